//! How much work results take, in counts that are the same on every machine: times are in `docs/performance.md`. A count may
//! change with a reason; say it in CHANGELOG.md. Balances of one temperature are counted in `tests/reducer.rs`, a cycle in
//! `tests/cycle.rs`, solvers on published problems in the framework.

#[path = "../benches/common/identification.rs"]
mod identification;
#[path = "../benches/common/long.rs"]
mod long;
#[path = "../benches/common/plate.rs"]
mod plate;

use crate::common::{RPM, contact_work, file, language, two_speed, two_speed_with};
use gearloss_framework::evaluate::{Point, Scratch};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::real::LANES;
use gearloss_framework::resolve::Choice;
use gearloss_framework::thermal::Outcome;
use gearloss_framework::thermal::network::{March, Moment, Scheme, StepSize, Surroundings};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::identify::Settings;
use gearloss_studies::study::Study;
use identification::Prepared;
use serde_json::json;

/// Torques in Nm and speeds in rpm at the input of the two-speed example.
const POINTS: [[f64; 2]; 4] = [[10.0, 8000.0], [2.0, 20000.0], [20.0, 1000.0], [-10.0, 8000.0]];
const STUDY: &str = "examples/two-speed-ev/study.yaml";

fn point<'a>(speeds: &'a [f64], torques: &'a [f64]) -> Point<'a> {
    Point {
        speeds,
        torques,
        ..Point::default()
    }
}

/// The two-speed example under a set of its study.
fn under(set: &str) -> Transmission {
    under_with(set, Vec::new())
}

/// The same with some values changed.
fn under_with(set: &str, overrides: Vec<(String, serde_json::Value)>) -> Transmission {
    let language = language();
    let study = Study::read(&language, &file(STUDY)).unwrap();
    let mut choice = study.choice(Some(set));
    choice.overrides.extend(overrides);
    two_speed(&language).transmission(&language, &choice).unwrap()
}

/// Passes over the loss models and calls of them, at each point in first gear.
fn work(t: &Transmission) -> [(usize, usize); 4] {
    let case = t.case("first", &[], &["input"]).unwrap();
    POINTS.map(|[torque, speed]| {
        let mut scratch = t.scratch(&case);
        let solution = t.evaluate(&case, &point(&[speed * RPM], &[torque]), &[100.0], &mut scratch);
        assert!(solution.is_complete());
        let passes = solution.passes();
        (passes, scratch.calls())
    })
}

/// Laws outside of loops are called once; the bearings of a shaft twice, the cage of the idle gear, whose torque is its own friction, three or
/// four times. In coast (the last point) the mesh of each loop is called with them.
#[test]
fn a_point_takes_few_passes() {
    let of_set = |set: &str| work(&under(set));
    assert_eq!(
        [of_set("iso"), of_set("joint")],
        [
            [(3, 22), (3, 24), (3, 22), (3, 24)],
            [(4, 24), (4, 24), (4, 24), (4, 26)]
        ]
    );
}

/// Whatever is evaluated once is noted. Below 150 N/mm the friction of `iso` does not hang on the load.
#[test]
fn what_is_evaluated_once_is_noted() {
    let t = under_with("iso", vec![("bearings.*.model".to_owned(), json!("none"))]);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let noted = |torque: f64, scratch: &mut Scratch| {
        let solution = t.evaluate(&case, &point(&[4000.0 * RPM], &[torque]), &[100.0], scratch);
        let meshes = t.instances().iter().filter(|i| i.path.starts_with("meshes."));
        let counts: Vec<u32> = meshes
            .flat_map(|i| (0..i.entry.limits.len()).map(|limit| solution.extents()[i.notes.limits() + limit].seen))
            .collect();
        (solution.passes(), counts)
    };
    let (passes, few) = noted(0.5, &mut scratch);
    let (more, many) = noted(20.0, &mut scratch);
    assert_eq!((passes, more), (2, 2));
    assert!(few == many && few.iter().sum::<u32>() > 0, "{few:?}, {many:?}");
}

/// A point takes the same passes among others as alone.
#[test]
fn points_of_a_map_take_few_passes() {
    let of_set = |set: &str| {
        let t = under(set);
        let case = t.case("first", &[], &["input"]).unwrap();
        let torques: [f64; LANES] = std::array::from_fn(|i| 5.0 + 0.4 * i as f64);
        let mut scratch = t.batch_scratch(&case);
        let mut passes = 0;
        for step in 1..=250 {
            let speed = [f64::from(80 * step) * RPM];
            let mut batch = t.batch(&case, &point(&speed, &[0.0]), &[100.0], &mut scratch);
            let block = batch.solve(&torques);
            let points = (0..LANES).filter(|point| !block.is_alone(*point));
            passes += points.map(|point| block.passes(point)).sum::<usize>();
        }
        (passes, LANES * 250)
    };
    assert_eq!([of_set("iso"), of_set("joint")], [(12_000, 4_000), (16_000, 4_000)]);
}

/// Ways along the path, passes over its places, and places, of each mesh; the third one turns idly. Ways change with the limit
/// within which bodies count as settled and with the friction that the first way starts from, passes also with the solver of a place.
#[test]
fn bodies_and_films_settle_in_few_passes() {
    let language = language();
    let friction = json!({ "type": "ehl_mixed", "tau0": "5 MPa", "limiting_slope": 0.055, "mu_b": 0.13 });
    let model = json!({ "type": "path_integral", "load_sharing": "ramp", "tooth_friction": friction });
    let choice = Choice {
        overrides: vec![("meshes.*.model".to_owned(), model)],
        ..Choice::default()
    };
    let gearbox = two_speed(&language);
    let resolved = gearbox.resolve(&language, &choice).unwrap();
    let t = gearbox.build(&language, &resolved).unwrap();
    let laws = contact_work::laws(&language, &resolved, &t);
    let case = t.case("first", &[], &["input"]).unwrap();
    let found = POINTS.map(|[torque, speed]| {
        let mut scratch = t.scratch(&case);
        let solution = t.evaluate(&case, &point(&[speed * RPM], &[torque]), &[60.0], &mut scratch);
        contact_work::work(&laws, &solution)
    });
    let expected = [
        [(3, 175, 32), (3, 152, 32), (1, 33, 32)],
        [(2, 121, 32), (2, 110, 32), (1, 38, 32)],
        [(3, 150, 32), (3, 132, 32), (1, 32, 32)],
        [(3, 178, 32), (3, 152, 32), (1, 33, 32)],
    ];
    assert_eq!(found, expected.map(Vec::from));
}

/// At rest: more evaluations where losses fall more steeply with temperature, or for a narrower limit; how many nodes there are
/// only makes each solution of the network longer. A step takes two: at the temperatures before, and at those that they lead to.
#[test]
fn a_network_of_64_nodes_takes_few_evaluations() {
    let language = language();
    let changes = plate::network();
    let changes: Vec<_> = changes.iter().map(|(path, v)| (path.as_str(), v.clone())).collect();
    let t = two_speed_with(&language, None, &changes);
    let network = t.network().unwrap();
    assert_eq!(network.names().len(), plate::NODES);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let (speeds, torques) = ([6000.0 * RPM], [15.0]);
    let moment = Moment {
        case: &case,
        point: &point(&speeds, &torques),
        around: &Surroundings::default(),
    };
    let steady = t.steady(&moment, &mut scratch).unwrap();
    assert_eq!(steady.outcome, Outcome::Converged);
    let oil = steady.temperatures[network.oil()];
    assert!((40.0..120.0).contains(&oil), "{oil}");
    let start = network.start(Some(40.0), moment.around);
    let mut march = March::new(&t, network, start, Scheme::Implicit, StepSize::Fixed(1.0));
    march.advance(&moment, 1.0, &mut t.batch_scratch(&case)).unwrap();
    assert_eq!(march.steps(), [1, 0]);
    assert_eq!((steady.evaluations, march.evaluations()), (8, 2));
}

/// Calls of the residuals, each over all measured points, and steps. Both hang on where the search begins, on what the set makes
/// of the measurement, and on when what remains counts as nothing; every step calls for forward differences, the end of the search
/// for central ones.
#[test]
fn a_fit_of_two_parameters_takes_few_calls() {
    let prepared = Prepared::read(&file(STUDY), "two_inputs").unwrap();
    let calls = ["iso", "joint"].map(|set| {
        let mut identification = prepared.identification(set).unwrap();
        let fitted = identification.fit(&Settings::default()).unwrap();
        (fitted.minima.evaluations, fitted.fit().counts.steps)
    });
    assert_eq!(calls, [(17, 3), (11, 1)]);
}

/// What the benches read is a document as a user would write it: nothing in it is refused, and all of it arrives.
#[test]
fn the_long_document_of_the_benches_resolves() {
    let language = language();
    let text = long::yaml();
    assert_eq!(text.lines().count(), long::LINES);
    let read = Gearbox::of_text(&language, &text, "long.yaml", file("tests"));
    let resolved = read.and_then(|gearbox| gearbox.resolve(&language, &Choice::default()));
    let resolved = resolved.unwrap_or_else(|f| panic!("{}", f.render()));
    assert_eq!(resolved.value["gears"].as_object().unwrap().len(), long::SHAFTS);
    assert_eq!(resolved.value["bearings"].as_object().unwrap().len(), 2 * long::SHAFTS);
}
