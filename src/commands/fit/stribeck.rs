//! `fit stribeck`: the coefficient of boundary friction.

use std::path::Path;

use gearloss_framework::document::Dimension;
use gearloss_plugins::tooth_friction::ehl_mixed::identification::{
    StribeckPoint, fit_boundary_friction, mixed_residual,
};
use gearloss_studies::fit::columns::{Columns, Measure, Quantity};

use super::{estimates_table, print_unused};
use crate::commands::point::quantity;
use crate::output::{End, Failure, Out, Table, figures, significant};

const LAMBDA: Quantity = Quantity::plain("lambda");
const FILM: Quantity = Quantity::new("film", Measure::Of(Dimension::Length), "nm");
const MU: Quantity = Quantity::plain("mu");
const MU_FILM: Quantity = Quantity::plain("mu_film");

pub fn run(path: &Path, rq: Option<&str>, exponent: f64, out: &mut Out) -> Result<End, Failure> {
    if !(0.1..=10.0).contains(&exponent) {
        return Err(Failure::input(
            format!("--exponent {exponent} is not between 0.1 and 10"),
            "omit it for the usual value 2",
        ));
    }
    let columns = super::columns(path)?;
    let points = points(&columns, rq)?;
    let squares = fit_boundary_friction(&points, exponent).map_err(|fault| {
        Failure::input(
            format!("{}: {fault}", path.display()),
            "measure at film thicknesses below the roughness",
        )
    })?;
    out.line(format!("{}: {} points", path.display(), points.len()))?;
    print_unused(&columns, &[LAMBDA, FILM, MU, MU_FILM], out)?;
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
    let [message, help] = match (rq, columns.has(&LAMBDA), columns.has(&FILM)) {
        (None, true, false) | (Some(_), false, true) => ["", ""],
        (Some(_), true, _) => ["both `lambda` and --rq", "omit --rq, which applies to films"],
        (None, true, true) => ["both `lambda` and `film`", "delete one of them"],
        (None, false, true) => ["`film` without a roughness", "add --rq, such as --rq \"0.28 um\""],
        (_, false, false) => [
            "neither `lambda` nor `film [nm]`",
            "add `lambda`, or `film [nm]` with --rq",
        ],
    };
    if !message.is_empty() {
        return Err(columns.wrong(None, message, help).into());
    }
    let lambda = match rq {
        None => columns.numbers(&LAMBDA)?,
        Some(text) => {
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
    };
    let (mu, film) = (columns.numbers(&MU)?, columns.numbers(&MU_FILM)?);
    let rows = lambda.into_iter().zip(film).zip(mu);
    Ok(rows
        .map(|((lambda, film), mu)| StribeckPoint { lambda, film, mu })
        .collect())
}
