//! Equilibrium of roller bearings.

use super::*;
use crate::testing::assert_close;

/// Loads of the rollers from the first one, which is under the load, to one side.
#[track_caller]
fn assert_loads(bearing: &Rollers, found: &Equilibrium, slice: f64, expected: &[f64]) {
    let rollers: Vec<RollerLoad> = bearing.loads(&found.displacement).collect();
    assert_close(rollers[0].greatest_slice, slice, 1e-8);
    for (got, expected) in rollers.iter().zip(expected) {
        assert_close(got.load, *expected, 1e-7);
    }
}

/// SciPy: 5000 N without and with a moment of 5 Nm.
#[test]
fn profiled_rollers_with_clearance() {
    let bearing = Rollers::new(fourteen_rollers());
    let found = balanced(&bearing, Axes::loaded(0.0, 5000.0).with_moment(0.0));
    assert_close(found.displacement.radial[0], 0.023_589_487 * MM, 5e-8);
    assert_loads(&bearing, &found, 91.897_313, &[1895.0405, 1449.4689, 395.4409]);
    let found = balanced(&bearing, Axes::loaded(0.0, 5000.0).with_moment(5.0));
    assert_close(found.displacement.radial[0], 0.023_283_162 * MM, 5e-8);
    assert_close(found.displacement.tilt[0].atan(), 1.020_632_46e-3, 1e-8);
    assert_loads(&bearing, &found, 98.202_928, &[1885.8896]);
}

#[test]
fn straight_rollers_without_clearance() {
    let bearing = Rollers::new(RollerGeometry {
        profile: Profile::Straight,
        clearance: 0.0,
        ..fourteen_rollers()
    });
    let found = balanced(&bearing, Axes::loaded(0.0, 5000.0));
    assert_loads(&bearing, &found, 1_459.295_868 / 30.0, &[1_459.295_868]);
}

/// A long roller is straight in the middle and has its pole at the end, where no load remains.
#[test]
fn the_profile_of_a_long_roller_begins_where_its_straight_part_ends() {
    let long = RollerGeometry {
        length: 40.0 * MM,
        slices: 400,
        clearance: 0.0,
        ..fourteen_rollers()
    };
    let bearing = Rollers::new(long);
    let found = balanced(&bearing, Axes::loaded(0.0, 20_000.0));
    let slices: Vec<f64> = bearing.slices(0, &found.displacement).collect();
    // (40 - 27.5)/2 mm on each side of the middle, in slices of 0.1 mm.
    let straight = &slices[200 - 62..200 + 62];
    assert!(straight.iter().all(|load| *load == straight[0]));
    assert!(slices[200 + 63] < straight[0] && slices[399] < 0.9 * straight[0]);
    assert!(slices[200..].windows(2).all(|pair| pair[1] <= pair[0]));
}

/// Sixteen tapered rollers under thrust alone: Q = Fa/(Z sin a).
#[test]
fn thrust_on_tapered_rollers() {
    let angle = 14.17_f64.to_radians();
    let bearing = Rollers::new(RollerGeometry {
        number: 16,
        contact_angle: angle,
        clearance: 0.0,
        ..fourteen_rollers()
    });
    let found = balanced(&bearing, Axes::loaded(6000.0, 0.0));
    for roller in bearing.loads(&found.displacement) {
        assert_close(roller.load, 6000.0 / (16.0 * angle.sin()), 1e-11);
    }
    // The thrust that a radial load needs at least is Fr tan a.
    assert_eq!(
        balance(&bearing, &Axes::loaded(0.9 * 5000.0 * angle.tan(), 5000.0)),
        Err(Unbalanced)
    );
    balanced(&bearing, Axes::loaded(1.1 * 5000.0 * angle.tan(), 5000.0));
}

#[test]
fn cylindrical_rollers_carry_no_thrust() {
    let bearing = Rollers::new(fourteen_rollers());
    assert_eq!(balance(&bearing, &Axes::loaded(100.0, 5000.0)), Err(Unbalanced));
    assert_eq!(balanced(&bearing, Axes::loaded(0.0, 5000.0)).axial_stiffness(), None);
}

/// Pressure of a line contact by hand: sqrt(q E*/(pi R)), with R = D (1 - D/d_m)/2 at the inner ring.
#[test]
fn pressure_of_a_slice() {
    let bearing = Rollers::new(fourteen_rollers());
    let modulus: f64 = 210e9 / 0.91 / 2.0;
    let by_hand = |radius: f64| (100.0 / (0.4 * MM) * modulus / (std::f64::consts::PI * radius)).sqrt();
    assert_close(
        bearing.pressure(100.0, 0),
        by_hand(5.5 * MM * (1.0 - 11.0 / 60.0)),
        1e-12,
    );
    assert_close(
        bearing.pressure(100.0, 1),
        by_hand(5.5 * MM * (1.0 + 11.0 / 60.0)),
        1e-12,
    );
}

/// Straight rollers tilt about their middle: each resists with 10/9 of its stiffness times the mean square of the distance of its slices.
#[test]
fn tilting_stiffness_of_straight_rollers() {
    let geometry = RollerGeometry {
        profile: Profile::Straight,
        ..fourteen_rollers()
    };
    let bearing = Rollers::new(geometry);
    let found = balanced(&bearing, Axes::loaded(0.0, 5000.0).with_moment(0.0).mirrored());
    let slices = geometry.slices as f64;
    let square = geometry.length * geometry.length / 12.0 * (1.0 - 1.0 / (slices * slices));
    let each = bearing.loads(&found.displacement).zip(bearing.directions());
    let resisting = each.map(|(roller, [cos, _])| {
        let approach = (roller.load / bearing.stiffness()).powf(0.9);
        if approach == 0.0 {
            0.0
        } else {
            cos * cos * roller.load / approach
        }
    });
    let expected = 10.0 / 9.0 * square * resisting.sum::<f64>();
    assert_close(found.tilting_stiffness().unwrap_or_default(), expected, 1e-9);
}
