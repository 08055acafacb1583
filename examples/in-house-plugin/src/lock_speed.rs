//! Speed of the wheel of a parking lock, which the pawl must not exceed.

use gearloss_framework::prelude::*;

use crate::parking_lock::{ParkingLock, ParkingLockAt};

const SPEED: Figure = Figure::greatest("v", "m/s", "circumferential speed of the wheel");

/// Circumferential speed of the wheel of a parking lock.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct LockSpeed {
    /// Speed above which the lock is reported. [m/s]
    #[serde(default = "greatest")]
    #[schemars(range(min = 0.0, max = 100.0))]
    greatest: f64,
}

fn greatest() -> f64 {
    20.0
}

impl Rating<ParkingLock> for LockSpeed {
    fn rate(&self, at: &ParkingLockAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let speed = at.show("v", "m/s", 0.5 * at.part.wheel * at.speed.abs());
        to.add_bounded(&SPEED, speed, Bound::at_most(self.greatest));
        Ok(())
    }
}

register_rating!(ParkingLock, "lock_speed", LockSpeed,
    source: "rig report 18, 2023",
    evidence: [formula(Evidence::Derived, "circumference times speed")],
    figures: [SPEED]);

#[cfg(test)]
mod tests {
    use gearloss_framework::testing::{assert_close, rate};

    #[test]
    fn speed_of_a_wheel_by_hand() {
        let found = rate("lock_speed", "{ part: { wheel: 100 mm }, at: { speed: 1000 rpm } }");
        assert_close(found.rated.value("v").unwrap_or(0.0), 5.236, 1e-4);
    }
}
