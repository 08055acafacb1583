//! A whole study, run by a program: outcomes as typed values, and their tables as columns. The files are in memory here, as if
//! they came from an archive or a database; `Disk::shared()` in place of `files` reads them from the disk.
//!
//! `cargo run --example run_study`
#![allow(clippy::print_stdout, reason = "an example shows its numbers")]

use std::error::Error;

use gearloss::api::analyses::compare::{CompareOutcome, Comparisons};
use gearloss::api::analyses::cycle::CycleOutcome;
use gearloss::api::{InMemory, Language, StudyRun, read_study};

fn main() -> Result<(), Box<dyn Error>> {
    let files = InMemory::new([
        ("ev/town.yaml", include_str!("two-speed-ev/town.yaml")),
        ("ev/gearbox.yaml", include_str!("two-speed-ev/gearbox.yaml")),
    ]);
    let language = Language::linked()?;
    // Errors in the documents are returned here, with line, reason and help.
    let study = read_study(&language, &files.shared(), "ev/town.yaml")?;

    for (name, outcome) in StudyRun::new(&language, &study).outcomes() {
        let outcome = outcome?;
        if let Some(CompareOutcome {
            comparisons: Comparisons::OnGrid(sets),
            ..
        }) = outcome.get()
        {
            for set in sets {
                let mean = set.mean.ok_or("no point has a value under both sets")?;
                println!(
                    "{name}: {} minus {}, mean {mean:.3} {}",
                    set.model_set, set.base, set.unit
                );
            }
        }
        if let Some(CycleOutcome { cycles, .. }) = outcome.get() {
            for duty in cycles {
                println!(
                    "{name}: {} under {}, mean loss {:.3} W",
                    duty.cycle, duty.model_set, duty.mean_loss_w
                );
            }
        }
        // Every outcome also provides its numbers as columns, with the names of the files that the program writes.
        let table = outcome
            .table(name)
            .ok_or("the first table has the name of the analysis")?;
        let column = table.columns.iter().find(|column| column.name == "loss_w");
        let losses = column.and_then(|column| column.numbers()).ok_or("no column loss_w")?;
        let greatest = losses.iter().copied().fold(f64::NAN, f64::max);
        println!("{name}: {} rows, greatest loss {greatest:.3} W", losses.len());
    }
    Ok(())
}
