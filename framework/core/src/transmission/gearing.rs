//! Gears and meshes: geometry of every pair, checked against axes, hands and positions.

use serde_json::Value;

use super::materials;
use super::members::Members;
use super::plausible;
use super::seats::{CylindricalTeeth, GearSeat, MeshSeat, Teeth};
use crate::attach::dangling;
use crate::codes;
use crate::description::{
    GearEntry, GearKind, GearboxEntry, MeshEntry, PlanetarySetEntry, gears::Hand, gears::Mounting,
    shift_sign::ShiftSign,
};
use crate::document::Diagnostic;
use crate::geometry::{Pair, PairFault, PairSpec};
use crate::material::Material;
use crate::mechanism::Mechanism;
use crate::mechanism::NamedSlots;
use crate::mechanism::gear_drag::GearDrag;
use crate::mechanism::gear_mesh::GearMesh;
use crate::registry::{Memory, Registry};

/// Default roughness, that of ground flanks: Ra 0.4 um. \[m\]
const USUAL_RA: f64 = 0.4e-6;

/// Computes the geometry of all pairs.
pub(crate) fn gearing(
    registry: &Registry,
    entry: &GearboxEntry,
    members: &Members,
    memory: &mut Memory,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> (Vec<GearSeat>, Vec<MeshSeat>) {
    let mut gearing = Gearing::new(registry, entry, members, memory, found, warnings);
    gearing.check_gears();
    gearing.found.extend(repeated(entry));
    let (mut meshes, orbits): (Vec<MeshSeat>, Vec<Orbit>) = entry
        .meshes
        .iter()
        .filter_map(|(id, mesh)| gearing.mesh(format!("meshes.{id}"), mesh))
        .unzip();
    one_orbit(
        entry,
        members,
        meshes.iter().zip(&orbits),
        gearing.found,
        gearing.warnings,
    );
    meshes.extend(gearing.crossed_meshes());
    let Gearing {
        gears, found, warnings, ..
    } = gearing;
    // A mesh with a fault is none of those.
    if found.is_empty() {
        warnings.extend(without_mate(entry, &meshes));
    }
    (gears, meshes)
}

/// Reports pairs of gears that are in several meshes.
fn repeated(entry: &GearboxEntry) -> Vec<Diagnostic> {
    let pair = |mesh: &MeshEntry| {
        let mut pair = mesh.gears.clone();
        pair.sort();
        pair
    };
    let meshes: Vec<(&str, [String; 2])> = entry.meshes.iter().map(|(id, mesh)| (id, pair(mesh))).collect();
    let repeated = meshes.iter().enumerate().filter_map(|(i, (id, gears))| {
        let (other, [a, b]) = meshes[..i].iter().find(|(_, earlier)| earlier == gears)?;
        let message = format!("`{a}` and `{b}` are already the gears of `meshes.{other}`");
        Some(
            Diagnostic::error(format!("meshes.{id}.gears"), message)
                .help("delete one of these meshes, or name other gears"),
        )
    });
    repeated.collect()
}

/// Ids of gears in no mesh.
pub(super) fn lone_gears<'a>(entry: &'a GearboxEntry, meshes: &[MeshSeat]) -> Vec<&'a str> {
    let is_lone = |number: usize| !meshes.iter().any(|mesh| mesh.gears.contains(&number));
    let ids = entry.gears.ids().enumerate();
    ids.filter(|(number, _)| is_lone(*number)).map(|(_, id)| id).collect()
}

/// Reports gears in no mesh.
fn without_mate(entry: &GearboxEntry, meshes: &[MeshSeat]) -> impl Iterator<Item = Diagnostic> {
    lone_gears(entry, meshes).into_iter().map(|id| {
        let message = format!("`{id}` meshes with no gear, so it carries no torque");
        Diagnostic::warning(format!("gears.{id}"), message)
            .code(codes::LONE_GEAR)
            .help("add its mesh, or remove the gear if it is none of the gearbox")
    })
}

/// The gears while their meshes are computed one after the other: what a mesh determines holds for the next ones.
pub(super) struct Gearing<'a> {
    registry: &'a Registry,
    pub(super) entry: &'a GearboxEntry,
    pub(super) members: &'a Members,
    pub(super) gears: Vec<GearSeat>,
    /// Profile shifts, with the signs of ring gears according to ISO 21771.
    shifts: Vec<Option<f64>>,
    /// Hands of helical gears: 1 for right, -1 for left.
    hands: Vec<Option<f64>>,
    /// Tip diameters. \[m\]
    tips: Vec<Option<f64>>,
    /// Base pitches, each with the mesh that gives it. \[m\]
    pitches: Vec<Option<(f64, String)>>,
    memory: &'a mut Memory,
    pub(super) found: &'a mut Vec<Diagnostic>,
    pub(super) warnings: &'a mut Vec<Diagnostic>,
}

impl<'a> Gearing<'a> {
    fn new(
        registry: &'a Registry,
        entry: &'a GearboxEntry,
        members: &'a Members,
        memory: &'a mut Memory,
        found: &'a mut Vec<Diagnostic>,
        warnings: &'a mut Vec<Diagnostic>,
    ) -> Self {
        let materials = materials::of_gears(entry, found, warnings);
        let seat =
            |(((id, gear), member), material): (((&str, &GearEntry), &Option<usize>), Option<Material>)| GearSeat {
                id: id.to_owned(),
                member: member.unwrap_or(0),
                at: gear.at,
                tip_at: gear.at,
                z: gear.z,
                facewidth: gear.facewidth,
                ring: gear.kind == GearKind::Ring,
                diameters: [0.0; 3],
                material,
            };
        let shift = |g: &GearEntry| match g.kind {
            GearKind::External => g.profile_shift,
            GearKind::Ring => g.profile_shift.map(|x| ShiftSign::standard(g.profile_shift_sign, x)),
        };
        let hand = |g: &GearEntry| g.hand.map(|hand| if hand == Hand::Right { 1.0 } else { -1.0 });
        let gears = || entry.gears.iter().map(|(_, gear)| gear);
        Self {
            registry,
            entry,
            members,
            gears: entry
                .gears
                .iter()
                .zip(&members.of_gear)
                .zip(materials)
                .map(seat)
                .collect(),
            shifts: gears().map(shift).collect(),
            hands: gears().map(hand).collect(),
            tips: gears().map(|g| g.tip_diameter).collect(),
            pitches: vec![None; members.of_gear.len()],
            memory,
            found,
            warnings,
        }
    }

    /// Checks the keys of each gear that do not depend on its meshes.
    fn check_gears(&mut self) {
        for (id, gear) in self.entry.gears.iter() {
            self.warnings.extend(unsigned_shift(id, gear));
            if gear.bearings.is_some() && gear.mounted == Mounting::Fixed {
                let message = "a gear that is fixed to its shaft has no separate bearings";
                self.found.push(
                    Diagnostic::error(format!("gears.{id}.bearings"), message)
                        .help("write `bearings: none` for the shaft, or `mounted: loose` here"),
                );
            }
            if gear.profile_shift_sign.is_some() && gear.kind == GearKind::External {
                let message = "`profile_shift_sign` applies to ring gears only";
                self.found
                    .push(Diagnostic::error(format!("gears.{id}.profile_shift_sign"), message).help("remove it"));
            }
        }
    }

    /// One mesh with its geometry; `None` if it is wrong, or a member or an axis of it is.
    fn mesh(&mut self, path: String, mesh: &MeshEntry) -> Option<(MeshSeat, Orbit)> {
        let members = self.members;
        let [first, second] = self.mating(&path, &mesh.gears)?;
        let sign = if self.gears[second].ring { -1.0 } else { 1.0 };
        let bodies = [first, second].map(|gear| members.of_gear[gear].unwrap_or(0));
        let planets = bodies.map(|body| members.planets[body]);
        if let [Some(a), Some(b)] = planets
            && a.carrier != b.carrier
        {
            self.found.push(Diagnostic::error(
                format!("{path}.gears"),
                "the planets belong to different carriers",
            ));
            return None;
        }
        let carried = planets[0].or(planets[1]);
        let between = match carried {
            Some(_) => None,
            None => Some(self.between_axes(&path, mesh, [first, second], bodies)?),
        };
        self.check_cylindrical(&path, [first, second])?;
        if let Some(carried) = carried {
            self.check_on_carrier(&path, bodies, carried.carrier)?;
        }
        let apart = between.map(|v| v[0].hypot(v[1]));
        let spec = PairSpec {
            z: [self.gears[first].z, self.gears[second].z],
            internal: sign < 0.0,
            normal_module: mesh.normal_module,
            pressure_angle: mesh.pressure_angle,
            helix_angle: mesh.helix_angle,
            centre_distance: mesh.centre_distance.or(apart),
            profile_shift: [self.shifts[first], self.shifts[second]],
            tip_diameter: [self.tips[first], self.tips[second]],
            root_diameter: [first, second].map(|g| self.entry.gears.0[g].1.root_diameter),
            facewidth: self.common_facewidth(&path, [first, second])?,
            tip_shortening: mesh.tip_shortening,
        };
        let schematic = !looks_at_teeth(self.registry, self.entry, mesh);
        let pair = self.pair(&path, &spec, [first, second], schematic)?;
        self.adopt(&path, &pair, [first, second]);
        let helix = if mesh.double_helical { 0.0 } else { mesh.helix_angle };
        let hand = hand_of(&path, helix, sign, [first, second], &self.gears, &mut self.hands)
            .map_err(|error| self.found.push(error))
            .ok()?;
        let direction = match (between, apart) {
            (Some(v), Some(apart)) => [sign * v[0] / apart, sign * v[1] / apart],
            // In the frame of the carrier the planet is on the y axis; its contact with another planet can be anywhere.
            _ if sign < 0.0 => [1.0, 0.0],
            _ => [if planets[0].is_some() { -1.0 } else { 1.0 }, 0.0],
        };
        let written = self.entry.gears.0[second].1.profile_shift.is_some() && spec.centre_distance.is_none();
        let other = turned(&spec)
            .filter(|_| written)
            .and_then(|other| Pair::new(&other).ok());
        let orbit = Orbit {
            turned: other.map(|pair| pair.centre_distance),
            schematic,
        };
        let seat = MeshSeat {
            path,
            gears: [first, second],
            members: bodies,
            carrier: carried.map(|c| c.carrier),
            count: carried.map_or(1.0, |c| c.count),
            teeth: Teeth::Cylindrical(Box::new(CylindricalTeeth { pair, hand, direction })),
            ra: self.ra([first, second]),
            rq: self.rq([first, second]),
        };
        Some((seat, orbit))
    }

    /// Arithmetic mean roughness of the flanks of both gears. \[m\]
    pub(super) fn ra(&self, gears: [usize; 2]) -> [f64; 2] {
        gears.map(|gear| self.entry.gears.0[gear].1.surface.map_or(USUAL_RA, |own| own.ra))
    }

    /// Root mean square roughness of the flanks of both gears. \[m\]
    pub(super) fn rq(&self, gears: [usize; 2]) -> [f64; 2] {
        gears.map(|gear| {
            let surface = self.entry.gears.0[gear].1.surface;
            surface.map_or(1.25 * USUAL_RA, |own| own.rq.unwrap_or(1.25 * own.ra))
        })
    }

    /// Checks what only gears of other sections may have; `None` with an error.
    fn check_cylindrical(&mut self, path: &str, gears: [usize; 2]) -> Option<()> {
        let before = self.found.len();
        for gear in gears {
            let (id, written) = &self.entry.gears.0[gear];
            if written.z < 5 {
                let message = format!("{} teeth, but a cylindrical gear in `{path}` has at least 5", written.z);
                self.found.push(
                    Diagnostic::error(format!("gears.{id}.z"), message)
                        .help("correct the number of teeth, or describe a worm in `worm_meshes`"),
                );
            }
            if written.faces.is_some() {
                self.found.push(
                    Diagnostic::error(format!("gears.{id}.faces"), "a cylindrical gear faces no side")
                        .code(codes::CROSSED)
                        .help("remove it; it belongs to gears of `bevel_meshes`"),
                );
            }
        }
        (self.found.len() == before).then_some(())
    }

    /// Checks that the axes of gears in mesh with a planet are parallel to that of the carrier; `None` with an error.
    fn check_on_carrier(&mut self, path: &str, bodies: [usize; 2], carrier: usize) -> Option<()> {
        let of_carrier = self.members.axes[carrier]?;
        let parallel = |body: usize| {
            let own = self.members.axes[body];
            own.is_none_or(|own| of_carrier.to_parallel(&own).is_some())
        };
        let Some(body) = bodies.into_iter().find(|body| !parallel(*body)) else {
            return Some(());
        };
        let names = &self.members.names;
        let message = format!(
            "the axis of `{}` is not parallel to that of the carrier `{}`",
            names[body], names[carrier]
        );
        self.found.push(
            Diagnostic::error(format!("{path}.gears"), message)
                .code(codes::AXES)
                .help("give both shafts the same direction; planets on axes that cross that of their carrier are not available"),
        );
        None
    }

    /// The gears that a mesh names: two different ones, a ring gear second.
    pub(super) fn mating(&mut self, path: &str, gears: &[String; 2]) -> Option<[usize; 2]> {
        let ids: Vec<&str> = self.entry.gears.ids().collect();
        let mut pair = [0; 2];
        let mut known = true;
        for (i, name) in gears.iter().enumerate() {
            if let Some(gear) = self.entry.gears.index(name) {
                pair[i] = gear;
                known &= self.members.of_gear[gear].is_some();
            } else {
                known = false;
                self.found
                    .push(dangling(&format!("{path}.gears.{i}"), "gear", name, &ids));
            }
        }
        if !known {
            return None;
        }
        let [first, second] = pair.map(|gear| &self.gears[gear]);
        let fault = if pair[0] == pair[1] {
            Diagnostic::error(format!("{path}.gears"), "a gear cannot mesh with itself").help("name two gears")
        } else if first.ring {
            Diagnostic::error(
                format!("{path}.gears"),
                format!("`{}` is a ring gear and is listed first", first.id),
            )
            .help(format!("write gears: [{}, {}]", second.id, first.id))
        } else if first.member == second.member {
            let shaft = &self.members.names[first.member];
            let message = format!("`{}` and `{}` cannot mesh: both are on `{shaft}`", first.id, second.id);
            Diagnostic::error(format!("{path}.gears"), message).help("correct `shaft` of one of them")
        } else {
            return Some(pair);
        };
        self.found.push(fault);
        None
    }

    /// The vector from the first axis to the second, which a stated centre distance has to match; `None` if an axis is unknown. \[m\]
    fn between_axes(
        &mut self,
        path: &str,
        mesh: &MeshEntry,
        gears: [usize; 2],
        bodies: [usize; 2],
    ) -> Option<[f64; 2]> {
        let [Some(a), Some(b)] = bodies.map(|body| self.members.axes[body]) else {
            let on_planet = self.entry.planetary_sets.iter().any(|(_, set)| {
                gears
                    .iter()
                    .any(|g| set.planets.contains(&self.entry.gears.0[*g].1.shaft))
            });
            if on_planet {
                self.found.push(
                    Diagnostic::error(
                        format!("{path}.gears"),
                        "a gear on a planet body cannot be an idler gear",
                    )
                    .help("remove `mounted: loose`; a planet that rotates on another planet is a separate shaft"),
                );
            }
            return None;
        };
        let Some(between) = a.to_parallel(&b) else {
            let message = if a.is_parallel(&b) {
                "the axes are parallel, but their directions are opposite"
            } else {
                "the axes are not parallel"
            };
            let help = if a.is_parallel(&b) {
                "reverse `direction` of one of the shafts and the sign of its positions"
            } else {
                "describe the pair in `bevel_meshes`, `worm_meshes` or `crossed_helical_meshes`, or correct `axis` of a shaft"
            };
            self.found.push(
                Diagnostic::error(format!("{path}.gears"), message)
                    .code(codes::AXES)
                    .help(help),
            );
            return None;
        };
        let apart = between[0].hypot(between[1]);
        if let Some(given) = mesh.centre_distance
            && (apart / given - 1.0).abs() > 1e-4
        {
            self.found.push(
                Diagnostic::error(
                    format!("{path}.centre_distance"),
                    format!(
                        "the centre distance is {:.4} mm, but the axes are {:.4} mm apart",
                        given * 1e3,
                        apart * 1e3
                    ),
                )
                .help("correct one of them, or omit `centre_distance`"),
            );
            return None;
        }
        Some(between)
    }

    /// The face width that two gears have in common. \[m\]
    fn common_facewidth(&mut self, path: &str, pair: [usize; 2]) -> Option<f64> {
        // Positions count from different points if the axes have directions.
        let start = |gear: &GearSeat| self.members.axes[gear.member].map_or(0.0, |axis| axis.start());
        let edge = |gear: &GearSeat, side: f64| start(gear) + gear.at + side * 0.5 * gear.facewidth;
        let [a, b] = pair.map(|gear| &self.gears[gear]);
        let facewidth = edge(a, 1.0).min(edge(b, 1.0)) - edge(a, -1.0).max(edge(b, -1.0));
        if facewidth <= 0.0 {
            self.found.push(
                Diagnostic::error(
                    format!("{path}.gears"),
                    format!(
                        "`{}` and `{}` do not overlap: they are {:.3} mm apart along the shafts",
                        a.id,
                        b.id,
                        -facewidth * 1e3
                    ),
                )
                .help("correct `at` of one of them"),
            );
            return None;
        }
        let least = self.entry.plausibility.face_overlap;
        self.warnings
            .extend(plausible::face_overlap(path, [a, b], facewidth, least));
        Some(facewidth)
    }

    /// The geometry of a pair; pitch circles only if no model uses impossible teeth.
    fn pair(&mut self, path: &str, spec: &PairSpec, gears: [usize; 2], schematic: bool) -> Option<Pair> {
        let pair = match self.memory.repeat(path, *spec, Pair::new) {
            Ok(pair) => pair,
            Err(faults) if schematic && faults.iter().all(PairFault::is_of_teeth) => {
                let most = self.entry.plausibility.profile_shift;
                self.warnings.extend(plausible::no_involute(path, spec, &faults, most));
                let of_pair = |fault: &PairFault| Diagnostic::error(path, fault.to_string());
                Pair::schematic(spec)
                    .map_err(|faults| self.found.extend(faults.iter().map(of_pair)))
                    .ok()?
            }
            Err(faults) => {
                let most = self.entry.plausibility.profile_shift;
                if let Some((message, notes)) = plausible::misfit(spec, &faults, most) {
                    let error = notes
                        .into_iter()
                        .fold(Diagnostic::error(path, message), Diagnostic::note);
                    self.found.push(error.help(
                        "correct the centre distance (`axis` of the shafts, or `centre_distance`), the numbers of teeth or the module",
                    ));
                    return None;
                }
                let ring = &self.entry.gears.0[gears[1]].1;
                let help =
                    if ring.profile_shift.is_some() && turned(spec).is_some_and(|other| Pair::new(&other).is_ok()) {
                        other_sign(ring.profile_shift_sign)
                    } else {
                        "check teeth, module, angles, centre distance, profile shifts and tip diameters of this pair"
                    };
                self.found.extend(faults.iter().map(|fault| match fault {
                    PairFault::RingTip => {
                        let ring = &self.gears[gears[1]].id;
                        Diagnostic::error(format!("gears.{ring}"), fault.to_string()).help(
                            "add `tip_diameter: ... mm`, the inner diameter of its teeth: without profile shift and tip shortening the reference diameter minus two modules",
                        )
                    }
                    _ => Diagnostic::error(path, fault.to_string()).help(help),
                }));
                return None;
            }
        };
        let closes = spec.centre_distance.is_some();
        let follows = spec.profile_shift.map(|shift| closes && shift.is_none());
        if pair.involute {
            let ranges = &self.entry.plausibility;
            self.warnings
                .extend(plausible::shifts(path, spec, &pair, follows, ranges.profile_shift));
            let ids = gears.map(|gear| self.gears[gear].id.as_str());
            self.warnings.extend(plausible::teeth(path, &pair, ids, ranges));
        }
        Some(pair)
    }

    /// Takes from a pair what it determines for its gears, which have one base pitch in all of their meshes.
    fn adopt(&mut self, path: &str, pair: &Pair, gears: [usize; 2]) {
        for (i, gear) in gears.into_iter().enumerate() {
            self.shifts[gear] = Some(pair.profile_shift[i]);
            self.tips[gear] = Some(pair.tip_diameter[i]);
            match &self.pitches[gear] {
                Some((pitch, other)) if (pair.base_pitch / pitch - 1.0).abs() > 1e-6 => self.found.push(
                    Diagnostic::error(
                        path,
                        format!(
                            "the base pitch is {:.5} mm, but `{other}` gives the same gear `{}` one of {:.5} mm",
                            pair.base_pitch * 1e3,
                            self.gears[gear].id,
                            pitch * 1e3
                        ),
                    )
                    .help("state equal module, pressure angle and helix angle for all meshes of a gear"),
                ),
                Some(_) => {}
                None => self.pitches[gear] = Some((pair.base_pitch, path.to_owned())),
            }
            self.gears[gear].diameters = [pair.reference_diameter[i], pair.tip_diameter[i], pair.root_diameter[i]];
        }
    }
}

/// A ring gear whose profile shift has no stated sign.
fn unsigned_shift(id: &str, gear: &GearEntry) -> Option<Diagnostic> {
    let shift = gear.profile_shift.filter(|x| *x != 0.0)?;
    (gear.kind == GearKind::Ring && gear.profile_shift_sign.is_none()).then(|| {
        Diagnostic::warning(
            format!("gears.{id}.profile_shift"),
            format!(
                "the sign of a ring gear's profile shift is not stated: {shift} is interpreted as away from the axis, which is {} in ISO 21771",
                -shift
            ),
        )
        .code(codes::PROFILE_SHIFT)
        .help(
            "add `profile_shift_sign: iso21771` if the value is defined as in ISO 21771 or DIN 3960, or `outward` to keep the present interpretation",
        )
    })
}

/// The pair with the opposite sign of its ring gear's profile shift, if it has one.
fn turned(spec: &PairSpec) -> Option<PairSpec> {
    let [x1, x2] = spec.profile_shift;
    let x2 = x2.filter(|x2| spec.internal && *x2 != 0.0)?;
    Some(PairSpec {
        profile_shift: [x1, Some(-x2)],
        ..*spec
    })
}

/// The fix if the geometry is valid with the opposite sign.
fn other_sign(sign: Option<ShiftSign>) -> &'static str {
    match sign {
        Some(ShiftSign::Iso21771) => {
            "the geometry is valid with the opposite sign of the ring gear's profile shift: change its sign, or write `profile_shift_sign: outward`"
        }
        Some(ShiftSign::Outward) => {
            "the geometry is valid with the opposite sign of the ring gear's profile shift: change its sign, or write `profile_shift_sign: iso21771`"
        }
        None => {
            "the geometry is valid with the sign of ISO 21771 for the ring gear's profile shift: add `profile_shift_sign: iso21771` to the ring gear"
        }
    }
}

/// The hand of the first gear; sets it for both gears of a helical pair.
fn hand_of(
    path: &str,
    helix: f64,
    sign: f64,
    pair: [usize; 2],
    gears: &[GearSeat],
    hands: &mut [Option<f64>],
) -> Result<f64, Diagnostic> {
    if helix == 0.0 {
        return Ok(0.0);
    }
    let [first, second] = pair;
    // An external mate has the opposite hand, a ring gear the same.
    match (hands[first], hands[second]) {
        (Some(a), Some(b)) if b != -sign * a => Err(Diagnostic::error(
            format!("{path}.gears"),
            format!(
                "the hands of `{}` and `{}` do not match",
                gears[first].id, gears[second].id
            ),
        )
        .help(if sign > 0.0 {
            "external gears have opposite hands"
        } else {
            "a ring gear has the hand of its pinion"
        })),
        (Some(a), _) => {
            hands[second] = Some(-sign * a);
            Ok(a)
        }
        (None, Some(b)) => {
            hands[first] = Some(-sign * b);
            Ok(-sign * b)
        }
        (None, None) => Err(Diagnostic::error(
            format!("gears.{}", gears[first].id),
            "`hand` is missing on a helical gear",
        )
        .note(format!(
            "`{path}` has a helix angle; the hand determines the direction of its thrust"
        ))
        .help("add `hand: right` or `hand: left` to one gear of the pair")),
    }
}

/// Data of a mesh for the check of a planet's orbit, in addition to its centre distance.
struct Orbit {
    /// Centre distance with the opposite sign of the ring gear's profile shift, if it follows from the shifts.
    turned: Option<f64>,
    /// True if no model uses the tooth geometry.
    schematic: bool,
}

/// Checks that all meshes of a planet body with central gears have the same orbit radius.
fn one_orbit<'a>(
    entry: &GearboxEntry,
    members: &Members,
    meshes: impl Iterator<Item = (&'a MeshSeat, &'a Orbit)> + Clone,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) {
    let equal = |a: f64, b: f64| (a / b - 1.0).abs() <= 1e-4;
    for (body, planet) in members.planets.iter().enumerate() {
        if planet.is_none() {
            continue;
        }
        let mut meshes_of_body = meshes
            .clone()
            .filter(|(m, _)| m.members.contains(&body) && !m.members.iter().all(|b| members.planets[*b].is_some()));
        let Some((first, at_first)) = meshes_of_body.next() else {
            continue;
        };
        let Some(distance) = first.cylindrical().map(|teeth| teeth.pair.centre_distance) else {
            continue;
        };
        for (other, at_other) in meshes_of_body {
            let Some(more) = other.cylindrical().map(|teeth| teeth.pair.centre_distance) else {
                continue;
            };
            if equal(more, distance) {
                continue;
            }
            let ring = if at_other.turned.is_some_and(|more| equal(more, distance)) {
                Some(other)
            } else {
                at_first.turned.filter(|distance| equal(more, *distance)).map(|_| first)
            };
            let path = format!("{}.centre_distance", other.path);
            let message = format!(
                "the centre distance is {:.4} mm, that of `{}` is {:.4} mm; a planet has a single orbit",
                more * 1e3,
                first.path,
                distance * 1e3
            );
            if at_first.schematic && at_other.schematic {
                warnings.push(
                    Diagnostic::warning(path, message)
                        .note("speeds and torques are still valid, since no model uses the tooth geometry; loads of planet bearings are not")
                        .help("check the numbers of teeth, or make both centre distances equal"),
                );
                continue;
            }
            let help = match ring {
                Some(mesh) => other_sign(entry.gears.0[mesh.gears[1]].1.profile_shift_sign),
                None => "make both centre distances equal by profile shifts",
            };
            found.push(Diagnostic::error(path, message).help(help));
        }
    }
}

/// True if a model of a mesh, of its gears or of the planets among them uses the tooth geometry, or diameters that follow from it.
fn looks_at_teeth(registry: &Registry, entry: &GearboxEntry, mesh: &MeshEntry) -> bool {
    let name = |choice: &'_ Value| {
        choice
            .as_str()
            .or_else(|| choice["type"].as_str())
            .unwrap_or("none")
            .to_owned()
    };
    let drags = |slots: &Option<NamedSlots<GearDrag>>| {
        let mut slots = slots.iter().flat_map(|slots| slots.0.iter());
        slots.any(|(_, choice)| name(&choice.value) != "none")
    };
    let gears: Vec<&GearEntry> = mesh.gears.iter().filter_map(|gear| entry.gears.get(gear)).collect();
    let of_set = |set: &PlanetarySetEntry| {
        gears.iter().any(|gear| set.planets.contains(&gear.shaft))
            && set.model.as_ref().is_some_and(|choice| name(&choice.value) != "none")
    };
    let model = mesh
        .model
        .as_ref()
        .map_or_else(|| "none".to_owned(), |choice| name(&choice.value));
    registry.model(GearMesh::KEY, &model).is_none_or(|entry| entry.geometry)
        || drags(&mesh.drag)
        || gears.iter().any(|gear| drags(&gear.drag))
        || entry.planetary_sets.iter().any(|(_, set)| of_set(set))
}
