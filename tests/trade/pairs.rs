//! Opposed bearings with a contact angle: their axial loads, and what is reported of them.

use serde_json::Value;

use super::{Case, changed};

const POINT: [&str; 4] = ["--torque", "0 Nm", "--speed", "1500 rpm"];

/// What `solve` finds of the bearings.
fn bearings(case: &Case, text: &str, more: &[&str]) -> Vec<Value> {
    case.write("changed.yaml", text);
    let args = [&["solve", "changed.yaml", "--format", "json"], &POINT[..], more].concat();
    let said = case.gearloss(&args);
    assert_eq!(said.code, Some(0), "{}", said.text);
    let point: Value = serde_json::from_str(&said.text).unwrap();
    point["supports"].as_array().unwrap().clone()
}

fn numbers(bearings: &[Value], key: &str) -> Vec<f64> {
    bearings.iter().map(|bearing| bearing[key].as_f64().unwrap()).collect()
}

/// What `check` prints of a changed gearbox, and its exit code.
fn checked(case: &Case, text: &str) -> (Option<i32>, String) {
    case.write("changed.yaml", text);
    let said = case.gearloss(&["check", "changed.yaml"]);
    (said.code, said.text)
}

/// Radial loads, thrust, axial loads of the catalogues.
const SIX_CASES: [([u32; 2], i32, [f64; 2]); 6] = [
    ([3000, 2000], 500, [900.0, 1400.0]),
    ([2000, 3000], 500, [600.0, 1100.0]),
    ([2000, 3000], 200, [700.0, 900.0]),
    ([2000, 3000], -500, [1400.0, 900.0]),
    ([3000, 2000], -500, [1100.0, 600.0]),
    ([3000, 2000], -200, [900.0, 700.0]),
];

#[test]
fn the_six_cases_of_the_catalogues_are_the_default() {
    let case = Case::new("opposed-bearings", "cases");
    for ([at_a, at_b], thrust, axial) in SIX_CASES {
        let (first, second) = (format!("[{thrust} N, {at_a} N, 0 N]"), format!("[0 N, {at_b} N, 0 N]"));
        let text = changed(
            &case,
            &[("[500 N, 3000 N, 0 N]", &first), ("[0 N, 2000 N, 0 N]", &second)],
        );
        let found = bearings(&case, &text, &[]);
        for (found, printed) in numbers(&found, "axial_n").iter().zip(axial) {
            assert!((found - printed).abs() < 1e-6, "{found} {printed}");
        }
        let induced = axial[0].min(axial[1]);
        for found in numbers(&found, "induced_n") {
            assert!((found - induced).abs() < 1e-6, "{found} {induced}");
        }
    }
}

#[test]
fn stated_induced_thrust_replaces_the_default_of_its_bearing() {
    let case = Case::new("opposed-bearings", "stated");
    let text = changed(&case, &[]);
    let default = bearings(&case, &text, &[]);
    // The same ratio by a contact angle and by a statement: 1.25 tan(alpha) = 0.3.
    let by_angle = changed(
        &case,
        &[("y: 1.6666666666666667", "contact_angle: 13.495733280795811 deg")],
    );
    let stated = changed(&case, &[("y: 1.6666666666666667", "induced_thrust: 0.3")]);
    for other in [by_angle, stated] {
        let other = bearings(&case, &other, &[]);
        for (own, other) in numbers(&default, "axial_n").iter().zip(numbers(&other, "axial_n")) {
            assert!((own - other).abs() < 1e-9, "{own} {other}");
        }
    }
    // One override, and both.
    let one = bearings(&case, &text, &["--set", "bearings.A.induced_thrust=0.5"]);
    assert_eq!(numbers(&one, "axial_n"), [1500.0, 2000.0]);
    let none = changed(&case, &[("axial:", "induced_thrust: 0, axial:")]);
    let none = bearings(&case, &none, &[]);
    assert_eq!(numbers(&none, "axial_n"), [0.0, 500.0]);
    assert!(none.iter().all(|bearing| bearing["induced_n"].is_null()));
}

#[test]
fn a_pair_is_described_and_explained() {
    let case = Case::new("opposed-bearings", "described");
    let text = changed(&case, &[]);
    let (code, said) = checked(&case, &text);
    assert_eq!(code, Some(0), "{said}");
    let line =
        "pair A/B of a: face to face; induced thrust per radial load 0.3 (0.5/Y, Y = 1.6666666666666667, stated)";
    assert!(said.contains(line) && !said.contains("W0308"), "{said}");
    // The other way round, with data of the catalogue and of a designation.
    let plain = "kind: tapered_roller, bore: 30 mm, outside: 62 mm, y: 1.6666666666666667, axial: ";
    let turned = changed(
        &case,
        &[
            (&format!("{plain}left"), "designation: \"30206\", axial: right"),
            (
                &format!("{plain}right"),
                "designation: 7206 B, kind: angular_contact_ball, bore: 30 mm, outside: 62 mm, axial: left",
            ),
        ],
    );
    let (code, said) = checked(&case, &turned);
    assert_eq!(code, Some(0), "{said}");
    let line = "pair B/A of a: back to back; induced thrust per radial load B 0.88 (contact angle 40 deg, designation), \
                A 0.3125 (0.5/Y, Y = 1.6, catalogue 30206)";
    assert!(said.contains(line), "{said}");
    case.write(
        "changed.yaml",
        text.replace("bearing: none", "bearing: { type: constant, value: 0.001 }"),
    );
    let said = case.gearloss(&[&["explain", "changed.yaml", "B"], &POINT[..]].concat());
    for line in [
        "axial loads of the pair A/B of a, face to face, before load factors:",
        "r(A) = 0.3 (0.5/Y, Y = 1.6666666666666667, stated)",
        "Ka = 500 N, positive towards +x",
        "Fa(B) = max(S(B), S(A) + Ka) = ",
        "Fa(A) = Fa(B) - Ka = ",
        "of each of them induced: ",
    ] {
        assert!(said.text.contains(line), "{line}\n{}", said.text);
    }
}

#[test]
fn thrust_that_is_not_counted_is_reported_with_what_to_state() {
    let case = Case::new("opposed-bearings", "findings");
    let b = "kind: tapered_roller, bore: 30 mm, outside: 62 mm, y: 1.6666666666666667, axial: right";
    let findings: [(&[(&str, &str)], i32, &[&str]); 9] = [
        (
            &[
                ("axial: right", "axial: left, axial_share: 0.5"),
                ("axial: left }", "axial: left, axial_share: 0.5 }"),
            ],
            0,
            &[
                "warning[W0308]: bearings.A: the thrust that the radial load of `tapered_roller` induces is not in the loads: no bearing takes thrust of `a` towards +x",
                "write `axial: right` at the bearing that opposes it; or write `induced_thrust: 0` here",
            ],
        ),
        (
            &[(b, "designation: \"6206\", axial: right")],
            0,
            &[
                "W0308]: bearings.A: the thrust that the radial load of `tapered_roller` induces is not in the loads: `bearings.B` has no known induced thrust",
                "state `induced_thrust` there, 0 of a bearing without contact angle: then they are a pair",
            ],
        ),
        (
            &[
                (b, "designation: \"6206\", axial: both, axial_share: 1"),
                ("axial: left }", "axial: left, axial_share: 0 }"),
            ],
            0,
            &["W0308]: bearings.A: ", "`bearings.B` takes thrust in both directions"],
        ),
        (
            &[(", axial: right", "")],
            0,
            &[
                "W0308]: bearings.B: ",
                "the bearing has `axial: none`",
                "W0308]: bearings.A: ",
            ],
        ),
        (
            &[(b, "kind: tapered_roller, bore: 30 mm, outside: 62 mm, axial: right")],
            0,
            &[
                "W0308]: bearings.B: ",
                "neither its axial factor Y nor its contact angle is stated",
                "help: state `y` of its catalogue, `contact_angle`, or `induced_thrust`",
            ],
        ),
        (
            &[(
                b,
                "designation: 7206 C, kind: angular_contact_ball, bore: 30 mm, outside: 62 mm, axial: right",
            )],
            0,
            &[
                "W0308]: bearings.B: ",
                "contact angles from 20 to 40 deg",
                "help: state `induced_thrust`",
            ],
        ),
        (
            &[
                (b, "designation: \"6206\", axial: right"),
                ("axial: left }", "axial: left, induced_thrust: 0.4 }"),
            ],
            2,
            &[
                "error[E0308]: bearings.A.induced_thrust: this induced thrust loads no other bearing: `bearings.B` has no known induced thrust",
                "or remove `induced_thrust` here",
            ],
        ),
        (
            &[("axial: left }", "axial: none, induced_thrust: 0.4 }")],
            2,
            &[
                "E0308]: bearings.A.induced_thrust: ",
                "the bearing has no `axial: left` or `axial: right`",
            ],
        ),
        (
            &[
                ("axial: left }", "axial: left, spring_preload: 800 N }"),
                ("axial: right }", "axial: right, spring_preload: -800 N }"),
            ],
            2,
            &["E0308]: shafts.a: springs press several bearings of a pair: bearings.A, bearings.B"],
        ),
    ];
    for (changes, expected, words) in findings {
        let (code, said) = checked(&case, &changed(&case, changes));
        assert_eq!(code, Some(expected), "{changes:?}\n{said}");
        for words in words {
            assert!(said.contains(words), "{words}\n{said}");
        }
    }
}

#[test]
fn followed_help_makes_a_pair() {
    let case = Case::new("opposed-bearings", "helped");
    let b = "kind: tapered_roller, bore: 30 mm, outside: 62 mm, y: 1.6666666666666667, axial: right";
    // Of a deep groove ball bearing: it takes the thrust that A induces.
    let helped = changed(&case, &[(b, "designation: \"6206\", axial: right, induced_thrust: 0")]);
    assert!(!checked(&case, &helped).1.contains("W0308"));
    assert_eq!(numbers(&bearings(&case, &helped, &[]), "axial_n"), [900.0, 1400.0]);
    // Unknown data concern one bearing: the other one is not reported as well.
    let unknown = changed(
        &case,
        &[(b, "kind: tapered_roller, bore: 30 mm, outside: 62 mm, axial: right")],
    );
    assert!(!checked(&case, &unknown).1.contains("W0308]: bearings.A"));
}

#[test]
fn a_spring_alone_loads_its_ring_and_is_noted_where_it_is_too_weak() {
    let case = Case::new("opposed-bearings", "spring");
    let sprung = changed(&case, &[("axial: left }", "axial: left, spring_preload: 1000 N }")]);
    let (_, said) = checked(&case, &sprung);
    assert!(said.contains("; spring of 1000 N on A"), "{said}");
    let found = bearings(&case, &sprung, &[]);
    assert_eq!(numbers(&found, "axial_n"), [1000.0, 1500.0]);
    assert!(found.iter().all(|bearing| bearing["induced_n"].is_null()));
    let solve = |spring: &str, thrust: &str| {
        let text = sprung
            .replace("1000 N", spring)
            .replace("[500 N", &format!("[{thrust}"));
        case.write("changed.yaml", &text);
        case.gearloss(&[&["solve", "changed.yaml"], &POINT[..]].concat()).text
    };
    let (weak, enough) = (solve("800 N", "500 N"), solve("901 N", "500 N"));
    // 900 N are induced at A.
    assert!(
        weak.contains("outside: bearings.A: spring force less the thrust that the radial load induces Fs - r Fr -100 N is below 0 N"),
        "{weak}"
    );
    assert!(!enough.contains("less the thrust"), "{enough}");
    // 600 N are induced at B, which has 1000 - 500 N.
    let unloaded = solve("1000 N", "-500 N");
    assert!(
        unloaded.contains("outside: bearings.B: axial load less the thrust that the radial load induces Fs + Ka - r Fr -100 N is below 0 N"),
        "{unloaded}"
    );
    assert!(!unloaded.contains("spring force less"), "{unloaded}");
    // A ring that takes thrust towards -x can only push towards +x.
    let (code, said) = checked(&case, &sprung.replace("1000 N", "-1000 N"));
    assert_eq!(code, Some(2), "{said}");
    let error =
        "error[E0308]: bearings.A.spring_preload: the spring lifts this ring of a pair off its rolling elements";
    assert!(said.contains(error), "{said}");
}
