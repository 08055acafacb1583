//! Mixed friction: boundary and fluid friction, weighted by the film ratio.
//!
//! Sources, as collected by Arana et al. 2019: mu = xi mu_S + (1 - xi) mu_F with the share xi of boundary friction
//! - Doleschel 2002: (1 - lambda/2)^2 below lambda = 2, else 0; lambda = h/((Ra1 + Ra2)/2);
//! - Matsumoto and Morikawa 2014: 0.5 lg((Rz1 + Rz2)/h_min), from 0 to 1;
//! - Diab 2006: (1 - erf(lambda/sqrt 2))/4; lambda = h over the rms roughness of both flanks;
//! - Olver and Spikes 1998: 1/(1 + Lambda)^m with m = 2; Lambda = h over the rms roughness of both flanks.
//!
//! The film thickness is the central one, reduced by inlet heating (by a factor of twenty at most, where the fit ends); the minimum
//! one for Matsumoto. Boundary and fluid friction are separate laws: constants (0.08 to 0.135 and 0.02 to 0.04 are typical),
//! `doleschel`, `eyring`.

use std::f64::consts::{FRAC_1_SQRT_2, LOG10_E};

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, KINKED, PathAt, Range, SMOOTH, ToothFriction, ToothFrictionLaw,
};
use gearloss_framework::mechanism::{Answers, ShopUnits};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use gearloss_framework::{limits, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gearloss_framework::contact::path::with_space;
use gearloss_framework::contact::{self, Film, Films};

use super::finite;

limits! {
    SUM_SPEED = ("v_S", "sum of the surface velocities", "m/s", 0.0, 100.0,
        "assumed, not stated by a source; at zero speed there is no film, only boundary friction");
}
observed! {
    MU = ("mu", "-", "coefficient of friction");
    LAMBDA = ("lambda", "-", "film thickness over roughness, as defined by the weight");
    XI = ("xi", "-", "share of boundary friction");
    THICKNESS = ("h", "um", "film thickness");
}

/// Share of boundary friction as a function of the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Weight {
    /// Parabola to a film ratio of two.
    Doleschel,
    /// Logarithm of roughness over the minimum film thickness.
    Matsumoto,
    /// Error function.
    Diab,
    /// Power of one plus the film ratio.
    OlverSpikes,
}

/// Boundary and fluid friction, weighted by the film ratio.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Share of boundary friction as a function of the film.
    pub weight: Weight,
    /// Boundary friction.
    pub boundary: ModelRef<ToothFriction>,
    /// Fluid friction.
    pub fluid: ModelRef<ToothFriction>,
    /// Film thickness formula; default: the minimum film for Matsumoto, else the central film.
    pub film: Option<Film>,
    /// Inlet heating thins the film.
    #[serde(default = "yes")]
    pub thermal: bool,
    /// Exponent of Olver and Spikes. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub exponent: f64,
    /// Rz over Ra, for Matsumoto. [-]
    #[serde(default = "six")]
    #[schemars(range(min = 2.0, max = 12.0))]
    pub rz_over_ra: f64,
}

fn yes() -> bool {
    true
}
fn two() -> f64 {
    2.0
}
fn six() -> f64 {
    6.0
}

struct Mixed {
    params: Params,
    film: Film,
    boundary: Slot<ToothFriction>,
    fluid: Slot<ToothFriction>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Mixed, Diagnostic> {
    let boundary = cx.slot("boundary", &params.boundary)?;
    let fluid = cx.slot("fluid", &params.fluid)?;
    let film = params.film.unwrap_or(match params.weight {
        Weight::Matsumoto => Film::DowsonHigginson,
        _ => Film::HamrockDowson,
    });
    Ok(Mixed {
        params,
        film,
        boundary,
        fluid,
    })
}

/// Share of boundary friction from the film ratio; for Matsumoto the ratio is film thickness over (Rz1 + Rz2).
#[inline(always)]
fn share<R: Real>(weight: Weight, lambda: R, exponent: f64) -> R {
    let one = R::constant(1.0);
    match weight {
        Weight::Doleschel => {
            let rest = (one - lambda * 0.5).at_least(0.0);
            rest * rest
        }
        Weight::Matsumoto => (lambda.ln() * (-0.5 * LOG10_E)).at_least(0.0).at_most(1.0),
        Weight::Diab => (one - erf(lambda * FRAC_1_SQRT_2)) * 0.25,
        Weight::OlverSpikes => (lambda + 1.0).power(-exponent),
    }
}

/// Error function for x above zero, Abramowitz and Stegun 7.1.26, within 1.5e-7.
#[inline(always)]
fn erf<R: Real>(x: R) -> R {
    let one = R::constant(1.0);
    let t = one / (x * 0.327_591_1 + 1.0);
    let poly =
        t * (t * (t * (t * (t * 1.061_405_429 - 1.453_152_027) + 1.421_413_741) - 0.284_496_736) + 0.254_829_592);
    one - poly * (-x * x).exp()
}

impl Mixed {
    /// Share of boundary friction in a contact with a film of known thickness.
    #[inline(always)]
    fn share<R: Real>(&self, at: &ContactAt<'_, R>, h: R) -> R {
        at.check(&SUM_SPEED, at.sum_speed);
        at.observe(&THICKNESS, h.um());
        let roughness = match self.params.weight {
            Weight::Doleschel => at.ra,
            Weight::Matsumoto => at.ra * 2.0 * self.params.rz_over_ra,
            Weight::Diab | Weight::OlverSpikes => at.rq,
        };
        let lambda = at.observe(&LAMBDA, h / roughness);
        at.observe(&XI, share(self.params.weight, lambda, self.params.exponent))
    }
}

impl ToothFrictionLaw for Mixed {
    #[inline(always)]
    fn mu<R: Answers>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let xi = self.share(at, contact::film(at, self.film, self.params.thermal));
        let nested = |slot: &Slot<ToothFriction>, weight: R| {
            // A law with zero weight is not evaluated: it may be undefined there, as a film at zero speed.
            let counts = weight.is_above(R::ZERO);
            if !counts.any() {
                return Ok(R::ZERO);
            }
            let at = at.nested(slot).with(|to| to.notes = to.notes.among(counts));
            let mu = R::answer::<ToothFriction>(&**slot, &at)?;
            Ok(R::select(counts, weight * mu, R::ZERO))
        };
        let mu = nested(&self.boundary, xi)? + nested(&self.fluid, R::constant(1.0) - xi)?;
        Ok(at.observe(&MU, finite(mu)?))
    }

    fn order(&self) -> usize {
        self.boundary.order().max(self.fluid.order())
    }

    /// The share of boundary friction vanishes at a film ratio of two, for Matsumoto with a kink.
    fn kinked_order(&self) -> Option<usize> {
        let of_weight = match self.params.weight {
            Weight::Doleschel => Some(2 * SMOOTH),
            Weight::Matsumoto => Some(KINKED),
            Weight::Diab | Weight::OlverSpikes => None,
        };
        let most = of_weight
            .max(self.boundary.cut_off_order())
            .max(self.fluid.cut_off_order());
        most.map(|order| order.max(self.order()))
    }

    #[inline(always)]
    fn along<R: Answers>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let boundary = R::along(&*self.boundary, &path.nested(&self.boundary), mu)?;
        let mut shares = Range::default();
        let fluid = with_space(
            path.nodes.len(),
            #[inline(always)]
            |fluid| {
                let along = R::along(&*self.fluid, &path.nested(&self.fluid), fluid)?;
                let films = Films::new(path, self.film, self.params.thermal);
                for ((node, mu), fluid) in path.nodes.iter().zip(mu).zip(fluid) {
                    let at = path.contact(node);
                    let xi = self.share(&at, films.at(node));
                    shares.extend(node, xi);
                    *mu = at.observe(&MU, xi * *mu + (R::constant(1.0) - xi) * *fluid);
                    R::end_pass();
                }
                Ok(along)
            },
        )?;
        Ok(Along {
            kink: boundary.kink | fluid.kink | shares.is_cut_off([0.0, 1.0]),
            ..Along::default()
        })
    }
}

register!(ToothFriction, "mixed", Params,
    source: "Doleschel 2002; Matsumoto, Morikawa 2014; Diab 2006; Olver, Spikes 1998; collected by Arana et al. 2019",
    example: "{ type: mixed, weight: doleschel, boundary: { type: constant, value: 0.1 }, fluid: { type: constant, value: 0.02 } }",
    evidence: [
        formula(Evidence::OneSource, "weights of Doleschel, Matsumoto and Diab agree in two sources, that of Olver and Spikes has one"),
        default_of("film", Evidence::SeveralSources, "film formulas agree in three sources"),
        default_of("thermal", Evidence::OneSource, "thermal factor from one public source and memory"),
        default_of("exponent", Evidence::OneSource, "Olver and Spikes"),
        default_of("rz_over_ra", Evidence::Assumed, "typical for ground flanks"),
    ],
    limits: [SUM_SPEED], observed: [MU, LAMBDA, XI, THICKNESS], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::NoPart;
    use gearloss_framework::registry::{Files, Registry};
    use std::sync::Arc;

    fn close(value: f64, printed: f64) {
        assert!((value / printed - 1.0).abs() < 1e-5, "{value} against {printed}");
    }

    #[test]
    fn b10_weights() {
        for (lambda, xi) in [(0.5, 0.5625), (1.0, 0.25)] {
            close(share(Weight::Doleschel, lambda, 2.0), xi);
        }
        assert_eq!(share(Weight::Doleschel, 2.5, 2.0), 0.0);
        close(share(Weight::Matsumoto, 1.0 / 25.0, 2.0), 0.69897);
        assert_eq!(
            (share(Weight::Matsumoto, 0.0, 2.0), share(Weight::Matsumoto, 2.0, 2.0)),
            (1.0, 0.0)
        );
        // At zero film ratio a quarter, and at two deviations 2.3 % of a half: erf(sqrt 2) = 0.954500.
        close(share(Weight::Diab, 2.0, 2.0), 0.25 * (1.0 - 0.954500));
        assert!((share(Weight::Diab, 0.0, 2.0) - 0.25).abs() < 1e-8);
    }

    #[test]
    fn b10_doleschel_with_invented_constants() {
        let registry = Registry::linked().unwrap_or_else(|found| panic!("{found:?}"));
        let files = Files::default();
        let mut build = Build::new(&registry, &files);
        let mut law = |value: serde_json::Value| -> f64 {
            let slot = build
                .slot_at::<ToothFriction>("model", &Arc::new(NoPart {}), &value)
                .unwrap();
            let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
                to.pressure = 1.2e9;
                to.sum_speed = 6.0;
                to.eta = 15e-3;
            });
            slot.mu(&at).unwrap()
        };
        let fluid = serde_json::json!({ "type": "doleschel", "mu": 0.020, "pressure": 0.5, "speed": -0.1, "viscosity": -0.05, "reference_speed": 8.3 });
        let boundary = serde_json::json!({ "type": "doleschel", "mu": 0.085, "pressure": 0.1, "speed": -0.05, "viscosity": 0.0, "reference_speed": 0.2 });
        let xi = share(Weight::Doleschel, 0.8, 2.0);
        close(xi * law(boundary.clone()) + (1.0 - xi) * law(fluid.clone()), 0.0409836);
        // The mixed coefficient is between those of the two laws.
        let mixed = law(
            serde_json::json!({ "type": "mixed", "weight": "doleschel", "boundary": boundary, "fluid": fluid,
            "thermal": true, "exponent": 2.0, "rz_over_ra": 6.0 }),
        );
        assert!(mixed > law(fluid) && mixed < law(boundary), "{mixed}");
    }

    #[test]
    fn b11_olver_spikes() {
        let mixed = |f: f64, b: f64, lambda: f64| f + (b - f) * share(Weight::OlverSpikes, lambda, 2.0);
        close(mixed(0.03, 0.13, 0.7), 0.0646021);
        close(mixed(0.02, 0.10, 3.0), 0.025);
    }
}
