//! Viscosity over temperature according to Vogel: eta = A exp(B / (t + C)), t in degC.

/// A fitted law of the dynamic viscosity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vogel {
    /// Logarithm of A, mPa s.
    pub ln_a: f64,
    /// B. \[K\]
    pub b: f64,
    /// C. \[degC\] 95 is typical for mineral gear oils.
    pub c: f64,
}

impl Vogel {
    /// The law through two points of temperature in degC and dynamic viscosity in mPa s, with a given C.
    pub fn through(first: (f64, f64), second: (f64, f64), c: f64) -> Self {
        let (x1, x2) = (1.0 / (first.0 + c), 1.0 / (second.0 + c));
        let b = (first.1 / second.1).ln() / (x1 - x2);
        Self {
            ln_a: first.1.ln() - b * x1,
            b,
            c,
        }
    }

    /// The law through three points; `None` if no C fits them with a pole below the coldest.
    pub(crate) fn through_three(mut points: [(f64, f64); 3]) -> Option<Self> {
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        let [(t1, e1), (t2, e2), (t3, e3)] = points;
        // (ln e1/e2) / (ln e2/e3) = (t2 - t1)(t3 + C) / ((t3 - t2)(t1 + C)) is linear in C.
        let (upper, lower) = ((e1 / e2).ln() * (t3 - t2), (e2 / e3).ln() * (t2 - t1));
        let c = (lower * t3 - upper * t1) / (upper - lower);
        (c.is_finite() && t1 + c > 0.0).then(|| Self::through((t1, e1), (t3, e3), c))
    }

    /// Dynamic viscosity at a temperature in degC. \[mPa s\] At the pole and below, that of one degree above it.
    pub fn eta(&self, temperature: f64) -> f64 {
        (self.ln_a + self.b / (temperature + self.c).max(1.0)).min(700.0).exp()
    }

    /// Relative decrease of the dynamic viscosity with temperature. \[1/K\]
    pub fn slope(&self, temperature: f64) -> f64 {
        self.b / (temperature + self.c).max(1.0).powi(2)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn three_points_give_back_the_law() {
        let law = Vogel {
            ln_a: -2.3,
            b: 950.0,
            c: 95.0,
        };
        let found = Vogel::through_three([100.0, 0.0, 40.0].map(|t| (t, law.eta(t)))).unwrap();
        assert!((found.c - 95.0).abs() < 1e-9 && (found.b / 950.0 - 1.0).abs() < 1e-9);
        for t in [-20.0, 60.0, 140.0] {
            assert!((found.eta(t) / law.eta(t) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn points_that_follow_no_such_law_are_refused() {
        // A viscosity that falls faster when warm has its pole among the points.
        assert_eq!(Vogel::through_three([(0.0, 100.0), (50.0, 90.0), (100.0, 5.0)]), None);
    }
}
