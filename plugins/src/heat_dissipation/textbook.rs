//! Textbook free and forced convection with radiation.
//!
//! Source: free convection at a vertical wall according to Churchill and Chu 1975, Nu = (0.825 + 0.387 Ra^(1/6)/(1 + (0.492/Pr)^(9/16))^(8/27))^2; forced
//! convection along a plate, laminar Nu = 0.664 Re^0.5 Pr^(1/3), above Re = 5e5 with a laminar leading part Nu = (0.037 Re^0.8 -
//! 871) Pr^(1/3), which joins the laminar law continuously; combined (alpha_f^3 + alpha_n^3)^(1/3); radiation eps sigma (T_w^2 +
//! T_a^2)(T_w + T_a). Air at the mean temperature of wall and surroundings.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, HousingPart,
};
use gearloss_framework::registry::{Build, Evidence, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{ZERO_CELSIUS, needed, part};
use crate::convection::{Shape, forced, free, mixed, radiation};

limits! { RAYLEIGH = ("Ra", "Rayleigh number", "-", 0.0, 1e12, "Churchill and Chu 1975"); }
observed! { ALPHA = ("alpha", "W/(m2 K)", "heat transfer coefficient with radiation"); }

/// Free and forced convection with radiation.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Factor on convection, such as 2 for the moving air of a workshop. [-]
    #[serde(default = "default_one")]
    #[schemars(range(min = 0.01, max = 100.0))]
    pub factor: f64,
}

fn default_one() -> f64 {
    1.0
}

struct Ready {
    factor: f64,
    part: HousingPart,
    area: f64,
    height: f64,
    length: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Ready, Diagnostic> {
    let part = part(cx);
    let height = needed(
        part.height,
        "textbook",
        "the height of the housing",
        "height: 200 mm",
        cx,
    )?;
    Ok(Ready {
        factor: params.factor,
        area: needed(part.area, "textbook", "the area of the housing", "area: 500 cm2", cx)?,
        height,
        length: length(&part, "textbook", cx)?,
        part,
    })
}

/// Length along the flow; used only with moving air.
pub(super) fn length(part: &HousingPart, model: &str, cx: &Build<'_>) -> Result<f64, Diagnostic> {
    match part.length {
        None if part.air_speed == 0.0 => Ok(1.0),
        length => needed(
            length,
            model,
            "the length along the flow of the air",
            "length: 200 mm",
            cx,
        ),
    }
}

impl HeatDissipationModel for Ready {
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        let (wall, ambient) = (at.surface_temperature + ZERO_CELSIUS, at.ambient + ZERO_CELSIUS);
        let (ra, free) = free(Shape::Plate, self.height, wall, ambient);
        at.check(&RAYLEIGH, ra);
        at.show("alpha_n", "W/(m2 K)", free);
        let forced = if self.part.air_speed > 0.0 {
            at.show(
                "alpha_f",
                "W/(m2 K)",
                forced(self.part.air_speed, self.length, 0.5 * (wall + ambient)),
            )
        } else {
            0.0
        };
        let radiation = at.show("alpha_rad", "W/(m2 K)", radiation(self.part.emissivity, wall, ambient));
        let alpha = at.observe(&ALPHA, self.factor * mixed(forced, free) + radiation);
        Ok(at.show("alpha A", "W/K", alpha * self.area))
    }
}

register!(HeatDissipation, "textbook", Params,
    source: "Churchill and Chu 1975; flat plate; Stefan-Boltzmann",
    example: "{ type: textbook }",
    evidence: [formula(Evidence::SeveralSources, "textbooks agree; a housing is not a flat plate")],
    limits: [RAYLEIGH], observed: [ALPHA], prepare: prepare);
