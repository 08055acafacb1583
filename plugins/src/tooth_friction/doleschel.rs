//! Power law of boundary or fluid friction according to Doleschel.
//!
//! Source: Doleschel 2002 (FVA 345), quoted from memory: mu = mu_R (p_H/1000 N/mm2)^a (v_S/v_R)^b (eta/20 mPa s)^c with v_R = 8.3 m/s for fluid and
//! 0.2 m/s for boundary friction, which is independent of viscosity. Coefficient and exponents are properties of the oil from its
//! FVA 345 test; no values of standard oils are public, so there are no defaults. Intended for the two slots of `mixed`.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{ContactAt, FrictionLimits, ToothFriction, ToothFrictionLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{entraining, finite};

limits! {
    SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.2, 15.3,
        "FVA 345 tests FZG C gears up to 20 m/s, and boundary friction at 0.2 m/s; quoted from memory");
}
observed! { MU = ("mu", "-", "coefficient of friction"); }

/// Power law of boundary or fluid friction according to Doleschel, with test constants of an oil.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Doleschel {
    /// Coefficient of friction at the reference. [-]
    #[schemars(range(min = 0.0001, max = 0.5))]
    pub mu: f64,
    /// Exponent of the Hertz pressure over 1 GPa. [-]
    #[schemars(range(min = -3.0, max = 3.0))]
    pub pressure: f64,
    /// Exponent of the sum velocity over the reference speed. [-]
    #[schemars(range(min = -3.0, max = 3.0))]
    pub speed: f64,
    /// Exponent of the dynamic viscosity over 20 mPa s; zero for boundary friction. [-]
    #[serde(default)]
    #[schemars(range(min = -3.0, max = 3.0))]
    pub viscosity: f64,
    /// Reference speed: 8.3 m/s for fluid, 0.2 m/s for boundary friction. [m/s]
    #[serde(default = "fluid")]
    #[schemars(range(min = 0.001, max = 100.0))]
    pub reference_speed: f64,
    /// Maximum coefficient of friction; limits a falling power of speed at creeping speeds. [-]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub greatest: f64,
}

fn fluid() -> f64 {
    8.3
}

/// The largest reference coefficient: a measured reference value is never cut off.
fn greatest() -> f64 {
    0.5
}

impl ToothFrictionLaw for Doleschel {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let unloaded = at.pressure.is_zero();
        if unloaded.all() {
            at.branch("no load: no friction");
            return Ok(at.observe(&MU, R::ZERO));
        }
        let sum_speed = entraining(at.sum_speed)?;
        let powers = at.pressure.gpa().ln() * self.pressure
            + (sum_speed / self.reference_speed).ln() * self.speed
            + (at.eta.mpa_s() / 20.0).ln() * self.viscosity;
        let mu = R::select(unloaded, R::ZERO, powers.exp() * self.mu);
        at.notes.among(!unloaded).check(&SUM_SPEED, sum_speed);
        at.observe(&MU, finite(self.cut_off(mu))?);
        Ok(mu)
    }

    fn friction_limits(&self) -> Option<FrictionLimits> {
        Some(FrictionLimits::up_to(self.greatest))
    }
}

register!(ToothFriction, "doleschel", Doleschel,
    source: "Doleschel 2002; FVA 345",
    example: "{ type: doleschel, mu: 0.02, pressure: 0.5, speed: -0.1, viscosity: -0.05 }",
    evidence: [
        formula(Evidence::Recalled, "formula quoted from memory, not checked"),
        default_of("viscosity", Evidence::Recalled, "boundary friction is independent of viscosity"),
        default_of("reference_speed", Evidence::Recalled, "reference of fluid friction"),
        default_of("greatest", Evidence::Assumed, "the largest coefficient that the law accepts at its reference"),
    ],
    limits: [SUM_SPEED], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    #[test]
    fn a_contact_at_rest_is_named_as_such() {
        let law = Doleschel {
            mu: 0.02,
            pressure: 0.5,
            speed: -0.1,
            viscosity: -0.05,
            reference_speed: 8.3,
            greatest: greatest(),
        };
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| to.sum_speed = 0.0);
        let fault = law.mu(&at).unwrap_err();
        assert!(fault.what.starts_with("sum of the surface speeds"), "{fault}");
        // An unloaded contact is not a power of zero either.
        let creeping = at.with(|to| to.sum_speed = 1e-300);
        assert_eq!(law.cut_off(law.mu(&creeping).unwrap()), 0.5);
        let rising = Doleschel { pressure: -0.5, ..law };
        assert_eq!(
            rising
                .mu(&at.with(|to| (to.pressure, to.sum_speed) = (0.0, 5.0)))
                .unwrap(),
            0.0
        );
    }
}
