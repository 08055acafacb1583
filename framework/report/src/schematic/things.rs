//! The things to draw, in m, from the transmission and its resolved description.

mod read;

use serde_json::Value;

use gearloss_framework::transmission::Transmission;
use read::{axles, chains, members, parts, spread, wheels};

/// The support of a member.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A shaft, a carrier or a ring: turns about a fixed axis.
    Shaft,
    /// An idler gear on a shaft.
    Loose(usize),
    /// A planet body on a carrier.
    Planet(usize),
}

/// Something that turns.
#[derive(Debug)]
pub(super) struct Member {
    pub name: String,
    pub kind: Kind,
    /// Index of the axis; for a planet body the axis of its carrier.
    pub line: usize,
    /// Number of equal copies.
    pub count: f64,
}

/// A gear.
#[derive(Debug)]
pub(super) struct Wheel {
    pub id: String,
    pub member: usize,
    /// Middle of the face. \[m\]
    pub at: f64,
    /// Displacement along the axis in the drawing of a gear without a stated position. \[m\]
    pub moved: f64,
    pub width: f64,
    /// Tip radius. \[m\]
    pub radius: f64,
    pub ring: bool,
    pub z: u32,
    /// False if position or diameter are not stated.
    pub stated: bool,
}

/// Two gears in mesh.
#[derive(Debug)]
pub(super) struct Contact {
    pub gears: [usize; 2],
    /// True if one of them is a planet.
    pub carried: bool,
}

/// Symbol of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Symbol {
    /// Crossed squares.
    Bearing,
    /// Triangles.
    Seal,
    /// A sleeve between two members.
    Sleeve,
    /// Plates between two members.
    Clutch,
    /// A circle: pumps and components of mechanisms of other crates.
    Other,
}

/// A component on a member or between two.
#[derive(Debug)]
pub(super) struct Part {
    /// Path, such as `bearings.B1`.
    pub path: String,
    pub id: String,
    pub symbol: Symbol,
    /// Inner and outer member; absent for the housing.
    pub between: [Option<usize>; 2],
    /// Position along the shafts if it is stated. \[m\]
    pub at: Option<f64>,
    /// Width and radial height if they are known. \[m\]
    pub size: [Option<f64>; 2],
    /// Number of equal copies.
    pub count: f64,
}

/// A differential.
#[derive(Debug)]
pub(super) struct Axle {
    pub id: String,
    pub case: usize,
    pub sides: [usize; 2],
}

/// A chain or belt.
#[derive(Debug)]
pub(super) struct Strand {
    pub id: String,
    pub members: [usize; 2],
    /// Position along the shafts. \[m\]
    pub at: f64,
    /// Radii of both wheels; a usual one if they are not known. \[m\]
    pub radii: [f64; 2],
    /// What it is, with its teeth or ratio.
    pub what: String,
}

/// Everything that is drawn.
#[derive(Debug)]
pub(super) struct Things {
    pub members: Vec<Member>,
    pub lines: usize,
    pub wheels: Vec<Wheel>,
    pub contacts: Vec<Contact>,
    pub parts: Vec<Part>,
    pub axles: Vec<Axle>,
    pub chains: Vec<Strand>,
    /// Name and member.
    pub ports: Vec<(String, usize)>,
    pub reference: usize,
}

/// Name and member of every port on its shaft; ports of `wheels` are separate.
fn ports(transmission: &Transmission) -> Vec<(String, usize)> {
    let ports = transmission.ports().iter();
    let ports = ports.filter(|p| p.member < transmission.members().len());
    let all = ports.chain(transmission.wheels());
    all.map(|p| (p.name.clone(), p.member)).collect()
}

impl Things {
    pub(super) fn new(transmission: &Transmission, resolved: &Value) -> Self {
        let (members, lines) = members(transmission, resolved);
        let mut wheels = wheels(transmission);
        let contacts: Vec<Contact> = transmission
            .mesh_seats()
            .map(|(gears, carried)| Contact { gears, carried })
            .collect();
        spread(&mut wheels, &contacts, &members);
        let parts = parts(&members, &wheels, resolved);
        let axles = axles(&members, resolved);
        let chains = chains(&members, resolved);
        Self {
            parts,
            axles,
            chains,
            members,
            lines,
            wheels,
            contacts,
            ports: ports(transmission),
            reference: transmission.reference_port(),
        }
    }

    /// The shaft that a member turns on: itself, or the shaft of an idler gear.
    pub(super) fn shaft_of(&self, member: usize) -> usize {
        match self.members[member].kind {
            Kind::Loose(shaft) => shaft,
            _ => member,
        }
    }

    /// Index of the first gear of a member.
    pub(super) fn wheel_of(&self, member: usize) -> Option<usize> {
        self.wheels.iter().position(|w| w.member == member)
    }

    /// True for a body with only rings and brakes: it needs no shaft.
    pub(super) fn floats(&self, member: usize) -> bool {
        let wheels = || self.wheels.iter().filter(|w| w.member == member);
        let on_shaft =
            |p: &Part| p.between.contains(&Some(member)) && (p.symbol == Symbol::Bearing || !p.between.contains(&None));
        wheels().count() > 0
            && wheels().all(|w| w.ring)
            && !self.ports.iter().any(|p| p.1 == member)
            && !self.parts.iter().any(on_shaft)
            && !self.in_axle(member)
    }

    /// True for the case or a side of a differential.
    pub(super) fn in_axle(&self, member: usize) -> bool {
        let of = |a: &Axle| a.case == member || a.sides.contains(&member);
        self.axles.iter().any(of)
    }

    /// True for a planet body.
    pub(super) fn is_planet(&self, member: usize) -> bool {
        matches!(self.members[member].kind, Kind::Planet(_))
    }
}
