//! A constant heat transfer coefficient over an area.
//!
//! Source: Q = alpha A (T_surface - T_sink); Concli 2015 measured 24.7 W/(m2 K) over the surface of a small planetary gearbox on
//! its flange, based on the surface temperature.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::heat_dissipation::{
    HeatDissipation, HeatDissipationAt, HeatDissipationModel, WarmSide,
};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{needed, part};

/// Temperature that the coefficient refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The surface temperature.
    #[default]
    Surface,
    /// The oil temperature.
    Oil,
}

/// A constant heat transfer coefficient over an area.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Heat transfer coefficient. [W/(m2 K)]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub alpha: f64,
    /// Area; default: that of the housing outside. [cm2]
    #[schemars(range(min = 0.01, max = 1e8))]
    pub area: Option<f64>,
    /// Temperature that the coefficient refers to.
    #[serde(default)]
    pub side: Side,
    /// Temperature of the heat sink, such as a flange; default: the ambient temperature. [degC]
    #[schemars(range(min = -60.0, max = 250.0))]
    pub sink: Option<f64>,
}

struct Constant {
    alpha: f64,
    area: f64,
    side: WarmSide,
    sink: Option<f64>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Constant, Diagnostic> {
    let area = params.area.or(part(cx).area);
    Ok(Constant {
        alpha: params.alpha,
        area: needed(area, "constant", "an area", "area: 500 cm2", cx)?,
        side: match params.side {
            Side::Surface => WarmSide::Surface,
            Side::Oil => WarmSide::Oil,
        },
        sink: params.sink,
    })
}

impl HeatDissipationModel for Constant {
    fn warm_side(&self) -> WarmSide {
        self.side
    }
    fn sink(&self) -> Option<f64> {
        self.sink
    }
    fn conductance(&self, at: &HeatDissipationAt<'_>) -> Result<f64, Undefined> {
        Ok(at.show("alpha A", "W/K", self.alpha * self.area))
    }
}

register!(HeatDissipation, "constant", Params,
    source: "Newton's law; Concli 2015, eq. 11",
    example: "{ type: constant, alpha: 24.7 W/(m2 K), area: 500 cm2 }",
    evidence: [formula(Evidence::User, "the user states the coefficient; one article measured 24.7")],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::heat_dissipation::HousingPart;

    use super::*;

    #[test]
    fn e1_alpha_times_area_times_difference() {
        let part = HousingPart::default();
        let at = HeatDissipationAt::usual(&part, Notes::MUTED);
        let way = Constant {
            alpha: 24.7,
            area: 0.05,
            side: WarmSide::Surface,
            sink: None,
        };
        assert!((way.conductance(&at).unwrap() * 60.0 / 74.1000 - 1.0).abs() < 1e-9);
    }
}
