//! Quantities outside their stated ranges in all analyses of a run, for the end of its output.

use gearloss_studies::analyses::Outcome;
use gearloss_studies::distinct::distinct;
use gearloss_studies::points::Note;

use crate::text::{beyond, significant};

/// Start of each line.
const OUTSIDE: &str = "outside: ";

/// Values of a model's quantity outside its stated range.
#[derive(Debug, Clone, PartialEq)]
struct Values {
    least: f64,
    greatest: f64,
    points: u64,
    outside: u64,
    unit: String,
    /// Both ends as text, because JSON has no infinite numbers, and their origin.
    range: (String, String),
}

impl Values {
    fn from_note(note: &Note) -> Option<Self> {
        let stated = note.range.filter(|_| note.outside > 0)?;
        Some(Self {
            least: note.least,
            greatest: note.greatest,
            points: note.points.into(),
            outside: note.outside.into(),
            unit: note.unit.to_owned(),
            range: (beyond(stated.least, stated.greatest), stated.origin.to_owned()),
        })
    }

    fn add(&mut self, other: &Self) {
        self.least = self.least.min(other.least);
        self.greatest = self.greatest.max(other.greatest);
        self.points += other.points;
        self.outside += other.outside;
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
            values: Values::from_note(note),
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
        let known = |own: &&mut Left| (&own.path, &own.name) == (&other.path, &other.name);
        let Some(own) = self.0.iter_mut().find(known) else {
            self.0.push(other);
            return;
        };
        match (&mut own.values, other.values) {
            (Some(values), Some(more)) => values.add(&more),
            (None, more) => own.values = more,
            (Some(_), None) => {}
        }
        for analysis in other.analyses {
            if !own.analyses.contains(&analysis) {
                own.analyses.push(analysis);
            }
        }
    }

    /// A line for each quantity and range, with all its models.
    pub fn lines(&self) -> Vec<String> {
        let mut groups: Vec<Vec<&Left>> = Vec::new();
        for left in &self.0 {
            let range = |left: &Left| left.values.as_ref().map(|values| values.range.clone());
            let same = |group: &&mut Vec<&Left>| group[0].name == left.name && range(group[0]) == range(left);
            match groups.iter_mut().find(same) {
                Some(group) => group.push(left),
                None => groups.push(vec![left]),
            }
        }
        groups.iter().map(|group| line(group)).collect()
    }
}

/// One line for the models outside the same range.
fn line(group: &[&Left]) -> String {
    let paths: Vec<&str> = group.iter().map(|left| left.path.as_str()).collect();
    let analyses = distinct(group.iter().flat_map(|left| &left.analyses).map(String::as_str));
    let analyses = match &analyses[..] {
        [] => String::new(),
        list => format!("; in {}", list.join(", ")),
    };
    let (paths, name) = (paths.join(", "), &group[0].name);
    let mut values = group.iter().filter_map(|left| left.values.clone());
    let Some(first) = values.next() else {
        return format!("{OUTSIDE}{paths}: {name} is outside its validity range in some samples{analyses}");
    };
    let all = values.fold(first, |mut all, values| {
        all.add(&values);
        all
    });
    let unit = if all.unit == "-" {
        String::new()
    } else {
        format!(" {}", all.unit)
    };
    let (range, origin) = &all.range;
    format!(
        "{OUTSIDE}{paths}: {name} {} to {}{unit} is {range} at {} of {} points ({origin}){analyses}",
        significant(all.least),
        significant(all.greatest),
        all.outside,
        all.points
    )
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
                unit: "-".to_owned(),
                range: ("outside 0 to 5".to_owned(), "catalogue".to_owned()),
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
                "outside: bearings.B1.model, bearings.B2.model: n_dm 1 to 9 is outside 0 to 5 at 12 of 30 points \
              (catalogue); in map, city"
            ]
        );
    }
}
