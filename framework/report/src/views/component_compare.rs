//! Models of one component: tables of losses over speed by torque and term; figures of losses over speed with measured points.

mod summary;

use gearloss_studies::analyses::common::measurable::note;
use gearloss_studies::analyses::component_compare::{
    ComponentCompareOutcome, ComponentComparison, LossOfComponent, MeasuredLoss, ModelOfComponent,
};
use gearloss_studies::numbers::RPM;

use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, fixed, number, spread};

register_view!(ComponentCompareOutcome, show);

fn show(outcome: &ComponentCompareOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    let comparison = &outcome.component_comparison;
    for (i, torque) in comparison.torques.iter().enumerate() {
        page.line(format!("{name}: loss in W of {}, {torque} Nm", comparison.component));
        page.table(losses(comparison, i));
        page.line("");
        page.figure(format!("{name}-{torque}Nm"), figure(name, comparison, (i, *torque)));
    }
    for deviation in &comparison.deviations {
        page.line(format!(
            "{}: model minus measurement: mean {} %, rms {} %, {} points",
            deviation.model,
            number(Some(deviation.mean_percent), 1),
            number(Some(deviation.rms_percent), 1),
            deviation.count
        ));
    }
    if comparison.omitted > 0 {
        page.line(note(comparison.omitted, "the model minus measurement"));
    }
    page.line("");
}

/// Losses at one torque over speed by model and term.
fn losses(comparison: &ComponentComparison, torque: usize) -> TextTable {
    let speeds = &comparison.speeds;
    let shown = spread(speeds.len());
    let mut titles = vec!["model".to_owned(), "term".to_owned()];
    titles.extend(shown.iter().map(|i| format!("{} rpm", fixed(speeds[*i] * RPM, 0))));
    let mut table = TextTable::new(&titles);
    for model in &comparison.models {
        let mut row = |first: &str, term: &str, watts: &dyn Fn(&LossOfComponent) -> Option<f64>| {
            let mut row = vec![first.to_owned(), term.to_owned()];
            let point = |i: &usize| &model.points[torque * speeds.len() + i];
            row.extend(shown.iter().map(|i| number(watts(point(i)), 3)));
            table.row(row);
        };
        row(&model.model, "total", &|point| point.loss_w);
        for (i, term) in model.terms.iter().enumerate().filter(|_| model.terms.len() > 1) {
            row("", term, &|point| point.terms_w.0[i].1);
        }
    }
    table
}

/// Loss over speed at one torque with measured points.
fn figure(name: &str, comparison: &ComponentComparison, (i, torque): (usize, f64)) -> Figure {
    let speeds = &comparison.speeds;
    let line = |model: &ModelOfComponent| {
        let point = |(k, speed): (usize, &f64)| Some((speed * RPM, model.points[i * speeds.len() + k].loss_w?));
        Line {
            name: model.model.clone(),
            points: speeds.iter().enumerate().map(point).collect(),
            stroke: Stroke::Marked,
        }
    };
    let mut lines: Vec<Line> = comparison.models.iter().map(line).collect();
    let near = |m: &&MeasuredLoss| (m.torque_nm - torque).abs() <= 0.02 * torque.abs().max(1e-9);
    let measured = comparison.measured.iter().filter(near);
    let points: Vec<_> = measured.map(|m| Some((m.speed * RPM, m.loss_w))).collect();
    if !points.is_empty() {
        lines.push(Line {
            name: "measured".to_owned(),
            points,
            stroke: Stroke::Dots,
        });
    }
    Figure::Lines {
        title: format!("{name}: loss of {}, {torque} Nm", comparison.component),
        x: "speed in rpm".to_owned(),
        y: "loss in W".to_owned(),
        lines,
    }
}
