//! From the description of the oil network to its numbers, and what is wrong with it.

use serde_json::Value;

use super::oils::OilNumbers;
use super::seats::GearSeat;
use super::{Component, PartInfo, PartKind};
use crate::attach::{Common, Places as _, SeatedPocket, dangling};
use crate::codes;
use crate::description::oil_network::{NozzleEntry, PipeEntry, PumpEntry, RotatingChannelEntry};
use crate::description::{GearboxEntry, HoleEntry, OilNetworkEntry, PocketEntry, WindowEntry};
use crate::document::Diagnostic;
use crate::hydraulics::{Chamber, Channel, Driver, Edge, Element, End, Hydraulics, Law, Pocket, Relief, Room, Window};

const SUMP: &str = "sump";
const HOUSING: &str = "housing";

/// Paths of all elements, in the order of their numbers.
pub(crate) fn element_paths(entry: &GearboxEntry) -> Vec<String> {
    let Some(network) = &entry.oil_network else {
        return Vec::new();
    };
    let pumps = network.pumps.ids().map(|id| format!("oil_network.pumps.{id}"));
    let pipes = network.pipes.ids().map(|id| format!("oil_network.pipes.{id}"));
    let nozzles = network.nozzles.ids().map(|id| format!("oil_network.nozzles.{id}"));
    let rotating = network.rotating_channels.ids();
    let rotating = rotating.map(|id| format!("oil_network.rotating_channels.{id}"));
    pumps.chain(pipes).chain(nozzles).chain(rotating).collect()
}

/// Radius of the lowest point of the raceway of a bearing, by its path. \[m\]
pub(crate) fn raceway(parts: &[PartInfo], components: &[Component], bearing: &str) -> Option<f64> {
    let is_of = |part: &&PartInfo| {
        let rest = part.path.strip_prefix(bearing);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    match parts.iter().find(is_of)?.kind {
        PartKind::Component(component) => components[component].placed.lowest(),
        PartKind::Mesh(_) | PartKind::Drag(_) | PartKind::Transfer(_) => None,
    }
}

/// What the network needs of the transmission while it is built.
pub(super) struct Around<'a> {
    pub entry: &'a GearboxEntry,
    pub document: &'a Value,
    /// Names of shafts and idler gears.
    pub members: &'a [String],
    pub parts: &'a [PartInfo],
    pub components: &'a [Component],
    pub pockets: &'a [SeatedPocket],
    pub gears: &'a [GearSeat],
}

/// Builds the network and the pockets; faults become findings.
pub(super) fn hydraulics(
    around: &Around<'_>,
    oils: &mut OilNumbers<'_>,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Hydraulics {
    let mut built = Hydraulics::default();
    if let Some(network) = &around.entry.oil_network {
        let names = Names {
            network,
            around,
            drained: Vec::new(),
            found,
        };
        names.build(oils, &mut built);
        has_ways(&built, found, warnings);
        warnings.extend(heights_of_a_level_road(around.entry, network));
        shaft_torques(&built, around, found, warnings);
    }
    built.pockets = around
        .pockets
        .iter()
        .filter_map(|pocket| seated_pocket(pocket, &built, (around, oils), found, warnings))
        .collect();
    built
}

/// Looks up the names of a network while it is built.
struct Names<'a, 'f> {
    network: &'a OilNetworkEntry,
    around: &'a Around<'a>,
    /// Names of the chambers, each before those into which it drains.
    drained: Vec<String>,
    found: &'f mut Vec<Diagnostic>,
}

impl Names<'_, '_> {
    fn build(mut self, oils: &mut OilNumbers<'_>, built: &mut Hydraulics) {
        let network = self.network;
        built.air = network.air;
        built.junctions = network.junctions.ids().map(str::to_owned).collect();
        built.up = oils.up();
        let places = network.junctions.iter().map(|(_, junction)| {
            let height = junction.height?;
            Some(oils.place(height, [junction.x, junction.y]))
        });
        built.heights = places.collect();
        self.check_names();
        self.check_places(oils);
        if oils.highest().is_none() {
            let heights = network
                .junctions
                .iter()
                .filter(|(_, junction)| junction.height.is_some());
            let heights = heights.map(|(id, _)| format!("oil_network.junctions.{id}.height"));
            let inlets = network.pipes.iter().filter(|(_, pipe)| pipe.inlet_height.is_some());
            let inlets = inlets.map(|(id, _)| format!("oil_network.pipes.{id}.inlet_height"));
            self.found.extend(heights.chain(inlets).map(|path| {
                Diagnostic::error(path, "a height needs the oil level, which is not stated")
                    .help("add `housing.oil.level`, or remove the height")
            }));
        }
        self.chambers(oils, built);
        let all = network.pumps.iter().filter_map(|(id, pump)| self.pump(id, pump, oils));
        built.elements.extend(all);
        let all = network.pipes.iter().filter_map(|(id, pipe)| self.pipe(id, pipe, oils));
        built.elements.extend(all);
        let all = network
            .nozzles
            .iter()
            .filter_map(|(id, nozzle)| self.nozzle(id, nozzle, oils));
        built.elements.extend(all);
        let rotating = network.rotating_channels.iter();
        let all = rotating.filter_map(|(id, channel)| self.rotating(id, channel, oils));
        built.elements.extend(all);
        self.check_oil(built);
    }

    /// The oil that comes from the sump and returns there is that of the sump.
    fn check_oil(&mut self, built: &Hydraulics) {
        let entry = self.around.entry;
        let (Some(own), Some(sump)) = (&self.network.oil.lubricant, &entry.housing.oil) else {
            return;
        };
        let mut elements = built.elements.iter();
        let has_sump = !built.chambers.is_empty() || elements.any(|element| element.ends.contains(&End::Sump));
        // A lubricant that is not known was reported.
        if has_sump && *own != sump.lubricant && entry.lubricants.get(own).is_some() {
            let message = "the network takes oil from the sump and returns it there, but states another lubricant";
            self.found
                .push(Diagnostic::error("oil_network.lubricant", message).help("remove `lubricant` of the network"));
        }
    }

    /// Names of junctions and chambers that are taken.
    fn check_names(&mut self) {
        let junctions = self.network.junctions.ids().map(|id| ("junctions", id));
        for (section, id) in junctions.chain(self.network.chambers.ids().map(|id| ("chambers", id))) {
            let path = format!("oil_network.{section}.{id}");
            if id == SUMP || id == HOUSING {
                self.found
                    .push(Diagnostic::error(path, format!("`{id}` is reserved")).help("rename it"));
            } else if section == "chambers" && self.network.junctions.get(id).is_some() {
                self.found.push(
                    Diagnostic::error(path, format!("a junction is called `{id}`, too")).help("rename one of them"),
                );
            }
        }
    }

    /// Places of junctions and of mouths: x and y belong to a height, and one of them alone needs an oil space.
    fn check_places(&mut self, oils: &OilNumbers<'_>) {
        // A drawn space that is not known has a fault that was reported.
        let inside = self.around.entry.housing.inside.as_ref();
        let has_middle = oils.inside.is_some() || inside.is_some_and(|inside| !inside.sections.is_empty());
        let junctions = self.network.junctions.iter().map(|(id, own)| {
            let path = format!("oil_network.junctions.{id}");
            (path, ["height", "x", "y"], own.height, [own.x, own.y])
        });
        let pipes = self.network.pipes.iter().map(|(id, own)| {
            let path = format!("oil_network.pipes.{id}");
            let place = [own.inlet_x, own.inlet_y];
            (path, ["inlet_height", "inlet_x", "inlet_y"], own.inlet_height, place)
        });
        for (path, [height_key, x, y], height, place) in junctions.chain(pipes) {
            let error = match (height, place) {
                (None, [None, None]) | (Some(_), [None, None] | [Some(_), Some(_)]) => continue,
                (None, [of_x, _]) => {
                    let stated = if of_x.is_some() { x } else { y };
                    Diagnostic::error(format!("{path}.{stated}"), "a place without a height")
                        .help(format!("add `{height_key}` or delete `{x}` and `{y}`"))
                }
                (Some(_), [of_x, _]) => {
                    let (stated, missing) = if of_x.is_some() { (x, y) } else { (y, x) };
                    if has_middle {
                        continue;
                    }
                    let message = format!("`{missing}` is missing, and no oil space is known whose middle it could be");
                    Diagnostic::error(format!("{path}.{missing}"), message).help(format!(
                        "state `{missing}`, draw the oil space with `housing.inside`, or delete `{stated}`"
                    ))
                }
            };
            self.found.push(error);
        }
    }

    /// Chambers, each before those into which it drains.
    fn chambers(&mut self, oils: &mut OilNumbers<'_>, built: &mut Hydraulics) {
        let chambers = &self.network.chambers;
        let ids: Vec<&str> = chambers.ids().collect();
        let into: Vec<Option<usize>> = chambers
            .iter()
            .map(|(id, chamber)| {
                let into = ids.iter().position(|known| *known == chamber.into);
                if into.is_none() && chamber.into != SUMP {
                    let path = format!("oil_network.chambers.{id}.into");
                    self.found.push(dangling(&path, "chamber", &chamber.into, &ids));
                }
                into
            })
            .collect();
        // Number of chambers on the way to the sump; those with more are first.
        let depth = |start: usize| {
            let mut at = Some(start);
            (0..=ids.len()).find(|_| {
                at = at.and_then(|chamber| into[chamber]);
                at.is_none()
            })
        };
        let depths: Vec<Option<usize>> = (0..ids.len()).map(depth).collect();
        if let Some(ring) = depths.iter().position(Option::is_none) {
            let path = format!("oil_network.chambers.{}.into", ids[ring]);
            self.found.push(
                Diagnostic::error(path, "the chambers drain in a ring, so no oil returns to the sump")
                    .help("have one of them drain into `sump`"),
            );
            return;
        }
        let mut order: Vec<usize> = (0..ids.len()).collect();
        order.sort_by_key(|chamber| std::cmp::Reverse(depths[*chamber]));
        for &i in &order {
            let (id, chamber) = &chambers.0[i];
            self.drained.push(id.clone());
            let oil = self.oil(&format!("oil_network.chambers.{id}"), oils);
            built.chambers.push(Chamber {
                name: id.clone(),
                drain: chamber.drain.orifice(),
                floor: chamber.floor,
                holes: [chamber.drain_x, chamber.drain_y],
                height: chamber.height,
                oil: oil.unwrap_or(0),
                into: into[i].and_then(|into| order.iter().position(|known| *known == into)),
            });
        }
    }

    fn oil(&self, path: &str, oils: &mut OilNumbers<'_>) -> Option<u16> {
        oils.oil(path, &Common::of(&self.network.oil, 1.0))
    }

    /// An end by its name; `None` and reported if it is unknown. The chamber, by its place in the order in which they drain.
    fn end(&mut self, path: &str, name: &str, words: &[&str]) -> Option<(End, Option<String>)> {
        if words.contains(&name) {
            return Some((if name == SUMP { End::Sump } else { End::Open }, None));
        }
        if let Some(node) = self.network.junctions.ids().position(|id| id == name) {
            return Some((End::Node(node), None));
        }
        let may_be_chamber = words.contains(&HOUSING);
        if may_be_chamber && self.network.chambers.get(name).is_some() {
            return Some((End::Open, Some(name.to_owned())));
        }
        let chambers = self.network.chambers.ids().filter(|_| may_be_chamber);
        let ids: Vec<&str> = self
            .network
            .junctions
            .ids()
            .chain(chambers)
            .chain(words.iter().copied())
            .collect();
        self.found.push(dangling(path, "junction", name, &ids));
        None
    }

    /// An element with its names; `law` is found even if they are wrong, so that all faults are reported.
    fn element(
        &mut self,
        path: String,
        (from, from_words): (&str, &[&str]),
        (to, to_words): (&str, &[&str]),
        law: Option<Law>,
        feeds: &[String],
        oils: &mut OilNumbers<'_>,
    ) -> Option<Element> {
        let begin = self.end(&format!("{path}.from"), from, from_words);
        let end = self.end(&format!("{path}.to"), to, to_words);
        if from == to {
            self.found.push(
                Diagnostic::error(path.clone(), "both ends are the same").help("name two junctions, or omit `to`"),
            );
        }
        for fed in feeds {
            let exists = |part: &PartInfo| part.path == *fed || part.path.starts_with(&format!("{fed}."));
            let entry = self.around.entry;
            let is_gear = fed
                .strip_prefix("gears.")
                .is_some_and(|id| entry.gears.get(id).is_some());
            let is_mesh = entry.has_mesh(fed);
            if !is_gear && !is_mesh && !self.around.parts.iter().any(exists) {
                let parts: Vec<&str> = self.around.parts.iter().map(|part| part.path.as_str()).collect();
                self.found
                    .push(dangling(&format!("{path}.feeds"), "component", fed, &parts));
            }
        }
        let oil = self.oil(&path, oils);
        let (begin, (end, chamber)) = (begin?.0, end?);
        let chambers = &self.drained;
        Some(Element {
            ends: [begin, end],
            law: law?,
            oil: oil?,
            feeds: feeds.to_vec(),
            chamber: chamber.and_then(|name| chambers.iter().position(|id| id == &name)),
            inlet: None,
            path,
        })
    }

    fn member(&mut self, path: &str, name: &str) -> Option<usize> {
        let member = self.around.members.iter().position(|known| known == name);
        if member.is_none() {
            let ids: Vec<&str> = self.around.members.iter().map(String::as_str).collect();
            self.found.push(dangling(path, "shaft or idler gear", name, &ids));
        }
        member
    }

    fn pump(&mut self, id: &str, pump: &PumpEntry, oils: &mut OilNumbers<'_>) -> Option<Element> {
        let path = format!("oil_network.pumps.{id}");
        let driver = match (&pump.shaft, pump.speed) {
            (Some(shaft), None) => self.member(&format!("{path}.shaft"), shaft).map(Driver::Member),
            (None, Some(speed)) => Some(Driver::Motor(speed)),
            (shaft, _) => {
                let both = if shaft.is_some() { "two drives" } else { "no drive" };
                self.found.push(
                    Diagnostic::error(path.clone(), format!("the pump has {both}"))
                        .help("state `shaft` for a driven pump, or `speed` for one with its own motor"),
                );
                None
            }
        };
        if pump.relief.is_some_and(|relief| relief.full <= relief.opens) {
            self.found.push(
                Diagnostic::error(
                    format!("{path}.relief"),
                    "the valve is fully open below its opening pressure",
                )
                .help("state `full` above `opens`, such as 1 bar more"),
            );
        }
        let law = driver.map(|driver| Law::Pump {
            driver,
            displacement: pump.displacement / (2.0 * std::f64::consts::PI),
            leakage: pump.leakage,
            regulated: pump.regulated_flow,
            relief: pump.relief.map(|relief| Relief {
                opens: relief.opens,
                conductance: relief.flow / (relief.full - relief.opens),
            }),
        });
        self.element(path, (&pump.from, &[SUMP]), (&pump.to, &[]), law, &[], oils)
    }

    fn pipe(&mut self, id: &str, pipe: &PipeEntry, oils: &mut OilNumbers<'_>) -> Option<Element> {
        let path = format!("oil_network.pipes.{id}");
        if pipe.inlet_height.is_some() && pipe.from != SUMP {
            self.found.push(
                Diagnostic::error(format!("{path}.inlet_height"), "the pipe does not begin in the sump")
                    .help("remove it, or state `from: sump`"),
            );
        }
        let channel = Channel {
            area: pipe
                .area
                .unwrap_or(0.25 * std::f64::consts::PI * pipe.diameter * pipe.diameter),
            diameter: pipe.diameter,
            length: pipe.length,
            roughness: pipe.roughness,
            losses: pipe.losses,
        };
        let law = Some(Law::Pipe(channel));
        let ends = [SUMP, HOUSING];
        let element = self.element(path, (&pipe.from, &[SUMP]), (&pipe.to, &ends), law, &pipe.feeds, oils)?;
        let inlet = pipe.inlet_height;
        Some(Element {
            inlet: inlet.map(|height| oils.place(height, [pipe.inlet_x, pipe.inlet_y])),
            ..element
        })
    }

    fn nozzle(&mut self, id: &str, nozzle: &NozzleEntry, oils: &mut OilNumbers<'_>) -> Option<Element> {
        let path = format!("oil_network.nozzles.{id}");
        let law = Some(Law::Orifice(nozzle.hole.orifice()));
        let ends = [SUMP, HOUSING];
        self.element(
            path,
            (&nozzle.from, &[SUMP]),
            (&nozzle.to, &ends),
            law,
            &nozzle.feeds,
            oils,
        )
    }

    fn rotating(&mut self, id: &str, own: &RotatingChannelEntry, oils: &mut OilNumbers<'_>) -> Option<Element> {
        let path = format!("oil_network.rotating_channels.{id}");
        let member = self.member(&format!("{path}.shaft"), &own.shaft);
        let law = member.map(|member| Law::Rotating {
            channel: Channel {
                roughness: own.roughness,
                ..Channel::round(own.diameter, own.length, own.losses)
            },
            count: f64::from(own.count),
            member,
            radii: [own.inner_radius, own.outer_radius],
            swirl: own.swirl,
        });
        self.element(path, (&own.from, &[]), (&own.to, &[HOUSING]), law, &own.feeds, oils)
    }
}

/// Checks that oil can leave every junction, and that something drives it.
fn has_ways(network: &Hydraulics, found: &mut Vec<Diagnostic>, warnings: &mut Vec<Diagnostic>) {
    let count = network.junctions.len();
    // Junctions from which a flow that resists leads to the air.
    let spread = |starts: &dyn Fn(&Element) -> bool, passes: &dyn Fn(&Element) -> bool| {
        let mut reached = vec![false; count];
        loop {
            let before = reached.iter().filter(|own| **own).count();
            for element in &network.elements {
                let nodes = element.ends.map(|end| match end {
                    End::Node(node) => Some(node),
                    End::Sump | End::Open => None,
                });
                let known = |node: Option<usize>| node.is_some_and(|node| reached[node]);
                let is_source = starts(element) || (passes(element) && (known(nodes[0]) || known(nodes[1])));
                for node in nodes.into_iter().flatten().filter(|_| is_source) {
                    reached[node] = true;
                }
            }
            if reached.iter().filter(|own| **own).count() == before {
                return reached;
            }
        }
    };
    let resists = |element: &Element| !matches!(element.law, Law::Pump { .. });
    let ends_in_air =
        |element: &Element| resists(element) && element.ends.iter().any(|end| !matches!(end, End::Node(_)));
    let open = spread(&ends_in_air, &resists);
    for (name, _) in network.junctions.iter().zip(&open).filter(|(_, open)| !**open) {
        found.push(
            Diagnostic::error(
                format!("oil_network.junctions.{name}"),
                format!("`{name}` is cut off: no pipe, nozzle or channel leads from it to the sump or the housing"),
            )
            .help("add a pipe or nozzle, such as `nozzles: { J1: { from: ... , diameter: 1 mm } }`, or remove the junction"),
        );
    }
    let drives = |element: &Element| matches!(element.law, Law::Pump { .. } | Law::Rotating { .. });
    let driven = spread(&drives, &resists);
    let still: Vec<&str> = network
        .junctions
        .iter()
        .zip(open.iter().zip(&driven))
        .filter(|(_, (open, driven))| **open && !**driven)
        .map(|(name, _)| name.as_str())
        .collect();
    if !still.is_empty() {
        warnings.push(
            Diagnostic::warning(
                "oil_network",
                format!("no pump or rotating channel drives the oil at {}", still.join(", ")),
            )
            .help("add a pump, or join them to a junction with one"),
        );
    }
}

/// Heights that stay while the housing is inclined, because their places along and across the shafts are not stated.
fn heights_of_a_level_road(entry: &GearboxEntry, network: &OilNetworkEntry) -> Vec<Diagnostic> {
    let housing = &entry.housing;
    if housing.grade == 0.0 && housing.bank == 0.0 && housing.travel.is_none() {
        return Vec::new();
    }
    let is_open = |height: Option<f64>, place: [Option<f64>; 2]| height.is_some() && place == [None; 2];
    let junctions = network.junctions.iter();
    let junctions = junctions.filter(|(_, own)| is_open(own.height, [own.x, own.y]));
    let junctions = junctions.map(|(id, _)| {
        let path = format!("oil_network.junctions.{id}.height");
        (path, "state `x` and `y` of the junction, as in the drawing")
    });
    let pipes = network.pipes.iter();
    let pipes = pipes.filter(|(_, own)| is_open(own.inlet_height, [own.inlet_x, own.inlet_y]));
    let pipes = pipes.map(|(id, _)| {
        let path = format!("oil_network.pipes.{id}.inlet_height");
        (path, "state `inlet_x` and `inlet_y` of the pipe, as in the drawing")
    });
    let warning = |(path, help): (String, &str)| {
        Diagnostic::warning(path, "the housing is inclined, and this height is taken as it is")
            .code(codes::LEVEL_HEIGHT)
            .help(help)
    };
    junctions.chain(pipes).map(warning).collect()
}

/// Checks that an auxiliary on the right shaft computes the torque of each driven pump and of each rotating channel, once.
fn shaft_torques(
    network: &Hydraulics,
    around: &Around<'_>,
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) {
    let paths = |component: usize| {
        let kind = PartKind::Component(component);
        around
            .parts
            .iter()
            .find(|part| part.kind == kind)
            .map_or("", |part| part.path.as_str())
    };
    for (number, element) in network.elements.iter().enumerate() {
        let (member, what, key) = match &element.law {
            Law::Pump {
                driver: Driver::Member(member),
                ..
            } => (Some(*member), "pump", "pump"),
            Law::Pump { .. } => (None, "pump", "pump"),
            Law::Rotating { member, .. } => (Some(*member), "rotating channel", "channel"),
            Law::Pipe(_) | Law::Orifice(_) => continue,
        };
        let id = element.path.rsplit('.').next().unwrap_or_default();
        let users: Vec<usize> = (0..around.components.len())
            .filter(|i| around.components[*i].placed.supply() == Some(number as u16))
            .collect();
        for user in &users {
            let Some(member) = member else {
                found.push(
                    Diagnostic::error(
                        format!("{}.model", paths(*user)),
                        format!("the pump `{id}` has its own motor, so no shaft drives it"),
                    )
                    .help("remove this auxiliary, or state the `shaft` of the pump instead of its `speed`"),
                );
                continue;
            };
            if around.components[*user].between[0] != Some(member as u16) {
                found.push(
                    Diagnostic::error(
                        format!("{}.shaft", paths(*user)),
                        format!("the {what} `{id}` is on `{}`", around.members[member]),
                    )
                    .help(format!("write `shaft: {}`", around.members[member])),
                );
            }
        }
        if let [first, second, ..] = users[..] {
            found.push(
                Diagnostic::error(
                    format!("{}.model", paths(second)),
                    format!("`{}` already computes the torque of the {what} `{id}`", paths(first)),
                )
                .help("remove one of them"),
            );
        }
        if let (Some(member), true) = (member, users.is_empty()) {
            let shaft = &around.members[member];
            let example = if key == "pump" {
                format!("{{ type: pump, pump: {id}, efficiency: 0.85 }}")
            } else {
                format!("{{ type: rotating_channel, channel: {id} }}")
            };
            warnings.push(
                Diagnostic::warning(
                    element.path.clone(),
                    format!("the power that the {what} `{id}` takes from `{shaft}` is no loss of any component"),
                )
                .help(format!(
                    "add `auxiliaries: {{ {id}: {{ shaft: {shaft}, model: {example} }} }}`"
                )),
            );
        }
    }
}

/// A pocket with its edge and its inflow.
fn seated_pocket(
    pocket: &SeatedPocket,
    network: &Hydraulics,
    (around, oils): (&Around<'_>, &OilNumbers<'_>),
    found: &mut Vec<Diagnostic>,
    warnings: &mut Vec<Diagnostic>,
) -> Option<Pocket> {
    let PocketEntry {
        edge,
        drain,
        rib,
        window,
        length,
        ..
    } = pocket.entry.clone();
    let path = format!("{}.pocket", pocket.path);
    let id = pocket.path.strip_prefix("bearings.").unwrap_or_default();
    if around.document["bearings"][id]["oil_height"].is_number() {
        found.push(
            Diagnostic::error(path.clone(), "`oil_height` already states the oil height")
                .help("remove `oil_height` or `pocket`"),
        );
    }
    let edge_of = overflow_edge(&pocket.entry, &path, found)?;
    let feeds: Vec<(usize, f64)> = network.feeding(&pocket.path).collect();
    let caught = rib.filter(|rib| rib.wetting.is_none());
    let inflow = rib.map_or(0.0, |rib| rib.wetting.unwrap_or(0.0) * rib.rib().share(f64::INFINITY));
    if rib.is_some_and(|rib| rib.wetting.is_some() && rib.walls.is_none()) {
        found.push(
            Diagnostic::error(
                format!("{path}.catch"),
                "`wetting` is stated, but not on what length of wall",
            )
            .help("state `walls`, or remove `wetting` to have both from the oil space"),
        );
    }
    let of_sump = oils.is_of_sump(pocket.oil);
    for (key, is_stated) in [("catch", rib.is_some()), ("window", window.is_some())] {
        if is_stated && !of_sump {
            found.push(
                Diagnostic::error(
                    format!("{path}.{key}"),
                    "gears throw the oil of the housing into the pocket, but the bearing has another lubricant",
                )
                .help(format!("remove `lubricant` of the bearing, or `{key}`")),
            );
        }
    }
    for (element, _) in &feeds {
        let element = &network.elements[*element];
        if !oils.are_alike(element.oil, pocket.oil) {
            let message =
                "`feeds` brings the oil of the network into the pocket, but the bearing has another lubricant";
            found.push(
                Diagnostic::error(format!("{}.feeds", element.path), message).help(format!(
                    "remove `lubricant` of the bearing, or `{}` from `feeds`",
                    pocket.path
                )),
            );
        }
    }
    let path_of_window = format!("{path}.window");
    let window = window.map(|window| seated_window(&window, &path_of_window, around, oils));
    let window = window.transpose().map_err(|error| found.push(error)).ok().flatten();
    if feeds.is_empty() && inflow == 0.0 && caught.is_none() && pocket.entry.window.is_none() {
        warnings.push(
            Diagnostic::warning(path, "no oil flows into the pocket, so it stays empty").help(format!(
                "add `feeds: [{}]` to a nozzle or pipe, or `catch` or `window` to the pocket",
                pocket.path
            )),
        );
    }
    let room = length.and_then(|length| {
        room_of(pocket, length, around)
            .map_err(|fault| found.extend(fault))
            .ok()
    });
    Some(Pocket {
        path: pocket.path.clone(),
        edge: edge_of,
        edge_height: edge,
        drain: drain.as_ref().map(HoleEntry::orifice),
        feeds,
        inflow,
        rib: caught.map(|rib| rib.rib()),
        window,
        room,
        oil: pocket.oil,
        of_sump,
    })
}

/// What the oil of a pocket flows over.
fn overflow_edge(entry: &PocketEntry, path: &str, found: &mut Vec<Diagnostic>) -> Option<Edge> {
    let &PocketEntry {
        edge_radius,
        edge_width,
        edge_length,
        edge_sharp,
        ..
    } = entry;
    let edge = match (edge_radius, edge_width) {
        (Some(radius), None) => Edge::Circle { radius },
        (None, Some(width)) if edge_sharp => Edge::Sharp { width, discharge: 0.62 },
        (None, Some(width)) => Edge::Sill {
            width,
            length: edge_length,
        },
        (radius, _) => {
            let both = if radius.is_some() { "two shapes" } else { "no shape" };
            found.push(
                Diagnostic::error(path.to_owned(), format!("the edge of the pocket has {both}")).help(
                    "state `edge_radius` for the bore of a cage, shoulder or seal, or `edge_width` for a straight slot",
                ),
            );
            return None;
        }
    };
    if edge_length > 0.0 && (edge_radius.is_some() || edge_sharp) {
        found.push(
            Diagnostic::error(
                format!("{path}.edge_length"),
                "only a straight edge that is not sharp has a length",
            )
            .help("remove it, or state only `edge_width`"),
        );
    }
    if edge_sharp && edge_radius.is_some() {
        found.push(
            Diagnostic::error(
                format!("{path}.edge_sharp"),
                "the law of a circular edge has no sharp form",
            )
            .help("remove it, or state `edge_width` instead of `edge_radius`"),
        );
    }
    Some(edge)
}

/// The room for oil between the rings of the bearing of a pocket with a length; no fault where another one was reported.
fn room_of(pocket: &SeatedPocket, length: f64, around: &Around<'_>) -> Result<Room, Option<Diagnostic>> {
    let id = pocket.path.strip_prefix("bearings.").unwrap_or_default();
    let bearing = &around.document["bearings"][id];
    let wrong = |message: &str, help: &str| {
        let fault = Diagnostic::error(format!("{}.pocket.length", pocket.path), message);
        Err(Some(fault.code(codes::OIL_NETWORK).help(help)))
    };
    match (
        raceway(around.parts, around.components, &pocket.path),
        bearing["bore"].as_f64(),
    ) {
        (Some(outer), Some(bore)) => Ok(Room {
            length,
            radii: [outer, 0.5 * bore],
        }),
        (Some(_), None) => wrong(
            "the oil in the pocket needs `bore` of the bearing, which is missing",
            "state `bore`, or remove `length`",
        ),
        (None, _) if bearing["lubrication"] == "grease" => wrong(
            "the bearing has `lubrication: grease`, so no oil stands in its pocket",
            "remove `length`, or state another `lubrication`",
        ),
        // A stated `oil_height`, or a bearing with a fault.
        (None, _) => Err(None),
    }
}

/// A window beside the gear that throws oil through it; its path.
fn seated_window(
    entry: &WindowEntry,
    path: &str,
    around: &Around<'_>,
    oils: &OilNumbers<'_>,
) -> Result<Window, Diagnostic> {
    let wrong = |message: String, help: &str| Diagnostic::error(path, message).code(codes::WINDOW).help(help);
    let ids: Vec<&str> = around.gears.iter().map(|gear| gear.id.as_str()).collect();
    let Some(number) = ids.iter().position(|id| *id == entry.gear) else {
        return Err(dangling(&format!("{path}.gear"), "gear", &entry.gear, &ids));
    };
    let gear = &around.gears[number];
    if entry.bottom >= entry.top || entry.from >= entry.to {
        return Err(wrong(
            "the window has no height or no length".to_owned(),
            "state `bottom` below `top` and `from` before `to`",
        ));
    }
    let Some(axis) = oils.stationary_axis_along_x(gear.member) else {
        return Err(wrong(
            format!("`{}` has no stationary axis along x", gear.id),
            "name another gear; for this one no law is known",
        ));
    };
    let Some(lift) = oils.sump.as_ref().and_then(|sump| sump.lift_of(number)) else {
        return Err(wrong(
            format!(
                "how much oil `{}` lifts is not known: it has no churning law in a known oil space",
                gear.id
            ),
            "state an oil level with `housing.inside` and a churning law in `models.gear_drag`, or name another gear",
        ));
    };
    let [x, y, z] = axis.point(gear.at);
    let [_, tip, root] = gear.diameters;
    let window = Window {
        lift,
        member: gear.member,
        wall: entry.y - y,
        edges: [entry.bottom - z, entry.top - z],
        ends: [entry.from - x, entry.to - x],
        gear: [0.5 * tip, 0.5 * (tip - root), gear.facewidth],
    };
    if window.wall.abs() <= 0.5 * tip {
        return Err(wrong(
            format!(
                "the wall is {:.1} mm from the axis of `{}`, whose tip circle has a radius of {:.1} mm",
                1e3 * window.wall.abs(),
                gear.id,
                500.0 * tip
            ),
            "state the y of a wall beside the gear",
        ));
    }
    Ok(window)
}
