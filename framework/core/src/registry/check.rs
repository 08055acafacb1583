//! Check values in the registry.

/// A case with known results, which a model or a rating must reproduce: data of the registration, so that users see how a law was checked. The
/// conformance suite evaluates it as `gearloss eval` does ([`checks`](crate::checks)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Check {
    /// Input as for `gearloss eval --input`, in YAML on one line: `part`, `at` and `model` or `rating`, each optional.
    pub input: &'static str,
    /// Quantities and their expected values with unit, such as `("moment", "0.75 Nm")`: `total`, `moment`, a term (in W), a quantity of a
    /// rating, or a step or an observed quantity by its symbol, as `gearloss eval` prints them.
    pub values: &'static [(&'static str, &'static str)],
    /// Greatest deviation, relative to the expected value.
    pub tolerance: f64,
    /// Reason for this tolerance.
    pub because: &'static str,
    /// Where the values are from: title with page, table or equation, or how they were calculated.
    pub source: &'static str,
}
