//! Laws of a property of oils against values over temperature: viscosity, density, pressure-viscosity coefficient.

use std::sync::Arc;

use gearloss_framework::description::LubricantEntry;
use gearloss_framework::description::lubricant::{DensityLaw, PressureViscosityLaw, ViscosityLaw};
use gearloss_framework::document::{Diagnostic, Dimension, did_you_mean};
use gearloss_framework::lubricant::Lubricant;
use gearloss_numerics::statistics::bands;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::validation::{Cell, CellOfRegime, Ratio};
use super::{Analysis, Built, Engine, Head, Outcome, Plan, Planner, Stopped, Work};
use crate::codes;
use crate::distinct::distinct;
use crate::fit::columns::{Columns, Measure, Quantity};
use crate::points::Note;
use crate::register_analysis;
use crate::study::{Uses, Write};
use crate::table::Table;

/// Every law of a property of oils compared with values over temperature, without any fit.
///
/// The oils are lubricants of the gearbox; each law is given what the gearbox states of them, such as the viscosity at two temperatures.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct OilPropertyEntry {
    /// Gearbox whose lubricants are compared; default: the first.
    #[schemars(extend("x-refers-to" = "gearboxes"))]
    pub gearbox: Option<String>,
    /// The property.
    pub property: OilProperty,
    /// Table with `temperature` and a column with the name and a unit of the property, and `oil`, the name of a lubricant, unless there is one.
    #[schemars(extend("x-refers-to" = "file"))]
    pub file: String,
    /// Standard deviation of the values, common to all. [%]
    #[schemars(range(min = 0.01, max = 100.0))]
    pub accuracy: Option<f64>,
}

/// A property of an oil.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OilProperty {
    /// Kinematic viscosity, mm2/s.
    KinematicViscosity,
    /// Density, kg/m3.
    Density,
    /// Pressure-viscosity coefficient, 1/GPa.
    PressureViscosity,
}

impl OilProperty {
    /// Its name, its unit in results, and how many of them are one in SI.
    fn measure(self) -> (&'static str, &'static str, f64) {
        match self {
            Self::KinematicViscosity => ("kinematic_viscosity", "mm2/s", 1e6),
            Self::Density => ("density", "kg/m3", 1.0),
            Self::PressureViscosity => ("pressure_viscosity", "1/GPa", 1e9),
        }
    }

    /// Its column.
    fn quantity(self) -> Quantity {
        let dimension = match self {
            Self::KinematicViscosity => Dimension::KinematicViscosity,
            Self::Density => Dimension::Density,
            Self::PressureViscosity => Dimension::PressureCoefficient,
        };
        let (name, unit, _) = self.measure();
        Quantity::new(name, Measure::Of(dimension), unit)
    }

    /// The laws, by their names in a gearbox: each an oil of which nothing else is changed.
    fn laws(self, oil: &LubricantEntry) -> Vec<(String, LubricantEntry)> {
        let named = |law: &dyn Named, changed: LubricantEntry| (law.name(), changed);
        match self {
            Self::KinematicViscosity => [
                ViscosityLaw::AstmD341,
                ViscosityLaw::Din51563,
                ViscosityLaw::AstmD341Low,
                ViscosityLaw::Vogel,
            ]
            .iter()
            .map(|law| {
                let mut changed = oil.clone();
                if let Some(viscosity) = &mut changed.viscosity {
                    viscosity.law = *law;
                }
                named(law, changed)
            })
            .collect(),
            Self::Density => [DensityLaw::Linear, DensityLaw::Din51757, DensityLaw::Api]
                .iter()
                .map(|law| {
                    let mut changed = oil.clone();
                    let density = changed.density.get_or_insert_default();
                    density.law = *law;
                    if *law != DensityLaw::Linear {
                        density.expansion = None;
                    }
                    named(law, changed)
                })
                .collect(),
            Self::PressureViscosity => [
                PressureViscosityLaw::Gold,
                PressureViscosityLaw::SoKlaus,
                PressureViscosityLaw::Wooster,
            ]
            .iter()
            .map(|law| {
                let mut changed = oil.clone();
                changed.pressure_viscosity.law = *law;
                changed.pressure_viscosity.value = None;
                named(law, changed)
            })
            .collect(),
        }
    }

    /// Its value, SI, at a temperature in degC.
    fn of(self, oil: &Lubricant, temperature: f64) -> f64 {
        let at = oil.oil_at(temperature);
        match self {
            Self::KinematicViscosity => at.nu,
            Self::Density => at.rho,
            Self::PressureViscosity => at.alpha,
        }
    }
}

/// A law with its name in a gearbox.
trait Named {
    fn name(&self) -> String;
}

impl<T: Serialize> Named for T {
    fn name(&self) -> String {
        let value = serde_json::to_value(self).unwrap_or_default();
        value.as_str().unwrap_or_default().to_owned()
    }
}

register_analysis!(OilPropertyEntry);

/// Every law of a property of oils against values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OilPropertyOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// The comparison.
    pub oil_property: PropertyOfOils,
}

/// Laws of a property against values over temperature.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PropertyOfOils {
    /// The property.
    pub property: OilProperty,
    /// Its name as a column.
    #[serde(skip)]
    pub name: &'static str,
    /// Unit of its values.
    pub unit: &'static str,
    /// Name of the file.
    pub file: String,
    /// Number of values. [-]
    pub points: usize,
    /// The laws, those closest to the values first.
    pub laws: Vec<LawOfProperty>,
    /// Laws without a value here, each with the reason.
    pub left_out: Vec<String>,
}

/// One law against the values.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LawOfProperty {
    /// Its name, as in a gearbox.
    pub name: String,
    /// All values together.
    pub all: Cell,
    /// The values by temperature.
    pub regimes: Vec<CellOfRegime>,
    /// The values by oil.
    pub oils: Vec<CellOfOil>,
    /// The values, in the order of the file.
    pub at: Vec<ValueOfOil>,
}

/// The values of one oil.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CellOfOil {
    /// Name of the lubricant.
    pub oil: String,
    /// Its values.
    pub cell: Cell,
}

/// One value and the law.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ValueOfOil {
    /// Line in the file. [-]
    pub line: u64,
    /// Name of the lubricant.
    pub oil: String,
    /// Temperature. [degC]
    pub oil_temperature_degc: f64,
    /// The value of the file. [unit of the property]
    pub measured: f64,
    /// That of the law. [unit of the property]
    pub calculated: f64,
    /// Calculated over measured. [-]
    pub ratio: f64,
    /// Lower and upper end of the 95 % band of the ratio, from the accuracy; absent without. [-]
    pub band: Option<[f64; 2]>,
}

/// A value of the file, SI.
struct Given {
    line: u64,
    oil: String,
    temperature: f64,
    value: f64,
}

/// The oils and the values.
pub struct OilPropertyPlan<'a> {
    built: Arc<Built<'a>>,
    oils: Vec<(String, LubricantEntry)>,
    values: Vec<Given>,
}

impl Plan for OilPropertyPlan<'_> {
    fn work(&self) -> Vec<Work> {
        Vec::new()
    }
}

impl Analysis for OilPropertyEntry {
    const TYPE: &'static str = "oil_property";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = OilPropertyPlan<'a>;
    type Outcome = OilPropertyOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::new(self.gearbox.as_ref(), &[])
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<OilPropertyPlan<'a>, Stopped> {
        let built = cx.built(cx.gearbox(self.gearbox.as_ref())?, &[])?.remove(0);
        let oils = oils(cx, &built)?;
        let values = self.values(cx, &oils)?;
        Ok(OilPropertyPlan { built, oils, values })
    }

    fn reduce<'a>(&'a self, plan: OilPropertyPlan<'a>, engine: &Engine<'a>) -> Result<OilPropertyOutcome, Stopped> {
        let (name, unit, factor) = self.property.measure();
        let names = plan
            .oils
            .first()
            .map_or_else(Vec::new, |(_, oil)| self.property.laws(oil));
        let (mut laws, mut left_out) = (Vec::new(), Vec::new());
        for (k, (law, _)) in names.into_iter().enumerate() {
            match self.judge(&plan, k, factor) {
                Ok(at) => laws.extend(cells(law, at)),
                Err(reason) => left_out.push(format!("{law}: {reason}")),
            }
        }
        if laws.is_empty() {
            let message = format!(
                "no law of the {} has values: {}",
                name.replace('_', " "),
                left_out.join("; ")
            );
            return Err(engine.wrong(&engine.path(), message, "state the property of the lubricants"));
        }
        laws.sort_by(|a, b| a.all.rms_percent.total_cmp(&b.all.rms_percent));
        Ok(OilPropertyOutcome {
            head: engine.head(&[Arc::clone(&plan.built)]),
            oil_property: PropertyOfOils {
                property: self.property,
                name,
                unit,
                file: self.file.clone(),
                points: plan.values.len(),
                laws,
                left_out,
            },
        })
    }
}

/// The lubricants of a gearbox, with the values of catalogues.
fn oils(cx: &Planner<'_>, built: &Built<'_>) -> Result<Vec<(String, LubricantEntry)>, Stopped> {
    let all = built.resolved.value.get("lubricants").and_then(Value::as_object);
    let read = |(name, value): (&String, &Value)| {
        let oil = serde_json::from_value(value.clone());
        let oil = oil.map_err(|e| {
            cx.wrong(
                &cx.path(),
                format!("the lubricant `{name}` cannot be read: {e}"),
                "report this",
            )
        });
        Ok((name.clone(), oil?))
    };
    let oils = all
        .into_iter()
        .flatten()
        .map(read)
        .collect::<Result<Vec<_>, Stopped>>()?;
    if oils.is_empty() {
        return Err(cx.wrong(&cx.path(), "the gearbox has no lubricants", "add `lubricants` to it"));
    }
    Ok(oils)
}

impl OilPropertyEntry {
    /// Reads the values.
    fn values(&self, cx: &Planner<'_>, oils: &[(String, LubricantEntry)]) -> Result<Vec<Given>, Stopped> {
        let place = format!("{}.file", cx.path());
        let bytes = cx.study.read_file(&self.file);
        let bytes = bytes.map_err(|e| {
            let message = format!("{}: cannot read: {e}", self.file);
            cx.wrong_as(codes::DATA, &place, message, "file names are relative to the study")
        })?;
        cx.keep_input(&self.file, &bytes);
        let at = |found: Diagnostic| {
            cx.found(vec![Diagnostic {
                path: place.clone(),
                ..found
            }])
        };
        let columns = Columns::of_file(&self.file, &bytes).map_err(at)?;
        let temperature = Quantity::new("temperature", Measure::Of(Dimension::Temperature), "degC");
        let temperatures = columns.numbers(&temperature).map_err(at)?;
        let values = columns.numbers(&self.property.quantity()).map_err(at)?;
        let names: Vec<&str> = match oils {
            [(only, _)] if !columns.has(&Quantity::plain("oil")) => vec![only.as_str(); values.len()],
            _ => columns.texts("oil").map_err(at)?,
        };
        let known: Vec<&str> = oils.iter().map(|(name, _)| name.as_str()).collect();
        let mut all = Vec::new();
        for (row, ((temperature, value), oil)) in temperatures.into_iter().zip(values).zip(names).enumerate() {
            if !known.contains(&oil) {
                let help = match did_you_mean(oil, known.iter().copied()) {
                    Some(near) => format!("write `{near}`"),
                    None => format!("the lubricants of the gearbox are {}", known.join(", ")),
                };
                return Err(at(columns.wrong(
                    Some(row),
                    &format!("there is no lubricant `{oil}`"),
                    help,
                )));
            }
            all.push(Given {
                line: columns.line(row),
                oil: oil.to_owned(),
                temperature,
                value,
            });
        }
        Ok(all)
    }

    /// A law, by its number, at all values; or why it has none.
    fn judge(&self, plan: &OilPropertyPlan<'_>, law: usize, factor: f64) -> Result<Vec<ValueOfOil>, String> {
        let mut built = Vec::new();
        for (name, entry) in &plan.oils {
            let (_, changed) = self.property.laws(entry).swap_remove(law);
            let oil = Lubricant::new(&changed).map_err(|(_, reason, _)| format!("{name}: {reason}"))?;
            built.push((name, oil));
        }
        let value = |given: &Given| {
            let oil = built.iter().find(|(name, _)| **name == given.oil);
            let (_, oil) = oil.ok_or_else(|| format!("there is no lubricant `{}`", given.oil))?;
            let calculated = self.property.of(oil, given.temperature);
            let ratio = calculated / given.value;
            if !(ratio.is_finite() && ratio > 0.0) {
                return Err(format!("no value at {} degC in line {}", given.temperature, given.line));
            }
            let spread = self.accuracy.map(|accuracy| (BAND * accuracy / 100.0).exp());
            Ok(ValueOfOil {
                line: given.line,
                oil: given.oil.clone(),
                oil_temperature_degc: given.temperature,
                measured: given.value * factor,
                calculated: calculated * factor,
                ratio,
                band: spread.map(|spread| [ratio / spread, ratio * spread]),
            })
        };
        plan.values.iter().map(value).collect()
    }
}

/// The cells of a law.
fn cells(name: String, at: Vec<ValueOfOil>) -> Option<LawOfProperty> {
    let ratio = |i: &usize| Ratio {
        ratio: at[*i].ratio,
        band: at[*i].band,
        in_range: true,
    };
    let cell = |places: &[usize]| Cell::of_ratios(&places.iter().map(ratio).collect::<Vec<_>>(), &[]);
    let temperatures: Vec<f64> = at.iter().map(|value| value.oil_temperature_degc).collect();
    let regime = |([from, to], places): ([f64; 2], Vec<usize>)| {
        Some(CellOfRegime {
            over: "oil_temperature".to_owned(),
            unit: "degC".to_owned(),
            from,
            to,
            cell: cell(&places)?,
        })
    };
    let of_oil = |oil: &String| {
        let places: Vec<usize> = (0..at.len()).filter(|i| at[*i].oil == *oil).collect();
        Some(CellOfOil {
            oil: oil.clone(),
            cell: cell(&places)?,
        })
    };
    Some(LawOfProperty {
        all: cell(&(0..at.len()).collect::<Vec<_>>())?,
        regimes: bands(&temperatures).into_iter().filter_map(regime).collect(),
        oils: distinct(at.iter().map(|value| &value.oil))
            .into_iter()
            .filter_map(of_oil)
            .collect(),
        name,
        at,
    })
}

/// Half-width of a 95 % band in standard deviations.
const BAND: f64 = 1.96;

impl Outcome for OilPropertyOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let found = &self.oil_property;
        let values = Table::of_each(&self.head.analysis, &found.laws, |law| &law.at)
            .text("law", "Law", |(law, _)| &law.name)
            .number("line", "-", "Line in the file", |(_, value)| value.line as f64)
            .text("oil", "Lubricant", |(_, value)| &value.oil)
            .number("oil_temperature_degc", "degC", "Temperature", |(_, value)| {
                value.oil_temperature_degc
            })
            .number("measured", found.unit, "Value of the file", |(_, value)| value.measured)
            .number("calculated", found.unit, "Value of the law", |(_, value)| {
                value.calculated
            })
            .number("ratio", "-", "Calculated over measured", |(_, value)| value.ratio)
            .number("ratio_low", "-", "Lower end of its 95 % band", |(_, value)| {
                value.band.map(|band| band[0])
            })
            .number("ratio_high", "-", "Upper end of its 95 % band", |(_, value)| {
                value.band.map(|band| band[1])
            })
            .finish();
        vec![values]
    }

    fn notes(&self) -> Vec<&Note> {
        Vec::new()
    }
}
