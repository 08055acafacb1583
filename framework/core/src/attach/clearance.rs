//! Between two members without load: synchronizers, clutches, brakes, ring gaps. Gear states may close it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attach, Names, Oil, Spot, State, sealed};
use crate::immersion::Height;
use crate::real::Points;

/// Between two members, with relative speed only.
#[derive(Debug)]
pub enum Clearance {}

/// The two members of a clearance.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ClearancePlace {
    /// The two shafts or idler gears; `housing` makes it a brake.
    #[schemars(extend("x-refers-to" = ["shafts", "gears", "housing"]))]
    pub between: [String; 2],
    /// Position along the shaft; matters only for the oil level of a tilted housing. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
}

/// Indices of the two members; `None` for the housing.
pub(crate) type ClearanceSeat = [Option<u16>; 2];

/// The state at a clearance.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ClearanceSite<'a, R = f64> {
    /// Speed of the first member relative to the second, signed; zero when closed. \[rad/s\]
    pub speed: R,
    /// Speed of the first member, signed. \[rad/s\]
    pub first_speed: R,
    /// The local oil.
    pub oil: &'a Oil<R>,
    /// Oil height above the axis.
    pub level: Height<R>,
}

impl sealed::Sealed for Clearance {}

impl Attach for Clearance {
    type Place = ClearancePlace;
    type Seat = ClearanceSeat;
    type Site<'a, R: Points> = ClearanceSite<'a, R>;
    const LOADED: bool = false;

    fn seat(place: &ClearancePlace, names: &mut Names<'_>) -> Option<ClearanceSeat> {
        let a = names.side("between", &place.between[0]);
        let b = names.side("between", &place.between[1]);
        let (a, b) = (a?, b?);
        if a == b {
            let path = names.path().to_owned();
            names.report(
                crate::document::Diagnostic::error(format!("{path}.between"), "both sides are the same member")
                    .help("name two different members, or one member and `housing`"),
            );
            return None;
        }
        names.lies(a.or(b), place.at);
        names.add_clearance([a, b]);
        Some([a, b])
    }

    #[inline(always)]
    fn site<'a, R: Points>(seat: ClearanceSeat, spot: &Spot, state: &State<'a, R>) -> ClearanceSite<'a, R> {
        ClearanceSite {
            speed: state.relative(seat[0], seat[1]),
            first_speed: state.speed(seat[0]),
            oil: state.oil(spot),
            level: state.level(spot),
        }
    }

    fn between(seat: ClearanceSeat) -> [Option<u16>; 2] {
        seat
    }
}
