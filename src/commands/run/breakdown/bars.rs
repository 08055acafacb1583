//! Rows of stacked bars: printed, drawn, and kept as rows and JSON.

use gearloss_report::Figure;
use gearloss_report::plot::Bar;
use gearloss_studies::analysis::{Note, PointResult};
use gearloss_studies::study::{As, By, Write};
use serde_json::{Value, json};

use super::super::super::solve::RPM;
use super::super::write::{cell, picture};
use super::super::{Built, Runner};
use crate::output::{Failure, Out, Table, number};
use gearloss_report::text::spread;
use gearloss_studies::analyses::numbers::tidy;
use gearloss_studies::analyses::shares::{Shares, together};

/// What is stacked, in which unit, and what is written of it.
pub struct Kind<'a> {
    name: &'a str,
    by: By,
    unit: As,
    formats: &'a [Write],
}

impl<'a> Kind<'a> {
    pub fn new(name: &'a str, by: By, unit: As, formats: &'a [Write]) -> Self {
        Self {
            name,
            by,
            unit,
            formats,
        }
    }
}

/// Bars side by side.
pub struct Row<'a> {
    /// What they stand over, with its unit.
    pub over: &'a str,
    /// What all of them have in common.
    pub title: String,
    /// Label, measured loss with its accuracy in W, and the point.
    pub bars: Vec<(String, Option<(f64, f64)>, PointResult)>,
}

/// Everything that an analysis has shown so far.
pub struct Bars<'a> {
    kind: Kind<'a>,
    names: Vec<String>,
    /// Rows of the table.
    pub rows: Vec<Vec<String>>,
    /// JSON of what is closed.
    pub results: Vec<Value>,
    points: Vec<Value>,
}

impl<'a> Bars<'a> {
    pub fn new(kind: Kind<'a>, built: &[Built<'_>]) -> Self {
        Self {
            names: together(built.iter().map(|b| &b.transmission), kind.by),
            kind,
            rows: Vec::new(),
            results: Vec::new(),
            points: Vec::new(),
        }
    }

    /// True where points have to keep their terms.
    pub fn needs_terms(&self) -> bool {
        self.kind.by == By::Term
    }

    pub fn formats(&self) -> &[Write] {
        self.kind.formats
    }

    fn unit(&self) -> (&'static str, &'static str) {
        match self.kind.unit {
            As::Watts => ("w", "W"),
            As::Percent => ("percent", "%"),
        }
    }

    pub fn header(&self) -> Vec<String> {
        let loss = format!("loss_{}", self.unit().0);
        [
            "model_set",
            "gear",
            "torque_nm",
            "speed_rpm",
            "oil_temperature_degc",
            "share",
            &loss,
        ]
        .map(str::to_owned)
        .to_vec()
    }

    /// Prints, draws and keeps one row of bars.
    pub fn show(
        &mut self,
        runner: &Runner<'_>,
        b: &Built<'_>,
        gear: &str,
        row: &Row<'_>,
        out: &mut Out,
    ) -> Result<(), Failure> {
        let name = self.kind.name;
        let (_, label) = self.unit();
        let shares = Shares::of(&b.transmission, self.kind.by).under(&self.names);
        // Watts per unit of the picture.
        let scale = |p: &PointResult| match self.kind.unit {
            As::Watts => Some(1.0),
            As::Percent => p.loss.filter(|loss| *loss != 0.0).map(|loss| 100.0 / loss),
        };
        let stacks: Vec<Option<Vec<f64>>> = row
            .bars
            .iter()
            .map(|(_, _, p)| {
                let scale = scale(p)?;
                Some(shares.stack(p)?.into_iter().map(|w| w * scale).collect())
            })
            .collect();
        let measured: Vec<Option<(f64, f64)>> = row
            .bars
            .iter()
            .map(|(_, seen, p)| seen.and_then(|(loss, accuracy)| Some((loss * scale(p)?, accuracy * scale(p)?))))
            .collect();
        for (((_, _, p), stack), seen) in row.bars.iter().zip(&stacks).zip(&measured) {
            let head = [
                b.name.clone(),
                gear.to_owned(),
                cell(Some(p.torque)),
                cell(Some(tidy(p.speed * RPM))),
                cell(p.oil),
            ];
            let line = |share: &str, value: Option<f64>| {
                let mut line = head.to_vec();
                line.extend([share.to_owned(), cell(value)]);
                line
            };
            for (i, share) in self.names.iter().enumerate() {
                self.rows.push(line(share, stack.as_ref().map(|s| s[i])));
            }
            if let Some((loss, _)) = seen {
                self.rows.push(line("measured", Some(*loss)));
            }
            let mut point = json!({
                "torque_nm": p.torque, "speed_rpm": tidy(p.speed * RPM), "oil_temperature_degc": p.oil,
            });
            let unit = self.unit().0;
            point[format!("losses_{unit}")] = json!(stack);
            point[format!("measured_loss_{unit}")] = json!(seen.map(|s| s.0));
            self.points.push(point);
        }
        // What loses nothing at any bar needs no colour.
        let lost = |k: &usize| stacks.iter().flatten().any(|s| s[*k] != 0.0);
        let shown: Vec<usize> = (0..self.names.len()).filter(lost).collect();
        let bars = row.bars.iter().zip(&stacks).zip(&measured);
        let figure = Figure::Bars {
            title: format!("{name}: loss, gear {gear}, {}, models {}", row.title, b.name),
            over: row.over.to_owned(),
            height: format!("loss in {label}"),
            names: shown.iter().map(|k| self.names[*k].clone()).collect(),
            bars: bars
                .map(|(((label, _, _), stack), measured)| Bar {
                    label: label.clone(),
                    shares: stack.iter().flat_map(|s| shown.iter().map(|k| s[*k])).collect(),
                    measured: *measured,
                    ..Bar::default()
                })
                .collect(),
        };
        let title = row.title.replace([' ', ',', '`'], "");
        let file = format!("{name}-{}-{gear}-{title}", b.name);
        picture(runner, &file, figure, self.kind.formats)?;
        out.line(format!(
            "{name}: loss in {label}, gear {gear}, {}, models {}",
            row.title, b.name
        ))?;
        let shown = spread(row.bars.len());
        let mut titles = vec![row.over.to_owned()];
        titles.extend(shown.iter().map(|i| row.bars[*i].0.clone()));
        let mut table = Table::new(&titles.iter().map(String::as_str).collect::<Vec<_>>());
        let mut line = |title: &str, value: &dyn Fn(usize) -> Option<f64>| {
            let mut cells = vec![title.to_owned()];
            cells.extend(shown.iter().map(|i| number(value(*i), 2)));
            table.row(cells);
        };
        for (k, share) in self.names.iter().enumerate() {
            line(share, &|i| Some(stacks[i].as_ref()?[k]));
        }
        line("sum", &|i| Some(stacks[i].as_ref()?.iter().sum()));
        if measured.iter().any(Option::is_some) {
            line("measured", &|i| measured[i].map(|m| m.0));
        }
        out.text(&table.render())?;
        out.line("")?;
        Ok(())
    }

    /// Closes what belongs to one set in one gear state.
    pub fn close(&mut self, b: &Built<'_>, gear: &str, notes: &[Note]) {
        self.results.push(json!({
            "model_set": b.name,
            "gear": gear,
            "unit": self.unit().0,
            "shares": self.names,
            "notes": notes,
            "points": std::mem::take(&mut self.points),
        }));
    }
}
