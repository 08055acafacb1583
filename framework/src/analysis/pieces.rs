//! Many points, solved in parallel piece by piece, so that few of them are held.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::{Given, OilTemperature, PointResult, Points, merge, sums};
use crate::document::Diagnostic;
use crate::evaluate::Point;
use crate::flow::Tolerance;
use crate::loss::Extent;
use crate::transmission::{Case, Transmission};

/// Points per task; fixed, so that the bits do not hang on the number of threads.
const CHUNK: usize = 64;

/// Points of a piece; a multiple of those of a task.
const PIECE: usize = 16 * CHUNK;

/// Pieces that are solved together.
const TOGETHER: usize = 16;

/// The most solved points that are held while a field is solved piece by piece.
pub const MOST_HELD: usize = 2 * TOGETHER * PIECE;

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

/// Number of pieces of as many points.
pub fn pieces(points: usize) -> usize {
    points.div_ceil(PIECE)
}

/// Numbers of the points of a piece, of as many points.
fn of_piece(number: usize, count: usize) -> Range<usize> {
    number * PIECE..((number + 1) * PIECE).min(count)
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
    let going = AtomicBool::new(true);
    let solve = |chunk: Range<usize>| {
        if !going.load(Ordering::Relaxed) {
            return (Vec::new(), Vec::new());
        }
        let solved = solve_chunk(transmission, &case, points, chunk);
        if !progress(solved.0.len()) {
            going.store(false, Ordering::Relaxed);
        }
        solved
    };
    let solve_all = |numbers: &[usize]| -> Vec<Piece> {
        let count = points.field.len();
        let chunks = |number: &usize| {
            let own = of_piece(*number, count);
            let end = own.end;
            own.step_by(CHUNK).map(move |start| start..(start + CHUNK).min(end))
        };
        let chunks: Vec<Range<usize>> = numbers.iter().flat_map(chunks).collect();
        let mut solved: Vec<(Vec<PointResult>, Vec<Extent>)> = chunks.into_par_iter().map(solve).collect();
        let mut solved = solved.drain(..);
        let piece = |number: &usize| {
            let own = of_piece(*number, count);
            let mut piece = Piece {
                number: *number,
                points: Vec::with_capacity(own.len()),
                seen: Vec::new(),
            };
            for (points, totals) in solved.by_ref().take(own.len().div_ceil(CHUNK)) {
                merge(&mut piece.seen, &totals);
                piece.points.extend(points);
            }
            piece
        };
        numbers.iter().map(piece).collect()
    };
    let mut ready: Vec<Piece> = Vec::new();
    let mut groups = numbers.chunks(TOGETHER);
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

/// Solves points that follow each other, with what was seen over them.
fn solve_chunk(
    transmission: &Transmission,
    case: &Case,
    points: &Points,
    chunk: Range<usize>,
) -> (Vec<PointResult>, Vec<Extent>) {
    let mut scratch = transmission.scratch(case);
    let member = |port: usize| transmission.ports()[port].member;
    let at_torque = case.torque_ports.first().map(|port| member(*port));
    let reference = member(transmission.reference_port());
    let other = match transmission.ports() {
        [_, _] => Some(member(1 - transmission.reference_port())),
        _ => None,
    };
    let at_reference = case.torque_ports.first() == Some(&transmission.reference_port());
    let mut torques = vec![0.0; case.torque_ports.len()];
    let mut speeds = vec![0.0; case.speed_ports.len()];
    let results = chunk
        .map(|i| {
            let Given { torque, speed, oil } = points.field.at(i);
            for (value, first) in [(torque, torques.first_mut()), (speed, speeds.first_mut())] {
                if let Some(first) = first {
                    *first = value;
                }
            }
            let point = Point {
                speeds: &speeds,
                torques: &torques,
                flow: points.flow,
                tolerance: Tolerance::default(),
            };
            let wanted = oil.map_or(points.oil, OilTemperature::Fixed);
            let warm = wanted.find(transmission, case, &point, &mut scratch);
            let solution = transmission.evaluate(case, &point, warm.temperatures(), &mut scratch);
            let mut totals = [0.0; 6];
            let mut terms = Vec::new();
            for (part, loss) in solution.parts() {
                sums::add(&mut totals, transmission, part, &loss);
                if points.terms {
                    terms.push(std::array::from_fn(|k| loss.term_watts(k)));
                }
            }
            let result = PointResult {
                torque,
                speed,
                torque_speed: at_torque.map_or(0.0, |member| solution.speed(member)),
                reference_speed: solution.speed(reference),
                output_speed: other.map(|member| solution.speed(member)),
                at_reference,
                oil: Some(warm.oil),
                surface: warm.balance.as_ref().and_then(|b| b.surface),
                balance: warm.outcome(),
                evaluations: warm.evaluations(),
                nodes: warm
                    .network
                    .as_ref()
                    .map(|n| n.temperatures.clone())
                    .unwrap_or_default(),
                status: solution.status(),
                efficiency: solution.efficiency(),
                loss: solution.loss(),
                loss_torque: solution.loss_torque(),
                input: solution.input_power(),
                output: solution.output_power(),
                sums: totals,
                parts: solution.watts().to_vec(),
                terms,
                outside: solution.extents().iter().any(|e| e.outside > 0),
                undefined: solution.undefined_part(),
                passes: solution.passes(),
            };
            if warm.is_sound() {
                result
            } else {
                result.without_temperature()
            }
        })
        .collect();
    (results, scratch.totals)
}
