//! Losses of candidates at measured points, and the measurement.

use crate::inference::{PointSet, neighbours};

/// Losses of every candidate at each point, and of all other components.
#[derive(Debug, Clone)]
pub struct Losses<'a> {
    /// Loss of all other components, by point. \[W\]
    pub rest: &'a [f64],
    /// For each mechanism and candidate the loss by point. \[W\]
    pub mechanisms: Vec<Vec<&'a [f64]>>,
}

impl Losses<'_> {
    /// Number of combinations.
    pub fn count(&self) -> usize {
        self.mechanisms.iter().map(Vec::len).product()
    }

    /// The candidates of combination `number`, one index for each mechanism.
    pub fn combination(&self, mut number: usize) -> Vec<usize> {
        let mut places = vec![0; self.mechanisms.len()];
        for (place, mechanism) in places.iter_mut().zip(&self.mechanisms).rev() {
            *place = number % mechanism.len();
            number /= mechanism.len();
        }
        places
    }

    /// Loss of a combination at one point. \[W\]
    pub fn loss(&self, places: &[usize], factors: &[f64], point: usize) -> f64 {
        let chosen = self.mechanisms.iter().zip(places).zip(factors);
        chosen.fold(self.rest[point], |sum, ((mechanism, place), factor)| {
            sum + factor * mechanism[*place][point]
        })
    }

    /// Loss of a combination at every point. \[W\]
    pub fn of_combination(&self, places: &[usize], factors: &[f64]) -> Vec<f64> {
        (0..self.rest.len()).map(|i| self.loss(places, factors, i)).collect()
    }
}

/// Measured losses with their accuracy and groups.
#[derive(Debug, Clone)]
pub struct MeasuredLosses {
    /// \[W\]
    pub losses: Vec<f64>,
    /// Standard deviations, positive. \[W\]
    pub deviations: Vec<f64>,
    /// Weight of each point; usually one. \[-\]
    pub weights: Vec<f64>,
    /// Factor from an error in W to the printed unit; absent if the quantity does not exist.
    pub units: Vec<Option<f64>>,
    /// Indices of points that are predicted together from all others.
    pub folds: Vec<Vec<usize>>,
    /// Neighbouring points and the shapes of common errors, for the correlation of errors.
    pub points: PointSet,
}

impl MeasuredLosses {
    /// The same with common errors for points at these torques, speeds and oil temperatures. Common errors have four shapes: proportional
    /// to the accuracy, a gain of the loss, an offset of the loss, and an offset of a torque, whose power is proportional to speed.
    #[must_use]
    pub fn with_conditions(mut self, torques: &[f64], speeds: &[f64], oils: &[f64]) -> Self {
        let over = |value: &dyn Fn(usize) -> f64| {
            let list: Vec<f64> = (0..self.len()).map(|i| value(i) / self.deviations[i]).collect();
            self.weighted(&list)
        };
        let shapes = vec![
            over(&|i| self.deviations[i]),
            over(&|i| self.losses[i]),
            over(&|_| 1.0),
            over(&|i| speeds[i]),
        ];
        self.points = PointSet {
            cells: neighbours(torques, speeds, oils),
            shapes,
        };
        self
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.losses.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.losses.is_empty()
    }

    /// Residuals of losses: calculated minus measured, over the standard deviations.
    pub fn residuals(&self, losses: &[f64]) -> Vec<f64> {
        let all = losses.iter().zip(&self.losses).zip(&self.deviations);
        all.map(|((loss, measured), deviation)| (loss - measured) / deviation)
            .collect()
    }

    /// Residuals times the roots of the weights, whose sum of squares is the misfit.
    pub fn weighted(&self, residuals: &[f64]) -> Vec<f64> {
        residuals
            .iter()
            .zip(&self.weights)
            .map(|(r, w)| r * w.max(0.0).sqrt())
            .collect()
    }

    /// Differences of two lists of losses in units of the accuracy, with the weights.
    pub fn differences(&self, first: &[f64], second: &[f64]) -> Vec<f64> {
        let all = first.iter().zip(second).zip(&self.deviations);
        let list: Vec<f64> = all.map(|((a, b), deviation)| (a - b) / deviation).collect();
        self.weighted(&list)
    }
}
