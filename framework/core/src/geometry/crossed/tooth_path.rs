//! Motion of both flanks along the path of contact of a crossed pair.
//!
//! The path runs along the normal of the flanks at the mean point, which is exact for crossed helical and cylindrical teeth, and that of the
//! virtual pair for bevel and hypoid teeth. Sliding is a vector that changes linearly along it: across the contact as in a cylindrical pair, and
//! lengthwise by the offset.

use nalgebra::{Vector2, Vector3};

use super::mean_point::MeanPoint;
use super::motion::{CrossedMotion, Velocity};

/// Path of contact of a flank, for a speed of one of the first gear. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothPath {
    frame: MeanPoint,
    flank_normal: Vector3<f64>,
    /// Perpendicular to the line of contact in the tangent plane of the flanks.
    across: Vector3<f64>,
    /// Ends along the normal; the start is at the tip of the first gear.
    pub ends: [f64; 2],
}

impl ToothPath {
    /// Of a flank with the lengths from the pitch point to both tips in the transverse plane of the virtual pair, its base helix angle, and the
    /// inclination of the line of contact to the trace. \[m, rad\]
    pub fn new(
        frame: &MeanPoint,
        flank_normal: Vector3<f64>,
        to_tip: [f64; 2],
        (base_helix, inclination): (f64, f64),
    ) -> Self {
        // The line of contact is turned from the trace towards the axis of the relative rotation.
        let in_flank = flank_normal.cross(&frame.trace);
        let turning = frame.turning();
        let side = if turning.dot(&in_flank) * turning.dot(&frame.trace) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let line = frame.trace * inclination.cos() + in_flank * (side * inclination.sin());
        Self {
            frame: *frame,
            flank_normal,
            across: flank_normal.cross(&line),
            ends: [-to_tip[0] / base_helix.cos(), to_tip[1] / base_helix.cos()],
        }
    }

    /// Of a flank with its ends along the normal and the direction of its line of contact, or of the long axis of a point contact.
    pub(super) fn across_line(
        frame: &MeanPoint,
        flank_normal: Vector3<f64>,
        ends: [f64; 2],
        line: Vector3<f64>,
    ) -> Self {
        Self {
            frame: *frame,
            flank_normal,
            across: flank_normal.cross(&line),
            ends,
        }
    }

    /// Sliding velocity at a place along the path, over the speed of the first gear. \[m\]
    pub fn sliding(&self, s: f64) -> Vector3<f64> {
        let [first, second] = self.frame.velocities(self.flank_normal * s);
        first - second
    }

    /// Velocities of both surfaces across the line of contact, over the speed of the first gear. \[m\]
    pub fn rolling(&self, s: f64) -> [f64; 2] {
        self.frame
            .velocities(self.flank_normal * s)
            .map(|velocity| velocity.dot(&self.across))
    }

    /// The motion over the position in the transverse plane, from the pitch point towards the tip of the first gear, for the cosine of the base
    /// helix angle; with the relative radius of curvature over that of the virtual cylinders.
    pub(super) fn motion(&self, cos_base_helix: f64, radius_factor: f64) -> CrossedMotion {
        let in_flank = self.flank_normal.cross(&self.frame.trace);
        let in_plane = |v: Vector3<f64>| Vector2::new(v.dot(&self.frame.trace), v.dot(&in_flank));
        let velocity = |at: Vector3<f64>, change: Vector3<f64>| Velocity {
            at_pitch: in_plane(at),
            change: in_plane(change) / -cos_base_helix,
        };
        let first = self.frame.velocities(Vector3::zeros())[0];
        CrossedMotion {
            first: velocity(first, self.frame.axis[0].cross(&self.flank_normal)),
            sliding: velocity(self.frame.sliding(), self.frame.turning().cross(&self.flank_normal)),
            across: in_plane(self.across),
            radius_factor,
            spot: None,
        }
    }

    /// Mean sliding velocity with even load along the path, over the speed of the first gear. \[m\]
    pub fn mean_sliding(&self) -> f64 {
        let turning = self.turning();
        self.mean(|t| {
            let speed = turning.speed(t);
            f64::midpoint(t * speed, turning.least.norm_squared() * turning.logarithm(t))
        })
    }

    /// Mean arm of the friction force about the first axis, over the coefficient of friction, with even load. \[m\]
    pub fn mean_friction_arm(&self) -> f64 {
        let turning = self.turning();
        let (least, change) = (turning.least, turning.change);
        let [first, _] = self.frame.velocities(self.flank_normal * turning.place);
        let along = self.frame.axis[0].cross(&self.flank_normal);
        let products = [
            least.dot(&first),
            change.dot(&first) + least.dot(&along),
            change.dot(&along),
        ];
        let steepness = change.norm_squared();
        self.mean(|t| {
            let speed = turning.speed(t);
            let logarithm = turning.logarithm(t);
            let second = (t * speed - least.norm_squared() * logarithm) / (2.0 * steepness);
            products[0] * logarithm + products[1] * speed / steepness + products[2] * second
        })
    }

    /// Mean friction force of one newton along the path, with even load, on the first gear turning forwards, and its mean moment about the
    /// mean point. Its power over the speed of the first gear is minus the mean sliding velocity. \[-, m\]
    pub fn mean_friction(&self) -> (Vector3<f64>, Vector3<f64>) {
        let turning = self.turning();
        let (least, change, place) = (turning.least, turning.change, turning.place);
        let steepness = change.norm_squared();
        // Means of 1/v, t/v and t^2/v over the distance t from the place of least sliding, v the sliding speed.
        let inverse = self.mean(|t| turning.logarithm(t));
        let first = self.mean(|t| turning.speed(t) / steepness);
        let second =
            self.mean(|t| (t * turning.speed(t) - least.norm_squared() * turning.logarithm(t)) / (2.0 * steepness));
        let force = -(least * inverse + change * first);
        let weighted = least * (first + place * inverse) + change * (second + place * first);
        (force, -self.flank_normal.cross(&weighted))
    }

    /// Mean along the path of what has this primitive over the distance from the place of least sliding.
    fn mean(&self, primitive: impl Fn(f64) -> f64) -> f64 {
        let place = self.turning().place;
        let [start, end] = self.ends;
        (primitive(end - place) - primitive(start - place)) / (end - start)
    }

    fn turning(&self) -> Turning {
        let change = self.frame.turning().cross(&self.flank_normal);
        let place = -self.frame.sliding().dot(&change) / change.norm_squared();
        Turning {
            place,
            least: self.sliding(place),
            change,
        }
    }
}

/// Sliding along a path: the least one, and its change perpendicular to that.
#[derive(Clone, Copy)]
struct Turning {
    /// Where it is least, along the path.
    place: f64,
    least: Vector3<f64>,
    change: Vector3<f64>,
}

impl Turning {
    /// Sliding speed at a distance from the place of the least.
    fn speed(&self, t: f64) -> f64 {
        self.least.norm().hypot(self.change.norm() * t)
    }

    /// Integral of its inverse; zero where sliding vanishes at the place of the least, because its factor does, too.
    fn logarithm(&self, t: f64) -> f64 {
        let (least, change) = (self.least.norm(), self.change.norm());
        // Rounding of velocities that cancel.
        if least <= 1e-12 * change * (self.place.abs() + t.abs()) {
            return 0.0;
        }
        (t * change / least).asinh() / change
    }
}
