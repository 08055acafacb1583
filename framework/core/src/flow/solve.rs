//! Torques and losses of one point, or of several together, block after block.
//!
//! Points that are solved together have the driving gears in common. The leading point, that with the largest power, decides them;
//! points that would decide otherwise, and those that do not converge soon, leave and are solved alone. The operations of a point
//! are the same either way.

use super::equilibrium::{follow, follow_to_next};
use super::order::Block;
use super::system::Flow;
use super::work::{Drive, FlowState, Outcome, Start, Tolerance, Work};
use crate::real::{Mask as _, Points};

/// A driving gear that changes more often than this indicates a train that may be self-locking.
const TURNS: u8 = 4;
/// Meshes whose driving gear may be in doubt at once.
const MOST_DOUBTFUL: usize = 8;
/// Iterations without progress after which steps are halved.
const PATIENCE: usize = 10;
/// Iterations after which points that are solved together leave; up to here, no step is halved.
const TOGETHER: usize = PATIENCE - 2;

impl Flow {
    /// The power flow without losses, at the speeds and given torques of the work.
    pub fn ideal<R: Points>(&self, work: &mut Work<R>) {
        R::wide(
            #[inline(always)]
            || {
                self.prepare(work, false);
                self.lossless(work);
            },
        );
    }

    /// The power flow with losses that `losses` computes from the torques, at the speeds and given torques of the work. The torques
    /// are in equilibrium with the accepted losses, so the power balance holds to rounding for any tolerance.
    pub fn real<R: Points>(
        &self,
        tolerance: Tolerance<R>,
        start: Start,
        work: &mut Work<R>,
        mut losses: impl FnMut(&mut FlowState<'_, R>),
    ) -> Outcome {
        R::wide(
            #[inline(always)]
            || {
                self.prepare(work, true);
                match start {
                    Start::Lossless => self.lossless(work),
                    Start::Last => lead(work),
                }
            },
        );
        work.turned.fill(0);
        let mut way = Way {
            tolerance,
            start,
            fixed: false,
        };
        loop {
            match self.walk(&way, work, &mut losses) {
                End::Agreed => return converged(work),
                End::Open if self.mark_locked(work) => return self.search(way, work, &mut losses),
                End::Open => return Outcome::NoConvergence,
                // The friction just used was on the wrong gear, so this flow is invalid.
                End::Turned if work.turned.iter().all(|turned| *turned <= TURNS) => way.start = Start::Lossless,
                End::Turned => return self.search(way, work, &mut losses),
            }
        }
    }

    /// Finds torques and losses of all blocks for the present driving gears.
    fn walk<R: Points>(&self, way: &Way<R>, work: &mut Work<R>, losses: &mut impl FnMut(&mut FlowState<'_, R>)) -> End {
        let Some(order) = self.adopt_order(work) else {
            return End::Open;
        };
        work.mesh_loss.fill(R::ZERO);
        work.passes = R::constant(1.0);
        for block in &order.blocks {
            let end = if block.is_loop() {
                self.close(block, way, work, losses)
            } else {
                self.pass(block, way, work, losses)
            };
            if end != End::Agreed {
                return end;
            }
        }
        R::wide(
            #[inline(always)]
            || self.sum_up(work),
        );
        End::Agreed
    }

    /// A block without a loop: its torques follow from earlier ones, its losses from earlier torques.
    #[inline(always)]
    fn pass<R: Points>(
        &self,
        block: &Block,
        way: &Way<R>,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
    ) -> End {
        if !block.unknowns.is_empty() {
            let turned = R::wide(
                #[inline(always)]
                || {
                    self.balance(block, work);
                    self.turn(block, way.fixed, work)
                },
            );
            return if turned { End::Turned } else { End::Agreed };
        }
        if self.ask(block, work, losses) {
            End::Agreed
        } else {
            End::Open
        }
    }

    /// Evaluates the laws of a block at the present torques; points where a loss is not finite leave. False if a point that is solved
    /// alone has such a loss.
    fn ask<R: Points>(
        &self,
        block: &Block,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
    ) -> bool {
        work.evaluate(self, &block.laws, losses);
        let finite = R::wide(
            #[inline(always)]
            || self.take_answers(&block.laws, work),
        );
        work.keep(finite);
        R::COUNT > 1 || finite.all()
    }

    /// Iterates the torques and losses of a loop until they agree.
    fn close<R: Points>(
        &self,
        block: &Block,
        way: &Way<R>,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
    ) -> End {
        R::wide(
            #[inline(always)]
            || self.begin(block, way.start, work),
        );
        work.done = R::mask(|_| false);
        let mut pace = Pace::default();
        let most = if R::COUNT == 1 {
            way.tolerance.passes
        } else {
            way.tolerance.passes.min(TOGETHER)
        };
        for pass in 1..=most {
            let turned = R::wide(
                #[inline(always)]
                || self.turn(block, way.fixed, work),
            );
            if turned {
                return End::Turned;
            }
            if !self.ask(block, work, losses) {
                return End::Open;
            }
            let before = work.done;
            let (found, change) = R::wide(
                #[inline(always)]
                || {
                    follow(block, pass == 1, work);
                    let within = (power_of(block, work), way.tolerance.power);
                    self.approach(block, (pass == 1, pace.share), within, work)
                },
            );
            work.keep(found);
            if R::COUNT == 1 {
                if !found.all() {
                    return End::Open;
                }
                pace.halve_without_progress(change.at_point(0));
            }
            let passes = work.passes.max(R::constant(pass as f64));
            work.passes = R::select(work.done & !before, passes, work.passes);
            if (work.done | !work.live).all() {
                break;
            }
        }
        work.keep(work.done);
        if R::COUNT == 1 && !work.done.all() {
            return End::Open;
        }
        R::wide(
            #[inline(always)]
            || {
                follow_to_next(block, work);
                self.accept(block, work);
            },
        );
        End::Agreed
    }

    /// Adopts the driving gears of the meshes of a block as the leading point decides; true if one was assumed differently.
    #[inline(always)]
    fn turn<R: Points>(&self, block: &Block, fixed: bool, work: &mut Work<R>) -> bool {
        let mut turned = false;
        for &k in &block.rolling {
            self.roll(k, work);
            if fixed {
                continue;
            }
            if !work.live.at_point(work.leading) {
                // All points that are left agree so far.
                work.leading = (0..R::COUNT).find(|point| work.live.at_point(*point)).unwrap_or(0);
            }
            let before = work.drives[k];
            let decide = |point: usize| match Drive::of(work.rolling[k].at_point(point), work.largest.at_point(point)) {
                Drive::Neither => before,
                drive => drive,
            };
            let decided = decide(work.leading);
            let agreed = R::mask(|point| decide(point).driven() == decided.driven());
            work.keep(agreed);
            work.drives[k] = decided;
            if decided.driven() != before.driven() {
                turned = true;
                work.turned[k] += u8::from(before != Drive::Neither);
            }
        }
        turned
    }

    /// Marks the steep meshes that lose all of the power of their driving gear, whose torque then grows without bound; true if there are any.
    fn mark_locked<R: Points>(&self, work: &mut Work<R>) -> bool {
        let mut any = false;
        for (k, _) in self.meshes.iter().enumerate().filter(|(_, mesh)| mesh.steep) {
            let (loss, power) = (work.mesh_loss[k].at_point(0), work.rolling[k].at_point(0).abs());
            if R::COUNT == 1 && power > 0.0 && loss >= power {
                work.turned[k] = work.turned[k].max(1);
                any = true;
            }
        }
        any
    }

    /// Tries patterns of the meshes whose driving gear kept changing, in order of the number of changes to the ideal pattern.
    fn search<R: Points>(
        &self,
        way: Way<R>,
        work: &mut Work<R>,
        losses: &mut impl FnMut(&mut FlowState<'_, R>),
    ) -> Outcome {
        if R::COUNT > 1 {
            // Each point has its own pattern.
            work.live = R::mask(|_| false);
            return converged(work);
        }
        let mut doubtful = [0; MOST_DOUBTFUL];
        let count = work.doubtful().count();
        if count > MOST_DOUBTFUL {
            return Outcome::NoConvergence;
        }
        for (place, mesh) in doubtful.iter_mut().zip(work.doubtful()) {
            *place = mesh;
        }
        let doubtful = &doubtful[..count];
        self.lossless(work);
        work.ideal.copy_from_slice(&work.drives);
        let way = Way {
            start: Start::Lossless,
            fixed: true,
            ..way
        };
        for changes in 0..=doubtful.len() as u32 {
            for pattern in (0..1_u32 << doubtful.len()).filter(|p| p.count_ones() == changes) {
                work.drives.copy_from_slice(&work.ideal);
                for (bit, &k) in doubtful.iter().enumerate() {
                    if pattern >> bit & 1 == 1 {
                        work.drives[k] = if work.ideal[k] == Drive::Second {
                            Drive::First
                        } else {
                            Drive::Second
                        };
                    }
                }
                let end = self.walk(&way, work, losses);
                let agrees = |k: usize| {
                    let now = Drive::of(work.rolling[k].at_point(0), work.largest.at_point(0));
                    now == Drive::Neither || now.driven() == work.drives[k].driven()
                };
                if end == End::Agreed && (0..self.meshes.len()).all(agrees) {
                    return converged(work);
                }
            }
        }
        Outcome::SelfLocking
    }

    /// The power flow without the losses that depend on torques, and its driving gears.
    #[inline(always)]
    fn lossless<R: Points>(&self, work: &mut Work<R>) {
        for block in &self.lossless.blocks {
            self.balance(block, work);
        }
        self.powers(work);
        lead(work);
        for k in 0..self.meshes.len() {
            let drives = |point: usize| Drive::of(work.rolling[k].at_point(point), work.largest.at_point(point));
            let decided = drives(work.leading);
            let agreed = R::mask(|point| drives(point).driven() == decided.driven());
            work.drives[k] = decided;
            work.keep(agreed);
        }
    }
}

/// How torques and losses are found.
struct Way<R: Points> {
    tolerance: Tolerance<R>,
    start: Start,
    /// True if the driving gears are kept.
    fixed: bool,
}

/// Share of each step of a loop that is taken.
struct Pace {
    share: f64,
    /// Smallest change so far, and the iterations since.
    least: f64,
    slow: usize,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            share: 1.0,
            least: f64::INFINITY,
            slow: 0,
        }
    }
}

impl Pace {
    fn halve_without_progress(&mut self, change: f64) {
        if change < self.least {
            (self.least, self.slow) = (change, 0);
            return;
        }
        self.slow += 1;
        if self.slow == PATIENCE {
            (self.share, self.slow) = (0.5 * self.share, 0);
        }
    }
}

/// How a walk over blocks ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// Loads and losses agree at all points that have not left.
    Agreed,
    /// A gear drives that was assumed to be driven.
    Turned,
    /// A loop did not converge.
    Open,
}

/// The greatest power of the meshes and losses of a loop; that of the whole flow if it has no mesh. A branch that idles is as exact as those
/// that carry the power.
#[inline(always)]
fn power_of<R: Points>(block: &Block, work: &Work<R>) -> R {
    if block.rolling.is_empty() {
        return work.largest;
    }
    let rolling = block.rolling.iter().map(|mesh| work.rolling[*mesh].abs());
    let laws = block.feedback.iter().map(|feedback| feedback.law);
    let losses = laws.map(|law| work.answers[law].abs() * work.weights[law]);
    rolling.chain(losses).fold(R::ZERO, R::max)
}

fn converged<R: Points>(work: &Work<R>) -> Outcome {
    Outcome::Converged {
        passes: work.passes.at_point(0) as usize,
    }
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
