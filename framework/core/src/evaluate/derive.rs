//! Derivatives of a point: of its losses, powers and balanced temperature, over what is given.
//!
//! The point is solved first. Its flow is then continued over numbers with derivatives ([`Flow::derive`](crate::flow::Flow::derive)).
//! A balanced oil temperature is a second variable, whose derivative follows from the implicit function theorem: with losses Q(p, T)
//! and dissipated heat W(T), dT/dp = (dQ/dp) / (dW/dT - dQ/dT).

use std::collections::BTreeSet;

use super::{Noting, Point, PowerFlow, Scratch};
use crate::flow::{Balance, Tolerance};
use crate::loss::{Step, Trace};
use crate::mechanism::differences::BY_DIFFERENCES;
use crate::real::{Dual, Real as _};
use crate::thermal::Unbalanced;
use crate::transmission::{Case, Transmission};

/// Tolerance of the point whose derivatives are computed: they are those of the last iterate, so its error is theirs.
const TIGHT: f64 = 1e-12;

/// Pair of directions of the given quantity, and of the oil temperature.
const GIVEN: usize = 0;
const TEMPERATURE: usize = 1;

/// Relative rounding error of a sum of derivatives, after some hundred operations.
const ROUNDING: f64 = 1e-13;

/// A given quantity of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GivenQuantity {
    /// A speed, by position among those of the point. \[rad/s\]
    Speed(usize),
    /// A torque, by position among those of the point. \[Nm\]
    Torque(usize),
    /// The oil temperature. \[K\]
    OilTemperature,
}

/// A derivative with its estimated error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Slope {
    /// The derivative.
    pub value: f64,
    /// Estimated error.
    pub error: f64,
}

/// Derivatives of a point over one given quantity, whose unit is in the denominator.
#[derive(Debug, Clone, PartialEq)]
pub struct Slopes {
    /// Of the sum of all losses. \[W\]
    pub loss: Slope,
    /// Of the loss of each part, in their order. \[W\]
    pub parts: Vec<Slope>,
    /// Of the input power. \[W\]
    pub input_power: Slope,
    /// Of the output power; `None` if losses exceed the input of an ideal flow. \[W\]
    pub output_power: Option<Slope>,
    /// Of output over input power; `None` without output.
    pub efficiency: Option<Slope>,
    /// Of the balanced oil temperature; `None` if it is given. \[K\]
    pub oil_temperature: Option<Slope>,
    /// Numbers of the model instances whose derivatives were found by differences.
    pub by_differences: Vec<usize>,
}

/// Why a point has no derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoSlopes {
    /// The point, or a model close to it, is undefined.
    Undefined(Unbalanced),
    /// The losses increase as steeply with the temperature as the dissipated heat, or more.
    Unstable,
    /// The derivatives of the flow do not converge.
    NoConvergence,
}

impl Transmission {
    /// Derivatives of a point at one temperature for all nodes, which is given or a balanced one. \[degC\]
    ///
    /// # Errors
    /// Why there are none.
    ///
    /// # Panics
    /// As [`Transmission::evaluate`], and for a position that the point does not have: bugs of the caller.
    pub fn slopes(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperature: f64,
        is_balanced: bool,
        given: GivenQuantity,
        solved: &mut Scratch,
    ) -> Result<Slopes, NoSlopes> {
        let point = &Point {
            tolerance: Tolerance {
                power: point.tolerance.power.min(TIGHT),
                ..point.tolerance
            },
            ..*point
        };
        self.try_point(case, point, &[temperature], solved, Noting::Muted)
            .map_err(NoSlopes::Undefined)?;
        let (s, by_differences, change) = self.derive(case, point, temperature, is_balanced, given, solved)?;
        let warming = if is_balanced {
            Some(self.warming(temperature, s.sum)?)
        } else {
            None
        };
        // The derivative of a number of the point, with the temperature that follows.
        let total = |x: Dual| {
            let along =
                |k: usize| x.slopes[2 * GIVEN + k] + warming.map_or(0.0, |w| w[k] * x.slopes[2 * TEMPERATURE + k]);
            [along(0), along(1)]
        };
        let error = change.max(ROUNDING);
        let slope = |x: Dual| slope(total(x), error * total(x)[0].abs());
        let ports = self.ports.iter();
        let powers = ports.map(|p| s.work.ports[p.member] * s.models.conditions.speeds[p.member]);
        let Balance { input, mut output } = Balance::from_powers(powers);
        if point.flow == PowerFlow::Ideal {
            output = input - s.sum;
        }
        let has_output = solved.output_power(0).is_some_and(|power| power > 0.0) && input.value > 0.0;
        let efficiency = || {
            // The derivatives of both powers nearly cancel.
            let [of_input, of_output] = [input, output].map(|power| total(power)[0].abs());
            let size = (of_output + of_input * output.value / input.value) / input.value;
            self::slope(total(output / input), error * size)
        };
        Ok(Slopes {
            loss: slope(s.sum),
            parts: s.watts.iter().map(|watts| slope(*watts)).collect(),
            input_power: slope(input),
            output_power: solved.output_power(0).map(|_| slope(output)),
            efficiency: has_output.then(efficiency),
            oil_temperature: warming.map(|pair| self::slope(pair, error * pair[0].abs())),
            by_differences,
        })
    }

    /// Continues a solved point over numbers with derivatives. Returns the workspace, the instances of models that were
    /// differentiated by differences, and the last relative change of the derivatives of the flow.
    fn derive(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperature: f64,
        is_balanced: bool,
        given: GivenQuantity,
        solved: &Scratch,
    ) -> Result<(Scratch<Dual>, Vec<usize>, f64), NoSlopes> {
        let mut s: Scratch<Dual> = Scratch::new(self, case);
        let varied = |x: f64, own: bool| {
            if own {
                Dual::variable(x, GIVEN)
            } else {
                Dual::constant(x)
            }
        };
        for (i, speed) in point.speeds.iter().enumerate() {
            s.prescribed[i] = varied(*speed, given == GivenQuantity::Speed(i));
        }
        for (i, torque) in point.torques.iter().enumerate() {
            s.work.given[i] = varied(*torque, given == GivenQuantity::Torque(i));
        }
        let temperature = if is_balanced {
            Dual::variable(temperature, TEMPERATURE)
        } else {
            varied(temperature, given == GivenQuantity::OilTemperature)
        };
        s.models.conditions.temperatures.push(temperature);
        s.models.conditions.inclination = Dual::constant(self.inclination_of(point));
        s.models.conditions.trace = Some(Trace::default());
        self.settle_prescribed(case, &mut s, !0, Noting::Muted);
        let mut plain = BTreeSet::new();
        s.models.ideal = point.flow == PowerFlow::Ideal;
        s.models.derives = true;
        let (work, models) = (&mut s.work, &mut s.models);
        plain.extend(by_differences(&mut models.conditions.trace));
        let mut losses = |flow: &mut crate::flow::FlowState<'_, Dual>| {
            models.conditions.trace = Some(Trace::default());
            self.lose(case, flow, models, false);
            plain.extend(by_differences(&mut models.conditions.trace));
        };
        let change = if point.flow == PowerFlow::Real && !s.standing {
            case.flow.derive(&solved.work, work, &mut losses)
        } else {
            case.flow.ideal(work);
            work.once(&case.flow, &mut losses);
            Some(0.0)
        };
        s.ideal = point.flow == PowerFlow::Ideal;
        s.models.conditions.trace = Some(Trace::default());
        self.rest(case, &mut s, false);
        plain.extend(by_differences(&mut s.models.conditions.trace));
        self.finish(crate::flow::Outcome::Converged { passes: 1 }, &mut s);
        match (s.undefined, change) {
            (Some((part, reason)), _) => Err(NoSlopes::Undefined(Unbalanced::Part(part, reason))),
            (None, None) => Err(NoSlopes::NoConvergence),
            (None, Some(change)) => Ok((s, plain.into_iter().collect(), change)),
        }
    }

    /// Derivatives of a balanced temperature over the given quantity along both directions of its pair, from those of the losses.
    fn warming(&self, temperature: f64, loss: Dual) -> Result<[f64; 2], NoSlopes> {
        let dissipation = self.dissipation_slope(temperature).map_err(NoSlopes::Undefined)?;
        let mut warming = [0.0; 2];
        for (k, own) in warming.iter_mut().enumerate() {
            let rise = dissipation[k] - loss.slopes[2 * TEMPERATURE + k];
            if rise.is_nan() || rise <= 0.0 {
                return Err(NoSlopes::Unstable);
            }
            *own = loss.slopes[2 * GIVEN + k] / rise;
        }
        Ok(warming)
    }
}

/// The derivative from those along both directions of a pair, which differ by the error of differences, with a further error.
fn slope([value, coarse]: [f64; 2], further: f64) -> Slope {
    Slope {
        value,
        error: (value - coarse).abs() + further,
    }
}

/// The instances in a trace that were differentiated by differences; stops recording.
fn by_differences(trace: &mut Option<Trace>) -> Vec<usize> {
    let steps = trace.take().map(Trace::into_steps).unwrap_or_default();
    let plain = steps.iter().filter_map(|step| match step {
        Step::Branch { instance, taken } if *taken == BY_DIFFERENCES => Some(*instance),
        _ => None,
    });
    plain.collect()
}
