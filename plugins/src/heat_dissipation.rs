//! Heat dissipation of the gearbox: from the housing to the air, through the flange, through a cooler.

pub mod constant;
pub mod fins;
pub mod iso14179_1;
pub mod iso14179_2;
pub mod oil_cooler;
pub mod textbook;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::heat_dissipation::{HeatDissipation, HousingPart};
use gearloss_framework::registry::Build;

/// 0 degC. \[K\]
pub(crate) const ZERO_CELSIUS: f64 = 273.15;

fn part(cx: &Build<'_>) -> HousingPart {
    cx.part::<HeatDissipation>().copied().unwrap_or_default()
}

/// A quantity of the housing outside that a model requires.
fn needed(value: Option<f64>, model: &str, what: &str, example: &str, cx: &Build<'_>) -> Result<f64, Diagnostic> {
    value.ok_or_else(|| {
        cx.error(format!("{model} needs {what}"))
            .help(format!("add `housing: {{ outside: {{ {example} }} }}` with your value"))
    })
}

#[cfg(test)]
mod cases {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::heat_dissipation::{HeatDissipationAt, HeatDissipationModel};

    use super::*;

    /// A housing of aluminium.
    pub fn part() -> HousingPart {
        HousingPart {
            wall_thickness: 0.008,
            wall_conductivity: 150.0,
            emissivity: 0.9,
            ..HousingPart::default()
        }
    }

    /// Compares the conductance in W/K with oil of 80 degC, air of 20 degC, 830 kg/m3 and 2100 J/(kg K).
    #[track_caller]
    pub fn assert_conductance(way: &impl HeatDissipationModel, by_hand: f64) {
        let part = part();
        let at = HeatDissipationAt::usual(&part, Notes::MUTED).with(|to| to.surface_temperature = 80.0);
        let conductance = way.conductance(&at).unwrap();
        assert!((conductance / by_hand - 1.0).abs() < 1e-5, "{conductance}");
    }
}
