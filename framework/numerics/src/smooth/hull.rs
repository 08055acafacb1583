//! The convex hull of points, by whether it contains a point.
//!
//! The point of a convex hull that is nearest to a place is found by the algorithm of Wolfe: affine hulls of few points, of which points leave
//! and into which points enter, until no point is nearer.
//!
//! Source: Wolfe, Finding the nearest point in a polytope, Mathematical Programming 11 (1976) 128-149.

use nalgebra::{DMatrix, DVector};

/// Distance, relative to the range of each coordinate, within which a place belongs to the hull: places on its faces differ by rounding.
const NEAR: f64 = 1e-6;

/// Weights below this are those of points that left an affine hull.
const NO_WEIGHT: f64 = 1e-12;

/// The convex hull of points. A coordinate without a range is left out: a place must have its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// Least value and range of each coordinate.
    ranges: Vec<[f64; 2]>,
    /// The points, each coordinate from zero to one.
    points: Vec<DVector<f64>>,
}

impl Hull {
    /// Of points with equal numbers of coordinates; absent without points, or with a coordinate that is not finite.
    pub fn new(points: &[Vec<f64>]) -> Option<Self> {
        let first = points.first()?;
        let finite = |point: &Vec<f64>| point.len() == first.len() && point.iter().all(|x| x.is_finite());
        if !points.iter().all(finite) {
            return None;
        }
        let range = |k: usize| {
            let of = |ends: [f64; 2], point: &Vec<f64>| [ends[0].min(point[k]), ends[1].max(point[k])];
            let [low, high] = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], of);
            [low, high - low]
        };
        let ranges: Vec<[f64; 2]> = (0..first.len()).map(range).collect();
        let points = points.iter().map(|point| scaled(&ranges, point)).collect();
        Some(Self { ranges, points })
    }

    /// Whether a place is inside or on a face.
    pub fn contains(&self, place: &[f64]) -> bool {
        if place.len() != self.ranges.len() || !place.iter().all(|x| x.is_finite()) {
            return false;
        }
        let place = scaled(&self.ranges, place);
        if place.iter().any(|x| !(-NEAR..=1.0 + NEAR).contains(x)) {
            return false;
        }
        self.distance(&place) <= NEAR
    }

    /// Distance from the hull to a place with scaled coordinates.
    fn distance(&self, place: &DVector<f64>) -> f64 {
        let from: Vec<DVector<f64>> = self.points.iter().map(|point| point - place).collect();
        let nearest = |to: &DVector<f64>| {
            let along = |i: &usize| from[*i].dot(to);
            (0..from.len())
                .min_by(|a, b| along(a).total_cmp(&along(b)))
                .unwrap_or(0)
        };
        let norm = |i: &usize| from[*i].norm_squared();
        let start = (0..from.len()).min_by(|a, b| norm(a).total_cmp(&norm(b))).unwrap_or(0);
        let (mut corners, mut weights) = (vec![start], vec![1.0]);
        // Each round ends in another affine hull of the points: the distance decreases from one to the next.
        for _ in 0..100 + 10 * from.len() {
            let at = combined(&from, &corners, &weights);
            let square = at.norm_squared();
            let next = nearest(&at);
            if square <= NEAR * NEAR * 1e-2 || from[next].dot(&at) >= square * (1.0 - 1e-12) || corners.contains(&next)
            {
                return square.sqrt();
            }
            corners.push(next);
            weights.push(0.0);
            loop {
                let Some(affine) = nearest_of_affine(&from, &corners) else {
                    return square.sqrt();
                };
                if affine.iter().all(|weight| *weight > NO_WEIGHT) {
                    weights = affine;
                    break;
                }
                let share =
                    |(old, new): (&f64, &f64)| (*new <= NO_WEIGHT).then(|| old / (old - new).max(f64::MIN_POSITIVE));
                let step = weights.iter().zip(&affine).filter_map(share).fold(1.0, f64::min);
                for (weight, affine) in weights.iter_mut().zip(&affine) {
                    *weight += step * (affine - *weight);
                }
                let kept: Vec<usize> = (0..corners.len()).filter(|i| weights[*i] > NO_WEIGHT).collect();
                if kept.is_empty() || kept.len() == corners.len() {
                    return square.sqrt();
                }
                corners = kept.iter().map(|i| corners[*i]).collect();
                weights = kept.iter().map(|i| weights[*i]).collect();
            }
        }
        combined(&from, &corners, &weights).norm()
    }
}

/// A point with each coordinate over its range; one without a range is a multiple of its value away.
fn scaled(ranges: &[[f64; 2]], point: &[f64]) -> DVector<f64> {
    let coordinate = |([low, range], x): (&[f64; 2], &f64)| match *range {
        0.0 => (x - low) / low.abs().max(1.0),
        range => (x - low) / range,
    };
    DVector::from_iterator(point.len(), ranges.iter().zip(point).map(coordinate))
}

fn combined(from: &[DVector<f64>], corners: &[usize], weights: &[f64]) -> DVector<f64> {
    let zero = DVector::zeros(from[0].len());
    corners
        .iter()
        .zip(weights)
        .fold(zero, |sum, (corner, weight)| sum + &from[*corner] * *weight)
}

/// Weights, with the sum one, of the point nearest to the origin in the affine hull of some points.
fn nearest_of_affine(from: &[DVector<f64>], corners: &[usize]) -> Option<Vec<f64>> {
    let count = corners.len();
    let entry = |i: usize, j: usize| match (i < count, j < count) {
        (true, true) => from[corners[i]].dot(&from[corners[j]]),
        (false, false) => 0.0,
        _ => 1.0,
    };
    let system = DMatrix::from_fn(count + 1, count + 1, entry);
    let mut right = DVector::zeros(count + 1);
    right[count] = 1.0;
    let solution = system.full_piv_lu().solve(&right)?;
    let weights: Vec<f64> = solution.iter().take(count).copied().collect();
    weights.iter().all(|weight| weight.is_finite()).then_some(weights)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::sampling::Generator;

    #[test]
    fn a_triangle_contains_what_is_inside_and_on_its_faces() {
        let hull = Hull::new(&[vec![0.0, 0.0], vec![4.0, 0.0], vec![0.0, 300.0]]).unwrap();
        for inside in [
            [1.0, 1.0],
            [0.0, 0.0],
            [4.0, 0.0],
            [2.0, 150.0],
            [0.0, 100.0],
            [1.0, 224.9],
        ] {
            assert!(hull.contains(&inside), "{inside:?}");
        }
        for outside in [[2.1, 150.0], [-0.01, 1.0], [4.0, 300.0], [0.0, 301.0], [f64::NAN, 0.0]] {
            assert!(!hull.contains(&outside), "{outside:?}");
        }
    }

    #[test]
    fn a_coordinate_without_a_range_must_have_its_value() {
        let hull = Hull::new(&[vec![1.0, 80.0], vec![2.0, 80.0]]).unwrap();
        assert!(hull.contains(&[1.5, 80.0]));
        assert!(!hull.contains(&[1.5, 80.1]) && !hull.contains(&[2.5, 80.0]));
        assert!(Hull::new(&[]).is_none());
    }

    #[test]
    fn weighted_means_are_inside_and_what_a_plane_separates_is_outside() {
        let mut generator = Generator::new(7);
        for dimensions in 1..=3 {
            let points: Vec<Vec<f64>> = (0..40)
                .map(|_| (0..dimensions).map(|_| generator.unit()).collect())
                .collect();
            let hull = Hull::new(&points).unwrap();
            for _ in 0..200 {
                let weights: Vec<f64> = points.iter().map(|_| -generator.unit().max(1e-12).ln()).collect();
                let whole: f64 = weights.iter().sum();
                let mean: Vec<f64> = (0..dimensions)
                    .map(|k| points.iter().zip(&weights).map(|(p, w)| p[k] * w).sum::<f64>() / whole)
                    .collect();
                assert!(hull.contains(&mean), "{mean:?}");
                // Along a direction, a little beyond the point that is farthest there.
                let direction: Vec<f64> = (0..dimensions).map(|_| generator.unit() - 0.5).collect();
                let along = |p: &Vec<f64>| p.iter().zip(&direction).map(|(x, d)| x * d).sum::<f64>();
                let farthest = points.iter().max_by(|a, b| along(a).total_cmp(&along(b))).unwrap();
                assert!(hull.contains(farthest));
                let beyond: Vec<f64> = farthest.iter().zip(&direction).map(|(x, d)| x + 0.01 * d).collect();
                assert!(!hull.contains(&beyond), "{beyond:?}");
            }
        }
    }
}
