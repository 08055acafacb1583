//! Differences of several quantities over one number, with their error, or the kink that they find.

/// Steps that are tried, over the size of the number: wide ones suffer less from rounding, narrow ones from curvature.
const STEPS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Difference of the derivatives below and above, over the larger one, that is a kink.
const KINK: f64 = 1e-3;
/// Rounding of a result, over the result.
const ROUNDING: f64 = 1e-14;
/// Differences of the sides below so many times their rounding are no kink.
const CLEAR: f64 = 1e5;

/// The number over which is differentiated.
pub struct Around {
    /// Its value.
    pub value: f64,
    /// Its size, in which steps are measured.
    pub size: f64,
    /// Minimum and maximum allowed.
    pub range: [f64; 2],
}

/// The derivative of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The derivative.
    pub value: f64,
    /// Its estimated error.
    pub error: f64,
    /// At a kink: the derivatives below and above.
    pub kink: Option<[f64; 2]>,
}

impl Around {
    /// Differentiates several quantities, of which the function returns the value and its error, which changes over the size of the
    /// number as the value does; `None` where one is missing at any of the places.
    ///
    /// # Errors
    /// The first error of the function.
    pub fn differentiate<E>(
        &self,
        mut function: impl FnMut(f64) -> Result<Vec<Option<[f64; 2]>>, E>,
    ) -> Result<Vec<Option<Difference>>, E> {
        let here = function(self.value)?;
        let mut scales = Vec::new();
        for step in self.steps() {
            let mut at = |times: f64| function(self.value + times * step);
            let below = [at(-0.5)?, at(-1.0)?, at(-2.0)?];
            let above = [at(0.5)?, at(1.0)?, at(2.0)?];
            scales.push((step, below, above));
        }
        let quantity = |k: usize| {
            let [here, error] = here.get(k).copied().flatten()?;
            let mut best: Option<Difference> = None;
            let mut kink = None;
            for (step, below, above) in &scales {
                let number = |results: &Vec<Option<[f64; 2]>>| Some(results.get(k).copied().flatten()?[0]);
                let [below, above] = [below, above].map(|side| {
                    let [half, one, two] = side;
                    Some([number(half)?, number(one)?, number(two)?])
                });
                let found = difference(here, below?, above?, *step);
                // The last steps are the narrowest.
                kink = found.kink;
                if best.is_none_or(|best| found.error < best.error) {
                    best = Some(found);
                }
            }
            best.map(|best| Difference {
                kink,
                error: best.error + error / self.size,
                ..best
            })
        };
        Ok((0..here.len()).map(quantity).collect())
    }

    /// The steps that stay in the range; narrower ones close to its ends.
    fn steps(&self) -> [f64; STEPS.len()] {
        let room = (self.value - self.range[0]).min(self.range[1] - self.value);
        STEPS.map(|step| {
            let step = step * self.size;
            if room > 0.0 {
                step.min(0.5 * room * step / (STEPS[0] * self.size))
            } else {
                step
            }
        })
    }
}

/// The derivative from the results at half a step, one and two steps to each side.
fn difference(here: f64, below: [f64; 3], above: [f64; 3], step: f64) -> Difference {
    // As the slope of a stencil: from the results at one and two of some steps.
    let slope = |one: usize, step: f64| {
        let (near, far) = (above[one] - below[one], above[one + 1] - below[one + 1]);
        (8.0 * near - far) / (12.0 * step)
    };
    let (wide, narrow) = (slope(1, step), slope(0, 0.5 * step));
    let rounding = ROUNDING * here.abs() / step;
    // The slope at the end of a polynomial through four points.
    let side = |[half, one, two]: [f64; 3]| (-21.0 * here + 32.0 * half - 12.0 * one + two) / (6.0 * step);
    let sides = [-side(below), side(above)];
    let apart = (sides[1] - sides[0]).abs();
    let largest = sides[0].abs().max(sides[1].abs());
    Difference {
        // The error of both decreases with the fourth power of the step. What remains after the extrapolation is less than their
        // difference, which also shows the scatter of solved points.
        value: narrow + (narrow - wide) / 15.0,
        error: (narrow - wide).abs() + rounding,
        kink: (apart > KINK * largest && apart > CLEAR * rounding).then_some(sides),
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    fn derivative(value: f64, function: impl Fn(f64) -> f64) -> Difference {
        let around = Around {
            value,
            size: value.abs().max(1.0),
            range: [f64::NEG_INFINITY, f64::INFINITY],
        };
        let found = around.differentiate(|x| Ok::<_, Infallible>(vec![Some([function(x), 0.0])]));
        let Ok(found) = found;
        found[0].unwrap_or(Difference {
            value: f64::NAN,
            error: f64::NAN,
            kink: None,
        })
    }

    #[test]
    fn smooth_functions_have_their_derivative_within_its_error() {
        for x in [0.3, 2.0, 7.0] {
            let found = derivative(x, f64::sin);
            assert_eq!(found.kink, None);
            assert!((found.value - x.cos()).abs() < 1e-10, "{found:?}");
        }
    }

    #[test]
    fn a_kink_has_the_derivatives_of_both_sides() {
        let found = derivative(2.0, |x| x + 3.0 * (x - 2.0).max(0.0));
        let [below, above] = found.kink.unwrap_or_default();
        assert!((below - 1.0).abs() < 1e-9 && (above - 4.0).abs() < 1e-9, "{found:?}");
        // A kink nearby is avoided by narrower steps.
        let found = derivative(2.0, |x| x + 3.0 * (x - 2.01).max(0.0));
        assert!(found.kink.is_none() && (found.value - 1.0).abs() < 1e-8, "{found:?}");
    }

    #[test]
    fn steps_stay_in_the_range() {
        let around = Around {
            value: 0.05,
            size: 1.0,
            range: [0.0, 1.0],
        };
        let mut places = Vec::new();
        let found = around.differentiate(|x| {
            places.push(x);
            Ok::<_, Infallible>(vec![Some([x * x, 0.0])])
        });
        let Ok(found) = found;
        assert!(places.iter().all(|x| (0.0..=1.0).contains(x)));
        assert!(found[0].is_some_and(|found| (found.value - 0.1).abs() < 1e-10));
    }
}
