//! The presentation of an outcome: text, verdicts, figures.
//!
//! A view is a function of an outcome. It registers itself with [`register_view!`](crate::register_view). For an outcome without a view the
//! page shows its tables.

use std::any::{Any, TypeId};

use gearloss_framework::document::Diagnostic;
use gearloss_framework::registry::inventory;
use gearloss_studies::analyses::Outcome;
use gearloss_studies::analyses::common::ranges::PublishedCoefficient;
use gearloss_studies::correction::UsedCorrection;
use gearloss_studies::points::Note;
use gearloss_studies::table::Table;
use serde::Serialize;

use crate::Figure;
use crate::picture::{Picture, Screen};
use crate::stated_ranges::StatedRanges;
use crate::text::{TextTable, printed_unit, significant};
use crate::{limits, model_error};

/// The presentation of an outcome, in reading order.
#[derive(Debug, Default)]
pub struct Page {
    /// The result in one sentence with its numbers.
    pub headline: Option<String>,
    /// The numbers that a reader remembers, three to five.
    pub key_figures: Vec<KeyFigure>,
    /// Limits of the study that are not kept, as sentences.
    pub limits: Vec<String>,
    /// Which limits are kept, as the end of the headline; may be empty.
    pub limits_verdict: String,
    /// What else a reader has to be careful about, the worst first.
    pub careful: Vec<String>,
    /// Text and tables, for the details of the report and for `--verbose`.
    pub blocks: Vec<Block>,
    /// Quantities outside their stated ranges, a line for each.
    pub outside: Vec<String>,
    /// Main conclusions; the section of the report begins with them.
    pub verdicts: Vec<String>,
    /// Figures as files, if they are requested.
    pub figures: Vec<NamedFigure>,
    /// Pictures of the report; the first one shows the result best.
    pub pictures: Vec<Picture>,
    /// Files for other programs.
    pub files: Vec<NamedFile>,
    /// Reasons for missing files for other programs.
    pub faults: Vec<Diagnostic>,
}

/// A number with its name.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct KeyFigure {
    /// What it is.
    pub label: String,
    /// The number, with sensible digits.
    pub value: String,
    /// Its unit.
    pub unit: String,
    /// Where, between which limits, or compared with what; may be empty.
    pub detail: String,
}

/// A file for another program.
#[derive(Debug)]
pub struct NamedFile {
    /// Its name.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// A piece of the details of an outcome.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// Lines of text.
    Text(String),
    /// A table.
    Table(TextTable),
}

/// Text and tables in their order.
#[derive(Debug, Default)]
pub struct Blocks(Vec<Block>);

impl Blocks {
    /// Adds text behind what there is.
    pub fn text(&mut self, text: &str) {
        match self.0.last_mut() {
            Some(Block::Text(last)) => last.push_str(text),
            _ if text.is_empty() => {}
            _ => self.0.push(Block::Text(text.to_owned())),
        }
    }

    /// Adds a table.
    pub fn table(&mut self, table: TextTable) {
        self.0.push(Block::Table(table));
    }

    /// Adds other blocks behind these.
    pub fn append(&mut self, other: Self) {
        for block in other.0 {
            match block {
                Block::Text(text) => self.text(&text),
                Block::Table(table) => self.table(table),
            }
        }
    }

    /// All of them as text.
    pub fn render(&self) -> String {
        let parts = self.0.iter().map(|block| match block {
            Block::Text(text) => text.clone(),
            Block::Table(table) => table.render(),
        });
        parts.collect()
    }

    /// All of them in their order.
    pub fn into_vec(self) -> Vec<Block> {
        self.0
    }
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
        self.blocks.push(Block::Text(format!("{}\n", text.as_ref())));
    }

    /// Adds lines unchanged.
    pub fn lines(&mut self, text: String) {
        self.blocks.push(Block::Text(text));
    }

    /// Adds a table.
    pub fn table(&mut self, table: TextTable) {
        self.blocks.push(Block::Table(table));
    }

    /// Adds a key figure: its name, value, unit and detail.
    pub fn key_figure(&mut self, label: &str, value: impl Into<String>, unit: &str, detail: impl Into<String>) {
        self.key_figures.push(KeyFigure {
            label: label.to_owned(),
            value: value.into(),
            // The unit of a ratio is not printed.
            unit: if unit == "-" {
                String::new()
            } else {
                printed_unit(unit).to_owned()
            },
            detail: detail.into(),
        });
    }

    /// Adds a main conclusion, which is also shown at the top of its section.
    pub fn verdict(&mut self, sentence: String) {
        self.line(&sentence);
        self.verdicts.push(sentence);
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

    /// Adds a figure to the report and to the files.
    pub fn figure(&mut self, name: impl Into<String>, figure: Figure) {
        self.pictures.push(Picture::Figure(figure.clone()));
        self.file_figure(name, figure);
    }

    /// Adds a figure to the files alone, because a picture of the report shows the same.
    pub fn file_figure(&mut self, name: impl Into<String>, figure: Figure) {
        let name = name.into();
        self.figures.push(NamedFigure { name, figure });
    }

    /// Adds a figure to the report alone.
    pub fn report_figure(&mut self, figure: Figure) {
        self.pictures.push(Picture::Figure(figure));
    }

    /// Adds a picture for the screen.
    pub fn screen(&mut self, picture: Screen) {
        self.pictures.push(Picture::Screen(picture));
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
        let any: &dyn Any = outcome;
        let view = inventory::iter::<View>().find(|view| (view.outcome)() == any.type_id());
        match view {
            Some(view) => (view.show)(any, &mut page),
            None => page.tables(&outcome.tables()),
        }
        limits::add(&outcome.head().study_limits, &mut page);
        model_error::add(&outcome.head().model_error, &mut page);
        let corrections = outcome.head().corrections.iter();
        page.careful.extend(corrections.map(UsedCorrection::sentence));
        let mut ranges = StatedRanges::default();
        ranges.add_outcome(&outcome.head().analysis, outcome);
        page.outside = ranges.lines();
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
            self.table(text.titled(&table.name));
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

// Unit tests register nothing, so that they compile only what they use.
#[cfg(test)]
pub(crate) use gearloss_framework::unregistered as submit;
#[cfg(not(test))]
#[doc(hidden)]
pub use inventory::submit;

/// Registers the view of a type of outcome: `register_view!(BalanceOutcome, show);` with `fn show(&BalanceOutcome, &mut Page)`.
#[macro_export]
macro_rules! register_view {
    ($O:ty, $show:path) => {
        $crate::page::submit! {
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
