//! Drag of parking locks: a mechanism with its own section `parking_locks`.

use gearloss_framework::prelude::*;

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum ParkingLock {}

/// Drag of an open parking lock. A model returns a moment about its shaft.
pub trait ParkingLockModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &ParkingLockAt<'_>) -> Result<Loss, Undefined>;
}

/// A parking lock.
#[derive(Debug, PartialEq, Deserialize, JsonSchema)]
pub struct ParkingLockPart {
    /// Outside diameter of the wheel. [mm]
    #[schemars(range(min = 20.0, max = 500.0))]
    pub wheel: f64,
}

context! {
    /// Inputs of a model of a parking lock.
    pub struct ParkingLockAt of ParkingLock {
        /// Speed of the wheel, signed. [rpm]
        speed: 1000.0 in -20000.0..=20000.0 from "kinematics of its shaft",
        /// Dynamic viscosity of the oil. [mPa s]
        eta: 8.0 in 0.5..=10000.0 from "the oil of the component at its temperature",
    }
}

impl Mechanism for ParkingLock {
    const KEY: &'static str = "parking_lock";
    const MEANING: &'static str = "Drag of an open parking lock.";
    const ANSWER: &'static str = "Drag moment. [Nm]";
    const EXAMPLE: &'static str = "{ wheel: 90 mm }";
    type Part = ParkingLockPart;
    type At<'a, R: Real> = ParkingLockAt<'a, R>;
    type Answer = Loss;
    type Model = dyn ParkingLockModel;

    answered_by!(loss);
}

impl Component for ParkingLock {
    const SECTION: &'static str = "parking_locks";
    type Attachment = OnMember;

    fn context<'a, R: Points>(
        part: &'a ParkingLockPart,
        site: MemberSite<'a, R>,
        notes: Notes<'a, R>,
    ) -> ParkingLockAt<'a, R> {
        ParkingLockAt {
            part,
            speed: site.speed,
            eta: site.oil.eta,
            notes,
        }
    }
}

// Provides `constant`, `formula`, `table` and `none`.
impl ParkingLockModel for Scalar<ParkingLock> {
    fn loss(&self, at: &ParkingLockAt<'_>) -> Result<Loss, Undefined> {
        self.moment(at)
    }
}

register_component!(ParkingLock);
