//! Rolling bearings according to ISO/TR 14179-1, of AGMA origin: Palmgren's form with f0 depending on the oil level.
//!
//! Source: ISO/TR 14179-1:2001, quoted from memory: the load-dependent moment is that of ISO/TR 14179-2; f0 = f0_min + (f0_max - f0_min)
//! H/H_max with f0_min if no rolling element is immersed and f0_max for a fully immersed bearing. The report's table of both was
//! not available. By a convention of this program they are the values for oil mist and for an oil jet in the table of ISO/TR
//! 14179-2, and H_max is the height of the outer raceway; a greased bearing has f0_min.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::mechanism::bearing::{Bearing, BearingPart, Lubrication};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::palmgren::{self, AXIAL_RATIO, Constants, F0, LOAD, NO_LOAD, P1, Palmgren, RADIAL_RATIO};
use super::rows::{self, Lack};

/// Palmgren's form with a load-independent factor that depends on the oil level, as in ISO/TR 14179-1.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Minimum f0, with no rolling element immersed; default: that of oil mist. [-]
    #[schemars(range(min = 0.0, max = 50.0))]
    pub f0_min: Option<f64>,
    /// Maximum f0, fully immersed; default: that of an oil jet. [-]
    #[schemars(range(min = 0.0, max = 50.0))]
    pub f0_max: Option<f64>,
    #[serde(default)]
    coefficients: Constants,
}

impl Params {
    fn model(&self, part: &BearingPart) -> Result<Palmgren, Lack> {
        let f0 = |stated: Option<f64>, lubrication| stated.map_or_else(|| rows::f0_under(part, lubrication), Ok);
        let f0 = F0::Dip {
            least: f0(self.f0_min, Lubrication::OilAir)?,
            most: f0(self.f0_max, Lubrication::Jet)?,
            covered: 2.0 * part.raceway,
        };
        Palmgren::new(
            part,
            f0,
            rows::load_law(part, 0.55, 3.0, false)?,
            rows::f2(part),
            self.coefficients,
        )
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Palmgren, Diagnostic> {
    palmgren::of_part(cx, |part| params.model(part))
}

register!(Bearing, "iso14179_1", Params,
    source: "ISO/TR 14179-1:2001",
    example: "{ type: iso14179_1 }",
    evidence: [
        formula(Evidence::Recalled, "quoted from memory, not checked; one program uses the same structure"),
        default_of("f0_min", Evidence::Assumed, "the report's table was not available"),
        default_of("f0_max", Evidence::Assumed, "the report's table was not available"),
    ],
    limits: [AXIAL_RATIO, RADIAL_RATIO], terms: [LOAD, NO_LOAD], observed: [P1], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::bearing::testing::{RIG, moments, part};
    use gearloss_framework::mechanism::bearing::BearingKind;

    #[test]
    fn f0_rises_with_the_oil_from_mist_to_jet() {
        let part = part(BearingKind::DeepGrooveBall, "63", 40.0, 90.0, Some(24000.0));
        let model = Params {
            coefficients: Constants::PUBLISHED,
            f0_min: None,
            f0_max: None,
        }
        .model(&part)
        .unwrap();
        let no_load = |height| moments(&model, &part, RIG, height)[1];
        // 69.4883 N mm is the moment for f0 = 2.
        assert!((no_load(0.0) / (69.4883 / 2.0) - 1.0).abs() < 1e-5);
        assert!((no_load(1.0) / (69.4883 * 2.0) - 1.0).abs() < 1e-5);
        assert!((no_load(part.raceway) / (69.4883 * 1.25) - 1.0).abs() < 1e-5);
    }
}
