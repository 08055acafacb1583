//! The choice of gears in a simulated cycle.
//!
//! What an interval draws is evaluated in every gear at the temperatures at its start, or, while intervals are simulated together, at those
//! of the first of them if the choice does not depend on the difference. Where the simulation asks for the same point at the same
//! temperatures, it takes over what was evaluated in the chosen gear.

use std::collections::VecDeque;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Noting, Point, Snapshot};
use gearloss_framework::machine::Machine;
use gearloss_framework::real::LANES;
use gearloss_framework::transmission::Transmission;
use serde::{Deserialize, Serialize};

use super::{
    Asked, At, Cases, Driven, Ride, Settled, around, ask, drive_through, limited, point_of, steady_temperatures, wheels,
};
use crate::codes;
use crate::duty::{Demand, Interval, ShiftMap, Vehicle};
use crate::points::gear_rule::{Offer, Pick, Rule, Shifting, energy, least_energy};
use crate::points::{Found, OilTemperature};

/// How the gears of a cycle are chosen.
#[derive(Debug, Clone)]
pub struct GearChoice {
    /// What chooses them.
    pub by: ChosenBy,
    /// Gears among which to choose; empty: all that turn the wheels in the direction of the first one.
    pub among: Vec<String>,
    /// Energy that a shift dissipates; absent: from the moments of inertia. \[J\]
    pub shift_energy: Option<f64>,
    /// Energy of the actuator for each shift. \[J\]
    pub actuation: f64,
    /// Maximum speed of the reference port. \[rad/s\]
    pub most_speed: Option<f64>,
    /// Maximum torque of the reference port. \[Nm\]
    pub most_torque: Option<f64>,
    /// Path of the choice in the study.
    pub place: String,
}

/// What chooses the gears of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub enum ChosenBy {
    /// The rule.
    Rule(Rule),
    /// The least energy over the whole cycle at the temperatures that the rule gives.
    Optimum(Rule),
    /// A map over speed and torque of the wheels.
    Map(ShiftMap),
}

/// A choice with the losses of the machine at the reference port.
#[derive(Debug, Clone, Copy)]
pub struct Choosing<'a> {
    /// The choice.
    pub choice: &'a GearChoice,
    /// The machine that a vehicle states; those of the gearbox are known to it.
    pub machine: Option<&'a Machine>,
}

/// A shift at the start of an interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Energy that the shift dissipates, with that of the actuator. \[J\]
    pub heat: f64,
    /// Kinetic energy that the rotating parts release, negative if they take it up. \[J\]
    pub released: f64,
    /// True if a limit requires it.
    pub forced: bool,
}

/// The least energy over a cycle against that of the rule, at the temperatures of the rule. \[J\]
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// Least energy, with shifts.
    pub energy: f64,
    /// Energy with the gears of the rule, with shifts.
    pub rule_energy: f64,
    /// Number of shifts of the rule. \[-\]
    pub rule_shifts: usize,
}

/// The gear of an interval that will be simulated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chosen {
    /// Number of the gear state.
    pub state: usize,
    pub forced: bool,
    pub beyond: bool,
    pub is_clear: bool,
}

/// A gear among which to choose.
struct Candidate {
    state: usize,
    /// Moments of inertia (kg m2) of rotor and shafts with their speeds over that of the wheels.
    inertias: Vec<[f64; 2]>,
}

/// What chooses the gears while a cycle is simulated.
pub(super) struct Chooser<'a> {
    choosing: Choosing<'a>,
    candidates: Vec<Candidate>,
    /// Candidate of each interval, if they are known.
    given: Option<Vec<usize>>,
    now: Shifting,
    /// The next intervals in every gear.
    ahead: VecDeque<Vec<Offered>>,
    /// Number of intervals that have passed.
    passed: usize,
    /// Steps of a thermal network have other temperatures than the choice, so that what it notes is not used.
    noting: Noting,
}

/// An interval in one gear.
struct Offered {
    offer: Offer,
    solved: Option<Solved>,
}

/// A solved demand.
pub(super) struct Solved {
    pub asked: Asked,
    /// True if the demand is the same at the temperatures of a later time.
    pub is_clear: bool,
    /// The temperatures if they are those of an equilibrium.
    pub found: Option<Found>,
    /// The point; absent if the demand is limited and only what it exceeds was evaluated.
    pub point: Option<Snapshot>,
}

/// What an interval draws in a gear.
struct Evaluated {
    solved: Solved,
    /// Torque of the reference port. \[Nm\]
    torque: f64,
    loss: f64,
    /// Power of the machines. \[W\]
    drawn: f64,
    excess: f64,
}

/// Number of intervals that are evaluated ahead where their temperatures are given: several times the lanes, because without notes intervals of
/// one gear and one direction of power share them.
const AHEAD: usize = 4 * LANES;

/// Relative excess over an envelope that is rounding.
const ROUNDING: f64 = 1e-9;

impl<'a> Chooser<'a> {
    /// A chooser for a cycle, with the gears among which it chooses.
    ///
    /// # Errors
    /// If no gear can be chosen.
    pub fn new(cases: &mut Cases<'a>) -> Result<Option<Self>, Vec<Diagnostic>> {
        let Some(choosing) = cases.ride.choice else {
            return Ok(None);
        };
        check_demands(cases, choosing.choice)?;
        let candidates = candidates(cases, choosing.choice)?;
        let ride = cases.ride;
        let marches = ride.oil == OilTemperature::Network && !ride.spectrum;
        Ok(Some(Self {
            choosing,
            candidates,
            given: None,
            now: Shifting::default(),
            ahead: VecDeque::new(),
            passed: 0,
            noting: if marches { Noting::Muted } else { Noting::Seen },
        }))
    }

    /// The demand of one of the next intervals, as it was solved in a gear state.
    pub fn solved(&self, interval: usize, state: usize) -> Option<&Solved> {
        let gear = self.candidates.iter().position(|candidate| candidate.state == state)?;
        self.ahead.get(interval)?.get(gear)?.solved.as_ref()
    }

    /// The same of the next interval, which is simulated.
    pub fn take_solved(&mut self, state: usize) -> Option<Solved> {
        let gear = self.candidates.iter().position(|candidate| candidate.state == state)?;
        self.ahead.front_mut()?.get_mut(gear)?.solved.take()
    }

    /// The gears of the first `count` of the remaining intervals. `warm` are the temperatures of a thermal network at the start of the first.
    pub fn choose(
        &mut self,
        cases: &mut Cases<'_>,
        (rest, count): (&[Interval], usize),
        warm: Option<&[f64]>,
        driven: &mut Driven,
    ) -> Result<Vec<Chosen>, Vec<Diagnostic>> {
        let intervals = &rest[..count];
        let needs_offers = self.given.is_none() && !matches!(self.choosing.choice.by, ChosenBy::Map(_));
        match (needs_offers, warm) {
            (false, _) => {}
            (true, Some(warm)) => {
                let offered = self.offers(cases, intervals, &|_| warm, &mut driven.evaluations)?;
                self.ahead = offered.into();
            }
            (true, None) => self.look_ahead(cases, rest, count, &mut driven.evaluations)?,
        }
        let mut now = self.now;
        let mut all = Vec::with_capacity(count);
        for (i, interval) in intervals.iter().enumerate() {
            if let Some(name) = &interval.given.gear {
                all.push(Chosen {
                    state: cases.transmission.state(name).map_err(|e| vec![e])?,
                    forced: false,
                    beyond: false,
                    is_clear: true,
                });
                continue;
            }
            let pick = match (&self.given, &self.choosing.choice.by) {
                (Some(given), _) => settled(given[self.passed + i]),
                (None, ChosenBy::Map(map)) => settled(self.mapped(cases, map, interval, now)),
                (None, ChosenBy::Rule(rule) | ChosenBy::Optimum(rule)) => {
                    let rule = if cases.ride.spectrum { Rule::default() } else { *rule };
                    let before = if cases.ride.spectrum { Shifting::default() } else { now };
                    rule.pick(before, &offers_in(&self.ahead[i]))
                }
            };
            // A cycle starts when the vehicle does.
            if now.gear.is_some() || interval.demand != Demand::Rest {
                now = now.after(pick.gear, interval.duration);
            }
            all.push(Chosen {
                state: self.candidates[pick.gear].state,
                forced: pick.forced,
                beyond: pick.beyond,
                is_clear: pick.is_clear,
            });
        }
        Ok(all)
    }

    /// Takes over the gear of a simulated interval; returns the shift at its start.
    pub fn pass(&mut self, ride: &Ride<'_>, interval: &Interval, chosen: &Chosen) -> Option<Shift> {
        self.passed += 1;
        self.ahead.pop_front();
        let to = self
            .candidates
            .iter()
            .position(|candidate| candidate.state == chosen.state)?;
        if self.now.gear.is_none() && interval.demand == Demand::Rest {
            return None;
        }
        let from = self.now.gear;
        self.now = self.now.after(to, interval.duration);
        let from = from.filter(|from| *from != to && !ride.spectrum)?;
        Some(Shift {
            forced: chosen.forced,
            ..self.shift(ride.vehicle, interval, from, to)
        })
    }

    /// The shift between two gears at the start of an interval.
    fn shift(&self, vehicle: Option<&Vehicle>, interval: &Interval, from: usize, to: usize) -> Shift {
        let wheels = match interval.demand {
            Demand::Wheel {
                speed, acceleration, ..
            } => {
                let radius = vehicle.map_or(f64::INFINITY, |vehicle| vehicle.tyre_radius);
                (speed - 0.5 * acceleration * interval.duration / radius).max(0.0)
            }
            _ => 0.0,
        };
        let pairs = self.candidates[from].inertias.iter().zip(&self.candidates[to].inertias);
        let (mut heat, mut released) = (0.0, 0.0);
        for ([inertia, before], [_, after]) in pairs {
            let (before, after) = (before * wheels, after * wheels);
            heat += 0.5 * inertia * (before - after).powi(2);
            released += 0.5 * inertia * (before * before - after * after);
        }
        let choice = self.choosing.choice;
        Shift {
            heat: choice.shift_energy.unwrap_or(heat) + choice.actuation,
            released,
            forced: false,
        }
    }

    /// The gear of the map in an interval; at standstill the present one.
    fn mapped(&self, cases: &Cases<'_>, map: &ShiftMap, interval: &Interval, now: Shifting) -> usize {
        let (speed, torque) = match interval.demand {
            Demand::Wheel { speed, torque, .. } => (speed, torque),
            // A port that drives the wheels takes torque from the transmission.
            Demand::Port { torque, speed } => (speed.abs(), -torque * speed.signum()),
            Demand::Rest => match now.gear {
                Some(gear) => return gear,
                None => (0.0, 0.0),
            },
        };
        let name = map.gear(speed, torque);
        let is_named = |candidate: &Candidate| cases.transmission.states()[candidate.state].name == name;
        self.candidates.iter().position(is_named).unwrap_or(0)
    }

    /// Evaluates what the next intervals draw where every interval has its own temperature, given or at equilibrium.
    fn look_ahead(
        &mut self,
        cases: &mut Cases<'_>,
        rest: &[Interval],
        count: usize,
        evaluations: &mut usize,
    ) -> Result<(), Vec<Diagnostic>> {
        if self.ahead.len() >= count {
            return Ok(());
        }
        let given = |interval: &Interval| interval.given.oil_temperature.or(cases.ride.oil.given());
        let given: Vec<[f64; 1]> = rest.iter().take(AHEAD).map_while(|i| Some([given(i)?])).collect();
        self.ahead = if given.len() >= count {
            let temperatures = |i: usize| given[i].as_slice();
            self.offers(cases, &rest[..given.len()], &temperatures, evaluations)?
                .into()
        } else {
            let offers: Result<Vec<_>, _> = rest[..count]
                .iter()
                .map(|interval| self.offers_at_equilibrium(cases, interval, evaluations))
                .collect();
            offers?.into()
        };
        Ok(())
    }

    /// What an interval draws in each gear at the equilibrium of that gear.
    fn offers_at_equilibrium(
        &self,
        cases: &mut Cases<'_>,
        interval: &Interval,
        evaluations: &mut usize,
    ) -> Result<Vec<Offered>, Vec<Diagnostic>> {
        let mut offers = Vec::new();
        for candidate in &self.candidates {
            let name = &cases.transmission.states()[candidate.state].name;
            let around = around(cases.ride, Some(interval));
            let asked = ask(cases, interval, &around, name)?;
            let warm = steady_temperatures(cases, interval, &asked, &around);
            let Some(warm) = warm.ok().filter(Found::is_sound) else {
                offers.push(NO_SOLUTION);
                continue;
            };
            *evaluations += warm.evaluations();
            let one = std::slice::from_ref(interval);
            let found = self.in_gear(cases, one, candidate, &|_| warm.temperatures(), evaluations)?;
            // A demand that may be limited has its equilibrium with the limit.
            let keep = |solved: Solved| Solved {
                found: Some(warm.clone()),
                ..solved
            };
            offers.extend(found.into_iter().map(|offered| Offered {
                solved: offered.solved.filter(|_| asked.limited.is_none()).map(keep),
                ..offered
            }));
        }
        Ok(offers)
    }

    /// What intervals draw in each gear at temperatures of each.
    fn offers<'t>(
        &self,
        cases: &mut Cases<'_>,
        intervals: &[Interval],
        temperatures: &dyn Fn(usize) -> &'t [f64],
        evaluations: &mut usize,
    ) -> Result<Vec<Vec<Offered>>, Vec<Diagnostic>> {
        let mut all: Vec<Vec<Offered>> = Vec::new();
        all.resize_with(intervals.len(), || Vec::with_capacity(self.candidates.len()));
        for candidate in &self.candidates {
            let found = self.in_gear(cases, intervals, candidate, temperatures, evaluations)?;
            for (offers, offered) in all.iter_mut().zip(found) {
                offers.push(offered);
            }
        }
        Ok(all)
    }

    /// What intervals draw in a gear at temperatures of each.
    fn in_gear<'t>(
        &self,
        cases: &mut Cases<'_>,
        intervals: &[Interval],
        candidate: &Candidate,
        temperatures: &dyn Fn(usize) -> &'t [f64],
        evaluations: &mut usize,
    ) -> Result<Vec<Offered>, Vec<Diagnostic>> {
        let name = &cases.transmission.states()[candidate.state].name;
        let mut asked = Vec::new();
        for (i, interval) in intervals.iter().enumerate() {
            let is_moving = interval.demand != Demand::Rest && interval.given.gear.is_none();
            if is_moving {
                let around = around(cases.ride, Some(interval));
                asked.push((i, ask(cases, interval, &around, name)?));
            }
        }
        let mut found = self.evaluate(cases, intervals, &asked, temperatures);
        *evaluations += asked.len();
        self.limit(cases, intervals, (&asked, &mut found), temperatures, evaluations)?;
        let has_machine = has_machine(cases.transmission, cases.ride);
        let mut found = asked.iter().map(|(i, _)| *i).zip(found).peekable();
        let offered = |i: usize| match found.next_if(|(place, _)| *place == i) {
            Some((_, Some(found))) => Offered {
                offer: Offer {
                    power: if has_machine { found.drawn } else { found.loss },
                    loss: found.loss,
                    excess: found.excess,
                },
                solved: Some(found.solved),
            },
            Some((_, None)) => NO_SOLUTION,
            None => Offered {
                offer: Offer::REST,
                solved: None,
            },
        };
        Ok((0..intervals.len()).map(offered).collect())
    }

    /// Limits demands to what is regenerated, and notes those that are beyond an envelope.
    fn limit<'t>(
        &self,
        cases: &mut Cases<'_>,
        intervals: &[Interval],
        (asked, found): (&[(usize, Asked)], &mut [Option<Evaluated>]),
        temperatures: &dyn Fn(usize) -> &'t [f64],
        evaluations: &mut usize,
    ) -> Result<(), Vec<Diagnostic>> {
        let (mut places, mut again) = (Vec::new(), Vec::new());
        for (k, (i, asked)) in asked.iter().enumerate() {
            let (Some(lossless), Some(found)) = (asked.limited, &mut found[k]) else {
                continue;
            };
            let speed = intervals[*i].given.vehicle_speed.unwrap_or(0.0);
            let gear = cases.known[asked.place].0.0.clone();
            let settled = limited(cases, *asked, (found.torque, lossless, speed), &gear)?;
            let Settled {
                asked: demand,
                is_clear,
            } = settled;
            found.solved.is_clear = is_clear;
            if demand.place == asked.place {
                continue;
            }
            if demand.wanted.is_some() {
                // What a gear lacks is no saving: the offer remains that of the whole demand.
                (found.solved.asked, found.solved.point) = (demand, None);
            } else {
                places.push((k, is_clear));
                again.push((*i, demand));
            }
        }
        *evaluations += again.len();
        let evaluated = self.evaluate(cases, intervals, &again, temperatures);
        for ((k, is_clear), mut evaluated) in places.into_iter().zip(evaluated) {
            if let Some(evaluated) = &mut evaluated {
                evaluated.solved.is_clear = is_clear;
            }
            found[k] = evaluated;
        }
        Ok(())
    }

    /// Solves demands at temperatures of their intervals; without notes several together where they are of one case and one direction of power.
    fn evaluate<'t>(
        &self,
        cases: &mut Cases<'_>,
        intervals: &[Interval],
        asked: &[(usize, Asked)],
        temperatures: &dyn Fn(usize) -> &'t [f64],
    ) -> Vec<Option<Evaluated>> {
        let mut found: Vec<Option<Evaluated>> = Vec::new();
        found.resize_with(asked.len(), || None);
        let key = |k: usize| {
            let asked = &asked[k].1;
            (asked.place, asked.torque > 0.0, asked.torque < 0.0, asked.speed > 0.0)
        };
        let mut order: Vec<usize> = (0..asked.len()).collect();
        order.sort_by_key(|k| key(*k));
        let (t, ride) = (cases.transmission, cases.ride);
        for alike in order.chunk_by(|a, b| key(*a) == key(*b)) {
            let place = asked[alike[0]].1.place;
            let (case, scratch) = (&cases.known[place].1, &mut cases.scratches[place]);
            let point = |k: &usize| {
                let (i, asked) = &asked[*k];
                point_of(case, ride, asked, intervals[*i].inclination)
            };
            let points: Vec<Point<'_>> = alike.iter().map(point).collect();
            let warm = |k: usize| temperatures(asked[alike[k]].0);
            let solved = match self.noting {
                Noting::Muted => t.snapshots(case, &points, &warm, Noting::Muted, scratch),
                // One by one: points side by side would note the range of all of them, also of those whose gear is not chosen.
                noting => (0..points.len())
                    .map(|n| t.snapshot(case, &points[n], warm(n), noting, scratch))
                    .collect(),
            };
            for (n, (k, point)) in alike.iter().zip(solved).enumerate() {
                found[*k] = point.ok().map(|point| self.read(t, asked[*k].1, point, warm(n)));
            }
        }
        found
    }

    /// What a solved demand draws.
    fn read(&self, t: &Transmission, asked: Asked, point: Snapshot, temperatures: &[f64]) -> Evaluated {
        let reference = t.ports()[t.reference_port()].member;
        let (speeds, torques) = (&point.speeds, &point.port_torques);
        let (w, m) = (speeds[reference], torques[reference]);
        let choice = self.choosing.choice;
        let over = |x: f64, most: Option<f64>| most.map_or(0.0, |most| x.abs() / most - 1.0);
        let mut excess = over(w, choice.most_speed).max(over(m, choice.most_torque)).max(0.0);
        let mut drawn = w * m;
        let in_network = temperatures.len() > 1;
        for machine in t.active_machines(in_network).chain(self.choosing.machine) {
            let is_stated = self
                .choosing
                .machine
                .is_some_and(|stated| std::ptr::eq(stated, machine));
            let member = if is_stated { reference } else { machine.member };
            let state = t.machine_at(machine, speeds[member], torques[member], temperatures);
            drawn += state.machine + state.inverter;
            if member != reference {
                drawn += state.shaft();
            }
            excess = excess.max(beyond(machine, state.speed, state.torque));
        }
        Evaluated {
            torque: m,
            loss: point.watts.iter().sum(),
            drawn,
            excess,
            solved: Solved {
                asked,
                is_clear: true,
                found: None,
                point: Some(point),
            },
        }
    }
}

/// The offers of an interval.
fn offers_in(offered: &[Offered]) -> Vec<Offer> {
    offered.iter().map(|offered| offered.offer).collect()
}

/// A gear without a solution.
const NO_SOLUTION: Offered = Offered {
    offer: Offer {
        power: f64::MAX,
        loss: 0.0,
        excess: f64::INFINITY,
    },
    solved: None,
};

/// A gear that does not depend on what it draws.
fn settled(gear: usize) -> Pick {
    Pick {
        gear,
        forced: false,
        beyond: false,
        is_clear: true,
    }
}

/// How far a speed \[rad/s\] and a torque \[Nm\] are beyond the map and the envelope of a machine, relative to their borders.
fn beyond(machine: &Machine, speed: f64, torque: f64) -> f64 {
    let map = machine.map().map_or(0.0, |map| map.excess(speed, torque));
    let envelope = machine.envelope();
    let over = envelope.map_or(0.0, |envelope| torque.abs() / envelope.most(speed) - 1.0);
    if over > ROUNDING { map.max(over) } else { map }
}

/// Whether gears are compared by the power of machines; otherwise by the loss of the gearbox.
pub fn has_machine(t: &Transmission, ride: &Ride<'_>) -> bool {
    let in_gearbox = || t.active_machines(ride.oil == OilTemperature::Network).next().is_some();
    ride.choice.is_some_and(|choosing| choosing.machine.is_some()) || in_gearbox()
}

/// Refuses demands that already contain a gear.
fn check_demands(cases: &Cases<'_>, choice: &GearChoice) -> Result<(), Vec<Diagnostic>> {
    let t = cases.transmission;
    let of_port = cases
        .ride
        .intervals
        .iter()
        .any(|interval| matches!(interval.demand, Demand::Port { .. }) && interval.given.gear.is_none());
    if of_port && cases.ride.port == t.ports()[t.reference_port()].name {
        let message = format!(
            "torque and speed are stated at `{}`, where they already depend on the gear",
            cases.ride.port
        );
        let error = Diagnostic::error(&choice.place, message).code(codes::GEAR_CHOICE);
        return Err(vec![error.help(
            "use a cycle with the speed of a vehicle, or torque and speed at the wheels; or add a column `gear`",
        )]);
    }
    let has_gears = cases
        .ride
        .intervals
        .iter()
        .any(|interval| interval.given.gear.is_some());
    if has_gears && matches!(choice.by, ChosenBy::Optimum(_)) {
        let message = "the cycle states gears, so that they cannot be chosen over the whole cycle";
        let error = Diagnostic::error(&choice.place, message).code(codes::GEAR_CHOICE);
        return Err(vec![error.help(
            "delete the column `gear` of the cycle, or write `gear: best` for rows without one",
        )]);
    }
    Ok(())
}

/// The gears among which to choose.
fn candidates(cases: &mut Cases<'_>, choice: &GearChoice) -> Result<Vec<Candidate>, Vec<Diagnostic>> {
    let t = cases.transmission;
    let mapped: Vec<String> = match &choice.by {
        ChosenBy::Map(map) => map.gears().iter().map(|(gear, _)| gear.clone()).collect(),
        _ => Vec::new(),
    };
    let named = if mapped.is_empty() { &choice.among } else { &mapped };
    let on_wheels = cases.wheels.is_some();
    let mut found: Vec<Candidate> = Vec::new();
    let mut first = 0.0;
    for (state, described) in t.states().iter().enumerate() {
        let is_wanted = named.is_empty() || named.contains(&described.name);
        if !is_wanted {
            continue;
        }
        let places = if on_wheels {
            &[At::Wheels, At::Input][..]
        } else {
            &[At::Port]
        };
        let placed = places
            .iter()
            .try_for_each(|at| cases.place(&described.name, *at).map(|_| ()));
        let relative = placed.map(|()| relative_speeds(cases, state, places[0]));
        let fault = match relative {
            Ok((ratio, inertias)) if ratio.is_finite() && ratio != 0.0 => {
                if found.is_empty() {
                    first = ratio;
                }
                if !named.is_empty() || ratio * first > 0.0 {
                    found.push(Candidate { state, inertias });
                }
                continue;
            }
            Ok(_) => Diagnostic::error("", format!("`{}` does not connect the ports", described.name)),
            Err(mut list) if !list.is_empty() => list.swap_remove(0),
            Err(_) => continue,
        };
        if !named.is_empty() {
            let message = format!("`{}` cannot be chosen: {}", described.name, fault.message);
            let error = Diagnostic::error(&choice.place, message).code(codes::GEAR_CHOICE);
            return Err(vec![error.help("leave it out of `gears`")]);
        }
    }
    if found.is_empty() {
        let error = Diagnostic::error(
            &choice.place,
            "no gear of the gearbox connects the machine with the wheels",
        );
        let help = "describe such a state under `gear_states`";
        return Err(vec![error.help(help).code(codes::GEAR_CHOICE)]);
    }
    Ok(found)
}

/// Speed of the reference port over that of the wheels in a gear, and those of all parts with a moment of inertia.
fn relative_speeds(cases: &mut Cases<'_>, state: usize, at: At) -> (f64, Vec<[f64; 2]>) {
    let t = cases.transmission;
    let Ok(place) = cases.place(&t.states()[state].name, at) else {
        return (0.0, Vec::new());
    };
    let speeds = t.speeds(&cases.known[place].1, &[1.0]);
    let ratio = speeds[t.ports()[t.reference_port()].member];
    let inertia = cases.ride.vehicle.and_then(|vehicle| vehicle.inertia.as_ref());
    let inertias = inertia.map_or_else(Vec::new, |inertia| {
        let member = |name: &str| t.members().iter().position(|member| member == name);
        let shaft = |name: &str| member(name).map_or(0.0, |member| speeds[member]);
        let shafts = inertia.shafts.iter().map(|(name, part)| [part.inertia, shaft(name)]);
        std::iter::once([inertia.rotor, ratio]).chain(shafts).collect()
    });
    (ratio, inertias)
}

/// Simulates a cycle with the gears of the least energy: with the rule first, whose temperatures the comparison uses.
pub(super) fn drive_optimum(
    t: &Transmission,
    ride: &Ride<'_>,
    progress: &dyn Fn(usize) -> bool,
) -> Result<Option<Driven>, Vec<Diagnostic>> {
    let mut cases = Cases::new(t, ride)?;
    let Some(chooser) = Chooser::new(&mut cases)?.map(Chooser::muted) else {
        return drive_through(t, ride, None, progress);
    };
    let Some(by_rule) = drive_through(t, ride, None, progress)? else {
        return Ok(None);
    };
    if by_rule.broken.is_some() || ride.spectrum {
        return Ok(Some(by_rule));
    }
    let starts: Vec<&[f64]> = std::iter::once(by_rule.start.as_slice())
        .chain(by_rule.stretches.iter().map(|stretch| stretch.temperatures.as_slice()))
        .collect();
    // Without a network every interval has its own temperature.
    let has_network = t.network().is_some() && ride.oil == OilTemperature::Network;
    let at = |i: usize| starts[if has_network { i } else { i + 1 }];
    let mut evaluations = by_rule.evaluations;
    let mut offers = Vec::with_capacity(ride.intervals.len());
    for first in (0..ride.intervals.len()).step_by(AHEAD) {
        let some = &ride.intervals[first..ride.intervals.len().min(first + AHEAD)];
        let offered = chooser.offers(&mut cases, some, &|i| at(first + i), &mut evaluations)?;
        offers.extend(offered.iter().map(|offered| offers_in(offered)));
    }
    let durations: Vec<f64> = ride.intervals.iter().map(|interval| interval.duration).collect();
    let has_machine = has_machine(t, ride);
    let shift = |i: usize, from: usize, to: usize| {
        let shift = chooser.shift(ride.vehicle, &ride.intervals[i], from, to);
        // Kinetic energy is no loss, but part of what is drawn.
        shift.heat - if has_machine { shift.released } else { 0.0 }
    };
    let number = |state: usize| chooser.candidates.iter().position(|candidate| candidate.state == state);
    let gears_of_rule: Vec<usize> = by_rule.stretches.iter().map(|s| number(s.gear).unwrap_or(0)).collect();
    let best = least_energy(&offers, &durations, &shift);
    let optimum = Optimum {
        energy: energy(&offers, &durations, &best, &shift),
        rule_energy: energy(&offers, &durations, &gears_of_rule, &shift),
        rule_shifts: by_rule
            .stretches
            .iter()
            .filter(|stretch| stretch.shift.is_some())
            .count(),
    };
    let driven = drive_through(t, ride, Some(best), &|_| progress(0))?;
    Ok(driven.map(|driven| Driven {
        optimum: Some(optimum),
        evaluations: driven.evaluations + evaluations,
        ..driven
    }))
}

impl Chooser<'_> {
    /// With the candidate of each interval.
    pub fn with_given(mut self, given: Option<Vec<usize>>) -> Self {
        self.given = given;
        self
    }

    /// Without notes: for a comparison alone.
    fn muted(mut self) -> Self {
        self.noting = Noting::Muted;
        self
    }
}

/// What the intervals of a ride draw in the gears of its choice at given temperatures of the oil; with several gears, in the first one.
///
/// # Errors
/// If no gear can be chosen, or a temperature is not given.
pub fn offers_of(t: &Transmission, ride: &Ride<'_>) -> Result<Vec<Offer>, Vec<Diagnostic>> {
    let mut cases = Cases::new(t, ride)?;
    let Some(chooser) = Chooser::new(&mut cases)?.map(Chooser::muted) else {
        return Ok(Vec::new());
    };
    let mut all = Vec::with_capacity(ride.intervals.len());
    let mut evaluations = 0;
    for some in ride.intervals.chunks(AHEAD) {
        let oil = |interval: &Interval| interval.given.oil_temperature.or(ride.oil.given()).unwrap_or(f64::NAN);
        let oils: Vec<[f64; 1]> = some.iter().map(|interval| [oil(interval)]).collect();
        let offers = chooser.offers(&mut cases, some, &|i| oils[i].as_slice(), &mut evaluations)?;
        all.extend(offers.iter().map(|offers| offers[0].offer));
    }
    Ok(all)
}

/// Torque of the wheels that tows a gearbox whose input stands, against the rotation, at speeds of the wheels (rad/s) and temperatures of the oil
/// (degC). \[Nm\]
///
/// # Errors
/// If the gear state does not separate the wheels from the input.
pub fn tow_torques(t: &Transmission, state: &str, points: &[(f64, f64)]) -> Result<Vec<f64>, Vec<Diagnostic>> {
    let port = wheels(t).map_err(|error| vec![error])?;
    let name = |port: usize| t.ports()[port].name.as_str();
    let case = t.case(state, &[name(port), name(t.reference_port())], &[])?;
    let mut scratch = t.scratch(&case);
    let mut tow = |(speed, oil): &(f64, f64)| {
        if *speed == 0.0 {
            return Ok(0.0);
        }
        let point = Point {
            speeds: &[*speed, 0.0],
            ..Point::default()
        };
        t.try_point(&case, &point, &[*oil], &mut scratch, Noting::Counted)
            .map_err(|_| {
                let message = format!("the towed gearbox has no losses at {speed} rad/s");
                vec![Diagnostic::error("gear_states", message).help("examine the point with `explain`")]
            })?;
        Ok(scratch.port_torque(t.ports()[port].member) * speed.signum())
    };
    points.iter().map(&mut tow).collect()
}
