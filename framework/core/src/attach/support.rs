//! Between two members, carrying load: bearings. Statics uses the position and the axial direction.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Attach, Level, Names, Oil, PreloadEntry, Spot, State, sealed};
use crate::description::PocketEntry;
use crate::immersion::Height;
use crate::real::Points;

/// Between a shaft and its support: the housing, or another member.
#[derive(Debug)]
pub enum Support {}

/// Position of a bearing and the loads that it takes.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct SupportPlace {
    /// Member in the bore: a shaft.
    #[schemars(extend("x-refers-to" = "shafts"))]
    pub shaft: String,
    /// Member around the bearing, such as an idler gear; default: the housing.
    #[schemars(extend("x-refers-to" = ["shafts", "gears"]))]
    pub outer: Option<String>,
    /// Position along the shaft. [mm]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub at: f64,
    /// Directions in which the bearing takes thrust of the shaft.
    #[serde(default)]
    pub axial: Axial,
    /// Share of the thrust if several bearings can take it. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub axial_share: Option<f64>,
    /// Axial preload by a spring; a positive force pushes the shaft towards +x. The bearing of a pair has the force of its spring as axial
    /// load. [N]
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub spring_preload: f64,
    /// Preload of this and the opposed bearing of a pair without a spring, or their end play; stated at one of them.
    pub preload: Option<PreloadEntry>,
    /// Thrust induced by the radial load, per radial load. Default for tapered roller and angular contact ball bearings of which one takes
    /// thrust to the left, one to the right: 0.5/Y, or by `contact_angle`. Zero: no induced thrust, as of a bearing without contact angle. [-]
    #[schemars(range(min = 0.0, max = 3.0))]
    pub induced_thrust: Option<f64>,
    /// The bearing takes the tilting moment of a shaft that it supports alone.
    #[serde(default)]
    pub takes_moment: bool,
    /// Radial stiffness; default: rigid. A number, or a load at which it follows from the rolling elements. The loads of two bearings do not
    /// depend on it, unless they have a tilting stiffness; those of more bearings and the misalignment of gears do.
    pub radial_stiffness: Option<RadialStiffness>,
    /// Tilting stiffness; default: none. A number, or a load at which it follows from the rolling elements. A shaft on several bearings, of which
    /// one has it, needs `sections`. A bearing that supports a shaft alone takes its whole moment, however stiff.
    pub tilting_stiffness: Option<TiltingStiffness>,
    /// Oil height above the axis, if the bearing has a separate oil pocket. [mm]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub level: Option<f64>,
    /// Pocket in which oil stands up to an overflow edge. The oil height at the bearing is that of the sump or of the pocket, whichever is
    /// higher.
    pub pocket: Option<PocketEntry>,
    /// Whether oil of the sump reaches the bearing; `false` for one behind a wall or a seal, which only its pocket supplies.
    #[serde(default = "reached")]
    pub fed: bool,
    /// Factor on the radial load for the loss models: a number, or numbers over the torque of a port.
    #[serde(default)]
    pub radial_factor: Factor,
    /// Factor on the axial load for the loss models: a number, or numbers over the torque of a port.
    #[serde(default)]
    pub axial_factor: Factor,
}

fn reached() -> bool {
    true
}

/// Directions in which a bearing takes thrust of the shaft.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axial {
    /// No thrust.
    #[default]
    None,
    /// Thrust towards -x.
    Left,
    /// Thrust towards +x.
    Right,
    /// Thrust in both directions.
    Both,
}

impl Axial {
    /// The opposite direction.
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

/// Radial stiffness of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum RadialStiffness {
    /// One stiffness. [N/mm]
    Constant(#[schemars(range(min = 1.0, max = 1e9))] f64),
    /// From the load distribution of the rolling elements: the load over the displacement that it causes.
    At(StiffnessLoad),
}

/// Tilting stiffness of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TiltingStiffness {
    /// One stiffness. [Nm/rad]
    Constant(#[schemars(range(min = 1.0, max = 1e9))] f64),
    /// From the load distribution of the rolling elements: the moment of a small tilt in the plane of the load, which stays.
    At(StiffnessLoad),
}

/// The load at which a bearing has a stiffness, with the clearance in operation and a ring that does not tilt. A bearing with a contact angle
/// also has the axial load that loads half of its elements.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StiffnessLoad {
    /// Radial load. [N]
    #[schemars(range(min = 1.0, max = 1e8))]
    pub at_load: f64,
}

/// A stiffness of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stiffness {
    /// A radial load over the displacement that it causes. \[N/m\]
    Radial,
    /// A moment over the tilt that it causes. \[Nm/rad\]
    Tilting,
}

impl Stiffness {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Radial, Self::Tilting];

    /// Key of a support that states it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Radial => "radial_stiffness",
            Self::Tilting => "tilting_stiffness",
        }
    }
}

/// How the stiffness of a bearing is stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedStiffness {
    /// As a number. \[N/m, Nm/rad\]
    Constant(f64),
    /// By a load. \[N\]
    At(f64),
}

impl SupportPlace {
    /// A stiffness as stated.
    pub fn stated(&self, stiffness: Stiffness) -> Option<StatedStiffness> {
        Some(match stiffness {
            Stiffness::Radial => match self.radial_stiffness? {
                RadialStiffness::Constant(value) => StatedStiffness::Constant(value),
                RadialStiffness::At(load) => StatedStiffness::At(load.at_load),
            },
            Stiffness::Tilting => match self.tilting_stiffness? {
                TiltingStiffness::Constant(value) => StatedStiffness::Constant(value),
                TiltingStiffness::At(load) => StatedStiffness::At(load.at_load),
            },
        })
    }
}

/// Factors over the magnitude of a port's torque, linear in between, constant beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct FactorOver {
    /// Port of the torque.
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Torques, increasing. [Nm]
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
    pocket: Option<u16>,
}

/// The state at a bearing.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct SupportSite<'a, R = f64> {
    /// Speed of the inner member relative to the outer one, signed. \[rad/s\]
    pub speed: R,
    /// Speed of the outer member, signed. \[rad/s\]
    pub outer_speed: R,
    /// Radial load, with its factor. \[N\]
    pub radial: R,
    /// Axial load, with its factor. \[N\]
    pub axial: R,
    /// Tilting moment. \[Nm\]
    pub tilting: R,
    /// The local oil.
    pub oil: &'a Oil<R>,
    /// Oil height above the axis.
    pub level: Height<R>,
    /// Oil height in its pocket above the lowest point of the raceway; zero without a pocket. \[m\]
    pub pocket: R,
}

impl sealed::Sealed for Support {}

impl Attach for Support {
    type Place = SupportPlace;
    type Seat = SupportSeat;
    type Site<'a, R: Points> = SupportSite<'a, R>;
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
                    "`inner` and `outer` of a bearing are the same member",
                )
                .help("name another member, or omit `outer` for the housing"),
            );
            return None;
        }
        names.lies(Some(inner), place.at);
        names.own_level(match place.level {
            Some(level) => Some(Level::Own(level)),
            None if !place.fed => Some(Level::Dry),
            None => None,
        });
        let stated = place.level.is_some();
        if stated && (place.pocket.is_some() || !place.fed) {
            let path = names.path().to_owned();
            let key = if place.fed { "pocket" } else { "fed" };
            names.report(
                crate::document::Diagnostic::error(format!("{path}.{key}"), "`level` already states the oil height")
                    .help(format!("remove `level` or `{key}`")),
            );
        }
        let pocket = place.pocket.as_ref().map(|pocket| names.add_pocket(pocket));
        let number = names.add_support(inner, outer, place);
        Some(SupportSeat {
            inner,
            outer,
            number,
            pocket,
        })
    }

    #[inline(always)]
    fn site<'a, R: Points>(seat: SupportSeat, spot: &Spot, state: &State<'a, R>) -> SupportSite<'a, R> {
        let load = &state.loads[seat.number as usize];
        SupportSite {
            speed: state.relative(Some(seat.inner), seat.outer),
            outer_speed: state.speed(seat.outer),
            radial: load.radial,
            axial: load.axial,
            tilting: load.tilting,
            oil: state.oil(spot),
            level: state.level(spot),
            pocket: seat
                .pocket
                .map_or(R::ZERO, |pocket| state.supplies.pockets[pocket as usize]),
        }
    }

    fn between(seat: SupportSeat) -> [Option<u16>; 2] {
        [Some(seat.inner), seat.outer]
    }

    fn support(seat: SupportSeat) -> Option<u16> {
        Some(seat.number)
    }
}
