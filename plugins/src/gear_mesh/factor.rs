//! Power times mean friction times a tooth loss factor, shared by several models.

use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
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
    pub fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let mu = self.friction.mu(&MeanFrictionAt::at_pitch_point(
            at,
            at.notes.nested(self.friction.notes),
        ))?;
        let mu = at.observe(&MU, mu);
        let factor = at.observe(&LOSS_FACTOR, self.value);
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        Ok(Loss::POWERS.with(&SLIDING, at.show("P", "W", input * mu * factor)))
    }
}
