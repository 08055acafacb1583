//! Traction curves: points by pressure and temperature, without points dominated by heating or elastic creep.

use super::{Isotherm, TractionPoint};

/// Slide-to-roll ratio below which elastic creep of the bodies matters.
const CREEP: f64 = 0.01;
/// Relative pressure difference within which points belong to one curve: repeatability of loads.
const SAME_PRESSURE: f64 = 0.01;
/// Temperature difference within which points belong to one curve: control accuracy of baths. \[K\]
const SAME_TEMPERATURE: f64 = 1.0;

/// The points of one pressure and temperature, in order of their shear rate.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Mean pressure of the first point. \[Pa\]
    pub pressure: f64,
    /// Temperature of the first point. \[degC\]
    pub temperature: f64,
    /// The remaining points.
    pub points: Vec<TractionPoint>,
    /// Number of points omitted because of little sliding.
    pub creeping: usize,
    /// Number of points omitted because they are beyond the maximum stress, where heating dominates.
    pub heated: usize,
    /// Maximum of stress over pressure. \[-\]
    pub greatest: f64,
}

/// The curves of some points, in order of their first points; `slide_roll` is the sliding over the rolling speed of each point,
/// where it was measured.
pub fn curves(points: &[TractionPoint], slide_roll: Option<&[f64]>) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for (row, point) in points.iter().enumerate() {
        let place = curves.iter().position(|curve| curve.holds(point));
        let place = place.unwrap_or_else(|| {
            curves.push(Curve::from_point(point));
            curves.len() - 1
        });
        if slide_roll.is_some_and(|ratio| ratio[row] < CREEP) {
            curves[place].creeping += 1;
        } else {
            curves[place].points.push(*point);
        }
    }
    curves.iter_mut().for_each(Curve::cut);
    curves
}

/// Curves with at least this fraction of the maximum pressure determine the limiting stress.
const HIGHEST: f64 = 0.9;

/// The curve at the highest pressures with the maximum stress over pressure.
pub fn limiting(curves: &[Curve]) -> Option<&Curve> {
    let highest = curves.iter().map(|c| c.pressure).fold(0.0, f64::max);
    let high = curves
        .iter()
        .filter(|c| c.pressure >= HIGHEST * highest && c.greatest > 0.0);
    high.max_by(|a, b| a.greatest.total_cmp(&b.greatest))
}

impl Curve {
    fn from_point(point: &TractionPoint) -> Self {
        Self {
            pressure: point.pressure,
            temperature: point.temperature,
            points: Vec::new(),
            creeping: 0,
            heated: 0,
            greatest: 0.0,
        }
    }

    fn holds(&self, point: &TractionPoint) -> bool {
        (point.pressure / self.pressure - 1.0).abs() <= SAME_PRESSURE
            && (point.temperature - self.temperature).abs() <= SAME_TEMPERATURE
    }

    /// Omits points beyond the maximum stress.
    fn cut(&mut self) {
        self.points.sort_by(|p, q| p.shear_rate.total_cmp(&q.shear_rate));
        let greatest = self.points.iter().map(|p| p.stress).fold(0.0, f64::max);
        let last = self.points.iter().rposition(|p| p.stress == greatest);
        let keep = last.map_or(0, |last| last + 1);
        self.heated = self.points.len() - keep;
        self.points.truncate(keep);
        self.greatest = self.points.iter().map(|p| p.stress / p.pressure).fold(0.0, f64::max);
    }

    /// Slope of stress over the logarithm of the shear rate; absent where fewer than two points are on the line.
    pub fn slope(&self) -> Option<Isotherm> {
        Isotherm::slope(&self.points)
    }

    /// The least stress of the points that a slope is based on, over the slope, and the part by which the slope is too low
    /// there: Eyring's law has the slope tau0 tanh(tau/tau0).
    pub fn error_of_slope(&self, found: &Isotherm) -> (f64, f64) {
        // The points on the line have the largest stresses.
        let mut stresses: Vec<f64> = self.points.iter().map(|p| p.stress).collect();
        stresses.sort_by(|a, b| b.total_cmp(a));
        let begins = stresses[found.points - 1] / found.slope;
        (begins, 1.0 - begins.tanh())
    }

    /// Pressure and temperature as text.
    pub fn name(&self) -> String {
        format!("{:.3} GPa, {:.1} degC", self.pressure * 1e-9, self.temperature)
    }
}
