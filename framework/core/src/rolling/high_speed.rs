//! Balls whose centrifugal force and gyroscopic moment matter.
//!
//! Source: Jones 1960 and Harris, derived again: the inner ring rotates, the outer ring is at rest and controls, so that the ball does not spin
//! on it: tan(beta) = sin a_o/(cos a_o + D/d_m) for the angle beta of its own axis, F_c = m d_m w_m^2/2, M_g = (m D^2/10) w_m w_R sin(beta).
//! The whole gyroscopic moment is a friction force T = 2 M_g/D at the outer contact, a convention; the ball slips where T exceeds mu Q_o, which is
//! not checked here. The centrifugal force is at the radius d_m/2.

use super::balls::{BallLoad, Balls, along, local};
use super::equilibrium::{Axes, LocalForce, Row};

/// A row of balls at a speed of the inner ring.
#[derive(Debug, Clone, Copy)]
pub struct BallsAtSpeed<'a> {
    balls: &'a Balls,
    /// Magnitude of the speed of the inner ring. \[rad/s\]
    speed: f64,
    /// Mass of a ball. \[kg\]
    mass: f64,
}

/// Motion of a ball and the forces of its inertia.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BallMotion {
    /// Speed of its centre about the axis of the bearing, w_m. \[rad/s\]
    pub orbital: f64,
    /// Speed of the ball about its own axis, w_R. \[rad/s\]
    pub rotation: f64,
    /// Sine and cosine of the angle beta of that axis to the axis of the bearing.
    pub axis: [f64; 2],
    /// Spin in the inner and the outer contact. \[rad/s\]
    pub spin: [f64; 2],
    /// Centrifugal force. \[N\]
    pub centrifugal: f64,
    /// Gyroscopic moment. \[Nm\]
    pub gyroscopic: f64,
}

/// A ball at speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BallAtSpeed {
    /// Its contacts.
    pub contacts: BallLoad,
    /// Its motion.
    pub motion: BallMotion,
}

/// A contact between a ball and a groove: direction from the centre of the groove, distance, load and its slope.
#[derive(Clone, Copy)]
struct GrooveContact {
    direction: [f64; 2],
    distance: f64,
    load: f64,
    slope: f64,
}

impl GrooveContact {
    fn stiffness(&self) -> [[f64; 2]; 2] {
        along(self.direction, self.load, self.slope, self.distance)
    }

    fn angle(&self) -> f64 {
        self.direction[0].atan2(self.direction[1])
    }
}

/// Both contacts of a ball that is in equilibrium.
struct Settled {
    contacts: [GrooveContact; 2],
    motion: BallMotion,
}

fn sum(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j]))
}

fn solve([[a, b], [c, d]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    let determinant = a * d - b * c;
    [(d * x - b * y) / determinant, (a * y - c * x) / determinant]
}

/// Steps after which the search for the place of a ball ends.
const STEPS: usize = 100;

impl Balls {
    /// The same row while the inner ring rotates relative to the outer ring at rest. \[rad/s\]
    pub fn at_speed(&self, speed: f64) -> BallsAtSpeed<'_> {
        let geometry = self.geometry();
        BallsAtSpeed {
            balls: self,
            speed: speed.abs(),
            mass: geometry.balls.density * std::f64::consts::PI * geometry.diameter.powi(3) / 6.0,
        }
    }
}

impl BallsAtSpeed<'_> {
    /// Motion of a ball with contacts in these directions, sine and cosine of the contact angles.
    pub fn motion(&self, [inner, outer]: [[f64; 2]; 2]) -> BallMotion {
        let geometry = self.balls.geometry();
        let ratio = geometry.diameter / geometry.pitch_diameter;
        let axis = {
            let [sin, cos] = [outer[0], outer[1] + ratio];
            let length = (sin * sin + cos * cos).sqrt();
            [sin / length, cos / length]
        };
        let cos_from_axis = |[sin, cos]: [f64; 2]| cos * axis[1] + sin * axis[0];
        let sin_from_axis = |[sin, cos]: [f64; 2]| axis[0] * cos - axis[1] * sin;
        let of_inner = (1.0 - ratio * inner[1]) * cos_from_axis(outer);
        let of_outer = (1.0 + ratio * outer[1]) * cos_from_axis(inner);
        let orbital = self.speed * of_inner / (of_inner + of_outer);
        let rotation = orbital * (1.0 / ratio + outer[1]) / cos_from_axis(outer);
        let inertia = self.mass * geometry.diameter * geometry.diameter / 10.0;
        BallMotion {
            orbital,
            rotation,
            axis,
            spin: [
                rotation * sin_from_axis(inner) - (self.speed - orbital) * inner[0],
                rotation * sin_from_axis(outer) + orbital * outer[0],
            ],
            centrifugal: 0.5 * self.mass * geometry.pitch_diameter * orbital * orbital,
            gyroscopic: inertia * orbital * rotation * axis[0],
        }
    }

    /// Distance of the centres of ball and groove while they just touch. \[m\]
    fn free_distance(&self, ring: usize) -> f64 {
        let geometry = self.balls.geometry();
        (geometry.conformity[ring] - 0.5) * geometry.diameter
    }

    fn groove_contact(&self, ring: usize, to_ball: [f64; 2]) -> GrooveContact {
        let distance = (to_ball[0] * to_ball[0] + to_ball[1] * to_ball[1])
            .sqrt()
            .max(f64::MIN_POSITIVE);
        let approach = (distance - self.free_distance(ring)).max(0.0);
        let slope = 1.5 * self.balls.contacts()[ring].stiffness() * approach.sqrt();
        GrooveContact {
            direction: to_ball.map(|part| part / distance),
            distance,
            load: slope * approach / 1.5,
            slope,
        }
    }

    /// The place of a ball between the centres of the grooves, at a displacement in its plane: `None` if it touches nothing.
    fn settle(&self, displacement: [f64; 3]) -> Option<Settled> {
        let centres = self.balls.centres(displacement);
        let [distance, approach] = self.balls.approach(displacement);
        if approach <= 0.0 && self.speed == 0.0 {
            return None;
        }
        let toward = centres.map(|part| part / distance.max(f64::MIN_POSITIVE));
        let stiffness = self.balls.contacts()[1].stiffness();
        let load = self.balls.stiffness() * approach.max(0.0).powf(1.5);
        let motion = self.motion([toward; 2]);
        let pressed = (load.max(motion.centrifugal) / stiffness).powf(2.0 / 3.0);
        let reach = self.free_distance(1) + pressed;
        // Centre of the ball from that of the outer groove; thrown outwards where the rings do not hold it.
        let mut place = if approach > 0.0 {
            toward.map(|part| part * reach)
        } else {
            [0.0, reach]
        };
        let evaluate = |place: [f64; 2]| {
            let outer = self.groove_contact(1, place);
            let inner = self.groove_contact(0, [centres[0] - place[0], centres[1] - place[1]]);
            let motion = self.motion([inner.direction, outer.direction]);
            let friction = 2.0 * motion.gyroscopic / self.balls.geometry().diameter;
            let [sin, cos] = outer.direction;
            let inertia = [friction * cos, motion.centrifugal - friction * sin];
            let off = [0, 1].map(|i| inner.load * inner.direction[i] - outer.load * outer.direction[i] + inertia[i]);
            let contacts = [inner, outer];
            (Settled { contacts, motion }, inertia, off)
        };
        let (mut at, mut inertia, mut off) = evaluate(place);
        // Slope of the forces of inertia, from their changes so far (Broyden).
        let mut slope = [[0.0; 2]; 2];
        for _ in 0..STEPS {
            let size = off[0].hypot(off[1]);
            let forces = at.contacts[0].load + at.contacts[1].load + at.motion.centrifugal;
            let stiffness = sum(at.contacts[0].stiffness(), at.contacts[1].stiffness());
            let step = solve(sum(stiffness, slope.map(|row| row.map(|x| -x))), off);
            if size <= 1e-14 * forces || !(step[0].is_finite() && step[1].is_finite()) {
                break;
            }
            let mut share = 1.0;
            let (next, reached, changed, left) = loop {
                let next = [place[0] + share * step[0], place[1] + share * step[1]];
                let (reached, changed, left) = evaluate(next);
                if left[0].hypot(left[1]) < size || share < 1e-3 {
                    break (next, reached, changed, left);
                }
                // Rounding.
                if size <= 1e-12 * forces {
                    return Some(at);
                }
                share *= 0.5;
            };
            let moved = [next[0] - place[0], next[1] - place[1]];
            let square = moved[0] * moved[0] + moved[1] * moved[1];
            if square == 0.0 {
                break;
            }
            for i in [0, 1] {
                let expected = slope[i][0] * moved[0] + slope[i][1] * moved[1];
                let missed = (changed[i] - inertia[i] - expected) / square;
                slope[i] = [slope[i][0] + missed * moved[0], slope[i][1] + missed * moved[1]];
            }
            (place, at, inertia, off) = (next, reached, changed, left);
        }
        Some(at)
    }

    /// The balls in their order at a displacement of the inner ring; a ball that touches nothing has no motion.
    pub fn loads(&self, displacement: &Axes<f64>) -> impl Iterator<Item = BallAtSpeed> {
        let displacement = *displacement;
        (0..self.directions().len()).map(move |ball| {
            let settled = self.settle(self.in_plane(ball, &displacement));
            settled.map_or_else(BallAtSpeed::default, |at| BallAtSpeed {
                contacts: BallLoad {
                    load: at.contacts.map(|contact| contact.load),
                    angle: at.contacts.map(|contact| contact.angle()),
                },
                motion: at.motion,
            })
        })
    }
}

impl Row for BallsAtSpeed<'_> {
    fn directions(&self) -> &[[f64; 2]] {
        self.balls.directions()
    }

    fn radius(&self) -> f64 {
        self.balls.radius()
    }

    fn force(&self, _element: usize, displacement: [f64; 3]) -> LocalForce {
        let Some(at) = self.settle(displacement) else {
            return LocalForce::default();
        };
        let [inner, outer] = at.contacts;
        if inner.load <= 0.0 {
            return LocalForce::default();
        }
        // The ball gives way; the small change of the gyroscopic moment is neglected in the stiffness, not in the force.
        let of_inner = inner.stiffness();
        let both = sum(of_inner, outer.stiffness());
        let columns = [0, 1].map(|j| solve(both, [of_inner[0][j], of_inner[1][j]]));
        let k = [0, 1]
            .map(|i| [0, 1].map(|j| of_inner[i][j] - of_inner[i][0] * columns[j][0] - of_inner[i][1] * columns[j][1]));
        local(inner.direction.map(|part| inner.load * part), k, inner.load)
    }

    fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        self.balls.guess(axial, radial)
    }
}
