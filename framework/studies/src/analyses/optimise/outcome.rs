//! Results of a search.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::OptimiseEntry;
use super::band::Band;
use super::changes::Change;
use super::drives::{Drive, Drives};
use super::objectives::{Minimised, Objective};
use super::search::Search;
use crate::analyses::common::limits_over_cycles::note_proposed;
use crate::analyses::common::trial::Left;
use crate::analyses::{Built, Head, Outcome, TextFile};
use crate::distinct::distinct;
use crate::duty::Consumption;
use crate::limits::{Limit, LimitRecord};
use crate::points::Note;
use crate::table::Table;

/// The best designs of a search, and what their changes save.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OptimiseOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// Name of the model set.
    pub model_set: String,
    /// Number of evaluated designs.
    pub designs: usize,
    /// Number of those that keep all limits.
    pub feasible: usize,
    /// Number of those that could not be built or driven, and the reason of the first.
    pub failed: usize,
    /// Why the first of them could not be.
    pub first_failure: Option<String>,
    /// Every reason with the number of designs, the most frequent first.
    pub failures: Vec<FailureOfSearch>,
    /// True if every combination of the choices was evaluated.
    pub exhaustive: bool,
    /// Seed of the random numbers.
    pub seed: u32,
    /// The variables with their values as described and in the best design.
    pub variables: Vec<VariableOfSearch>,
    /// The limits.
    pub limits: Vec<LimitOfSearch>,
    /// What is minimised.
    pub objectives: Vec<ObjectiveOfSearch>,
    /// Mean losses of the cycles, and the consumption of the vehicle.
    pub gains: Vec<GainOfCycle>,
    /// Cycles over which the design with the least loss is not that with the least consumption.
    pub disagreements: Vec<Disagreement>,
    /// The changes of the best design, the one that saves most first.
    pub changes: Vec<ChangeOfDesign>,
    /// Designs that keep the limits and that no other design beats in every objective, the least loss in the first one first.
    pub front: Vec<DesignOfSearch>,
    /// All evaluated designs, in their order.
    #[serde(skip)]
    pub all: Vec<DesignOfSearch>,
    /// Values of the best design: resolved path to value.
    #[serde(skip)]
    pub found: Vec<(String, Value)>,
    /// File name of the gearbox, relative to the study.
    #[serde(skip)]
    pub gearbox: String,
    /// Quantities outside their stated ranges in the best design.
    #[serde(skip)]
    pub left: Vec<(String, String)>,
}

/// Why designs could not be built or driven.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FailureOfSearch {
    /// The reason.
    pub reason: String,
    /// Number of designs.
    pub designs: usize,
}

impl FailureOfSearch {
    /// The reasons with their numbers, the most frequent first.
    pub fn all<'r>(reasons: impl Iterator<Item = &'r String>) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for reason in reasons {
            match all.iter_mut().find(|known| known.reason == *reason) {
                Some(known) => known.designs += 1,
                None => all.push(Self {
                    reason: reason.clone(),
                    designs: 1,
                }),
            }
        }
        all.sort_by_key(|failure| std::cmp::Reverse(failure.designs));
        all
    }
}

/// A variable of a search.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct VariableOfSearch {
    /// Name in the study.
    pub variable: String,
    /// Its path.
    pub path: String,
    /// Value as described.
    pub present: String,
    /// Value in the best design; null if no design keeps the limits.
    pub best: Option<String>,
    /// True if the number of the best design is at an end of its range.
    pub at_end_of_range: bool,
}

/// A limit of a search.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LimitOfSearch {
    /// The limit, and its value in the design as described.
    #[serde(flatten)]
    pub entry: LimitRecord,
    /// Value of the best design.
    pub best: Option<f64>,
    /// True if the best design is within 1 % of the limit, or within 1 K.
    pub binding: bool,
}

/// A minimised quantity before and after.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ObjectiveOfSearch {
    /// The quantity.
    pub quantity: Minimised,
    /// Name of the cycle.
    pub cycle: String,
    /// Unit of its values.
    pub unit: &'static str,
    /// Value of the design as described. [unit]
    pub present: f64,
    /// Value of the best design. [unit]
    pub best: Option<f64>,
    /// Least value of any design that keeps the limits. [unit]
    pub least: Option<f64>,
    /// Band of the gain under the uncertain inputs.
    pub band: Option<BandOfGain>,
}

/// Consumption of the vehicle over a cycle before and after.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ConsumptionOfSearch {
    /// Whether it is minimised.
    pub minimised: bool,
    /// Of the design as described.
    pub present: Consumption,
    /// Of the best design.
    pub best: Option<Consumption>,
    /// Least consumption of any design that keeps the limits. [kWh/100 km]
    pub least_kwh_per_100_km: Option<f64>,
}

/// A cycle over which the least loss of the gearbox and the least consumption belong to different designs.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Disagreement {
    /// Name of the cycle.
    pub cycle: String,
    /// The design with the least mean loss of those that keep the limits.
    pub least_loss: DesignOfDisagreement,
    /// The one with the least consumption.
    pub least_consumption: DesignOfDisagreement,
}

/// One of two designs that differ.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DesignOfDisagreement {
    /// Number in the order of evaluation, from one.
    pub design: usize,
    /// Values of the variables, in their order.
    pub values: Vec<String>,
    /// Mean loss of the gearbox. [W]
    pub mean_loss_w: f64,
    /// Energy of the vehicle.
    pub consumption: Consumption,
}

/// Mean loss of a cycle before and after.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct GainOfCycle {
    /// Name of the cycle.
    pub cycle: String,
    /// Whether its loss is minimised.
    pub minimised: bool,
    /// Mean loss of the design as described. [W]
    pub present_w: f64,
    /// Mean loss of the best design. [W]
    pub best_w: Option<f64>,
    /// Least mean loss of any design that keeps the limits. [W]
    pub least_w: Option<f64>,
    /// Band of the gain under the uncertain inputs.
    pub band: Option<BandOfGain>,
    /// Consumption of the vehicle; absent without a battery or without distance.
    pub consumption: Option<ConsumptionOfSearch>,
}

/// Band of a gain under uncertain inputs.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct BandOfGain {
    /// Quantiles of 2.5, 50 and 97.5 % of a loss. [W]
    pub gain_w: Option<[f64; 3]>,
    /// The same of a consumption. [kWh/100 km]
    pub gain_kwh_per_100_km: Option<[f64; 3]>,
    /// Number of samples.
    pub samples: usize,
    /// True if zero is inside the band: the gain is smaller than its uncertainty.
    pub contains_zero: bool,
}

impl BandOfGain {
    fn new(quantity: Minimised, gain: [f64; 3], samples: usize) -> Self {
        let of = |wanted| (quantity == wanted).then_some(gain);
        Self {
            gain_w: of(Minimised::MeanLoss),
            gain_kwh_per_100_km: of(Minimised::Consumption),
            samples,
            contains_zero: gain[0] <= 0.0 && gain[2] >= 0.0,
        }
    }

    /// The quantiles in the unit of the objective.
    pub fn gain(&self) -> [f64; 3] {
        self.gain_w.or(self.gain_kwh_per_100_km).unwrap_or_default()
    }
}

/// A change of the best design.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChangeOfDesign {
    /// Name of the variable.
    pub variable: String,
    /// Value as described.
    pub from: String,
    /// Value in the best design.
    pub to: String,
    /// Gain of this change alone in each minimised loss; null if it cannot be driven. [W]
    pub alone_w: Option<Vec<f64>>,
    /// Its share of the gain of all changes in each minimised loss (Shapley value); null with more than eight changes. [W]
    pub share_w: Option<Vec<f64>>,
    /// Gain of this change alone in each minimised consumption. [kWh/100 km]
    pub alone_kwh_per_100_km: Option<Vec<f64>>,
    /// Its share of the gain of all changes in each minimised consumption. [kWh/100 km]
    pub share_kwh_per_100_km: Option<Vec<f64>>,
    /// Band of its gain alone in each objective; empty without uncertain inputs.
    pub bands: Vec<BandOfGain>,
    /// Gain of this change alone in each objective, in its unit.
    #[serde(skip)]
    pub alone: Option<Vec<f64>>,
    /// Its share of the gain of all changes in each objective, in its unit.
    #[serde(skip)]
    pub share: Option<Vec<f64>>,
}

/// An evaluated design.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DesignOfSearch {
    /// Number in the order of evaluation, from one.
    pub design: usize,
    /// Values of the variables, in their order.
    pub values: Vec<String>,
    /// Mean losses of the minimised cycles. [W]
    pub mean_losses_w: Option<Vec<f64>>,
    /// Consumption over the minimised cycles; absent without a battery or without distance. [kWh/100 km]
    pub consumptions_kwh_per_100_km: Option<Vec<f64>>,
    /// Values of the objectives, each in its unit.
    #[serde(skip)]
    pub objectives: Option<Vec<f64>>,
    /// Limited quantities, in the order and the units of the limits.
    pub limited: Vec<f64>,
    /// Sum of the relative violations of the limits.
    pub violation: Option<f64>,
    /// Whether it is on the front.
    pub on_front: bool,
}

/// Puts the results of a search together.
#[expect(
    clippy::too_many_arguments,
    reason = "called once, with what the parts of an analysis give"
)]
pub fn put_together(
    entry: &OptimiseEntry,
    b: &Arc<Built<'_>>,
    drives: &Drives<'_>,
    search: &Search<'_>,
    present: &Drive,
    objectives: &[Objective],
    changes: Vec<Change>,
    bands: Vec<Band>,
) -> OptimiseOutcome {
    let chosen = search.chosen();
    let best = chosen.as_ref().and_then(|design| {
        let place = search.designs.iter().position(|other| other == design)?;
        search.driven[place].as_ref().ok()
    });
    let front = search.front();
    let cycles = minimised_cycles(objectives);
    let consumptions = |drive: &Drive| -> Option<Vec<f64>> {
        let of = |cycle: &usize| Some(drive.consumptions[*cycle]?.consumption_kwh_per_100_km);
        cycles.iter().map(of).collect()
    };
    let design = |i: usize| DesignOfSearch {
        design: i + 1,
        values: words(drives, &search.designs[i].genes),
        mean_losses_w: search.driven[i]
            .as_ref()
            .ok()
            .map(|drive| cycles.iter().map(|cycle| drive.losses[*cycle]).collect()),
        consumptions_kwh_per_100_km: search.driven[i].as_ref().ok().and_then(&consumptions),
        objectives: search.driven[i]
            .is_ok()
            .then(|| search.designs[i].score.objectives.clone()),
        limited: search.driven[i]
            .as_ref()
            .map_or_else(|_| Vec::new(), |driven| driven.limited.clone()),
        violation: search.driven[i].is_ok().then_some(search.designs[i].score.violation),
        on_front: front.contains(&i),
    };
    let mut failures = search.driven.iter().filter_map(|driven| driven.as_ref().err());
    let first_failure = failures.next().cloned();
    let genes = chosen.as_ref().map(|design| design.genes.as_slice());
    let study = drives.engine.study;
    let gearbox = study
        .gearboxes
        .iter()
        .position(|(_, known)| std::ptr::eq(known, b.gearbox));
    let gearbox = gearbox.and_then(|i| study.entry.gearboxes.iter().nth(i));
    let proposed = best.unwrap_or(present);
    note_proposed(
        drives.engine,
        &b.name,
        drives.limits,
        &proposed.limited,
        "the best design",
    );
    OptimiseOutcome {
        head: drives.engine.head(&[Arc::clone(b)]),
        model_set: b.name.clone(),
        designs: search.designs.len(),
        feasible: search
            .designs
            .iter()
            .filter(|design| design.score.is_feasible())
            .count(),
        failed: usize::from(first_failure.is_some()) + failures.count(),
        first_failure,
        failures: FailureOfSearch::all(search.driven.iter().filter_map(|driven| driven.as_ref().err())),
        exhaustive: search.is_exhaustive,
        seed: entry.seed,
        variables: variables(drives, genes),
        limits: limits(drives, present, best),
        objectives: of_objectives(drives, search, present, best, (objectives, &bands)),
        gains: gains(drives, search, present, best, (objectives, &bands)),
        disagreements: disagreements(drives, search),
        changes: ordered(changes, drives, genes, (objectives, &bands)),
        front: front.iter().map(|i| design(*i)).collect(),
        all: (0..search.designs.len()).map(design).collect(),
        found: genes.map_or_else(Vec::new, |genes| {
            let mut found = drives.overrides(genes, |_| true);
            // A gearbox of its own has no formulas of the study.
            found.extend(drives.trial.followed(&found).unwrap_or_default());
            found
        }),
        gearbox: gearbox.map_or_else(String::new, |(_, file)| file.clone()),
        left: best
            .map_or_else(Left::new, |drive| drive.left.clone())
            .into_iter()
            .collect(),
    }
}

fn words(drives: &Drives<'_>, genes: &[f64]) -> Vec<String> {
    let pairs = drives.variables.iter().zip(genes);
    pairs.map(|(variable, gene)| variable.words(*gene)).collect()
}

fn variables(drives: &Drives<'_>, genes: Option<&[f64]>) -> Vec<VariableOfSearch> {
    let variables = drives.variables.iter().enumerate();
    let variable = |(i, entry): (usize, &super::Variable)| {
        let gene = genes.map(|genes| genes[i]);
        VariableOfSearch {
            variable: entry.name.clone(),
            path: entry.path.clone(),
            present: entry.present_words(),
            best: gene.map(|gene| entry.words(gene)),
            at_end_of_range: gene
                .is_some_and(|gene| entry.number(gene).is_some() && !(1e-3..=1.0 - 1e-3).contains(&gene)),
        }
    };
    variables.map(variable).collect()
}

fn limits(drives: &Drives<'_>, present: &Drive, best: Option<&Drive>) -> Vec<LimitOfSearch> {
    let limits = drives.limits.iter().enumerate();
    let limit = |(i, entry): (usize, &Limit)| {
        let best = best.map(|drive| drive.limited[i]).filter(|x| x.is_finite());
        let near = |value: f64, bound: &f64| {
            let width = if entry.unit.symbol == "degC" {
                1.0
            } else {
                0.01 * bound.abs()
            };
            (value - bound).abs() <= width
        };
        LimitOfSearch {
            entry: entry.record(Some(present.limited[i])),
            best,
            binding: best.is_some_and(|value| entry.bounds.iter().flatten().any(|bound| near(value, bound))),
        }
    };
    limits.map(limit).collect()
}

/// The cycles of the objectives, each once.
fn minimised_cycles(objectives: &[Objective]) -> Vec<usize> {
    let mut cycles: Vec<usize> = Vec::new();
    for objective in objectives {
        if !cycles.contains(&objective.cycle) {
            cycles.push(objective.cycle);
        }
    }
    cycles
}

/// The driven designs that keep the limits, with their index.
fn kept<'s>(search: &'s Search<'_>) -> impl Iterator<Item = (usize, &'s Drive)> {
    let all = search.designs.iter().zip(&search.driven).enumerate();
    all.filter(|(_, (design, _))| design.score.is_feasible())
        .filter_map(|(i, (_, drive))| Some((i, drive.as_ref().ok()?)))
}

fn of_objectives(
    drives: &Drives<'_>,
    search: &Search<'_>,
    present: &Drive,
    best: Option<&Drive>,
    (objectives, bands): (&[Objective], &[Band]),
) -> Vec<ObjectiveOfSearch> {
    let of = |(i, objective): (usize, &Objective)| ObjectiveOfSearch {
        quantity: objective.quantity,
        cycle: drives.duties.list[objective.cycle].name.clone(),
        unit: objective.quantity.unit(),
        present: objective.value(present),
        best: best.map(|drive| objective.value(drive)),
        least: kept(search)
            .map(|(_, drive)| objective.value(drive))
            .min_by(f64::total_cmp),
        band: bands
            .get(i)
            .map(|band| BandOfGain::new(objective.quantity, band.all, band.samples)),
    };
    objectives.iter().enumerate().map(of).collect()
}

fn gains(
    drives: &Drives<'_>,
    search: &Search<'_>,
    present: &Drive,
    best: Option<&Drive>,
    (objectives, bands): (&[Objective], &[Band]),
) -> Vec<GainOfCycle> {
    let cycles = drives.duties.list.iter().enumerate();
    let gain = |(cycle, read): (usize, &crate::analyses::common::duties::Read)| {
        let place = |quantity| {
            let wanted = Objective { quantity, cycle };
            objectives.iter().position(|known| *known == wanted)
        };
        let objective = place(Minimised::MeanLoss);
        let losses = kept(search).map(|(_, drive)| drive.losses[cycle]);
        let consumed = |drive: &Drive| Some(drive.consumptions[cycle]?.consumption_kwh_per_100_km);
        let band = objective.and_then(|objective| bands.get(objective));
        GainOfCycle {
            cycle: read.name.clone(),
            minimised: objective.is_some(),
            present_w: present.losses[cycle],
            best_w: best.map(|drive| drive.losses[cycle]),
            least_w: losses.min_by(f64::total_cmp),
            band: band.map(|band| BandOfGain::new(Minimised::MeanLoss, band.all, band.samples)),
            consumption: present.consumptions[cycle].map(|of_present| ConsumptionOfSearch {
                minimised: place(Minimised::Consumption).is_some(),
                present: of_present,
                best: best.and_then(|drive| drive.consumptions[cycle]),
                least_kwh_per_100_km: kept(search)
                    .filter_map(|(_, drive)| consumed(drive))
                    .min_by(f64::total_cmp),
            }),
        }
    };
    cycles.map(gain).collect()
}

/// Cycles with a consumption whose least value belongs to another design than the least loss.
fn disagreements(drives: &Drives<'_>, search: &Search<'_>) -> Vec<Disagreement> {
    let cycles = drives.duties.list.iter().enumerate();
    let disagreement = |(cycle, read): (usize, &crate::analyses::common::duties::Read)| {
        let designs =
            || kept(search).filter_map(|(i, drive)| Some((i, drive.losses[cycle], drive.consumptions[cycle]?)));
        let net = |design: &(usize, f64, Consumption)| design.2.consumption_kwh_per_100_km;
        let least_loss = designs().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let least_consumption = designs().min_by(|a, b| net(a).total_cmp(&net(b)))?;
        // Designs that differ by rounding errors do not disagree.
        let gain = net(&least_loss) - net(&least_consumption);
        if gain <= 1e-9 * net(&least_loss).abs() {
            return None;
        }
        let design = |(i, mean_loss_w, consumption): (usize, f64, Consumption)| DesignOfDisagreement {
            design: i + 1,
            values: words(drives, &search.designs[i].genes),
            mean_loss_w,
            consumption,
        };
        Some(Disagreement {
            cycle: read.name.clone(),
            least_loss: design(least_loss),
            least_consumption: design(least_consumption),
        })
    };
    cycles.filter_map(disagreement).collect()
}

/// The changes, the one that saves most in the first objective first.
fn ordered(
    changes: Vec<Change>,
    drives: &Drives<'_>,
    genes: Option<&[f64]>,
    (objectives, bands): (&[Objective], &[Band]),
) -> Vec<ChangeOfDesign> {
    let Some(genes) = genes else { return Vec::new() };
    let of = |wanted: Minimised, list: &Option<Vec<f64>>| -> Option<Vec<f64>> {
        let pairs = objectives.iter().zip(list.as_ref()?);
        let of_quantity = pairs.filter(|(objective, _)| objective.quantity == wanted);
        Some(of_quantity.map(|(_, gain)| *gain).collect())
    };
    let is_minimised = |wanted: Minimised| objectives.iter().any(|objective| objective.quantity == wanted);
    let consumed =
        |list: &Option<Vec<f64>>| of(Minimised::Consumption, list).filter(|_| is_minimised(Minimised::Consumption));
    let lost = |list: &Option<Vec<f64>>| of(Minimised::MeanLoss, list).filter(|_| is_minimised(Minimised::MeanLoss));
    let change = |(place, saved): (usize, Change)| {
        let variable = &drives.variables[saved.variable];
        ChangeOfDesign {
            variable: variable.name.clone(),
            from: variable.present_words(),
            to: variable.words(genes[saved.variable]),
            alone_w: lost(&saved.alone),
            share_w: lost(&saved.share),
            alone_kwh_per_100_km: consumed(&saved.alone),
            share_kwh_per_100_km: consumed(&saved.share),
            bands: bands
                .iter()
                .zip(objectives)
                .map(|(band, objective)| BandOfGain::new(objective.quantity, band.alone[place], band.samples))
                .collect(),
            alone: saved.alone,
            share: saved.share,
        }
    };
    let mut all: Vec<ChangeOfDesign> = changes.into_iter().enumerate().map(change).collect();
    let saved = |change: &ChangeOfDesign| {
        let list = change.share.as_ref().or(change.alone.as_ref());
        list.map_or(f64::NEG_INFINITY, |list| list[0])
    };
    all.sort_by(|a, b| saved(b).total_cmp(&saved(a)));
    all
}

impl OptimiseOutcome {
    /// The cycles of the objectives, each once.
    pub fn minimised_cycles(&self) -> Vec<&str> {
        distinct(self.objectives.iter().map(|objective| objective.cycle.as_str()))
    }
}

impl Outcome for OptimiseOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let name = &self.head.analysis;
        let cycles = self.minimised_cycles();
        let has_consumption = self
            .all
            .iter()
            .any(|design| design.consumptions_kwh_per_100_km.is_some());
        let consumed = cycles.iter().enumerate().filter(|_| has_consumption);
        let designs = Table::of(name, &self.all)
            .number("design", "-", "Number in the order of evaluation", |design| {
                design.design as f64
            })
            .each(self.variables.iter().enumerate(), |table, (i, variable)| {
                let meaning = format!("Value of {}", variable.path);
                table.text(variable.variable.clone(), meaning, move |design| &design.values[i])
            })
            .each(cycles.iter().enumerate(), |table, (i, cycle)| {
                let meaning = format!("Mean loss over {cycle}");
                table.number(format!("{cycle}_w"), "W", meaning, move |design| {
                    design.mean_losses_w.as_ref().map(|all| all[i])
                })
            })
            .each(consumed, |table, (i, cycle)| {
                let meaning = format!("Consumption over {cycle}");
                table.number(
                    format!("{cycle}_kwh_per_100_km"),
                    "kWh/100 km",
                    meaning,
                    move |design| design.consumptions_kwh_per_100_km.as_ref().map(|all| all[i]),
                )
            })
            .each(self.limits.iter().enumerate(), |table, (i, limit)| {
                let LimitRecord {
                    limit, quantity, unit, ..
                } = limit.entry.clone();
                table.number(format!("{limit}_limited"), unit, quantity, move |design| {
                    design.limited.get(i).copied()
                })
            })
            .fields("violation on_front", |design| design);
        let changes = Table::of(format!("{name}-changes"), &self.changes)
            .fields("variable from to", |change| change)
            .each(self.objectives.iter().enumerate(), |table, (i, objective)| {
                let (of, unit) = (&objective.cycle, objective.unit);
                let suffix = match objective.quantity {
                    Minimised::MeanLoss => "w",
                    Minimised::Consumption => "kwh_per_100_km",
                };
                table
                    .number(
                        format!("{of}_alone_{suffix}"),
                        unit,
                        format!("Gain of the change alone over {of}"),
                        move |change| change.alone.as_ref().map(|all| all[i]),
                    )
                    .number(
                        format!("{of}_share_{suffix}"),
                        unit,
                        format!("Share of the gain of all changes over {of}"),
                        move |change| change.share.as_ref().map(|all| all[i]),
                    )
            });
        vec![designs.finish(), changes.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.left.iter().collect()
    }

    fn found(&self) -> Vec<(String, Value)> {
        self.found.clone()
    }

    fn files(&self) -> Vec<TextFile> {
        if self.found.is_empty() {
            return Vec::new();
        }
        let mut text = format!(
            "# Best design of the analysis `{}`. Save it next to the study.\ngearloss: gearbox/1\nextends: {}\nset:\n",
            self.head.analysis, self.gearbox
        );
        for (path, value) in &self.found {
            text += &format!("  {}: {value}\n", Value::from(path.as_str()));
        }
        vec![TextFile {
            name: format!("{}-best.yaml", self.head.analysis),
            text,
        }]
    }
}
