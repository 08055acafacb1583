//! Gear states: constraint rows, degrees of freedom, and the ports that may prescribe speeds.

use std::sync::Arc;

use super::case::Cases;
use super::gearing::lone_gears;
use super::members::Members;
use super::seats::MeshSeat;
use super::transfers::TransferSeat;
use crate::attach::{SeatedClearance, dangling};
use crate::codes;
use crate::description::{GearboxEntry, RatiosEntry};
use crate::document::Diagnostic;
use crate::flow::{MeshRow, Share};
use crate::kinematics::{Fault, Motion, Row, Train};
use crate::registry::Memory;

/// Origin of a row, for messages.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RowName {
    /// A mesh or a differential, by path.
    Path(String),
    /// The rule that both sides of a differential have equal speed.
    Equal(String),
    /// A port that rotates with the axle of `wheels`, by name.
    Wheel(String),
    /// The ratio of two speeds that a control keeps, by path.
    Ratio(String),
}

/// One gear state.
#[derive(Debug, Clone, PartialEq)]
pub struct GearState {
    /// Name.
    pub name: String,
    /// Engaged couplings and clutches.
    pub engaged: Vec<String>,
    /// Columns and rows.
    pub(crate) train: Train,
    pub(crate) rows: Vec<RowName>,
    pub(crate) meshes: Vec<MeshRow>,
    pub(crate) shares: Vec<Share>,
    /// Gears in no mesh, for messages.
    pub(crate) lone_gears: Vec<String>,
    /// Columns whose speed a rule prescribes, with zero given torque: differences of differentials and of speeds in a ratio.
    pub(crate) equal: Vec<usize>,
    /// Columns that are stationary by rule, with a reaction torque.
    pub(crate) standing: Vec<usize>,
    /// Ports that prescribe the speeds of this state unless a point states others.
    pub speed_ports: Vec<usize>,
    /// Degrees of freedom, without those that rules prescribe.
    pub freedom: usize,
}

impl GearState {
    /// Adds a row with friction.
    fn add(&mut self, seat: &TransferSeat) {
        let ([first, second], [z1, sz2]) = (seat.members, seat.row);
        let row = MeshRow {
            row: self.rows.len(),
            first: Some(first),
            z1,
            second: Some(second),
            sz2,
            carrier: seat.carrier,
            steep: false,
        };
        let speeds = Row::mesh(row.first, z1, row.second, sz2, row.carrier);
        self.train.rows.push(speeds);
        self.rows.push(RowName::Path(seat.path.clone()));
        self.meshes.push(row);
    }

    /// Changes the coefficients of a row with friction, by its number among those.
    fn turn_at(&mut self, number: usize, [z1, sz2]: [f64; 2]) {
        let row = &mut self.meshes[number];
        if [row.z1, row.sz2] != [z1, sz2] {
            (row.z1, row.sz2) = (z1, sz2);
            self.train.rows[row.row] = Row::mesh(row.first, z1, row.second, sz2, row.carrier);
        }
    }
}

/// Everything that determines the gear states.
#[derive(PartialEq)]
struct Plan {
    /// Meshes, differentials and wheels.
    base: GearState,
    written: Vec<Written>,
    transfers: Vec<TransferSeat>,
    /// Number of the first row with friction that is no gear mesh.
    first_transfer: usize,
    members: Vec<String>,
    clearances: Vec<SeatedClearance>,
    ports: Vec<super::Port>,
    has_wheels: bool,
}

/// A gear state as it is described.
#[derive(PartialEq)]
struct Written {
    /// Its name, with its ratio behind it if there are several.
    name: String,
    /// Its key under `gear_states`.
    key: String,
    engaged: Vec<String>,
    standstill: Vec<String>,
    /// Ports whose speeds have a ratio: the one that follows first.
    ratio: Option<([String; 2], f64)>,
}

/// The gear states of a description; several ratios of speeds make several.
fn written(entry: &GearboxEntry) -> Vec<Written> {
    let mut all = Vec::new();
    for (key, state) in entry.gear_states.iter() {
        let with = |name: String, ratio: Option<([String; 2], f64)>| Written {
            name,
            key: key.to_owned(),
            engaged: state.engaged().to_vec(),
            standstill: state.standstill().to_vec(),
            ratio,
        };
        let Some(rule) = state.speed_ratio() else {
            all.push(with(key.to_owned(), None));
            continue;
        };
        let ports = || [rule.port.clone(), rule.to.clone()];
        match &rule.ratio {
            RatiosEntry::One(ratio) => all.push(with(key.to_owned(), Some((ports(), *ratio)))),
            RatiosEntry::Several(ratios) => {
                let each = ratios
                    .iter()
                    .map(|ratio| with(format!("{key} {ratio}"), Some((ports(), *ratio))));
                all.extend(each);
            }
        }
    }
    if all.is_empty() {
        all.push(Written {
            name: ONLY.to_owned(),
            key: ONLY.to_owned(),
            engaged: Vec::new(),
            standstill: Vec::new(),
            ratio: None,
        });
    }
    all
}

/// Gear states with their cases, and what is wrong with them.
type Planned = (Arc<Vec<GearState>>, Arc<Cases>, Vec<Diagnostic>);

/// Name of the gear state of a description that states none.
const ONLY: &str = "only";

/// The key of a gear state in the description: without `gear_states` its ports are what a reader can change.
pub(super) fn path_of_state(name: &str) -> String {
    if name == ONLY {
        "ports".to_owned()
    } else {
        format!("gear_states.{name}")
    }
}

/// The gear state behind a sentence; nothing if the description states none.
pub(super) fn in_state(name: &str) -> String {
    if name == ONLY {
        String::new()
    } else {
        format!(" in `{name}`")
    }
}

/// Builds and checks every gear state of a description without faults so far.
pub fn states(
    entry: &GearboxEntry,
    members: &Members,
    (meshes, transfers): (&[MeshSeat], &[TransferSeat]),
    clearances: &[SeatedClearance],
    (ports, wheels): (&[super::Port], &[super::Port]),
    memory: &mut Memory,
    found: &mut Vec<Diagnostic>,
) -> (Arc<Vec<GearState>>, Arc<Cases>) {
    if !found.is_empty() {
        return Default::default();
    }
    let base = all_open(entry, members, (meshes, transfers), wheels, found);
    let plan = Plan {
        base,
        written: written(entry),
        transfers: transfers.to_vec(),
        first_transfer: meshes.len(),
        members: members.names.clone(),
        clearances: clearances.to_vec(),
        ports: ports.to_vec(),
        has_wheels: !wheels.is_empty(),
    };
    let (states, cases, more) = memory.repeat("gear states", plan, planned);
    found.extend(more);
    (states, cases)
}

/// The gear states of a plan.
fn planned(plan: &Plan) -> Planned {
    let mut found = Vec::new();
    let Plan {
        base,
        written,
        transfers,
        first_transfer,
        members,
        clearances,
        ports,
        has_wheels,
    } = plan;
    let ids: Vec<&str> = members.iter().map(String::as_str).collect();
    let closable: Vec<&str> = clearances.iter().map(|c| c.id.as_str()).collect();
    let mut states = Vec::new();
    for (number, described) in written.iter().enumerate() {
        let Written {
            name,
            key,
            engaged,
            standstill,
            ratio,
        } = described;
        let path = path_of_state(key);
        let before = found.len();
        let mut state = GearState {
            name: name.clone(),
            engaged: engaged.clone(),
            ..base.clone()
        };
        for (seat, row) in transfers.iter().zip(*first_transfer..) {
            state.turn_at(row, seat.row_in(key));
        }
        for id in engaged {
            match clearances.iter().find(|c| c.id == *id) {
                Some(clearance) => {
                    let [a, b] = clearance.between.map(|m| m.map(usize::from));
                    state.train.rows.push(Row::joined(a, b));
                    state.rows.push(RowName::Path(clearance.path.clone()));
                }
                None => found.push(dangling(&path, "coupling, clutch or brake", id, &closable)),
            }
        }
        for id in standstill {
            match ids.iter().position(|m| m == id) {
                Some(member) => state.standing.push(member),
                None => found.push(dangling(&format!("{path}.standstill"), "shaft or idler gear", id, &ids)),
            }
        }
        if *has_wheels || !engaged.is_empty() && !state.equal.is_empty() {
            // Wheels whose speeds are stated, and a lock, make the rule of some differentials redundant, whatever speeds are stated: equal
            // ones decide.
            let mut straight = state.train.clone();
            for (row, name) in straight.rows.iter_mut().zip(&state.rows) {
                match (name, &mut row.terms[..]) {
                    (RowName::Wheel(_), [_, axle]) => axle.1 = -1.0,
                    (RowName::Equal(_), [left, right, _]) => (left.1, right.1) = (1.0, -1.0),
                    _ => {}
                }
            }
            let freedom = Motion::freedom(&straight);
            state.equal.retain(|difference| {
                let mut held = straight.clone();
                held.rows.push(Row::joined(Some(*difference), None));
                Motion::freedom(&held) < freedom
            });
        }
        if let Some((names, ratio)) = ratio
            && found.len() == before
        {
            if written[..number].iter().any(|other| other.name == *name) {
                let place = written[..number].iter().filter(|other| other.key == *key).count();
                let path = format!("{path}.speed_ratio.ratio.{place}");
                let error = Diagnostic::error(path, format!("`{name}` exists twice"));
                found.push(error.help("state each ratio once").code(codes::OVERDETERMINED));
            } else if let Err(error) = keep_ratio(&mut state, ports, (names, *ratio), &format!("{path}.speed_ratio")) {
                found.push(error);
            }
        }
        if found.len() == before {
            choose_ports(&mut state, ports, members, &path, &mut found);
        }
        states.push(state);
    }
    (Arc::new(states), Arc::default(), found)
}

/// What all gear states have in common: meshes, differentials and wheels, without any engaged coupling.
fn all_open(
    entry: &GearboxEntry,
    members: &Members,
    (meshes, transfers): (&[MeshSeat], &[TransferSeat]),
    wheels: &[super::Port],
    found: &mut Vec<Diagnostic>,
) -> GearState {
    // The axle of `wheels` follows the members if its port includes it.
    let axle = members.names.len();
    let mut state = GearState {
        name: String::new(),
        engaged: Vec::new(),
        train: Train {
            columns: axle + usize::from(!wheels.is_empty()),
            rows: Vec::new(),
        },
        rows: Vec::new(),
        meshes: Vec::new(),
        shares: Vec::new(),
        lone_gears: lone_gears(entry, meshes).into_iter().map(str::to_owned).collect(),
        equal: Vec::new(),
        standing: Vec::new(),
        speed_ports: Vec::new(),
        freedom: 0,
    };
    for mesh in meshes {
        let [z1, z2] = mesh.z().map(f64::from);
        let row = MeshRow {
            row: state.rows.len(),
            first: Some(mesh.members[0]),
            z1,
            second: Some(mesh.members[1]),
            sz2: mesh.sign() * z2,
            carrier: mesh.carrier,
            steep: mesh.crossed().is_some(),
        };
        let speeds = Row::mesh(row.first, row.z1, row.second, row.sz2, row.carrier);
        state.train.rows.push(speeds);
        state.rows.push(RowName::Path(mesh.path.clone()));
        state.meshes.push(row);
    }
    for seat in transfers.iter().filter(|seat| !seat.is_differential()) {
        state.add(seat);
    }
    add_differentials(&mut state, entry, members, transfers, found);
    state.shares = shares(entry, members, meshes, &state.meshes, found);
    let first_wheel = state.rows.len();
    for (number, wheel) in wheels.iter().enumerate() {
        let speeds = entry.wheel_speeds.as_ref();
        let speed = speeds.and_then(|speeds| speeds.get(number)).copied().unwrap_or(1.0);
        state.train.rows.push(Row {
            terms: vec![(wheel.member, 1.0), (axle, -speed)],
        });
        state.rows.push(RowName::Wheel(wheel.name.clone()));
    }
    // If the transmission itself locks the wheels to equal speed, nothing else determines their torque split.
    for second in 1..wheels.len() {
        state.shares.extend((0..second).map(|first| Share {
            member: axle,
            a: (first_wheel + first, 1.0),
            b: (first_wheel + second, 1.0),
        }));
    }
    state
}

/// Adds the row of each differential, and the rule that both of its sides have equal speed.
fn add_differentials(
    state: &mut GearState,
    entry: &GearboxEntry,
    members: &Members,
    transfers: &[TransferSeat],
    found: &mut Vec<Diagnostic>,
) {
    let ids: Vec<&str> = members.names.iter().map(String::as_str).collect();
    for (id, differential) in entry.differentials.iter() {
        let path = format!("differentials.{id}");
        let mut member = |key: &str, name: &str| {
            let index = ids.iter().position(|m| *m == name);
            if index.is_none() {
                found.push(dangling(&format!("{path}.{key}"), "shaft", name, &ids));
            }
            index
        };
        let case = member("case", &differential.case);
        let left = member("left", &differential.left);
        let right = member("right", &differential.right);
        let (Some(case), Some(left), Some(right)) = (case, left, right) else {
            continue;
        };
        if let Some(seat) = transfers.iter().find(|seat| seat.path == path) {
            state.add(seat);
        } else {
            let row = Row::mesh(Some(left), 1.0, Some(right), 1.0, Some(case));
            state.train.rows.push(row);
            state.rows.push(RowName::Path(path.clone()));
        }
        let train = &mut state.train;
        if differential.equal_speeds {
            let column = train.columns;
            train.columns += 1;
            let half = 0.5 * differential.speed_difference;
            train
                .rows
                .push(Row::difference((left, 1.0 - half), (right, 1.0 + half), column));
            state.rows.push(RowName::Equal(path));
            state.equal.push(column);
        }
    }
}

/// Adds the rule that the speeds of two ports have a ratio, which transmits no torque.
fn keep_ratio(
    state: &mut GearState,
    ports: &[super::Port],
    (names, ratio): (&[String; 2], f64),
    path: &str,
) -> Result<(), Diagnostic> {
    let known: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
    let member = |key: &str, name: &str| {
        let port = ports.iter().find(|port| port.name == name);
        port.map(|port| port.member)
            .ok_or_else(|| dangling(&format!("{path}.{key}"), "port", name, &known))
    };
    let (follows, leads) = (member("port", &names[0])?, member("to", &names[1])?);
    let wrong =
        |message: String, help: String| Err(Diagnostic::error(path, message).help(help).code(codes::OVERDETERMINED));
    if follows == leads {
        let help = "name two ports on different shafts".to_owned();
        return wrong(format!("`{}` and `{}` are one shaft", names[0], names[1]), help);
    }
    let column = state.train.columns;
    state.train.columns += 1;
    state
        .train
        .rows
        .push(Row::difference((follows, 1.0), (leads, ratio), column));
    state.rows.push(RowName::Ratio(path.to_owned()));
    state.equal.push(column);
    let ruled = state.equal.len() + state.standing.len();
    let mut held = state.train.clone();
    held.rows.push(Row::joined(Some(column), None));
    let freedom = Motion::freedom(&state.train);
    if freedom <= ruled || Motion::freedom(&held) == freedom {
        let message = format!(
            "the speeds of `{}` and `{}` already follow from each other{}",
            names[0],
            names[1],
            in_state(&state.name)
        );
        let help =
            "delete `speed_ratio`, or engage fewer couplings: a ratio is kept where two speeds are free".to_owned();
        return wrong(message, help);
    }
    Ok(())
}

/// Selects the ports that prescribe speeds: the reference port first, then the others in their order.
fn choose_ports(
    state: &mut GearState,
    ports: &[super::Port],
    members: &[String],
    path: &str,
    found: &mut Vec<Diagnostic>,
) {
    let ruled = state.equal.len() + state.standing.len();
    let freedom = Motion::freedom(&state.train);
    let columns: Vec<usize> = all_ports(state, ports);
    let mut order: Vec<usize> = (0..ports.len()).collect();
    order.sort_by_key(|i| (ports[*i].name != "input", *i));
    let mut chosen: Vec<usize> = Vec::new();
    let mut faults = None;
    let count = freedom.saturating_sub(ruled);
    for &port in &order {
        let mut more = chosen.clone();
        more.push(port);
        match Motion::new(&state.train, &columns, &prescribed(state, ports, &more)) {
            Ok(_) => {
                chosen = more;
                faults = None;
                break;
            }
            Err(list) => {
                // A port that the others determine, or that is fixed, cannot be chosen; a free member may still find its port.
                let member = ports[port].member;
                let useless = list.iter().any(|f| match f {
                    Fault::Tied { .. } => more.len() > 1,
                    Fault::Locked { port, .. } => *port == member && count > 0,
                    Fault::Under { .. } => false,
                });
                if !useless {
                    chosen = more;
                    faults = Some(list);
                } else if faults.is_none() {
                    faults = Some(list);
                }
            }
        }
    }
    if let Some(list) = faults {
        found.extend(list.iter().map(|fault| explain(fault, state, members, ports, path)));
    }
    state.freedom = count;
    state.speed_ports = chosen;
}

/// Columns at which speeds may be prescribed.
pub(crate) fn all_ports(state: &GearState, ports: &[super::Port]) -> Vec<usize> {
    ports
        .iter()
        .map(|p| p.member)
        .chain(state.equal.iter().copied())
        .chain(state.standing.iter().copied())
        .collect()
}

/// Columns whose speeds some ports and the rules prescribe.
pub(crate) fn prescribed(state: &GearState, ports: &[super::Port], chosen: &[usize]) -> Vec<usize> {
    let mut columns: Vec<usize> = chosen.iter().map(|p| ports[*p].member).collect();
    columns.extend(state.standing.iter().copied());
    columns.extend(state.equal.iter().copied());
    columns
}

/// A fault of kinematics as a message.
pub(crate) fn explain(
    fault: &Fault,
    state: &GearState,
    members: &[String],
    ports: &[super::Port],
    path: &str,
) -> Diagnostic {
    let name = |column: &usize| {
        let axle = ports.iter().find(|p| p.member == *column).map(|p| p.name.clone());
        members
            .get(*column)
            .cloned()
            .or(axle)
            .unwrap_or_else(|| "a difference of speeds".to_owned())
    };
    let list = |columns: &[usize]| columns.iter().map(name).collect::<Vec<_>>().join(", ");
    let row = |row: &usize| match state.rows.get(*row) {
        Some(RowName::Path(path) | RowName::Ratio(path)) => path.clone(),
        Some(RowName::Equal(path)) => format!("equal speeds of {path}"),
        Some(RowName::Wheel(name)) => format!("equal speed of {name} and the other `wheels`"),
        None => String::new(),
    };
    let rows = |rows: &[usize]| rows.iter().map(row).collect::<Vec<_>>().join(", ");
    let port = |column: &usize| {
        ports
            .iter()
            .find(|p| p.member == *column)
            .map_or_else(|| name(column), |p| p.name.clone())
    };
    let in_state = in_state(&state.name);
    match fault {
        Fault::Under { columns, ports: among } => {
            let error = Diagnostic::error(path, format!("{} can rotate freely{in_state}", list(columns)))
                .code(codes::UNDERDETERMINED);
            if among.is_empty() {
                let standing = columns.first().map(name).unwrap_or_default();
                let other = match state.name.as_str() {
                    ONLY => format!(
                        "connect it by a mesh, or hold it: `gear_states: {{ drive: {{ engaged: [], standstill: [{standing}] }} }}`"
                    ),
                    state => {
                        format!("engage a coupling, or write `{state}: {{ engaged: [...], standstill: [{standing}] }}`")
                    }
                };
                error.help(match mesh_of_lone_gears(&state.lone_gears) {
                    Some(help) => format!("{help}; otherwise {other}"),
                    None => other,
                })
            } else {
                let speed = format!(
                    "also prescribe the speed of {}",
                    among.iter().map(port).collect::<Vec<_>>().join(" or ")
                );
                error.help(match mesh_of_lone_gears(&state.lone_gears) {
                    Some(help) => format!("{help}; otherwise {speed}"),
                    None => speed,
                })
            }
        }
        Fault::Tied {
            port: tied,
            others,
            rows: by,
        } => {
            let ratios: Vec<String> = others
                .iter()
                .map(|(c, r)| format!("{} (ratio {:.6})", port(c), 1.0 / r))
                .collect();
            Diagnostic::error(
                path,
                format!(
                    "the speed of {} follows from that of {}{in_state}",
                    port(tied),
                    ratios.join(" and ")
                ),
            )
            .note(format!("tied by {}", rows(by)))
            .help("prescribe one of them")
            .code(codes::OVERDETERMINED)
        }
        Fault::Locked { port: locked, rows: by } => {
            let help = match state.name.as_str() {
                ONLY => "correct the tooth numbers of the loop, or delete a mesh of it",
                _ => "engage fewer couplings, or correct the tooth numbers of the loop",
            };
            Diagnostic::error(path, format!("{} cannot rotate{in_state}", port(locked)))
                .note(format!("locked by {}", rows(by)))
                .help(help)
                .code(codes::OVERDETERMINED)
        }
    }
}

/// What to do about gears in no mesh, if there are any.
fn mesh_of_lone_gears(gears: &[String]) -> Option<String> {
    match gears {
        [] => None,
        [one] => Some(format!("`{one}` is in no mesh: add its mesh")),
        several => Some(format!("`{}` are in no mesh: add their meshes", several.join("`, `"))),
    }
}

fn shares(
    entry: &GearboxEntry,
    members: &Members,
    meshes: &[MeshSeat],
    rows: &[MeshRow],
    found: &mut Vec<Diagnostic>,
) -> Vec<Share> {
    let mut shares = Vec::new();
    let ids: Vec<&str> = members.names.iter().map(String::as_str).collect();
    let ids_of_meshes = || meshes.iter().filter_map(|mesh| Some(mesh.path.split_once('.')?.1));
    let known: Vec<&str> = ids_of_meshes().collect();
    for (i, share) in entry.torque_shares.iter().enumerate() {
        let path = format!("torque_shares.{i}");
        let Some(member) = ids.iter().position(|m| *m == share.member) else {
            found.push(dangling(
                &format!("{path}.member"),
                "shaft or idler gear",
                &share.member,
                &ids,
            ));
            continue;
        };
        let sum: f64 = share.parts.iter().sum();
        if share.parts.len() != share.meshes.len() || (sum - 1.0).abs() > 1e-9 || share.parts.iter().any(|p| *p <= 0.0)
        {
            found.push(
                Diagnostic::error(
                    format!("{path}.parts"),
                    format!("{} shares with the sum {sum}", share.parts.len()),
                )
                .help("state a positive share for each mesh; their sum must be one"),
            );
            continue;
        }
        let numbers: Vec<Option<usize>> = share
            .meshes
            .iter()
            .map(|name| {
                let number = ids_of_meshes().position(|id| id == name);
                match number {
                    Some(number) if meshes[number].members.contains(&member) => Some(number),
                    Some(_) => {
                        found.push(
                            Diagnostic::error(
                                format!("{path}.meshes"),
                                format!("`{name}` has no gear on `{}`", share.member),
                            )
                            .help("list meshes of this member"),
                        );
                        None
                    }
                    None => {
                        found.push(dangling(&format!("{path}.meshes"), "mesh", name, &known));
                        None
                    }
                }
            })
            .collect();
        for k in 1..numbers.len() {
            if let (Some(a), Some(b)) = (numbers[0], numbers[k]) {
                shares.push(Share {
                    member,
                    a: (rows[a].row, share.parts[0]),
                    b: (rows[b].row, share.parts[k]),
                });
            }
        }
    }
    shares
}
