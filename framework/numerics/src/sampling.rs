//! Points at which uncertain or unknown quantities are tried: Sobol points, and distributions that turn them into values.
//!
//! There is no random source: a point is known by its index alone, and drawn numbers follow from a seed.

mod directions;
mod distribution;
mod generator;
mod normal;
mod sobol;

pub use distribution::{Distribution, values};
pub use generator::Generator;
pub use normal::inverse_normal;
pub use sobol::Sobol;
