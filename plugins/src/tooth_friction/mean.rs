//! A mean friction law as constant friction along the path of contact.
//!
//! Within a mesh model the law is evaluated at the pitch point of the mesh. Alone, as in `eval`, the single contact represents the pitch point
//! and an FZG C pair the mesh.

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, MeshPart};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::mechanism::tooth_friction::{Along, ContactAt, PathAt, ToothFriction, ToothFrictionLaw};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::finite;

/// A mean friction law as constant friction along the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Law of the mean coefficient of friction.
    pub mean_friction: ModelRef<MeanFriction>,
}

struct Mean {
    friction: Slot<MeanFriction>,
    /// The pair of a single contact.
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

impl ToothFrictionLaw for Mean {
    #[inline(always)]
    fn mu<R: Answers>(&self, at: &ContactAt<'_, R>) -> Result<R, Undefined> {
        let usual = MeanFrictionAt::usual(&self.part, at.notes.nested(self.friction.notes));
        let at = usual.with(|to| {
            to.line_load = at.line_load;
            to.normal_force = at.line_load * self.part.pair.line_length();
            to.pressure = at.pressure;
            to.pitch_speed = at.sum_speed * 0.5 / self.part.pair.working_angle.sin();
            to.speed = at.sum_speed * 0.5 / (self.part.pair.working_angle.sin() * self.part.pair.working_radius[0]);
            to.sum_speed = at.sum_speed;
            to.radius = at.radius;
            to.ra = at.ra;
            to.rq = at.rq;
            to.temperature = at.temperature;
            to.nu = at.nu;
            to.eta = at.eta;
            to.alpha = at.alpha;
            to.beta = at.beta;
            to.conductivity = at.conductivity;
            to.x_l = at.x_l;
        });
        finite(R::answer::<MeanFriction>(&*self.friction, &at)?)
    }

    #[inline(always)]
    fn along<R: Answers>(&self, path: &PathAt<'_, R>, mu: &mut [R]) -> Result<Along<R>, Undefined> {
        let at = path.mean.with(|to| to.notes = path.notes.nested(self.friction.notes));
        mu.fill(R::answer::<MeanFriction>(&*self.friction, &at)?);
        Ok(Along::default())
    }
}

register!(ToothFriction, "mean", Params,
    source: "definition: one coefficient for the whole mesh",
    example: "{ type: mean, mean_friction: { type: schlenk } }",
    evidence: [formula(Evidence::Derived, "the evidence is that of the mean friction law")],
    plastics: true, prepare: prepare);
