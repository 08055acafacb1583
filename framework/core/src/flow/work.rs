//! Workspace, model interface and outcome of one solve.

use std::sync::Arc;

use super::order::{Laws, Order};
use super::system::Driven;
use super::{Flow, LoadedDrag};
use crate::real::Points;

/// Which gear of a mesh drives in the carrier's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Drive {
    /// The first gear.
    #[default]
    First,
    /// The second gear.
    Second,
    /// Neither, because there is no torque.
    Neither,
}

impl Drive {
    /// Relative to the largest internal power, a rolling power below this has no direction.
    const NO_POWER: f64 = 1e-13;

    /// The driving gear of a mesh, into which the first gear puts a power.
    pub(super) fn of(rolling: f64, largest: f64) -> Self {
        if rolling.abs() <= Self::NO_POWER * largest {
            Self::Neither
        } else if rolling > 0.0 {
            Self::First
        } else {
            Self::Second
        }
    }

    /// The gear that loses torque.
    pub(crate) fn driven(self) -> Driven {
        usize::from(self == Self::Second)
    }
}

/// Tolerance of the agreement between loads and losses, of one point or of each of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance<R = f64> {
    /// Estimated error of any accepted loss over the greatest power of the meshes and losses with which it is a loop.
    pub power: R,
    /// Maximum number of iterations.
    pub passes: usize,
}

impl<R: Points> Default for Tolerance<R> {
    fn default() -> Self {
        Self {
            power: R::constant(1e-9),
            passes: 60,
        }
    }
}

impl Tolerance {
    /// [`Tolerance::power`] of losses that are only estimated. In trains without circulating power they are wrong by about the same
    /// share.
    pub(crate) const ESTIMATE: f64 = 0.1;

    /// The same for each of several points.
    pub(crate) fn everywhere<R: Points>(self) -> Tolerance<R> {
        Tolerance {
            power: R::constant(self.power),
            passes: self.passes,
        }
    }
}

/// Torques with which loops start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// Those without the losses of the loop.
    Lossless,
    /// Those of the last solve of the point, which converged, for the same speeds and given torques at other temperatures: the work has
    /// them, or `resume` copies them into it.
    Last,
}

/// Torques and driving gears of a solved point, for [`Start::Last`].
#[derive(Debug, Clone, Default)]
pub struct Last {
    unknown: Vec<f64>,
    largest: f64,
    drives: Vec<Drive>,
}

/// Torques at which some laws are evaluated, and their losses.
pub struct FlowState<'a, R: Points = f64> {
    /// Speeds of all columns. \[rad/s\]
    pub speeds: &'a [R],
    /// Multipliers of the rows as written. \[Nm per coefficient\]
    pub multipliers: &'a [R],
    /// Which gear drives, by mesh.
    pub drives: &'a [Drive],
    /// Torques on all columns from ports. \[Nm\]
    pub ports: &'a [R],
    /// The drags that depend on torques.
    pub drags: &'a [LoadedDrag],
    /// The laws to be evaluated; the multipliers and torques that they do not depend on may be those of earlier solves.
    pub laws: &'a Laws,
    /// The points that are solved; one is removed if a loss of it is undefined.
    pub live: &'a mut R::Mask,
    /// Loss of each mesh, all copies together, to be written. \[W\]
    pub mesh_loss: &'a mut [R],
    /// Moment of each drag against the motion of its first column, signed, which acts the other way on the second one; to be written.
    /// \[Nm\]
    pub moments: &'a mut [R],
}

/// How the solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Loads and losses agree, at all points that have not left.
    Converged {
        /// Evaluations of the laws of the loop that needs the most; one without loops.
        passes: usize,
    },
    /// No pattern of driving gears is consistent; [`Work::doubtful`] names the meshes.
    SelfLocking,
    /// The iteration limit was reached.
    NoConvergence,
}

/// Workspace for one solve; made once, used for every point.
#[derive(Debug, Clone)]
pub struct Work<R: Points = f64> {
    /// Speeds of all columns. \[rad/s\]
    pub speeds: Vec<R>,
    /// Torques of the given ports, in their order. \[Nm\]
    pub given: Vec<R>,
    /// Torques on all columns from drags that are independent of torque. \[Nm\]
    pub steady: Vec<R>,
    /// Multipliers of the rows as written.
    pub multipliers: Vec<R>,
    /// Torques of ports on all columns.
    pub ports: Vec<R>,
    /// Torques of drags on all columns.
    pub drags: Vec<R>,
    /// Loss of each mesh. \[W\]
    pub mesh_loss: Vec<R>,
    /// Power that the first gear puts into each mesh, in the carrier's frame. \[W\]
    pub rolling: Vec<R>,
    /// Which gear drives, by mesh, at all points that have not left.
    pub drives: Vec<Drive>,
    /// Largest internal power. \[W\]
    pub largest: R,
    /// Points that are solved together, as set before a solve. A point leaves if it decides otherwise than the leading one, and is
    /// solved alone.
    pub live: R::Mask,
    /// Evaluations of the laws of the loop that needs the most, of each point.
    pub passes: R,
    /// Points of a loop whose torques and losses agree; their torques no longer change.
    pub(super) done: R::Mask,
    /// The point that decides which gears drive.
    pub(super) leading: usize,
    /// The order of the driving gears.
    pub(super) order: Arc<Order>,
    /// Moments of the drags that depend on torques.
    pub(super) moments: Vec<R>,
    /// Speeds of second and first gear of each mesh in the carrier's frame; zero if they are rounding error.
    pub(crate) relative: Vec<[R; 2]>,
    /// Multiplier of each mesh, over its scale, per power that the first gear puts into it; zero if it does not roll.
    pub(super) per_watt: Vec<R>,
    /// Given torques on all columns with the drags that are independent of torque, then zeros: for each equation.
    pub(super) applied: Vec<R>,
    pub(super) unknown: Vec<R>,
    /// Unknowns of loops without the losses of the loop; at the evaluation of its laws before the last one; and of the next step.
    pub(super) bare: Vec<R>,
    pub(super) before: Vec<R>,
    pub(super) next: Vec<R>,
    /// Of each law: lost multiplier or moment, at the last evaluation and at the one before, its derivative over the leading unknown, and
    /// its power per unit.
    pub(super) answers: Vec<R>,
    pub(super) answers_before: Vec<R>,
    pub(super) slopes: Vec<R>,
    /// The same as far as a step follows them.
    pub(super) followed: Vec<R>,
    pub(super) weights: Vec<R>,
    /// The accepted loss of each law over that of its last evaluation: other than one in loops.
    pub(crate) accepted: Vec<R>,
    /// Right-hand side, matrix and unknowns of the leads of a loop.
    pub(super) right: Vec<R>,
    pub(super) factors: Vec<R>,
    pub(super) exchanged: Vec<usize>,
    /// Number of changes of the driving gear of each mesh.
    pub(super) turned: Vec<u8>,
    /// Driving gears without losses.
    pub(super) ideal: Vec<Drive>,
}

impl<R: Points> Work<R> {
    /// Computes the losses of an ideal power flow; they change no torque.
    pub fn once(&mut self, flow: &Flow, mut losses: impl FnMut(&mut FlowState<'_, R>)) {
        self.mesh_loss.fill(R::ZERO);
        self.evaluate(flow, &flow.laws, &mut losses);
        self.drags.fill(R::ZERO);
        self.passes = R::constant(1.0);
    }

    /// Evaluates laws at the present torques.
    pub(super) fn evaluate(&mut self, flow: &Flow, laws: &Laws, losses: &mut impl FnMut(&mut FlowState<'_, R>)) {
        losses(&mut FlowState {
            speeds: &self.speeds,
            multipliers: &self.multipliers,
            drives: &self.drives,
            ports: &self.ports,
            drags: &flow.drags,
            laws,
            live: &mut self.live,
            mesh_loss: &mut self.mesh_loss,
            moments: &mut self.moments,
        });
    }

    /// Copies the torques and driving gears of a solved point.
    pub(crate) fn copy_last(&self, point: usize, last: &mut Last) {
        last.unknown.clear();
        last.unknown.extend(self.unknown.iter().map(|x| x.at_point(point)));
        last.largest = self.largest.at_point(point);
        last.drives.clone_from(&self.drives);
    }

    /// Takes over the torques of earlier solves, one for each point, and the driving gears of the first. Returns where they are the
    /// same.
    pub(crate) fn resume<'l>(&mut self, last: impl Fn(usize) -> &'l Last) -> R::Mask {
        for (number, unknown) in self.unknown.iter_mut().enumerate() {
            *unknown = R::each(|point| last(point).unknown[number]);
        }
        self.largest = R::each(|point| last(point).largest);
        self.drives.clone_from(&last(0).drives);
        R::mask(|point| last(point).drives == self.drives)
    }

    /// Removes the points where a condition does not hold. A point that is solved alone stays.
    #[inline(always)]
    pub(super) fn keep(&mut self, mask: R::Mask) {
        if R::COUNT > 1 {
            self.live = self.live & mask;
        }
    }

    /// Laws of each loop of the last solve.
    pub(crate) fn loops(&self) -> impl Iterator<Item = &Laws> {
        let loops = self.order.blocks.iter().filter(|block| block.is_loop());
        loops.map(|block| &block.laws)
    }

    /// Meshes whose driving gear changed in the last solve; with [`Outcome::SelfLocking`] the locking ones.
    pub fn doubtful(&self) -> impl Iterator<Item = usize> + '_ {
        self.turned
            .iter()
            .enumerate()
            .filter(|(_, turned)| **turned > 0)
            .map(|(mesh, _)| mesh)
    }
}

impl Flow {
    /// Number of columns: members and differences.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Workspace for solving this flow at one point or at several.
    pub fn work<R: Points>(&self) -> Work<R> {
        let (columns, size, meshes) = (self.columns, self.equations.len(), self.meshes.len());
        let laws = meshes + self.drags.len();
        let zeros = |count: usize| vec![R::ZERO; count];
        Work {
            speeds: zeros(columns),
            given: zeros(self.given.len()),
            steady: zeros(columns),
            multipliers: zeros(self.rows),
            ports: zeros(columns),
            drags: zeros(columns),
            mesh_loss: zeros(meshes),
            rolling: zeros(meshes),
            drives: vec![Drive::Neither; meshes],
            largest: R::ZERO,
            live: R::mask(|_| true),
            passes: R::ZERO,
            done: R::mask(|_| false),
            leading: 0,
            order: Arc::clone(&self.lossless),
            moments: zeros(self.drags.len()),
            relative: vec![[R::ZERO; 2]; meshes],
            per_watt: zeros(meshes),
            applied: zeros(size),
            unknown: zeros(size),
            bare: zeros(size),
            before: zeros(size),
            next: zeros(size),
            answers: zeros(laws),
            answers_before: zeros(laws),
            slopes: zeros(laws),
            followed: zeros(laws),
            weights: zeros(laws),
            accepted: vec![R::constant(1.0); laws],
            right: zeros(size),
            factors: Vec::new(),
            exchanged: Vec::new(),
            turned: vec![0; meshes],
            ideal: vec![Drive::Neither; meshes],
        }
    }
}
