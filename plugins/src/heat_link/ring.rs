//! Radial conduction through rings.
//!
//! Source: Fourier's law in a ring, R = ln(r_o/r_i)/(2 pi k B). For bearing rings, bushes and press fits; both faces are adiabatic.
//! The contact resistance of the joint between two rings is not included.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::STEEL;

/// Radial conduction through rings.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Inner diameter. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub inner_diameter: f64,
    /// Outer diameter. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub outer_diameter: f64,
    /// Width. [mm]
    #[schemars(range(min = 0.1, max = 1e4))]
    pub width: f64,
    /// Thermal conductivity. [W/(m K)]
    #[serde(default = "steel")]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub conductivity: f64,
    /// Number of such rings in parallel. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: u32,
}

fn steel() -> f64 {
    STEEL
}

fn default_one() -> u32 {
    1
}

struct Ring {
    conductance: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ring, Diagnostic> {
    if params.outer_diameter <= params.inner_diameter {
        return Err(cx
            .error("the ring has no thickness")
            .help("increase `outer_diameter` above `inner_diameter`"));
    }
    let around = 2.0 * PI * params.conductivity * params.width;
    Ok(Ring {
        conductance: f64::from(params.count) * around / (params.outer_diameter / params.inner_diameter).ln(),
    })
}

impl HeatLinkModel for Ring {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        Ok(at.show("2 pi k B/ln(r_o/r_i)", "W/K", self.conductance))
    }
}

register!(HeatLink, "ring", Params,
    source: "Fourier's law in a ring",
    example: "{ type: ring, inner_diameter: 65 mm, outer_diameter: 90 mm, width: 23 mm }",
    evidence: [
        formula(Evidence::SeveralSources, "textbooks agree"),
        default_of("conductivity", Evidence::SeveralSources, "hardened steel"),
        default_of("count", Evidence::User, "one ring"),
    ],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::cases::built;
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn ring(inner: f64, outer: f64, count: u32) -> Params {
        Params {
            inner_diameter: inner,
            outer_diameter: outer,
            width: 0.023,
            conductivity: STEEL,
            count,
        }
    }

    #[test]
    fn u5d_ring() {
        let one = built(prepare, ring(0.065, 0.090, 1)).unwrap().conductance;
        close(1.0 / one, 0.04895329);
        close(built(prepare, ring(0.065, 0.090, 2)).unwrap().conductance, 2.0 * one);
    }

    #[test]
    fn a_thin_ring_is_a_wall() {
        let thin = built(prepare, ring(0.0999, 0.1001, 1)).unwrap().conductance;
        close(thin, STEEL * PI * 0.1 * 0.023 / 1e-4);
        assert!(built(prepare, ring(0.09, 0.09, 1)).err().unwrap().contains("thickness"));
    }
}
