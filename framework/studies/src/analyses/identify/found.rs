//! All that is found for one set of models.

use gearloss_numerics::inference::{Fold, Validation, Widening};

use super::checks::Checks;
use super::entry::IdentifyEntry;
use super::hold_out::{HoldOutOfSet, predict};
use super::lines::{Sheet, sheets};
use super::next::{self, Candidates, Next};
use super::posterior::{self, PosteriorOfSet};
use crate::analyses::{Context, Stopped};
use crate::analysis::{Note, merge, notes};
use crate::codes;
use crate::identify::{
    Calculated, Fitted, HoldOut, Identification, Identified, Observation, Pair, Profiled, Settings, ShareBands,
};
use crate::measured::{Measured, Seen};
use crate::study::{Difference, Quantity};

/// All that is found for one set of models, as tables and pictures need it.
#[derive(Debug, Clone)]
pub struct Found {
    /// The parameters, in the order of the coordinates.
    pub parameters: Vec<Identified>,
    /// The rows that were fitted.
    pub measured: Measured,
    /// What was fitted, in the order of the residuals.
    pub observations: Vec<Observation>,
    /// What a user should know of the points.
    pub notes: Vec<String>,
    /// The fit.
    pub fitted: Fitted,
    /// Measured and calculated numbers at the start and at the end, in the order of the observations.
    pub pairs: [Vec<Pair>; 2],
    /// What the gearbox does at the rows, at the start and at the end.
    pub rows: [Vec<RowOfSet>; 2],
    /// Intervals by profile.
    pub profiles: Vec<Option<Profiled>>,
    /// Errors of predictions.
    pub folds: Option<Result<(Vec<Fold>, Validation), String>>,
    /// What the residuals say against the fit.
    pub checks: Checks,
    /// Losses by mechanism at all rows.
    pub shares: Result<ShareBands, String>,
    /// Rows that belong together.
    pub sheets: Vec<Sheet>,
    /// What to measure next, or why nothing can be said of it.
    pub next: Option<Result<Next, String>>,
}

/// What is published as it was found.
pub(super) struct Beside {
    /// What the draws from the posterior say, where they were requested.
    pub posterior: Option<Result<PosteriorOfSet, String>>,
    /// Predictions of rows that were held out.
    pub held_out: Option<HoldOutOfSet>,
    /// What was seen of limits at the end.
    pub outside: Vec<Note>,
}

/// What the gearbox does at one row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowOfSet {
    /// Gear state.
    pub gear: String,
    /// Torque. \[Nm\]
    pub torque: f64,
    /// Speed. \[rad/s\]
    pub speed: f64,
    /// Temperature of the oil; absent where no balance was found. \[degC\]
    pub oil: Option<f64>,
    /// Losses by mechanism, in the order of the mechanisms of [`Found::shares`]; none without them. \[W\]
    pub losses: Vec<f64>,
    /// Measured loss, without what the identified rig adds, and its standard deviation, zero where none is stated. \[W\]
    pub measured_loss: Option<[f64; 2]>,
}

/// What is made before a fit for what follows from it.
pub(super) struct Prepared<'h> {
    pub candidates: Option<Candidates>,
    pub groups: Option<Result<Vec<Fold>, String>>,
    pub held_out: Option<&'h HoldOut>,
}

impl Found {
    /// Everything that follows from a fit. `gear` is the state of rows that tell none.
    pub(super) fn new(
        cx: &Context<'_>,
        entry: &IdentifyEntry,
        settings: &Settings<'_>,
        gear: &str,
        (identification, fitted): (Identification<'_>, Fitted),
        prepared: Prepared<'_>,
    ) -> Result<(Self, Beside), Stopped> {
        let path = cx.path();
        let failed = |reason: String| {
            cx.wrong_as(
                codes::NO_CONVERGENCE,
                &path,
                reason,
                "begin with other values, or narrow the bounds",
            )
        };
        let at = |theta: &[f64]| -> Result<(Calculated, Vec<Pair>), String> {
            let calculated = identification.calculate(theta)?;
            let pairs = identification.pairs(&calculated)?;
            Ok((calculated, pairs))
        };
        let (before, pairs_before) = at(&identification.start()).map_err(failed)?;
        let (after, pairs_after) = at(fitted.theta()).map_err(failed)?;
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
        if !cx.goes_on() {
            return Err(Stopped::Interrupted);
        }
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
            let help = "hold out rows in which what is fitted was measured and the gearbox has a value";
            cx.wrong_as(codes::HOLD_OUT, &format!("{path}.hold_out"), reason, help)
        })?;
        let transmission = &after.solved.transmissions[0].1;
        let mut seen = after.solved.seen.clone();
        let held_out = held_out.map(|(held_out, there)| {
            merge(&mut seen, &there);
            held_out
        });
        let beside = Beside {
            posterior,
            held_out,
            outside: notes(transmission, &seen),
        };
        let mechanisms = shares.as_ref().map_or(&[][..], |shares| &shares.mechanisms);
        let found = Self {
            checks,
            rows: [&before, &after].map(|there| rows(there, identification.measured(), mechanisms)),
            pairs: [pairs_before, pairs_after],
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

    /// Root of the mean square of calculated less measured for a quantity, before and after, in efficiency points, W, Nm or K.
    pub fn rms(&self, quantity: Quantity) -> [f64; 2] {
        [0, 1].map(|k| {
            let list: Vec<f64> = self.deviations(quantity, k).into_iter().map(|(_, d)| d).collect();
            (list.iter().map(|d| d * d).sum::<f64>() / list.len().max(1) as f64).sqrt()
        })
    }

    /// Root of the mean square of the residuals of a quantity, before and after.
    pub fn weighted_rms(&self, quantity: Quantity) -> [f64; 2] {
        [0, 1].map(|k| {
            let all = self.observations.iter().zip(&self.pairs[k]);
            let own = all.filter(|(o, _)| o.quantity == quantity);
            let list: Vec<f64> = own.map(|(o, p)| (p.model - p.measured) / o.deviation).collect();
            (list.iter().map(|r| r * r).sum::<f64>() / list.len().max(1) as f64).sqrt()
        })
    }

    /// Rows and calculated less measured for a quantity, before (0) or after (1), in efficiency points, W, Nm or K.
    pub fn deviations(&self, quantity: Quantity, which: usize) -> Vec<(usize, f64)> {
        let all = self.observations.iter().zip(&self.pairs[which]);
        all.filter(|(o, _)| o.quantity == quantity)
            .filter_map(|(o, p)| Some((o.row, quantity.difference(Difference::Points, p.measured, p.model)?)))
            .collect()
    }

    /// The fitted quantities, each once.
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut list = Vec::new();
        for observation in &self.observations {
            if !list.contains(&observation.quantity) {
                list.push(observation.quantity);
            }
        }
        list
    }

    /// Factors by which intervals and bands are too small, where the model does not reproduce the points or neighbours err
    /// together.
    pub fn intervals_widened(&self) -> Widening {
        self.checks.widening()
    }

    /// Factor by which intervals of parameters are too small, the greater of the two; absent where they are not.
    pub fn widening(&self) -> Option<f64> {
        Some(self.intervals_widened().parameters).filter(|widening| *widening > 1.0)
    }
}

/// What the gearbox does at all rows.
fn rows(there: &Calculated, measured: &Measured, mechanisms: &[&'static str]) -> Vec<RowOfSet> {
    let solved = there.solved.rows.iter().zip(&measured.rows);
    let row = |((number, gear, point), row): (&(usize, String, _), _)| {
        let point: &crate::analysis::PointResult = point;
        let parts = there.solved.transmissions[*number].1.parts();
        let of_mechanism = |mechanism: &&str| {
            let own = parts
                .iter()
                .zip(&point.parts)
                .filter(|(part, _)| part.mechanism == *mechanism);
            own.map(|(_, watts)| watts).sum()
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
