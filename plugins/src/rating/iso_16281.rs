//! Life, pressure and stiffness of rolling bearings from the loads of their rolling elements, according to ISO/TS 16281.
//!
//! Source: ISO/TS 16281:2008 as printed by a public program. Balls: Q_ci = C/(0.407 Z cos^0.7 a) (1 + t^(10/3))^0.3 and
//! Q_ce = C/(0.389 Z cos^0.7 a) (1 + t^(-10/3))^0.3 with t = 1.044 ((1 - g)/(1 + g))^1.72 (f_i (2 f_e - 1)/(f_e (2 f_i - 1)))^0.41, g = D cos a/d_m; mean
//! loads with the power 3 on the ring that rotates relative to the load and 10/3 on the other; L10r = ((Q_ei/Q_ci)^(10/3) + (Q_ee/Q_ce)^(10/3))^(-9/10).
//! Rollers: Q_ci = C/(0.83 0.378 Z cos a) (1 + t^(9/2))^(2/9), Q_ce = C/(0.83 0.364 Z cos a) (1 + t^(-9/2))^(2/9), t = 1.038 ((1 - g)/(1 + g))^(143/108),
//! of a slice n_s^(-7/9) of it; slices with the powers 4 and 9/2, at the ends with the stress factor 1 - 0.01/ln(1.985 |2k - n_s - 1|/(2 n_s - 2));
//! L10r = (sum of the powers 9/2 over all slices of both rings)^(-8/9). P_ref = C/L10r^(1/p) with p = 3 or 10/3.
//! Lives of ball bearings agree with a commercial program within 1e-4, and without clearance with L10 of ISO 281; the factors 0.407 to 0.364 follow
//! from integrals of Sjoevall within 0.5 %. Rollers could be compared with no other program: their slices follow the power 4, L10 of ISO 281 10/3, so
//! that lightly loaded and well aligned rollers live longer here.
//! The rings are rigid and round. The tilt is that of the parameter, or follows from the tilting moment of a bearing that supports its shaft alone,
//! in the plane of the radial load. Balls have centrifugal force and gyroscopic moment at high speed (Jones, Harris). Flanges that carry thrust of
//! cylindrical rollers and the rib of tapered ones are not included. Lubrication and cleanliness are not included: multiply by a_ISO of `iso_281`.

use std::borrow::Cow;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::bearing::{Bearing, BearingAt, BearingKind, ElementRow, Elements};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::rolling::{Axes, BallGeometry, BallLoad, Balls, Equilibrium, Given, Rollers, balance};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::bearing::contact::{ESTIMATED, FAST, FASTEST, GREATEST_ANGLE};

use super::at_least_unless_zero;

const Q_MAX: Figure = Figure::greatest("Q_max", "N", "load of the most loaded rolling element").detail();
const PRESSURE: Figure = Figure::greatest("p_max", "MPa", "maximum Hertzian pressure on the raceways");
const LOADED: Figure = Figure::least("Z_l/Z", "-", "share of loaded rolling elements").detail();
const RADIAL: Figure = Figure::least("k_r", "N/um", "radial stiffness").detail();
const AXIAL: Figure = Figure::least("k_a", "N/um", "axial stiffness").detail();
const P_REF: Figure = Figure::greatest("P_ref", "N", "equivalent load from the load distribution").detail();
const L10RH: Figure = Figure::life("L10rh", "h", "basic reference rating life");

/// Life, pressure and stiffness of a rolling bearing from the loads of its rolling elements, according to ISO/TS 16281.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Iso16281 {
    /// Tilt of the inner ring relative to the outer ring in the plane of the radial load. [deg]
    #[serde(default)]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub misalignment: f64,
    /// Speed factor n d_m, for mm and 1/min, above which balls have centrifugal force and gyroscopic moment. [-]
    #[serde(default = "inertia_from")]
    #[schemars(range(min = 0.0, max = 1e8))]
    pub inertia_from: f64,
    /// Pressure above which the bearing is reported; default: never. [MPa]
    #[schemars(range(min = 0.0, max = 1e5))]
    pub greatest_pressure: Option<f64>,
    /// Life below which the bearing is reported; zero: never. [h]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub least_life: f64,
}

fn inertia_from() -> f64 {
    FAST
}

/// The rating with the rolling elements of its bearing.
struct Prepared {
    params: Iso16281,
    /// The elements, or what is missing.
    elements: Result<Elements, &'static str>,
}

fn prepare(params: Iso16281, cx: &mut Build<'_>) -> Result<Prepared, Diagnostic> {
    let elements = cx.own_part::<Bearing>()?.rolling_elements();
    Ok(Prepared {
        params,
        elements: elements.map_err(|missing| match missing {
            Cow::Borrowed(text) => text,
            Cow::Owned(_) => "estimated rolling elements do not fit: state `internal`",
        }),
    })
}

/// What the loads of the elements give.
struct Distribution {
    /// Radial and axial stiffness, where something resists. \[N/m\]
    stiffness: [Option<f64>; 2],
    greatest: f64,
    pressure: f64,
    loaded: f64,
    /// Life in 10^6 revolutions for a load rating of 1 N.
    life: f64,
}

/// Which ring rotates relative to the load.
#[derive(Clone, Copy, PartialEq)]
enum Rotating {
    Inner,
    Outer,
}

/// Sums of powers of loads: of the inner and of the outer ring, with the power of a rotating and of a stationary ring.
fn powers(rotating: Rotating, turning: f64, standing: f64) -> [f64; 2] {
    match rotating {
        Rotating::Inner => [turning, standing],
        Rotating::Outer => [standing, turning],
    }
}

/// Loads of balls for a dynamic load rating of one, on the inner and the outer ring.
fn ball_ratings(geometry: &BallGeometry) -> [f64; 2] {
    let cos = geometry.contact_angle.cos();
    let gamma = geometry.diameter * cos / geometry.pitch_diameter;
    let [inner, outer] = geometry.conformity;
    let grooves = inner * (2.0 * outer - 1.0) / (outer * (2.0 * inner - 1.0));
    let t = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves.powf(0.41);
    let share =
        |factor: f64, t: f64| (1.0 + t.powf(10.0 / 3.0)).powf(0.3) / (factor * geometry.number as f64 * cos.powf(0.7));
    [share(0.407, t), share(0.389, 1.0 / t)]
}

/// Life of balls in 10^6 revolutions for a load rating of one.
fn life_of_balls(balls: &Balls, rotating: Rotating, loads: &[BallLoad]) -> f64 {
    let exponents = powers(rotating, 3.0, 10.0 / 3.0);
    let mut sums = [0.0; 2];
    for ball in loads {
        for ring in [0, 1] {
            sums[ring] += ball.load[ring].powf(exponents[ring]);
        }
    }
    let number = balls.geometry().number as f64;
    let ratings = ball_ratings(balls.geometry());
    let damage = |ring: usize| {
        let mean = (sums[ring] / number).powf(1.0 / exponents[ring]);
        (mean / ratings[ring]).powf(10.0 / 3.0)
    };
    (damage(0) + damage(1)).powf(-0.9)
}

/// Stress factor of a slice, which grows towards the ends.
fn edge_factor(slice: usize, slices: usize) -> f64 {
    let place = (2.0 * slice as f64 + 1.0 - slices as f64).abs() / (2.0 * slices as f64 - 2.0);
    1.0 - 0.01 / (1.985 * place).ln()
}

/// Life of rollers in 10^6 revolutions for a load rating of one.
fn life_of_rollers(rollers: &Rollers, rotating: Rotating, displacement: &Axes<f64>) -> f64 {
    let geometry = rollers.geometry();
    let (number, slices) = (geometry.number as f64, geometry.slices);
    let cos = geometry.contact_angle.cos();
    let gamma = geometry.diameter * cos / geometry.pitch_diameter;
    let t = 1.038 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
    let of_slice = (slices as f64).powf(-7.0 / 9.0);
    let rating = |factor: f64, t: f64| of_slice * (1.0 + t.powf(4.5)).powf(2.0 / 9.0) / (0.83 * factor * number * cos);
    let ratings = [rating(0.378, t), rating(0.364, 1.0 / t)];
    let exponents = powers(rotating, 4.0, 4.5);
    let mut sums = vec![[0.0; 2]; slices];
    for roller in 0..geometry.number {
        for (k, load) in rollers
            .slices(roller, displacement)
            .enumerate()
            .filter(|(_, load)| *load > 0.0)
        {
            let load = load * edge_factor(k, slices);
            for ring in [0, 1] {
                sums[k][ring] += load.powf(exponents[ring]);
            }
        }
    }
    let damage = |ring: usize, sum: f64| ((sum / number).powf(1.0 / exponents[ring]) / ratings[ring]).powf(4.5);
    let sum: f64 = sums.iter().map(|rings| damage(0, rings[0]) + damage(1, rings[1])).sum();
    sum.powf(-8.0 / 9.0)
}

/// Radial and axial stiffness.
fn stiffness(found: &Equilibrium) -> [Option<f64>; 2] {
    [found.radial_stiffness(), found.axial_stiffness()]
}

/// From the loads of balls.
fn of_balls(
    balls: &Balls,
    found: &Equilibrium,
    rotating: Rotating,
    loads: Vec<BallLoad>,
    at: &BearingAt<'_>,
) -> Distribution {
    let is_steep = |ball: &BallLoad| ball.load[0] > 0.0 && ball.angle[0].abs().to_degrees() > GREATEST_ANGLE;
    if loads.iter().any(is_steep) {
        at.branch("contact angles beyond 80 deg: balls run over the shoulder of the inner ring");
    }
    let (mut greatest, mut pressure, mut loaded) = (0.0_f64, 0.0_f64, 0.0);
    for ball in &loads {
        for (contact, load) in balls.contacts().iter().zip(ball.load) {
            greatest = greatest.max(load);
            pressure = pressure.max(contact.under(load).pressure);
        }
        loaded += f64::from(u8::from(ball.load[0] > 0.0));
    }
    Distribution {
        stiffness: stiffness(found),
        greatest,
        pressure,
        loaded: loaded / balls.geometry().number as f64,
        life: life_of_balls(balls, rotating, &loads),
    }
}

/// From the loads of rollers.
fn of_rollers(rollers: &Rollers, found: &Equilibrium, rotating: Rotating) -> Distribution {
    let displacement = &found.displacement;
    let (mut greatest, mut slice, mut loaded) = (0.0_f64, 0.0_f64, 0.0);
    for roller in rollers.loads(displacement) {
        greatest = greatest.max(roller.load);
        slice = slice.max(roller.greatest_slice);
        loaded += f64::from(u8::from(roller.load > 0.0));
    }
    Distribution {
        greatest,
        pressure: [0, 1]
            .map(|ring| rollers.pressure(slice, ring))
            .into_iter()
            .fold(0.0, f64::max),
        loaded: loaded / rollers.geometry().number as f64,
        life: life_of_rollers(rollers, rotating, displacement),
        stiffness: stiffness(found),
    }
}

impl Prepared {
    /// The equilibrium of the inner ring and what follows from it; `None` if there is none.
    fn distribution(&self, elements: &Elements, at: &BearingAt<'_>) -> Option<Distribution> {
        let tilted = |given: Axes<Given>, arm: f64| {
            if at.tilting > 0.0 {
                at.branch("the tilting moment is in the plane of the radial load, in the sense that loads the most loaded element more");
                given.with_moment(at.tilting + at.radial * arm)
            } else {
                given.with_tilt(self.params.misalignment)
            }
        };
        let rotating = if at.outer_speed == 0.0 {
            Rotating::Inner
        } else {
            at.branch("the outer ring rotates: the load is fixed to the inner ring");
            Rotating::Outer
        };
        match &elements.row {
            ElementRow::Balls(balls) => {
                let axial = at.axial.abs();
                // With less the balls run at the bottom of the grooves, where the second bearing of the pair does not let them.
                if axial < at.radial * balls.geometry().contact_angle.tan() {
                    return None;
                }
                let given = tilted(Axes::loaded(axial, at.radial), balls.pressure_centre());
                let factor = at.speed.rpm().abs() * (1e3 * balls.geometry().pitch_diameter);
                if factor > FASTEST {
                    return None;
                }
                if factor > self.params.inertia_from && rotating == Rotating::Inner {
                    at.branch("balls with centrifugal force and gyroscopic moment");
                    let found = balls.balance_at_speed(at.speed.abs(), &given).ok()?;
                    let row = balls.at_speed(at.speed);
                    let loads: Vec<BallLoad> = row.loads(&found.displacement).map(|ball| ball.contacts).collect();
                    Some(of_balls(balls, &found, rotating, loads, at))
                } else {
                    let found = balance(balls, &given).ok()?;
                    let loads = balls.loads(&found.displacement).collect();
                    Some(of_balls(balls, &found, rotating, loads, at))
                }
            }
            ElementRow::Rollers(rollers) => {
                let axial = if rollers.geometry().contact_angle > 0.0 {
                    at.axial.abs()
                } else {
                    if at.axial != 0.0 {
                        at.branch("the flanges carry the axial load: not included");
                    }
                    0.0
                };
                let given = tilted(Axes::loaded(axial, at.radial), rollers.pressure_centre());
                let found = balance(rollers, &given).ok()?;
                Some(of_rollers(rollers, &found, rotating))
            }
        }
    }
}

impl Rating<Bearing> for Prepared {
    fn rate(&self, at: &BearingAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let elements = match &self.elements {
            Ok(elements) => elements,
            Err(missing) => {
                at.branch(missing);
                return Ok(());
            }
        };
        if elements.is_estimated {
            at.branch(ESTIMATED);
        }
        if elements.is_clearance_assumed {
            at.branch("no clearance in operation is stated: zero, or what the class has more than the normal one");
        }
        let (number, diameter) = match &elements.row {
            ElementRow::Balls(balls) => (balls.geometry().number, balls.geometry().diameter),
            ElementRow::Rollers(rollers) => {
                at.show("L", "mm", rollers.geometry().length.mm());
                (rollers.geometry().number, rollers.geometry().diameter)
            }
        };
        at.show("Z", "-", number as f64);
        at.show("D", "mm", diameter.mm());
        let carries_thrust = at.part.kind.has_balls() || at.part.kind == BearingKind::TaperedRoller;
        if at.radial == 0.0 && (at.axial == 0.0 || !carries_thrust) {
            at.branch("no load on the rolling elements");
            return Ok(());
        }
        let Some(found) = self.distribution(elements, at) else {
            at.branch(
                "no equilibrium: the axial load is below Fr tan(a), which the radial load induces: state the thrust of the pair; or the moment is too large; or balls are faster than 4e6 mm/min",
            );
            return Ok(());
        };
        to.add(&Q_MAX, at.show("Q_max", "N", found.greatest));
        let bound = self
            .params
            .greatest_pressure
            .map_or(Bound::NONE, |most| Bound::at_most(most * 1e-6));
        to.add_bounded(&PRESSURE, at.show("p_max", "MPa", found.pressure * 1e-6), bound);
        to.add(&LOADED, at.show("Z_l/Z", "-", found.loaded));
        for (figure, stiffness) in [&RADIAL, &AXIAL].into_iter().zip(found.stiffness) {
            if let Some(stiffness) = stiffness {
                to.add(figure, at.show(figure.symbol, "N/um", stiffness * 1e-6));
            }
        }
        let Some(c) = at.part.c else {
            at.branch("the dynamic load rating `c` is not known: no life");
            return Ok(());
        };
        let p = if at.part.kind.has_balls() { 3.0 } else { 10.0 / 3.0 };
        // The life grows with the power 3 or 4 of the load rating.
        let life = found.life * c.powf(if at.part.kind.has_balls() { 3.0 } else { 4.0 });
        at.show("L10r", "-", life);
        to.add(&P_REF, at.show("P_ref", "N", c * life.powf(-1.0 / p)));
        let n = at.show("n", "1/min", at.speed.rpm().abs());
        if n == 0.0 {
            at.branch("no relative speed: no life in hours");
            return Ok(());
        }
        let hours = at.show("L10rh", "h", life * 1e6 / (60.0 * n));
        to.add_bounded(&L10RH, hours, at_least_unless_zero(self.params.least_life / 3600.0));
        Ok(())
    }
}

/// The bearing that the public and the commercial program calculate, in part; the clearance is filled in.
macro_rules! seven_balls {
    ($clearance:literal, $at:literal) => {
        concat!(
            "{ part: { kind: deep_groove_ball, bore: 25 mm, outside: 62 mm, c: 23400 N, internal: { elements: 7, diameter: 11.5 mm, clearance: ",
            $clearance,
            " } }, at: ",
            $at,
            " }"
        )
    };
}

/// Values of the commercial program.
const PRINTED: Check = Check {
    input: "",
    values: &[],
    tolerance: 1e-4,
    because: "the programs differ in the fifth digit",
    source: "a commercial program, as printed in the tests of a public one",
};

register_rating!(Bearing, "iso_16281", Iso16281,
    source: "ISO/TS 16281:2008 as printed by a public program; Jones 1960 and Harris for high speed",
    evidence: [
        formula(Evidence::OneSource, "a public program that prints the equations; ball bearings also agree with a commercial one. Internal geometry that is not stated is estimated: assumed"),
        default_of("inertia_from", Evidence::Assumed, "centrifugal forces are a few per cent of usual loads there"),
        default_of("misalignment", Evidence::Assumed, "seats in line, rigid shaft"),
    ],
    checks: [
        Check {
            input: seven_balls!("0 um", "{ radial: 1000 N, axial: 0 N }"),
            values: &[("L10r", "13163.019")],
            ..PRINTED
        },
        Check {
            input: seven_balls!("0 um", "{ radial: 0 N, axial: 1000 N }"),
            values: &[("L10r", "2222.7318")],
            ..PRINTED
        },
        Check {
            input: seven_balls!("10 um", "{ radial: 1000 N, axial: 0 N }"),
            values: &[("L10r", "10795.7948")],
            ..PRINTED
        },
        Check {
            input: seven_balls!("10 um", "{ radial: 0 N, axial: 1000 N }"),
            values: &[("L10r", "3115.8781")],
            ..PRINTED
        },
        Check {
            input: seven_balls!("0 um", "{ radial: 1000 N, axial: 0 N }"),
            values: &[("Q_max", "619.61396 N")],
            tolerance: 1e-7,
            because: "the value has eight digits",
            source: "independent solution with SciPy",
        },
        Check {
            input: "{ part: { kind: cylindrical_roller, bore: 40 mm, outside: 80 mm, internal: { elements: 14, diameter: 11 mm, \
                    length: 12 mm, clearance: 20 um } }, at: { radial: 5000 N, axial: 0 N } }",
            values: &[("Q_max", "1895.0405 N")],
            tolerance: 1e-7,
            because: "the value has eight digits",
            source: "independent solution with SciPy",
        },
    ],
    figures: [Q_MAX, PRESSURE, LOADED, RADIAL, AXIAL, P_REF, L10RH],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::registry::RatedAlone;
    use gearloss_framework::rolling::{Contact, load_integral};
    use gearloss_framework::testing::{assert_close, rate};
    use proptest::prelude::*;

    fn rated(part: &str, at: &str, rating: &str) -> RatedAlone {
        rate("iso_16281", &format!("{{ part: {part}, at: {at}, rating: {rating} }}"))
    }

    fn value(rated: &RatedAlone, symbol: &str) -> f64 {
        rated.rated.value(symbol).unwrap()
    }

    const BALL: &str = "{ kind: deep_groove_ball, bore: 25 mm, outside: 62 mm, c: 23400 N, internal: { elements: 7, diameter: 11.5 mm } }";
    const ROLLER: &str = "{ kind: cylindrical_roller, bore: 40 mm, outside: 80 mm, c: 62000 N, internal: { elements: 14, diameter: 11 mm, length: 12 mm } }";
    const TAPERED: &str = "{ kind: tapered_roller, bore: 30 mm, outside: 62 mm, width: 17.25 mm, c: 50000 N, c0: 44000 N, e: 0.37, y: 1.6 }";
    const ANGULAR: &str = "{ kind: angular_contact_ball, bore: 40 mm, outside: 80 mm, c: 36000 N, e: 1.14, y: 0.57 }";

    /// The factors of the ratings are mean loads of very many elements in half a load zone, for which the bearing is rated: 1/0.407, 1/0.389, 1/0.378
    /// and 1/0.364 of Fr/Z.
    #[test]
    fn factors_are_integrals_of_sjoevall() {
        for (contact, power, factor) in [
            (Contact::Point, 3.0, 0.407),
            (Contact::Point, 10.0 / 3.0, 0.389),
            (Contact::Line, 4.0, 0.378),
            (Contact::Line, 4.5, 0.364),
        ] {
            let [_, radial] = load_integral(0.5, contact.exponent());
            let [mean, _] = load_integral(0.5, contact.exponent() * power);
            assert_close(mean.powf(1.0 / power) / radial, 1.0 / factor, 5e-3);
        }
    }

    /// Very many balls without clearance live as long as ISO 281 says, (C/Fr)^3, but for the three digits of the factors.
    #[test]
    fn many_balls_are_those_of_iso_281() {
        let part = "{ kind: deep_groove_ball, bore: 500 mm, outside: 520 mm, c: 20000 N, internal: { elements: 300, diameter: 5 mm } }";
        let found = rated(part, "{ radial: 2000 N, axial: 0 N, speed: 100 rpm }", "{}");
        assert_close(found.step("L10r").unwrap(), 1000.0, 3e-3);
        assert_close(value(&found, "P_ref"), 2000.0, 1e-3);
    }

    /// Seven balls of which one is under the load live within some per cent of it, and clearance shortens their life.
    #[test]
    fn clearance_shortens_the_life() {
        let life = |clearance: f64| {
            let part = BALL.replace("11.5 mm }", &format!("11.5 mm, clearance: {clearance} um }}"));
            rated(&part, "{ radial: 2000 N, axial: 0 N }", "{}")
                .step("L10r")
                .unwrap()
        };
        assert_close(life(0.0), 11.7_f64.powi(3), 0.04);
        let lives = [0.0, 10.0, 20.0, 40.0].map(life);
        assert!(lives.is_sorted_by(|a, b| a > b), "{lives:?}");
        assert!(life(-3.0) > life(0.0));
    }

    /// Lives and pressures of an independent solution with SciPy.
    #[test]
    fn misalignment_shortens_the_life_of_rollers() {
        let found = |rating: &str| rated(ROLLER, "{ radial: 10000 N, axial: 0 N }", rating);
        let (straight, tilted) = (found("{}"), found("{ misalignment: 10 arcmin }"));
        assert_close(straight.step("L10r").unwrap(), 1_475.248_256, 1e-8);
        assert_close(tilted.step("L10r").unwrap(), 620.146_743, 1e-5);
        let growth = value(&tilted, "p_max") / value(&straight, "p_max");
        assert_close(growth, 13.416_644_287 / 11.627_200_084, 1e-5);
        let other = found("{ misalignment: -10 arcmin }");
        assert_close(value(&other, "p_max"), value(&tilted, "p_max"), 1e-9);
    }

    #[test]
    fn silicon_nitride_has_more_pressure_and_is_stiffer() {
        let of = |material: &str| {
            let part = BALL.replace("11.5 mm }", &format!("11.5 mm, material: {material} }}"));
            rated(&part, "{ radial: 2000 N, axial: 500 N }", "{}")
        };
        let (hybrid, steel) = (of("silicon_nitride"), of("steel"));
        assert!((1.1..1.13).contains(&(value(&hybrid, "p_max") / value(&steel, "p_max"))));
        assert!((1.05..1.2).contains(&(value(&hybrid, "k_a") / value(&steel, "k_a"))));
    }

    /// A bearing with a contact angle needs Fr tan(a) of thrust.
    #[test]
    fn without_the_thrust_of_a_pair_there_is_no_distribution() {
        for part in [TAPERED, ANGULAR] {
            let without = rated(part, "{ radial: 3000 N, axial: 100 N }", "{}");
            assert_eq!(without.rated.figures(), [], "{part}");
            let with = rated(part, "{ radial: 3000 N, axial: 4000 N }", "{}");
            assert!(value(&with, "k_a") > 1.0 && value(&with, "Z_l/Z") > 0.5, "{part}");
        }
    }

    #[test]
    fn bounds_are_in_their_units() {
        let found = rated(
            BALL,
            "{ radial: 4000 N }",
            "{ greatest_pressure: 1000 MPa, least_life: 1e7 h }",
        );
        let outside = found.rated.figures().iter().filter(|figure| figure.is_outside());
        let bounds: Vec<(&str, f64, f64)> = outside
            .map(|f| (f.figure.symbol, f.bound.least, f.bound.greatest))
            .collect();
        assert_eq!(
            bounds,
            [("p_max", f64::NEG_INFINITY, 1000.0), ("L10rh", 1e7, f64::INFINITY)]
        );
    }

    #[test]
    fn kinds_with_several_rows_have_no_distribution() {
        for kind in [
            "spherical_roller",
            "self_aligning_ball",
            "thrust_ball",
            "four_point_contact_ball",
        ] {
            let found = rated(
                &format!("{{ kind: {kind}, bore: 40 mm, outside: 80 mm, c: 40000 N }}"),
                "{}",
                "{}",
            );
            assert_eq!(found.rated.figures(), [], "{kind}");
        }
    }

    /// At high speed the outer ring carries the centrifugal forces too.
    #[test]
    fn fast_balls_press_on_the_outer_ring() {
        let at = |speed: &str| format!("{{ radial: 300 N, axial: 100 N, speed: {speed} }}");
        let slow = rated(BALL, &at("1000 rpm"), "{}");
        let fast = rated(BALL, &at("25000 rpm"), "{}");
        assert!(value(&fast, "Q_max") > 1.5 * value(&slow, "Q_max"));
        let without = rated(BALL, &at("25000 rpm"), "{ inertia_from: 1e8 }");
        assert_close(value(&without, "Q_max"), value(&slow, "Q_max"), 1e-12);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// More load, more pressure and a shorter life.
        #[test]
        fn life_falls_with_the_load(kind in 0..4_usize, radial in 50.0..10_000.0_f64, share in 0.0..1.0_f64) {
            let part = [BALL, ROLLER, TAPERED, ANGULAR][kind];
            let axial = (share + [0.0, 0.0, 0.4, 1.3][kind]) * radial;
            let of = |factor: f64| {
                rated(part, &format!("{{ radial: {} N, axial: {} N }}", factor * radial, factor * axial), "{}")
            };
            let (one, more) = (of(1.0), of(1.3));
            prop_assert!(value(&more, "L10rh") < value(&one, "L10rh"));
            prop_assert!(value(&more, "p_max") > value(&one, "p_max"));
            prop_assert!(value(&more, "P_ref") > value(&one, "P_ref"));
        }
    }
}
