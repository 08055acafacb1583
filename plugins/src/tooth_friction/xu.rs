//! Regression of an EHL friction model for gear contacts.
//!
//! Source: Xu, Kahraman, Anderson, Maddock: Prediction of mechanical efficiency of parallel-axis gear pairs, J. Mech. Des. 129
//! (2007) 58-68: mu = exp(f) P^b2 |SR|^b3 V^b6 nu0^b7 R^b8 with f = b1 + b4 |SR| P lg nu0 + b5 exp(-|SR| P lg nu0) + b9 exp(S);
//! P in GPa, V mean rolling speed in m/s, nu0 dynamic viscosity at the inlet in mPa s, R in m, S composite roughness in um rms.
//! Fitted for a 75W-90 gear oil; it has no parameter for the kind of oil. Not for S above about 1 um, where exp(S) grows too fast,
//! nor for oils near 1 mPa s, where lg nu0 vanishes.

use std::f64::consts::LOG10_E;

use gearloss_framework::loss::{Notes, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, PathAt, PathNode, ToothFriction, ToothFrictionLaw,
};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::checks::SIX_DIGITS;

/// Design range of the regression, quoted from memory.
const FROM: &str = "design range of the regression, quoted from memory";
limits! {
    PRESSURE = ("P_h", "Hertzian pressure", "GPa", 0.5, 2.5, FROM);
    SLIDE_ROLL = ("SR", "slide-to-roll ratio", "-", 0.0, 1.0, FROM);
    VISCOSITY = ("nu0", "dynamic viscosity of the oil", "mPa s", 6.0, 75.0, FROM);
    ROLLING = ("V_e", "entraining velocity", "m/s", 1.0, 25.0, FROM);
    RADIUS = ("R", "effective radius of curvature", "mm", 5.0, 40.0, FROM);
    ROUGHNESS = ("S", "surface roughness", "um", 0.05, 0.6, FROM);
}
observed! { MU = ("mu", "-", "coefficient of friction"); }

/// Roughness that is used as S.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Roughness {
    /// Composite rms roughness of both flanks, as intended by the regression.
    #[default]
    CompositeRms,
    /// Mean Ra of the flanks, as used by some programs.
    Ra,
}

coefficients! {
    /// Regression coefficients b1 to b9 of Xu.
    pub struct Constants {
        /// Constant of f.
        b1 = -8.916465, in -17.83293..=-4.4582325;
        /// Exponent of the Hertz pressure in GPa.
        b2 = 1.03303, in 0.516515..=2.06606;
        /// Exponent of the slide-to-roll ratio.
        b3 = 1.036077, in 0.5180385..=2.072154;
        /// Factor of |SR| P lg nu0 in f.
        b4 = -0.354068, in -0.708136..=-0.177034;
        /// Factor of the exponential of -|SR| P lg nu0 in f.
        b5 = 2.812084, in 1.406042..=5.624168;
        /// Exponent of the mean rolling speed in m/s.
        b6 = -0.100601, in -0.201202..=-0.0503005;
        /// Exponent of the dynamic viscosity in mPa s.
        b7 = 0.752755, in 0.3763775..=1.50551;
        /// Exponent of the radius of curvature in m.
        b8 = -0.390958, in -0.781916..=-0.195479;
        /// Factor of the exponential of the roughness in um in f.
        b9 = 0.620305, in 0.3101525..=1.24061;
    }
}

/// Regression of an EHL friction model for gear contacts.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Xu {
    /// Roughness that is used as S.
    #[serde(default)]
    pub roughness: Roughness,
    #[serde(default)]
    coefficients: Constants,
}

impl Roughness {
    /// S of the regression. \[um\]
    #[inline(always)]
    fn composite<R: Real>(self, ra: R, rq: R) -> R {
        match self {
            Self::CompositeRms => rq.um(),
            Self::Ra => ra.um(),
        }
    }
}

/// The viscosity at the inlet in mPa s, with its note and that of the roughness in um.
#[inline(always)]
fn check_oil<R: Real>(notes: Notes<'_, R>, eta: R, s: R) -> Result<R, Undefined> {
    let eta = notes.check(&VISCOSITY, eta.mpa_s());
    notes.check(&ROUGHNESS, s);
    // Below 1 mPa s the logarithm changes sign and the trend of friction reverses.
    if eta.is_above(R::constant(1.0)).all() {
        Ok(eta)
    } else {
        Err(Undefined {
            what: "viscosity at the inlet [mPa s], at most 1",
            value: eta.extremes(1).0,
        })
    }
}

impl ToothFrictionLaw for Xu {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let s = self.roughness.composite(at.ra, at.rq);
        let nu0 = check_oil(at.notes, at.eta, s)?;
        let p = at.check(&PRESSURE, at.pressure.gpa());
        let sr = at.check(&SLIDE_ROLL, at.slide_roll());
        let v = at.check(&ROLLING, at.sum_speed * 0.5);
        at.check(&RADIUS, at.radius.mm());
        if (sr.is_zero() | p.is_zero()).agreed()? {
            at.branch("no sliding or no load: no friction");
            return Ok(at.observe(&MU, R::ZERO));
        }
        let c = &self.coefficients;
        let x = at.show("|SR| P lg nu0", "-", sr * p * nu0.ln() * LOG10_E);
        let f = x * c.b4 + (-x).exp() * c.b5 + s.exp() * c.b9 + c.b1;
        let f = at.show("f", "-", f);
        let powers = p.ln() * c.b2 + sr.ln() * c.b3 + v.ln() * c.b6;
        let powers = powers + nu0.ln() * c.b7 + at.radius.ln() * c.b8;
        Ok(at.observe(&MU, finite((f + powers).exp())?))
    }

    /// The same law; what does not change along the path is computed once, and logarithms of the geometry are known.
    #[inline(always)]
    fn along<R: Real>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let c = &self.coefficients;
        let s = self.roughness.composite(path.ra, path.rq);
        let nu0 = check_oil(path.notes, path.eta, s)?;
        let [steady, lg_nu0] = path.notes.once(
            #[inline(always)]
            || {
                let ln_nu0 = nu0.ln();
                let steady = s.exp() * c.b9 + path.speed.ln() * c.b6 + ln_nu0 * c.b7 + c.b1;
                [steady, ln_nu0 * LOG10_E]
            },
        );
        // Without load the logarithm is minus infinity, and friction is zero.
        let unit = path.unit_pressure().gpa();
        let common = steady + unit.ln() * c.b2;
        let fall = -(unit * lg_nu0);
        // One function per loop: the steps of a number depend on each other, those of different nodes do not.
        for (node, mu) in path.nodes.iter().zip(&mut *mu) {
            *mu = fall * (node.slide_roll * node.root_load);
            R::end_pass();
        }
        for mu in &mut *mu {
            *mu = mu.exp();
        }
        for (node, mu) in path.nodes.iter().zip(&mut *mu) {
            let x = fall * (node.slide_roll * node.root_load);
            *mu = common + geometry(c, node) - x * c.b4 + *mu * c.b5;
            R::end_pass();
        }
        for mu in &mut *mu {
            *mu = mu.exp();
        }
        for end in 0..2 {
            path.notes.check(&PRESSURE, unit * path.extent.root_load[end]);
            path.notes.check(&SLIDE_ROLL, R::constant(path.extent.slide_roll[end]));
            path.notes
                .check(&ROLLING, path.speed * (0.5 * path.extent.sum_speed[end]));
            path.notes.check(&RADIUS, R::constant(path.extent.radius[end].mm()));
        }
        let (mut least, mut most) = (R::constant(f64::INFINITY), R::ZERO);
        for mu in &*mu {
            least = least.min(*mu);
            most = most.max(*mu);
        }
        path.notes.observe(&MU, least);
        path.notes.observe(&MU, finite(most)?);
        Ok(Along::default())
    }
}

/// Contribution of a node to the exponent.
#[inline(always)]
fn geometry(c: &Constants, node: &PathNode) -> f64 {
    c.b2 * node.ln_root_load + c.b3 * node.ln_slide_roll + c.b6 * node.ln_rolling + c.b8 * node.ln_radius
}

register!(ToothFriction, "xu", Xu,
    source: "Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58-68, doi 10.1115/1.2359478",
    example: "{ type: xu }",
    evidence: [
        formula(Evidence::SeveralSources, "coefficients agree in two independent transcriptions"),
        default_of("roughness", Evidence::OneSource, "the regression uses the composite rms value"),
    ],
    checks: [
        Check {
            input: "{ model: { type: xu, roughness: composite_rms }, at: { sliding: 3 m/s, sum_speed: 20 m/s, radius: 10 mm, \
                    pressure: 1 GPa, rq: 0.4 um, eta: 10 mPa s } }",
            values: &[("total", "0.0190746")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: xu, roughness: composite_rms }, at: { sliding: 1 m/s, sum_speed: 40 m/s, radius: 8 mm, \
                    pressure: 1.5 GPa, rq: 0.2 um, eta: 6 mPa s } }",
            values: &[("total", "0.00510914")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: xu, roughness: composite_rms }, at: { sliding: 2.4 m/s, sum_speed: 6 m/s, radius: 5 mm, \
                    pressure: 0.6 GPa, rq: 0.6 um, eta: 50 mPa s } }",
            values: &[("total", "0.0682874")],
            ..SIX_DIGITS
        },
    ],
    limits: [PRESSURE, SLIDE_ROLL, VISCOSITY, ROLLING, RADIUS, ROUGHNESS], observed: [MU]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gear_mesh::path_integral::tests::fzg_c14;
    use gearloss_framework::coefficients::Coefficients as _;
    use gearloss_framework::mechanism::NoPart;
    use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
    use gearloss_framework::mechanism::tooth_friction::PathExtent;

    fn law() -> Xu {
        Xu {
            roughness: Roughness::CompositeRms,
            coefficients: Constants::PUBLISHED,
        }
    }

    fn mu(sr: f64, p: f64, eta: f64, s: f64, v: f64, r: f64) -> f64 {
        let at = ContactAt::usual(&NoPart {}, Notes::MUTED).with(|to| {
            to.sliding = sr * v;
            to.sum_speed = 2.0 * v;
            to.radius = r;
            to.pressure = p * 1e9;
            to.rq = s * 1e-6;
            to.eta = eta * 1e-3;
        });
        law().mu(&at).unwrap()
    }

    #[test]
    fn without_sliding_there_is_no_friction() {
        assert_eq!(mu(0.0, 1.0, 10.0, 0.4, 10.0, 0.01), 0.0);
    }

    #[test]
    fn along_the_path_is_the_same_law_node_by_node() {
        let nodes: Vec<PathNode> = (0..9)
            .map(|i| {
                PathNode::new(
                    0.001 + 0.002 * f64::from(i),
                    0.03 + 0.001 * f64::from(i),
                    0.008,
                    0.5 + 0.05 * f64::from(i),
                )
            })
            .collect();
        let part = fzg_c14(0.4e-6, 0.5e-6);
        let extent = PathExtent::from_nodes(&nodes);
        let mean = MeanFrictionAt::usual(&part, Notes::MUTED);
        let path = PathAt::new(&nodes, &extent, &mean, Notes::MUTED).with(|to| {
            to.speed = 300.0;
            to.line_load = 2e5;
        });
        let mut along = [0.0; 9];
        law().along(&path, &mut along).unwrap();
        for (node, mu) in nodes.iter().zip(along) {
            assert!((law().mu(&path.contact(node)).unwrap() / mu - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn every_constant_is_that_of_the_paper() {
        let table = crate::printed::Printed::read(include_str!("../../tests/tables/xu.csv"));
        for (line, constant) in table.rows().zip(Constants::LIST) {
            line.is("value", constant.published);
        }
        assert_eq!(table.rows().count(), Constants::LIST.len());
    }
}
