//! Results for one model set.

use gearloss_numerics::inference::{Fold, Validation, Widening};

use super::checks::Checks;
use super::correction;
use super::entry::IdentifyEntry;
use super::hold_out::{HoldOutOfSet, predict};
use super::lines::{Sheet, sheets};
use super::next::{self, Candidates, Next};
use super::posterior::{self, PosteriorOfSet};
use crate::analyses::Stopped;
use crate::codes;
use crate::correction::Correction;
use crate::distinct::distinct;
use crate::engine::JobsWithin;
use crate::identify::{
    Calculated, Fitted, HoldOut, Identification, Identified, Mean, Observation, Pair, Profiled, Settings, ShareBands,
};
use crate::measured::{Measured, Seen};
use crate::points::{Note, merge, merge_notes, notes};
use crate::study::{Difference, Quantity};

/// Results for one model set, for tables and figures.
#[derive(Debug, Clone)]
pub struct Found {
    /// The parameters, in the order of the coordinates.
    pub parameters: Vec<Identified>,
    /// The fitted rows.
    pub measured: Measured,
    /// The fitted observations, in the order of the residuals.
    pub observations: Vec<Observation>,
    /// Notes on the points.
    pub notes: Vec<String>,
    /// The fit.
    pub fitted: Fitted,
    /// Measured and calculated values at the start and at the end, in the order of the observations.
    pub pairs: [Vec<Pair>; 2],
    /// State of the gearbox at the rows, at the start and at the end.
    pub rows: [Vec<RowOfSet>; 2],
    /// The fitted means, in the order of the residuals after those of the observations.
    pub means: Vec<Mean>,
    /// Their calculated values at the start and at the end. \[W or -\]
    pub calculated_means: [Vec<f64>; 2],
    /// Profile intervals.
    pub profiles: Vec<Option<Profiled>>,
    /// Errors of predictions.
    pub folds: Option<Result<(Vec<Fold>, Validation), String>>,
    /// Diagnostics of the residuals.
    pub checks: Checks,
    /// Losses by mechanism at all rows.
    pub shares: Result<ShareBands, String>,
    /// Rows that belong together.
    pub sheets: Vec<Sheet>,
    /// Proposed measurements, or why there are none.
    pub next: Option<Result<Next, String>>,
}

/// Published as computed.
pub(super) struct Beside {
    /// Summary of the draws from the posterior, if requested.
    pub posterior: Option<Result<PosteriorOfSet, String>>,
    /// Predictions of held-out rows.
    pub held_out: Option<HoldOutOfSet>,
    /// Observed limits at the end.
    pub outside: Vec<Note>,
    /// Corrections of the loss torque, if requested.
    pub correction: Vec<Correction>,
}

/// State of the gearbox at one row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowOfSet {
    /// Gear state.
    pub gear: String,
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Oil temperature; absent if no balance was found. \[degC\]
    pub oil: Option<f64>,
    /// Losses by mechanism, in the order of the mechanisms of [`Found::shares`]; none without them. \[W\]
    pub losses: Vec<f64>,
    /// Measured loss without the contribution of the identified rig, and its standard deviation, zero if not stated. \[W\]
    pub measured_loss: Option<[f64; 2]>,
}

/// Data prepared before a fit for its evaluation.
pub(super) struct Prepared<'h> {
    pub candidates: Option<Candidates>,
    pub groups: Option<Result<Vec<Fold>, String>>,
    pub held_out: Option<&'h HoldOut>,
}

impl Found {
    /// All results of a fit. `gear` is the gear of rows without one.
    pub(super) fn new(
        jobs: &JobsWithin<'_>,
        entry: &IdentifyEntry,
        settings: &Settings<'_>,
        gear: &str,
        (identification, fitted): (Identification<'_>, Fitted),
        prepared: Prepared<'_>,
    ) -> Result<(Self, Beside), Stopped> {
        let cx = jobs.engine;
        let path = cx.path();
        let failed = |reason: String| {
            cx.wrong_as(
                codes::NO_CONVERGENCE,
                &path,
                reason,
                "use other start values, or narrow the bounds",
            )
        };
        let at = |theta: &[f64]| -> Result<(Calculated, Vec<Pair>), String> {
            let calculated = identification.calculate(theta)?;
            let pairs = identification.pairs(&calculated)?;
            Ok((calculated, pairs))
        };
        let (before, pairs_before) = at(&identification.start()).map_err(failed)?;
        let (after, pairs_after) = at(fitted.theta()).map_err(failed)?;
        let means_before = identification
            .calculate_means(&identification.start())
            .map_err(failed)?;
        let means_after = identification.calculate_means(fitted.theta()).map_err(failed)?;
        let sheets = sheets(identification.measured(), gear);
        let profiles = if entry.profiles {
            identification.profiles(&fitted, settings.interrupt)
        } else {
            vec![None; identification.parameters().len()]
        };
        let posterior = entry
            .posterior
            .map(|entry| posterior::draw(entry, (&identification, &fitted, &profiles), settings.interrupt));
        let folds = prepared.groups.map(|groups| {
            let groups = groups?;
            let validation = identification.validate(&fitted, &groups, settings)?;
            Ok((groups, validation))
        });
        jobs.result(())?;
        let all: Vec<usize> = (0..identification.measured().rows.len()).collect();
        let shares = identification.share_bands(&fitted, &all, &profiles);
        let next = entry.next.as_ref().zip(prepared.candidates);
        let next = next.map(|(entry, candidates)| next::plan(entry, candidates, &identification, &fitted));
        let checks = Checks::new(&identification, &fitted, &sheets);
        let widening = checks.widening();
        let held_out = prepared.held_out.map(|choice| {
            let end = (&after, &pairs_after[..]);
            predict(
                choice,
                &entry.residuals,
                (&identification, &fitted),
                end,
                (widening, &profiles),
            )
        });
        let held_out = held_out.transpose().map_err(|reason| {
            let help = "hold out rows with measured values of the fitted quantity, at which the gearbox has a value";
            cx.wrong_as(codes::HOLD_OUT, &format!("{path}.hold_out"), reason, help)
        })?;
        let transmission = &after.solved.transmissions[0];
        let mut seen = after.solved.seen.clone();
        merge(&mut seen, &means_after.seen);
        let held_out = held_out.map(|(held_out, there)| {
            merge(&mut seen, &there);
            held_out
        });
        let mut outside = notes(transmission, &seen);
        merge_notes(&mut outside, &means_after.notes);
        let correction = match &entry.correction {
            Some(wanted) => correction::fit(cx, wanted, identification.measured(), &after)?,
            None => Vec::new(),
        };
        let beside = Beside {
            posterior,
            held_out,
            outside,
            correction,
        };
        let mechanisms = shares.as_ref().map_or(&[][..], |shares| &shares.mechanisms);
        let found = Self {
            checks,
            rows: [&before, &after].map(|there| rows(there, identification.measured(), mechanisms)),
            pairs: [pairs_before, pairs_after],
            means: identification.means().list.clone(),
            calculated_means: [means_before.values, means_after.values],
            parameters: identification.parameters().to_vec(),
            measured: identification.measured().clone(),
            observations: identification.observations().to_vec(),
            notes: identification.notes().to_vec(),
            next,
            fitted,
            profiles,
            folds,
            shares,
            sheets,
        };
        Ok((found, beside))
    }

    /// Root mean square of calculated minus measured for a quantity, before and after, in percentage points, W, Nm or K.
    pub fn rms(&self, quantity: Quantity) -> [f64; 2] {
        [0, 1].map(|k| {
            let list: Vec<f64> = self.deviations(quantity, k).into_iter().map(|(_, d)| d).collect();
            (list.iter().map(|d| d * d).sum::<f64>() / list.len().max(1) as f64).sqrt()
        })
    }

    /// Root mean square of the residuals of a quantity, before and after.
    pub fn weighted_rms(&self, quantity: Quantity) -> [f64; 2] {
        [0, 1].map(|k| {
            let all = self.observations.iter().zip(&self.pairs[k]);
            let of_quantity = all.filter(|(o, _)| o.quantity == quantity);
            let list: Vec<f64> = of_quantity.map(|(o, p)| (p.model - p.measured) / o.deviation).collect();
            (list.iter().map(|r| r * r).sum::<f64>() / list.len().max(1) as f64).sqrt()
        })
    }

    /// Rows and calculated minus measured for a quantity, before (0) or after (1), in percentage points, W, Nm or K.
    pub fn deviations(&self, quantity: Quantity, which: usize) -> Vec<(usize, f64)> {
        let all = self.observations.iter().zip(&self.pairs[which]);
        all.filter(|(o, _)| o.quantity == quantity)
            .filter_map(|(o, p)| Some((o.row, quantity.difference(Difference::Points, p.measured, p.model)?)))
            .collect()
    }

    /// The fitted quantities without repetition.
    pub fn quantities(&self) -> Vec<Quantity> {
        distinct(self.observations.iter().map(|observation| observation.quantity))
    }

    /// Factors by which intervals and bands are too small if the model does not reproduce the points or neighbouring errors are correlated.
    pub fn intervals_widened(&self) -> Widening {
        self.checks.widening()
    }

    /// Factor by which intervals of parameters are too small, the larger of the two; absent if they are not.
    pub fn widening(&self) -> Option<f64> {
        Some(self.intervals_widened().parameters).filter(|widening| *widening > 1.0)
    }
}

/// State of the gearbox at all rows.
fn rows(there: &Calculated, measured: &Measured, mechanisms: &[&'static str]) -> Vec<RowOfSet> {
    let solved = there.solved.rows.iter().zip(&measured.rows);
    let row = |((number, gear, point), row): (&(usize, String, _), _)| {
        let point: &crate::points::PointResult = point;
        let parts = there.solved.transmissions[*number].parts();
        let of_mechanism = |mechanism: &&str| {
            let watts_of_parts = parts
                .iter()
                .zip(&point.parts)
                .filter(|(part, _)| part.mechanism == *mechanism);
            watts_of_parts.map(|(_, watts)| watts).sum()
        };
        let seen = Seen::with_rig(&there.rig, measured, row, point);
        let accuracy = seen.accuracy(Quantity::Loss).unwrap_or(0.0);
        RowOfSet {
            gear: gear.clone(),
            torque: point.torque,
            speed: point.speed,
            oil: point.oil,
            losses: mechanisms.iter().map(of_mechanism).collect(),
            measured_loss: seen.loss.map(|loss| [loss, accuracy]),
        }
    };
    solved.map(row).collect()
}
