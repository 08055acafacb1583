//! All maps of an analysis side by side: a row for each model set, a column for each gear, oil temperature and bound value.

use gearloss_studies::analyses::map::{Axes, MapOfSet, MapOutcome, ShownPoint};
use gearloss_studies::distinct::distinct;
use gearloss_studies::numbers::word;
use gearloss_studies::points::SUMS;

use super::pictures::{AxisNames, Quantity, quantities, speed, torque};
use crate::figure::jumps;
use crate::picture::{Breakdown, PanelQuantity, Panels};
use crate::text::{last_key, words_of_set};

/// Most panels side by side: a page that is 1440 pixels wide leaves each of them over 300, enough for labelled contours.
const MOST_COLUMNS: usize = 4;

/// Powers of the drawn lines as shares of the greatest: near the axes, through the middle, and in the corner of the greatest.
const POWERS: [f64; 4] = [0.05, 0.15, 0.4, 0.8];

/// Where the maps of an analysis stand.
struct Layout<'a> {
    rows: Vec<String>,
    columns: Vec<String>,
    slider: Option<(String, Vec<String>)>,
    /// Name and values of the vertical coordinate.
    y: (String, Vec<f64>),
    /// Maps of each panel, one above the other; none where there is no map.
    placed: Vec<Vec<&'a MapOfSet>>,
}

/// The panels; absent if a map is a list of points, or the maps have different axes.
pub fn panels(outcome: &MapOutcome, names: &AxisNames) -> Option<Panels> {
    let axes = &outcome.maps.first()?.shown.grid.as_ref()?.axes;
    let (layout, title) = match outcome.notes_of_sets {
        Some(_) => (over_bound(outcome)?, "losses over speed and a value of the gearbox"),
        None => (
            over_torque(outcome, axes, names)?,
            "efficiency and loss over torque and speed",
        ),
    };
    let is_torque = outcome.notes_of_sets.is_none();
    let marks = outcome
        .marks
        .iter()
        .filter(|_| is_torque)
        .map(|mark| [speed(axes, mark.speed), torque(axes, mark.torque)].map(f64::to_bits));
    let marks = distinct(marks).into_iter().map(|place| place.map(f64::from_bits));
    let placed = &layout.placed;
    Some(Panels {
        title: format!("{}: {title}", outcome.head.analysis),
        x: (
            names.over_speed(axes),
            axes.speeds.iter().map(|x| speed(axes, *x)).collect(),
        ),
        quantities: quantities(outcome)
            .into_iter()
            .map(|quantity| PanelQuantity {
                name: quantity.name.to_owned(),
                unit: quantity.unit.to_owned(),
                diverging: false,
                best: Some(quantity.best),
                jumps: jumps(quantity.name),
                panels: placed
                    .iter()
                    .map(|maps| panel(maps, &|map| values(map, &quantity)))
                    .collect(),
            })
            .filter(|quantity| quantity.panels.iter().flatten().flatten().any(Option::is_some))
            .collect(),
        outside: placed.iter().map(|maps| outside(maps)).collect(),
        marks: marks.map(|[x, y]| (x, y)).collect(),
        marked: "measured".to_owned(),
        powers: if is_torque { powers(axes) } else { Vec::new() },
        envelope: if is_torque { envelope(outcome, axes) } else { Vec::new() },
        breakdown: Some(Breakdown {
            names: SUMS.iter().map(|(_, meaning)| (*meaning).to_owned()).collect(),
            panels: placed.iter().map(|maps| panel(maps, &losses)).collect(),
        }),
        rows: layout.rows.iter().map(|set| words_of_set(set)).collect(),
        columns: layout.columns,
        slider: layout.slider,
        y: layout.y,
    })
}

/// One panel for each map, over torque and speed; absent if their axes differ.
fn over_torque<'a>(outcome: &'a MapOutcome, axes: &Axes, names: &AxisNames) -> Option<Layout<'a>> {
    let same = |map: &MapOfSet| {
        let grid = map.shown.grid.as_ref().map(|grid| &grid.axes);
        grid.is_some_and(|shown| shown.torques == axes.torques && shown.speeds == axes.speeds)
    };
    if !outcome.maps.iter().all(same) || axes.torques.len() < 2 || axes.speeds.len() < 2 {
        return None;
    }
    let rows: Vec<String> = outcome.set_names().into_iter().map(str::to_owned).collect();
    let columns = distinct(outcome.maps.iter().map(|map| column(outcome, map)));
    let find = |row: &String, name: &String| -> Vec<&MapOfSet> {
        let is_own = |map: &&MapOfSet| map.model_set == *row && column(outcome, map) == *name;
        outcome.maps.iter().find(is_own).into_iter().collect()
    };
    let y = (
        names.over_torque(axes),
        axes.torques.iter().map(|x| torque(axes, *x)).collect(),
    );
    // More columns than fit side by side are shown one after the other.
    if columns.len() > MOST_COLUMNS {
        let placed = columns
            .iter()
            .flat_map(|column| rows.iter().map(|row| find(row, column)));
        return Some(Layout {
            placed: placed.collect(),
            columns: vec![String::new()],
            slider: Some(("map".to_owned(), columns)),
            rows,
            y,
        });
    }
    let placed = rows
        .iter()
        .flat_map(|row| columns.iter().map(|column| find(row, column)));
    Some(Layout {
        placed: placed.collect(),
        slider: None,
        columns,
        rows,
        y,
    })
}

/// One panel for each set, over speed and the values of one bound path: the maps of a set are its rows. Absent if the values are no numbers.
fn over_bound(outcome: &MapOutcome) -> Option<Layout<'_>> {
    let rows: Vec<String> = outcome.set_names().into_iter().map(str::to_owned).collect();
    let placed: Vec<Vec<&MapOfSet>> = rows
        .iter()
        .map(|set| outcome.maps.iter().filter(|map| map.model_set == *set).collect())
        .collect();
    let first = outcome.maps.first()?;
    let axes = &first.shown.grid.as_ref()?.axes;
    let path = first.bound.keys().next()?;
    let words: Vec<String> = placed
        .first()?
        .iter()
        .flat_map(|map| map.bound.values().map(word))
        .collect();
    let bound: Option<Vec<f64>> = words.iter().map(|word| word.split(' ').next()?.parse().ok()).collect();
    let bound = bound.filter(|values| values.len() > 1 && axes.speeds.len() > 1)?;
    let unit = words.first()?.split_once(' ');
    let unit = unit.map_or_else(String::new, |(_, unit)| format!(" in {unit}"));
    Some(Layout {
        rows,
        columns: vec![format!("gear {}, {} Nm", first.gear, axes.torques.first()?)],
        slider: None,
        y: (format!("{path}{unit}"), bound),
        placed,
    })
}

/// The cells of the maps of a panel; absent where there is no map.
fn panel<T>(maps: &[&MapOfSet], read: &dyn Fn(&MapOfSet) -> Vec<T>) -> Option<Vec<T>> {
    (!maps.is_empty()).then(|| maps.iter().flat_map(|map| read(map)).collect())
}

/// What distinguishes a map from the others of its set.
fn column(outcome: &MapOutcome, map: &MapOfSet) -> String {
    let mut words = Vec::new();
    if outcome.maps.iter().any(|other| other.gear != map.gear) {
        words.push(format!("gear {}", map.gear));
    }
    // A bound oil temperature is among the bound values.
    let is_bound = map.bound.iter().any(|(path, _)| path.ends_with("thermal.oil"));
    let differs = outcome.maps.iter().any(|other| other.oil.given() != map.oil.given());
    if let Some(oil) = map.oil.given().filter(|_| differs && !is_bound) {
        words.push(format!("oil {oil} °C"));
    }
    words.extend(map.bound.iter().map(|(path, value)| {
        let name = last_key(path);
        format!("{name} {}", word(value))
    }));
    if words.is_empty() {
        words.push(format!("gear {}", map.gear));
    }
    words.join(", ")
}

/// The cells of a map in the order of panels; absent outside the envelope.
fn cells<'a, T>(map: &'a MapOfSet, read: impl Fn(Option<&'a ShownPoint>) -> T) -> Vec<T> {
    let places = map.shown.grid.iter().flat_map(|grid| &grid.places);
    places.map(|place| read(place.map(|i| &map.shown.points[i]))).collect()
}

fn values(map: &MapOfSet, quantity: &Quantity) -> Vec<Option<f64>> {
    // Without torque the efficiency is zero, which says nothing and would fill the scale.
    let says = |point: &&ShownPoint| point.torque != 0.0 || quantity.name != "efficiency";
    cells(map, |point| {
        (quantity.value)(point.filter(says)?).filter(|x| x.is_finite())
    })
}

/// Cells outside a stated range; an empty list if there are none.
fn outside(maps: &[&MapOfSet]) -> Vec<bool> {
    let outside = panel(maps, &|map| {
        cells(map, |point| point.is_some_and(|point| point.outside))
    });
    outside.filter(|cells| cells.contains(&true)).unwrap_or_default()
}

fn losses(map: &MapOfSet) -> Vec<f32> {
    let sums = cells(map, |point| point.map_or([0.0; SUMS.len()], |point| point.sums));
    sums.into_iter().flatten().map(|watts| watts as f32).collect()
}

/// Maximum torque over speed, as the axes state them.
fn envelope(outcome: &MapOutcome, axes: &Axes) -> Vec<(f64, f64)> {
    let Some(envelope) = &outcome.envelope else {
        return Vec::new();
    };
    let corners = envelope.speed.iter().zip(&envelope.torque);
    corners
        .map(|(at, most)| (speed(axes, at.abs()), torque(axes, most.abs())))
        .collect()
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
