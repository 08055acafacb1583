//! A thermal network as built: indices in place of names, laws in place of choices.

use std::cell::Cell;
use std::sync::Arc;

use super::circuit::{Circuit, Exchange};
use super::faults;
use crate::attach::dangling;
use crate::description::network::{ExchangerEntry, LinkEntry, NetworkEntry};
use crate::description::{GearboxEntry, NetworkChoice};
use crate::document::Diagnostic;
use crate::duty::{MotorEntry, MotorMap, RotorShare};
use crate::evaluate::Scratch;
use crate::loss::{Extent, Notes, Undefined};
use crate::lubricant::Lubricant;
use crate::mechanism::heat_dissipation::HousingPart;
use crate::mechanism::heat_link::{GearShape, HeatLink, HeatLinkAt, HeatLinkPart};
use crate::registry::{Build, Files, Slot};
use crate::thermal::Arrangement;
use crate::transmission::{AMBIENT, GearSeat, HeatPath, NodeNames, PartKind, Port, Transmission};

/// What surrounds a gearbox at one time. Absent is what the description says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surroundings {
    /// Temperature of the surroundings. \[degC\]
    pub ambient: Option<f64>,
    /// Speed of the vehicle. \[m/s\]
    pub vehicle_speed: f64,
    /// Mass flow of the oil that a pump drives round. \[kg/s\]
    pub oil_flow: Option<f64>,
    /// Mass flow of the coolant of every heat exchanger. \[kg/s\]
    pub coolant_flow: Option<f64>,
    /// Temperature at which it comes in. \[degC\]
    pub coolant_temperature: Option<f64>,
}

/// Conductance of a link.
enum Law {
    Given(f64),
    Model(Box<Lawful>),
}

/// A law with what it sees.
struct Lawful {
    model: Slot<HeatLink>,
    part: Arc<HeatLinkPart>,
    member: Option<usize>,
    lubricant: Arc<Lubricant>,
}

/// One link.
pub struct Link {
    /// Path, such as `thermal.network.links.casing_air`.
    pub path: String,
    between: [usize; 2],
    law: Law,
}

/// How much flows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Rate {
    /// Mass flow times specific heat. \[W/K\]
    Given(f64),
    /// A share of the oil that a pump drives round.
    Share(f64),
}

struct Exchanger {
    path: String,
    from: usize,
    to: usize,
    oil: Rate,
    ua: f64,
    arrangement: Arrangement,
    /// \[kg/s\]
    coolant_flow: f64,
    coolant_heat_capacity: f64,
    coolant_temperature: f64,
}

/// An electric motor at a port.
struct Motor {
    path: String,
    /// What was noted while its map was read.
    notes: Vec<String>,
    map: MotorMap,
    rotor_share: RotorShare,
    member: usize,
    rotor: usize,
    stator: usize,
}

/// A thermal network.
pub struct Network {
    names: Vec<String>,
    capacities: Vec<f64>,
    /// Temperatures of held nodes; the first node is the surroundings. \[degC\]
    held: Vec<Option<f64>>,
    /// Temperatures at the start, where stated. \[degC\]
    starts: Vec<Option<f64>>,
    links: Vec<Link>,
    flows: Vec<([usize; 2], Rate)>,
    exchangers: Vec<Exchanger>,
    sources: Vec<(usize, f64)>,
    motors: Vec<Motor>,
    heat: Vec<HeatPath>,
    /// The oil of the housing.
    oil: usize,
    pumped: Option<f64>,
    lubricant: Arc<Lubricant>,
    ambient: f64,
}

/// What a network needs of the transmission that is being built.
pub(crate) struct Around<'a> {
    /// Names of nodes.
    pub names: &'a NodeNames,
    /// Names of members.
    pub members: &'a [String],
    /// Gears.
    pub gears: &'a [GearSeat],
    /// Oils by name; empty where one has a fault that was reported.
    pub lubricants: &'a [(String, Arc<Lubricant>)],
    /// The outside of the housing.
    pub housing: &'a HousingPart,
    /// Ports.
    pub ports: &'a [Port],
    /// Files that the description names.
    pub files: &'a Files,
}

impl Network {
    /// The network of a description; absent without one, and where it has faults, which go to the findings.
    pub(crate) fn new(
        entry: &GearboxEntry,
        around: &Around<'_>,
        build: &mut Build<'_>,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Self> {
        let Some(NetworkChoice::Written(network)) = &entry.thermal.network else {
            return None;
        };
        let before = found.len();
        let ambient = entry.thermal.ambient;
        let all = || network.nodes.iter().map(|(_, node)| node);
        let of_oil = entry.housing.oil.as_ref().map(|oil| oil.lubricant.as_str());
        let lubricant = of_oil
            .map_or_else(
                || around.lubricants.first(),
                |id| around.lubricants.iter().find(|(name, _)| name == id),
            )
            .map(|(_, lubricant)| Arc::clone(lubricant));
        let links: Vec<Link> = network
            .links
            .iter()
            .filter_map(|(id, link)| {
                let path = format!("thermal.network.links.{id}");
                law(&path, link, around, lubricant.as_ref(), build, found)
            })
            .collect();
        let node = |path: &str, id: &str, found: &mut Vec<Diagnostic>| node_of(around.names, path, id, found);
        let mut flows = Vec::new();
        for (id, flow) in network.flows.iter() {
            let path = format!("thermal.network.flows.{id}");
            let ends = [
                node(&format!("{path}.from"), &flow.from, found),
                node(&format!("{path}.to"), &flow.to, found),
            ];
            if flow.capacity.is_some() && flow.share.is_some() {
                found.push(
                    Diagnostic::error(path.clone(), "both `capacity` and `share` are given")
                        .mend("leave one of them out"),
                );
            }
            let rate = rate(&path, flow.capacity, flow.share, network, found);
            if let ([Some(from), Some(to)], Some(rate)) = (ends, rate) {
                if from == to {
                    found.push(same(&path));
                }
                flows.push(([from, to], rate));
            }
        }
        let exchangers: Vec<Exchanger> = network
            .exchangers
            .iter()
            .filter_map(|(id, e)| exchanger(&format!("thermal.network.exchangers.{id}"), e, network, around, found))
            .collect();
        let mut sources = Vec::new();
        for (id, source) in network.sources.iter() {
            let path = format!("thermal.network.sources.{id}.into");
            sources.extend(node(&path, &source.into, found).map(|node| (node, source.heat)));
        }
        let motors: Vec<Motor> = network
            .motors
            .iter()
            .filter_map(|(id, e)| motor(&format!("thermal.network.motors.{id}"), e, around, found))
            .collect();
        let built = Self {
            names: around.names.names().to_vec(),
            capacities: std::iter::once(0.0).chain(all().map(|n| n.heat_capacity)).collect(),
            held: std::iter::once(Some(ambient))
                .chain(all().map(|n| n.temperature))
                .collect(),
            starts: std::iter::once(None).chain(all().map(|n| n.start)).collect(),
            links,
            flows,
            exchangers,
            sources,
            motors,
            heat: Vec::new(),
            oil: around.names.of_oil(""),
            pumped: network.oil_flow,
            lubricant: lubricant?,
            ambient,
        };
        if found.len() == before {
            faults::check(&built.shape(), found);
        }
        (found.len() == before).then_some(built)
    }

    /// Says where the heat of each part goes, in the order of the parts.
    pub(crate) fn set_heat(&mut self, heat: Vec<HeatPath>) {
        self.heat = heat;
    }

    /// Adds the heat of all parts at the point that was evaluated last to that of the nodes. \[W\]
    pub(super) fn add_parts(&self, transmission: &Transmission, scratch: &Scratch, heat: &mut [f64]) {
        for ((part, way), watts) in transmission.parts().iter().zip(&self.heat).zip(scratch.watts()) {
            match (way, part.kind) {
                (HeatPath::Gears([first, second]), PartKind::Mesh(mesh)) => {
                    let share = scratch.first_heat(mesh);
                    heat[*first] += share * watts;
                    heat[*second] += (1.0 - share) * watts;
                }
                (HeatPath::Gears(nodes), _) => spread(*watts, nodes, heat),
                (HeatPath::Nodes(nodes), _) => spread(*watts, nodes, heat),
            }
        }
    }

    /// Adds the losses of all motors at the point that was evaluated last to the heat of the nodes, and tells them for rotor and
    /// stator; true where one is beyond its map. \[W\]
    pub(super) fn add_motors(
        &self,
        temperatures: &[f64],
        scratch: &Scratch,
        heat: &mut [f64],
        losses: &mut Vec<[f64; 2]>,
    ) -> bool {
        let mut outside = false;
        losses.clear();
        for motor in &self.motors {
            let (speed, torque) = (scratch.speeds()[motor.member], scratch.port_torque(motor.member));
            // The windings are in the stator.
            let found = motor.map.loss(speed, torque, temperatures[motor.stator]);
            outside |= found.outside;
            let share = motor.rotor_share.at(speed.abs()).unwrap_or(0.0);
            let own = [share * found.loss, (1.0 - share) * found.loss];
            heat[motor.rotor] += own[0];
            heat[motor.stator] += own[1];
            losses.push(own);
        }
        outside
    }

    /// Names, capacities and connections, for checks.
    fn shape(&self) -> faults::Shape<'_> {
        faults::Shape {
            names: &self.names,
            capacities: &self.capacities,
            held: self.held.iter().map(Option::is_some).collect(),
            links: self.links.iter().map(|link| link.between).collect(),
            flows: self
                .flows
                .iter()
                .map(|(ends, _)| *ends)
                .chain(self.exchangers.iter().map(|e| [e.from, e.to]))
                .collect(),
            cooled: self.exchangers.iter().map(|e| e.to).collect(),
        }
    }

    /// Names of the nodes, the surroundings first.
    pub fn names(&self) -> &[String] {
        &self.names
    }
    /// Heat capacities of the nodes. \[J/K\]
    pub fn capacities(&self) -> &[f64] {
        &self.capacities
    }
    /// True for nodes that are held at a temperature.
    pub fn is_held(&self, node: usize) -> bool {
        self.held[node].is_some()
    }
    /// Number of the node that is the oil of the housing.
    pub fn oil(&self) -> usize {
        self.oil
    }
    /// Links with their paths and ends.
    pub fn links(&self) -> impl ExactSizeIterator<Item = (&str, [usize; 2])> {
        self.links.iter().map(|link| (link.path.as_str(), link.between))
    }
    /// True where a pump drives oil round, so that a recorded flow counts.
    pub fn is_pumped(&self) -> bool {
        self.pumped.is_some()
    }
    /// Paths of the heat exchangers.
    pub fn exchangers(&self) -> impl ExactSizeIterator<Item = &str> {
        self.exchangers.iter().map(|e| e.path.as_str())
    }
    /// What is worth knowing of the maps of motors.
    pub(crate) fn warnings(&self) -> impl Iterator<Item = Diagnostic> {
        let motors = self.motors.iter();
        motors.flat_map(|m| {
            let path = format!("{}.map", m.path);
            m.notes
                .iter()
                .map(move |note| Diagnostic::warning(path.clone(), note.clone()))
        })
    }
    /// Paths of the motors.
    pub fn motors(&self) -> impl ExactSizeIterator<Item = &str> {
        self.motors.iter().map(|m| m.path.as_str())
    }
    /// Heat from elsewhere by node. \[W\]
    pub fn sources(&self) -> &[(usize, f64)] {
        &self.sources
    }
    /// Where the heat of a part goes, by its number.
    pub fn heat(&self, part: usize) -> &HeatPath {
        &self.heat[part]
    }

    /// Temperatures at the start: held nodes as they are held, others as stated, else `start`, else the surroundings. \[degC\]
    pub fn start(&self, start: Option<f64>, around: &Surroundings) -> Vec<f64> {
        let ambient = around.ambient.unwrap_or(self.ambient);
        (0..self.names.len())
            .map(|i| self.held(i, around).or(self.starts[i]).or(start).unwrap_or(ambient))
            .collect()
    }

    /// Temperature of a held node. \[degC\]
    fn held(&self, node: usize, around: &Surroundings) -> Option<f64> {
        match (node, around.ambient) {
            (0, Some(ambient)) => Some(ambient),
            _ => self.held[node],
        }
    }

    /// Writes the numbers of the network at temperatures of its nodes (degC) and speeds of the members (rad/s).
    ///
    /// # Errors
    /// Number of the link whose law has no value, and why.
    pub(crate) fn circuit(
        &self,
        temperatures: &[f64],
        (speeds, cells): (&[f64], &[Cell<Extent>]),
        around: &Surroundings,
        circuit: &mut Circuit,
    ) -> Result<(), (usize, Undefined)> {
        circuit.capacities.clone_from(&self.capacities);
        circuit.held.clear();
        circuit.held.extend((0..self.names.len()).map(|i| self.held(i, around)));
        // One mass flow all round, so that none is lost: that of the oil of the housing.
        let oil = temperatures[self.oil];
        let pumped = || self.pumped.unwrap_or(0.0) * self.lubricant.density(oil);
        let mass = around.oil_flow.unwrap_or_else(pumped);
        let capacity = mass * self.lubricant.heat_capacity(oil);
        let rate = |rate: Rate| match rate {
            Rate::Given(given) => given,
            Rate::Share(share) => share * capacity,
        };
        circuit.links.clear();
        for (i, link) in self.links.iter().enumerate() {
            let conductance = match &link.law {
                Law::Given(given) => *given,
                Law::Model(law) => {
                    let ends = link.between.map(|node| temperatures[node]);
                    law.conductance(ends, speeds, around.vehicle_speed, mass, cells)
                        .map_err(|e| (i, e))?
                }
            };
            circuit.links.push((link.between, conductance));
        }
        circuit.flows.clear();
        circuit
            .flows
            .extend(self.flows.iter().map(|(ends, flow)| (*ends, rate(*flow))));
        circuit.exchangers.clear();
        circuit.exchangers.extend(self.exchangers.iter().map(|e| {
            let oil = rate(e.oil);
            let coolant = around.coolant_flow.unwrap_or(e.coolant_flow) * e.coolant_heat_capacity;
            Exchange {
                from: e.from,
                to: e.to,
                oil,
                transfer: e.arrangement.transfer(e.ua, [oil, coolant]),
                coolant: around.coolant_temperature.unwrap_or(e.coolant_temperature),
            }
        }));
        Ok(())
    }
}

impl Lawful {
    fn conductance(
        &self,
        [first, second]: [f64; 2],
        speeds: &[f64],
        vehicle_speed: f64,
        oil_flow: f64,
        cells: &[Cell<Extent>],
    ) -> Result<f64, Undefined> {
        let oil = self.lubricant.at(0.5 * (first + second));
        let at = HeatLinkAt {
            part: &self.part,
            temperature_1: first,
            temperature_2: second,
            speed: self.member.map_or(0.0, |member| speeds[member].abs()),
            vehicle_speed: vehicle_speed.abs(),
            nu: oil.nu,
            eta: oil.eta,
            rho: oil.rho,
            heat_capacity: self.lubricant.heat_capacity(oil.temperature),
            conductivity: oil.conductivity,
            oil_flow,
            notes: Notes::new(cells, self.model.notes),
        };
        let conductance = self.model.conductance(&at)?;
        if conductance.is_finite() && conductance >= 0.0 {
            Ok(conductance)
        } else {
            Err(Undefined {
                what: "conductance of a link, which is negative or not finite [W/K]",
                value: conductance,
            })
        }
    }
}

/// Adds a heat to nodes by equal parts.
fn spread(watts: f64, nodes: &[usize], heat: &mut [f64]) {
    for node in nodes {
        heat[*node] += watts / nodes.len() as f64;
    }
}

fn node_of(names: &NodeNames, path: &str, id: &str, found: &mut Vec<Diagnostic>) -> Option<usize> {
    let node = names.node(id);
    if node.is_none() {
        let ids: Vec<&str> = names.names().iter().map(String::as_str).collect();
        found.push(dangling(path, "node", id, &ids));
    }
    node
}

fn same(path: &str) -> Diagnostic {
    Diagnostic::error(path, "both ends are one node").mend("name two nodes")
}

fn law(
    path: &str,
    link: &LinkEntry,
    around: &Around<'_>,
    own: Option<&Arc<Lubricant>>,
    build: &mut Build<'_>,
    found: &mut Vec<Diagnostic>,
) -> Option<Link> {
    let between = match &link.between[..] {
        [a, b] => [a, b].map(|id| node_of(around.names, &format!("{path}.between"), id, found)),
        _ => return None,
    };
    let gear = link.gear.as_ref().map(|id| {
        let gear = around.gears.iter().find(|g| g.id == *id);
        if gear.is_none() {
            let ids: Vec<&str> = around.gears.iter().map(|g| g.id.as_str()).collect();
            found.push(dangling(&format!("{path}.gear"), "gear", id, &ids));
        }
        gear
    });
    let member = match &link.shaft {
        Some(id) => {
            let member = around.members.iter().position(|m| m == id);
            if member.is_none() {
                let ids: Vec<&str> = around.members.iter().map(String::as_str).collect();
                found.push(dangling(&format!("{path}.shaft"), "shaft or loose gear", id, &ids));
            }
            member
        }
        None => gear.flatten().map(|g| g.member),
    };
    let lubricant = match &link.lubricant {
        Some(id) => {
            let named = around
                .lubricants
                .iter()
                .find(|(name, _)| name == id)
                .map(|(_, oil)| oil);
            if named.is_none() && !around.lubricants.is_empty() {
                let ids: Vec<&str> = around.lubricants.iter().map(|(name, _)| name.as_str()).collect();
                found.push(dangling(&format!("{path}.lubricant"), "lubricant", id, &ids));
            }
            named
        }
        None => own,
    };
    if matches!(gear, Some(None)) {
        return None;
    }
    let law = match (link.conductance, &link.model) {
        (Some(given), None) => Law::Given(given),
        (None, Some(choice)) => {
            let part = Arc::new(HeatLinkPart {
                housing: Some(*around.housing),
                gear: gear.flatten().filter(|g| g.diameters[0] > 0.0).map(shape),
            });
            match build.slot_at::<HeatLink>(&format!("{path}.model"), &part, &choice.value) {
                Ok(model) => Law::Model(Box::new(Lawful {
                    model,
                    part,
                    member,
                    lubricant: Arc::clone(lubricant?),
                })),
                Err(error) => {
                    found.push(error);
                    return None;
                }
            }
        }
        (given, _) => {
            let (what, mend) = if given.is_some() {
                ("both `conductance` and `model` are given", "leave one of them out")
            } else {
                ("the link has no conductance", "add `conductance: 10 W/K`, or a `model`")
            };
            found.push(Diagnostic::error(path, what).mend(mend));
            return None;
        }
    };
    let [Some(first), Some(second)] = between else {
        return None;
    };
    if first == second {
        found.push(same(path));
        return None;
    }
    Some(Link {
        path: path.to_owned(),
        between: [first, second],
        law,
    })
}

/// A gear as a law of heat sees it.
fn shape(gear: &GearSeat) -> GearShape {
    let [pitch, tip, root] = gear.diameters;
    GearShape {
        teeth: gear.z,
        pitch_diameter: pitch,
        tip_diameter: tip,
        tooth_height: 0.5 * (tip - root).abs(),
        facewidth: gear.facewidth,
    }
}

fn rate(
    path: &str,
    capacity: Option<f64>,
    share: Option<f64>,
    network: &NetworkEntry,
    found: &mut Vec<Diagnostic>,
) -> Option<Rate> {
    match capacity {
        Some(given) => Some(Rate::Given(given)),
        None if network.oil_flow.is_some() => Some(Rate::Share(share.unwrap_or(1.0))),
        None => {
            found.push(
                Diagnostic::error(path, "nothing says how much flows")
                    .mend("add `oil_flow: 8 l/min` to the network, or `capacity: 200 W/K` here"),
            );
            None
        }
    }
}

fn motor(path: &str, entry: &MotorEntry, around: &Around<'_>, found: &mut Vec<Diagnostic>) -> Option<Motor> {
    let rotor = node_of(around.names, &format!("{path}.rotor"), &entry.rotor, found);
    let stator = node_of(around.names, &format!("{path}.stator"), &entry.stator, found);
    let port = around.ports.iter().find(|p| p.name == entry.port);
    if port.is_none() {
        let ids: Vec<&str> = around.ports.iter().map(|p| p.name.as_str()).collect();
        found.push(dangling(&format!("{path}.port"), "port", &entry.port, &ids));
    }
    if let Err(fault) = entry.rotor_share.at(0.0) {
        found.push(Diagnostic::error(format!("{path}.rotor_share"), fault.message).mend(fault.mend));
    }
    let map = match around.files.text(&entry.map) {
        Err(reason) => {
            let error = Diagnostic::error(format!("{path}.map"), reason);
            found.push(error.mend("file names are relative to the gearbox document"));
            None
        }
        Ok(text) => match MotorMap::read(text.as_bytes()) {
            Ok(map) => Some(map),
            Err(faults) => {
                for fault in faults {
                    let message = format!("{}: {}", entry.map, fault.message);
                    found.push(Diagnostic::error(format!("{path}.map"), message).mend(fault.mend));
                }
                None
            }
        },
    };
    let map = map?;
    Some(Motor {
        path: path.to_owned(),
        notes: map.notes.clone(),
        map,
        rotor_share: entry.rotor_share.clone(),
        member: port?.member,
        rotor: rotor?,
        stator: stator?,
    })
}

fn exchanger(
    path: &str,
    entry: &ExchangerEntry,
    network: &NetworkEntry,
    around: &Around<'_>,
    found: &mut Vec<Diagnostic>,
) -> Option<Exchanger> {
    let from = node_of(around.names, &format!("{path}.from"), &entry.from, found);
    let to = node_of(around.names, &format!("{path}.to"), &entry.to, found);
    let oil = rate(path, entry.capacity, None, network, found);
    if from.is_some() && from == to {
        found.push(same(path));
    }
    let held = network
        .nodes
        .get(&entry.to)
        .is_some_and(|node| node.temperature.is_some());
    if held || entry.to == AMBIENT {
        let message = format!("`{}` is held at a temperature, and the exchanger decides it", entry.to);
        found.push(
            Diagnostic::error(format!("{path}.to"), message)
                .mend("name a node of its own for the oil behind the exchanger, without a `temperature`"),
        );
    }
    Some(Exchanger {
        path: path.to_owned(),
        from: from?,
        to: to?,
        oil: oil?,
        ua: entry.ua,
        arrangement: entry.arrangement,
        coolant_flow: entry.coolant_flow * entry.coolant_density,
        coolant_heat_capacity: entry.coolant_heat_capacity,
        coolant_temperature: entry.coolant_temperature,
    })
}
