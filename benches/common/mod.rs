//! What the benches share: examples, sets of models, points, and documents that are made. Every bench is in the group of its
//! file's name, with its own name in quotes where it is made: the page `docs/performance.md` is kept by both.
#![allow(dead_code, clippy::unwrap_used, missing_docs)]

pub mod long;
pub mod plate;

use std::path::{Path, PathBuf};

use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_plugins as _;
use gearloss_studies::study::Study;
use serde_json::Value;

/// rad/s per 1/min.
pub const RPM: f64 = std::f64::consts::PI / 30.0;

/// The language of all built-in models.
pub fn language() -> Language {
    Language::linked().unwrap_or_else(|f| panic!("{}", f.render()))
}

/// The folder of an example.
pub fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)
}

/// The gearbox of an example.
pub fn gearbox(language: &Language, name: &str) -> Gearbox {
    let file = example(name).join("gearbox.yaml");
    Gearbox::read(language, &file).unwrap_or_else(|f| panic!("{}", f.render()))
}

/// A choice with changed values of the resolved document.
pub fn with(overrides: Vec<(String, Value)>) -> Choice {
    Choice {
        overrides,
        ..Choice::default()
    }
}

/// A set of models of the two-speed example's study.
pub fn set(language: &Language, name: &str) -> Choice {
    let study = Study::read(language, &example("two-speed-ev").join("study.yaml"));
    study.unwrap_or_else(|f| panic!("{}", f.render())).choice(Some(name))
}

/// A transmission that must come about.
pub fn build(language: &Language, gearbox: &Gearbox, choice: &Choice) -> Transmission {
    let built = gearbox.transmission(language, choice);
    built.unwrap_or_else(|f| panic!("{}", f.render()))
}

/// A point with real power flow.
pub fn point<'a>(speeds: &'a [f64], torques: &'a [f64]) -> Point<'a> {
    Point {
        speeds,
        torques,
        flow: PowerFlow::Real,
        tolerance: Tolerance::default(),
        inclination: 0.0,
    }
}
