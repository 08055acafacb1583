//! Classic problems of least squares.

use gearloss_numerics::least_squares::{Options, Parameter, Problem, Subproblem};

pub const INF: f64 = f64::INFINITY;

pub type Residual = fn(&[f64]) -> Vec<f64>;

pub fn parameters(start: &[f64], lower: &[f64], upper: &[f64]) -> Vec<Parameter> {
    let each = start.iter().zip(lower).zip(upper).enumerate();
    each.map(|(i, ((x, l), h))| Parameter::new(format!("x{}", i + 1), *x).within(*l, *h))
        .collect()
}

pub fn problem<'a>(residual: Residual, start: &[f64], lower: &[f64], upper: &[f64]) -> Problem<'a> {
    Problem::new(move |x: &[f64]| Ok(residual(x)), parameters(start, lower, upper))
}

pub fn rosenbrock(x: &[f64]) -> Vec<f64> {
    vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
}

pub fn powell(x: &[f64]) -> Vec<f64> {
    vec![
        x[0] + 10.0 * x[1],
        5.0_f64.sqrt() * (x[2] - x[3]),
        (x[1] - 2.0 * x[2]).powi(2),
        10.0_f64.sqrt() * (x[0] - x[3]).powi(2),
    ]
}

pub fn wood(x: &[f64]) -> Vec<f64> {
    vec![
        10.0 * (x[1] - x[0] * x[0]),
        1.0 - x[0],
        90.0_f64.sqrt() * (x[3] - x[2] * x[2]),
        1.0 - x[2],
        10.0_f64.sqrt() * (x[1] + x[3] - 2.0),
        (x[1] - x[3]) / 10.0_f64.sqrt(),
    ]
}

pub fn beale(x: &[f64]) -> Vec<f64> {
    [1.5, 2.25, 2.625]
        .iter()
        .zip(1..)
        .map(|(y, i)| y - x[0] * (1.0 - x[1].powi(i)))
        .collect()
}

pub fn helix(x: &[f64]) -> Vec<f64> {
    let turn = x[1].atan2(x[0]) / (2.0 * std::f64::consts::PI);
    vec![10.0 * (x[2] - 10.0 * turn), 10.0 * (x[0].hypot(x[1]) - 1.0), x[2]]
}

pub fn broyden(x: &[f64]) -> Vec<f64> {
    let at = |i: usize| if i < x.len() { x[i] } else { 0.0 };
    (0..x.len())
        .map(|i| (3.0 - x[i]) * x[i] + 1.0 - at(i.wrapping_sub(1)) - 2.0 * at(i + 1))
        .collect()
}

pub fn himmelblau(x: &[f64]) -> Vec<f64> {
    vec![x[0] * x[0] + x[1] - 11.0, x[0] + x[1] * x[1] - 7.0]
}

/// Both ways to find steps, to as many digits as there are.
pub fn ways() -> [Options<'static>; 2] {
    [Subproblem::Cone, Subproblem::Dogleg].map(|subproblem| Options {
        subproblem,
        ..Options::exact()
    })
}
