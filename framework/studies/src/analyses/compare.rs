//! Differences between model sets and products over a grid, or from a measurement.

mod cases;
mod model_error;
mod on_grid;
mod over_cycles;
mod with_data;

use gearloss_framework::description::Ordered;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use on_grid::{DifferenceAt, GridComparison, GridDifference, GridPlan};
pub use over_cycles::{CycleComparison, DifferenceOfPhase, DifferenceOfShare};
pub use with_data::{Band, ComparedPoint, DataComparison, DataOfComparison, Ranking, ranking};

use super::common::duties::DrivePlan;
use super::common::inputs::Input;
use super::common::measurable::{countable, measured};
use super::common::model_error::ModelErrorEntry;
use super::common::rows::RowsPlan;
use super::{Analysis, Engine, Head, Outcome, Plan, Planner, Stopped, Work};
use crate::codes;
use crate::correction::{CorrectionFrom, ReadyCorrection};
use crate::points::Note;
use crate::register_analysis;
use crate::study::{By, CycleGear, Data, Difference, Quantity, RideEntry, Uses};
use crate::table::Table;

/// Difference between model sets, products and variants over a grid or over cycles, or from a measurement; figures show the differences and, with
/// data, parity.
///
/// Over cycles the differences of the mean loss are split by share and by phase of the cycle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CompareEntry {
    /// Gearbox of sets without a product; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Grid; not with `data` or `drive`.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: Option<String>,
    /// Cycles; not with `data` or `grid`.
    pub drive: Option<RideEntry>,
    /// Base of the comparison; not with `data`. `PRODUCT/SET` selects another gearbox, `own` or `PRODUCT/own` its default models.
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub base: Option<String>,
    /// Measured points that the sets are compared with.
    #[schemars(extend("x-refers-to" = "measurements"))]
    pub data: Option<Data>,
    /// Columns of the data that change a value of the gearbox: column to resolved path.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub bind: Ordered<String>,
    /// Gear of the data or of cycles without one; default: the first. Over cycles `best` chooses the gear that draws least, an entry states how
    /// gears are chosen.
    pub gear: Option<CycleGear>,
    /// Model sets to compare; `PRODUCT/SET` selects another gearbox.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub against: Vec<String>,
    /// Variants of the base to compare, each with its changed values: resolved path to value. Not with `data`.
    #[serde(default)]
    #[schemars(extend("x-keys" = "path"))]
    pub variants: Ordered<Ordered<Value>>,
    /// Grouping of the losses of cycles.
    #[serde(default)]
    pub by: By,
    /// Compared quantity; not with `drive`.
    #[serde(default)]
    pub quantity: Quantity,
    /// Accuracy of a measurement, in the unit of the difference: maps mark differences below it. [-]
    #[schemars(range(min = 0.0, max = 1e9), extend("x-bare" = true))]
    pub accuracy: Option<f64>,
    /// Unit of the difference: the other set minus the base, or model minus measurement.
    #[serde(default)]
    pub difference: Difference,
    /// Error of the models for a band of the difference of the loss: a factor on the loss of each model that measured sets judge, the same in
    /// all sets that use the model. Not with `data`, where the measurement judges.
    pub model_error: Option<ModelErrorEntry>,
    /// Number of samples for `model_error`; powers of two fill the distributions most evenly. Default: 64. [-]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: Option<u32>,
    /// Smooth correction of the loss torque of an identification: the differences that remain with it, beside those of the physics. With `data`, one model
    /// set, and `quantity: loss` or `loss_torque`.
    pub correction: Option<CorrectionFrom>,
}

register_analysis!(CompareEntry);

/// Differences of model sets from a base over a grid, or from a measurement.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CompareOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The measurement; absent for differences over a grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub data: Option<DataOfComparison>,
    /// One for each model set.
    pub comparisons: Comparisons,
    /// Compared quantity.
    #[serde(skip)]
    pub quantity: Quantity,
    /// Kind of difference.
    #[serde(skip)]
    pub difference: Difference,
    /// Accuracy of a measurement as the study states it. [unit of the difference]
    #[serde(skip)]
    pub accuracy: Option<f64>,
}

/// Differences by model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Comparisons {
    /// From a base over a grid.
    OnGrid(Vec<GridComparison>),
    /// From a base over cycles.
    OverCycles(Vec<CycleComparison>),
    /// From a measurement.
    WithData(Vec<DataComparison>),
}

/// What is compared.
pub enum ComparePlan<'a> {
    /// Sets with a base over a grid.
    OnGrid(&'a str, GridPlan<'a>, Vec<Vec<Input>>),
    /// Sets with a base over cycles.
    OverCycles(Box<DrivePlan<'a>>, Vec<Vec<Input>>),
    /// Sets with measured points.
    WithData(&'a Data, Box<RowsPlan<'a>>, Option<Vec<ReadyCorrection>>),
}

impl Plan for ComparePlan<'_> {
    fn work(&self) -> Vec<Work> {
        match self {
            Self::OnGrid(_, plan, _) => plan.work(),
            Self::OverCycles(plan, _) => plan.work(),
            Self::WithData(_, plan, _) => plan.work(),
        }
    }
}

impl Analysis for CompareEntry {
    const TYPE: &'static str = "compare";
    type Plan<'a> = ComparePlan<'a>;
    type Outcome = CompareOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: self.grid.as_ref(),
            ..Uses::new(self.gearbox.as_ref(), self.base.iter().chain(&self.against))
                .in_gears(self.gear.iter().flat_map(CycleGear::names))
                .bind(&self.bind)
                .with("data", self.data.as_ref())
                .riding(self.drive.as_ref())
        }
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<ComparePlan<'a>, Stopped> {
        let path = cx.path();
        countable(cx, &path, self.quantity, self.difference)?;
        if self.data.is_some() {
            measured(cx, &path, self.quantity)?;
        }
        if self.against.is_empty() && self.variants.is_empty() {
            let help = "write `against: [...]` with model sets, or `variants: { name: { path: value } }`";
            return Err(cx.wrong(&path, "nothing is compared with the base", help));
        }
        if self.by != By::default() && self.drive.is_none() {
            return Err(cx.wrong(
                &format!("{path}.by"),
                "`by` groups the losses of cycles",
                "delete it, or write `drive: ...`",
            ));
        }
        let counted = (self.quantity, self.difference, self.accuracy);
        if self.drive.is_some() && counted != (Quantity::default(), Difference::default(), None) {
            let message = "over cycles the mean losses are compared, in W and in percent";
            return Err(cx.wrong(&path, message, "delete `quantity`, `difference` and `accuracy`"));
        }
        if self.model_error.is_some() && self.data.is_some() {
            let message = "in a comparison with a measurement the measurement judges the models";
            return Err(cx.wrong(&format!("{path}.model_error"), message, "delete it"));
        }
        if self.correction.is_some() && self.data.is_none() {
            let message = "a correction is of measured losses, and this comparison is one of sets";
            return Err(cx.wrong_as(
                codes::CORRECTION,
                &format!("{path}.correction"),
                message,
                "delete it, or write `data`",
            ));
        }
        match (&self.grid, &self.drive, &self.base, &self.data) {
            (None, None, None, Some(_)) if !self.variants.is_empty() => {
                let message = "a comparison with a measurement has no variants";
                Err(cx.wrong(
                    &format!("{path}.variants"),
                    message,
                    "write them as model sets or gearboxes",
                ))
            }
            (None, None, None, Some(data)) => {
                let corrections = with_data::corrections(cx, self)?;
                Ok(ComparePlan::WithData(data, Box::new(with_data::plan(cx, self, data)?), corrections))
            }
            (.., None) if !self.bind.is_empty() => {
                Err(cx.wrong(&path, "`bind` belongs to `data`", "state it in the grid"))
            }
            (Some(_), None, Some(_), None) if self.gear.is_some() => {
                Err(cx.wrong(&path, "`gear` belongs to `data` or `drive`", "state it in the grid"))
            }
            (Some(grid), None, Some(base), None) => {
                let plan = GridPlan::new(cx, self, grid, base)?;
                let inputs = model_error::inputs(cx, self, &plan.built())?;
                Ok(ComparePlan::OnGrid(base, plan, inputs))
            }
            (None, Some(ride), Some(base), None) => {
                let plan = over_cycles::plan(cx, self, ride, base)?;
                let inputs = model_error::inputs(cx, self, &plan.built)?;
                Ok(ComparePlan::OverCycles(Box::new(plan), inputs))
            }
            _ => {
                Err(cx.wrong(
                    &path,
                    "a comparison needs `base` with `grid` or with `drive`, or else `data`",
                    "write `base: ...` with `grid: ...` or `drive: { cycles: [...] }` to compare sets, or `data: { file: ... }` to compare with a measurement",
                ))
            }
        }
    }

    fn reduce<'a>(&'a self, plan: ComparePlan<'a>, engine: &Engine<'a>) -> Result<CompareOutcome, Stopped> {
        let (built, data, comparisons) = match &plan {
            ComparePlan::OnGrid(base, plan, inputs) => {
                let comparisons = plan.compare(engine, self, base, inputs)?;
                (plan.built(), None, Comparisons::OnGrid(comparisons))
            }
            ComparePlan::OverCycles(plan, inputs) => {
                let comparisons = over_cycles::compare(engine, self, plan, inputs)?;
                (plan.built.clone(), None, Comparisons::OverCycles(comparisons))
            }
            ComparePlan::WithData(data, plan, corrections) => {
                let (built, data, comparisons) = with_data::compare(engine, self, data, plan, corrections.as_deref())?;
                (built, Some(data), Comparisons::WithData(comparisons))
            }
        };
        Ok(CompareOutcome {
            head: engine.head(&built),
            data,
            comparisons,
            quantity: self.quantity,
            difference: self.difference,
            accuracy: self.accuracy,
        })
    }
}

impl Outcome for CompareOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let name = &self.head.analysis;
        let counted = (self.quantity, self.difference);
        match &self.comparisons {
            Comparisons::OnGrid(all) => vec![on_grid::table(name, counted, all)],
            Comparisons::OverCycles(all) => vec![over_cycles::table(name, all), over_cycles::phase_table(name, all)],
            Comparisons::WithData(all) => vec![with_data::table(name, counted, all)],
        }
    }

    fn notes(&self) -> Vec<&Note> {
        match &self.comparisons {
            Comparisons::OnGrid(all) => all.iter().flat_map(|c| &c.notes).collect(),
            Comparisons::OverCycles(all) => all.iter().flat_map(|c| &c.notes).collect(),
            Comparisons::WithData(all) => all.iter().flat_map(|c| &c.notes).collect(),
        }
    }

    /// Those of the base, once for each cycle.
    fn unlisted(&self) -> usize {
        match &self.comparisons {
            Comparisons::OnGrid(all) => all.first().map_or(0, |c| c.ranges_left_by_base),
            Comparisons::OverCycles(all) => {
                let of_one_case = all.iter().take_while(|c| c.model_set == all[0].model_set);
                of_one_case.map(|c| c.ranges_left_by_base).sum()
            }
            Comparisons::WithData(_) => 0,
        }
    }
}

/// Unit of a quantity in tables.
fn unit(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Efficiency | Quantity::SystemEfficiency => "-",
        Quantity::Loss | Quantity::DcPower | Quantity::UnitLoss => "W",
        Quantity::LossTorque => "Nm",
        Quantity::Temperature => "degC",
    }
}
