//! Batches: several points that are solved together.
//!
//! A [`Batch`] has the same speeds and temperatures and differs in one torque: speeds, oils and all values that depend only on them,
//! including notes, are computed once. [`Transmission::evaluate_together`] takes points with a speed, torque and temperature each. The
//! numbers of a point are those of [`Transmission::evaluate`] to the bit, whatever the other points are.

use std::cell::Cell;

use super::{Noting, Point, Scratch, Solution};
use crate::attach::Oil;
use crate::flow::{Balance, Last, Start, Status, Tolerance};
use crate::loss::{Extent, Loss, Undefined};
use crate::real::{LANES, Lane, Mask as _, Points as _, Real as _};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Minimum number of points that are solved together; fewer are faster one by one.
const FEW: usize = 4;

/// Workspace for the points of one case, in batches and one by one; each part is allocated once, when it is needed.
#[derive(Debug, Clone)]
pub struct BatchScratch {
    /// Values that are common to the points of a batch.
    settled: Option<Scratch>,
    pub(super) together: Option<Scratch<Lane>>,
    /// For points that are solved one by one.
    pub(super) alone: Scratch,
}

impl BatchScratch {
    /// Observed extents of every limit and observed quantity since the last call, one count per point.
    pub fn take_totals(&mut self) -> Vec<Extent> {
        let mut totals = self.alone.take_totals();
        if let Some(together) = &mut self.together {
            for (total, seen) in totals.iter_mut().zip(together.take_totals()) {
                *total = seen.merge(*total);
            }
        }
        totals
    }

    /// Workspace for points that are solved one by one.
    pub fn alone(&mut self) -> &mut Scratch {
        &mut self.alone
    }

    /// Number of loss model evaluations for all points so far.
    pub fn calls(&self) -> usize {
        let settled = self.settled.as_ref().map_or(0, Scratch::all_calls);
        let together = self.together.as_ref().map_or(0, Scratch::all_calls);
        settled + together + self.alone.all_calls()
    }
}

/// Points that differ in the first given torque.
pub struct Batch<'a> {
    transmission: &'a Transmission,
    case: &'a Case,
    point: Point<'a>,
    temperatures: &'a [f64],
    settled: &'a mut Scratch,
    together: &'a mut Scratch<Lane>,
    alone: &'a mut Scratch,
}

impl Transmission {
    /// Workspace for evaluating the batches of a case; one per thread.
    pub fn batch_scratch(&self, case: &Case) -> BatchScratch {
        BatchScratch {
            settled: None,
            together: None,
            alone: self.scratch(case),
        }
    }

    /// Prepares a batch of points at the temperatures of the nodes, or at one for all nodes. \[degC\]
    ///
    /// # Panics
    /// As [`Transmission::evaluate`], and if the case gives no torque: bugs of the caller.
    pub fn batch<'a>(
        &'a self,
        case: &'a Case,
        point: &Point<'a>,
        temperatures: &'a [f64],
        scratch: &'a mut BatchScratch,
    ) -> Batch<'a> {
        assert!(!case.torque_ports.is_empty(), "a case that gives a torque");
        let BatchScratch {
            settled,
            together,
            alone,
        } = scratch;
        let settled = settled.get_or_insert_with(|| self.scratch(case));
        let together = together.get_or_insert_with(|| Scratch::new(self, case));
        self.settle(case, point, temperatures, settled, Noting::Seen);
        together.take_settled(settled);
        Batch {
            transmission: self,
            case,
            point: *point,
            temperatures,
            settled,
            together,
            alone,
        }
    }

    /// Solves points with a speed, torque and temperature each, at most [`LANES`]; they have the power flow of the first.
    /// \[degC\]
    ///
    /// # Panics
    /// If there are none or too many, or as [`Transmission::evaluate`]: bugs of the caller.
    pub fn evaluate_together<'s, 't>(
        &'s self,
        case: &Case,
        points: &[Point<'_>],
        temperatures: &dyn Fn(usize) -> &'t [f64],
        noting: Noting,
        scratch: &'s mut BatchScratch,
    ) -> Block<'s> {
        // With a generic closure each crate that calls this would compile the whole evaluation once more.
        assert!((1..=LANES).contains(&points.len()), "1 to {LANES} points");
        let s = scratch.together.get_or_insert_with(|| Scratch::new(self, case));
        self.solve_together(case, points, temperatures, &|_| None, noting, s);
        Block { transmission: self, s }
    }

    /// The same, each from the losses of its last solve, if there are any.
    pub(super) fn solve_together<'t>(
        &self,
        case: &Case,
        points: &[Point<'_>],
        temperatures: &dyn Fn(usize) -> &'t [f64],
        last: &dyn Fn(usize) -> Option<&'t Last>,
        noting: Noting,
        s: &mut Scratch<Lane>,
    ) {
        // Lanes without a point repeat the last one and are not read.
        let own = |lane: usize| lane.min(points.len() - 1);
        // Ports beyond those of the case have speeds and torques added by rules, which are zero.
        let value = |values: &[f64], port: usize| values.get(port).copied().unwrap_or(0.0);
        for (port, speed) in s.prescribed.iter_mut().enumerate() {
            *speed = Lane::each(|lane| value(points[own(lane)].speeds, port));
        }
        for (port, torque) in s.work.given.iter_mut().enumerate() {
            *torque = Lane::each(|lane| value(points[own(lane)].torques, port));
        }
        let c = &mut s.models.conditions;
        c.temperatures.resize(temperatures(0).len(), Lane::ZERO);
        for (node, temperature) in c.temperatures.iter_mut().enumerate() {
            *temperature = Lane::each(|lane| temperatures(own(lane))[node]);
        }
        c.common = false;
        c.live = Lane::mask(|lane| lane < points.len());
        let same = |lane: usize| {
            let mut values = s.prescribed.iter().chain(&c.temperatures);
            values.all(|value| value[lane].to_bits() == value[lane - 1].to_bits())
        };
        let starts = Lane::bits(Lane::mask(|lane| lane == 0 || !same(lane)));
        self.settle_prescribed(case, s, starts, noting);
        let mut start = Start::Lossless;
        if let Some(first) = last(0) {
            start = Start::Last;
            let alike = s.work.resume(|lane| last(own(lane)).unwrap_or(first));
            let c = &mut s.models.conditions;
            c.live = c.live & alike;
        }
        let tolerance = Tolerance {
            power: Lane::each(|lane| points[own(lane)].tolerance.power),
            ..points[0].tolerance.everywhere()
        };
        self.solve_settled(case, (points[0].flow, tolerance), start, s, noting);
    }

    /// The losses of points by number at temperatures, as [`Transmission::probe`]. \[degC, W\]
    pub(crate) fn probe_all(
        &self,
        case: &Case,
        points: &[Point<'_>],
        asked: &[(usize, f64)],
        scratch: &mut BatchScratch,
    ) -> Vec<Result<f64, Unbalanced>> {
        let mut losses = Vec::with_capacity(asked.len());
        for asked in asked.chunks(LANES) {
            let first = losses.len();
            let mut alone = Lane::mask(|_| true);
            if asked.len() >= FEW {
                let own: [Point<'_>; LANES] = std::array::from_fn(|lane| points[asked[lane.min(asked.len() - 1)].0]);
                let temperature = |lane: usize| std::slice::from_ref(&asked[lane].1);
                let block = self.evaluate_together(case, &own[..asked.len()], &temperature, Noting::Muted, scratch);
                losses.extend((0..asked.len()).map(|lane| Ok(block.losses()[lane])));
                alone = Lane::mask(|lane| block.is_alone(lane));
            } else {
                losses.resize(first + asked.len(), Ok(0.0));
            }
            for (lane, (point, temperature)) in asked.iter().enumerate().filter(|(lane, _)| alone.at_point(*lane)) {
                losses[first + lane] = self.probe(case, &points[*point], &[*temperature], &mut scratch.alone);
            }
        }
        losses
    }
}

impl Batch<'_> {
    /// Solves the points with these first torques together, at most [`LANES`]. \[Nm\]
    ///
    /// # Panics
    /// If there are none or too many: a bug of the caller.
    pub fn solve(&mut self, torques: &[f64]) -> Block<'_> {
        assert!((1..=LANES).contains(&torques.len()), "1 to {LANES} torques");
        let together = &mut *self.together;
        // Lanes without a point repeat the last one and are not read.
        let last = torques.len() - 1;
        together.work.given[0] = Lane::each(|point| torques[point.min(last)]);
        together.begin_block(self.settled, torques.len());
        let law = (self.point.flow, self.point.tolerance.everywhere());
        self.transmission
            .solve_settled(self.case, law, Start::Lossless, together, Noting::Counted);
        Block {
            transmission: self.transmission,
            s: together,
        }
    }

    /// Solves a single point of the batch.
    pub fn alone(&mut self, torque: f64) -> Solution<'_> {
        let torques = &mut self.settled.work.given[..self.point.torques.len()];
        torques[0] = torque;
        let point = Point { torques, ..self.point };
        self.transmission
            .evaluate(self.case, &point, self.temperatures, self.alone)
    }
}

impl Scratch<Lane> {
    /// Takes over what is common to the points of a batch.
    fn take_settled(&mut self, settled: &Scratch) {
        fn spread(own: &mut [Lane], settled: &[f64]) {
            for (own, settled) in own.iter_mut().zip(settled) {
                *own = Lane::constant(*settled);
            }
        }
        fn losses(own: &mut [Result<Loss<Lane>, Undefined>], settled: &[Result<Loss, Undefined>]) {
            for (own, settled) in own.iter_mut().zip(settled) {
                *own = settled.as_ref().map(Loss::everywhere).map_err(|reason| *reason);
            }
        }
        let (own, from) = (&mut self.models, &settled.models);
        let (c, common) = (&mut own.conditions, &from.conditions);
        spread(&mut c.speeds, &common.speeds);
        c.temperatures.resize(common.temperatures.len(), Lane::ZERO);
        spread(&mut c.temperatures, &common.temperatures);
        for (own, oil) in c.oils.iter_mut().zip(&common.oils) {
            *own = Oil::of_properties(oil.properties().map(Lane::constant));
        }
        c.surface = Lane::constant(common.surface);
        c.rest = Lane::constant(common.rest);
        c.hydraulics.take_common(&common.hydraulics);
        c.common = true;
        c.forget();
        spread(&mut own.closings, &from.closings);
        spread(&mut own.relative, &from.relative);
        own.rests.clone_from(&from.rests);
        losses(&mut own.component_losses, &from.component_losses);
        losses(&mut own.drag_losses, &from.drag_losses);
        spread(&mut self.work.speeds, &settled.work.speeds);
        spread(&mut self.work.steady, &settled.work.steady);
        spread(&mut self.work.given, &settled.work.given);
        self.standing = settled.standing;
    }

    /// Starts the next points of a batch with its common notes.
    fn begin_block(&mut self, settled: &Scratch, points: usize) {
        let c = &mut self.models.conditions;
        c.live = Lane::mask(|point| point < points);
        let bits = Lane::bits(c.live);
        let common = settled.models.conditions.cells.iter().map(Cell::get);
        for (own, common) in c.cells.iter().zip(common) {
            own.set(common.for_points(bits));
        }
        // A model that is undefined without load is so at every point, which is solved alone for the reason.
        let losses = settled
            .models
            .component_losses
            .iter()
            .chain(&settled.models.drag_losses);
        if losses.clone().any(Result::is_err) {
            c.live = Lane::mask(|_| false);
        }
    }
}

/// Points that were solved together.
pub struct Block<'a> {
    transmission: &'a Transmission,
    s: &'a Scratch<Lane>,
}

impl Block<'_> {
    /// True if a point must be solved by [`Batch::alone`]: it takes another branch than the others, or a loss of it is undefined. Its
    /// other results are then undefined.
    pub fn is_alone(&self, point: usize) -> bool {
        !self.s.models.conditions.live.at_point(point)
    }

    /// Operating state of the transmission.
    pub fn status(&self, point: usize) -> Status {
        self.s.status[point]
    }

    /// Input and output power. \[W\]
    pub fn balance(&self, point: usize) -> Balance {
        self.s.balance.at_point(point)
    }

    /// Output power, as [`Solution::output_power`]. \[W\]
    pub fn output_power(&self, point: usize) -> Option<f64> {
        self.s.output_power(point)
    }

    /// Sums of all losses. \[W\]
    pub fn losses(&self) -> &Lane {
        &self.s.sum
    }

    /// Losses of all parts, in their order. \[W\]
    pub fn watts(&self) -> &[Lane] {
        &self.s.watts
    }

    /// Power of one term of a part, all copies. \[W\]
    pub fn term_watts(&self, part: usize, term: usize) -> Lane {
        Lane::wide(
            #[inline(always)]
            || self.transmission.term_watts(part, term, self.s),
        )
    }

    /// True if a model is outside its stated range.
    pub fn leaves_a_range(&self, point: usize) -> bool {
        let models = self.transmission.rated_cells();
        self.s.models.conditions.leaves_a_range(point, models)
    }

    /// Evaluations of the laws of the loop of torques and losses that needs the most; one without loops.
    pub fn passes(&self, point: usize) -> usize {
        self.s.passes[point] as usize
    }

    /// Torques that a port of a member applies. \[Nm\]
    pub fn port_torques(&self, member: usize) -> &Lane {
        &self.s.work.ports[member]
    }

    /// Speeds of a member by number. \[rad/s\]
    pub fn speeds(&self, member: usize) -> &Lane {
        &self.s.models.conditions.speeds[member]
    }
}
