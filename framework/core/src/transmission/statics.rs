//! From placed supports and meshes to shaft loads; load factors and imported loads.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Vector3;

use super::crossed::{CrossedTeeth, Wrench};
use super::lean::Lean;
use super::members::Members;
use super::pairs::{Design, NotCounted};
use super::preloads;
use super::seats::{CylindricalTeeth, MeshSeat, Teeth, orbit};
use super::transfers::TransferSeat;
use crate::attach::{Axial, Factor, SeatedSupport, StatedStiffness, Stiffness, dangling};
use crate::codes;
use crate::description::{GearboxEntry, Unsupported};
use crate::document::Diagnostic;
use crate::loads::{
    CrossedMesh, CylindricalMesh, Induced, Layout, LoadFault, MemberLayout, MeshLayout, PlanetBody, Section,
    ShaftLoads, SupportLayout, SupportLoad, Thrust,
};
use crate::real::Real;
use crate::registry::Memory;
use crate::table::clamped;

/// Gravity. \[m/s2\]
const GRAVITY: f64 = 9.80665;

/// A factor as a constant or over the torque of a port.
#[derive(Debug, Clone)]
pub(crate) enum LoadFactor {
    Constant(f64),
    Over {
        port: usize,
        torques: Vec<f64>,
        factors: Vec<f64>,
    },
}

/// Radial and axial factor of one support.
#[derive(Debug, Clone)]
pub(crate) struct LoadFactors {
    pub radial: LoadFactor,
    pub axial: LoadFactor,
}

impl LoadFactor {
    /// The factor at the torques of all ports, by number.
    pub fn value_at<R: Real>(&self, torque: impl Fn(usize) -> R) -> R {
        match self {
            Self::Constant(factor) => R::constant(*factor),
            Self::Over { port, torques, factors } => {
                torque(*port).lift(|torque| clamped(torques, factors, torque.abs()))
            }
        }
    }
}

impl LoadFactors {
    /// Ports on whose torque the factors depend.
    pub fn reads(&self) -> impl Iterator<Item = usize> {
        [&self.radial, &self.axial]
            .into_iter()
            .filter_map(|factor| match factor {
                LoadFactor::Constant(_) => None,
                LoadFactor::Over { port, .. } => Some(*port),
            })
    }
}

/// Bearing loads from a file, over the torque of a port, by gear state.
#[derive(Debug, Clone)]
pub struct Imported {
    pub port: usize,
    /// For each gear state and support: increasing torques with radial, axial and tilting load.
    pub tables: Vec<Vec<Option<Vec<(f64, [f64; 3])>>>>,
}

/// Least step of the derivatives of tabulated loads, far below any difference of torques in a file. \[Nm\]
const STEP: f64 = 1e-6;

impl Imported {
    /// The port on whose torque the load of a support depends, if the file has it.
    pub fn reads(&self, state: usize, support: usize) -> Option<usize> {
        self.tables[state][support].as_ref().map(|_| self.port)
    }

    /// Replaces the load of a support if the file has it.
    pub fn load<R: Real>(&self, state: usize, support: usize, torque: R) -> Option<SupportLoad<R>> {
        let rows = self.tables[state][support].as_ref()?;
        let [radial, axial, tilting] = torque.lift_all(STEP, |torque| {
            let i = rows.partition_point(|r| r.0 <= torque).clamp(1, rows.len() - 1);
            let ((a, low), (b, high)) = (rows[i - 1], rows[i]);
            let t = ((torque - a) / (b - a)).clamp(0.0, 1.0);
            std::array::from_fn(|k| low[k] + t * (high[k] - low[k]))
        });
        Some(SupportLoad {
            radial,
            axial,
            tilting,
            untaken: R::ZERO,
        })
    }
}

/// The layout for statics.
pub fn shaft_loads(
    entry: &GearboxEntry,
    members: &Members,
    (meshes, transfers, leans): (&[MeshSeat], &[TransferSeat], &[Lean]),
    (supports, designs): (&[SeatedSupport], &[Design]),
    memory: &mut Memory,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Option<Arc<ShaftLoads>> {
    let mut layout = Layout {
        members: (0..members.names.len())
            .map(|i| member_layout(i, entry, members, meshes, found))
            .collect(),
        supports: supports
            .iter()
            .zip(designs)
            .map(|(support, design)| support_layout(support, design, members, found))
            .collect(),
        meshes: meshes.iter().map(|mesh| mesh_layout(mesh, entry, members)).collect(),
    };
    for (mesh, lean) in layout.meshes.iter_mut().zip(leans) {
        if let MeshLayout::Cylindrical(teeth) = mesh {
            teeth.at += lean.shift;
        }
    }
    for seat in transfers {
        let Some(strands) = &seat.strands else { continue };
        layout.meshes.push(strands.layout(seat.members));
        for (wheel, member) in seat.members.into_iter().enumerate() {
            if strands.slack > 0.0 {
                let force = (strands.at[wheel], strands.permanent(wheel));
                layout.members[member].forces.push(force);
            }
        }
    }
    preloads::mark(&mut layout, supports, designs, &members.names, found);
    unsupported(entry, members, &layout, found, warnings);
    found.extend(moments_not_taken(&layout, supports, members));
    warnings.extend(
        supports
            .iter()
            .zip(designs)
            .filter_map(|(support, design)| unsuited(support, design)),
    );
    let not_counted = NotCounted::new(&layout, supports, designs);
    match memory.repeat("shaft loads", layout, |layout| ShaftLoads::new(layout).map(Arc::new)) {
        Ok(loads) => {
            not_counted.report(&loads, members, found, warnings);
            Some(loads)
        }
        Err(faults) => {
            let path = |s: &usize| supports[*s].path.clone();
            let thrust_bearings = |member: usize| -> Vec<usize> {
                let at = |support: &SeatedSupport| [Some(support.inner), support.outer].contains(&Some(member as u16));
                let thrust = supports.iter().zip(designs).enumerate();
                let thrust = thrust.filter(|(_, (support, design))| !design.carries.radial && at(support));
                thrust.map(|(i, _)| i).collect()
            };
            found.extend(faults.iter().map(|fault| {
                let finding = explain(fault, members, &path, &thrust_bearings);
                match fault {
                    LoadFault::AxialIndeterminate { supports, .. }
                        if supports
                            .iter()
                            .any(|support| designs[*support].induced != Induced::None) =>
                    {
                        finding.note(
                            "of opposed bearings with a contact angle, one takes `axial: left` and one `axial: right`",
                        )
                    }
                    _ => finding,
                }
            }));
            None
        }
    }
}

/// Forces, moments, hinges and sections of a shaft; what revolves if it is a planet body.
fn member_layout(
    i: usize,
    entry: &GearboxEntry,
    members: &Members,
    meshes: &[MeshSeat],
    found: &mut Vec<Diagnostic>,
) -> MemberLayout {
    let (name, axis) = (&members.names[i], &members.frames[i]);
    let mut member = MemberLayout {
        start: members.frames[i].start(),
        loose: members.loose[i],
        ..MemberLayout::default()
    };
    let Some(shaft) = entry.shafts.get(name).filter(|_| !members.loose[i]) else {
        return member;
    };
    if shaft.mass > 0.0 && members.planets[i].is_none() {
        let up = crate::immersion::upward(entry.housing.grade, entry.housing.bank);
        match shaft.mass_at {
            Some(at) => member
                .forces
                .push((at, axis.local(up.map(|u| -u * shaft.mass * GRAVITY)))),
            None => found.push(
                Diagnostic::error(format!("shafts.{name}"), "a mass without `mass_at`")
                    .help("add `mass_at:`, the position of the centre of mass along the shaft"),
            ),
        }
    }
    for load in &shaft.loads {
        member.forces.push((load.at, axis.local(load.force)));
        member.moments.push((load.at, load.moment));
    }
    member.hinges.clone_from(&shaft.hinges);
    member.shear = shaft.shear_deformation;
    for (k, s) in shaft.sections.iter().enumerate() {
        if s.to <= s.from || s.inner >= s.outer {
            found.push(
                Diagnostic::error(
                    format!("shafts.{name}.sections.{k}"),
                    "the section has zero length or wall thickness",
                )
                .help("write `from` below `to` and `inner` below `outer`"),
            );
        }
        member.sections.push(Section {
            range: [s.from, s.to],
            outer: s.outer,
            inner: s.inner,
        });
    }
    member.planet = members.planets[i].map(|planet| PlanetBody {
        carrier: planet.carrier,
        orbit: orbit(i, members, meshes).unwrap_or(0.0),
        count: planet.count,
        mass: shaft.mass,
        uneven: planet.uneven,
    });
    member
}

/// A support; the two members that it connects are on one axis.
fn support_layout(
    support: &SeatedSupport,
    design: &Design,
    members: &Members,
    found: &mut Vec<Diagnostic>,
) -> SupportLayout {
    let place = &support.place;
    let (inner, outer) = (support.inner as usize, support.outer.map(usize::from));
    if let Some(outer) = outer
        && let [Some(a), Some(b)] = [inner, outer].map(|m| members.axes[m])
        && !a.is_same(&b)
    {
        found.push(
            Diagnostic::error(
                &support.path,
                format!(
                    "`{}` and `{}` are not on the same axis",
                    members.names[inner], members.names[outer]
                ),
            )
            .help("give both members the same `axis`, also the point from which positions count"),
        );
    }
    let mut stiffness_of = |stiffness: Stiffness| match (place.stated(stiffness)?, design.stiffness(stiffness)) {
        (StatedStiffness::Constant(value), _) => Some(value),
        (StatedStiffness::At(_), Some(Ok(value))) => Some(*value),
        (StatedStiffness::At(_), Some(Err(reason))) => {
            let unit = match stiffness {
                Stiffness::Radial => "N/mm",
                Stiffness::Tilting => "Nm/rad",
            };
            found.push(
                Diagnostic::error(
                    format!("{}.{}", support.path, stiffness.key()),
                    format!("no stiffness at this load: {reason}"),
                )
                .code(codes::NO_STIFFNESS)
                .help(format!(
                    "state the stiffness in {unit}, or the geometry of the rolling elements under `internal`"
                )),
            );
            None
        }
        (StatedStiffness::At(_), None) => None,
    };
    let [radial_stiffness, tilting_stiffness] = Stiffness::ALL.map(&mut stiffness_of);
    SupportLayout {
        inner,
        outer,
        at: place.at,
        axial: place.axial,
        share: place.axial_share,
        spring: place.spring_preload,
        takes_radial: design.carries.radial,
        takes_moment: place.takes_moment,
        radial_stiffness,
        tilting_stiffness,
        induced: design.induced_thrust(place).map(|induced| induced.ratio),
        preloaded: None,
    }
}

/// A mesh; the force of cylindrical gears acts in the middle of the common face width, that of others at the mean point.
fn mesh_layout(mesh: &MeshSeat, entry: &GearboxEntry, members: &Members) -> MeshLayout {
    match &mesh.teeth {
        Teeth::Cylindrical(teeth) => MeshLayout::Cylindrical(cylindrical_layout(mesh, teeth, entry, members)),
        Teeth::Crossed(teeth) => MeshLayout::Crossed(Box::new(crossed_layout(mesh, teeth, members))),
    }
}

fn cylindrical_layout(
    mesh: &MeshSeat,
    teeth: &CylindricalTeeth,
    entry: &GearboxEntry,
    members: &Members,
) -> CylindricalMesh {
    let [a, b] = mesh.gears.map(|g| &entry.gears.0[g].1);
    let [start_a, start_b] = mesh.members.map(|member| members.frames[member].start());
    let (at_a, at_b) = (start_a + a.at, start_b + b.at);
    let left = (at_a - 0.5 * a.facewidth).max(at_b - 0.5 * b.facewidth);
    let right = (at_a + 0.5 * a.facewidth).min(at_b + 0.5 * b.facewidth);
    let pair = &teeth.pair;
    CylindricalMesh {
        members: mesh.members,
        at: if (at_a - at_b).abs() < 1e-9 {
            at_a
        } else {
            0.5 * (left + right)
        },
        radius: pair.working_radius,
        sign: pair.sign(),
        direction: teeth.direction,
        across: 1.0,
        tan_alpha: pair.working_angle.tan(),
        hand_tan_beta: teeth.hand * pair.working_helix.tan(),
        count: mesh.count,
        central: mesh
            .members
            .map(|m| mesh.carrier.is_some() && members.planets[m].is_none()),
    }
}

fn crossed_layout(mesh: &MeshSeat, teeth: &CrossedTeeth, members: &Members) -> CrossedMesh {
    let axes = mesh.members.map(|member| &members.frames[member]);
    let local = |gear: usize, vector: Vector3<f64>| {
        // The second gear has the opposite forces.
        let sense = if gear == 0 { 1.0 } else { -1.0 };
        axes[gear].local((vector * sense).into())
    };
    let across = |[_, y, z]: [f64; 3]| [y, z];
    CrossedMesh {
        members: mesh.members,
        at: [0, 1].map(|gear| axes[gear].position(teeth.mean_point.into())),
        arm: [0, 1].map(|gear| across(axes[gear].local(teeth.arm(gear).into()))),
        normal: [0, 1].map(|gear| teeth.flanks.map(|flank| local(gear, flank.normal))),
        friction: [0, 1].map(|gear| {
            teeth.flanks.map(|flank| {
                let wrench = |wrench: Wrench| (local(gear, wrench.force), across(local(gear, wrench.moment)));
                flank.friction.map(wrench)
            })
        }),
    }
}

/// Reports members without bearings, and thrust directions without a bearing.
fn unsupported(
    entry: &GearboxEntry,
    members: &Members,
    layout: &Layout,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) {
    // A bearing with a fault does not support anything yet.
    let faulty = found.iter().any(|finding| finding.path.starts_with("bearings."));
    let mut planets = Vec::new();
    let (supports_of, meshes_of) = (layout.supports_by_member(), layout.meshes_by_member());
    for (i, name) in members.names.iter().enumerate() {
        let section = if members.loose[i] { "gears" } else { "shafts" };
        let path = format!("{section}.{name}");
        let supports: Vec<&SupportLayout> = supports_of[i].iter().map(|s| &layout.supports[*s]).collect();
        let meshes = meshes_of[i].iter().map(|mesh| &layout.meshes[*mesh]);
        let member = &layout.members[i];
        let loaded = meshes
            .clone()
            .any(|m| (0..2).any(|g| m.members()[g] == i && !m.is_central(g)))
            || !(member.forces.is_empty() && member.moments.is_empty());
        let without = if members.loose[i] {
            entry.gears.get(name).and_then(|gear| gear.bearings)
        } else {
            entry.shafts.get(name).and_then(|shaft| shaft.bearings)
        };
        match (supports.is_empty(), without) {
            (true, Some(Unsupported::None)) => continue,
            (true, None) if loaded && members.planets[i].is_some() => {
                planets.push(name.as_str());
                continue;
            }
            (true, None) if loaded && !faulty => {
                let what = if members.loose[i] { "gear" } else { "shaft" };
                found.push(
                    Diagnostic::error(path, format!("the {what} is loaded and has no bearings"))
                        .code(codes::NO_BEARING)
                        .note("without them its bearing loads and losses would be missing from every result")
                        .help(
                            "add its bearings, with `model: none` for bearings without loss; or write `bearings: none` here",
                        ),
                );
                continue;
            }
            (false, Some(Unsupported::None)) => found.push(
                Diagnostic::error(
                    format!("{path}.bearings"),
                    "`bearings: none` is stated, but there are bearings",
                )
                .help("remove `bearings: none`, or remove the bearings"),
            ),
            _ => {}
        }
        let helical = meshes.clone().any(MeshLayout::has_thrust);
        if helical && !members.loose[i] && !supports.is_empty() {
            let [forwards, back] = members.frames[i].senses();
            for (side, words) in [(Axial::Right, forwards), (Axial::Left, back)] {
                let taken = supports.iter().any(|s| s.axial == side || s.axial == Axial::Both);
                if !taken {
                    warnings.push(
                        Diagnostic::warning(path.clone(), format!("no bearing takes thrust towards {words}"))
                            .code(codes::THRUST)
                            .help("set `axial:` of a bearing to left, right or both"),
                    );
                }
            }
        }
    }
    for (id, set) in entry.planetary_sets.iter() {
        let bare: Vec<String> = planets
            .iter()
            .filter(|name| set.planets.iter().any(|planet| planet == *name))
            .map(|name| format!("`{name}`"))
            .collect();
        if !bare.is_empty() {
            warnings.push(
                Diagnostic::warning(
                    format!("planetary_sets.{id}.planets"),
                    format!(
                        "the planets {} have no bearings: their loads and losses are not included",
                        bare.join(", ")
                    ),
                )
                .help("add bearings between the planets and the carrier, or write `bearings: none` for these shafts")
                .code(codes::UNCOUNTED),
            );
        }
    }
}

/// Reports bearings with a stated resistance to moments that nothing uses.
fn moments_not_taken(layout: &Layout, supports: &[SeatedSupport], members: &Members) -> Vec<Diagnostic> {
    let carried: Vec<usize> = layout
        .supports
        .iter()
        .map(|support| layout.carried(support).0)
        .collect();
    let carrying = |member: usize| {
        let on = carried.iter().zip(&layout.supports);
        on.filter(|(on, support)| **on == member && support.takes_radial)
            .count()
    };
    let each = supports.iter().zip(&layout.supports).zip(&carried);
    each.filter_map(|((seat, support), member)| {
        let path = &seat.path;
        if !support.takes_radial && (support.takes_moment || seat.place.tilting_stiffness.is_some()) {
            let key = if support.takes_moment {
                "takes_moment"
            } else {
                Stiffness::Tilting.key()
            };
            let message = "a bearing that carries thrust only takes no moment here";
            return Some(
                Diagnostic::error(format!("{path}.{key}"), message)
                    .help(format!("delete `{key}`, or state it at a radial bearing")),
            );
        }
        (support.takes_moment && carrying(*member) > 1).then(|| {
            let shaft = &members.names[*member];
            let message = format!("several bearings carry `{shaft}`, so none takes its moment alone");
            Diagnostic::error(format!("{path}.takes_moment"), message)
                .help("delete `takes_moment`; state `tilting_stiffness` of a bearing that resists to tilting")
        })
    })
    .collect()
}

/// Reports an assignment of thrust that does not match the design of a bearing.
fn unsuited(support: &SeatedSupport, design: &Design) -> Option<Diagnostic> {
    let (place, path) = (&support.place, &support.path);
    let (carries, name) = (design.carries, &design.name);
    let axial = match place.axial {
        Axial::None => "none",
        Axial::Left => "left",
        Axial::Right => "right",
        Axial::Both => "both",
    };
    let finding = match (carries.thrust, place.axial) {
        (_, Axial::None) if !carries.radial => Diagnostic::warning(
            format!("{path}.axial"),
            format!("`{name}` carries thrust only, but no thrust is assigned to it: it has no load"),
        )
        .help("write `axial: left`, `right` or `both`"),
        (Thrust::None, Axial::Left | Axial::Right | Axial::Both) => Diagnostic::warning(
            format!("{path}.axial"),
            format!("`{name}` carries no thrust, but `axial: {axial}` assigns thrust to it"),
        )
        .help("write `axial: none` here and assign the thrust to a bearing that carries it"),
        (Thrust::None, Axial::None) if place.spring_preload != 0.0 => Diagnostic::warning(
            format!("{path}.spring_preload"),
            format!("`{name}` carries no thrust, but a spring loads it axially"),
        )
        .help("remove `spring_preload` here, or choose a bearing that carries thrust"),
        (Thrust::OneDirection, Axial::Both) => Diagnostic::warning(
            format!("{path}.axial"),
            format!("`{name}` carries thrust in one direction, but `axial: both` assigns both to it"),
        )
        .help("write `axial: left` or `axial: right`, and assign the other direction to another bearing"),
        _ => return None,
    };
    Some(finding.code(codes::CANNOT_CARRY))
}

fn explain(
    fault: &LoadFault,
    members: &Members,
    path: &dyn Fn(&usize) -> String,
    thrust_bearings: &dyn Fn(usize) -> Vec<usize>,
) -> Diagnostic {
    let name = |m: usize| &members.names[m];
    let list = |supports: &[usize]| supports.iter().map(path).collect::<Vec<_>>().join(", ");
    let at = |m: usize| format!("{}.{}", if members.loose[m] { "gears" } else { "shafts" }, name(m));
    match fault {
        LoadFault::Cycle { members: circle } => {
            let names: Vec<&str> = circle.iter().map(|m| name(*m).as_str()).collect();
            Diagnostic::error("bearings", format!("{} support each other in a loop", names.join(", ")))
                .help("one of them needs a bearing in the housing; swap `shaft` and `outer` of a bearing")
        }
        LoadFault::Mechanism { member, supports } => {
            let fault = Diagnostic::error(
                at(*member),
                format!(
                    "`{}` can tilt or move on its bearings: {}",
                    name(*member),
                    list(supports)
                ),
            )
            .help("add two bearings at different positions, or a single one with `takes_moment: true`");
            match thrust_bearings(*member) {
                thrust if thrust.is_empty() => fault,
                thrust => fault.note(format!("thrust bearings carry no radial load: {}", list(&thrust))),
            }
        }
        LoadFault::AxialIndeterminate {
            member,
            supports,
            right,
        } => {
            let [forwards, back] = members.frames[*member].senses();
            let words = if *right { forwards } else { back };
            Diagnostic::error(
                at(*member),
                format!(
                    "several bearings of `{}` take thrust towards {words}: {}",
                    name(*member),
                    list(supports)
                ),
            )
            .help("assign it to one of them with `axial:`, or state `axial_share` of each")
        }
        LoadFault::SeveralSprings { member, supports } => Diagnostic::error(
            at(*member),
            format!("springs press several bearings of a pair: {}", list(supports)),
        )
        .help("state `spring_preload` of one of them: through the shaft it loads the other one, too"),
        LoadFault::SpringOfSeveral { support, supports } => Diagnostic::error(
            format!("{}.spring_preload", path(support)),
            format!(
                "a spring presses one of several bearings that take the same thrust: {}",
                list(supports)
            ),
        )
        .help("assign the thrust to the bearing with the spring, with `axial: none` at the others"),
        LoadFault::SpringLifts { support } => Diagnostic::error(
            format!("{}.spring_preload", path(support)),
            "the spring lifts this ring of a pair off its rolling elements",
        )
        .help("reverse the sign: a bearing with `axial: left` pushes the shaft towards +x only, which is positive"),
        LoadFault::NoSection { member, range } => Diagnostic::error(
            format!("{}.sections", at(*member)),
            format!(
                "no diameters between {:.3} mm and {:.3} mm",
                range[0] * 1e3,
                range[1] * 1e3
            ),
        )
        .note(
            "with more than two bearings, a hinge or a tilting stiffness, the loads depend on the stiffness of the shaft"
                .to_owned(),
        )
        .help("add `sections: [{ from: ..., to: ..., outer: ... }]`"),
        LoadFault::MomentAtHinge { member, at: place } => Diagnostic::error(
            format!("{}.hinges", at(*member)),
            format!(
                "a load acts at the hinge at {:.3} mm, where its moment would be ambiguous",
                place * 1e3
            ),
        )
        .help("move the hinge or the load"),
    }
}

/// Load factors of all supports; empty if all are one.
pub(crate) fn load_factors(
    supports: &[SeatedSupport],
    ports: &[super::Port],
    found: &mut Vec<Diagnostic>,
) -> Vec<LoadFactors> {
    let names: Vec<&str> = ports.iter().map(|p| p.name.as_str()).collect();
    let mut read = |support: &str, key: &str, factor: &Factor| match factor {
        Factor::Constant(factor) => LoadFactor::Constant(*factor),
        Factor::Over(over) => {
            let port = names.iter().position(|n| *n == over.port);
            if port.is_none() {
                let path = format!("{support}.{key}.port");
                found.push(dangling(&path, "port", &over.port, &names));
            }
            if over.torques.len() != over.factors.len() || over.torques.windows(2).any(|w| w[1] <= w[0]) {
                found.push(
                    Diagnostic::error(
                        format!("{support}.{key}"),
                        "the numbers of torques and factors differ, or torques do not increase",
                    )
                    .help("state increasing torques and one factor for each"),
                );
                return LoadFactor::Constant(1.0);
            }
            LoadFactor::Over {
                port: port.unwrap_or(0),
                torques: over.torques.clone(),
                factors: over.factors.clone(),
            }
        }
    };
    let factors: Vec<LoadFactors> = supports
        .iter()
        .map(|s| LoadFactors {
            radial: read(&s.path, "radial_factor", &s.place.radial_factor),
            axial: read(&s.path, "axial_factor", &s.place.axial_factor),
        })
        .collect();
    let one = |factor: &LoadFactor| matches!(factor, LoadFactor::Constant(factor) if *factor == 1.0);
    if factors.iter().all(|f| one(&f.radial) && one(&f.axial)) {
        return Vec::new();
    }
    factors
}

/// Reads imported loads.
pub fn imported(
    text: &str,
    file: &str,
    port: usize,
    states: &[String],
    supports: &[SeatedSupport],
) -> Result<Imported, Diagnostic> {
    let fault = |reason: String| Diagnostic::error("imported_loads.file", format!("{file}: {reason}"));
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| fault(e.to_string()))?.clone();
    let column = |name: &str| header.iter().position(|h| h == name);
    let need = |name: &str| column(name).ok_or_else(|| fault(format!("line 1: no column `{name}`")));
    let (gear, component) = (need("gear")?, need("component")?);
    let (torque, radial, axial) = (need("torque [Nm]")?, need("radial [N]")?, need("axial [N]")?);
    let tilting = column("tilting [Nm]");
    let mut rows: BTreeMap<(usize, usize), Vec<(f64, [f64; 3])>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.map_err(|e| fault(e.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |i: usize| -> Result<f64, Diagnostic> {
            let cell = record.get(i).unwrap_or_default();
            let value = cell.parse::<f64>().ok().filter(|x| x.is_finite());
            value.ok_or_else(|| {
                fault(format!(
                    "line {line}, column `{}`: `{cell}` is not a number",
                    &header[i]
                ))
            })
        };
        let name = record.get(gear).unwrap_or_default();
        let state = states
            .iter()
            .position(|s| s == name)
            .ok_or_else(|| fault(format!("line {line}: no gear state is called `{name}`")))?;
        let name = record.get(component).unwrap_or_default();
        let support = supports
            .iter()
            .position(|s| s.path.rsplit('.').next() == Some(name))
            .ok_or_else(|| fault(format!("line {line}: no bearing is called `{name}`")))?;
        let tilt = tilting.map_or(Ok(0.0), number)?;
        rows.entry((state, support))
            .or_default()
            .push((number(torque)?, [number(radial)?.abs(), number(axial)?.abs(), tilt]));
    }
    let mut tables = vec![vec![None; supports.len()]; states.len()];
    for ((state, support), mut list) in rows {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        if list.len() < 2 || list.windows(2).any(|w| w[1].0 <= w[0].0) {
            return Err(fault(format!(
                "{} in `{}` requires at least two different torques",
                supports[support].path, states[state]
            )));
        }
        tables[state][support] = Some(list);
    }
    Ok(Imported { port, tables })
}
