//! The transmission: immutable, validated, with indices instead of names, built models and precomputed values.

mod axis;
mod build;
mod case;
mod catchers;
mod crossed;
mod crossed_gearing;
mod drag_models;
mod drags;
mod gearing;
mod grease;
mod inside;
mod lean;
mod materials;
mod members;
mod nodes;
mod oil_network;
mod oils;
mod pairs;
mod planet_sharing;
mod planets;
mod plausible;
mod preloads;
mod seats;
mod stage;
mod states;
mod statics;
mod strands;
mod sump;
mod torque_order;
mod transfers;

use std::sync::Arc;

pub use crate::loads::Mounting;
pub use axis::Axis;
pub use case::Case;
pub use crossed::{CrossedFlank, CrossedKind, CrossedTeeth, Wrench};
pub(crate) use drags::DragSeat;
pub use nodes::{AMBIENT, HeatPath};
pub use oils::{AtRest, Oils, Surface};
pub use pairs::{BearingPair, PairedBearing};
pub use preloads::{BodyTemperature, PairPreload, PreloadBy};
pub use seats::GearSeat;
pub(crate) use seats::MeshSeat;
pub use stage::{ChainStage, CrossedStage, Stage};
pub use states::GearState;
pub use sump::Sump;
pub use torque_order::{TorqueBlock, TorqueOrder};

pub(crate) use case::Cases;
pub(crate) use catchers::Pockets;
pub(crate) use states::RowName;

pub(crate) use nodes::NodeNames;
pub(crate) use oil_network::raceway;
pub use planet_sharing::PlanetShares;
pub(crate) use planet_sharing::{MeshSharing, Sharing};
pub(crate) use transfers::{Transfer, TransferLaw};

use crate::attach::Stiffness;
use crate::description::{RatingEntry, ThermalMode};
use crate::document::Diagnostic;
use crate::hydraulics::Hydraulics;
use crate::loads::{ShaftLoads, StaticRating};
use crate::loss::NoteBase;
use crate::machine::Machine;
use crate::mechanism::Slot;
use crate::mechanism::bevel_mesh::{BevelMesh, BevelPart};
use crate::mechanism::crossed_helical_mesh::{CrossedHelicalMesh, CrossedHelicalPart};
use crate::mechanism::gear_drag::{DragPart, GearDrag};
use crate::mechanism::gear_mesh::{GearMesh, MeshPart};
use crate::mechanism::worm_mesh::{AtRest as WormAtRest, WormMesh, WormPart};
use crate::registry::{Instance, Placed};
use crate::thermal::Housing;
use crate::thermal::network::Network;

/// Kind of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartKind {
    /// A component of a mechanism's section; its number among the placed components.
    Component(usize),
    /// The load-dependent loss of a mesh; its number.
    Mesh(usize),
    /// A drag model on a gear or on a mesh; its number.
    Drag(usize),
    /// A chain, a joint or a differential with friction; its number.
    Transfer(usize),
}

/// A stiffness of a bearing that follows from a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessAtLoad {
    /// Number of the support.
    pub(crate) support: usize,
    /// Which stiffness.
    pub stiffness: Stiffness,
    /// The radial load. \[N\]
    pub load: f64,
    /// The stiffness. \[N/m, Nm/rad\]
    pub value: f64,
}

/// One part with a power loss.
#[derive(Debug, Clone)]
pub struct PartInfo {
    /// Path of the component, such as `bearings.B1`; for drags with the slot, such as `gears.G4.drag.churning`.
    pub path: String,
    /// Key of the mechanism.
    pub mechanism: &'static str,
    /// Kind.
    pub kind: PartKind,
    /// Number of equal copies.
    pub count: f64,
    /// Factor on the loss of the model.
    pub loss_factor: f64,
    /// Position of the notes of its model.
    pub notes: NoteBase,
}

/// Name of the port that combines the ports of `wheels`.
pub const WHEELS: &str = "wheels";
/// Key of the speeds of the ports of `wheels`.
pub const WHEEL_SPEEDS: &str = "wheel_speeds";

/// A port.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Member; the number after the last one for the axle of [`WHEELS`].
    pub member: usize,
}

/// One mesh with its model.
pub(crate) struct MeshModel {
    pub seat: MeshSeat,
    pub law: MeshLaw,
    pub oil: u16,
    /// True if the teeth run in grease.
    pub greased: bool,
    /// Nodes of the bodies of both gears, if a thermal network has them.
    pub bodies: Option<[usize; 2]>,
    /// Factor on the loss of the model.
    pub loss_factor: f64,
    /// Load sharing among planets, if the planets of its set carry different loads.
    pub sharing: Option<MeshSharing>,
    /// Tangential force of one copy per multiplier of its row. \[1/m\]
    pub force_per_multiplier: f64,
}

/// The loss of a mesh, by the mechanism of its kind of teeth.
pub(crate) enum MeshLaw {
    /// Cylindrical gears.
    Cylindrical { part: Arc<MeshPart>, model: Slot<GearMesh> },
    /// Bevel and hypoid gears.
    Bevel {
        part: Arc<BevelPart>,
        model: Slot<BevelMesh>,
    },
    /// A worm and its wheel.
    Worm { part: Arc<WormPart>, model: Slot<WormMesh> },
    /// Crossed helical gears.
    CrossedHelical {
        part: Arc<CrossedHelicalPart>,
        model: Slot<CrossedHelicalMesh>,
    },
}

impl MeshLaw {
    /// True if it need not be evaluated.
    pub fn off(&self) -> bool {
        match self {
            Self::Cylindrical { model, .. } => model.off,
            Self::Bevel { model, .. } => model.off,
            Self::Worm { model, .. } => model.off,
            Self::CrossedHelical { model, .. } => model.off,
        }
    }

    /// Position of the notes of its model.
    pub fn notes(&self) -> NoteBase {
        match self {
            Self::Cylindrical { model, .. } => model.notes,
            Self::Bevel { model, .. } => model.notes,
            Self::Worm { model, .. } => model.notes,
            Self::CrossedHelical { model, .. } => model.notes,
        }
    }

    /// The part of cylindrical gears.
    pub fn cylindrical(&self) -> Option<&MeshPart> {
        match self {
            Self::Cylindrical { part, .. } => Some(part),
            Self::Bevel { .. } | Self::Worm { .. } | Self::CrossedHelical { .. } => None,
        }
    }
}

/// One drag model with its indices.
pub(crate) struct DragModel {
    pub seat: DragSeat,
    pub part: Arc<DragPart>,
    pub model: Slot<GearDrag>,
    pub oil: u16,
    /// Number of the element of the oil network that the model names.
    pub supply: Option<u16>,
    /// Factor on the loss of the model.
    pub loss_factor: f64,
    /// True if the model covers churning.
    pub churning: bool,
}

/// A component with its number of copies.
pub(crate) struct Component {
    pub placed: Box<dyn Placed>,
    /// The two members that take its reaction.
    pub between: [Option<u16>; 2],
    /// True if its loss may depend on torque or load.
    pub loaded: bool,
    /// True if its model is `none`.
    pub off: bool,
    /// Number of its support, if it carries load.
    pub support: Option<u16>,
    /// Load sharing among planets, if it is on a planet and the planets carry different loads.
    pub sharing: Option<Arc<Sharing>>,
    /// Position of the notes of its model.
    pub notes: NoteBase,
    /// Number of copies, times the factor on the loss.
    pub count: f64,
}

impl Component {
    /// Group of its support, whose loads are found together.
    pub fn group(&self, loads: &ShaftLoads) -> Option<usize> {
        self.support.map(|support| loads.group_of(support.into()))
    }

    /// A placed component. Unequal load sharing matters only if the loss may depend on load.
    fn new(placed: Box<dyn Placed>, count: f64, sharing: Option<Arc<Sharing>>) -> Self {
        Self {
            between: placed.between(),
            loaded: placed.loaded(),
            off: placed.off(),
            support: placed.support(),
            sharing: sharing.filter(|_| placed.loaded()),
            notes: placed.notes(),
            placed,
            count,
        }
    }
}

/// A support with a known static load rating.
#[derive(Debug, Clone, Copy)]
pub struct RatedSupport {
    /// Its number.
    pub support: usize,
    /// Rating of one bearing.
    pub rating: StaticRating,
    /// True if it is on a planet of a set whose planets carry different loads.
    pub uneven: bool,
}

/// A transmission, ready to be evaluated at any number of points from any number of threads.
pub struct Transmission {
    pub(crate) title: String,
    pub(crate) members: Vec<String>,
    /// Axis of each member, of planets that of their carrier.
    pub(crate) axes: Vec<Axis>,
    pub(crate) ports: Vec<Port>,
    /// Ports with equal speed that are one among `ports`; usually empty.
    pub(crate) wheels: Vec<Port>,
    pub(crate) states: Arc<Vec<GearState>>,
    /// Cases of these states that were prepared so far.
    pub(crate) cases: Arc<Cases>,
    pub(crate) gears: Vec<GearSeat>,
    pub(crate) meshes: Vec<MeshModel>,
    pub(crate) drags: Vec<DragModel>,
    /// Rows with friction that are no gear meshes: those with strands first.
    pub(crate) transfers: Vec<Transfer>,
    pub(crate) components: Vec<Component>,
    pub(crate) parts: Vec<PartInfo>,
    pub(crate) instances: Vec<Instance>,
    /// Cells of notes: those of the models, then the static safety of each rated support, then two of each pair with a spring or a preload.
    pub(crate) cells: usize,
    /// As [`Self::limited`].
    pub(crate) limited: Arc<[(usize, usize)]>,
    /// Supports with a known static load rating.
    pub(crate) rated: Vec<RatedSupport>,
    /// Opposed bearings that load each other.
    pub(crate) pairs: Vec<BearingPair>,
    /// Each stiffness of a support that follows from a load.
    pub(crate) stiffnesses: Vec<StiffnessAtLoad>,
    pub(crate) oils: Oils,
    pub(crate) hydraulics: Hydraulics,
    pub(crate) loads: Arc<ShaftLoads>,
    /// Load correction factors of each support; empty if all are one.
    pub(crate) load_factors: Vec<statics::LoadFactors>,
    pub(crate) imported: Option<statics::Imported>,
    pub(crate) supports: Vec<String>,
    /// Greatest number of different loads of the planets of a set; zero if all share equally.
    pub(crate) uneven: usize,
    /// Relative speed, as a fraction of the common speed, below which friction between two bodies decreases.
    pub(crate) locked_below: f64,
    /// Findings that do not prevent evaluation.
    pub warnings: Vec<Diagnostic>,
    /// Oil temperature as described, if it is given. \[degC\]
    pub oil_temperature: f64,
    /// Temperature mode as described.
    pub thermal_mode: ThermalMode,
    /// Design torque and speed. \[Nm and rad/s\]
    pub rating: Option<RatingEntry>,
    pub(crate) housing: Housing,
    pub(crate) machines: Vec<Arc<Machine>>,
    pub(crate) network: Option<Network>,
}

impl Transmission {
    /// Title.
    pub fn title(&self) -> &str {
        &self.title
    }
    /// Names of shafts and idler gears, by number.
    pub fn members(&self) -> &[String] {
        &self.members
    }
    /// Axes of shafts and idler gears, by number; of a planet that of its carrier.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }
    /// Pitch angle of a bevel gear by its number, and one if its shaft runs from apex to base, else minus one; `None` of other gears. \[rad\]
    pub fn cone_of_gear(&self, gear: usize) -> Option<(f64, f64)> {
        let seats = self.meshes.iter().map(|mesh| &mesh.seat);
        let mut cones = seats.filter_map(|seat| {
            let side = seat.gears.iter().position(|own| *own == gear)?;
            let teeth = seat.crossed().filter(|teeth| teeth.kind == CrossedKind::Bevel)?;
            Some((teeth.cones.pitch_angle[side], teeth.along[side]))
        });
        cones.next()
    }
    /// Ports.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }
    /// Ports with equal speed that are one among [`Transmission::ports`]; usually empty.
    pub fn wheels(&self) -> &[Port] {
        &self.wheels
    }
    /// Gear states, including neutral.
    pub fn states(&self) -> &[GearState] {
        &self.states
    }
    /// Electric machines at ports: those of `machines`, and the motors of the thermal network.
    pub fn machines(&self) -> &[Arc<Machine>] {
        &self.machines
    }
    /// Gears with their geometry.
    pub fn gears(&self) -> &[GearSeat] {
        &self.gears
    }
    /// The kind of a row with friction by its number in the power flow: gear meshes first.
    pub(crate) fn kind_of_row(&self, number: usize) -> PartKind {
        let transfer = number.checked_sub(self.meshes.len());
        transfer.map_or(PartKind::Mesh(number), PartKind::Transfer)
    }
    /// Tangential force per multiplier of each row that loads bearings: those of meshes, then those of chains. \[1/m\]
    pub(crate) fn force_factors(&self) -> impl Iterator<Item = f64> {
        let meshes = self.meshes.iter().map(|mesh| mesh.force_per_multiplier);
        let chains = self.transfers.iter().filter(|transfer| transfer.seat.strands.is_some());
        meshes.chain(chains.map(|chain| chain.force_per_multiplier))
    }
    /// Every part that may lose power, in the order of the document.
    pub fn parts(&self) -> &[PartInfo] {
        &self.parts
    }
    /// Every model that was built, with its path.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }
    /// Cell of notes of the first rated support; the cells of models precede it.
    pub fn rated_cells(&self) -> usize {
        self.pair_cells() - self.rated.len()
    }
    /// Cell of notes of the first pair with a spring or a preload; the cells of rated supports precede it.
    pub fn pair_cells(&self) -> usize {
        self.cells - self.pairs.iter().map(BearingPair::cells).sum::<usize>()
    }
    /// Number of cells of notes.
    pub fn cells(&self) -> usize {
        self.cells
    }
    /// Volume of the sump's oil at the oil temperature as described over that at another temperature in degC. \[-\]
    pub fn oil_expansion(&self, from: f64) -> f64 {
        self.oils.heat(from).0 / self.oils.heat(self.oil_temperature).0
    }
    /// Opposed bearings that load each other.
    pub fn pairs(&self) -> &[BearingPair] {
        &self.pairs
    }
    /// Each stiffness of a bearing that follows from a load, with the path of the bearing.
    pub fn stiffnesses(&self) -> impl Iterator<Item = (&str, StiffnessAtLoad)> {
        let each = self.stiffnesses.iter();
        each.map(|known| (self.supports[known.support].as_str(), *known))
    }
    /// Cells of notes of limits, each with a component that uses the model; those of a bearing's static safety and spring with the
    /// bearing.
    pub fn limited(&self) -> &[(usize, usize)] {
        &self.limited
    }
    /// Supports with a known static load rating.
    pub fn rated(&self) -> &[RatedSupport] {
        &self.rated
    }
    /// Paths of the supports, by number.
    pub fn supports(&self) -> &[String] {
        &self.supports
    }
    /// Numbers of the gears of every mesh, and whether it is on a rotating carrier, in the order of the meshes.
    pub fn mesh_seats(&self) -> impl Iterator<Item = ([usize; 2], bool)> {
        self.meshes.iter().map(|m| (m.seat.gears, m.seat.carrier.is_some()))
    }
    /// Paths of all meshes.
    pub fn mesh_paths(&self) -> impl Iterator<Item = &str> {
        self.meshes.iter().map(|m| m.seat.path.as_str())
    }
    /// Number, path, geometry and roughness of every mesh of cylindrical gears.
    pub fn cylindrical_meshes(&self) -> impl Iterator<Item = (usize, &str, &MeshPart)> {
        let meshes = self.meshes.iter().enumerate();
        meshes.filter_map(|(i, m)| Some((i, m.seat.path.as_str(), m.law.cylindrical()?)))
    }
    /// True with meshes of gears on axes that cross.
    pub(crate) fn has_crossed_meshes(&self) -> bool {
        self.crossed_meshes().next().is_some()
    }
    /// Path and geometry of every mesh of gears on axes that cross.
    pub fn crossed_meshes(&self) -> impl Iterator<Item = (&str, &CrossedTeeth)> {
        let meshes = self.meshes.iter();
        meshes.filter_map(|m| Some((m.seat.path.as_str(), m.seat.crossed()?.as_ref())))
    }
    /// Path of every worm drive with its geometry, and its friction at rest if its model knows it.
    pub fn worms(&self) -> impl Iterator<Item = (&str, &WormPart, Option<WormAtRest>)> {
        self.meshes.iter().filter_map(|mesh| match &mesh.law {
            MeshLaw::Worm { part, model } => Some((mesh.seat.path.as_str(), part.as_ref(), model.at_rest(part))),
            _ => None,
        })
    }
    /// Ids of both gears of a mesh by its path; `None` if there is no such mesh.
    pub fn gears_of_mesh(&self, path: &str) -> Vec<&str> {
        let mesh = self.meshes.iter().find(|m| m.seat.path == path);
        let gears = mesh.into_iter().flat_map(|m| m.seat.gears);
        gears.map(|g| self.gears[g].id.as_str()).collect()
    }
    /// Path of the first mesh of a gear.
    pub fn mesh_of_gear(&self, gear: &str) -> Option<&str> {
        let index = self.gears.iter().position(|g| g.id == gear)?;
        let mesh = self.meshes.iter().find(|m| m.seat.gears.contains(&index))?;
        Some(&mesh.seat.path)
    }
    /// Name of the first member that takes the reaction of a placed component.
    pub fn member_of_component(&self, component: usize) -> Option<&str> {
        let [first, second] = self.components.get(component)?.between;
        let member = first.or(second)?;
        self.members.get(member as usize).map(String::as_str)
    }
    /// The heat transfer paths to the surroundings.
    pub fn housing(&self) -> &Housing {
        &self.housing
    }
    /// True if cycles incline the oil: the housing states its direction of travel.
    pub fn travels(&self) -> bool {
        self.oils.travel().is_some()
    }
    /// Volume of the oil in the housing, if it is known, and its mass at the temperature of [`Self::oil_temperature`]. \[m3 and kg\]
    pub fn oil_fill(&self) -> Option<(f64, f64)> {
        self.oils.fill(self.oil_temperature)
    }
    /// Density and specific heat of the sump at a temperature in degC. \[kg/m3 and J/(kg K)\]
    pub(crate) fn sump_heat(&self, temperature: f64) -> (f64, f64) {
        self.oils.heat(temperature)
    }
    /// The sump, if the oil space and a level are known.
    pub fn oil_space(&self) -> Option<&Sump> {
        self.oils.sump.as_ref()
    }
    /// The network of oil flows; empty without one.
    pub fn hydraulics(&self) -> &Hydraulics {
        &self.hydraulics
    }
    /// The thermal network.
    pub fn network(&self) -> Option<&Network> {
        self.network.as_ref()
    }
    /// Number of temperature nodes.
    pub fn nodes(&self) -> usize {
        self.network.as_ref().map_or(1, |n| n.names().len())
    }
    /// Number of a gear state by its name.
    ///
    /// # Errors
    /// If there is none, with the available names.
    pub fn state(&self, name: &str) -> Result<usize, Diagnostic> {
        self.states.iter().position(|s| s.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.states.iter().map(|s| s.name.as_str()).collect();
            crate::attach::dangling("gear_states", "gear state", name, &names)
        })
    }
    /// Number of a port by its name.
    ///
    /// # Errors
    /// If there is none, with the available names.
    pub fn port(&self, name: &str) -> Result<usize, Diagnostic> {
        self.ports.iter().position(|p| p.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.ports.iter().map(|p| p.name.as_str()).collect();
            crate::attach::dangling("ports", "port", name, &names)
        })
    }
    /// The port that torque, speed and efficiency refer to: `input`, or the first.
    pub fn reference_port(&self) -> usize {
        self.ports.iter().position(|p| p.name == "input").unwrap_or(0)
    }
}
