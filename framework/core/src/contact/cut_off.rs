//! The integral along the path of contact of a law that is cut off at limits.
//!
//! The law itself is smooth on each section. Its cut-off is a kink at a point that depends on load, speed and oil. The coefficients at
//! the few points of a section, times load, are interpolated to many, cut off there and summed. Those of a law that grows without bound
//! where sliding vanishes are interpolated times sliding velocity too.

use super::path::Path;
use crate::geometry::gauss;
use crate::mechanism::tooth_friction::{FrictionLimits, KINKED, PathNode, Range};
use crate::real::{Mask as _, Real};

/// One of the many points of a section.
#[derive(Clone, Copy)]
struct FinePoint {
    /// What multiplies the coefficient of friction before it is interpolated.
    scale: f64,
    /// Sliding power per scaled friction, normal force and speed of the first gear.
    weight: f64,
}

/// A path prepared for a law with limits.
pub(crate) struct CutOff {
    limits: FrictionLimits,
    /// Number of points on each section.
    order: usize,
    /// The weights of both rules: of the points of a section, and of its many points.
    rules: [Vec<f64>; 2],
    /// Factors that interpolate values at the points of a section to its many points.
    factors: Vec<f64>,
    /// What multiplies the coefficient of friction at each point before it is interpolated.
    scales: Vec<f64>,
    /// The many points of each section.
    fine: Vec<FinePoint>,
}

impl CutOff {
    /// A path of sections with a number of points for a law with limits.
    pub fn new(path: &Path, order: usize, limits: FrictionLimits) -> Self {
        let scale = |node: &PathNode| node.share * if limits.diverges { node.sliding } else { 1.0 };
        let rules = [order, KINKED].map(gauss::rule);
        let prepared = Self {
            limits,
            order,
            factors: gauss::interpolation(&rules[0], &rules[1]),
            rules: rules.map(|rule| rule.into_iter().map(|node| gauss::graded(node).1).collect()),
            scales: path.nodes().iter().map(scale).collect(),
            fine: Vec::new(),
        };
        prepared.weighted(path)
    }

    /// The same for the path with other weights.
    pub fn weighted(mut self, path: &Path) -> Self {
        let [few, many] = &self.rules;
        let sections = path.weights().chunks(self.order).zip(self.scales.chunks(self.order));
        let fine = sections.flat_map(|(weights, scales)| {
            // Without load there is no power.
            let scaled = |i: usize| match scales[i] {
                0.0 => 0.0,
                scale => weights[i] / (few[i] * scale),
            };
            let places = self.factors.chunks(self.order).zip(many);
            places.map(move |(factors, weight)| FinePoint {
                scale: factors.iter().zip(scales).map(|(factor, scale)| factor * scale).sum(),
                weight: weight
                    * factors
                        .iter()
                        .enumerate()
                        .map(|(i, factor)| factor * scaled(i))
                        .sum::<f64>(),
            })
        });
        self.fine = fine.collect();
        self
    }

    /// Sliding power per normal force and speed of the first gear, for friction at each point before it is cut off. \[m\]
    #[inline(always)]
    pub fn sliding<R: Real>(&self, path: &Path, mu: &[R]) -> R {
        let FrictionLimits { least, greatest, .. } = self.limits;
        let mut sum = R::ZERO;
        for (section, fine) in self.fine.chunks(KINKED).enumerate() {
            let [start, end] = [section, section + 1].map(|i| i * self.order);
            let before = sum;
            for (mu, weight) in mu[start..end].iter().zip(&path.weights()[start..end]) {
                sum += self.limits.cut_off(*mu) * *weight;
            }
            // A kink may be between the last point of one section and the first of the next.
            let mut range = Range::default();
            for i in start.max(1) - 1..(end + 1).min(mu.len()) {
                range.extend(&path.nodes()[i], mu[i]);
            }
            let has_kink = range.is_cut_off([least, greatest]);
            if !has_kink.any() {
                continue;
            }
            let mut cut_off = before;
            for (factors, place) in self.factors.chunks(self.order).zip(fine) {
                let mut scaled = R::ZERO;
                for ((factor, scale), mu) in factors.iter().zip(&self.scales[start..end]).zip(&mu[start..end]) {
                    scaled += *mu * (*factor * *scale);
                }
                cut_off += scaled.at_least(least * place.scale).at_most(greatest * place.scale) * place.weight;
                R::end_pass();
            }
            sum = R::select(has_kink, cut_off, sum);
        }
        sum
    }
}
