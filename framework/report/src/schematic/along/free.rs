//! Free positions for components without a stated position.

use super::super::things::{Kind, Part, Symbol};
use super::{AIR, LEFT, RIGHT, Work, middle, width};

impl Work<'_> {
    pub(super) fn unstated(&mut self, i: usize, sides: &[f64]) {
        let part = &self.things.parts[i];
        let wide = width(part, self.scale);
        let x = match part.between {
            [Some(a), Some(b)] => self.between(a, b, wide, sides),
            [Some(m), None] | [None, Some(m)] => self.on_member(m, part, wide, sides),
            [None, None] => 0.0,
        };
        self.put(i, x);
    }

    /// A free position on a member that is connected to the housing.
    fn on_member(&self, member: usize, part: &Part, wide: f64, sides: &[f64]) -> f64 {
        if let (Some(g), true) = (self.things.wheel_of(member), self.things.floats(member)) {
            return middle(self.along.wheels[g]);
        }
        if self.things.members[member].kind != Kind::Shaft {
            return self.beside(member, wide);
        }
        let port = self.things.ports.iter().position(|p| p.1 == member).map(|p| sides[p]);
        // Seals are at the end where the shaft leaves the housing, a second one at the other end.
        let same = |p: &&Part| p.symbol == part.symbol && p.between == part.between;
        let before = self
            .things
            .parts
            .iter()
            .filter(same)
            .take_while(|p| p.path != part.path);
        let turn = if before.count().is_multiple_of(2) { 1.0 } else { -1.0 };
        let place = |side: f64| {
            let end = self.along.extents[member].map_or(0.0, |e| if side > 0.0 { e[1] } else { e[0] });
            self.free(member, end, side, wide)
        };
        if part.symbol == Symbol::Seal {
            return place(turn * port.unwrap_or(RIGHT));
        }
        // Prefer an end without a port and without another shaft around this one.
        let first = -turn * port.unwrap_or(LEFT);
        let (near, far) = (place(first), place(-first));
        if self.around(member, far) < self.around(member, near) {
            far
        } else {
            near
        }
    }

    /// Number of other shafts of the axis that cover a position on a member, with those that leave the gearbox there.
    fn around(&self, member: usize, x: f64) -> usize {
        let things = self.things;
        let over = |m: usize| {
            m != member
                && things.members[m].line == things.members[member].line
                && things.members[m].kind == Kind::Shaft
                && self.along.extents[m].is_some_and(|e| e[0] - 20.0 < x && x < e[1] + 20.0)
        };
        (0..things.members.len()).filter(|m| over(*m)).count()
    }

    /// A free position between two members.
    fn between(&self, a: usize, b: usize, wide: f64, sides: &[f64]) -> f64 {
        let things = self.things;
        for member in [b, a] {
            if things.members[member].kind != Kind::Shaft {
                return self.beside(member, wide);
            }
        }
        let (Some(of_a), Some(of_b)) = (self.along.extents[a], self.along.extents[b]) else {
            let known = self.along.extents[a].or(self.along.extents[b]);
            return self.free(a, known.map_or(0.0, |e| e[1]), RIGHT, wide);
        };
        let gap = [of_a[1].min(of_b[1]), of_a[0].max(of_b[0])];
        if gap[1] - gap[0] >= wide {
            let x = self.free(a, middle(gap) - 0.5 * wide - AIR, RIGHT, wide);
            if x + 0.5 * wide <= gap[1] {
                return x;
            }
        }
        // At the end without a port of either member.
        let port = |side: f64| (0..sides.len()).any(|p| sides[p] == side && [a, b].contains(&things.ports[p].1));
        let side = if port(RIGHT) && !port(LEFT) { LEFT } else { RIGHT };
        let end = if side > 0.0 {
            of_a[1].min(of_b[1])
        } else {
            of_a[0].max(of_b[0])
        };
        self.free(a, end, side, wide)
    }

    /// The nearest free position next to an idler gear or a planet, preferably towards another idler gear.
    fn beside(&self, member: usize, wide: f64) -> f64 {
        let face = self
            .things
            .wheel_of(member)
            .map(|g| self.along.wheels[g])
            .or(self.along.extents[member])
            .unwrap_or([0.0, 0.0]);
        let away = |side: f64| {
            let start = if side > 0.0 { face[1] } else { face[0] };
            let x = self.free(member, start, side, wide);
            ((x - start).abs(), x)
        };
        let (left, right) = (away(LEFT), away(RIGHT));
        let towards = |m: usize| {
            let other = m != member && self.things.members[m].kind == self.things.members[member].kind;
            let gear = self.things.wheel_of(m).filter(|_| other)?;
            Some(middle(self.along.wheels[gear]) - middle(face))
        };
        let nearest = (0..self.things.members.len())
            .filter_map(towards)
            .min_by(|a, b| a.abs().total_cmp(&b.abs()));
        let leftwards = nearest.is_some_and(|d| d < 0.0);
        if left.0 + 1.0 < right.0 || (leftwards && left.0 <= right.0 + 1.0) {
            left.1
        } else {
            right.1
        }
    }
}
