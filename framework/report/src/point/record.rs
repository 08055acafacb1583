//! A solved point as a record of the format `gearloss-point/1`.

use gearloss_framework::coefficients::{Changed, changed_from_source};
use gearloss_framework::evaluate::{PartLoss, PowerFlow, Solution};
use gearloss_framework::flow::Status;
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::loads::SupportLoad;
use gearloss_framework::machine::MachineState;
use gearloss_framework::registry::Package;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::{CrossedStage, PartInfo, PlanetShares, Port, Stage, Transmission};
use gearloss_studies::analyses::balance::BalanceOfPoint;
use gearloss_studies::numbers::{RPM, tidy};
use gearloss_studies::pairs::{PreloadRecord, preload_records};
use gearloss_studies::points::{
    Derivatives, Note, PreparedPoint, SelfLocking, SolvedPoint, Sums, UnitPoint, WeakPoint, evidence, sums,
};
use gearloss_studies::ratings::{RatedComponent, rated};
use schemars::JsonSchema;
use serde::Serialize;

use super::multiplied;
use super::network::NetworkRecord;
use super::oil::OilLevelRecord;
use super::oil_network::OilRecord;

const FORMAT: &str = "gearloss-point/1";

/// Output of `gearloss solve --format json`.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = FORMAT)]
pub struct PointRecord {
    /// Kind and version of the format.
    #[schemars(extend("const" = FORMAT))]
    format: &'static str,
    /// Version of the program.
    gearloss: &'static str,
    /// Gear state.
    gear: String,
    /// Whether torque downstream is reduced by upstream losses.
    power_flow: PowerFlow,
    /// Operating state of the transmission.
    status: Status,
    /// Output power over input power, as a fraction; null without input power, or if it has no value. [-]
    efficiency: Option<f64>,
    /// Sum of all losses; null if it has no value. [W]
    loss_w: Option<f64>,
    /// Loss over the speed of the reference port; null if it has no value. [Nm]
    loss_torque_nm: Option<f64>,
    /// Balance of power.
    power: PowerRecord,
    /// The usual sums; null if no flow was found. [W]
    sums_w: Option<Sums>,
    /// Ports.
    ports: Vec<PortRecord>,
    /// All rotating members.
    members: Vec<MemberRecord>,
    /// Derived geometry of every mesh.
    stages: Vec<Stage>,
    /// Geometry of every mesh of gears on axes that cross; absent without such meshes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    crossed_stages: Vec<CrossedStage>,
    /// Loads of all supports.
    supports: Vec<SupportRecord>,
    /// Load sharing of planets that follows from position errors of their pins; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    planets: Vec<PlanetsRecord>,
    /// Preloads of pairs of bearings; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    preloads: Vec<PreloadRecord>,
    /// Components with losses.
    parts: Vec<PartRecord>,
    /// Crates whose mechanisms and models are linked into the program.
    packages: Vec<Package>,
    /// Direction in which no power can flow; null if there is none.
    self_locking: Option<SelfLocking>,
    /// Temperature of the oil; null if no balance was found. [degC]
    oil_temperature_degc: Option<f64>,
    /// Temperature at which the losses were calculated, also if no balance was found. [degC]
    evaluated_at_degc: f64,
    /// Oil levels above the datum; null if no level is known.
    oil_level: Option<OilLevelRecord>,
    /// Balance of losses and heat with its history; null if the temperature is given.
    balance: Option<BalanceOfPoint>,
    /// Steady state of the thermal network; null without a network, and if the temperature is given.
    network: Option<NetworkRecord>,
    /// Flows and pressures of the oil network, and pockets of bearings; absent without them.
    #[serde(skip_serializing_if = "Option::is_none")]
    oil_network: Option<OilRecord>,
    /// Limits and observed quantities noted by the models.
    notes: Vec<Note>,
    /// Ratings of the components: life, safety, film, temperature. No loss depends on them.
    pub ratings: Vec<RatedComponent>,
    /// Evidence grades of everything that is used, the lowest first.
    pub evidence: Vec<WeakPoint>,
    /// Models that no component uses, as text.
    unreached: Vec<String>,
    /// Coefficients of formulas that were changed from their source.
    pub changed_from_source: Vec<Changed>,
    /// Quantities of the drive unit; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<UnitPoint>,
    /// Electric machines; absent without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    machines: Vec<MachineRecord>,
    /// Derivatives over the variables of `--derivative`; absent without that option.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub derivatives: Vec<Derivatives>,
}

/// Balance of power.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Power")]
struct PowerRecord {
    /// Input power; null if it has no value. [W]
    input_w: Option<f64>,
    /// Output power; null if it has no value. [W]
    output_w: Option<f64>,
    /// Sum of all losses; null if it has no value. [W]
    loss_w: Option<f64>,
    /// Input power minus output power minus losses; null if it has no value. [W]
    residual_w: Option<f64>,
    /// Largest internal power; null if no power flow was found. [W]
    largest_internal_power_w: Option<f64>,
    /// Largest internal power over input power; null without input power. [-]
    largest_internal_over_input: Option<f64>,
}

/// A port.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Port")]
struct PortRecord {
    /// Name.
    port: String,
    /// Speed. [rpm]
    speed_rpm: f64,
    /// Torque as applied to the transmission; null without a power flow, and at an output whose ideal power is less than the losses. [Nm]
    torque_nm: Option<f64>,
    /// Power into the transmission; null without a power flow, and at an output whose ideal power is less than the losses. [W]
    power_w: Option<f64>,
}

/// An electric machine.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Machine")]
struct MachineRecord {
    /// Path.
    machine: String,
    /// Speed. [rpm]
    speed_rpm: f64,
    /// Torque as applied to the transmission. [Nm]
    torque_nm: f64,
    /// Power into the transmission. [W]
    shaft_power_w: f64,
    /// Power out of the DC link. [W]
    dc_power_w: f64,
    /// Loss of the machine, with what its map contains. [W]
    loss_w: f64,
    /// Loss of an inverter that is described apart. [W]
    inverter_loss_w: f64,
    /// True if it is outside a map, whose end value is then used.
    outside_map: bool,
    /// What its torque reaches: `continuous`, `peak` or `beyond` the envelope.
    reached: &'static str,
}

impl MachineRecord {
    fn new((path, state): &(String, MachineState)) -> Self {
        Self {
            machine: path.clone(),
            speed_rpm: tidy(state.speed * RPM),
            torque_nm: state.torque,
            shaft_power_w: state.shaft(),
            dc_power_w: state.electric(),
            loss_w: state.machine,
            inverter_loss_w: state.inverter,
            outside_map: state.outside,
            reached: state.reached.name(),
        }
    }
}

/// A rotating member.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Member")]
struct MemberRecord {
    /// Name.
    member: String,
    /// Speed. [rpm]
    speed_rpm: f64,
}

/// Load of a support.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Support")]
struct SupportRecord {
    /// Path.
    support: String,
    /// Radial load; null if no flow was found. [N]
    radial_n: Option<f64>,
    /// Axial load; null if no flow was found. [N]
    axial_n: Option<f64>,
    /// The part of it that induced thrust adds; null outside of pairs of bearings, for a pair with a spring or a preload, and if no flow was
    /// found. [N]
    induced_n: Option<f64>,
    /// Tilting moment; null if no flow was found. [Nm]
    tilting_nm: Option<f64>,
    /// The part of the radial load that turns with a carrier, whose planets carry different loads; the radial load is the root of the mean
    /// square over a turn. Null if no flow was found. [N]
    turning_n: Option<f64>,
    /// Load at the most loaded planet; null for equal load sharing and for other supports.
    most_loaded_planet: Option<LoadRecord>,
    /// Static safety C0/P0 according to ISO 76, at the most loaded planet; null without load or without a known rating. [-]
    static_safety: Option<f64>,
}

/// Load sharing of the planets of a set.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Planets")]
struct PlanetsRecord {
    /// Id of the set.
    set: String,
    /// Load of the most loaded planet over the mean. [-]
    k_gamma: f64,
    /// Load of each planet over the mean. [-]
    shares: Vec<f64>,
    /// Radial displacements of floating members.
    displacements: Vec<DisplacementRecord>,
}

/// Radial displacement of a floating member of a set; of several that float freely each has the one with which it alone would even out the
/// load.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Displacement")]
struct DisplacementRecord {
    /// Name.
    member: String,
    /// Displacement. [um]
    displacement_um: f64,
}

impl From<PlanetShares> for PlanetsRecord {
    fn from(found: PlanetShares) -> Self {
        let k_gamma = found.k_gamma();
        let displacements = found.displacements.into_iter();
        Self {
            set: found.set,
            k_gamma,
            shares: found.shares,
            displacements: displacements
                .map(|(member, displacement)| DisplacementRecord {
                    member,
                    displacement_um: displacement * 1e6,
                })
                .collect(),
        }
    }
}

/// A load.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Load")]
struct LoadRecord {
    /// Radial load. [N]
    radial_n: f64,
    /// Axial load. [N]
    axial_n: f64,
    /// Tilting moment. [Nm]
    tilting_nm: f64,
}

/// A component with losses.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Part")]
struct PartRecord {
    /// Path.
    part: String,
    /// Mechanism.
    mechanism: &'static str,
    /// Model of its loss.
    model: &'static str,
    /// Number of copies. [-]
    count: f64,
    /// Relative speed of its sides. [rpm]
    relative_speed_rpm: f64,
    /// Moment of one copy about the relative speed; at standstill its limit; null if the model has no value. [Nm]
    moment_of_one_nm: Option<f64>,
    /// Loss of all copies; null if the model has no value. [W]
    loss_w: Option<f64>,
    /// Why the model has no value; null if it has one.
    undefined: Option<String>,
    /// Terms of its model.
    terms: Vec<TermRecord>,
}

/// A term of a model.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Term")]
struct TermRecord {
    /// Name.
    term: &'static str,
    /// True if it depends on the load.
    load_dependent: bool,
    /// Loss of all copies; zero if the model has no value, null if no power flow was found. [W]
    loss_w: Option<f64>,
}

impl PointRecord {
    /// A solved point of a gearbox, without derivatives.
    ///
    /// # Errors
    /// That a rating of the gearbox cannot be made.
    pub fn new(
        language: &Language,
        (gearbox, resolved, transmission): (&Gearbox, &Resolved, &Transmission),
        prepared: &PreparedPoint,
        solved: &SolvedPoint<'_>,
    ) -> Result<Self, Findings> {
        let (solution, found) = (&solved.solution, &solved.found);
        let ratings = gearbox.ratings(language, resolved, transmission)?;
        let member = |(i, name): (usize, &String)| MemberRecord {
            member: name.clone(),
            speed_rpm: tidy(solution.speed(i) * RPM),
        };
        let ports = transmission.ports().iter().enumerate();
        let supports = transmission.supports().iter().enumerate();
        let parts = solution.parts();
        Ok(Self {
            format: FORMAT,
            gearloss: env!("CARGO_PKG_VERSION"),
            gear: prepared.gear.clone(),
            power_flow: prepared.flow,
            status: solution.status(),
            efficiency: solution.efficiency(),
            loss_w: solution.loss(),
            loss_torque_nm: solution.loss_torque(),
            power: PowerRecord {
                input_w: solution.input_power(),
                output_w: solution.output_power(),
                loss_w: solution.loss(),
                residual_w: solution.residual(),
                largest_internal_power_w: solution.has_flow().then(|| solution.largest_power()),
                largest_internal_over_input: multiplied(solution),
            },
            sums_w: sums(transmission, solution).map(Sums::from),
            ports: ports.map(|(i, port)| PortRecord::new(solution, i, port)).collect(),
            members: transmission.members().iter().enumerate().map(member).collect(),
            stages: transmission.stages().collect(),
            crossed_stages: transmission.crossed_stages().collect(),
            supports: supports
                .map(|(i, path)| SupportRecord::new(solution, i, path))
                .collect(),
            planets: (solution.planet_shares().into_iter().filter(|_| solution.has_flow()))
                .map(PlanetsRecord::from)
                .collect(),
            preloads: preload_records(transmission, solution),
            parts: parts
                .map(|(part, loss)| PartRecord::new(transmission, solution, part, &loss))
                .collect(),
            packages: language.registry().packages(),
            self_locking: solved.locking.clone(),
            // Without a heat balance there is no oil temperature; the losses are at another one.
            oil_temperature_degc: found.is_sound().then_some(found.oil),
            evaluated_at_degc: found.oil,
            oil_level: solution.oil_levels().map(OilLevelRecord::from),
            balance: found.balance.as_ref().map(|b| BalanceOfPoint::new(transmission, b)),
            network: found.network.as_ref().and_then(|n| NetworkRecord::new(transmission, n)),
            oil_network: OilRecord::new(solution),
            notes: solved.notes.clone(),
            ratings: rated(&ratings, transmission, solution),
            evidence: evidence(transmission, resolved, &|path| gearbox.places.is_written(path)),
            unreached: resolved.unreached.clone(),
            changed_from_source: changed_from_source(transmission, resolved),
            unit: solved.unit(),
            machines: solved.machines.iter().map(MachineRecord::new).collect(),
            derivatives: Vec::new(),
        })
    }
}

impl PortRecord {
    fn new(solution: &Solution<'_>, number: usize, port: &Port) -> Self {
        let (speed, torque) = (solution.speed(port.member), solution.known_torque(number));
        Self {
            port: port.name.clone(),
            speed_rpm: tidy(speed * RPM),
            torque_nm: torque,
            power_w: torque.map(|torque| speed * torque),
        }
    }
}

impl SupportRecord {
    fn new(solution: &Solution<'_>, number: usize, path: &str) -> Self {
        let flow = solution.has_flow();
        let load = Some(solution.load(number)).filter(|_| flow);
        let most = solution.most_loaded(number).filter(|_| flow);
        Self {
            support: path.to_owned(),
            radial_n: load.map(|load| load.radial),
            axial_n: load.map(|load| load.axial),
            induced_n: solution.induced(number, false).filter(|_| flow),
            tilting_nm: load.map(|load| load.tilting),
            turning_n: flow.then(|| solution.turning_load(number)),
            most_loaded_planet: most.map(LoadRecord::from),
            static_safety: solution.static_safety(number),
        }
    }
}

impl From<SupportLoad> for LoadRecord {
    fn from(load: SupportLoad) -> Self {
        Self {
            radial_n: load.radial,
            axial_n: load.axial,
            tilting_nm: load.tilting,
        }
    }
}

impl PartRecord {
    fn new(transmission: &Transmission, solution: &Solution<'_>, part: &PartInfo, loss: &PartLoss) -> Self {
        // Without a power flow losses are null.
        let flow = solution.has_flow();
        let entry = &transmission.instances()[part.notes.instance()].entry;
        let terms = entry.terms.iter().map(|term| TermRecord {
            term: term.name,
            load_dependent: term.load_dependent,
            loss_w: flow.then(|| loss.term_watts(term.index)),
        });
        Self {
            part: part.path.clone(),
            mechanism: part.mechanism,
            model: entry.name,
            count: part.count,
            relative_speed_rpm: tidy(loss.speed * RPM),
            moment_of_one_nm: loss.moment().filter(|_| flow),
            loss_w: (flow && loss.result.is_ok()).then(|| loss.watts()),
            undefined: loss.result.err().filter(|_| flow).map(|reason| reason.to_string()),
            terms: terms.collect(),
        }
    }
}
