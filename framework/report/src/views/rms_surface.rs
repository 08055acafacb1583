//! Surfaces of the difference from a measurement: a table, a map and the minimum.

mod summary;

use gearloss_numerics::inference::Side;
use gearloss_studies::analyses::rms_surface::{AxisOfSurface, Flat, RmsSurfaceOutcome, SurfaceOfSet};

use crate::page::Page;
use crate::register_view;
use crate::text::{TextTable, number, spread};
use crate::{Figure, Map};

register_view!(RmsSurfaceOutcome, show);

/// Maximum number of points that are listed.
const NAMED: usize = 5;

fn show(outcome: &RmsSurfaceOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    if let Some(first) = outcome.surfaces.first() {
        for note in &outcome.measured_notes {
            page.line(format!("{name}: {}: {note}", first.file));
        }
        left_out(name, outcome.measured_points, first, page);
    }
    for surface in &outcome.surfaces {
        let (what, unit) = surface.quantity.words(outcome.difference);
        let title = format!(
            "{name}: {what} of {} minus measurement, rms in {unit}",
            surface.model_set
        );
        table(&title, surface, page);
        let set = &surface.model_set;
        page.verdict(format!("{name}: `{set}`: {}", verdict(surface, unit)));
        page.line("");
        page.figure(format!("{name}-{set}"), map(title, unit, surface));
    }
}

/// Lists the omitted points.
fn left_out(name: &str, measured_points: usize, surface: &SurfaceOfSet, page: &mut Page) {
    let all = &surface.left_out;
    if all.is_empty() {
        return;
    }
    page.line(format!(
        "{name}: {} of {measured_points} points have no value at some pair and are omitted at all pairs:",
        all.len()
    ));
    for point in all.iter().take(NAMED) {
        page.line(format!("  line {}: {}", point.line, point.reason));
    }
    if all.len() > NAMED {
        page.line(format!("  and {} more", all.len() - NAMED));
    }
}

/// The surface and the pairs without a value.
fn table(title: &str, surface: &SurfaceOfSet, page: &mut Page) {
    let SurfaceOfSet { x, y, pairs, .. } = surface;
    page.line(format!("{title} over {} points, over {}", surface.points, x.path));
    let table = TextTable::of(spread(y.values.len()))
        .column(&y.path, |j| &y.words[*j])
        .each(spread(x.values.len()), |table, i| {
            table.column(&x.words[i], |j| number(pairs[j * x.values.len() + i].rms, 3))
        });
    page.table(table.finish());
    let without = pairs
        .iter()
        .enumerate()
        .filter_map(|(i, pair)| Some((i, pair.reason.as_ref()?)));
    for (n, (i, why)) in without.enumerate() {
        if n == NAMED {
            page.line("further pairs have no value");
            break;
        }
        let at = |axis: &AxisOfSurface, place: usize| format!("{} = {}", axis.path, axis.words[place]);
        let columns = x.values.len();
        page.line(format!(
            "no value at {}, {}: {why}",
            at(x, i % columns),
            at(y, i / columns)
        ));
    }
}

/// The position of the minimum and its uncertainty.
fn verdict(surface: &SurfaceOfSet, unit: &str) -> String {
    let (least, axes) = (&surface.least_place, [&surface.x, &surface.y]);
    let mut places = Vec::new();
    let (mut on, mut nothing) = (Vec::new(), Vec::new());
    for (k, axis) in axes.iter().enumerate() {
        let (path, value) = (&axis.path, &axis.words[least.place[k]]);
        if !least.depends[k] {
            nothing.push(path.as_str());
            continue;
        }
        places.push(format!("{path} = {value}"));
        match least.ends[k] {
            Some(Side::Upper) => on.push(format!("the upper end of {path}: the minimum may be above {value}")),
            Some(Side::Lower) => on.push(format!("the lower end of {path}: the minimum may be below {value}")),
            None => {}
        }
    }
    let mut said = format!("minimum rms {:.3} {unit}", least.value);
    if places.is_empty() {
        return format!("{said} everywhere: {} have no effect", nothing.join(" and "));
    }
    said.push_str(&format!(" at {}", places.join(", ")));
    if on.is_empty() {
        said.push_str(", inside the surface");
    } else {
        said.push_str(&format!(", at {}", on.join(", and at ")));
    }
    for path in &nothing {
        said.push_str(&format!("; {path} has no effect"));
    }
    let ranges = |flat: &Flat| {
        let flat_ranges = (0..2).filter(|k| least.depends[*k]);
        let flat_ranges: Vec<String> = flat_ranges.map(|k| range(axes[k], flat[k])).collect();
        flat_ranges.join(", ")
    };
    said.push_str(&format!("; within 5 % of the minimum: {}", ranges(&least.close)));
    if let (Some(unseen), Some(accuracy)) = (&least.unseen, surface.accuracy) {
        said.push_str(&format!(
            "; within the accuracy of one measurement, {accuracy:.3}: {}",
            ranges(unseen)
        ));
    }
    said
}

/// A range of values along an axis as text.
fn range(axis: &AxisOfSurface, [low, high]: [usize; 2]) -> String {
    let whole = low == 0 && high + 1 == axis.values.len();
    let path = &axis.path;
    match (whole, low == high) {
        (true, _) => format!("any {path}"),
        (_, true) => format!("{path} {} only", axis.words[low]),
        _ => format!("{path} {} to {}", axis.words[low], axis.words[high]),
    }
}

fn map(title: String, unit: &str, surface: &SurfaceOfSet) -> Figure {
    let SurfaceOfSet { x, y, pairs, .. } = surface;
    let least = &surface.least_place;
    Figure::Map(Map {
        title,
        x: (x.path.clone(), x.words.clone()),
        y: (y.path.clone(), y.words.clone()),
        values: pairs.iter().map(|pair| pair.rms).collect(),
        unit: unit.to_owned(),
        crossed: Some((
            least.place[1] * x.values.len() + least.place[0],
            format!("minimum, {:.3}", least.value),
        )),
        ..Map::default()
    })
}
