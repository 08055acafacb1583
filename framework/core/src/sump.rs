//! Where the oil of a housing is: its volume below a level, the level at rest that a volume has, and the level while gears lift oil.
//!
//! Heights are above a datum, along the upward direction of the housing, in m; volumes in m3.

mod disc;
mod hull;
mod inclined;
mod outline;
mod running;
mod space;

pub use disc::Disc;
pub use hull::{CHORDS, hull};
pub use inclined::{AnySpace, Inclinations, STEEPEST, Travel, apparent_grade};
pub use outline::{Outline, Profile};
pub use running::{Band, CAPTURE, LEAST_SPLASH, Lift, Lifted, Running, Walls, effective_share, film};
pub use space::{Crowded, Space};

#[cfg(test)]
mod tests;
