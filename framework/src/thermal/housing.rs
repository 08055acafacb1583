//! The housing: ways on which heat leaves, sources of heat, and the temperature of the surface between oil and air.

use std::cell::Cell;
use std::sync::Arc;

use super::balance::{Balance, Step, single};
use crate::description::{GearboxEntry, HeatInto, OutsideEntry, Thermal, ThermalMode};
use crate::document::Diagnostic;
use crate::loss::{Extent, Notes, Undefined};
use crate::mechanism::heat_dissipation::{HeatDissipation, HeatDissipationAt, HousingPart, WarmSide};
use crate::registry::{Build, Slot};

/// One way on which heat leaves.
pub struct Way {
    /// Path, such as `thermal.heat_dissipation.casing`.
    pub path: String,
    model: Slot<HeatDissipation>,
    side: WarmSide,
    /// Where the way ends. \[degC\]
    sink: f64,
}

/// The oil of the sump at one temperature, as far as heat goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SumpOil {
    /// Temperature. \[degC\]
    pub temperature: f64,
    /// Density. \[kg/m3\]
    pub rho: f64,
    /// Specific heat. \[J/(kg K)\]
    pub heat_capacity: f64,
}

/// Heat that leaves at one temperature of the oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatFlow {
    /// Temperature of the surface; that of the oil where nothing lies between. \[degC\]
    pub surface: f64,
    /// Heat that leaves the oil. \[W\]
    pub from_oil: f64,
    /// Sum of the magnitudes of all flows. \[W\]
    pub scale: f64,
}

/// The ways, sources and temperatures of a gearbox.
pub struct Housing {
    part: Arc<HousingPart>,
    ways: Vec<Way>,
    /// Temperature of the surroundings. \[degC\]
    pub ambient: f64,
    /// Temperature of the oil up to which a balance is looked for. \[degC\]
    pub maximum: f64,
    /// Resistance between oil and surface. \[K/W\]
    pub oil_to_surface: f64,
    /// Heat of sources into the oil. \[W\]
    pub into_oil: f64,
    /// Heat of sources into the surface. \[W\]
    pub into_surface: f64,
}

impl Housing {
    /// The housing of a description.
    pub(crate) fn new(entry: &GearboxEntry, build: &mut Build<'_>, found: &mut Vec<Diagnostic>) -> Self {
        let thermal = &entry.thermal;
        let part = Arc::new(part(entry.housing.outside.as_ref()));
        let before = found.len();
        let mut ways = Vec::new();
        let slots = thermal.heat_dissipation.iter().flat_map(|slots| slots.0.iter());
        for (name, choice) in slots {
            let path = format!("thermal.heat_dissipation.{name}");
            match build.slot_at::<HeatDissipation>(&path, &part, &choice.value) {
                Ok(model) if model.off => {}
                Ok(model) => ways.push(Way {
                    path,
                    side: model.warm_side(),
                    sink: model.sink().unwrap_or(thermal.ambient),
                    model,
                }),
                Err(error) => found.push(error),
            }
        }
        let sum = |into: HeatInto| {
            let sources = thermal.sources.iter().filter(|(_, s)| s.into == into);
            sources.map(|(_, s)| s.heat).sum()
        };
        let housing = Self {
            part,
            ways,
            ambient: thermal.ambient,
            maximum: thermal.maximum,
            oil_to_surface: thermal.oil_to_surface,
            into_oil: sum(HeatInto::Oil),
            into_surface: sum(HeatInto::Surface),
        };
        // What is wrong with a way was said already.
        if thermal.mode == ThermalMode::Balance && found.len() == before {
            housing.check(thermal, found);
        }
        housing
    }

    fn check(&self, thermal: &Thermal, found: &mut Vec<Diagnostic>) {
        if self.ways.is_empty() {
            found.push(
                Diagnostic::error("thermal.mode", "a balance needs a way on which heat leaves").mend(
                    "add `heat_dissipation: { casing: { type: constant, alpha: 20 W/(m2 K), area: 500 cm2 } }` under `thermal`",
                ),
            );
        } else if self.coldest() >= self.maximum {
            found.push(
                Diagnostic::error(
                    "thermal.maximum",
                    format!(
                        "{} degC is no warmer than the coldest sink, {} degC",
                        thermal.maximum,
                        self.coldest()
                    ),
                )
                .mend("raise it above the surroundings"),
            );
        }
    }

    /// Temperature below which no heat leaves: that of the coldest sink. \[degC\]
    pub fn coldest(&self) -> f64 {
        self.ways.iter().map(|w| w.sink).fold(f64::INFINITY, f64::min)
    }

    /// The ways.
    pub fn ways(&self) -> &[Way] {
        &self.ways
    }

    /// Heat flow of one way. \[W\]
    fn flow_of(&self, way: &Way, oil: &SumpOil, surface: f64, notes: Notes<'_>) -> Result<f64, Undefined> {
        let at = HeatDissipationAt {
            part: &self.part,
            oil_temperature: oil.temperature,
            surface_temperature: surface,
            ambient: self.ambient,
            rho: oil.rho,
            heat_capacity: oil.heat_capacity,
            notes: notes.of(way.model.notes),
        };
        let conductance = way.model.conductance(&at)?;
        if !(conductance.is_finite() && conductance >= 0.0) {
            return Err(Undefined {
                what: "conductance of a way of heat, which is negative or not finite",
                value: conductance,
            });
        }
        let warm = match way.side {
            WarmSide::Oil => oil.temperature,
            WarmSide::Surface => surface,
        };
        Ok(conductance * (warm - way.sink))
    }

    /// Sum of the flows that begin at one side, and sum of their magnitudes. \[W\]
    fn sum(&self, side: WarmSide, oil: &SumpOil, surface: f64) -> Result<(f64, f64), (usize, Undefined)> {
        let (mut sum, mut scale) = (0.0, 0.0);
        for (i, way) in self.ways.iter().enumerate().filter(|(_, w)| w.side == side) {
            let flow = self.flow_of(way, oil, surface, Notes::MUTED).map_err(|e| (i, e))?;
            sum += flow;
            scale += flow.abs();
        }
        Ok((sum, scale))
    }

    /// Heat that leaves the oil at a temperature.
    ///
    /// # Errors
    /// Number of the way without value, and why.
    pub fn flow(&self, oil: &SumpOil) -> Result<HeatFlow, (usize, Undefined)> {
        let surface = self.surface(oil)?;
        let (from_oil, oil_scale) = self.sum(WarmSide::Oil, oil, surface)?;
        let (from_surface, surface_scale) = self.sum(WarmSide::Surface, oil, surface)?;
        // What leaves the surface and does not come in there comes out of the oil.
        Ok(HeatFlow {
            surface,
            from_oil: from_oil + from_surface - self.into_surface,
            scale: oil_scale + surface_scale + self.into_surface,
        })
    }

    /// Temperature of the surface. \[degC\]
    fn surface(&self, oil: &SumpOil) -> Result<f64, (usize, Undefined)> {
        if self.oil_to_surface == 0.0 {
            return Ok(oil.temperature);
        }
        // What comes through the wall and from sources falls with the temperature of the surface, what leaves it rises.
        let hottest = oil.temperature + self.oil_to_surface * self.into_surface;
        let low = self.coldest().min(oil.temperature);
        if hottest <= low {
            return Ok(low);
        }
        let found: Balance<(usize, Undefined)> = single([low, hottest], |t| {
            let (heat, scale) = self.sum(WarmSide::Surface, oil, t)?;
            // A flow into the surface from a sink that is warmer counts as one that comes in.
            let through = (oil.temperature - t) / self.oil_to_surface;
            Ok(Step {
                temperature: t,
                loss: through + self.into_surface,
                heat,
                scale: scale + through.abs(),
            })
        });
        match (found.taken(), found.undefined) {
            (Some(root), _) => Ok(root.temperature),
            (None, Some((_, reason))) => Err(reason),
            // Only ways from the oil: the surface is as warm as what comes in makes it.
            (None, None) => Ok(hottest),
        }
    }

    /// Heat flow of every way at a temperature of the oil, with its notes. \[W\]
    ///
    /// # Errors
    /// As [`Housing::flow`].
    pub(crate) fn flows(
        &self,
        oil: &SumpOil,
        surface: f64,
        cells: &[Cell<Extent>],
    ) -> Result<Vec<f64>, (usize, Undefined)> {
        let flow = |(i, way): (usize, &Way)| {
            self.flow_of(way, oil, surface, Notes::new(cells, way.model.notes))
                .map_err(|e| (i, e))
        };
        self.ways.iter().enumerate().map(flow).collect()
    }
}

/// What the models see of the outside; a box stands for what is not stated.
fn part(outside: Option<&OutsideEntry>) -> HousingPart {
    let outside = outside.copied().unwrap_or_default();
    let of_box = outside
        .sides
        .map(|[l, w, h]| 2.0 * (l * w + l * h + w * h) - outside.mounting_area);
    let area = outside.area.or(of_box).filter(|a| *a > 0.0);
    HousingPart {
        area,
        oil_area: outside.oil_area.or(area),
        height: outside.height.or(outside.sides.map(|s| s[2])),
        length: outside.length.or(outside.sides.map(|s| s[0])),
        wall_thickness: outside.wall_thickness,
        wall_conductivity: outside.wall_conductivity,
        emissivity: outside.emissivity,
        air_speed: outside.air_speed,
    }
}
