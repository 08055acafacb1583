//! All that is found for one set of models.

use gearloss_framework::loss::Extent;
use gearloss_numerics::inference::{Fold, Validation, Widening};
use gearloss_studies::analysis::{Note, merge, notes};
use gearloss_studies::identify::{Calculated, Fitted, Identification, Pair, Posterior, Profiled, Settings, ShareBands};
use gearloss_studies::study::{Difference, IdentifyEntry, Quantity};

use super::super::{Built, Runner};
use super::checks::Checks;
use super::hold_out::HeldOut;
use super::lines::{Sheet, sheets};
use super::next::{self, Candidates, Next};
use super::posterior;
use crate::interrupt;
use crate::output::Failure;

/// All that is found for one set of models.
pub struct Outcome<'a> {
    /// Name of the set.
    pub name: String,
    pub identification: Identification<'a>,
    pub fitted: Fitted,
    /// Measured and calculated numbers at the start and at the end, in the order of the observations.
    pub pairs: [Vec<Pair>; 2],
    /// What the gearbox does at the start and at the end.
    pub calculated: [Calculated; 2],
    /// Intervals by profile.
    pub profiles: Vec<Option<Profiled>>,
    /// Draws from the posterior, where they were asked for.
    pub posterior: Option<Result<Posterior, String>>,
    /// Errors of predictions.
    pub folds: Option<Result<(Vec<Fold>, Validation), String>>,
    pub checks: Checks,
    /// Predictions of rows that were held out.
    pub held_out: Option<HeldOut<'a>>,
    /// Losses by mechanism at all rows.
    pub shares: Result<ShareBands, String>,
    /// Rows that belong together.
    pub sheets: Vec<Sheet>,
    pub next: Option<Result<Next, String>>,
    /// What was seen of limits at the end.
    pub notes: Vec<Note>,
}

impl<'a> Outcome<'a> {
    pub fn new(
        runner: &Runner<'_>,
        (name, entry): (&str, &IdentifyEntry),
        settings: &Settings<'_>,
        gear: &str,
        (built, identification, fitted): (&Built<'_>, Identification<'a>, Fitted),
        (candidates, groups): (Option<Candidates>, Option<Result<Vec<Fold>, String>>),
    ) -> Result<Self, Failure> {
        let path = format!("analyses.{name}");
        let failed = |reason: String| runner.wrong(&path, reason, "begin with other values, or narrow the bounds");
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
        let posterior = entry.posterior.map(|entry| {
            identification.posterior(
                &fitted,
                &posterior::ensemble(entry, &identification),
                settings.interrupt,
            )
        });
        let folds = groups.map(|groups| {
            let groups = groups?;
            let validation = identification.validate(&fitted, &groups, settings)?;
            Ok((groups, validation))
        });
        if interrupt::pressed() {
            return Err(Failure::Interrupted);
        }
        let all: Vec<usize> = (0..identification.measured().rows.len()).collect();
        let shares = identification.share_bands(&fitted, &all, &profiles);
        let next = entry.next.as_ref().zip(candidates);
        let next = next.map(|(entry, candidates)| next::plan(entry, candidates, &identification, &fitted));
        let transmission = &after.solved.transmissions[0].1;
        runner.seen(transmission, &after.solved.seen);
        Ok(Self {
            name: built.name.clone(),
            checks: Checks::of(&identification, &fitted, &sheets),
            notes: notes(transmission, &after.solved.seen),
            pairs: [pairs_before, pairs_after],
            calculated: [before, after],
            next,
            identification,
            fitted,
            profiles,
            posterior,
            folds,
            shares,
            sheets,
            held_out: None,
        })
    }

    /// Adds what was held out, and the limits that were left there.
    pub fn add_held_out(&mut self, runner: &Runner<'_>, held_out: HeldOut<'a>) {
        let solved = &self.calculated[1].solved;
        let (transmission, there) = (&solved.transmissions[0].1, &held_out.predictions.calculated.solved.seen);
        // What fitted rows have left is counted.
        let newly_left = |(before, own): (&Extent, &Extent)| if before.outside > 0 { Extent::EMPTY } else { *own };
        runner.seen(
            transmission,
            &solved.seen.iter().zip(there).map(newly_left).collect::<Vec<_>>(),
        );
        let mut seen = solved.seen.clone();
        merge(&mut seen, there);
        self.notes = notes(transmission, &seen);
        self.held_out = Some(held_out);
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
            let all = self.identification.observations().iter().zip(&self.pairs[k]);
            let own = all.filter(|(o, _)| o.quantity == quantity);
            let list: Vec<f64> = own.map(|(o, p)| (p.model - p.measured) / o.deviation).collect();
            (list.iter().map(|r| r * r).sum::<f64>() / list.len().max(1) as f64).sqrt()
        })
    }

    /// Rows and calculated less measured for a quantity, before (0) or after (1), in efficiency points, W, Nm or K.
    pub fn deviations(&self, quantity: Quantity, which: usize) -> Vec<(usize, f64)> {
        let all = self.identification.observations().iter().zip(&self.pairs[which]);
        all.filter(|(o, _)| o.quantity == quantity)
            .filter_map(|(o, p)| Some((o.row, quantity.difference(Difference::Points, p.measured, p.model)?)))
            .collect()
    }

    /// The fitted quantities, each once.
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut list = Vec::new();
        for observation in self.identification.observations() {
            if !list.contains(&observation.quantity) {
                list.push(observation.quantity);
            }
        }
        list
    }

    /// Factors by which intervals and bands are too small, where the model does not reproduce the points or neighbours err
    /// together.
    pub fn intervals_widened(&self) -> Widening {
        Widening::from_checks(self.checks.lack.as_ref(), self.checks.succession.as_ref())
    }

    /// Factor by which intervals of parameters are too small, the greater of the two; absent where they are not.
    pub fn widening(&self) -> Option<f64> {
        Some(self.intervals_widened().parameters).filter(|widening| *widening > 1.0)
    }
}
