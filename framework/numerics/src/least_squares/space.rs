//! The coordinates of a problem: its free parameters, linear or logarithmic.

use super::fault::{Fault, Finding};
use super::problem::{Parameter, Scale};

/// Noise of a call above which it is more than rounding. \[-\]
const NOISY: f64 = 1e-14;

/// Coordinates u of the free parameters, with their bounds and typical sizes.
#[derive(Debug, Clone)]
pub(super) struct Space<'p> {
    pub parameters: &'p [Parameter],
    /// Indices of the free parameters; all vectors below and in the solver contain only these.
    pub free: Vec<usize>,
    pub start: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    pub typical: Vec<f64>,
    /// Notes on changes of the input.
    pub notes: Vec<String>,
}

impl<'p> Space<'p> {
    /// Coordinates of valid parameters.
    ///
    /// # Errors
    /// All errors of the parameters.
    pub fn from_parameters(parameters: &'p [Parameter]) -> Result<Self, Fault> {
        let mut findings = Vec::new();
        if parameters.is_empty() {
            findings.push(Finding::new("parameters", "there are none", "give at least one"));
        }
        for (i, parameter) in parameters.iter().enumerate() {
            if parameters[..i].iter().any(|p| p.name == parameter.name) {
                let place = format!("parameter `{}`", parameter.name);
                findings.push(Finding::new(place, "its name is used twice", "rename one of them"));
            }
            findings.extend(check(parameter));
        }
        if !findings.is_empty() {
            return Err(Fault { findings });
        }
        let mut space = Self {
            parameters,
            free: Vec::new(),
            start: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            typical: Vec::new(),
            notes: Vec::new(),
        };
        for (i, p) in parameters.iter().enumerate() {
            let start = p.start.clamp(p.lower, p.upper);
            if start != p.start {
                let note = format!("`{}` starts at its bound {start}: {} is outside", p.name, p.start);
                space.notes.push(note);
            }
            if p.lower == p.upper {
                space.notes.push(format!("`{}` is fixed at {}", p.name, p.lower));
                continue;
            }
            let logarithmic = p.scale == Scale::Log;
            // Without a bound a logarithmic parameter is unbounded in u but positive.
            let end = |bound: f64| if bound.is_finite() { p.coordinate(bound) } else { bound };
            let (lower, upper, u) = (end(p.lower), end(p.upper), p.coordinate(start));
            space.typical.push(match p.typical {
                Some(size) => size,
                None if logarithmic => 1.0,
                None if (upper - lower).is_finite() => 0.1 * (upper - lower),
                None if u != 0.0 => u.abs(),
                None => 1.0,
            });
            space.free.push(i);
            space.start.push(u);
            space.lower.push(lower);
            space.upper.push(upper);
        }
        Ok(space)
    }

    /// The same from another start.
    pub fn starting(&self, u: &[f64]) -> Self {
        Self {
            start: u.to_vec(),
            ..self.clone()
        }
    }

    /// Number of free parameters.
    pub fn len(&self) -> usize {
        self.free.len()
    }

    /// Name of a free parameter.
    pub fn name(&self, j: usize) -> &str {
        &self.parameters[self.free[j]].name
    }

    /// All parameters in their own units. A coordinate at a bound returns exactly the bound.
    pub fn theta(&self, u: &[f64]) -> Vec<f64> {
        let mut theta: Vec<f64> = self.parameters.iter().map(|p| p.lower).collect();
        for (j, i) in self.free.iter().enumerate() {
            let p = &self.parameters[*i];
            theta[*i] = match p.scale {
                _ if u[j] <= self.lower[j] => p.lower,
                _ if u[j] >= self.upper[j] => p.upper,
                Scale::Linear => u[j],
                Scale::Log => u[j].exp().clamp(p.lower, p.upper),
            };
        }
        theta
    }

    /// All coordinates, including those of fixed parameters.
    pub fn all_coordinates(&self, u: &[f64]) -> Vec<f64> {
        let mut all: Vec<f64> = self.parameters.iter().map(|p| p.coordinate(p.lower)).collect();
        for (j, i) in self.free.iter().enumerate() {
            all[*i] = u[j];
        }
        all
    }

    /// Rows of the priors of free parameters.
    pub fn priors(&self, u: &[f64]) -> impl Iterator<Item = f64> {
        let rows = self.free.iter().zip(u).map(|(i, u)| {
            let p = &self.parameters[*i];
            p.prior.map(|prior| (u - p.coordinate(prior.mean)) / prior.deviation)
        });
        rows.flatten()
    }

    /// Derivatives of the rows of priors: free parameter and slope of each.
    pub fn slopes_of_priors(&self) -> impl Iterator<Item = (usize, f64)> {
        let slopes = self.free.iter().enumerate().map(|(j, i)| {
            let prior = self.parameters[*i].prior;
            prior.map(|prior| (j, 1.0 / prior.deviation))
        });
        slopes.flatten()
    }

    /// The scale of difference steps. For noisy residuals it is at least the typical size, because the step of an offset near zero would
    /// otherwise be too small.
    pub fn reach(&self, j: usize, u: f64, noise: f64) -> f64 {
        if noise > NOISY {
            u.abs().max(self.typical[j])
        } else {
            self.size(j, u)
        }
    }

    /// The scale of a change of a coordinate.
    pub fn size(&self, j: usize, u: f64) -> f64 {
        u.abs().max(1e-3 * self.typical[j])
    }
}

/// All errors of one parameter.
fn check(p: &Parameter) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut find = |message: String, help: &str| {
        found.push(Finding::new(format!("parameter `{}`", p.name), message, help));
    };
    if !p.start.is_finite() {
        find(format!("its start is {}", p.start), "give a number");
    }
    if p.lower.is_nan() || p.upper.is_nan() || p.lower == f64::INFINITY || p.upper == f64::NEG_INFINITY {
        let message = format!("its bounds are {} and {}", p.lower, p.upper);
        find(message, "give numbers, or -inf and inf for no bound");
    } else if p.lower > p.upper {
        let message = format!("its lower bound {} is above its upper bound {}", p.lower, p.upper);
        find(message, "exchange them");
    }
    if p.scale == Scale::Log {
        if p.lower.is_finite() && p.lower <= 0.0 {
            let message = format!("its lower bound {} has no logarithm", p.lower);
            find(message, "give a positive bound, or make it linear");
        }
        if p.upper <= 0.0 {
            let message = format!("its upper bound {} has no logarithm", p.upper);
            find(message, "give a positive bound, or make it linear");
        }
        if p.start.max(p.lower) <= 0.0 {
            let message = format!("its start {} has no logarithm", p.start);
            find(message, "give a positive start, or make it linear");
        }
    }
    if let Some(prior) = p.prior {
        if !(prior.deviation > 0.0 && prior.deviation.is_finite()) {
            let message = format!("the deviation {} of its prior is not positive", prior.deviation);
            find(
                message,
                "give a standard deviation, or fix the parameter by equal bounds",
            );
        }
        if !p.coordinate(prior.mean).is_finite() {
            let message = format!("the mean {} of its prior is not possible on its scale", prior.mean);
            find(message, "give a number, positive for a logarithmic parameter");
        }
    }
    if let Some(size) = p.typical.filter(|size| !(*size > 0.0 && size.is_finite())) {
        let message = format!("its typical size {size} is not positive");
        find(message, "give a positive size, or omit it");
    }
    found
}
