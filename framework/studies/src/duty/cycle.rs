//! A duty as a study writes it: a shipped cycle, a file, or a spectrum of loads.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Interval, Spectrum, Trace, Vehicle};
use crate::measured::{Decimal, Encoding, MeasuredFault, Separator, fault};
use gearloss_framework::description::Ordered;
use gearloss_framework::document::did_you_mean;
use gearloss_framework::registry::Registry;

/// A duty: a shipped cycle, a recorded file, or a spectrum of loads.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CycleEntry {
    /// A cycle that ships by name.
    Shipped(ShippedCycleEntry),
    /// A file of a vehicle's speed, or of torque and speed at a port, over time.
    File(Box<FileCycleEntry>),
    /// Loads with their shares of the time.
    Spectrum(SpectrumCycleEntry),
}

/// A cycle that ships by name.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ShippedCycleEntry {
    /// Name of the cycle, such as `wltc_class3b`.
    pub shipped: String,
    /// How often it is driven. [-]
    #[serde(default = "one_time")]
    #[schemars(range(min = 1, max = 1000))]
    pub repeat: u32,
    /// Rows before this time are left out. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub start: Option<f64>,
    /// Rows behind this time are left out. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub end: Option<f64>,
}

/// A file of a vehicle's speed, or of torque and speed at a port, over time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct FileCycleEntry {
    /// CSV file beside the study.
    pub file: String,
    /// What a reader of the report has to know of these data: where they come from, or that they are synthetic.
    pub about: Option<String>,
    /// Column of each quantity, where it is not named as the quantity: `torque: T_in`. Quantities: `time`, `vehicle_speed`,
    /// `grade` (rise over run), `torque` and `speed` at the port, `oil_flow`, `oil_temperature`, `coolant_flow`,
    /// `coolant_temperature`, `ambient`, `gear`.
    #[serde(default)]
    pub columns: Ordered<String>,
    /// Columns of measured temperatures by the node of the thermal network that they belong to.
    #[serde(default)]
    pub temperatures: Ordered<String>,
    /// Unit of each quantity or node, where neither the header nor a row of units states it: `vehicle_speed: km/h`.
    #[serde(default)]
    pub units: Ordered<String>,
    /// Port at which torque and speed were recorded.
    #[serde(default = "input")]
    pub port: String,
    /// What separates cells; absent, it is recognised.
    pub separator: Option<Separator>,
    /// Decimal sign; absent, it is recognised.
    pub decimal: Option<Decimal>,
    /// Encoding; absent, UTF-8, and Latin-1 where that fails.
    pub encoding: Option<Encoding>,
    /// How often the series is driven. [-]
    #[serde(default = "one_time")]
    #[schemars(range(min = 1, max = 1000))]
    pub repeat: u32,
    /// Rows before this time are left out. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub start: Option<f64>,
    /// Rows behind this time are left out. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub end: Option<f64>,
    /// The longest step between rows that is no gap; absent, five times the median step. [s]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub gap: Option<f64>,
    /// The greatest acceleration of the vehicle that is believed. [m/s2]
    #[serde(default = "most_acceleration")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub most_acceleration: f64,
    /// The fastest change of the port's speed that is believed; absent, any. [rpm/s]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub most_speed_change: Option<f64>,
}

/// Loads with their shares of the time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SpectrumCycleEntry {
    /// The loads: a list, or a file.
    pub spectrum: Spectrum,
    /// Port that torque and speed belong to.
    #[serde(default = "input")]
    pub port: String,
    /// Time that shares are of; times of loads stand for themselves. [s]
    #[serde(default = "hour")]
    #[schemars(range(min = 1e-3, max = 1e12))]
    pub duration: f64,
}

pub(super) fn one_time() -> u32 {
    1
}
pub(super) fn input() -> String {
    "input".to_owned()
}
// Assumed: a tyre on dry road carries about one g; what is beyond is a fault of the recording.
pub(super) fn most_acceleration() -> f64 {
    12.0
}
fn hour() -> f64 {
    3600.0
}

/// A duty as read.
#[derive(Debug, Clone, PartialEq)]
pub enum Duty {
    /// A series over time.
    Trace(Trace),
    /// Loads with their times, in the order of the list, which says nothing of the order on the road.
    Spectrum(Vec<Interval>),
}

impl CycleEntry {
    /// Reads the duty. `bytes` reads a file beside the study.
    ///
    /// # Errors
    /// An unknown cycle, an unreadable file, and what is wrong in a file, with its line.
    pub fn read(
        &self,
        registry: &Registry,
        bytes: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Duty, Vec<MeasuredFault>> {
        let bytes =
            |file: &str| bytes(file).map_err(|reason| vec![fault(reason, "name a file that stands beside the study")]);
        match self {
            Self::Shipped(entry) => entry.read(registry).map(Duty::Trace),
            Self::File(entry) => Trace::read(entry, &bytes(&entry.file)?).map(Duty::Trace),
            Self::Spectrum(entry) => {
                let intervals = match &entry.spectrum {
                    Spectrum::Loads(loads) => super::spectrum::intervals(loads, entry.duration),
                    Spectrum::File(file) => {
                        let loads = file.read(&bytes(&file.file)?)?;
                        super::spectrum::intervals(&loads, entry.duration)
                    }
                };
                intervals.map(Duty::Spectrum)
            }
        }
    }

    /// What a reader has to know of the file; absent where nothing is said.
    pub fn about(&self) -> Option<&str> {
        match self {
            Self::Shipped(_) => None,
            Self::File(entry) => entry.about.as_deref(),
            Self::Spectrum(entry) => match &entry.spectrum {
                Spectrum::Loads(_) => None,
                Spectrum::File(file) => file.about.as_deref(),
            },
        }
    }

    /// Port that recorded torques and speeds belong to; absent for a shipped cycle, which knows none.
    pub fn port(&self) -> Option<&str> {
        match self {
            Self::Shipped(_) => None,
            Self::File(entry) => Some(&entry.port),
            Self::Spectrum(entry) => Some(&entry.port),
        }
    }
}

impl ShippedCycleEntry {
    fn read(&self, registry: &Registry) -> Result<Trace, Vec<MeasuredFault>> {
        let Some(cycle) = registry.cycle(&self.shipped) else {
            let names: Vec<&str> = registry.cycles().iter().map(|c| c.name).collect();
            let help = match did_you_mean(&self.shipped, names.iter().copied()) {
                Some(close) => format!("write `{close}`"),
                None => format!("there are: {}", names.join(", ")),
            };
            return Err(vec![fault(format!("no cycle is called `{}`", self.shipped), help)]);
        };
        let entry = FileCycleEntry {
            columns: Ordered(vec![("vehicle_speed".to_owned(), "speed".to_owned())]),
            repeat: self.repeat,
            start: self.start,
            end: self.end,
            ..FileCycleEntry::named(cycle.name)
        };
        Trace::read(&entry, cycle.csv.as_bytes())
    }
}

impl FileCycleEntry {
    /// An entry that states the file alone.
    pub fn named(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            about: None,
            columns: Ordered::default(),
            temperatures: Ordered::default(),
            units: Ordered::default(),
            port: input(),
            separator: None,
            decimal: None,
            encoding: None,
            repeat: one_time(),
            start: None,
            end: None,
            gap: None,
            most_acceleration: most_acceleration(),
            most_speed_change: None,
        }
    }
}

impl Duty {
    /// The intervals of the duty, repeated as stated. A series of the vehicle's speed needs the vehicle.
    ///
    /// # Errors
    /// If the vehicle is missing.
    pub fn intervals(&self, vehicle: Option<&Vehicle>) -> Result<Vec<Interval>, MeasuredFault> {
        match self {
            Self::Trace(trace) => trace.intervals(vehicle),
            Self::Spectrum(intervals) => Ok(intervals.clone()),
        }
    }
}
