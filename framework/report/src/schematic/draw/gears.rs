//! The symbols of gears, with rings and planets.

use super::super::axes::height;
use super::super::canvas::{Rect, Voice};
use super::super::things::{Kind, Part, Symbol, Wheel};
use super::{Draw, FIXED, LOOSE, MESH, PIN, SHAFT, SIDES, label, style};

const BORE: &str = "class=\"ground\" fill=\"#fff\" stroke=\"none\"";
/// Minimum gap between gears in mesh that gets a dotted line. \[px\]
const GAP: f64 = 7.0;

impl Draw<'_> {
    /// Radius of the bore of a gear that turns freely: space for its bearing.
    pub(super) fn bore(&self, wheel: &Wheel, radius: f64) -> Option<f64> {
        let side = match self.things.members[wheel.member].kind {
            Kind::Shaft => return None,
            Kind::Loose(_) => 1,
            Kind::Planet(_) => 0,
        };
        let beside = |p: &&Part| p.symbol == Symbol::Bearing && p.between[side] == Some(wheel.member);
        let room = self
            .things
            .parts
            .iter()
            .find(beside)
            .map_or(5.0, |p| height(p, self.scale));
        Some((self.inner(wheel.member) + room).min(0.7 * radius))
    }

    pub(super) fn gear(&mut self, gear: usize) {
        let wheel = &self.things.wheels[gear];
        let rect = self.axes.rectangle(self.things, self.along, gear);
        let radius = self.axes.radii[gear];
        let bore = self.bore(wheel, radius).filter(|_| !wheel.ring);
        let look = style(if bore.is_some() { LOOSE } else { FIXED }, wheel.stated);
        let turns = self.things.members[wheel.member].name.as_str();
        let tip = format!(
            "{}: {} teeth, face width {:.1} mm, tip diameter {:.1} mm, turns with {turns}",
            wheel.id,
            wheel.z,
            1e3 * wheel.width,
            2e3 * wheel.radius
        );
        self.canvas.open(&format!("gears.{}", wheel.id), &tip);
        self.canvas.rect(&rect, &look);
        if let Some(bore) = bore {
            let y = rect.middle()[1];
            let inside = Rect::new([rect.x[0] + 0.6, rect.x[1] - 0.6], [y - bore, y + bore]);
            self.canvas.rect(&inside, BORE);
            for side in SIDES {
                let y = y + side * bore;
                self.canvas.line(&[[rect.x[0], y], [rect.x[1], y]], LOOSE);
            }
        }
        if let Some(web) = self.along.webs[gear] {
            self.web(gear, &rect, web, &look);
        }
        self.canvas.close();
        if wheel.ring {
            self.canvas.avoid(rect);
        } else {
            self.canvas.shade(rect);
        }
        let count = self.things.members[wheel.member].count;
        self.canvas
            .word(label(&wheel.id, count), rect, Some(rect), Voice::Plain);
    }

    /// From the body of a ring down to its shaft.
    fn web(&mut self, gear: usize, rim: &Rect, x: f64, look: &str) {
        let member = self.things.wheels[gear].member;
        let half = self.axes.halves[gear];
        let line = self.axes.lines[self.things.members[member].line];
        let outer = if half < 0.0 { rim.y[0] } else { rim.y[1] };
        let arm = Rect::new(
            [rim.middle()[0].clamp(rim.x[0], rim.x[1]), x],
            [outer, outer - half * 5.0],
        );
        let arm = if x > rim.x[1] {
            Rect::new([rim.x[1], x + 2.0], arm.y)
        } else {
            Rect::new([rim.x[0], x - 2.0], arm.y)
        };
        let down = Rect::new(
            [x - 2.0, x + 2.0],
            [outer - half * 5.0, line + half * self.inner(member)],
        );
        for r in [arm, down] {
            self.canvas.rect(&r, look);
            self.canvas.avoid(r);
        }
    }

    /// The drum that joins several rings of one body without a shaft.
    pub(super) fn drums(&mut self) {
        for member in 0..self.things.members.len() {
            let wheels = (0..self.things.wheels.len()).filter(|g| self.things.wheels[*g].member == member);
            let mut rims: Vec<Rect> = wheels
                .map(|g| self.axes.rectangle(self.things, self.along, g))
                .collect();
            if !self.things.floats(member) {
                continue;
            }
            rims.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
            for pair in rims.windows(2) {
                let height = [pair[0].y[0].min(pair[1].y[0]), pair[0].y[0].max(pair[1].y[0]) + 6.0];
                let drum = Rect::new([pair[0].x[1], pair[1].x[0].max(pair[0].x[1])], height);
                self.canvas.rect(&drum, FIXED);
                self.canvas.avoid(drum);
            }
        }
    }

    /// The pin of a planet, its leg to the carrier, and the sleeve of a planet with several gears.
    pub(super) fn planet(&mut self, body: usize) {
        let (Kind::Planet(carrier), Some(x)) = (self.things.members[body].kind, self.along.extents[body]) else {
            return;
        };
        let y = self.axes.height(self.things, body);
        let of_body = |w: &&Wheel| w.member == body;
        let bores = self.things.wheels.iter().enumerate().filter(|(_, w)| of_body(w));
        let bore = bores
            .filter_map(|(g, w)| self.bore(w, self.axes.radii[g]))
            .fold(f64::INFINITY, f64::min);
        if self.things.wheels.iter().filter(of_body).count() > 1 && bore.is_finite() {
            for side in SIDES {
                let wall = [y + side * bore, y + side * (bore + 3.0)];
                self.canvas.rect(&Rect::new(x, wall), LOOSE);
            }
        }
        let leg = self.along.legs[body];
        let own_shaft = self.along.extents[carrier].is_some();
        let from = leg.map_or(x[0] - 7.0, |leg| leg.min(x[0] - 7.0));
        let to = leg.map_or(x[1] + 7.0, |leg| leg.max(x[1] + 7.0));
        let pin = Rect::new([from, to], [y - PIN, y + PIN]);
        self.canvas.rect(&pin, SHAFT);
        if !own_shaft {
            let name = self.things.members[carrier].name.clone();
            self.canvas.word(name, pin, None, Voice::Quiet);
        }
        for end in [from, to]
            .into_iter()
            .filter(|end| leg.is_none_or(|leg| (leg - end).abs() > 1.0))
        {
            self.canvas.rect(&Rect::about(end, y, 3.0, 14.0), SHAFT);
        }
        if let Some(leg) = leg {
            let line = self.axes.lines[self.things.members[body].line];
            let side = if self.axes.orbits[body] < 0.0 { -1.0 } else { 1.0 };
            let down = Rect::new(
                [leg - 2.0, leg + 2.0],
                [y + side * PIN, line + side * self.inner(carrier)],
            );
            self.canvas.rect(&down, SHAFT);
            self.canvas.avoid(down);
        }
    }

    /// Dotted lines between gears in mesh that do not touch in this plane.
    pub(super) fn apart(&mut self) {
        for contact in &self.things.contacts {
            let [a, b] = contact.gears.map(|g| self.axes.rectangle(self.things, self.along, g));
            let gap = (a.y[0] - b.y[1]).max(b.y[0] - a.y[1]);
            if gap.abs() <= GAP {
                continue;
            }
            let x = 0.5 * (a.x[0].max(b.x[0]) + a.x[1].min(b.x[1]));
            let (upper, lower) = if a.middle()[1] < b.middle()[1] { (a, b) } else { (b, a) };
            let ends = if gap > 0.0 {
                [upper.y[1], lower.y[0]]
            } else {
                [upper.middle()[1], lower.middle()[1]]
            };
            self.canvas.line(&[[x, ends[0]], [x, ends[1]]], MESH);
        }
    }
}
