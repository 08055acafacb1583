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
    /// The points, in the order of the field.
    pub points: Vec<PointResult>,
    /// What was seen of limits and observed quantities over these points.
    pub seen: Vec<Extent>,
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
        (in_place(solved, task), space.take_seen())
    };
    let solve_all = |numbers: &[usize]| -> Vec<Piece> {
        let orders: Vec<Vec<usize>> = numbers.iter().map(|number| points.field.in_order(*number)).collect();
        let tasks: Vec<&[usize]> = orders.iter().flat_map(|order| order.chunks(TASK)).collect();
        let mut solved: Vec<(Vec<(usize, PointResult)>, Vec<Extent>)> =
            tasks.into_par_iter().map_init(|| solver.space(), solve).collect();
        let mut solved = solved.drain(..);
        let piece = |(number, order): (&usize, &Vec<usize>)| {
            let mut seen = Vec::new();
            let own = solved.by_ref().take(order.len().div_ceil(TASK));
            let parts = own.map(|(points, totals)| {
                merge(&mut seen, &totals);
                points
            });
            let parts = parts.collect();
            Piece {
                number: *number,
                points: joined(parts, points.field.of_piece(*number)),
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

/// Solved points of a task by their numbers, which here are still in the caches.
fn in_place(solved: Vec<PointResult>, numbers: &[usize]) -> Vec<(usize, PointResult)> {
    let mut order: Vec<usize> = (0..solved.len()).collect();
    order.sort_by_key(|i| numbers[*i]);
    let mut solved: Vec<Option<PointResult>> = solved.into_iter().map(Some).collect();
    order
        .into_iter()
        .filter_map(|i| Some((numbers[i], solved[i].take()?)))
        .collect()
}

/// The points of all tasks of a piece, each in the order of the field, as one list.
fn joined(parts: Vec<Vec<(usize, PointResult)>>, numbers: Range<usize>) -> Vec<PointResult> {
    let mut points = Vec::with_capacity(numbers.len());
    let mut parts: Vec<_> = parts.into_iter().map(|part| part.into_iter().peekable()).collect();
    let mut next = numbers.start;
    // What was broken off has no points.
    while parts.iter().any(|part| part.len() > 0) {
        let before = next;
        for part in &mut parts {
            while let Some((_, point)) = part.next_if(|(number, _)| *number == next) {
                points.push(point);
                next += 1;
            }
        }
        if next == before {
            break;
        }
    }
    points
}
