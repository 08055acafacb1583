//! The certified problems of nonlinear regression of the NIST (StRD).

use std::f64::consts::PI;

use gearloss_numerics::least_squares::{Fit, Options, Parameter, Problem, solve};

/// Law of a problem: parameters and predictors to the response.
pub type Law = fn(&[f64], &[f64]) -> f64;

fn exponentials(b: &[f64], x: f64) -> f64 {
    b.chunks(2).map(|pair| pair[0] * (-pair[1] * x).exp()).sum()
}

fn gauss(b: &[f64], x: &[f64]) -> f64 {
    let bell = |k: usize| b[k] * (-(x[0] - b[k + 1]).powi(2) / b[k + 2].powi(2)).exp();
    b[0] * (-b[1] * x[0]).exp() + bell(2) + bell(5)
}

fn rational(b: &[f64], x: f64, above: usize) -> f64 {
    let power = |b: &[f64]| b.iter().rev().fold(0.0, |sum, b| sum * x + b);
    power(&b[..above]) / (1.0 + x * power(&b[above..]))
}

fn enso(b: &[f64], x: f64) -> f64 {
    let wave = |c: f64, s: f64, period: f64| {
        let angle = 2.0 * PI * x / period;
        c * angle.cos() + s * angle.sin()
    };
    b[0] + wave(b[1], b[2], 12.0) + wave(b[4], b[5], b[3]) + wave(b[7], b[8], b[6])
}

/// Laws of all problems by their names.
pub const LAWS: [(&str, Law); 27] = [
    ("Bennett5", |b, x| b[0] * (b[1] + x[0]).powf(-1.0 / b[2])),
    ("BoxBOD", |b, x| b[0] * (1.0 - (-b[1] * x[0]).exp())),
    ("Chwirut1", |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ("Chwirut2", |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ("DanWood", |b, x| b[0] * x[0].powf(b[1])),
    ("ENSO", |b, x| enso(b, x[0])),
    ("Eckerle4", |b, x| {
        b[0] / b[1] * (-0.5 * ((x[0] - b[2]) / b[1]).powi(2)).exp()
    }),
    ("Gauss1", gauss),
    ("Gauss2", gauss),
    ("Gauss3", gauss),
    ("Hahn1", |b, x| rational(b, x[0], 4)),
    ("Kirby2", |b, x| rational(b, x[0], 3)),
    ("Lanczos1", |b, x| exponentials(b, x[0])),
    ("Lanczos2", |b, x| exponentials(b, x[0])),
    ("Lanczos3", |b, x| exponentials(b, x[0])),
    ("MGH09", |b, x| {
        b[0] * (x[0] * x[0] + x[0] * b[1]) / (x[0] * x[0] + x[0] * b[2] + b[3])
    }),
    ("MGH10", |b, x| b[0] * (b[1] / (x[0] + b[2])).exp()),
    ("MGH17", |b, x| {
        b[0] + b[1] * (-x[0] * b[3]).exp() + b[2] * (-x[0] * b[4]).exp()
    }),
    ("Misra1a", |b, x| b[0] * (1.0 - (-b[1] * x[0]).exp())),
    ("Misra1b", |b, x| b[0] * (1.0 - (1.0 + b[1] * x[0] / 2.0).powi(-2))),
    ("Misra1c", |b, x| b[0] * (1.0 - (1.0 + 2.0 * b[1] * x[0]).powf(-0.5))),
    ("Misra1d", |b, x| b[0] * b[1] * x[0] / (1.0 + b[1] * x[0])),
    ("Nelson", |b, x| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()),
    ("Rat42", |b, x| b[0] / (1.0 + (b[1] - b[2] * x[0]).exp())),
    ("Rat43", |b, x| {
        b[0] / (1.0 + (b[1] - b[2] * x[0]).exp()).powf(1.0 / b[3])
    }),
    ("Roszman1", |b, x| {
        b[0] - b[1] * x[0] - (b[2] / (x[0] - b[3])).atan() / PI
    }),
    ("Thurber", |b, x| rational(b, x[0], 4)),
];

/// A problem as it is in its file.
pub struct Certified {
    pub name: &'static str,
    pub law: Law,
    pub starts: [Vec<f64>; 2],
    pub values: Vec<f64>,
    pub deviations: Vec<f64>,
    pub sum: f64,
    pub y: Vec<f64>,
    pub x: Vec<Vec<f64>>,
}

impl Certified {
    pub fn read((name, law): (&'static str, Law)) -> Self {
        let path = format!("{}/tests/data/nist_strd/{name}.dat", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().filter_map(|x| x.parse().ok()).collect() };
        let table: Vec<Vec<f64>> = text
            .lines()
            .skip(40)
            .map_while(|line| line.split_once('=').map(|(_, right)| numbers(right)))
            .collect();
        let column = |k: usize| table.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let line = text
            .lines()
            .find_map(|l| l.trim().strip_prefix("Residual Sum of Squares:"))
            .unwrap();
        let data: Vec<Vec<f64>> = text.lines().skip(60).map(numbers).filter(|row| row.len() > 1).collect();
        let log = |y: f64| if name == "Nelson" { y.ln() } else { y };
        Self {
            name,
            law,
            starts: [column(0), column(1)],
            values: column(2),
            deviations: column(3),
            sum: line.trim().parse().unwrap(),
            y: data.iter().map(|row| log(row[0])).collect(),
            x: data.iter().map(|row| row[1..].to_vec()).collect(),
        }
    }

    pub fn solve(&self, parameters: Vec<Parameter>, options: &Options<'_>) -> Fit {
        let residual = |b: &[f64]| Ok(self.x.iter().zip(&self.y).map(|(x, y)| (self.law)(b, x) - y).collect());
        solve(&Problem::new(residual, parameters), options).unwrap()
    }

    pub fn parameters(&self, start: usize) -> Vec<Parameter> {
        let named = |(i, b): (usize, &f64)| Parameter::new(format!("b{}", i + 1), *b);
        self.starts[start].iter().enumerate().map(named).collect()
    }

    /// Correct digits of the parameters, at most 11.
    pub fn digits(&self, fit: &Fit) -> f64 {
        digits(&fit.theta, &self.values)
    }

    /// Correct digits of the standard deviations, from the QR of the final Jacobian with columns of length one.
    pub fn deviation_digits(&self, fit: &Fit) -> f64 {
        let Some(derivative) = &fit.derivative else { return 0.0 };
        let mut columns = derivative.jacobian.clone();
        let norms: Vec<f64> = columns.column_iter().map(|c| c.norm()).collect();
        for (mut column, norm) in columns.column_iter_mut().zip(&norms) {
            column /= *norm;
        }
        let variance = fit.chi2() / (self.y.len() - norms.len()) as f64;
        let Some(inverse) = columns.qr().r().try_inverse() else {
            return 0.0;
        };
        let deviations: Vec<f64> = inverse
            .row_iter()
            .zip(&norms)
            .map(|(row, norm)| variance.sqrt() * row.norm() / norm)
            .collect();
        digits(&deviations, &self.deviations)
    }
}

/// Correct digits of the worst of several values, at most 11.
pub fn digits(found: &[f64], certified: &[f64]) -> f64 {
    let worst = found
        .iter()
        .zip(certified)
        .map(|(a, b)| ((a - b) / b).abs())
        .fold(0.0, f64::max);
    (-worst.log10()).min(11.0)
}

/// All problems.
pub fn all() -> Vec<Certified> {
    LAWS.iter().map(|law| Certified::read(*law)).collect()
}
