//! Linear least squares inside bounds, for a few unknowns and many rows.
//!
//! Source: Stark, Parker: Bounded-variable least squares (Computational Statistics 10 (1995) 129-141): an active set of bounds; each step
//! solves for the free unknowns. The rows are first reduced to a triangle by an orthogonal factorisation, so that the cost of a step does
//! not depend on their number.

use nalgebra::{DMatrix, DVector};

use super::linear::nearest;

/// Slope over the norms of column and residual below which a bound remains active.
const FLAT: f64 = 1e-10;

/// The unknowns within their bounds that minimise the distance of the linear combination of the columns from the target.
///
/// Absent if lengths differ, a number is not finite, bounds are reversed, or the search cycles because of rounding.
pub fn bounded_linear(columns: &[Vec<f64>], target: &[f64], bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
    let count = columns.len();
    let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
    let whole = count == bounds.len() && columns.iter().all(|c| c.len() == target.len() && finite(c));
    if !whole || !finite(target) || !bounds.iter().all(|[low, high]| low <= high) {
        return None;
    }
    if count == 0 {
        return Some(Vec::new());
    }
    let matrix = DMatrix::from_fn(target.len(), count, |i, j| columns[j][i]);
    let mut right = DVector::from_row_slice(target);
    let factors = matrix.qr();
    factors.q_tr_mul(&mut right);
    let matrix = factors.r();
    let right = right.rows(0, matrix.nrows()).into_owned();

    let mut x = DVector::from_iterator(count, bounds.iter().map(|[low, high]| 1.0_f64.clamp(*low, *high)));
    let mut free = vec![true; count];
    for _ in 0..100 * (count + 1) {
        // The optimum of the free unknowns with the others fixed; as far towards it as the bounds allow.
        let places: Vec<usize> = (0..count).filter(|j| free[*j]).collect();
        let held = (0..count).filter(|j| !free[*j]);
        let rest = held.fold(right.clone(), |rest, j| rest - matrix.column(j) * x[j]);
        let best = nearest(matrix.select_columns(&places), &rest)?;
        let mut share = 1.0;
        let mut blocked = None;
        for (k, j) in places.iter().enumerate() {
            let [low, high] = bounds[*j];
            let end = best[k].clamp(low, high);
            if end != best[k] {
                let part = ((end - x[*j]) / (best[k] - x[*j])).clamp(0.0, 1.0);
                if blocked.is_none() || part < share {
                    (share, blocked) = (part, Some((*j, end)));
                }
            }
        }
        for (k, j) in places.iter().enumerate() {
            let [low, high] = bounds[*j];
            x[*j] = (x[*j] + share * (best[k] - x[*j])).clamp(low, high);
        }
        if let Some((j, end)) = blocked {
            (x[j], free[j]) = (end, false);
            continue;
        }
        // A bound is released if the residual decreases inwards, the steepest first.
        let residual = &right - &matrix * &x;
        let slope = |j: usize| {
            let column = matrix.column(j);
            let size = column.norm() * right.norm();
            let slope = column.dot(&residual) / if size > 0.0 { size } else { 1.0 };
            let inwards = if x[j] <= bounds[j][0] { slope } else { -slope };
            (bounds[j][0] < bounds[j][1] && inwards > FLAT).then_some((j, inwards))
        };
        let steepest = (0..count).filter(|j| !free[*j]).filter_map(slope);
        match steepest.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((j, _)) => free[j] = true,
            None => return Some(x.as_slice().to_vec()),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::*;

    fn squares(columns: &[Vec<f64>], target: &[f64], x: &[f64]) -> f64 {
        let row = |i: usize| columns.iter().zip(x).map(|(c, x)| c[i] * x).sum::<f64>() - target[i];
        (0..target.len()).map(|i| row(i).powi(2)).sum()
    }

    #[test]
    fn a_bound_moves_the_other_unknown() {
        let columns = [vec![1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0]];
        let free = bounded_linear(&columns, &[1.0, 3.0, 5.0], &[[-9.0, 9.0], [-9.0, 9.0]]).unwrap();
        assert!((free[0] - 1.0).abs() < 1e-12 && (free[1] - 2.0).abs() < 1e-12);
        // With the slope at 1 the best height is the mean of 1, 2, 3.
        let held = bounded_linear(&columns, &[1.0, 3.0, 5.0], &[[-9.0, 9.0], [0.0, 1.0]]).unwrap();
        assert!((held[0] - 2.0).abs() < 1e-12 && held[1] == 1.0, "{held:?}");
    }

    #[test]
    fn what_cannot_be_solved_is_refused() {
        assert_eq!(bounded_linear(&[vec![1.0]], &[1.0, 2.0], &[[0.0, 1.0]]), None);
        assert_eq!(bounded_linear(&[vec![f64::NAN]], &[1.0], &[[0.0, 1.0]]), None);
        assert_eq!(bounded_linear(&[vec![1.0]], &[1.0], &[[2.0, 1.0]]), None);
        assert_eq!(bounded_linear(&[], &[1.0], &[]), Some(Vec::new()));
        // A column of zeros stays where it began.
        assert_eq!(
            bounded_linear(&[vec![0.0]], &[1.0], &[[0.5, 2.0]]).map(|x| x.len()),
            Some(1)
        );
    }

    proptest! {
        #[test]
        fn no_neighbour_inside_the_bounds_is_nearer(
            numbers in proptest::collection::vec(-3.0..3.0_f64, 18), target in proptest::collection::vec(-5.0..5.0_f64, 6),
            low in -1.0..0.9_f64, width in 0.0..2.0_f64, way in 0..6_usize, step in 1e-4..0.5_f64,
        ) {
            let columns: Vec<Vec<f64>> = numbers.chunks(6).map(<[f64]>::to_vec).collect();
            let bounds = [[low, low + width], [-2.0, 0.5], [0.5, 2.0]];
            let x = bounded_linear(&columns, &target, &bounds).unwrap();
            for (x, [low, high]) in x.iter().zip(bounds) {
                prop_assert!((low..=high).contains(x));
            }
            let mut other = x.clone();
            let j = way / 2;
            other[j] = (x[j] + if way % 2 == 0 { step } else { -step }).clamp(bounds[j][0], bounds[j][1]);
            let [least, moved] = [&x, &other].map(|x| squares(&columns, &target, x));
            prop_assert!(least <= moved + 1e-9 * (1.0 + least), "{least} {moved}");
        }
    }
}
