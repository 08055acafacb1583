//! Rows of the train with friction that are no gear meshes: chains and belts, joints, differentials.

use std::sync::Arc;

use super::members::Members;
use super::oils::OilNumbers;
use super::strands::{self, Strands};
use super::{PartInfo, PartKind};
use crate::attach::{Clearance, Common, Places as _, Spot, dangling};
use crate::codes;
use crate::description::{ChainEntry, DifferentialEntry, GearboxEntry, JointEntry};
use crate::document::Diagnostic;
use crate::loss::NoteBase;
use crate::mechanism::chain::{Chain, ChainKind, ChainPart};
use crate::mechanism::clutch::{Clutch, ClutchPart};
use crate::mechanism::differential::{Differential, DifferentialPart};
use crate::mechanism::joint::{Joint, JointPart};
use crate::mechanism::{Mechanism, ModelRef, Slot};
use crate::registry::{Build, Placed, place_between};

/// Where a row acts, and its coefficients.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TransferSeat {
    /// Path, such as `chains.front`.
    pub path: String,
    /// Members of both sides: `first (w1 - wc) + second (w2 - wc) = 0`.
    pub members: [usize; 2],
    /// Member that is the case of a differential.
    pub carrier: Option<usize>,
    /// Coefficients of both sides.
    pub row: [f64; 2],
    /// Other coefficients in single gears, by name.
    pub rows: Vec<(String, [f64; 2])>,
    /// The strands of a chain, which load bearings.
    pub strands: Option<Strands>,
}

impl TransferSeat {
    /// Coefficients of both sides in a gear.
    pub fn row_in(&self, gear: &str) -> [f64; 2] {
        let own = self.rows.iter().find(|(name, _)| name == gear);
        own.map_or(self.row, |(_, row)| *row)
    }

    /// True for a differential, whose row exists without friction, too.
    pub fn is_differential(&self) -> bool {
        self.carrier.is_some()
    }
}

/// The model of a row with what it knows of its part.
pub(crate) enum TransferLaw {
    Chain(Arc<ChainPart>, Slot<Chain>),
    Joint(Arc<JointPart>, Slot<Joint>),
    Differential(Arc<DifferentialPart>, Slot<Differential>),
}

impl TransferLaw {
    /// True if the model is `none`.
    pub fn is_off(&self) -> bool {
        match self {
            Self::Chain(_, model) => model.off,
            Self::Joint(_, model) => model.off,
            Self::Differential(_, model) => model.off,
        }
    }

    /// Position of the notes of its model.
    pub fn notes(&self) -> NoteBase {
        match self {
            Self::Chain(_, model) => model.notes,
            Self::Joint(_, model) => model.notes,
            Self::Differential(_, model) => model.notes,
        }
    }

    fn mechanism(&self) -> &'static str {
        match self {
            Self::Chain(..) => Chain::KEY,
            Self::Joint(..) => Joint::KEY,
            Self::Differential(..) => Differential::KEY,
        }
    }
}

/// A chain, a joint, or a differential whose gears have friction.
pub(crate) struct Transfer {
    pub seat: TransferSeat,
    pub law: TransferLaw,
    pub oil: u16,
    /// Factor on the loss of the model.
    pub loss_factor: f64,
    /// Tangential force at the first wheel per multiplier of its row; zero without strands. \[1/m\]
    pub force_per_multiplier: f64,
}

/// The rows of a description: chains whose strands load bearings, other chains, joints, differentials with friction.
pub(crate) fn seats(
    entry: &GearboxEntry,
    members: &Members,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<TransferSeat> {
    let mut seats = Vec::new();
    for (id, chain) in entry.chains.iter() {
        seats.extend(chain_seat(
            format!("chains.{id}"),
            chain,
            entry,
            members,
            found,
            warnings,
        ));
    }
    seats.sort_by_key(|seat| seat.strands.is_none());
    for (id, joint) in entry.joints.iter() {
        seats.extend(joint_seat(format!("joints.{id}"), joint, members, found));
    }
    for (id, differential) in entry.differentials.iter() {
        if has_friction(differential) {
            seats.extend(differential_seat(format!("differentials.{id}"), differential, members));
        }
        found.extend(faults_of_differential(id, differential, entry));
    }
    seats
}

/// True unless the model of the gears is `none`.
fn has_friction(differential: &DifferentialEntry) -> bool {
    let name = |model: &ModelRef<Differential>| {
        let value = &model.value;
        value.as_str().or_else(|| value["type"].as_str()) != Some("none")
    };
    differential.model.as_ref().is_some_and(name)
}

fn chain_seat(
    path: String,
    chain: &ChainEntry,
    entry: &GearboxEntry,
    members: &Members,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Option<TransferSeat> {
    let before = found.len();
    let shafts: Vec<&str> = entry.shafts.ids().collect();
    let wheels = [0, 1].map(|i| {
        let name = &chain.wheels[i].shaft;
        let member = shafts.iter().position(|shaft| shaft == name);
        let key = format!("{path}.wheels.{i}.shaft");
        match member {
            None => found.push(dangling(&key, "shaft", name, &shafts)),
            Some(member) if members.axes[member].is_none() => found.push(
                Diagnostic::error(key, format!("the axis of `{name}` moves with a carrier"))
                    .code(codes::CHAIN)
                    .help("a chain runs over wheels on shafts with an `axis`"),
            ),
            Some(_) => {}
        }
        member
    });
    let is_variable = chain.kind == ChainKind::VariableBelt;
    let faults = if is_variable {
        faults_of_ratio(&path, chain, entry)
    } else {
        faults_of_teeth(&path, chain)
    };
    found.extend(faults.into_iter().map(|fault| fault.code(codes::CHAIN)));
    let [Some(first), Some(second)] = wheels else {
        return None;
    };
    if first == second {
        found.push(
            Diagnostic::error(format!("{path}.wheels"), "both wheels are on the same shaft")
                .code(codes::CHAIN)
                .help("name two parallel shafts"),
        );
    }
    if found.len() > before {
        return None;
    }
    let axes = [members.axes[first]?, members.axes[second]?];
    let strands = strands::checked(&path, chain, axes, found, warnings);
    if found.len() > before {
        return None;
    }
    if is_variable {
        warnings.extend(unknown_forces(&path, chain, entry));
    }
    let teeth = chain.part().z;
    Some(TransferSeat {
        members: [first, second],
        carrier: None,
        row: teeth.map_or_else(
            || ratio_row(chain.ratio.unwrap_or(1.0)),
            |[first, second]| [f64::from(first), -f64::from(second)],
        ),
        rows: chain
            .ratios
            .iter()
            .map(|(gear, ratio)| (gear.to_owned(), ratio_row(ratio.0)))
            .collect(),
        strands,
        path,
    })
}

/// Coefficients of a ratio: both wheels turn in the same direction.
fn ratio_row(ratio: f64) -> [f64; 2] {
    [1.0, -ratio]
}

/// What is wrong with the keys of a chain over wheels with teeth.
fn faults_of_teeth(path: &str, chain: &ChainEntry) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let stated = [
        ("pitch", chain.pitch.is_some()),
        ("wheels.0.z", chain.wheels[0].z.is_some()),
        ("wheels.1.z", chain.wheels[1].z.is_some()),
    ];
    for (key, _) in stated.iter().filter(|(_, stated)| !stated) {
        let key_name = key.rsplit('.').next().unwrap_or(key);
        found.push(
            Diagnostic::error(format!("{path}.{key}"), format!("`{key_name}` is missing")).help(
                "state the pitch and the number of teeth of both wheels; `kind: variable_belt` has a `ratio` instead",
            ),
        );
    }
    if chain.ratio.is_some() || !chain.ratios.is_empty() {
        found.push(
            Diagnostic::error(format!("{path}.ratio"), "the ratio follows from the numbers of teeth")
                .help("remove it, or write `kind: variable_belt` and omit teeth and pitch"),
        );
    }
    if chain.mass.is_some() && chain.links.is_none() {
        found.push(
            Diagnostic::error(format!("{path}.mass"), "the mass per length requires `links`")
                .help("add `links:`, the number of links or of teeth of the belt"),
        );
    }
    found
}

/// What is wrong with the keys of a belt of variable ratio.
fn faults_of_ratio(path: &str, chain: &ChainEntry, entry: &GearboxEntry) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let gears: Vec<&str> = entry.gear_states.ids().collect();
    for (gear, _) in chain.ratios.iter() {
        if !gears.contains(&gear) {
            found.push(dangling(&format!("{path}.ratios.{gear}"), "gear state", gear, &gears));
        }
    }
    let without: Vec<&str> = gears
        .iter()
        .copied()
        .filter(|gear| chain.ratios.iter().all(|(own, _)| own != *gear))
        .collect();
    if chain.ratio.is_none() && (gears.is_empty() || !without.is_empty()) {
        let message = if gears.is_empty() {
            "`ratio` is missing".to_owned()
        } else {
            format!("the ratio is not stated in {}", without.join(", "))
        };
        found.push(Diagnostic::error(format!("{path}.ratio"), message).help(
            "add `ratio:`, the speed of the first wheel over that of the second, or `ratios:` with one for each gear",
        ));
    }
    let unused = [
        ("pitch", chain.pitch.is_some()),
        ("links", chain.links.is_some()),
        ("pin_diameter", chain.pin_diameter.is_some()),
        ("slack_tension", chain.slack_tension > 0.0),
        ("mass", chain.mass.is_some()),
        ("wheels.0.z", chain.wheels[0].z.is_some()),
        ("wheels.1.z", chain.wheels[1].z.is_some()),
    ];
    for (key, _) in unused.iter().filter(|(_, stated)| *stated) {
        found.push(
            Diagnostic::error(
                format!("{path}.{key}"),
                "a belt of variable ratio does not use this key",
            )
            .help("remove it"),
        );
    }
    found
}

/// Reports that a belt of variable ratio loads no bearings.
fn unknown_forces(path: &str, chain: &ChainEntry, entry: &GearboxEntry) -> Option<Diagnostic> {
    let bare = |shaft: &str| {
        let shaft = entry.shafts.get(shaft);
        shaft.is_some_and(|shaft| shaft.bearings.is_none() && shaft.loads.is_empty())
    };
    let shafts: Vec<&str> = chain.wheels.iter().map(|wheel| wheel.shaft.as_str()).collect();
    let shafts: Vec<&str> = shafts.into_iter().filter(|shaft| bare(shaft)).collect();
    (!shafts.is_empty()).then(|| {
        let message = format!(
            "the clamping and strand forces of the belt are not known, so they do not load the bearings of {}",
            shafts.join(", ")
        );
        Diagnostic::warning(path.to_owned(), message)
            .code(codes::CHAIN_DOUBTFUL)
            .help("state them under `loads` of the shafts, or import the loads of the bearings with `imported_loads`")
    })
}

fn joint_seat(
    path: String,
    joint: &JointEntry,
    members: &Members,
    found: &mut Vec<Diagnostic>,
) -> Option<TransferSeat> {
    let ids: Vec<&str> = members.names.iter().map(String::as_str).collect();
    let sides = [0, 1].map(|i| {
        let member = ids.iter().position(|id| *id == joint.between[i]);
        if member.is_none() {
            found.push(dangling(
                &format!("{path}.between.{i}"),
                "shaft",
                &joint.between[i],
                &ids,
            ));
        }
        member
    });
    let [Some(first), Some(second)] = sides else {
        return None;
    };
    if first == second {
        found.push(
            Diagnostic::error(format!("{path}.between"), "both sides are the same shaft")
                .code(codes::JOINT)
                .help("name the shafts on both sides of the joint"),
        );
        return None;
    }
    Some(TransferSeat {
        path,
        members: [first, second],
        carrier: None,
        row: [1.0, -1.0],
        rows: Vec::new(),
        strands: None,
    })
}

/// The seat of a differential; unknown names are reported with its row.
fn differential_seat(path: String, differential: &DifferentialEntry, members: &Members) -> Option<TransferSeat> {
    let member = |name: &str| members.names.iter().position(|member| member == name);
    Some(TransferSeat {
        path,
        members: [member(&differential.left)?, member(&differential.right)?],
        carrier: Some(member(&differential.case)?),
        row: [1.0, 1.0],
        rows: Vec::new(),
        strands: None,
    })
}

/// A difference of speeds that contradicts other statements.
fn faults_of_differential(id: &str, differential: &DifferentialEntry, entry: &GearboxEntry) -> Option<Diagnostic> {
    if differential.speed_difference == 0.0 {
        return None;
    }
    let path = format!("differentials.{id}.speed_difference");
    let ports = entry.wheels.iter().flatten();
    let mut shafts = ports.filter_map(|port| entry.ports.get(port));
    let fault = if !differential.equal_speeds {
        Diagnostic::error(path, "`equal_speeds: false` leaves the speeds to every point")
            .help("remove one of `speed_difference` and `equal_speeds`")
    } else if shafts.any(|shaft| [&differential.left, &differential.right].contains(&shaft)) {
        let x = 0.5 * differential.speed_difference;
        Diagnostic::error(path, "`wheels` states the speeds of these sides, too").help(format!(
            "remove it and write `wheel_speeds: [{}, {}]`, in the order of `wheels`",
            1.0 + x,
            1.0 - x
        ))
    } else {
        return None;
    };
    Some(fault.code(codes::DIFFERENTIAL))
}

/// The models of all rows.
pub(crate) fn models(
    entry: &GearboxEntry,
    seats: Vec<TransferSeat>,
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    parts: &mut Vec<PartInfo>,
    found: &mut Vec<Diagnostic>,
) -> Vec<Transfer> {
    let mut transfers = Vec::new();
    for seat in seats {
        let (section, id) = seat.path.split_once('.').unwrap_or_default();
        let path = seat.path.clone();
        let (law, oil, loss_factor) = match section {
            "chains" => {
                let Some(chain) = entry.chains.get(id) else { continue };
                let oil = oils.oil(&path, &of_chain(chain));
                let part = build.part_again(&path, chain.part());
                let model = build.model_of(&path, &part, chain.model.as_ref());
                (
                    model.map(|model| TransferLaw::Chain(part, model)),
                    oil,
                    chain.loss_factor,
                )
            }
            "joints" => {
                let Some(joint) = entry.joints.get(id) else { continue };
                let part = JointPart {
                    kind: joint.kind,
                    angle: joint.angle,
                };
                let part = build.part_again(&path, part);
                let model = build.model_of(&path, &part, joint.model.as_ref());
                (
                    model.map(|model| TransferLaw::Joint(part, model)),
                    None,
                    joint.loss_factor,
                )
            }
            _ => {
                let Some(own) = entry.differentials.get(id) else {
                    continue;
                };
                let oil = oils.oil(&path, &of_differential(own));
                let part = build.part_again(&path, DifferentialPart { gears: own.gears });
                let model = build.model_of(&path, &part, own.model.as_ref());
                let law = model.map(|model| TransferLaw::Differential(part, model));
                (law, oil, own.loss_factor)
            }
        };
        match law {
            Ok(law) => {
                parts.push(PartInfo {
                    path,
                    mechanism: law.mechanism(),
                    kind: PartKind::Transfer(transfers.len()),
                    count: 1.0,
                    loss_factor,
                    notes: law.notes(),
                });
                let force = |strands: &Strands| seat.row[0] / strands.radii[0];
                transfers.push(Transfer {
                    force_per_multiplier: seat.strands.as_ref().map_or(0.0, force),
                    seat,
                    law,
                    oil: oil.unwrap_or(0),
                    loss_factor,
                });
            }
            Err(error) => found.push(error),
        }
    }
    transfers
}

fn of_chain(chain: &ChainEntry) -> Common {
    Common::of(&chain.oil, chain.loss_factor)
}

fn of_differential(differential: &DifferentialEntry) -> Common {
    Common::of(&differential.oil, differential.loss_factor)
}

/// Friction between the sides of a differential that does not depend on torque.
pub(crate) struct Locking {
    pub path: String,
    pub placed: Box<dyn Placed>,
    pub loss_factor: f64,
}

/// That of all differentials.
pub(crate) fn locking(
    entry: &GearboxEntry,
    members: &Members,
    oils: &mut OilNumbers<'_>,
    build: &mut Build<'_>,
    found: &mut Vec<Diagnostic>,
) -> Vec<Locking> {
    let member = |name: &str| members.names.iter().position(|member| member == name);
    let mut all = Vec::new();
    for (id, differential) in entry.differentials.iter() {
        let path = format!("differentials.{id}.locking");
        let (Some(choice), Some(left), Some(right)) = (
            &differential.locking,
            member(&differential.left),
            member(&differential.right),
        ) else {
            continue;
        };
        let part = ClutchPart {
            inner_diameter: None,
            outer_diameter: None,
            faces: 1,
            gap: None,
        };
        let part = build.part_again(&path, part);
        let model = match build.slot_at::<Clutch>(&path, &part, &choice.value) {
            Ok(model) => model,
            Err(error) => {
                found.push(error);
                continue;
            }
        };
        let Some(oil) = oils.oil(&format!("differentials.{id}"), &of_differential(differential)) else {
            continue;
        };
        let sides = [left, right].map(|side| Some(side as u16));
        let spot = Spot {
            oil,
            level: oils.level(sides[0], 0.0),
            supply: None,
        };
        all.push(Locking {
            placed: place_between::<Clutch, Clearance>(part, sides, spot, model),
            path,
            loss_factor: differential.loss_factor,
        });
    }
    all
}
