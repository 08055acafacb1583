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

/// Memory of a point of a sample, with or without machines.
pub fn bytes(has_machines: bool) -> usize {
    std::mem::size_of::<f64>() * if has_machines { OF_UNIT } else { OF_GEARBOX }
}

/// Values of the inputs, the solved points, and the stated ranges outside which the sample lies.
type Sample = (Vec<f64>, KeptPoints, Left);

/// A quantity of a solved point that is kept for all samples.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kept {
    /// Power out over power in. \[-\]
    Efficiency,
    /// Sum of all losses. \[W\]
    Loss,
    /// Loss over the speed of the reference port. \[Nm\]
    LossTorque,
    /// Temperature of the oil. \[°C\]
    Oil,
    /// Power out of the DC link. \[W\]
    DcPower,
    /// Loss of the drive unit. \[W\]
    UnitLoss,
    /// Efficiency of the drive unit. \[-\]
    SystemEfficiency,
}

/// Number of quantities without machines, and with them.
const OF_GEARBOX: usize = Kept::DcPower as usize;
const OF_UNIT: usize = Kept::SystemEfficiency as usize + 1;

/// The quantities of the points of a sample, as numbers alone: not a number where there is no value.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct KeptPoints {
    /// Number of quantities of a point.
    width: usize,
    /// Those of each point.
    numbers: Vec<f64>,
}

impl KeptPoints {
    fn of(points: &[PointResult]) -> Self {
        let has_machines = points.iter().any(|point| point.unit().is_some());
        let width = if has_machines { OF_UNIT } else { OF_GEARBOX };
        let mut numbers = Vec::with_capacity(points.len() * width);
        for point in points {
            let unit = point.unit();
            let all: [Option<f64>; OF_UNIT] = [
                point.efficiency,
                point.loss,
                point.loss_torque,
                point.oil,
                unit.map(|unit| unit.dc_power_w),
                unit.map(|unit| unit.unit_loss_w),
                unit.and_then(|unit| unit.system_efficiency),
            ];
            numbers.extend(all[..width].iter().map(|x| x.unwrap_or(f64::NAN)));
        }
        Self { width, numbers }
    }

    /// A quantity of a point, if it has a value.
    fn get(&self, point: usize, quantity: Kept) -> Option<f64> {
        let own = &self.numbers[point * self.width..][..self.width];
        own.get(quantity as usize).copied().filter(|x| !x.is_nan())
    }

    /// A quantity of all points that have a value.
    fn all(&self, quantity: Kept) -> impl Iterator<Item = f64> {
        let points = self.numbers.len() / self.width;
        (0..points).filter_map(move |point| self.get(point, quantity))
    }
}

/// All samples of one set.
pub struct Samples {
    /// Values of the inputs and the solved points of each sample that could be built.
    pub solved: Vec<(Vec<f64>, KeptPoints)>,
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
        Ok((values, KeptPoints::of(&solved.points), left))
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
        let kept = KeptPoints::of(nominal);
        let point = |(i, p): (usize, &PointResult)| {
            let scaled = |quantity: Kept, factor: f64| QuantityBand {
                nominal: kept.get(i, quantity).map(|x| factor * x),
                band: self.band(i, quantity, factor),
            };
            let own = |quantity: Kept| scaled(quantity, 1.0);
            let efficiency_percent = scaled(Kept::Efficiency, 100.0);
            let system_percent = scaled(Kept::SystemEfficiency, 100.0);
            PointOfBand {
                torque_nm: p.torque,
                speed_rpm: tidy(p.speed * RPM),
                // Results contain efficiencies as fractions.
                efficiency: efficiency_percent.scaled(0.01),
                loss_w: own(Kept::Loss),
                loss_torque_nm: own(Kept::LossTorque),
                oil_temperature_degc: own(Kept::Oil),
                dc_power_w: own(Kept::DcPower).known(),
                unit_loss_w: own(Kept::UnitLoss).known(),
                system_efficiency: system_percent.scaled(0.01).known(),
                system_percent,
                efficiency_percent,
            }
        };
        nominal.iter().enumerate().map(point).collect()
    }

    /// Ends and middle of the band of a quantity, times a factor, at a point; absent where fewer than half of the samples have a value.
    fn band(&self, point: usize, quantity: Kept, factor: f64) -> Option<[f64; 3]> {
        let all = self.solved.iter();
        let all = all.filter_map(|(_, points)| points.get(point, quantity));
        let mut values: Vec<f64> = all.map(|x| factor * x).collect();
        values.sort_unstable_by(f64::total_cmp);
        (2 * values.len() > self.solved.len()).then(|| SHARES.map(|share| quantile(&values, share)))
    }

    /// The inputs with their correlation with the mean loss over the grid, the strongest first.
    pub fn ranked(&self, inputs: &[Input]) -> Vec<UncertainInput> {
        let mean = |points: &KeptPoints| {
            let losses: Vec<f64> = points.all(Kept::Loss).collect();
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
