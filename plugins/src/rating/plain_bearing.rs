//! Specific load and film thickness of plain bearings.
//!
//! Source: DIN 31652-3:1983 and ISO 7902-3:1998 compare p = F/(D B) with a limit of the bearing material, 5 to 10 MPa for white metal and 7 to 20 MPa
//! for bronzes, and h_min with a limit of surfaces, alignment and dirt, quoted from memory. State the limits of your bearing.
//! The film is that of the model `journal_film` at the point, with its temperature if the bearing states a `conductance`.
//! At standstill there is no film, and its thickness is not rated. Thrust washers are not rated.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::bearing::journal_film::{FilmFit, Journal};

const PRESSURE: Figure = Figure::greatest("p", "MPa", "specific load");
const THICKNESS: Figure = Figure::least("h_min", "um", "minimum film thickness").detail();
const RATIO: Figure = Figure::least(
    "h_min/h_lim",
    "-",
    "film thickness over that at which the surfaces touch",
);
const TEMPERATURE: Figure = Figure::greatest("T", "degC", "temperature of the film").detail();

/// Specific load and film thickness of a plain bearing.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PlainBearing {
    /// Specific load above which the bearing is reported; default: never. [MPa]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub greatest_specific_load: Option<f64>,
    /// Film thickness over that at which the surfaces touch below which the bearing is reported. [-]
    #[serde(default = "least_ratio")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_ratio: f64,
    /// Temperature of the film above which the bearing is reported; default: never. [degC]
    #[schemars(range(min = -60.0, max = 400.0))]
    pub greatest_temperature: Option<f64>,
    /// Approximation of the film, as in the model `journal_film`.
    #[serde(default)]
    pub fit: FilmFit,
}

fn least_ratio() -> f64 {
    1.0
}

impl Rating<Bearing> for PlainBearing {
    fn rate(&self, at: &BearingAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let Some(journal) = Journal::of(at.part, self.fit) else {
            at.branch("not a plain bearing: no film");
            return Ok(());
        };
        let pressure = at.show("p", "MPa", at.radial * 1e-6 / (journal.diameter * journal.width));
        let greatest = self.greatest_specific_load.map(|pressure| pressure * 1e-6);
        to.add_bounded(&PRESSURE, pressure, greatest.map_or(Bound::NONE, Bound::at_most));
        if at.speed == 0.0 {
            at.branch("no relative speed: no film");
            return Ok(());
        }
        let film = journal.film(at)?;
        at.show("eps", "-", film.place.eccentricity);
        to.add(&THICKNESS, at.show("h_min", "um", film.thickness.um()));
        let ratio = at.show("h_min/h_lim", "-", film.thickness / journal.least);
        to.add_bounded(&RATIO, ratio, Bound::at_least(self.least_ratio));
        let greatest = self.greatest_temperature.map_or(Bound::NONE, Bound::at_most);
        to.add_bounded(&TEMPERATURE, at.show("T", "degC", film.temperature), greatest);
        Ok(())
    }
}

register_rating!(Bearing, "plain_bearing", PlainBearing,
    source: "DIN 31652-3:1983; ISO 7902-3:1998",
    part: "{ kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, least_thickness: 3 um, conductance: 40 W/K, fed: true } }",
    evidence: [
        formula(Evidence::Derived, "definitions, with the film of the model `journal_film`"),
        default_of("least_ratio", Evidence::Derived, "definition of the limit that the bearing states"),
        default_of("fit", Evidence::Derived, "own solution of the Reynolds equation"),
    ],
    checks: [
        Check {
            input: "{ rating: { fit: din31652 }, part: { kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, \
                    least_thickness: 3 um } }, at: { speed: 142.75473 rpm, radial: 2000 N, nu: 20.0555458 mm2/s, rho: 870 kg/m3 } }",
            values: &[("h_min/h_lim", "1"), ("p", "1.1111111 MPa")],
            tolerance: 1e-5,
            because: "the values have six digits or more",
            source: "calculated independently with the polynomials of DIN 31652-2 and ISO 7902-2; F/(D B)",
        },
    ],
    figures: [PRESSURE, THICKNESS, RATIO, TEMPERATURE]);

#[cfg(test)]
mod tests {
    use gearloss_framework::rating::RatedFigure;
    use gearloss_framework::testing::rate;

    fn outside(rating: &str, speed: &str) -> Vec<&'static str> {
        let part =
            "{ kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, least_thickness: 3 um } }";
        let input =
            format!("{{ rating: {rating}, part: {part}, at: {{ speed: {speed}, radial: 10 kN, nu: 20 mm2/s }} }}");
        let rated = rate("plain_bearing", &input).rated;
        let outside = rated.figures().iter().filter(|found| found.is_outside());
        outside.map(|found: &RatedFigure| found.figure.symbol).collect()
    }

    #[test]
    fn a_thin_film_and_a_high_load_are_reported() {
        let plain = "{}";
        assert_eq!(outside(plain, "50 rpm"), ["h_min/h_lim"]);
        assert!(outside(plain, "3000 rpm").is_empty());
        assert_eq!(outside("{ greatest_specific_load: 5 MPa }", "0 rpm"), ["p"]);
    }
}
