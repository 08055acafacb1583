//! Characteristic functions of a full journal bearing of finite width: load, attitude angle and side flow over the relative eccentricity.
//!
//! So = F psi^2/(D B eta w) = y g(eps) with y = eps/(1 - eps) and, with x = B/D,
//! g = x^2/2 sqrt(pi^2 (1 - eps^2) + 16 eps^2)/((1 + eps)^2 (a2 - eps)) a1(x) e^p(eps, x). This is the form of DIN 31652 and ISO 7902, in which
//! p is zero; its a2 is negative there. y instead of eps keeps all digits of the film thickness at any load.

use std::f64::consts::{FRAC_PI_2, PI};

use gearloss_framework::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Approximation of the solution of the Reynolds equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilmFit {
    /// Own fit of an own numerical solution: within 0.9 % of its load, 0.3 deg of its angle and 0.3 % of its flow for B/D of 0.25 to 1.5 and
    /// eccentricities of 0.05 to 0.95.
    #[default]
    Reynolds,
    /// Polynomials of DIN 31652-2:1983 and ISO 7902-2:1998, quoted from memory. For B/D of 0.25 to 1 their load is within 10 %, their friction
    /// within 11 % of the own solution; beyond they are wrong and refused.
    Din31652,
}

/// a2 with its sign changed, over powers of B/D.
const END: [f64; 5] = [1.000_026, 0.023_634, 0.4215, 0.038_817, 0.090_551];
/// a1 of DIN 31652, over powers of B/D.
const DIN_FACTOR: [f64; 5] = [1.1642, -1.9456, 7.1161, -10.1073, 5.0141];
/// Coefficients of the attitude angle of DIN 31652, over powers of the eccentricity; each over powers of B/D.
const DIN_ANGLE: [[f64; 2]; 5] = [
    [1.152_624, -0.105_465],
    [-2.5905, 0.798_745],
    [8.733_93, -2.3291],
    [-13.3414, 3.424_337],
    [6.6294, -1.591_732],
];
/// Coefficients of p, as those of the angle.
const LOAD: [[f64; 5]; 5] = [
    [-0.01020, 0.07912, -0.06662, 0.22249, -0.06078],
    [0.38292, -2.07217, 3.41034, -1.72552, 0.29363],
    [-2.02055, 10.22740, -12.89242, 6.08903, -1.01296],
    [3.88843, -19.12128, 20.84128, -8.82209, 1.28060],
    [-2.23938, 10.22500, -9.64335, 3.22825, -0.27918],
];
/// Coefficients of the attitude angle.
const ANGLE: [[f64; 4]; 5] = [
    [1.00407, -0.00413, -0.07744, 0.02555],
    [-0.44956, -0.26828, 0.55985, -0.18511],
    [-0.09682, 2.72254, -2.98051, 0.89596],
    [0.07170, -5.66176, 6.33710, -1.90431],
    [-0.06392, 3.67671, -4.11036, 1.22804],
];
/// Coefficients of the flow over B/D and eccentricity.
const FLOW: [[f64; 5]; 3] = [
    [0.24903, 0.00934, -0.09435, 0.04645, -0.00763],
    [0.00078, -0.00572, -0.00347, -0.01220, 0.00553],
    [-0.00763, 0.05374, -0.07441, 0.04070, -0.00729],
];

/// Greatest B/D of the fit of DIN 31652 at which its load is near the solution of the Reynolds equation.
pub const DIN_WIDEST: f64 = 1.0;
/// Steps of Newton's method until the eccentricity has all digits; five suffice for loads So of 1e-8 to 1e12 and all widths.
const STEPS: usize = 6;

/// The functions of one bearing.
#[derive(Debug)]
pub struct Characteristics {
    /// g = factor sqrt(pi^2 (1 - eps^2) + 16 eps^2)/((1 + eps)^2 (end - eps)) e^load(eps).
    factor: f64,
    end: f64,
    load: [f64; 5],
    /// ln(g/factor) without load.
    centre: f64,
    /// beta = angle(eps) atan(pi sqrt(1 - eps^2)/(2 eps)).
    angle: [f64; 5],
    /// Q3/(D^3 psi w) = eps flow(eps).
    flow: [f64; 3],
}

/// The place of a shaft in its bush.
#[derive(Debug, Clone, Copy)]
pub struct Place<R> {
    /// Relative eccentricity eps.
    pub eccentricity: R,
    /// 1 - eps with all its digits.
    pub room: R,
    /// eps/(1 - eps).
    ratio: R,
}

impl<R: Real> Place<R> {
    fn new(ratio: R) -> Self {
        let room = R::constant(1.0) / (ratio + 1.0);
        Self {
            eccentricity: ratio * room,
            room,
            ratio,
        }
    }

    /// sqrt(1 - eps^2).
    pub fn root(&self) -> R {
        (self.room * (self.eccentricity + 1.0)).sqrt()
    }
}

impl Characteristics {
    /// The functions of a bearing with a width over its diameter. Narrower than the fit, load and flow follow those of infinitely narrow
    /// bearings, x^2 and x; wider, those of the widest one.
    pub fn new(fit: FilmFit, width: f64) -> Self {
        let (narrowest, widest) = match fit {
            FilmFit::Reynolds => (0.2, 1.75),
            FilmFit::Din31652 => (0.25, DIN_WIDEST),
        };
        let x = width.min(widest);
        let held = x.max(narrowest);
        let of_width = |coefficients: &[f64]| polynomial(coefficients, held);
        let (a1, load, angle, flow) = match fit {
            FilmFit::Reynolds => (
                1.0,
                LOAD.map(|row| of_width(&row)),
                ANGLE.map(|row| of_width(&row)),
                FLOW.map(|row| x * of_width(&row)),
            ),
            FilmFit::Din31652 => (
                of_width(&DIN_FACTOR),
                [0.0; 5],
                DIN_ANGLE.map(|row| of_width(&row)),
                [0.25 * x * (1.0 - 0.223 * held * held), 0.0, 0.0],
            ),
        };
        let mut functions = Self {
            factor: 0.5 * x * x * a1,
            end: of_width(&END),
            load,
            centre: 0.0,
            angle,
            flow,
        };
        functions.centre = functions.shape(&Place::new(0.0)).0;
        functions
    }

    /// ln(g/factor) and its derivative by eps.
    #[inline(always)]
    fn shape<R: Real>(&self, place: &Place<R>) -> (R, R) {
        let e = place.eccentricity;
        let sum = e + 1.0;
        let square = place.room * sum * (PI * PI) + e * e * 16.0;
        let end = R::constant(self.end) - e;
        let one = R::constant(1.0);
        let logarithm = (square.sqrt() / (sum * sum * end)).ln() + polynomial(&self.load, e);
        let [_, p1, p2, p3, p4] = self.load;
        let slope = e * (16.0 - PI * PI) / square - one / sum * 2.0
            + one / end
            + polynomial(&[p1, 2.0 * p2, 3.0 * p3, 4.0 * p4], e);
        (logarithm, slope)
    }

    /// The place at which a film carries a load So, zero or more.
    ///
    /// With y = So/g(0) e^v, v + ln g(eps) - ln g(0) = 0 has a slope of 0.7 to 1.7 in v for all eps, so that Newton's method finds its only
    /// root from v = 0 in a few steps. The last step also makes the derivatives those of the implicit function.
    #[inline(always)]
    pub fn place<R: Real>(&self, sommerfeld: R) -> Place<R> {
        let ratio = sommerfeld / (self.centre.exp() * self.factor);
        let mut v = R::ZERO;
        let mut place = Place::new(ratio);
        for _ in 0..STEPS {
            let (logarithm, slope) = self.shape(&place);
            v -= (v + logarithm - self.centre) / (place.eccentricity * place.room * slope + 1.0);
            place = Place::new(ratio * v.exp());
        }
        place
    }

    /// So at a place, and its derivative by eps.
    #[inline(always)]
    pub fn load<R: Real>(&self, place: &Place<R>) -> (R, R) {
        let (logarithm, slope) = self.shape(place);
        let g = logarithm.exp() * self.factor;
        let load = place.ratio * g;
        (load, g / (place.room * place.room) + load * slope)
    }

    /// Sine of the attitude angle beta, between the line of centres and the load.
    #[inline(always)]
    pub fn sine_of_angle<R: Real>(&self, place: &Place<R>) -> R {
        let tangent = place.eccentricity / place.root() * (2.0 / PI);
        let angle = polynomial(&self.angle, place.eccentricity) * (R::constant(FRAC_PI_2) - tangent.lift(f64::atan));
        // `sine` is for angles of up to 45 degrees; that of three times an angle follows from it.
        let third = (angle / 3.0).sine();
        third * (R::constant(3.0) - third * third * 4.0)
    }

    /// Derivative of the attitude angle by eps.
    #[inline(always)]
    pub fn turning<R: Real>(&self, place: &Place<R>) -> R {
        let (e, root) = (place.eccentricity, place.root());
        let half = R::constant(FRAC_PI_2) - (e / root * (2.0 / PI)).lift(f64::atan);
        let [_, a1, a2, a3, a4] = self.angle;
        // d atan(2 eps/(pi root))/d eps = 2/(pi root (root^2 + 4 eps^2/pi^2)).
        let falling = R::constant(2.0 / PI) / (root * (root * root + e * e * (4.0 / (PI * PI))));
        polynomial(&[a1, 2.0 * a2, 3.0 * a3, 4.0 * a4], e) * half - polynomial(&self.angle, e) * falling
    }

    /// Side flow Q3/(D^3 psi w).
    #[inline(always)]
    pub fn flow<R: Real>(&self, place: &Place<R>) -> R {
        place.eccentricity * polynomial(&self.flow, place.eccentricity)
    }
}

/// A polynomial with coefficients from that of the power zero on.
#[inline(always)]
fn polynomial<R: Real>(coefficients: &[f64], x: R) -> R {
    let mut sum = R::ZERO;
    for coefficient in coefficients.iter().rev() {
        sum = sum * x + *coefficient;
    }
    sum
}

#[cfg(test)]
mod tests {
    use gearloss_framework::real::{Dual, Points as _};
    use proptest::prelude::*;

    use super::*;

    fn at(eccentricity: f64) -> Place<f64> {
        Place::new(eccentricity / (1.0 - eccentricity))
    }

    /// So, beta in degrees, mu/psi and Q3/(D^3 psi w).
    fn values(functions: &Characteristics, eccentricity: f64) -> [f64; 4] {
        let place = at(eccentricity);
        let (load, _) = functions.load(&place);
        let sine = functions.sine_of_angle(&place);
        let friction = PI / (load * place.root()) + 0.5 * eccentricity * sine;
        [load, sine.asin().to_degrees(), friction, functions.flow(&place)]
    }

    #[track_caller]
    fn close(value: f64, expected: f64, tolerance: f64) {
        assert!((value / expected - 1.0).abs() < tolerance, "{value} against {expected}");
    }

    /// Values of the polynomials, calculated independently.
    #[test]
    fn the_fit_of_din_31652() {
        for (width, expected) in [(1.0, [1.29702, 50.849, 3.26036]), (0.5, [0.492_140, 48.635, 8.20457])] {
            let found = values(&Characteristics::new(FilmFit::Din31652, width), 0.6);
            for (value, expected) in found.iter().zip(expected) {
                close(*value, expected, 1e-5);
            }
        }
    }

    /// Own solution of the Reynolds equation with the boundary condition of Reynolds: finite volumes, 180 x 20 and 360 x 40 cells, extrapolated.
    /// B/D, eps, So, beta in degrees, mu/psi, Q3/(D^3 psi w).
    const SOLVED: [[f64; 6]; 14] = [
        [0.25, 0.2, 0.021002, 75.378, 152.77, 0.012303],
        [0.25, 0.6, 0.14765, 46.817, 26.815, 0.036916],
        [0.25, 0.9, 2.1609, 21.786, 3.5024, 0.055455],
        [0.5, 0.2, 0.078332, 75.13, 41.030, 0.02349],
        [0.5, 0.6, 0.49846, 48.05, 8.1013, 0.07045],
        [0.5, 0.9, 5.0939, 23.56, 1.5948, 0.10618],
        [0.75, 0.6, 0.91433, 49.397, 4.5227, 0.097652],
        [1.0, 0.2, 0.25192, 73.86, 12.824, 0.04001],
        [1.0, 0.6, 1.3160, 50.53, 3.2157, 0.11731],
        [1.0, 0.8, 3.5718, 36.23, 1.7023, 0.15506],
        [1.0, 0.9, 8.4559, 26.48, 1.0530, 0.17387],
        [1.25, 0.6, 1.6711, 51.378, 2.5843, 0.13034],
        [1.5, 0.4, 1.0016, 62.654, 3.5999, 0.095053],
        [1.5, 0.9, 10.064, 28.182, 0.92867, 0.19996],
    ];

    #[test]
    fn the_own_fit_follows_the_own_solution() {
        for [width, eccentricity, load, angle, friction, flow] in SOLVED {
            let [so, beta, mu, q] = values(&Characteristics::new(FilmFit::Reynolds, width), eccentricity);
            close(so, load, 0.009);
            assert!((beta - angle).abs() < 0.3, "{beta} against {angle}");
            close(mu, friction, 0.007);
            close(q, flow, 0.003);
        }
    }

    /// So and the tangent of the attitude angle from finite volumes of the half bearing: pressure p psi^2/(eta w) of zero at the widest gap and at the
    /// side, never below zero, by relaxation.
    fn solved(width: f64, eccentricity: f64, around: usize, across: usize) -> [f64; 2] {
        let (step, side) = (2.0 * PI / around as f64, 1.0 / across as f64);
        let gap = |i: f64| 1.0 + eccentricity * (i * step).cos();
        let mut p = vec![vec![0.0_f64; across]; around + 1];
        for _ in 0..10 * around {
            for i in 1..around {
                let [before, here, after] = [-0.5, 0.0, 0.5].map(|half| gap(i as f64 + half));
                let (west, east) = ((before / step).powi(2) * before, (after / step).powi(2) * after);
                let along = here.powi(3) / (width * side).powi(2);
                let source = 6.0 * (after - before) / step;
                for j in 0..across {
                    let inner = if j > 0 { along } else { 0.0 };
                    let (outer, beside) = if j + 1 < across {
                        (along, p[i][j + 1])
                    } else {
                        (2.0 * along, 0.0)
                    };
                    let inflow = east * p[i + 1][j] + west * p[i - 1][j] + outer * beside;
                    let inflow = inflow + inner * p[i][j.saturating_sub(1)];
                    let balanced = (inflow - source) / (east + west + inner + outer);
                    p[i][j] = (p[i][j] + 1.8 * (balanced - p[i][j])).max(0.0);
                }
            }
        }
        let force = |part: fn(f64) -> f64| -> f64 {
            let rows = p
                .iter()
                .enumerate()
                .map(|(i, row)| part(i as f64 * step) * row.iter().sum::<f64>());
            0.5 * rows.sum::<f64>() * step * side
        };
        let (along, across) = (-force(f64::cos), force(f64::sin));
        [along.hypot(across), across / along]
    }

    #[test]
    fn the_own_fit_follows_finite_volumes() {
        for (width, eccentricity) in [(0.25, 0.9), (0.5, 0.6), (1.0, 0.2), (1.5, 0.6)] {
            let (coarse, fine) = (
                solved(width, eccentricity, 90, 10),
                solved(width, eccentricity, 180, 20),
            );
            // The error falls with the square of the step.
            let [load, tangent] = std::array::from_fn(|k| fine[k] + (fine[k] - coarse[k]) / 3.0);
            let [so, beta, ..] = values(&Characteristics::new(FilmFit::Reynolds, width), eccentricity);
            close(so, load, 0.009);
            assert!((beta - tangent.atan().to_degrees()).abs() < 0.3, "{beta}");
        }
    }

    /// Its distance from the own solution where the fit is accepted, and why it is refused beyond.
    #[test]
    fn the_fit_of_din_31652_follows_the_own_solution_up_to_a_width_of_the_diameter() {
        for [width, eccentricity, load, angle, friction, flow] in SOLVED.iter().filter(|row| row[0] <= DIN_WIDEST) {
            let [so, beta, mu, q] = values(&Characteristics::new(FilmFit::Din31652, *width), *eccentricity);
            close(so, *load, 0.10);
            assert!((beta - angle).abs() < 2.5, "{beta} against {angle}");
            close(mu, *friction, 0.11);
            close(q, *flow, 0.03);
        }
        let x = 1.25;
        let place = at(0.6);
        let wide = polynomial(&DIN_FACTOR, x) * 0.5 * x * x * 1.5 * (PI * PI * 0.64 + 16.0 * 0.36_f64).sqrt()
            / (1.6 * 1.6 * (polynomial(&END, x) - 0.6));
        assert!((place.ratio - 1.5).abs() < 1e-12);
        close(wide, 1.6 * 1.6711, 0.02);
    }

    /// What the polynomials of DIN 31652 differ from the own solution, in percent: B/D, eps, load, friction.
    #[test]
    fn the_fit_of_din_31652_differs_as_stated() {
        for [width, eccentricity, of_load, of_friction] in [
            [1.0, 0.2, -1.0, 1.0],
            [1.0, 0.6, -1.4, 1.4],
            [1.0, 0.8, 2.9, -2.9],
            [1.0, 0.9, 4.5, -3.8],
            [0.5, 0.2, -3.1, 3.2],
            [0.5, 0.6, -1.3, 1.3],
            [0.5, 0.9, 5.6, -5.1],
        ] {
            let [_, _, load, _, friction, _] = solution(width, eccentricity);
            let [so, _, mu, _] = values(&Characteristics::new(FilmFit::Din31652, width), eccentricity);
            let differences = [(so / load - 1.0) * 100.0, (mu / friction - 1.0) * 100.0];
            for (found, stated) in differences.iter().zip([of_load, of_friction]) {
                assert!((found - stated).abs() < 0.06, "{found} % against {stated} %");
            }
        }
    }

    /// The row of the own solution.
    fn solution(width: f64, eccentricity: f64) -> [f64; 6] {
        let of = |row: &&[f64; 6]| row[..2] == [width, eccentricity];
        *SOLVED.iter().find(of).expect("a row")
    }

    /// Raimondi and Boyd 1958, quoted from memory: B/D, eps, S = 1/(2 pi So), f/psi with f the coefficient of friction.
    #[test]
    fn raimondi_and_boyd() {
        for [width, eccentricity, s, f] in [
            [1.0, 0.2, 0.631, 12.8],
            [1.0, 0.6, 0.121, 3.22],
            [1.0, 0.8, 0.0446, 1.70],
            [1.0, 0.9, 0.0188, 1.05],
            [0.5, 0.2, 2.03, 40.9],
            [0.5, 0.6, 0.319, 8.10],
            [0.5, 0.9, 0.0313, 1.60],
        ] {
            let [_, _, load, _, friction, _] = solution(width, eccentricity);
            close(1.0 / (2.0 * PI * load), s, 0.0035);
            close(friction, f, 0.0035);
            let [so, _, mu, _] = values(&Characteristics::new(FilmFit::Reynolds, width), eccentricity);
            close(1.0 / (2.0 * PI * so), s, 0.009);
            close(mu, f, 0.009);
        }
    }

    /// Infinitely narrow bearings, exactly: So = (B/D)^2 eps/(2 (1 - eps^2)^2) sqrt(pi^2 (1 - eps^2) + 16 eps^2) for the pressures above zero.
    #[test]
    fn narrow_bearings_tend_to_the_solution_without_circumferential_pressure_flow() {
        for eccentricity in [0.2, 0.5, 0.7] {
            let e2: f64 = eccentricity * eccentricity;
            let width = 0.02;
            let narrow =
                width * width * eccentricity / (2.0 * (1.0 - e2).powi(2)) * (PI * PI * (1.0 - e2) + 16.0 * e2).sqrt();
            let [so, ..] = values(&Characteristics::new(FilmFit::Reynolds, width), eccentricity);
            // The shape is held at B/D = 0.2, where the pressure flow along the circumference matters by as much.
            close(so, narrow, 0.07);
        }
    }

    proptest! {
        #[test]
        fn the_load_is_carried_at_the_place_that_is_found(
            exponent in -8.0..12.0_f64, width in 0.05..3.0_f64, din in any::<bool>()
        ) {
            let fit = if din { FilmFit::Din31652 } else { FilmFit::Reynolds };
            let functions = Characteristics::new(fit, width);
            let wanted = 10.0_f64.powf(exponent);
            let place = functions.place(wanted);
            let (load, slope) = functions.load(&place);
            prop_assert!((load / wanted - 1.0).abs() < 1e-13, "{load} for {wanted}");
            prop_assert!(slope > 0.0 && place.eccentricity <= 1.0 && place.room > 0.0);
            // The implicit function: d eps/d So = 1/(d So/d eps).
            let derived = functions.place(Dual::variable(wanted, 0));
            prop_assert_eq!(derived.eccentricity.value.to_bits(), place.eccentricity.to_bits());
            prop_assert!((derived.room.slopes[0] * slope + 1.0).abs() < 1e-10);
        }

        #[test]
        fn a_higher_load_leaves_a_thinner_film(exponent in -6.0..8.0_f64, width in 0.05..3.0_f64) {
            let functions = Characteristics::new(FilmFit::Reynolds, width);
            let room = |so: f64| functions.place(so).room;
            prop_assert!(room(1.01 * 10.0_f64.powf(exponent)) < room(10.0_f64.powf(exponent)));
        }
    }

    #[test]
    fn without_load_the_shaft_is_in_the_middle() {
        let place = Characteristics::new(FilmFit::Reynolds, 0.5).place(Dual::variable(0.0, 0));
        assert_eq!((place.eccentricity.value, place.room.value), (0.0, 1.0));
        assert!(place.eccentricity.slopes[0] > 0.0 && place.eccentricity.at_point(0) == 0.0);
    }
}
