//! Results of one cycle with one gearbox and one model set.

use gearloss_framework::transmission::Transmission;

use super::ReferenceLoss;
use super::machines::MachineOfDuty;
use super::outcome::{
    BrokenOff, DutyOfSet, EnergyOfDuty, EnergyPerDistance, HeatOfDuty, HeatOfExchanger, HeatOfMotor, HeatOfNode,
    IntervalOfDuty, ReferenceOfDuty, TemperatureOfNode,
};
use crate::analyses::Built;
use crate::analyses::balance::reason;
use crate::analyses::common::duties::{Read, nodes};
use crate::analyses::common::shares::Shares;
use crate::duty::{Duty, distance};
use crate::numbers::RPM;
use crate::points::{Driven, Stretch, notes_over_time};

/// The results of a simulated cycle.
pub fn duty(
    b: &Built<'_>,
    read: &Read,
    driven: &Driven,
    shares: &Shares,
    reference: Option<&ReferenceLoss>,
) -> DutyOfSet {
    let t = &b.transmission;
    let duration = driven.total.duration;
    let mean = |energy: f64| if duration > 0.0 { energy / duration } else { 0.0 };
    let energy = energy(driven);
    let energies = shares.sums(&driven.total.parts);
    let nodes = nodes(t, driven);
    let measured: Vec<Vec<(f64, f64)>> = nodes.iter().map(|node| measured(read, node)).collect();
    let series = |s: &Stretch| interval(t, s, shares, energy.motors_j.is_some(), &measured);
    let series = driven.stretches.iter().map(series).collect();
    DutyOfSet {
        model_set: b.name.clone(),
        cycle: read.name.clone(),
        duration_s: duration,
        intervals: driven.stretches.len(),
        mean_loss_w: mean(energy.loss_j),
        shares: shares.names.clone(),
        mean_losses_w: energies.iter().map(|joule| mean(*joule)).collect(),
        energy,
        per_distance: per_distance(driven),
        consumption: None,
        gears_used: None,
        heat: heat(t, driven),
        motors: motors(t, driven),
        motors_beyond_map: driven.total.beyond_map,
        inclination_deg: t.travels().then(|| {
            let all = driven.stretches.iter().map(|s| s.inclination.to_degrees());
            all.fold([0.0; 2], |[low, high]: [f64; 2], at| [low.min(at), high.max(at)])
        }),
        machines: MachineOfDuty::all(t, driven),
        nodes: nodes
            .into_iter()
            .zip(measured)
            .enumerate()
            .map(|(node, (name, measured))| temperature(driven, node, name, measured))
            .collect(),
        about: read.about.clone(),
        reference: reference.map(|reference| ReferenceOfDuty {
            mean_loss_w: reference.loss,
            source: reference.source.clone(),
        }),
        bands: None,
        ratings: None,
        evaluations: driven.evaluations,
        calls: driven.calls,
        steps: driven.steps[0],
        steps_in_vain: driven.steps[1],
        broken: driven.broken.as_ref().map(|(time, why)| BrokenOff {
            time_s: *time,
            reason: reason(t, why),
        }),
        notes: notes_over_time(t, driven),
        file_notes: match &read.duty {
            Duty::Trace(trace) => trace.notes.clone(),
            Duty::Spectrum(_) => Vec::new(),
        },
        energies_j: energies,
        series,
    }
}

fn energy(driven: &Driven) -> EnergyOfDuty {
    let total = &driven.total;
    let loss: f64 = total.parts.iter().sum();
    EnergyOfDuty {
        input_j: total.input,
        output_j: total.output,
        loss_j: loss,
        // Losses of motors need a thermal network.
        motors_j: (!total.motors.is_empty()).then(|| total.motors.iter().flatten().sum()),
        brakes_j: driven.brakes,
        residual_share: (total.input - total.output - loss).abs() / total.input.abs().max(1e-300),
        drive_efficiency: efficiency(driven, |power| power > 0.0),
        recuperation_efficiency: efficiency(driven, |power| power < 0.0),
    }
}

/// Output over input energy of the intervals whose power into the reference port meets a condition; absent without input.
fn efficiency(driven: &Driven, holds: fn(f64) -> bool) -> Option<f64> {
    let stretches = driven.stretches.iter().filter(|s| holds(s.torque * s.speed));
    let sum = |sum: [f64; 2], s: &Stretch| [sum[0] + s.heats.input, sum[1] + s.heats.output];
    let [input, output] = stretches.fold([0.0, 0.0], sum);
    (input > 0.0).then(|| output / input)
}

/// Energy over the distance of the vehicle.
pub fn per_distance(driven: &Driven) -> Option<EnergyPerDistance> {
    let (km, wh) = (
        1e-3 * distance(driven)?,
        driven.total.parts.iter().sum::<f64>() / 3600.0,
    );
    Some(EnergyPerDistance {
        distance_km: km,
        loss_wh_per_km: wh / km,
        loss_kwh_per_100_km: 0.1 * wh / km,
    })
}

/// Heat, if losses and temperatures depend on each other.
fn heat(t: &Transmission, driven: &Driven) -> Option<HeatOfDuty> {
    if driven.start.len() <= 1 {
        return None;
    }
    let total = &driven.total;
    let network = t.network();
    let node = |name: &String, heat_j: Option<f64>| HeatOfNode {
        node: name.clone(),
        heat_j,
    };
    let named = || network.into_iter().flat_map(|n| n.names().iter().enumerate());
    let is_held = |i: usize| network.is_some_and(|n| n.is_held(i));
    let takes = |i: usize, heat: Option<&f64>| heat.is_some_and(|heat| is_held(i) || *heat != 0.0);
    Some(HeatOfDuty {
        came_j: total.heat_input(),
        stored_j: total.stored,
        held: named()
            .filter(|(i, _)| is_held(*i))
            .map(|(i, name)| node(name, total.held.get(i).copied()))
            .collect(),
        exchangers: network
            .into_iter()
            .flat_map(|n| n.exchangers().zip(&total.exchangers))
            .map(|(path, joule)| HeatOfExchanger {
                exchanger: path.to_owned(),
                heat_j: *joule,
            })
            .collect(),
        carried_away_j: total.flows,
        residual_share: total.residual().abs() / total.heat_input().abs().max(1e-300),
        sources_j: total.sources,
        inverters_j: total.inverters.iter().sum(),
        taken: named()
            .filter(|(i, _)| takes(*i, total.held.get(*i)))
            .map(|(i, name)| node(name, total.held.get(i).copied()))
            .collect(),
    })
}

fn motors(t: &Transmission, driven: &Driven) -> Vec<HeatOfMotor> {
    let motors = t.network().into_iter();
    let motors = motors.flat_map(|n| n.motors().zip(&driven.total.motors));
    motors
        .map(|(path, [rotor, stator])| HeatOfMotor {
            motor: path.to_owned(),
            rotor_j: *rotor,
            stator_j: *stator,
        })
        .collect()
}

/// Temperatures of a node over the cycle.
fn temperature(driven: &Driven, node: usize, name: String, measured: Vec<(f64, f64)>) -> TemperatureOfNode {
    let start = driven.start[node];
    let all = || driven.stretches.iter().map(|s| s.temperatures[node]);
    let weighted: f64 = driven
        .stretches
        .iter()
        .map(|s| s.temperatures[node] * s.heats.duration)
        .sum();
    let duration = driven.total.duration;
    let squares: Vec<f64> = measured
        .iter()
        .filter_map(|(time, measured)| Some((measured - calculated_at(driven, node, *time)?).powi(2)))
        .collect();
    let compared = !squares.is_empty();
    TemperatureOfNode {
        node: name,
        start_degc: start,
        end_degc: all().next_back().unwrap_or(start),
        least_degc: all().fold(start, f64::min),
        greatest_degc: all().fold(start, f64::max),
        mean_degc: if duration > 0.0 { weighted / duration } else { 0.0 },
        rms_k: compared.then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()),
        measured_rows: compared.then_some(squares.len()),
        measured,
    }
}

/// Temperature of a node at a time, linear between the ends of intervals; absent outside the cycle. \[degC\]
fn calculated_at(driven: &Driven, node: usize, time: f64) -> Option<f64> {
    let stretches = &driven.stretches;
    let i = stretches.partition_point(|s| s.start + s.heats.duration < time);
    let s = stretches.get(i)?;
    let before = if i == 0 {
        driven.start[node]
    } else {
        stretches[i - 1].temperatures[node]
    };
    let share = (time - s.start) / s.heats.duration;
    (-1e-9..=1.0 + 1e-9)
        .contains(&share)
        .then(|| before + share * (s.temperatures[node] - before))
}

/// One interval with its mean powers.
fn interval(
    t: &Transmission,
    s: &Stretch,
    shares: &Shares,
    has_motors: bool,
    measured: &[Vec<(f64, f64)>],
) -> IntervalOfDuty {
    let heats = &s.heats;
    let power = |joule: f64| joule / heats.duration;
    let end = s.start + heats.duration;
    IntervalOfDuty {
        time_s: s.start,
        duration_s: heats.duration,
        torque_nm: s.torque,
        speed_rpm: s.speed * RPM,
        vehicle_speed_m_s: s.vehicle_speed,
        inclination_deg: t.travels().then(|| s.inclination.to_degrees()),
        gear: t.states()[s.gear].name.clone(),
        shift_j: s.shift.map(|shift| shift.heat),
        status: s.status,
        input_w: power(heats.input),
        output_w: power(heats.output),
        loss_w: power(heats.parts.iter().sum()),
        losses_w: shares.sums(&heats.parts).into_iter().map(power).collect(),
        motors_w: has_motors.then(|| power(heats.motors.iter().flatten().sum())),
        brakes_w: power(s.brakes),
        temperatures_degc: s.temperatures.clone(),
        measured_degc: measured.iter().map(|series| measured_at(series, end)).collect(),
    }
}

/// The temperature measured at a time, within a millisecond; absent without one. \[degC\]
fn measured_at(series: &[(f64, f64)], time: f64) -> Option<f64> {
    let i = series.partition_point(|(t, _)| *t < time - 1e-3);
    let (at, value) = series.get(i)?;
    (*at <= time + 1e-3).then_some(*value)
}

/// Temperatures of a node stated in a cycle: time and value. \[s and degC\]
fn measured(read: &Read, node: &str) -> Vec<(f64, f64)> {
    let Duty::Trace(trace) = &read.duty else {
        return Vec::new();
    };
    let Some(column) = trace.nodes.iter().position(|n| n == node) else {
        return Vec::new();
    };
    trace.samples.iter().map(|s| (s.time, s.temperatures[column])).collect()
}
