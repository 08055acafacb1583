//! Samples of uncertain quantities: Sobol points, and distributions that convert them into values.
//!
//! There is no random source: a point depends only on its index, and random numbers on a seed.

mod directions;
mod distribution;
mod generator;
mod normal;
mod sobol;

pub use distribution::{Distribution, values};
pub use generator::Generator;
pub use normal::inverse_normal;
pub use sobol::Sobol;
