//! Results of a sensitivity analysis as records and columns.

use gearloss_numerics::sensitivity::{Estimate, Influence};
use schemars::JsonSchema;
use serde::Serialize;

use super::super::common::ranges::Range;
use super::super::common::trial::Left;
use super::super::{Head, Outcome};
use super::Found;
use super::outputs::{Output, OutputKind};
use crate::points::Note;
use crate::table::Table;
use crate::varied::Varied;

/// Sensitivity of the losses over a grid with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SensitivityOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set.
    pub sensitivities: Vec<SensitivityOfSet>,
}

/// Sensitivity of the losses with one model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SensitivityOfSet {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Number of points of the grid. [-]
    pub points: usize,
    /// Number of evaluations of each method.
    pub runs: RunsOfMethods,
    /// The varied quantities.
    pub parameters: Vec<VariedParameter>,
    /// The outputs, the mean loss first.
    pub outputs: Vec<OutputSensitivity>,
    /// Samples of the shares of the variance. [-]
    #[serde(skip)]
    pub samples: usize,
    /// Number of quantities outside their stated ranges at the values of the gearbox. [-]
    #[serde(skip)]
    pub left_at_start: usize,
    /// Quantities outside their stated ranges in some evaluations.
    #[serde(skip)]
    pub left_at_samples: Left,
}

/// Number of evaluations of each method; absent for methods that were not requested.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct RunsOfMethods {
    /// Slopes at the values of the gearbox. [-]
    pub local: Option<usize>,
    /// Screening. [-]
    pub morris: Option<usize>,
    /// Shares of the variance. [-]
    pub sobol: Option<usize>,
}

impl RunsOfMethods {
    /// Of all methods.
    pub(super) fn count(&self) -> usize {
        [self.local, self.morris, self.sobol].into_iter().flatten().sum()
    }
}

/// A varied quantity and its range.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct VariedParameter {
    /// Path as in the study.
    pub path: String,
    /// Resolved paths that it matches.
    pub paths: Vec<String>,
    /// Unit of its values.
    pub unit: &'static str,
    /// Value of the gearbox; one for a factor, absent if the gearbox states none. [unit]
    pub start: Option<f64>,
    /// Lower end of the range. [unit]
    pub from: f64,
    /// Upper end of the range. [unit]
    pub to: f64,
    /// The quantity.
    #[serde(skip)]
    pub varied: Varied,
}

/// Sensitivity of one output.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OutputSensitivity {
    /// `loss`, a mechanism, a mechanism and its term, `efficiency`, or `relative_loss`.
    pub output: String,
    /// Kind.
    pub kind: OutputKind,
    /// Its unit: `w` or `-`.
    pub unit: &'static str,
    /// Whether a term is load-dependent; absent for other outputs, and if models of a mechanism differ in it.
    pub load_dependent: Option<bool>,
    /// Mean over the points at the values of the gearbox. [unit]
    pub mean: f64,
    /// Slopes over each parameter; absent if not requested, and for `relative_loss`, which has a kink there.
    pub local: Option<Vec<SlopeOfOutput>>,
    /// Effect of each parameter; absent if not requested.
    pub morris: Option<Vec<EffectOfParameter>>,
    /// Shares of the variance; absent if not requested.
    pub sobol: Option<SharesOfVariance>,
}

/// Slope of an output over one parameter at the values of the gearbox.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct SlopeOfOutput {
    /// Change of the output over the change of the parameter. [unit of the output over unit of the parameter]
    pub slope: f64,
    /// Slope times the range of the parameter over the output; absent if the output is zero. [-]
    pub scaled: Option<f64>,
    /// Relative change of the output over the relative change of the parameter; absent if one of them is zero. [-]
    pub elasticity: Option<f64>,
}

/// Changes of an output over the whole range of one parameter, along trajectories.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct EffectOfParameter {
    /// Mean. [unit of the output]
    pub mu: f64,
    /// Mean of the magnitudes. [unit of the output]
    pub mu_star: f64,
    /// Standard deviation. [unit of the output]
    pub sigma: f64,
    /// Influence of the parameter on the output.
    pub influence: Influence,
}

/// Variance shares of an output.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SharesOfVariance {
    /// Mean over the ranges. [unit of the output]
    pub mean: f64,
    /// Variance over the ranges. [unit of the output squared]
    pub variance: f64,
    /// Whether parameters interact: the first-order shares sum to less than 90 %.
    pub interactions: bool,
    /// First-order share of each parameter. [-]
    pub first: Vec<Estimate>,
    /// Total share of each parameter, including interactions. [-]
    pub total: Vec<Estimate>,
}

impl VariedParameter {
    pub(super) fn new(range: &Range) -> Self {
        let varied = range.varied.clone();
        Self {
            path: varied.pattern.clone(),
            paths: varied.paths.clone(),
            unit: varied.unit.symbol,
            start: varied.start(),
            from: range.ends[0],
            to: range.ends[1],
            varied,
        }
    }
}

/// Results of every method for each output.
pub(super) fn outputs(list: &[Output], means: &[f64], ranges: &[Range], found: &Found) -> Vec<OutputSensitivity> {
    let output = |(i, (output, mean)): (usize, (&Output, &f64))| OutputSensitivity {
        output: output.name.clone(),
        kind: output.kind,
        unit: output.unit(),
        load_dependent: output.load_dependent,
        mean: *mean,
        local: slopes(output.kind, i, ranges, found),
        morris: effects(i, found),
        sobol: found.sobol.as_ref().map(|sobol| {
            let shares = &sobol[i];
            SharesOfVariance {
                mean: shares.mean,
                variance: shares.variance,
                interactions: shares.interact(),
                first: shares.first.clone(),
                total: shares.total.clone(),
            }
        }),
    };
    list.iter().zip(means).enumerate().map(output).collect()
}

/// Slopes of an output over the parameters, without an elasticity if a parameter is zero. Absent for the relative change over the points,
/// which has a minimum with a kink at the values of the gearbox.
fn slopes(kind: OutputKind, output: usize, ranges: &[Range], found: &Found) -> Option<Vec<SlopeOfOutput>> {
    let local = found.local.as_ref().filter(|_| kind != OutputKind::RelativeLoss)?;
    let slopes = local[output].iter().zip(ranges).map(|(local, range)| {
        let zero = range.varied.start() == Some(0.0);
        SlopeOfOutput {
            slope: local.slope,
            scaled: local.scaled,
            elasticity: local.elasticity.filter(|_| !zero),
        }
    });
    Some(slopes.collect())
}

fn effects(output: usize, found: &Found) -> Option<Vec<EffectOfParameter>> {
    let morris = found.morris.as_ref()?;
    let effects = morris.effects[output].iter().zip(morris.influences(output));
    let effects = effects.map(|(effect, influence)| EffectOfParameter {
        mu: effect.mean,
        mu_star: effect.magnitude,
        sigma: effect.deviation,
        influence,
    });
    Some(effects.collect())
}

/// A row of the table: one output over one parameter, with the results of the requested methods.
struct Row<'o> {
    of_set: &'o SensitivityOfSet,
    output: &'o OutputSensitivity,
    parameter: &'o VariedParameter,
    local: Option<&'o SlopeOfOutput>,
    effect: Option<&'o EffectOfParameter>,
    first: Option<&'o Estimate>,
    total: Option<&'o Estimate>,
}

impl Outcome for SensitivityOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let of_output = "unit of the output";
        let mut rows = Vec::new();
        for of_set in &self.sensitivities {
            for output in &of_set.outputs {
                rows.extend(of_set.parameters.iter().enumerate().map(|(k, parameter)| Row {
                    of_set,
                    output,
                    parameter,
                    local: output.local.as_ref().and_then(|slopes| slopes.get(k)),
                    effect: output.morris.as_ref().map(|effects| &effects[k]),
                    first: output.sobol.as_ref().map(|shares| &shares.first[k]),
                    total: output.sobol.as_ref().map(|shares| &shares.total[k]),
                }));
            }
        }
        let table = Table::of(&self.head.analysis, rows)
            .text("model_set", "Model set", |row| &row.of_set.model_set)
            .text("gear", "Gear", |row| &row.of_set.gear)
            .text("output", "Output", |row| &row.output.output)
            .text("kind", "Kind of the output", |row| row.output.kind.name())
            .text("unit", "Unit of the output", |row| row.output.unit)
            .text("parameter", "Path of the parameter", |row| &row.parameter.path)
            .text("parameter_unit", "Unit of the parameter", |row| row.parameter.unit)
            .number(
                "local_slope",
                "unit of the output over unit of the parameter",
                "Slope at the values of the gearbox",
                |row| row.local.map(|local| local.slope),
            )
            .number("local_scaled", "-", "Slope times the range over the output", |row| {
                row.local.and_then(|local| local.scaled)
            })
            .number("local_elasticity", "-", "Relative change over relative change", |row| {
                row.local.and_then(|local| local.elasticity)
            })
            .number("morris_mu", of_output, "Mean change over the whole range", |row| {
                row.effect.map(|effect| effect.mu)
            })
            .number(
                "morris_mu_star",
                of_output,
                "Mean magnitude of the change over the whole range",
                |row| row.effect.map(|effect| effect.mu_star),
            )
            .number("morris_sigma", of_output, "Standard deviation of the change", |row| {
                row.effect.map(|effect| effect.sigma)
            })
            .text("morris_influence", "Influence of the parameter on the output", |row| {
                row.effect.map_or("", |effect| effect.influence.name())
            })
            .number("sobol_first", "-", "First-order share of the variance", |row| {
                row.first.map(|index| index.value)
            })
            .ends(
                ["sobol_first_low", "sobol_first_high"],
                "-",
                "its 95 % interval",
                |row| row.first.map(|index| index.interval),
            )
            .number("sobol_total", "-", "Total share of the variance", |row| {
                row.total.map(|index| index.value)
            })
            .ends(
                ["sobol_total_low", "sobol_total_high"],
                "-",
                "its 95 % interval",
                |row| row.total.map(|index| index.interval),
            );
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.sensitivities
            .iter()
            .flat_map(|of_set| &of_set.left_at_samples)
            .collect()
    }

    fn unlisted(&self) -> usize {
        self.sensitivities.iter().map(|of_set| of_set.left_at_start).sum()
    }
}
