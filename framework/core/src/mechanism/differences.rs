//! Derivatives of models whose law is not written over [`Real`](crate::real::Real): differences along each direction in which the
//! quantities of a context change.

use super::tooth_friction::{Along, PathAt, ToothFriction, ToothFrictionModel};
use super::{Answer, Inputs as _, Mechanism};
use crate::loss::{Notes, Undefined};
use crate::real::{DIRECTIONS, Dual, Stencil};

/// Noted as a branch by each model whose derivatives are found here.
pub(crate) const BY_DIFFERENCES: &str = "derivatives by differences";

/// Step over the size of the quantity that changes most. Where the model is smooth, the error of a derivative is about 1e-12.
const STEP: f64 = 4e-4;

/// Least size of a quantity over its usual value: less is a rounding residue of zero.
const LEAST: f64 = 1e-6;

/// Size of temperatures, whose zero has no meaning. \[K\]
const TEMPERATURES: f64 = 30.0;

/// The result of a model with derivatives by differences.
///
/// # Errors
/// If the model is undefined there or close to it.
pub(crate) fn answer<M: Mechanism>(
    model: &M::Model,
    at: &M::At<'_, Dual>,
) -> Result<<M::Answer as Answer>::Of<Dual>, Undefined> {
    let answer = M::answer(model, &at.map(Notes::MUTED, |x| x.value))?;
    let mut stencils: [Option<Stencil<M::Answer>>; DIRECTIONS] = [None; DIRECTIONS];
    for (direction, stencil) in stencils.iter_mut().enumerate() {
        let Some(step) = step::<M>(at, direction) else { continue };
        *stencil = Some(Stencil::new(step, |s| {
            M::answer(model, &at.map(Notes::MUTED, moved(direction, s)))
        })?);
    }
    if stencils.iter().any(Option::is_some) {
        at.notes().branch(BY_DIFFERENCES);
    }
    Ok(answer.gather(|number| Dual {
        value: number(&answer),
        slopes: stencils.map(|stencil| stencil.map_or(0.0, |stencil| stencil.slope(number))),
    }))
}

/// Coefficients of friction along a path, as [`answer`].
///
/// # Errors
/// As [`answer`].
pub(super) fn along(
    model: &dyn ToothFrictionModel,
    path: &PathAt<'_, Dual>,
    mu: &mut [Dual],
) -> Result<Along<Dual>, Undefined> {
    let evaluate = |number: &dyn Fn(Dual) -> f64| {
        let mut values = vec![0.0; path.nodes.len()];
        let along = path.map([Notes::MUTED; 2], number, |path| model.uncut_along(path, &mut values))?;
        Ok((values, along))
    };
    let (values, value_along) = evaluate(&|x| x.value)?;
    for (mu, value) in mu.iter_mut().zip(values) {
        *mu = Dual {
            value,
            ..Dual::default()
        };
    }
    let mut along = Along {
        first_heat: Dual {
            value: value_along.first_heat,
            ..Dual::default()
        },
        kink: value_along.kink,
    };
    let Some(node) = path.nodes.first() else {
        return Ok(along);
    };
    // The quantities of all contacts change in the same proportion.
    let contact = path.contact(node);
    for direction in 0..DIRECTIONS {
        let Some(step) = step::<ToothFriction>(&contact, direction) else {
            continue;
        };
        let stencil = Stencil::new(step, |s| evaluate(&moved(direction, s)))?;
        for (k, mu) in mu.iter_mut().enumerate() {
            mu.slopes[direction] = stencil.slope(|(values, _)| values[k]);
        }
        along.first_heat.slopes[direction] = stencil.slope(|(_, along)| along.first_heat);
        path.notes.branch(BY_DIFFERENCES);
    }
    Ok(along)
}

/// The value of a number at a distance along a direction.
fn moved(direction: usize, distance: f64) -> impl Fn(Dual) -> f64 {
    move |x| x.value + x.slopes[direction] * distance
}

/// The step along a direction; `None` if nothing changes along it.
fn step<M: Mechanism>(at: &M::At<'_, Dual>, direction: usize) -> Option<f64> {
    let alone = at.map(Notes::MUTED, |x| x.value);
    let change = at.map(Notes::MUTED, |x| x.slopes[direction]);
    let mut most = 0.0_f64;
    for q in M::QUANTITIES {
        let change = (q.get)(&change);
        if change != 0.0 {
            let unit = q.unit;
            let size = if unit.symbol == "degC" {
                TEMPERATURES
            } else {
                let usual = if q.usual == 0.0 { q.greatest } else { q.usual };
                (q.get)(&alone).abs().max(LEAST * unit.to_si(usual).abs())
            };
            most = most.max((change / size).abs());
        }
    }
    (most > 0.0 && most.is_finite()).then(|| STEP / most * Dual::step_factor(direction))
}
