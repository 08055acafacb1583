//! Samples of uncertain inputs over a grid, and the resulting bands.

use gearloss_numerics::sampling::Sobol;
use serde::{Deserialize, Serialize};

use super::{PointOfBand, QuantityBand, UncertainInput};
use crate::analyses::common::inputs::Input;
use crate::analyses::common::trial::{Left, Trial, left};
use crate::analyses::{Engine, Run, Stopped};
use crate::numbers::{RPM, tidy};
use crate::points::{PointResult, correlation, quantile};

/// Probabilities of the ends and the middle of a band.
pub const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Memory of a point of a sample.
pub const BYTES: usize = std::mem::size_of::<PointOfSample>();

/// Values of the inputs, the solved points, and the stated ranges outside which the sample lies.
type Sample = (Vec<f64>, Vec<PointOfSample>, Left);

/// The quantities of a solved point that are kept for all samples, so they are numbers alone: not a number where there is no value.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct PointOfSample {
    /// Power out over power in. \[-\]
    efficiency: f64,
    /// Sum of all losses. \[W\]
    loss: f64,
    /// Loss over the speed of the reference port. \[Nm\]
    loss_torque: f64,
    /// Temperature of the oil. \[°C\]
    oil: f64,
    /// Power out of the DC link. \[W\]
    dc_power: f64,
    /// Loss of the drive unit. \[W\]
    unit_loss: f64,
    /// Efficiency of the drive unit. \[-\]
    system_efficiency: f64,
}

impl From<&PointResult> for PointOfSample {
    fn from(point: &PointResult) -> Self {
        let number = |x: Option<f64>| x.unwrap_or(f64::NAN);
        let unit = point.unit();
        Self {
            efficiency: number(point.efficiency),
            loss: number(point.loss),
            loss_torque: number(point.loss_torque),
            oil: number(point.oil),
            dc_power: number(unit.map(|unit| unit.dc_power_w)),
            unit_loss: number(unit.map(|unit| unit.unit_loss_w)),
            system_efficiency: number(unit.and_then(|unit| unit.system_efficiency)),
        }
    }
}

/// A quantity of a kept point.
type Read = fn(&PointOfSample) -> f64;

/// A kept number, if there is one.
fn known(x: f64) -> Option<f64> {
    (!x.is_nan()).then_some(x)
}

/// All samples of one set.
pub struct Samples {
    /// Values of the inputs and the solved points of each sample that could be built.
    pub solved: Vec<(Vec<f64>, Vec<PointOfSample>)>,
    /// Why each of the others has no value.
    pub failed: Vec<String>,
}

/// Solves all samples, independent of the number of threads. Adds quantities outside their stated ranges.
pub fn solve(
    engine: &Engine<'_>,
    count: u32,
    run: &Run<'_>,
    inputs: &[Input],
    all_left: &mut Left,
) -> Result<Samples, Stopped> {
    let sobol = Sobol::new(inputs.len()).map_err(|reason| engine.wrong("analyses", reason, "use fewer inputs"))?;
    let trial = Trial::new(engine, &run.built);
    let sample = |i: usize| -> Result<Sample, String> {
        let place = sobol.point(i as u32);
        let values: Vec<f64> = inputs
            .iter()
            .zip(place)
            .map(|(input, share)| input.value(share))
            .collect::<Result<_, _>>()?;
        let changes = inputs.iter().zip(&values);
        let changes = changes.flat_map(|(input, value)| input.range.varied.overrides(*value));
        let transmission = trial.build(changes)?;
        let solved = trial.solve(engine, &transmission, &run.points)?;
        let left = left(&transmission, &solved.seen).collect();
        Ok((values, solved.points.iter().map(PointOfSample::from).collect(), left))
    };
    let all = engine.jobs(&run.built.name, count as usize, |i| Ok(sample(i)))?;
    let (mut solved, mut failed) = (Vec::new(), Vec::new());
    for result in all {
        match result {
            Ok((values, points, more)) => {
                all_left.extend(more);
                solved.push((values, points));
            }
            Err(reason) => failed.push(reason),
        }
    }
    if solved.len() < 2 {
        let message = format!(
            "hardly any sample could be built: {}",
            failed.first().map_or("", String::as_str)
        );
        return Err(engine.wrong("analyses", message, "narrow the ranges of the inputs"));
    }
    Ok(Samples { solved, failed })
}

impl Samples {
    /// The points of the grid with their bands.
    pub fn points(&self, nominal: &[PointResult]) -> Vec<PointOfBand> {
        let point = |(i, p): (usize, &PointResult)| {
            let nominal = PointOfSample::from(p);
            let quantity = |read: Read| QuantityBand {
                nominal: known(read(&nominal)),
                band: self.band(i, read),
            };
            let efficiency_percent = quantity(|p| 100.0 * p.efficiency);
            let system_percent = quantity(|p| 100.0 * p.system_efficiency);
            PointOfBand {
                torque_nm: p.torque,
                speed_rpm: tidy(p.speed * RPM),
                // Results contain efficiencies as fractions.
                efficiency: efficiency_percent.scaled(0.01),
                loss_w: quantity(|p| p.loss),
                loss_torque_nm: quantity(|p| p.loss_torque),
                oil_temperature_degc: quantity(|p| p.oil),
                dc_power_w: quantity(|p| p.dc_power).known(),
                unit_loss_w: quantity(|p| p.unit_loss).known(),
                system_efficiency: system_percent.scaled(0.01).known(),
                system_percent,
                efficiency_percent,
            }
        };
        nominal.iter().enumerate().map(point).collect()
    }

    /// Ends and middle of the band of a quantity at a point; absent where fewer than half of the samples have a value.
    fn band(&self, point: usize, read: Read) -> Option<[f64; 3]> {
        let all = self.solved.iter();
        let mut values: Vec<f64> = all.filter_map(|(_, points)| known(read(&points[point]))).collect();
        values.sort_unstable_by(f64::total_cmp);
        (2 * values.len() > self.solved.len()).then(|| SHARES.map(|share| quantile(&values, share)))
    }

    /// The inputs with their correlation with the mean loss over the grid, the strongest first.
    pub fn ranked(&self, inputs: &[Input]) -> Vec<UncertainInput> {
        let mean = |points: &Vec<PointOfSample>| {
            let losses: Vec<f64> = points.iter().filter_map(|p| known(p.loss)).collect();
            (!losses.is_empty()).then(|| losses.iter().sum::<f64>() / losses.len() as f64)
        };
        // A sample without any loss has no mean.
        let solved: Vec<(&Vec<f64>, f64)> = self
            .solved
            .iter()
            .filter_map(|(values, points)| Some((values, mean(points)?)))
            .collect();
        let losses: Vec<f64> = solved.iter().map(|(_, loss)| *loss).collect();
        let input = |(k, input): (usize, &Input)| {
            let values: Vec<f64> = solved.iter().map(|(values, _)| values[k]).collect();
            let range = &input.range;
            UncertainInput {
                path: range.varied.pattern.clone(),
                paths: range.varied.paths.clone(),
                unit: range.varied.unit.symbol,
                from: range.ends[0],
                to: range.ends[1],
                correlation_with_mean_loss: correlation(&values, &losses),
                words: range.ends.map(|end| range.varied.words(end)),
            }
        };
        let mut ranked: Vec<UncertainInput> = inputs.iter().enumerate().map(input).collect();
        let strength = |input: &UncertainInput| input.correlation_with_mean_loss.unwrap_or(0.0).abs();
        ranked.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
        ranked
    }
}
