//! Map as it is written in a study.

use gearloss_framework::description::Ordered;
use gearloss_framework::document::data::TableFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::export::ExportName;
use crate::correction::CorrectionFrom;
use crate::points::PointResult;
use crate::study::{Data, Write};

/// Losses and efficiency over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct MapEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Grid; not with `points`.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: Option<String>,
    /// File of points instead of a grid, for example of measured data: torque, speed, and optionally gear and oil temperature of each
    /// point.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub points: Option<Data>,
    /// Columns of the points that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// Gear of points without a column `gear`; default: the first.
    #[schemars(extend("x-refers-to" = "gear_states"))]
    pub gear: Option<String>,
    /// What figures, and tables for other programs, show: the gearbox, the machines, or the drive unit of both. Files contain the quantities of all.
    #[serde(default)]
    pub of: MapOf,
    /// Losses of the motor at the reference port, for `gear: best` of the grid and gearboxes without a motor in a thermal network: a file as under
    /// `motor_map` of a vehicle. Without a motor the gears are compared by the loss of the gearbox.
    #[schemars(extend("x-refers-to" = "file"))]
    pub motor_map: Option<TableFile>,
    /// Measured points that are drawn into the figures.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub measured: Option<Data>,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// Smooth correction of the loss torque of an identification: further columns with the corrected loss and its band, apart from those of
    /// the physics. Points outside of the measured region have none. Tables for other programs contain the physics alone.
    pub correction: Option<CorrectionFrom>,
    /// Formats to write; default: CSV and JSON. Figures show efficiency, loss and, with a heat balance, temperature.
    #[serde(default = "Write::data")]
    pub write: Vec<Write>,
    /// Loss tables for other programs, one file for each gear; requires a grid.
    #[serde(default)]
    pub export: Vec<ExportName>,
    /// Libraries of further platforms for `fmu2` and `fmu3`: files out of the folder `binaries` of FMUs that were written there. That of the own
    /// platform is always included.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "file"))]
    pub fmu_libraries: Vec<String>,
    /// Maximum relative deviation of the straight lines of a `lossy_gear` table from the loss torque at a grid point; above it there is an
    /// error. [-]
    #[serde(default = "quarter")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub lossy_gear_limit: f64,
}

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

/// About the difference between model sets.
fn quarter() -> f64 {
    0.25
}
