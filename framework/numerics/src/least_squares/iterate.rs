//! One run from one start to its end.

use nalgebra::{DMatrix, DVector};

use super::context::{Context, Point};
use super::difference::{Differences, NoDerivative};
use super::evaluate::Miss;
use super::fit::{Counts, How, Iteration, Reason};
use super::linearised::Linearised;
use super::noise::CostNoise;
use super::options::{self, Steps, Tolerances};
use super::subproblem;
use super::trial::{Here, Trial};

/// Maximum number of accepted Gauss-Newton steps whose decrease is below the noise.
const TRUSTED: usize = 5;
/// Minimum expected relative decrease for a second-order correction.
const WORTH: f64 = 1e-6;

/// How a run ended.
pub(super) struct End {
    pub point: Point,
    pub reason: Reason,
    /// Details of the reason.
    pub detail: Option<String>,
    /// Derivatives by central differences at the point, if computed.
    pub jacobian: Option<DMatrix<f64>>,
    /// Free parameters whose columns were always zero.
    pub unseen: Vec<bool>,
}

/// Record of the runs.
#[derive(Default)]
pub(super) struct Record {
    pub log: Vec<Iteration>,
    pub counts: Counts,
}

/// State of a run.
struct Run<'a> {
    context: &'a Context<'a>,
    steps: Steps,
    attempt: usize,
    point: Point,
    central: bool,
    /// Column scales D.
    scale: DVector<f64>,
    radius: Option<f64>,
    /// Accepted Gauss-Newton steps whose decrease is below the noise.
    trusted: usize,
    noise: CostNoise,
    unseen: Vec<bool>,
    /// Derivatives at the point that are not from differences.
    known: Option<DMatrix<f64>>,
    /// Whether the run may end with them.
    trusts: bool,
}

/// Consequence of a trial step.
enum Verdict {
    Again,
    Moved,
    /// The end, after a step that moved the point or not.
    Stop(Reason, bool),
}

/// Runs from a point until a test is met; records steps and work.
pub(super) fn run(context: &Context<'_>, start: Point, steps: Steps, attempt: usize, record: &mut Record) -> End {
    record.counts.runs += 1;
    let n = start.u.len();
    let run = Run {
        context,
        steps,
        attempt,
        point: start,
        central: context.options.differences == options::Differences::Central,
        scale: DVector::zeros(n),
        radius: None,
        trusted: 0,
        noise: CostNoise::stated(context.noise),
        unseen: vec![true; n],
        known: known(context),
        trusts: context.options.known.is_some_and(|known| known.sufficient),
    };
    run.finish(record)
}

/// The known derivatives by the free parameters, with the rows of priors.
fn known(context: &Context<'_>) -> Option<DMatrix<f64>> {
    let (evaluator, space) = (context.evaluator, context.evaluator.space);
    let known = context.options.known?.jacobian;
    let priors: Vec<(usize, f64)> = space.slopes_of_priors().collect();
    let mut jacobian = known
        .select_columns(&space.free)
        .resize_vertically(evaluator.rows + priors.len(), 0.0);
    for (row, (j, slope)) in priors.into_iter().enumerate() {
        jacobian[(evaluator.rows + row, j)] = slope;
    }
    Some(jacobian)
}

impl Run<'_> {
    fn finish(mut self, record: &mut Record) -> End {
        let (context, evaluator) = (self.context, self.context.evaluator);
        if self.point.u.is_empty() {
            return self.end(Reason::FirstOrder, None, None);
        }
        let limits = (
            record.counts.steps + context.options.iterations,
            evaluator.evaluations() + context.options.evaluations,
        );
        let mut switched = false;
        loop {
            let known = self.known.take();
            let by_differences = known.is_none();
            let jacobian = match known.map_or_else(|| self.differences(), Ok) {
                Ok(jacobian) => jacobian,
                Err(NoDerivative::Interrupted) => return self.end(Reason::Interrupted, None, None),
                Err(NoDerivative::NotFinite(why)) => return self.end(Reason::DerivativeNotFinite, Some(why), None),
            };
            self.trusts |= by_differences;
            for (unseen, column) in self.unseen.iter_mut().zip(jacobian.column_iter()) {
                *unseen &= column.norm() == 0.0;
            }
            let (space, memory) = (evaluator.space, self.steps.memory);
            let local = Linearised::about(&self.point, jacobian, &context.robust, space, &mut self.scale, memory);
            let mut stop = self.optimal(&local).map(|reason| (reason, false));
            if stop.is_some() && !self.trusts {
                continue;
            }
            if stop.is_none() {
                self.start_radius(&local, switched);
                switched = false;
                stop = loop {
                    if record.counts.steps >= limits.0 {
                        return self.end(Reason::IterationLimit, None, Some(local));
                    }
                    if evaluator.evaluations() >= limits.1 {
                        return self.end(Reason::EvaluationLimit, None, Some(local));
                    }
                    let (before, radius) = (self.point.clone(), self.radius);
                    let verdict = self.trial(&local, record);
                    let moved = matches!(verdict, Ok(Verdict::Moved | Verdict::Stop(_, true)));
                    if moved && context.options.known.is_some() {
                        self.known = Some(self.corrected(&local.jacobian, &before));
                    }
                    match verdict {
                        // Derivatives by differences come before a smaller ball.
                        Ok(Verdict::Again | Verdict::Stop(_, false)) if !by_differences => {
                            self.radius = radius;
                            break None;
                        }
                        Ok(Verdict::Again) => {}
                        Ok(Verdict::Moved) => break None,
                        Ok(Verdict::Stop(_, true)) if !self.trusts => break None,
                        Ok(Verdict::Stop(reason, moved)) => break Some((reason, moved)),
                        Err(_) => break Some((Reason::Interrupted, false)),
                    }
                };
            }
            match stop {
                None => {}
                // After a step the derivatives belong to the previous point.
                Some((reason, moved)) if self.ends(reason) => return self.end(reason, None, (!moved).then_some(local)),
                // A run that stops with one-sided differences continues with central ones.
                Some(_) => {
                    self.central = true;
                    switched = true;
                }
            }
        }
    }

    /// Whether a stop ends the run.
    fn ends(&self, reason: Reason) -> bool {
        let options = self.context.options;
        let forward = options.differences == options::Differences::Forward || options.known.is_some();
        let last = forward || self.context.noisy;
        self.central || last || matches!(reason, Reason::ZeroResidual | Reason::Interrupted)
    }

    fn end(self, reason: Reason, detail: Option<String>, local: Option<Linearised<'_>>) -> End {
        End {
            point: self.point,
            reason,
            detail,
            jacobian: match local {
                Some(local) if self.central || self.context.options.known.is_some() => Some(local.jacobian),
                _ => self.known,
            },
            unseen: self.unseen,
        }
    }

    /// Derivatives by differences at the point.
    fn differences(&self) -> Result<DMatrix<f64>, NoDerivative> {
        let differences = Differences {
            evaluator: self.context.evaluator,
            noise: self.context.rough,
            central: self.central,
        };
        differences.jacobian(&self.point.u, &self.point.r)
    }

    /// The derivatives at another point, corrected by the residuals on the way from there: the smallest change in the metric of the
    /// column norms with which they give the change of the residuals.
    fn corrected(&self, jacobian: &DMatrix<f64>, before: &Point) -> DMatrix<f64> {
        let n = before.u.len();
        let step = DVector::from_fn(n, |j, _| self.point.u[j] - before.u[j]);
        let metric = DVector::from_fn(n, |j, _| self.scale[j] * self.scale[j] * step[j]);
        let length = metric.dot(&step);
        let miss = &self.point.r - &before.r - jacobian * &step;
        let corrected = jacobian + miss * (metric / length).transpose();
        if corrected.iter().all(|x| x.is_finite()) {
            corrected
        } else {
            jacobian.clone()
        }
    }

    fn tolerances(&self) -> &Tolerances {
        if self.central {
            &self.context.options.central
        } else {
            &self.context.options.forward
        }
    }

    /// Tests of a point.
    fn optimal(&self, local: &Linearised<'_>) -> Option<Reason> {
        let tolerances = self.tolerances();
        if local.cost == 0.0 {
            Some(Reason::ZeroResidual)
        } else if local.first_order <= tolerances.first_order {
            Some(Reason::FirstOrder)
        } else if local
            .relative_offset
            .is_some_and(|offset| offset <= tolerances.relative_offset)
        {
            Some(Reason::RelativeOffset)
        } else {
            None
        }
    }

    /// The first radius, or a new one if the last differences have reduced it to zero.
    fn start_radius(&mut self, local: &Linearised<'_>, switched: bool) {
        let typical = &self.context.evaluator.space.typical;
        let here = local.length(|j| self.point.u[j]);
        match self.radius {
            None => self.radius = Some(self.steps.radius * here.max(local.length(|j| typical[j]))),
            Some(radius) if switched && radius < 1e-6 * here => self.radius = Some(1e-2 * here),
            Some(_) => {}
        }
    }

    /// Tries one step. The only error is an interruption.
    fn trial(&mut self, local: &Linearised<'_>, record: &mut Record) -> Result<Verdict, Miss> {
        let (context, radius) = (self.context, self.radius.unwrap_or(0.0));
        let (model, region) = (local.model(), local.region(radius, self.steps.bound));
        let step = subproblem::step(&model, &region, context.options.subproblem);
        record.counts.steps += 1;
        record.counts.cone_solves += usize::from(step.cone);
        record.counts.cone_failures += usize::from(step.how == How::Fallback);
        let (predicted, slope) = (model.fall(&step.z), model.slope(&step.z));
        let mut z = step.z;
        let mut corrected = false;
        if self.steps.second_order
            && predicted > WORTH * local.cost
            && let Some(half) = local.correction(context.evaluator, &region, &z)?
        {
            z += half;
            corrected = true;
        }
        let u = local.target(&z);
        // A step without expected decrease is not evaluated.
        let promising = predicted > 0.0;
        let there = if promising {
            context.evaluator.try_residual(&u)?
        } else {
            None
        };
        let fall = |r: &DVector<f64>| context.robust.fall(&self.point.r, r);
        let actual = there.as_ref().map_or(f64::NEG_INFINITY, fall);
        let mut trial = Trial {
            predicted,
            slope,
            actual,
            ratio: if promising {
                actual / predicted
            } else {
                f64::NEG_INFINITY
            },
            length: z.norm(),
            change: local.change(&u),
            shortcut: step.how == How::Shortcut,
        };
        let here = Here {
            evaluator: context.evaluator,
            local,
            u: &self.point.u,
            r: &self.point.r,
            tolerances: *self.tolerances(),
        };
        if self.trusted < TRUSTED && trial.drowns(here, &mut self.noise)? {
            self.trusted += 1;
            trial.ratio = 1.0;
        }
        let (next, accepted) = (trial.radius(radius), trial.accepted());
        self.radius = Some(next);
        let stop = trial.stop(here, &mut self.noise, next, self.steps.bound)?;
        record.log.push(Iteration {
            attempt: self.attempt,
            cost: local.cost,
            first_order: local.first_order,
            relative_offset: local.relative_offset,
            central: self.central,
            how: step.how,
            corrected,
            radius,
            length: trial.length,
            predicted,
            actual,
            accepted,
        });
        if let Some(r) = there.filter(|_| accepted) {
            self.point = Point { u, r };
        }
        Ok(match stop {
            Some(reason) => Verdict::Stop(reason, accepted),
            None if accepted => Verdict::Moved,
            None => Verdict::Again,
        })
    }
}
