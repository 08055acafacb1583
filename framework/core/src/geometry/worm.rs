//! Worm and wheel with axes at right angles: kinematics of the threads, and the efficiency of a screw.
//!
//! Source: screw kinematics, as in DIN 3975 and DIN 3996: tan gamma_m = z_1/q at the reference cylinder of the worm, whose diameter is
//! d_m1 = q m_x, and a = m_x (q + z_2 + 2 x_2)/2. The efficiency with friction is that of forces as vectors at the mean point
//! ([`MeanPoint`](crate::geometry::crossed::MeanPoint)): tan gamma/tan(gamma + rho) if the worm drives and tan(gamma - rho)/tan gamma if the
//! wheel drives, with tan rho = mu/cos alpha_n. DIN 3996 has tan rho = mu, for its own coefficients of friction.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use super::crossed::PitchCones;
use crate::real::Real;

/// Profile of the threads of a worm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WormProfile {
    /// Straight in the axial section.
    Za,
    /// Straight in the normal section.
    Zn,
    /// Involute helicoid.
    #[default]
    Zi,
    /// Ground with a conical disc.
    Zk,
    /// Concave, ground with a disc of circular profile.
    Zc,
}

/// What a drawing of a cylindrical worm drive states. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WormSpec {
    /// Threads of the worm and teeth of the wheel.
    pub z: [u32; 2],
    /// Axial module m_x of the worm.
    pub module: f64,
    /// Reference diameter d_m1 of the worm.
    pub worm_diameter: f64,
    /// Normal pressure angle.
    pub pressure_angle: f64,
    /// Profile of the threads.
    pub profile: WormProfile,
    /// Profile shift coefficient x_2 of the wheel.
    pub profile_shift: f64,
    /// Face width b_2H of the wheel.
    pub facewidth: f64,
}

/// Efficiency at which sources expect self-locking of a worm drive at rest: below the first certainly, between both perhaps.
const DOUBTFUL: [f64; 2] = [0.45, 0.55];

/// Whether a worm drive at rest holds a load on its wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Holding {
    /// Self-locking: the wheel cannot set the worm in motion.
    SelfLocking,
    /// Efficiency at rest between 0.45 and 0.55: vibration may release it.
    Doubtful,
    /// The wheel can drive the worm.
    None,
}

/// A cylindrical worm and its wheel. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WormPair {
    /// What the drawing states.
    pub spec: WormSpec,
    /// Lead angle gamma_m at the reference cylinder.
    pub lead_angle: f64,
    /// Centre distance.
    pub centre_distance: f64,
}

impl WormPair {
    /// A pair from its drawing.
    pub fn new(spec: WormSpec) -> Self {
        let [starts, teeth] = spec.z.map(f64::from);
        Self {
            spec,
            lead_angle: (starts * spec.module / spec.worm_diameter).atan(),
            centre_distance: 0.5 * (spec.worm_diameter + spec.module * (teeth + 2.0 * spec.profile_shift)),
        }
    }

    /// Ratio z_2/z_1.
    pub fn ratio(&self) -> f64 {
        let [starts, teeth] = self.spec.z.map(f64::from);
        teeth / starts
    }

    /// Diameter factor q.
    pub fn diameter_factor(&self) -> f64 {
        self.spec.worm_diameter / self.spec.module
    }

    /// Diameter d_m2 of the wheel that touches the reference cylinder of the worm.
    pub fn wheel_diameter(&self) -> f64 {
        2.0 * self.centre_distance - self.spec.worm_diameter
    }

    /// Sliding velocity over the speed of the worm, at its reference cylinder. \[m\]
    pub fn sliding(&self) -> f64 {
        0.5 * self.spec.worm_diameter / self.lead_angle.cos()
    }

    /// The cylinders that roll on each other across the threads, for a worm of right hand. With profile shift that of the worm is larger than
    /// its reference cylinder by twice the shift, and that of the wheel is its own.
    pub fn cylinders(&self) -> PitchCones {
        let rolling = self.spec.worm_diameter + 2.0 * self.spec.profile_shift * self.spec.module;
        let lead = (f64::from(self.spec.z[0]) * self.spec.module / rolling).atan();
        PitchCones::cylinders(self.spec.z, self.spec.module * lead.cos(), [FRAC_PI_2 - lead, -lead])
    }

    /// Efficiency for the tangent of the angle of friction: if the worm drives, and if the wheel drives. Below zero, both must be driven.
    #[inline(always)]
    pub fn efficiencies<R: Real>(&self, tan_rho: R) -> [R; 2] {
        let lead = self.lead_angle.tan();
        let one = R::constant(1.0);
        [
            (one - tan_rho * lead) / (one + tan_rho / lead),
            (one - tan_rho / lead) / (one + tan_rho * lead),
        ]
    }

    /// Tangent of the angle of friction of a coefficient of friction, with forces as vectors.
    #[inline(always)]
    pub fn tan_rho<R: Real>(&self, friction: R) -> R {
        friction / self.spec.pressure_angle.cos()
    }

    /// The tangent of the angle of friction that has an efficiency if the worm drives.
    pub fn tan_rho_of(&self, efficiency: f64) -> f64 {
        let lead = self.lead_angle.tan();
        (1.0 - efficiency) / (lead + efficiency / lead)
    }
}

impl Holding {
    /// From the efficiency with which the worm sets its wheel in motion.
    pub fn of(starting_efficiency: f64) -> Self {
        let [certain, perhaps] = DOUBTFUL;
        if starting_efficiency < certain {
            Self::SelfLocking
        } else if starting_efficiency <= perhaps {
            Self::Doubtful
        } else {
            Self::None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::crossed::{Flank, MeanPoint};

    fn close(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} instead of {expected}");
    }

    /// Example of the public REXS models of FVA.
    fn fva() -> WormPair {
        WormPair::new(WormSpec {
            z: [2, 41],
            module: 4e-3,
            worm_diameter: 36e-3,
            pressure_angle: 20.0_f64.to_radians(),
            profile: WormProfile::Zi,
            profile_shift: 0.0,
            facewidth: 30e-3,
        })
    }

    #[test]
    fn kinematics_of_the_example() {
        let pair = fva();
        close(pair.lead_angle.to_degrees(), 12.528807, 1e-6);
        close(pair.centre_distance, 0.1, 1e-15);
        close(pair.sliding() * 1e3, 18.43908891, 1e-8);
        close(
            MeanPoint::new(&pair.cylinders()).sliding().norm() * 1e3,
            18.43908891,
            1e-8,
        );
    }

    #[test]
    fn efficiencies_of_the_example() {
        let pair = fva();
        let friction = 0.0403544;
        let [forward, back] = pair.efficiencies(friction);
        close(forward, 0.83872437, 5e-9);
        close(back, 0.81113126, 5e-9);
        let [forward, back] = pair.efficiencies(pair.tan_rho(friction));
        close(forward, 0.83005031, 5e-9);
        close(back, 0.79912467, 5e-9);
        close(pair.tan_rho_of(forward), pair.tan_rho(friction), 1e-15);
    }

    /// The closed form is that of forces as vectors, for both flanks and both directions of power, also where the pair locks.
    #[test]
    fn forces_as_vectors_have_the_same_efficiency() {
        let pair = fva();
        let frame = MeanPoint::new(&pair.cylinders());
        for friction in [0.0, 0.05, 0.25] {
            let [forward, back] = pair.efficiencies(pair.tan_rho(friction));
            assert_eq!(back < 0.0, friction > 0.2);
            for flank in [Flank::Drive, Flank::Coast] {
                let normal = frame.flank_normal(pair.spec.pressure_angle, flank);
                let powers = |turns: f64| {
                    let on_first = normal - frame.sliding().normalize() * (turns * friction);
                    [
                        frame.torque_of(0, on_first) * turns,
                        frame.torque_of(1, -on_first) * turns * frame.speed_ratio,
                    ]
                };
                // The flanks push the worm in one sense of rotation; in the other one it pushes them.
                let pushed = frame.torque_of(0, normal).signum();
                let [worm, wheel] = powers(-pushed);
                close(wheel / -worm, forward, 1e-12);
                let [worm, wheel] = powers(pushed);
                close(worm / -wheel, back, 1e-12);
            }
        }
    }

    #[test]
    fn without_friction_nothing_is_lost() {
        assert_eq!(fva().efficiencies(0.0), [1.0, 1.0]);
    }

    #[test]
    fn profile_shift_keeps_the_axes_and_the_ratio() {
        let pair = WormPair::new(WormSpec {
            profile_shift: 0.4,
            ..fva().spec
        });
        let cylinders = pair.cylinders();
        close(cylinders.offset, pair.centre_distance, 1e-15);
        close(cylinders.shaft_angle, FRAC_PI_2, 1e-15);
        let turns = cylinders.radius[0] * cylinders.spiral_angle[0].cos()
            / cylinders.radius[1]
            / cylinders.spiral_angle[1].cos();
        close(turns, 2.0 / 41.0, 1e-15);
    }

    #[test]
    fn a_load_is_held_by_the_efficiency_at_rest() {
        assert_eq!(
            [0.44, 0.5, 0.56].map(Holding::of),
            [Holding::SelfLocking, Holding::Doubtful, Holding::None]
        );
    }
}
