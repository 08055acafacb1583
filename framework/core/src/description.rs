//! The description of a gearbox: the typed sections that the framework itself reads.
//!
//! The registry adds the sections of mechanisms (`bearings`, `couplings`, `seals`, ... and those of other crates). All structs are
//! read from the resolved document, in which every quantity is SI and every default is filled in.

pub mod bevel_teeth;
pub mod chains;
pub mod crossed;
mod defaults;
mod every_mesh;
pub mod gears;
pub mod housing;
pub mod lubricant;
pub mod materials;
pub mod network;
pub mod oil_network;
pub mod pins;
pub mod plausibility;
pub mod shafts;
pub mod shift_sign;
pub mod states;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::de::value::MapDeserializer;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use crate::machine::MachineEntry;
pub use bevel_teeth::{BevelAxes, BevelFault, BevelPair, BevelTeeth};
pub use chains::{ChainEntry, JointEntry};
pub use crossed::{
    BevelMeshEntry, CalculationPoint, CrossedHelicalMeshEntry, CutterEntry, CuttingMethod, DepthEntry, FlankAngles,
    SpiralAngleOf, WormMeshEntry,
};
pub use every_mesh::{MeshCommon, MeshMetal, OilOfComponent};
pub use gearloss_document::Ordered;
pub use gears::{DifferentialEntry, GearEntry, GearKind, MeshEntry, Mounting, PlanetarySetEntry, Surface};
pub use housing::{
    HeatInto, HousingEntry, InsideEntry, InsideSection, LevelOver, OilEntry, OutsideEntry, Running, RunningWord,
    Thermal, ThermalMode,
};
pub use lubricant::{Consistency, GreaseEntry, LubricantEntry};
pub use materials::MaterialEntry;
pub use network::{NetworkChoice, NetworkEntry, NodeEntry};
pub use oil_network::{HoleEntry, OilNetworkEntry, PocketEntry, WindowEntry};
pub use plausibility::PlausibilityEntry;
pub use shafts::{AxisEntry, DirectedAxis, LoadEntry, SectionEntry, ShaftEntry, Unsupported};
pub use states::{AssumedEntry, GearStateEntry, ImportedLoads, RatingEntry, RatiosEntry, SpeedRatioEntry, TorqueShare};

/// A gearbox.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "gearbox")]
pub struct GearboxEntry {
    /// Kind and format version of the document.
    #[schemars(extend("x-also-called" = ["schema", "format", "kind"]))]
    pub gearloss: GearboxFormat,
    /// Title for reports.
    pub title: Option<String>,
    /// Source of the description.
    pub source: Option<String>,
    /// A gearbox file that this one extends; `set` changes it.
    #[schemars(extend("x-refers-to" = "file"))]
    pub extends: Option<String>,
    /// Changes to the file named in `extends`: resolved path to value.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub set: Ordered<Value>,
    /// Shafts at which torque and speed are given or measured: name to shaft.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub ports: Ordered<String>,
    /// Ports with equal speed that count as one port, `wheels`: both wheels of a driven axle on a straight road. Its torque is the
    /// sum of theirs, which the transmission splits; if the split is not determined, it is equal.
    #[schemars(length(min = 2))]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub wheels: Option<Vec<String>>,
    /// Speeds of the ports of `wheels` over their common speed, in the same order, as in a corner: `[1.06, 0.94]`. The torque of the
    /// common port then has their power at the common speed. Default: all one, a straight road. [-]
    #[schemars(inner(range(min = 0.0, max = 2.0)), length(min = 2))]
    pub wheel_speeds: Option<Vec<f64>>,
    /// Shafts, planet bodies and carriers: all rotating members except idler gears.
    pub shafts: Ordered<ShaftEntry>,
    /// Gears.
    #[serde(default)]
    pub gears: Ordered<GearEntry>,
    /// Pairs of cylindrical gears in mesh.
    #[serde(default)]
    pub meshes: Ordered<MeshEntry>,
    /// Pairs of bevel or hypoid gears in mesh.
    #[serde(default)]
    pub bevel_meshes: Ordered<BevelMeshEntry>,
    /// Worms with their wheels.
    #[serde(default)]
    pub worm_meshes: Ordered<WormMeshEntry>,
    /// Pairs of cylindrical gears in mesh on axes that cross.
    #[serde(default)]
    pub crossed_helical_meshes: Ordered<CrossedHelicalMeshEntry>,
    /// Planetary sets: a carrier and the shafts that are planets on it.
    #[serde(default)]
    pub planetary_sets: Ordered<PlanetarySetEntry>,
    /// Differentials.
    #[serde(default)]
    pub differentials: Ordered<DifferentialEntry>,
    /// Chains and belts.
    #[serde(default)]
    pub chains: Ordered<ChainEntry>,
    /// Joints between shafts at an angle, such as cardan and constant-velocity joints.
    #[serde(default)]
    pub joints: Ordered<JointEntry>,
    /// Relative speed, as a fraction of the common speed of the bodies, below which friction decreases linearly to zero: for gears
    /// and bearings on a carrier whose planets hardly roll, as in a differential on a straight road. Irregularities of real drives
    /// reverse the sign of such friction all the time. Zero: full friction at any relative speed. [-]
    #[serde(default = "uneven_running")]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub locked_below: f64,
    /// Which couplings are engaged in which gear.
    #[serde(default)]
    #[schemars(extend("x-digits-first" = true))]
    pub gear_states: Ordered<GearStateEntry>,
    /// Torque split of parallel meshes on one shaft.
    #[serde(default)]
    pub torque_shares: Vec<TorqueShare>,
    /// Flanks of all gears without their own.
    pub surface: Option<Surface>,
    /// Materials of gears.
    #[serde(default)]
    pub materials: Ordered<MaterialEntry>,
    /// Oils.
    pub lubricants: Ordered<LubricantEntry>,
    /// Housing and its oil.
    #[serde(default)]
    pub housing: HousingEntry,
    /// Pumps, pipes and nozzles: flows and pressures of the oil.
    pub oil_network: Option<OilNetworkEntry>,
    /// Electric machines at ports, with their inverters.
    #[serde(default)]
    pub machines: Ordered<MachineEntry>,
    /// Operating temperature.
    #[serde(default)]
    pub thermal: Thermal,
    /// Bearing loads from a file instead of the calculated ones.
    pub imported_loads: Option<ImportedLoads>,
    /// Catalogues of this gearbox: section to file, or to a folder of tables if the name ends with `/`.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "file"))]
    pub catalogues: Ordered<String>,
    /// Design torque and speed, the largest values; axes of grids may use fractions of them.
    pub rating: Option<RatingEntry>,
    /// Ranges of plausible values of the geometry.
    #[serde(default)]
    pub plausibility: PlausibilityEntry,
    /// Assumptions and their reasons; shown in reports.
    #[serde(default)]
    pub assumed: Vec<AssumedEntry>,
    /// Sources of values.
    #[serde(default)]
    pub sources: Vec<AssumedEntry>,
}

impl GearboxEntry {
    /// The lubricant of a part that states one, or none: that of the housing, or the only one. `None` if it does not exist.
    pub fn lubricant<'a>(&'a self, stated: Option<&str>) -> Option<(&'a str, &'a LubricantEntry)> {
        let name = stated.or(self.housing.oil.as_ref().map(|oil| oil.lubricant.as_str()));
        let mut lubricants = self.lubricants.iter();
        match name {
            Some(name) => lubricants.find(|(id, _)| *id == name),
            None => lubricants.next().filter(|_| self.lubricants.0.len() == 1),
        }
    }

    /// True if that lubricant is a grease.
    pub fn is_greased(&self, stated: Option<&str>) -> bool {
        self.lubricant(stated)
            .is_some_and(|(_, lubricant)| lubricant.grease.is_some())
    }

    /// True if one of the lubricants is a grease.
    pub fn has_grease(&self) -> bool {
        self.lubricants.iter().any(|(_, lubricant)| lubricant.grease.is_some())
    }

    /// True if there is a mesh of gears with this path, such as `meshes.M1` or `worm_meshes.W`.
    pub fn has_mesh(&self, path: &str) -> bool {
        path.split_once('.').is_some_and(|(section, id)| match section {
            "meshes" => self.meshes.get(id).is_some(),
            "bevel_meshes" => self.bevel_meshes.get(id).is_some(),
            "worm_meshes" => self.worm_meshes.get(id).is_some(),
            "crossed_helical_meshes" => self.crossed_helical_meshes.get(id).is_some(),
            _ => false,
        })
    }

    /// Gears and lubricant of all meshes, by path.
    pub fn all_meshes(&self) -> impl Iterator<Item = (String, &[String; 2], Option<&str>)> {
        let of = |section: &str, id: &str| format!("{section}.{id}");
        let meshes = self.meshes.iter();
        let meshes = meshes.map(move |(id, m)| (of("meshes", id), &m.gears, m.common.oil.lubricant.as_deref()));
        let bevel = self.bevel_meshes.iter();
        let bevel = bevel.map(move |(id, m)| (of("bevel_meshes", id), &m.gears, m.common.oil.lubricant.as_deref()));
        let worm = self.worm_meshes.iter();
        let worm = worm.map(move |(id, m)| (of("worm_meshes", id), &m.gears, m.common.oil.lubricant.as_deref()));
        let crossed = self.crossed_helical_meshes.iter();
        let crossed = crossed.map(move |(id, m)| {
            (
                of("crossed_helical_meshes", id),
                &m.gears,
                m.common.oil.lubricant.as_deref(),
            )
        });
        meshes.chain(bevel).chain(worm).chain(crossed)
    }

    /// Reads an entry of a section again, in which only numbers differ from before, and in its models none if they are `same`; the whole
    /// document for a section without entries.
    ///
    /// # Errors
    /// If it cannot be read.
    pub(crate) fn read_again(
        &mut self,
        document: &Value,
        (section, id): (&str, &str),
        same: SameModels,
    ) -> Result<(), serde_json::Error> {
        let section_value = &document[section];
        match section {
            "shafts" => entry_again(&mut self.shafts, section_value, id),
            // Copies of their models as written take longer to read than all of their numbers.
            "gears" if same.0 => entry_but_models(&mut self.gears, section_value, id, |new, old| new.drag = old.drag),
            "meshes" if same.0 => entry_but_models(&mut self.meshes, section_value, id, |new, old| {
                (new.model, new.drag) = (old.model, old.drag);
            }),
            "gears" => entry_again(&mut self.gears, section_value, id),
            "meshes" => entry_again(&mut self.meshes, section_value, id),
            "bevel_meshes" => entry_again(&mut self.bevel_meshes, section_value, id),
            "worm_meshes" => entry_again(&mut self.worm_meshes, section_value, id),
            "crossed_helical_meshes" => entry_again(&mut self.crossed_helical_meshes, section_value, id),
            "planetary_sets" => entry_again(&mut self.planetary_sets, section_value, id),
            "differentials" => entry_again(&mut self.differentials, section_value, id),
            "chains" => entry_again(&mut self.chains, section_value, id),
            "joints" => entry_again(&mut self.joints, section_value, id),
            "machines" => entry_again(&mut self.machines, section_value, id),
            "lubricants" => entry_again(&mut self.lubricants, section_value, id),
            "materials" => entry_again(&mut self.materials, section_value, id),
            "housing" => {
                self.housing = HousingEntry::deserialize(section_value)?;
                Ok(())
            }
            "thermal" => {
                self.thermal = Thermal::deserialize(section_value)?;
                Ok(())
            }
            _ => {
                *self = Self::deserialize(document)?;
                Ok(())
            }
        }
    }
}

/// Reads one entry of a section again.
fn entry_again<T: DeserializeOwned>(
    entries: &mut Ordered<T>,
    section: &Value,
    id: &str,
) -> Result<(), serde_json::Error> {
    if let Some((_, entry)) = entries.0.iter_mut().find(|(known, _)| known == id) {
        *entry = T::deserialize(&section[id])?;
    }
    Ok(())
}

/// True if the models of an entry are as they were.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SameModels(pub bool);

/// Keys of the models of gears and meshes.
pub(crate) const OF_MODELS: [&str; 2] = ["model", "drag"];

/// Reads one entry of a section again, without the models, which are kept.
fn entry_but_models<T: DeserializeOwned>(
    entries: &mut Ordered<T>,
    section: &Value,
    id: &str,
    keep: impl FnOnce(&mut T, T),
) -> Result<(), serde_json::Error> {
    if let Some((_, entry)) = entries.0.iter_mut().find(|(known, _)| known == id) {
        let fields = section[id].as_object().into_iter().flatten();
        let fields = fields.filter(|(key, _)| !OF_MODELS.contains(&key.as_str()));
        let fields = fields.map(|(key, value)| (key.as_str(), value));
        let new = T::deserialize(MapDeserializer::new(fields))?;
        let old = std::mem::replace(entry, new);
        keep(entry, old);
    }
    Ok(())
}

/// Assumed: single-pitch deviations of micrometres on pitches of millimetres.
fn uneven_running() -> f64 {
    1e-3
}

/// Kind and format version of a gearbox document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum GearboxFormat {
    /// The first format.
    #[serde(rename = "gearbox/1")]
    One,
}
