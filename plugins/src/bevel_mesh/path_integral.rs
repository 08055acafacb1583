//! Loss of bevel and hypoid meshes from local friction integrated along the path of contact.
//!
//! Derived: the flanks touch along the path of contact of the virtual cylindrical gears (ISO 10300-1 annex A), with the velocities of the real
//! gears at each point: sliding is a vector, across the contact as in cylindrical gears, and along the teeth by the offset of the axes. The
//! friction force F_n mu has an arm about both axes, so that the driving gear balances T = F_n (a_1 + <mu v12/|v12| v_1>/omega_1) if it is the
//! pinion. For constant friction at the mean point alone this is the efficiency (1 + mu tan(beta_2)/cos(alpha_n))/(1 + mu
//! tan(beta_1)/cos(alpha_n)) of hypoid gears, and without an offset the loss factor of the virtual gears, pi (u + 1)/(z_1 u cos(beta_b)) (eps_1^2
//! \+ eps_2^2)/eps_alpha with even load.
//! The load is shared evenly along the path by default, an upper bound: crowned teeth carry more in the middle of the path, where profile
//! sliding is small. The line load is the normal force over the length of the line of contact of the virtual gears, whose face width is 0.85 of
//! the real one without a contact pattern. ISO 10300 has a higher peak in the middle, by 20 % for its hypoid example.
//! No published law for the loss of bevel or hypoid gears could be checked (Wech 1987, ISO/TR 22849, ISO/TR 14179-1 for bevel gears); none is
//! included. Laws of tooth friction come from tests of cylindrical gears or discs, mostly with slide-to-roll ratios up to 1, which hypoid gears
//! with a large offset exceed.

use std::sync::Arc;

use gearloss_framework::contact::path::FrictionPath;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelMeshAt, BevelMeshLaw, MeshFriction};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::flanks::{self, Flanks, LOSS_FACTOR, MU, SLIDING};
use super::uniform;
use crate::checks::SIX_DIGITS;

/// Local friction integrated along the path of contact, with friction in the balance of forces.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PathIntegral {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default = "uniform")]
    pub load_sharing: LoadSharing,
    /// Local friction law of the flanks. Laws that need a pair of gears, too, use the virtual gears of the drive flanks.
    pub tooth_friction: ModelRef<ToothFriction>,
}

/// The paths of a mesh, prepared.
struct Integral {
    /// Those of the drive and of the coast flanks, with their local loss factors.
    paths: Arc<[(FrictionPath, f64); 2]>,
    friction: Slot<ToothFriction>,
}

fn prepare(params: PathIntegral, cx: &mut Build<'_>) -> Result<Integral, Diagnostic> {
    let [drive, coast] = &cx.own_part::<BevelMesh>()?.flanks;
    let (virtual_gears, pairs) = (Arc::new(drive.clone()), [drive.pair, coast.pair]);
    let friction = cx.slot_of("tooth_friction", &virtual_gears, &params.tooth_friction)?;
    let sharing = params.load_sharing;
    super::check_sharing(&pairs, sharing, cx)?;
    let orders = (friction.order(), friction.kinked_order(), friction.friction_limits());
    let paths = cx.repeat("paths", (pairs, sharing, orders), |_| -> Result<_, String> {
        let path = |i: usize| {
            let path = FrictionPath::new(&pairs[i], sharing, &*friction)?;
            Ok::<_, String>((path, pairs[i].loss_factor_local(sharing)))
        };
        Ok(Arc::new([path(0)?, path(1)?]))
    });
    Ok(Integral {
        paths: paths.map_err(|fault| cx.error(fault))?,
        friction,
    })
}

impl BevelMeshLaw for Integral {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &BevelMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let factors = [self.paths[0].1, self.paths[1].1];
        flanks::loss(
            at,
            factors,
            #[inline(always)]
            |flank, mesh| {
                let path = &self.paths[flank].0;
                let mean = MeanFrictionAt::at_pitch_point(mesh, mesh.notes);
                let bodies = mesh.bodies()?;
                let at_path = path
                    .few()
                    .at_operating_point(&mean, mesh.notes.nested_at_same_state(self.friction.notes))
                    .with(|to| to.bodies = bodies);
                mesh.show("F_n/l", "N/mm", at_path.line_load * 1e-3);
                let found = path.friction(&*self.friction, &at_path)?;
                Ok(Flanks {
                    friction: MeshFriction {
                        sliding: found.sliding,
                        arm: found.arm,
                    },
                    mean: found.mean,
                    first_heat: found.first_heat,
                })
            },
        )
    }
}

register!(BevelMesh, "path_integral", PathIntegral,
    source: "derived on the virtual cylindrical gears of ISO 10300-1 annex A",
    example: "{ type: path_integral, tooth_friction: { type: constant, value: 0.05 } }",
    evidence: [
        formula(Evidence::Derived, "equals published formulas for constant friction at the mean point, and cylindrical gears without an offset"),
        default_of("load_sharing", Evidence::Assumed, "even load along the path: an upper bound"),
    ],
    checks: [
        Check {
            input: "{ model: { type: path_integral, load_sharing: uniform, tooth_friction: { type: constant, value: 0.05 } }, \
                    at: { torque: 250 Nm, speed: 1200 rpm } }",
            values: &[("H_v", "0.463247"), ("total", "685.0168 W")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, LOSS_FACTOR], prepare: prepare);
