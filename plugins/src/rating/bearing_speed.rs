//! Speeds of rolling bearings compared with those of the catalogue.
//!
//! Source: catalogues state a thermal reference speed according to ISO 15312 and a limiting speed, which depends on cage, seals and balance.
//! n d_m compares bearings of any size. The speed is that of the rings relative to each other.
//! The reference speed holds for the conditions of ISO 15312; exceeding it is a question of temperature and not reported.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const SPEED_FACTOR: Figure = Figure::greatest("n d_m", "mm/min", "speed factor").detail();
const OF_REFERENCE: Figure = Figure::greatest("n/n_ref", "-", "speed over reference speed");
const OF_LIMITING: Figure = Figure::greatest("n/n_lim", "-", "speed over limiting speed");

/// Speed of a rolling bearing compared with those of its catalogue.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct BearingSpeed {
    /// Speed over limiting speed above which the bearing is reported. [-]
    #[serde(default = "greatest_ratio")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub greatest_ratio: f64,
    /// Speed factor n d_m, for mm and 1/min, above which the bearing is reported; default: never. [-]
    #[schemars(range(min = 0.0, max = 1e8))]
    pub greatest_speed_factor: Option<f64>,
}

fn greatest_ratio() -> f64 {
    1.0
}

impl Rating<Bearing> for BearingSpeed {
    fn rate(&self, at: &BearingAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        if !at.part.kind.rolls() {
            at.branch("no rolling elements: no speed of a catalogue");
            return Ok(());
        }
        let n = at.show("n", "1/min", at.speed.rpm().abs());
        let factor = at.show("n d_m", "mm/min", n * at.part.mean_diameter().mm());
        to.add_bounded(
            &SPEED_FACTOR,
            factor,
            self.greatest_speed_factor.map_or(Bound::NONE, Bound::at_most),
        );
        if let Some(reference) = at.part.reference_speed {
            to.add(&OF_REFERENCE, at.show("n/n_ref", "-", n / reference.rpm()));
        }
        if let Some(limiting) = at.part.limiting_speed {
            let ratio = at.show("n/n_lim", "-", n / limiting.rpm());
            to.add_bounded(&OF_LIMITING, ratio, Bound::at_most(self.greatest_ratio));
        } else {
            at.branch("`limiting_speed` is not stated: the speed is not compared with it");
        }
        Ok(())
    }
}

register_rating!(Bearing, "bearing_speed", BearingSpeed,
    source: "bearing catalogues; ISO 15312:2018 for the reference speed",
    evidence: [
        formula(Evidence::Derived, "ratios of stated numbers"),
        default_of("greatest_ratio", Evidence::SeveralSources, "definition of the limiting speed in catalogues"),
    ],
    figures: [SPEED_FACTOR, OF_REFERENCE, OF_LIMITING]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::rating::RatedFigure;
    use gearloss_framework::testing::{assert_close, rate};

    #[test]
    fn a_6208_at_half_and_at_twice_its_limiting_speed() {
        let part = "{ kind: deep_groove_ball, bore: 40 mm, outside: 80 mm, reference_speed: 18000 rpm, limiting_speed: 11000 rpm }";
        let rated = |n: f64| {
            rate(
                "bearing_speed",
                &format!("{{ part: {part}, at: {{ speed: {n} rpm }} }}"),
            )
            .rated
        };
        let (half, twice) = (rated(-5500.0), rated(22_000.0));
        assert_close(half.value("n/n_lim").unwrap(), 0.5, 1e-12);
        assert_close(half.value("n d_m").unwrap(), 330_000.0, 1e-12);
        assert!(!half.figures().iter().any(RatedFigure::is_outside));
        let reported = twice.figures().iter().filter(|f| f.is_outside());
        assert_eq!(reported.map(|f| f.figure.symbol).collect::<Vec<_>>(), ["n/n_lim"]);
    }
}
