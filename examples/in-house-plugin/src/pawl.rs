//! The moment is that of a mean force at the rim and is independent of speed.

use gearloss_framework::prelude::*;

use crate::parking_lock::{ParkingLock, ParkingLockAt, ParkingLockModel};

terms! { RATTLE = no_load("rattle"); }
limits! { SPEED = ("n", "speed of the shaft", "1/min", 0.0, 6000.0, "rig of the example"); }

/// A pawl that rattles on the wheel.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Pawl {
    /// Mean force of the pawl on the wheel. [N]
    #[serde(default = "force")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub force: f64,
}

fn force() -> f64 {
    0.5
}

impl ParkingLockModel for Pawl {
    fn loss(&self, at: &ParkingLockAt<'_>) -> Result<Loss, Undefined> {
        at.check(&SPEED, at.speed.abs().rpm());
        let moment = at.show("M", "Nm", self.force * 0.5 * at.part.wheel);
        Ok(Loss::MOMENTS.with(&RATTLE, moment))
    }
}

register!(ParkingLock, "pawl", Pawl,
    source: "rig report 17, 2023",
    example: "{ type: pawl, force: 0.8 N }",
    evidence: [formula(Evidence::Assumed, "invented"), default_of("force", Evidence::Assumed, "invented")],
    limits: [SPEED], terms: [RATTLE]);
