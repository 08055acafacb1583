//! Identified parameters: targets, start values and bounds.

use crate::codes;
use serde_json::{Value, json};

use crate::measured::Rig;
use crate::study::{IdentifiedEntry, OverEntry, PriorEntry, ScaleEntry};
use crate::varied::{Varied, words};
use gearloss_framework::document::{Diagnostic, Dimension, Unit, parse_quantity};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Resolved, lookup};
use gearloss_numerics::inference;
use gearloss_numerics::least_squares::{self, Prior};

/// A quantity of the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigQuantity {
    /// Offset of the torque meter at `in`.
    OffsetIn,
    /// Offset of the torque meter at `out`.
    OffsetOut,
    /// Drag torque of the rig's bearings at `in`.
    SupportIn,
    /// Drag torque of the rig's bearings at `out`.
    SupportOut,
}

const RIG: [(&str, RigQuantity); 4] = [
    ("rig.torque_offset_in", RigQuantity::OffsetIn),
    ("rig.torque_offset_out", RigQuantity::OffsetOut),
    ("rig.support_in.torque", RigQuantity::SupportIn),
    ("rig.support_out.torque", RigQuantity::SupportOut),
];

impl RigQuantity {
    /// Its place in a rig. \[Nm\]
    fn place(self, rig: &mut Rig) -> &mut f64 {
        match self {
            Self::OffsetIn => &mut rig.offset[0],
            Self::OffsetOut => &mut rig.offset[1],
            Self::SupportIn => &mut rig.support[0].torque,
            Self::SupportOut => &mut rig.support[1].torque,
        }
    }

    /// Whether it belongs to `out`.
    pub fn is_out(self) -> bool {
        matches!(self, Self::OffsetOut | Self::SupportOut)
    }
}

/// Target of a parameter.
#[derive(Debug, Clone)]
pub enum Target {
    /// Quantities of the gearbox.
    Path(Varied),
    /// Load factors over the torque of a port: this one is for one of the torques.
    Over {
        /// The factors.
        varied: Varied,
        /// Port of the torque.
        port: String,
        /// All torques. \[Nm\]
        torques: Vec<f64>,
        /// Number of the torque.
        place: usize,
    },
    /// A quantity of the rig. \[Nm\]
    Rig(RigQuantity),
}

/// An identified parameter; numbers are in the unit of its path.
#[derive(Debug, Clone)]
pub struct Identified {
    /// Name.
    pub name: String,
    /// The path as written.
    pub path: String,
    /// Target.
    pub target: Target,
    /// Unit of its numbers.
    pub unit: &'static Unit,
    /// Value of the gearbox or the rig before the fit; absent if not stated.
    pub stated: Option<f64>,
    /// Start value.
    pub start: f64,
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// Scale.
    pub scale: ScaleEntry,
    /// Prior.
    pub prior: Option<Prior>,
    /// Reference size of its interval if its value may be zero: `usual_size` for a path; for an offset of a torque meter the median of the
    /// measured loss torques.
    pub size: Option<f64>,
}

/// Reference length for intervals of a length that may be zero, such as an offset of the oil level. An assumption: about the tooth depth
/// and immersion depth of car gears. \[m\]
const LENGTH: f64 = 0.01;
/// The same for a temperature. An assumption: changes the viscosity of oils by a third. \[K\]
const TEMPERATURE: f64 = 10.0;

/// Reference size of an interval, in the unit of a path whose values may have either sign; absent if the value provides it.
fn usual_size(unit: &Unit, range: [f64; 2]) -> Option<f64> {
    let signed = range[0] < 0.0 && range[1] > 0.0;
    match unit.dimension {
        Dimension::Temperature | Dimension::TemperatureDifference => Some(TEMPERATURE / unit.factor),
        Dimension::Length if signed => Some(LENGTH / unit.factor),
        Dimension::None if signed => Some(1.0),
        _ => None,
    }
}

/// An error at a key of a parameter.
fn fault(name: &str, key: &str, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
    Diagnostic::error(format!("parameters.{name}.{key}"), message)
        .help(help)
        .code(codes::VARIED)
}

/// An entry of the study.
#[derive(Clone, Copy)]
struct Written<'e> {
    name: &'e str,
    entry: &'e IdentifiedEntry,
}

/// What a path refers to.
struct Identifiable {
    target: Target,
    unit: &'static Unit,
    /// Value of the gearbox or the rig. [unit]
    stated: Option<f64>,
    /// Range of the schema. [unit]
    range: [f64; 2],
}

impl Written<'_> {
    /// An error at a key of the entry.
    fn fault(self, key: &str, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
        fault(self.name, key, message, help)
    }

    fn what(self, rig: &Rig, (language, resolved): (&Language, &Resolved)) -> Result<Identifiable, Diagnostic> {
        let together = !self.entry.paths.is_empty() || !self.entry.values.is_empty();
        let path = match &self.entry.path {
            Some(_) if together => {
                let message = "both `path` and `paths` with `values` are stated";
                return Err(self.fault("path", message, "delete one of them"));
            }
            Some(path) => path,
            None if together => {
                let varied = Varied::along(language, resolved, &self.entry.paths, &self.entry.values);
                let varied = varied.map_err(|(key, message, help)| self.fault(&key, message, help))?;
                if self.entry.over.is_some() {
                    return Err(self.fault("over", "`over` belongs to one load factor", "delete it"));
                }
                return Ok(Identifiable {
                    unit: varied.unit,
                    stated: varied
                        .start()
                        .filter(|start| (varied.range[0]..=varied.range[1]).contains(start)),
                    range: varied.range,
                    target: Target::Path(varied),
                });
            }
            None => {
                let help = "add `path`, or several `paths` with `values`";
                return Err(self.fault("path", "no path is stated", help));
            }
        };
        if !path.starts_with("rig.") {
            let varied = Varied::new(language, resolved, path, self.entry.tie).map_err(|error| Diagnostic {
                message: format!("`{path}`: {}", error.message),
                path: format!("parameters.{}.path", self.name),
                ..error
            })?;
            return Ok(Identifiable {
                unit: varied.unit,
                stated: varied.start(),
                range: varied.range,
                target: Target::Path(varied),
            });
        }
        let Some((_, quantity)) = RIG.iter().find(|(known, _)| known == path) else {
            let names = RIG.map(|(path, _)| path).join(", ");
            let message = format!("`{path}` is not an identifiable quantity of a rig");
            return Err(self.fault("path", message, format!("write one of {names}")));
        };
        let least = match quantity {
            RigQuantity::OffsetIn | RigQuantity::OffsetOut => f64::NEG_INFINITY,
            RigQuantity::SupportIn | RigQuantity::SupportOut => 0.0,
        };
        Ok(Identifiable {
            target: Target::Rig(*quantity),
            unit: Unit::of_symbol("Nm").unwrap_or(Unit::ONE),
            stated: Some(*quantity.place(&mut rig.clone())),
            range: [least, f64::INFINITY],
        })
    }

    /// The value at a key. [unit]
    fn quantity(self, what: &Identifiable, key: &str, value: &Value) -> Result<f64, Diagnostic> {
        read(&what.target, what.unit, value)
            .map_err(|reason| self.fault(key, reason, "write a quantity of the path, such as `0.3 um`"))
    }

    /// A bound: written, or from the schema.
    fn bound(
        self,
        what: &Identifiable,
        key: &str,
        value: Option<&Value>,
        (schema, name): (f64, &str),
    ) -> Result<f64, Diagnostic> {
        match value {
            Some(value) => self.quantity(what, key, value),
            None if schema.is_finite() => Ok(schema),
            None => {
                let message = format!("the {name} of `{}` is unknown", self.entry.words());
                Err(self.fault("path", message, format!("add `{key}: ...`")))
            }
        }
    }

    fn bounds(self, what: &Identifiable) -> Result<[f64; 2], Diagnostic> {
        let (entry, range) = (self.entry, what.range);
        let bounds = [
            self.bound(what, "from", entry.from.as_ref(), (range[0], "lower bound"))?,
            self.bound(what, "to", entry.to.as_ref(), (range[1], "upper bound"))?,
        ];
        let [from, to] = bounds.map(|x| words(what.unit, x));
        if bounds[0] > bounds[1] {
            let message = format!("the bounds are reversed: from {from} to {to}");
            return Err(self.fault("to", message, "exchange `from` and `to`"));
        }
        if bounds[0] < range[0] || bounds[1] > range[1] {
            let key = if bounds[0] < range[0] { "from" } else { "to" };
            let [least, greatest] = range.map(|x| words(what.unit, x));
            let message = format!("{from} to {to} is outside the range of the path, {least} to {greatest}");
            return Err(self.fault(key, message, "narrow the bounds"));
        }
        if entry.scale == ScaleEntry::Log && bounds[0] <= 0.0 {
            let message = format!("a logarithmic scale needs a positive lower bound, not {from}");
            let help = "write `from:` with a positive value, or `scale: linear`";
            return Err(self.fault("scale", message, help));
        }
        Ok(bounds)
    }

    /// The start value: written, or stated by the gearbox or the rig.
    fn start(self, what: &Identifiable, bounds: [f64; 2], stated: Option<f64>) -> Result<f64, Diagnostic> {
        let Some(value) = &self.entry.start else {
            let missing = || self.fault("path", "the gearbox states no start value", "add `start: ...`");
            // Between the rows, if the gearbox is on none of them.
            let between = self.entry.path.is_none().then_some(0.5 * (bounds[0] + bounds[1]));
            return stated.or(between).ok_or_else(missing);
        };
        let start = self.quantity(what, "start", value)?;
        if start < bounds[0] || start > bounds[1] {
            let [start, from, to] = [start, bounds[0], bounds[1]].map(|x| words(what.unit, x));
            let message = format!("{start} is outside {from} to {to}");
            return Err(self.fault("start", message, "choose a start within the bounds"));
        }
        Ok(start)
    }

    fn prior(self, what: &Identifiable, bounds: [f64; 2], start: f64) -> Result<Option<Prior>, Diagnostic> {
        let Some(prior) = &self.entry.prior else {
            return Ok(None);
        };
        let prior = prior_of(prior, &what.target, what.unit, self.entry.scale, start).map_err(|(key, reason)| {
            let help = "write a positive quantity of the path; for `scale: log` a number, relative to the mean";
            self.fault(&format!("prior.{key}"), reason, help)
        })?;
        if prior.mean < bounds[0] || prior.mean > bounds[1] {
            let [mean, from, to] = [prior.mean, bounds[0], bounds[1]].map(|x| words(what.unit, x));
            let message = format!("its mean, {mean}, is outside {from} to {to}");
            return Err(self.fault("prior", message, "widen the bounds, or correct the mean"));
        }
        Ok(Some(prior))
    }

    /// The parameters of a curve: one factor for each torque, each at its value of the curve that the gearbox states.
    fn over_torques(
        self,
        over: &OverEntry,
        one: Identified,
        curve: Option<&[f64]>,
    ) -> Result<Vec<Identified>, Diagnostic> {
        let Target::Path(varied) = &one.target else {
            return Err(self.fault("over", "a quantity of the rig is one number", "delete `over`"));
        };
        let path = &self.entry.words();
        if !path.ends_with(".radial_factor") && !path.ends_with(".axial_factor") {
            let message = format!("`{path}` is not a load factor");
            let help = "delete `over`, or write `bearings.*.radial_factor` or `axial_factor`";
            return Err(self.fault("over", message, help));
        }
        if over.torques.windows(2).any(|w| w[0] >= w[1]) {
            let help = "sort them and remove duplicates";
            return Err(self.fault("over.torques", "the torques are not ascending", help));
        }
        let of_curve = |place: usize| curve.and_then(|list| list.get(place).copied());
        let at = |(place, torque): (usize, &f64)| Identified {
            name: format!("{} at {torque} Nm", self.name),
            stated: of_curve(place).or(one.stated),
            start: of_curve(place)
                .filter(|_| self.entry.start.is_none())
                .unwrap_or(one.start),
            target: Target::Over {
                varied: varied.clone(),
                port: over.port.clone(),
                torques: over.torques.clone(),
                place,
            },
            ..one.clone()
        };
        Ok(over.torques.iter().enumerate().map(at).collect())
    }
}

impl Identified {
    /// The parameters of an entry: one, or one for each torque of `over`. Paths of findings begin with `parameters`.
    ///
    /// # Errors
    /// Errors of path, bounds, start or prior.
    pub fn from_entry(
        name: &str,
        entry: &IdentifiedEntry,
        rig: &Rig,
        (language, resolved): (&Language, &Resolved),
    ) -> Result<Vec<Self>, Diagnostic> {
        let written = Written { name, entry };
        let what = written.what(rig, (language, resolved))?;
        let bounds = written.bounds(&what)?;
        // A curve of factors may be stated already.
        let curve = entry
            .over
            .as_ref()
            .and_then(|over| curve_at(resolved, &what.target, &over.torques));
        let stated = what.stated.or_else(|| curve.as_ref()?.first().copied());
        let start = written.start(&what, bounds, stated)?;
        let one = Self {
            name: name.to_owned(),
            path: entry.words(),
            stated,
            start,
            bounds,
            scale: entry.scale,
            prior: written.prior(&what, bounds, start)?,
            size: usual_size(what.unit, what.range),
            unit: what.unit,
            target: what.target,
        };
        match &entry.over {
            Some(over) => written.over_torques(over, one, curve.as_deref()),
            None => Ok(vec![one]),
        }
    }

    /// Paths that it changes; empty for a quantity of the rig.
    pub fn paths(&self) -> &[String] {
        match &self.target {
            Target::Path(varied) | Target::Over { varied, .. } => &varied.paths,
            Target::Rig(_) => &[],
        }
    }

    /// The published value, if it changes coefficients of formulas; one for a factor.
    pub fn published(&self) -> Option<f64> {
        match &self.target {
            Target::Path(varied) => varied.published(),
            Target::Over { .. } | Target::Rig(_) => None,
        }
    }

    /// The difference of a value from the source as text; absent if it changes no coefficient of a formula.
    pub fn changed_from_source(&self, value: f64) -> Option<String> {
        match &self.target {
            Target::Path(varied) => varied.changed_from_source(value),
            Target::Over { .. } | Target::Rig(_) => None,
        }
    }

    /// A value with its unit.
    pub fn words(&self, value: f64) -> String {
        words(self.unit, value)
    }

    /// For the solver.
    pub(super) fn fitted(&self) -> least_squares::Parameter {
        let mut parameter =
            least_squares::Parameter::new(self.name.clone(), self.start).within(self.bounds[0], self.bounds[1]);
        if self.scale == ScaleEntry::Log {
            parameter = parameter.log();
        }
        parameter.prior = self.prior;
        parameter
    }

    /// For inference.
    ///
    /// # Errors
    /// If a value is not possible on the scale or not within the bounds.
    pub(super) fn stated(&self, theta: f64) -> Result<inference::Parameter, String> {
        let scale = match self.scale {
            ScaleEntry::Linear => inference::Scale::Linear,
            ScaleEntry::Log => inference::Scale::Log,
        };
        Ok(inference::Parameter::new(&self.name, scale, theta, self.bounds)?.sized(self.size))
    }

    /// Overrides with the values of all parameters of the gearbox.
    pub fn overrides(parameters: &[Self], theta: &[f64]) -> Vec<(String, Value)> {
        let mut overrides = Vec::new();
        for (i, (parameter, value)) in parameters.iter().zip(theta).enumerate() {
            match &parameter.target {
                Target::Path(varied) => overrides.extend(varied.overrides(*value)),
                // All factors of a curve are written with the first.
                Target::Over {
                    varied,
                    port,
                    torques,
                    place: 0,
                } => {
                    let factors = &theta[i..i + torques.len()];
                    let curve = json!({ "port": port, "torques": torques, "factors": factors });
                    overrides.extend(varied.paths.iter().map(|path| (path.clone(), curve.clone())));
                }
                Target::Over { .. } | Target::Rig(_) => {}
            }
        }
        overrides
    }

    /// A rig with the values of its parameters.
    pub fn rig(parameters: &[Self], theta: &[f64], stated: &Rig) -> Rig {
        let mut rig = *stated;
        for (parameter, value) in parameters.iter().zip(theta) {
            if let Target::Rig(quantity) = &parameter.target {
                *quantity.place(&mut rig) = *value;
            }
        }
        rig
    }

    /// The first error of parameters that change the same value. Paths of findings start with `parameters`.
    pub(super) fn find_duplicate(parameters: &[Self]) -> Option<Diagnostic> {
        for (i, one) in parameters.iter().enumerate() {
            for other in &parameters[..i] {
                let same_curve = matches!((&one.target, &other.target), (Target::Over { .. }, Target::Over { .. }))
                    && one.path == other.path
                    && one.base_name() == other.base_name();
                let same_rig = matches!((&one.target, &other.target), (Target::Rig(a), Target::Rig(b)) if a == b);
                let common = one.paths().iter().find(|path| other.paths().contains(path));
                if same_rig || (common.is_some() && !same_curve) {
                    let what = common.map_or(one.path.as_str(), String::as_str);
                    return Some(fault(
                        one.base_name(),
                        "path",
                        format!("`{}` also changes `{what}`", other.base_name()),
                        "list every value once",
                    ));
                }
            }
        }
        None
    }

    /// The name of the entry, without the torque of a factor.
    pub fn base_name(&self) -> &str {
        match self.target {
            Target::Over { .. } => self.name.split(" at ").next().unwrap_or(&self.name),
            _ => &self.name,
        }
    }
}

/// Factors at some torques of the curve of the first path; absent if it has none.
fn curve_at(resolved: &Resolved, target: &Target, torques: &[f64]) -> Option<Vec<f64>> {
    let Target::Path(varied) = target else { return None };
    let stated = lookup(&resolved.value, varied.paths.first()?)?;
    let numbers = |key: &str| -> Option<Vec<f64>> { stated[key].as_array()?.iter().map(Value::as_f64).collect() };
    let (at, factors) = (numbers("torques")?, numbers("factors")?);
    let factor = |torque: &f64| {
        let place = at.iter().position(|t| t >= torque);
        match place {
            None => factors.last().copied(),
            Some(0) => factors.first().copied(),
            Some(k) => {
                let share = (torque - at[k - 1]) / (at[k] - at[k - 1]);
                Some(factors.get(k - 1)? + share * (factors.get(k)? - factors.get(k - 1)?))
            }
        }
    };
    torques.iter().map(factor).collect()
}

/// A quantity as written: a number in the unit of the path, or a text with a unit.
fn read(target: &Target, unit: &'static Unit, value: &Value) -> Result<f64, String> {
    match target {
        Target::Path(varied) | Target::Over { varied, .. } => varied.quantity(value, false),
        Target::Rig(_) => {
            let number = match value {
                Value::Number(x) => x.as_f64().unwrap_or(f64::NAN),
                Value::String(text) => unit.from_si(parse_quantity(text, unit).map_err(|fault| fault.message)?),
                _ => f64::NAN,
            };
            number
                .is_finite()
                .then_some(number)
                .ok_or_else(|| format!("{value} is not a torque"))
        }
    }
}

fn prior_of(
    entry: &PriorEntry,
    target: &Target,
    unit: &'static Unit,
    scale: ScaleEntry,
    start: f64,
) -> Result<Prior, (&'static str, String)> {
    let mean = entry.mean.as_ref().map_or(Ok(start), |mean| read(target, unit, mean));
    let mean = mean.map_err(|reason| ("mean", reason))?;
    let deviation = match (scale, target, &entry.deviation) {
        (ScaleEntry::Log, _, value) => value
            .as_f64()
            .ok_or_else(|| format!("{value} is not a number relative to the mean")),
        (ScaleEntry::Linear, Target::Path(varied) | Target::Over { varied, .. }, value) => varied.quantity(value, true),
        (ScaleEntry::Linear, Target::Rig(_), value) => read(target, unit, value),
    };
    let deviation = deviation.map_err(|reason| ("deviation", reason))?;
    if deviation <= 0.0 {
        return Err(("deviation", format!("{deviation} is not positive")));
    }
    if scale == ScaleEntry::Log && mean <= 0.0 {
        return Err(("mean", format!("{mean} has no logarithm")));
    }
    Ok(Prior { mean, deviation })
}
