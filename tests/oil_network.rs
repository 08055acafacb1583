//! The oil network in a gearbox: flows of models, torque of the pump and of rotating channels, pockets, heat carried by flows.

use crate::common::{self, RPM, language};
use gearloss_framework::evaluate::{GivenQuantity, Noting, Point, Solution};
use gearloss_framework::files::Disk;
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::testing::assert_close;
use gearloss_framework::thermal::network::{Moment, Surroundings};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::checked::CheckedGearbox;
use serde_json::{Value, json};

const L_MIN: f64 = 1e-3 / 60.0;

fn transmission(overrides: &[(&str, Value)]) -> Transmission {
    let language = language();
    let gearbox = Gearbox::read(&language, &common::file("tests/oil_network/gearbox.yaml")).unwrap();
    let choice = Choice {
        overrides: overrides
            .iter()
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect(),
        ..Choice::default()
    };
    gearbox.transmission(&language, &choice).unwrap()
}

fn solve<T>(t: &Transmission, speed: f64, oil: f64, read: impl FnOnce(&Solution<'_>) -> T) -> T {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[speed * RPM],
        torques: &[40.0],
        ..Point::default()
    };
    read(&t.evaluate(&case, &point, &[oil], &mut scratch))
}

fn part(t: &Transmission, path: &str) -> usize {
    t.parts().iter().position(|part| part.path == path).unwrap()
}

fn reading(t: &Transmission, solution: &Solution<'_>, path: &str, name: &str) -> f64 {
    let readings = solution.readings(part(t, path));
    readings.iter().find(|reading| reading.name == name).unwrap().value
}

#[test]
fn losses_follow_from_the_flows() {
    let t = transmission(&[]);
    for speed in [600.0, 3000.0, -3000.0, 6000.0] {
        solve(&t, speed, 80.0, |solution| {
            let supply = solution.oil_supply().unwrap();
            let flow = |name: &str| {
                let path = format!("oil_network.{name}");
                supply.elements.iter().find(|element| element.path == path).unwrap()
            };
            let watts = |path: &str| solution.part(part(&t, path)).watts();
            // Junctions neither gain nor lose oil.
            let pump = flow("pumps.main");
            let consumers = ["nozzles.J1", "nozzles.J2", "nozzles.B3_feed", "pipes.branch"];
            let consumed: f64 = consumers.iter().map(|name| flow(name).flow).sum();
            assert!((pump.flow - pump.relieved.unwrap() - consumed).abs() < 1e-12 * pump.flow);
            assert!((flow("pipes.branch").flow - flow("rotating_channels.bore").flow).abs() < 1e-12 * pump.flow);
            // The pump takes displacement times pressure rise, through its efficiency.
            let turns = speed.abs() / 60.0;
            assert_close(pump.power.unwrap(), 3e-6 * turns * pump.rise, 1e-12);
            assert_close(watts("auxiliaries.oil_pump"), pump.power.unwrap() / 0.85, 1e-12);
            // Oil leaves the bore with the speed of its outlet, without swirl at the inlet.
            let w = solution.speed(t.members().iter().position(|m| m == "middle_shaft").unwrap());
            let bore = flow("rotating_channels.bore");
            let rho = reading(&t, solution, "auxiliaries.bore", "rho");
            assert_close(watts("auxiliaries.bore"), rho * bore.flow * (w * 15e-3).powi(2), 1e-12);
            assert_close(
                reading(&t, solution, "meshes.M1.drag.injection", "injected") * L_MIN,
                flow("nozzles.J1").flow,
                1e-12,
            );
            // The pocket, not the sump, determines the oil height of this bearing.
            let pocket = solution.pockets().next().unwrap();
            assert_close(pocket.inflow, flow("nozzles.B3_feed").flow, 1e-12);
            assert!(pocket.height > 0.0);
            assert_close(
                reading(&t, solution, "bearings.B3", "oil_height") * 1e-3,
                pocket.height,
                1e-12,
            );
            assert_eq!(reading(&t, solution, "bearings.B4", "oil_height"), 0.0);
            assert!(solution.residual().unwrap().abs() < 1e-9 * solution.input_power().unwrap());
        });
    }
}

/// The flow of a nozzle, stated in the model instead, gives the same loss.
#[test]
fn a_nozzle_is_a_typed_flow() {
    let t = transmission(&[]);
    let (named, flow) = solve(&t, 3000.0, 80.0, |solution| {
        let injected = reading(&t, solution, "meshes.M2.drag.injection", "injected");
        (solution.part(part(&t, "meshes.M2.drag.injection")).watts(), injected)
    });
    let model = json!({ "type": "mauz_injection", "flow": format!("{flow} l/min") });
    let typed = transmission(&[("meshes.M2.drag.injection", model)]);
    let watts = solve(&typed, 3000.0, 80.0, |solution| {
        solution.part(part(&typed, "meshes.M2.drag.injection")).watts()
    });
    assert_close(watts, named, 1e-12);
}

#[test]
fn points_of_a_map_have_the_bits_of_single_points() {
    let t = transmission(&[]);
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let speeds: Vec<[f64; 1]> = (0..LANES).map(|i| [(200.0 + 400.0 * i as f64) * RPM]).collect();
    let oils: Vec<[f64; 1]> = (0..LANES).map(|i| [-20.0 + 8.0 * i as f64]).collect();
    let points: Vec<Point<'_>> = speeds
        .iter()
        .map(|speeds| Point {
            speeds,
            torques: &[40.0],
            ..Point::default()
        })
        .collect();
    let mut scratch = t.batch_scratch(&case);
    let block = t.evaluate_together(&case, &points, &|lane| &oils[lane], Noting::Muted, &mut scratch);
    let together = block.losses().to_vec();
    let mut alone = t.scratch(&case);
    for (i, point) in points.iter().enumerate() {
        let loss = t.evaluate(&case, point, &oils[i], &mut alone).loss().unwrap();
        assert_eq!(loss.to_bits(), together[i].to_bits(), "{i}");
    }
}

#[test]
fn derivatives_pass_through_the_network() {
    let t = transmission(&[]);
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let tolerance = Tolerance {
        power: 1e-14,
        ..Tolerance::default()
    };
    let loss = |speed: f64, oil: f64| {
        let point = Point {
            speeds: &[speed],
            torques: &[40.0],
            tolerance,
            ..Point::default()
        };
        t.evaluate(&case, &point, &[oil], &mut t.scratch(&case)).loss().unwrap()
    };
    for (speed, oil) in [(100.0, 20.0), (300.0, 80.0), (500.0, 60.0)] {
        let point = Point {
            speeds: &[speed],
            torques: &[40.0],
            ..Point::default()
        };
        for (given, h) in [(GivenQuantity::Speed(0), 0.01), (GivenQuantity::OilTemperature, 0.02)] {
            let slopes = t
                .slopes(&case, &point, oil, false, given, &mut t.scratch(&case))
                .unwrap();
            let difference = match given {
                GivenQuantity::OilTemperature => loss(speed, oil + h) - loss(speed, oil - h),
                _ => loss(speed + h, oil) - loss(speed - h, oil),
            };
            // The derivatives of the parts nearly cancel over the temperature.
            let size: f64 = slopes.parts.iter().map(|part| part.value.abs()).sum();
            assert!(
                (slopes.loss.value - difference / (2.0 * h)).abs() < 1e-5 * size,
                "{speed} {oil} {given:?}"
            );
        }
    }
}

/// The oil of a nozzle warms by the heat of a source over its mass flow times specific heat.
#[test]
fn flows_of_the_network_carry_heat() {
    let network = json!({
        "nodes": { "sump": { "oil": true, "temperature": 70.0 }, "hot": {} },
        "flows": { "out": { "from": "sump", "to": "hot", "element": "nozzles.J2" }, "back": { "from": "hot", "to": "sump", "element": "nozzles.J2" } },
        "sources": { "motor": { "heat": "200 W", "into": "hot" } },
        "links": {
            "spray": { "between": ["hot", "sump"],
                "model": { "type": "spray", "nozzle": "J1", "area": "1 m2", "alpha": "100000 W/(m2 K)" } },
            "leg": { "between": ["sump", "ambient"], "conductance": "1 W/K" },
        },
    });
    let t = transmission(&[("thermal.mode", json!("network")), ("thermal.network", network)]);
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[3000.0 * RPM],
        torques: &[40.0],
        ..Point::default()
    };
    let around = Surroundings::default();
    let moment = Moment {
        case: &case,
        point: &point,
        around: &around,
    };
    let steady = t.steady(&moment, &mut scratch).unwrap();
    let hot = t
        .network()
        .unwrap()
        .names()
        .iter()
        .position(|name| name == "hot")
        .unwrap();
    let warmer = steady.temperatures[hot] - 70.0;
    let supply = t
        .evaluate(&case, &point, &steady.temperatures, &mut scratch)
        .oil_supply()
        .unwrap();
    let flow = |name: &str| supply.elements.iter().find(|e| e.path.ends_with(name)).unwrap().flow;
    let [density, heat] = t.network().unwrap().oil_properties(70.0);
    // A large surface takes all that the stream can carry.
    let conductance = density * heat * (flow("J1") + flow("J2"));
    assert_close(warmer, 200.0 / conductance, 2e-3);
}

/// Paths and messages of what the network lacks at the rated speed.
fn shortages(file: &str, overrides: &[(&str, Value)]) -> Vec<(String, String)> {
    let overrides = overrides
        .iter()
        .map(|(path, value)| ((*path).to_owned(), value.clone()));
    let choice = Choice {
        overrides: overrides.collect(),
        ..Choice::default()
    };
    let checked = CheckedGearbox::read(&language(), &Disk::shared(), &common::file(file), &choice).unwrap();
    let found = checked.short_of_oil().into_iter();
    found.map(|warning| (warning.path, warning.message)).collect()
}

#[test]
fn shortages_have_their_numbers() {
    assert_eq!(shortages("tests/oil_network/gearbox.yaml", &[]), []);
    let found = shortages("tests/cases/doubtful_oil_network/input.yaml", &[]);
    for (path, words) in [
        (
            "oil_network.pumps.main",
            "its inlet would have -9.110 bar absolute, below 0.7 bar",
        ),
        (
            "oil_network.pipes.intake",
            "8.0 mm below the oil surface at -52.0 mm; two diameters are 24.0 mm",
        ),
        ("oil_network.chambers.room", "above the allowed 40.0 mm"),
        ("oil_network.nozzles.J2", "it has no flow"),
    ] {
        let message = found
            .iter()
            .find(|(own, _)| own == path)
            .map(|(_, message)| message.as_str());
        assert!(
            message.is_some_and(|message| message.contains(words)),
            "{path}: {message:?}"
        );
    }
    let always = [("oil_network.pumps.main.relief.opens", json!("0.01 bar"))];
    let found = shortages("tests/oil_network/gearbox.yaml", &always);
    assert!(
        found
            .iter()
            .any(|(path, message)| path == "oil_network.pumps.main" && message.contains("never closes")),
        "{found:?}"
    );
    // The pipe is its only inlet.
    let high = [("oil_network.pipes.intake.inlet_height", json!("-70 mm"))];
    let found = shortages("tests/oil_network/gearbox.yaml", &high);
    assert!(
        found
            .iter()
            .any(|(_, message)| message.contains("10.0 mm above the oil surface")),
        "{found:?}"
    );
}

/// A wider nozzle takes more, and a change of the network in place is a new build.
#[test]
fn overrides_reach_the_network() {
    let flow = |t: &Transmission| {
        solve(t, 3000.0, 80.0, |solution| {
            reading(t, solution, "meshes.M1.drag.injection", "injected")
        })
    };
    let wider = [("oil_network.nozzles.J1.diameter", json!("1.2 mm"))];
    assert!(flow(&transmission(&wider)) > 1.2 * flow(&transmission(&[])));
    let aerated = [("oil_network.air", json!(0.1))];
    assert!(flow(&transmission(&aerated)) < 0.99 * flow(&transmission(&[])));
}

/// What stands in a chamber is missing from the sump: no oil is lost, and the level at rest, which churning takes, stays.
#[test]
fn chambers_lower_the_level_while_rotating() {
    let text = std::fs::read_to_string(common::file("tests/oil_network/gearbox.yaml")).unwrap();
    let levels = |chamber: &str, to: &str| {
        let text = text
            .replace(
                "models:\n",
                "models:\n  gear_drag: { churning: { type: changenet_2011 } }\n",
            )
            .replace("level: -80 mm", "level: -70 mm")
            .replace("oil_network:\n", &format!("oil_network:\n{chamber}"))
            .replace(
                "count: 2, feeds: [meshes.M2]",
                &format!("count: 2, feeds: [meshes.M2]{to}"),
            );
        let (language, files) = (language(), gearloss::api::InMemory::default().shared());
        let path = std::path::Path::new("");
        let gearbox = Gearbox::from_text(&language, &files, &text, "chamber.yaml", path);
        let gearbox = gearbox.unwrap_or_else(|found| panic!("{}", found.render()));
        let t = gearbox.transmission(&language, &Choice::default());
        let t = t.unwrap_or_else(|found| panic!("{}", found.render()));
        let space = t.oil_space().unwrap().space().clone();
        let levels = solve(&t, 3000.0, 80.0, |solution| solution.oil_levels().unwrap());
        (levels, space)
    };
    let room = "  chambers: { room: { floor: 20 cm2, drain: { diameter: 5 mm, length: 8 mm } } }\n";
    let ((without, _), (with, space)) = (levels("", ""), levels(room, ", to: room"));
    assert_eq!(with.at_rest.to_bits(), without.at_rest.to_bits());
    assert!(with.running < without.running - 1e-4, "{with:?} {without:?}");
    let [own, other] = [with, without].map(|levels| levels.estimate.unwrap());
    assert_eq!(other.held, 0.0);
    assert!(own.held > 1e-5, "{own:?}");
    let kept = space.volume(with.running)[0] + own.missing + own.held;
    assert!((kept / own.volume - 1.0).abs() < 1e-11, "{own:?}");
    assert!(own.band.low() <= with.running && with.running <= own.band.high());
}

/// The gearbox of the tests with other texts in its place.
fn replaced(texts: &[(&str, &str)]) -> Transmission {
    let text = std::fs::read_to_string(common::file("tests/oil_network/gearbox.yaml")).unwrap();
    let text = texts.iter().fold(text, |text, (old, new)| {
        assert!(text.contains(old), "{old}");
        text.replace(old, new)
    });
    let (language, files) = (language(), gearloss::api::InMemory::default().shared());
    let gearbox = Gearbox::from_text(&language, &files, &text, "replaced.yaml", std::path::Path::new(""));
    let gearbox = gearbox.unwrap_or_else(|found| panic!("{}", found.render()));
    let t = gearbox.transmission(&language, &Choice::default());
    t.unwrap_or_else(|found| panic!("{}", found.render()))
}

fn solve_inclined<T>(t: &Transmission, degrees: f64, read: impl FnOnce(&Solution<'_>) -> T) -> T {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[3000.0 * RPM],
        torques: &[40.0],
        inclination: degrees.to_radians(),
        ..Point::default()
    };
    read(&t.evaluate(&case, &point, &[80.0], &mut scratch))
}

/// Junctions and mouths whose places are stated go up and down with the housing, while it travels as in one that stands inclined.
#[test]
fn heights_of_the_network_follow_the_inclination() {
    let with = |place: &str, keys: &str| {
        let housing = format!("volume: 1.2 l }}\n{keys}");
        replaced(&[
            ("volume: 2.5 l, level: -80 mm }\n", &housing),
            (
                "suction: { height: -90 mm }",
                &format!("suction: {{ height: -90 mm{place} }}"),
            ),
        ])
    };
    let suction = |t: &Transmission, degrees: f64| {
        solve_inclined(t, degrees, |solution| {
            let supply = solution.oil_supply().unwrap();
            (supply.junctions[0].1, solution.oil_levels().unwrap().running)
        })
    };
    for (place, height_at, travel, stated) in [
        // The datum is the origin of the housing.
        (", x: 20 mm, y: 250 mm", [0.0, 0.25, -0.09], "+y", "bank"),
        (", x: -60 mm, y: 95 mm", [-0.06, 0.095, -0.09], "+x", "grade"),
    ] {
        let travels = with(place, &format!("  travel: \"{travel}\"\n"));
        let unplaced = with("", &format!("  travel: \"{travel}\"\n"));
        let level = suction(&with(place, ""), 0.0);
        assert_eq!(suction(&travels, 0.0), level);
        assert_eq!(suction(&with("", ""), 0.0), level);
        let said = |t: &Transmission| {
            t.warnings
                .iter()
                .any(|found| found.code == Some(gearloss_framework::codes::LEVEL_HEIGHT))
        };
        assert!(said(&unplaced));
        for degrees in [10.0_f64, -6.0] {
            let own = suction(&travels, degrees);
            let of_stated = suction(&with(place, &format!("  {stated}: {degrees} deg\n")), 0.0);
            assert!((own.0 - of_stated.0).abs() < 1e-3, "{own:?} {of_stated:?}");
            // The pressure differs by the column between both heights.
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let [x, y, z] = height_at;
            let height = sine * if travel == "+x" { x } else { y } + cosine * z;
            let flat = suction(&unplaced, degrees);
            let rho = solve_inclined(&travels, degrees, |solution| {
                reading(&travels, solution, "auxiliaries.bore", "rho")
            });
            let column = rho * 9.80665 * (z - height);
            assert!(
                (own.0 - flat.0 - column).abs() < 0.02 * column.abs(),
                "{own:?} {flat:?} {column}"
            );
        }
    }
}

/// A chamber holds the depth over the middle of its floor; its holes are at one side of it.
#[test]
fn chambers_hold_more_with_their_holes_uphill() {
    let room = "  chambers: { room: { floor: 20 cm2, drain_y: 30 mm, drain: { diameter: 5 mm, length: 8 mm } } }\n";
    let t = replaced(&[
        (
            "models:\n",
            "models:\n  gear_drag: { churning: { type: changenet_2011 } }\n",
        ),
        (
            "volume: 2.5 l, level: -80 mm }\n",
            "volume: 1.2 l }\n  travel: \"+y\"\n",
        ),
        ("{ height: -90 mm }", "{ height: -90 mm, y: 0 mm }"),
        ("{ height: 60 mm }", "{ height: 60 mm, y: 0 mm }"),
        ("{ height: 0 mm }", "{ height: 0 mm, y: 0 mm }"),
        ("inlet_height: -112 mm", "inlet_height: -112 mm, inlet_y: 100 mm"),
        ("oil_network:\n", &format!("oil_network:\n{room}")),
        ("count: 2, feeds: [meshes.M2]", "count: 2, feeds: [meshes.M2], to: room"),
    ]);
    for degrees in [0.0_f64, 8.0, -8.0] {
        solve_inclined(&t, degrees, |solution| {
            let supply = solution.oil_supply().unwrap();
            let chamber = &supply.chambers[0];
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let expected = 20e-4 * ((chamber.height + 0.03 * sine) / cosine).max(0.0);
            assert_close(chamber.volume, expected, 1e-12);
            let levels = solution.oil_levels().unwrap();
            let estimate = levels.estimate.unwrap();
            assert_close(estimate.held, expected, 1e-12);
            let space = t.oil_space().unwrap().at(degrees.to_radians());
            let kept = space.volume(levels.running)[0] + estimate.missing + estimate.held;
            assert!((kept / estimate.volume - 1.0).abs() < 1e-10, "{degrees} {levels:?}");
        });
    }
}
