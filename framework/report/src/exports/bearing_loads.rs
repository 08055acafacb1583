//! Loads and speeds of the bearings over cycles as CSV, for programs of life and noise.

use gearloss_framework::document::Diagnostic;
use gearloss_studies::analyses::cycle::{BearingLoad, BearingLoads, CycleExport, CycleOutcome, LoadCase};
use gearloss_studies::numbers::tidy;
use gearloss_studies::table::Table;

use super::rexs_loads::rexs;
use crate::codes;
use crate::csv::CsvTable;
use crate::page::Page;

/// Adds the requested files, with a line for each.
pub fn add(outcome: &CycleOutcome, page: &mut Page) {
    if outcome.loads.is_empty() {
        return;
    }
    let analysis = &outcome.head.analysis;
    for format in &outcome.exports {
        match format {
            CycleExport::Fmu2 | CycleExport::Fmu3 => {}
            CycleExport::BearingLoads => {
                let name = format!("{analysis}-bearing_loads.csv").replace('/', "-");
                match csv(&outcome.loads, &name) {
                    Ok(bytes) => {
                        page.line(format!(
                            "{analysis}: {name}: {}",
                            about(&outcome.loads.iter().collect::<Vec<_>>())
                        ));
                        page.file(name, bytes);
                    }
                    Err(reason) => {
                        let path = format!("analyses.{analysis}.export");
                        return page.fault(
                            Diagnostic::error(path, format!("the bearing loads cannot be written: {reason}"))
                                .help("export fewer cycles in one analysis")
                                .code(codes::EXPORT),
                        );
                    }
                }
            }
            CycleExport::RexsLoads => {
                // The loads of one set follow each other.
                for loads in outcome.loads.chunk_by(|a, b| a.model_set == b.model_set) {
                    let name = format!("{analysis}-{}-bearing_loads.rexs", loads[0].model_set).replace('/', "-");
                    page.line(format!(
                        "{analysis}: {name}: {}",
                        about(&loads.iter().collect::<Vec<_>>())
                    ));
                    page.file(name, rexs(loads).into_bytes());
                }
            }
        }
    }
}

/// Counts, and how far the classes are from the intervals, as one line.
fn about(all: &[&BearingLoads]) -> String {
    let cases: usize = all.iter().map(|loads| loads.cases.len()).sum();
    let intervals: usize = all
        .iter()
        .flat_map(|loads| &loads.cases)
        .map(|case| case.intervals)
        .sum();
    let bearings = all.first().and_then(|loads| loads.cases.first());
    let bearings = bearings.map_or(0, |case| case.bearings.len());
    let mut about = format!("bearings: {bearings}, load cases: {cases}, intervals: {intervals}");
    let deviation = all.iter().filter_map(|loads| loads.deviation).reduce(f64::max);
    if let Some(deviation) = deviation {
        about.push_str(&format!(
            "; equivalent radial loads (exponent 10/3) deviate by at most {:.2} % from those of the intervals",
            100.0 * deviation
        ));
    }
    let lost = |case: &&LoadCase| case.bearings.iter().any(|bearing| bearing.load.is_none());
    let lost = all.iter().flat_map(|loads| &loads.cases).filter(lost).count();
    if lost > 0 {
        about.push_str(&format!("; {lost} load cases have no power flow and no loads"));
    }
    about
}

type Row<'a> = (&'a BearingLoads, usize, &'a LoadCase, &'a BearingLoad);

fn csv(all: &[BearingLoads], name: &str) -> std::io::Result<Vec<u8>> {
    let mut rows: Vec<Row<'_>> = Vec::new();
    for loads in all {
        for (number, case) in (1..).zip(&loads.cases) {
            rows.extend(case.bearings.iter().map(|bearing| (loads, number, case, bearing)));
        }
    }
    // Minus zero is zero.
    let yz = |row: &Row<'_>, axis: usize| Some(row.3.load?.radial_yz_n?[axis] + 0.0);
    let table = Table::of(name, rows)
        .text("model_set", "Model set", |row: &Row<'_>| &row.0.model_set)
        .text("cycle", "Duty cycle", |row| &row.0.cycle)
        .number("load_case", "-", "Number of the load case in the cycle", |row| {
            row.1 as f64
        })
        .text("gear", "Gear", |row| &row.2.gear)
        .number("duration_s", "s", "Time in the load case", |row| row.2.duration_s)
        .number("share", "-", "Share of the time of the cycle", |row| row.2.share)
        .number("torque_nm", "Nm", "Torque of the reference port", |row| row.2.torque_nm)
        .number("speed_rpm", "rpm", "Speed of the reference port", |row| {
            tidy(row.2.speed_rpm)
        })
        .text("bearing", "Bearing", |row| &row.3.bearing)
        .number("copies", "-", "Number of equal bearings", |row| row.3.copies)
        .number("inner_rpm", "rpm", "Speed of the inner ring", |row| {
            row.3.inner_rpm.map(tidy)
        })
        .number("outer_rpm", "rpm", "Speed of the outer ring", |row| {
            row.3.outer_rpm.map(tidy)
        })
        .number("radial_y_n", "N", "Force on the inner ring along y", |row| yz(row, 0))
        .number("radial_z_n", "N", "Force on the inner ring along z", |row| yz(row, 1))
        .number(
            "turning_n",
            "N",
            "Part of the radial load that turns with a carrier",
            |row| row.3.load.map(|load| load.turning_n),
        )
        .number("radial_n", "N", "Radial load", |row| {
            row.3.load.map(|load| load.radial_n)
        })
        .number("axial_n", "N", "Axial load", |row| row.3.load.map(|load| load.axial_n))
        .number("tilting_nm", "Nm", "Tilting moment", |row| {
            row.3.load.map(|load| load.tilting_nm)
        })
        .number("oil_degc", "degC", "Temperature of the oil at the bearing", |row| {
            row.3.oil_degc
        })
        .finish();
    let mut bytes = Vec::new();
    let mut lines = CsvTable::new(&mut bytes, &table)?;
    lines.rows(&table)?;
    lines.finish()?;
    Ok(bytes)
}
