//! Members: shafts and idler gears, including the planets.

use super::axis::Axis;
use crate::attach::dangling;
use crate::codes;
use crate::description::{GearboxEntry, Mounting};
use crate::document::Diagnostic;

/// Maximum number of members: their numbers have 16 bits.
const MOST_MEMBERS: usize = u16::MAX as usize;

/// A planet body on its carrier.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnCarrier {
    pub carrier: usize,
    pub count: f64,
    /// True if the planets of its set carry different loads.
    pub uneven: bool,
}

/// All members by name.
pub struct Members {
    /// Shafts in the order of the document, then idler gears.
    pub names: Vec<String>,
    /// Axis of each member, if it has one.
    pub axes: Vec<Option<Axis>>,
    /// The axis of each member, of a planet body that of its carrier: the frame of its loads.
    pub frames: Vec<Axis>,
    /// Set for planet bodies.
    pub planets: Vec<Option<OnCarrier>>,
    /// True for idler gears.
    pub loose: Vec<bool>,
    /// Member of each gear, if its shaft exists.
    pub of_gear: Vec<Option<usize>>,
}

impl Members {
    pub fn new(entry: &GearboxEntry, found: &mut Vec<Diagnostic>) -> Self {
        let mut names: Vec<String> = entry.shafts.ids().map(str::to_owned).collect();
        let mut axes = axes_of_shafts(entry, found);
        let shafts = names.clone();
        let ids: Vec<&str> = shafts.iter().map(String::as_str).collect();
        let mut of_gear = Vec::new();
        let mut loose = vec![false; names.len()];
        for (id, gear) in entry.gears.iter() {
            let shaft = shafts.iter().position(|s| *s == gear.shaft);
            if shaft.is_none() {
                found.push(dangling(&format!("gears.{id}.shaft"), "shaft", &gear.shaft, &ids));
            }
            if gear.mounted == Mounting::Loose {
                if shafts.iter().any(|s| s == id) {
                    found.push(
                        Diagnostic::error(format!("gears.{id}"), format!("`{id}` is a shaft and an idler gear"))
                            .help("rename one of them: they are separate members"),
                    );
                }
                of_gear.push(Some(names.len()));
                names.push(id.to_owned());
                axes.push(shaft.and_then(|s| axes[s]));
                loose.push(true);
            } else {
                of_gear.push(shaft);
            }
        }
        if names.len() > MOST_MEMBERS {
            let message = format!(
                "{} shafts and idler gears; at most {MOST_MEMBERS} are possible",
                names.len()
            );
            found.push(Diagnostic::error("shafts", message).help("describe the train in several files"));
        }
        let mut planets = vec![None; names.len()];
        for (id, set) in entry.planetary_sets.iter() {
            let path = format!("planetary_sets.{id}");
            let Some(carrier) = shafts.iter().position(|s| *s == set.carrier) else {
                found.push(dangling(&format!("{path}.carrier"), "shaft", &set.carrier, &ids));
                continue;
            };
            for planet in &set.planets {
                match shafts.iter().position(|s| s == planet) {
                    None => found.push(dangling(&format!("{path}.planets"), "shaft", planet, &ids)),
                    Some(body) if body == carrier || planets[body].is_some() => found.push(
                        Diagnostic::error(
                            format!("{path}.planets"),
                            format!("`{planet}` is the carrier, or already a planet"),
                        )
                        .help("list each planet body once"),
                    ),
                    Some(body) => {
                        planets[body] = Some(OnCarrier {
                            carrier,
                            count: f64::from(set.count),
                            uneven: false,
                        });
                    }
                }
            }
        }
        for (i, (name, shaft)) in entry.shafts.iter().enumerate() {
            if shaft.axis.is_none() && planets[i].is_none() {
                found.push(
                    Diagnostic::error(format!("shafts.{name}"), "`axis` is missing")
                        .help("add `axis: [y, z]`; only a planet body has none, because its axis moves"),
                );
            }
        }
        let frame = |m: usize| axes[planets[m].map_or(m, |planet: OnCarrier| planet.carrier)];
        let frames = (0..names.len()).map(|m| frame(m).unwrap_or(Axis::along_x([0.0; 2])));
        let frames = frames.collect();
        Self {
            names,
            axes,
            frames,
            planets,
            loose,
            of_gear,
        }
    }
}

/// The axes of the shafts; reports those without a direction.
fn axes_of_shafts(entry: &GearboxEntry, found: &mut Vec<Diagnostic>) -> Vec<Option<Axis>> {
    let mut axes = Vec::with_capacity(entry.shafts.0.len());
    for (name, shaft) in entry.shafts.iter() {
        let axis = shaft.axis.as_ref().map(Axis::new);
        if axis == Some(None) {
            found.push(
                Diagnostic::error(format!("shafts.{name}.axis.direction"), "the direction has no length")
                    .code(codes::AXES)
                    .help("state the direction of the axis, such as `[0, 1, 0]` along y"),
            );
        }
        axes.push(axis.flatten());
    }
    axes
}
