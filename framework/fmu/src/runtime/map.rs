//! Losses of a map.

use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use super::table::Table;
use super::variables::{Causality, Kind, Slot, Use};

/// Quantities of the tables: speed, torque, oil temperature.
pub const QUANTITIES: usize = 3;
/// Shares of the loss in the tables, beside the total.
pub const SHARES: usize = 6;

/// Further channels of a drive unit: power at the shafts of the machines over speed, and the losses of machines and of inverters.
const ELECTRIC: usize = 3;

/// Whose losses a map has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OfMap {
    /// The gearbox.
    #[default]
    Gearbox,
    /// Gearbox, machines and inverters.
    Unit,
    /// Machines and inverters.
    Machines,
}

impl OfMap {
    /// Number of channels of the gearbox: loss torque and its shares.
    fn of_gearbox(self) -> usize {
        match self {
            Self::Gearbox | Self::Unit => 1 + SHARES,
            Self::Machines => 0,
        }
    }

    /// Number of channels of machines and inverters.
    fn electric(self) -> usize {
        match self {
            Self::Gearbox => 0,
            Self::Unit | Self::Machines => ELECTRIC,
        }
    }
}

/// Origin of the oil temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OilOfMap {
    /// An input: the tables have it as an axis.
    Given,
    /// An output: each point has its own.
    Balance,
    /// The same at all points.
    Fixed,
}

/// Losses of one gear.
#[derive(Debug, Clone, PartialEq)]
pub struct GearOfMap {
    /// Its name.
    pub name: String,
    /// Speed of the other port over that of the reference port; absent unless there are two ports.
    pub ratio: Option<f64>,
    /// Over speed, torque and, if given, oil temperature. Of the gearbox: loss torque and its shares over speed; then the oil temperature of a
    /// heat balance; then, if the map has machines, power of their shafts over speed \[Nm\], their losses and those of inverters \[W\].
    pub table: Table,
}

/// Losses over speed, torque and oil temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Whose losses.
    pub of: OfMap,
    /// Origin of the oil temperature.
    pub oil: OilOfMap,
    /// The gears; at least one.
    pub gears: Vec<GearOfMap>,
    /// Start values of speed, torque and oil temperature.
    pub starts: Vec<f64>,
}

impl Map {
    /// Whether all tables are as described.
    pub fn is_sound(&self) -> bool {
        let channels = self.of.of_gearbox() + usize::from(self.oil == OilOfMap::Balance) + self.of.electric();
        let gear = |gear: &GearOfMap| gear.table.channels == channels && gear.table.is_sound();
        let has_one = self.gears.first().map(|gear| gear.ratio.is_some());
        let same = self.gears.iter().all(|gear| Some(gear.ratio.is_some()) == has_one);
        let turns = |gear: &GearOfMap| gear.ratio.is_none_or(|ratio| ratio.is_finite() && ratio != 0.0);
        let starts = self.starts.len() == QUANTITIES && self.starts.iter().all(|x| x.is_finite());
        has_one.is_some() && same && starts && self.gears.iter().all(|g| gear(g) && turns(g))
    }

    /// The variables after time.
    pub fn variables(&self) -> Vec<Slot> {
        let input = |use_: Use, start: f64| Slot {
            use_,
            kind: Kind::Real,
            causality: Causality::Input,
            start,
        };
        let output = |use_: Use| Slot {
            use_,
            kind: Kind::Real,
            causality: Causality::Output,
            start: 0.0,
        };
        let start = |i: usize| self.starts.get(i).copied().unwrap_or(0.0);
        let mut all = vec![input(Use::Speed, start(0)), input(Use::Torque, start(1))];
        if self.oil == OilOfMap::Given {
            all.push(input(Use::OilTemperature, start(2)));
        }
        if self.gears.len() > 1 {
            all.push(Slot::gear());
        }
        let losses: &[Use] = match self.of {
            OfMap::Gearbox => &[Use::LossTorque, Use::LossPower, Use::Efficiency],
            OfMap::Unit => &[
                Use::LossPower,
                Use::Efficiency,
                Use::DcPower,
                Use::GearboxLoss,
                Use::MachineLoss,
                Use::InverterLoss,
            ],
            OfMap::Machines => &[
                Use::LossPower,
                Use::Efficiency,
                Use::DcPower,
                Use::MachineLoss,
                Use::InverterLoss,
            ],
        };
        all.extend(losses.iter().copied().map(output));
        if self.gears.iter().all(|gear| gear.ratio.is_some()) {
            all.extend([Use::OutputTorque, Use::OutputSpeed].map(output));
        }
        if self.oil == OilOfMap::Balance {
            all.push(output(Use::OilTemperature));
        }
        if self.of.of_gearbox() > 0 {
            all.extend((0..SHARES as u32).map(|share| output(Use::Share(share))));
        }
        all.push(Slot::outside());
        all
    }

    /// Writes the outputs from the inputs.
    pub fn evaluate(&self, slots: &[Slot], values: &mut [f64]) {
        let input = |wanted: Use| Slot::value(slots, values, wanted);
        let (speed, torque) = (input(Use::Speed), input(Use::Torque));
        let Some((gear, is_gear)) = chosen(&self.gears, input(Use::Gear), slots) else {
            return;
        };
        let turn = Turn::new(speed, torque, &gear.table);
        let mut sums = [0.0; 2 + SHARES + ELECTRIC];
        let quantities = [turn.speed, turn.torque, input(Use::OilTemperature)];
        let inside = gear.table.interpolate(&quantities, 1.0, &mut sums);
        let (of_gearbox, rest) = sums.split_at(self.of.of_gearbox());
        let loss_torque = of_gearbox.first().copied().unwrap_or(0.0);
        let gearbox = loss_torque * speed.abs();
        let rest_from = usize::from(self.oil == OilOfMap::Balance);
        let mut electric = [0.0; ELECTRIC];
        if self.of.electric() > 0 {
            electric.copy_from_slice(&rest[rest_from..rest_from + ELECTRIC]);
        }
        let [shaft_torque, machine, inverter] = electric;
        let shafts = shaft_torque * speed.abs();
        let dc = shafts + machine + inverter;
        let power = gearbox + machine + inverter;
        let ratio = gear.ratio.unwrap_or(1.0);
        for (slot, value) in slots.iter().zip(values) {
            if slot.causality != Causality::Output {
                continue;
            }
            *value = match slot.use_ {
                Use::LossTorque => loss_torque,
                Use::LossPower => power,
                Use::Efficiency if self.of == OfMap::Gearbox => efficiency(speed * torque, power),
                Use::Efficiency => from_link(dc, shafts - gearbox),
                Use::DcPower => dc,
                Use::GearboxLoss => gearbox,
                Use::MachineLoss => machine,
                Use::InverterLoss => inverter,
                Use::OutputTorque => (torque - turn.sense * loss_torque) / ratio,
                Use::OutputSpeed => speed * ratio,
                Use::OilTemperature => rest.first().copied().unwrap_or(0.0),
                Use::Share(share) => of_gearbox.get(1 + share as usize).copied().unwrap_or(0.0) * speed.abs(),
                Use::Outside => f64::from(!(inside && is_gear && !turn.is_mirrored)),
                _ => *value,
            };
        }
    }
}

/// The gear with a number from one on, and whether there is one with this number; with a single gear there is no number.
pub fn chosen<'a, G>(gears: &'a [G], number: f64, slots: &[Slot]) -> Option<(&'a G, bool)> {
    if !slots.iter().any(|slot| slot.use_ == Use::Gear) {
        return gears.first().map(|gear| (gear, true));
    }
    let held = (number as usize).clamp(1, gears.len().max(1));
    let gear = gears.get(held - 1);
    gear.map(|gear| (gear, held as f64 == number))
}

/// Speed and torque where the tables have them.
pub struct Turn {
    /// Speed for the tables.
    pub speed: f64,
    /// Torque for the tables.
    pub torque: f64,
    /// Sense of rotation, 1 or -1.
    pub sense: f64,
    /// Whether the tables lack this sense of rotation, so that the other one applies.
    pub is_mirrored: bool,
}

impl Turn {
    /// For tables whose first axis is the speed.
    pub fn new(speed: f64, torque: f64, table: &Table) -> Self {
        let sense = if speed < 0.0 { -1.0 } else { 1.0 };
        let first = table.axes.first().and_then(|axis| axis.points.first());
        let is_mirrored = sense < 0.0 && first.is_none_or(|first| *first >= 0.0);
        let factor = if is_mirrored { -1.0 } else { 1.0 };
        Self {
            speed: factor * speed,
            torque: factor * torque,
            sense,
            is_mirrored,
        }
    }
}

/// Output over input power, from the power into the reference port and the loss; zero without output power. \[W\]
pub fn efficiency(reference: f64, loss: f64) -> f64 {
    let (input, output) = if reference > 0.0 {
        (reference, reference - loss)
    } else {
        (loss - reference, -reference)
    };
    if output > 0.0 && input > 0.0 {
        output / input
    } else {
        0.0
    }
}

/// Power that passes over the power of the DC link, or the reciprocal while it is generated; zero if no power passes. \[W\]
fn from_link(dc: f64, passed: f64) -> f64 {
    if dc > 0.0 && passed > 0.0 {
        passed / dc
    } else if dc < 0.0 && passed < 0.0 {
        dc / passed
    } else {
        0.0
    }
}
