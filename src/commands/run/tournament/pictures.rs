//! Pictures of a ranking: where each model is at best, errors of the best, spread of the shortlist.

use gearloss_numerics::selection::Combination;
use gearloss_report::Figure;
use gearloss_report::plot::{Bar, Line, Stroke};
use gearloss_studies::analysis::bands;
use gearloss_studies::study::TournamentEntry;

use super::super::super::solve::RPM;
use super::super::Runner;
use super::super::write::picture;
use super::rank::Outcome;
use super::{Field, Measurements};
use crate::output::{Failure, figures};
use gearloss_studies::analyses::numbers::tidy;

pub fn write_all(
    runner: &Runner<'_>,
    name: &str,
    entry: &TournamentEntry,
    (rows, field): (&Measurements, &Field<'_>),
    o: &Outcome,
) -> Result<(), Failure> {
    let mut bars = Vec::new();
    for (k, slot) in field.slots.iter().enumerate() {
        for (place, candidate) in slot.candidates.iter().enumerate() {
            let best = o.ranked.iter().find(|c| c.places[k] == place);
            bars.push(Bar {
                label: format!("{}\n{}", slot.name, candidate.name),
                shares: best.map(|c| c.predicted).into_iter().collect(),
                ..Bar::default()
            });
        }
    }
    let figure = Figure::Bars {
        title: format!("{name}: error of the best combination with each model, over the accuracy of the points"),
        over: String::new(),
        height: "predicted rms over the accuracy".to_owned(),
        names: vec!["predicted rms".to_owned()],
        bars,
    };
    picture(runner, &format!("{name}-models"), figure, &entry.write)?;
    let count = rows.losses.len();
    let line = |c: &Combination| {
        let losses = field.losses().all(&c.places, &c.factors);
        let error = |i: usize| {
            let unit = rows.losses.units[i]?;
            Some((tidy(rows.speeds[i] * RPM), unit * (losses[i] - rows.losses.losses[i])))
        };
        Line {
            name: field.names(&c.places).join(", "),
            points: (0..count).map(error).collect(),
            stroke: Stroke::Dots,
        }
    };
    let figure = Figure::Lines {
        title: format!("{name}: model minus measurement of the best three, in {}", field.unit),
        x: "speed in rpm".to_owned(),
        y: format!("error in {}", field.unit),
        lines: o.ranked.iter().take(3).map(line).collect(),
    };
    picture(runner, &format!("{name}-errors"), figure, &entry.write)?;
    let list = &o.shortlist;
    let spread = |i: &usize| {
        let percent = Some(100.0 * list.deviations[*i] / list.means[*i]).filter(|x| x.is_finite())?;
        Some((tidy(rows.speeds[*i] * RPM), percent))
    };
    let of_band = |([from, to], mut places): ([f64; 2], Vec<usize>)| {
        places.sort_by(|a, b| rows.speeds[*a].total_cmp(&rows.speeds[*b]));
        let [from, to] = [from, to].map(|t| figures(t, 3));
        Line {
            name: if from == to {
                format!("{from} Nm")
            } else {
                format!("{from} to {to} Nm")
            },
            points: places.iter().map(spread).collect(),
            stroke: Stroke::Dots,
        }
    };
    let figure = Figure::Lines {
        title: format!(
            "{name}: spread of the {} combinations of the shortlist, in % of the loss",
            list.members.len()
        ),
        x: "speed in rpm".to_owned(),
        y: "weighted standard deviation in % of the loss".to_owned(),
        lines: bands(&rows.torques).into_iter().map(of_band).collect(),
    };
    picture(runner, &format!("{name}-shortlist"), figure, &entry.write)
}
