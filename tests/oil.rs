//! Where the oil is: levels from volumes, the level that each law takes, and the band of the level while rotating.

use crate::common::{file, language};
use gearloss::api::{Choice, Gearbox, InMemory, Language};
use gearloss::studies::checked::CheckedGearbox;
use gearloss_framework::codes;
use gearloss_framework::evaluate::{LevelFrom, OilLevels, Point, Solution};
use gearloss_framework::transmission::Transmission;
use proptest::prelude::*;
use std::path::Path;

/// The two-speed example with another description of its oil, bearings without oil heights of their own, and a churning law.
fn built(language: &Language, oil: &str, churning: &str) -> Transmission {
    let text = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let text = text
        .replace("volume: 1.2 l, level: -49 mm", oil)
        .replace("{ type: iso14179_2, speed_of: pinion }", churning)
        .replace("  bearing: { type: iso14179_2 }", "  bearing: { type: skf }")
        .replace(", oil_height: 14 mm", "");
    let files = InMemory::default().shared();
    let gearbox = Gearbox::from_text(language, &files, &text, "gearbox.yaml", Path::new(""));
    let gearbox = gearbox.unwrap_or_else(|found| panic!("{}", found.render()));
    gearbox
        .transmission(language, &Choice::default())
        .unwrap_or_else(|found| panic!("{}", found.render()))
}

/// Levels, churning and bearing losses in first gear at a speed in rpm and an oil temperature in degC.
fn at(t: &Transmission, speed: f64, temperature: f64) -> (Option<OilLevels>, f64, f64) {
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * std::f64::consts::PI / 30.0],
        torques: &[10.0],
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[temperature], &mut scratch);
    let sum = |mechanism: &str| {
        let parts = solution.parts().filter(|(part, _)| part.mechanism == mechanism);
        parts.map(|(_, loss)| loss.watts()).sum::<f64>()
    };
    (solution.oil_levels(), sum("gear_drag"), sum("bearing"))
}

const LYON: &str = "{ type: changenet_2011 }";

#[test]
fn churning_takes_the_level_at_rest_and_bearings_the_one_while_rotating() {
    let language = language();
    let with = |running: &str| {
        let oil = format!("volume: 1.2 l, level: 5 mm{running}");
        at(&built(&language, &oil, LYON), 6000.0, 80.0)
    };
    let (still, low, high) = (
        with(", running_level: at_rest"),
        with(", running_level: -15 mm"),
        with(", running_level: 0 mm"),
    );
    assert_eq!(
        (still.1.to_bits(), low.1.to_bits()),
        (high.1.to_bits(), high.1.to_bits())
    );
    assert!(low.2 < high.2 && high.2 < still.2, "{} {} {}", low.2, high.2, still.2);
    let levels = low.0.unwrap();
    assert_eq!(
        (levels.from, levels.at_rest, levels.running),
        (LevelFrom::Stated, 0.005, -0.015)
    );
    // The estimate is lower than at rest, and is used by default.
    let estimated = with("");
    let levels = estimated.0.unwrap();
    assert_eq!(levels.from, LevelFrom::Estimated);
    assert!(levels.running < levels.at_rest && estimated.2 < still.2);
    // Without a churning law nothing is lifted.
    let (levels, ..) = at(&built(&language, "volume: 1.2 l, level: 5 mm", "none"), 6000.0, 80.0);
    let levels = levels.unwrap();
    assert_eq!(levels.running.to_bits(), levels.at_rest.to_bits());
}

#[test]
fn volume_and_level_follow_from_each_other() {
    let language = language();
    let filled = built(&language, "volume: 1.2 l", LYON);
    // An independent calculation: the hull of circles of 128 chords, 8 mm around the gears and 12 mm beside them, and halving.
    let (cold, ..) = at(&filled, 0.0, 20.0);
    let cold = cold.unwrap();
    assert!((cold.at_rest + 31.832606458278e-3).abs() < 1e-12, "{cold:?}");
    let estimate = cold.estimate.unwrap();
    assert!((estimate.volume - 1.2e-3).abs() < 1e-15 && !estimate.drawn);
    assert!(
        (estimate.band.low() - cold.at_rest).abs() < 1e-15,
        "at standstill nothing falls: {estimate:?}"
    );
    let (hot, ..) = at(&filled, 0.0, 100.0);
    assert!(hot.unwrap().at_rest > cold.at_rest + 1e-3);
    assert_eq!(cold.running.to_bits(), cold.at_rest.to_bits());
    let level = format!("level: {} mm", cold.at_rest * 1e3);
    let (same, ..) = at(&built(&language, &level, LYON), 0.0, 100.0);
    assert!((same.unwrap().estimate.unwrap().volume - 1.2e-3).abs() < 1e-12);
    // What is in the circuit is not in the sump, and a dry sump has no level.
    let (less, ..) = at(
        &built(&language, "volume: 1.5 l, circuit_volume: 0.3 l", LYON),
        0.0,
        20.0,
    );
    assert!((less.unwrap().at_rest - cold.at_rest).abs() < 1e-12);
    assert!(
        at(&built(&language, "volume: 1.2 l, dry_sump: true", LYON), 6000.0, 80.0)
            .0
            .is_none()
    );
}

#[test]
fn oil_is_neither_lost_nor_made() {
    let language = language();
    let filled = built(&language, "volume: 1.2 l", LYON);
    let space = filled.oil_space().unwrap().space();
    for (speed, temperature) in [(1000.0, 0.0), (6000.0, 40.0), (12000.0, 80.0), (20000.0, 120.0)] {
        let levels = at(&filled, speed, temperature).0.unwrap();
        let estimate = levels.estimate.unwrap();
        let kept = space.volume(levels.running)[0] + estimate.missing;
        assert!((kept / estimate.volume - 1.0).abs() < 1e-11, "{speed} {levels:?}");
        assert!(estimate.band.low() <= levels.running && levels.running <= estimate.band.high());
    }
}

#[test]
fn the_band_is_an_input() {
    let language = language();
    let with = |place: &str| {
        let t = built(&language, &format!("volume: 1.9 l, running_band: {place}"), LYON);
        let (levels, _, bearings) = at(&t, 8000.0, 60.0);
        (levels.unwrap(), bearings)
    };
    let (low, middle, high) = (with("-1"), with("0"), with("1"));
    let band = middle.0.estimate.unwrap().band;
    assert_eq!(low.0.running, band.low());
    assert_eq!(high.0.running, band.high());
    // Where full tooth spaces bound all film estimates, the usual one is an end of the band.
    assert!(low.0.running <= middle.0.running && middle.0.running <= high.0.running);
    assert!(low.1 <= middle.1 && middle.1 <= high.1);
    assert!(low.0.running < high.0.running && low.1 < high.1, "{low:?} {high:?}");
}

/// Path and message of the warnings of a gearbox about its oil.
fn doubts(text: &str) -> Vec<(String, String)> {
    let (language, files) = (language(), InMemory::default().shared());
    let gearbox = Gearbox::from_text(&language, &files, text, "slow.yaml", Path::new(""));
    let gearbox = gearbox.unwrap_or_else(|found| panic!("{}", found.render()));
    let resolved = gearbox.resolve(&language, &Choice::default()).unwrap();
    let checked = CheckedGearbox::new(&language, gearbox, resolved);
    let checked = checked.unwrap_or_else(|found| panic!("{}", found.render()));
    let warnings = checked.warnings().into_iter();
    let of_oil = warnings.filter(|found| {
        [codes::OIL_LEVEL, codes::STATED_OVER_DRAWING]
            .map(Some)
            .contains(&found.code)
    });
    of_oil.map(|found| (found.path, found.message)).collect()
}

#[test]
fn bearings_that_no_oil_reaches_are_named() {
    let slow = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let check = |speed: &str| doubts(&slow.replace("100 rpm", speed));
    let found = check("100 rpm");
    let paths: Vec<&str> = found.iter().map(|(path, _)| path.as_str()).collect();
    assert_eq!(paths, ["bearings.left_in", "bearings.right_in", "bearings.left_out"]);
    assert!(
        found[0]
            .1
            .contains("the level is -38 mm, and the fastest gear in the oil has 0.2199 m/s of the 3 m/s"),
        "{}",
        found[0].1
    );
    // The wheel splashes.
    assert!(check("1500 rpm").is_empty());
}

/// Behind a wall only a pocket supplies a bearing, however fast gears splash.
#[test]
fn a_bearing_behind_a_wall_needs_a_pocket_with_oil() {
    let slow = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let with = |keys: &str| {
        let bearing = format!("at: 60 mm, designation: \"6205\", {keys} }}");
        doubts(
            &slow
                .replace("100 rpm", "1500 rpm")
                .replace("at: 60 mm, designation: \"6205\" }", &bearing),
        )
    };
    let found = with("fed: false");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "bearings.right_in");
    assert!(
        found[0].1.contains("`fed: false` keeps the oil of the sump at -"),
        "{found:?}"
    );
    assert!(found[0].1.ends_with("it has no pocket"), "{found:?}");
    let pocket = "fed: false, pocket: { edge: 5 mm, edge_radius: 15 mm, catch: { width: 20 mm } }";
    assert_eq!(with(pocket), []);
    // Ribs catch nothing while the gears are too slow to throw oil.
    let found = doubts(&slow.replace(
        "at: 60 mm, designation: \"6205\" }",
        &format!("at: 60 mm, designation: \"6205\", {pocket} }}"),
    ));
    let own = found
        .iter()
        .find(|(path, message)| path == "bearings.right_in" && message.contains("pocket"));
    assert!(
        own.is_some_and(|(_, message)| message.ends_with("0 l/min flow into its pocket at the rated speed")),
        "{found:?}"
    );
}

/// Grade and acceleration of a cycle incline the oil as the `grade` or `bank` of a gearbox that stands inclined.
#[test]
fn a_cycle_inclines_the_oil_as_a_stated_grade_does() {
    let language = language();
    let with = |keys: &str| {
        let text = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
        let text = text
            .replace("volume: 1.2 l, level: -49 mm", "volume: 1.9 l")
            .replace("  section: { area", &format!("  {keys}\n  section: {{ area"))
            .replace("{ type: iso14179_2, speed_of: pinion }", LYON)
            .replace("  bearing: { type: iso14179_2 }", "  bearing: { type: skf }")
            .replace(", oil_height: 14 mm", "");
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, &text, "gearbox.yaml", Path::new("")).unwrap();
        let t = gearbox.transmission(&language, &Choice::default());
        t.unwrap_or_else(|found| panic!("{}", found.render()))
    };
    let solved = |t: &Transmission, degrees: f64| {
        let case = t.case("first", &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[8000.0 * std::f64::consts::PI / 30.0],
            torques: &[10.0],
            inclination: f64::to_radians(degrees),
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[60.0], &mut scratch);
        let sum = |mechanism: &str| {
            let parts = solution.parts().filter(|(part, _)| part.mechanism == mechanism);
            parts.map(|(_, loss)| loss.watts()).sum::<f64>()
        };
        (solution.oil_levels().unwrap(), sum("gear_drag"), sum("bearing"))
    };
    let level = solved(&with(""), 0.0);
    for (travel, stated, sign) in [
        ("+x", "grade", 1.0),
        ("-x", "grade", -1.0),
        ("+y", "bank", 1.0),
        ("-y", "bank", -1.0),
    ] {
        let travels = with(&format!("travel: \"{travel}\""));
        // A level road changes nothing, to the bit.
        let same = solved(&travels, 0.0);
        assert_eq!(same.0.at_rest.to_bits(), level.0.at_rest.to_bits());
        assert_eq!([same.1, same.2].map(f64::to_bits), [level.1, level.2].map(f64::to_bits));
        for degrees in [10.0, -6.0, 7.3] {
            let (own, churning, bearings) = solved(&travels, degrees);
            let (of_stated, stated_churning, stated_bearings) =
                solved(&with(&format!("{stated}: {} deg", sign * degrees)), 0.0);
            // Whole degrees are exact.
            let near = if f64::round(degrees) == degrees { 1e-11 } else { 5e-6 };
            assert!(
                (own.at_rest - of_stated.at_rest).abs() < near,
                "{travel} {degrees}: {own:?} {of_stated:?}"
            );
            assert!(
                (churning / stated_churning - 1.0).abs() < 300.0 * near,
                "{travel} {degrees}: {churning} {stated_churning}"
            );
            assert!(
                (own.running - of_stated.running).abs() < 4.0 * near,
                "{travel} {degrees}: {own:?} {of_stated:?}"
            );
            assert!(
                (bearings / stated_bearings - 1.0).abs() < 1000.0 * near,
                "{travel} {degrees}: {bearings} {stated_bearings}"
            );
            assert!((own.estimate.unwrap().volume / level.0.estimate.unwrap().volume - 1.0).abs() < 1e-9);
        }
    }
    // Without a direction of travel a point is not inclined.
    assert_eq!(solved(&with(""), 20.0).1.to_bits(), level.1.to_bits());
}

/// A gear throws oil through a window in front of a bearing; the share is that of the flight, and the flow that of the estimate.
#[test]
fn gears_throw_oil_through_windows() {
    let language = language();
    let slow = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let text = |window: &str| {
        let pocket = format!(
            "at: 60 mm, designation: \"6205\", fed: false, pocket: {{ edge: 5 mm, edge_radius: 15 mm, window: {{ gear: wheel, {window} }} }} }}"
        );
        slow.replace("at: 60 mm, designation: \"6205\" }", &pocket)
            .replace("100 rpm", "3000 rpm")
    };
    let solved = |window: &str, speed: f64| {
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, &text(window), "slow.yaml", Path::new("")).unwrap();
        let t = gearbox.transmission(&language, &Choice::default());
        let t = t.unwrap_or_else(|found| panic!("{}", found.render()));
        let case = t.case(&t.states()[0].name, &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[speed * std::f64::consts::PI / 30.0],
            torques: &[10.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let pocket = solution.pockets().next().unwrap();
        let lifted = solution.oil_levels().unwrap().estimate.unwrap().lifted;
        (pocket.window.unwrap(), pocket.inflow, pocket.height, lifted)
    };
    // The wheel turns against the pinion: its lowest point moves away from it for one sense and towards it for the other.
    let wide = |y: &str| format!("y: {y} mm, bottom: -60 mm, top: 400 mm, from: -100 mm, to: 160 mm");
    let (own, inflow, height, lifted) = solved(&wide("-20"), 3000.0);
    let (other, nothing, ..) = solved(&wide("140"), 3000.0);
    let (back, ..) = solved(&wide("140"), -3000.0);
    assert!(own.share > 0.5 || other.share > 0.5, "{own:?} {other:?}");
    let hit = if own.share > other.share {
        (own, inflow, height)
    } else {
        (other, nothing, 0.0)
    };
    assert!(
        hit.0.flow <= lifted * (1.0 + 1e-12) && hit.0.flow == hit.1,
        "{hit:?} {lifted}"
    );
    assert_eq!(own.share.min(other.share), 0.0);
    assert!((back.share > 0.0) != (other.share > 0.0));
    // Below the speed at which gears throw oil there is none.
    assert_eq!(solved(&wide("-20"), 100.0).0.flow, 0.0);
    assert_eq!(solved(&wide("140"), 100.0).0.flow, 0.0);
    // A window high above is missed.
    let checked = |window: &str| {
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, &text(window), "slow.yaml", Path::new("")).unwrap();
        let resolved = gearbox.resolve(&language, &Choice::default()).unwrap();
        CheckedGearbox::new(&language, gearbox, resolved).unwrap().warnings()
    };
    let missed = |window: &str| {
        let found = checked(window)
            .into_iter()
            .filter(|found| found.code == Some(codes::MISSED_WINDOW));
        found.map(|found| found.message).collect::<Vec<_>>()
    };
    let high = |y: &str| format!("y: {y} mm, bottom: 3000 mm, top: 3100 mm, from: -100 mm, to: 160 mm");
    let found: Vec<String> = [high("-20"), high("140")]
        .iter()
        .flat_map(|window| missed(window))
        .collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        found.iter().any(|message| message.contains("meets the wall")),
        "{found:?}"
    );
}

/// A rib catches its part of the oil that the gears lift at the point.
#[test]
fn lifted_oil_fills_pockets() {
    let language = language();
    let solved = |rib: &str, speed: f64| {
        let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
        let pocket = format!(
            "at: 60 mm, designation: \"6205\", pocket: {{ edge: 5 mm, edge_radius: 15 mm, catch: {{ {rib} }} }} }}"
        );
        let text = text.replace("at: 60 mm, designation: \"6205\" }", &pocket);
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, &text, "slow.yaml", Path::new("")).unwrap();
        let t = gearbox.transmission(&language, &Choice::default());
        let t = t.unwrap_or_else(|found| panic!("{}", found.render()));
        let case = t.case(&t.states()[0].name, &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[speed * std::f64::consts::PI / 30.0],
            torques: &[10.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[80.0], &mut scratch);
        let pocket = solution.pockets().next().unwrap();
        let lifted = solution.oil_levels().unwrap().estimate.unwrap().lifted;
        (
            pocket.inflow,
            pocket.height,
            lifted,
            t.oil_space().unwrap().walls().length,
        )
    };
    let (inflow, height, lifted, walls) = solved("width: 20 mm", 3000.0);
    assert!(lifted > 0.0 && height > 5e-3, "{lifted} {height}");
    assert!(
        (inflow / (lifted * 0.02 / walls * 0.5) - 1.0).abs() < 1e-12,
        "{inflow} {lifted}"
    );
    // Another rib leaves another film on the walls, with which the level and what the gears lift differ a little.
    let (half, _, own, _) = solved("width: 20 mm, walls: 800 mm, above: 0.25", 3000.0);
    assert!((half / (own * 0.02 / 0.8 * 0.25) - 1.0).abs() < 1e-12);
    assert!((own / lifted - 1.0).abs() < 0.01);
    // Below the speed at which gears throw oil there is none, and a typed flow stays.
    assert_eq!(solved("width: 20 mm", 100.0).0, 0.0);
    let (typed, ..) = solved("wetting: 20 l/min, width: 50 mm, walls: 400 mm", 100.0);
    assert!((typed * 6e4 - 1.25).abs() < 1e-12, "{typed}");
}

/// The share of the case that a churning law states replaces that of the drawing, and is compared with it.
#[test]
fn a_stated_share_of_the_case_that_is_not_drawn_is_said() {
    let slow = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let inside = "  inside: { sections: { case: { from: 10 mm, to: 50 mm, y: [-40 mm, 110 mm, 110 mm, -40 mm], z: [-50 mm, -50 mm, 50 mm, 50 mm] } } }\n  \
                  clearance: { radial: 6 mm, axial: 10 mm }\nlubricants:";
    let with = |fill: &str| {
        let law = format!("{{ type: shore{fill} }}");
        let text = slow
            .replace("{ type: changenet_2011 }", &law)
            .replace("lubricants:", inside);
        let text = text
            .replace("100 rpm", "1500 rpm")
            .replace("volume: 0.06 l, level: -38 mm", "level: -38 mm");
        doubts(&text)
            .into_iter()
            .filter(|(path, _)| path.ends_with("fill"))
            .collect::<Vec<_>>()
    };
    let found = with(", fill: 0.3");
    let paths: Vec<&str> = found.iter().map(|(path, _)| path.as_str()).collect();
    assert_eq!(
        paths,
        ["gears.pinion.drag.churning.fill", "gears.wheel.drag.churning.fill"]
    );
    assert!(
        found[0].1.starts_with("0.3 is stated, and the oil at rest fills 0.1"),
        "{found:?}"
    );
    assert_eq!(with(""), []);
}

/// As filled at 20 degC and at 90 degC, with 7e-4 1/K.
#[test]
fn oil_expands() {
    let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let text = text.replace(
        "oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s } }",
        "oil: { viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s }, density: { value: 850 kg/m3, at: 20 degC, expansion: 7e-4 1/K } }",
    );
    let text = text.replace("volume: 0.06 l, level: -38 mm", "volume: 0.12 l");
    let t = of_text(&text);
    let volume = solved(&t, 0.0, 90.0, 0.0, |solution| {
        solution.oil_levels().unwrap().estimate.unwrap().volume
    });
    assert!((volume * 1e3 - 0.126_183).abs() < 5e-7, "{volume}");
}

fn of_text(text: &str) -> Transmission {
    let (language, files) = (language(), InMemory::default().shared());
    let gearbox = Gearbox::from_text(&language, &files, text, "slow.yaml", Path::new(""));
    let gearbox = gearbox.unwrap_or_else(|found| panic!("{}", found.render()));
    let t = gearbox.transmission(&language, &Choice::default());
    t.unwrap_or_else(|found| panic!("{}", found.render()))
}

/// Reads a point with a speed in rpm, an oil temperature in degC and an inclination in rad.
fn solved<T>(t: &Transmission, speed: f64, oil: f64, inclination: f64, read: impl FnOnce(&Solution<'_>) -> T) -> T {
    let case = t.case(&t.states()[0].name, &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * std::f64::consts::PI / 30.0],
        torques: &[10.0],
        inclination,
        ..Point::default()
    };
    read(&t.evaluate(&case, &point, &[oil], &mut scratch))
}

/// What a level at rest costs that is taken for the one while rotating, by three laws in first gear at 6000 rpm.
#[test]
fn the_level_at_rest_of_the_two_speed_example_is_open() {
    let language = language();
    let watts = |level: &str, law: &str| {
        let text = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
        let text = text
            .replace("level: -49 mm", level)
            .replace("{ type: iso14179_2, speed_of: pinion }", law);
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, &text, "gearbox.yaml", Path::new("")).unwrap();
        let t = gearbox.transmission(&language, &Choice::default()).unwrap();
        let case = t.case("first", &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[6000.0 * std::f64::consts::PI / 30.0],
            torques: &[15.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[100.0], &mut scratch);
        let drags = solution.parts().filter(|(part, _)| part.mechanism == "gear_drag");
        drags.map(|(_, loss)| loss.watts()).sum::<f64>()
    };
    for (law, low, high) in [
        ("{ type: iso14179_2, speed_of: pinion }", "36.1", "152.9"),
        (LYON, "5.29", "14.10"),
        ("{ type: shore }", "2.49", "5.28"),
    ] {
        for (level, expected) in [("level: -49 mm", low), ("level: -9.2 mm", high)] {
            let decimals = expected.split('.').nth(1).unwrap().len();
            assert_eq!(format!("{:.decimals$}", watts(level, law)), expected, "{law} {level}");
        }
    }
}

/// The gears of the slow example with a window, a rib and pockets of known length, and a housing that travels.
fn caught(volume: f64, edge: f64, keys: &str) -> Transmission {
    let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let pocket = |catch: &str| format!("pocket: {{ edge: {edge} mm, edge_radius: 15 mm, length: 12 mm, {catch} }}");
    let window = "window: { gear: wheel, y: -20 mm, bottom: -60 mm, top: 30 mm, from: 20 mm, to: 60 mm }";
    of_text(
        &text
            .replace("volume: 0.06 l, level: -38 mm", &format!("volume: {volume} l{keys}"))
            .replace(
                "measured_from: shaft_out }",
                "measured_from: shaft_out }\n  travel: \"+y\"",
            )
            .replace(
                "at: 60 mm, designation: \"6205\" }",
                &format!("at: 60 mm, designation: \"6205\", {} }}", pocket(window)),
            )
            .replace(
                "at: 0 mm,  designation: \"6206\", axial: both }",
                &format!(
                    "at: 0 mm,  designation: \"6206\", axial: both, {} }}",
                    pocket("catch: { width: 40 mm }")
                ),
            ),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10))]
    /// Sump, walls, air and pockets hold the oil together at every speed, level, temperature and inclination.
    #[test]
    fn no_state_loses_oil(
        litres in 0.03..0.2_f64, edge in 0.0..9.0_f64,
        points in prop::collection::vec((-6000.0..6000.0_f64, -20.0..130.0_f64, -25.0..25.0_f64), 8)
    ) {
        let t = caught(litres, edge, "");
        for (speed, oil, degrees) in points {
            let inclination = f64::to_radians(degrees);
            solved(&t, speed, oil, inclination, |solution| {
                let levels = solution.oil_levels().unwrap();
                let estimate = levels.estimate.unwrap();
                let kept = t.oil_space().unwrap().at(inclination).volume(levels.running)[0];
                let all = kept + estimate.missing + estimate.in_pockets + estimate.held;
                assert!((all / estimate.volume - 1.0).abs() < 1e-9, "{speed} {oil} {degrees}: {levels:?}");
                let resting = t.oil_space().unwrap().at(inclination).volume(levels.at_rest)[0];
                assert!((resting / estimate.volume - 1.0).abs() < 1e-9);
                // A level is found within 1e-13 m.
                assert!(estimate.band.low() <= levels.running + 1e-12, "{speed} {oil} {degrees}: {levels:?}");
                assert!(levels.running <= levels.at_rest, "{speed} {oil} {degrees}: {levels:?}");
                assert!(estimate.after_minute <= levels.at_rest + 1e-12 && estimate.after_minute >= levels.running - 1e-12);
                // What flows into pockets is part of what the gears lift.
                let inflow: f64 = solution.pockets().map(|pocket| pocket.inflow).sum();
                assert!(inflow <= estimate.lifted * (1.0 + 1e-12));
                if speed.abs() < 200.0 {
                    assert_eq!((estimate.lifted, levels.running.to_bits()), (0.0, levels.at_rest.to_bits()));
                }
            });
        }
    }
}

/// A window and a rib keep oil off the walls, and pockets hold some: both are in the level.
#[test]
fn pockets_windows_and_ribs_are_in_the_balance() {
    let t = caught(0.1, 5.0, "");
    let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let without = of_text(&text.replace("volume: 0.06 l, level: -38 mm", "volume: 0.1 l"));
    for speed in [3000.0, -3000.0] {
        let of = |t: &Transmission| {
            solved(t, speed, 80.0, 0.0, |solution| {
                let pockets: Vec<f64> = solution.pockets().map(|pocket| pocket.inflow).collect();
                (solution.oil_levels().unwrap().estimate.unwrap(), pockets)
            })
        };
        let ((own, pockets), (plain, _)) = (of(&t), of(&without));
        assert!(own.in_pockets > 0.0 && plain.in_pockets == 0.0, "{own:?}");
        // What the window takes and the rib catches does not wet the wall below.
        let rib = pockets.last().unwrap();
        assert!(
            *rib > 0.0 && own.missing < plain.missing,
            "{own:?} {plain:?} {pockets:?}"
        );
        if pockets[0] > 0.0 {
            assert!(
                (rib / ((own.lifted - pockets[0]) * 0.04 / t.oil_space().unwrap().walls().length * 0.5) - 1.0).abs()
                    < 1e-12
            );
        }
        assert!(own.on_gears > 0.0 && own.on_gears < 5e-6, "{own:?}");
    }
}

/// Churning of the drive unit without swell and with one level for all gears: that of its file, and that of its volume in the hull of its gears.
#[test]
fn the_level_of_the_drive_unit_decides_its_churning() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file("examples/electric-drive-unit/gearbox.yaml")).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let space = t.oil_space().unwrap().at(0.0);
    assert_eq!(format!("{:.2}", 1e3 * space.volume(-91.79e-3)[0]), "0.47");
    for (level, watts) in [("-91.79 mm", "14.2"), ("-39.2 mm", "76.4")] {
        let choice = Choice::default()
            .with("housing.oil.level", level)
            .with("gears.W1.level", level)
            .with("gears.*.drag.churning.swell", 0.0);
        let t = gearbox.transmission(&language, &choice).unwrap();
        let case = t.case(&t.states()[0].name, &["input"], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let point = Point {
            speeds: &[8000.0 * std::f64::consts::PI / 30.0],
            torques: &[20.0],
            ..Point::default()
        };
        let solution = t.evaluate(&case, &point, &[60.0], &mut scratch);
        let drags = solution.parts().filter(|(part, _)| part.mechanism == "gear_drag");
        let churning: f64 = drags.map(|(_, loss)| loss.watts()).sum();
        assert_eq!(format!("{churning:.1}"), watts, "{level}");
    }
}

/// A text of the slow example with a second oil and a bearing with a pocket, which has one of the two and more keys.
fn with_pocket(lubricant: &str, keys: &str) -> String {
    let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let pocket = format!("pocket: {{ edge: 5 mm, edge_radius: 15 mm, length: 12 mm{keys} }}");
    text.replace("volume: 0.06 l, level: -38 mm", "volume: 0.1 l")
        .replace(
            "lubricants:\n",
            "lubricants:\n  grade: { viscosity: { kv40: 320 mm2/s, kv100: 24 mm2/s } }\n",
        )
        .replace(
            "at: 0 mm,  designation: \"6206\", axial: both }",
            &format!("at: 0 mm,  designation: \"6206\", axial: both, lubricant: {lubricant}, {pocket} }}"),
        )
}

/// The same with a circuit of its own oil, which supplies the pocket from one junction; a pipe to `end` supplies the other.
fn with_circuit(lubricant: &str, of_circuit: &str, end: &str) -> String {
    let circuit = format!(
        "oil_network:
  lubricant: {of_circuit}
  junctions: {{ tank: {{}}, gallery: {{}} }}
  pumps: {{ pump: {{ from: tank, to: gallery, speed: 1000 rpm, displacement: 1 cm3 }} }}
  pipes: {{ back: {{ from: tank, to: {end}, diameter: 20 mm, length: 100 mm }} }}
  nozzles: {{ jet: {{ from: gallery, diameter: 4 mm, feeds: [bearings.left_out] }} }}
lubricants:
"
    );
    with_pocket(lubricant, "").replace("lubricants:\n", &circuit)
}

/// What stands in a pocket is missing from the sump only if it is the oil of the sump.
#[test]
fn pockets_of_another_oil_are_not_subtracted() {
    let of = |lubricant: &str| {
        let t = of_text(&with_circuit(lubricant, lubricant, "housing"));
        solved(&t, 3000.0, 80.0, 0.0, |solution| {
            let height = solution.pockets().next().unwrap().height;
            let levels = solution.oil_levels().unwrap();
            (height, levels.running, levels.estimate.unwrap().in_pockets)
        })
    };
    let text = std::fs::read_to_string(file("tests/oil/slow.yaml")).unwrap();
    let bare = of_text(&text.replace("volume: 0.06 l, level: -38 mm", "volume: 0.1 l"));
    let without = solved(&bare, 3000.0, 80.0, 0.0, |solution| {
        solution.oil_levels().unwrap().running
    });
    let (height, running, in_pockets) = of("oil");
    assert!(
        height > 5e-3 && in_pockets > 1e-6 && running < without,
        "{height} {running} {without} {in_pockets}"
    );
    let (height, running, in_pockets) = of("grade");
    assert!(height > 5e-3, "{height}");
    assert_eq!((running.to_bits(), in_pockets), (without.to_bits(), 0.0));
}

/// Neither gears nor the network can fill the pocket of a bearing with another oil, and oil from the sump is that of the sump.
#[test]
fn pockets_and_networks_have_one_oil() {
    let language = language();
    let read = |text: &str| {
        let files = InMemory::default().shared();
        let gearbox = Gearbox::from_text(&language, &files, text, "gearbox.yaml", Path::new("")).unwrap();
        gearbox.transmission(&language, &Choice::default())
    };
    let catch = |wetting: &str| format!(", catch: {{ width: 40 mm, walls: 400 mm{wetting} }}");
    let [calculated, stated] = ["", ", wetting: 1 l/min"].map(catch);
    for text in [
        with_pocket("oil", &calculated),
        with_pocket("oil", &stated),
        with_circuit("oil", "oil", "sump"),
        with_circuit("grade", "grade", "housing"),
    ] {
        assert!(read(&text).is_ok(), "{text}");
    }
    for (text, path) in [
        (with_pocket("grade", &calculated), "bearings.left_out.pocket.catch"),
        (with_pocket("grade", &stated), "bearings.left_out.pocket.catch"),
        (with_circuit("grade", "oil", "housing"), "oil_network.nozzles.jet.feeds"),
        (with_circuit("oil", "grade", "housing"), "oil_network.nozzles.jet.feeds"),
        (with_circuit("grade", "grade", "sump"), "oil_network.lubricant"),
    ] {
        let found = read(&text).err().unwrap();
        let [error] = &found.list[..] else {
            panic!("{}", found.render())
        };
        assert_eq!(error.path, path, "{}", error.message);
        assert!(error.message.contains("another lubricant"), "{}", error.message);
    }
}
