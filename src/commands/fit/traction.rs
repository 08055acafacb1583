//! `fit traction`: Eyring stress and pressure exponent in three steps, and the limiting stress.
//!
//! Source: LaFountain, Johnston, Spikes, Tribol. Trans. 44 (2001) 648-656, after Johnson and Tevaarwerk 1977.

use std::path::Path;

use gearloss_framework::lubricant::roelands::Roelands;
use gearloss_numerics::least_squares::{Parameter, Problem};
use gearloss_plugins::tooth_friction::ehl_mixed::identification::{Isotherm, TractionPoint, residual};

use super::columns::Columns;
use super::curves::{Curve, QUANTITIES, curves};
use super::oil::oil;
use super::squares::{Estimate, Squares};
use crate::args::OilArgs;
use crate::output::{End, Failure, Out, Table, figures, number, significant};

const MPA: f64 = 1e6;
/// Bounds of the Eyring stress as in `lubricants`. \[MPa\]
const TAU0: [f64; 2] = [0.1, 50.0];
/// Bounds and start value of the pressure exponent.
const Z: [f64; 2] = [0.2, 1.2];
const START: f64 = 0.5;
/// Relative underestimate of a slope that is reported.
const LOW: f64 = 0.01;
/// Curves with at least this fraction of the maximum pressure determine the limiting stress.
const HIGHEST: f64 = 0.9;
/// Slopes of the limiting stress as in `lubricants`.
const LIMITING: [f64; 2] = [0.005, 0.2];

pub fn run(path: &Path, args: &OilArgs, out: &mut Out) -> Result<End, Failure> {
    let columns = Columns::read(path)?;
    let curves = curves(&columns)?;
    let law = oil(args)?.roelands(Some(START));
    let points: Vec<TractionPoint> = curves.iter().flat_map(|c| c.points.iter().copied()).collect();
    out.line(format!(
        "{}: {} of {} points on {} curves",
        columns.file(),
        points.len(),
        columns.len(),
        curves.len()
    ))?;
    if let Some(note) = columns.unused(&QUANTITIES) {
        out.line(note)?;
    }
    out.line(format!(
        "viscosity: Roelands, {} Pa s at {} degC, S0 {}",
        significant(law.eta(0.0, law.reference)),
        significant(law.reference),
        significant(law.s0)
    ))?;
    let slopes: Vec<Option<Isotherm>> = curves.iter().map(|c| Isotherm::slope(&c.points)).collect();
    out.line("\nstep 1: slope of the stress over the logarithm of the shear rate")?;
    out.text(&slopes_table(&curves, &slopes))?;
    let found: Vec<Isotherm> = slopes.iter().flatten().copied().filter(|s| s.slope > 0.0).collect();
    let (mean, spread) = Isotherm::mean(&found).ok_or_else(|| {
        Failure::input(
            format!(
                "{}: no curve with increasing stress over two shear rates",
                columns.file()
            ),
            "measure each pressure and temperature at several sliding speeds",
        )
    })?;
    out.line(format!(
        "mean {} MPa, spread {} MPa",
        significant(mean / MPA),
        significant(spread / MPA)
    ))?;
    out.text(&low_slopes(&curves, &slopes))?;
    let tau0 = (mean / MPA).clamp(TAU0[0], TAU0[1]);
    let failed = |fault: String| {
        Failure::input(
            format!("{}: {fault}", columns.file()),
            "measure at more pressures, temperatures or sliding speeds",
        )
    };
    let alone = exponent(&law, &points, tau0).map_err(failed)?;
    let both = together(&law, &points, [tau0, alone.estimates[0].value]).map_err(failed)?;
    out.text(&steps_table(tau0, &alone, &both))?;
    let limit = limiting(&curves);
    out.text(&limit_words(limit))?;
    let mut words = vec![
        format!("tau0: {} MPa", figures(both.estimates[0].value, 4)),
        format!("z: {}", figures(both.estimates[1].value, 4)),
    ];
    words.extend(
        limit
            .filter(|curve| (LIMITING[0]..=LIMITING[1]).contains(&curve.greatest))
            .map(|curve| format!("limiting_slope: {}", figures(curve.greatest, 3))),
    );
    out.line(format!("\nrheology: {{ {} }}", words.join(", ")))?;
    Ok(End::Fine)
}

/// Step 2: the exponent with the mean slope.
fn exponent(law: &Roelands, points: &[TractionPoint], tau0: f64) -> Result<Squares, String> {
    let z = Parameter::new("z", START).within(Z[0], Z[1]);
    let all = |theta: &[f64]| Ok(residuals(law, points, tau0, theta[0]));
    Squares::from_problem(&Problem::new(all, vec![z]))
}

/// Step 3: both simultaneously.
fn together(law: &Roelands, points: &[TractionPoint], [tau0, z]: [f64; 2]) -> Result<Squares, String> {
    let tau0 = Parameter::new("tau0", tau0).within(TAU0[0], TAU0[1]);
    let z = Parameter::new("z", z).within(Z[0], Z[1]);
    let all = |theta: &[f64]| Ok(residuals(law, points, theta[0], theta[1]));
    Squares::from_problem(&Problem::new(all, vec![tau0, z]))
}

/// Calculated minus measured stresses. \[MPa\]
fn residuals(law: &Roelands, points: &[TractionPoint], tau0: f64, z: f64) -> Vec<f64> {
    points.iter().map(|p| residual(law, tau0 * MPA, z, p) / MPA).collect()
}

/// The curve at the highest pressures with the maximum stress over pressure.
fn limiting(curves: &[Curve]) -> Option<&Curve> {
    let highest = curves.iter().map(|c| c.pressure).fold(0.0, f64::max);
    let high = curves
        .iter()
        .filter(|c| c.pressure >= HIGHEST * highest && c.greatest > 0.0);
    high.max_by(|a, b| a.greatest.total_cmp(&b.greatest))
}

fn limit_words(limit: Option<&Curve>) -> String {
    let Some(curve) = limit else {
        return String::new();
    };
    let said = format!(
        "\nmaximum stress over pressure at the highest pressures: {} at {}\n",
        figures(curve.greatest, 3),
        curve.name()
    );
    let end = if curve.heated > 0 {
        "beyond it the stress decreases: limiting stress or heating"
    } else {
        "the curve still increases there: the limiting stress is at least this"
    };
    format!("{said}note: {end}\n")
}

fn slopes_table(curves: &[Curve], slopes: &[Option<Isotherm>]) -> String {
    let head = [
        "pressure GPa",
        "temperature degC",
        "points",
        "creeping",
        "heated",
        "on the line",
        "slope MPa",
    ];
    let mut table = Table::new(&head);
    for (curve, slope) in curves.iter().zip(slopes) {
        table.row(vec![
            format!("{:.3}", curve.pressure * 1e-9),
            format!("{:.1}", curve.temperature),
            curve.points.len().to_string(),
            curve.creeping.to_string(),
            curve.heated.to_string(),
            number(slope.map(|s| s.points as f64), 0),
            slope.map_or_else(|| "-".to_owned(), |s| significant(s.slope / MPA)),
        ]);
    }
    let mut text = table.render();
    if curves.iter().any(|c| c.creeping > 0) {
        text.push_str("creeping: omitted, elastic creep of the bodies below 1 % sliding\n");
    }
    if curves.iter().any(|c| c.heated > 0) {
        text.push_str("heated: omitted, heating dominates beyond the maximum stress\n");
    }
    text
}

/// Underestimated slopes: the slope of Eyring's law over ln(shear rate) is tau0 tanh(tau/tau0).
fn low_slopes(curves: &[Curve], slopes: &[Option<Isotherm>]) -> String {
    let mut text = String::new();
    for (curve, slope) in curves.iter().zip(slopes) {
        let Some(Isotherm { slope, points }) = slope else {
            continue;
        };
        // The points on the line have the largest stresses.
        let mut stresses: Vec<f64> = curve.points.iter().map(|p| p.stress).collect();
        stresses.sort_by(|a, b| b.total_cmp(a));
        let least = stresses[*points - 1];
        let low = 1.0 - (least / slope).tanh();
        if low > LOW {
            text.push_str(&format!(
                "note: at {} the stress starts at {:.1} times the slope, so the slope is up to {:.0} % too low there; step 3 is not affected\n",
                curve.name(),
                least / slope,
                100.0 * low
            ));
        }
    }
    text
}

fn steps_table(tau0: f64, alone: &Squares, both: &Squares) -> String {
    let mut steps = Table::new(&["step", "tau0 MPa", "z", "residual rms MPa"]);
    let row = |name: &str, tau0: f64, z: f64, rms: f64| {
        vec![name.to_owned(), significant(tau0), significant(z), significant(rms)]
    };
    let [both_tau0, both_z] = [0, 1].map(|k| both.estimates[k].value);
    steps.row(row(
        "2: z with the mean slope",
        tau0,
        alone.estimates[0].value,
        alone.rms,
    ));
    steps.row(row("3: both by least squares", both_tau0, both_z, both.rms));
    let correlation = both
        .correlation
        .map_or_else(String::new, |r| format!("correlation of tau0 and z: {r:.3}\n"));
    format!(
        "\n{}\n{}{correlation}",
        steps.render(),
        estimates_table(&both.estimates)
    )
}

/// Parameters with standard deviations and intervals, and notes on active bounds.
pub fn estimates_table(estimates: &[Estimate]) -> String {
    let mut table = Table::new(&["parameter", "value", "standard deviation", "95 % from", "to"]);
    let dash = || "-".to_owned();
    for estimate in estimates {
        let end = |i: usize| estimate.interval.map_or_else(dash, |ends| significant(ends[i]));
        table.row(vec![
            estimate.name.clone(),
            significant(estimate.value),
            estimate.deviation.map_or_else(dash, |d| figures(d, 3)),
            end(0),
            end(1),
        ]);
    }
    let mut text = table.render();
    for held in estimates.iter().filter(|e| e.held) {
        text.push_str(&format!(
            "note: {} is at its bound, and the points favour a value beyond it: check units and the oil\n",
            held.name
        ));
    }
    text
}
