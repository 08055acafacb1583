//! A made-up transmission with five losses and a torque offset of its rig: eight parameters, 440 points, known truth.

use gearloss_numerics::inference::{Accuracy, Fit, Parameter, Scale, Standing};
use gearloss_numerics::sensitivity::gradients;
use nalgebra::{DMatrix, DVector};

pub use crate::loss_map::{AT_BOUND, DEVIATIONS, OPTIMUM};

/// Names of the losses and of the offset, in the order of [`terms`].
pub const TERMS: usize = 6;

/// The operating point of one measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Viscosity. \[mm2/s\]
    pub nu: f64,
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[1/min\]
    pub speed: f64,
}

impl Point {
    /// Speed. \[rad/s\]
    pub fn omega(&self) -> f64 {
        std::f64::consts::PI * self.speed / 30.0
    }

    /// Standard uncertainty of the measured loss. \[W\]
    pub fn sigma(&self) -> f64 {
        self.omega() * (0.005_f64.powi(2) + (0.0005 * self.torque).powi(2)).sqrt()
    }
}

/// Mesh, bearing, drag, churning, seal and offset for f_nu, f_mu, a, f_L, f_0, h, M_s, dT. \[W\]
pub fn terms(theta: &[f64], at: &Point) -> [f64; TERMS] {
    let [f_nu, f_mu, a, f_l, f_0, h, m_s, d_t] = theta[..8] else {
        panic!("eight parameters");
    };
    let (w, x, t) = (at.omega(), at.speed / 10000.0, at.torque / 10.0);
    let v = f_nu * at.nu / 6.4;
    [
        f_mu * 0.0075 * at.torque * w * t.powf(a) * x.powf(-0.2) * (0.7 + 0.3 * (-1.5 * v * x.sqrt()).exp()),
        f_l * 14.0 * t.powf(1.55) * x,
        f_0 * 12.0 * v.powf(2.0 / 3.0) * x.powf(5.0 / 3.0),
        20.0 * h.powf(1.5) * (0.7 + 0.3 * v.sqrt()) * x.powf(2.4),
        m_s * w / (1.0 + 0.5 * x).sqrt(),
        d_t * w,
    ]
}

/// All terms together. \[W\]
pub fn model(theta: &[f64], at: &Point) -> f64 {
    terms(theta, at).iter().sum()
}

/// The 440 points: speed fastest, then torque, then viscosity.
pub fn points() -> Vec<Point> {
    let mut list = Vec::new();
    for nu in [16.0, 6.4] {
        for torque in 1..=10 {
            for speed in 1..=22 {
                list.push(Point {
                    nu,
                    torque: 2.0 * f64::from(torque),
                    speed: 1000.0 * f64::from(speed),
                });
            }
        }
    }
    list
}

pub const TRUTH: [f64; 8] = [1.25, 1.10, 0.20, 1.40, 0.80, 0.75, 0.020, 0.025];
pub const START: [f64; 8] = [1.0, 1.0, 0.1, 1.0, 1.0, 1.0, 0.01, 0.0];
pub const NAMES: [&str; 8] = ["f_nu", "f_mu", "a", "f_L", "f_0", "h", "M_s", "dT"];
pub const BOUNDS: [[f64; 2]; 8] = [
    [0.4, 2.5],
    [0.5, 2.0],
    [-0.2, 0.6],
    [0.2, 4.0],
    [0.2, 5.0],
    [0.2, 2.0],
    [0.0, 0.1],
    [-0.1, 0.1],
];

pub fn scale(parameter: usize) -> Scale {
    if [0, 3, 4].contains(&parameter) {
        Scale::Log
    } else {
        Scale::Linear
    }
}

/// The eight parameters at some values.
pub fn parameters(theta: &[f64]) -> Vec<Parameter> {
    (0..8)
        .map(|k| Parameter::new(NAMES[k], scale(k), theta[k], BOUNDS[k]).unwrap())
        .collect()
}

/// Parameters in their own units from coordinates.
pub fn thetas(u: &[f64]) -> Vec<f64> {
    u.iter().enumerate().map(|(k, u)| scale(k).theta(*u)).collect()
}

/// Nearly normal noise of a number: twelve states of a linear generator for each point.
pub fn noise(number: u32, count: usize) -> Vec<f64> {
    let mut state = number;
    (0..count)
        .map(|_| {
            let mut sum = 6.0;
            for _ in 0..12 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                sum += f64::from(state);
            }
            sum / 2.0_f64.powi(32) - 6.0
        })
        .collect()
}

/// Measured losses with the first noise. \[W\]
pub fn measured() -> Vec<f64> {
    let points = points();
    let noise = noise(1, points.len());
    points
        .iter()
        .zip(noise)
        .map(|(at, e)| model(&TRUTH, at) + at.sigma() * e)
        .collect()
}

/// Standardised residuals at coordinates, over some of the points.
pub fn residuals(u: &[f64], rows: &[usize], measured: &[f64]) -> Vec<f64> {
    let (theta, points) = (thetas(u), points());
    rows.iter()
        .map(|i| (model(&theta, &points[*i]) - measured[*i]) / points[*i].sigma())
        .collect()
}

/// Residuals and central Jacobian over the coordinates, over some of the points.
pub fn linearised(parameters: &[Parameter], rows: &[usize], measured: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    let points = points();
    let function = |theta: &[f64]| {
        let residual = |i: &usize| (model(theta, &points[*i]) - measured[*i]) / points[*i].sigma();
        Ok(rows.iter().map(residual).collect())
    };
    let slopes = gradients(parameters, 0.0, function).unwrap();
    let u: Vec<f64> = parameters.iter().map(|p| p.u).collect();
    let jacobian = DMatrix::from_fn(rows.len(), parameters.len(), |i, k| slopes[i][k]);
    (residuals(&u, rows, measured), jacobian)
}

/// The fit of all points at some parameters.
pub fn fit(parameters: Vec<Parameter>) -> Fit {
    let all: Vec<usize> = (0..440).collect();
    let (residuals, jacobian) = linearised(&parameters, &all, &measured());
    Fit::new(parameters, &jacobian, &residuals, 0, Accuracy::Given).unwrap()
}

/// A crude damped Gauss-Newton method inside the bounds, with some parameters held: objective and coordinates.
pub fn minimise(rows: &[usize], measured: &[f64], mut at: Vec<Parameter>, held: &[usize]) -> (f64, Vec<f64>) {
    let sum = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>();
    let mut damping = 1e-6;
    let (mut r, mut jacobian) = linearised(&at, rows, measured);
    for _ in 0..300 {
        let gradient: Vec<f64> = jacobian
            .column_iter()
            .map(|c| c.iter().zip(&r).map(|(j, r)| j * r).sum())
            .collect();
        for (p, g) in at.iter_mut().zip(&gradient) {
            p.update_state(*g);
        }
        let free: Vec<usize> = (0..8)
            .filter(|k| !held.contains(k) && at[*k].standing == Standing::Free)
            .collect();
        let norms: Vec<f64> = free.iter().map(|k| jacobian.column(*k).norm()).collect();
        let count = rows.len();
        let augmented = DMatrix::from_fn(count + free.len(), free.len(), |i, c| match i.checked_sub(count) {
            None => jacobian[(i, free[c])] / norms[c],
            Some(d) => {
                if d == c {
                    f64::sqrt(damping)
                } else {
                    0.0
                }
            }
        });
        let right = DVector::from_fn(count + free.len(), |i, _| if i < count { -r[i] } else { 0.0 });
        let step = augmented.svd(true, true).solve(&right, 1e-14).unwrap();
        let mut next = at.clone();
        let mut moved: f64 = 0.0;
        for (c, k) in free.iter().enumerate() {
            let [low, high] = next[*k].bounds;
            next[*k].u = (next[*k].u + step[c] / norms[c]).clamp(low, high);
            moved = moved.max((next[*k].u - at[*k].u).abs() * norms[c]);
        }
        let u: Vec<f64> = next.iter().map(|p| p.u).collect();
        let trial = residuals(&u, rows, measured);
        if sum(&trial) <= sum(&r) {
            at = next;
            (r, jacobian) = linearised(&at, rows, measured);
            damping = (damping * 0.1_f64).max(1e-14);
        } else {
            damping *= 10.0;
        }
        // In units of standard deviations if all others were known.
        if moved < 1e-7 || damping > 1e12 {
            break;
        }
    }
    (sum(&r), at.iter().map(|p| p.u).collect())
}

#[test]
fn check_7_1_data() {
    // Printed with nine to twelve digits.
    let near = |x: f64, y: f64| assert!((x - y).abs() <= 2e-9 * y.abs(), "{x} {y}");
    let (points, e, y) = (points(), noise(1, 440), measured());
    for (i, x) in [
        (0, -1.1055668),
        (1, -0.244727797),
        (2, 0.175113429),
        (3, 1.02267693),
        (439, -0.783267586),
    ] {
        assert!((e[i] - x).abs() < 5e-9);
    }
    near(e.iter().sum::<f64>() / 440.0, -0.0378588396);
    near(e.iter().map(|e| e * e).sum(), 481.228298);
    for (i, value) in [(0, 6.85397554), (219, 659.229042), (220, 6.83568527), (439, 614.350341)] {
        near(model(&TRUTH, &points[i]), value);
    }
    for (i, value) in [(0, 6.26363816), (219, 720.482356), (220, 6.04763707), (439, 594.175206)] {
        near(y[i], value);
    }
    near(y.iter().sum(), 92375.0749707);
    let all: Vec<usize> = (0..440).collect();
    let sum = |theta: &[f64]| {
        let u: Vec<f64> = parameters(theta).iter().map(|p| p.u).collect();
        residuals(&u, &all, &y).iter().map(|r| r * r).sum::<f64>()
    };
    near(sum(&START), 10929.0224);
    near(sum(&TRUTH), 481.228298);
    near(sum(&OPTIMUM), 468.4034462);
}
