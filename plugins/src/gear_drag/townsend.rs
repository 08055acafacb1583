//! Windage of a smooth rotor of the gear's size, after Townsend.
//!
//! Source: Townsend (ed.): Dudley's Gear Handbook, 2nd ed., 1991, recalled: P = n^3 D^5 L^0.7/1e17 in hp, n in 1/min, D and L in inches.
//! A rotor without teeth: it lies below the laws for gears.

use gearloss_framework::loss::{Loss, Term, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::gear_drag::{Covers, GearDrag, GearDragAt, GearDragModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Evidence, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WINDAGE;

const TERM: Term = Term::no_load(0, "windage");
/// One horsepower. \[W\]
const HP: f64 = 745.699_871_582;
/// One inch. \[m\]
const INCH: f64 = 25.4e-3;

/// Windage of a smooth rotor of the gear's size.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Townsend {}

/// Power from 1/min and inches. \[W\]
fn power(n: f64, d: f64, l: f64) -> f64 {
    n.powi(3) * d.powi(5) * l.powf(0.7) / 1e17 * HP
}

impl GearDragModel for Townsend {
    fn covers(&self) -> Option<Covers> {
        Some(WINDAGE)
    }

    fn loss(&self, at: &GearDragAt<'_>) -> Result<Loss, Undefined> {
        let gear = &at.part.gear;
        let power = power(at.speed.abs().rpm(), gear.tip_diameter / INCH, gear.facewidth / INCH);
        Ok(Loss::POWERS.with(&TERM, at.show("P", "W", power)))
    }
}

register!(GearDrag, "townsend", Townsend,
    source: "Townsend (ed.), Dudley's Gear Handbook, 1991",
    example: "{ type: townsend }",
    evidence: [formula(Evidence::Recalled, "below the laws for gears, as a smooth rotor is")],
    terms: [TERM]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c13_published_rotors() {
        for (value, printed) in [
            (power(10000.0, 10.0, 2.0), 1211.39),
            (power(6000.0, 12.0, 3.0), 864.787),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
    }
}
