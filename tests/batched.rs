//! Points side by side have the bits of points alone, but for the sign of zero: losses, terms, power in and out, notes.

use crate::common::{RPM, file, language, two_speed};
use gearloss_framework::evaluate::{Noting, Point};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::loss::{Extent, MOST_TERMS};
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::thermal::Equilibrium;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::study::Study;
use serde_json::json;

/// How many points were solved side by side, and how many had to be evaluated alone.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Count {
    together: usize,
    alone: usize,
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Vec<u64> {
    // Zero has two signs; a sum that starts in another place may have the other one.
    numbers.into_iter().map(|x| (x + 0.0).to_bits()).collect()
}

/// Compares rows of torques at some speeds and temperatures in every gear state that takes one speed and one torque.
fn compare(t: &Transmission, speeds: &[f64], torques: &[f64], temperatures: &[f64], count: &mut Count) {
    for state in t.states() {
        let needed = t.torques_needed(t.state(&state.name).unwrap());
        let names: Vec<&str> = t.ports().iter().map(|p| p.name.as_str()).take(needed).collect();
        let Ok(case) = t.case(&state.name, &[], &names) else {
            continue;
        };
        if case.torque_ports.is_empty() {
            continue;
        }
        let mut scratch = t.scratch(&case);
        let mut rows = t.batch_scratch(&case);
        for speed in speeds {
            for temperature in temperatures {
                let own_speeds = vec![*speed; case.speed_ports.len()];
                let mut own_torques = vec![0.0; case.torque_ports.len()];
                let start = own_torques.clone();
                let point = Point {
                    speeds: &own_speeds,
                    torques: &start,
                    ..Point::default()
                };
                let temperature = [*temperature];
                // Those of one sense first, then a few of both and none.
                let blocks = torques
                    .chunk_by(|a, b| a * b > 0.0)
                    .flat_map(|alike| alike.chunks(LANES));
                let mut row = t.batch(&case, &point, &temperature, &mut rows);
                for some in blocks.chain([&torques[12..25]]) {
                    let block = row.solve(some);
                    let mut alone = Vec::new();
                    for (lane, torque) in some.iter().enumerate() {
                        own_torques[0] = *torque;
                        let point = Point {
                            torques: &own_torques,
                            ..point
                        };
                        let solution = t.evaluate(&case, &point, &temperature, &mut scratch);
                        if block.is_alone(lane) {
                            alone.push((*torque, solution.loss()));
                            count.alone += usize::from(*speed != 0.0);
                            continue;
                        }
                        count.together += 1;
                        if lane == 0 {
                            // Nothing of the points before is left in a scratch.
                            let point = Point {
                                torques: &own_torques,
                                ..point
                            };
                            let anew = t.evaluate(&case, &point, &temperature, &mut t.scratch(&case)).loss();
                            assert_eq!(bits(anew), bits(solution.loss()), "{speed} {torque}");
                        }
                        let at = format!("{} {} {speed} {torque}", t.title(), state.name);
                        assert_eq!(block.status(lane), solution.status(), "{at}");
                        assert_eq!(block.passes(lane), solution.passes(), "{at}");
                        assert_eq!(
                            bits(block.watts().iter().map(|w| w[lane])),
                            bits(solution.watts().iter().copied()),
                            "{at}"
                        );
                        assert_eq!(bits([block.losses()[lane]]), bits(solution.loss()), "{at}");
                        let balance = block.balance(lane);
                        assert_eq!(
                            bits([balance.input, balance.output]),
                            bits([solution.input_power().unwrap(), solution.output_power().unwrap()]),
                            "{at}"
                        );
                        for (number, (part, loss)) in solution.parts().enumerate() {
                            for term in 0..MOST_TERMS {
                                assert_eq!(
                                    bits([block.term_watts(number, term)[lane]]),
                                    bits([loss.term_watts(term)]),
                                    "{at} {} {term}",
                                    part.path
                                );
                            }
                        }
                        let outside = solution.leaves_a_range();
                        assert_eq!(block.leaves_a_range(lane), outside, "{at}");
                    }
                    for (torque, loss) in alone {
                        assert_eq!(row.alone(torque).loss(), loss);
                    }
                }
            }
        }
        let totals: Vec<Extent> = rows.take_totals();
        for (instance, (row, single)) in totals.iter().zip(&scratch.totals).enumerate() {
            assert_eq!(row, single, "{} {} cell {instance}", t.title(), state.name);
        }
    }
}

fn transmission(language: &Language, path: &str, set: Option<&str>) -> Transmission {
    let choice = Choice {
        set: set.map(str::to_owned),
        ..Choice::default()
    };
    let gearbox = Gearbox::read(language, &file(path)).unwrap_or_else(|found| panic!("{found:#?}"));
    gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|found| panic!("{path}: {found:#?}"))
}

#[test]
fn the_examples_have_the_same_bits_side_by_side_and_alone() {
    let language = language();
    // Both senses, none, and torques near none and far beyond the rating.
    let torques: Vec<f64> = (-20..=20)
        .map(|i| 0.9 * f64::from(i))
        .chain([1e-6, -1e-3, 0.01, 150.0])
        .collect();
    let speeds = [0.0, 30.0 * RPM, 4321.0 * RPM, -2000.0 * RPM, 20000.0 * RPM];
    // Two full blocks and a rest.
    let many: Vec<f64> = (1..=150).map(|i| 0.2 * f64::from(i)).collect();
    let mut full = Count::default();
    let joint = transmission(&language, "examples/two-speed-ev/gearbox.yaml", Some("joint"));
    compare(&joint, &speeds[1..3], &many, &[80.0], &mut full);
    assert!(full.together > 0 && full.alone == 0, "{full:?}");
    let mut count = Count::default();
    for (path, sets) in [
        (
            "examples/two-speed-ev/gearbox.yaml",
            &[None, Some("joint"), Some("iso14179_2")][..],
        ),
        ("examples/planetary-reducer/gearbox.yaml", &[None]),
        ("examples/planet-pins/gearbox.yaml", &[None]),
        ("examples/electric-drive-unit/gearbox.yaml", &[None]),
        ("examples/electric-drive-unit/gearbox-beam.yaml", &[None]),
        ("examples/worm-drive/gearbox.yaml", &[None]),
        ("tests/results/crossed_helical.yaml", &[None]),
        ("framework/workbench/src/form/layouts/bevel-helical.yaml", &[None]),
        (
            "framework/workbench/src/form/layouts/axle.yaml",
            &[None, Some("iso14179_2")],
        ),
    ] {
        for set in sets {
            let t = transmission(&language, path, *set);
            let mut of_case = Count::default();
            compare(&t, &speeds, &torques, &[100.0, 20.0], &mut of_case);
            // The others have states whose points seldom stay together.
            if path.contains("two-speed") {
                count.together += of_case.together;
                count.alone += of_case.alone;
            }
        }
    }
    // Sets of a study, with seals and synchronizers switched off or with models of their own.
    let study = Study::read(&language, &file("examples/two-speed-ev/study.yaml")).unwrap();
    for set in ["iso", "joint", "complete"] {
        let t = two_speed(&language)
            .transmission(&language, &study.choice(Some(set)))
            .unwrap();
        let mut of_set = Count::default();
        compare(&t, &speeds, &torques, &[100.0, 20.0], &mut of_set);
        assert!(of_set.together > of_set.alone, "{set}: {of_set:?}");
        count.together += of_set.together;
        count.alone += of_set.alone;
    }
    // Most points are solved side by side, or nothing is won.
    assert!(count.together > 3 * count.alone, "{count:?}");
}

/// Three pairs of tapered roller bearings, then one of them on a spring that is too weak at some of the points, then one with a preload that
/// is lost at the higher temperature.
#[test]
fn pairs_of_bearings_have_the_same_bits_side_by_side_and_alone() {
    let language = language();
    let layout = file("framework/workbench/src/form/layouts/three-stage.yaml");
    let gearbox = Gearbox::read(&language, &layout).unwrap();
    let torques: Vec<f64> = (-20..=20).map(|i| 0.9 * f64::from(i)).chain([1e-6, 150.0]).collect();
    let spring = Choice::default().with("bearings.B3.spring_preload", 300.0);
    let preload = json!({ "force": 500.0, "housing": { "material": "aluminium" } });
    let preload = Choice::default().with("bearings.B3.preload", preload);
    for (choice, sprung, preloaded) in [(Choice::default(), 0, 0), (spring, 1, 0), (preload, 0, 1)] {
        let t = gearbox.transmission(&language, &choice).unwrap();
        assert_eq!(t.pairs().len(), 3);
        assert_eq!(t.pairs().iter().filter(|pair| pair.spring.is_some()).count(), sprung);
        assert_eq!(
            t.pairs().iter().filter(|pair| pair.preload.is_some()).count(),
            preloaded
        );
        let mut count = Count::default();
        compare(&t, &[30.0 * RPM, 1500.0 * RPM], &torques, &[70.0, 20.0], &mut count);
        assert!(count.together > count.alone, "{count:?}");
    }
}

#[test]
fn changed_coefficients_of_formulas_count_side_by_side_as_alone() {
    let language = language();
    let torques: Vec<f64> = (-20..=20).map(|i| 0.9 * f64::from(i)).chain([1e-6, 150.0]).collect();
    let speeds = [30.0 * RPM, 4321.0 * RPM, -2000.0 * RPM];
    let xu = "meshes.*.model.tooth_friction.coefficients";
    let bearing = "bearings.*.model.coefficients";
    let of_xu = [("b1", -8.5), ("b2", 1.4), ("b3", 0.9), ("b4", -0.5), ("b5", 4.0)];
    let more_of_xu = [("b6", -0.15), ("b7", 0.6), ("b8", -0.5), ("b9", 0.4)];
    let of_skf = [
        ("rolling_exponent", 0.55),
        ("mixed_factor", 4e-8),
        ("inlet_factor", 3e-9),
        ("bath_factor", 2e-7),
    ];
    let of_palmgren = [("viscous_exponent", 0.7), ("constant_factor", 2e-5)];
    for (set, changes) in [
        (
            "joint",
            [
                of_xu.map(|law| (xu, law)).to_vec(),
                more_of_xu.map(|law| (xu, law)).to_vec(),
            ]
            .concat(),
        ),
        ("joint", of_skf.map(|law| (bearing, law)).to_vec()),
        ("iso14179_2", of_palmgren.map(|law| (bearing, law)).to_vec()),
        (
            "iso14179_2",
            vec![("meshes.*.model.coefficients", ("load_exponent", 0.27))],
        ),
    ] {
        let published = transmission(&language, "examples/two-speed-ev/gearbox.yaml", Some(set));
        let mut choice = Choice::of_set(set);
        for (at, (name, value)) in &changes {
            choice = choice.with(format!("{at}.{name}"), *value);
        }
        let changed = two_speed(&language)
            .transmission(&language, &choice)
            .unwrap_or_else(|found| panic!("{}", found.render()));
        let loss = |t: &Transmission| {
            let case = t.case("first", &["input"], &["input"]).unwrap();
            let point = Point {
                speeds: &[4321.0 * RPM],
                torques: &[9.0],
                ..Point::default()
            };
            t.evaluate(&case, &point, &[80.0], &mut t.scratch(&case))
                .loss()
                .unwrap()
        };
        assert!(
            (loss(&published) / loss(&changed) - 1.0).abs() > 1e-4,
            "{set}: {changes:?}"
        );
        let mut count = Count::default();
        compare(&changed, &speeds, &torques, &[100.0, 20.0], &mut count);
        assert!(count.together > count.alone, "{set}: {count:?}");
    }
}

#[test]
fn what_was_seen_is_the_same_taken_in_one_go_or_in_the_middle_of_a_row() {
    let language = language();
    let t = transmission(&language, "examples/two-speed-ev/gearbox.yaml", Some("joint"));
    let case = t.case(&t.states()[0].name, &[], &[t.ports()[0].name.as_str()]).unwrap();
    let torques: Vec<f64> = (1..=200).map(|i| 0.1 * f64::from(i)).collect();
    let seen = |parts: &[&[f64]]| {
        let mut rows = t.batch_scratch(&case);
        let mut seen: Option<Vec<Extent>> = None;
        for part in parts {
            let point = Point {
                speeds: &[3000.0 * RPM],
                torques: &[0.0],
                ..Point::default()
            };
            let mut row = t.batch(&case, &point, &[90.0], &mut rows);
            for some in part.chunks(LANES) {
                row.solve(some);
            }
            let totals = rows.take_totals();
            seen = Some(match seen {
                None => totals,
                Some(before) => before.into_iter().zip(totals).map(|(a, b)| a.merge(b)).collect(),
            });
        }
        seen.unwrap()
    };
    let whole = seen(&[&torques]);
    assert!(whole.iter().any(|extent| extent.seen == 200));
    assert_eq!(whole, seen(&[&torques[..70], &torques[70..]]));
}

/// Numbers between zero and one that look random.
fn scatter(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Points with a speed, torque and temperature each have the bits of each alone, whatever the others are and in whichever order;
/// so have their balances.
#[test]
fn points_of_any_composition_have_the_bits_of_each_alone() {
    let language = language();
    let mut together = 0;
    for (path, set) in [
        ("examples/two-speed-ev/gearbox.yaml", None),
        ("examples/two-speed-ev/gearbox.yaml", Some("joint")),
        ("examples/two-speed-ev/gearbox.yaml", Some("iso14179_2")),
        ("examples/planetary-reducer/gearbox.yaml", None),
        ("examples/electric-drive-unit/gearbox.yaml", None),
    ] {
        let t = transmission(&language, path, set);
        let state = &t.states()[0].name;
        let needed = t.torques_needed(t.state(state).unwrap());
        let names: Vec<&str> = t.ports().iter().map(|p| p.name.as_str()).take(needed).collect();
        let case = t.case(state, &[], &names).unwrap();
        let mut random = scatter(7);
        let given: Vec<(Vec<f64>, Vec<f64>, [f64; 1])> = (0..60)
            .map(|i| {
                let speed = if i % 13 == 0 { 0.0 } else { 1500.0 * (random() - 0.1) };
                let torques = case.torque_ports.iter().map(|_| 30.0 * (random() - 0.3)).collect();
                (vec![speed; case.speed_ports.len()], torques, [20.0 + 100.0 * random()])
            })
            .collect();
        let points: Vec<Point<'_>> = given
            .iter()
            .map(|(speeds, torques, _)| Point {
                speeds,
                torques,
                ..Point::default()
            })
            .collect();
        let mut alone = t.scratch(&case);
        let single: Vec<(Option<f64>, Vec<u64>)> = (0..points.len())
            .map(|i| {
                let solution = t.evaluate(&case, &points[i], &given[i].2, &mut alone);
                (solution.loss(), bits(solution.watts().iter().copied()))
            })
            .collect();
        let mut scratch = t.batch_scratch(&case);
        for step in [1, 7, 11] {
            for size in [LANES, 5] {
                let order: Vec<usize> = (0..points.len()).map(|i| i * step % points.len()).collect();
                for some in order.chunks(size) {
                    let group: Vec<Point<'_>> = some.iter().map(|i| points[*i]).collect();
                    let temperatures = |lane: usize| &given[some[lane]].2[..];
                    let block = t.evaluate_together(&case, &group, &temperatures, Noting::Counted, &mut scratch);
                    for (lane, i) in some.iter().enumerate().filter(|(lane, _)| !block.is_alone(*lane)) {
                        together += 1;
                        let watts = bits(block.watts().iter().map(|watts| watts[lane]));
                        let loss = Some(block.losses()[lane]);
                        assert_eq!((loss, watts), single[*i], "{path} {set:?} point {i} of {some:?}");
                    }
                }
            }
        }
        if path.contains("planetary") {
            let balances = t.equilibria(&case, &points[..20], &mut scratch);
            let (mut steps, mut steps_alone) = (0, 0);
            for (point, together) in points.iter().zip(balances) {
                let found = t.equilibrium(&case, point, &mut alone);
                steps += together.history.len();
                steps_alone += found.history.len();
                // A scan of estimates leaves other steps.
                let Equilibrium { history, scanned, .. } = found.clone();
                let together = Equilibrium {
                    history,
                    scanned,
                    ..together
                };
                assert_eq!(found, together);
            }
            // The scans of 20 points have 17 temperatures each, of which half need no losses.
            assert!(steps < steps_alone - 170, "{steps} of {steps_alone}");
        }
    }
    assert!(together > 800, "{together}");
}
