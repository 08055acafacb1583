//! The thermal network of a gearbox with tables instead of models, for programs that simulate it themselves.
//!
//! The losses of each part are tabulated over speed, torque and the temperatures of the nodes on which they depend, the conductances of
//! links over what they depend on. The tables cover what the cycles of the analysis reach, with a margin.

use gearloss_fmu::Experiment;
use gearloss_fmu::content::Content;
use gearloss_fmu::model::Model;
use gearloss_fmu::network as fmu;
use gearloss_fmu::table::{Axis, Table};
use gearloss_fmu::variables::{Causality, Slot, Use};
use gearloss_framework::evaluate::{BatchScratch, PowerFlow};
use gearloss_framework::thermal::Arrangement;
use gearloss_framework::thermal::network::{LinkState, Load, Network, NodeHeats, Rate, StepSize};
use gearloss_framework::transmission::{Case, Transmission};

use super::super::units::speed_ratio;
use super::super::{Built, Context, Stopped};
use crate::analyses::duties::{Duties, Read};
use crate::analyses::numbers::RPM;
use crate::distinct::distinct;
use crate::duty::Duty;
use crate::points::{Driven, OilTemperature};

/// Numbers of points over torque on each side of zero, and over speed.
const LOADS: [usize; 2] = [10, 20];
/// Numbers of points over the temperatures of the nodes on which a loss depends, the one that matters most first.
const TEMPERATURES: [&[usize]; 4] = [&[], &[17], &[11, 5], &[9, 4, 4]];
/// Number of points over a temperature of anything else.
const SINGLE: usize = 13;
/// Number of points over speed of the vehicle, and over oil flow.
const VEHICLE: usize = 9;
/// See [`VEHICLE`].
const FLOW: usize = 5;
/// A loss depends on the temperature of a node if that changes it by more than this share over [`PROBE`].
const MATTERS: f64 = 2e-3;
/// Change of temperature by which dependence is found. \[K\]
const PROBE: f64 = 20.0;
/// Speed below which a motor is off without torque. \[rad/s\]
const SLOWEST: f64 = 0.1;
/// Maximum number of rows of the reference inputs.
const MOST_ROWS: usize = 20_000;

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

/// Ranges of the tables.
struct Ranges {
    torques: Vec<f64>,
    /// Begins with standstill.
    speeds: Vec<f64>,
    /// Lowest and highest temperature. \[degC\]
    temperatures: [f64; 2],
    vehicle: Vec<f64>,
    /// Mass flows of the oil. \[kg/s\]
    flows: Vec<f64>,
}

/// The network of a gearbox whose cycles were simulated.
pub fn tabulate(
    cx: &Context<'_>,
    b: &Built<'_>,
    duties: &Duties<'_>,
    driven: &[Driven],
) -> Result<NetworkTables, Stopped> {
    let t = &b.transmission;
    let network = network(cx, b, duties)?;
    let failed = |message: String| {
        cx.wrong(
            &format!("{}.export", cx.path()),
            message,
            "examine the point with `explain`",
        )
    };
    let ranges = Ranges::new(network, driven).ok_or_else(|| failed("no cycle has a torque and a speed".to_owned()))?;
    let first = &duties.list[0];
    let own_gear = duties.ride(t, first).gear.to_owned();
    let given = duties.list.iter().flat_map(|read| &read.intervals);
    let gears = distinct(given.map(|interval| interval.given.gear.as_ref().unwrap_or(&own_gear)));
    let mut filled = 0;
    let mut all = Vec::new();
    for gear in &gears {
        let work = Tabulated {
            t,
            network,
            ranges: &ranges,
            case: case(t, gear).map_err(|list| b.gearbox.findings(list))?,
            flow: cx.study.entry.conditions.power_flow,
        };
        let (losses, missing) = work.losses(cx, gear).map_err(|why| match why {
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
    let properties = Tabulated::spaced(ranges.temperatures, SINGLE);
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
    let rows = |read: &Read, driven: &Driven| rows(&content, network, read, driven, (&gears, &own_gear));
    let mut deviation = [0.0_f64; 2];
    for (read, driven) in duties.list.iter().zip(driven) {
        let own = deviation_of(&content, network, driven, &rows(read, driven));
        deviation = [deviation[0].max(own[0]), deviation[1].max(own[1])];
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
pub fn network<'a>(cx: &Context<'_>, b: &'a Built<'_>, duties: &Duties<'_>) -> Result<&'a Network, Stopped> {
    let oil = OilTemperature::from_conditions(&b.transmission, cx.study.entry.conditions.oil_temperature);
    let in_time = duties.list.iter().all(|read| matches!(read.duty, Duty::Trace(_)));
    let network = b
        .transmission
        .network()
        .filter(|_| oil == OilTemperature::Network && in_time);
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

fn temperature_axis(node: usize, points: Vec<f64>) -> Axis {
    Axis {
        quantity: fmu::TEMPERATURES + node as u32,
        points,
    }
}

fn rate(rate: Rate) -> fmu::Flow {
    match rate {
        Rate::Given(given) => fmu::Flow::Given(given),
        Rate::Share(share) => fmu::Flow::Share(share),
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

impl Ranges {
    /// What the cycles reach, with a margin; absent if nothing turns.
    fn new(network: &Network, driven: &[Driven]) -> Option<Self> {
        let all = || driven.iter().flat_map(|driven| &driven.stretches);
        let [mut low, mut high, mut fast, mut vehicle] = [0.0_f64; 4];
        for stretch in all() {
            (low, high) = (low.min(stretch.torque), high.max(stretch.torque));
            fast = fast.max(stretch.speed.abs());
            vehicle = vehicle.max(stretch.vehicle_speed.unwrap_or(0.0).abs());
        }
        let nodes = all().flat_map(|stretch| &stretch.temperatures);
        let nodes = nodes.chain(driven.iter().flat_map(|driven| &driven.start));
        let held = (0..network.names().len()).filter_map(|node| network.held(node));
        let coolant = network.exchanger_numbers().map(|e| e.coolant_temperature);
        let ends = nodes.copied().chain(held).chain(coolant);
        let [cold, hot] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| {
            [low.min(t), high.max(t)]
        });
        if fast == 0.0 || low == high || cold > hot {
            return None;
        }
        let [per_side, speeds] = LOADS;
        // Denser near zero, where losses bend.
        let power = |power: f64| move |i: usize, count: usize| (i as f64 / count as f64).powf(power);
        let (share, dense) = (power(1.5), power(2.0));
        let side = |end: f64| (1..=per_side).map(move |i| 1.05 * end * dense(i, per_side));
        let mut torques = vec![0.0];
        torques.extend(side(low).chain(side(high)).filter(|torque| *torque != 0.0));
        torques.sort_by(f64::total_cmp);
        let mass = network.pumped().unwrap_or(0.0) * network.oil_properties(0.5 * (cold + hot))[0];
        Some(Self {
            torques,
            speeds: (0..=speeds).map(|i| 1.05 * fast * share(i, speeds)).collect(),
            temperatures: [(cold - 10.0).floor(), (hot + 20.0).ceil()],
            vehicle: (0..VEHICLE)
                .map(|i| 1.05 * vehicle.max(10.0) * share(i, VEHICLE - 1))
                .collect(),
            flows: if mass > 0.0 {
                (0..FLOW).map(|i| 2.0 * mass * share(i, FLOW - 1)).collect()
            } else {
                vec![0.0]
            },
        })
    }

    fn about(&self, gears: &[&String]) -> String {
        let last = |axis: &[f64]| axis[axis.len() - 1];
        let names: Vec<&str> = gears.iter().map(|gear| gear.as_str()).collect();
        format!(
            "gears {}, {:.0} to {:.0} Nm, up to {:.0} rpm, {} to {} degC",
            names.join(", "),
            self.torques[0],
            last(&self.torques),
            last(&self.speeds) * RPM,
            self.temperatures[0],
            self.temperatures[1]
        )
    }
}

/// Why there are no tables.
enum Failed {
    /// A loss or a conductance has no value.
    Undefined(String),
    Stopped(Stopped),
}

impl From<Stopped> for Failed {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}

impl From<String> for Failed {
    fn from(what: String) -> Self {
        Self::Undefined(what)
    }
}

/// Groups that are tabulated together: the same combinations of temperatures, by rank of the nodes in each group.
struct Sweep {
    groups: Vec<usize>,
    /// Rank of each node in the groups that depend on it; absent if none does.
    ranks: Vec<Option<usize>>,
    /// Temperatures by rank. \[degC\]
    axes: Vec<Vec<f64>>,
}

impl Sweep {
    /// As few as possible for all groups.
    fn all(groups: &[Group], nodes: usize, temperatures: [f64; 2]) -> Vec<Self> {
        let mut sweeps: Vec<Self> = Vec::new();
        for (place, group) in groups.iter().enumerate() {
            if sweeps.iter_mut().any(|sweep| sweep.join(place, group)) {
                continue;
            }
            let counts = TEMPERATURES[group.nodes.len()];
            let mut own = Self {
                groups: Vec::new(),
                ranks: vec![None; nodes],
                axes: counts
                    .iter()
                    .map(|count| Tabulated::spaced(temperatures, *count))
                    .collect(),
            };
            own.join(place, group);
            sweeps.push(own);
        }
        sweeps
    }

    /// Adds a group whose nodes have no other rank in the groups before; true if it is one.
    fn join(&mut self, place: usize, group: &Group) -> bool {
        let ranked = || group.nodes.iter().zip(0..);
        let fits = ranked().all(|(node, rank)| self.ranks[*node].is_none_or(|own| own == rank));
        if !fits || group.nodes.len() != self.axes.len() {
            return false;
        }
        for (node, rank) in ranked() {
            self.ranks[*node] = Some(rank);
        }
        self.groups.push(place);
        true
    }

    /// Number of combinations.
    fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product()
    }

    /// Temperatures of all nodes in a combination; the last rank varies fastest. Nodes that hardly matter have the mean of the others, or
    /// `middle`. \[degC\]
    fn temperatures(&self, combination: usize, middle: f64) -> Vec<f64> {
        let (mut rest, mut given) = (combination, vec![0.0; self.axes.len()]);
        for (own, axis) in given.iter_mut().zip(&self.axes).rev() {
            *own = axis[rest % axis.len()];
            rest /= axis.len();
        }
        let mean = given.iter().sum::<f64>() / given.len().max(1) as f64;
        let mean = if given.is_empty() { middle } else { mean };
        let of = |rank: &Option<usize>| rank.map_or(mean, |rank| given[rank]);
        self.ranks.iter().map(of).collect()
    }
}

/// A number with the precision of the tables.
fn short(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Tabulation of one gear.
struct Tabulated<'a> {
    t: &'a Transmission,
    network: &'a Network,
    ranges: &'a Ranges,
    case: Case,
    flow: PowerFlow,
}

/// Parts that depend on the same nodes.
struct Group {
    nodes: Vec<usize>,
    parts: Vec<usize>,
    /// Nodes that they heat.
    heated: Vec<usize>,
}

impl Tabulated<'_> {
    /// Points of a range of temperatures, ends included: denser where it is cold, where the viscosity of oils bends most.
    fn spaced([from, to]: [f64; 2], count: usize) -> Vec<f64> {
        let last = count.saturating_sub(1).max(1) as f64;
        (0..count)
            .map(|i| from + (to - from) * (i as f64 / last).powf(1.4))
            .collect()
    }

    fn middle(&self) -> f64 {
        0.5 * (self.ranges.temperatures[0] + self.ranges.temperatures[1])
    }

    fn heats(&self, loads: &[Load], scratch: &mut BatchScratch) -> Vec<Option<NodeHeats>> {
        let found = self.t.node_heats(self.network, &self.case, self.flow, loads, scratch);
        found.into_iter().map(Result::ok).collect()
    }

    /// Groups of parts by the nodes whose temperatures change their losses.
    fn groups(&self, scratch: &mut BatchScratch) -> Result<Vec<Group>, String> {
        let count = self.network.names().len();
        let Ranges { torques, speeds, .. } = self.ranges;
        let even = vec![self.middle(); count];
        let mut strength = vec![vec![0.0_f64; count]; self.t.parts().len()];
        let mut heated = vec![Vec::new(); self.t.parts().len()];
        let [fast, slow] = [speeds.len() / 2, speeds.len() / 6 + 1].map(|i| speeds[i]);
        let mut is_known = false;
        for torque in [0.6 * torques[0], 0.0, 0.6 * torques[torques.len() - 1]] {
            for speed in [slow, fast] {
                let load = |temperatures: Vec<f64>| Load {
                    torque,
                    speed,
                    temperatures,
                };
                let mut loads = vec![load(even.clone())];
                for node in 0..count {
                    let mut own = even.clone();
                    own[node] -= PROBE;
                    loads.push(load(own));
                }
                let Some(all) = self.heats(&loads, scratch).into_iter().collect::<Option<Vec<_>>>() else {
                    continue;
                };
                is_known = true;
                let watts =
                    |heats: &NodeHeats, part: usize| heats.parts[part].iter().map(|(_, watts)| watts).sum::<f64>();
                for part in 0..self.t.parts().len() {
                    let base = watts(&all[0], part);
                    if heated[part].is_empty() {
                        heated[part] = all[0].parts[part].iter().map(|(node, _)| *node).collect();
                    }
                    for node in 0..count {
                        let change = (watts(&all[node + 1], part) / base - 1.0).abs();
                        if change.is_finite() {
                            strength[part][node] = strength[part][node].max(change);
                        }
                    }
                }
            }
        }
        if !is_known {
            return Err("no loss has a value in the middle of the tables".to_owned());
        }
        let mut groups: Vec<Group> = Vec::new();
        for (part, (strength, heated)) in strength.iter().zip(heated).enumerate() {
            let mut nodes: Vec<usize> = (0..count).filter(|node| strength[*node] > MATTERS).collect();
            nodes.sort_by(|a, b| strength[*b].total_cmp(&strength[*a]));
            nodes.truncate(TEMPERATURES.len() - 1);
            match groups.iter_mut().find(|group| group.nodes == nodes) {
                Some(group) => {
                    group.parts.push(part);
                    let more: Vec<usize> = heated.into_iter().filter(|node| !group.heated.contains(node)).collect();
                    group.heated.extend(more);
                }
                None => groups.push(Group {
                    nodes,
                    parts: vec![part],
                    heated,
                }),
            }
        }
        Ok(groups)
    }

    /// Losses as heat into nodes over the speed of the reference port, and the number of loads without losses.
    fn losses(&self, cx: &Context<'_>, gear: &str) -> Result<(Vec<fmu::Source>, usize), Failed> {
        let mut scratch = self.t.batch_scratch(&self.case);
        let Ranges { torques, speeds, .. } = self.ranges;
        let groups = self.groups(&mut scratch)?;
        let mut filled = 0;
        let mut sources: Vec<Option<fmu::Source>> = groups.iter().map(|_| None).collect();
        for sweep in Sweep::all(&groups, self.network.names().len(), self.ranges.temperatures) {
            let combinations = sweep.len();
            let label = format!("tables, gear {gear}");
            let solved = cx.each(&label, combinations, |combination| {
                self.solve(&groups, &sweep, combination)
            })?;
            for place in &sweep.groups {
                let group = &groups[*place];
                let mut axes = self.load_axes();
                let temperatures = group.nodes.iter().zip(&sweep.axes);
                axes.extend(temperatures.map(|(node, axis)| temperature_axis(*node, axis.clone())));
                let channels = group.heated.len();
                sources[*place] = Some(fmu::Source {
                    table: Table {
                        axes,
                        channels,
                        values: vec![0.0; speeds.len() * torques.len() * combinations * channels],
                    },
                    nodes: group.heated.iter().map(|node| *node as u32).collect(),
                    over_speed: true,
                });
            }
            for (combination, solved) in solved.into_iter().enumerate() {
                let (losses, missing) = solved.map_err(Failed::Undefined)?;
                filled += missing;
                for (place, losses) in sweep.groups.iter().zip(losses) {
                    let Some(source) = &mut sources[*place] else { continue };
                    let channels = source.table.channels;
                    for (load, values) in losses.chunks(channels.max(1)).enumerate() {
                        let at = (load * combinations + combination) * channels;
                        source.table.values[at..at + channels].copy_from_slice(values);
                    }
                }
            }
        }
        Ok((sources.into_iter().flatten().collect(), filled))
    }

    /// Heat over speed of each group of a sweep at all loads and one combination of temperatures: by speed, torque and heated node; and the
    /// number of loads without losses.
    fn solve(&self, groups: &[Group], sweep: &Sweep, combination: usize) -> Result<(Vec<Vec<f64>>, usize), String> {
        let Ranges { torques, speeds, .. } = self.ranges;
        let temperatures = sweep.temperatures(combination, self.middle());
        let loads: Vec<Load> = torques
            .iter()
            .flat_map(|torque| speeds[1..].iter().map(move |speed| (*torque, *speed)))
            .map(|(torque, speed)| Load {
                torque,
                speed,
                temperatures: temperatures.clone(),
            })
            .collect();
        let heats = self.heats(&loads, &mut self.t.batch_scratch(&self.case));
        let mut losses: Vec<Vec<f64>> = sweep
            .groups
            .iter()
            .map(|place| vec![0.0; speeds.len() * torques.len() * groups[*place].heated.len()])
            .collect();
        let mut filled = 0;
        for w in 0..speeds.len() {
            // At standstill as at the lowest speed: over the speed, the heat of friction has a limit.
            let column = w.max(1) - 1;
            for t in 0..torques.len() {
                let Some((heats, is_own)) = nearest(&heats, torques, (t, column), speeds.len() - 1) else {
                    let rpm = speeds[column + 1] * RPM;
                    return Err(format!("at {rpm:.0} rpm no torque has losses with a value"));
                };
                filled += usize::from(!is_own && w > 0);
                for (place, values) in sweep.groups.iter().zip(&mut losses) {
                    let group = &groups[*place];
                    let at = (w * torques.len() + t) * group.heated.len();
                    for (node, watts) in group.parts.iter().flat_map(|part| &heats.parts[*part]) {
                        let channel = group.heated.iter().position(|own| own == node).unwrap_or(0);
                        values[at + channel] += watts / speeds[column + 1];
                    }
                }
            }
        }
        for value in losses.iter_mut().flatten() {
            *value = short(*value);
        }
        Ok((losses, filled))
    }

    fn load_axes(&self) -> Vec<Axis> {
        [(fmu::SPEED, &self.ranges.speeds), (fmu::TORQUE, &self.ranges.torques)]
            .map(|(quantity, points)| Axis {
                quantity,
                points: points.clone(),
            })
            .into()
    }

    /// Losses of the motors, at the reference port over the axes of their own maps.
    fn motors(&self) -> Result<Vec<fmu::Source>, String> {
        let mut sources = Vec::new();
        let reference = self.t.ports()[self.t.reference_port()].member;
        for motor in 0..self.network.motors().len() {
            let (member, nodes) = self.network.motor_nodes(motor);
            let table = if member == reference {
                self.own_motor(motor, nodes[1])
            } else {
                self.other_motor(motor, nodes[1])?
            };
            sources.push(fmu::Source {
                table,
                nodes: nodes.map(|node| node as u32).into(),
                over_speed: false,
            });
        }
        Ok(sources)
    }

    fn own_motor(&self, motor: usize, stator: usize) -> Table {
        let [mut speeds, torques] = self.network.motor_axes(motor);
        speeds.retain(|speed| *speed > SLOWEST);
        speeds.splice(0..0, [0.0, SLOWEST]);
        let mut both: Vec<f64> = torques.iter().rev().map(|torque| -torque).collect();
        both.push(0.0);
        both.extend(torques);
        both.dedup();
        let [cold, hot] = self.ranges.temperatures;
        let same = |(speed, torque): (&f64, &f64)| {
            self.network.motor_loss(motor, *speed, *torque, cold)
                == self.network.motor_loss(motor, *speed, *torque, hot)
        };
        let is_same = speeds
            .iter()
            .all(|speed| both.iter().all(|torque| same((speed, torque))));
        let temperatures = Self::spaced([cold, hot], if is_same { 1 } else { SINGLE });
        let mut values = Vec::new();
        for speed in &speeds {
            for torque in &both {
                for temperature in &temperatures {
                    values.extend(self.network.motor_loss(motor, *speed, *torque, *temperature).map(short));
                }
            }
        }
        let mut axes = vec![
            Axis {
                quantity: fmu::SPEED,
                points: speeds,
            },
            Axis {
                quantity: fmu::TORQUE,
                points: both,
            },
        ];
        if !is_same {
            axes.push(temperature_axis(stator, temperatures));
        }
        Table {
            axes,
            channels: 2,
            values,
        }
    }

    fn other_motor(&self, motor: usize, stator: usize) -> Result<Table, String> {
        let Ranges { torques, speeds, .. } = self.ranges;
        let mut scratch = self.t.batch_scratch(&self.case);
        let temperatures = Self::spaced(self.ranges.temperatures, SINGLE);
        let mut values = vec![0.0; speeds.len() * torques.len() * temperatures.len() * 2];
        for (k, temperature) in temperatures.iter().enumerate() {
            let loads: Vec<Load> = torques
                .iter()
                .flat_map(|torque| speeds[1..].iter().map(move |speed| (*torque, *speed)))
                .map(|(torque, speed)| Load {
                    torque,
                    speed,
                    temperatures: vec![*temperature; self.network.names().len()],
                })
                .collect();
            let heats = self.heats(&loads, &mut scratch);
            for w in 1..speeds.len() {
                for t in 0..torques.len() {
                    let found = nearest(&heats, torques, (t, w - 1), speeds.len() - 1);
                    let (heats, _) = found.ok_or("the losses of a motor have no value")?;
                    let at = ((w * torques.len() + t) * temperatures.len() + k) * 2;
                    values[at..at + 2].copy_from_slice(&heats.motors[motor].map(short));
                }
            }
        }
        let mut axes = self.load_axes();
        axes.push(temperature_axis(stator, temperatures));
        Ok(Table {
            axes,
            channels: 2,
            values,
        })
    }

    /// Conductances of the links, over what they depend on.
    fn links(&self) -> Result<Vec<fmu::Link>, String> {
        let links: Vec<(String, [usize; 2])> = self
            .network
            .links()
            .map(|(path, ends)| (path.to_owned(), ends))
            .collect();
        let of = |(i, (path, ends)): (usize, &(String, [usize; 2]))| {
            let conductance = self.conductance(i, *ends).map_err(|what| format!("{path}: {what}"))?;
            Ok(fmu::Link {
                between: ends.map(|node| node as u32),
                conductance,
            })
        };
        links.iter().enumerate().map(of).collect()
    }

    fn conductance(&self, link: usize, ends: [usize; 2]) -> Result<fmu::Conductance, String> {
        let temperatures = Self::spaced(self.ranges.temperatures, SINGLE);
        let axes = [
            temperature_axis(ends[0], temperatures.clone()),
            temperature_axis(ends[1], temperatures),
            Axis {
                quantity: fmu::SPEED,
                points: self.ranges.speeds.clone(),
            },
            Axis {
                quantity: fmu::VEHICLE,
                points: self.ranges.vehicle.clone(),
            },
            Axis {
                quantity: fmu::OIL_FLOW,
                points: self.ranges.flows.clone(),
            },
        ];
        let at = |x: [f64; 5]| {
            let state = LinkState {
                temperatures: [x[0], x[1]],
                speeds: &self.t.speeds(&self.case, &[x[2]]),
                vehicle_speed: x[3],
                oil_flow: x[4],
            };
            let found = self.network.conductance(link, &state);
            found.map_err(|undefined| format!("{} {} has no value", undefined.what, undefined.value))
        };
        // Some state inside of the ranges, without symmetry.
        let base: [f64; 5] = std::array::from_fn(|k| {
            let points = &axes[k].points;
            points[points.len() * (k + 3) / 9]
        });
        let before = at(base)?;
        let mut wanted = Vec::new();
        for (k, axis) in axes.iter().enumerate() {
            for x in &axis.points {
                let mut changed = base;
                changed[k] = *x;
                if (at(changed)? - before).abs() > 1e-9 * before.abs() {
                    wanted.push(k);
                    break;
                }
            }
        }
        if wanted.is_empty() {
            return Ok(fmu::Conductance::Given(before));
        }
        let sizes: Vec<usize> = wanted.iter().map(|k| axes[*k].points.len()).collect();
        let mut values = Vec::with_capacity(sizes.iter().product());
        for place in 0..sizes.iter().product::<usize>() {
            let (mut rest, mut x) = (place, base);
            for (k, size) in wanted.iter().zip(&sizes).rev() {
                x[*k] = axes[*k].points[rest % size];
                rest /= size;
            }
            values.push(short(at(x)?));
        }
        Ok(fmu::Conductance::Table(Table {
            axes: wanted.iter().map(|k| axes[*k].clone()).collect(),
            channels: 1,
            values,
        }))
    }
}

/// The heat at a torque and a speed, or at the next torque towards zero that has one; whether it is that of the torque itself.
fn nearest<'h>(
    heats: &'h [Option<NodeHeats>],
    torques: &[f64],
    (torque, column): (usize, usize),
    moving: usize,
) -> Option<(&'h NodeHeats, bool)> {
    let mut order: Vec<usize> = (0..torques.len()).collect();
    order.sort_by(|a, b| {
        (torques[*a] - torques[torque])
            .abs()
            .total_cmp(&(torques[*b] - torques[torque]).abs())
    });
    let smaller = order.into_iter().filter(|i| torques[*i].abs() <= torques[torque].abs());
    let mut found = smaller.filter_map(|i| Some((heats[i * moving + column].as_ref()?, i == torque)));
    found.next()
}

/// Inputs of a simulated cycle: for each interval the values of the variables that are inputs.
fn rows(
    content: &Content,
    network: &Network,
    read: &Read,
    driven: &Driven,
    (gears, own_gear): (&[&String], &String),
) -> Vec<Vec<f64>> {
    let slots: Vec<Slot> = Model::new(content.clone()).slots().to_vec();
    let numbers: Vec<_> = network.exchanger_numbers().collect();
    let ambient = driven.start[0];
    let row = |(stretch, interval): (&crate::points::Stretch, &crate::duty::Interval)| {
        let given = &interval.given;
        let own = |use_: Use| match use_ {
            Use::Speed => stretch.speed,
            Use::Torque => stretch.torque,
            Use::Ambient => given.ambient.unwrap_or(ambient),
            Use::VehicleSpeed => given.vehicle_speed.unwrap_or(0.0),
            // Cycles state the mass flow, at the temperature of the oil.
            Use::OilFlow => match given.oil_flow {
                Some(mass) => mass / network.oil_properties(stretch.temperatures[network.oil()])[0],
                None => network.pumped().unwrap_or(0.0),
            },
            Use::CoolantFlow(i) => given.coolant_flow.unwrap_or(numbers[i as usize].coolant_flow),
            Use::CoolantTemperature(i) => given
                .coolant_temperature
                .unwrap_or(numbers[i as usize].coolant_temperature),
            Use::Gear => {
                let gear = given.gear.as_ref().unwrap_or(own_gear);
                gears
                    .iter()
                    .position(|own| *own == gear)
                    .map_or(1.0, |i| (i + 1) as f64)
            }
            _ => 0.0,
        };
        let inputs = slots.iter().filter(|slot| slot.causality == Causality::Input);
        inputs.map(|slot| own(slot.use_)).collect()
    };
    driven.stretches.iter().zip(&read.intervals).map(row).collect()
}

/// Largest deviation of the oil and of any node from a simulated cycle. \[K\]
fn deviation_of(content: &Content, network: &Network, driven: &Driven, rows: &[Vec<f64>]) -> [f64; 2] {
    let mut model = Model::new(content.clone());
    let slots = model.slots().to_vec();
    let inputs: Vec<(u32, Slot)> = numbered(&slots, |slot| slot.causality == Causality::Input);
    let nodes: Vec<(u32, Slot)> = numbered(&slots, |slot| matches!(slot.use_, Use::Node(_)));
    for (reference, slot) in &nodes {
        if let Use::Node(node) = slot.use_ {
            // A node with a prescribed temperature has no start value.
            let _ = model.set(*reference, slot.kind, driven.start[node as usize]);
        }
    }
    let mut deviation = [0.0_f64; 2];
    for (stretch, row) in driven.stretches.iter().zip(rows) {
        for ((reference, slot), value) in inputs.iter().zip(row) {
            let _ = model.set(*reference, slot.kind, *value);
        }
        if model.advance(stretch.heats.duration).is_err() {
            return [f64::INFINITY; 2];
        }
        for (reference, slot) in &nodes {
            let (Use::Node(node), Ok(value)) = (slot.use_, model.get(*reference, slot.kind)) else {
                continue;
            };
            let own = (value - stretch.temperatures[node as usize]).abs();
            deviation[1] = deviation[1].max(own);
            if node as usize == network.oil() {
                deviation[0] = deviation[0].max(own);
            }
        }
    }
    deviation
}

/// Variables with their references.
fn numbered(slots: &[Slot], is_wanted: impl Fn(&Slot) -> bool) -> Vec<(u32, Slot)> {
    let all = (0..).zip(slots.iter().copied());
    all.filter(|(_, slot)| is_wanted(slot)).collect()
}

/// The inputs of a cycle at equal steps.
fn experiment(rows: &[Vec<f64>], driven: &Driven) -> Experiment {
    let durations = driven.stretches.iter().map(|stretch| stretch.heats.duration);
    let step = durations.clone().fold(f64::INFINITY, f64::min);
    let mut inputs: Vec<Vec<f64>> = Vec::new();
    for (row, duration) in rows.iter().zip(durations) {
        let count = (duration / step).round().max(1.0) as usize;
        let left = MOST_ROWS.saturating_sub(inputs.len());
        inputs.extend(std::iter::repeat_n(row.clone(), count.min(left)));
    }
    // The end of the last step.
    inputs.extend(inputs.last().cloned());
    Experiment { step, inputs }
}
