//! Where laws of friction on films end: in boundary friction.
//!
//! Most laws are powers of speed that were fitted where films carry part of the load. At creeping speeds they grow without bound, and
//! friction does not: without a film flanks run on boundary layers, for which 0.08 to 0.135 is usual. The laws are held at `greatest`, 0.2,
//! the bound that Benedict and Kelley's logarithm is usually given; gears that turn faster than a crawl never reach it.

/// Greatest coefficient of friction that a law answers with, as its default.
pub fn greatest() -> f64 {
    0.2
}
