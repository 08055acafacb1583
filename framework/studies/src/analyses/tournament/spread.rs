//! The spread of all combinations without measurements: model-form uncertainty.

use std::sync::Arc;

use super::super::common::axes::grid_axes;
use super::super::{Built, Engine, Planner, Run, Stopped};
use super::band::bands;
use super::entrants::Entrants;
use super::entry::TournamentEntry;
use super::field::Field;
use super::model_error::Errors;
use super::outcome::{ShareOfSpread, Spread, SpreadPoint};
use super::slot::Slot;
use crate::numbers::{RPM, tidy};

impl TournamentEntry {
    /// The points of the grid.
    pub(super) fn grid_points<'a>(
        &self,
        cx: &Planner<'a>,
        grid_name: &str,
        base: &Arc<Built<'a>>,
    ) -> Result<Run<'a>, Stopped> {
        let path = cx.path();
        let t = &base.transmission;
        let of_data = [
            self.factors.is_some(),
            self.gear.is_some(),
            self.errors.is_some(),
            self.correlation.is_some(),
        ];
        if of_data.contains(&true) {
            let message = "`factors`, `gear`, `errors` and `correlation` belong to `data`";
            return Err(cx.wrong(&path, message, "delete them, or give `data`"));
        }
        let grid = cx.study.grid(&path, grid_name)?;
        let gear = cx.one_gear(&path, grid, t)?;
        if !grid.bind.is_empty() || grid.envelope.is_some() {
            let message = "a tournament needs a grid without bound values and envelope";
            return Err(cx.wrong(&path, message, "give it its own grid"));
        }
        let (torques, speeds) = grid_axes(cx, grid_name, grid, t)?;
        Run::new(cx, base, cx.points(t, &gear, torques, speeds))
    }

    /// The spread over the grid.
    pub(super) fn spread(
        &self,
        engine: &Engine<'_>,
        run: &Run<'_>,
        entrants: &[Entrants],
        errors: Option<&Errors>,
    ) -> Result<Spread, Stopped> {
        let path = engine.path();
        let field = Field::new(engine, self, run, entrants, errors)?;
        let [torques, speeds] = run.points.field.axes().unwrap_or_default();
        if field.scale.iter().any(Option::is_none) {
            let message = "an efficiency, or a loss torque, needs speed and torque at every point";
            return Err(engine.wrong(&path, message, "omit zero, or write `quantity: loss`"));
        }
        let scales: Vec<f64> = field.scale.iter().map(|s| s.unwrap_or(0.0)).collect();
        let variances: Vec<f64> = field.slots.iter().map(|slot| variance(slot, &scales)).collect();
        let bands = match errors {
            Some(_) => bands(engine, &field)?.into_iter().map(Some).collect(),
            None => vec![None; scales.len()],
        };
        if errors.is_some() {
            let losses = |part: usize| field.points.iter().map(|p| p.parts[part]).sum();
            let losses: Vec<f64> = (0..run.built.transmission.parts().len()).map(losses).collect();
            engine.weigh_model_error(&run.built.name, &losses);
        }
        let whole: f64 = variances.iter().sum();
        let share = |(slot, variance): (&Slot, &f64)| ShareOfSpread {
            mechanism: slot.name.clone(),
            share: (whole > 0.0).then(|| variance / whole),
        };
        Ok(Spread {
            model_set: run.built.name.clone(),
            gear: run.points.gear.clone(),
            unit: self.unit(),
            combinations: field.count(),
            mechanisms: field.mechanisms(),
            shares_of_spread: field.slots.iter().zip(&variances).map(share).collect(),
            points: (0..scales.len())
                .map(|i| SpreadPoint {
                    band_w: bands[i],
                    ..point(&field, i, scales[i])
                })
                .collect(),
            unit_in_words: self.unit_in_words(),
            deviation_rms: f64::sqrt(whole / scales.len() as f64),
            torques: torques.to_vec(),
            speeds: speeds.to_vec(),
            unlisted: field.unlisted,
            left_out: field.left_out,
        })
    }
}

/// All combinations at one point. Losses of mechanisms are added, so extremes and moments over all combinations are the sums of theirs.
fn point(field: &Field<'_>, i: usize, scale: f64) -> SpreadPoint {
    let p = &field.points[i];
    let mut point = SpreadPoint {
        torque_nm: p.torque,
        speed_rpm: tidy(p.speed * RPM),
        least_loss_w: field.rest[i],
        mean_loss_w: field.rest[i],
        greatest_loss_w: field.rest[i],
        deviation_w: 0.0,
        band_w: None,
        scale,
    };
    for slot in &field.slots {
        let losses: Vec<f64> = slot.candidates.iter().map(|c| c.loss[i]).collect();
        point.least_loss_w += losses.iter().copied().fold(f64::INFINITY, f64::min);
        point.greatest_loss_w += losses.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mean = losses.iter().sum::<f64>() / losses.len() as f64;
        point.mean_loss_w += mean;
        point.deviation_w += losses.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / losses.len() as f64;
    }
    point.deviation_w = point.deviation_w.sqrt();
    point
}

/// Variance over the candidates of a mechanism in the unit of errors, summed over the points.
fn variance(slot: &Slot, scales: &[f64]) -> f64 {
    let at_point = |(i, scale): (usize, &f64)| {
        let losses: Vec<f64> = slot.candidates.iter().map(|c| c.loss[i]).collect();
        let mean = losses.iter().sum::<f64>() / losses.len() as f64;
        scale * scale * losses.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / losses.len() as f64
    };
    scales.iter().enumerate().map(at_point).sum()
}
