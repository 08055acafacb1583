//! Identifies uncertain inputs of a gearbox from measured points by bounded least squares, with 95 % intervals.
//!
//! The points are synthetic: the head of `rig.csv` lists the true values.
//!
//! `cargo run --example fit_parameters`
#![allow(clippy::print_stdout, reason = "an example shows its numbers")]

use std::error::Error;
use std::path::Path;

use gearloss::framework::description::Ordered;
use gearloss::framework::language::Language;
use gearloss::studies::identify::{Identification, Settings};
use gearloss::studies::study::{Data, IdentifiedEntry, Quantity, Study};

const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two-speed-ev/study.yaml");
/// Name, path in the description or of the rig, lower and upper bound in the unit of the path.
const PARAMETERS: [(&str, &str, f64, f64); 8] = [
    ("viscosity", "lubricants.sump.viscosity.factor", 0.4, 2.5),
    ("roughness", "gears.*.surface.rq", 0.1, 1.0),
    ("oil level", "housing.oil.level_offset", -20.0, 20.0),
    ("bearing loads", "bearings.*.radial_factor", 0.5, 2.0),
    ("boundary friction", "bearings.*.model.mu_bl", 0.05, 0.25),
    ("seals", "seals.*.loss_factor", 0.2, 5.0),
    ("torque meter", "rig.torque_offset_in", -0.1, 0.1),
    ("bearing of the rig", "rig.support_in.torque", 0.0, 0.06),
];

fn main() -> Result<(), Box<dyn Error>> {
    let language = Language::linked()?;
    // The study defines the file of the points, the accuracy of the instruments, and the model set `complete`.
    let study = Study::read(&language, Path::new(STUDY))?;
    let (_, gearbox) = study.gearbox("gearboxes", None)?;
    let (measured, _) = study.measured("measurements", &Data::Named("rig".to_owned()), &[])?;
    let bound = Ordered::default();
    let rows = study.rows(&measured, &bound, None, false);

    let entries = PARAMETERS.map(|(name, path, from, to)| (name, IdentifiedEntry::between(path, from, to)));
    let mut identification = Identification::new(
        &language,
        gearbox,
        study.choice(Some("complete")),
        rows,
        entries.iter().map(|(name, entry)| (*name, entry)),
        &[Quantity::Efficiency],
    )?;
    let fitted = identification.fit(&Settings::default())?;
    let fit = fitted.fit();
    if !fit.converged() {
        return Err(format!("the fit is {}: {}", fit.status.name(), fit.reason.name()).into());
    }

    let points = identification.observations().len();
    let misfit = fitted.inference.chi_square() / fitted.inference.freedom();
    println!("{points} efficiencies, mean square of the residuals over their accuracies {misfit:.2}\n");
    println!("{:<20}{:>9}{:>10}{:>10}  unit", "parameter", "value", "from", "to");
    for (k, parameter) in identification.parameters().iter().enumerate() {
        // A parameter at an active bound, or without effect, has no interval.
        let ends = fitted.inference.interval(k, 0.95, 1.0).map(|interval| interval.ends);
        let [from, to] = ends.map_or(["-".to_owned(), "-".to_owned()], |ends| ends.map(|x| format!("{x:.4}")));
        let (value, unit) = (fitted.theta()[k], parameter.unit.symbol);
        println!("{:<20}{value:>9.4}{from:>10}{to:>10}  {unit}", parameter.name);
    }
    Ok(())
}
