//! Friction of a stepped shaft that rotates in open air or mist.
//!
//! Sources: cylinder, turbulent: Theodorsen, Regier, NACA Report 793 (1944), 1/sqrt(C_f) = -0.6 + 4.07 lg(Re sqrt(C_f)), M = C_f pi rho w^2 R^4 L, Re = rho w
//! R^2/mu; laminar, exact: C_f = 4/Re; the larger one holds. Shoulders are free discs from the smaller to the larger radius. The air has
//! the temperature of the oil of the component and one atmosphere.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::auxiliary::{Auxiliary, AuxiliaryAt, AuxiliaryModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{limits, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use super::rotor::{Medium, MixtureViscosity, free_disc};
use crate::checks::SIX_DIGITS;

terms! {
    CYLINDERS = no_load("cylinders");
    SHOULDERS = no_load("shoulders");
}
limits! { SPEED = ("R w", "surface speed of the shaft", "m/s", 0.0, 100.0, "incompressible flow, Mach number below 0.3"); }

/// A section of the shaft with constant diameter.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Section {
    /// Diameter. [mm]
    #[schemars(range(min = 1.0, max = 1e4))]
    pub diameter: f64,
    /// Length. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub length: f64,
}

/// A stepped shaft in open air or mist.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct ShaftWindage {
    /// Sections in their order along the shaft; the steps between them are shoulders.
    #[schemars(length(min = 1))]
    pub sections: Vec<Section>,
    /// Volume fraction of oil in the air. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub oil_fraction: f64,
    /// Viscosity of the mixture.
    #[serde(default)]
    pub mixture_viscosity: MixtureViscosity,
}

fn prepare(params: ShaftWindage, cx: &mut Build<'_>) -> Result<ShaftWindage, Diagnostic> {
    if params.sections.is_empty() {
        return Err(cx
            .error("shaft_windage requires a section")
            .help("write `sections: [{ diameter: 40 mm, length: 250 mm }]`"));
    }
    Ok(params)
}

/// The friction coefficient of a cylinder.
fn cylinder(re: f64) -> f64 {
    // With y = 1/sqrt(C_f): y + b ln(y) = b ln(Re) - 0.6, which Newton's method solves from any y above its root.
    let b = 4.07 / std::f64::consts::LN_10;
    let right = b * re.ln() - 0.6;
    let mut y = right.max(1.0);
    for _ in 0..8 {
        y -= (y + b * y.ln() - right) / (1.0 + b / y);
    }
    let laminar = 4.0 / re;
    // Below this Reynolds number the flow is laminar, and the law of turbulent flow has no root.
    if re < 80.0 { laminar } else { laminar.max(1.0 / (y * y)) }
}

impl AuxiliaryModel for ShaftWindage {
    fn loss(&self, at: &AuxiliaryAt<'_>) -> Result<Loss, Undefined> {
        let speed = at.speed.abs();
        if speed == 0.0 {
            at.branch("at standstill: no torque");
            return Ok(Loss::MOMENTS);
        }
        let oil = Medium {
            rho: at.rho,
            mu: at.eta,
        };
        let Medium { rho, mu } = Medium::new(at.temperature, oil, self.oil_fraction, self.mixture_viscosity);
        let (pressure, reynolds) = (rho * speed * speed, |radius: f64| rho * speed * radius * radius / mu);
        let radii = self.sections.iter().map(|section| 0.5 * section.diameter);
        at.check(&SPEED, speed * radii.clone().fold(0.0, f64::max));
        let cylinders: f64 = self
            .sections
            .iter()
            .zip(radii.clone())
            .map(|(section, radius)| cylinder(reynolds(radius)) * PI * pressure * radius.powi(4) * section.length)
            .sum();
        let shoulders: f64 = radii
            .clone()
            .zip(radii.skip(1))
            .map(|(a, b)| {
                let outer = a.max(b);
                // One of the two faces of a disc.
                0.25 * free_disc(reynolds(outer)) * pressure * (outer.powi(5) - a.min(b).powi(5))
            })
            .sum();
        Ok(Loss::MOMENTS.with(&CYLINDERS, cylinders).with(&SHOULDERS, shoulders))
    }
}

register!(Auxiliary, "shaft_windage", ShaftWindage,
    source: "Theodorsen, Regier, NACA Report 793 (1944)",
    example: "{ type: shaft_windage, sections: [{ diameter: 40 mm, length: 250 mm }] }",
    evidence: [
        formula(Evidence::OneSource, "the coefficient agrees with a published value at Re = 1.15e5; laminar flow is exact"),
        default_of("oil_fraction", Evidence::Assumed, "dry air"),
        default_of("mixture_viscosity", Evidence::Disputed, "between the two other rules, whose losses differ by two to three times"),
    ],
    checks: [
        Check {
            input: "{ model: { type: shaft_windage, sections: [{ diameter: 40 mm, length: 250 mm }] }, \
                    at: { speed: 12000 rpm, temperature: 80 degC, eta: 8 mPa s, rho: 820 } }",
            values: &[("cylinders", "1.536835 W")],
            ..SIX_DIGITS
        },
    ],
    limits: [SPEED], terms: [CYLINDERS, SHOULDERS], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_coefficient_and_the_change_from_laminar_flow() {
        assert!(
            (cylinder(1.15e5) / 0.004_334_93 - 1.0).abs() < 1e-5,
            "{}",
            cylinder(1.15e5)
        );
        assert_eq!(cylinder(81.0), 4.0 / 81.0);
        assert!(cylinder(82.0) > 4.0 / 82.0);
    }
}
