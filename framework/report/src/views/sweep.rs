//! A sweep: tables of the loss; figures of loss and efficiency over the values as lines or maps, over names as bars.

mod cycles;
mod summary;

use gearloss_studies::analyses::sweep::{PointOfSweep, SweepOfValue, SweepOutcome};
use gearloss_studies::numbers::word;

use crate::figure::Best;
use crate::limits::{after, bounds, in_unit};
use crate::names::{of_component, quantity};
use crate::page::Page;
use crate::plot::{Bar, Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, fixed, number, printed_unit, short, with_printed_units};
use crate::{Figure, Map};

register_view!(SweepOutcome, show);

fn show(outcome: &SweepOutcome, page: &mut Page) {
    left_out(outcome, page);
    if !outcome.cycles.is_empty() {
        page.published(&outcome.published);
        cycles::show(outcome, page);
        return;
    }
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
    if sweep.is_of_names() {
        sweep.bars(page);
    } else {
        sweep.figures(page);
        sweep.limits(page);
    }
    designs(outcome, page);
}

/// Combinations with which the gearbox cannot be built.
fn left_out(outcome: &SweepOutcome, page: &mut Page) {
    let Some(first) = outcome.left_out.first() else { return };
    page.careful.push(format!(
        "{} of the combinations left out, the first {}: {}",
        outcome.left_out.len(),
        first.values,
        first.reason
    ));
    for combination in &outcome.left_out {
        page.line(format!("left out: {}: {}", combination.values, combination.reason));
    }
}

/// Most designs that are compared.
const DESIGNS: usize = 12;

/// The values with the lowest mean loss over all points, as bars of its shares; only if both paths vary.
fn designs(outcome: &SweepOutcome, page: &mut Page) {
    let several = outcome.notes.len() > 1;
    let label = |value: &SweepOfValue| {
        let words = format!("{}, {}", word(&value.value), word(&value.second.as_ref()?.value));
        Some(if several {
            format!("{}: {words}", value.model_set)
        } else {
            words
        })
    };
    let bar = |value: &SweepOfValue| {
        let count = value.points.len().max(1) as f64;
        let mut shares = vec![0.0; value.shares.len()];
        for point in &value.points {
            let losses = point.losses_w.as_ref()?;
            shares
                .iter_mut()
                .zip(losses)
                .for_each(|(sum, watts)| *sum += watts / count);
        }
        let mean: f64 = shares.iter().sum();
        let above = format!("{} W", short(mean));
        let label = label(value)?;
        Some((
            mean,
            Bar {
                label,
                shares,
                above,
                ..Bar::default()
            },
        ))
    };
    let mut bars: Vec<(f64, Bar)> = outcome.sweep.iter().filter_map(bar).collect();
    bars.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all = bars.len();
    bars.truncate(DESIGNS);
    let names = outcome
        .sweep
        .first()
        .map(|value| value.shares.clone())
        .unwrap_or_default();
    let first = outcome.sweep.first();
    let paths = first.and_then(|value| Some([&value.path, &value.second.as_ref()?.path]));
    let over = paths.map_or_else(String::new, |paths| paths.map(|path| quantity(path)).join(", "));
    if bars.len() > 1 {
        page.report_figure(Figure::Bars {
            title: format!("Lowest mean loss of {all} designs, the best first"),
            over,
            height: "mean loss in W".to_owned(),
            names,
            bars: bars.into_iter().map(|(_, bar)| bar).collect(),
        });
    }
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

/// A quantity at the points of a sweep.
#[derive(Clone, Copy)]
struct Quantity {
    words: &'static str,
    unit: &'static str,
    /// In names of figures.
    file: &'static str,
    best: Best,
    /// Whether it has a table, besides its figures.
    in_table: bool,
    read: fn(&PointOfSweep) -> Option<f64>,
}

/// Those of the drive unit have no value without machines.
const QUANTITIES: [Quantity; 4] = [
    Quantity {
        words: "loss",
        unit: "W",
        file: "loss",
        best: Best::Lowest,
        in_table: true,
        read: |point| point.loss_w,
    },
    Quantity {
        words: "efficiency",
        unit: "%",
        file: "efficiency",
        best: Best::Highest,
        in_table: false,
        read: |point| Some(100.0 * point.efficiency?),
    },
    Quantity {
        words: "loss of the drive unit",
        unit: "W",
        file: "unit-loss",
        best: Best::Lowest,
        in_table: true,
        read: |point| Some(point.unit?.unit_loss_w),
    },
    Quantity {
        words: "system efficiency",
        unit: "%",
        file: "system-efficiency",
        best: Best::Highest,
        in_table: true,
        read: |point| Some(100.0 * point.unit?.system_efficiency?),
    },
];

impl<'a> Sweep<'a> {
    fn new(outcome: &'a SweepOutcome) -> Option<Self> {
        let first = outcome.sweep.first()?;
        // Combinations may be left out, so the words of a value are those of any with it.
        let words = |side: usize, word: &dyn Fn(&SweepOfValue) -> Option<String>| -> Vec<String> {
            let count = outcome
                .sweep
                .iter()
                .map(|value| value.places[side] + 1)
                .max()
                .unwrap_or(0);
            let of = |place| {
                outcome
                    .sweep
                    .iter()
                    .find(|value| value.places[side] == place)
                    .and_then(word)
            };
            (0..count).filter_map(of).collect()
        };
        Some(Self {
            outcome,
            name: &outcome.head.analysis,
            path: &first.path,
            words: words(0, &|value| Some(word(&value.value))),
            second_path: first.second.as_ref().map(|second| second.path.as_str()),
            second_words: words(1, &|value| Some(word(&value.second.as_ref()?.value))),
        })
    }

    /// Names of the sets in their order.
    fn sets(&self) -> impl Iterator<Item = &'a str> {
        self.outcome.notes.iter().map(|of_set| of_set.model_set.as_str())
    }

    /// The points of one set at one combination; absent if it is left out.
    fn cell(&self, set: &str, places: [usize; 2]) -> Option<&'a SweepOfValue> {
        self.outcome
            .sweep
            .iter()
            .find(|value| value.model_set == set && value.places == places)
    }

    /// The points of one set and one second value, in the order of the first values.
    fn row(&self, set: &'a str, second: usize) -> Vec<&'a SweepOfValue> {
        let values = self.outcome.values_of_set(set);
        values.filter(|value| value.places[1] == second).collect()
    }

    /// Those that points can have: without machines none of the drive unit.
    fn quantities(&self) -> impl Iterator<Item = Quantity> {
        let mut points = self.outcome.sweep.iter().flat_map(|value| &value.points);
        let has_unit = points.any(|point| point.unit.is_some());
        let count = if has_unit { QUANTITIES.len() } else { 2 };
        QUANTITIES.into_iter().take(count)
    }

    /// Tables over the first values at one second value.
    fn table(&self, set: &'a str, second: usize, page: &mut Page) {
        let values: Vec<Option<&SweepOfValue>> = (0..self.words.len()).map(|i| self.cell(set, [i, second])).collect();
        let Some(first) = values.iter().flatten().next() else {
            return;
        };
        let beside = match (self.second_path, self.second_words.get(second)) {
            (Some(path), Some(word)) => format!(", {path} {word}"),
            _ => String::new(),
        };
        for quantity in self.quantities().filter(|quantity| quantity.in_table) {
            let Quantity { words, unit, read, .. } = quantity;
            page.line(format!(
                "{}: {words} in {unit} over {}, models {set}{beside}",
                self.name, self.path
            ));
            let table = TextTable::of(first.points.iter().enumerate())
                .column("torque Nm", |(_, point)| point.torque_nm.to_string())
                .column("speed rpm", |(_, point)| fixed(point.solved_speed_rpm, 0))
                .each(self.words.iter().zip(&values), |table, (word, value)| {
                    table.column(word, |(i, _)| {
                        number(value.and_then(|value| read(&value.points[*i])), 2)
                    })
                });
            page.table(table.finish());
        }
    }

    /// Whether the values of the only path are names, such as those of oils, which have no place on an axis.
    fn is_of_names(&self) -> bool {
        self.second_path.is_none() && numbers(&self.words).is_none()
    }

    /// Losses by their shares, oil temperature, and limited quantities as bars, one for each name, model set and point.
    fn bars(&self, page: &mut Page) {
        let several = self.outcome.sweep.first().map_or(0, |value| value.points.len()) * self.sets().count() > 1;
        let bars = |read: &dyn Fn(&SweepOfValue, &PointOfSweep) -> Option<(Vec<f64>, String)>| -> Vec<Bar> {
            let all = self
                .outcome
                .sweep
                .iter()
                .flat_map(|value| value.points.iter().map(move |point| (value, point)));
            let bar = |(value, point): (&SweepOfValue, &PointOfSweep)| {
                let (shares, above) = read(value, point)?;
                let name = word(&value.value);
                let label = if several {
                    format!("{name}\n{}: {}", value.model_set, words_of_point(point))
                } else {
                    name
                };
                Some(Bar {
                    label,
                    shares,
                    above,
                    ..Bar::default()
                })
            };
            all.filter_map(bar).collect()
        };
        let mut add = |file: &str, title: &str, height: String, names: Vec<String>, bars: Vec<Bar>| {
            if bars.is_empty() {
                return;
            }
            let title = format!("{}: {title}", self.name);
            let over = quantity(self.path);
            page.figure(
                format!("{}-{file}", self.name),
                Figure::Bars {
                    title,
                    over,
                    height,
                    names,
                    bars,
                },
            );
        };
        let losses = bars(&|_, point| {
            let loss = point.loss_w?;
            let above = watts_and_share(loss, point.efficiency);
            Some((point.losses_w.clone().unwrap_or_else(|| vec![loss]), above))
        });
        let names = self.outcome.sweep.first().map(|value| value.shares.clone());
        let loss = "loss in W".to_owned();
        add("loss", "loss and efficiency", loss, names.unwrap_or_default(), losses);
        let units = bars(&|_, point| {
            let unit = point.unit.as_ref()?;
            let above = watts_and_share(unit.unit_loss_w, unit.system_efficiency);
            Some((vec![point.loss_w?, unit.machine_loss_w, unit.inverter_loss_w], above))
        });
        let names = ["gearbox", "machines", "inverters"].map(str::to_owned);
        add(
            "unit",
            "loss and efficiency of the drive unit",
            "loss in W".to_owned(),
            names.to_vec(),
            units,
        );
        let single = |value: f64, unit: &str| (vec![value], format!("{}{}", short(value), after(unit)));
        let temperatures = bars(&|_, point| Some(single(point.oil_temperature_degc?, "°C")));
        let differs = |bars: &[Bar]| bars.windows(2).any(|pair| pair[0].shares != pair[1].shares);
        let is_limited = self.outcome.limits.iter().any(|limit| limit.is_of_oil);
        if differs(&temperatures) && !is_limited {
            let height = "oil temperature in °C".to_owned();
            add(
                "oil",
                "oil temperature",
                height,
                vec!["oil temperature".to_owned()],
                temperatures,
            );
        }
        for column in &self.outcome.limits {
            let reached = &self.outcome.head.study_limits;
            let Some(limit) = reached.iter().find(|reached| reached.limit == column.name) else {
                continue;
            };
            let values = bars(&|_, point| {
                let value = point.limit_values.get(&column.name).copied().flatten()?;
                let beyond =
                    limit.least.is_some_and(|least| value < least) || limit.most.is_some_and(|most| value > most);
                let (shares, above) = single(value, column.unit);
                Some((shares, above + if beyond { ", beyond the limit" } else { "" }))
            });
            let words = of_component(&column.words);
            let title = format!("{words}, limit: {}", bounds(limit));
            let height = format!("{words}{}", in_unit(column.unit));
            add(&format!("limit-{}", column.name), &title, height, vec![words], values);
        }
    }

    /// Loss and efficiency over the values, of the gearbox and of the drive unit.
    fn figures(&self, page: &mut Page) {
        for drawn in self.quantities() {
            let Quantity {
                words,
                unit,
                file,
                read,
                ..
            } = drawn;
            let y = format!("{words} in {unit}");
            if let Some(second_path) = self.second_path {
                for map in self.maps(second_path, drawn) {
                    let title = map.title.replace([' ', ',', ':'], "");
                    page.figure(format!("{}-{file}-{title}", self.name), Figure::Map(map));
                }
                continue;
            }
            let lines = self.lines(&read);
            if !lines.is_empty() {
                let figure = Figure::Lines {
                    title: format!("{}: {words} over {}", self.name, quantity(self.path)),
                    x: self.axis().1,
                    y,
                    lines,
                };
                page.figure(format!("{}-{file}", self.name), figure);
            }
        }
    }

    /// Limited quantities over the values, each with its limit as lines.
    fn limits(&self, page: &mut Page) {
        if self.second_path.is_some() {
            return;
        }
        let (places, x) = self.axis();
        for column in &self.outcome.limits {
            let mut lines = self.lines(&|point| point.limit_values.get(&column.name).copied().flatten());
            let reached = self
                .outcome
                .head
                .study_limits
                .iter()
                .find(|reached| reached.limit == column.name);
            let (Some(limit), false) = (reached, lines.is_empty()) else {
                continue;
            };
            let across = |bound: f64| places.iter().map(|place| Some((*place, bound))).collect();
            lines.extend(
                [(limit.least, "least"), (limit.most, "most")]
                    .into_iter()
                    .filter_map(|(bound, end)| {
                        Some(Line {
                            name: format!("limit {}: {end}", column.name),
                            points: across(bound?),
                            stroke: Stroke::Line,
                        })
                    }),
            );
            let words = of_component(&column.words);
            let y = format!("{words}{}", in_unit(column.unit));
            let figure = Figure::Lines {
                title: format!("{}: {words} over {}", self.name, quantity(self.path)),
                x: x.clone(),
                y,
                lines,
            };
            page.figure(format!("{}-limit-{}", self.name, column.name), figure);
        }
    }

    /// Positions of the values on the axis, and its title.
    fn axis(&self) -> (Vec<f64>, String) {
        let (words, path) = (&self.words, quantity(self.path));
        let places = numbers(words).unwrap_or_default();
        let unit = words
            .first()
            .and_then(|w| w.split_once(' '))
            .map_or("", |(_, unit)| unit);
        let title = if unit.is_empty() {
            path
        } else {
            format!("{path} in {}", printed_unit(unit))
        };
        (places, title)
    }

    /// A line for each set, torque and speed.
    fn lines(&self, quantity: &dyn Fn(&PointOfSweep) -> Option<f64>) -> Vec<Line> {
        let (places, _) = self.axis();
        let mut lines = Vec::new();
        for set in self.sets() {
            let values = self.row(set, 0);
            for (i, point) in values[0].points.iter().enumerate() {
                let points: Vec<_> = values
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
    fn maps(&self, second_path: &str, drawn: Quantity) -> Vec<Map> {
        let Quantity {
            words,
            unit,
            best,
            read,
            ..
        } = drawn;
        let printed = |words: &[String]| words.iter().map(|word| with_printed_units(word)).collect();
        let mut maps = Vec::new();
        for set in self.sets() {
            let points = self.outcome.sweep.iter().find(|value| value.model_set == set);
            for (i, point) in points.map_or(&[][..], |value| &value.points).iter().enumerate() {
                let places = (0..self.second_words.len()).flat_map(|k| (0..self.words.len()).map(move |i| [i, k]));
                let value = |places| self.cell(set, places).and_then(|value| read(&value.points[i]));
                let values: Vec<Option<f64>> = places.map(value).collect();
                if values.iter().any(Option::is_some) {
                    maps.push(Map {
                        title: format!(
                            "{}: {words} in {unit}, models {set}, {}",
                            self.name,
                            words_of_point(point)
                        ),
                        x: (quantity(self.path), printed(&self.words)),
                        y: (quantity(second_path), printed(&self.second_words)),
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

/// Values as numbers without their unit; nothing if one of them is a name.
pub(super) fn numbers(words: &[String]) -> Option<Vec<f64>> {
    words.iter().map(|word| word.split(' ').next()?.parse().ok()).collect()
}

/// A loss with the efficiency, if there is one, above a bar.
fn watts_and_share(watts: f64, share: Option<f64>) -> String {
    let share = share.map(|share| format!(", {} %", short(100.0 * share)));
    format!("{} W{}", short(watts), share.unwrap_or_default())
}

fn words_of_point(point: &PointOfSweep) -> String {
    format!("{} Nm, {} rpm", point.torque_nm, fixed(point.solved_speed_rpm, 0))
}
