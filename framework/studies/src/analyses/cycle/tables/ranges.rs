//! Ranges and axes of the tables.

use gearloss_fmu::network as fmu;
use gearloss_fmu::table::Axis;
use gearloss_framework::thermal::network::Network;

use crate::numbers::RPM;
use crate::points::Driven;

/// Numbers of points over torque on each side of zero, and over speed.
const LOADS: [usize; 2] = [10, 20];
/// Number of points over speed of the vehicle, and over oil flow.
const VEHICLE: usize = 9;
/// See [`VEHICLE`].
const FLOW: usize = 5;
/// Number of points over a temperature of anything else.
pub const SINGLE: usize = 13;

/// Ranges of the tables.
pub struct Ranges {
    /// Torques of the reference port. \[Nm\]
    pub torques: Vec<f64>,
    /// Speeds of the reference port, from standstill on. \[rad/s\]
    pub speeds: Vec<f64>,
    /// Lowest and highest temperature. \[degC\]
    pub temperatures: [f64; 2],
    /// Speeds of the vehicle. \[m/s\]
    pub vehicle: Vec<f64>,
    /// Mass flows of the oil. \[kg/s\]
    pub flows: Vec<f64>,
}

impl Ranges {
    /// What the cycles reach, with a margin; absent if nothing turns.
    pub fn new(network: &Network, driven: &[Driven]) -> Option<Self> {
        let all = || driven.iter().flat_map(|driven| &driven.stretches);
        let [mut low, mut high, mut fast, mut vehicle] = [0.0_f64; 4];
        for stretch in all() {
            (low, high) = (low.min(stretch.torque), high.max(stretch.torque));
            fast = fast.max(stretch.speed.abs());
            vehicle = vehicle.max(stretch.vehicle_speed.unwrap_or(0.0).abs());
        }
        let nodes = all().flat_map(|stretch| &stretch.temperatures);
        let nodes = nodes.chain(driven.iter().flat_map(|driven| &driven.start));
        let held = (0..network.names().len()).filter_map(|node| network.held(node));
        let coolant = network.exchanger_numbers().map(|e| e.coolant_temperature);
        let ends = nodes.copied().chain(held).chain(coolant);
        let [cold, hot] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| {
            [low.min(t), high.max(t)]
        });
        if fast == 0.0 || low == high || cold > hot {
            return None;
        }
        let [per_side, speeds] = LOADS;
        // Denser near zero, where losses bend.
        let power = |power: f64| move |i: usize, count: usize| (i as f64 / count as f64).powf(power);
        let (share, dense) = (power(1.5), power(2.0));
        let side = |end: f64| (1..=per_side).map(move |i| 1.05 * end * dense(i, per_side));
        let mut torques = vec![0.0];
        torques.extend(side(low).chain(side(high)).filter(|torque| *torque != 0.0));
        torques.sort_by(f64::total_cmp);
        let mass = network.pumped().unwrap_or(0.0) * network.oil_properties(0.5 * (cold + hot))[0];
        Some(Self {
            torques,
            speeds: (0..=speeds).map(|i| 1.05 * fast * share(i, speeds)).collect(),
            temperatures: [(cold - 10.0).floor(), (hot + 20.0).ceil()],
            vehicle: (0..VEHICLE)
                .map(|i| 1.05 * vehicle.max(10.0) * share(i, VEHICLE - 1))
                .collect(),
            flows: if mass > 0.0 {
                (0..FLOW).map(|i| 2.0 * mass * share(i, FLOW - 1)).collect()
            } else {
                vec![0.0]
            },
        })
    }

    pub fn about(&self, gears: &[&String]) -> String {
        let last = |axis: &[f64]| axis[axis.len() - 1];
        let names: Vec<&str> = gears.iter().map(|gear| gear.as_str()).collect();
        format!(
            "gears {}, {:.0} to {:.0} Nm, up to {:.0} rpm, {} to {} degC",
            names.join(", "),
            self.torques[0],
            last(&self.torques),
            last(&self.speeds) * RPM,
            self.temperatures[0],
            self.temperatures[1]
        )
    }
}

/// Axis of the temperature of a node.
pub fn temperature_axis(node: usize, points: Vec<f64>) -> Axis {
    Axis {
        quantity: fmu::TEMPERATURES + node as u32,
        points,
    }
}

/// A number with the precision of the tables.
pub fn short(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Points of a range of temperatures, ends included: denser where it is cold, where the viscosity of oils bends most.
pub fn spaced([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|i| from + (to - from) * (i as f64 / last).powf(1.4))
        .collect()
}
