//! Many random bearings, of which every one has its equilibrium.

use super::*;
use crate::random::Random;

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    fn is(&mut self, probability: f64) -> bool {
        self.share() < probability
    }
}

/// A ball bearing at speed and the loads on its ring.
struct Fast {
    geometry: BallGeometry,
    /// \[rad/s\]
    speed: f64,
    given: Axes<Given>,
}

impl Fast {
    /// One of any size of load and a speed factor of up to 3e6 mm/min; thrust enough for its contact angle at rest.
    fn any(random: &mut Random) -> Self {
        let number = random.between(3.0, 31.0) as usize;
        let diameter = random.between(2.0, 30.0) * MM;
        let least = 1.05 * diameter / (std::f64::consts::PI / number as f64).sin();
        let pitch_diameter = (random.between(1.0, 1.6) * least).max(2.5 * diameter);
        let contact_angle = if random.is(0.5) {
            random.between(10.0, 45.0).to_radians()
        } else {
            0.0
        };
        let clearance = if contact_angle == 0.0 && random.is(0.7) {
            random.between(-10.0, 60.0) * UM
        } else {
            0.0
        };
        let geometry = BallGeometry {
            number,
            diameter,
            pitch_diameter,
            conformity: [random.between(0.505, 0.55), random.between(0.505, 0.55)],
            contact_angle,
            clearance,
            balls: if random.is(0.3) {
                Material::SILICON_NITRIDE
            } else {
                Material::STEEL
            },
            rings: Material::STEEL,
        };
        // Up to about 60 N/mm2 of the squared diameter for each ball.
        let size = number as f64 * (1e3 * diameter).powi(2) * 60.0;
        let of_size = |random: &mut Random| size * 10_f64.powf(random.between(-4.0, 0.0));
        let radial = if random.is(0.9) { of_size(random) } else { 0.0 };
        let axial = if contact_angle > 0.0 {
            (1.2 + random.share()) * radial * contact_angle.tan() + of_size(random)
        } else if random.is(0.7) {
            of_size(random)
        } else {
            0.0
        };
        let given = Axes::loaded(axial, radial);
        let given = match (3.0 * random.share()) as u32 {
            0 => given,
            1 => given.with_tilt(random.between(-3e-3, 3e-3)),
            _ => given.with_moment(random.between(-0.05, 0.05) * (radial + axial) * pitch_diameter),
        };
        let factor = 10_f64.powf(random.between(5.0, 3e6_f64.log10()));
        Self {
            geometry,
            speed: factor / (1e3 * pitch_diameter) * std::f64::consts::PI / 30.0,
            given,
        }
    }

    /// The same under loads from a millinewton, up to a speed factor of 4e6 mm/min.
    fn light(random: &mut Random) -> Self {
        let Self { geometry, .. } = Self::any(random);
        let size = (1e2 * geometry.diameter).powi(2);
        let mut load = || size * 10_f64.powf(random.between(-3.0, 4.0));
        let (radial, axial) = (load(), load());
        let least = 1.2 * radial * geometry.contact_angle.tan();
        let factor = 10_f64.powf(random.between(5.0, 4e6_f64.log10()));
        Self {
            geometry,
            speed: factor / (1e3 * geometry.pitch_diameter) * std::f64::consts::PI / 30.0,
            given: Axes::loaded(axial.max(least), radial),
        }
    }

    /// The equilibrium, and the largest difference between its loads and the forces of the balls, moments over the radius, over the loads and the
    /// forces of inertia.
    fn off(&self) -> Option<f64> {
        let balls = Balls::new(self.geometry);
        let row = balls.at_speed(self.speed);
        let found = balls.balance_at_speed(self.speed, &self.given).ok()?;
        let radius = balls.radius();
        let (mut forces, mut size) = ([0.0; 5], 0.0);
        for (ball, [cos, sin]) in row.loads(&found.displacement).zip(balls.directions()) {
            let [inner, outer] = ball.contacts.load;
            let (along, across) = (
                inner * ball.contacts.angle[0].sin(),
                inner * ball.contacts.angle[0].cos(),
            );
            for (sum, part) in forces
                .iter_mut()
                .zip([along, across * cos, across * sin, along * cos, along * sin])
            {
                *sum += part;
            }
            size += 1e-3 * outer;
        }
        let lengths = [1.0, 1.0, 1.0, radius, radius];
        let mut most = 0.0_f64;
        for ((given, force), length) in self.given.array().into_iter().zip(forces).zip(lengths) {
            if let Given::Load(load) = given {
                most = most.max((force - load / length).abs());
                size += (load / length).abs();
            }
        }
        Some(if most == 0.0 { 0.0 } else { most / size })
    }
}

#[track_caller]
fn assert_balanced(bearings: usize, most: f64, any: fn(&mut Random) -> Fast) {
    let mut random = Random(1);
    for number in 0..bearings {
        let bearing = any(&mut random);
        match bearing.off() {
            Some(off) => assert!(off <= most, "{number}: {off:e}"),
            None => panic!("{number}: {:?} {:?} {}", bearing.given, bearing.geometry, bearing.speed),
        }
    }
}

/// Without steps of speed some are not found, and without walls that stay straight beyond a quarter turn balls on the far side of the centre of
/// the groove are pressed to it.
#[test]
fn every_fast_bearing_has_an_equilibrium() {
    assert_balanced(5000, 1e-10, Fast::any);
}

/// Rounding of the places of balls is a greater share of light loads.
#[test]
fn every_fast_bearing_with_little_load_has_an_equilibrium() {
    assert_balanced(2000, 1e-8, Fast::light);
}
