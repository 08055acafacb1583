//! What programs use: read, override, build, solve, run a study, get typed outcomes. Authors of models use
//! [`crate::framework::prelude`] instead.
//!
//! # A point
//! ```
//! use gearloss::api::{self, Choice, Gearbox, Given, Language, solve_point};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two-speed-ev/gearbox.yaml");
//! let language = Language::linked()?; // the models that are linked into the program
//! let gearbox = Gearbox::read(&language, file.as_ref())?;
//! let choice = Choice::of_set("joint").with("housing.oil.level_offset", "-10 mm");
//! let transmission = gearbox.transmission(&language, &choice)?;
//! let point = solve_point(&gearbox, &transmission, "first", Given::new(10.0, 800.0))?; // Nm, rad/s
//! println!("{:?} W", point.loss);
//! # assert!(point.loss.is_some_and(|loss| loss > 0.0));
//! # Ok(())
//! # }
//! ```
//! [`solve_points`] solves grids and lists on all cores. [`Transmission::evaluate`] solves a single point without allocating.
//!
//! # A study
//! [`read_study`] reads and checks a study. [`StudyRun`] computes the outcomes of its analyses, whose types are in [`analyses`];
//! their tables are columns ([`Table`]). Nothing is printed and no file is written.
//!
//! ```
//! use gearloss::api::{InMemory, Language, StudyRun, analyses::map::MapOutcome, read_study};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gearbox = include_str!("../examples/two-speed-ev/gearbox.yaml");
//! let study = "
//! gearloss: study/1
//! gearboxes: { ev: gearbox.yaml }
//! grids: { small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] } }
//! analyses: { losses: { type: map, grid: small, model_sets: [joint] } }
//! ";
//! let files = InMemory::new([("study.yaml", study), ("gearbox.yaml", gearbox)]).shared();
//! let language = Language::linked()?;
//! let study = read_study(&language, &files, "study.yaml")?;
//! let outcome = StudyRun::new(&language, &study).analysis("losses")?;
//! assert!(outcome.get::<MapOutcome>().is_some());
//! let table = outcome.table("losses").ok_or("the first table has the name of the analysis")?;
//! let losses = table.column("loss_w").and_then(|column| column.numbers());
//! # assert_eq!(losses.map(<[f64]>::len), Some(4));
//! # Ok(())
//! # }
//! ```
//!
//! # Files
//! Documents and their data are read from a [`SharedSource`]: the [`Disk`], or [`InMemory`], or your own [`FileSource`].
//!
//! # Errors
//! Errors in documents are returned as [`Findings`]: a list of [`Diagnostic`]s with code, path, position in the text and help, and the
//! texts. An analysis without an outcome returns [`Stopped`], which contains findings or states who aborted it.

use std::path::Path;

pub use gearloss_document::files::{Disk, FileSource, InMemory, SharedSource};
pub use gearloss_document::{Code, Diagnostic, FilePlace, PlacedDiagnostic, RelatedPlace, Severity, Sources};
pub use gearloss_framework::evaluate::{GivenQuantity, Point, PowerFlow, Scratch, Slope, Slopes, Solution};
pub use gearloss_framework::gearbox::{Findings, Gearbox};
pub use gearloss_framework::language::Language;
pub use gearloss_framework::resolve::{Choice, Resolved};
pub use gearloss_framework::transmission::{Case, Transmission};
/// The analyses with their outcomes, for [`Outcome::get`]: `analyses::compare::CompareOutcome`.
pub use gearloss_studies::analyses;
pub use gearloss_studies::analyses::{Engine, Outcome, Planner, Stopped};
pub use gearloss_studies::engine::progress::{Progress, Silent, Steps};
pub use gearloss_studies::points::{Derivative, Derivatives, Derived, Method, Variable};
pub use gearloss_studies::points::{Field, Given, GridResult, OilTemperature, PointResult, Points};
pub use gearloss_studies::run::StudyRun;
pub use gearloss_studies::study::Study;
pub use gearloss_studies::table::{Column, Table, Texts, Values};

/// Every code of a finding, in the order of their numbers; docs/errors.md lists them with cause and help.
pub fn codes() -> Vec<Code> {
    let lists: [&[Code]; 5] = [
        gearloss_document::codes::ALL,
        gearloss_framework::codes::ALL,
        gearloss_studies::codes::ALL,
        gearloss_report::codes::ALL,
        gearloss_exchange::codes::ALL,
    ];
    lists.concat()
}

/// Reads a study of a source with its gearboxes, and checks every name that its analyses use.
///
/// # Errors
/// All findings of reading, the walk and the check.
pub fn read_study(language: &Language, files: &SharedSource, file: impl AsRef<Path>) -> Result<Study, Findings> {
    let study = Study::read_from(language, files, file.as_ref())?;
    study.check(language)?;
    Ok(study)
}

/// Solves one point of a gear state: torque and speed at the reference port, temperatures as the gearbox states them.
///
/// # Errors
/// If there is no such gear state, or if it requires other ports: use [`solve_points`] then.
pub fn solve_point(
    gearbox: &Gearbox,
    transmission: &Transmission,
    gear: &str,
    given: Given,
) -> Result<PointResult, Findings> {
    let points = Points::at_reference(transmission, gear, Field::List(vec![given]));
    let mut solved = solve_points(gearbox, transmission, &points)?.points;
    // A list of one point has one result.
    Ok(solved.remove(0))
}

/// Solves points on all cores. They have the same bits on any number of cores.
///
/// # Errors
/// If the gear state is unknown, or if the ports do not match it.
pub fn solve_points(gearbox: &Gearbox, transmission: &Transmission, points: &Points) -> Result<GridResult, Findings> {
    let solved = gearloss_studies::points::run_grid(transmission, points, &|_| true);
    // The progress above breaks nothing off.
    Ok(solved.map_err(|list| gearbox.findings(list))?.unwrap_or_default())
}
