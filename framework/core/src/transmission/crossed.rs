//! Pairs of gears on axes that cross, placed in the housing.
//!
//! The frame of the mean point knows a right-hand pinion; a pair with a left-hand one is its mirror image. It is turned, and mirrored if need
//! be, onto the axes of the housing. A pair of flanks carries while the torque on the first gear has one sense, the other one else, so all
//! forces are vectors per newton of the tangential force of the first gear, one set for each sense.

use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

use super::axis::Axis;
use crate::description::BevelPair;
use crate::geometry::crossed::{Blank, Flank, MeanPoint, PitchCones, ToothPath, VirtualPair};
use crate::geometry::{Pair, WormPair};

/// Kind of a pair on axes that cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CrossedKind {
    /// Bevel gears; hypoid gears if the axes do not intersect.
    Bevel,
    /// A worm with its wheel.
    Worm,
    /// Cylindrical gears on crossed axes.
    CrossedHelical,
}

impl CrossedKind {
    /// Section of the document.
    pub fn section(self) -> &'static str {
        match self {
            Self::Bevel => "bevel_meshes",
            Self::Worm => "worm_meshes",
            Self::CrossedHelical => "crossed_helical_meshes",
        }
    }
}

/// Teeth of a pair on axes that cross, in the housing.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossedTeeth {
    /// Kind.
    pub kind: CrossedKind,
    /// Pitch cones or cylinders.
    pub cones: PitchCones,
    /// Frame of the right-hand pair.
    pub frame: MeanPoint,
    /// Dimensions of bevel gears.
    pub blank: Option<Blank>,
    /// Drive and coast flanks of bevel gears as pairs of surfaces.
    pub pairs: Option<[Pair; 2]>,
    /// Geometry of a worm and its wheel.
    pub worm: Option<WormPair>,
    /// Normal pressure angles of the drive and the coast flank. \[rad\]
    pub pressure_angle: [f64; 2],
    /// True if the pinion has the left hand, so that the pair is the mirror image of the frame.
    pub left: bool,
    /// Mean point. \[m\]
    pub mean_point: Vector3<f64>,
    /// Axes from apex to base; of cylinders in either direction. Unit vectors.
    pub axis: [Vector3<f64>; 2],
    /// One for each gear whose shaft has the direction of its axis, else minus one.
    pub along: [f64; 2],
    /// Flanks that carry a torque of the teeth on the first gear about the direction of its shaft: a positive one, a negative one.
    pub flanks: [CrossedFlank; 2],
}

/// Forces of a pair of flanks at the mean point, on the first gear; those on the second one are opposite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossedFlank {
    /// Which flank.
    pub flank: Flank,
    /// Force without friction per newton of the magnitude of the tangential force.
    pub normal: Vector3<f64>,
    /// What a newton of friction adds while the first gear turns about the direction of its shaft: if the first gear drives, and if the
    /// second one does. The torque of the driving gear does not change.
    pub friction: [Wrench; 2],
    /// Mean sliding speed over the magnitude of the speed of the first gear. \[m\]
    pub sliding: f64,
}

/// A force at the mean point with a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// Force.
    pub force: Vector3<f64>,
    /// Moment about the mean point. \[m\]
    pub moment: Vector3<f64>,
}

/// Friction of a flank that is one newton everywhere, in the frame: on the first gear, turning forwards.
#[derive(Debug, Clone, Copy)]
struct UnitFriction {
    wrench: Wrench,
    sliding: f64,
}

/// A pair before it is placed.
pub(super) struct Unplaced {
    pub kind: CrossedKind,
    pub cones: PitchCones,
    pub blank: Option<Blank>,
    pub pairs: Option<[Pair; 2]>,
    pub worm: Option<WormPair>,
    /// Pressure angles of the cutter and the share of the limit pressure angle in it. \[rad\]
    pub pressure_angle: [f64; 2],
    pub limit_factor: f64,
    pub left: bool,
    /// As [`CrossedTeeth::along`].
    pub along: [f64; 2],
}

/// The crossing point or the feet of the common perpendicular of two lines, as distances along them. \[m\]
pub(super) fn feet(through: [Vector3<f64>; 2], along: [Vector3<f64>; 2]) -> [f64; 2] {
    let between = through[1] - through[0];
    let common = along[0].cross(&along[1]);
    let size = common.norm_squared();
    [
        between.cross(&along[1]).dot(&common) / size,
        between.cross(&along[0]).dot(&common) / size,
    ]
}

/// Distance of two lines, positive towards the product of their directions. \[m\]
pub(super) fn signed_offset(through: [Vector3<f64>; 2], along: [Vector3<f64>; 2]) -> f64 {
    let common = along[0].cross(&along[1]);
    common.dot(&(through[1] - through[0])) / common.norm()
}

/// Axes of two shafts as vectors.
pub(super) fn lines(axes: [&Axis; 2]) -> ([Vector3<f64>; 2], [Vector3<f64>; 2]) {
    (
        axes.map(|axis| Vector3::from(axis.origin)),
        axes.map(|axis| Vector3::from(axis.direction())),
    )
}

impl CrossedTeeth {
    /// Places a pair on the axes of its shafts, which have its shaft angle and offset.
    pub(super) fn new(pair: Unplaced, axes: [&Axis; 2]) -> Self {
        let Unplaced {
            kind,
            cones,
            blank,
            pairs,
            worm,
            pressure_angle,
            limit_factor,
            left,
            along,
        } = pair;
        let frame = MeanPoint::new(&cones);
        let limit = limit_factor * cones.limit_pressure_angle();
        let pressure_angle = [pressure_angle[0] + limit, pressure_angle[1] - limit];
        let (through, directions) = lines(axes);
        let axis = [directions[0] * along[0], directions[1] * along[1]];
        let mirror = if left { -1.0 } else { 1.0 };
        let place = turned(frame.axis, axis, mirror);
        // Both axes have their feet in common, to the rounding of the offset.
        let of_frame = feet(frame.foot, frame.axis)[0];
        let of_housing = feet(through, axis)[0];
        let mean_point = through[0] + axis[0] * of_housing - place * (frame.foot[0] + frame.axis[0] * of_frame);
        let arms = [0, 1].map(|i| -(place * frame.foot[i]));
        let torque = |gear: usize, wrench: &Wrench| {
            let sense = if gear == 0 { 1.0 } else { -1.0 };
            sense * directions[gear].dot(&(arms[gear].cross(&wrench.force) + wrench.moment))
        };
        // A positive speed of the first shaft is one of the frame, or its opposite.
        let turns = along[0] * mirror;
        let flank = |flank: Flank| {
            let angle = pressure_angle[usize::from(flank == Flank::Coast)];
            let in_frame = frame.flank_normal(angle, flank);
            let normal = Wrench {
                force: place * in_frame,
                moment: Vector3::zeros(),
            };
            let unit = UnitFriction::new(
                &cones,
                &frame,
                blank.as_ref(),
                in_frame,
                flank,
                (pressure_angle, limit_factor),
            );
            let friction = Wrench {
                force: place * unit.wrench.force * turns,
                moment: place * unit.wrench.moment * (turns * mirror),
            };
            let arm = torque(0, &normal);
            let with_normal = [0, 1].map(|driving| {
                let share = torque(driving, &friction) / torque(driving, &normal);
                Wrench {
                    force: friction.force - normal.force * share,
                    moment: friction.moment,
                }
            });
            let flank = CrossedFlank {
                flank,
                normal: normal.force * (cones.radius[0] / arm.abs()),
                friction: with_normal,
                sliding: unit.sliding,
            };
            (arm, flank)
        };
        let (drive, coast) = (flank(Flank::Drive), flank(Flank::Coast));
        let flanks = if drive.0 > 0.0 {
            [drive.1, coast.1]
        } else {
            [coast.1, drive.1]
        };
        Self {
            kind,
            cones,
            frame,
            blank,
            pairs,
            worm,
            pressure_angle,
            left,
            mean_point,
            axis,
            along,
            flanks,
        }
    }

    /// Geometry of a bevel or hypoid pair; `None` of other ones.
    pub fn bevel_pair(&self) -> Option<BevelPair> {
        Some(BevelPair {
            cones: self.cones,
            blank: self.blank?,
            flanks: self.pairs?,
        })
    }

    /// Sign of the second number of teeth in the constraint of speeds.
    pub fn sign(&self) -> f64 {
        self.along[0] * self.along[1]
    }

    /// Vector from the axis of a gear to the mean point. \[m\]
    pub fn arm(&self, gear: usize) -> Vector3<f64> {
        let mirror = if self.left { -1.0 } else { 1.0 };
        -(turned(self.frame.axis, self.axis, mirror) * self.frame.foot[gear])
    }

    /// Distances of the mean point along both axes from the feet of their common perpendicular, positive towards the base. \[m\]
    pub fn mounting_distance(&self) -> [f64; 2] {
        let feet = feet(self.frame.foot, self.frame.axis);
        feet.map(|foot| -foot)
    }
}

/// The turn, with a mirror if `mirror` is -1, that moves two directions of the frame to two of the housing.
fn turned(frame: [Vector3<f64>; 2], housing: [Vector3<f64>; 2], mirror: f64) -> Matrix3<f64> {
    let basis = |[first, second]: [Vector3<f64>; 2], mirror: f64| {
        let common = first.cross(&second).normalize() * mirror;
        Matrix3::from_columns(&[first, common, first.cross(&common) * mirror])
    };
    basis(housing, mirror) * basis(frame, 1.0).transpose()
}

impl UnitFriction {
    /// Of bevel gears the mean along the path of contact with even load, of others at the mean point.
    fn new(
        cones: &PitchCones,
        frame: &MeanPoint,
        blank: Option<&Blank>,
        normal: Vector3<f64>,
        flank: Flank,
        (pressure_angle, limit_factor): ([f64; 2], f64),
    ) -> Self {
        let Some(blank) = blank else {
            let sliding = frame.sliding();
            return Self {
                wrench: Wrench {
                    force: -sliding.normalize(),
                    moment: Vector3::zeros(),
                },
                sliding: sliding.norm(),
            };
        };
        let side = if flank == Flank::Drive { 1.0 } else { -1.0 };
        let angle = pressure_angle[usize::from(flank == Flank::Coast)];
        let design = angle - side * limit_factor * cones.limit_pressure_angle();
        let virtual_pair = VirtualPair::new(cones, blank, (design, limit_factor), flank);
        let path = ToothPath::new(
            frame,
            normal,
            virtual_pair.to_tip,
            (virtual_pair.base_helix, virtual_pair.inclination),
        );
        let (force, moment) = path.mean_friction();
        Self {
            wrench: Wrench { force, moment },
            sliding: path.mean_sliding(),
        }
    }
}

#[cfg(test)]
mod tests;
