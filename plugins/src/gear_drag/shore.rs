//! Churning of one gear in a cylindrical case, from inertia run-down tests up to 90 m/s.
//!
//! Source: Shore, Kadiric et al.: Optimization of electric vehicle drivetrain fluid, Tribol. Trans., equations 7 and 8: C = 0.38
//! rho nu^0.05 R_a^8.51 R_p^-5.90 b^0.20 d_r^0.08 d_x^0.34 h_eff^1.10 w^0.81 g^0.57 in N m, SI throughout, with h_eff = h_0 (phi +
//! (1 - phi) tanh(0.2 + Re^0.4/Fr)), Re = w R_p^2/nu, Fr = w^2 R_p/g, g = 9.8. Dimensionally exact. The exponents of R_a and R_p
//! make it sensitive to tooth height: a change of one percent in R_a/R_p changes the torque by eight percent, so the radii must be
//! exact. Immersion depth at the reference circle, at rest: h_0 is printed as the initial depth, and h_eff contains how the level
//! falls. Single gear; the source does not state whether d_x is the gap of one side or both; one side is assumed.

use gearloss_framework::codes;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::CHURNING;
use super::rise::{Rise, SWELL, churning};
use crate::checks::SIX_DIGITS;

terms! { TERM = no_load("churning"); }
limits! {
    after SWELL;
    SPEED = ("v", "pitch line velocity", "m/s", 0.0, 90.0, "pitch line velocities of the rig");
}
observed! { H_EFF = ("h_eff", "mm", "effective immersion depth while the gear rotates"); }

/// The source rounds gravity. \[m/s2\]
const G: f64 = 9.8;

coefficients! {
    /// Constants of equations 7 and 8 of Shore and others.
    struct Constants {
        /// Factor of the torque, SI.
        factor = 0.38, in 0.19..=0.76;
        /// Exponent of the viscosity.
        viscosity_exponent = 0.05, in 0.025..=0.1;
        /// Exponent of the tip radius.
        tip_exponent = 8.51, in 6.0..=11.0;
        /// Exponent of the reference radius.
        pitch_exponent = -5.90, in -8.0..=-4.0;
        /// Exponent of the face width.
        width_exponent = 0.20, in 0.1..=0.4;
        /// Exponent of the radial gap.
        radial_gap_exponent = 0.08, in 0.04..=0.16;
        /// Exponent of the axial gap.
        axial_gap_exponent = 0.34, in 0.17..=0.68;
        /// Exponent of the effective depth.
        depth_exponent = 1.10, in 0.55..=2.2;
        /// Exponent of the speed.
        speed_exponent = 0.81, in 0.405..=1.62;
        /// Exponent of gravity.
        gravity_exponent = 0.57, in 0.285..=1.14;
        /// Constant inside the hyperbolic tangent of the effective depth.
        depth_constant = 0.2, in 0.1..=0.4;
        /// Exponent of the Reynolds number there.
        depth_reynolds_exponent = 0.4, in 0.2..=0.8;
    }
}

churning! {
    /// Churning of one gear in a cylindrical case, from inertia run-down tests up to 90 m/s.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Params {
        /// Share of the case filled with oil at standstill; default: that of the oil space of the housing. [-]
        #[schemars(range(min = 0.0, max = 1.0))]
        pub fill: Option<f64>,
        #[serde(default)]
        coefficients: Constants,
    }
}

#[derive(Debug)]
struct Shore {
    coefficients: Constants,
    fill: f64,
    rise: Rise,
    radial: f64,
    axial: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Shore, Diagnostic> {
    let part = cx.own_part::<GearDrag>()?;
    let part_fill = part.fill;
    let (Some(radial), Some(axial)) = (part.radial_clearance, part.axial_clearance) else {
        return Err(cx
            .error("shore requires the gaps between gear and wall")
            .help("add `housing: { clearance: { radial: 8 mm, axial: 12 mm } }` with your values"));
    };
    let Some(fill) = params.fill.or(part_fill) else {
        return Err(cx
            .error("shore requires the filled share of the case")
            .help("add `fill: 0.3` with your value, or an oil level with `housing.inside`"));
    };
    let rise = params.rise(cx)?;
    let drawn = part_fill.filter(|drawn| cx.has_drawn_space() && (fill - drawn).abs() > 0.1 * drawn);
    if let (Some(drawn), Some(stated)) = (drawn, params.fill) {
        let message = format!(
            "{stated} is stated, and the oil at rest fills {drawn:.3} of the oil space in `housing.inside`; the stated one is used"
        );
        let doubt = Diagnostic::warning("", message).code(codes::STATED_OVER_DRAWING);
        cx.doubt("fill", doubt.help("remove `fill`, or correct the outline or the level"));
    }
    Ok(Shore {
        rise,
        coefficients: params.coefficients,
        fill,
        radial,
        axial,
    })
}

impl Shore {
    /// Effective depth and torque from tip and reference radius, width and depth (m), viscosity (m2/s), density, speed.
    #[allow(clippy::too_many_arguments)]
    fn torque(&self, r_a: f64, r_p: f64, b: f64, h_0: f64, nu: f64, rho: f64, omega: f64) -> (f64, f64) {
        let c = &self.coefficients;
        let re = omega * r_p * r_p / nu;
        let fr = omega * omega * r_p / G;
        let h_eff =
            h_0 * (self.fill + (1.0 - self.fill) * (c.depth_constant + re.powf(c.depth_reynolds_exponent) / fr).tanh());
        let size = r_a.powf(c.tip_exponent) * r_p.powf(c.pitch_exponent) * b.powf(c.width_exponent);
        let case = self.radial.powf(c.radial_gap_exponent) * self.axial.powf(c.axial_gap_exponent);
        let viscous = c.factor * rho * nu.powf(c.viscosity_exponent);
        let depth = h_eff.powf(c.depth_exponent);
        let torque = viscous * size * case * depth * omega.powf(c.speed_exponent) * G.powf(c.gravity_exponent);
        (h_eff, torque)
    }
}

impl GearDragModel for Shore {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| Ok(self.alone(at)))
    }
}

impl Shore {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Loss {
        let gear = &at.part.gear;
        let omega = at.speed.abs();
        if at.dip <= 0.0 || omega == 0.0 {
            at.branch("dry or at standstill: no churning");
            return Loss::MOMENTS;
        }
        let (r_a, r_p) = (0.5 * gear.tip_diameter, 0.5 * gear.reference_diameter);
        at.check(&SPEED, omega * r_p);
        let h_0 = at.dip.min(gear.reference_diameter);
        let (h_eff, torque) = self.torque(r_a, r_p, gear.facewidth, h_0, at.nu, at.rho, omega);
        at.observe(&H_EFF, h_eff.mm());
        Loss::MOMENTS.with(&TERM, at.show("C_ch", "Nm", torque))
    }
}

/// A check of the same wheel in its housing.
macro_rules! wheel {
    ($model:literal, $at:literal) => {
        concat!(
            "{ model: ",
            $model,
            ", part: { gear: { z: 35, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 20 mm, reference_diameter: 140 mm, ",
            "working_diameter: 140 mm, tip_diameter: 148 mm, root_diameter: 130 mm, contact_height: 1 mm }, ",
            "radial_clearance: 6 mm, axial_clearance: 30 mm }, at: ",
            $at,
            " }"
        )
    };
}

register!(GearDrag, "shore", Params,
    source: "Shore, Kadiric et al., Tribol. Trans., equations 7 and 8",
    example: "{ type: shore, fill: 0.35 }",
    evidence: [
        formula(Evidence::OneSource, "one article; dimensionally exact"),
        default_of("fill", Evidence::Assumed, "a spacious housing; the source has a cylinder around one gear"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: wheel!("{ type: shore, fill: 0.35 }", "{ speed: 1000 rpm, dip: 35 mm, nu: 50 mm2/s, rho: 840 kg/m3 }"),
            values: &[("h_eff", "26.1933 mm"), ("moment", "0.0805387 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: wheel!("{ type: shore, fill: 0.35 }", "{ speed: 3000 rpm, dip: 35 mm, nu: 10 mm2/s, rho: 840 kg/m3 }"),
            values: &[("h_eff", "20.2747 mm"), ("moment", "0.136511 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: wheel!("{ type: shore, fill: 0.35 }", "{ speed: 9000 rpm, dip: 35 mm, nu: 10 mm2/s, rho: 840 kg/m3 }"),
            values: &[("h_eff", "17.372 mm"), ("moment", "0.280426 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: wheel!("{ type: shore, fill: 0.3 }", "{ speed: 1000 rpm, dip: 35 mm, nu: 27.3 mm2/s, rho: 826 kg/m3 }"),
            values: &[("h_eff", "27.48452 mm"), ("moment", "0.08101279 Nm")],
            tolerance: 1e-6,
            because: "the values have seven digits",
            ..SIX_DIGITS
        },
        Check {
            input: wheel!("{ type: shore, fill: 0.3 }", "{ speed: 4000 rpm, dip: 35 mm, nu: 27.3 mm2/s, rho: 826 kg/m3 }"),
            values: &[("h_eff", "16.98586 mm"), ("moment", "0.1466633 Nm")],
            tolerance: 1e-6,
            because: "the values have seven digits",
            ..SIX_DIGITS
        },
        Check {
            input: wheel!("{ type: shore, fill: 0.3 }", "{ speed: 12000 rpm, dip: 35 mm, nu: 27.3 mm2/s, rho: 826 kg/m3 }"),
            values: &[("h_eff", "15.62399 mm"), ("moment", "0.3257352 Nm")],
            tolerance: 1e-6,
            because: "the values have seven digits",
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL, SPEED], terms: [TERM], observed: [H_EFF], prepare: prepare);

#[cfg(test)]
mod tests {
    use gearloss_framework::sump::Lift;
    use gearloss_framework::testing::{assert_close, eval};

    /// Loss of the wheel of the rig with the oil 35 mm above the bottom of its case of 160 mm: 25 mm at the reference circle, 0.1618 of the case.
    fn loss(speed: f64, [radial, axial]: [f64; 2]) -> f64 {
        let input = format!(
            "{{ model: {{ type: shore, fill: 0.1618 }}, part: {{ gear: {{ z: 35, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 20 mm, \
             reference_diameter: 140 mm, working_diameter: 140 mm, tip_diameter: 148 mm, root_diameter: 130 mm, contact_height: 1 mm }}, \
             radial_clearance: {radial} mm, axial_clearance: {axial} mm }}, \
             at: {{ speed: {speed} rad/s, dip: 25 mm, nu: 10 mm2/s, rho: 830 kg/m3 }} }}"
        );
        eval("gear_drag/shore", &input).total
    }

    /// The faster the gear, the less of what full tooth spaces would carry can its churning power lift.
    #[test]
    fn full_tooth_spaces_break_the_bound_of_energy() {
        let gear = Lift {
            height: 0.0,
            slope: 1.0,
            orbit: 0.0,
            radii: [74e-3, 70e-3, 65e-3],
            width: 20e-3,
            teeth: 35.0,
        };
        for (rim, expected, unit) in [
            (7.4, 0.20, 0.01),
            (14.8, 0.057, 0.001),
            (29.6, 0.017, 0.001),
            (51.8, 0.0077, 0.0001),
            (92.5, 0.0036, 0.0001),
        ] {
            let speed = rim / 74e-3;
            let lifted = gear.lifted(loss(speed, [6.0, 30.0]), speed, 830.0);
            assert!(
                (lifted.flow / lifted.most - expected).abs() <= 0.5 * unit,
                "{rim} {lifted:?}"
            );
        }
    }

    /// Halving a gap: axial gaps matter more than radial ones.
    #[test]
    fn narrow_gaps_lower_the_torque() {
        let wide = loss(100.0, [6.0, 30.0]);
        assert_close(loss(100.0, [3.0, 30.0]) / wide, 0.946, 5e-4);
        assert_close(loss(100.0, [6.0, 15.0]) / wide, 0.790, 5e-4);
    }
}
