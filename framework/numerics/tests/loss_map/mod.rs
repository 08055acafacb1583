//! A problem with the shape of a gearbox: eight parameters of a loss map of 440 points, with known noise.

use std::f64::consts::PI;

use gearloss_numerics::least_squares::{Fit, Parameter, Problem};

/// One operating point: viscosity, torque, speed. \[mm2/s, Nm, rpm\]
pub type Point = [f64; 3];

pub fn points() -> Vec<Point> {
    let mut points = Vec::new();
    for nu in [16.0, 6.4] {
        for torque in 1..=10 {
            for speed in 1..=22 {
                points.push([nu, 2.0 * f64::from(torque), 1000.0 * f64::from(speed)]);
            }
        }
    }
    points
}

pub fn omega(point: &Point) -> f64 {
    PI * point[2] / 30.0
}

/// Loss and the offset of the rig. \[W\]
pub fn loss(p: &[f64], point: &Point) -> f64 {
    let [nu, torque, speed] = *point;
    let (w, x, t, v) = (omega(point), speed / 10000.0, torque / 10.0, p[0] * nu / 6.4);
    p[1] * 0.0075 * torque * w * t.powf(p[2]) * x.powf(-0.2) * (0.7 + 0.3 * (-1.5 * v * x.sqrt()).exp())
        + p[3] * 14.0 * t.powf(1.55) * x
        + p[4] * 12.0 * v.powf(2.0 / 3.0) * x.powf(5.0 / 3.0)
        + 20.0 * p[5].powf(1.5) * (0.7 + 0.3 * v.sqrt()) * x.powf(2.4)
        + p[6] * w / (1.0 + 0.5 * x).sqrt()
        + p[7] * w
}

pub fn sigma(point: &Point) -> f64 {
    omega(point) * (0.005_f64.powi(2) + (0.0005 * point[1]).powi(2)).sqrt()
}

pub const TRUTH: [f64; 8] = [1.25, 1.10, 0.20, 1.40, 0.80, 0.75, 0.020, 0.025];
pub const NAMES: [&str; 8] = ["f_nu", "f_mu", "a", "f_L", "f_0", "h", "M_s", "dT"];

/// Standard normal errors, near enough: sums of twelve uniform ones from a linear congruential generator.
pub fn errors(seed: u32) -> Vec<f64> {
    let mut s = seed;
    let mut next = || {
        s = s.wrapping_mul(1664525).wrapping_add(1013904223);
        f64::from(s)
    };
    (0..440)
        .map(|_| ((0..12).map(|_| next()).sum::<f64>() + 6.0) / 2.0_f64.powi(32) - 6.0)
        .collect()
}

pub fn measured(seed: u32) -> Vec<f64> {
    let errors = errors(seed);
    let point = |(p, e): (&Point, f64)| loss(&TRUTH, p) + sigma(p) * e;
    points().iter().zip(errors).map(point).collect()
}

pub fn parameters() -> Vec<Parameter> {
    let table = [
        (1.0, 0.4, 2.5, true),
        (1.0, 0.5, 2.0, false),
        (0.1, -0.2, 0.6, false),
        (1.0, 0.2, 4.0, true),
        (1.0, 0.2, 5.0, true),
        (1.0, 0.2, 2.0, false),
        (0.01, 0.0, 0.1, false),
        (0.0, -0.1, 0.1, false),
    ];
    let parameter = |(name, (start, lower, upper, log)): (&str, (f64, f64, f64, bool))| {
        let linear = Parameter::new(name, start).within(lower, upper);
        if log { linear.log() } else { linear }
    };
    NAMES.into_iter().zip(table).map(parameter).collect()
}

/// The problem with the measurements of a seed.
pub fn problem(y: &[f64], parameters: Vec<Parameter>) -> Problem<'_> {
    problem_of(y, parameters, loss)
}

pub fn problem_of<'a>(
    y: &'a [f64],
    parameters: Vec<Parameter>,
    law: impl Fn(&[f64], &Point) -> f64 + Send + Sync + 'a,
) -> Problem<'a> {
    let points = points();
    let residual = move |p: &[f64]| {
        Ok(points
            .iter()
            .zip(y)
            .map(|(at, y)| (law(p, at) - y) / sigma(at))
            .collect())
    };
    Problem::new(residual, parameters)
}

pub fn near(found: &[f64], expected: &[f64], relative: f64) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() <= relative * b.abs().max(1e-12),
            "{found:?} instead of {expected:?}"
        );
    }
}

/// Standard errors of the parameters that are free and on no bound, with weights given by the uncertainties.
pub fn deviations(fit: &Fit) -> Vec<f64> {
    let derivative = fit.derivative.as_ref().unwrap();
    let free: Vec<usize> = (0..fit.theta.len()).filter(|j| fit.active[*j].is_none()).collect();
    let r = derivative.jacobian.select_columns(&free).qr().r();
    let inverse = r.try_inverse().unwrap();
    let scale = |j: usize| if fit.u[j] == fit.theta[j] { 1.0 } else { fit.theta[j] };
    inverse
        .row_iter()
        .zip(&free)
        .map(|(row, j)| row.norm() * scale(*j))
        .collect()
}

/// The optimum with `h` at an upper bound of 0.7.
pub const AT_BOUND: [f64; 8] = [
    1.20107149,
    1.15803709,
    0.253107616,
    1.0245616,
    0.978194253,
    0.7,
    0.0134678539,
    0.0301566212,
];
pub const OPTIMUM: [f64; 8] = [
    1.184552524,
    1.149303954,
    0.2536491049,
    1.048765314,
    0.9765250472,
    0.7250596825,
    0.01986663924,
    0.02439891357,
];
pub const DEVIATIONS: [f64; 8] = [
    0.230144893,
    0.0560232651,
    0.0301162903,
    0.1731647,
    0.212723511,
    0.0600076819,
    0.0171930824,
    0.0156225551,
];
