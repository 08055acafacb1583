//! Variables of an FMU. The value reference of a variable is its place in the list; the first is the time.

/// Meaning of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// Time. \[s\]
    Time,
    /// Speed of the reference port. \[rad/s\]
    Speed,
    /// Torque at the reference port. \[Nm\]
    Torque,
    /// Temperature of the oil of a map. \[degC\]
    OilTemperature,
    /// Number of the gear, from one on.
    Gear,
    /// Loss over the speed of the reference port. \[Nm\]
    LossTorque,
    /// Loss. \[W\]
    LossPower,
    /// Output power over input power. \[-\]
    Efficiency,
    /// Torque that the other port delivers. \[Nm\]
    OutputTorque,
    /// Speed of the other port. \[rad/s\]
    OutputSpeed,
    /// A share of the loss. \[W\]
    Share(u32),
    /// Whether an input is beyond the tables.
    Outside,
    /// Ambient temperature. \[degC\]
    Ambient,
    /// Speed of the vehicle. \[m/s\]
    VehicleSpeed,
    /// Volume flow of the circulated oil. \[m3/s\]
    OilFlow,
    /// Mass flow of the coolant of a heat exchanger. \[kg/s\]
    CoolantFlow(u32),
    /// Inlet temperature of the coolant of a heat exchanger. \[degC\]
    CoolantTemperature(u32),
    /// Temperature of a node. \[degC\]
    Node(u32),
    /// Change of the temperature of a node over time. \[K/s\]
    Rate(u32),
    /// Heat through a heat exchanger. \[W\]
    ExchangerHeat(u32),
    /// Losses of all motors. \[W\]
    MotorLoss,
    /// Power out of the DC link. \[W\]
    DcPower,
    /// Loss of the gearbox of a drive unit. \[W\]
    GearboxLoss,
    /// Losses of the machines. \[W\]
    MachineLoss,
    /// Losses of the inverters. \[W\]
    InverterLoss,
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A floating-point number.
    Real,
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
}

/// Direction of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// The time.
    Independent,
    /// Set from outside at any time.
    Input,
    /// Computed.
    Output,
    /// Computed, with a start value that can be set before the simulation: a continuous state in Model Exchange.
    State,
    /// Derivative of the state of the same order.
    Derivative,
}

/// One variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slot {
    /// Meaning.
    pub use_: Use,
    /// Type.
    pub kind: Kind,
    /// Direction.
    pub causality: Causality,
    /// Start value; that of an output is computed.
    pub start: f64,
}

impl Slot {
    /// The time.
    pub const fn time() -> Self {
        Self {
            use_: Use::Time,
            kind: Kind::Real,
            causality: Causality::Independent,
            start: 0.0,
        }
    }

    /// The number of the gear.
    pub const fn gear() -> Self {
        Self {
            use_: Use::Gear,
            kind: Kind::Integer,
            causality: Causality::Input,
            start: 1.0,
        }
    }

    /// Whether an input is beyond the tables.
    pub const fn outside() -> Self {
        Self {
            use_: Use::Outside,
            kind: Kind::Boolean,
            causality: Causality::Output,
            start: 0.0,
        }
    }

    /// Value of the variable with a meaning; zero if there is none.
    pub fn value(slots: &[Self], values: &[f64], wanted: Use) -> f64 {
        let wanted_value = slots.iter().zip(values).find(|(slot, _)| slot.use_ == wanted);
        wanted_value.map_or(0.0, |(_, value)| *value)
    }
}
