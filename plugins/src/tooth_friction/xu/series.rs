//! The friction of Xu and others, summed over a path with the weights of its places, as pieces of polynomials.
//!
//! Along a path the coefficient at the place k is `exp(common + g_k - b4 x_k + b5 exp(x_k))` with `x_k = -t s_k`. Under `common` and `t`
//! stand load, speed and oil; `g_k` and `s_k` are geometry. The weighted sum without `exp(common)` is therefore a function of `t`
//! alone, and a smooth one: polynomials of degree [`DEGREE`] through its values on pieces of `t` are as close as rounding, at a
//! twentieth of the work. The law is the same, and so is the rule by which the path is integrated.

use std::f64::consts::PI;

use gearloss_framework::lanes::{exp, wide};
use gearloss_framework::mechanism::tooth_friction::PathNode;

use super::{B, geometry};

/// Degree of the polynomials.
const DEGREE: usize = 9;
/// Pieces of the range.
const PIECES: usize = 64;
/// The greatest `t s` along the path that is tabulated: slide-roll ratio times pressure in GPa times lg of the viscosity in mPa s.
const REACH: f64 = 8.0;

/// A weighted sum over a path, prepared.
#[derive(Debug)]
pub struct Series {
    /// Pieces per unit of `t`.
    scale: f64,
    /// Coefficients of powers from -1 to 1 over each piece.
    pieces: Vec<[f64; DEGREE + 1]>,
    /// Least and greatest exponent along the path, less `common`, at the end of each piece that has the lesser ones, and at the other.
    bounds: Vec<[f64; 2]>,
}

impl Series {
    /// The sum of the friction at some nodes with these weights.
    pub fn new(nodes: &[PathNode], weights: &[f64]) -> Self {
        let steepest = nodes.iter().map(steepness).fold(f64::MIN_POSITIVE, f64::max);
        let scale = PIECES as f64 * steepest / REACH;
        let exponents = |t: f64| {
            let exponent = move |node: &PathNode| {
                let x = -t * node.slide_roll * node.root_load;
                geometry(node) - B[3] * x + B[4] * exp(x)
            };
            nodes.iter().map(exponent)
        };
        let sum = |t: f64| -> f64 { exponents(t).zip(weights).map(|(exponent, w)| w * exp(exponent)).sum() };
        let to_powers = to_powers();
        let pieces = (0..PIECES).map(|piece| {
            let values: [f64; DEGREE + 1] = wide(
                #[inline(always)]
                || std::array::from_fn(|k| sum((piece as f64 + 0.5 + 0.5 * place(k)) / scale)),
            );
            std::array::from_fn(|power| to_powers[power].iter().zip(values).map(|(m, value)| m * value).sum())
        });
        // Every exponent falls with `t`.
        let bounds = (0..PIECES).map(|piece| {
            let [start, end] = [piece, piece + 1].map(|end| end as f64 / scale);
            [
                exponents(end).fold(f64::INFINITY, f64::min),
                exponents(start).fold(f64::NEG_INFINITY, f64::max),
            ]
        });
        Self {
            scale,
            pieces: pieces.collect(),
            bounds: bounds.collect(),
        }
    }

    /// The sum at `t`, without `exp(common)`; no number beyond the range.
    #[inline(always)]
    pub fn at(&self, t: f64) -> f64 {
        let along = t * self.scale;
        let number = along as usize;
        let Some(piece) = self.pieces.get(number) else {
            return f64::NAN;
        };
        let x = 2.0 * (along - number as f64) - 1.0;
        let x_2 = x * x;
        let x_4 = x_2 * x_2;
        let two = |n: usize| piece[n] + piece[n + 1] * x;
        let four = |n: usize| two(n) + two(n + 2) * x_2;
        four(0) + four(4) * x_4 + two(8) * (x_4 * x_4)
    }

    /// Numbers below and above every exponent along the path at `t`, less `common`.
    pub fn bounds(&self, t: f64) -> Option<[f64; 2]> {
        self.bounds.get((t * self.scale) as usize).copied()
    }
}

fn steepness(node: &PathNode) -> f64 {
    node.slide_roll * node.root_load
}

/// Places of the values on a piece from -1 to 1, after Chebyshev.
fn place(k: usize) -> f64 {
    ((k as f64 + 0.5) * PI / (DEGREE + 1) as f64).cos()
}

/// The matrix from values at the places to coefficients of powers.
fn to_powers() -> [[f64; DEGREE + 1]; DEGREE + 1] {
    const N: usize = DEGREE + 1;
    // Coefficients of the Chebyshev polynomials.
    let mut polynomials = [[0.0; N]; N];
    polynomials[0][0] = 1.0;
    polynomials[1][1] = 1.0;
    for n in 2..N {
        for power in 0..N {
            let raised = if power > 0 {
                2.0 * polynomials[n - 1][power - 1]
            } else {
                0.0
            };
            polynomials[n][power] = raised - polynomials[n - 2][power];
        }
    }
    let mut matrix = [[0.0; N]; N];
    for k in 0..N {
        for (n, polynomial) in polynomials.iter().enumerate() {
            let angle = n as f64 * (k as f64 + 0.5) * PI / N as f64;
            let weight = angle.cos() * if n == 0 { 1.0 } else { 2.0 } / N as f64;
            for power in 0..N {
                matrix[power][k] += weight * polynomial[power];
            }
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path with fast and slow places, one of them close to the pitch point.
    fn nodes() -> Vec<PathNode> {
        (0..12)
            .map(|i| {
                let i = f64::from(i);
                PathNode::new(1e-6 + 0.0011 * i, 0.03 + 0.001 * i, 0.006 + 0.0005 * i, 0.4 + 0.05 * i)
            })
            .collect()
    }

    #[test]
    fn the_sum_is_that_of_the_nodes_to_rounding() {
        let nodes = nodes();
        let weights: Vec<f64> = (0..12).map(|i| 0.3 + 0.1 * f64::from(i)).collect();
        let series = Series::new(&nodes, &weights);
        let end = PIECES as f64 / series.scale;
        for i in 0..2000 {
            let t = end * (f64::from(i) + 0.37) / 2000.0;
            let (mut sum, mut least, mut greatest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
            for (node, weight) in nodes.iter().zip(&weights) {
                let x = -t * node.slide_roll * node.root_load;
                let exponent = geometry(node) - B[3] * x + B[4] * x.exp();
                sum += weight * exponent.exp();
                least = exponent.min(least);
                greatest = exponent.max(greatest);
            }
            assert!(
                (series.at(t) / sum - 1.0).abs() < 1e-13,
                "{t}: {} against {sum}",
                series.at(t)
            );
            let [below, above] = series.bounds(t).unwrap_or([0.0; 2]);
            assert!(below <= least && greatest <= above);
            // The bounds are close, or they would spare nothing.
            assert!(
                above - greatest < 0.7 && least - below < 0.7,
                "{t}: {below} {least} {greatest} {above}"
            );
        }
        assert!(series.at(1.001 * end).is_nan() && series.bounds(1.001 * end).is_none());
    }
}
