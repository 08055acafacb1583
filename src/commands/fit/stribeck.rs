//! `fit stribeck`: the coefficient of boundary friction.

use std::path::Path;

use gearloss_framework::document::Dimension;
use gearloss_numerics::least_squares::{Parameter, Problem};
use gearloss_plugins::tooth_friction::ehl_mixed::identification::{StribeckPoint, boundary_friction, mixed_residual};

use super::columns::{Columns, Measure, Quantity};
use super::squares::Squares;
use super::traction::estimates_table;
use crate::commands::point::quantity;
use crate::output::{End, Failure, Out, Table, figures, significant};

const LAMBDA: Quantity = Quantity::plain("lambda");
const FILM: Quantity = Quantity::new("film", Measure::Of(Dimension::Length), "nm");
const MU: Quantity = Quantity::plain("mu");
const MU_FILM: Quantity = Quantity::plain("mu_film");

/// Bounds of the coefficient, as in `lubricants`.
const MU_B: [f64; 2] = [0.01, 0.5];

pub fn run(path: &Path, rq: Option<&str>, exponent: f64, out: &mut Out) -> Result<End, Failure> {
    if !(0.1..=10.0).contains(&exponent) {
        return Err(Failure::input(
            format!("--exponent {exponent} is not between 0.1 and 10"),
            "omit it for the usual value 2",
        ));
    }
    let columns = Columns::read(path)?;
    let points = points(&columns, rq)?;
    let start = boundary_friction(&points, exponent).unwrap_or(MU_B[0]);
    let mu_b = Parameter::new("mu_b", start.clamp(MU_B[0], MU_B[1])).within(MU_B[0], MU_B[1]);
    let all = |theta: &[f64]| Ok(points.iter().map(|p| mixed_residual(theta[0], exponent, p)).collect());
    let squares = Squares::from_problem(&Problem::new(all, vec![mu_b])).map_err(|fault| {
        Failure::input(
            format!("{}: {fault}", columns.file()),
            "measure at film thicknesses below the roughness",
        )
    })?;
    out.line(format!("{}: {} points", columns.file(), points.len()))?;
    if let Some(note) = columns.unused(&[LAMBDA, FILM, MU, MU_FILM]) {
        out.line(note)?;
    }
    let mut table = Table::new(&["lambda", "film friction", "mu", "law", "law minus mu"]);
    let found = squares.estimates[0].value;
    for point in &points {
        let residual = mixed_residual(found, exponent, point);
        table.row(vec![
            figures(point.lambda, 4),
            figures(point.film, 4),
            figures(point.mu, 4),
            figures(point.mu + residual, 4),
            format!("{residual:.5}"),
        ]);
    }
    out.text(&table.render())?;
    out.line(format!("residual rms {}\n", significant(squares.rms)))?;
    out.text(&estimates_table(&squares.estimates))?;
    out.line(format!("\nrheology: {{ mu_b: {} }}", figures(found, 4)))?;
    Ok(End::Fine)
}

fn points(columns: &Columns, rq: Option<&str>) -> Result<Vec<StribeckPoint>, Failure> {
    let lambda = match (rq, columns.has(&LAMBDA), columns.has(&FILM)) {
        (None, true, false) => columns.numbers(&LAMBDA)?,
        (Some(text), false, true) => {
            let rq = quantity("--rq", text, "um")?;
            if rq <= 0.0 {
                let message = format!("--rq \"{text}\" is not positive");
                return Err(Failure::input(
                    message,
                    "write the combined rms roughness of both flanks",
                ));
            }
            columns.numbers(&FILM)?.iter().map(|film| film / rq).collect()
        }
        (Some(_), true, _) => {
            return Err(columns.wrong(None, "both `lambda` and --rq", "omit --rq, which applies to films"));
        }
        (None, true, true) => {
            return Err(columns.wrong(None, "both `lambda` and `film`", "delete one of them"));
        }
        (None, false, true) => {
            return Err(columns.wrong(None, "`film` without a roughness", "add --rq, such as --rq \"0.28 um\""));
        }
        (_, false, false) => {
            let help = "add `lambda`, or `film [nm]` with --rq";
            return Err(columns.wrong(None, "neither `lambda` nor `film [nm]`", help));
        }
    };
    let (mu, film) = (columns.numbers(&MU)?, columns.numbers(&MU_FILM)?);
    let rows = lambda.into_iter().zip(film).zip(mu);
    Ok(rows
        .map(|((lambda, film), mu)| StribeckPoint { lambda, film, mu })
        .collect())
}
