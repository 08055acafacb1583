//! A smooth function through scattered values with its uncertainty, and the region in which it may be used.
//!
//! [`Smooth`] is a Gaussian process: it tends to zero far from all values, interpolates between them as smoothly as they allow, and states
//! how well it is known at each place. It has no value outside of the convex hull of its places.

mod hull;
mod process;

pub use hull::Hull;
pub use process::{LeftOut, MOST_VALUES, Member, Predicted, Smooth};
