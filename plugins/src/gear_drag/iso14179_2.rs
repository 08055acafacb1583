//! Splash torque of an immersed gear stage according to ISO/TR 14179-2.
//!
//! Source: ISO/TR 14179-2:2001: T_H = C_Sp C_1 exp(C_2 v_t/10), C_1 = 0.063 (h_e1 + h_e2)/10 + 0.0128 (b/10)^3, C_2 = (h_e1 +
//! h_e2)/800 + 0.2, C_Sp = (4 h_max/(3 h_C))^1.5 2 h_C/l_h with l_h = 4 A_G/U_M; lengths in mm, v_t in m/s. One horizontal stage,
//! immersion depths of the tip circles at standstill (quoted from memory). The torque is independent of viscosity and does not
//! vanish with speed. It must be multiplied by the speed of one shaft of the pair; sources differ on which one, so `speed_of` has
//! no default. If the sump itself supplies the mesh (both gears immersed), C_Sp is one. Without immersion the b^3 term would
//! remain; the loss is then set to zero. Not for face widths far above 100 mm, where the b^3 term becomes unrealistic.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel, Scope};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::rise::{Rise, SWELL, churning};
use crate::checks::SIX_DIGITS;
use crate::powers::power;

terms! { SPLASH = no_load("splash"); }
limits! {
    after SWELL;
    PITCH_SPEED = ("v_t", "pitch line velocity", "m/s", 0.0, 60.0, "ISO/TR 14179-2");
    WIDTH = ("b", "face width", "mm", 0.0, 100.0, "above, the b^3 term is unrealistically large");
}
observed! { TORQUE = ("T_H", "Nm", "splash torque"); }

/// Gear whose speed multiplies the splash torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpeedOf {
    /// The gear with more teeth.
    Wheel,
    /// The gear with fewer teeth.
    Pinion,
}

coefficients! {
    /// Constants of the formula of ISO/TR 14179-2.
    struct Constants {
        /// Factor of the immersion depths over 10 mm in C_1.
        dip_factor = 0.063, in 0.0315..=0.126;
        /// Factor of the power of the face width over 10 mm in C_1.
        width_factor = 0.0128, in 0.0064..=0.0256;
        /// Exponent of the face width over 10 mm in C_1.
        width_exponent = 3.0, in 1.5..=3.5;
        /// Length in mm that divides the immersion depths in C_2.
        dip_length = 800.0, in 400.0..=1600.0;
        /// Constant of C_2, the exponent over v_t/(10 m/s).
        speed_constant = 0.2, in 0.1..=0.4;
        /// Exponent of 4 h_max/(3 h_C) in the splash factor C_Sp.
        splash_exponent = 1.5, in 0.75..=3.0;
    }
}

churning! {
    /// Splash torque of an immersed gear stage according to ISO/TR 14179-2.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Iso14179 {
        /// Gear whose speed multiplies the splash torque. Sources differ, and the loss differs by the gear ratio.
        pub speed_of: SpeedOf,
        #[serde(default)]
        coefficients: Constants,
    }
}

/// With the housing prepared.
struct Splash {
    rise: Rise,
    coefficients: Constants,
    /// Characteristic length of the gear case. \[mm\]
    l_h: f64,
    /// True if the speed of the first gear applies.
    first: bool,
}

fn prepare(params: Iso14179, cx: &mut Build<'_>) -> Result<Splash, Diagnostic> {
    let part = cx.own_part::<GearDrag>()?;
    let Some(mate) = &part.mate else {
        return Err(cx
            .error("iso14179_2 requires a gear pair")
            .help("add `mate:` to the part"));
    };
    let (Some(area), Some(perimeter)) = (part.section_area, part.section_perimeter) else {
        return Err(cx
            .error("iso14179_2 requires the cross-section of the housing")
            .help("add `housing: { section: { area: 420 cm2, perimeter: 85 cm } }` with your values"));
    };
    let pinion_first = part.gear.z <= mate.z;
    let (l_h, rise) = ((4.0 * area / perimeter).mm(), params.rise(cx)?);
    Ok(Splash {
        rise,
        coefficients: params.coefficients,
        l_h,
        first: (params.speed_of == SpeedOf::Pinion) == pinion_first,
    })
}

/// Splash torque, N m; immersion depths, face width, contact height and case length in mm, speed in m/s.
fn torque(c: &Constants, dips: f64, b: f64, v_t: f64, c_sp: f64) -> f64 {
    let c_1 = c.dip_factor * dips / 10.0 + c.width_factor * power(b / 10.0, c.width_exponent);
    let c_2 = dips / c.dip_length + c.speed_constant;
    c_sp * c_1 * (c_2 * v_t / 10.0).exp()
}

fn splash_factor(c: &Constants, deepest: f64, h_c: f64, l_h: f64) -> f64 {
    (4.0 * deepest / (3.0 * h_c)).powf(c.splash_exponent) * 2.0 * h_c / l_h
}

impl GearDragModel for Splash {
    fn covers(&self) -> Option<Covers> {
        Some(Covers {
            churning: true,
            ..Covers::default()
        })
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| self.alone(at))
    }
}

impl Splash {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let part = at.part;
        let (h_1, h_2) = (at.tip_dip.mm(), at.tip_dip_2.mm());
        let share = f64::from(u8::from(self.first));
        if h_1 + h_2 == 0.0 {
            at.branch("no gear immersed: no splash");
            return Ok(Loss::POWERS.felt_by_first(share));
        }
        at.show("h_e1", "mm", h_1);
        at.show("h_e2", "mm", h_2);
        let mate = part.mate.as_ref().unwrap_or(&part.gear);
        let b = at.check(&WIDTH, part.gear.facewidth.min(mate.facewidth).mm());
        let v_t = at.check(&PITCH_SPEED, at.speed.abs() * 0.5 * part.gear.working_diameter);
        let c_sp = if h_1 > 0.0 && h_2 > 0.0 {
            at.branch("both gears immersed: C_Sp is one");
            1.0
        } else {
            let (deepest, body) = if h_1 > h_2 { (h_1, &part.gear) } else { (h_2, mate) };
            let h_c = at.show("h_C", "mm", body.contact_height.mm());
            if h_c <= 0.0 {
                return Err(Undefined {
                    what: "height h_C of the mesh above the gear's lowest point [mm]",
                    value: h_c,
                });
            }
            splash_factor(&self.coefficients, deepest, h_c, at.show("l_h", "mm", self.l_h))
        };
        at.show("C_Sp", "-", c_sp);
        let torque = at.observe(&TORQUE, torque(&self.coefficients, h_1 + h_2, b, v_t, c_sp));
        let speed = if self.first { at.speed } else { at.speed_2 };
        Ok(Loss::POWERS
            .with(&SPLASH, at.show("P", "W", torque * speed.abs()))
            .felt_by_first(share))
    }
}

register!(GearDrag, "iso14179_2", Iso14179,
    source: "ISO/TR 14179-2:2001",
    example: "{ type: iso14179_2, speed_of: wheel }",
    evidence: [
        formula(Evidence::Disputed, "form published, constants quoted from memory; sources differ on the shaft"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    checks: [
        Check {
            input: "{ model: { type: iso14179_2, speed_of: pinion }, part: { gear: { z: 31, normal_module: 1.6 mm, \
                    pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 30 mm, reference_diameter: 55.7 mm, \
                    working_diameter: 56 mm, tip_diameter: 59.8 mm, root_diameter: 52.6 mm, contact_height: 30 mm }, mate: { z: 96, \
                    normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 30 mm, \
                    reference_diameter: 172.4 mm, working_diameter: 174 mm, tip_diameter: 176.3 mm, root_diameter: 169 mm, \
                    contact_height: 90 mm }, section_area: 100 cm2, section_perimeter: 20 cm }, at: { speed: 285.7142857 rad/s, \
                    tip_dip: 30 mm, tip_dip_2: 40 mm } }",
            values: &[("T_H", "0.990015 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: iso14179_2, speed_of: pinion }, part: { gear: { z: 31, normal_module: 1.6 mm, \
                    pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, reference_diameter: 55.7 mm, \
                    working_diameter: 56 mm, tip_diameter: 59.8 mm, root_diameter: 52.6 mm, contact_height: 30 mm }, mate: { z: 96, \
                    normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, facewidth: 17 mm, \
                    reference_diameter: 172.4 mm, working_diameter: 174 mm, tip_diameter: 176.3 mm, root_diameter: 169 mm, \
                    contact_height: 90 mm }, section_area: 100 cm2, section_perimeter: 20 cm }, at: { speed: 714.2857143 rad/s, \
                    tip_dip: 0 mm, tip_dip_2: 45 mm } }",
            values: &[("C_Sp", "0.489898"), ("T_H", "0.283297 Nm")],
            ..SIX_DIGITS
        },
    ],
    limits: [SWELL, PITCH_SPEED, WIDTH], terms: [SPLASH], observed: [TORQUE], scope: Scope::Mesh, prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::gear_drag::{DragPart, GearBody};
    use gearloss_framework::registry::{Files, Registry};
    use std::sync::Arc;

    fn pair() -> DragPart {
        let body = |z, diameter| GearBody {
            z,
            normal_module: 1.6e-3,
            pressure_angle: 0.3,
            helix_angle: 0.5,
            pitch_angle: 0.0,
            facewidth: 17e-3,
            reference_diameter: diameter,
            working_diameter: diameter,
            tip_diameter: diameter + 4e-3,
            root_diameter: diameter - 4e-3,
            contact_height: 90e-3,
        };
        DragPart {
            gear: body(31, 0.056),
            mate: Some(body(96, 0.174)),
            oil_volume: None,
            fill: None,
            section_area: Some(0.01),
            section_perimeter: Some(0.2),
            radial_clearance: None,
            axial_clearance: None,
        }
    }

    fn at(part: &DragPart, dips: [f64; 2]) -> GearDragAt<'_> {
        // Pitch line velocity 20 m/s.
        let speed = 20.0 / 0.028;
        let speed_2 = -speed * 31.0 / 96.0;
        GearDragAt::usual(part, Notes::MUTED).with(|to| {
            to.speed = speed;
            to.speed_2 = speed_2;
            to.tip_dip = dips[0];
            to.tip_dip_2 = dips[1];
        })
    }

    #[test]
    fn c2_power_is_felt_by_the_gear_whose_speed_counts() {
        let part = pair();
        let at = at(&part, [0.0, 0.045]);
        // A section of 0.01 m2 with a perimeter of 0.2 m has l_h = 200 mm.
        let l_h = (4.0 * 0.01_f64 / 0.2).mm();
        let pinion = Splash {
            rise: Rise::NONE,
            coefficients: Constants::PUBLISHED,
            l_h,
            first: true,
        }
        .loss(&at)
        .unwrap();
        let wheel = Splash {
            rise: Rise::NONE,
            coefficients: Constants::PUBLISHED,
            l_h,
            first: false,
        }
        .loss(&at)
        .unwrap();
        assert!((pinion.sum() / (0.283297 * at.speed) - 1.0).abs() < 1e-5);
        assert!((pinion.sum() / wheel.sum() - 96.0 / 31.0).abs() < 1e-12);
        assert_eq!((pinion.first_share(), wheel.first_share()), (1.0, 0.0));
    }

    #[test]
    fn dry_gears_and_gears_at_rest_lose_nothing() {
        let part = pair();
        let splash = Splash {
            rise: Rise::NONE,
            coefficients: Constants::PUBLISHED,
            l_h: 200.0,
            first: true,
        };
        assert_eq!(splash.loss(&at(&part, [0.0, 0.0])).unwrap().sum(), 0.0);
        let rest = at(&part, [0.0, 0.045]).with(|to| {
            to.speed = 0.0;
            to.speed_2 = 0.0;
        });
        assert_eq!(splash.loss(&rest).unwrap().sum(), 0.0);
    }

    #[test]
    fn the_section_of_the_case_is_asked_for() {
        let registry = Registry::linked().unwrap_or_else(|found| panic!("{found:?}"));
        let files = Files::default();
        let part = Arc::new(DragPart {
            section_perimeter: None,
            ..pair()
        });
        let value = serde_json::json!({ "type": "iso14179_2", "speed_of": "pinion" });
        let fault = Build::new(&registry, &files)
            .slot_at::<GearDrag>("gear_drag.churning", &part, &value)
            .err();
        assert!(fault.unwrap().to_string().contains("section"));
    }
}
