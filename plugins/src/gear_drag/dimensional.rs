//! Churning of one gear with a user-defined dimensionless torque.
//!
//! The common form of the laws by dimensional analysis: T = 1/2 rho w^2 R^3 S_m C_m, with R the radius of the reference circle and S_m
//! the wetted surface of faces, rim and teeth. C_m is a formula of Re = w R b/nu, Fr = w^2 R/g, and the ratios h/D, V/D^3 and
//! b/D, named `re`, `fr`, `h`, `v` and `b`; depth h and volume V at rest.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::formula::Formula;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::dipping::Dipping;
use super::rise::{Rise, SWELL, churning};
use super::{CHURNING, GRAVITY};

terms! { TERM = no_load("churning"); }
observed! { C_M = ("C_m", "-", "dimensionless churning torque"); }

churning! {
    /// Churning of one gear with a user-defined dimensionless torque.
    #[derive(Debug, Deserialize, JsonSchema)]
    pub struct Params {
        /// Formula of the dimensionless torque in `re`, `fr`, `h`, `v`, `b`, such as `0.1 * fr^-0.6 * h^0.5`.
        pub c_m: String,
    }
}

struct Dimensional {
    rise: Rise,
    c_m: Formula,
    volume: Option<f64>,
}

const NAMES: [&str; 5] = ["re", "fr", "h", "b", "v"];

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Dimensional, Diagnostic> {
    let part = cx.own_part::<GearDrag>()?;
    let volume = part.oil_volume;
    // Without an oil volume the formula must not use it.
    let names = &NAMES[..if volume.is_some() { 5 } else { 4 }];
    let c_m = Formula::compile(&params.c_m, names).map_err(|fault| {
        let error = cx.error(format!("c_m, {fault}"));
        match fault.help {
            Some(help) => error.help(help),
            None => error.note(format!(
                "names: {}{}",
                names.join(", "),
                if volume.is_some() {
                    ""
                } else {
                    "; `v` needs `housing.oil.volume`"
                }
            )),
        }
    })?;
    let rise = params.rise(cx)?;
    Ok(Dimensional { rise, c_m, volume })
}

impl GearDragModel for Dimensional {
    fn covers(&self) -> Option<Covers> {
        Some(CHURNING)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        self.rise.applied(at, |at| self.alone(at))
    }
}

impl Dimensional {
    /// The law without swell.
    fn alone(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let Some(gear) = Dipping::of(at) else {
            return Ok(Loss::MOMENTS);
        };
        let (b, diameter) = (at.part.gear.facewidth, 2.0 * gear.radius);
        at.show("b", "mm", b.mm());
        let inputs = [
            at.show("re", "-", gear.omega * gear.radius * b / at.nu),
            at.show("fr", "-", gear.omega * gear.omega * gear.radius / GRAVITY),
            gear.dip / diameter,
            b / diameter,
            self.volume.unwrap_or(0.0) / diameter.powi(3),
        ];
        let c_m = self.c_m.value(|input| inputs[input])?;
        if c_m < 0.0 {
            return Err(Undefined {
                what: "dimensionless torque C_m, which is negative",
                value: c_m,
            });
        }
        let torque = gear.torque(at.rho, at.observe(&C_M, c_m));
        Ok(Loss::MOMENTS.with(&TERM, at.show("T", "Nm", torque)))
    }
}

register!(GearDrag, "dimensional", Params,
    source: "user-defined; the form of Changenet, Boness and others",
    example: "{ type: dimensional, c_m: \"0.1 * fr^-0.6 * h^0.5\" }",
    evidence: [
        formula(Evidence::User, "the user states it"),
        default_of("swell", Evidence::Assumed, "no public formula; `swell_max` is derived"),
    ],
    limits: [SWELL], terms: [TERM], observed: [C_M], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c7_torque_of_the_common_form() {
        let gear = Dipping {
            omega: 100.0,
            radius: 80e-3,
            dip: 0.04,
            surface: 0.02,
        };
        assert!((gear.torque(840.0, 0.02) / 0.86016 - 1.0).abs() < 1e-5);
    }
}
