//! Equilibrium of the inner ring on balls at high speed.

use super::balls::Balls;
use super::equilibrium::{Axes, Equilibrium, Given, Unbalanced, balance, balance_from};
use super::mirrored::Mirrored;

/// Part of the speed below which the search in steps is given up.
const LEAST_STEP: f64 = 1e-3;

impl Balls {
    /// The equilibrium at a speed of the inner ring (rad/s), from that at rest; where it is far from it, in steps of speed.
    ///
    /// # Errors
    /// If there is none of the stationary ring, or none is found at steps of a thousandth of the speed.
    pub fn balance_at_speed(&self, speed: f64, given: &Axes<Given>) -> Result<Equilibrium, Unbalanced> {
        follow(balance(self, given)?, speed, |speed, start| {
            balance_from(&self.at_speed(speed), given, start)
        })
    }

    /// The same in half the time, under a load in the plane of the first ball; see [`Axes::mirrored`].
    ///
    /// # Errors
    /// As [`Balls::balance_at_speed`].
    pub fn balance_mirrored(&self, speed: f64, given: &Axes<Given>) -> Result<Equilibrium, Unbalanced> {
        follow(balance(&Mirrored(self), given)?, speed, |speed, start| {
            balance_from(&Mirrored(&self.at_speed(speed)), given, start)
        })
    }
}

/// Follows an equilibrium from rest to a speed.
fn follow(
    mut found: Equilibrium,
    speed: f64,
    at_speed: impl Fn(f64, &Axes<f64>) -> Result<Equilibrium, Unbalanced>,
) -> Result<Equilibrium, Unbalanced> {
    let (mut share, mut step) = (0.0_f64, 1.0_f64);
    while share < 1.0 {
        let next = (share + step).min(1.0);
        match at_speed(next * speed, &found.displacement) {
            Ok(further) => (found, share, step) = (further, next, 2.0 * step),
            Err(Unbalanced) if step < LEAST_STEP => return Err(Unbalanced),
            Err(Unbalanced) => step *= 0.25,
        }
    }
    Ok(found)
}
