//! Sensitivities at one point: slopes of outputs over parameters.

use super::run::{Evaluate, outputs};
use crate::inference::{Parameter, Scale, Standing};

/// Sensitivity of one output to one parameter at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Change of the output over the change of the coordinate u (theta, or ln theta).
    pub slope: f64,
    /// Slope times the range of the coordinate over the output; absent if the output is zero.
    pub scaled: Option<f64>,
    /// Relative change of the output over the relative change of the parameter; absent if the output is zero.
    pub elasticity: Option<f64>,
}

/// Slopes of outputs over the coordinates of the parameters, by output, then by parameter; zero for fixed parameters.
///
/// The function receives the parameters in their own units. Differences are central and stay within the bounds; without space on one side
/// they use two points on the other. `noise` is the relative noise of one evaluation; zero means rounding.
///
/// # Errors
/// If the function fails or returns non-finite numbers.
pub fn gradients<F>(parameters: &[Parameter], noise: f64, function: F) -> Result<Vec<Vec<f64>>, String>
where
    F: Fn(&[f64]) -> Result<Vec<f64>, String> + Sync,
{
    Ok(differences(parameters, noise, &function)?.1)
}

/// Local sensitivities of outputs, by output, then by parameter. As [`gradients`].
///
/// # Errors
/// If the function fails or returns non-finite numbers.
pub fn local<F>(parameters: &[Parameter], noise: f64, function: F) -> Result<Vec<Vec<Local>>, String>
where
    F: Evaluate,
{
    let (values, slopes) = differences(parameters, noise, &function)?;
    let sensitivity = |value: f64, parameter: &Parameter, slope: f64| {
        let over = |change: f64| Some(change / value).filter(|x| x.is_finite());
        let relative = match parameter.scale {
            Scale::Log => slope,
            Scale::Linear => slope * parameter.u,
        };
        Local {
            slope,
            scaled: over(slope * parameter.range()),
            elasticity: over(relative),
        }
    };
    let of_output = |(value, slopes): (f64, Vec<f64>)| {
        let pairs = parameters.iter().zip(slopes);
        pairs
            .map(|(parameter, slope)| sensitivity(value, parameter, slope))
            .collect()
    };
    Ok(values.into_iter().zip(slopes).map(of_output).collect())
}

/// Outputs at the point, and slopes by output and parameter.
fn differences<F>(parameters: &[Parameter], noise: f64, function: &F) -> Result<(Vec<f64>, Vec<Vec<f64>>), String>
where
    F: Evaluate,
{
    let at: Vec<f64> = parameters.iter().map(|p| p.u).collect();
    let stencils: Vec<[f64; 2]> = parameters.iter().map(|p| stencil(p, noise)).collect();
    let point = |i: usize| {
        let mut u = at.clone();
        if let Some(i) = i.checked_sub(1) {
            u[i / 2] = stencils[i / 2][i % 2];
        }
        parameters.iter().zip(u).map(|(p, u)| p.scale.theta(u)).collect()
    };
    let mut runs = outputs(1 + 2 * parameters.len(), point, function)?;
    let neighbours = runs.split_off(1);
    let values = runs.swap_remove(0);
    let slope = |output: usize, k: usize| {
        let [h1, h2] = stencils[k].map(|u| u - at[k]);
        let [d1, d2] = [2 * k, 2 * k + 1].map(|i| neighbours[i][output] - values[output]);
        // The parabola through the three points; for h2 = -h1 it is the central difference.
        if h1 == h2 {
            0.0
        } else {
            (d1 * (h2 / h1) - d2 * (h1 / h2)) / (h2 - h1)
        }
    };
    let slopes: Vec<Vec<f64>> = (0..values.len())
        .map(|output| (0..parameters.len()).map(|k| slope(output, k)).collect())
        .collect();
    if slopes.iter().flatten().all(|s| s.is_finite()) {
        Ok((values, slopes))
    } else {
        Err("the outputs are too large for differences".to_owned())
    }
}

/// The two evaluated values of a coordinate; both are its own value if it is fixed.
fn stencil(parameter: &Parameter, noise: f64) -> [f64; 2] {
    let (u, [low, high]) = (parameter.u, parameter.bounds);
    if parameter.standing == Standing::Fixed || low >= high {
        return [u, u];
    }
    let h = parameter.step(noise);
    if low <= u - h && u + h <= high {
        return [u - h, u + h];
    }
    let (sign, room) = if high - u >= u - low {
        (1.0, high - u)
    } else {
        (-1.0, u - low)
    };
    let h = sign * h.min(0.5 * room);
    [u + h, (u + 2.0 * h).clamp(low, high)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn power_law(theta: &[f64]) -> Result<Vec<f64>, String> {
        if theta[0] < 0.5 || theta[1] > 3.0 {
            return Err("outside of the bounds".to_owned());
        }
        Ok(vec![5.0 * theta[0].powi(2) / theta[1], theta[1] - 3.0])
    }

    #[test]
    fn elasticities_of_a_power_law_are_its_exponents() {
        for (a, b) in [(1.0, 2.0), (0.5, 2.0), (1.0, 3.0)] {
            let parameters = [
                Parameter::new("a", Scale::Log, a, [0.5, 2.0]).unwrap(),
                Parameter::new("b", Scale::Linear, b, [1.0, 3.0]).unwrap(),
                Parameter::new("c", Scale::Linear, 4.0, [4.0, 4.0]).unwrap(),
            ];
            let found = local(&parameters, 0.0, power_law).unwrap();
            // Central differences lose a third of the digits, one-sided ones a little more.
            for (local, exponent) in found[0].iter().zip([2.0, -1.0, 0.0]) {
                assert!((local.elasticity.unwrap() - exponent).abs() < 1e-8, "{local:?}");
            }
            assert!((found[0][0].scaled.unwrap() - 2.0 * 4.0_f64.ln()).abs() < 1e-8);
            assert!((found[1][1].slope - 1.0).abs() < 1e-9 && found[1][1].elasticity.is_some() == (b != 3.0));
        }
    }

    #[test]
    fn faults_of_the_function_are_reported() {
        let parameters = [Parameter::new("a", Scale::Log, 1.0, [0.5, 2.0]).unwrap()];
        assert!(
            gradients(&parameters, 0.0, |_: &[f64]| Err("no".to_owned()))
                .unwrap_err()
                .contains("no")
        );
        let slopes = gradients(&parameters, 1e-6, |x: &[f64]| Ok(vec![x[0]])).unwrap();
        assert!((slopes[0][0] - 1.0).abs() < 1e-3);
    }
}
