//! Equilibrium of the members of a block, and the step of a loop towards the losses that its torques cause.

use std::sync::Arc;

use super::linear::{eliminate, substitute};
use super::order::{Block, Equation, Feedback, Laws, Order};
use super::system::{Flow, MeshRow};
use super::work::{Start, Work};
use crate::real::{Points, Real};

/// Relative to the fastest speed, speeds below this are rounding error.
const STILL: f64 = 1e-12;
/// Safety factor of the estimated error of a loop.
const SAFETY: f64 = 0.5;
/// Greatest exponent with which a loss is assumed to follow a torque.
const STEEPEST: f64 = 2.0;
/// Least curvature of a loss over a torque, as a share of the loss: that of a constant plus a power with the exponent 1.5 whose tangent passes
/// through the origin, so that a straight line through it seems to be the law.
const LEAST_CURVATURE: f64 = 0.25;
/// Share of a torque up to which a loss is assumed to follow it.
const SMALL: f64 = 0.5;

impl Flow {
    /// Computes what is constant over a point: given torques, with or without the drags that are independent of torque, the speeds of
    /// the gears of each mesh, and powers per unit of each law.
    #[inline(always)]
    pub(super) fn prepare<R: Points>(&self, work: &mut Work<R>, with_drags: bool) {
        work.ports.fill(R::ZERO);
        for (port, torque) in self.given.iter().zip(&work.given) {
            work.ports[*port] += *torque;
        }
        work.multipliers.fill(R::ZERO);
        work.applied.fill(R::ZERO);
        work.applied[..self.columns].copy_from_slice(&work.ports);
        if with_drags {
            for (applied, drag) in work.applied.iter_mut().zip(&work.steady) {
                *applied += *drag;
            }
        }
        let fastest = work.speeds.iter().fold(R::ZERO, |most, w| most.max(w.abs()));
        for (k, mesh) in self.meshes.iter().enumerate() {
            let relative =
                [mesh.second, mesh.first].map(|gear| relative_speed(gear, mesh, &work.speeds, fastest * STILL));
            let power = relative[1] * (mesh.z1 * self.scale[mesh.row]);
            let rolls = !(relative[0].is_zero() | relative[1].is_zero());
            work.relative[k] = relative;
            work.per_watt[k] = R::select(rolls, R::constant(-1.0) / power, R::ZERO);
            work.weights[k] = R::select(rolls, power.abs(), R::ZERO);
        }
        for (weight, drag) in work.weights[self.meshes.len()..].iter_mut().zip(&self.drags) {
            let [a, b] = drag.between.map(|column| column.map_or(R::ZERO, |c| work.speeds[c]));
            *weight = (a - b).abs();
        }
    }

    /// The order of the present driving gears.
    pub(super) fn adopt_order<R: Points>(&self, work: &mut Work<R>) -> Option<Arc<Order>> {
        if !work.order.is_of(&work.drives) {
            work.order = self.order(&work.drives)?;
            let leads = work.order.blocks.iter().map(|block| block.leads.len()).max();
            let leads = leads.unwrap_or(0).max(work.exchanged.len());
            work.factors.resize(leads * leads, R::ZERO);
            work.exchanged.resize(leads, 0);
        }
        Some(Arc::clone(&work.order))
    }

    /// Unknowns of a block in equilibrium with earlier unknowns and losses.
    #[inline(always)]
    pub(super) fn balance<R: Points>(&self, block: &Block, work: &mut Work<R>) {
        self.balance_with(block, work, |_| &[]);
    }

    /// Ends a loop: its unknowns in equilibrium also with its own losses.
    #[inline(always)]
    pub(super) fn accept<R: Points>(&self, block: &Block, work: &mut Work<R>) {
        self.balance_with(block, work, |equation| &equation.own_laws);
    }

    #[inline(always)]
    fn balance_with<R: Points>(
        &self,
        block: &Block,
        work: &mut Work<R>,
        own_laws: impl Fn(&Equation) -> &[(usize, f64)],
    ) {
        let n = block.unknowns.len();
        for (right, equation) in work.right.iter_mut().zip(&block.equations) {
            let mut sum = -work.applied[equation.number];
            for (law, effect) in equation.laws.iter().chain(own_laws(equation)) {
                sum += work.answers[*law] * *effect;
            }
            for (unknown, coefficient) in &equation.unknowns {
                sum -= work.unknown[*unknown] * *coefficient;
            }
            *right = sum;
        }
        substitute(&block.factors, &block.exchanged, &mut work.right[..n]);
        for (place, unknown) in block.unknowns.iter().enumerate() {
            work.unknown[*unknown] = work.right[place];
        }
        self.write(block, work);
    }

    /// Writes the torques of the unknowns of a block.
    #[inline(always)]
    pub(super) fn write<R: Points>(&self, block: &Block, work: &mut Work<R>) {
        for &unknown in &block.unknowns {
            let x = work.unknown[unknown];
            match unknown.checked_sub(self.rows) {
                None => work.multipliers[unknown] = x * self.scale[unknown],
                Some(port) => work.ports[self.unknown[port]] = x,
            }
        }
    }

    /// Begins a loop: its unknowns without its own losses, or those of the last solve.
    #[inline(always)]
    pub(super) fn begin<R: Points>(&self, block: &Block, start: Start, work: &mut Work<R>) {
        for &unknown in &block.unknowns {
            work.before[unknown] = work.unknown[unknown];
        }
        self.balance(block, work);
        for &unknown in &block.unknowns {
            work.bare[unknown] = work.unknown[unknown];
        }
        if start == Start::Last {
            for &unknown in &block.unknowns {
                work.unknown[unknown] = work.before[unknown];
            }
            self.write(block, work);
        }
    }

    /// Takes the losses of laws: meshes as lost multipliers, drags as moments. Returns where all of them are finite.
    #[inline(always)]
    pub(super) fn take_answers<R: Points>(&self, laws: &Laws, work: &mut Work<R>) -> R::Mask {
        let mut sum = R::ZERO;
        let mut take = |answer: R| {
            sum += answer.abs();
            R::select(answer.abs().is_below(R::constant(f64::INFINITY)), answer, R::ZERO)
        };
        for &k in &laws.meshes {
            let loss = take(work.mesh_loss[k]);
            let loss = R::select(work.per_watt[k].is_zero(), R::ZERO, loss);
            let sign = if work.drives[k].driven() == 1 { -1.0 } else { 1.0 };
            work.mesh_loss[k] = loss;
            work.answers[k] = loss * work.per_watt[k] * sign;
        }
        for &drag in &laws.drags {
            work.answers[self.meshes.len() + drag] = take(work.moments[drag]);
        }
        sum.is_below(R::constant(f64::INFINITY))
    }

    /// The next unknowns of a loop, with the share of a step that is taken. Points are done whose losses, followed to the next unknowns, are
    /// uncertain by less than a tolerance of the power of the loop. Returns where there are any unknowns, and the greatest uncertainty.
    /// \[W\]
    #[inline(always)]
    pub(super) fn approach<R: Points>(
        &self,
        block: &Block,
        (first, share): (bool, f64),
        (power, tolerance): (R, R),
        work: &mut Work<R>,
    ) -> (R::Mask, R) {
        let leads = block.leads.len();
        let lead_of = |lead: usize| block.unknowns[block.leads[lead]];
        let (matrix, right) = (&mut work.factors[..leads * leads], &mut work.right[..leads]);
        matrix.fill(R::ZERO);
        for (i, &place) in block.leads.iter().enumerate() {
            matrix[i * leads + i] = R::constant(1.0);
            right[i] = work.bare[block.unknowns[place]];
        }
        for feedback in &block.feedback {
            let (law, lead) = (feedback.law, feedback.lead);
            let (x, y) = (work.unknown[lead_of(lead)], work.answers[law]);
            let slope = work.followed[law];
            let bare = y - slope * x;
            for (i, &place) in block.leads.iter().enumerate() {
                matrix[lead * leads + i] -= slope * feedback.response[place];
                right[i] += bare * feedback.response[place];
            }
        }
        let found = eliminate(matrix, &mut work.exchanged[..leads]);
        substitute(matrix, &work.exchanged[..leads], right);
        for &unknown in &block.unknowns {
            work.next[unknown] = work.bare[unknown];
        }
        for feedback in &block.feedback {
            let (law, lead) = (feedback.law, feedback.lead);
            let (x, y) = (work.unknown[lead_of(lead)], work.answers[law]);
            let answer = y + work.followed[law] * (work.right[lead] - x);
            for (unknown, response) in block.unknowns.iter().zip(&feedback.response) {
                work.next[*unknown] += answer * *response;
            }
        }
        let mut doubt = R::ZERO;
        for feedback in &block.feedback {
            doubt = doubt.max(doubt_of(feedback, lead_of(feedback.lead), (first, power), work));
        }
        let size = block.unknowns.iter().fold(R::ZERO, |sum, x| sum + work.next[*x].abs());
        let found = found & size.is_below(R::constant(f64::INFINITY));
        work.done = work.done | found & !doubt.is_above(power * tolerance * SAFETY);
        for &unknown in &block.unknowns {
            let x = work.unknown[unknown];
            let step = (work.next[unknown] - x) * share;
            work.before[unknown] = x;
            work.unknown[unknown] = R::select(work.done | !found, x, x + step);
        }
        for feedback in &block.feedback {
            work.answers_before[feedback.law] = work.answers[feedback.law];
        }
        self.write(block, work);
        (found, doubt)
    }

    /// The power that the first gear puts into a mesh.
    #[inline(always)]
    pub(super) fn roll<R: Points>(&self, k: usize, work: &mut Work<R>) {
        let mesh = &self.meshes[k];
        work.rolling[k] = -work.multipliers[mesh.row] * mesh.z1 * work.relative[k][1];
        work.largest = work.largest.max(work.rolling[k].abs());
    }

    /// Rolling powers and the largest internal power.
    #[inline(always)]
    pub(super) fn powers<R: Points>(&self, work: &mut Work<R>) {
        work.largest = R::ZERO;
        for k in 0..self.meshes.len() {
            self.roll(k, work);
        }
        for (speed, torque) in work.speeds.iter().zip(&work.ports) {
            work.largest = work.largest.max((*speed * *torque).abs());
        }
    }

    /// Powers and drags of a solved flow.
    #[inline(always)]
    pub(super) fn sum_up<R: Points>(&self, work: &mut Work<R>) {
        self.powers(work);
        work.drags.copy_from_slice(&work.steady);
        for (drag, moment) in self.drags.iter().zip(&work.answers[self.meshes.len()..]) {
            for (column, sign) in drag.between.iter().zip([-1.0, 1.0]) {
                if let Some(column) = column {
                    work.drags[*column] += *moment * sign;
                }
            }
        }
    }
}

/// Moves the losses of a loop along their derivatives to the next unknowns.
#[inline(always)]
pub(super) fn follow_to_next<R: Points>(block: &Block, work: &mut Work<R>) {
    for feedback in &block.feedback {
        let (law, lead) = (feedback.law, block.unknowns[block.leads[feedback.lead]]);
        let found = work.answers[law];
        let next = found + work.followed[law] * (work.next[lead] - work.unknown[lead]);
        let share = R::select(found.is_zero(), R::constant(1.0), next / found);
        work.answers[law] = found * share;
        work.accepted[law] = share;
        if let Some(loss) = work.mesh_loss.get_mut(law) {
            *loss = *loss * share;
        }
    }
}

/// By how much a loss of a loop may differ at the next unknowns from what follows from its derivative. \[W\]
///
/// A loss f is about a constant and a power of the torque x with an exponent of 0 to 2. Before a secant is known, its derivative is wrong by at
/// most f / x. The error of a secant is f'' / 2 times the distances from both of its points. Of such a loss, the curvature x^2 f'' / 2 is at most
/// x f' / 2 and, without the constant, at most the difference of x f' from f. Other unknowns count by as much as they do not change along.
#[inline(always)]
fn doubt_of<R: Points>(feedback: &Feedback, lead: usize, (first, power): (bool, R), work: &Work<R>) -> R {
    let (law, x) = (feedback.law, work.unknown[lead]);
    let (loss, slope) = (work.answers[law].abs(), work.slopes[law]);
    let step = work.next[lead] - x;
    let before = x - work.before[lead];
    // Without a step before, nothing changes along.
    let along = R::select(before.is_zero() | R::mask(|_| first), R::ZERO, step / before);
    let mut others = R::ZERO;
    for &other in &feedback.others {
        let y = work.unknown[other];
        let apart = work.next[other] - y - along * (y - work.before[other]);
        others += R::select(apart.is_zero(), R::ZERO, (apart / y).abs());
    }
    let error = if first {
        loss
    } else {
        let own = (slope * x).abs();
        let curvature = (own * 0.5).min((own - loss).abs()).max(loss * LEAST_CURVATURE);
        let far = ((step + before) / x).abs().min(R::constant(1.0));
        curvature * far + ((slope - work.followed[law]) * x).abs()
    };
    let own = error * (step / x).abs();
    let doubt = (own + loss * others) * work.weights[law];
    let doubt = R::select(step.is_zero() & others.is_zero(), R::ZERO, doubt);
    // Of a torque that was zero nothing is known.
    R::select(x.is_zero() & !step.is_zero(), power, doubt)
}

/// Derivatives of the laws of a loop over their leading unknowns: after the first evaluation those of powers of these, then secants.
#[inline(always)]
pub(super) fn follow<R: Points>(block: &Block, first: bool, work: &mut Work<R>) {
    for feedback in &block.feedback {
        let (law, lead) = (feedback.law, block.unknowns[block.leads[feedback.lead]]);
        let (x, y) = (work.unknown[lead], work.answers[law]);
        work.slopes[law] = if first {
            R::select(y.is_zero() | x.is_zero(), R::ZERO, y / x * feedback.exponent)
        } else {
            let step = x - work.before[lead];
            let secant = (y - work.answers_before[law]) / step;
            R::select(step.is_zero(), work.slopes[law], secant)
        };
    }
    bound(block, work);
}

/// The derivatives of the laws of a loop as far as a step follows them.
#[inline(always)]
pub(super) fn bound<R: Points>(block: &Block, work: &mut Work<R>) {
    for feedback in &block.feedback {
        let (law, lead) = (feedback.law, block.unknowns[block.leads[feedback.lead]]);
        let (x, y) = (work.unknown[lead], work.answers[law]);
        work.followed[law] = bounded(work.slopes[law], x, y, feedback.gain);
    }
}

/// A derivative of a loss `y` over a torque `x`, which may not be steeper than laws are. Where the loss, times a gain, is not small
/// against the torque, it is not followed: the next torque would have another direction.
#[inline(always)]
fn bounded<R: Real>(slope: R, x: R, y: R, gain: f64) -> R {
    let steepest = (y / x).abs() * STEEPEST;
    let slope = slope.min(steepest).max(-steepest);
    R::select((y.abs() * gain).is_below(x.abs() * SMALL), slope, R::ZERO)
}

/// Speed of a gear in the carrier's frame; zero if it is rounding error.
#[inline(always)]
fn relative_speed<R: Real>(gear: Option<usize>, mesh: &MeshRow, speeds: &[R], still: R) -> R {
    let speed = |column: Option<usize>| column.map_or(R::ZERO, |c| speeds[c]);
    let relative = speed(gear) - speed(mesh.carrier);
    R::select(relative.abs().is_above(still), relative, R::ZERO)
}
