//! The largest loss and its greatest share, in one sentence.

use gearloss_studies::analyses::breakdown::{As, BreakdownOutcome};
use gearloss_studies::analyses::numbers::tidy;

use crate::page::Page;
use crate::text::{place, short};

pub fn add(outcome: &BreakdownOutcome, page: &mut Page) {
    let unit = outcome.unit.symbol();
    let mut words = Vec::new();
    for of_set in &outcome.breakdowns {
        let lost = of_set
            .points
            .iter()
            .filter_map(|point| Some((point, point.losses.shares()?)));
        let sum = |shares: &[f64]| shares.iter().sum::<f64>();
        // In percent all sums are equal.
        let size = |shares: &[f64]| match outcome.unit {
            As::Watts => sum(shares),
            As::Percent => shares.iter().copied().fold(0.0, f64::max),
        };
        let Some((point, shares)) = lost.max_by(|a, b| size(a.1).total_cmp(&size(b.1))) else {
            continue;
        };
        let total = sum(shares);
        let Some((largest, most)) = of_set.shares.iter().zip(shares).max_by(|a, b| a.1.total_cmp(b.1)) else {
            continue;
        };
        let at = place(tidy(point.torque_nm), tidy(point.speed_rpm));
        let of = if outcome.breakdowns.iter().any(|other| other.gear != of_set.gear) {
            format!("{}, gear {}", of_set.model_set, of_set.gear)
        } else {
            of_set.model_set.clone()
        };
        let share = if total > 0.0 { 100.0 * most / total } else { 0.0 };
        words.push(match outcome.unit {
            As::Watts => format!("{of}: {} W at {at}, {} % of it {largest}", short(total), short(share)),
            As::Percent => format!("{of}: {} % {largest} at {at}", short(share)),
        });
        page.key_figure(
            &format!("largest share, {of}"),
            short(*most),
            unit,
            format!("{largest} at {at}"),
        );
    }
    page.headline = (!words.is_empty()).then(|| words.join("; "));
}
