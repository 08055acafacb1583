//! What to measure next, from the points of a grid.

use gearloss_framework::design::Rule;
use gearloss_framework::identify::{Candidate, Fitted, Identification, NextPlan};
use gearloss_framework::study::{NextEntry, RuleEntry};

use super::super::{Built, Runner, grid_axes};
use crate::output::Failure;

/// Points to be measured, with all candidates.
pub struct Next {
    pub candidates: Vec<Candidate>,
    pub plan: NextPlan,
    pub gear: String,
    /// Torques in Nm and speeds in rad/s of the grid.
    pub axes: (Vec<f64>, Vec<f64>),
    /// Temperatures, in the order of the candidates; one without value for that of the study.
    pub oils: Vec<Option<f64>>,
    pub rule: RuleEntry,
}

pub fn plan(
    runner: &Runner<'_>,
    name: &str,
    entry: &NextEntry,
    built: &Built<'_>,
    identification: &Identification<'_>,
    fitted: &Fitted,
) -> Result<Next, Failure> {
    let path = format!("analyses.{name}.next");
    let grid = runner.study.grid(&path, &entry.grid)?;
    if !grid.bind.is_empty() || grid.envelope.is_some() {
        let message = "points to be measured come from a grid without bound values and envelope";
        return Err(runner.wrong(&format!("{path}.grid"), message, "give it a grid of its own"));
    }
    let gear = runner.one_gear(&format!("{path}.grid"), grid, &built.transmission)?;
    let (torques, speeds) = grid_axes(runner, &entry.grid, grid, &built.transmission)?;
    let oils: Vec<Option<f64>> = match &entry.oil_temperatures[..] {
        [] => vec![None],
        list => list.iter().map(|oil| Some(*oil)).collect(),
    };
    let mut candidates = Vec::new();
    for oil in &oils {
        for torque in &torques {
            candidates.extend(speeds.iter().map(|speed| Candidate {
                torque: *torque,
                speed: *speed,
                oil: *oil,
            }));
        }
    }
    let rule = match entry.rule {
        RuleEntry::Worst => Rule::Worst,
        RuleEntry::Trace => Rule::Trace,
        RuleEntry::Determinant => Rule::Determinant,
    };
    let change = |a: &Candidate, b: &Candidate| {
        let torque = if a.torque == b.torque {
            0.0
        } else {
            entry.cost_of_torque
        };
        let oil = if a.oil == b.oil { 0.0 } else { entry.cost_of_temperature };
        torque + oil
    };
    let plan = identification.next(fitted, &candidates, &gear, (rule, entry.points as usize), change);
    let plan = plan.map_err(|reason| {
        runner.wrong(
            &path,
            reason,
            "leave such points out of the grid, or identify other parameters",
        )
    })?;
    Ok(Next {
        candidates,
        plan,
        gear,
        axes: (torques, speeds),
        oils,
        rule: entry.rule,
    })
}
