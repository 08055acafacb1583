//! Bevel differential whose gears are meshes of bevel gears: torque bias of an open differential from laws of tooth friction.
//!
//! Derived, with the equilibrium of `bevel_gears`. In the frame of the case a side gear drives the pinions, and these drive the other side gear: two
//! meshes in series, whose loss a law of bevel meshes gives at their torque, speed and oil. Between them the thrust washers of the side gears take
//! e_s = mu_w tan(alpha) sin(delta_s) r_w/r_s, seat and pin of a pinion e_p = (mu_s tan(alpha) sin(delta_p) r_sp + mu_p r_pin)/r_p. What arrives at
//! the other side is T_fast = T_slow (1 - e_p) eta_1 eta_2 (1 - e_s)/((1 + e_s) (1 + e_p)), and S = (T_slow - T_fast)/T_case. For constant
//! efficiencies that is the closed form tanh(atanh(e_s) + atanh(e_p) + atanh(e_m)) with e_m = (1 - eta_1 eta_2)/(1 + eta_1 eta_2).
//! The pinions share the torque equally. Teeth are straight, with the mean pitch radius of the side gear and the usual depth.

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::bevel_mesh::{BevelMesh, BevelPart};
use gearloss_framework::mechanism::differential::{Differential, DifferentialAt, DifferentialLaw};
use gearloss_framework::real::Mask as _;
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

use super::bevel_gears::{BIAS, ContactFriction, Contacts, PINIONS, RATIO, TEETH, WASHERS};

/// Bevel differential whose gears are meshes of bevel gears: torque bias of an open differential from laws of tooth friction.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Friction of the contacts that are no teeth.
    #[serde(flatten)]
    pub contacts: ContactFriction,
    /// Loss of a pinion in mesh with a side gear.
    pub mesh: ModelRef<BevelMesh>,
}

struct BevelMeshes {
    contacts: Contacts,
    /// Teeth of a side gear over those of a pinion.
    ratio: f64,
    pinions: f64,
    part: Arc<BevelPart>,
    mesh: Slot<BevelMesh>,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<BevelMeshes, Diagnostic> {
    let gears = cx.own_part::<Differential>()?.gears;
    let Some((gears, teeth)) = gears.and_then(|gears| Some((gears, gears.teeth?))) else {
        return Err(cx
            .error("bevel_meshes requires the gears of the differential with their teeth")
            .help("add `teeth: { pinions, facewidth, ra }` to `gears`, or use `bevel_gears` with a mesh efficiency"));
    };
    let Some(contacts) = Contacts::new(&params.contacts, &gears) else {
        return Err(cx
            .error("friction takes the whole torque: the differential would lock itself")
            .help("correct the coefficients of friction and the radii"));
    };
    let part = gears.mesh(&teeth).map_err(|fault| {
        cx.error(format!("the gears of the differential do not mesh: {fault}"))
            .help("correct `gears`: numbers of teeth, radius of the side gear, face width and pressure angle")
    })?;
    let part = Arc::new(part);
    Ok(BevelMeshes {
        contacts,
        ratio: f64::from(gears.side.z) / f64::from(gears.pinion.z),
        pinions: f64::from(teeth.pinions),
        mesh: cx.slot_of("mesh", &part, &params.mesh)?,
        part,
    })
}

impl DifferentialLaw for BevelMeshes {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &DifferentialAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no torque, or both sides turn together: no loss");
            return Ok(Loss::POWERS);
        }
        let Contacts { washer, pinion } = self.contacts;
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let notes = at.notes.nested_at_same_state(self.mesh.notes);
        let speed = at.speed.abs() * self.ratio;
        // Of the torque of the driving side gear, and which gear of the mesh drives.
        let efficiency = |share: R, pinion_drives: bool, notes| {
            let torque = at.torque * share / (self.ratio * self.pinions);
            let mesh = at.mesh_at(&self.part, (torque, speed, pinion_drives), notes);
            let loss = R::answer::<BevelMesh>(&*self.mesh, &mesh)?;
            let lost = loss.total_watts(speed) / (torque * speed);
            Ok(R::select(idle, R::constant(1.0), -lost + 1.0))
        };
        let first = R::constant(1.0 / (1.0 + washer));
        let at_pinion = first * efficiency(first, false, notes.muted())?;
        let behind_pinion = at_pinion * ((1.0 - pinion) / (1.0 + pinion));
        let last = behind_pinion * efficiency(behind_pinion, true, notes)?;
        let shares = [
            (first + last) * washer,
            at_pinion - behind_pinion,
            (first - at_pinion) + (behind_pinion - last),
        ];
        let lost = shares[0] + shares[1] + shares[2];
        at.show("e_s", "-", R::constant(washer));
        at.show("e_p", "-", R::constant(pinion));
        let bias = at.observe(&BIAS, lost / (-lost + 2.0));
        at.observe(&RATIO, (bias + 1.0) / (-bias + 1.0));
        let power = at.show("P_in", "W", at.torque * at.speed.abs());
        let watts = shares.map(|share| R::select(idle, R::ZERO, power * share));
        Ok(Loss::POWERS
            .with(&WASHERS, watts[0])
            .with(&PINIONS, watts[1])
            .with(&TEETH, watts[2]))
    }
}

register!(Differential, "bevel_meshes", Params,
    source: "derived: equilibrium of side gears and pinions, with laws of bevel meshes",
    example: "{ type: bevel_meshes, friction: 0.08, mesh: { type: path_integral, tooth_friction: { type: constant, value: 0.08 } } }",
    evidence: [
        formula(Evidence::Derived, "equilibrium; the coefficients of friction of washers, seats and pins are the user's"),
        default_of("seat_friction", Evidence::Assumed, "the same as of the washers"),
        default_of("pin_friction", Evidence::Assumed, "the same as of the washers"),
    ],
    checks: [
        Check {
            input: "{ model: { type: bevel_meshes, friction: 0.08, mesh: { type: efficiency, value: 1 } }, at: { torque: 535.13560538 Nm, speed: 5 rad/s } }",
            values: &[
                ("e_s", "0.0230455786 -"), ("e_p", "0.0473022354 -"), ("S", "0.0702712108 -"), ("T_slow/T_fast", "1.1511649667 -"),
                ("total", "351.35605377 W"), ("washers", "115.10241878 W"), ("pinions", "236.25363499 W"),
            ],
            tolerance: 3e-9,
            because: "the smallest value has nine digits",
            source: "independent implementation of the closed form: 1000 Nm at the case, sides 10 rad/s apart; the total is the sum of its parts",
        },
    ],
    terms: [WASHERS, PINIONS, TEETH], observed: [BIAS, RATIO], prepare: prepare);
