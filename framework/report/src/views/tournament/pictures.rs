//! Figures of a ranking: best error with each model, errors of the best combinations, spread of the shortlist.

use gearloss_studies::analyses::tournament::{RankedCombination, RankedPoint, Ranking};
use gearloss_studies::points::bands;

use crate::Figure;
use crate::page::Page;
use crate::plot::{Bar, Line, Stroke};
use crate::text::figures;

pub fn draw(name: &str, ranking: &Ranking, page: &mut Page) {
    page.figure(format!("{name}-models"), models(name, ranking));
    page.figure(format!("{name}-errors"), errors(name, ranking));
    page.figure(format!("{name}-shortlist"), shortlist(name, ranking));
}

/// The error of the best combination with each model.
fn models(name: &str, ranking: &Ranking) -> Figure {
    let mut bars = Vec::new();
    for (k, mechanism) in ranking.mechanisms.iter().enumerate() {
        for (place, candidate) in mechanism.candidates.iter().enumerate() {
            let best = ranking.ranking.iter().find(|c| c.places[k] == place);
            bars.push(Bar {
                label: format!("{}\n{}", mechanism.mechanism, candidate.name),
                shares: best.map(|c| c.predicted_over_accuracy).into_iter().collect(),
                ..Bar::default()
            });
        }
    }
    Figure::Bars {
        title: format!("{name}: error of the best combination with each model, relative to the accuracy of the points"),
        over: String::new(),
        height: "predicted rms / accuracy".to_owned(),
        names: vec!["predicted rms".to_owned()],
        bars,
    }
}

/// Errors of the best three combinations over speed.
fn errors(name: &str, ranking: &Ranking) -> Figure {
    let line = |c: &RankedCombination| {
        let error = |(point, loss): (&RankedPoint, f64)| {
            let scale = point.scale?;
            Some((point.speed_rpm, scale * (loss - point.measured_loss_w)))
        };
        Line {
            name: c.models.join(", "),
            points: ranking.points.iter().zip(ranking.losses(c)).map(error).collect(),
            stroke: Stroke::Dots,
        }
    };
    let unit = ranking.unit_in_words;
    Figure::Lines {
        title: format!("{name}: model minus measurement of the best three combinations, in {unit}"),
        x: "speed in rpm".to_owned(),
        y: format!("error in {unit}"),
        lines: ranking.ranking.iter().take(3).map(line).collect(),
    }
}

/// Spread of the combinations that are not distinguishable from the winner, over speed.
fn shortlist(name: &str, ranking: &Ranking) -> Figure {
    let points = &ranking.points;
    let spread = |i: &usize| {
        let point = &points[*i];
        let percent = Some(100.0 * point.deviation_w / point.mean_loss_w).filter(|x| x.is_finite())?;
        Some((point.speed_rpm, percent))
    };
    let line = |([from, to], mut places): ([f64; 2], Vec<usize>)| {
        places.sort_by(|a, b| points[*a].speed.total_cmp(&points[*b].speed));
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
    let torques: Vec<f64> = points.iter().map(|p| p.torque_nm).collect();
    let members = ranking.ranking.iter().filter(|c| c.weight.is_some()).count();
    Figure::Lines {
        title: format!("{name}: spread of the {members} combinations of the shortlist, in % of the loss"),
        x: "speed in rpm".to_owned(),
        y: "weighted standard deviation in % of the loss".to_owned(),
        lines: bands(&torques).into_iter().map(line).collect(),
    }
}
