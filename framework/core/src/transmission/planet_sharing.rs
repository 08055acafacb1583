//! Load sharing among planets: stated, or from position errors of their pins.

use std::sync::Arc;

use serde_json::Value;

use super::members::Members;
use super::seats::{GearSeat, MeshSeat, materials_of};
use crate::attach::dangling;
use crate::codes;
use crate::contact::sharing::stiffness::single_stiffness;
use crate::description::GearboxEntry;
use crate::description::gears::PlanetarySetEntry;
use crate::description::pins::PinsEntry;
use crate::document::Diagnostic;
use crate::loads::{ElasticPlanets, PinForces};
use crate::real::Real;

/// Unequal load sharing among the planets of a set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sharing {
    /// Id of the set.
    pub set: String,
    /// Number of planets with each of the different loads, the greatest load first.
    counts: Vec<f64>,
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// Load over the mean of the most loaded planet, and of each other planet.
    Stated([f64; 2]),
    /// From the forces of pins pushed forwards and backwards.
    Calculated(Box<Calculated>),
}

#[derive(Debug, Clone, PartialEq)]
struct Calculated {
    elastic: ElasticPlanets,
    floating: Vec<Floating>,
    /// Numbers of both meshes, with the tangential force of the pin per tangential force of the first gear. \[-\]
    pins: [(usize, f64); 2],
    /// Forces of the planets in their order.
    forces: [PinForces; 2],
    /// The different forces, the greatest first, by mean force: from which one on, force there, slope. \[N, N, -\]
    different: [Vec<Vec<[f64; 3]>>; 2],
    /// Sum of the forces with the directions of the planets: from which mean force on, y and z there, slopes. \[N, N, -\]
    across: [Vec<[[f64; 3]; 2]>; 2],
}

/// A member that moves across the axis.
#[derive(Debug, Clone, PartialEq)]
struct Floating {
    shaft: String,
    /// Force of one planet on it per force of its pin.
    force: f64,
    /// What centres it; zero for one that floats freely. \[N/m\]
    stiffness: f64,
}

/// How the planets of a set share the force of one mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MeshSharing {
    pub set: Arc<Sharing>,
    /// Tangential force of the pin per tangential force of the first gear; of a stated sharing one.
    pub pin: f64,
}

/// Load sharing of a planetary set at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanetShares {
    /// Id of the set.
    pub set: String,
    /// Load of each planet over the mean. \[-\]
    pub shares: Vec<f64>,
    /// Floating members with their radial displacement. Of several that float freely each has the displacement with which it alone would even
    /// out the load. \[m\]
    pub displacements: Vec<(String, f64)>,
}

impl PlanetShares {
    /// Load of the most loaded planet over the mean, K_gamma. \[-\]
    pub fn k_gamma(&self) -> f64 {
        self.shares.iter().fold(0.0, |most, own| most.max(*own))
    }
}

/// The value of lines at a place: each from its start on, with the value there and its slope.
#[inline(always)]
fn on_lines<'a, R: Real>(x: R, lines: impl Iterator<Item = &'a [f64; 3]>) -> R {
    let mut value = R::ZERO;
    for [start, at_start, slope] in lines {
        let own = (x - *start) * *slope + *at_start;
        value = R::select(x.is_below(R::constant(*start)), value, own);
    }
    value
}

impl Sharing {
    /// Number of planets with each of the different loads, the greatest load first.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    fn stated(set: &str, factor: f64, count: f64) -> Self {
        Self {
            set: set.to_owned(),
            counts: vec![1.0, count - 1.0],
            kind: Kind::Stated([factor, (count - factor) / (count - 1.0)]),
        }
    }

    fn calculated(set: &str, elastic: ElasticPlanets, floating: Vec<Floating>, pins: [(usize, f64); 2]) -> Self {
        let forces = [1.0, -1.0].map(|sense| elastic.forces(sense));
        let ordered = forces.each_ref().map(PinForces::ordered);
        let planets = elastic.errors.len();
        let lines = |of: &PinForces, planet: usize| -> Vec<[f64; 3]> {
            let knots = of.knots.iter().zip(&of.planets);
            knots
                .map(|(knot, planets)| [*knot, planets[planet][0], planets[planet][1]])
                .collect()
        };
        // Planets with the same load at every torque are evaluated once.
        let mut different: [Vec<Vec<[f64; 3]>>; 2] = [Vec::new(), Vec::new()];
        let mut counts: Vec<f64> = Vec::new();
        for planet in 0..planets {
            let own = ordered.each_ref().map(|of| lines(of, planet));
            let same = (0..2).all(|i| different[i].last().is_some_and(|last| almost(last, &own[i])));
            if let (true, Some(last)) = (same, counts.last_mut()) {
                *last += 1.0;
                continue;
            }
            counts.push(1.0);
            for (of, own) in different.iter_mut().zip(own) {
                of.push(own);
            }
        }
        let directions: Vec<(f64, f64)> = (0..planets).map(|planet| elastic.angle(planet).sin_cos()).collect();
        let across = forces.each_ref().map(|of| {
            let knots = of.knots.iter().zip(&of.planets);
            let sums = knots.map(|(knot, planets)| {
                let sum = |part: usize, of: fn(&(f64, f64)) -> f64| -> f64 {
                    planets
                        .iter()
                        .zip(&directions)
                        .map(|(own, direction)| own[part] * of(direction))
                        .sum()
                };
                [
                    [*knot, sum(0, |direction| direction.1), sum(1, |direction| direction.1)],
                    [*knot, sum(0, |direction| direction.0), sum(1, |direction| direction.0)],
                ]
            });
            // A member that floats freely passes no force on, so that all forces balance.
            if elastic.centring == Some(0.0) {
                Vec::new()
            } else {
                sums.collect()
            }
        });
        Self {
            set: set.to_owned(),
            counts,
            kind: Kind::Calculated(Box::new(Calculated {
                elastic,
                floating,
                pins,
                forces,
                different,
                across,
            })),
        }
    }

    /// What the planets carry at a mean tangential force of their pins, if it is calculated. \[N\]
    pub fn shares(&self, pin: f64) -> Option<PlanetShares> {
        let Kind::Calculated(own) = &self.kind else {
            return None;
        };
        let sense = if pin < 0.0 { -1.0 } else { 1.0 };
        // Without a torque the shares are those of a small one.
        let mean = pin.abs().max(1e-9);
        let forces = own.forces[usize::from(pin < 0.0)].at(mean);
        let moved = own.elastic.displacement(sense, mean);
        let sprung = own.elastic.centring.unwrap_or(0.0);
        let displacements = own.floating.iter().map(|member| {
            let moved = match (sprung > 0.0, member.stiffness > 0.0) {
                // Of springs in series each has its part.
                (true, _) => moved * sprung * member.force / member.stiffness,
                (false, true) => 0.0,
                (false, false) => moved / member.force,
            };
            (member.shaft.clone(), moved)
        });
        Some(PlanetShares {
            set: self.set.clone(),
            shares: forces.into_iter().map(|force| force / mean).collect(),
            displacements: displacements.collect(),
        })
    }
}

/// Lines that differ by rounding only.
fn almost(one: &[[f64; 3]], other: &[[f64; 3]]) -> bool {
    let scale = one.last().map_or(0.0, |line| line[0].abs() + line[1].abs());
    let near = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-12 * scale;
    one.iter()
        .zip(other)
        .all(|(a, b)| near(a[1], b[1], scale) && near(a[2], b[2], 1.0))
}

impl MeshSharing {
    /// Tangential force of the mesh of the planets with the load of this number, for the mean of all. \[N\]
    #[inline(always)]
    pub fn force<R: Real>(&self, which: usize, mean: R) -> R {
        match &self.set.kind {
            Kind::Stated(factors) => mean * factors[which.min(1)],
            Kind::Calculated(own) => {
                let pin = mean * self.pin;
                let lines = |sense: usize| {
                    let of = &own.different[sense];
                    on_lines(pin.abs(), of[which.min(of.len() - 1)].iter())
                };
                let backwards = pin.is_below(R::ZERO);
                R::select(backwards, -lines(1), lines(0)) / self.pin
            }
        }
    }

    /// Tangential force of one planet in the direction of the first one that has the same transverse force as all of them, but for its
    /// direction, which turns with the carrier. \[N\]
    #[inline(always)]
    pub fn across<R: Real>(&self, mean: R) -> R {
        match &self.set.kind {
            Kind::Stated([most, others]) => mean * (*most - *others),
            Kind::Calculated(own) => {
                let pin = mean * self.pin;
                let length = |sense: usize| {
                    let of = |axis: usize| on_lines(pin.abs(), own.across[sense].iter().map(|both| &both[axis]));
                    let (y, z) = (of(0), of(1));
                    (y * y + z * z).sqrt()
                };
                let backwards = pin.is_below(R::ZERO);
                R::select(backwards, -length(1), length(0)) / self.pin
            }
        }
    }
}

/// Load sharing of the set of each planet member; `None` if all planets carry the same load.
pub fn sharing(
    (entry, document): (&GearboxEntry, &Value),
    members: &Members,
    (gears, meshes): (&[GearSeat], &[MeshSeat]),
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Option<Arc<Sharing>>> {
    let mut sharing = vec![None; members.names.len()];
    for (id, set) in entry.planetary_sets.iter() {
        let count = f64::from(set.count);
        let stated = set.load_sharing.unwrap_or(1.0);
        let bodies = Bodies {
            members,
            gears,
            meshes,
            id,
            set,
        };
        let own = if let Some(pins) = &set.pins {
            match calculated(entry, &bodies, pins) {
                Ok(own) => own,
                Err(faults) => {
                    found.extend(faults);
                    None
                }
            }
        } else if stated > count {
            let message = format!("one planet of {count} cannot carry {stated} times the mean");
            let fault = bodies.fault("load_sharing", message);
            found.push(fault.help(format!("write a number from 1 to {count}")));
            None
        } else {
            (stated > 1.0).then(|| Sharing::stated(id, stated, count))
        };
        if set.pins.is_none() && set.load_sharing.is_none() {
            warnings.extend(assumed_equal(document, &bodies));
        }
        let own = own.map(Arc::new);
        for planet in &set.planets {
            if let Some(body) = members.names.iter().position(|m| m == planet) {
                sharing[body].clone_from(&own);
            }
        }
    }
    sharing
}

/// The sharing of a mesh by its number.
pub fn of_mesh(number: usize, seat: &MeshSeat, sharing: &[Option<Arc<Sharing>>]) -> Option<MeshSharing> {
    let set = seat.members.iter().find_map(|body| sharing[*body].as_ref())?;
    let pin = match &set.kind {
        Kind::Stated(_) => 1.0,
        Kind::Calculated(own) => own.pins.iter().find(|(mesh, _)| *mesh == number)?.1,
    };
    Some(MeshSharing {
        set: Arc::clone(set),
        pin,
    })
}

/// Equal sharing where position errors of the pins would make it unequal, of sets that `pins` describes.
fn assumed_equal(document: &Value, bodies: &Bodies<'_>) -> Option<Diagnostic> {
    let Bodies {
        members,
        meshes,
        id,
        set,
        ..
    } = bodies;
    let bearings: Vec<&Value> = document["bearings"]
        .as_object()
        .into_iter()
        .flat_map(|all| all.values())
        .collect();
    let held = |member: usize| {
        let name = Some(members.names[member].as_str());
        bearings
            .iter()
            .any(|own| own["shaft"].as_str() == name || own["outer"].as_str() == name)
    };
    bodies.sides().ok()?;
    let carrier = members.names.iter().position(|name| *name == set.carrier)?;
    let central: Vec<usize> = (meshes
        .iter()
        .filter(|mesh| mesh.carrier == Some(carrier))
        .flat_map(|mesh| mesh.members))
    .filter(|member| members.planets[*member].is_none())
    .collect();
    let floats = set.count == 3 && !(central.len() > 1 && central.iter().chain([&carrier]).all(|member| held(*member)));
    (set.count >= 3 && !floats).then(|| {
        let which = if set.count == 3 {
            "three planets between members that all have bearings".to_owned()
        } else {
            format!("{} planets", set.count)
        };
        Diagnostic::warning(
            format!("planetary_sets.{id}"),
            format!("{which} are assumed to share the load equally"),
        )
        .code(codes::EQUAL_PLANETS)
        .help("state the position errors of the pins in `pins`, or `load_sharing`: 1 if they share equally")
    })
}

/// A set with what it belongs to.
struct Bodies<'a> {
    members: &'a Members,
    gears: &'a [GearSeat],
    meshes: &'a [MeshSeat],
    id: &'a str,
    set: &'a PlanetarySetEntry,
}

/// A mesh of the planet with a gear on the central axis, for a unit of the tangential force on the planet of the first of both.
struct Side {
    /// Number of the mesh.
    mesh: usize,
    /// Member on the central axis.
    central: usize,
    /// Tangential force on the planet in the positive sense of the carrier, and along the line of action. \[-\]
    force: [f64; 2],
    /// Force on the planet away from the axis of the carrier. \[-\]
    outwards: f64,
    /// Minus one for a mesh on the side of the axis of the carrier, one on the other.
    sense: f64,
}

impl Bodies<'_> {
    fn fault(&self, key: &str, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(format!("planetary_sets.{}.{key}", self.id), message).code(codes::PINS)
    }

    fn undetermined(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(format!("planetary_sets.{}.pins", self.id), message)
            .code(codes::PINS_UNDETERMINED)
            .help("state `load_sharing` as a number instead")
    }

    /// Both meshes of the planet.
    fn sides(&self) -> Result<[Side; 2], Diagnostic> {
        let one = "the load sharing is calculated for one planet body in mesh with two gears on the central axis";
        let [planet] = &self.set.planets[..] else {
            return Err(self.undetermined(one));
        };
        let body = self.members.names.iter().position(|name| name == planet);
        let own: Vec<(usize, &MeshSeat)> = (self.meshes.iter().enumerate())
            .filter(|(_, mesh)| body.is_some_and(|body| mesh.members.contains(&body)))
            .collect();
        let [first, second] = own[..] else {
            return Err(self.undetermined(one));
        };
        let mut tangential = 1.0;
        let mut radius = 0.0;
        let mut sides = [first, second].into_iter().map(|(mesh, seat)| {
            let of_planet = usize::from(Some(seat.members[0]) != body);
            let pair = &seat.cylindrical().ok_or_else(|| self.undetermined(one))?.pair;
            let side = if pair.internal { 1.0 } else { -1.0 };
            let own = pair.working_radius[of_planet];
            if radius > 0.0 {
                // No moment about the axis of the planet.
                tangential = -radius / (side * own);
            }
            radius = side * own * tangential;
            Ok(Side {
                mesh,
                central: seat.members[1 - of_planet],
                force: [tangential, tangential / pair.working_angle.cos()],
                outwards: -side * tangential.abs() * pair.working_angle.tan(),
                sense: side,
            })
        });
        match (sides.next(), sides.next()) {
            (Some(first), Some(second)) => Ok([first?, second?]),
            _ => Err(self.undetermined(one)),
        }
    }
}

/// The sharing of a set with position errors of its pins; `None` if they are equal.
fn calculated(entry: &GearboxEntry, bodies: &Bodies<'_>, pins: &PinsEntry) -> Result<Option<Sharing>, Vec<Diagnostic>> {
    let count = bodies.set.count as usize;
    let mut faults = Vec::new();
    if bodies.set.load_sharing.is_some() {
        faults.push(
            bodies
                .fault("load_sharing", "the load sharing is stated and calculated from `pins`")
                .help("remove one of them"),
        );
    }
    for (key, values) in [("errors", pins.errors.len()), ("clearances", pins.clearances.len())] {
        if values != count && !(key == "clearances" && values == 0) {
            let message = format!("{values} values for {count} planets");
            faults.push(
                bodies
                    .fault(&format!("pins.{key}"), message)
                    .help("write one value for each planet"),
            );
        }
    }
    let sides = match bodies.sides() {
        Ok(sides) => sides,
        Err(fault) => {
            faults.push(fault);
            return Err(faults);
        }
    };
    let ids = sides
        .each_ref()
        .map(|side| bodies.meshes[side.mesh].path.trim_start_matches("meshes."));
    for (i, own) in pins.meshes.iter().enumerate() {
        if !ids.contains(&own.mesh.as_str()) {
            faults.push(dangling(
                &format!("planetary_sets.{}.pins.meshes.{i}.mesh", bodies.id),
                "mesh of the planet",
                &own.mesh,
                &ids,
            ));
        }
    }
    let pin = sides[0].force[0] + sides[1].force[0];
    let outwards = sides[0].outwards + sides[1].outwards;
    if pin.abs() < 0.05 {
        faults.push(bodies.undetermined(
            "both meshes push the planet in opposite senses, so that its pin takes hardly any tangential force",
        ));
    }
    let mut compliance = (pin * pin + outwards * outwards) / (pin * pin) * pins.stiffness.map_or(0.0, |own| 1.0 / own);
    for (side, id) in sides.iter().zip(ids) {
        let stated = pins.meshes.iter().find(|own| own.mesh == id).map(|own| own.stiffness);
        let Some(teeth) = stated.or_else(|| mesh_stiffness(entry, bodies.gears, &bodies.meshes[side.mesh])) else {
            faults.push(
                bodies
                    .undetermined(format!(
                        "the stiffness of `{id}` is not known without the geometry of its teeth"
                    ))
                    .help("state it under `meshes`"),
            );
            continue;
        };
        let rim = pins
            .rim_stiffness
            .filter(|_| side.sense > 0.0)
            .map_or(0.0, |own| 1.0 / own);
        compliance += (side.force[1] / pin).powi(2) * (1.0 / teeth + rim);
    }
    let (centring, floating) = floating(bodies, pins, &sides, [pin, outwards], &mut faults);
    if !faults.is_empty() {
        return Err(faults);
    }
    let elastic = ElasticPlanets {
        errors: pins.errors.clone(),
        clearances: if pins.clearances.is_empty() {
            vec![0.0; count]
        } else {
            pins.clearances.clone()
        },
        stiffness: 1.0 / compliance,
        centring,
    };
    if elastic.equal() {
        return Ok(None);
    }
    // The force of the first gear is that of the planet on the side of the ring; on the other side it has the other sense.
    let pins = sides
        .each_ref()
        .map(|side| (side.mesh, side.sense * pin / side.force[0]));
    Ok(Some(Sharing::calculated(bodies.id, elastic, floating, pins)))
}

/// What centres the floating members for the force of a pin, and these members.
fn floating(
    bodies: &Bodies<'_>,
    pins: &PinsEntry,
    sides: &[Side; 2],
    [pin, outwards]: [f64; 2],
    faults: &mut Vec<Diagnostic>,
) -> (Option<f64>, Vec<Floating>) {
    let name = |member: usize| bodies.members.names[member].as_str();
    let known = [
        name(sides[0].central),
        name(sides[1].central),
        bodies.set.carrier.as_str(),
    ];
    let forces = [sides[0].force[1].abs(), sides[1].force[1].abs(), pin.hypot(outwards)];
    let mut floating: Vec<Floating> = Vec::new();
    for (i, own) in pins.floating.iter().enumerate() {
        let path = format!("pins.floating.{i}.shaft");
        match known.iter().position(|known| *known == own.shaft) {
            None => faults.push(dangling(
                &format!("planetary_sets.{}.{path}", bodies.id),
                "member of the set",
                &own.shaft,
                &known,
            )),
            Some(_) if floating.iter().any(|earlier| earlier.shaft == own.shaft) => {
                faults.push(
                    bodies
                        .fault(&path, format!("`{}` is listed twice", own.shaft))
                        .help("remove one of them"),
                );
            }
            Some(which) => floating.push(Floating {
                shaft: own.shaft.clone(),
                force: forces[which] / pin.abs(),
                stiffness: own.stiffness,
            }),
        }
    }
    let compliance: f64 = floating.iter().map(|own| own.force * own.force / own.stiffness).sum();
    let centring = (!floating.is_empty()).then(|| if compliance.is_finite() { 1.0 / compliance } else { 0.0 });
    (centring, floating)
}

/// Mean stiffness of the teeth in mesh, c_gamma b of ISO 6336-1; `None` without the geometry of the teeth. \[N/m\]
fn mesh_stiffness(entry: &GearboxEntry, gears: &[GearSeat], seat: &MeshSeat) -> Option<f64> {
    let pair = &seat.cylindrical()?.pair;
    let written = entry.meshes.get(seat.path.strip_prefix("meshes.")?)?;
    let materials = materials_of(gears, seat.gears, written.metal);
    let mean = 0.75 * pair.contact_ratio + 0.25;
    let stiffness = single_stiffness(pair, materials.map(|material| material.elastic)) * mean * pair.facewidth;
    (pair.involute && stiffness.is_finite() && stiffness > 0.0).then_some(stiffness)
}
