//! Loss of worm drives.

pub mod agma;
pub mod din_3996;
pub mod efficiency;
pub mod friction;

use gearloss_framework::loss::Loss;
use gearloss_framework::mechanism::worm_mesh::WormMeshAt;
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::{observed, terms};

terms! {
    pub(crate) SLIDING = load("sliding");
    pub(crate) IDLE = no_load("idle");
    pub(crate) BEARINGS = load("bearings");
    pub(crate) SEALS = no_load("seals");
}
observed! {
    pub(crate) MU = ("mu_zm", "-", "mean coefficient of friction of the teeth");
    pub(crate) EFFICIENCY = ("eta_z", "-", "efficiency of the teeth in the direction of the power; below zero both must be driven");
    pub(crate) BACK = ("eta_back", "-", "efficiency of the teeth if the wheel drives; self-locking at zero or less");
}

/// The efficiency in the direction of the power for the tangent of the angle of friction, noted with that of the wheel.
#[inline(always)]
pub(crate) fn efficiency<R: Real>(at: &WormMeshAt<'_, R>, tan_rho: R) -> R {
    let [forward, back] = at.part.pair.efficiencies(tan_rho);
    at.observe(&BACK, back);
    at.observe(&EFFICIENCY, R::select(at.worm_drives(), forward, back))
}

/// The loss of teeth whose friction does not depend on torque: with coefficient and tangent of the angle of friction by sliding velocity.
#[inline(always)]
pub(crate) fn of_friction<R: Real>(
    at: &WormMeshAt<'_, R>,
    friction: impl FnOnce(&WormMeshAt<'_, R>) -> R,
    tan_rho: impl FnOnce(R) -> R,
) -> Loss<R> {
    let idle = at.speed.is_zero() | at.torque.is_zero();
    if idle.all() {
        at.branch("no speed or no torque: no loss");
        return Loss::POWERS;
    }
    let at = &at.with(|to| to.notes = to.notes.among(!idle));
    let mu = at.observe(&MU, friction(at));
    let efficiency = efficiency(at, tan_rho(mu));
    let input = at.show("P_in", "W", at.input());
    let watts = at.show("P_Vz", "W", input * (R::constant(1.0) - efficiency));
    Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts))
}

#[cfg(test)]
mod tests;
