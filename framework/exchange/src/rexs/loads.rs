//! Load cases: speeds, torques, forces, temperatures and durations.

use super::map::{Force, Map, id, named};
use super::model::{Component, Id, LoadCase};
use super::pose::Vector;
use super::source::Source;
use super::units::Quantity;

/// Torque and speed of one load case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    pub name: String,
    /// Number of the spectrum in the file, from one.
    pub spectrum: usize,
    /// \[Nm\]
    pub torque: f64,
    /// \[rpm\]
    pub speed: f64,
    pub gear: Option<i64>,
    /// \[degC\]
    pub oil: Option<f64>,
    /// Share of the time of its spectrum. \[%\]
    pub share: Option<f64>,
    /// \[h\]
    pub time: Option<f64>,
    /// Its place in the lists of forces.
    pub number: usize,
}

/// All that a study needs.
#[derive(Debug, Default)]
pub struct Loads {
    /// Members at which torque enters or leaves, and their names; the first is the input.
    pub ports: Vec<(Id, String)>,
    pub torque_at: String,
    pub speed_at: String,
    pub cases: Vec<Case>,
}

/// A load case with what the components state without it.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    source: &'a Source<'a>,
    case: Option<&'a LoadCase>,
}

impl<'a> Values<'a> {
    /// The component of the load case if it states an attribute, else that of the model.
    fn holder(&self, component: &'a Component, id: &str) -> &'a Component {
        let in_case = self.case.and_then(|case| case.components.get(&component.id));
        in_case
            .filter(|in_case| in_case.attribute(id).is_some())
            .unwrap_or(component)
    }

    /// True if the load case itself states an attribute.
    pub(super) fn states(&self, component: &Component, id: &str) -> bool {
        let in_case = self.case.and_then(|case| case.components.get(&component.id));
        in_case.is_some_and(|in_case| in_case.attribute(id).is_some())
    }

    /// What the components state without a load case.
    pub(super) fn without_case(self) -> Self {
        Self { case: None, ..self }
    }

    pub(super) fn number(&self, component: &'a Component, id: &str, quantity: Quantity) -> Option<f64> {
        self.source.number(self.holder(component, id), id, quantity)
    }

    /// Several numbers; see [`Source::numbers`].
    pub(super) fn numbers(&self, component: &'a Component, id: &str, quantity: Quantity) -> Option<Vec<f64>> {
        self.source.numbers(self.holder(component, id), id, quantity)
    }

    /// The time of a load case itself: that of the gear unit is the life of the gearbox.
    fn own_time(&self, unit: &'a Component) -> Option<f64> {
        let in_case = self.case?.components.get(&unit.id)?;
        self.source.number(in_case, "operating_time", Quantity::Time)
    }

    fn flag(&self, component: &'a Component, id: &str) -> Option<bool> {
        self.source.flag(self.holder(component, id), id)
    }
}

/// All load cases with their spectrum; the components alone if there is none.
pub(super) fn all<'a>(source: &'a Source<'a>) -> Vec<(usize, Values<'a>)> {
    let spectra = source.model.spectra.iter().enumerate();
    let mut all: Vec<(usize, Values<'a>)> = spectra
        .flat_map(|(i, spectrum)| spectrum.cases.iter().map(move |case| (i + 1, case)))
        .map(|(spectrum, case)| {
            (
                spectrum,
                Values {
                    source,
                    case: Some(case),
                },
            )
        })
        .collect();
    if all.is_empty() {
        all.push((1, Values { source, case: None }));
    }
    all
}

/// Most load cases that are read; longer series are no load spectrum.
pub const MOST_CASES: usize = 10_000;

/// The external forces and moments that are not zero in all load cases.
pub fn forces(map: &Map<'_>) -> Vec<Force> {
    let source = map.source;
    let cases = all(source);
    let mut forces = Vec::new();
    for load in source.components("external_load") {
        let Some(shaft) = map.shaft_of.get(&load.id) else {
            continue;
        };
        let (Some(member), Some(pose)) = (map.members.of(*shaft), map.poses.get(*shaft)) else {
            continue;
        };
        let by_case: Vec<(Vector, [f64; 2])> = cases
            .iter()
            .map(|(_, values)| {
                let force = ["u", "v", "w"].map(|axis| {
                    let id = format!("force_{axis}_direction");
                    values.number(load, &id, Quantity::Force).unwrap_or(0.0)
                });
                let [v, w] = ["v", "w"].map(|axis| {
                    let id = format!("torque_around_{axis}_axis");
                    values.number(load, &id, Quantity::Moment).unwrap_or(0.0)
                });
                let force = map.frame.coordinates(pose.turned(force)).map(|x| x + 0.0);
                (force, map.bending(member, pose.turned([0.0, v, w])))
            })
            .collect();
        if by_case
            .iter()
            .all(|(force, moment)| *force == [0.0; 3] && *moment == [0.0; 2])
        {
            continue;
        }
        let at = source
            .number(load, "u_coordinate_on_shaft", Quantity::Length)
            .unwrap_or(0.0);
        forces.push(Force {
            component: load.id,
            member,
            comment: named(load),
            at: map.poses.get(load.id).map_or_else(
                || super::shafts::along(map, member, pose, at),
                |pose_of_load| map.along(member, pose_of_load.origin),
            ),
            by_case,
        });
    }
    forces
}

/// Ports and load cases.
pub fn loads(map: &Map<'_>) -> Loads {
    let source = map.source;
    let cases = all(source);
    let first = cases[0].1;
    let mut members = ports(map, &cases);
    let (speed_at, torque_at) = (speed_member(map, &first), torque_member(map, &first, &members));
    order(map, &first, &mut members, speed_at, torque_at);
    let count = members.len();
    let named = members.into_iter().enumerate().map(|(i, member)| {
        let name = match i {
            0 => "input".to_owned(),
            1 if count == 2 => "output".to_owned(),
            _ => format!("output_{i}"),
        };
        (member, name)
    });
    let mut loads = Loads {
        ports: named.collect(),
        ..Loads::default()
    };
    let name = |member: Option<Id>| {
        let port = loads.ports.iter().find(|(loaded, _)| Some(*loaded) == member)?;
        Some((port.0, port.1.clone()))
    };
    let (Some(torque_at), Some(speed_at)) = (name(torque_at), name(speed_at)) else {
        if torque_at.is_some() || speed_at.is_some() {
            source.note("torque and speed are not both given where torque enters or leaves, so there is no study");
        }
        return loads;
    };
    if count != 2 {
        source.note(format!(
            "a study needs two ports, and the model has {count}, so there is no study"
        ));
        return loads;
    }
    read_cases(map, &cases, &mut loads, torque_at.0, speed_at.0);
    (loads.torque_at, loads.speed_at) = (torque_at.1, speed_at.1);
    loads
}

/// Members with loads that transmit torque; those whose torque is zero in all cases do not count.
fn ports<'a>(map: &Map<'a>, cases: &[(usize, Values<'a>)]) -> Vec<Id> {
    let source = map.source;
    let mut members: Vec<Id> = Vec::new();
    for load in source.components("external_load") {
        let zero = cases.iter().all(|(_, values)| {
            values.flag(load, "defines_torque") == Some(true) && torque(map, values, load, None) == Some(0.0)
        });
        let is_set = |id: &str| source.flag(load, id) == Some(true);
        let transmits = is_set("transmits_torque") || is_set("defines_torque");
        let Some(member) = map.member_with(load.id).filter(|_| transmits) else {
            continue;
        };
        if zero && cases.len() > 1 {
            source.note(format!(
                "{} has no torque in any load case and is no port",
                load.label()
            ));
        } else if !members.contains(&member) {
            members.push(member);
        }
    }
    members
}

/// The input first: what drives, if torque and speed of one port say so, else the port of the speed.
fn order<'a>(map: &Map<'a>, values: &Values<'a>, members: &mut [Id], speed_at: Option<Id>, torque_at: Option<Id>) {
    members.sort_by_key(|member| {
        let rank = if Some(*member) == speed_at {
            0
        } else {
            1 + i32::from(Some(*member) != torque_at)
        };
        (rank, *member)
    });
    if let (Some(at), 2) = (torque_at, members.len()) {
        let speed = speed_of(map, values, at);
        let torque = torque_of(map, values, at, speed);
        if let (Some(speed), Some(torque)) = (speed, torque)
            && (speed * torque < 0.0) == (members[0] == at)
        {
            members.swap(0, 1);
        }
    }
}

/// Torque, speed, gear, temperature and duration of each load case.
fn read_cases<'a>(map: &Map<'a>, cases: &[(usize, Values<'a>)], loads: &mut Loads, torque_at: Id, speed_at: Id) {
    let source = map.source;
    let filled = source
        .model
        .spectra
        .iter()
        .filter(|spectrum| !spectrum.cases.is_empty());
    let several = filled.count() > 1;
    let unit = source.components("gear_unit").next();
    let casing = source.components("gear_casing").next();
    for (number, (spectrum, values)) in cases.iter().enumerate().take(MOST_CASES) {
        let case_id = values.case.map_or(1, |case| case.id);
        let name = if several {
            format!("{spectrum}.{case_id}")
        } else {
            case_id.to_string()
        };
        let speed = speed_of(map, values, speed_at);
        let torque = torque_of(map, values, torque_at, speed.filter(|_| torque_at == speed_at));
        let (Some(speed), Some(torque)) = (speed, torque) else {
            source.note(format!("load case {name} states no torque or no speed and was ignored"));
            continue;
        };
        let of_unit = |id: &str, quantity| unit.and_then(|unit| values.number(unit, id, quantity));
        loads.cases.push(Case {
            name,
            spectrum: *spectrum,
            torque: torque + 0.0,
            speed: speed + 0.0,
            gear: of_unit("gear_shift_index", Quantity::Number).map(|gear| gear as i64),
            oil: casing.and_then(|casing| values.number(casing, "temperature_lubricant", Quantity::Temperature)),
            share: of_unit("operating_time_fraction", Quantity::Percent).filter(|share| *share >= 0.0),
            time: unit.and_then(|unit| values.own_time(unit)).filter(|time| *time >= 0.0),
            number,
        });
    }
    if cases.len() > MOST_CASES {
        source.note(format!(
            "of {} load cases, the first {MOST_CASES} were taken",
            cases.len()
        ));
    }
}

/// The member whose speed is given.
fn speed_member<'a>(map: &Map<'a>, values: &Values<'a>) -> Option<Id> {
    let source = map.source;
    let defining = source
        .components("shaft")
        .find(|shaft| values.flag(shaft, "defines_speed") == Some(true));
    // Some files do not say which shaft defines the speed.
    let stated = || {
        let mut stated = source.components("shaft").filter(|shaft| {
            values
                .holder(shaft, "rotational_speed")
                .attribute("rotational_speed")
                .is_some()
        });
        stated.next().filter(|_| stated.next().is_none())
    };
    map.members.of(defining.or_else(stated)?.id)
}

/// The port whose torque is given: one where speed is given, too, if there is one.
fn torque_member<'a>(map: &Map<'a>, values: &Values<'a>, ports: &[Id]) -> Option<Id> {
    let source = map.source;
    let speed_at = speed_member(map, values);
    let defining: Vec<Id> = source
        .components("external_load")
        .filter(|load| values.flag(load, "defines_torque") == Some(true))
        .filter_map(|load| map.member_with(load.id))
        .filter(|member| ports.contains(member))
        .collect();
    if defining.iter().any(|member| Some(*member) != defining.first().copied()) {
        source.note("torques are given at several ports; that of the port with the given speed counts, the other follows from it and the losses");
    }
    defining
        .iter()
        .find(|member| Some(**member) == speed_at)
        .or(defining.first())
        .copied()
}

/// Speed of a member about its axis, in the direction of positions. \[rpm\]
fn speed_of<'a>(map: &Map<'a>, values: &Values<'a>, member: Id) -> Option<f64> {
    let shafts = map.members.parts(member).filter_map(|id| map.source.component(id));
    let mut stated: Vec<(bool, f64)> = shafts
        .filter_map(|shaft| {
            let speed = values.number(shaft, "rotational_speed", Quantity::Speed)?;
            let sense = map.sense(member, map.poses.get(shaft.id)?.u);
            Some((values.flag(shaft, "defines_speed") != Some(true), speed * sense))
        })
        .collect();
    stated.sort_by_key(|(other, _)| *other);
    stated.first().map(|(_, speed)| *speed)
}

/// Sum of the torques that loads apply to a member about its axis. \[Nm\]
fn torque_of<'a>(map: &Map<'a>, values: &Values<'a>, member: Id, speed: Option<f64>) -> Option<f64> {
    let loads = map
        .source
        .components("external_load")
        .filter(|load| map.member_with(load.id) == Some(member));
    let torques: Vec<f64> = loads
        .filter(|load| values.flag(load, "defines_torque") == Some(true))
        .filter_map(|load| torque(map, values, load, speed))
        .collect();
    (!torques.is_empty()).then(|| torques.iter().sum())
}

/// Torque of a load about x, from its power if the speed is known. \[Nm\]
fn torque<'a>(map: &Map<'a>, values: &Values<'a>, load: &'a Component, speed: Option<f64>) -> Option<f64> {
    let shaft = map.shaft_of.get(&load.id)?;
    if let Some(torque) = values.number(load, "torque_around_u_axis", Quantity::Moment) {
        return Some(torque * map.sense(map.members.of(*shaft)?, map.poses.get(*shaft)?.u));
    }
    let speed = speed.filter(|speed| *speed != 0.0)?;
    let power = values.number(load, "power", Quantity::Power)?;
    Some(power / (speed * std::f64::consts::PI / 30.0))
}

/// Name of a gear in gearbox files.
pub fn gear_name(gear: i64) -> String {
    id("gear", gear)
}
