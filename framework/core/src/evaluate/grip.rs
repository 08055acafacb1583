//! Friction between bodies that rotate together: flanks and bearings on a carrier whose planets hardly roll, as in a differential
//! on a straight road.
//!
//! The sign of friction follows that of the relative speed, so friction jumps where the relative speed passes through zero: at
//! wheel speeds 1e-5 rpm apart the full friction would take torque from one wheel, at equal speeds none. No real drive rotates that
//! evenly. Single-pitch errors are some micrometres on some millimetres, and tyres differ by more, so a relative speed below about
//! a thousandth of the common speed changes its sign all the time, and only the mean over both signs remains. Here that mean
//! increases linearly with the relative speed, up to full friction at `locked_below` times the common speed. Without a common
//! speed, against the stationary housing, nothing changes however slowly a gear rotates.

use crate::real::Real;
use crate::transmission::Transmission;

impl Transmission {
    /// Share of full friction at a contact, from the relative speed of its bodies and their common speed.
    #[inline(always)]
    pub(super) fn grip<R: Real>(&self, relative: R, together: R) -> R {
        let full = together.abs() * self.locked_below;
        let slides = !relative.abs().is_below(full);
        R::select(slides, R::constant(1.0), relative.abs() / full)
    }

    /// The share for a mesh: its gears rotate together with the carrier.
    #[inline(always)]
    pub(super) fn mesh_grip<R: Real>(&self, index: usize, speeds: &[R]) -> R {
        let carrier = self.meshes[index].seat.carrier;
        let carrier = carrier.map_or(R::ZERO, |carrier| speeds[carrier]);
        self.grip(self.mesh_speed(index, speeds), carrier)
    }

    /// Copies of a component, times the factor on their loss and their share of friction.
    #[inline(always)]
    pub(super) fn copies<R: Real>(&self, index: usize, speeds: &[R]) -> R {
        let component = &self.components[index];
        let [a, b] = component
            .between
            .map(|member| member.map_or(R::ZERO, |m| speeds[m as usize]));
        self.grip(a - b, a.abs().min(b.abs())) * component.count
    }
}
