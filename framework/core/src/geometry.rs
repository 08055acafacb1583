//! Involute geometry of pairs: working angles, diameters, the path of contact, load sharing, loss factors.

mod contact_lines;
pub mod crossed;
mod factors;
pub(crate) mod gauss;
mod involute;
mod pair;
mod path;
mod ramp;
mod share_table;
mod worm;

pub use involute::involute;
pub use pair::{Pair, PairFault, PairSpec, RequiredShifts};
pub use path::{Line, LoadSharing, PathPoint};
pub use share_table::{ShareRow, ShareTable};
pub use worm::{Holding, WormPair, WormProfile, WormSpec};
