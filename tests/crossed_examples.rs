//! Examples whose axes cross: the numbers of their pages.

use gearloss_framework::evaluate::{Point, Solution};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use serde_json::json;

use crate::common::{RPM, file, language};

fn built(path: &str, choice: &Choice) -> Transmission {
    let language = language();
    let gearbox = Gearbox::read(&language, &file(path)).unwrap();
    gearbox.transmission(&language, choice).unwrap()
}

/// A point with torque in Nm and speed in rpm at these ports.
fn at<T>(
    t: &Transmission,
    (torque_at, torque): (&str, f64),
    (speed_at, rpm): (&str, f64),
    oil: f64,
    show: impl FnOnce(&Solution<'_>) -> T,
) -> T {
    let case = t.case("only", &[speed_at], &[torque_at]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[rpm * RPM],
        torques: &[torque],
        ..Point::default()
    };
    show(&t.evaluate(&case, &point, &[oil], &mut scratch))
}

/// Golden losses of the rear axle, of the release in which it came: friction of the mesh with its preloaded bearings, driving and coasting.
#[test]
fn the_rear_axle_loses_what_it_lost() {
    let wheels = Choice::default().with("wheels", json!(["left", "right"]));
    let t = built("examples/rear-axle/gearbox.yaml", &wheels);
    for (torque, loss, efficiency) in [
        (150.0, 831.688_703_816, 0.964_702_035_113),
        (-80.0, 752.538_222_700, 0.943_498_507_880),
    ] {
        at(&t, ("input", torque), ("input", 1500.0), 60.0, |solved| {
            assert!(
                (solved.loss().unwrap() / loss - 1.0).abs() < 1e-9,
                "{:?}",
                solved.loss()
            );
            assert!((solved.efficiency().unwrap() - efficiency).abs() < 1e-9);
        });
    }
}

/// The table of the page: torque of the motor in its sense of rotation, up and down.
#[test]
fn the_lift_holds_its_load_at_low_speed_only() {
    let t = built("examples/worm-drive/gearbox.yaml", &Choice::default());
    for (rpm, lifting, efficiency, lowering, status) in [
        (1450.0, 13.6, 64.1, -3.9, Status::Coast),
        (400.0, 13.7, 64.0, -3.9, Status::Coast),
        (100.0, 16.1, 54.3, -1.5, Status::Coast),
        (50.0, 18.1, 48.3, 0.4, Status::Dragged),
        (25.0, 20.0, 43.7, 2.3, Status::Dragged),
        (10.0, 20.6, 42.5, 2.8, Status::Dragged),
    ] {
        let load = ("output", -350.0);
        at(&t, load, ("input", rpm), 70.0, |solved| {
            assert_eq!(solved.status(), Status::Drive);
            assert!((solved.torque(0) - lifting).abs() < 0.05, "{rpm}: {}", solved.torque(0));
            assert!((100.0 * solved.efficiency().unwrap() - efficiency).abs() < 0.06);
        });
        at(&t, load, ("input", -rpm), 70.0, |solved| {
            assert_eq!(solved.status(), status, "{rpm}");
            assert!(
                (-solved.torque(0) - lowering).abs() < 0.06,
                "{rpm}: {}",
                solved.torque(0)
            );
        });
        // Braked at the worm, the load moves it or not at all.
        at(&t, ("input", -5.0), ("input", rpm), 70.0, |solved| {
            assert_eq!(solved.status() == Status::SelfLocking, rpm <= 50.0, "{rpm}");
        });
    }
}

/// To lift 350 Nm from rest, the teeth need 350/40/0.380 = 23.0 Nm.
#[test]
fn the_lift_starts_with_its_friction_at_rest() {
    let t = built("examples/worm-drive/gearbox.yaml", &Choice::default());
    let (_, worm, rest) = t.worms().next().unwrap();
    let rest = rest.unwrap();
    let [efficiency, _] = rest.efficiency;
    assert!((efficiency - 0.380).abs() < 5e-4, "{efficiency}");
    assert!((350.0 / worm.pair.ratio() / efficiency - 23.0).abs() < 0.05);
}
