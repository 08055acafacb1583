//! Map as it is written in a study.

use gearloss_framework::description::Ordered;
use gearloss_framework::document::data::TableFile;
use schemars::JsonSchema;
use serde::Deserialize;

use super::export::ExportName;
use super::map_of::MapOf;
use crate::correction::CorrectionFrom;
use crate::study::Data;

/// Losses and efficiency over a grid; figures show efficiency, loss and, with a heat balance, temperature.
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

/// About the difference between model sets.
fn quarter() -> f64 {
    0.25
}
