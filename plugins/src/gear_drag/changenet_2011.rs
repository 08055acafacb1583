//! Churning of one gear by flow regimes.
//!
//! Source: Changenet, Leprince, Ville, Velex: A note on flow regimes and churning loss modeling, J. Mech. Des. 133 (2011)
//! 121009: T = 1/2 rho w^2 R^3 S_m C_m; C_m by Reynolds number w R b/nu (4000) and speed parameter w^2 (R b m_n)^(1/3)
//! (750 and 1250 m/s2, linear in between). Immersion depth at the reference circle and oil volume at rest, as set before the tests
//! (quoted from memory): the exponents of speed contain how the level fell in them. Wetted surface of faces, rim and teeth. Single
//! gear in a spacious case, automotive sizes (R 40 to 110 mm, module 1.5 to 5 mm, b 14 to 40 mm, to about 7000 rpm).
//! For a bevel gear the surface is that of a frustum with the radius and the immersion depth of its outer end. No test of bevel gears behind
//! it was readable (Laruelle and others 2017 have some): an extension of our own, uncertain by a factor of about two.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearBody, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::dipping::Dipping;
use super::rise::{Rise, SWELL, churning};
use super::{CHURNING, GRAVITY};
use crate::checks::SIX_DIGITS;

terms! { TERM = no_load("churning"); }
const RANGE: &str = "gears of the tests, quoted from memory";
limits! {
    after SWELL;
    RADIUS = ("R_p", "pitch radius", "mm", 40.0, 110.0, RANGE);
    MODULE = ("m_n", "normal module", "mm", 1.5, 5.0, RANGE);
    WIDTH = ("b", "face width", "mm", 14.0, 40.0, RANGE);
    SPEED = ("n", "speed of the gear", "1/min", 0.0, 7000.0, RANGE);
    CONE = ("delta", "pitch angle of a bevel gear", "deg", 0.0, 0.0,
        "tests with cylindrical gears; the surface of a bevel gear is that of its cone, and its torque uncertain by a factor of about two");
}
observed! {
    C_M = ("C_m", "-", "dimensionless churning torque");
    REYNOLDS = ("Re", "-", "Reynolds number");
}

coefficients! {
    /// Constants of the formula of Changenet and others 2011.
    struct Constants {
        /// Factor of C_m at a low speed parameter and a low Reynolds number.
        slow_viscous_factor = 1.366, in 0.683..=2.732;
        /// Factor of C_m at a low speed parameter and a high Reynolds number.
        slow_factor = 0.239, in 0.1195..=0.478;
        /// Exponent of h/D at a low speed parameter.
        slow_dip_exponent = 0.45, in 0.225..=0.9;
        /// Exponent of V/D^3 at a low speed parameter.
        slow_volume_exponent = 0.1, in 0.05..=0.2;
        /// Exponent of the Froude number at a low speed parameter.
        slow_froude_exponent = -0.6, in -1.2..=-0.3;
        /// Exponent of b/D at a low speed parameter.
        slow_width_exponent = 0.21, in 0.105..=0.42;
        /// Factor of C_m at a high speed parameter and a low Reynolds number.
        fast_viscous_factor = 20.797, in 10.3985..=41.594;
        /// Factor of C_m at a high speed parameter and a high Reynolds number.
        fast_factor = 3.644, in 1.822..=7.288;
        /// Exponent of h/D at a high speed parameter.
        fast_dip_exponent = 0.1, in 0.05..=0.2;
        /// Exponent of V/D^3 at a high speed parameter.
        fast_volume_exponent = -0.35, in -0.7..=-0.175;
        /// Exponent of the Froude number at a high speed parameter.
        fast_froude_exponent = -0.88, in -1.76..=-0.44;
        /// Exponent of b/D at a high speed parameter.
        fast_width_exponent = 0.85, in 0.425..=1.7;
        /// Exponent of the Reynolds number in the viscous regime.
        reynolds_exponent = -0.21, in -0.42..=-0.105;
        /// Reynolds number below which the flow is viscous.
        viscous_reynolds = 4000.0, in 2000.0..=8000.0;
        /// Speed parameter in m/s2 up to which the slow regime applies.
        slow_speed_parameter = 750.0, in 375.0..=900.0;
        /// Speed parameter in m/s2 from which the fast regime applies; linear in between.
        fast_speed_parameter = 1250.0, in 1000.0..=2500.0;
    }
}

churning! {
    /// Churning of one gear by flow regimes.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Changenet {
        #[serde(default)]
        coefficients: Constants,
    }
}

/// One gear in its oil.
struct Churning {
    coefficients: Constants,
    rise: Rise,
    size: Size,
}

/// Powers of V/D^3 and b/D of a gear in C_m, which no operating point changes.
struct Size {
    slow: [f64; 2],
    fast: [f64; 2],
}

impl Size {
    fn new(c: &Constants, v: f64, b: f64) -> Self {
        Self {
            slow: [v.powf(c.slow_volume_exponent), b.powf(c.slow_width_exponent)],
            fast: [v.powf(c.fast_volume_exponent), b.powf(c.fast_width_exponent)],
        }
    }
}

fn prepare(params: Changenet, cx: &mut Build<'_>) -> Result<Churning, Diagnostic> {
    let part = cx.own_part::<GearDrag>()?;
    let Some(volume) = part.oil_volume else {
        return Err(cx
            .error("changenet_2011 requires the oil volume")
            .help("add `housing: { oil: { volume: 1.2 l } }` with your value, or `housing.inside`, from which the volume below the level follows"));
    };
    let rise = params.rise(cx)?;
    let part = cx.own_part::<GearDrag>()?;
    Ok(Churning::new(params.coefficients, rise, &part.gear, volume))
}

/// Dimensionless torque from the size of the gear, Reynolds number, speed parameter, Froude number and h/D.
fn c_m(c: &Constants, size: &Size, re: f64, gamma: f64, fr: f64, h: f64) -> f64 {
    let viscous = re < c.viscous_reynolds;
    let front = |viscous_factor: f64, factor: f64| {
        if viscous {
            viscous_factor * re.powf(c.reynolds_exponent)
        } else {
            factor
        }
    };
    let slow = || {
        front(c.slow_viscous_factor, c.slow_factor)
            * h.powf(c.slow_dip_exponent)
            * size.slow[0]
            * fr.powf(c.slow_froude_exponent)
            * size.slow[1]
    };
    let fast = || {
        front(c.fast_viscous_factor, c.fast_factor)
            * h.powf(c.fast_dip_exponent)
            * size.fast[0]
            * fr.powf(c.fast_froude_exponent)
            * size.fast[1]
    };
    if gamma <= c.slow_speed_parameter {
        slow()
    } else if gamma >= c.fast_speed_parameter {
        fast()
    } else {
        let t = (gamma - c.slow_speed_parameter) / (c.fast_speed_parameter - c.slow_speed_parameter);
        slow() * (1.0 - t) + fast() * t
    }
}

impl Churning {
    /// For a gear in a volume of oil. \[m3\]
    fn new(coefficients: Constants, rise: Rise, gear: &GearBody, volume: f64) -> Self {
        let diameter = gear.reference_diameter;
        let size = Size::new(&coefficients, volume / diameter.powi(3), gear.facewidth / diameter);
        Self {
            coefficients,
            rise,
            size,
        }
    }
}

impl GearDragModel for Churning {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn describes_bevel(&self) -> bool {
        true
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| Ok(self.alone(at)))
    }
}

impl Churning {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Loss {
        let Some(dipping) = Dipping::of(at) else {
            return Loss::MOMENTS;
        };
        let gear = &at.part.gear;
        let Dipping { omega, radius, dip, .. } = dipping;
        let (diameter, b) = (gear.reference_diameter, gear.facewidth);
        if gear.pitch_angle != 0.0 {
            at.branch("bevel gear: surface of its cone, radius and immersion depth of its outer end");
            at.check(&CONE, gear.pitch_angle.to_degrees());
        }
        at.check(&RADIUS, radius.mm());
        at.check(&MODULE, gear.normal_module.mm());
        at.check(&WIDTH, b.mm());
        at.check(&SPEED, omega.rpm());
        let re = at.observe(&REYNOLDS, omega * radius * b / at.nu);
        let fr = at.show("Fr", "-", omega * omega * radius / GRAVITY);
        let gamma = at.show(
            "gamma",
            "m/s2",
            omega * omega * (radius * b * gear.normal_module).cbrt(),
        );
        at.branch(if re < self.coefficients.viscous_reynolds {
            "viscous: Re below its limit"
        } else {
            "inertial: Re at its limit or above"
        });
        at.branch(if gamma <= self.coefficients.slow_speed_parameter {
            "slow: gamma up to its lower limit"
        } else if gamma >= self.coefficients.fast_speed_parameter {
            "fast: gamma from its upper limit on"
        } else {
            "gamma between its limits"
        });
        let c_m = at.observe(&C_M, c_m(&self.coefficients, &self.size, re, gamma, fr, dip / diameter));
        let torque = dipping.torque(at.rho, c_m);
        Loss::MOMENTS.with(&TERM, at.show("T", "Nm", torque))
    }
}

register!(GearDrag, "changenet_2011", Changenet,
    source: "Changenet, Leprince, Ville, Velex, J. Mech. Des. 133 (2011) 121009",
    example: "{ type: changenet_2011 }",
    evidence: [
        formula(Evidence::OneSource, "one public transcription; both branches meet at Re 4000, which confirms it"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: "{ model: { type: changenet_2011, swell: 0.3 }, part: { gear: { z: 96, normal_module: 1.6 mm, \
                    pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, reference_diameter: 172.3893101 mm, \
                    working_diameter: 172.3893101 mm, tip_diameter: 176.251 mm, root_diameter: 169 mm, contact_height: 90 mm }, \
                    oil_volume: 1.3 l }, at: { speed: 1500 rpm, dip: 45 mm, nu: 6.4 mm2/s, rho: 842 kg/m3, towards_mesh: 0 } }",
            values: &[("moment", "0.324885 Nm"), ("total", "51.0328 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL, RADIUS, MODULE, WIDTH, SPEED, CONE], terms: [TERM], observed: [C_M, REYNOLDS], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::gear_drag::DragPart;
    use gearloss_framework::registry::{Files, Registry};
    use std::sync::Arc;

    #[test]
    fn c9_dimensionless_torque_in_all_regimes() {
        for (re, gamma, printed) in [
            (3000.0, 500.0, 0.00777232),
            (6000.0, 500.0, 0.00730623),
            (3000.0, 2000.0, 0.0297894),
            (6000.0, 2000.0, 0.0280437),
            (6000.0, 1000.0, 0.017675),
        ] {
            let size = Size::new(&Constants::PUBLISHED, 0.5, 0.2);
            let value = c_m(&Constants::PUBLISHED, &size, re, gamma, 60.0, 0.25);
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }

    fn wheel() -> DragPart {
        let diameter = 1.6e-3 / 27.0_f64.to_radians().cos() * 96.0;
        let gear = GearBody {
            z: 96,
            normal_module: 1.6e-3,
            pressure_angle: 17.5_f64.to_radians(),
            helix_angle: 27.0_f64.to_radians(),
            pitch_angle: 0.0,
            facewidth: 17e-3,
            reference_diameter: diameter,
            working_diameter: diameter,
            tip_diameter: 176.251e-3,
            root_diameter: 169e-3,
            contact_height: 0.09,
        };
        DragPart {
            gear,
            mate: None,
            oil_volume: Some(1.3e-3),
            fill: None,
            section_area: None,
            section_perimeter: None,
            radial_clearance: None,
            axial_clearance: None,
        }
    }

    #[test]
    fn swell_multiplies_and_rest_or_a_dry_gear_loses_nothing() {
        let part = wheel();
        let speed = 1500.0 * std::f64::consts::PI / 30.0;
        let at = GearDragAt::usual(&part, Notes::MUTED).with(|to| {
            to.speed = speed;
            to.dip = 0.045;
            to.nu = 6.4e-6;
            to.rho = 842.0;
            to.towards_mesh = 0.0;
        });
        let model = Churning::new(Constants::PUBLISHED, Rise::swelling(0.3), &part.gear, 1.3e-3);
        let moment = model.loss(&at).unwrap().total_moment(speed);
        let swollen = model
            .loss(&at.with(|to| to.towards_mesh = 1.0))
            .unwrap()
            .total_moment(speed);
        assert!((swollen / moment - 1.3).abs() < 1e-12);
        for still in [at.with(|to| to.speed = 0.0), at.with(|to| to.dip = 0.0)] {
            assert_eq!(model.loss(&still).unwrap().sum(), 0.0);
        }
    }

    #[test]
    fn deeper_than_covered_changes_nothing() {
        let part = wheel();
        let model = Churning::new(Constants::PUBLISHED, Rise::NONE, &part.gear, 1.3e-3);
        let at = |dip| {
            GearDragAt::usual(&part, Notes::MUTED).with(|to| {
                to.speed = 150.0;
                to.dip = dip;
                to.nu = 6.4e-6;
                to.rho = 842.0;
            })
        };
        let covered = model.loss(&at(part.gear.reference_diameter)).unwrap().sum();
        assert_eq!(model.loss(&at(1.0)).unwrap().sum(), covered);
        assert!(model.loss(&at(0.1)).unwrap().sum() < covered);
    }

    #[test]
    fn the_volume_of_the_oil_is_asked_for() {
        let registry = Registry::linked().unwrap_or_else(|found| panic!("{found:?}"));
        let files = Files::default();
        let part = Arc::new(DragPart {
            oil_volume: None,
            fill: None,
            ..wheel()
        });
        let value = serde_json::json!({ "type": "changenet_2011", "swell": 0.0 });
        let fault = Build::new(&registry, &files)
            .slot_at::<GearDrag>("gear_drag.churning", &part, &value)
            .err();
        assert!(fault.unwrap().to_string().contains("oil volume"));
    }
}
