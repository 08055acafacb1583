//! Uncertainty propagation: samples of all inputs, solved over a grid, and the resulting bands.

mod samples;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::model_error::{ModelErrorEntry, losses_of_parts};
use super::common::ranges::{PublishedCoefficient, built_again, published};
use super::common::trial::Left;
use super::{Analysis, BuiltAgain, Engine, Head, Outcome, Plan, Planner, Run, Stopped, Work};
use crate::analyses::common::axes::grid_axes;
use crate::analyses::common::inputs::Input;
use crate::codes;
use crate::points::Note;
use crate::register_analysis;
use crate::study::{NameOr, ParameterKey, ToleranceEntry, Uses, Write};
use crate::table::Table;

/// Uncertainty bands of efficiency, loss and temperature from uncertain inputs.
///
/// Every input is drawn from its distribution, over a grid.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct UncertaintyEntry {
    /// Gearbox; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// Grid with one gear.
    #[schemars(extend("x-refers-to" = "grids"))]
    pub grid: String,
    /// Model sets; default: the models of the gearbox. `PRODUCT/SET` selects another gearbox, `PRODUCT/own` its default models.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "model_sets"))]
    pub model_sets: Vec<String>,
    /// The uncertain inputs. A name refers to a parameter of the study, uniformly distributed.
    #[serde(default)]
    #[schemars(with = "Vec<NameOr<ToleranceEntry>>")]
    pub inputs: Vec<ToleranceEntry>,
    /// Error of the models: a factor on the loss of each model that measured sets judge.
    pub model_error: Option<ModelErrorEntry>,
    /// Number of samples; powers of two fill the ranges most evenly. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 16_777_216))]
    pub samples: u32,
}

fn samples() -> u32 {
    256
}

register_analysis!(UncertaintyEntry);

/// Uncertainty bands over a grid with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct UncertaintyOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub bands: Vec<BandsOfSet>,
    /// Quantities outside their stated ranges at nominal points or in samples, by set.
    #[serde(skip)]
    pub left: Vec<(String, String)>,
}

/// Uncertainty bands over a grid with one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct BandsOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Number of solved samples. [-]
    pub samples: usize,
    /// Number of failed samples. [-]
    pub failed: usize,
    /// Probabilities of the lower end, the middle and the upper end of each band. [-]
    pub quantiles: [f64; 3],
    /// The inputs, those with the strongest correlation first.
    pub inputs: Vec<UncertainInput>,
    /// The points of the grid: for each torque all speeds.
    pub points: Vec<PointOfBand>,
    /// Torques of the grid. [Nm]
    #[serde(skip)]
    pub torques_nm: Vec<f64>,
    /// Speeds of the grid, not rounded. [rpm]
    #[serde(skip)]
    pub speeds_rpm: Vec<f64>,
    /// Why the first of the failed samples has no value.
    #[serde(skip)]
    pub first_failure: Option<String>,
    /// Inputs that are coefficients of formulas, in the order of the study.
    #[serde(skip)]
    pub published: Vec<PublishedCoefficient>,
}

/// An uncertain input.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct UncertainInput {
    /// Path of the quantity as in the study, possibly a pattern.
    pub path: String,
    /// Resolved paths that change together.
    pub paths: Vec<String>,
    /// Unit of the ends of the range.
    pub unit: &'static str,
    /// Lower end of the range, in the unit of the input.
    pub from: f64,
    /// Upper end of the range, in the unit of the input.
    pub to: f64,
    /// Correlation with the mean loss over the grid; absent if one of them is constant. [-]
    pub correlation_with_mean_loss: Option<f64>,
    /// Both ends with their unit, as text.
    #[serde(skip)]
    pub words: [String; 2],
}

/// One point of the grid.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PointOfBand {
    /// Given torque. [Nm]
    pub torque_nm: f64,
    /// Given speed. [rpm]
    pub speed_rpm: f64,
    /// Output power over input power. [-]
    pub efficiency: QuantityBand,
    /// Sum of all losses. [W]
    pub loss_w: QuantityBand,
    /// Loss over the speed of the reference port. [Nm]
    pub loss_torque_nm: QuantityBand,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: QuantityBand,
    /// Power out of the DC link into the machines; absent without machines. [W]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dc_power_w: Option<QuantityBand>,
    /// Losses of gearbox, machines and inverters; absent without machines. [W]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit_loss_w: Option<QuantityBand>,
    /// Efficiency of the drive unit; absent without machines. [-]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub system_efficiency: Option<QuantityBand>,
    /// The same in percent. [%]
    #[serde(skip)]
    pub system_percent: QuantityBand,
    /// The efficiency in percent. [%]
    #[serde(skip)]
    pub efficiency_percent: QuantityBand,
}

/// A quantity at one point, in its unit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, JsonSchema)]
pub struct QuantityBand {
    /// Nominal value; absent if there is none.
    pub nominal: Option<f64>,
    /// Lower end, median and upper end of the 95 % band; absent if fewer than half the samples have a value.
    pub band: Option<[f64; 3]>,
}

impl QuantityBand {
    /// Half the width of the band.
    pub fn half_width(&self) -> Option<f64> {
        self.band.map(|band| 0.5 * (band[2] - band[0]))
    }

    /// The quantity, if it has a value at the point or in its band.
    fn known(self) -> Option<Self> {
        (self.nominal.is_some() || self.band.is_some()).then_some(self)
    }

    fn scaled(&self, scale: f64) -> Self {
        Self {
            nominal: self.nominal.map(|x| scale * x),
            band: self.band.map(|band| band.map(|x| scale * x)),
        }
    }
}

/// The points with each set, and the uncertain inputs.
pub struct UncertaintyPlan<'a> {
    samples: usize,
    runs: Vec<Run<'a>>,
    inputs: Vec<Vec<Input>>,
}

impl Plan for UncertaintyPlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |run: &Run<'_>| Work::new(run.label(), "point", (self.samples + 1) * run.points.field.len());
        self.runs.iter().map(work).collect()
    }

    fn samples(&self, cx: &Planner<'_>) -> Vec<BuiltAgain> {
        let sets = self.runs.iter().zip(&self.inputs);
        let of_set = |(run, inputs): (&Run<'_>, &Vec<Input>)| {
            built_again(cx, &run.built, inputs.iter().map(|input| &input.range))
        };
        sets.flat_map(of_set).collect()
    }
}

impl Analysis for UncertaintyEntry {
    const TYPE: &'static str = "uncertainty";
    const PARAMETERS: Option<ParameterKey> = Some(ParameterKey::Range("inputs"));
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = UncertaintyPlan<'a>;
    type Outcome = UncertaintyOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses {
            grid: Some(&self.grid),
            ..Uses::new(self.gearbox.as_ref(), &self.model_sets)
        }
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<UncertaintyPlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.gearbox.as_ref())?;
        let grid = cx.study.grid(&path, &self.grid)?;
        if !grid.bind.is_empty() || grid.envelope.is_some() {
            let message = "uncertainty bands need a grid without bound values and envelope";
            return Err(cx.wrong(&path, message, "give it its own grid"));
        }
        let built = cx.built(gearbox, &self.model_sets)?;
        let gear = cx.one_gear(&path, grid, &built[0].transmission)?;
        let (mut runs, mut inputs) = (Vec::new(), Vec::new());
        for b in &built {
            let (torques, speeds) = grid_axes(cx, &self.grid, grid, &b.transmission)?;
            let points = cx.points(&b.transmission, &gear, torques, speeds);
            let kept = points
                .field
                .len()
                .saturating_mul(samples::bytes(cx.has_machines(&b.transmission)));
            cx.fit_in_memory(&format!("{path}.samples"), self.samples as usize, kept)?;
            let mut of_set = Input::all(cx, &path, &self.inputs, b)?;
            ModelErrorEntry::add(self.model_error.as_ref(), cx, b, &mut of_set)?;
            if of_set.is_empty() {
                let message = format!("nothing is uncertain in `{}`", b.name);
                let help = "state `inputs`, or write `model_error` with sets that judge its models";
                return Err(cx.wrong_as(codes::NOTHING_UNCERTAIN, &path, message, help));
            }
            inputs.push(of_set);
            runs.push(Run::new(cx, b, points)?);
        }
        Ok(UncertaintyPlan {
            samples: self.samples as usize,
            runs,
            inputs,
        })
    }

    fn reduce<'a>(&'a self, plan: UncertaintyPlan<'a>, engine: &Engine<'a>) -> Result<UncertaintyOutcome, Stopped> {
        let mut all_left = Vec::new();
        let bands = engine.parts(plan.runs.iter().zip(&plan.inputs), |(run, inputs)| {
            let mut left = Left::new();
            let samples = samples::solve(engine, self.samples, run, inputs, &mut left)?;
            let nominal = engine.solve_here(run)?;
            left.extend(super::common::trial::left(&run.built.transmission, &nominal.seen));
            all_left.extend(left);
            engine.weigh_model_error(&run.built.name, &losses_of_parts(&nominal.points));
            let [torques, speeds] = run.points.field.axes().unwrap_or_default();
            Ok(BandsOfSet {
                model_set: run.built.name.clone(),
                gear: run.points.gear.clone(),
                samples: samples.solved.len(),
                failed: samples.failed.len(),
                quantiles: samples::SHARES,
                inputs: samples.ranked(inputs),
                points: samples.points(&nominal.points),
                torques_nm: torques.to_vec(),
                speeds_rpm: speeds.iter().map(|speed| speed * crate::numbers::RPM).collect(),
                first_failure: samples.failed.into_iter().next(),
                published: published(inputs.iter().map(|input| &input.range.varied)),
            })
        })?;
        let built: Vec<_> = plan.runs.into_iter().map(|run| run.built).collect();
        Ok(UncertaintyOutcome {
            head: engine.head(&built),
            bands,
            left: all_left,
        })
    }
}

/// Name, unit and meaning of a quantity in tables, and how to read it.
type Quantity = (
    &'static str,
    &'static str,
    &'static str,
    fn(&PointOfBand) -> Option<&QuantityBand>,
);

const QUANTITIES: [Quantity; 7] = [
    ("efficiency", "-", "Output power over input power", |p| {
        Some(&p.efficiency)
    }),
    ("loss_w", "W", "Sum of all losses", |p| Some(&p.loss_w)),
    (
        "loss_torque_nm",
        "Nm",
        "Loss over the speed of the reference port",
        |p| Some(&p.loss_torque_nm),
    ),
    ("oil_temperature_degc", "degC", "Oil temperature", |p| {
        Some(&p.oil_temperature_degc)
    }),
    ("dc_power_w", "W", "Power out of the DC link into the machines", |p| {
        p.dc_power_w.as_ref()
    }),
    ("unit_loss_w", "W", "Losses of gearbox, machines and inverters", |p| {
        p.unit_loss_w.as_ref()
    }),
    (
        "system_efficiency",
        "-",
        "Power at the other ports over the power of the DC link",
        |p| p.system_efficiency.as_ref(),
    ),
];

impl Outcome for UncertaintyOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let points = || self.bands.iter().flat_map(|set| &set.points);
        // Quantities of the drive unit have columns only if there is one.
        let known = QUANTITIES.iter().copied().enumerate();
        let known = known.filter(|(i, (.., quantity))| *i < 4 || points().any(|point| quantity(point).is_some()));
        let known: Vec<Quantity> = known.map(|(_, quantity)| quantity).collect();
        let table = Table::of_each(&self.head.analysis, &self.bands, |set| &set.points)
            .text("model_set", "Model set", |(set, _)| &set.model_set)
            .text("gear", "Gear", |(set, _)| &set.gear)
            .fields("torque_nm speed_rpm", |(_, point)| point)
            .each(known, |table, (name, unit, meaning, quantity)| {
                let ends = [
                    ("low", "lower end of the 95 % band"),
                    ("median", "median of the samples"),
                    ("high", "upper end of the 95 % band"),
                ];
                let nominal = format!("{meaning}, nominal");
                table
                    .number(name, unit, nominal, |(_, point)| quantity(point)?.nominal)
                    .each(ends.into_iter().enumerate(), |table, (k, (end, which))| {
                        let meaning = format!("{meaning}, {which}");
                        table.number(format!("{name}_{end}"), unit, meaning, |(_, point)| {
                            quantity(point)?.band.map(|band| band[k])
                        })
                    })
            });
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.left.iter().collect()
    }
}
