//! Parameters of a fit: coordinate, bounds and state.

/// Internal coordinate of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Linear: u = theta.
    Linear,
    /// Logarithmic: u = ln theta. For positive factors that may vary by more than 3:1.
    Log,
}

impl Scale {
    /// The parameter in its own unit from the coordinate.
    pub fn theta(self, u: f64) -> f64 {
        match self {
            Self::Linear => u,
            // An end of an interval may overflow.
            Self::Log => u.exp().min(f64::MAX),
        }
    }

    /// The coordinate from the parameter in its own unit; absent if it does not exist.
    pub fn coordinate(self, theta: f64) -> Option<f64> {
        let u = match self {
            Self::Linear => theta,
            Self::Log => theta.ln(),
        };
        u.is_finite().then_some(u)
    }
}

/// Which end of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The lower one.
    Lower,
    /// The upper one.
    Upper,
}

impl Side {
    /// Direction of the end: -1 or 1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Lower => -1.0,
            Self::Upper => 1.0,
        }
    }

    /// Index of the end in a pair.
    pub fn place(self) -> usize {
        usize::from(self == Self::Upper)
    }

    /// Name in sentences.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
        }
    }
}

/// State of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Between its bounds, or at an inactive bound.
    Free,
    /// At an active bound: the data favour a value beyond it. The others are then conditional on it.
    Active(Side),
    /// Fixed by the user.
    Fixed,
}

/// A parameter at the optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name or path in reports.
    pub name: String,
    /// Internal coordinate.
    pub scale: Scale,
    /// Coordinate of the optimum: theta or ln theta.
    pub u: f64,
    /// Lower and upper bound in the coordinate; infinite if there is none.
    pub bounds: [f64; 2],
    /// State.
    pub standing: Standing,
    /// Reference size of its interval in the coordinate if its value does not provide one, [`Parameter::sized`].
    pub size: Option<f64>,
}

impl Parameter {
    /// A parameter between two bounds, all in its own unit. It is fixed if the bounds are equal.
    ///
    /// # Errors
    /// If the bounds are reversed, the value is not between them, or a number has no coordinate.
    pub fn new(name: &str, scale: Scale, theta: f64, [low, high]: [f64; 2]) -> Result<Self, String> {
        let none = |theta: f64| format!("{name}: {theta} is not possible on a {} scale", scale.name());
        let bound = |theta: f64, infinite: f64| match scale {
            _ if theta == infinite => Ok(infinite),
            Scale::Log if theta == 0.0 => Err(format!("{name}: a logarithmic parameter needs a positive bound")),
            _ => scale.coordinate(theta).ok_or_else(|| none(theta)),
        };
        let bounds = [bound(low, f64::NEG_INFINITY)?, bound(high, f64::INFINITY)?];
        let u = scale.coordinate(theta).ok_or_else(|| none(theta))?;
        if bounds[0] > u || u > bounds[1] {
            return Err(format!("{name}: {theta} is not between its bounds {low} and {high}"));
        }
        let standing = if bounds[0] == bounds[1] {
            Standing::Fixed
        } else {
            Standing::Free
        };
        Ok(Self {
            name: name.to_owned(),
            scale,
            u,
            bounds,
            standing,
            size: None,
        })
    }

    /// Sets the reference size of its interval: for an offset, which may be zero, a typical size of the quantity.
    pub fn sized(self, size: Option<f64>) -> Self {
        let size = size.filter(|size| *size > 0.0 && size.is_finite());
        Self { size, ..self }
    }

    /// Reference size of half-widths in the coordinate, independent of the bounds: one for a logarithm; otherwise the given size, or the
    /// magnitude of the value, or one if that is zero.
    pub fn own_size(&self) -> f64 {
        match (self.scale, self.size) {
            (Scale::Linear, Some(size)) => size,
            (Scale::Linear, None) if self.u != 0.0 => self.u.abs(),
            _ => 1.0,
        }
    }

    /// The value in its own unit.
    pub fn theta(&self) -> f64 {
        self.scale.theta(self.u)
    }

    /// Reference size for measurement plans and slopes in the coordinate: the distance of the bounds. Without two bounds: one for a
    /// logarithm, otherwise the magnitude, or one if that is zero.
    pub fn range(&self) -> f64 {
        let width = self.bounds[1] - self.bounds[0];
        match self.scale {
            _ if width.is_finite() && width > 0.0 => width,
            Scale::Linear if self.u != 0.0 => self.u.abs(),
            _ => 1.0,
        }
    }

    /// Step of a central difference for a function with a relative noise; it balances truncation error and noise.
    ///
    /// The scale of a logarithm is one; of other coordinates the larger of their size and a tenth of their range. Otherwise the step of an
    /// offset near zero would be lost in rounding, and parallel columns would not be detected.
    pub fn step(&self, noise: f64) -> f64 {
        let width = self.bounds[1] - self.bounds[0];
        let size = match self.scale {
            Scale::Linear if width.is_finite() && width > 0.0 => self.u.abs().max(0.1 * width),
            Scale::Linear if self.u != 0.0 => self.u.abs(),
            _ => 1.0,
        };
        noise.max(f64::EPSILON).cbrt() * size
    }

    /// State from the gradient of the sum of squares: at an active bound, or free.
    ///
    /// "At a bound" means bitwise equal, as from a solver that respects bounds.
    pub fn update_state(&mut self, gradient: f64) {
        self.standing = match self.bounds {
            [low, high] if low == high => Standing::Fixed,
            [low, _] if self.u == low && gradient > 0.0 => Standing::Active(Side::Lower),
            [_, high] if self.u == high && gradient < 0.0 => Standing::Active(Side::Upper),
            _ => Standing::Free,
        };
    }
}

impl Scale {
    /// Name in documents and sentences.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Log => "log",
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_no_parameter_is_refused() {
        assert!(
            Parameter::new("f", Scale::Log, 1.0, [0.0, 2.0])
                .unwrap_err()
                .contains("positive bound")
        );
        assert!(Parameter::new("f", Scale::Log, -1.0, [0.1, 2.0]).is_err());
        assert!(Parameter::new("f", Scale::Linear, f64::NAN, [0.1, 2.0]).is_err());
        assert!(Parameter::new("f", Scale::Linear, 1.0, [f64::NAN, 2.0]).is_err());
        assert!(
            Parameter::new("f", Scale::Linear, 3.0, [0.1, 2.0])
                .unwrap_err()
                .contains("between")
        );
        assert!(Parameter::new("f", Scale::Linear, 1.0, [2.0, 0.0]).is_err());
    }

    #[test]
    fn coordinates_ranges_and_standing() {
        let mut f = Parameter::new("f", Scale::Log, 2.0, [0.5, 2.0]).unwrap();
        assert!((f.u - 2.0_f64.ln()).abs() < 1e-15 && (f.theta() - 2.0).abs() < 1e-15);
        assert!((f.range() - 4.0_f64.ln()).abs() < 1e-15);
        for (gradient, standing) in [(-1.0, Standing::Active(Side::Upper)), (1.0, Standing::Free)] {
            f.update_state(gradient);
            assert_eq!(f.standing, standing);
        }
        let fixed = Parameter::new("f", Scale::Linear, 2.0, [2.0, 2.0]).unwrap();
        assert_eq!((fixed.standing, fixed.range()), (Standing::Fixed, 2.0));
        let open = Parameter::new("f", Scale::Linear, -3.0, [f64::NEG_INFINITY, 1.0]).unwrap();
        assert_eq!(open.range(), 3.0);
        assert_eq!(Scale::Log.theta(1e6), f64::MAX);
    }
}
