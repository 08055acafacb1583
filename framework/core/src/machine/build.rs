//! From the description of machines to machines: reads their files, and refuses what contradicts itself or would be counted twice.

use std::sync::Arc;

use gearloss_document::data::TableFile;

use super::entry::{BridgeEntry, Contained, IdleEntry, InverterEntry, MachineEntry};
use super::envelope::Envelope;
use super::inverter::{Bridge, Conduction, Inverter};
use super::{Law, Machine};
use crate::attach::dangling;
use crate::codes;
use crate::description::{GearboxEntry, NetworkChoice};
use crate::document::Diagnostic;
use crate::motor::{MotorEntry, MotorMap};
use crate::registry::Files;
use crate::transmission::{NodeNames, Port};

/// Data of the transmission that machines need.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a> {
    pub names: &'a NodeNames,
    pub ports: &'a [Port],
    /// Ports and the shaft that each is.
    pub shafts: &'a crate::description::Ordered<String>,
    pub files: &'a Files,
    /// Bearings and rotor drags with a loss: shaft, path, and what it would count twice.
    pub counted: &'a [(String, String, Contained)],
}

/// The machines of the section `machines`.
pub(crate) fn machines(
    entry: &GearboxEntry,
    around: Around<'_>,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Arc<Machine>> {
    let mut all: Vec<Arc<Machine>> = Vec::new();
    for (id, machine) in entry.machines.iter() {
        let path = format!("machines.{id}");
        let before = found.len();
        let built = machine_of(&path, machine, around, found);
        let map = built.as_ref().and_then(Machine::map);
        checks(&path, (machine, map), around, found, warnings);
        if let Some(built) = built.filter(|_| found.len() == before) {
            if let Some(other) = all.iter().find(|other| other.port == built.port) {
                let message = format!("`{}` is already at port `{}`", other.path, machine.port);
                found.push(
                    Diagnostic::error(format!("{path}.port"), message)
                        .help("give each machine a port on a shaft of its own, or describe machines of one shaft as one with a map of both")
                        .code(codes::MACHINE),
                );
            }
            all.push(Arc::new(built));
        }
    }
    all
}

/// The motors of the thermal network, which are machines with nodes.
pub(crate) fn motors(
    entry: &GearboxEntry,
    around: Around<'_>,
    machines: &[Arc<Machine>],
    found: &mut Vec<Diagnostic>,
) -> Vec<Arc<Machine>> {
    let Some(NetworkChoice::Written(network)) = &entry.thermal.network else {
        return Vec::new();
    };
    let motor = |(id, motor): (&str, &MotorEntry)| {
        let path = format!("thermal.network.motors.{id}");
        let mut built = machine_of(&path, &MachineEntry::from(motor), around, found)?;
        if let Some(machine) = machines.iter().find(|machine| machine.port == built.port) {
            let message = format!(
                "`{}` is at port `{}` as well: its losses would be counted twice",
                machine.path, motor.port
            );
            let help = "delete the motor, and name `rotor` and `stator` at the machine";
            found.push(Diagnostic::error(&path, message).help(help).code(codes::MACHINE));
        }
        built.only_in_network = true;
        Some(Arc::new(built))
    };
    network.motors.iter().filter_map(motor).collect()
}

/// A finding about a machine.
fn wrong(path: impl Into<String>, message: impl Into<String>, help: &str) -> Diagnostic {
    Diagnostic::error(path, message).help(help).code(codes::MACHINE)
}

fn machine_of(path: &str, entry: &MachineEntry, around: Around<'_>, found: &mut Vec<Diagnostic>) -> Option<Machine> {
    let mut node = |key: &str, id: &Option<String>| -> Option<usize> {
        let id = id.as_ref()?;
        let node = around.names.node(id);
        if node.is_none() {
            let ids: Vec<&str> = around.names.names().iter().map(String::as_str).collect();
            found.push(dangling(&format!("{path}.{key}"), "node", id, &ids));
        }
        node
    };
    let (rotor, stator) = (node("rotor", &entry.rotor), node("stator", &entry.stator));
    let heated = entry.inverter.as_ref().and_then(|inverter| inverter.node.as_ref());
    let inverter_node = node("inverter.node", &heated.cloned());
    let port = around.ports.iter().position(|p| p.name == entry.port);
    if port.is_none() {
        let ids: Vec<&str> = around.ports.iter().map(|p| p.name.as_str()).collect();
        found.push(dangling(&format!("{path}.port"), "port", &entry.port, &ids));
    }
    if let Err(fault) = entry.rotor_share.share_at(0.0) {
        found.push(Diagnostic::error(format!("{path}.rotor_share"), fault.message).help(fault.help));
    }
    let law = match (&entry.map, entry.efficiency) {
        (Some(file), None) => {
            map_of(&format!("{path}.map"), file, around.files, found).map(|map| Law::Map(Arc::new(map)))
        }
        (None, Some(efficiency)) => Some(Law::Efficiency(efficiency)),
        (given, _) => {
            let message = if given.is_some() {
                "both `map` and `efficiency` are stated"
            } else {
                "the losses of the machine are not stated"
            };
            found.push(wrong(path, message, "write `map: FILE`, or `efficiency: 0.93`"));
            None
        }
    };
    let map = match &law {
        Some(Law::Map(map)) => Some(&**map),
        _ => None,
    };
    let inverter = entry.inverter.as_ref();
    let inverter = inverter.map(|inverter| inverter_of(path, entry, inverter, map, around.files, found));
    let law = law?;
    let mut notes = match &law {
        Law::Map(map) => map.notes.clone(),
        Law::Efficiency(_) => Vec::new(),
    };
    if let Some(Some(Inverter::Map(map))) = &inverter {
        notes.extend(map.notes.iter().cloned());
    }
    let increases = |speeds: Vec<f64>| speeds.windows(2).all(|pair| pair[0] < pair[1]);
    if !increases(entry.freewheel.iter().map(|at| at.speed).collect()) {
        found.push(wrong(
            format!("{path}.freewheel"),
            "the speeds do not increase",
            "sort them",
        ));
    }
    let port = port?;
    Some(Machine {
        path: path.to_owned(),
        port,
        member: around.ports[port].member,
        notes,
        only_in_network: false,
        nodes: rotor.zip(stator).map(|(rotor, stator)| [rotor, stator]),
        inverter_node,
        contains: entry.contains.clone(),
        rotor_share: entry.rotor_share.clone(),
        law,
        winding: entry.winding,
        freewheel: (entry.idle == IdleEntry::Off).then(|| {
            let list = &entry.freewheel;
            [
                list.iter().map(|at| at.speed).collect(),
                list.iter().map(|at| at.loss).collect(),
            ]
        }),
        voltage: entry.voltage,
        inverter: inverter.flatten(),
        envelope: entry
            .envelope
            .as_ref()
            .map(|envelope| Envelope::new(envelope, entry.voltage)),
    })
}

/// Reads a map.
fn map_of(path: &str, file: &TableFile, files: &Files, found: &mut Vec<Diagnostic>) -> Option<MotorMap> {
    match files.bytes(file.name()) {
        Err(reason) => {
            found.push(Diagnostic::error(path, reason).help("file names are relative to the gearbox document"));
            None
        }
        Ok(bytes) => match MotorMap::read_stated(file, &bytes) {
            Ok(map) => Some(map),
            Err(faults) => {
                for fault in faults {
                    let message = format!("{}: {}", file.name(), fault.message);
                    found.push(Diagnostic::error(path, message).help(fault.help));
                }
                None
            }
        },
    }
}

fn inverter_of(
    path: &str,
    machine: &MachineEntry,
    entry: &InverterEntry,
    map: Option<&MotorMap>,
    files: &Files,
    found: &mut Vec<Diagnostic>,
) -> Option<Inverter> {
    let at = format!("{path}.inverter");
    match (entry.efficiency, &entry.map, &entry.bridge) {
        (Some(efficiency), None, None) => Some(Inverter::Efficiency(efficiency)),
        (None, Some(file), None) => {
            map_of(&format!("{at}.map"), file, files, found).map(|map| Inverter::Map(Arc::new(map)))
        }
        (None, None, Some(bridge)) => {
            let at = format!("{at}.bridge");
            let bridge = bridge_of(&at, machine, bridge, map, found)?;
            Some(Inverter::Bridge(Box::new(bridge)))
        }
        (None, None, None) => {
            let help = "write `efficiency`, `map`, or `bridge` with values of the data sheet";
            found.push(wrong(at, "the losses of the inverter are not stated", help));
            None
        }
        _ => {
            found.push(wrong(
                at,
                "the losses of the inverter are stated twice",
                "keep one of `efficiency`, `map` and `bridge`",
            ));
            None
        }
    }
}

fn bridge_of(
    at: &str,
    machine: &MachineEntry,
    entry: &BridgeEntry,
    map: Option<&MotorMap>,
    found: &mut Vec<Diagnostic>,
) -> Option<Bridge> {
    let before = found.len();
    if machine.voltage.is_none() {
        let help = "add `voltage: 400 V` to the machine";
        found.push(wrong(at, "the voltage of the DC link is not known", help));
    }
    let of_map = map.is_some_and(MotorMap::has_phase);
    match &entry.current {
        None if !of_map => {
            let message =
                "a map over torque and speed alone has no current, on which the losses of the inverter depend";
            let help = "add the columns `current`, `power_factor` and `modulation` to the map, or `current: { torque: 300 Nm, current: \
                        400 A, power_factor: 0.85, base_speed: 4000 rpm }` here";
            found.push(wrong(at, message, help));
        }
        Some(_) if of_map => {
            let message = "the map of the machine already states the current";
            found.push(wrong(format!("{at}.current"), message, "delete `current`"));
        }
        Some(current) => {
            let speeds: Vec<f64> = current.field_weakening.iter().map(|at| at.speed).collect();
            if speeds.windows(2).any(|pair| pair[1] <= pair[0]) {
                let at = format!("{at}.current.field_weakening");
                found.push(wrong(at, "the speeds do not increase", "sort them"));
            }
        }
        None => {}
    }
    let four = [
        entry.transistor_voltage,
        entry.transistor_resistance,
        entry.diode_voltage,
        entry.diode_resistance,
    ];
    let conduction = match (entry.channel_resistance, four) {
        (Some(resistance), [None, None, None, None]) => Some(Conduction::Channel(resistance)),
        (None, [Some(v), Some(r), Some(vd), Some(rd)]) => Some(Conduction::Bipolar {
            transistor: [v, r],
            diode: [vd, rd],
        }),
        _ => {
            let help = "state voltage and resistance of transistor and diode, or `channel_resistance` alone";
            found.push(wrong(
                at,
                "the lines of the semiconductors are incomplete or stated twice",
                help,
            ));
            None
        }
    };
    (found.len() == before).then_some(Bridge {
        entry: entry.clone(),
        conduction: conduction?,
        voltage: machine.voltage?,
    })
}

/// Refuses what contradicts itself or would be counted twice, and warns about what is missing from the sums.
fn checks(
    path: &str,
    (entry, map): (&MachineEntry, Option<&MotorMap>),
    around: Around<'_>,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) {
    let contains_inverter = entry.contains.contains(&Contained::Inverter);
    if contains_inverter && entry.inverter.is_some() {
        let message = "the map contains the inverter, so its losses would be counted twice";
        found.push(wrong(
            format!("{path}.inverter"),
            message,
            "delete `inverter`, or `inverter` under `contains`",
        ));
    }
    if entry.rotor.is_some() != entry.stator.is_some() {
        let message = "only one of `rotor` and `stator` is stated";
        found.push(wrong(path, message, "state both nodes, or none"));
    }
    if entry.idle == IdleEntry::Energised && !entry.freewheel.is_empty() {
        let message = "`freewheel` belongs to `idle: \"off\"`";
        found.push(wrong(
            format!("{path}.freewheel"),
            message,
            "write `idle: \"off\"`, or delete it",
        ));
    }
    if let Some(envelope) = &entry.envelope {
        let at = format!("{path}.envelope");
        if envelope.peak.is_none() && envelope.continuous.is_none() {
            let help = "write for example `continuous: { torque: 180 Nm, power: 80 kW }`";
            found.push(wrong(&at, "the envelope states no torque", help));
        }
        if let (Some(peak), Some(continuous)) = (envelope.peak, envelope.continuous)
            && (continuous.torque > peak.torque || continuous.power > peak.power)
        {
            let message = "the continuous torque or power is above that of the peak";
            found.push(wrong(&at, message, "exchange `continuous` and `peak`"));
        }
        if envelope.peak_time.is_some() && (envelope.peak.is_none() || envelope.continuous.is_none()) {
            let message = "`peak_time` is the time between `continuous` and `peak`";
            found.push(wrong(format!("{at}.peak_time"), message, "state both, or delete it"));
        }
        if envelope.voltage.is_some() && entry.voltage.is_none() {
            let message = "the voltage of the DC link is not known";
            found.push(wrong(
                format!("{at}.voltage"),
                message,
                "add `voltage: 400 V` to the machine",
            ));
        }
    }
    if entry.winding.is_some() && entry.efficiency.is_some() {
        let message = "`winding` belongs to a map";
        found.push(wrong(format!("{path}.winding"), message, "delete it"));
    }
    if let Some(map) = map {
        if entry.winding.is_some() && map.has_temperatures() {
            let message = "the map states the losses at several temperatures";
            found.push(wrong(format!("{path}.winding"), message, "delete `winding`"));
        }
        match (map.voltages(), entry.voltage) {
            (Some(_), None) => {
                let message = "the map states the losses at several voltages of the DC link";
                found.push(wrong(path, message, "add `voltage: 400 V`"));
            }
            (Some((first, last)), Some(voltage)) if !(first..=last).contains(&voltage) => {
                let message = format!("the map states the losses from {first} to {last} V, not at {voltage} V");
                found.push(wrong(format!("{path}.voltage"), message, "choose a voltage of the map"));
            }
            _ => {}
        }
        if (entry.winding.is_some() || map.has_temperatures()) && entry.stator.is_none() {
            let message = "the temperature of the winding is that of the oil: no node is its `stator`";
            warnings.push(
                Diagnostic::warning(path, message)
                    .help("name `rotor` and `stator` of a thermal network")
                    .code(codes::MACHINE_DOUBTFUL),
            );
        }
    }
    if !contains_inverter && entry.inverter.is_none() {
        let message = "the losses of the inverter are in no sum";
        warnings.push(
            Diagnostic::warning(path, message)
                .help("describe `inverter`, or write `contains: [inverter]` if the map is measured at the DC link")
                .code(codes::MACHINE_DOUBTFUL),
        );
    }
    let shaft = around.shafts.get(&entry.port);
    let twice = around
        .counted
        .iter()
        .filter(|(of, ..)| shaft.is_some_and(|shaft| shaft == of));
    for (_, counted, what) in twice.filter(|(.., what)| entry.contains.contains(what)) {
        let (word, key) = match what {
            Contained::Bearings => ("bearings", "bearings"),
            _ => ("windage", "windage"),
        };
        let message =
            format!("the map contains the {word} of the rotor, and `{counted}` on its shaft has a loss as well");
        let help = format!("write `model: none` at `{counted}`, or delete `{key}` from `contains`");
        found.push(wrong(format!("{path}.contains"), message, &help));
    }
}
