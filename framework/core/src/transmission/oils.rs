//! Oils by number, and the oil height at every position.

use std::sync::Arc;

use super::members::Members;
use super::nodes::NodeNames;
use super::seats::{MeshSeat, orbit};
use crate::attach::{Common, Level, Oil, Places, dangling};
use crate::description::{GearboxEntry, Running};
use crate::document::Diagnostic;
use crate::immersion::upward;
use crate::lubricant::Lubricant;
use crate::mechanism::gear_mesh::MeshOil;
use crate::real::Real;
use crate::registry::Memory;
use crate::table::clamped;

/// Oil height of the sump above its datum while rotating.
#[derive(Debug, Clone)]
pub enum Surface {
    /// No oil level is stated.
    Dry,
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
    surface: Surface,
    /// The oil of the housing.
    sump: Option<usize>,
    /// Volume of the oil in the housing, if it is stated. \[m3\]
    volume: Option<f64>,
}

impl Oils {
    /// Oil height above the datum at given speeds. \[m\]
    pub fn surface<R: Real>(&self, speeds: &[R]) -> R {
        match &self.surface {
            Surface::Dry => R::constant(f64::NEG_INFINITY),
            Surface::Fixed(height) => R::constant(*height),
            Surface::Over {
                member,
                speeds: at,
                levels,
            } => speeds[*member].lift(|speed| clamped(at, levels, speed.abs())),
        }
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
        let oil = self.lubricants.get(self.sump.unwrap_or(0));
        oil.map_or((0.0, 0.0), |oil| {
            (oil.density(temperature), oil.heat_capacity(temperature))
        })
    }

    /// Volume of the oil in the housing, if it is stated, and its mass at a temperature in degC. \[m3 and kg\]
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
    surface: Surface,
    /// Level of the sump at standstill, if stated. \[m\]
    at_rest: Option<f64>,
    /// Volume of the sump, if stated. \[m3\]
    volume: Option<f64>,
    /// Axis of each member, and the radius of its orbit.
    axes: Vec<Option<([f64; 2], f64)>>,
    up: [f64; 3],
    datum: [f64; 2],
    nodes: &'a NodeNames,
    pub findings: Vec<Diagnostic>,
}

impl<'a> OilNumbers<'a> {
    pub fn new(
        entry: &'a GearboxEntry,
        members: &Members,
        meshes: &[MeshSeat],
        nodes: &'a NodeNames,
        memory: &mut Memory,
    ) -> Self {
        let mut findings = Vec::new();
        let names: Vec<&str> = entry.lubricants.ids().collect();
        let mut lubricants = lubricants(entry, memory, &mut findings);
        // A planet's axis orbits that of its carrier.
        let axes = (0..members.names.len())
            .map(|m| match members.planets[m] {
                Some(planet) => Some((members.axes[planet.carrier]?, orbit(m, members, meshes)?)),
                None => Some((members.axes[m]?, 0.0)),
            })
            .collect();
        let broken = lubricants.len() < names.len();
        let up = upward(entry.housing.grade, entry.housing.bank);
        let shafts: Vec<&str> = members.names.iter().map(String::as_str).collect();
        let mut datum = [0.0; 2];
        let mut surface = Surface::Dry;
        let mut at_rest = None;
        let mut default = None;
        if let Some(oil) = &entry.housing.oil {
            default = names.iter().position(|n| *n == oil.lubricant);
            if default.is_none() {
                findings.push(dangling("housing.oil.lubricant", "lubricant", &oil.lubricant, &names));
            }
            if let Some(from) = &oil.measured_from {
                match shafts.iter().position(|s| s == from) {
                    Some(member) => datum = members.axes[member].unwrap_or_default(),
                    None => findings.push(dangling("housing.oil.measured_from", "shaft", from, &shafts)),
                }
            }
            let offset = oil.level_offset;
            at_rest = oil.level.map(|level| level + offset);
            surface = match (&oil.running_level, oil.level) {
                (Some(Running::Height(height)), _) => Surface::Fixed(height + offset),
                (Some(Running::Over(over)), _) => {
                    let path = "housing.oil.running_level";
                    let member = shafts.iter().position(|s| *s == over.shaft);
                    if member.is_none() {
                        findings.push(dangling(&format!("{path}.shaft"), "shaft", &over.shaft, &shafts));
                    }
                    if over.speeds.len() != over.levels.len() || over.speeds.windows(2).any(|w| w[1] <= w[0]) {
                        findings.push(
                            Diagnostic::error(
                                path,
                                "the numbers of speeds and levels differ, or speeds do not increase",
                            )
                            .help("state increasing speeds and one level for each"),
                        );
                        Surface::Dry
                    } else {
                        Surface::Over {
                            member: member.unwrap_or(0),
                            speeds: over.speeds.clone(),
                            levels: over.levels.iter().map(|l| l + offset).collect(),
                        }
                    }
                }
                (None, Some(level)) => Surface::Fixed(level + offset),
                (None, None) => Surface::Dry,
            };
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
        Self {
            volume: entry.housing.oil.as_ref().and_then(|oil| oil.volume),
            names,
            lubricants,
            spots: Vec::new(),
            default,
            dangles: default.is_none() && entry.housing.oil.is_some(),
            surface,
            at_rest,
            axes,
            up,
            datum,
            nodes,
            findings,
        }
    }

    /// The highest oil level, at standstill or rotating, above the datum; `None` if none is stated. \[m\]
    pub fn highest(&self) -> Option<f64> {
        let turning = match &self.surface {
            Surface::Dry => return None,
            Surface::Fixed(level) => *level,
            Surface::Over { levels, .. } => levels.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        };
        Some(self.at_rest.map_or(turning, |level| level.max(turning)))
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
                surface: self.surface,
                sump: self.default,
                volume: self.volume,
            },
            self.findings,
        )
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
        if matches!(self.surface, Surface::Dry) {
            return Level::Dry;
        }
        let Some(([y, z], orbit)) = member.and_then(|m| self.axes[m as usize]) else {
            return Level::Dry;
        };
        let height = self.up[0] * at + self.up[1] * (y - self.datum[0]) + self.up[2] * (z - self.datum[1]);
        Level::Sump {
            height,
            slope: 1.0 / self.up[1].hypot(self.up[2]),
            orbit,
        }
    }
}
