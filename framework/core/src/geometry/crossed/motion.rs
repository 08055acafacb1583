//! Motion of both flanks of a crossed pair over the position on its path of contact, in the tangent plane of the flanks.
//!
//! The velocities are those of [`ToothPath`](super::ToothPath), linear in the position; this is what a [`Pair`](crate::geometry::Pair) of crossed
//! gears keeps of them. Positions are those of the pair: along the line of action of the transverse plane, positive towards the tip of the first
//! gear.

use nalgebra::Vector2;

/// A velocity in the tangent plane, along the trace of the teeth and across it, over the speed of the first gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Velocity {
    /// At the pitch point. \[m\]
    pub at_pitch: Vector2<f64>,
    /// Change with the position.
    pub change: Vector2<f64>,
}

impl Velocity {
    fn at(&self, place: f64) -> Vector2<f64> {
        self.at_pitch + self.change * place
    }
}

/// Motion of both flanks along the path of contact. Places are distances from the pitch point. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossedMotion {
    /// Velocity of the first flank.
    pub first: Velocity,
    /// Velocity of the first flank relative to the second.
    pub sliding: Velocity,
    /// Direction across the line of contact.
    pub across: Vector2<f64>,
    /// Relative radius of curvature at the pitch point over that of the virtual cylinders.
    pub radius_factor: f64,
    /// Of a point contact the long semi-axis under a force of one newton; it grows with the cube root of the force. \[m\]
    pub spot: Option<f64>,
}

impl CrossedMotion {
    /// Sliding speed over the speed of the first gear. \[m\]
    pub fn sliding_speed(&self, place: f64) -> f64 {
        self.sliding.at(place).norm()
    }

    /// The part of the sliding speed that the offset of the axes causes: along the teeth, the same at all places. \[m\]
    pub fn lengthwise(&self) -> f64 {
        self.sliding.at_pitch.norm()
    }

    /// Velocities of both surfaces across the line of contact, over the speed of the first gear. \[m\]
    pub fn rolling(&self, place: f64) -> [f64; 2] {
        let first = self.first.at(place);
        [first, first - self.sliding.at(place)].map(|velocity| velocity.dot(&self.across))
    }

    /// Arm of the friction force about the axis of the first gear, over the coefficient of friction: how fast the first flank moves in the
    /// direction of sliding, over the speed of the first gear. It jumps where sliding vanishes. \[m\]
    pub fn friction_arm(&self, place: f64) -> f64 {
        let sliding = self.sliding.at(place);
        let speed = sliding.norm();
        if speed > 0.0 {
            sliding.dot(&self.first.at(place)) / speed
        } else {
            0.0
        }
    }
}
