//! Pressure and film of gear flanks along the path of contact, with an indicator of micropitting.
//!
//! Source: Hertz for a line contact of the local radii and load share; film of Dowson and Higginson 1961 or of Hamrock and Dowson 1977, with
//! inlet heating according to Gupta et al., as the friction laws use them. The film ratio lambda is the film over the composite root mean
//! square roughness of both flanks; that for micropitting is the film over the arithmetic mean roughness, as in ISO/TS 6336-22, whose
//! permissible value is that of a test of the oil and must be stated.
//! These are indicators, not safety factors of ISO 6336: without load distribution factors, profile modifications and the roughness term of
//! the standards, and with the viscosity of the oil, not of the warmer flank. Pitting and bending strength are not rated.
//! With a plastic gear the pressure hardly raises the viscosity, which these films suppose: they are then omitted.

use gearloss_framework::contact::sharing::{Sharing, SharingEntry};
use gearloss_framework::contact::{Film, film};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt};
use gearloss_framework::mechanism::mean_friction::{MeanFrictionAt, hertz};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::at_least_unless_zero;
use super::flank::{self, RatedFlanks};

pub(super) const AT_PITCH: Figure = Figure::greatest("p_HC", "MPa", "Hertzian pressure at the pitch point");
pub(super) const PRESSURE: Figure =
    Figure::greatest("p_H", "MPa", "maximum Hertzian pressure along the path of contact");
pub(super) const FILM: Figure =
    Figure::least("h_min", "um", "minimum film thickness along the path of contact").detail();
pub(super) const LAMBDA: Figure = Figure::least("lambda", "-", "minimum film ratio along the path of contact");
pub(super) const LAMBDA_RA: Figure =
    Figure::least("lambda_GF", "-", "minimum film over arithmetic mean roughness").detail();
const MICROPITTING: Figure = Figure::least("S_lambda", "-", "indicator of micropitting");

/// Hertzian pressure, film ratio and an indicator of micropitting of gear flanks.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct FlankContact {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default)]
    pub load_sharing: SharingEntry,
    /// Film formula.
    #[serde(default)]
    pub film: Film,
    /// Inlet heating reduces the film.
    #[serde(default = "yes")]
    pub thermal: bool,
    /// Film ratio lambda below which the mesh is reported; zero: never. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_film_ratio: f64,
    /// Hertzian pressure above which the mesh is reported; default: the least `permissible_pressure` of the gears' materials. [MPa]
    #[schemars(range(min = 0.0, max = 10000.0))]
    pub greatest_pressure: Option<f64>,
    /// Permissible film over arithmetic mean roughness, from a micropitting test of the oil; without it there is no indicator. [-]
    #[schemars(range(min = 0.001, max = 10.0))]
    pub permissible_film_ratio: Option<f64>,
    /// Indicator of micropitting below which the mesh is reported. [-]
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_safety: f64,
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}

/// The rating of a pair of flanks with its path.
pub(super) struct Prepared {
    params: FlankContact,
    flanks: Option<RatedFlanks>,
}

fn prepare(params: FlankContact, cx: &mut Build<'_>) -> Result<Prepared, Diagnostic> {
    let part = cx.own_part::<GearMesh>()?.clone();
    let (drive, coast) = cx.load_sharings(&part, &params.load_sharing)?;
    Ok(Prepared::new(params, &part.pair, &drive, coast.as_ref()))
}

impl Rating<GearMesh> for Prepared {
    fn rate(&self, at: &GearMeshAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        self.rate_flanks(at, to);
        Ok(())
    }
}

impl Prepared {
    pub(super) fn new(params: FlankContact, pair: &Pair, drive: &Sharing, coast: Option<&Sharing>) -> Self {
        Self {
            flanks: RatedFlanks::new(pair, drive, coast),
            params,
        }
    }

    pub(super) fn rate_flanks(&self, at: &GearMeshAt<'_>, to: &mut Rated) {
        let Some(path) = self.flanks.as_ref().map(|flanks| flanks.at(at)) else {
            at.branch("no path of contact of involute flanks");
            return;
        };
        if at.torque <= 0.0 {
            at.branch("no torque");
            return;
        }
        let params = &self.params;
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes);
        let (mut pressure, mut thinnest) = (0.0_f64, f64::INFINITY);
        flank::contacts(path, at, &mean, |_, contact| {
            pressure = pressure.max(contact.pressure);
            thinnest = thinnest.min(film(contact, params.film, params.thermal));
        });
        let whole = mean.part.pair.line_load(mean.normal_force);
        let share = path.line(path.at_pitch_point(), whole);
        at.show("F_bn", "N", mean.normal_force);
        at.show("rho_C", "mm", mean.radius.mm());
        let line_load = whole * share;
        let at_pitch = hertz(line_load, mean.part.modulus, mean.radius);
        to.add(&AT_PITCH, at.show("p_HC", "MPa", at_pitch * 1e-6));
        let permissible = at
            .part
            .materials
            .iter()
            .filter_map(|material| material.permissible_pressure);
        let least = permissible.fold(None, |least: Option<f64>, own| {
            Some(least.map_or(own, |least| least.min(own)))
        });
        let bound = params
            .greatest_pressure
            .or(least)
            .map_or(Bound::NONE, |bound| Bound::at_most(bound * 1e-6));
        to.add_bounded(&PRESSURE, at.show("p_H", "MPa", pressure * 1e-6), bound);
        if at.speed == 0.0 {
            at.branch("no speed: no film");
            return;
        }
        if at.part.plastic().is_some() {
            at.branch("a plastic gear: the film formulas hold for metal flanks");
            return;
        }
        to.add(&FILM, at.show("h_min", "um", thinnest.um()));
        at.show("Rq", "um", at.part.rq.um());
        let lambda = at.show("lambda", "-", thinnest / at.part.rq);
        to.add_bounded(&LAMBDA, lambda, at_least_unless_zero(params.least_film_ratio));
        let of_mean = at.show("lambda_GF", "-", thinnest / at.part.ra);
        to.add(&LAMBDA_RA, of_mean);
        if let Some(permissible) = params.permissible_film_ratio {
            let safety = at.show("S_lambda", "-", of_mean / permissible);
            to.add_bounded(&MICROPITTING, safety, Bound::at_least(params.least_safety));
        }
    }
}

register_rating!(GearMesh, "flank_contact", FlankContact,
    source: "Hertz 1881; Dowson and Higginson 1961; Hamrock and Dowson 1977; ISO/TS 6336-22:2018 for the form of the indicator",
    evidence: [
        formula(Evidence::Reconstructed, "pressure and film are those of the friction laws; the indicator has the form of the standard, not its numbers"),
        default_of("least_safety", Evidence::Derived, "the film of the test that passed"),
    ],
    checks: [
        Check {
            input: "{ at: { torque: 70 Nm } }",
            values: &[("p_HC", "795.1 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 5 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ at: { torque: 98.9 Nm } }",
            values: &[("p_HC", "944.9 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 6 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ at: { torque: 132.5 Nm } }",
            values: &[("p_HC", "1093.9 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 7 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ at: { torque: 171.6 Nm } }",
            values: &[("p_HC", "1244.9 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 8 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ at: { torque: 215.6 Nm } }",
            values: &[("p_HC", "1395.4 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 9 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ at: { torque: 265.1 Nm } }",
            values: &[("p_HC", "1547.3 MPa")],
            tolerance: 0.01,
            because: "the stages are quoted from memory",
            source: "load stage 10 of the micropitting test of FVA 54/7 with FZG C gears",
        },
        Check {
            input: "{ part: { z: [25, 50], normal_module: 2 mm, pressure_angle: 20 deg, helix_angle: 30 deg, \
                    centre_distance: 86.602540378 mm, facewidth: 25.132741 mm, tip_diameter: [61.735 mm, 119.47 mm], ra: [0.4 um, \
                    0.4 um], rq: [0.5 um, 0.5 um] }, at: { torque: 100 Nm, speed: 3000 rpm }, rating: { load_sharing: uniform } }",
            values: &[("p_HC", "680.843 MPa")],
            tolerance: 2e-6,
            because: "the value has six digits",
            source: "ISO 6336-2 by hand for a whole overlap ratio: Z_H Z_E sqrt(F_t/(d b) (u + 1)/u/eps_alpha)",
        },
        Check {
            input: "{ part: { z: [25, 50], normal_module: 2 mm, pressure_angle: 20 deg, helix_angle: 30 deg, \
                    centre_distance: 86.602540378 mm, facewidth: 25.132741 mm, tip_diameter: [61.735 mm, 119.47 mm], ra: [0.4 um, \
                    0.4 um], rq: [0.5 um, 0.5 um] }, at: { torque: 100 Nm, speed: 3000 rpm }, rating: { load_sharing: contact_lines } }",
            values: &[("p_HC", "680.843 MPa")],
            tolerance: 2e-6,
            because: "the value has six digits",
            source: "ISO 6336-2 by hand for a whole overlap ratio: Z_H Z_E sqrt(F_t/(d b) (u + 1)/u/eps_alpha)",
        },
    ],
    figures: [AT_PITCH, PRESSURE, FILM, LAMBDA, LAMBDA_RA, MICROPITTING],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::registry::RatedAlone;
    use gearloss_framework::testing::{assert_close, rate};

    fn rated(at: &str, rating: &str) -> RatedAlone {
        rate("flank_contact", &format!("{{ at: {at}, rating: {rating} }}"))
    }

    fn value(rated: &RatedAlone, symbol: &str) -> f64 {
        rated.rated.value(symbol).unwrap()
    }

    /// With rigid teeth the pressure is highest at the inner point of single contact of the pinion, where one pair begins to carry the whole
    /// force.
    #[test]
    fn the_highest_pressure_is_at_the_end_of_a_section() {
        let part = gearloss_framework::mechanism::gear_mesh::MeshPart::fzg_c().unwrap();
        let pair = &part.pair;
        let found = rated("{ torque: 100 Nm }", "{}");
        let radius = |x: f64| pair.relative_radius(x);
        let [_, inner, pitch, outer, _] = pair.points;
        let at_ends = [inner, outer].map(|x| (radius(pitch) / radius(x)).sqrt());
        let most = at_ends[0].max(at_ends[1]) * value(&found, "p_HC");
        assert!(
            value(&found, "p_H") > most * (1.0 - 1e-6),
            "{} {most}",
            value(&found, "p_H")
        );
    }

    #[test]
    fn pressure_grows_with_the_root_of_the_torque() {
        let [one, four] = ["50 Nm", "200 Nm"].map(|torque| rated(&format!("{{ torque: {torque} }}"), "{}"));
        for symbol in ["p_HC", "p_H"] {
            assert_close(value(&four, symbol) / value(&one, symbol), 2.0, 1e-12);
        }
        assert!(value(&one, "p_H") >= value(&one, "p_HC"));
    }

    /// Isothermal film of Dowson and Higginson: U^0.7 and W^-0.13.
    #[test]
    fn film_follows_its_law() {
        let film = |at: &str| value(&rated(at, "{ thermal: false }"), "h_min");
        assert_close(
            film("{ speed: 2000 rpm }") / film("{ speed: 1000 rpm }"),
            2.0_f64.powf(0.7),
            1e-9,
        );
        assert_close(
            film("{ torque: 200 Nm }") / film("{ torque: 100 Nm }"),
            2.0_f64.powf(-0.13),
            1e-9,
        );
    }

    #[test]
    fn the_indicator_needs_a_permissible_film() {
        assert_eq!(rated("{}", "{}").rated.value("S_lambda"), None);
        let found = rated("{}", "{ permissible_film_ratio: 10 }");
        assert_close(value(&found, "S_lambda") * 10.0, value(&found, "lambda_GF"), 1e-12);
        assert!(
            found
                .rated
                .figures()
                .iter()
                .any(|f| f.figure.symbol == "S_lambda" && f.is_outside())
        );
    }

    #[test]
    fn a_bound_on_the_pressure_is_in_its_unit() {
        let found = rated("{ torque: 265.1 Nm }", "{ greatest_pressure: 1000 MPa }");
        let broken = found.rated.figures().iter().find(|f| f.is_outside()).unwrap();
        assert_eq!((broken.figure.symbol, broken.bound.greatest), ("p_H", 1000.0));
    }
}
