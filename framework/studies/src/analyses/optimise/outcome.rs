//! Results of a search.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::OptimiseEntry;
use super::band::Band;
use super::changes::Change;
use super::drives::{Drive, Drives};
use super::search::Search;
use crate::analyses::limits::over_cycles::note_proposed;
use crate::analyses::limits::{Limit, LimitRecord};
use crate::analyses::trial::Left;
use crate::analyses::{Built, Head, Outcome, TextFile};
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
    /// True if every combination of the choices was evaluated.
    pub exhaustive: bool,
    /// Seed of the random numbers.
    pub seed: u32,
    /// The variables with their values as described and in the best design.
    pub variables: Vec<VariableOfSearch>,
    /// The limits.
    pub limits: Vec<LimitOfSearch>,
    /// Mean losses of the cycles.
    pub gains: Vec<GainOfCycle>,
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
}

/// Band of a gain under uncertain inputs.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct BandOfGain {
    /// Quantiles of 2.5, 50 and 97.5 %. [W]
    pub gain_w: [f64; 3],
    /// Number of samples.
    pub samples: usize,
    /// True if zero is inside the band: the gain is smaller than its uncertainty.
    pub contains_zero: bool,
}

impl BandOfGain {
    fn new(gain_w: [f64; 3], samples: usize) -> Self {
        Self {
            gain_w,
            samples,
            contains_zero: gain_w[0] <= 0.0 && gain_w[2] >= 0.0,
        }
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
    /// Gain of this change alone in each minimised cycle; null if it cannot be driven. [W]
    pub alone_w: Option<Vec<f64>>,
    /// Its share of the gain of all changes in each minimised cycle (Shapley value); null with more than eight changes. [W]
    pub share_w: Option<Vec<f64>>,
    /// Band of its gain alone in each minimised cycle; empty without uncertain inputs.
    pub bands: Vec<BandOfGain>,
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
    objectives: &[usize],
    changes: Vec<Change>,
    bands: Vec<Band>,
) -> OptimiseOutcome {
    let chosen = search.chosen();
    let best = chosen.as_ref().and_then(|design| {
        let place = search.designs.iter().position(|other| other == design)?;
        search.driven[place].as_ref().ok()
    });
    let front = search.front();
    let design = |i: usize| DesignOfSearch {
        design: i + 1,
        values: words(drives, &search.designs[i].genes),
        mean_losses_w: search.driven[i]
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
        exhaustive: search.is_exhaustive,
        seed: entry.seed,
        variables: variables(drives, genes, b),
        limits: limits(drives, present, best),
        gains: gains(drives, search, present, best, (objectives, &bands)),
        changes: ordered(changes, drives, genes, b, &bands),
        front: front.iter().map(|i| design(*i)).collect(),
        all: (0..search.designs.len()).map(design).collect(),
        found: genes.map_or_else(Vec::new, |genes| drives.overrides(genes, |_| true)),
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

fn variables(drives: &Drives<'_>, genes: Option<&[f64]>, b: &Built<'_>) -> Vec<VariableOfSearch> {
    let variables = drives.variables.iter().enumerate();
    let variable = |(i, entry): (usize, &super::Variable)| {
        let gene = genes.map(|genes| genes[i]);
        VariableOfSearch {
            variable: entry.name.clone(),
            path: entry.path.clone(),
            present: entry.present_words(b),
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

fn gains(
    drives: &Drives<'_>,
    search: &Search<'_>,
    present: &Drive,
    best: Option<&Drive>,
    (objectives, bands): (&[usize], &[Band]),
) -> Vec<GainOfCycle> {
    let cycles = drives.duties.list.iter().enumerate();
    let gain = |(cycle, read): (usize, &crate::analyses::duties::Read)| {
        let objective = objectives.iter().position(|known| *known == cycle);
        let feasible = search.designs.iter().zip(&search.driven);
        let feasible = feasible.filter(|(design, _)| design.score.is_feasible());
        let losses = feasible.filter_map(|(_, drive)| Some(drive.as_ref().ok()?.losses[cycle]));
        let band = objective.and_then(|objective| bands.get(objective));
        GainOfCycle {
            cycle: read.name.clone(),
            minimised: objective.is_some(),
            present_w: present.losses[cycle],
            best_w: best.map(|drive| drive.losses[cycle]),
            least_w: losses.min_by(f64::total_cmp),
            band: band.map(|band| BandOfGain::new(band.all, band.samples)),
        }
    };
    cycles.map(gain).collect()
}

/// The changes, the one that saves most in the first objective first.
fn ordered(
    changes: Vec<Change>,
    drives: &Drives<'_>,
    genes: Option<&[f64]>,
    b: &Built<'_>,
    bands: &[Band],
) -> Vec<ChangeOfDesign> {
    let Some(genes) = genes else { return Vec::new() };
    let change = |(place, saved): (usize, Change)| {
        let variable = &drives.variables[saved.variable];
        ChangeOfDesign {
            variable: variable.name.clone(),
            from: variable.present_words(b),
            to: variable.words(genes[saved.variable]),
            alone_w: saved.alone,
            share_w: saved.share,
            bands: bands
                .iter()
                .map(|band| BandOfGain::new(band.alone[place], band.samples))
                .collect(),
        }
    };
    let mut all: Vec<ChangeOfDesign> = changes.into_iter().enumerate().map(change).collect();
    let saved = |change: &ChangeOfDesign| {
        let list = change.share_w.as_ref().or(change.alone_w.as_ref());
        list.map_or(f64::NEG_INFINITY, |list| list[0])
    };
    all.sort_by(|a, b| saved(b).total_cmp(&saved(a)));
    all
}

impl Outcome for OptimiseOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let name = &self.head.analysis;
        let minimised: Vec<&GainOfCycle> = self.gains.iter().filter(|gain| gain.minimised).collect();
        let designs = Table::of(name, &self.all)
            .number("design", "-", "Number in the order of evaluation", |design| {
                design.design as f64
            })
            .each(self.variables.iter().enumerate(), |table, (i, variable)| {
                let meaning = format!("Value of {}", variable.path);
                table.text(variable.variable.clone(), meaning, move |design| &design.values[i])
            })
            .each(minimised.iter().enumerate(), |table, (i, cycle)| {
                let meaning = format!("Mean loss over {}", cycle.cycle);
                table.number(format!("{}_w", cycle.cycle), "W", meaning, move |design| {
                    design.mean_losses_w.as_ref().map(|all| all[i])
                })
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
            .each(minimised.iter().enumerate(), |table, (i, cycle)| {
                let of = &cycle.cycle;
                table
                    .number(
                        format!("{of}_alone_w"),
                        "W",
                        format!("Gain of the change alone over {of}"),
                        move |change| change.alone_w.as_ref().map(|all| all[i]),
                    )
                    .number(
                        format!("{of}_share_w"),
                        "W",
                        format!("Share of the gain of all changes over {of}"),
                        move |change| change.share_w.as_ref().map(|all| all[i]),
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
