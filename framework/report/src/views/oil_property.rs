//! Laws of a property of oils against values: ratios by law, oil and temperature, lines over temperature.

use gearloss_studies::analyses::oil_property::{
    CellOfOil, LawOfProperty, OilPropertyOutcome, PropertyOfOils, ValueOfOil,
};
use gearloss_studies::analyses::validation::CellOfRegime;

use super::validation::ratio_text;
use crate::Figure;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, short};

register_view!(OilPropertyOutcome, show);

/// Names of columns with the rows below them.
type Rows = (Vec<String>, Vec<Vec<String>>);

fn show(outcome: &OilPropertyOutcome, page: &mut Page) {
    let (name, found) = (&outcome.head.analysis, &outcome.oil_property);
    let words = found.name.replace('_', " ");
    if let Some(best) = found.laws.first() {
        page.headline = Some(format!(
            "Of {} laws of the {words}, `{}` is closest to the values: {} times them ({} to {}) at {} points",
            found.laws.len(),
            best.name,
            ratio_text(best.all.ratio),
            ratio_text(best.all.least),
            ratio_text(best.all.greatest),
            best.all.points
        ));
        for law in &found.laws {
            let detail = format!("{} to {}", ratio_text(law.all.least), ratio_text(law.all.greatest));
            page.key_figure(
                &format!("calculated over measured, {}", law.name),
                ratio_text(law.all.ratio),
                "-",
                detail,
            );
        }
    }
    page.line(format!(
        "{name}: calculated over measured {words} at {} points of {}",
        found.points, found.file
    ));
    let (head, rows) = cells(found);
    page.table(TextTable::filled(&head, rows));
    for line in &found.left_out {
        page.line(format!("not judged: {line}"));
    }
    page.line("");
    for (head, rows) in parts(found) {
        page.table(TextTable::filled(&head, rows));
        page.line("");
    }
    page.figure(format!("{name}-ratios"), figure(name, found));
}

/// The laws at all values: names of the columns, and a row for each law.
pub fn cells(found: &PropertyOfOils) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let head = vec![
        "law", "points", "ratio", "least", "greatest", "bias %", "rms %", "max %", "in band",
    ];
    let row = |law: &LawOfProperty| {
        vec![
            law.name.clone(),
            law.all.points.to_string(),
            precise(law.all.ratio),
            precise(law.all.least),
            precise(law.all.greatest),
            number(Some(law.all.bias_percent), 1),
            number(Some(law.all.rms_percent), 1),
            number(Some(law.all.max_percent), 1),
            number(law.all.in_band, 2),
        ]
    };
    (head, found.laws.iter().map(row).collect())
}

/// The ratio of each law by temperature and by oil, where there are several.
pub fn parts(found: &PropertyOfOils) -> Vec<Rows> {
    let Some(first) = found.laws.first() else {
        return Vec::new();
    };
    let ends = |regime: &CellOfRegime| {
        let [from, to] = [regime.from, regime.to].map(short);
        if from == to {
            format!("{from} degC")
        } else {
            format!("{from} to {to} degC")
        }
    };
    let head = |what: &str, names: Vec<String>| {
        let first = format!("ratio by {what}");
        std::iter::once(first).chain(names).collect::<Vec<String>>()
    };
    let row = |law: &LawOfProperty, ratios: Vec<f64>| {
        std::iter::once(law.name.clone())
            .chain(ratios.into_iter().map(precise))
            .collect::<Vec<String>>()
    };
    let mut all = Vec::new();
    if first.regimes.len() > 1 {
        let rows = found.laws.iter();
        let rows = rows.map(|law| row(law, law.regimes.iter().map(|regime| regime.cell.ratio).collect()));
        all.push((
            head("oil temperature", first.regimes.iter().map(ends).collect()),
            rows.collect(),
        ));
    }
    if first.oils.len() > 1 {
        let rows = found.laws.iter();
        let rows = rows.map(|law| row(law, law.oils.iter().map(|oil| oil.cell.ratio).collect()));
        let names = first.oils.iter().map(|of: &CellOfOil| of.oil.clone()).collect();
        all.push((head("oil", names), rows.collect()));
    }
    all
}

/// A ratio with three decimals: laws of oils are good to a percent.
fn precise(ratio: f64) -> String {
    if (0.1..10.0).contains(&ratio) {
        number(Some(ratio), 3)
    } else {
        short(ratio)
    }
}

fn figure(name: &str, found: &PropertyOfOils) -> Figure {
    let line = |law: &LawOfProperty| {
        let mut order: Vec<&ValueOfOil> = law.at.iter().collect();
        order.sort_by(|a, b| a.oil_temperature_degc.total_cmp(&b.oil_temperature_degc));
        Line {
            name: law.name.clone(),
            points: order
                .iter()
                .map(|value| Some((value.oil_temperature_degc, value.ratio)))
                .collect(),
            stroke: Stroke::Dots,
        }
    };
    Figure::Lines {
        title: format!("{name}: calculated over measured {}", found.name.replace('_', " ")),
        x: "oil temperature in degC".to_owned(),
        y: "ratio".to_owned(),
        lines: found.laws.iter().map(line).collect(),
    }
}
