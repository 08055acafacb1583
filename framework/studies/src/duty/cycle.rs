//! The entry of a cycle: a shipped cycle, a file, or a load spectrum.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Interval, Spectrum, Trace, Vehicle};
use crate::measured::{MeasuredFault, TableForm, fault};
use gearloss_framework::description::Ordered;
use gearloss_framework::document::did_you_mean;
use gearloss_framework::registry::Registry;

/// A shipped cycle, a recorded file, or a load spectrum.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CycleEntry {
    /// A shipped cycle by name.
    Shipped(ShippedCycleEntry),
    /// A file of a vehicle's speed, or of torque and speed at a port, over time.
    File(Box<FileCycleEntry>),
    /// Load cases with their shares of the time.
    Spectrum(SpectrumCycleEntry),
}

/// A shipped cycle by name.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ShippedCycleEntry {
    /// Name of the cycle, such as `wltc_class3b`.
    #[schemars(extend("x-refers-to" = "shipped_cycle"))]
    pub shipped: String,
    /// Number of repetitions. [-]
    #[serde(default = "one_time")]
    #[schemars(range(min = 1, max = 1000))]
    pub repeat: u32,
    /// Rows before this time are omitted. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub start: Option<f64>,
    /// Rows after this time are omitted. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub end: Option<f64>,
}

/// A file of a vehicle's speed, or of torque and speed at a port, over time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct FileCycleEntry {
    /// CSV file, workbook (.xlsx) or MDF file (.mf4), relative to the study.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Note for the report: origin of these data, or that they are synthetic.
    pub about: Option<String>,
    /// Column of each quantity, unless it has the name of the quantity: `torque: T_in`. Quantities: `time`, `vehicle_speed`, `grade` (rise
    /// over run), `torque` and `speed` at the port, `oil_flow`, `oil_temperature`, `coolant_flow`, `coolant_temperature`, `ambient`,
    /// `gear`; instead of `time` `distance`, which must be stated here, and `stop`.
    #[serde(default)]
    pub columns: Ordered<String>,
    /// Columns of measured temperatures by node of the thermal network.
    #[serde(default)]
    pub temperatures: Ordered<String>,
    /// Unit of each quantity or node, unless the header or a row of units states it: `vehicle_speed: km/h`.
    #[serde(default)]
    pub units: Ordered<String>,
    /// `units` have precedence where the file states different ones; otherwise that is an error.
    #[serde(default)]
    pub units_override: bool,
    /// Port at which torque and speed were recorded.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// How the file is written.
    #[serde(flatten)]
    pub form: TableForm,
    /// Phases of the cycle by name, in order, for comparisons.
    #[serde(default)]
    pub phases: Ordered<PhaseEntry>,
    /// Number of repetitions. [-]
    #[serde(default = "one_time")]
    #[schemars(range(min = 1, max = 1000))]
    pub repeat: u32,
    /// Rows before this time are omitted. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub start: Option<f64>,
    /// Rows after this time are omitted. [s]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub end: Option<f64>,
    /// Maximum step between rows; longer steps are gaps. Default: five times the median step. [s]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub gap: Option<f64>,
    /// Acceleration towards a target speed of a cycle over distance. [m/s2]
    #[serde(default = "driver")]
    #[schemars(range(min = 0.05, max = 12.0))]
    pub acceleration: f64,
    /// Deceleration towards a target speed or a stop of a cycle over distance. [m/s2]
    #[serde(default = "driver")]
    #[schemars(range(min = 0.05, max = 12.0))]
    pub deceleration: f64,
    /// Maximum plausible acceleration of the vehicle. [m/s2]
    #[serde(default = "most_acceleration")]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub most_acceleration: f64,
    /// Maximum plausible rate of change of the port speed; default: unlimited. [rpm/s]
    #[schemars(range(min = 1.0, max = 1e9))]
    pub most_speed_change: Option<f64>,
}

/// A phase of a cycle.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct PhaseEntry {
    /// Its end after the start of the cycle. [s]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub end: f64,
}

/// Load cases with their shares of the time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct SpectrumCycleEntry {
    /// The loads: a list, or a file.
    pub spectrum: Spectrum,
    /// Port of torque and speed.
    #[serde(default = "input")]
    #[schemars(extend("x-refers-to" = "ports"))]
    pub port: String,
    /// Total time for `share`; not used with `time`. [s]
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
// Assumed: a tyre on dry road allows about one g; larger values are recording errors.
pub(super) fn most_acceleration() -> f64 {
    12.0
}
// Assumed: the acceleration curves of VECTO begin at about 1 m/s2 and brake with 1 m/s2 or less.
pub(super) fn driver() -> f64 {
    1.0
}
pub(super) fn hour() -> f64 {
    3600.0
}

/// A cycle as read.
#[derive(Debug, Clone, PartialEq)]
pub enum Duty {
    /// A series over time.
    Trace(Trace),
    /// Load cases with their times, in the order of the list, which is not an order in time.
    Spectrum(Vec<Interval>),
}

impl CycleEntry {
    /// Reads the cycle. `bytes` reads a file relative to the study.
    ///
    /// # Errors
    /// An unknown cycle, an unreadable file, or errors in a file with their lines.
    pub fn read(
        &self,
        registry: &Registry,
        bytes: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<Duty, Vec<MeasuredFault>> {
        let bytes =
            |file: &str| bytes(file).map_err(|reason| vec![fault(reason, "file names are relative to the study")]);
        match self {
            Self::Shipped(entry) => entry.read(registry).map(Duty::Trace),
            Self::File(entry) => {
                entry.check_phases()?;
                let trace = Trace::read(entry, &bytes(&entry.file)?)?;
                entry.check_last_phase(trace.duration())?;
                Ok(Duty::Trace(trace))
            }
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

    /// Note on the file; absent if there is none.
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

    /// Names of its phases with the time from the start of the cycle at which each ends. A repeated or shortened cycle, and a spectrum, have
    /// none. \[s\]
    pub fn phases(&self, registry: &Registry) -> Vec<(String, f64)> {
        match self {
            Self::Shipped(entry) if entry.repeat == 1 && entry.start.is_none() && entry.end.is_none() => {
                let phases = registry.cycle(&entry.shipped).map_or(&[][..], |cycle| cycle.phases);
                phases.iter().map(|(name, end)| ((*name).to_owned(), *end)).collect()
            }
            Self::File(entry) => entry
                .phases
                .iter()
                .map(|(name, phase)| (name.to_owned(), phase.end))
                .collect(),
            Self::Shipped(_) | Self::Spectrum(_) => Vec::new(),
        }
    }

    /// Port of recorded torques and speeds; absent for a shipped cycle.
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
            return Err(vec![fault(format!("there is no cycle `{}`", self.shipped), help)]);
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
    /// Phases of a cycle that is used once and as a whole, each ending after the one before.
    fn check_phases(&self) -> Result<(), Vec<MeasuredFault>> {
        if self.phases.iter().next().is_none() {
            return Ok(());
        }
        if self.repeat > 1 || self.start.is_some() || self.end.is_some() {
            let help = "delete `phases`, or `repeat`, `start` and `end`";
            return Err(vec![fault(
                "a repeated or shortened cycle has no phases".to_owned(),
                help,
            )]);
        }
        let mut before = 0.0;
        for (name, phase) in self.phases.iter() {
            if phase.end <= before {
                let message = format!("the phase `{name}` ends at {} s, not after {before} s", phase.end);
                return Err(vec![fault(
                    message,
                    "write the phases in their order, each with its end",
                )]);
            }
            before = phase.end;
        }
        Ok(())
    }

    /// Phases within the time of the file.
    fn check_last_phase(&self, duration: f64) -> Result<(), Vec<MeasuredFault>> {
        // Times of a recording that does not begin at zero are differences.
        let longest = duration * (1.0 + 1e-9);
        match self.phases.iter().last().filter(|(_, phase)| phase.end > longest) {
            None => Ok(()),
            Some((name, phase)) => Err(vec![fault(
                format!(
                    "the phase `{name}` ends at {} s, after the cycle, which lasts {duration} s",
                    phase.end
                ),
                "count the time of phases from the first row of the file",
            )]),
        }
    }

    /// An entry with only a file.
    pub fn named(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            about: None,
            columns: Ordered::default(),
            temperatures: Ordered::default(),
            units: Ordered::default(),
            units_override: false,
            port: input(),
            form: TableForm::default(),
            phases: Ordered::default(),
            repeat: one_time(),
            start: None,
            end: None,
            gap: None,
            acceleration: driver(),
            deceleration: driver(),
            most_acceleration: most_acceleration(),
            most_speed_change: None,
        }
    }
}

impl Duty {
    /// The intervals of the cycle, including repetitions. A series of vehicle speed needs the vehicle.
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
