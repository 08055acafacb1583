//! From the description of a network to the network: resolves names and builds models.

use std::sync::Arc;

use super::faults;
use super::parts::{Exchanger, InverterSeat, Law, Lawful, Link, Motor, Network, Rate};
use crate::attach::dangling;
use crate::description::network::{ExchangerEntry, LinkEntry, NetworkEntry};
use crate::description::{GearboxEntry, NetworkChoice};
use crate::document::Diagnostic;
use crate::lubricant::Lubricant;
use crate::machine::Machine;
use crate::mechanism::heat_dissipation::HousingPart;
use crate::mechanism::heat_link::{GearMaterial, GearShape, HeatLink, HeatLinkPart};
use crate::registry::Build;
use crate::transmission::{AMBIENT, GearSeat, NodeNames};

/// Data of the transmission that a network needs while it is built.
pub(crate) struct Around<'a> {
    /// Names of nodes.
    pub names: &'a NodeNames,
    /// Names of members.
    pub members: &'a [String],
    /// Gears.
    pub gears: &'a [GearSeat],
    /// Numbers of the gears of each mesh.
    pub meshes: Vec<[usize; 2]>,
    /// Oils by name; empty if one has a fault that was reported.
    pub lubricants: &'a [(String, Arc<Lubricant>)],
    /// The outside of the housing.
    pub housing: &'a HousingPart,
    /// Machines with their nodes, if they have some.
    pub machines: &'a [Arc<Machine>],
}

impl Network {
    /// The network of a description; `None` without one, or if it has faults, which become findings.
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
        let lubricant = lubricant_of(entry, around);
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
                    Diagnostic::error(path.clone(), "both `capacity` and `share` are stated")
                        .help("remove one of them"),
                );
            }
            let element = element(&path, flow.element.as_ref(), flow.capacity, build, found);
            if flow.element.is_some() && element.is_none() {
                continue;
            }
            let rate = rate(&path, flow.capacity, (flow.share, element), network, found);
            if let ([Some(from), Some(to)], Some(rate)) = (ends, rate) {
                if from == to {
                    found.push(same_node(&path));
                }
                flows.push(([from, to], rate));
            }
        }
        let exchangers: Vec<Exchanger> = network
            .exchangers
            .iter()
            .filter_map(|(id, e)| {
                let path = format!("thermal.network.exchangers.{id}");
                let element = element(&path, e.element.as_ref(), e.capacity, build, found);
                if e.element.is_some() && element.is_none() {
                    return None;
                }
                exchanger(&path, e, element, network, around, found)
            })
            .collect();
        let mut sources = Vec::new();
        for (id, source) in network.sources.iter() {
            let path = format!("thermal.network.sources.{id}.into");
            sources.extend(node(&path, &source.into, found).map(|node| (node, source.heat)));
        }
        let motors = around.machines.iter().filter_map(|machine| {
            let [rotor, stator] = machine.nodes?;
            Some(Motor {
                machine: Arc::clone(machine),
                rotor,
                stator,
            })
        });
        let motors = motors.collect();
        let inverters = around.machines.iter().filter_map(|machine| {
            let node = machine.inverter_node?;
            Some(InverterSeat {
                machine: Arc::clone(machine),
                node,
            })
        });
        let inverters = inverters.collect();
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
            inverters,
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
}

/// That of the oil of the housing, else the first.
fn lubricant_of(entry: &GearboxEntry, around: &Around<'_>) -> Option<Arc<Lubricant>> {
    let found = match &entry.housing.oil {
        Some(oil) => around.lubricants.iter().find(|(name, _)| *name == oil.lubricant),
        None => around.lubricants.first(),
    };
    found.map(|(_, lubricant)| Arc::clone(lubricant))
}

fn node_of(names: &NodeNames, path: &str, id: &str, found: &mut Vec<Diagnostic>) -> Option<usize> {
    let node = names.node(id);
    if node.is_none() {
        let ids: Vec<&str> = names.names().iter().map(String::as_str).collect();
        found.push(dangling(path, "node", id, &ids));
    }
    node
}

fn same_node(path: &str) -> Diagnostic {
    Diagnostic::error(path, "both ends are the same node").help("name two nodes")
}

fn law(
    path: &str,
    link: &LinkEntry,
    around: &Around<'_>,
    of_network: Option<&Arc<Lubricant>>,
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
                found.push(dangling(&format!("{path}.shaft"), "shaft or idler gear", id, &ids));
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
        None => of_network,
    };
    if matches!(gear, Some(None)) {
        return None;
    }
    let law = match (link.conductance, &link.model) {
        (Some(given), None) => Law::Given(given),
        (None, Some(choice)) => {
            let part = HeatLinkPart {
                housing: Some(*around.housing),
                gear: gear
                    .flatten()
                    .filter(|g| g.diameters[0] > 0.0)
                    .map(|gear| shape(gear, mate(gear, between, around))),
            };
            let part = build.part_again(path, part);
            match build.slot_at::<HeatLink>(&format!("{path}.model"), &part, &choice.value) {
                Ok(model) => Law::Model(Box::new(Lawful {
                    supply: build.supply(&model),
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
            let (what, help) = if given.is_some() {
                ("both `conductance` and `model` are stated", "remove one of them")
            } else {
                ("the link has no conductance", "add `conductance: 10 W/K`, or a `model`")
            };
            found.push(Diagnostic::error(path, what).help(help));
            return None;
        }
    };
    let [Some(first), Some(second)] = between else {
        return None;
    };
    if first == second {
        found.push(same_node(path));
        return None;
    }
    Some(Link {
        path: path.to_owned(),
        between: [first, second],
        law,
    })
}

/// The gear that meshes with one and has one of these nodes, the first of several; else the first that meshes with it.
fn mate<'a>(gear: &GearSeat, nodes: [Option<usize>; 2], around: &Around<'a>) -> Option<&'a GearSeat> {
    let own = around.names.of_gear(&gear.id);
    let others = around.meshes.iter().filter_map(|pair| {
        let place = pair.iter().position(|of| around.gears[*of].id == gear.id)?;
        Some(&around.gears[pair[1 - place]])
    });
    let in_the_link = |other: &&GearSeat| {
        let node = around.names.of_gear(&other.id);
        node.is_some() && node != own && nodes.contains(&node)
    };
    others.clone().find(in_the_link).or_else(|| others.clone().next())
}

/// A gear and its mate in the form used by heat models.
fn shape(gear: &GearSeat, mate: Option<&GearSeat>) -> GearShape {
    let [pitch, tip, root] = gear.diameters;
    GearShape {
        teeth: gear.z,
        pitch_diameter: pitch,
        tip_diameter: tip,
        tooth_height: 0.5 * (tip - root).abs(),
        facewidth: gear.facewidth,
        material: gear.material.map_or_else(GearMaterial::default, GearMaterial::from),
        mate: mate
            .and_then(|mate| mate.material)
            .map_or_else(GearMaterial::default, GearMaterial::from),
    }
}

/// Number of an element of the oil network; `None` without one, or reported.
fn element(
    path: &str,
    name: Option<&String>,
    capacity: Option<f64>,
    build: &Build<'_>,
    found: &mut Vec<Diagnostic>,
) -> Option<usize> {
    let name = name?;
    let path = format!("{path}.element");
    if capacity.is_some() {
        found.push(
            Diagnostic::error(path.clone(), "both `capacity` and `element` are stated").help("remove one of them"),
        );
    }
    let known = build.oil_elements.as_deref().unwrap_or_default();
    let ids: Vec<&str> = known
        .iter()
        .filter_map(|path| path.strip_prefix("oil_network."))
        .collect();
    let number = ids.iter().position(|id| id == name);
    if number.is_none() {
        found.push(dangling(&path, "element of the oil network", name, &ids));
    }
    number
}

fn rate(
    path: &str,
    capacity: Option<f64>,
    (share, element): (Option<f64>, Option<usize>),
    network: &NetworkEntry,
    found: &mut Vec<Diagnostic>,
) -> Option<Rate> {
    match (capacity, element) {
        (Some(given), _) => Some(Rate::Given(given)),
        (None, Some(element)) => Some(Rate::Element(element, share.unwrap_or(1.0))),
        (None, None) if network.oil_flow.is_some() => Some(Rate::Share(share.unwrap_or(1.0))),
        (None, None) => {
            found.push(
                Diagnostic::error(path, "the flow is not stated").help(
                    "add `oil_flow: 8 l/min` to the network, or `capacity: 200 W/K` or an `element` of the oil network here",
                ),
            );
            None
        }
    }
}

fn exchanger(
    path: &str,
    entry: &ExchangerEntry,
    element: Option<usize>,
    network: &NetworkEntry,
    around: &Around<'_>,
    found: &mut Vec<Diagnostic>,
) -> Option<Exchanger> {
    let from = node_of(around.names, &format!("{path}.from"), &entry.from, found);
    let to = node_of(around.names, &format!("{path}.to"), &entry.to, found);
    let oil = rate(path, entry.capacity, (None, element), network, found);
    if from.is_some() && from == to {
        found.push(same_node(path));
    }
    let held = network
        .nodes
        .get(&entry.to)
        .is_some_and(|node| node.temperature.is_some());
    if held || entry.to == AMBIENT {
        let message = format!(
            "`{}` has a prescribed temperature, but the exchanger determines it",
            entry.to
        );
        found.push(
            Diagnostic::error(format!("{path}.to"), message)
                .help("use a separate node without `temperature` for the oil after the exchanger"),
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
