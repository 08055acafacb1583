//! Cycles: driving cycles, recorded load series, load spectra, and the vehicle.
//!
//! A cycle is converted into a list of intervals. Each states the demand at a port of the transmission or at the wheels; the response of
//! the transmission and its temperature are computed elsewhere.

mod battery;
mod cycle;
mod shift_map;
mod spectrum;
mod trace;
mod vehicle;

pub use battery::{Battery, BatteryEntry, Consumption, ConsumptionColumn, distance};
pub use cycle::{CycleEntry, Duty, FileCycleEntry, PhaseEntry, ShippedCycleEntry, SpectrumCycleEntry};
pub use shift_map::ShiftMap;
pub(crate) use spectrum::points;
pub use spectrum::{Spectrum, SpectrumFile, SpectrumPoint};
pub use trace::{Sample, Trace};
pub use vehicle::{
    CoastDownEntry, InertiaEntry, NoRegeneration, Regeneration, RegenerationEntry, RoadLoad, STANDARD_GRAVITY,
    ShaftInertiaEntry, Vehicle, VehicleEntry, input_torque,
};

/// Demand on the transmission over an interval; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Demand {
    /// Torque and speed at a port, as recorded.
    Port {
        /// \[Nm\]
        torque: f64,
        /// \[rad/s\]
        speed: f64,
    },
    /// Demanded torque at the wheels, negative while braking and before any limit of regeneration, and their speed.
    Wheel {
        /// Of all driven wheels together, without the parts of `inertia` of the vehicle. \[Nm\]
        torque: f64,
        /// \[rad/s\]
        speed: f64,
        /// Acceleration of the vehicle. \[m/s2\]
        acceleration: f64,
    },
    /// Standstill without load.
    Rest,
}

/// Known boundary conditions in addition to the demand.
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
    /// Inlet temperature of the coolant. \[degC\]
    pub coolant_temperature: Option<f64>,
    /// Air temperature. \[degC\]
    pub ambient: Option<f64>,
    /// Gear state.
    pub gear: Option<String>,
}

/// An interval of time with constant demand.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Time at its start. \[s\]
    pub start: f64,
    /// \[s\]
    pub duration: f64,
    /// Demand on the transmission.
    pub demand: Demand,
    /// Inclination of the apparent vertical by the grade of the road and the acceleration; positive as uphill. \[rad\]
    pub inclination: f64,
    /// Boundary conditions.
    pub given: Given,
}

#[cfg(test)]
mod tests;
