//! Thermal networks that are laid out from a description: heat counted once, temperatures of a sensible size, paths to every number.

use crate::common::{self, RPM};
use gearloss_framework::evaluate::Point;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::registry::{NetworkRecipe, Registry};
use gearloss_framework::resolve::{Choice, ValueSource, lookup};
use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::{March, Moment, Scheme, Steady, StepSize, Surroundings};
use gearloss_framework::transmission::{HeatPath, PartKind, Transmission};
use gearloss_studies::points::{Field, Given, OilTemperature, Points, run_grid};
use serde_json::{Value, json};

/// An example, the gear state, speed in rpm and torque in Nm at the input.
struct Drive {
    file: &'static str,
    gear: &'static str,
    speed: f64,
    torque: f64,
    set: Vec<(&'static str, Value)>,
}

fn two_speed() -> Drive {
    Drive {
        file: "examples/two-speed-ev/gearbox.yaml",
        gear: "first",
        speed: 6000.0,
        torque: 15.0,
        set: vec![
            ("housing.outside", json!({ "box": ["350 mm", "200 mm", "300 mm"] })),
            ("thermal.mode", json!("network")),
            ("thermal.network", json!("auto")),
        ],
    }
}

fn planetary() -> Drive {
    Drive {
        file: "examples/planetary-reducer/gearbox.yaml",
        gear: "reducing",
        speed: 3000.0,
        torque: 2.9,
        set: vec![("thermal.mode", json!("network")), ("thermal.network", json!("auto"))],
    }
}

/// A spiral bevel stage before a helical one.
fn bevel_helical() -> Drive {
    Drive {
        file: "framework/workbench/src/form/layouts/bevel-helical.yaml",
        gear: "only",
        speed: 1500.0,
        torque: 45.0,
        set: vec![
            ("housing.outside", json!({ "box": ["350 mm", "200 mm", "300 mm"] })),
            ("thermal.mode", json!("network")),
            ("thermal.network", json!("auto")),
        ],
    }
}

/// A worm drive, which loses more than a tenth of its power.
fn worm() -> Drive {
    Drive {
        file: "examples/worm-drive/gearbox.yaml",
        speed: 1000.0,
        torque: 5.0,
        ..bevel_helical()
    }
}

/// A point at rest: temperatures and heat of its network, loss of every part.
struct Rest {
    transmission: Transmission,
    steady: Steady,
    losses: Vec<f64>,
}

impl Rest {
    fn temperature(&self, node: &str) -> f64 {
        let names = self.transmission.network().unwrap().names();
        self.steady.temperatures[names.iter().position(|n| n == node).unwrap()]
    }
}

impl Drive {
    fn with(mut self, path: &'static str, value: Value) -> Self {
        self.set.push((path, value));
        self
    }

    fn choice(&self) -> Choice {
        let overrides = self.set.iter().map(|(path, value)| ((*path).to_owned(), value.clone()));
        Choice {
            overrides: overrides.collect(),
            ..Choice::default()
        }
    }

    fn transmission(&self, language: &Language) -> Transmission {
        let gearbox = Gearbox::read(language, &common::file(self.file)).unwrap();
        gearbox.transmission(language, &self.choice()).unwrap()
    }

    /// Does something with the point.
    fn point<T>(&self, transmission: &Transmission, act: impl FnOnce(&Moment<'_>) -> T) -> T {
        let case = transmission.case(self.gear, &["input"], &["input"]).unwrap();
        let (speeds, torques) = ([self.speed * RPM], [self.torque]);
        let point = Point {
            speeds: &speeds,
            torques: &torques,
            ..Point::default()
        };
        let around = Surroundings::default();
        act(&Moment {
            case: &case,
            point: &point,
            around: &around,
        })
    }

    fn rest(&self, language: &Language) -> Rest {
        let transmission = self.transmission(language);
        let (steady, losses) = self.point(&transmission, |moment| {
            let mut scratch = transmission.scratch(moment.case);
            let steady = transmission.steady(moment, &mut scratch).unwrap();
            let solution = transmission.evaluate(moment.case, moment.point, &steady.temperatures, &mut scratch);
            let losses = solution.watts().to_vec();
            (steady, losses)
        });
        Rest {
            transmission,
            steady,
            losses,
        }
    }
}

#[test]
fn the_heat_of_every_part_is_counted_once_and_leaves() {
    let language = common::language();
    for drive in [two_speed(), planetary(), bevel_helical(), worm()] {
        let rest = drive.rest(&language);
        assert_eq!(rest.steady.outcome, Outcome::Converged);
        let loss: f64 = rest.losses.iter().sum();
        assert!(loss > 50.0, "{loss}");
        let came: f64 = rest.steady.heat.iter().sum();
        assert!((came - loss).abs() < 1e-7 * loss, "{came} {loss}");
        assert!(rest.steady.residual.abs() < 1e-9 * loss, "{}", rest.steady.residual);
        assert!((rest.steady.leaving.held[0] - came).abs() < 1e-9 * loss);
        let ambient = rest.steady.temperatures[0];
        for (name, t) in rest
            .transmission
            .network()
            .unwrap()
            .names()
            .iter()
            .zip(&rest.steady.temperatures)
            .skip(1)
        {
            assert!(*t > ambient && *t < 200.0, "{name} {t}");
        }
    }
}

#[test]
fn loaded_gears_are_warmer_than_their_oil_and_oil_is_warmer_than_the_casing() {
    let language = common::language();
    for (drive, bodies) in [
        (two_speed(), &["input", "intermediate", "output", "G3"][..]),
        (planetary(), &["sun_shaft", "planet"][..]),
        (bevel_helical(), &["input", "intermediate"][..]),
        (worm(), &["worm"][..]),
    ] {
        let rest = drive.rest(&language);
        for body in bodies {
            assert!(rest.temperature(body) > rest.temperature("sump"), "{body}");
        }
        assert!(rest.temperature("sump") > rest.temperature("casing"));
    }
}

/// Rise of the oil above the surroundings against that of one balance of the whole housing, in free convection with radiation as
/// well: 43.4 K against 41.9 K at the transmission of the car, 54.8 K against 54.2 K at the reducer.
#[test]
fn the_oil_is_about_as_warm_as_in_one_balance_of_the_housing() {
    let language = common::language();
    for drive in [two_speed(), planetary()] {
        let network = drive.rest(&language).temperature("sump") - 20.0;
        let lumped = drive
            .with("thermal.mode", json!("balance"))
            .with("thermal.heat_dissipation", json!({ "casing": { "type": "textbook" } }));
        let transmission = lumped.transmission(&language);
        let one = lumped.point(&transmission, |moment| {
            let mut scratch = transmission.scratch(moment.case);
            let found = transmission.equilibrium(moment.case, moment.point, &mut scratch);
            found.oil().unwrap() - 20.0
        });
        let ratio = network / one;
        assert!((0.5..2.0).contains(&ratio), "{network} K against {one} K");
    }
}

#[test]
fn every_mesh_heats_its_gears_bearings_heat_themselves_and_churning_heats_the_oil() {
    let language = common::language();
    for drive in [two_speed(), planetary(), bevel_helical(), worm()] {
        let transmission = drive.transmission(&language);
        let network = transmission.network().unwrap();
        let names = network.names();
        for (i, part) in transmission.parts().iter().enumerate() {
            match (network.heat(i), part.kind) {
                (HeatPath::Gears(_), PartKind::Mesh(_)) => {}
                (HeatPath::Nodes(nodes), _) => {
                    assert_eq!(nodes.len(), 1, "{}", part.path);
                    let node = names[nodes[0]].as_str();
                    match part.path.split_once('.').unwrap() {
                        ("bearings", id) => assert_eq!(node, id),
                        ("seals", _) => assert_ne!(node, "sump"),
                        _ => assert_eq!(node, "sump", "{}", part.path),
                    }
                }
                (way, _) => panic!("{}: {way:?}", part.path),
            }
        }
    }
}

#[test]
fn numbers_that_were_laid_out_can_be_changed_by_path() {
    let language = common::language();
    let gearbox = Gearbox::read(&language, &common::file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let resolved = gearbox.resolve(&language, &two_speed().choice()).unwrap();
    let path = "thermal.network.links.B1_casing.conductance";
    // 80 W/(m K) times 47 mm.
    assert_eq!(lookup(&resolved.value, path).and_then(Value::as_f64), Some(3.76));
    assert_eq!(*resolved.source_of(path), ValueSource::Network);
    let (unit, least, _) = language.number_at(&resolved.value, path).unwrap();
    assert_eq!((unit.symbol, least), ("W/K", 0.0));

    let free = two_speed().rest(&language);
    let bound = two_speed().with(path, json!("0.1 W/K")).rest(&language);
    assert!(
        bound.temperature("B1") > free.temperature("B1") + 2.0,
        "{} {}",
        bound.temperature("B1"),
        free.temperature("B1")
    );
    // A pattern meets many, a capacity changes nothing at rest, and what the recipe reads may be changed as well.
    let both = two_speed()
        .with("thermal.network.links.*.model.flanks", json!(2))
        .rest(&language);
    let over = |rest: &Rest| rest.temperature("input") - rest.temperature("sump");
    assert!(over(&both) < 0.9 * over(&free), "{} {}", over(&both), over(&free));
    let heavy = two_speed()
        .with("thermal.network.nodes.sump.heat_capacity", json!("1e5 J/K"))
        .rest(&language);
    assert!((heavy.temperature("sump") - free.temperature("sump")).abs() < 1e-6);
    let more = two_speed().with("housing.oil.volume", json!("2.4 l"));
    let resolved = gearbox.resolve(&language, &more.choice()).unwrap();
    let capacity = lookup(&resolved.value, "thermal.network.nodes.sump.heat_capacity").unwrap();
    assert_eq!(capacity.as_f64(), Some(4212.0));
}

#[test]
fn an_override_that_meets_nothing_or_does_not_fit_is_reported() {
    let language = common::language();
    let gearbox = Gearbox::read(&language, &common::file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    for (path, value, said) in [
        (
            "thermal.network.links.B9_casing.conductance",
            json!(1.0),
            "`thermal.network.links` has no `B9_casing`",
        ),
        ("thermal.network.links.B1_casing.conductance", json!(-1.0), "-1"),
    ] {
        let drive = two_speed().with(path, value);
        let said_was = gearbox.resolve(&language, &drive.choice()).unwrap_err().render();
        assert!(said_was.contains(said), "{said_was}");
    }
}

#[test]
fn a_long_march_ends_where_the_network_rests() {
    let language = common::language();
    for drive in [two_speed(), planetary()] {
        let rest = drive.rest(&language);
        let t = &rest.transmission;
        let network = t.network().unwrap();
        let (temperatures, heats) = drive.point(t, |moment| {
            let mut scratch = t.batch_scratch(moment.case);
            let start = network.start(None, moment.around);
            let mut march = March::new(t, network, start, Scheme::Implicit, StepSize::Adaptive(0.1));
            let heats = march.advance(moment, 2e5, &mut scratch).unwrap();
            (march.temperatures, heats)
        });
        for (end, rest) in temperatures.iter().zip(&rest.steady.temperatures) {
            assert!((end - rest).abs() < 0.1, "{end} {rest}");
        }
        assert!(heats.residual().abs() < 1e-9 * heats.heat_input());
    }
}

#[test]
fn grease_keeps_a_bearing_from_the_oil_and_copies_count() {
    let language = common::language();
    let drive = planetary();
    let gearbox = Gearbox::read(&language, &common::file(drive.file)).unwrap();
    let value = gearbox.resolve(&language, &drive.choice()).unwrap().value;
    let links = &value["thermal"]["network"]["links"];
    assert!(links.get("I1_sump").is_none() && links.get("pin_sump").is_some());
    // Three planets: three pins between planets and carrier, three pairs of teeth at a time, all teeth fling oil off.
    let conductance = |link: &str| links[link]["conductance"].as_f64().unwrap();
    assert_eq!(conductance("pin_planet"), 4.32);
    assert_eq!(conductance("pin_carrier"), 4.8);
    assert_eq!(conductance("sun_planet"), 30.0);
    assert_eq!(links["planets_sump"]["model"]["teeth"].as_f64(), Some(108.0));
    assert_eq!(links["ring_screws"]["between"], json!(["ring_body", "casing"]));
    // The planets on their carrier reach 67.5 + 45 + 2.5 mm.
    assert_eq!(links["sump_casing"]["shaft"], "carrier");
    assert_eq!(links["sump_casing"]["model"]["tip_diameter"].as_f64(), Some(0.115));
}

#[test]
fn sources_of_heat_come_into_oil_and_casing() {
    let language = common::language();
    let drive = planetary().with(
        "thermal.sources",
        json!({ "motor": { "heat": "30 W" }, "inverter": { "heat": "5 W", "into": "oil" } }),
    );
    let rest = drive.rest(&language);
    let loss: f64 = rest.losses.iter().sum();
    assert!((rest.steady.leaving.held[0] - loss - 35.0).abs() < 1e-6);
}

#[test]
fn the_models_of_a_steady_state_are_seen_once() {
    let language = common::language();
    let gearbox = Gearbox::read(&language, &common::file("examples/electric-drive-unit/gearbox.yaml")).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let field = Field::Grid {
        torques: vec![40.0, 80.0],
        speeds: vec![2000.0 * RPM, 6000.0 * RPM],
    };
    let mut points = Points::at_reference(&t, &t.states()[0].name, field);
    points.oil = OilTemperature::Network;
    let solved = run_grid(&t, &points, &|_| true).unwrap().unwrap();
    assert!(solved.points.iter().all(|point| point.loss.is_some()));
    assert_eq!(solved.seen.iter().map(|seen| seen.seen).max(), Some(4));
}

/// The drive unit with its own network, and examples with an automatic one.
fn several(language: &Language) -> [(Transmission, &'static str); 3] {
    let unit = Drive {
        file: "examples/electric-drive-unit/gearbox.yaml",
        gear: "only",
        speed: 0.0,
        torque: 0.0,
        set: Vec::new(),
    };
    [unit, two_speed(), planetary()].map(|drive| (drive.transmission(language), drive.gear))
}

/// Torque of the transmission of a gear state over that of the drive unit.
fn scale(gear: &str) -> f64 {
    match gear {
        "reducing" => 0.03,
        "first" => 0.1,
        _ => 1.0,
    }
}

#[test]
fn steady_states_have_the_bits_of_single_points_in_any_batch() {
    let language = common::language();
    for (t, gear) in &several(&language) {
        let case = t.case(gear, &["input"], &["input"]).unwrap();
        // Both senses, standstill, no torque, and loads at which no steady state is in the range.
        let scale = scale(gear);
        let given: Vec<[[f64; 1]; 2]> = (0..36)
            .map(|i| {
                let speed = f64::from(i * 7 % 12) * 900.0 * RPM;
                [[speed], [scale * f64::from(i * 11 % 36 - 9) * 12.0]]
            })
            .collect();
        let points: Vec<Point<'_>> = given
            .iter()
            .map(|[speeds, torques]| Point {
                speeds,
                torques,
                ..Point::default()
            })
            .collect();
        let around = Surroundings::default();
        let moment = |point| Moment {
            case: &case,
            point,
            around: &around,
        };
        let moments: Vec<Moment<'_>> = points.iter().map(moment).collect();
        let mut scratch = t.scratch(&case);
        let single: Vec<Steady> = moments.iter().map(|m| t.steady(m, &mut scratch).unwrap()).collect();
        let sound = single.iter().filter(|steady| steady.outcome == Outcome::Converged);
        assert!(sound.count() > 20, "{gear}");
        for size in [1, 3, 7, 16, 36] {
            let mut together = t.batch_scratch(&case);
            let batches = moments.chunks(size);
            let found: Vec<Steady> = batches
                .flat_map(|some| t.steady_states(some, &mut together).unwrap())
                .collect();
            assert_eq!(found, single, "{gear} {size}");
            assert_eq!(together.take_totals(), scratch.totals, "{gear} {size}");
        }
        let mut turned = moments.clone();
        turned.reverse();
        let mut found = t.steady_states(&turned, &mut t.batch_scratch(&case)).unwrap();
        found.reverse();
        assert_eq!(found, single, "{gear}");
    }
}

#[test]
fn a_map_of_a_network_has_the_points_of_solve() {
    let language = common::language();
    for (t, gear) in &several(&language) {
        let scale = scale(gear);
        let torques: Vec<f64> = (0..5).map(|i| scale * (f64::from(i) * 40.0 - 60.0)).collect();
        let speeds: Vec<f64> = (0..9).map(|i| f64::from(i) * 700.0 * RPM).collect();
        let field = Field::Grid {
            torques: torques.clone(),
            speeds: speeds.clone(),
        };
        let mut points = Points::at_reference(t, gear, field);
        points.oil = OilTemperature::Network;
        let map = run_grid(t, &points, &|_| true).unwrap().unwrap();
        for (i, point) in map.points.iter().enumerate() {
            points.field = Field::List(vec![Given::new(torques[i / speeds.len()], speeds[i % speeds.len()])]);
            let alone = run_grid(t, &points, &|_| true).unwrap().unwrap();
            assert_eq!(*point, alone.points[0], "{gear} {i}");
        }
    }
}

#[test]
fn a_program_without_one_recipe_says_so() {
    let recipe = NetworkRecipe {
        meaning: "Another.",
        generate: |_, _| Ok(json!({})),
        origin: gearloss_framework::origin!(),
    };
    let language = Language::new(Registry::linked().unwrap().with_recipes([recipe])).unwrap();
    let gearbox = Gearbox::read(&language, &common::file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let said = gearbox.resolve(&language, &two_speed().choice()).unwrap_err().render();
    assert!(
        said.contains("thermal.network: two crates generate networks") && said.contains("help:"),
        "{said}"
    );
}

#[test]
fn a_conductance_that_turns_negative_is_reported_with_its_link() {
    let language = common::language();
    let drive = two_speed().with(
        "thermal.network.links.sump_casing.model",
        json!({ "type": "formula", "formula": "-1 * temperature_1" }),
    );
    let rest = drive.rest(&language);
    assert_eq!(rest.steady.outcome, Outcome::Undefined);
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(["solve", "--gear", "first", "--speed", "6000 rpm", "--torque", "15 Nm"])
        .args(["--set", "thermal.mode=network", "--set", "thermal.network=auto"])
        .args(["--set", "housing.outside={ box: [350 mm, 200 mm, 300 mm] }"])
        .args([
            "--set",
            "thermal.network.links.sump_casing.model={ type: formula, formula: -1 * temperature_1 }",
        ])
        .arg(common::file("examples/two-speed-ev/gearbox.yaml"))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(
        text.contains("thermal.network.links.sump_casing: ") && text.contains("negative"),
        "{text}"
    );
}

#[test]
fn a_circuit_of_oil_that_does_not_close_is_reported_and_no_exchanger_cools_the_air() {
    let language = common::language();
    let gearbox = Gearbox::read(&language, &common::file("examples/electric-drive-unit/gearbox.yaml")).unwrap();
    let with = |path: &str, value: Value| Choice {
        overrides: vec![(path.to_owned(), value)],
        ..Choice::default()
    };
    let built = gearbox.transmission(&language, &Choice::default()).unwrap();
    assert!(
        built.warnings.iter().all(|w| !w.message.contains("oil flow of")),
        "{:?}",
        built.warnings
    );
    let half = with("thermal.network.flows.to_gears.share", json!(0.25));
    let open = gearbox.transmission(&language, &half).unwrap();
    let told: Vec<&str> = open.warnings.iter().map(|w| w.path.as_str()).collect();
    for node in ["sump", "exchanger_outlet"] {
        assert!(
            told.contains(&format!("thermal.network.nodes.{node}").as_str()),
            "{told:?}"
        );
    }
    let air = with("thermal.network.exchangers.cooler.to", json!("ambient"));
    let refused = gearbox.transmission(&language, &air).err().unwrap();
    assert!(
        refused.first().contains("`ambient` has a prescribed temperature"),
        "{}",
        refused.first()
    );
}

/// A pair face to face whose preload grows as it warms its shaft: up to a closing when cold there is a steady state, whose temperatures rise
/// faster and faster with it; beyond, the bodies warm past every temperature.
#[test]
fn a_pair_that_tightens_as_it_warms_may_have_no_steady_state() {
    let at = |closing: f64| {
        let preload = json!({ "closing": format!("{closing} um"), "housing": { "material": "cast_iron" } });
        let drive = Drive {
            file: "examples/industrial-reducer/gearbox.yaml",
            gear: "only",
            speed: 1480.0,
            torque: 290.0,
            set: vec![
                ("thermal.mode", json!("network")),
                ("thermal.network", json!("auto")),
                ("bearings.B1.preload", preload),
            ],
        };
        drive.rest(&common::language())
    };
    let shaft = |closing: f64| {
        let found = at(closing);
        assert_eq!(found.steady.outcome, Outcome::Converged, "{closing}");
        found.temperature("input")
    };
    let [cold, warm, hot] = [0.0, 6.0, 12.0].map(shaft);
    assert!(warm > cold && hot - warm > 1.5 * (warm - cold), "{cold} {warm} {hot}");
    let none = at(20.0);
    assert_eq!(none.steady.outcome, Outcome::NoneBelowMaximum);
    let oil = none.steady.temperatures[none.transmission.network().unwrap().oil()];
    assert!((149.0..260.0).contains(&oil), "{oil}");
}
