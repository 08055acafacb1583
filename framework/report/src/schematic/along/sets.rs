//! Carriers and rings of planetary sets: positions of their legs and webs.

use super::super::things::{Kind, Part, Symbol};
use super::{RIGHT, Span, Work, middle};

/// From the faces of planets to the leg of their carrier, and on to the web of a ring. \[px\]
const STEP: f64 = 11.0;
/// Space between a planet and the leg of its carrier for a coupling from the carrier to the sun. \[px\]
const LOCK: f64 = 30.0;

impl Work<'_> {
    /// Side on which a body continues from a position; absent if nothing else is attached to it.
    fn continuation_side(&self, member: usize, x: f64, sides: &[f64]) -> Option<f64> {
        let port = self.things.ports.iter().position(|p| p.1 == member);
        match self.along.extents[member].map(middle) {
            Some(other) if (other - x).abs() > 1.0 => Some((other - x).signum()),
            other => port.map(|p| sides[p]).or_else(|| {
                let joined = |p: &Part| p.between.contains(&Some(member)) && !self.pin(p);
                let parts = self.things.parts.iter().any(joined);
                (other.is_some() || parts || self.things.in_axle(member)).then_some(RIGHT)
            }),
        }
    }

    fn pin(&self, part: &Part) -> bool {
        part.between[0].is_some_and(|m| self.things.is_planet(m))
    }

    /// True if a coupling without a stated position connects a carrier to another shaft: it is drawn next to the sun.
    fn locks(&self, carrier: usize) -> bool {
        let joins = |p: &Part| {
            matches!(p.symbol, Symbol::Sleeve | Symbol::Clutch)
                && p.at.is_none()
                && p.between.contains(&Some(carrier))
                && !p.between.contains(&None)
        };
        self.things.parts.iter().any(joins)
    }

    /// Legs from carriers to their planets.
    pub(super) fn carriers(&mut self, sides: &[f64]) {
        let things = self.things;
        let ways: Vec<Option<(usize, f64)>> = things
            .members
            .iter()
            .enumerate()
            .map(|(body, member)| {
                let Kind::Planet(carrier) = member.kind else {
                    return None;
                };
                let x = self.along.extents[body].map_or(0.0, middle);
                self.continuation_side(carrier, x, sides).map(|side| (carrier, side))
            })
            .collect();
        for (body, way) in ways.into_iter().enumerate() {
            let Some((carrier, side)) = way else { continue };
            let span = self.along.extents[body].unwrap_or([-8.0, 8.0]);
            self.along.extents[body] = Some(span);
            let room = if self.locks(carrier) { LOCK } else { 0.0 };
            let x = (if side > 0.0 { span[1] } else { span[0] }) + side * (STEP + room);
            self.along.legs[body] = Some(x);
            self.extend(carrier, [x - 1.5, x + 1.5]);
            self.take(carrier, [x - 1.5, x + 1.5]);
        }
    }

    /// Webs from rings to their shafts, beyond the planets and the leg of their carrier.
    pub(super) fn rings(&mut self, sides: &[f64]) {
        let things = self.things;
        let webs: Vec<Option<f64>> = (0..things.wheels.len())
            .map(|g| {
                let wheel = &things.wheels[g];
                if !wheel.ring || self.things.floats(wheel.member) {
                    return None;
                }
                let x = middle(self.along.wheels[g]);
                let wanted = self.continuation_side(wheel.member, x, sides).unwrap_or(RIGHT);
                Some(self.web(g, if self.barred(g, wanted) { -wanted } else { wanted }))
            })
            .collect();
        for (g, x) in webs.iter().enumerate() {
            if let Some(x) = x {
                self.extend(things.wheels[g].member, [x - 1.5, x + 1.5]);
                self.take(things.wheels[g].member, [x - 1.5, x + 1.5]);
            }
        }
        self.along.webs = webs;
    }

    /// True if another ring of the same planets is on that side.
    fn barred(&self, ring: usize, side: f64) -> bool {
        let bodies = self.bodies(ring);
        let x = middle(self.along.wheels[ring]);
        (0..self.things.wheels.len()).any(|g| {
            g != ring
                && self.things.wheels[g].ring
                && side * (middle(self.along.wheels[g]) - x) > 1.0
                && self.bodies(g).iter().any(|b| bodies.contains(b))
        })
    }

    /// Planet bodies that a ring meshes with.
    pub(super) fn bodies(&self, ring: usize) -> Vec<usize> {
        let things = self.things;
        let mates = things.contacts.iter().filter(|c| c.gears[1] == ring);
        mates
            .map(|c| things.wheels[c.gears[0]].member)
            .filter(|m| things.is_planet(*m))
            .collect()
    }

    fn web(&self, ring: usize, side: f64) -> f64 {
        let outer = |span: Span| if side > 0.0 { span[1] } else { span[0] };
        let mut x = outer(self.along.wheels[ring]) + side * STEP;
        for body in self.bodies(ring) {
            let faces = self.along.extents[body].map_or(x, outer);
            let leg = self.along.legs[body].filter(|leg| side * (leg - faces) > 0.0);
            // The pin of the planet protrudes a little.
            let far = leg.unwrap_or(faces + side * 5.0) + side * STEP;
            x = if side > 0.0 { x.max(far) } else { x.min(far) };
        }
        x
    }
}
