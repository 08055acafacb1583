//! Open wet multi-disc clutch or brake: shear of the oil between the discs.
//!
//! Derived for laminar flow between parallel discs, fed at the inner radius. Full film: T = N pi eta dw (r_o^4 - r_i^4)/(2 h).
//! Centrifugal pumping draws more oil outwards than is supplied: dp/dr = rho C r - 6 eta Q/(pi r h^3) with C = 0.3 w1^2 + 0.4 w1 w2 + 0.3 w2^2.
//! `coverage`: beyond r_c = sqrt(6 eta Q/(pi rho C h^3)) the oil covers only the share (r_c/r)^2 of the gap:
//! T = N (pi eta dw (r*^4 - r_i^4)/(2 h) + 6 eta^2 dw Q (r_o^2 - r*^2)/(rho C h^4)), r* = r_c limited to r_i to r_o. The drag
//! rises with speed, peaks when r_c reaches the outer radius, then falls with 1/w, as measured drag does.
//! `pressure_balance`: the film ends where its pressure has fallen to that of the housing, with mist beyond; it
//! collapses within about 15 % of speed, as on plates without grooves.
//! Kitabayashi 2003, Rao 2011 and Iqbal 2013 describe the same mechanism; their coefficients are not public, so their names are
//! not used. Not for touching plates, axially vibrating plates, or turbulent flow (rho w r h/eta above about 1000).

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::clutch::{Clutch, ClutchAt, ClutchModel};
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::checks::SIX_DIGITS;

terms! { SHEAR = no_load("shear"); }
limits! { REYNOLDS = ("Re", "Reynolds number of the gap", "-", 0.0, 1000.0, "laminar flow in the gap"); }
observed! { RADIUS = ("r*", "mm", "radius to which the oil fills the gap"); }

/// Shape of the film once centrifugal pumping exceeds the supply.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Film {
    /// It covers part of the circumference.
    #[default]
    Coverage,
    /// It ends where its pressure has fallen to that of the housing; mist beyond.
    PressureBalance,
    /// It remains complete at any speed.
    Full,
}

coefficients! {
    /// Constants of the centrifugal pumping C according to Hashimoto and others.
    struct Constants {
        /// Factor of the square of either speed in C.
        own_pumping = 0.3, in 0.15..=0.6;
        /// Factor of the product of both speeds in C.
        cross_pumping = 0.4, in 0.0..=0.8;
    }
}

/// Open wet multi-disc clutch or brake: shear of the oil between the discs.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Shape of the film once centrifugal pumping exceeds the supply.
    #[serde(default)]
    pub film: Film,
    /// Total flow to all gaps; not used for a full film. [l/min]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub flow: Option<f64>,
    /// Share of the faces taken up by grooves. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.95))]
    pub groove_share: f64,
    /// Viscosity of the mist beyond the film, for `pressure_balance`. [mPa s]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub mist_viscosity: f64,
    #[serde(default)]
    coefficients: Constants,
}

struct Discs {
    coefficients: Constants,
    film: Film,
    /// Flow of one gap. \[m3/s\]
    flow: f64,
    faces: f64,
    face_share: f64,
    mist: f64,
    r_i: f64,
    r_o: f64,
    gap: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Discs, Diagnostic> {
    let part = cx.own_part::<Clutch>()?;
    let (Some(inner), Some(outer), Some(gap)) = (part.inner_diameter, part.outer_diameter, part.gap) else {
        return Err(cx
            .error("disc_gap requires `inner_diameter`, `outer_diameter` and `gap` of the clutch")
            .help("add them to the clutch"));
    };
    if outer <= inner {
        return Err(cx
            .error("the outer diameter does not exceed the inner diameter")
            .help("swap `inner_diameter` and `outer_diameter`, or correct one"));
    }
    if params.film == Film::Full && params.flow.is_some() {
        return Err(cx
            .error("`flow` is not used for a full film")
            .help("omit `flow`, or choose `film: coverage`"));
    }
    if params.film != Film::PressureBalance && params.mist_viscosity > 0.0 {
        return Err(cx
            .error("`mist_viscosity` applies to `film: pressure_balance` only")
            .help("omit it, or choose `film: pressure_balance`"));
    }
    let faces = f64::from(part.faces);
    let flow = match (params.flow, params.film) {
        (Some(flow), _) => flow / faces,
        (None, Film::Full) => 0.0,
        (None, _) => {
            return Err(cx
                .error("disc_gap requires `flow`, the oil supplied to the gaps")
                .help("add `flow: 3 l/min` with your value, or choose `film: full`"));
        }
    };
    Ok(Discs {
        coefficients: params.coefficients,
        film: params.film,
        flow,
        faces,
        face_share: 1.0 - params.groove_share,
        mist: params.mist_viscosity,
        r_i: 0.5 * inner,
        r_o: 0.5 * outer,
        gap,
    })
}

impl Discs {
    /// Shear moment of one gap between two radii. \[Nm\]
    fn shear(&self, eta: f64, delta: f64, from: f64, to: f64) -> f64 {
        std::f64::consts::PI * eta * delta * (to.powi(4) - from.powi(4)) / (2.0 * self.gap)
    }

    /// Moment of all gaps and the radius of the film, from viscosity, density and both speeds.
    fn moment(&self, eta: f64, rho: f64, w_1: f64, w_2: f64) -> (f64, f64) {
        let (delta, h, q) = ((w_1 - w_2).abs(), self.gap, self.flow);
        let Constants {
            own_pumping,
            cross_pumping,
        } = self.coefficients;
        // The quadratic form has its minimum at opposite speeds; it is not negative for the published constants.
        let pumping = own_pumping * w_1 * w_1 + cross_pumping * w_1 * w_2 + own_pumping * w_2 * w_2;
        let feed = 6.0 * eta * q / (std::f64::consts::PI * h.powi(3));
        let (r_i, r_o) = (self.r_i, self.r_o);
        if self.film == Film::Full || pumping <= 0.0 {
            return (self.total(self.shear(eta, delta, r_i, r_o)), r_o);
        }
        if self.film == Film::Coverage {
            let r = (feed / (rho * pumping)).sqrt().clamp(r_i, r_o);
            let broken = 6.0 * eta * eta * delta * q * (r_o * r_o - r * r) / (rho * pumping * h.powi(4));
            return (self.total(self.shear(eta, delta, r_i, r) + broken), r);
        }
        let r = self.film_end(rho * pumping, feed);
        let mist = self.shear(self.mist, delta, r, r_o);
        (self.total(self.shear(eta, delta, r_i, r) + mist), r)
    }

    fn total(&self, one: f64) -> f64 {
        self.faces * self.face_share * one
    }

    /// Radius at which pumping balances the supply: rho C (r^2 - r_i^2)/2 = feed ln(r/r_i), by bisection; r_o if there is none.
    fn film_end(&self, pumping: f64, feed: f64) -> f64 {
        let (r_i, r_o) = (self.r_i, self.r_o);
        let surplus = |r: f64| 0.5 * pumping * (r * r - r_i * r_i) - feed * (r / r_i).ln();
        if surplus(r_o) <= 0.0 {
            return r_o;
        }
        // Just outside r_i the surplus has the sign of pumping r_i^2 - feed.
        if pumping * r_i * r_i >= feed {
            return r_i;
        }
        let (mut low, mut high) = (r_i * (1.0 + 1e-9), r_o);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if surplus(middle) <= 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

impl ClutchModel for Discs {
    fn loss(&self, at: &ClutchAt<'_>) -> Result<Loss, Undefined> {
        let second = at.first_speed - at.speed;
        let fastest = at.first_speed.abs().max(second.abs());
        at.check(&REYNOLDS, at.rho * fastest * self.r_o * self.gap / at.eta);
        let (moment, radius) = self.moment(at.eta, at.rho, at.first_speed, second);
        at.observe(&RADIUS, radius.mm());
        Ok(Loss::MOMENTS.with(&SHEAR, at.show("T", "Nm", moment)))
    }
}

register!(Clutch, "disc_gap", Params,
    source: "derived: laminar flow between discs with centrifugal pumping (0.3 w^2 according to Hashimoto et al. 1984)",
    example: "{ type: disc_gap, flow: 3 l/min }",
    evidence: [
        formula(Evidence::Derived, "full film is textbook; coverage follows from continuity"),
        default_of("film", Evidence::Derived, "matches the trend of measured drag"),
        default_of("groove_share", Evidence::Assumed, "plain plates"),
        default_of("mist_viscosity", Evidence::Assumed, "no mist"),
    ],
    checks: [
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min }, at: { speed: 1000 rpm, first_speed: 1000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.95542 Nm"), ("r*", "70.0000 mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min, film: pressure_balance }, at: { speed: 1000 rpm, first_speed: 1000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.95542 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, film: full }, at: { speed: 1000 rpm, first_speed: 1000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.95542 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min }, at: { speed: 1400 rpm, first_speed: 1400 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "2.69255 Nm"), ("r*", "66.3746 mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min, film: pressure_balance }, at: { speed: 1400 rpm, first_speed: 1400 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "2.73758 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, film: full }, at: { speed: 1400 rpm, first_speed: 1400 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "2.73758 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min }, at: { speed: 2000 rpm, first_speed: 2000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "2.13059 Nm"), ("r*", "55.0000 mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min, film: pressure_balance }, at: { speed: 2000 rpm, first_speed: 2000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "0 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, film: full }, at: { speed: 2000 rpm, first_speed: 2000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "3.91083 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min }, at: { speed: 4000 rpm, first_speed: 4000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.06529 Nm"), ("r*", "55.0000 mm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min, film: pressure_balance }, at: { speed: 4000 rpm, first_speed: 4000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "0 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, film: full }, at: { speed: 4000 rpm, first_speed: 4000 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "7.82166 Nm")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: disc_gap, flow: 3 l/min }, at: { speed: 800 rpm, first_speed: 1200 rpm, eta: 10 mPa s, rho: 830 kg/m3 } }",
            values: &[("moment", "1.44934 Nm"), ("r*", "62.0877 mm")],
            ..SIX_DIGITS
        },
    ],
    limits: [REYNOLDS], terms: [SHEAR], observed: [RADIUS], prepare: prepare);

#[cfg(test)]
mod tests {
    use super::*;

    fn discs(film: Film) -> Discs {
        Discs {
            coefficients: Constants::PUBLISHED,
            film,
            flow: 0.25e-3 / 60.0,
            faces: 12.0,
            face_share: 1.0,
            mist: 0.0,
            r_i: 0.055,
            r_o: 0.070,
            gap: 0.15e-3,
        }
    }

    fn at(film: Film, n_1: f64, n_2: f64) -> (f64, f64) {
        let w = std::f64::consts::PI / 30.0;
        discs(film).moment(0.010, 830.0, n_1 * w, n_2 * w)
    }

    #[test]
    fn opposite_speeds_and_rest_are_finite() {
        // Pumping has its minimum at opposite speeds, but never reverses.
        assert!(at(Film::Coverage, 1000.0, -1000.0).0.is_finite());
        assert_eq!(at(Film::Coverage, 0.0, 0.0).0, 0.0);
    }
}
