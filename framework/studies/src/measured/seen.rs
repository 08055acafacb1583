//! Measured values at a point, from the available columns.

use super::{Instruments, Measured, Powers, Rig, Row};
use crate::points::PointResult;
use crate::study::{Difference, Quantity};

/// Measured values from the available columns, without the contribution of the rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Output power over input power. \[-\]
    pub efficiency: Option<f64>,
    /// \[W\]
    pub loss: Option<f64>,
    /// \[Nm\]
    pub loss_torque: Option<f64>,
    /// \[degC\]
    pub oil: Option<f64>,
    /// Power at the port with given torque: positive if it enters. \[W\]
    here: f64,
    /// Speed of the reference port. \[rad/s\]
    reference: f64,
    /// Standard deviations of efficiency, loss, loss torque and temperature, if columns state them.
    accuracies: [Option<f64>; 4],
    /// The instruments and the calculated point, if columns do not state them.
    instruments: Option<(Instruments, Powers)>,
    /// Calculated efficiency and loss torque.
    calculated: [Option<f64>; 2],
}

impl Seen {
    /// Torque and speed are at the ports of the conditions, `out` columns at the other port. The speeds of the ports, which depend only on
    /// the gear, and with them the contribution of the rig, are from the solved point.
    pub fn without_rig(measured: &Measured, row: &Row, point: &PointResult) -> Self {
        Self::with_rig(&measured.rig, measured, row, point)
    }

    /// As [`Seen::without_rig`], with the contribution of another rig. The point was solved with the corrected torque.
    pub fn with_rig(rig: &Rig, measured: &Measured, row: &Row, point: &PointResult) -> Self {
        let value = |quantity: &str| measured.value(row, quantity);
        let shown = value("torque").map_or(0.0, |t| measured.applied_torque(t, point)) * point.torque_speed;
        let here = if rig.is_silent() {
            shown
        } else {
            point.torque * point.torque_speed
        };
        let added = rig.power([point.reference_speed, point.output_speed.unwrap_or(0.0)]);
        let reference = point.reference_speed.abs();
        // A torque given at the other port is not a second one.
        let torque_there = value("torque_out").filter(|_| !measured.torque_at_other_port);
        let there = torque_there.zip(value("speed_out")).map(|(t, w)| (t * w).abs());
        // Without its column the speed there follows from the gear.
        let speed_there = if point.at_reference {
            point.output_speed
        } else {
            Some(point.reference_speed)
        };
        let by_ratio = torque_there.zip(speed_there).map(|(t, w)| (t * w).abs());
        // Each quantity is read from its own column first, because other columns may be rounded or inconsistent.
        let of_efficiency = value("efficiency").and_then(|eta| {
            if shown > 0.0 {
                Some(shown * (1.0 - eta))
            } else {
                (eta > 0.0).then(|| -shown * (1.0 / eta - 1.0))
            }
        });
        let of_torque = value("loss_torque").map(|t| t * reference);
        let measured_loss = value("loss");
        // Rigs write the torque of the brake with either sign; the sign here shows where power enters. Noise may make the difference
        // negative.
        let lost = |there: f64| if shown > 0.0 { shown - there } else { there + shown };
        let left = |loss: Option<f64>| loss.map(|loss| loss - added);
        let of_ports = there.map(lost);
        let loss = left(
            measured_loss
                .or(of_torque)
                .or(of_ports)
                .or(of_efficiency)
                .or(by_ratio.map(lost)),
        );
        let efficiency = if rig.is_silent() { value("efficiency") } else { None }.or_else(|| {
            let loss = left(of_efficiency).or(loss)?;
            if here > 0.0 {
                Some((here - loss) / here)
            } else {
                (here < 0.0).then(|| -here / (loss - here))
            }
        });
        let loss_torque = left(of_torque).or(loss).map(|loss| loss / reference);
        // The stated accuracy, and the standard error of the mean of a steady interval.
        let accuracy = |quantity: &str, reading: Option<f64>| {
            let stated = measured.stated_accuracy(row, quantity, reading)? / measured.divisor;
            Some(stated.hypot(measured.standard_error(row, quantity).unwrap_or(0.0)))
        };
        Self {
            efficiency: efficiency.filter(|eta| eta.is_finite()),
            loss,
            loss_torque: loss_torque.filter(|t| t.is_finite()),
            oil: value("oil_temperature"),
            here,
            reference,
            accuracies: [
                accuracy("efficiency", point.efficiency.or(efficiency)),
                accuracy("loss", point.loss.or(loss)),
                accuracy("loss_torque", point.loss_torque.or(loss_torque)),
                accuracy("oil_temperature", value("oil_temperature")).or(measured.oil_temperature),
            ],
            instruments: measured.instruments.zip(powers(point)),
            calculated: [point.efficiency, point.loss_torque],
        }
    }

    /// One of them.
    pub fn quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Efficiency => self.efficiency,
            Quantity::Loss => self.loss,
            Quantity::LossTorque => self.loss_torque,
            Quantity::Temperature => self.oil,
            // Quantities of the drive unit are not measured.
            Quantity::DcPower | Quantity::UnitLoss | Quantity::SystemEfficiency => None,
        }
    }

    /// Change of loss for a change of efficiency by one: the input power if it enters here, otherwise its square over the output power.
    /// \[W\]
    fn watts_per_efficiency(&self) -> Option<f64> {
        if self.here > 0.0 {
            return Some(self.here);
        }
        let input = self.loss? - self.here;
        (self.here < 0.0).then(|| input * input / -self.here)
    }

    /// Standard deviation of a quantity: from its own column, from that of another one, or from the instruments and the calculated point.
    /// The reading is not used, because low readings would get more weight.
    pub fn accuracy(&self, quantity: Quantity) -> Option<f64> {
        let [efficiency, loss, loss_torque, temperature] = self.accuracies;
        let watts = loss
            .or_else(|| Some(loss_torque? * self.reference))
            .or_else(|| Some(efficiency? * self.watts_per_efficiency()?));
        let found = match quantity {
            Quantity::Efficiency => efficiency.or_else(|| Some(watts? / self.watts_per_efficiency()?)),
            Quantity::Loss => watts,
            Quantity::LossTorque => loss_torque.or_else(|| Some(watts? / self.reference)),
            Quantity::Temperature => temperature,
            Quantity::DcPower | Quantity::UnitLoss | Quantity::SystemEfficiency => None,
        };
        found
            .or_else(|| self.of_instruments(quantity))
            .filter(|a| a.is_finite())
    }

    fn of_instruments(&self, quantity: Quantity) -> Option<f64> {
        let (instruments, at) = self.instruments.as_ref()?;
        match quantity {
            Quantity::Efficiency => Some(instruments.efficiency(at, self.calculated[0]?)),
            Quantity::Loss => Some(instruments.loss(at)),
            Quantity::LossTorque => Some(instruments.loss_torque(at, self.calculated[1]?)),
            Quantity::Temperature | Quantity::DcPower | Quantity::UnitLoss | Quantity::SystemEfficiency => None,
        }
    }

    /// Whether the efficiency is meaningless, because the input torque is below three of its standard deviations.
    pub fn is_drowned(&self) -> bool {
        match (&self.instruments, self.accuracies[0]) {
            (_, Some(accuracy)) => self.efficiency.is_some_and(|eta| 3.0 * accuracy > eta.abs()),
            (Some((instruments, at)), None) => instruments.drowns(at),
            (None, None) => false,
        }
    }
}

/// The calculated point as measured by the instruments; absent if it has no loss or more than two ports.
fn powers(point: &PointResult) -> Option<Powers> {
    let speed = [point.reference_speed.abs(), point.output_speed?.abs()];
    let here = point.torque * point.torque_speed;
    let there = point.loss? - here;
    // The port of the given torque: the one with this power.
    let [input, output] = if point.at_reference {
        [here, there]
    } else {
        [there, here]
    };
    Some(Powers {
        torque: [(input / speed[0]).abs(), (output / speed[1]).abs()],
        speed,
        driven: usize::from(output > input),
    })
}

/// Accuracy of a measured quantity in the unit of its difference: fractions in percentage points.
pub fn counted(quantity: Quantity, difference: Difference, accuracy: f64, measured: Option<f64>) -> Option<f64> {
    match quantity {
        _ if difference == Difference::Percent => measured.filter(|m| *m != 0.0).map(|m| 100.0 * accuracy / m),
        Quantity::Efficiency => Some(100.0 * accuracy),
        _ => Some(accuracy),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use serde_json::json;

    use super::*;
    use crate::measured::MeasuredEntry;
    use gearloss_framework::flow::Status;

    /// A point with given torque at a port that turns at 10 rad/s while the reference port turns at 100 rad/s.
    fn seen(text: &str) -> Seen {
        on(text, 0.0)
    }

    /// The same with an offset of the meter at `in`.
    fn on(text: &str, offset: f64) -> Seen {
        let entry: MeasuredEntry =
            serde_json::from_value(json!({ "file": "rig.csv", "stated_as": "standard" })).unwrap();
        let measured = entry.read(text.as_bytes(), &[]).unwrap();
        let point = PointResult {
            torque: measured.value(&measured.rows[0], "torque").unwrap(),
            speed: 100.0,
            torque_speed: 10.0,
            reference_speed: 100.0,
            output_speed: Some(10.0),
            at_reference: false,
            nodes: Vec::new(),
            oil: None,
            surface: None,
            balance: None,
            status: Status::Standstill,
            efficiency: None,
            loss: None,
            loss_torque: None,
            input: None,
            output: None,
            sums: [0.0; 6],
            parts: Vec::new(),
            terms: Vec::new(),
            machines: Vec::new(),
            outside: false,
            limits: Vec::new(),
            beyond: false,
            undefined: None,
            passes: 0,
        };
        let rig = Rig {
            offset: [offset, 0.0],
            ..Rig::default()
        };
        Seen::with_rig(&rig, &measured, &measured.rows[0], &point)
    }

    #[test]
    fn power_counts_at_the_port_of_the_torque() {
        // 100 Nm at 10 rad/s brake the output: 1000 W come out at 95 %.
        let coast = seen("torque [Nm],speed [rpm],efficiency [%],efficiency_accuracy [%]\n-100,955,95,0.5\n");
        assert!((coast.loss.unwrap() - 1000.0 * (1.0 / 0.95 - 1.0)).abs() < 1e-9);
        assert!((coast.loss_torque.unwrap() - coast.loss.unwrap() / 100.0).abs() < 1e-12);
        // P_in = 1000 / eta, so dP = 1000 / eta^2 d eta.
        assert!((coast.accuracy(Quantity::Loss).unwrap() - 0.005 * 1000.0 / (0.95 * 0.95)).abs() < 1e-9);
        let drive = seen("torque [Nm],speed [rpm],loss [W],loss_accuracy [W]\n100,955,50,5\n");
        assert!((drive.efficiency.unwrap() - 0.95).abs() < 1e-12);
        assert!((drive.accuracy(Quantity::Efficiency).unwrap() - 0.005).abs() < 1e-12);
    }

    #[test]
    fn a_rig_that_adds_next_to_nothing_changes_next_to_nothing() {
        let text = "torque [Nm],speed [rpm],efficiency [%],loss [W],loss_torque [Nm]\n100,955,95,60,0.7\n";
        let (silent, touched) = (seen(text), on(text, 1e-12));
        for quantity in [Quantity::Efficiency, Quantity::Loss, Quantity::LossTorque] {
            let [a, b] = [&silent, &touched].map(|s| s.quantity(quantity).unwrap());
            assert!((a - b).abs() < 1e-9 * a.abs(), "{quantity:?} {a} {b}");
        }
    }

    #[test]
    fn a_loss_below_zero_keeps_its_sign() {
        let noisy = seen("torque [Nm],speed [rpm],torque_out [Nm],speed_out [rad/s]\n100,955,1010,1\n");
        assert!((noisy.loss.unwrap() + 10.0).abs() < 1e-9);
        let coast = seen("torque [Nm],speed [rpm],torque_out [Nm],speed_out [rad/s]\n-100,955,1040,1\n");
        assert!((coast.loss.unwrap() - 40.0).abs() < 1e-9);
    }
}
