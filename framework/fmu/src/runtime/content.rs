//! The content of an FMU as bytes: little-endian, with its length checked everywhere, since the file may have been changed.
//!
//! `GEARLOSS`, version, kind, then the fields of [`Map`] or [`Network`] in their order. Texts and lists begin with their length.

use alloc::string::String;
use alloc::vec::Vec;

use super::map::{GearOfMap, Map, OfMap, OilOfMap};
use super::network::{Conductance, Exchanger, Flow, GearOfNetwork, Link, Network, Node, Source};
use super::table::{Axis, Table};

/// First bytes of a content.
const MAGIC: &[u8; 8] = b"GEARLOSS";
/// Version of the layout.
const VERSION: u32 = 1;
/// Maximum number of elements of any list.
const MOST: u32 = 1 << 28;

/// What an FMU computes.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Losses of a map.
    Map(Map),
    /// Temperatures of a thermal network.
    Network(Network),
}

impl Content {
    /// The bytes.
    pub fn encode(&self) -> Vec<u8> {
        let mut to = Writer(MAGIC.to_vec());
        to.number(VERSION);
        match self {
            Self::Map(map) => {
                to.number(match map.of {
                    OfMap::Gearbox => 0,
                    OfMap::Unit => 2,
                    OfMap::Machines => 3,
                });
                to.map(map);
            }
            Self::Network(network) => {
                to.number(1);
                to.network(network);
            }
        }
        to.0
    }

    /// Reads the bytes; `None` if they are no content of this version.
    pub fn decode(bytes: &[u8]) -> Option<Self> {
        let mut from = Reader(bytes.strip_prefix(MAGIC)?);
        if from.number()? != VERSION {
            return None;
        }
        let content = match from.number()? {
            0 => Self::Map(from.map(OfMap::Gearbox)?),
            2 => Self::Map(from.map(OfMap::Unit)?),
            3 => Self::Map(from.map(OfMap::Machines)?),
            1 => Self::Network(from.network()?),
            _ => return None,
        };
        let is_sound = match &content {
            Self::Map(map) => map.is_sound(),
            Self::Network(network) => network.is_sound(),
        };
        (from.0.is_empty() && is_sound).then_some(content)
    }
}

/// Identifies a content: two FNV-1a hashes of it, as 32 hexadecimal digits.
pub fn token(bytes: &[u8]) -> [u8; 32] {
    let hash = |start: u64| {
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        bytes.iter().fold(start, step)
    };
    let both = [hash(0xcbf2_9ce4_8422_2325), hash(0x6c62_272e_07bb_0142)];
    let mut digits = [b'0'; 32];
    for (i, digit) in digits.iter_mut().enumerate() {
        let four = (both[i / 16] >> (60 - 4 * (i % 16))) as u8 & 15;
        *digit = if four < 10 { b'0' + four } else { b'a' + four - 10 };
    }
    digits
}

struct Writer(Vec<u8>);

impl Writer {
    fn number(&mut self, x: u32) {
        self.0.extend(x.to_le_bytes());
    }

    fn real(&mut self, x: f64) {
        self.0.extend(x.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.number(text.len() as u32);
        self.0.extend(text.as_bytes());
    }

    /// A number that may be absent.
    fn option(&mut self, x: Option<f64>) {
        self.number(u32::from(x.is_some()));
        self.real(x.unwrap_or(0.0));
    }

    fn list<T>(&mut self, list: &[T], mut each: impl FnMut(&mut Self, &T)) {
        self.number(list.len() as u32);
        for element in list {
            each(self, element);
        }
    }

    fn table(&mut self, table: &Table) {
        self.list(&table.axes, |to, axis| {
            to.number(axis.quantity);
            to.list(&axis.points, |to, x| to.real(*x));
        });
        self.number(table.channels as u32);
        // Short numbers where they lose nothing.
        let is_short = table.values.iter().all(|x| f64::from(*x as f32) == *x);
        self.number(u32::from(is_short));
        self.list(&table.values, |to, x| {
            if is_short {
                to.0.extend((*x as f32).to_le_bytes());
            } else {
                to.real(*x);
            }
        });
    }

    fn map(&mut self, map: &Map) {
        match map.oil {
            OilOfMap::Given => self.number(0),
            OilOfMap::Balance => self.number(1),
            OilOfMap::Fixed => self.number(2),
        }
        self.list(&map.gears, |to, gear| {
            to.text(&gear.name);
            to.option(gear.ratio);
            to.table(&gear.table);
        });
        self.list(&map.starts, |to, x| to.real(*x));
    }

    fn network(&mut self, network: &Network) {
        self.list(&network.nodes, |to, node| {
            to.text(&node.name);
            to.real(node.capacity);
            to.option(node.held);
            to.real(node.start);
        });
        self.number(network.oil);
        self.real(network.step);
        self.option(network.pumped);
        self.table(&network.oil_properties);
        self.list(&network.exchangers, |to, exchanger| {
            to.text(&exchanger.name);
            to.number(exchanger.from);
            to.number(exchanger.to);
            to.flow(exchanger.oil);
            to.real(exchanger.ua);
            to.number(exchanger.arrangement);
            to.real(exchanger.coolant_heat_capacity);
            to.real(exchanger.coolant_flow);
            to.real(exchanger.coolant_temperature);
        });
        self.list(&network.flows, |to, (from, end, flow)| {
            to.number(*from);
            to.number(*end);
            to.flow(*flow);
        });
        self.list(&network.sources, |to, (node, heat)| {
            to.number(*node);
            to.real(*heat);
        });
        self.list(&network.gears, |to, gear| {
            to.text(&gear.name);
            to.option(gear.ratio);
            to.list(&gear.losses, Self::source);
            to.list(&gear.motors, Self::source);
            to.list(&gear.links, |to, link| {
                to.number(link.between[0]);
                to.number(link.between[1]);
                match &link.conductance {
                    Conductance::Given(given) => {
                        to.number(0);
                        to.real(*given);
                    }
                    Conductance::Table(table) => {
                        to.number(1);
                        to.table(table);
                    }
                }
            });
        });
        self.number(u32::from(network.vehicle_speed));
        self.list(&network.starts, |to, x| to.real(*x));
    }

    fn flow(&mut self, flow: Flow) {
        let (kind, amount) = match flow {
            Flow::Given(given) => (0, given),
            Flow::Share(share) => (1, share),
        };
        self.number(kind);
        self.real(amount);
    }

    fn source(&mut self, source: &Source) {
        self.table(&source.table);
        self.list(&source.nodes, |to, node| to.number(*node));
        self.number(u32::from(source.over_speed));
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*first)
    }

    fn number(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn real(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_le_bytes)
    }

    fn flag(&mut self) -> Option<bool> {
        Some(self.number()? != 0)
    }

    fn text(&mut self) -> Option<String> {
        let count = self.number()? as usize;
        let (text, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        core::str::from_utf8(text).ok().map(String::from)
    }

    /// A number that may be absent; `None` at the end of the bytes.
    #[allow(clippy::option_option)]
    fn option(&mut self) -> Option<Option<f64>> {
        let is_there = self.flag()?;
        let x = self.real()?;
        Some(is_there.then_some(x))
    }

    fn list<T>(&mut self, mut each: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let count = self.number()?;
        // Each element has at least four bytes.
        if count > MOST || count as usize > self.0.len() / 4 {
            return None;
        }
        let mut list = Vec::new();
        for _ in 0..count {
            list.push(each(self)?);
        }
        Some(list)
    }

    fn table(&mut self) -> Option<Table> {
        let axis = |from: &mut Self| {
            Some(Axis {
                quantity: from.number()?,
                points: from.list(Self::real)?,
            })
        };
        let axes = self.list(axis)?;
        let channels = self.number()? as usize;
        let values = if self.flag()? {
            self.list(|from| from.bytes().map(|number| f64::from(f32::from_le_bytes(number))))?
        } else {
            self.list(Self::real)?
        };
        Some(Table { axes, channels, values })
    }

    fn map(&mut self, of: OfMap) -> Option<Map> {
        let oil = match self.number()? {
            0 => OilOfMap::Given,
            1 => OilOfMap::Balance,
            2 => OilOfMap::Fixed,
            _ => return None,
        };
        let gear = |from: &mut Self| {
            Some(GearOfMap {
                name: from.text()?,
                ratio: from.option()?,
                table: from.table()?,
            })
        };
        Some(Map {
            of,
            oil,
            gears: self.list(gear)?,
            starts: self.list(Self::real)?,
        })
    }

    fn network(&mut self) -> Option<Network> {
        let node = |from: &mut Self| {
            Some(Node {
                name: from.text()?,
                capacity: from.real()?,
                held: from.option()?,
                start: from.real()?,
            })
        };
        let exchanger = |from: &mut Self| {
            Some(Exchanger {
                name: from.text()?,
                from: from.number()?,
                to: from.number()?,
                oil: from.flow()?,
                ua: from.real()?,
                arrangement: from.number()?,
                coolant_heat_capacity: from.real()?,
                coolant_flow: from.real()?,
                coolant_temperature: from.real()?,
            })
        };
        let link = |from: &mut Self| {
            Some(Link {
                between: [from.number()?, from.number()?],
                conductance: match from.number()? {
                    0 => Conductance::Given(from.real()?),
                    1 => Conductance::Table(from.table()?),
                    _ => return None,
                },
            })
        };
        let gear = |from: &mut Self| {
            Some(GearOfNetwork {
                name: from.text()?,
                ratio: from.option()?,
                losses: from.list(Self::source)?,
                motors: from.list(Self::source)?,
                links: from.list(link)?,
            })
        };
        Some(Network {
            nodes: self.list(node)?,
            oil: self.number()?,
            step: self.real()?,
            pumped: self.option()?,
            oil_properties: self.table()?,
            exchangers: self.list(exchanger)?,
            flows: self.list(|from| Some((from.number()?, from.number()?, from.flow()?)))?,
            sources: self.list(|from| Some((from.number()?, from.real()?)))?,
            gears: self.list(gear)?,
            vehicle_speed: self.flag()?,
            starts: self.list(Self::real)?,
        })
    }

    fn flow(&mut self) -> Option<Flow> {
        match (self.number()?, self.real()?) {
            (0, given) => Some(Flow::Given(given)),
            (1, share) => Some(Flow::Share(share)),
            _ => None,
        }
    }

    fn source(&mut self) -> Option<Source> {
        Some(Source {
            table: self.table()?,
            nodes: self.list(Self::number)?,
            over_speed: self.flag()?,
        })
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use alloc::vec;

    use super::*;

    /// A network with everything that a content can have.
    pub fn network() -> Network {
        let axis = |quantity, points: &[f64]| Axis {
            quantity,
            points: points.to_vec(),
        };
        let node = |name: &str, capacity, held| Node {
            name: name.into(),
            capacity,
            held,
            start: 20.0,
        };
        let source = |scale: f64| Source {
            table: Table {
                axes: vec![axis(0, &[0.0, 100.0]), axis(1, &[-10.0, 10.0])],
                channels: 1,
                values: vec![scale, scale, scale, 3.0 * scale],
            },
            nodes: vec![1],
            over_speed: true,
        };
        Network {
            nodes: vec![
                node("ambient", 0.0, Some(20.0)),
                node("sump", 1000.0, None),
                node("cooled", 0.0, None),
                node("plate", 50.0, Some(35.0)),
            ],
            oil: 1,
            step: 1.0,
            pumped: Some(1e-4),
            oil_properties: Table {
                axes: vec![axis(5, &[0.0, 100.0])],
                channels: 2,
                values: vec![900.0, 1800.0, 830.0, 2200.1],
            },
            exchangers: vec![Exchanger {
                name: "cooler".into(),
                from: 1,
                to: 2,
                oil: Flow::Share(1.0),
                ua: 300.0,
                arrangement: 0,
                coolant_heat_capacity: 3600.0,
                coolant_flow: 0.1,
                coolant_temperature: 15.0,
            }],
            flows: vec![(2, 1, Flow::Share(1.0))],
            sources: vec![(1, 7.0)],
            gears: vec![GearOfNetwork {
                name: "first".into(),
                ratio: Some(-0.25),
                losses: vec![source(0.1)],
                motors: vec![source(0.01)],
                links: vec![
                    Link {
                        between: [1, 0],
                        conductance: Conductance::Given(5.0),
                    },
                    Link {
                        between: [1, 3],
                        conductance: Conductance::Table(Table {
                            axes: vec![axis(2, &[0.0, 30.0])],
                            channels: 1,
                            values: vec![1.0, 4.0],
                        }),
                    },
                ],
            }],
            vehicle_speed: true,
            starts: vec![0.0, 0.0, 0.0, 20.0],
        }
    }

    #[test]
    fn a_content_is_read_as_it_was_written() {
        let content = Content::Network(network());
        let bytes = content.encode();
        assert_eq!(Content::decode(&bytes), Some(content));
        assert_eq!(token(&bytes).len(), 32);
        let mut other = bytes.clone();
        other[40] ^= 1;
        assert_ne!(token(&bytes), token(&other));
    }

    /// A small generator of random numbers.
    fn random(state: &mut u64) -> usize {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        *state as usize
    }

    /// Whatever the bytes are, nothing panics, and the memory is bounded by their number.
    #[test]
    fn changed_bytes_are_refused_or_simulated() {
        let bytes = Content::Network(network()).encode();
        let mut state = 88_172_645_463_325_252;
        let mut sound = 0;
        for _ in 0..100_000 {
            let mut damaged = bytes.clone();
            for _ in 0..=random(&mut state) % 3 {
                let place = random(&mut state) % damaged.len();
                damaged[place] = random(&mut state) as u8;
            }
            damaged.truncate(damaged.len() - random(&mut state) % 2);
            if let Some(content) = Content::decode(&damaged) {
                let mut model = crate::model::Model::new(content);
                // A step length may have become tiny.
                let _ = model.advance(1e-3);
                let _ = model.get(1, crate::variables::Kind::Real);
                sound += 1;
            }
        }
        assert!(sound > 1000, "{sound}");
    }
}
