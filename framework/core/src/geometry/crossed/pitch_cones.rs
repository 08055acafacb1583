//! Pitch cones of bevel and hypoid pairs, cylinders of crossed helical pairs.
//!
//! Two cones with the half angles d1, d2 and the mean radii r1, r2 touch along a common tangent plane, in which their generatrices enclose the
//! offset angle. Shaft angle, offset and teeth are three conditions on them:
//!
//! cos S = cos d1 cos d2 cos z - sin d1 sin d2,
//! a sin S = (r1 cos d2 + r2 cos d1) sin z,
//! r1 cos b1 / (r2 cos b2) = z1/z2 with b1 = b2 + z.
//!
//! The [`Closure`] is the one that is left. It replaces the iterations of the standard, with the same cones: those of its examples for methods 1
//! and 3 follow to their printed digits.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};

/// Which spiral angle a drawing states, as a mean value. \[rad\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpiralAngle {
    /// That of the pinion.
    Pinion(f64),
    /// That of the wheel.
    Wheel(f64),
}

/// The size of a wheel. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// Outer pitch diameter, with the mean point in the middle of the face.
    Outer(f64),
    /// Outer pitch diameter, with the mean point of ISO 23509 method 1: the middle of the face of a first guess of the pitch angle.
    OuterOfStandard(f64),
    /// Mean pitch diameter.
    Mean(f64),
}

/// What determines the cones beside axes and teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Closure {
    /// ISO 23509 method 1, Gleason: the limit radius of the teeth is that of their lengthwise curvature. Cutter radius, and the number of blade
    /// groups for face hobbing, 0 for face milling.
    LimitRadius {
        /// Cutter radius. \[m\]
        cutter_radius: f64,
        /// Number of blade groups.
        blade_groups: u32,
    },
    /// ISO 23509 method 3, Klingelnberg: the cutter head rolls on both wheels. Radius and blade groups as above.
    Palloid {
        /// Cutter radius. \[m\]
        cutter_radius: f64,
        /// Number of blade groups.
        blade_groups: u32,
    },
    /// Pitch angle of the wheel, from a drawing by any method. Both spiral angles would not do: where cones of a large offset touch, the pitch angles
    /// change by degrees with hundredths of a degree in them. \[rad\]
    WheelPitchAngle(f64),
}

/// Why there are no cones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConeFault {
    /// The iteration finds no cones: the data contradict each other.
    NoCones,
}

/// Pitch cones of a pair that touch at the mean point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PitchCones {
    /// Numbers of teeth.
    pub z: [u32; 2],
    /// Shaft angle. \[rad\]
    pub shaft_angle: f64,
    /// Offset of the axes. \[m\]
    pub offset: f64,
    /// Pitch angles; 0: a cylinder. \[rad\]
    pub pitch_angle: [f64; 2],
    /// Mean spiral angles, in the direction of a right-hand pinion. \[rad\]
    pub spiral_angle: [f64; 2],
    /// Mean pitch radii. \[m\]
    pub radius: [f64; 2],
}

/// Greatest number of steps; examples take five to seven.
const STEPS: usize = 60;

/// Residual of a solution.
const CLOSED: f64 = 1e-13;

/// Step of the differences of the Jacobian. \[rad\]
const STEP: f64 = 1e-6;

impl PitchCones {
    /// Of a bevel pair, whose axes intersect (ISO 23509 method 0). \[rad, m\]
    pub fn bevel(z: [u32; 2], shaft_angle: f64, size: Size, facewidth: f64, spiral_angle: f64) -> Self {
        let u = f64::from(z[1]) / f64::from(z[0]);
        let first = shaft_angle.sin().atan2(shaft_angle.cos() + u);
        let pitch_angle = [first, shaft_angle - first];
        let wheel = mean_radius(size, facewidth, pitch_angle[1], 0.0);
        Self {
            z,
            shaft_angle,
            offset: 0.0,
            pitch_angle,
            spiral_angle: [spiral_angle; 2],
            radius: [wheel / u, wheel],
        }
    }

    /// Of a worm or crossed helical pair: cylinders, whose spiral angles are their helix angles, 90 degrees less the lead angle of a worm. \[m, rad\]
    pub fn cylinders(z: [u32; 2], normal_module: f64, spiral_angle: [f64; 2]) -> Self {
        let radius = [0, 1].map(|i| normal_module * f64::from(z[i]) / (2.0 * spiral_angle[i].cos()));
        Self {
            z,
            shaft_angle: spiral_angle[0] - spiral_angle[1],
            offset: radius[0] + radius[1],
            pitch_angle: [0.0; 2],
            spiral_angle,
            radius,
        }
    }

    /// Of a hypoid pair. The offset is positive; a pair with a left-hand pinion is its mirror image. \[rad, m\]
    ///
    /// # Errors
    /// If the data contradict each other.
    pub fn hypoid(
        z: [u32; 2],
        (shaft_angle, offset): (f64, f64),
        (size, facewidth): (Size, f64),
        spiral_angle: SpiralAngle,
        closure: Closure,
    ) -> Result<Self, ConeFault> {
        let search = Search {
            z,
            shaft_angle,
            offset,
            size,
            facewidth,
            spiral_angle,
            closure,
        };
        let ratio = f64::from(z[1]) / f64::from(z[0]);
        let wheel = (ratio / 1.2).atan();
        let radius = mean_radius(size, facewidth, wheel, search.guess());
        let mut at = Vector3::new(
            shaft_angle - wheel,
            wheel,
            (offset * wheel.sin() / radius).clamp(-0.9, 0.9).asin(),
        );
        let mut residual = search.residual(at);
        for _ in 0..STEPS {
            if residual.amax() < CLOSED {
                return Ok(search.cones(at));
            }
            let columns = [0, 1, 2].map(|k| {
                let mut step = Vector3::zeros();
                step[k] = STEP;
                (search.residual(at + step) - search.residual(at - step)) / (2.0 * STEP)
            });
            let change = Matrix3::from_columns(&columns).lu().solve(&residual);
            let change = change.ok_or(ConeFault::NoCones)?;
            // A step that leads away is halved.
            let mut share = 1.0;
            loop {
                let next = at - change * share;
                let after = search.residual(next);
                // Near the end rounding decides.
                if after.amax() < residual.amax() || (after.amax() < 1e3 * CLOSED && share < 1e-3) {
                    (at, residual) = (next, after);
                    break;
                }
                share /= 2.0;
                if share < 1e-9 {
                    return if residual.amax() < 1e2 * CLOSED {
                        Ok(search.cones(at))
                    } else {
                        Err(ConeFault::NoCones)
                    };
                }
            }
        }
        Err(ConeFault::NoCones)
    }

    /// Angle from the generatrix of the pinion to that of the wheel in the pitch plane. \[rad\]
    pub fn offset_angle(&self) -> f64 {
        self.spiral_angle[0] - self.spiral_angle[1]
    }

    /// Mean cone distances; infinite for cylinders. \[m\]
    pub fn cone_distance(&self) -> [f64; 2] {
        [0, 1].map(|i| self.radius[i] / self.pitch_angle[i].sin())
    }

    /// Mean normal module. \[m\]
    pub fn normal_module(&self) -> f64 {
        2.0 * self.radius[1] * self.spiral_angle[1].cos() / f64::from(self.z[1])
    }

    /// Gear ratio, teeth of the wheel over those of the pinion.
    pub fn ratio(&self) -> f64 {
        f64::from(self.z[1]) / f64::from(self.z[0])
    }

    /// Limit pressure angle: the flank on which the path of contact has the direction of the teeth. Zero without offset. \[rad\]
    pub fn limit_pressure_angle(&self) -> f64 {
        let [d1, d2] = self.pitch_angle.map(f64::tan);
        if d1 == 0.0 || d2 == 0.0 {
            return 0.0;
        }
        let [r1, r2] = self.cone_distance();
        let [b1, b2] = self.spiral_angle.map(f64::sin);
        (-(d1 * d2 / self.offset_angle().cos()) * (r1 * b1 - r2 * b2) / (r1 * d1 + r2 * d2)).atan()
    }

    /// Limit radius: the lengthwise curvature at which the contact of a hypoid pair is the same on both flanks. \[m\]
    pub fn limit_radius(&self) -> f64 {
        let limit = self.limit_pressure_angle();
        let [r1, r2] = self.cone_distance();
        let [t1, t2] = self.spiral_angle.map(f64::tan);
        let [c1, c2] = self.spiral_angle.map(f64::cos);
        let [d1, d2] = self.pitch_angle.map(f64::tan);
        let curvature = -limit.tan() * (t1 / (r1 * d1) + t2 / (r2 * d2)) + 1.0 / (r1 * c1) - 1.0 / (r2 * c2);
        (t1 - t2) / limit.cos() / curvature
    }

    /// Offset angle in the axial plane of the wheel. \[rad\]
    pub fn wheel_offset_angle(&self) -> f64 {
        let [c1, c2] = self.pitch_angle.map(f64::cos);
        (self.offset / (self.radius[1] + self.radius[0] * c2 / c1)).asin()
    }

    /// Distances of the mean point from the crossing point of the axes, along each axis. \[m\]
    pub fn crossing_to_mean_point(&self) -> [f64; 2] {
        let [c1, c2] = self.pitch_angle.map(f64::cos);
        let beyond = self.shaft_angle - FRAC_PI_2;
        let angle = self.wheel_offset_angle();
        let sum = self.radius[1] + self.radius[0] * c2 / c1;
        let wheel = self.radius[0] * self.pitch_angle[1].sin() / c1 - angle.cos() * beyond.tan() * sum;
        let pinion = self.radius[1] * angle.cos() * beyond.cos() - wheel * beyond.sin();
        [pinion, wheel]
    }

    /// Distances of the apexes beyond the crossing point of the axes. \[m\]
    pub fn apex_beyond_crossing(&self) -> [f64; 2] {
        let to_mean = self.crossing_to_mean_point();
        let distance = self.cone_distance();
        [0, 1].map(|i| distance[i] * self.pitch_angle[i].cos() - to_mean[i])
    }
}

/// Mean radius of a wheel. `guess` is the pitch angle by which the standard places its mean point. \[m\]
fn mean_radius(size: Size, facewidth: f64, pitch_angle: f64, guess: f64) -> f64 {
    match size {
        Size::Outer(diameter) => (diameter - facewidth * pitch_angle.sin()) / 2.0,
        Size::OuterOfStandard(diameter) => (diameter - facewidth * guess.sin()) / 2.0,
        Size::Mean(diameter) => diameter / 2.0,
    }
}

/// The three conditions on the pitch angles and the offset angle.
struct Search {
    z: [u32; 2],
    shaft_angle: f64,
    offset: f64,
    size: Size,
    facewidth: f64,
    spiral_angle: SpiralAngle,
    closure: Closure,
}

impl Search {
    /// First guess of the standard for the pitch angle of the wheel. \[rad\]
    fn guess(&self) -> f64 {
        let u = f64::from(self.z[1]) / f64::from(self.z[0]);
        let beyond = self.shaft_angle - FRAC_PI_2;
        (u * beyond.cos() / (1.2 * (1.0 - u * beyond.sin()))).atan()
    }

    fn cones(&self, at: Vector3<f64>) -> PitchCones {
        let [first, second, offset_angle] = [at[0], at[1], at[2]];
        let spiral_angle = match self.spiral_angle {
            SpiralAngle::Pinion(angle) => [angle, angle - offset_angle],
            SpiralAngle::Wheel(angle) => [angle + offset_angle, angle],
        };
        let wheel = mean_radius(self.size, self.facewidth, second, self.guess());
        let pinion =
            wheel * spiral_angle[1].cos() / spiral_angle[0].cos() * f64::from(self.z[0]) / f64::from(self.z[1]);
        PitchCones {
            z: self.z,
            shaft_angle: self.shaft_angle,
            offset: self.offset,
            pitch_angle: [first, second],
            spiral_angle,
            radius: [pinion, wheel],
        }
    }

    fn residual(&self, at: Vector3<f64>) -> Vector3<f64> {
        let cones = self.cones(at);
        let [[s1, c1], [s2, c2]] = cones.pitch_angle.map(|angle| [angle.sin(), angle.cos()]);
        let [r1, r2] = cones.radius;
        let angle = at[2];
        Vector3::new(
            c1 * c2 * angle.cos() - s1 * s2 - self.shaft_angle.cos(),
            ((r1 * c2 + r2 * c1) * angle.sin() - self.offset * self.shaft_angle.sin()) / r2,
            self.closure.residual(&cones),
        )
    }
}

impl Closure {
    fn residual(&self, cones: &PitchCones) -> f64 {
        match *self {
            Self::LimitRadius {
                cutter_radius,
                blade_groups,
            } => cones.limit_radius() / lengthwise_radius(cones, cutter_radius, blade_groups) - 1.0,
            Self::Palloid {
                cutter_radius,
                blade_groups,
            } => palloid_distance(cones, cutter_radius, blade_groups) / cones.cone_distance()[0] - 1.0,
            Self::WheelPitchAngle(angle) => cones.pitch_angle[1] - angle,
        }
    }
}

/// Lengthwise radius of curvature of the wheel's teeth at the mean point: the cutter radius, or that of an epicycloid. \[m\]
fn lengthwise_radius(cones: &PitchCones, cutter_radius: f64, blade_groups: u32) -> f64 {
    if blade_groups == 0 {
        return cutter_radius;
    }
    let (groups, beta) = (f64::from(blade_groups), cones.spiral_angle[1]);
    let distance = cones.cone_distance()[1];
    let crown = f64::from(cones.z[1]) / cones.pitch_angle[1].sin();
    let lead = (distance * groups * beta.cos() / (cutter_radius * crown)).asin();
    let between = FRAC_PI_2 - beta + lead;
    let to_cutter = (distance.powi(2) + cutter_radius.powi(2) - 2.0 * distance * cutter_radius * between.cos()).sqrt();
    let second = (distance * beta.cos() * (crown + groups) / (to_cutter * crown)).acos();
    let sum = beta.tan() + second.tan();
    distance * beta.cos() * (beta.tan() + second.tan() / (1.0 + lead.tan() * sum))
}

/// Cone distance of the pinion that method 3 requires. \[m\]
fn palloid_distance(cones: &PitchCones, cutter_radius: f64, blade_groups: u32) -> f64 {
    let [b1, b2] = cones.spiral_angle;
    let distance = cones.cone_distance()[1];
    let offset_angle = cones.offset_angle();
    let lead = (f64::from(blade_groups) * cones.normal_module() / (2.0 * cutter_radius)).asin();
    let turned = (cones.pitch_angle[1].sin() * cones.wheel_offset_angle().tan()).atan();
    let a3 = cutter_radius * (b2 - lead).cos().powi(2);
    let a4 = distance * (b2 + turned).cos() * b2.cos();
    let a5 = offset_angle.sin() * turned.cos() * lead.cos();
    let a6 = distance * b2.cos() + cutter_radius * lead.sin();
    let a7 = b1.cos() * (b2 + turned).cos() - (b2 + turned - lead).sin() * offset_angle.sin() / (b2 - lead).cos();
    a3 * a4 / (a5 * a6 + a3 * a7)
}
