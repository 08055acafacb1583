//! Information on parameters, as the triangular factor of all rows measured so far.

use nalgebra::DMatrix;

/// Ratio of a diagonal entry to the largest below which parameters are not identifiable.
const REGULAR: f64 = 1e-12;

/// The row of a parameter with a known range only: standard deviation of a uniform distribution, range/sqrt(12).
///
/// It keeps the information regular. A parameter with a prior has the row of the prior instead.
pub fn uniform_row(parameter: usize, ranges: &[f64]) -> Vec<f64> {
    let mut row = vec![0.0; ranges.len()];
    if let Some((entry, range)) = row.get_mut(parameter).zip(ranges.get(parameter)) {
        *entry = 12.0_f64.sqrt() / range;
    }
    row
}

/// Precision of parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Precision {
    /// Logarithm of the determinant of the covariance.
    pub ln_determinant: f64,
    /// Sum of the variances, each over the square of its range.
    pub trace: f64,
    /// Standard deviation of each parameter over its range.
    pub deviations: Vec<f64>,
}

impl Precision {
    /// The largest standard deviation relative to the range.
    pub fn worst(&self) -> f64 {
        self.deviations.iter().copied().fold(0.0, f64::max)
    }
}

/// Information on parameters: the triangle of all rows, each a gradient of a measured quantity over its standard uncertainty,
/// or a prior. The product of rows with themselves is never formed.
#[derive(Debug, Clone, PartialEq)]
pub struct Information {
    ranges: Vec<f64>,
    /// Upper triangle for parameters in units of their range, row by row.
    triangle: Vec<Vec<f64>>,
}

/// Effect of one more row.
pub(super) struct Step {
    /// Variance of the row due to the parameters relative to its noise.
    pub news: f64,
    /// Changes of the parameters, in units of their range.
    pub change: Vec<f64>,
}

impl Information {
    /// From the ranges of the parameters and the known rows, in the units of the candidates.
    ///
    /// # Errors
    /// If a range is not positive, a row has the wrong length or non-finite numbers, or the rows do not identify the parameters.
    pub fn new(ranges: &[f64], rows: &[Vec<f64>]) -> Result<Self, String> {
        if let Some(bad) = ranges.iter().find(|w| !(**w > 0.0 && w.is_finite())) {
            return Err(format!("the range of a parameter must be positive, not {bad}"));
        }
        let scaled = rows
            .iter()
            .map(|row| scale(row, ranges))
            .collect::<Result<Vec<_>, _>>()?;
        let count = ranges.len();
        let known = Self {
            ranges: ranges.to_vec(),
            triangle: if count == 0 {
                Vec::new()
            } else {
                // Rows of zeros if there are fewer rows than parameters, so that the triangle is square.
                let matrix = DMatrix::from_fn(scaled.len().max(count), count, |i, k| {
                    scaled.get(i).map_or(0.0, |r| r[k])
                });
                let r = matrix.qr().r();
                (0..count).map(|i| (0..count).map(|k| r[(i, k)]).collect()).collect()
            },
        };
        let diagonal = |k: usize| known.triangle[k][k].abs();
        let greatest = (0..count).map(diagonal).fold(0.0, f64::max);
        if (0..count).any(|k| diagonal(k) <= REGULAR * greatest) || !greatest.is_finite() {
            return Err(
                "the known rows do not identify the parameters: give every parameter a range or a prior".to_owned(),
            );
        }
        Ok(known)
    }

    /// Ranges of the parameters.
    pub fn ranges(&self) -> &[f64] {
        &self.ranges
    }

    /// Adds a row in units of the ranges, by rotations.
    pub(super) fn add(&mut self, mut row: Vec<f64>) {
        for k in 0..row.len() {
            let length = self.triangle[k][k].hypot(row[k]);
            let (c, s) = (self.triangle[k][k] / length, row[k] / length);
            for (above, below) in self.triangle[k].iter_mut().zip(&mut row).skip(k) {
                (*above, *below) = (c * *above + s * *below, c * *below - s * *above);
            }
        }
    }

    /// Effect of a row in units of the ranges.
    pub(super) fn step(&self, row: &[f64]) -> Step {
        let count = row.len();
        let mut solved = row.to_vec();
        for k in 0..count {
            solved[k] /= self.triangle[k][k];
            for i in k + 1..count {
                solved[i] -= self.triangle[k][i] * solved[k];
            }
        }
        let news = solved.iter().map(|x| x * x).sum();
        Step {
            news,
            change: self.back(solved),
        }
    }

    /// Solves with the triangle.
    fn back(&self, mut x: Vec<f64>) -> Vec<f64> {
        for k in (0..x.len()).rev() {
            x[k] = (x[k] - (k + 1..x.len()).map(|i| self.triangle[k][i] * x[i]).sum::<f64>()) / self.triangle[k][k];
        }
        x
    }

    /// Variances of the parameters in units of their range.
    pub(super) fn variances(&self) -> Vec<f64> {
        let count = self.ranges.len();
        let mut variances = vec![0.0; count];
        for k in 0..count {
            let mut unit = vec![0.0; count];
            unit[k] = 1.0;
            for (variance, x) in variances.iter_mut().zip(self.back(unit)) {
                *variance += x * x;
            }
        }
        variances
    }

    /// Precision of the parameters.
    pub fn precision(&self) -> Precision {
        let variances = self.variances();
        let terms = self.triangle.iter().enumerate().zip(&self.ranges);
        Precision {
            ln_determinant: terms
                .map(|((k, row), range)| 2.0 * (range.ln() - row[k].abs().ln()))
                .sum(),
            trace: variances.iter().sum(),
            deviations: variances.into_iter().map(f64::sqrt).collect(),
        }
    }
}

/// A row in units of the ranges.
pub(super) fn scale(row: &[f64], ranges: &[f64]) -> Result<Vec<f64>, String> {
    if row.len() != ranges.len() {
        return Err(format!(
            "a row of {} entries for {} parameters",
            row.len(),
            ranges.len()
        ));
    }
    let scaled: Vec<f64> = row.iter().zip(ranges).map(|(g, w)| g * w).collect();
    // Squares are summed later.
    if scaled.iter().all(|g| (g * g).is_finite()) {
        Ok(scaled)
    } else {
        Err("a row has entries that are not finite, or too large".to_owned())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn near(x: f64, y: f64) {
        assert!((x - y).abs() <= 1e-13 * y.abs(), "{x} {y}");
    }

    #[test]
    fn ranges_alone_are_even_distributions() {
        let ranges = [2.0, 0.5];
        let rows: Vec<Vec<f64>> = (0..2).map(|k| uniform_row(k, &ranges)).collect();
        let precision = Information::new(&ranges, &rows).unwrap().precision();
        for deviation in &precision.deviations {
            near(*deviation, 1.0 / 12.0_f64.sqrt());
        }
        near(precision.trace, 1.0 / 6.0);
        near(precision.ln_determinant, (4.0_f64 / 12.0 * 0.25 / 12.0).ln());
        near(precision.worst(), 1.0 / 12.0_f64.sqrt());
    }

    #[test]
    fn rows_one_by_one_are_rows_all_at_once() {
        let ranges = [1.0, 3.0, 0.1];
        let rows: Vec<Vec<f64>> = [[1.0, 0.2, 3.0], [0.0, 5.0, 1.0], [2.0, 1.0, 9.0], [1.0, -1.0, 4.0]]
            .map(Vec::from)
            .into();
        let mut one_by_one = Information::new(&ranges, &rows[..3]).unwrap();
        let step = one_by_one.step(&scale(&rows[3], &ranges).unwrap());
        let before = one_by_one.precision();
        one_by_one.add(scale(&rows[3], &ranges).unwrap());
        let [a, b] = [
            one_by_one.precision(),
            Information::new(&ranges, &rows).unwrap().precision(),
        ];
        near(a.ln_determinant, b.ln_determinant);
        near(a.trace, b.trace);
        near(before.ln_determinant - step.news.ln_1p(), a.ln_determinant);
        let squares: f64 = step.change.iter().map(|v| v * v).sum();
        assert!((before.trace - squares / (1.0 + step.news) - a.trace).abs() < 1e-12 * before.trace);
    }

    #[test]
    fn a_plan_without_information_is_refused() {
        assert!(
            Information::new(&[1.0, 1.0], &[vec![1.0, 1.0]])
                .unwrap_err()
                .contains("prior")
        );
        assert!(Information::new(&[1.0], &[]).is_err());
        assert!(Information::new(&[0.0], &[vec![1.0]]).is_err());
        assert!(Information::new(&[1.0], &[vec![1.0, 2.0]]).is_err());
        assert!(Information::new(&[1.0], &[vec![f64::NAN]]).is_err());
        assert!(Information::new(&[], &[]).is_ok());
        assert_eq!(uniform_row(5, &[1.0]), [0.0]);
    }
}
