//! A row by its half: under a load in the plane of its first element, elements on both sides of that plane carry the same.

use super::equilibrium::{LocalForce, Row};

/// A row under loads in the plane of y, in which its first element is; see [`Axes::mirrored`](super::Axes::mirrored). Its first half stands for
/// both, which takes half the time.
#[derive(Debug, Clone, Copy)]
pub struct Mirrored<R>(pub R);

impl<R: Row> Mirrored<&R> {
    /// How many elements are equal to this one of the first half, itself included.
    pub fn count(&self, element: usize) -> f64 {
        let is_single = element == 0 || 2 * element == self.0.directions().len();
        if is_single { 1.0 } else { 2.0 }
    }
}

impl<R: Row> Row for Mirrored<&R> {
    fn directions(&self) -> &[[f64; 2]] {
        let all = self.0.directions();
        &all[..(all.len() / 2 + 1).min(all.len())]
    }

    fn radius(&self) -> f64 {
        self.0.radius()
    }

    fn force(&self, element: usize, displacement: [f64; 3]) -> LocalForce {
        let own = self.0.force(element, displacement);
        let count = self.count(element);
        LocalForce {
            force: own.force.map(|force| count * force),
            stiffness: own.stiffness.map(|row| row.map(|stiffness| count * stiffness)),
            size: count * own.size,
        }
    }

    fn guess(&self, axial: f64, radial: f64) -> [f64; 2] {
        self.0.guess(axial, radial)
    }
}
