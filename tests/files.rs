//! What is read and written: regular files only and no longer than stated; one run at a time in a folder; names that every system has.

use crate::common::{self, program::gearloss_in as gearloss};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const STUDY: &str = "gearloss: study/1
gearboxes: { ours: gearbox.yaml }
grids: { field: { torque: [5 Nm, 10 Nm], speed: [1000 rpm, 2000 rpm] } }
analyses: { field: { type: map, grid: field, write: [csv, json, parquet] } }
";

/// A folder with a small study.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("files").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::copy(common::file("tests/cases/fine/input.yaml"), folder.join("gearbox.yaml")).unwrap();
    fs::write(folder.join("study.yaml"), STUDY).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let output = gearloss(folder, arguments);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    for word in words {
        assert!(told.contains(word), "{arguments:?} does not say `{word}`:\n{told}");
    }
}

/// Names of the files in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[cfg(unix)]
#[test]
fn devices_without_end_are_refused_wherever_a_file_is_named() {
    let folder = folder("devices");
    let no_file = "it is a device or a pipe, not a file";
    let gearbox = fs::read_to_string(folder.join("gearbox.yaml")).unwrap();
    let with = |name: &str, text: String| fs::write(folder.join(name), text).unwrap();
    with("extends.yaml", "gearloss: gearbox/1\nextends: /dev/zero\n".to_owned());
    with(
        "catalogue.yaml",
        format!("{gearbox}catalogues: {{ bearings: /dev/zero }}\n"),
    );
    with(
        "table.yaml",
        gearbox.replace("seal: { type: iso14179_2 }", "seal: { type: table, file: /dev/zero }"),
    );
    for name in ["extends.yaml", "catalogue.yaml", "table.yaml", "/dev/zero"] {
        refused(&folder, &["check", name], &[no_file]);
        refused(
            &folder,
            &["solve", name, "--speed", "100 rpm", "--torque", "1 Nm"],
            &[no_file],
        );
    }
    with(
        "data.yaml",
        STUDY.replace("{ type: map, grid: field,", "{ type: map, points: { file: /dev/zero },"),
    );
    with("gearboxes.yaml", STUDY.replace("gearbox.yaml", "/dev/zero"));
    with(
        "cycle.yaml",
        STUDY
            .replace("analyses:", "cycles: { drive: { file: /dev/zero } }\nanalyses:")
            .replace(
                "{ type: map, grid: field, write: [csv, json, parquet] }",
                "{ type: cycle, cycles: [drive] }",
            ),
    );
    for name in ["data.yaml", "gearboxes.yaml", "cycle.yaml", "/dev/zero"] {
        refused(&folder, &["run", name, "-o", "results"], &[no_file]);
    }
    refused(
        &folder,
        &["run", "study.yaml", "-o", "new", "--template", "/dev/zero"],
        &[no_file],
    );
    refused(&folder, &["eval", "seal/linke", "--input", "/dev/zero"], &[no_file]);
    refused(&folder, &["fit", "power-law", "/dev/zero"], &[no_file]);
    refused(&folder, &["fit", "stribeck", "/dev/zero"], &[no_file]);
    let import = [
        "import",
        "openfoam-forces",
        "/dev/zero",
        "--axis",
        "x",
        "--from",
        "0 s",
        "-o",
        "made.csv",
    ];
    refused(&folder, &import, &[no_file]);
}

#[test]
fn long_documents_are_refused_before_they_are_read() {
    let folder = folder("long");
    let file = fs::File::create(folder.join("long.yaml")).unwrap();
    file.set_len(5 << 20).unwrap();
    let long = "it has 5 MB; at most 4 MB are read";
    refused(&folder, &["check", "long.yaml"], &["long.yaml", long]);
    refused(&folder, &["run", "long.yaml"], &["long.yaml", long]);
}

#[test]
fn files_of_users_are_opened_in_one_place() {
    // The library inside of FMUs is not part of the program: it reads the resources of its FMU, up to a length of its own.
    // Locks and flushed folders of the workbench have no content that is read.
    let allowed = [
        "framework/document/src/files.rs",
        "framework/fmu/src/runtime/host.rs",
        "framework/workbench/src/disk.rs",
        "framework/workbench/src/drafts.rs",
        "framework/workbench/src/lock.rs",
    ];
    let mut found = Vec::new();
    let mut folders = ["src", "framework", "plugins/src"].map(common::file).to_vec();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                // Tests read their own data.
                folders.extend(Some(path).filter(|path| !path.ends_with("tests")));
            } else if path.extension().is_some_and(|kind| kind == "rs")
                && !allowed.iter().any(|file| path.ends_with(file))
            {
                let text = fs::read_to_string(&path).unwrap();
                // Tests of a module stand at its end.
                let code = text.split("#[cfg(test)]").next().unwrap();
                let opens = ["fs::read(", "fs::read_to_string(", "File::open("];
                if opens.iter().any(|call| code.contains(call)) {
                    found.push(path);
                }
            }
        }
    }
    assert!(
        found.is_empty(),
        "these open files without `framework::files`: {found:?}"
    );
}

#[test]
fn one_run_at_a_time_writes_into_a_folder() {
    let folder = folder("held");
    let results = folder.join("results");
    fs::create_dir_all(&results).unwrap();
    let mark = fs::File::create(results.join("unfinished.run")).unwrap();
    mark.lock().unwrap();
    fs::write(results.join("field.csv.1-0.part"), "half a ta").unwrap();
    for arguments in [
        &["run", "study.yaml"][..],
        &["run", "study.yaml", "--force"],
        &["run", "study.yaml", "--shard", "1/1", "-o", "results"],
    ] {
        refused(
            &folder,
            arguments,
            &["another run writes into", "results", "wait for it"],
        );
    }
    assert_eq!(names(&results), ["field.csv.1-0.part", "unfinished.run"]);
    // The other run is killed: its lock goes, what it has begun stays.
    drop(mark);
    let output = gearloss(&folder, &["run", "study.yaml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("was interrupted"),
        "{}",
        text(&output.stdout)
    );
    assert_eq!(
        names(&results),
        [
            "field.csv",
            "field.json",
            "field.parquet",
            "report.content",
            "report.html"
        ]
    );
    let again = gearloss(&folder, &["run", "study.yaml"]);
    assert!(text(&again.stdout).contains("replacing the results"));
}

#[test]
fn a_run_that_was_killed_is_gone_on_with() {
    let folder = folder("killed");
    fs::write(
        folder.join("study.yaml"),
        STUDY.replace(
            "torque: [5 Nm, 10 Nm]",
            "torque: { from: 0.001 Nm, to: 50 Nm, step: 0.001 Nm }",
        ),
    )
    .unwrap();
    let mut run = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    let mut run = run
        .current_dir(&folder)
        .args(["run", "study.yaml"])
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let results = folder.join("results");
    // Until it has begun to write; it takes a second from there.
    while !(results.is_dir() && names(&results).iter().any(|name| name.contains(".part"))) {
        assert!(run.try_wait().unwrap().is_none(), "it ended before it was seen");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    assert!(results.join("unfinished.run").is_file() && !results.join("report.html").exists());
    fs::write(folder.join("study.yaml"), STUDY).unwrap();
    let output = gearloss(&folder, &["run", "study.yaml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(
        names(&results),
        [
            "field.csv",
            "field.json",
            "field.parquet",
            "report.content",
            "report.html"
        ]
    );
    // Files of somebody else are not taken for those of a run.
    fs::remove_file(results.join("report.html")).unwrap();
    refused(&folder, &["run", "study.yaml"], &["not results of a study", "--force"]);
}

#[cfg(unix)]
#[test]
fn links_are_replaced_and_not_followed() {
    use std::os::unix::fs::symlink;
    let folder = folder("links");
    let results = folder.join("results");
    assert!(gearloss(&folder, &["run", "study.yaml"]).status.success());
    let diary = folder.join("diary.txt");
    fs::write(&diary, "dear diary").unwrap();
    for name in ["field.csv", "report.html"] {
        fs::remove_file(results.join(name)).unwrap();
        symlink(&diary, results.join(name)).unwrap();
    }
    assert!(gearloss(&folder, &["run", "study.yaml"]).status.success());
    assert_eq!(fs::read_to_string(&diary).unwrap(), "dear diary");
    assert!(!fs::symlink_metadata(results.join("field.csv")).unwrap().is_symlink());
    symlink(&diary, results.join("unfinished.run")).unwrap();
    refused(&folder, &["run", "study.yaml"], &["unfinished.run", "a link"]);
    let part = folder.join("shards/1-of-1");
    assert!(
        gearloss(&folder, &["run", "study.yaml", "--shard", "1/1"])
            .status
            .success()
    );
    fs::remove_file(part.join("field.tasks")).unwrap();
    symlink(&diary, part.join("field.tasks")).unwrap();
    refused(
        &folder,
        &["run", "study.yaml", "--shard", "1/1"],
        &["field.tasks", "a link"],
    );
}

/// A limit on the length of files stands for a disk that is full: both let a write fail.
#[cfg(unix)]
#[test]
fn what_cannot_be_written_is_named() {
    let folder = folder("full");
    let larger = STUDY.replace("torque: [5 Nm, 10 Nm]", "torque: { from: 1 Nm, to: 50 Nm, step: 1 Nm }");
    fs::write(folder.join("study.yaml"), larger).unwrap();
    let limited = |arguments: &str| {
        let order = format!("trap '' XFSZ; ulimit -f 4; exec \"$0\" {arguments}");
        let mut shell = Command::new("sh");
        shell
            .current_dir(&folder)
            .args(["-c", &order, env!("CARGO_BIN_EXE_gearloss")]);
        shell.output().unwrap()
    };
    let output = limited("run study.yaml");
    let told = text(&output.stderr);
    assert!(
        output.status.code() == Some(2) && told.contains("cannot write results/field."),
        "{told}"
    );
    let output = limited("run study.yaml --shard 1/1");
    let told = text(&output.stderr);
    assert!(
        output.status.code() == Some(2) && told.contains("cannot write ") && told.contains("shards/1-of-1/field.tasks"),
        "{told}"
    );
    if Path::new("/dev/full").exists() {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let mut models = Command::new(env!("CARGO_BIN_EXE_gearloss"));
        let output = models.arg("models").stdout(full).output().unwrap();
        let told = text(&output.stderr);
        assert!(told.contains("cannot write to the standard output"), "{told}");
    }
}

#[test]
fn names_of_devices_are_refused_where_they_become_files() {
    let folder = folder("names");
    fs::write(
        folder.join("study.yaml"),
        STUDY.replace("analyses: { field:", "analyses: { CON:"),
    )
    .unwrap();
    refused(
        &folder,
        &["run", "study.yaml"],
        &[
            "analyses.CON",
            "study.yaml:4",
            "device name on Windows",
            "rename it, for example to `CON_`",
        ],
    );
    refused(&folder, &["check", "study.yaml"], &["analyses.CON"]);
    fs::write(folder.join("study.yaml"), STUDY.replace("ours:", "lpt1:")).unwrap();
    refused(
        &folder,
        &["run", "study.yaml"],
        &["gearboxes.lpt1", "device name on Windows"],
    );
    refused(&folder, &["new", "plugin", "com1"], &["device name on Windows"]);
}

#[test]
fn texts_of_tables_are_no_formulas() {
    let folder = folder("formulas");
    let points = "name,speed [rpm],torque [Nm]\n=cmd|' /C calc'!A0,1000,5\n-3,1000,-5\n-,1000,5\n<!--<script>,1000,5\n";
    fs::write(folder.join("points.csv"), points).unwrap();
    let analysis =
        "analyses: { tests: { type: operating_points, data: { file: points.csv }, write: [csv, json, svg] } }\n";
    let head = STUDY.split("analyses:").next().unwrap();
    fs::write(folder.join("study.yaml"), head.to_owned() + analysis).unwrap();
    let output = gearloss(&folder, &["run", "study.yaml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let csv = fs::read_to_string(folder.join("results/tests.csv")).unwrap();
    let cells = |line: usize| csv.lines().nth(line).unwrap();
    assert!(cells(1).contains("'=cmd|"), "{csv}");
    assert!(cells(2).contains(",-3,-5,1000,"), "{csv}");
    let page = fs::read_to_string(folder.join("results/report.html")).unwrap();
    assert!(!page.contains("<!--<script>"), "a name breaks the page");
}

#[test]
fn analyses_that_hold_their_points_or_samples_refuse_too_many_of_them() {
    let folder = folder("many");
    let span = |unit: &str| format!("{{ from: 1 {unit}, to: 90000 {unit}, step: 1 {unit} }}");
    let wide = format!("torque: {}, speed: {}", span("Nm"), span("rpm"));
    let grid = "torque: { from: 1 Nm, to: 100 Nm, step: 1 Nm }, speed: { from: 10 rpm, to: 1000 rpm, step: 10 rpm }";
    let inputs = "[{ path: lubricants.oil.viscosity.kv40, percent: 5 }]";
    let many_points = ["more points", "than the maximum of 2000000", "analyses"];
    let many_samples = ["samples need", "GB of memory, more than 4 GB", "analyses"];
    for (words, analysis) in [
        (
            many_samples,
            format!("{{ type: uncertainty, grid: field, samples: 65536, inputs: {inputs} }}"),
        ),
        (
            many_samples,
            format!("{{ type: sensitivity, grid: field, methods: [sobol], samples: 16777216, parameters: {inputs} }}"),
        ),
        (
            many_points,
            "{ type: compare, grid: wide, base: mine, against: [mine] }".to_owned(),
        ),
        (
            many_points,
            format!("{{ type: sweep, path: seals.front.diameter, values: [20 mm, 21 mm], {wide} }}"),
        ),
        (many_points, format!("{{ type: breakdown, {wide} }}")),
        (
            many_points,
            format!("{{ type: temperature_sweep, oil_temperature: [20 degC], {wide} }}"),
        ),
        (
            many_points,
            format!(
                "{{ type: component_compare, component: seals.front, models: {{ own: {{ type: iso14179_2 }} }}, {wide} }}"
            ),
        ),
    ] {
        let study = format!(
            "gearloss: study/1\ngearboxes: {{ ours: gearbox.yaml }}\nmodel_sets: {{ mine: {{ seal: none }} }}\ngrids: {{ field: {{ {grid} }}, wide: {{ torque: {{ from: 1 Nm, to: 4000 Nm, step: 1 Nm }}, \
             speed: {{ from: 1 rpm, to: 4000 rpm, step: 1 rpm }} }} }}\nanalyses: {{ many: {analysis} }}\n"
        );
        fs::write(folder.join("study.yaml"), study).unwrap();
        refused(&folder, &["run", "study.yaml"], &words);
    }
}
