//! A grid of points: every torque at every speed.

use rayon::prelude::*;

use super::{OilTemperature, sums};
use crate::document::Diagnostic;
use crate::evaluate::{Point, PowerFlow};
use crate::flow::{Status, Tolerance};
use crate::loss::{Extent, Undefined};
use crate::thermal::{Equilibrium, Outcome as ThermalOutcome};
use crate::transmission::{Case, Transmission};

/// Points per task; fixed, so that the bits do not hang on the number of threads.
const CHUNK: usize = 64;

/// The points of a grid and how they are prescribed.
#[derive(Debug, Clone)]
pub struct Points {
    /// Gear state.
    pub gear: String,
    /// Port with given torque.
    pub torque_at: String,
    /// Port with given speed.
    pub speed_at: String,
    /// Torques. \[Nm\]
    pub torques: Vec<f64>,
    /// Speeds. \[rad/s\]
    pub speeds: Vec<f64>,
    /// Temperature of the oil.
    pub oil: OilTemperature,
    /// Real or ideal flow.
    pub flow: PowerFlow,
}

/// One solved point, as numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct PointResult {
    /// Given torque. \[Nm\]
    pub torque: f64,
    /// Given speed. \[rad/s\]
    pub speed: f64,
    /// Temperature of the oil; absent where no balance was found, and with it everything that hangs on it. \[degC\]
    pub oil: Option<f64>,
    /// Temperature of the surface, where it was found by balance. \[degC\]
    pub surface: Option<f64>,
    /// What became of the balance, where the temperature is not given.
    pub balance: Option<ThermalOutcome>,
    /// What the transmission does.
    pub status: Status,
    /// Power out over power in.
    pub efficiency: Option<f64>,
    /// Sum of all losses. \[W\]
    pub loss: Option<f64>,
    /// Loss over the speed of the reference port. \[Nm\]
    pub loss_torque: Option<f64>,
    /// Power in. \[W\]
    pub input: Option<f64>,
    /// Power out. \[W\]
    pub output: Option<f64>,
    /// The usual sums, in the order of [`super::SUMS`]. \[W\]
    pub sums: [f64; 6],
    /// Losses of all parts, in the order of the parts. \[W\]
    pub parts: Vec<f64>,
    /// Why a loss has no value: number of the part and the reason.
    pub undefined: Option<(usize, Undefined)>,
    /// Passes over the loss models.
    pub passes: usize,
    /// Evaluations of the point on the way to its temperature.
    pub evaluations: usize,
}

impl PointResult {
    /// Without all that hangs on a temperature that was not found.
    fn without_temperature(self) -> Self {
        Self {
            oil: None,
            efficiency: None,
            loss: None,
            loss_torque: None,
            input: None,
            output: None,
            sums: [0.0; 6],
            parts: vec![0.0; self.parts.len()],
            ..self
        }
    }
}

/// A solved grid: torques outside, speeds inside.
#[derive(Debug, Clone)]
pub struct GridResult {
    /// The points.
    pub points: Vec<PointResult>,
    /// What was seen of limits and observed quantities over all points.
    pub seen: Vec<Extent>,
    /// Wall time is no result; calls of loss models are: the sum of passes.
    pub passes: usize,
}

impl Points {
    /// The case of these points.
    ///
    /// # Errors
    /// If the gear state or a port is unknown, or the prescription does not fit.
    pub fn case(&self, transmission: &Transmission) -> Result<Case, Vec<Diagnostic>> {
        let state = transmission.state(&self.gear).map_err(|e| vec![e])?;
        let torques: &[&str] = if transmission.torques_needed(state) == 0 {
            &[]
        } else {
            &[&self.torque_at]
        };
        transmission.case(&self.gear, &[&self.speed_at], torques)
    }
}

/// Solves all points of a grid.
///
/// # Errors
/// If the case does not fit.
pub fn run_grid(
    transmission: &Transmission,
    points: &Points,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<GridResult, Vec<Diagnostic>> {
    let case = points.case(transmission)?;
    let all: Vec<(f64, f64)> = points
        .torques
        .iter()
        .flat_map(|t| points.speeds.iter().map(move |w| (*t, *w)))
        .collect();
    let solved: Vec<(Vec<PointResult>, Vec<Extent>)> = all
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut scratch = transmission.scratch(&case);
            let mut temperatures = vec![0.0; transmission.nodes()];
            let results = chunk
                .iter()
                .map(|(torque, speed)| {
                    let given = [*torque];
                    let point = Point {
                        speeds: &[*speed],
                        torques: &given[..case.torque_ports.len()],
                        flow: points.flow,
                        tolerance: Tolerance::default(),
                    };
                    let (oil, balance) = points.oil.find(transmission, &case, &point, &mut scratch);
                    temperatures.fill(oil);
                    let solution = transmission.evaluate(&case, &point, &temperatures, &mut scratch);
                    let mut totals = [0.0; 6];
                    for (part, loss) in solution.parts() {
                        sums::add(&mut totals, transmission, part, &loss);
                    }
                    let found = balance.as_ref().is_none_or(|b| b.oil().is_some());
                    let result = PointResult {
                        torque: *torque,
                        speed: *speed,
                        oil: Some(oil),
                        surface: balance.as_ref().and_then(|b| b.surface),
                        balance: balance.as_ref().map(|b| b.outcome),
                        evaluations: balance.as_ref().map_or(0, Equilibrium::evaluations),
                        status: solution.status(),
                        efficiency: solution.efficiency(),
                        loss: solution.loss(),
                        loss_torque: solution.loss_torque(),
                        input: solution.input_power(),
                        output: solution.output_power(),
                        sums: totals,
                        parts: solution.watts().to_vec(),
                        undefined: solution.undefined_part(),
                        passes: solution.passes(),
                    };
                    if found { result } else { result.without_temperature() }
                })
                .collect();
            progress(chunk.len());
            (results, scratch.totals)
        })
        .collect();
    let mut seen: Vec<Extent> = Vec::new();
    let mut results = Vec::with_capacity(all.len());
    for (points, totals) in solved {
        merge(&mut seen, &totals);
        results.extend(points);
    }
    let passes = results.iter().map(|p| p.passes).sum();
    Ok(GridResult {
        points: results,
        seen,
        passes,
    })
}

/// Adds what was seen of limits and observed quantities to what was seen before; both in the order of one transmission.
pub fn merge(total: &mut Vec<Extent>, more: &[Extent]) {
    if total.is_empty() {
        total.extend_from_slice(more);
    } else {
        for (a, b) in total.iter_mut().zip(more) {
            *a = a.merge(*b);
        }
    }
}
