//! What is to be fitted: a residual function and its parameters.

/// How a parameter is walked along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// As it is.
    Linear,
    /// By its logarithm: for factors above zero that may vary by more than three to one.
    Log,
}

/// What was known of a parameter before: a row of its own beside the residuals, never robustified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Mean, in the unit of the parameter.
    pub mean: f64,
    /// Standard deviation in the unit of the parameter; for a logarithmic one over its value. \[-\]
    pub deviation: f64,
}

/// A parameter that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name, for findings and notes.
    pub name: String,
    /// Where the search starts, in its own unit.
    pub start: f64,
    /// Least value; minus infinity where there is none.
    pub lower: f64,
    /// Greatest value; infinity where there is none.
    pub upper: f64,
    /// How it is walked along.
    pub scale: Scale,
    /// What was known of it before.
    pub prior: Option<Prior>,
    /// A size that is usual for it, in its own unit (of its logarithm: 1), where bounds and start do not tell one.
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

    /// Between two bounds; an infinite one is none, equal ones fix the parameter.
    pub fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower, upper, ..self }
    }

    /// Walked along by its logarithm.
    pub fn log(self) -> Self {
        let scale = Scale::Log;
        Self { scale, ..self }
    }

    /// Known before with a mean and a standard deviation, relative for a logarithmic parameter.
    pub fn prior(self, mean: f64, deviation: f64) -> Self {
        let prior = Some(Prior { mean, deviation });
        Self { prior, ..self }
    }

    /// With a usual size, by which steps and differences are measured where the value is near zero.
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

/// A residual function: parameters in their own units and in their order, to (calculated - measured) / uncertainty, or
/// why there is none. It always answers with as many rows, and with the same ones for the same parameters.
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
    /// In the words of the residual function, where it has no value.
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
