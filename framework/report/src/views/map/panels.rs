//! All maps of an analysis side by side: a row for each model set, a column for each gear, oil temperature and bound value.

use gearloss_studies::analyses::map::{Axes, MapOfSet, MapOutcome, ShownPoint};
use gearloss_studies::analyses::numbers::word;
use gearloss_studies::distinct::distinct;
use gearloss_studies::points::{OilTemperature, SUMS};

use super::pictures::{AxisNames, speed, torque};
use crate::picture::{Best, Breakdown, PanelQuantity, Panels};

/// Panels side by side.
const MOST_COLUMNS: usize = 4;

/// Powers of the drawn lines as shares of the greatest.
const POWERS: [f64; 4] = [0.05, 0.15, 0.4, 0.8];

/// A quantity of the tabs: name, unit, which end is good, and its reader.
type Quantity = (&'static str, &'static str, Option<Best>, fn(&ShownPoint) -> Option<f64>);

/// The panels; absent if a map is a list of points, or the maps have different axes.
pub fn panels(outcome: &MapOutcome, names: &AxisNames) -> Option<Panels> {
    if outcome.notes_of_sets.is_some() {
        return over_bound(outcome, names);
    }
    let first = &outcome.maps.first()?.shown.grid.as_ref()?.axes;
    let same = |map: &MapOfSet| {
        let axes = map.shown.grid.as_ref().map(|grid| &grid.axes);
        axes.is_some_and(|axes| axes.torques == first.torques && axes.speeds == first.speeds)
    };
    if !outcome.maps.iter().all(same) || first.torques.len() < 2 || first.speeds.len() < 2 {
        return None;
    }
    let rows: Vec<String> = outcome.set_names().into_iter().map(str::to_owned).collect();
    let columns = distinct(outcome.maps.iter().map(|map| column(outcome, map)));
    let find = |row: &String, own: &String| {
        let is_own = |map: &&MapOfSet| map.model_set == *row && column(outcome, map) == *own;
        outcome.maps.iter().find(is_own)
    };
    // More columns than fit side by side are shown one after the other.
    let slides = columns.len() > MOST_COLUMNS;
    let placed: Vec<Option<&MapOfSet>> = if slides {
        columns
            .iter()
            .flat_map(|column| rows.iter().map(|row| find(row, column)).collect::<Vec<_>>())
            .collect()
    } else {
        rows.iter()
            .flat_map(|row| columns.iter().map(|column| find(row, column)).collect::<Vec<_>>())
            .collect()
    };
    let (columns, slider) = if slides {
        (vec![String::new()], Some(("shown".to_owned(), columns)))
    } else {
        (columns, None)
    };
    let marks = outcome
        .marks
        .iter()
        .map(|mark| [speed(first, mark.speed), torque(first, mark.torque)].map(f64::to_bits));
    let marks = distinct(marks).into_iter().map(|place| place.map(f64::from_bits));
    Some(Panels {
        title: format!("{}: efficiency and loss over torque and speed", outcome.head.analysis),
        x: (
            names.over_speed(first),
            first.speeds.iter().map(|x| speed(first, *x)).collect(),
        ),
        y: (
            names.over_torque(first),
            first.torques.iter().map(|x| torque(first, *x)).collect(),
        ),
        slider,
        quantities: quantities(outcome)
            .into_iter()
            .map(|(name, unit, best, read)| PanelQuantity {
                name: name.to_owned(),
                unit: unit.to_owned(),
                diverging: false,
                best,
                panels: placed.iter().map(|map| map.map(|map| values(map, read))).collect(),
            })
            .filter(|quantity| quantity.panels.iter().flatten().flatten().any(Option::is_some))
            .collect(),
        outside: placed.iter().map(|map| map.map_or_else(Vec::new, outside)).collect(),
        marks: marks.map(|[x, y]| (x, y, 1.0)).collect(),
        marked: "measured".to_owned(),
        powers: powers(first),
        breakdown: Some(Breakdown {
            names: SUMS.iter().map(|(_, meaning)| (*meaning).to_owned()).collect(),
            panels: placed.iter().map(|map| map.map(losses)).collect(),
        }),
        rows,
        columns,
    })
}

/// Panels over speed and the values of one bound path, one for each set: the maps of a set are its rows.
fn over_bound(outcome: &MapOutcome, names: &AxisNames) -> Option<Panels> {
    let rows: Vec<String> = outcome.set_names().into_iter().map(str::to_owned).collect();
    let of_set = |set: &String| -> Vec<&MapOfSet> {
        let own = outcome.maps.iter().filter(|map| map.model_set == *set);
        own.collect()
    };
    let axes = &outcome.maps.first()?.shown.grid.as_ref()?.axes;
    let words: Vec<String> = of_set(&rows[0])
        .iter()
        .flat_map(|map| map.bound.values().map(word))
        .collect();
    let bound: Option<Vec<f64>> = words.iter().map(|word| word.split(' ').next()?.parse().ok()).collect();
    let bound = bound.filter(|values| values.len() > 1 && axes.speeds.len() > 1)?;
    let path = outcome.maps[0].bound.keys().next()?;
    let unit = words[0]
        .split_once(' ')
        .map_or_else(String::new, |(_, unit)| format!(" in {unit}"));
    let joined = |set: &String, read: &dyn Fn(&MapOfSet) -> Vec<Option<f64>>| {
        Some(of_set(set).into_iter().flat_map(read).collect())
    };
    Some(Panels {
        title: format!("{}: losses over speed and {path}", outcome.head.analysis),
        columns: vec![format!("gear {}, {} Nm", outcome.maps[0].gear, axes.torques[0])],
        x: (
            names.over_speed(axes),
            axes.speeds.iter().map(|x| speed(axes, *x)).collect(),
        ),
        y: (format!("{path}{unit}"), bound),
        quantities: quantities(outcome)
            .into_iter()
            .map(|(name, unit, best, read)| PanelQuantity {
                name: name.to_owned(),
                unit: unit.to_owned(),
                diverging: false,
                best,
                panels: rows.iter().map(|set| joined(set, &|map| values(map, read))).collect(),
            })
            .filter(|quantity| quantity.panels.iter().flatten().flatten().any(Option::is_some))
            .collect(),
        outside: rows
            .iter()
            .map(|set| {
                let all: Vec<bool> = of_set(set)
                    .into_iter()
                    .flat_map(|map| cells(map, |point| point.is_some_and(|point| point.outside)))
                    .collect();
                if all.contains(&true) { all } else { Vec::new() }
            })
            .collect(),
        breakdown: Some(Breakdown {
            names: SUMS.iter().map(|(_, meaning)| (*meaning).to_owned()).collect(),
            panels: rows
                .iter()
                .map(|set| Some(of_set(set).into_iter().flat_map(losses).collect()))
                .collect(),
        }),
        rows,
        ..Panels::default()
    })
}

/// What distinguishes a map from the others of its set.
fn column(outcome: &MapOutcome, map: &MapOfSet) -> String {
    let mut words = Vec::new();
    if outcome.maps.iter().any(|other| other.gear != map.gear) {
        words.push(format!("gear {}", map.gear));
    }
    if let Some(oil) = map
        .oil
        .given()
        .filter(|_| outcome.maps.iter().any(|other| other.oil.given() != map.oil.given()))
    {
        words.push(format!("oil {oil} °C"));
    }
    words.extend(map.bound.iter().map(|(path, value)| {
        let name = path.rsplit('.').next().unwrap_or(path);
        format!("{name} {}", word(value))
    }));
    if words.is_empty() {
        words.push(format!("gear {}", map.gear));
    }
    words.join(", ")
}

fn quantities(outcome: &MapOutcome) -> Vec<Quantity> {
    // Without torque the efficiency is zero, which says nothing and would fill the scale.
    let efficiency: fn(&ShownPoint) -> Option<f64> = |p| p.efficiency.filter(|_| p.torque != 0.0).map(|e| 100.0 * e);
    let mut all: Vec<Quantity> = vec![
        ("efficiency", "%", Some(Best::Highest), efficiency),
        ("loss", "W", Some(Best::Lowest), |p| p.loss),
        ("loss torque", "Nm", Some(Best::Lowest), |p| p.loss_torque),
    ];
    if outcome.maps.iter().any(|map| map.oil == OilTemperature::Balance) {
        all.push(("oil temperature", "°C", Some(Best::Lowest), |p| p.oil));
    }
    all
}

/// The cells of a map in the order of panels; absent outside the envelope.
fn cells<'a, T>(map: &'a MapOfSet, read: impl Fn(Option<&'a ShownPoint>) -> T) -> Vec<T> {
    let places = map.shown.grid.iter().flat_map(|grid| &grid.places);
    places.map(|place| read(place.map(|i| &map.shown.points[i]))).collect()
}

fn values(map: &MapOfSet, read: fn(&ShownPoint) -> Option<f64>) -> Vec<Option<f64>> {
    cells(map, |point| read(point?).filter(|x| x.is_finite()))
}

/// Cells outside a stated range; an empty list if there are none.
fn outside(map: &MapOfSet) -> Vec<bool> {
    let own = cells(map, |point| point.is_some_and(|point| point.outside));
    if own.contains(&true) { own } else { Vec::new() }
}

fn losses(map: &MapOfSet) -> Vec<f32> {
    let own = cells(map, |point| point.map_or([0.0; SUMS.len()], |point| point.sums));
    own.into_iter().flatten().map(|watts| watts as f32).collect()
}

/// Powers with one or two digits; none if an axis is a fraction of a rating.
fn powers(axes: &Axes) -> Vec<f64> {
    if axes.shares != [None, None] {
        return Vec::new();
    }
    let greatest = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let most = greatest(&axes.torques) * greatest(&axes.speeds);
    let round = |power: f64| -> f64 {
        let ten = 10_f64.powf(power.log10().floor());
        let digit = [1.0_f64, 2.0, 5.0, 10.0].into_iter().min_by(|a, b| {
            let far = |step: &f64| (step * ten / power).ln().abs();
            far(a).total_cmp(&far(b))
        });
        digit.unwrap_or(1.0) * ten
    };
    if most > 0.0 {
        distinct(POWERS.map(|share| round(share * most).to_bits()))
            .into_iter()
            .map(f64::from_bits)
            .collect()
    } else {
        Vec::new()
    }
}
