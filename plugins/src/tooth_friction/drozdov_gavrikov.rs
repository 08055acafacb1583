//! Friction between flanks according to Drozdov and Gavrikov.
//!
//! Source: Drozdov, Gavrikov: Friction and scoring under simultaneous rolling and sliding, Wear 11 (1968) 291-302, quoted from memory:
//! mu = 1/(0.8 nu^0.5 v_g + v_S phi + 13.4), phi = 0.47 - 0.13e-4 p - 0.4e-3 nu; nu in mm2/s, v_g and the sum velocity v_S in m/s, Hertz
//! pressure p in kgf/cm2. For v_g to 15, v_S from 3 to 20 m/s, nu from 4 to 500 mm2/s, p from 4000 to 20000 kgf/cm2.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{Along, ContactAt, PathAt, ToothFriction, ToothFrictionLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::observe_along;
use crate::checks::SIX_DIGITS;
use crate::powers::power;

const FROM: &str = "range of the tests, quoted from memory";
limits! {
    SLIDING = ("v_g", "sliding velocity", "m/s", 0.0, 15.0, FROM);
    SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 3.0, 20.0, FROM);
    VISCOSITY = ("nu", "kinematic viscosity of the oil", "mm2/s", 4.0, 500.0, FROM);
    PRESSURE = ("p", "Hertzian pressure", "kgf/cm2", 4000.0, 20000.0, FROM);
}
observed! { MU = ("mu", "-", "coefficient of friction"); }

/// One kgf/cm2. \[Pa\]
const KGF_CM2: f64 = 98_066.5;

coefficients! {
    /// Constants of the formula of Drozdov and Gavrikov, mu = 1/(0.8 nu^0.5 v_g + v_S phi + 13.4).
    struct Constants {
        /// Constant of phi.
        phi_constant = 0.47, in 0.235..=0.94;
        /// Decrease of phi per kgf/cm2 of pressure.
        phi_pressure = 0.13e-4, in 0.065e-4..=0.26e-4;
        /// Decrease of phi per mm2/s of viscosity.
        phi_viscosity = 0.4e-3, in 0.2e-3..=0.8e-3;
        /// Factor of the sliding velocity in m/s times the power of the viscosity in mm2/s.
        sliding_factor = 0.8, in 0.4..=1.6;
        /// Exponent of the viscosity in that term.
        viscosity_exponent = 0.5, in 0.25..=1.0;
        /// Inverse of the coefficient of friction at zero speed.
        constant = 13.4, in 6.7..=26.8;
    }
}

/// Friction between flanks according to Drozdov and Gavrikov.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct DrozdovGavrikov {
    #[serde(default)]
    coefficients: Constants,
}

impl DrozdovGavrikov {
    /// Friction in a contact from the power of the viscosity in mm2/s, with phi.
    #[inline(always)]
    fn friction<R: Real>(&self, at: &ContactAt<'_, R>, power_of_nu: R) -> Result<[R; 2], Undefined> {
        let c = &self.coefficients;
        let pressed = at.pressure / KGF_CM2 * c.phi_pressure;
        let phi = R::constant(c.phi_constant) - pressed - at.nu.mm2_s() * c.phi_viscosity;
        let inverse = power_of_nu * c.sliding_factor * at.sliding + at.sum_speed * phi + c.constant;
        if !inverse.is_above(R::ZERO).all() {
            return Err(Undefined {
                what: "inverse of the coefficient of friction",
                value: inverse.extremes(1).0,
            });
        }
        Ok([R::constant(1.0) / inverse, phi])
    }

    #[inline(always)]
    fn power_of<R: Real>(&self, nu: R) -> R {
        power(nu.mm2_s(), self.coefficients.viscosity_exponent)
    }
}

impl ToothFrictionLaw for DrozdovGavrikov {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        at.check(&VISCOSITY, at.nu.mm2_s());
        at.check(&PRESSURE, at.pressure / KGF_CM2);
        at.check(&SLIDING, at.sliding);
        at.check(&SUM_SPEED, at.sum_speed);
        let [mu, phi] = self.friction(at, self.power_of(at.nu))?;
        at.show("phi", "-", phi);
        Ok(at.observe(&MU, mu))
    }

    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let unit_pressure = path.unit_pressure() / KGF_CM2;
        path.notes.check(&VISCOSITY, path.nu.mm2_s());
        for end in 0..2 {
            path.notes.check(&PRESSURE, unit_pressure * path.extent.root_load[end]);
            path.notes.check(&SLIDING, path.speed * path.extent.sliding[end]);
            path.notes.check(&SUM_SPEED, path.speed * path.extent.sum_speed[end]);
        }
        let power_of_nu = self.power_of(path.nu);
        for (node, mu) in path.nodes.iter().zip(&mut *mu) {
            [*mu, _] = self.friction(&path.contact(node), power_of_nu)?;
            R::end_pass();
        }
        observe_along(path, &MU, mu.iter().copied());
        Ok(Along::default())
    }
}

register!(ToothFriction, "drozdov_gavrikov", DrozdovGavrikov,
    source: "Drozdov, Gavrikov, Wear 11 (1968) 291-302",
    example: "{ type: drozdov_gavrikov }",
    evidence: [formula(Evidence::Recalled, "formula quoted from memory, not checked; the magnitude is plausible")],
    checks: [
        Check {
            input: "{ at: { sliding: 2 m/s, sum_speed: 10 m/s, nu: 20 mm2/s, pressure: 0.980665 GPa } }",
            values: &[("total", "0.0418841")],
            ..SIX_DIGITS
        },
    ],
    limits: [SLIDING, SUM_SPEED, VISCOSITY, PRESSURE], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;

    #[test]
    fn far_above_the_tested_pressures_the_formula_is_undefined() {
        let beyond = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.pressure = 4e9;
            to.sum_speed = 200.0;
            to.sliding = 0.0;
            to.nu = 1e-3;
        });
        assert!(
            DrozdovGavrikov {
                coefficients: Constants::PUBLISHED
            }
            .mu(&beyond)
            .is_err()
        );
    }
}
