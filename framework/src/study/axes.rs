//! Axes of grids: one value, a list, or from, to and step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The most values that one axis may have.
const MOST: usize = 100_000;

/// From, to and step of an axis, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// First value.
    pub from: f64,
    /// Last value, which is reached to rounding.
    pub to: f64,
    /// Step.
    pub step: f64,
}

impl Span {
    /// The values.
    ///
    /// # Errors
    /// If the step does not lead from one end to the other, or to too many values.
    pub fn values(&self) -> Result<Vec<f64>, String> {
        let count = (self.to - self.from) / self.step;
        if !count.is_finite() || count < 0.0 {
            return Err("the step does not lead from `from` to `to`".to_owned());
        }
        if count > MOST as f64 {
            return Err(format!("the axis has more than {MOST} values"));
        }
        let count = (count * (1.0 + 1e-12) + 1e-9).floor() as usize;
        Ok((0..=count).map(|i| self.from + i as f64 * self.step).collect())
    }
}

/// Torques.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TorqueAxis {
    /// One torque. [Nm]
    One(#[schemars(range(min = -1e9, max = 1e9))] f64),
    /// Several torques. [Nm]
    List(#[schemars(inner(range(min = -1e9, max = 1e9)), length(min = 1))] Vec<f64>),
    /// Torques at equal steps.
    Steps(TorqueSpan),
}

/// Torques at equal steps.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct TorqueSpan {
    /// First torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub from: f64,
    /// Last torque. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub to: f64,
    /// Step. [Nm]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub step: f64,
}

impl TorqueAxis {
    /// The torques. \[Nm\]
    ///
    /// # Errors
    /// As [`Span::values`].
    pub fn values(&self) -> Result<Vec<f64>, String> {
        match self {
            Self::One(torque) => Ok(vec![*torque]),
            Self::List(list) => Ok(list.clone()),
            Self::Steps(s) => Span {
                from: s.from,
                to: s.to,
                step: s.step,
            }
            .values(),
        }
    }
}

/// Speeds.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SpeedAxis {
    /// One speed. [rpm]
    One(#[schemars(range(min = -1e6, max = 1e6))] f64),
    /// Several speeds. [rpm]
    List(#[schemars(inner(range(min = -1e6, max = 1e6)), length(min = 1))] Vec<f64>),
    /// Speeds at equal steps.
    Steps(SpeedSpan),
}

/// Speeds at equal steps.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct SpeedSpan {
    /// First speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub from: f64,
    /// Last speed. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub to: f64,
    /// Step. [rpm]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub step: f64,
}

impl SpeedAxis {
    /// The speeds. \[rad/s\]
    ///
    /// # Errors
    /// As [`Span::values`].
    pub fn values(&self) -> Result<Vec<f64>, String> {
        match self {
            Self::One(speed) => Ok(vec![*speed]),
            Self::List(list) => Ok(list.clone()),
            Self::Steps(s) => Span {
                from: s.from,
                to: s.to,
                step: s.step,
            }
            .values(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn steps_reach_both_ends() {
        let rpm = std::f64::consts::PI / 30.0;
        let span = Span {
            from: 1000.0 * rpm,
            to: 22000.0 * rpm,
            step: 1000.0 * rpm,
        };
        assert_eq!(span.values().unwrap().len(), 22);
        assert_eq!(
            Span {
                from: 3.0,
                to: 3.0,
                step: 1.0
            }
            .values()
            .unwrap(),
            [3.0]
        );
        assert_eq!(
            Span {
                from: 3.0,
                to: 1.0,
                step: -1.0
            }
            .values()
            .unwrap(),
            [3.0, 2.0, 1.0]
        );
    }

    #[test]
    fn a_step_that_leads_nowhere_is_refused() {
        for (from, to, step) in [(1.0, 2.0, 0.0), (1.0, 2.0, -1.0), (0.0, 1.0, 1e-9)] {
            assert!(Span { from, to, step }.values().is_err());
        }
    }
}
