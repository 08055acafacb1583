//! The search: all combinations if they are few, otherwise generations and a refinement of the numbers.

use std::collections::BTreeMap;

use gearloss_numerics::search::{Design, Evolution, Gene, Refinement, Score, best, front};

use super::OptimiseEntry;
use super::drives::{Drive, Drives};
use super::objectives::Objective;
use crate::analyses::Stopped;

/// Share of the designs for refining numbers.
const REFINED: f64 = 0.25;

/// Step of a refinement at its start, as a share of the range.
const STEP: f64 = 0.05;

/// All designs of a search.
pub struct Search<'a> {
    drives: &'a Drives<'a>,
    entry: &'a OptimiseEntry,
    objectives: &'a [Objective],
    /// Values of the design as described, by objective.
    present: Vec<f64>,
    genes: Vec<Gene>,
    /// Evaluated designs, in their order.
    pub designs: Vec<Design>,
    /// What was driven, absent if it could not be.
    pub driven: Vec<Result<Drive, String>>,
    /// Index of a design by the bits of its genes.
    known: BTreeMap<Vec<u64>, usize>,
    /// Whether every combination was evaluated.
    pub is_exhaustive: bool,
}

impl<'a> Search<'a> {
    pub fn new(drives: &'a Drives<'a>, entry: &'a OptimiseEntry, present: &Drive, objectives: &'a [Objective]) -> Self {
        Self {
            drives,
            entry,
            objectives,
            present: objectives.iter().map(|objective| objective.value(present)).collect(),
            genes: drives.genes(),
            designs: Vec::new(),
            driven: Vec::new(),
            known: BTreeMap::new(),
            is_exhaustive: false,
        }
    }

    /// Evaluates designs until the search or its number of designs ends.
    pub fn run(&mut self) -> Result<(), Stopped> {
        let most = self.entry.designs as usize;
        if let Some(all) = self.combinations(most) {
            self.is_exhaustive = true;
            self.evaluate("designs", all)?;
            return Ok(());
        }
        let has_numbers = self.genes.contains(&Gene::Number);
        let kept_back = if has_numbers {
            (REFINED * most as f64) as usize
        } else {
            0
        };
        self.evolve(most - kept_back)?;
        for objective in 0..self.objectives.len() {
            let share = (most - self.designs.len()) / (self.objectives.len() - objective);
            self.refine(objective, self.designs.len() + share)?;
        }
        Ok(())
    }

    /// Every combination of choices, if all variables are choices and they are few enough.
    fn combinations(&self, most: usize) -> Option<Vec<Vec<f64>>> {
        let mut all: Vec<Vec<f64>> = vec![Vec::new()];
        for gene in &self.genes {
            let Gene::Choice(count) = gene else { return None };
            if all.len().saturating_mul(*count) > most {
                return None;
            }
            let longer = |start: &Vec<f64>| {
                let start = start.clone();
                (0..*count).map(move |choice| [start.as_slice(), &[choice as f64]].concat())
            };
            all = all.iter().flat_map(longer).collect();
        }
        Some(all)
    }

    fn evolve(&mut self, most: usize) -> Result<(), Stopped> {
        let usual = (8 + 4 * self.genes.len()).min(64);
        let size = self.entry.population.map_or(usual, |stated| stated as usize).min(most);
        let mut evolution = Evolution::new(self.genes.clone(), size, u64::from(self.entry.seed));
        let start: Vec<f64> = self
            .drives
            .variables
            .iter()
            .map(super::variables::Variable::present)
            .collect();
        let first = evolution.first(vec![start]);
        let first = first.map_err(|reason| {
            self.drives
                .engine
                .wrong(&self.drives.engine.path(), reason, "use fewer variables")
        })?;
        let evaluated = self.evaluate("designs", first)?;
        evolution.select(evaluated);
        while self.designs.len() < most {
            let mut next = evolution.children(&|genes| self.known.contains_key(&bits(genes)));
            next.truncate(most - self.designs.len());
            if next.is_empty() {
                break;
            }
            let evaluated = self.evaluate("designs", next)?;
            evolution.select(evaluated);
        }
        Ok(())
    }

    /// Refines the numbers of the best design of an objective.
    fn refine(&mut self, objective: usize, most: usize) -> Result<(), Stopped> {
        let Some(start) = best(&self.designs, objective).filter(|design| design.score.is_feasible()) else {
            return Ok(());
        };
        let mut refinement = Refinement::new(&self.genes, start.clone(), objective, STEP);
        while !refinement.is_done() {
            let neighbours = refinement.neighbours();
            // Two steps follow.
            if self.designs.len() + neighbours.len() + 2 > most {
                break;
            }
            let mut all = self.evaluate("refined designs", neighbours)?;
            let steps = refinement.steps(&all);
            all.extend(self.evaluate("refined designs", steps)?);
            refinement.learn(&all);
        }
        Ok(())
    }

    /// The scores of designs, which are driven if they are new.
    fn evaluate(&mut self, label: &str, designs: Vec<Vec<f64>>) -> Result<Vec<Design>, Stopped> {
        let mut new: Vec<Vec<f64>> = Vec::new();
        for genes in &designs {
            if !self.known.contains_key(&bits(genes)) && !new.contains(genes) {
                new.push(genes.clone());
            }
        }
        let driven = self.drives.drive_all(label, &new)?;
        for (genes, drive) in new.into_iter().zip(driven) {
            let score = match &drive {
                Ok(drive) => Score {
                    objectives: self.objectives.iter().map(|objective| objective.value(drive)).collect(),
                    violation: self.drives.violation(drive),
                },
                Err(_) => Score {
                    objectives: vec![f64::INFINITY; self.objectives.len()],
                    violation: f64::INFINITY,
                },
            };
            self.known.insert(bits(&genes), self.designs.len());
            self.designs.push(Design { genes, score });
            self.driven.push(drive);
        }
        let known = designs.iter().filter_map(|genes| self.known.get(&bits(genes)));
        Ok(known.map(|i| self.designs[*i].clone()).collect())
    }

    /// The design with the least objectives, relative to those of the design as described: their mean over the objectives. Absent if no design
    /// keeps the limits.
    pub fn chosen(&self) -> Option<Design> {
        let sum = |design: &&Design| -> f64 {
            let pairs = design.score.objectives.iter().zip(&self.present);
            // A consumption may be negative, if more is recuperated than drawn.
            let relative = |(objective, present): (&f64, &f64)| {
                if *present < 0.0 {
                    1.0 + (objective - present) / present.abs()
                } else {
                    objective / present.max(f64::MIN_POSITIVE)
                }
            };
            pairs.map(relative).sum()
        };
        let feasible = self.designs.iter().filter(|design| design.score.is_feasible());
        feasible.min_by(|a, b| sum(a).total_cmp(&sum(b))).cloned()
    }

    /// Indices of the designs that keep the limits and that no other design beats in every objective, the least first objective first.
    pub fn front(&self) -> Vec<usize> {
        let mut all = front(&self.designs);
        all.retain(|i| self.designs[*i].score.is_feasible());
        let first = |i: &usize| self.designs[*i].score.objectives[0];
        all.sort_by(|a, b| first(a).total_cmp(&first(b)));
        all
    }
}

/// Genes as a key.
fn bits(genes: &[f64]) -> Vec<u64> {
    genes.iter().map(|x| x.to_bits()).collect()
}
