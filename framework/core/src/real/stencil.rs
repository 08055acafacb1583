//! Slopes of functions that are not written over [`Real`](super::Real), by differences.

/// The results of a function at two places on each side of a point, for its slope there.
///
/// The slope is that of the polynomial through them; its error is proportional to the fourth power of the step. At a kink it is the
/// mean of both sides.
#[derive(Debug, Clone, Copy)]
pub struct Stencil<T> {
    step: f64,
    /// At -2, -1, 1 and 2 steps from the point.
    results: [T; 4],
}

impl<T> Stencil<T> {
    /// Evaluates a function of the distance from the point.
    ///
    /// # Errors
    /// The first error of the function.
    pub fn new<E>(step: f64, mut function: impl FnMut(f64) -> Result<T, E>) -> Result<Self, E> {
        let results = [
            function(-2.0 * step)?,
            function(-step)?,
            function(step)?,
            function(2.0 * step)?,
        ];
        Ok(Self { step, results })
    }

    /// The slope of one number of the results.
    pub fn slope(&self, number: impl Fn(&T) -> f64) -> f64 {
        let [far_below, below, above, far_above] = &self.results;
        let near = number(above) - number(below);
        let far = number(far_above) - number(far_below);
        (8.0 * near - far) / (12.0 * self.step)
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    fn slope(step: f64, function: impl Fn(f64) -> f64) -> f64 {
        let Ok(stencil) = Stencil::new(step, |x| Ok::<_, Infallible>(function(x)));
        stencil.slope(|x| *x)
    }

    #[test]
    fn a_polynomial_of_the_fourth_degree_has_its_exact_slope() {
        assert!((slope(0.5, |x| 3.0 + 2.0 * x - x * x + x.powi(3) - 4.0 * x.powi(4)) - 2.0).abs() < 1e-14);
    }

    #[test]
    fn the_error_decreases_with_the_fourth_power_of_the_step() {
        let error = |step: f64| (slope(step, f64::exp) - 1.0).abs();
        assert!((error(0.1) / error(0.05) - 16.0).abs() < 0.1);
    }

    #[test]
    fn a_kink_has_the_mean_slope() {
        assert!(slope(0.1, f64::abs).abs() < 1e-15);
    }
}
