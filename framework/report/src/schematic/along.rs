//! Positions along the shafts in px; things without a stated position get a free one.

mod free;
mod levels;
mod sets;

use super::things::{Kind, Part, Symbol, Things};

/// A piece of an axis. \[px\]
pub(super) type Span = [f64; 2];

pub(super) const LEFT: f64 = -1.0;
pub(super) const RIGHT: f64 = 1.0;

/// Length of the arrow of a port. \[px\]
pub(super) const ARROW: f64 = 34.0;
/// Distance between things that get a free position. \[px\]
const AIR: f64 = 6.0;
/// Width of the box of a differential. \[px\]
pub(super) const AXLE: f64 = 44.0;
/// Width of a chain and its wheels. \[px\]
pub(super) const CHAIN: f64 = 10.0;

/// Positions along the shafts.
#[derive(Debug, Default)]
pub(super) struct Along {
    /// Faces of every gear.
    pub wheels: Vec<Span>,
    /// Middle of every component.
    pub parts: Vec<f64>,
    /// Which of the two members of a component is on its left: zero or one.
    pub left: Vec<usize>,
    /// Middle of every differential.
    pub axles: Vec<f64>,
    /// By member: the leg that carries a planet body.
    pub legs: Vec<Option<f64>>,
    /// By gear: the web that joins a ring to its shaft.
    pub webs: Vec<Option<f64>>,
    /// End of the shaft at every port, and the side to which it points.
    pub ends: Vec<(f64, f64)>,
    /// By member: start and end of its drawing.
    pub extents: Vec<Option<Span>>,
    /// By member: number of coaxial shafts inside it.
    pub levels: Vec<usize>,
}

/// Width of a component. \[px\]
pub(super) fn width(part: &Part, scale: f64) -> f64 {
    match part.symbol {
        Symbol::Bearing => part.size[0].map_or(16.0, |w| (w * scale).max(7.0)),
        Symbol::Seal => 12.0,
        Symbol::Sleeve => 18.0,
        Symbol::Clutch => 24.0,
        Symbol::Other => 16.0,
    }
}

fn middle(span: Span) -> f64 {
    0.5 * (span[0] + span[1])
}

fn join(a: Option<Span>, b: Span) -> Span {
    a.map_or(b, |a| [a[0].min(b[0]), a[1].max(b[1])])
}

struct Work<'a> {
    things: &'a Things,
    scale: f64,
    along: Along,
    /// Occupied pieces of each axis: of every line, then of every member that is a planet body.
    taken: Vec<Vec<Span>>,
}

/// Positions everything at a scale in px/m.
pub(super) fn along(things: &Things, scale: f64) -> Along {
    let count = things.members.len();
    let mut work = Work {
        things,
        scale,
        along: Along {
            legs: vec![None; count],
            webs: vec![None; things.wheels.len()],
            extents: vec![None; count],
            levels: vec![0; count],
            parts: vec![0.0; things.parts.len()],
            left: vec![0; things.parts.len()],
            ..Along::default()
        },
        taken: vec![Vec::new(); things.lines + count],
    };
    work.stated();
    work.differentials();
    let sides = work.port_sides();
    work.carriers(&sides);
    work.rings(&sides);
    for i in 0..things.parts.len() {
        if things.parts[i].at.is_none() {
            work.unstated(i, &sides);
        }
    }
    work.ports(&sides);
    work.bare();
    work.along.levels = work.levels();
    work.along
}

impl Work<'_> {
    fn track(&self, member: usize) -> usize {
        if self.things.is_planet(member) {
            self.things.lines + member
        } else {
            self.things.members[member].line
        }
    }

    fn extend(&mut self, member: usize, span: Span) {
        let shaft = self.things.shaft_of(member);
        self.along.extents[shaft] = Some(join(self.along.extents[shaft], span));
    }

    fn take(&mut self, member: usize, span: Span) {
        let track = self.track(member);
        self.taken[track].push(span);
    }

    /// Middle of the next free piece of a member's axis.
    fn free(&self, member: usize, start: f64, side: f64, width: f64) -> f64 {
        let taken = &self.taken[self.track(member)];
        let half = 0.5 * width + AIR;
        let mut x = start + side * half;
        // Each piece blocks at most once, because the search has one direction.
        for _ in 0..taken.len() {
            let Some(block) = taken.iter().find(|t| t[0] < x + half - 0.1 && t[1] > x - half + 0.1) else {
                break;
            };
            x = if side > 0.0 { block[1] + half } else { block[0] - half };
        }
        x
    }

    fn stated(&mut self) {
        let things = self.things;
        for wheel in &things.wheels {
            let half = 0.5 * (wheel.width * self.scale).max(4.0);
            let x = wheel.at * self.scale;
            let face = [x - half, x + half];
            self.along.wheels.push(face);
            if !wheel.ring {
                self.extend(wheel.member, face);
                self.take(wheel.member, face);
            }
        }
        for chain in &things.chains {
            let x = chain.at * self.scale;
            for member in chain.members {
                self.extend(member, [x - 0.5 * CHAIN, x + 0.5 * CHAIN]);
                self.take(member, [x - 0.5 * CHAIN, x + 0.5 * CHAIN]);
            }
        }
        for (i, part) in things.parts.iter().enumerate() {
            if let Some(at) = part.at {
                self.put(i, at * self.scale);
            }
        }
    }

    /// Places a component at a position and extends its shafts to it.
    fn put(&mut self, i: usize, x: f64) {
        let part = &self.things.parts[i];
        let half = 0.5 * width(part, self.scale);
        self.along.parts[i] = x;
        let Some(first) = part.between[0].or(part.between[1]) else {
            return;
        };
        // A component inside an idler gear or a planet occupies no piece of the axis.
        let inside = part.symbol == Symbol::Bearing && part.between[1].is_some();
        if !inside {
            self.take(first, [x - half, x + half]);
        }
        match part.between {
            [Some(a), Some(b)] if matches!(part.symbol, Symbol::Sleeve | Symbol::Clutch) => {
                let at = |m: usize| self.along.extents[self.things.shaft_of(m)].map_or(x, middle);
                let place = |m: usize| match self.things.members[m].kind {
                    Kind::Loose(_) => self.things.wheel_of(m).map_or(x, |g| middle(self.along.wheels[g])),
                    _ => at(m),
                };
                let left = usize::from(place(b) < place(a));
                self.along.left[i] = left;
                self.extend(part.between[left].unwrap_or(a), [x - 5.0, x - 4.0]);
                self.extend(part.between[1 - left].unwrap_or(b), [x + 4.0, x + 5.0]);
            }
            between => {
                for member in between.into_iter().flatten() {
                    // A pin bearing does not extend the shaft of its carrier.
                    if self.things.is_planet(first) && member != first {
                        continue;
                    }
                    if !self.things.floats(member) {
                        self.extend(member, [x - half, x + half]);
                    }
                }
            }
        }
    }

    fn differentials(&mut self) {
        let things = self.things;
        for axle in &things.axles {
            let start = self.along.extents[axle.case].map_or(0.0, |e| e[1]);
            let x = self.free(axle.case, start, RIGHT, AXLE);
            self.along.axles.push(x);
            let half = 0.5 * AXLE;
            self.take(axle.case, [x - half, x + half]);
            self.extend(axle.case, [x - half, x - half + 1.0]);
            self.extend(axle.sides[0], [x - 14.0, x - 8.0]);
            self.extend(axle.sides[1], [x + 8.0, x + 14.0]);
        }
    }

    /// The side to which each port points: outer ports of an axis outwards, a single port by its role.
    fn port_sides(&self) -> Vec<f64> {
        let things = self.things;
        let mut sides = vec![RIGHT; things.ports.len()];
        for line in 0..things.lines {
            let mut ports: Vec<(f64, usize)> = (0..things.ports.len())
                .filter(|p| things.members[things.ports[*p].1].line == line)
                .map(|p| {
                    (
                        self.along.extents[things.shaft_of(things.ports[p].1)].map_or(0.0, middle),
                        p,
                    )
                })
                .collect();
            // Among equals the reference port is first.
            ports.sort_by(|a, b| {
                a.0.total_cmp(&b.0)
                    .then((a.1 != things.reference).cmp(&(b.1 != things.reference)))
            });
            let count = ports.len();
            for (rank, (x, port)) in ports.into_iter().enumerate() {
                sides[port] = if count == 1 {
                    self.side_of_single(things.ports[port].1, x, port == things.reference)
                } else if 2 * rank < count {
                    LEFT
                } else {
                    RIGHT
                };
            }
        }
        sides
    }

    /// A port that is alone on its axis points away from the other shafts of the axis; without other shafts the reference port is on the
    /// left.
    fn side_of_single(&self, member: usize, x: f64, reference: bool) -> f64 {
        let line = self.things.members[member].line;
        let others: Vec<f64> = (0..self.things.members.len())
            .filter(|m| *m != member && self.things.members[*m].line == line && !self.things.is_planet(*m))
            .filter_map(|m| self.along.extents[m].map(middle))
            .collect();
        let mean = others.iter().sum::<f64>() / others.len().max(1) as f64;
        match (others.is_empty() || (x - mean).abs() < 1.0, reference) {
            (true, true) => LEFT,
            (true, false) => RIGHT,
            _ => (x - mean).signum(),
        }
    }

    fn ports(&mut self, sides: &[f64]) {
        let things = self.things;
        self.along.ends = vec![(0.0, RIGHT); things.ports.len()];
        let reach = |work: &Self, port: usize| {
            let shaft = things.shaft_of(things.ports[port].1);
            work.along.extents[shaft].map_or(0.0, |e| if sides[port] > 0.0 { e[1] } else { -e[0] })
        };
        let mut order: Vec<usize> = (0..things.ports.len()).collect();
        // The shorter shaft is the outer one.
        order.sort_by(|a, b| reach(self, *a).total_cmp(&reach(self, *b)));
        for port in order {
            let (member, side) = (things.ports[port].1, sides[port]);
            let extents = self.along.extents[things.shaft_of(member)].into_iter();
            let all = self.taken[self.track(member)].iter().copied().chain(extents);
            let outer = all
                .map(|t| side * if side > 0.0 { t[1] } else { t[0] })
                .fold(f64::NEG_INFINITY, f64::max);
            let end = if outer.is_finite() { side * outer } else { 0.0 } + side * 16.0;
            self.along.ends[port] = (end, side);
            self.extend(member, [end, end]);
            self.take(
                member,
                if side > 0.0 {
                    [end, end + ARROW]
                } else {
                    [end - ARROW, end]
                },
            );
        }
    }

    /// Shafts without components get a minimum length.
    fn bare(&mut self) {
        for member in 0..self.things.members.len() {
            let empty = self.along.extents[member].is_none();
            let carrier = self.things.members.iter().any(|m| m.kind == Kind::Planet(member));
            if empty && self.things.members[member].kind == Kind::Shaft && !carrier && !self.things.floats(member) {
                let x = self.free(member, 0.0, RIGHT, 30.0);
                self.extend(member, [x - 15.0, x + 15.0]);
                self.take(member, [x - 15.0, x + 15.0]);
            }
        }
    }
}
