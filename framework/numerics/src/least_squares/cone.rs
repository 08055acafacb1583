//! The minimum inside ball and box as a second-order cone program.
//!
//! Variables are the step and the residual of the model, both divided by their typical size, so that the tolerances of the solver are
//! meaningful: minimise 1/2 |y|^2 subject to R z - y = -q, the bounds, and |z| <= radius.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, SupportedConeT,
    ZeroConeT,
};
use nalgebra::DVector;

use super::model::{Model, Region};

/// Relative distance to a bound below which a component is fixed.
const NARROW: f64 = 1e-10;
/// Gap and infeasibility of a solved program.
const TOLERANCE: f64 = 1e-10;

/// The minimum of a model in a region, given the length of the Gauss-Newton step. Absent if the solver fails.
pub(super) fn step(model: &Model<'_>, region: &Region, newton: f64) -> Option<DVector<f64>> {
    let n = model.r.ncols();
    let size = region.radius.min(newton);
    let scale = model.q.norm();
    if !(size > 0.0 && size.is_finite() && scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let free: Vec<usize> = (0..n)
        .filter(|j| (region.upper[*j] - region.lower[*j]) / size > NARROW)
        .collect();
    let mut z = DVector::zeros(n);
    if free.is_empty() {
        return Some(z);
    }
    // A bound outside the ball is never active.
    let uppers: Vec<usize> = (0..free.len())
        .filter(|k| region.upper[free[*k]] < region.radius)
        .collect();
    let lowers: Vec<usize> = (0..free.len())
        .filter(|k| -region.lower[free[*k]] < region.radius)
        .collect();
    let (k, rows) = (free.len(), model.r.nrows());
    let bounds = uppers.len() + lowers.len();

    let (mut row, mut column, mut value) = (Vec::new(), Vec::new(), Vec::new());
    let mut entry = |i: usize, j: usize, x: f64| {
        row.push(i);
        column.push(j);
        value.push(x);
    };
    let mut right = Vec::with_capacity(rows + bounds + k + 1);
    for i in 0..rows {
        for (place, j) in free.iter().enumerate() {
            let x = model.r[(i, *j)];
            if x != 0.0 {
                entry(i, place, size / scale * x);
            }
        }
        entry(i, k + i, -1.0);
        right.push(-model.q[i] / scale);
    }
    for (i, place) in uppers.iter().enumerate() {
        entry(rows + i, *place, 1.0);
        right.push(region.upper[free[*place]] / size);
    }
    for (i, place) in lowers.iter().enumerate() {
        entry(rows + uppers.len() + i, *place, -1.0);
        right.push(-region.lower[free[*place]] / size);
    }
    right.push(region.radius / size);
    for place in 0..k {
        entry(rows + bounds + 1 + place, place, -1.0);
        right.push(0.0);
    }
    let height = right.len();
    let constraints = CscMatrix::new_from_triplets(height, k + rows, row, column, value);
    let residuals: Vec<usize> = (k..k + rows).collect();
    let objective = CscMatrix::new_from_triplets(k + rows, k + rows, residuals.clone(), residuals, vec![1.0; rows]);
    let mut cones: Vec<SupportedConeT<f64>> = vec![ZeroConeT(rows)];
    if bounds > 0 {
        cones.push(NonnegativeConeT(bounds));
    }
    cones.push(SecondOrderConeT(k + 1));
    let none = vec![0.0; k + rows];
    let mut solver = DefaultSolver::new(&objective, &none, &constraints, &right, &cones, settings()).ok()?;
    solver.solve();
    let answer = &solver.solution;
    if !matches!(answer.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    for (place, j) in free.iter().enumerate() {
        z[*j] = answer.x[place] * size;
    }
    // A constraint is active if its multiplier is larger than its slack.
    let binds = |i: usize| answer.z[rows + i] > answer.s[rows + i];
    let mut loose = free.clone();
    for (i, place) in uppers.iter().chain(&lowers).enumerate() {
        if binds(i) {
            let j = free[*place];
            z[j] = if i < uppers.len() {
                region.upper[j]
            } else {
                region.lower[j]
            };
            loose.retain(|other| *other != j);
        }
    }
    let ball = rows + bounds;
    let slack = answer.s[ball] - answer.s[ball + 1..].iter().map(|s| s * s).sum::<f64>().sqrt();
    let inside = answer.z[ball] <= slack;
    if let Some(sharp) = model.minimum(&z, &loose).filter(|sharp| inside && region.holds(sharp)) {
        return Some(sharp);
    }
    region.clip(&mut z);
    shrink(&mut z, region.radius, &loose);
    Some(z)
}

/// Moves a point into the ball by its free components, so that the others remain at their bounds; by all components if necessary.
fn shrink(z: &mut DVector<f64>, radius: f64, loose: &[usize]) {
    let norm = z.norm();
    if norm <= radius {
        return;
    }
    let part: f64 = loose.iter().map(|j| z[*j] * z[*j]).sum();
    let room = radius * radius - (norm * norm - part);
    if room > 0.0 {
        let factor = (room / part).sqrt();
        for j in loose {
            z[*j] *= factor;
        }
    } else {
        *z *= radius / norm;
    }
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_iter: 60,
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        tol_ktratio: 1e-8,
        presolve_enable: false,
        equilibrate_enable: true,
        max_threads: 1,
        // The built-in method, independent of the features of Clarabel that other crates enable.
        direct_solve_method: "qdldl".to_owned(),
        ..DefaultSettings::default()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::dogleg;
    use super::*;

    /// Box above, radius, step, half the square that is left, step by dogleg.
    const CASES: [([f64; 2], f64, [f64; 2], f64, [f64; 2]); 4] = [
        ([9e9, 9e9], 10.0, [0.5, 3.0], 0.0, [0.5, 3.0]),
        (
            [9e9, 9e9],
            1.0,
            [0.675433266, 0.737421116],
            4.38695366,
            [0.752576695, 0.658504608],
        ),
        ([9e9, 1.0], 10.0, [1.5, 1.0], 2.0, [1.5, 1.0]),
        ([9e9, 0.5], 1.0, [0.866025404, 0.5], 4.68782217, [0.866025404, 0.5]),
    ];

    #[test]
    fn check_2_3_cone_program_and_dogleg() {
        let r = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 0.0, 1.0]);
        let q = DVector::from_vec(vec![-4.0, -3.0]);
        let model = Model { r: &r, q: &q };
        for (upper, radius, z, left, legs) in CASES {
            let region = Region {
                radius,
                lower: DVector::from_element(2, -9e9),
                upper: DVector::from_row_slice(&upper),
            };
            let found = step(&model, &region, 9.25_f64.sqrt());
            let found = found.unwrap_or_else(|| panic!("no answer"));
            let near = |a: f64, b: f64| (a - b).abs() < 2e-9;
            assert!(near(found[0], z[0]) && near(found[1], z[1]), "{found} {z:?}");
            assert!((0.5 * (&r * &found + &q).norm_squared() - left).abs() < 1e-7);
            assert!(region.boxes(&found) && found.norm() <= radius * (1.0 + 1e-15));
            let found = dogleg::step(&model, &region);
            assert!(
                (found[0] - legs[0]).abs() < 1e-9 && (found[1] - legs[1]).abs() < 1e-9,
                "{found}"
            );
        }
    }
}
