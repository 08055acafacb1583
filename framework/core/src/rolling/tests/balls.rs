//! Contacts and static equilibrium of ball bearings.

use super::*;
use crate::testing::assert_close;

/// SciPy: ball of 15.081 mm on 65 mm, 1500 N.
#[test]
fn contacts_of_a_6308() {
    let bearing = Balls::new(BallGeometry {
        number: 8,
        diameter: 15.081 * MM,
        pitch_diameter: 65.0 * MM,
        ..seven_balls(0.0)
    });
    for (ring, [along, across], ratio, a, b, p0) in [
        (
            0,
            [5.790_988, 196.053],
            0.104_708_42,
            1.864_239_8,
            0.195_201_61,
            1968.1014,
        ),
        (
            1,
            [9.290_012, 133.2155],
            0.177_320_73,
            1.528_503_7,
            0.271_035_39,
            1728.7816,
        ),
    ] {
        let radii = bearing.geometry().radii(ring, 1.0);
        assert_close(radii[0], along * MM, 1e-7);
        assert_close(radii[1], across * MM, 1e-7);
        let contact = bearing.contacts()[ring];
        assert_close(contact.ratio(), ratio, 5e-8);
        let found = contact.under(1500.0);
        assert_close(found.across, a * MM, 5e-8);
        assert_close(found.along, b * MM, 5e-8);
        assert_close(found.pressure, p0 * 1e6, 5e-8);
    }
    assert_close(bearing.stiffness() * MM.powf(1.5), 382_314.501, 5e-9);
}

/// The same with balls of silicon nitride: pressure 1.117 of that of steel; about 12 % more according to authors of SKF.
#[test]
fn contacts_of_a_hybrid_bearing() {
    let of = |balls| {
        Balls::new(BallGeometry {
            number: 8,
            diameter: 15.081 * MM,
            pitch_diameter: 65.0 * MM,
            balls,
            ..seven_balls(0.0)
        })
    };
    let (hybrid, steel) = (
        of(Material::SILICON_NITRIDE).contacts()[0],
        of(Material::STEEL).contacts()[0],
    );
    let pressure = hybrid.under(1500.0).pressure;
    assert_close(pressure, 2198.4119e6, 5e-8);
    assert_close(pressure / steel.under(1500.0).pressure, 1.117_022, 1e-6);
    assert_close(hybrid.stiffness() / steel.stiffness(), 1.180_571_83, 1e-8);
}

/// Loads of the balls from the first one, which is under the radial load, to one side.
fn loads(bearing: &Balls, found: &Equilibrium) -> Vec<f64> {
    bearing
        .loads(&found.displacement)
        .map(|ball| ball.load[0])
        .take(4)
        .collect()
}

#[track_caller]
fn assert_loads(bearing: &Balls, found: &Equilibrium, expected: &[f64]) {
    for (got, expected) in loads(bearing, found).iter().zip(expected) {
        assert_close(*got, *expected, 1e-7);
    }
}

/// Four cases of SciPy, the first three of which the commercial program prints with 15.1101, 133.5381, 21.223, 149.1717 um.
#[test]
fn radial_or_axial_load() {
    let [tight, loose] = [0.0, 10.0].map(|clearance| Balls::new(seven_balls(clearance * UM)));
    assert_close(tight.stiffness() * MM.powf(1.5), 333_592.05, 1e-8);
    let radial = balanced(&tight, Axes::loaded(0.0, 1000.0));
    assert_close(radial.displacement.radial[0], 15.11020 * UM, 1e-6);
    assert_loads(&tight, &radial, &[619.613_96, 305.045_92, 0.0, 0.0]);
    let axial = balanced(&tight, Axes::loaded(1000.0, 0.0));
    assert_close(axial.displacement.axial, 133.53799 * UM, 1e-7);
    let ball = tight.loads(&axial.displacement).next().unwrap_or_default();
    assert_close(ball.load[0], 631.498, 1e-6);
    assert_close(ball.angle[0].to_degrees(), 13.0746, 5e-6);
    let radial = balanced(&loose, Axes::loaded(0.0, 1000.0));
    assert_close(radial.displacement.radial[0], 21.22281 * UM, 1e-6);
    assert_loads(&loose, &radial, &[689.294_31, 249.166_62, 0.0, 0.0]);
    let axial = balanced(&loose, Axes::loaded(1000.0, 0.0));
    assert_close(axial.displacement.axial, 149.17172 * UM, 1e-7);
    let ball = loose.loads(&axial.displacement).next().unwrap_or_default();
    assert_close(ball.angle[0].to_degrees(), 14.66567, 1e-6);
}

/// SciPy; the commercial program prints 19.5923 and 146.4603 um.
#[test]
fn combined_load_with_a_free_tilt() {
    let loose = Balls::new(seven_balls(10.0 * UM));
    let found = balanced(&loose, Axes::loaded(1000.0, 1000.0).with_moment(0.0));
    assert_close(found.displacement.radial[0], 19.59177 * UM, 1e-6);
    assert_close(found.displacement.axial, 146.45996 * UM, 1e-6);
    assert_close(found.displacement.tilt[0].asin(), -2.65924e-3, 2e-6);
    assert_loads(&loose, &found, &[1_024.269_79, 773.552_78, 476.815_32, 446.350_04]);
}

/// SciPy; displacements there are from where the balls touch at the contact angle of the clearance.
#[test]
fn combined_load_with_a_held_tilt() {
    let loose = Balls::new(seven_balls(10.0 * UM));
    let found = balanced(&loose, Axes::loaded(500.0, 1000.0));
    let distance = loose.geometry().groove_distance();
    let touching = (distance * distance - (distance - 5.0 * UM).powi(2)).sqrt();
    assert_close(found.displacement.radial[0], 6.297_859 * UM, 1e-6);
    assert_close(found.displacement.axial - touching, 52.979_456 * UM, 1e-6);
    assert_loads(&loose, &found, &[642.586_08, 504.039_84, 237.335_02, 78.230_23]);
    let angles: Vec<f64> = loose
        .loads(&found.displacement)
        .map(|ball| ball.angle[0].to_degrees())
        .collect();
    assert_close(angles[0], 12.58346, 1e-6);
    assert_close(angles[3], 12.84166, 1e-6);
}

#[test]
fn without_load_nothing_is_loaded_and_nothing_moves() {
    let loose = Balls::new(seven_balls(10.0 * UM));
    let found = balanced(&loose, Axes::loaded(0.0, 0.0));
    assert_eq!(found.displacement, Axes::default());
    assert!(loose.loads(&found.displacement).all(|ball| ball.load == [0.0; 2]));
    assert_eq!(found.radial_stiffness(), None);
}

/// With negative clearance all balls carry load while the ring carries none.
#[test]
fn preloaded_balls_share_a_small_load() {
    let tight = Balls::new(seven_balls(-10.0 * UM));
    let found = balanced(&tight, Axes::loaded(0.0, 1e-3));
    let preload = tight.stiffness() * (5.0 * UM).powf(1.5);
    for ball in tight.loads(&found.displacement) {
        assert_close(ball.load[0], preload, 1e-4);
    }
    // Z/2 of the stiffness of a ball.
    let slope = 1.5 * preload / (5.0 * UM);
    assert_close(found.radial_stiffness().unwrap_or_default(), 3.5 * slope, 1e-4);
}

/// The stiffness is the slope of the displacement over the load.
#[test]
fn stiffness_is_a_slope() {
    let bearing = Balls::new(BallGeometry {
        contact_angle: 25.0_f64.to_radians(),
        ..seven_balls(0.0)
    });
    let at = |axial: f64, radial: f64| balanced(&bearing, Axes::loaded(axial, radial));
    let (middle, step) = (at(800.0, 500.0), 0.01);
    let axial = at(800.0 + step, 500.0).displacement.axial - at(800.0 - step, 500.0).displacement.axial;
    assert_close(middle.axial_stiffness().unwrap_or_default(), 2.0 * step / axial, 1e-6);
    let radial = at(800.0, 500.0 + step).displacement.radial[0] - at(800.0, 500.0 - step).displacement.radial[0];
    assert_close(middle.radial_stiffness().unwrap_or_default(), 2.0 * step / radial, 1e-6);
}

/// Small tilts turn the forces of the balls, of which the ring, free along its axis, takes the mean: q = Q/(A + delta),
/// M = R^2 (sum of q cos^2 - (sum of q cos)^2/sum of q) psi.
#[test]
fn tilting_stiffness_of_radially_loaded_balls() {
    let bearing = Balls::new(seven_balls(10.0 * UM));
    let found = balanced(&bearing, Axes::loaded(0.0, 1000.0).with_moment(0.0).mirrored());
    let mut sums = [0.0; 3];
    for (ball, [cos, _]) in bearing.loads(&found.displacement).zip(bearing.directions()) {
        let load = ball.load[0];
        let approach = (load / bearing.stiffness()).powf(2.0 / 3.0);
        let turning = load / (bearing.geometry().groove_distance() + approach);
        for (sum, share) in sums.iter_mut().zip([1.0, *cos, cos * cos]) {
            *sum += turning * share;
        }
    }
    let expected = bearing.radius().powi(2) * (sums[2] - sums[1] * sums[1] / sums[0]);
    assert_close(found.tilting_stiffness().unwrap_or_default(), expected, 1e-9);
}
