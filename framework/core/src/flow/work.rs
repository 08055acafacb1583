//! Workspace, model interface and outcome of one solve.

use super::Flow;
use crate::real::{Mask as _, Points};

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

/// Tolerance of the agreement between loads and losses, of one point or of each of several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance<R = f64> {
    /// Remaining change of any power over the largest internal power.
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
    /// [`Tolerance::power`] of losses that are only estimated: those at the torques without losses, if they are below half of it. In
    /// trains without circulating power they are wrong by about the same share.
    pub(crate) const ESTIMATE: f64 = 0.1;

    /// The same for each of several points.
    pub(crate) fn everywhere<R: Points>(self) -> Tolerance<R> {
        Tolerance {
            power: R::constant(self.power),
            passes: self.passes,
        }
    }
}

/// The losses with which the iteration between torque and loss starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// None in the meshes, and no drags that depend on torque.
    Lossless,
    /// Those of the last solve of the point, which converged, for the same speeds and given torques at other temperatures: the work has
    /// them, or `resume` copies them into it.
    Last,
}

/// Losses and driving gears of a solved point, for [`Start::Last`].
#[derive(Debug, Clone, Default)]
pub struct Last {
    values: Vec<f64>,
    drives: Vec<Drive>,
}

/// Torques in one iteration, and the target of the losses that follow from them.
pub struct FlowState<'a, R: Points = f64> {
    /// Speeds of all columns. \[rad/s\]
    pub speeds: &'a [R],
    /// Torques on all columns from drags that are independent of torque. \[Nm\]
    pub steady: &'a [R],
    /// Multipliers of the rows as written. \[Nm per coefficient\]
    pub multipliers: &'a [R],
    /// Which gear drives, by mesh.
    pub drives: &'a [Drive],
    /// Torques on all columns from ports. \[Nm\]
    pub ports: &'a [R],
    /// The points that are solved; one is removed if a loss of it is undefined.
    pub live: &'a mut R::Mask,
    /// Loss of each mesh, all copies together, to be written. \[W\]
    pub mesh_loss: &'a mut [R],
    /// Torques on all columns from drags, to be written; they oppose motion. \[Nm\]
    pub drags: &'a mut [R],
}

/// How the loop ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Loads and losses agree, at all points that have not left.
    Converged {
        /// Iterations over the loss models.
        passes: usize,
    },
    /// No pattern of driving gears is consistent; [`Work::doubtful`] names the meshes.
    SelfLocking,
    /// The iteration limit was reached; [`Work::mismatch`] is the remaining difference.
    NoConvergence,
}

/// Losses in the form used by the equilibrium: shares of rolling power of the meshes, then losses of meshes as constant powers,
/// then torques of drags by column.
#[derive(Debug, Clone)]
pub(super) struct Losses<R> {
    pub values: Vec<R>,
    meshes: usize,
}

impl<R: Points> Losses<R> {
    fn new(meshes: usize, columns: usize) -> Self {
        Self {
            values: vec![R::ZERO; 2 * meshes + columns],
            meshes,
        }
    }
    pub fn share(&self, mesh: usize) -> R {
        self.values[mesh]
    }
    pub fn constant(&self, mesh: usize) -> R {
        self.values[self.meshes + mesh]
    }
    pub fn drags(&self) -> &[R] {
        &self.values[2 * self.meshes..]
    }
    pub(crate) fn drags_mut(&mut self) -> &mut [R] {
        &mut self.values[2 * self.meshes..]
    }
    /// Writes the loss of a mesh as a share of its rolling power, or as a constant if the share is not small.
    #[inline(always)]
    pub(crate) fn set_mesh(&mut self, mesh: usize, loss: R, rolling: R) {
        let proportional = loss.is_above(R::ZERO) & loss.is_below(rolling * 0.5);
        self.values[mesh] = R::select(proportional, loss / rolling, R::ZERO);
        self.values[self.meshes + mesh] = R::select(proportional, R::ZERO, loss.at_least(0.0));
    }
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
    /// Loss of each mesh as used in the accepted solve. \[W\]
    pub mesh_loss: Vec<R>,
    /// Power that the first gear puts into each mesh, in the carrier's frame. \[W\]
    pub rolling: Vec<R>,
    /// Which gear drives, by mesh, at all points that have not left.
    pub drives: Vec<Drive>,
    /// Largest internal power of the accepted solve. \[W\]
    pub largest: R,
    /// Largest difference of power between the losses used last and the results of the models. \[W\]
    pub mismatch: R,
    /// Points that are solved together, as set before a solve. A point leaves if it decides otherwise than the leading one, and is solved alone.
    pub live: R::Mask,
    /// Iterations over the loss models of each point.
    pub passes: R,
    /// Points whose loads and losses agree; their torques no longer change.
    pub(super) done: R::Mask,
    /// The point that decides which gears drive.
    pub(super) leading: usize,
    /// Multipliers and port torques at which the models are evaluated.
    pub(super) evaluated: Vec<R>,
    pub(super) evaluated_ports: Vec<R>,
    /// Results of the models for the meshes. \[W\]
    pub(super) model_losses: Vec<R>,
    /// Losses in the last solve, in the one before, and the results of the models for each.
    pub(super) used: Losses<R>,
    pub(super) used_before: Losses<R>,
    pub(super) answer: Losses<R>,
    pub(super) answer_before: Losses<R>,
    /// Power per unit of each entry of the losses.
    pub(super) weights: Vec<R>,
    /// Entries of the losses that changed in the last two iterations.
    pub(super) live_entries: Vec<usize>,
    /// Number of changes of the driving gear of each mesh.
    pub(super) turned: Vec<u8>,
    pub(super) ideal: Vec<Drive>,
    /// Given torques on all columns.
    pub(super) applied: Vec<R>,
    /// Speeds of second and first gear of each mesh in the carrier's frame; zero if they are rounding error.
    pub(crate) relative: Vec<[R; 2]>,
    pub(super) right: Vec<R>,
    pub(super) residual: Vec<R>,
    pub(super) unknown: Vec<R>,
    pub(super) step: Vec<R>,
    /// Meshes with friction in the present solve, and the factors of their small system or of the whole one.
    pub(super) active: Vec<usize>,
    pub(super) factors: Vec<R>,
    /// The row that was exchanged with each row of the small system.
    pub(super) order: Vec<usize>,
    pub(super) shares: Vec<R>,
}

impl<R: Points> Work<R> {
    /// Computes the losses of an ideal power flow; they change no torque.
    pub fn once(&mut self, mut losses: impl FnMut(&mut FlowState<'_, R>)) {
        self.model_losses.fill(R::ZERO);
        losses(&mut FlowState {
            speeds: &self.speeds,
            steady: &self.steady,
            multipliers: &self.multipliers,
            drives: &self.drives,
            ports: &self.ports,
            live: &mut self.live,
            mesh_loss: &mut self.model_losses,
            drags: &mut self.drags,
        });
        self.mesh_loss.copy_from_slice(&self.model_losses);
        self.drags.fill(R::ZERO);
        self.passes = R::constant(1.0);
    }

    /// Copies the losses and driving gears of a solved point.
    pub(crate) fn copy_last(&self, point: usize, last: &mut Last) {
        last.values.clear();
        let values = self.used.values.iter();
        last.values.extend(values.map(|value| value.at_point(point)));
        last.drives.clone_from(&self.drives);
    }

    /// Takes over the losses of earlier solves, one for each point, and the driving gears of the first. Returns where they are the same.
    pub(crate) fn resume<'l>(&mut self, last: impl Fn(usize) -> &'l Last) -> R::Mask {
        for (entry, value) in self.used.values.iter_mut().enumerate() {
            *value = R::each(|point| last(point).values[entry]);
        }
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

    /// Difference of a result to the value used. \[W\]
    #[inline(always)]
    pub(super) fn difference(&self, entry: usize) -> R {
        (self.answer.values[entry] - self.used.values[entry]) * self.weights[entry]
    }

    /// Change of a value in the last step, and of the result.
    #[inline(always)]
    pub(super) fn changes(&self, entry: usize) -> (R, R) {
        let used = self.used.values[entry] - self.used_before.values[entry];
        let answer = self.answer.values[entry] - self.answer_before.values[entry];
        (used.abs(), answer.abs())
    }

    /// Lists the entries of the losses in which anything changes; the others change no sum.
    #[inline(always)]
    pub(super) fn list_live_entries(&mut self) {
        self.live_entries.clear();
        for entry in 0..self.weights.len() {
            let (used, answer) = (self.used.values[entry], self.answer.values[entry]);
            let same = used.is_equal(answer)
                & used.is_equal(self.used_before.values[entry])
                & answer.is_equal(self.answer_before.values[entry]);
            if !same.all() {
                self.live_entries.push(entry);
            }
        }
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
        let (n, s, k) = (self.columns, self.size.max(self.columns), self.meshes.len());
        let zeros = |count: usize| vec![R::ZERO; count];
        let losses = Losses::new(k, n);
        Work {
            speeds: zeros(n),
            given: zeros(self.given.len()),
            steady: zeros(n),
            multipliers: zeros(self.rows),
            ports: zeros(n),
            drags: zeros(n),
            mesh_loss: zeros(k),
            rolling: zeros(k),
            drives: vec![Drive::Neither; k],
            largest: R::ZERO,
            mismatch: R::ZERO,
            live: R::mask(|_| true),
            passes: R::ZERO,
            done: R::mask(|_| false),
            leading: 0,
            evaluated: zeros(self.rows),
            evaluated_ports: zeros(n),
            model_losses: zeros(k),
            used: losses.clone(),
            used_before: losses.clone(),
            answer: losses.clone(),
            weights: zeros(losses.values.len()),
            live_entries: Vec::with_capacity(losses.values.len()),
            answer_before: losses,
            turned: vec![0; k],
            ideal: vec![Drive::Neither; k],
            applied: zeros(s),
            relative: vec![[R::ZERO; 2]; k],
            right: zeros(s),
            residual: zeros(s),
            unknown: zeros(s),
            step: zeros(s),
            active: Vec::with_capacity(k),
            factors: zeros(self.solver.factor_count(k)),
            order: vec![0; k],
            shares: zeros(k),
        }
    }
}
