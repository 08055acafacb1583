//! Where the oil stands at a point: at rest and while rotating, with the estimates.

use super::Solution;
use super::scratch::incline;
use crate::hydraulics::Inputs;
use crate::real::Points as _;
use crate::sump::{Band, CAPTURE, left_on_wall};
use crate::transmission::{Pockets, Surface};

/// Time after a stop at which a dipstick is read. \[s\]
const MINUTE: f64 = 60.0;

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
    /// Oil in the pockets of bearings whose length is known, by the same. \[m3\]
    pub in_pockets: f64,
    /// Oil on the flanks of the gears, which is so little that the level does not have it. \[m3\]
    pub on_gears: f64,
    /// The level a minute after a stop, when a film is left on the walls and the chambers have drained. \[m\]
    pub after_minute: f64,
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
                incline: incline(c.travel.as_ref(), c.inclination),
            };
            let held = t.hydraulics.held(&c.hydraulics, &at);
            let catchers = Pockets {
                network: &t.hydraulics,
                work: &c.hydraulics,
                speeds: &c.speeds,
                oils: &c.oils,
            };
            let running = sump.running((c.rest, c.inclination), held, &c.oils, &lifted, (catchers, !0));
            let band = running.band();
            let outside = running.outside(|x| x, band.films[1], CAPTURE[1]);
            let space = (running.space)(0);
            let left = left_on_wall(running.nu, space.top() - c.rest, MINUTE) * running.walls.area;
            // After a stop the chambers drain, so that the sump has all oil below the level at rest again.
            let filled = space.volume(c.rest)[0];
            LevelEstimate {
                rim: (!lifted.is_empty()).then(|| running.fastest_rim()),
                band,
                volume: running.stock + held,
                lifted: outside.flow,
                missing: outside.on_walls + outside.in_air,
                in_pockets: outside.in_pockets,
                on_gears: running.on_gears(0),
                after_minute: space.level(filled - left.min(outside.on_walls)),
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
