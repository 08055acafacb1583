//! The temperature at which points are evaluated: given, or found by balance.

use crate::description::ThermalMode;
use crate::evaluate::{Point, Scratch};
use crate::thermal::Equilibrium;
use crate::transmission::{Case, Transmission};

/// How the temperature of the oil is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OilTemperature {
    /// It is given. \[degC\]
    Fixed(f64),
    /// Losses and heat are in balance, at every point anew.
    Balance,
}

impl OilTemperature {
    /// That of the conditions where they give one, else that of the gearbox.
    pub fn of(transmission: &Transmission, given: Option<f64>) -> Self {
        match (given, transmission.thermal_mode) {
            (Some(given), _) => Self::Fixed(given),
            (None, ThermalMode::Fixed) => Self::Fixed(transmission.oil_temperature),
            (None, ThermalMode::Balance) => Self::Balance,
        }
    }

    /// The given temperature. \[degC\]
    pub fn given(self) -> Option<f64> {
        match self {
            Self::Fixed(given) => Some(given),
            Self::Balance => None,
        }
    }

    /// The temperature at which to evaluate a point, and the balance behind it. Where there is no balance, the greatest
    /// temperature that was asked for. \[degC\]
    pub fn find(
        self,
        transmission: &Transmission,
        case: &Case,
        point: &Point<'_>,
        scratch: &mut Scratch,
    ) -> (f64, Option<Equilibrium>) {
        match self {
            Self::Fixed(given) => (given, None),
            Self::Balance => {
                let found = transmission.equilibrium(case, point, scratch);
                (found.oil().unwrap_or(transmission.housing().maximum), Some(found))
            }
        }
    }
}
