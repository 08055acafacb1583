//! The temperatures at which points are evaluated: given, or found by balance of the oil or of a thermal network.

use gearloss_framework::description::ThermalMode;
use gearloss_framework::evaluate::{BatchScratch, Point, Scratch};
use gearloss_framework::thermal::network::{Moment, Steady, Surroundings};
use gearloss_framework::thermal::{Equilibrium, Outcome};
use gearloss_framework::transmission::{Case, Transmission};

/// Origin of the oil temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OilTemperature {
    /// Given. \[degC\]
    Fixed(f64),
    /// Heat balance at every point.
    Balance,
    /// Steady state of the thermal network at every point.
    Network,
}

/// The temperatures of a point and their origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Oil temperature of the housing; without a balance the maximum evaluated one. \[degC\]
    pub oil: f64,
    /// The heat balance.
    pub balance: Option<Equilibrium>,
    /// The steady state of the thermal network.
    pub network: Option<Steady>,
}

impl Found {
    fn balanced(transmission: &Transmission, found: Equilibrium) -> Self {
        Self {
            oil: found.oil().unwrap_or(transmission.housing().maximum),
            balance: Some(found),
            network: None,
        }
    }

    pub(super) fn steady(transmission: &Transmission, found: Steady) -> Self {
        let oil = transmission.network().map(|network| found.temperatures[network.oil()]);
        Self {
            oil: oil.unwrap_or(transmission.oil_temperature),
            balance: None,
            network: Some(found),
        }
    }

    /// Temperatures for the evaluation: of the oil, or of all nodes. \[degC\]
    pub fn temperatures(&self) -> &[f64] {
        match &self.network {
            Some(steady) => &steady.temperatures,
            None => std::slice::from_ref(&self.oil),
        }
    }

    /// Result of the search; absent if the temperature is given.
    pub fn outcome(&self) -> Option<Outcome> {
        let balance = self.balance.as_ref().map(|b| b.outcome);
        balance.or(self.network.as_ref().map(|n| n.outcome))
    }

    /// True if temperatures are given or were found.
    pub fn is_sound(&self) -> bool {
        self.balance.as_ref().is_none_or(|b| b.oil().is_some())
            && self.network.as_ref().is_none_or(|n| n.outcome == Outcome::Converged)
    }

    /// Number of evaluations of the point.
    pub fn evaluations(&self) -> usize {
        let balance = self.balance.as_ref().map_or(0, Equilibrium::evaluations);
        balance + self.network.as_ref().map_or(0, |n| n.evaluations)
    }
}

impl OilTemperature {
    /// From the conditions if given, otherwise from the gearbox.
    pub fn from_conditions(transmission: &Transmission, given: Option<f64>) -> Self {
        match (given, transmission.thermal_mode) {
            (Some(given), _) => Self::Fixed(given),
            (None, ThermalMode::Fixed) => Self::Fixed(transmission.oil_temperature),
            (None, ThermalMode::Balance) => Self::Balance,
            (None, ThermalMode::Network) => Self::Network,
        }
    }

    /// The given temperature. \[degC\]
    pub fn given(self) -> Option<f64> {
        match self {
            Self::Fixed(given) => Some(given),
            Self::Balance | Self::Network => None,
        }
    }

    /// The temperatures at which to evaluate a point.
    pub fn find(self, transmission: &Transmission, case: &Case, point: &Point<'_>, scratch: &mut Scratch) -> Found {
        let given = |oil| Found {
            oil,
            balance: None,
            network: None,
        };
        match self {
            Self::Fixed(oil) => given(oil),
            Self::Balance => Found::balanced(transmission, transmission.equilibrium(case, point, scratch)),
            Self::Network => {
                let around = Surroundings::default();
                let moment = Moment {
                    case,
                    point,
                    around: &around,
                };
                match transmission.steady(&moment, scratch) {
                    Some(steady) => Found::steady(transmission, steady),
                    None => given(transmission.oil_temperature),
                }
            }
        }
    }
}

/// The temperatures at which to evaluate several points of one case; balances of the oil and steady states of the network are found side
/// by side, with the temperatures of each alone.
pub fn find_all(
    transmission: &Transmission,
    case: &Case,
    points: &[Point<'_>],
    origin: impl Fn(usize) -> OilTemperature,
    scratch: &mut BatchScratch,
) -> Vec<Found> {
    let origin = &origin;
    let wanted = |wanted| points.iter().enumerate().filter(move |(i, _)| origin(*i) == wanted);
    let balanced: Vec<Point<'_>> = wanted(OilTemperature::Balance).map(|(_, point)| *point).collect();
    let mut balances = transmission.equilibria(case, &balanced, scratch).into_iter();
    let around = Surroundings::default();
    let moment = |(_, point)| Moment {
        case,
        point,
        around: &around,
    };
    let moments: Vec<Moment<'_>> = wanted(OilTemperature::Network).map(moment).collect();
    let states = transmission.steady_states(&moments, scratch).unwrap_or_default();
    let mut states = states.into_iter();
    let mut next = |number: usize| {
        let found = match origin(number) {
            OilTemperature::Fixed(_) => None,
            OilTemperature::Balance => balances.next().map(|found| Found::balanced(transmission, found)),
            OilTemperature::Network => states.next().map(|found| Found::steady(transmission, found)),
        };
        found.unwrap_or_else(|| origin(number).find(transmission, case, &points[number], scratch.alone()))
    };
    (0..points.len()).map(&mut next).collect()
}
