//! Between two members, carrying load: bearings. Statics needs the place and the axial direction.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attach, Names, Oil, Spot, State, sealed};
use crate::immersion::Height;

/// Between a shaft and what carries it: the housing, or another member.
#[derive(Debug)]
pub enum Support {}

/// Where a support sits and which loads it takes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct SupportPlace {
    /// Shaft inside.
    pub shaft: String,
    /// Member outside, such as a loose gear; absent, the housing.
    pub outer: Option<String>,
    /// Place along the shaft. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
    /// Which way the support can take thrust of the shaft.
    #[serde(default)]
    pub axial: Axial,
    /// Share of the thrust where several supports could take it. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub axial_share: Option<f64>,
    /// Force of a spring that preloads the support axially; positive pushes the shaft to the right. [N]
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub spring_preload: f64,
    /// Thrust that the radial load induces, over the radial load: 1/(2 Y) for a tapered roller bearing, 1.14 for a 40
    /// degree angular contact ball bearing. Counts for a pair of which one takes thrust to the left, one to the right. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub induced_thrust: f64,
    /// The support takes the tilting moment of a shaft that it alone carries.
    #[serde(default)]
    pub takes_moment: bool,
    /// Radial stiffness; absent, rigid. Counts where more than two supports carry the shaft. [N/mm]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub radial_stiffness: Option<f64>,
    /// Tilting stiffness; absent, none. Counts where more than two supports carry the shaft. [Nm/rad]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub tilting_stiffness: Option<f64>,
    /// Height of the oil above the axis, where the support has a pocket of its own. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub level: Option<f64>,
    /// Factor on the radial load that the loss models see: a number, or numbers over the torque of a port.
    #[serde(default)]
    pub radial_factor: Factor,
    /// Factor on the axial load that the loss models see: a number, or numbers over the torque of a port.
    #[serde(default)]
    pub axial_factor: Factor,
}

/// Which way a support can take thrust of the shaft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axial {
    /// No thrust.
    #[default]
    None,
    /// Thrust towards smaller places.
    Left,
    /// Thrust towards greater places.
    Right,
    /// Thrust both ways.
    Both,
}

impl Axial {
    /// The other way.
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            other => other,
        }
    }
}

/// A load correction factor.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Factor {
    /// One factor. [-]
    Constant(#[schemars(range(min = 0.0, max = 100.0))] f64),
    /// Factors over the torque of a port.
    Over(FactorOver),
}

impl Default for Factor {
    fn default() -> Self {
        Self::Constant(1.0)
    }
}

/// Factors over the magnitude of a port's torque, linear in between, constant beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct FactorOver {
    /// Port whose torque counts.
    pub port: String,
    /// Torques, rising. [Nm]
    #[schemars(inner(range(min = 0.0, max = 1e9)), length(min = 2))]
    pub torques: Vec<f64>,
    /// Factors, one for each torque. [-]
    #[schemars(inner(range(min = 0.0, max = 100.0)), length(min = 2))]
    pub factors: Vec<f64>,
}

/// Indices of a support.
#[derive(Debug, Clone, Copy)]
pub struct SupportSeat {
    inner: u16,
    outer: Option<u16>,
    number: u16,
}

/// The state in a support.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct SupportSite<'a> {
    /// Speed of the inner member relative to the outer one, signed. \[rad/s\]
    pub speed: f64,
    /// Speed of the outer member, signed. \[rad/s\]
    pub outer_speed: f64,
    /// Radial load, with its factor. \[N\]
    pub radial: f64,
    /// Axial load, with its factor. \[N\]
    pub axial: f64,
    /// Tilting moment. \[Nm\]
    pub tilting: f64,
    /// The oil there.
    pub oil: &'a Oil,
    /// Height of the oil above the axis.
    pub level: Height,
}

impl sealed::Sealed for Support {}

impl Attach for Support {
    type Place = SupportPlace;
    type Seat = SupportSeat;
    type Site<'a> = SupportSite<'a>;
    const LOADED: bool = true;

    fn seat(place: &SupportPlace, names: &mut Names<'_>) -> Option<SupportSeat> {
        let inner = names.member("shaft", &place.shaft);
        let outer = match &place.outer {
            Some(id) => names.side("outer", id),
            None => Some(None),
        };
        let (inner, outer) = (inner?, outer?);
        if outer == Some(inner) {
            let path = names.path().to_owned();
            names.report(
                crate::document::Diagnostic::error(
                    format!("{path}.outer"),
                    "a support cannot carry a member on itself",
                )
                .help("name another member, or leave `outer` out for the housing"),
            );
            return None;
        }
        names.lies(Some(inner), place.at);
        names.own_level(place.level);
        let number = names.add_support(inner, outer, place);
        Some(SupportSeat { inner, outer, number })
    }

    #[inline(always)]
    fn site<'a>(seat: SupportSeat, spot: &Spot, state: &State<'a>) -> SupportSite<'a> {
        let load = &state.loads[seat.number as usize];
        SupportSite {
            speed: state.relative(Some(seat.inner), seat.outer),
            outer_speed: state.speed(seat.outer),
            radial: load.radial,
            axial: load.axial,
            tilting: load.tilting,
            oil: state.oil(spot),
            level: state.level(spot),
        }
    }

    fn between(seat: SupportSeat) -> [Option<u16>; 2] {
        [Some(seat.inner), seat.outer]
    }

    fn support(seat: SupportSeat) -> Option<u16> {
        Some(seat.number)
    }
}
