//! Sobol points: a fixed sequence that fills the unit cube evenly, identical on every platform.
//!
//! Source: Sobol, USSR Comput. Math. Math. Phys. 7 (1967) 86-112, in the order of the Gray code after Antonov, Saleev (19 (1979) 252-256);
//! directions after Joe, Kuo (2008). The sequence starts at index zero and no point is skipped, because only complete blocks of 2^k points
//! are balanced. Half of the last digit is added, so that no coordinate is zero or one.

use super::directions::JOE_KUO;

/// Binary digits of a coordinate; there are 2^32 points.
const DIGITS: usize = 32;

/// Sobol points of one number of dimensions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sobol {
    /// For each dimension the directions in descending order.
    directions: Vec<[u32; DIGITS]>,
}

impl Sobol {
    /// Number of tabulated dimensions.
    pub const MOST: usize = JOE_KUO.len() + 1;

    /// Prepares points of a number of dimensions.
    ///
    /// # Errors
    /// If there are more dimensions than [`Sobol::MOST`].
    pub fn new(dimensions: usize) -> Result<Self, String> {
        if dimensions > Self::MOST {
            return Err(format!(
                "{dimensions} dimensions exceed the {} tabulated for Sobol points; vary fewer parameters",
                Self::MOST
            ));
        }
        Ok(Self {
            directions: (0..dimensions).map(directions).collect(),
        })
    }

    /// Number of dimensions.
    pub fn dimensions(&self) -> usize {
        self.directions.len()
    }

    /// The point of an index, every coordinate inside the open interval from zero to one.
    pub fn point(&self, index: u32) -> Vec<f64> {
        // The step from one index to the next flips one digit of the Gray code; all flips together are the code.
        let gray = index ^ (index >> 1);
        let digit = |i: &usize| (gray >> i) & 1 == 1;
        let whole = |directions: &[u32; DIGITS]| (0..DIGITS).filter(digit).fold(0, |sum, i| sum ^ directions[i]);
        let share = |whole: u32| (f64::from(whole) + 0.5) / 2.0_f64.powi(32);
        self.directions.iter().map(|d| share(whole(d))).collect()
    }
}

/// Directions of one dimension, counted from zero, as fractions of 2^32.
fn directions(dimension: usize) -> [u32; DIGITS] {
    let mut v = [0; DIGITS];
    if dimension == 0 {
        for (i, v) in v.iter_mut().enumerate() {
            *v = 1 << (DIGITS - 1 - i);
        }
        return v;
    }
    let (coefficients, initial) = JOE_KUO[dimension - 1];
    let degree = initial.len();
    for i in 0..DIGITS {
        v[i] = if let Some(m) = initial.get(i) {
            m << (DIGITS - 1 - i)
        } else {
            let first = v[i - degree] ^ (v[i - degree] >> degree);
            let set = |k: &usize| (coefficients >> (degree - 1 - k)) & 1 == 1;
            (1..degree).filter(set).fold(first, |sum, k| sum ^ v[i - k])
        };
    }
    v
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn check_4_sobol_points() {
        // Coordinates of the early points have few binary digits; half of the last digit of 2^32 is added.
        let near = |point: Vec<f64>, expected: &[f64], tolerance: f64| {
            assert_eq!(point.len(), expected.len());
            for (x, y) in point.iter().zip(expected) {
                assert!((x - y).abs() <= tolerance, "{x} {y}");
            }
        };
        let six = Sobol::new(6).unwrap();
        near(six.point(3), &[0.25, 0.75, 0.75, 0.75, 0.25, 0.25], 2e-10);
        near(six.point(0), &[0.0; 6], 2e-10);
        near(six.point(1), &[0.5; 6], 2e-10);
        // Stated with six digits.
        let hundredth = [
            0.414063, 0.257813, 0.773438, 0.726563, 0.882813, 0.742188, 0.0234375, 0.476563, 0.632813, 0.695313,
            0.460938, 0.679688, 0.476563, 0.851563, 0.320313, 0.492188,
        ];
        near(Sobol::new(16).unwrap().point(100), &hundredth, 6e-7);
    }

    #[test]
    fn later_dimensions_agree_with_another_implementation() {
        // Point 1000 in dimensions 1, 16, 32, 41 and 64 as scipy 1.x gives it unscrambled, printed with eight digits.
        let point = Sobol::new(64).unwrap().point(1000);
        let expected = [0.21972656, 0.37011719, 0.14550781, 0.91308594, 0.44628906];
        for (dimension, x) in [1, 16, 32, 41, 64].into_iter().zip(expected) {
            assert!((point[dimension - 1] - x).abs() < 6e-9);
        }
    }

    #[test]
    fn directions_follow_what_the_table_must_obey() {
        for (coefficients, initial) in JOE_KUO {
            let degree = initial.len();
            // The polynomial is primitive: x has the order 2^degree - 1 modulo it.
            let polynomial = (1_u64 << degree) | (u64::from(coefficients) << 1) | 1;
            let (mut power, mut order) = (1_u64, 0);
            loop {
                power <<= 1;
                if power >> degree == 1 {
                    power ^= polynomial;
                }
                order += 1;
                if power == 1 {
                    break;
                }
            }
            assert_eq!(order, (1 << degree) - 1, "{coefficients} of degree {degree}");
            for (i, m) in initial.iter().enumerate() {
                assert!(m % 2 == 1 && *m < 2 << i, "{coefficients}: {m}");
            }
        }
    }

    /// Sobol's property A: each of the 2^d cells of half the width in d dimensions holds one of the first 2^d points. That
    /// is so if the first digits of the first d directions of the d dimensions are a regular matrix modulo two.
    #[test]
    fn leading_dimensions_have_property_a() {
        // Only 32 directions are kept; the wider matrices are those of the same recurrence, on the leading digits alone.
        let wide = |dimension: usize| -> Vec<u128> {
            let mut v: Vec<u128> = Vec::new();
            for i in 0..Sobol::MOST {
                let next = if dimension == 0 {
                    1 << (127 - i)
                } else {
                    let (a, m) = JOE_KUO[dimension - 1];
                    let s = m.len();
                    m.get(i).map_or_else(
                        || {
                            let mut x = v[i - s] ^ (v[i - s] >> s);
                            for k in (1..s).filter(|k| (a >> (s - 1 - k)) & 1 == 1) {
                                x ^= v[i - k];
                            }
                            x
                        },
                        |m| u128::from(*m) << (127 - i),
                    )
                };
                v.push(next);
            }
            v
        };
        let rows: Vec<u64> = (0..Sobol::MOST)
            .map(|j| {
                wide(j)
                    .iter()
                    .enumerate()
                    .fold(0, |row, (k, v)| row | (((v >> 127) as u64) << k))
            })
            .collect();
        for d in 1..=Sobol::MOST {
            let keep = if d == 64 { u64::MAX } else { (1 << d) - 1 };
            let mut basis: Vec<u64> = Vec::new();
            for row in rows.iter().take(d) {
                let left = basis.iter().fold(row & keep, |left, b| left.min(left ^ b));
                assert!(left != 0, "{d} dimensions");
                basis.push(left);
            }
        }
    }

    #[test]
    fn every_dimension_of_a_whole_block_is_balanced() {
        let sobol = Sobol::new(Sobol::MOST).unwrap();
        let mut seen = vec![[false; 64]; Sobol::MOST];
        for i in 0..64 {
            for (x, seen) in sobol.point(i).iter().zip(&mut seen) {
                seen[(x * 64.0) as usize] = true;
            }
        }
        assert!(seen.iter().flatten().all(|s| *s));
        let last = sobol.point(u32::MAX);
        assert!(last.iter().all(|x| 0.0 < *x && *x < 1.0));
    }

    #[test]
    fn too_many_dimensions_are_refused() {
        assert!(Sobol::new(65).unwrap_err().contains("64"));
        assert!(Sobol::new(0).unwrap().point(7).is_empty());
    }
}
