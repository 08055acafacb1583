//! The axes unfolded into one plane: each at the sum of the tip radii from the axis that it meshes with.

mod orbits;

use super::along::{ARROW, Along, CHAIN, width};
use super::canvas::Rect;
use super::things::{Part, Symbol, Things};
use orbits::{fit_rings, orbits};

/// Thickness of the body of a ring. \[px\]
pub(super) const RIM: f64 = 11.0;
/// Distance between axes without a common mesh, and around things that must not overlap. \[px\]
const APART: f64 = 40.0;

/// Radii and heights; y points downwards. \[px\]
#[derive(Debug, Default)]
pub(super) struct Axes {
    /// Height of every axis.
    pub lines: Vec<f64>,
    /// By member: height of its axis below that of its line; negative above. Zero except for planets.
    pub orbits: Vec<f64>,
    /// By gear: tip radius; inner radius of a ring.
    pub radii: Vec<f64>,
    /// By ring: minus one if its half above the axis is drawn, plus one for the half below.
    pub halves: Vec<f64>,
}

impl Axes {
    /// Height of the axis that a member turns about.
    pub(super) fn height(&self, things: &Things, member: usize) -> f64 {
        self.lines[things.members[member].line] + self.orbits[member]
    }

    /// Tip rectangle of a gear, or the body of a ring, relative to its line.
    fn outline(&self, things: &Things, along: &Along, gear: usize) -> Rect {
        let wheel = &things.wheels[gear];
        let (x, r) = (along.wheels[gear], self.radii[gear]);
        if wheel.ring {
            let half = self.halves[gear];
            return Rect::new(x, [half * r, half * (r + RIM)]);
        }
        let y = self.orbits[wheel.member];
        Rect::new(x, [y - r, y + r])
    }

    /// Tip rectangle of a gear, or the body of a ring.
    pub(super) fn rectangle(&self, things: &Things, along: &Along, gear: usize) -> Rect {
        let line = things.members[things.wheels[gear].member].line;
        self.outline(things, along, gear).down(self.lines[line])
    }
}

/// Half the thickness of a shaft with others inside. \[px\]
pub(super) fn thickness(level: usize) -> f64 {
    3.0 + 9.0 * level as f64
}

/// Radial height of a component. \[px\]
pub(super) fn height(part: &Part, scale: f64) -> f64 {
    match part.symbol {
        Symbol::Bearing => part.size[1].map_or(12.0, |h| (h * scale).clamp(8.0, 60.0)),
        Symbol::Seal => 13.0,
        Symbol::Sleeve | Symbol::Clutch => 22.0,
        Symbol::Other => 18.0,
    }
}

/// Unfolds all axes at a scale in px/m.
pub(super) fn axes(things: &Things, along: &Along, scale: f64) -> Axes {
    let radii: Vec<f64> = things.wheels.iter().map(|w| (w.radius * scale).max(4.0)).collect();
    let mut axes = Axes {
        orbits: orbits(things, &radii, scale),
        halves: vec![-1.0; things.wheels.len()],
        radii,
        lines: vec![0.0; things.lines],
    };
    fit_rings(things, &mut axes);
    unfold(things, along, scale, &mut axes);
    axes
}

/// The things on one axis, relative to its height: those that must not be covered, and thin shafts.
struct Row {
    hard: Vec<Rect>,
    soft: Vec<Rect>,
}

fn rows(things: &Things, along: &Along, scale: f64, axes: &Axes) -> Vec<Row> {
    let mut rows: Vec<Row> = (0..things.lines)
        .map(|_| Row {
            hard: Vec::new(),
            soft: Vec::new(),
        })
        .collect();
    for gear in 0..things.wheels.len() {
        let line = things.members[things.wheels[gear].member].line;
        rows[line].hard.push(axes.outline(things, along, gear));
    }
    for (i, part) in things.parts.iter().enumerate() {
        let Some(member) = part.between[0].or(part.between[1]) else {
            continue;
        };
        let reach = thickness(along.levels[things.shaft_of(member)]) + height(part, scale) + 6.0;
        let y = axes.orbits[member];
        rows[things.members[member].line]
            .soft
            .push(Rect::about(along.parts[i], y, width(part, scale), 2.0 * reach));
    }
    for (member, extent) in along.extents.iter().enumerate() {
        if let (Some(x), false) = (extent, things.is_planet(member)) {
            let y = thickness(along.levels[member]);
            rows[things.members[member].line].soft.push(Rect::new(*x, [-y, y]));
        }
    }
    for ((_, member), (end, side)) in things.ports.iter().zip(&along.ends) {
        let x = [*end, end + side * (ARROW + 60.0)];
        rows[things.members[*member].line].soft.push(Rect::new(x, [-9.0, 9.0]));
    }
    for chain in &things.chains {
        for (member, radius) in chain.members.into_iter().zip(chain.radii) {
            let room = Rect::about(chain.at * scale, 0.0, CHAIN, 2.0 * (radius * scale).max(6.0));
            rows[things.members[member].line].hard.push(room);
        }
    }
    for (i, axle) in things.axles.iter().enumerate() {
        let room = Rect::about(along.axles[i], 0.0, 44.0, 60.0);
        rows[things.members[axle.case].line].hard.push(room);
    }
    rows
}

/// Distance of two axes by their meshes, from the first to the second; negative for a ring below its pinion.
enum Reach {
    /// External gears: on either side.
    Either(f64),
    /// A ring about a pinion: downwards by this.
    Down(f64),
}

fn reach(things: &Things, axes: &Axes, from: usize, to: usize) -> Option<Reach> {
    let line = |g: usize| things.members[things.wheels[g].member].line;
    let mut most: Option<f64> = None;
    for contact in things.contacts.iter().filter(|c| !c.carried) {
        let [a, b] = contact.gears;
        if [line(a), line(b)] != [from, to] && [line(b), line(a)] != [from, to] {
            continue;
        }
        if things.wheels[b].ring {
            // The upper half of the ring is drawn, so the pinion touches it from below.
            let apart = (axes.radii[b] - axes.radii[a]).max(0.0);
            return Some(Reach::Down(if line(b) == to { apart } else { -apart }));
        }
        let sum = axes.radii[a] + axes.radii[b];
        most = Some(most.map_or(sum, |m| m.max(sum)));
    }
    most.map(Reach::Either)
}

/// Places each axis next to one that it meshes with, beginning with the axis of the reference port.
fn unfold(things: &Things, along: &Along, scale: f64, axes: &mut Axes) {
    let rows = rows(things, along, scale, axes);
    let first = things
        .ports
        .get(things.reference)
        .map_or(0, |p| things.members[p.1].line);
    let mut placed: Vec<(usize, f64)> = vec![(first, 1.0)];
    let mut next = 0;
    while placed.len() < things.lines {
        let Some(&(from, way)) = placed.get(next) else {
            // No mesh leads to the next axis: it is placed below everything.
            let Some(line) = (0..things.lines).find(|l| placed.iter().all(|p| p.0 != *l)) else {
                return;
            };
            axes.lines[line] = below(&rows, &placed, axes, line);
            placed.push((line, 1.0));
            continue;
        };
        for to in 0..things.lines {
            if placed.iter().any(|p| p.0 == to) {
                continue;
            }
            let at = axes.lines[from];
            let (height, way) = match reach(things, axes, from, to) {
                None => continue,
                Some(Reach::Down(by)) => (at + by, way),
                Some(Reach::Either(sum)) => beside(&rows, &placed, axes, to, at, sum, way),
            };
            axes.lines[to] = height;
            placed.push((to, way));
        }
        next += 1;
    }
}

/// Areas that a row would cover at a height: of gears, and of shafts and their components.
fn covered(rows: &[Row], placed: &[(usize, f64)], axes: &Axes, line: usize, at: f64) -> (f64, f64) {
    let (mut hard, mut soft) = (0.0, 0.0);
    for (other, _) in placed {
        let apart = at - axes.lines[*other];
        let sum = |a: &[Rect], b: &[Rect]| -> f64 {
            let pairs = a.iter().flat_map(|a| b.iter().map(move |b| a.down(apart).overlap(b)));
            pairs.sum()
        };
        let (ours, theirs) = (&rows[line], &rows[*other]);
        hard += sum(&ours.hard, &theirs.hard);
        soft += sum(&ours.soft, &theirs.hard) + sum(&ours.hard, &theirs.soft) + sum(&ours.soft, &theirs.soft);
        // Two axes at one height would look like one.
        hard += if apart.abs() < 12.0 { 1e4 } else { 0.0 };
    }
    (hard, soft)
}

/// Height next to an axis, below or above it, that covers the fewest things; farther away if gears would be covered.
fn beside(rows: &[Row], placed: &[(usize, f64)], axes: &Axes, line: usize, at: f64, sum: f64, way: f64) -> (f64, f64) {
    let cost = |side: f64| {
        let (hard, soft) = covered(rows, placed, axes, line, at + side * sum);
        hard + 0.2 * soft
    };
    // Below unless the other side is clearly better.
    let side = if cost(-way) + 50.0 < cost(way) { -way } else { way };
    let mut height = at + side * sum;
    for _ in 0..400 {
        if covered(rows, placed, axes, line, height).0 < 1.0 {
            break;
        }
        height += side * 8.0;
    }
    (height, side)
}

fn below(rows: &[Row], placed: &[(usize, f64)], axes: &Axes, line: usize) -> f64 {
    let edge = |row: &Row, side: usize| {
        let all = row.hard.iter().chain(&row.soft);
        all.map(|r| r.y[side])
            .fold(0.0, if side == 0 { f64::min } else { f64::max })
    };
    let lowest = placed
        .iter()
        .map(|(l, _)| axes.lines[*l] + edge(&rows[*l], 1))
        .fold(0.0, f64::max);
    lowest - edge(&rows[line], 0) + APART
}
