//! Plain journal bearings: the hydrodynamic film between a shaft and a bush.
//!
//! Source: the method of DIN 31652-1:1983 and ISO 7902-1:1998, quoted from memory, with own solutions of its equations. With the relative
//! clearance psi, D = `bore`, B = `width`, x = B/D: So = F psi^2/(D B eta w) = x^2 a1 e^p/2 eps/(1 - eps)
//! sqrt(pi^2 (1 - eps^2) + 16 eps^2)/((1 + eps)^2 (a2 - eps)) gives the eccentricity eps; h_min = D psi (1 - eps)/2; M = (mu/psi) psi F D/2 with
//! mu/psi = pi/(So sqrt(1 - eps^2)) + eps/2 sin(beta), beta = b(eps) atan(pi sqrt(1 - eps^2)/(2 eps)); Q3 = D^3 psi w eps q(eps). a1, a2, p, b and
//! q are polynomials in x and eps: those of the `fit`.
//! Without load that is Petroff's moment, which is the term `concentric`; `eccentric` is the rest of the film's.
//! The film has the temperature of the oil at the bearing. With `conductance` it has the temperature T at which it gives off its loss,
//! P = k (T - T_s) + 2 rho c Q3 (T - T_in), the last term if it is fed: its oil enters at T_in and leaves as much above T as it entered below;
//! rho c = 1.8e6 J/(m3 K). Its viscosity is then that of Walther's line with the viscosity and the slope of the oil at the bearing.
//! Where h_min is below `least_thickness` h_lim, the friction is (1 - s) times that of the film and s times `solid_friction` F D/2 with the share
//! s = 1 - h_min/h_lim: a convention of this program. It is continuous; at standstill the moment is that of solid friction.
//! Assumes a full bush without grooves in the loaded zone, a rigid, aligned shaft, steady load, enough oil and laminar flow. Where both members
//! turn, the film is drawn in by the sum of their speeds relative to the load, and friction is taken at the speed relative to each other. An axial
//! load has no friction: it needs a thrust washer. Not for grease, dry bushes or dynamic loads.
//! An explanation shows the stiffness at constant speed and viscosity, derived from F cos(beta) and F sin(beta) over the eccentricity: `k_xx` is the force
//! along the load per displacement along it, `k_xy` per displacement across it, `k_yx` and `k_yy` the same for the force across the load. `F/x` is the load over
//! the displacement in its direction, a value for `radial_stiffness`.

mod characteristics;
mod film;
mod stiffness;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingLaw};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{limits, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use characteristics::DIN_WIDEST;
pub use characteristics::FilmFit;
pub use film::{Film, Journal};
pub use stiffness::Loaded;

terms! {
    CONCENTRIC = no_load("concentric");
    ECCENTRIC = load("eccentric");
    CONTACT = load("contact");
}
limits! {
    WIDTH = ("B/D", "width over diameter", "-", 0.25, 1.5, "widths of the fit");
    ECCENTRICITY = ("eps", "relative eccentricity", "-", 0.05, 0.95, "eccentricities of the fit");
    FULL_FILM = ("h_min/h_lim", "film thickness over that at which the surfaces touch", "-", 1.0, f64::INFINITY, "full film; mixed friction below");
    LAMINAR = ("Re/Re_c", "Reynolds number over 41.3/sqrt(psi)", "-", 0.0, 1.0, "laminar flow, ISO 7902-1");
}
observed! {
    THICKNESS = ("h_min", "um", "minimum film thickness");
    TEMPERATURE = ("T", "degC", "temperature of the film");
    STIFFNESS = ("k", "N/um", "stiffness of the film along the eccentricity");
    FLOW = ("Q3", "l/min", "oil that leaves the film at its sides");
}

/// Plain journal bearings with a hydrodynamic film, by the method of DIN 31652 and ISO 7902.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct JournalFilm {
    /// Approximation of load, attitude angle and side flow over the eccentricity.
    #[serde(default)]
    pub fit: FilmFit,
}

fn prepare(params: JournalFilm, cx: &mut Build<'_>) -> Result<Journal, Diagnostic> {
    let part = cx.own_part::<Bearing>()?;
    let journal = Journal::of(part, params.fit).ok_or_else(|| {
        cx.error("journal_film applies to plain bearings only")
            .help("write `kind: plain` and `film:` in the bearing, or give it another model")
    })?;
    let width = journal.width / journal.diameter;
    if params.fit == FilmFit::Din31652 && width > DIN_WIDEST {
        return Err(cx
            .error(format!(
                "the fit of DIN 31652 as quoted from memory is wrong for bearings wider than their diameter; this one has B/D {width:.3}"
            ))
            .help("omit `fit`: the own fit serves B/D to 1.5"));
    }
    Ok(journal)
}

impl BearingLaw for Journal {
    #[inline(always)]
    fn loss<R: Real>(&self, at: &BearingAt<'_, R>) -> Result<Loss<R>, Undefined> {
        at.show("F", "N", at.radial);
        at.check(&WIDTH, R::constant(self.width / self.diameter));
        let film = self.film(at)?;
        at.branch(if self.is_cooled() {
            "the film has the temperature at which it gives off its loss"
        } else {
            "the film has the temperature of the oil at the bearing"
        });
        at.observe(&TEMPERATURE, film.temperature);
        at.show("eta", "mPa s", film.eta.mpa_s());
        at.show("So", "-", film.sommerfeld);
        let eccentricity = at.check(&ECCENTRICITY, film.place.eccentricity);
        at.show("sin(beta)", "-", film.sine);
        let loaded = at.radial.is_above(R::ZERO);
        let friction = film.moment() / (at.radial * (0.5 * self.diameter));
        at.show("mu", "-", R::select(loaded, friction, R::ZERO));
        at.observe(&THICKNESS, film.thickness.um());
        at.check(&FULL_FILM, film.thickness / self.least);
        at.branch(match (film.touching.is_zero().all(), eccentricity.is_zero().all()) {
            (true, true) => "no load: Petroff, without a coefficient of friction",
            (true, false) => "full film",
            (false, _) => "film thinner than h_lim: mixed friction, solid with the share 1 - h_min/h_lim",
        });
        at.check(&LAMINAR, film.turbulence);
        at.observe(&STIFFNESS, film.stiffness * 1e-6);
        let under = self.loaded(at.radial, &film);
        let [[xx, xy], [yx, yy]] = under.matrix();
        let stiffnesses = [
            ("k_xx", xx),
            ("k_xy", xy),
            ("k_yx", yx),
            ("k_yy", yy),
            ("F/x", under.in_operation()),
        ];
        for (symbol, k) in stiffnesses {
            at.show(symbol, "N/um", R::select(loaded, k * 1e-6, R::ZERO));
        }
        at.observe(&FLOW, film.flow * 6e4);
        let [concentric, eccentric, contact] = film.moments;
        Ok(Loss::MOMENTS
            .with(&CONCENTRIC, concentric)
            .with(&ECCENTRIC, eccentric)
            .with(&CONTACT, contact))
    }
}

/// Values calculated independently with the polynomials of DIN 31652 and ISO 7902.
const OF_DIN: Check = Check {
    input: "",
    values: &[],
    tolerance: 1e-5,
    because: "the values have six digits or more",
    source: "calculated independently with the polynomials of DIN 31652-2 and ISO 7902-2",
};

/// Values of an own numerical solution, which a fit follows.
const SOLVED: Check = Check {
    tolerance: 0.009,
    because: "the fit is within 0.9 % of the load of the numerical solution, whose error is 0.3 %",
    source: "own solution of the Reynolds equation by finite volumes with the boundary condition of Reynolds, 360 x 40 cells, extrapolated",
    ..OF_DIN
};

register!(Bearing, "journal_film", JournalFilm,
    source: "method of DIN 31652:1983 and ISO 7902:1998; own solution of the Reynolds equation",
    example: "{ type: journal_film }",
    part: "{ kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, least_thickness: 3 um, conductance: 40 W/K, fed: true } }",
    evidence: [
        formula(Evidence::Recalled, "the balance, the heat of the oil and the limit of laminar flow are quoted from memory; the film is derived and checked \
                 numerically; mixed friction is a convention, its coefficient 0.1 assumed"),
        default_of("fit", Evidence::Derived, "own solution; Raimondi and Boyd as quoted from memory agree within 0.3 %, the fit of DIN 31652, recalled, within \
                    10 % up to B/D 1"),
    ],
    checks: [
        Check {
            input: "{ model: { type: journal_film, fit: din31652 }, part: { kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, \
                    least_thickness: 3 um, conductance: 1.8 W/K, surroundings: 20 degC } }, at: { speed: 1500 rpm, radial: 2000 N, temperature: 40 degC, \
                    nu: 45.6912650 mm2/s, beta: 0.047269548 1/K, rho: 870 kg/m3 } }",
            values: &[
                ("T", "60.044024 degC"),
                ("eta", "17.4208579 mPa s"),
                ("So", "0.9135884"),
                ("eps", "0.7088495"),
                ("mu", "0.00764785"),
                ("h_min", "13.10177 um"),
                ("total", "72.079244 W"),
            ],
            ..OF_DIN
        },
        Check {
            input: "{ model: { type: journal_film, fit: din31652 }, part: { kind: plain, bore: 60 mm, width: 30 mm, film: { relative_clearance: 0.0015, \
                    least_thickness: 3 um } }, at: { speed: 142.75473 rpm, radial: 2000 N, nu: 20.0555458 mm2/s, rho: 870 kg/m3 } }",
            values: &[("h_min", "3 um"), ("h_min/h_lim", "1")],
            ..OF_DIN
        },
        Check {
            input: "{ part: { kind: plain, bore: 100 mm, width: 100 mm, film: { relative_clearance: 0.001, least_thickness: 3 um } }, \
                    at: { speed: 954.92966 rpm, radial: 13160 N, nu: 12.195122 mm2/s, rho: 820 kg/m3 } }",
            values: &[("So", "1.3160"), ("eps", "0.6"), ("mu", "0.0032157"), ("h_min", "20 um"), ("Q3", "0.70386 l/min")],
            ..SOLVED
        },
        Check {
            input: "{ part: { kind: plain, bore: 100 mm, width: 50 mm, film: { relative_clearance: 0.001, least_thickness: 3 um } }, \
                    at: { speed: 954.92966 rpm, radial: 2492.3 N, nu: 12.195122 mm2/s, rho: 820 kg/m3 } }",
            values: &[("So", "0.49846"), ("eps", "0.6"), ("mu", "0.0081013"), ("h_min", "20 um"), ("Q3", "0.4227 l/min")],
            ..SOLVED
        },
        Check {
            input: "{ part: { kind: plain, bore: 100 mm, width: 100 mm, film: { relative_clearance: 0.001, least_thickness: 3 um } }, \
                    at: { speed: 954.92966 rpm, radial: 0 N, nu: 12.195122 mm2/s, rho: 820 kg/m3 } }",
            values: &[("moment", "1.57079633 Nm")],
            source: "Petroff 1883: pi eta w B D^2/(2 psi)",
            ..OF_DIN
        },
    ],
    limits: [WIDTH, ECCENTRICITY, FULL_FILM, LAMINAR], terms: [CONCENTRIC, ECCENTRIC, CONTACT],
    observed: [THICKNESS, TEMPERATURE, STIFFNESS, FLOW], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::Answer as _;
    use gearloss_framework::mechanism::bearing::{BearingEntry, BearingFilm, BearingKind, BearingPart};
    use gearloss_framework::testing::{assert_close, eval};
    use proptest::prelude::*;

    use super::*;

    const RPM: f64 = std::f64::consts::PI / 30.0;

    /// A bearing of 60 mm with a width over diameter and a film that is changed.
    fn part(width: f64, change: impl FnOnce(&mut BearingFilm)) -> BearingPart {
        let mut film = BearingFilm {
            relative_clearance: Some(1.5e-3),
            least_thickness: Some(3e-6),
            ..BearingFilm::default()
        };
        change(&mut film);
        BearingPart::try_from(BearingEntry {
            kind: Some(BearingKind::Plain),
            bore: Some(0.06),
            width: Some(0.06 * width),
            film: Some(film),
            ..BearingEntry::default()
        })
        .unwrap()
    }

    /// Film and loss at a speed in 1/min and a load in N, with an oil of 20 mm2/s at 60 degC.
    fn at(part: &BearingPart, speed: f64, load: f64) -> (Film<f64>, Loss) {
        try_at(part, speed, load).unwrap()
    }

    fn try_at(part: &BearingPart, speed: f64, load: f64) -> Result<(Film<f64>, Loss), Undefined> {
        let at = BearingAt::usual(part, Notes::MUTED).with(|to| {
            (to.speed, to.radial) = (speed * RPM, load);
            (to.temperature, to.nu, to.rho, to.beta) = (60.0, 20e-6, 870.0, 0.039);
        });
        let journal = Journal::of(part, FilmFit::Reynolds).unwrap();
        Ok((journal.film(&at)?, BearingLaw::loss(&journal, &at)?))
    }

    #[test]
    fn at_standstill_it_has_no_power_and_the_moment_of_solid_friction() {
        for load in [0.0, 2000.0] {
            let (film, loss) = at(&part(0.5, |_| ()), 0.0, load);
            assert_eq!(loss.total(0.0), 0.0);
            assert!((loss.sum() - 0.1 * load * 0.03).abs() <= 1e-9 * load, "{film:?}");
        }
    }

    #[test]
    fn extreme_points_are_finite() {
        for speed in [0.0, 1e-9, 1.0, 1e5] {
            for load in [0.0, 1e-6, 1e9] {
                for width in [0.05, 0.5, 4.0] {
                    let cooled = |film: &mut BearingFilm| (film.conductance, film.fed) = (Some(1e5), true);
                    for (part, load) in [(part(width, |_| ()), load), (part(width, cooled), load.min(1e5))] {
                        let (film, loss) = at(&part, speed, load);
                        assert!(loss.is_sound(), "{speed} {load} {film:?}");
                        assert!(film.stiffness.is_finite() && film.flow.is_finite(), "{film:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_film_too_hot_for_any_oil_is_undefined() {
        let part = part(0.5, |film| film.conductance = Some(1e-3));
        let at = BearingAt::usual(&part, Notes::MUTED).with(|to| (to.speed, to.radial) = (1e3, 1e4));
        let undefined = Journal::of(&part, FilmFit::Reynolds).unwrap().film(&at).unwrap_err();
        assert!(undefined.what.contains("conductance"));
    }

    #[test]
    fn coaxial_shafts_draw_the_film_in_with_the_sum_of_their_speeds() {
        let film = |fixed: bool, outer_speed: f64| {
            let part = part(0.5, |film| film.load_fixed_in_space = fixed);
            let at = BearingAt::usual(&part, Notes::MUTED)
                .with(|to| (to.speed, to.outer_speed, to.radial) = (50.0, outer_speed, 2000.0));
            Journal::of(&part, FilmFit::Reynolds).unwrap().film(&at).unwrap()
        };
        let (planet, coaxial) = (film(false, 30.0), film(true, 30.0));
        assert_close(planet.sommerfeld / coaxial.sommerfeld, 110.0 / 50.0, 1e-12);
        assert_eq!(film(true, 0.0).sommerfeld, film(false, 0.0).sommerfeld);
        // The bush turns against the shaft at the same speed: the load draws nothing in.
        assert!(film(true, -25.0).place.eccentricity > 0.999);
    }

    #[test]
    fn the_stiffness_is_the_slope_of_the_load() {
        let part = part(0.5, |_| ());
        let clearance = 1.5e-3 * 0.03;
        let place = |load: f64| at(&part, 1500.0, load).0.place.eccentricity * clearance;
        let slope = (2001.0 - 1999.0) / (place(2001.0) - place(1999.0));
        assert_close(at(&part, 1500.0, 2000.0).0.stiffness, slope, 1e-6);
    }

    /// A small further load along or across displaces the shaft as the matrix of the film says; without load it only pushes across.
    #[test]
    fn the_matrix_is_the_slope_of_the_place() {
        let part = part(0.5, |_| ());
        let journal = Journal::of(&part, FilmFit::Reynolds).unwrap();
        let clearance = 1.5e-3 * 0.03;
        let place = |load: f64| {
            let film = at(&part, 1500.0, load).0;
            (film.place.eccentricity * clearance, film.sine.asin())
        };
        for load in [200.0, 2000.0, 20_000.0] {
            let [[xx, xy], [yx, yy]] = journal.loaded(load, &at(&part, 1500.0, load).0).matrix();
            let more = 1e-4 * load;
            let [(e1, b1), (e2, b2)] = [load - more, load + more].map(place);
            let change = [e2 * b2.cos() - e1 * b1.cos(), e2 * b2.sin() - e1 * b1.sin()];
            assert!(
                (xx * change[0] + xy * change[1] - 2.0 * more).abs() < 1e-6 * load,
                "{load}"
            );
            assert!((yx * change[0] + yy * change[1]).abs() < 1e-6 * load, "{load}");
            // A load that is turned turns the place.
            let (e, beta) = place(load);
            let turned = [-e * beta.sin(), e * beta.cos()];
            assert!((xx * turned[0] + xy * turned[1]).abs() < 1e-6 * load, "{load}");
            assert!((yx * turned[0] + yy * turned[1] - load).abs() < 1e-6 * load, "{load}");
        }
        let [[xx, xy], [yx, yy]] = journal.loaded(1e-3, &at(&part, 1500.0, 1e-3).0).matrix();
        // The attitude angle of the fit is 88.7 degrees there.
        assert!(xx.abs() < 0.03 * xy && yy.abs() < 0.03 * xy, "{xx} {yy} {xy}");
        assert_close(yx, -xy, 1e-3);
    }

    #[test]
    fn the_eccentricity_outside_the_fit_and_mixed_friction_are_noted() {
        let input = |speed: &str| {
            format!(
                "{{ part: {{ kind: plain, bore: 60 mm, width: 100 mm, film: {{ clearance: 90 um, least_thickness: 3 um }} }}, at: {{ speed: {speed}, radial: 20 kN }} }}"
            )
        };
        let outside = |speed: &str| -> Vec<&str> {
            let evaluated = eval("bearing/journal_film", &input(speed));
            evaluated.outside().collect()
        };
        assert_eq!(outside("10 rpm"), ["B/D", "eps", "h_min/h_lim"]);
        assert_eq!(outside("3000 rpm"), ["B/D"]);
    }

    proptest! {
        /// The film gives off what it produces, and is not colder than what cools it.
        #[test]
        fn the_balance_closes(
            speed in 1.0..6000.0_f64, load in 0.0..20_000.0_f64, conductance in 20.0..1000.0_f64, surroundings in 0.0..80.0_f64,
            supply in 20.0..90.0_f64, fed in any::<bool>()
        ) {
            let part = part(0.7, |film| {
                (film.conductance, film.surroundings, film.fed) = (Some(conductance), Some(surroundings), fed);
                film.supply = fed.then_some(supply);
            });
            let found = try_at(&part, speed, load);
            prop_assume!(found.is_ok());
            let (film, loss) = found.unwrap();
            let power = loss.total(speed * RPM);
            let oil = if fed { 2.0 * 1.8e6 * film.flow * (film.temperature - supply) } else { 0.0 };
            let given_off = conductance * (film.temperature - surroundings) + oil;
            let scale = power + conductance * surroundings + oil.abs();
            prop_assert!((given_off - power).abs() < 1e-10 * scale, "{given_off} of {power} W, {film:?}");
            let coldest = if fed { surroundings.min(supply) } else { surroundings };
            prop_assert!(film.temperature >= coldest);
        }

        /// The moment has no step where the surfaces begin to touch.
        #[test]
        fn mixed_friction_begins_without_a_step(load in 100.0..20_000.0_f64) {
            let part = part(0.5, |_| ());
            let touches = |speed: f64| at(&part, speed, load).0.touching > 0.0;
            let (mut low, mut high) = (1e-3, 1e5);
            prop_assume!(touches(low) && !touches(high));
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if touches(middle) { low = middle } else { high = middle }
            }
            let (below, above) = (at(&part, low, load).1.sum(), at(&part, high, load).1.sum());
            prop_assert!((below / above - 1.0).abs() < 1e-9);
        }
    }
}
