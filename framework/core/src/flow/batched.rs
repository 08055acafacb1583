//! Power flow with losses for the points of a block, which share speeds and driving gears.
//!
//! This is the batched loop of [`super::solve`] for points that converge easily. The operations are the same, unless extrapolated
//! initial torques allow the first iteration to be the last. A lane in which a driving gear changes, or that does not converge
//! within a few iterations, is excluded and solved by that loop.

use super::history::{TorqueHistory, UNKNOWN};
use super::linear::{Panels, larger};
use super::solve::{NO_POWER, PATIENCE, REACH, SAFETY, drive};
use super::system::{Flow, Friction, Side};
use super::work::{Drive, Tolerance};
use crate::lanes::{LANES, Lane, count, each, gather, greatest, over, weighted, wide};

/// Iterations after which a lane is excluded; up to here, the loop for single points does not change its relaxation.
const FEW: usize = PATIENCE - 2;

/// A mismatch below this share of the largest one may be rounding and gives no convergence rate.
const NEGLIGIBLE: f64 = 1e-3;

const ZERO: Lane = Lane::all(0.0);

/// Workspace and result of one block.
#[derive(Debug, Clone)]
pub struct WorkLanes {
    /// Multipliers of the rows as written, at the torques of the last model evaluation.
    multipliers: Vec<Lane>,
    /// Torques of ports on all columns.
    pub ports: Vec<Lane>,
    /// Loss of each mesh as used in the accepted solve. \[W\]
    pub mesh_loss: Vec<Lane>,
    /// Which gear drives, by mesh, in all lanes that are not excluded.
    pub drives: Vec<Drive>,
    /// Excluded lanes.
    pub alone: [bool; LANES],
    /// Converged lanes; their torques no longer change.
    pub done: [bool; LANES],
    /// Iterations over the loss models.
    pub passes: [usize; LANES],
    rolling: Vec<Lane>,
    /// Share of an error that remains after one iteration.
    rate: Lane,
    largest: Lane,
    /// Results of the models for the meshes. \[W\]
    model_losses: Vec<Lane>,
    used: Vec<Lane>,
    used_before: Vec<Lane>,
    answer: Vec<Lane>,
    answer_before: Vec<Lane>,
    weights: Vec<Lane>,
    /// Entries of the losses that changed in the last two iterations.
    live: Vec<usize>,
    applied: Vec<Lane>,
    relative: Vec<[f64; 2]>,
    right: Vec<Lane>,
    residual: Vec<Lane>,
    unknown: Vec<Lane>,
    step: Vec<Lane>,
    active: Vec<usize>,
    small: Vec<Lane>,
    /// Entries of the small system that are nonzero in some lane.
    filled: Vec<bool>,
    shares: Vec<Lane>,
    /// Power per step of the unknown of each mesh, ignoring standstill.
    powers: Vec<f64>,
}

/// Right-hand side of a block.
#[derive(Debug, Clone, Copy)]
pub struct TaskLanes<'a> {
    /// Speeds of all columns. \[rad/s\]
    pub speeds: &'a [f64],
    /// Torques of the given ports, in their order. \[Nm\]
    pub torques: &'a [Lane],
    /// Torques on all columns from drags that are independent of torque. \[Nm\]
    pub steady: &'a [f64],
    /// Tolerance of the agreement between loads and losses.
    pub tolerance: Tolerance,
}

/// Torques in one iteration, and the target of the losses that follow from them.
pub struct FlowLanes<'a> {
    /// Multipliers of the rows as written. \[Nm per coefficient\]
    pub multipliers: &'a [Lane],
    /// Which gear drives, by mesh.
    pub drives: &'a [Drive],
    /// Torques on all columns from ports. \[Nm\]
    pub ports: &'a [Lane],
    /// Lanes whose torques are no longer used.
    pub done: &'a [bool; LANES],
    /// Loss of each mesh, all copies together, to be written. \[W\]
    pub mesh_loss: &'a mut [Lane],
    /// Torques on all columns from drags, all to be written; they oppose motion. \[Nm\]
    pub drags: &'a mut [Lane],
}

/// A sparse matrix: for each row its columns and entries.
#[derive(Debug, Clone, Default)]
pub(super) struct SparseMatrix {
    /// For each row the end of its entries.
    ends: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl SparseMatrix {
    fn new(panels: &Panels, size: usize) -> Self {
        let mut matrix = Self::default();
        for (row, column, x) in panels.entries() {
            matrix.ends.resize(row, matrix.entries.len());
            matrix.entries.push((column, x));
        }
        matrix.ends.resize(size, matrix.entries.len());
        matrix
    }

    #[inline(always)]
    fn product(&self, x: &[Lane], y: &mut [Lane]) {
        let mut start = 0;
        for (y, end) in y.iter_mut().zip(&self.ends) {
            let entries = self.entries[start..*end].iter();
            *y = weighted(entries.map(|(column, entry)| (*entry, &x[*column])));
            start = *end;
        }
    }
}

/// A sparse vector: indices and entries.
#[derive(Debug, Clone, Default)]
pub(super) struct SparseVector(Vec<(usize, f64)>);

impl SparseVector {
    fn new(vector: &[f64]) -> Self {
        let entries = vector.iter().copied().enumerate().filter(|(_, x)| *x != 0.0);
        Self(entries.collect())
    }

    /// Adds the vector times a factor.
    #[inline(always)]
    fn add(&self, factor: &Lane, sum: &mut [Lane]) {
        for (row, entry) in &self.0 {
            let sum = &mut sum[*row];
            *sum = each(|i| sum[i] + factor[i] * entry);
        }
    }
}

/// True if two lanes have the same numbers.
#[inline(always)]
fn same_numbers(a: &Lane, b: &Lane) -> bool {
    count(|i| a[i] == b[i]) == LANES as u64
}

/// Remaining share of an error after one more iteration and all following ones, from the share left by each.
#[inline(always)]
fn to_come(error: f64, rate: f64) -> f64 {
    let left = error * rate / larger(1e-3, 1.0 - rate);
    // Also if the rate is unknown.
    if error == 0.0 { 0.0 } else { left }
}

/// True if every lane certainly has this driving gear.
#[inline(always)]
fn all_drive(drives: Drive, rolling: &Lane, largest: &Lane) -> bool {
    let sure = match drives {
        Drive::First => count(|i| rolling[i] > NO_POWER * largest[i]),
        Drive::Second => count(|i| -rolling[i] > NO_POWER * largest[i]),
        Drive::Neither => count(|i| rolling[i].abs() <= NO_POWER * largest[i]),
    };
    sure == LANES as u64
}

/// The parts of a [`Flow`] as sparse matrices.
#[derive(Debug, Clone, Default)]
pub(super) struct SparseFlow {
    base: SparseMatrix,
    inverse: SparseMatrix,
    /// Change and response of each mesh and side.
    sides: Vec<[(SparseVector, SparseVector); 2]>,
}

impl SparseFlow {
    pub fn new(base: &Panels, inverse: &Panels, size: usize, friction: &[Friction]) -> Self {
        let side = |side: &Side| (SparseVector::new(&side.change), SparseVector::new(&side.response));
        Self {
            base: SparseMatrix::new(base, size),
            inverse: SparseMatrix::new(inverse, size),
            sides: friction
                .iter()
                .map(|f| [side(&f.sides[0]), side(&f.sides[1])])
                .collect(),
        }
    }
}

impl Flow {
    /// Workspace for the blocks of this flow.
    pub fn work_batched(&self) -> WorkLanes {
        let (n, k) = (self.columns, self.meshes.len());
        let lanes = |count: usize| vec![ZERO; count];
        let size = self.size.max(n);
        WorkLanes {
            multipliers: lanes(self.rows),
            ports: lanes(n),
            mesh_loss: lanes(k),
            drives: vec![Drive::Neither; k],
            alone: [false; LANES],
            done: [false; LANES],
            passes: [0; LANES],
            rolling: lanes(k),
            rate: ZERO,
            largest: ZERO,
            model_losses: lanes(k),
            used: lanes(2 * k + n),
            used_before: lanes(2 * k + n),
            answer: lanes(2 * k + n),
            answer_before: lanes(2 * k + n),
            weights: lanes(2 * k + n),
            live: Vec::with_capacity(2 * k + n),
            applied: lanes(size),
            relative: vec![[0.0; 2]; k],
            right: lanes(size),
            residual: lanes(size),
            unknown: lanes(size),
            step: lanes(size),
            active: Vec::with_capacity(k),
            small: lanes(k * k),
            filled: vec![false; k * k],
            shares: lanes(k),
            powers: vec![0.0; k],
        }
    }

    /// As [`Flow::real`] for the points of a block. With an extrapolation history the initial torques are extrapolated from it, and
    /// the block becomes its next step.
    pub fn real_batched(
        &self,
        task: &TaskLanes<'_>,
        history: Option<(&mut TorqueHistory, f64)>,
        work: &mut WorkLanes,
        mut losses: impl FnMut(&mut FlowLanes<'_>),
    ) {
        let Some((history, at)) = history.filter(|_| task.tolerance.passes > 1) else {
            return self.iterate_batched(task, false, 0, work, &mut losses);
        };
        let guess = wide(
            #[inline(always)]
            || self.guess_batched(task, history, at, work),
        );
        let guessed = guess && {
            self.evaluate_models_batched(work, &mut losses);
            wide(
                #[inline(always)]
                || {
                    let (growth, measured) = (history.growth(at), history.rate.as_ref());
                    let rate = measured.map_or(Lane::all(UNKNOWN), |rate| over(rate, |rate| rate * growth));
                    self.finish_guess_batched(task, &rate, work)
                },
            )
        };
        let good = guessed && !work.done.contains(&false);
        self.iterate_batched(task, guessed, usize::from(guess), work, &mut losses);
        if work.alone.contains(&true) {
            return history.clear();
        }
        if !guessed {
            history.rate = Some(work.rate);
        }
        history.push(
            task.torques,
            at,
            &work.drives,
            &mut work.unknown,
            guessed.then_some(good),
        );
    }

    /// Iterates models and equilibrium until they agree: from the start, or after a first iteration from a guess. `pass` is the
    /// number of previous iterations.
    fn iterate_batched(
        &self,
        task: &TaskLanes<'_>,
        guessed: bool,
        mut pass: usize,
        work: &mut WorkLanes,
        losses: &mut impl FnMut(&mut FlowLanes<'_>),
    ) {
        let settled = |work: &WorkLanes| (0..LANES).all(|i| work.done[i] || work.alone[i]);
        if !guessed {
            wide(
                #[inline(always)]
                || self.begin_batched(task, work),
            );
        }
        let mut known = false;
        while pass < FEW.min(task.tolerance.passes) && !settled(work) {
            pass += 1;
            self.evaluate_models_batched(work, losses);
            wide(
                #[inline(always)]
                || self.iteration_batched(task, work, (known, guessed), pass),
            );
            known = true;
        }
        for i in 0..LANES {
            work.alone[i] |= !work.done[i];
        }
    }

    fn evaluate_models_batched(&self, work: &mut WorkLanes, losses: &mut impl FnMut(&mut FlowLanes<'_>)) {
        work.model_losses.fill(ZERO);
        wide(
            #[inline(always)]
            || {
                for ((multiplier, x), scale) in work.multipliers.iter_mut().zip(&work.unknown).zip(&self.scale) {
                    *multiplier = over(x, |x| x * scale);
                }
            },
        );
        let drags = 2 * self.meshes.len();
        losses(&mut FlowLanes {
            multipliers: &work.multipliers,
            drives: &work.drives,
            ports: &work.ports,
            done: &work.done,
            mesh_loss: &mut work.model_losses,
            drags: &mut work.answer[drags..],
        });
    }

    /// Extrapolates the torques of a first iteration; false if there is no basis for it.
    #[inline(always)]
    fn guess_batched(&self, task: &TaskLanes<'_>, history: &mut TorqueHistory, at: f64, work: &mut WorkLanes) -> bool {
        if !history.weigh(task.torques, at) {
            return false;
        }
        self.prepare_batched(task, work);
        work.drives.copy_from_slice(&history.drives);
        for (place, unknown) in work.unknown[..self.size].iter_mut().enumerate() {
            *unknown = history.guess(place);
        }
        // Whether the driving gears are still the same is known only after the losses have been evaluated.
        self.torques_batched(work);
        true
    }

    /// Completes a first iteration from extrapolated torques: the equilibrium with its losses, and which lanes have converged.
    /// False if a driving gear changed, which invalidates the guess.
    #[inline(always)]
    fn finish_guess_batched(&self, task: &TaskLanes<'_>, rate: &Lane, work: &mut WorkLanes) -> bool {
        let k = self.meshes.len();
        work.answers();
        std::mem::swap(&mut work.used, &mut work.answer);
        self.right_side_batched(work);
        // A stationary drag has no power, but its torque loads rotating members.
        let fastest = task.speeds.iter().fold(0.0, |most, speed| larger(most, speed.abs()));
        let speed = |speed: f64| if speed == 0.0 { fastest } else { speed.abs() };
        for ((power, row), relative) in work.powers.iter_mut().zip(&self.meshes).zip(&work.relative) {
            *power = (self.scale[row.row] * row.z1 * speed(relative[1])).abs();
        }
        let neglected = self.cfriction_losses_batched(task.speeds, speed, work);
        self.accept_batched(task.speeds, work);
        let meshes = self.meshes.iter().zip(&work.powers);
        let ports = self.unknown.iter().zip(&work.step[self.rows..]);
        let moved = greatest(
            meshes
                .map(|(row, power)| (*power, &work.step[row.row]))
                .chain(ports.map(|(port, step)| (speed(task.speeds[*port]), step))),
        );
        let left = each(|i| to_come(moved[i], rate[i]) + moved[i] * neglected[i]);
        for i in 0..LANES {
            work.done[i] = left[i] <= SAFETY * task.tolerance.power * work.largest[i];
        }
        work.passes = [1; LANES];
        if work.done.contains(&false) {
            work.rate = *rate;
            // The following code takes the torques as an equilibrium with the losses used.
            self.right_side_batched(work);
            self.friction_batched(work);
            self.refine_batched(work);
            for (unknown, step) in work.unknown.iter_mut().zip(&work.step) {
                *unknown = each(|i| unknown[i] + step[i]);
            }
            self.accept_batched(task.speeds, work);
            for losses in [&mut work.used_before, &mut work.answer_before] {
                losses.copy_from_slice(&work.used);
            }
        }
        (0..k).all(|mesh| {
            let drives = work.drives[mesh];
            let agrees = |i: usize| work.alone[i] || drive(work.rolling[mesh][i], work.largest[i]) == drives;
            all_drive(drives, &work.rolling[mesh], &work.largest) || (0..LANES).all(agrees)
        })
    }

    /// Writes the given torques, for any first iteration.
    #[inline(always)]
    fn prepare_batched(&self, task: &TaskLanes<'_>, work: &mut WorkLanes) {
        work.alone = [false; LANES];
        work.done = [false; LANES];
        // No other column has an applied torque; torques of the other ports follow from the unknowns.
        for port in &self.given {
            work.applied[*port] = ZERO;
        }
        for (port, torque) in self.given.iter().zip(task.torques) {
            work.applied[*port] = each(|i| work.applied[*port][i] + torque[i]);
            work.ports[*port] = work.applied[*port];
        }
        self.relative(task.speeds, &mut work.relative);
    }

    #[inline(always)]
    fn begin_batched(&self, task: &TaskLanes<'_>, work: &mut WorkLanes) {
        let k = self.meshes.len();
        self.prepare_batched(task, work);
        work.rate = Lane::all(UNKNOWN);
        work.used.fill(ZERO);
        // An earlier block may have left NaN.
        work.used_before.fill(ZERO);
        work.answer_before.fill(ZERO);
        for (e, steady) in (2 * k..).zip(task.steady) {
            for losses in [&mut work.used, &mut work.used_before, &mut work.answer_before] {
                losses[e] = Lane::all(*steady);
            }
        }
        work.drives.fill(Drive::Neither);
        self.solve_batched(task.speeds, work, &[false; LANES]);
        // The driving gears of the point with the largest power are usually those of the others.
        let sound = (0..LANES).filter(|i| !work.alone[*i]);
        let most = sound.max_by(|a, b| work.largest[*a].total_cmp(&work.largest[*b]));
        let Some(first) = most else { return };
        for mesh in 0..k {
            let drives = |i: usize| drive(work.rolling[mesh][i], work.largest[i]);
            work.drives[mesh] = drives(first);
            if !all_drive(work.drives[mesh], &work.rolling[mesh], &work.largest) {
                for i in 0..LANES {
                    work.alone[i] |= drives(i) != work.drives[mesh];
                }
            }
            if work.drives[mesh] == Drive::Neither {
                work.rolling[mesh] = ZERO;
            }
        }
    }

    /// Processes the results of the models in one iteration.
    #[inline(always)]
    fn iteration_batched(
        &self,
        task: &TaskLanes<'_>,
        work: &mut WorkLanes,
        (known, guessed): (bool, bool),
        pass: usize,
    ) {
        let &TaskLanes { speeds, tolerance, .. } = task;
        let k = self.meshes.len();
        work.answers();
        for (weight, rolling) in work.weights.iter_mut().zip(&work.rolling) {
            *weight = over(rolling, f64::abs);
        }
        work.weights[k..2 * k].fill(Lane::all(1.0));
        for (weight, speed) in work.weights[2 * k..].iter_mut().zip(speeds) {
            *weight = Lane::all(speed.abs());
        }
        work.live.clear();
        for e in 0..work.used.len() {
            let (used, answer) = (&work.used[e], &work.answer[e]);
            let (used_before, answer_before) = (&work.used_before[e], &work.answer_before[e]);
            if !(same_numbers(used, answer) && same_numbers(used, used_before) && same_numbers(answer, answer_before)) {
                work.live.push(e);
            }
        }
        let mut mismatch = ZERO;
        for &e in &work.live {
            let own = work.mismatch(e);
            mismatch = each(|i| larger(mismatch[i], own[i].abs()));
        }
        let left = if known {
            let (left, rate) = work.remaining(&mismatch);
            // An entry that had no torque before gives no information in the iteration in which it gets some, but in the next.
            if !guessed {
                let done = &work.done;
                work.rate = each(|i| {
                    if work.rate[i] < UNKNOWN || done[i] {
                        work.rate[i]
                    } else {
                        rate[i]
                    }
                });
            }
            left
        } else {
            each(|i| to_come(mismatch[i], work.rate[i]))
        };
        let judged = known || guessed;
        let last: [bool; LANES] =
            std::array::from_fn(|i| work.done[i] || judged && left[i] <= SAFETY * tolerance.power * work.largest[i]);
        let back = if known { work.secant() } else { ZERO };
        let back = each(|i| if last[i] { 0.0 } else { back[i] });
        work.advance(&back, 2 * k);
        self.solve_batched(speeds, work, &last);
        for mesh in 0..k {
            work.turn(mesh, k);
        }
        for i in 0..LANES {
            if last[i] && !work.done[i] {
                work.done[i] = true;
                work.passes[i] = pass;
            }
        }
    }

    /// As [`Flow::solve`]; converged lanes are refined.
    #[inline(always)]
    fn solve_batched(&self, speeds: &[f64], work: &mut WorkLanes, kept: &[bool; LANES]) {
        self.right_side_batched(work);
        self.friction_batched(work);
        self.step_batched(work);
        work.unknown.copy_from_slice(&work.step);
        if kept.contains(&true) {
            self.refine_batched(work);
            let all = !kept.contains(&false);
            for (unknown, step) in work.unknown.iter_mut().zip(&work.step) {
                *unknown = if all {
                    each(|i| unknown[i] + step[i])
                } else {
                    each(|i| if kept[i] { unknown[i] + step[i] } else { unknown[i] })
                };
            }
        }
        self.accept_batched(speeds, work);
    }

    /// Writes given torques and losses to the right-hand side.
    #[inline(always)]
    fn right_side_batched(&self, work: &mut WorkLanes) {
        let k = self.meshes.len();
        let (loaded, others) = work.right.split_at_mut(self.columns);
        for ((right, applied), drag) in loaded.iter_mut().zip(&work.applied).zip(&work.used[2 * k..]) {
            *right = each(|i| -applied[i] - drag[i]);
        }
        for (right, applied) in others.iter_mut().zip(&work.applied[self.columns..]) {
            *right = over(applied, |x| -x);
        }
        for (mesh, row) in self.meshes.iter().enumerate() {
            let side = usize::from(work.drives[mesh] == Drive::Second);
            let (loss, relative) = (&work.used[k + mesh], work.relative[mesh][side]);
            if relative == 0.0 || same_numbers(loss, &ZERO) {
                continue;
            }
            let torque = over(loss, |loss| loss / relative);
            if let Some(driven) = [row.second, row.first][side] {
                work.right[driven] = each(|i| work.right[driven][i] + torque[i]);
            }
            if let Some(carrier) = row.carrier {
                work.right[carrier] = each(|i| work.right[carrier][i] - torque[i]);
            }
        }
    }

    /// Solves for the correction of the unknowns that removes their residual.
    #[inline(always)]
    fn refine_batched(&self, work: &mut WorkLanes) {
        self.residual_batched(work);
        self.step_batched(work);
    }

    /// As [`solve_batched`](Self::solve_batched) from unknowns close to the solution: the meshes lose their share of the correction
    /// as if it were frictionless. Keeps the correction as well, and returns a bound of the neglected share of its power, which is
    /// about the square of the sum of the loss shares of coupled meshes and ports. Infinite if that is not small, as close to
    /// self-locking.
    #[inline(always)]
    fn cfriction_losses_batched(&self, speeds: &[f64], speed: impl Fn(f64) -> f64, work: &mut WorkLanes) -> Lane {
        work.active.clear();
        work.active.extend(0..self.meshes.len());
        self.friction_losses_batched(work);
        // The new unknowns replace the correction until it is known.
        self.sparse.inverse.product(&work.right, &mut work.step);
        for (share, friction) in work.shares.iter_mut().zip(&self.friction) {
            let (new, old) = (&work.step[friction.row], &work.unknown[friction.row]);
            *share = each(|i| new[i] - old[i]);
        }
        let (mut together, mut coupling) = (ZERO, 0.0);
        for (mesh, friction) in self.friction.iter().enumerate() {
            let side = usize::from(work.drives[mesh] == Drive::Second);
            let (share, used) = (&work.shares[mesh], &work.used[mesh]);
            let lost = each(|i| -(share[i] * used[i]));
            together = each(|i| together[i] + used[i]);
            self.sparse.sides[mesh][side].1.add(&lost, &mut work.step);
            let own = 1.0 / work.powers[mesh];
            for (other, power) in friction.sides[side].coupling.iter().zip(&work.powers) {
                coupling = larger(coupling, other.abs() * power * own);
            }
            let ports = &friction.sides[side].response[self.rows..];
            for (response, port) in ports.iter().zip(&self.unknown) {
                coupling = larger(coupling, response.abs() * speed(speeds[*port]) * own);
            }
        }
        std::mem::swap(&mut work.unknown, &mut work.step);
        for (step, new) in work.step.iter_mut().zip(&work.unknown) {
            *step = each(|i| new[i] - step[i]);
        }
        // With the coupling C by shares the step is (1 - C) y and the exact one y/(1 + C): they differ by C^2/(1 - C^2) of the step.
        over(&together, |shares| {
            let square = (shares * coupling) * (shares * coupling);
            if square < 0.5 {
                square / (1.0 - square)
            } else {
                f64::INFINITY
            }
        })
    }

    /// Writes the residual of the unknowns to the right-hand side.
    #[inline(always)]
    fn residual_batched(&self, work: &mut WorkLanes) {
        self.sparse.base.product(&work.unknown, &mut work.residual);
        for (right, residual) in work.right.iter_mut().zip(&work.residual) {
            *right = each(|i| right[i] - residual[i]);
        }
        self.friction_losses_batched(work);
    }

    /// Writes the friction losses of the meshes' torques to the right-hand side.
    #[inline(always)]
    fn friction_losses_batched(&self, work: &mut WorkLanes) {
        for &mesh in &work.active {
            let (row, side) = (self.friction[mesh].row, usize::from(work.drives[mesh] == Drive::Second));
            let (share, torque) = (&work.used[mesh], &work.unknown[row]);
            let lost = each(|i| -(share[i] * torque[i]));
            self.sparse.sides[mesh][side].0.add(&lost, &mut work.right);
        }
    }

    /// Torques and the losses used, from the solved unknowns.
    #[inline(always)]
    fn accept_batched(&self, speeds: &[f64], work: &mut WorkLanes) {
        self.torques_batched(work);
        let ports = speeds.iter().copied().zip(&work.ports);
        work.largest = greatest(work.rolling.iter().map(|rolling| (1.0, rolling)).chain(ports));
        let k = self.meshes.len();
        for mesh in 0..k {
            let moves = work.relative[mesh][usize::from(work.drives[mesh] == Drive::Second)] != 0.0;
            let (share, constant, rolling) = (&work.used[mesh], &work.used[k + mesh], &work.rolling[mesh]);
            work.mesh_loss[mesh] = each(|i| share[i] * rolling[i].abs() + if moves { constant[i] } else { 0.0 });
        }
        let step = |[total]: [f64; 1], number: &Lane, i: usize| [total + number[i].abs()];
        let total = gather(work.unknown.iter().chain(&work.mesh_loss), [0.0], step, |[sum], _| sum);
        if count(|i| !total[i].is_finite()) > 0 {
            for i in 0..LANES {
                work.alone[i] |= !total[i].is_finite();
            }
        }
    }

    /// Torques of ports and powers of meshes, from the unknowns.
    #[inline(always)]
    fn torques_batched(&self, work: &mut WorkLanes) {
        for (port, torque) in self.unknown.iter().zip(&work.unknown[self.rows..]) {
            work.ports[*port] = *torque;
        }
        for (mesh, row) in self.meshes.iter().enumerate() {
            let relative = work.relative[mesh];
            let scale = self.scale[row.row];
            work.rolling[mesh] = over(&work.unknown[row.row], |x| -(x * scale) * row.z1 * relative[1]);
        }
    }

    /// Factors the small system of the meshes with friction. It is close to identity, so no pivoting is needed.
    #[inline(always)]
    fn friction_batched(&self, work: &mut WorkLanes) {
        work.active.clear();
        for mesh in 0..self.meshes.len() {
            if !same_numbers(&work.used[mesh], &ZERO) {
                work.active.push(mesh);
            }
        }
        let n = work.active.len();
        for (j, &mesh) in work.active.iter().enumerate() {
            let side = usize::from(work.drives[mesh] == Drive::Second);
            let coupling = &self.friction[mesh].sides[side].coupling;
            let share = &work.used[mesh];
            for (i, &other) in work.active.iter().enumerate() {
                let one = if i == j { 1.0 } else { 0.0 };
                work.filled[j * n + i] = i == j || coupling[other] != 0.0;
                work.small[j * n + i] = over(share, |share| coupling[other] * share + one);
            }
        }
        let filled = &mut work.filled;
        for column in 0..n {
            let pivot = work.small[column * n + column];
            let mut most = Lane::all(1e-13);
            for row in (column + 1..n).filter(|row| filled[column * n + row]) {
                let other = &work.small[column * n + row];
                most = each(|i| larger(most[i], other[i].abs()));
            }
            if count(|i| pivot[i].abs() < most[i]) > 0 {
                for i in 0..LANES {
                    work.alone[i] |= pivot[i].abs() < most[i];
                }
            }
            let inverse = over(&pivot, |pivot| 1.0 / pivot);
            work.small[column * n + column] = inverse;
            for row in (column + 1..n).filter(|row| filled[column * n + row]) {
                let own = &mut work.small[column * n + row];
                *own = each(|i| own[i] * inverse[i]);
            }
            for later in column + 1..n {
                if !filled[later * n + column] {
                    continue;
                }
                let upper = work.small[later * n + column];
                for row in column + 1..n {
                    if !filled[column * n + row] {
                        continue;
                    }
                    filled[later * n + row] = true;
                    let lower = work.small[column * n + row];
                    let entry = &mut work.small[later * n + row];
                    *entry = each(|i| entry[i] - lower[i] * upper[i]);
                }
            }
        }
    }

    #[inline(always)]
    fn step_batched(&self, work: &mut WorkLanes) {
        self.sparse.inverse.product(&work.right, &mut work.step);
        let n = work.active.len();
        for (share, &mesh) in work.shares.iter_mut().zip(&work.active) {
            *share = work.step[self.friction[mesh].row];
        }
        let (factors, filled, x) = (&work.small, &work.filled, &mut work.shares);
        for column in 0..n {
            let own = x[column];
            for row in (column + 1..n).filter(|row| filled[column * n + row]) {
                let factor = &factors[column * n + row];
                x[row] = each(|i| x[row][i] - factor[i] * own[i]);
            }
        }
        for column in (0..n).rev() {
            let inverse = &factors[column * n + column];
            x[column] = each(|i| x[column][i] * inverse[i]);
            let own = x[column];
            for row in (0..column).filter(|row| filled[column * n + row]) {
                let factor = &factors[column * n + row];
                x[row] = each(|i| x[row][i] - factor[i] * own[i]);
            }
        }
        for (j, &mesh) in work.active.iter().enumerate() {
            let side = usize::from(work.drives[mesh] == Drive::Second);
            let (share, used) = (&work.shares[j], &work.used[mesh]);
            let lost = each(|i| -(share[i] * used[i]));
            self.sparse.sides[mesh][side].1.add(&lost, &mut work.step);
        }
    }
}

impl WorkLanes {
    /// The entries of the losses from the results of the models.
    #[inline(always)]
    fn answers(&mut self) {
        let k = self.model_losses.len();
        for mesh in 0..k {
            let (loss, rolling) = (&self.model_losses[mesh], &self.rolling[mesh]);
            let proportional = |i: usize| loss[i] > 0.0 && loss[i] < 0.5 * rolling[i].abs();
            self.answer[mesh] = each(|i| {
                if proportional(i) {
                    loss[i] / rolling[i].abs()
                } else {
                    0.0
                }
            });
            self.answer[k + mesh] = each(|i| if proportional(i) { 0.0 } else { loss[i].max(0.0) });
        }
    }

    /// Excludes the lanes in which the driving gear of a mesh differs from the common one. A lane without previous torque may still
    /// get its driving gear.
    #[inline(always)]
    fn turn(&mut self, mesh: usize, meshes: usize) {
        if all_drive(self.drives[mesh], &self.rolling[mesh], &self.largest) {
            return;
        }
        let now: [Drive; LANES] = std::array::from_fn(|i| drive(self.rolling[mesh][i], self.largest[i]));
        if self.drives[mesh] != Drive::Neither {
            for i in 0..LANES {
                self.alone[i] |= now[i] != Drive::Neither && now[i] != self.drives[mesh];
            }
            return;
        }
        let Some(first) = (0..LANES).find(|i| !self.alone[*i] && now[*i] != Drive::Neither) else {
            return;
        };
        let (share, constant) = (&self.used[mesh], &self.used[meshes + mesh]);
        for i in 0..LANES {
            self.alone[i] |= match now[i] {
                // Without a driving gear the loss is computed as if the first gear drives.
                Drive::Neither => now[first] == Drive::Second,
                own => own != now[first] || share[i] > 0.0 || constant[i] > 0.0,
            };
        }
        self.drives[mesh] = now[first];
    }

    #[inline(always)]
    fn mismatch(&self, e: usize) -> Lane {
        let (answer, used, weight) = (&self.answer[e], &self.used[e], &self.weights[e]);
        each(|i| (answer[i] - used[i]) * weight[i])
    }

    /// As `remaining` of the loop for single points; also returns the largest convergence rate of all mismatches that matter
    /// relative to the largest one. A mismatch that did not change gives no rate.
    #[inline(always)]
    fn remaining(&self, greatest: &Lane) -> (Lane, Lane) {
        let (mut moved, mut followed) = (ZERO, ZERO);
        for &e in &self.live {
            let (used, before, weight) = (&self.used[e], &self.used_before[e], &self.weights[e]);
            moved = each(|i| larger(moved[i], ((used[i] - before[i]) * weight[i]).abs()));
            let (answer, before) = (&self.answer[e], &self.answer_before[e]);
            followed = each(|i| larger(followed[i], ((answer[i] - before[i]) * weight[i]).abs()));
        }
        let common = each(|i| if moved[i] > 0.0 { followed[i] / moved[i] } else { 1.0 });
        let (mut most, mut rate) = (ZERO, ZERO);
        for &e in &self.live {
            let mismatch = self.mismatch(e);
            let (used, used_before) = (&self.used[e], &self.used_before[e]);
            let (answer, answer_before) = (&self.answer[e], &self.answer_before[e]);
            let falls = each(|i| {
                let (moved, followed) = ((used[i] - used_before[i]).abs(), (answer[i] - answer_before[i]).abs());
                let own = if followed < moved { followed / moved } else { 1.0 };
                larger(common[i], own)
            });
            most = each(|i| {
                let left = to_come(mismatch[i].abs(), falls[i]);
                if mismatch[i] == 0.0 {
                    most[i]
                } else {
                    larger(most[i], left)
                }
            });
            rate = each(|i| {
                let counts = mismatch[i].abs() > NEGLIGIBLE * greatest[i];
                // An entry that gets its first torque gives no rate.
                let (moved, followed) = ((used[i] - used_before[i]).abs(), (answer[i] - answer_before[i]).abs());
                let own = if moved > 0.0 {
                    larger(common[i], followed / moved)
                } else {
                    UNKNOWN
                };
                if counts { larger(rate[i], own) } else { rate[i] }
            });
        }
        (most, over(&rate, |rate| if rate > 0.0 { rate } else { UNKNOWN }))
    }

    /// As `secant` of the loop for single points.
    #[inline(always)]
    fn secant(&self) -> Lane {
        let (mut product, mut square) = (ZERO, ZERO);
        for &e in &self.live {
            let now = self.mismatch(e);
            let (answer, used, weight) = (&self.answer_before[e], &self.used_before[e], &self.weights[e]);
            let before = each(|i| (answer[i] - used[i]) * weight[i]);
            product = each(|i| product[i] + now[i] * (now[i] - before[i]));
            square = each(|i| square[i] + (now[i] - before[i]) * (now[i] - before[i]));
        }
        each(|i| {
            let back = product[i] / square[i];
            let back = if back < REACH.0 { REACH.0 } else { back };
            let back = if back > REACH.1 { REACH.1 } else { back };
            if square[i] > 0.0 { back } else { 0.0 }
        })
    }

    /// The losses of the next solve; those of converged lanes stay.
    #[inline(always)]
    fn advance(&mut self, back: &Lane, magnitudes: usize) {
        for &e in &self.live {
            let (answer, answer_before, used) = (&self.answer[e], &self.answer_before[e], &self.used[e]);
            let next = each(|i| used[i] + (answer[i] - back[i] * (answer[i] - answer_before[i]) - used[i]));
            let next = if e < magnitudes {
                over(&next, |x| x.max(0.0))
            } else {
                next
            };
            self.used_before[e] = *used;
            self.used[e] = each(|i| if self.done[i] { used[i] } else { next[i] });
            self.answer_before[e] = self.answer[e];
        }
    }
}
