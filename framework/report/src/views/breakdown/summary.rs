//! The largest loss and its greatest share, in one sentence.

use gearloss_studies::analyses::breakdown::{As, BreakdownOfSet, BreakdownOutcome};
use gearloss_studies::numbers::tidy;

use crate::names::{SetNames, share};
use crate::page::Page;
use crate::text::{capitalised, in_brackets, label_of_set, place, short};

/// Shares that are named.
const NAMED: usize = 3;

pub fn add(outcome: &BreakdownOutcome, page: &mut Page) {
    let unit = outcome.unit.symbol();
    let names = SetNames::new(outcome.breakdowns.iter().map(|breakdown| breakdown.model_set.as_str()));
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
        let mut leading: Vec<(String, f64)> = of_set
            .shares
            .iter()
            .map(|name| share(name))
            .zip(shares.iter().copied())
            .collect();
        leading.sort_by(|a, b| b.1.total_cmp(&a.1));
        let Some((largest, most)) = leading.first() else {
            continue;
        };
        // Of several temperatures, the one of the point matters.
        let is_several = of_set
            .points
            .iter()
            .any(|other| other.oil_temperature_degc != point.oil_temperature_degc);
        let oil = point.oil_temperature_degc.filter(|_| is_several);
        let oil = oil.map_or_else(String::new, |oil| format!(", oil {} °C", short(oil)));
        let at = place(tidy(point.torque_nm), tidy(point.speed_rpm)) + &oil;
        let gear = if differs(outcome, |breakdown| &breakdown.gear) {
            format!(" in gear {}", of_set.gear)
        } else {
            String::new()
        };
        let of = format!("{}{gear}", names.quoted(&of_set.model_set));
        let percent = |watts: f64| short(if total > 0.0 { 100.0 * watts / total } else { 0.0 });
        words.push(match outcome.unit {
            As::Watts => {
                let leading = leading.iter().take(NAMED).filter(|(_, watts)| *watts > 0.0);
                let leading: Vec<String> = leading
                    .map(|(name, watts)| format!("{name} {} %", percent(*watts)))
                    .collect();
                format!(
                    "with {of} the loss is {} W at {at}{}",
                    short(total),
                    in_brackets(&leading.join(", "))
                )
            }
            As::Percent => format!("{largest} with {} % at {at} ({of})", percent(*most)),
        });
        let most = format!("{} {unit}", short(*most));
        let sets = if differs(outcome, |breakdown| &breakdown.model_set) {
            2
        } else {
            1
        };
        page.key_figure(
            &label_of_set(&format!("loss{gear}"), &names.word(&of_set.model_set), sets),
            short(total),
            "W",
            format!("{largest} {most}, at {at}"),
        );
    }
    let all = words.join("; ");
    page.headline = (!words.is_empty()).then(|| match outcome.unit {
        As::Watts => capitalised(&all),
        As::Percent => format!("Largest share: {all}"),
    });
}

/// Whether the breakdowns differ in something.
fn differs(outcome: &BreakdownOutcome, read: fn(&BreakdownOfSet) -> &str) -> bool {
    outcome
        .breakdowns
        .windows(2)
        .any(|pair| read(&pair[0]) != read(&pair[1]))
}
