//! Limits of quantities, which points, cycles, designs and oils must keep.

pub mod at_points;
pub(crate) mod limit;
pub mod reached;

use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::{Diagnostic, Dimension, Unit, parse_quantity};
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::rating::Figure;
use gearloss_framework::resolve::meets;
use gearloss_framework::transmission::Transmission;
use serde_json::Value;

use limit::Owner;
pub use limit::{Limit, LimitRecord};

use crate::codes;
use crate::points::OilTemperature;
use crate::study::{LimitEntry, LimitedQuantity, Study};

/// What the limits of a study are read for.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    /// The language of all documents.
    pub language: &'a Language,
    /// The study.
    pub study: &'a Study,
    /// The transmission whose quantities are limited.
    pub transmission: &'a Transmission,
    /// Names of the cycles of the analysis; `None` at points.
    pub cycles: Option<&'a [&'a str]>,
}

/// Units of the quantities of a vehicle, which have no other dimension in documents.
static CONSUMPTION: Unit = plain("kWh/100 km");
static RANGE: Unit = plain("km");

const fn plain(symbol: &'static str) -> Unit {
    Unit {
        symbol,
        dimension: Dimension::None,
        factor: 1.0,
        offset: 0.0,
    }
}

impl Scope<'_> {
    /// Whether a vehicle of the study has a battery.
    fn has_battery(&self) -> bool {
        let mut vehicles = self.study.entry.vehicles.iter();
        vehicles.any(|(_, vehicle)| vehicle.battery.is_some())
    }

    /// Whether the machines of the gearbox lose power under the conditions of the study.
    fn has_machine(&self) -> bool {
        let given = self.study.entry.conditions.oil_temperature;
        let oil = OilTemperature::from_conditions(self.transmission, given);
        let mut machines = self.transmission.active_machines(oil == OilTemperature::Network);
        machines.next().is_some()
    }

    /// The drive unit as what a quantity belongs to.
    fn of_unit(&self, path: &str, (of, stated): (&str, Option<&str>)) -> Result<Owner, Findings> {
        if stated.is_some() {
            return Err(self.wrong(of, "this quantity is that of the drive unit", "delete `of`"));
        }
        if self.has_machine() {
            return Ok(Owner::Unit);
        }
        let message = "the gearbox has no machine, or it belongs to a thermal network that is not used";
        let error = Diagnostic::error(path, message).help("describe it under `machines` of the gearbox");
        Err(self.found(error.code(codes::NO_MACHINE)))
    }

    fn wrong(&self, path: &str, message: impl Into<String>, help: &str) -> Findings {
        self.found(Diagnostic::error(path, message.into()).help(help).code(codes::ANALYSIS))
    }

    fn found(&self, error: Diagnostic) -> Findings {
        self.study.findings(vec![error])
    }
}

impl Limit {
    /// The limits of an analysis at a path, after those of the study whose names it does not use.
    ///
    /// # Errors
    /// Everything that is wrong in the first wrong entry.
    pub fn all(scope: Scope<'_>, path: &str, entries: &Ordered<LimitEntry>) -> Result<Vec<Self>, Findings> {
        let mut all = Self::of_study(scope)?;
        all.retain(|limit| entries.get(&limit.name).is_none());
        for (name, entry) in entries.iter() {
            all.push(Self::new(scope, &format!("{path}.limits.{name}"), name, entry)?);
        }
        Ok(all)
    }

    /// The limits of the study.
    ///
    /// # Errors
    /// Everything that is wrong in the first wrong entry.
    pub fn of_study(scope: Scope<'_>) -> Result<Vec<Self>, Findings> {
        let entries = scope.study.entry.limits.iter();
        entries
            .map(|(name, entry)| Self::new(scope, &format!("limits.{name}"), name, entry))
            .collect()
    }

    fn new(scope: Scope<'_>, path: &str, name: &str, entry: &LimitEntry) -> Result<Self, Findings> {
        let t = scope.transmission;
        let rated = match (entry.quantity, &entry.rating) {
            (LimitedQuantity::Rating, Some(rating)) => Some(known_rating(scope, &format!("{path}.rating"), rating)?),
            (LimitedQuantity::Rating, None) => {
                let help = "write for example `rating: iso_281.L10h`";
                return Err(scope.wrong(path, "`rating` is missing", help));
            }
            (_, Some(_)) => {
                let message = "`rating` belongs to the quantity `rating`";
                return Err(scope.wrong(
                    &format!("{path}.rating"),
                    message,
                    "write `quantity: rating`, or delete it",
                ));
            }
            (_, None) => None,
        };
        let symbol = rated.map_or(entry.quantity.unit(), |(_, figure)| figure.unit);
        let unit = Unit::of_symbol(symbol).unwrap_or(match entry.quantity {
            LimitedQuantity::Consumption => &CONSUMPTION,
            LimitedQuantity::Range => &RANGE,
            _ => Unit::ONE,
        });
        let of = &format!("{path}.of");
        let of = match (entry.quantity, entry.of.as_deref()) {
            (LimitedQuantity::Temperature, Some(node)) if !entry.is_of_oil() => {
                Owner::Node(known_node(scope, of, node)?)
            }
            (LimitedQuantity::Temperature, _) => Owner::Oil,
            (LimitedQuantity::Consumption | LimitedQuantity::Range, _) if !scope.has_battery() => {
                let message = "consumption and range need a vehicle with a battery";
                let help = "add `vehicles: { car: { ..., battery: { energy: 60 kWh, efficiency: 0.95 } } }`";
                return Err(scope.wrong(path, message, help));
            }
            (LimitedQuantity::MeanLoss | LimitedQuantity::Consumption | LimitedQuantity::Range, None) => {
                Owner::AllCycles
            }
            (LimitedQuantity::MeanLoss | LimitedQuantity::Consumption | LimitedQuantity::Range, Some(name)) => {
                known_cycle(scope, of, name)?
            }
            (LimitedQuantity::Loss | LimitedQuantity::Efficiency, None) => Owner::Gearbox,
            (LimitedQuantity::Loss | LimitedQuantity::Efficiency, Some(_)) => {
                return Err(scope.wrong(of, "a loss and an efficiency are those of the gearbox", "delete `of`"));
            }
            (LimitedQuantity::Rating, component) => Owner::Rating {
                rating: rated.map_or("", |(rating, _)| rating),
                symbol: rated.map_or("", |(_, figure)| figure.symbol),
                components: known_components(scope, of, component.unwrap_or("*"))?,
            },
            (LimitedQuantity::Ratio, None) => Owner::Gear(0),
            (LimitedQuantity::Ratio, Some(gear)) => {
                let names: Vec<&str> = t.states().iter().map(|state| state.name.as_str()).collect();
                let place = names.iter().position(|known| *known == gear);
                Owner::Gear(place.ok_or_else(|| scope.found(dangling(of, "gear state", gear, &names)))?)
            }
            // All others are those of the drive unit.
            (_, stated) => scope.of_unit(path, (of, stated))?,
        };
        let bound = |key: &str, value: &Option<Value>| -> Result<Option<f64>, Findings> {
            let number = value.as_ref().map(|value| quantity(value, unit));
            let help = format!("write it as a {}", unit.dimension.name());
            let number = number.transpose();
            number.map_err(|reason| scope.wrong(&format!("{path}.{key}"), reason, &help))
        };
        let bounds = [bound("least", &entry.least)?, bound("most", &entry.most)?];
        match bounds {
            [None, None] => Err(scope.wrong(
                path,
                "a limit needs `least` or `most`",
                "write for example `most: 110 degC`",
            )),
            bounds
                if matches!(
                    entry.quantity,
                    LimitedQuantity::Efficiency | LimitedQuantity::SystemEfficiency
                ) && bounds.iter().flatten().any(|bound| !(0.0..=1.0).contains(bound)) =>
            {
                let help = "write it as a number, such as `least: 0.95`";
                Err(scope.wrong(path, "an efficiency is between 0 and 1", help))
            }
            [Some(least), Some(most)] if least > most => {
                let message = format!("no value is above {least} and below {most}");
                Err(scope.wrong(path, message, "exchange `least` and `most`"))
            }
            _ => Ok(Self {
                name: name.to_owned(),
                words: words(entry, rated.map(|(_, figure)| figure)),
                unit,
                bounds,
                severity: entry.severity,
                quantity: entry.quantity,
                of,
            }),
        }
    }
}

/// A cycle of an analysis; one of the study that the analysis does not have limits nothing.
fn known_cycle(scope: Scope<'_>, path: &str, name: &str) -> Result<Owner, Findings> {
    let of_study = || scope.study.entry.cycles.ids().collect::<Vec<_>>();
    if let Some(place) = scope
        .cycles
        .and_then(|cycles| cycles.iter().position(|known| *known == name))
    {
        return Ok(Owner::Cycle(place));
    }
    if path.starts_with("limits.") && of_study().contains(&name) {
        return Ok(Owner::OtherCycle);
    }
    match scope.cycles {
        Some(cycles) => Err(scope.found(dangling(path, "cycle of this analysis", name, cycles))),
        None => Err(scope.found(dangling(path, "cycle of this study", name, &of_study()))),
    }
}

/// A pattern of components, which one of the gearbox meets. In a study with several gearboxes it may belong to another one.
fn known_components(scope: Scope<'_>, path: &str, pattern: &str) -> Result<String, Findings> {
    let parts = || scope.transmission.parts().iter().map(|part| part.path.as_str());
    if pattern == "*" || parts().any(|part| meets(pattern, part)) || scope.study.gearboxes.len() > 1 {
        return Ok(pattern.to_owned());
    }
    let names: Vec<&str> = parts().collect();
    Err(scope.found(dangling(path, "component", pattern, &names)))
}

fn known_node(scope: Scope<'_>, path: &str, node: &str) -> Result<String, Findings> {
    let names: Vec<&str> = match scope.transmission.network() {
        Some(network) => network.names().iter().map(String::as_str).collect(),
        None => vec!["oil"],
    };
    if names.contains(&node) {
        return Ok(node.to_owned());
    }
    Err(scope.found(dangling(path, "node", node, &names)))
}

/// A rating and its quantity, of `RATING.SYMBOL`.
fn known_rating(scope: Scope<'_>, path: &str, written: &str) -> Result<(&'static str, Figure), Findings> {
    let (rating, symbol) = written.split_once('.').unwrap_or((written, ""));
    let plugin = scope.language.registry().rating_named(rating).map_err(|error| {
        scope.found(Diagnostic {
            path: path.to_owned(),
            ..error
        })
    })?;
    let figure = plugin.figures.iter().find(|figure| figure.symbol == symbol);
    let figure = figure.ok_or_else(|| {
        let symbols: Vec<&str> = plugin.figures.iter().map(|figure| figure.symbol).collect();
        scope.found(dangling(path, "quantity of this rating", symbol, &symbols))
    })?;
    Ok((plugin.entry.name, *figure))
}

/// A bound in a unit.
fn quantity(written: &Value, unit: &'static Unit) -> Result<f64, String> {
    let number = match written {
        Value::Number(x) => x.as_f64(),
        Value::String(text) => {
            // Units of quantities of a vehicle are known here alone.
            let plain = text
                .trim()
                .strip_suffix(unit.symbol)
                .filter(|_| unit.dimension == Dimension::None);
            match plain.and_then(|number| number.trim().parse().ok()) {
                Some(number) => Some(number),
                None => Some(unit.from_si(parse_quantity(text, unit).map_err(|fault| fault.message)?)),
            }
        }
        _ => None,
    };
    let number = number.filter(|x| x.is_finite());
    number.ok_or_else(|| format!("{written} is not a valid {}", unit.dimension.name()))
}

/// What is limited, in words; with the quantity of a rating.
fn words(entry: &LimitEntry, figure: Option<Figure>) -> String {
    let of = |default: &str| entry.of.clone().unwrap_or_else(|| default.to_owned());
    match entry.quantity {
        LimitedQuantity::Temperature => format!("temperature of {}", of("the oil")),
        LimitedQuantity::Loss => "loss".to_owned(),
        LimitedQuantity::DcPower => "power of the DC link".to_owned(),
        LimitedQuantity::MachineLoss => "loss of machines and inverters".to_owned(),
        LimitedQuantity::UnitLoss => "loss of the drive unit".to_owned(),
        LimitedQuantity::SystemEfficiency => "efficiency of the drive unit".to_owned(),
        LimitedQuantity::Efficiency => "efficiency".to_owned(),
        LimitedQuantity::MeanLoss => format!("mean loss over {}", of("every cycle")),
        LimitedQuantity::Consumption => format!("consumption over {}", of("every cycle")),
        LimitedQuantity::Range => format!("range over {}", of("every cycle")),
        LimitedQuantity::Ratio => format!("ratio of gear {}", of("1")),
        LimitedQuantity::Rating => {
            let of = entry.of.as_ref().map_or_else(String::new, |of| format!(" of {of}"));
            match figure {
                Some(figure) => format!("{} {}{of}", figure.meaning, figure.symbol),
                None => format!("{}{of}", entry.rating.as_deref().unwrap_or_default()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Severity;

    #[test]
    fn the_worst_value_is_the_one_beyond_either_bound() {
        let limit = |bounds| Limit {
            name: String::new(),
            words: String::new(),
            unit: Unit::ONE,
            bounds,
            severity: Severity::Warning,
            quantity: LimitedQuantity::MeanLoss,
            of: Owner::AllCycles,
        };
        let worst = |bounds, values: [f64; 3]| limit(bounds).worst(values.into_iter());
        assert_eq!(worst([Some(2.0), Some(9.0)], [1.0, 5.0, 8.0]), 1.0);
        assert_eq!(worst([Some(2.0), Some(9.0)], [3.0, 5.0, 10.0]), 10.0);
        assert_eq!(worst([Some(2.0), Some(9.0)], [4.0, 5.0, 8.0]), 8.0);
        assert_eq!(worst([Some(2.0), None], [4.0, 5.0, 8.0]), 4.0);
        assert_eq!(worst([None, Some(9.0)], [4.0, 5.0, 8.0]), 8.0);
        assert!(limit([None, Some(9.0)]).worst(std::iter::empty()).is_nan());
        assert!(limit([None, Some(9.0)]).violation(f64::NAN).is_infinite());
    }
}
