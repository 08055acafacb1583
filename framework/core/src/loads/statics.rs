//! Reactions of one member to forces, from statics or a beam.

use super::beam::{Beam, BeamFault, BeamLoad, BeamSupport};
use super::layout::{LoadFault, MemberLayout, SupportLayout};

/// A force at a position, with its arm from the axis, and a couple.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Action {
    /// Position along the shaft. \[m\]
    pub at: f64,
    /// Arm from the axis in y and z. \[m\]
    pub arm: [f64; 2],
    /// Force in x, y, z. \[N\]
    pub force: [f64; 3],
    /// Moment about y and z in addition to that of the force. \[Nm\]
    pub moment: [f64; 2],
}

impl Action {
    /// The load in the plane of y (1) or of z (2).
    pub fn in_plane(&self, axis: usize) -> BeamLoad {
        let [my, mz] = self.couple();
        BeamLoad {
            at: self.at,
            force: self.force[axis],
            // The slope in the plane of z is minus the rotation about y.
            moment: if axis == 1 { mz } else { -my },
        }
    }

    /// Couple of the axial force about y and z, with the free moment. \[Nm\]
    pub fn couple(&self) -> [f64; 2] {
        [
            self.moment[0] + self.arm[1] * self.force[0],
            self.moment[1] - self.arm[0] * self.force[0],
        ]
    }
}

/// Reaction of one support on a member: force in y and z, couple about y and z.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Reaction {
    /// Force on the member. \[N\]
    pub force: [f64; 2],
    /// Couple on the member. \[Nm\]
    pub couple: [f64; 2],
}

/// Static system of a member.
#[derive(Debug, Clone)]
pub(crate) enum Statics {
    /// No support.
    None,
    /// One support takes force and couple.
    One {
        /// Position. \[m\]
        at: f64,
    },
    /// Two supports.
    Two {
        /// Positions. \[m\]
        at: [f64; 2],
    },
    /// A beam on several supports.
    Beam(Box<Beam>),
}

impl Statics {
    /// Selects the static system of a member from its supports.
    pub fn new(
        number: usize,
        member: &MemberLayout,
        supports: &[(usize, SupportLayout)],
        actions: &[f64],
    ) -> Result<Self, LoadFault> {
        let mechanism = || LoadFault::Mechanism {
            member: number,
            supports: supports.iter().map(|s| s.0).collect(),
        };
        match supports {
            [] => Ok(Self::None),
            [(_, only)]
                if member.loose || member.planet.is_some() || only.takes_moment || only.tilting_stiffness.is_some() =>
            {
                Ok(Self::One { at: only.at })
            }
            [_] => Err(mechanism()),
            [(_, a), (_, b)]
                if member.hinges.is_empty() && a.tilting_stiffness.is_none() && b.tilting_stiffness.is_none() =>
            {
                if (b.at - a.at).abs() < 1e-6 {
                    Err(mechanism())
                } else {
                    Ok(Self::Two { at: [a.at, b.at] })
                }
            }
            _ => {
                let beam_supports: Vec<BeamSupport> = supports.iter().map(|(_, s)| BeamSupport::of(s)).collect();
                match Beam::new(&member.sections, &beam_supports, &member.hinges, actions, member.shear) {
                    Ok(beam) => Ok(Self::Beam(Box::new(beam))),
                    Err(BeamFault::Mechanism) => Err(mechanism()),
                    Err(BeamFault::NoSection(range)) => Err(LoadFault::NoSection { member: number, range }),
                    Err(BeamFault::MomentAtHinge(at)) => Err(LoadFault::MomentAtHinge { member: number, at }),
                }
            }
        }
    }

    /// Reactions of the supports, in their order.
    pub fn reactions(&self, actions: &[Action]) -> Vec<Reaction> {
        let total = |axis: usize| actions.iter().map(|a| a.force[axis]).sum::<f64>();
        let couple_about = |at: f64| {
            actions.iter().fold([0.0; 2], |sum, a| {
                let own = a.couple();
                [
                    sum[0] + own[0] - (a.at - at) * a.force[2],
                    sum[1] + own[1] + (a.at - at) * a.force[1],
                ]
            })
        };
        match self {
            Self::None => Vec::new(),
            Self::One { at } => {
                let couple = couple_about(*at);
                vec![Reaction {
                    force: [-total(1), -total(2)],
                    couple: [-couple[0], -couple[1]],
                }]
            }
            Self::Two { at: [a, b] } => {
                let [my, mz] = couple_about(*a);
                let length = b - a;
                let second = [-mz / length, my / length];
                let first = [-total(1) - second[0], -total(2) - second[1]];
                vec![
                    Reaction {
                        force: first,
                        couple: [0.0; 2],
                    },
                    Reaction {
                        force: second,
                        couple: [0.0; 2],
                    },
                ]
            }
            Self::Beam(beam) => {
                let plane = |axis: usize| -> Vec<BeamLoad> { actions.iter().map(|a| a.in_plane(axis)).collect() };
                let (y, z) = (beam.reactions(&plane(1)), beam.reactions(&plane(2)));
                y.iter()
                    .zip(&z)
                    .map(|(y, z)| Reaction {
                        force: [y.force, z.force],
                        couple: [-z.moment, y.moment],
                    })
                    .collect()
            }
        }
    }
}
