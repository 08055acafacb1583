#![allow(clippy::unwrap_used)]
use super::*;

/// The car of the checks: an electric sedan of the US EPA test-car list of 2022.
fn sedan() -> VehicleEntry {
    VehicleEntry {
        mass: 1928.0,
        coast_down: Some(CoastDownEntry {
            a: 165.3404,
            b: 0.467_668_3,
            c: 0.320_520_7,
        }),
        drag_area: None,
        rolling_resistance: None,
        air_density: None,
        tyre_radius: 0.3357,
        rotating_mass_factor: Some(1.04),
        inertia: None,
        regeneration: RegenerationEntry::Word(NoRegeneration::None),
        efficiency: None,
        battery: None,
        motor_map: None,
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs()
}

const RATIO: f64 = 9.036_290_3;

#[test]
fn u7a_coast_down_at_150_km_h() {
    let car = sedan().vehicle("vehicle").unwrap();
    let v = 150.0 / 3.6;
    let force = car.force(v, 0.0, 0.0);
    assert!(close(force, 741.2862) && close(force * v, 30886.92), "{force}");
    let rpm = car.wheel_speed(v) * RATIO * 30.0 / std::f64::consts::PI;
    assert!(close(rpm, 10710.23), "{rpm}");
}

#[test]
fn u7b_radius_of_the_wheels_and_force_while_accelerating() {
    // Speed of the motor over that of the vehicle, 115 rpm per mph.
    let radius = 0.44704 * 60.0 * RATIO / (2.0 * std::f64::consts::PI * 115.0);
    assert!(close(radius, 0.335_436_3), "{radius}");
    let force = sedan().vehicle("vehicle").unwrap().force(100.0 / 3.6, 1.0, 0.0);
    assert!(close(force, 2430.767), "{force}");
}

#[test]
fn u7c_drag_and_rolling_resistance_at_150_km_h() {
    let entry = VehicleEntry {
        mass: 1847.0,
        coast_down: None,
        drag_area: Some(0.5106),
        rolling_resistance: Some(0.0085),
        ..sedan()
    };
    // The check rounds gravity.
    let car = Vehicle {
        gravity: 9.81,
        ..entry.vehicle("vehicle").unwrap()
    };
    let v = 150.0 / 3.6;
    let force = car.force(v, 0.0, 0.0);
    assert!(close(force, 685.8871) && close(force * v, 28578.63), "{force}");
    let torque = input_torque(force * car.tyre_radius, RATIO, 1.0);
    assert!(close(torque, 25.48084), "{torque}");
}

#[test]
fn a_road_load_is_stated_once_and_wholly() {
    let message = |entry: VehicleEntry| entry.vehicle("vehicle").unwrap_err().to_string();
    let help = "(help: state `coast_down`, or `drag_area` and `rolling_resistance`)";
    let bare = || VehicleEntry {
        coast_down: None,
        ..sedan()
    };
    assert_eq!(message(bare()), format!("vehicle: no road load is stated {help}"));
    let drag_area = Some(0.5);
    assert_eq!(
        message(VehicleEntry { drag_area, ..bare() }),
        format!("vehicle: `drag_area` needs `rolling_resistance` {help}")
    );
    let rolling_resistance = Some(0.01);
    assert_eq!(
        message(VehicleEntry {
            rolling_resistance,
            ..bare()
        }),
        format!("vehicle: `rolling_resistance` needs `drag_area` {help}")
    );
    assert_eq!(
        message(VehicleEntry { drag_area, ..sedan() }),
        format!("vehicle: the road load is stated twice {help}")
    );
    let air_density = Some(1.1);
    assert_eq!(
        message(VehicleEntry { air_density, ..sedan() }),
        "vehicle.air_density: a coast-down test already includes the air density (help: delete `air_density`)"
    );
}

#[test]
fn regeneration_is_limited_by_torque_power_and_speed() {
    let limits = Regeneration {
        torque: 350.0,
        power: 190e3,
        fade_speed: 2.0,
    };
    assert!(close(limits.limit(100.0, 20.0), 350.0));
    assert!(close(limits.limit(-1000.0, 20.0), 190.0));
    assert!(close(limits.limit(50.0, 0.5), 87.5));
    assert_eq!((limits.limit(0.0, 0.0), limits.limit(0.0, -1.0)), (0.0, 0.0));
    let off = Regeneration {
        torque: 0.0,
        power: 0.0,
        fade_speed: 0.0,
    };
    assert_eq!((off.limit(0.0, 0.0), off.limit(10.0, 10.0)), (0.0, 0.0));
    let car = |regeneration| Vehicle {
        regeneration,
        ..sedan().vehicle("vehicle").unwrap()
    };
    assert_eq!(car(None).regained(-50.0, 100.0, 20.0), 0.0);
    assert_eq!(car(None).regained(50.0, 100.0, 20.0), 50.0);
    assert_eq!(car(Some(limits)).regained(-50.0, 100.0, 20.0), -50.0);
    assert_eq!(car(Some(limits)).regained(-500.0, 100.0, 20.0), -350.0);
}

#[test]
fn a_vehicle_at_standstill_asks_nothing() {
    let car = sedan().vehicle("vehicle").unwrap();
    assert_eq!(car.demand(0.0, 0.0, 0.2), Demand::Rest);
    assert_eq!(car.road_load(0.0, 0.0), 0.0);
}

#[test]
fn a_downhill_slope_that_equals_the_road_load_asks_no_torque() {
    let car = sedan().vehicle("vehicle").unwrap();
    let v = 20.0;
    let sine = car.road_load(v, 0.0) / (car.mass * car.gravity);
    let grade = -sine / (1.0 - sine * sine).sqrt();
    assert!(car.force(v, 0.0, grade).abs() < 1e-9);
}

/// k = 1 + (J_wheels + J_rotor i2) / (m r2), by hand.
#[test]
fn the_mass_factor_follows_the_ratio() {
    let inertia = InertiaEntry {
        wheels: 3.6,
        rotor: 0.05,
        shafts: Ordered(vec![("layshaft".to_owned(), ShaftInertiaEntry { inertia: 0.01 })]),
    };
    let entry = VehicleEntry {
        rotating_mass_factor: None,
        inertia: Some(inertia),
        ..sedan()
    };
    let car = entry.vehicle("vehicle").unwrap();
    for (ratio, factor) in [
        (9.036_290, 1.035_359),
        (5.153, 1.022_68),
        (12.0, 1.049_707),
        (7.0, 1.027_845),
    ] {
        let found = car.mass_factor(ratio, |_| 0.0);
        assert!((found - factor).abs() < 6e-7, "{ratio}: {found}");
    }
    // A shaft at 3 times the speed of the wheels adds 0.01 * 9 kg m2.
    let [with, without] = [3.0, 0.0].map(|speed| car.mass_factor(9.0, |_| speed));
    assert!(((with - without) - 0.09 / (1928.0 * 0.3357 * 0.3357)).abs() < 1e-15);
    // The force without these parts and their torque are the force with the factor.
    let torque = car.force(20.0, 1.0, 0.0) * car.tyre_radius + car.inertia_torque(1.04, 1.0);
    let fixed = sedan().vehicle("vehicle").unwrap();
    assert!(
        close(torque, fixed.force(20.0, 1.0, 0.0) * fixed.tyre_radius),
        "{torque}"
    );
    let both = VehicleEntry {
        rotating_mass_factor: Some(1.04),
        ..entry
    };
    assert!(both.vehicle("vehicle").is_err());
}
