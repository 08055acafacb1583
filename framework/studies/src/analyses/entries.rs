//! What a study writes of each analysis: its name, its meaning, and the names that it uses.

use super::Entry;
use crate::register_entry;
use crate::study::{
    IdentifyEntry, Then, Uses,
};

impl Entry for IdentifyEntry {
    const TYPE: &'static str = "identify";
    const MEANING: &'static str = "Uncertain parameters, found from measured points.";

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.next.as_ref().map(|next| &next.grid),
            grid_key: "next.grid",
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
                .at(&self.gear)
                .bind(&self.bind)
                .with("data", Some(&self.data))
        }
    }

    fn then(&self) -> Option<Then<'_>> {
        let set = self.then.as_deref()?;
        Some(Then {
            set,
            model_sets: &self.model_sets,
        })
    }
}

register_entry!(IdentifyEntry);

