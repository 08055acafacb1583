//! The spread of all combinations over a grid.

use gearloss_studies::analyses::tournament::Spread;
use gearloss_studies::numbers::{RPM, tidy};

use crate::page::Page;
use crate::text::{TextTable, number};
use crate::{Figure, Map};

pub fn show(name: &str, spread: &Spread, page: &mut Page) {
    let table = TextTable::of(spread.mechanisms.iter().zip(&spread.shares_of_spread))
        .column("mechanism", |(mechanism, _)| &mechanism.mechanism)
        .column("models", |(mechanism, _)| mechanism.candidates.len().to_string())
        .column("share of the spread %", |(_, of)| {
            number(of.share.map(|share| 100.0 * share), 1)
        });
    page.table(table.finish());
    let halves = spread
        .points
        .iter()
        .map(|p| 0.5 * (p.greatest_loss_w - p.least_loss_w) * p.scale);
    page.verdict(format!(
        "half the distance between the extremes: {:.3} to {:.3} {}; standard deviation {:.3} rms",
        halves.clone().fold(f64::INFINITY, f64::min),
        halves.fold(0.0, f64::max),
        spread.unit_in_words,
        spread.deviation_rms
    ));
    let bands = || {
        spread
            .points
            .iter()
            .filter_map(|p| p.band_w.map(|band| 0.5 * (band[2] - band[0]) * p.scale))
    };
    if bands().next().is_some() {
        page.verdict(format!(
            "half the width of the 95 % band over the combinations with the known errors of their models: {:.3} to {:.3} {}",
            bands().fold(f64::INFINITY, f64::min),
            bands().fold(0.0, f64::max),
            spread.unit_in_words
        ));
    }
    page.line("");
    if spread.torques.len() < 2 || spread.speeds.len() < 2 {
        return;
    }
    let figure = Figure::Map(Map {
        title: format!(
            "{name}: standard deviation over {} combinations in {}",
            spread.combinations, spread.unit_in_words
        ),
        x: (
            "speed rpm".to_owned(),
            spread.speeds.iter().map(|w| format!("{}", tidy(w * RPM))).collect(),
        ),
        y: (
            "torque Nm".to_owned(),
            spread.torques.iter().map(|t| format!("{}", tidy(*t))).collect(),
        ),
        values: spread.points.iter().map(|p| Some(p.deviation_w * p.scale)).collect(),
        unit: spread.unit_in_words.to_owned(),
        ..Map::default()
    });
    page.figure(format!("{name}-spread"), figure);
}
