//! Quantities outside their stated ranges in all analyses of a run, for the end of its output.

use std::collections::BTreeMap;

use gearloss_studies::analyses::Outcome;
use gearloss_studies::distinct::distinct;
use gearloss_studies::points::Note;

use crate::names::model;
use crate::text::{TextTable, beyond, number, printed_unit, short, significant};

/// Start of each line.
const OUTSIDE: &str = "outside: ";

/// Values of a model's quantity outside its stated range.
#[derive(Debug, Clone, PartialEq)]
struct Values {
    least: f64,
    greatest: f64,
    points: u64,
    outside: u64,
    /// Name of the quantity, as it stands in a sentence.
    meaning: &'static str,
    unit: &'static str,
    /// Ends of the stated range.
    ends: [f64; 2],
    /// Both ends as text, because JSON has no infinite numbers, and their origin.
    range: (String, String),
    /// Share of the loss of each analysis that the components lose outside the range, where it is known.
    loss_shares: BTreeMap<String, f64>,
}

impl Values {
    fn from_note(note: &Note, analysis: Option<&str>) -> Option<Self> {
        let stated = note.range.filter(|_| note.outside > 0)?;
        Some(Self {
            least: note.least,
            greatest: note.greatest,
            points: note.points.into(),
            outside: note.outside.into(),
            meaning: note.meaning,
            unit: note.unit,
            ends: [stated.least, stated.greatest],
            range: (beyond(stated.least, stated.greatest), stated.origin.to_owned()),
            loss_shares: note
                .loss_share
                .map(|share| (analysis.unwrap_or_default().to_owned(), share))
                .into_iter()
                .collect(),
        })
    }

    fn add(&mut self, other: &Self) {
        self.least = self.least.min(other.least);
        self.greatest = self.greatest.max(other.greatest);
        self.points += other.points;
        self.outside += other.outside;
    }

    /// Largest share in the loss of an analysis; absent if no analysis knows it.
    fn loss_share(&self) -> Option<f64> {
        self.loss_shares.values().copied().reduce(f64::max)
    }

    /// Which bound is exceeded, with the range, called so, and its unit.
    fn exceeded(&self, range: &str) -> String {
        let [low, high] = self.ends;
        let beyond = if self.greatest <= high {
            "below"
        } else if self.least >= low {
            "above"
        } else {
            "outside"
        };
        let bound = match self.ends.map(f64::is_finite) {
            [true, true] => format!("the {range} {} to {}", short(low), short(high)),
            [true, false] => short(low),
            _ => short(high),
        };
        format!("{beyond} {bound}{}", unit(self.unit))
    }

    /// A value for comparison with the range: one far below a positive bound by a round number below that bound.
    fn compared(&self, value: f64, print: fn(f64) -> String) -> String {
        let low = self.ends[0];
        let negligible = if low > 0.0 && low.is_finite() {
            10.0_f64.powf(low.log10().floor() - 2.0)
        } else {
            0.0
        };
        if value > 0.0 && value < negligible {
            format!("less than {}", print(negligible))
        } else {
            print(value)
        }
    }

    fn share_of_points(&self) -> f64 {
        self.outside as f64 / self.points.max(1) as f64
    }
}

/// A quantity of one model outside its range.
#[derive(Debug, Clone, PartialEq)]
struct Left {
    /// Path of the model.
    path: String,
    /// Symbol.
    name: String,
    /// Absent if samples record only that it was out of range.
    values: Option<Values>,
    /// Analyses.
    analyses: Vec<String>,
}

impl Left {
    fn from_note(note: &Note, analyses: Vec<String>) -> Self {
        Self {
            path: note.path.clone(),
            name: note.name.to_owned(),
            values: Values::from_note(note, analyses.first().map(String::as_str)),
            analyses,
        }
    }
}

/// All quantities outside their ranges, in order of first occurrence.
#[derive(Debug, Clone, Default)]
pub struct StatedRanges(Vec<Left>);

impl StatedRanges {
    /// Of notes of models, without analyses.
    pub fn from_notes(notes: &[Note]) -> Self {
        let left = notes.iter().filter(|note| note.outside > 0 && note.range.is_some());
        Self(left.map(|note| Left::from_note(note, Vec::new())).collect())
    }

    /// Adds what an analysis found.
    pub fn add_outcome(&mut self, analysis: &str, outcome: &dyn Outcome) {
        for note in outcome.notes().iter().filter(|note| note.outside > 0) {
            self.add(Left::from_note(note, vec![analysis.to_owned()]));
        }
        for (path, name) in outcome.left_at_samples() {
            self.add(Left {
                path: path.clone(),
                name: name.clone(),
                values: None,
                analyses: vec![analysis.to_owned()],
            });
        }
    }

    fn add(&mut self, other: Left) {
        let known = |left: &&mut Left| (&left.path, &left.name) == (&other.path, &other.name);
        let Some(left) = self.0.iter_mut().find(known) else {
            self.0.push(other);
            return;
        };
        match (&mut left.values, other.values) {
            (Some(values), Some(more)) => {
                values.add(&more);
                // The same component with another model set: the larger share.
                for (analysis, share) in more.loss_shares {
                    let known_share = values.loss_shares.entry(analysis).or_default();
                    *known_share = known_share.max(share);
                }
            }
            (None, more) => left.values = more,
            (Some(_), None) => {}
        }
        for analysis in other.analyses {
            if !left.analyses.contains(&analysis) {
                left.analyses.push(analysis);
            }
        }
    }

    /// Quantities with the same range, the one that concerns most of the loss first.
    fn groups(&self) -> Vec<Group> {
        let mut groups: Vec<Vec<&Left>> = Vec::new();
        for left in &self.0 {
            let range = |left: &Left| left.values.as_ref().map(|values| values.range.clone());
            let same = |group: &&mut Vec<&Left>| group[0].name == left.name && range(group[0]) == range(left);
            match groups.iter_mut().find(same) {
                Some(group) => group.push(left),
                None => groups.push(vec![left]),
            }
        }
        let mut groups: Vec<Group> = groups.iter().map(|group| Group::new(group)).collect();
        groups.sort_by(|a, b| b.weight().total_cmp(&a.weight()));
        groups
    }

    /// A line for each quantity and range, with all its models.
    pub fn lines(&self) -> Vec<String> {
        self.groups().iter().map(Group::line).collect()
    }

    /// The quantities that concern most of the loss, in short, the worst first.
    pub fn worst(&self) -> Vec<String> {
        self.groups().iter().map(Group::short).collect()
    }

    /// Rows of the table that an analysis concerns, such as `1-3, 5`; empty if there are none.
    pub fn rows_of(&self, analysis: &str) -> String {
        let groups = self.groups();
        let concerned = groups
            .iter()
            .enumerate()
            .filter(|(_, group)| group.analyses.iter().any(|listed| listed == analysis));
        let rows: Vec<usize> = concerned.map(|(i, _)| i + 1).collect();
        let runs = rows.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
            [first, .., last] => format!("{first}-{last}"),
            _ => run[0].to_string(),
        });
        runs.collect::<Vec<_>>().join(", ")
    }

    /// All of them as a table; absent if there are none.
    pub fn table(&self) -> Option<TextTable> {
        let groups = self.groups();
        let known = |group: &Group, cell: fn(&Values) -> String| group.values.as_ref().map(cell).unwrap_or_default();
        let percent = |group: &Group, share: fn(&Values) -> Option<f64>| {
            number(group.values.as_ref().and_then(share).map(|share| 100.0 * share), 1)
        };
        let table = TextTable::of(groups.iter().enumerate())
            .column("no.", |(i, _)| (i + 1).to_string())
            .column("models", |(_, group)| group.paths.join(", "))
            .column("quantity", |(_, group)| group.quantity())
            .column("stated range", |(_, group)| match &group.values {
                Some(values) => values.range.0.clone(),
                None => "left in some samples".to_owned(),
            })
            .column("from", |(_, group)| known(group, |v| significant(v.least)))
            .column("to", |(_, group)| known(group, |v| significant(v.greatest)))
            .column("unit", |(_, group)| known(group, |v| printed_unit(v.unit).to_owned()))
            .column("points outside %", |(_, group)| {
                percent(group, |v| Some(v.share_of_points()))
            })
            .column("loss outside %", |(_, group)| percent(group, Values::loss_share))
            .column("source of the range", |(_, group)| known(group, |v| v.range.1.clone()))
            .column("analyses", |(_, group)| group.analyses.join(", "));
        (!groups.is_empty()).then(|| table.finish())
    }
}

/// Models outside the same range of a quantity.
struct Group {
    paths: Vec<String>,
    name: String,
    /// Of all of them; absent if samples record only that they were out of range.
    values: Option<Values>,
    analyses: Vec<String>,
}

impl Group {
    fn new(group: &[&Left]) -> Self {
        let mut values = group.iter().filter_map(|left| left.values.clone());
        let first = values.next();
        let all = first.map(|first| {
            values.fold(first, |mut all, values| {
                all.add(&values);
                // Different components of one analysis: their shares of its loss add up.
                for (analysis, share) in values.loss_shares {
                    let known_share = all.loss_shares.entry(analysis).or_default();
                    *known_share = (*known_share + share).min(1.0);
                }
                all
            })
        });
        Self {
            paths: group.iter().map(|left| left.path.clone()).collect(),
            name: group[0].name.clone(),
            values: all,
            analyses: distinct(group.iter().flat_map(|left| &left.analyses).cloned()),
        }
    }

    /// How much of the results it concerns. A component of unknown loss counts as one of ten equal ones.
    fn weight(&self) -> f64 {
        let of = |values: &Values| values.loss_share().unwrap_or(0.1 * values.share_of_points());
        self.values.as_ref().map_or(0.0, of)
    }

    /// Name and symbol.
    fn quantity(&self) -> String {
        let meaning = self.values.as_ref().map(|values| format!("{} ", values.meaning));
        format!("{}{}", meaning.unwrap_or_default(), self.name)
    }

    fn line(&self) -> String {
        let analyses = match &self.analyses[..] {
            [] => String::new(),
            list => format!("; in {}", list.join(", ")),
        };
        let (paths, name) = (self.paths.join(", "), self.quantity());
        let Some(all) = &self.values else {
            return format!("{OUTSIDE}{paths}: {name} is outside its validity range in some samples{analyses}");
        };
        let ends = match [all.least, all.greatest].map(|x| all.compared(x, significant)) {
            [low, high] if low == high => low,
            [low, high] => format!("{low} to {high}"),
        };
        format!(
            "{OUTSIDE}{paths}: {name} {ends}{} is {} at {} of {} points ({}){analyses}",
            unit(all.unit),
            all.exceeded("range"),
            all.outside,
            all.points,
            all.range.1
        )
    }

    fn short(&self) -> String {
        let first = model(&self.paths[0]);
        let paths = match self.paths.len() {
            1 => first,
            2 => format!("{first} and 1 other"),
            count => format!("{first} and {} others", count - 1),
        };
        let name = self.quantity();
        let Some(all) = &self.values else {
            return format!("{paths}: {name} is outside its range in some samples");
        };
        let share = all.loss_share().map_or_else(String::new, |share| {
            format!(", with {} % of the loss", short(100.0 * share))
        });
        // What is small beside the largest value is zero for a reader, unless it is itself outside.
        let is_inside = all.least >= all.ends[0];
        let least = if is_inside && all.least.abs() < 1e-3 * all.greatest.abs() {
            0.0
        } else {
            all.least
        };
        let ends = match [least, all.greatest].map(|x| all.compared(x, short)) {
            [low, high] if low == high => low,
            [low, high] => format!("{low} to {high}"),
        };
        format!(
            "{paths}: {name} ({ends}{}) is {} at {} % of the points{share}",
            unit(all.unit),
            all.exceeded("stated range"),
            short(100.0 * all.share_of_points())
        )
    }
}

/// A unit behind a number.
fn unit(symbol: &str) -> String {
    if symbol == "-" {
        String::new()
    } else {
        format!(" {}", printed_unit(symbol))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn left(path: &str, least: f64, analysis: &str) -> Left {
        Left {
            path: path.to_owned(),
            name: "n_dm".to_owned(),
            values: Some(Values {
                least,
                greatest: 9.0,
                points: 10,
                outside: 4,
                meaning: "speed factor",
                unit: "-",
                ends: [0.0, 5.0],
                range: ("outside 0 to 5".to_owned(), "catalogue".to_owned()),
                loss_shares: BTreeMap::from([(analysis.to_owned(), 0.25)]),
            }),
            analyses: vec![analysis.to_owned()],
        }
    }

    #[test]
    fn one_line_names_all_analyses_and_models() {
        let mut ranges = StatedRanges::default();
        ranges.add(left("bearings.B1.model", 2.0, "map"));
        ranges.add(left("bearings.B1.model", 1.0, "city"));
        ranges.add(left("bearings.B2.model", 3.0, "map"));
        assert_eq!(
            ranges.lines(),
            [
                "outside: bearings.B1.model, bearings.B2.model: speed factor n_dm 1 to 9 is above the range 0 to 5 at 12 of 30 points \
              (catalogue); in map, city"
            ]
        );
        assert_eq!(
            (ranges.rows_of("map"), ranges.rows_of("town")),
            ("1".to_owned(), String::new())
        );
        let short = "bearing B1 and 1 other: speed factor n_dm (1 to 9) is above the stated range 0 to 5 at 40 % of the points, \
                     with 50 % of the loss";
        assert_eq!(ranges.worst(), [short]);
        let mut ranges = StatedRanges::default();
        ranges.add(left("bearings.B1.model", 1e-6, "map"));
        assert!(
            ranges.worst()[0].contains("n_dm (0 to 9)"),
            "small beside the largest value"
        );
        let mut ranges = StatedRanges::default();
        ranges.add(left("bearings.B1.model", -1e-3, "map"));
        assert!(
            ranges.worst()[0].contains("n_dm (-0.001 to 9) is outside the stated range"),
            "small, but below the range"
        );
        let mut ranges = StatedRanges::default();
        let mut pressure = left("meshes.M1.model", 3.47e-7, "map");
        if let Some(values) = &mut pressure.values {
            (values.greatest, values.unit, values.ends) = (0.9, "GPa", [0.5, 4.0]);
        }
        ranges.add(pressure);
        let short = &ranges.worst()[0];
        assert!(short.contains("n_dm (less than 0.001 to 0.9 GPa) is below"), "{short}");
        let line = &ranges.lines()[0];
        assert!(
            line.contains("n_dm less than 0.001 to 0.9 GPa is below the range 0.5 to 4 GPa"),
            "{line}"
        );
    }
}
