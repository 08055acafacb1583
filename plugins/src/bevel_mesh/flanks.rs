//! Loss of the carrying flanks of a bevel or hypoid mesh, for any law that gives their friction at a normal force.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::bevel_mesh::{BevelMeshAt, MeshFriction};
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::real::Mask as _;
use gearloss_framework::{observed, terms};

terms! { pub SLIDING = load("sliding"); }
observed! {
    pub MU = ("mu_m", "-", "coefficient of friction, weighted by load and sliding speed");
    pub LOSS_FACTOR = ("H_v", "-", "mean sliding speed over the speed of the arm of the normal force");
}

/// Friction of the carrying flanks at a torque.
pub struct Flanks<R> {
    /// Sliding and friction arm.
    pub friction: MeshFriction<R>,
    /// Mean coefficient.
    pub mean: R,
    /// Share of the heat that enters the pinion.
    pub first_heat: R,
}

/// How often friction is evaluated: the normal force depends on it, and it depends on the normal force by a small power. It changes the force
/// by 6 % at most, which changes friction by 1 % at most; after the second evaluation by less than 2e-4.
const PASSES: usize = 2;

/// The loss of a mesh whose flanks have a friction that `friction` finds for a mesh of cylindrical gears with the same normal force. `factor` is
/// the mean sliding speed of the flanks over that of the arm of the normal force.
#[inline(always)]
pub fn loss<R: Answers>(
    at: &BevelMeshAt<'_, R>,
    factors: [f64; 2],
    friction: impl Fn(usize, &GearMeshAt<'_, R>) -> Result<Flanks<R>, Undefined>,
) -> Result<Loss<R>, Undefined> {
    let idle = at.speed.is_zero() | at.torque.is_zero();
    if idle.all() {
        at.branch("no speed or no torque: no loss");
        return Ok(Loss::POWERS);
    }
    let at = &at.with(|to| to.notes = at.notes.among(!idle));
    let flank = at.flank()?;
    at.branch(if flank == 0 {
        "the drive flanks carry"
    } else {
        "the coast flanks carry"
    });
    let pair = &at.part.flanks[flank].pair;
    let arm = pair.base_radius[0] * pair.cos_base_helix;
    let mut mesh = at.on_flank(flank);
    let notes = mesh.notes;
    let mut found = None;
    for pass in 1..=PASSES {
        // Only the last evaluation has the final force.
        mesh.notes = if pass == PASSES { notes } else { notes.muted() };
        let flanks = friction(flank, &mesh)?;
        let normal = at.normal_force(flank, &flanks.friction)?;
        mesh.torque = normal * arm;
        found = Some((flanks, normal));
    }
    let Some((flanks, normal)) = found else {
        return Ok(Loss::POWERS);
    };
    at.observe(&MU, flanks.mean);
    at.observe(&LOSS_FACTOR, R::constant(factors[flank]));
    at.show("F_n", "N", normal);
    let speed = at.speed.abs();
    let pitch = pair.points[2];
    at.show("v_g at C", "m/s", speed * pair.sliding(pitch));
    at.show("v_sum at C", "m/s", speed * pair.sum_speed(pitch));
    at.show("rho at C", "mm", R::constant(pair.pitch_radius * 1e3));
    let watts = at.show("P_s", "W", flanks.friction.sliding * normal * speed);
    Ok(Loss::POWERS
        .with(&SLIDING, R::select(idle, R::ZERO, watts))
        .heats_first(flanks.first_heat))
}
