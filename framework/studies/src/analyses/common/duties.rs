//! Reads and simulates the cycles of a study.

use std::sync::Arc;

use crate::codes;
use crate::duty::{Battery, Consumption, Demand, Duty, Given, Interval, Vehicle, VehicleEntry};
use crate::points::{Choosing, Driven, GearChoice, OilTemperature, Ride, can_drive, drive};
use crate::study::{By, Conditions, RideEntry};
use gearloss_framework::document::data::{MeasuredFault, TableFile};
use gearloss_framework::document::{Diagnostic, classify};
use gearloss_framework::machine::Machine;
use gearloss_framework::motor::MotorMap;
use gearloss_framework::thermal::network::{Network, StepSize};
use gearloss_framework::transmission::Transmission;

use super::gears::{GearOfCycles, check_gears};
use super::shares::Shares;
use super::trial::{Left, left};
use crate::analyses::balance::reason;
use crate::analyses::{Built, Engine, Plan, Planner, Stopped, Work, gear_of};

/// A cycle as read.
pub struct Read {
    /// Name in the study.
    pub name: String,
    /// Its path in the study.
    place: String,
    /// Its content.
    pub duty: Duty,
    /// Its intervals.
    pub intervals: Vec<Interval>,
    /// Port of recorded torques.
    port: Option<String>,
    /// Notes on its file.
    pub about: Option<String>,
    /// Names of its phases with the time from the start of the cycle at which each ends. \[s\]
    pub phases: Vec<(String, f64)>,
}

/// Cycles of an analysis with the settings of the simulation. It can be shared among threads.
pub struct Duties<'a> {
    /// The cycles.
    pub list: Vec<Read>,
    vehicle: Option<Vehicle>,
    /// Its name in the study.
    vehicle_id: &'a str,
    /// Battery of the vehicle with its motor.
    battery: Option<Battery>,
    entry: &'a RideEntry,
    /// Gear of cycles without one.
    gear: Option<&'a str>,
    /// How gears are chosen instead.
    choice: Option<GearChoice>,
    conditions: &'a Conditions,
}

/// The gearbox with each set, and cycles that fit it.
pub struct DrivePlan<'a> {
    /// The gearbox with each set.
    pub built: Vec<Arc<Built<'a>>>,
    /// The cycles.
    pub duties: Duties<'a>,
}

impl<'a> DrivePlan<'a> {
    /// Cycles that fit the gearboxes. `path` is the place of the ride in the study.
    ///
    /// # Errors
    /// As [`Duties::check`].
    pub fn new(cx: &Planner<'a>, path: &str, duties: Duties<'a>, built: Vec<Arc<Built<'a>>>) -> Result<Self, Stopped> {
        built.iter().try_for_each(|b| duties.check(cx, path, b))?;
        Ok(Self { built, duties })
    }

    /// Simulates every cycle with every set, in jobs: set by set.
    ///
    /// # Errors
    /// An interruption, or cycles that do not fit.
    pub fn drive(&self, engine: &Engine<'_>) -> Result<Vec<Vec<Driven>>, Stopped> {
        let count = self.duties.list.len();
        let driven = engine.jobs("cycles", self.built.len() * count, |i| {
            let b = &self.built[i / count];
            let read = &self.duties.list[i % count];
            let driven = self.duties.drive(&b.transmission, read, &|_| engine.should_continue());
            let driven = driven.map_err(|list| Stopped::from(b.gearbox.findings(list)))?;
            driven.ok_or(Stopped::Interrupted)
        })?;
        let mut driven = driven.into_iter();
        Ok(self
            .built
            .iter()
            .map(|_| driven.by_ref().take(count).collect())
            .collect())
    }
}

impl DrivePlan<'_> {
    /// Refuses cycles of which one broke off.
    ///
    /// # Errors
    /// There.
    pub fn refuse_broken(&self, engine: &Engine<'_>, driven: &[Vec<Driven>]) -> Result<(), Stopped> {
        for (b, driven_of_set) in self.built.iter().zip(driven) {
            for (read, driven) in self.duties.list.iter().zip(driven_of_set) {
                let Some((time, why)) = &driven.broken else { continue };
                let message = format!(
                    "`{}` could not be simulated with `{}` beyond {time} s: {}",
                    read.name,
                    b.name,
                    reason(&b.transmission, why)
                );
                let help = "examine the point with `explain`";
                return Err(engine.wrong_as(codes::BROKEN_OFF, &engine.path(), message, help));
            }
        }
        Ok(())
    }
}

impl Plan for DrivePlan<'_> {
    fn work(&self) -> Vec<Work> {
        let work = |b: &Arc<Built<'_>>| Work::new(&b.name, "cycle", self.duties.list.len());
        self.built.iter().map(work).collect()
    }
}

impl<'a> Duties<'a> {
    /// Reads the cycles of an analysis at a path.
    pub fn new(
        cx: &Planner<'a>,
        path: &str,
        entry: &'a RideEntry,
        gear: Option<GearOfCycles<'a>>,
    ) -> Result<Self, Stopped> {
        let study = &cx.study.entry;
        if entry.step.is_some() && entry.tolerance.is_some() {
            let message = "both `step` and `tolerance` are given";
            return Err(cx.wrong_as(codes::DUTY, path, message, "delete one of them"));
        }
        let mut found = Vec::new();
        if entry.vehicle.is_none() && study.vehicles.len() > 1 {
            let names: Vec<&str> = study.vehicles.ids().collect();
            let message = format!("the study has several vehicles: {}", names.join(", "));
            return Err(cx.wrong_as(codes::DUTY, path, message, "select one, such as `vehicle: car`"));
        }
        let vehicle_id: Option<&'a str> = entry.vehicle.as_deref().or_else(|| study.vehicles.ids().next());
        let vehicle = vehicle_id.and_then(|id| Some((id, study.vehicles.get(id)?)));
        let vehicle = vehicle.and_then(|(id, vehicle)| {
            let read = vehicle.vehicle(&format!("vehicles.{id}"));
            read.map_err(|fault| found.push(fault)).ok()
        });
        let battery = vehicle_id.and_then(|id| Some((id, study.vehicles.get(id)?)));
        let battery = battery.and_then(|(id, vehicle)| {
            let read = battery_of(cx, &format!("vehicles.{id}"), vehicle);
            read.map_err(|faults| found.extend(faults)).ok().flatten()
        });
        let mut list = Vec::new();
        for name in &entry.cycles {
            let Some(cycle) = study.cycles.get(name) else { continue };
            let at = format!("cycles.{name}");
            let read = |file: &str| {
                let bytes = cx
                    .study
                    .read_file(file)
                    .map_err(|e| format!("cannot read {file}: {e}"))?;
                cx.keep_input(file, &bytes);
                Ok(bytes)
            };
            let duty = match cycle.read(cx.language.registry(), read) {
                Ok(duty) => duty,
                Err(faults) => {
                    found.extend(
                        faults
                            .into_iter()
                            .map(|f| Diagnostic::error(&at, f.message).help(f.help).code(codes::DUTY)),
                    );
                    continue;
                }
            };
            match duty.intervals(vehicle.as_ref()) {
                Ok(intervals) => list.push(Read {
                    name: name.clone(),
                    place: at.clone(),
                    duty,
                    intervals,
                    port: cycle.port().map(str::to_owned),
                    about: cycle.about().map(str::to_owned),
                    phases: cycle.phases(cx.language.registry()),
                }),
                Err(fault) => found.push(Diagnostic::error(&at, fault.message).help(fault.help).code(codes::DUTY)),
            }
        }
        if !entry.points.is_empty() {
            let place = format!("{path}.points");
            match crate::duty::points(&entry.points) {
                Ok(intervals) => list.push(Read {
                    name: "points".to_owned(),
                    place,
                    duty: Duty::Spectrum(intervals.clone()),
                    intervals,
                    port: Some(study.conditions.torque_at.clone()),
                    about: None,
                    phases: Vec::new(),
                }),
                Err(faults) => found.extend(
                    faults
                        .into_iter()
                        .map(|f| Diagnostic::error(&place, f.message).help(f.help)),
                ),
            }
        } else if entry.cycles.is_empty() {
            let help = "add `cycles: [NAME]`, or `points: [{ torque: 10 Nm, speed: 3000 rpm }]` for loads without an order in time";
            return Err(cx.wrong_as(codes::DUTY, path, "neither a cycle nor a point is stated", help));
        }
        if !found.is_empty() {
            classify(&mut found, codes::DUTY);
            return Err(cx.study.findings(found).into());
        }
        Ok(Self {
            list,
            vehicle,
            vehicle_id: vehicle_id.unwrap_or_default(),
            battery,
            entry,
            gear: gear.and_then(GearOfCycles::name),
            choice: match gear {
                // The gear of a sweep or comparison over cycles is beside `drive`.
                Some(gear) => gear.choice(cx, &format!("{}.gear", path.strip_suffix(".drive").unwrap_or(path)))?,
                None => None,
            },
            conditions: &study.conditions,
        })
    }

    /// Whether the consumption over a cycle is known: there are a battery and the speed of the vehicle.
    pub fn has_consumption(&self, cycle: usize) -> bool {
        let mut intervals = self.list[cycle].intervals.iter();
        self.battery.is_some() && intervals.all(|interval| interval.given.vehicle_speed.is_some())
    }

    /// The machine that the vehicle states.
    pub fn machine(&self) -> Option<&Machine> {
        self.battery.as_ref().and_then(|battery| battery.motor.as_ref())
    }

    /// Whether the losses of a machine are described: in the gearbox, or by a map of the vehicle.
    pub fn has_machine(&self, t: &Transmission) -> bool {
        let oil = OilTemperature::from_conditions(t, self.conditions.oil_temperature);
        let in_gearbox = || t.active_machines(oil == OilTemperature::Network).next().is_some();
        self.machine().is_some() || in_gearbox()
    }

    /// Energy of the vehicle over a simulated cycle; absent without a battery or without distance.
    pub fn consumption(&self, t: &Transmission, driven: &Driven) -> Option<Consumption> {
        let oil = t.network().map_or(0, Network::oil);
        self.battery.as_ref()?.consumption(driven, oil)
    }

    /// Refuses a machine of the vehicle beside one of the gearbox. A fixed temperature replaces the network with its motors.
    fn machine_once(&self, cx: &Planner<'_>, path: &str, t: &Transmission) -> Result<(), Stopped> {
        let oil = OilTemperature::from_conditions(t, self.conditions.oil_temperature);
        let Some(machine) = t.active_machines(oil == OilTemperature::Network).next() else {
            return Ok(());
        };
        if self.battery.as_ref().is_none_or(|battery| battery.motor.is_none()) {
            return Ok(());
        }
        let message = if machine.only_in_network {
            "`motor_map` of the vehicle, but the thermal network of the gearbox has a motor"
        } else {
            "`motor_map` of the vehicle, but the gearbox has a machine: its losses would be counted twice"
        };
        Err(cx.wrong_as(codes::DUTY, path, message, "delete `motor_map` of the vehicle"))
    }

    /// Reasons why the cycles cannot be simulated with a gearbox.
    pub fn check(&self, cx: &Planner<'_>, path: &str, b: &Built<'_>) -> Result<(), Stopped> {
        let oil = OilTemperature::from_conditions(&b.transmission, self.conditions.oil_temperature);
        let shafts = self.vehicle.as_ref().and_then(|vehicle| vehicle.inertia.as_ref());
        let members: Vec<&str> = b.transmission.members().iter().map(String::as_str).collect();
        let shafts = shafts.map_or_else(Vec::new, |inertia| inertia.shafts.ids().collect());
        if let Some(unknown) = shafts.iter().find(|shaft| !members.contains(shaft)) {
            let at = format!("vehicles.{}.inertia.shafts", self.vehicle_id);
            let error = gearloss_framework::attach::dangling(&at, "shaft", unknown, &members);
            return Err(cx.study.findings(vec![error]).into());
        }
        self.machine_once(cx, path, &b.transmission)?;
        let in_time = self.list.iter().find(|read| matches!(read.duty, Duty::Trace(_)));
        if let (OilTemperature::Balance, Some(read)) = (oil, in_time) {
            let message = format!(
                "`{}` is transient, but the heat balance of the gearbox is steady-state",
                read.name
            );
            let help = "write `thermal: { mode: network, network: auto }` in the gearbox, or `conditions: { oil_temperature: ... }`";
            return Err(cx.wrong_as(codes::DUTY, path, message, help));
        }
        // Keys that need transient or computed temperatures.
        let goes_on = oil == OilTemperature::Network && in_time.is_some();
        let unused = [
            ("start", self.entry.start.is_some() && !goes_on),
            ("step", self.entry.step.is_some() && !goes_on),
            ("tolerance", self.entry.tolerance.is_some() && !goes_on),
            ("scheme", self.entry.scheme.is_some() && !goes_on),
            (
                "ambient",
                self.entry.ambient.is_some() && oil != OilTemperature::Network,
            ),
        ];
        if let Some((key, _)) = unused.iter().find(|(_, unused)| *unused) {
            let message = match oil {
                OilTemperature::Network => "loads without an order in time have no transient temperatures",
                OilTemperature::Fixed(_) => "the oil temperature is given, so this key has no effect",
                OilTemperature::Balance => "the heat balance of the gearbox states its own ambient temperature",
            };
            let help = match oil {
                OilTemperature::Network => "delete it",
                _ => "delete it, or give the gearbox a thermal network",
            };
            return Err(cx.wrong_as(codes::DUTY, &format!("{path}.{key}"), message, help));
        }
        let told = |read: &&Read| read.intervals.iter().any(|i| i.given.oil_temperature.is_some());
        if let (OilTemperature::Network, Some(read)) = (oil, self.list.iter().find(told)) {
            let message = format!(
                "`{}` contains oil temperatures, which the thermal network computes",
                read.name
            );
            let help = "delete them, or state `conditions: { oil_temperature: ... }`; a column under `temperatures`, with its node, is used for comparison";
            return Err(cx.wrong_as(codes::DUTY, &read.place, message, help));
        }
        if let Some(choice) = &self.choice {
            check_gears(cx, choice, &b.transmission)?;
        }
        for read in &self.list {
            can_drive(&b.transmission, &self.ride(&b.transmission, read)).map_err(|list| unfit(cx, read, list))?;
        }
        let network = b.transmission.network().filter(|_| oil == OilTemperature::Network);
        let cooled = network.is_some_and(|n| n.exchangers().len() > 0);
        for read in &self.list {
            let any = |of: fn(&Given) -> bool| read.intervals.iter().any(|i| of(&i.given));
            let unused = [
                (
                    "coolant_temperature",
                    any(|g| g.coolant_temperature.is_some()) && !cooled,
                ),
                ("coolant_flow", any(|g| g.coolant_flow.is_some()) && !cooled),
                (
                    "oil_flow",
                    any(|g| g.oil_flow.is_some()) && !network.is_some_and(Network::is_pumped),
                ),
                ("ambient", any(|g| g.ambient.is_some()) && network.is_none()),
            ];
            if let Some((column, _)) = unused.iter().find(|(_, unused)| *unused) {
                let what = match *column {
                    "oil_flow" => "a thermal network with `oil_flow`",
                    "ambient" => "a thermal network",
                    _ => "a heat exchanger in the thermal network",
                };
                let message = format!("`{column}` of `{}` needs {what}", read.name);
                let help = "delete the column, or describe the component that uses it";
                return Err(cx.wrong_as(codes::DUTY, &format!("{}.columns", read.place), message, help));
            }
            let Duty::Trace(trace) = &read.duty else { continue };
            let nodes: Vec<&str> = match network {
                Some(network) => network.names().iter().map(String::as_str).collect(),
                None => vec!["oil"],
            };
            if let Some(unknown) = trace.nodes.iter().find(|node| !nodes.contains(&node.as_str())) {
                let at = format!("{}.temperatures", read.place);
                let error = gearloss_framework::attach::dangling(&at, "node", unknown, &nodes);
                return Err(cx.study.findings(vec![error]).into());
            }
        }
        Ok(())
    }

    /// Simulates one of them; absent if `progress` interrupts.
    pub fn drive(
        &self,
        t: &Transmission,
        read: &Read,
        progress: &dyn Fn(usize) -> bool,
    ) -> Result<Option<Driven>, Vec<Diagnostic>> {
        drive(t, &self.ride(t, read), progress)
    }

    /// Settings of the simulation of one of them.
    pub fn ride<'r>(&'r self, t: &'r Transmission, read: &'r Read) -> Ride<'r> {
        let of_port = read.intervals.iter().any(|i| matches!(i.demand, Demand::Port { .. }));
        let longest = read.intervals.iter().map(|i| i.duration).fold(0.0, f64::max);
        Ride {
            intervals: &read.intervals,
            // A series without torque belongs to no port and uses the reference port.
            port: read
                .port
                .as_deref()
                .filter(|_| of_port)
                .unwrap_or(&t.ports()[t.reference_port()].name),
            vehicle: self.vehicle.as_ref(),
            gear: gear_of(self.gear, t),
            choice: self.choice.as_ref().map(|choice| Choosing {
                choice,
                machine: self.machine(),
            }),
            oil: OilTemperature::from_conditions(t, self.conditions.oil_temperature),
            spectrum: matches!(read.duty, Duty::Spectrum(_)),
            start: self.entry.start,
            ambient: self.entry.ambient,
            scheme: self.entry.scheme.unwrap_or_default(),
            step: match self.entry.tolerance {
                Some(tolerance) => StepSize::Adaptive(tolerance),
                None => StepSize::Fixed(self.entry.step.unwrap_or(longest)),
            },
            flow: self.conditions.power_flow,
        }
    }
}

/// Moves an error to the cycle that causes it.
fn unfit(cx: &Planner<'_>, read: &Read, list: Vec<Diagnostic>) -> Stopped {
    let at_duty = |mut error: Diagnostic| {
        let key = if error.path == "ports" && read.place.starts_with("cycles.") && read.port.is_some() {
            ".port"
        } else {
            ""
        };
        // A choice of gears states its own place.
        if error.code != Some(codes::GEAR_CHOICE) {
            error.path = format!("{}{key}", read.place);
        }
        error
    };
    let mut list: Vec<Diagnostic> = list.into_iter().map(at_duty).collect();
    // An unknown port of both torque and speed is reported once.
    list.dedup();
    cx.study.findings(list).into()
}

/// Names of the temperatures of a simulated cycle: nodes, or the oil only.
pub fn nodes(t: &Transmission, driven: &Driven) -> Vec<String> {
    match t.network().filter(|n| n.names().len() == driven.start.len()) {
        Some(network) => network.names().to_vec(),
        // A cycle that could not start has no temperature.
        None => vec!["oil".to_owned(); driven.start.len()],
    }
}

/// Mean losses of a cycle.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MeanLoss {
    /// Loss of the transmission. \[W\]
    pub loss: f64,
    /// The same by share. \[W\]
    pub shares: Vec<f64>,
    /// Energy of the vehicle; absent without a battery or without distance.
    pub consumption: Option<Consumption>,
}

/// Why a transmission has no mean losses of the cycles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unfinished {
    /// What is wrong.
    pub message: String,
    /// Why the simulation of a cycle stopped; absent if it did not start.
    pub reason: Option<String>,
}

impl From<String> for Unfinished {
    fn from(message: String) -> Self {
        Self { message, reason: None }
    }
}

impl Unfinished {
    /// The message with its reason.
    pub fn text(self) -> String {
        match self.reason {
            Some(reason) => format!("{}: {reason}", self.message),
            None => self.message,
        }
    }
}

impl Duties<'_> {
    /// Drives every cycle to its end, unless it should not continue.
    ///
    /// # Errors
    /// If one cannot be driven to its end.
    pub fn drive_all(&self, t: &Transmission, should_continue: &dyn Fn() -> bool) -> Result<Vec<Driven>, Unfinished> {
        let mut all = Vec::new();
        for read in &self.list {
            let driven = self
                .drive(t, read, &|_| should_continue())
                .map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?
                .ok_or_else(|| "interrupted".to_owned())?;
            if let Some((time, why)) = &driven.broken {
                return Err(Unfinished {
                    message: format!("`{}` could not be simulated beyond {time} s", read.name),
                    reason: Some(reason(t, why)),
                });
            }
            all.push(driven);
        }
        Ok(all)
    }

    /// Mean losses of every cycle, with shares under common names of several transmissions, and quantities outside their stated ranges.
    pub fn mean_losses(
        &self,
        engine: &Engine<'_>,
        t: &Transmission,
        by: By,
        names: &[String],
    ) -> Result<(Vec<MeanLoss>, Left), Unfinished> {
        Ok(self.mean_losses_of(t, &self.drive_all(t, &|| engine.should_continue())?, by, names))
    }

    /// Mean losses of driven cycles, as [`Duties::mean_losses`].
    pub fn mean_losses_of(
        &self,
        t: &Transmission,
        driven: &[Driven],
        by: By,
        names: &[String],
    ) -> (Vec<MeanLoss>, Left) {
        let shares = Shares::new(t, by).under(names);
        let mean = |driven: &Driven| {
            let time = driven.total.duration;
            MeanLoss {
                loss: driven.total.parts.iter().sum::<f64>() / time,
                shares: shares.sums(&driven.total.parts).iter().map(|x| x / time).collect(),
                consumption: self.consumption(t, driven),
            }
        };
        let seen = driven.iter().flat_map(|cycle| left(t, &cycle.seen));
        (driven.iter().map(mean).collect(), seen.collect())
    }
}

/// Rejects sums by the terms of models, because energies of cycles are stored by component only.
pub fn sums_energies(cx: &Planner<'_>, path: &str, by: By) -> Result<(), Stopped> {
    if matches!(by, By::Term | By::Sum | By::Unit) {
        let message = "the energies of a cycle can be summed by mechanism, component or stage only";
        return Err(cx.wrong_as(
            codes::DUTY,
            &format!("{path}.by"),
            message,
            "write `by: mechanism`, `component` or `stage`",
        ));
    }
    Ok(())
}

/// The battery of a vehicle with the losses of its motor.
fn battery_of(cx: &Planner<'_>, path: &str, vehicle: &VehicleEntry) -> Result<Option<Battery>, Vec<Diagnostic>> {
    let Some(entry) = vehicle.battery.clone() else {
        let unused = vehicle.motor_map.as_ref().map(|_| {
            let error = Diagnostic::error(
                format!("{path}.motor_map"),
                "a motor without a battery changes no result",
            );
            vec![error.help("state `battery: { energy: 60 kWh, efficiency: 0.95 }`, or delete `motor_map`")]
        });
        return unused.map_or(Ok(None), Err);
    };
    let wrong = |key: &str, message: &str, help: &str| {
        let at = format!("{path}.battery{key}");
        vec![Diagnostic::error(at, message).help(help).code(codes::BATTERY)]
    };
    match (entry.efficiency, &entry.cells) {
        (None, None) => {
            let help = "write `efficiency: 0.95`, or `cells` with voltage and resistance";
            return Err(wrong("", "the losses of the battery are not stated", help));
        }
        (Some(_), Some(_)) => {
            let message = "a constant efficiency beside `cells` would count the losses twice";
            return Err(wrong(".efficiency", message, "delete one of them"));
        }
        (None, Some(_)) if entry.charge_efficiency.is_some() => {
            let message = "a constant efficiency beside `cells` would count the losses twice";
            let help = "delete it, or state `coulombic_efficiency` of the cells";
            return Err(wrong(".charge_efficiency", message, help));
        }
        (None, Some(cells)) => {
            if let Some((key, message)) = cells.fault() {
                return Err(wrong(&format!(".cells.{key}"), &message, "correct it"));
            }
        }
        (Some(_), None) => {}
    }
    let Some(map) = &vehicle.motor_map else {
        return Ok(Some(Battery {
            entry,
            motor: None,
            fixed_efficiency: vehicle.efficiency,
        }));
    };
    Ok(Some(Battery {
        entry,
        motor: Some(machine_of_map(cx, &format!("{path}.motor_map"), map)?),
        fixed_efficiency: vehicle.efficiency,
    }))
}

/// A machine with the losses of a file, at the port of a cycle or the reference port, wherever it is in the gearbox.
pub fn machine_of_map(cx: &Planner<'_>, at: &str, map: &TableFile) -> Result<Machine, Vec<Diagnostic>> {
    let file = map.name();
    let bytes = cx.study.read_file(file);
    let bytes = bytes
        .map_err(|e| vec![Diagnostic::error(at, format!("cannot read {file}: {e}")).help("check the file name")])?;
    cx.keep_input(file, &bytes);
    let of_file = |fault: MeasuredFault| Diagnostic::error(at, format!("{file}: {}", fault.message)).help(fault.help);
    let map = MotorMap::read_stated(map, &bytes);
    let map = map.map_err(|faults| faults.into_iter().map(of_file).collect::<Vec<_>>())?;
    Ok(Machine::of_map(at, (0, 0), map))
}
