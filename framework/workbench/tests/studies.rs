//! Runs of studies.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use gearloss_framework::files::Disk;
use gearloss_studies::run::StudyRun;
use gearloss_studies::study::Study;
use gearloss_workbench::Listener;
use gearloss_workbench::request::Texts;
use serde_json::{Value, json};

use super::common::{about, example, language, value};

/// Keeps events; stops after a number of them.
#[derive(Default)]
struct Kept {
    events: Mutex<Vec<Value>>,
    reports: Mutex<Vec<String>>,
    seen: AtomicUsize,
    most: Option<usize>,
}

impl Listener for Kept {
    fn event(&self, event: Value) {
        self.seen.fetch_add(1, Ordering::Relaxed);
        self.events.lock().unwrap().push(event);
    }

    fn report(&self, html: String) -> String {
        self.reports.lock().unwrap().push(html);
        "/report/1".to_owned()
    }

    fn should_continue(&self) -> bool {
        self.most.is_none_or(|most| self.seen.load(Ordering::Relaxed) < most)
    }
}

impl Kept {
    fn of(&self, kind: &str) -> Vec<Value> {
        let events = self.events.lock().unwrap();
        events.iter().filter(|event| event["event"] == kind).cloned().collect()
    }
}

const STUDY: &str = "
gearloss: study/1
gearboxes: { ev: gearbox.yaml }
grids: { small: { gear: first, torque: [10 Nm, 20 Nm], speed: [3000 rpm, 6000 rpm] } }
analyses:
  losses: { type: map, grid: small, model_sets: [joint] }
  gap: { type: compare, grid: small, base: joint, against: [iso14179_2] }
";

fn texts(study: &str) -> Texts {
    Texts::from([("study.yaml".to_owned(), study.to_owned())])
}

#[test]
fn a_study_runs_from_its_unsaved_text() {
    let session = about("two-speed-ev");
    let listed = value(
        &session,
        json!({ "request": "analyses", "texts": texts(STUDY), "study": "study.yaml" }),
    );
    let names: Vec<&str> = listed
        .as_array()
        .unwrap()
        .iter()
        .map(|a| a["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["losses", "gap"]);
    let kept = Kept::default();
    session.run(&texts(STUDY), "study.yaml", &[], &kept);
    let sections = kept.of("section");
    assert_eq!(sections.len(), 2, "{:?}", kept.events.lock().unwrap());
    assert!(
        sections[0]["section"]["headline"]
            .as_str()
            .unwrap()
            .contains("efficiency")
    );
    assert!(!sections[0]["section"]["pictures"].as_array().unwrap().is_empty());
    assert_eq!(kept.of("report").len(), 1);
    assert_eq!(kept.of("end")[0]["failed"], 0);
    // `tests/workbench.rs` of the program compares it with the file of `gearloss run`.
    let html = kept.reports.lock().unwrap()[0].clone();
    assert!(html.contains("losses") && html.contains("gap"));
    // One analysis alone has no report.
    let one = Kept::default();
    session.run(&texts(STUDY), "study.yaml", &["gap".to_owned()], &one);
    assert_eq!((one.of("section").len(), one.of("report").len()), (1, 0));
}

/// The numbers are those of the library, to the bit.
#[test]
fn sections_have_the_numbers_of_the_outcome() {
    let session = about("two-speed-ev");
    let kept = Kept::default();
    session.run(&texts(STUDY), "study.yaml", &["losses".to_owned()], &kept);
    let folder = example("two-speed-ev");
    let study = Study::from_text(language(), &Disk::shared(), STUDY.to_owned(), "study.yaml", folder).unwrap();
    let outcome = StudyRun::new(language(), &study).analysis("losses").unwrap();
    let table = outcome.table("losses").unwrap();
    let losses = table.column("loss_w").unwrap().numbers().unwrap().to_vec();
    let section = &kept.of("section")[0]["section"];
    let quantities = section["pictures"][0]["quantities"].as_array().unwrap();
    let drawn = quantities.iter().find(|quantity| quantity["unit"] == "W").unwrap();
    let mut drawn: Vec<f64> = drawn["panels"][0]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| w.as_f64().unwrap())
        .collect();
    let mut losses = losses;
    drawn.sort_by(f64::total_cmp);
    losses.sort_by(f64::total_cmp);
    assert_eq!(drawn, losses);
}

#[test]
fn a_run_can_be_interrupted() {
    let session = about("two-speed-ev");
    let kept = Kept {
        most: Some(1),
        ..Kept::default()
    };
    session.run(&texts(STUDY), "study.yaml", &[], &kept);
    assert!(kept.of("end").is_empty() && kept.of("section").is_empty());
}

#[test]
fn faults_of_a_study_are_events() {
    let session = about("two-speed-ev");
    let kept = Kept::default();
    session.run(
        &texts("gearloss: study/1\ngearboxes: { ev: none.yaml }\nanalyses: {}\n"),
        "study.yaml",
        &[],
        &kept,
    );
    let faults = kept.of("fault");
    assert!(
        faults[0]["fault"]["findings"][0]["message"]
            .as_str()
            .unwrap()
            .contains("none.yaml"),
        "{faults:?}"
    );
    // An analysis that fails does not stop the others.
    let kept = Kept::default();
    let study = STUDY.replace("analyses:", "measurements: { m: { file: none.csv, columns: { torque: torque, speed: speed, loss: loss } } }\nanalyses:\n  fit: { type: map, grid: small, measured: m, model_sets: [joint] }");
    session.run(&texts(&study), "study.yaml", &[], &kept);
    let sections = kept.of("section");
    assert_eq!(sections.len(), 3, "{:?}", kept.events.lock().unwrap());
    assert!(sections[0]["section"]["failed"].is_string());
    assert_eq!(kept.of("end")[0]["failed"], 1);
}
