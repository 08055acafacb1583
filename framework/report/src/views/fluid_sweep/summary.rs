//! The oil with the least loss in one sentence.

use gearloss_studies::analyses::fluid_sweep::FluidSweepOutcome;

use crate::page::Page;
use crate::text::short;

pub fn add(outcome: &FluidSweepOutcome, page: &mut Page) {
    let mut words = Vec::new();
    let several = outcome.fluid_sweep.len() > 1;
    for set in &outcome.fluid_sweep {
        for duty in &set.cycles {
            let least = &duty.least;
            let of = if several {
                format!("{}, {}", duty.cycle, set.model_set)
            } else {
                duty.cycle.clone()
            };
            let end = if least.at_end_of_range {
                ", the end of the range"
            } else {
                ""
            };
            let flat = least.flat_range.map(short);
            words.push(format!(
                "{of}: {} W at {} {}{end} (within 1 % from {} to {})",
                short(least.mean_loss_w),
                short(least.value),
                set.unit,
                flat[0],
                flat[1]
            ));
            let detail = format!(
                "{} W; within 1 % from {} to {}",
                short(least.mean_loss_w),
                flat[0],
                flat[1]
            );
            page.key_figure(
                &format!("value of the least loss, {of}"),
                short(least.value),
                set.unit,
                detail,
            );
            if least.at_end_of_range {
                page.careful
                    .push(format!("{of}: the least loss is at the end of the range of oils"));
            }
        }
        if set
            .cycles
            .iter()
            .flat_map(|duty| &duty.fluids)
            .any(|fluid| fluid.beyond_definition)
        {
            page.careful.push(
                "below 2 mm2/s the viscosity index is not defined; its law for thicker oils is extrapolated".to_owned(),
            );
        }
    }
    page.headline = Some(format!("least mean loss: {}", words.join("; ")));
}
