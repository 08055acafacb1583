//! Loads and speeds of the bearings over a cycle, as load cases for programs of life and noise.
//!
//! A load of a spectrum is a load case. The intervals of a cycle in time are sorted into classes of gear, torque and speed of the reference
//! port, and each class is solved at its means over time; without classes every interval is a load case.

use std::collections::BTreeMap;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::Solution;
use gearloss_framework::transmission::Transmission;

use super::points::{At, Points};
use crate::analyses::common::duties::Read;
use crate::duty::Duty;
use crate::numbers::RPM;
use crate::points::{Driven, Ride};

/// Classes of torque and of speed unless stated.
pub const CLASSES: u32 = 20;

/// Exponent of the load in the life of roller bearings, ISO 281; that of ball bearings is 3.
const LIFE_EXPONENT: f64 = 10.0 / 3.0;

/// Load cases of one cycle with one model set.
#[derive(Debug, Clone)]
pub struct BearingLoads {
    /// Name of the model set.
    pub model_set: String,
    /// Name of the cycle.
    pub cycle: String,
    /// The load cases, in the order of the spectrum, in time, or of their classes.
    pub cases: Vec<LoadCase>,
    /// Largest relative deviation of the equivalent radial load of a bearing over the classes from that over the intervals; absent if every
    /// interval is a load case. [-]
    pub deviation: Option<f64>,
}

/// A load case: an operating point with its duration.
#[derive(Debug, Clone)]
pub struct LoadCase {
    /// Name of the gear.
    pub gear: String,
    /// Number of the gear among those of the gearbox, from one.
    pub gear_number: usize,
    /// Torque of the reference port. [Nm]
    pub torque_nm: f64,
    /// Speed of the reference port. [rpm]
    pub speed_rpm: f64,
    /// Its time in the cycle. [s]
    pub duration_s: f64,
    /// Its share of the time of the cycle. [-]
    pub share: f64,
    /// Number of intervals of the cycle in it. [-]
    pub intervals: usize,
    /// The bearings, the same in every load case.
    pub bearings: Vec<BearingLoad>,
}

/// Load and speed of a bearing, one copy.
#[derive(Debug, Clone)]
pub struct BearingLoad {
    /// Path; for planets that carry different loads the mean over them, and the most loaded one in addition.
    pub bearing: String,
    /// Number of equal copies. [-]
    pub copies: f64,
    /// Speed of the inner ring. [rpm]
    pub inner_rpm: Option<f64>,
    /// Speed of the outer ring. [rpm]
    pub outer_rpm: Option<f64>,
    /// Temperature of the oil at the bearing. [degC]
    pub oil_degc: Option<f64>,
    /// Its load; absent without a power flow.
    pub load: Option<Load>,
}

/// The load of a bearing.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// Radial force on the inner ring, y and z, without the part that turns with a carrier; absent if the direction is not known. [N]
    pub radial_yz_n: Option<[f64; 2]>,
    /// Part of the radial load that turns with a carrier, whose planets carry different loads. [N]
    pub turning_n: f64,
    /// Radial load. [N]
    pub radial_n: f64,
    /// Axial load without its direction. [N]
    pub axial_n: f64,
    /// Tilting moment. [Nm]
    pub tilting_nm: f64,
}

/// The load cases of a simulated cycle; `classes` is the number of classes of torque and of speed, zero for none.
///
/// # Errors
/// If a gear is unknown.
pub fn bearing_loads(
    t: &Transmission,
    model_set: &str,
    (read, ride, driven): (&Read, &Ride<'_>, &Driven),
    classes: u32,
) -> Result<BearingLoads, Vec<Diagnostic>> {
    let mut points = Points::new(t, ride.flow);
    let intervals = Points::of(t, driven);
    let time: f64 = intervals.iter().map(|at| at.duration).sum();
    let is_sorted = matches!(read.duty, Duty::Trace(_)) && classes > 0;
    let mut solve = |all: &[(At<'_>, usize)]| -> Result<Vec<LoadCase>, Vec<Diagnostic>> {
        let case = |(at, intervals): &(At<'_>, usize)| {
            let bearings = points.solve(at, |solution| bearings(t, solution))?;
            let state = t.states().iter().position(|state| state.name == at.gear);
            Ok(LoadCase {
                gear: at.gear.to_owned(),
                gear_number: state.map_or(1, |state| state + 1),
                torque_nm: at.torque,
                speed_rpm: at.speed * RPM,
                duration_s: at.duration,
                share: if time > 0.0 { at.duration / time } else { 0.0 },
                intervals: *intervals,
                bearings,
            })
        };
        all.iter().map(case).collect()
    };
    let single: Vec<(At<'_>, usize)> = intervals.iter().map(|at| (at.clone(), 1)).collect();
    let of_intervals = solve(&single)?;
    let (cases, deviation) = if is_sorted {
        let cases = solve(&sorted(&intervals, classes))?;
        let deviation = deviation(&cases, &of_intervals);
        (cases, Some(deviation))
    } else {
        (of_intervals, None)
    };
    Ok(BearingLoads {
        model_set: model_set.to_owned(),
        cycle: read.name.clone(),
        cases,
        deviation,
    })
}

/// The intervals in classes of gear, torque and speed, each at its means over time. Zero is a boundary, so that drive and coast stay apart,
/// and standstill is a class of its own.
fn sorted<'a>(intervals: &[At<'a>], classes: u32) -> Vec<(At<'a>, usize)> {
    let width = |value: fn(&At<'_>) -> f64| {
        let values = intervals.iter().map(value);
        let (least, greatest) = values.fold((0.0_f64, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        (greatest - least) / f64::from(classes)
    };
    let (torque, speed) = (width(|at| at.torque), width(|at| at.speed));
    // The greatest value belongs to the last class.
    let class = |value: f64, width: f64| {
        if width > 0.0 {
            (value / width * (1.0 - 1e-9)).floor() as i64
        } else {
            0
        }
    };
    let mut sums: BTreeMap<(&str, bool, i64, i64), (At<'a>, usize)> = BTreeMap::new();
    for at in intervals.iter().filter(|at| at.duration > 0.0) {
        let key = (
            at.gear,
            at.speed != 0.0,
            class(at.speed, speed),
            class(at.torque, torque),
        );
        match sums.entry(key) {
            std::collections::btree_map::Entry::Vacant(place) => {
                place.insert((at.clone(), 1));
            }
            std::collections::btree_map::Entry::Occupied(mut place) => {
                let (sum, count) = place.get_mut();
                let share = at.duration / (sum.duration + at.duration);
                sum.torque += share * (at.torque - sum.torque);
                sum.speed += share * (at.speed - sum.speed);
                for (mean, other) in sum.temperatures.iter_mut().zip(&at.temperatures) {
                    *mean += share * (other - *mean);
                }
                sum.duration += at.duration;
                *count += 1;
            }
        }
    }
    sums.into_values().collect()
}

/// Loads, speeds and oil temperatures of all supports at a point.
fn bearings(t: &Transmission, solution: &Solution<'_>) -> Vec<BearingLoad> {
    let forces = solution.radial_forces();
    let mut all = Vec::new();
    for (support, path) in t.supports().iter().enumerate() {
        let part = t.parts().iter().position(|part| part.path == *path);
        let readings = part.map(|part| solution.readings(part)).unwrap_or_default();
        let read = |name: &str| {
            let found = readings.iter().find(|reading| reading.name == name);
            found.map(|reading| reading.value)
        };
        let outer_rpm = read("outer_speed");
        let record = BearingLoad {
            bearing: path.clone(),
            copies: part.map_or(1.0, |part| t.parts()[part].count),
            inner_rpm: read("speed").zip(outer_rpm).map(|(relative, outer)| outer + relative),
            outer_rpm,
            oil_degc: read("temperature"),
            load: None,
        };
        let load = |load: gearloss_framework::loads::SupportLoad, radial_yz_n| Load {
            radial_yz_n,
            turning_n: solution.turning_load(support),
            radial_n: load.radial,
            axial_n: load.axial,
            tilting_nm: load.tilting,
        };
        let flows = solution.has_flow();
        all.push(BearingLoad {
            load: flows.then(|| load(solution.load(support), forces[support])),
            ..record.clone()
        });
        if let Some(most) = solution.most_loaded(support) {
            all.push(BearingLoad {
                bearing: format!("{path}, most loaded planet"),
                copies: 1.0,
                load: flows.then(|| load(most, None)),
                ..record
            });
        }
    }
    all
}

/// Largest relative deviation of the equivalent radial loads: the mean of the load to the exponent of life over all revolutions.
fn deviation(cases: &[LoadCase], intervals: &[LoadCase]) -> f64 {
    let count = cases.first().map_or(0, |case| case.bearings.len());
    let sum = |cases: &[LoadCase], bearing: usize| -> f64 {
        let one = |case: &LoadCase| {
            let load = &case.bearings[bearing];
            let relative = load
                .inner_rpm
                .zip(load.outer_rpm)
                .map(|(inner, outer)| (inner - outer).abs())?;
            Some(case.duration_s * relative * load.load?.radial_n.powf(LIFE_EXPONENT))
        };
        cases.iter().filter_map(one).sum()
    };
    (0..count)
        .filter_map(|bearing| {
            let (binned, exact) = (sum(cases, bearing), sum(intervals, bearing));
            (exact > 0.0).then(|| ((binned / exact).powf(1.0 / LIFE_EXPONENT) - 1.0).abs())
        })
        .fold(0.0, f64::max)
}
