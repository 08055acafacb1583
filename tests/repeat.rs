//! Evaluating allocates nothing after warm-up, and gives the same bits on any number of threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{RPM, file, language, two_speed_with};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_studies::points::{Field, MOST_IN_FLIGHT, OilTemperature, Points, run_grid, solve_pieces, take_points};
use serde_json::json;

#[test]
fn a_point_allocates_nothing() {
    let language = language();
    let law = json!({ "type": "ehl_mixed", "tau0": "5 MPa", "limiting_slope": 0.055, "mu_b": 0.13 });
    let model = json!({ "type": "path_integral", "tooth_friction": law });
    for (set, overrides) in [
        (None, vec![]),
        (Some("joint"), vec![]),
        (Some("joint"), vec![("meshes.*.model", model)]),
    ] {
        let t = two_speed_with(&language, set, &overrides);
        let case = t.case("first", &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        let mut evaluate = |speed: f64, torque: f64| {
            let point = Point {
                speeds: &[speed * RPM],
                torques: &[torque],
                ..Point::default()
            };
            t.evaluate(&case, &point, &[100.0], &mut scratch).loss()
        };
        let mut through_zero = || {
            for i in 0..1000 {
                assert!(evaluate(20.0 * f64::from(i), 0.02 * f64::from(i) - 10.0).is_some());
            }
        };
        // The order of torques is made for each pattern of driving gears that occurs.
        through_zero();
        let info = allocation_counter::measure(through_zero);
        assert_eq!(info.count_total, 0, "{set:?}");
    }
}

#[test]
fn an_oil_network_allocates_nothing() {
    let language = language();
    let gearbox = Gearbox::read(&language, &file("tests/oil_network/gearbox.yaml")).unwrap();
    let t = gearbox.transmission(&language, &Choice::default()).unwrap();
    let case = t.case("only", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut over_speeds = || {
        for i in 0..100 {
            let point = Point {
                speeds: &[60.0 * f64::from(i) * RPM],
                torques: &[40.0],
                ..Point::default()
            };
            assert!(
                t.evaluate(&case, &point, &[f64::from(i)], &mut scratch)
                    .loss()
                    .is_some()
            );
        }
    };
    over_speeds();
    assert_eq!(allocation_counter::measure(over_speeds).count_total, 0);
}

#[test]
fn pairs_of_bearings_allocate_nothing() {
    let language = language();
    let layout = file("framework/workbench/src/form/layouts/three-stage.yaml");
    let gearbox = Gearbox::read(&language, &layout).unwrap();
    let preload = json!({ "closing": 5e-6, "housing": { "material": "cast_iron" } });
    let choice = Choice::default()
        .with("bearings.B3.spring_preload", 300.0)
        .with("bearings.B5.preload", preload);
    let t = gearbox.transmission(&language, &choice).unwrap();
    let case = t.case("only", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let mut through_zero = || {
        for i in 0..100 {
            let point = Point {
                speeds: &[15.0 * f64::from(i) * RPM],
                torques: &[0.2 * f64::from(i) - 10.0],
                ..Point::default()
            };
            assert!(t.evaluate(&case, &point, &[70.0], &mut scratch).loss().is_some());
        }
    };
    through_zero();
    assert_eq!(allocation_counter::measure(through_zero).count_total, 0);
}

#[test]
fn one_thread_and_many_give_the_same_bits() {
    let language = language();
    let t = two_speed_with(&language, Some("joint"), &[]);
    let points = Points {
        gear: "first".to_owned(),
        torque_at: vec!["input".to_owned()],
        speed_at: vec!["input".to_owned()],
        field: Field::Grid {
            torques: (0..31).map(|i| f64::from(i) - 10.0).collect(),
            speeds: (0..23).map(|i| f64::from(i) * 1000.0 * RPM).collect(),
        },
        oil: OilTemperature::Fixed(100.0),
        flow: PowerFlow::Real,
        terms: false,
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run_grid(&t, &points, &|_| true)).unwrap().unwrap()
    };
    let (one, many) = (on(1), on(7));
    assert_eq!(one.passes, many.passes);
    assert_eq!(one.seen, many.seen);
    for (a, b) in one.points.iter().zip(&many.points) {
        let bits = |p: &gearloss_studies::points::PointResult| {
            (
                p.loss.map(f64::to_bits),
                p.efficiency.map(f64::to_bits),
                p.parts.iter().map(|w| w.to_bits()).collect::<Vec<_>>(),
            )
        };
        assert_eq!(bits(a), bits(b));
    }
    // A machine-independent count: how often the loss models were asked for the whole grid.
    assert!(
        (2 * 713..=4 * 713).contains(&one.passes),
        "{} passes for 713 points",
        one.passes
    );
}

/// Counts what was solved and not yet taken, whatever the speed of both sides.
#[test]
fn few_points_of_a_large_field_are_held_at_once() {
    let language = language();
    let t = two_speed_with(&language, Some("joint"), &[]);
    // Pieces are as large as they get.
    let torques: Vec<f64> = (0..300).map(|i| 0.06 * f64::from(i)).collect();
    let speeds: Vec<f64> = (0..3200).map(|i| f64::from(i) * 7.0 * RPM).collect();
    let count = torques.len() * speeds.len();
    assert!(count > 2 * MOST_IN_FLIGHT);
    let points = Points {
        gear: "first".to_owned(),
        torque_at: vec!["input".to_owned()],
        speed_at: vec!["input".to_owned()],
        field: Field::Grid { torques, speeds },
        oil: OilTemperature::Fixed(100.0),
        flow: PowerFlow::Real,
        terms: false,
    };
    let numbers: Vec<usize> = (0..points.field.pieces()).collect();
    for threads in [1, 3] {
        let (waiting, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let solved = |more: usize| {
            let now = waiting.fetch_add(more, Ordering::SeqCst) + more;
            most.fetch_max(now, Ordering::SeqCst);
            true
        };
        let (mut taken, mut next) = (0, 0);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let whole = pool.install(|| {
            solve_pieces(&t, &points, &numbers, &take_points, &solved, &mut |piece| {
                assert_eq!(piece.number, next);
                next += 1;
                taken += piece.len();
                waiting.fetch_sub(piece.len(), Ordering::SeqCst);
                true
            })
        });
        assert!(whole.unwrap());
        assert_eq!((taken, next), (count, numbers.len()));
        let most = most.into_inner();
        assert!(
            (MOST_IN_FLIGHT / 2..=MOST_IN_FLIGHT).contains(&most),
            "{most} of {MOST_IN_FLIGHT} held"
        );
    }
}

/// A piece is the same alone, among others, and in the whole field.
#[test]
fn pieces_solved_alone_are_those_of_the_whole_field() {
    let language = language();
    let t = two_speed_with(&language, Some("joint"), &[]);
    let points = Points {
        gear: "first".to_owned(),
        torque_at: vec!["input".to_owned()],
        speed_at: vec!["input".to_owned()],
        field: Field::Grid {
            torques: (0..250).map(|i| 0.08 * f64::from(i)).collect(),
            speeds: (0..70).map(|i| f64::from(i) * 300.0 * RPM).collect(),
        },
        oil: OilTemperature::Fixed(100.0),
        flow: PowerFlow::Real,
        terms: false,
    };
    let whole = run_grid(&t, &points, &|_| true).unwrap().unwrap();
    for (i, point) in whole.points.iter().enumerate() {
        let given = points.field.given_point(i);
        assert_eq!((point.torque, point.speed), (given.torque, given.speed), "{i}");
    }
    // Lines of 64 torques at 70 speeds, in three tasks each.
    assert_eq!(points.field.pieces(), 4);
    let mut start = 0;
    let mut seen = Vec::new();
    for number in 0..4 {
        let mut alone = Vec::new();
        solve_pieces(&t, &points, &[number], &take_points, &|_| true, &mut |piece| {
            alone.push(piece);
            true
        })
        .unwrap();
        let end = start + alone[0].len();
        assert!(alone[0].points().eq(&whole.points[start..end]));
        // A piece that is computed again, as after a lost worker, has the same parts.
        solve_pieces(&t, &points, &[number], &take_points, &|_| true, &mut |piece| {
            assert!(piece == alone[0] && piece.is_sound(number, alone[0].len()));
            assert!(!piece.is_sound(number + 1, piece.len()) && !piece.is_sound(number, piece.len() + 1));
            true
        })
        .unwrap();
        gearloss_studies::points::merge(&mut seen, &alone[0].seen);
        start = end;
    }
    assert_eq!((start, seen), (17500, whole.seen));
    let stopped = solve_pieces(&t, &points, &[0, 1, 2, 3], &take_points, &|_| true, &mut |piece| {
        piece.number < 1
    });
    assert!(!stopped.unwrap(), "who takes no more is handed no more");
}
