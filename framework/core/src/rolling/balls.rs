//! A row of balls between two grooves.
//!
//! Source: ISO/TS 16281:2008 and Harris, as printed by a public program: with the distance A = (f_i + f_o - 1) D of the centres of the
//! grooves and the radius R_i of those of the inner ring, X = A cos a0 + delta_r cos phi and Y = A sin a0 + delta_a + R_i psi cos phi, the
//! approach of the rings at a ball is sqrt(X^2 + Y^2) - A, its contact angle atan2(Y, X), its load c_p times the power 3/2 of the approach.
//! The curvatures of the contacts are those at the nominal contact angle. The technical specification rounds c_p to a factor of 1.48, 0.065 %
//! lower; here it is that of Hertz. Its moment has the arm d_m/2; here it is R_i, the arm of the displacement, so that the work of a moment is
//! stored in the contacts.

use super::equilibrium::{Axes, LocalForce, Row};
use super::material::Material;
use super::point_contact::PointContact;

/// Internal geometry of a row of balls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallGeometry {
    /// Number of balls.
    pub number: usize,
    /// Diameter D of a ball. \[m\]
    pub diameter: f64,
    /// Diameter d_m of the circle of their centres. \[m\]
    pub pitch_diameter: f64,
    /// Radius of the groove over D: of the inner and of the outer ring.
    pub conformity: [f64; 2],
    /// Contact angle of the bearing without clearance, in which axial displacement is zero; zero for a bearing with clearance. \[rad\]
    pub contact_angle: f64,
    /// Radial clearance, from side to side, of a bearing without contact angle, in whose centre axial displacement is zero; negative with
    /// preload. \[m\]
    pub clearance: f64,
    /// Material of the balls.
    pub balls: Material,
    /// Material of the rings.
    pub rings: Material,
}

impl BallGeometry {
    /// Distance A of the centres of both grooves if the ball touches both. \[m\]
    pub fn groove_distance(&self) -> f64 {
        (self.conformity[0] + self.conformity[1] - 1.0) * self.diameter
    }

    /// Relative radii of the contact with the inner ring (`0`) or the outer ring (`1`) along and across the direction of rolling, from the cosine of
    /// its contact angle. \[m\]
    pub fn radii(&self, ring: usize, cos: f64) -> [f64; 2] {
        let gamma = self.diameter * cos / self.pitch_diameter;
        let side = [1.0, -1.0][ring];
        let conformity = self.conformity[ring];
        [
            0.5 * self.diameter * (1.0 - side * gamma),
            self.diameter * conformity / (2.0 * conformity - 1.0),
        ]
    }

    fn contact(&self, ring: usize) -> PointContact {
        let [along, across] = self.radii(ring, self.contact_angle.cos());
        PointContact::new(along, across, self.balls.contact_modulus(&self.rings))
    }
}

/// A row of balls at rest, or so slow that their inertia does not matter.
#[derive(Debug, Clone)]
pub struct Balls {
    geometry: BallGeometry,
    contacts: [PointContact; 2],
    /// Load over the power 3/2 of the approach of the rings. \[N/m^1.5\]
    stiffness: f64,
    /// From the centre of the outer groove to that of the inner groove at zero displacement: axial, radial. \[m\]
    centre: [f64; 2],
    /// Square of their distance less A^2. \[m2\]
    excess: f64,
    /// Radius R_i of the centres of the inner groove. \[m\]
    radius: f64,
    directions: Vec<[f64; 2]>,
}

/// One ball under load. Values of the inner and of the outer contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BallLoad {
    /// Loads of the contacts, equal without inertia. \[N\]
    pub load: [f64; 2],
    /// Contact angles. \[rad\]
    pub angle: [f64; 2],
}

/// Positions of elements, the first one in the direction of y.
pub(super) fn directions(number: usize) -> Vec<[f64; 2]> {
    let angle = |element: usize| std::f64::consts::TAU * element as f64 / number as f64;
    (0..number).map(|j| [angle(j).cos(), angle(j).sin()]).collect()
}

impl Balls {
    /// A row with its contacts.
    pub fn new(geometry: BallGeometry) -> Self {
        let contacts = [0, 1].map(|ring| geometry.contact(ring));
        let compliance: f64 = contacts
            .iter()
            .map(|contact| contact.stiffness().powf(-2.0 / 3.0))
            .sum();
        let distance = geometry.groove_distance();
        let loose = 0.5 * geometry.clearance;
        let (sin, cos) = geometry.contact_angle.sin_cos();
        let free_cos = (cos - loose / distance).min(1.0);
        Self {
            contacts,
            stiffness: compliance.powf(-1.5),
            centre: [distance * sin, distance * cos - loose],
            excess: loose * (loose - 2.0 * distance * cos),
            radius: 0.5 * geometry.pitch_diameter + (geometry.conformity[0] - 0.5) * geometry.diameter * free_cos,
            directions: directions(geometry.number),
            geometry,
        }
    }

    /// The internal geometry.
    pub fn geometry(&self) -> &BallGeometry {
        &self.geometry
    }

    /// Contacts of a ball with the inner and the outer ring.
    pub fn contacts(&self) -> &[PointContact; 2] {
        &self.contacts
    }

    /// Load over the power 3/2 of the approach of both rings. \[N/m^1.5\]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Distance of the pressure centre, in which a radial load does not tilt the ring, from the plane of the centres of the inner groove, about which
    /// the moments of the row are, along the axis. \[m\]
    pub fn pressure_centre(&self) -> f64 {
        self.radius * self.geometry.contact_angle.tan()
    }

    /// From the centre of the outer groove to that of the inner groove at a displacement in the plane of a ball: axial, radial. \[m\]
    pub(super) fn centres(&self, [axial, radial, tilt]: [f64; 3]) -> [f64; 2] {
        [self.centre[0] + axial + tilt, self.centre[1] + radial]
    }

    /// Direction of the contacts, of any length.
    pub(super) fn toward(&self, displacement: [f64; 3]) -> [f64; 2] {
        let [axial, radial] = self.centres(displacement);
        [axial, radial.max(0.0)]
    }

    /// The distance of these centres, over which the contact turns, and by how much it exceeds A, without the cancellation of a difference. Beyond
    /// a quarter turn the walls of the grooves are taken as straight, so that the approach stays a convex function. \[m\]
    pub(super) fn approach(&self, [axial, radial, tilt]: [f64; 3]) -> [f64; 2] {
        let moved = [axial + tilt, radial];
        let [y, x] = [self.centre[0] + moved[0], self.centre[1] + moved[1]];
        if x <= 0.0 {
            return [f64::INFINITY, y.abs() - self.geometry.groove_distance()];
        }
        let distance = x.hypot(y);
        let along = self.centre[0] * moved[0] + self.centre[1] * moved[1];
        let excess = 2.0 * along + moved[0] * moved[0] + moved[1] * moved[1] + self.excess;
        [distance, excess / (distance + self.geometry.groove_distance())]
    }

    /// The balls in their order at a displacement of the inner ring.
    pub fn loads(&self, displacement: &Axes<f64>) -> impl Iterator<Item = BallLoad> {
        let displacement = *displacement;
        (0..self.directions.len()).map(move |ball| {
            let plane = self.in_plane(ball, &displacement);
            let [axial, radial] = self.toward(plane);
            let load = self.stiffness * self.approach(plane)[1].max(0.0).powf(1.5);
            BallLoad {
                load: [load; 2],
                angle: [axial.atan2(radial); 2],
            }
        })
    }

    /// A first guess of displacements, as [`Row::guess`].
    pub(super) fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        let number = self.directions.len() as f64;
        let sine = self.geometry.contact_angle.sin().max(0.2);
        let approach = |load: f64| (load / (number * self.stiffness)).powf(2.0 / 3.0);
        let across = approach(5.0 * radial) + 0.5 * self.geometry.clearance.max(0.0);
        // Along the axis the grooves have to turn before they touch.
        let distance = self.geometry.groove_distance() + approach(axial.abs() / sine);
        let turned = (distance * distance - self.centre[1] * self.centre[1]).max(0.0).sqrt();
        [axial.signum() * turned - self.centre[0], across]
    }
}

/// Force of a contact along a direction (axial, radial) as a force on the ring, with its derivatives; `slope` is that of the load over the
/// approach, `distance` that of the centres, over which the direction turns.
pub(super) fn along([axial, radial]: [f64; 2], load: f64, slope: f64, distance: f64) -> [[f64; 2]; 2] {
    let across = load / distance;
    [
        [
            slope * axial * axial + across * radial * radial,
            (slope - across) * axial * radial,
        ],
        [
            (slope - across) * axial * radial,
            slope * radial * radial + across * axial * axial,
        ],
    ]
}

/// The same of a force in the axial and the radial direction with its derivatives, where a tilt moves as an axial displacement.
pub(super) fn local(force: [f64; 2], k: [[f64; 2]; 2], size: f64) -> LocalForce {
    let [axial, radial] = force;
    let [[aa, ar], [ra, rr]] = k;
    LocalForce {
        force: [axial, radial, axial],
        stiffness: [[aa, ar, aa], [ra, rr, ra], [aa, ar, aa]],
        size,
    }
}

impl Row for Balls {
    fn directions(&self) -> &[[f64; 2]] {
        &self.directions
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn force(&self, _element: usize, displacement: [f64; 3]) -> LocalForce {
        let [distance, approach] = self.approach(displacement);
        if approach <= 0.0 {
            return LocalForce::default();
        }
        let toward = self.toward(displacement);
        let [axial, radial] = if distance.is_finite() {
            toward.map(|part| part / distance)
        } else {
            [toward[0].signum(), 0.0]
        };
        let slope = 1.5 * self.stiffness * approach.sqrt();
        let load = slope * approach / 1.5;
        let k = along([axial, radial], load, slope, distance);
        local([load * axial, load * radial], k, load)
    }

    fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        Balls::guess(self, axial, radial)
    }
}
