//! Conduction along a shaft, through a wall or another body of constant cross-section.
//!
//! Source: Fourier's law, R = l/(k A). One-dimensional: the heat enters and leaves over the whole cross-section.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_link::{HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::STEEL;

/// Conduction along a shaft, through a wall or another body of constant cross-section.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Length of the heat path. [mm]
    #[schemars(range(min = 0.001, max = 1e5))]
    pub length: f64,
    /// Cross-section area, unless `diameter` is given. [mm2]
    #[schemars(range(min = 0.001, max = 1e9))]
    pub area: Option<f64>,
    /// Diameter of a shaft. [mm]
    #[schemars(range(min = 0.01, max = 1e4))]
    pub diameter: Option<f64>,
    /// Bore of a shaft; default: it is solid. [mm]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub inner_diameter: Option<f64>,
    /// Thermal conductivity: 46 steel, 50 grey cast iron, 150 cast aluminium, 390 copper. [W/(m K)]
    #[serde(default = "steel")]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub conductivity: f64,
}

fn steel() -> f64 {
    STEEL
}

struct Conduction {
    conductance: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Conduction, Diagnostic> {
    let bore = params.inner_diameter.unwrap_or(0.0);
    let area = match (params.area, params.diameter) {
        (Some(area), None) if params.inner_diameter.is_none() => area,
        (None, Some(diameter)) if bore < diameter => 0.25 * PI * (diameter * diameter - bore * bore),
        (None, Some(_)) => {
            return Err(cx
                .error("the bore is not smaller than the shaft diameter")
                .help("reduce `inner_diameter` below `diameter`"));
        }
        (None, None) => {
            return Err(cx
                .error("the link requires a cross-section")
                .help("write `diameter: 40 mm` or `area: 500 mm2` with your value"));
        }
        (Some(_), _) => {
            return Err(cx
                .error("the cross-section is stated twice")
                .help("write `area`, or `diameter` with its `inner_diameter`"));
        }
    };
    Ok(Conduction {
        conductance: params.conductivity * area / params.length,
    })
}

impl HeatLinkModel for Conduction {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        Ok(at.show("k A/l", "W/K", self.conductance))
    }
}

register!(HeatLink, "conduction", Params,
    source: "Fourier's law",
    example: "{ type: conduction, length: 120 mm, diameter: 40 mm }",
    evidence: [
        formula(Evidence::SeveralSources, "textbooks agree"),
        default_of("conductivity", Evidence::SeveralSources, "hardened steel; 30 and more for alloyed steels"),
    ],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::cases::built;
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn shaft(area: Option<f64>, diameter: Option<f64>, inner_diameter: Option<f64>) -> Params {
        Params {
            length: 0.12,
            area,
            diameter,
            inner_diameter,
            conductivity: STEEL,
        }
    }

    #[test]
    fn u5d_shaft() {
        let solid = built(prepare, shaft(None, Some(0.040), None)).unwrap();
        close(1.0 / solid.conductance, 2.075934);
        let of_area = built(prepare, shaft(Some(PI * 4e-4), None, None)).unwrap();
        close(of_area.conductance, solid.conductance);
        // A bore of half the diameter removes a quarter of the section.
        let hollow = built(prepare, shaft(None, Some(0.040), Some(0.020))).unwrap();
        close(hollow.conductance, 0.75 * solid.conductance);
    }

    #[test]
    fn a_cross_section_is_stated_once_and_leaves_metal() {
        for (params, word) in [
            (shaft(None, None, None), "diameter: 40 mm"),
            (shaft(Some(1e-3), Some(0.04), None), "twice"),
            (shaft(Some(1e-3), None, Some(0.01)), "twice"),
            (shaft(None, Some(0.04), Some(0.04)), "bore"),
        ] {
            let error = built(prepare, params).err().unwrap();
            assert!(error.contains(word), "{error}");
        }
    }
}
