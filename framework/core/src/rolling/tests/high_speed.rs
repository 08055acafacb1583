//! Balls with centrifugal force and gyroscopic moment.

use super::*;
use crate::testing::assert_close;

/// The 218 of Harris.
fn bearing(balls: Material) -> Balls {
    let ring = steel();
    Balls::new(BallGeometry {
        number: 16,
        diameter: 22.225 * MM,
        pitch_diameter: 125.26 * MM,
        conformity: [0.5232; 2],
        contact_angle: 40.0_f64.to_radians(),
        clearance: 0.0,
        balls,
        rings: ring,
    })
}

fn steel() -> Material {
    let mut steel = Material::STEEL;
    steel.elastic.modulus = 206e9;
    steel
}

struct Expected {
    rpm: f64,
    angles: [f64; 2],
    loads: [f64; 2],
    centrifugal: f64,
    gyroscopic: f64,
    orbital: f64,
    rotation: f64,
    spin: f64,
    axial: f64,
}

#[track_caller]
fn assert_as(balls: Material, expected: &Expected) {
    let bearing = bearing(balls);
    let speed = expected.rpm * std::f64::consts::PI / 30.0;
    let row = bearing.at_speed(speed);
    let found = balanced(&row, Axes::loaded(17_800.0, 0.0));
    assert_close(found.displacement.axial, expected.axial * MM, 1e-7);
    for ball in row.loads(&found.displacement) {
        for ring in [0, 1] {
            assert_close(ball.contacts.angle[ring].to_degrees(), expected.angles[ring], 5e-8);
            assert_close(ball.contacts.load[ring], expected.loads[ring], 5e-8);
        }
        let motion = ball.motion;
        assert_close(motion.orbital / speed, expected.orbital, 5e-8);
        assert_close(motion.rotation / speed, expected.rotation, 5e-8);
        assert_close(motion.spin[0] / speed, expected.spin, 5e-8);
        assert!(motion.spin[1].abs() < 1e-12 * speed, "{}", motion.spin[1]);
        if expected.centrifugal > 0.0 {
            assert_close(motion.centrifugal, expected.centrifugal, 5e-8);
            assert_close(motion.gyroscopic, expected.gyroscopic * MM, 5e-8);
        }
    }
}

/// SciPy.
#[test]
fn the_218_at_rest_and_at_high_speed() {
    let contacts = *bearing(steel()).contacts();
    assert_close(contacts[0].stiffness() * MM.powf(1.5), 1_287_096.1, 5e-8);
    assert_close(contacts[1].stiffness() * MM.powf(1.5), 1_338_814.7, 5e-8);
    let slow = Expected {
        rpm: 1.0,
        angles: [41.502_289; 2],
        loads: [1678.8652; 2],
        centrifugal: 0.0,
        gyroscopic: 0.0,
        orbital: 0.433_558_39,
        rotation: 2.783_106_1,
        spin: -0.662_649_97,
        axial: 0.036_099_408,
    };
    assert_as(steel(), &slow);
    let fast = Expected {
        rpm: 10_000.0,
        angles: [45.406_188, 37.415_187],
        loads: [1562.2765, 2020.2879],
        centrifugal: 595.755_85,
        gyroscopic: 1608.9706,
        orbital: 0.439_850_48,
        rotation: 2.840_946_0,
        spin: -1.056_725_8,
        axial: 0.033_685_748,
    };
    assert_as(steel(), &fast);
    let faster = Expected {
        rpm: 15_000.0,
        angles: [49.961_887, 31.826_827],
        loads: [1453.0770, 2595.3858],
        centrifugal: 1429.4071,
        gyroscopic: 3350.6546,
        orbital: 0.454_210_96,
        rotation: 2.955_571_6,
        spin: -1.562_415_7,
        axial: 0.020_312_988,
    };
    assert_as(steel(), &faster);
}

#[test]
fn the_218_with_balls_of_silicon_nitride() {
    let hybrid = Expected {
        rpm: 10_000.0,
        angles: [42.952_594, 39.727_726],
        loads: [1632.6848, 1814.3005],
        centrifugal: 239.505_22,
        gyroscopic: 680.428_97,
        orbital: 0.435_412_32,
        rotation: 2.802_703_7,
        spin: -0.819_441_38,
        axial: 0.032_106_348,
    };
    assert_as(Material::SILICON_NITRIDE, &hybrid);
}

/// At standstill it is the static equilibrium, whose contacts are in series.
#[test]
fn at_standstill_it_is_static() {
    let bearing = bearing(steel());
    let given = Axes::loaded(5000.0, 9000.0).with_moment(20.0);
    let (still, fixed) = (balanced(&bearing.at_speed(0.0), given), balanced(&bearing, given));
    let balls = bearing.loads(&fixed.displacement);
    for (own, other) in bearing.at_speed(0.0).loads(&still.displacement).zip(balls) {
        if other.load[0] == 0.0 {
            assert_eq!(own.contacts.load, [0.0; 2]);
        } else {
            assert_close(own.contacts.load[0], other.load[0], 1e-9);
        }
    }
    assert_close(still.displacement.axial, fixed.displacement.axial, 1e-9);
    assert_close(
        still.radial_stiffness().unwrap_or_default(),
        fixed.radial_stiffness().unwrap_or_default(),
        1e-7,
    );
}

/// A ball that the inner ring does not touch is pressed to the outer ring by its centrifugal force alone.
#[test]
fn unloaded_balls_run_on_the_outer_ring() {
    let bearing = bearing(steel());
    let row = bearing.at_speed(800.0);
    let found = balanced(&row, Axes::loaded(3000.0, 20_000.0));
    let balls: Vec<BallAtSpeed> = row.loads(&found.displacement).collect();
    let free: Vec<&BallAtSpeed> = balls.iter().filter(|ball| ball.contacts.load[0] == 0.0).collect();
    assert!(!free.is_empty());
    for ball in free {
        assert_close(ball.contacts.load[1], ball.motion.centrifugal, 1e-9);
        assert!(ball.contacts.angle[1].abs() < 1e-9);
    }
}

/// Forces that overflow are no equilibrium, and the search ends.
#[test]
fn an_impossible_speed_has_no_equilibrium() {
    let bearing = bearing(steel());
    for speed in [1e20, 1e150, 1e299, f64::INFINITY] {
        let found = balance(&bearing.at_speed(speed), &Axes::loaded(3000.0, 20_000.0));
        assert!(found.is_err() || speed < 1e100, "{speed}: {found:?}");
    }
    let found = balance(&bearing, &Axes::loaded(f64::NAN, 1.0));
    assert_eq!(found, Err(Unbalanced));
}

/// The stiffness of a ball is the slope of its force, with the change of its inertia: loaded, and barely held.
#[test]
fn stiffness_at_speed_is_a_slope() {
    let bearing = bearing(steel());
    let row = bearing.at_speed(1500.0);
    for place in [[30.0 * UM, 10.0 * UM, 0.0], [-120.0 * UM, 100.0 * UM, 20.0 * UM]] {
        let at = row.force(0, place);
        assert!(at.size > 0.0);
        for to in 0..3 {
            let moved = |step: f64| {
                let mut place = place;
                place[to] += step;
                row.force(0, place).force
            };
            let (ahead, behind) = (moved(1e-4 * UM), moved(-1e-4 * UM));
            for from in 0..3 {
                let slope = (ahead[from] - behind[from]) / (2e-4 * UM);
                assert!(
                    (at.stiffness[from][to] - slope).abs() < 1e-5 * at.stiffness[0][0].abs(),
                    "{from} {to}: {} {slope}",
                    at.stiffness[from][to]
                );
            }
        }
    }
}

/// The stiffness of the ring at speed is the slope of its displacement over the load, though gyroscopic moments make it unsymmetric.
#[test]
fn stiffness_of_the_ring_at_speed_is_a_slope() {
    let bearing = bearing(steel());
    let row = bearing.at_speed(1500.0);
    let at = |axial: f64, radial: f64| balanced(&row, Axes::loaded(axial, radial));
    let (middle, step) = (at(17_800.0, 6000.0), 1.0);
    let axial = at(17_800.0 + step, 6000.0).displacement.axial - at(17_800.0 - step, 6000.0).displacement.axial;
    assert_close(middle.axial_stiffness().unwrap_or_default(), 2.0 * step / axial, 1e-5);
    let [ahead, behind] = [step, -step].map(|step| at(17_800.0, 6000.0 + step).displacement.radial[0]);
    assert_close(
        middle.radial_stiffness().unwrap_or_default(),
        2.0 * step / (ahead - behind),
        1e-5,
    );
}
