//! A problem: a residual function and its parameters.

/// Scale of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// As it is.
    Linear,
    /// Logarithmic: for positive factors that may vary by more than three to one.
    Log,
}

/// Prior of a parameter: an additional row, without robust loss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Mean, in the unit of the parameter.
    pub mean: f64,
    /// Standard deviation in the unit of the parameter; for a logarithmic parameter relative to its value. \[-\]
    pub deviation: f64,
}

/// A fitted parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name, for findings and notes.
    pub name: String,
    /// Start value in its own unit.
    pub start: f64,
    /// Minimum; minus infinity if there is none.
    pub lower: f64,
    /// Maximum; infinity if there is none.
    pub upper: f64,
    /// Scale.
    pub scale: Scale,
    /// Prior.
    pub prior: Option<Prior>,
    /// Typical size in its own unit (of its logarithm: 1) if bounds and start do not provide one.
    pub typical: Option<f64>,
}

impl Parameter {
    /// A linear parameter without bounds.
    pub fn new(name: impl Into<String>, start: f64) -> Self {
        Self {
            name: name.into(),
            start,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            scale: Scale::Linear,
            prior: None,
            typical: None,
        }
    }

    /// Sets the bounds; an infinite bound is no bound, equal bounds fix the parameter.
    pub fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower, upper, ..self }
    }

    /// Uses the logarithmic scale.
    pub fn log(self) -> Self {
        let scale = Scale::Log;
        Self { scale, ..self }
    }

    /// Sets a prior with a mean and a standard deviation, relative for a logarithmic parameter.
    pub fn prior(self, mean: f64, deviation: f64) -> Self {
        let prior = Some(Prior { mean, deviation });
        Self { prior, ..self }
    }

    /// Sets a typical size, the scale of steps and differences if the value is near zero.
    pub fn typical(self, size: f64) -> Self {
        let typical = Some(size);
        Self { typical, ..self }
    }

    /// The coordinate of a value.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.ln(),
        }
    }
}

/// A residual function: from parameters in their own units to (calculated - measured) / uncertainty, or the reason why there is none. The
/// number of rows is constant, and the function is deterministic.
pub type Residual<'a> = dyn Fn(&[f64]) -> Result<Vec<f64>, String> + Send + Sync + 'a;

/// A residual function with its parameters.
pub struct Problem<'a> {
    residual: Box<Residual<'a>>,
    parameters: Vec<Parameter>,
}

impl<'a> Problem<'a> {
    /// A residual function with its parameters.
    pub fn new(
        residual: impl Fn(&[f64]) -> Result<Vec<f64>, String> + Send + Sync + 'a,
        parameters: Vec<Parameter>,
    ) -> Self {
        Self {
            residual: Box::new(residual),
            parameters,
        }
    }

    /// Its parameters.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Weighted residuals at parameters in their own units.
    ///
    /// # Errors
    /// The error of the residual function if it has no value.
    pub fn residual(&self, theta: &[f64]) -> Result<Vec<f64>, String> {
        (self.residual)(theta)
    }
}

impl std::fmt::Debug for Problem<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Problem")
            .field("parameters", &self.parameters)
            .finish_non_exhaustive()
    }
}
