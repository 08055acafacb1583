//! Maps: a table of the efficiency over torque and speed, tables for other programs, figures.

mod over_bound;
mod panels;
mod pictures;
mod summary;

use gearloss_studies::analyses::cycle::Criterion;
use gearloss_studies::analyses::map::{MapOfSet, MapOutcome, ShownGrid, ShownPoint};
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::points::OilTemperature;

use crate::exports;
use crate::machines;
use crate::page::Page;
use crate::register_view;
use crate::text::{TextTable, fixed, number, short, spread, words_of_set};

register_view!(MapOutcome, show);

fn show(outcome: &MapOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for note in &outcome.about_points {
        page.line(format!("{name}: {note}"));
    }
    match &outcome.notes_of_sets {
        Some(sets) => over_bound::show(outcome, sets, page),
        None => outcome.maps.iter().for_each(|map| show_map(name, map, page)),
    }
    outside_maps(outcome, page);
    exports::add(outcome, page);
    for note in &outcome.about_measured {
        page.line(format!("{name}: measured: {note}"));
    }
    if let Some(thinned) = outcome.maps.iter().find_map(|map| map.shown.thinned()) {
        page.line(format!("{name}: {thinned}"));
    }
    pictures::draw(outcome, page);
}

/// Machines outside their maps: maps with the same caution in one sentence.
fn outside_maps(outcome: &MapOutcome, page: &mut Page) {
    let mut cautions: Vec<(String, Vec<String>)> = Vec::new();
    for map in &outcome.maps {
        let at = format!("gear {}, {}", map.gear, words_of_set(&map.model_set));
        for text in map.outside_maps.iter().map(machines::outside_map) {
            match cautions.iter_mut().find(|(known, _)| *known == text) {
                Some((_, places)) => places.push(at.clone()),
                None => cautions.push((text, vec![at.clone()])),
            }
        }
    }
    let several = outcome.maps.len() > 1;
    let sentence = |(text, places): (String, Vec<String>)| {
        if several {
            format!("{}: {text}", places.join("; "))
        } else {
            text
        }
    };
    page.careful.extend(cautions.into_iter().map(sentence));
}

/// A map as a table.
fn show_map(name: &str, map: &MapOfSet, page: &mut Page) {
    page.line(format!(
        "{name}: efficiency{} in %, gear {}, models {}{}",
        map.of.words(),
        map.gear,
        map.model_set,
        map.bound_words()
    ));
    if let Some(best) = &map.best_gears {
        let parts = best.gears.iter().map(|gear| {
            let share = short(100.0 * gear.share);
            let points = if gear.points == 1 { "point" } else { "points" };
            format!("{} at {} {points} ({share} %)", gear.gear, gear.points)
        });
        let compared = match best.criterion {
            Criterion::MachinePower => "the power of the machine",
            Criterion::GearboxLoss => "the loss of the gearbox, because no machine is described",
        };
        let parts: Vec<String> = parts.collect();
        page.line(format!("best gear of each point by {compared}: {}", parts.join(", ")));
    }
    let percent = |p: &ShownPoint| p.efficiency.map(|e| 100.0 * e);
    if let Some(grid) = &map.shown.grid {
        page.table(table(map, grid, &percent));
        if map.oil == OilTemperature::Balance {
            page.line("oil temperature in degC");
            page.table(table(map, grid, &|p| p.oil));
        }
    } else {
        let points = &map.shown.points;
        let table = TextTable::of(spread(points.len()).into_iter().map(|i| &points[i]))
            .column("torque Nm", |p| tidy(p.torque).to_string())
            .column("speed rpm", |p| fixed(p.speed * RPM, 0))
            .column("oil degC", |p| number(p.oil, 1))
            .column("efficiency %", |p| number(percent(p), 2))
            .column("loss W", |p| number(p.loss, 2));
        page.table(table.finish());
    }
    if let Some(thinned) = thinned(map) {
        page.line(thinned);
    }
    page.line("");
}

/// Notes that the table shows only some of the points.
fn thinned(map: &MapOfSet) -> Option<String> {
    let (torques, speeds) = map.shown.size();
    let shown = spread(torques).len() * spread(speeds).len();
    (shown < torques * speeds).then(|| format!("shown: {shown} of {} points; the files contain all", torques * speeds))
}

fn table(map: &MapOfSet, grid: &ShownGrid, quantity: &dyn Fn(&ShownPoint) -> Option<f64>) -> TextTable {
    let ShownGrid { axes, places } = grid;
    let speeds: Vec<f64> = axes.speeds.iter().map(|speed| speed * RPM).collect();
    let value = |t: usize, s: usize| quantity(&map.shown.points[places[t * speeds.len() + s]?]);
    TextTable::over_grid(&axes.torques, &speeds, |t, s| number(value(t, s), 2))
}
