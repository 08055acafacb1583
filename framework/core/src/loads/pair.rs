//! Opposed bearings with a contact angle, adjusted without clearance: through the shaft, the thrust that the radial load of one induces
//! loads the other one.
//!
//! Source: the table of six cases that catalogues print for a thrust K and induced thrusts S. It is one law: the bearing that takes K has
//! the larger of its own S and of the other's S plus K, and the other one has that minus K. A ring on a spring floats: it has the force of
//! the spring, and the other bearing that and K. With a stated preload or end play the load distributions decide ([`StiffPair`]).

use super::layout::{LoadFault, SupportLayout};
use super::stiff_pair::StiffPair;
use crate::attach::Axial;
use crate::real::{Points, Real};

/// Supports of a member that take its thrust towards -x and towards +x and load each other. Usually there is one on each side.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The member that they carry.
    pub member: usize,
    /// Those that take thrust of the member towards -x, and those that take it towards +x.
    pub sides: [Vec<PairedSupport>; 2],
    /// The support whose ring is on a spring.
    pub spring: Option<PairSpring>,
    /// Both bearings, one on each side, if they are adjusted with a stated preload.
    pub stiff: Option<StiffPair>,
}

/// A support of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairedSupport {
    /// Its number.
    pub support: usize,
    /// Thrust that its radial load induces, per radial load.
    pub induced: f64,
    /// Its share of the axial load of its side.
    pub share: f64,
}

/// A spring that presses a ring of a pair against its rolling elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSpring {
    /// Side of the ring: 0 takes thrust towards -x, 1 towards +x.
    pub side: usize,
    /// Number of the support.
    pub support: usize,
    /// Force of the spring, positive. \[N\]
    pub force: f64,
}

/// Loads of a pair, before load factors; of two sides, the first takes thrust towards -x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairLoads<R = f64> {
    /// Thrust of the member towards +x. \[N\]
    pub thrust: R,
    /// Thrust that the radial loads of each side induce. \[N\]
    pub induced: [R; 2],
    /// Axial load of each side. \[N\]
    pub axial: [R; 2],
}

impl Pair {
    /// The pair of a member with these supports, of which `takers` take thrust towards -x and towards +x, with their shares. `None` unless
    /// there are some on both sides, each takes one direction, the induced thrust of all is known, and there is any.
    ///
    /// # Errors
    /// If springs do not press exactly one ring, alone on its side, against its rolling elements.
    pub(super) fn new(
        member: usize,
        supports: &[(usize, SupportLayout)],
        takers: &[Vec<(usize, f64)>; 2],
    ) -> Result<Option<Self>, LoadFault> {
        let paired = |side: &Vec<(usize, f64)>| -> Option<Vec<PairedSupport>> {
            let known = side.iter().map(|(support, share)| {
                let (_, seat) = supports.iter().find(|(number, _)| number == support)?;
                let induced = seat.induced.filter(|_| seat.axial != Axial::Both)?;
                Some(PairedSupport {
                    support: *support,
                    induced,
                    share: *share,
                })
            });
            known.collect::<Option<Vec<_>>>().filter(|side| !side.is_empty())
        };
        let [Some(left), Some(right)] = takers.each_ref().map(paired) else {
            return Ok(None);
        };
        let sides = [left, right];
        if sides.iter().flatten().all(|paired| paired.induced == 0.0) {
            return Ok(None);
        }
        let spring = Self::spring(member, supports, &sides)?;
        let row = |side: &Vec<PairedSupport>| {
            let [own] = side[..] else { return None };
            supports.iter().find(|(number, _)| *number == own.support)?.1.preloaded
        };
        let stiff = match sides.each_ref().map(row) {
            [Some(left), Some(right)] => Some(StiffPair { rows: [left, right] }),
            _ => None,
        };
        Ok(Some(Self {
            member,
            sides,
            spring,
            stiff,
        }))
    }

    fn spring(
        member: usize,
        supports: &[(usize, SupportLayout)],
        sides: &[Vec<PairedSupport>; 2],
    ) -> Result<Option<PairSpring>, LoadFault> {
        let sprung = supports.iter().filter(|(_, seat)| seat.spring != 0.0);
        let side_of = |support: &usize| {
            let has = |side: &Vec<PairedSupport>| side.iter().any(|paired| paired.support == *support);
            sides.iter().position(has)
        };
        let sprung: Vec<(usize, f64, usize)> = sprung
            .filter_map(|(support, seat)| Some((*support, seat.spring, side_of(support)?)))
            .collect();
        match sprung[..] {
            [] => Ok(None),
            [(support, force, side)] => {
                // A ring that takes thrust towards -x can push the member towards +x only.
                let presses = (force > 0.0) == (side == 0);
                if presses && sides[side].len() == 1 {
                    return Ok(Some(PairSpring {
                        side,
                        support,
                        force: force.abs(),
                    }));
                }
                let supports = sides[side].iter().map(|paired| paired.support).collect();
                Err(if presses {
                    LoadFault::SpringOfSeveral { support, supports }
                } else {
                    LoadFault::SpringLifts { support }
                })
            }
            [..] => Err(LoadFault::SeveralSprings {
                member,
                supports: sprung.into_iter().map(|(support, ..)| support).collect(),
            }),
        }
    }

    /// The loads under a thrust of the member towards +x (N), at a closing (m) that matters with a stated preload, and the radial load of each
    /// support (N).
    #[inline(always)]
    pub fn loads<R: Points>(&self, thrust: R, closing: R, radial: impl Fn(usize) -> R) -> PairLoads<R> {
        let [left, right] = [0, 1].map(|side| {
            let paired = self.sides[side].iter();
            paired.fold(R::ZERO, |sum, paired| sum + radial(paired.support) * paired.induced)
        });
        let axial = match (&self.stiff, self.spring) {
            (Some(stiff), _) => {
                let radial = [0, 1].map(|side| radial(self.sides[side][0].support));
                stiff.axial(thrust, radial, closing)
            }
            (None, Some(PairSpring { side: 0, force, .. })) => {
                [(-thrust).at_least(force), (thrust + force).at_least(0.0)]
            }
            (None, Some(PairSpring { force, .. })) => [(-thrust + force).at_least(0.0), thrust.at_least(force)],
            (None, None) => {
                let pushed = (thrust + left).is_below(right);
                [
                    R::select(pushed, right - thrust, left),
                    R::select(pushed, right, thrust + left),
                ]
            }
        };
        PairLoads {
            thrust,
            induced: [left, right],
            axial,
        }
    }
}

impl PairLoads {
    /// The part of the axial load of either side that induced thrust or a spring adds to the thrust of the member. \[N\]
    pub fn mutual(&self) -> f64 {
        self.axial[0].min(self.axial[1])
    }
}

impl<R: Real> PairLoads<R> {
    /// By how much the axial load of each side exceeds the thrust that its radial loads induce. Below zero less than about half of the
    /// rolling elements carry; a spring permits it. The spring force alone counts for the side of the spring. \[N\]
    pub fn reserve(&self, spring: PairSpring) -> [R; 2] {
        let along = if spring.side == 0 { self.thrust } else { -self.thrust };
        let sprung = -self.induced[spring.side] + spring.force;
        let other = along - self.induced[1 - spring.side] + spring.force;
        if spring.side == 0 {
            [sprung, other]
        } else {
            [other, sprung]
        }
    }
}
