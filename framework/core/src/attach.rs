//! Where a component is attached: the closed set of attachments, as types.
//!
//! The attachment determines the relative speed, the loads, the local oil, and which members take the reaction. Each has a *place*
//! (the keys that it adds to the component's entry), a *seat* (indices), and a *site* (the state at one point).

mod clearance;
mod common;
mod member;
mod preload;
mod support;

use std::cell::Cell;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

pub use clearance::{Clearance, ClearancePlace, ClearanceSite};
pub use common::Common;
pub use member::{MemberPlace, MemberSite, OnMember};
pub use preload::{BodyMaterial, PreloadBody, PreloadEntry};
pub use support::{
    Axial, Factor, FactorOver, RadialStiffness, StatedStiffness, Stiffness, StiffnessLoad, Support, SupportPlace,
    SupportSeat, SupportSite, TiltingStiffness,
};

use crate::codes;
use crate::description::PocketEntry;
use crate::document::{Diagnostic, did_you_mean};
use crate::hydraulics::{Supplies, Supply};
use crate::immersion::Height;
use crate::loads::SupportLoad;
use crate::real::Points;
use crate::sump::Travel;

mod sealed {
    pub trait Sealed {}
}

/// An attachment. The set is closed: mechanisms choose one, they do not define new ones.
pub trait Attach: sealed::Sealed + 'static {
    /// The keys that the attachment adds to the component's entry.
    type Place: DeserializeOwned + JsonSchema + Send + Sync;
    /// Indices of the members and oils that the place names.
    type Seat: Copy + Send + Sync;
    /// The state at one operating point.
    type Site<'a, R: Points>;
    /// True if the loss may depend on torque or load.
    const LOADED: bool;
    /// Looks up the names of a place; unknown names become findings.
    fn seat(place: &Self::Place, names: &mut Names<'_>) -> Option<Self::Seat>;
    /// The site of a seat.
    fn site<'a, R: Points>(seat: Self::Seat, spot: &Spot, state: &State<'a, R>) -> Self::Site<'a, R>;
    /// First and second member: moments oppose the speed of the first relative to the second, and both take the reaction. `None` is
    /// the housing.
    fn between(seat: Self::Seat) -> [Option<u16>; 2];
    /// Number of the support, if the attachment carries load.
    fn support(_seat: Self::Seat) -> Option<u16> {
        None
    }
}

/// The oil at one place at one point, SI; temperature in degC.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Oil<R = f64> {
    /// Temperature. \[degC\]
    pub temperature: R,
    /// Kinematic viscosity. \[m2/s\]
    pub nu: R,
    /// Density. \[kg/m3\]
    pub rho: R,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: R,
    /// Kinematic viscosity at 40 degC. \[m2/s\]
    pub nu40: R,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: R,
    /// Relative decrease of the viscosity with temperature. \[1/K\]
    pub beta: R,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: R,
    /// Coefficient of boundary friction in rolling bearings; zero if none is stated.
    pub mu_bl: R,
    /// Coefficient of full-film friction in rolling bearings.
    pub mu_ehl: R,
    /// Lubricant factor of mean mesh friction.
    pub x_l: R,
    /// Eyring stress; zero if none is stated. \[Pa\]
    pub tau0: R,
    /// Slope of the limiting stress over pressure; zero if none is stated.
    pub limiting_slope: R,
}

/// The properties of an oil as an array, in the order of their names, and back.
macro_rules! properties {
    ($($name:ident),*) => {
        impl<R: Copy> Oil<R> {
            pub(crate) fn properties(&self) -> [R; 13] {
                [$(self.$name),*]
            }

            pub(crate) fn of_properties([$($name),*]: [R; 13]) -> Self {
                Self { $($name),* }
            }
        }
    };
}
properties!(
    temperature,
    nu,
    rho,
    eta,
    nu40,
    alpha,
    beta,
    conductivity,
    mu_bl,
    mu_ehl,
    x_l,
    tau0,
    limiting_slope
);

/// Oil supply of a component and its level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Number of the oil among those of the transmission.
    pub oil: u16,
    /// How the oil height above the component's axis is computed.
    pub level: Level,
    /// Number of the element of the oil network that its model names.
    pub supply: Option<u16>,
}

/// Oil height above an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Level {
    /// No oil reaches the place.
    Dry,
    /// A separate pocket with this height above the axis. \[m\]
    Own(f64),
    /// The sump: `(surface - height) * slope`, with the height of the axis above the datum. \[m\]
    Sump {
        /// Height of the axis above the datum, along the upward direction. \[m\]
        height: f64,
        /// One over the component of the upward direction perpendicular to the shafts.
        slope: f64,
        /// Radius of the orbit of the axis about that point; zero for a stationary axis. \[m\]
        orbit: f64,
        /// The point from the datum (m), and the direction of the axis.
        axis: [[f64; 3]; 2],
    },
}

/// Inclination of the housing at each point, in addition to that as built.
#[derive(Debug, Clone, Copy)]
pub struct Incline<'a, R = f64> {
    /// How the housing travels.
    pub travel: &'a Travel,
    /// Positive raises what is ahead. \[rad\]
    pub angle: R,
}

impl<R: Points> Incline<'_, R> {
    /// The upward direction at a point; that as built without one.
    #[inline]
    pub(crate) fn up(&self, point: usize) -> Option<[f64; 3]> {
        let angle = self.angle.at_point(point);
        (angle != 0.0).then(|| self.travel.up(angle))
    }
}

/// Least rise across an axis.
const UPRIGHT: f64 = 1e-6;

impl Level {
    /// Height of a surface above the axis, across the shafts.
    #[inline(always)]
    pub(crate) fn under<R: Points>(self, surface: R, incline: Option<Incline<'_, R>>) -> Height<R> {
        match self {
            Self::Dry => Height {
                level: R::constant(f64::NEG_INFINITY),
                orbit: 0.0,
            },
            Self::Own(level) => Height {
                level: R::constant(level),
                orbit: 0.0,
            },
            Self::Sump {
                height, slope, orbit, ..
            } => match incline {
                None => Height {
                    level: (surface - height) * slope,
                    orbit,
                },
                Some(incline) => {
                    let [height, slope] = self.axis(incline);
                    Height {
                        level: (surface - height) * slope,
                        orbit,
                    }
                }
            },
        }
    }

    /// Height of the axis above the datum (m) and one over the rise across it, at the inclination of each point; zeros without a sump.
    pub(crate) fn axis<R: Points>(self, incline: Incline<'_, R>) -> [R; 2] {
        let Self::Sump {
            height, slope, axis, ..
        } = self
        else {
            return [R::ZERO; 2];
        };
        let [place, direction] = axis;
        let at = |point: usize| {
            let Some(up) = incline.up(point) else {
                return [height, slope];
            };
            let dot = |a: [f64; 3]| up[0] * a[0] + up[1] * a[1] + up[2] * a[2];
            let along = dot(direction);
            let across = (1.0 - along * along).max(0.0).sqrt().max(UPRIGHT);
            [dot(place), 1.0 / across]
        };
        R::each_of(at)
    }
}

/// State of the transmission at one operating point, as attachments see it.
#[derive(Debug, Clone, Copy)]
pub struct State<'a, R = f64> {
    /// Speeds of the members. \[rad/s\]
    pub speeds: &'a [R],
    /// Oils, by number.
    pub oils: &'a [Oil<R>],
    /// Temperatures of the nodes, or one for all nodes. \[degC\]
    pub temperatures: &'a [R],
    /// Oil height above the datum while rotating; minus infinity without a sump. \[m\]
    pub surface: R,
    /// The same at rest, for churning laws. \[m\]
    pub rest: R,
    /// Inclination of the housing, if a point has any.
    pub incline: Option<Incline<'a, R>>,
    /// What the oil network supplies.
    pub supplies: Supplies<'a, R>,
    /// Loads of the supports.
    pub loads: &'a [SupportLoad<R>],
    /// Number of loss model evaluations.
    pub calls: &'a Cell<usize>,
}

impl<'a, R: Points> State<'a, R> {
    /// Counts one evaluation of a model for each of some points.
    pub(crate) fn count_call(&self, points: R::Mask) {
        self.calls.set(self.calls.get() + R::bits(points).count_ones() as usize);
    }

    /// Speed of a member; zero for the housing. \[rad/s\]
    #[inline(always)]
    pub fn speed(&self, member: Option<u16>) -> R {
        member.map_or(R::ZERO, |m| self.speeds[m as usize])
    }

    /// Difference of two members' speeds; zero if it is rounding error. \[rad/s\]
    #[inline(always)]
    pub fn relative(&self, a: Option<u16>, b: Option<u16>) -> R {
        let (a, b) = (self.speed(a), self.speed(b));
        let rounding = a.abs().max(b.abs()) * 1e-12;
        R::select((a - b).abs().is_above(rounding), a - b, R::ZERO)
    }

    /// The oil of a spot.
    #[inline]
    pub fn oil(&self, spot: &Spot) -> &'a Oil<R> {
        &self.oils[spot.oil as usize]
    }

    /// What flows through an element of the oil network; nothing without one.
    #[inline(always)]
    pub fn supply(&self, element: Option<u16>) -> Supply<R> {
        element.map_or_else(Supply::default, |element| self.supplies.elements[element as usize])
    }

    /// Oil height above the axis at a spot.
    #[inline(always)]
    pub fn level(&self, spot: &Spot) -> Height<R> {
        spot.level.under(self.surface, self.incline)
    }
}

/// A support with its indices, for statics.
#[derive(Debug, Clone)]
pub struct SeatedSupport {
    /// Path of the component.
    pub path: String,
    /// Member inside.
    pub inner: u16,
    /// Member outside; `None` for the housing.
    pub outer: Option<u16>,
    /// Entry as written.
    pub place: SupportPlace,
}

/// A clearance with its indices: gear states may close it.
#[derive(Debug, Clone, PartialEq)]
pub struct SeatedClearance {
    /// Id of the component.
    pub id: String,
    /// Path of the component.
    pub path: String,
    /// The two members; `None` for the housing.
    pub between: [Option<u16>; 2],
}

/// The pocket of a bearing as described, with the number of its oil.
#[derive(Debug, Clone)]
pub struct SeatedPocket {
    /// Path of the bearing.
    pub path: String,
    /// Entry as written.
    pub entry: PocketEntry,
    /// Number of its oil; after the spot of the bearing was found.
    pub oil: u16,
}

/// Assigns a number to an oil by lubricant and temperature offset, and computes how high a place is.
pub trait Places {
    /// Number of the oil of a lubricant with an offset; `None` and reported if the lubricant does not exist.
    fn oil(&mut self, path: &str, common: &Common) -> Option<u16>;
    /// How the oil height is computed at a position along a member's axis.
    fn level(&self, member: Option<u16>, at: f64) -> Level;
}

/// Supports, clearances and pockets in the order in which they were placed.
#[derive(Debug)]
pub(crate) struct Seated {
    pub supports: Vec<SeatedSupport>,
    pub clearances: Vec<SeatedClearance>,
    pub pockets: Vec<SeatedPocket>,
}

/// The names that a component may use while it is placed. Collects supports, clearances and findings.
pub struct Names<'a> {
    members: &'a [(String, Option<u16>)],
    places: &'a mut dyn Places,
    supports: Vec<SeatedSupport>,
    clearances: Vec<SeatedClearance>,
    pockets: Vec<SeatedPocket>,
    findings: Vec<Diagnostic>,
    path: String,
    id: String,
    site: (Option<u16>, f64),
    level: Option<Level>,
}

impl<'a> Names<'a> {
    /// Names of members, each with its index; `None` if the member itself has a fault that was reported.
    pub fn new(members: &'a [(String, Option<u16>)], places: &'a mut dyn Places) -> Self {
        Self {
            members,
            places,
            supports: Vec::new(),
            clearances: Vec::new(),
            pockets: Vec::new(),
            findings: Vec::new(),
            path: String::new(),
            id: String::new(),
            site: (None, 0.0),
            level: None,
        }
    }

    /// Starts the next component.
    pub(crate) fn turn_to(&mut self, section: &str, id: &str) {
        self.path = [section, ".", id].concat();
        id.clone_into(&mut self.id);
        self.site = (None, 0.0);
        self.level = None;
    }

    /// Path of the component.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// A member by its id. The outer `None`: reported. The inner `None`: the housing.
    pub fn side(&mut self, key: &str, id: &str) -> Option<Option<u16>> {
        if id == "housing" {
            Some(None)
        } else {
            self.member(key, id).map(Some)
        }
    }

    /// A member by its id; `None` and reported if it does not exist.
    pub fn member(&mut self, key: &str, id: &str) -> Option<u16> {
        if let Some((_, index)) = self.members.iter().find(|(name, _)| name == id) {
            *index
        } else {
            let ids: Vec<&str> = self.members.iter().map(|(name, _)| name.as_str()).collect();
            self.findings.push(dangling(
                &format!("{}.{key}", self.path),
                "shaft or idler gear",
                id,
                &ids,
            ));
            None
        }
    }

    fn lies(&mut self, member: Option<u16>, at: f64) {
        self.site = (member, at);
    }

    fn own_level(&mut self, level: Option<Level>) {
        self.level = level;
    }

    fn add_pocket(&mut self, entry: &PocketEntry) -> u16 {
        self.pockets.push(SeatedPocket {
            path: self.path.clone(),
            entry: entry.clone(),
            oil: 0,
        });
        (self.pockets.len() - 1) as u16
    }

    fn add_support(&mut self, inner: u16, outer: Option<u16>, place: &SupportPlace) -> u16 {
        self.supports.push(SeatedSupport {
            path: self.path.clone(),
            inner,
            outer,
            place: place.clone(),
        });
        (self.supports.len() - 1) as u16
    }

    fn add_clearance(&mut self, between: [Option<u16>; 2]) {
        self.clearances.push(SeatedClearance {
            id: self.id.clone(),
            path: self.path.clone(),
            between,
        });
    }

    /// Oil supply of the component; after it was placed.
    pub fn spot(&mut self, common: &Common) -> Option<Spot> {
        let oil = self.places.oil(&self.path, common)?;
        let level = self
            .level
            .unwrap_or_else(|| self.places.level(self.site.0, self.site.1));
        if let Some(pocket) = self.pockets.last_mut().filter(|pocket| pocket.path == self.path) {
            pocket.oil = oil;
        }
        Some(Spot {
            oil,
            level,
            supply: None,
        })
    }

    /// Adds a finding.
    pub fn report(&mut self, finding: Diagnostic) {
        self.findings.push(finding);
    }

    /// What was placed, and findings.
    pub(crate) fn finish(self) -> (Seated, Vec<Diagnostic>) {
        let seated = Seated {
            supports: self.supports,
            clearances: self.clearances,
            pockets: self.pockets,
        };
        (seated, self.findings)
    }
}

/// The error for an unknown id.
pub fn dangling(path: &str, what: &str, id: &str, ids: &[&str]) -> Diagnostic {
    let error = Diagnostic::error(path, format!("no {what} is called `{id}`")).code(codes::UNKNOWN_NAME);
    let error = if ids.is_empty() {
        error
    } else {
        error.note(format!("available: {}", ids.join(", ")))
    };
    // A near match of a short id is as often another component as a misspelling.
    let close = if id.len() > 2 {
        did_you_mean(id, ids.iter().copied())
    } else {
        None
    };
    match close {
        Some(close) => error.help(format!("write `{close}`")),
        None if ids.is_empty() => error.help(format!("none is defined: add `{id}`, or omit the name")),
        None => error.help(format!("use one of them, or add `{id}`")),
    }
}
