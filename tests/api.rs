//! The library as a program uses it: documents from memory, points, studies, typed outcomes.

use std::path::{Path, PathBuf};
use std::sync::Barrier;

use gearloss::api::analyses::cycle::CycleOutcome;
use gearloss::api::analyses::operating_points::OperatingPointsOutcome;
use gearloss::api::{
    Choice, Disk, Field, FileSource as _, Findings, Gearbox, Given, InMemory, Language, Outcome, Points, SharedSource,
    Study, StudyRun, read_study, solve_point, solve_points,
};

use crate::common::{file, language, two_speed, two_speed_with};

/// The files of a folder of the repository, in memory under the same path below a folder that there is not.
fn in_memory(folders: &[&str]) -> SharedSource {
    let mut files = InMemory::default();
    for folder in folders {
        for entry in std::fs::read_dir(file(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let name = path.file_name().unwrap();
                files.add(nowhere().join(folder).join(name), std::fs::read(&path).unwrap());
            }
        }
    }
    files.shared()
}

fn nowhere() -> PathBuf {
    PathBuf::from("/nowhere")
}

/// The outcome of an analysis as JSON.
fn json(outcome: &dyn Outcome) -> String {
    let mut text = Vec::new();
    outcome.write_json(&mut text).unwrap();
    String::from_utf8(text).unwrap()
}

/// The outcome of an analysis of a study in memory, which is that of the same study on the disk.
fn same_from_memory(study: &str, folders: &[&str], analysis: &str) -> Box<dyn Outcome> {
    let language = language();
    let memory = read_study(&language, &in_memory(folders), nowhere().join(study)).unwrap();
    let disk = read_study(&language, &Disk::shared(), file(study)).unwrap();
    let from_memory = StudyRun::new(&language, &memory).analysis(analysis).unwrap();
    let from_disk = StudyRun::new(&language, &disk).analysis(analysis).unwrap();
    assert_eq!(json(from_memory.as_ref()), json(from_disk.as_ref()));
    from_memory
}

#[test]
fn a_study_with_points_and_tables_runs_from_memory() {
    let outcome = same_from_memory(
        "examples/planetary-reducer/study.yaml",
        &["examples/planetary-reducer"],
        "tests",
    );
    let typed = outcome.get::<OperatingPointsOutcome>();
    assert!(typed.is_some() && outcome.get::<CycleOutcome>().is_none());
    let table = outcome.table("tests").unwrap();
    let losses = table.column("loss_w").and_then(|column| column.numbers());
    assert_eq!(losses.map(<[f64]>::len), Some(table.len()), "{:?}", table.header());
}

#[test]
fn a_recorded_duty_runs_from_memory() {
    let folders = [
        "tests/results",
        "examples/two-speed-ev",
        "examples/planetary-reducer",
        "examples/electric-drive-unit",
        "examples/drive-unit-system",
    ];
    let outcome = same_from_memory("tests/results/study.yaml", &folders, "cycle_thermal");
    assert!(!outcome.get::<CycleOutcome>().unwrap().cycles.is_empty());
}

#[test]
fn files_beside_a_document_in_memory_are_not_read_from_the_disk() {
    let text = Disk
        .read_text(&file("examples/planetary-reducer/gearbox.yaml"), 1 << 20)
        .unwrap();
    // On the disk the table that the gearbox names is beside it.
    let path = file("examples/planetary-reducer/gearbox.yaml");
    let files = InMemory::new([(&path, text)]).shared();
    let language = language();
    let built =
        Gearbox::read_from(&language, &files, &path).and_then(|g| g.transmission(&language, &Choice::default()));
    let found = built.err().unwrap().render();
    assert!(found.contains("there is no such file in memory"), "{found}");
    let missing = Gearbox::read_from(&language, &files, Path::new("none.yaml"))
        .err()
        .unwrap();
    assert!(missing.render().contains("cannot read none.yaml"), "{missing}");
}

#[test]
fn points_are_solved_alone_and_together() {
    let language = language();
    let gearbox = two_speed(&language);
    let t = two_speed_with(&language, Some("joint"), &[]);
    let given = [
        Given::new(10.0, 400.0),
        Given::new(10.0, 800.0),
        Given::new(20.0, 800.0),
    ];
    let list = Points::at_reference(&t, "first", Field::List(given.to_vec()));
    let solved = solve_points(&gearbox, &t, &list).unwrap().points;
    for (given, solved) in given.into_iter().zip(&solved) {
        let alone = solve_point(&gearbox, &t, "first", given).unwrap();
        assert_eq!(alone.loss, solved.loss);
        assert!(alone.loss.is_some_and(|loss| loss > 0.0));
    }
    let wrong: Findings = solve_point(&gearbox, &t, "third", Given::new(10.0, 400.0))
        .err()
        .unwrap();
    assert!(wrong.first().contains("third"), "{wrong}");
}

#[test]
fn an_analysis_that_there_is_not_is_named() {
    let language = language();
    let study = read_study(&language, &Disk::shared(), file("examples/two-speed-ev/town.yaml")).unwrap();
    let run = StudyRun::new(&language, &study);
    let error = run.analysis("towm").err().unwrap();
    let text = error.to_string();
    assert!(text.contains("towm") && text.contains("town"), "{text}");
    // A program compares the code, and reads place and help without the text.
    let [findings] = error.findings() else {
        panic!("one list of findings: {text}");
    };
    assert_eq!(findings.list[0].code, Some(gearloss::framework::codes::UNKNOWN_NAME));
    let json = serde_json::to_value(findings).unwrap();
    assert_eq!(
        (&json[0]["code"], &json[0]["path"]),
        (&"E0203".into(), &"analyses".into())
    );
    assert!(json[0]["line"].is_u64() && json[0]["help"].is_string(), "{json:#}");
    let names: Vec<&str> = run
        .outcomes()
        .map(|(name, outcome)| outcome.map(|_| name).unwrap())
        .collect();
    assert_eq!(names, ["sets", "town"]);
}

/// A study of the two-speed gearbox in memory, with files beside it.
fn study_in_memory(language: &Language, analyses: &str, files: &[(&str, &str)]) -> Study {
    let gearbox = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let study = format!("gearloss: study/1\ngearboxes: {{ ours: gearbox.yaml }}\nanalyses:\n{analyses}");
    let texts = [("gearbox.yaml", gearbox.as_str()), ("study.yaml", study.as_str())];
    let files = InMemory::new(files.iter().copied().chain(texts));
    read_study(language, &files.shared(), "study.yaml").unwrap()
}

#[test]
fn two_runs_of_one_study_at_once_list_their_own_inputs() {
    let language = language();
    let names = ["first", "second"];
    let seal = |name: &str| {
        format!(
            "  {name}: {{ type: component_compare, component: seals.D1, torque: 1 Nm, speed: 1000 rpm, \
             models: {{ rig: {{ type: table, file: {name}.csv }} }} }}\n"
        )
    };
    let table = "speed [rpm],moment [Nm]\n0,0.1\n20000,0.2\n";
    let files = [("first.csv", table), ("second.csv", table)];
    let study = study_in_memory(&language, &names.map(seal).concat(), &files);
    // Both begin together each time, so that one reads its file while the other runs.
    let together = Barrier::new(names.len());
    let run = |name: &str| {
        for _ in 0..20 {
            together.wait();
            let outcome = StudyRun::new(&language, &study).analysis(name).unwrap();
            let inputs: Vec<&str> = outcome.head().inputs.iter().map(|input| input.file.as_str()).collect();
            assert_eq!(inputs, ["study", "gearbox.yaml", &format!("{name}.csv")]);
        }
    };
    std::thread::scope(|scope| {
        for name in names {
            let run = &run;
            scope.spawn(move || run(name));
        }
    });
}

#[test]
fn model_sets_found_by_one_run_are_unknown_to_another() {
    let language = language();
    let analyses = "  fit:
    type: identify
    data: { file: rig.csv }
    model_sets: [own]
    residuals: [loss]
    parameters: { viscosity: { path: lubricants.sump.viscosity.factor, from: 0.5, to: 2 } }
    starts: 1
    folds: 0
    then: fitted
  fitted: { type: operating_points, data: { file: rig.csv }, model_sets: [fitted] }
";
    let rig = "torque [Nm],speed [rpm],loss [W]\n5,2000,40\n10,2000,50\n20,8000,300\n";
    let study = study_in_memory(&language, analyses, &[("rig.csv", rig)]);
    let [first, second] = [(); 2].map(|()| StudyRun::new(&language, &study));
    first.analysis("fit").unwrap();
    first.analysis("fitted").unwrap();
    let error = second.analysis("fitted").err().unwrap().to_string();
    assert!(error.contains("the model set `fitted` has no values"), "{error}");
}
