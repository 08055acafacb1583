//! How the temperature of a point was found.

use gearloss_framework::description::ThermalMode;
use gearloss_framework::transmission::Transmission;
use gearloss_report::picture::Picture;
use gearloss_report::point::{balance_text, over_temperature};
use gearloss_report::text::significant;
use gearloss_studies::analyses::balance::BalanceOfPoint;
use gearloss_studies::points::Found;
use serde::Serialize;

/// How the temperature of a point was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Convergence {
    /// What was searched; `fixed`: nothing.
    pub of: ThermalMode,
    /// The end of the search as a sentence.
    pub outcome: String,
    /// Unit of the residual: `W`, or `K` for a network.
    pub unit: &'static str,
    /// Number of steps at the start that only scan the range.
    pub scanned: usize,
    /// All steps.
    pub steps: Vec<ConvergenceStep>,
    /// Losses and transferred heat over the oil temperature.
    pub picture: Option<Picture>,
}

/// A step of the search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ConvergenceStep {
    /// Oil temperature. [degC]
    pub temperature: f64,
    /// Losses minus transferred heat; for a network the largest difference of a node from the temperature that its heat brings
    /// about. [W, K]
    pub residual: f64,
}

impl Convergence {
    /// That of the temperatures of a point.
    pub fn new(transmission: &Transmission, found: &Found) -> Self {
        let none = Self {
            of: ThermalMode::Fixed,
            outcome: format!("The oil temperature is given: {} degC.", significant(found.oil)),
            unit: "W",
            scanned: 0,
            steps: Vec::new(),
            picture: None,
        };
        if let Some(balance) = &found.balance {
            let balance = BalanceOfPoint::new(transmission, balance);
            let steps = balance.history.iter().map(|step| ConvergenceStep {
                temperature: step.oil_temperature_degc,
                residual: step.residual_w,
            });
            Self {
                of: ThermalMode::Balance,
                outcome: balance_text(&balance, true),
                scanned: balance.scan,
                steps: steps.collect(),
                picture: Some(Picture::Figure(over_temperature(
                    "Losses and transferred heat",
                    &balance,
                ))),
                ..none
            }
        } else if let Some(network) = &found.network {
            let steps = network.history.iter().map(|step| ConvergenceStep {
                temperature: step.oil,
                residual: step.change,
            });
            Self {
                of: ThermalMode::Network,
                outcome: format!(
                    "network: {} after {} evaluations, oil {:.2} degC, residual {} W",
                    network.outcome.name(),
                    network.evaluations,
                    found.oil,
                    significant(network.residual)
                ),
                unit: "K",
                steps: steps.collect(),
                ..none
            }
        } else {
            none
        }
    }
}
