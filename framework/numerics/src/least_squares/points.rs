//! Deterministic points that fill the unit cube evenly.

/// The first sixteen primes: bases of Halton's sequence.
const PRIMES: [u32; 16] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];

/// Point i of Halton's sequence in up to sixteen dimensions; from 1, since point 0 is the corner.
///
/// Halton, "On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional integrals" (1960).
pub fn halton(i: usize, dimensions: usize) -> Vec<f64> {
    PRIMES
        .iter()
        .take(dimensions)
        .map(|base| radical_inverse(i, *base))
        .collect()
}

/// Point i, starting at 1, of a low-discrepancy sequence in any number of dimensions: Halton's up to sixteen, beyond that multiples of
/// roots of primes, because Halton's points of large bases lie on lines.
///
/// Richtmyer, "The evaluation of definite integrals, and a quasi-Monte-Carlo method based on the properties of algebraic
/// numbers" (1951).
pub fn spread(i: usize, dimensions: usize) -> Vec<f64> {
    if dimensions <= PRIMES.len() {
        return halton(i, dimensions);
    }
    let primes = (2_u32..).filter(|p| (2..*p).take_while(|d| d * d <= *p).all(|d| p % d != 0));
    primes
        .take(dimensions)
        .map(|p| (i as f64 * f64::from(p).sqrt()).fract())
        .collect()
}

/// Radical inverse of a number to a base.
fn radical_inverse(mut i: usize, base: u32) -> f64 {
    let base = base as usize;
    let (mut digits, mut unit) = (0.0, 1.0);
    while i > 0 {
        unit /= base as f64;
        digits += unit * (i % base) as f64;
        i /= base;
    }
    digits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_2_7_halton_points() {
        let expected = [
            [0.5, 0.333333333, 0.2, 0.142857143],
            [0.25, 0.666666667, 0.4, 0.285714286],
            [0.75, 0.111111111, 0.6, 0.428571429],
        ];
        for (i, point) in expected.iter().enumerate() {
            for (a, b) in halton(i + 1, 4).iter().zip(point) {
                assert!((a - b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn many_dimensions_are_filled_evenly() {
        let points: Vec<Vec<f64>> = (1..=1000).map(|i| spread(i, 24)).collect();
        for j in 0..24 {
            let low = points.iter().filter(|p| p[j] < 0.5).count();
            assert!(points.iter().all(|p| (0.0..1.0).contains(&p[j])) && (480..=520).contains(&low));
        }
    }
}
