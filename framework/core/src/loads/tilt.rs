//! Misalignment of gears in mesh from the bending of their shafts and the stiffness of their bearings.
//!
//! Derived: with e the direction of the force on the second gear in the transverse plane, the flanks open by (u2 - u1) e at displacements u1
//! and u2 of both axes, so over the face by its width times (s2 - s1) e, where s are the slopes of the axes at the mesh. Neglected: torsion,
//! the housing, the tilt of a loose gear on its shaft, and the friction of the teeth.

use super::beam::{Beam, BeamFault, BeamLoad, BeamSupport};
use super::layout::{CylindricalMesh, MeshLayout};
use super::shaft_loads::{ShaftLoads, System};
use super::statics::Action;

/// Why the misalignment of a mesh cannot be found.
#[derive(Debug, Clone, PartialEq)]
pub enum TiltFault {
    /// The mesh is none of cylindrical gears between shafts in the housing.
    OtherMesh,
    /// Fewer than two bearings carry a member.
    Unsupported(usize),
    /// Diameters of a member are missing in a range. \[m\]
    NoSection(usize, [f64; 2]),
    /// The beam cannot be solved.
    Undetermined(usize),
}

/// Misalignment of a mesh under the forces of all teeth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tilt {
    /// Opening of the flanks per length along the shafts.
    pub slope: f64,
    /// One if contact moves along the face in the direction of the shafts, minus one against it; one for spur gears.
    pub sense: f64,
}

impl ShaftLoads {
    /// The misalignment of a mesh under a part of tangential forces on the first gear of one copy of each mesh, with the permanent loads. Their
    /// sense decides which flanks touch, also without them. \[N\]
    ///
    /// # Errors
    /// A mesh whose shafts cannot be calculated.
    pub fn tilt(&self, mesh: usize, tangential: &[f64], part: f64) -> Result<Tilt, TiltFault> {
        let layout = self.layout();
        let Some(MeshLayout::Cylindrical(teeth)) = layout.meshes.get(mesh) else {
            return Err(TiltFault::OtherMesh);
        };
        let planetary = teeth.members.iter().any(|m| layout.members[*m].planet.is_some());
        if planetary || teeth.central != [false; 2] {
            return Err(TiltFault::OtherMesh);
        }
        let system = System::new(layout).map_err(|_| TiltFault::OtherMesh)?;
        let forces: Vec<f64> = tangential.iter().map(|force| part * force).collect();
        let actions = system.actions(&forces);
        let place = |gear: usize| {
            let member = teeth.members[gear];
            (member, layout.meshes[mesh].at(gear, layout.members[member].start))
        };
        let [first, second] = [place(0), place(1)].map(|place| slopes(&system, &actions, place));
        let (first, second) = (first?, second?);
        let force = tangential[mesh];
        let [ey, ez] = direction(teeth, force);
        let opens = (second[0] - first[0]) * ey + (second[1] - first[1]) * ez;
        Ok(Tilt {
            slope: opens,
            sense: if teeth.hand_tan_beta * force < 0.0 { -1.0 } else { 1.0 },
        })
    }
}

/// Direction of the force on the second gear in the transverse plane, for the sign of the tangential force on the first one.
fn direction(teeth: &CylindricalMesh, force: f64) -> [f64; 2] {
    let [along, of_size] = teeth.forces(1);
    let sign = if force < 0.0 { -1.0 } else { 1.0 };
    let [y, z] = [1, 2].map(|axis| sign * along[axis] + of_size[axis]);
    let length = y.hypot(z);
    [y / length, z / length]
}

/// Slopes dy/dx and dz/dx of a member at a position.
fn slopes(system: &System<'_>, actions: &[Vec<Action>], (m, at): (usize, f64)) -> Result<[f64; 2], TiltFault> {
    let (member, supports) = (&system.layout().members[m], system.radial(m));
    let carrier = supports.first().and_then(|(_, seat)| seat.outer);
    if let (true, Some(carrier)) = (member.loose, carrier) {
        return slopes(system, actions, (carrier, at));
    }
    if supports.len() < 2 {
        return Err(TiltFault::Unsupported(m));
    }
    let beam_supports: Vec<BeamSupport> = supports.iter().map(|(_, seat)| BeamSupport::of(seat)).collect();
    let places: Vec<f64> = actions[m].iter().map(|action| action.at).chain([at]).collect();
    let beam = Beam::new(&member.sections, &beam_supports, &member.hinges, &places, member.shear);
    let beam = beam.map_err(|fault| match fault {
        BeamFault::NoSection(range) => TiltFault::NoSection(m, range),
        BeamFault::Mechanism | BeamFault::MomentAtHinge(_) => TiltFault::Undetermined(m),
    })?;
    Ok([1, 2].map(|axis| {
        let loads: Vec<BeamLoad> = actions[m].iter().map(|action| action.in_plane(axis)).collect();
        beam.slope(&loads, at)
    }))
}
