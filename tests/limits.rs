//! Limits of the theory on the two-speed example: rest, zero torque with preload, dry, reversal, neutral; the balance.

use crate::common::{RPM, language, two_speed_with};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::{Status, Tolerance};
use gearloss_framework::transmission::Transmission;
use serde_json::json;

/// Solves a point and hands out what the tests look at: status, loss, efficiency, residual over the largest power, losses.
struct Seen {
    status: Status,
    loss: Option<f64>,
    efficiency: Option<f64>,
    residual: Option<f64>,
    parts: Vec<(String, f64)>,
    radial: Vec<f64>,
    axial: Vec<f64>,
}

fn solve(t: &Transmission, gear: &str, speeds: &[(&str, f64)], torques: &[(&str, f64)], flow: PowerFlow) -> Seen {
    let speed_ports: Vec<&str> = speeds.iter().map(|s| s.0).collect();
    let torque_ports: Vec<&str> = torques.iter().map(|s| s.0).collect();
    let case = t.case(gear, &speed_ports, &torque_ports).unwrap();
    let mut scratch = t.scratch(&case);
    let speeds: Vec<f64> = speeds.iter().map(|s| s.1 * RPM).collect();
    let torques: Vec<f64> = torques.iter().map(|s| s.1).collect();
    let tolerance = Tolerance {
        power: 1e-12,
        passes: 60,
    };
    let point = Point {
        speeds: &speeds,
        torques: &torques,
        flow,
        tolerance,
        inclination: 0.0,
    };
    let solution = t.evaluate(&case, &point, &[t.oil_temperature], &mut scratch);
    Seen {
        status: solution.status(),
        loss: solution.loss(),
        efficiency: solution.efficiency(),
        residual: solution
            .residual()
            .map(|r| r / solution.largest_power().max(f64::MIN_POSITIVE)),
        parts: solution
            .parts()
            .map(|(part, loss)| (part.path.clone(), loss.watts()))
            .collect(),
        radial: (0..t.supports().len()).map(|i| solution.load(i).radial).collect(),
        axial: (0..t.supports().len()).map(|i| solution.load(i).axial).collect(),
    }
}

fn solve_point(t: &Transmission, speed: f64, torque: f64) -> Seen {
    solve(t, "first", &[("input", speed)], &[("input", torque)], PowerFlow::Real)
}

#[test]
fn at_rest_nothing_is_lost_and_nothing_is_undefined() {
    let language = language();
    for set in [None, Some("joint")] {
        let seen = solve_point(&two_speed_with(&language, set, &[]), 0.0, 10.0);
        assert_eq!(
            (seen.status, seen.loss, seen.efficiency),
            (Status::Standstill, Some(0.0), None)
        );
        assert!(seen.radial[0] > 600.0);
    }
}

#[test]
fn zero_torque_is_dragged_and_preload_still_loads_the_bearings() {
    let language = language();
    let free = solve_point(&two_speed_with(&language, None, &[]), 8000.0, 0.0);
    assert_eq!((free.status, free.efficiency), (Status::Dragged, None));
    assert!(free.loss.unwrap() > 0.0);
    let preload = [("bearings.B1.spring_preload", json!(200.0))];
    let preloaded = solve_point(&two_speed_with(&language, None, &preload), 8000.0, 0.0);
    assert!(
        preloaded.axial[0] == 200.0 && preloaded.axial[1] > 100.0,
        "{:?}",
        preloaded.axial
    );
    assert!(preloaded.loss.unwrap() > free.loss.unwrap());
    // With ideal flow no torque arises from drags, and only preload is left.
    let transmission = two_speed_with(&language, None, &preload);
    let ideal = solve(
        &transmission,
        "first",
        &[("input", 8000.0)],
        &[("input", 0.0)],
        PowerFlow::Ideal,
    );
    assert_eq!(ideal.axial[..2], [200.0, 200.0]);
    assert!(ideal.radial.iter().all(|r| *r == 0.0));
}

#[test]
fn a_dry_housing_has_no_churning() {
    let language = language();
    for set in [None, Some("joint")] {
        let dry = two_speed_with(&language, set, &[("housing.oil.level", json!("-2000 mm"))]);
        let seen = solve_point(&dry, 8000.0, 10.0);
        let churning: f64 = seen
            .parts
            .iter()
            .filter(|(path, _)| path.contains("churning"))
            .map(|(_, w)| w)
            .sum();
        assert_eq!(churning, 0.0);
        assert!(seen.loss.unwrap() > 0.0);
    }
}

#[test]
fn reversing_speed_and_torque_loses_the_same_and_coasting_does_not() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let (forward, back) = (solve_point(&t, 8000.0, 10.0), solve_point(&t, -8000.0, -10.0));
    // Crossed planes load the bearings differently when torque reverses, so only the meshes mirror exactly with them.
    assert_eq!(back.status, Status::Drive);
    assert!((forward.loss.unwrap() / back.loss.unwrap() - 1.0).abs() < 0.05);
    let coast = solve_point(&t, 8000.0, -10.0);
    assert_eq!(coast.status, Status::Coast);
    assert!(coast.efficiency.unwrap() < 1.0 && coast.efficiency.unwrap() > 0.9);
}

#[test]
fn neutral_takes_no_torque_and_both_ports_supply_the_drags() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let seen = solve(
        &t,
        "neutral",
        &[("input", 3000.0), ("output", 500.0)],
        &[],
        PowerFlow::Real,
    );
    assert_eq!((seen.status, seen.efficiency), (Status::Dragged, None));
    assert!(seen.loss.unwrap() > 0.0 && seen.residual.unwrap().abs() < 1e-12);
    assert!(t.case("neutral", &["input", "output"], &["input"]).is_err());
    assert!(t.case("neutral", &["input"], &[]).is_err());
    assert!(t.case("first", &["input", "output"], &["input"]).is_err());
}

#[test]
fn power_in_is_power_out_and_losses_to_rounding_over_the_map() {
    let language = language();
    for set in [None, Some("joint")] {
        let t = two_speed_with(&language, set, &[]);
        for gear in ["first", "second"] {
            for speed in [-12000.0, 500.0, 4000.0, 22000.0] {
                for torque in [-20.0, -3.0, 0.0, 0.05, 3.6, 20.0, 60.0] {
                    let seen = solve(&t, gear, &[("input", speed)], &[("input", torque)], PowerFlow::Real);
                    assert!(
                        seen.residual.unwrap().abs() < 1e-12,
                        "{gear} {speed} {torque} {:?}",
                        seen.residual
                    );
                    assert!(seen.parts.iter().all(|(_, watts)| *watts >= 0.0));
                    let sum: f64 = seen.parts.iter().map(|(_, watts)| watts).sum();
                    assert!((sum - seen.loss.unwrap()).abs() <= 1e-12 * sum);
                }
            }
        }
    }
}

#[test]
fn the_bearing_table_of_the_example_comes_from_its_file() {
    let language = language();
    let t = two_speed_with(&language, None, &[]);
    let expected = [
        (622.0, 0.0),
        (358.0, 438.0),
        (2498.0, 871.0),
        (1016.0, 0.0),
        (2119.0, 1310.0),
        (879.0, 0.0),
    ];
    let seen = solve(&t, "first", &[("input", 8000.0)], &[("input", 10.0)], PowerFlow::Ideal);
    for (i, (radial, axial)) in expected.into_iter().enumerate() {
        assert!(
            (seen.radial[i] - radial).abs() <= 0.51 && (seen.axial[i] - axial).abs() <= 0.51,
            "{i}: {}",
            seen.radial[i]
        );
    }
}

#[test]
fn trends_follow_speed_torque_and_temperature() {
    let language = language();
    for set in [None, Some("joint")] {
        let t = two_speed_with(&language, set, &[]);
        let loss = |speed: f64, torque: f64| solve_point(&t, speed, torque).loss.unwrap();
        assert!(loss(4000.0, 10.0) < loss(8000.0, 10.0) && loss(8000.0, 5.0) < loss(8000.0, 10.0));
        let cold = two_speed_with(&language, set, &[("thermal.oil", json!("20 degC"))]);
        assert!(solve_point(&cold, 8000.0, 1.0).loss.unwrap() > loss(8000.0, 1.0));
    }
}
