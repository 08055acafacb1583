//! Friction forces of a mesh at earlier torques of a point, from which those at others follow.
//!
//! The loads of bearings contain the friction of meshes on axes that cross, so that each iteration of their losses needs it. Friction is a
//! smooth function of the tooth force: at forces close to two others its secant gives it, and no law is evaluated.

use crate::flow::Drive;
use crate::real::Points;

/// Product of the distances to both other forces, over the square of the force, up to which their secant counts. The friction force is about a
/// power of the force with an exponent of 0.7 to 1.1, so that the secant differs from it by at most a tenth of this product.
const CLOSE: f64 = 1e-7;

/// Friction at two tooth forces, the newest first. Without friction at others, the second one is that of no force: none.
#[derive(Debug, Clone, Copy)]
pub(super) struct FoundFriction<R> {
    /// Tooth forces. \[N\]
    pub force: [R; 2],
    /// Friction forces. \[N\]
    friction: [R; 2],
    /// The driving gear.
    drive: Drive,
    /// Evaluation of laws at which the friction was found last.
    pub round: usize,
}

impl<R: Points> FoundFriction<R> {
    /// Nothing is known but that no force has no friction.
    pub const NONE: Self = Self {
        force: [R::ZERO; 2],
        friction: [R::ZERO; 2],
        drive: Drive::Neither,
        round: 0,
    };

    /// Forgets what was found with another driving gear.
    #[inline(always)]
    pub fn turn(&mut self, drive: Drive) {
        if self.drive.driven() != drive.driven() {
            *self = Self {
                round: self.round,
                ..Self::NONE
            };
        }
        self.drive = drive;
    }

    /// True where the friction at a force follows.
    #[inline(always)]
    pub fn gives(&self, force: R) -> R::Mask {
        let [near, far] = self.force;
        let product = ((force - near) * (force - far)).abs();
        let most = near * near * CLOSE;
        product.is_below(most) | product.is_equal(most)
    }

    /// Adds the friction at a force where a condition holds.
    #[inline(always)]
    pub fn add(&mut self, which: R::Mask, force: R, friction: R) {
        let ([force_before, _], [friction_before, _]) = (self.force, self.friction);
        self.force = [
            R::select(which, force, force_before),
            R::select(which, force_before, self.force[1]),
        ];
        self.friction = [
            R::select(which, friction, friction_before),
            R::select(which, friction_before, self.friction[1]),
        ];
    }

    /// Friction at a force that follows.
    #[inline(always)]
    pub fn at(&self, force: R) -> R {
        let ([near, far], [friction, other]) = (self.force, self.friction);
        let along = (friction - other) * ((force - near) / (near - far));
        R::select(force.is_equal(near), friction, friction + along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_secant_gives_friction_close_to_what_is_known() {
        let law = |force: f64| 0.05 * force.powf(0.8);
        let mut found = FoundFriction::<f64>::NONE;
        assert!(found.gives(0.0) && found.at(0.0) == 0.0);
        assert!(!found.gives(1000.0));
        found.add(true, 1000.0, law(1000.0));
        assert!(found.gives(1000.0) && found.at(1000.0) == law(1000.0));
        assert!(!found.gives(1000.2) && found.gives(1000.00009));
        found.add(true, 990.0, law(990.0));
        for force in [989.995, 990.0, 990.005] {
            assert!(found.gives(force));
            let error = (found.at(force) / law(force) - 1.0).abs();
            assert!(error < 1e-8, "{force} {error}");
        }
        assert!(!found.gives(-990.0) && !found.gives(991.0));
        found.turn(Drive::Second);
        assert!(!found.gives(990.0));
    }
}
