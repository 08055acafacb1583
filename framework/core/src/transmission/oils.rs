//! Oils by number, and the oil height at every position.

use std::sync::Arc;

use super::axis::Axis;
use super::inside::Inside;
use super::members::Members;
use super::nodes::NodeNames;
use super::seats::{GearSeat, MeshSeat, orbit};
use super::sump::Sump;
use crate::attach::{Common, Level, Oil, Places, dangling};
use crate::codes;
use crate::description::{GearboxEntry, OilEntry, Running, RunningWord};
use crate::document::Diagnostic;
use crate::hydraulics::Place;
use crate::immersion::upward;
use crate::lubricant::Lubricant;
use crate::mechanism::gear_mesh::MeshOil;
use crate::real::{Points, Real};
use crate::registry::Memory;
use crate::sump::Travel;
use crate::table::clamped;

/// Least rise across an axis.
const UPRIGHT: f64 = 1e-6;

/// Oil height of the sump above its datum at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AtRest {
    /// No oil level is known.
    Dry,
    /// Only a level while rotating is stated, which is used.
    AsRunning,
    /// One height at all temperatures. \[m\]
    Stated(f64),
    /// That of a mass of oil (kg), without a volume (m3) elsewhere, plus an offset (m).
    Filled {
        /// Mass of the oil as filled. \[kg\]
        mass: f64,
        /// Volume in pipes and coolers. \[m3\]
        circuit: f64,
        /// Added to the level. \[m\]
        offset: f64,
    },
}

/// Oil height of the sump above its datum while rotating.
#[derive(Debug, Clone)]
pub enum Surface {
    /// As at rest.
    AtRest,
    /// Estimated from what the gears lift, at a place in the band of the estimates from -1 to 1.
    Estimated(f64),
    /// One height. \[m\]
    Fixed(f64),
    /// Heights over the speed of a member. \[m over rad/s\]
    Over {
        /// Member of the speed.
        member: usize,
        /// Increasing speeds. \[rad/s\]
        speeds: Vec<f64>,
        /// Heights. \[m\]
        levels: Vec<f64>,
    },
}

/// All oils of a transmission and its sump.
pub struct Oils {
    lubricants: Vec<Arc<Lubricant>>,
    /// Lubricant, temperature node and offset of each oil.
    spots: Vec<(usize, usize, f64)>,
    at_rest: AtRest,
    surface: Surface,
    /// What determines levels from volumes; `None` if the oil space is not known.
    pub(crate) sump: Option<Sump>,
    /// The oil of the housing.
    default: Option<usize>,
    /// Volume of the oil in the housing, if it is known. \[m3\]
    volume: Option<f64>,
}

impl Oils {
    /// Oil height above the datum at rest, at given speeds and states of the oils; minus infinity if no level is known. \[m\]
    pub(crate) fn at_rest<R: Points>(&self, speeds: &[R], oils: &[Oil<R>]) -> R {
        let dry = R::constant(f64::NEG_INFINITY);
        match (self.at_rest, &self.sump) {
            (AtRest::Stated(height), _) => R::constant(height),
            (AtRest::AsRunning, _) => self.running(speeds, dry),
            (AtRest::Filled { mass, circuit, offset }, Some(sump)) => {
                sump.level(R::constant(mass) / oils[sump.oil].rho - circuit) + offset
            }
            (AtRest::Filled { .. } | AtRest::Dry, _) => dry,
        }
    }

    /// Oil height above the datum while rotating, from that at rest, if it is not estimated. \[m\]
    pub(crate) fn running<R: Real>(&self, speeds: &[R], rest: R) -> R {
        match &self.surface {
            Surface::AtRest | Surface::Estimated(_) => rest,
            Surface::Fixed(height) => R::constant(*height),
            Surface::Over {
                member,
                speeds: at,
                levels,
            } => speeds[*member].lift(|speed| clamped(at, levels, speed.abs())),
        }
    }

    /// How the housing travels, if cycles incline it.
    pub fn travel(&self) -> Option<&Travel> {
        self.sump.as_ref()?.travel()
    }

    /// How the level while rotating is found.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// How the level at rest is found.
    pub fn rest(&self) -> AtRest {
        self.at_rest
    }

    /// Writes the state of all oils at the temperatures of the nodes, or at one for all nodes. \[degC\]
    pub(crate) fn write_states<R: Real>(&self, temperatures: &[R], oils: &mut [Oil<R>]) {
        /// Least step of the derivatives: 1e-4 of the absolute temperature, because zero in degC has no meaning. \[K\]
        const STEP: f64 = 0.03;
        for ((lubricant, node, offset), oil) in self.spots.iter().zip(oils) {
            let temperature = temperatures.get(*node).unwrap_or(&temperatures[0]);
            let lubricant = &self.lubricants[*lubricant];
            let properties = (*temperature + *offset).lift_all(STEP, |t| lubricant.oil_at(t).properties());
            *oil = Oil::of_properties(properties);
        }
    }

    /// Density and specific heat of the sump at a temperature in degC; those of the first oil without a sump.
    /// \[kg/m3 and J/(kg K)\]
    pub fn heat(&self, temperature: f64) -> (f64, f64) {
        let oil = self.lubricants.get(self.default.unwrap_or(0));
        oil.map_or((0.0, 0.0), |oil| {
            (oil.density(temperature), oil.heat_capacity(temperature))
        })
    }

    /// Volume of the oil in the housing, if it is known, and its mass at a temperature in degC. \[m3 and kg\]
    pub fn fill(&self, temperature: f64) -> Option<(f64, f64)> {
        let (density, _) = self.heat(temperature);
        self.volume.map(|volume| (volume, volume * density))
    }

    /// Number of oils.
    pub fn len(&self) -> usize {
        self.spots.len()
    }

    /// True without oils.
    pub fn is_empty(&self) -> bool {
        self.spots.is_empty()
    }
}

/// Numbers oils while components are placed.
pub(crate) struct OilNumbers<'a> {
    names: Vec<&'a str>,
    lubricants: Vec<Arc<Lubricant>>,
    spots: Vec<(usize, usize, f64)>,
    default: Option<usize>,
    /// True if the housing's oil does not exist, which is reported once.
    dangles: bool,
    at_rest: AtRest,
    surface: Surface,
    /// Level at rest at the oil temperature as described, if known. \[m\]
    rest: Option<f64>,
    pub inside: Option<Inside>,
    /// Volume of the sump, if known. \[m3\]
    volume: Option<f64>,
    /// Share of the inside that it fills, if known. \[-\]
    share: Option<f64>,
    /// What determines levels from volumes, once the drag models are built.
    pub sump: Option<Sump>,
    /// Axis of each member, and the radius of its orbit.
    axes: Vec<Option<(Axis, f64)>>,
    up: [f64; 3],
    /// Where heights count from. \[m\]
    datum: [f64; 3],
    nodes: &'a NodeNames,
    pub findings: Vec<Diagnostic>,
    pub warnings: Vec<Diagnostic>,
}

impl<'a> OilNumbers<'a> {
    pub fn new(
        (entry, document): (&'a GearboxEntry, &serde_json::Value),
        members: &Members,
        (gears, meshes): (&[GearSeat], &[MeshSeat]),
        nodes: &'a NodeNames,
        memory: &mut Memory,
    ) -> Self {
        let mut findings = Vec::new();
        let names: Vec<&str> = entry.lubricants.ids().collect();
        let mut lubricants = lubricants(entry, memory, &mut findings);
        // A planet's axis orbits that of its carrier.
        let axes: Vec<Option<(Axis, f64)>> = (0..members.names.len())
            .map(|m| match members.planets[m] {
                Some(planet) => Some((members.axes[planet.carrier]?, orbit(m, members, meshes)?)),
                None => Some((members.axes[m]?, 0.0)),
            })
            .collect();
        let broken = lubricants.len() < names.len();
        let up = upward(entry.housing.grade, entry.housing.bank);
        let shafts: Vec<&str> = members.names.iter().map(String::as_str).collect();
        let mut datum = [0.0; 3];
        let mut surface = Surface::AtRest;
        let mut default = None;
        if let Some(oil) = &entry.housing.oil {
            default = names.iter().position(|n| *n == oil.lubricant);
            if default.is_none() {
                findings.push(dangling("housing.oil.lubricant", "lubricant", &oil.lubricant, &names));
            }
            if let Some(from) = &oil.measured_from {
                match shafts.iter().position(|s| s == from) {
                    Some(member) => {
                        let axis = members.axes[member].filter(|axis| !axis.is_along_x());
                        let along_x =
                            members.axes[member].map_or([0.0; 3], |axis| [0.0, axis.origin[1], axis.origin[2]]);
                        datum = axis.map_or(along_x, |axis| axis.origin);
                    }
                    None => findings.push(dangling("housing.oil.measured_from", "shaft", from, &shafts)),
                }
            }
            surface = running(oil, &shafts, &mut findings);
        } else if names.len() == 1 {
            default = Some(0);
        }
        if names.is_empty() {
            findings
                .push(Diagnostic::error("lubricants", "lubricants are missing").help(
                    "add one, such as `lubricants: { sump: { viscosity: { kv40: 32 mm2/s, kv100: 6 mm2/s } } }`",
                ));
        }
        if broken {
            lubricants.clear();
        }
        let place = (up, datum);
        let oil = entry.housing.oil.as_ref();
        // An inside without oil is checked, too.
        let asked = oil.is_some() || entry.housing.inside.is_some();
        let inside = asked.then(|| Inside::new((entry, document), members, gears, &axes, place, memory, &mut findings));
        let mut oils = Self {
            names,
            default,
            dangles: default.is_none() && entry.housing.oil.is_some(),
            at_rest: AtRest::Dry,
            surface,
            rest: None,
            inside: inside.flatten(),
            volume: None,
            share: None,
            sump: None,
            lubricants,
            spots: Vec::new(),
            axes,
            up,
            datum,
            nodes,
            findings,
            warnings: Vec::new(),
        };
        if let Some(oil) = oil {
            oils.settle(oil, entry.thermal.oil);
            oils.share = oils.inside.as_ref().zip(oils.rest).map(|(inside, rest)| {
                let space = &inside.space;
                space.volume(rest)[0] / space.inside()
            });
        }
        oils
    }

    /// True if an oil is the lubricant of the housing, at whatever temperature.
    pub fn is_of_sump(&self, oil: u16) -> bool {
        self.spots
            .get(oil as usize)
            .is_some_and(|(lubricant, ..)| Some(*lubricant) == self.default)
    }

    /// True if two oils are the same lubricant, at whatever temperatures.
    pub fn are_alike(&self, first: u16, second: u16) -> bool {
        let of = |oil: u16| self.spots.get(oil as usize).map(|(lubricant, ..)| *lubricant);
        of(first) == of(second)
    }

    /// Finds level at rest and volume from each other, and compares them if both are stated. \[degC\]
    fn settle(&mut self, oil: &OilEntry, temperature: f64) {
        self.volume = oil.volume;
        if oil.dry_sump {
            let stated = [
                ("level", oil.level.is_some()),
                ("running_level", oil.running_level.is_some()),
            ];
            if let Some((key, _)) = stated.iter().find(|(_, stated)| *stated) {
                self.findings.push(
                    Diagnostic::error(format!("housing.oil.{key}"), "a dry sump has no level")
                        .help("remove the level or `dry_sump`"),
                );
            }
            self.surface = Surface::AtRest;
            return;
        }
        let measured = matches!(self.surface, Surface::Fixed(_) | Surface::Over { .. });
        let space = self.inside.as_ref().map(|inside| Arc::clone(&inside.space));
        if let Some(level) = oil.level {
            self.at_rest = AtRest::Stated(level + oil.level_offset);
            self.rest = Some(level + oil.level_offset);
            if let Some(space) = space {
                self.volume = oil.volume.or_else(|| Some(space.volume(level)[0] + oil.circuit_volume));
                self.compare(oil, level);
            }
        } else if let (Some(volume), Some(space), Some(lubricant)) =
            (oil.volume, space, self.default.and_then(|i| self.lubricants.get(i)))
        {
            let mass = volume * lubricant.density(oil.fill_temperature);
            let hot = mass / lubricant.density(temperature) - oil.circuit_volume;
            self.at_rest = AtRest::Filled {
                mass,
                circuit: oil.circuit_volume,
                offset: oil.level_offset,
            };
            self.rest = Some(space.level(hot) + oil.level_offset);
            if hot <= 0.0 || hot > space.full() {
                let basis = self.inside.as_ref().map_or("", Inside::basis);
                let message = format!(
                    "{:.3} l of oil at {temperature} degC have no level: {:.3} l fit {basis}",
                    hot * 1e3,
                    space.full() * 1e3
                );
                self.findings.push(
                    Diagnostic::error("housing.oil.volume", message)
                        .code(codes::OIL_SPACE)
                        .help("correct the volume, state `housing.inside` from the drawing, or state the level"),
                );
            }
        } else if measured {
            self.at_rest = AtRest::AsRunning;
            self.warnings.push(
                Diagnostic::warning("housing.oil.running_level", "the level at rest is not known")
                    .code(codes::OIL_LEVEL)
                    .note("churning laws were measured over the level at rest; the one while rotating is used, which is lower")
                    .help("state `level`, or `volume` with `housing.inside`"),
            );
        }
        if matches!(self.at_rest, AtRest::Dry) {
            self.surface = Surface::AtRest;
        }
    }

    /// Warns if a stated volume is not that of a stated level. \[m\]
    fn compare(&mut self, oil: &OilEntry, level: f64) {
        let (Some(inside), Some(volume)) = (&self.inside, oil.volume) else {
            return;
        };
        let (filled, below) = (volume - oil.circuit_volume, inside.space.volume(level)[0]);
        // A housing is larger than the hull of its gears, and a drawing is exact within some percent.
        let least = if inside.drawn { 0.9 } else { 1.0 / 3.0 };
        if below >= least * filled && below <= 1.1 * filled {
            return;
        }
        let message = format!(
            "below {:.2} mm are {:.3} l {}, and {:.3} l are filled, whose level is {:.2} mm",
            level * 1e3,
            below * 1e3,
            inside.basis(),
            filled * 1e3,
            inside.space.level(filled) * 1e3
        );
        self.warnings.push(
            Diagnostic::warning("housing.oil.level", message)
                .code(codes::OIL_LEVEL)
                .help("correct the level or the volume, state `circuit_volume`, or `housing.inside` from the drawing; the level is used"),
        );
    }

    /// The axis of a member, if it is stationary and along x.
    pub fn stationary_axis_along_x(&self, member: usize) -> Option<Axis> {
        let (axis, orbit) = self.axes[member]?;
        (orbit == 0.0 && axis.is_along_x()).then_some(axis)
    }

    /// The upward direction of the housing as built.
    pub fn up(&self) -> [f64; 3] {
        self.up
    }

    /// A place with a height in the drawing above the datum and x and y in the housing; one of them that is not stated is that of the middle
    /// of the oil space, which is known unless an error says so. \[m\]
    pub fn place(&self, height: f64, [x, y]: [Option<f64>; 2]) -> Place {
        if x.is_none() && y.is_none() {
            return Place { height, at: None };
        }
        let middle = self.inside.as_ref().map_or([0.0; 2], |inside| inside.middle);
        let at = [
            x.map_or(middle[0], |x| x - self.datum[0]),
            y.map_or(middle[1], |y| y - self.datum[1]),
            height,
        ];
        Place {
            height: self.up[0] * at[0] + self.up[1] * at[1] + self.up[2] * at[2],
            at: Some(at),
        }
    }

    /// True if an oil level is known.
    pub fn has_level(&self) -> bool {
        !matches!(self.at_rest, AtRest::Dry)
    }

    /// Level at rest above the datum at the oil temperature as described, if it is known. \[m\]
    pub fn rest(&self) -> Option<f64> {
        self.rest
    }

    /// The highest oil level, at standstill or rotating, above the datum; `None` if none is known. \[m\]
    pub fn highest(&self) -> Option<f64> {
        let turning = match &self.surface {
            Surface::AtRest | Surface::Estimated(_) => None,
            Surface::Fixed(level) => Some(*level),
            Surface::Over { levels, .. } => levels.iter().copied().reduce(f64::max),
        };
        match (self.rest, turning) {
            (Some(rest), Some(turning)) => Some(rest.max(turning)),
            (rest, turning) => rest.or(turning),
        }
    }

    /// A height that the level at rest exceeds at no temperature. \[m\]
    pub fn highest_at_rest(&self) -> f64 {
        /// More than any oil expands from its filling.
        const EXPANDED: f64 = 1.5;
        match (self.at_rest, &self.inside, self.volume) {
            (AtRest::Filled { offset, .. }, Some(inside), Some(volume)) => {
                inside.space.level(EXPANDED * volume) + offset
            }
            _ => self.rest.unwrap_or(f64::NEG_INFINITY),
        }
    }

    /// Volume of the oil, and the share of the inside of the housing that it fills, if they are known. \[m3 and -\]
    pub fn filled(&self) -> [Option<f64>; 2] {
        [self.volume, self.share]
    }

    /// The lubricant of an oil; `None` if a lubricant has a fault that was reported.
    pub fn lubricant(&self, oil: u16) -> Option<MeshOil> {
        let (lubricant, ..) = self.spots.get(oil as usize)?;
        Some(MeshOil {
            id: (*self.names.get(*lubricant)?).to_owned(),
            lubricant: Arc::clone(self.lubricants.get(*lubricant)?),
        })
    }

    /// The lubricants by their names; none if one has a fault that was reported.
    pub fn named(&self) -> impl Iterator<Item = (&str, &Lubricant)> {
        let lubricants = self.lubricants.iter().map(AsRef::as_ref);
        self.names.iter().copied().zip(lubricants)
    }

    /// All lubricants with their names; empty if one has a fault that was reported.
    pub fn lubricants(&self) -> Vec<(String, Arc<Lubricant>)> {
        let lubricants = self.names.iter().zip(&self.lubricants);
        lubricants
            .map(|(name, oil)| ((*name).to_owned(), Arc::clone(oil)))
            .collect()
    }

    pub fn finish(self) -> (Oils, Vec<Diagnostic>) {
        (
            Oils {
                lubricants: self.lubricants,
                spots: self.spots,
                at_rest: self.at_rest,
                surface: self.surface,
                sump: self.sump,
                default: self.default,
                volume: self.volume,
            },
            self.findings,
        )
    }
}

/// How the level while rotating is found, as stated.
fn running(oil: &OilEntry, shafts: &[&str], findings: &mut Vec<Diagnostic>) -> Surface {
    let offset = oil.level_offset;
    match &oil.running_level {
        None => Surface::Estimated(oil.running_band),
        Some(Running::Word(RunningWord::AtRest)) => Surface::AtRest,
        Some(Running::Height(height)) => Surface::Fixed(height + offset),
        Some(Running::Over(over)) => {
            let path = "housing.oil.running_level";
            let member = shafts.iter().position(|s| *s == over.shaft);
            if member.is_none() {
                findings.push(dangling(&format!("{path}.shaft"), "shaft", &over.shaft, shafts));
            }
            if over.speeds.len() != over.levels.len() || over.speeds.windows(2).any(|w| w[1] <= w[0]) {
                findings.push(
                    Diagnostic::error(
                        path,
                        "the numbers of speeds and levels differ, or speeds do not increase",
                    )
                    .help("state increasing speeds and one level for each"),
                );
                return Surface::AtRest;
            }
            Surface::Over {
                member: member.unwrap_or(0),
                speeds: over.speeds.clone(),
                levels: over.levels.iter().map(|l| l + offset).collect(),
            }
        }
    }
}

/// The oils of a gearbox, those with equal entries from the last time.
fn lubricants(entry: &GearboxEntry, memory: &mut Memory, findings: &mut Vec<Diagnostic>) -> Vec<Arc<Lubricant>> {
    let mut lubricants = Vec::new();
    for (id, lubricant) in entry.lubricants.iter() {
        let path = format!("lubricants.{id}");
        if let Some(known) = memory.get::<Arc<Lubricant>>(&path).filter(|_| memory.is_same(&path)) {
            lubricants.push(Arc::clone(known));
            continue;
        }
        match Lubricant::new(lubricant) {
            Ok(lubricant) => {
                let lubricant = Arc::new(lubricant);
                memory.keep(&path, Arc::clone(&lubricant));
                lubricants.push(lubricant);
            }
            Err((key, message, help)) => {
                findings.push(Diagnostic::error(format!("lubricants.{id}.{key}"), message).help(help));
            }
        }
    }
    lubricants
}

impl Places for OilNumbers<'_> {
    fn oil(&mut self, path: &str, common: &Common) -> Option<u16> {
        let lubricant = match &common.lubricant {
            Some(name) => {
                let found = self.names.iter().position(|n| n == name);
                if found.is_none() {
                    self.findings
                        .push(dangling(&format!("{path}.lubricant"), "lubricant", name, &self.names));
                }
                found?
            }
            None => match self.default {
                Some(default) => default,
                None if self.dangles => return None,
                None => {
                    self.findings.push(
                        Diagnostic::error(path, "no oil: the housing states none")
                            .help("add `housing: { oil: { lubricant: ... } }`, or `lubricant:` here"),
                    );
                    return None;
                }
            },
        };
        let spot = (lubricant, self.nodes.of_oil(path), common.temperature_offset);
        let number = self.spots.iter().position(|s| *s == spot).unwrap_or_else(|| {
            self.spots.push(spot);
            self.spots.len() - 1
        });
        Some(number as u16)
    }

    fn level(&self, member: Option<u16>, at: f64) -> Level {
        if !self.has_level() {
            return Level::Dry;
        }
        let Some((axis, orbit)) = member.and_then(|m| self.axes[m as usize]) else {
            return Level::Dry;
        };
        let [x, y, z] = axis.point(at);
        let [x, y, z] = [x - self.datum[0], y - self.datum[1], z - self.datum[2]];
        // How much of a step across the axis is upwards: none if the shaft stands upright, where a disc is in the oil or out of it.
        let across = if axis.is_along_x() {
            self.up[1].hypot(self.up[2])
        } else {
            let [_, first, second] = axis.local(self.up);
            first.hypot(second).max(UPRIGHT)
        };
        Level::Sump {
            height: self.up[0] * x + self.up[1] * y + self.up[2] * z,
            slope: 1.0 / across,
            orbit,
            axis: [[x, y, z], axis.direction()],
        }
    }
}
