//! Least squares of a few parameters with confidence intervals.

use gearloss_numerics::inference::{self, Accuracy, Standing};
use gearloss_numerics::least_squares::{Options, Problem, Side, solve};

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    pub name: String,
    pub value: f64,
    /// Absent if the points do not determine it.
    pub deviation: Option<f64>,
    /// Ends of the 95 % interval.
    pub interval: Option<[f64; 2]>,
    /// Whether it is at an active bound.
    pub held: bool,
}

/// Least squares estimates of a problem; their accuracy is estimated from the scatter of the residuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Squares {
    pub estimates: Vec<Estimate>,
    /// Correlation of the first two parameters.
    pub correlation: Option<f64>,
    /// Root mean square of the residuals.
    pub rms: f64,
}

impl Squares {
    pub fn from_problem(problem: &Problem<'_>) -> Result<Self, String> {
        let fit = solve(problem, &Options::exact()).map_err(|fault| fault.to_string())?;
        let derivative = fit.derivative.as_ref().filter(|_| fit.converged());
        let derivative =
            derivative.ok_or_else(|| format!("the fit is {}: {}", fit.status.name(), fit.reason.name()))?;
        let mut parameters = Vec::new();
        for ((parameter, theta), active) in problem.parameters().iter().zip(&fit.theta).zip(&fit.active) {
            let bounds = [parameter.lower, parameter.upper];
            let scale = inference::Scale::Linear;
            let mut stated = inference::Parameter::new(&parameter.name, scale, *theta, bounds)?;
            stated.standing = match active {
                None => Standing::Free,
                Some(Side::Lower) => Standing::Active(inference::Side::Lower),
                Some(Side::Upper) => Standing::Active(inference::Side::Upper),
            };
            parameters.push(stated);
        }
        let said = inference::Fit::new(parameters, &derivative.jacobian, &fit.residuals, 0, Accuracy::Estimated)?;
        let estimates = problem.parameters().iter().enumerate().map(|(k, parameter)| Estimate {
            name: parameter.name.clone(),
            value: fit.theta[k],
            deviation: said.deviation(k),
            interval: said.interval(k, CONFIDENCE, 1.0).map(|i| i.ends),
            held: fit.active[k].is_some(),
        });
        Ok(Self {
            estimates: estimates.collect(),
            correlation: (fit.theta.len() > 1).then(|| said.correlation(0, 1)).flatten(),
            rms: (said.chi_square() / fit.rows as f64).sqrt(),
        })
    }
}
