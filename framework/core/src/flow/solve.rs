//! The iteration between torque and loss, of one point or of several together.
//!
//! Points that are solved together have the driving gears in common. The leading point, that with the largest power, decides them;
//! points that would decide otherwise, and those that do not converge soon, leave and are solved alone. The operations of a point
//! are the same either way.

use super::system::Flow;
use super::work::{Drive, FlowState, Outcome, Start, Tolerance, Work};
use crate::real::{Mask as _, Points};

/// Relative to the largest internal power, a rolling power below this has no direction.
const NO_POWER: f64 = 1e-13;
/// A driving gear that changes more often than this indicates a train that may be self-locking.
const TURNS: u8 = 4;
/// Iterations without progress after which steps are halved.
const PATIENCE: usize = 10;
/// Iterations after which points that are solved together leave; up to here, no step is halved.
const TOGETHER: usize = PATIENCE - 2;
/// Tolerance above which the losses at the torques without losses may be the result, if they are within the tolerance: only estimates
/// ask for so little.
const ROUGH: f64 = 0.01;
/// Safety factor: the remaining error is estimated from two steps.
const SAFETY: f64 = 0.5;
/// Maximum extrapolation, in steps in either direction.
const REACH: (f64, f64) = (-9.0, 0.9);

impl Flow {
    /// The power flow without losses, at the speeds and given torques of the work.
    pub fn ideal<R: Points>(&self, work: &mut Work<R>) {
        work.used.values.fill(R::ZERO);
        work.drags.fill(R::ZERO);
        work.mismatch = R::ZERO;
        R::wide(
            #[inline(always)]
            || self.begin(work, R::mask(|_| true)),
        );
    }

    /// The power flow without mesh losses, for the drags in `work.used`, and the resulting driving gears; to rounding where it is
    /// `kept`.
    #[inline(always)]
    fn begin<R: Points>(&self, work: &mut Work<R>, kept: R::Mask) {
        self.prepare(work);
        work.drives.fill(Drive::Neither);
        work.rolling.fill(R::ZERO);
        work.mesh_loss.fill(R::ZERO);
        work.largest = R::ZERO;
        // There is none only if torques overflow.
        self.solve(work, kept);
        lead(work);
        for k in 0..self.meshes.len() {
            let drives = |point: usize| drive(work.rolling[k].at_point(point), work.largest.at_point(point));
            let decided = drives(work.leading);
            let agreed = R::mask(|point| drives(point) == decided);
            work.drives[k] = decided;
            if decided == Drive::Neither {
                work.rolling[k] = R::ZERO;
            }
            work.keep(agreed);
        }
    }

    /// The power flow with losses that `losses` computes from the torques, at the speeds and given torques of the work. The losses in `work` are those of the accepted solve, so
    /// the power balance holds to rounding for any tolerance. Without losses the first iteration is a guess, so there are at least two.
    pub fn real<R: Points>(
        &self,
        tolerance: Tolerance<R>,
        start: Start,
        work: &mut Work<R>,
        mut losses: impl FnMut(&mut FlowState<'_, R>),
    ) -> Outcome {
        for values in [&mut work.used_before, &mut work.answer_before] {
            values.values.fill(R::ZERO);
        }
        if start == Start::Lossless {
            work.used.values.fill(R::ZERO);
            work.used.drags_mut().copy_from_slice(&work.steady);
        }
        R::wide(
            #[inline(always)]
            || {
                if start == Start::Lossless {
                    self.begin(work, R::mask(|_| false));
                } else {
                    self.prepare(work);
                    work.rolling.fill(R::ZERO);
                    work.largest = R::ZERO;
                    self.solve(work, R::mask(|_| false));
                    lead(work);
                }
            },
        );
        work.turned.fill(0);
        work.passes = R::ZERO;
        let mut passes = 0;
        let mut steps = Steps {
            near: R::mask(|_| start == Start::Last) | tolerance.power.is_above(R::constant(ROUGH)),
            ..Steps::default()
        };
        let end = match self.iterate(tolerance, work, &mut losses, &mut passes, &mut steps) {
            End::Turning => self.patterns(tolerance, work, &mut losses, &mut passes),
            End::Agreed => Outcome::Converged { passes },
            End::Open => Outcome::NoConvergence,
        };
        work.drags.copy_from_slice(work.used.drags());
        end
    }

    /// Iterates models and equilibrium until they agree.
    fn iterate<R: Points>(
        &self,
        tolerance: Tolerance<R>,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
        passes: &mut usize,
        steps: &mut Steps<R>,
    ) -> End {
        work.done = R::mask(|_| false);
        let most = if R::COUNT == 1 {
            tolerance.passes
        } else {
            tolerance.passes.min(TOGETHER)
        };
        for _ in 0..most {
            *passes += 1;
            let finite = evaluate_losses(work, losses);
            work.keep(finite);
            if R::COUNT == 1 && !finite.all() {
                return End::Open;
            }
            let found = R::wide(
                #[inline(always)]
                || self.follow(tolerance, work, steps),
            );
            work.keep(found);
            if R::COUNT == 1 && !found.all() {
                return if steps.fixed { End::Turning } else { End::Open };
            }
            if !steps.fixed && turn(work) {
                // The friction just used was on the wrong gear: this flow is invalid.
                *steps = Steps {
                    slow: steps.slow,
                    damping: steps.damping,
                    ..Steps::default()
                };
                work.done = R::mask(|_| false);
                if work.turned.iter().any(|turned| *turned > TURNS) {
                    return End::Turning;
                }
                continue;
            }
            work.passes = R::select(steps.last & !work.done, R::constant(*passes as f64), work.passes);
            work.done = steps.last;
            if (work.done | !work.live).all() {
                return End::Agreed;
            }
        }
        work.keep(work.done);
        if R::COUNT == 1 { End::Open } else { End::Agreed }
    }

    /// Follows the results of the models with the next torques. Returns where there are any.
    #[inline(always)]
    fn follow<R: Points>(&self, tolerance: Tolerance<R>, work: &mut Work<R>, steps: &mut Steps<R>) -> R::Mask {
        self.weigh(work);
        work.list_live_entries();
        let mut mismatch = R::ZERO;
        for &entry in &work.live_entries {
            mismatch = mismatch.max(work.difference(entry).abs());
        }
        work.mismatch = mismatch;
        let enough = work.largest * (tolerance.power * SAFETY);
        steps.last = if steps.known {
            work.done | !remaining(work).is_above(enough)
        } else {
            // Losses below half of the power decrease by more than half in a step, so all that follows is less than the mismatch.
            work.done | steps.near & !mismatch.is_above(enough)
        };
        if R::COUNT == 1 {
            steps.halve_without_progress(mismatch.at_point(0));
        }
        let back = if steps.known {
            R::select(steps.last, R::ZERO, secant(work))
        } else {
            R::ZERO
        };
        let pace = R::select(steps.last, R::constant(1.0), R::constant(steps.damping));
        self.advance(work, back, pace);
        steps.known = true;
        self.solve(work, steps.last)
    }

    /// Power per unit of each entry of the losses.
    #[inline(always)]
    pub(super) fn weigh<R: Points>(&self, work: &mut Work<R>) {
        let meshes = self.meshes.len();
        for (weight, rolling) in work.weights.iter_mut().zip(&work.rolling) {
            *weight = rolling.abs();
        }
        work.weights[meshes..2 * meshes].fill(R::constant(1.0));
        for (weight, speed) in work.weights[2 * meshes..].iter_mut().zip(&work.speeds) {
            *weight = speed.abs();
        }
    }

    /// The losses of the next solve: the result, extrapolated by `back` towards the previous result, with relaxation. Those of
    /// converged points stay.
    #[inline(always)]
    fn advance<R: Points>(&self, work: &mut Work<R>, back: R, pace: R) {
        for &entry in &work.live_entries {
            let (used, answer) = (work.used.values[entry], work.answer.values[entry]);
            let next = used + pace * (answer - back * (answer - work.answer_before.values[entry]) - used);
            let magnitude = entry < 2 * self.meshes.len();
            let next = if magnitude { next.at_least(0.0) } else { next };
            work.used_before.values[entry] = used;
            work.used.values[entry] = R::select(work.done, used, next);
            work.answer_before.values[entry] = answer;
        }
    }

    /// Tries patterns of the meshes whose driving gear kept changing, in order of the number of changes to the ideal pattern.
    fn patterns<R: Points>(
        &self,
        tolerance: Tolerance<R>,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
        passes: &mut usize,
    ) -> Outcome {
        if R::COUNT > 1 {
            // Each point has its own pattern.
            work.live = R::mask(|_| false);
            return Outcome::Converged { passes: *passes };
        }
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
        self.ideal(work);
        work.ideal.copy_from_slice(&work.drives);
        for changes in 0..=count as u32 {
            for pattern in (0..1_u32 << count).filter(|p| p.count_ones() == changes) {
                self.ideal(work);
                for (bit, &k) in doubtful[..count].iter().enumerate() {
                    if pattern >> bit & 1 == 1 {
                        work.drives[k] = if work.ideal[k] == Drive::Second {
                            Drive::First
                        } else {
                            Drive::Second
                        };
                    }
                }
                let mut steps = Steps {
                    fixed: true,
                    ..Steps::default()
                };
                let end = self.iterate(tolerance, work, losses, passes, &mut steps);
                let agrees = |k: usize| {
                    let now = drive(work.rolling[k].at_point(0), work.largest.at_point(0));
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

/// The steps of one loop.
struct Steps<R: Points> {
    /// True if the driving gears are kept.
    fixed: bool,
    /// Where the losses at the start are close to the result, or their first change may be the last.
    near: R::Mask,
    /// True once the values of two iterations are known.
    known: bool,
    /// Points for which the iteration is the last one.
    last: R::Mask,
    /// Smallest mismatch so far, and the iterations since.
    least: f64,
    slow: usize,
    /// Share of a step that is taken.
    damping: f64,
}

impl<R: Points> Default for Steps<R> {
    fn default() -> Self {
        Self {
            fixed: false,
            near: R::mask(|_| false),
            known: false,
            last: R::mask(|_| false),
            least: f64::INFINITY,
            slow: 0,
            damping: 1.0,
        }
    }
}

impl<R: Points> Steps<R> {
    fn halve_without_progress(&mut self, mismatch: f64) {
        if mismatch < self.least {
            (self.least, self.slow) = (mismatch, 0);
            return;
        }
        self.slow += 1;
        if self.slow == PATIENCE {
            (self.damping, self.slow) = (0.5 * self.damping, 0);
        }
    }
}

/// How a loop ended.
enum End {
    /// Loads and losses agree at all points that have not left.
    Agreed,
    /// A driving gear changed too often, or the tried pattern has no equilibrium.
    Turning,
    /// Neither within the iteration limit.
    Open,
}

/// Evaluates the losses of the models at the present torques. Returns where all of them are finite.
pub(super) fn evaluate_losses<R: Points>(
    work: &mut Work<R>,
    losses: &mut impl FnMut(&mut FlowState<'_, R>),
) -> R::Mask {
    R::wide(
        #[inline(always)]
        || {
            // What belongs to converged points stays, so that their losses are those of the accepted torques.
            let done = work.done;
            let pairs = work.evaluated.iter_mut().zip(&work.multipliers);
            for (evaluated, now) in pairs.chain(work.evaluated_ports.iter_mut().zip(&work.ports)) {
                *evaluated = R::select(done, *evaluated, *now);
            }
        },
    );
    work.model_losses.fill(R::ZERO);
    work.answer.drags_mut().fill(R::ZERO);
    losses(&mut FlowState {
        speeds: &work.speeds,
        steady: &work.steady,
        multipliers: &work.evaluated,
        drives: &work.drives,
        ports: &work.evaluated_ports,
        live: &mut work.live,
        mesh_loss: &mut work.model_losses,
        drags: work.answer.drags_mut(),
    });
    R::wide(
        #[inline(always)]
        || {
            let mut sum = R::ZERO;
            for (k, loss) in work.model_losses.iter().enumerate() {
                work.answer.set_mesh(k, *loss, work.rolling[k].abs());
                sum += loss.abs();
            }
            for drag in work.answer.drags() {
                sum += drag.abs();
            }
            sum.is_below(R::constant(f64::INFINITY))
        },
    )
}

/// Lets the point with the largest power decide the driving gears.
fn lead<R: Points>(work: &mut Work<R>) {
    let live = (0..R::COUNT).filter(|point| work.live.at_point(*point));
    work.leading = live.fold(0, |most, point| {
        if work.largest.at_point(point) > work.largest.at_point(most) {
            point
        } else {
            most
        }
    });
}

/// Adopts the driving gears of the last solve as the leading point decides; true if one of them was assumed differently.
fn turn<R: Points>(work: &mut Work<R>) -> bool {
    let mut turned = false;
    if !work.live.at_point(work.leading) {
        // All points that are left agree so far.
        work.leading = (0..R::COUNT).find(|point| work.live.at_point(*point)).unwrap_or(0);
    }
    for k in 0..work.drives.len() {
        let before = work.drives[k];
        // The driving gear after the solve, and whether another one was assumed.
        let decide = |point: usize| {
            let now = drive(work.rolling[k].at_point(point), work.largest.at_point(point));
            if now == Drive::Neither || now == before {
                return (before, false);
            }
            let lost = work.used.share(k).at_point(point) > 0.0 || work.used.constant(k).at_point(point) > 0.0;
            (now, before != Drive::Neither || lost)
        };
        let decided = decide(work.leading);
        let agreed = R::mask(|point| decide(point) == decided);
        work.keep(agreed);
        let (now, wrong) = decided;
        if wrong && before != Drive::Neither {
            work.turned[k] += 1;
        }
        turned |= wrong;
        work.drives[k] = now;
    }
    turned
}

/// Expected error after one more plain step: the mismatch of each loss decreases as in the last step, or as all of them together,
/// whichever is slower. A loss that has just appeared gives no rate yet.
#[inline(always)]
fn remaining<R: Points>(work: &Work<R>) -> R {
    let (mut moved, mut followed) = (R::ZERO, R::ZERO);
    for &entry in &work.live_entries {
        let (own_moved, own_followed) = work.changes(entry);
        moved = moved.max(own_moved * work.weights[entry].abs());
        followed = followed.max(own_followed * work.weights[entry].abs());
    }
    let one = R::constant(1.0);
    let common = R::select(moved.is_above(R::ZERO), followed / moved, one);
    let mut most = R::ZERO;
    for &entry in &work.live_entries {
        let mismatch = work.difference(entry).abs();
        let (moved, followed) = work.changes(entry);
        let own = R::select(followed.is_below(moved), followed / moved, one);
        let falls = common.max(own);
        // The sum of all following steps, as a geometric series.
        let left = mismatch * falls / R::constant(1e-3).max(one - falls);
        most = R::select(mismatch.is_zero(), most, most.max(left));
    }
    most
}

/// Extrapolation factor towards the previous result that makes the mismatch along the last step vanish (Anderson 1965 with a depth
/// of one).
#[inline(always)]
fn secant<R: Points>(work: &Work<R>) -> R {
    let (mut product, mut square) = (R::ZERO, R::ZERO);
    for &entry in &work.live_entries {
        let now = work.difference(entry);
        let before = (work.answer_before.values[entry] - work.used_before.values[entry]) * work.weights[entry];
        product += now * (now - before);
        square += (now - before) * (now - before);
    }
    let back = (product / square).at_least(REACH.0).at_most(REACH.1);
    R::select(square.is_above(R::ZERO), back, R::ZERO)
}

fn drive(rolling: f64, largest: f64) -> Drive {
    if rolling.abs() <= NO_POWER * largest {
        Drive::Neither
    } else if rolling > 0.0 {
        Drive::First
    } else {
        Drive::Second
    }
}
