//! Axes of grids: one value, a list, or from, to and step.

use gearloss_framework::document::{Conversion, Unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Maximum number of values of one axis.
const MOST: usize = 100_000;

/// Why an axis has no values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AxisError {
    /// The step has the wrong sign or is zero.
    #[error("the step does not lead from `from` to `to`")]
    Step,
    /// The step is too small.
    #[error("the axis has more than {MOST} values")]
    TooMany,
    /// The gearbox has no rating.
    #[error("the axis uses fractions of a rating, but the gearbox has none")]
    NoRating,
}

/// From, to and step of an axis, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// First value.
    pub from: f64,
    /// Last value, reached within rounding.
    pub to: f64,
    /// Step.
    pub step: f64,
    /// The unit in which they are written.
    pub unit: Conversion,
}

const fn unit(symbol: &str) -> &'static Unit {
    match Unit::of_symbol(symbol) {
        Some(unit) => unit,
        None => Unit::ONE,
    }
}

impl Span {
    /// From, to and step in SI, written in a unit, or in that of the documentation.
    pub fn new([from, to, step]: [f64; 3], unit: Option<&str>, documented: &Unit) -> Self {
        let written = unit.and_then(|unit| Unit::read_as(unit, documented.dimension).ok());
        let unit = written.unwrap_or_else(|| documented.conversion());
        Self { from, to, step, unit }
    }

    /// The values: to the bit those that are read if each is written in the unit of `from`, `to` and `step`.
    ///
    /// # Errors
    /// If the step does not divide the range, or gives too many values.
    pub fn values(&self) -> Result<Vec<f64>, AxisError> {
        let count = (self.to - self.from) / self.step;
        if !count.is_finite() || count < 0.0 {
            return Err(AxisError::Step);
        }
        if count > MOST as f64 {
            return Err(AxisError::TooMany);
        }
        let count = (count * (1.0 + 1e-12) + 1e-9).floor() as usize;
        let difference = Conversion {
            offset: 0.0,
            ..self.unit
        };
        let decimal = |unit: Conversion, si| unit.written(si).and_then(Decimal::new);
        let written = decimal(self.unit, self.from).zip(decimal(difference, self.step));
        let value = |i: usize| match written {
            Some((from, step)) => self.unit.to_si(Decimal::after(from, step, i)),
            None => self.from + i as f64 * self.step,
        };
        Ok((0..=count).map(value).collect())
    }
}

/// A number as a whole number and its decimals.
#[derive(Debug, Clone, Copy)]
struct Decimal {
    whole: i128,
    decimals: usize,
}

impl Decimal {
    /// `None` if it has so many decimals that whole numbers overflow.
    fn new(x: f64) -> Option<Self> {
        let text = format!("{x}");
        let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
        // Numbers of an axis are below 1e12 and have at most 13 digits.
        (fraction.len() <= 25).then_some(Self {
            whole: format!("{whole}{fraction}").parse().ok()?,
            decimals: fraction.len(),
        })
    }

    /// The value after some steps, as read if it is written.
    fn after(from: Self, step: Self, steps: usize) -> f64 {
        let decimals = from.decimals.max(step.decimals);
        let aligned = |number: Self| number.whole * 10_i128.pow((decimals - number.decimals) as u32);
        let value = aligned(from) + steps as i128 * aligned(step);
        format!("{value}e-{decimals}").parse().unwrap_or(f64::NAN)
    }
}

/// Fractions of a rating.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Shares {
    /// Several fractions. [-]
    List(#[schemars(inner(range(min = -10.0, max = 10.0)), length(min = 1))] Vec<f64>),
    /// Fractions at equal steps.
    Steps(ShareSpan),
}

/// Fractions at equal steps.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
pub struct ShareSpan {
    /// First fraction. [-]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub from: f64,
    /// Last fraction. [-]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub to: f64,
    /// Step. [-]
    #[schemars(range(min = -10.0, max = 10.0))]
    pub step: f64,
}

/// Values as fractions of the rating, to compare gearboxes of different size.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct OfRating {
    /// Fractions of the torque or speed under `rating` of the gearbox: a list, or from, to and step.
    pub of_rating: Shares,
}

impl OfRating {
    fn values(&self, rating: Option<f64>) -> Result<Vec<f64>, AxisError> {
        let rating = rating.ok_or(AxisError::NoRating)?;
        let shares = match &self.of_rating {
            Shares::List(list) => list.clone(),
            Shares::Steps(s) => Span::new([s.from, s.to, s.step], None, Unit::ONE).values()?,
        };
        Ok(shares.into_iter().map(|share| share * rating).collect())
    }
}

/// An axis of a quantity with its unit and the range of its values, and such values at equal steps; one with a `rating` also takes fractions of
/// it.
macro_rules! axis {
    (
        $Axis:ident, $Span:ident: $All:literal, $all:literal, $one:literal in $unit:literal, steps in $step:literal,
        $least:literal to $greatest:literal $(, $rating:ident: $fractions:literal)?
    ) => {
        #[doc = concat!($All, ".")]
        #[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
        #[serde(untagged)]
        pub enum $Axis {
            #[doc = concat!("One ", $one, ". [", $unit, "]")]
            One(#[schemars(range(min = $least, max = $greatest))] f64),
            #[doc = concat!("Several ", $all, ". [", $unit, "]")]
            List(#[schemars(inner(range(min = $least, max = $greatest)), length(min = 1))] Vec<f64>),
            #[doc = concat!($All, " at equal steps.")]
            Steps($Span),
            $(#[doc = $fractions]
            Rated(OfRating),)?
        }

        #[doc = concat!($All, " at equal steps.")]
        #[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
        pub struct $Span {
            #[doc = concat!("First ", $one, ". [", $unit, "]")]
            #[schemars(range(min = $least, max = $greatest))]
            pub from: f64,
            #[doc = concat!("Last ", $one, ". [", $unit, "]")]
            #[schemars(range(min = $least, max = $greatest))]
            pub to: f64,
            #[doc = concat!("Step. [", $step, "]")]
            #[schemars(range(min = $least, max = $greatest))]
            pub step: f64,
            /// The unit in which all three are written.
            #[serde(default, rename = "unit of steps", skip_serializing_if = "Option::is_none")]
            #[schemars(skip)]
            pub unit: Option<String>,
        }

        impl $Axis {
            /// The values, SI.
            ///
            /// # Errors
            /// As [`Span::values`], or if the axis uses fractions of a missing rating.
            pub fn values(&self $(, $rating: Option<f64>)?) -> Result<Vec<f64>, AxisError> {
                match self {
                    Self::One(value) => Ok(vec![*value]),
                    Self::List(list) => Ok(list.clone()),
                    Self::Steps(s) => Span::new([s.from, s.to, s.step], s.unit.as_deref(), unit($unit)).values(),
                    $(Self::Rated(shares) => shares.values($rating),)?
                }
            }
        }
    };
}

axis! {
    TorqueAxis, TorqueSpan: "Torques", "torques", "torque" in "Nm", steps in "Nm", -1e9 to 1e9,
    rating: "Torques as fractions of the rated torque."
}
axis! {
    SpeedAxis, SpeedSpan: "Speeds", "speeds", "speed" in "rpm", steps in "rpm", -1e6 to 1e6,
    rating: "Speeds as fractions of the rated speed."
}
axis! { PowerAxis, PowerSpan: "Powers", "powers", "power" in "W", steps in "W", -1e9 to 1e9 }
axis! {
    TemperatureAxis, TemperatureSpan: "Temperatures", "temperatures", "temperature" in "degC", steps in "K", -60.0 to 250.0
}

/// Maximum torque over speed: points outside are omitted.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
pub struct Envelope {
    /// Speeds, ascending from zero; signs are ignored. [rpm]
    #[schemars(inner(range(min = 0.0, max = 1e6)), length(min = 2))]
    pub speed: Vec<f64>,
    /// Maximum torque at each speed, linear in between; signs are ignored. [Nm]
    #[schemars(inner(range(min = 0.0, max = 1e9)), length(min = 2))]
    pub torque: Vec<f64>,
}

impl Envelope {
    /// Checks the envelope.
    ///
    /// # Errors
    /// If the lists differ in length or speeds are not ascending.
    pub(crate) fn check(&self) -> Result<(), String> {
        if self.speed.len() != self.torque.len() {
            return Err(format!(
                "an envelope needs equal numbers of speeds and torques, not {} and {}",
                self.speed.len(),
                self.torque.len()
            ));
        }
        if self.speed.first().is_some_and(|first| *first > 0.0) {
            return Err("the envelope does not start at 0 rpm".to_owned());
        }
        if self.speed.windows(2).all(|w| w[0] < w[1]) {
            Ok(())
        } else {
            Err("the speeds of the envelope are not ascending".to_owned())
        }
    }

    /// True for a point inside the envelope; torque in Nm, speed in rad/s.
    pub fn holds(&self, torque: f64, speed: f64) -> bool {
        let speed = speed.abs();
        // Speeds that are stated in different units may differ in their last digits.
        let near = 1e-9 * self.speed.last().copied().unwrap_or(0.0);
        let right = self.speed.iter().position(|s| speed <= s + near);
        let most = match right {
            None => return false,
            Some(0) => self.torque[0],
            Some(i) => {
                let share = (speed - self.speed[i - 1]) / (self.speed[i] - self.speed[i - 1]);
                self.torque[i - 1] + share.min(1.0) * (self.torque[i] - self.torque[i - 1])
            }
        };
        torque.abs() <= most * (1.0 + 1e-9)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::document::parse_quantity;

    #[test]
    fn steps_reach_both_ends() {
        let rpm = std::f64::consts::PI / 30.0;
        let span = Span::new([1000.0 * rpm, 22000.0 * rpm, 1000.0 * rpm], None, unit("rpm"));
        assert_eq!(span.values().unwrap().len(), 22);
        let values = |numbers: [f64; 3]| Span::new(numbers, None, unit("Nm")).values().unwrap();
        assert_eq!(values([3.0, 3.0, 1.0]), [3.0]);
        assert_eq!(values([3.0, 1.0, -1.0]), [3.0, 2.0, 1.0]);
    }

    #[test]
    fn values_are_those_of_the_written_numbers_to_the_bit() {
        for (symbol, documented, [from, to, step]) in [
            ("rpm", "rpm", [0.0, 12000.0, 500.0]),
            ("U/min", "rpm", [1000.0, 22000.0, 1000.0]),
            ("rad/s", "rpm", [0.1, 0.9, 0.1]),
            ("Hz", "rpm", [-2.0, 5.0, 0.125]),
            ("Nm", "Nm", [0.0, 1.0, 0.1]),
            ("N mm", "Nm", [12.5, 900.0, 12.5]),
            ("lbf ft", "Nm", [-60.0, 60.0, 20.0]),
            ("kW", "W", [0.3, 3.0, 0.3]),
            ("degC", "degC", [-10.0, 90.0, 0.7]),
            ("degF", "degC", [140.0, 212.0, 9.0]),
        ] {
            let documented = unit(documented);
            let si = |number: f64| parse_quantity(&format!("{number} {symbol}"), documented).unwrap();
            let difference = si(step) - si(0.0);
            let span = Span::new([si(from), si(to), difference], Some(symbol), documented);
            for (i, value) in span.values().unwrap().iter().enumerate() {
                let text = format!("{:.3} {symbol}", from + i as f64 * step);
                let written = parse_quantity(&text, documented).unwrap();
                assert_eq!(value.to_bits(), written.to_bits(), "{text}: {value} {written}");
            }
        }
    }

    #[test]
    fn a_step_that_leads_nowhere_is_refused() {
        for numbers in [[1.0, 2.0, 0.0], [1.0, 2.0, -1.0], [0.0, 1.0, 1e-9]] {
            assert!(Span::new(numbers, None, unit("Nm")).values().is_err());
        }
    }

    #[test]
    fn an_envelope_holds_what_is_below_it() {
        let envelope = Envelope {
            speed: vec![0.0, 100.0, 300.0],
            torque: vec![20.0, 20.0, 10.0],
        };
        assert!(envelope.check().is_ok());
        for (torque, speed, held) in [
            (20.0, 50.0, true),
            (-20.0, 100.0, true),
            (15.0, 200.0, true),
            (15.1, 200.0, false),
            (10.0, -300.0, true),
            (1.0, 301.0, false),
        ] {
            assert_eq!(envelope.holds(torque, speed), held, "{torque} {speed}");
        }
        let falling = Envelope {
            speed: vec![100.0, 100.0],
            torque: vec![20.0, 20.0],
        };
        assert!(falling.check().is_err());
    }

    #[test]
    fn shares_of_a_rating_need_one() {
        let axis = TorqueAxis::Rated(OfRating {
            of_rating: Shares::List(vec![0.5, 1.0]),
        });
        assert_eq!(axis.values(Some(20.0)).unwrap(), [10.0, 20.0]);
        assert_eq!(axis.values(None), Err(AxisError::NoRating));
    }
}
