//! Pairs with preload.

use super::*;
use crate::testing::assert_close;

/// Seventeen tapered rollers of 15 mm at 14 degrees, with the approach 7.7e-5 Q^0.9/l^0.8 of catalogues, in mm and N.
fn tapered() -> ManyElements {
    let approach_at_1_n = 7.7e-5 / 15.0_f64.powf(0.8) * MM;
    ManyElements {
        number: 17.0,
        stiffness: approach_at_1_n.powf(-10.0 / 9.0),
        contact_angle: 14.0_f64.to_radians(),
        contact: Contact::Line,
    }
}

fn shared(bearing: ManyElements, radial: [f64; 2], external: f64, closing: f64) -> SharedThrust {
    let of = |radial: f64| move |axial: f64| bearing.thrust(radial, axial);
    let (first, second) = (of(radial[0]), of(radial[1]));
    match share_thrust([&first, &second], closing, external, 1.0 * UM) {
        Some(found) => found,
        None => panic!("no equilibrium"),
    }
}

/// SciPy.
#[test]
fn two_tapered_bearings() {
    let bearing = tapered();
    let closing = 2.0 * bearing.approach(1000.0);
    assert_close(closing, 0.010_239_077_930 * MM, 1e-10);
    assert_close(10.0 / 9.0 * 1000.0 / (0.5 * closing) * MM, 217_033.431_8, 1e-9);
    for (radial, external, closing, displacement, thrusts) in [
        (
            [0.0, 0.0],
            500.0,
            closing,
            0.006_272_411_22,
            [1_253.152_94, 753.152_941],
        ),
        (
            [3000.0, 2000.0],
            0.0,
            closing,
            0.004_639_716_58,
            [1_129.774_84, 1_129.774_84],
        ),
        (
            [3000.0, 2000.0],
            500.0,
            closing,
            0.006_285_224_04,
            [1_327.415_44, 827.415_441],
        ),
        (
            [3000.0, 2000.0],
            500.0,
            0.0,
            0.004_020_942_99,
            [1_083.741_36, 583.741_361],
        ),
        (
            [3000.0, 2000.0],
            0.0,
            0.0,
            -0.004_372_300_61,
            [886.322_994, 886.322_994],
        ),
    ] {
        let found = shared(bearing, radial, external, closing);
        assert_close(found.displacement, displacement * MM, 1e-9);
        for (got, expected) in found.thrust.iter().zip(thrusts) {
            assert_close(*got, expected, 1e-8);
        }
    }
}

/// SciPy: balls at 40 degrees.
#[test]
fn two_angular_contact_bearings() {
    let bearing = ManyElements {
        number: 12.0,
        stiffness: 4e5 / MM.powf(1.5),
        contact_angle: 40.0_f64.to_radians(),
        contact: Contact::Point,
    };
    let closing = 2.0 * bearing.approach(500.0);
    for (external, thrusts) in [(500.0, [771.186_359, 271.186_359]), (1413.0, [1413.0189, 0.0189])] {
        let found = shared(bearing, [0.0; 2], external, closing);
        assert_close(found.thrust[0], thrusts[0], 1e-8);
        assert!((found.thrust[1] - thrusts[1]).abs() < 5e-5, "{:?}", found.thrust);
    }
}

/// An equal pair without radial loads lifts off at 2^n of its preload: 2.828 with balls, 2.160 with rollers.
#[test]
fn a_pair_lifts_off() {
    for contact in [Contact::Point, Contact::Line] {
        let bearing = ManyElements { contact, ..tapered() };
        let closing = 2.0 * bearing.approach(1000.0);
        let limit = 1000.0 * 2.0_f64.powf(contact.exponent());
        let below = shared(bearing, [0.0; 2], 0.999 * limit, closing);
        assert!(below.thrust[1] > 0.0, "{below:?}");
        let above = shared(bearing, [0.0; 2], 1.001 * limit, closing);
        assert_close(above.thrust[0], 1.001 * limit, 1e-12);
        assert_eq!(above.thrust[1], 0.0);
    }
}

/// A pair of rows with single elements instead of integrals, with end play: the thrust is only the external one.
#[test]
fn two_rows_with_end_play() {
    let row = Balls::new(BallGeometry {
        contact_angle: 30.0_f64.to_radians(),
        ..seven_balls(0.0)
    });
    let thrust = |axial: f64| thrust_at(&row, 0.0, axial.max(0.0));
    let found = share_thrust([&thrust, &thrust], -20.0 * UM, 300.0, 1.0 * UM).map(|found| found.thrust);
    assert!(
        found.is_some_and(|[first, second]| (first - 300.0).abs() < 1e-9 && second == 0.0),
        "{found:?}"
    );
}

/// By hand, of the formula.
#[test]
fn temperature_closes_or_opens_a_pair() {
    let pair = |arrangement, expansion| Thermal {
        arrangement,
        diameter: [70.0 * MM, 60.0 * MM],
        contact_angle: [14.0_f64.to_radians(); 2],
        distance: 120.0 * MM,
        expansion,
        rise: [60.0, 45.0],
    };
    let steel = [11.5e-6; 2];
    let aluminium = [11.5e-6, 23e-6];
    for (arrangement, expansion, closing) in [
        (Arrangement::X, steel, 0.065_670_881_2),
        (Arrangement::O, steel, 0.024_270_881_2),
        (Arrangement::X, aluminium, -0.131_341_762_4),
        (Arrangement::O, aluminium, -0.048_541_762_4),
    ] {
        assert_close(pair(arrangement, expansion).closing(), closing * MM, 1e-8);
    }
    let neutral = pair(Arrangement::O, steel);
    assert_close(neutral.neutral_distance(), 260.700_760_7 * MM, 1e-9);
    let distance = neutral.neutral_distance();
    assert_eq!(Thermal { distance, ..neutral }.closing(), 0.0);
}
