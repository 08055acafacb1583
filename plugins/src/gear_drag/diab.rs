//! Windage of one gear according to Diab, by dimensional analysis or from faces and teeth.
//!
//! Source: Diab, Ville, Velex, Changenet: Windage losses in high speed gears, J. Mech. Des. 126 (2004) 903-908, quoted from memory.
//! Dimensional: C_t = 60 Re^-0.25 (b/R)^0.8 z^-0.4 ((h1/R)^0.56 + (h2/R)^0.56), P = 1/2 C_t rho w^3 R^5, Re = rho w R^2/mu, h1 and h2 the
//! distances of flanges, 0.5 R where there are none.
//! Analytical: faces C_f = 2 n1 pi/(5 - 2 m1) (R*/R)^5/Re*^m1 + 2 n2 pi/(5 - 2 m2) (Re^-m2 - (R*/R)^5/Re*^m2), n1 1.293, m1 0.5, n2 0.074,
//! m2 0.2, Re* = 3e5; teeth C_l = xi z/4 (b/R) (r_a/R)^4 (1 - cos phi)(1 + cos phi)^3, phi = pi/z - 2 (inv alpha_p - inv alpha_A).
//! The medium is air at oil temperature, with a volume fraction of oil for mist.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::involute;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::WINDAGE;
use crate::air::Air;

terms! { TERM = no_load("windage"); }
const PI: f64 = std::f64::consts::PI;

/// Which of the two laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// By dimensional analysis, with flanges.
    #[default]
    Dimensional,
    /// From faces and teeth, with deflectors.
    Analytical,
}

coefficients! {
    /// Constants of both laws of Diab.
    pub struct Constants {
        /// Factor of C_t of the dimensional law.
        factor = 60.0, in 30.0..=120.0;
        /// Exponent of the Reynolds number in C_t.
        reynolds_exponent = -0.25, in -0.5..=-0.125;
        /// Exponent of b/R in C_t.
        width_exponent = 0.8, in 0.4..=1.6;
        /// Exponent of the number of teeth in C_t.
        teeth_exponent = -0.4, in -0.8..=-0.2;
        /// Exponent of the flange distances over R in C_t.
        flange_exponent = 0.56, in 0.28..=1.12;
        /// Factor n1 of laminar flow at the faces, in the analytical law.
        laminar_factor = 1.293, in 0.6465..=2.586;
        /// Exponent m1 of the Reynolds number in laminar flow.
        laminar_exponent = 0.5, in 0.25..=1.0;
        /// Factor n2 of turbulent flow at the faces.
        turbulent_factor = 0.074, in 0.037..=0.148;
        /// Exponent m2 of the Reynolds number in turbulent flow.
        turbulent_exponent = 0.2, in 0.1..=0.4;
        /// Reynolds number Re* at which the flow at the faces becomes turbulent.
        critical_reynolds = 3e5, in 1.5e5..=6e5;
    }
}

/// Windage of one gear according to Diab, by dimensional analysis or from faces and teeth.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Diab {
    /// Which of the two laws.
    #[serde(default)]
    pub form: Form,
    /// Axial distances of flanges from both faces, for the dimensional law; default: half of the radius. [mm]
    #[schemars(inner(range(min = 0.1, max = 10000.0)))]
    pub flanges: Option<[f64; 2]>,
    /// Factor for deflectors on the teeth, for the analytical law; 1 without deflectors. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub xi: f64,
    /// Volume fraction of oil in the air. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5))]
    pub oil_fraction: f64,
    #[serde(default)]
    coefficients: Constants,
}

fn default_one() -> f64 {
    1.0
}

/// C_t of the dimensional law.
fn dimensional(c: &Constants, re: f64, b: f64, z: f64, flanges: [f64; 2]) -> f64 {
    c.factor
        * re.powf(c.reynolds_exponent)
        * b.powf(c.width_exponent)
        * z.powf(c.teeth_exponent)
        * (flanges[0].powf(c.flange_exponent) + flanges[1].powf(c.flange_exponent))
}

/// C_f of both faces of a disc.
pub(crate) fn faces(c: &Constants, re: f64) -> f64 {
    let (n_1, m_1) = (c.laminar_factor, c.laminar_exponent);
    let (n_2, m_2, critical) = (c.turbulent_factor, c.turbulent_exponent, c.critical_reynolds);
    if re < critical {
        return 2.0 * n_1 * PI / (5.0 - 2.0 * m_1) * re.powf(-m_1);
    }
    // R*/R to the fifth.
    let inner = (critical / re).sqrt().powi(5);
    2.0 * n_1 * PI / (5.0 - 2.0 * m_1) / critical.powf(m_1) * inner
        + 2.0 * n_2 * PI / (5.0 - 2.0 * m_2) * (re.powf(-m_2) - inner / critical.powf(m_2))
}

/// C_l of the teeth; radii of reference, tip and base circle, face width (m).
fn teeth(xi: f64, z: f64, r: f64, r_a: f64, r_b: f64, b: f64) -> f64 {
    let angle = |radius: f64| (r_b / radius).min(1.0).acos();
    let phi = PI / z - 2.0 * (involute(angle(r)) - involute(angle(r_a)));
    xi * z / 4.0 * (b / r) * (r_a / r).powi(4) * (1.0 - phi.cos()) * (1.0 + phi.cos()).powi(3)
}

impl GearDragModel for Diab {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let omega = at.speed.abs();
        if omega == 0.0 {
            at.branch("at standstill: no windage");
            return Ok(Loss::POWERS);
        }
        let r = 0.5 * gear.reference_diameter;
        let air = Air::at_temperature(at.temperature + 273.15);
        let rho = air.rho + self.oil_fraction * at.rho;
        let re = at.show("Re", "-", rho * omega * r * r / air.mu);
        at.show("R", "mm", r.mm());
        let z = f64::from(gear.z);
        let c = match self.form {
            Form::Dimensional => {
                let flanges = self.flanges.map_or([0.5; 2], |h| h.map(|h| h / r));
                dimensional(&self.coefficients, re, gear.facewidth / r, z, flanges)
            }
            Form::Analytical => {
                let transverse = (gear.pressure_angle.tan() / gear.helix_angle.cos()).atan();
                let r_b = r * transverse.cos();
                faces(&self.coefficients, re) + teeth(self.xi, z, r, 0.5 * gear.tip_diameter, r_b, gear.facewidth)
            }
        };
        let power = 0.5 * at.show("C", "-", c) * rho * omega.powi(3) * r.powi(5);
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

fn prepare(params: Diab, cx: &mut Build<'_>) -> Result<Diab, Diagnostic> {
    if params.form == Form::Analytical && params.flanges.is_some() {
        return Err(cx
            .error("`flanges` applies to the dimensional law only")
            .help("omit `flanges`, or write `form: dimensional`"));
    }
    if params.form == Form::Dimensional && params.xi != 1.0 {
        return Err(cx
            .error("`xi` applies to the analytical law only")
            .help("omit `xi`, or write `form: analytical`"));
    }
    Ok(params)
}

register!(GearDrag, "diab", Diab,
    source: "Diab, Ville, Velex, Changenet, J. Mech. Des. 126 (2004) 903-908",
    example: "{ type: diab, form: analytical }",
    evidence: [
        formula(Evidence::Recalled, "four independent windage laws agree within a factor of two"),
        default_of("form", Evidence::Recalled, "both laws are Diab's"),
        default_of("flanges", Evidence::Recalled, "no flanges"),
        default_of("xi", Evidence::Recalled, "a free gear"),
        default_of("oil_fraction", Evidence::Assumed, "dry air"),
    ],
    terms: [TERM], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn c15_dimensional() {
        let re = 1.2 * 1000.0 * 0.144 * 0.144 / 1.8e-5;
        close(re, 1.3824e6);
        let c_t = dimensional(&Constants::PUBLISHED, re, 30.0 / 144.0, 72.0, [0.5; 2]);
        close(c_t, 0.122326);
        close(0.5 * c_t * 1.2 * 1e9 * 0.144_f64.powi(5), 4544.48);
        let re = 1.2 * 1500.0 * 0.06 * 0.06 / 1.8e-5;
        let c_t = dimensional(&Constants::PUBLISHED, re, 25.0 / 60.0, 40.0, [10.0 / 60.0; 2]);
        close(c_t, 0.203867);
        close(0.5 * c_t * 1.2 * 1500.0_f64.powi(3) * 0.06_f64.powi(5), 321.018);
    }

    #[test]
    fn c16_analytical() {
        let r_b = 0.144 * 20.0_f64.to_radians().cos();
        let c_l = teeth(1.0, 72.0, 0.144, 0.148, r_b, 0.030);
        close(c_l, 0.0721945);
        for (omega, c_f, power) in [(1000.0, 0.00588094, 2900.54), (100.0, 0.00546263, 2.885)] {
            let moment = faces(&Constants::PUBLISHED, 1.2 * omega * 0.144 * 0.144 / 1.8e-5);
            close(moment, c_f);
            close(
                0.5 * (moment + c_l) * 1.2 * f64::powi(omega, 3) * 0.144_f64.powi(5),
                power,
            );
        }
    }

    #[test]
    fn both_branches_of_the_faces_meet() {
        assert!(
            (faces(&Constants::PUBLISHED, 2.999_999e5) / faces(&Constants::PUBLISHED, 3.000_001e5) - 1.0).abs() < 1e-5
        );
    }
}
