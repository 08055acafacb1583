//! The differences in one sentence.

use gearloss_studies::analyses::compare::{
    CompareOutcome, Comparisons, CycleComparison, DataComparison, DifferenceOfShare, GridComparison, ranking,
};
use gearloss_studies::analyses::numbers::RPM;

use crate::page::Page;
use crate::text::{brief, place, short, signed};

pub fn add(outcome: &CompareOutcome, page: &mut Page) {
    let (what, unit) = outcome.quantity.words(outcome.difference);
    let unit = brief(unit);
    page.headline = match &outcome.comparisons {
        Comparisons::OnGrid(all) => on_grid(all, (what, unit), page),
        Comparisons::OverCycles(all) => over_cycles(all, page),
        Comparisons::WithData(all) => with_data(all, (what, unit), page),
    };
}

fn over_cycles(all: &[CycleComparison], page: &mut Page) -> Option<String> {
    let mut words = Vec::new();
    for c in all {
        let percent = c
            .difference_percent
            .map_or_else(String::new, |percent| format!(" ({} %)", signed(percent)));
        // The share that changes most in the direction of the sum.
        let size = |share: &&DifferenceOfShare| share.difference_w * c.difference_w.signum();
        let most = c.shares.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let most = most
            .filter(|share| share.difference_w != 0.0)
            .map_or_else(String::new, |share| {
                format!(", most in {} ({} W)", share.share, signed(share.difference_w))
            });
        words.push(format!(
            "{}, {}: {} W{percent}{most}",
            c.model_set,
            c.cycle,
            signed(c.difference_w)
        ));
        let per_km = c
            .difference_wh_per_km
            .map_or_else(String::new, |wh| format!("; {} Wh/km", signed(wh)));
        let detail = format!("{}: {} W{per_km}", c.base, short(c.base_mean_loss_w));
        page.key_figure(
            &format!("{}, {}", c.model_set, c.cycle),
            signed(c.difference_w),
            "W",
            detail,
        );
    }
    let base = &all.first()?.base;
    Some(format!("mean loss minus that of {base}: {}", words.join("; ")))
}

fn on_grid(all: &[GridComparison], (what, unit): (&str, &str), page: &mut Page) -> Option<String> {
    let mut words = Vec::new();
    for c in all {
        let (Some(mean), Some(least), Some(greatest)) = (c.mean, &c.least, &c.greatest) else {
            continue;
        };
        let largest = if least.difference.abs() > greatest.difference.abs() {
            least
        } else {
            greatest
        };
        let at = place(largest.torque_nm, largest.speed * RPM);
        let of = format!("{} minus {}", c.model_set, c.base);
        words.push(format!(
            "{of}: {} {unit} on average, {} at {at}{}",
            signed(mean),
            signed(largest.difference),
            everywhere(least.difference, greatest.difference)
        ));
        let label = format!("{what}: {of}");
        page.key_figure(
            &label,
            signed(mean),
            unit,
            format!("mean; {} at {at}", signed(largest.difference)),
        );
    }
    (!words.is_empty()).then(|| format!("{what}: {}", words.join("; ")))
}

/// Says that a difference has one sign.
fn everywhere(least: f64, greatest: f64) -> &'static str {
    match (least > 0.0, greatest < 0.0) {
        (true, _) => ", higher at every point",
        (_, true) => ", lower at every point",
        _ => "",
    }
}

fn with_data(all: &[DataComparison], (what, unit): (&str, &str), page: &mut Page) -> Option<String> {
    for c in all {
        if let Some(difference) = c.difference {
            let detail = format!(
                "rms over {} points; mean {} {unit}",
                difference.count,
                signed(difference.mean)
            );
            page.key_figure(&format!("{what}: {}", c.model_set), short(difference.rms), unit, detail);
        }
    }
    let ranked = ranking(all).sets;
    let (first, others) = ranked.split_first()?;
    let others: Vec<String> = others
        .iter()
        .map(|(set, rms)| format!("{set} {}", short(*rms)))
        .collect();
    let accuracy = all.first().and_then(|c| c.accuracy);
    if let (Some(accuracy), Some(next)) = (accuracy, ranked.get(1))
        && next.1 - first.1 < accuracy
    {
        page.careful.push(format!(
            "the measurement does not distinguish {} from {}: their deviations differ by less than its accuracy, {} {unit}",
            first.0, next.0, short(accuracy)
        ));
    }
    let others = if others.is_empty() {
        String::new()
    } else {
        format!("; {}", others.join(", "))
    };
    Some(format!(
        "{what} against the measurement: {} {} {unit} rms{others}",
        first.0,
        short(first.1)
    ))
}
