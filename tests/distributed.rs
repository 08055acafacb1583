//! A study whose tasks workers compute from a parcel, in any order and more than once, has the outcomes of a local run to the bit.

use std::path::Path;
use std::sync::Arc;

use gearloss::api::{Disk, Language, Outcome, SharedSource, Silent, StudyRun, read_study};
use gearloss::document::files::Recorder;
use gearloss::studies::distributed::{Collected, Parcel, Results, Stage, Worker};

use crate::common::file;

/// A study of the repository that was read through a recorder.
fn recorded(language: &Language, name: &str) -> (gearloss::api::Study, Arc<Recorder>) {
    let recorder = Arc::new(Recorder::new(Disk::shared()));
    let files: SharedSource = recorder.clone();
    let study = read_study(language, &files, file(name)).unwrap();
    (study, recorder)
}

/// The record of an outcome. A tournament measures times, which differ between any two runs.
fn json(outcome: &dyn Outcome) -> String {
    let mut text = Vec::new();
    outcome.write_json(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    text.lines().filter(|line| !line.contains("time")).collect()
}

/// The outcome of an analysis whose tasks a worker computes in chunks, the last first, the first of each stage twice.
fn distributed(language: &Language, run: &StudyRun<'_>, parcel: &[u8], name: &str) -> (Box<dyn Outcome>, usize) {
    let collected = Collected::default();
    let mut count = 0;
    loop {
        let stages = collected.missing(run, name, &Silent).unwrap();
        if stages.is_empty() {
            return (collected.outcome(run, name, &Silent).unwrap(), count);
        }
        for Stage { part, stage, tasks } in stages {
            let before = collected.before(name, part, stage);
            let mut chunks: Vec<&[usize]> = tasks.chunks(tasks.len().div_ceil(3)).collect();
            chunks.push(chunks[0]);
            let mut first: Option<Results> = None;
            for chunk in chunks.into_iter().rev() {
                let worker = Worker::open(language, parcel).unwrap();
                let tasks = chunk.to_vec();
                let results = worker.compute(name, &Stage { part, stage, tasks }, before.clone(), &Silent);
                let results = results.unwrap();
                assert_eq!(results.len(), chunk.len());
                if chunk[0] == 0 && !name.contains("tournament") {
                    assert!(
                        first.get_or_insert(results.clone()) == &results,
                        "{name}: a task has two results"
                    );
                }
                count += results.len();
                collected.add(name, results);
            }
        }
    }
}

#[test]
fn tasks_of_every_analysis_make_the_outcomes_of_a_local_run() {
    let language = Language::linked().unwrap();
    let (study, recorder) = recorded(&language, "tests/results/study.yaml");
    let [local, apart] = [(); 2].map(|()| StudyRun::new(&language, &study));
    let mut split = 0;
    for name in study.entry.analyses.ids() {
        let expected = local.analysis(name).unwrap();
        // Data that the analysis reads by itself, as the process that leads does before it packs.
        assert!(Collected::default().missing(&apart, name, &Silent).is_ok());
        let parcel = Parcel::new(&study, &recorder, &apart).to_bytes().unwrap();
        let (outcome, tasks) = distributed(&language, &apart, &parcel, name);
        assert!(json(&*outcome) == json(&*expected), "{name} differs");
        split += usize::from(tasks > 0);
    }
    assert!(split >= 8, "{split} analyses have tasks");
}

#[test]
fn parcels_of_other_programs_and_damaged_ones_are_refused() {
    let language = Language::linked().unwrap();
    let (study, recorder) = recorded(&language, "examples/two-products/study.yaml");
    let run = StudyRun::new(&language, &study);
    let parcel = Parcel::new(&study, &recorder, &run).to_bytes().unwrap();
    let refused = |bytes: &[u8]| Worker::open(&language, bytes).err().map(|error| error.to_string());
    assert_eq!(refused(&parcel), None);
    let other: Vec<u8> = String::from_utf8_lossy(&parcel)
        .find("gearloss 0")
        .map_or_else(Vec::new, |at| {
            let mut bytes = parcel.clone();
            bytes[at + "gearloss ".len()] = b'9';
            bytes
        });
    let words = refused(&other).unwrap();
    assert!(
        words.contains("gearloss 9") && words.contains("this worker has gearloss 0"),
        "{words}"
    );
    let words = refused(&parcel[..parcel.len() / 2]).unwrap();
    assert!(words.contains("cannot be read"), "{words}");
}

/// A worker has no access to the files: it reads from the parcel only.
#[test]
fn a_worker_needs_no_files() {
    let language = Language::linked().unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("distributed");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in [
        ("gearbox.yaml", include_str!("../examples/two-speed-ev/gearbox.yaml")),
        (
            "study.yaml",
            "
gearloss: study/1
gearboxes: { ours: gearbox.yaml }
grids: { small: { gear: first, torque: [5 Nm, 8 Nm], speed: [3000 rpm, 12000 rpm] } }
analyses: { losses: { type: map, grid: small } }
",
        ),
    ] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let (study, recorder) = recorded(&language, folder.join("study.yaml").to_str().unwrap());
    let run = StudyRun::new(&language, &study);
    let collected = Collected::default();
    let stages = collected.missing(&run, "losses", &Silent).unwrap();
    let parcel = Parcel::new(&study, &recorder, &run).to_bytes().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let worker = Worker::open(&language, &parcel).unwrap();
    let results = worker.compute("losses", &stages[0], Results::new(), &Silent).unwrap();
    assert_eq!(results.len(), 1);
}
