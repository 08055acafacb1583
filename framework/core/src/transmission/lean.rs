//! Misalignment of meshes from their own shafts, found at the rated torque after a first build, and what of it the second build takes: how the
//! misalignment grows with the load, and how far the resultant force moves along the face.

use super::{MeshLaw, Transmission};
use crate::codes;
use crate::contact::sharing::{CalculatedSharing, SharingEntry, slices_of};
use crate::description::GearboxEntry;
use crate::document::Diagnostic;
use crate::loads::TiltFault;
use serde_json::Value;

/// What the deflection of both shafts does to a mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lean {
    /// Misalignment without torque, by weights and forces of belts. \[m\]
    pub constant: f64,
    /// Misalignment per tangential force at the base circle over the face width. \[m2/N\]
    pub per_line_load: f64,
    /// Distance of the resultant force at the rated torque from the middle of the face, in the direction of the shafts. \[m\]
    pub shift: f64,
}

/// True if a description asks for the misalignment of a mesh from its shafts.
pub fn is_wanted(entry: &GearboxEntry) -> bool {
    entry.meshes.0.iter().any(|(_, mesh)| mesh.shaft_deflection)
}

/// Reports misalignments, stated or by the shafts, of meshes where nothing has thin slices, which alone use them.
pub fn without_effect(entry: &GearboxEntry, resolved: &Value) -> Vec<Diagnostic> {
    let has_slices = |model: &Value| {
        let sharing = SharingEntry::of_model(model);
        matches!(
            sharing,
            Some((_, SharingEntry::Calculated(CalculatedSharing::Slices(_))))
        )
    };
    let ratings = resolved["ratings"].as_object();
    if ratings.is_some_and(|all| all.values().any(has_slices)) {
        return Vec::new();
    }
    let meshes = entry.meshes.iter();
    let stated = meshes.flat_map(|(id, mesh)| {
        let keys = [
            ("shaft_deflection", mesh.shaft_deflection),
            ("misalignment", mesh.misalignment != 0.0),
        ];
        keys.into_iter()
            .filter(|(_, stated)| *stated)
            .map(move |(key, _)| (id, key))
    });
    let unused = stated.filter(|(id, _)| !has_slices(&resolved["meshes"][*id]["model"]));
    unused
        .map(|(id, key)| {
            let message = format!(
                "`{key}` has no effect on losses and ratings: neither the model of the mesh nor a rating has thin slices"
            );
            Diagnostic::warning(format!("meshes.{id}.{key}"), message)
                .code(codes::LEAN_UNUSED)
                .help(format!(
                    "write `load_sharing: {{ type: slices }}` in the model of the mesh, or remove `{key}`"
                ))
        })
        .collect()
}

/// The leans of all meshes of a transmission that was built without them, by number.
///
/// # Errors
/// Meshes whose shafts cannot be calculated.
pub fn leans(t: &Transmission, entry: &GearboxEntry, resolved: &Value) -> Result<Vec<Lean>, Vec<Diagnostic>> {
    let mut leans = vec![Lean::default(); t.meshes.len()];
    let mut faults = Vec::new();
    let wanted = |mesh: usize| {
        let path = t.meshes[mesh].seat.path.as_str();
        let id = path.strip_prefix("meshes.")?;
        entry.meshes.get(id)?.shaft_deflection.then_some((path, id))
    };
    let mut open: Vec<usize> = (0..t.meshes.len()).filter(|mesh| wanted(*mesh).is_some()).collect();
    if t.rating.is_none() {
        let missing = open.iter().filter_map(|mesh| wanted(*mesh)).map(|(path, _)| {
            fault(
                path,
                "the deflection of both shafts is that at the rated torque, and none is stated".to_owned(),
            )
            .help("state `rating: { torque: ..., speed: ... }`")
        });
        return Err(missing.collect());
    }
    for state in 0..t.states().len() {
        t.at_rating(state, |solution| {
            let forces = solution.tangential_forces();
            open.retain(|mesh| {
                let Some((path, id)) = wanted(*mesh).filter(|_| forces[*mesh] != 0.0) else {
                    return true;
                };
                match lean(t, *mesh, forces, &resolved["meshes"][id]["model"]) {
                    Ok(found) => leans[*mesh] = found,
                    Err(tilt) => faults.push(explain(t, path, &tilt)),
                }
                false
            });
        });
    }
    faults.extend(open.iter().filter_map(|mesh| wanted(*mesh)).map(|(path, _)| {
        fault(
            path,
            "no gear state loads this mesh at the rated torque, at which the deflection of both shafts is calculated"
                .to_owned(),
        )
        .help("state a `rating` that loads the mesh, or remove `shaft_deflection`")
    }));
    if faults.is_empty() { Ok(leans) } else { Err(faults) }
}

/// The lean of a mesh under the tangential forces of all meshes.
fn lean(t: &Transmission, mesh: usize, forces: &[f64], model: &Value) -> Result<Lean, TiltFault> {
    let MeshLaw::Cylindrical { part, .. } = &t.meshes[mesh].law else {
        return Err(TiltFault::OtherMesh);
    };
    let pair = &part.pair;
    let tilt = t.loads.tilt(mesh, forces, 1.0)?;
    let at_rest = t.loads.tilt(mesh, forces, 0.0)?;
    // In the plane of action the face begins where contact does.
    let over_face = |slope: f64| tilt.sense * slope * pair.facewidth;
    let torque = forces[mesh].abs() * t.meshes[mesh].seat.radius();
    let line_load = torque / (pair.base_radius[0] * pair.facewidth);
    let constant = over_face(at_rest.slope);
    let lean = Lean {
        constant,
        per_line_load: (over_face(tilt.slope) - constant) / line_load,
        shift: 0.0,
    };
    let sharing = SharingEntry::of_model(model);
    let Some((_, SharingEntry::Calculated(CalculatedSharing::Slices(entry)))) = sharing else {
        return Ok(lean);
    };
    let leaning = part.as_ref().clone().leaning(lean.constant, lean.per_line_load);
    let shift = slices_of(&leaning, &entry).map_or(0.0, |(_, slices)| slices.mesh(line_load).0.shift);
    Ok(Lean {
        shift: tilt.sense * shift * 0.5 * pair.facewidth,
        ..lean
    })
}

fn fault(path: &str, message: String) -> Diagnostic {
    Diagnostic::error(format!("{path}.shaft_deflection"), message).code(codes::SHAFT_DEFLECTION)
}

fn explain(t: &Transmission, path: &str, tilt: &TiltFault) -> Diagnostic {
    let name = |member: &usize| t.members()[*member].as_str();
    match tilt {
        TiltFault::OtherMesh => fault(
            path,
            "a gear of this mesh is on a planet or on the axis of its carrier".to_owned(),
        )
        .help("state the `misalignment` of this mesh instead"),
        TiltFault::Unsupported(member) => fault(
            path,
            format!("fewer than two bearings take the radial force of `{}`", name(member)),
        )
        .help("add its bearings, or state the `misalignment` instead"),
        TiltFault::NoSection(member, [from, to]) => fault(
            path,
            format!(
                "`{}` has no diameter from {:.3} to {:.3} mm, so its deflection is not known",
                name(member),
                from * 1e3,
                to * 1e3
            ),
        )
        .help("state `sections` of the shaft over its bearings and gears"),
        TiltFault::Undetermined(member) => {
            fault(path, format!("the deflection of `{}` is not determined", name(member)))
                .help("check bearings and hinges of the shaft")
        }
    }
}
