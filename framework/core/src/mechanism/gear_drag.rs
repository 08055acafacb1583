//! Drag of gears in oil and air: churning, squeezing, windage.

use schemars::JsonSchema;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use crate::immersion;
use crate::loss::{Loss, Undefined};
use crate::mechanism::{Mechanism, ROUNDED, Scalar};
use crate::real::Real;
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum GearDrag {}

/// Scope of a model, as registered: evaluated for a gear, or for a mesh with both of its gears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Once for each gear.
    Gear,
    /// Once for each mesh, with both gears.
    Mesh,
}

/// Cause of loss that a model covers. Covering one twice in one gearbox is an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Covers {
    /// Moving the oil in which the gear is immersed.
    pub churning: bool,
    /// Squeezing oil out of the mesh.
    pub squeezing: bool,
    /// Moving air or oil mist.
    pub windage: bool,
}

/// Drag of one gear or of one pair, by the model's scope. A model returns moments about the speed of the gear, or of the first gear
/// of a pair, or powers.
///
/// The inputs are [`GearDragAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait GearDragModel: Send + Sync {
    /// The causes that the model covers; `None` if the name of its slot states it.
    fn covers(&self) -> Option<Covers>;
    /// True if the law describes bevel gears, too: gears with a [pitch angle](GearBody::pitch_angle).
    fn describes_bevel(&self) -> bool {
        false
    }
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined>;
}

/// Data of one gear for churning and windage models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GearBody {
    /// Number of teeth. [-]
    #[schemars(range(min = 1, max = 2000))]
    pub z: u32,
    /// Normal module. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub normal_module: f64,
    /// Normal pressure angle. [deg]
    #[schemars(range(min = 10.0, max = 35.0))]
    pub pressure_angle: f64,
    /// Helix angle at the reference circle. [deg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub helix_angle: f64,
    /// Pitch angle of a bevel gear, whose diameters are those at its outer end; zero for a cylindrical gear. [deg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 120.0))]
    pub pitch_angle: f64,
    /// Face width. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub facewidth: f64,
    /// Reference diameter. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub reference_diameter: f64,
    /// Diameter of the working pitch circle. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub working_diameter: f64,
    /// Tip diameter. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub tip_diameter: f64,
    /// Root diameter. [mm]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub root_diameter: f64,
    /// Height of the pitch point above the lowest point of the gear's tip circle. [mm]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub contact_height: f64,
}

impl GearBody {
    /// An external gear in its written form, whose values are consistent.
    fn possible(self, name: &str) -> Result<Self, String> {
        let mm = |x: f64| {
            format!("{:.4}", x * 1e3)
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        };
        let reference = f64::from(self.z) * self.normal_module / self.helix_angle.cos();
        if self.tip_diameter <= self.root_diameter {
            return Err(format!(
                "{name}: tip_diameter {} mm does not exceed root_diameter {} mm: swap them or correct one",
                mm(self.tip_diameter),
                mm(self.root_diameter)
            ));
        }
        // The module of a bevel gear is that in the middle of its face.
        if self.pitch_angle == 0.0 && (self.reference_diameter - reference).abs() > ROUNDED * reference {
            return Err(format!(
                "{name}: reference_diameter {} mm contradicts z, normal_module and helix_angle, which give {} mm: correct one of them",
                mm(self.reference_diameter),
                mm(reference)
            ));
        }
        let highest = 0.5 * (self.tip_diameter + self.working_diameter);
        if self.contact_height > (1.0 + ROUNDED) * highest {
            return Err(format!(
                "{name}: contact_height {} mm is above the working pitch circle (at most {} mm from tip_diameter and working_diameter): correct one of them",
                mm(self.contact_height),
                mm(highest)
            ));
        }
        Ok(self)
    }

    /// Immersion depth of the reference circle from that of the tip circle, for a stationary axis. \[m\]
    pub fn dip_of(&self, tip_dip: f64) -> f64 {
        immersion::dip(tip_dip - 0.5 * self.tip_diameter, 0.5 * self.reference_diameter)
    }

    /// Immersion depth of the tip circle from that of the reference circle, for a stationary axis; zero if that is dry. \[m\]
    pub fn tip_dip_of(&self, dip: f64) -> f64 {
        if dip > 0.0 {
            immersion::dip(dip - 0.5 * self.reference_diameter, 0.5 * self.tip_diameter)
        } else {
            0.0
        }
    }
}

/// One gear or one pair in its housing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DragPart {
    /// The gear, or the first gear of the pair.
    #[serde(deserialize_with = "gear")]
    pub gear: GearBody,
    /// The second gear of a pair.
    #[serde(default, deserialize_with = "mate")]
    pub mate: Option<GearBody>,
    /// Volume of the oil in the housing. [l]
    #[schemars(range(min = 0.001, max = 10000.0))]
    pub oil_volume: Option<f64>,
    /// Share of the inside of the housing that the oil fills at rest. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fill: Option<f64>,
    /// Cross-section area of the gear case, perpendicular to the shafts. [cm2]
    #[schemars(range(min = 0.1, max = 1e7))]
    pub section_area: Option<f64>,
    /// Perimeter of that cross-section. [cm]
    #[schemars(range(min = 0.1, max = 1e5))]
    pub section_perimeter: Option<f64>,
    /// Radial gap between gear and housing. [mm]
    #[schemars(range(min = 0.1, max = 10000.0))]
    pub radial_clearance: Option<f64>,
    /// Axial gap between gear and housing. [mm]
    #[schemars(range(min = 0.1, max = 10000.0))]
    pub axial_clearance: Option<f64>,
}

fn gear<'de, D: Deserializer<'de>>(from: D) -> Result<GearBody, D::Error> {
    GearBody::deserialize(from)?.possible("gear").map_err(Error::custom)
}

fn mate<'de, D: Deserializer<'de>>(from: D) -> Result<Option<GearBody>, D::Error> {
    let mate = Option::<GearBody>::deserialize(from)?;
    mate.map(|mate| mate.possible("mate"))
        .transpose()
        .map_err(Error::custom)
}

impl DragPart {
    /// Teeth of the gear per tooth of its mate; not finite without a mate. \[-\]
    pub fn ratio(&self) -> f64 {
        self.mate
            .map_or(f64::NAN, |mate| f64::from(self.gear.z) / f64::from(mate.z))
    }
}

context! {
    /// All inputs of a drag model. Quantities that end in `_2` belong to the second gear of a pair.
    pub struct GearDragAt of GearDrag {
        /// Speed of the gear, or of the first gear, signed. [rpm]
        speed: 1500.0 in -30000.0..=30000.0 from "kinematics",
        /// Speed of the second gear, signed. [rpm]
        speed_2: -4645.0 in -30000.0..=30000.0 from "kinematics",
        /// Immersion depth of the tip circle at rest. [mm]
        tip_dip: 20.0 in 0.0..=5000.0 from "`level` of the gear, else the oil level at rest and the position of its shaft",
        /// Immersion depth of the reference circle at rest. [mm]
        dip: 18.05 in 0.0..=5000.0 from "`level` of the gear, else the oil level at rest and the position of its shaft",
        /// Immersion depth of the second gear's tip circle at rest. [mm]
        tip_dip_2: 0.0 in 0.0..=5000.0 from "`level` of that gear, else the oil level at rest and the position of its shaft",
        /// Immersion depth of the second gear's reference circle at rest. [mm]
        dip_2: 0.0 in 0.0..=5000.0 from "`level` of that gear, else the oil level at rest and the position of its shaft",
        /// One if the gear's lowest point moves towards a mate, zero if it moves away from all of them. [-]
        towards_mesh: 0.0 in 0.0..=1.0 from "direction of rotation and the positions of the mates",
        /// The same for the second gear. [-]
        towards_mesh_2: 0.0 in 0.0..=1.0 from "direction of rotation and the positions of its mates",
        /// Height above the lowest point of the tip circle of the highest mesh towards which that point moves; zero: `contact_height`. [mm]
        mesh_height: 0.0 in 0.0..=5000.0 from "direction of rotation and the positions of the mates",
        /// The same for the second gear. [mm]
        mesh_height_2: 0.0 in 0.0..=5000.0 from "direction of rotation and the positions of its mates",
        ..oil from "the oil of the gear or mesh",
        /// Flow of the nozzle that the model names. [l/min]
        injected: 2.0 in 0.0..=100.0 from "the oil network",
    } laws {
        "dip = tip_dip minus the addendum" {
            dip: |at| at.part.gear.dip_of(at.tip_dip),
            tip_dip: |at| at.part.gear.tip_dip_of(at.dip),
        }
        "dip_2 = tip_dip_2 minus the addendum of the mate" {
            dip_2: |at| at.part.mate.map_or(f64::NAN, |mate| mate.dip_of(at.tip_dip_2)),
            tip_dip_2: |at| at.part.mate.map_or(f64::NAN, |mate| mate.tip_dip_of(at.dip_2)),
        }
        "speed_2 = -speed z/z_2 of external gears with fixed axes" usually {
            speed_2: |at| -at.speed * at.part.ratio(),
            speed: |at| -at.speed_2 / at.part.ratio(),
        }
    }
}

impl Mechanism for GearDrag {
    const KEY: &'static str = "gear_drag";
    const MEANING: &'static str = "Drag of gears in oil and air: churning, squeezing, windage.";
    const ANSWER: &'static str = "Drag moment on the gear. [Nm]";
    const EXAMPLE: &'static str = "
gear: { z: 96, normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, \
reference_diameter: 172.4 mm, working_diameter: 173.9 mm, tip_diameter: 176.3 mm, root_diameter: 169 mm, contact_height: 90 mm }
mate: { z: 31, normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, \
reference_diameter: 55.7 mm, working_diameter: 56.1 mm, tip_diameter: 59.8 mm, root_diameter: 52.6 mm, contact_height: 30 mm }
oil_volume: 1.3 l
section_area: 420 cm2
section_perimeter: 85 cm
radial_clearance: 8 mm
axial_clearance: 12 mm
";
    type Part = DragPart;
    type At<'a, R: Real> = GearDragAt<'a, R>;
    type Answer = Loss;
    type Model = dyn GearDragModel;

    answered_by!(loss);
}

impl GearDragModel for Scalar<GearDrag> {
    fn covers(&self) -> Option<Covers> {
        None
    }
    /// The user states it for this gear.
    fn describes_bevel(&self) -> bool {
        true
    }
    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

crate::register_mechanism!(GearDrag);
