//! Fixed point of a scalar function: the only kind of loop in this model.

use gearloss_framework::real::Real;

/// Finds x with phi(x) = x between zero and a maximum, where phi(0) is not below zero and phi(most) not above it, so that a
/// solution exists. Uses secants, and bisection where they leave the bracket or converge slowly. Several points search side by side.
#[derive(Debug, Clone, Copy)]
pub struct Search<R = f64> {
    bracket: [R; 2],
    last: Option<(R, R)>,
    slope: R,
    tried: u32,
}

impl<R: Real> Search<R> {
    /// A search up to a maximum, with an initial guess for the slope of phi.
    #[inline(always)]
    pub fn new(most: R, slope: R) -> Self {
        Self {
            bracket: [R::ZERO, most],
            last: None,
            slope,
            tried: 0,
        }
    }

    /// The last estimate of the slope of phi.
    #[inline(always)]
    pub fn slope(&self) -> R {
        self.slope
    }

    /// The next x, after phi has been evaluated at x.
    #[inline(always)]
    pub fn next(&mut self, x: R, phi: R) -> R {
        let falls = !phi.is_above(x);
        let [low, high] = self.bracket;
        let [low, high] = [R::select(falls, low, x), R::select(falls, x, high)];
        self.bracket = [low, high];
        if let Some((x0, phi0)) = self.last {
            let slope = (phi - phi0) / (x - x0);
            self.slope = R::select(slope.is_within(f64::MIN, f64::MAX), slope, self.slope);
        }
        self.last = Some((x, phi));
        self.tried += 1;
        let middle = (low + high) * 0.5;
        if self.tried.is_multiple_of(8) {
            return middle;
        }
        let secant = self.secant(x, phi);
        R::select(secant.is_above(low) & secant.is_below(high), secant, middle)
    }

    /// The solution after phi has been evaluated at x, if the slope of phi is that of the last estimate.
    #[inline(always)]
    pub fn secant(&self, x: R, phi: R) -> R {
        x + (phi - x) / (R::constant(1.0) - self.slope)
    }

    /// The same inside the bracket, else phi.
    #[inline(always)]
    pub fn solution(&self, x: R, phi: R) -> R {
        let secant = self.secant(x, phi);
        let [low, high] = self.bracket;
        R::select(secant.is_below(low) | !secant.is_below(high), phi, secant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solution and the number of iterations.
    fn settle(phi: impl Fn(f64) -> f64, start: f64, most: f64) -> (f64, u32) {
        let mut search = Search::new(most, 0.0);
        let mut x = start;
        for passes in 1..200 {
            let y = phi(x);
            if (y - x).abs() < 1e-9 {
                return (y, passes);
            }
            x = search.next(x, y);
        }
        panic!("not converged: {x}");
    }

    #[test]
    fn falling_rising_steep_and_stepping_laws_settle() {
        assert!(settle(|x| 0.1 - 0.3 * x, 0.05, 1.0).1 <= 4);
        assert!(settle(|x| 0.02 + 0.9 * x, 0.9, 1.0).1 <= 4);
        assert!(settle(|x| (0.05 - 40.0 * (x - 0.04)).clamp(0.0, 0.13), 0.1, 0.13).1 < 40);
        let (step, passes) = settle(|x| if x < 0.07 { 0.12 } else { 0.07 }, 0.01, 0.13);
        assert!((step - 0.07).abs() < 1e-6 && passes < 60, "{step} {passes}");
        // With positive feedback there are several solutions; one of them is found.
        let s_shaped = |x: f64| 0.01 + 0.1 * x * x / (x * x + 1e-3);
        let (found, _) = settle(s_shaped, 0.0, 0.13);
        assert!((s_shaped(found) - found).abs() < 1e-8);
    }
}
