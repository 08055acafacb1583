//! Figures of maps.

use gearloss_studies::analyses::map::{Axes, MapOfSet, MapOutcome, Mark, ShownGrid, ShownPoint};
use gearloss_studies::numbers::{RPM, tidy, word};
use gearloss_studies::points::OilTemperature;

use super::panels::panels;
use crate::figure::{Best, Hatching, jumps};
use crate::limits::{bounds, in_unit};
use crate::page::Page;
use crate::picture::Screen;
use crate::text::extremes;
use crate::{Cloud, Figure, Map};

/// A quantity of the maps.
pub struct Quantity {
    /// Short name for file names.
    short: &'static str,
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Which end is good.
    pub best: Best,
    /// Reads the value at a point.
    pub value: fn(&ShownPoint) -> Option<f64>,
}

/// Efficiency, loss, loss torque, and with a heat balance the temperature.
pub fn quantities(outcome: &MapOutcome) -> Vec<Quantity> {
    let quantity = |(short, name, unit), best, value| Quantity {
        short,
        name,
        unit,
        best,
        value,
    };
    let efficiency = |p: &ShownPoint| p.efficiency.map(|e| 100.0 * e);
    let mut all = vec![
        quantity(("efficiency", "efficiency", "%"), Best::Highest, efficiency),
        quantity(("loss", "loss", "W"), Best::Lowest, |p| p.loss),
        quantity(("loss-torque", "loss torque", "Nm"), Best::Lowest, |p| p.loss_torque),
    ];
    if outcome.maps.iter().any(|m| m.best_gears.is_some()) {
        let names = ("gear", "number of the best gear", "-");
        all.push(quantity(names, Best::Lowest, |p| p.gear.map(|gear| gear as f64 + 1.0)));
    }
    if outcome.maps.iter().any(|m| m.oil == OilTemperature::Balance) {
        let names = ("temperature", "oil temperature", "degC");
        all.push(quantity(names, Best::Lowest, |p| p.oil));
    }
    all
}

/// Figures over speed and torque; over speed and the bound values if there is one torque and one bound path.
pub fn draw(outcome: &MapOutcome, page: &mut Page) {
    let name = &outcome.head.analysis;
    let axes = AxisNames::new(outcome);
    // Side by side for the report; each on its own for the files.
    let panels = panels(outcome, &axes);
    let mut put = |name: String, figure: Figure| match &panels {
        Some(_) => page.file_figure(name, figure),
        None => page.figure(name, figure),
    };
    for set in outcome.set_names() {
        let maps: Vec<&MapOfSet> = outcome.maps.iter().filter(|m| m.model_set == set).collect();
        for quantity in quantities(outcome) {
            // Without load there is no efficiency.
            let is_known = |m: &&MapOfSet| m.shown.points.iter().any(|p| (quantity.value)(p).is_some());
            if !maps.iter().any(is_known) {
                continue;
            }
            // All maps of a quantity share one colour scale.
            let values = outcome
                .maps
                .iter()
                .flat_map(|m| m.shown.points.iter().filter_map(quantity.value));
            let ends = extremes(values.map(|x| (x, ()))).map(|[low, high]| (low.0, high.0));
            let file = format!("{name}-{set}-{}", quantity.short);
            if let (true, Some(grid)) = (outcome.notes_of_sets.is_some(), &maps[0].shown.grid) {
                put(file, over_bound(name, &quantity, &maps, grid, &axes, ends));
                continue;
            }
            for (i, map) in maps.iter().enumerate() {
                let number = if maps.len() > 1 {
                    format!("-{}", i + 1)
                } else {
                    String::new()
                };
                let oil = map
                    .oil
                    .given()
                    .map_or_else(String::new, |oil| format!(", oil {oil} °C"));
                let title = format!(
                    "{name}: {}{} in {}, models {set}, gear {}{oil}{}",
                    quantity.name,
                    outcome.of.words(),
                    quantity.unit,
                    map.gear,
                    map.bound_words()
                );
                put(
                    format!("{file}{number}"),
                    over_torque(map, &title, &quantity, &axes, &outcome.marks, ends),
                );
            }
        }
    }
    if let Some(panels) = panels {
        page.screen(Screen::Panels(Box::new(panels)));
    }
    limit_maps(outcome, &axes, page);
}

/// Each limited quantity over speed and torque, hatched where it is beyond its limit.
fn limit_maps(outcome: &MapOutcome, names: &AxisNames, page: &mut Page) {
    let name = &outcome.head.analysis;
    for (number, map) in outcome.maps.iter().enumerate() {
        let Some(ShownGrid { axes, places }) = &map.shown.grid else {
            continue;
        };
        for (i, column) in map.limits.iter().enumerate() {
            let reached = outcome.head.study_limits.iter();
            let mut reached =
                reached.filter(|reached| reached.limit == column.name && reached.model_set == map.model_set);
            let Some(limit) = reached.next() else { continue };
            let value = |place: &Option<usize>| {
                let value = *map.shown.points[(*place)?].limits.get(i)?;
                value.is_finite().then_some(value)
            };
            // Lives span decades, most of them far from their limit.
            let life = limit.least.filter(|_| column.unit == "h" && limit.most.is_none());
            let cut = life.map_or(f64::INFINITY, |least| CUT * least);
            let values: Vec<Option<f64>> = places.iter().map(value).collect();
            let is_cut = values.iter().flatten().any(|value| *value > cut);
            let remark = if is_cut {
                format!(", cut off at {CUT} times")
            } else {
                String::new()
            };
            let title = format!(
                "{name}: {}{}, {}{remark}, models {}, gear {}{}",
                column.words,
                in_unit(column.unit),
                bounds(limit),
                map.model_set,
                map.gear,
                map.bound_words()
            );
            let figure = Figure::Map(Map {
                title,
                x: over_speed(axes, names),
                y: torque_axis(axes, names),
                hatched: values
                    .iter()
                    .map(|value| value.is_some_and(|value| limit.is_beyond(value)))
                    .collect(),
                hatching: Hatching::Limit,
                values: values
                    .into_iter()
                    .map(|value| value.map(|value| value.min(cut)))
                    .collect(),
                unit: column.unit.trim_matches('-').to_owned(),
                ..Map::default()
            });
            page.figure(
                format!("{name}-{}-limit-{}-{}", map.model_set, column.name, number + 1),
                figure,
            );
        }
    }
}

/// Factor on a least value at which a picture cuts off larger ones.
const CUT: f64 = 3.0;

/// A quantity over speed and the values of one bound path.
fn over_bound(
    name: &str,
    quantity: &Quantity,
    maps: &[&MapOfSet],
    grid: &ShownGrid,
    names: &AxisNames,
    ends: Option<(f64, f64)>,
) -> Figure {
    let points = || maps.iter().flat_map(|m| &m.shown.points);
    Figure::Map(Map {
        title: format!(
            "{name}: {} in {}, models {}, gear {}, {} Nm",
            quantity.name, quantity.unit, maps[0].model_set, maps[0].gear, grid.axes.torques[0]
        ),
        x: over_speed(&grid.axes, names),
        y: (
            maps[0].bound.keys().next().cloned().unwrap_or_default(),
            maps.iter().flat_map(|m| m.bound.values().map(word)).collect(),
        ),
        values: points().map(quantity.value).collect(),
        unit: quantity.unit.to_owned(),
        best: Some(quantity.best),
        jumps: jumps(quantity.name),
        hatched: points().map(|p| p.outside).collect(),
        ends,
        ..Map::default()
    })
}

/// Names of the axes with the ports of torque and speed.
pub struct AxisNames {
    speed: String,
    torque: String,
}

impl AxisNames {
    fn new(outcome: &MapOutcome) -> Self {
        let conditions = &outcome.head.conditions;
        Self {
            speed: format!("speed at {} in rpm", conditions.speed_at),
            torque: format!("torque at {} in Nm", conditions.torque_at),
        }
    }

    /// Name of the axis of speeds.
    pub fn over_speed(&self, axes: &Axes) -> String {
        let words = axes.shares[0].map_or(self.speed.as_str(), |_| "speed / rated speed");
        words.to_owned()
    }

    /// Name of the axis of torques.
    pub fn over_torque(&self, axes: &Axes) -> String {
        let words = axes.shares[1].map_or(self.torque.as_str(), |_| "torque / rated torque");
        words.to_owned()
    }
}

/// The figure of one quantity of one map.
fn over_torque(
    map: &MapOfSet,
    title: &str,
    quantity: &Quantity,
    names: &AxisNames,
    marks: &[Mark],
    ends: Option<(f64, f64)>,
) -> Figure {
    let value = quantity.value;
    let Some(ShownGrid { axes, places }) = &map.shown.grid else {
        let point = |p: &ShownPoint| Some((p.speed * RPM, p.torque, value(p)?));
        return Figure::Cloud(Cloud {
            title: title.to_owned(),
            axes: (names.speed.clone(), names.torque.clone()),
            points: map.shown.points.iter().filter_map(point).collect(),
            unit: quantity.unit.to_owned(),
            ..Cloud::default()
        });
    };
    let columns = axes.speeds.len();
    let marks: Vec<(f64, f64)> = marks
        .iter()
        .filter(|m| m.gear.as_deref().is_none_or(|g| g == map.gear))
        .map(|m| (speed(axes, m.speed), torque(axes, m.torque)))
        .collect();
    let cells = || places[..axes.torques.len() * columns].iter();
    let solved = |place: &Option<usize>| place.map(|i| &map.shown.points[i]);
    // Without torque there is no efficiency.
    let known = |p: &ShownPoint| {
        if jumps(quantity.name) && p.torque == 0.0 {
            None
        } else {
            value(p)
        }
    };
    Figure::Map(Map {
        title: title.to_owned(),
        x: over_speed(axes, names),
        y: torque_axis(axes, names),
        values: cells().map(|p| solved(p).and_then(known)).collect(),
        unit: quantity.unit.to_owned(),
        best: Some(quantity.best),
        jumps: jumps(quantity.name),
        hatched: cells().map(|p| solved(p).is_some_and(|p| p.outside)).collect(),
        marks,
        ends,
        ..Map::default()
    })
}

/// A speed in the unit of the axis.
pub fn speed(axes: &Axes, speed: f64) -> f64 {
    tidy(axes.shares[0].map_or(speed * RPM, |rating| speed / rating))
}

/// A torque in the unit of the axis.
pub fn torque(axes: &Axes, torque: f64) -> f64 {
    tidy(axes.shares[1].map_or(torque, |rating| torque / rating))
}

/// Name and values of the axis of speeds.
fn over_speed(axes: &Axes, names: &AxisNames) -> (String, Vec<String>) {
    let values = axes.speeds.iter().map(|w| format!("{}", speed(axes, *w)));
    (names.over_speed(axes), values.collect())
}

/// Name and values of the axis of torques.
fn torque_axis(axes: &Axes, names: &AxisNames) -> (String, Vec<String>) {
    let values = axes.torques.iter().map(|t| format!("{}", torque(axes, *t)));
    (names.over_torque(axes), values.collect())
}
