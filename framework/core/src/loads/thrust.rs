//! Distribution of thrust over the supports of one member.

use super::SupportLoad;
use super::layout::{LoadFault, SupportLayout};
use super::pair::Pair;
use crate::attach::Axial;
use crate::real::{Points, Real};

/// The thrust arrangement of one member, over its own supports.
#[derive(Debug, Clone)]
pub(crate) struct Taking {
    supports: Vec<usize>,
    /// Those with a contact angle that load each other.
    pair: Option<Pair>,
    /// Supports with a spring and its force, without the spring of the pair. \[N\]
    springs: Vec<(usize, f64)>,
    /// Supports that take thrust towards -x and towards +x, with their shares of it.
    takers: [Vec<(usize, f64)>; 2],
}

impl Taking {
    /// The arrangement of a member with these supports.
    ///
    /// # Errors
    /// If several supports can take one thrust and no shares are stated, or if springs do not fit a pair.
    pub fn new(member: usize, supports: &[(usize, SupportLayout)]) -> Result<Self, Vec<LoadFault>> {
        let mut open = Vec::new();
        let takers = [false, true].map(|right| {
            let takers: Vec<&(usize, SupportLayout)> = supports.iter().filter(|(_, s)| takes(s, right)).collect();
            if takers.len() > 1 && takers.iter().any(|(_, s)| s.share.is_none()) {
                open.push(LoadFault::AxialIndeterminate {
                    member,
                    supports: takers.iter().map(|(i, _)| *i).collect(),
                    right,
                });
            }
            let whole: f64 = takers.iter().map(|(_, s)| s.share.unwrap_or(1.0)).sum();
            takers
                .iter()
                .map(|(i, s)| (*i, s.share.unwrap_or(1.0) / whole))
                .collect()
        });
        // Thrust towards +x is reported before thrust towards -x.
        open.reverse();
        if !open.is_empty() {
            return Err(open);
        }
        let pair = Pair::new(member, supports, &takers).map_err(|fault| vec![fault])?;
        let of_pair = pair.as_ref().and_then(|pair| pair.spring).map(|spring| spring.support);
        let springs = supports.iter().filter(|(i, s)| s.spring != 0.0 && Some(*i) != of_pair);
        Ok(Self {
            supports: supports.iter().map(|(i, _)| *i).collect(),
            springs: springs.map(|(i, s)| (*i, s.spring)).collect(),
            pair,
            takers,
        })
    }

    /// Supports of the member.
    pub fn supports(&self) -> &[usize] {
        &self.supports
    }

    /// The supports that load each other.
    pub fn pair(&self) -> Option<&Pair> {
        self.pair.as_ref()
    }

    /// A thrust towards +x with the forces of springs on the member.
    #[inline(always)]
    pub fn with_springs<R: Real>(&self, thrust: R) -> R {
        self.springs.iter().fold(thrust, |sum, (_, spring)| sum + *spring)
    }

    /// The thrust towards +x that no support takes. `scale` is the magnitude of the forces in the sum of the thrust.
    #[inline(always)]
    pub fn untaken<R: Real>(&self, thrust: R, scale: R) -> R {
        if self.pair.is_some() {
            return R::ZERO;
        }
        let rest = self.rest(thrust, scale);
        let [left, right] = [-rest, rest].map(|own| own.at_least(0.0));
        match &self.takers {
            [l, r] if l.is_empty() && r.is_empty() => rest,
            [l, _] if l.is_empty() => -left,
            [_, r] if r.is_empty() => right,
            _ => R::ZERO,
        }
    }

    /// The thrust that springs leave.
    #[inline(always)]
    fn rest<R: Real>(&self, thrust: R, scale: R) -> R {
        let rest = self.with_springs(thrust);
        // What is rounding error is no thrust.
        R::select(rest.abs().is_above(scale * 1e-9), rest, R::ZERO)
    }

    /// Adds the axial load of each support for a thrust towards +x, and the untaken thrust. `closings` are those of pairs with a stated preload,
    /// by member. \[m\]
    #[inline(always)]
    pub fn share<R: Points>(&self, thrust: R, scale: R, closings: &[R], loads: &mut [SupportLoad<R>]) {
        for (i, spring) in &self.springs {
            loads[*i].axial += R::constant(spring.abs());
        }
        if let Some(pair) = &self.pair {
            let closing = closings.get(pair.member).copied().unwrap_or(R::ZERO);
            let totals = pair
                .loads(self.with_springs(thrust), closing, |support| loads[support].radial)
                .axial;
            for (side, total) in pair.sides.iter().zip(totals) {
                for paired in side {
                    loads[paired.support].axial += total * paired.share;
                }
            }
            return;
        }
        let rest = self.rest(thrust, scale);
        for (takers, own) in self.takers.iter().zip([-rest, rest]) {
            for (i, share) in takers {
                loads[*i].axial += own.at_least(0.0) * *share;
            }
        }
        let untaken = self.untaken(thrust, scale);
        for i in &self.supports {
            loads[*i].untaken = untaken;
        }
    }
}

/// True if a support can take a thrust.
fn takes(support: &SupportLayout, right: bool) -> bool {
    matches!(
        (support.axial, right),
        (Axial::Both, _) | (Axial::Right, true) | (Axial::Left, false)
    )
}
