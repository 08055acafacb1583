//! Drag of open couplings.

pub mod cone_gap;
pub mod ring_gap;

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::synchronizer::{SynchronizerAt, SynchronizerModel};
use gearloss_framework::{limits, terms};

terms! { SHEAR = no_load("shear"); }
limits! {
    REYNOLDS = ("Re", "Reynolds number of the gap", "-", 0.0, 1000.0, "laminar gap flow");
    TAYLOR = ("Ta", "Taylor number of the gap", "-", 0.0, 41.3, "onset of Taylor vortices");
}

/// The oil in the gap of one coupling, which is sheared over its width.
struct Film {
    /// Symbol of the torque.
    symbol: &'static str,
    /// Torque per viscosity and speed. \[m3\]
    factor: f64,
    radius: f64,
    gap: f64,
}

impl SynchronizerModel for Film {
    fn loss(&self, at: &SynchronizerAt<'_>) -> Result<Loss, Undefined> {
        let reynolds = at.rho * at.speed.abs() * self.radius * self.gap / at.eta;
        at.check(&REYNOLDS, reynolds);
        at.check(&TAYLOR, reynolds * (self.gap / self.radius).sqrt());
        at.show("eta", "Pa s", at.eta);
        let moment = self.factor * at.eta * at.speed.abs();
        Ok(Loss::MOMENTS.with(&SHEAR, at.show(self.symbol, "Nm", moment)))
    }
}

#[cfg(test)]
mod cases {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use gearloss_framework::mechanism::synchronizer::{CouplingPart, Synchronizer};
    use gearloss_framework::registry::{Build, Files, Registry, Slot};

    /// A coupling from JSON, in SI.
    pub fn part(json: &str) -> Arc<CouplingPart> {
        Arc::new(serde_json::from_str(json).unwrap())
    }

    /// A model of a coupling, by name.
    pub fn build(model: &str, part: &Arc<CouplingPart>) -> Result<Slot<Synchronizer>, String> {
        let registry = Registry::linked().unwrap_or_else(|found| panic!("{found:?}"));
        let files = Files::default();
        let value = serde_json::json!({ "type": model });
        Build::new(&registry, &files)
            .slot_at("couplings.S1.model", part, &value)
            .map_err(|fault| fault.to_string())
    }
}
