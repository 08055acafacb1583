//! A local friction law as mean friction of a mesh: averaged along the path of contact, or evaluated at the pitch point.
//!
//! The average weights every point by its load share and sliding velocity, so that mean friction times the local loss factor equals
//! the loss of the path integral. The pitch point has pure rolling: that option is intended for laws of mixed friction whose
//! publications evaluate them there.

use gearloss_framework::contact::sharing::SharingEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw};
use gearloss_framework::mechanism::tooth_friction::{ContactAt, ToothFriction};
use gearloss_framework::mechanism::{Answers, NoPart};
use gearloss_framework::real::Mask as _;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use gearloss_framework::{observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gearloss_framework::contact::path::FrictionPath;

use crate::tooth_friction::finite;

observed! { MU = ("mu_m", "-", "mean coefficient of friction"); }

/// Laws whose friction vanishes or diverges without sliding.
const SLIDING_LAWS: [&str; 6] = [
    "xu",
    "eyring",
    "benedict_kelley",
    "misharin",
    "odonoghue_cameron",
    "ehl_mixed",
];

/// Where the local law is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Where {
    /// Along the path of contact, weighted by load and sliding velocity.
    #[default]
    Path,
    /// At the pitch point, under the full load.
    PitchPoint,
}

/// A local friction law, averaged along the path of contact or evaluated at the pitch point.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Local friction law of the flanks.
    pub tooth_friction: ModelRef<ToothFriction>,
    /// Where the law is evaluated.
    #[serde(default)]
    pub at: Where,
    /// Load sharing among pairs of teeth in contact.
    #[serde(default)]
    pub load_sharing: SharingEntry,
}

struct Local {
    at: Where,
    path: FrictionPath,
    friction: Slot<ToothFriction>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Local, Diagnostic> {
    let friction = cx.slot("tooth_friction", &params.tooth_friction)?;
    let law = params.tooth_friction.value["type"].as_str().unwrap_or_default();
    if params.at == Where::PitchPoint && SLIDING_LAWS.contains(&law) {
        return Err(cx
            .error(format!(
                "`{law}` is a law of sliding friction, and the pitch point has no sliding"
            ))
            .help("write `at: path`, or choose a law of mixed friction"));
    }
    let part = cx.own_part::<MeanFriction>()?.clone();
    let sharing = cx.load_sharing(&part, &params.load_sharing)?;
    let path = FrictionPath::new(&part.pair, sharing, &*friction).map_err(|fault| cx.error(fault))?;
    Ok(Local {
        at: params.at,
        path,
        friction,
    })
}

impl MeanFrictionLaw for Local {
    #[inline(always)]
    fn mu<R: Answers>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined> {
        if (at.speed.is_zero() | at.normal_force.is_zero()).any() {
            return Err(Undefined {
                what: "speed or load of the mesh, which is zero",
                value: 0.0,
            });
        }
        let notes = at.notes.nested(self.friction.notes);
        let mu = match self.at {
            Where::Path => {
                let path = self.path.few().at_operating_point(at, notes);
                self.path.friction(&*self.friction, &path)?.mean
            }
            Where::PitchPoint => R::answer::<ToothFriction>(
                &*self.friction,
                &ContactAt::usual(&NoPart {}, notes).with(|to| {
                    to.sliding = R::ZERO;
                    to.sum_speed = at.sum_speed;
                    to.radius = at.radius;
                    to.line_load = at.normal_force / at.part.pair.line_length();
                    to.pressure = at.pressure;
                    to.modulus = R::constant(at.part.modulus);
                    to.length = R::constant(at.part.pair.line_length());
                    to.ra = at.ra;
                    to.rq = at.rq;
                    to.temperature = at.temperature;
                    to.nu = at.nu;
                    to.eta = at.eta;
                    to.alpha = at.alpha;
                    to.beta = at.beta;
                    to.conductivity = at.conductivity;
                    to.x_l = at.x_l;
                }),
            )?,
        };
        Ok(at.observe(&MU, finite(mu)?))
    }
}

register!(MeanFriction, "local", Params,
    source: "definition of the mean: equal loss along the path of contact",
    example: "{ type: local, tooth_friction: { type: xu } }",
    evidence: [
        formula(Evidence::Derived, "the average that gives the loss of the path integral"),
        default_of("at", Evidence::Derived, "the average preserves the loss"),
        default_of("load_sharing", Evidence::Assumed, "rigid teeth"),
    ],
    observed: [MU], plastics: true, prepare: prepare);
