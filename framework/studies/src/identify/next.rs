//! Experimental design: proposed measurements with the most information on the parameters.

use nalgebra::DMatrix;

use super::fit::JUMPS;
use super::{Fitted, Identification, Observation};
use crate::measured::{Measured, Row, Seen};
use crate::study::Quantity;
use gearloss_numerics::design::{Design, Information, Plan, Rule, uniform_row};
use gearloss_numerics::inference::Standing;
use gearloss_numerics::sensitivity::gradients;

/// Number of draws from the joint region for alternative plans, and its confidence.
const DRAWS: (u32, f64) = (5, 0.95);

/// A point that a rig can run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Oil temperature; absent: from the study. \[degC\]
    pub oil: Option<f64>,
}

/// Proposed points.
#[derive(Debug, Clone)]
pub struct NextPlan {
    /// The plan.
    pub plan: Plan,
    /// Standard deviation of the measured quantity at every candidate; efficiencies as fractions.
    pub deviations: Vec<f64>,
    /// Gain of each candidate as the only measurement.
    pub gains: Vec<f64>,
    /// Candidates of the plan that are absent from alternative plans, with the number of such plans.
    pub lacking: Vec<(usize, usize)>,
    /// Number of alternative plans.
    pub others: usize,
    /// Indices of the parameters of the plan.
    pub parameters: Vec<usize>,
}

impl Identification<'_> {
    /// Ranks candidates by their information in addition to the fitted points.
    ///
    /// # Errors
    /// If no parameter is free, or a candidate has no value.
    pub fn next(
        &self,
        fitted: &Fitted,
        candidates: &[Candidate],
        gear: &str,
        (rule, count): (Rule, usize),
        change_over: impl Fn(&Candidate, &Candidate) -> f64 + Sync,
    ) -> Result<NextPlan, String> {
        let inference = &fitted.inference;
        let free: Vec<usize> = (0..self.parameters.len())
            .filter(|k| inference.parameters()[*k].standing == Standing::Free && inference.column(*k) > 0.0)
            .collect();
        if free.is_empty() {
            return Err("no parameter is free".to_owned());
        }
        let quantity = self.observations.first().map_or(Quantity::Efficiency, |o| o.quantity);
        let shown = self.shown(fitted, candidates, gear, quantity)?;
        let observations: Vec<Observation> = (0..candidates.len())
            .map(|row| Observation {
                row,
                quantity,
                deviation: shown.deviations[row],
            })
            .collect();
        let there = self.with_rows(&shown.measured, observations)?;
        let rows = |u: &[f64]| -> Result<Vec<Vec<f64>>, String> {
            let mut parameters = inference.parameters().to_vec();
            for (parameter, u) in parameters.iter_mut().zip(u) {
                parameter.u = *u;
            }
            let slopes = gradients(&parameters, JUMPS, |theta| there.residuals(theta))?;
            Ok(slopes
                .iter()
                .map(|row| free.iter().map(|k| row[*k]).collect())
                .collect())
        };
        let ranges: Vec<f64> = free.iter().map(|k| inference.parameters()[*k].range()).collect();
        let derivative = fitted.fit().derivative.as_ref().ok_or("the fit has no derivatives")?;
        // Without accuracies residuals are not in units of their standard deviation, which is estimated from the scatter.
        let known = known(&derivative.jacobian, &free, &ranges, inference.scatter(), |k| {
            self.parameters[k].prior.is_some()
        });
        let information = Information::new(&ranges, &known)?;
        let cost = |a: usize, b: usize| change_over(&candidates[a], &candidates[b]);
        let plan = |u: &[f64]| -> Result<(Plan, Vec<f64>), String> {
            let design = Design::new(information.clone(), &rows(u)?, rule, cost)?;
            let alone = design.alone();
            let plan = design.exchange(&design.greedy(count)?)?;
            Ok((plan, alone))
        };
        let at: Vec<f64> = inference.parameters().iter().map(|p| p.u).collect();
        let (best, gains) = plan(&at)?;
        let mut lacking = std::collections::BTreeMap::new();
        let mut others = 0;
        for u in inference.draws(DRAWS.0, DRAWS.1)? {
            // Draws without a value of the gearbox are omitted.
            let Ok((other, _)) = plan(&u) else { continue };
            others += 1;
            let lacking_here: std::collections::BTreeSet<usize> = best.lacking_in(&other).into_iter().collect();
            for candidate in lacking_here {
                *lacking.entry(candidate).or_insert(0) += 1;
            }
        }
        Ok(NextPlan {
            plan: best,
            deviations: shown.deviations,
            gains,
            lacking: lacking.into_iter().collect(),
            others,
            parameters: free,
        })
    }

    /// Expected measurements of the rig at candidates, with the accuracy of the instruments, or of the nearest measured point.
    fn shown(
        &self,
        fitted: &Fitted,
        candidates: &[Candidate],
        gear: &str,
        quantity: Quantity,
    ) -> Result<Shown, String> {
        let mut measured = Measured {
            quantities: vec!["torque", "speed", "loss", "oil_temperature"],
            divisor: self.rows.measured.divisor,
            rig: self.rows.measured.rig,
            instruments: self.rows.measured.instruments,
            accuracies: self.rows.measured.accuracies.clone(),
            ..Measured::default()
        };
        let bound = self
            .rows
            .measured
            .rows
            .first()
            .map(|row| row.bound.clone())
            .unwrap_or_default();
        for (i, candidate) in candidates.iter().enumerate() {
            measured.rows.push(Row {
                line: i as u64 + 1,
                gear: Some(gear.to_owned()),
                values: vec![Some(candidate.torque), Some(candidate.speed), Some(0.0), candidate.oil],
                bound: bound.clone(),
                ..Row::default()
            });
        }
        let calculated = self.with_rows(&measured, Vec::new())?.calculate(fitted.theta())?;
        let (mut losses, mut oils, mut deviations) = (Vec::new(), Vec::new(), Vec::new());
        let scatter = fitted.inference.scatter();
        let factor = fitted
            .factors
            .iter()
            .find(|(q, _)| *q == quantity)
            .map_or(1.0, |(_, factor)| *factor);
        for (i, candidate) in candidates.iter().enumerate() {
            let point = calculated.point(i);
            let speed = candidate.speed * 30.0 / std::f64::consts::PI;
            let none = |what: &str| format!("no {what} at {} Nm and {speed:.0} rpm", candidate.torque);
            let loss = point.loss.ok_or_else(|| none("loss"))?;
            let what = quantity.words(crate::study::Difference::Points).0;
            quantity.value(point).ok_or_else(|| none(what))?;
            let seen = Seen::with_rig(&calculated.rig, &measured, &measured.rows[i], point);
            let stated = seen.accuracy(quantity).filter(|a| *a > 0.0);
            deviations.push(stated.map_or_else(
                || self.nearest(candidate, quantity) * scatter,
                |accuracy| accuracy * factor,
            ));
            losses.push(
                loss + calculated
                    .rig
                    .power([point.reference_speed, point.output_speed.unwrap_or(0.0)]),
            );
            oils.push(point.oil);
        }
        for (row, (loss, oil)) in measured.rows.iter_mut().zip(losses.into_iter().zip(oils)) {
            row.values[2] = Some(loss);
            row.values[3] = row.values[3].or(oil);
        }
        Ok(Shown { measured, deviations })
    }

    /// Deviation of the nearest measured point.
    fn nearest(&self, candidate: &Candidate, quantity: Quantity) -> f64 {
        let rows = self.rows.measured;
        let distance = |o: &&Observation| {
            let value = |name: &str| rows.value(&rows.rows[o.row], name).unwrap_or(0.0);
            let apart = |a: f64, b: f64| (a - b) / (a.abs() + b.abs()).max(1e-9);
            apart(value("torque"), candidate.torque).hypot(apart(value("speed"), candidate.speed))
        };
        let observed = self.observations.iter().filter(|o| o.quantity == quantity);
        observed
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map_or(1.0, |o| o.deviation)
    }
}

/// Candidates as measured by the rig.
struct Shown {
    measured: Measured,
    deviations: Vec<f64>,
}

/// Rows of the current information: those of the fit, and the range of each parameter without prior.
fn known(
    jacobian: &DMatrix<f64>,
    free: &[usize],
    ranges: &[f64],
    noise: f64,
    has_prior: impl Fn(usize) -> bool,
) -> Vec<Vec<f64>> {
    let measured = jacobian
        .row_iter()
        .map(|row| free.iter().map(|k| row[*k] / noise).collect());
    let unknown = free.iter().enumerate().filter(|(_, k)| !has_prior(**k));
    let mut rows: Vec<Vec<f64>> = unknown.map(|(place, _)| uniform_row(place, ranges)).collect();
    rows.extend(measured);
    rows
}
