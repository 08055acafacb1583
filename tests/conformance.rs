//! Every linked model owes the same to the framework; registries that cannot work are refused.

use crate::common;
use gearloss_framework::conformance::check_all;
use gearloss_framework::language::Language;
use gearloss_framework::mechanism::Mechanism;
use gearloss_framework::mechanism::seal::Seal;
use gearloss_framework::registry::{Catalogue, Check, Entry, MechanismEntry, Package, Registry, ShippedSet, inventory};
use gearloss_report::models::ChecksText;

#[test]
fn all_models_conform() {
    let faults = check_all(&common::language());
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Tests of each value are in `plugins/tests/checks.rs`.
#[test]
fn a_wrong_check_value_is_printed_as_such() {
    let language = common::language();
    let entry = language.registry().model(Seal::KEY, "linke").unwrap();
    for (values, word, counts) in [
        (
            &[("total", "36.9120 W"), ("moment", "0.1 Nm")],
            "outside",
            "2, faults: 1",
        ),
        (
            &[("total", "36.9120 W"), ("totla", "36.9 W")],
            "fault: `totla`",
            "0, faults: 1",
        ),
    ] {
        let checks = vec![Check {
            values,
            ..entry.checks[0]
        }]
        .leak();
        let mut text = ChecksText::default();
        text.model(&language, &Entry { checks, ..*entry });
        let (text, hold) = text.finish();
        assert!(!hold && text.contains(word), "{text}");
        assert!(text.ends_with(&format!("check values: {counts}\n")), "{text}");
    }
}

fn linked() -> (Vec<MechanismEntry>, Vec<Entry>) {
    let _ = common::language();
    (
        inventory::iter::<MechanismEntry>().copied().collect(),
        inventory::iter::<Entry>().copied().collect(),
    )
}

fn refused(mechanisms: Vec<MechanismEntry>, models: Vec<Entry>) -> String {
    let faults = Registry::from_entries(mechanisms, models, [], []).err().unwrap();
    faults
        .iter()
        .map(|f| format!("{f} {}", f.notes.join(" ")))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn an_empty_registry_says_what_to_link() {
    let text = refused(linked().0, Vec::new());
    assert!(
        text.contains("no loss model is linked") && text.contains("use gearloss_plugins as _;"),
        "{text}"
    );
}

#[test]
fn two_models_of_one_name_name_both_places() {
    let (mechanisms, mut models) = linked();
    let mut copy = *models
        .iter()
        .find(|m| m.name == "iso14179_2" && m.mechanism == Seal::KEY)
        .unwrap();
    copy.origin.package = Package {
        name: "my-models",
        version: "2.1.0",
    };
    copy.origin.file = "src/seal.rs";
    models.push(copy);
    let text = refused(mechanisms, models);
    assert!(
        text.contains("two registrations of the seal model `iso14179_2`"),
        "{text}"
    );
    assert!(
        text.contains("my-models 2.1.0, src/seal.rs") && text.contains("plugins/src/seal/iso14179_2.rs"),
        "{text}"
    );
}

#[test]
fn two_sets_of_one_name_and_two_rows_of_one_designation_are_reported() {
    let (mechanisms, models) = linked();
    let set = *inventory::iter::<ShippedSet>().next().unwrap();
    let found = Registry::from_entries(mechanisms.clone(), models.clone(), [], [set, set])
        .err()
        .unwrap();
    assert!(
        found[0].message.contains("two registrations of the model set"),
        "{found:?}"
    );
    let bearings = *inventory::iter::<Catalogue>()
        .find(|c| c.section == "bearings")
        .unwrap();
    let registry = Registry::from_entries(mechanisms, models, [bearings, bearings], []).unwrap();
    let found = Language::new(registry).err().unwrap();
    assert!(
        found[0].message.contains("two catalogues of bearings have a row"),
        "{found:?}"
    );
}

#[test]
fn the_order_of_registration_changes_nothing() {
    let (mut mechanisms, mut models) = linked();
    let schema = |m: Vec<MechanismEntry>, e: Vec<Entry>| {
        let language =
            Language::new(Registry::from_entries(m, e, [], []).unwrap()).unwrap_or_else(|f| panic!("{f:#?}"));
        language.published(gearloss_framework::language::Kind::Gearbox)
    };
    let one = schema(mechanisms.clone(), models.clone());
    mechanisms.reverse();
    models.reverse();
    assert_eq!(one, schema(mechanisms, models));
}

#[test]
fn the_framework_names_no_concrete_model() {
    let names = [
        "iso14179",
        "changenet",
        "path_integral",
        "cone_gap",
        "ring_gap",
        "skf::",
        "\"skf\"",
        "\"xu\"",
    ];
    let mut folders = vec![common::file("framework")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                // The import of REXS and new documents write gearboxes and studies, which choose models; tests of the editor and of the
                // workbench have some.
                let chooses = [
                    "framework/exchange",
                    "framework/editor/tests",
                    "workbench/src/form",
                    "workbench/tests",
                ];
                if !chooses.iter().any(|folder| path.ends_with(folder)) {
                    folders.push(path);
                }
            } else if path.extension().is_some_and(|kind| kind == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                for name in names {
                    assert!(!text.contains(name), "{} names {name}", path.display());
                }
            }
        }
    }
}
