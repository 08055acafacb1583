//! Mixed friction: boundary friction decreases as the film grows relative to the roughness.
//!
//! Source: Olver and Spikes, Proc. IMechE J 212 (1998) 321-336, with the exponent 2: mu = mu_f + (mu_b - mu_f)/(1 + Lambda)^m, Lambda
//! the central film over the rms roughness of both flanks.

use gearloss_framework::real::Real;

/// Share of boundary friction at a film ratio.
#[inline(always)]
pub fn boundary_share<R: Real>(lambda: R, exponent: f64) -> R {
    let above = lambda + 1.0;
    if exponent == 2.0 {
        R::constant(1.0) / (above * above)
    } else {
        above.power(-exponent)
    }
}

/// Friction from that of the film and boundary friction. If the film friction is the larger one, the transition is reversed.
#[inline(always)]
pub fn friction<R: Real>(film: R, boundary: R, share: R) -> R {
    film + (boundary - film) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn u3k_friction_over_the_film_ratio() {
        for (lambda, mu) in [(0.0, 0.13), (1.0, 0.055), (3.0, 0.03625)] {
            for exponent in [2.0, 2.0 + 1e-14] {
                assert!((friction(0.03, 0.13, boundary_share(lambda, exponent)) - mu).abs() < 1e-12);
            }
        }
    }
}
