//! Churning of one gear by Reynolds number, the earlier law of the Lyon group.
//!
//! Source: Changenet, Velex: A model for the prediction of churning losses in geared transmissions, J. Mech. Des. 129 (2007)
//! 128-133: T = 1/2 rho w^2 R^3 S_m C_m with C_m = 1.366 (h/D)^0.45 (V/D^3)^0.1 Fr^-0.6 Re^-0.21 below Re = w R b/nu = 6000 and
//! 3.644 (h/D)^0.1 (V/D^3)^-0.35 Fr^-0.88 (b/D)^0.85 above 9000, linear in between. Immersion depth and volume are those at rest,
//! as set before the tests (quoted from memory). For narrow gears at low speed it is up to four times `changenet_2011`, because
//! only Re selects the regime.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::dipping::Dipping;
use super::rise::{Rise, SWELL, churning};
use super::{CHURNING, GRAVITY};
use crate::checks::SIX_DIGITS;

terms! { TERM = no_load("churning"); }
observed! {
    C_M = ("C_m", "-", "dimensionless churning torque");
    REYNOLDS = ("Re", "-", "Reynolds number");
}

coefficients! {
    /// Constants of the formula of Changenet and Velex 2007.
    struct Constants {
        /// Factor of C_m at low Reynolds numbers.
        slow_factor = 1.366, in 0.683..=2.732;
        /// Exponent of h/D at low Reynolds numbers.
        slow_dip_exponent = 0.45, in 0.225..=0.9;
        /// Exponent of V/D^3 at low Reynolds numbers.
        slow_volume_exponent = 0.1, in 0.05..=0.2;
        /// Exponent of the Froude number at low Reynolds numbers.
        slow_froude_exponent = -0.6, in -1.2..=-0.3;
        /// Exponent of the Reynolds number at low Reynolds numbers.
        slow_reynolds_exponent = -0.21, in -0.42..=-0.105;
        /// Factor of C_m at high Reynolds numbers.
        fast_factor = 3.644, in 1.822..=7.288;
        /// Exponent of h/D at high Reynolds numbers.
        fast_dip_exponent = 0.1, in 0.05..=0.2;
        /// Exponent of V/D^3 at high Reynolds numbers.
        fast_volume_exponent = -0.35, in -0.7..=-0.175;
        /// Exponent of the Froude number at high Reynolds numbers.
        fast_froude_exponent = -0.88, in -1.76..=-0.44;
        /// Exponent of b/D at high Reynolds numbers.
        fast_width_exponent = 0.85, in 0.425..=1.7;
        /// Reynolds number up to which the first form applies.
        slow_reynolds = 6000.0, in 3000.0..=7400.0;
        /// Reynolds number from which the second form applies; linear in between.
        fast_reynolds = 9000.0, in 7500.0..=18000.0;
    }
}

churning! {
    /// Churning of one gear by Reynolds number.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Params {
        #[serde(default)]
        coefficients: Constants,
    }
}

struct Changenet {
    coefficients: Constants,
    rise: Rise,
    volume: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Changenet, Diagnostic> {
    let part = cx.own_part::<GearDrag>()?;
    let Some(volume) = part.oil_volume else {
        return Err(cx
            .error("changenet_2007 requires the oil volume")
            .help("add `housing: { oil: { volume: 1.2 l } }` with your value, or `housing.inside`, from which the volume below the level follows"));
    };
    Ok(Changenet {
        rise: params.rise(cx)?,
        coefficients: params.coefficients,
        volume,
    })
}

/// Dimensionless torque from Reynolds and Froude number, h/D, V/D^3 and b/D.
fn c_m(c: &Constants, re: f64, fr: f64, h: f64, v: f64, b: f64) -> f64 {
    let slow = || {
        c.slow_factor
            * h.powf(c.slow_dip_exponent)
            * v.powf(c.slow_volume_exponent)
            * fr.powf(c.slow_froude_exponent)
            * re.powf(c.slow_reynolds_exponent)
    };
    let fast = || {
        c.fast_factor
            * h.powf(c.fast_dip_exponent)
            * v.powf(c.fast_volume_exponent)
            * fr.powf(c.fast_froude_exponent)
            * b.powf(c.fast_width_exponent)
    };
    if re <= c.slow_reynolds {
        slow()
    } else if re >= c.fast_reynolds {
        fast()
    } else {
        let t = (re - c.slow_reynolds) / (c.fast_reynolds - c.slow_reynolds);
        slow() * (1.0 - t) + fast() * t
    }
}

impl GearDragModel for Changenet {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| Ok(self.alone(at)))
    }
}

impl Changenet {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Loss {
        let Some(gear) = Dipping::of(at) else {
            return Loss::MOMENTS;
        };
        let (body, diameter) = (&at.part.gear, 2.0 * gear.radius);
        let re = at.observe(&REYNOLDS, gear.omega * gear.radius * body.facewidth / at.nu);
        let fr = at.show("Fr", "-", gear.omega * gear.omega * gear.radius / GRAVITY);
        at.branch(if re <= self.coefficients.slow_reynolds {
            "slow: Re up to its lower limit"
        } else if re >= self.coefficients.fast_reynolds {
            "fast: Re from its upper limit on"
        } else {
            "Re between its limits"
        });
        let c_m = c_m(
            &self.coefficients,
            re,
            fr,
            gear.dip / diameter,
            self.volume / diameter.powi(3),
            body.facewidth / diameter,
        );
        let torque = gear.torque(at.rho, at.observe(&C_M, c_m));
        Loss::MOMENTS.with(&TERM, at.show("T", "Nm", torque))
    }
}

register!(GearDrag, "changenet_2007", Params,
    source: "Changenet, Velex, J. Mech. Des. 129 (2007) 128-133",
    example: "{ type: changenet_2007 }",
    evidence: [
        formula(Evidence::OneSource, "one public transcription, which uses other limits of Re"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: "{ part: { gear: { z: 50, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 40 mm, reference_diameter: 200 mm, \
                    working_diameter: 200 mm, tip_diameter: 208 mm, root_diameter: 190 mm, contact_height: 1 mm }, oil_volume: 4 l }, \
                    at: { speed: 76.70717046 rad/s, dip: 50 mm, nu: 61.36573637 mm2/s } }",
            values: &[("Re", "5000"), ("Fr", "60"), ("C_m", "0.00978918")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 50, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 40 mm, reference_diameter: 200 mm, \
                    working_diameter: 200 mm, tip_diameter: 208 mm, root_diameter: 190 mm, contact_height: 1 mm }, oil_volume: 4 l }, \
                    at: { speed: 76.70717046 rad/s, dip: 50 mm, nu: 40.91049091 mm2/s } }",
            values: &[("Re", "7500"), ("Fr", "60"), ("C_m", "0.0185169")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ part: { gear: { z: 50, normal_module: 4 mm, pressure_angle: 20 deg, facewidth: 40 mm, reference_diameter: 200 mm, \
                    working_diameter: 200 mm, tip_diameter: 208 mm, root_diameter: 190 mm, contact_height: 1 mm }, oil_volume: 4 l }, \
                    at: { speed: 76.70717046 rad/s, dip: 50 mm, nu: 25.56905682 mm2/s } }",
            values: &[("Re", "12000"), ("Fr", "60"), ("C_m", "0.0280437")],
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL], terms: [TERM], observed: [C_M, REYNOLDS], prepare: prepare);
