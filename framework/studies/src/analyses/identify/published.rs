//! An identification as the outcome of an analysis: its tables, notes, values and files.

use serde_json::Value;

use super::outcome::{IdentificationOfSet, IdentifyOutcome};
use super::{tables, values};
use crate::analyses::{Head, Outcome, TextFile};
use crate::identify::Identified;
use crate::points::Note;
use crate::table::Table;

impl Outcome for IdentifyOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let (name, all) = (self.head.analysis.as_str(), &self.identifications[..]);
        let mut list = Vec::new();
        if self.data.is_some() {
            list.extend([tables::points(name, all), tables::shares(name, all)]);
        }
        if all.iter().any(|o| !o.means.is_empty()) {
            list.push(tables::means::table(name, all));
        }
        list.push(tables::parameters(name, all));
        list.extend(self.requested.posterior.then(|| tables::posterior::table(name, all)));
        list.extend(self.held_out.as_ref().map(|_| tables::hold_out::table(name, all)));
        list.extend(self.requested.next.then(|| tables::next::table(name, all)));
        list.extend(
            self.comparison_of_sets
                .as_ref()
                .map(|sets| tables::compare::table(name, sets)),
        );
        list
    }

    fn notes(&self) -> Vec<&Note> {
        self.identifications.iter().flat_map(|o| &o.outside).collect()
    }

    fn found(&self) -> Vec<(String, Value)> {
        // A study can only name the values of one set.
        match &self.identifications[..] {
            [o] => Identified::overrides(&o.found.parameters, o.found.fitted.theta()),
            _ => Vec::new(),
        }
    }

    fn files(&self) -> Vec<TextFile> {
        let name = &self.head.analysis;
        let file = |o: &IdentificationOfSet| TextFile {
            name: format!("{name}-{}.yaml", o.model_set.replace('/', "-")),
            text: values::as_yaml(name, o),
        };
        self.identifications.iter().map(file).collect()
    }
}
