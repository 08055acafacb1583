//! Comparison with a measurement: statistics over all points and in bands for each set, the best set, parity plot, differences and their
//! histogram.

use gearloss_studies::analyses::common::measurable::note;
use gearloss_studies::analyses::compare::{Band, CompareOutcome, DataComparison, ranking};
use gearloss_studies::numbers::RPM;
use gearloss_studies::points::Statistics;

use crate::deviations::{Deviation, histograms, parity, picture};
use crate::page::Page;
use crate::text::{TextTable, number};

pub fn show(outcome: &CompareOutcome, all: &[DataComparison], page: &mut Page) {
    let name = &outcome.head.analysis;
    if let Some(data) = &outcome.data {
        for note in &data.notes {
            page.line(format!("{name}: {}: {note}", data.file));
        }
    }
    let (words, label) = outcome.quantity.words(outcome.difference);
    for c in all {
        page.line(format!("{name}: {} minus measurement, {words} in {label}", c.model_set));
        page.table(statistics(c));
        let omitted = c.points.iter().filter(|p| p.omitted).count();
        if omitted > 0 {
            page.line(note(omitted, "the difference"));
        }
        page.line("");
    }
    if let Some(sentence) = best(outcome, all) {
        page.verdict(sentence);
        page.line("");
    }
    figures(outcome, all, page);
}

/// Statistics over all points and in bands as a table.
fn statistics(c: &DataComparison) -> TextTable {
    let mut table = TextTable::new(&["over", "points", "min", "max", "mean", "rms"]);
    let mut line = |over: String, statistics: Option<Statistics>| {
        let mut row = vec![over, statistics.map_or(0, |s| s.count).to_string()];
        match statistics {
            Some(s) => row.extend([s.least, s.greatest, s.mean, s.rms].map(|x| number(Some(x), 3))),
            None => row.extend(["-"; 4].map(str::to_owned)),
        }
        table.row(row);
    };
    line("all points".to_owned(), c.difference);
    line("all points, loss in %".to_owned(), c.loss_difference_percent_of_loss);
    if c.corrected_difference.is_some() {
        line(
            "all points inside, with the correction".to_owned(),
            c.corrected_difference,
        );
    }
    for band in &c.bands {
        line(range(band), band.difference);
    }
    table
}

/// A band as text; equal ends as one value.
fn range(band: &Band) -> String {
    let Band { over, from, to, .. } = band;
    let unit = if *over == "torque" { "Nm" } else { "rpm" };
    if (to - from).abs() <= 0.005 * to.abs() {
        format!("{over} {from:.1} {unit}")
    } else {
        format!("{over} {from:.1} to {to:.1} {unit}")
    }
}

/// The set that matches the measurement best, and whether the accuracy of the measurement distinguishes the sets.
fn best(outcome: &CompareOutcome, all: &[DataComparison]) -> Option<String> {
    let name = &outcome.head.analysis;
    let ranking = ranking(all);
    let [first, second, ..] = &ranking.sets[..] else {
        return None;
    };
    let (_, unit) = outcome.quantity.words(outcome.difference);
    let mut words = format!(
        "{name}: `{}` matches the measurement best, {:.3} {unit} rms; next `{}`, {:.3}",
        first.0, first.1, second.0, second.1
    );
    if ranking.omitted > 0 {
        words.push_str(&format!(
            ", over the {} points at which all sets have a value; {} are omitted",
            ranking.points, ranking.omitted
        ));
    }
    if let Some(accuracy) = all[0].accuracy.filter(|accuracy| second.1 - first.1 < *accuracy) {
        words.push_str(&format!(
            "; indistinguishable at a measurement accuracy of {accuracy:.3} {unit}"
        ));
    }
    Some(words)
}

fn figures(outcome: &CompareOutcome, all: &[DataComparison], page: &mut Page) {
    let name = &outcome.head.analysis;
    let (what, unit) = outcome.quantity.words(outcome.difference);
    let pairs = |c: &DataComparison| c.points.iter().map(|p| Some((p.measured?, p.model?))).collect();
    let figure = parity(
        name,
        what,
        (&format!("measured {what}"), &format!("model {what}")),
        all.iter().map(|c| (c.model_set.clone(), pairs(c))).collect(),
    );
    page.figure(format!("{name}-parity"), figure);
    for c in all {
        let title = format!("{name}: {what} of {} minus measurement in {unit}", c.model_set);
        let points = c.points.iter().map(|p| (p.torque_nm, p.speed * RPM, p.difference));
        let points: Vec<Deviation> = points.collect();
        page.figure(
            format!("{name}-{}", c.model_set),
            picture(title, (what, unit), &points, c.accuracy, None),
        );
    }
    let values = |c: &DataComparison| c.points.iter().filter_map(|p| p.difference).collect();
    let lists = all.iter().map(|c| (c.model_set.clone(), values(c))).collect();
    page.figure(format!("{name}-histogram"), histograms(name, (what, unit), lists));
}
