//! Mixed friction: boundary friction decreases as the film grows relative to the roughness.
//!
//! Source: Olver and Spikes, Proc. IMechE J 212 (1998) 321-336, with the exponent 2: mu = mu_f + (mu_b - mu_f)/(1 + Lambda)^m, Lambda
//! the central film over the rms roughness of both flanks.

/// Share of boundary friction at a film ratio.
#[inline]
pub fn boundary_share(lambda: f64, exponent: f64) -> f64 {
    let above = 1.0 + lambda;
    if exponent == 2.0 {
        1.0 / (above * above)
    } else {
        above.powf(-exponent)
    }
}

/// Friction from that of the film and boundary friction. If the film friction is the larger one, the transition is reversed.
#[inline]
pub fn friction(film: f64, boundary: f64, share: f64) -> f64 {
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
