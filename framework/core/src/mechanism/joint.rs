//! Loss of joints between shafts at an angle.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::loss::{Loss, Term, Undefined};
use crate::mechanism::{Answers, Mechanism, Scalar};
use crate::real::{Dual, Lane, Points as _, Real};
use crate::{answered_by, context};

/// Marker of the mechanism; never constructed.
#[derive(Debug)]
pub enum Joint {}

/// Loss of one joint between two shafts at an angle. A model returns powers, the means over a revolution.
///
/// The inputs are [`JointAt`], which documents each quantity with unit, source and tested range, and the part in it.
pub trait JointModel: Send + Sync {
    /// Loss at one operating point. Pure; must not allocate.
    fn loss(&self, at: &JointAt<'_>) -> Result<Loss, Undefined>;

    /// The losses at several points together; written by a [law](JointLaw). An error has them evaluated one by one.
    ///
    /// # Errors
    /// As [`Mechanism::answer_together`].
    fn losses(&self, _at: &JointAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Err(Undefined::DISAGREED)
    }

    /// The loss with its derivatives; written by a [law](JointLaw). `None` has them found by differences.
    fn loss_with_derivatives(&self, _at: &JointAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        None
    }
}

/// A model of joints that is written once for one point and for several; mark `loss` as `#[inline(always)]`, so that it uses wide
/// instructions.
pub trait JointLaw: Send + Sync {
    /// Loss at one operating point, or at several. Pure; must not allocate.
    fn loss<R: Answers>(&self, at: &JointAt<'_, R>) -> Result<Loss<R>, Undefined>;
}

impl<L: JointLaw> JointModel for L {
    fn loss(&self, at: &JointAt<'_>) -> Result<Loss, Undefined> {
        JointLaw::loss(self, at)
    }

    fn losses(&self, at: &JointAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Lane::wide(
            #[inline(always)]
            || JointLaw::loss(self, at),
        )
    }

    fn loss_with_derivatives(&self, at: &JointAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        Some(JointLaw::loss(self, at))
    }
}

/// Kind of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Cardan joint (Hooke's joint) with a cross. Its speed fluctuates over a revolution; results are means.
    Cardan,
    /// Constant-velocity joint, such as a ball joint (Rzeppa) or a tripod joint.
    ConstantVelocity,
}

/// A joint between two shafts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct JointPart {
    /// Kind of the joint.
    pub kind: JointKind,
    /// Angle between the axes of both shafts. [deg]
    #[schemars(range(min = 0.0, max = 60.0))]
    pub angle: f64,
}

context! {
    /// All inputs of a joint model.
    pub struct JointAt of Joint {
        /// Magnitude of the torque on the first shaft. [Nm]
        torque: 500.0 in 0.0..=50000.0 from "the power flow, reduced by upstream losses unless it is ideal",
        /// Mean speed of the first shaft, signed. [rpm]
        speed: 800.0 in -10000.0..=10000.0 from "kinematics",
        /// One if the first shaft drives, zero if the second does. [-]
        first_drives: 1.0 in 0.0..=1.0 from "the direction of the power flow",
        /// Angle between the axes of both shafts. [deg]
        angle: 6.0 in 0.0..=60.0 from "`angle` of the joint",
    }
}

impl Mechanism for Joint {
    const KEY: &'static str = "joint";
    const MEANING: &'static str = "Loss of a joint between two shafts at an angle.";
    const ANSWER: &'static str = "Power lost in the joint. [W]";
    const EXAMPLE: &'static str = "{ kind: cardan, angle: 6 deg }";
    const TOTAL: Term = Term::load("total");
    type Part = JointPart;
    type At<'a, R: Real> = JointAt<'a, R>;
    type Answer = Loss;
    type Model = dyn JointModel;

    answered_by!(loss, losses, loss_with_derivatives);
}

impl JointModel for Scalar<Joint> {
    fn loss(&self, at: &JointAt<'_>) -> Result<Loss, Undefined> {
        self.power(at)
    }

    fn losses(&self, at: &JointAt<'_, Lane>) -> Result<Loss<Lane>, Undefined> {
        Ok(Loss::POWERS.with(&Joint::TOTAL, self.values(at)?))
    }

    fn loss_with_derivatives(&self, _at: &JointAt<'_, Dual>) -> Option<Result<Loss<Dual>, Undefined>> {
        let value = self.constant()?;
        Some(Ok(Loss::POWERS.with(&Joint::TOTAL, Dual::constant(value))))
    }
}

crate::register_mechanism!(Joint);
