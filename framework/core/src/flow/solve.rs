//! The iteration between torque and loss.

use super::linear::larger;
use super::system::Flow;
use super::work::{Drive, FlowState, Outcome, Tolerance, Work};

/// Relative to the largest internal power, a rolling power below this has no direction.
pub(super) const NO_POWER: f64 = 1e-13;
/// A driving gear that changes more often than this indicates a train that may be self-locking.
const TURNS: u8 = 4;
/// Iterations without progress after which steps are halved.
pub(super) const PATIENCE: usize = 10;
/// Safety factor: the remaining error is estimated from two steps.
pub(super) const SAFETY: f64 = 0.5;
/// Maximum extrapolation, in steps in either direction.
pub(super) const REACH: (f64, f64) = (-9.0, 0.9);

impl Flow {
    /// The power flow without losses. Speeds of all columns; torques of the given ports in their order.
    pub fn ideal(&self, speeds: &[f64], torques: &[f64], work: &mut Work) {
        work.used.values.fill(0.0);
        work.drags.fill(0.0);
        work.mismatch = 0.0;
        self.begin(speeds, torques, work, true);
    }

    /// The power flow without mesh losses, for the drags in `work.used`, and the resulting driving gears; to rounding if it is
    /// `kept`.
    fn begin(&self, speeds: &[f64], torques: &[f64], work: &mut Work, kept: bool) {
        self.prepare(speeds, torques, work);
        work.drives.fill(Drive::Neither);
        if !self.solve(speeds, work, kept) {
            // Reached only if torques overflow.
            work.multipliers.fill(0.0);
            work.ports.fill(0.0);
            work.rolling.fill(0.0);
            work.mesh_loss.fill(0.0);
            work.largest = 0.0;
        }
        for k in 0..self.meshes.len() {
            work.drives[k] = drive(work.rolling[k], work.largest);
            work.rolling[k] = if work.drives[k] == Drive::Neither {
                0.0
            } else {
                work.rolling[k]
            };
        }
    }

    /// The power flow with losses that `losses` computes from the torques; `steady` are the torques on all columns from drags that
    /// are independent of torque, with which the initial torques are computed. The losses in `work` are those of the accepted
    /// solve, so the power balance holds to rounding for any tolerance. The first iteration is a guess, so there are at least two.
    pub fn real(
        &self,
        speeds: &[f64],
        torques: &[f64],
        steady: &[f64],
        tolerance: Tolerance,
        work: &mut Work,
        mut losses: impl FnMut(&mut FlowState<'_>),
    ) -> Outcome {
        work.used.values.fill(0.0);
        work.used.drags_mut().copy_from_slice(steady);
        self.begin(speeds, torques, work, false);
        work.turned.fill(0);
        let mut passes = 0;
        let task = Task {
            speeds,
            torques,
            tolerance,
        };
        let end = match self.iterate(task, work, &mut losses, &mut passes, false) {
            End::Turning => self.patterns(task, work, &mut losses, &mut passes),
            End::Agreed => Outcome::Converged { passes },
            End::Open => Outcome::NoConvergence,
        };
        work.drags.copy_from_slice(work.used.drags());
        end
    }

    /// Iterates models and equilibrium until they agree; `fixed` keeps the driving gears.
    fn iterate(
        &self,
        task: Task<'_>,
        work: &mut Work,
        losses: &mut impl FnMut(&mut FlowState<'_>),
        passes: &mut usize,
        fixed: bool,
    ) -> End {
        let Task { speeds, tolerance, .. } = task;
        let mut known = false;
        let (mut least, mut slow, mut damping) = (f64::INFINITY, 0, 1.0);
        for _ in 0..tolerance.passes {
            *passes += 1;
            if !evaluate_losses(speeds, work, losses) {
                return End::Open;
            }
            self.weigh(speeds, work);
            work.mismatch = work.entries().fold(0.0, |most, e| larger(most, e.mismatch().abs()));
            let left = if known { remaining(work) } else { work.mismatch };
            let last = known && left <= SAFETY * tolerance.power * work.largest;
            if work.mismatch < least {
                (least, slow) = (work.mismatch, 0);
            } else {
                slow += 1;
                if slow == PATIENCE {
                    (damping, slow) = (0.5 * damping, 0);
                }
            }
            let back = if known && !last { secant(work) } else { 0.0 };
            let pace = if last { 1.0 } else { damping };
            self.advance(work, back, pace);
            if !self.solve(speeds, work, last) {
                return if fixed { End::Turning } else { End::Open };
            }
            known = true;
            if !fixed && turn(work) {
                // The friction just used was on the wrong gear: this flow is invalid.
                known = false;
                least = f64::INFINITY;
                if work.turned.iter().any(|turned| *turned > TURNS) {
                    return End::Turning;
                }
                continue;
            }
            if last {
                return End::Agreed;
            }
        }
        End::Open
    }

    /// Power per unit of each entry of the losses.
    fn weigh(&self, speeds: &[f64], work: &mut Work) {
        let meshes = self.meshes.len();
        for (weight, rolling) in work.weights.iter_mut().zip(&work.rolling) {
            *weight = rolling.abs();
        }
        work.weights[meshes..2 * meshes].fill(1.0);
        for (weight, speed) in work.weights[2 * meshes..].iter_mut().zip(speeds) {
            *weight = speed.abs();
        }
    }

    /// The losses of the next solve: the result, extrapolated by `back` towards the previous result, with relaxation.
    fn advance(&self, work: &mut Work, back: f64, pace: f64) {
        let answers = work.answer.values.iter().zip(&mut work.answer_before.values);
        let uses = work.used.values.iter_mut().zip(&mut work.used_before.values);
        for ((used, used_before), (answer, answer_before)) in uses.zip(answers) {
            *used_before = *used;
            *used += pace * (answer - back * (answer - *answer_before) - *used);
            *answer_before = *answer;
        }
        for magnitude in &mut work.used.values[..2 * self.meshes.len()] {
            *magnitude = magnitude.max(0.0);
        }
    }

    /// Tries patterns of the meshes whose driving gear kept changing, in order of the number of changes to the ideal pattern.
    fn patterns(
        &self,
        task: Task<'_>,
        work: &mut Work,
        losses: &mut impl FnMut(&mut FlowState<'_>),
        passes: &mut usize,
    ) -> Outcome {
        let mut doubtful = [0_usize; 8];
        let mut count = 0;
        for k in 0..self.meshes.len() {
            if work.turned[k] > 0 {
                if count == doubtful.len() {
                    return Outcome::NoConvergence;
                }
                doubtful[count] = k;
                count += 1;
            }
        }
        self.ideal(task.speeds, task.torques, work);
        work.ideal.copy_from_slice(&work.drives);
        for changes in 0..=count as u32 {
            for pattern in (0..1_u32 << count).filter(|p| p.count_ones() == changes) {
                self.ideal(task.speeds, task.torques, work);
                for (bit, &k) in doubtful[..count].iter().enumerate() {
                    if pattern >> bit & 1 == 1 {
                        work.drives[k] = if work.ideal[k] == Drive::Second {
                            Drive::First
                        } else {
                            Drive::Second
                        };
                    }
                }
                let end = self.iterate(task, work, losses, passes, true);
                let agrees = |k: usize| {
                    let now = drive(work.rolling[k], work.largest);
                    now == Drive::Neither || now == work.drives[k]
                };
                if matches!(end, End::Agreed) && (0..self.meshes.len()).all(agrees) {
                    return Outcome::Converged { passes: *passes };
                }
            }
        }
        Outcome::SelfLocking
    }
}

/// The problem and its tolerance.
#[derive(Clone, Copy)]
struct Task<'a> {
    speeds: &'a [f64],
    torques: &'a [f64],
    tolerance: Tolerance,
}

/// How a loop ended.
enum End {
    /// Loads and losses agree.
    Agreed,
    /// A driving gear changed too often, or the tried pattern has no equilibrium.
    Turning,
    /// Neither within the iteration limit.
    Open,
}

/// Evaluates the losses of the models at the present torques; false if a result is NaN.
fn evaluate_losses(speeds: &[f64], work: &mut Work, losses: &mut impl FnMut(&mut FlowState<'_>)) -> bool {
    work.model_losses.fill(0.0);
    work.answer.drags_mut().fill(0.0);
    losses(&mut FlowState {
        speeds,
        multipliers: &work.multipliers,
        drives: &work.drives,
        ports: &work.ports,
        mesh_loss: &mut work.model_losses,
        drags: work.answer.drags_mut(),
    });
    for (k, loss) in work.model_losses.iter().enumerate() {
        work.answer.set_mesh(k, *loss, work.rolling[k].abs());
    }
    work.model_losses
        .iter()
        .chain(work.answer.drags())
        .all(|x| x.is_finite())
}

/// Adopts the driving gears of the last solve; true if one of them was assumed differently.
fn turn(work: &mut Work) -> bool {
    let mut turned = false;
    for k in 0..work.drives.len() {
        let now = drive(work.rolling[k], work.largest);
        if now == Drive::Neither || now == work.drives[k] {
            continue;
        }
        if work.drives[k] == Drive::Neither {
            turned |= work.used.share(k) > 0.0 || work.used.constant(k) > 0.0;
        } else {
            turned = true;
            work.turned[k] += 1;
        }
        work.drives[k] = now;
    }
    turned
}

/// Expected error after one more plain step: the mismatch of each loss decreases as in the last step, or as all of them together,
/// whichever is slower. A loss that has just appeared gives no rate yet.
fn remaining(work: &Work) -> f64 {
    let (moved, followed) = work.entries().fold((0.0, 0.0), |(moved, followed), entry| {
        (
            larger(moved, (entry.moved() * entry.weight).abs()),
            larger(followed, (entry.followed() * entry.weight).abs()),
        )
    });
    let common = if moved > 0.0 { followed / moved } else { 1.0 };
    let mut most = 0.0;
    for entry in work.entries() {
        let mismatch = entry.mismatch().abs();
        if mismatch == 0.0 {
            continue;
        }
        let (moved, followed) = (entry.moved().abs(), entry.followed().abs());
        let own = if followed < moved { followed / moved } else { 1.0 };
        let falls = larger(common, own);
        // The sum of all following steps, as a geometric series.
        most = larger(most, mismatch * falls / larger(1e-3, 1.0 - falls));
    }
    most
}

/// Extrapolation factor towards the previous result that makes the mismatch along the last step vanish (Anderson 1965 with a depth
/// of one).
fn secant(work: &Work) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for entry in work.entries() {
        let now = entry.mismatch();
        let before = (entry.answer_before - entry.used_before) * entry.weight;
        product += now * (now - before);
        square += (now - before) * (now - before);
    }
    if square > 0.0 {
        (product / square).clamp(REACH.0, REACH.1)
    } else {
        0.0
    }
}

pub(super) fn drive(rolling: f64, largest: f64) -> Drive {
    if rolling.abs() <= NO_POWER * largest {
        Drive::Neither
    } else if rolling > 0.0 {
        Drive::First
    } else {
        Drive::Second
    }
}
