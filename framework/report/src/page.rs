//! The presentation of an outcome: text, verdicts, figures.
//!
//! A view is a function of an outcome. It registers itself with [`register_view!`](crate::register_view). For an outcome without a view the
//! page shows its tables.

use std::any::{Any, TypeId};

use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::inventory;
use gearloss_studies::analyses::Outcome;
use gearloss_studies::analyses::ranges::PublishedCoefficient;
use gearloss_studies::points::Note;
use gearloss_studies::table::Table;

use crate::Figure;
use crate::stated_ranges::StatedRanges;
use crate::text::{TextTable, significant};

/// The presentation of an outcome, in reading order.
#[derive(Debug, Default)]
pub struct Page {
    /// Text for terminal and report.
    pub text: Vec<Text>,
    /// Main conclusions; the report begins with them.
    pub verdicts: Vec<String>,
    /// Pictures.
    pub figures: Vec<NamedFigure>,
    /// Files for other programs.
    pub files: Vec<NamedFile>,
    /// Reasons for missing files for other programs.
    pub faults: Vec<Diagnostic>,
}

/// A file for another program.
#[derive(Debug)]
pub struct NamedFile {
    /// Its name.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// A piece of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Text {
    /// For terminal and report.
    Everywhere(String),
    /// For the report alone.
    InReport(String),
}

/// A figure with the name of its file.
#[derive(Debug)]
pub struct NamedFigure {
    /// Name without extension.
    pub name: String,
    /// The figure.
    pub figure: Figure,
}

impl Page {
    /// Adds a line.
    pub fn line(&mut self, text: impl AsRef<str>) {
        self.text.push(Text::Everywhere(format!("{}\n", text.as_ref())));
    }

    /// Adds lines unchanged.
    pub fn lines(&mut self, text: String) {
        self.text.push(Text::Everywhere(text));
    }

    /// Adds a main conclusion, which is also shown at the top of the report.
    pub fn verdict(&mut self, sentence: String) {
        self.line(&sentence);
        self.verdicts.push(sentence);
    }

    /// Adds quantities outside their stated ranges. The terminal shows them once, at the end of a run.
    pub fn outside(&mut self, notes: &[Note]) {
        self.text.push(Text::InReport(outside(notes)));
    }

    /// Adds quantities (path, name) that are outside their stated ranges in some samples. The terminal shows them once, at the end of a
    /// run.
    pub fn outside_at_samples(&mut self, left: &[&(String, String)]) {
        for (path, name) in left {
            let text = format!("outside: {path}: {name} is outside its validity range in some samples\n");
            self.text.push(Text::InReport(text));
        }
    }

    /// Adds the published values of varied quantities that are coefficients of formulas.
    pub fn published(&mut self, coefficients: &[PublishedCoefficient]) {
        for coefficient in coefficients {
            self.line(format!(
                "`{}`: a coefficient of a formula, published value {}; other values differ from the source",
                coefficient.pattern, coefficient.published
            ));
        }
    }

    /// Adds a figure.
    pub fn figure(&mut self, name: impl Into<String>, figure: Figure) {
        let name = name.into();
        self.figures.push(NamedFigure { name, figure });
    }

    /// Adds a file for another program.
    pub fn file(&mut self, name: impl Into<String>, bytes: Vec<u8>) {
        let name = name.into();
        self.files.push(NamedFile { name, bytes });
    }

    /// Adds the reason why a file for another program is missing.
    pub fn fault(&mut self, why: Diagnostic) {
        self.faults.push(why);
    }

    /// The page of an outcome.
    pub fn from_outcome(outcome: &dyn Outcome) -> Self {
        let mut page = Self::default();
        page.verdicts.extend(outcome.head().about_data.iter().cloned());
        let own: &dyn Any = outcome;
        let view = inventory::iter::<View>().find(|view| (view.outcome)() == own.type_id());
        match view {
            Some(view) => (view.show)(own, &mut page),
            None => page.tables(&outcome.tables()),
        }
        page
    }

    /// Adds tables as text with a limited number of rows.
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

/// Maximum number of rows of a table without a view.
const MOST_ROWS: usize = 40;

/// The view of outcomes of one type.
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

/// Registers the view of a type of outcome: `register_view!(BalanceOutcome, show);` with `fn show(&BalanceOutcome, &mut Page)`.
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

/// Quantities outside their stated ranges, one line for all components with the same range.
pub fn outside(notes: &[Note]) -> String {
    let lines = StatedRanges::from_notes(notes).lines();
    lines.into_iter().map(|line| line + "\n").collect()
}
