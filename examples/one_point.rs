//! One operating point of a gearbox file with a shipped model set: losses by component, and the efficiency.
//!
//! `cargo run --example one_point`
#![allow(clippy::print_stdout, reason = "an example shows its numbers")]

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use gearloss::framework::evaluate::Point;
use gearloss::framework::gearbox::Gearbox;
use gearloss::framework::language::Language;
use gearloss::framework::resolve::Choice;

const GEARBOX: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two-speed-ev/gearbox.yaml");
/// rad/s per 1/min.
const RPM: f64 = PI / 30.0;

fn main() -> Result<(), Box<dyn Error>> {
    // The sections, models, catalogues and model sets of all linked crates.
    let language = Language::linked()?;
    let gearbox = Gearbox::read(&language, Path::new(GEARBOX))?;
    // Errors in the file or the model set are returned here, with line, reason and help.
    let transmission = gearbox.transmission(&language, &Choice::of_set("joint"))?;
    for warning in &transmission.warnings {
        println!("{}", gearbox.sources.render(warning));
    }

    // First gear; the port of the speed is the default of the gear, the torque is given at the input.
    let case = transmission
        .case("first", &[], &["input"])
        .map_err(|list| gearbox.findings(list))?;
    let mut scratch = transmission.scratch(&case);
    let oil = [transmission.oil_temperature];
    let point = Point {
        speeds: &[8000.0 * RPM],
        torques: &[10.0],
        ..Point::default()
    };
    let solution = transmission.evaluate(&case, &point, &oil, &mut scratch);

    // If a loss has no value, the sum and the efficiency are absent.
    if let Some((part, reason)) = solution.undefined() {
        println!("{}: {reason}", part.path);
    }
    let (Some(sum), Some(efficiency)) = (solution.loss(), solution.efficiency()) else {
        return Err(format!("no loss: {}", solution.status().name()).into());
    };
    println!("{}", transmission.title());
    println!("first gear, 10 Nm at 8000 rpm, oil {} degC\n", oil[0]);
    println!("{:<26}{:<16}{:>9}{:>8}", "component", "model", "loss W", "share %");
    for (part, loss) in solution.parts() {
        let model = transmission.instances()[part.notes.instance()].entry.name;
        let watts = loss.watts();
        println!("{:<26}{model:<16}{watts:>9.3}{:>8.1}", part.path, 100.0 * watts / sum);
    }
    println!("\nloss {sum:.3} W, efficiency {:.3} %", 100.0 * efficiency);
    Ok(())
}
