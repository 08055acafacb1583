//! What to measure next, from the points of a grid.

use gearloss_numerics::design::Rule;
use gearloss_studies::identify::{Candidate, Fitted, Identification, NextPlan};
use gearloss_studies::study::{NextEntry, RuleEntry};

use super::super::{Built, Runner, grid_axes};
use crate::output::Failure;

/// All points that the rig can run.
pub struct Candidates {
    all: Vec<Candidate>,
    gear: String,
    axes: (Vec<f64>, Vec<f64>),
    oils: Vec<Option<f64>>,
}

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

/// The candidates of an entry, before anything is fitted.
pub fn candidates(
    runner: &Runner<'_>,
    name: &str,
    entry: &NextEntry,
    built: &Built<'_>,
) -> Result<Candidates, Failure> {
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
    let mut all = Vec::new();
    for oil in &oils {
        for torque in &torques {
            all.extend(speeds.iter().map(|speed| Candidate {
                torque: *torque,
                speed: *speed,
                oil: *oil,
            }));
        }
    }
    Ok(Candidates {
        all,
        gear,
        axes: (torques, speeds),
        oils,
    })
}

/// What to measure next, or why nothing can be said.
pub fn plan(
    entry: &NextEntry,
    candidates: Candidates,
    identification: &Identification<'_>,
    fitted: &Fitted,
) -> Result<Next, String> {
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
    let Candidates { all, gear, axes, oils } = candidates;
    let plan = identification.next(fitted, &all, &gear, (rule, entry.points as usize), change)?;
    Ok(Next {
        candidates: all,
        plan,
        gear,
        axes,
        oils,
        rule: entry.rule,
    })
}
