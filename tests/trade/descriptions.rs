//! Gearbox files: what is absent, misspelt or set from elsewhere.
#![allow(clippy::case_sensitive_file_extension_comparisons)]

use super::Case;
use gearloss_framework::document::visible;

/// A finding about a value of `set` points at its own line and column.
#[test]
fn a_finding_about_set_points_at_its_entry() {
    let case = Case::new("set_of_another_file", "line");
    let said = case.gearloss(&["check", "set.yaml"]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.text
            .contains("set.shafts.a.nonsense: the key `nonsense` does not exist here")
            && said.text.contains("set.yaml:6:22"),
        "{}",
        said.text
    );
    // The same for a model set, and for a value that only building refuses.
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    case.write(
        "own.yaml",
        gearbox + "model_sets:\n  mine:\n    set:\n      thermal.oil: 70 degC\n      shafts.b.nonsense: 3\n",
    );
    let said = case.gearloss(&["check", "own.yaml", "--models", "mine"]);
    assert!(
        said.code == Some(2) && said.text.contains("own.yaml:18:26"),
        "{}",
        said.text
    );
}

fn bearings(case: &Case, designation: &str) -> String {
    let gearbox = format!(
        "gearloss: gearbox/1\nextends: gearbox.yaml\nbearings:\n  A: {{ shaft: a, at: 0 mm, designation: \"{designation}\" }}\n"
    );
    case.write("bearing.yaml", gearbox);
    case.gearloss(&["check", "bearing.yaml"]).text
}

/// Help about a designation never leads to another kind or bore.
#[test]
fn no_help_leads_to_another_bearing() {
    let case = Case::new("set_of_another_file", "designations");
    for (designation, others) in [
        ("C2213", &["6213", "22213"][..]),
        ("QJ213", &["6213", "7213"]),
        ("NF208", &[" 6208", "30208"]),
        ("81213", &["6213", "51213"]),
        ("22213", &["6213", " 2213"]),
        ("7213", &["6213", "write `7213BE`"]),
    ] {
        let said = bearings(&case, designation);
        assert!(said.contains(&format!("no catalogue has `{designation}`")), "{said}");
        for other in others {
            assert!(!said.contains(other), "{designation}: {said}");
        }
    }
    // The same kind and bore is offered, as a note with its sizes.
    let said = bearings(&case, "NF208");
    assert!(
        said.contains("of this kind and bore: N208EC (40 x 80 x 18 mm)"),
        "{said}"
    );
    let said = bearings(&case, "62O8");
    assert!(said.contains("write `6208`"), "{said}");
    let said = bearings(&case, "6208-XYZ");
    assert!(
        said.contains("`6208` is known, but not what `XYZ` behind it means"),
        "{said}"
    );
}

/// Words that look alike and mean other things.
#[test]
fn no_help_leads_to_another_thing() {
    let case = Case::new("set_of_another_file", "words");
    case.write(
        "kind.yaml",
        "gearloss: gearbox/1\nextends: gearbox.yaml\nbearings:\n  A: { shaft: a, at: 0 mm, kind: needle_roller, bore: 30 mm, outside: 40 mm }\n",
    );
    let said = case.gearloss(&["check", "kind.yaml"]);
    assert!(
        said.code == Some(2)
            && said.text.contains("needle_cage")
            && !said.text.contains("write `needle_roller_thrust`"),
        "{}",
        said.text
    );
}

#[test]
fn physics_that_is_absent_is_named() {
    let case = Case::new("set_of_another_file", "undescribed");
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    for (changed, what) in [
        (
            gearbox.replace("normal_module: 2 mm,", "normal_module: 2 mm, type: worm,"),
            "worm stages are described in a section of their own",
        ),
        (
            gearbox.replace("normal_module: 2 mm,", "normal_module: 2 mm, kind: spiral_bevel,"),
            "bevel stages are described in a section of their own",
        ),
        (
            gearbox.replace("axis: [60 mm, 0 mm]", "axis: [60 mm, 0 mm], direction: [0, 0, 1]"),
            "the direction of a shaft is a part of its axis",
        ),
    ] {
        case.write("changed.yaml", changed);
        let said = case.gearloss(&["check", "changed.yaml"]);
        assert!(
            said.code == Some(2) && said.text.contains(what),
            "{what}: {}",
            said.text
        );
        assert!(!said.text.contains("choose one of these keys"), "{}", said.text);
    }
    for (layout, what) in [
        ("helical-worm", "new gearbox worm"),
        ("hypoid", "new gearbox axle"),
        ("bevel", "new gearbox bevel-helical"),
    ] {
        let said = case.gearloss(&["new", "gearbox", layout, "-o", "new.yaml"]);
        assert!(said.code == Some(2) && said.text.contains(what), "{}", said.text);
    }
    let said = case.gearloss(&["new", "gearbox", "--help"]);
    assert!(!said.text.contains("cycloidal"), "{}", said.text);
}

#[test]
fn lists_and_words_in_the_wrong_place_are_led_to_theirs() {
    let case = Case::new("set_of_another_file", "places");
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    case.write("none.yaml", gearbox.clone() + "bearings: none\n");
    let said = case.gearloss(&["check", "none.yaml"]);
    assert!(
        said.code == Some(2) && said.text.contains("is a key of a single shaft"),
        "{}",
        said.text
    );
    case.write(
        "gear.yaml",
        gearbox.replace("p: { shaft: a,", "p: { bearings: none, shaft: a,"),
    );
    let said = case.gearloss(&["check", "gear.yaml"]);
    assert!(
        said.code == Some(2) && said.text.contains("write `bearings: none` for the shaft"),
        "{}",
        said.text
    );
    case.write(
        "study.yaml",
        "gearloss: study/1\ngearboxes: { g: gearbox.yaml }\ncycles:\n  d: { spectrum: { loads: [ { torque: 40 Nm, speed: 4000 rpm, share: 1 } ] } }\n\
         analyses:\n  c: { type: cycle, cycles: [d] }\n",
    );
    let said = case.gearloss(&["check", "study.yaml"]);
    assert!(
        said.code == Some(2)
            && said
                .text
                .contains("write the list itself: `spectrum: [...]`, without `loads`")
            && said.text.contains("\n1 error\n"),
        "{}",
        said.text
    );
}

/// A gearbox without `gear_states` has no such key in its messages.
#[test]
fn messages_name_keys_of_the_file() {
    let case = Case::new("set_of_another_file", "gear-states");
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    let held = gearbox.replace(
        "  m: {",
        "  second: { gears: [q, x], normal_module: 2 mm, model: none }\n  m: {",
    );
    let held = held.replace(
        "gears:\n",
        "gears:\n  q: { shaft: a, at: 60 mm, z: 30, facewidth: 20 mm }\n  x: { shaft: b, at: 60 mm, z: 30, facewidth: 20 mm }\n",
    );
    case.write("held.yaml", held);
    let said = case.gearloss(&["check", "held.yaml"]);
    assert!(
        said.code == Some(2) && said.text.contains("ports: ") && !said.text.contains("gear_states"),
        "{}",
        said.text
    );
}

/// A file that two others extend is reported once, and what is repeated is counted as such.
#[test]
fn errors_of_a_common_file_are_shown_once() {
    let case = Case::new("set_of_another_file", "common");
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    case.write("gearbox.yaml", gearbox.replace("z: 20,", "z: 20 mm,"));
    for name in ["first.yaml", "second.yaml"] {
        case.write(name, "gearloss: gearbox/1\nextends: gearbox.yaml\n");
    }
    let said = case.gearloss(&["check", "first.yaml", "second.yaml"]);
    assert_eq!(said.text.matches("error[").count(), 1, "{}", said.text);
    assert!(
        said.text
            .contains("1 error, 1 of them printed above: they are in a file that was read before"),
        "{}",
        said.text
    );
}

/// Titles with escape sequences, marks of direction and characters without width: a terminal does not obey them, and the report shows them.
#[test]
fn hidden_characters_of_titles_are_shown_as_escapes() {
    let case = Case::new("hidden-characters", "titles");
    case.gearloss(&["new", "gearbox", "single-stage", "-o", "template.yaml"]);
    let at = ["--torque", "20 Nm", "--speed", "1500 rpm"];
    let solve = [&["solve", "gearbox.yaml"], &at[..]].concat();
    for arguments in [
        &["check", "gearbox.yaml"][..],
        &["check", "--resolved", "gearbox.yaml"],
        &["check", "--resolved", "--format", "json", "gearbox.yaml"],
        &["check", "study.yaml"],
        &solve,
        &["run", "study.yaml", "-o", "results", "--verbose"],
    ] {
        let said = case.gearloss(arguments);
        assert_eq!(said.code, Some(0), "{arguments:?}: {}", said.text);
        assert_eq!(visible(&said.text), said.text, "{arguments:?}");
    }
    // Errors: names in messages and help, and the excerpt with its caret.
    let said = case.gearloss(&["check", "wrong.yaml"]);
    assert_eq!(said.code, Some(2), "{}", said.text);
    assert_eq!(visible(&said.text), said.text);
    for shown in [r"\u{1b}[31mgears", r"a\u{202e}b", r"# \u{200b}\u{202e} hidden"] {
        assert!(said.text.contains(shown), "{shown}: {}", said.text);
    }
    // What is printed as JSON or YAML has the same value as before.
    let said = case.gearloss(&["check", "--resolved", "--format", "json", "gearbox.yaml"]);
    let title = "Öl µ ≥ 2 °C \u{1b}[31m\u{1b}[2J \u{202e}esrever\u{202c} \u{9b}2J \u{200b}";
    let json: serde_json::Value = serde_json::from_str(&said.text).unwrap();
    assert_eq!(
        json.pointer("/files/0/resolved/title").and_then(|title| title.as_str()),
        Some(title)
    );
    let said = case.gearloss(&["check", "--resolved", "gearbox.yaml"]);
    case.write("resolved.yaml", &said.text);
    let again = case.gearloss(&["check", "--resolved", "--format", "json", "resolved.yaml"]);
    let json: serde_json::Value = serde_json::from_str(&again.text).unwrap();
    assert_eq!(
        json.pointer("/files/0/resolved/title").and_then(|title| title.as_str()),
        Some(title),
        "{}",
        said.text
    );
    // The files of the run; JSON is read by programs.
    let mut texts = 0;
    for entry in std::fs::read_dir(case.path("results")).unwrap().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if !name.ends_with(".json") && !name.ends_with(".xlsx") {
            let text = std::fs::read_to_string(entry.path()).unwrap();
            assert_eq!(visible(&text), text, "{name}");
            texts += 1;
        }
    }
    assert!(texts >= 3, "{texts}");
    let report = std::fs::read_to_string(case.path("results/report.html")).unwrap();
    for shown in [
        r"Größe \u{1b}]0;owned\u{7} \u{202e}esrever",
        r"Is \u{2066}this\u{2069} safe?",
        r"Map \u{9b}2J \u{202e}esrever",
    ] {
        assert!(report.contains(shown), "{shown}");
    }
}
