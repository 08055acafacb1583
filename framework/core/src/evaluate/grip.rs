//! Friction between bodies that turn together: flanks and bearings on a carrier whose planets hardly roll, as in a differential on a
//! straight road.
//!
//! Friction follows the sense of the relative speed, so that it jumps from one side to the other where that passes through zero: with
//! wheels 1e-5 rpm apart all of the friction would take torque from one wheel, with equal speeds none. No drive turns that evenly. Single
//! pitches err by some micrometres on some millimetres, and tyres differ by more, so that a relative speed of less than about a thousandth
//! of the common one changes its sense all the time, and of the friction only its mean over both senses is left. Here that mean rises in
//! proportion to the relative speed, up to all of the friction at `locked_below` times the common speed. At rest against the housing there is
//! no common speed, and nothing changes however slowly a gear turns.

use crate::transmission::Transmission;

impl Transmission {
    /// Share of its friction that a contact bears, from the relative speed of its bodies and the speed at which they turn together.
    #[inline]
    fn grip(&self, relative: f64, together: f64) -> f64 {
        let full = self.locked_below * together.abs();
        if relative.abs() < full {
            relative.abs() / full
        } else {
            1.0
        }
    }

    /// The share for a mesh: its gears turn together with the carrier.
    #[inline]
    pub(super) fn mesh_grip(&self, index: usize, speeds: &[f64]) -> f64 {
        let carrier = self.meshes[index].seat.carrier.map_or(0.0, |carrier| speeds[carrier]);
        self.grip(self.mesh_speed(index, speeds), carrier)
    }

    /// Copies of a component, with the factor on their loss and the share of their friction.
    #[inline]
    pub(super) fn copies(&self, index: usize, speeds: &[f64]) -> f64 {
        let component = &self.components[index];
        let [a, b] = component
            .between
            .map(|member| member.map_or(0.0, |m| speeds[m as usize]));
        component.count * self.grip(a - b, a.abs().min(b.abs()))
    }
}
