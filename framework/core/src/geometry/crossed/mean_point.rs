//! The frame at the mean point, in which velocities and tooth forces of any pair are vectors.
//!
//! The mean point is the origin, the pitch plane is tangent to both cones there, its normal points into the first gear. A cylindrical pair, a
//! worm and a hypoid pair differ in the angles of their cones only.

use nalgebra::Vector3;

use super::pitch_cones::PitchCones;

/// Which flanks of the teeth touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flank {
    /// The concave flank of a right-hand pinion, convex of the wheel: usually the drive side.
    Drive,
    /// The other ones.
    Coast,
}

/// Frame of a pair at its mean point. Vectors of unit length unless a unit is stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanPoint {
    /// Axes, from the apex to the base.
    pub axis: [Vector3<f64>; 2],
    /// Feet of the mean point on the axes. \[m\]
    pub foot: [Vector3<f64>; 2],
    /// Directions of motion of both pitch surfaces, for a positive speed of the first gear.
    pub tangent: [Vector3<f64>; 2],
    /// Normal of the pitch plane, into the first gear.
    pub normal: Vector3<f64>,
    /// Trace of the teeth in the pitch plane.
    pub trace: Vector3<f64>,
    /// Speed of the second gear over that of the first, about their axes.
    pub speed_ratio: f64,
}

/// Force of the teeth at the mean point, for a given torque of the first gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothForce {
    /// Normal force. \[N\]
    pub normal: f64,
    /// Force on the first gear; that on the second one is opposite. \[N\]
    pub on_first: Vector3<f64>,
}

impl MeanPoint {
    /// The frame of a pair.
    pub fn new(cones: &PitchCones) -> Self {
        let normal = Vector3::z();
        let angle = cones.offset_angle();
        let generatrix = [Vector3::x(), Vector3::new(angle.cos(), angle.sin(), 0.0)];
        let [[s1, c1], [s2, c2]] = cones.pitch_angle.map(|angle| [angle.sin(), angle.cos()]);
        let [g1, g2] = generatrix;
        let tangent = generatrix.map(|g| normal.cross(&g));
        let (sine, cosine) = cones.spiral_angle[0].sin_cos();
        Self {
            axis: [g1 * c1 + normal * s1, g2 * c2 - normal * s2],
            foot: [
                (normal * c1 - g1 * s1) * cones.radius[0],
                -(normal * c2 + g2 * s2) * cones.radius[1],
            ],
            trace: g1 * cosine + tangent[0] * sine,
            tangent,
            normal,
            speed_ratio: -1.0 / cones.ratio(),
        }
    }

    /// Normal of a flank with a pressure angle in rad, into the first gear.
    pub fn flank_normal(&self, pressure_angle: f64, flank: Flank) -> Vector3<f64> {
        let side = match flank {
            Flank::Drive => -1.0,
            Flank::Coast => 1.0,
        };
        self.normal.cross(&self.trace) * (side * pressure_angle.cos()) + self.normal * pressure_angle.sin()
    }

    /// Velocities of both gears at a place for a speed of one of the first gear. \[m\]
    pub fn velocities(&self, place: Vector3<f64>) -> [Vector3<f64>; 2] {
        let speeds = [1.0, self.speed_ratio];
        [0, 1].map(|i| (self.axis[i] * speeds[i]).cross(&(place - self.foot[i])))
    }

    /// Difference of both angular velocities for a speed of one of the first gear.
    pub fn turning(&self) -> Vector3<f64> {
        self.axis[0] - self.axis[1] * self.speed_ratio
    }

    /// Sliding velocity at the mean point for a speed of one of the first gear: that of the first gear relative to the second. \[m\]
    pub fn sliding(&self) -> Vector3<f64> {
        let [first, second] = self.velocities(Vector3::zeros());
        first - second
    }

    /// Tooth force with friction at the mean point. `torque` is that with which the shaft of the first gear acts on it, `turns` the sign of its
    /// speed, `flank_normal` that of the flank that carries the torque, [`flank_normal`](Self::flank_normal). \[Nm\]
    ///
    /// `None` if friction is so large that no normal force balances the torque: the pair is self-locking.
    pub fn force(&self, torque: f64, turns: f64, flank_normal: Vector3<f64>, friction: f64) -> Option<ToothForce> {
        let sliding = self.sliding() * turns;
        let length = sliding.norm();
        let along = if length > 0.0 { sliding / length } else { sliding };
        let direction = flank_normal - along * friction;
        let arm = self.torque_of(0, direction);
        let normal = -torque / arm;
        (normal.is_finite() && normal >= 0.0).then(|| ToothForce {
            normal,
            on_first: direction * normal,
        })
    }

    /// Torque of a force at the mean point about the axis of a gear. \[Nm\]
    pub fn torque_of(&self, gear: usize, force: Vector3<f64>) -> f64 {
        self.axis[gear].dot(&(-self.foot[gear]).cross(&force))
    }

    /// Axial (from apex to base), radial (away from the axis) and tangential (in the direction of positive speed) parts of a force on a gear.
    /// \[N\]
    pub fn parts(&self, gear: usize, force: Vector3<f64>) -> [f64; 3] {
        let outwards = -self.foot[gear].normalize();
        let tangential = self.axis[gear].cross(&outwards);
        [
            self.axis[gear].dot(&force),
            outwards.dot(&force),
            tangential.dot(&force),
        ]
    }
}
