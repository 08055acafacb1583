//! Distribution of thrust over the supports of one member.

use super::SupportLoad;
use super::layout::SupportLayout;
use crate::attach::Axial;
use crate::real::Real;

/// The thrust arrangement of one member, over its own supports.
#[derive(Debug, Clone)]
pub(crate) struct Taking {
    supports: Vec<usize>,
    /// The two supports with a contact angle that load each other, which take thrust towards +x and -x, with their induced thrust
    /// per radial load.
    pair: Option<[(usize, f64); 2]>,
    /// Supports with a spring and its force. \[N\]
    springs: Vec<(usize, f64)>,
    /// Supports that take thrust towards -x and towards +x, with their shares of it.
    takers: [Vec<(usize, f64)>; 2],
}

impl Taking {
    /// The arrangement of a member with these supports.
    ///
    /// # Errors
    /// If several supports can take one thrust and no shares are stated: the supports, and true for a thrust towards +x.
    pub fn new(supports: &[(usize, SupportLayout)]) -> Result<Self, Vec<(Vec<usize>, bool)>> {
        let mut open = Vec::new();
        let takers = [false, true].map(|right| {
            let takers: Vec<&(usize, SupportLayout)> = supports.iter().filter(|(_, s)| takes(s, right)).collect();
            if takers.len() > 1 && takers.iter().any(|(_, s)| s.share.is_none()) {
                open.push((takers.iter().map(|(i, _)| *i).collect(), right));
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
        let pushes = |side: Axial| {
            let pushing = supports.iter().find(|(_, s)| s.axial == side && s.induced > 0.0);
            pushing.map(|(i, s)| (*i, s.induced))
        };
        Ok(Self {
            supports: supports.iter().map(|(i, _)| *i).collect(),
            pair: pushes(Axial::Right).zip(pushes(Axial::Left)).map(|(r, l)| [r, l]),
            springs: supports
                .iter()
                .filter(|(_, s)| s.spring != 0.0)
                .map(|(i, s)| (*i, s.spring))
                .collect(),
            takers,
        })
    }

    /// Supports of the member.
    pub fn supports(&self) -> &[usize] {
        &self.supports
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
        let rest = self.springs.iter().fold(thrust, |rest, (_, spring)| rest + *spring);
        // What is rounding error is no thrust.
        R::select(rest.abs().is_above(scale * 1e-9), rest, R::ZERO)
    }

    /// Adds the axial load of each support for a thrust towards +x, and the untaken thrust.
    #[inline(always)]
    pub fn share<R: Real>(&self, thrust: R, scale: R, loads: &mut [SupportLoad<R>]) {
        // Bearings with a contact angle load each other: the pair balances K + S_L against S_R.
        if let Some([(r, induced_r), (l, induced_l)]) = self.pair {
            let (s_r, s_l) = (loads[r].radial * induced_r, loads[l].radial * induced_l);
            let thrust = thrust + self.springs.iter().map(|s| s.1).sum::<f64>();
            let left = (thrust + s_l).is_below(s_r);
            loads[r].axial += R::select(left, s_r, thrust + s_l);
            loads[l].axial += R::select(left, s_r - thrust, s_l);
            return;
        }
        for (i, spring) in &self.springs {
            loads[*i].axial += R::constant(spring.abs());
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
