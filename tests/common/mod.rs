//! What several tests share.

pub mod contact_work;
pub mod rig;

use std::path::{Path, PathBuf};

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Registry;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_plugins as _;

/// rad/s per 1/min.
pub const RPM: f64 = std::f64::consts::PI / 30.0;

/// The language of all built-in models.
pub fn language() -> Language {
    Language::new(Registry::linked().unwrap()).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

/// A file of the repository.
pub fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The two-speed example.
pub fn two_speed(language: &Language) -> Gearbox {
    Gearbox::read(language, &file("examples/two-speed-ev/gearbox.yaml")).unwrap()
}

/// The two-speed example with changed values.
pub fn two_speed_with(language: &Language, set: Option<&str>, overrides: &[(&str, serde_json::Value)]) -> Transmission {
    let choice = Choice {
        set: set.map(str::to_owned),
        overrides: overrides
            .iter()
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect(),
        ..Choice::default()
    };
    two_speed(language).transmission(language, &choice).unwrap()
}

/// Folders of the golden cases.
pub fn cases() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = std::fs::read_dir(file("tests/cases"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.is_dir())
        .collect();
    folders.sort();
    folders
}
