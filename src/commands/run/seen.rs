//! What was measured at a point, from whichever columns give it.

use gearloss_framework::measured::{Measured, Row};
use gearloss_framework::study::Quantity;

/// What was measured, from whichever columns give it.
pub struct Seen {
    /// Power out over power in. \[-\]
    pub efficiency: Option<f64>,
    /// \[W\]
    pub loss: Option<f64>,
    /// \[Nm\]
    pub loss_torque: Option<f64>,
    /// \[degC\]
    pub oil: Option<f64>,
}

impl Seen {
    /// Torque and speed are those at the ports of the conditions; `out` columns those at the other port. Power counts as it
    /// flows: what goes in is positive.
    pub fn of(measured: &Measured, row: &Row, torque: f64, speed: f64, reference: f64) -> Self {
        let value = |quantity: &str| measured.value(row, quantity);
        let here = torque * speed;
        let there = value("torque_out").zip(value("speed_out")).map(|(t, w)| t * w);
        // Rigs write the torque of the brake with either sign: power comes in at one port and out at the other.
        let both = there.map(|there| (here.abs().max(there.abs()), here.abs().min(there.abs())));
        let loss = value("loss")
            .or_else(|| value("loss_torque").map(|t| t * reference.abs()))
            .or_else(|| both.map(|(more, less)| more - less))
            .or_else(|| {
                let eta = value("efficiency")?;
                if here > 0.0 {
                    Some(here * (1.0 - eta))
                } else {
                    (eta > 0.0).then(|| -here * (1.0 / eta - 1.0))
                }
            });
        let efficiency = value("efficiency")
            .or_else(|| both.map(|(more, less)| less / more))
            .or_else(|| {
                let loss = loss?;
                if here > 0.0 {
                    Some((here - loss) / here)
                } else {
                    (here < 0.0).then(|| -here / (loss - here))
                }
            })
            .filter(|eta| eta.is_finite());
        Self {
            efficiency,
            loss,
            loss_torque: value("loss_torque").or_else(|| Some(loss? / reference.abs()).filter(|t| t.is_finite())),
            oil: value("oil_temperature"),
        }
    }

    /// One of them.
    pub fn quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Efficiency => self.efficiency,
            Quantity::Loss => self.loss,
            Quantity::LossTorque => self.loss_torque,
            Quantity::Temperature => self.oil,
        }
    }
}
