//! Nesting of coaxial shafts.

use super::super::things::{Kind, Symbol};
use super::{Span, Work, middle};

impl Work<'_> {
    /// Shafts that certainly enclose others: those that hold a bearing, and rings whose web passes the leg of a carrier.
    fn nested(&self) -> Vec<[usize; 2]> {
        let things = self.things;
        let mut pairs = Vec::new();
        for part in things.parts.iter().filter(|p| p.symbol == Symbol::Bearing) {
            if let [Some(inner), Some(outer)] = part.between {
                pairs.push([inner, outer]);
            }
        }
        for (ring, web) in self.along.webs.iter().enumerate() {
            for body in self.bodies(ring) {
                let Kind::Planet(carrier) = things.members[body].kind else {
                    continue;
                };
                let (Some(web), Some(leg)) = (web, self.along.legs[body]) else {
                    continue;
                };
                let x = self.along.extents[body].map_or(0.0, middle);
                if (web - x) * (leg - x) > 0.0 {
                    pairs.push([carrier, things.wheels[ring].member]);
                }
            }
        }
        let shaft = |m: &usize| things.members[*m].kind == Kind::Shaft;
        pairs.retain(|pair| pair[0] != pair[1] && pair.iter().all(shaft));
        pairs
    }

    /// Number of shafts inside each: long ones inside short ones unless the nesting is certain.
    pub(super) fn levels(&self) -> Vec<usize> {
        let (things, extents) = (self.things, &self.along.extents);
        let count = things.members.len();
        let mut depth = vec![0; count];
        let nested = self.nested();
        // Circular nesting is meaningless; the bound ends the loop.
        for _ in 0..count.min(8) {
            for [inner, outer] in &nested {
                depth[*outer] = depth[*outer].max(depth[*inner] + 1);
            }
        }
        let mut order: Vec<(usize, usize, Span)> = (0..count)
            .filter(|m| things.members[*m].kind == Kind::Shaft)
            .filter_map(|m| extents[m].map(|e| (depth[m], m, e)))
            .collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then((b.2[1] - b.2[0]).total_cmp(&(a.2[1] - a.2[0]))));
        let mut levels = vec![0; count];
        for i in 0..order.len() {
            let (_, member, span) = order[i];
            let under = order[..i].iter().filter(|(_, m, s)| {
                things.members[*m].line == things.members[member].line && s[0] + 1.0 < span[1] && span[0] + 1.0 < s[1]
            });
            levels[member] = under.map(|(_, m, _)| levels[*m] + 1).max().unwrap_or(0);
        }
        levels
    }
}
