//! A sweep over cycles: mean losses, and the consumption of the vehicle.

use super::outcome::{CycleOfSweep, LimitOfSweep, NotesOfSet, SweepOutcome};
use super::{Solved, SweepEntry, VariedPaths, compact, second_of, value_of};
use crate::analyses::common::duties::DrivePlan;
use crate::analyses::common::gears::GearOfCycles;
use crate::analyses::common::ranges::published;
use crate::analyses::common::shares::together;
use crate::analyses::cycle::limited_in_cycles;
use crate::analyses::{Engine, Stopped, gear_of};
use crate::limits::Limit;
use crate::points::notes_over_time;
use crate::varied::{Tie, Varied};

impl SweepEntry {
    /// The results over cycles.
    pub(super) fn over_cycles(
        &self,
        engine: &Engine<'_>,
        plan: &DrivePlan<'_>,
        limits: &[Vec<Limit>],
        varied: &VariedPaths,
        solved: Solved,
    ) -> Result<SweepOutcome, Stopped> {
        let driven = plan.drive(engine)?;
        plan.refuse_broken(engine, &driven)?;
        let DrivePlan { built, duties } = plan;
        let names = together(built.iter().map(|b| &b.transmission), self.by);
        let gear = self.gear.as_ref().map(GearOfCycles::from);
        let mut cycles = Vec::new();
        for ((b, driven), (limits, places)) in built.iter().zip(&driven).zip(limits.iter().zip(&solved.places)) {
            let limited = limited_in_cycles(engine, b, limits, duties, driven)?;
            let t = &b.transmission;
            let (means, _) = duties.mean_losses_of(t, driven, self.by, &names);
            for (k, (mean, driven)) in means.into_iter().zip(driven).enumerate() {
                cycles.push(CycleOfSweep {
                    model_set: b.name.clone(),
                    gear: gear.map_or_else(|| gear_of(None, t), GearOfCycles::word).to_owned(),
                    path: varied.0.words(),
                    value: value_of(&varied.0, places[0]),
                    second: second_of(varied, *places),
                    cycle: duties.list[k].name.clone(),
                    shares: names.clone(),
                    mean_loss_w: mean.loss,
                    mean_losses_w: mean.shares,
                    consumption: mean.consumption,
                    limited: limited[k].clone(),
                    notes: notes_over_time(t, driven),
                    places: *places,
                });
            }
        }
        compact(cycles.iter_mut().map(|value| &mut value.places).collect());
        let (first, second) = varied;
        let paths = first.paths.iter().chain(second.iter().flat_map(|second| &second.paths));
        let quantity = |path: &String| Varied::new(engine.language, &built.first()?.resolved, path, Tie::Value).ok();
        let coefficients: Vec<Varied> = paths.filter_map(quantity).collect();
        let columns = limits.first().map_or(&[][..], Vec::as_slice);
        Ok(SweepOutcome {
            head: engine.head(built),
            notes: NotesOfSet::all(cycles.iter().map(|value| (&value.model_set, &value.notes))),
            sweep: Vec::new(),
            cycle_limits: columns.iter().map(LimitOfSweep::new).collect(),
            cycles,
            left_out: solved.left_out,
            limits: Vec::new(),
            published: published(coefficients.iter()),
        })
    }
}
