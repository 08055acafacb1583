//! Links between the nodes of a thermal network.

pub mod annulus;
pub mod casing_air;
pub mod conduction;
pub mod fling_off;
pub mod gear_in_mist;
pub mod hertz_spot;
pub mod oil_casing;
pub mod ring;
pub mod spray;
pub mod tooth_contact;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::heat_dissipation::HousingPart;
use gearloss_framework::mechanism::heat_link::{GearShape, HeatLink, HeatLinkAt, HeatLinkPart};
use gearloss_framework::registry::Build;

use crate::rotating::Fluid;

/// Thermal conductivity of steel. \[W/(m K)\]
const STEEL: f64 = 46.0;

fn part(cx: &Build<'_>) -> HeatLinkPart {
    cx.part::<HeatLink>().copied().unwrap_or_default()
}

/// The model's own value, else that of the gear named by the link; otherwise an error with an example of the missing key.
fn of_gear(
    stated: Option<f64>,
    gear: impl FnOnce(&GearShape) -> f64,
    what: &str,
    example: &str,
    cx: &Build<'_>,
) -> Result<f64, Diagnostic> {
    stated.or_else(|| part(cx).gear.as_ref().map(gear)).ok_or_else(|| {
        cx.error(format!("the link needs {what}")).help(format!(
            "name the gear of the link, or write `{example}` beside `type`, with your value"
        ))
    })
}

/// The model's own value, else that of the housing; otherwise an error with an example of the missing key.
fn of_housing(
    stated: Option<f64>,
    housing: impl FnOnce(&HousingPart) -> Option<f64>,
    what: &str,
    example: &str,
    cx: &Build<'_>,
) -> Result<f64, Diagnostic> {
    stated
        .or_else(|| part(cx).housing.as_ref().and_then(housing))
        .ok_or_else(|| {
            cx.error(format!("the link needs {what}")).help(format!(
                "write `{example}` beside `type` or in `housing: {{ outside: {{ ... }} }}`, with your value"
            ))
        })
}

/// The oil at the mean temperature of both nodes.
fn oil(at: &HeatLinkAt<'_>) -> Fluid {
    Fluid {
        conductivity: at.conductivity,
        eta: at.eta,
        density: at.rho,
        heat_capacity: at.heat_capacity,
    }
}

#[cfg(test)]
mod cases {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::heat_link::HeatLinkModel;
    use gearloss_framework::registry::{Files, Registry};

    use super::*;

    /// An oil with a given conductivity, kinematic viscosity, density and specific heat at a speed, for the check cases.
    pub fn at(part: &HeatLinkPart, speed: f64, [k, nu, rho, c]: [f64; 4]) -> HeatLinkAt<'_> {
        HeatLinkAt::usual(part, Notes::MUTED).with(|to| {
            to.speed = speed;
            to.nu = nu;
            to.eta = nu * rho;
            to.rho = rho;
            to.heat_capacity = c;
            to.conductivity = k;
        })
    }

    /// The message with which preparing a model for a part fails.
    pub fn built<T, M: HeatLinkModel>(
        prepare: fn(T, &mut Build<'_>) -> Result<M, Diagnostic>,
        params: T,
    ) -> Result<M, String> {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        prepare(params, &mut Build::new(&registry, &files)).map_err(|d| format!("{d} {:?}", d.help))
    }
}
