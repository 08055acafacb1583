//! Power times mean friction times a tooth loss factor, shared by several models.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::real::Mask as _;
use gearloss_framework::registry::Slot;
use gearloss_framework::{observed, terms};

terms! { pub SLIDING = load("sliding"); }
observed! {
    pub MU = ("mu_m", "-", "Mean coefficient of friction.");
    pub LOSS_FACTOR = ("H_v", "-", "Tooth loss factor.");
}

/// A loss factor with its mean friction law.
pub struct Factor {
    pub value: f64,
    pub friction: Slot<MeanFriction>,
}

impl Factor {
    #[inline(always)]
    pub fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes.nested(self.friction.notes));
        let mu = at.observe(&MU, R::answer::<MeanFriction>(&*self.friction, &mean)?);
        let factor = at.observe(&LOSS_FACTOR, R::constant(self.value));
        let input = at.show("P_in", "W", at.torque * at.speed.magnitude());
        let watts = at.show("P", "W", input * mu * factor);
        Ok(Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts)))
    }
}
