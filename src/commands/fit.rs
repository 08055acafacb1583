//! `fit`: fits a law to a table and prints it with its residuals.

mod columns;
mod curves;
mod oil;
mod power_law;
mod squares;
mod stribeck;
mod traction;

use crate::args::{FitArgs, FitLaw};
use crate::output::{End, Failure, Out};

pub fn run(args: &FitArgs, out: &mut Out) -> Result<End, Failure> {
    match &args.law {
        FitLaw::PowerLaw { table } => power_law::run(table, out),
        FitLaw::Traction { curves, oil } => traction::run(curves, oil, out),
        FitLaw::Stribeck { curve, rq, exponent } => stribeck::run(curve, rq.as_deref(), *exponent, out),
    }
}
