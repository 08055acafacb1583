//! The vehicle: torque at the wheels for a speed profile, and regeneration.

use crate::codes;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{BatteryEntry, Demand};
use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::document::data::TableFile;

/// Standard gravity. \[m/s2\]
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Density of air at 20 degC and one atmosphere, as usual for road loads. \[kg/m3\]
const AIR_DENSITY: f64 = 1.2;

/// A vehicle. Its road load is stated by `coast_down`, or by `drag_area` and `rolling_resistance`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct VehicleEntry {
    /// Mass with load. [kg]
    #[schemars(range(min = 1.0, max = 1e6))]
    pub mass: f64,
    /// Road load from a coast-down test.
    pub coast_down: Option<CoastDownEntry>,
    /// Drag coefficient times frontal area. [m2]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub drag_area: Option<f64>,
    /// Rolling resistance per weight. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rolling_resistance: Option<f64>,
    /// Air density for `drag_area`; default: 1.2 kg/m3. [kg/m3]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub air_density: Option<f64>,
    /// Rolling radius of the driven wheels. [mm]
    #[schemars(range(min = 10.0, max = 5000.0))]
    pub tyre_radius: f64,
    /// Accelerated mass, including rotating parts, over the mass; default: 1.04, assumed: cars with one ratio have 1.03 to 1.05. Not with
    /// `inertia`. [-]
    #[schemars(range(min = 1.0, max = 3.0))]
    pub rotating_mass_factor: Option<f64>,
    /// Moments of inertia, from which the factor follows with the ratio of each gear.
    pub inertia: Option<InertiaEntry>,
    /// Regeneration while braking: `none`, or its limits.
    pub regeneration: RegenerationEntry,
    /// A fixed efficiency between port and wheels; default: the losses of the transmission are used. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub efficiency: Option<f64>,
    /// Battery: with it, cycles report consumption, recuperation and range.
    pub battery: Option<BatteryEntry>,
    /// Losses of the motor at the reference port, for gearboxes without a motor in a thermal network: CSV file, workbook or MDF file relative to the study, or an
    /// entry with `file`, `columns` and `units`; with `speed [rpm]`, `torque [Nm]`, and `efficiency [-]` or `loss [W]`. Needs `battery`.
    #[schemars(extend("x-refers-to" = "file"))]
    pub motor_map: Option<TableFile>,
}

/// Rotating mass factor of cars with one ratio, assumed. \[-\]
const ROTATING_MASS_FACTOR: f64 = 1.04;

/// Moments of inertia of rotating parts.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct InertiaEntry {
    /// Of all wheels together, with brakes and half shafts. [kg m2]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub wheels: f64,
    /// Of the rotor of the machine, at the reference port. [kg m2]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub rotor: f64,
    /// Of shafts of the gearbox with their gears, by name.
    #[serde(default)]
    pub shafts: Ordered<ShaftInertiaEntry>,
}

/// Moment of inertia of a shaft.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct ShaftInertiaEntry {
    /// With its gears, about its own axis. [kg m2]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub inertia: f64,
}

/// Coefficients of a coast-down test: force over the speed, a + b v + c v2.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct CoastDownEntry {
    /// Constant force. [N]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub a: f64,
    /// Force per speed. [N s/m]
    #[schemars(range(min = -1e5, max = 1e5))]
    pub b: f64,
    /// Force per square of the speed. [N s2/m2]
    #[schemars(range(min = -1e4, max = 1e4))]
    pub c: f64,
}

/// Regeneration while braking.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum RegenerationEntry {
    /// A word.
    Word(NoRegeneration),
    /// Limits up to which braking is regenerative.
    Limits(Regeneration),
}

/// No regeneration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NoRegeneration {
    /// All braking by the brakes.
    None,
}

/// Limits of regeneration at the port of the motor; the brakes supply the remainder.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
pub struct Regeneration {
    /// Maximum torque. [Nm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub torque: f64,
    /// Maximum power. [kW]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power: f64,
    /// Vehicle speed below which regeneration is reduced linearly to zero. The default is assumed. [m/s]
    #[serde(default = "fade_speed")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub fade_speed: f64,
}

fn fade_speed() -> f64 {
    2.0
}

impl Regeneration {
    /// Maximum braking torque at the port, min(T, P/w) min(1, v/v_fade), at a speed of the port \[rad/s\] and of the vehicle \[m/s\].
    /// \[Nm\]
    pub fn limit(&self, port_speed: f64, vehicle_speed: f64) -> f64 {
        let speed = port_speed.abs();
        let torque = if self.torque * speed > self.power {
            self.power / speed
        } else {
            self.torque
        };
        let fade = if vehicle_speed < self.fade_speed {
            vehicle_speed.max(0.0) / self.fade_speed
        } else {
            1.0
        };
        torque * fade
    }
}

/// Torque at the port for a torque at the wheels with a fixed efficiency, as a divisor in drive and a factor while braking. `ratio` is the
/// speed of the port over that of the wheels. \[Nm\]
pub fn input_torque(wheel_torque: f64, ratio: f64, efficiency: f64) -> f64 {
    if wheel_torque > 0.0 {
        wheel_torque / (ratio * efficiency)
    } else {
        wheel_torque * efficiency / ratio
    }
}

/// Force of the road on a vehicle that rolls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RoadLoad {
    /// a + b v + c v2, as measured on a level road.
    CoastDown(CoastDownEntry),
    /// Drag and rolling resistance.
    Resistance {
        /// Drag coefficient times frontal area. \[m2\]
        drag_area: f64,
        /// Rolling resistance per weight. \[-\]
        rolling_resistance: f64,
        /// \[kg/m3\]
        air_density: f64,
    },
}

/// A vehicle; SI.
#[derive(Debug, Clone)]
pub struct Vehicle {
    /// \[kg\]
    pub mass: f64,
    /// Force of the road.
    pub road_load: RoadLoad,
    /// \[m\]
    pub tyre_radius: f64,
    /// Accelerated mass over the mass without the parts of `inertia`. \[-\]
    pub rotating_mass_factor: f64,
    /// Moments of inertia of rotating parts, if stated.
    pub inertia: Option<InertiaEntry>,
    /// \[m/s2\]
    pub gravity: f64,
    /// Limits of regeneration; absent: none.
    pub regeneration: Option<Regeneration>,
    /// Fixed efficiency between port and wheels, if stated. \[-\]
    pub efficiency: Option<f64>,
}

impl VehicleEntry {
    /// The vehicle. `path` is that of the entry in its document.
    ///
    /// # Errors
    /// If no road load is stated, or two.
    pub fn vehicle(&self, path: &str) -> Result<Vehicle, Diagnostic> {
        let help = "state `coast_down`, or `drag_area` and `rolling_resistance`";
        let road_load = match (self.coast_down, self.drag_area, self.rolling_resistance) {
            (Some(coast_down), None, None) => {
                if self.air_density.is_some() {
                    let at = format!("{path}.air_density");
                    return Err(vehicle_error(at, "a coast-down test already includes the air density")
                        .help("delete `air_density`"));
                }
                RoadLoad::CoastDown(coast_down)
            }
            (None, Some(drag_area), Some(rolling_resistance)) => RoadLoad::Resistance {
                drag_area,
                rolling_resistance,
                air_density: self.air_density.unwrap_or(AIR_DENSITY),
            },
            (None, None, None) => return Err(vehicle_error(path, "no road load is stated").help(help)),
            (None, Some(_), None) => {
                return Err(vehicle_error(path, "`drag_area` needs `rolling_resistance`").help(help));
            }
            (None, None, Some(_)) => {
                return Err(vehicle_error(path, "`rolling_resistance` needs `drag_area`").help(help));
            }
            (Some(_), ..) => return Err(vehicle_error(path, "the road load is stated twice").help(help)),
        };
        Ok(Vehicle {
            mass: self.mass,
            road_load,
            tyre_radius: self.tyre_radius,
            rotating_mass_factor: match (&self.inertia, self.rotating_mass_factor) {
                (Some(_), Some(_)) => {
                    let at = format!("{path}.rotating_mass_factor");
                    let message = "both `rotating_mass_factor` and `inertia` are stated";
                    return Err(vehicle_error(at, message).help("delete one of them"));
                }
                (Some(_), None) => 1.0,
                (None, factor) => factor.unwrap_or(ROTATING_MASS_FACTOR),
            },
            inertia: self.inertia.clone(),
            gravity: STANDARD_GRAVITY,
            regeneration: match self.regeneration {
                RegenerationEntry::Word(NoRegeneration::None) => None,
                RegenerationEntry::Limits(limits) => Some(limits),
            },
            efficiency: self.efficiency,
        })
    }
}

impl Vehicle {
    /// Force of air and tyres at a speed \[m/s\] on a road that rises by `grade` over its run; none at standstill. \[N\]
    pub fn road_load(&self, speed: f64, grade: f64) -> f64 {
        if speed <= 0.0 {
            return 0.0;
        }
        match self.road_load {
            RoadLoad::CoastDown(CoastDownEntry { a, b, c }) => a + speed * (b + c * speed),
            RoadLoad::Resistance {
                drag_area,
                rolling_resistance,
                air_density,
            } => {
                let cosine = 1.0 / grade.hypot(1.0);
                self.mass * self.gravity * rolling_resistance * cosine + 0.5 * air_density * drag_area * speed * speed
            }
        }
    }

    /// Force at the driven wheels: inertia, air and tyres, and the slope. Acceleration in m/s2. \[N\]
    pub fn force(&self, speed: f64, acceleration: f64, grade: f64) -> f64 {
        let sine = grade / grade.hypot(1.0);
        self.mass * (self.rotating_mass_factor * acceleration + self.gravity * sine) + self.road_load(speed, grade)
    }

    /// Speed of the wheels at a speed of the vehicle \[m/s\], without slip. \[rad/s\]
    pub fn wheel_speed(&self, speed: f64) -> f64 {
        speed / self.tyre_radius
    }

    /// Demand at the driven wheels; none at standstill, where brakes hold the vehicle.
    pub fn demand(&self, speed: f64, acceleration: f64, grade: f64) -> Demand {
        if speed <= 0.0 {
            return Demand::Rest;
        }
        Demand::Wheel {
            torque: self.force(speed, acceleration, grade) * self.tyre_radius,
            speed: self.wheel_speed(speed),
            acceleration,
        }
    }

    /// The rotating mass factor k = 1 + (J_wheels + J_rotor i2 + sum J_shaft i_shaft2) / (m r2), where i is a speed over that of the wheels:
    /// of the rotor, and of a shaft by its name. The fixed one without moments of inertia. \[-\]
    ///
    /// Source: kinetic energy of translation and rotation at the same acceleration of the vehicle, wheels without slip.
    pub fn mass_factor(&self, rotor: f64, shaft: impl Fn(&str) -> f64) -> f64 {
        let Some(inertia) = &self.inertia else {
            return self.rotating_mass_factor;
        };
        let shafts = inertia
            .shafts
            .iter()
            .map(|(name, part)| part.inertia * shaft(name).powi(2));
        let at_wheels = inertia.wheels + inertia.rotor * rotor * rotor + shafts.sum::<f64>();
        1.0 + at_wheels / (self.mass * self.tyre_radius * self.tyre_radius)
    }

    /// Torque at the wheels that accelerates the parts of `inertia`, with the factor that they give. \[Nm\]
    pub fn inertia_torque(&self, mass_factor: f64, acceleration: f64) -> f64 {
        self.mass * (mass_factor - self.rotating_mass_factor) * acceleration * self.tyre_radius
    }

    /// Limits a braking torque at the port to regeneration; a driving torque is unchanged. Speeds of the port \[rad/s\] and of the vehicle
    /// \[m/s\]. \[Nm\]
    pub fn regained(&self, port_torque: f64, port_speed: f64, vehicle_speed: f64) -> f64 {
        if port_torque >= 0.0 {
            return port_torque;
        }
        let limit = self.regeneration.map_or(0.0, |r| r.limit(port_speed, vehicle_speed));
        port_torque.max(-limit)
    }
}

/// A finding about a vehicle.
fn vehicle_error(path: impl Into<String>, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(path, message).code(codes::DUTY)
}

#[cfg(test)]
mod tests;
