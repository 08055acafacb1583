//! Two views of a gearbox whose axes are not all parallel: from above, and from the side below it, both to one scale.
//!
//! Gears, shafts and bearings are bodies of revolution about their axes; the outline of one in a view is the hull of its end circles. Bodies
//! that are nearer to the viewer cover those behind them.

mod cuts;

use super::canvas::{Canvas, Rect, Voice};
use super::draw::{self, CENTRE, FIXED, LOOSE, PORT, SHAFT, round_length};
use super::things::{Kind, Part, Symbol, Things};
use cuts::Cuts;
use gearloss_framework::transmission::{Axis, Transmission};

/// Width and height of one view. \[px\]
const WIDTH: f64 = 520.0;
const HEIGHT: f64 = 360.0;
/// Room between both views, with their names. \[px\]
const BETWEEN: f64 = 64.0;
/// Corners of a circle.
const CORNERS: usize = 48;
/// Length of the arrow of a port. \[px\]
const ARROW: f64 = 30.0;
/// Component of a direction in the plane of a view below which its axis is seen from its end.
const FROM_END: f64 = 0.2;
/// Radius of a shaft without stated sections, over the largest tip radius.
const THIN: f64 = 0.09;

const BEARING: &str = "class=\"bearing\" fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.1\"";
const CROSS: &str = "class=\"line\" fill=\"none\" stroke=\"#111\" stroke-width=\"0.9\"";
const SEAL: &str = "class=\"seal\" fill=\"#8fd8c1\" stroke=\"#00553e\" stroke-width=\"1\"";
const SLEEVE: &str = "class=\"coupling\" fill=\"#f3c6a5\" stroke=\"#b04a00\" stroke-width=\"1.2\"";
const OTHER: &str = "class=\"other\" fill=\"#eed9e6\" stroke=\"#8a3f6b\" stroke-width=\"1.2\"";

/// A direction of view: which coordinates point to the right and upwards on the page, and which towards the viewer.
struct View {
    name: &'static str,
    right: usize,
    up: usize,
    near: (usize, f64),
}

const VIEWS: [View; 2] = [
    View {
        name: "from above (x to the right, y upwards)",
        right: 0,
        up: 1,
        near: (2, 1.0),
    },
    View {
        name: "from the side (x to the right, z upwards)",
        right: 0,
        up: 2,
        near: (1, -1.0),
    },
];

/// A body of revolution: both ends along its axis with their radii. \[m\]
#[derive(Clone, Copy)]
struct Body {
    ends: [f64; 2],
    radii: [f64; 2],
}

/// What a body is.
enum What {
    Shaft(usize),
    Gear(usize),
    Part(usize),
}

struct Solid<'a> {
    what: What,
    axis: &'a Axis,
    body: Body,
}

impl Solid<'_> {
    /// Points of both end circles. \[m\]
    fn points(&self) -> Vec<[f64; 3]> {
        let [_, e2, e3] = self.axis.frame;
        let mut points = Vec::with_capacity(2 * CORNERS);
        for (at, radius) in self.body.ends.into_iter().zip(self.body.radii) {
            let middle = self.axis.point(at);
            points.extend((0..CORNERS).map(|corner| {
                let (sine, cosine) = (corner as f64 / CORNERS as f64 * std::f64::consts::TAU).sin_cos();
                std::array::from_fn(|i| middle[i] + radius * (cosine * e2[i] + sine * e3[i]))
            }));
        }
        points
    }
}

/// True if the gearbox needs these views.
pub(super) fn is_needed(transmission: &Transmission) -> bool {
    transmission.axes().iter().any(|axis| !axis.is_along_x())
}

/// Draws both views; the members, gears and parts are those of the unfolded drawing.
pub(super) fn projected(transmission: &Transmission, things: &Things) -> String {
    let mut solids = solids(transmission, things);
    let cuts = shortened(transmission.axes(), things, &mut solids);
    let points: Vec<[f64; 3]> = solids.iter().flat_map(Solid::points).collect();
    let extent = |coordinate: usize| {
        let values = points.iter().map(|point| point[coordinate]);
        [
            values.clone().fold(f64::INFINITY, f64::min),
            values.fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let size = |coordinate: usize| (extent(coordinate)[1] - extent(coordinate)[0]).max(1e-3);
    let scale = (WIDTH / size(0)).min(HEIGHT / size(1).max(size(2)));
    let mut canvas = Canvas::default();
    let mut top = 0.0;
    for view in &VIEWS {
        let place = |point: [f64; 3]| {
            [
                scale * (point[view.right] - extent(view.right)[0]),
                top + scale * (extent(view.up)[1] - point[view.up]),
            ]
        };
        let mut page = Page {
            canvas: &mut canvas,
            things,
            axes: transmission.axes(),
            cuts: &cuts,
            view,
            scale,
        };
        page.draw(&solids, &place);
        page.canvas.write_words();
        let bottom = canvas.extent().y[1];
        canvas.foot(0.0, bottom + 22.0, view.name);
        top = bottom + BETWEEN;
    }
    foot(&mut canvas, scale, cuts.any());
    canvas.finish(&format!("Views of {}", transmission.title()))
}

fn foot(canvas: &mut Canvas, scale: f64, cut: bool) {
    let y = canvas.extent().y[1] + 26.0;
    let bar = round_length(90.0 / scale);
    let length = bar * scale;
    canvas.line(
        &[[0.0, y - 4.0], [0.0, y], [length, y], [length, y - 4.0]],
        "class=\"line\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.5\"",
    );
    canvas.foot(length + 8.0, y + 1.0, &format!("{} mm", 1e3 * bar));
    canvas.foot(
        0.0,
        y + 22.0,
        "Blue gears are fixed to their shaft, amber gears turn freely on it.",
    );
    if cut {
        canvas.foot(0.0, y + 40.0, "Long shafts are shortened at the double lines.");
    }
}

/// The number of an axis in space: that of the first member on it.
fn line_of_member(axes: &[Axis], member: usize) -> usize {
    let same = axes.iter().position(|axis| axis.is_same(&axes[member]));
    same.unwrap_or(member)
}

/// Shortens long bare shafts, so that the gears are large enough to be seen.
fn shortened(axes: &[Axis], things: &Things, solids: &mut [Solid<'_>]) -> Cuts {
    let largest = things.wheels.iter().map(|wheel| wheel.radius).fold(0.0, f64::max);
    let line_of = |what: &What| {
        let member = match *what {
            What::Shaft(member) => member,
            What::Gear(number) => things.wheels[number].member,
            What::Part(number) => things.parts[number].between.into_iter().flatten().next().unwrap_or(0),
        };
        line_of_member(axes, member)
    };
    let bodies = solids.iter().filter_map(|solid| {
        let is_gear = matches!(solid.what, What::Gear(_));
        (!matches!(solid.what, What::Shaft(_))).then(|| (line_of(&solid.what), solid.body.ends, is_gear))
    });
    let cuts = Cuts::new(axes.len(), bodies, largest);
    for solid in solids {
        let line = line_of(&solid.what);
        solid.body.ends = solid.body.ends.map(|at| cuts.place(line, at));
    }
    cuts
}

/// All bodies, shafts first.
fn solids<'a>(transmission: &'a Transmission, things: &Things) -> Vec<Solid<'a>> {
    let axes = transmission.axes();
    let largest = things.wheels.iter().map(|wheel| wheel.radius).fold(0.0, f64::max);
    let thin = THIN * largest.max(0.02);
    let gears: Vec<Body> = (0..things.wheels.len())
        .map(|i| gear(transmission, things, i))
        .collect();
    let parts: Vec<Option<Body>> = (things.parts.iter()).map(|own| part(own, thin)).collect();
    let mut solids = Vec::new();
    for (member, axis) in axes.iter().enumerate() {
        if things.members[member].kind != Kind::Shaft {
            continue;
        }
        let of_gears = things.wheels.iter().zip(&gears);
        let of_gears = of_gears.filter(|(wheel, _)| things.shaft_of(wheel.member) == member);
        let of_parts = things.parts.iter().zip(&parts);
        let of_parts =
            of_parts.filter(|(own, _)| own.between.into_iter().flatten().any(|m| things.shaft_of(m) == member));
        let bodies = of_gears
            .map(|(_, body)| *body)
            .chain(of_parts.filter_map(|(_, body)| *body));
        let ends = bodies.fold([f64::INFINITY, f64::NEG_INFINITY], |ends, body| {
            [
                body.ends.into_iter().fold(ends[0], f64::min),
                body.ends.into_iter().fold(ends[1], f64::max),
            ]
        });
        if ends[0] < ends[1] {
            solids.push(Solid {
                what: What::Shaft(member),
                axis,
                body: Body {
                    ends: [ends[0] - thin, ends[1] + thin],
                    radii: [thin; 2],
                },
            });
        }
    }
    for (number, body) in gears.into_iter().enumerate() {
        let axis = &axes[things.wheels[number].member];
        let what = What::Gear(number);
        solids.push(Solid { what, axis, body });
    }
    for (number, body) in parts.into_iter().enumerate() {
        let member = things.parts[number].between.into_iter().flatten().next();
        if let (Some(member), Some(body)) = (member, body) {
            let axis = &axes[member];
            let what = What::Part(number);
            solids.push(Solid { what, axis, body });
        }
    }
    solids
}

/// A gear: a cylinder, or the tip cone of a bevel gear.
fn gear(transmission: &Transmission, things: &Things, number: usize) -> Body {
    let (wheel, seat) = (&things.wheels[number], &transmission.gears()[number]);
    let cone = transmission.cone_of_gear(number);
    match cone.filter(|_| seat.tip_at != seat.at) {
        Some((angle, along)) => Body {
            ends: [seat.tip_at, seat.tip_at - along * wheel.width * angle.cos()],
            radii: [
                wheel.radius,
                (wheel.radius - wheel.width * angle.sin()).max(0.1 * wheel.radius),
            ],
        },
        None => Body {
            ends: [wheel.at - 0.5 * wheel.width, wheel.at + 0.5 * wheel.width],
            radii: [wheel.radius; 2],
        },
    }
}

/// A component with a stated position.
fn part(own: &Part, thin: f64) -> Option<Body> {
    let at = own.at?;
    let half = 0.5 * own.size[0].unwrap_or(2.0 * thin);
    let high = own.size[1].unwrap_or(2.0 * thin);
    Some(Body {
        ends: [at - half, at + half],
        radii: [thin + high; 2],
    })
}

/// One view.
struct Page<'a> {
    canvas: &'a mut Canvas,
    things: &'a Things,
    axes: &'a [Axis],
    cuts: &'a Cuts,
    view: &'a View,
    scale: f64,
}

impl Page<'_> {
    fn draw(&mut self, solids: &[Solid<'_>], place: &dyn Fn([f64; 3]) -> [f64; 2]) {
        let (near, sign) = self.view.near;
        // The far ones first; a shaft before what is on it.
        let depth = |solid: &Solid<'_>| {
            let middle = solid.axis.point(0.5 * (solid.body.ends[0] + solid.body.ends[1]));
            sign * middle[near]
        };
        let mut order: Vec<&Solid<'_>> = solids.iter().collect();
        order.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        for solid in solids.iter().filter(|solid| matches!(solid.what, What::Shaft(_))) {
            let reach = 0.02;
            let [from, to] = solid.body.ends;
            let line = [from - reach, to + reach].map(|at| place(solid.axis.point(at)));
            self.canvas.line(&line, CENTRE);
        }
        for solid in order {
            self.solid(solid, place);
        }
        for port in 0..self.things.ports.len() {
            self.port(port, solids, place);
        }
    }

    fn solid(&mut self, solid: &Solid<'_>, place: &dyn Fn([f64; 3]) -> [f64; 2]) {
        let corners = hull(solid.points().into_iter().map(place).collect());
        let room = bounds(&corners);
        let things = self.things;
        match solid.what {
            What::Shaft(member) => {
                let name = &things.members[member].name;
                self.canvas.open(&format!("shafts.{name}"), name);
                self.canvas.shape(&corners, SHAFT);
                self.marks(member, solid, place);
                self.canvas.close();
                self.canvas.avoid(room);
                if !self.is_seen_from_end(solid.axis)
                    && !things.ports.iter().any(|port| port.1 == member && port.0 == *name)
                {
                    self.canvas.word(name.clone(), room, None, Voice::Quiet);
                }
            }
            What::Gear(number) => {
                let wheel = &things.wheels[number];
                let loose = matches!(things.members[wheel.member].kind, Kind::Loose(_));
                self.canvas.open(
                    &format!("gears.{}", wheel.id),
                    &format!("{}: z = {}", wheel.id, wheel.z),
                );
                self.canvas.shape(&corners, if loose { LOOSE } else { FIXED });
                self.canvas.close();
                self.canvas.shade(room);
                self.canvas.word(draw::label(&wheel.id, 1.0), room, None, Voice::Plain);
            }
            What::Part(number) => {
                let own = &things.parts[number];
                let style = match own.symbol {
                    Symbol::Bearing => BEARING,
                    Symbol::Seal => SEAL,
                    Symbol::Sleeve | Symbol::Clutch => SLEEVE,
                    Symbol::Other => OTHER,
                };
                self.canvas.open(&own.path, &own.path);
                self.canvas.shape(&corners, style);
                if own.symbol == Symbol::Bearing {
                    self.cross(solid, place);
                }
                self.canvas.close();
                self.canvas.avoid(room);
                if !self.is_seen_from_end(solid.axis) {
                    self.canvas
                        .word(draw::label(&own.id, own.count), room, None, Voice::Plain);
                }
            }
        }
    }

    /// True if an axis is seen from its end: what is on it lies behind each other, and its names are in the other view.
    fn is_seen_from_end(&self, axis: &Axis) -> bool {
        let direction = axis.direction();
        direction[self.view.right].hypot(direction[self.view.up]) < FROM_END
    }

    /// Double lines across a shaft where it is shortened.
    fn marks(&mut self, member: usize, solid: &Solid<'_>, place: &dyn Fn([f64; 3]) -> [f64; 2]) {
        if self.is_seen_from_end(solid.axis) {
            return;
        }
        let direction = solid.axis.direction();
        let flat = direction[self.view.right].hypot(direction[self.view.up]);
        let [u, v] = [direction[self.view.right] / flat, direction[self.view.up] / flat];
        let reach = solid.body.radii[0] * self.scale + 4.0;
        let [from, to] = solid.body.ends;
        for at in self.cuts.marks(line_of_member(self.axes, member)) {
            if at <= from || at >= to {
                continue;
            }
            let [x, y] = place(solid.axis.point(at));
            for side in [-3.0, 3.0] {
                let [x, y] = [x + side * u, y - side * v];
                let line = [
                    [x - reach * v - 2.0 * u, y - reach * u + 2.0 * v],
                    [x + reach * v + 2.0 * u, y + reach * u - 2.0 * v],
                ];
                self.canvas.line(&line, CROSS);
            }
        }
    }

    /// The diagonals of a bearing that is seen from the side.
    fn cross(&mut self, solid: &Solid<'_>, place: &dyn Fn([f64; 3]) -> [f64; 2]) {
        let axis = solid.axis;
        let direction = axis.direction();
        let flat = direction[self.view.right].hypot(direction[self.view.up]);
        if flat < 0.5 {
            return;
        }
        // Across the axis in the plane of the view.
        let [u, v] = [direction[self.view.right] / flat, direction[self.view.up] / flat];
        let [from, to] = solid.body.ends.map(|at| place(axis.point(at)));
        let reach = solid.body.radii[0] * self.scale;
        let corner = |[x, y]: [f64; 2], side: f64| [x + side * reach * v, y + side * reach * u];
        self.canvas.line(&[corner(from, 1.0), corner(to, -1.0)], CROSS);
        self.canvas.line(&[corner(from, -1.0), corner(to, 1.0)], CROSS);
    }

    /// An arrow along the shaft, or a ring around a shaft that is seen from its end.
    fn port(&mut self, number: usize, solids: &[Solid<'_>], place: &dyn Fn([f64; 3]) -> [f64; 2]) {
        let (name, member) = &self.things.ports[number];
        let shaft = self.things.shaft_of(*member);
        let Some(solid) = solids
            .iter()
            .find(|solid| matches!(solid.what, What::Shaft(own) if own == shaft))
        else {
            return;
        };
        let axis = &self.axes[shaft];
        let direction = axis.direction();
        let flat = direction[self.view.right].hypot(direction[self.view.up]);
        self.canvas.open(
            &format!("ports.{name}"),
            &format!("port {name} at {}", self.things.members[*member].name),
        );
        let room = if flat < FROM_END {
            let [x, y] = place(axis.point(solid.body.ends[1]));
            let radius = solid.body.radii[0] * self.scale + 4.0;
            self.canvas.circle(
                [x, y],
                radius,
                "class=\"line\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.6\"",
            );
            Rect::about(x, y, 2.0 * radius, 2.0 * radius)
        } else {
            let outer = self.outer_end(shaft, solids);
            let [x, y] = place(axis.point(solid.body.ends[outer]));
            let side = if outer == 0 { -1.0 } else { 1.0 };
            let way = [
                side * direction[self.view.right] / flat,
                -side * direction[self.view.up] / flat,
            ];
            let far = [x + ARROW * way[0], y + ARROW * way[1]];
            let (tail, tip) = if number == self.things.reference {
                (far, [x, y])
            } else {
                ([x, y], far)
            };
            let along = [(tip[0] - tail[0]) / ARROW, (tip[1] - tail[1]) / ARROW];
            let neck = |back: f64, across: f64| {
                [
                    tip[0] - back * along[0] - across * along[1],
                    tip[1] - back * along[1] + across * along[0],
                ]
            };
            self.canvas.line(&[tail, neck(8.0, 0.0)], PORT);
            self.canvas.shape(&[tip, neck(11.0, 5.0), neck(11.0, -5.0)], PORT);
            bounds(&[tail, tip, neck(11.0, 5.0), neck(11.0, -5.0)])
        };
        self.canvas.close();
        self.canvas.avoid(room);
        if flat >= FROM_END {
            self.canvas.word(name.clone(), room, None, Voice::Loud);
        }
    }

    /// The end of a shaft that is further from its gears, or from those of others on its axis: the second one unless they are nearer to it.
    fn outer_end(&self, shaft: usize, solids: &[Solid<'_>]) -> usize {
        let line = line_of_member(self.axes, shaft);
        let middles = |belongs: &dyn Fn(usize) -> bool| -> Vec<f64> {
            let own = solids.iter().filter(|solid| match solid.what {
                What::Gear(number) => belongs(self.things.wheels[number].member),
                _ => false,
            });
            own.map(|solid| 0.5 * (solid.body.ends[0] + solid.body.ends[1]))
                .collect()
        };
        let mut gears = middles(&|member| self.things.shaft_of(member) == shaft);
        if gears.is_empty() {
            gears = middles(&|member| line_of_member(self.axes, member) == line);
        }
        let ends = solids.iter().find_map(|solid| match solid.what {
            What::Shaft(own) if own == shaft => Some(solid.body.ends),
            _ => None,
        });
        let (Some([from, to]), false) = (ends, gears.is_empty()) else {
            return 1;
        };
        let mean = gears.iter().sum::<f64>() / gears.len() as f64;
        usize::from(to - mean >= mean - from)
    }
}

/// The convex hull of some points, in order.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) <= 1e-9 {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut outline = half(&mut points.iter().copied());
    outline.extend(half(&mut points.iter().rev().copied()));
    outline
}

fn bounds(points: &[[f64; 2]]) -> Rect {
    let range = |i: usize| {
        let values = points.iter().map(|point| point[i]);
        [
            values.clone().fold(f64::INFINITY, f64::min),
            values.fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    Rect::new(range(0), range(1))
}
