//! Check values of models and ratings beside what this program computes.

use gearloss_framework::checks::{Compared, compare, compare_rating};
use gearloss_framework::language::Language;
use gearloss_framework::registry::{Check, Entry, RatingPlugin};

use crate::text::{Lines, TextTable, figures};

/// Check values as text.
#[derive(Debug, Default)]
pub struct ChecksText {
    out: Lines,
    values: usize,
    faults: usize,
}

impl ChecksText {
    /// Adds the checks of a model, if it has any.
    pub fn model(&mut self, language: &Language, entry: &Entry) {
        let name = format!("{}/{}", entry.mechanism, entry.name);
        self.entry(&name, entry, |check| compare(language, entry, check));
    }

    /// Adds the checks of a rating, if it has any.
    pub fn rating(&mut self, language: &Language, rating: &RatingPlugin) {
        let name = format!("rating/{}", rating.entry.name);
        self.entry(&name, &rating.entry, |check| compare_rating(language, rating, check));
    }

    /// The text, and whether all values are within their tolerance.
    pub fn finish(mut self) -> (String, bool) {
        self.out.line(match (self.values, self.faults) {
            (0, 0) => "no check values".to_owned(),
            (values, 0) => format!("check values: {values}, all within their tolerance"),
            (values, faults) => format!("check values: {values}, faults: {faults}"),
        });
        (self.out.into_text(), self.faults == 0)
    }

    fn entry(&mut self, name: &str, entry: &Entry, compare: impl Fn(&Check) -> Result<Vec<Compared>, String>) {
        if entry.checks.is_empty() {
            return;
        }
        self.out.line(format!("{name}: {}", entry.meaning()));
        let head = [
            "check",
            "quantity",
            "expected",
            "computed",
            "deviation",
            "tolerance",
            "",
        ];
        let mut table = TextTable::new(&head);
        for (number, check) in (1..).zip(entry.checks) {
            self.out.line(format!("{number}: {}", check.input));
            self.out
                .line(format!("   {}; tolerance: {}", check.source, check.because));
            match compare(check) {
                Ok(all) => {
                    for checked in all {
                        self.values += 1;
                        self.faults += usize::from(!checked.agrees());
                        table.row(vec![
                            number.to_string(),
                            checked.quantity.to_owned(),
                            checked.stated.to_owned(),
                            figures(checked.computed, 8),
                            format!("{:.1e}", checked.deviation()),
                            format!("{:e}", check.tolerance),
                            if checked.agrees() { "" } else { "outside" }.to_owned(),
                        ]);
                    }
                }
                Err(fault) => {
                    self.faults += 1;
                    self.out.line(format!("   fault: {fault}"));
                }
            }
        }
        self.out.text(&table.render());
        self.out.line("");
    }
}
