//! Completion of a search that makes no progress with short differences.

use super::context::{Context, Point};
use super::evaluate::Evaluator;
use super::fault::Fault;
use super::fit::{Fit, Reason};
use super::iterate::{End, Record};
use super::kink::kinks;
use super::options::{Noise, Options};
use super::polish::polish;
use super::problem::Problem;
use super::space::Space;

/// Remaining shift in standard errors above which a search with small steps is completed without derivatives. \[-\]
const LEFT: f64 = 0.02;

/// Whether a search ended where derivatives predict a decrease that no step achieves.
pub(super) fn is_stuck(fit: &Fit) -> bool {
    let left = fit.log.last().and_then(|step| step.relative_offset);
    match fit.reason {
        Reason::Radius => true,
        Reason::Step | Reason::Cost => left.is_some_and(|left| left > LEFT),
        _ => false,
    }
}

/// Completes a search without derivatives, from its end or from other coordinates, and finds the kinks at its minimum.
///
/// # Errors
/// If there are no residuals at the other coordinates.
pub(super) fn finish(
    problem: &Problem<'_>,
    options: &Options<'_>,
    space: &Space<'_>,
    fit: Fit,
    from: Option<&[f64]>,
) -> Result<Fit, Fault> {
    let Some(derivative) = &fit.derivative else {
        return Ok(fit);
    };
    let u: Vec<f64> = match from {
        Some(u) => u.to_vec(),
        None => space.free.iter().map(|i| fit.u[*i]).collect(),
    };
    let start = space.starting(&u);
    let (evaluator, r) = Evaluator::start(problem, &start, options.interrupt)?;
    let noise = match options.noise {
        Noise::Known(noise) => noise.max(f64::EPSILON),
        Noise::Rounding | Noise::Estimated => f64::EPSILON,
    };
    let context = Context::new(&evaluator, options, fit.loss_scale, noise);
    let jacobian = derivative.jacobian.select_columns(&space.free);
    let mut end = End {
        point: Point { u, r },
        reason: Reason::Interrupted,
        detail: None,
        jacobian: None,
        unseen: space.free.iter().map(|i| derivative.unseen[*i]).collect(),
    };
    let mut held = Vec::new();
    if let Ok(polished) = polish(&context, end.point.clone(), &jacobian) {
        end.point = polished.point;
        end.reason = if polished.settled {
            Reason::Pattern
        } else {
            Reason::EvaluationLimit
        };
        context.derive(&mut end);
        let found = end
            .jacobian
            .as_ref()
            .map(|jacobian| kinks(&context, &end.point, jacobian));
        match found {
            Some(Ok(found)) => held = found,
            Some(Err(_)) => end.reason = Reason::Interrupted,
            None => {}
        }
    }
    let mut record = Record {
        log: fit.log,
        counts: fit.counts,
    };
    record.counts.polishing += evaluator.evaluations();
    let mut finished = context.fit(end, fit.attempt, record, (Vec::new(), held));
    finished.counts.evaluations += fit.counts.evaluations;
    finished.counts.undefined += fit.counts.undefined;
    finished.notes = fit.notes;
    Ok(finished)
}
