//! What a map shows: the gearbox, the machines, or the drive unit of both.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::points::PointResult;

/// What a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MapOf {
    /// The gearbox: output power over input power, and its loss.
    #[default]
    Gearbox,
    /// The drive unit: power at the other ports over the power of the DC link, and the losses of gearbox, machines and inverters.
    Unit,
    /// The machines with their inverters: power at their shafts over the power of the DC link, and their losses.
    Machine,
}

impl MapOf {
    /// Whose efficiency and loss, as the end of a phrase; empty of the gearbox.
    pub fn words(self) -> &'static str {
        match self {
            Self::Gearbox => "",
            Self::Unit => " of the drive unit",
            Self::Machine => " of the machines",
        }
    }

    /// True of the gearbox.
    pub fn is_gearbox(&self) -> bool {
        *self == Self::Gearbox
    }

    /// Efficiency, loss \[W\], and loss over the speed of the reference port \[Nm\] at a point.
    pub fn read(self, point: &PointResult) -> [Option<f64>; 3] {
        let unit = point.unit();
        let (efficiency, loss) = match self {
            Self::Gearbox => return [point.efficiency, point.loss, point.loss_torque],
            Self::Unit => (
                unit.and_then(|unit| unit.system_efficiency),
                unit.map(|unit| unit.unit_loss_w),
            ),
            Self::Machine => (
                unit.and_then(|unit| unit.machine_efficiency()),
                unit.map(|unit| unit.machine_loss_w + unit.inverter_loss_w),
            ),
        };
        let speed = point.reference_speed.abs();
        [efficiency, loss, loss.filter(|_| speed != 0.0).map(|loss| loss / speed)]
    }

    /// The usual sums of a point, with the losses of machines and inverters among the others. \[W\]
    pub fn sums(self, point: &PointResult) -> [f64; 6] {
        let unit = point.unit();
        let electric = unit.map_or(0.0, |unit| unit.machine_loss_w + unit.inverter_loss_w);
        match self {
            Self::Gearbox => point.sums,
            Self::Unit => {
                let mut sums = point.sums;
                sums[5] += electric;
                sums
            }
            Self::Machine => [0.0, 0.0, 0.0, 0.0, 0.0, electric],
        }
    }
}
