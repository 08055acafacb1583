//! Films of oil on walls and gears.
//!
//! - *Falling film*, textbook: laminar (3 nu G/g)^(1/3), turbulent 0.302 (3 nu^2/g)^(1/3) Re^(8/15) after Brauer, quoted from memory.
//! - *Draining film* after Jeffreys (1930, quoted from memory): sqrt(nu z/(g t)) at z below the upper edge, so that the mean over a height is
//!   2/3 of that at its lower end. On the flank of a tooth the acceleration of the rim takes the place of gravity (derived).
//! - *Drawn film*: a surface that rises out of a bath carries 2/3 sqrt(nu U/g) times its speed U, the most that viscosity lifts against
//!   gravity (derived), but no more than it drags along while it is wetted, 1.616 sqrt(nu l/U) (boundary layer of Sakiadis, integrated
//!   numerically). Where surface tension limits it (Landau and Levich, below a capillary number of 0.01, a few cm/s in oil), it is thinner.

use crate::real::Real;

/// Gravity. \[m/s2\]
const G: f64 = 9.80665;

/// Factor of what a moving surface drags along.
const DRAGGED: f64 = 1.616;

/// Thickness of a film that runs down a wall: flow per length (m2/s) and viscosity (m2/s). \[m\]
#[inline]
pub fn film<R: Real>(flow: R, nu: R) -> R {
    // Of smaller flows the cube root is not defined, and the film has no volume.
    let flow = flow.at_least(1e-200);
    let laminar = (flow * nu * (3.0 / G)).cbrt();
    let turbulent = (nu * nu * (3.0 / G)).cbrt() * (flow / nu).power(8.0 / 15.0) * 0.302;
    // They meet near Re = 400.
    Real::max(laminar, turbulent)
}

/// Mean thickness of the film that is left on a wall: viscosity (m2/s), height of the wall (m), time since it was wetted (s). \[m\]
pub fn left_on_wall(nu: f64, height: f64, time: f64) -> f64 {
    2.0 / 3.0 * (nu * height / (G * time)).sqrt()
}

/// Mean thickness of the film on the flanks of a gear half a turn after they left the oil: viscosity (m2/s), height of a tooth (m), speed of
/// the rim (m/s). \[m\]
pub fn left_on_flank(nu: f64, tooth: f64, speed: f64) -> f64 {
    2.0 / 3.0 * (nu * tooth / (std::f64::consts::PI * speed)).sqrt()
}

/// Flow per width over the speed of a surface that rises out of oil: viscosity (m2/s), speed (m/s), length over which it was wetted (m). \[m\]
pub fn drawn(nu: f64, speed: f64, wetted: f64) -> f64 {
    let lifted = 2.0 / 3.0 * (nu * speed / G).sqrt();
    lifted.min(DRAGGED * (nu * wetted / speed).sqrt())
}
