//! One operating point from the arguments.

use gearloss_framework::document::{Unit, parse_quantity};
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::points::{OilTemperature, PreparedPoint};

use crate::args::{FlowArg, PointArgs};
use crate::output::Failure;

/// A quantity of an option in SI.
pub fn quantity(option: &str, text: &str, unit: &'static str) -> Result<f64, Failure> {
    let unit = Unit::of_symbol(unit).unwrap_or(Unit::ONE);
    // A bare number is in the documented unit, as in a file.
    if let Ok(bare) = text.trim().parse::<f64>()
        && bare.is_finite()
    {
        return Ok(unit.to_si(bare));
    }
    parse_quantity(text.trim(), unit).map_err(|fault| {
        Failure::input(
            format!("{option} \"{text}\": {}", fault.message),
            fault.help.unwrap_or_else(|| "write a smaller number".to_owned()),
        )
    })
}

/// `[port=]quantity`.
fn at_port<'a>(option: &str, text: &'a str, unit: &'static str) -> Result<(&'a str, f64), Failure> {
    let (port, value) = text
        .split_once('=')
        .map_or(("input", text), |(port, value)| (port.trim(), value));
    Ok((port, quantity(option, value, unit)?))
}

/// Completes torque or speed of each port whose power is given.
fn divide_powers<'a>(
    powers: &[(&'a str, f64)],
    torques: &mut Vec<(&'a str, f64)>,
    speeds: &mut Vec<(&'a str, f64)>,
) -> Result<(), Failure> {
    for (k, &(port, power)) in powers.iter().enumerate() {
        let of_port = |list: &[(&str, f64)]| list.iter().find(|(name, _)| *name == port).map(|(_, value)| *value);
        let (torque, speed) = (of_port(torques), of_port(speeds));
        let (known, missing, name) = match (torque, speed) {
            _ if of_port(&powers[..k]).is_some() => {
                return Err(Failure::input(
                    format!("--power of `{port}` is given twice"),
                    "delete one of them",
                ));
            }
            (Some(_), Some(_)) => {
                return Err(Failure::input(
                    format!("power, torque and speed of `{port}` are given"),
                    "delete one of the three: two decide the third",
                ));
            }
            (None, None) => {
                return Err(Failure::input(
                    format!("of `{port}` only the power is given"),
                    format!("add --speed \"{port}=1000 rpm\" or --torque \"{port}=10 Nm\""),
                ));
            }
            (Some(torque), None) => (torque, &mut *speeds, "torque"),
            (None, Some(speed)) => (speed, &mut *torques, "speed"),
        };
        let other = power / known;
        if !other.is_finite() {
            return Err(Failure::input(
                format!("no power is transmitted at `{port}`: its {name} is zero or too small"),
                format!("write another {name}, or a torque and a speed in place of --power"),
            ));
        }
        missing.push((port, other));
    }
    Ok(())
}

/// Prepares the point of the arguments.
pub fn prepare(args: &PointArgs, gearbox: &Gearbox, transmission: &Transmission) -> Result<PreparedPoint, Failure> {
    let gear = match (&args.gear, transmission.states()) {
        (Some(gear), _) => gear.clone(),
        (None, [only]) => only.name.clone(),
        (None, states) => {
            let names: Vec<&str> = states.iter().map(|s| s.name.as_str()).collect();
            return Err(Failure::input(
                "no gear is given",
                format!("add --gear with one of {}", names.join(", ")),
            ));
        }
    };
    let mut speeds = Vec::new();
    for text in &args.speed {
        speeds.push(at_port("--speed", text, "rpm")?);
    }
    let mut torques = Vec::new();
    for text in &args.torque {
        torques.push(at_port("--torque", text, "Nm")?);
    }
    let mut powers = Vec::new();
    for text in &args.power {
        powers.push(at_port("--power", text, "W")?);
    }
    let state = transmission
        .state(&gear)
        .map_err(|e| Failure::from(gearbox.findings(vec![e])))?;
    let ports: Vec<&str> = transmission.ports().iter().map(|p| p.name.as_str()).collect();
    // The assumed port must exist.
    for (port, _) in speeds.iter_mut().chain(&mut torques).chain(&mut powers) {
        if *port == "input" && !ports.contains(port) {
            *port = ports[transmission.reference_port()];
        }
    }
    divide_powers(&powers, &mut torques, &mut speeds)?;
    let needed = transmission.torques_needed(state);
    if speeds.is_empty() {
        let released: Vec<&str> = transmission.states()[state]
            .speed_ports
            .iter()
            .map(|p| ports[*p])
            .collect();
        let (missing, torque) = if torques.len() < needed {
            ("no speed and no torque is given", " --torque \"10 Nm\"")
        } else {
            ("no speed is given", "")
        };
        let speeds = released.join("=1000 rpm\" --speed \"");
        return Err(Failure::input(
            missing,
            format!("add --speed \"{speeds}=1000 rpm\"{torque}"),
        ));
    }
    if torques.len() < needed {
        return Err(Failure::input(
            format!("`{gear}` needs {needed} given torque"),
            format!(
                "add --torque \"10 Nm\", or at another port --torque \"{}=10 Nm\"",
                ports.last().copied().unwrap_or("output")
            ),
        ));
    }
    let speed_names: Vec<&str> = speeds.iter().map(|s| s.0).collect();
    let torque_names: Vec<&str> = torques.iter().map(|s| s.0).collect();
    let case = transmission
        .case(&gear, &speed_names, &torque_names)
        .map_err(|list| Failure::from(gearbox.findings(list)))?;
    let given = match &args.oil_temperature {
        Some(text) => {
            let given = quantity("--oil-temperature", text, "degC")?;
            if !(-60.0..=250.0).contains(&given) {
                let message = format!("--oil-temperature \"{text}\" is not a valid oil temperature");
                return Err(Failure::input(message, "write a temperature from -60 to 250 degC"));
            }
            Some(given)
        }
        None => None,
    };
    Ok(PreparedPoint {
        case,
        gear,
        speeds: speeds.iter().map(|s| s.1).collect(),
        torques: torques.iter().map(|s| s.1).collect(),
        oil: OilTemperature::from_conditions(transmission, given),
        flow: if args.power_flow == FlowArg::Real {
            PowerFlow::Real
        } else {
            PowerFlow::Ideal
        },
    })
}
