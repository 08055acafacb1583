//! Results of some solved points of a batch.

use super::BatchScratch;
use crate::flow::{Balance, Status};
use crate::lanes::{LANES, Lane, each, over, wide};
use crate::transmission::{PartKind, Transmission};

/// Some solved points of a batch.
pub struct Block<'a> {
    pub(super) transmission: &'a Transmission,
    /// Number of the reference port.
    pub(super) reference: usize,
    pub(super) s: &'a BatchScratch,
}

impl Block<'_> {
    /// By lane: true if the point must be evaluated by [`Batch::alone`](super::Batch::alone); the other results of the lane are then
    /// undefined. Lanes beyond the given torques are undefined, here and in the iterations.
    pub fn alone(&self) -> &[bool; LANES] {
        &self.s.alone_lanes
    }

    fn powers(&self, lane: usize) -> impl Iterator<Item = f64> + Clone + '_ {
        let ports = self.transmission.ports.iter();
        ports.map(move |p| self.s.work.ports[p.member][lane] * self.s.state.speeds[p.member])
    }

    /// Operating state of the transmission.
    pub fn status(&self, lane: usize) -> Status {
        Status::from_powers(self.powers(lane), self.reference)
    }

    /// Input and output power. \[W\]
    pub fn balance(&self, lane: usize) -> Balance {
        Balance::from_powers(self.powers(lane))
    }

    /// Sums of all losses. \[W\]
    pub fn losses(&self) -> &Lane {
        &self.s.sum
    }

    /// Losses of all parts, in their order. \[W\]
    pub fn watts(&self) -> &[Lane] {
        &self.s.watts
    }

    /// Power of one term of a part, all copies. \[W\]
    pub fn term_watts(&self, part: usize, term: usize) -> Lane {
        let (t, s) = (self.transmission, self.s);
        let info = &t.parts[part];
        match info.kind {
            PartKind::Component(i) if t.depends_on_torque(info) => {
                let (speed, count) = (s.state.relative[i], t.copies(i, &s.state.speeds));
                if speed == 0.0 {
                    return Lane::all(0.0);
                }
                wide(
                    #[inline(always)]
                    || over(&s.components[i].watts(term, speed), |watts| watts * count),
                )
            }
            PartKind::Mesh(i) => {
                let speed = t.mesh_speed(i, &s.state.speeds);
                if speed == 0.0 {
                    return Lane::all(0.0);
                }
                wide(
                    #[inline(always)]
                    || {
                        let watts = s.meshes[i].watts(term, speed);
                        each(|lane| watts[lane] * s.factors[i][lane])
                    },
                )
            }
            _ => Lane::all(t.part_loss(info, &s.state).term_watts(term)),
        }
    }

    /// True if a model is outside its stated range.
    pub fn outside(&self, lane: usize) -> bool {
        self.s.outside[lane].get()
    }

    /// Iterations over the loss models, by lane.
    pub fn passes(&self) -> &[usize; LANES] {
        &self.s.work.passes
    }

    /// Speed of a member by number. \[rad/s\]
    pub fn speed(&self, member: usize) -> f64 {
        self.s.state.speeds[member]
    }
}
