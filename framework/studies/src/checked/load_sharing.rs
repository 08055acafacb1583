//! What the load sharing of a mesh means for its loss at the rated torque: that of its model beside one calculated in thin slices.

use std::sync::Arc;

use gearloss_framework::contact::sharing::modification::FlankModification;
use gearloss_framework::contact::sharing::stiffness::StiffnessLaw;
use gearloss_framework::contact::sharing::{CalculatedSharing, SharingEntry, SlicesSharing};
use gearloss_framework::language::Language;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt};
use gearloss_framework::registry::Build;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::CheckedGearbox;

/// Loss of a mesh at the rated torque and speed by its own load sharing and by one calculated in thin slices.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SharingAtRating {
    /// Path of the mesh.
    pub mesh: String,
    /// Gear state.
    pub gear: String,
    /// Its load sharing: a word, or the `type`.
    pub load_sharing: String,
    /// Loss of one pair of gears with it. [W]
    pub loss_w: f64,
    /// The same with thin slices, with the stated modifications; null if its sharing is one of thin slices. [W]
    pub sliced_loss_w: Option<f64>,
    /// True if no modification and no misalignment is stated.
    pub unmodified: bool,
    /// Misalignment of the flanks over the face width, if that by the deflection of the shafts is in it. [um]
    pub shaft_misalignment_um: Option<f64>,
}

impl SharingAtRating {
    /// As one sentence.
    pub fn sentence(&self) -> String {
        let Self {
            mesh,
            gear,
            load_sharing,
            loss_w,
            sliced_loss_w,
            unmodified,
            shaft_misalignment_um,
        } = self;
        let stated = if *unmodified {
            ", with no modification stated"
        } else {
            ""
        };
        let sliced = sliced_loss_w.map(|watts| format!("; by slices {watts:.1} W"));
        let sliced = sliced.unwrap_or_default();
        let leans = shaft_misalignment_um.map(|um| format!(", misaligned by {um:.1} um with its shafts"));
        let leans = leans.unwrap_or_default();
        format!("at the rated torque in `{gear}`: {mesh}: `{load_sharing}`: {loss_w:.1} W{sliced}{stated}{leans}")
    }
}

/// The loss of every mesh whose model has a load sharing, in the first gear that drives it at the rating.
pub fn load_sharings(language: &Language, checked: &CheckedGearbox) -> Vec<SharingAtRating> {
    let t = &checked.transmission;
    let mut found: Vec<SharingAtRating> = Vec::new();
    for (i, state) in t.states().iter().enumerate() {
        t.at_rating(i, |solution| {
            for (mesh, path, _) in t.cylindrical_meshes() {
                if found.iter().any(|known| known.mesh == path) {
                    continue;
                }
                let Some(at) = solution.mesh_at(mesh).filter(|at| at.torque > 0.0 && at.speed != 0.0) else {
                    continue;
                };
                let id = path.trim_start_matches("meshes.");
                let model = &checked.resolved.value["meshes"][id]["model"];
                let own = sharing(language, checked, model, &at, path);
                found.extend(own.map(|of| SharingAtRating {
                    gear: state.name.clone(),
                    ..of
                }));
            }
        });
    }
    found
}

fn sharing(
    language: &Language,
    checked: &CheckedGearbox,
    model: &Value,
    at: &GearMeshAt<'_>,
    path: &str,
) -> Option<SharingAtRating> {
    let (place, own) = SharingEntry::of_model(model)?;
    let is_sliced = matches!(own, SharingEntry::Calculated(CalculatedSharing::Slices(_)));
    let part = Arc::new(at.part.clone());
    let mut build = Build::new(language.registry(), &checked.gearbox.files);
    let mut loss = |model: &Value| {
        let slot = build.slot_at::<GearMesh>(path, &part, model).ok()?;
        slot.loss(&at.with(|to| to.part = &part))
            .ok()
            .map(|loss| loss.total_watts(at.speed))
    };
    let sliced = SharingEntry::Calculated(CalculatedSharing::Slices(SlicesSharing {
        stiffness: if part.pair.internal {
            StiffnessLaw::Iso6336
        } else {
            StiffnessLaw::Weber
        },
        ..SlicesSharing::default()
    }));
    let mut other = model.clone();
    *other.pointer_mut(place)? = serde_json::to_value(sliced).ok()?;
    let written = model.pointer(place)?;
    Some(SharingAtRating {
        mesh: path.to_owned(),
        gear: String::new(),
        load_sharing: written.as_str().or_else(|| written["type"].as_str())?.to_owned(),
        loss_w: loss(model)?,
        sliced_loss_w: if is_sliced { None } else { Some(loss(&other)?) },
        shaft_misalignment_um: (part.yielding != 0.0).then(|| {
            let line_load = part.pair.line_load(part.pair.normal_force(at.torque));
            part.misalignment_under(line_load) * 1e6
        }),
        unmodified: part.misalignment == 0.0
            && part.yielding == 0.0
            && part.flanks.iter().all(|flank| *flank == FlankModification::default()),
    })
}
