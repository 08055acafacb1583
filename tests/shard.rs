//! Shards of a study, merged, give what a single run gives, byte by byte; they go on where they were broken off, and parts of
//! anything else are refused.

// In a folder, what the program prints of its results is the same wherever that lies.
use crate::common::{self, program::gearloss_in as gearloss};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("shard").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The same, with the gearbox of the two-speed example.
fn with_gearbox(name: &str) -> PathBuf {
    let folder = folder(name);
    let gearbox = common::file("examples/two-speed-ev/gearbox.yaml");
    fs::copy(gearbox, folder.join("gearbox.yaml")).unwrap();
    folder
}

fn fine(folder: &Path, arguments: &[&str]) -> Output {
    let output = gearloss(folder, arguments);
    assert!(
        output.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Why a command fails.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = gearloss(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    text(&output.stderr)
}

/// All files of a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let read = |path: PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, fs::read(path).unwrap())
    };
    entries.map(read).collect()
}

/// Runs a study at once and in shards, and compares everything.
fn same_as_single(folder: &Path, study: &str, shards: usize, end: &[&str]) -> Output {
    let both = |command: &[&str]| -> Vec<String> { [command, end].concat().into_iter().map(str::to_owned).collect() };
    let run = |arguments: Vec<String>| gearloss(folder, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let single = run(both(&["run", study, "-o", "results"]));
    let single_files = files(&folder.join("results"));
    fs::remove_dir_all(folder.join("results")).unwrap();
    let mut parts = Vec::new();
    for k in 1..=shards {
        let part = format!("part-{k}");
        fine(
            folder,
            &["run", study, "--shard", &format!("{k}/{shards}"), "-o", &part],
        );
        parts.push(part);
    }
    let names = parts.iter().map(String::as_str);
    let command: Vec<&str> = ["merge", study]
        .into_iter()
        .chain(names)
        .chain(["-o", "results"])
        .collect();
    let merged = run(both(&command));
    let merged_files = files(&folder.join("results"));
    assert_eq!(
        single_files.keys().collect::<Vec<_>>(),
        merged_files.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in &single_files {
        let merged = &merged_files[name];
        if name == "report.html" {
            assert_same_text(&text(bytes), &text(merged));
        }
        // The content holds the same times as the page.
        assert!(
            *bytes == *merged || name == "report.html" || name == "report.content",
            "{name} differs"
        );
    }
    assert_same_text(&text(&single.stdout), &text(&merged.stdout));
    assert_same_text(&text(&single.stderr), &text(&merged.stderr));
    assert_eq!(single.status.code(), merged.status.code());
    single
}

/// A row of a page without the cells of two decimals.
fn without_times(row: &str) -> String {
    let cells = row.split("<td>").map(|cell| {
        let text = cell.split('<').next().unwrap_or_default();
        let is_time = text.split_once('.').is_some_and(|(_, decimals)| decimals.len() == 2);
        if is_time {
            cell.replacen(text, "*", 1)
        } else {
            cell.to_owned()
        }
    });
    cells.collect::<Vec<_>>().join("<td>")
}

/// Compares line by line, but for the columns of times that a tournament measures: they differ between any two runs.
fn assert_same_text(one: &str, other: &str) {
    assert_eq!(one.lines().count(), other.lines().count());
    // First and last character of the column in the present table.
    let mut times: Option<(usize, usize)> = None;
    // Whether the present table of a page has a column of times; its cells with two decimals are not compared.
    let mut timed = false;
    for (a, b) in one.lines().zip(other.lines()) {
        if a.contains("<thead>") {
            timed = a.contains(">time<") || a.contains(">relative time<");
        }
        let [a, b] = [a, b].map(|line| if timed { without_times(line) } else { line.to_owned() });
        let (a, b) = (a.as_str(), b.as_str());
        let masked = |line: &str| -> String {
            let held = |i: usize| times.is_none_or(|(start, end)| !(start..end).contains(&i));
            let chars = line.chars().enumerate();
            chars.map(|(i, c)| if held(i) { c } else { '*' }).collect()
        };
        assert!(masked(a) == masked(b), "{a:.300}\n{b:.300}");
        // A page escapes the heading `rms / accuracy`, and so shifts it against its columns.
        let a = a.replace("&#x2f;", "/");
        let long = a.find("  relative time");
        let short = a.find("  time  ").or(a.strip_suffix("  time").map(str::len));
        if let Some(start) = long.or(short.filter(|_| a.starts_with("rank"))) {
            times = Some((start + 2, if long.is_some() { a.len() } else { start + 6 }));
        } else if a.is_empty() {
            times = None;
        }
    }
}

/// Copies the files of a folder, without folders in it.
fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        if entry.file_type().unwrap().is_file() {
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
    }
}

/// Every type of analysis with every variant.
#[test]
fn three_shards_of_every_analysis_make_the_single_run() {
    let folder = folder("every");
    for from in [
        "two-speed-ev",
        "planetary-reducer",
        "electric-drive-unit",
        "drive-unit-system",
    ] {
        copied(
            &common::file("examples").join(from),
            &folder.join("examples").join(from),
        );
    }
    copied(&common::file("tests/results"), &folder.join("tests/results"));
    let output = same_as_single(&folder, "tests/results/study.yaml", 3, &[]);
    assert!(output.status.success());
}

/// A study with a map of several pieces, one of points and bound values, a failing analysis, and the gearbox beside it.
const STUDY: &str = "
gearloss: study/1
title: In parts
gearboxes: { ours: gearbox.yaml }
conditions: { torque_at: input, speed_at: input }
model_sets:
  iso: { bearing: { type: iso14179_2 } }
grids:
  field:
    gear: [first, second]
    torque: { from: 1 Nm, to: 20 Nm, step: 0.5 Nm }
    speed: { from: 500 rpm, to: 22000 rpm, step: 500 rpm }
    envelope: { speed: [0 rpm, 10000 rpm, 22000 rpm], torque: [20 Nm, 20 Nm, 8 Nm] }
  rising: { gear: first, torque: { from: 1 Nm, to: 20 Nm, step: 1 Nm }, speed: { from: 1000 rpm, to: 20000 rpm, step: 1000 rpm } }
  high: { gear: first, torque: 5 Nm, speed: 1 rpm, envelope: { speed: [0 rpm, 10 rpm], torque: [1 Nm, 1 Nm] } }
analyses:
  maps: { type: map, grid: field, model_sets: [iso], write: [csv, json, parquet, svg] }
  listed: { type: map, points: { file: points.csv }, gear: first, write: [csv, json] }
  beyond: { type: map, grid: high }
  table: { type: map, grid: rising, export: [lossy_gear], write: [csv] }
  gap: { type: compare, grid: rising, base: iso, against: [iso], quantity: loss, write: [csv, json, parquet] }
";

/// Writes the study with what it names into a folder.
fn small(name: &str) -> PathBuf {
    let folder = with_gearbox(name);
    fs::write(folder.join("study.yaml"), STUDY).unwrap();
    fs::write(
        folder.join("points.csv"),
        "torque [Nm],speed [rpm]\n5,3000\n8,12000\n-3,4000\n",
    )
    .unwrap();
    folder
}

/// What fails in a single run fails in the same words after a merge, with the same exit code; and what is denied is denied.
#[test]
fn failures_and_denials_are_those_of_the_single_run() {
    let folder = small("failures");
    let output = same_as_single(&folder, "study.yaml", 2, &[]);
    let words = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(words.contains("no point of the grid is below the envelope"), "{words}");
    assert!(words.contains("1 of 5 analyses failed"), "{words}");

    let sound: Vec<&str> = STUDY.lines().filter(|line| !line.starts_with("  beyond")).collect();
    fs::write(folder.join("study.yaml"), sound.join("\n")).unwrap();
    for old in ["part-1", "part-2", "results"] {
        fs::remove_dir_all(folder.join(old)).unwrap();
    }
    let output = same_as_single(&folder, "study.yaml", 2, &["--deny", "extrapolation"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("--deny extrapolation"));
}

/// A piece of a map that several tasks solve has its points where they belong, in every file.
#[test]
fn pieces_of_several_tasks_keep_the_order_of_the_grid() {
    let folder = with_gearbox("tasks");
    let study = "
gearloss: study/1
gearboxes: { ours: gearbox.yaml }
conditions: { torque_at: input, speed_at: input, oil_temperature: 80 degC }
grids:
  field: { gear: first, torque: { from: 1 Nm, to: 70 Nm, step: 1 Nm }, speed: { from: 100 rpm, to: 8000 rpm, step: 100 rpm } }
analyses:
  map: { type: map, grid: field, export: [lossy_gear], write: [csv, json, parquet] }
";
    fs::write(folder.join("study.yaml"), study).unwrap();
    same_as_single(&folder, "study.yaml", 2, &[]);
    let csv = fs::read_to_string(folder.join("results/map.csv")).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let [torque, speed] = ["torque_nm", "speed_rpm"].map(|name| head.iter().position(|h| *h == name).unwrap());
    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.join("results/map.json")).unwrap()).unwrap();
    let points = json["maps"][0]["points"].as_array().unwrap();
    let mut count = 0;
    for (i, line) in lines.enumerate() {
        let (t, n) = ((i / 80 + 1) as f64, (100 * (i % 80 + 1)) as f64);
        let number = |text: &str| text.parse::<f64>().unwrap();
        assert_eq!((number(line[torque]), number(line[speed])), (t, n), "line {i}");
        assert_eq!(
            (&points[i]["torque_nm"], &points[i]["speed_rpm"]),
            (&t.into(), &n.into()),
            "{i}"
        );
        count += 1;
    }
    assert_eq!((count, points.len()), (5600, 5600));
}

/// `shard 1/2: 3 tasks in FOLDER, 2 of them from before`: the tasks of the shard, and those from before.
fn counted(output: &Output) -> (usize, usize) {
    let line = text(&output.stdout).lines().next().unwrap().to_owned();
    let numbers: Vec<usize> = line
        .replace(',', " ")
        .split_whitespace()
        .filter_map(|w| w.parse().ok())
        .collect();
    let [computed, before] = numbers[..] else {
        panic!("{line}");
    };
    (computed, before)
}

#[test]
fn a_broken_off_shard_goes_on_where_it_stopped() {
    let folder = small("resumed");
    let run = ["run", "study.yaml", "--shard", "1/2", "-o", "one"];
    let (computed, before) = counted(&fine(&folder, &run));
    assert!(computed >= 2 && before == 0, "{computed} {before}");
    assert_eq!(
        counted(&fine(&folder, &run)),
        (computed, computed),
        "nothing is computed twice"
    );

    // The last result is cut off in the middle, as by a full disk, and then one byte of another one is changed.
    let path = folder.join("one/maps.tasks");
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 100]).unwrap();
    assert_eq!(counted(&fine(&folder, &run)), (computed, computed - 1));
    assert_eq!(fs::read(&path).unwrap(), whole);

    let mut changed = whole.clone();
    changed[200] ^= 1;
    fs::write(&path, changed).unwrap();
    let (_, before) = counted(&fine(&folder, &run));
    assert!(before < computed);
    assert_eq!(fs::read(&path).unwrap(), whole);

    fine(&folder, &["run", "study.yaml", "--shard", "2/2", "-o", "two"]);
    assert_eq!(
        gearloss(&folder, &["merge", "study.yaml", "one", "two"]).status.code(),
        Some(2),
        "the failing analysis of the study is told"
    );
    assert!(folder.join("results/maps.json").is_file());
}

#[test]
fn parts_of_anything_else_are_refused() {
    let folder = small("changed");
    let shard = |k: &'static str| ["run", "study.yaml", "--shard", k];
    fine(&folder, &shard("1/2"));
    let missing = refused(&folder, &["merge", "study.yaml"]);
    assert!(missing.contains("missing or unfinished: shard 2/2"), "{missing}");
    assert!(missing.contains("gearloss run study.yaml --shard 2/2"), "{missing}");
    fine(&folder, &shard("2/2"));
    assert!(!folder.join("results").exists());

    for (file, from, to) in [
        ("gearbox.yaml", "radial_clearance", "radial_clearance"),
        ("points.csv", "8,12000", "8,12001"),
        ("study.yaml", "step: 0.5 Nm", "step: 0.25 Nm"),
    ] {
        let path = folder.join(file);
        let original = fs::read_to_string(&path).unwrap();
        // A comment is a change as well: what was read is told by its bytes.
        let changed = if from == to {
            format!("{original}\n# changed\n")
        } else {
            original.replace(from, to)
        };
        assert_ne!(changed, original, "{file}");
        fs::write(&path, changed).unwrap();
        for arguments in [&["merge", "study.yaml"][..], &shard("1/2")] {
            let words = refused(&folder, arguments);
            let named = file.replace("study.yaml", "study");
            assert!(words.contains("was computed from other inputs"), "{words}");
            assert!(words.contains(&named) && words.contains("has changed"), "{words}");
        }
        fs::write(&path, original).unwrap();
    }

    // Another version of a crate of models.
    let manifest = folder.join("shards/2-of-2/shard.json");
    let original = fs::read_to_string(&manifest).unwrap();
    let other = original.replacen("gearloss-plugins ", "gearloss-plugins 9.", 1);
    assert_ne!(other, original);
    fs::write(&manifest, other).unwrap();
    let words = refused(&folder, &["merge", "study.yaml"]);
    assert!(
        words.contains("models from") && words.contains("gearloss-plugins 9."),
        "{words}"
    );
    fs::write(&manifest, original).unwrap();

    // Shards of two splittings, a folder of something else, a shard in the folder of another.
    fine(&folder, &["run", "study.yaml", "--shard", "1/3", "-o", "third"]);
    let words = refused(&folder, &["merge", "study.yaml", "shards/1-of-2", "third"]);
    assert!(
        words.contains("belongs to 2 shards") && words.contains("to 3"),
        "{words}"
    );
    let words = refused(&folder, &["run", "study.yaml", "--shard", "2/3", "-o", "third"]);
    assert!(words.contains("shard 1/3, not to 2/3"), "{words}");
    let words = refused(&folder, &["run", "study.yaml", "--shard", "2/3", "-o", "."]);
    assert!(words.contains("not part of a study"), "{words}");
    let words = refused(&folder, &["merge", "study.yaml", "."]);
    assert!(words.contains("not a part of a study"), "{words}");
}

#[test]
fn more_shards_than_pieces_are_fine_and_wrong_numbers_are_reported() {
    let folder = with_gearbox("many");
    let study = "gearloss: study/1\ngearboxes: { ours: gearbox.yaml }\ngrids:\n  few: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 8000 rpm] }\nanalyses:\n  map: { type: map, grid: few, write: [csv] }\n";
    fs::write(folder.join("study.yaml"), study).unwrap();
    same_as_single(&folder, "study.yaml", 4, &[]);
    for wrong in ["0/3", "4/3", "1", "1/0", "a/b", "-1/3", ""] {
        let words = refused(&folder, &["run", "study.yaml", &format!("--shard={wrong}")]);
        assert!(words.contains("K/N"), "{wrong}: {words}");
    }
    let words = refused(
        &folder,
        &["run", "study.yaml", "--shard", "1/2", "--deny", "extrapolation"],
    );
    assert!(words.contains("cannot be used with"), "{words}");
}

#[test]
fn shards_lists_the_tasks_and_proposes_a_number() {
    let folder = small("proposed");
    let sound: Vec<&str> = STUDY.lines().filter(|line| !line.starts_with("  beyond")).collect();
    fs::write(folder.join("study.yaml"), sound.join("\n")).unwrap();
    let words = text(&fine(&folder, &["shards", "study.yaml"]).stdout);
    let row = |name: &str| -> Vec<String> {
        let line = words.lines().find(|line| line.starts_with(name)).unwrap();
        line.split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(row("maps")[1], "4", "{words}");
    assert_eq!(row("listed")[1..3], ["not", "split:"], "{words}");
    assert!(words.contains("on one core: one `gearloss run` suffices"), "{words}");
    fs::write(folder.join("study.yaml"), "gearloss: study/1\n").unwrap();
    assert!(refused(&folder, &["shards", "study.yaml"]).contains("gearboxes"));
}
