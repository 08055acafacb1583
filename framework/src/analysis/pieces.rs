//! Many points, solved in parallel piece by piece, so that few of them are held.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::solve::{Solver, Space};
use super::{Field, PointResult, Points, merge};
use crate::document::Diagnostic;
use crate::lanes::LANES;
use crate::loss::Extent;
use crate::transmission::Transmission;

/// Points of a piece that is no part of a grid.
const PIECE: usize = 1024;

/// Points that are solved at once: at least one piece, at most as many pieces as make this number.
const TOGETHER: usize = LANES * 1024;

/// The most solved points that are held while a field is solved piece by piece.
pub const MOST_HELD: usize = 2 * TOGETHER;

/// Points of a task, where a piece has more of them. Each begins anew, without what the speeds before say.
const TASK: usize = 2048;

/// Some points of a field that follow each other, solved.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Number of the piece among those of the field.
    pub number: usize,
    /// The points in the order of the field, in runs as they were solved: joining them would cost as much as solving some.
    runs: Vec<Vec<PointResult>>,
    /// What was seen of limits and observed quantities over these points.
    pub seen: Vec<Extent>,
}

impl Piece {
    /// A piece of points in the order of the field, and what was seen of limits and observed quantities over them.
    pub fn new(number: usize, points: Vec<PointResult>, seen: Vec<Extent>) -> Self {
        Self {
            number,
            runs: vec![points],
            seen,
        }
    }

    /// The points, in the order of the field.
    pub fn points(&self) -> impl Iterator<Item = &PointResult> + Clone {
        self.runs.iter().flatten()
    }

    /// The same, without the piece.
    pub fn into_points(self) -> impl Iterator<Item = PointResult> {
        self.runs.into_iter().flatten()
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.runs.iter().map(Vec::len).sum()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Field {
    /// Points of a piece. On a grid a piece is made of whole lines of one torque, so many that blocks of one speed are full
    /// where memory allows it.
    fn piece(&self) -> usize {
        match self {
            Self::Grid { speeds, .. } if (1..=TOGETHER).contains(&speeds.len()) => {
                speeds.len() * (TOGETHER / speeds.len()).min(LANES)
            }
            _ => PIECE,
        }
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.len().div_ceil(self.piece())
    }

    /// Numbers of the points of a piece.
    fn of_piece(&self, number: usize) -> Range<usize> {
        let piece = self.piece();
        number * piece..((number + 1) * piece).min(self.len())
    }

    /// The points of a piece in the order in which they are solved: those of one speed and oil one after the other.
    fn in_order(&self, number: usize) -> Vec<usize> {
        let own = self.of_piece(number);
        if let Self::Grid { speeds, .. } = self {
            let columns = own.start..(own.start + speeds.len()).min(own.end);
            return columns
                .flat_map(|first| (first..own.end).step_by(speeds.len()))
                .collect();
        }
        let mut numbers: Vec<usize> = own.collect();
        numbers.sort_by(|a, b| {
            let (a, b) = (self.at(*a), self.at(*b));
            let oil = |oil: Option<f64>| oil.unwrap_or(f64::NEG_INFINITY);
            a.speed.total_cmp(&b.speed).then(oil(a.oil).total_cmp(&oil(b.oil)))
        });
        numbers
    }
}

/// Solves the pieces of given numbers and hands them over in this order, so that no more points are held than
/// [`MOST_HELD`]: while some are taken, the next are solved. `progress` hears how many more are solved; where it or `take`
/// answers false the work is broken off, and so does this answer.
///
/// # Errors
/// If the case does not fit.
pub fn solve_pieces(
    transmission: &Transmission,
    points: &Points,
    numbers: &[usize],
    progress: &(dyn Fn(usize) -> bool + Sync),
    take: &mut dyn FnMut(Piece) -> bool,
) -> Result<bool, Vec<Diagnostic>> {
    let case = points.case(transmission)?;
    let solver = Solver::new(transmission, &case, points);
    let going = AtomicBool::new(true);
    let solve = |space: &mut Space, task: &[usize]| {
        if !going.load(Ordering::Relaxed) {
            return (Vec::new(), Vec::new());
        }
        let solved = solver.solve(task, space);
        if !progress(solved.len()) {
            going.store(false, Ordering::Relaxed);
        }
        (runs(solved, task), space.take_seen())
    };
    let solve_all = |numbers: &[usize]| -> Vec<Piece> {
        let orders: Vec<Vec<usize>> = numbers.iter().map(|number| points.field.in_order(*number)).collect();
        let tasks: Vec<&[usize]> = orders.iter().flat_map(|order| order.chunks(TASK)).collect();
        let mut solved: Vec<(Vec<Run>, Vec<Extent>)> =
            tasks.into_par_iter().map_init(|| solver.space(), solve).collect();
        let mut solved = solved.drain(..);
        let piece = |(number, order): (&usize, &Vec<usize>)| {
            let mut seen = Vec::new();
            let own = solved.by_ref().take(order.len().div_ceil(TASK));
            let mut runs = Vec::new();
            for (own, totals) in own {
                merge(&mut seen, &totals);
                runs.extend(own);
            }
            runs.sort_by_key(|(first, _)| *first);
            Piece {
                number: *number,
                runs: runs.into_iter().map(|(_, points)| points).collect(),
                seen,
            }
        };
        numbers.iter().zip(&orders).map(piece).collect()
    };
    let mut ready: Vec<Piece> = Vec::new();
    let mut groups = numbers.chunks((TOGETHER / points.field.piece()).max(1));
    loop {
        let next = groups.next();
        let mut solved = Vec::new();
        rayon::in_place_scope(|scope| {
            if let Some(next) = next {
                scope.spawn(|_| solved = solve_all(next));
            }
            if !ready.drain(..).all(&mut *take) {
                going.store(false, Ordering::Relaxed);
            }
        });
        if !going.load(Ordering::Relaxed) {
            return Ok(false);
        }
        if next.is_none() {
            return Ok(true);
        }
        ready = solved;
    }
}

/// The number of a point, and with it those that follow in the order of the field.
type Run = (usize, Vec<PointResult>);

/// The points of a task of given numbers as runs, while they are still in the caches.
fn runs(solved: Vec<PointResult>, numbers: &[usize]) -> Vec<Run> {
    let mut order: Vec<usize> = (0..solved.len()).collect();
    order.sort_by_key(|i| numbers[*i]);
    let mut solved: Vec<Option<PointResult>> = solved.into_iter().map(Some).collect();
    let run = |own: &[usize]| {
        let mut points = Vec::with_capacity(own.len());
        points.extend(own.iter().filter_map(|i| solved[*i].take()));
        (numbers[own[0]], points)
    };
    order.chunk_by(|a, b| numbers[*b] == numbers[*a] + 1).map(run).collect()
}
