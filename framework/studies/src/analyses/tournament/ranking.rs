//! Combinations ranked by prediction errors of measured losses relative to their accuracy; the winner, and those that are not
//! distinguishable from it.

use gearloss_numerics::selection::{Combination, MeasuredLosses, Shortlist, Winner, rank, shortlist, winner};

use super::super::{Engine, Run, Stopped};
use super::candidates::left;
use super::entrants::Entrants;
use super::entry::TournamentEntry;
use super::field::{Field, given};
use super::measurements::{Measurements, OwnRows};
use super::outcome::{Comparison, RankedCombination, RankedPoint, Ranking};
use crate::measured::Measured;
use crate::numbers::{RPM, tidy};
use crate::points::{Statistics, run_grid};

/// A ranking with its conclusions.
struct Ranked {
    combinations: Vec<Combination>,
    winner: Winner,
    shortlist: Shortlist,
}

impl Ranked {
    /// Weight of a combination by its index; absent if it is not on the shortlist.
    fn weight(&self, place: usize) -> Option<f64> {
        let member = self
            .shortlist
            .members
            .iter()
            .position(|member_place| *member_place == place)?;
        self.shortlist.weights.get(member).copied()
    }
}

impl TournamentEntry {
    /// Ranks every combination by measured points.
    pub(super) fn ranking(
        &self,
        engine: &Engine<'_>,
        (measured, file): (&Measured, &str),
        run: &Run<'_>,
        entrants: &[Entrants],
    ) -> Result<Ranking, Stopped> {
        let (base, gear) = (&run.built, &run.points.gear);
        let of_gear = OwnRows::new(engine, measured, gear)?;
        let (mut list, mut unlisted) = (of_gear.given, 0);
        if !measured.rig.is_silent() {
            // The contribution of the rig depends on the speeds; it is subtracted from the torque.
            let solved = engine.solve(&run.with_list(list.clone()))?;
            unlisted += left(&base.transmission, &solved);
            for (given, p) in list.iter_mut().zip(solved.points) {
                let added = measured.rig.added([p.reference_speed, p.output_speed.unwrap_or(0.0)]);
                given.torque -= added[usize::from(!p.at_reference)];
            }
        }
        let run = run.with_list(list);
        let field = Field::new(engine, self, &run, entrants, None)?;
        let rows = Measurements::new(engine, self, (measured, &of_gear.rows), &field)?;
        let found = self.ranked(engine, &field, &rows.losses)?;
        let gap = gap_of_sum(engine, &field, &found.combinations[found.winner.place])?;
        let accuracies = (0..rows.losses.len()).filter_map(|i| Some((rows.accuracy(i)?, rows.losses.weights[i])));
        Ok(Ranking {
            model_set: base.name.clone(),
            gear: gear.clone(),
            unit: self.unit(),
            combinations: found.combinations.len(),
            accuracy: Statistics::weighted(accuracies).map(|s| s.rms),
            correlation: found.winner.errors.correlation,
            correlation_estimated: found.winner.is_estimated,
            variance_over_stated: found.winner.errors.variance,
            winner: found.winner.place,
            best_unmarked: found.winner.unmarked,
            best_against_unmarked: found.winner.best_against_unmarked.as_ref().map(Comparison::new),
            mechanisms: field.mechanisms(),
            points: points(&rows, &found.shortlist),
            ranking: combinations(&field, &found),
            unit_in_words: self.unit_in_words(),
            notes_on_file: measured.notes.iter().map(|note| format!("{file}: {note}")).collect(),
            notes: rows.notes,
            points_of_other_gears: of_gear.others,
            unranked: field.count() - found.combinations.len(),
            groups: rows.losses.folds.len(),
            fits_factors: self.factors.is_some(),
            shown: self.shown as usize,
            gap_of_sum: gap,
            unlisted: unlisted + field.unlisted,
            rest_w: field.rest,
            left_out: field.left_out,
        })
    }

    fn ranked(&self, engine: &Engine<'_>, field: &Field<'_>, measured: &MeasuredLosses) -> Result<Ranked, Stopped> {
        let data = format!("{}.data", engine.path());
        let outside = measured.folds.iter().map(|fold| measured.len() - fold.len());
        let fewest = outside.min().unwrap_or(0);
        if self.factors.is_some() && fewest < field.slots.len() {
            let message = format!(
                "{fewest} points outside a group cannot fit {} factors",
                field.slots.len()
            );
            return Err(engine.wrong(&data, message, "give more points, or fewer mechanisms"));
        }
        let losses = field.losses();
        let bounds = self.factors.map(|f| [f.least, f.greatest]);
        let running = engine.running(field.count(), engine.name);
        let ranked = rank(&losses, measured, bounds, &|| running.advance(1));
        drop(running);
        if !engine.should_continue() {
            return Err(Stopped::Interrupted);
        }
        let is_marked = |c: &Combination| !field.marks(c).is_empty();
        let Some(winner) = winner(&ranked, &is_marked, &losses, measured, self.correlation) else {
            let message = "no combination can be ranked with these points";
            let help = "give points with a positive weight, or wider bounds of the factors";
            return Err(engine.wrong(&data, message, help));
        };
        let shortlist = shortlist(&ranked, &winner, &losses, measured);
        Ok(Ranked {
            combinations: ranked,
            winner,
            shortlist,
        })
    }
}

/// The measured points with the predictions of the shortlist.
fn points(rows: &Measurements, list: &Shortlist) -> Vec<RankedPoint> {
    let point = |i: usize| RankedPoint {
        torque_nm: rows.torques[i],
        speed_rpm: tidy(rows.speeds[i] * RPM),
        measured_loss_w: rows.losses.losses[i],
        loss_accuracy_w: rows.losses.deviations[i],
        accuracy: rows.accuracy(i),
        weight: rows.losses.weights[i],
        mean_loss_w: list.means[i],
        deviation_w: list.deviations[i],
        least_loss_w: list.ranges[i][0],
        greatest_loss_w: list.ranges[i][1],
        speed: rows.speeds[i],
        scale: rows.losses.units[i],
    };
    (0..rows.losses.len()).map(point).collect()
}

/// All combinations, sorted by predicted error.
fn combinations(field: &Field<'_>, found: &Ranked) -> Vec<RankedCombination> {
    let combination = |(i, c): (usize, &Combination)| {
        let against = Comparison::new(&found.winner.standings[i]);
        let bounds = c.on_bound.iter().map(|k| field.slots[*k].name.clone());
        RankedCombination {
            models: field.names(&c.places),
            predicted_over_accuracy: c.predicted,
            predicted_rms: c.printed.map(|p| p.predicted),
            worst_group_rms: c.printed.map(|p| p.worst),
            fitted_rms: c.printed.map(|p| p.fitted),
            mean: c.printed.map(|p| p.mean),
            factors: c.factors.clone(),
            on_bound: bounds.collect(),
            marks: field.marks(c),
            winner_against_it: (i != found.winner.place).then_some(against),
            weight: found.weight(i),
            places: c.places.clone(),
            against,
        }
    };
    found.combinations.iter().enumerate().map(combination).collect()
}

/// Maximum difference between added losses and the combination solved together. \[% of the loss\]
fn gap_of_sum(engine: &Engine<'_>, field: &Field<'_>, c: &Combination) -> Result<f64, Stopped> {
    let base = field.base;
    let mut resolved = base.resolved.clone();
    for (slot, place) in field.slots.iter().zip(&c.places) {
        resolved = slot
            .with(engine.language, &resolved, &slot.candidates[*place].model)
            .map_err(|reason| engine.wrong(&engine.path(), reason, "report this"))?;
    }
    let transmission = base.gearbox.build(engine.language, &resolved)?;
    let points = engine.listed(&transmission, &field.gear, given(&field.points));
    let solved = run_grid(&transmission, &points, &|_| engine.should_continue());
    let solved = solved.map_err(|list| Stopped::from(base.gearbox.findings(list)))?;
    let solved = solved.ok_or(Stopped::Interrupted)?;
    let added = field.losses().of_combination(&c.places, &vec![1.0; c.places.len()]);
    let gaps = solved.points.iter().zip(&added);
    let gaps = gaps.filter_map(|(p, added)| Some(100.0 * (added - p.loss?) / p.loss?));
    Ok(gaps.fold(0.0_f64, |worst, gap| if gap.abs() > worst.abs() { gap } else { worst }))
}
