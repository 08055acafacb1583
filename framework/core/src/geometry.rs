//! Involute geometry of pairs: working angles, diameters, the path of contact, load sharing, loss factors.

mod contact_lines;
pub mod crossed;
mod factors;
pub(crate) mod gauss;
mod involute;
mod pair;
mod path;
mod ramp;
mod worm;

pub use involute::involute;
pub use pair::{Pair, PairFault, PairSpec};
pub use path::{LoadSharing, PathPoint};
pub use worm::{Holding, WormPair, WormProfile, WormSpec};
