//! Film thickness and its reduction by inlet heating.
//!
//! Sources: Chittenden, Dowson, Dunn, Taylor, J. Tribol. 107 (1985) 381-397 and 398-405 (ellipses in any direction); Hamrock and
//! Dowson 1977 (points); Dowson and Toyoda 1979, Dowson and Higginson 1966, Ertel and Grubin (lines). Inlet heating: Murch and
//! Wilson 1975, Gupta et al. 1992, Wilson and Sheu 1983, Hsu and Lee 1994. U is the mean of both surface speeds throughout,
//! also in L = eta beta U^2/k; Wilson and Sheu use the sum, so their formula takes 4 L. With this interpretation the three laws
//! that depend on L only agree within 4 % in pure rolling up to L = 1; otherwise they do not.

use std::f64::consts::LN_2;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gearloss_framework::contact::thermal_factor;
use gearloss_framework::real::{Points, Real};

/// Film thickness formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Film {
    /// Central film according to Chittenden et al., for a long ellipse with the pressure of the line.
    #[default]
    ChittendenLine,
    /// Central film according to Hamrock and Dowson, for a long ellipse with the pressure of the line.
    HamrockDowsonLine,
    /// Central film of a line contact according to Dowson and Toyoda; a third above the others.
    DowsonToyoda,
    /// Minimum film of a line contact according to Dowson and Higginson.
    DowsonHigginson,
    /// Central film of a line contact according to Ertel and Grubin.
    ErtelGrubin,
}

/// A long ellipse with the pressure of a line of line load w and length L carries (2/3) w L.
const ELLIPSE: f64 = 2.0 / 3.0;

impl Film {
    /// Film over radius from the natural logarithms of U = eta v/(E' R), G = alpha E', W = w/(E' R), and the length of the line over
    /// the radius.
    #[inline(always)]
    pub fn over_radius<R: Real>(self, ln_u: R, ln_g: R, ln_w: R, ln_length: R) -> R {
        let (factor, ellipse, exponents) = match self {
            Self::ChittendenLine => (4.31, true, [0.68, 0.49, -0.073]),
            Self::HamrockDowsonLine => (2.69, true, [0.67, 0.53, -0.067]),
            Self::DowsonToyoda => (3.06, false, [0.69, 0.56, -0.10]),
            Self::DowsonHigginson => (2.65, false, [0.7, 0.54, -0.13]),
            Self::ErtelGrubin => (1.95, false, [8.0 / 11.0, 8.0 / 11.0, -1.0 / 11.0]),
        };
        let ln_w = if ellipse { ln_w + ln_length + ELLIPSE.ln() } else { ln_w };
        (ln_u * exponents[0] + ln_g * exponents[1] + ln_w * exponents[2]).exp() * factor
    }
}

/// Film thinning by inlet heating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InletHeating {
    /// None.
    None,
    /// Murch and Wilson, for pure rolling.
    MurchWilson,
    /// Gupta et al.; thinned by a factor of twenty at most, where the fit ends.
    Gupta,
    /// Wilson and Sheu.
    #[default]
    WilsonSheu,
    /// Hsu and Lee, for line contacts.
    HsuLee,
}

/// The quantities at an inlet on which a thinning factor may depend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inlet<R = f64> {
    /// Mean of both surface speeds. \[m/s\]
    pub speed: R,
    /// Ratio of sliding to that mean.
    pub slide_roll: R,
    /// L = eta beta U^2/k with the mean speed.
    pub thermal_load: R,
    /// Maximum pressure over the reduced modulus.
    pub pressure: R,
    /// G = alpha E'.
    pub g: R,
    /// W = w/(E' R).
    pub w: R,
}

/// Natural logarithms of quantities at an inlet of which thinning factors contain powers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InletLogarithms<R = f64> {
    /// Of the slide-to-roll ratio.
    pub slide_roll: R,
    /// Of L.
    pub thermal_load: R,
    /// Of G.
    pub g: R,
    /// Of W.
    pub w: R,
}

/// Ratio of film thickness to isothermal film thickness. Only one applies, because inlet heating is the cause of corrections for
/// speed.
#[derive(Debug, Clone, Copy)]
pub enum Factor {
    /// By inlet heating.
    Heating(InletHeating),
    /// A user-defined correction, such as one for high speed.
    Own(fn(&Inlet) -> f64),
}

impl Factor {
    /// The ratio.
    #[inline(always)]
    pub fn at<R: Points>(self, at: &Inlet<R>, ln: &InletLogarithms<R>) -> R {
        match self {
            Self::Heating(law) => law.ratio(at, ln),
            Self::Own(law) => R::each(|point| law(&at.at_point(point))),
        }
    }
}

impl<R: Points> Inlet<R> {
    fn at_point(&self, point: usize) -> Inlet {
        Inlet {
            speed: self.speed.at_point(point),
            slide_roll: self.slide_roll.at_point(point),
            thermal_load: self.thermal_load.at_point(point),
            pressure: self.pressure.at_point(point),
            g: self.g.at_point(point),
            w: self.w.at_point(point),
        }
    }
}

impl InletHeating {
    /// The ratio by this law.
    pub fn factor(self) -> Factor {
        Factor::Heating(self)
    }

    #[inline(always)]
    fn ratio<R: Real>(self, at: &Inlet<R>, ln: &InletLogarithms<R>) -> R {
        let one = R::constant(1.0);
        match self {
            Self::None => one,
            Self::MurchWilson => R::constant(3.94) / ((ln.thermal_load * 0.62).exp() + 3.94),
            Self::Gupta => thermal_factor(at.pressure, at.slide_roll, at.thermal_load),
            Self::WilsonSheu => {
                let sliding = ((ln.slide_roll - LN_2) * 0.83).exp() * 14.8 + 1.0;
                one / (sliding * 0.1 * ((ln.thermal_load + 2.0 * LN_2) * 0.64).exp() + 1.0)
            }
            Self::HsuLee => {
                let load = (ln.g * 0.687 + ln.w * 0.447 + ln.thermal_load * 0.527).exp();
                one / (load * 0.0766 * (at.slide_roll * 0.875).exp() + 1.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    const MODULUS: f64 = 206e9 / 0.91;
    const G: f64 = 1.5e-8 * MODULUS;

    fn u(radius: f64) -> f64 {
        0.010 * 5.0 / (MODULUS * radius)
    }

    #[test]
    fn u2d_films_of_a_line() {
        let w = 2.0e5 / (MODULUS * 0.010);
        for (film, printed) in [
            (Film::DowsonToyoda, 3.280002e-7),
            (Film::DowsonHigginson, 2.499398e-7),
            (Film::ErtelGrubin, 2.997698e-7),
            (Film::ChittendenLine, 2.469429e-7),
        ] {
            let [ln_u, ln_g, ln_w, ln_length] = [u(0.010), G, w, 3.0].map(f64::ln);
            close(film.over_radius(ln_u, ln_g, ln_w, ln_length) * 0.010, printed);
        }
    }

    fn inlet(speed: f64, speeds: [f64; 2]) -> Inlet {
        Inlet {
            speed,
            slide_roll: 2.0 * (speeds[0] - speeds[1]).abs() / (speeds[0] + speeds[1]),
            thermal_load: 0.010 * 0.04 * speed * speed / 0.14,
            pressure: 1e9 / MODULUS,
            g: G,
            w: 2.0e5 / (MODULUS * 0.010),
        }
    }

    fn thinned(law: InletHeating, at: &Inlet) -> f64 {
        let ln = InletLogarithms {
            slide_roll: at.slide_roll.ln(),
            thermal_load: at.thermal_load.ln(),
            g: at.g.ln(),
            w: at.w.ln(),
        };
        law.factor().at(at, &ln)
    }

    #[test]
    fn u2e_u2f_inlet_heating() {
        let (slow, fast) = (inlet(5.0, [5.0, 5.0]), inlet(20.0, [22.0, 18.0]));
        close(slow.thermal_load, 0.07142857);
        close(fast.thermal_load, 1.142857);
        for (law, rolling, sliding) in [
            (InletHeating::MurchWilson, 0.9529071, 0.7838748),
            (InletHeating::Gupta, 0.9436282, 0.6858907),
            (InletHeating::WilsonSheu, 0.9570720, 0.5424386),
            (InletHeating::HsuLee, 0.9273623, 0.7131446),
        ] {
            close(thinned(law, &slow), rolling);
            close(thinned(law, &fast), sliding);
        }
    }

    #[test]
    fn the_laws_of_inlet_heating_agree_in_pure_rolling() {
        for step in 1..=20 {
            let at = Inlet {
                thermal_load: 0.05 * f64::from(step),
                pressure: 0.0,
                ..inlet(5.0, [5.0, 5.0])
            };
            let all =
                [InletHeating::MurchWilson, InletHeating::Gupta, InletHeating::WilsonSheu].map(|law| thinned(law, &at));
            let (least, most) = all.iter().fold((1.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
            // At L = 1 they are 3.4 % apart; confusing sum and mean speed would give 15 %.
            assert!(most / least < 1.035, "{all:?}");
        }
    }
}
