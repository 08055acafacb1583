//! Tensor product of cubic splines over three axes with equidistant nodes.
//!
//! Source: de Boor, A Practical Guide to Splines: B-splines on equidistant knots, with the third derivative continuous at the
//! second and the last but one node ("not a knot"), so that cubic polynomials are reproduced exactly along each axis.

/// Minimum number of nodes along an axis: a cubic.
pub const LEAST: usize = 4;

/// Number of values that a table holds per node.
pub const NUMBERS: usize = 3;

/// Several values over three axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// Number of nodes along each axis.
    nodes: [usize; 3],
    /// Coefficients of the B-splines, two more than nodes along each axis; the last axis varies fastest.
    coefficients: Vec<[f64; NUMBERS]>,
}

impl Spline {
    /// Interpolates values at all nodes, the last axis varying fastest; at least [`LEAST`] nodes along each axis.
    pub fn through(nodes: [usize; 3], values: Vec<[f64; NUMBERS]>) -> Self {
        let mut counts = nodes;
        let mut coefficients = values;
        for axis in 0..3 {
            let n = counts[axis];
            let rows = rows(n);
            let inner: usize = counts[axis + 1..].iter().product();
            let outer: usize = counts[..axis].iter().product();
            let mut next = Vec::with_capacity(outer * (n + 2) * inner);
            for o in 0..outer {
                for row in &rows {
                    for i in 0..inner {
                        let mut sum = [0.0; NUMBERS];
                        for (k, weight) in row.iter().enumerate() {
                            add(&mut sum, *weight, &coefficients[(o * n + k) * inner + i]);
                        }
                        next.push(sum);
                    }
                }
            }
            coefficients = next;
            counts[axis] = n + 2;
        }
        Self { nodes, coefficients }
    }

    /// The values at a position, which along each axis is zero at the first node and one at the last.
    pub fn value(&self, place: [f64; 3]) -> [f64; NUMBERS] {
        let mut first = [0; 3];
        let mut weights = [[0.0; 4]; 3];
        for axis in 0..3 {
            let last = self.nodes[axis] - 1;
            let x = place[axis] * last as f64;
            // NaN and positions outside the table fall into the cell at an end.
            first[axis] = (x as usize).min(last - 1);
            weights[axis] = basis(x - first[axis] as f64);
        }
        let [_, middle, last] = self.nodes.map(|n| n + 2);
        let mut sum = [0.0; NUMBERS];
        for (i, a) in weights[0].iter().enumerate() {
            for (j, b) in weights[1].iter().enumerate() {
                let start = ((first[0] + i) * middle + first[1] + j) * last + first[2];
                for (c, value) in weights[2].iter().zip(&self.coefficients[start..start + 4]) {
                    add(&mut sum, a * b * c, value);
                }
            }
        }
        sum
    }
}

fn add(sum: &mut [f64; NUMBERS], weight: f64, values: &[f64; NUMBERS]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// The four B-splines over a cell, at a position from zero to one in it.
fn basis(u: f64) -> [f64; 4] {
    let v = 1.0 - u;
    let (u2, v2) = (u * u, v * v);
    [
        v2 * v / 6.0,
        2.0 / 3.0 - u2 + 0.5 * u2 * u,
        2.0 / 3.0 - v2 + 0.5 * v2 * v,
        u2 * u / 6.0,
    ]
}

/// For each coefficient its weights on the values at the nodes: the inverse of the collocation matrix, without the end conditions.
fn rows(nodes: usize) -> Vec<Vec<f64>> {
    const NOT_A_KNOT: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
    let size = nodes + 2;
    let mut system = vec![vec![0.0; 2 * size]; size];
    for (i, row) in system.iter_mut().enumerate() {
        row[size + i] = 1.0;
        let (start, weights): (usize, &[f64]) = match i {
            0 => (0, &NOT_A_KNOT),
            i if i + 1 == size => (size - 5, &NOT_A_KNOT),
            i => (i - 1, &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]),
        };
        row[start..start + weights.len()].copy_from_slice(weights);
    }
    for column in 0..size {
        let pivot = (column..size)
            .max_by(|a, b| system[*a][column].abs().total_cmp(&system[*b][column].abs()))
            .unwrap_or(column);
        system.swap(column, pivot);
        let mut row = system[column].clone();
        let scale = 1.0 / row[column];
        for x in &mut row {
            *x *= scale;
        }
        for (i, other) in system.iter_mut().enumerate() {
            let factor = other[column];
            if i != column && factor != 0.0 {
                for (x, y) in other.iter_mut().zip(&row) {
                    *x -= factor * y;
                }
            }
        }
        system[column] = row;
    }
    system.iter().map(|row| row[size + 1..2 * size - 1].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_and_values_at_nodes_are_met() {
        let nodes = [4, 7, 5];
        let cubic = |x: f64, y: f64, z: f64| {
            [
                1.0 + x - 2.0 * x * x * x + y * y * z,
                0.3 * z * z * z - x * y * y * y,
                x - z,
            ]
        };
        let at = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        let mut values = Vec::new();
        for i in 0..nodes[0] {
            for j in 0..nodes[1] {
                for k in 0..nodes[2] {
                    values.push(cubic(at(i, 4), at(j, 7), at(k, 5)));
                }
            }
        }
        let spline = Spline::through(nodes, values);
        for place in [
            [0.0, 0.0, 0.0],
            [1.0, 1.0, 1.0],
            [0.1, 0.77, 0.5],
            [0.9, 0.34, 0.99],
            [1.0 / 3.0, 0.5, 0.25],
        ] {
            let expected = cubic(place[0], place[1], place[2]);
            for (value, expected) in spline.value(place).iter().zip(expected) {
                assert!((value - expected).abs() < 1e-13, "{value} {expected} at {place:?}");
            }
        }
    }

    #[test]
    fn a_bend_is_met_as_the_fourth_power_of_the_step() {
        let error = |n: usize| {
            let mut values = Vec::new();
            for i in 0..n {
                values.extend([[(3.0 * i as f64 / (n - 1) as f64).sin(), 0.0, 0.0]; 16]);
            }
            let spline = Spline::through([n, 4, 4], values);
            (0..200)
                .map(|i| f64::from(i) / 199.0)
                .map(|x| (spline.value([x, 0.3, 0.6])[0] - (3.0 * x).sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(11) / error(21)).log2();
        assert!((3.5..5.0).contains(&order), "{order}");
    }
}
