//! One model alone: without a gearbox, on a part and a context that the caller gives.

use std::cell::Cell;
use std::sync::Arc;

use serde_json::{Map, Value};

use crate::document::{Diagnostic, did_you_mean};
use crate::loss::{Extent, Limit, Notes, Observed, Step, Trace};
use crate::mechanism::{Answer, Mechanism};
use crate::registry::{Build, Files, Registry, from_resolved};

/// What a model answered.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// The named values of the answer; watts for a loss.
    pub values: Vec<(&'static str, f64)>,
    /// Their sum.
    pub total: f64,
    /// Moment about the relative speed for a loss, N m; the coefficient otherwise.
    pub moment: Option<f64>,
    /// Observed quantities with the path of their model.
    pub observed: Vec<(String, Observed, Extent)>,
    /// Limits with the path of their model.
    pub limits: Vec<(String, Limit, Extent)>,
    /// Every step of the formula, with the path of the model that took it.
    pub steps: Vec<(String, Step)>,
}

/// Evaluates a model of a mechanism on a part, at the usual context with the given quantities changed; all values SI.
///
/// # Errors
/// If part or model cannot be built, a quantity is unknown, or the formula has no value there.
pub fn eval<M: Mechanism>(
    registry: &Registry,
    files: &Files,
    model: &Value,
    part: &Value,
    inputs: &Map<String, Value>,
) -> Result<Evaluated, Diagnostic> {
    let part: Arc<M::Part> = Arc::new(from_resolved(part).map_err(|e| Diagnostic::error("part", e.to_string()))?);
    let mut build = Build::new(registry, files);
    let slot = build.slot_at::<M>("model", &part, model)?;
    let (instances, cells) = build.finish();
    let mut extents = vec![Extent::EMPTY; cells];
    let trace = Trace::default();
    let (answer, speed) = {
        let cells = Cell::from_mut(extents.as_mut_slice()).as_slice_of_cells();
        let mut at = M::usual(&part, Notes::new(cells, slot.notes).traced(&trace));
        for (name, value) in inputs {
            let Some(quantity) = M::QUANTITIES.iter().find(|q| q.name == name) else {
                let error = Diagnostic::error(
                    format!("at.{name}"),
                    format!("the context of {} has no quantity `{name}`", M::KEY),
                );
                return Err(match did_you_mean(name, M::QUANTITIES.iter().map(|q| q.name)) {
                    Some(close) => error.mend(format!("write `{close}`")),
                    None => error,
                });
            };
            (quantity.set)(&mut at, value.as_f64().unwrap_or(f64::NAN));
        }
        (M::answer(&slot, &at), M::speed(&at))
    };
    let answer = answer.map_err(|undefined| Diagnostic::error("model", undefined.to_string()))?;
    let terms = instances.first().map_or(&[][..], |i| i.entry.terms);
    let mut evaluated = Evaluated {
        values: answer.values(terms, speed),
        total: answer.total(speed),
        moment: answer.moment(speed),
        observed: Vec::new(),
        limits: Vec::new(),
        steps: trace
            .into_steps()
            .into_iter()
            .map(|step| (instances[step.instance()].path.clone(), step))
            .collect(),
    };
    for instance in &instances {
        let path = |i: usize| (instance.path.clone(), i);
        for (i, limit) in instance.entry.limits.iter().enumerate() {
            let (path, i) = path(i);
            evaluated
                .limits
                .push((path, *limit, extents[instance.notes.limits + i]));
        }
        for (i, observed) in instance.entry.observed.iter().enumerate() {
            let (path, i) = path(i);
            evaluated
                .observed
                .push((path, *observed, extents[instance.notes.observed + i]));
        }
    }
    Ok(evaluated)
}
