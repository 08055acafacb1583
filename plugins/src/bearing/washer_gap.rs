//! Thrust washers and thrust pads: shear of the oil in a gap of stated thickness.
//!
//! Source: derived from laminar shear flow between plane rings: T = phi pi/32 eta w (D^4 - d^4)/h with the share phi of the ring that pads cover;
//! a washer that floats between two faces has the sum of both gaps. The thickness is stated, because plane parallel faces carry no load by
//! hydrodynamics: what carries them (wedges, waviness, contact) is not modelled. With `solid_friction` mu the axial load is carried by faces that
//! touch: T = mu Fa (D^3 - d^3)/(3 (D^2 - d^2)), for an even pressure; it is added to the shear of the gap.
//! Not for turbulent gaps or gaps that are not filled with oil.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, BearingLaw};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use gearloss_framework::{limits, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::checks::BY_HAND;

terms! {
    SHEAR = no_load("shear");
    CONTACT = load("contact");
}
limits! { REYNOLDS = ("Re", "Reynolds number of the gap", "-", 0.0, 1000.0, "laminar gap flow"); }

/// Thrust washers: oil shear in a gap of stated thickness.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct WasherGap {}

struct Washer {
    /// Torque per viscosity and speed. \[m3\]
    shear: f64,
    /// Torque of touching faces per axial load. \[m\]
    contact: f64,
    radius: f64,
    gap: f64,
}

fn prepare(_params: WasherGap, cx: &mut Build<'_>) -> Result<Washer, Diagnostic> {
    let part = cx.own_part::<Bearing>()?;
    let (BearingKind::ThrustWasher, Some(film)) = (part.kind, part.film) else {
        return Err(cx
            .error("washer_gap applies to thrust washers only")
            .help("write `kind: thrust_washer` and `film:` in the bearing, or give it another model"));
    };
    let gap = film
        .gap
        .ok_or_else(|| cx.error("washer_gap requires `film.gap`").help("add it to the bearing"))?;
    let (d, big_d) = (part.bore, part.outside);
    Ok(Washer {
        shear: film.pad_share.unwrap_or(1.0) * PI / 32.0 * (big_d.powi(4) - d.powi(4)) / gap,
        contact: film.solid_friction.unwrap_or(0.0) * (big_d.powi(3) - d.powi(3)) / (3.0 * (big_d.powi(2) - d.powi(2))),
        radius: 0.5 * big_d,
        gap,
    })
}

impl BearingLaw for Washer {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let speed = at.speed.abs();
        at.check(&REYNOLDS, speed / at.nu * (self.radius * self.gap));
        at.show("Fa", "N", at.axial);
        let eta = at.show("eta", "Pa s", at.nu * at.rho);
        Ok(Loss::MOMENTS
            .with(&SHEAR, at.show("T_shear", "Nm", eta * speed * self.shear))
            .with(&CONTACT, at.show("T_contact", "Nm", at.axial * self.contact)))
    }
}

register!(Bearing, "washer_gap", WasherGap,
    source: "derived: laminar shear flow between plane rings",
    example: "{ type: washer_gap }",
    part: "{ kind: thrust_washer, bore: 20 mm, outside: 32 mm, film: { gap: 100 um, solid_friction: 0.05 } }",
    evidence: [formula(Evidence::Derived, "shear flow; the user states the gap and the friction of touching faces")],
    checks: [
        Check {
            input: "{ part: { kind: thrust_washer, bore: 20 mm, outside: 32 mm, film: { gap: 100 um } }, at: { speed: 3000 rpm, nu: 10 mm2/s, \
                    rho: 820 kg/m3, axial: 300 N } }",
            values: &[("Re", "50.2655"), ("T_shear", "0.00224729 Nm"), ("moment", "0.00224729 Nm")],
            ..BY_HAND
        },
        Check {
            input: "{ part: { kind: thrust_washer, bore: 20 mm, outside: 32 mm, film: { gap: 100 um, solid_friction: 0.05, pad_share: 0.5 } }, \
                    at: { speed: 3000 rpm, nu: 10 mm2/s, rho: 820 kg/m3, axial: 300 N } }",
            values: &[("T_shear", "0.00112364 Nm"), ("T_contact", "0.198462 Nm")],
            ..BY_HAND
        },
    ],
    limits: [REYNOLDS], terms: [SHEAR, CONTACT], prepare: prepare);

#[cfg(test)]
mod tests {
    use gearloss_framework::testing::{assert_close, eval};

    /// A wide ring is a disc, a narrow one a band at its radius.
    #[test]
    fn discs_and_narrow_rings() {
        let moments = |bore: f64| {
            let part = format!(
                "{{ kind: thrust_washer, bore: {bore} mm, outside: 40 mm, film: {{ gap: 100 um, solid_friction: 0.1 }} }}"
            );
            let at = "{ speed: 1000 rpm, nu: 10 mm2/s, rho: 800 kg/m3, axial: 1 kN }";
            let loss = eval("bearing/washer_gap", &format!("{{ part: {part}, at: {at} }}"));
            ["T_shear", "T_contact"].map(|step| loss.step(step).expect("a step"))
        };
        let [disc, narrow] = [moments(0.5), moments(39.99)];
        let w = std::f64::consts::PI * 1000.0 / 30.0;
        assert_close(
            disc[0],
            0.5 * std::f64::consts::PI * 0.008 * w * 0.02_f64.powi(4) / 1e-4,
            1e-6,
        );
        assert_close(disc[1], 0.1 * 1000.0 * 0.02 * 2.0 / 3.0, 1e-3);
        assert_close(
            narrow[0],
            0.008 * w * 0.02_f64.powi(3) / 1e-4 * 2.0 * std::f64::consts::PI * 5e-6,
            1e-3,
        );
        assert_close(narrow[1], 0.1 * 1000.0 * 0.02, 1e-3);
    }
}
