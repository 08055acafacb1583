//! Workspace, model interface and outcome of one solve.

use super::Flow;
use super::linear::padded;

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

/// Tolerance of the agreement between loads and losses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Remaining change of any power over the largest internal power.
    pub power: f64,
    /// Maximum number of iterations.
    pub passes: usize,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self {
            power: 1e-9,
            passes: 60,
        }
    }
}

/// Torques in one iteration, and the target of the losses that follow from them.
#[derive(Debug)]
pub struct FlowState<'a> {
    /// Speeds of all columns. \[rad/s\]
    pub speeds: &'a [f64],
    /// Multipliers of the rows as written. \[Nm per coefficient\]
    pub multipliers: &'a [f64],
    /// Which gear drives, by mesh.
    pub drives: &'a [Drive],
    /// Torques on all columns from ports. \[Nm\]
    pub ports: &'a [f64],
    /// Loss of each mesh, all copies together, to be written. \[W\]
    pub mesh_loss: &'a mut [f64],
    /// Torques on all columns from drags, to be written; they oppose motion. \[Nm\]
    pub drags: &'a mut [f64],
}

/// How the loop ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Loads and losses agree.
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
pub(super) struct Losses {
    pub values: Vec<f64>,
    meshes: usize,
}

impl Losses {
    fn new(meshes: usize, columns: usize) -> Self {
        Self {
            values: vec![0.0; 2 * meshes + columns],
            meshes,
        }
    }
    pub fn share(&self, mesh: usize) -> f64 {
        self.values[mesh]
    }
    pub fn constant(&self, mesh: usize) -> f64 {
        self.values[self.meshes + mesh]
    }
    pub fn drags(&self) -> &[f64] {
        &self.values[2 * self.meshes..]
    }
    pub fn drags_mut(&mut self) -> &mut [f64] {
        &mut self.values[2 * self.meshes..]
    }
    /// Writes the loss of a mesh as a share of its rolling power, or as a constant if the share is not small.
    pub fn set_mesh(&mut self, mesh: usize, loss: f64, rolling: f64) {
        let proportional = loss > 0.0 && loss < 0.5 * rolling;
        self.values[mesh] = if proportional { loss / rolling } else { 0.0 };
        self.values[self.meshes + mesh] = if proportional { 0.0 } else { loss.max(0.0) };
    }
}

/// A mesh with friction in the present solve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Active {
    pub mesh: usize,
    /// Number of its row.
    pub row: usize,
    /// Which side of [`super::system::Friction`] loses torque.
    pub side: usize,
    /// Share of its rolling power that is lost.
    pub share: f64,
}

/// One entry of the losses over two iterations.
pub(super) struct Entry {
    pub used: f64,
    pub used_before: f64,
    pub answer: f64,
    pub answer_before: f64,
    /// Power per unit of the entry.
    pub weight: f64,
}

impl Entry {
    /// Difference of the result to the value used. \[W\]
    pub fn mismatch(&self) -> f64 {
        (self.answer - self.used) * self.weight
    }
    /// Change of the value in the last step.
    pub fn moved(&self) -> f64 {
        self.used - self.used_before
    }
    /// Change of the result in the last step.
    pub fn followed(&self) -> f64 {
        self.answer - self.answer_before
    }
}

/// Workspace for one solve; made once, used for every point.
#[derive(Debug, Clone)]
pub struct Work {
    /// Multipliers of the rows as written.
    pub multipliers: Vec<f64>,
    /// Torques of ports on all columns.
    pub ports: Vec<f64>,
    /// Torques of drags on all columns.
    pub drags: Vec<f64>,
    /// Loss of each mesh as used in the accepted solve. \[W\]
    pub mesh_loss: Vec<f64>,
    /// Power that the first gear puts into each mesh, in the carrier's frame. \[W\]
    pub rolling: Vec<f64>,
    /// Which gear drives, by mesh.
    pub drives: Vec<Drive>,
    /// Largest internal power of the accepted solve. \[W\]
    pub largest: f64,
    /// Largest difference of power between the losses used last and the results of the models. \[W\]
    pub mismatch: f64,
    /// Results of the models for the meshes. \[W\]
    pub(super) model_losses: Vec<f64>,
    /// Losses in the last solve, in the one before, and the results of the models for each.
    pub(super) used: Losses,
    pub(super) used_before: Losses,
    pub(super) answer: Losses,
    pub(super) answer_before: Losses,
    /// Power per unit of each entry of the losses.
    pub(super) weights: Vec<f64>,
    /// Number of changes of the driving gear of each mesh.
    pub(super) turned: Vec<u8>,
    pub(super) ideal: Vec<Drive>,
    /// Given torques on all columns, padded.
    pub(super) applied: Vec<f64>,
    /// Speeds of second and first gear of each mesh in the carrier's frame; zero if they are rounding error.
    pub(crate) relative: Vec<[f64; 2]>,
    pub(super) right: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) unknown: Vec<f64>,
    pub(super) step: Vec<f64>,
    /// The small system of the meshes with friction.
    pub(super) active: Vec<Active>,
    pub(super) small: Vec<f64>,
    pub(super) order: Vec<usize>,
    pub(super) shares: Vec<f64>,
}

impl Work {
    /// Computes the losses of an ideal power flow; they change no torque.
    pub fn once(&mut self, speeds: &[f64], mut losses: impl FnMut(&mut FlowState<'_>)) {
        self.model_losses.fill(0.0);
        losses(&mut FlowState {
            speeds,
            multipliers: &self.multipliers,
            drives: &self.drives,
            ports: &self.ports,
            mesh_loss: &mut self.model_losses,
            drags: &mut self.drags,
        });
        self.mesh_loss.copy_from_slice(&self.model_losses);
        self.drags.fill(0.0);
    }

    /// The entries of the losses.
    pub(super) fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        let uses = self.used.values.iter().zip(&self.used_before.values);
        let answers = self.answer.values.iter().zip(&self.answer_before.values);
        uses.zip(answers)
            .zip(&self.weights)
            .map(|(((used, used_before), (answer, answer_before)), weight)| Entry {
                used: *used,
                used_before: *used_before,
                answer: *answer,
                answer_before: *answer_before,
                weight: *weight,
            })
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

    /// Workspace for solving this flow.
    pub fn work(&self) -> Work {
        let (n, s, k) = (self.columns, padded(self.size), self.meshes.len());
        let losses = Losses::new(k, n);
        Work {
            multipliers: vec![0.0; self.rows],
            ports: vec![0.0; n],
            drags: vec![0.0; n],
            mesh_loss: vec![0.0; k],
            rolling: vec![0.0; k],
            drives: vec![Drive::Neither; k],
            largest: 0.0,
            mismatch: 0.0,
            model_losses: vec![0.0; k],
            used: losses.clone(),
            used_before: losses.clone(),
            answer: losses.clone(),
            weights: vec![0.0; losses.values.len()],
            answer_before: losses,
            turned: vec![0; k],
            ideal: vec![Drive::Neither; k],
            applied: vec![0.0; s],
            relative: vec![[0.0; 2]; k],
            right: vec![0.0; s],
            residual: vec![0.0; s],
            unknown: vec![0.0; s],
            step: vec![0.0; s],
            active: Vec::with_capacity(k),
            small: vec![0.0; k * k],
            order: vec![0; k],
            shares: vec![0.0; k],
        }
    }
}
