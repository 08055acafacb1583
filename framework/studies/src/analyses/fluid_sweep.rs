//! Mean cycle losses over one property of an oil, and their minimum.

mod least;
mod swept;

use std::sync::Arc;

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use self::swept::Swept;
use super::common::duties::{DrivePlan, Duties, MeanLoss, Unfinished, sums_energies};
use super::common::shares::together;
use super::common::trial::{Left, Trial};
use super::{Analysis, Built, Engine, Head, Outcome, Plan, Planner, Stopped, Work};
use crate::analyses::common::limits_over_cycles::{built, limits_of, note_proposed, values, violation};
use crate::duty::Consumption;
use crate::limits::{Limit, LimitRecord};
use crate::points::Note;
use crate::register_analysis;
use crate::study::{By, DriveEntry, LimitEntry, Uses, Write};
use crate::table::Table;

pub use least::LeastLoss;

/// Mean cycle losses over one property of an oil, and their minimum.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct FluidSweepEntry {
    /// Cycles and settings of the simulation.
    #[serde(flatten)]
    pub drive: DriveEntry,
    /// Oil; default: the oil of the housing.
    #[schemars(extend("x-refers-to" = "lubricants"))]
    pub lubricant: Option<String>,
    /// Viscosities at 100 degC of hypothetical oils with one viscosity index; values below 2 mm2/s, for which the index is not defined, are
    /// marked. [mm2/s]
    #[serde(default)]
    #[schemars(inner(range(min = 0.5, max = 1000.0)))]
    pub kv100: Vec<f64>,
    /// Their viscosity index; default: that of the oil. [-]
    #[schemars(range(min = 0.0, max = 400.0))]
    pub vi: Option<f64>,
    /// Another property of the oil instead of the viscosity, such as `rheology.tau0`.
    pub property: Option<String>,
    /// Its values, each as in a gearbox: `[4 MPa, 6 MPa]`.
    #[serde(default)]
    pub values: Vec<Value>,
    /// Adds values between the listed ones until the minimum loss is found.
    #[serde(default = "yes")]
    pub refine: bool,
    /// Limits by name, which an oil must keep: a life, a film ratio, a temperature.
    #[serde(default)]
    pub limits: Ordered<LimitEntry>,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
}

fn yes() -> bool {
    true
}

register_analysis!(FluidSweepEntry);

/// Mean losses over one property of an oil with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FluidSweepOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub fluid_sweep: Vec<FluidsOfSet>,
    /// Temperature at the start of the cycles, if the study states it. [degC]
    pub start_degc: Option<f64>,
    /// Quantities outside their stated ranges with any oil, by set.
    #[serde(skip)]
    pub left: Vec<(String, String)>,
}

/// Mean losses over one property of an oil with one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FluidsOfSet {
    /// Name of the set.
    pub model_set: String,
    /// The property with its unit.
    pub property: String,
    /// Names of the shares of the loss of all sets.
    pub shares: Vec<String>,
    /// The limits.
    pub limits: Vec<LimitRecord>,
    /// One for each cycle.
    pub cycles: Vec<FluidsOfDuty>,
    /// Unit of the property.
    #[serde(skip)]
    pub unit: &'static str,
}

/// Mean losses of one cycle over one property of an oil.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FluidsOfDuty {
    /// Name of the cycle.
    pub cycle: String,
    /// The lowest-loss oil.
    pub least: LeastLoss,
    /// The listed or refined oil with the least loss that keeps all limits; null without limits, or if none keeps them.
    pub least_within_limits: Option<OilWithinLimits>,
    /// The listed or refined oil with the least consumption; null without a battery or without distance.
    pub least_consumption: Option<OilOfLeastConsumption>,
    /// The oil as described.
    pub present: PresentOil,
    /// The oils in ascending order of the value.
    pub fluids: Vec<LossOfFluid>,
}

/// Mean loss of one cycle with the oil as described.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PresentOil {
    /// Value of the property, in its unit; null if the description has none.
    pub value: Option<f64>,
    /// Mean loss of the transmission. [W]
    pub mean_loss_w: f64,
    /// Energy of the vehicle; absent without a battery or without distance.
    pub consumption: Option<Consumption>,
}

/// The oil with the least loss that keeps all limits.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct OilWithinLimits {
    /// Value of the property, in its unit.
    pub value: f64,
    /// Mean loss of the transmission. [W]
    pub mean_loss_w: f64,
}

/// The oil with which the vehicle uses least.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct OilOfLeastConsumption {
    /// Value of the property, in its unit.
    pub value: f64,
    /// Consumption. [kWh/100 km]
    pub consumption_kwh_per_100_km: f64,
    /// Range with the usable energy; absent if more is recuperated than drawn. [km]
    pub range_km: Option<f64>,
}

/// Mean loss of one cycle with one oil.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LossOfFluid {
    /// Value of the property, in its unit.
    pub value: f64,
    /// Mean loss of the transmission. [W]
    pub mean_loss_w: f64,
    /// The same by share, in the order of the names. [W]
    pub mean_losses_w: Vec<f64>,
    /// Energy of the vehicle; absent without a battery or without distance.
    pub consumption: Option<Consumption>,
    /// True if the property is not defined: viscosity index below 2 mm2/s.
    pub beyond_definition: bool,
    /// True if the value was added by the search for the minimum loss.
    pub refined: bool,
    /// Limited quantities over all cycles, in the order and the units of the limits; null where one is unknown.
    pub limited: Vec<Option<f64>>,
    /// Whether it keeps all limits.
    pub keeps_limits: bool,
}

/// Results of one hypothetical oil.
struct Fluid {
    /// Value of the property: mm2/s at 100 degC, or in the unit of the path.
    value: f64,
    /// Mean loss of each cycle.
    losses: Vec<MeanLoss>,
    /// Limited quantities.
    limited: Vec<f64>,
    /// True if it was added by the search for the minimum loss.
    refined: bool,
}

/// Simulates oils with one set.
struct Search<'a> {
    engine: &'a Engine<'a>,
    entry: &'a FluidSweepEntry,
    duties: &'a Duties<'a>,
    names: &'a [String],
    swept: &'a Swept,
    trial: Trial<'a>,
    limits: &'a [Limit],
    /// Label of the progress.
    label: String,
    /// Ascending by value.
    fluids: Vec<Fluid>,
    /// Results of each cycle with the oil as described, and its limited quantities.
    present: (Vec<MeanLoss>, Vec<f64>),
    left: Left,
}

/// The gearbox with each set, its cycles, and the oils.
pub struct FluidSweepPlan<'a> {
    drive: DrivePlan<'a>,
    oils: Vec<Oils>,
}

/// The oils of one set.
struct Oils {
    swept: Swept,
    values: Vec<f64>,
    limits: Vec<Limit>,
}

impl Plan for FluidSweepPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |(b, oils): (&Arc<Built<'_>>, &Oils)| Work::new(&b.name, "oil", oils.values.len() + 1);
        self.drive.built.iter().zip(&self.oils).map(work).collect()
    }
}

impl Analysis for FluidSweepEntry {
    const TYPE: &'static str = "fluid_sweep";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = FluidSweepPlan<'a>;
    type Outcome = FluidSweepOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::driving(&self.drive)
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<FluidSweepPlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.drive.gearbox.as_ref())?;
        sums_energies(cx, &path, self.by)?;
        self.check_keys(cx, &path)?;
        let duties = Duties::new(cx, &path, &self.drive.ride, self.drive.gear.as_ref().map(Into::into))?;
        let drive = DrivePlan::new(cx, &path, duties, cx.built(gearbox, &self.drive.model_sets)?)?;
        let oils = |b: &Arc<Built<'a>>| {
            let swept = Swept::new(cx, &path, self, b)?;
            let values = swept.values(cx, &path, self)?;
            let limits = limits_of(cx, &path, &self.limits, &drive.duties, b)?;
            let trial = Trial::new(cx, b);
            for value in &values {
                let oil = swept.overrides(*value).and_then(|changes| trial.build(changes));
                oil.map_err(|reason| failed(cx, &value.to_string(), &reason))?;
            }
            Ok(Oils { swept, values, limits })
        };
        let oils = drive.built.iter().map(oils).collect::<Result<_, Stopped>>()?;
        Ok(FluidSweepPlan { drive, oils })
    }

    fn reduce<'a>(&'a self, plan: FluidSweepPlan<'a>, engine: &Engine<'a>) -> Result<FluidSweepOutcome, Stopped> {
        let DrivePlan { built, duties } = &plan.drive;
        let names = together(built.iter().map(|b| &b.transmission), self.by);
        let mut all_left = Vec::new();
        let sets = engine.parts(built.iter().zip(&plan.oils), |(b, oils)| {
            let mut search = Search {
                engine,
                entry: self,
                duties,
                names: &names,
                swept: &oils.swept,
                trial: Trial::new(engine, b),
                limits: &oils.limits,
                label: format!("{} oils", b.name),
                fluids: Vec::new(),
                present: Default::default(),
                left: Left::new(),
            };
            search.drive_present()?;
            search.drive(&oils.values, false)?;
            if self.refine {
                search.refine()?;
            }
            search.note_limits(b);
            let set = search.result(b);
            all_left.extend(search.left);
            Ok(set)
        })?;
        Ok(FluidSweepOutcome {
            head: engine.head(built),
            fluid_sweep: sets,
            start_degc: self.drive.ride.start,
            left: all_left,
        })
    }
}

impl FluidSweepEntry {
    /// Rejects contradictory keys.
    fn check_keys(&self, cx: &Planner<'_>, path: &str) -> Result<(), Stopped> {
        let viscosity = !self.kv100.is_empty() || self.vi.is_some();
        let message = match (&self.property, viscosity, self.values.is_empty()) {
            (Some(_), true, _) => "both `property` and `kv100` or `vi`",
            (None, _, false) => "`values` without a `property`",
            _ => return Ok(()),
        };
        let help = "sweep the viscosity by `kv100`, or one `property` by its `values`";
        Err(cx.wrong(path, message, help))
    }
}

impl Search<'_> {
    /// Simulates all cycles with the oil as described.
    fn drive_present(&mut self) -> Result<(), Stopped> {
        let losses = self.engine.jobs(&self.label, 1, |_| Ok(self.mean_losses(Vec::new())))?;
        for result in losses {
            let (losses, limited, _) = result.map_err(|reason| failed(self.engine, "the oil as described", &reason))?;
            self.present = (losses, limited);
        }
        Ok(())
    }

    /// Simulates all cycles with oils of some values, and stores the results.
    fn drive(&mut self, values: &[f64], refined: bool) -> Result<(), Stopped> {
        let losses = |i: usize| self.mean_losses(self.swept.overrides(values[i])?);
        let all = self.engine.jobs(&self.label, values.len(), |i| Ok(losses(i)))?;
        for (value, result) in values.iter().copied().zip(all) {
            let (losses, limited, more) = result.map_err(|reason| failed(self.engine, &value.to_string(), &reason))?;
            self.left.extend(more);
            self.fluids.push(Fluid {
                value,
                losses,
                limited,
                refined,
            });
        }
        self.fluids.sort_by(|a, b| a.value.total_cmp(&b.value));
        Ok(())
    }

    /// Mean loss of each cycle, limited quantities, and quantities outside their stated ranges.
    fn mean_losses(&self, overrides: Vec<(String, Value)>) -> Result<(Vec<MeanLoss>, Vec<f64>, Left), String> {
        let (t, ratings) = built(&self.trial, self.limits, overrides)?;
        let driven = self
            .duties
            .drive_all(&t, &|| self.engine.should_continue())
            .map_err(Unfinished::text)?;
        let limited = values(self.limits, self.duties, &t, ratings.as_ref(), &driven)?;
        let (losses, left) = self.duties.mean_losses_of(&t, &driven, self.entry.by, self.names);
        Ok((losses, limited, left))
    }

    /// Simulates further oils: in each round, for every cycle, the oil at the minimum of a parabola through the three best oils.
    fn refine(&mut self) -> Result<(), Stopped> {
        for _ in 0..least::ROUNDS {
            let duties = 0..self.duties.list.len();
            let mut wanted: Vec<f64> = duties.filter_map(|k| least::wanted(&self.points(k))).collect();
            wanted.sort_by(f64::total_cmp);
            wanted.dedup_by(|a, b| (*a / *b - 1.0).abs() < 1e-6);
            if wanted.is_empty() {
                break;
            }
            self.drive(&wanted, true)?;
        }
        Ok(())
    }

    /// Value and mean loss of each oil for a cycle.
    fn points(&self, duty: usize) -> Vec<(f64, f64)> {
        self.fluids.iter().map(|f| (f.value, f.losses[duty].loss)).collect()
    }

    /// The driven oil with the least loss of a cycle that keeps all limits.
    fn least_within_limits(&self, duty: usize) -> Option<OilWithinLimits> {
        let kept = self
            .fluids
            .iter()
            .filter(|fluid| violation(self.limits, &fluid.limited) == 0.0);
        let least = kept.min_by(|a, b| a.losses[duty].loss.total_cmp(&b.losses[duty].loss));
        let least = least.filter(|_| !self.limits.is_empty());
        least.map(|fluid| OilWithinLimits {
            value: fluid.value,
            mean_loss_w: fluid.losses[duty].loss,
        })
    }

    /// The driven oil with the least consumption of a cycle.
    fn least_consumption(&self, duty: usize) -> Option<OilOfLeastConsumption> {
        let used = self.fluids.iter().filter_map(|fluid| {
            let consumption = fluid.losses[duty].consumption?;
            Some(OilOfLeastConsumption {
                value: fluid.value,
                consumption_kwh_per_100_km: consumption.consumption_kwh_per_100_km,
                range_km: consumption.range_km,
            })
        });
        used.min_by(|a, b| a.consumption_kwh_per_100_km.total_cmp(&b.consumption_kwh_per_100_km))
    }

    /// Notes the limited values of the oil with the least loss among those that break the limits least.
    fn note_limits(&self, b: &Built<'_>) {
        let total = |fluid: &Fluid| fluid.losses.iter().map(|loss| loss.loss).sum::<f64>();
        let broken = |fluid: &Fluid| violation(self.limits, &fluid.limited);
        let better = |a: &&Fluid, b: &&Fluid| broken(a).total_cmp(&broken(b)).then(total(a).total_cmp(&total(b)));
        if let Some(best) = self.fluids.iter().min_by(better) {
            note_proposed(self.engine, &b.name, self.limits, &best.limited, "the best oil");
        }
    }

    fn result(&self, b: &Built<'_>) -> FluidsOfSet {
        let loss = |k: usize| {
            move |f: &Fluid| LossOfFluid {
                value: f.value,
                mean_loss_w: f.losses[k].loss,
                mean_losses_w: f.losses[k].shares.clone(),
                consumption: f.losses[k].consumption,
                beyond_definition: self.swept.is_beyond(f.value),
                refined: f.refined,
                limited: f.limited.iter().map(|x| Some(*x).filter(|x| x.is_finite())).collect(),
                keeps_limits: violation(self.limits, &f.limited) == 0.0,
            }
        };
        let duties = self.duties.list.iter().enumerate();
        FluidsOfSet {
            model_set: b.name.clone(),
            property: self.swept.name(),
            shares: self.names.to_vec(),
            limits: self
                .limits
                .iter()
                .zip(&self.present.1)
                .map(|(limit, x)| limit.record(Some(*x)))
                .collect(),
            cycles: duties
                .map(|(k, read)| FluidsOfDuty {
                    cycle: read.name.clone(),
                    least: LeastLoss::new(&self.points(k)),
                    least_within_limits: self.least_within_limits(k),
                    least_consumption: self.least_consumption(k),
                    present: PresentOil {
                        value: self.swept.present(),
                        mean_loss_w: self.present.0[k].loss,
                        consumption: self.present.0[k].consumption,
                    },
                    fluids: self.fluids.iter().map(loss(k)).collect(),
                })
                .collect(),
            unit: self.swept.unit(),
        }
    }
}

/// An oil with which a cycle cannot be simulated.
fn failed(cx: &Planner<'_>, oil: &str, reason: &str) -> Stopped {
    let help = "delete the value, or narrow the range";
    cx.wrong(&cx.path(), format!("{oil}: {reason}"), help)
}

impl Outcome for FluidSweepOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let first = self.fluid_sweep.first();
        let unit = first.map_or("-", |set| set.unit);
        let shares = first.map_or(&[][..], |set| &set.shares);
        let limits = first.map_or(&[][..], |set| &set.limits);
        let mut rows = Vec::new();
        for set in &self.fluid_sweep {
            for duty in &set.cycles {
                rows.extend(duty.fluids.iter().map(|fluid| (set, duty, fluid)));
            }
        }
        let has_consumption = rows.iter().any(|(.., fluid)| fluid.consumption.is_some());
        let table = Table::of(&self.head.analysis, rows)
            .text("model_set", "Model set", |(set, ..)| &set.model_set)
            .text("cycle", "Duty cycle", |(_, duty, _)| &duty.cycle)
            .fields_in(unit, "value", |(.., fluid)| fluid)
            .fields("beyond_definition refined mean_loss_w", |(.., fluid)| fluid)
            .each(shares.iter().enumerate(), |table, (i, share)| {
                let meaning = format!("Mean loss of the share {share}");
                table.number(format!("{share}_w"), "W", meaning, |(.., fluid)| fluid.mean_losses_w[i])
            })
            .each(
                Consumption::COLUMNS.iter().filter(|_| has_consumption),
                |table, column| {
                    table.number(column.name, column.unit, column.meaning, |(.., fluid)| {
                        fluid.consumption.as_ref().and_then(column.read)
                    })
                },
            )
            .each(limits.iter().enumerate(), |table, (i, limit)| {
                let meaning = format!("{} over all cycles", limit.quantity);
                table.number(
                    format!("{}_limited", limit.limit),
                    limit.unit.clone(),
                    meaning,
                    |(.., fluid)| fluid.limited[i],
                )
            });
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.left.iter().collect()
    }
}
