//! Differences of mean losses over cycles: by share and by phase.

use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use super::cases::{cases, names};
use super::{CompareEntry, model_error};
use crate::analyses::common::duties::{DrivePlan, Duties, Read, Unfinished, sums_energies};
use crate::analyses::common::inputs::Input;
use crate::analyses::common::model_error::energies_of_parts;
use crate::analyses::common::shares::{Shares, together};
use crate::analyses::common::trial::Trial;
use crate::analyses::cycle::results::per_distance;
use crate::analyses::{Built, Engine, Planner, Stopped};
use crate::duty::Consumption;
use crate::points::{Driven, Note, notes, notes_over_time};
use crate::study::RideEntry;
use crate::table::Table;

/// Differences of one set or variant from the base over one cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CycleComparison {
    /// Name of the set or of the variant.
    pub model_set: String,
    /// Name of the base.
    pub base: String,
    /// Name of the cycle.
    pub cycle: String,
    /// Simulated time. [s]
    pub duration_s: f64,
    /// Mean loss of the base. [W]
    pub base_mean_loss_w: f64,
    /// Mean loss. [W]
    pub mean_loss_w: f64,
    /// Difference of the mean losses. [W]
    pub difference_w: f64,
    /// Lower end, median and upper end of the 95 % band of the difference, from the known errors of the models; absent unless they are asked for,
    /// and known for some model. [W]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference_band_w: Option<[f64; 3]>,
    /// The same relative to the base; absent if it has no loss. [%]
    pub difference_percent: Option<f64>,
    /// The same as energy per distance; absent without a vehicle. [Wh/km]
    pub difference_wh_per_km: Option<f64>,
    /// Difference of the consumption of the vehicle; absent without a battery. [kWh/100 km]
    pub consumption_difference_kwh_per_100_km: Option<f64>,
    /// Difference of the range of the vehicle; absent without a battery. [km]
    pub range_difference_km: Option<f64>,
    /// Energy of the vehicle with the base; absent without a battery.
    pub base_consumption: Option<Consumption>,
    /// Energy of the vehicle; absent without a battery.
    pub consumption: Option<Consumption>,
    /// Differences by share of the loss.
    pub shares: Vec<DifferenceOfShare>,
    /// Differences by phase of the cycle; empty if it has none.
    pub phases: Vec<DifferenceOfPhase>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Number of quantities outside their stated ranges with the base.
    #[serde(skip)]
    pub ranges_left_by_base: usize,
}

/// Difference of one share of the loss.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DifferenceOfShare {
    /// Name of the share.
    pub share: String,
    /// Mean loss of the base. [W]
    pub base_mean_loss_w: f64,
    /// Mean loss. [W]
    pub mean_loss_w: f64,
    /// Difference. [W]
    pub difference_w: f64,
}

/// Difference in one phase of a cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DifferenceOfPhase {
    /// Name of the phase.
    pub phase: String,
    /// Its start. [s]
    pub from_s: f64,
    /// Its end. [s]
    pub to_s: f64,
    /// Mean loss of the base. [W]
    pub base_mean_loss_w: f64,
    /// Mean loss. [W]
    pub mean_loss_w: f64,
    /// Difference. [W]
    pub difference_w: f64,
}

/// Cycles of the base and the compared sets, the base first.
pub(super) fn plan<'a>(
    cx: &Planner<'a>,
    entry: &'a CompareEntry,
    ride: &'a RideEntry,
    base: &str,
) -> Result<DrivePlan<'a>, Stopped> {
    let path = cx.path();
    let gearbox = cx.gearbox(entry.gearbox.as_ref())?;
    sums_energies(cx, &path, entry.by)?;
    let duties = Duties::new(cx, &format!("{path}.drive"), ride, entry.gear.as_ref().map(Into::into))?;
    let built = cases(cx, entry, gearbox, &names(entry, base))?;
    DrivePlan::new(cx, &path, duties, built)
}

pub(super) fn compare(
    engine: &Engine<'_>,
    entry: &CompareEntry,
    plan: &DrivePlan<'_>,
    inputs: &[Vec<Input>],
) -> Result<Vec<CycleComparison>, Stopped> {
    let DrivePlan { built, duties } = plan;
    let driven = plan.drive(engine)?;
    plan.refuse_broken(engine, &driven)?;
    let losses = |_: usize, _: &Trial<'_>, t: &Transmission| {
        let driven = duties
            .drive_all(t, &|| engine.should_continue())
            .map_err(Unfinished::text)?;
        // A cycle without time has no energy.
        let mean =
            |driven: &Driven| driven.total.parts.iter().sum::<f64>() / driven.total.duration.max(f64::MIN_POSITIVE);
        Ok(driven.iter().map(|driven| vec![mean(driven)]).collect())
    };
    let bands = model_error::bands(engine, entry, (built, inputs), &losses)?;
    for (b, driven) in built.iter().zip(&driven).filter(|_| !inputs.is_empty()) {
        engine.weigh_model_error(&b.name, &energies_of_parts(driven));
    }
    let share_names = together(built.iter().map(|b| &b.transmission), entry.by);
    let (Some((base, others)), Some((of_base, of_others))) = (built.split_first(), driven.split_first()) else {
        return Ok(Vec::new());
    };
    let mut comparisons = Vec::new();
    for (case, (b, driven_of_set)) in others.iter().zip(of_others).enumerate() {
        for (cycle, ((read, driven), of_base)) in duties.list.iter().zip(driven_of_set).zip(of_base).enumerate() {
            let shares = [base, b].map(|b| Shares::new(&b.transmission, entry.by).under(&share_names));
            let mut compared = comparison(read, [(base, of_base), (b, driven)], &shares);
            let both = [(base, of_base), (b, driven)];
            let both = both.map(|(b, driven)| duties.consumption(&b.transmission, driven));
            [compared.base_consumption, compared.consumption] = both;
            if let [Some(before), Some(now)] = both {
                compared.consumption_difference_kwh_per_100_km =
                    Some(now.consumption_kwh_per_100_km - before.consumption_kwh_per_100_km);
                compared.range_difference_km = now.range_km.zip(before.range_km).map(|(now, before)| now - before);
            }
            compared.difference_band_w = bands.get(case).and_then(|cycles| *cycles.get(cycle)?);
            comparisons.push(compared);
        }
    }
    Ok(comparisons)
}

/// Base and case over one cycle.
fn comparison(read: &Read, pair: [(&Built<'_>, &Driven); 2], shares: &[Shares; 2]) -> CycleComparison {
    let [(base, of_base), (b, driven)] = pair;
    // A cycle without time has no energy.
    let duration = driven.total.duration.max(f64::MIN_POSITIVE);
    let both = [of_base, driven];
    let losses = [0, 1].map(|k| both[k].total.parts.iter().sum::<f64>() / duration);
    let difference = losses[1] - losses[0];
    let sums = [0, 1].map(|k| shares[k].sums(&both[k].total.parts));
    let share = |(i, name): (usize, &String)| {
        let [before, now] = [0, 1].map(|k| sums[k][i] / duration);
        DifferenceOfShare {
            share: name.clone(),
            base_mean_loss_w: before,
            mean_loss_w: now,
            difference_w: now - before,
        }
    };
    let km = per_distance(driven).map(|per| per.distance_km);
    CycleComparison {
        model_set: b.name.clone(),
        base: base.name.clone(),
        cycle: read.name.clone(),
        duration_s: duration,
        base_mean_loss_w: losses[0],
        mean_loss_w: losses[1],
        difference_w: difference,
        difference_band_w: None,
        difference_percent: (losses[0] > 0.0).then(|| 100.0 * difference / losses[0]),
        difference_wh_per_km: km.map(|km| difference * duration / 3600.0 / km),
        consumption_difference_kwh_per_100_km: None,
        range_difference_km: None,
        base_consumption: None,
        consumption: None,
        shares: shares[0].names.iter().enumerate().map(share).collect(),
        phases: phases(read, both),
        notes: notes_over_time(&b.transmission, driven),
        ranges_left_by_base: notes(&base.transmission, &of_base.seen)
            .iter()
            .filter(|note| note.outside > 0)
            .count(),
    }
}

/// Mean losses in each phase.
fn phases(read: &Read, both: [&Driven; 2]) -> Vec<DifferenceOfPhase> {
    let mut from = 0.0;
    let phase = |(name, end): &(String, f64)| {
        let start = std::mem::replace(&mut from, *end);
        let mean = |driven: &Driven| {
            let (mut joule, mut time) = (0.0, 0.0);
            let first = driven.stretches.first().map_or(0.0, |s| s.start);
            for s in &driven.stretches {
                // An interval belongs to the phase in which its middle lies.
                let middle = s.start - first + 0.5 * s.heats.duration;
                if middle >= start && middle < *end {
                    joule += s.heats.parts.iter().sum::<f64>();
                    time += s.heats.duration;
                }
            }
            if time > 0.0 { joule / time } else { 0.0 }
        };
        let [before, now] = both.map(mean);
        DifferenceOfPhase {
            phase: name.clone(),
            from_s: start,
            to_s: *end,
            base_mean_loss_w: before,
            mean_loss_w: now,
            difference_w: now - before,
        }
    };
    read.phases.iter().map(phase).collect()
}

/// A row for each share of the loss.
pub(super) fn table(name: &str, all: &[CycleComparison]) -> Table {
    Table::of_each(name, all, |c| &c.shares)
        .text("model_set", "Model set or variant", |(c, _)| &c.model_set)
        .text("base", "Base", |(c, _)| &c.base)
        .text("cycle", "Duty cycle", |(c, _)| &c.cycle)
        .fields("share base_mean_loss_w mean_loss_w difference_w", |(_, share)| share)
        .finish()
}

/// A row for each phase of the cycles.
pub(super) fn phase_table(name: &str, all: &[CycleComparison]) -> Table {
    Table::of_each(format!("{name}-phases"), all, |c| &c.phases)
        .text("model_set", "Model set or variant", |(c, _)| &c.model_set)
        .text("base", "Base", |(c, _)| &c.base)
        .text("cycle", "Duty cycle", |(c, _)| &c.cycle)
        .fields(
            "phase from_s to_s base_mean_loss_w mean_loss_w difference_w",
            |(_, phase)| phase,
        )
        .finish()
}
