//! Points solved in parallel, piece by piece, so that few are in memory.

use std::iter::repeat_n;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::solve::{Solver, Space};
use super::{Field, PointResult, Points, merge};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Extent;
use gearloss_framework::real::LANES;
use gearloss_framework::transmission::Transmission;
use serde::{Deserialize, Serialize};

/// Points of a piece of a list.
const PIECE: usize = 1024;

/// Torques of one speed in a piece of a grid: a few full blocks.
const ROWS: usize = 4 * LANES;

/// Maximum number of points of a piece of a grid: sufficient for full blocks of a square map with 10^7 points.
const LARGEST: usize = ROWS * 3200;

/// Number of points that are solved at once, at least one piece.
const TOGETHER: usize = ROWS * 2048;

/// Maximum number of points with data in memory while a field is solved piece by piece.
pub const MOST_IN_FLIGHT: usize = 2 * LARGEST;

/// Maximum number of points of a task.
const TASK: usize = 4096;

/// Results of consecutive points of a field, by task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Piece<T = Vec<PointResult>> {
    /// Index of the piece in the field.
    pub number: usize,
    /// Results of the points of each task, in the order of the field.
    pub(super) tasks: Vec<T>,
    /// The order of the field: index of a task and number of its following points.
    order: Vec<(usize, usize)>,
    /// Observed limits and quantities over these points.
    pub seen: Vec<Extent>,
}

/// Points with their indices in the field, ascending.
pub type Numbered<'a> = [(usize, &'a mut PointResult)];

/// Function applied to the points of a task after solving.
pub type Make<'a, T> = dyn Fn(&mut Numbered<'_>) -> T + Sync + 'a;

/// The points themselves; the originals remain without components, terms and nodes.
pub fn take_points(points: &mut Numbered<'_>) -> Vec<PointResult> {
    let taken = |(_, point): &mut (usize, &mut PointResult)| PointResult {
        nodes: std::mem::take(&mut point.nodes),
        limits: std::mem::take(&mut point.limits),
        machines: std::mem::take(&mut point.machines),
        parts: std::mem::take(&mut point.parts),
        terms: std::mem::take(&mut point.terms),
        ..**point
    };
    points.iter_mut().map(taken).collect()
}

impl<T> Piece<T> {
    /// The order of the points in the field: index of a task and its following points.
    pub fn runs(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        let mut done = vec![0; self.tasks.len()];
        self.order.iter().map(move |(task, count)| {
            let start = done[*task];
            done[*task] += count;
            (*task, start..start + count)
        })
    }

    /// The piece with the results of each task mapped.
    pub fn map<U>(self, other: impl FnMut(T) -> U) -> Piece<U> {
        Piece {
            number: self.number,
            tasks: self.tasks.into_iter().map(other).collect(),
            order: self.order,
            seen: self.seen,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.order.iter().map(|(_, count)| count).sum()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Piece {
    /// A piece of points in the order of the field, with observed limits and quantities.
    pub fn new(number: usize, points: Vec<PointResult>, seen: Vec<Extent>) -> Self {
        Self {
            number,
            order: vec![(0, points.len())],
            tasks: vec![points],
            seen,
        }
    }

    /// The points, in the order of the field.
    pub fn points(&self) -> impl Iterator<Item = &PointResult> {
        self.runs().flat_map(|(task, place)| &self.tasks[task][place])
    }

    /// The same, consuming the piece.
    pub fn into_points(self) -> impl Iterator<Item = PointResult> {
        let mut tasks: Vec<_> = self.tasks.into_iter().map(Vec::into_iter).collect();
        let in_order = self.order.into_iter().flat_map(|(task, count)| repeat_n(task, count));
        in_order.filter_map(move |task| tasks[task].next())
    }

    /// Whether a piece that was read has this number and so many points.
    pub fn is_sound(&self, number: usize, points: usize) -> bool {
        let mut missing: Vec<usize> = self.tasks.iter().map(Vec::len).collect();
        let is_there = |&(task, count): &(usize, usize)| {
            let rest = missing
                .get_mut(task)
                .and_then(|count_left| Some((count_left.checked_sub(count)?, count_left)));
            rest.map(|(rest, count_left)| *count_left = rest).is_some()
        };
        self.number == number
            && self.len() == points
            && self.order.iter().all(is_there)
            && missing.iter().all(|n| *n == 0)
    }

    /// Applies `make` to points that were solved elsewhere; `first` is the index of the first in the field.
    pub fn made<T: Send>(self, first: usize, make: &Make<'_, T>) -> Piece<T> {
        let (number, seen) = (self.number, self.seen.clone());
        let mut points: Vec<PointResult> = self.into_points().collect();
        let mut points: Vec<(usize, &mut PointResult)> = (first..).zip(&mut points).collect();
        Piece {
            number,
            order: points.chunks(TASK).map(<[_]>::len).enumerate().collect(),
            tasks: points.par_chunks_mut(TASK).with_max_len(1).map(make).collect(),
            seen,
        }
    }
}

impl Field {
    /// Number of points of a piece. On a grid a piece has complete rows of one torque, enough for full blocks of one speed if memory
    /// allows.
    fn piece(&self) -> usize {
        match self {
            Self::Grid { speeds, .. } if (1..=LARGEST).contains(&speeds.len()) => {
                speeds.len() * (LARGEST / speeds.len()).min(ROWS)
            }
            _ => PIECE,
        }
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.len().div_ceil(self.piece())
    }

    /// Indices of the points of a piece.
    pub fn of_piece(&self, number: usize) -> Range<usize> {
        let piece = self.piece();
        number * piece..((number + 1) * piece).min(self.len())
    }

    /// The points of a piece in solution order: grouped by speed and oil temperature.
    fn in_order(&self, number: usize) -> Vec<usize> {
        let numbers_of_piece = self.of_piece(number);
        if let Self::Grid { speeds, .. } = self {
            let mut numbers = Vec::with_capacity(numbers_of_piece.len());
            for first in numbers_of_piece.start..(numbers_of_piece.start + speeds.len()).min(numbers_of_piece.end) {
                numbers.extend((first..numbers_of_piece.end).step_by(speeds.len()));
            }
            return numbers;
        }
        let mut numbers: Vec<usize> = numbers_of_piece.collect();
        numbers.sort_by(|a, b| {
            let (a, b) = (self.given_point(*a), self.given_point(*b));
            let oil = |oil: Option<f64>| oil.unwrap_or(f64::NEG_INFINITY);
            a.speed.total_cmp(&b.speed).then(oil(a.oil).total_cmp(&oil(b.oil)))
        });
        numbers
    }
}

/// Result of a task.
struct Task<T> {
    made: T,
    /// Index of a point, and number of consecutive points in the order of the field.
    runs: Vec<(usize, usize)>,
    seen: Vec<Extent>,
}

/// Solves the pieces with the given indices and passes them on in this order. `make` extracts the requested data of the points on all
/// threads, while they are in the caches; points are not stored unless `make` returns them ([`take_points`]). Data of at most [`MOST_IN_FLIGHT`] points
/// are in memory: while some are taken, the next are solved. `progress` is called with the number of newly solved points; if it or `take`
/// returns false, the work stops and this returns false.
///
/// # Errors
/// If the case is invalid.
pub fn solve_pieces<T: Send>(
    transmission: &Transmission,
    points: &Points,
    numbers: &[usize],
    make: &Make<'_, T>,
    progress: &(dyn Fn(usize) -> bool + Sync),
    take: &mut dyn FnMut(Piece<T>) -> bool,
) -> Result<bool, Vec<Diagnostic>> {
    let case = points.case(transmission)?;
    let solver = Solver::new(transmission, &case, points);
    let going = AtomicBool::new(true);
    // One for each concurrent task, reused.
    let spaces: Mutex<Vec<Space>> = Mutex::default();
    let solve = |task: &[usize]| {
        if !going.load(Ordering::Relaxed) {
            return None;
        }
        let spare = spaces.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut space = spare.unwrap_or_else(|| solver.space());
        let mut points = solver.solve(task, &mut space);
        let made = make(&mut points);
        if !progress(task.len()) {
            going.store(false, Ordering::Relaxed);
        }
        let runs = points.chunk_by(|a, b| b.0 == a.0 + 1);
        let runs = runs.map(|run| (run[0].0, run.len())).collect();
        let seen = space.take_seen();
        spaces.lock().unwrap_or_else(PoisonError::into_inner).push(space);
        Some(Task { made, runs, seen })
    };
    let solve_all = |numbers: &[usize]| -> Vec<Piece<T>> {
        let orders: Vec<Vec<usize>> = numbers.iter().map(|number| points.field.in_order(*number)).collect();
        let tasks: Vec<&[usize]> = orders.iter().flat_map(|order| order.chunks(TASK)).collect();
        // One by one for load balancing.
        let solved: Option<Vec<Task<T>>> = tasks.into_par_iter().with_max_len(1).map(solve).collect();
        // Nothing after an interruption.
        let Some(solved) = solved else {
            return Vec::new();
        };
        let mut solved = solved.into_iter();
        let piece = |(number, order): (&usize, &Vec<usize>)| {
            let (mut seen, mut made, mut runs) = (Vec::new(), Vec::new(), Vec::new());
            for (i, task) in solved.by_ref().take(order.len().div_ceil(TASK)).enumerate() {
                merge(&mut seen, &task.seen);
                made.push(task.made);
                runs.extend(task.runs.into_iter().map(|(first, count)| (first, i, count)));
            }
            runs.sort_unstable();
            Piece {
                number: *number,
                tasks: made,
                order: runs.into_iter().map(|(_, task, count)| (task, count)).collect(),
                seen,
            }
        };
        numbers.iter().zip(&orders).map(piece).collect()
    };
    let mut ready: Vec<Piece<T>> = Vec::new();
    let mut groups = numbers.chunks((TOGETHER / points.field.piece()).max(1));
    loop {
        let next = groups.next();
        let mut solved = Vec::new();
        let mut take_all = |ready: &mut Vec<Piece<T>>| {
            if !ready.drain(..).all(&mut *take) {
                going.store(false, Ordering::Relaxed);
            }
        };
        match next {
            // Few points, as those of a sample, are not worth another task.
            Some(next) if ready.is_empty() => solved = solve_all(next),
            Some(next) => rayon::in_place_scope(|scope| {
                scope.spawn(|_| solved = solve_all(next));
                take_all(&mut ready);
            }),
            None => take_all(&mut ready),
        }
        if !going.load(Ordering::Relaxed) {
            return Ok(false);
        }
        if next.is_none() {
            return Ok(true);
        }
        ready = solved;
    }
}
