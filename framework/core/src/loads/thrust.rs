//! Distribution of thrust over the supports of one member.

use super::SupportLoad;
use super::layout::SupportLayout;
use crate::attach::Axial;

/// The thrust arrangement of one member, over its own supports.
#[derive(Debug, Clone)]
pub struct Taking {
    pub(super) supports: Vec<usize>,
    /// The two supports with a contact angle that load each other, which take thrust towards +x and -x, with their induced thrust
    /// per radial load.
    pub(super) pair: Option<[(usize, f64); 2]>,
    /// Supports with a spring and its force. \[N\]
    pub(super) springs: Vec<(usize, f64)>,
    /// Supports that take thrust towards -x and towards +x, with their shares of it.
    pub(super) takers: [Vec<(usize, f64)>; 2],
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

    /// Adds the axial load of each support for a thrust towards +x; returns the untaken thrust. `scale` is the magnitude of the
    /// forces in the sum of the thrust.
    pub fn share(&self, thrust: f64, scale: f64, loads: &mut [SupportLoad]) -> f64 {
        // Bearings with a contact angle load each other: the pair balances K + S_L against S_R.
        if let Some([(r, induced_r), (l, induced_l)]) = self.pair {
            let (s_r, s_l) = (induced_r * loads[r].radial, induced_l * loads[l].radial);
            let thrust = thrust + self.springs.iter().map(|s| s.1).sum::<f64>();
            if thrust + s_l >= s_r {
                loads[r].axial += thrust + s_l;
                loads[l].axial += s_l;
            } else {
                loads[r].axial += s_r;
                loads[l].axial += s_r - thrust;
            }
            return 0.0;
        }
        let mut rest = thrust;
        for (i, spring) in &self.springs {
            loads[*i].axial += spring.abs();
            rest += spring;
        }
        if rest.abs() <= 1e-9 * scale {
            return 0.0;
        }
        let takers = &self.takers[usize::from(rest > 0.0)];
        for (i, share) in takers {
            loads[*i].axial += rest.abs() * share;
        }
        if !takers.is_empty() {
            return 0.0;
        }
        for i in &self.supports {
            loads[*i].untaken = rest;
        }
        rest
    }
}

/// True if a support can take a thrust.
fn takes(support: &SupportLayout, right: bool) -> bool {
    matches!(
        (support.axial, right),
        (Axial::Both, _) | (Axial::Right, true) | (Axial::Left, false)
    )
}
