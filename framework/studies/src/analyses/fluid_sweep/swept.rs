//! The varied property of an oil, and its overrides in a gearbox.

use gearloss_framework::attach::dangling;
use gearloss_framework::description::LubricantEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::lubricant::index::{at_constant_index, index};
use gearloss_framework::resolve::lookup;
use serde_json::{Value, json};

use super::FluidSweepEntry;
use crate::analyses::{Built, Planner, Stopped};
use crate::varied::{Tie, Varied};

/// Kinematic viscosity at 100 degC below which the viscosity index is not defined. \[mm2/s\]
const DEFINED: f64 = 2.0;

/// The varied property.
pub enum Swept {
    /// The viscosity, at a constant index. Path of the oil, its viscosity in mm2/s at 100 degC, and the other keys of its viscosity.
    Viscosity {
        oil: String,
        present: Option<f64>,
        index: f64,
        law: Value,
        factor: Value,
    },
    /// A quantity.
    Property(Varied),
}

impl Swept {
    pub fn new(cx: &Planner<'_>, path: &str, entry: &FluidSweepEntry, b: &Built<'_>) -> Result<Self, Stopped> {
        let described = lookup(&b.resolved.value, "housing.oil.lubricant").and_then(Value::as_str);
        let names: Vec<&str> = b.resolved.value["lubricants"]
            .as_object()
            .into_iter()
            .flatten()
            .map(|(k, _)| k.as_str())
            .collect();
        let oil = entry
            .lubricant
            .as_deref()
            .or(described)
            .or(names.first().copied())
            .unwrap_or_default();
        if !names.contains(&oil) {
            let error = dangling(&format!("{path}.lubricant"), "lubricant", oil, &names);
            return Err(cx.found(vec![error]));
        }
        let oil = format!("lubricants.{oil}");
        if let Some(property) = &entry.property {
            let varied = Varied::new(cx.language, &b.resolved, &format!("{oil}.{property}"), Tie::Value);
            return varied.map(Self::Property).map_err(|d| {
                let at = Diagnostic {
                    path: format!("{path}.property"),
                    ..d
                };
                cx.found(vec![at])
            });
        }
        let present = viscosities(&b.resolved.value, &oil);
        let index = entry
            .vi
            .or_else(|| present.and_then(|[kv40, kv100]| index(kv40, kv100)))
            .ok_or_else(|| {
                cx.wrong(
                    &format!("{path}.vi"),
                    format!("`{oil}` has no viscosity index"),
                    "state the common index of all oils",
                )
            })?;
        let viscosity = lookup(&b.resolved.value, &format!("{oil}.viscosity"));
        let of = |key: &str| viscosity.and_then(|v| v.get(key)).cloned().unwrap_or(Value::Null);
        Ok(Self::Viscosity {
            law: of("law"),
            factor: of("factor"),
            oil,
            present: present.map(|[_, kv100]| kv100),
            index,
        })
    }

    /// Listed values, ascending.
    pub fn values(&self, cx: &Planner<'_>, path: &str, entry: &FluidSweepEntry) -> Result<Vec<f64>, Stopped> {
        let mut values = match self {
            Self::Viscosity { .. } => entry.kv100.iter().map(|nu| nu * 1e6).collect(),
            Self::Property(varied) => entry
                .values
                .iter()
                .map(|value| varied.quantity(value, false))
                .collect::<Result<Vec<f64>, String>>()
                .map_err(|reason| {
                    cx.wrong(
                        &format!("{path}.values"),
                        reason,
                        "write quantities of the property, such as `5 MPa`",
                    )
                })?,
        };
        values.sort_by(f64::total_cmp);
        values.dedup();
        if values.len() < 3 {
            let (key, help) = match self {
                Self::Viscosity { .. } => (
                    "kv100",
                    "list viscosities, such as `kv100: [2 mm2/s, 4 mm2/s, 6 mm2/s]`",
                ),
                Self::Property(_) => ("values", "list values, each as in a gearbox"),
            };
            return Err(cx.wrong(&format!("{path}.{key}"), "a sweep needs three different values", help));
        }
        Ok(values)
    }

    pub fn overrides(&self, value: f64) -> Result<Vec<(String, Value)>, String> {
        match self {
            Self::Viscosity {
                oil,
                index,
                law,
                factor,
                ..
            } => {
                let kv40 = at_constant_index(value, *index)
                    .ok_or_else(|| format!("an oil with {value} mm2/s cannot have the viscosity index {index}"))?;
                // The law of viscosity over temperature is defined from 2 mm2/s.
                let law = if value < DEFINED {
                    json!("astm_d341_low")
                } else {
                    law.clone()
                };
                let mut viscosity = json!({ "kv40": kv40, "kv100": value });
                for (key, stated) in [("law", law), ("factor", factor.clone())] {
                    if !stated.is_null() {
                        viscosity[key] = stated;
                    }
                }
                Ok(vec![(format!("{oil}.viscosity"), viscosity)])
            }
            Self::Property(varied) => Ok(varied.overrides(value).collect()),
        }
    }

    /// Name of the property with its unit.
    pub fn name(&self) -> String {
        match self {
            Self::Viscosity { index, .. } => format!("kv100 in mm2/s at a viscosity index of {index:.1}"),
            Self::Property(varied) => format!("{} in {}", varied.pattern, varied.unit.symbol),
        }
    }

    /// Value of the description.
    pub fn present(&self) -> Option<f64> {
        match self {
            Self::Viscosity { present, .. } => *present,
            Self::Property(varied) => varied.start(),
        }
    }

    /// Unit of the property.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Viscosity { .. } => "mm2/s",
            Self::Property(varied) => varied.unit.symbol,
        }
    }

    /// True if the property is not defined.
    pub fn is_beyond(&self, value: f64) -> bool {
        matches!(self, Self::Viscosity { .. }) && value < DEFINED
    }
}

/// Kinematic viscosities of an oil of a resolved document at 40 and 100 degC. \[mm2/s\]
fn viscosities(document: &Value, oil: &str) -> Option<[f64; 2]> {
    let entry: LubricantEntry = serde_json::from_value(lookup(document, oil)?.clone()).ok()?;
    let lubricant = Lubricant::new(&entry).ok()?;
    Some([40.0, 100.0].map(|t| lubricant.oil_at(t).nu * 1e6))
}
