//! Simulation of a cycle: losses, energy and temperatures over time.
//!
//! Each interval has constant speeds and torques. At the wheels of a vehicle the torque is given at the output, and the losses of the
//! transmission determine the input torque; while braking, regeneration at the input is limited, and the brakes supply the remainder.

mod gears;

use self::gears::{Chooser, Chosen, Solved, drive_optimum};
use super::OilTemperature;
use crate::codes;
use crate::duty::{Demand, Interval, Vehicle, input_torque};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{BatchScratch, Noting, Point, PowerFlow};
use gearloss_framework::flow::{Status, Tolerance};
use gearloss_framework::loss::Extent;
use gearloss_framework::machine::{BeyondEntry, MachineEnergy};
use gearloss_framework::sump::STEEPEST;
use gearloss_framework::thermal::Unbalanced;
use gearloss_framework::thermal::network::{Heats, March, Moment, Passed, Scheme, Stage, StepSize, Surroundings};
use gearloss_framework::transmission::{Case, Transmission, WHEELS};
use serde::{Deserialize, Serialize};

pub use self::gears::{Choosing, ChosenBy, GearChoice, Optimum, Shift, has_machine, offers_of, tow_torques};

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
    /// How the gears of intervals without one are chosen; absent: the stated gear.
    pub choice: Option<Choosing<'a>>,
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Energy from the transmission into the wheels; absent without wheels. \[J\]
    pub wheels: Option<f64>,
    /// Temperatures at its end: of the nodes, or of the oil only. \[degC\]
    pub temperatures: Vec<f64>,
    /// State of the transmission.
    pub status: Status,
    /// Inclination of the oil by grade and acceleration. \[rad\]
    pub inclination: f64,
    /// Number of the gear state.
    pub gear: usize,
    /// The shift at its start, if gears are chosen.
    pub shift: Option<Shift>,
    /// True if every gear is beyond a limit of the choice.
    pub beyond_limits: bool,
    /// Energy that the vehicle lacks at its wheels because a machine is at its envelope. \[J\]
    pub lacking: f64,
    /// Torque \[Nm\] and speed \[rad/s\] of each active machine at its end.
    pub machines: Vec<[f64; 2]>,
}

/// A simulated cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// True if gears are chosen.
    pub is_chosen: bool,
    /// Least energy against the rule, if the gears have the least energy.
    pub optimum: Option<Optimum>,
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
    known: Vec<((String, At), Case)>,
    /// A workspace for each case.
    scratches: Vec<BatchScratch>,
}

impl Cases<'_> {
    fn place(&mut self, gear: &str, at: At) -> Result<usize, Vec<Diagnostic>> {
        if let Some(place) = self.known.iter().position(|((g, a), _)| g == gear && *a == at) {
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
        self.scratches.push(t.batch_scratch(&case));
        self.known.push(((gear.to_owned(), at), case));
        Ok(self.known.len() - 1)
    }

    /// Ratio of the speed of the reference port to that of the wheels, and the rotating mass factor of a vehicle.
    fn ratio(&mut self, gear: &str, vehicle: &Vehicle) -> Result<[f64; 2], Vec<Diagnostic>> {
        let place = self.place(gear, At::Wheels)?;
        let t = self.transmission;
        let speeds = t.speeds(&self.known[place].1, &[1.0]);
        let ratio = speeds[t.ports()[t.reference_port()].member];
        let shaft = |name: &str| {
            let member = t.members().iter().position(|member| member == name);
            member.map_or(0.0, |member| speeds[member])
        };
        Ok([ratio, vehicle.mass_factor(ratio, shaft)])
    }
}

/// Demand of an interval.
#[derive(Clone, Copy)]
struct Asked {
    place: usize,
    torque: f64,
    speed: f64,
    /// Braking power of brakes and transmission. \[W\]
    braking: f64,
    /// Power of the brakes, if known beforehand. \[W\]
    brakes: Option<f64>,
    /// Demanded power at the wheels, if a machine limits it. \[W\]
    wanted: Option<f64>,
    /// Torque (Nm) and speed (rad/s) of the input without losses, if regeneration is limited unless losses reduce the torque.
    limited: Option<[f64; 2]>,
}

/// A demand within its limits.
struct Settled {
    asked: Asked,
    /// True if it is the same at the temperatures of a later time.
    is_clear: bool,
}

/// An interval with its demand.
struct Planned<'a> {
    interval: &'a Interval,
    asked: Asked,
    around: Surroundings,
    chosen: Chosen,
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
            scratches: Vec::new(),
        })
    }
}

/// Checks gears and ports of every interval of a cycle without solving.
///
/// # Errors
/// If a gear or a port is unknown or invalid.
pub fn can_drive(transmission: &Transmission, ride: &Ride<'_>) -> Result<(), Vec<Diagnostic>> {
    let mut cases = Cases::new(transmission, ride)?;
    if transmission.travels()
        && let Some(steep) = ride
            .intervals
            .iter()
            .find(|interval| interval.inclination.abs() > STEEPEST)
    {
        let message = format!(
            "grade and acceleration of the cycle incline the oil by {:.1} deg at {} s, more than {:.0} deg",
            steep.inclination.to_degrees(),
            steep.start,
            STEEPEST.to_degrees()
        );
        let help = "correct the speeds and grades of the cycle, or delete `travel`: cycles then do not incline the oil";
        return Err(vec![
            Diagnostic::error("housing.travel", message)
                .code(gearloss_framework::codes::TRAVEL)
                .help(help),
        ]);
    }
    Chooser::new(&mut cases)?;
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
    match ride.choice.map(|choosing| &choosing.choice.by) {
        Some(ChosenBy::Optimum(_)) => drive_optimum(transmission, ride, progress),
        _ => drive_through(transmission, ride, None, progress),
    }
}

/// Simulates a cycle once; `given` are the numbers of chosen gears, if they are known.
fn drive_through(
    transmission: &Transmission,
    ride: &Ride<'_>,
    given: Option<Vec<usize>>,
    progress: &dyn Fn(usize) -> bool,
) -> Result<Option<Driven>, Vec<Diagnostic>> {
    let reference = transmission.reference_port();
    let mut cases = Cases::new(transmission, ride)?;
    let mut chooser = Chooser::new(&mut cases)?.map(|chooser| chooser.with_given(given));
    let wheels = cases.wheels;
    let member = |port: usize| transmission.ports()[port].member;
    let first = around(ride, ride.intervals.first());
    let network = transmission.network().filter(|_| ride.oil == OilTemperature::Network);
    let start = network.map_or_else(
        || ride.oil.given().into_iter().collect(),
        |network| network.start(ride.start, &first),
    );
    let machines = transmission.active_machines(start.len() > 1);
    let machines: Vec<usize> = machines.map(|machine| machine.member).collect();
    let mut march = network
        .filter(|_| !ride.spectrum)
        .map(|network| March::new(transmission, network, start.clone(), ride.scheme, ride.step));
    let mut driven = Driven {
        stretches: Vec::with_capacity(ride.intervals.len()),
        total: Heats::default(),
        brakes: 0.0,
        start,
        seen: vec![Extent::EMPTY; transmission.cells()],
        lost_outside: vec![0.0; transmission.cells()],
        evaluations: 0,
        calls: 0,
        steps: [0; 2],
        broken: None,
        is_chosen: chooser.is_some(),
        optimum: None,
    };
    let mut rest = ride.intervals;
    while let Some(first) = rest.first() {
        let together = march
            .as_ref()
            .map_or(1, |march| march.reach(rest.iter().map(|interval| interval.duration)));
        let warm = march.as_ref().map(|march| march.temperatures.as_slice());
        let chosen = match &mut chooser {
            Some(chooser) => chooser.choose(&mut cases, (rest, together), warm, &mut driven)?,
            None => stated(&cases, &rest[..together])?,
        };
        let planned = plan(
            &mut cases,
            (&rest[..together], &chosen),
            (warm, chooser.as_ref()),
            &mut driven,
        )?;
        let passed = if let Some(march) = &mut march {
            advance(march, &mut cases, &planned)
        } else {
            let solved = chooser
                .as_mut()
                .and_then(|chooser| chooser.take_solved(chosen[0].state));
            steady(&mut cases, &planned[0], solved, &mut driven).map(|passed| vec![passed])
        };
        let passed = match passed {
            Ok(passed) => passed,
            Err(reason) => {
                driven.broken = Some((first.start, reason));
                break;
            }
        };
        rest = &rest[passed.len()..];
        for (passed, planned) in passed.into_iter().zip(&planned) {
            let shift = chooser
                .as_mut()
                .and_then(|chooser| chooser.pass(ride, planned.interval, &planned.chosen));
            driven.take(
                passed,
                planned,
                shift,
                (member(reference), wheels.map(member), &machines),
            );
            if !progress(1) {
                return Ok(None);
            }
        }
    }
    if chooser.is_some() {
        driven.start_in_first_gear(ride);
    }
    if let (true, Some(first)) = (march.is_none(), driven.stretches.first()) {
        // Steady-state: there is no initial state.
        driven.start.clone_from(&first.temperatures);
    }
    for scratch in &mut cases.scratches {
        driven.calls += scratch.calls();
        super::merge(&mut driven.seen, &scratch.take_totals());
    }
    kept_envelopes(transmission, &driven)?;
    if let Some(march) = march {
        driven.lost_outside = march.lost_outside().to_vec();
        driven.evaluations += march.evaluations();
        driven.steps = march.steps();
        super::merge(&mut driven.seen, march.seen());
    }
    Ok(Some(driven))
}

/// The demands of the next intervals. They end before an interval whose demand may depend on the temperatures at its start, unless it is
/// the first.
fn plan<'i>(
    cases: &mut Cases<'_>,
    (intervals, chosen): (&'i [Interval], &[Chosen]),
    (warm, chooser): (Option<&[f64]>, Option<&Chooser<'_>>),
    driven: &mut Driven,
) -> Result<Vec<Planned<'i>>, Vec<Diagnostic>> {
    let mut planned = Vec::with_capacity(intervals.len());
    for (i, (interval, chosen)) in intervals.iter().zip(chosen).enumerate() {
        if !chosen.is_clear && !planned.is_empty() {
            break;
        }
        let around = around(cases.ride, Some(interval));
        let settled = match chooser.and_then(|chooser| chooser.solved(i, chosen.state)) {
            Some(solved) => Settled {
                asked: solved.asked,
                is_clear: solved.is_clear,
            },
            None => settle(cases, (interval, &around), chosen.state, (warm, driven))?,
        };
        if !settled.is_clear && !planned.is_empty() {
            break;
        }
        planned.push(Planned {
            interval,
            asked: settled.asked,
            around,
            chosen: *chosen,
        });
    }
    Ok(planned)
}

/// The demand of an interval in a gear state, limited at these temperatures.
fn settle(
    cases: &mut Cases<'_>,
    (interval, around): (&Interval, &Surroundings),
    state: usize,
    (warm, driven): (Option<&[f64]>, &mut Driven),
) -> Result<Settled, Vec<Diagnostic>> {
    let gear = &cases.transmission.states()[state].name;
    let asked = ask(cases, interval, around, gear)?;
    match asked.limited {
        Some(lossless) => limit(cases, asked, (interval, around, lossless), gear, (warm, driven)),
        None => Ok(Settled { asked, is_clear: true }),
    }
}

/// The stated gears of intervals.
fn stated(cases: &Cases<'_>, intervals: &[Interval]) -> Result<Vec<Chosen>, Vec<Diagnostic>> {
    let of = |interval: &Interval| {
        let gear = interval.given.gear.as_deref().unwrap_or(cases.ride.gear);
        Ok(Chosen {
            state: cases.transmission.state(gear).map_err(|e| vec![e])?,
            forced: false,
            beyond: false,
            is_clear: true,
        })
    };
    intervals.iter().map(of).collect()
}

/// Simulates the first of some intervals, and those of the others that are simulated together with it.
fn advance(march: &mut March<'_>, cases: &mut Cases<'_>, planned: &[Planned<'_>]) -> Result<Vec<Passed>, Unbalanced> {
    let points: Vec<Point<'_>> = planned
        .iter()
        .map(|planned| {
            point_of(
                &cases.known[planned.asked.place].1,
                cases.ride,
                &planned.asked,
                planned.interval.inclination,
            )
        })
        .collect();
    let stages = planned.iter().zip(&points).map(|(planned, point)| Stage {
        moment: Moment {
            case: &cases.known[planned.asked.place].1,
            point,
            around: &planned.around,
        },
        duration: planned.interval.duration,
        scratch: planned.asked.place,
    });
    march.advance_together(&stages.collect::<Vec<_>>(), &mut cases.scratches)
}

impl Driven {
    /// Takes over a simulated interval with the shift at its start. Members: those of the reference port, of the wheels and of the machines.
    fn take(
        &mut self,
        passed: Passed,
        planned: &Planned<'_>,
        shift: Option<Shift>,
        (reference, wheels, machines): (usize, Option<usize>, &[usize]),
    ) {
        let Planned { interval, asked, .. } = planned;
        let taken = |member: usize| passed.port_torques[member] * passed.speeds[member];
        let brakes = match asked.brakes {
            Some(watts) => watts * interval.duration,
            None if asked.braking > 0.0 => {
                (asked.braking - taken(wheels.unwrap_or(reference))).max(0.0) * interval.duration
            }
            None => 0.0,
        };
        let wheels = wheels.map(|member| -taken(member) * interval.duration);
        let lacking = asked.wanted.zip(wheels);
        let lacking = lacking.map_or(0.0, |(wanted, wheels)| (wanted * interval.duration - wheels).max(0.0));
        self.total.add(&passed.heats);
        self.brakes += brakes;
        self.stretches.push(Stretch {
            start: interval.start,
            torque: passed.port_torques[reference],
            speed: passed.speeds[reference],
            machines: machines
                .iter()
                .map(|member| [passed.port_torques[*member], passed.speeds[*member]])
                .collect(),
            vehicle_speed: interval.given.vehicle_speed,
            heats: passed.heats,
            brakes,
            wheels,
            temperatures: passed.temperatures,
            status: passed.status,
            inclination: planned.interval.inclination,
            gear: planned.chosen.state,
            shift,
            beyond_limits: planned.chosen.beyond,
            lacking,
        });
    }

    /// The vehicle waits in the gear in which it starts.
    fn start_in_first_gear(&mut self, ride: &Ride<'_>) {
        let waits = |interval: &Interval| interval.demand == Demand::Rest && interval.given.gear.is_none();
        let waiting = ride.intervals.iter().take_while(|interval| waits(interval)).count();
        let Some(gear) = self.stretches.get(waiting).map(|first| first.gear) else {
            return;
        };
        for stretch in &mut self.stretches[..waiting] {
            stretch.gear = gear;
        }
    }
}

/// The port of the wheels: `wheels`, `output`, or the only port other than the reference port.
///
/// # Errors
/// If there is none.
fn wheels(t: &Transmission) -> Result<usize, Diagnostic> {
    let named = |name: &str| t.ports().iter().position(|p| p.name == name);
    let other = (t.ports().len() == 2).then(|| 1 - t.reference_port());
    let port = named(WHEELS).or_else(|| named("output")).or(other);
    port.ok_or_else(|| {
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

/// Torque and speed of an interval in a gear, and their ports; the torque may still be limited.
fn ask(
    cases: &mut Cases<'_>,
    interval: &Interval,
    around: &Surroundings,
    gear: &str,
) -> Result<Asked, Vec<Diagnostic>> {
    let ride = cases.ride;
    let (torque, speed) = match interval.demand {
        Demand::Rest => (0.0, 0.0),
        Demand::Port { torque, speed } => (torque, speed),
        Demand::Wheel {
            torque,
            speed,
            acceleration,
        } => {
            let Some(vehicle) = ride.vehicle else {
                return Ok(Asked {
                    place: cases.place(gear, At::Port)?,
                    torque: 0.0,
                    speed: 0.0,
                    braking: 0.0,
                    brakes: None,
                    wanted: None,
                    limited: None,
                });
            };
            let [ratio, mass_factor] = cases.ratio(gear, vehicle)?;
            let torque = match vehicle.inertia {
                Some(_) => torque + vehicle.inertia_torque(mass_factor, acceleration),
                None => torque,
            };
            // The input turns forward.
            let wheel_speed = speed * ratio.signum();
            let input_speed = speed * ratio.abs();
            let at_wheels = Asked {
                place: 0,
                torque: -torque * ratio.signum(),
                speed: wheel_speed,
                braking: (-torque * speed).max(0.0),
                brakes: None,
                wanted: None,
                limited: None,
            };
            let t = cases.transmission;
            let regained = |torque: f64| supplied(t, vehicle, torque, [input_speed, around.vehicle_speed]);
            if let Some(efficiency) = vehicle.efficiency {
                let wanted = input_torque(torque, ratio.abs(), efficiency);
                let taken = regained(wanted);
                return Ok(Asked {
                    place: cases.place(gear, At::Input)?,
                    torque: taken,
                    // The brakes supply what regeneration does not, with the efficiency at the wheels.
                    brakes: Some((taken - wanted).max(0.0) * input_speed / efficiency),
                    ..at_wheels
                });
            }
            let ideal = torque / ratio.abs();
            // Losses reduce the regenerated power, so a demand within the limit without losses is within it with losses.
            // While driving they increase the torque, which is tried well below an envelope.
            let exceeds = regained(ideal) != ideal || ideal > 0.5 * most_torque(t, input_speed);
            return Ok(Asked {
                place: cases.place(gear, At::Wheels)?,
                limited: exceeds.then_some([ideal, input_speed]),
                ..at_wheels
            });
        }
    };
    Ok(Asked {
        place: cases.place(gear, At::Port)?,
        torque,
        speed,
        braking: 0.0,
        brakes: None,
        wanted: None,
        limited: None,
    })
}

/// The demand of an interval whose torque at the wheels exceeds the limit of regeneration without losses, at these temperatures.
fn limit(
    cases: &mut Cases<'_>,
    asked: Asked,
    (interval, around, lossless): (&Interval, &Surroundings, [f64; 2]),
    gear: &str,
    (warm, driven): (Option<&[f64]>, &mut Driven),
) -> Result<Settled, Vec<Diagnostic>> {
    let (t, ride) = (cases.transmission, cases.ride);
    let given = interval.given.oil_temperature.or(ride.oil.given());
    let oil = [given.unwrap_or(t.oil_temperature)];
    driven.evaluations += 1;
    let scratch = cases.scratches[asked.place].alone();
    let case = &cases.known[asked.place].1;
    let point = point_of(case, ride, &asked, interval.inclination);
    let tried = t.try_point(case, &point, warm.unwrap_or(&oil), scratch, Noting::Muted);
    if tried.is_err() {
        // The solved point reports that losses have no value.
        return Ok(Settled { asked, is_clear: false });
    }
    let torque = scratch.port_torque(t.ports()[t.reference_port()].member);
    limited(cases, asked, (torque, lossless, around.vehicle_speed), gear)
}

/// A demand with the torque of the reference port that it needs with losses: it is within the limit, or it is limited. It is clear if it
/// is the same with half and with one and a half times these losses, and hence at the temperatures of a later time.
fn limited(
    cases: &mut Cases<'_>,
    asked: Asked,
    (needed, [ideal, input_speed], vehicle_speed): (f64, [f64; 2], f64),
    gear: &str,
) -> Result<Settled, Vec<Diagnostic>> {
    let Some(vehicle) = cases.ride.vehicle else {
        return Ok(Settled { asked, is_clear: false });
    };
    let regained = |torque: f64| supplied(cases.transmission, vehicle, torque, [input_speed, vehicle_speed]);
    let exceeds = |torque: f64| regained(torque) != torque;
    let slack = 0.5 * (needed - ideal).abs();
    let is_clear = exceeds(needed - slack) == exceeds(needed + slack);
    let torque = regained(needed);
    let asked = if exceeds(needed) {
        Asked {
            place: cases.place(gear, At::Input)?,
            torque,
            wanted: (needed > 0.0).then_some(-asked.torque * asked.speed),
            ..asked
        }
    } else {
        asked
    };
    Ok(Settled { asked, is_clear })
}

/// Largest torque of a machine at the reference port, whose envelope limits it, at a speed \[rad/s\]; infinite without one. \[Nm\]
fn most_torque(t: &Transmission, speed: f64) -> f64 {
    let machine = t.machines().iter().find(|machine| machine.port == t.reference_port());
    let envelope = machine.and_then(|machine| machine.envelope());
    let envelope = envelope.filter(|envelope| envelope.beyond == BeyondEntry::Limit);
    envelope.map_or(f64::INFINITY, |envelope| envelope.most(speed))
}

/// A torque at the port \[Nm\] limited to regeneration and to the envelope of the machine, at the speeds of the port \[rad/s\] and of the
/// vehicle \[m/s\]. \[Nm\]
fn supplied(t: &Transmission, vehicle: &Vehicle, torque: f64, [port_speed, vehicle_speed]: [f64; 2]) -> f64 {
    let most = most_torque(t, port_speed);
    vehicle.regained(torque, port_speed, vehicle_speed).clamp(-most, most)
}

/// Refuses a cycle in which a machine whose envelope must be kept exceeds it.
fn kept_envelopes(t: &Transmission, driven: &Driven) -> Result<(), Vec<Diagnostic>> {
    let machines = t.active_machines(driven.start.len() > 1).enumerate();
    for (i, machine) in machines {
        let Some(envelope) = machine.envelope().filter(|e| e.beyond == BeyondEntry::Refuse) else {
            continue;
        };
        let exceeds = |s: &&Stretch| s.heats.machines.get(i).is_some_and(|energy| energy.beyond > 0.0);
        let mut beyond = driven.stretches.iter().filter(exceeds);
        let Some(first) = beyond.next() else { continue };
        let at = first.machines.get(i).map_or_else(String::new, |[torque, speed]| {
            format!(
                ": {torque:.1} Nm at {:.0} rpm, where it reaches {:.1} Nm",
                speed * 30.0 / std::f64::consts::PI,
                envelope.most(*speed)
            )
        });
        let message = format!(
            "the cycle asks for more torque than the machine has in {} intervals, first at {} s{at}",
            beyond.count() + 1,
            first.start
        );
        let error = Diagnostic::error(format!("{}.envelope", machine.path), message)
            .help("write `beyond: limit` to limit the torque and count the shortfall, or choose a larger machine")
            .code(codes::BEYOND_ENVELOPE);
        return Err(vec![error]);
    }
    Ok(())
}

/// The operating point of a demand at the inclination of its interval.
fn point_of<'a>(case: &Case, ride: &Ride<'_>, asked: &'a Asked, inclination: f64) -> Point<'a> {
    Point {
        speeds: std::slice::from_ref(&asked.speed),
        torques: &std::slice::from_ref(&asked.torque)[..case.torque_ports.len()],
        flow: ride.flow,
        tolerance: Tolerance::default(),
        inclination,
    }
}

/// The temperatures of a steady-state interval: given, or those of the equilibrium with its own losses.
fn steady_temperatures(
    cases: &mut Cases<'_>,
    interval: &Interval,
    asked: &Asked,
    around: &Surroundings,
) -> Result<super::Found, Unbalanced> {
    let (t, ride) = (cases.transmission, cases.ride);
    let (case, scratch) = (&cases.known[asked.place].1, cases.scratches[asked.place].alone());
    let point = &point_of(case, ride, asked, interval.inclination);
    let wanted = interval.given.oil_temperature.map_or(ride.oil, OilTemperature::Fixed);
    Ok(match wanted {
        OilTemperature::Network => {
            let moment = Moment { case, point, around };
            let steady = t.steady(&moment, scratch).ok_or(Unbalanced::Flow)?;
            super::Found::steady(t, steady)
        }
        other => other.find(t, case, point, scratch),
    })
}

/// A steady-state interval: at a given temperature, or at the equilibrium with its own losses. What choosing its gear has solved is not
/// solved again.
fn steady(
    cases: &mut Cases<'_>,
    planned: &Planned<'_>,
    solved: Option<Solved>,
    driven: &mut Driven,
) -> Result<Passed, Unbalanced> {
    let Planned { interval, asked, .. } = planned;
    let (found, point) = solved.map_or((None, None), |solved| (solved.found, solved.point));
    let warm = if let Some(warm) = found {
        warm
    } else {
        let warm = steady_temperatures(cases, interval, asked, &planned.around)?;
        driven.evaluations += warm.evaluations();
        warm
    };
    if !warm.is_sound() {
        let balance = warm.balance.as_ref().and_then(|b| b.undefined);
        let network = warm.network.as_ref().and_then(|n| n.undefined);
        return Err(balance.map(|(_, why)| why).or(network).unwrap_or(Unbalanced::Flow));
    }
    let t = cases.transmission;
    let duration = interval.duration;
    let point = if let Some(point) = point {
        point
    } else {
        driven.evaluations += 1;
        let (case, scratch) = (&cases.known[asked.place].1, &mut cases.scratches[asked.place]);
        let point = point_of(case, cases.ride, asked, interval.inclination);
        t.snapshot(case, &point, warm.temperatures(), Noting::Seen, scratch)?
    };
    point.count(t, &mut driven.seen);
    for (cell, watts) in point.lost_outside(t) {
        driven.lost_outside[cell] += watts * duration;
    }
    let each = |list: &[f64]| list.iter().map(|x| x * duration).collect();
    let [input, output] = point.power;
    let mut heats = Heats {
        duration,
        parts: each(&point.watts),
        input: input * duration,
        output: output * duration,
        ..Heats::default()
    };
    if let Some(steady) = &warm.network {
        heats.motors = steady.motors.iter().map(|m| m.map(|x| x * duration)).collect();
        heats.inverters = each(&steady.inverters);
        heats.sources = t
            .network()
            .map_or(0.0, |n| n.sources().iter().map(|(_, watts)| watts * duration).sum());
        heats.held = each(&steady.leaving.held);
        heats.exchangers = each(&steady.leaving.exchangers);
        heats.flows = steady.leaving.flows * duration;
    }
    let machines = t.machines_at(&point.speeds, &point.port_torques, warm.temperatures());
    heats.machines = (machines.iter())
        .map(|state| MachineEnergy::lasting(state, duration))
        .collect();
    Ok(Passed {
        heats,
        temperatures: warm.temperatures().to_vec(),
        speeds: point.speeds,
        port_torques: point.port_torques,
        status: point.status,
    })
}
