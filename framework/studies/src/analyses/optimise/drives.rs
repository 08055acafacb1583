//! Driven designs: losses of the cycles and limited quantities.

use gearloss_numerics::search::Gene;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::variables::Variable;
use crate::analyses::common::duties::{Duties, Unfinished};
use crate::analyses::common::limits_over_cycles::{built, mean_loss, values, violation};
use crate::analyses::common::trial::{Left, Trial, left};
use crate::analyses::{Engine, Planner, Stopped};
use crate::duty::Consumption;
use crate::limits::Limit;

/// What is driven, and how designs are built.
pub struct Drives<'a> {
    pub engine: &'a Engine<'a>,
    pub duties: &'a Duties<'a>,
    pub trial: Trial<'a>,
    pub variables: &'a [Variable],
    pub limits: &'a [Limit],
}

/// A driven design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Mean loss of each cycle. \[W\]
    pub losses: Vec<f64>,
    /// Energy of the vehicle over each cycle; absent without a battery or without distance.
    pub consumptions: Vec<Option<Consumption>>,
    /// Limited quantities, in the order and the units of the limits.
    pub limited: Vec<f64>,
    /// Quantities outside their stated ranges.
    pub left: Left,
}

impl Drives<'_> {
    /// The genes of the variables.
    pub fn genes(&self) -> Vec<Gene> {
        self.variables.iter().map(Variable::gene).collect()
    }

    /// The design as described.
    pub fn present(&self) -> Result<Drive, Stopped> {
        let mut driven = self
            .engine
            .jobs("design as described", 1, |_| Ok(self.drive(Vec::new())))?;
        driven.remove(0).map_err(|reason| {
            let help = "examine it with an analysis `cycle`";
            self.engine
                .wrong(&self.engine.path(), format!("the gearbox as described: {reason}"), help)
        })
    }

    /// Overrides of the variables of a subset; the others are as described.
    pub fn overrides<'g>(&'g self, genes: &'g [f64], is_changed: impl Fn(usize) -> bool + 'g) -> Vec<(String, Value)> {
        let overridden = self
            .variables
            .iter()
            .zip(genes)
            .enumerate()
            .filter(move |(i, _)| is_changed(*i));
        overridden
            .flat_map(|(_, (variable, gene))| variable.overrides(*gene))
            .collect()
    }

    /// Drives all cycles with overrides.
    ///
    /// # Errors
    /// Why the gearbox cannot be built or driven.
    pub fn drive(&self, overrides: Vec<(String, Value)>) -> Result<Drive, String> {
        let (t, ratings) = built(&self.trial, self.limits, overrides)?;
        let driven = self
            .duties
            .drive_all(&t, &|| self.engine.should_continue())
            .map_err(Unfinished::text)?;
        Ok(Drive {
            losses: driven
                .iter()
                .map(|cycle| mean_loss(cycle).unwrap_or(f64::INFINITY))
                .collect(),
            consumptions: driven.iter().map(|cycle| self.duties.consumption(&t, cycle)).collect(),
            limited: values(self.limits, self.duties, &t, ratings.as_ref(), &driven)?,
            left: driven.iter().flat_map(|cycle| left(&t, &cycle.seen)).collect(),
        })
    }

    /// Drives designs with their genes, each as a task.
    pub fn drive_all(&self, label: &str, designs: &[Vec<f64>]) -> Result<Vec<Result<Drive, String>>, Stopped> {
        let drive = |i: usize| self.drive(self.overrides(&designs[i], |_| true));
        self.engine.jobs(label, designs.len(), |i| Ok(drive(i)))
    }

    /// Sum of the violations of the limits.
    pub fn violation(&self, drive: &Drive) -> f64 {
        violation(self.limits, &drive.limited)
    }
}

/// Rejects a chosen value with which the gearbox cannot be built. Of values that belong together, or that others follow, some may be
/// impossible: designs with them are counted, and only if none is possible, the first reason is an error.
pub fn check(cx: &Planner<'_>, trial: &Trial<'_>, variables: &[Variable]) -> Result<(), Stopped> {
    let is_followed = !cx.study.entry.conditions.follows.is_empty();
    for variable in variables {
        let Gene::Choice(count) = variable.gene() else { continue };
        let mut faults = Vec::new();
        for choice in 0..count {
            if let Err(reason) = trial.build(variable.overrides(choice as f64)) {
                faults.push((choice, reason));
            }
        }
        let may_fail = variable.is_joint() || is_followed;
        if let Some((choice, reason)) = faults.first().filter(|_| !may_fail || faults.len() == count) {
            let path = format!("{}.variables.{}.values.{choice}", cx.path(), variable.name);
            return Err(cx.wrong(&path, reason.clone(), "correct the value, or delete it"));
        }
    }
    Ok(())
}
