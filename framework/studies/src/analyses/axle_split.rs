//! The torque of a cycle, divided between a front and a rear unit.
//!
//! Source: equal units with convex losses share the torque equally, and a unit alone is better only if the other one can be disconnected:
//! derived. Here both are found by comparing all shares of a grid and both disconnections.

mod best;
mod outcome;

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::document::data::TableFile;
use gearloss_framework::machine::Machine;
use schemars::JsonSchema;
use serde::Deserialize;

use self::best::{ByShare, State, least};
pub use self::outcome::{AxleSplitOutcome, FixedSplit, IntervalOfSplit, SplitOfCycle, TimeInState};
use super::common::duties::{Duties, Read, machine_of_map};
use super::{Analysis, Built, Engine, Plan, Planner, Stopped, Work, gear_of};
use crate::codes;
use crate::duty::{Demand, Interval};
use crate::points::{Choosing, ChosenBy, GearChoice, Offer, Ride, Rule, offers_of, tow_torques};
use crate::register_analysis;
use crate::study::{RideEntry, Uses, Write};

/// Front and rear unit that drive one vehicle: the share of each with the least drawn power, or a fixed one.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct AxleSplitEntry {
    /// Unit of the front axle.
    pub front: UnitEntry,
    /// Unit of the rear axle.
    pub rear: UnitEntry,
    /// Cycles and vehicle. The temperatures of both gearboxes must be given.
    #[serde(flatten)]
    pub ride: RideEntry,
    /// Share of the torque of the wheels at the front axle; default: in each interval that with which both machines draw least. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub split: Option<f64>,
    /// Step of the shares that are compared. [-]
    #[serde(default = "step")]
    #[schemars(range(min = 0.001, max = 0.5))]
    pub share_step: f64,
}

/// Twenty shares: the least is flat, so that a finer step changes little.
fn step() -> f64 {
    0.05
}

/// A unit: gearbox and machine of an axle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct UnitEntry {
    /// Gearbox of the unit.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: String,
    /// Model set; default: the models of the gearbox.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_set: Option<String>,
    /// Gear while the unit is connected; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Gear state in which the unit is disconnected: the wheels turn what is on their side, machine and input stand. Default: it cannot be
    /// disconnected.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub disconnect: Option<String>,
    /// Losses of the machine with its inverter, as `motor_map` of a vehicle; default: that of the vehicle.
    #[schemars(extend("x-refers-to" = "file"))]
    pub motor_map: Option<TableFile>,
}

register_analysis!(AxleSplitEntry);

/// The intervals of a cycle, and the energy (J) of fixed shares.
type Solved = (Vec<IntervalOfSplit>, Vec<(f64, f64)>);

/// A unit that is ready to drive.
struct Unit<'a> {
    built: Arc<Built<'a>>,
    gear: String,
    machine: Option<Machine>,
    choice: GearChoice,
    disconnect: Option<String>,
}

/// Both units with their cycles.
pub struct AxleSplitPlan<'a> {
    units: [Unit<'a>; 2],
    duties: Duties<'a>,
}

impl Plan for AxleSplitPlan<'_> {
    fn work(&self) -> Vec<Work> {
        vec![Work::new("both units", "cycle", self.duties.list.len())]
    }
}

impl Analysis for AxleSplitEntry {
    const TYPE: &'static str = "axle_split";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = AxleSplitPlan<'a>;
    type Outcome = AxleSplitOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(Some(&self.front.gearbox), &self.front.model_set)
            .in_gears(self.front.gear.iter().chain(&self.front.disconnect))
            .riding(Some(&self.ride))
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<AxleSplitPlan<'a>, Stopped> {
        let path = cx.path();
        let duties = Duties::new(cx, &path, &self.ride, None)?;
        let units = [("front", &self.front), ("rear", &self.rear)];
        let [front, rear] = units.map(|(key, entry)| entry.unit(cx, &format!("{path}.{key}"), &duties));
        let plan = AxleSplitPlan {
            units: [front?, rear?],
            duties,
        };
        let wrong = |message: String, help: &str| Err(cx.wrong_as(codes::AXLE_SPLIT, &path, message, help));
        for unit in &plan.units {
            plan.duties.check(cx, &path, &unit.built)?;
            let ride = plan.duties.ride(&unit.built.transmission, &plan.duties.list[0]);
            if ride.oil.given().is_none() {
                let message = format!("the oil temperature of `{}` is not given", unit.built.name);
                return wrong(message, "write `conditions: { oil_temperature: 60 degC }`");
            }
            if ride
                .vehicle
                .is_some_and(|vehicle| vehicle.inertia.is_some() || vehicle.efficiency.is_some())
            {
                let message = "`inertia` and `efficiency` of a vehicle belong to one unit, but here are two".to_owned();
                return wrong(
                    message,
                    "state `rotating_mass_factor`, and the losses of both gearboxes",
                );
            }
        }
        let of_port = |read: &Read| read.intervals.iter().any(|i| matches!(i.demand, Demand::Port { .. }));
        if let Some(read) = plan.duties.list.iter().find(|read| of_port(read)) {
            let message = format!(
                "`{}` states torque and speed at a port instead of the speed of a vehicle",
                read.name
            );
            return wrong(message, "use a cycle with the speed of a vehicle");
        }
        Ok(plan)
    }

    fn reduce<'a>(&'a self, plan: AxleSplitPlan<'a>, engine: &Engine<'a>) -> Result<AxleSplitOutcome, Stopped> {
        let solved = engine.jobs("cycles", plan.duties.list.len(), |i| {
            self.cycle(engine, &plan, &plan.duties.list[i])
        })?;
        let names = || [0, 1].map(|unit| plan.units[unit].built.name.clone());
        let of_cycle =
            |(read, (series, fixed)): (&Read, Solved)| SplitOfCycle::new(&read.name, names(), series, &fixed);
        let cycles = plan.duties.list.iter().zip(solved).map(of_cycle).collect();
        let built: Vec<Arc<Built<'_>>> = plan.units.iter().map(|unit| Arc::clone(&unit.built)).collect();
        Ok(AxleSplitOutcome {
            head: engine.head(&built),
            cycles,
        })
    }
}

impl UnitEntry {
    fn unit<'a>(&'a self, cx: &Planner<'a>, path: &str, duties: &Duties<'a>) -> Result<Unit<'a>, Stopped> {
        let sets: Vec<String> = self.model_set.iter().cloned().collect();
        let mut built = cx.built(cx.gearbox(Some(&self.gearbox))?, &sets)?;
        let built = built.swap_remove(0);
        let t = &built.transmission;
        for (key, gear) in [("gear", &self.gear), ("disconnect", &self.disconnect)] {
            if let Some(Err(error)) = gear.as_ref().map(|gear| t.state(gear)) {
                return Err(cx.found(vec![Diagnostic {
                    path: format!("{path}.{key}"),
                    ..error
                }]));
            }
        }
        let machine = self
            .motor_map
            .as_ref()
            .map(|map| machine_of_map(cx, &format!("{path}.motor_map"), map));
        let machine = machine.transpose().map_err(|list| cx.found(list))?;
        let has_own = t.active_machines(false).next().is_some();
        if machine.is_some() && has_own {
            let at = format!("{path}.motor_map");
            let message = "the gearbox has a machine, whose losses would be counted twice";
            return Err(cx.wrong_as(
                codes::AXLE_SPLIT,
                &at,
                message,
                "delete it, or `machines` of the gearbox",
            ));
        }
        if machine.is_none() && duties.machine().is_none() && !has_own {
            let help = "write `motor_map: machine.csv` here or in the vehicle";
            return Err(cx.wrong_as(
                codes::AXLE_SPLIT,
                path,
                "the unit has no machine, so that it draws nothing",
                help,
            ));
        }
        if let Some(state) = &self.disconnect {
            tow_torques(t, state, &[(1.0, 20.0)]).map_err(|list| {
                let reason = list.first().map_or_else(String::new, |error| error.message.clone());
                let message = format!("`{state}` does not separate the wheels from the input: {reason}");
                let help = "name a gear state in which a coupling between input and wheels is open";
                cx.wrong_as(codes::AXLE_SPLIT, &format!("{path}.disconnect"), message, help)
            })?;
        }
        let gear = gear_of(self.gear.as_deref(), t).to_owned();
        Ok(Unit {
            choice: GearChoice {
                by: ChosenBy::Rule(Rule::default()),
                among: vec![gear.clone()],
                shift_energy: Some(0.0),
                actuation: 0.0,
                most_speed: None,
                most_torque: None,
                place: path.to_owned(),
            },
            gear,
            machine,
            disconnect: self.disconnect.clone(),
            built,
        })
    }
}

impl Unit<'_> {
    /// The machine that is stated for it; `None` if the gearbox has one.
    fn machine<'m>(&'m self, duties: &'m Duties<'_>) -> Option<&'m Machine> {
        let has_own = self.built.transmission.active_machines(false).next().is_some();
        self.machine.as_ref().or(duties.machine()).filter(|_| !has_own)
    }

    /// What the unit draws in intervals that state the torque of its own wheels.
    fn offers(&self, duties: &Duties<'_>, read: &Read, intervals: &[Interval]) -> Result<Vec<Offer>, Stopped> {
        let t = &self.built.transmission;
        let ride = Ride {
            intervals,
            gear: &self.gear,
            choice: Some(Choosing {
                choice: &self.choice,
                machine: self.machine(duties),
            }),
            ..duties.ride(t, read)
        };
        offers_of(t, &ride).map_err(|list| self.built.gearbox.findings(list).into())
    }

    /// Torque of the wheels that tows the disconnected unit in each interval; absent if it cannot be disconnected. \[Nm\]
    fn towed(&self, duties: &Duties<'_>, read: &Read) -> Result<Option<Vec<f64>>, Stopped> {
        let t = &self.built.transmission;
        let Some(state) = &self.disconnect else {
            return Ok(None);
        };
        let oil = duties.ride(t, read).oil.given();
        let at = |interval: &Interval| {
            let speed = match interval.demand {
                Demand::Wheel { speed, .. } => speed,
                _ => 0.0,
            };
            (speed, interval.given.oil_temperature.or(oil).unwrap_or(f64::NAN))
        };
        let points: Vec<(f64, f64)> = read.intervals.iter().map(at).collect();
        let towed = tow_torques(t, state, &points);
        Ok(Some(
            towed.map_err(|list| Stopped::from(self.built.gearbox.findings(list)))?,
        ))
    }
}

impl AxleSplitEntry {
    /// Shares of the front axle that are compared.
    fn shares(&self) -> Vec<f64> {
        if let Some(share) = self.split {
            return vec![share];
        }
        let count = (1.0 / self.share_step).round().max(1.0) as usize;
        (0..=count).map(|i| i as f64 / count as f64).collect()
    }

    /// One cycle with both units.
    fn cycle(&self, engine: &Engine<'_>, plan: &AxleSplitPlan<'_>, read: &Read) -> Result<Solved, Stopped> {
        let shares = self.shares();
        // The shares of the fixed splits for comparison: half, and each unit alone while the other one turns.
        let fixed = [0.5, 1.0, 0.0];
        let mut sampled = shares.clone();
        sampled.extend(fixed);
        let [front, rear] = &plan.units;
        let towed = [front.towed(&plan.duties, read)?, rear.towed(&plan.duties, read)?];
        let mut by_share = Vec::new();
        for (number, unit) in plan.units.iter().enumerate() {
            // Towing the other unit is a torque that this one supplies.
            let towed = towed[1 - number].as_ref().filter(|_| self.split.is_none());
            let mut intervals = Vec::with_capacity(read.intervals.len() * (sampled.len() + 1));
            for (i, interval) in read.intervals.iter().enumerate() {
                let own = sampled
                    .iter()
                    .map(|share| if number == 0 { *share } else { 1.0 - share });
                intervals.extend(own.map(|share| with_torque(interval, share, 0.0)));
                intervals.extend(towed.map(|towed| with_torque(interval, 1.0, towed[i])));
            }
            let offers = unit.offers(&plan.duties, read, &intervals)?;
            by_share.push((offers, towed.is_some()));
        }
        if !engine.should_continue() {
            return Err(Stopped::Interrupted);
        }
        let row = |unit: usize, i: usize| -> (Vec<Offer>, Option<Offer>) {
            let (offers, has_alone) = &by_share[unit];
            let width = sampled.len() + usize::from(*has_alone);
            let row = &offers[i * width..(i + 1) * width];
            (row[..sampled.len()].to_vec(), row.get(sampled.len()).copied())
        };
        let mut series = Vec::with_capacity(read.intervals.len());
        let mut fixed_energies = [0.0; 3];
        for (i, interval) in read.intervals.iter().enumerate() {
            let ((front, front_alone), (rear, rear_alone)) = (row(0, i), row(1, i));
            let (front_of_shares, front_fixed) = front.split_at(shares.len());
            let (rear_of_shares, rear_fixed) = rear.split_at(shares.len());
            for (energy, (front, rear)) in fixed_energies.iter_mut().zip(front_fixed.iter().zip(rear_fixed)) {
                *energy += (front.power + rear.power) * interval.duration;
            }
            let found = least(&ByShare {
                front: front_of_shares,
                rear: rear_of_shares,
                alone: [front_alone, rear_alone],
            });
            let (torque, is_moving) = match interval.demand {
                Demand::Wheel { torque, .. } => (torque, true),
                _ => (0.0, false),
            };
            series.push(IntervalOfSplit {
                time_s: interval.start,
                duration_s: interval.duration,
                vehicle_speed_m_s: interval.given.vehicle_speed,
                wheel_torque_nm: torque,
                state: if is_moving { found.state } else { State::Standstill },
                front_share: is_moving.then_some(match found.state {
                    State::FrontAlone => 1.0,
                    State::RearAlone => 0.0,
                    _ => shares[found.share],
                }),
                front_w: found.drawn[0],
                rear_w: found.drawn[1],
                drawn_w: found.drawn[0] + found.drawn[1],
                beyond: found.excess > 0.0,
            });
        }
        Ok((series, fixed.into_iter().zip(fixed_energies).collect()))
    }
}

/// An interval with a share of the torque of the wheels and a further torque. \[Nm\]
fn with_torque(interval: &Interval, share: f64, more: f64) -> Interval {
    let demand = match interval.demand {
        Demand::Wheel {
            torque,
            speed,
            acceleration,
        } => Demand::Wheel {
            torque: share * torque + more,
            speed,
            acceleration,
        },
        other => other,
    };
    let mut given = interval.given.clone();
    given.gear = None;
    Interval {
        demand,
        given,
        ..interval.clone()
    }
}
