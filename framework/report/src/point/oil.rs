//! Oil levels of a point as text and as a record.

use gearloss_framework::evaluate::{LevelFrom, OilLevels};
use schemars::JsonSchema;
use serde::Serialize;

use crate::text::{figures, fixed};

/// Litres per minute of one m3/s.
const PER_MINUTE: f64 = 6e4;

/// Oil levels above the datum.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "OilLevel")]
pub(super) struct OilLevelRecord {
    /// At rest; churning laws use it. [mm]
    at_rest_mm: f64,
    /// While rotating; bearings and other components use it. [mm]
    running_mm: f64,
    /// Where the level while rotating comes from.
    running_from: LevelFrom,
    /// Estimates of the level while rotating; null if the oil space is not known.
    estimate: Option<EstimateRecord>,
}

/// Estimates of the level while rotating, from the oil that the gears lift.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "OilLevelEstimate")]
struct EstimateRecord {
    /// Lowest estimate. [mm]
    lowest_mm: f64,
    /// Highest estimate. [mm]
    highest_mm: f64,
    /// By the film on the walls, with 0.3, 1 and 2 times the flow of the momentum theorem. [mm]
    films_mm: [f64; 3],
    /// By the effective depth of Shore. [mm]
    effective_depth_mm: f64,
    /// Flow that the gears lift. [l/min]
    lifted_l_per_min: f64,
    /// Oil on the walls and in the air. [l]
    missing_l: f64,
    /// Oil in chambers that drain into the sump. [l]
    in_chambers_l: f64,
    /// Oil in pockets of bearings whose length is stated. [l]
    in_pockets_l: f64,
    /// Oil on the flanks of gears, which no level lacks because it is so little. [l]
    on_gears_l: f64,
    /// Level a minute after a stop, when a film is left on the walls and the chambers have drained. [mm]
    minute_after_stop_mm: f64,
    /// Oil in the housing. [l]
    volume_l: f64,
    /// True if the oil space is that of the drawing; otherwise it is the hull of the gears, an assumption.
    drawn: bool,
}

impl From<OilLevels> for OilLevelRecord {
    fn from(levels: OilLevels) -> Self {
        let mm = |x: f64| x * 1e3;
        Self {
            at_rest_mm: mm(levels.at_rest),
            running_mm: mm(levels.running),
            running_from: levels.from,
            estimate: levels.estimate.map(|estimate| EstimateRecord {
                lowest_mm: mm(estimate.band.low()),
                highest_mm: mm(estimate.band.high()),
                films_mm: estimate.band.films.map(mm),
                effective_depth_mm: mm(estimate.band.effective),
                lifted_l_per_min: estimate.lifted * PER_MINUTE,
                missing_l: mm(estimate.missing),
                in_chambers_l: mm(estimate.held),
                in_pockets_l: mm(estimate.in_pockets),
                on_gears_l: mm(estimate.on_gears),
                minute_after_stop_mm: mm(estimate.after_minute),
                volume_l: mm(estimate.volume),
                drawn: estimate.drawn,
            }),
        }
    }
}

/// The levels in one or two lines; empty if none is known.
pub(super) fn oil_level_text(levels: Option<OilLevels>) -> String {
    let Some(levels) = levels else { return String::new() };
    let mm = |x: f64| fixed(x * 1e3, 1);
    let running = match levels.from {
        LevelFrom::Stated => format!("{} mm rotating as stated", mm(levels.running)),
        LevelFrom::AtRest => "the same rotating".to_owned(),
        LevelFrom::Estimated if levels.running == levels.at_rest => "the same rotating: no gear lifts oil".to_owned(),
        LevelFrom::Estimated => format!("{} mm rotating by estimate", mm(levels.running)),
    };
    let mut text = format!("oil level {} mm at rest, {running}\n", mm(levels.at_rest));
    // Without lifted oil all estimates are the level at rest.
    if let Some(estimate) = levels.estimate.filter(|estimate| estimate.band.low() < levels.at_rest) {
        let space = if estimate.drawn {
            ""
        } else {
            ", inside of the housing assumed"
        };
        text += &format!(
            "  estimates {} to {} mm: film {} to {}, usually {}; effective depth {}; gears lift {} l/min, {} of {} l are on walls and in the air{space}\n",
            mm(estimate.band.low()),
            mm(estimate.band.high()),
            mm(estimate.band.films[2]),
            mm(estimate.band.films[0]),
            mm(estimate.band.films[1]),
            mm(estimate.band.effective),
            figures(estimate.lifted * PER_MINUTE, 3),
            figures(estimate.missing * 1e3, 3),
            figures(estimate.volume * 1e3, 3),
        );
        for (volume, place) in [
            (estimate.held, "chambers"),
            (estimate.in_pockets, "pockets of bearings"),
        ] {
            if volume > 0.0 {
                text += &format!("  {} l stand in {place}\n", figures(volume * 1e3, 3));
            }
        }
    }
    text
}
