//! Simulated cycles as inputs of a network with tables, and its deviation from them.

use gearloss_fmu::Experiment;
use gearloss_fmu::content::Content;
use gearloss_fmu::model::Model;
use gearloss_fmu::variables::{Causality, Slot, Use};
use gearloss_framework::thermal::network::Network;
use gearloss_framework::transmission::Transmission;

use crate::analyses::common::duties::Read;
use crate::points::Driven;

/// Maximum number of rows of the reference inputs.
const MOST_ROWS: usize = 20_000;

/// Inputs of a simulated cycle: for each interval the values of the variables that are inputs.
pub fn rows(
    content: &Content,
    network: &Network,
    read: &Read,
    driven: &Driven,
    (t, gears): (&Transmission, &[&String]),
) -> Vec<Vec<f64>> {
    let slots: Vec<Slot> = Model::new(content.clone()).slots().to_vec();
    let numbers: Vec<_> = network.exchanger_numbers().collect();
    let ambient = driven.start[0];
    let row = |(stretch, interval): (&crate::points::Stretch, &crate::duty::Interval)| {
        let given = &interval.given;
        let input = |use_: Use| match use_ {
            Use::Speed => stretch.speed,
            Use::Torque => stretch.torque,
            Use::Ambient => given.ambient.unwrap_or(ambient),
            Use::VehicleSpeed => given.vehicle_speed.unwrap_or(0.0),
            // Cycles state the mass flow, at the temperature of the oil.
            Use::OilFlow => match given.oil_flow {
                Some(mass) => mass / network.oil_properties(stretch.temperatures[network.oil()])[0],
                None => network.pumped().unwrap_or(0.0),
            },
            Use::CoolantFlow(i) => given.coolant_flow.unwrap_or(numbers[i as usize].coolant_flow),
            Use::CoolantTemperature(i) => given
                .coolant_temperature
                .unwrap_or(numbers[i as usize].coolant_temperature),
            Use::Gear => {
                let gear = &t.states()[stretch.gear].name;
                gears
                    .iter()
                    .position(|known| *known == gear)
                    .map_or(1.0, |i| (i + 1) as f64)
            }
            _ => 0.0,
        };
        let inputs = slots.iter().filter(|slot| slot.causality == Causality::Input);
        inputs.map(|slot| input(slot.use_)).collect()
    };
    driven.stretches.iter().zip(&read.intervals).map(row).collect()
}

/// Largest deviation of the oil and of any node from a simulated cycle. \[K\]
pub fn deviation_of(content: &Content, network: &Network, driven: &Driven, rows: &[Vec<f64>]) -> [f64; 2] {
    let mut model = Model::new(content.clone());
    let slots = model.slots().to_vec();
    let inputs: Vec<(u32, Slot)> = numbered(&slots, |slot| slot.causality == Causality::Input);
    let nodes: Vec<(u32, Slot)> = numbered(&slots, |slot| matches!(slot.use_, Use::Node(_)));
    for (reference, slot) in &nodes {
        if let Use::Node(node) = slot.use_ {
            // A node with a prescribed temperature has no start value.
            let _ = model.set(*reference, slot.kind, driven.start[node as usize]);
        }
    }
    let mut deviation = [0.0_f64; 2];
    for (stretch, row) in driven.stretches.iter().zip(rows) {
        for ((reference, slot), value) in inputs.iter().zip(row) {
            let _ = model.set(*reference, slot.kind, *value);
        }
        if model.advance(stretch.heats.duration).is_err() {
            return [f64::INFINITY; 2];
        }
        for (reference, slot) in &nodes {
            let (Use::Node(node), Ok(value)) = (slot.use_, model.get(*reference, slot.kind)) else {
                continue;
            };
            let deviation_here = (value - stretch.temperatures[node as usize]).abs();
            deviation[1] = deviation[1].max(deviation_here);
            if node as usize == network.oil() {
                deviation[0] = deviation[0].max(deviation_here);
            }
        }
    }
    deviation
}

/// Variables with their references.
fn numbered(slots: &[Slot], is_wanted: impl Fn(&Slot) -> bool) -> Vec<(u32, Slot)> {
    let all = (0..).zip(slots.iter().copied());
    all.filter(|(_, slot)| is_wanted(slot)).collect()
}

/// The inputs of a cycle at equal steps.
pub fn experiment(rows: &[Vec<f64>], driven: &Driven) -> Experiment {
    let durations = driven.stretches.iter().map(|stretch| stretch.heats.duration);
    let step = durations.clone().fold(f64::INFINITY, f64::min);
    let mut inputs: Vec<Vec<f64>> = Vec::new();
    for (row, duration) in rows.iter().zip(durations) {
        let count = (duration / step).round().max(1.0) as usize;
        let left = MOST_ROWS.saturating_sub(inputs.len());
        inputs.extend(std::iter::repeat_n(row.clone(), count.min(left)));
    }
    // The end of the last step.
    inputs.extend(inputs.last().cloned());
    Experiment { step, inputs }
}
