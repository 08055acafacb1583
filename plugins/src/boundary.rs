//! Upper bound of the friction laws: boundary friction.
//!
//! Most laws are powers of speed, fitted where a film carries part of the load. At creeping speeds they grow without bound; real
//! friction does not: without a film the flanks run on boundary layers with coefficients of typically 0.08 to 0.135. The parameter
//! `greatest` bounds the laws; its default is 0.2, the usual bound of the logarithmic law of Benedict and Kelley. Gears at normal
//! speeds never reach it.

/// Default upper bound of a coefficient of friction.
pub fn greatest() -> f64 {
    0.2
}
