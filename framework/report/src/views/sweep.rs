//! A sweep: tables of the loss; figures of loss and efficiency over the values as lines or maps.

mod summary;

use gearloss_studies::analyses::numbers::word;
use gearloss_studies::analyses::sweep::{PointOfSweep, SweepOfValue, SweepOutcome};

use crate::figure::Best;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, fixed, number};
use crate::{Figure, Map};

register_view!(SweepOutcome, show);

fn show(outcome: &SweepOutcome, page: &mut Page) {
    summary::add(outcome, page);
    page.published(&outcome.published);
    let Some(sweep) = Sweep::new(outcome) else {
        return;
    };
    for of_set in &outcome.notes {
        for second in 0..sweep.second_words.len().max(1) {
            sweep.table(&of_set.model_set, second, page);
        }
        page.line("");
    }
    sweep.figures(page);
}

/// A sweep with its values as text.
struct Sweep<'a> {
    outcome: &'a SweepOutcome,
    name: &'a str,
    path: &'a str,
    words: Vec<String>,
    /// The second path if there is one.
    second_path: Option<&'a str>,
    second_words: Vec<String>,
}

/// Name, unit, which end is good, and reader of a quantity.
type Quantity = (&'static str, &'static str, Best, fn(&PointOfSweep) -> Option<f64>);

const QUANTITIES: [Quantity; 2] = [
    ("loss", "W", Best::Lowest, |point| point.loss_w),
    ("efficiency", "%", Best::Highest, |point| {
        point.efficiency.map(|e| 100.0 * e)
    }),
];

impl<'a> Sweep<'a> {
    fn new(outcome: &'a SweepOutcome) -> Option<Self> {
        let first = outcome.sweep.first()?;
        let own = || outcome.values_of_set(&first.model_set);
        let along = own().filter(|value| value.places[1] == 0);
        let seconds = own().filter(|value| value.places[0] == 0);
        Some(Self {
            outcome,
            name: &outcome.head.analysis,
            path: &first.path,
            words: along.map(|value| word(&value.value)).collect(),
            second_path: first.second.as_ref().map(|second| second.path.as_str()),
            second_words: seconds
                .filter_map(|value| Some(word(&value.second.as_ref()?.value)))
                .collect(),
        })
    }

    /// Names of the sets in their order.
    fn sets(&self) -> impl Iterator<Item = &'a str> {
        self.outcome.notes.iter().map(|of_set| of_set.model_set.as_str())
    }

    /// The points of one set and one second value, in the order of the first values.
    fn row(&self, set: &'a str, second: usize) -> Vec<&'a SweepOfValue> {
        let own = self.outcome.values_of_set(set);
        own.filter(|value| value.places[1] == second).collect()
    }

    /// The loss over the first values at one second value.
    fn table(&self, set: &'a str, second: usize, page: &mut Page) {
        let own = self.row(set, second);
        let beside = match (self.second_path, self.second_words.get(second)) {
            (Some(path), Some(word)) => format!(", {path} {word}"),
            _ => String::new(),
        };
        page.line(format!(
            "{}: loss in W over {}, models {set}{beside}",
            self.name, self.path
        ));
        let mut titles = vec!["torque Nm", "speed rpm"];
        titles.extend(self.words.iter().map(String::as_str));
        let mut table = TextTable::new(&titles);
        for (i, point) in own[0].points.iter().enumerate() {
            let mut row = vec![format!("{}", point.torque_nm), fixed(point.solved_speed_rpm, 0)];
            row.extend(own.iter().map(|value| number(value.points[i].loss_w, 2)));
            table.row(row);
        }
        page.table(table);
    }

    /// Loss and efficiency over the values.
    fn figures(&self, page: &mut Page) {
        for quantity in QUANTITIES {
            let (short, unit, _, read) = quantity;
            let y = format!("{short} in {unit}");
            if let Some(second_path) = self.second_path {
                for map in self.maps(second_path, quantity) {
                    let title = map.title.replace([' ', ',', ':'], "");
                    page.figure(format!("{}-{short}-{title}", self.name), Figure::Map(map));
                }
                continue;
            }
            let lines = self.lines(read);
            if !lines.is_empty() {
                let figure = Figure::Lines {
                    title: format!("{}: {y}", self.name),
                    x: self.axis().1,
                    y,
                    lines,
                };
                page.figure(format!("{}-{short}", self.name), figure);
            }
        }
    }

    /// Positions of the values on the axis, and its title. Values that are not numbers are at their index.
    fn axis(&self) -> (Vec<f64>, String) {
        let (words, path) = (&self.words, self.path);
        let parsed: Option<Vec<f64>> = words.iter().map(|w| w.split(' ').next()?.parse().ok()).collect();
        let unit = words
            .first()
            .and_then(|w| w.split_once(' '))
            .map_or("", |(_, unit)| unit);
        match parsed {
            Some(places) if unit.is_empty() => (places, path.to_owned()),
            Some(places) => (places, format!("{path} in {unit}")),
            None => (
                (1..=words.len()).map(|i| i as f64).collect(),
                format!("{path}: {}", words.join(", ")),
            ),
        }
    }

    /// A line for each set, torque and speed.
    fn lines(&self, quantity: fn(&PointOfSweep) -> Option<f64>) -> Vec<Line> {
        let (places, _) = self.axis();
        let mut lines = Vec::new();
        for set in self.sets() {
            let own = self.row(set, 0);
            for (i, point) in own[0].points.iter().enumerate() {
                let points: Vec<_> = own
                    .iter()
                    .map(|value| Some((places[value.places[0]], quantity(&value.points[i])?)))
                    .collect();
                if points.iter().any(Option::is_some) {
                    lines.push(Line {
                        name: format!("{set}: {}", words_of_point(point)),
                        points,
                        stroke: Stroke::Marked,
                    });
                }
            }
        }
        lines
    }

    /// A map over both paths for each set, torque and speed.
    fn maps(&self, second_path: &str, (quantity, unit, best, read): Quantity) -> Vec<Map> {
        let mut maps = Vec::new();
        for set in self.sets() {
            for (i, point) in self.row(set, 0)[0].points.iter().enumerate() {
                let own = self.outcome.values_of_set(set);
                let values: Vec<Option<f64>> = own.map(|value| read(&value.points[i])).collect();
                if values.iter().any(Option::is_some) {
                    maps.push(Map {
                        title: format!(
                            "{}: {quantity} in {unit}, models {set}, {}",
                            self.name,
                            words_of_point(point)
                        ),
                        x: (self.path.to_owned(), self.words.clone()),
                        y: (second_path.to_owned(), self.second_words.clone()),
                        values,
                        unit: unit.to_owned(),
                        best: Some(best),
                        ..Map::default()
                    });
                }
            }
        }
        maps
    }
}

fn words_of_point(point: &PointOfSweep) -> String {
    format!("{} Nm, {} rpm", point.torque_nm, fixed(point.solved_speed_rpm, 0))
}
