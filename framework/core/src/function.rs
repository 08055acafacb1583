//! Laws that an embedding program provides while it runs, such as functions of a Python session: the model `function` of every mechanism.
//!
//! The program registers a [`FunctionSource`]. Without one there is no such model, in documents, schemas or lists.

use std::sync::Arc;

use crate::loss::Undefined;
use crate::registry::inventory;

/// A law of one result over quantities of the context of a mechanism. It is a pure function: equal inputs give equal results.
pub trait Function: Send + Sync {
    /// Names of the quantities that it takes, in their order.
    fn quantities(&self) -> &[String];

    /// The results at several points: `inputs` has the values of each quantity, in its documented unit; `results` are in the unit of the
    /// mechanism's result.
    ///
    /// # Errors
    /// If it fails: the points then have no value.
    fn evaluate(&self, inputs: &[Vec<f64>], results: &mut [f64]) -> Result<(), Undefined>;
}

/// Where functions are found.
#[derive(Clone, Copy)]
pub struct FunctionSource {
    /// The function of a name.
    pub find: fn(&str) -> Option<Arc<dyn Function>>,
    /// Names of all functions.
    pub names: fn() -> Vec<String>,
}

inventory::collect!(FunctionSource);

impl FunctionSource {
    /// That of the program.
    pub(crate) fn linked() -> Option<&'static Self> {
        inventory::iter::<Self>().next()
    }
}
