//! The tests of the program and of the models that it ships, as one program: each that links them on its own costs seconds and a
//! hundred megabytes. A module is a file or a folder beside this one; `cargo test --test all MODULE::` runs the tests of one.
// A test of many messages is a table of its cases.
#![allow(clippy::unwrap_used, clippy::too_many_lines)]

mod analyses;
mod api;
mod axle_split;
mod batched;
mod bearing_loads;
mod browser;
mod cards;
mod coefficients;
mod common;
mod comparison;
mod conformance;
mod consumption;
mod corpus;
mod correction;
mod counts;
mod coverage;
mod crossed_examples;
mod cycle;
mod dependencies;
mod derivatives;
mod distributed;
mod drive_unit;
mod drivetrain;
mod editor;
mod ehl_mixed;
mod electric_drive_unit;
mod errors;
mod explained;
mod files;
mod fit_rheology;
mod fuzz;
mod gear_choice;
mod golden;
mod grease;
mod hold_out;
mod identify;
mod import_bearings;
mod invariants;
mod json;
mod laws;
mod library;
mod limits;
mod load_on_teeth;
mod locked;
mod lsp;
mod machines;
mod materials;
mod measured;
mod measured_formats;
mod mistakes;
mod model_error;
mod modules;
mod mutated;
mod network;
mod new;
mod oil;
mod oil_network;
mod oils;
mod optimise;
mod peers;
mod performance;
mod plain_bearings;
mod planetary;
mod planets;
mod power_split;
mod program;
mod ratings;
mod reader;
mod reducer;
mod reference;
mod repeat;
mod report;
mod results;
mod rexs;
mod rig;
mod savings;
mod schema;
mod schematic;
mod selection;
mod sensitivity;
mod shard;
mod studies;
mod study_limits;
mod surface;
mod temperature;
mod topologies;
mod trade;
mod unit_exports;
mod variants;
mod vscode;
mod wheels;
mod workbench;

/// A file that no `mod` line names would never be compiled, and its tests would never fail.
#[test]
fn every_file_of_tests_is_a_module_of_its_program() {
    for folder in [
        "tests",
        "framework/exchange/tests",
        "framework/numerics/tests",
        "plugins/tests",
    ] {
        let mut files: Vec<String> = std::fs::read_dir(common::file(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|kind| kind == "rs") || path.join("mod.rs").is_file())
            .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
            .filter(|name| name != "main")
            .collect();
        files.sort();
        let main = std::fs::read_to_string(common::file(folder).join("main.rs")).unwrap();
        let mut modules: Vec<&str> = main
            .lines()
            .filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'))
            .collect();
        modules.sort_unstable();
        assert_eq!(modules, files, "{folder}/main.rs");
    }
}
