//! The differences in one sentence.

use gearloss_framework::resolve::OWN_MODELS;
use gearloss_studies::analyses::compare::{
    CompareOutcome, Comparisons, CycleComparison, DataComparison, DifferenceOfShare, GridComparison, ranking,
};
use gearloss_studies::numbers::RPM;

use crate::names::{SetNames, cycle, listed, share};
use crate::page::Page;
use crate::text::{again, in_brackets, place, short, signed};

/// Components that are named: for each cycle, and for a difference over a grid.
const OF_CYCLE: usize = 2;
const OF_GRID: usize = 3;
/// The share of the largest difference below which a component is not named.
const SMALL: f64 = 0.05;
/// Components with a tile.
const TILES: usize = 5;

pub fn add(outcome: &CompareOutcome, page: &mut Page) {
    let (what, unit) = outcome.quantity.words(outcome.difference);
    page.headline = match &outcome.comparisons {
        Comparisons::OnGrid(all) => on_grid(all, (what, unit), page),
        Comparisons::OverCycles(all) => over_cycles(all, page),
        Comparisons::WithData(all) => with_data(all, (what, unit), page),
    };
}

fn over_cycles(all: &[CycleComparison], page: &mut Page) -> Option<String> {
    let names = SetNames::new(all.iter().flat_map(|c| [c.model_set.as_str(), c.base.as_str()]));
    let mut words: Vec<(String, Vec<String>)> = Vec::new();
    for c in all {
        let percent = c.difference_percent.map(|percent| format!("{} %", signed(percent)));
        let parts = Some(leading(&c.shares, OF_CYCLE).join(", ")).filter(|parts| !parts.is_empty());
        let details: Vec<String> = percent.into_iter().chain(parts).collect();
        let details = in_brackets(&details.join("; "));
        let change = format!("{} W over {}{details}", signed(c.difference_w), cycle(&c.cycle));
        let set = names.quoted(&c.model_set);
        match words.iter_mut().find(|(other, _)| *other == set) {
            Some((_, list)) => list.push(change),
            None => words.push((set, vec![change])),
        }
        let per_km = c
            .difference_wh_per_km
            .map_or_else(String::new, |wh| format!("; {} Wh/km", signed(wh)));
        let range = c
            .range_difference_km
            .map_or_else(String::new, |km| format!("; {} km of range", signed(km)));
        let detail = format!(
            "{}: {} W{per_km}{range}",
            names.word(&c.base),
            short(c.base_mean_loss_w)
        );
        page.key_figure(
            &format!("{}, {}", names.word(&c.model_set), cycle(&c.cycle)),
            signed(c.difference_w),
            "W",
            detail,
        );
    }
    let first = base(&names, &all.first()?.base);
    let words = words.into_iter().map(|(set, list)| format!("{set} {}", listed(&list)));
    Some(format!(
        "Mean loss against {first}: {}",
        words.collect::<Vec<_>>().join("; ")
    ))
}

/// The base in a sentence.
fn base(names: &SetNames<'_>, base: &str) -> String {
    if base == OWN_MODELS {
        "the gearbox as described".to_owned()
    } else {
        names.quoted(base)
    }
}

/// The shares with the largest differences, the largest first.
fn largest(shares: &[DifferenceOfShare]) -> Vec<&DifferenceOfShare> {
    let mut order: Vec<&DifferenceOfShare> = shares.iter().filter(|share| share.difference_w != 0.0).collect();
    order.sort_by(|a, b| b.difference_w.abs().total_cmp(&a.difference_w.abs()));
    let least = order.first().map_or(0.0, |first| SMALL * first.difference_w.abs());
    order.retain(|part| part.difference_w.abs() >= least);
    order
}

/// The same with their differences.
fn leading(shares: &[DifferenceOfShare], count: usize) -> Vec<String> {
    let words = largest(shares).into_iter().take(count);
    words
        .map(|part| format!("{} {} W", share(&part.share), signed(part.difference_w)))
        .collect()
}

fn on_grid(all: &[GridComparison], (what, unit): (&str, &str), page: &mut Page) -> Option<String> {
    let names = SetNames::new(all.iter().flat_map(|c| [c.model_set.as_str(), c.base.as_str()]));
    let mut words = Vec::new();
    for c in all {
        let (Some(mean), Some(least), Some(greatest)) = (c.mean, &c.least, &c.greatest) else {
            continue;
        };
        let farthest = if least.difference.abs() > greatest.difference.abs() {
            least
        } else {
            greatest
        };
        let at = place(farthest.torque_nm, farthest.speed * RPM);
        let (set, base) = (names.quoted(&c.model_set), base(&names, &c.base));
        let share = share_of_loss(c, mean, unit);
        let side = if mean < 0.0 { "lower" } else { "higher" };
        // The first difference in full, the others by their mean.
        words.push(if words.is_empty() {
            let parts = by_component(&c.components, unit, if all.len() > 1 { 1 } else { OF_GRID });
            format!(
                "With {set} the {what} is {} {unit}{share} {side} than with {base} on average{}, most at {at} ({}{}){parts}",
                short(mean.abs()),
                everywhere(least.difference, greatest.difference),
                signed(farthest.difference),
                again(unit)
            )
        } else {
            format!("with {set} {}{}{share} {side}", short(mean.abs()), again(unit))
        });
        page.key_figure(
            &format!("{what}: {} minus {}", names.word(&c.model_set), names.word(&c.base)),
            signed(mean),
            unit,
            format!("mean{share}; {}{} at {at}", signed(farthest.difference), again(unit)),
        );
    }
    if let [only] = all
        && !(unit == "W" && only_component(&only.components).is_some())
    {
        tiles_of_components(only, &names, page);
    }
    (!words.is_empty()).then(|| words.join("; "))
}

/// The component that alone differs.
fn only_component(components: &[DifferenceOfShare]) -> Option<&DifferenceOfShare> {
    let mut different = components.iter().filter(|part| part.difference_w != 0.0);
    different.next().filter(|_| different.next().is_none())
}

/// The components with the largest differences, as the end of a sentence.
fn by_component(components: &[DifferenceOfShare], unit: &str, count: usize) -> String {
    match only_component(components) {
        Some(only) if unit == "W" => format!("; all of it in {}", share(&only.share)),
        _ => match leading(components, count).join(", ") {
            parts if parts.is_empty() => parts,
            parts => format!("; loss by component: {parts} on average"),
        },
    }
}

/// A mean difference of the loss as a share of the mean loss of the base.
fn share_of_loss(c: &GridComparison, mean: f64, unit: &str) -> String {
    let base: f64 = c.components.iter().map(|component| component.base_mean_loss_w).sum();
    if unit == "W" && base > 0.0 {
        format!(" ({} % of {} W)", short(100.0 * mean.abs() / base), short(base))
    } else {
        String::new()
    }
}

/// The components that contribute most to the difference.
fn tiles_of_components(c: &GridComparison, names: &SetNames<'_>, page: &mut Page) {
    for part in largest(&c.components).into_iter().take(TILES) {
        let detail = format!(
            "mean; {} {} W, {} {} W",
            names.word(&c.base),
            short(part.base_mean_loss_w),
            names.word(&c.model_set),
            short(part.mean_loss_w)
        );
        page.key_figure(
            &format!("difference in {}", share(&part.share)),
            signed(part.difference_w),
            "W",
            detail,
        );
    }
}

/// Says that a difference has one sign.
fn everywhere(least: f64, greatest: f64) -> &'static str {
    match (least > 0.0, greatest < 0.0) {
        (true, _) => ", higher at every point",
        (_, true) => ", lower at every point",
        _ => "",
    }
}

/// A set that is compared with data: the gearbox itself, or other models for it.
fn as_described(set: &str) -> String {
    if set == OWN_MODELS {
        "as described".to_owned()
    } else {
        format!("with `{set}`")
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
            page.key_figure(
                &format!("{what} deviation, {}", as_described(&c.model_set)),
                short(difference.rms),
                unit,
                detail,
            );
        }
    }
    let ranked = ranking(all).sets;
    let (first, others) = ranked.split_first()?;
    let others: Vec<String> = others
        .iter()
        .map(|(set, rms)| format!("`{set}` {}", short(*rms)))
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
    let mean = all.iter().find(|c| c.model_set == first.0).and_then(|c| c.difference);
    let mean = mean.map_or_else(String::new, |difference| {
        format!(" (mean {} {unit})", signed(difference.mean))
    });
    let closest = if ranked.len() > 1 { "at best, " } else { "" };
    let (start, with) = if first.0 == OWN_MODELS && others.is_empty() {
        ("As described, the", String::new())
    } else {
        ("The", format!(" {closest}{}", as_described(&first.0)))
    };
    Some(format!(
        "{start} {what} deviates from the data by {} {unit} rms{mean}{with}{others}",
        short(first.1)
    ))
}
