//! Proposed measurements from the points of a grid.

use gearloss_numerics::design::{Choice, Precision, Rule};
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::{NextEntry, RuleEntry};
use super::found::Found;
use crate::analyses::common::axes::grid_axes;
use crate::analyses::{Built, Planner, Stopped};
use crate::identify::{Candidate, Fitted, Identification, NextPlan};
use crate::numbers::{RPM, tidy};

/// All points that the rig can run.
pub(super) struct Candidates {
    all: Vec<Candidate>,
    gear: String,
    axes: (Vec<f64>, Vec<f64>),
    oils: Vec<Option<f64>>,
}

/// Proposed points, with all candidates.
#[derive(Debug, Clone)]
pub struct Next {
    /// All points that the rig can run.
    pub candidates: Vec<Candidate>,
    /// The chosen points, and the gain of each candidate.
    pub plan: NextPlan,
    /// Requested number.
    pub count: u32,
    /// Gear state.
    pub gear: String,
    /// Torques in Nm and speeds in rad/s of the grid.
    pub axes: (Vec<f64>, Vec<f64>),
    /// Temperatures in the order of the candidates; a single empty one for the temperature of the study.
    pub oils: Vec<Option<f64>>,
    /// Design criterion.
    pub rule: RuleEntry,
}

/// Proposed measurements.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct NextOfSet {
    /// Design criterion.
    pub rule: RuleEntry,
    /// Gear state.
    pub gear: String,
    /// Parameters of the plan.
    pub parameters: Vec<String>,
    /// Number of alternative plans, for other parameters of the joint region.
    pub other_plans: usize,
    /// Current precision of the parameters.
    pub before: PrecisionOfSet,
    /// Expected precision with the points of the plan.
    pub after: PrecisionOfSet,
    /// The points in measurement order.
    pub points: Vec<NextPoint>,
}

/// Joint precision of parameters.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PrecisionOfSet {
    /// Logarithm of the determinant of the covariance. [-]
    pub ln_determinant: f64,
    /// Sum of the variances, each relative to the square of its range. [-]
    pub trace: f64,
    /// Standard deviation of each parameter relative to its range. [-]
    pub deviations_over_ranges: Vec<f64>,
}

/// A proposed point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct NextPoint {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature; absent: from the study. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Gain by the rule, given the previous points. [-]
    pub gain: f64,
    /// One, plus the cost of the change from the previous point. [-]
    pub cost: f64,
    /// Number of alternative plans without this point.
    pub lacking_in_other_plans: usize,
}

impl From<&Precision> for PrecisionOfSet {
    fn from(precision: &Precision) -> Self {
        Self {
            ln_determinant: precision.ln_determinant,
            trace: precision.trace,
            deviations_over_ranges: precision.deviations.clone(),
        }
    }
}

impl Next {
    /// The published record; `found` belongs to its set.
    pub(super) fn record(&self, found: &Found) -> NextOfSet {
        let point = |choice: &Choice| {
            let at = &self.candidates[choice.candidate];
            let mut lacking = self.plan.lacking.iter();
            NextPoint {
                torque_nm: at.torque,
                speed_rpm: tidy(at.speed * RPM),
                oil_temperature_degc: at.oil,
                gain: choice.gain,
                cost: choice.cost,
                lacking_in_other_plans: lacking.find(|(k, _)| *k == choice.candidate).map_or(0, |(_, n)| *n),
            }
        };
        let parameters = self.plan.parameters.iter();
        NextOfSet {
            rule: self.rule,
            gear: self.gear.clone(),
            parameters: parameters.map(|k| found.parameters[*k].name.clone()).collect(),
            other_plans: self.plan.others,
            before: (&self.plan.plan.before).into(),
            after: (&self.plan.plan.after).into(),
            points: self.plan.plan.choices.iter().map(point).collect(),
        }
    }
}

/// The candidates of an entry, before the fit.
pub(super) fn candidates(cx: &Planner<'_>, entry: &NextEntry, built: &Built<'_>) -> Result<Candidates, Stopped> {
    let path = format!("{}.next", cx.path());
    let grid = cx.study.grid(&path, &entry.grid)?;
    if !grid.bind.is_empty() || grid.envelope.is_some() {
        let message = "proposed measurements need a grid without bound values and envelope";
        return Err(cx.wrong(&format!("{path}.grid"), message, "give it its own grid"));
    }
    let gear = cx.one_gear(&format!("{path}.grid"), grid, &built.transmission)?;
    let (torques, speeds) = grid_axes(cx, &entry.grid, grid, &built.transmission)?;
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

/// Proposed measurements, or why there are none.
pub(super) fn plan(
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
        count: entry.points,
        gear,
        axes,
        oils,
        rule: entry.rule,
    })
}
