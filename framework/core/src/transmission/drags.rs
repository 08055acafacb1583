//! Drag on gears and meshes: seats, parts, and the causes that two models both cover.

use super::seats::{CylindricalTeeth, GearSeat, MeshSeat};
use crate::attach::Level;
use crate::description::GearboxEntry;
use crate::description::housing::WallClearance;
use crate::mechanism::gear_drag::{Covers, DragPart, GearBody};

/// Seat of a drag model.
#[derive(Debug, Clone)]
pub(crate) struct DragSeat {
    /// Path with the slot, such as `gears.G4.drag.churning`; that of the gear or mesh until its slots are known.
    pub path: String,
    /// Members of the gear or of both gears.
    pub members: [usize; 2],
    /// Numbers of the gear or of both gears.
    pub gears: [usize; 2],
    /// True for a mesh.
    pub pair: bool,
    /// Tip and reference radius of each gear. \[m\]
    pub radii: [[f64; 2]; 2],
    /// Oil height at each gear.
    pub levels: [Level; 2],
    /// Mates of each gear: its lowest point moves towards a mate if speed times y is positive.
    pub mates: [Vec<Mate>; 2],
    /// Number of equal copies.
    pub count: f64,
}

/// Numbers of the gears of which a model covers a cause of loss, its path, and these causes.
pub(crate) type Covered = (Vec<usize>, String, Covers);

/// A mate of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mate {
    /// y component of the unit vector to it.
    pub y: f64,
    /// Height of the pitch point above the lowest point of the gear's tip circle. \[m\]
    pub height: f64,
}

/// The mates of a gear with axes fixed in the housing.
pub fn mates(gear: usize, meshes: &[MeshSeat]) -> Vec<Mate> {
    meshes
        .iter()
        .filter(|m| m.carrier.is_none())
        .filter_map(|m| {
            let CylindricalTeeth { direction, .. } = m.cylindrical()?;
            match m.gears {
                [a, _] if a == gear => Some((m, 0, direction[0])),
                [_, b] if b == gear && !m.internal() => Some((m, 1, -direction[0])),
                _ => None,
            }
        })
        .filter_map(|(m, side, y)| {
            let height = contact_height(m, side)?;
            Some(Mate { y, height })
        })
        .collect()
}

/// Height of the pitch point of a mesh above the lowest point of the tip circle of one of its gears. \[m\]
fn contact_height(mesh: &MeshSeat, side: usize) -> Option<f64> {
    let CylindricalTeeth { pair, direction, .. } = mesh.cylindrical()?;
    // The pitch point is at the working radius towards the mate.
    let upwards = if side == 0 {
        direction[1]
    } else {
        -pair.sign() * direction[1]
    };
    Some((pair.working_radius[side] * upwards + 0.5 * pair.tip_diameter[side]).max(0.0))
}

/// The body of a gear in a mesh of cylindrical gears; `None` of other ones.
pub fn body(gear: &GearSeat, index: usize, mesh: &MeshSeat) -> Option<GearBody> {
    let CylindricalTeeth { pair, .. } = mesh.cylindrical()?;
    let side = usize::from(mesh.gears[0] != index);
    Some(GearBody {
        z: gear.z,
        normal_module: pair.normal_module,
        pressure_angle: pair.pressure_angle,
        helix_angle: pair.helix_angle,
        pitch_angle: 0.0,
        facewidth: gear.facewidth,
        reference_diameter: pair.reference_diameter[side],
        working_diameter: 2.0 * pair.working_radius[side],
        tip_diameter: pair.tip_diameter[side],
        root_diameter: pair.root_diameter[side],
        contact_height: contact_height(mesh, side)?,
    })
}

/// The body of a gear alone; `None` of worms and crossed helical gears.
pub fn body_of_gear(gear: &GearSeat, index: usize, mesh: &MeshSeat) -> Option<GearBody> {
    body(gear, index, mesh).or_else(|| bevel_body(gear, index, mesh))
}

/// The body of a bevel gear, with the diameters at its outer end.
fn bevel_body(gear: &GearSeat, index: usize, mesh: &MeshSeat) -> Option<GearBody> {
    let teeth = mesh.crossed()?;
    let blank = teeth.blank.as_ref()?;
    let side = usize::from(mesh.gears[0] != index);
    let [reference, tip, root] = gear.diameters;
    // The lowest point of a circle around an inclined axis.
    let upright = (1.0 - teeth.axis[side].z.powi(2)).max(0.0).sqrt();
    Some(GearBody {
        z: gear.z,
        normal_module: teeth.cones.normal_module(),
        pressure_angle: teeth.pressure_angle[0],
        helix_angle: teeth.cones.spiral_angle[side].abs(),
        pitch_angle: teeth.cones.pitch_angle[side],
        facewidth: blank.facewidth[side],
        reference_diameter: reference,
        working_diameter: reference,
        tip_diameter: tip,
        root_diameter: root,
        contact_height: (teeth.arm(side).z + 0.5 * tip * upright).max(0.0),
    })
}

/// A part from the bodies, the gap of the gear and the housing, with the volume of the oil and the share of the housing that it fills. \[m3 and -\]
pub fn part(
    entry: &GearboxEntry,
    own: Option<WallClearance>,
    [oil_volume, fill]: [Option<f64>; 2],
    gear: GearBody,
    mate: Option<GearBody>,
) -> DragPart {
    let housing = &entry.housing;
    let clearance = own.or(housing.clearance);
    DragPart {
        gear,
        mate,
        oil_volume,
        fill,
        section_area: housing.section.map(|s| s.area),
        section_perimeter: housing.section.map(|s| s.perimeter),
        radial_clearance: clearance.map(|c| c.radial),
        axial_clearance: clearance.map(|c| c.axial),
    }
}

/// The causes that the name of a slot states for its model.
pub fn named(slot: &str) -> Covers {
    Covers {
        churning: slot == "churning",
        squeezing: slot == "squeezing",
        windage: slot == "windage",
    }
}

/// Names of the causes that two models both cover.
pub fn twice(a: Covers, b: Covers) -> Vec<&'static str> {
    [
        (a.churning && b.churning, "churning"),
        (a.squeezing && b.squeezing, "squeezing"),
        (a.windage && b.windage, "windage"),
    ]
    .into_iter()
    .filter(|(both, _)| *both)
    .map(|(_, name)| name)
    .collect()
}
