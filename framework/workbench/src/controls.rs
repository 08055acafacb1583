//! What a point of a gearbox is made of: gears with their torques and speeds, model sets, oil temperature.

use std::path::Path;

use gearloss_framework::description::ThermalMode;
use gearloss_framework::files::{SharedSource, without_dots};
use gearloss_framework::language::Language;
use gearloss_framework::transmission::Transmission;
use gearloss_report::html::point_of_report;
use gearloss_studies::analyses::Planner;
use gearloss_studies::engine::progress::Progress;
use gearloss_studies::numbers::RPM;
use gearloss_studies::study::Study;
use serde::Serialize;
use serde_json::Value;

use crate::answer::Fault;
use crate::chosen::Chosen;
use crate::request::{GivenInput, PointOf, Quantity};

/// Torque and speed up to which the sliders reach if nothing states any. \[Nm, rpm\]
const USUAL: [f64; 2] = [100.0, 3000.0];

/// First values as shares of the ranges, the preferred one first.
const SHARES: [f64; 4] = [0.5, 0.25, 0.1, 0.02];

/// What a point of a gearbox is made of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Controls {
    /// Title of the gearbox.
    pub title: String,
    /// Gear states.
    pub gears: Vec<GearControls>,
    /// Model sets; the first, empty one stands for the models of the gearbox itself.
    pub model_sets: Vec<String>,
    /// Origin of the oil temperature.
    pub oil: OilControls,
    /// Volume of the oil; absent if the oil space is not known.
    pub fill: Option<FillControls>,
}

/// A gear state with what has to be given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GearControls {
    /// Name.
    pub name: String,
    /// Torques and speeds.
    pub inputs: Vec<InputControls>,
}

/// A torque or speed with the range of its slider.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct InputControls {
    /// Quantity.
    pub quantity: Quantity,
    /// Port.
    pub port: String,
    /// Unit of the numbers.
    pub unit: &'static str,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// First value.
    pub value: f64,
}

impl InputControls {
    /// The input with its first value.
    fn given(&self) -> GivenInput {
        GivenInput {
            quantity: self.quantity,
            port: self.port.clone(),
            value: self.value,
        }
    }
}

/// Origin of the oil temperature.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OilControls {
    /// `fixed`, `balance` or `network`.
    pub mode: ThermalMode,
    /// Temperature of `fixed`. [degC]
    pub value: Option<f64>,
}

/// Volume of the oil with the range of its slider. \[l\]
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FillControls {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// That of the file, or of its level.
    pub value: f64,
}

/// Shares of the full oil space at the ends of the slider of the volume.
const FILLED: [f64; 2] = [0.05, 0.9];

/// The volume of the oil of a gearbox.
fn fill(chosen: &Chosen) -> Option<FillControls> {
    let space = chosen.transmission.oil_space()?.space();
    let oil = &chosen.resolved.value["housing"]["oil"];
    let expansion = chosen.transmission.oil_expansion(oil["fill_temperature"].as_f64()?);
    let stated = oil["volume"].as_f64();
    // That below a level has the temperature of the oil.
    let value = stated.or_else(|| Some(chosen.transmission.oil_fill()?.0 / expansion))?;
    let circuit = oil["circuit_volume"].as_f64().unwrap_or(0.0);
    let [from, to] = FILLED.map(|share| rounded((share * space.full() + circuit) / expansion * 1e3));
    let value = rounded(value * 1e3);
    Some(FillControls {
        from: from.min(value),
        to: to.max(value),
        value,
    })
}

/// The controls of a gearbox. `studies` lists files that may state where it is used.
pub fn controls(
    language: &Language,
    files: &SharedSource,
    gearbox: &str,
    studies: &dyn Fn() -> Vec<String>,
    progress: &dyn Progress,
) -> Result<Controls, Fault> {
    let chosen = Chosen::read(language, files, gearbox, "", progress)?;
    let transmission = &chosen.transmission;
    let ends = transmission
        .rating
        .as_ref()
        .map(|rating| [rating.torque, rating.speed * RPM]);
    let ends = ends.or_else(|| {
        let mut studies = studies().into_iter().take_while(|_| progress.should_continue());
        studies.find_map(|study| in_study(language, files, &study, gearbox, transmission))
    });
    let mode = thermal_mode(&chosen.resolved.value);
    Ok(Controls {
        title: transmission.title().to_owned(),
        gears: start(&chosen, gearbox, ends.unwrap_or(USUAL)),
        model_sets: model_sets(language, &chosen.gearbox.value),
        oil: OilControls {
            value: Some(transmission.oil_temperature).filter(|_| mode == ThermalMode::Fixed),
            mode,
        },
        fill: fill(&chosen),
    })
}

fn thermal_mode(resolved: &Value) -> ThermalMode {
    serde_json::from_value(resolved["thermal"]["mode"].clone()).unwrap_or(ThermalMode::Fixed)
}

/// The gears with first values in the middle of their ranges, or nearer to zero if there is no result: a drive may not stand half of its
/// rating for ever.
fn start(chosen: &Chosen, gearbox: &str, ends: [f64; 2]) -> Vec<GearControls> {
    let transmission = &chosen.transmission;
    let has_result = |gears: &[GearControls]| {
        let gear = gears
            .iter()
            .find(|gear| gear.inputs.iter().any(|input| input.quantity == Quantity::Torque));
        let Some(gear) = gear else { return true };
        let point = PointOf {
            gearbox: gearbox.to_owned(),
            gear: gear.name.clone(),
            inputs: gear.inputs.iter().map(InputControls::given).collect(),
            oil_temperature: None,
            oil_volume: None,
            model_set: String::new(),
        };
        chosen.prepare(&point).is_ok_and(|prepared| {
            let mut scratch = transmission.scratch(&prepared.case);
            prepared.solve(transmission, &mut scratch).solution.loss().is_some()
        })
    };
    let tried = SHARES.into_iter().map(|share| gears(transmission, ends, share));
    let found = tried.clone().find(|gears| has_result(gears));
    found.unwrap_or_else(|| gears(transmission, ends, SHARES[0]))
}

/// The gears with first values at a share of their ranges, at the ports that `solve` assumes.
fn gears(transmission: &Transmission, [torque, speed]: [f64; 2], share: f64) -> Vec<GearControls> {
    let ports = transmission.ports();
    let input = |quantity, port: usize, to: f64, value: f64| InputControls {
        quantity,
        port: ports[port].name.clone(),
        unit: match quantity {
            Quantity::Torque => "Nm",
            Quantity::Speed => "rpm",
        },
        from: rounded(value.min(0.0) * 2.0),
        to: rounded(to.max(2.0 * value)),
        value: rounded(value),
    };
    let states = transmission.states().iter().enumerate();
    let states = states.map(|(number, state)| {
        // The port of reference first, as in `solve`.
        let reference = transmission.reference_port();
        let others = (0..ports.len()).filter(|port| *port != reference);
        let at_torques = [reference].into_iter().chain(others);
        let at_torques: Vec<usize> = at_torques.take(transmission.torques_needed(number)).collect();
        let torques = at_torques
            .iter()
            .map(|port| input(Quantity::Torque, *port, torque, share * torque));
        let parts = parts(transmission, &state.name, &state.speed_ports, &at_torques);
        let speeds = state.speed_ports.iter().zip(parts);
        let speeds = speeds.map(|(port, part)| input(Quantity::Speed, *port, speed, share * speed * part));
        GearControls {
            name: state.name.clone(),
            inputs: torques.chain(speeds).collect(),
        }
    });
    states.collect()
}

/// Speeds at the ports of a gear state relative to the first of them: those at which the members turn slowest in the sum of squares, so
/// that both outputs of a differential turn alike and what the first does not drive stands.
fn parts(transmission: &Transmission, gear: &str, speed_ports: &[usize], torque_ports: &[usize]) -> Vec<f64> {
    let names = |ports: &[usize]| -> Vec<&str> {
        ports
            .iter()
            .map(|port| transmission.ports()[*port].name.as_str())
            .collect()
    };
    let mut parts = vec![0.0; speed_ports.len()];
    let Some(first) = parts.first_mut() else { return parts };
    *first = 1.0;
    let Ok(case) = transmission.case(gear, &names(speed_ports), &names(torque_ports)) else {
        return parts;
    };
    for port in 1..speed_ports.len() {
        let mut unit = vec![0.0; speed_ports.len()];
        unit[port] = 1.0;
        let (so_far, of_port) = (transmission.speeds(&case, &parts), transmission.speeds(&case, &unit));
        let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let share = -product(&so_far, &of_port) / product(&of_port, &of_port);
        parts[port] = if share.is_finite() { share } else { 0.0 };
    }
    parts
}

/// With the digits that a slider needs; conversion of units leaves rounding errors.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// Model sets of a gearbox and those that are shipped.
fn model_sets(language: &Language, gearbox: &Value) -> Vec<String> {
    let sets = gearbox["model_sets"].as_object();
    let sets = sets.into_iter().flatten().map(|(name, _)| name.clone());
    let mut names = vec![String::new()];
    for name in sets.chain(language.shipped_sets().keys().cloned()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The greatest torque and speed at which a study uses a gearbox. \[Nm, rpm\]
fn in_study(
    language: &Language,
    files: &SharedSource,
    study: &str,
    gearbox: &str,
    transmission: &Transmission,
) -> Option<[f64; 2]> {
    let read = Study::read_from(language, files, Path::new(study)).ok()?;
    let folder = Path::new(study).parent()?;
    let uses = |file: &str| without_dots(&folder.join(file)) == without_dots(Path::new(gearbox));
    read.entry.gearboxes.iter().find(|(_, file)| uses(file))?;
    let cx = Planner::new(language, &read, "workbench");
    let (_, given) = point_of_report(&cx, transmission)?;
    let ends = [given.torque.abs(), given.speed.abs() * RPM];
    ends.iter().all(|end| *end > 0.0).then_some(ends)
}
