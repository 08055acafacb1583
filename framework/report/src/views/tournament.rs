//! A tournament: the candidates; the ranking and its verdict, or the spread.

mod pictures;
mod ranking;
mod spread;
mod summary;
mod verdict;

use gearloss_studies::analyses::tournament::{MechanismOfTournament, Tournament, TournamentOutcome};

use crate::page::Page;
use crate::register_view;
use crate::text::{TextTable, number};

register_view!(TournamentOutcome, show);

fn show(outcome: &TournamentOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    match &outcome.tournament {
        Tournament::Ranking(found) => {
            for note in &found.notes_on_file {
                page.line(format!("{name}: {note}"));
            }
            if found.points_of_other_gears > 0 {
                page.line(format!(
                    "{} points of other gear states are omitted",
                    found.points_of_other_gears
                ));
            }
            candidates(name, &found.mechanisms, &found.left_out, page);
            ranking::show(name, found, page);
            pictures::draw(name, found, page);
        }
        Tournament::Spread(found) => {
            candidates(name, &found.mechanisms, &found.left_out, page);
            spread::show(name, found, page);
        }
    }
}

/// The candidates with mean loss and time, and the reasons why others are omitted.
fn candidates(name: &str, mechanisms: &[MechanismOfTournament], left_out: &[String], page: &mut Page) {
    let counts = mechanisms
        .iter()
        .map(|m| format!("{} {}", m.candidates.len(), m.mechanism));
    let combinations: usize = mechanisms.iter().map(|m| m.candidates.len()).product();
    page.line(format!(
        "{name}: {} = {combinations} combinations",
        counts.collect::<Vec<_>>().join(" x ")
    ));
    for line in left_out {
        page.line(format!("omitted: {line}"));
    }
    let candidates = mechanisms
        .iter()
        .flat_map(|m| m.candidates.iter().map(move |candidate| (m, candidate)));
    let mean = |losses: &[f64]| losses.iter().sum::<f64>() / losses.len() as f64;
    let table = TextTable::of(candidates)
        .column("mechanism", |(m, _)| &m.mechanism)
        .column("model", |(_, candidate)| &candidate.name)
        .column("mean loss W", |(_, candidate)| {
            number(Some(mean(&candidate.losses_w)), 3)
        })
        .column("relative time", |(_, candidate)| number(Some(candidate.time), 2));
    page.table(table.finish());
    page.line("");
}
