//! A corpus of sets: each a folder with data, their source, and the gearbox and study that judge models by them.
//!
//! `data.csv` has names in line 1, units in line 2, then numbers as printed; commas, decimal points, no quotes. `source.md` begins with
//! the record of [`SourceEntry`] between two lines `---`, followed by own words.

mod data;
mod model_error;
mod read;
mod source;
mod table;
mod validated;

use std::path::PathBuf;

pub use self::model_error::{ErrorOfLaw, JudgingSet, LeftOut, errors_of_laws};
pub use self::read::is_corpus;
pub use self::source::{Basis, Product, SourceEntry, SourceFormat, StatedColumn, Trust};
pub use self::table::cells_csv;
pub use self::validated::{CellOfSet, FEWEST_SETS, Judgement, ModelOverSets, Validated, over_sets};

use crate::study::Study;

/// Name of the file with the source of a set.
pub const SOURCE: &str = "source.md";
/// Name of the file with the data of a set.
pub const DATA: &str = "data.csv";
/// Name of the study of a set.
pub const STUDY: &str = "study.yaml";

/// Sets, in the order of their names.
pub struct Corpus {
    /// The sets.
    pub sets: Vec<Set>,
}

/// A set that was read and found complete.
pub struct Set {
    /// Name of its folder.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// Who, where, how, with which accuracy and licence.
    pub source: SourceEntry,
    /// Number of rows of its data; absent without data.
    pub rows: Option<usize>,
    /// The study that judges models by it; absent if no model can describe its product.
    pub study: Option<Study>,
}
