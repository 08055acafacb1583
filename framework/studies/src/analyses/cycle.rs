//! Simulated cycles: losses, energy, temperatures.

mod bands;
mod bearings;
mod gears;
mod machines;
mod outcome;
mod points;
pub(super) mod ratings;
pub(super) mod results;
mod tables;

use std::sync::Arc;

use gearloss_fmu::Library;
use gearloss_framework::attach::dangling;
use gearloss_framework::description::Ordered;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Findings;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::duties::{DrivePlan, Duties, Read, sums_energies};
use super::common::inputs::Input;
use super::common::model_error::{ModelErrorEntry, energies_of_parts};
use super::common::shares::{Shares, together};
use super::common::units::libraries;
use super::{Analysis, Built, Engine, Head, Outcome, Plan, Planner, Stopped, Work};
use crate::analyses::common::limits_over_cycles::{limits_of, reached};
use crate::codes;
use crate::distinct::distinct;
use crate::limits::Limit;
use crate::limits::at_points;
use crate::numbers::tidy;
use crate::points::{Driven, Note};
use crate::register_analysis;
use crate::study::{By, DriveEntry, ToleranceEntry, Uses, Write};
use crate::table::Table;

pub use bearings::{BearingLoad, BearingLoads, Load, LoadCase};
pub use gears::{Criterion, GearsOfDuty, OptimumOfDuty, TimeInGear};
pub use machines::{MachineOfDuty, OutsideMap};
pub use ratings::RatedOverTime;
pub use tables::NetworkTables;

pub use outcome::{
    BandOfDuty, BrokenOff, CycleOutcome, DutyOfSet, EnergyOfDuty, EnergyPerDistance, HeatOfDuty, HeatOfExchanger,
    HeatOfMotor, HeatOfNode, InputOfBand, IntervalOfDuty, ReferenceOfDuty, TemperatureOfNode,
};

/// Cycle losses, energy and temperatures, for driving cycles or load spectra.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct CycleAnalysisEntry {
    /// Cycles and settings of the simulation.
    #[serde(flatten)]
    pub drive: DriveEntry,
    /// Grouping of losses.
    #[serde(default)]
    pub by: By,
    /// Reference mean losses by cycle, such as published values, for comparison.
    #[serde(default)]
    pub reference: Ordered<ReferenceLoss>,
    /// Uncertain inputs: every cycle is simulated with values drawn from their distributions.
    #[serde(default)]
    pub inputs: Vec<ToleranceEntry>,
    /// Error of the models for the bands: a factor on the loss of each model that measured sets judge.
    pub model_error: Option<ModelErrorEntry>,
    /// Number of samples of uncertain inputs; powers of two fill the ranges most evenly. [-]
    #[serde(default = "samples")]
    #[schemars(range(min = 8, max = 65536))]
    pub samples: u32,
    /// Ratings of the components over each cycle: lives after Palmgren and Miner at the temperature of each moment, extremes of the
    /// other quantities.
    #[serde(default)]
    pub ratings: bool,
    /// Results for other programs: the thermal network with tables instead of models, loads and speeds of the bearings.
    #[serde(default)]
    pub export: Vec<CycleExport>,
    /// Number of classes of torque, and of speed, for `bearing_loads` and `rexs_loads` of a cycle in time; 0: every interval is a load case.
    /// Default: 20. [-]
    #[schemars(range(min = 0, max = 1000))]
    pub load_classes: Option<u32>,
    /// Libraries of further platforms for `export`: files out of the folder `binaries` of FMUs that were written there. That of the own
    /// platform is always included.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "file"))]
    pub fmu_libraries: Vec<String>,
}

/// A format of results of cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CycleExport {
    /// The temperatures over time as a Functional Mock-up Unit of FMI 2.0, for Co-Simulation and Model Exchange.
    Fmu2,
    /// As `fmu2`, of FMI 3.0.
    Fmu3,
    /// Loads and speeds of the bearings by load case as CSV, for programs of life and noise.
    BearingLoads,
    /// The same as load cases of a REXS 1.7 model of the bearings.
    RexsLoads,
}

impl CycleExport {
    /// True if it contains the thermal network.
    fn is_network(self) -> bool {
        matches!(self, Self::Fmu2 | Self::Fmu3)
    }
}

fn samples() -> u32 {
    64
}

/// A reference mean loss.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct ReferenceLoss {
    /// Mean loss of the transmission over the whole cycle. [W]
    #[schemars(range(min = 1e-6, max = 1e9))]
    pub loss: f64,
    /// Provenance.
    pub source: Option<String>,
}

register_analysis!(CycleAnalysisEntry);

/// The gearbox with each set, its cycles, limits and uncertain inputs.
pub struct CyclePlan<'a> {
    drive: DrivePlan<'a>,
    limits: Vec<Vec<Limit>>,
    inputs: Vec<Vec<Input>>,
    /// Number of samples of the inputs.
    samples: usize,
    libraries: Vec<Library>,
}

impl Plan for CyclePlan<'_> {
    fn work(&self) -> Vec<Work> {
        let mut work = self.drive.work();
        if self.samples > 0 {
            let count = self.samples * self.drive.duties.list.len();
            let of_set = |b: &Arc<Built<'_>>| Work::new(&b.name, "cycle of samples", count);
            work.extend(self.drive.built.iter().map(of_set));
        }
        work
    }
}

impl Analysis for CycleAnalysisEntry {
    const TYPE: &'static str = "cycle";
    const FORMATS: &'static [Write] = Write::WITH_FIGURES;
    type Plan<'a> = CyclePlan<'a>;
    type Outcome = CycleOutcome;

    fn uses(&self) -> Uses<'_> {
        Uses::driving(&self.drive)
    }

    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<CyclePlan<'a>, Stopped> {
        let path = cx.path();
        let gearbox = cx.gearbox(self.drive.gearbox.as_ref())?;
        let built = cx.built(gearbox, &self.drive.model_sets)?;
        sums_energies(cx, &path, self.by)?;
        let duties = Duties::new(cx, &path, &self.drive.ride, self.drive.gear.as_ref().map(Into::into))?;
        self.check_reference(cx, &path, &duties)?;
        if self.load_classes.is_some() && !self.needs_loads() {
            let help = "delete it, or write `export: [bearing_loads]` or `[rexs_loads]`";
            return Err(cx.wrong(&format!("{path}.load_classes"), "no export has load cases", help));
        }
        let libraries = libraries(cx, &self.fmu_libraries, self.needs_network())?;
        let drive = DrivePlan::new(cx, &path, duties, built)?;
        let (mut limits, mut inputs) = (Vec::new(), Vec::new());
        for b in &drive.built {
            limits.push(limits_of(cx, &path, &Ordered::default(), &drive.duties, b)?);
            if self.needs_network() {
                tables::network(cx, b, &drive.duties)?;
            }
            if self.needs_loads() && b.transmission.supports().is_empty() {
                let message = format!("`{}` has no bearings, so there are no bearing loads", b.name);
                let help = "describe `bearings`, or delete the export";
                return Err(cx.wrong(&format!("{path}.export"), message, help));
            }
            let mut of_set = Input::all(cx, &path, &self.inputs, b)?;
            ModelErrorEntry::add(self.model_error.as_ref(), cx, b, &mut of_set)?;
            inputs.push(of_set);
        }
        Ok(CyclePlan {
            samples: if inputs.iter().all(Vec::is_empty) {
                0
            } else {
                self.samples as usize
            },
            drive,
            limits,
            inputs,
            libraries,
        })
    }

    fn reduce<'a>(&'a self, plan: CyclePlan<'a>, engine: &Engine<'a>) -> Result<CycleOutcome, Stopped> {
        let DrivePlan { built, duties } = &plan.drive;
        let names = together(built.iter().map(|b| &b.transmission), self.by);
        let all_bands = if plan.samples > 0 {
            let inputs = built.iter().zip(&plan.inputs);
            engine.parts(inputs, |(b, inputs)| {
                // Without any input there is no band, not one of no width.
                let of_set = || bands::bands(engine, self, (b, inputs), (duties, &names));
                (!inputs.is_empty()).then(of_set).transpose()
            })?
        } else {
            Vec::new()
        };
        let driven = plan.drive.drive(engine)?;
        let mut cycles = Vec::new();
        for ((b, limits), driven) in built.iter().zip(&plan.limits).zip(&driven) {
            limited_in_cycles(engine, b, limits, duties, driven)?;
            engine.weigh_model_error(&b.name, &energies_of_parts(driven));
            cycles.extend(self.results(engine, b, duties, driven, &names)?);
        }
        range_differences(&mut cycles, duties.list.len());
        let (mut networks, mut loads) = (Vec::new(), Vec::new());
        if driven.iter().flatten().all(|driven| driven.broken.is_none()) {
            for (b, driven) in built.iter().zip(&driven) {
                if self.needs_network() {
                    networks.push(tables::tabulate(engine, b, duties, driven)?);
                }
                if self.needs_loads() {
                    loads.extend(self.loads(b, duties, driven)?);
                }
            }
        }
        let mut all_left = Vec::new();
        for (bands, cycles_of_set) in all_bands.into_iter().zip(cycles.chunks_mut(duties.list.len())) {
            if let Some(bands) = bands {
                bands.add_to(cycles_of_set);
                all_left.extend(bands.left());
            }
        }
        Ok(CycleOutcome {
            head: engine.head(built),
            failures: broken_off(&engine.path(), &cycles)
                .map(|error| engine.study.findings(vec![error]))
                .into_iter()
                .collect(),
            cycles,
            left: all_left,
            networks,
            loads,
            exports: self.export.clone(),
            libraries: plan.libraries,
        })
    }
}

impl CycleAnalysisEntry {
    fn needs_network(&self) -> bool {
        self.export.iter().any(|format| format.is_network())
    }

    fn needs_loads(&self) -> bool {
        self.export.iter().any(|format| !format.is_network())
    }

    /// The results of the cycles with one set.
    fn results(
        &self,
        cx: &Planner<'_>,
        b: &Built<'_>,
        duties: &Duties<'_>,
        driven: &[Driven],
        names: &[String],
    ) -> Result<Vec<DutyOfSet>, Stopped> {
        let t = &b.transmission;
        let shares = Shares::new(t, self.by).under(names);
        let ratings = self.ratings.then(|| b.gearbox.ratings(cx.language, &b.resolved, t));
        let ratings = ratings.transpose()?;
        let mut cycles = Vec::new();
        for (read, driven) in duties.list.iter().zip(driven) {
            let mut duty = results::duty(b, read, driven, &shares, self.reference.get(&read.name));
            duty.consumption = duties.consumption(t, driven);
            duty.gears_used = gears::gears(t, &duties.ride(t, read), driven);
            if let Some(ratings) = &ratings {
                let rated = ratings::over_cycle(t, ratings, &duties.ride(t, read), driven);
                duty.ratings = Some(rated.map_err(|list| b.gearbox.findings(list))?);
            }
            cycles.push(duty);
        }
        Ok(cycles)
    }

    /// The bearing loads of the cycles with one set.
    fn loads(&self, b: &Built<'_>, duties: &Duties<'_>, driven: &[Driven]) -> Result<Vec<BearingLoads>, Stopped> {
        let t = &b.transmission;
        let classes = self.load_classes.unwrap_or(bearings::CLASSES);
        let of_cycle = |(read, driven): (&Read, &Driven)| {
            let loads = bearings::bearing_loads(t, &b.name, (read, &duties.ride(t, read), driven), classes);
            loads.map_err(|list| Stopped::from(b.gearbox.findings(list)))
        };
        duties.list.iter().zip(driven).map(of_cycle).collect()
    }

    /// Rejects reference losses of cycles that the analysis does not have.
    fn check_reference(&self, cx: &Planner<'_>, path: &str, duties: &Duties<'_>) -> Result<(), Stopped> {
        let names: Vec<&str> = duties.list.iter().map(|read| read.name.as_str()).collect();
        let Some(unknown) = self.reference.ids().find(|id| !names.contains(id)) else {
            return Ok(());
        };
        let path = format!("{path}.reference");
        Err(cx.found(vec![dangling(&path, "cycle of this analysis", unknown, &names)]))
    }
}

/// Adds the difference of each range from that of the first set in the same cycle.
fn range_differences(cycles: &mut [DutyOfSet], count: usize) {
    let range = |duty: &DutyOfSet| duty.consumption.and_then(|consumption| consumption.range_km);
    let first: Vec<Option<f64>> = cycles.iter().take(count).map(range).collect();
    for (i, duty) in cycles.iter_mut().enumerate().skip(count) {
        let difference = range(duty).zip(first[i % count]).map(|(here, first)| here - first);
        if let Some(consumption) = &mut duty.consumption {
            consumption.range_difference_km = difference;
        }
    }
}

/// Notes what the limits of the study reach in the cycles of a set; returns the limited values by cycle, in the order of the limits.
pub fn limited_in_cycles(
    engine: &Engine<'_>,
    b: &Built<'_>,
    limits: &[Limit],
    duties: &Duties<'_>,
    driven: &[Driven],
) -> Result<Vec<Vec<Option<f64>>>, Stopped> {
    if limits.is_empty() {
        return Ok(vec![Vec::new(); driven.len()]);
    }
    let t = &b.transmission;
    let mut rated = Vec::new();
    if let Some(ratings) = at_points::ratings(engine.scope(b), limits, b.gearbox, &b.resolved)? {
        for (read, driven) in duties.list.iter().zip(driven) {
            let ratings_over_cycle = ratings::over_cycle(t, &ratings, &duties.ride(t, read), driven);
            rated.push(ratings_over_cycle.map_err(|list| b.gearbox.findings(list))?);
        }
    }
    let whole: Vec<&Driven> = driven.iter().collect();
    engine.note_limits(&b.name, limits, reached(limits, duties, t, &whole, &rated));
    let in_cycle = |(k, driven): (usize, &Driven)| {
        let value = |limit: &Limit| limit.in_cycle(duties, t, (k, driven), &rated).filter(|x| x.is_finite());
        limits.iter().map(value).collect()
    };
    Ok(driven.iter().enumerate().map(in_cycle).collect())
}

/// Why the first cycle that did not reach its end stopped.
fn broken_off(path: &str, cycles: &[DutyOfSet]) -> Option<Diagnostic> {
    let mut broken = cycles.iter().filter_map(|duty| Some((duty, duty.broken.as_ref()?)));
    let (duty, broken) = broken.next()?;
    let message = format!(
        "`{}` could not be simulated beyond {} s: {}",
        duty.cycle, broken.time_s, broken.reason
    );
    let help = "the results up to there are kept; examine the point with `explain`";
    Some(Diagnostic::error(path, message).help(help).code(codes::BROKEN_OFF))
}

impl Outcome for CycleOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        let nodes = self.nodes();
        // Columns of nodes that a set does not have are empty.
        let place = |duty: &DutyOfSet, name: &str| duty.nodes.iter().position(|known| known.node == name);
        let shares = self.cycles.first().map_or(&[][..], |duty| &duty.shares);
        let table = Table::of_each(&self.head.analysis, &self.cycles, |duty| &duty.series)
            .text("model_set", "Model set", |(duty, _)| &duty.model_set)
            .text("cycle", "Duty cycle", |(duty, _)| &duty.cycle)
            .number("time_s", "s", "Time at the start of the interval", |(_, at)| at.time_s)
            .number("duration_s", "s", "Length of the interval", |(_, at)| at.duration_s)
            .number("torque_nm", "Nm", "Torque of the reference port", |(_, at)| {
                at.torque_nm
            })
            .number("speed_rpm", "rpm", "Speed of the reference port", |(_, at)| {
                tidy(at.speed_rpm)
            })
            .number("vehicle_speed_m_s", "m/s", "Speed of the vehicle", |(_, at)| {
                at.vehicle_speed_m_s
            })
            .each(self.inclines().then_some(()), |table, ()| {
                table.number(
                    "inclination_deg",
                    "deg",
                    "Inclination of the oil by grade and acceleration",
                    |(_, at)| at.inclination_deg,
                )
            })
            .each(self.gears_differ().then_some(()), |table, ()| {
                let dissipated = "Energy that the shift at the start of the interval dissipates";
                table
                    .text("gear", "Gear", |(_, at)| &at.gear)
                    .number("shift_j", "J", dissipated, |(_, at)| at.shift_j)
            })
            .text("status", "State of the transmission", |(_, at)| at.status.name())
            .number("input_w", "W", "Input power", |(_, at)| at.input_w)
            .number("output_w", "W", "Output power", |(_, at)| at.output_w)
            .number("loss_w", "W", "Loss of the transmission", |(_, at)| at.loss_w)
            .each(shares.iter().enumerate(), |table, (i, share)| {
                let meaning = format!("Loss of the share {share}");
                table.number(format!("{share}_w"), "W", meaning, |(_, at)| at.losses_w[i])
            })
            .number("motors_w", "W", "Loss of all motors", |(_, at)| at.motors_w)
            .number(
                "brakes_w",
                "W",
                "Power dissipated in the brakes of the vehicle",
                |(_, at)| at.brakes_w,
            )
            .each(&nodes, |table, node| {
                let meaning = format!("Temperature of the node {node} at the end of the interval, calculated");
                table.number(format!("{node}_end_degc"), "degC", meaning, |(duty, at)| {
                    place(duty, node).map(|i| at.temperatures_degc[i])
                })
            })
            .each(&nodes, |table, node| {
                let meaning = format!("Temperature of the node {node} at the end of the interval, measured");
                table.number(format!("{node}_measured_degc"), "degC", meaning, |(duty, at)| {
                    place(duty, node).and_then(|i| at.measured_degc[i])
                })
            });
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.cycles.iter().flat_map(|duty| &duty.notes).collect()
    }

    fn left_at_samples(&self) -> Vec<&(String, String)> {
        self.left.iter().collect()
    }

    fn failures(&self) -> &[Findings] {
        &self.failures
    }
}

impl CycleOutcome {
    /// True if a cycle inclines the oil.
    fn inclines(&self) -> bool {
        self.cycles.iter().any(|duty| duty.inclination_deg.is_some())
    }

    /// True if gears are chosen or change in a cycle.
    fn gears_differ(&self) -> bool {
        self.cycles.iter().any(|duty| duty.gears_used.is_some())
    }

    /// Nodes of all cycles, in the order of the first.
    fn nodes(&self) -> Vec<&str> {
        let all = self.cycles.iter().flat_map(|duty| &duty.nodes);
        distinct(all.map(|node| node.node.as_str()))
    }
}
