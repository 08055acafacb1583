//! A ranking as text: the first combinations and the verdict.

use gearloss_numerics::inference::VISIBLE;
use gearloss_studies::analyses::tournament::{RankedCombination, RankedPoint, Ranking};
use gearloss_studies::distinct::distinct;
use gearloss_studies::points::Statistics;

use super::verdict::{short_marks, verdict};
use crate::page::Page;
use crate::text::{TextTable, number};

pub fn show(name: &str, ranking: &Ranking, page: &mut Page) {
    for note in &ranking.notes {
        page.line(format!("{name}: {note}"));
    }
    if ranking.unranked > 0 {
        page.line(format!(
            "{} combinations could not be fitted or have no valid point",
            ranking.unranked
        ));
    }
    table(name, ranking, page);
    summary(name, ranking, page);
    shortlist(name, ranking, page);
    page.line(format!(
        "losses of mechanisms are computed at the torques of the set and added; for the best combination the error is at most {:.3} % of the loss",
        ranking.gap_of_sum
    ));
    page.line("");
}

/// The combinations with the smallest errors, and the winner.
fn table(name: &str, ranking: &Ranking, page: &mut Page) {
    page.line(format!(
        "{name}: the combinations with the smallest errors; *: winner, =: not distinguishable from it; errors in {}",
        ranking.unit_in_words
    ));
    let mut shown: Vec<usize> = (0..ranking.ranking.len().min(ranking.shown)).collect();
    if !shown.contains(&ranking.winner) {
        shown.push(ranking.winner);
    }
    let combination = |i: &usize| (*i, &ranking.ranking[*i]);
    let table = TextTable::of(shown.iter().map(combination))
        .column("rank", |(i, _)| format!("{}{}", i + 1, sign(ranking, *i)))
        .each(ranking.mechanisms.iter().enumerate(), |table, (k, m)| {
            table.column(&m.mechanism, |(_, c)| &c.models[k])
        })
        .column("rms / accuracy", |(_, c)| number(Some(c.predicted_over_accuracy), 2))
        .column("predicted rms", |(_, c)| number(c.predicted_rms, 3))
        .column("worst group", |(_, c)| number(c.worst_group_rms, 3))
        .column("fitted rms", |(_, c)| number(c.fitted_rms, 3))
        .column("mean", |(_, c)| number(c.mean, 3))
        .column("time", |(_, c)| number(Some(time(ranking, c)), 2))
        .each(ranking.fits_factors.then_some("factors"), |table, head| {
            table.column(head, |(_, c)| {
                let factors = c.factors.iter().map(|f| format!("{f:.2}"));
                factors.collect::<Vec<_>>().join(" ")
            })
        })
        .column("weight", |(_, c)| number(c.weight, 2))
        .column("marks", |(_, c)| short_marks(ranking, c));
    page.table(table.finish());
    for line in distinct(shown.iter().flat_map(|i| &ranking.ranking[*i].marks)) {
        page.line(format!("mark: {line}"));
    }
}

/// The sign behind the rank of a combination.
fn sign(ranking: &Ranking, i: usize) -> &'static str {
    match () {
        () if i == ranking.winner => "*",
        () if ranking.is_alike(i) => "=",
        () => "",
    }
}

/// Relative time of a combination: the time of the set with the addition of each candidate.
fn time(ranking: &Ranking, c: &RankedCombination) -> f64 {
    let chosen = ranking.mechanisms.iter().zip(&c.places);
    let more: f64 = chosen
        .map(|(mechanism, place)| mechanism.candidates[*place].time - 1.0)
        .sum();
    (1.0 + more).max(0.0)
}

/// The verdict of the ranking.
fn summary(name: &str, ranking: &Ranking, page: &mut Page) {
    page.line(format!(
        "{name}: {} points in {} groups of neighbouring torques; errors relative to the accuracy of the loss, and in {}: the ranking is the \
         same in every unit",
        ranking.points.len(),
        ranking.groups,
        ranking.unit_in_words
    ));
    let how = if ranking.correlation_estimated {
        "estimated from the residuals of the best combination"
    } else {
        "stated"
    };
    page.line(format!(
        "{name}: correlation of the errors of any two points {:.2} ({how}), variance {:.2} times the stated one; the set of points distinguishes predictions that differ by {:.1} standard deviations of the set",
        ranking.correlation,
        ranking.variance_over_stated,
        VISIBLE.sqrt()
    ));
    page.verdict(format!("{name}: {}", verdict(ranking)));
}

/// Spread of the combinations that are not distinguishable from the winner.
fn shortlist(name: &str, ranking: &Ranking, page: &mut Page) {
    let members = ranking.ranking.iter().filter_map(|c| Some((c.weight?, c)));
    let mut members: Vec<(f64, &RankedCombination)> = members.collect();
    if members.len() < 2 {
        return;
    }
    members.sort_by(|a, b| b.0.total_cmp(&a.0));
    let largest = members.iter().take(3);
    let largest: Vec<String> = largest
        .map(|(weight, c)| format!("{weight:.2} {}", c.models.join(", ")))
        .collect();
    let rms = |percent: fn(&RankedPoint) -> f64| {
        let all = ranking.points.iter().map(percent).filter(|x| x.is_finite());
        Statistics::from_values(all).map(|s| s.rms)
    };
    page.verdict(format!(
        "{name}: the shortlist of {} spreads by {} % of the loss (weighted standard deviation, root mean square over the points; half the distance between its extremes {} %); largest weights: {}",
        members.len(),
        number(rms(|p| 100.0 * p.deviation_w / p.mean_loss_w), 2),
        number(rms(|p| 50.0 * (p.greatest_loss_w - p.least_loss_w) / p.mean_loss_w), 2),
        largest.join("; ")
    ));
}
