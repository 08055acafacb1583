//! Duties over time: driving cycles, recorded series of loads, load spectra, the vehicle between wheels and road, and the
//! losses of an electric motor.
//!
//! A duty becomes a list of intervals. Each says what is asked of the transmission, at one of its ports or at the wheels; how the
//! transmission answers, and how warm it gets, is not decided here.

mod cycle;
mod spectrum;
mod trace;
mod vehicle;

pub use cycle::{CycleEntry, Duty, FileCycleEntry, ShippedCycleEntry, SpectrumCycleEntry};
pub use spectrum::{Spectrum, SpectrumFile, SpectrumPoint};
pub use trace::{Sample, Trace};
pub use vehicle::{
    CoastDownEntry, NoRegeneration, Regeneration, RegenerationEntry, RoadLoad, STANDARD_GRAVITY, Vehicle, VehicleEntry,
    input_torque,
};

/// What is asked of the transmission over an interval; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Demand {
    /// Torque and speed at a port, as recorded.
    Port {
        /// \[Nm\]
        torque: f64,
        /// \[rad/s\]
        speed: f64,
    },
    /// Torque wanted at the wheels, negative while braking and before any limit of regeneration, and their speed. The
    /// transmission decides the rest.
    Wheel {
        /// Of all driven wheels together. \[Nm\]
        torque: f64,
        /// \[rad/s\]
        speed: f64,
    },
    /// Nothing turns and nothing is loaded.
    Rest,
}

/// What the surroundings and the driver give beside the demand, as far as it is known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Given {
    /// Speed of the vehicle. \[m/s\]
    pub vehicle_speed: Option<f64>,
    /// Mass flow of the oil. \[kg/s\]
    pub oil_flow: Option<f64>,
    /// Temperature of the oil. \[degC\]
    pub oil_temperature: Option<f64>,
    /// Mass flow of the coolant. \[kg/s\]
    pub coolant_flow: Option<f64>,
    /// Temperature of the coolant that comes in. \[degC\]
    pub coolant_temperature: Option<f64>,
    /// Temperature of the air. \[degC\]
    pub ambient: Option<f64>,
    /// Gear state.
    pub gear: Option<String>,
}

/// A stretch of time over which the duty counts as constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Time at its begin. \[s\]
    pub start: f64,
    /// \[s\]
    pub duration: f64,
    /// What is asked of the transmission.
    pub demand: Demand,
    /// What else is known.
    pub given: Given,
}

#[cfg(test)]
mod tests;
