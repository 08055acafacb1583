//! The oil space of a housing from its description: sections of the drawing, or the hull of the gears; solids that displace oil.

use super::axis::Axis;
use super::members::Members;
use super::seats::GearSeat;
use crate::codes;
use crate::description::{GearboxEntry, InsideEntry, InsideSection};
use crate::document::Diagnostic;
use crate::registry::Memory;
use crate::sump::{CHORDS, Crowded, Disc, Inclinations, InclinedWalls, Outline, Space, Travel, Walls, hull};
use serde_json::Value;
use std::sync::Arc;

/// Radial and axial gap between gears and wall if none is stated: an assumption. \[m\]
const GAP: f64 = 0.01;

/// The upward direction of a housing that is not inclined.
const LEVEL: [f64; 3] = [0.0, 0.0, 1.0];

/// The inside of a housing.
#[derive(Debug, Clone)]
pub(crate) struct Inside {
    pub space: Arc<Space>,
    /// The spaces at the inclinations of a housing that travels.
    pub inclinations: Option<Arc<Inclinations>>,
    /// True if its sections are stated; otherwise it is the hull of the gears.
    pub drawn: bool,
    pub sections: Vec<Outline>,
    /// Stated area and horizontal length of the wall. \[m2 and m\]
    walls: [Option<f64>; 2],
    /// The upward direction, and the height of the datum along it. \[m\]
    pub up: ([f64; 3], f64),
    /// Where heights count from. \[m\]
    datum: [f64; 3],
    /// x and y of the middle of the sections, from the datum. \[m\]
    pub middle: [f64; 2],
}

/// The axis of each member with the radius of its orbit.
pub(crate) type Axes = [Option<(Axis, f64)>];

/// What determines the space, so that it is built once for descriptions that differ in other values.
#[derive(Debug, Clone, PartialEq)]
struct Input {
    sections: Vec<Outline>,
    discs: Vec<Disc>,
    up: [f64; 3],
    datum: f64,
}

impl Inside {
    /// The inside of the housing; `None` if it is not stated and the gears do not determine it: without gears, and with ring gears, which
    /// are part of a housing that no hull describes.
    pub fn new(
        (entry, document): (&GearboxEntry, &Value),
        members: &Members,
        gears: &[GearSeat],
        axes: &Axes,
        (up, datum): ([f64; 3], [f64; 3]),
        memory: &mut Memory,
        found: &mut Vec<Diagnostic>,
    ) -> Option<Self> {
        let stated = entry.housing.inside.clone().unwrap_or_default();
        let drawn = !stated.sections.is_empty();
        let sections = if drawn {
            drawn_sections(&stated, found)?
        } else {
            vec![of_gears(entry, &stated, gears, axes, memory)?]
        };
        let height_of = |up: [f64; 3]| height_along(up, datum);
        let height = height_of(up);
        let input = |up: [f64; 3]| Input {
            discs: discs((entry, document), members, gears, axes, &sections, (up, height_of(up))),
            sections: sections.clone(),
            up,
            datum: height_of(up),
        };
        // Solids are inside or not, however the housing is inclined; a surface that it makes narrow says less about that.
        let checked = memory.repeat("oil space", input(LEVEL), |input| {
            Space::new(&input.sections, input.discs.clone(), input.up, input.datum).map(Arc::new)
        });
        let space = checked.map(|level| {
            if up == LEVEL {
                return level;
            }
            memory.repeat("oil space as it is inclined", input(up), |input| {
                Arc::new(Space::unchecked(
                    &input.sections,
                    input.discs.clone(),
                    input.up,
                    input.datum,
                ))
            })
        });
        let mean = |ends: [f64; 2], origin: f64| f64::midpoint(ends[0], ends[1]) - origin;
        let middle = [
            mean(widest(sections.iter().map(|section| section.range)), datum[0]),
            mean(widest(sections.iter().map(Outline::extent)), datum[1]),
        ];
        let travel = entry
            .housing
            .travel
            .and_then(|travel| Travel::new(up, travel.direction()));
        let inclinations = travel.filter(|_| space.is_ok()).map(|travel| {
            let at: Vec<(Vec<Disc>, f64)> = travel
                .ups()
                .map(|up| {
                    let height = height_of(up);
                    let solids = discs((entry, document), members, gears, axes, &sections, (up, height));
                    (solids, height)
                })
                .collect();
            let input = (sections.clone(), travel, at, middle);
            memory.repeat("inclined oil space", input, |(sections, travel, at, middle)| {
                Arc::new(Inclinations::new(*travel, sections, at, *middle))
            })
        });
        match space {
            Ok(space) => Some(Self {
                space,
                inclinations,
                drawn,
                sections,
                walls: [stated.wall_area, stated.wall_length],
                up: (up, height),
                datum,
                middle,
            }),
            Err(Crowded(level)) => {
                // No one has stated the hull.
                found.extend(drawn.then(||
                    Diagnostic::error(
                        "housing.inside",
                        format!("gears and shafts reach out of the oil space {:.1} mm above the datum", level * 1e3),
                    )
                    .code(codes::OIL_SPACE)
                    .help("check the corners and ranges of the sections against the tip circles and positions of the gears")
                ));
                None
            }
        }
    }

    /// Walls above a level: those of the sections and their ends, and half the height of the space as the path of flight.
    pub fn walls(&self, level: f64) -> Walls {
        self.walls_along(self.up.0, &self.space, level)
    }

    /// The walls above the level that the oil below a level as built has at each inclination, if the housing travels. \[m\]
    pub fn inclined_walls(&self, level: f64) -> Option<InclinedWalls> {
        let volume = self.space.volume(level)[0];
        let spaces = self.inclinations.as_ref()?.exact();
        Some(InclinedWalls(
            spaces
                .map(|(up, space)| self.walls_along(up, space, space.level(volume)))
                .collect(),
        ))
    }

    /// Walls above a level with an upward direction. The horizontal length is twice the extent in both horizontal directions.
    fn walls_along(&self, up: [f64; 3], space: &Space, level: f64) -> Walls {
        let (mut area, mut length) = (0.0, 0.0_f64);
        let datum = height_along(up, self.datum);
        let rise = up[1].hypot(up[2]);
        for section in &self.sections {
            let along = section.length();
            let middle = 0.5 * (section.range[0] + section.range[1]);
            let at = |[y, z]: [f64; 2]| up[0] * middle + up[1] * y + up[2] * z - datum;
            let [rim, end] = section.above(at, level);
            let extent = |a: f64, b: f64| widest(section.corners.iter().map(|[y, z]| [(a * y + b * z) / rise; 2]));
            let ([bottom, top], [least, greatest]) = (extent(up[1], up[2]), extent(up[2], -up[1]));
            area += rim * along + 2.0 * end;
            length = length.max(2.0 * (rise * along + up[0].abs() * (top - bottom) + greatest - least));
        }
        let [stated, horizontal] = self.walls;
        Walls {
            area: stated.unwrap_or(area),
            length: horizontal.unwrap_or(length),
            flight: 0.5 * (space.top() - space.bottom()),
        }
    }

    /// What the space is, for findings.
    pub fn basis(&self) -> &'static str {
        if self.drawn {
            "in the sections of `housing.inside`"
        } else {
            "in the hull of the tip circles, an assumed inside of the housing"
        }
    }
}

/// Height of a point along the upward direction, from the origin. \[m\]
fn height_along(up: [f64; 3], point: [f64; 3]) -> f64 {
    if point[0] == 0.0 {
        up[1] * point[1] + up[2] * point[2]
    } else {
        up[0] * point[0] + up[1] * point[1] + up[2] * point[2]
    }
}

/// The range of all ranges.
fn widest(ranges: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |all, own| {
        [all[0].min(own[0]), all[1].max(own[1])]
    })
}

/// The stated sections; `None` with errors.
fn drawn_sections(stated: &InsideEntry, found: &mut Vec<Diagnostic>) -> Option<Vec<Outline>> {
    let before = found.len();
    let mut sections = Vec::new();
    for (id, section) in stated.sections.iter() {
        let path = format!("housing.inside.sections.{id}");
        match drawn_section(section) {
            Ok(outline) => sections.push(outline),
            Err((message, help)) => {
                found.push(Diagnostic::error(path, message).code(codes::OIL_SPACE).help(help));
            }
        }
    }
    (found.len() == before).then_some(sections)
}

fn drawn_section(section: &InsideSection) -> Result<Outline, (String, &'static str)> {
    if section.y.len() != section.z.len() {
        let message = format!("{} values of y and {} of z", section.y.len(), section.z.len());
        return Err((message, "state y and z of each corner"));
    }
    if section.from >= section.to {
        return Err(("the section ends before it begins".to_owned(), "swap `from` and `to`"));
    }
    let outline = Outline {
        corners: section.y.iter().zip(&section.z).map(|(y, z)| [*y, *z]).collect(),
        range: [section.from, section.to],
    };
    if outline.crosses_itself() || outline.area() <= 0.0 {
        return Err((
            "the corners are not those of a polygon: its sides cross or it has no area".to_owned(),
            "list the corners in order along the wall",
        ));
    }
    Ok(outline)
}

/// The hull of the gears with gaps; `None` if a section along x does not describe it.
fn of_gears(
    entry: &GearboxEntry,
    stated: &InsideEntry,
    gears: &[GearSeat],
    axes: &Axes,
    memory: &mut Memory,
) -> Option<Outline> {
    let is_along_x = |gear: &GearSeat| axes[gear.member].is_some_and(|(axis, _)| axis.is_along_x());
    if gears.iter().any(|gear| gear.ring || !is_along_x(gear)) {
        return None;
    }
    let clearance = entry.housing.clearance;
    let (radial, axial) = (clearance.map_or(GAP, |c| c.radial), clearance.map_or(GAP, |c| c.axial));
    let mut circles = Vec::new();
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for gear in gears.iter().filter(|gear| gear.diameters[1] > 0.0) {
        let (axis, orbit) = axes[gear.member]?;
        let [x, y, z] = axis.point(gear.at);
        circles.push(([y, z], orbit + 0.5 * gear.diameters[1] + radial));
        ends = [
            ends[0].min(x - 0.5 * gear.facewidth),
            ends[1].max(x + 0.5 * gear.facewidth),
        ];
    }
    if circles.is_empty() {
        return None;
    }
    let middle = 0.5 * (ends[0] + ends[1]);
    let half = 0.5 * stated.width.unwrap_or(ends[1] - ends[0] + 2.0 * axial);
    Some(Outline {
        corners: memory.repeat("hull of the gears", circles, |circles| hull(circles, CHORDS)),
        range: [middle - half, middle + half],
    })
}

/// Positions of a planet on its orbit over whose displaced volumes the mean is taken.
const POSITIONS: usize = 24;

/// Solid share of the ring between bore and outside of a rolling bearing: a convention.
const SOLID_BEARING: f64 = 0.6;

/// What displaces oil: gears as discs up to their reference circles, because tooth and space halve the ring between root and tip, sections
/// of shafts inside between them, and rolling bearings on shafts in the housing. Planets displace the mean over their orbit.
fn discs(
    (entry, document): (&GearboxEntry, &Value),
    members: &Members,
    gears: &[GearSeat],
    axes: &Axes,
    sections: &[Outline],
    (up, datum): ([f64; 3], f64),
) -> Vec<Disc> {
    // Width is that of all copies or of the solid share, extent that along the axis.
    let disc_of = |axis: &Axis, at: f64, radius: f64, [width, extent]: [f64; 2]| {
        let [x, y, z] = axis.point(at);
        let slope = if axis.is_along_x() {
            1.0 / up[1].hypot(up[2])
        } else {
            // The disc reaches from its lowest to its highest point, also if it lies flat.
            let [along, first, second] = axis.local(up);
            2.0 * radius / (2.0 * radius * first.hypot(second) + width.abs() * along.abs())
        };
        Disc {
            height: up[0] * x + up[1] * y + up[2] * z - datum,
            radius,
            width,
            slope,
            rise: if axis.is_along_x() { up[0] * extent * slope } else { 0.0 },
        }
    };
    let disc = |axis: &Axis, at: f64, radius: f64, width: f64| disc_of(axis, at, radius, [width; 2]);
    let fixed = |member: usize| axes[member].filter(|(_, orbit)| *orbit == 0.0).map(|(axis, _)| axis);
    let wheels = gears.iter().filter(|gear| !gear.ring && gear.diameters[0] > 0.0);
    let wheels: Vec<(Disc, Axis, [f64; 2])> = wheels
        .filter_map(|gear| {
            let axis = fixed(gear.member)?;
            let disc = disc(&axis, gear.at, 0.5 * gear.diameters[0], gear.facewidth);
            Some((
                disc,
                axis,
                [gear.at - 0.5 * gear.facewidth, gear.at + 0.5 * gear.facewidth],
            ))
        })
        .collect();
    let mut discs: Vec<Disc> = wheels.iter().map(|(disc, ..)| *disc).collect();
    for (member, (_, shaft)) in entry.shafts.iter().enumerate() {
        let Some(axis) = members.axes[member] else { continue };
        for part in &shaft.sections {
            let mut free: Vec<[f64; 2]> = sections
                .iter()
                .map(|section| both([part.from, part.to], reach(&axis, section)))
                .collect();
            for (_, _, taken) in wheels.iter().filter(|(_, own, _)| *own == axis) {
                free = free
                    .iter()
                    .flat_map(|range| [[range[0], range[1].min(taken[0])], [range[0].max(taken[1]), range[1]]])
                    .collect();
                free.retain(|range| range[1] > range[0]);
            }
            let free = free.iter().filter(|range| range[1] > range[0]);
            discs.extend(free.map(|range| {
                let middle = 0.5 * (range[0] + range[1]);
                disc(&axis, middle, 0.5 * part.outer, range[1] - range[0])
            }));
        }
    }
    let planets = gears.iter().filter(|gear| !gear.ring && gear.diameters[0] > 0.0);
    for (gear, (axis, orbit)) in planets.filter_map(|gear| Some((gear, axes[gear.member]?))) {
        let count = planets_of(entry, members, gear.member);
        if orbit == 0.0 || count == 0.0 {
            continue;
        }
        discs.extend((0..POSITIONS).map(|position| {
            let (sine, cosine) = (std::f64::consts::TAU * position as f64 / POSITIONS as f64).sin_cos();
            let [_, first, second] = axis.frame;
            let orbiting = Axis {
                origin: std::array::from_fn(|i| axis.origin[i] + orbit * (cosine * first[i] + sine * second[i])),
                ..axis
            };
            let width = gear.facewidth * count / POSITIONS as f64;
            disc_of(&orbiting, gear.at, 0.5 * gear.diameters[0], [width, gear.facewidth])
        }));
    }
    let bearings = document["bearings"].as_object().into_iter().flatten();
    for (_, bearing) in bearings.filter(|(_, bearing)| matches!(bearing["outer"].as_str(), None | Some("housing"))) {
        let number = |key: &str| bearing[key].as_f64();
        let member = members.names.iter().position(|name| bearing["shaft"] == name.as_str());
        let (Some(axis), Some(at), Some(width)) = (member.and_then(fixed), number("at"), number("width")) else {
            continue;
        };
        let (Some(bore), Some(outside)) = (number("bore"), number("outside")) else {
            continue;
        };
        for section in sections {
            let range = both([at - 0.5 * width, at + 0.5 * width], reach(&axis, section));
            let solid = SOLID_BEARING * (range[1] - range[0]);
            if solid > 0.0 && outside > bore {
                // A ring is the difference of two discs.
                let ring = [(outside, solid), (bore, -solid)];
                let extent = range[1] - range[0];
                // The part that is inside.
                let at = if axis.is_along_x() {
                    f64::midpoint(range[0], range[1])
                } else {
                    at
                };
                discs.extend(ring.map(|(diameter, width)| disc_of(&axis, at, 0.5 * diameter, [width, extent])));
            }
        }
    }
    discs
}

/// Positions between which an axis is in a section: between its ends and between its outermost corners. \[m\]
fn reach(axis: &Axis, section: &Outline) -> [f64; 2] {
    let [x, y, _] = axis.direction();
    let within = |range: [f64; 2], origin: f64, slope: f64| {
        if slope == 0.0 {
            let inside = range[0] <= origin && origin <= range[1];
            return if inside {
                [f64::NEG_INFINITY, f64::INFINITY]
            } else {
                [0.0; 2]
            };
        }
        let [a, b] = range.map(|end| (end - origin) / slope);
        [a.min(b), a.max(b)]
    };
    let along = within(section.range, axis.origin[0], x);
    if axis.is_along_x() {
        return along;
    }
    both(along, within(section.extent(), axis.origin[1], y))
}

/// Number of copies of a planet body; zero for other members.
fn planets_of(entry: &GearboxEntry, members: &Members, member: usize) -> f64 {
    let name = &members.names[member];
    let mut sets = entry.planetary_sets.iter();
    sets.find(|(_, set)| set.planets.contains(name))
        .map_or(0.0, |(_, set)| f64::from(set.count))
}

/// What two ranges have in common.
fn both(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}
