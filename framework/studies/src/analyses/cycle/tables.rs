//! The thermal network of a gearbox with tables instead of models, for programs that simulate it themselves.
//!
//! The losses of each part are tabulated over speed, torque and the temperatures of the nodes on which they depend, the conductances of
//! links over what they depend on. The tables cover what the cycles of the analysis reach, with a margin.

mod links;
mod losses;
mod motors;
mod ranges;
mod replay;
mod sweep;

use gearloss_fmu::Experiment;
use gearloss_fmu::content::Content;
use gearloss_fmu::network as fmu;
use gearloss_fmu::table::Table;
use gearloss_framework::thermal::Arrangement;
use gearloss_framework::thermal::network::{Network, Rate, StepSize};
use gearloss_framework::transmission::{Case, Transmission};

use self::losses::{Failed, Tabulated};
use self::ranges::{Ranges, SINGLE, spaced, temperature_axis};
use self::replay::{deviation_of, experiment, rows};
use super::super::common::units::speed_ratio;
use super::super::{Built, Engine, Planner, Stopped};
use crate::analyses::common::duties::{Duties, Read};
use crate::distinct::distinct;
use crate::duty::Duty;
use crate::points::{Driven, OilTemperature};

/// A network in tables.
#[derive(Debug, Clone)]
pub struct NetworkTables {
    /// Name of the model set.
    pub model_set: String,
    /// The network.
    pub content: Content,
    /// The first cycle as inputs.
    pub experiment: Experiment,
    /// Number of values in the tables.
    pub values: usize,
    /// Number of loads without losses, where those of a smaller torque are used.
    pub filled: usize,
    /// Largest deviation of the oil and of any node from the simulated cycles. \[K\]
    pub deviation: [f64; 2],
    /// Ranges in words.
    pub about: String,
}

/// The network of a gearbox whose cycles were simulated.
pub fn tabulate(
    engine: &Engine<'_>,
    b: &Built<'_>,
    duties: &Duties<'_>,
    driven: &[Driven],
) -> Result<NetworkTables, Stopped> {
    let t = &b.transmission;
    let network = network(engine, b, duties)?;
    let failed = |message: String| {
        engine.wrong(
            &format!("{}.export", engine.path()),
            message,
            "examine the point with `explain`",
        )
    };
    let ranges = Ranges::new(network, driven).ok_or_else(|| failed("no cycle has a torque and a speed".to_owned()))?;
    let first = &duties.list[0];
    let stretches = driven.iter().flat_map(|driven| &driven.stretches);
    let gears = distinct(stretches.map(|stretch| &t.states()[stretch.gear].name));
    let mut filled = 0;
    let mut all = Vec::new();
    for gear in &gears {
        let work = Tabulated {
            t,
            network,
            ranges: &ranges,
            case: case(t, gear).map_err(|list| b.gearbox.findings(list))?,
            flow: engine.study.entry.conditions.power_flow,
        };
        let (losses, missing) = work.losses(engine, gear).map_err(|why| match why {
            Failed::Undefined(message) => failed(format!("gear {gear}: {message}")),
            Failed::Stopped(stopped) => stopped,
        })?;
        filled += missing;
        all.push(fmu::GearOfNetwork {
            name: (*gear).clone(),
            ratio: speed_ratio(t, gear),
            losses,
            motors: work
                .motors()
                .map_err(|message| failed(format!("gear {gear}: {message}")))?,
            links: work
                .links()
                .map_err(|message| failed(format!("gear {gear}: {message}")))?,
        });
    }
    let start = &driven[0].start;
    let properties = spaced(ranges.temperatures, SINGLE);
    let content = fmu::Network {
        nodes: (0..network.names().len())
            .map(|i| fmu::Node {
                name: network.names()[i].clone(),
                capacity: network.capacities()[i],
                held: network.held(i),
                start: start[i],
            })
            .collect(),
        oil: network.oil() as u32,
        step: match duties.ride(t, first).step {
            StepSize::Fixed(step) => step,
            StepSize::Adaptive(_) => 1.0,
        },
        pumped: network.pumped(),
        oil_properties: Table {
            values: properties.iter().flat_map(|oil| network.oil_properties(*oil)).collect(),
            axes: vec![temperature_axis(network.oil(), properties)],
            channels: 2,
        },
        exchangers: exchangers(network),
        flows: network
            .flows()
            .iter()
            .map(|([from, to], flow)| (*from as u32, *to as u32, rate(*flow)))
            .collect(),
        sources: network
            .sources()
            .iter()
            .map(|(node, heat)| (*node as u32, *heat))
            .collect(),
        vehicle_speed: all.iter().flat_map(|gear| &gear.links).any(on_vehicle),
        gears: all,
        starts: vec![0.0, 0.0, 0.0, start[0]],
    };
    let values = count_values(&content);
    let content = Content::Network(content);
    let rows = |read: &Read, driven: &Driven| rows(&content, network, read, driven, (t, &gears));
    let mut deviation = [0.0_f64; 2];
    for (read, driven) in duties.list.iter().zip(driven) {
        let of_cycle = deviation_of(&content, network, driven, &rows(read, driven));
        deviation = [deviation[0].max(of_cycle[0]), deviation[1].max(of_cycle[1])];
    }
    let experiment = experiment(&rows(first, &driven[0]), &driven[0]);
    Ok(NetworkTables {
        model_set: b.name.clone(),
        experiment,
        values,
        filled,
        deviation,
        about: ranges.about(&gears),
        content,
    })
}

/// The thermal network of a gearbox, if its cycles simulate it in time.
pub fn network<'a>(cx: &Planner<'_>, b: &'a Built<'_>, duties: &Duties<'_>) -> Result<&'a Network, Stopped> {
    let oil = OilTemperature::from_conditions(&b.transmission, cx.study.entry.conditions.oil_temperature);
    let in_time = duties.list.iter().all(|read| matches!(read.duty, Duty::Trace(_)));
    let network = b
        .transmission
        .network()
        .filter(|_| oil == OilTemperature::Network && in_time);
    if network.is_some() && b.transmission.travels() {
        return Err(cx.wrong(
            &format!("{}.export", cx.path()),
            "the losses in the FMU are those on a level road, but `housing.travel` inclines the oil in cycles",
            "delete `housing.travel`, or the export",
        ));
    }
    if network.is_some_and(Network::uses_oil_network) {
        return Err(cx.wrong(
            &format!("{}.export", cx.path()),
            "the FMU of a cycle has one oil flow, but flows of the oil network carry heat in this network",
            "state `oil_flow` and shares of it in `thermal.network`, instead of `element` and `nozzle`",
        ));
    }
    if let Some(machine) = network.and_then(|network| network.inverters().next()) {
        return Err(cx.wrong(
            &format!("{}.export", cx.path()),
            format!("the FMU of a cycle has no heat of inverters, but that of `{machine}` heats a node"),
            "delete `inverter.node` of the machine, or the export",
        ));
    }
    network.ok_or_else(|| {
        cx.wrong(
            &format!("{}.export", cx.path()),
            "the FMU of a cycle is a thermal network, which these cycles do not simulate",
            "write `thermal: { mode: network, network: auto }` in the gearbox and use cycles in time; losses without a network are exported by a `map`",
        )
    })
}

/// The case of torque and speed at the reference port.
fn case(t: &Transmission, gear: &str) -> Result<Case, Vec<gearloss_framework::document::Diagnostic>> {
    let state = t.state(gear).map_err(|e| vec![e])?;
    t.takes_one(state).map_err(|e| vec![e])?;
    let port = t.ports()[t.reference_port()].name.as_str();
    let torques: &[&str] = if t.torques_needed(state) == 0 { &[] } else { &[port] };
    t.case(gear, &[port], torques)
}

fn rate(rate: Rate) -> fmu::Flow {
    match rate {
        Rate::Given(given) => fmu::Flow::Given(given),
        // A network with flows of elements is refused.
        Rate::Share(share) | Rate::Element(_, share) => fmu::Flow::Share(share),
    }
}

fn exchangers(network: &Network) -> Vec<fmu::Exchanger> {
    let of = |(path, e): (&str, gearloss_framework::thermal::network::ExchangerNumbers)| fmu::Exchanger {
        name: path.rsplit('.').next().unwrap_or(path).to_owned(),
        from: e.between[0] as u32,
        to: e.between[1] as u32,
        oil: rate(e.oil),
        ua: e.ua,
        arrangement: match e.arrangement {
            Arrangement::Counterflow => 0,
            Arrangement::Parallel => 1,
            Arrangement::Crossflow => 2,
        },
        coolant_heat_capacity: e.coolant_heat_capacity,
        coolant_flow: e.coolant_flow,
        coolant_temperature: e.coolant_temperature,
    };
    network.exchangers().zip(network.exchanger_numbers()).map(of).collect()
}

fn on_vehicle(link: &fmu::Link) -> bool {
    match &link.conductance {
        fmu::Conductance::Given(_) => false,
        fmu::Conductance::Table(table) => table.axes.iter().any(|axis| axis.quantity == fmu::VEHICLE),
    }
}

fn count_values(network: &fmu::Network) -> usize {
    let of_gear = |gear: &fmu::GearOfNetwork| {
        let sources = gear
            .losses
            .iter()
            .chain(&gear.motors)
            .map(|source| source.table.values.len());
        let links = gear.links.iter().map(|link| match &link.conductance {
            fmu::Conductance::Given(_) => 1,
            fmu::Conductance::Table(table) => table.values.len(),
        });
        sources.chain(links).sum::<usize>()
    };
    network.gears.iter().map(of_gear).sum()
}
