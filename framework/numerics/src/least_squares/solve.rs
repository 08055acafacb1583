//! Solution of a problem: attempts and the status of their ends.

use nalgebra::{DMatrix, DVector};

use super::context::{Context, Point};
use super::difference::Differences;
use super::evaluate::{Evaluator, Miss};
use super::fault::{Fault, Finding};
use super::finish::{finish, is_stuck};
use super::fit::{Derivative, Fit, Kink, Reason, Status};
use super::iterate::{self, End, Record};
use super::options::{Noise, Options, Steps};
use super::problem::Problem;
use super::robust::{Loss, Robust};
use super::space::Space;
use super::{linear, noise, optimality};

/// Independence of the columns below which a fit is singular. \[-\]
pub const SINGULAR: f64 = 1e-9;
/// Noise above which central differences are no more accurate than one-sided ones.
const NOISIEST: f64 = 1e-6;
/// Relative difference of costs that are equal.
const EQUAL: f64 = 1e-9;
/// Share of calls without value above which there is a note.
const UNDEFINED: f64 = 0.1;
/// Share of failed cone programs above which there is a note.
const FAILURES: f64 = 0.2;

/// Finds a minimum of the cost of a problem near the start.
///
/// # Errors
/// If the problem is invalid; all its errors. Failures of the search are not errors: the fit reports status and reason.
pub fn solve(problem: &Problem<'_>, options: &Options<'_>) -> Result<Fit, Fault> {
    let space = Space::from_parameters(problem.parameters())?;
    let fit = search(problem, options, &space)?;
    if options.polish && is_stuck(&fit) {
        return finish(problem, options, &space, fit, None);
    }
    Ok(fit)
}

/// As [`solve`], from the start of a space, without completion.
pub(super) fn search(problem: &Problem<'_>, options: &Options<'_>, space: &Space<'_>) -> Result<Fit, Fault> {
    options.check()?;
    let (evaluator, r) = Evaluator::start(problem, space, options.interrupt)?;
    let shape = (evaluator.rows, space.parameters.len());
    if let Some(known) = options.known.filter(|known| known.jacobian.shape() != shape) {
        let (rows, columns) = known.jacobian.shape();
        let message = format!(
            "{rows} rows and {columns} columns for {} rows of data and {} parameters",
            shape.0, shape.1
        );
        return Err(Finding::new("option known", message, "give a row for each residual without priors").into());
    }
    let start = Point {
        u: space.start.clone(),
        r,
    };
    let mut notes = space.notes.clone();
    let noise = match options.noise {
        Noise::Rounding => f64::EPSILON,
        Noise::Known(noise) => noise.max(f64::EPSILON),
        Noise::Estimated => match noise::estimate(&evaluator, &start.u, &start.r) {
            Ok(noise) => noise,
            Err(Miss::Interrupted) => f64::EPSILON,
            Err(Miss::Undefined(message)) => {
                let help = "state their noise, or use another start";
                return Err(Finding::new("residuals near the start", message, help).into());
            }
        },
    };
    if noise > NOISIEST {
        notes.push(format!(
            "residuals are noisy (relative noise {noise:.1e}): the search ends with one-sided differences"
        ));
    }
    let mut context = Context::new(&evaluator, options, options.loss_scale, noise);
    let mut record = Record::default();
    let (end, attempt) = robust_attempts(&mut context, start, &mut record);
    Ok(context.fit(end, attempt, record, (notes, Vec::new())))
}

/// All attempts, started from a soft_l1 fit if the loss has additional minima or its scale is unknown.
fn robust_attempts(context: &mut Context<'_>, mut start: Point, record: &mut Record) -> (End, usize) {
    let loss = context.robust.loss;
    let estimate = context.options.estimate_spread && loss != Loss::Linear;
    if estimate || matches!(loss, Loss::Cauchy | Loss::Arctan) {
        context.robust.loss = Loss::SoftL1;
        if estimate {
            context.robust.scale = context.options.loss_scale * context.robust.spread(&start.r);
        }
        let (end, attempt) = attempts(context, start, record);
        context.robust.loss = loss;
        if end.reason == Reason::Interrupted {
            return (end, attempt);
        }
        if estimate {
            // Constant from here: a changing scale would invalidate the test of the cost.
            context.robust.scale = context.options.loss_scale * context.robust.spread(&end.point.r);
        }
        start = end.point;
    }
    attempts(context, start, record)
}

/// Attempts with other steps until one succeeds; the best attempt with its number.
fn attempts(context: &Context<'_>, start: Point, record: &mut Record) -> (End, usize) {
    let first = context.options.steps;
    let tries = [
        first,
        Steps { radius: 0.3, ..first },
        Steps {
            radius: 100.0,
            bound: 2.0,
            ..first
        },
        Steps {
            radius: 1.0,
            bound: 10.0,
            memory: 1.0,
            second_order: false,
        },
    ];
    let attempt = |i: usize, record: &mut Record| {
        let mut end = iterate::run(context, start.clone(), tries[i], i + 1, record);
        context.derive(&mut end);
        let clean = context.status(&end) == Status::Converged;
        (end, clean)
    };
    let (mut best, mut clean) = attempt(0, record);
    let mut number = 1;
    for i in 1..tries.len() {
        if clean || best.reason == Reason::Interrupted || !context.options.attempts {
            break;
        }
        let (end, well) = attempt(i, record);
        let [new, old] = [&end, &best].map(|end| context.robust.cost(&end.point.r));
        let equal = (new - old).abs() <= EQUAL * old;
        let reason = end.reason;
        if (equal && well) || (!equal && new < old) {
            (best, clean, number) = (end, well, i + 1);
        } else if reason == Reason::Interrupted {
            // The best point so far after an interruption.
            best.reason = reason;
        }
        if well {
            break;
        }
    }
    (best, number)
}

impl<'a> Context<'a> {
    /// With a relative noise of calls.
    pub(super) fn new(evaluator: &'a Evaluator<'a>, options: &'a Options<'a>, loss_scale: f64, noise: f64) -> Self {
        Self {
            evaluator,
            options,
            robust: Robust {
                loss: options.loss,
                scale: loss_scale,
                rows: evaluator.rows,
            },
            noise,
            rough: noise.max(options.jumps),
            noisy: noise > NOISIEST,
        }
    }
}

impl Context<'_> {
    /// Central derivatives at an end without derivatives.
    pub(super) fn derive(&self, end: &mut End) {
        let (u, r) = (&end.point.u, &end.point.r);
        if end.jacobian.is_none() && end.reason != Reason::Interrupted {
            let differences = Differences {
                evaluator: self.evaluator,
                noise: self.rough,
                central: true,
            };
            end.jacobian = differences.jacobian(u, r).ok();
        }
    }

    /// Gradient and independent share of the columns at an end.
    fn measures(&self, end: &End, jacobian: &DMatrix<f64>) -> (DVector<f64>, f64) {
        let gradient = jacobian.tr_mul(&self.robust.slope(&end.point.r));
        let active = optimality::active(self.evaluator.space, &end.point.u, &gradient);
        let weighted = self.robust.weighted(&end.point.r);
        let rows = weighted.rows(jacobian);
        // A parameter that never had an effect is reported by name; one that lost its effect on the way makes the end singular.
        let mut free = optimality::unheld(&rows, &weighted.residual, &active);
        free.retain(|j| !end.unseen[*j]);
        let independence = linear::independence(&linear::columns(&rows, &free));
        (gradient, independence)
    }

    fn status(&self, end: &End) -> Status {
        match (&end.jacobian, end.reason) {
            (_, Reason::Interrupted) => Status::Interrupted,
            (_, Reason::ZeroResidual) if end.point.u.is_empty() => Status::Converged,
            (Some(jacobian), reason) if reason.is_convergence() => {
                if self.measures(end, jacobian).1 < SINGULAR {
                    Status::Singular
                } else {
                    Status::Converged
                }
            }
            _ => Status::Failed,
        }
    }

    /// The fit at an end.
    pub(super) fn fit(
        &self,
        end: End,
        attempt: usize,
        record: Record,
        (mut notes, kinks): (Vec<String>, Vec<Kink>),
    ) -> Fit {
        let space = self.evaluator.space;
        let all = space.parameters.len();
        let status = self.status(&end);
        let mut active = vec![None; all];
        let derivative = end.jacobian.as_ref().map(|jacobian| {
            let (slope, independence) = self.measures(&end, jacobian);
            let sides = optimality::active(space, &end.point.u, &slope);
            let mut whole = DMatrix::zeros(jacobian.nrows(), all);
            let (mut gradient, mut unseen) = (vec![0.0; all], vec![false; all]);
            for (j, i) in space.free.iter().enumerate() {
                whole.set_column(*i, &jacobian.column(j));
                gradient[*i] = slope[j];
                unseen[*i] = end.unseen[j];
                active[*i] = sides[j];
            }
            Derivative {
                jacobian: whole,
                gradient,
                independence,
                unseen,
            }
        });
        for (j, _) in end.unseen.iter().enumerate().filter(|(_, unseen)| **unseen) {
            notes.push(format!("`{}` has no effect on any residual", space.name(j)));
        }
        notes.extend(end.detail);
        let mut counts = record.counts;
        counts.evaluations = self.evaluator.evaluations();
        counts.undefined = self.evaluator.undefined();
        if counts.undefined as f64 > UNDEFINED * counts.evaluations as f64 {
            let (bad, of) = (counts.undefined, counts.evaluations);
            notes.push(format!("residuals had no value in {bad} of {of} calls"));
        }
        if counts.cone_failures as f64 > FAILURES * counts.steps as f64 {
            let (bad, of) = (counts.cone_failures, counts.steps);
            notes.push(format!("the cone program failed in {bad} of {of} steps"));
        }
        Fit {
            theta: space.theta(&end.point.u),
            u: space.all_coordinates(&end.point.u),
            cost: self.robust.cost(&end.point.r),
            residuals: end.point.r.iter().copied().collect(),
            rows: self.evaluator.rows,
            derivative,
            active,
            fixed: (0..all).map(|i| !space.free.contains(&i)).collect(),
            status,
            reason: end.reason,
            attempt,
            loss_scale: self.robust.scale,
            log: record.log,
            counts,
            kinks,
            notes,
        }
    }
}
