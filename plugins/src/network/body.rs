//! Sizes and heat capacities of gears and shafts, as far as the description defines them.

use std::f64::consts::PI;

use gearloss_framework::description::{GearKind, GearboxEntry, ShaftEntry};

/// Share of the disc below the tip diameter that is metal: webs are thinner than rims.
const WEB: f64 = 0.6;
/// Rim thickness of a ring gear, in modules.
const RIM: f64 = 4.0;

/// A metal, by its heat capacity.
#[derive(Clone, Copy)]
pub struct Metal {
    /// \[kg/m3\]
    density: f64,
    /// \[J/(kg K)\]
    pub specific_heat: f64,
}

impl Metal {
    /// Steel.
    pub const STEEL: Self = Self {
        density: 7800.0,
        specific_heat: 470.0,
    };
    const ALUMINIUM: Self = Self {
        density: 2700.0,
        specific_heat: 900.0,
    };

    /// The metal of a wall with a thermal conductivity: aluminium from 90 W/(m K), otherwise iron.
    pub fn of_wall(conductivity: f64) -> Self {
        if conductivity >= 90.0 {
            Self::ALUMINIUM
        } else {
            Self::STEEL
        }
    }

    /// Heat capacity of a volume. \[J/(m3 K)\]
    pub fn heat_capacity(self) -> f64 {
        self.density * self.specific_heat
    }
}

/// Size of a gear.
#[derive(Clone, Copy)]
pub struct Size {
    /// Reference diameter. \[m\]
    diameter: f64,
    /// Normal module. \[m\]
    module: f64,
    /// Face width. \[m\]
    width: f64,
    /// True for internal teeth.
    pub ring: bool,
}

impl Size {
    /// Oil-wetted surface: both sides and the teeth, for a ring gear only the teeth. \[m2\]
    pub fn wetted(&self) -> f64 {
        let sides = if self.ring {
            0.0
        } else {
            0.5 * PI * self.diameter * self.diameter
        };
        sides + PI * self.diameter * self.width
    }

    /// Volume of metal. \[m3\]
    fn volume(&self) -> f64 {
        if self.ring {
            PI * (self.diameter + RIM * self.module) * RIM * self.module * self.width
        } else {
            WEB * 0.25 * PI * self.diameter * self.diameter * self.width
        }
    }
}

/// The component that splashes oil on the casing.
pub struct Splash<'a> {
    /// Gear or carrier.
    pub member: &'a str,
    /// Outer diameter of the planets; `None` for a gear. \[m\]
    pub reach: Option<f64>,
}

/// Gears with their sizes.
pub struct Bodies<'a> {
    entry: &'a GearboxEntry,
    sizes: Vec<(&'a str, Size)>,
}

impl<'a> Bodies<'a> {
    /// The bodies of a description; a gear without a mesh has no known size.
    pub fn new(entry: &'a GearboxEntry) -> Self {
        let size = |(id, gear): (&'a str, &gearloss_framework::description::GearEntry)| {
            let (_, mesh) = entry.meshes.iter().find(|(_, m)| m.gears.iter().any(|g| g == id))?;
            let size = Size {
                diameter: f64::from(gear.z) * mesh.normal_module / mesh.helix_angle.cos(),
                module: mesh.normal_module,
                width: gear.facewidth,
                ring: gear.kind == GearKind::Ring,
            };
            Some((id, size))
        };
        Self {
            entry,
            sizes: entry.gears.iter().filter_map(size).collect(),
        }
    }

    /// Size of a gear.
    pub fn size(&self, gear: &str) -> Option<&Size> {
        self.sizes.iter().find(|(id, _)| *id == gear).map(|(_, size)| size)
    }

    /// Heat capacity of a gear. \[J/K\]
    pub fn capacity(&self, gear: &str) -> f64 {
        let written = self.entry.gears.get(gear).and_then(|gear| gear.material.as_deref());
        let material = written.and_then(|name| self.entry.materials.get(name));
        let thermal = material.and_then(|material| material.material().ok()?.thermal);
        let per_volume = thermal.map_or(Metal::STEEL.heat_capacity(), |own| own.density * own.heat_capacity);
        self.size(gear).map_or(0.0, Size::volume) * per_volume
    }

    /// Heat capacity of a shaft without gears: from its sections, else of a bar between its outermost bearings and gears with the
    /// mean bore of its bearings as diameter. Takes the bearings by bore and position. \[J/K\]
    pub fn shaft_capacity(
        &self,
        id: &str,
        shaft: &ShaftEntry,
        bearings: impl Iterator<Item = (Option<f64>, f64)>,
    ) -> f64 {
        let round = |outer: f64, inner: f64, length: f64| 0.25 * PI * (outer * outer - inner * inner) * length;
        let volume: f64 = if shaft.sections.is_empty() {
            let (mut bores, mut places): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
            for (bore, at) in bearings {
                bores.extend(bore);
                places.push(at);
            }
            places.extend(
                self.entry
                    .gears
                    .iter()
                    .filter(|(_, g)| g.shaft == id)
                    .map(|(_, g)| g.at),
            );
            let ends = places
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                    [low.min(*at), high.max(*at)]
                });
            if bores.is_empty() {
                0.0
            } else {
                let bore = bores.iter().sum::<f64>() / bores.len() as f64;
                round(bore, 0.0, ends[1] - ends[0])
            }
        } else {
            shaft
                .sections
                .iter()
                .map(|s| round(s.outer, s.inner, s.to - s.from).max(0.0))
                .sum()
        };
        volume * Metal::STEEL.heat_capacity()
    }

    /// Number of equal copies of a shaft: the number of planets for a planet body. Also accepts an idler gear on one.
    pub fn copies(&self, member: &str) -> f64 {
        let shaft = self.entry.gears.get(member).map_or(member, |gear| gear.shaft.as_str());
        let mut sets = self.entry.planetary_sets.iter();
        let set_of_shaft = sets.find(|(_, set)| set.planets.iter().any(|planet| planet == shaft));
        set_of_shaft.map_or(1.0, |(_, set)| f64::from(set.count))
    }

    /// Number of equal copies of a gear.
    pub fn copies_of_gear(&self, gear: &str) -> f64 {
        self.entry.gears.get(gear).map_or(1.0, |gear| self.copies(&gear.shaft))
    }

    /// The component with the largest reach: a gear on its own axis, or the planets on their carrier.
    pub fn splashing(&self) -> Option<Splash<'a>> {
        let mut farthest: Option<(f64, Splash<'a>)> = None;
        let mut offer = |reach: f64, splash: Splash<'a>| {
            if farthest.as_ref().is_none_or(|(most, _)| reach > *most) {
                farthest = Some((reach, splash));
            }
        };
        for (id, size) in self.sizes.iter().filter(|(_, size)| !size.ring) {
            let tip = size.diameter + 2.0 * size.module;
            let Some(gear) = self.entry.gears.get(id) else {
                continue;
            };
            let mut sets = self.entry.planetary_sets.iter();
            match sets.find(|(_, set)| set.planets.contains(&gear.shaft)) {
                None => offer(
                    tip,
                    Splash {
                        member: id,
                        reach: None,
                    },
                ),
                Some((_, set)) => {
                    if let Some(orbit) = self.orbit(id) {
                        let reach = Some(orbit + tip);
                        let member = set.carrier.as_str();
                        offer(orbit + tip, Splash { member, reach });
                    }
                }
            }
        }
        farthest.map(|(_, splash)| splash)
    }

    /// Diameter of the planet orbit, from the mesh with a sun or a ring. \[m\]
    fn orbit(&self, planet: &str) -> Option<f64> {
        let diameter = self.size(planet)?.diameter;
        let mates = self.entry.meshes.iter().filter_map(|(_, mesh)| {
            let [one, other] = mesh.gears.each_ref().map(String::as_str);
            match (one == planet, other == planet) {
                (true, _) => Some(other),
                (_, true) => Some(one),
                _ => None,
            }
        });
        mates
            .filter(|mate| self.copies_of_gear(mate) <= 1.0)
            .find_map(|mate| self.size(mate))
            .map(|mate| {
                if mate.ring {
                    mate.diameter - diameter
                } else {
                    mate.diameter + diameter
                }
            })
    }
}
