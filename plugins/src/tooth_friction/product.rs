//! Products of powers of what changes along a path of contact, for laws of friction of this form.

use std::f64::consts::LN_2;

use gearloss_framework::mechanism::tooth_friction::{ContactAt, PathAt, PathNode};
use gearloss_framework::real::{LANES, Lane, Points as _, Real};

/// Exponents of the quantities of a contact, in SI.
#[derive(Debug, Clone, Copy)]
pub struct Product {
    /// Of the sliding velocity.
    pub sliding: f64,
    /// Of the sum of the surface speeds.
    pub sum_speed: f64,
    /// Of the radius of relative curvature.
    pub radius: f64,
    /// Of the line load.
    pub line_load: f64,
}

/// The logarithm of a power. What does not count may be zero, whose logarithm is infinite.
#[inline(always)]
fn term<R: Real>(ln: impl FnOnce() -> R, exponent: f64) -> R {
    if exponent == 0.0 { R::ZERO } else { ln() * exponent }
}

impl Product {
    /// The natural logarithm of the product at a contact.
    #[inline(always)]
    pub fn logarithm<R: Real>(&self, at: &ContactAt<'_, R>) -> R {
        term(|| at.sliding.ln(), self.sliding)
            + term(|| at.sum_speed.ln(), self.sum_speed)
            + term(|| at.radius.ln(), self.radius)
            + term(|| at.line_load.ln(), self.line_load)
    }

    /// What the logarithms at all nodes of a path have in common.
    #[inline(always)]
    fn common<R: Real>(&self, path: &PathAt<'_, R>) -> R {
        term(|| path.speed.ln(), self.sliding + self.sum_speed) + term(|| path.line_load.ln(), self.line_load)
    }

    /// What is left of the logarithm at a node.
    #[inline(always)]
    fn at_node(&self, node: &PathNode) -> f64 {
        term(|| node.ln_slide_roll + node.ln_rolling, self.sliding)
            + term(|| node.ln_rolling + LN_2, self.sum_speed)
            + term(|| node.ln_radius, self.radius)
            + term(|| 2.0 * node.ln_root_load + node.ln_radius, self.line_load)
    }

    /// The natural logarithms at all nodes of a path.
    #[inline(always)]
    pub fn logarithms<R: Real>(&self, path: &PathAt<'_, R>, all: &mut [R]) {
        let common = self.common(path);
        for (node, value) in path.nodes.iter().zip(all) {
            *value = common + self.at_node(node);
        }
    }

    /// The products at all nodes of a path, times a factor.
    #[inline(always)]
    pub fn along<R: Real>(&self, path: &PathAt<'_, R>, factor: R, all: &mut [R]) {
        let factor = factor * self.common(path).exp();
        // The nodes are the same at all points, so that a lane holds nodes here.
        for (nodes, all) in path.nodes.chunks(LANES).zip(all.chunks_mut(LANES)) {
            let powers = Lane::each(
                #[inline(always)]
                |i| nodes.get(i).map_or(0.0, |node| self.at_node(node)),
            );
            for (value, power) in all.iter_mut().zip(*powers.exp()) {
                *value = factor * power;
            }
        }
    }
}
