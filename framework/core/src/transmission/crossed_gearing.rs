//! Meshes of gears on axes that cross: what the axes, the teeth and the drawing determine together, checked against each other.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use super::axis::Axis;
use super::crossed::{CrossedKind, CrossedTeeth, Unplaced, feet, lines, signed_offset};
use super::gearing::Gearing;
use super::seats::{MeshSeat, Teeth};
use crate::codes;
use crate::description::gears::{Faces, Hand};
use crate::description::{BevelAxes, BevelFault, BevelMeshEntry, CrossedHelicalMeshEntry, GearKind, WormMeshEntry};
use crate::document::Diagnostic;
use crate::geometry::crossed::{Blank, MeanPoint, PitchCones};
use crate::geometry::{WormPair, WormSpec};
use crate::mechanism::worm_mesh::WormEntry;

/// Largest difference between a stated length and the one that follows. \[m\]
const LENGTH: f64 = 1e-5;

/// Largest difference between a stated angle and the one that follows. \[rad\]
const ANGLE: f64 = 0.01 * PI / 180.0;

/// Two gears with the axes of their shafts.
struct OnAxes {
    gears: [usize; 2],
    bodies: [usize; 2],
    axes: [Axis; 2],
}

impl Gearing<'_> {
    /// The meshes of all sections of gears on axes that cross, with the positions and diameters of their gears.
    pub(super) fn crossed_meshes(&mut self) -> Vec<MeshSeat> {
        let entry = self.entry;
        let mut seats = Vec::new();
        for (id, mesh) in entry.bevel_meshes.iter() {
            seats.extend(self.bevel(format!("bevel_meshes.{id}"), mesh));
        }
        for (id, mesh) in entry.worm_meshes.iter() {
            seats.extend(self.worm(format!("worm_meshes.{id}"), mesh));
        }
        for (id, mesh) in entry.crossed_helical_meshes.iter() {
            seats.extend(self.crossed_helical(format!("crossed_helical_meshes.{id}"), mesh));
        }
        self.check_faces();
        seats
    }

    /// Reports gears that state a side of an apex which they do not have.
    fn check_faces(&mut self) {
        for (id, _) in self.entry.gears.iter().filter(|(_, gear)| gear.faces.is_some()) {
            let mut meshes = self.entry.bevel_meshes.iter();
            if !meshes.any(|(_, mesh)| mesh.gears.iter().any(|gear| gear == id)) {
                let path = format!("gears.{id}.faces");
                // Gears of `meshes` were reported with their mesh.
                if !self.found.iter().any(|finding| finding.path == path) {
                    self.found.push(
                        Diagnostic::error(path, "only bevel gears face a side")
                            .code(codes::CROSSED)
                            .help("remove it; it belongs to gears of `bevel_meshes`"),
                    );
                }
            }
        }
    }

    /// The gears of a mesh, whose axes must not be parallel and are fixed in the housing.
    fn on_axes(&mut self, path: &str, names: &[String; 2], kind: CrossedKind) -> Option<OnAxes> {
        let gears = self.mating(path, names)?;
        let bodies = gears.map(|gear| self.members.of_gear[gear].unwrap_or(0));
        let mut fault = None;
        let [Some(first), Some(second)] = bodies.map(|body| self.members.axes[body]) else {
            if let Some(body) = bodies.into_iter().find(|body| self.members.planets[*body].is_some()) {
                let message = format!(
                    "`{}` is a planet body: gears on it are cylindrical",
                    self.members.names[body]
                );
                let fault = Diagnostic::error(format!("{path}.gears"), message);
                self.found.push(
                    fault
                        .code(codes::AXES)
                        .help("describe a bevel differential in `differentials`"),
                );
            }
            return None;
        };
        for gear in gears {
            let (id, written) = &self.entry.gears.0[gear];
            if let Some((_, mesh)) = (self.entry.meshes.iter()).find(|(_, mesh)| mesh.gears.contains(id)) {
                let _ = mesh;
                fault = Some((
                    format!("{path}.gears"),
                    format!("`{id}` is also in a mesh of cylindrical gears"),
                    "describe two gears on the shaft",
                ));
            }
            let not_there = match kind {
                CrossedKind::Bevel => [
                    ("kind", written.kind == GearKind::Ring),
                    ("profile_shift", written.profile_shift.is_some()),
                    ("profile_shift_sign", written.profile_shift_sign.is_some()),
                    ("tip_diameter", written.tip_diameter.is_some()),
                    ("root_diameter", written.root_diameter.is_some()),
                ],
                CrossedKind::Worm | CrossedKind::CrossedHelical => [
                    ("kind", written.kind == GearKind::Ring),
                    ("profile_shift", written.profile_shift.is_some()),
                    ("profile_shift_sign", written.profile_shift_sign.is_some()),
                    ("faces", written.faces.is_some()),
                    ("", false),
                ],
            };
            if let Some((key, _)) = not_there.iter().find(|(_, stated)| *stated) {
                fault = Some((
                    format!("gears.{id}.{key}"),
                    format!("`{key}` does not apply to a gear of `{}`", kind.section()),
                    "remove it; what the teeth need is stated in the mesh",
                ));
            }
            if kind == CrossedKind::Bevel && written.z < 5 {
                fault = Some((
                    format!("gears.{id}.z"),
                    format!("{} teeth, but a bevel gear has at least 5", written.z),
                    "correct the number of teeth",
                ));
            }
        }
        if fault.is_none() && first.is_parallel(&second) {
            let message = "the axes are parallel";
            self.found.push(
                Diagnostic::error(format!("{path}.gears"), message)
                    .code(codes::AXES)
                    .help("describe the pair in `meshes`, or correct `axis` of a shaft"),
            );
            return None;
        }
        if let Some((path, message, help)) = fault {
            self.found
                .push(Diagnostic::error(path, message).code(codes::CROSSED).help(help));
            return None;
        }
        Some(OnAxes {
            gears,
            bodies,
            axes: [first, second],
        })
    }

    /// An error in the teeth of a bevel mesh.
    fn no_pair(&mut self, path: &str, fault: BevelFault) -> Option<MeshSeat> {
        let path = fault.key.map_or_else(|| path.to_owned(), |key| format!("{path}.{key}"));
        self.impossible(path, fault.message, fault.help)
    }

    /// An error in a mesh.
    fn impossible(&mut self, path: String, message: String, help: &'static str) -> Option<MeshSeat> {
        self.found
            .push(Diagnostic::error(path, message).code(codes::CROSSED).help(help));
        None
    }

    /// Compares a stated value with the one that follows from the axes; true if it differs. `scale` converts to `unit`.
    fn differs(&mut self, path: String, what: &str, (stated, follows): (f64, f64), most: f64, unit: &str) -> bool {
        let scale = if unit == "mm" { 1e3 } else { 180.0 / PI };
        // Rounding of the conversion does not count.
        if (stated - follows).abs() <= most * (1.0 + 1e-9) {
            return false;
        }
        let message = format!(
            "{what} is {:.4} {unit}, but {:.4} {unit} follows from the axes and the teeth",
            stated * scale,
            follows * scale
        );
        self.found.push(
            Diagnostic::error(path, message)
                .code(codes::CROSSED)
                .help("correct it, the axes or the teeth, or omit it: it is only compared"),
        );
        true
    }

    /// True if the first gear, of a pair in which hands matter, has the left hand; `None` with an error.
    fn is_left(&mut self, path: &str, gears: [usize; 2], matters: bool, opposite: bool) -> Option<bool> {
        let hands = gears.map(|gear| self.entry.gears.0[gear].1.hand);
        let id = |i: usize| &self.entry.gears.0[gears[i]].0;
        let left = match hands {
            [None, None] if matters => {
                let fault = Diagnostic::error(
                    format!("gears.{}", id(0)),
                    "`hand` is missing on a gear with inclined teeth",
                )
                .code(codes::CROSSED)
                .note(format!(
                    "in `{path}` the hand determines the directions of thrust and rotation"
                ))
                .help("add `hand: right` or `hand: left` to one gear of the pair");
                self.found.push(fault);
                return None;
            }
            [Some(a), Some(b)] if matters && (a == b) == opposite => {
                let fault = Diagnostic::error(
                    format!("{path}.gears"),
                    format!("the hands of `{}` and `{}` do not match", id(0), id(1)),
                );
                self.found.push(fault.code(codes::CROSSED).help(if opposite {
                    "pinion and wheel have opposite hands"
                } else {
                    "worm and wheel have the same hand"
                }));
                return None;
            }
            [Some(own), _] => own == Hand::Left,
            [None, Some(mate)] => (mate == Hand::Left) != opposite,
            [None, None] => false,
        };
        Some(left)
    }

    /// Places a pair and gives its gears their positions; `None` with an error.
    fn seat(&mut self, path: String, on: &OnAxes, pair: Unplaced) -> Option<MeshSeat> {
        let teeth = CrossedTeeth::new(pair, [&on.axes[0], &on.axes[1]]);
        for i in 0..2 {
            let axis = &on.axes[i];
            let through = nalgebra::Vector3::from(axis.origin);
            let at = nalgebra::Vector3::from(axis.direction()).dot(&(teeth.mean_point - through));
            let gear = on.gears[i];
            let (id, written) = &self.entry.gears.0[gear];
            if written.at != 0.0 {
                self.differs(
                    format!("gears.{id}.at"),
                    "the position of the mean point",
                    (written.at, at),
                    LENGTH,
                    "mm",
                );
            }
            let seated = &mut self.gears[gear];
            if seated.diameters[1] != 0.0 && (seated.at - at).abs() > LENGTH {
                let message = format!(
                    "`{id}` has its mean point at {:.3} mm, but at {:.3} mm for another mesh",
                    at * 1e3,
                    seated.at * 1e3
                );
                return self.impossible(format!("{path}.gears"), message, "correct the axes or the teeth");
            }
            seated.at = at;
            let (diameters, beyond) = self.diameters(&teeth, i, gear);
            let seated = &mut self.gears[gear];
            seated.diameters = diameters;
            seated.tip_at = at + teeth.along[i] * beyond;
        }
        Some(MeshSeat {
            path,
            gears: on.gears,
            members: on.bodies,
            carrier: None,
            count: 1.0,
            ra: self.ra(on.gears),
            rq: self.rq(on.gears),
            teeth: Teeth::Crossed(Arc::new(teeth)),
        })
    }

    /// Reference, tip and root diameter of a gear, those of bevel gears at the outer end, and the distance of that end from the mean point
    /// along the axis. \[m\]
    fn diameters(&self, teeth: &CrossedTeeth, side: usize, gear: usize) -> ([f64; 3], f64) {
        let cones = &teeth.cones;
        let mean = 2.0 * cones.radius[side];
        let Some(blank) = &teeth.blank else {
            let written = &self.entry.gears.0[gear].1;
            // Of a worm the axial module counts, of others the normal one; a basic rack with an addendum of one module.
            let module = match teeth.kind {
                CrossedKind::Worm => cones.normal_module() / cones.spiral_angle[1].cos(),
                _ => cones.normal_module(),
            };
            let tip = written.tip_diameter.unwrap_or(mean + 2.0 * module);
            let root = written.root_diameter.unwrap_or(mean - 2.5 * module);
            return ([mean, tip, root], 0.0);
        };
        let (sine, cosine) = cones.pitch_angle[side].sin_cos();
        let outer = mean + 2.0 * blank.outer[side] * sine;
        let tip = blank.tip_diameter[side];
        let root = outer - 2.0 * blank.outer_dedendum[side] * cosine;
        let addendum = (tip - outer) / (2.0 * cosine);
        // The tip lies inside of the pitch cone, towards the apex.
        ([outer, tip, root], blank.outer[side] * cosine - addendum * sine)
    }

    fn bevel(&mut self, path: String, mesh: &BevelMeshEntry) -> Option<MeshSeat> {
        let on = self.on_axes(&path, &mesh.gears, CrossedKind::Bevel)?;
        let left = self.is_left(&path, on.gears, mesh.teeth.spiral_angle != 0.0, true)?;
        let along = on.gears.map(|gear| match self.entry.gears.0[gear].1.faces {
            None | Some(Faces::Start) => 1.0,
            Some(Faces::End) => -1.0,
        });
        let (through, directions) = lines([&on.axes[0], &on.axes[1]]);
        let towards = [directions[0] * along[0], directions[1] * along[1]];
        let shaft_angle = towards[0].dot(&towards[1]).clamp(-1.0, 1.0).acos();
        let signed = signed_offset(through, towards);
        let before = self.found.len();
        if let Some(stated) = mesh.shaft_angle {
            self.differs(
                format!("{path}.shaft_angle"),
                "the shaft angle",
                (stated, shaft_angle),
                ANGLE,
                "deg",
            );
        }
        if let Some(stated) = mesh.offset {
            self.differs(
                format!("{path}.offset"),
                "the offset",
                (stated, signed.abs()),
                LENGTH,
                "mm",
            );
        }
        if self.found.len() > before {
            return None;
        }
        let z = on.gears.map(|gear| self.gears[gear].z);
        let facewidth = self.gears[on.gears[1]].facewidth;
        // The frame of a right-hand pinion has a positive offset where that along the product of the axes is negative.
        let offset = if left { signed } else { -signed };
        let on_axes = BevelAxes {
            z,
            shaft_angle,
            offset,
            facewidth,
        };
        let teeth = &mesh.teeth;
        let cones = match teeth.pitch_cones(&on_axes) {
            Ok(cones) => cones,
            Err(fault) => return self.no_pair(&path, fault),
        };
        if cones.offset < 0.0 && mesh.teeth.spiral_angle != 0.0 {
            self.warnings.push(
                Diagnostic::warning(
                    path.clone(),
                    format!(
                        "hand and offset give the pinion a spiral angle of {:.3} deg and the wheel one of {:.3} deg",
                        cones.spiral_angle[0].to_degrees(),
                        cones.spiral_angle[1].to_degrees()
                    ),
                )
                .code(codes::UNUSUAL_HAND)
                .help("usually the pinion has the larger one: check `hand` and the axes"),
            );
        }
        let blank = teeth.blank(&cones, &on_axes);
        if !is_sound(&cones, &blank) {
            return self.impossible(
                path,
                "the teeth have no blank".to_owned(),
                "check size, facewidth, spiral angle, depth and axes",
            );
        }
        let flanks = match teeth.flanks(&cones, &blank) {
            Ok(flanks) => flanks,
            Err(fault) => return self.no_pair(&path, fault),
        };
        let angles = &teeth.pressure_angle;
        let pair = Unplaced {
            kind: CrossedKind::Bevel,
            cones,
            blank: Some(blank),
            pairs: Some(flanks),
            worm: None,
            pressure_angle: [angles.drive, angles.coast],
            limit_factor: angles.limit_factor,
            left,
            along,
        };
        let seat = self.seat(path.clone(), &on, pair)?;
        if let (Some(stated), Some(teeth)) = (mesh.mounting_distance, seat.crossed()) {
            for (i, (stated, follows)) in stated.into_iter().zip(teeth.mounting_distance()).enumerate() {
                let path = format!("{path}.mounting_distance.{i}");
                self.differs(path, "the mounting distance", (stated, follows), LENGTH, "mm");
            }
        }
        Some(seat)
    }

    fn worm(&mut self, path: String, mesh: &WormMeshEntry) -> Option<MeshSeat> {
        let on = self.on_axes(&path, &mesh.gears, CrossedKind::Worm)?;
        let left = self.is_left(&path, on.gears, true, false)?;
        let (through, directions) = lines([&on.axes[0], &on.axes[1]]);
        let angle = directions[0].dot(&directions[1]).clamp(-1.0, 1.0).acos();
        if (angle - FRAC_PI_2).abs() > ANGLE {
            let message = format!("the axes enclose {:.4} deg", angle.to_degrees());
            return self.impossible(path, message, "a worm and its wheel have axes at 90 deg");
        }
        let diameter = match WormEntry::reference_diameter(mesh.module, mesh.diameter_factor, mesh.worm_diameter) {
            Ok(diameter) => diameter,
            Err(message) => {
                let help = "state one of `diameter_factor` and `worm_diameter`";
                return self.impossible(path, message.to_owned(), help);
            }
        };
        let z = on.gears.map(|gear| self.gears[gear].z);
        let signed = signed_offset(through, directions);
        let wheel = mesh.module * f64::from(z[1]);
        let shift = (signed.abs() - 0.5 * (diameter + wheel)) / mesh.module;
        if let Some(stated) = mesh.profile_shift
            && (stated - shift).abs() * mesh.module > LENGTH
        {
            let message = format!(
                "the profile shift coefficient is {stated:.4}, but {shift:.4} follows from the distance of the axes, {:.4} mm",
                signed.abs() * 1e3
            );
            return self.impossible(
                format!("{path}.profile_shift"),
                message,
                "correct it or the axes, or omit it: it is only compared",
            );
        }
        if shift.abs() > 3.0 {
            let message = format!(
                "the axes are {:.4} mm apart, but worm and wheel fit at {:.4} mm",
                signed.abs() * 1e3,
                (diameter + wheel) * 500.0
            );
            return self.impossible(
                path,
                message,
                "correct the axes, the module or the diameter of the worm",
            );
        }
        let worm = WormPair::new(WormSpec {
            z,
            module: mesh.module,
            worm_diameter: diameter,
            pressure_angle: mesh.pressure_angle,
            profile: mesh.profile,
            profile_shift: shift,
            facewidth: self.gears[on.gears[1]].facewidth,
        });
        let cones = worm.cylinders();
        let along = along_of_cylinders(&cones, left, signed);
        self.seat(
            path,
            &on,
            Unplaced {
                kind: CrossedKind::Worm,
                cones,
                blank: None,
                pairs: None,
                worm: Some(worm),
                pressure_angle: [mesh.pressure_angle; 2],
                limit_factor: 0.0,
                left,
                along,
            },
        )
    }

    fn crossed_helical(&mut self, path: String, mesh: &CrossedHelicalMeshEntry) -> Option<MeshSeat> {
        let on = self.on_axes(&path, &mesh.gears, CrossedKind::CrossedHelical)?;
        let mut angles = mesh.helix_angle;
        for (i, angle) in angles.iter_mut().enumerate().filter(|(_, angle)| **angle != 0.0) {
            let (id, written) = &self.entry.gears.0[on.gears[i]];
            match written.hand {
                Some(Hand::Right) => {}
                Some(Hand::Left) => *angle = -*angle,
                None => {
                    let (path, message) = (format!("gears.{id}"), "`hand` is missing on a gear with inclined teeth");
                    return self.impossible(path, message.to_owned(), "add `hand: right` or `hand: left`");
                }
            }
        }
        // In the frame the second angle counts the other way, and the first gear is right-hand, or the angle between the axes would be negative.
        let left = angles[0] + angles[1] < 0.0;
        let mirror = if left { -1.0 } else { 1.0 };
        let spiral = [mirror * angles[0], -mirror * angles[1]];
        let z = on.gears.map(|gear| self.gears[gear].z);
        let cones = PitchCones::cylinders(z, mesh.normal_module, spiral);
        let (through, directions) = lines([&on.axes[0], &on.axes[1]]);
        let signed = signed_offset(through, directions);
        let along = along_of_cylinders(&cones, left, signed);
        let between = (directions[0].dot(&directions[1]) * along[0] * along[1])
            .clamp(-1.0, 1.0)
            .acos();
        let before = self.found.len();
        self.differs(
            format!("{path}.helix_angle"),
            "the angle between the axes that both helix angles and hands need",
            (cones.shaft_angle, between),
            ANGLE,
            "deg",
        );
        self.differs(
            path.clone(),
            "the distance of the axes that the teeth need",
            (cones.offset, signed.abs()),
            LENGTH,
            "mm",
        );
        if self.found.len() > before {
            return None;
        }
        self.seat(
            path,
            &on,
            Unplaced {
                kind: CrossedKind::CrossedHelical,
                cones,
                blank: None,
                pairs: None,
                worm: None,
                pressure_angle: [mesh.pressure_angle; 2],
                limit_factor: 0.0,
                left,
                along,
            },
        )
    }
}

/// In which directions the axes of cylinders run, so that they lie as in the frame: cylinders have no apex. `signed` is the offset along the
/// product of the directions of both shafts.
fn along_of_cylinders(cones: &PitchCones, left: bool, signed: f64) -> [f64; 2] {
    let frame = MeanPoint::new(cones);
    let in_frame = signed_offset(frame.foot, frame.axis);
    let wanted = if left { -in_frame } else { in_frame };
    [1.0, if wanted * signed < 0.0 { -1.0 } else { 1.0 }]
}

/// True if all dimensions are numbers that a gear can have.
fn is_sound(cones: &PitchCones, blank: &Blank) -> bool {
    let lengths = [cones.radius, blank.tip_diameter, blank.facewidth];
    let angles = cones
        .pitch_angle
        .iter()
        .all(|angle| *angle > 0.0 && *angle < FRAC_PI_2 + 0.6);
    angles
        && lengths
            .iter()
            .flatten()
            .all(|length| length.is_finite() && *length > 0.0)
        && feet(MeanPoint::new(cones).foot, MeanPoint::new(cones).axis)
            .iter()
            .all(|foot| foot.is_finite())
}
