//! Loss of bevel and hypoid meshes from a law of mean friction.
//!
//! Derived as for `path_integral`, with one coefficient of friction for the whole mesh: P = P_in mu S/(a_1 + mu A) if the pinion drives, with
//! the means S of the sliding speed and A of the arm of friction over the path, both per speed of the pinion, and the arm a_1 of the normal
//! force. S/a_1 is the tooth loss factor H_v. Without an offset it is that of the virtual cylindrical gears.
//! The inputs of the law are those of the virtual gears at the mean point: line load, relative radius of curvature and sum of the surface
//! speeds across the line of contact. Lengthwise sliding of hypoid gears is in the loss factor, not in the coefficient, because laws of mean
//! friction come from cylindrical gears without any.

use gearloss_framework::contact::path::Path;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::{LoadSharing, Pair};
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt, BevelMeshLaw, MeshFriction};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::flanks::{self, Flanks, LOSS_FACTOR, MU, SLIDING};
use super::uniform;
use crate::checks::SIX_DIGITS;

/// One coefficient of friction for the whole mesh, with friction in the balance of forces.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Load sharing among pairs of teeth in contact, for the tooth loss factor.
    #[serde(default = "uniform")]
    pub load_sharing: LoadSharing,
    /// Law of the mean coefficient of friction. One that averages a local law uses the drive flanks.
    pub mean_friction: ModelRef<MeanFriction>,
}

/// Points on each section of a path for means that are exact to nine digits.
const ORDER: usize = 24;

/// Means of a pair of flanks per coefficient of friction.
struct Means {
    friction: MeshFriction<f64>,
    factor: f64,
}

impl Means {
    fn new(pair: &Pair, sharing: LoadSharing) -> Result<Self, String> {
        let path = Path::new(pair, sharing, ORDER)?;
        let friction = MeshFriction {
            sliding: path.sliding(&vec![1.0; path.len()]),
            arm: path.friction_arm(&vec![1.0; path.len()], None),
        };
        Ok(Self {
            factor: friction.sliding / (pair.base_radius[0] * pair.cos_base_helix),
            friction,
        })
    }
}

struct MeanLoss {
    flanks: [Means; 2],
    friction: Slot<MeanFriction>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<MeanLoss, Diagnostic> {
    let [drive, coast] = &cx.own_part::<BevelMesh>()?.flanks;
    let (virtual_gears, pairs) = (std::sync::Arc::new(drive.clone()), [drive.pair, coast.pair]);
    let friction = cx.slot_of("mean_friction", &virtual_gears, &params.mean_friction)?;
    super::check_sharing(&pairs, params.load_sharing, cx)?;
    let means = |i: usize| Means::new(&pairs[i], params.load_sharing).map_err(|fault| cx.error(fault));
    Ok(MeanLoss {
        flanks: [means(0)?, means(1)?],
        friction,
    })
}

impl BevelMeshLaw for MeanLoss {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &BevelMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let factors = [self.flanks[0].factor, self.flanks[1].factor];
        flanks::loss(
            at,
            factors,
            #[inline(always)]
            |flank, mesh| {
                let mean = MeanFrictionAt::at_pitch_point(mesh, mesh.notes.nested(self.friction.notes));
                let mu = R::answer::<MeanFriction>(&*self.friction, &mean)?;
                let Means { friction, .. } = &self.flanks[flank];
                Ok(Flanks {
                    friction: MeshFriction {
                        sliding: mu * friction.sliding,
                        arm: mu * friction.arm,
                    },
                    mean: mu,
                    first_heat: R::HALF,
                })
            },
        )
    }
}

register!(BevelMesh, "mean_friction", Params,
    source: "derived on the virtual cylindrical gears of ISO 10300-1 annex A",
    example: "{ type: mean_friction, mean_friction: { type: schlenk } }",
    evidence: [
        formula(Evidence::Derived, "laws of cylindrical gears applied to the virtual gears; equal to `path_integral` for constant friction"),
        default_of("load_sharing", Evidence::Assumed, "even load along the path: an upper bound"),
    ],
    checks: [
        Check {
            input: "{ model: { type: mean_friction, load_sharing: uniform, mean_friction: { type: constant, value: 0.03 } }, \
                    at: { torque: 250 Nm, speed: 1200 rpm } }",
            values: &[("H_v", "0.463247"), ("total", "420.8776 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);
