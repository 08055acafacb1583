//! Limits that a design must keep.

use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::{Dimension, Unit, parse_quantity};
use gearloss_framework::thermal::network::Network;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::analyses::duties::{Duties, nodes};
use crate::analyses::{Built, Context, Stopped};
use crate::points::Driven;

/// A bound of a quantity over all cycles.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct LimitEntry {
    /// Limited quantity.
    pub quantity: LimitedQuantity,
    /// What it belongs to: a node of the thermal network, a cycle, a gear. Default: the oil, all cycles, the first gear.
    pub of: Option<String>,
    /// Least allowed value, with its unit: `20 degC`.
    pub least: Option<Value>,
    /// Greatest allowed value, with its unit: `110 degC`.
    pub most: Option<Value>,
}

/// A quantity that can be limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LimitedQuantity {
    /// The highest temperature of a node in any cycle, or the lowest for a least value.
    Temperature,
    /// The mean loss of a cycle.
    MeanLoss,
    /// The ratio of a gear: speed of the reference port over that of the first other port.
    Ratio,
}

impl LimitedQuantity {
    /// Its unit.
    fn unit(self) -> &'static Unit {
        let symbol = match self {
            Self::Temperature => "degC",
            Self::MeanLoss => "W",
            Self::Ratio => "-",
        };
        Unit::of_symbol(symbol).unwrap_or(Unit::ONE)
    }
}

/// A limit as read.
pub struct Limit {
    /// Name in the study.
    pub name: String,
    /// What is limited, in words.
    pub words: String,
    /// Its unit.
    pub unit: &'static Unit,
    /// Least and greatest allowed value, in the unit.
    pub bounds: [Option<f64>; 2],
    quantity: LimitedQuantity,
    /// Name of the node; index of the cycle; index of the gear.
    of: Owner,
}

enum Owner {
    Node(String),
    Oil,
    Cycle(usize),
    AllCycles,
    Gear(usize),
}

/// The index of a cycle of an analysis.
pub fn cycle(cx: &Context<'_>, path: &str, name: &str, duties: &Duties<'_>) -> Result<usize, Stopped> {
    let names: Vec<&str> = duties.list.iter().map(|read| read.name.as_str()).collect();
    let place = names.iter().position(|own| *own == name);
    place.ok_or_else(|| cx.found(vec![dangling(path, "cycle of this analysis", name, &names)]))
}

impl Limit {
    /// The limits of an analysis at a path.
    pub fn all(
        cx: &Context<'_>,
        path: &str,
        entries: &Ordered<LimitEntry>,
        duties: &Duties<'_>,
        b: &Built<'_>,
    ) -> Result<Vec<Self>, Stopped> {
        let entries = entries.iter();
        entries
            .map(|(name, entry)| Self::new(cx, &format!("{path}.limits.{name}"), name, entry, duties, b))
            .collect()
    }

    fn new(
        cx: &Context<'_>,
        path: &str,
        name: &str,
        entry: &LimitEntry,
        duties: &Duties<'_>,
        b: &Built<'_>,
    ) -> Result<Self, Stopped> {
        let unit = entry.quantity.unit();
        let t = &b.transmission;
        let of = &format!("{path}.of");
        let of = match (entry.quantity, entry.of.as_deref()) {
            (LimitedQuantity::Temperature, None) => Owner::Oil,
            (LimitedQuantity::Temperature, Some(node)) => Owner::Node(known_node(cx, of, node, t)?),
            (LimitedQuantity::MeanLoss, None) => Owner::AllCycles,
            (LimitedQuantity::MeanLoss, Some(name)) => Owner::Cycle(cycle(cx, of, name, duties)?),
            (LimitedQuantity::Ratio, None) => Owner::Gear(0),
            (LimitedQuantity::Ratio, Some(gear)) => {
                let names: Vec<&str> = t.states().iter().map(|state| state.name.as_str()).collect();
                let place = names.iter().position(|own| *own == gear);
                Owner::Gear(place.ok_or_else(|| cx.found(vec![dangling(of, "gear state", gear, &names)]))?)
            }
        };
        let bound = |key: &str, value: &Option<Value>| -> Result<Option<f64>, Stopped> {
            let number = value.as_ref().map(|value| quantity(value, unit));
            let help = format!("write it as a {}", unit.dimension.name());
            let number = number.transpose();
            number.map_err(|reason| cx.wrong(&format!("{path}.{key}"), reason, &help))
        };
        let bounds = [bound("least", &entry.least)?, bound("most", &entry.most)?];
        match bounds {
            [None, None] => Err(cx.wrong(
                path,
                "a limit needs `least` or `most`",
                "write for example `most: 110 degC`",
            )),
            [Some(least), Some(most)] if least > most => {
                let message = format!("no value is above {least} and below {most}");
                Err(cx.wrong(path, message, "exchange `least` and `most`"))
            }
            _ => Ok(Self {
                name: name.to_owned(),
                words: words(entry),
                unit,
                bounds,
                quantity: entry.quantity,
                of,
            }),
        }
    }

    /// The limited value of a driven design, in the unit: of the worst moment.
    pub fn value(&self, t: &Transmission, driven: &[Driven]) -> Option<f64> {
        match (&self.of, self.quantity) {
            (Owner::Gear(gear), _) => t.ratios(*gear).first().and_then(|(_, ratio)| *ratio).map(f64::abs),
            (Owner::Cycle(cycle), _) => mean_loss(&driven[*cycle]),
            (Owner::AllCycles, _) => {
                let all = driven.iter().map(mean_loss).collect::<Option<Vec<f64>>>()?;
                Some(self.worst(all.into_iter()))
            }
            (Owner::Oil | Owner::Node(_), _) => {
                let node = match &self.of {
                    Owner::Node(name) => nodes(t, driven.first()?).iter().position(|own| own == name)?,
                    _ => t.network().map_or(0, Network::oil),
                };
                let all = driven.iter().flat_map(|own| {
                    let ends = own.stretches.iter().map(|stretch| &stretch.temperatures);
                    ends.filter_map(|all| all.get(node).or(all.first()).copied())
                });
                Some(self.worst(all))
            }
        }
    }

    /// The value closest to the limit, or farthest beyond it.
    fn worst(&self, values: impl Iterator<Item = f64>) -> f64 {
        if self.bounds[1].is_some() {
            values.fold(f64::NEG_INFINITY, f64::max)
        } else {
            values.fold(f64::INFINITY, f64::min)
        }
    }

    /// How far a value is beyond the limit, as a share of the bound, or of 10 K for temperatures; zero if the limit is kept.
    pub fn violation(&self, value: f64) -> f64 {
        let beyond = match self.bounds {
            [Some(least), _] if value < least => least - value,
            [_, Some(most)] if value > most => value - most,
            _ if value.is_nan() => f64::INFINITY,
            _ => return 0.0,
        };
        let scale = match self.unit.dimension {
            Dimension::Temperature => 10.0,
            _ => self
                .bounds
                .iter()
                .flatten()
                .fold(f64::MIN_POSITIVE, |sum, bound| sum.max(bound.abs())),
        };
        beyond / scale
    }
}

/// Mean loss of a cycle. \[W\]
pub fn mean_loss(driven: &Driven) -> Option<f64> {
    let time = driven.total.duration;
    (time > 0.0 && driven.broken.is_none()).then(|| driven.total.parts.iter().sum::<f64>() / time)
}

fn known_node(cx: &Context<'_>, path: &str, node: &str, t: &Transmission) -> Result<String, Stopped> {
    let names: Vec<&str> = match t.network() {
        Some(network) => network.names().iter().map(String::as_str).collect(),
        None => vec!["oil"],
    };
    if names.contains(&node) {
        return Ok(node.to_owned());
    }
    Err(cx.found(vec![dangling(path, "node", node, &names)]))
}

/// A bound in a unit.
fn quantity(written: &Value, unit: &'static Unit) -> Result<f64, String> {
    let number = match written {
        Value::Number(x) => x.as_f64(),
        Value::String(text) => Some(unit.from_si(parse_quantity(text, unit).map_err(|fault| fault.message)?)),
        _ => None,
    };
    let number = number.filter(|x| x.is_finite());
    number.ok_or_else(|| format!("{written} is not a valid {}", unit.dimension.name()))
}

fn words(entry: &LimitEntry) -> String {
    let of = |default: &str| entry.of.clone().unwrap_or_else(|| default.to_owned());
    match entry.quantity {
        LimitedQuantity::Temperature => format!("temperature of {}", of("the oil")),
        LimitedQuantity::MeanLoss => format!("mean loss over {}", of("every cycle")),
        LimitedQuantity::Ratio => format!("ratio of gear {}", of("1")),
    }
}
