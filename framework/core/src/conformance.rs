//! The conformance suite: checks the requirements of the framework on every model, on a grid of its mechanism's context, and its check
//! values.
//!
//! It serves built-in models and those of other crates: a crate calls [`check_all`] in one test, which covers every linked model.

mod derivatives;
mod ratings;

pub use ratings::conform_rating;

use std::cell::Cell;
use std::sync::Arc;

use serde_json::Value;

use crate::checks;
use crate::language::Language;
use crate::loss::{Kept, NoteBase, Notebook, Notes, Seen, Undefined};
use crate::mechanism::{Answer, Inputs as _, Mechanism, Quantity};
use crate::real::{Dual, LANES, Lane, Real as _};
use crate::registry::{Build, Entry, Evidence, Files, Graded, Registry, from_resolved};

/// Checks every linked model and rating on its mechanism's example part. Returns one line for each fault.
pub fn check_all(language: &Language) -> Vec<String> {
    let mut faults = Vec::new();
    for mechanism in language.registry().mechanisms() {
        for q in (mechanism.quantities)() {
            if !(q.least <= q.usual && q.usual <= q.greatest) {
                faults.push(format!(
                    "{}: the usual value of `{}` is outside its range",
                    mechanism.key, q.name
                ));
            }
        }
        for entry in language.registry().models(mechanism.key) {
            let checks = checks::faults(language, entry).into_iter();
            faults.extend(checks.map(|fault| format!("{}/{}: {fault}", entry.mechanism, entry.name)));
            match language.example_of(entry) {
                Ok((model, part)) => {
                    let files = Files::default();
                    files.put_all(entry.files);
                    // The example of `table` names a file; a plane over the first quantity replaces it.
                    if let Some(q) = (mechanism.quantities)().first() {
                        let unit = q.unit.symbol;
                        let answer = crate::document::Unit::of_doc(mechanism.answer).map_or("-", |u| u.symbol);
                        let csv = format!(
                            "{} [{unit}],answer [{answer}]\n{},0.01\n{},0.02\n",
                            q.name, q.least, q.greatest
                        );
                        files.put("table.csv", &csv);
                    }
                    for fault in (mechanism.conform)(language.registry(), &files, entry, &model, &part) {
                        faults.push(format!("{}/{}: {fault}", entry.mechanism, entry.name));
                    }
                }
                Err(found) => {
                    faults.extend(
                        found
                            .iter()
                            .map(|d| format!("{}/{}: its example: {d}", entry.mechanism, entry.name)),
                    );
                }
            }
        }
    }
    faults.extend(ratings::check_all(language));
    faults
}

/// The faults of one model, built from its resolved parameters, on one resolved part.
pub fn conform<M: Mechanism>(
    registry: &Registry,
    files: &Files,
    entry: &Entry,
    model: &Value,
    part: &Value,
) -> Vec<String> {
    let mut faults = head(entry);
    let part: Arc<M::Part> = match from_resolved(part) {
        Ok(part) => Arc::new(part),
        Err(e) => return vec![format!("the mechanism's example part cannot be read: {e}")],
    };
    let mut build = Build::new(registry, files);
    let slot = match build.slot_at::<M>("model", &part, model) {
        Ok(slot) => slot,
        Err(e) => return vec![format!("cannot be built from its example: {e}")],
    };
    let (instances, cells) = build.finish();
    for instance in &instances {
        let found = instance
            .path
            .split('.')
            .skip(1)
            .try_fold(model, |value, key| value.get(key));
        if found.is_none() {
            faults.push(format!(
                "nested slot `{}` is not a key of the parameters",
                instance.path
            ));
        }
    }
    let cells = &vec![Cell::new(Seen::NOTHING); cells][..];
    let usual = M::usual(&part, Notes::MUTED);
    let noted = M::usual(&part, Notes::new(cells, slot.notes));
    let mut try_at = |what: &str, changes: &[(usize, f64)]| {
        let (mut at, mut with_notes) = (usual, noted);
        for (i, value) in changes {
            let q = &M::QUANTITIES[*i];
            (q.set)(&mut at, q.unit.to_si(*value));
            (q.set)(&mut with_notes, q.unit.to_si(*value));
        }
        let answer = M::answer(&slot, &at);
        let speed = M::speed(&at);
        if !same_result(&answer, &M::answer(&slot, &with_notes), speed) {
            faults.push(format!("returns a different result with notes, at {what}"));
        }
        if let (true, Some(fault)) = (changes.len() < 2, together::<M>(&slot, &part, &at, slot.notes)) {
            faults.push(format!("{fault} at {what}"));
        }
        match answer {
            Ok(answer) if !answer.is_sound() => faults.push(format!("the result is negative or not finite at {what}")),
            Ok(answer) => {
                if let Some(term) = answer.stray(entry.terms) {
                    faults.push(format!("sets term {term}, which it does not list, at {what}"));
                }
            }
            Err(Undefined { what: "", .. }) => {
                faults.push(format!("undefined without a reason at {what}"));
            }
            Err(_) => {}
        }
    };
    try_at("the usual point", &[]);
    for (i, q) in M::QUANTITIES.iter().enumerate() {
        let mut values = vec![q.least, q.greatest, 0.5 * (q.least + q.greatest)];
        if q.least <= 0.0 && q.greatest >= 0.0 {
            values.push(0.0);
        }
        for value in values {
            try_at(&format!("{} = {value}", q.name), &[(i, value)]);
            for (j, other) in M::QUANTITIES.iter().enumerate().skip(i + 1) {
                for second in [other.least, other.greatest] {
                    try_at(
                        &format!("{} = {value}, {} = {second}", q.name, other.name),
                        &[(i, value), (j, second)],
                    );
                }
            }
        }
    }
    // User-defined laws such as `formula` and `table` may depend on the direction of rotation.
    let stated = |g: &Graded| g.key.is_empty() && g.grade == Evidence::User;
    if !entry.evidence.iter().any(stated) {
        faults.extend(rest_and_reversal::<M>(&slot, &usual));
    }
    faults.extend(derivatives::faults::<M>(&slot, &part));
    faults.extend(keeping::<M>(&slot, &part, slot.notes, (instances.len(), cells)));
    faults.dedup();
    faults.truncate(12);
    faults
}

/// Whether the law of a model answers for several points at once and has exact derivatives; otherwise its
/// derivatives are differences. `None` if it cannot be built from its example alone.
pub fn is_generic<M: Mechanism>(registry: &Registry, files: &Files, model: &Value, part: &Value) -> Option<bool> {
    let part: Arc<M::Part> = Arc::new(from_resolved(part).ok()?);
    let slot = Build::new(registry, files).slot_at::<M>("model", &part, model).ok()?;
    let at = M::At::gather(&part, Notebook::CLOSED.notes(slot.notes), |quantity| {
        Dual::constant(quantity(&M::usual(&part, Notes::MUTED)))
    });
    Some(M::answer_with_derivatives(&slot, &at).is_some())
}

/// Checks the loss at standstill and for the opposite direction of rotation: zero power, and equal power.
fn rest_and_reversal<M: Mechanism>(model: &M::Model, usual: &M::At<'_, f64>) -> Vec<String> {
    let speeds: Vec<&Quantity<M>> = M::QUANTITIES
        .iter()
        .filter(|q| q.unit.symbol == "rpm" && q.least < 0.0)
        .collect();
    let mut faults = Vec::new();
    if speeds.is_empty() {
        return faults;
    }
    let with = |change: fn(f64) -> f64| {
        let mut at = *usual;
        for q in &speeds {
            (q.set)(&mut at, change((q.get)(usual)));
        }
        (M::answer(model, &at), M::speed(&at))
    };
    if let (Ok(rest), speed) = with(|_| 0.0)
        && rest.moment(speed).is_some()
        && rest.total(speed) != 0.0
    {
        faults.push("loses power at standstill".to_owned());
    }
    match (with(|x| x), with(|x| -x)) {
        ((Ok(forward), w), (Ok(backward), v)) => {
            let (a, b) = (forward.total(w), backward.total(v));
            if (a - b).abs() > 1e-9 * a.abs() {
                faults.push(format!("loses {a} in one direction of rotation and {b} in the other"));
            }
        }
        ((Err(_), _), (Err(_), _)) => {}
        _ => faults.push("is undefined in one direction of rotation only".to_owned()),
    }
    faults
}

/// A law that is written for several points must give and note for each what it gives and notes for that point alone. The loads of
/// the points differ, some of them are zero; then their speeds and oils as well.
fn together<M: Mechanism>(
    model: &M::Model,
    part: &M::Part,
    at: &M::At<'_, f64>,
    base: NoteBase,
) -> Option<&'static str> {
    const LOADS: [&str; 4] = ["N", "Nm", "N/mm", "GPa"];
    const STATES: [&str; 4] = ["rpm", "m/s", "mm2/s", "mPa s"];
    // Looked up once: in the loops it would take a third of the time of the suite.
    let kinds: Vec<[bool; 2]> = M::QUANTITIES
        .iter()
        .map(|q| [LOADS, STATES].map(|kind| kind.contains(&q.unit.symbol)))
        .collect();
    let [all, single] = [(); 2].map(|()| vec![Cell::new(Seen::NOTHING); base.end()]);
    for states in [false, true] {
        for cell in all.iter().chain(&single) {
            cell.set(Seen::NOTHING);
        }
        let several: Notebook<'_, Lane> = Notebook {
            cells: &all,
            ..Notebook::CLOSED
        };
        let point = |i: usize| {
            let book = Notebook {
                cells: &single,
                points: 1 << i,
                ..Notebook::CLOSED
            };
            let mut point = M::usual(part, book.notes(base));
            for (k, (q, [load, state])) in M::QUANTITIES.iter().zip(&kinds).enumerate() {
                let factor = match *load || states && *state {
                    true if *load && i % 5 == 4 && k % 2 == 0 => 0.0,
                    true => 0.3 + 1.5 * i as f64 / LANES as f64,
                    false => 1.0,
                };
                (q.set)(&mut point, (q.get)(at) * factor);
            }
            point
        };
        let lanes = M::At::together(part, several.notes(base), point);
        let Ok(answers) = M::answer_together(model, &lanes) else {
            continue;
        };
        for i in 0..LANES {
            let here = point(i);
            let (alone, speed) = (M::answer(model, &here), M::speed(&here));
            if !same_result(&Ok(M::Answer::at_point(&answers, i)), &alone, speed) {
                return Some("gives another result at one of several points");
            }
        }
        if all != single {
            return Some("notes something else at several points");
        }
    }
    None
}

/// Values that a model keeps over the iterations of a point must not depend on loads, which change between them, and must not skip
/// notes.
fn keeping<M: Mechanism>(
    model: &M::Model,
    part: &M::Part,
    base: NoteBase,
    (instances, cells): (usize, &[Cell<Seen>]),
) -> Vec<String> {
    let kept: Vec<Cell<Kept<f64>>> = vec![Cell::new(None); instances];
    let none: &[Cell<Kept<f64>>] = &[];
    let notes = |cells, kept| {
        let book = Notebook {
            cells,
            kept,
            ..Notebook::CLOSED
        };
        book.clear(base);
        book.notes(base)
    };
    let _ = M::answer(model, &M::usual(part, notes(&[], &kept)));
    let evaluate = |notes, q: &Quantity<M>, value| {
        let mut at = M::usual(part, notes);
        (q.set)(&mut at, q.unit.to_si(value));
        let noted = |cells: &[Cell<Seen>]| cells.iter().map(Cell::get).collect::<Vec<_>>();
        (M::answer(model, &at), M::speed(&at), noted(cells))
    };
    let mut faults = Vec::new();
    for q in M::QUANTITIES.iter().filter(|q| matches!(q.unit.symbol, "N" | "Nm")) {
        for value in [q.least, q.greatest] {
            let (anew, speed, noted) = evaluate(notes(cells, none), q, value);
            let (again, _, noted_again) = evaluate(notes(cells, &kept), q, value);
            if !same_result(&anew, &again, speed) {
                faults.push(format!(
                    "keeps a value that depends on `{}` over the iterations of a point",
                    q.name
                ));
            }
            if noted != noted_again {
                faults.push("writes notes inside a value that it keeps over the iterations of a point".to_owned());
            }
        }
    }
    faults
}

fn same_result<A: Answer>(a: &Result<A, Undefined>, b: &Result<A, Undefined>, speed: f64) -> bool {
    match (a, b) {
        (Ok(a), Ok(b)) => a.total(speed).to_bits() == b.total(speed).to_bits(),
        (Err(a), Err(b)) => a.what == b.what,
        _ => false,
    }
}

pub(super) fn head(entry: &Entry) -> Vec<String> {
    let mut faults = Vec::new();
    if entry.meaning().is_empty() {
        faults.push("has no description: write a doc comment on its parameters".to_owned());
    }
    for limit in entry.limits {
        if limit.least.is_nan() || limit.greatest.is_nan() || limit.least > limit.greatest {
            faults.push(format!("limit `{}` has an empty range", limit.name));
        }
    }
    let named = [
        (
            "limits",
            entry.limits.iter().map(|l| (l.name, l.index)).collect::<Vec<_>>(),
        ),
        ("observed", entry.observed.iter().map(|o| (o.name, o.index)).collect()),
        ("terms", entry.terms.iter().map(|t| (t.name, t.index)).collect()),
    ];
    for (list, named) in named {
        for (i, (name, index)) in named.into_iter().enumerate() {
            if index != i {
                faults.push(format!(
                    "`{name}` is number {index} of `{list}!` and number {i} of `{list}` in the registration"
                ));
            }
        }
    }
    if entry.source.trim().is_empty() {
        faults.push("has no source".to_owned());
    }
    if entry.evidence.is_empty() {
        faults.push("has no evidence".to_owned());
    }
    faults
}
