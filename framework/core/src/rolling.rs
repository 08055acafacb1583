//! Loads inside rolling bearings: contacts, the load of every rolling element, stiffness.
//!
//! Sources: Hertz 1881 for the contacts; Sjoevall 1933, Jones 1960, Harris and ISO/TS 16281:2008 for the equilibrium of the ring, the
//! latter as printed by a public program, whose tests state values of a commercial one. Each file names what it uses and how it was
//! checked.
//!
//! The outer ring is at rest. A displacement of the inner ring, and the load that causes it, have five [`Axes`]: one axial, two radial, two
//! tilts in the planes of the radial ones. A [`Row`] of elements gives the force at a displacement, and [`balance`] finds the displacement at a
//! load: of [`Balls`] and of [`Rollers`]; [`Balls::balance_at_speed`] does at high speed. Lengths in m, forces in N, angles and tilts in rad.
//!
//! All of this is in `f64`: the number of steps of an equilibrium differs from point to point, so that lanes would not agree. [`AxialRow`] has the
//! axial displacement of very many elements, for any numbers. Nothing allocates after a row is built.

mod axial_row;
mod balance_at_speed;
mod balls;
mod elliptic;
mod equilibrium;
mod high_speed;
mod many_elements;
mod material;
mod mirrored;
mod point_contact;
mod rollers;
mod root;

pub use axial_row::AxialRow;
pub use balls::{BallGeometry, BallLoad, Balls};
pub use equilibrium::{Axes, Equilibrium, Given, LocalForce, Row, Unbalanced, balance, balance_from};
pub use high_speed::{BallAtSpeed, BallMotion, BallsAtSpeed};
pub use many_elements::{Contact, ManyElements, load_integral};
pub use material::Material;
pub use mirrored::Mirrored;
pub use point_contact::{Ellipse, PointContact};
pub use rollers::{Profile, RollerGeometry, RollerLoad, Rollers};
pub(crate) use root::root_of_growing;

#[cfg(test)]
mod tests;
