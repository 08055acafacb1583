//! The friction of Xu and others, summed over a path with the weights of its points, as piecewise polynomials.
//!
//! Along a path the coefficient at point k is `exp(common + g_k - b4 x_k + b5 exp(x_k))` with `x_k = -t s_k`. `common` and `t`
//! contain load, speed and oil; `g_k` and `s_k` are geometry. The weighted sum without `exp(common)` is therefore a smooth function
//! of `t` alone. Polynomials through its values on pieces of `t` reproduce it to rounding, at a twentieth of the cost. The law is
//! the same, and so is the quadrature along the path.

use std::f64::consts::PI;

use gearloss_framework::lanes::{LANES, Lane, count, exp, over, wide};
use gearloss_framework::mechanism::tooth_friction::PathNode;

use super::{Constants, geometry};

/// Terms of the polynomials.
const TERMS: usize = 16;
/// Number of pieces with a polynomial.
const PIECES: usize = 16;
/// Number of pieces with bounds.
const BOUNDS: usize = 64;
/// Number of pieces with bounds per piece with a polynomial.
const FINER: f64 = (BOUNDS / PIECES) as f64;
/// Maximum deviation of the exponent at a point from the line through its ends over a piece with bounds: an eighth of the square of
/// the piece times the maximum second derivative.
fn sag(b5: f64) -> f64 {
    0.125 * b5 * (REACH / BOUNDS as f64) * (REACH / BOUNDS as f64)
}
/// The maximum tabulated `t s` along the path: slide-to-roll ratio times pressure in GPa times lg of the viscosity in mPa s.
const REACH: f64 = 8.0;

/// A weighted sum over a path, prepared.
#[derive(Debug)]
pub struct Series {
    /// Pieces with a polynomial per unit of `t`.
    scale: f64,
    /// Coefficients of powers from -1 to 1 over each piece.
    pieces: Vec<[f64; TERMS]>,
    /// Lines below and above every exponent along the path, minus `common`: value and slope over each piece.
    bounds: Vec<[(f64, f64); 2]>,
    /// For each of these pieces the points, as bits, whose exponent might be the minimum or maximum somewhere in it; empty for a
    /// path with more points than bits.
    ends: Vec<u64>,
}

impl Series {
    /// The sum of the friction at some nodes with these weights.
    pub fn new(c: &Constants, nodes: &[PathNode], weights: &[f64]) -> Self {
        let sag = sag(c.b5);
        let steepest = nodes.iter().map(steepness).fold(f64::MIN_POSITIVE, f64::max);
        let scale = PIECES as f64 * steepest / REACH;
        let exponents = |t: f64| {
            let exponent = move |node: &PathNode| {
                let x = -t * node.slide_roll * node.root_load;
                geometry(c, node) - c.b4 * x + c.b5 * exp(x)
            };
            nodes.iter().map(exponent)
        };
        let sum = |t: f64| -> f64 { exponents(t).zip(weights).map(|(exponent, w)| w * exp(exponent)).sum() };
        let pieces = (0..PIECES).map(|piece| {
            let values = wide(
                #[inline(always)]
                || std::array::from_fn(|k| sum((piece as f64 + 0.5 + 0.5 * place(k)) / scale)),
            );
            powers(&values)
        });
        // Every exponent is convex in `t`: it is below the line through its ends over a piece, and above that line minus `sag`.
        let lines: Vec<Vec<f64>> = (0..=BOUNDS)
            .map(|end| exponents(end as f64 / (scale * FINER)).collect())
            .collect();
        let extremes: Vec<[f64; 2]> = lines
            .iter()
            .map(|line| {
                let [least, greatest] = line
                    .iter()
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], x| {
                        [x.min(least), x.max(greatest)]
                    });
                [least - sag, greatest]
            })
            .collect();
        let bounds = extremes
            .array_windows()
            .map(|[start, end]| [0, 1].map(|k| (start[k], end[k] - start[k])));
        let apart = sag + super::ROUNDING;
        // A point without load or sliding has an exponent of minus infinity everywhere, and is not below another such point.
        let ends = lines.array_windows().map(|[start, end]| {
            let surely_below = |a: usize, b: usize| start[a] + apart < start[b] && end[a] + apart < end[b];
            let all = 0..nodes.len();
            let is_end = |k: &usize| {
                !all.clone().any(|other| surely_below(other, *k)) || !all.clone().any(|other| surely_below(*k, other))
            };
            all.clone().filter(is_end).fold(0, |ends, k| ends | 1 << k)
        });
        Self {
            scale,
            pieces: pieces.collect(),
            bounds: bounds.collect(),
            ends: if nodes.len() <= u64::BITS as usize {
                ends.collect()
            } else {
                Vec::new()
            },
        }
    }

    /// The sum at `t`, without `exp(common)`; NaN outside the range.
    pub fn sum_at(&self, t: f64) -> f64 {
        let number = (t * self.scale) as usize;
        let piece = self.pieces.get(number);
        piece.map_or(f64::NAN, |piece| self.on_piece(piece, number, t))
    }

    /// The sums in all lanes.
    #[inline(always)]
    pub fn lanes(&self, t: &Lane) -> Lane {
        let first = (t[0] * self.scale) as usize;
        let (start, end) = (first as f64, first as f64 + 1.0);
        match self.pieces.get(first) {
            // Similar loads share a piece.
            Some(piece) if count(|i| t[i] * self.scale >= start && t[i] * self.scale < end) == LANES as u64 => over(
                t,
                #[inline(always)]
                |t| self.on_piece(piece, first, t),
            ),
            _ => over(t, |t| self.sum_at(t)),
        }
    }

    #[inline(always)]
    fn on_piece(&self, piece: &[f64; TERMS], number: usize, t: f64) -> f64 {
        let x = 2.0 * (t * self.scale - number as f64) - 1.0;
        let x_2 = x * x;
        let x_4 = x_2 * x_2;
        let two = |n: usize| piece[n] + piece[n + 1] * x;
        let four = |n: usize| two(n) + two(n + 2) * x_2;
        four(0) + four(4) * x_4 + (four(8) + four(12) * x_4) * (x_4 * x_4)
    }

    /// Bounds below and above every exponent along the path at `t`, minus `common`; `None` outside the range.
    pub fn bounds(&self, t: f64) -> Option<[f64; 2]> {
        let place = t * (self.scale * FINER);
        let number = place as usize;
        let lines = self.bounds.get(number)?;
        Some(lines.map(|(start, rise)| start + rise * (place - number as f64)))
    }

    /// The points, as bits, whose exponent might be the minimum or maximum at some `t` between two values; `None` if that is not
    /// known.
    pub fn places(&self, low: f64, high: f64) -> Option<u64> {
        let [first, last] = [low, high].map(|t| (t * (self.scale * FINER)) as usize);
        Some(self.ends.get(first..=last)?.iter().fold(0, |all, ends| all | ends))
    }
}

fn steepness(node: &PathNode) -> f64 {
    node.slide_roll * node.root_load
}

/// Chebyshev points on a piece from -1 to 1.
fn place(k: usize) -> f64 {
    ((k as f64 + 0.5) * PI / TERMS as f64).cos()
}

/// Coefficients of powers from values at the Chebyshev points, by Chebyshev polynomials, whose coefficients decrease so fast that
/// no precision is lost.
fn powers(values: &[f64; TERMS]) -> [f64; TERMS] {
    let mut powers = [0.0; TERMS];
    // The Chebyshev polynomials of degree n and n - 1.
    let (mut own, mut before) = ([0.0; TERMS], [0.0; TERMS]);
    own[0] = 1.0;
    for n in 0..TERMS {
        let turned = |k: usize| (n as f64 * (k as f64 + 0.5) * PI / TERMS as f64).cos();
        let sum: f64 = values.iter().enumerate().map(|(k, value)| value * turned(k)).sum();
        let coefficient = sum * (if n == 0 { 1.0 } else { 2.0 }) / TERMS as f64;
        for (power, own) in powers.iter_mut().zip(own) {
            *power += coefficient * own;
        }
        let twice = if n == 0 { 1.0 } else { 2.0 };
        let raised = |power: usize| if power > 0 { twice * own[power - 1] } else { 0.0 };
        let next = std::array::from_fn(|power| raised(power) - before[power]);
        (before, own) = (own, next);
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path with fast and slow points, one of them close to the pitch point.
    fn nodes() -> Vec<PathNode> {
        (0..12)
            .map(|i| {
                let i = f64::from(i);
                PathNode::new(1e-6 + 0.0011 * i, 0.03 + 0.001 * i, 0.006 + 0.0005 * i, 0.4 + 0.05 * i)
            })
            .collect()
    }

    #[test]
    fn the_sum_is_that_of_the_nodes() {
        let nodes = nodes();
        let weights: Vec<f64> = (0..12).map(|i| 0.3 + 0.1 * f64::from(i)).collect();
        let series = Series::new(&Constants::PUBLISHED, &nodes, &weights);
        let c = Constants::PUBLISHED;
        let end = PIECES as f64 / series.scale;
        let mut places = 0;
        for i in 0..2000 {
            let t = end * (f64::from(i) + 0.37) / 2000.0;
            let (mut sum, mut least, mut greatest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
            let (mut least_end, mut greatest_end) = (f64::INFINITY, f64::NEG_INFINITY);
            let ends = series.places(t, t).unwrap_or(0);
            for (k, (node, weight)) in nodes.iter().zip(&weights).enumerate() {
                let x = -t * node.slide_roll * node.root_load;
                let exponent = geometry(&c, node) - c.b4 * x + c.b5 * x.exp();
                sum += weight * exponent.exp();
                least = exponent.min(least);
                greatest = exponent.max(greatest);
                if ends >> k & 1 == 1 {
                    least_end = exponent.min(least_end);
                    greatest_end = exponent.max(greatest_end);
                }
            }
            assert!(least_end == least && greatest_end == greatest, "{t}: {ends:b}");
            places += ends.count_ones();
            assert!(
                (series.sum_at(t) / sum - 1.0).abs() < 2e-14,
                "{t}: {} against {sum}",
                series.sum_at(t)
            );
            let [below, above] = series.bounds(t).unwrap_or([0.0; 2]);
            assert!(below <= least && greatest <= above);
            // The bounds are close; otherwise they would save nothing.
            assert!(
                above - greatest < 0.1 && least - below < 0.1,
                "{t}: {below} {least} {greatest} {above}"
            );
        }
        // A quarter of the points on average; otherwise they would save little.
        assert!(f64::from(places) / 2000.0 <= 3.0, "{places}");
        assert!(series.sum_at(1.001 * end).is_nan() && series.bounds(1.001 * end).is_none());
        assert!(series.places(0.5 * end, 1.001 * end).is_none());
    }

    #[test]
    fn places_without_load_have_the_least_friction() {
        let mut nodes = nodes();
        for unloaded in [0, 11] {
            nodes[unloaded] = PathNode::new(0.002, 0.03, 0.006, 0.0);
        }
        let series = Series::new(&Constants::PUBLISHED, &nodes, &[1.0; 12]);
        let end = PIECES as f64 / series.scale;
        for i in 0..100 {
            let t = end * (f64::from(i) + 0.37) / 100.0;
            let ends = series.places(t, t).unwrap_or(0);
            assert!(ends & 1 == 1 && ends >> 11 & 1 == 1, "{ends:b}");
            assert!(ends & 0x7FE != 0, "one with the maximum as well: {ends:b}");
        }
    }
}
