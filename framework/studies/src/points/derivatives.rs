//! Derivatives of one point over a given quantity or over a number of the description.
//!
//! Over a given torque, speed or oil temperature they are exact: the laws carry them through the power flow and the heat balance
//! ([`Transmission::slopes`]). Over a number of the description, and through a thermal network, they are differences of whole solved
//! points.

mod differences;

use std::fmt;

use gearloss_framework::codes;
use gearloss_framework::document::{Diagnostic, Unit, did_you_mean};
use gearloss_framework::evaluate::{GivenQuantity, NoSlopes, Noting, Point, Scratch, Slope, Slopes};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Choice, Resolved};
use gearloss_framework::thermal::{Equilibrium, Step, Unbalanced};
use gearloss_framework::transmission::{Case, Transmission};

use self::differences::{Around, Difference};
use super::{OilTemperature, PreparedPoint};
use crate::varied::{Tie, Varied};

/// Tolerance of the points whose differences are taken.
const TIGHT: f64 = 1e-12;
/// Size of a given quantity that is zero or a temperature, for the steps of differences: 1 Nm, 1 rad/s, 30 K.
const SIZE: [f64; 2] = [1.0, 30.0];

/// What a derivative is over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Variable {
    /// The given torque of a port. \[Nm\]
    Torque(String),
    /// The given speed of a port. \[rpm\]
    Speed(String),
    /// The given oil temperature. \[K\]
    OilTemperature,
    /// The number of the resolved description at a path, in the unit of the schema.
    Path(String),
}

impl From<&str> for Variable {
    /// `torque:PORT`, `speed:PORT`, `oil_temperature`, or a path.
    fn from(text: &str) -> Self {
        let text = text.trim();
        match text.split_once(':') {
            Some(("torque", port)) => Self::Torque(port.trim().to_owned()),
            Some(("speed", port)) => Self::Speed(port.trim().to_owned()),
            _ if text == "oil_temperature" => Self::OilTemperature,
            _ => Self::Path(text.to_owned()),
        }
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Torque(port) => write!(f, "torque:{port}"),
            Self::Speed(port) => write!(f, "speed:{port}"),
            Self::OilTemperature => f.write_str("oil_temperature"),
            Self::Path(path) => f.write_str(path),
        }
    }
}

/// How derivatives were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// By the rules of calculus, from the laws of the models.
    Exact,
    /// By differences: of some models, or of whole points.
    Differences,
}

impl Method {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Differences => "differences",
        }
    }
}

/// The derivative of one quantity.
#[derive(Debug, Clone, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Derivative {
    /// `loss`, `efficiency`, `oil_temperature`, or the path of a part, whose loss is meant.
    pub of: String,
    /// Unit of the derivative.
    pub unit: String,
    /// The derivative; null at a kink.
    pub value: Option<f64>,
    /// Its estimated error; null at a kink.
    pub error: Option<f64>,
    /// At a kink: the derivatives below and above, which depend on the step at a jump; null elsewhere.
    pub kink: Option<[f64; 2]>,
}

/// The derivatives of a point over one variable.
#[derive(Debug, Clone, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Derivatives {
    /// The variable: `torque:PORT`, `speed:PORT`, `oil_temperature` or a path.
    pub variable: String,
    /// Exact: by the rules of calculus, from the laws of the models; differences: of some models, or of whole points.
    pub method: Method,
    /// Paths of the models that were differentiated by differences; empty if whole points were, or none.
    pub models: Vec<String>,
    /// The derivatives of the sum of all losses, of efficiency and balanced oil temperature if there are any, and of the loss of
    /// each part.
    pub derivatives: Vec<Derivative>,
}

/// A gearbox with the choice with which it was resolved, and a point of it.
#[derive(Clone, Copy)]
pub struct Derived<'a> {
    /// The linked models.
    pub language: &'a Language,
    /// The gearbox.
    pub gearbox: &'a Gearbox,
    /// Its model set and overrides.
    pub choice: &'a Choice,
    /// Resolved with them.
    pub resolved: &'a Resolved,
    /// Built from that.
    pub transmission: &'a Transmission,
    /// The point.
    pub prepared: &'a PreparedPoint,
}

impl Derived<'_> {
    /// The derivatives over a variable.
    ///
    /// # Errors
    /// If the point does not give that quantity, the path is not that of a number, or the point is undefined there or close to it.
    pub fn over(&self, variable: &Variable) -> Result<Derivatives, Findings> {
        let found = match variable {
            Variable::Path(path) => return self.over_path(path),
            Variable::Torque(port) => self.over_given(variable, self.given_torque(port)),
            Variable::Speed(port) => self.over_given(variable, self.given_speed(port)),
            Variable::OilTemperature => self.over_given(variable, self.given_temperature()),
        };
        found.map_err(|error| self.gearbox.findings(vec![error.code(codes::GIVEN)]))
    }

    fn given_torque(&self, port: &str) -> Result<GivenQuantity, Diagnostic> {
        let ports = &self.prepared.case.torque_ports;
        self.position("torque", port, ports).map(GivenQuantity::Torque)
    }

    fn given_speed(&self, port: &str) -> Result<GivenQuantity, Diagnostic> {
        let ports = &self.prepared.case.speed_ports;
        self.position("speed", port, ports).map(GivenQuantity::Speed)
    }

    fn given_temperature(&self) -> Result<GivenQuantity, Diagnostic> {
        match self.prepared.oil {
            OilTemperature::Fixed(_) => Ok(GivenQuantity::OilTemperature),
            OilTemperature::Balance | OilTemperature::Network => Err(Diagnostic::error(
                "",
                "the oil temperature is not given: it follows from the heat balance",
            )
            .help("give the oil temperature, or choose another variable")),
        }
    }

    /// Position of a port among those where a quantity is given.
    fn position(&self, what: &str, port: &str, given: &[usize]) -> Result<usize, Diagnostic> {
        let name = |number: &usize| self.transmission.ports()[*number].name.as_str();
        let names: Vec<&str> = given.iter().map(name).collect();
        if let Some(position) = names.iter().position(|name| *name == port) {
            return Ok(position);
        }
        let known = self
            .transmission
            .ports()
            .iter()
            .any(|known_port| known_port.name == port);
        let message = if known {
            format!("the {what} at `{port}` is not given: it follows from the others")
        } else {
            format!("there is no port `{port}`")
        };
        let help = match (did_you_mean(port, names.iter().copied()), &names[..]) {
            (Some(close), _) => format!("write `{what}:{close}`"),
            (None, []) => format!("the point gives no {what}: choose another variable"),
            (None, names) => format!("write `{what}:{}`", names.join(&format!("` or `{what}:"))),
        };
        Err(Diagnostic::error("", message).help(help))
    }

    fn over_given(
        &self,
        variable: &Variable,
        given: Result<GivenQuantity, Diagnostic>,
    ) -> Result<Derivatives, Diagnostic> {
        let given = given?;
        let unit = match given {
            GivenQuantity::Torque(_) => "Nm",
            GivenQuantity::Speed(_) => "rpm",
            GivenQuantity::OilTemperature => "K",
        };
        if self.prepared.oil == OilTemperature::Network {
            return self.through_network(variable, given, unit);
        }
        let (transmission, prepared) = (self.transmission, self.prepared);
        let mut scratch = transmission.scratch(&prepared.case);
        let point = tight(prepared.point());
        let found = prepared.oil.find(transmission, &prepared.case, &point, &mut scratch);
        if !found.is_sound() {
            return Err(
                Diagnostic::error("", "the point has no heat balance, so it has no derivatives")
                    .help("give the oil temperature"),
            );
        }
        let balanced = found.balance.is_some();
        let slopes = transmission
            .slopes(&prepared.case, &point, found.oil, balanced, given, &mut scratch)
            .map_err(|reason| self.undefined(&reason))?;
        // Speeds are in rad/s inside.
        let factor = Unit::of_symbol(unit).map_or(1.0, |unit| unit.to_si(1.0) - unit.to_si(0.0));
        Ok(self.of_slopes(variable, &slopes, factor, unit))
    }

    fn of_slopes(&self, variable: &Variable, slopes: &Slopes, factor: f64, unit: &str) -> Derivatives {
        let one = |of: &str, own_unit: &str, slope: Slope| Derivative {
            of: of.to_owned(),
            unit: over(own_unit, unit),
            value: Some(slope.value * factor),
            error: Some(slope.error * factor),
            kink: None,
        };
        let mut derivatives = vec![one(LOSS.0, LOSS.1, slopes.loss)];
        derivatives.extend(slopes.efficiency.map(|slope| one(EFFICIENCY.0, EFFICIENCY.1, slope)));
        derivatives.extend(slopes.oil_temperature.map(|slope| one(OIL.0, OIL.1, slope)));
        let parts = self.transmission.parts().iter().zip(&slopes.parts);
        derivatives.extend(parts.map(|(part, slope)| one(&part.path, "W", *slope)));
        let instances = self.transmission.instances();
        let models: Vec<String> = slopes
            .by_differences
            .iter()
            .map(|number| instances[*number].path.clone())
            .collect();
        Derivatives {
            variable: variable.to_string(),
            method: if models.is_empty() {
                Method::Exact
            } else {
                Method::Differences
            },
            models,
            derivatives,
        }
    }

    /// The finding that a point is undefined.
    fn undefined(&self, reason: &NoSlopes) -> Diagnostic {
        let message = match reason {
            NoSlopes::Undefined(Unbalanced::Part(part, reason)) => {
                let part = &self.transmission.parts()[*part].path;
                format!("{part} has no derivative: {reason}")
            }
            NoSlopes::Undefined(Unbalanced::Way(_, reason) | Unbalanced::Link(_, reason)) => {
                format!("the dissipated heat has no derivative: {reason}")
            }
            NoSlopes::Undefined(Unbalanced::Flow | Unbalanced::Network) => {
                "the point has no power flow, so it has no derivatives".to_owned()
            }
            NoSlopes::Unstable => {
                "the balanced oil temperature has no derivative: losses increase with it as steeply as the dissipated heat"
                    .to_owned()
            }
            NoSlopes::NoConvergence => "the derivatives of losses and torques do not converge".to_owned(),
        };
        Diagnostic::error("", message).help("choose a point where its losses are defined on both sides")
    }

    /// Derivatives over a given quantity by differences, with the thermal network solved at each point.
    fn through_network(
        &self,
        variable: &Variable,
        given: GivenQuantity,
        unit: &str,
    ) -> Result<Derivatives, Diagnostic> {
        let prepared = self.prepared;
        let value = match given {
            GivenQuantity::Torque(i) => prepared.torques[i],
            GivenQuantity::Speed(i) => prepared.speeds[i],
            GivenQuantity::OilTemperature => return Err(Diagnostic::error("", "the oil temperature is not given")),
        };
        let around = Around {
            value,
            size: if value == 0.0 { SIZE[0] } else { value.abs() },
            range: [f64::NEG_INFINITY, f64::INFINITY],
        };
        let differences = around.differentiate(|value| {
            let (mut speeds, mut torques) = (prepared.speeds.clone(), prepared.torques.clone());
            match given {
                GivenQuantity::Torque(i) => torques[i] = value,
                GivenQuantity::Speed(i) => speeds[i] = value,
                GivenQuantity::OilTemperature => {}
            }
            let point = Point {
                speeds: &speeds,
                torques: &torques,
                ..prepared.point()
            };
            solved(self.transmission, &prepared.case, &point, prepared.oil)
                .map_err(|reason| self.undefined(&NoSlopes::Undefined(reason)))
        })?;
        let factor = Unit::of_symbol(unit).map_or(1.0, |unit| unit.to_si(1.0) - unit.to_si(0.0));
        Ok(self.of_differences(variable, &differences, factor, unit))
    }

    fn over_path(&self, path: &str) -> Result<Derivatives, Findings> {
        let finding = |error: Diagnostic| self.gearbox.findings(vec![error.code(codes::CHOICE)]);
        let varied = Varied::new(self.language, self.resolved, path, Tie::Value).map_err(finding)?;
        let same = varied.base.windows(2).all(|pair| pair[0] == pair[1]);
        let value = match varied.start() {
            Some(value) if same => value,
            Some(_) => {
                let error = Diagnostic::error(path, format!("the numbers at `{path}` differ"));
                return Err(finding(error.help("name one of them, or give all the same value")));
            }
            None => {
                let error = Diagnostic::error(path, format!("`{path}` has no value"));
                return Err(finding(error.help("state it in the gearbox, or with --set")));
            }
        };
        let around = Around {
            value,
            size: match (varied.unit.symbol, value) {
                ("degC", _) => SIZE[1],
                (_, 0.0) => SIZE[0],
                _ => value.abs(),
            },
            range: varied.range,
        };
        let differences: Result<_, Findings> = around.differentiate(|value| {
            let mut choice = self.choice.clone();
            choice.overrides.extend(varied.overrides(value));
            let transmission = self.gearbox.transmission(self.language, &choice)?;
            self.solved_in(&transmission)
        });
        let unit = if varied.unit.symbol == "degC" {
            "K"
        } else {
            varied.unit.symbol
        };
        let differences = differences?;
        Ok(self.of_differences(&Variable::Path(path.to_owned()), &differences, 1.0, unit))
    }

    /// The results of the point in a changed transmission.
    fn solved_in(&self, transmission: &Transmission) -> Result<Vec<Option<[f64; 2]>>, Findings> {
        let prepared = self.prepared;
        let names = |ports: &[usize]| -> Vec<&str> {
            let names = ports.iter().map(|port| self.transmission.ports()[*port].name.as_str());
            names.collect()
        };
        let (speeds, torques) = (names(&prepared.case.speed_ports), names(&prepared.case.torque_ports));
        let case = transmission
            .case(&prepared.gear, &speeds, &torques)
            .map_err(|list| self.gearbox.findings(list))?;
        // A temperature of the gearbox may be the one that is varied.
        let stated = OilTemperature::from_conditions(self.transmission, None) == prepared.oil;
        let oil = if stated {
            OilTemperature::from_conditions(transmission, None)
        } else {
            prepared.oil
        };
        solved(transmission, &case, &prepared.point(), oil).map_err(|reason| {
            let error = self.undefined(&NoSlopes::Undefined(reason));
            self.gearbox.findings(vec![error.code(codes::GIVEN)])
        })
    }

    fn of_differences(
        &self,
        variable: &Variable,
        differences: &[Option<Difference>],
        factor: f64,
        unit: &str,
    ) -> Derivatives {
        let parts = self.transmission.parts().iter().map(|part| (part.path.as_str(), "W"));
        let quantities = [LOSS, EFFICIENCY, OIL].into_iter().chain(parts);
        let derivatives = quantities.zip(differences).filter_map(|((of, own_unit), difference)| {
            let difference = difference.as_ref()?;
            let smooth = difference.kink.is_none();
            Some(Derivative {
                of: of.to_owned(),
                unit: over(own_unit, unit),
                value: smooth.then_some(difference.value * factor),
                error: smooth.then_some(difference.error * factor),
                kink: difference.kink.map(|sides| sides.map(|side| side * factor)),
            })
        });
        Derivatives {
            variable: variable.to_string(),
            method: Method::Differences,
            models: Vec::new(),
            derivatives: derivatives.collect(),
        }
    }
}

/// Quantities with their units, in the order of [`solved`].
const LOSS: (&str, &str) = ("loss", "W");
const EFFICIENCY: (&str, &str) = ("efficiency", "-");
const OIL: (&str, &str) = ("oil_temperature", "K");

/// The unit of a derivative.
fn over(of: &str, variable: &str) -> String {
    match (of, variable) {
        (of, "-") => of.to_owned(),
        (of, variable) if of == variable => "-".to_owned(),
        (of, variable) => {
            let of = if of == "-" { "1" } else { of };
            if variable.contains(['/', ' ']) {
                format!("{of}/({variable})")
            } else {
                format!("{of}/{variable}")
            }
        }
    }
}

/// A point at the tolerance of derivatives.
fn tight(point: Point<'_>) -> Point<'_> {
    Point {
        tolerance: Tolerance {
            power: TIGHT,
            ..point.tolerance
        },
        ..point
    }
}

/// The loss, the efficiency and the balanced temperature of a point, and the loss of each part, each with its error.
fn solved(
    transmission: &Transmission,
    case: &Case,
    point: &Point<'_>,
    oil: OilTemperature,
) -> Result<Vec<Option<[f64; 2]>>, Unbalanced> {
    let mut scratch: Scratch = transmission.scratch(case);
    let point = tight(*point);
    let found = oil.find(transmission, case, &point, &mut scratch);
    if !found.is_sound() {
        return Err(Unbalanced::Network);
    }
    let balanced = found.balance.as_ref().and_then(sharpened);
    let temperatures = balanced.as_ref().map_or(found.temperatures(), std::slice::from_ref);
    transmission.try_point(case, &point, temperatures, &mut scratch, Noting::Muted)?;
    let solution = transmission.evaluate(case, &point, temperatures, &mut scratch);
    let temperature = found.outcome().map(|_| balanced.unwrap_or(found.oil));
    // Losses are within the tolerance of the flow, a temperature to rounding.
    let watts = |watts: f64| [watts, TIGHT * solution.largest_power()];
    let mut results = vec![
        solution.loss().map(watts),
        solution.efficiency().map(|efficiency| [efficiency, TIGHT]),
        temperature.map(|temperature| [temperature, 0.0]),
    ];
    results.extend(solution.watts().iter().map(|loss| Some(watts(*loss))));
    Ok(results)
}

/// A balanced temperature after one more secant step: the search ends at a residual of 1e-10 of the loss, which differences amplify.
fn sharpened(found: &Equilibrium) -> Option<f64> {
    /// Minimum distance of the other step, so that rounding does not determine the slope. \[K\]
    const APART: f64 = 1e-4;
    let root = found.stable.first().filter(|root| root.beyond.is_none())?;
    let distance = |step: &Step| (step.temperature - root.temperature).abs();
    let others = found.history.iter().filter(|step| distance(step) >= APART);
    let other = others.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let slope = (other.residual() - root.step.residual()) / (other.temperature - root.temperature);
    let better = root.temperature - root.step.residual() / slope;
    Some(better).filter(|better| better.is_finite())
}
