//! Fixed point of a scalar function: the only kind of loop in this model.

/// Finds x with phi(x) = x between zero and a maximum, where phi(0) is not below zero and phi(most) not above it, so that a
/// solution exists. Uses secants, and bisection where they leave the bracket or converge slowly.
#[derive(Debug, Clone, Copy)]
pub struct Search {
    bracket: [f64; 2],
    last: Option<(f64, f64)>,
    slope: f64,
    tried: u32,
}

impl Search {
    /// A search up to a maximum, with an initial guess for the slope of phi.
    #[inline]
    pub fn new(most: f64, slope: f64) -> Self {
        Self {
            bracket: [0.0, most],
            last: None,
            slope,
            tried: 0,
        }
    }

    /// The last estimate of the slope of phi.
    #[inline]
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// The next x, after phi has been evaluated at x.
    #[inline]
    pub fn next(&mut self, x: f64, phi: f64) -> f64 {
        self.bracket[usize::from(phi <= x)] = x;
        if let Some((x0, phi0)) = self.last {
            let slope = (phi - phi0) / (x - x0);
            if slope.is_finite() {
                self.slope = slope;
            }
        }
        self.last = Some((x, phi));
        self.tried += 1;
        let [low, high] = self.bracket;
        let secant = x + (phi - x) / (1.0 - self.slope);
        if !self.tried.is_multiple_of(8) && secant > low && secant < high {
            secant
        } else {
            0.5 * (low + high)
        }
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
