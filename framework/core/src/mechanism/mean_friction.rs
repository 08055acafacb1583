//! One coefficient of friction for a whole mesh.

use crate::loss::{Notes, Undefined};
use crate::mechanism::gear_mesh::{GearMeshAt, MeshPart};
use crate::mechanism::{Answers, Mechanism, Scalar, with_oil};
use crate::real::{Dual, Lane, Points as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum MeanFriction {}

/// Mean coefficient of friction of a mesh.
///
/// The inputs are [`MeanFrictionAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait MeanFrictionModel: Send + Sync {
    /// Coefficient of friction. \[-\] Pure; must not allocate. Called with positive torque and speed.
    fn mu(&self, at: &MeanFrictionAt<'_>) -> Result<f64, Undefined>;

    /// The coefficients at several points together; written by a [law](MeanFrictionLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn mu_together(&self, _at: &MeanFrictionAt<'_, Lane>) -> Result<Lane, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The coefficient with its derivatives; written by a [law](MeanFrictionLaw). `None` has them found by differences.
    fn mu_with_derivatives(&self, _at: &MeanFrictionAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        None
    }
}

/// A law of mean friction that is written once for one point and for several; mark `mu` as `#[inline(always)]`, so that it uses wide
/// instructions.
pub trait MeanFrictionLaw: Send + Sync {
    /// Coefficient of friction at one operating point, or at several. \[-\] Pure; must not allocate. Called with positive torque and
    /// speed; among several points also without, where the result is not used.
    fn mu<R: Answers>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined>;
}

impl<L: MeanFrictionLaw> MeanFrictionModel for L {
    fn mu(&self, at: &MeanFrictionAt<'_>) -> Result<f64, Undefined> {
        MeanFrictionLaw::mu(self, at)
    }

    fn mu_together(&self, at: &MeanFrictionAt<'_, Lane>) -> Result<Lane, Undefined> {
        Lane::wide(
            #[inline(always)]
            || MeanFrictionLaw::mu(self, at),
        )
    }

    fn mu_with_derivatives(&self, at: &MeanFrictionAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        Some(MeanFrictionLaw::mu(self, at))
    }
}

context! {
    /// All inputs of a mean friction law: the mesh at its pitch point, in the frame of its carrier.
    pub struct MeanFrictionAt of MeanFriction {
        /// Tangential force at the base circle over the face width, which is the normal force over the length of a line of contact. [N/mm]
        line_load: 200.0 in 0.0..=3000.0 from "torque of the mesh over its face width",
        /// Normal force of the mesh. [N]
        normal_force: 2800.0 in 0.0..=1000000.0 from "torque of the mesh and base circle",
        /// Hertz pressure at the pitch point under the full normal force. [GPa]
        pressure: 0.927 in 0.0..=4.0 from "`normal_force`, `radius` and the material",
        /// Magnitude of the speed of the first gear relative to the carrier. [rpm]
        speed: 3000.0 in 0.0..=30000.0 from "kinematics",
        /// Pitch line velocity. [m/s]
        pitch_speed: 11.5 in 0.0..=200.0 from "`speed` and the working pitch circle",
        /// Sum of the surface speeds at the pitch point. [m/s]
        sum_speed: 8.78 in 0.0..=200.0 from "`speed` and the geometry of the pair",
        /// Radius of relative curvature at the pitch point, normal plane. [mm]
        radius: 8.38 in 0.1..=500.0 from "the geometry of the pair",
        /// Arithmetic mean roughness, mean of both flanks. [um]
        ra: 0.4 in 0.01..=5.0 from "`surface.ra` of both gears",
        /// Root mean square roughness of both flanks together. [um]
        rq: 0.707 in 0.01..=5.0 from "`surface.rq` of both gears",
        ..oil of contacts from "the oil of the mesh",
    } laws {
        "normal_force = line_load facewidth/cos beta_b" {
            normal_force: |at| at.line_load * at.part.pair.line_length(),
            line_load: |at| at.normal_force / at.part.pair.line_length(),
        }
        "pressure = sqrt(line_load modulus/(2 pi radius))" {
            pressure: |at| hertz(at.normal_force / at.part.pair.line_length(), at.part.modulus, at.radius),
            normal_force: |at| load_at(at.pressure, at.part.modulus, at.radius) * at.part.pair.line_length(),
            radius: |at| radius_at(at.pressure, at.part.modulus, at.normal_force / at.part.pair.line_length()),
        }
        "pitch_speed = speed working_diameter/2" {
            pitch_speed: |at| at.speed * at.part.pair.working_radius[0],
            speed: |at| at.pitch_speed / at.part.pair.working_radius[0],
        }
        "sum_speed = 2 pitch_speed sin alpha_wt" {
            sum_speed: |at| 2.0 * at.pitch_speed * at.part.pair.sin_working_angle,
            pitch_speed: |at| at.sum_speed / (2.0 * at.part.pair.sin_working_angle),
        }
        "radius equals that of the pair at its pitch point" usually { radius: |at| at.part.pair.pitch_radius }
        "ra equals that of the pair" usually { ra: |at| at.part.ra }
        "rq equals that of the pair" usually { rq: |at| at.part.rq }
    }
}

impl<'a, R: Real> MeanFrictionAt<'a, R> {
    /// The mesh at its pitch point.
    #[inline(always)]
    pub fn at_pitch_point(at: &GearMeshAt<'a, R>, notes: Notes<'a, R>) -> Self {
        let part = at.part;
        let pair = &part.pair;
        let tangential = at.torque / pair.base_radius[0];
        let normal_force = pair.normal_force(at.torque);
        let speed = at.speed.abs();
        let pitch_speed = speed * pair.working_radius[0];
        let [line_load, of_pressure] = if pair.touches_in_a_point() {
            [pair.line_load(normal_force); 2]
        } else {
            [tangential / pair.facewidth, normal_force / pair.line_length()]
        };
        with_oil!(of contacts from at, Self {
            part,
            line_load,
            normal_force,
            pressure: hertz(of_pressure, R::constant(part.modulus), R::constant(pair.pitch_radius)),
            speed,
            pitch_speed,
            sum_speed: pitch_speed * 2.0 * pair.sin_working_angle,
            radius: R::constant(pair.pitch_radius),
            ra: R::constant(part.ra),
            rq: R::constant(part.rq),
            notes,
        })
    }
}

/// Hertz pressure of a line contact from line load in N/m, reduced modulus in Pa and radius in m. \[Pa\]
#[inline(always)]
pub fn hertz<R: Real>(line_load: R, modulus: R, radius: R) -> R {
    (line_load * modulus / (radius * (2.0 * std::f64::consts::PI))).sqrt()
}

/// Line load at which a line contact has a Hertz pressure. \[N/m\]
pub fn load_at(pressure: f64, modulus: f64, radius: f64) -> f64 {
    pressure * pressure * (2.0 * std::f64::consts::PI * radius) / modulus
}

/// Radius at which a line contact has a Hertz pressure. \[m\]
pub fn radius_at(pressure: f64, modulus: f64, line_load: f64) -> f64 {
    line_load * modulus / (2.0 * std::f64::consts::PI * pressure * pressure)
}

/// Reduced modulus at which a line contact has a Hertz pressure. \[Pa\]
pub fn modulus_at(pressure: f64, line_load: f64, radius: f64) -> f64 {
    pressure * pressure * (2.0 * std::f64::consts::PI * radius) / line_load
}

impl Mechanism for MeanFriction {
    const KEY: &'static str = "mean_friction";
    const MEANING: &'static str = "Mean coefficient of friction of a mesh.";
    const ANSWER: &'static str = "Coefficient of friction. [-]";
    const EXAMPLE: &'static str = crate::mechanism::gear_mesh::GearMesh::EXAMPLE;
    type Part = MeshPart;
    type At<'a, R: Real> = MeanFrictionAt<'a, R>;
    type Answer = f64;
    type Model = dyn MeanFrictionModel;

    answered_by!(mu, mu_together, mu_with_derivatives);
}

impl MeanFrictionModel for Scalar<MeanFriction> {
    fn mu(&self, at: &MeanFrictionAt<'_>) -> Result<f64, Undefined> {
        self.value(at)
    }

    fn mu_together(&self, at: &MeanFrictionAt<'_, Lane>) -> Result<Lane, Undefined> {
        self.values(at)
    }

    fn mu_with_derivatives(&self, _at: &MeanFrictionAt<'_, Dual>) -> Option<Result<Dual, Undefined>> {
        self.constant().map(|value| Ok(Dual::constant(value)))
    }
}

crate::register_mechanism!(MeanFriction);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn b12_hertz_pressure() {
        let p = hertz(300e3, 226.374e9, 0.010);
        assert!((p / 1.03964e9 - 1.0).abs() < 1e-5, "{p}");
    }
}
