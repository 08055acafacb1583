//! The symbols of a schematic: shafts, differentials and ports; gears and components have their own modules.

mod gears;
mod parts;

use super::along::{ARROW, AXLE, Along, CHAIN};
use super::axes::{Axes, thickness};
use super::canvas::{Canvas, Rect, Voice};
use super::things::{Kind, Strand, Things};

// Colours of Okabe and Ito, light inside and dark at the edge; every symbol also has its own shape. Pages give the classes dark colours.
pub(super) const FIXED: &str = "class=\"fixed\" fill=\"#cfe6f5\" stroke=\"#0072b2\" stroke-width=\"1.3\"";
pub(super) const LOOSE: &str = "class=\"loose\" fill=\"#fbe6bd\" stroke=\"#a06a00\" stroke-width=\"1.3\"";
pub(super) const SHAFT: &str = "class=\"shaft\" fill=\"#d5d5d5\" stroke=\"#444\" stroke-width=\"0.9\"";
const GROUND: &str = "class=\"line\" fill=\"none\" stroke=\"#555\" stroke-width=\"1\"";
const BOX: &str = "class=\"box\" fill=\"#f6f6f6\" stroke=\"#444\" stroke-width=\"1.2\"";
pub(super) const CENTRE: &str =
    "class=\"line\" fill=\"none\" stroke=\"#999\" stroke-width=\"0.8\" stroke-dasharray=\"12 3 2 3\"";
const MESH: &str = "class=\"mesh\" fill=\"none\" stroke=\"#8a3f6b\" stroke-width=\"1.8\" stroke-dasharray=\"1.5 4\" stroke-linecap=\"round\"";
pub(super) const PORT: &str = "class=\"port\" fill=\"#000\" stroke=\"#000\" stroke-width=\"1.6\"";
const STRAND: &str = "class=\"mesh\" fill=\"none\" stroke=\"#8a3f6b\" stroke-width=\"1.4\"";
const DASHED: &str = " stroke-dasharray=\"4 2.5\"";

/// Half the thickness of a planet's pin. \[px\]
const PIN: f64 = 2.5;
/// Thickness of the wall of a hollow shaft. \[px\]
const WALL: f64 = 4.0;
/// Up and down.
const SIDES: [f64; 2] = [-1.0, 1.0];

fn style(base: &str, stated: bool) -> String {
    format!("{base}{}", if stated { "" } else { DASHED })
}

/// An id with the number of its copies.
pub(super) fn label(id: &str, count: f64) -> String {
    if count > 1.0 {
        format!("{id} \u{d7}{count:.0}")
    } else {
        id.to_owned()
    }
}

struct Draw<'a> {
    canvas: &'a mut Canvas,
    things: &'a Things,
    along: &'a Along,
    axes: &'a Axes,
    scale: f64,
}

/// Draws everything.
pub(super) fn draw_all(canvas: &mut Canvas, things: &Things, along: &Along, axes: &Axes, scale: f64) {
    let mut draw = Draw {
        canvas,
        things,
        along,
        axes,
        scale,
    };
    draw.centre_lines();
    for gear in 0..things.wheels.len() {
        draw.gear(gear);
    }
    draw.drums();
    draw.shafts();
    for body in 0..things.members.len() {
        draw.planet(body);
    }
    draw.apart();
    for axle in 0..things.axles.len() {
        draw.axle(axle);
    }
    for chain in &things.chains {
        draw.chain(chain);
    }
    for part in 0..things.parts.len() {
        draw.part(part);
    }
    for port in 0..things.ports.len() {
        draw.port(port);
    }
    draw.shaft_names();
    draw.canvas.write_words();
    draw.foot();
}

impl Draw<'_> {
    fn centre_lines(&mut self) {
        for line in 0..self.things.lines {
            let spans = (0..self.things.members.len())
                .filter(|m| self.things.members[*m].line == line && !self.things.is_planet(*m))
                .filter_map(|m| self.along.extents[m]);
            let span = spans.fold(None, |all: Option<[f64; 2]>, s| {
                Some(all.map_or(s, |a| [a[0].min(s[0]), a[1].max(s[1])]))
            });
            if let Some([from, to]) = span {
                let y = self.axes.lines[line];
                self.canvas.line(&[[from - 12.0, y], [to + 12.0, y]], CENTRE);
            }
        }
    }

    /// Half the thickness of the shaft or pin that a member turns on.
    fn inner(&self, member: usize) -> f64 {
        match self.things.members[member].kind {
            Kind::Planet(_) => PIN,
            Kind::Loose(shaft) => thickness(self.along.levels[shaft]),
            Kind::Shaft => thickness(self.along.levels[member]),
        }
    }

    fn shafts(&mut self) {
        for (number, member) in self.things.members.iter().enumerate() {
            let Some(x) = self.along.extents[number].filter(|_| member.kind == Kind::Shaft) else {
                continue;
            };
            let (y, level) = (self.axes.lines[member.line], self.along.levels[number]);
            let half = thickness(level);
            self.canvas.open(&format!("shafts.{}", member.name), &member.name);
            if level == 0 {
                self.canvas.rect(&Rect::new(x, [y - half, y + half]), SHAFT);
            } else {
                for side in SIDES {
                    let wall = Rect::new(x, [y + side * (half - WALL), y + side * half]);
                    self.canvas.rect(&wall, SHAFT);
                }
            }
            self.canvas.close();
            self.canvas.avoid(Rect::new(x, [y - half, y + half]));
        }
    }

    /// Bevel gears in a box.
    fn axle(&mut self, number: usize) {
        let axle = &self.things.axles[number];
        let (x, y) = (
            self.along.axles[number],
            self.axes.lines[self.things.members[axle.case].line],
        );
        let room = Rect::about(x, y, AXLE, 60.0);
        let name = |m: usize| self.things.members[m].name.as_str();
        let [left, right] = axle.sides.map(name);
        let tip = format!("{}: case {}, sides {left} and {right}", axle.id, name(axle.case));
        self.canvas.open(&format!("differentials.{}", axle.id), &tip);
        self.canvas.rect(&room, &style(BOX, false));
        for side in SIDES {
            let bevel = [[12.0, -14.0], [12.0, 14.0], [3.0, 5.0], [3.0, -5.0]];
            self.canvas.shape(&bevel.map(|[u, v]| [x + side * u, y + v]), FIXED);
            let planet = [[-11.0, 17.0], [11.0, 17.0], [2.0, 8.0], [-2.0, 8.0]];
            self.canvas.shape(&planet.map(|[u, v]| [x + u, y + side * v]), LOOSE);
            self.canvas.line(&[[x, y + side * 17.0], [x, y + side * 30.0]], GROUND);
            let half = Rect::new([x + side * 12.0, x + side * 0.5 * AXLE], [y - 3.0, y + 3.0]);
            self.canvas.rect(&half, SHAFT);
        }
        self.canvas.close();
        self.canvas.avoid(room);
        self.canvas.word(axle.id.clone(), room, None, Voice::Plain);
    }

    /// Two wheels with the strands between their axes, which the unfolded view does not show at their distance.
    fn chain(&mut self, chain: &Strand) {
        let x = chain.at * self.scale;
        let heights = chain.members.map(|member| self.axes.height(self.things, member));
        let names = chain.members.map(|member| self.things.members[member].name.as_str());
        let tip = format!("{}: {}, from {} to {}", chain.id, chain.what, names[0], names[1]);
        self.canvas.open(&format!("chains.{}", chain.id), &tip);
        for side in SIDES {
            let strand = x + side * 0.5 * CHAIN;
            self.canvas.line(&[[strand, heights[0]], [strand, heights[1]]], STRAND);
        }
        let wheels = [0, 1].map(|i| Rect::about(x, heights[i], CHAIN, 2.0 * (chain.radii[i] * self.scale).max(6.0)));
        for wheel in &wheels {
            self.canvas.rect(wheel, FIXED);
        }
        self.canvas.close();
        for wheel in wheels {
            self.canvas.shade(wheel);
        }
        self.canvas
            .word(chain.id.clone(), wheels[0], Some(wheels[0]), Voice::Plain);
    }

    /// An arrow: into the gearbox at the reference port, out of it at the others.
    fn port(&mut self, number: usize) {
        let (name, member) = &self.things.ports[number];
        let (end, side) = self.along.ends[number];
        let level = self.along.levels[self.things.shaft_of(*member)];
        let off = if level > 0 { thickness(level) - 2.0 } else { 0.0 };
        let y = self.axes.height(self.things, *member) - off;
        let far = end + side * ARROW;
        let (tail, tip) = if number == self.things.reference {
            (far, end)
        } else {
            (end, far)
        };
        let way = (tip - tail).signum();
        let tip_text = format!("port {name} at {}", self.things.members[*member].name);
        self.canvas.open(&format!("ports.{name}"), &tip_text);
        self.canvas.line(&[[tail, y], [tip - way * 8.0, y]], PORT);
        let head = [[tip, y], [tip - way * 11.0, y - 5.0], [tip - way * 11.0, y + 5.0]];
        self.canvas.shape(&head, PORT);
        self.canvas.close();
        let room = Rect::about(0.5 * (end + far), y, ARROW, 12.0);
        self.canvas.avoid(room);
        self.canvas.word(name.clone(), room, None, Voice::Loud);
    }

    /// Names of shafts without a port of the same name.
    fn shaft_names(&mut self) {
        for (number, member) in self.things.members.iter().enumerate() {
            let told = |p: &(String, usize)| p.1 == number && p.0 == member.name;
            let Some(x) = self.along.extents[number].filter(|_| member.kind == Kind::Shaft) else {
                continue;
            };
            if !self.things.ports.iter().any(told) {
                let (y, half) = (self.axes.lines[member.line], thickness(self.along.levels[number]));
                let room = Rect::new(x, [y - half, y + half]);
                self.canvas.word(member.name.clone(), room, None, Voice::Quiet);
            }
        }
    }

    /// The scale bar, and the meaning of dashes and dots if there are any.
    fn foot(&mut self) {
        let extent = self.canvas.extent();
        let (x, y) = (extent.x[0], extent.y[1] + 26.0);
        let bar = round_length(90.0 / self.scale);
        let length = bar * self.scale;
        self.canvas.line(
            &[[x, y - 4.0], [x, y], [x + length, y], [x + length, y - 4.0]],
            "class=\"line\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.5\"",
        );
        self.canvas
            .foot(x + length + 8.0, y + 1.0, &format!("{} mm", 1e3 * bar));
        let unstated = self.things.wheels.iter().any(|w| !w.stated)
            || self.things.parts.iter().any(|p| p.at.is_none())
            || !self.things.axles.is_empty();
        let mut notes = Vec::new();
        if !self.things.wheels.is_empty() {
            notes.push("Blue gears are fixed to their shaft, amber gears turn freely on it.");
        }
        if unstated {
            notes.push("Dashed: position assumed, the description states none.");
        }
        if self.canvas.holds(MESH) {
            notes.push("Dotted: gears in mesh that are apart in this plane.");
        }
        for (i, note) in notes.into_iter().enumerate() {
            self.canvas.foot(x, y + 22.0 + 17.0 * i as f64, note);
        }
    }
}

/// The largest of 1, 2, 5, 10, ... that is not longer. \[m\]
pub(super) fn round_length(most: f64) -> f64 {
    let decade = 10.0_f64.powf(most.log10().floor());
    let steps = [5.0, 2.0, 1.0];
    steps
        .into_iter()
        .map(|s| s * decade)
        .find(|s| *s <= most)
        .unwrap_or(decade)
}
