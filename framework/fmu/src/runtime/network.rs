//! A thermal network with tabulated losses: C dT/dt = Q - K T, by backward Euler steps of its own, or as derivatives for the solver of
//! another program. Nodes without heat capacity are algebraic: their temperatures follow from the others.
//!
//! Links transfer heat in both directions, flows carry it downstream. Losses, conductances and flows of a step are those at the
//! temperatures at its end, found by fixed-point iteration.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use super::map::{Turn, chosen, efficiency};
use super::math::{exp, pow};
use super::table::Table;
use super::variables::{Causality, Kind, Slot, Use};

/// Quantities of the tables: speed, torque, vehicle speed (m/s), mass flow of the oil (kg/s), then the temperatures of the nodes.
pub const SPEED: u32 = 0;
/// See [`SPEED`].
pub const TORQUE: u32 = 1;
/// See [`SPEED`].
pub const VEHICLE: u32 = 2;
/// See [`SPEED`].
pub const OIL_FLOW: u32 = 3;
/// See [`SPEED`].
pub const TEMPERATURES: u32 = 4;

/// Agreement of the temperatures of two iterations. \[K\]
const AGREED: f64 = 1e-6;
/// Maximum number of iterations of a step.
const MOST_PASSES: usize = 60;
/// Number of iterations above which only half of each change is applied.
const CAREFUL: usize = 12;
/// Maximum number of steps between two communication points.
const MOST_STEPS: f64 = 1e7;

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Its name.
    pub name: String,
    /// Heat capacity. \[J/K\]
    pub capacity: f64,
    /// Prescribed temperature; that of the first node, the ambient, is an input. \[degC\]
    pub held: Option<f64>,
    /// Temperature at the start. \[degC\]
    pub start: f64,
}

impl Node {
    /// Whether its temperature is a continuous state.
    fn is_state(&self) -> bool {
        self.held.is_none() && self.capacity > 0.0
    }

    /// Whether its temperature follows from the others at once.
    fn is_algebraic(&self) -> bool {
        self.held.is_none() && !self.is_state()
    }
}

/// Capacity flow of oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Flow {
    /// As given. \[W/K\]
    Given(f64),
    /// A share of the circulated oil.
    Share(f64),
}

/// A heat exchanger, by its effectiveness.
#[derive(Debug, Clone, PartialEq)]
pub struct Exchanger {
    /// Its name.
    pub name: String,
    /// Node of the incoming oil.
    pub from: u32,
    /// Node of the oil after it.
    pub to: u32,
    /// Flow of the oil.
    pub oil: Flow,
    /// Conductance between oil and coolant. \[W/K\]
    pub ua: f64,
    /// 0 counterflow, 1 parallel flow, 2 crossflow.
    pub arrangement: u32,
    /// Specific heat of the coolant. \[J/(kg K)\]
    pub coolant_heat_capacity: f64,
    /// Mass flow of the coolant unless set. \[kg/s\]
    pub coolant_flow: f64,
    /// Inlet temperature of the coolant unless set. \[degC\]
    pub coolant_temperature: f64,
}

/// Heat into nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// One channel for each of the nodes.
    pub table: Table,
    /// The nodes.
    pub nodes: Vec<u32>,
    /// Whether the table has heat over the speed of the reference port (Nm) instead of heat (W).
    pub over_speed: bool,
}

/// Conductance of a link.
#[derive(Debug, Clone, PartialEq)]
pub enum Conductance {
    /// Constant. \[W/K\]
    Given(f64),
    /// Tabulated. \[W/K\]
    Table(Table),
}

/// A link between two nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// The nodes.
    pub between: [u32; 2],
    /// Its conductance.
    pub conductance: Conductance,
}

/// What depends on the gear.
#[derive(Debug, Clone, PartialEq)]
pub struct GearOfNetwork {
    /// Its name.
    pub name: String,
    /// Speed of the other port over that of the reference port; absent unless there are two ports.
    pub ratio: Option<f64>,
    /// Losses of the transmission.
    pub losses: Vec<Source>,
    /// Losses of motors.
    pub motors: Vec<Source>,
    /// Links.
    pub links: Vec<Link>,
}

/// A thermal network.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    /// The nodes; the first is the ambient.
    pub nodes: Vec<Node>,
    /// The oil of the housing.
    pub oil: u32,
    /// Maximum length of a step. \[s\]
    pub step: f64,
    /// Volume flow of the circulated oil; absent if none is circulated. \[m3/s\]
    pub pumped: Option<f64>,
    /// Density (kg/m3) and specific heat (J/(kg K)) over the temperature of the oil.
    pub oil_properties: Table,
    /// Heat exchangers.
    pub exchangers: Vec<Exchanger>,
    /// Flows: from a node to a node.
    pub flows: Vec<(u32, u32, Flow)>,
    /// Constant heat into nodes. \[W\]
    pub sources: Vec<(u32, f64)>,
    /// The gears; at least one.
    pub gears: Vec<GearOfNetwork>,
    /// Whether a link depends on the speed of the vehicle.
    pub vehicle_speed: bool,
    /// Start values of speed, torque, vehicle speed and ambient temperature.
    pub starts: Vec<f64>,
}

/// Everything at one set of temperatures.
struct State {
    /// K, row by row, and the heat of nodes and coolants.
    matrix: Vec<f64>,
    right: Vec<f64>,
    /// Prescribed temperatures.
    held: Vec<Option<f64>>,
    /// Loss of the transmission and of the motors. \[W\]
    losses: [f64; 2],
    /// Heat transfer of each exchanger over the difference of inlet temperatures, and the inlet temperature of its coolant.
    exchangers: Vec<(f64, f64)>,
    inside: bool,
}

impl Network {
    /// Whether all parts fit together.
    pub fn is_sound(&self) -> bool {
        let count = self.nodes.len() as u32;
        let known = |node: u32| node < count;
        let table = |table: &Table, channels: usize| {
            table.channels == channels
                && table.is_sound()
                && table.axes.iter().all(|axis| axis.quantity < TEMPERATURES + count)
        };
        let source = |s: &Source| table(&s.table, s.nodes.len()) && s.nodes.iter().all(|node| known(*node));
        let link = |l: &Link| {
            l.between.iter().all(|node| known(*node))
                && match &l.conductance {
                    Conductance::Given(given) => given.is_finite(),
                    Conductance::Table(interpolated) => table(interpolated, 1),
                }
        };
        let gear = |g: &GearOfNetwork| {
            g.losses.iter().chain(&g.motors).all(source)
                && g.links.iter().all(link)
                && g.ratio.is_none_or(|ratio| ratio.is_finite() && ratio != 0.0)
        };
        let exchanger = |e: &Exchanger| known(e.from) && known(e.to) && e.arrangement < 3 && e.ua.is_finite();
        let node = |n: &Node| n.capacity.is_finite() && n.start.is_finite() && n.held.is_none_or(f64::is_finite);
        !self.gears.is_empty()
            && self.nodes.iter().all(node)
            && known(self.oil)
            && self.starts.len() == 4
            && self.step.is_finite()
            && self.step > 0.0
            && self.gears.iter().all(gear)
            && self.exchangers.iter().all(exchanger)
            && self.flows.iter().all(|(from, to, _)| known(*from) && known(*to))
            && self.sources.iter().all(|(node, _)| known(*node))
            && table(&self.oil_properties, 2)
    }

    /// The variables after time.
    pub fn variables(&self) -> Vec<Slot> {
        let real = |causality: Causality, use_: Use, start: f64| Slot {
            use_,
            kind: Kind::Real,
            causality,
            start,
        };
        let start = |i: usize| self.starts.get(i).copied().unwrap_or(0.0);
        let input = |use_: Use, start: f64| real(Causality::Input, use_, start);
        let output = |use_: Use| real(Causality::Output, use_, 0.0);
        let mut all = vec![
            input(Use::Speed, start(0)),
            input(Use::Torque, start(1)),
            input(Use::Ambient, start(3)),
        ];
        if self.vehicle_speed {
            all.push(input(Use::VehicleSpeed, start(2)));
        }
        all.extend(self.pumped.map(|pumped| input(Use::OilFlow, pumped)));
        for (i, e) in (0..).zip(&self.exchangers) {
            all.push(input(Use::CoolantFlow(i), e.coolant_flow));
            all.push(input(Use::CoolantTemperature(i), e.coolant_temperature));
        }
        if self.gears.len() > 1 {
            all.push(Slot::gear());
        }
        for (i, node) in (0..).zip(&self.nodes).skip(1) {
            let use_ = Use::Node(i);
            all.push(if node.is_state() {
                real(Causality::State, use_, node.start)
            } else {
                output(use_)
            });
        }
        all.extend([Use::LossTorque, Use::LossPower, Use::Efficiency].map(output));
        if self.gears.iter().all(|gear| gear.ratio.is_some()) {
            all.extend([Use::OutputTorque, Use::OutputSpeed].map(output));
        }
        if self.gears.iter().any(|gear| !gear.motors.is_empty()) {
            all.push(output(Use::MotorLoss));
        }
        all.extend((0..self.exchangers.len() as u32).map(|i| output(Use::ExchangerHeat(i))));
        all.push(Slot::outside());
        // At the end, so that the other references do not depend on them.
        let states = (0..).zip(&self.nodes).skip(1).filter(|(_, node)| node.is_state());
        all.extend(states.map(|(i, _)| real(Causality::Derivative, Use::Rate(i), 0.0)));
        all
    }

    /// Temperatures of all nodes from the values of the variables; the first guess of an algebraic one is that of the oil, so that it
    /// does not depend on earlier calls. \[degC\]
    fn temperatures(&self, slots: &[Slot], values: &[f64]) -> Vec<f64> {
        let mut temperatures: Vec<f64> = self.nodes.iter().map(|node| node.held.unwrap_or(node.start)).collect();
        for (slot, value) in slots.iter().zip(values) {
            let (place, is_free) = match slot.use_ {
                Use::Ambient => (0, true),
                Use::Node(node) => (node as usize, slot.causality == Causality::State),
                _ => continue,
            };
            if let Some(temperature) = temperatures.get_mut(place).filter(|_| is_free) {
                *temperature = *value;
            }
        }
        let oil = temperatures.get(self.oil as usize).copied();
        for (temperature, node) in temperatures.iter_mut().zip(&self.nodes).skip(1) {
            if let (true, Some(oil)) = (node.is_algebraic(), oil) {
                *temperature = oil;
            }
        }
        temperatures
    }

    /// Writes the outputs from inputs and temperatures; false if the temperatures of algebraic nodes were not found.
    pub fn evaluate(&self, slots: &[Slot], values: &mut [f64]) -> bool {
        let mut temperatures = self.temperatures(slots, values);
        let mut is_solved = true;
        if self.nodes.iter().skip(1).any(Node::is_algebraic) {
            match self.stepped(slots, values, &temperatures, None) {
                Some(solved) => temperatures = solved,
                None => is_solved = false,
            }
        }
        let input = |wanted: Use| Slot::value(slots, values, wanted);
        let (speed, torque) = (input(Use::Speed), input(Use::Torque));
        let Some(state) = self.state(slots, values, &temperatures) else {
            return false;
        };
        let ratio = chosen(&self.gears, input(Use::Gear), slots).and_then(|(gear, _)| gear.ratio);
        let ratio = ratio.unwrap_or(1.0);
        let loss = state.losses[0];
        let moment = if speed == 0.0 { 0.0 } else { loss / speed.abs() };
        let sense = if speed < 0.0 { -1.0 } else { 1.0 };
        let at = |node: u32| temperatures.get(node as usize).copied().unwrap_or(0.0);
        for (slot, value) in slots.iter().zip(values) {
            if !matches!(
                slot.causality,
                Causality::Output | Causality::State | Causality::Derivative
            ) {
                continue;
            }
            *value = match slot.use_ {
                Use::LossTorque => moment,
                Use::LossPower => loss,
                Use::Efficiency => efficiency(speed * torque, loss),
                Use::OutputTorque => (torque - sense * moment) / ratio,
                Use::OutputSpeed => speed * ratio,
                Use::MotorLoss => state.losses[1],
                Use::Node(node) => at(node),
                Use::Rate(node) => state.rate(node as usize, &self.nodes, &temperatures),
                Use::ExchangerHeat(i) => {
                    let place = i as usize;
                    let exchanger = self.exchangers.get(place).zip(state.exchangers.get(place));
                    exchanger.map_or(0.0, |(e, (transfer, coolant))| transfer * (at(e.from) - coolant))
                }
                Use::Outside => f64::from(!state.inside),
                _ => *value,
            };
        }
        is_solved
    }

    /// Simulates a time (s) with constant inputs; false if no temperatures were found, and the values are then those of the last step.
    pub fn advance(&self, slots: &[Slot], values: &mut [f64], duration: f64) -> bool {
        // Rounding of the times must not add a step.
        let wanted = duration / self.step - 1e-9;
        if !(duration >= 0.0 && wanted < MOST_STEPS) {
            return false;
        }
        let count = if wanted <= 1.0 {
            1
        } else {
            wanted as usize + usize::from(wanted > (wanted as usize) as f64)
        };
        let length = duration / count as f64;
        if length <= 0.0 {
            return true;
        }
        for _ in 0..count {
            let before = self.temperatures(slots, values);
            let Some(after) = self.stepped(slots, values, &before, Some(length)) else {
                return false;
            };
            for (slot, value) in slots.iter().zip(&mut *values) {
                if let (Use::Node(node), Causality::State) = (slot.use_, slot.causality) {
                    *value = after.get(node as usize).copied().unwrap_or(*value);
                }
            }
        }
        true
    }

    /// Temperatures at the end of a step; without a length those of the algebraic nodes at the temperatures of the others.
    fn stepped(&self, slots: &[Slot], values: &[f64], before: &[f64], length: Option<f64>) -> Option<Vec<f64>> {
        let mut guess = before.to_vec();
        for pass in 1..=MOST_PASSES {
            let after = self.state(slots, values, &guess)?.solve(&self.nodes, before, length)?;
            let change = guess
                .iter()
                .zip(&after)
                .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            if change <= AGREED {
                return Some(after);
            }
            let share = if pass < CAREFUL { 1.0 } else { 0.5 };
            for (guess, after) in guess.iter_mut().zip(&after) {
                *guess += share * (after - *guess);
            }
        }
        None
    }

    /// Heat and conductances at temperatures.
    fn state(&self, slots: &[Slot], values: &[f64], temperatures: &[f64]) -> Option<State> {
        let input = |wanted: Use| Slot::value(slots, values, wanted);
        let (gear, is_gear) = chosen(&self.gears, input(Use::Gear), slots)?;
        let count = self.nodes.len();
        let mut properties = [0.0; 2];
        let mut quantities = vec![0.0; TEMPERATURES as usize];
        quantities.extend_from_slice(temperatures);
        let mut inside = self.oil_properties.interpolate(&quantities, 1.0, &mut properties) && is_gear;
        let mass = input(Use::OilFlow).max(0.0) * properties[0];
        let capacity = mass * properties[1];
        let speed = input(Use::Speed);
        let first = gear
            .losses
            .iter()
            .chain(&gear.motors)
            .map(|source| &source.table)
            .next();
        let turn = first.map(|table| Turn::new(speed, input(Use::Torque), table));
        if let Some(turn) = turn {
            quantities[SPEED as usize] = turn.speed;
            quantities[TORQUE as usize] = turn.torque;
            inside &= !turn.is_mirrored;
        } else {
            quantities[SPEED as usize] = speed.abs();
        }
        quantities[VEHICLE as usize] = input(Use::VehicleSpeed).abs();
        quantities[OIL_FLOW as usize] = mass;
        let mut state = State {
            matrix: vec![0.0; count * count],
            right: vec![0.0; count],
            held: self.nodes.iter().map(|node| node.held).collect(),
            losses: [0.0; 2],
            exchangers: Vec::with_capacity(self.exchangers.len()),
            inside,
        };
        if let (Some(ambient), true) = (state.held.first_mut(), count > 0) {
            *ambient = Some(input(Use::Ambient));
        }
        for (node, heat) in &self.sources {
            state.add_heat(*node, *heat);
        }
        for (kind, sources) in [&gear.losses, &gear.motors].into_iter().enumerate() {
            for source in sources {
                let factor = if source.over_speed { speed.abs() } else { 1.0 };
                let mut heats = vec![0.0; source.nodes.len()];
                state.inside &= source.table.interpolate(&quantities, factor, &mut heats);
                for (node, heat) in source.nodes.iter().zip(heats) {
                    state.add_heat(*node, heat);
                    state.losses[kind] += heat;
                }
            }
        }
        for link in &gear.links {
            let conductance = match &link.conductance {
                Conductance::Given(given) => *given,
                Conductance::Table(table) => {
                    let mut sum = [0.0];
                    state.inside &= table.interpolate(&quantities, 1.0, &mut sum);
                    sum[0]
                }
            };
            let [a, b] = link.between.map(|node| node as usize);
            for (here, other) in [(a, b), (b, a)] {
                state.add(here, here, conductance);
                state.add(here, other, -conductance);
            }
        }
        let rate = |flow: Flow| match flow {
            Flow::Given(given) => given,
            Flow::Share(share) => share * capacity,
        };
        for (from, to, flow) in &self.flows {
            let (from, to, flow) = (*from as usize, *to as usize, rate(*flow));
            state.add(to, to, flow);
            state.add(to, from, -flow);
        }
        for (i, e) in (0..).zip(&self.exchangers) {
            let oil = rate(e.oil);
            let coolant = input(Use::CoolantFlow(i)).max(0.0) * e.coolant_heat_capacity;
            let (transfer, inlet) = (e.transfer([oil, coolant]), input(Use::CoolantTemperature(i)));
            let (from, to) = (e.from as usize, e.to as usize);
            state.add(to, to, oil);
            state.add(to, from, transfer - oil);
            state.add_heat(e.to, transfer * inlet);
            state.exchangers.push((transfer, inlet));
        }
        // Stationary oil has the temperature of its upstream node, unless something else heats or cools it.
        let ways = self.flows.iter().map(|(from, to, _)| (*from, *to));
        for (from, to) in ways.chain(self.exchangers.iter().map(|e| (e.from, e.to))) {
            let (from, to) = (from as usize, to as usize);
            if state.matrix[to * count + to] == 0.0 && state.right[to] == 0.0 {
                state.add(to, to, 1.0);
                state.add(to, from, -1.0);
            }
        }
        Some(state)
    }
}

impl State {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let count = self.right.len();
        if let Some(entry) = self.matrix.get_mut(row * count + column) {
            *entry += value;
        }
    }

    fn add_heat(&mut self, node: u32, heat: f64) {
        if let Some(sum) = self.right.get_mut(node as usize) {
            *sum += heat;
        }
    }

    /// Change of the temperature of a node with heat capacity. \[K/s\]
    fn rate(&self, node: usize, nodes: &[Node], temperatures: &[f64]) -> f64 {
        let count = self.right.len();
        let row = self.matrix.get(node * count..(node + 1) * count).unwrap_or_default();
        let heat = self.right.get(node).copied().unwrap_or(0.0);
        let lost: f64 = row.iter().zip(temperatures).map(|(k, t)| k * t).sum();
        nodes.get(node).map_or(0.0, |heated| (heat - lost) / heated.capacity)
    }

    /// Temperatures after a backward step (s) from `before`, or of the algebraic nodes if no time passes; `None` if a node is isolated.
    fn solve(mut self, nodes: &[Node], before: &[f64], length: Option<f64>) -> Option<Vec<f64>> {
        let count = nodes.len();
        for (i, (node, before)) in nodes.iter().zip(before).enumerate() {
            let is_held = length.is_none() && node.is_state();
            if let Some(temperature) = self.held[i].or(is_held.then_some(*before)) {
                self.held[i] = Some(temperature);
                self.matrix[i * count..(i + 1) * count].fill(0.0);
                self.matrix[i * count + i] = 1.0;
                self.right[i] = temperature;
            } else if let Some(length) = length {
                self.add(i, i, node.capacity / length);
                self.right[i] += node.capacity / length * before;
            }
        }
        let mut solved = eliminate(&mut self.matrix, self.right)?;
        for (t, held) in solved.iter_mut().zip(&self.held) {
            *t = held.unwrap_or(*t);
        }
        Some(solved)
    }
}

impl Exchanger {
    /// Heat over the difference of the inlet temperatures, from both capacity flows (W/K); zero if a fluid is stationary. \[W/K\]
    ///
    /// Source: effectiveness and number of transfer units (Kays and London, Compact Heat Exchangers).
    fn transfer(&self, flows: [f64; 2]) -> f64 {
        let (least, greatest) = (flows[0].min(flows[1]), flows[0].max(flows[1]));
        if least <= 0.0 || least.is_nan() {
            return 0.0;
        }
        let (ntu, ratio) = (self.ua / least, least / greatest);
        let share = match self.arrangement {
            0 if (1.0 - ratio).abs() < 1e-9 => ntu / (1.0 + ntu),
            0 => {
                let e = exp(-ntu * (1.0 - ratio));
                (1.0 - e) / (1.0 - ratio * e)
            }
            1 => (1.0 - exp(-ntu * (1.0 + ratio))) / (1.0 + ratio),
            _ if ratio < 1e-9 => 1.0 - exp(-ntu),
            _ => 1.0 - exp(pow(ntu, 0.22) / ratio * (exp(-ratio * pow(ntu, 0.78)) - 1.0)),
        };
        share * least
    }
}

/// Solves a system of linear equations by Gaussian elimination with row pivoting; `None` if it is singular.
fn eliminate(matrix: &mut [f64], mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for column in 0..count {
        let size = |row: usize| matrix[row * count + column].abs();
        let pivot = (column..count).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        if size(pivot) == 0.0 || size(pivot).is_nan() {
            return None;
        }
        if pivot != column {
            for k in 0..count {
                matrix.swap(pivot * count + k, column * count + k);
            }
            right.swap(pivot, column);
        }
        for row in column + 1..count {
            let factor = matrix[row * count + column] / matrix[column * count + column];
            if factor == 0.0 {
                continue;
            }
            for k in column..count {
                matrix[row * count + k] -= factor * matrix[column * count + k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..count).rev() {
        let mut sum = right[row];
        for k in row + 1..count {
            sum -= matrix[row * count + k] * right[k];
        }
        right[row] = sum / matrix[row * count + row];
    }
    right.iter().all(|t| t.is_finite()).then_some(right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::content::Content;
    use crate::content::tests::network;
    use crate::model::{Fault, Model};

    fn reference(model: &Model, wanted: Use) -> u32 {
        model
            .slots()
            .iter()
            .position(|slot| slot.use_ == wanted)
            .unwrap_or(usize::MAX) as u32
    }

    fn set(model: &mut Model, wanted: Use, value: f64) {
        let reference = reference(model, wanted);
        assert_eq!(model.set(reference, Kind::Real, value), Ok(()), "{wanted:?}");
    }

    fn get(model: &mut Model, wanted: Use) -> f64 {
        let reference = reference(model, wanted);
        model.get(reference, Kind::Real).unwrap_or(f64::NAN)
    }

    /// The derivative is C dT/dt = Q - K T, with the temperature behind the cooler found at once, as in the steps of Co-Simulation.
    #[test]
    fn derivatives_are_those_of_the_steps() {
        let mut model = Model::new(Content::Network(network()));
        set(&mut model, Use::Speed, 100.0);
        set(&mut model, Use::Torque, 10.0);
        assert_eq!(model.start(), ());
        assert_eq!(model.state_count(), 1);
        for temperature in [20.0, 55.0, 90.0] {
            assert_eq!(model.set_continuous(&[temperature]), Ok(()));
            let mut rate = [0.0];
            assert_eq!(model.write_continuous(Causality::Derivative, &mut rate), Ok(()));
            assert_eq!(get(&mut model, Use::Rate(1)), rate[0]);
            assert_eq!(get(&mut model, Use::Node(1)), temperature);
            // All heat: losses of the gearbox and the motor, the constant one, the links, and the cooler.
            let heat = get(&mut model, Use::LossPower) + get(&mut model, Use::MotorLoss) + 7.0
                - get(&mut model, Use::ExchangerHeat(0))
                - 5.0 * (temperature - 20.0)
                - (temperature - 35.0);
            assert!((rate[0] - heat / 1000.0).abs() < 1e-7, "{} {}", rate[0], heat / 1000.0);
            let mut copy = model.clone();
            assert_eq!(copy.advance(1.0), Ok(()));
            let slope = get(&mut copy, Use::Node(1)) - temperature;
            // A backward step has the derivative at its end, to the agreement of its iterations.
            let end = get(&mut copy, Use::Rate(1));
            assert!((slope - end).abs() < 3.0 * AGREED, "{slope} {end}");
        }
        assert_eq!(model.set_continuous(&[f64::NAN]), Err(Fault::NotFinite));
        assert_eq!(model.set_continuous(&[1.0, 2.0]), Err(Fault::State));
        assert_eq!(model.write_continuous(Causality::State, &mut []), Err(Fault::State));
    }

    /// Heat and conductances without tables: each backward step is T = (C T0/h + Q + G Ta)/(C/h + G).
    #[test]
    fn one_node_by_hand() {
        let mut reduced = network();
        reduced.exchangers.clear();
        reduced.flows.clear();
        reduced.nodes.truncate(2);
        reduced.gears[0].links.truncate(1);
        reduced.gears[0].motors.clear();
        let mut model = Model::new(Content::Network(reduced));
        set(&mut model, Use::Speed, 100.0);
        set(&mut model, Use::Torque, 10.0);
        set(&mut model, Use::Ambient, 10.0);
        assert!((get(&mut model, Use::LossPower) - 30.0).abs() < 1e-12);
        let mut temperature = 20.0;
        for _ in 0..25 {
            temperature = (1000.0 * temperature + 37.0 + 5.0 * 10.0) / 1005.0;
        }
        assert_eq!(model.advance(25.0), Ok(()));
        assert!((get(&mut model, Use::Node(1)) - temperature).abs() < 1e-9);
        // In a long time all heat goes to the ambient.
        assert_eq!(model.advance(1e5), Ok(()));
        assert!((get(&mut model, Use::Node(1)) - (10.0 + 37.0 / 5.0)).abs() < 1e-6);
    }

    #[test]
    fn heat_of_the_exchanger_leaves_the_oil() {
        let mut model = Model::new(Content::Network(network()));
        assert_eq!(model.advance(1e5), Ok(()));
        // Steady state at standstill: 7 W come in, and leave to ambient, plate and coolant.
        let sump = get(&mut model, Use::Node(1));
        let left = 5.0 * (sump - 20.0) + 1.0 * (sump - 35.0) + get(&mut model, Use::ExchangerHeat(0));
        assert!((left - 7.0).abs() < 1e-5, "{left}");
        // Counterflow with capacity flows of 210 and 540 W/K, 350 W/K between them (u6a of the network of the framework).
        let exchanger = Exchanger {
            ua: 350.0,
            ..network().exchangers.remove(0)
        };
        assert!((exchanger.transfer([210.0, 540.0]) / 210.0 / 0.7432523 - 1.0).abs() < 1e-6);
        let cross = Exchanger {
            ua: 1.5,
            arrangement: 2,
            ..exchanger.clone()
        };
        assert!((cross.transfer([1.0, 1.0 / 0.6]) / 0.640193 - 1.0).abs() < 1e-5);
        let parallel = Exchanger {
            ua: 1.5,
            arrangement: 1,
            ..exchanger
        };
        assert!((parallel.transfer([1.0, 1.0 / 0.6]) / 0.568301 - 1.0).abs() < 1e-5);
        assert_eq!(parallel.transfer([0.0, 1.0]), 0.0);
    }

    #[test]
    fn outputs_follow_from_loss_and_ratio_in_both_senses() {
        let mut model = Model::new(Content::Network(network()));
        set(&mut model, Use::Speed, -50.0);
        set(&mut model, Use::Torque, -10.0);
        // Turned round, the load is that of 50 rad/s and 10 Nm: 0.2 Nm.
        assert_eq!(get(&mut model, Use::LossTorque), 0.2);
        assert_eq!(get(&mut model, Use::OutputSpeed), 12.5);
        assert!((get(&mut model, Use::OutputTorque) * 12.5 - (500.0 - 10.0)).abs() < 1e-9);
        assert!((get(&mut model, Use::Efficiency) - 0.98).abs() < 1e-12);
        assert!(model.is_outside(), "the tables have one sense only");
    }

    #[test]
    fn what_cannot_be_set_or_simulated_is_a_fault() {
        let mut model = Model::new(Content::Network(network()));
        let node = reference(&model, Use::Node(1));
        assert_eq!(model.set(node, Kind::Real, 60.0), Ok(()));
        model.start();
        assert_eq!(model.set(node, Kind::Real, 70.0), Err(Fault::NotSettable));
        assert_eq!(model.set(node, Kind::Integer, 1.0), Err(Fault::Unknown));
        let held = reference(&model, Use::Node(3));
        assert_eq!(model.set(held, Kind::Real, 70.0), Err(Fault::NotSettable));
        let speed = reference(&model, Use::Speed);
        assert_eq!(model.set(speed, Kind::Real, f64::INFINITY), Err(Fault::NotFinite));
        for duration in [f64::NAN, -1.0, 1e12] {
            assert_eq!(model.advance(duration), Err(Fault::NoSolution), "{duration}");
        }
        let state = model.state();
        assert_eq!(model.advance(30.0), Ok(()));
        assert_ne!(get(&mut model, Use::Node(1)), 60.0);
        assert_eq!(model.restore(&state), Ok(()));
        assert_eq!(get(&mut model, Use::Node(1)), 60.0);
        assert_eq!(model.restore(&state[1..]), Err(Fault::State));
    }
}
