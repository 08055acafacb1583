//! Defaults that several sections share.

/// A factor without effect.
pub(super) fn default_one() -> f64 {
    1.0
}
