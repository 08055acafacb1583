//! Definitions, references and renaming over several documents.

use std::path::Path;

use gearloss_editor::{FileRange, Workspace};

use super::common::in_memory;

const BASE: &str = "gearloss: gearbox/1
ports: { input: drive }
shafts: { drive: { axis: [0 mm, 0 mm] }, wheel: {} }
gears: { G1: { shaft: drive }, G2: { shaft: wheel } }
bearings: { B1: { shaft: drive } }
couplings: { K1: { between: [drive, wheel] } }
gear_states: { first: [K1], second: [] }
assumed: [{ paths: [shafts.drive.mass], because: guess }]
";

const DERIVED: &str = "gearloss: gearbox/1
extends: base.yaml
set: { shafts.drive.mass: 2 kg }
shafts: { drive: { mass: 3 kg } }
";

const STUDY: &str = "gearloss: study/1
gearboxes: { one: derived.yaml }
grids: { g: { gear: [first], torque: 1 Nm, speed: 1 rpm } }
conditions: { set: { shafts.drive.mass: 1 kg } }
analyses: { a: { type: balance, gear: first } }
";

fn workspace() -> Workspace<'static> {
    in_memory(&[("base.yaml", BASE), ("derived.yaml", DERIVED), ("study.yaml", STUDY)])
}

fn at(text: &str, before: &str) -> usize {
    text.find(before).unwrap_or_else(|| panic!("{before}"))
}

/// File and line, from one, of each place.
fn shown(places: &[FileRange]) -> Vec<String> {
    let line = |place: &FileRange| {
        format!(
            "{}:{}:{}",
            place.file,
            place.range.start.line + 1,
            place.range.start.utf8
        )
    };
    places.iter().map(line).collect()
}

#[test]
fn an_id_and_a_file_have_a_definition() {
    let workspace = workspace();
    let definition =
        |file: &str, text: &str, before: &str| shown(&workspace.definition(Path::new(file), at(text, before)));
    assert_eq!(definition("base.yaml", BASE, "drive }, G2"), ["base.yaml:3:10"]);
    assert_eq!(definition("study.yaml", STUDY, "derived.yaml"), ["derived.yaml:1:0"]);
    assert_eq!(definition("derived.yaml", DERIVED, "base.yaml"), ["base.yaml:1:0"]);
    assert_eq!(definition("study.yaml", STUDY, "first }"), ["base.yaml:7:15"]);
    // Written in both: what `extends` merges.
    assert_eq!(
        definition("study.yaml", STUDY, "drive.mass"),
        ["derived.yaml:4:10", "base.yaml:3:10"]
    );
    assert!(definition("study.yaml", STUDY, "1 Nm").is_empty());
}

#[test]
fn references_are_found_in_every_document() {
    let found = shown(&workspace().references(Path::new("base.yaml"), at(BASE, "drive: {")));
    assert_eq!(
        found,
        [
            "base.yaml:2:16",
            "base.yaml:3:10",
            "base.yaml:4:22",
            "base.yaml:5:25",
            "base.yaml:6:29",
            "base.yaml:8:27",
            "derived.yaml:3:14",
            "derived.yaml:4:10",
            "study.yaml:4:28",
        ]
    );
}

#[test]
fn renaming_changes_every_use() {
    let workspace = workspace();
    let edits = workspace
        .rename(Path::new("study.yaml"), at(STUDY, "first }"), "low")
        .unwrap();
    let mut texts = [("base.yaml", BASE.to_owned()), ("study.yaml", STUDY.to_owned())];
    for file in &edits {
        let (_, text) = texts.iter_mut().find(|(name, _)| *name == file.file).unwrap();
        for edit in file.edits.iter().rev() {
            text.replace_range(edit.range.from..edit.range.to, &edit.insert);
        }
    }
    assert!(texts[0].1.contains("gear_states: { low: [K1]"), "{}", texts[0].1);
    assert!(
        texts[1].1.contains("gear: [low]") && texts[1].1.contains("gear: low }"),
        "{}",
        texts[1].1
    );
    assert!(!texts.iter().any(|(_, text)| text.contains("first")));
}

#[test]
fn a_name_that_cannot_be_given_is_refused_with_help() {
    let workspace = workspace();
    let file = Path::new("base.yaml");
    for (before, new, words) in [
        ("drive: {", "wheel", "already has an id"),
        ("drive: {", "2nd", "not a valid id"),
        ("drive: {", "on", "not a valid id"),
        ("guess", "other", "no id here"),
    ] {
        let refused = workspace.rename(file, at(BASE, before), new).unwrap_err();
        assert!(refused.to_string().contains(words), "{new}: {refused}");
    }
    // The name of a gear may begin with a digit.
    assert!(workspace.rename(file, at(BASE, "second"), "2nd").is_ok());
}

#[test]
fn a_gear_of_two_gearboxes_is_not_renamed_for_one_of_them() {
    let study = STUDY.replace("{ one: derived.yaml }", "{ one: derived.yaml, two: other.yaml }");
    let workspace = in_memory(&[
        ("base.yaml", BASE),
        ("derived.yaml", DERIVED),
        ("other.yaml", "gearloss: gearbox/1\ngear_states: { first: [] }\n"),
        ("study.yaml", &study),
    ]);
    let refused = workspace
        .rename(Path::new("base.yaml"), at(BASE, "first:"), "low")
        .unwrap_err();
    assert!(refused.message.contains("study.yaml, line 3"), "{refused}");
    let stated = study
        .replace("type: balance,", "type: balance, gearbox: two,")
        .replace("gear: [first], ", "");
    let workspace = in_memory(&[
        ("base.yaml", BASE),
        ("derived.yaml", DERIVED),
        ("other.yaml", "gearloss: gearbox/1\ngear_states: { first: [] }\n"),
        ("study.yaml", &stated),
    ]);
    let edits = workspace
        .rename(Path::new("base.yaml"), at(BASE, "first:"), "low")
        .unwrap();
    assert_eq!(edits.len(), 1, "{edits:?}");
}

#[test]
fn the_outline_has_sections_and_ids() {
    let symbols = workspace().symbols(Path::new("base.yaml"));
    let shafts = symbols.iter().find(|symbol| symbol.name == "shafts").unwrap();
    let ids: Vec<&str> = shafts.children.iter().map(|symbol| symbol.name.as_str()).collect();
    assert_eq!(ids, ["drive", "wheel"]);
    assert!(shafts.children[0].is_id);
}

/// Text after renaming what is at the first occurrence of a word.
fn renamed(files: &[(&str, &str)], file: &str, before: &str, new: &str) -> Vec<(String, String)> {
    let workspace = in_memory(files);
    let (_, text) = files.iter().find(|(name, _)| *name == file).unwrap();
    let edits = workspace.rename(Path::new(file), at(text, before), new).unwrap();
    let changed = edits.iter().map(|edited| {
        let (name, text) = files.iter().find(|(name, _)| *name == edited.file).unwrap();
        let mut text = (*text).to_owned();
        for edit in edited.edits.iter().rev() {
            text.replace_range(edit.range.from..edit.range.to, &edit.insert);
        }
        ((*name).to_owned(), text)
    });
    changed.collect()
}

#[test]
fn ids_of_a_study_and_sets_of_a_product_are_renamed() {
    let study = "gearloss: study/1
gearboxes: { one: box.yaml }
grids: { small: { torque: 1 Nm, speed: 1 rpm } }
analyses:
  a: { type: map, grid: small, model_sets: [one/joint, joint] }
  fit: { type: identify, then: fitted }
  b: { type: map, grid: small, model_sets: [fitted] }
answered_by: [a]
";
    let gearbox = "gearloss: gearbox/1\nmodel_sets: { joint: {}, other: { extends: joint } }\n";
    let files = [("study.yaml", study), ("box.yaml", gearbox)];
    for (file, before, new, expected) in [
        ("study.yaml", "small: {", "tiny", study.replace("small", "tiny")),
        ("study.yaml", "one: box", "ev", study.replace("one", "ev")),
        ("study.yaml", "fitted }", "found", study.replace("fitted", "found")),
        (
            "study.yaml",
            "a]",
            "losses",
            study.replace("  a:", "  losses:").replace("[a]", "[losses]"),
        ),
        ("box.yaml", "joint: {}", "both", study.replace("joint", "both")),
    ] {
        let changed = renamed(&files, file, before, new);
        let (_, text) = changed.iter().find(|(name, _)| name == "study.yaml").unwrap();
        assert_eq!(*text, expected, "{before}");
        if file == "box.yaml" {
            assert!(
                changed.contains(&("box.yaml".to_owned(), gearbox.replace("joint", "both"))),
                "{changed:?}"
            );
        }
    }
}
