//! Limit of a torque or a speed at which the balance reaches a given temperature.

use super::balance::{Step, balance};
use super::housing::SumpOil;
use crate::evaluate::{Point, Scratch};
use crate::transmission::{Case, Transmission};

/// Position of the limit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "snake_case", tag = "outcome", content = "at")]
pub enum Limit {
    /// At this value losses and dissipation are equal at the given temperature.
    Reached(f64),
    /// At this value the losses jump above dissipation.
    AtDiscontinuity(f64),
    /// Losses exceed dissipation from the first value of the range on.
    ExceededFromTheStart,
    /// Losses are below dissipation in the whole range.
    NotReached,
    /// Losses or heat are undefined where the limit would be.
    Undefined,
}

impl Limit {
    /// The value, if there is one.
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Reached(value) | Self::AtDiscontinuity(value) => Some(value),
            _ => None,
        }
    }

    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reached(_) => "reached",
            Self::AtDiscontinuity(_) => "at_discontinuity",
            Self::ExceededFromTheStart => "exceeded_from_the_start",
            Self::NotReached => "not_reached",
            Self::Undefined => "undefined",
        }
    }
}

impl Transmission {
    /// The first value of a range at which the balance reaches an oil temperature in degC. `set` writes a value of the range into
    /// speeds and torques of the point.
    pub fn thermal_limit(
        &self,
        case: &Case,
        point: &Point<'_>,
        temperature: f64,
        range: [f64; 2],
        set: impl Fn(f64, &mut [f64], &mut [f64]),
        scratch: &mut Scratch,
    ) -> Limit {
        let (rho, heat_capacity) = self.sump_heat(temperature);
        let oil = SumpOil {
            temperature,
            rho,
            heat_capacity,
        };
        let Ok(flow) = self.housing().flow(&oil) else {
            return Limit::Undefined;
        };
        let heat = flow.from_oil - self.housing().into_oil;
        let (mut speeds, mut torques) = (point.speeds.to_vec(), point.torques.to_vec());
        let at = |share: f64| range[0] + share * (range[1] - range[0]);
        // The dissipation at the given temperature takes the role of the losses in a balance: it falls below them at the limit.
        let found = balance([0.0, 1.0], |share| {
            set(at(share), &mut speeds, &mut torques);
            let point = Point {
                speeds: &speeds,
                torques: &torques,
                ..*point
            };
            self.probe(case, &point, &[temperature], scratch).map(|loss| Step {
                temperature: share,
                loss: heat,
                heat: loss,
                scale: loss + flow.scale,
            })
        });
        let begins = found.history.first().map(|s| (s.temperature, s.residual()));
        match (found.stable.first(), begins) {
            (_, Some((0.0, left))) if left <= 0.0 => Limit::ExceededFromTheStart,
            (Some(root), _) if root.beyond.is_some() => Limit::AtDiscontinuity(at(root.temperature)),
            (Some(root), _) => Limit::Reached(at(root.temperature)),
            (None, _) if found.undefined.is_some() => Limit::Undefined,
            (None, _) => Limit::NotReached,
        }
    }
}
