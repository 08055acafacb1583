//! The minimum of a surface, whether it is inside, and the flatness of the surface about it.

use gearloss_numerics::inference::Side;

/// Relative difference from the minimum of values that count as close.
const CLOSE: f64 = 0.05;
/// Relative change below which a change is rounding or a solver residual.
const NOISE: f64 = 1e-7;

/// First and last index along each axis.
pub type Flat = [[usize; 2]; 2];

/// The minimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Least {
    /// The value, in the unit of the difference.
    pub value: f64,
    /// Indices along x and y.
    pub place: [usize; 2],
    /// End of each axis at which it is: the values may decrease beyond.
    pub ends: [Option<Side>; 2],
    /// Whether the values change along each axis.
    pub depends: [bool; 2],
    /// Range of indices with a value within 5 % of it.
    pub close: Flat,
    /// Range of indices with a value above it by less than an accuracy, if known.
    pub unseen: Option<Flat>,
}

impl Least {
    /// The minimum of values whose first coordinate varies fastest; absent if none has a value.
    pub fn new(values: &[Option<f64>], columns: usize, accuracy: Option<f64>) -> Option<Self> {
        let known = || values.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?)));
        let (cell, value) = known().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let place = [cell % columns, cell / columns];
        let counts = [columns, values.len() / columns];
        let steps = [1, columns];
        let depends = [0, 1].map(|axis| {
            known().any(|(i, here)| {
                let at = [i % columns, i / columns][axis];
                let next = (at + 1 < counts[axis]).then(|| values[i + steps[axis]]).flatten();
                next.is_some_and(|next| (next - here).abs() > NOISE * here.abs().max(next.abs()))
            })
        });
        let ends = [0, 1].map(|axis| match place[axis] {
            _ if !depends[axis] => None,
            0 => Some(Side::Lower),
            i if i + 1 == counts[axis] => Some(Side::Upper),
            _ => None,
        });
        let below = |limit: f64| {
            [0, 1].map(|axis| {
                let near = known().filter(|(_, value)| *value <= limit);
                near.fold([place[axis]; 2], |[low, high], (i, _)| {
                    let at = [i % columns, i / columns][axis];
                    [low.min(at), high.max(at)]
                })
            })
        };
        Some(Self {
            value,
            place,
            ends,
            depends,
            close: below((1.0 + CLOSE) * value),
            unseen: accuracy.map(|a| below(value + a)),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A bowl about a place, of 5 by 4 values.
    fn bowl(x: f64, y: f64) -> Vec<Option<f64>> {
        let value = |i: usize| 1.0 + ((i % 5) as f64 - x).powi(2) + 0.03 * ((i / 5) as f64 - y).powi(2);
        (0..20).map(|i| Some(value(i))).collect()
    }

    #[test]
    fn a_bowl_has_its_least_inside_and_is_flat_along_one_axis() {
        let least = Least::new(&bowl(2.0, 1.0), 5, Some(1.0)).unwrap();
        assert_eq!((least.place, least.ends), ([2, 1], [None, None]));
        assert_eq!(least.close, [[2, 2], [0, 2]]);
        assert_eq!(least.unseen.unwrap(), [[1, 3], [0, 3]]);
    }

    #[test]
    fn a_slope_ends_at_its_sides_and_gaps_do_not_count() {
        let mut values = bowl(9.0, -1.0);
        assert_eq!(
            Least::new(&values, 5, None).unwrap().ends,
            [Some(Side::Upper), Some(Side::Lower)]
        );
        values[4] = None;
        let least = Least::new(&values, 5, None).unwrap();
        assert_eq!((least.place, least.ends), ([4, 1], [Some(Side::Upper), None]));
        assert!(Least::new(&[None, None], 2, None).is_none());
    }

    #[test]
    fn an_axis_along_which_nothing_changes_has_no_end() {
        let values: Vec<Option<f64>> = (0..6).map(|i| Some(if i % 3 == 2 { 1.0 } else { 2.0 })).collect();
        let least = Least::new(&values, 3, None).unwrap();
        assert_eq!((least.depends, least.ends), ([true, false], [Some(Side::Upper), None]));
        assert_eq!(least.close, [[2, 2], [0, 1]]);
    }
}
