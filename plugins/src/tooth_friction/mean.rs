//! A law of mean friction as a constant along the path of contact.
//!
//! Within a mesh model the law sees the mesh at its pitch point. Alone, as in `eval`, the one contact stands for the pitch
//! point, and an FZG C pair for the mesh.

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Notes, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, MeshPart};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::mechanism::tooth_friction::{Along, ContactAt, PathAt, ToothFriction, ToothFrictionModel};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, formula};
use schemars::JsonSchema;
use serde::Deserialize;

/// A law of mean friction as a constant along the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Law of the mean coefficient of friction.
    pub mean_friction: ModelRef<MeanFriction>,
}

struct Mean {
    friction: Slot<MeanFriction>,
    /// The pair of a contact that stands alone.
    part: Arc<MeshPart>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Mean, Diagnostic> {
    let part = Arc::new(match cx.part::<GearMesh>() {
        Some(part) => part.clone(),
        None => MeshPart::fzg_c().map_err(|fault| cx.error(fault))?,
    });
    let friction = cx.slot_of("mean_friction", &part, &params.mean_friction)?;
    Ok(Mean { friction, part })
}

impl ToothFrictionModel for Mean {
    fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
        let usual = MeanFrictionAt::usual(&self.part, Notes::MUTED);
        self.friction.mu(&MeanFrictionAt {
            line_load: at.line_load * self.part.pair.base_helix.cos(),
            normal_force: at.line_load * self.part.pair.facewidth,
            pressure: at.pressure,
            pitch_speed: 0.5 * at.sum_speed / self.part.pair.working_angle.sin(),
            speed: 0.5 * at.sum_speed / (self.part.pair.working_angle.sin() * self.part.pair.working_radius[0]),
            sum_speed: at.sum_speed,
            radius: at.radius,
            ra: at.ra,
            rq: at.rq,
            temperature: at.temperature,
            nu: at.nu,
            eta: at.eta,
            alpha: at.alpha,
            beta: at.beta,
            conductivity: at.conductivity,
            x_l: at.x_l,
            notes: at.notes.of(self.friction.notes),
            ..usual
        })
    }

    fn along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
        mu.fill(self.friction.mu(&MeanFrictionAt {
            notes: path.notes.of(self.friction.notes),
            ..*path.mean
        })?);
        Ok(Along::default())
    }
}

register!(ToothFriction, "mean", Params,
    meaning: "A law of mean friction as a constant along the path of contact.",
    source: "definition: one coefficient for the whole mesh",
    example: "{ type: mean, mean_friction: { type: schlenk } }",
    evidence: [formula(Evidence::Derived, "the law itself states its evidence")],
    prepare: prepare);
