//! Loss of a joint from a known efficiency: a number, or a table over the quantities of the joint, such as its angle.
//!
//! User-defined: P = (1 - eta) P_in. For constant-velocity joints, whose friction no open formula gives, with the values of the maker: their
//! loss rises with the angle, so a table over `angle` is better than a number. The joint has one `angle` in a gearbox; to vary it over
//! points, bind its path.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::joint::{Joint, JointAt, JointModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::{register, terms};

use crate::efficiency::{EFFICIENCY, Efficiency, Params};

terms! { STATED = load("stated"); }

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency<Joint>, Diagnostic> {
    Efficiency::prepare(params, cx)
}

impl JointModel for Efficiency<Joint> {
    fn loss(&self, at: &JointAt<'_>) -> Result<Loss, Undefined> {
        self.loss(at, [at.torque, at.speed], &STATED)
    }
}

register!(Joint, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.99 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [STATED], observed: [EFFICIENCY], prepare: prepare);
