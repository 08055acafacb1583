//! A gearbox that is built again and again with other numbers is to the bit the gearbox that is resolved and built with them.

use crate::common::{cases, file, language};
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, Resolved};
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use gearloss_numerics::sampling::Generator;
use gearloss_studies::study::Study;
use serde_json::Value;
use std::path::PathBuf;

/// The gearboxes of the examples.
const EXAMPLES: [&str; 9] = [
    "examples/two-speed-ev/gearbox.yaml",
    "examples/electric-drive-unit/gearbox.yaml",
    "examples/electric-drive-unit/gearbox-40.yaml",
    "examples/electric-drive-unit/gearbox-beam.yaml",
    "examples/planetary-reducer/gearbox.yaml",
    "examples/planet-pins/gearbox.yaml",
    "examples/two-products/theirs.yaml",
    "examples/foreign-map/gearbox.yaml",
    "examples/transfer-case/gearbox.yaml",
];

/// A number of a resolved document that may be overridden: path, value in the documented unit, range.
struct Quantity {
    path: String,
    value: f64,
    range: [f64; 2],
}

fn quantities(language: &Language, resolved: &Resolved) -> Vec<Quantity> {
    fn descend(language: &Language, root: &Value, at: &Value, path: &mut String, found: &mut Vec<Quantity>) {
        let mut visit = |key: &str, value: &Value| {
            let length = path.len();
            if length > 0 {
                path.push('.');
            }
            path.push_str(key);
            descend(language, root, value, path, found);
            path.truncate(length);
        };
        match at {
            Value::Object(map) => map.iter().for_each(|(key, value)| visit(key, value)),
            Value::Array(list) => list
                .iter()
                .enumerate()
                .for_each(|(i, value)| visit(&i.to_string(), value)),
            Value::Number(number) => {
                let known = language.number_at(root, path).zip(number.as_f64());
                found.extend(known.map(|((unit, least, greatest), si)| Quantity {
                    path: path.clone(),
                    value: unit.from_si(si),
                    range: [least, greatest],
                }));
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    descend(
        language,
        &resolved.value,
        &resolved.value,
        &mut String::new(),
        &mut found,
    );
    found
}

/// Everything that a user sees of a transmission: parts, notes of the build, warnings, and losses in every gear state, as bits.
fn seen(t: &Transmission) -> (Vec<String>, Vec<u64>) {
    let mut words: Vec<String> = t.warnings.iter().map(|warning| format!("{warning:?}")).collect();
    for part in t.parts() {
        words.push(format!("{part:?}"));
    }
    for instance in t.instances() {
        words.push(format!(
            "{} {} {:?}",
            instance.path, instance.entry.name, instance.notes
        ));
    }
    let mut bits = Vec::new();
    for state in t.states() {
        words.push(format!("{} {:?}", state.name, state.speed_ports));
        let needed = t.torques_needed(t.state(&state.name).unwrap());
        let names: Vec<&str> = t.ports().iter().map(|p| p.name.as_str()).take(needed).collect();
        let Ok(case) = t.case(&state.name, &[], &names) else {
            continue;
        };
        let mut scratch = t.scratch(&case);
        for (speed, torque) in [(20.0, 1.0), (700.0, 30.0), (-300.0, 8.0)] {
            let speeds = vec![speed; case.speed_ports.len()];
            let torques = vec![torque; case.torque_ports.len()];
            let point = Point {
                speeds: &speeds,
                torques: &torques,
                ..Point::default()
            };
            let temperatures = vec![70.0; t.nodes()];
            let solution = t.evaluate(&case, &point, &temperatures, &mut scratch);
            bits.extend(solution.watts().iter().map(|x| x.to_bits()));
            bits.extend(solution.extents().iter().map(|extent| u64::from(extent.outside > 0)));
            if t.nodes() == 1 {
                let balance = t.equilibrium(&case, &point, &mut scratch);
                bits.push(balance.oil().unwrap_or(-1.0).to_bits());
            }
        }
    }
    (words, bits)
}

/// The transmission as seen, or its errors as printed.
fn outcome(built: Result<Transmission, Findings>) -> Result<(Vec<String>, Vec<u64>), String> {
    built.map(|t| seen(&t)).map_err(|findings| findings.render())
}

/// A new value: near the old one, anywhere in the range, or outside of it.
fn drawn(generator: &mut Generator, quantity: &Quantity) -> f64 {
    let share = |generator: &mut Generator| generator.below(1 << 20) as f64 / f64::from(1 << 20);
    let [low, high] = quantity.range;
    match generator.below(12) {
        0 if low.is_finite() && high.is_finite() => low + share(generator) * (high - low),
        1 => high + 1.0,
        2 => quantity.value,
        _ => (quantity.value * (0.8 + 0.4 * share(generator))).clamp(low, high),
    }
}

/// Gearboxes with choices of models, and how many lists of paths are overridden in each.
fn gearboxes(language: &Language) -> Vec<(PathBuf, Gearbox, Choice, usize)> {
    let examples = EXAMPLES.iter().map(|path| (file(path), 12));
    let of_cases = cases().into_iter().map(|folder| (folder.join("input.yaml"), 1));
    let mut all: Vec<(PathBuf, Gearbox, Choice, usize)> = Vec::new();
    for (path, rounds) in examples.chain(of_cases) {
        if let Ok(gearbox) = Gearbox::read(language, &path) {
            all.push((path, gearbox, Choice::default(), rounds));
        }
    }
    let path = file(EXAMPLES[0]);
    let study = Study::read(language, &path.with_file_name("study.yaml")).unwrap();
    for set in ["iso", "joint", "complete"] {
        let gearbox = Gearbox::read(language, &path).unwrap();
        all.push((path.clone(), gearbox, study.choice(Some(set)), 12));
    }
    all
}

#[test]
fn other_numbers_in_place_are_those_of_a_new_build() {
    let language = language();
    let mut generator = Generator::new(7);
    let (mut equal, mut refused) = (0, 0);
    for (path, gearbox, choice, rounds) in gearboxes(&language) {
        let Ok(resolved) = gearbox.resolve(&language, &choice) else {
            continue;
        };
        let all = quantities(&language, &resolved);
        let variants = Variants::new(&language, &gearbox, choice.clone());
        for _ in 0..rounds {
            // The same paths several times, with other numbers, some of which stay.
            let changed: Vec<&Quantity> = (0..=generator.below(5))
                .map(|_| &all[generator.below(all.len())])
                .collect();
            let mut overrides: Vec<(String, Value)> = Vec::new();
            for _ in 0..4 {
                let draw = |quantity: &&Quantity| (quantity.path.clone(), Value::from(drawn(&mut generator, quantity)));
                let new: Vec<(String, Value)> = changed.iter().map(draw).collect();
                let stays = generator.below(2) == 0;
                overrides = match overrides.first() {
                    Some(first) if stays => [vec![first.clone()], new[1..].to_vec()].concat(),
                    _ => new,
                };
                let whole = Choice {
                    overrides: [&choice.overrides[..], &overrides].concat(),
                    ..choice.clone()
                };
                let expected = outcome(gearbox.transmission(&language, &whole));
                let found = outcome(variants.build(&overrides));
                assert_eq!(found, expected, "{} {overrides:?}", path.display());
                match found {
                    Ok(_) => equal += 1,
                    Err(_) => refused += 1,
                }
            }
        }
    }
    assert!(equal > 150 && refused > 30, "{equal} {refused}");
}

/// Patterns, texts with units, models, catalogues and networks are not numbers in place: they are resolved.
#[test]
fn overrides_of_any_kind_follow_each_other() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let choice = Choice::of_set("no_such_set");
    let choices = [Choice::default(), choice];
    let lists: Vec<Vec<(&str, Value)>> = vec![
        vec![],
        vec![
            ("bearings.*.radial_factor", 1.2.into()),
            ("gears.*.surface.rq", 0.5.into()),
        ],
        vec![
            ("bearings.*.radial_factor", 0.9.into()),
            ("gears.*.surface.rq", 0.5.into()),
        ],
        vec![("surface.rq", 0.5.into()), ("gears.G1.surface.rq", 0.4.into())],
        vec![("surface.rq", 0.3.into()), ("gears.G1.surface.rq", 0.4.into())],
        vec![("housing.oil.volume", "1.1 l".into())],
        vec![("bearings.B1.designation", "6304".into())],
        vec![
            ("bearings.B1.designation", "6304".into()),
            ("bearings.B1.bore", 21.0.into()),
        ],
        vec![("lubricants.sump.viscosity.kv40", 32.0.into())],
        vec![
            ("lubricants.sump.viscosity.kv100", 7.0.into()),
            ("lubricants.sump.viscosity.vi", 120.0.into()),
        ],
        vec![
            ("lubricants.sump.viscosity.kv100", 8.0.into()),
            ("lubricants.sump.viscosity.vi", 120.0.into()),
        ],
        vec![("gears.G1.z", 17.into())],
        vec![("gears.G1.level", 3.0.into()), ("gears.*.level", 4.0.into())],
        vec![("gears.G1.level", 2.0.into()), ("gears.*.level", 5.0.into())],
        vec![
            ("bearings.B3.model", serde_json::json!({ "type": "skf" })),
            ("bearings.B3.model.mu_bl", 0.2.into()),
        ],
        vec![("bearings.B3.model.mu_bl", 0.2.into())],
        vec![("bearings.no.bore", 1.0.into())],
        vec![("meshes.M1.centre_distance", 70.0.into())],
        vec![("meshes.M1.centre_distance", 69.0.into())],
        vec![("locked_below", 0.01.into())],
        vec![("locked_below", 0.02.into())],
        vec![("shafts.input.axis.0", 133.4.into()), ("thermal.oil", 60.0.into())],
        vec![("shafts.input.axis.0", 133.401.into()), ("thermal.oil", 80.0.into())],
    ];
    for choice in choices {
        let variants = Variants::new(&language, &gearbox, choice.clone());
        for list in lists.iter().chain(lists.iter().rev()) {
            let overrides: Vec<(String, Value)> = list
                .iter()
                .map(|(path, value)| ((*path).to_owned(), value.clone()))
                .collect();
            let whole = Choice {
                overrides: overrides.clone(),
                ..choice.clone()
            };
            let expected = outcome(gearbox.transmission(&language, &whole));
            assert_eq!(outcome(variants.build(&overrides)), expected, "{overrides:?}");
            let resolved = |result: Result<Resolved, Findings>| {
                result
                    .map(|resolved| (resolved.value, resolved.sources))
                    .map_err(|f| f.render())
            };
            assert_eq!(
                resolved(variants.resolve(&overrides)),
                resolved(gearbox.resolve(&language, &whole))
            );
        }
    }
}

/// What another value of a number builds again: models whose part or parameters it changes, no others.
#[test]
fn only_models_that_read_a_number_are_built_again() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file(EXAMPLES[0])).unwrap();
    let variants = Variants::new(&language, &gearbox, Choice::of_set("joint"));
    let again = |path: &str, values: [f64; 2]| {
        let [before, after] = values.map(|value| vec![(path.to_owned(), Value::from(value))]);
        variants.built_again([&before, &after]).unwrap()
    };
    for (path, values) in [
        ("bearings.*.radial_factor", [1.0, 1.2]),
        ("seals.*.loss_factor", [0.5, 2.0]),
        ("gears.*.loss_factor", [1.0, 2.0]),
        ("meshes.*.loss_factor", [1.0, 2.0]),
        ("bearings.*.temperature_offset", [1.0, 2.0]),
    ] {
        assert_eq!(again(path, values), Some(Vec::new()), "{path}");
    }
    let meshes = ["M1", "M2", "M3"].map(|id| format!("meshes.{id}.model"));
    assert_eq!(again("gears.*.surface.rq", [0.4, 0.6]), Some(meshes.to_vec()));
    let bearings = again("bearings.*.model.mu_bl", [0.12, 0.2]).unwrap();
    assert!(bearings.contains(&"bearings.B1.model".to_owned()), "{bearings:?}");
    assert!(
        bearings.iter().all(|path| path.starts_with("bearings.")),
        "{bearings:?}"
    );
    let written = ["1.1 l", "1.2 l"].map(|volume| vec![("housing.oil.volume".to_owned(), Value::from(volume))]);
    assert_eq!(variants.built_again([&written[0], &written[1]]).unwrap(), None);
}
