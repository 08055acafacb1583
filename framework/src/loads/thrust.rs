//! How the supports of one member share its thrust.

use super::layout::SupportLayout;
use crate::attach::Axial;

/// The thrust arrangement of one member, over its own supports.
#[derive(Debug, Clone)]
pub struct Taking {
    /// Own number, which thrust, share and spring of each support.
    pub supports: Vec<(usize, SupportLayout)>,
}

impl Taking {
    fn takes(support: &SupportLayout, right: bool) -> bool {
        matches!(
            (support.axial, right),
            (Axial::Both, _) | (Axial::Right, true) | (Axial::Left, false)
        )
    }

    /// Supports that could take a thrust, where there are several and no shares are stated.
    pub fn indeterminate(&self, right: bool) -> Option<Vec<usize>> {
        let takers: Vec<&(usize, SupportLayout)> =
            self.supports.iter().filter(|(_, s)| Self::takes(s, right)).collect();
        let unshared = takers.len() > 1 && takers.iter().any(|(_, s)| s.share.is_none());
        unshared.then(|| takers.iter().map(|(i, _)| *i).collect())
    }

    /// Writes the axial load of each support for a thrust towards +x and the radial loads; returns thrust that nothing
    /// takes. `write(support, load)` adds to the load of a support.
    pub fn share(
        &self,
        thrust: f64,
        scale: f64,
        radial: impl Fn(usize) -> f64,
        mut write: impl FnMut(usize, f64),
    ) -> f64 {
        // Bearings with a contact angle push each other: the pair balances K + S_L against S_R.
        let pair = |side: Axial| self.supports.iter().find(|(_, s)| s.axial == side && s.induced > 0.0);
        if let (Some((r, right)), Some((l, left))) = (pair(Axial::Right), pair(Axial::Left)) {
            let (s_r, s_l) = (right.induced * radial(*r), left.induced * radial(*l));
            let thrust = thrust + self.supports.iter().map(|(_, s)| s.spring).sum::<f64>();
            if thrust + s_l >= s_r {
                write(*r, thrust + s_l);
                write(*l, s_l);
            } else {
                write(*r, s_r);
                write(*l, s_r - thrust);
            }
            return 0.0;
        }
        let mut rest = thrust;
        for (i, support) in &self.supports {
            if support.spring != 0.0 {
                write(*i, support.spring.abs());
                rest += support.spring;
            }
        }
        if rest.abs() <= 1e-9 * scale {
            return 0.0;
        }
        let right = rest > 0.0;
        let shares: f64 = self
            .supports
            .iter()
            .filter(|(_, s)| Self::takes(s, right))
            .map(|(_, s)| s.share.unwrap_or(1.0))
            .sum();
        if shares == 0.0 {
            return rest;
        }
        for (i, support) in self.supports.iter().filter(|(_, s)| Self::takes(s, right)) {
            write(*i, rest.abs() * support.share.unwrap_or(1.0) / shares);
        }
        0.0
    }
}
