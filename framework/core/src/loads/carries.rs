//! The loads that a support can carry by its design.

/// Directions of the thrust that a support can carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thrust {
    /// No thrust.
    None,
    /// Thrust in one direction, which depends on how it is mounted.
    OneDirection,
    /// Thrust in both directions.
    Both,
}

/// The loads that a support can carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Carries {
    /// False if it carries thrust only.
    pub radial: bool,
    /// The thrust that it can carry.
    pub thrust: Thrust,
}

impl Carries {
    /// Any load: the design is not known, or has no such limit.
    pub const ANY: Self = Self {
        radial: true,
        thrust: Thrust::Both,
    };
}
