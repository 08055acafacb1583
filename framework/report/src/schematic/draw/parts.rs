//! The symbols of bearings, seals, couplings and other components on shafts.

use super::super::along::width;
use super::super::axes::{height, thickness};
use super::super::canvas::{Rect, Voice};
use super::super::things::{Kind, Part, Symbol};
use super::{Draw, GROUND, LOOSE, SHAFT, SIDES, WALL, label, style};

const BEARING: &str = "class=\"bearing\" fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.1\"";
const CROSS: &str = "class=\"line\" fill=\"none\" stroke=\"#111\" stroke-width=\"0.9\"";
const SLEEVE: &str = "class=\"coupling\" fill=\"#f3c6a5\" stroke=\"#b04a00\" stroke-width=\"1.2\"";
const SEAL: &str = "class=\"seal\" fill=\"#8fd8c1\" stroke=\"#00553e\" stroke-width=\"1\"";
const OTHER: &str = "class=\"other\" fill=\"#eed9e6\" stroke=\"#8a3f6b\" stroke-width=\"1.2\"";

impl Draw<'_> {
    pub(super) fn part(&mut self, number: usize) {
        let part = &self.things.parts[number];
        let x = self.along.parts[number];
        let Some(member) = part.between[0].or(part.between[1]) else {
            return;
        };
        let y = self.axes.height(self.things, member);
        let names = part
            .between
            .map(|m| m.map_or("housing", |m| self.things.members[m].name.as_str()));
        let tip = format!("{}: {} and {}", part.path, names[0], names[1]);
        self.canvas.open(&part.path, &tip);
        let room = match part.symbol {
            Symbol::Bearing => self.bearing(part, x, y),
            Symbol::Seal => self.seal(part, member, x, y),
            Symbol::Sleeve | Symbol::Clutch => self.coupling(number, x, y),
            Symbol::Other => self.other(part, member, x, y),
        };
        self.canvas.close();
        let within = self.gear_around(part);
        self.canvas
            .word(label(&part.id, part.count), room, within, Voice::Plain);
    }

    /// The idler gear or planet that contains a bearing.
    fn gear_around(&self, part: &Part) -> Option<Rect> {
        let turning = |m: &usize| self.things.members[*m].kind != Kind::Shaft;
        let member = part.between.into_iter().flatten().find(turning)?;
        let gear = self
            .things
            .wheel_of(member)
            .filter(|_| part.symbol == Symbol::Bearing)?;
        Some(self.axes.rectangle(self.things, self.along, gear))
    }

    /// Crossed squares above and below the shaft; hatched outside if the housing holds them.
    fn bearing(&mut self, part: &Part, x: f64, y: f64) -> Rect {
        let inner = part.between[0].map_or(3.0, |m| self.inner(m));
        let room = self.room_in(part, inner);
        let (wide, high) = (
            width(part, self.scale),
            room.unwrap_or_else(|| height(part, self.scale)),
        );
        for side in SIDES {
            let square = Rect::new(
                [x - 0.5 * wide, x + 0.5 * wide],
                [y + side * inner, y + side * (inner + high)],
            );
            self.canvas.rect(&square, BEARING);
            self.canvas
                .line(&[[square.x[0], square.y[0]], [square.x[1], square.y[1]]], CROSS);
            self.canvas
                .line(&[[square.x[0], square.y[1]], [square.x[1], square.y[0]]], CROSS);
            self.canvas.avoid(square);
            if part.between[1].is_none() {
                self.ground(x, y + side * (inner + high), wide, side);
            }
        }
        let hatch = if part.between[1].is_none() { 5.0 } else { 0.0 };
        Rect::about(x, y, wide, 2.0 * (inner + high + hatch))
    }

    /// Radial space for a bearing between two members.
    fn room_in(&self, part: &Part, inner: f64) -> Option<f64> {
        let [first, outer] = [part.between[0]?, part.between[1]?];
        let around = |member: usize| {
            let wheel = self.things.wheel_of(member)?;
            self.bore(&self.things.wheels[wheel], self.axes.radii[wheel])
        };
        let outside = match (self.things.members[first].kind, self.things.members[outer].kind) {
            (Kind::Planet(_), _) => around(first)?,
            (_, Kind::Loose(_)) => around(outer)?,
            _ => thickness(self.along.levels[outer]) - WALL,
        };
        Some(outside - inner).filter(|room| *room > 2.0)
    }

    /// A hatched edge of the housing.
    fn ground(&mut self, x: f64, y: f64, wide: f64, side: f64) {
        let half = 0.5 * wide.max(14.0);
        self.canvas.line(&[[x - half, y], [x + half, y]], GROUND);
        let ticks = (wide / 8.0).clamp(3.0, 40.0).ceil();
        for tick in 0..ticks as usize {
            let from = x - half + 2.0 * half * tick as f64 / ticks;
            self.canvas.line(&[[from, y], [from + 5.0, y + side * 5.0]], GROUND);
        }
    }

    fn seal(&mut self, part: &Part, member: usize, x: f64, y: f64) -> Rect {
        let (inner, high) = (self.inner(member), height(part, self.scale));
        for side in SIDES {
            let lip = [[x, inner], [x - 6.0, inner + high], [x + 6.0, inner + high]];
            let points = lip.map(|[x, v]| [x, y + side * v]);
            self.canvas.shape(&points, &style(SEAL, part.at.is_some()));
            self.canvas.avoid(Rect::new(
                [x - 5.0, x + 5.0],
                [y + side * inner, y + side * (inner + high)],
            ));
        }
        Rect::about(x, y, 10.0, 2.0 * (inner + high))
    }

    fn other(&mut self, part: &Part, member: usize, x: f64, y: f64) -> Rect {
        let middle = y - self.inner(member) - 9.0;
        self.canvas.circle([x, middle], 8.0, &style(OTHER, part.at.is_some()));
        self.canvas.shape(
            &[[x - 4.0, middle - 2.0], [x + 4.0, middle - 2.0], [x, middle - 7.5]],
            OTHER,
        );
        let room = Rect::about(x, middle, 16.0, 16.0);
        self.canvas.avoid(room);
        room
    }

    /// A sleeve or plates, with their connections to both members.
    fn coupling(&mut self, number: usize, x: f64, y: f64) -> Rect {
        let part = &self.things.parts[number];
        let ring = part.between.iter().flatten().find_map(|m| self.held_ring(part, *m));
        if let Some(ring) = ring {
            return self.brake_on_ring(part, ring, x);
        }
        let left = self.along.left[number];
        let ends = [part.between[left], part.between[1 - left]];
        let inner = ends.iter().flatten().map(|m| self.inner(*m)).fold(0.0, f64::max);
        let lowest = ends.iter().flatten().filter_map(|m| self.face(*m, x)).map(|(_, r)| r);
        let radius = (inner + 17.0)
            .min(lowest.fold(f64::INFINITY, f64::min) - 4.0)
            .max(inner + 9.0);
        let housed = part.between.contains(&None);
        for side in SIDES {
            for (end, from) in ends.into_iter().zip([-1.0, 1.0]) {
                let Some(member) = end else { continue };
                let level = y + side * radius;
                if let Some((face, _)) = self.face(member, x) {
                    let stub = Rect::new([face, x - (x - face).signum() * 5.0], [level - 2.0, level + 2.0]);
                    self.canvas.rect(&stub, LOOSE);
                } else {
                    let alone = housed || ends.iter().flatten().any(|m| self.face(*m, x).is_some());
                    let at = if alone { x } else { x + from * 5.0 };
                    let hub = Rect::new([at - 1.5, at + 1.5], [y + side * self.inner(member), level]);
                    self.canvas.rect(&hub, SHAFT);
                    self.canvas.avoid(hub);
                }
            }
            self.joint(part, x, y + side * radius);
            if housed {
                let top = if part.symbol == Symbol::Clutch { 8.0 } else { 5.0 };
                self.ground(x, y + side * (radius + top), 18.0, side);
            }
        }
        Rect::about(
            x,
            y,
            width(part, self.scale),
            2.0 * (radius + if housed { 13.0 } else { 8.0 }),
        )
    }

    /// A sleeve or plates, which open and close.
    fn joint(&mut self, part: &Part, x: f64, y: f64) {
        let stated = part.at.is_some();
        let room = if part.symbol == Symbol::Clutch {
            let room = Rect::about(x, y, 22.0, 14.0);
            self.canvas.rect(&room, &style(SLEEVE, stated));
            for (plate, from) in [(-6.0, -5.0), (-2.0, 5.0), (2.0, -5.0), (6.0, 5.0)] {
                let ends = [[x + plate, y + from], [x + plate, y - 0.6 * from]];
                self.canvas.line(
                    &ends,
                    "class=\"line\" fill=\"none\" stroke=\"#111\" stroke-width=\"1.6\"",
                );
            }
            room
        } else {
            let room = Rect::about(x, y, 17.0, 8.0);
            self.canvas.rect(&room, &style(SLEEVE, stated));
            room
        };
        self.canvas.avoid(room);
    }

    /// The face of an idler gear or a planet towards a position, with the gear's tip radius.
    fn face(&self, member: usize, x: f64) -> Option<(f64, f64)> {
        if self.things.members[member].kind == Kind::Shaft {
            return None;
        }
        let wheel = self.things.wheel_of(member)?;
        let [from, to] = self.along.wheels[wheel];
        let near = if (x - from).abs() < (x - to).abs() { from } else { to };
        Some((near, self.axes.radii[wheel]))
    }

    /// The ring of a member without a shaft that a coupling holds against the housing.
    fn held_ring(&self, part: &Part, member: usize) -> Option<usize> {
        let wheel = self.things.wheel_of(member)?;
        let floats = self.things.floats(member) && part.between.contains(&None);
        floats.then_some(wheel)
    }

    fn brake_on_ring(&mut self, part: &Part, ring: usize, x: f64) -> Rect {
        let rim = self.axes.rectangle(self.things, self.along, ring);
        let half = self.axes.halves[ring];
        let high = if part.symbol == Symbol::Clutch { 15.0 } else { 9.0 };
        let edge = if half < 0.0 { rim.y[0] } else { rim.y[1] };
        self.joint(part, x, edge + half * 0.5 * high);
        self.ground(x, edge + half * high, 20.0, half);
        Rect::new([x - 10.0, x + 10.0], [edge, edge + half * (high + 6.0)])
    }
}
