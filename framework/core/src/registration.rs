//! Registration of mechanisms: the code that the framework provides for each, for its entry in the registry.
//!
//! It is above the registry, which refers to this code only by function pointers.

use crate::conformance;
use crate::eval;
use crate::generic;
use crate::mechanism::{Component, Mechanism, QuantityDoc};
use crate::registry::{MechanismEntry, Origin, Section};

impl MechanismEntry {
    /// The entry of a mechanism without its own section.
    pub const fn new<M: Mechanism>(origin: Origin) -> Self {
        Self {
            key: M::KEY,
            meaning: M::MEANING,
            answer: M::ANSWER,
            example: M::EXAMPLE,
            origin,
            section: None,
            quantities: quantities::<M>,
            laws: || M::LAWS.iter().map(|law| law.text).collect(),
            generics: generic::entries::<M>,
            part: |generator| <M::Part as schemars::JsonSchema>::json_schema(generator),
            eval: eval::eval::<M>,
            conform: conformance::conform::<M>,
            is_generic: conformance::is_generic::<M>,
        }
    }

    /// The entry of a mechanism whose parts have a section.
    pub const fn component<C: Component>(origin: Origin) -> Self {
        Self {
            section: Some(Section::new::<C>()),
            ..Self::new::<C>(origin)
        }
    }
}

fn quantities<M: Mechanism>() -> Vec<QuantityDoc> {
    M::QUANTITIES
        .iter()
        .map(|q| QuantityDoc {
            name: q.name,
            doc: q.doc,
            unit: q.unit,
            usual: q.usual,
            least: q.least,
            greatest: q.greatest,
            from: q.from,
        })
        .collect()
}
