//! `fit traction`: Eyring stress and pressure exponent in three steps, and the limiting stress.
//!
//! Source: LaFountain, Johnston, Spikes, Tribol. Trans. 44 (2001) 648-656, after Johnson and Tevaarwerk 1977.

use std::path::Path;

use gearloss_framework::document::{Diagnostic, Dimension};
use gearloss_plugins::tooth_friction::ehl_mixed::identification::{
    Curve, Isotherm, START, TractionFit, TractionPoint, curves, limiting,
};
use gearloss_studies::fit::columns::{Columns, Measure, Quantity};

use super::oil::oil;
use super::{estimates_table, print_unused};
use crate::args::OilArgs;
use crate::output::{End, Failure, Out, Table, figures, number, significant};

const MPA: f64 = 1e6;
/// Relative underestimate of a slope that is reported.
const LOW: f64 = 0.01;
/// Slopes of the limiting stress as in `lubricants`.
const LIMITING: [f64; 2] = [0.005, 0.2];

const PRESSURE: Quantity = Quantity::new("pressure", Measure::Of(Dimension::Pressure), "GPa");
const TEMPERATURE: Quantity = Quantity::new("temperature", Measure::Of(Dimension::Temperature), "degC");
const SHEAR_RATE: Quantity = Quantity::new("shear_rate", Measure::ShearRate, "1/s");
const SLIDING: Quantity = Quantity::new("sliding", Measure::Of(Dimension::Speed), "m/s");
const FILM: Quantity = Quantity::new("film", Measure::Of(Dimension::Length), "nm");
const STRESS: Quantity = Quantity::new("stress", Measure::Of(Dimension::Pressure), "MPa");
const MU: Quantity = Quantity::plain("mu");
const SLIDE_ROLL: Quantity = Quantity::plain("slide_roll");

const QUANTITIES: [Quantity; 8] = [PRESSURE, TEMPERATURE, SHEAR_RATE, SLIDING, FILM, STRESS, MU, SLIDE_ROLL];

pub fn run(path: &Path, args: &OilArgs, out: &mut Out) -> Result<End, Failure> {
    let columns = super::columns(path)?;
    let measured = points(&columns)?;
    let slide_roll = columns.has(&SLIDE_ROLL).then(|| columns.numbers(&SLIDE_ROLL));
    let curves = curves(&measured, slide_roll.transpose()?.as_deref());
    let law = oil(args)?.roelands(Some(START));
    let points: Vec<TractionPoint> = curves.iter().flat_map(|c| c.points.iter().copied()).collect();
    out.line(format!(
        "{}: {} of {} points on {} curves",
        path.display(),
        points.len(),
        measured.len(),
        curves.len()
    ))?;
    print_unused(&columns, &QUANTITIES, out)?;
    out.line(format!(
        "viscosity: Roelands, {} Pa s at {} degC, S0 {}",
        significant(law.eta(0.0, law.reference)),
        significant(law.reference),
        significant(law.s0)
    ))?;
    let slopes: Vec<Option<Isotherm>> = curves.iter().map(Curve::slope).collect();
    out.line("\nstep 1: slope of stress over the logarithm of the shear rate")?;
    out.text(&slopes_table(&curves, &slopes))?;
    let found: Vec<Isotherm> = slopes.iter().flatten().copied().filter(|s| s.slope > 0.0).collect();
    let (mean, spread) = Isotherm::mean(&found).ok_or_else(|| {
        Failure::input(
            format!(
                "{}: no curve with increasing stress over two shear rates",
                path.display()
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
    let fit = TractionFit::new(&law, &points, mean).map_err(|fault| {
        Failure::input(
            format!("{}: {fault}", path.display()),
            "measure at more pressures, temperatures or sliding speeds",
        )
    })?;
    out.text(&steps_table(&fit))?;
    let limit = limiting(&curves);
    out.text(&limit_words(limit))?;
    let mut words = vec![
        format!("tau0: {} MPa", figures(fit.both.estimates[0].value, 4)),
        format!("z: {}", figures(fit.both.estimates[1].value, 4)),
    ];
    words.extend(
        limit
            .filter(|curve| (LIMITING[0]..=LIMITING[1]).contains(&curve.greatest))
            .map(|curve| format!("limiting_slope: {}", figures(curve.greatest, 3))),
    );
    out.line(format!("\nrheology: {{ {} }}", words.join(", ")))?;
    Ok(End::Fine)
}

fn points(columns: &Columns) -> Result<Vec<TractionPoint>, Diagnostic> {
    let pressure = columns.numbers(&PRESSURE)?;
    let temperature = columns.numbers(&TEMPERATURE)?;
    if let Some(row) = temperature.iter().position(|t| !(-60.0..=300.0).contains(t)) {
        let message = format!("{} degC is not a valid oil temperature", temperature[row]);
        return Err(columns.wrong(
            Some(row),
            &message,
            "write a temperature from -60 to 300 degC, and check the unit",
        ));
    }
    columns.either(&SHEAR_RATE, &[SLIDING, FILM])?;
    let shear_rate = if columns.has(&SHEAR_RATE) {
        columns.numbers(&SHEAR_RATE)?
    } else {
        let film = columns.numbers(&FILM)?;
        columns
            .numbers(&SLIDING)?
            .iter()
            .zip(film)
            .map(|(v, h)| v / h)
            .collect()
    };
    columns.either(&STRESS, &[MU])?;
    let stress: Vec<f64> = if columns.has(&STRESS) {
        columns.numbers(&STRESS)?
    } else {
        columns
            .numbers(&MU)?
            .iter()
            .zip(&pressure)
            .map(|(mu, p)| mu * p)
            .collect()
    };
    let point = |row: usize| TractionPoint {
        pressure: pressure[row],
        temperature: temperature[row],
        shear_rate: shear_rate[row],
        stress: stress[row],
    };
    Ok((0..pressure.len()).map(point).collect())
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

/// Underestimated slopes.
fn low_slopes(curves: &[Curve], slopes: &[Option<Isotherm>]) -> String {
    let mut text = String::new();
    for (curve, slope) in curves.iter().zip(slopes) {
        let Some(slope) = slope else {
            continue;
        };
        let (begins, low) = curve.error_of_slope(slope);
        if low > LOW {
            text.push_str(&format!(
                "note: at {} the stress starts at {:.1} times the slope, so the slope is up to {:.0} % too low there; step 3 is not affected\n",
                curve.name(),
                begins,
                100.0 * low
            ));
        }
    }
    text
}

fn steps_table(fit: &TractionFit) -> String {
    let TractionFit { tau0, exponent, both } = fit;
    let mut steps = Table::new(&["step", "tau0 MPa", "z", "residual rms MPa"]);
    let row = |name: &str, tau0: f64, z: f64, rms: f64| {
        vec![name.to_owned(), significant(tau0), significant(z), significant(rms)]
    };
    let [both_tau0, both_z] = [0, 1].map(|k| both.estimates[k].value);
    steps.row(row(
        "2: z with the mean slope",
        *tau0,
        exponent.estimates[0].value,
        exponent.rms,
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
