//! What uncertain inputs do: samples of all inputs, solved over a grid, and the bands that they leave.

use gearloss_numerics::sampling::Sobol;
use gearloss_report::plot::{Line, Stroke};
use gearloss_report::{Figure, Map};
use gearloss_studies::analysis::{PointResult, Points, correlation, quantile};
use gearloss_studies::study::UncertaintyEntry;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::super::solve::RPM;
use super::write::{cell, head, picture, write};
use super::{Built, Runner, grid_axes};
use crate::commands::run::shown::show_published;
use crate::interrupt;
use crate::output::{Failure, Out, Table, fixed, number};
use gearloss_report::text::spread;
use gearloss_studies::analyses::inputs::Input;
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::analyses::trial::{Left, Trial, left};

/// A quantity: name in results, in words, how to read it.
type Quantity = (&'static str, &'static str, fn(&PointResult) -> Option<f64>);

const QUANTITIES: [Quantity; 4] = [
    ("efficiency", "efficiency in %", |p| p.efficiency.map(|e| 100.0 * e)),
    ("loss_w", "loss in W", |p| p.loss),
    ("loss_torque_nm", "loss torque in Nm", |p| p.loss_torque),
    ("oil_temperature_degc", "oil temperature in degC", |p| p.oil),
];

/// Shares of the samples below the ends and the middle of a band.
const SHARES: [f64; 3] = [0.025, 0.5, 0.975];

/// Values of the inputs, the solved points, and which stated ranges were left: path and quantity.
type Sample = (Vec<f64>, Vec<PointResult>, Vec<(String, &'static str)>);

/// All samples of one set.
struct Sampled<'a> {
    built: Built<'a>,
    inputs: Vec<Input>,
    torques: Vec<f64>,
    speeds: Vec<f64>,
    nominal: Vec<PointResult>,
    /// Values of the inputs and the solved points of each sample that could be built.
    samples: Vec<(Vec<f64>, Vec<PointResult>)>,
    failed: Vec<String>,
}

pub fn run(runner: &Runner<'_>, name: &str, entry: &UncertaintyEntry, out: &mut Out) -> Result<(), Failure> {
    let path = format!("analyses.{name}");
    let (_, gearbox) = runner.study.gearbox(&path, entry.gearbox.as_ref())?;
    let grid = runner.study.grid(&path, &entry.grid)?;
    if !grid.bind.is_empty() || grid.envelope.is_some() {
        let message = "a band takes a grid without bound values and envelope";
        return Err(runner.wrong(&path, message, "give it a grid of its own"));
    }
    let mut all = Vec::new();
    let built = runner.built(gearbox, &entry.model_sets)?;
    let gear = &runner.one_gear(&path, grid, &built[0].transmission)?;
    for built in built {
        let (torques, speeds) = grid_axes(runner, &entry.grid, grid, &built.transmission)?;
        let points = runner.points(&built.transmission, gear, torques.clone(), speeds.clone());
        runner.holds(&format!("{path}.samples"), points.field.len(), entry.samples as usize)?;
        let inputs = Input::all(runner, &path, &entry.inputs, &built)?;
        if runner.checked(&built, &points)? {
            continue;
        }
        let nominal = runner.solve(&built, &points)?.points;
        let (samples, failed) = sample(runner, entry, &built, &inputs, &points, out)?;
        all.push(Sampled {
            built,
            inputs,
            torques,
            speeds,
            nominal,
            samples,
            failed,
        });
    }
    if runner.only_checks {
        return Ok(());
    }
    let mut header: Vec<String> = ["model_set", "gear", "torque_nm", "speed_rpm"]
        .map(str::to_owned)
        .to_vec();
    for (quantity, ..) in QUANTITIES {
        header.extend(["", "_low", "_median", "_high"].map(|end| format!("{quantity}{end}")));
    }
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for s in &all {
        let bands: Vec<Vec<Option<[f64; 3]>>> = QUANTITIES.iter().map(|(.., of)| s.bands(*of)).collect();
        for (i, p) in s.nominal.iter().enumerate() {
            let mut row = vec![s.built.name.clone(), gear.clone()];
            row.extend([cell(Some(p.torque)), cell(Some(tidy(p.speed * RPM)))]);
            for ((name, _, of), bands) in QUANTITIES.iter().zip(&bands) {
                // Results hold efficiencies as shares.
                let scale = if *name == "efficiency" { 0.01 } else { 1.0 };
                row.push(cell(of(p).map(|x| scale * x)));
                row.extend((0..3).map(|k| cell(bands[i].map(|b| scale * b[k]))));
            }
            rows.push(row);
        }
        let ranked = s.ranked();
        show(name, s, &bands, &ranked, out)?;
        show_published(s.inputs.iter().map(|input| &input.range.varied), out)?;
        results.push(s.result(gear, &bands, &ranked));
        pictures(runner, name, entry, s, &bands)?;
    }
    let mut value = head(runner, &all.iter().map(|s| &s.built).collect::<Vec<_>>());
    value["bands"] = Value::Array(results);
    write(runner, name, &entry.write, &header, &rows, &value)
}

/// Solves all samples; the same whatever the number of threads.
fn sample(
    runner: &Runner<'_>,
    entry: &UncertaintyEntry,
    built: &Built<'_>,
    inputs: &[Input],
    points: &Points,
    out: &mut Out,
) -> Result<(Vec<(Vec<f64>, Vec<PointResult>)>, Vec<String>), Failure> {
    let failed = |reason: String| runner.wrong("analyses", reason, "use fewer inputs");
    let sobol = Sobol::new(inputs.len()).map_err(failed)?;
    let trial = Trial::new(runner, built);
    let bar = runner.bar(u64::from(entry.samples), &built.name);
    let one = |i: u32| -> Result<Sample, String> {
        let place = sobol.point(i);
        let values: Vec<f64> = inputs
            .iter()
            .zip(place)
            .map(|(input, share)| input.value(share))
            .collect::<Result<_, _>>()?;
        let changes = inputs.iter().zip(&values);
        let changes = changes.flat_map(|(input, value)| input.range.varied.overrides(*value));
        let transmission = trial.build(changes)?;
        let solved = trial.solve(&transmission, points)?;
        bar.inc(1);
        let left = left(&transmission, &solved.seen).collect();
        Ok((values, solved.points, left))
    };
    let all: Vec<_> = (0..entry.samples).into_par_iter().with_max_len(1).map(one).collect();
    ProgressBar::finish_and_clear(&bar);
    if interrupt::pressed() {
        return Err(Failure::Interrupted);
    }
    let (mut samples, mut failed) = (Vec::new(), Vec::new());
    let mut left = Left::new();
    for result in all {
        match result {
            Ok((values, points, more)) => {
                left.extend(more);
                samples.push((values, points));
            }
            Err(reason) => failed.push(reason),
        }
    }
    runner.left_at_samples(&left, out);
    if samples.len() < 2 {
        let message = format!(
            "hardly a sample could be built: {}",
            failed.first().map_or("", String::as_str)
        );
        return Err(runner.wrong("analyses", message, "narrow the ranges of the inputs"));
    }
    Ok((samples, failed))
}

impl Sampled<'_> {
    /// Ends and middle of the band of a quantity at each point; absent where fewer than half of the samples have a value.
    fn bands(&self, of: fn(&PointResult) -> Option<f64>) -> Vec<Option<[f64; 3]>> {
        let band = |i: usize| {
            let mut values: Vec<f64> = self.samples.iter().filter_map(|(_, points)| of(&points[i])).collect();
            values.sort_by(f64::total_cmp);
            (2 * values.len() > self.samples.len()).then(|| SHARES.map(|share| quantile(&values, share)))
        };
        (0..self.nominal.len()).map(band).collect()
    }

    /// Correlation of each input with the mean loss over the grid, the strongest first.
    fn ranked(&self) -> Vec<(usize, Option<f64>)> {
        let mean = |points: &Vec<PointResult>| {
            let losses: Vec<f64> = points.iter().filter_map(|p| p.loss).collect();
            (!losses.is_empty()).then(|| losses.iter().sum::<f64>() / losses.len() as f64)
        };
        // A sample without any loss has no mean.
        let solved = || {
            self.samples
                .iter()
                .filter_map(|(values, points)| Some((values, mean(points)?)))
        };
        let losses: Vec<f64> = solved().map(|(_, loss)| loss).collect();
        let of = |k: usize| {
            let values: Vec<f64> = solved().map(|(values, _)| values[k]).collect();
            (k, correlation(&values, &losses))
        };
        let mut ranked: Vec<_> = (0..self.inputs.len()).map(of).collect();
        ranked.sort_by(|a, b| b.1.unwrap_or(0.0).abs().total_cmp(&a.1.unwrap_or(0.0).abs()));
        ranked
    }

    fn result(&self, gear: &str, bands: &[Vec<Option<[f64; 3]>>], ranked: &[(usize, Option<f64>)]) -> Value {
        let input = |(k, correlation): &(usize, Option<f64>)| {
            let input = &self.inputs[*k];
            json!({
                "path": input.range.varied.pattern, "paths": input.range.varied.paths, "unit": input.range.varied.unit.symbol,
                "from": input.range.ends[0], "to": input.range.ends[1], "correlation_with_mean_loss": correlation,
            })
        };
        let point = |(i, p): (usize, &PointResult)| {
            let mut point = json!({ "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM) });
            for ((name, _, of), bands) in QUANTITIES.iter().zip(bands) {
                let scale = if *name == "efficiency" { 0.01 } else { 1.0 };
                let band = bands[i].map(|b| b.map(|x| scale * x));
                point[*name] = json!({ "nominal": of(p).map(|x| scale * x), "band": band });
            }
            point
        };
        json!({
            "model_set": self.built.name, "gear": gear, "samples": self.samples.len(), "failed": self.failed.len(),
            "quantiles": SHARES, "inputs": ranked.iter().map(input).collect::<Vec<_>>(),
            "points": self.nominal.iter().enumerate().map(point).collect::<Vec<_>>(),
        })
    }
}

fn show(
    name: &str,
    s: &Sampled<'_>,
    bands: &[Vec<Option<[f64; 3]>>],
    ranked: &[(usize, Option<f64>)],
    out: &mut Out,
) -> Result<(), Failure> {
    out.line(format!("{name}: {} samples, models {}", s.samples.len(), s.built.name))?;
    if let Some(reason) = s.failed.first() {
        out.line(format!("{} further samples have no value: {reason}", s.failed.len()))?;
    }
    let mut table = Table::new(&["input", "from", "to", "correlation with the mean loss"]);
    for (k, correlation) in ranked {
        let input = &s.inputs[*k];
        table.row(vec![
            input.range.varied.pattern.clone(),
            input.range.varied.words(input.range.ends[0]),
            input.range.varied.words(input.range.ends[1]),
            number(*correlation, 3),
        ]);
    }
    out.text(&table.render())?;
    out.line("")?;
    out.line("efficiency in %: half of the width of the 95 % band")?;
    let columns = s.speeds.len();
    let shown = spread(columns);
    let mut titles = vec!["torque Nm".to_owned()];
    titles.extend(shown.iter().map(|i| format!("{} rpm", fixed(s.speeds[*i] * RPM, 0))));
    let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
    for t in spread(s.torques.len()) {
        let mut row = vec![format!("{}", tidy(s.torques[t]))];
        row.extend(
            shown
                .iter()
                .map(|i| number(bands[0][t * columns + i].map(|b| 0.5 * (b[2] - b[0])), 3)),
        );
        table.row(row);
    }
    out.text(&table.render())?;
    out.line("")?;
    Ok(())
}

/// Maps of the width of the bands, and the bands themselves over speed at a few torques.
fn pictures(
    runner: &Runner<'_>,
    name: &str,
    entry: &UncertaintyEntry,
    s: &Sampled<'_>,
    bands: &[Vec<Option<[f64; 3]>>],
) -> Result<(), Failure> {
    let columns = s.speeds.len();
    let set = &s.built.name;
    for ((short, long, of), bands) in QUANTITIES.iter().zip(bands) {
        let width = |b: &Option<[f64; 3]>| b.map(|b| 0.5 * (b[2] - b[0]));
        // A given temperature has no band.
        if bands.iter().all(|b| width(b).is_none_or(|w| w == 0.0)) {
            continue;
        }
        if columns > 1 && s.torques.len() > 1 {
            let figure = Figure::Map(Map {
                title: format!("{name}: half of the 95 % band of the {long}, models {set}"),
                x: (
                    "speed rpm".to_owned(),
                    s.speeds.iter().map(|w| format!("{}", tidy(w * RPM))).collect(),
                ),
                y: (
                    "torque Nm".to_owned(),
                    s.torques.iter().map(|t| format!("{}", tidy(*t))).collect(),
                ),
                values: bands.iter().map(width).collect(),
                ..Map::default()
            });
            picture(runner, &format!("{name}-{set}-{short}-width"), figure, &entry.write)?;
        }
        for t in spread(s.torques.len()).into_iter().step_by(3) {
            let line = |words: &str, stroke: Stroke, of: &dyn Fn(usize) -> Option<f64>| Line {
                name: words.to_owned(),
                points: (0..columns)
                    .map(|i| Some((s.speeds[i] * RPM, of(t * columns + i)?)))
                    .collect(),
                stroke,
            };
            let figure = Figure::Lines {
                title: format!(
                    "{name}: {long} with its 95 % band, {} Nm, models {set}",
                    tidy(s.torques[t])
                ),
                x: "speed in rpm".to_owned(),
                y: (*long).to_owned(),
                lines: vec![
                    line("nominal", Stroke::Marked, &|i| of(&s.nominal[i])),
                    line("median", Stroke::Line, &|i| bands[i].map(|b| b[1])),
                    line("2.5 %", Stroke::Line, &|i| bands[i].map(|b| b[0])),
                    line("97.5 %", Stroke::Line, &|i| bands[i].map(|b| b[2])),
                ],
            };
            let file = format!("{name}-{set}-{short}-{}Nm", tidy(s.torques[t]));
            picture(runner, &file, figure, &entry.write)?;
        }
    }
    Ok(())
}
