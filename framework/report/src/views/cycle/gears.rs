//! Time and energy in each gear of a cycle, and its shifts.

use gearloss_studies::analyses::cycle::{Criterion, DutyOfSet, GearsOfDuty};

use crate::names::cycle;
use crate::page::Page;
use crate::text::{TextTable, short, significant};

/// The lines of a cycle whose gears are chosen or change.
pub fn text(duty: &DutyOfSet, page: &mut Page) {
    let Some(gears) = &duty.gears_used else { return };
    page.line(format!("  gears: {}{}", gears.choice, compared(gears)));
    let table = TextTable::of(&gears.gears)
        .column("gear", |gear| &gear.gear)
        .column("time s", |gear| significant(gear.time_s))
        .column("time %", |gear| format!("{:.1}", 100.0 * gear.time_share))
        .column("input %", |gear| format!("{:.1}", 100.0 * gear.input_share))
        .column("loss kJ", |gear| format!("{:.2}", 1e-3 * gear.loss_j))
        .column("loss %", |gear| format!("{:.1}", 100.0 * gear.loss_share));
    page.table(table.finish());
    if let Some(shifts) = gears.shifts {
        let forced = match gears.forced_shifts {
            0 => String::new(),
            forced => format!(", {forced} of them required by a limit"),
        };
        let heat = if gears.shift_energy_j > 0.0 {
            format!("; they dissipate {} kJ", significant(1e-3 * gears.shift_energy_j))
        } else {
            String::new()
        };
        page.line(format!("  {shifts} shifts{forced}{heat}"));
    }
    if let Some(optimum) = &gears.optimum {
        let share = optimum
            .gap_share
            .map_or_else(String::new, |share| format!(" ({} %)", short(100.0 * share)));
        page.line(format!(
            "  the rule needs {} kJ{share} more than the least energy of {} kJ, with {} shifts, both at the temperatures of the rule",
            significant(1e-3 * optimum.gap_j),
            significant(1e-3 * optimum.energy_j),
            optimum.rule_shifts
        ));
    }
    if gears.intervals_beyond_limits > 0 {
        page.careful.push(format!(
            "{}: every gear is beyond a limit of speed or torque in {} of {} intervals; that with the smallest excess is used",
            cycle(&duty.cycle),
            gears.intervals_beyond_limits,
            duty.intervals
        ));
    }
}

/// What is compared.
fn compared(gears: &GearsOfDuty) -> &'static str {
    match gears.criterion {
        Some(Criterion::MachinePower) => "; compared by the power of the machine",
        Some(Criterion::GearboxLoss) => "; compared by the loss of the gearbox, because no machine is described",
        None => "",
    }
}

/// Share of the time by gear, in words.
pub fn words(duty: &DutyOfSet) -> Option<String> {
    let gears = duty.gears_used.as_ref()?;
    let parts: Vec<String> = gears
        .gears
        .iter()
        .map(|gear| format!("{} {} % of the time", gear.gear, short(100.0 * gear.time_share)))
        .collect();
    Some(parts.join(", "))
}
