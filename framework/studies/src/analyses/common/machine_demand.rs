//! What the points of an analysis demand of machines beyond their loss maps and envelopes, found without solving any point.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::machine::{Machine, Reached};
use gearloss_framework::transmission::{Case, Transmission};

use super::outside_maps::MachineOutside;
use crate::analyses::Built;
use crate::codes;
use crate::points::{Given, OilTemperature, Points};

/// Points beyond the maps and the envelopes of machines.
#[derive(Debug, Default)]
pub(crate) struct MachineDemand {
    /// By model set, because several sets are solved at the same points.
    by_set: BTreeMap<String, Beyond>,
    /// Machines whose torque is not given: paths.
    lossless: Vec<String>,
}

/// The same with one model set.
#[derive(Debug, Default)]
struct Beyond {
    outside_map: Vec<MachineOutside>,
    envelope: Vec<MachineOutside>,
}

/// A machine with its speed over that of the points, and its torque over theirs.
struct Seat<'t> {
    machine: &'t Machine,
    speed: f64,
    torque: f64,
}

impl MachineDemand {
    /// Adds points that are solved in a gear, or in the one of several gears that is chosen at each point: such a point is beyond if it
    /// is in all of them, and counts as that of the gear in which it is least.
    pub fn add(&mut self, built: &Built<'_>, gears: &[&Points]) {
        let t = &built.transmission;
        let Some(first) = gears.first() else { return };
        if t.active_machines(first.oil == OilTemperature::Network).next().is_none() {
            return;
        }
        let seats: Vec<Vec<Seat<'_>>> = gears.iter().map(|points| self.seats(t, points)).collect();
        let beyond = self.by_set.entry(built.name.clone()).or_default();
        for i in 0..first.field.len() {
            let given = first.field.given_point(i);
            let all = seats.iter().map(|seats| Beyond::at(seats, given));
            if let Some(least) = all.min_by(Beyond::compare) {
                MachineOutside::merge(&mut beyond.outside_map, least.outside_map);
                MachineOutside::merge(&mut beyond.envelope, least.envelope);
            }
        }
    }

    /// The machines in a gear. Torques that are not given are those without losses, which are in proportion.
    fn seats<'t>(&mut self, t: &'t Transmission, points: &Points) -> Vec<Seat<'t>> {
        // Points that do not fit are refused by who asks for them.
        let Ok(case) = points.case(t) else { return Vec::new() };
        let mut unit_speeds = vec![0.0; case.speed_ports.len()];
        if let Some(first) = unit_speeds.first_mut() {
            *first = 1.0;
        }
        let speeds = t.speeds(&case, &unit_speeds);
        let mut seats = Vec::new();
        for machine in t.active_machines(points.oil == OilTemperature::Network) {
            let place = case.torque_ports.iter().position(|port| *port == machine.port);
            let torque = match place {
                Some(0) => 1.0,
                Some(_) => 0.0,
                None => {
                    if !self.lossless.contains(&machine.path) {
                        self.lossless.push(machine.path.clone());
                    }
                    lossless_torque(t, &case, &unit_speeds, machine)
                }
            };
            seats.push(Seat {
                machine,
                speed: speeds[machine.member],
                torque,
            });
        }
        seats
    }

    /// A warning for each machine, at a path.
    pub fn warnings(&self, path: &str) -> Vec<Diagnostic> {
        let warning = |beyond: &MachineOutside, message: String, help: &str| {
            let found = Diagnostic::warning(path, message)
                .help(help)
                .code(codes::MACHINE_DEMAND);
            if self.lossless.contains(&beyond.machine) {
                found.note("its torque is taken without the losses of the gearbox")
            } else {
                found
            }
        };
        let outside = self.most(|of_set| &of_set.outside_map).into_iter().map(|beyond| {
            let help = "extend the map, or state other points; the loss at the edge of the map is used";
            warning(beyond, beyond.words("outside its map"), help)
        });
        let beyond = self.most(|of_set| &of_set.envelope).into_iter().map(|beyond| {
            let help = "state points that the machine can run, or correct `envelope`; points are not limited";
            warning(beyond, beyond.words("beyond its envelope"), help)
        });
        outside.chain(beyond).collect()
    }

    /// Each machine with the model set that has it beyond at most points.
    fn most(&self, of: fn(&Beyond) -> &Vec<MachineOutside>) -> Vec<&MachineOutside> {
        let rank = |beyond: &MachineOutside| (beyond.points, beyond.size());
        let mut all: Vec<&MachineOutside> = Vec::new();
        for beyond in self.by_set.values().flat_map(of) {
            match all.iter_mut().find(|known| known.machine == beyond.machine) {
                Some(known) if rank(known) < rank(beyond) => *known = beyond,
                Some(_) => {}
                None => all.push(beyond),
            }
        }
        all
    }
}

impl Beyond {
    /// One point in a gear.
    fn at(seats: &[Seat<'_>], given: Given) -> Self {
        let mut found = Self::default();
        for seat in seats {
            let (machine, speed, torque) = (seat.machine, seat.speed * given.speed, seat.torque * given.torque);
            // Without torque a machine whose inverter is off needs no map.
            let map = machine.map().filter(|_| torque != 0.0 || !machine.freewheels());
            if map.is_some_and(|map| map.excess(speed, torque) > 0.0) {
                let excess = machine.excess(speed, torque);
                found
                    .outside_map
                    .push(MachineOutside::beyond(machine, [torque, speed], excess));
            }
            let envelope = machine.envelope();
            if let Some(envelope) = envelope.filter(|of| of.reached(speed, torque) == Reached::Beyond) {
                let excess = [torque.abs() - envelope.most(speed), 0.0];
                found
                    .envelope
                    .push(MachineOutside::beyond(machine, [torque, speed], excess));
            }
        }
        found
    }

    /// Less is no machine beyond, then less power of the excess, which is none at standstill.
    fn compare(&self, other: &Self) -> Ordering {
        let rank = |beyond: &Self| {
            let places = [&beyond.outside_map, &beyond.envelope].into_iter().flatten();
            let sizes: Vec<f64> = places.map(MachineOutside::size).collect();
            (!sizes.is_empty(), sizes.iter().sum::<f64>())
        };
        let [(own, size), (others, other_size)] = [self, other].map(rank);
        own.cmp(&others).then(size.total_cmp(&other_size))
    }
}

/// Torque of a machine over that of the points without losses; zero where no torque flows. \[-\]
fn lossless_torque(t: &Transmission, case: &Case, speeds: &[f64], machine: &Machine) -> f64 {
    let mut torques = vec![0.0; case.torque_ports.len()];
    let Some(first) = torques.first_mut() else { return 0.0 };
    *first = 1.0;
    let point = Point {
        speeds,
        torques: &torques,
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let mut scratch = t.scratch(case);
    let solution = t.evaluate(case, &point, &[t.oil_temperature], &mut scratch);
    if solution.has_flow() {
        solution.port_torque(machine.member)
    } else {
        0.0
    }
}
