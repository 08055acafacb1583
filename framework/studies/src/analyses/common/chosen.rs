//! The gearbox of an analysis, its gear and its model sets.

use std::sync::Arc;

use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::analyses::{Built, Planner, Stopped, gear_of};
use crate::study::Uses;

/// What an analysis of one gear evaluates.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct Chosen {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Gear; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
}

impl Chosen {
    /// The names that it uses.
    pub fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &self.model_sets).in_gears(&self.gear)
    }

    /// The gearbox with each of its model sets.
    ///
    /// # Errors
    /// As [`Planner::built`].
    pub fn built<'a>(&self, cx: &Planner<'a>) -> Result<Vec<Arc<Built<'a>>>, Stopped> {
        cx.built(cx.gearbox(self.gearbox.as_ref())?, &self.model_sets)
    }

    /// The gear, or the first one.
    pub fn gear<'t>(&'t self, transmission: &'t Transmission) -> &'t str {
        gear_of(self.gear.as_deref(), transmission)
    }
}
