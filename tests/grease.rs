//! Grease in bearings and on gears: base oil, no level, churning, and what `check` says.

use crate::common::{RPM, language};
use gearloss_framework::codes;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_framework::testing::assert_close;
use gearloss_framework::transmission::Transmission;

/// An open pair of small spur gears in grease, with greased bearings.
const OPEN: &str = "
gearloss: gearbox/1
ports: { input: first, output: second }
shafts: { first: { axis: [0 mm, 0 mm] }, second: { axis: [48 mm, 0 mm] } }
gears:
  a: { shaft: first, at: 20 mm, z: 48, facewidth: 10 mm }
  b: { shaft: second, at: 20 mm, z: 48, facewidth: 10 mm }
meshes: { pair: { gears: [a, b], normal_module: 1 mm } }
surface: { ra: 1.6 um }
bearings:
  A1: { shaft: first, at: 0 mm, designation: \"6000\", axial: both, lubrication: grease }
  A2: { shaft: first, at: 40 mm, designation: \"6000\", lubrication: grease }
  B1: { shaft: second, at: 0 mm, designation: \"6000\", axial: both, lubrication: grease }
  B2: { shaft: second, at: 40 mm, designation: \"6000\", lubrication: grease }
lubricants:
  grease: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s }, grease: { consistency: \"2\" } }
models: { gear_mesh: { type: iso14179_2 }, bearing: { type: skf }, gear_drag: { churning: { type: mauz } } }
thermal: { mode: fixed, oil: 25 degC }
";

fn build(text: &str) -> Result<Transmission, String> {
    let language = language();
    let gearbox = Gearbox::of_text(&language, text, "input.yaml", ".").map_err(|found| found.render())?;
    gearbox
        .transmission(&language, &Choice::default())
        .map_err(|found| found.render())
}

fn built(text: &str) -> Transmission {
    build(text).unwrap_or_else(|found| panic!("{found}"))
}

/// Loss of a part in W at 500/min and 4 N m, without dependence of the flow on losses.
fn watts(t: &Transmission, part: &str) -> f64 {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[500.0 * RPM],
        torques: &[4.0],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[25.0], &mut scratch);
    let number = t.parts().iter().position(|p| p.path == part).unwrap();
    solution.parts().nth(number).unwrap().1.watts()
}

/// What is wrong with a text that is refused.
fn refused(text: &str) -> String {
    match build(text) {
        Ok(_) => panic!("it was accepted"),
        Err(found) => found,
    }
}

fn warnings(t: &Transmission) -> Vec<String> {
    t.warnings
        .iter()
        .map(|w| format!("{}: {}", w.path, w.message))
        .collect()
}

#[test]
fn an_open_greased_pair_is_solved_and_says_what_is_not_included() {
    let t = built(OPEN);
    assert_eq!(
        warnings(&t),
        ["gears.a: no law of the churning of grease is known: that of `a`, `b` is not included"]
    );
    assert_eq!(t.warnings[0].code, Some(codes::UNCOUNTED));
    assert!(watts(&t, "meshes.pair") > 0.0);
    assert_eq!(watts(&t, "gears.a.drag.churning"), 0.0);
}

/// The friction is that of the base oil: with the same oil, a mesh loses the same, and a bearing less than in a bath only by starvation and drag.
#[test]
fn models_take_the_base_oil() {
    let greased = built(OPEN);
    let oiled = built(
        &OPEN
            .replace(", grease: { consistency: \"2\" }", "")
            .replace(", lubrication: grease", ""),
    );
    assert!(oiled.warnings.is_empty());
    assert_eq!(watts(&greased, "meshes.pair"), watts(&oiled, "meshes.pair"));
    let (in_grease, in_oil) = (watts(&greased, "bearings.A1"), watts(&oiled, "bearings.A1"));
    assert!(in_grease < in_oil && in_grease > 0.5 * in_oil, "{in_grease} {in_oil}");
}

/// Churning multiplies the rolling moment of the catalogue and the load-independent moment of Palmgren's form, and nothing else.
#[test]
fn churning_is_a_factor_on_viscous_friction() {
    for model in ["skf", "iso14179_2", "harris", "schaeffler", "contact"] {
        let of = |churning: f64| {
            let bearing = format!("lubrication: grease, grease: {{ churning: {churning} }}");
            let text = OPEN
                .replace("bearing: { type: skf }", &format!("bearing: {{ type: {model} }}"))
                .replace("lubrication: grease", &bearing);
            watts(&built(&text), "bearings.A1")
        };
        let [one, two, four] = [1.0, 2.0, 4.0].map(of);
        let usual = OPEN.replace("bearing: { type: skf }", &format!("bearing: {{ type: {model} }}"));
        assert_eq!(one, watts(&built(&usual), "bearings.A1"), "{model}");
        assert!(two > one, "{model}");
        assert_close(four - two, 2.0 * (two - one), 1e-9);
    }
}

#[test]
fn grease_has_no_level() {
    let level = "\nhousing: { oil: { lubricant: grease, level: -20 mm } }";
    let found = refused(&format!("{OPEN}{level}"));
    assert!(found.contains("`grease` is a grease, which has no level"), "{found}");
    let found = refused(&OPEN.replace("z: 48, facewidth: 10 mm }", "z: 48, facewidth: 10 mm, level: -20 mm }"));
    assert!(found.contains("the lubricant of the gear is a grease"), "{found}");
    let found = refused(&OPEN.replacen(", lubrication: grease", ", lubrication: grease, oil_height: 3 mm", 1));
    assert!(found.contains("a greased bearing is in no oil"), "{found}");
    let found = refused(&OPEN.replacen(", lubrication: grease", "", 1));
    assert!(
        found.contains("`grease` is a grease, but `lubrication` is not"),
        "{found}"
    );
}

/// Beside an oil in the housing: what reaches greased parts, and what is greased with an oil.
#[test]
fn grease_beside_oil_is_checked() {
    let oil = "  sump: { viscosity: { kv40: 46 mm2/s, kv100: 7 mm2/s } }\nhousing: { oil: { lubricant: sump, level: -15 mm }, section: { area: 50 cm2, perimeter: 30 cm } }\nmodels";
    let text = OPEN
        .replace("models", oil)
        .replace(", gear_drag: { churning: { type: mauz } }", "");
    let said = warnings(&built(&text)).join("\n");
    assert!(
        said.contains(
            "bearings.A1.lubrication: the bearing is greased, but its lubricant `sump` is described as an oil"
        ),
        "{said}"
    );
    let text = text.replace("lubrication: grease", "lubrication: grease, lubricant: grease");
    let text = text.replace("facewidth: 10 mm }", "facewidth: 10 mm, lubricant: grease }");
    let said = warnings(&built(&text)).join("\n");
    assert!(
        said.contains(
            "gears.a.lubricant: the gear runs in grease, but the oil of the housing reaches 10.000 mm into it"
        ),
        "{said}"
    );
    assert!(
        said.contains("meshes.pair.lubricant: the teeth run in oil, but the lubricant of `a`, for its drag, is grease"),
        "{said}"
    );
    let deep = text.replace("level: -15 mm", "level: -9 mm");
    let said = warnings(&built(&deep)).join("\n");
    assert!(said.contains("mm into this greased bearing"), "{said}");
    let sealed = deep.replace("designation: \"6000\"", "designation: \"6000-2RSH\"");
    assert!(
        !warnings(&built(&sealed))
            .join("\n")
            .contains("mm into this greased bearing")
    );
}

#[test]
fn consistency_and_filling_are_checked() {
    let said = warnings(&built(&OPEN.replace("consistency: \"2\"", "consistency: \"00\""))).join("\n");
    assert!(
        said.contains("the consistency of `grease` is not one of those of rolling bearings"),
        "{said}"
    );
    let full = OPEN.replacen(
        "lubrication: grease",
        "lubrication: grease, grease: { filling: 0.8 }",
        1,
    );
    let said = warnings(&built(&full)).join("\n");
    assert!(
        said.contains("bearings.A1.grease.filling: a bearing filled by 80 % churns its grease unless it is slow"),
        "{said}"
    );
    let stated = full.replace("filling: 0.8", "filling: 0.8, churning: 1");
    assert_eq!(warnings(&built(&stated)).len(), 1);
}
