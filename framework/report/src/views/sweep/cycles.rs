//! A sweep over cycles: mean loss and consumption by value, and why they differ.

use gearloss_studies::analyses::sweep::{CycleOfSweep, SweepOutcome};
use gearloss_studies::duty::Consumption;
use gearloss_studies::numbers::word;

use super::numbers;
use crate::figure::Best;
use crate::names::{cycle, listed, quantity};
use crate::page::Page;
use crate::plot::{Bar, Line, Stroke};
use crate::text::{TextTable, number, of_set, short, with_printed_units};
use crate::{Figure, Map};

/// The results of one model set over one cycle.
struct Swept<'a> {
    set: &'a str,
    cycle: &'a str,
    values: Vec<&'a CycleOfSweep>,
}

pub(super) fn show(outcome: &SweepOutcome, page: &mut Page) {
    let sets = outcome.notes.len();
    let mut words = Vec::new();
    for swept in all(outcome) {
        words.push(format!("{}{}", of_set(swept.set, sets), sentence(&swept, page)));
        table(outcome, &swept, page);
        figures(outcome, &swept, page);
    }
    let first = outcome.cycles.first();
    let second = first.and_then(|value| Some(quantity(&value.second.as_ref()?.path)));
    let paths = first.map(|value| quantity(&value.path)).into_iter().chain(second);
    let paths = listed(&paths.collect::<Vec<_>>());
    page.headline = Some(format!("By {paths}: {}", words.join("; ")));
}

/// Every set over every cycle.
fn all(outcome: &SweepOutcome) -> Vec<Swept<'_>> {
    let mut all: Vec<Swept<'_>> = Vec::new();
    for value in &outcome.cycles {
        match all
            .iter_mut()
            .find(|known| known.set == value.model_set && known.cycle == value.cycle)
        {
            Some(known) => known.values.push(value),
            None => all.push(Swept {
                set: &value.model_set,
                cycle: &value.cycle,
                values: vec![value],
            }),
        }
    }
    all
}

/// The consumption of a value.
fn net(value: &CycleOfSweep) -> Option<f64> {
    Some(value.consumption.as_ref()?.consumption_kwh_per_100_km)
}

/// A value in words.
fn at(value: &CycleOfSweep) -> String {
    let second = value
        .second
        .as_ref()
        .map(|second| format!(" and {}", word(&second.value)));
    with_printed_units(&format!("{}{}", word(&value.value), second.unwrap_or_default()))
}

/// The best value of a cycle: by consumption if it is known, otherwise by loss.
fn sentence(swept: &Swept<'_>, page: &mut Page) -> String {
    let of = cycle(swept.cycle);
    let (mut lossy, mut frugal) = (swept.values[0], swept.values[0]);
    let (mut worst, mut thirsty) = (lossy, frugal);
    for value in swept.values.iter().copied() {
        if value.mean_loss_w < lossy.mean_loss_w {
            lossy = value;
        }
        if value.mean_loss_w > worst.mean_loss_w {
            worst = value;
        }
        if net(value) < net(frugal) {
            frugal = value;
        }
        if net(value) > net(thirsty) {
            thirsty = value;
        }
    }
    let detail = format!("{}; {} W at {}", at(lossy), short(worst.mean_loss_w), at(worst));
    page.key_figure(
        &format!("lowest mean loss over {of}"),
        short(lossy.mean_loss_w),
        "W",
        detail,
    );
    let loss = format!(
        "lowest mean loss over {of} at {} with {} W instead of {} W at {}",
        at(lossy),
        short(lossy.mean_loss_w),
        short(worst.mean_loss_w),
        at(worst)
    );
    let (Some(least), Some(most)) = (net(frugal), net(thirsty)) else {
        return loss;
    };
    let detail = format!("{}; {} kWh/100 km at {}", at(frugal), short(most), at(thirsty));
    page.key_figure(
        &format!("lowest consumption over {of}"),
        short(least),
        "kWh/100 km",
        detail,
    );
    if let (Some(a), Some(b)) = (&lossy.consumption, &frugal.consumption)
        && lossy.places != frugal.places
    {
        page.careful.push(format!(
            "{of}: the lowest loss is not the lowest consumption: at {} the gearbox loses {} W and the vehicle uses {} kWh/100 km, at {} {} W \
             and {} kWh/100 km; the machine loses {} and {} kWh/100 km, the gearbox {} and {}",
            at(lossy),
            short(lossy.mean_loss_w),
            short(a.consumption_kwh_per_100_km),
            at(frugal),
            short(frugal.mean_loss_w),
            short(b.consumption_kwh_per_100_km),
            short(a.machine_kwh_per_100_km),
            short(b.machine_kwh_per_100_km),
            short(a.transmission_kwh_per_100_km),
            short(b.transmission_kwh_per_100_km),
        ));
    }
    format!(
        "lowest consumption over {of} at {} with {} kWh/100 km instead of {} kWh/100 km at {}",
        at(frugal),
        short(least),
        short(most),
        at(thirsty)
    )
}

fn table(outcome: &SweepOutcome, swept: &Swept<'_>, page: &mut Page) {
    let first = swept.values[0];
    let consumption: [(&str, fn(&Consumption) -> Option<f64>, usize); 6] = [
        ("consumption kWh/100 km", |c| Some(c.consumption_kwh_per_100_km), 4),
        ("range km", |c| c.range_km, 1),
        ("transmission", |c| Some(c.transmission_kwh_per_100_km), 4),
        ("machine", |c| Some(c.machine_kwh_per_100_km), 4),
        ("brakes", |c| Some(c.brakes_kwh_per_100_km), 4),
        ("battery", |c| Some(c.battery_kwh_per_100_km), 4),
    ];
    let has_consumption = first.consumption.is_some();
    let table = TextTable::of(&swept.values)
        .column(&first.path, |value| word(&value.value))
        .each(&first.second, |table, second| {
            table.column(&second.path, |value| {
                value
                    .second
                    .as_ref()
                    .map(|second| word(&second.value))
                    .unwrap_or_default()
            })
        })
        .column("mean loss W", |value| number(Some(value.mean_loss_w), 2))
        .each(
            consumption.iter().filter(|_| has_consumption),
            |table, (head, read, digits)| {
                table.column(head, |value| number(value.consumption.as_ref().and_then(read), *digits))
            },
        )
        .each(outcome.cycle_limits.iter().enumerate(), |table, (i, limit)| {
            table.column(format!("{} {}", limit.limit, limit.unit), |value| {
                number(value.limited.get(i).copied().flatten(), 3)
            })
        });
    page.table(
        table
            .finish()
            .titled(format!("{}, models {}", cycle(swept.cycle), swept.set)),
    );
}

/// Name of a file, quantity with its unit, and its value.
type Quantity<'q> = (&'q str, String, &'q dyn Fn(&CycleOfSweep) -> Option<f64>);

/// A quantity over two paths.
fn map_of(swept: &Swept<'_>, title: String, unit: &str, read: &dyn Fn(&CycleOfSweep) -> Option<f64>) -> Map {
    let count = |side: usize| {
        let places = swept.values.iter().map(|value| value.places[side] + 1);
        places.max().unwrap_or(0)
    };
    let cell = |places| swept.values.iter().find(|value| value.places == places);
    let places = (0..count(1)).flat_map(|k| (0..count(0)).map(move |i| [i, k]));
    let words = |side: usize, of: &dyn Fn(&CycleOfSweep) -> String| {
        let value = |place| swept.values.iter().find(|value| value.places[side] == place);
        let words = (0..count(side)).filter_map(|place| value(place).map(|value| of(value)));
        words.collect::<Vec<String>>()
    };
    let second = |value: &CycleOfSweep| {
        let second = value.second.as_ref();
        second.map_or_else(String::new, |second| word(&second.value))
    };
    let first = swept.values[0];
    let path = first
        .second
        .as_ref()
        .map_or_else(String::new, |second| second.path.clone());
    Map {
        title,
        x: (first.path.clone(), words(0, &|value| word(&value.value))),
        y: (path, words(1, &second)),
        values: places
            .map(|places| cell(places).and_then(|value| read(value)))
            .collect(),
        unit: unit.to_owned(),
        best: Some(Best::Lowest),
        ..Map::default()
    }
}

/// Consumption and loss over the values: lines over numbers, bars of their parts over names, maps over two paths.
fn figures(outcome: &SweepOutcome, swept: &Swept<'_>, page: &mut Page) {
    let name = &outcome.head.analysis;
    let of = cycle(swept.cycle);
    let several = if outcome.notes.len() > 1 {
        format!("-{}", swept.set.replace('/', "-"))
    } else {
        String::new()
    };
    let file = |what: &str| format!("{name}-{what}-{}{several}", swept.cycle);
    let first = swept.values[0];
    let quantities: [Quantity<'_>; 2] = [
        ("consumption", "consumption in kWh/100 km".to_owned(), &net),
        ("loss", "mean loss in W".to_owned(), &|value| Some(value.mean_loss_w)),
    ];
    let quantities = quantities.into_iter().filter(|(.., read)| read(first).is_some());
    let words: Vec<String> = swept.values.iter().map(|value| word(&value.value)).collect();
    if first.second.is_some() {
        for (what, title, read) in quantities {
            let title = format!("{name}: {title}, {of}, models {}", swept.set);
            let unit = if what == "loss" { "W" } else { "kWh/100 km" };
            page.figure(file(what), Figure::Map(map_of(swept, title, unit, read)));
        }
        return;
    }
    if let Some(places) = numbers(&words) {
        for (what, title, read) in quantities {
            let points = places.iter().zip(&swept.values);
            let line = Line {
                name: format!("{}: {of}", swept.set),
                points: points.map(|(x, value)| Some((*x, read(value)?))).collect(),
                stroke: Stroke::Marked,
            };
            let figure = Figure::Lines {
                title: format!("{name}: {title}"),
                x: first.path.clone(),
                y: title,
                lines: vec![line],
            };
            page.figure(file(what), figure);
        }
        return;
    }
    let mut bars =
        |what: &str, height: &str, names: Vec<String>, read: &dyn Fn(&CycleOfSweep) -> Option<(Vec<f64>, f64)>| {
            let bar = |value: &&CycleOfSweep| {
                let (shares, sum) = read(value)?;
                Some(Bar {
                    label: word(&value.value),
                    shares,
                    above: short(sum),
                    ..Bar::default()
                })
            };
            let bars: Vec<Bar> = swept.values.iter().filter_map(bar).collect();
            if !bars.is_empty() {
                let figure = Figure::Bars {
                    title: format!("{name}: {height}, {of}"),
                    over: quantity(&first.path),
                    height: height.to_owned(),
                    names,
                    bars,
                };
                page.figure(file(what), figure);
            }
        };
    let parts = ["vehicle", "transmission", "machine", "brakes", "auxiliaries", "battery"].map(str::to_owned);
    bars("consumption", "consumption in kWh/100 km", parts.to_vec(), &|value| {
        let c = value.consumption.as_ref()?;
        let parts = vec![
            c.wheels_kwh_per_100_km,
            c.transmission_kwh_per_100_km,
            c.machine_kwh_per_100_km,
            c.brakes_kwh_per_100_km,
            c.auxiliaries_kwh_per_100_km,
            c.battery_kwh_per_100_km,
        ];
        // A route downhill gives energy to the vehicle, which is no height of a bar.
        parts
            .iter()
            .all(|part| *part >= 0.0)
            .then_some((parts, c.consumption_kwh_per_100_km))
    });
    bars("loss", "mean loss in W", first.shares.clone(), &|value| {
        Some((value.mean_losses_w.clone(), value.mean_loss_w))
    });
}
