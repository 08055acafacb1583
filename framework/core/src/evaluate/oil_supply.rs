//! What the oil network supplies at a solved point, and what is too little.

use super::Solution;
use super::scratch::incline;
use crate::hydraulics::{Element, End, Inputs, Law, Window};
use crate::transmission::raceway;

/// Pressure of the surroundings. \[Pa\]
const ATMOSPHERE: f64 = 1.01325e5;

/// Convention: below this absolute pressure oil releases air and pumps cavitate. \[Pa\]
const LEAST_PRESSURE: f64 = 0.7e5;

/// Convention: a mouth in the sump less than so many diameters below the surface draws air.
const LEAST_DEPTH: f64 = 2.0;

/// Convention: a chamber that holds more than this share of the oil starves the sump.
const LARGE_SHARE: f64 = 0.5;

/// Flow over the largest of the network below which a consumer has none.
const NO_FLOW: f64 = 1e-6;

/// The oil network at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct OilSupply {
    /// False if no pressures were found.
    pub is_solved: bool,
    /// Name and pressure over the air of the housing of each junction. \[Pa\]
    pub junctions: Vec<(String, f64)>,
    /// Flows.
    pub elements: Vec<ElementFlow>,
    /// Chambers.
    pub chambers: Vec<ChamberLevel>,
    /// What is too little or too much.
    pub findings: Vec<SupplyFinding>,
}

/// Flow through one element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementFlow {
    /// Path.
    pub path: String,
    /// Names of its ends.
    pub ends: [String; 2],
    /// Flow of oil without its free air. \[m3/s\]
    pub flow: f64,
    /// Pressure at its end minus that at its beginning. \[Pa\]
    pub rise: f64,
    /// Flow of oil through the relief valve of a pump; `None` without one. \[m3/s\]
    pub relieved: Option<f64>,
    /// Power that the oil takes from its shaft or motor, without friction; `None` for elements that do not rotate. \[W\]
    pub power: Option<f64>,
    /// Components that it supplies.
    pub feeds: Vec<String>,
}

/// Oil in one chamber.
#[derive(Debug, Clone, PartialEq)]
pub struct ChamberLevel {
    /// Name.
    pub name: String,
    /// Flow through it. \[m3/s\]
    pub flow: f64,
    /// Height of the oil over its holes. \[m\]
    pub height: f64,
    /// Oil that it holds. \[m3\]
    pub volume: f64,
}

/// What is too little or too much at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct SupplyFinding {
    /// Path of the element, junction or chamber.
    pub path: String,
    /// With its numbers.
    pub message: String,
    /// How to change it.
    pub help: &'static str,
}

/// The pocket of a bearing at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct PocketLevel<'a> {
    /// Path of the bearing.
    pub bearing: &'a str,
    /// Flow into the pocket. \[m3/s\]
    pub inflow: f64,
    /// Height of the oil above the lowest point of the raceway. \[m\]
    pub height: f64,
    /// What its window takes of the oil that a gear throws; `None` without one.
    pub window: Option<WindowFlow>,
    /// True if oil flows over its edge.
    pub overflows: bool,
    /// Radius of the raceway. \[m\]
    pub raceway: Option<f64>,
}

/// What a window takes at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowFlow {
    /// Flow through it. \[m3/s\]
    pub flow: f64,
    /// Share of the oil that its gear throws.
    pub share: f64,
    /// Heights above the axis of its gear at which the first and the last oil meet the wall; zeros if it flies elsewhere. \[m\]
    pub meets: [f64; 2],
    /// Heights of its edges above that axis. \[m\]
    pub edges: [f64; 2],
}

impl Solution<'_> {
    /// What a window takes at the point.
    fn window(&self, window: &Window) -> Option<WindowFlow> {
        let (t, m) = (self.transmission, &self.scratch.models);
        let c = &m.conditions;
        let (taken, flow) = t.oils.sump.as_ref()?.through(window, (&c.speeds, c.surface), &m.lifted);
        Some(WindowFlow {
            flow,
            share: taken.share,
            meets: taken.meets,
            edges: window.edges,
        })
    }

    /// The oil network at the point; `None` without one.
    pub fn oil_supply(&self) -> Option<OilSupply> {
        let (t, c) = (self.transmission, &self.scratch.models.conditions);
        let (network, work) = (&t.hydraulics, &c.hydraulics);
        if network.elements.is_empty() {
            return None;
        }
        let is_solved = work.supplies.iter().all(|supply| supply.flow.is_finite());
        let at = Inputs {
            speeds: &c.speeds,
            oils: &c.oils,
            surface: c.surface,
            incline: incline(c.travel.as_ref(), c.inclination),
        };
        let levels = network.chambers(work, &at);
        let chambers = network.chambers.iter().zip(levels);
        let name = |end: End, chamber: Option<usize>| match (end, chamber) {
            (End::Node(node), _) => network.junctions[node].clone(),
            (End::Sump, _) => "sump".to_owned(),
            (End::Open, Some(chamber)) => network.chambers[chamber].name.clone(),
            (End::Open, None) => "housing".to_owned(),
        };
        let elements = network.elements.iter().zip(&work.supplies);
        let mut supply = OilSupply {
            is_solved,
            junctions: network
                .junctions
                .iter()
                .cloned()
                .zip(work.pressures.iter().copied())
                .collect(),
            elements: elements
                .map(|(element, supply)| {
                    let [from, to] = element.ends;
                    let speed = element.driver_speed(&c.speeds);
                    let has_valve = matches!(element.law, Law::Pump { relief: Some(_), .. });
                    ElementFlow {
                        path: element.path.clone(),
                        ends: [name(from, None), name(to, element.chamber)],
                        flow: supply.flow,
                        rise: supply.rise,
                        relieved: has_valve.then_some(supply.relieved),
                        power: speed.map(|speed| speed.abs() * supply.torque),
                        feeds: element.feeds.clone(),
                    }
                })
                .collect(),
            chambers: chambers
                .map(|(chamber, [height, flow, volume])| ChamberLevel {
                    name: chamber.name.clone(),
                    flow,
                    height,
                    volume,
                })
                .collect(),
            findings: Vec::new(),
        };
        supply.findings = self.supply_findings(&supply);
        Some(supply)
    }

    /// The pockets of bearings at the point.
    pub fn pockets(&self) -> impl Iterator<Item = PocketLevel<'_>> {
        let (t, work) = (self.transmission, &self.scratch.models.conditions.hydraulics);
        let network = &t.hydraulics;
        let raceway = move |bearing: &str| raceway(&t.parts, &t.components, bearing);
        network
            .pockets
            .iter()
            .zip(&work.pockets)
            .enumerate()
            .map(move |(number, (pocket, height))| PocketLevel {
                bearing: &pocket.path,
                inflow: pocket.inflow(number, work),
                window: pocket.window.as_ref().and_then(|window| self.window(window)),
                height: *height,
                overflows: *height > pocket.edge_height,
                raceway: raceway(&pocket.path),
            })
    }

    fn supply_findings(&self, supply: &OilSupply) -> Vec<SupplyFinding> {
        let (t, c) = (self.transmission, &self.scratch.models.conditions);
        let network = &t.hydraulics;
        let mut found = Vec::new();
        let mut add = |path: String, message: String, help: &'static str| {
            found.push(SupplyFinding { path, message, help });
        };
        if !supply.is_solved {
            add(
                "oil_network".to_owned(),
                "no pressures were found at which the flows balance".to_owned(),
                "check the diameters and lengths of the network for numbers of another unit",
            );
            return found;
        }
        let inlet = |node: usize| {
            let of_pump =
                |element: &&Element| matches!(element.law, Law::Pump { .. }) && element.ends[0] == End::Node(node);
            network.elements.iter().find(of_pump)
        };
        for (node, (name, pressure)) in supply.junctions.iter().enumerate() {
            let absolute = pressure + ATMOSPHERE;
            if absolute >= LEAST_PRESSURE {
                continue;
            }
            let numbers = format!("{:.3} bar absolute, below 0.7 bar", absolute * 1e-5);
            match inlet(node) {
                Some(pump) => add(
                    pump.path.clone(),
                    format!("its inlet would have {numbers}: the oil releases air, and the pump does not fill"),
                    "use a wider or shorter suction pipe, place the pump lower, or limit its speed",
                ),
                None => add(
                    format!("oil_network.junctions.{name}"),
                    format!("`{name}` would have {numbers}: the oil column breaks, and channels do not fill"),
                    "feed it with more oil, or use narrower outlets",
                ),
            }
        }
        let largest = supply
            .elements
            .iter()
            .fold(0.0_f64, |most, element| most.max(element.flow.abs()));
        // At standstill nothing needs oil.
        let rotates = |element: &Element| element.driver_speed(&c.speeds).is_some_and(|speed| speed != 0.0);
        let is_driven = network.elements.iter().any(rotates);
        for (element, flow) in network.elements.iter().zip(&supply.elements) {
            if let (Some(inlet), Law::Pipe(pipe)) = (element.inlet, &element.law) {
                let depth = c.surface - inlet.height(incline(c.travel.as_ref(), c.inclination));
                if depth < LEAST_DEPTH * pipe.diameter {
                    let place = if depth < 0.0 {
                        format!("{:.1} mm above", -1e3 * depth)
                    } else {
                        format!("only {:.1} mm below", 1e3 * depth)
                    };
                    add(
                        element.path.clone(),
                        format!(
                            "its mouth is {place} the oil surface at {:.1} mm; two diameters are {:.1} mm: it draws air",
                            1e3 * c.surface,
                            1e3 * LEAST_DEPTH * pipe.diameter
                        ),
                        "lower the mouth, or fill more oil",
                    );
                }
            }
            let is_consumer = element.ends[1] == End::Open || !element.feeds.is_empty();
            if is_consumer && is_driven && flow.flow <= NO_FLOW * largest {
                add(
                    element.path.clone(),
                    format!("it has no flow: {:.4} l/min", flow.flow * 6e4),
                    "join it to a junction with a pressure above that of the housing",
                );
            }
        }
        let fill = t.oil_fill().map(|(volume, _)| volume);
        for (chamber, level) in network.chambers.iter().zip(&supply.chambers) {
            let path = format!("oil_network.chambers.{}", chamber.name);
            let help = "use a wider drain or a second one";
            let numbers = format!(
                "{:.1} mm ({:.2} l) at {:.2} l/min",
                1e3 * level.height,
                1e3 * level.volume,
                6e4 * level.flow
            );
            if chamber.height.is_some_and(|height| level.height > height) {
                let allowed = chamber.height.unwrap_or_default();
                add(
                    path,
                    format!("the oil stands {numbers}, above the allowed {:.1} mm", 1e3 * allowed),
                    help,
                );
            } else if fill.is_some_and(|fill| level.volume > LARGE_SHARE * fill) {
                let fill = 1e3 * fill.unwrap_or_default();
                add(
                    path,
                    format!("the oil stands {numbers}, more than half of the fill of {fill:.2} l"),
                    help,
                );
            }
        }
        found
    }
}
