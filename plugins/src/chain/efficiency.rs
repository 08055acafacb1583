//! Loss of a chain or belt from a known efficiency: a number, or a table over the quantities of the chain.
//!
//! User-defined: P = (1 - eta) P_in. For chains and belts whose loss has been measured or is stated by the maker, and for the map of a
//! variable belt over `ratio`, `torque` and `speed`. For a table of power losses instead of efficiencies use the model `table`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::chain::{Chain, ChainAt, ChainModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::{register, terms};

use crate::efficiency::{EFFICIENCY, Efficiency, Params};

terms! { STATED = load("stated"); }

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Efficiency<Chain>, Diagnostic> {
    Efficiency::prepare(params, cx)
}

impl ChainModel for Efficiency<Chain> {
    fn loss(&self, at: &ChainAt<'_>) -> Result<Loss, Undefined> {
        self.loss(at, [at.torque, at.speed], &STATED)
    }
}

register!(Chain, "efficiency", Params,
    source: USER_DEFINED,
    example: "{ type: efficiency, value: 0.97 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [STATED], observed: [EFFICIENCY], prepare: prepare);
