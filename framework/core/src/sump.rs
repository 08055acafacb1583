//! Where the oil of a housing is: its volume below a level, the level at rest that a volume has, and the level while gears lift oil.
//!
//! Heights are above a datum, along the upward direction of the housing, in m; volumes in m3.

mod disc;
mod films;
mod hull;
mod inclined;
mod outline;
mod running;
mod space;

pub use disc::Disc;
pub use films::{drawn, film, left_on_flank, left_on_wall};
pub use hull::{CHORDS, hull};
pub use inclined::{AnySpace, Inclinations, InclinedWalls, STEEPEST, Travel, apparent_grade};
pub use outline::{Outline, Profile};
pub use running::{
    Band, CAPTURE, Catchers, Caught, LEAST_SPLASH, Lift, Lifted, Outside, Running, Walls, effective_share,
};
pub use space::{Crowded, Space};

#[cfg(test)]
mod tests;
