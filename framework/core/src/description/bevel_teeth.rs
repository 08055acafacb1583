//! Teeth of bevel and hypoid gears as a drawing states them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::crossed::{CalculationPoint, CutterEntry, CuttingMethod, DepthEntry, FlankAngles, SpiralAngleOf};
use crate::geometry::Pair;
use crate::geometry::crossed::{Blank, Closure, Depth, Flank, PitchCones, Size, SpiralAngle, TeethFault};

/// Teeth of a bevel or hypoid pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BevelTeeth {
    /// Outer pitch diameter of the wheel d_e2; this or another size is stated. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub outer_diameter: Option<f64>,
    /// Outer transverse module m_et2: outer pitch diameter of the wheel over its number of teeth. [mm]
    #[schemars(range(min = 0.05, max = 100.0))]
    pub outer_module: Option<f64>,
    /// Mean pitch diameter of the wheel d_m2. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub mean_diameter: Option<f64>,
    /// Mean spiral angle; zero for straight and zerol teeth. [deg]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub spiral_angle: f64,
    /// The gear that has this spiral angle; that of the other one of a hypoid pair follows.
    #[serde(default)]
    pub spiral_angle_of: SpiralAngleOf,
    /// Pressure angles of both flanks.
    #[serde(default)]
    pub pressure_angle: FlankAngles,
    /// How the cutter determines the pitch cones of a hypoid pair; default: `gleason`.
    pub method: Option<CuttingMethod>,
    /// Cutter of a hypoid pair.
    pub cutter: Option<CutterEntry>,
    /// Where the mean point is that method `gleason` finds from an outer diameter; default: `standard`.
    pub calculation_point: Option<CalculationPoint>,
    /// Pitch angle of the wheel of a hypoid pair from its drawing, instead of `cutter`. [deg]
    #[schemars(range(min = 1.0, max = 90.0))]
    pub wheel_pitch_angle: Option<f64>,
    /// Tooth depth.
    #[serde(default)]
    pub depth: DepthEntry,
}

/// What a bevel pair needs besides its teeth: what gears and axes state in a gearbox. SI, angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelAxes {
    /// Numbers of teeth, the pinion first.
    pub z: [u32; 2],
    /// Shaft angle.
    pub shaft_angle: f64,
    /// Offset of the axes; negative if the hand of the teeth gives the pinion the smaller spiral angle.
    pub offset: f64,
    /// Face width of the wheel.
    pub facewidth: f64,
}

/// A bevel or hypoid pair with its computed geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelPair {
    /// Pitch cones; the spiral angles are those of a right-hand pinion.
    pub cones: PitchCones,
    /// Blanks.
    pub blank: Blank,
    /// The drive flanks and the coast flanks, as pairs of surfaces.
    pub flanks: [Pair; 2],
}

/// Why teeth and axes do not make a pair.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelFault {
    /// The key at fault, if it is one.
    pub key: Option<&'static str>,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: &'static str,
}

impl std::fmt::Display for BevelFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.message, self.help)
    }
}

/// Offset below which axes intersect: rounding. \[m\]
const INTERSECTS: f64 = 1e-9;

fn fault<T>(key: Option<&'static str>, message: impl Into<String>, help: &'static str) -> Result<T, BevelFault> {
    Err(BevelFault {
        key,
        message: message.into(),
        help,
    })
}

impl BevelTeeth {
    /// The geometry of a pair with these teeth.
    ///
    /// # Errors
    /// Why there is none.
    pub fn pair(&self, axes: &BevelAxes) -> Result<BevelPair, BevelFault> {
        let cones = self.pitch_cones(axes)?;
        let blank = self.blank(&cones, axes);
        let flanks = self.flanks(&cones, &blank)?;
        Ok(BevelPair { cones, blank, flanks })
    }

    /// The drive flanks and the coast flanks of a pair.
    ///
    /// # Errors
    /// Why they do not mesh.
    pub fn flanks(&self, cones: &PitchCones, blank: &Blank) -> Result<[Pair; 2], BevelFault> {
        let angles = &self.pressure_angle;
        let flanks = |angle: f64, flank: Flank| {
            Pair::bevel(cones, blank, (angle, angles.limit_factor), flank).or_else(|faults| {
                let sentences: Vec<String> = faults.iter().map(TeethFault::to_string).collect();
                let help = "correct the depth, the face width or the numbers of teeth";
                fault(None, sentences.join("; "), help)
            })
        };
        Ok([flanks(angles.drive, Flank::Drive)?, flanks(angles.coast, Flank::Coast)?])
    }

    /// The blanks of a pair.
    pub fn blank(&self, cones: &PitchCones, axes: &BevelAxes) -> Blank {
        let ratio = cones.ratio();
        let depth = Depth {
            working: self.depth.working,
            clearance: self.depth.clearance,
            wheel_addendum: self.depth.wheel_addendum.unwrap_or(0.21 + 0.29 / (ratio * ratio)),
            addendum_angle: self.depth.addendum_angle,
            dedendum_angle: self.depth.dedendum_angle,
        };
        Blank::new(cones, &depth, axes.facewidth, self.outer_diameter(axes))
    }

    fn outer_diameter(&self, axes: &BevelAxes) -> Option<f64> {
        let of_module = self.outer_module.map(|module| module * f64::from(axes.z[1]));
        self.outer_diameter.or(of_module)
    }

    /// The pitch cones of a pair.
    ///
    /// # Errors
    /// Why there are none.
    pub fn pitch_cones(&self, axes: &BevelAxes) -> Result<PitchCones, BevelFault> {
        let sizes = [self.outer_diameter, self.outer_module, self.mean_diameter];
        if sizes.iter().flatten().count() != 1 {
            return fault(
                None,
                "the size of the wheel is stated not once",
                "state one of `outer_diameter`, `outer_module` and `mean_diameter`",
            );
        }
        let size = match (self.outer_diameter(axes), self.mean_diameter) {
            (Some(outer), _) => Size::Outer(outer),
            (None, mean) => Size::Mean(mean.unwrap_or_default()),
        };
        if axes.offset.abs() > INTERSECTS {
            return self.hypoid(axes, size);
        }
        let of_hypoid = [
            ("method", self.method.is_some()),
            ("cutter", self.cutter.is_some()),
            ("calculation_point", self.calculation_point.is_some()),
            ("wheel_pitch_angle", self.wheel_pitch_angle.is_some()),
        ];
        if let Some((key, _)) = of_hypoid.iter().find(|(_, stated)| *stated) {
            return fault(
                Some(key),
                "the axes intersect, so the pitch cones follow from the teeth",
                "remove it, or give the shafts an offset",
            );
        }
        Ok(PitchCones::bevel(
            axes.z,
            axes.shaft_angle,
            size,
            axes.facewidth,
            self.spiral_angle,
        ))
    }

    fn hypoid(&self, axes: &BevelAxes, size: Size) -> Result<PitchCones, BevelFault> {
        let method = self.method.unwrap_or_default();
        let closure = match (self.cutter, self.wheel_pitch_angle) {
            (Some(cutter), None) if method == CuttingMethod::Gleason => Closure::LimitRadius {
                cutter_radius: cutter.radius,
                blade_groups: cutter.blade_groups,
            },
            (Some(cutter), None) => Closure::Palloid {
                cutter_radius: cutter.radius,
                blade_groups: cutter.blade_groups,
            },
            (None, Some(angle)) if self.method.is_none() => Closure::WheelPitchAngle(angle),
            _ => {
                return fault(
                    None,
                    format!(
                        "the axes have an offset of {:.4} mm, and what determines the pitch cones is not stated once",
                        axes.offset.abs() * 1e3
                    ),
                    "state `cutter` with its `method`, or `wheel_pitch_angle` from the drawing",
                );
            }
        };
        let size = match size {
            Size::Outer(outer) if matches!(closure, Closure::LimitRadius { .. }) => {
                match self.calculation_point.unwrap_or_default() {
                    CalculationPoint::Standard => Size::OuterOfStandard(outer),
                    CalculationPoint::MidFace => Size::Outer(outer),
                }
            }
            _ if self.calculation_point.is_some() => {
                return fault(
                    Some("calculation_point"),
                    "only method `gleason` with an outer diameter has a choice of the mean point",
                    "remove it",
                );
            }
            size => size,
        };
        let spiral = match self.spiral_angle_of {
            SpiralAngleOf::Pinion => SpiralAngle::Pinion(self.spiral_angle),
            SpiralAngleOf::Wheel => SpiralAngle::Wheel(self.spiral_angle),
        };
        let lines = (axes.shaft_angle, axes.offset);
        PitchCones::hypoid(axes.z, lines, (size, axes.facewidth), spiral, closure).or_else(|_| {
            fault(
                None,
                "no pitch cones fit the axes, the teeth and the cutter",
                "check offset, size, spiral angle, `hand` and the cutter; or state `wheel_pitch_angle` from the drawing",
            )
        })
    }
}
