//! Cycles: tables of losses, energy and temperatures; figures of stacked losses, temperatures, torque and speed over time.

mod gears;
mod pictures;
mod summary;

use gearloss_studies::analyses::cycle::{
    BandOfDuty, CycleOutcome, DutyOfSet, HeatOfDuty, IntervalOfDuty, RatedOverTime,
};

use gearloss_studies::duty::Consumption;

use crate::Figure;
use crate::exports;
use crate::machines::cautions_of_cycle;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, last_key, number, short, signed, significant};

register_view!(CycleOutcome, show);

fn show(outcome: &CycleOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for duty in &outcome.cycles {
        text(name, duty, page);
        figures(name, duty, page);
        ratings(name, duty, page);
    }
    exports::network::add(outcome, page);
    exports::bearing_loads::add(outcome, page);
    pictures::draw(outcome, page);
}

fn text(name: &str, duty: &DutyOfSet, page: &mut Page) {
    let (energy, loss) = (&duty.energy, duty.energy.loss_j);
    page.line(format!(
        "{name}: {}, {} s, models {}: mean loss {} W, {} kJ",
        duty.cycle,
        significant(duty.duration_s),
        duty.model_set,
        significant(duty.mean_loss_w),
        significant(1e-3 * loss),
    ));
    if let Some(about) = &duty.about {
        page.line(format!("  {about}"));
    }
    for note in &duty.file_notes {
        page.line(format!("  note: {note}"));
    }
    if let Some(reference) = &duty.reference {
        let source = reference.source.as_deref().unwrap_or("reference");
        let ratio = 100.0 * (duty.mean_loss_w / reference.mean_loss_w - 1.0);
        page.line(format!(
            "  {source}: {} W; calculated {ratio:+.1} %",
            significant(reference.mean_loss_w)
        ));
    }
    let percent = |joule: f64| if loss > 0.0 { 100.0 * joule / loss } else { 0.0 };
    let table = TextTable::of(0..duty.shares.len())
        .column("loss", |k| &duty.shares[*k])
        .column("mean W", |k| format!("{:.2}", duty.mean_losses_w[*k]))
        .column("kJ", |k| format!("{:.2}", 1e-3 * duty.energies_j[*k]))
        .column("share %", |k| format!("{:.1}", percent(duty.energies_j[*k])));
    page.table(table.finish());
    if let Some(band) = &duty.bands {
        band_text(duty, band, page);
    }
    page.line(format!(
        "  energy in {} kJ, out {} kJ, energy balance error {:.1e} of the input",
        significant(1e-3 * energy.input_j),
        significant(1e-3 * energy.output_j),
        energy.residual_share
    ));
    let efficiencies = [
        ("drive", energy.drive_efficiency),
        ("recuperation", energy.recuperation_efficiency),
    ];
    for (what, efficiency) in efficiencies {
        if let Some(share) = efficiency {
            page.line(format!("  efficiency in {what}: {:.2} %", 100.0 * share));
        }
    }
    if let Some(per) = &duty.per_distance {
        page.line(format!(
            "  over {} km: {} Wh/km, {} kWh/100 km",
            significant(per.distance_km),
            significant(per.loss_wh_per_km),
            significant(per.loss_kwh_per_100_km)
        ));
    }
    if let Some(consumption) = &duty.consumption {
        consumption_text(duty, consumption, page);
    }
    gears::text(duty, page);
    if energy.brakes_j > 0.0 {
        page.line(format!(
            "  dissipated in brakes: {} kJ",
            significant(1e-3 * energy.brakes_j)
        ));
    }
    if let Some([least, greatest]) = duty.inclination_deg {
        page.line(format!(
            "  the oil is inclined by grade and acceleration from {least:.1} to {greatest:.1} deg"
        ));
    }
    if let Some(heat) = &duty.heat {
        heat_text(duty, heat, page);
    }
    for text in duty
        .machines
        .iter()
        .flat_map(|machine| cautions_of_cycle(machine, duty.duration_s))
    {
        page.line(format!("  note: {text}"));
    }
    page.line(format!(
        "  {} intervals, {} steps, {} evaluations",
        duty.intervals, duty.steps, duty.evaluations
    ));
    page.line("");
}

/// Consumption, recuperation and range of the vehicle.
fn consumption_text(duty: &DutyOfSet, consumption: &Consumption, page: &mut Page) {
    page.line(format!(
        "  battery: {} kWh/100 km drawn, {} recuperated, consumption {} kWh/100 km{}",
        short(consumption.drawn_kwh_per_100_km),
        short(consumption.recuperated_kwh_per_100_km),
        short(consumption.consumption_kwh_per_100_km),
        if consumption.includes_motor {
            ""
        } else {
            ", without losses of the motor"
        }
    ));
    let inverter = if consumption.inverter_kwh_per_100_km > 0.0 {
        format!(", inverter {}", short(consumption.inverter_kwh_per_100_km))
    } else {
        String::new()
    };
    let share = |of: Option<f64>| of.map_or_else(|| "-".to_owned(), |of| format!("{} %", short(100.0 * of)));
    let shifts = consumption.shifts_kwh_per_100_km;
    let shifts = shifts.map_or_else(String::new, |shifts| format!(", shifts {}", short(shifts)));
    page.line(format!(
        "  of it in kWh/100 km: vehicle {}, transmission {}, machine {}{}, brakes {}, auxiliaries {}, battery {}{shifts}; system efficiency {}, \
         recuperated {} of the braking energy",
        short(consumption.wheels_kwh_per_100_km),
        short(consumption.transmission_kwh_per_100_km),
        short(consumption.machine_kwh_per_100_km),
        inverter,
        short(consumption.brakes_kwh_per_100_km),
        short(consumption.auxiliaries_kwh_per_100_km),
        short(consumption.battery_kwh_per_100_km),
        share(consumption.system_efficiency),
        share(consumption.recuperated_share)
    ));
    if consumption.motor_beyond_map && duty.machines.is_empty() {
        page.line("  note: the motor was outside its map, the loss at the edge of the map is used");
    }
    if consumption.machine_limited > 0 {
        page.line(format!(
            "  limited: the machine is at its envelope in {} intervals; the vehicle lacks {} kWh/100 km at its wheels",
            consumption.machine_limited,
            short(consumption.lacking_kwh_per_100_km)
        ));
    }
    if consumption.battery_limited > 0 {
        page.line(format!(
            "  limited: the battery is at its limit in {} intervals and lacks {} kWh/100 km",
            consumption.battery_limited,
            short(consumption.shortfall_kwh_per_100_km)
        ));
    }
    let Some(range) = consumption.range_km else {
        page.line("  no range: more energy is recuperated than drawn");
        return;
    };
    let lost = consumption
        .range_lost_in_transmission_km
        .map(|km| format!("; the losses of the transmission cost {} km", short(km)));
    let difference = consumption
        .range_difference_km
        .map(|km| format!("; {} km against the first model set", signed(km)));
    page.line(format!(
        "  range {} km{}{}",
        short(range),
        lost.unwrap_or_default(),
        difference.unwrap_or_default()
    ));
}

/// The uncertainty band of the loss and of its shares, and the correlation with the inputs.
fn band_text(duty: &DutyOfSet, band: &BandOfDuty, page: &mut Page) {
    let [low, middle, high] = band.mean_loss_w;
    let mut line = format!(
        "  {} samples of {} inputs: mean loss {low:.1} to {high:.1} W (95 %), median {middle:.1} W",
        band.samples,
        band.inputs.len()
    );
    if let (Some(reference), Some(inside)) = (&duty.reference, band.reference_inside) {
        line.push_str(&format!(
            "; {} W is {} the band",
            reference.mean_loss_w,
            if inside { "inside" } else { "outside" }
        ));
    }
    page.line(line);
    if let Some([low, middle, high]) = band.consumption_kwh_per_100_km {
        page.line(format!(
            "  consumption {} to {} kWh/100 km (95 %), median {}",
            short(low),
            short(high),
            short(middle)
        ));
    }
    if let Some(reason) = &band.first_failure {
        page.line(format!("  {} further samples have no value: {reason}", band.failed));
    }
    let table = TextTable::of(duty.shares.iter().zip(&band.mean_losses_w))
        .column("loss", |(name, _)| *name)
        .column("2.5 % W", |(_, band)| format!("{:.2}", band[0]))
        .column("median W", |(_, band)| format!("{:.2}", band[1]))
        .column("97.5 % W", |(_, band)| format!("{:.2}", band[2]));
    page.table(table.finish());
    let table = TextTable::of(&band.inputs)
        .column("input", |input| &input.input)
        .column("correlation with the mean loss", |input| {
            number(input.correlation_with_mean_loss, 3)
        });
    page.table(table.finish());
}

/// Heat and temperatures.
fn heat_text(duty: &DutyOfSet, heat: &HeatOfDuty, page: &mut Page) {
    let kj = |joule: f64| format!("{} kJ", significant(1e-3 * joule));
    let mut parts = vec![format!("losses {}", kj(duty.energy.loss_j))];
    if let Some(motors) = duty.energy.motors_j {
        parts.push(format!("motors {}", kj(motors)));
    }
    if heat.inverters_j != 0.0 {
        parts.push(format!("inverters {}", kj(heat.inverters_j)));
    }
    if heat.sources_j != 0.0 {
        parts.push(format!("sources {}", kj(heat.sources_j)));
    }
    let mut paths = vec![format!("stored {}", kj(heat.stored_j))];
    for node in &heat.taken {
        paths.push(format!("{} {}", node.node, kj(node.heat_j.unwrap_or_default())));
    }
    for exchanger in &heat.exchangers {
        let path = &exchanger.exchanger;
        let id = last_key(path);
        paths.push(format!("{id} {}", kj(exchanger.heat_j)));
    }
    if heat.carried_away_j.abs() > 1e-9 * heat.came_j.abs() {
        paths.push(format!("transferred by flows {}", kj(heat.carried_away_j)));
    }
    page.line(format!(
        "  heat: {} = {}, balance error {:.1e}",
        parts.join(" + "),
        paths.join(" + "),
        heat.residual_share
    ));
    let measured = duty.nodes.iter().any(|node| node.rms_k.is_some());
    let table = TextTable::of(&duty.nodes)
        .column("node", |node| &node.node)
        .column("start degC", |node| format!("{:.2}", node.start_degc))
        .column("end", |node| format!("{:.2}", node.end_degc))
        .column("min", |node| format!("{:.2}", node.least_degc))
        .column("max", |node| format!("{:.2}", node.greatest_degc))
        .column("mean", |node| format!("{:.2}", node.mean_degc))
        .each(measured.then_some("rms deviation K"), |table, head| {
            table.column(head, |node| {
                node.rms_k.map_or_else(String::new, |rms| format!("{rms:.2}"))
            })
        });
    page.table(table.finish());
}

/// Reads a quantity of an interval.
type Read = fn(&IntervalOfDuty) -> f64;

/// Maximum number of points of one line: more cannot be distinguished and enlarge the page.
const MOST: usize = 2400;

/// Figures of one cycle for the files.
fn figures(name: &str, duty: &DutyOfSet, page: &mut Page) {
    let (set, cycle) = (&duty.model_set, &duty.cycle);
    let series = &duty.series;
    if series.is_empty() {
        return;
    }
    let every = series.len().div_ceil(MOST);
    let file = format!("{name}-{set}-{cycle}");
    let losses = Figure::Areas {
        title: format!("{name}: losses over {cycle}, models {set}"),
        x: "time in s".to_owned(),
        y: "loss in W".to_owned(),
        names: duty.shares.clone(),
        places: series.chunks(every).map(|chunk| chunk[0].time_s).collect(),
        stacks: series
            .chunks(every)
            .map(|chunk| mean_losses(chunk, duty.shares.len()))
            .collect(),
    };
    page.file_figure(format!("{file}-loss"), losses);
    let over_time: [(&str, &str, Read); 2] = [("torque", "Nm", |i| i.torque_nm), ("speed", "rpm", |i| i.speed_rpm)];
    for (what, unit, read) in over_time {
        let figure = Figure::Lines {
            title: format!("{name}: {what} of the reference port over {cycle}, models {set}"),
            x: "time in s".to_owned(),
            y: format!("{what} in {unit}"),
            lines: vec![line(series, every, what, &|i| (i.time_s, read(i)))],
        };
        page.file_figure(format!("{file}-{what}"), figure);
    }
    if duty.heat.is_none() {
        return;
    }
    let figure = Figure::Lines {
        title: format!("{name}: temperatures over {cycle}, models {set}"),
        x: "time in s".to_owned(),
        y: "temperature in degC".to_owned(),
        lines: temperatures(duty, every),
    };
    page.file_figure(format!("{file}-temperatures"), figure);
}

fn line(series: &[IntervalOfDuty], every: usize, name: &str, read: &dyn Fn(&IntervalOfDuty) -> (f64, f64)) -> Line {
    Line {
        name: name.to_owned(),
        points: series.iter().step_by(every).map(|i| Some(read(i))).collect(),
        stroke: Stroke::Line,
    }
}

/// Losses by share, averaged over the intervals of one plotted point, which conserves energy.
fn mean_losses(chunk: &[IntervalOfDuty], shares: usize) -> Vec<f64> {
    let time: f64 = chunk.iter().map(|i| i.duration_s).sum();
    let mut sum = vec![0.0; shares];
    for interval in chunk {
        for (sum, watts) in sum.iter_mut().zip(&interval.losses_w) {
            *sum += watts * interval.duration_s / time;
        }
    }
    sum
}

/// Temperatures of all nodes, calculated and measured.
fn temperatures(duty: &DutyOfSet, every: usize) -> Vec<Line> {
    let mut lines = Vec::new();
    for (node, of_node) in duty.nodes.iter().enumerate() {
        lines.push(line(&duty.series, every, &of_node.node, &|i| {
            (i.time_s + i.duration_s, i.temperatures_degc[node])
        }));
        if !of_node.measured.is_empty() {
            let every = of_node.measured.len().div_ceil(MOST / 8);
            lines.push(Line {
                name: format!("{}, measured", of_node.node),
                points: of_node.measured.iter().step_by(every).copied().map(Some).collect(),
                stroke: Stroke::Dots,
            });
        }
    }
    lines
}

/// Ratings over the cycle: lives first, then what is outside its bound at some time.
fn ratings(name: &str, duty: &DutyOfSet, page: &mut Page) {
    let Some(rated) = &duty.ratings else { return };
    let unit = |rated: &RatedOverTime| {
        if rated.unit == "-" {
            String::new()
        } else {
            format!(" {}", rated.unit)
        }
    };
    for rating in rated.iter().filter(|rating| rating.over_time == "damage") {
        page.line(format!(
            "{name}: {}: {} {} = {}{} over {}",
            rating.component,
            rating.meaning,
            rating.symbol,
            significant(rating.value),
            unit(rating),
            duty.cycle
        ));
    }
    for rating in rated.iter().filter(|rating| rating.outside) {
        let (side, bound) = match (rating.least, rating.greatest) {
            (Some(least), _) if rating.value < least => ("below", least),
            (_, Some(greatest)) => ("above", greatest),
            _ => continue,
        };
        page.careful.push(format!(
            "{}: {} {} reaches {}{}, {side} {}{}, for {} % of {} (ratings.{})",
            rating.component,
            rating.meaning,
            rating.symbol,
            significant(rating.value),
            unit(rating),
            significant(bound),
            unit(rating),
            significant(100.0 * rating.outside_share),
            duty.cycle,
            rating.rating
        ));
    }
}
