//! Points, the loss of all other components, and the loss of each candidate.

use gearloss_framework::description::ThermalMode;
use gearloss_numerics::selection::{Combination, Losses};

use super::super::{Built, Engine, Run, Stopped};
use super::candidates::{Gathering, left};
use super::entrants::Entrants;
use super::entry::{MOST, TournamentEntry};
use super::law_loss::LossOfLaw;
use super::model_error::Errors;
use super::outcome::{CandidateOfTournament, MechanismOfTournament};
use super::slot::{Candidate, Slot};
use crate::numbers::RPM;
use crate::points::{Field as Given, Given as GivenPoint, PointResult, Points};
use crate::study::Quantity;

/// Points, the loss of all other components, and the loss of each candidate.
pub struct Field<'a> {
    pub base: &'a Built<'a>,
    pub gear: String,
    pub points: Vec<PointResult>,
    /// Loss of all components outside the mechanisms of the tournament. \[W\]
    pub rest: Vec<f64>,
    pub slots: Vec<Slot>,
    /// Factor from an error in W to the printed unit at each point; absent if the quantity does not exist, such as an efficiency without
    /// torque.
    pub scale: Vec<Option<f64>>,
    /// Why models are omitted.
    pub left_out: Vec<String>,
    /// Number of quantities outside their stated ranges.
    pub unlisted: usize,
    /// Losses of all other components by laws with a known error, if it is asked for.
    pub rest_laws: Vec<LossOfLaw>,
}

impl<'a> Field<'a> {
    /// Solves the points with the set, and evaluates every candidate at the temperatures found.
    pub fn new(
        engine: &'a Engine<'a>,
        entry: &TournamentEntry,
        run: &'a Run<'a>,
        entrants: &[Entrants],
        errors: Option<&Errors>,
    ) -> Result<Self, Stopped> {
        let base: &'a Built<'a> = &run.built;
        let mut run = run.clone();
        // A measured temperature is used unless the model computes one.
        if base.transmission.thermal_mode != ThermalMode::Fixed
            && let Given::List(list) = &mut run.points.field
        {
            for given in list {
                given.oil = None;
            }
        }
        let solved = engine.solve(&run)?;
        // All models are evaluated at the temperatures of the set, because losses are added.
        let points = Points {
            field: Given::List(given(&solved.points)),
            ..run.points
        };
        let gathering = Gathering::new(engine, entrants, base, &points, &solved, errors)?;
        let (slots, left_out) = (gathering.slots, gathering.left_out);
        let unlisted = gathering.unlisted + left(&base.transmission, &solved);
        if let Some(p) = solved.points.iter().find(|p| p.loss.is_none()) {
            let message = format!(
                "the set itself has no loss at {} Nm, {:.0} rpm",
                p.torque,
                p.speed * RPM
            );
            return Err(engine.wrong(&engine.path(), message, "choose a set with a loss at every point"));
        }
        let parts = base.transmission.parts();
        let rest = |p: &PointResult| {
            let parts_with_losses = parts.iter().zip(&p.parts);
            parts_with_losses
                .filter(|(part, _)| !slots.iter().any(|s| s.covers(part)))
                .map(|(_, w)| w)
                .sum()
        };
        let rest: Vec<f64> = solved.points.iter().map(rest).collect();
        let rest_laws = errors.map_or_else(Vec::new, |errors| {
            let is_rest = |part: usize| !slots.iter().any(|slot| slot.covers(&parts[part]));
            errors.of_base(&base.transmission, &solved.points, is_rest)
        });
        let scale = |p: &PointResult| match entry.quantity {
            Quantity::Efficiency => 100.0 / (p.torque * p.torque_speed).abs(),
            Quantity::LossTorque => 1.0 / p.reference_speed.abs(),
            // Others are refused.
            _ => 1.0,
        };
        let scale = |p: &PointResult| Some(scale(p)).filter(|s| s.is_finite());
        let field = Self {
            scale: solved.points.iter().map(scale).collect(),
            gear: points.gear,
            points: solved.points,
            rest,
            rest_laws,
            slots,
            base,
            left_out,
            unlisted,
        };
        if field.count() > MOST {
            let message = format!("{} combinations are more than {MOST}", field.count());
            let help = "list the candidates: `mechanisms: [{ mechanism: bearing, models: { skf: { type: skf } } }]`; without a list every \
                        model is combined with every nested model that it accepts";
            return Err(engine.wrong(&engine.path(), message, help));
        }
        Ok(field)
    }

    /// Number of combinations.
    pub fn count(&self) -> usize {
        self.slots.iter().map(|s| s.candidates.len()).product()
    }

    /// Losses of all candidates.
    pub fn losses(&self) -> Losses<'_> {
        let mechanisms = self
            .slots
            .iter()
            .map(|slot| slot.candidates.iter().map(|c| c.loss.as_slice()).collect());
        Losses {
            rest: &self.rest,
            mechanisms: mechanisms.collect(),
        }
    }

    /// Names of the candidates of a combination.
    pub fn names(&self, places: &[usize]) -> Vec<String> {
        let chosen = self.slots.iter().zip(places);
        chosen
            .map(|(slot, place)| slot.candidates[*place].name.clone())
            .collect()
    }

    /// Marks of a combination as text: quantities outside stated ranges, and factors at a bound.
    pub fn marks(&self, c: &Combination) -> Vec<String> {
        let ranges = self.slots.iter().zip(&c.places).flat_map(|(slot, place)| {
            let candidate = &slot.candidates[*place];
            let marks = candidate.marks.iter();
            marks.map(|mark| format!("{} {}: {}", slot.name, candidate.name, mark.words))
        });
        let bounds = c
            .on_bound
            .iter()
            .map(|k| format!("{}: factor {:.2} at a bound", self.slots[*k].name, c.factors[*k]));
        ranges.chain(bounds).collect()
    }

    /// The mechanisms with their candidates, for results.
    pub fn mechanisms(&self) -> Vec<MechanismOfTournament> {
        let candidate = |c: &Candidate| CandidateOfTournament {
            name: c.name.clone(),
            model: c.model.clone(),
            losses_w: c.loss.clone(),
            outside: c.marks.iter().map(|mark| mark.words.clone()).collect(),
            quantities_outside: c.marks.iter().map(|mark| mark.name).collect(),
            time: c.time,
        };
        let mechanism = |slot: &Slot| MechanismOfTournament {
            mechanism: slot.name.clone(),
            candidates: slot.candidates.iter().map(candidate).collect(),
        };
        self.slots.iter().map(mechanism).collect()
    }
}

/// The torques, speeds and temperatures of solved points.
pub fn given(points: &[PointResult]) -> Vec<GivenPoint> {
    let given = |p: &PointResult| GivenPoint {
        torque: p.torque,
        speed: p.speed,
        oil: p.oil,
    };
    points.iter().map(given).collect()
}
