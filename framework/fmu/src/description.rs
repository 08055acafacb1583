//! `modelDescription.xml`, and a page of documentation.

use crate::archive::{Fmu, Version};
use crate::content::Content;
use crate::map::OfMap;
use crate::model::Model;
use crate::variables::{Causality, Kind, Slot, Use};

/// Name, description and unit of a variable.
pub struct Info {
    /// Name, structured by dots.
    pub name: String,
    description: String,
    unit: Option<&'static str>,
}

/// A unit: name, powers of the base units, name and factor of the display unit.
type Unit = (&'static str, &'static str, Option<(&'static str, f64)>);

/// Units with their powers of kg, m, s, K and rad, the factor and offset to them, and a display unit with its factor.
const UNITS: [Unit; 9] = [
    ("s", r#"s="1""#, None),
    (
        "rad/s",
        r#"s="-1" rad="1""#,
        Some(("1/min", 30.0 / std::f64::consts::PI)),
    ),
    ("N.m", r#"kg="1" m="2" s="-2""#, None),
    ("W", r#"kg="1" m="2" s="-3""#, None),
    ("degC", r#"K="1" offset="273.15""#, None),
    ("K/s", r#"K="1" s="-1""#, None),
    ("m3/s", r#"m="3" s="-1""#, Some(("l/min", 60000.0))),
    ("kg/s", r#"kg="1" s="-1""#, None),
    ("m/s", r#"m="1" s="-1""#, Some(("km/h", 3.6))),
];

/// The last name of a path as one name: letters, digits and underscores, or in quotes.
fn part(name: &str) -> String {
    let is_plain =
        name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !name.starts_with(|c: char| c.is_ascii_digit());
    if is_plain && !name.is_empty() {
        return name.to_owned();
    }
    let letters = name.chars().map(|c| {
        if matches!(c, '\'' | '\\' | '"') || !(' '..='~').contains(&c) {
            '_'
        } else {
            c
        }
    });
    format!("'{}'", letters.collect::<String>())
}

fn loss_of(map: OfMap) -> &'static str {
    match map {
        OfMap::Gearbox => "Loss of the transmission",
        OfMap::Unit => "Losses of gearbox, machines and inverters, which become heat",
        OfMap::Machines => "Losses of machines and inverters, which become heat",
    }
}

fn efficiency_of(map: OfMap) -> &'static str {
    match map {
        OfMap::Gearbox => "Output power over input power, in drive and coast; zero without output power",
        OfMap::Unit => {
            "Power at the other ports over the power of the DC link, while generating the reciprocal; zero if no power passes"
        }
        OfMap::Machines => {
            "Power at the shafts of the machines over the power of the DC link, while generating the reciprocal; zero if no power passes"
        }
    }
}

/// Name, description and unit of a variable.
pub fn info(fmu: &Fmu<'_>, slot: &Slot) -> Info {
    let plain = |name: &str, unit: Option<&'static str>, description: &str| Info {
        name: name.to_owned(),
        description: description.to_owned(),
        unit,
    };
    let (nodes, exchangers) = match fmu.content {
        Content::Map(_) => (&[][..], &[][..]),
        Content::Network(network) => (&network.nodes[..], &network.exchangers[..]),
    };
    let exchanger = |i: u32| exchangers.get(i as usize).map_or("", |e| &e.name);
    match slot.use_ {
        Use::Time => plain("time", Some("s"), "Time"),
        Use::Speed => plain("input.speed", Some("rad/s"), "Speed of the reference port"),
        Use::Torque => plain(
            "input.torque",
            Some("N.m"),
            "Torque at the reference port, positive in drive",
        ),
        Use::OilTemperature if slot.causality == Causality::Input => {
            plain("oil.temperature", Some("degC"), "Temperature of the oil")
        }
        Use::OilTemperature => plain(
            "oil.temperature",
            Some("degC"),
            "Temperature of the oil at the heat balance",
        ),
        Use::Gear => plain("gear", None, &format!("Number of the gear: {}", gears(fmu.content))),
        Use::LossTorque => plain("loss.torque", Some("N.m"), "Loss over the speed of the reference port"),
        Use::LossPower => plain("loss.power", Some("W"), loss_of(of_map(fmu.content))),
        Use::Efficiency => plain("efficiency", None, efficiency_of(of_map(fmu.content))),
        Use::DcPower => plain(
            "dc.power",
            Some("W"),
            "Power out of the DC link into the machines, negative while they generate",
        ),
        Use::GearboxLoss => plain("loss.gearbox", Some("W"), "Loss of the gearbox"),
        Use::MachineLoss => plain(
            "loss.machines",
            Some("W"),
            "Losses of the machines, with what their maps contain",
        ),
        Use::InverterLoss => plain(
            "loss.inverters",
            Some("W"),
            "Losses of inverters that are described apart",
        ),
        Use::OutputTorque => plain("output.torque", Some("N.m"), "Torque that the other port delivers"),
        Use::OutputSpeed => plain("output.speed", Some("rad/s"), "Speed of the other port"),
        Use::Share(share) => {
            let (name, meaning) = fmu.shares.get(share as usize).copied().unwrap_or(("others", "others"));
            plain(&format!("loss.{name}"), Some("W"), &format!("Loss of: {meaning}"))
        }
        Use::Outside => plain("outside", None, "An input is beyond the tables, whose ends are used"),
        Use::Ambient => plain("ambient.temperature", Some("degC"), "Ambient temperature"),
        Use::VehicleSpeed => plain("vehicle.speed", Some("m/s"), "Speed of the vehicle"),
        Use::OilFlow => plain("oil.flow", Some("m3/s"), "Volume flow of the circulated oil"),
        Use::CoolantFlow(i) => plain(
            &format!("coolant.{}.flow", part(exchanger(i))),
            Some("kg/s"),
            "Mass flow of the coolant",
        ),
        Use::CoolantTemperature(i) => {
            let name = format!("coolant.{}.temperature", part(exchanger(i)));
            plain(&name, Some("degC"), "Temperature of the coolant at the inlet")
        }
        Use::Node(node) => {
            let name = nodes.get(node as usize).map_or("", |node| &node.name);
            plain(
                &format!("temperature.{}", part(name)),
                Some("degC"),
                &format!("Temperature of {name}"),
            )
        }
        Use::Rate(node) => {
            let name = nodes.get(node as usize).map_or("", |node| &node.name);
            plain(
                &format!("der(temperature.{})", part(name)),
                Some("K/s"),
                &format!("Change of the temperature of {name}"),
            )
        }
        Use::ExchangerHeat(i) => plain(
            &format!("heat.{}", part(exchanger(i))),
            Some("W"),
            "Heat from the oil to the coolant",
        ),
        Use::MotorLoss => plain("loss.motors", Some("W"), "Losses of the motors"),
    }
}

/// Whose losses a content has.
fn of_map(content: &Content) -> OfMap {
    match content {
        Content::Map(map) => map.of,
        Content::Network(_) => OfMap::Gearbox,
    }
}

/// The gears with their numbers.
fn gears(content: &Content) -> String {
    let names: Vec<&str> = match content {
        Content::Map(map) => map.gears.iter().map(|gear| gear.name.as_str()).collect(),
        Content::Network(network) => network.gears.iter().map(|gear| gear.name.as_str()).collect(),
    };
    let numbered = names.iter().zip(1..).map(|(name, i)| format!("{i} {name}"));
    numbered.collect::<Vec<_>>().join(", ")
}

/// Number of gears.
fn gear_count(content: &Content) -> usize {
    match content {
        Content::Map(map) => map.gears.len(),
        Content::Network(network) => network.gears.len(),
    }
}

/// Text as the value of an attribute or the content of an element.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// The model description.
pub fn xml(fmu: &Fmu<'_>, version: Version, token: &str) -> String {
    let slots = Model::new(fmu.content.clone()).slots().to_vec();
    let (name, description, tool) = (escaped(&fmu.name), escaped(&fmu.description), escaped(&fmu.tool));
    let (number, key, state) = match version {
        Version::Two => ("2.0", "guid", "FMUstate"),
        Version::Three => ("3.0", "instantiationToken", "FMUState"),
    };
    let events = if version == Version::Two {
        " numberOfEventIndicators=\"0\""
    } else {
        ""
    };
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"{number}\" modelName=\"{name}\" {key}=\"{token}\"\n  \
         description=\"{description}\"\n  generationTool=\"{tool}\" variableNamingConvention=\"structured\"{events}>\n"
    );
    let common = format!(
        "modelIdentifier=\"{}\" canGetAndSet{state}=\"true\" canSerialize{state}=\"true\"",
        fmu.identifier()
    );
    let steps = match version {
        Version::Two => "completedIntegratorStepNotNeeded=\"true\"",
        Version::Three => "needsCompletedIntegratorStep=\"false\"",
    };
    xml.push_str(&format!("  <ModelExchange {common} {steps}/>\n"));
    xml.push_str(&format!(
        "  <CoSimulation {common} canHandleVariableCommunicationStepSize=\"true\"/>\n"
    ));
    xml.push_str(&units(fmu, &slots));
    xml.push_str("  <LogCategories>\n");
    for category in ["logStatusWarning", "logStatusDiscard", "logStatusError"] {
        xml.push_str(&format!("    <Category name=\"{category}\"/>\n"));
    }
    let stop = fmu.experiment.step * fmu.experiment.inputs.len().saturating_sub(1) as f64;
    xml.push_str(&format!(
        "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stopTime=\"{stop}\" stepSize=\"{}\"/>\n  <ModelVariables>\n",
        fmu.experiment.step
    ));
    for (reference, slot) in slots.iter().enumerate() {
        let state = match slot.use_ {
            Use::Rate(node) => slots.iter().position(|other| other.use_ == Use::Node(node)),
            _ => None,
        };
        xml.push_str(&variable(fmu, version, (reference, slot), state));
    }
    xml.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    xml.push_str(&structure(version, &slots));
    xml.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    xml
}

/// The used units.
fn units(fmu: &Fmu<'_>, slots: &[Slot]) -> String {
    let used: Vec<&str> = slots.iter().filter_map(|slot| info(fmu, slot).unit).collect();
    let mut xml = "  <UnitDefinitions>\n".to_owned();
    for (name, powers, display) in UNITS.iter().filter(|(name, ..)| used.contains(name)) {
        xml.push_str(&format!("    <Unit name=\"{name}\">\n      <BaseUnit {powers}/>\n"));
        if let Some((shown, factor)) = display {
            xml.push_str(&format!("      <DisplayUnit name=\"{shown}\" factor=\"{factor}\"/>\n"));
        }
        xml.push_str("    </Unit>\n");
    }
    xml + "  </UnitDefinitions>\n"
}

/// FMI 2.0 counts variables from one, FMI 3.0 uses value references.
fn number(version: Version, reference: usize) -> usize {
    if version == Version::Two {
        reference + 1
    } else {
        reference
    }
}

/// The element of a variable; `state` is the place of that of which it is the derivative.
fn variable(fmu: &Fmu<'_>, version: Version, (reference, slot): (usize, &Slot), state: Option<usize>) -> String {
    let info = info(fmu, slot);
    let causality = match slot.causality {
        Causality::Independent => "independent",
        Causality::Input => "input",
        Causality::Output | Causality::State => "output",
        Causality::Derivative => "local",
    };
    let variability = if slot.kind == Kind::Real {
        "continuous"
    } else {
        "discrete"
    };
    let mut common = format!(
        "name=\"{}\" valueReference=\"{reference}\" description=\"{}\" causality=\"{causality}\" variability=\"{variability}\"",
        escaped(&info.name),
        escaped(&info.description)
    );
    match slot.causality {
        Causality::Output | Causality::Derivative => common.push_str(" initial=\"calculated\""),
        Causality::State => common.push_str(" initial=\"exact\""),
        Causality::Input | Causality::Independent => {}
    }
    let mut particular = String::new();
    if slot.kind == Kind::Integer {
        particular.push_str(&format!(" min=\"1\" max=\"{}\"", gear_count(fmu.content)));
    }
    if matches!(slot.causality, Causality::Input | Causality::State) {
        particular.push_str(&format!(" start=\"{}\"", slot.start));
    }
    if let Some(state) = state {
        particular.push_str(&format!(" derivative=\"{}\"", number(version, state)));
    }
    if let Some(unit) = info.unit {
        particular.push_str(&format!(" unit=\"{unit}\""));
        let known = UNITS.iter().find(|(name, ..)| *name == unit);
        if let Some((_, _, Some((shown, _)))) = known {
            particular.push_str(&format!(" displayUnit=\"{shown}\""));
        }
    }
    match (version, slot.kind) {
        (Version::Two, kind) => {
            let kind = match kind {
                Kind::Real => "Real",
                Kind::Integer => "Integer",
                Kind::Boolean => "Boolean",
            };
            format!("    <ScalarVariable {common}><{kind}{particular}/></ScalarVariable>\n")
        }
        (Version::Three, kind) => {
            let kind = match kind {
                Kind::Real => "Float64",
                Kind::Integer => "Int32",
                Kind::Boolean => "Boolean",
            };
            format!("    <{kind} {common}{particular}/>\n")
        }
    }
}

/// Whether an output depends on an input or a state at the same time. Losses and temperatures without heat capacity may depend on all.
fn depends(output: &Slot, on: &Slot) -> bool {
    match output.use_ {
        Use::OutputSpeed => matches!(on.use_, Use::Speed | Use::Gear),
        _ if output.causality == Causality::State => output.use_ == on.use_,
        _ => true,
    }
}

/// Outputs, derivatives and initial unknowns with what they depend on.
fn structure(version: Version, slots: &[Slot]) -> String {
    let list = |output: &Slot| {
        let knowns = slots.iter().enumerate();
        let knowns = knowns.filter(|(_, slot)| matches!(slot.causality, Causality::Input | Causality::State));
        let needed = knowns.filter(|(_, slot)| depends(output, slot));
        needed
            .map(|(i, _)| number(version, i).to_string())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let part = |wanted: fn(Causality) -> bool, group: &str, element: &str| {
        let of = slots.iter().enumerate().filter(|(_, slot)| wanted(slot.causality));
        let lines: Vec<String> = of
            .map(|(i, slot)| {
                let on = list(slot);
                match version {
                    Version::Two => format!(
                        "      <Unknown index=\"{}\" dependencies=\"{on}\"/>\n",
                        number(version, i)
                    ),
                    Version::Three => format!("    <{element} valueReference=\"{i}\" dependencies=\"{on}\"/>\n"),
                }
            })
            .collect();
        match version {
            Version::Two if lines.is_empty() => String::new(),
            Version::Two => format!("    <{group}>\n{}    </{group}>\n", lines.concat()),
            Version::Three => lines.concat(),
        }
    };
    [
        part(
            |c| matches!(c, Causality::Output | Causality::State),
            "Outputs",
            "Output",
        ),
        part(
            |c| c == Causality::Derivative,
            "Derivatives",
            "ContinuousStateDerivative",
        ),
        part(
            |c| matches!(c, Causality::Output | Causality::Derivative),
            "InitialUnknowns",
            "InitialUnknown",
        ),
    ]
    .concat()
}

/// A page about the variables.
pub fn page(fmu: &Fmu<'_>) -> String {
    let model = Model::new(fmu.content.clone());
    let rows = model.slots().iter().map(|slot| {
        let info = info(fmu, slot);
        let direction = match slot.causality {
            Causality::Independent => "time",
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::State => "output, with a start value; a state in Model Exchange",
            Causality::Derivative => "derivative of a state",
        };
        format!(
            "<tr><td>{}<td>{direction}<td>{}<td>{}\n",
            escaped(&info.name),
            info.unit.unwrap_or("-"),
            escaped(&info.description)
        )
    });
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{name}</title>\n<h1>{name}</h1>\n<p>{}</p>\n\
         <p>Inputs are constant over a step. Beyond the tables their ends are used, and <code>outside</code> is true. \
         Reference inputs and outputs are in <code>extra/org.fmi-standard.fmi-ls-ref</code>.</p>\n\
         <table border=\"1\">\n<tr><th>variable<th>kind<th>unit<th>meaning\n{}</table>\n</html>\n",
        escaped(&fmu.description),
        rows.collect::<String>(),
        name = escaped(&fmu.name),
    )
}
