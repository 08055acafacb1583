//! Loss of crossed helical meshes from local friction along the path of their point contact.
//!
//! Derived: the point of contact moves along the normal of the flanks, with the velocities of both gears as vectors at each place. The Hertz ellipse
//! follows from the curvature of both flanks; laws of line contact get 4/3 of its long semi-axis as length and the radius that has its maximum
//! pressure. The friction force has an arm about both axes: the driving gear balances T = F_n (a_1 + <mu v12/|v12| v_1>/omega_1) if it is the first.
//! Friction is the mean along the path, with even load on all pairs of teeth in contact; the line load of a point contact is not proportional to its
//! share of the force, which shares of one have no part in. Laws of tooth friction come from tests of cylindrical gears or discs; the slide-to-roll
//! ratio of crossed helical teeth is mostly beyond their range. Wear of a new pair widens the contact.

use gearloss_framework::contact::path::FrictionPath;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::crossed_helical_mesh::{
    CrossedHelicalMesh, CrossedHelicalMeshAt, CrossedHelicalMeshLaw,
};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::real::Mask as _;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, Slot, formula};
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

use super::{EFFICIENCY, MU, SLIDING, normal_force, sliding_loss};
use crate::checks::SIX_DIGITS;

/// How often friction is evaluated: the normal force depends on it, and it on a small power of the normal force.
const PASSES: usize = 3;

/// Local friction along the path of the point of contact, with friction in the balance of forces.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PointContact {
    /// Local friction law of the flanks.
    pub tooth_friction: ModelRef<ToothFriction>,
}

struct Contact {
    path: Arc<FrictionPath>,
    friction: Slot<ToothFriction>,
}

fn prepare(params: PointContact, cx: &mut Build<'_>) -> Result<Contact, Diagnostic> {
    let flanks = Arc::new(cx.own_part::<CrossedHelicalMesh>()?.flanks.clone());
    let friction = cx.slot_of("tooth_friction", &flanks, &params.tooth_friction)?;
    let path = FrictionPath::new(&flanks.pair, LoadSharing::Uniform, &*friction).map_err(|fault| cx.error(fault))?;
    Ok(Contact {
        path: Arc::new(path),
        friction,
    })
}

impl CrossedHelicalMeshLaw for Contact {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &CrossedHelicalMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let mut mesh = at.flanks();
        let notes = mesh.notes;
        let mut loss = Loss::POWERS;
        for pass in 1..=PASSES {
            // Only the last evaluation has the final force.
            let last = pass == PASSES;
            mesh.notes = if last { notes } else { notes.muted() };
            let mean = MeanFrictionAt::at_pitch_point(&mesh, mesh.notes);
            let path = self
                .path
                .few()
                .at_operating_point(&mean, mesh.notes.nested_at_same_state(self.friction.notes));
            if last {
                at.show("p_0", "GPa", mean.pressure * 1e-9);
                at.show("v_g at C", "m/s", at.speed.abs() * at.part.at_pitch[0]);
            }
            let found = self.path.friction(&*self.friction, &path)?;
            let normal = normal_force(at, [found.sliding, found.arm])?;
            mesh.torque = normal * at.part.flanks.pair.base_radius[0];
            if last {
                at.observe(&MU, found.mean);
                loss = sliding_loss(at, idle, found.sliding, normal).heats_first(found.first_heat);
            }
        }
        Ok(loss)
    }
}

register!(CrossedHelicalMesh, "point_contact", PointContact,
    source: "derived: path of crossed helical teeth with Hertz point contact",
    example: "{ type: point_contact, tooth_friction: { type: constant, value: 0.05 } }",
    evidence: [formula(Evidence::Derived, "forces at the pitch point equal the formula of screws; the local laws were measured in line contact with less sliding")],
    checks: [
        Check {
            input: "{ model: { type: point_contact, tooth_friction: { type: constant, value: 0.05 } }, at: { torque: 10 Nm, speed: 1000 rpm } }",
            values: &[("v_g at C", "4.712389 m/s")],
            ..SIX_DIGITS
        },
    ],
    terms: [SLIDING], observed: [MU, EFFICIENCY], prepare: prepare);
