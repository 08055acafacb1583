//! Parameters of a fit: their coordinate, bounds and standing.

/// How a parameter is counted inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// As it is: u = theta.
    Linear,
    /// By its logarithm: u = ln theta. For positive factors that may vary by more than 3:1.
    Log,
}

impl Scale {
    /// The parameter in its own unit from the coordinate.
    pub fn theta(self, u: f64) -> f64 {
        match self {
            Self::Linear => u,
            // An end of an interval may lie beyond all numbers.
            Self::Log => u.exp().min(f64::MAX),
        }
    }

    /// The coordinate from the parameter in its own unit; absent where it has none.
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

    /// Place of the end in a pair.
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

/// Whether a parameter can move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Between its bounds, or on one that does not hold it.
    Free,
    /// On a bound, and the data push it outward. The others are then conditional on it.
    Active(Side),
    /// Held by the user.
    Fixed,
}

/// A parameter at the optimum.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name or path in reports.
    pub name: String,
    /// How it is counted.
    pub scale: Scale,
    /// Coordinate of the optimum: theta or ln theta.
    pub u: f64,
    /// Lower and upper bound in the coordinate; infinite where there is none.
    pub bounds: [f64; 2],
    /// Whether it can move.
    pub standing: Standing,
    /// Size by which its interval is judged, in the coordinate, where its own value does not tell one, [`Parameter::sized`].
    pub size: Option<f64>,
}

impl Parameter {
    /// A parameter between two bounds, all in its own unit. It is fixed where the bounds are one.
    ///
    /// # Errors
    /// If the bounds are not in order, the value is not between them, or a number has no coordinate.
    pub fn new(name: &str, scale: Scale, theta: f64, [low, high]: [f64; 2]) -> Result<Self, String> {
        let none = |theta: f64| format!("{name}: {theta} has no place on a {} scale", scale.name());
        let bound = |theta: f64, infinite: f64| match scale {
            _ if theta == infinite => Ok(infinite),
            Scale::Log if theta == 0.0 => Err(format!("{name}: a parameter by its logarithm needs a bound above zero")),
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

    /// With a size by which its interval is judged: for an offset, which may be zero, one that is usual for the quantity.
    pub fn sized(self, size: Option<f64>) -> Self {
        let size = size.filter(|size| *size > 0.0 && size.is_finite());
        Self { size, ..self }
    }

    /// Size by which half-widths are judged whatever the bounds are, in the coordinate: one for a logarithm, whose half-width is
    /// relative as it is; else the size that was given, or the magnitude of the value, or one where that is zero.
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

    /// Size by which plans of measurements and slopes count, in the coordinate: the distance of the bounds. Without two of them a parameter
    /// is judged by its own size: a logarithm by one, else the magnitude, or one where that is zero.
    pub fn range(&self) -> f64 {
        let width = self.bounds[1] - self.bounds[0];
        match self.scale {
            _ if width.is_finite() && width > 0.0 => width,
            Scale::Linear if self.u != 0.0 => self.u.abs(),
            _ => 1.0,
        }
    }

    /// Step of a central difference for a function that is known to a relative noise. It balances what is left out of the
    /// series against the noise.
    ///
    /// A logarithm changes things at the scale of one wherever it stands, other coordinates at that of their size or a tenth of
    /// their range, the greater of the two: an offset near zero would else get a step that drowns in rounding, and parallel
    /// columns would not be found.
    pub fn step(&self, noise: f64) -> f64 {
        let width = self.bounds[1] - self.bounds[0];
        let size = match self.scale {
            Scale::Linear if width.is_finite() && width > 0.0 => self.u.abs().max(0.1 * width),
            Scale::Linear if self.u != 0.0 => self.u.abs(),
            _ => 1.0,
        };
        noise.max(f64::EPSILON).cbrt() * size
    }

    /// Where it stands by the gradient of the sum of squares: on a bound that the gradient pushes it against, or free.
    ///
    /// On a bound means by exact bits, as a solver that respects bounds leaves it there.
    pub fn stand(&mut self, gradient: f64) {
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
                .contains("above zero")
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
            f.stand(gradient);
            assert_eq!(f.standing, standing);
        }
        let fixed = Parameter::new("f", Scale::Linear, 2.0, [2.0, 2.0]).unwrap();
        assert_eq!((fixed.standing, fixed.range()), (Standing::Fixed, 2.0));
        let open = Parameter::new("f", Scale::Linear, -3.0, [f64::NEG_INFINITY, 1.0]).unwrap();
        assert_eq!(open.range(), 3.0);
        assert_eq!(Scale::Log.theta(1e6), f64::MAX);
    }
}
