//! Tables over several quantities, interpolated linearly along each axis.

use alloc::vec::Vec;

/// Maximum number of axes of a table.
pub const MOST_AXES: usize = 6;

/// One axis of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Number of the quantity, in the list that [`Table::interpolate`] takes.
    pub quantity: u32,
    /// Its values, ascending; at least one.
    pub points: Vec<f64>,
}

/// Several values over common axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// The axes; the last one varies fastest.
    pub axes: Vec<Axis>,
    /// Number of values at each point.
    pub channels: usize,
    /// The values of each point, one point after the other.
    pub values: Vec<f64>,
}

impl Axis {
    /// Index of the point below a value, the share of the way to the next point, and whether the value is on the axis. Beyond the ends
    /// the value at the end applies.
    fn find(&self, value: f64) -> (usize, f64, bool) {
        let points = &self.points;
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return (0, 0.0, false);
        };
        let margin = 1e-9 * (last - first).max(last.abs()).max(1.0);
        let is_inside = value >= first - margin && value <= last + margin;
        let above = points.partition_point(|point| *point <= value);
        if above == 0 {
            return (0, 0.0, is_inside);
        }
        let below = above - 1;
        match points.get(above) {
            Some(next) => (below, (value - points[below]) / (next - points[below]), is_inside),
            None => (below, 0.0, is_inside),
        }
    }
}

impl Table {
    /// Whether axes, channels and values fit together, so that interpolation is defined.
    pub fn is_sound(&self) -> bool {
        let mut count = self.channels;
        for axis in &self.axes {
            let ascends = axis.points.windows(2).all(|w| w[0] < w[1]);
            if axis.points.is_empty() || !ascends || !axis.points.iter().all(|x| x.is_finite()) {
                return false;
            }
            match count.checked_mul(axis.points.len()) {
                Some(more) => count = more,
                None => return false,
            }
        }
        self.axes.len() <= MOST_AXES && count == self.values.len() && self.values.iter().all(|x| x.is_finite())
    }

    /// Adds `factor` times the values at some quantities to `sums`, one for each channel. Returns whether all quantities are on their
    /// axes.
    pub fn interpolate(&self, quantities: &[f64], factor: f64, sums: &mut [f64]) -> bool {
        let count = self.axes.len().min(MOST_AXES);
        let (mut below, mut shares) = ([0; MOST_AXES], [0.0; MOST_AXES]);
        let mut inside = true;
        for (i, axis) in self.axes.iter().take(count).enumerate() {
            let value = quantities.get(axis.quantity as usize).copied().unwrap_or(0.0);
            let (index, share, is_inside) = axis.find(value);
            (below[i], shares[i]) = (index, share);
            inside &= is_inside;
        }
        for corner in 0..1_usize << count {
            let (mut place, mut weight) = (0, factor);
            for (i, axis) in self.axes.iter().take(count).enumerate() {
                let upper = corner >> i & 1;
                weight *= if upper == 1 { shares[i] } else { 1.0 - shares[i] };
                place = place * axis.points.len() + below[i] + upper;
            }
            if weight == 0.0 {
                continue;
            }
            let row = self.values.get(place * self.channels..(place + 1) * self.channels);
            for (sum, value) in sums.iter_mut().zip(row.unwrap_or(&[])) {
                *sum += weight * value;
            }
        }
        inside
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn table() -> Table {
        let axis = |quantity, points: &[f64]| Axis {
            quantity,
            points: points.to_vec(),
        };
        let (x, y, z) = ([0.0, 1.0, 3.0], [10.0, 20.0], [-1.0, 0.0, 2.0, 5.0]);
        let mut values = Vec::new();
        for a in x {
            for b in y {
                for c in z {
                    values.extend([law(a, b, c), -law(a, b, c)]);
                }
            }
        }
        Table {
            axes: vec![axis(2, &x), axis(0, &y), axis(1, &z)],
            channels: 2,
            values,
        }
    }

    /// Linear along each axis, so that interpolation is exact.
    fn law(x: f64, y: f64, z: f64) -> f64 {
        1.0 + 2.0 * x - 0.3 * y + x * y * z + 0.5 * z
    }

    #[test]
    fn a_law_that_is_linear_along_each_axis_is_met() {
        let table = table();
        assert!(table.is_sound());
        for (x, y, z) in [(0.0, 10.0, -1.0), (2.2, 13.0, 4.0), (3.0, 20.0, 5.0), (0.5, 20.0, 0.0)] {
            let mut sums = [0.0; 2];
            assert!(table.interpolate(&[y, z, x], 1.0, &mut sums));
            assert!(
                (sums[0] - law(x, y, z)).abs() < 1e-12 && sums[0] == -sums[1],
                "{sums:?}"
            );
        }
    }

    #[test]
    fn beyond_an_axis_its_end_applies() {
        let table = table();
        for (given, held) in [
            ((9.0, 15.0, 1.0), (3.0, 15.0, 1.0)),
            ((-1.0, 5.0, 9.0), (0.0, 10.0, 5.0)),
        ] {
            let mut sums = [0.0; 2];
            assert!(!table.interpolate(&[given.1, given.2, given.0], 1.0, &mut sums));
            assert!((sums[0] - law(held.0, held.1, held.2)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_table_that_does_not_fit_its_axes_is_not_sound() {
        let mut short = table();
        short.values.pop();
        let mut twice = table();
        twice.axes[0].points[1] = 0.0;
        let mut lost = table();
        lost.values[3] = f64::NAN;
        assert!(!short.is_sound() && !twice.is_sound() && !lost.is_sound());
    }
}
