//! Between two members without load: synchronizers, clutches, brakes, ring gaps. Gear states may close it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attach, Names, Oil, Spot, State, sealed};
use crate::immersion::Height;

/// Between two members, with relative speed only.
#[derive(Debug)]
pub enum Clearance {}

/// The two members of a clearance.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct ClearancePlace {
    /// The two shafts or loose gears; `housing` makes it a brake.
    pub between: [String; 2],
    /// Place along the shaft; matters for the oil level of a tilted housing only. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
}

/// Indices of the two members; absent for the housing.
pub type ClearanceSeat = [Option<u16>; 2];

/// The state in a clearance.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ClearanceSite<'a> {
    /// Speed of the first member relative to the second, signed; zero when closed. \[rad/s\]
    pub speed: f64,
    /// Speed of the first member, signed. \[rad/s\]
    pub first_speed: f64,
    /// The oil there.
    pub oil: &'a Oil,
    /// Height of the oil above the axis.
    pub level: Height,
}

impl sealed::Sealed for Clearance {}

impl Attach for Clearance {
    type Place = ClearancePlace;
    type Seat = ClearanceSeat;
    type Site<'a> = ClearanceSite<'a>;
    const LOADED: bool = false;

    fn seat(place: &ClearancePlace, names: &mut Names<'_>) -> Option<ClearanceSeat> {
        let a = names.side("between", &place.between[0]);
        let b = names.side("between", &place.between[1]);
        let (a, b) = (a?, b?);
        if a == b {
            let path = names.path().to_owned();
            names.report(
                crate::document::Diagnostic::error(format!("{path}.between"), "both ends are the same member")
                    .help("name two members, or one member and `housing`"),
            );
            return None;
        }
        names.lies(a.or(b), place.at);
        names.add_clearance([a, b]);
        Some([a, b])
    }

    #[inline(always)]
    fn site<'a>(seat: ClearanceSeat, spot: &Spot, state: &State<'a>) -> ClearanceSite<'a> {
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
