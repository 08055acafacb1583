//! Pairs of gears whose axes cross or intersect: bevel, hypoid, worm and crossed helical pairs.
//!
//! Both gears are replaced by their pitch cones, which touch at the mean point in the middle of the teeth; a worm and a crossed helical gear
//! have cylinders, cones of angle zero. [`PitchCones`] finds them from the axes, the teeth and what the drawing states; [`MeanPoint`] is the frame
//! in which velocities and forces are vectors, for every kind alike; [`VirtualPair`] is the cylindrical pair whose path of contact stands for
//! that of bevel and hypoid teeth; [`ToothPath`] is the motion along that path.
//!
//! Sources: ISO 23509:2016 for cones and blanks, ISO 10300-1 annex A for the virtual pair, both as printed by public calculators whose results
//! equal the published examples; the frame, velocities and forces are derived here and agree with the axes, with published forces and with
//! cylindrical gears at a shaft angle of zero. The first gear is the pinion or worm. Angles in rad, lengths in m.

mod blank;
mod flank_pair;
mod helical_pair;
mod mean_point;
mod motion;
mod pitch_cones;
mod tooth_path;
mod virtual_pair;

pub use blank::{Blank, Depth};
pub use flank_pair::TeethFault;
pub use mean_point::{Flank, MeanPoint, ToothForce};
pub use motion::{CrossedMotion, Velocity};
pub use pitch_cones::{Closure, ConeFault, PitchCones, Size, SpiralAngle};
pub use tooth_path::ToothPath;
pub use virtual_pair::VirtualPair;

#[cfg(test)]
mod tests;
