//! Heat dissipation of the gearbox: from the housing to the air, through the flange, through a cooler.

pub(crate) mod air;
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
