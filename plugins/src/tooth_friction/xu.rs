//! Regression of an EHL friction model for gear contacts.
//!
//! Source: Xu, Kahraman, Anderson, Maddock: Prediction of mechanical efficiency of parallel-axis gear pairs, J. Mech. Des. 129
//! (2007) 58-68: mu = exp(f) P^b2 |SR|^b3 V^b6 nu0^b7 R^b8 with f = b1 + b4 |SR| P lg nu0 + b5 exp(-|SR| P lg nu0) + b9 exp(S);
//! P in GPa, V mean rolling speed in m/s, nu0 dynamic viscosity at the inlet in mPa s, R in m, S composite roughness in um rms.
//! Fitted for a 75W-90 gear oil; it has no parameter for the kind of oil. Not for S above about 1 um, where exp(S) grows too fast,
//! nor for oils near 1 mPa s, where lg nu0 vanishes.

mod series;

use std::f64::consts::LOG10_E;

use gearloss_framework::lanes::{Lane, LaneNotes, Powers, each, exp, ln, over, wide};
use gearloss_framework::loss::{Notes, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::tooth_friction::{
    Along, ContactAt, PathAt, PathNode, ToothFriction, ToothFrictionModel, WeightedFriction,
};
use gearloss_framework::registry::{Evidence, default_of, formula};
use gearloss_framework::{coefficients, limits, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use series::Series;

/// Design range of the regression, quoted from memory.
const FROM: &str = "design range of the regression, quoted from memory";
limits! {
    PRESSURE = ("P_h", "GPa", 0.5, 2.5, FROM);
    SLIDE_ROLL = ("SR", "-", 0.0, 1.0, FROM);
    VISCOSITY = ("nu0", "mPa s", 6.0, 75.0, FROM);
    ROLLING = ("V_e", "m/s", 1.0, 25.0, FROM);
    RADIUS = ("R", "mm", 5.0, 40.0, FROM);
    ROUGHNESS = ("S", "um", 0.05, 0.6, FROM);
}
observed! { MU = ("mu", "-", "Coefficient of friction."); }

/// Allowed error of a logarithm of friction.
const ROUNDING: f64 = 1e-13;

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
    fn composite(self, ra: f64, rq: f64) -> f64 {
        match self {
            Self::CompositeRms => rq.um(),
            Self::Ra => ra.um(),
        }
    }
}

fn check_oil(notes: Notes<'_>, eta: f64, s: f64) -> Result<f64, Undefined> {
    let eta = notes.check(&VISCOSITY, eta.mpa_s());
    notes.check(&ROUGHNESS, s);
    // Below 1 mPa s the logarithm changes sign and the trend of friction reverses.
    if eta <= 1.0 {
        Err(Undefined {
            what: "viscosity at the inlet [mPa s], at most 1",
            value: eta,
        })
    } else {
        Ok(eta)
    }
}

impl ToothFrictionModel for Xu {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        let s = self.roughness.composite(at.ra, at.rq);
        let nu0 = check_oil(at.notes, at.eta, s)?;
        let p = at.check(&PRESSURE, at.pressure.gpa());
        let sr = at.check(&SLIDE_ROLL, at.slide_roll());
        let v = at.check(&ROLLING, 0.5 * at.sum_speed);
        at.check(&RADIUS, at.radius.mm());
        if sr == 0.0 || p == 0.0 {
            at.branch("no sliding or no load: no friction");
            return Ok(at.observe(&MU, 0.0));
        }
        let c = &self.coefficients;
        let x = at.show("|SR| P lg nu0", "-", sr * p * nu0.log10());
        let f = at.show("f", "-", c.b1 + c.b4 * x + c.b5 * (-x).exp() + c.b9 * s.exp());
        let mu = (f + c.b2 * p.ln() + c.b3 * sr.ln() + c.b6 * v.ln() + c.b7 * nu0.ln() + c.b8 * at.radius.ln()).exp();
        if mu.is_finite() {
            Ok(at.observe(&MU, mu))
        } else {
            Err(Undefined {
                what: "coefficient of friction",
                value: mu,
            })
        }
    }

    fn along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        let s = self.roughness.composite(path.ra, path.rq);
        let nu0 = check_oil(path.notes, path.eta, s)?;
        let unit = unit_pressure(path.line_load, path.modulus);
        if unit == 0.0 {
            mu.fill(0.0);
            return Ok(Along::default());
        }
        let along = Common::new(&self.coefficients, path, s, nu0);
        let (common, fall) = (along.common(ln(unit)), along.fall(unit));
        walk(&self.coefficients, path, common, fall, mu);
        let [least, most] = ends(mu);
        for end in 0..2 {
            path.notes.check(&PRESSURE, unit * path.extent.root_load[end]);
            path.notes.check(&SLIDE_ROLL, path.extent.slide_roll[end]);
            path.notes
                .check(&ROLLING, 0.5 * path.extent.sum_speed[end] * path.speed);
            path.notes.check(&RADIUS, path.extent.radius[end].mm());
        }
        path.notes.observe(&MU, least);
        path.notes.observe(&MU, most);
        if most.is_finite() {
            Ok(Along::default())
        } else {
            Err(Undefined {
                what: "coefficient of friction",
                value: most,
            })
        }
    }

    fn along_lanes(&self, path: &PathAt<'_>, line_loads: &Lane, mu: &mut [Lane]) -> bool {
        let s = self.roughness.composite(path.ra, path.rq);
        let Ok(nu0) = check_oil(Notes::MUTED, path.eta, s) else {
            return false;
        };
        let c = &self.coefficients;
        let along = Common::new(c, path, s, nu0);
        wide(
            #[inline(always)]
            || {
                let units = over(line_loads, |line_load| unit_pressure(line_load, path.modulus));
                let commons = over(
                    &units,
                    #[inline(always)]
                    |unit| along.common(ln(unit)),
                );
                let falls = over(&units, |unit| along.fall(unit));
                for (node, mu) in path.nodes.iter().zip(&mut *mu) {
                    let geometry = geometry(c, node);
                    *mu = each(
                        #[inline(always)]
                        |i| {
                            let x = falls[i] * node.slide_roll * node.root_load;
                            exp(commons[i] + geometry - c.b4 * x + c.b5 * exp(x))
                        },
                    );
                }
            },
        );
        true
    }

    fn weighted(&self, nodes: &[PathNode], weights: &[f64]) -> Option<Box<dyn WeightedFriction>> {
        Some(Box::new(Weighted {
            roughness: self.roughness,
            coefficients: self.coefficients,
            series: Series::new(&self.coefficients, nodes, weights),
        }))
    }

    fn note_lanes(&self, path: &PathAt<'_>, line_loads: &Lane, mu: &[Lane], notes: LaneNotes<'_>) {
        note_ranges(self.roughness, path, line_loads, notes.range(line_loads), notes);
        let (mut least, mut greatest) = (Lane::all(f64::INFINITY), Lane::all(0.0));
        wide(
            #[inline(always)]
            || {
                for mu in mu {
                    least = each(|i| if mu[i] < least[i] { mu[i] } else { least[i] });
                    greatest = each(|i| if mu[i] > greatest[i] { mu[i] } else { greatest[i] });
                }
            },
        );
        notes.observe(&MU, &least, &greatest);
    }
}

/// Notes all limits without iterating over the path; `range` has the minimum and maximum line load.
fn note_ranges(
    roughness: Roughness,
    path: &PathAt<'_>,
    line_loads: &Lane,
    range: Option<(f64, f64)>,
    notes: LaneNotes<'_>,
) {
    let _ = check_oil(path.notes, path.eta, roughness.composite(path.ra, path.rq));
    let root_load = path.extent.root_load;
    let noted = range.is_some_and(|(low, high)| {
        let [low, high] = [low, high].map(|line_load| unit_pressure(line_load, path.modulus));
        let [least, greatest] = root_load.map(|root_load| (low * root_load, high * root_load));
        notes.check_range(&PRESSURE, least, greatest)
    });
    if !noted {
        let [least, greatest] = wide(
            #[inline(always)]
            || {
                root_load.map(
                    #[inline(always)]
                    |root_load| {
                        over(line_loads, |line_load| {
                            unit_pressure(line_load, path.modulus) * root_load
                        })
                    },
                )
            },
        );
        notes.check(&PRESSURE, &least, &greatest);
    }
    for end in 0..2 {
        path.notes.check(&SLIDE_ROLL, path.extent.slide_roll[end]);
        path.notes
            .check(&ROLLING, 0.5 * path.extent.sum_speed[end] * path.speed);
        path.notes.check(&RADIUS, path.extent.radius[end].mm());
    }
}

/// The law summed along one path.
struct Weighted {
    roughness: Roughness,
    coefficients: Constants,
    series: Series,
}

impl Weighted {
    fn common(&self, path: &PathAt<'_>) -> Option<Common> {
        let s = self.roughness.composite(path.ra, path.rq);
        let nu0 = check_oil(Notes::MUTED, path.eta, s).ok()?;
        Some(Common::new(&self.coefficients, path, s, nu0))
    }
}

impl WeightedFriction for Weighted {
    fn sum(&self, path: &PathAt<'_>) -> f64 {
        let unit = unit_pressure(path.line_load, path.modulus);
        let along = self.common(path);
        along.map_or(f64::NAN, |along| {
            self.series.sum_at(-along.fall(unit)) * power(self.coefficients.b2, unit) * along.factor
        })
    }

    fn sums(&self, path: &PathAt<'_>, line_loads: &Lane, powers: &mut Powers) -> Lane {
        let Some(along) = self.common(path) else {
            return Lane::all(f64::NAN);
        };
        let b2 = self.coefficients.b2;
        wide(
            #[inline(always)]
            || {
                let units = over(line_loads, |line_load| unit_pressure(line_load, path.modulus));
                let raised = powers.raise(0, |i| units[i], b2, |unit| power(b2, unit));
                let sums = self.series.lanes(&over(&units, |unit| -along.fall(unit)));
                each(|i| sums[i] * raised[i] * along.factor)
            },
        )
    }

    fn note(&self, path: &PathAt<'_>, line_loads: &Lane, notes: LaneNotes<'_>) -> bool {
        let (Some(along), Some(range)) = (self.common(path), notes.range(line_loads)) else {
            return false;
        };
        let [low, high] = [range.0, range.1].map(|line_load| unit_pressure(line_load, path.modulus));
        let c = &self.coefficients;
        let at = |unit: f64| -along.fall(unit);
        let seen = notes.seen(&MU);
        // One loop, so that the lanes do not wait for each other.
        let mut logarithms = [low, high, seen.0, seen.1];
        wide(
            #[inline(always)]
            || {
                for number in &mut logarithms {
                    *number = ln(*number);
                }
            },
        );
        let [ln_low, ln_high, ln_least, ln_greatest] = logarithms;
        // Once friction has been observed above and below, a path adds nothing. Usually common bounds for all loads show this: the
        // common part increases with load, and the rest decreases.
        let (Some([below, _]), Some([_, above])) = (self.series.bounds(at(high)), self.series.bounds(at(low))) else {
            return false;
        };
        if along.common(ln_low) + below >= ln_least + ROUNDING
            && along.common(ln_high) + above <= ln_greatest - ROUNDING
        {
            notes.observe_range(&MU, seen.0, seen.1);
            note_ranges(self.roughness, path, line_loads, Some(range), notes);
            return true;
        }
        // Otherwise only the points at which friction might be the minimum or maximum of the path matter.
        let Some(places) = self.series.places(at(low), at(high)) else {
            return false;
        };
        let (least, greatest) = wide(
            #[inline(always)]
            || {
                let units = over(line_loads, |line_load| unit_pressure(line_load, path.modulus));
                let commons = over(
                    &units,
                    #[inline(always)]
                    |unit| along.common(ln(unit)),
                );
                let falls = over(&units, |unit| along.fall(unit));
                let (mut least, mut greatest) = (Lane::all(f64::INFINITY), Lane::all(f64::NEG_INFINITY));
                for (_, node) in path.nodes.iter().enumerate().filter(|(k, _)| places >> k & 1 == 1) {
                    let geometry = geometry(c, node);
                    let exponents = each(
                        #[inline(always)]
                        |i| {
                            let x = falls[i] * node.slide_roll * node.root_load;
                            commons[i] + geometry - c.b4 * x + c.b5 * exp(x)
                        },
                    );
                    least = each(|i| {
                        if exponents[i] < least[i] {
                            exponents[i]
                        } else {
                            least[i]
                        }
                    });
                    greatest = each(|i| {
                        if exponents[i] > greatest[i] {
                            exponents[i]
                        } else {
                            greatest[i]
                        }
                    });
                }
                (over(&least, exp), over(&greatest, exp))
            },
        );
        notes.observe(&MU, &least, &greatest);
        note_ranges(self.roughness, path, line_loads, Some(range), notes);
        true
    }
}

/// Friction at each node of a path, from the common part of the exponent and from its decrease.
fn walk(c: &Constants, path: &PathAt<'_>, common: f64, fall: f64, mu: &mut [f64]) {
    wide(
        #[inline(always)]
        || {
            for (node, mu) in path.nodes.iter().zip(&mut *mu) {
                *mu = fall * node.slide_roll * node.root_load;
            }
            for mu in &mut *mu {
                *mu = exp(*mu);
            }
            for (node, mu) in path.nodes.iter().zip(&mut *mu) {
                let x = fall * node.slide_roll * node.root_load;
                *mu = common + geometry(c, node) - c.b4 * x + c.b5 * *mu;
            }
            for mu in &mut *mu {
                *mu = exp(*mu);
            }
        },
    );
}

/// Minimum and maximum friction of a path.
fn ends(mu: &[f64]) -> [f64; 2] {
    [
        mu.iter().fold(f64::INFINITY, |least, mu| least.min(*mu)),
        mu.iter().fold(0.0, |most: f64, mu| most.max(*mu)),
    ]
}

/// Hertz pressure per `root_load` of a node. \[GPa m^0.5\]
#[inline(always)]
fn unit_pressure(line_load: f64, modulus: f64) -> f64 {
    (line_load * (modulus / (2.0 * std::f64::consts::PI))).sqrt() * 1e-9
}

/// Factor from the unit of pressure.
#[inline(always)]
fn power(b2: f64, unit: f64) -> f64 {
    exp(b2 * ln(unit))
}

/// Contribution of a node to the exponent.
#[inline(always)]
fn geometry(c: &Constants, node: &PathNode) -> f64 {
    c.b2 * node.ln_root_load + c.b3 * node.ln_slide_roll + c.b6 * node.ln_rolling + c.b8 * node.ln_radius
}

/// The quantities that are constant along a path under every load.
struct Common {
    b2: f64,
    b7: f64,
    rough: f64,
    speed: f64,
    ln_nu0: f64,
    /// The exponential of all terms but the unit of pressure.
    factor: f64,
}

impl Common {
    fn new(c: &Constants, path: &PathAt<'_>, s: f64, nu0: f64) -> Self {
        let [rough, speed, ln_nu0, factor] = path.notes.once(|| {
            let (rough, speed, ln_nu0) = (c.b1 + c.b9 * exp(s), c.b6 * ln(path.speed), ln(nu0));
            [rough, speed, ln_nu0, exp(rough + speed + c.b7 * ln_nu0)]
        });
        Self {
            b2: c.b2,
            b7: c.b7,
            rough,
            speed,
            ln_nu0,
            factor,
        }
    }

    /// The part of the exponent that is constant along the path, from the logarithm of the unit of pressure in GPa.
    #[inline(always)]
    fn common(&self, ln_unit: f64) -> f64 {
        self.rough + self.b2 * ln_unit + self.speed + self.b7 * self.ln_nu0
    }

    /// -P lg nu0 per slide-to-roll ratio and `root_load`.
    #[inline(always)]
    fn fall(&self, unit: f64) -> f64 {
        -unit * self.ln_nu0 * LOG10_E
    }
}

register!(ToothFriction, "xu", Xu,
    source: "Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58-68, doi 10.1115/1.2359478",
    example: "{ type: xu }",
    evidence: [
        formula(Evidence::SeveralSources, "coefficients agree in two independent transcriptions"),
        default_of("roughness", Evidence::OneSource, "the regression uses the composite rms value"),
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
    fn b7_published_form() {
        for (value, printed) in [
            (mu(0.3, 1.0, 10.0, 0.4, 10.0, 0.01), 0.0190746),
            (mu(0.05, 1.5, 6.0, 0.2, 20.0, 0.008), 0.00510914),
            (mu(0.8, 0.6, 50.0, 0.6, 3.0, 0.005), 0.0682874),
        ] {
            assert!((value / printed - 1.0).abs() < 1e-5, "{value} {printed}");
        }
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
        let path = PathAt::new(&nodes, &extent, 0.02, &mean, Notes::MUTED).with(|to| {
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
        for (line, own) in table.rows().zip(Constants::LIST) {
            line.is("value", own.published);
        }
        assert_eq!(table.rows().count(), Constants::LIST.len());
    }
}
