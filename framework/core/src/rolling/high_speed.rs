//! Balls whose centrifugal force and gyroscopic moment matter.
//!
//! Source: Jones 1960 and Harris, derived again: the inner ring rotates, the outer ring is at rest and controls, so that the ball does not spin
//! on it: tan(beta) = sin a_o/(cos a_o + D/d_m) for the angle beta of its own axis, F_c = m d_m w_m^2/2, M_g = (m D^2/10) w_m w_R sin(beta).
//! The whole gyroscopic moment is a friction force T = 2 M_g/D at the outer contact, a convention; the ball slips where T exceeds mu Q_o, which is
//! not checked here. The centrifugal force is at the radius d_m/2.
//!
//! With this axis the speeds of Jones shorten to w_m = w (1 - (D/d_m) cos a_i)/(1 + cos(a_i - a_o)), and T to 2/5 F_c sin a_o, so that both forces
//! of inertia have derivatives in closed form.

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

/// A contact between a ball and a groove: direction from the centre of the groove, distance over which it turns, load and its slope.
#[derive(Clone, Copy)]
struct GrooveContact {
    direction: [f64; 2],
    distance: f64,
    load: f64,
    slope: f64,
}

impl GrooveContact {
    fn stiffness(&self) -> Matrix {
        along(self.direction, self.load, self.slope, self.distance)
    }

    /// Change of the contact angle with the place of the ball. \[rad/m\]
    fn turn(&self) -> [f64; 2] {
        let [sin, cos] = self.direction;
        [cos / self.distance, -sin / self.distance]
    }

    fn angle(&self) -> f64 {
        self.direction[0].atan2(self.direction[1])
    }
}

/// Both contacts of a ball that is in equilibrium.
#[derive(Clone, Copy)]
struct Settled {
    contacts: [GrooveContact; 2],
    /// Forces of inertia, and their changes with the angles of the inner and of the outer contact. \[N, N/rad\]
    inertia: [f64; 2],
    turned: [[f64; 2]; 2],
    centrifugal: f64,
}

impl Settled {
    /// Forces on the ball that are not balanced. \[N\]
    fn off(&self) -> [f64; 2] {
        let [inner, outer] = &self.contacts;
        [0, 1].map(|i| inner.load * inner.direction[i] - outer.load * outer.direction[i] + self.inertia[i])
    }

    /// Change of the forces of inertia as the ball moves away from the groove of a ring. \[N/m\]
    fn inertia_slope(&self, ring: usize) -> Matrix {
        let turn = self.contacts[ring].turn();
        self.turned[ring].map(|force| turn.map(|angle| force * angle))
    }

    /// Resistance of the ball to being moved, and the change of the forces on it with the place of the inner groove. \[N/m\]
    fn stiffness(&self) -> [Matrix; 2] {
        let [inner, outer] = self.contacts.map(|contact| contact.stiffness());
        let of_inner = combine(inner, self.inertia_slope(0), |a, b| a + b);
        let of_outer = combine(outer, self.inertia_slope(1), |a, b| a - b);
        [combine(of_inner, of_outer, |a, b| a + b), of_inner]
    }
}

type Matrix = [[f64; 2]; 2];

fn combine(a: Matrix, b: Matrix, of: impl Fn(f64, f64) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| of(a[i][j], b[i][j])))
}

fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

fn solve([[a, b], [c, d]]: Matrix, [x, y]: [f64; 2]) -> [f64; 2] {
    let determinant = a * d - b * c;
    [(d * x - b * y) / determinant, (a * y - c * x) / determinant]
}

fn dot([a, b]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    a * x + b * y
}

/// Newton's step; with a share of stiffness added where it does not resist, as to a ball that touches nothing.
fn downhill(stiffness: Matrix, off: [f64; 2], least: f64) -> [f64; 2] {
    let [[a, b], [c, d]] = stiffness;
    let mean = 0.5 * (b + c);
    if a > 0.0 && a * d - mean * mean > 1e-12 * a * a {
        return solve(stiffness, off);
    }
    // The least eigenvalue of the symmetric part.
    let lowest = 0.5 * (a + d) - (0.25 * (a - d) * (a - d) + mean * mean).sqrt();
    let shift = least - lowest.min(0.0);
    solve([[a + shift, b], [c, d + shift]], off)
}

/// Friction of the gyroscopic moment over the centrifugal force and the sine of the outer contact angle: 2/D times m D^2/10 times d_m/D over m d_m/2.
const GYROSCOPIC: f64 = 0.4;
/// Rounding of a place over that of a force as [`LocalForce::size`] has it.
const ROUNDING_OF_PLACES: f64 = 2.0 * f64::EPSILON / 1e-14;
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
        let axis = [outer[0], outer[1] + ratio];
        let length = axis[0].hypot(axis[1]);
        let axis = axis.map(|part| part / length);
        let sin_from_axis = |[sin, cos]: [f64; 2]| axis[0] * cos - axis[1] * sin;
        let orbital = self.orbital(inner, outer);
        let rotation = orbital * length / ratio;
        let centrifugal = self.centrifugal(orbital);
        BallMotion {
            orbital,
            rotation,
            axis,
            spin: [
                rotation * sin_from_axis(inner) - (self.speed - orbital) * inner[0],
                rotation * sin_from_axis(outer) + orbital * outer[0],
            ],
            centrifugal,
            gyroscopic: 0.5 * GYROSCOPIC * centrifugal * outer[0] * geometry.diameter,
        }
    }

    /// Speed of the centre of a ball about the axis of the bearing. \[rad/s\]
    fn orbital(&self, inner: [f64; 2], outer: [f64; 2]) -> f64 {
        let geometry = self.balls.geometry();
        let ratio = geometry.diameter / geometry.pitch_diameter;
        self.speed * (1.0 - ratio * inner[1]) / (1.0 + inner[1] * outer[1] + inner[0] * outer[0])
    }

    fn centrifugal(&self, orbital: f64) -> f64 {
        0.5 * self.mass * self.balls.geometry().pitch_diameter * orbital * orbital
    }

    /// A ball at a place from the centre of the outer groove, with that of the inner groove.
    fn at(&self, place: [f64; 2], centres: [f64; 2]) -> Settled {
        let outer = self.groove_contact(1, place);
        let inner = self.groove_contact(0, [centres[0] - place[0], centres[1] - place[1]]);
        let ([sin_i, cos_i], [sin, cos]) = (inner.direction, outer.direction);
        let geometry = self.balls.geometry();
        let ratio = geometry.diameter / geometry.pitch_diameter;
        let centrifugal = self.centrifugal(self.orbital(inner.direction, outer.direction));
        let inertia = [
            GYROSCOPIC * centrifugal * sin * cos,
            centrifugal * (1.0 - GYROSCOPIC * sin * sin),
        ];
        // Twice the relative change of the speed with each angle.
        let apart = 2.0 * (sin_i * cos - cos_i * sin) / (1.0 + cos_i * cos + sin_i * sin);
        let of_inner = 2.0 * ratio * sin_i / (1.0 - ratio * cos_i) + apart;
        let turned = [
            inertia.map(|force| of_inner * force),
            [
                GYROSCOPIC * centrifugal * (cos * cos - sin * sin) - apart * inertia[0],
                -2.0 * GYROSCOPIC * centrifugal * sin * cos - apart * inertia[1],
            ],
        ];
        Settled {
            contacts: [inner, outer],
            inertia,
            turned,
            centrifugal,
        }
    }

    /// Distance of the centres of ball and groove while they just touch. \[m\]
    fn free_distance(&self, ring: usize) -> f64 {
        let geometry = self.balls.geometry();
        (geometry.conformity[ring] - 0.5) * geometry.diameter
    }

    fn groove_contact(&self, ring: usize, to_ball: [f64; 2]) -> GrooveContact {
        let [along, across] = to_ball;
        // Beyond a quarter turn the wall of the groove is taken as straight, so that a ball on the far side of its centre does not touch it.
        let is_round = across > 0.0;
        let reached = [along, if is_round { across } else { 0.0 }];
        let distance = norm(reached).max(f64::MIN_POSITIVE);
        let approach = (distance - self.free_distance(ring)).max(0.0);
        let slope = 1.5 * self.balls.contacts()[ring].stiffness() * approach.sqrt();
        GrooveContact {
            direction: reached.map(|part| part / distance),
            distance: if is_round { distance } else { f64::INFINITY },
            load: slope * approach / 1.5,
            slope,
        }
    }

    /// Distance of the centres of ball and groove under a load. \[m\]
    fn distance_under(&self, ring: usize, load: f64) -> f64 {
        let stiffness = self.balls.contacts()[ring].stiffness();
        self.free_distance(ring) + (load / stiffness).powf(2.0 / 3.0)
    }

    /// About where a ball comes to rest that is thrown outwards: at the bottom of the outer groove or, if the inner groove holds it, pressed into
    /// both.
    fn thrown(&self, centrifugal: f64, centres: [f64; 2]) -> [f64; 2] {
        let [inner, outer] = [0, 1].map(|ring| self.distance_under(ring, centrifugal));
        let bottom = [0.0, outer];
        if norm([centres[0], (centres[1] - outer).max(0.0)]) <= self.free_distance(0) {
            return bottom;
        }
        // The corner of both circles that is further outwards.
        let distance = norm(centres).max(f64::MIN_POSITIVE);
        let [sin, cos] = centres.map(|part| part / distance);
        let along = 0.5 * (distance + (outer - inner) * (outer + inner) / distance);
        let across = ((outer - along) * (outer + along)).max(0.0).sqrt().copysign(sin);
        [along * sin - across * cos, along * cos + across.abs() * sin.abs()]
    }

    /// The place of a ball between the centres of the grooves, at a displacement in its plane: `None` if it touches nothing.
    fn settle(&self, displacement: [f64; 3]) -> Option<Settled> {
        let centres = self.balls.centres(displacement);
        let [_, approach] = self.balls.approach(displacement);
        if approach <= 0.0 && self.speed == 0.0 {
            return None;
        }
        let toward = self.balls.toward(displacement);
        let length = toward[0].hypot(toward[1]).max(f64::MIN_POSITIVE);
        let toward = toward.map(|part| part / length);
        let load = self.balls.stiffness() * approach.max(0.0).powf(1.5);
        let centrifugal = self.centrifugal(self.orbital(toward, toward));
        let mut place = if load > centrifugal {
            toward.map(|part| part * self.distance_under(1, load))
        } else {
            self.thrown(centrifugal, centres)
        };
        let mut at = self.at(place, centres);
        let mut best = (f64::INFINITY, at);
        // The contacts store energy that is a convex function of the place, so that steps downhill find the only rest.
        let reach = 0.1 * (self.free_distance(0) + self.free_distance(1));
        for _ in 0..STEPS {
            let off = at.off();
            let size = norm(off);
            if size < best.0 {
                best = (size, at);
            }
            let forces = at.contacts[0].load + at.contacts[1].load + at.centrifugal;
            if size <= 1e-14 * forces {
                break;
            }
            let step = downhill(at.stiffness()[0], off, size / reach);
            let length = norm(step);
            if !length.is_finite() {
                break;
            }
            let step = step.map(|part| part * (reach / length).min(1.0));
            let slope = dot(off, step);
            let mut share = 1.0;
            let (next, reached) = loop {
                let next = [place[0] + share * step[0], place[1] + share * step[1]];
                let reached = self.at(next, centres);
                if dot(reached.off(), step) >= -0.25 * slope || share < 1e-9 {
                    break (next, reached);
                }
                share *= 0.5;
            };
            // Rounding.
            if next == place || (size <= 1e-12 * forces && norm(reached.off()) >= size) {
                break;
            }
            (place, at) = (next, reached);
        }
        Some(best.1)
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
                motion: self.motion(at.contacts.map(|contact| contact.direction)),
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
        let inner = at.contacts[0];
        if inner.load <= 0.0 {
            return LocalForce::default();
        }
        // The ball gives way.
        let (of_inner, [both, moved]) = (inner.stiffness(), at.stiffness());
        let columns = [0, 1].map(|j| solve(both, [moved[0][j], moved[1][j]]));
        let k = [0, 1]
            .map(|i| [0, 1].map(|j| of_inner[i][j] - of_inner[i][0] * columns[j][0] - of_inner[i][1] * columns[j][1]));
        // Under the lightest loads, rounding of the places decides.
        let places = ROUNDING_OF_PLACES * inner.slope * self.balls.geometry().groove_distance();
        let size = inner.load.max(at.contacts[1].load).max(places);
        local(inner.direction.map(|part| inner.load * part), k, size)
    }

    fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        // Balls that are thrown outwards open the bearing as a load on all of them does.
        let slow = self.centrifugal(0.5 * self.speed);
        self.balls
            .guess(axial, radial + self.balls.directions().len() as f64 * slow)
    }
}
