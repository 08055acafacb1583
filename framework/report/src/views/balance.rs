//! A heat balance: its result; losses and heat over temperature; temperature and residual over the steps.

mod summary;

use gearloss_framework::thermal::Outcome;
use gearloss_studies::analyses::balance::{BalanceOfPoint, BalanceOutcome, BalanceStep};

use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::significant;
use crate::unit;

register_view!(BalanceOutcome, show);

fn show(outcome: &BalanceOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for of_set in &outcome.balances {
        page.line(format!("{name}: models {}", of_set.model_set));
        page.lines(balance_text(&of_set.balance, false));
        page.lines(unit::line(of_set.unit.as_ref()));
        page.line("");
        figures(&format!("{name}-{}", of_set.model_set), &of_set.balance, page);
    }
}

/// A heat balance as text; `above` if the losses of its point are printed above.
pub fn balance_text(balance: &BalanceOfPoint, above: bool) -> String {
    let mut text = format!("balance: {}", balance.outcome.name());
    if let (Some(oil), Some(surface)) = (balance.oil_temperature_degc, balance.surface_temperature_degc) {
        text.push_str(&format!(
            ", oil {oil:.2} °C, surface {surface:.2} °C, surroundings {} °C",
            significant(balance.ambient_degc)
        ));
    }
    text.push('\n');
    for path in &balance.ways {
        text.push_str(&format!("  {} transfers {:.3} W\n", path.path, path.heat_w));
    }
    if balance.sources_w.oil + balance.sources_w.surface > 0.0 {
        text.push_str(&format!(
            "  heat sources add {} W to the oil and {} W to the surface\n",
            significant(balance.sources_w.oil),
            significant(balance.sources_w.surface)
        ));
    }
    for root in &balance.stable {
        if let Some(beyond) = root.residual_beyond_jump_w {
            text.push_str(&format!(
                "  discontinuity at {:.4} °C: residual {:.4} W below and {:.4} W above\n",
                root.oil_temperature_degc, root.residual_w, beyond
            ));
        }
    }
    match balance.outcome {
        Outcome::Several => {
            let all: Vec<String> = balance
                .stable
                .iter()
                .map(|r| format!("{:.2}", r.oil_temperature_degc))
                .collect();
            text.push_str(&format!(
                "  several stable temperatures: {} °C; the lowest is used\n",
                all.join(", ")
            ));
        }
        Outcome::NoneBelowMaximum => {
            text.push_str(&format!(
                "  losses exceed the transferred heat up to {} °C",
                significant(balance.maximum_degc)
            ));
            text.push_str(if above {
                "; the losses above are at this temperature\n"
            } else {
                "\n"
            });
        }
        Outcome::Undefined if above => {
            text.push_str(&format!(
                "  the losses above are at {} °C\n",
                significant(balance.maximum_degc)
            ));
        }
        Outcome::Converged | Outcome::AtDiscontinuity | Outcome::Undefined | Outcome::NoConvergence => {}
    }
    if let Some(undefined) = &balance.undefined {
        text.push_str(&format!(
            "  no value at {:.2} °C: {}\n",
            undefined.oil_temperature_degc, undefined.reason
        ));
    }
    text
}

/// Losses and heat over temperature; temperature and residual over the steps of the search.
fn figures(name: &str, balance: &BalanceOfPoint, page: &mut Page) {
    let title = format!("{name}: losses and transferred heat");
    page.figure(name, over_temperature(&title, balance));
    let steps = &balance.history[balance.scan..];
    let line = |name: &str, y: &dyn Fn(&BalanceStep) -> Option<f64>| Line {
        name: name.to_owned(),
        points: steps
            .iter()
            .enumerate()
            .map(|(i, s)| Some((i as f64 + 1.0, y(s)?)))
            .collect(),
        stroke: Stroke::Marked,
    };
    let temperature = [line("oil temperature", &|s| Some(s.oil_temperature_degc))];
    let title = format!("{name}: temperature over the steps of the search");
    page.figure(
        format!("{name}-steps"),
        figure(title, "step", "degC", temperature.to_vec()),
    );
    // A residual of zero has no logarithm and ends the line.
    let residual = [line("residual", &|s| {
        let share = (s.residual_w / s.loss_w).abs();
        (share > 0.0 && share.is_finite()).then(|| share.log10())
    })];
    let title = format!("{name}: residual over the steps of the search");
    let figure = figure(title, "step", "log10 of residual / loss", residual.to_vec());
    page.figure(format!("{name}-residual"), figure);
}

/// Losses and transferred heat over the oil temperature.
pub fn over_temperature(title: &str, balance: &BalanceOfPoint) -> Figure {
    let mut sorted: Vec<&BalanceStep> = balance.history.iter().collect();
    sorted.sort_by(|a, b| a.oil_temperature_degc.total_cmp(&b.oil_temperature_degc));
    let line = |name: &str, y: fn(&BalanceStep) -> f64| Line {
        name: name.to_owned(),
        points: sorted.iter().map(|s| Some((s.oil_temperature_degc, y(s)))).collect(),
        stroke: Stroke::Marked,
    };
    let curves = vec![line("loss", |s| s.loss_w), line("heat", |s| s.heat_w)];
    figure(title.to_owned(), "oil temperature in degC", "W", curves)
}

fn figure(title: String, x: &str, y: &str, lines: Vec<Line>) -> Figure {
    Figure::Lines {
        title,
        x: x.to_owned(),
        y: y.to_owned(),
        lines,
    }
}
