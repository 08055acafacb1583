//! On a member, against the housing: seals, pumps and other components driven by a shaft.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attach, Names, Oil, Spot, State, sealed};
use crate::hydraulics::Supply;
use crate::immersion::Height;
use crate::real::Points;

/// On a shaft or an idler gear, against the housing.
#[derive(Debug)]
pub enum OnMember {}

/// Position of a component on a member.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct MemberPlace {
    /// Shaft or idler gear.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub shaft: String,
    /// Position along the shaft; matters only for the oil level of a tilted housing. [mm]
    #[serde(default)]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
}

/// The state at a component on a member.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct MemberSite<'a, R = f64> {
    /// Speed of the member, signed. \[rad/s\]
    pub speed: R,
    /// The local oil.
    pub oil: &'a Oil<R>,
    /// Oil height above the axis.
    pub level: Height<R>,
    /// What flows through the element of the oil network that the model names.
    pub supply: Supply<R>,
}

impl sealed::Sealed for OnMember {}

impl Attach for OnMember {
    type Place = MemberPlace;
    type Seat = u16;
    type Site<'a, R: Points> = MemberSite<'a, R>;
    const LOADED: bool = false;

    fn seat(place: &MemberPlace, names: &mut Names<'_>) -> Option<u16> {
        let member = names.member("shaft", &place.shaft)?;
        names.lies(Some(member), place.at);
        Some(member)
    }

    #[inline(always)]
    fn site<'a, R: Points>(seat: u16, spot: &Spot, state: &State<'a, R>) -> MemberSite<'a, R> {
        MemberSite {
            speed: state.speed(Some(seat)),
            oil: state.oil(spot),
            level: state.level(spot),
            supply: state.supply(spot.supply),
        }
    }

    fn between(seat: u16) -> [Option<u16>; 2] {
        [Some(seat), None]
    }
}
