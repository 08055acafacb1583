//! What several tests share.

pub mod contact_work;
pub mod program;
pub mod rig;
pub mod study;

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock};

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

/// Whether expensive tests take their complete size: `FULL=1` in the environment.
pub fn is_full() -> bool {
    std::env::var_os("FULL").is_some()
}

/// The next of random numbers that are the same on every machine: `SplitMix64` after Steele, Lea and Flood, 2014.
pub fn random_bits(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A file of the repository.
pub fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The two-speed example.
pub fn two_speed(language: &Language) -> Gearbox {
    Gearbox::read(language, &file("examples/two-speed-ev/gearbox.yaml")).unwrap()
}

/// A gearbox from its text, as it is.
pub fn built(language: &Language, text: &str) -> Transmission {
    let gearbox = Gearbox::of_text(language, text, "input.yaml", ".").unwrap();
    gearbox.transmission(language, &Choice::default()).unwrap()
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

/// A run of a study with the program.
pub struct StudyRun {
    /// Where its results are; to be read only.
    pub folder: PathBuf,
    /// What it printed.
    pub text: String,
    /// Tests in other processes wait for the folder: a runner may begin one for each test.
    _lock: File,
}

/// Runs a study of the repository once for all tests that read its results.
pub fn study_run(study: &'static str) -> &'static StudyRun {
    static RUNS: Mutex<BTreeMap<&str, &OnceLock<StudyRun>>> = Mutex::new(BTreeMap::new());
    let run: &'static OnceLock<StudyRun> = RUNS
        .lock()
        .unwrap()
        .entry(study)
        .or_insert_with(|| Box::leak(Box::default()));
    run.get_or_init(|| {
        let name = study.trim_end_matches(".yaml").replace('/', "-");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("results").join(name);
        std::fs::create_dir_all(folder.parent().unwrap()).unwrap();
        let lock = File::create(folder.with_extension("lock")).unwrap();
        lock.lock().unwrap();
        let _ = std::fs::remove_dir_all(&folder);
        let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
            .args(["run", "--verbose"])
            .arg(file(study))
            .arg("-o")
            .arg(&folder)
            .output()
            .unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{study}: {error}");
        StudyRun {
            folder,
            text: String::from_utf8(output.stdout).unwrap(),
            _lock: lock,
        }
    })
}
