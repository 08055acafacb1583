//! Churning of one gear in a cylindrical case, from an inertia run-down rig to 90 m/s.
//!
//! Source: Shore, Kadiric et al.: Optimization of electric vehicle drivetrain fluid, Tribol. Trans., equations 7 and 8:
//! C = 0.38 rho nu^0.05 R_a^8.51 R_p^-5.90 b^0.20 d_r^0.08 d_x^0.34 h_eff^1.10 w^0.81 g^0.57 in N m, SI throughout, with
//! h_eff = h_0 (phi + (1 - phi) tanh(0.2 + Re^0.4/Fr)), Re = w R_p^2/nu, Fr = w^2 R_p/g, g = 9.8. Dimensionally exact.
//! The exponents of R_a and R_p hide the tooth size: one percent in R_a/R_p moves the torque by eight, so radii must be exact.
//! The dip counts at the reference circle. Single gear; whether d_x is one side or both is not said, one side is assumed.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Limit, Loss, Observed, Term, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::CHURNING;

const TERM: Term = Term::no_load(0, "churning");
const SPEED: Limit = Limit::new(0, "v", "m/s", 0.0, 90.0, "pitch line speeds of the rig");
const H_EFF: Observed = Observed::new(0, "h_eff", "mm", "Depth that remains once the oil is thrown about.");

/// The source rounds gravity. \[m/s2\]
const G: f64 = 9.8;

/// Churning of one gear in a cylindrical case, from an inertia run-down rig to 90 m/s.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Share of the case that oil fills at rest. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fill: f64,
    /// Share of the torque that is added where the gear's lowest point moves towards its mate: 0 to 0.5. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 5.0))]
    pub swell: f64,
}

#[derive(Debug)]
struct Shore {
    fill: f64,
    swell: f64,
    radial: f64,
    axial: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Shore, Diagnostic> {
    let part = cx.part::<GearDrag>().ok_or_else(|| cx.error("bug: no part"))?;
    let (Some(radial), Some(axial)) = (part.radial_clearance, part.axial_clearance) else {
        return Err(cx
            .error("shore needs the gaps between gear and wall")
            .mend("add `housing: { clearance: { radial: 8 mm, axial: 12 mm } }` with your figures"));
    };
    Ok(Shore {
        fill: params.fill,
        swell: params.swell,
        radial,
        axial,
    })
}

impl Shore {
    /// Effective depth and torque from tip and reference radius, width and depth (m), viscosity (m2/s), density, speed.
    #[allow(clippy::too_many_arguments)]
    fn torque(&self, r_a: f64, r_p: f64, b: f64, h_0: f64, nu: f64, rho: f64, omega: f64) -> (f64, f64) {
        let re = omega * r_p * r_p / nu;
        let fr = omega * omega * r_p / G;
        let h_eff = h_0 * (self.fill + (1.0 - self.fill) * (0.2 + re.powf(0.4) / fr).tanh());
        let size = r_a.powf(8.51) * r_p.powf(-5.90) * b.powf(0.20);
        let case = self.radial.powf(0.08) * self.axial.powf(0.34);
        let torque = 0.38 * rho * nu.powf(0.05) * size * case * h_eff.powf(1.10) * omega.powf(0.81) * G.powf(0.57);
        (h_eff, torque)
    }
}

impl GearDragModel for Shore {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let omega = at.speed.abs();
        if at.dip <= 0.0 || omega == 0.0 {
            at.branch("dry or at rest: no churning");
            return Ok(Loss::MOMENTS);
        }
        let (r_a, r_p) = (0.5 * gear.tip_diameter, 0.5 * gear.reference_diameter);
        at.check(&SPEED, omega * r_p);
        let h_0 = at.dip.min(gear.reference_diameter);
        let (h_eff, torque) = self.torque(r_a, r_p, gear.facewidth, h_0, at.nu, at.rho, omega);
        at.observe(&H_EFF, h_eff.mm());
        let swell = if at.towards_mesh > 0.0 { self.swell } else { 0.0 };
        Ok(Loss::MOMENTS.with(&TERM, at.show("C_ch", "Nm", torque * (1.0 + swell))))
    }
}

register!(GearDrag, "shore", Params,
    source: "Shore, Kadiric et al., Tribol. Trans., equations 7 and 8",
    example: "{ type: shore, fill: 0.35 }",
    evidence: [
        formula(Evidence::OneSource, "one article; the dimensions are exact"),
        default_of("swell", Evidence::Assumed, "no public formula"),
    ],
    limits: [SPEED], terms: [TERM], observed: [H_EFF], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c10_published_gear() {
        let model = Shore {
            fill: 0.35,
            swell: 0.0,
            radial: 6e-3,
            axial: 30e-3,
        };
        for (nu, n, h_eff, torque) in [
            (50.0, 1000.0, 26.1933, 0.0805387),
            (10.0, 3000.0, 20.2747, 0.136511),
            (10.0, 9000.0, 17.372, 0.280426),
        ] {
            let omega = n * std::f64::consts::PI / 30.0;
            let own = model.torque(74e-3, 70e-3, 20e-3, 35e-3, nu * 1e-6, 840.0, omega);
            assert!((own.0 * 1e3 / h_eff - 1.0).abs() < 1e-5, "{own:?}");
            assert!((own.1 / torque - 1.0).abs() < 1e-5, "{own:?}");
        }
    }

    /// Oil of 27.3 mm2/s and 826 kg/m3 at 40 degC.
    #[test]
    fn u9a_u9b_u9c_three_speeds() {
        let model = Shore {
            fill: 0.30,
            swell: 0.0,
            radial: 6e-3,
            axial: 30e-3,
        };
        for (n, h_eff, torque) in [
            (1000.0, 0.02748452, 0.08101279),
            (4000.0, 0.01698586, 0.1466633),
            (12000.0, 0.01562399, 0.3257352),
        ] {
            let omega = n * std::f64::consts::PI / 30.0;
            let own = model.torque(74e-3, 70e-3, 20e-3, 35e-3, 27.3e-6, 826.0, omega);
            assert!((own.0 / h_eff - 1.0).abs() < 1e-6, "{own:?}");
            assert!((own.1 / torque - 1.0).abs() < 1e-6, "{own:?}");
        }
    }
}
