//! Every combination of the models of some mechanisms: ranked by a measurement, or their spread.

mod band;
mod candidates;
pub(super) mod entrants;
mod entry;
mod field;
mod law_loss;
mod marks;
mod measurements;
mod model_error;
mod outcome;
mod ranking;
pub(super) mod slot;
mod spread;
mod tables;

pub use outcome::{
    CandidateOfTournament, Comparison, ComparisonOfGroups, MechanismOfTournament, RankedCombination, RankedPoint,
    Ranking, ShareOfSpread, Spread, SpreadPoint, Tournament, TournamentOutcome,
};

pub use entry::{CandidatesEntry, FactorsEntry, LossErrorsEntry, TournamentEntry};

use self::entrants::Entrants;
use self::measurements::OwnRows;
use self::model_error::Errors;
use super::{Analysis, Engine, Plan, Planner, Run, Stopped, Work, gear_of};
use crate::measured::Measured;
use crate::register_analysis;
use crate::study::{Uses, Write};

register_analysis!(TournamentEntry);

/// The set, the models that take part, and the points.
pub struct TournamentPlan<'a> {
    /// The points of the grid; none of measured ones.
    run: Run<'a>,
    entrants: Vec<Entrants>,
    /// Measured points, and the name of their file.
    measured: Option<(Measured, String)>,
    /// The errors of the models, if they are asked for.
    errors: Option<Errors>,
}

impl Plan for TournamentPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let points = match &self.measured {
            Some((measured, _)) => measured.rows.len(),
            None => self.run.points.field.len(),
        };
        let models = |of_slot: &Entrants| of_slot.list.iter().filter(|entrant| entrant.built.is_ok()).count();
        let work =
            |of_slot: &Entrants| Work::new(&of_slot.slot.name, "point of models", points * models(of_slot)).at_most();
        self.entrants.iter().map(work).collect()
    }
}

impl Analysis for TournamentEntry {
    const TYPE: &'static str = "tournament";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = TournamentPlan<'a>;
    type Outcome = TournamentOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), &self.model_set)
                .in_gears(&self.gear)
                .with("data", self.data.as_ref())
        }
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<TournamentPlan<'a>, Stopped> {
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        self.check(cx)?;
        let built = cx.built(gearbox, self.model_set.as_slice())?;
        let base = &built[0];
        let (run, measured) = match (&self.grid, &self.data) {
            (Some(grid), None) => (self.grid_points(cx, grid, base)?, None),
            (None, Some(data)) => {
                let path = format!("{}.data", cx.path());
                let measured = cx.read_at_ports(&path, data, &[])?;
                let gear = gear_of(self.gear.as_deref(), &base.transmission);
                OwnRows::new(cx, &measured, gear)?;
                let run = Run::new(cx, base, cx.listed(&base.transmission, gear, Vec::new()))?;
                (run, Some((measured, cx.data(&path, data)?.file.to_string())))
            }
            _ => {
                return Err(cx.wrong(
                    &cx.path(),
                    "a tournament needs either `data` or `grid`",
                    "give measured points under `data`, or a `grid` for the spread of the models",
                ));
            }
        };
        let entrants = Entrants::all(cx, &self.mechanisms, base)?;
        Ok(TournamentPlan {
            errors: Errors::new(cx, self.model_error.as_ref(), base, &entrants)?,
            entrants,
            run,
            measured,
        })
    }

    fn reduce<'a>(&'a self, plan: TournamentPlan<'a>, engine: &Engine<'a>) -> Result<TournamentOutcome, Stopped> {
        let TournamentPlan {
            run,
            entrants,
            measured,
            errors,
        } = plan;
        let tournament = engine.undivided(|| match &measured {
            None => Ok(Tournament::Spread(Box::new(self.spread(
                engine,
                &run,
                &entrants,
                errors.as_ref(),
            )?))),
            Some((measured, file)) => {
                let ranking = self.ranking(engine, (measured, file), &run, &entrants)?;
                Ok(Tournament::Ranking(Box::new(ranking)))
            }
        })?;
        let head = engine.head(&[run.built]);
        Ok(TournamentOutcome { head, tournament })
    }
}
