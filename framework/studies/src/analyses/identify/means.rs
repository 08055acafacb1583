//! Means over cycles of an identification: read, calculated by the simulation of cycles, and published.

use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::{Unit, parse_quantity};
use gearloss_framework::loss::Extent;
use gearloss_framework::variants::Variants;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::IdentifyEntry;
use super::found::Found;
use crate::analyses::common::duties::{Duties, Unfinished};
use crate::analyses::common::gears::GearOfCycles;
use crate::analyses::common::shares::Shares;
use crate::analyses::{Built, Planner, Stopped};
use crate::codes;
use crate::identify::{CalculatedMeans, Identified, Mean, Means};
use crate::points::{Note, merge, merge_notes, notes};
use crate::study::{By, MeanEntry, RideEntry};

/// All mechanisms together.
const ALL: &str = "all";

/// A fitted mean.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MeanOfFit {
    /// Name.
    pub name: String,
    /// Unit of its values: `W`, or `-` for a ratio of losses.
    pub unit: &'static str,
    /// Lower end of the range that agrees with it; absent if none. [unit]
    pub from: Option<f64>,
    /// Upper end of the range that agrees with it; absent if none. [unit]
    pub to: Option<f64>,
    /// Standard deviation of the ends. [unit]
    pub accuracy: f64,
    /// Calculated at the start. [unit]
    pub model_before: f64,
    /// Calculated. [unit]
    pub model: f64,
    /// Distance from the range at the start, relative to the accuracy. [-]
    pub residual_before: f64,
    /// Distance from the range, relative to the accuracy: zero in it. [-]
    pub residual: f64,
    /// Leverage of the mean, zero to one. [-]
    pub leverage: f64,
    /// Provenance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
}

impl MeanOfFit {
    /// The means of a fit.
    pub(super) fn all(found: &Found) -> Vec<Self> {
        let leverage = &found.fitted.inference.leverage()[found.observations.len()..];
        let [before, after] = &found.calculated_means;
        let of_mean = |(i, mean): (usize, &Mean)| Self {
            name: mean.name.clone(),
            unit: if mean.is_ratio { "-" } else { "W" },
            from: Some(mean.range[0]).filter(|x| x.is_finite()),
            to: Some(mean.range[1]).filter(|x| x.is_finite()),
            accuracy: mean.accuracy,
            model_before: before[i],
            model: after[i],
            residual_before: mean.residual(before[i]),
            residual: mean.residual(after[i]),
            leverage: leverage[i],
            source: mean.source.clone(),
        };
        found.means.iter().enumerate().map(of_mean).collect()
    }
}

/// Cycles with a gearbox that parameters change further.
struct Simulation<'a> {
    drive: &'a RideEntry,
    set: &'a Ordered<Value>,
    duties: Duties<'a>,
    variants: Variants<'a>,
}

/// Mean losses of a simulation.
struct Driven {
    /// Each mechanism with its mean loss. \[W\]
    losses: Vec<(String, f64)>,
    /// Observed without other values of the gearbox.
    seen: Vec<Extent>,
    /// Notes with other values: they may be other models, which observe other quantities.
    notes: Vec<Note>,
}

/// A mean loss of a simulation by its number: of one mechanism, or of all.
#[derive(PartialEq)]
struct MeanLoss<'a> {
    simulation: usize,
    mechanism: &'a str,
}

impl Driven {
    fn loss(&self, mechanism: &str) -> f64 {
        let of = self
            .losses
            .iter()
            .filter(|(name, _)| mechanism == ALL || name == mechanism);
        of.map(|(_, loss)| loss).sum()
    }
}

impl Simulation<'_> {
    fn drive(&self, overrides: &[(String, Value)]) -> Result<Driven, String> {
        let t = self.variants.build(overrides).map_err(|findings| findings.first())?;
        let shares = Shares::new(&t, By::Mechanism);
        let (mut joules, mut time, mut seen) = (vec![0.0; shares.names.len()], 0.0, Vec::new());
        for driven in self.duties.drive_all(&t, &|| true).map_err(Unfinished::text)? {
            for (sum, joule) in joules.iter_mut().zip(shares.sums(&driven.total.parts)) {
                *sum += joule;
            }
            time += driven.total.duration;
            merge(&mut seen, &driven.seen);
        }
        // Cycles without time have no energy.
        let mean = |joule: f64| joule / time.max(f64::MIN_POSITIVE);
        let (seen, notes) = if self.set.is_empty() {
            (seen, Vec::new())
        } else {
            (Vec::new(), notes(&t, &seen))
        };
        Ok(Driven {
            losses: shares.names.into_iter().zip(joules.into_iter().map(mean)).collect(),
            seen,
            notes,
        })
    }
}

/// What is read of the means of an entry, with one set.
struct Reader<'a, 'c> {
    cx: &'c Planner<'a>,
    entry: &'a IdentifyEntry,
    built: &'c Built<'a>,
    simulations: Vec<Simulation<'a>>,
}

/// The means of an entry with one set.
///
/// # Errors
/// Unknown names, cycles that do not fit the gearbox, values that are no losses or ratios.
pub(super) fn means<'a>(cx: &Planner<'a>, entry: &'a IdentifyEntry, built: &Built<'a>) -> Result<Means<'a>, Stopped> {
    let mut reader = Reader {
        cx,
        entry,
        built,
        simulations: Vec::new(),
    };
    let (mut list, mut losses) = (Vec::new(), Vec::new());
    for (name, mean) in entry.means.iter() {
        let path = format!("{}.means.{name}", cx.path());
        list.push(reader.stated(&path, name, mean)?);
        losses.push(reader.losses(&path, mean)?);
    }
    let simulations = reader.simulations;
    Ok(Means::new(list, move |overrides| {
        let driven = simulations
            .par_iter()
            .with_max_len(1)
            .map(|simulation| simulation.drive(overrides));
        let driven: Vec<Driven> = driven.collect::<Result<_, _>>()?;
        let loss = |of: &MeanLoss<'_>| driven[of.simulation].loss(of.mechanism);
        let value = |(of, over): &(MeanLoss<'_>, Option<MeanLoss<'_>>)| loss(of) / over.as_ref().map_or(1.0, loss);
        let (mut seen, mut notes) = (Vec::new(), Vec::new());
        for driven in &driven {
            merge(&mut seen, &driven.seen);
            merge_notes(&mut notes, &driven.notes);
        }
        Ok(CalculatedMeans {
            values: losses.iter().map(value).collect(),
            seen,
            notes,
        })
    }))
}

/// Whether one of two paths is the other, or lies below it.
fn overlap(one: &str, other: &str) -> bool {
    let is_within = |path: &str, whole: &str| {
        let rest = path.strip_prefix(whole);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    is_within(one, other) || is_within(other, one)
}

/// Refuses a parameter that changes what a mean states under `set`, or a part or the whole of it.
pub(super) fn refuse_changed(
    cx: &Planner<'_>,
    entry: &IdentifyEntry,
    built: &Built<'_>,
    parameters: &[Identified],
) -> Result<(), Stopped> {
    for (name, mean) in entry.means.iter() {
        let path = format!("{}.means.{name}", cx.path());
        let relative_to = mean.relative_to.as_ref().and_then(|other| other.set.as_ref());
        let sets = [
            Some((&mean.set, "set")),
            relative_to.map(|set| (set, "relative_to.set")),
        ];
        for (set, key) in sets.into_iter().flatten() {
            for (pattern, _) in set.iter() {
                let changed = gearloss_framework::resolve::matches(&built.resolved.value, pattern);
                let is_set = |path: &String| changed.iter().any(|set| overlap(path, set));
                let both = |parameter: &&Identified| parameter.paths().iter().any(is_set);
                if let Some(parameter) = parameters.iter().find(both) {
                    let message = format!(
                        "`{pattern}` is also changed by the parameter `{}`",
                        parameter.base_name()
                    );
                    let help = "delete it here, or do not identify it";
                    return Err(cx.wrong_as(codes::IDENTIFICATION, &format!("{path}.{key}"), message, help));
                }
            }
        }
    }
    Ok(())
}

impl<'a> Reader<'a, '_> {
    fn wrong(&self, path: &str, message: impl Into<String>, help: &str) -> Stopped {
        self.cx.wrong_as(codes::IDENTIFICATION, path, message, help)
    }

    /// The range of a mean.
    fn stated(&self, path: &str, name: &str, mean: &MeanEntry) -> Result<Mean, Stopped> {
        let is_ratio = mean.relative_to.is_some();
        let read = |key: &str, value: Option<&Value>| {
            let number = value.map(|value| number(value, is_ratio)).transpose();
            number.map_err(|reason| {
                let help = if is_ratio {
                    "write a ratio of losses, such as `0.96`"
                } else {
                    "write a power, such as `238 W`; a ratio needs `relative_to`"
                };
                self.wrong(&format!("{path}.{key}"), reason, help)
            })
        };
        let [value, from, to] = [
            read("value", mean.value.as_ref())?,
            read("from", mean.from.as_ref())?,
            read("to", mean.to.as_ref())?,
        ];
        let accuracy = read("accuracy", Some(&mean.accuracy))?.unwrap_or(f64::NAN);
        if accuracy.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            let help = "state the standard deviation of the value";
            return Err(self.wrong(&format!("{path}.accuracy"), "the accuracy is not positive", help));
        }
        let range = match (value, from, to) {
            (Some(value), None, None) => [value, value],
            (None, None, None) => {
                let help = "write `value`, or `from`, `to` or both";
                return Err(self.wrong(path, "neither a value nor a range is stated", help));
            }
            (None, from, to) => [from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY)],
            (Some(_), ..) => {
                let message = "both a value and a range are stated";
                return Err(self.wrong(&format!("{path}.value"), message, "delete one of them"));
            }
        };
        if range[0] > range[1] {
            return Err(self.wrong(
                &format!("{path}.to"),
                "the range is reversed",
                "exchange `from` and `to`",
            ));
        }
        Ok(Mean {
            name: name.to_owned(),
            source: mean.source.clone(),
            is_ratio,
            range,
            accuracy,
        })
    }

    /// The loss of a mean, and the one over which it is stated.
    fn losses(&mut self, path: &str, mean: &'a MeanEntry) -> Result<(MeanLoss<'a>, Option<MeanLoss<'a>>), Stopped> {
        let mechanism = mean.mechanism.as_deref().unwrap_or(ALL);
        let of = self.loss((path, path), &mean.drive, &mean.set, (path, mechanism))?;
        let over = mean.relative_to.as_ref().map(|other| {
            let below = format!("{path}.relative_to");
            let place = |is_own: bool| if is_own { below.as_str() } else { path };
            self.loss(
                (place(other.drive.is_some()), place(other.set.is_some())),
                other.drive.as_ref().unwrap_or(&mean.drive),
                other.set.as_ref().unwrap_or(&mean.set),
                (
                    place(other.mechanism.is_some()),
                    other.mechanism.as_deref().unwrap_or(mechanism),
                ),
            )
        });
        let over = over.transpose()?;
        if over.as_ref() == Some(&of) {
            let help = "state another `drive`, `set` or `mechanism` there";
            return Err(self.wrong(&format!("{path}.relative_to"), "a loss over itself is always 1", help));
        }
        Ok((of, over))
    }

    /// A mean loss; each of `drive`, `set` and `mechanism` with the place of the key.
    fn loss(
        &mut self,
        (of_drive, of_set): (&str, &str),
        drive: &'a RideEntry,
        set: &'a Ordered<Value>,
        (of_mechanism, mechanism): (&str, &'a str),
    ) -> Result<MeanLoss<'a>, Stopped> {
        let names = Shares::new(&self.built.transmission, By::Mechanism).names;
        if mechanism != ALL && !names.iter().any(|name| name == mechanism) {
            let known: Vec<&str> = names.iter().map(String::as_str).chain([ALL]).collect();
            let message = format!("no loss of the gearbox belongs to `{mechanism}`");
            let help = format!("write one of {}", known.join(", "));
            return Err(self.cx.wrong(&format!("{of_mechanism}.mechanism"), message, &help));
        }
        let same = |known: &Simulation<'_>| known.drive == drive && known.set.iter().eq(set.iter());
        let known = self.simulations.iter().position(same);
        if known.is_none() {
            let new = self.simulation(&format!("{of_drive}.drive"), drive, &format!("{of_set}.set"), set)?;
            self.simulations.push(new);
        }
        Ok(MeanLoss {
            simulation: known.unwrap_or(self.simulations.len() - 1),
            mechanism,
        })
    }

    fn simulation(
        &self,
        of_drive: &str,
        drive: &'a RideEntry,
        of_set: &str,
        set: &'a Ordered<Value>,
    ) -> Result<Simulation<'a>, Stopped> {
        let (cx, study) = (self.cx, &self.cx.study.entry);
        let cycles: Vec<&str> = study.cycles.ids().collect();
        let vehicles: Vec<&str> = study.vehicles.ids().collect();
        let named = drive.cycles.iter().map(|name| ("cycles", "cycle", name, &cycles));
        let named = named.chain(drive.vehicle.iter().map(|name| ("vehicle", "vehicle", name, &vehicles)));
        let unknown = named.filter(|(.., name, known)| !known.contains(&name.as_str()));
        let unknown: Vec<_> = unknown
            .map(|(key, kind, name, known)| dangling(&format!("{of_drive}.{key}"), kind, name, known))
            .collect();
        if !unknown.is_empty() {
            return Err(cx.found(unknown));
        }
        let gear = self.entry.gear.as_deref().map(GearOfCycles::Named);
        let duties = Duties::new(cx, of_drive, drive, gear)?;
        let gearbox = self.built.gearbox;
        let mut choice = cx.study.choice(self.built.set());
        if set.is_empty() {
            duties.check(cx, of_drive, self.built)?;
        } else {
            let change = |(path, value): (&str, &Value)| (path.to_owned(), value.clone());
            choice.overrides.extend(set.iter().map(change));
            let placed = set
                .iter()
                .map(|(path, value)| (path.to_owned(), value.clone(), of_set.to_owned()));
            let built = cx.built_as(gearbox, Some(&self.built.name), None, &placed.collect::<Vec<_>>())?;
            duties.check(cx, of_drive, &built)?;
        }
        Ok(Simulation {
            drive,
            set,
            duties,
            variants: Variants::new(cx.language, gearbox, choice),
        })
    }
}

/// A loss in W, or a ratio of losses.
fn number(value: &Value, is_ratio: bool) -> Result<f64, String> {
    let unit = if is_ratio {
        Unit::ONE
    } else {
        Unit::of_symbol("W").unwrap_or(Unit::ONE)
    };
    let number = match value {
        Value::Number(x) => x.as_f64().unwrap_or(f64::NAN),
        Value::String(text) => unit.from_si(parse_quantity(text, unit).map_err(|fault| fault.message)?),
        _ => f64::NAN,
    };
    let what = if is_ratio { "ratio" } else { "power" };
    number
        .is_finite()
        .then_some(number)
        .ok_or_else(|| format!("{value} is not a {what}"))
}
