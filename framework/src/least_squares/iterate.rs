//! One run from one start to its end.

use nalgebra::{DMatrix, DVector};

use super::difference::{Differences, NoDerivative};
use super::evaluate::{Evaluator, Miss};
use super::fit::{Counts, Iteration, Reason};
use super::linear::Factors;
use super::options::{self, Options, Steps, Tolerances};
use super::robust::{Robust, Weighted};
use super::subproblem::{self, How, Model, Region};
use super::{optimality, second_order};

/// Least share of the expected fall with which a step is taken.
const ACCEPT: f64 = 1e-4;
/// Changes of the cost below so many times its noise say nothing.
const NOISY: f64 = 1e3;
/// How often a run trusts a Gauss-Newton step whose fall drowns in noise.
const TRUSTED: usize = 5;
/// Expected fall over the cost, from which on a step is worth a correction.
const WORTH: f64 = 1e-6;

/// A point with its residual.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub u: Vec<f64>,
    pub r: DVector<f64>,
}

/// How a run ended.
pub(super) struct End {
    pub point: Point,
    pub reason: Reason,
    /// Why, where the reason does not say all.
    pub detail: Option<String>,
    /// Derivatives by central differences at the point, where the run had them.
    pub jacobian: Option<DMatrix<f64>>,
    /// Free parameters whose columns were never anything but zero.
    pub unseen: Vec<bool>,
}

/// What all runs of a problem share.
pub(super) struct Context<'a> {
    pub evaluator: &'a Evaluator<'a>,
    pub options: &'a Options<'a>,
    pub robust: Robust,
    /// Relative noise of one call.
    pub noise: f64,
    /// Whether the noise leaves central differences no digits, so that one-sided ones end the run.
    pub noisy: bool,
}

/// What runs leave behind.
#[derive(Default)]
pub(super) struct Record {
    pub log: Vec<Iteration>,
    pub counts: Counts,
}

/// A run on its way.
struct Run<'a> {
    context: &'a Context<'a>,
    steps: Steps,
    attempt: usize,
    point: Point,
    central: bool,
    /// Column scales D.
    scale: DVector<f64>,
    radius: Option<f64>,
    trusted: usize,
    unseen: Vec<bool>,
}

/// The residuals as a linear model about a point.
struct Local {
    jacobian: DMatrix<f64>,
    weighted: Weighted,
    cost: f64,
    factors: Factors,
    first_order: f64,
    relative_offset: Option<f64>,
}

/// What a step that was tried says about going on.
enum Verdict {
    Again,
    Moved,
    /// The end, after a step that moved the point or not.
    Stop(Reason, bool),
}

/// Runs from a point, with derivatives that are counted in the record.
pub(super) fn run(context: &Context<'_>, start: Point, steps: Steps, attempt: usize, record: &mut Record) -> End {
    record.counts.runs += 1;
    let n = start.u.len();
    Run {
        context,
        steps,
        attempt,
        point: start,
        central: context.options.differences == options::Differences::Central,
        scale: DVector::zeros(n),
        radius: None,
        trusted: 0,
        unseen: vec![true; n],
    }
    .finish(record)
}

impl Run<'_> {
    fn finish(mut self, record: &mut Record) -> End {
        if self.point.u.is_empty() {
            return self.end(Reason::FirstOrder, None, None);
        }
        let begun = (record.counts.steps, self.context.evaluator.evaluations());
        let mut switched = false;
        loop {
            let differences = Differences {
                evaluator: self.context.evaluator,
                noise: self.context.noise,
                central: self.central,
            };
            let jacobian = match differences.jacobian(&self.point.u, &self.point.r) {
                Ok(jacobian) => jacobian,
                Err(NoDerivative::Interrupted) => return self.end(Reason::Interrupted, None, None),
                Err(NoDerivative::NotFinite(why)) => return self.end(Reason::DerivativeNotFinite, Some(why), None),
            };
            let local = self.local(jacobian);
            let mut stop = self.optimal(&local).map(|reason| (reason, false));
            if stop.is_none() {
                self.start_radius(switched);
                switched = false;
                stop = loop {
                    if record.counts.steps - begun.0 >= self.context.options.iterations {
                        return self.end(Reason::IterationLimit, None, Some(local));
                    }
                    if self.context.evaluator.evaluations() - begun.1 >= self.context.options.evaluations {
                        return self.end(Reason::EvaluationLimit, None, Some(local));
                    }
                    if self.context.evaluator.interrupted() {
                        return self.end(Reason::Interrupted, None, None);
                    }
                    match self.trial(&local, record) {
                        Verdict::Again => {}
                        Verdict::Moved => break None,
                        Verdict::Stop(reason, moved) => break Some((reason, moved)),
                    }
                };
            }
            match stop {
                None => {}
                // After a step, the derivatives are those of the point before.
                Some((reason, moved)) if self.ends(reason) => return self.end(reason, None, (!moved).then_some(local)),
                // Whatever stops a run with one-sided differences: central ones have the last word.
                Some(_) => {
                    self.central = true;
                    switched = true;
                }
            }
        }
    }

    /// Whether a stop ends the run.
    fn ends(&self, reason: Reason) -> bool {
        let last = self.context.options.differences == options::Differences::Forward || self.context.noisy;
        self.central || last || matches!(reason, Reason::ZeroResidual | Reason::Interrupted)
    }

    fn end(self, reason: Reason, detail: Option<String>, local: Option<Local>) -> End {
        End {
            point: self.point,
            reason,
            detail,
            jacobian: local.filter(|_| self.central).map(|local| local.jacobian),
            unseen: self.unseen,
        }
    }

    fn tolerances(&self) -> &Tolerances {
        if self.central {
            &self.context.options.central
        } else {
            &self.context.options.forward
        }
    }

    /// The linear model about the point; column scales follow.
    fn local(&mut self, jacobian: DMatrix<f64>) -> Local {
        let (context, space) = (self.context, self.context.evaluator.space);
        let weighted = context.robust.weighted(&self.point.r);
        let rows = weighted.rows(&jacobian);
        let mut columns = rows.clone();
        for (j, mut column) in columns.column_iter_mut().enumerate() {
            let norm = column.norm();
            if norm > 0.0 {
                self.unseen[j] = false;
            }
            let scale = (self.steps.memory * self.scale[j]).max(norm);
            self.scale[j] = if scale > 0.0 { scale } else { 1.0 / space.typical[j] };
            column /= self.scale[j];
        }
        let gradient = rows.tr_mul(&weighted.residual);
        let active = optimality::active(space, &self.point.u, &gradient);
        Local {
            cost: context.robust.cost(&self.point.r),
            factors: Factors::of(columns, &weighted.residual),
            first_order: optimality::first_order(space, &self.point.u, &rows, &weighted.residual),
            relative_offset: optimality::relative_offset(&rows, &weighted.residual, &active),
            jacobian,
            weighted,
        }
    }

    fn optimal(&self, local: &Local) -> Option<Reason> {
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

    /// Length in the scaled metric of a vector of coordinates.
    fn length(&self, of: impl Fn(usize) -> f64) -> f64 {
        DVector::from_fn(self.scale.len(), |j, _| self.scale[j] * of(j)).norm()
    }

    /// A first radius, and one to go on with where the last differences have shrunk it to nothing.
    fn start_radius(&mut self, switched: bool) {
        let typical = &self.context.evaluator.space.typical;
        let here = self.length(|j| self.point.u[j]);
        match self.radius {
            None => self.radius = Some(self.steps.radius * here.max(self.length(|j| typical[j]))),
            Some(radius) if switched && radius < 1e-6 * here => self.radius = Some(1e-2 * here),
            Some(_) => {}
        }
    }

    /// What a step may do: the ball, the bounds, and a greatest relative change of each coordinate.
    fn region(&self, radius: f64) -> Region {
        let (space, u) = (self.context.evaluator.space, &self.point.u);
        let farthest = |j: usize| self.steps.bound * self.scale[j] * u[j].abs().max(space.typical[j]);
        let n = u.len();
        Region {
            radius,
            lower: DVector::from_fn(n, |j, _| (self.scale[j] * (space.lower[j] - u[j])).max(-farthest(j))),
            upper: DVector::from_fn(n, |j, _| (self.scale[j] * (space.upper[j] - u[j])).min(farthest(j))),
        }
    }

    /// Where a scaled step leads; on a bound that it meets, exactly.
    fn target(&self, z: &DVector<f64>) -> Vec<f64> {
        let (space, u) = (self.context.evaluator.space, &self.point.u);
        let place = |j: usize| match z[j] {
            z if z <= self.scale[j] * (space.lower[j] - u[j]) => space.lower[j],
            z if z >= self.scale[j] * (space.upper[j] - u[j]) => space.upper[j],
            z => (u[j] + z / self.scale[j]).clamp(space.lower[j], space.upper[j]),
        };
        (0..u.len()).map(place).collect()
    }

    /// Half the second-order correction of a step, where it is worth a call and stays inside the bounds.
    fn correction(&self, local: &Local, region: &Region, z: &DVector<f64>) -> Result<Option<DVector<f64>>, Miss> {
        let p = DVector::from_fn(z.len(), |j, _| z[j] / self.scale[j]);
        let there = match self
            .context
            .evaluator
            .residual(&self.target(&(z * second_order::PROBE)))
        {
            Ok(there) => there,
            Err(Miss::Undefined(_)) => return Ok(None),
            Err(Miss::Interrupted) => return Err(Miss::Interrupted),
        };
        let mut bend = second_order::bend(&self.point.r, &there, &(&local.jacobian * p));
        if let Some(factors) = &local.weighted.factors {
            bend.component_mul_assign(factors);
        }
        let model = local.model();
        let half = second_order::correction(&model, region, z, &local.factors.project(bend));
        let space = self.context.evaluator.space;
        Ok(half.filter(|half| {
            (0..z.len()).all(|j| {
                let u = self.point.u[j] + (z[j] + half[j]) / self.scale[j];
                half[j] == 0.0 || (space.lower[j] <= u && u <= space.upper[j])
            })
        }))
    }

    /// Tries one step.
    fn trial(&mut self, local: &Local, record: &mut Record) -> Verdict {
        let (context, radius) = (self.context, self.radius.unwrap_or(0.0));
        let (model, region) = (local.model(), self.region(radius));
        let step = subproblem::step(&model, &region, context.options.subproblem);
        record.counts.steps += 1;
        record.counts.cone_solves += usize::from(step.cone);
        record.counts.cone_failures += usize::from(step.how == How::Fallback);
        let (predicted, slope) = (model.fall(&step.z), model.slope(&step.z));
        let mut z = step.z;
        let mut corrected = false;
        if self.steps.second_order && predicted > WORTH * local.cost {
            match self.correction(local, &region, &z) {
                Ok(None) => {}
                Ok(Some(half)) => {
                    z += half;
                    corrected = true;
                }
                Err(_) => return Verdict::Stop(Reason::Interrupted, false),
            }
        }
        let u = self.target(&z);
        // A step that promises nothing is not worth a call.
        let there = if predicted > 0.0 {
            match context.evaluator.residual(&u) {
                Ok(r) => Some(r),
                Err(Miss::Undefined(_)) => None,
                Err(Miss::Interrupted) => return Verdict::Stop(Reason::Interrupted, false),
            }
        } else {
            None
        };
        let actual = there
            .as_ref()
            .map_or(f64::NEG_INFINITY, |r| context.robust.fall(&self.point.r, r));
        let mut ratio = if predicted > 0.0 {
            actual / predicted
        } else {
            f64::NEG_INFINITY
        };
        let shortcut = step.how == How::Shortcut;
        let noise = NOISY * context.noise * local.cost;
        if ratio <= ACCEPT && predicted <= noise && actual >= -noise && shortcut && self.trusted < TRUSTED {
            self.trusted += 1;
            ratio = 1.0;
        }
        let accepted = ratio > ACCEPT;
        let length = z.norm();
        record.log.push(Iteration {
            attempt: self.attempt,
            cost: local.cost,
            first_order: local.first_order,
            relative_offset: local.relative_offset,
            central: self.central,
            how: step.how,
            corrected,
            radius,
            length,
            predicted,
            actual,
            accepted,
        });
        self.radius = Some(if ratio < 0.25 {
            let cut = if actual.is_finite() && actual < 0.0 {
                (slope / (2.0 * (slope - actual))).clamp(0.1, 0.5)
            } else {
                0.25
            };
            cut * length.min(radius)
        } else if ratio > 0.75 && shortcut {
            radius.max(2.0 * length)
        } else if ratio > 0.75 && length >= 0.99 * radius {
            2.0 * radius
        } else {
            radius
        });
        let change = self.change(&u);
        let verdict = self.stop(local.cost, predicted, actual, ratio, change, accepted);
        if let Some(r) = there.filter(|_| accepted) {
            self.point = Point { u, r };
        }
        match verdict {
            Some(reason) => Verdict::Stop(reason, accepted),
            None if accepted => Verdict::Moved,
            None => Verdict::Again,
        }
    }

    /// Greatest relative change of a coordinate.
    fn change(&self, u: &[f64]) -> f64 {
        let space = self.context.evaluator.space;
        let change = |j: usize| (u[j] - self.point.u[j]).abs() / space.size(j, self.point.u[j]);
        (0..u.len()).map(change).fold(0.0, f64::max)
    }

    /// Tests after a step.
    fn stop(&self, cost: f64, predicted: f64, actual: f64, ratio: f64, change: f64, accepted: bool) -> Option<Reason> {
        let tolerances = self.tolerances();
        // Of a step that was not taken, smallness says nothing about a minimum, unless what it promised drowns in noise.
        let drowned = predicted <= NOISY * self.context.noise * cost;
        if change <= tolerances.step && (accepted || drowned) {
            return Some(Reason::Step);
        }
        let flat = actual.abs() <= tolerances.cost * cost && predicted <= tolerances.cost * cost && ratio <= 2.0;
        let near = change <= 1e3 * tolerances.step || predicted <= 0.01 * f64::EPSILON * cost || !accepted;
        if flat && near {
            return Some(Reason::Cost);
        }
        let space = self.context.evaluator.space;
        let least = 1e-15 * self.length(|j| space.size(j, self.point.u[j]));
        (!accepted && self.radius.is_some_and(|radius| radius <= least)).then_some(Reason::Radius)
    }
}

impl Local {
    fn model(&self) -> Model<'_> {
        Model {
            r: &self.factors.r,
            q: &self.factors.q,
        }
    }
}
