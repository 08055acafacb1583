//! The pieces of work whose instructions are counted.

use std::hint::black_box;
use std::path::Path;

use gearloss_framework::evaluate::{GivenQuantity, Noting, Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use gearloss_plugins as _;
use serde_json::json;

/// rad/s per 1/min.
const RPM: f64 = std::f64::consts::PI / 30.0;

/// A piece of work.
pub struct Piece {
    /// Its name.
    pub name: &'static str,
    /// What it consists of, and how many.
    pub element: &'static str,
    pub elements: u32,
    run: fn(&Language, u32),
}

/// All pieces.
pub const PIECES: [Piece; 8] = [
    Piece {
        name: "map",
        element: "point of the two-speed example, set joint, 16 torques of a speed together",
        elements: 16 * SPEEDS,
        run: map,
    },
    Piece {
        name: "scattered",
        element: "point of the same, each with a speed of its own",
        elements: 16 * SPEEDS,
        run: scattered,
    },
    Piece {
        name: "ehl_mixed",
        element: "point of the electric drive unit, 16 torques of a speed together",
        elements: 16 * FEW_SPEEDS,
        run: ehl_mixed,
    },
    Piece {
        name: "ehl_mixed_loops",
        element: "the same with the torque at the output, where each mesh is in a loop",
        elements: 16 * FEW_SPEEDS,
        run: ehl_mixed_loops,
    },
    Piece {
        name: "balance",
        element: "heat balance of the planetary example",
        elements: SPEEDS,
        run: balance,
    },
    Piece {
        name: "sample",
        element: "transmission built with four other numbers, set joint",
        elements: SPEEDS,
        run: sample,
    },
    Piece {
        name: "point",
        element: "point of the two-speed example, set joint, alone",
        elements: SPEEDS,
        run: single,
    },
    Piece {
        name: "derivative",
        element: "exact derivatives of that point over its torque",
        elements: SPEEDS,
        run: derivative,
    },
];

/// Speeds, heat balances or samples of one call.
const SPEEDS: u32 = 32;
const FEW_SPEEDS: u32 = 2;

/// Does a piece some times.
pub fn run(name: &str, calls: u32) {
    let piece = PIECES.iter().find(|piece| piece.name == name);
    let piece = piece.unwrap_or_else(|| panic!("there is no piece `{name}`"));
    (piece.run)(&Language::linked().unwrap_or_else(|f| panic!("{}", f.render())), calls);
}

fn gearbox(language: &Language, example: &str) -> Gearbox {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let file = examples.join(example).join("gearbox.yaml");
    Gearbox::read(language, &file).unwrap_or_else(|f| panic!("{}", f.render()))
}

fn joint() -> Choice {
    Choice {
        set: Some("joint".to_owned()),
        ..Choice::default()
    }
}

fn build(language: &Language, example: &str, choice: &Choice) -> Transmission {
    let built = gearbox(language, example).transmission(language, choice);
    built.unwrap_or_else(|f| panic!("{}", f.render()))
}

fn of_set(language: &Language) -> Transmission {
    build(language, "two-speed-ev", &joint())
}

fn point<'a>(speeds: &'a [f64], torques: &'a [f64]) -> Point<'a> {
    Point {
        speeds,
        torques,
        flow: PowerFlow::Real,
        ..Point::default()
    }
}

/// Batches over torques of a port, from a speed of the input on. \[Nm, rpm\]
fn batches(t: &Transmission, (gear, port, most, from): (&str, &str, f64, f64), speeds: u32, calls: u32) {
    let case = t.case(gear, &["input"], &[port]).unwrap();
    let mut scratch = t.batch_scratch(&case);
    let torques: [f64; LANES] = std::array::from_fn(|i| most * (1.0 + i as f64) / LANES as f64);
    for call in 0..calls * speeds {
        let speed = [(from + f64::from(call)) * RPM];
        let mut batch = t.batch(&case, &point(&speed, &[0.0]), &[80.0], &mut scratch);
        black_box(batch.solve(&torques).losses());
    }
}

fn map(language: &Language, calls: u32) {
    batches(&of_set(language), ("first", "input", 20.0, 8000.0), SPEEDS, calls);
}

fn drive_unit(language: &Language, port: &str, most: f64, calls: u32) {
    let t = build(language, "electric-drive-unit", &Choice::default());
    let gear = t.states()[0].name.clone();
    batches(&t, (&gear, port, most, 3000.0), FEW_SPEEDS, calls);
}

fn ehl_mixed(language: &Language, calls: u32) {
    drive_unit(language, "input", 300.0, calls);
}

fn ehl_mixed_loops(language: &Language, calls: u32) {
    drive_unit(language, "output", -2700.0, calls);
}

fn scattered(language: &Language, calls: u32) {
    let t = of_set(language);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.batch_scratch(&case);
    for call in 0..calls * SPEEDS {
        let given: [[f64; 2]; LANES] = std::array::from_fn(|i| {
            let place = f64::from(call) + i as f64 / LANES as f64;
            [(8000.0 + place) * RPM, 2.0 + i as f64]
        });
        let points: [Point<'_>; LANES] = std::array::from_fn(|i| point(&given[i][..1], &given[i][1..]));
        let block = t.evaluate_together(&case, &points, &|_| &[80.0], Noting::Counted, &mut scratch);
        black_box(block.losses());
    }
}

fn balance(language: &Language, calls: u32) {
    let t = build(language, "planetary-reducer", &Choice::default());
    let case = t.case("reducing", &["input"], &["output"]).unwrap();
    let mut scratch = t.scratch(&case);
    for call in 0..calls * SPEEDS {
        let speed = [(2000.0 + f64::from(call)) * RPM];
        black_box(t.equilibrium(&case, &point(&speed, &[-16.0]), &mut scratch).oil());
    }
}

fn sample(language: &Language, calls: u32) {
    let gearbox = gearbox(language, "two-speed-ev");
    let variants = Variants::new(language, &gearbox, joint());
    for call in 0..calls * SPEEDS {
        let step = f64::from(call % 97);
        let numbers = [
            ("lubricants.sump.viscosity.kv100", json!(6.0 + 0.01 * step)),
            ("gears.*.surface.rq", json!(0.3 + 0.001 * step)),
            ("housing.oil.level_offset", json!(0.05 * step)),
            ("bearings.*.model.mu_bl", json!(0.12 + 0.0002 * step)),
        ];
        let numbers = numbers.map(|(path, number)| (path.to_owned(), number));
        black_box(variants.build(&numbers).unwrap_or_else(|f| panic!("{}", f.render())));
    }
}

fn single(language: &Language, calls: u32) {
    let t = of_set(language);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    for call in 0..calls * SPEEDS {
        let speed = [(8000.0 + f64::from(call)) * RPM];
        black_box(t.evaluate(&case, &point(&speed, &[10.0]), &[80.0], &mut scratch).loss());
    }
}

fn derivative(language: &Language, calls: u32) {
    let t = of_set(language);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    for call in 0..calls * SPEEDS {
        let speed = [(8000.0 + f64::from(call)) * RPM];
        let given = GivenQuantity::Torque(0);
        let slopes = t.slopes(&case, &point(&speed, &[10.0]), 80.0, false, given, &mut scratch);
        black_box(slopes.unwrap_or_else(|fault| panic!("{fault:?}")).loss);
    }
}
