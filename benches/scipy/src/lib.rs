//! Residuals of an identification, and our own solver on them, over a C ABI: for comparisons of solvers, not for users.
//!
//! Parameters are the coordinates `u` in which our solver walks: the parameter in the unit of its path, or its natural
//! logarithm. Texts end in a zero and are cut to the room that is given for them.

// The workspace forbids unsafe code. A C ABI is not to be had without: it takes pointers as the caller gives them. It all
// stands in this file, and nothing of the project depends on this crate.
#![allow(unsafe_code)]

// Times and comparisons are of the same identifications.
#[path = "../../common/identification.rs"]
mod identification;
// The check problem of the solver's own tests, of which only the problem is needed here.
#[allow(dead_code)]
#[path = "../../../framework/numerics/tests/loss_map/mod.rs"]
mod loss_map;

use std::ffi::{CStr, c_char};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use gearloss_studies::identify::Settings;
use gearloss_numerics::least_squares::{Fit, Options, Parameter, Problem, Scale, solve};
use identification::Prepared;

/// A problem with the options of its fit.
pub struct Handle {
    problem: Problem<'static>,
    options: Options<'static>,
    rows: usize,
    /// Every call of the last fit: coordinates, cost, and 1 where the search stood there, else 0.
    trace: Vec<Vec<f64>>,
    /// What became of the last fit.
    words: String,
    /// Borrowed by the problem, and so dropped after it: fields are dropped in their order.
    _kept: Option<Kept>,
}

/// What a problem borrows for as long as it lives.
struct Kept(*mut Prepared);

impl Drop for Kept {
    fn drop(&mut self) {
        // SAFETY: the pointer is that of a leaked box, and the only borrower, the problem, is dropped before.
        drop(unsafe { Box::from_raw(self.0) });
    }
}

/// Relative difference of costs that are the same but for the order of their sums.
const SAME: f64 = 1e-12;

/// What a fit came to.
#[repr(C)]
pub struct Outcome {
    /// Half the sum of squares.
    pub cost: f64,
    /// Wall time. \[s\]
    pub seconds: f64,
    /// Calls of the residual function.
    pub evaluations: u64,
    /// Steps that were tried.
    pub steps: u64,
    /// Threads that take part.
    pub threads: u64,
    /// 1 where it has converged, else 0.
    pub converged: i32,
}

impl Handle {
    fn study(study: &Path, analysis: &str, set: &str) -> Result<Self, String> {
        let kept = Kept(Box::into_raw(Box::new(Prepared::read(study, analysis).map_err(|e| e.to_string())?)));
        // SAFETY: a box that was just leaked, and that `Kept` frees once the problem is gone.
        let prepared: &'static Prepared = unsafe { &*kept.0 };
        let identification = prepared.identification(set).map_err(|e| e.to_string())?;
        let options = Settings::default().options(identification.accuracy());
        let parameters = identification.problem().parameters().to_vec();
        let rows = identification.observations().len();
        Ok(Self {
            problem: Problem::new(move |theta: &[f64]| identification.residuals(theta), parameters),
            options,
            rows,
            trace: Vec::new(),
            words: String::new(),
            _kept: Some(kept),
        })
    }

    fn check(seed: u32) -> Self {
        let measured = loss_map::measured(seed);
        let rows = measured.len();
        let residual = move |theta: &[f64]| loss_map::problem(&measured, Vec::new()).residual(theta);
        Self {
            problem: Problem::new(residual, loss_map::parameters()),
            options: Options::fit(),
            rows,
            trace: Vec::new(),
            words: String::new(),
            _kept: None,
        }
    }

    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual(&self, u: &[f64]) -> Result<Vec<f64>, String> {
        let theta: Vec<f64> = self.parameters().iter().zip(u).map(|(p, u)| value(p, *u)).collect();
        self.problem.residual(&theta)
    }

    fn fit(&mut self, start: &[f64]) -> Result<Outcome, String> {
        let calls: Mutex<Vec<Vec<f64>>> = Mutex::default();
        let (problem, parameters) = (&self.problem, self.problem.parameters());
        let residual = |theta: &[f64]| {
            let residual = problem.residual(theta)?;
            let mut call: Vec<f64> = parameters.iter().zip(theta).map(|(p, x)| coordinate(p, *x)).collect();
            call.push(0.5 * residual.iter().map(|r| r * r).sum::<f64>());
            // A lock that a panic has left is of no concern to numbers that are only appended.
            calls.lock().unwrap_or_else(PoisonError::into_inner).push(call);
            Ok(residual)
        };
        let at = |(p, u): (&Parameter, &f64)| Parameter {
            start: value(p, *u),
            ..p.clone()
        };
        let traced = Problem::new(residual, parameters.iter().zip(start).map(at).collect());
        let begun = Instant::now();
        let fit = solve(&traced, &self.options).map_err(|fault| fault.to_string())?;
        let seconds = begun.elapsed().as_secs_f64();
        drop(traced);
        self.trace = calls.into_inner().unwrap_or_else(PoisonError::into_inner);
        let held: Vec<f64> = fit.log.iter().map(|step| step.cost).chain([fit.cost]).collect();
        for call in &mut self.trace {
            let cost = call[call.len() - 1];
            let stood = held.iter().any(|held| (held - cost).abs() <= SAME * cost);
            call.push(f64::from(u8::from(stood)));
        }
        self.words = words(&fit);
        Ok(Outcome {
            cost: fit.cost,
            seconds,
            evaluations: fit.counts.evaluations as u64,
            steps: fit.counts.steps as u64,
            threads: rayon::current_num_threads() as u64,
            converged: i32::from(fit.converged()),
        })
    }
}

/// The coordinate of a value.
fn coordinate(parameter: &Parameter, value: f64) -> f64 {
    match parameter.scale {
        Scale::Linear => value,
        Scale::Log => value.ln(),
    }
}

/// The value of a coordinate, inside the bounds.
fn value(parameter: &Parameter, u: f64) -> f64 {
    let value = match parameter.scale {
        Scale::Linear => u,
        Scale::Log => u.exp(),
    };
    value.clamp(parameter.lower, parameter.upper)
}

/// How a fit ended, and its steps.
fn words(fit: &Fit) -> String {
    let mut words = format!(
        "{} ({}), attempt {}, {} steps, {} cone programs\n",
        fit.status.name(),
        fit.reason.name(),
        fit.attempt,
        fit.counts.steps,
        fit.counts.cone_solves
    );
    for step in &fit.log {
        let _ = writeln!(
            words,
            "attempt {} {} cost {:.9} first-order {:.1e} offset {:.1e} radius {:.1e} length {:.1e} predicted {:.3e} actual {:.3e} {:?}{}{}",
            step.attempt,
            if step.central { "central" } else { "forward" },
            step.cost,
            step.first_order,
            step.relative_offset.unwrap_or(f64::NAN),
            step.radius,
            step.length,
            step.predicted,
            step.actual,
            step.how,
            if step.corrected { " corrected" } else { "" },
            if step.accepted { "" } else { " refused" },
        );
    }
    for note in &fit.notes {
        let _ = writeln!(words, "note: {note}");
    }
    words
}

/// Writes a text into the room for it.
///
/// # Safety
/// `out` is null or holds `room` bytes.
unsafe fn tell(text: &str, out: *mut c_char, room: usize) {
    if out.is_null() || room == 0 {
        return;
    }
    let length = text.len().min(room - 1);
    // SAFETY: `length + 1` bytes are inside the room.
    unsafe {
        std::ptr::copy_nonoverlapping(text.as_ptr().cast(), out, length);
        *out.add(length) = 0;
    }
}

/// # Safety
/// `text` is a text that ends in a zero, and lives as long as what is given back.
unsafe fn read<'a>(text: *const c_char, what: &str) -> Result<&'a str, String> {
    if text.is_null() {
        return Err(format!("no {what} is named"));
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(text) }
        .to_str()
        .map_err(|_| format!("the {what} is not UTF-8"))
}

/// An analysis `identify` of a study under a set of models; null where there is none, with the reason in `error`.
///
/// # Safety
/// The texts end in a zero; `error` is null or holds `room` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_new(
    study: *const c_char,
    analysis: *const c_char,
    set: *const c_char,
    error: *mut c_char,
    room: usize,
) -> *mut Handle {
    // SAFETY: as the caller promises.
    let made = unsafe {
        read(study, "study").and_then(|study| {
            let (analysis, set) = (read(analysis, "analysis")?, read(set, "set")?);
            Handle::study(Path::new(study), analysis, set)
        })
    };
    match made {
        Ok(handle) => Box::into_raw(Box::new(handle)),
        Err(reason) => {
            // SAFETY: as the caller promises.
            unsafe { tell(&reason, error, room) };
            std::ptr::null_mut()
        }
    }
}

/// The check problem of the solver's tests, with the measurements of a seed.
#[unsafe(no_mangle)]
pub extern "C" fn gearloss_residual_check(seed: u32) -> *mut Handle {
    Box::into_raw(Box::new(Handle::check(seed)))
}

/// Frees a handle.
///
/// # Safety
/// The handle is null or one of this library, and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_free(handle: *mut Handle) {
    if !handle.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// How many residuals there are.
///
/// # Safety
/// The handle is one of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_rows(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises.
    unsafe { &*handle }.rows
}

/// How many parameters there are.
///
/// # Safety
/// The handle is one of this library.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_parameters(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises.
    unsafe { &*handle }.parameters().len()
}

/// Coordinates of the start and of both bounds.
///
/// # Safety
/// The handle is one of this library; each list has room for as many numbers as there are parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_box(
    handle: *const Handle,
    start: *mut f64,
    lower: *mut f64,
    upper: *mut f64,
) {
    // SAFETY: as the caller promises.
    let parameters = unsafe { &*handle }.parameters();
    for (j, p) in parameters.iter().enumerate() {
        // SAFETY: as the caller promises.
        unsafe {
            *start.add(j) = coordinate(p, p.start.clamp(p.lower, p.upper));
            *lower.add(j) = coordinate(p, p.lower);
            *upper.add(j) = coordinate(p, p.upper);
        }
    }
}

/// Name of a parameter.
///
/// # Safety
/// The handle is one of this library; `out` holds `room` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_name(handle: *const Handle, j: usize, out: *mut c_char, room: usize) {
    // SAFETY: as the caller promises.
    unsafe {
        let name = (&*handle).parameters().get(j).map_or("", |p| p.name.as_str());
        tell(name, out, room);
    }
}

/// Residuals at coordinates; 0 where they have a value, else 1.
///
/// # Safety
/// The handle is one of this library; `u` holds as many numbers as there are parameters, `r` has room for all residuals.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_eval(handle: *const Handle, u: *const f64, r: *mut f64) -> i32 {
    // SAFETY: as the caller promises.
    let handle = unsafe { &*handle };
    // SAFETY: as the caller promises.
    let (u, out) = unsafe {
        let u = std::slice::from_raw_parts(u, handle.parameters().len());
        (u, std::slice::from_raw_parts_mut(r, handle.rows))
    };
    match handle.residual(u) {
        Ok(residual) if residual.len() == out.len() => {
            out.copy_from_slice(&residual);
            0
        }
        _ => 1,
    }
}

/// Fits with our own solver, as the program does, from coordinates; 0 where there is a fit, else 1, with the reason in the words.
///
/// # Safety
/// The handle is one of this library, and no other thread uses it; `start` holds as many numbers as there are parameters;
/// `outcome` has room for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_fit(handle: *mut Handle, start: *const f64, outcome: *mut Outcome) -> i32 {
    // SAFETY: as the caller promises.
    let handle = unsafe { &mut *handle };
    // SAFETY: as the caller promises.
    let start = unsafe { std::slice::from_raw_parts(start, handle.parameters().len()) };
    match handle.fit(start) {
        Ok(found) => {
            // SAFETY: as the caller promises.
            unsafe { outcome.write(found) };
            0
        }
        Err(reason) => {
            handle.words = reason;
            1
        }
    }
}

/// The calls of the last fit that had a value, in their order, at most `most`: coordinates of all parameters, the cost, and 1
/// where the search stood there, one call after the other. Gives back how many there are; `out` may be null.
///
/// # Safety
/// The handle is one of this library; `out` is null or has room for `most` calls.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_trace(handle: *const Handle, out: *mut f64, most: usize) -> usize {
    // SAFETY: as the caller promises.
    let handle = unsafe { &*handle };
    if !out.is_null() {
        for (i, x) in handle.trace.iter().take(most).flatten().enumerate() {
            // SAFETY: as the caller promises.
            unsafe { *out.add(i) = *x };
        }
    }
    handle.trace.len()
}

/// How the last fit ended, and its steps.
///
/// # Safety
/// The handle is one of this library; `out` holds `room` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gearloss_residual_words(handle: *const Handle, out: *mut c_char, room: usize) {
    // SAFETY: as the caller promises.
    unsafe { tell(&(*handle).words, out, room) };
}
