//! Points of a thermal network: each is evaluated at several temperatures, together with others or as a single one, and what the network
//! reads is copied, so that the next evaluation of the point may be in another lane.

use std::cell::Cell;

use super::{BatchScratch, Noting, Point, Scratch};
use crate::flow::{Last, Start, Status};
use crate::loss::{Extent, Loss, Seen, nanowatts};
use crate::real::{LANES, Lane, Mask as _, Points};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Minimum number of points that are evaluated in lanes: with the most expensive models, full lanes take the time of six single points.
const FEW: usize = 6;

/// What is copied of an evaluated point.
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    /// Losses of all parts. \[W\]
    pub watts: Vec<f64>,
    /// Speeds of the members. \[rad/s\]
    pub speeds: Vec<f64>,
    /// Torques that ports apply, by member. \[Nm\]
    pub port_torques: Vec<f64>,
    /// Share of the heat of each mesh that enters its first gear.
    pub first_heat: Vec<f64>,
    /// Flow of oil through each element of the oil network. \[m3/s\]
    pub oil_flows: Vec<f64>,
    /// Input and output power. \[W\]
    pub power: [f64; 2],
    /// Operating state.
    pub status: Status,
    /// Notes of the models.
    cells: Vec<Seen>,
    last: Last,
}

/// A point to be evaluated at temperatures of its own.
pub(crate) struct Asked<'a> {
    pub point: Point<'a>,
    /// Of the nodes. \[degC\]
    pub temperatures: &'a [f64],
    /// With [`Start::Last`], that of its last evaluation.
    pub snapshot: &'a mut Snapshot,
}

impl Snapshot {
    /// Speeds of the members (rad/s), flows of the oil network (m3/s), and the note cells of heat models.
    pub(crate) fn flows_and_cells(&mut self) -> (&[f64], &[f64], &[Cell<Seen>]) {
        let cells = Cell::from_mut(self.cells.as_mut_slice()).as_slice_of_cells();
        (&self.speeds, &self.oil_flows, cells)
    }

    /// Limits that are exceeded: cell of the notes and loss of a component that uses the model. \[W\]
    pub fn lost_outside<'a>(&'a self, transmission: &'a Transmission) -> impl Iterator<Item = (usize, f64)> + 'a {
        let limited = transmission.limited.iter();
        let exceeded = limited.filter(|(cell, _)| self.cells[*cell].outside() != 0);
        exceeded.map(|(cell, part)| (*cell, self.watts[*part]))
    }

    /// Counts the observations among those of all points.
    pub fn count(&self, transmission: &Transmission, totals: &mut [Extent]) {
        for (total, seen) in totals.iter_mut().zip(&self.cells) {
            total.count(*seen);
        }
        for (cell, watts) in self.lost_outside(transmission) {
            let total = &mut totals[cell].lost_outside;
            *total = total.saturating_add(nanowatts(watts));
        }
    }
}

impl<R: Points> Scratch<R> {
    /// Copies one of the evaluated points.
    fn copy_point(&self, point: usize, to: &mut Snapshot) {
        let copy = |to: &mut Vec<f64>, from: &[R]| {
            to.clear();
            to.extend(from.iter().map(|x| x.at_point(point)));
        };
        let c = &self.models.conditions;
        copy(&mut to.watts, &self.watts);
        copy(&mut to.speeds, &c.speeds);
        copy(&mut to.port_torques, &self.work.ports);
        to.oil_flows.clear();
        let supplies = c.hydraulics.supplies.iter();
        to.oil_flows.extend(supplies.map(|supply| supply.flow.at_point(point)));
        to.first_heat.clear();
        let shares = self.models.mesh_losses.iter();
        let share = |loss: &Loss<R>| loss.first_heat().at_point(point);
        to.first_heat
            .extend(shares.map(|loss| loss.as_ref().map_or(0.5, share)));
        to.power = [self.balance.input.at_point(point), self.balance.output.at_point(point)];
        to.status = self.status[point];
        to.cells.clear();
        to.cells.extend(c.cells.iter().map(|cell| cell.get().at_point(point)));
        self.work.copy_last(point, &mut to.last);
    }
}

impl Transmission {
    /// Evaluates points at temperatures of each, together where that is faster, each with the numbers that it has as a single one. They
    /// have the power flow of the first. \[degC\]
    ///
    /// Each is a copy, or why there are no losses. Points that are evaluated together have noted the range of all of them.
    pub fn snapshots<'t>(
        &self,
        case: &Case,
        points: &[Point<'_>],
        temperatures: &dyn Fn(usize) -> &'t [f64],
        noting: Noting,
        scratch: &mut BatchScratch,
    ) -> Vec<Result<Snapshot, Unbalanced>> {
        let mut snapshots = vec![Snapshot::default(); points.len()];
        let asked = points.iter().zip(&mut snapshots).enumerate();
        let mut asked: Vec<Asked<'_>> = asked
            .map(|(i, (point, snapshot))| Asked {
                point: *point,
                temperatures: temperatures(i),
                snapshot,
            })
            .collect();
        let results = self.evaluate_each(case, &mut asked, Start::Lossless, noting, scratch);
        let pairs = results.into_iter().zip(snapshots);
        pairs.map(|(result, snapshot)| result.map(|()| snapshot)).collect()
    }

    /// Evaluates a point at temperatures as one of [`Transmission::snapshots`]. \[degC\]
    ///
    /// # Errors
    /// Why there are no losses.
    pub fn snapshot(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperatures: &[f64],
        noting: Noting,
        scratch: &mut BatchScratch,
    ) -> Result<Snapshot, Unbalanced> {
        let mut snapshot = Snapshot::default();
        let mut asked = Asked {
            point: *point,
            temperatures,
            snapshot: &mut snapshot,
        };
        self.evaluate_one(case, &mut asked, Start::Lossless, noting, &mut scratch.alone)?;
        Ok(snapshot)
    }

    /// Evaluates a point.
    ///
    /// # Errors
    /// Why there are no losses.
    pub(crate) fn evaluate_one(
        &self,
        case: &Case,
        asked: &mut Asked<'_>,
        start: Start,
        noting: Noting,
        scratch: &mut Scratch,
    ) -> Result<(), Unbalanced> {
        if start == Start::Last {
            scratch.work.resume(|_| &asked.snapshot.last);
        }
        self.try_point_from(start, case, &asked.point, asked.temperatures, scratch, noting)?;
        scratch.copy_point(0, asked.snapshot);
        Ok(())
    }

    /// Evaluates points with the power flow of the first, each with the numbers that it has as a single one.
    pub(crate) fn evaluate_each(
        &self,
        case: &Case,
        asked: &mut [Asked<'_>],
        start: Start,
        noting: Noting,
        scratch: &mut BatchScratch,
    ) -> Vec<Result<(), Unbalanced>> {
        let mut results = Vec::with_capacity(asked.len());
        for some in asked.chunks_mut(LANES) {
            let solved = if some.len() < FEW {
                0
            } else {
                let s = scratch.together.get_or_insert_with(|| Scratch::new(self, case));
                self.evaluate_lanes(case, some, start, noting, s)
            };
            results.extend(some.iter_mut().enumerate().map(|(lane, own)| {
                if solved >> lane & 1 == 1 {
                    Ok(())
                } else {
                    self.evaluate_one(case, own, start, noting, &mut scratch.alone)
                }
            }));
        }
        results
    }

    /// Evaluates points in lanes. Returns a bit for each point that did not leave.
    fn evaluate_lanes(
        &self,
        case: &Case,
        asked: &mut [Asked<'_>],
        start: Start,
        noting: Noting,
        s: &mut Scratch<Lane>,
    ) -> u32 {
        let points: Vec<Point<'_>> = asked.iter().map(|own| own.point).collect();
        let last = |lane: usize| (start == Start::Last).then(|| &asked[lane].snapshot.last);
        self.solve_together(case, &points, &|lane| asked[lane].temperatures, &last, noting, s);
        let live = s.models.conditions.live;
        let mut solved = 0;
        for (lane, own) in asked.iter_mut().enumerate() {
            if live.at_point(lane) && s.status[lane].has_flow() {
                s.copy_point(lane, own.snapshot);
                solved |= 1 << lane;
            }
        }
        solved
    }
}
