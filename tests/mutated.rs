//! Whatever text stands in a file: no panic, no number that is not finite, and an end.

use crate::common;
use std::sync::LazyLock;

use gearloss_framework::document::read_yaml;
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use proptest::prelude::*;

static LANGUAGE: LazyLock<Language> = LazyLock::new(common::language);
static TEXTS: LazyLock<Vec<String>> = LazyLock::new(|| {
    ["tests/cases/fine/input.yaml", "examples/two-speed-ev/gearbox.yaml"]
        .iter()
        .map(|path| std::fs::read_to_string(common::file(path)).unwrap())
        .collect()
});

/// Reads, builds and evaluates a text as far as it goes.
fn try_all(text: &str) {
    let gearbox = match Gearbox::of_text(&LANGUAGE, text, "mutant.yaml", "tests/cases/fine") {
        Ok(gearbox) => gearbox,
        Err(findings) => {
            assert!(!findings.list.is_empty());
            let _ = findings.render();
            return;
        }
    };
    let t = match gearbox.transmission(&LANGUAGE, &Choice::default()) {
        Ok(t) => t,
        Err(findings) => {
            assert!(!findings.list.is_empty());
            let _ = findings.render();
            return;
        }
    };
    for state in 0..t.states().len() {
        let name = t.states()[state].name.clone();
        let speeds: Vec<f64> = (0..t.states()[state].speed_ports.len())
            .map(|i| 300.0 / (1.0 + i as f64))
            .collect();
        let ports: Vec<&str> = t
            .ports()
            .iter()
            .take(t.torques_needed(state))
            .map(|p| p.name.as_str())
            .collect();
        let Ok(case) = t.case(&name, &[], &ports) else { continue };
        let mut scratch = t.scratch(&case);
        let torques = vec![7.0; case.torque_ports.len()];
        let point = Point {
            speeds: &speeds,
            torques: &torques,
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
        for value in [solution.loss(), solution.efficiency(), solution.loss_torque()]
            .into_iter()
            .flatten()
        {
            assert!(value.is_finite() && value >= 0.0, "{value}\n{text}");
        }
        if let Some(efficiency) = solution.efficiency() {
            assert!(efficiency <= 1.0);
        }
    }
}

/// A change of a text: where it begins (share of its length), how many characters it takes, and what it puts there.
fn change() -> impl Strategy<Value = (f64, usize, String)> {
    let piece = prop_oneof![
        "[-0-9.,eE ]{0,6}",
        "[a-z_]{0,8}",
        Just("{".to_owned()),
        Just("]".to_owned()),
        Just(": ".to_owned()),
        Just("\n  ".to_owned()),
        Just("1e308 mm".to_owned()),
        Just("0 mm".to_owned()),
        Just("-1".to_owned()),
        Just("&a *a".to_owned()),
        Just("none".to_owned()),
        Just("\u{fffd}é".to_owned()),
    ];
    (0.0..1.0_f64, 0..12_usize, piece)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]
    #[test]
    fn a_mutated_gearbox_never_panics(which in 0..2_usize, changes in proptest::collection::vec(change(), 1..4)) {
        let mut letters: Vec<char> = TEXTS[which].chars().collect();
        for (at, length, piece) in changes {
            let start = (at * letters.len() as f64) as usize;
            let end = (start + length).min(letters.len());
            letters.splice(start..end, piece.chars());
        }
        try_all(&letters.into_iter().collect::<String>());
    }

    #[test]
    fn numbers_of_any_size_never_make_a_result_that_is_not_finite(
        which in 0..2_usize, place in any::<prop::sample::Index>(), number in prop_oneof![
            Just(0.0), Just(-1.0), Just(1e-9), Just(1e9), 1e-3..1e3_f64,
        ],
    ) {
        // Replaces the number of one quantity; its unit stays.
        let text = &TEXTS[which];
        let starts: Vec<usize> = text
            .char_indices()
            .filter(|(i, c)| c.is_ascii_digit() && text[..*i].ends_with([' ', '[', '-']))
            .map(|(i, _)| i)
            .collect();
        let start = starts[place.index(starts.len())];
        let length = text[start..].find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(1);
        try_all(&format!("{}{number}{}", &text[..start], &text[start + length..]));
    }

    #[test]
    fn any_text_is_read_to_an_end(text in "\\PC{0,300}") {
        let read = read_yaml(0, &text);
        let _ = LANGUAGE.walk_gearbox(&read.node);
    }
}

#[test]
fn bombs_are_refused_quickly() {
    let deep = "a: ".to_owned() + &"[".repeat(100_000);
    let wide = format!("gearloss: gearbox/1\nshafts: {{ {} }}\n", "s: 1, ".repeat(20_000));
    let alias = "a: &a [1,1]\nb: &b [*a,*a]\nc: &c [*b,*b]\nd: [*c,*c]\n";
    for text in [deep.as_str(), wide.as_str(), alias, &"#".repeat(5 << 20)] {
        let findings = Gearbox::of_text(&LANGUAGE, text, "bomb.yaml", ".").err().unwrap();
        assert!(!findings.list.is_empty() && findings.render().len() < 1_000_000);
    }
}
