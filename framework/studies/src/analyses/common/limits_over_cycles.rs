//! Limited quantities over cycles.

use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::evaluate::Ratings;
use gearloss_framework::machine::MachineEnergy;
use gearloss_framework::thermal::network::{Heats, Network};
use gearloss_framework::transmission::Transmission;
use serde_json::Value;

use super::duties::{Duties, nodes};
use super::trial::Trial;
use crate::analyses::cycle::RatedOverTime;
use crate::analyses::cycle::ratings::over_cycle;
use crate::analyses::{Built, Engine, Planner, Stopped};
use crate::limits::at_points::keep_limited;
use crate::limits::limit::Owner;
use crate::limits::reached::{Place, Reached};
use crate::limits::{Limit, Scope};
use crate::points::Driven;
use crate::study::{LimitEntry, LimitedQuantity};

/// The limits of an analysis of cycles at a path, after those of the study whose names it does not use.
///
/// # Errors
/// Everything that is wrong in the first wrong entry.
pub fn limits_of(
    cx: &Planner<'_>,
    path: &str,
    entries: &Ordered<LimitEntry>,
    duties: &Duties<'_>,
    b: &Built<'_>,
) -> Result<Vec<Limit>, Stopped> {
    let names: Vec<&str> = duties.list.iter().map(|read| read.name.as_str()).collect();
    let scope = Scope {
        cycles: Some(&names),
        ..cx.scope(b)
    };
    Ok(Limit::all(scope, path, entries)?)
}

/// The index of a cycle of an analysis.
pub fn cycle(cx: &Planner<'_>, path: &str, name: &str, duties: &Duties<'_>) -> Result<usize, Stopped> {
    let names: Vec<&str> = duties.list.iter().map(|read| read.name.as_str()).collect();
    let place = names.iter().position(|known| *known == name);
    place.ok_or_else(|| cx.found(vec![dangling(path, "cycle of this analysis", name, &names)]))
}

impl Limit {
    /// The limited value of a driven design, in the unit: of the worst moment, component and cycle. `rated` are the ratings over each cycle.
    fn value(
        &self,
        duties: &Duties<'_>,
        t: &Transmission,
        driven: &[Driven],
        rated: &[Vec<RatedOverTime>],
    ) -> Option<f64> {
        match &self.of {
            Owner::Rating { .. } => {
                let ratings = rated.iter().flatten();
                let ratings = ratings.filter(|rating| self.limits(rating));
                // Where the quantity is unknown, the limit cannot be kept.
                Some(self.worst(ratings.map(|rating| rating.value)))
            }
            Owner::OtherCycle => None,
            Owner::Gearbox => {
                let all = driven.iter().flat_map(|cycle| self.of_gearbox(cycle));
                Some(self.worst(all))
            }
            Owner::Unit if self.quantity == LimitedQuantity::SystemEfficiency => {
                let of_cycle = |cycle: &Driven| duties.consumption(t, cycle)?.system_efficiency;
                Some(self.worst(driven.iter().filter_map(of_cycle)))
            }
            Owner::Unit => {
                let moments = driven.iter().flat_map(|cycle| &cycle.stretches);
                let moments = moments
                    .map(|stretch| &stretch.heats)
                    .filter(|heats| heats.duration > 0.0);
                Some(self.worst(moments.map(|heats| self.of_unit(heats))))
            }
            Owner::Gear(gear) => t.ratios(*gear).first().and_then(|(_, ratio)| *ratio).map(f64::abs),
            Owner::Cycle(cycle) => self.of_cycle(duties, t, &driven[*cycle]),
            Owner::AllCycles => {
                let all = driven.iter().map(|cycle| self.of_cycle(duties, t, cycle));
                let all = all.collect::<Option<Vec<f64>>>()?;
                Some(self.worst(all.into_iter()))
            }
            Owner::Oil | Owner::Node(_) => {
                let node = match &self.of {
                    Owner::Node(name) => nodes(t, driven.first()?)
                        .iter()
                        .position(|node_name| node_name == name)?,
                    _ => t.network().map_or(0, Network::oil),
                };
                let of_node = |all: &Vec<f64>| all.get(node).or(all.first()).copied();
                let all = driven.iter().flat_map(|cycle| {
                    let ends = cycle.stretches.iter().map(|stretch| &stretch.temperatures);
                    std::iter::once(&cycle.start).chain(ends).filter_map(of_node)
                });
                Some(self.worst(all))
            }
        }
    }

    /// The limited quantity of a whole cycle.
    fn of_cycle(&self, duties: &Duties<'_>, t: &Transmission, driven: &Driven) -> Option<f64> {
        match self.quantity {
            LimitedQuantity::Consumption => Some(duties.consumption(t, driven)?.consumption_kwh_per_100_km),
            LimitedQuantity::Range => duties.consumption(t, driven)?.range_km,
            _ => mean_loss(driven),
        }
    }

    /// A power of the drive unit in an interval. \[W\]
    fn of_unit(&self, heats: &Heats) -> f64 {
        let electric = |machine: &MachineEnergy| match self.quantity {
            LimitedQuantity::DcPower => machine.electric(),
            _ => machine.machine + machine.inverter,
        };
        let machines: f64 = heats.machines.iter().map(electric).sum();
        let gearbox = match self.quantity {
            LimitedQuantity::UnitLoss => heats.parts.iter().sum::<f64>(),
            _ => 0.0,
        };
        (machines + gearbox) / heats.duration
    }

    /// The loss of every moment, or the efficiency of a cycle.
    fn of_gearbox(&self, driven: &Driven) -> Vec<f64> {
        if self.quantity == LimitedQuantity::Efficiency {
            let Some(received) = Some(driven.total.input).filter(|energy| *energy > 0.0) else {
                return Vec::new();
            };
            return vec![driven.total.output / received];
        }
        let moments = driven.stretches.iter().map(|stretch| &stretch.heats);
        let moments = moments.filter(|heats| heats.duration > 0.0);
        moments
            .map(|heats| heats.parts.iter().sum::<f64>() / heats.duration)
            .collect()
    }

    /// Whether it limits a quantity of a rating.
    fn limits(&self, rating: &RatedOverTime) -> bool {
        self.symbol() == Some(rating.symbol) && self.rates(rating.rating, &rating.component)
    }

    /// Whether it limits one of the cycles but not this one.
    fn is_of_another_cycle(&self, cycle: usize) -> bool {
        match self.of {
            Owner::Cycle(limited) => limited != cycle,
            Owner::OtherCycle => true,
            _ => false,
        }
    }
}

impl Limit {
    /// The limited value in one of the cycles; absent where it is unknown, and for a limit of another cycle.
    pub fn in_cycle(
        &self,
        duties: &Duties<'_>,
        t: &Transmission,
        (k, driven): (usize, &Driven),
        rated: &[Vec<RatedOverTime>],
    ) -> Option<f64> {
        if self.is_of_another_cycle(k) {
            return None;
        }
        let rated = rated.get(k).map_or(&[][..], std::slice::from_ref);
        match self.of {
            Owner::Cycle(_) => self.of_cycle(duties, t, driven),
            _ => self.value(duties, t, std::slice::from_ref(driven), rated),
        }
    }
}

/// What the limits reach in each cycle of a simulated gearbox, in the order of the limits; `rated` are the ratings over each cycle.
pub fn reached(
    limits: &[Limit],
    duties: &Duties<'_>,
    t: &Transmission,
    driven: &[&Driven],
    rated: &[Vec<RatedOverTime>],
) -> Vec<Reached> {
    let of_limit = |limit: &Limit| {
        let mut reached = Reached::default();
        for (k, driven) in driven
            .iter()
            .enumerate()
            .filter(|(k, _)| !limit.is_of_another_cycle(*k))
        {
            let value = limit.in_cycle(duties, t, (k, driven), rated).unwrap_or(f64::NAN);
            let mut parts = rated.get(k).into_iter().flatten().filter(|rating| limit.limits(rating));
            let component = parts
                .find(|rating| rating.value == value)
                .map(|rating| rating.component.clone());
            let place = Place {
                component,
                cycle: Some(duties.list[k].name.clone()),
                ..Place::default()
            };
            reached.note(limit, value, || place.clone());
        }
        reached
    };
    limits.iter().map(of_limit).collect()
}

/// Notes the limited values of the design or oil that an analysis proposes.
pub fn note_proposed(engine: &Engine<'_>, set: &str, limits: &[Limit], values: &[f64], what: &str) {
    let note = |(limit, value): (&Limit, &f64)| {
        let mut reached = Reached::default();
        let place = || Place {
            cycle: Some(format!("all cycles with {what}")),
            ..Place::default()
        };
        reached.note(limit, *value, place);
        reached
    };
    engine.note_limits(set, limits, limits.iter().zip(values).map(note).collect());
}

/// A gearbox with overrides, and its ratings if limits need them.
///
/// # Errors
/// The first error of building.
pub fn built(
    trial: &Trial<'_>,
    limits: &[Limit],
    overrides: Vec<(String, Value)>,
) -> Result<(Transmission, Option<Ratings>), String> {
    if limits.iter().any(Limit::is_rating) {
        let (t, mut ratings) = trial.build_rated(overrides)?;
        // Only what is limited is rated, at every moment of the cycles.
        keep_limited(&mut ratings, limits, &t);
        Ok((t, Some(ratings)))
    } else {
        Ok((trial.build(overrides)?, None))
    }
}

/// The limited quantities of a driven gearbox, in the order and the units of the limits; NaN where one is unknown.
///
/// # Errors
/// If the ratings cannot be evaluated.
pub fn values(
    limits: &[Limit],
    duties: &Duties<'_>,
    t: &Transmission,
    ratings: Option<&Ratings>,
    driven: &[Driven],
) -> Result<Vec<f64>, String> {
    let mut rated = Vec::new();
    if let Some(ratings) = ratings {
        for (read, driven) in duties.list.iter().zip(driven) {
            let ratings_over_cycle = over_cycle(t, ratings, &duties.ride(t, read), driven);
            rated
                .push(ratings_over_cycle.map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?);
        }
    }
    let value = |limit: &Limit| limit.value(duties, t, driven, &rated).unwrap_or(f64::NAN);
    Ok(limits.iter().map(value).collect())
}

/// Sum of the violations of limits.
pub fn violation(limits: &[Limit], values: &[f64]) -> f64 {
    let pairs = limits.iter().zip(values);
    pairs.map(|(limit, value)| limit.violation(*value)).sum()
}

/// Mean loss of a cycle. \[W\]
pub fn mean_loss(driven: &Driven) -> Option<f64> {
    let time = driven.total.duration;
    (time > 0.0 && driven.broken.is_none()).then(|| driven.total.parts.iter().sum::<f64>() / time)
}
