//! Limits of a study that points or cycles do not keep, in words.

use gearloss_framework::resolve::OWN_MODELS;
use gearloss_studies::distinct::distinct;
use gearloss_studies::limits::reached::{LimitReached, Place};

use crate::names::{listed, model, of_component};
use crate::page::Page;
use crate::text::{TextTable, printed_unit, short};

/// Adds the limits of an analysis: broken ones as sentences, all of them as a table.
pub fn add(limits: &[LimitReached], page: &mut Page) {
    if limits.is_empty() {
        return;
    }
    let broken = limits.iter().filter(|limit| limit.is_broken());
    page.limits = broken.map(|limit| format!("limit {}", sentence(limit))).collect();
    if let Some(headline) = &mut page.headline {
        page.limits_verdict = verdict(limits);
        headline.push_str(&page.limits_verdict);
    }
    let table = TextTable::of(limits)
        .column("limit", |limit| &limit.limit)
        .column("models", |limit| &limit.model_set)
        .column("quantity", |limit| of_component(&limit.quantity))
        .column("allowed", |limit| bounds(limit))
        .column("worst", |limit| match limit.worst {
            Some(worst) => format!("{}{}", short(worst), after(&limit.unit)),
            None => "unknown".to_owned(),
        })
        .column("where", |limit| place(&limit.at))
        .column("beyond", |limit| {
            format!("{} of {}{}", limit.beyond, limit.points, unknown(limit))
        });
    page.table(table.finish().titled("Limits of the study"));
}

/// Which limits are kept, as the end of a sentence; nothing if none is broken but some are not known everywhere.
fn verdict(limits: &[LimitReached]) -> String {
    let broken = limits.iter().filter(|limit| limit.is_broken());
    let broken = distinct(broken.map(|limit| format!("`{}`", limit.limit)));
    match &broken[..] {
        [] if limits.iter().any(|limit| limit.points_unknown > 0) => String::new(),
        [] => "; every limit is kept".to_owned(),
        [one] => format!("; the limit {one} is not kept"),
        several => format!("; the limits {} are not kept", listed(several)),
    }
}

/// A broken limit with its worst value.
pub fn sentence(limit: &LimitReached) -> String {
    let what = if limit.at.cycle.is_some() { "cycles" } else { "points" };
    let Some(worst) = limit.worst else {
        return format!(
            "{}: {} is unknown at all {} {what}; the limit cannot be kept",
            limit.limit,
            of_component(&limit.quantity),
            limit.points_unknown
        );
    };
    let side = match limit.least {
        Some(least) if worst < least => "below",
        _ => "above",
    };
    let bound = if side == "below" { limit.least } else { limit.most }.unwrap_or(f64::NAN);
    let unit = after(&limit.unit);
    format!(
        "{}: {} is {}{unit}, {side} {}{unit}, {}; beyond the limit at {} of {} {what}{}{}",
        limit.limit,
        of_component(&limit.quantity),
        short(worst),
        short(bound),
        place(&without_repetition(limit)),
        limit.beyond,
        limit.points,
        unknown(limit),
        match limit.model_set.as_str() {
            OWN_MODELS => String::new(),
            set => format!(" with {set}"),
        }
    )
}

/// How often the quantity is unknown; nothing if it never is.
fn unknown(limit: &LimitReached) -> String {
    match limit.points_unknown {
        0 => String::new(),
        count => format!(", unknown at {count}"),
    }
}

/// A unit after its number; nothing for `-`.
pub fn after(unit: &str) -> String {
    match unit {
        "-" => String::new(),
        _ => format!(" {}", printed_unit(unit)),
    }
}

/// A unit of an axis or a title.
pub fn in_unit(unit: &str) -> String {
    match unit {
        "-" => String::new(),
        _ => format!(" in {}", printed_unit(unit)),
    }
}

/// The bounds as words of a title.
pub fn bounds(limit: &LimitReached) -> String {
    let unit = after(&limit.unit);
    match (limit.least, limit.most) {
        (Some(least), Some(most)) => format!("{} to {}{unit}", short(least), short(most)),
        (Some(least), None) => format!("at least {}{unit}", short(least)),
        (None, Some(most)) => format!("at most {}{unit}", short(most)),
        (None, None) => String::new(),
    }
}

/// Where a value was found, without the component if the quantity names it.
fn without_repetition(limit: &LimitReached) -> Place {
    let mut at = limit.at.clone();
    at.component
        .take_if(|component| limit.quantity.ends_with(component.as_str()));
    at
}

/// Where a value was found.
fn place(at: &Place) -> String {
    let component = at.component.iter().map(|component| format!("at {}", model(component)));
    let cycle = at.cycle.iter().map(|cycle| format!("over {cycle}"));
    let torque = at.torque_nm.map(|torque| format!("{} Nm", short(torque)));
    let speed = at.speed_rpm.map(|speed| format!("{speed:.0} rpm"));
    let gear = at.gear.iter().map(|gear| format!("gear {gear}"));
    let all = component.chain(cycle).chain(torque).chain(speed).chain(gear);
    all.collect::<Vec<_>>().join(", ")
}
