//! What a reader gets to see of an outcome: text, sentences that must not be missed, pictures.
//!
//! A view is a function of an outcome. It registers itself with [`register_view!`](crate::register_view); an outcome without one is
//! shown as its tables.

use std::any::{Any, TypeId};

use gearloss_framework::registry::inventory;
use gearloss_studies::analyses::ranges::PublishedCoefficient;
use gearloss_studies::analyses::{AnyOutcome, Outcome};
use gearloss_studies::analysis::Note;
use gearloss_studies::table::Table;

use crate::Figure;
use crate::text::{TextTable, beyond, significant};

/// How an outcome is shown, in the order of reading.
#[derive(Debug, Default)]
pub struct Page {
    /// Text, as on a terminal and in the report.
    pub text: Vec<Text>,
    /// Sentences that a reader must not miss; the report begins with them.
    pub verdicts: Vec<String>,
    /// Pictures.
    pub figures: Vec<NamedFigure>,
}

/// A piece of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Text {
    /// For terminal and report.
    Everywhere(String),
    /// For the report alone.
    InReport(String),
}

/// A picture with the name of its file.
#[derive(Debug)]
pub struct NamedFigure {
    /// Name without extension.
    pub name: String,
    /// The picture.
    pub figure: Figure,
}

impl Page {
    /// Adds a line.
    pub fn line(&mut self, text: impl AsRef<str>) {
        self.text.push(Text::Everywhere(format!("{}\n", text.as_ref())));
    }

    /// Adds lines as they are.
    pub fn lines(&mut self, text: String) {
        self.text.push(Text::Everywhere(text));
    }

    /// Adds a sentence that a reader must not miss.
    pub fn verdict(&mut self, sentence: String) {
        self.line(&sentence);
        self.verdicts.push(sentence);
    }

    /// Adds what was outside its stated range. The terminal shows it once, at the end of a run.
    pub fn outside(&mut self, notes: &[Note]) {
        self.text.push(Text::InReport(outside(notes)));
    }

    /// Adds stated ranges that samples left: path and quantity. The terminal shows them once, at the end of a run.
    pub fn outside_at_samples(&mut self, left: &[(&str, &str)]) {
        for (path, name) in left {
            let text = format!("outside: {path}: {name} leaves its stated range at some samples\n");
            self.text.push(Text::InReport(text));
        }
    }

    /// Adds which of the varied quantities are coefficients of formulas, with the value of the source.
    pub fn published(&mut self, coefficients: &[PublishedCoefficient]) {
        for coefficient in coefficients {
            self.line(format!(
                "`{}`: a coefficient of a formula, published {}; other values are changed from the source",
                coefficient.pattern, coefficient.published
            ));
        }
    }

    /// Adds a picture.
    pub fn figure(&mut self, name: impl Into<String>, figure: Figure) {
        let name = name.into();
        self.figures.push(NamedFigure { name, figure });
    }

    /// The page of an outcome.
    pub fn of(outcome: &dyn AnyOutcome) -> Self {
        let mut page = Self::default();
        page.verdicts.extend(outcome.head().about_data.iter().cloned());
        let own: &dyn Any = outcome.as_any();
        let view = inventory::iter::<View>().find(|view| (view.outcome)() == own.type_id());
        match view {
            Some(view) => (view.show)(own, &mut page),
            None => page.tables(&outcome.tables()),
        }
        page
    }

    /// Adds tables as text, some rows of each.
    pub fn tables(&mut self, tables: &[Table]) {
        for table in tables {
            let head: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
            let mut text = TextTable::new(&head);
            for row in 0..table.len().min(MOST_ROWS) {
                let cells = table.columns.iter().map(|column| match column.numbers() {
                    Some(numbers) if numbers[row].is_nan() => "-".to_owned(),
                    Some(numbers) => significant(numbers[row]),
                    None => column.cell(row).into_owned(),
                });
                text.row(cells.collect());
            }
            self.line(&table.name);
            self.lines(text.render());
            if table.len() > MOST_ROWS {
                self.line(format!("... and {} more rows", table.len() - MOST_ROWS));
            }
            self.line("");
        }
    }
}

/// The most rows of a table that are shown where no view chooses.
const MOST_ROWS: usize = 40;

/// How outcomes of one type are shown.
pub struct View {
    outcome: fn() -> TypeId,
    show: fn(&dyn Any, &mut Page),
}

inventory::collect!(View);

impl View {
    /// The view of an outcome; use [`register_view!`](crate::register_view).
    pub const fn new<O: Outcome>(show: fn(&dyn Any, &mut Page)) -> Self {
        Self {
            outcome: TypeId::of::<O>,
            show,
        }
    }
}

/// Registers how outcomes of a type are shown: `register_view!(BalanceOutcome, show);` with `fn show(&BalanceOutcome, &mut Page)`.
#[macro_export]
macro_rules! register_view {
    ($O:ty, $show:path) => {
        gearloss_framework::registry::inventory::submit! {
            $crate::page::View::new::<$O>(|outcome, page| {
                if let Some(outcome) = outcome.downcast_ref::<$O>() {
                    $show(outcome, page);
                }
            })
        }
    };
}

/// What was outside of its stated range, one line for all components that left the same range.
pub fn outside(notes: &[Note]) -> String {
    let mut groups: Vec<(&Note, Vec<&Note>)> = Vec::new();
    for note in notes.iter().filter(|n| n.outside > 0) {
        let same = |(first, _): &&mut (&Note, Vec<&Note>)| first.name == note.name && first.range == note.range;
        match groups.iter_mut().find(same) {
            Some((_, group)) => group.push(note),
            None => groups.push((note, vec![note])),
        }
    }
    let mut text = String::new();
    for (note, group) in groups {
        let Some(stated) = note.range else {
            continue;
        };
        let unit = if note.unit == "-" {
            String::new()
        } else {
            format!(" {}", note.unit)
        };
        let seen = |f: fn(f64, f64) -> f64, of: fn(&Note) -> f64| group.iter().map(|n| of(n)).reduce(f).unwrap_or(0.0);
        let paths: Vec<&str> = group.iter().map(|n| n.path.as_str()).collect();
        let outside: u32 = group.iter().map(|n| n.outside).sum();
        let points: u32 = group.iter().map(|n| n.points).sum();
        let range = beyond(stated.least, stated.greatest);
        text.push_str(&format!(
            "outside: {}: {} {} to {}{unit} is {range} at {outside} of {points} points ({})\n",
            paths.join(", "),
            note.name,
            significant(seen(f64::min, |n| n.least)),
            significant(seen(f64::max, |n| n.greatest)),
            stated.origin,
        ));
    }
    text
}
