//! Opposed bearings with a contact angle: which load each other, and which induced thrust is not in the loads.

use super::members::Members;
use super::preloads::{PairPreload, Preloading};
use crate::attach::{Axial, SeatedSupport, Stiffness, SupportPlace};
use crate::codes;
use crate::document::Diagnostic;
use crate::loads::{
    AngularRow, Carries, Induced, InducedBasis, InducedThrust, Layout, Mounting, PairSpring, ShaftLoads,
};

/// What the design of a support determines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Design {
    /// Its name in messages.
    pub name: String,
    /// The loads that it can carry.
    pub carries: Carries,
    /// The thrust that its radial load induces.
    pub induced: Induced,
    /// How it is displaced by an axial load, or why this is not known; `None` without a preload in the gearbox.
    pub row: Option<Result<AngularRow, String>>,
    /// Each [`Stiffness`] at the load that it states, or why this is not known; `None` if it states none.
    pub stiffness: [Option<Result<f64, String>>; 2],
}

impl Default for Design {
    fn default() -> Self {
        Self {
            name: String::new(),
            carries: Carries::ANY,
            induced: Induced::None,
            row: None,
            stiffness: [None, None],
        }
    }
}

impl Design {
    /// A stiffness at the load that is stated for it.
    pub fn stiffness(&self, stiffness: Stiffness) -> Option<&Result<f64, String>> {
        let [radial, tilting] = &self.stiffness;
        match stiffness {
            Stiffness::Radial => radial.as_ref(),
            Stiffness::Tilting => tilting.as_ref(),
        }
    }

    /// The thrust that a radial load induces, as stated or by the design; `None` without contact angle or if it is not known.
    pub fn induced_thrust(&self, place: &SupportPlace) -> Option<InducedThrust> {
        let stated = place.induced_thrust.map(|ratio| InducedThrust {
            ratio,
            basis: InducedBasis::Stated,
        });
        stated.or(match self.induced {
            Induced::Known(known) => Some(known),
            Induced::None | Induced::Unknown { .. } => None,
        })
    }
}

/// Opposed bearings that load each other by the thrust that their radial loads induce, by a spring, or by a preload.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingPair {
    /// Number of the shaft or gear that they carry.
    pub member: usize,
    /// Those that take its thrust towards -x, and those that take it towards +x.
    pub sides: [Vec<PairedBearing>; 2],
    /// How they are mounted; `None` if their positions do not tell.
    pub mounting: Option<Mounting>,
    /// The spring on one of them.
    pub spring: Option<PairSpring>,
    /// Their stated preload or end play.
    pub preload: Option<PairPreload>,
}

/// A bearing of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairedBearing {
    /// Number of its support.
    pub support: usize,
    /// Thrust per radial load.
    pub induced: InducedThrust,
    /// Share of the axial load of its side.
    pub share: f64,
}

/// How some bearings are mounted; `None` if their positions do not tell.
fn mounting<'a>(places: impl Iterator<Item = &'a SupportPlace>) -> Option<Mounting> {
    let (mut left, mut right) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
    for place in places {
        let range = if place.axial == Axial::Left {
            &mut left
        } else {
            &mut right
        };
        *range = [range[0].min(place.at), range[1].max(place.at)];
    }
    if left[1] < right[0] {
        Some(Mounting::FaceToFace)
    } else if right[1] < left[0] {
        Some(Mounting::BackToBack)
    } else {
        None
    }
}

impl BearingPair {
    /// All pairs; reports what is wrong with their preloads.
    pub(super) fn all(loads: &ShaftLoads, preloading: &Preloading<'_>, found: &mut Vec<Diagnostic>) -> Vec<Self> {
        let Preloading { supports, designs, .. } = preloading;
        let pairs = loads.pairs().map(|pair| {
            let bearing = |paired: &crate::loads::PairedSupport| {
                let own = |basis| InducedThrust {
                    ratio: paired.induced,
                    basis,
                };
                let design = &designs[paired.support];
                PairedBearing {
                    support: paired.support,
                    induced: match (&pair.stiff, &design.row) {
                        (Some(_), Some(Ok(row))) => own(InducedBasis::HalfLoaded(row.row.contact_angle)),
                        _ => design
                            .induced_thrust(&supports[paired.support].place)
                            .unwrap_or(own(InducedBasis::Stated)),
                    },
                    share: paired.share,
                }
            };
            let mounting = mounting(pair.sides.iter().flatten().map(|own| &supports[own.support].place));
            Self {
                member: pair.member,
                sides: pair.sides.each_ref().map(|side| side.iter().map(bearing).collect()),
                mounting,
                spring: pair.spring,
                preload: PairPreload::new(pair, mounting, preloading, found),
            }
        });
        pairs.collect()
    }

    /// Its bearings, those that take thrust towards -x first.
    pub fn bearings(&self) -> impl Iterator<Item = &PairedBearing> {
        self.sides.iter().flatten()
    }

    /// Numbers of their supports.
    pub fn supports(&self) -> impl Iterator<Item = usize> {
        self.bearings().map(|bearing| bearing.support)
    }

    /// The side of a support.
    pub fn side_of(&self, support: usize) -> Option<usize> {
        self.sides
            .iter()
            .position(|side| side.iter().any(|bearing| bearing.support == support))
    }

    /// Supports with a cell of notes: with a spring or a preload, the first of each side.
    pub fn noted(&self) -> impl Iterator<Item = usize> {
        let is_noted = self.spring.is_some() || self.preload.is_some();
        let sides = self.sides.iter().filter(move |_| is_noted);
        sides.filter_map(|side| side.first()).map(|bearing| bearing.support)
    }

    /// What its preload may not be as meant.
    pub(super) fn warnings(&self, preloading: &Preloading<'_>) -> Vec<Diagnostic> {
        let numbers = self
            .sides
            .each_ref()
            .map(|side| side.first().map_or(0, |own| own.support));
        let preload = self.preload.iter();
        preload
            .flat_map(|preload| preload.warnings(numbers, preloading))
            .collect()
    }

    /// Number of its cells of notes.
    pub(super) fn cells(&self) -> usize {
        self.noted().count()
    }
}

/// Bearings whose induced thrust may not be in the loads.
pub(super) struct NotCounted<'a> {
    supports: &'a [SeatedSupport],
    designs: &'a [Design],
    /// The member that each support carries.
    carried: Vec<usize>,
}

/// Why a bearing is in no pair.
enum Obstacle<'a> {
    /// Nothing takes the opposite thrust.
    NoOpponent,
    /// A bearing that takes thrust in both directions.
    BothWays(&'a SeatedSupport),
    /// A bearing whose induced thrust is not known, or that has no contact angle.
    Lacks(usize),
}

impl<'a> NotCounted<'a> {
    pub fn new(layout: &Layout, supports: &'a [SeatedSupport], designs: &'a [Design]) -> Self {
        let carried = layout.supports.iter().map(|support| layout.carried(support).0);
        Self {
            supports,
            designs,
            carried: carried.collect(),
        }
    }

    /// Reports induced thrust that is not in the loads: stated ones as errors, others as warnings.
    pub fn report(
        &self,
        loads: &ShaftLoads,
        members: &Members,
        found: &mut Vec<Diagnostic>,
        warnings: &mut Vec<Diagnostic>,
    ) {
        let mut paired = vec![false; self.supports.len()];
        for support in loads.pairs().flat_map(|pair| pair.sides.iter().flatten()) {
            paired[support.support] = true;
        }
        for (number, support) in self.supports.iter().enumerate().filter(|(number, _)| !paired[*number]) {
            match (support.place.induced_thrust, self.designs[number].induced) {
                // Zero states that none is to be counted.
                (Some(0.0), _) | (None, Induced::None) => {}
                (Some(_), _) => found.push(self.stated(number, members)),
                (None, Induced::Known(_)) => warnings.extend(self.known(number, members)),
                (None, Induced::Unknown { why, help }) => warnings.extend(self.unknown(number, why, help)),
            }
        }
    }

    /// The error that a stated thrust has no effect.
    fn stated(&self, number: usize, members: &Members) -> Diagnostic {
        let support = &self.supports[number];
        let error = |why: &str| {
            Diagnostic::error(
                format!("{}.induced_thrust", support.path),
                format!("this induced thrust loads no other bearing: {why}"),
            )
        };
        if matches!(support.place.axial, Axial::None | Axial::Both) {
            return error("the bearing has no `axial: left` or `axial: right`")
                .help("state the direction of thrust that it takes, or remove `induced_thrust`");
        }
        let (why, help) = self.words(number, members);
        error(&why).help(format!("{help}; or remove `induced_thrust` here"))
    }

    /// The warning that a thrust by design is not counted, unless another finding says it.
    fn known(&self, number: usize, members: &Members) -> Option<Diagnostic> {
        match self.supports[number].place.axial {
            // Reported as more thrust than it can carry.
            Axial::Both => return None,
            Axial::None => return Some(self.without_direction(number)),
            Axial::Left | Axial::Right => {}
        }
        if let Obstacle::Lacks(other) = self.obstacle(number)
            && matches!(self.designs[other].induced, Induced::Unknown { .. })
        {
            return None;
        }
        let (why, help) = self.words(number, members);
        Some(self.warning(number, &why).help(format!(
            "{help}; or write `induced_thrust: 0` here to leave its thrust out"
        )))
    }

    /// The warning that a thrust is not known.
    fn unknown(&self, number: usize, why: &str, help: &'static str) -> Option<Diagnostic> {
        match self.supports[number].place.axial {
            Axial::Both => None,
            Axial::None => Some(self.without_direction(number)),
            Axial::Left | Axial::Right => Some(self.warning(number, why).help(help)),
        }
    }

    fn without_direction(&self, number: usize) -> Diagnostic {
        self.warning(number, "the bearing has `axial: none`").help(
            "write `axial: left` or `axial: right`, the opposite of its partner; or `induced_thrust: 0` to leave its thrust out",
        )
    }

    fn warning(&self, number: usize, why: &str) -> Diagnostic {
        let (support, name) = (&self.supports[number], &self.designs[number].name);
        Diagnostic::warning(
            support.path.clone(),
            format!("the thrust that the radial load of `{name}` induces is not in the loads: {why}"),
        )
        .code(codes::INDUCED)
    }

    /// What is in the way of a pair, and what would remove it.
    fn words(&self, number: usize, members: &Members) -> (String, String) {
        let opposite = self.supports[number].place.axial.opposite();
        let [forwards, back] = members.frames[self.carried[number]].senses();
        let (side, key) = if opposite == Axial::Left {
            (back, "left")
        } else {
            (forwards, "right")
        };
        match self.obstacle(number) {
            Obstacle::NoOpponent => (
                format!(
                    "no bearing takes thrust of `{}` towards {side}",
                    members.names[usize::from(self.supports[number].inner)]
                ),
                format!("write `axial: {key}` at the bearing that opposes it"),
            ),
            Obstacle::BothWays(other) => (
                format!("`{}` takes thrust in both directions", other.path),
                "write `axial: left` or `axial: right` there, if it opposes this bearing, else `axial: none`"
                    .to_owned(),
            ),
            Obstacle::Lacks(other) => (
                format!("`{}` has no known induced thrust", self.supports[other].path),
                "state `induced_thrust` there, 0 of a bearing without contact angle: then they are a pair".to_owned(),
            ),
        }
    }

    /// What is in the way of a pair.
    fn obstacle(&self, number: usize) -> Obstacle<'a> {
        let same_member = |other: &usize| self.carried[*other] == self.carried[number];
        let takers: Vec<usize> = (0..self.supports.len())
            .filter(same_member)
            .filter(|other| self.supports[*other].place.axial != Axial::None)
            .collect();
        let place = |other: &usize| &self.supports[*other].place;
        if let Some(both) = takers.iter().find(|other| place(other).axial == Axial::Both) {
            return Obstacle::BothWays(&self.supports[*both]);
        }
        // `axial` is that of the member in the bore, which need not be the carried one.
        let takes = |other: &usize| {
            let in_bore = usize::from(self.supports[*other].inner) == self.carried[*other];
            let axial = place(other).axial;
            if in_bore { axial } else { axial.opposite() }
        };
        if !takers.iter().any(|other| takes(other) == takes(&number).opposite()) {
            return Obstacle::NoOpponent;
        }
        let lacks = takers
            .iter()
            .find(|other| self.designs[**other].induced_thrust(place(other)).is_none());
        lacks.map_or(Obstacle::NoOpponent, |other| Obstacle::Lacks(*other))
    }
}
