//! The coordinates in which a problem is solved: its free parameters, linear or by logarithm.

use super::fault::{Fault, Finding};
use super::problem::{Parameter, Scale};

/// Noise of a call above which it is more than the rounding of a formula. \[-\]
const NOISY: f64 = 1e-14;

/// Coordinates u of the free parameters, with their bounds and usual sizes.
#[derive(Debug, Clone)]
pub(super) struct Space<'p> {
    pub parameters: &'p [Parameter],
    /// Numbers of the free ones; all vectors below and all inside the solver count these only.
    pub free: Vec<usize>,
    pub start: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    pub typical: Vec<f64>,
    /// What was changed of what was asked for.
    pub notes: Vec<String>,
}

impl<'p> Space<'p> {
    /// Coordinates of parameters that make sense.
    ///
    /// # Errors
    /// All that makes no sense, at once.
    pub fn of(parameters: &'p [Parameter]) -> Result<Self, Fault> {
        let mut findings = Vec::new();
        if parameters.is_empty() {
            findings.push(Finding::new("parameters", "there are none", "name at least one"));
        }
        for (i, parameter) in parameters.iter().enumerate() {
            if parameters[..i].iter().any(|p| p.name == parameter.name) {
                let place = format!("parameter `{}`", parameter.name);
                findings.push(Finding::new(place, "its name is taken twice", "rename one of them"));
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
                let note = format!("`{}` starts at its bound {start}: {} lies beyond it", p.name, p.start);
                space.notes.push(note);
            }
            if p.lower == p.upper {
                space.notes.push(format!("`{}` is fixed at {}", p.name, p.lower));
                continue;
            }
            let logarithmic = p.scale == Scale::Log;
            // Without a bound a logarithmic parameter is unbounded in u, and above zero all the same.
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

    /// How many are free.
    pub fn len(&self) -> usize {
        self.free.len()
    }

    /// Name of a free parameter.
    pub fn name(&self, j: usize) -> &str {
        &self.parameters[self.free[j]].name
    }

    /// All parameters in their own units. A coordinate on a bound gives the bits of the bound.
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

    /// All coordinates, those of fixed parameters among them.
    pub fn all(&self, u: &[f64]) -> Vec<f64> {
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

    /// The size by which steps of differences are measured. For noisy residuals it is no less than a usual size: the step of an
    /// offset near zero would else drown.
    pub fn reach(&self, j: usize, u: f64, noise: f64) -> f64 {
        if noise > NOISY {
            u.abs().max(self.typical[j])
        } else {
            self.size(j, u)
        }
    }

    /// The size by which a change of a coordinate counts.
    pub fn size(&self, j: usize, u: f64) -> f64 {
        u.abs().max(1e-3 * self.typical[j])
    }
}

/// All that makes no sense with one parameter.
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
        find(message, "give numbers, or -inf and inf for none");
    } else if p.lower > p.upper {
        let message = format!("its lower bound {} lies above its upper bound {}", p.lower, p.upper);
        find(message, "exchange them");
    }
    if p.scale == Scale::Log {
        if p.lower.is_finite() && p.lower <= 0.0 {
            let message = format!("its lower bound {} has no logarithm", p.lower);
            find(message, "give a bound above zero, or make it linear");
        }
        if p.upper <= 0.0 {
            let message = format!("its upper bound {} has no logarithm", p.upper);
            find(message, "give a bound above zero, or make it linear");
        }
        if p.start.max(p.lower) <= 0.0 {
            let message = format!("its start {} has no logarithm", p.start);
            find(message, "start above zero, or make it linear");
        }
    }
    if let Some(prior) = p.prior {
        if !(prior.deviation > 0.0 && prior.deviation.is_finite()) {
            let message = format!("the deviation {} of its prior is not above zero", prior.deviation);
            find(
                message,
                "give a standard deviation, or fix the parameter by equal bounds",
            );
        }
        if !p.coordinate(prior.mean).is_finite() {
            let message = format!("the mean {} of its prior has no value on its scale", prior.mean);
            find(message, "give a number, above zero for a logarithmic parameter");
        }
    }
    if let Some(size) = p.typical.filter(|size| !(*size > 0.0 && size.is_finite())) {
        let message = format!("its typical size {size} is not above zero");
        find(message, "give a size, or leave it out");
    }
    found
}
