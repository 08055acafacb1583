//! Derivatives of laws, at random contexts and along random directions.

use crate::loss::{NoteBase, Notebook, Notes, Undefined};
use crate::mechanism::{Answer, Inputs as _, Mechanism, differences};
use crate::random::Random;
use crate::real::{DIRECTIONS, Dual, Stencil};

/// Number of contexts.
const CONTEXTS: usize = 60;
/// Steps of the differences, over the size of each quantity.
const STEPS: [f64; 2] = [1e-3, 5e-4];
/// Differences with both steps agree so well where the law is smooth, over its result.
const SMOOTH: f64 = 2e-9;
/// Maximum deviation of a derivative there, over the result.
const EXACT: f64 = 1e-8;

/// The faults of the derivatives of a law: its values must have the bits of plain numbers, and where the law is smooth, derivatives
/// must agree with differences, also with those that the framework takes of models that are not laws.
pub(super) fn faults<M: Mechanism>(model: &M::Model, part: &M::Part) -> Vec<String> {
    let mut faults = Vec::new();
    let mut random = Random(1);
    let (mut defined, mut compared) = (0, 0);
    for _ in 0..CONTEXTS {
        let at_point = context::<M>(part, &mut random);
        let directions: [M::At<'_, f64>; DIRECTIONS] =
            std::array::from_fn(|_| direction::<M>(&at_point, part, &mut random));
        let at = M::At::gather(part, Notebook::CLOSED.notes(NoteBase::default()), |quantity| Dual {
            value: quantity(&at_point),
            slopes: directions.each_ref().map(quantity),
        });
        let Some(answer) = M::answer_with_derivatives(model, &at) else {
            return faults;
        };
        let alone = M::answer(model, &at_point);
        let value = answer.as_ref().map(|all| M::Answer::map(all, |x: Dual| x.value));
        if !super::same_result(&value.map_err(|e| *e), &alone, 1.0) {
            faults.push("returns a different result with derivatives".to_owned());
        }
        let (Ok(answer), Ok(alone)) = (answer, alone) else {
            continue;
        };
        defined += 1;
        let plain = differences::answer::<M>(model, &at);
        for direction in 0..DIRECTIONS {
            let along = |s: f64| {
                let moved = at.map(Notes::MUTED, |x: Dual| x.value + s * x.slopes[direction]);
                M::answer(model, &moved).map(|answer| answer.total(1.0))
            };
            let slope = |step: f64| Ok::<f64, Undefined>(Stencil::new(step, along)?.slope(|total| *total));
            let (Ok(wide), Ok(narrow)) = (slope(STEPS[0]), slope(STEPS[1])) else {
                continue;
            };
            let scale = narrow.abs() + alone.total(1.0).abs();
            if (wide - narrow).abs() > SMOOTH * scale {
                continue;
            }
            compared += 1;
            let of =
                |all: &<M::Answer as Answer>::Of<Dual>| M::Answer::map(all, |x: Dual| x.slopes[direction]).total(1.0);
            let exact = of(&answer);
            if (exact - narrow).abs() > EXACT * scale {
                faults.push(format!("has a derivative of {exact} where differences give {narrow}"));
            }
            if let Ok(plain) = &plain
                && (of(plain) - exact).abs() > EXACT * scale
            {
                faults.push(format!(
                    "has a derivative of {exact} where a plain model has {}",
                    of(plain)
                ));
            }
        }
    }
    if defined > 0 && compared == 0 {
        faults.push("is nowhere smooth enough to check its derivatives".to_owned());
    }
    faults
}

/// A context at random quantities around the usual ones, in their ranges.
fn context<'a, M: Mechanism>(part: &'a M::Part, random: &mut Random) -> M::At<'a, f64> {
    let mut at = M::usual(part, Notes::MUTED);
    for q in M::QUANTITIES {
        let value = if q.usual == 0.0 {
            0.01 * q.greatest * random.share()
        } else {
            q.usual * 4.0_f64.powf(2.0 * random.share() - 1.0)
        };
        (q.set)(&mut at, q.unit.to_si(value.clamp(q.least, q.greatest)));
    }
    at
}

/// Derivatives of the quantities of a context: random, of the size of each. Quantities that are zero or one are flags.
fn direction<'a, M: Mechanism>(at: &M::At<'a, f64>, part: &'a M::Part, random: &mut Random) -> M::At<'a, f64> {
    let mut direction = M::usual(part, Notes::MUTED);
    for q in M::QUANTITIES {
        let flag = q.least == 0.0 && q.greatest == 1.0;
        let size = if flag { 0.0 } else { (q.get)(at) };
        (q.set)(&mut direction, size * (2.0 * random.share() - 1.0));
    }
    direction
}
