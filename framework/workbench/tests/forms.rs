//! Forms of new gearboxes.

use std::collections::BTreeMap;

use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_workbench::form::{FieldKind, LAYOUTS, Layout, forms, ratios, written};
use gearloss_workbench::store::Memory;
use serde_json::json;

use super::common::{first_point, language, session, value};

fn values(list: &[(&str, &str)]) -> BTreeMap<String, String> {
    let list = list.iter();
    list.map(|(path, value)| ((*path).to_owned(), (*value).to_owned()))
        .collect()
}

/// Without changes a form writes the template; with the values of the template typed again, too, except that they are not assumed.
#[test]
fn a_form_without_changes_is_its_template() {
    for layout in LAYOUTS {
        assert_eq!(
            written(&layout, &BTreeMap::new()).unwrap().text,
            layout.text,
            "{}",
            layout.name
        );
        let form = forms().into_iter().find(|form| form.name == layout.name).unwrap();
        let fields: Vec<_> = form.groups.iter().flat_map(|group| &group.fields).collect();
        assert!(fields.len() > 20, "{}: {} fields", layout.name, fields.len());
        let same: BTreeMap<String, String> = fields.iter().map(|f| (f.path.clone(), f.value.clone())).collect();
        assert_eq!(same.len(), fields.len(), "{}: a path occurs twice", layout.name);
        let (text, assumed) = (written(&layout, &same).unwrap().text, "\nassumed:");
        let before = |text: &str| text.split(assumed).next().unwrap().to_owned();
        assert_eq!(before(&text), before(layout.text), "{}", layout.name);
        let left = text.split(assumed).nth(1).unwrap();
        for field in fields {
            assert!(!left.contains(&field.path), "{}: {}", layout.name, field.path);
        }
        assert!(!left.contains("[gears") && !left.contains("bearings.B1"), "{left}");
    }
}

/// Every field has an effect, on what its path names.
#[test]
fn every_field_is_written() {
    for layout in LAYOUTS {
        let form = forms().into_iter().find(|form| form.name == layout.name).unwrap();
        for field in form.groups.iter().flat_map(|group| &group.fields) {
            let typed = match field.kind {
                FieldKind::Text if field.path == "title" => "Getriebe: \"neu\", #2".to_owned(),
                _ if field.example.is_some_and(|example| !example.is_empty()) => field.example.unwrap().to_owned(),
                FieldKind::Text | FieldKind::Number => "0.123".to_owned(),
                FieldKind::Integer => "33".to_owned(),
                FieldKind::Quantity => {
                    let (_, unit) = field.value.split_once(' ').unwrap();
                    format!("12.5 {unit}")
                }
                FieldKind::Bearing => "6213".to_owned(),
                FieldKind::Oil => "ISO VG 68 PAO".to_owned(),
                FieldKind::Material => "steel".to_owned(),
                FieldKind::Choice => field.choices[1].to_owned(),
            };
            let text = written(&layout, &values(&[(&field.path, &typed)])).unwrap().text;
            assert_ne!(text, layout.text, "{}: {}", layout.name, field.path);
            let gearbox = Gearbox::of_text(language(), &text, "gearbox.yaml", "").unwrap();
            if field.path == "title" {
                assert_eq!(gearbox.value["title"], "Getriebe: \"neu\", #2");
            }
            if field.kind == FieldKind::Bearing {
                let id = field.path.split('.').nth(1).unwrap();
                assert_eq!(gearbox.value["bearings"][id]["designation"], "6213");
            }
        }
    }
}

/// Details of bearings become keys: a hybrid bearing with known balls, a greased one, a plain one with its model.
#[test]
fn details_of_bearings_are_written() {
    let typed = [
        ("bearings.B1.internal.elements", "9"),
        ("bearings.B1.internal.diameter", "9.525 mm"),
        ("bearings.B1.internal.material", "silicon_nitride"),
        ("bearings.B1.internal.length", ""),
        ("bearings.B2.lubrication", "grease"),
        ("bearings.B2.grease.churning", "2.5"),
        ("bearings.B4.kind", "plain"),
        ("bearings.B4.bore", "40 mm"),
        ("bearings.B4.width", "30 mm"),
        ("bearings.B4.film.relative_clearance", "0.0015"),
        ("bearings.B4.film.least_thickness", "3 um"),
    ];
    let text = written(Layout::named("two-stage").unwrap(), &values(&typed))
        .unwrap()
        .text;
    let gearbox = Gearbox::of_text(language(), &text, "gearbox.yaml", "").unwrap();
    let bearings = &gearbox.value["bearings"];
    let internal = &bearings["B1"]["internal"];
    assert_eq!(
        (&internal["elements"], &internal["material"]),
        (&json!(9), &json!("silicon_nitride"))
    );
    assert!(internal.get("length").is_none());
    assert_eq!(bearings["B2"]["lubricant"], "grease");
    assert_eq!(bearings["B2"]["grease"]["churning"], 2.5);
    assert_eq!(gearbox.value["lubricants"]["grease"]["grease"]["consistency"], "2");
    assert_eq!(
        (&bearings["B4"]["kind"], &bearings["B4"]["model"]["type"]),
        (&json!("plain"), &json!("journal_film"))
    );
    assert!(bearings["B4"].get("designation").is_none());
    assert!(gearbox.transmission(language(), &Choice::default()).is_ok(), "{text}");
}

/// What was typed is not assumed; the other fields of the same component are.
#[test]
fn typed_values_are_not_assumed() {
    let typed = [
        ("gears.G1.z", "22"),
        ("bearings.B1.designation", "6207"),
        ("thermal.oil", "60 degC"),
    ];
    let text = written(Layout::named("two-stage").unwrap(), &values(&typed))
        .unwrap()
        .text;
    let gearbox = Gearbox::of_text(language(), &text, "gearbox.yaml", "").unwrap();
    let paths: Vec<&str> = gearbox.value["assumed"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|entry| entry["paths"].as_array().unwrap())
        .map(|path| path.as_str().unwrap())
        .collect();
    for (path, is_assumed) in [
        ("gears", false),
        ("gears.G1", false),
        ("gears.G1.z", false),
        ("gears.G1.facewidth", true),
        ("gears.G1.at", true),
        ("gears.G2", true),
        ("bearings.B1.designation", false),
        ("bearings.B1.at", true),
        ("bearings.B2", true),
        ("seals", true),
        ("thermal", false),
        ("meshes", true),
        ("shafts", true),
    ] {
        assert_eq!(paths.contains(&path), is_assumed, "{path}: {paths:?}");
    }
    let typed = [
        ("meshes.first.centre_distance", "91"),
        ("meshes.second.centre_distance", "118 mm"),
    ];
    let text = written(Layout::named("two-stage").unwrap(), &values(&typed))
        .unwrap()
        .text;
    assert!(text.contains("paths: [gears, meshes]"), "{text}");
}

/// A text stays a text, whatever it looks like.
#[test]
fn texts_that_look_like_numbers_are_quoted() {
    let typed = [("title", "2024"), ("lubricants.sump.designation", "220")];
    let text = written(Layout::named("two-stage").unwrap(), &values(&typed))
        .unwrap()
        .text;
    assert!(
        text.contains("title: \"2024\"") && text.contains("designation: \"220\""),
        "{text}"
    );
}

/// Centre distances move the axes.
#[test]
fn centre_distances_become_axes() {
    let axis = |layout: &str, typed: &[(&str, &str)], shaft: &str| {
        let text = written(Layout::named(layout).unwrap(), &values(typed)).unwrap().text;
        let gearbox = Gearbox::of_text(language(), &text, "gearbox.yaml", "").unwrap();
        let axis = &gearbox.value["shafts"][shaft]["axis"];
        [0, 1].map(|i| (axis[i].as_f64().unwrap() * 1e9).round() / 1e6)
    };
    let typed = [
        ("meshes.first.centre_distance", "95 mm"),
        ("meshes.second.centre_distance", "0.12 m"),
    ];
    assert_eq!(axis("two-stage", &typed, "input"), [215.0, 0.0]);
    assert_eq!(axis("two-stage", &typed, "intermediate"), [120.0, 0.0]);
    let typed = [("meshes.M1.centre_distance", "105 mm")];
    assert_eq!(axis("two-speed", &typed, "input"), [84.0, 63.0]);
    let typed = [("meshes.in_left.centre_distance", "110.1 mm")];
    assert_eq!(axis("dual-countershaft", &typed, "left"), [-110.1, 0.0]);
    assert_eq!(axis("dual-countershaft", &typed, "right"), [110.1, 0.0]);
}

/// A ring follows from its sun and planets, a centre distance from the teeth, until they are typed.
#[test]
fn what_is_not_typed_follows() {
    let form = |layout: &str, typed: &[(&str, &str)]| written(Layout::named(layout).unwrap(), &values(typed)).unwrap();
    // 1.5 mm (24 + 36) / 2 = 45 mm; the ring has 24 + 2 * 36 teeth and grows by 12 modules.
    let set = form("planetary", &[("gears.planets.z", "36")]);
    let expected = values(&[
        ("gears.ring.z", "96"),
        ("gears.ring.tip_diameter", "142 mm"),
        ("meshes.sun_planet.centre_distance", "45 mm"),
    ]);
    assert_eq!(set.followed, expected);
    let gearbox = Gearbox::of_text(language(), &set.text, "gearbox.yaml", "").unwrap();
    assert_eq!(gearbox.value["gears"]["ring"]["z"], 96);
    let ratio = &ratios(language(), &set.text)[0];
    assert!(ratio.gear == "reducing" && ratio.to == "output" && (ratio.ratio - 5.0).abs() < 1e-12);
    let typed = form("planetary", &[("gears.planets.z", "36"), ("gears.ring.z", "90")]);
    assert!(!typed.followed.contains_key("gears.ring.z"));
    let module = form("planetary", &[("meshes.sun_planet.normal_module", "3 mm")]);
    assert_eq!(module.followed["meshes.planet_ring.normal_module"], "3 mm");
    assert_eq!(module.followed["meshes.sun_planet.centre_distance"], "81 mm");
    assert_eq!(module.followed["gears.ring.tip_diameter"], "250 mm");
    // Twice the teeth of both gears are twice the distance; what does not decide it changes nothing.
    let stage = form(
        "two-stage",
        &[
            ("gears.G1.z", "42"),
            ("gears.G2.z", "152"),
            ("gears.G1.facewidth", "30 mm"),
        ],
    );
    assert_eq!(stage.followed, values(&[("meshes.first.centre_distance", "182 mm")]));
    assert!(form("two-stage", &[("title", "new")]).followed.is_empty());
    // What cannot be read is a finding of the text, not a distance.
    assert!(form("two-stage", &[("gears.G1.z", "many")]).followed.is_empty());
}

/// On axes that cross a centre distance or an offset is a coordinate of an axis, too.
#[test]
fn distances_and_offsets_place_axes_that_cross() {
    let form = |layout: &str, typed: &[(&str, &str)]| {
        let written = written(Layout::named(layout).unwrap(), &values(typed)).unwrap();
        let gearbox = Gearbox::of_text(language(), &written.text, "gearbox.yaml", "").unwrap();
        let built = gearbox.transmission(language(), &Choice::default());
        assert!(built.is_ok(), "{layout}: {:?}", built.err());
        written
    };
    let worm = form("worm", &[("gears.wheel.z", "51")]);
    assert_eq!(
        worm.followed,
        values(&[("worm_meshes.stage.centre_distance", "120 mm")])
    );
    assert!(worm.text.contains("through: [0 mm, 0 mm, 120 mm]"), "{}", worm.text);
    let axle = form("axle", &[("bevel_meshes.final.offset", "20 mm")]);
    assert!(axle.text.contains("offset: 20 mm "), "{}", axle.text);
    assert_eq!(
        axle.text.matches("through: [0 mm, 0 mm, 20 mm]").count(),
        3,
        "{}",
        axle.text
    );
    let reducer = form("bevel-helical", &[("meshes.helical.centre_distance", "124 mm")]);
    for place in ["axis: [124 mm, 0 mm]", "through: [30 mm, 124 mm, 0 mm]"] {
        assert!(reducer.text.contains(place), "{place}: {}", reducer.text);
    }
}

/// With a heat balance every layout finds its oil temperature.
#[test]
fn a_form_with_a_heat_balance_is_solved() {
    for layout in LAYOUTS {
        let text = written(&layout, &values(&[("thermal.mode", "balance")])).unwrap().text;
        let session = session(Memory::new("new", []));
        let answer = value(
            &session,
            first_point(&session, &json!({ "new.yaml": text }), "new.yaml"),
        );
        assert!(answer["efficiency"].as_f64().is_some(), "{}: {answer}", layout.name);
    }
}

/// The two countershafts have the same data.
#[test]
fn twins_are_written_together() {
    let typed = [
        ("gears.left_wheel.z", "46"),
        ("bearings.L1.designation", "6309"),
        ("meshes.left_out.normal_module", "3.1 mm"),
    ];
    let text = written(Layout::named("dual-countershaft").unwrap(), &values(&typed))
        .unwrap()
        .text;
    let gearbox = Gearbox::of_text(language(), &text, "gearbox.yaml", "").unwrap();
    assert_eq!(gearbox.value["gears"]["right_wheel"]["z"], 46);
    assert_eq!(gearbox.value["bearings"]["R1"]["designation"], "6309");
    assert_eq!(
        gearbox.value["meshes"]["right_out"],
        gearbox.value["meshes"]["right_out"]
    );
    assert_eq!(
        gearbox.value["meshes"]["left_out"]["normal_module"],
        gearbox.value["meshes"]["right_out"]["normal_module"]
    );
}

/// A field that is wrong is named.
#[test]
fn wrong_values_name_their_field() {
    let layout = Layout::named("two-stage").unwrap();
    for (path, typed, message) in [
        ("gears.G1.z", " ", "missing"),
        ("gears.G9.z", "20", "no such field"),
        ("title", "one\ntwo", "lines"),
        ("meshes.first.centre_distance", "ten mm", "ten"),
        ("meshes.first.centre_distance", "-3 mm", "distance"),
        ("meshes.first.centre_distance", "3 kg", "kg"),
    ] {
        let fault = written(layout, &values(&[(path, typed)])).unwrap_err();
        assert_eq!(fault.findings[0].path, path);
        assert!(fault.message.contains(message), "{}", fault.message);
        assert!(fault.help.is_some(), "{path}");
    }
}

/// From a form to a study that has no findings, for every layout.
#[test]
fn a_new_gearbox_has_a_study() {
    for layout in LAYOUTS {
        let session = session(Memory::new("new", []));
        let mut texts = json!({ "new.yaml": layout.text });
        let study = value(
            &session,
            json!({ "request": "new_study", "texts": texts, "gearbox": "new.yaml" }),
        );
        texts["study.yaml"] = study["text"].clone();
        let edit = json!({ "request": "findings", "file": "study.yaml" });
        let found = value(&session, json!({ "request": "edit", "texts": texts, "edit": edit }));
        let errors = found["value"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|finding| finding["severity"] == "error");
        assert_eq!(errors.count(), 0, "{}: {found}", layout.name);
    }
}

/// From a form to a solved point, for every layout.
#[test]
fn a_new_gearbox_is_solved() {
    for layout in LAYOUTS {
        let session = session(Memory::new("new", []));
        let text = value(
            &session,
            json!({ "request": "new", "layout": layout.name, "values": {} }),
        );
        let texts = json!({ "new.yaml": text["text"] });
        let answer = value(&session, first_point(&session, &texts, "new.yaml"));
        let efficiency = answer["efficiency"].as_f64().unwrap();
        // Threads slide.
        let least = if layout.name == "worm" { 0.8 } else { 0.9 };
        assert!((least..1.0).contains(&efficiency), "{}: {efficiency}", layout.name);
        let gearbox = Gearbox::of_text(language(), layout.text, "gearbox.yaml", "").unwrap();
        gearbox.resolve(language(), &Choice::default()).unwrap();
    }
}
