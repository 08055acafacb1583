//! Figures of identifications: parameters between their bounds, deviations before and after, losses and measured total, means, residuals,
//! correlations, proposed measurements.

use gearloss_numerics::inference::{Accuracy, BandMean, Parameter};
use gearloss_studies::analyses::identify::lines::Sheet;
use gearloss_studies::analyses::identify::{IdentificationOfSet, IdentifyOutcome};
use gearloss_studies::identify::{Identified, Observation};
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::study::Quantity;

use super::{hold_out, means, slug, stacks, words};
use crate::deviations::{self, Deviation, histograms};
use crate::page::Page;
use crate::plot::{Interval, Line, Stroke};
use crate::{Figure, Map};

/// Minimum correlation for a figure of the joint region of two parameters, and the maximum number of pairs.
const JOINT: (f64, usize) = (0.8, 4);
/// Number of points of a drawn border.
const BORDER: u32 = 72;

pub(super) fn draw(outcome: &IdentifyOutcome, o: &IdentificationOfSet, page: &mut Page) {
    let name = outcome.head.analysis.as_str();
    let mut put = |what: &str, figure: Figure| page.figure(format!("{name}-{}-{what}", o.model_set), figure);
    for (what, figure) in hold_out::pictures(name, o) {
        put(&what, figure);
    }
    put("parameters", parameters(name, o));
    for quantity in o.found.quantities() {
        for (what, figure) in maps(name, o, quantity) {
            put(&what, figure);
        }
        let list = |k: usize| o.found.deviations(quantity, k).into_iter().map(|(_, d)| d).collect();
        let lists = vec![("before".to_owned(), list(0)), ("after".to_owned(), list(1))];
        let title = format!("{name}: {} minus measurement", o.model_set);
        let what = format!("histogram-{}", slug(quantity));
        put(&what, histograms(&title, words(quantity), lists));
    }
    for (what, figure) in stacks::pictures(name, outcome.requested.stack_at, o) {
        put(&what, figure);
    }
    if !o.means.is_empty() {
        put("means", means::picture(name, o));
    }
    if !o.points.is_empty() {
        for (what, figure) in residuals(name, o) {
            put(what, figure);
        }
    }
    put("correlations", correlations(name, o));
    for (what, figure) in joint(name, o) {
        put(&what, figure);
    }
    for (what, figure) in next(name, o) {
        put(&what, figure);
    }
}

/// Positions of the parameters between their bounds, in the coordinates of the fit.
fn parameters(name: &str, o: &IdentificationOfSet) -> Figure {
    let inference = &o.found.fitted.inference;
    let all = inference.parameters().iter().zip(&o.found.parameters).enumerate();
    let interval = |(k, (of, identified)): (usize, (&Parameter, &Identified))| {
        let [low, high] = of.bounds;
        let place = |theta: f64| of.scale.coordinate(theta).map(|u| (u - low) / (high - low));
        let profiled = o.found.profiles[k]
            .as_ref()
            .and_then(|p| p.as_ref().ok())
            .map(|p| p.theta);
        let ends = profiled.or_else(|| inference.interval(k, 0.95, 1.0).map(|i| i.ends));
        Interval {
            name: of.name.clone(),
            at: (of.u - low) / (high - low),
            ends: ends.and_then(|[a, b]| Some([place(a)?, place(b)?])),
            before: identified.stated.and_then(place).filter(|x| (-0.2..=1.2).contains(x)),
        }
    };
    Figure::Intervals {
        title: format!("{name}: parameters of {} between their bounds", o.model_set),
        x: "0: lower bound, 1: upper bound (logarithmic parameters by their logarithm)".to_owned(),
        marks: vec![0.0, 1.0],
        key: ["found", "stated", "bounds"].map(str::to_owned),
        list: all.map(interval).filter(|i| i.at.is_finite()).collect(),
    }
}

/// Deviations over speed and torque before and after the fit: two maps with the same colours for each sheet.
fn maps(name: &str, o: &IdentificationOfSet, quantity: Quantity) -> Vec<(String, Figure)> {
    let (what, unit) = words(quantity);
    let measured = &o.found.measured;
    let mut figures = Vec::new();
    for (number, sheet) in o.found.sheets.iter().enumerate() {
        let lists = [0, 1].map(|which| -> Vec<Deviation> {
            let deviations = o
                .found
                .deviations(quantity, which)
                .into_iter()
                .filter(|(row, _)| sheet.rows.contains(row));
            deviations
                .map(|(row, d)| {
                    let value = |name: &str| measured.value(&measured.rows[row], name).unwrap_or(0.0);
                    (value("torque"), value("speed") * RPM, Some(d))
                })
                .collect()
        });
        let most = lists
            .iter()
            .flatten()
            .filter_map(|p| p.2)
            .fold(0.0_f64, |most, d| most.max(d.abs()));
        if most == 0.0 {
            continue;
        }
        let unseen = accuracy(o, quantity, sheet);
        for (k, list) in lists.iter().enumerate() {
            let when = ["before", "after"][k];
            let title = titled(
                format!("{name}: {what} of {} minus measurement in {unit}, {when}", o.model_set),
                sheet,
            );
            let figure = deviations::picture(title, (what, unit), list, unseen, Some((-most, most)));
            figures.push((numbered(&format!("{}-{when}", slug(quantity)), o, number), figure));
        }
    }
    figures
}

pub(super) fn titled(title: String, sheet: &Sheet) -> String {
    if sheet.name.is_empty() {
        title
    } else {
        format!("{title} ({})", sheet.name)
    }
}

pub(super) fn numbered(what: &str, o: &IdentificationOfSet, number: usize) -> String {
    if o.found.sheets.len() == 1 {
        what.to_owned()
    } else {
        format!("{what}-{}", number + 1)
    }
}

/// Root mean square accuracy of the measurement over a sheet, in the unit of the deviations.
fn accuracy(o: &IdentificationOfSet, quantity: Quantity, sheet: &Sheet) -> Option<f64> {
    if o.found.fitted.inference.accuracy() == Accuracy::Estimated {
        return None;
    }
    let unit = if quantity == Quantity::Efficiency { 100.0 } else { 1.0 };
    let observed = o.found.observations.iter();
    let observed = observed.filter(|x| x.quantity == quantity && sheet.rows.contains(&x.row));
    let list: Vec<f64> = observed.map(|x| unit * x.deviation).collect();
    (!list.is_empty()).then(|| (list.iter().map(|a| a * a).sum::<f64>() / list.len() as f64).sqrt())
}

/// Standardised residuals over torque and over speed, with the means of bands.
fn residuals(name: &str, o: &IdentificationOfSet) -> Vec<(&'static str, Figure)> {
    let measured = &o.found.measured;
    let figure = |what: &str, unit: &str, factor: f64, means: &[BandMean]| {
        let at = |(observation, r): (&Observation, &f64)| {
            let value = measured.value(&measured.rows[observation.row], what)?;
            Some((factor * value, *r))
        };
        let all = o.found.observations.iter().zip(&o.found.checks.standardised);
        let mean = means.iter().map(|b| Some((0.5 * (b.band[0] + b.band[1]), b.mean)));
        Figure::Lines {
            title: format!("{name}: residuals of {} over {what}", o.model_set),
            x: format!("{what} in {unit}"),
            y: "residual, standard deviations".to_owned(),
            lines: vec![
                Line {
                    name: "points".to_owned(),
                    points: all.map(at).collect(),
                    stroke: Stroke::Dots,
                },
                Line {
                    name: "mean".to_owned(),
                    points: mean.collect(),
                    stroke: Stroke::Marked,
                },
            ],
        }
    };
    vec![
        (
            "residuals-torque",
            figure("torque", "Nm", 1.0, &o.found.checks.over_torque),
        ),
        (
            "residuals-speed",
            figure("speed", "rpm", RPM, &o.found.checks.over_speed),
        ),
    ]
}

fn correlations(name: &str, o: &IdentificationOfSet) -> Figure {
    let inference = &o.found.fitted.inference;
    let names: Vec<String> = inference.parameters().iter().map(|p| p.name.clone()).collect();
    let count = names.len();
    let values = (0..count * count).map(|i| inference.correlation(i / count, i % count));
    Figure::Map(Map {
        title: format!("{name}: correlations of the parameters of {}", o.model_set),
        x: ("parameter".to_owned(), names.clone()),
        y: ("parameter".to_owned(), names),
        values: values.collect(),
        diverging: true,
        ends: Some((-1.0, 1.0)),
        ..Map::default()
    })
}

/// Joint 95 % regions of strongly correlated pairs.
fn joint(name: &str, o: &IdentificationOfSet) -> Vec<(String, Figure)> {
    let inference = &o.found.fitted.inference;
    let count = inference.parameters().len();
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    for j in 0..count {
        for k in j + 1..count {
            pairs.extend(
                inference
                    .correlation(j, k)
                    .filter(|c| c.abs() >= JOINT.0)
                    .map(|c| (j, k, c)),
            );
        }
    }
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    let figure = |(j, k, correlation): &(usize, usize, f64)| {
        let (one, other) = (&inference.parameters()[*j], &inference.parameters()[*k]);
        let (a, b) = (inference.deviation(*j)?, inference.deviation(*k)?);
        // Chi-square of two degrees of freedom.
        let radius = (-2.0 * 0.05_f64.ln()).sqrt();
        let border = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(BORDER);
            let (x, y) = (angle.cos(), angle.sin());
            let along = correlation * x + (1.0 - correlation * correlation).max(0.0).sqrt() * y;
            let inside = |p: &Parameter, u: f64| p.scale.theta(u.clamp(p.bounds[0], p.bounds[1]));
            Some((
                inside(one, one.u + radius * a * x),
                inside(other, other.u + radius * b * along),
            ))
        };
        let units = [*j, *k].map(|k| o.found.parameters[k].unit.symbol);
        let named = |name: &str, unit: &str| {
            if unit == "-" {
                name.to_owned()
            } else {
                format!("{name} {unit}")
            }
        };
        let line = |name: &str, points: Vec<Option<(f64, f64)>>, stroke: Stroke| Line {
            name: name.to_owned(),
            points,
            stroke,
        };
        Some(Figure::Lines {
            title: format!(
                "{name}: joint region of {} and {} of {}, correlation {correlation:.2}",
                one.name, other.name, o.model_set
            ),
            x: named(&one.name, units[0]),
            y: named(&other.name, units[1]),
            lines: vec![
                line("joint 95 % region", (0..=BORDER).map(border).collect(), Stroke::Line),
                line("found", vec![Some((one.theta(), other.theta()))], Stroke::Dots),
            ],
        })
    };
    let shown = pairs.iter().take(JOINT.1).filter_map(figure).enumerate();
    shown.map(|(i, figure)| (format!("joint-{}", i + 1), figure)).collect()
}

/// The information of one more point over speed and torque, with the points of the plan.
fn next(name: &str, o: &IdentificationOfSet) -> Vec<(String, Figure)> {
    let Some(Ok(next)) = &o.found.next else {
        return Vec::new();
    };
    let (torques, speeds) = &next.axes;
    let size = torques.len() * speeds.len();
    let figure = |(i, oil): (usize, &Option<f64>)| {
        let at = oil.map_or_else(String::new, |oil| format!(" at {oil:.0} degC"));
        let chosen = next.plan.plan.choices.iter().filter(|c| c.candidate / size == i);
        let marks = chosen.map(|c| {
            let at = &next.candidates[c.candidate];
            (tidy(at.speed * RPM), at.torque)
        });
        let label = |x: f64| format!("{}", tidy(x));
        let map = Map {
            title: format!("{name}: information of one more point on {}{at}", o.model_set),
            x: ("speed rpm".to_owned(), speeds.iter().map(|w| label(w * RPM)).collect()),
            y: ("torque Nm".to_owned(), torques.iter().map(|t| label(*t)).collect()),
            values: next.plan.gains[i * size..(i + 1) * size]
                .iter()
                .map(|g| Some(*g))
                .collect(),
            marks: marks.collect(),
            marked: "proposed".to_owned(),
            ..Map::default()
        };
        let what = if next.oils.len() == 1 {
            "next".to_owned()
        } else {
            format!("next-{}", i + 1)
        };
        (what, Figure::Map(map))
    };
    next.oils.iter().enumerate().map(figure).collect()
}
