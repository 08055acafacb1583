//! Many points: every torque at every speed of a grid, or a list.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::{OilTemperature, sums};
use crate::document::Diagnostic;
use crate::evaluate::{Point, PowerFlow};
use crate::flow::{Status, Tolerance};
use crate::loss::{Extent, MOST_TERMS, Undefined};
use crate::thermal::Outcome as ThermalOutcome;
use crate::transmission::{Case, Transmission};

/// Points per task; fixed, so that the bits do not hang on the number of threads.
const CHUNK: usize = 64;

/// Points of a piece; a multiple of those of a task.
const PIECE: usize = 16 * CHUNK;

/// Pieces that are solved together.
const TOGETHER: usize = 16;

/// The most solved points that are held while a field is solved piece by piece.
pub const MOST_HELD: usize = 2 * TOGETHER * PIECE;

/// The points of a grid and how they are prescribed.
#[derive(Debug, Clone)]
pub struct Points {
    /// Gear state.
    pub gear: String,
    /// Ports with given torque: that of the points at the first, none at the others. Those that the gear state has no use for
    /// are left out.
    pub torque_at: Vec<String>,
    /// Ports with given speed: that of the points at the first; the others stand still.
    pub speed_at: Vec<String>,
    /// Torques and speeds.
    pub field: Field,
    /// Temperature of the oil where the list gives none.
    pub oil: OilTemperature,
    /// Real or ideal flow.
    pub flow: PowerFlow,
    /// Whether losses are kept term by term.
    pub terms: bool,
}

/// Torque and speed of one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Temperature of the oil at this point; absent, that of all. \[degC\]
    pub oil: Option<f64>,
}

impl Given {
    fn on_grid(torques: &[f64], speeds: &[f64], place: usize) -> Self {
        Self {
            torque: torques[place / speeds.len()],
            speed: speeds[place % speeds.len()],
            oil: None,
        }
    }
}

/// Torques and speeds of many points.
#[derive(Debug, Clone, PartialEq)]
pub enum Field {
    /// Every torque at every speed; torques outside, speeds inside.
    Grid {
        /// Torques. \[Nm\]
        torques: Vec<f64>,
        /// Speeds. \[rad/s\]
        speeds: Vec<f64>,
    },
    /// Some places of such a grid.
    Part {
        /// Torques. \[Nm\]
        torques: Vec<f64>,
        /// Speeds. \[rad/s\]
        speeds: Vec<f64>,
        /// Numbers of the places, rising.
        places: Arc<[u32]>,
    },
    /// One after the other.
    List(Vec<Given>),
}

impl Field {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Self::Grid { torques, speeds } => torques.len() * speeds.len(),
            Self::Part { places, .. } => places.len(),
            Self::List(list) => list.len(),
        }
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A point by its number.
    ///
    /// # Panics
    /// If there are not as many points: a bug of the caller.
    pub fn at(&self, i: usize) -> Given {
        match self {
            Self::Grid { torques, speeds } => Given::on_grid(torques, speeds, i),
            Self::Part {
                torques,
                speeds,
                places,
            } => Given::on_grid(torques, speeds, places[i] as usize),
            Self::List(list) => list[i],
        }
    }

    /// The place on the grid of a point by its number; the number itself for a list.
    pub fn place(&self, i: usize) -> usize {
        match self {
            Self::Part { places, .. } => places[i] as usize,
            _ => i,
        }
    }
}

/// One solved point, as numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct PointResult {
    /// Given torque. \[Nm\]
    pub torque: f64,
    /// Given speed. \[rad/s\]
    pub speed: f64,
    /// Speed of the port at which the torque is given; zero where none is. \[rad/s\]
    pub torque_speed: f64,
    /// Speed of the reference port. \[rad/s\]
    pub reference_speed: f64,
    /// Speed of the other port, where there are two. \[rad/s\]
    pub output_speed: Option<f64>,
    /// Whether the torque is given at the reference port.
    pub at_reference: bool,
    /// Temperature of the oil; absent where no balance was found, and with it everything that hangs on it. \[degC\]
    pub oil: Option<f64>,
    /// Temperature of the surface, where it was found by balance. \[degC\]
    pub surface: Option<f64>,
    /// What became of the balance, where the temperature is not given.
    pub balance: Option<ThermalOutcome>,
    /// Temperatures of the nodes of a thermal network; none without one. \[degC\]
    pub nodes: Vec<f64>,
    /// What the transmission does.
    pub status: Status,
    /// Power out over power in.
    pub efficiency: Option<f64>,
    /// Sum of all losses. \[W\]
    pub loss: Option<f64>,
    /// Loss over the speed of the reference port. \[Nm\]
    pub loss_torque: Option<f64>,
    /// Power in. \[W\]
    pub input: Option<f64>,
    /// Power out. \[W\]
    pub output: Option<f64>,
    /// The usual sums, in the order of [`super::SUMS`]. \[W\]
    pub sums: [f64; 6],
    /// Losses of all parts, in the order of the parts. \[W\]
    pub parts: Vec<f64>,
    /// The same by the terms of their models, where that was asked for. \[W\]
    pub terms: Vec<[f64; MOST_TERMS]>,
    /// True where a model left its stated range.
    pub outside: bool,
    /// Why a loss has no value: number of the part and the reason.
    pub undefined: Option<(usize, Undefined)>,
    /// Passes over the loss models.
    pub passes: usize,
    /// Evaluations of the point on the way to its temperature.
    pub evaluations: usize,
}

impl PointResult {
    /// Without all that hangs on a temperature that was not found.
    fn without_temperature(self) -> Self {
        Self {
            oil: None,
            nodes: Vec::new(),
            efficiency: None,
            loss: None,
            loss_torque: None,
            input: None,
            output: None,
            sums: [0.0; 6],
            parts: vec![0.0; self.parts.len()],
            terms: Vec::new(),
            ..self
        }
    }
}

/// Solved points.
#[derive(Debug, Clone, Default)]
pub struct GridResult {
    /// The points, in the order of the field.
    pub points: Vec<PointResult>,
    /// What was seen of limits and observed quantities over all points.
    pub seen: Vec<Extent>,
    /// Wall time is no result; calls of loss models are: the sum of passes.
    pub passes: usize,
}

impl Points {
    /// The case of these points.
    ///
    /// # Errors
    /// If the gear state or a port is unknown, or the prescription does not fit.
    pub fn case(&self, transmission: &Transmission) -> Result<Case, Vec<Diagnostic>> {
        let state = transmission.state(&self.gear).map_err(|e| vec![e])?;
        let needed = transmission.torques_needed(state);
        let torques: Vec<&str> = self.torque_at.iter().map(String::as_str).take(needed).collect();
        let speeds: Vec<&str> = self.speed_at.iter().map(String::as_str).collect();
        transmission.case(&self.gear, &speeds, &torques)
    }
}

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

/// Solves all points and holds them. `progress` hears how many more are solved; where it answers false the work is broken
/// off, and there is no result.
///
/// # Errors
/// If the case does not fit.
pub fn run_grid(
    transmission: &Transmission,
    points: &Points,
    progress: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Option<GridResult>, Vec<Diagnostic>> {
    let count = points.field.len();
    let numbers: Vec<usize> = (0..pieces(count)).collect();
    let mut all = GridResult::default();
    let whole = solve_pieces(transmission, points, &numbers, progress, &mut |piece| {
        all.add(piece);
        true
    })?;
    Ok(whole.then_some(all))
}

impl GridResult {
    /// Adds the piece that follows.
    pub fn add(&mut self, piece: Piece) {
        merge(&mut self.seen, &piece.seen);
        self.passes += piece.points.iter().map(|p| p.passes).sum::<usize>();
        self.points.extend(piece.points);
    }
}

/// Adds what was seen of limits and observed quantities to what was seen before; both in the order of one transmission.
pub fn merge(total: &mut Vec<Extent>, more: &[Extent]) {
    if total.is_empty() {
        total.extend_from_slice(more);
    } else {
        for (a, b) in total.iter_mut().zip(more) {
            *a = a.merge(*b);
        }
    }
}
