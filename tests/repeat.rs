//! Evaluating allocates nothing after warm-up, and gives the same bits on any number of threads.
#![allow(clippy::unwrap_used)]

mod common;

use common::{RPM, language, two_speed_with};
use gearloss_framework::analysis::{Field, OilTemperature, Points, run_grid};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
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
                flow: PowerFlow::Real,
                tolerance: Tolerance::default(),
            };
            t.evaluate(&case, &point, &[100.0], &mut scratch).loss()
        };
        evaluate(5000.0, 10.0);
        let info = allocation_counter::measure(|| {
            for i in 0..1000 {
                assert!(evaluate(20.0 * f64::from(i), 0.02 * f64::from(i) - 10.0).is_some());
            }
        });
        assert_eq!(info.count_total, 0, "{set:?}");
    }
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
        let bits = |p: &gearloss_framework::analysis::PointResult| {
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
