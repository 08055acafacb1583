//! Simulation of a cycle: losses, energy and temperatures over time.
//!
//! Each interval has constant speeds and torques. At the wheels of a vehicle the torque is given at the output, and the losses of the
//! transmission determine the input torque; while braking, regeneration at the input is limited, and the brakes supply the remainder.

use super::OilTemperature;
use crate::duty::{Demand, Interval, Vehicle, input_torque};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Point, PowerFlow, Scratch};
use gearloss_framework::flow::{Status, Tolerance};
use gearloss_framework::loss::Extent;
use gearloss_framework::thermal::Unbalanced;
use gearloss_framework::thermal::network::{Heats, March, Moment, Scheme, StepSize, Surroundings};
use gearloss_framework::transmission::{Case, Transmission, WHEELS};

/// Settings of a simulation.
#[derive(Clone, Copy)]
pub struct Ride<'a> {
    /// The cycle.
    pub intervals: &'a [Interval],
    /// Port of recorded torques and speeds.
    pub port: &'a str,
    /// The vehicle, if the cycle states its speed.
    pub vehicle: Option<&'a Vehicle>,
    /// Gear if the cycle states none.
    pub gear: &'a str,
    /// Origin of the temperatures.
    pub oil: OilTemperature,
    /// True for loads without order in time; each is solved at its own steady-state temperature.
    pub spectrum: bool,
    /// Temperature at the start; absent: ambient temperature. \[degC\]
    pub start: Option<f64>,
    /// Ambient temperature if the cycle states none; absent: from the gearbox. \[degC\]
    pub ambient: Option<f64>,
    /// Whether losses are evaluated at the end or at the start of a step.
    pub scheme: Scheme,
    /// Step size.
    pub step: StepSize,
    /// Real or ideal flow.
    pub flow: PowerFlow,
}

/// One simulated interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Time at its start. \[s\]
    pub start: f64,
    /// Torque of the reference port at its end. \[Nm\]
    pub torque: f64,
    /// Speed of the reference port. \[rad/s\]
    pub speed: f64,
    /// Speed of the vehicle. \[m/s\]
    pub vehicle_speed: Option<f64>,
    /// Energies.
    pub heats: Heats,
    /// Energy dissipated in the brakes of the vehicle. \[J\]
    pub brakes: f64,
    /// Temperatures at its end: of the nodes, or of the oil only. \[degC\]
    pub temperatures: Vec<f64>,
    /// State of the transmission.
    pub status: Status,
}

/// A simulated cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven {
    /// The simulated intervals.
    pub stretches: Vec<Stretch>,
    /// All energies.
    pub total: Heats,
    /// Energy dissipated in the brakes of the vehicle. \[J\]
    pub brakes: f64,
    /// Temperatures at the start. \[degC\]
    pub start: Vec<f64>,
    /// Observed limits and quantities.
    pub seen: Vec<Extent>,
    /// Energy that the components lose while a limit is exceeded, by cell of notes. \[J\]
    pub lost_outside: Vec<f64>,
    /// Evaluations of the losses.
    pub evaluations: usize,
    /// Calls of loss models.
    pub calls: usize,
    /// Time steps, and rejected time steps.
    pub steps: [usize; 2],
    /// Time at which the simulation stopped, and why.
    pub broken: Option<(f64, Unbalanced)>,
}

/// Port of the given torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum At {
    /// At the recorded port, with its speed.
    Port,
    /// At the wheels, with their speed.
    Wheels,
    /// At the reference port, with the speed of the wheels.
    Input,
}

/// Gears with their cases, prepared at first use.
struct Cases<'a> {
    transmission: &'a Transmission,
    ride: &'a Ride<'a>,
    wheels: Option<usize>,
    known: Vec<((String, At), Case, Scratch)>,
}

impl Cases<'_> {
    fn place(&mut self, gear: &str, at: At) -> Result<usize, Vec<Diagnostic>> {
        if let Some(place) = self.known.iter().position(|((g, a), ..)| g == gear && *a == at) {
            return Ok(place);
        }
        let t = self.transmission;
        let name = |port: Option<usize>| port.map_or("", |port| t.ports()[port].name.as_str());
        let (speed, torque) = match at {
            At::Port => (self.ride.port, self.ride.port),
            At::Wheels => (name(self.wheels), name(self.wheels)),
            At::Input => (name(self.wheels), name(Some(t.reference_port()))),
        };
        let state = t.state(gear).map_err(|e| vec![e])?;
        t.takes_one(state).map_err(|e| vec![e])?;
        let torques: &[&str] = if t.torques_needed(state) == 0 { &[] } else { &[torque] };
        let case = t.case(gear, &[speed], torques)?;
        let scratch = t.scratch(&case);
        self.known.push(((gear.to_owned(), at), case, scratch));
        Ok(self.known.len() - 1)
    }

    /// Ratio of the speed of the reference port to that of the wheels.
    fn ratio(&mut self, gear: &str) -> Result<f64, Vec<Diagnostic>> {
        let place = self.place(gear, At::Wheels)?;
        let t = self.transmission;
        let speeds = t.speeds(&self.known[place].1, &[1.0]);
        Ok(speeds[t.ports()[t.reference_port()].member])
    }
}

/// Demand of an interval.
struct Asked {
    place: usize,
    torque: f64,
    speed: f64,
    /// Braking power of brakes and transmission. \[W\]
    braking: f64,
    /// Power of the brakes, if known beforehand. \[W\]
    brakes: Option<f64>,
}

impl<'a> Cases<'a> {
    fn new(transmission: &'a Transmission, ride: &'a Ride<'a>) -> Result<Self, Vec<Diagnostic>> {
        let on_wheels = ride.intervals.iter().any(|i| matches!(i.demand, Demand::Wheel { .. }));
        let wheels = on_wheels.then(|| wheels(transmission)).transpose();
        Ok(Self {
            transmission,
            ride,
            wheels: wheels.map_err(|e| vec![e])?,
            known: Vec::new(),
        })
    }
}

/// Checks gears and ports of every interval of a cycle without solving.
///
/// # Errors
/// If a gear or a port is unknown or invalid.
pub fn can_drive(transmission: &Transmission, ride: &Ride<'_>) -> Result<(), Vec<Diagnostic>> {
    let mut cases = Cases::new(transmission, ride)?;
    for interval in ride.intervals {
        let gear = interval.given.gear.as_deref().unwrap_or(ride.gear);
        match (interval.demand, ride.vehicle) {
            (Demand::Wheel { .. }, Some(_)) => {
                cases.place(gear, At::Wheels)?;
                cases.place(gear, At::Input)?;
            }
            _ => {
                cases.place(gear, At::Port)?;
            }
        }
    }
    Ok(())
}

/// Simulates a cycle. `progress` is called for each interval; if it returns false, the simulation stops without a result.
///
/// # Errors
/// If a gear or a port is unknown or invalid.
pub fn drive(
    transmission: &Transmission,
    ride: &Ride<'_>,
    progress: &dyn Fn(usize) -> bool,
) -> Result<Option<Driven>, Vec<Diagnostic>> {
    let reference = transmission.reference_port();
    let mut cases = Cases::new(transmission, ride)?;
    let wheels = cases.wheels;
    let first = around(ride, ride.intervals.first());
    let network = transmission.network().filter(|_| ride.oil == OilTemperature::Network);
    let start = network.map_or_else(
        || ride.oil.given().into_iter().collect(),
        |network| network.start(ride.start, &first),
    );
    let mut march = network
        .filter(|_| !ride.spectrum)
        .map(|network| March::new(transmission, network, start.clone(), ride.scheme, ride.step));
    let mut driven = Driven {
        stretches: Vec::with_capacity(ride.intervals.len()),
        total: Heats::default(),
        brakes: 0.0,
        start,
        seen: Vec::new(),
        lost_outside: vec![0.0; transmission.rated_cells() + transmission.rated().len()],
        evaluations: 0,
        calls: 0,
        steps: [0; 2],
        broken: None,
    };
    for interval in ride.intervals {
        let around = around(ride, Some(interval));
        let warm = march.as_ref().map(|m| m.temperatures.clone());
        let asked = ask(&mut cases, interval, &around, warm.as_deref(), &mut driven)?;
        let (_, case, scratch) = &mut cases.known[asked.place];
        let (torques, speeds) = ([asked.torque], [asked.speed]);
        let point = Point {
            speeds: &speeds,
            torques: &torques[..case.torque_ports.len()],
            flow: ride.flow,
            tolerance: Tolerance::default(),
        };
        let moment = Moment {
            case,
            point: &point,
            around: &around,
        };
        let went = match &mut march {
            Some(march) => {
                let before = march.evaluations;
                let heats = march.advance(&moment, interval.duration, scratch);
                driven.evaluations += march.evaluations - before;
                driven.steps = march.steps;
                heats.map(|heats| (heats, march.temperatures.clone()))
            }
            None => rest(transmission, ride, interval, &moment, scratch, &mut driven),
        };
        let (heats, temperatures) = match went {
            Ok(went) => went,
            Err(reason) => {
                driven.broken = Some((interval.start, reason));
                break;
            }
        };
        let member = |port: usize| transmission.ports()[port].member;
        let brakes = match (asked.brakes, wheels) {
            (Some(watts), _) => watts * interval.duration,
            (None, Some(wheels)) if asked.braking > 0.0 => {
                let taken = scratch.port_torque(member(wheels)) * scratch.speeds()[member(wheels)];
                (asked.braking - taken).max(0.0) * interval.duration
            }
            _ => 0.0,
        };
        driven.total.add(&heats);
        driven.brakes += brakes;
        driven.stretches.push(Stretch {
            start: interval.start,
            torque: scratch.port_torque(member(reference)),
            speed: scratch.speeds()[member(reference)],
            vehicle_speed: interval.given.vehicle_speed,
            heats,
            brakes,
            temperatures,
            status: scratch.status(),
        });
        if !progress(1) {
            return Ok(None);
        }
    }
    if let (true, Some(first)) = (march.is_none(), driven.stretches.first()) {
        // Steady-state: there is no initial state.
        driven.start.clone_from(&first.temperatures);
    }
    if let Some(march) = march {
        driven.lost_outside = march.lost_outside;
    }
    for (.., scratch) in &cases.known {
        driven.calls += scratch.all_calls();
        super::merge(&mut driven.seen, &scratch.totals);
    }
    Ok(Some(driven))
}

/// The port of the wheels: `wheels`, `output`, or the only port other than the reference port.
///
/// # Errors
/// If there is none.
fn wheels(t: &Transmission) -> Result<usize, Diagnostic> {
    let named = |name: &str| t.ports().iter().position(|p| p.name == name);
    let other = (t.ports().len() == 2).then(|| 1 - t.reference_port());
    let own = named(WHEELS).or_else(|| named("output")).or(other);
    own.ok_or_else(|| {
        let reference = &t.ports()[t.reference_port()].name;
        let names: Vec<&str> = t.ports().iter().map(|p| p.name.as_str()).collect();
        let others: Vec<&str> = names.iter().copied().filter(|name| name != reference).collect();
        Diagnostic::error("ports", "a vehicle needs the port of its wheels")
            .note(format!("there are: {}", names.join(", ")))
            .help(format!(
                "write `conditions: {{ wheels: [{}] }}` in the study if both wheels are ports, or rename the port to `output`",
                others.join(", ")
            ))
    })
}

fn around(ride: &Ride<'_>, interval: Option<&Interval>) -> Surroundings {
    let given = interval.map(|i| &i.given);
    Surroundings {
        ambient: given.and_then(|g| g.ambient).or(ride.ambient),
        vehicle_speed: given.and_then(|g| g.vehicle_speed).unwrap_or(0.0),
        oil_flow: given.and_then(|g| g.oil_flow),
        coolant_flow: given.and_then(|g| g.coolant_flow),
        coolant_temperature: given.and_then(|g| g.coolant_temperature),
    }
}

/// Torque and speed of an interval, and their ports.
fn ask(
    cases: &mut Cases<'_>,
    interval: &Interval,
    around: &Surroundings,
    warm: Option<&[f64]>,
    driven: &mut Driven,
) -> Result<Asked, Vec<Diagnostic>> {
    let gear = interval.given.gear.as_deref().unwrap_or(cases.ride.gear);
    let ride = cases.ride;
    let (torque, speed) = match interval.demand {
        Demand::Rest => (0.0, 0.0),
        Demand::Port { torque, speed } => (torque, speed),
        Demand::Wheel { torque, speed } => {
            let Some(vehicle) = ride.vehicle else {
                return Ok(Asked {
                    place: cases.place(gear, At::Port)?,
                    torque: 0.0,
                    speed: 0.0,
                    braking: 0.0,
                    brakes: None,
                });
            };
            let ratio = cases.ratio(gear)?;
            // The input turns forward.
            let wheel_speed = speed * ratio.signum();
            let input_speed = speed * ratio.abs();
            let braking = (-torque * speed).max(0.0);
            let at_input = |cases: &mut Cases<'_>, torque: f64| -> Result<Asked, Vec<Diagnostic>> {
                Ok(Asked {
                    place: cases.place(gear, At::Input)?,
                    torque,
                    speed: wheel_speed,
                    braking,
                    brakes: None,
                })
            };
            let regained = |torque: f64| vehicle.regained(torque, input_speed, around.vehicle_speed);
            if let Some(efficiency) = vehicle.efficiency {
                let wanted = input_torque(torque, ratio.abs(), efficiency);
                let taken = regained(wanted);
                // The brakes supply what regeneration does not, with the efficiency at the wheels.
                let brakes = Some((taken - wanted).max(0.0) * input_speed / efficiency);
                return Ok(Asked {
                    brakes,
                    ..at_input(cases, taken)?
                });
            }
            let place = cases.place(gear, At::Wheels)?;
            let at_wheels = Asked {
                place,
                torque: -torque * ratio.signum(),
                speed: wheel_speed,
                braking,
                brakes: None,
            };
            let ideal = torque / ratio.abs();
            // Losses reduce the regenerated power, so a demand within the limit without losses is within it with losses.
            if regained(ideal) <= ideal {
                return Ok(at_wheels);
            }
            let (_, case, scratch) = &mut cases.known[place];
            let point = Point {
                speeds: &[at_wheels.speed],
                torques: &[at_wheels.torque][..case.torque_ports.len()],
                flow: ride.flow,
                tolerance: Tolerance::default(),
            };
            let given = interval.given.oil_temperature.or(ride.oil.given());
            let oil = [given.unwrap_or(cases.transmission.oil_temperature)];
            driven.evaluations += 1;
            let t = cases.transmission;
            let tried = t.try_point(
                case,
                &point,
                warm.unwrap_or(&oil),
                scratch,
                gearloss_framework::evaluate::Noting::Muted,
            );
            let own = scratch.port_torque(t.ports()[t.reference_port()].member);
            // If losses have no value, the solved point reports it.
            return if tried.is_err() || regained(own) <= own {
                Ok(at_wheels)
            } else {
                at_input(cases, regained(own))
            };
        }
    };
    Ok(Asked {
        place: cases.place(gear, At::Port)?,
        torque,
        speed,
        braking: 0.0,
        brakes: None,
    })
}

/// A steady-state interval: at a given temperature, or at the equilibrium with its own losses.
fn rest(
    t: &Transmission,
    ride: &Ride<'_>,
    interval: &Interval,
    moment: &Moment<'_>,
    scratch: &mut Scratch,
    driven: &mut Driven,
) -> Result<(Heats, Vec<f64>), Unbalanced> {
    let duration = interval.duration;
    let wanted = interval.given.oil_temperature.map_or(ride.oil, OilTemperature::Fixed);
    let warm = match wanted {
        OilTemperature::Network => {
            let steady = t.steady(moment, scratch).ok_or(Unbalanced::Flow)?;
            super::Found {
                oil: steady.temperatures[t
                    .network()
                    .map_or(0, gearloss_framework::thermal::network::Network::oil)],
                balance: None,
                network: Some(steady),
            }
        }
        other => other.find(t, moment.case, moment.point, scratch),
    };
    if !warm.is_sound() {
        let balance = warm.balance.as_ref().and_then(|b| b.undefined);
        let network = warm.network.as_ref().and_then(|n| n.undefined);
        return Err(balance.map(|(_, why)| why).or(network).unwrap_or(Unbalanced::Flow));
    }
    driven.evaluations += warm.evaluations() + 1;
    t.try_point(
        moment.case,
        moment.point,
        warm.temperatures(),
        scratch,
        gearloss_framework::evaluate::Noting::Counted,
    )?;
    for (cell, watts) in scratch.lost_outside() {
        driven.lost_outside[cell] += watts * duration;
    }
    let each = |list: &[f64]| list.iter().map(|x| x * duration).collect();
    let [input, output] = scratch.power();
    let mut heats = Heats {
        duration,
        parts: each(scratch.watts()),
        input: input * duration,
        output: output * duration,
        ..Heats::default()
    };
    if let Some(steady) = &warm.network {
        heats.motors = steady.motors.iter().map(|m| m.map(|x| x * duration)).collect();
        heats.sources = t
            .network()
            .map_or(0.0, |n| n.sources().iter().map(|(_, watts)| watts * duration).sum());
        heats.held = each(&steady.leaving.held);
        heats.exchangers = each(&steady.leaving.exchangers);
        heats.flows = steady.leaving.flows * duration;
    }
    let temperatures = warm.temperatures().to_vec();
    Ok((heats, temperatures))
}
