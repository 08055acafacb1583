//! Where the oil stands at a point: at rest and while rotating, with the estimates.

use super::Solution;
use crate::attach::Oil;
use crate::hydraulics::Inputs;
use crate::real::Points as _;
use crate::sump::{Band, CAPTURE};
use crate::transmission::Surface;

/// Where the level while rotating comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LevelFrom {
    /// It is stated.
    Stated,
    /// It is that at rest.
    AtRest,
    /// It is estimated from what the gears lift.
    Estimated,
}

/// Oil heights above the datum at a point. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OilLevels {
    /// At rest, which churning laws use.
    pub at_rest: f64,
    /// While rotating, which everything else uses.
    pub running: f64,
    /// Where the level while rotating comes from.
    pub from: LevelFrom,
    /// What the oil space and the lifted oil give; `None` if the space is not known.
    pub estimate: Option<LevelEstimate>,
}

/// Estimates of the level while rotating.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelEstimate {
    /// The level by both methods. \[m\]
    pub band: Band,
    /// Volume of the oil in the housing. \[m3\]
    pub volume: f64,
    /// Flow that the gears lift, by the usual film estimate. \[m3/s\]
    pub lifted: f64,
    /// Oil on the walls and in the air, by the same. \[m3\]
    pub missing: f64,
    /// Oil in chambers that drain into the sump. \[m3\]
    pub held: f64,
    /// Greatest speed of a tip circle that dips into the oil at rest; `None` without gears with a churning law. \[m/s\]
    pub rim: Option<f64>,
    /// True if the oil space is that of the drawing; otherwise it is the hull of the gears.
    pub drawn: bool,
}

impl Solution<'_> {
    /// Oil levels of the point; `None` if no level is known.
    pub fn oil_levels(&self) -> Option<OilLevels> {
        let (t, m) = (self.transmission, &self.scratch.models);
        let c = &m.conditions;
        if !c.rest.is_finite() {
            return None;
        }
        let estimate = t.oils.sump.as_ref().map(|sump| {
            let mut lifted = m.lifted.clone();
            sump.lift(&t.drags, &m.drag_losses, &c.open(false).0, &mut lifted);
            let at = Inputs {
                speeds: &c.speeds,
                oils: &c.oils,
                surface: c.surface,
            };
            let held = t.hydraulics.held(&c.hydraulics, &at);
            let running = sump.running((c.rest, c.inclination), held, &c.oils, &lifted);
            let band = running.band();
            let nu = c.oils.get(sump.oil).map_or(0.0, |oil: &Oil| oil.nu);
            let [missing, flow] = running.missing(|i| lifted[i], band.films[1], nu, CAPTURE[1]);
            LevelEstimate {
                rim: (!lifted.is_empty()).then(|| running.fastest_rim()),
                band,
                volume: running.stock + held,
                lifted: flow,
                missing,
                held,
                drawn: sump.is_drawn(),
            }
        });
        let (from, running) = match (t.oils.surface(), &estimate) {
            (Surface::Fixed(_) | Surface::Over { .. }, _) => (LevelFrom::Stated, c.surface),
            (Surface::Estimated(place), Some(estimate)) => (LevelFrom::Estimated, estimate.band.at(*place)),
            (Surface::AtRest | Surface::Estimated(_), _) => (LevelFrom::AtRest, c.rest),
        };
        Some(OilLevels {
            at_rest: c.rest.at_point(0),
            running,
            from,
            estimate,
        })
    }
}
