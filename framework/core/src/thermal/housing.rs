//! The housing: heat dissipation paths, heat sources, and the surface temperature between oil and air.

use std::cell::Cell;
use std::sync::Arc;

use super::balance::{Balance, Step, single};
use crate::description::{GearboxEntry, HeatInto, OutsideEntry, Thermal, ThermalMode};
use crate::document::Diagnostic;
use crate::loss::{Notes, Seen, Trace, Undefined};
use crate::mechanism::Slot;
use crate::mechanism::heat_dissipation::{HeatDissipation, HeatDissipationAt, HousingPart, WarmSide};
use crate::registry::Build;

/// One heat dissipation path.
pub struct Way {
    /// Path, such as `thermal.heat_dissipation.casing`.
    pub path: String,
    model: Slot<HeatDissipation>,
    side: WarmSide,
    /// Temperature of the heat sink. \[degC\]
    sink: f64,
}

/// Thermal properties of the sump oil at one temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SumpOil {
    /// Temperature. \[degC\]
    pub temperature: f64,
    /// Density. \[kg/m3\]
    pub rho: f64,
    /// Specific heat. \[J/(kg K)\]
    pub heat_capacity: f64,
}

/// Heat dissipation at one oil temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatFlow {
    /// Surface temperature; equal to the oil temperature without a resistance between them. \[degC\]
    pub surface: f64,
    /// Heat that leaves the oil. \[W\]
    pub from_oil: f64,
    /// Sum of the magnitudes of all flows. \[W\]
    pub scale: f64,
}

/// Heat dissipation paths, heat sources and ambient temperature of a gearbox.
pub struct Housing {
    part: Arc<HousingPart>,
    ways: Vec<Way>,
    /// Ambient temperature. \[degC\]
    pub ambient: f64,
    /// Maximum oil temperature of the search for a balance. \[degC\]
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
        let part = build.part_again(
            "housing.outside",
            HousingPart::from(entry.housing.outside.unwrap_or_default()),
        );
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
            sources.fold(0.0, |sum, (_, s)| sum + s.heat)
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
        // Errors of a path have already been reported.
        if thermal.mode == ThermalMode::Balance && found.len() == before {
            housing.check(thermal, found);
        }
        housing
    }

    fn check(&self, thermal: &Thermal, found: &mut Vec<Diagnostic>) {
        if self.ways.is_empty() {
            found.push(
                Diagnostic::error("thermal.mode", "a balance requires a heat dissipation path").help(
                    "add `heat_dissipation: { casing: { type: constant, alpha: 20 W/(m2 K), area: 500 cm2 } }` under `thermal`",
                ),
            );
        } else if self.coldest() >= self.maximum {
            found.push(
                Diagnostic::error(
                    "thermal.maximum",
                    format!(
                        "{} degC does not exceed the coldest heat sink, {} degC",
                        thermal.maximum,
                        self.coldest()
                    ),
                )
                .help("raise it above the ambient temperature"),
            );
        }
    }

    /// The outside, in the form used by models.
    pub(crate) fn outside(&self) -> &HousingPart {
        &self.part
    }

    /// Temperature below which no heat is dissipated: that of the coldest heat sink. \[degC\]
    pub(crate) fn coldest(&self) -> f64 {
        self.ways.iter().map(|w| w.sink).fold(f64::INFINITY, f64::min)
    }

    /// The heat dissipation paths.
    pub fn ways(&self) -> &[Way] {
        &self.ways
    }

    /// Heat flow of one path. \[W\]
    fn flow_of(&self, way: &Way, oil: &SumpOil, surface: f64, notes: Notes<'_>) -> Result<f64, Undefined> {
        let at = HeatDissipationAt {
            part: &self.part,
            oil_temperature: oil.temperature,
            surface_temperature: surface,
            ambient: self.ambient,
            rho: oil.rho,
            heat_capacity: oil.heat_capacity,
            notes: notes.nested(way.model.notes),
        };
        let conductance = way.model.conductance(&at)?;
        if !(conductance.is_finite() && conductance >= 0.0) {
            return Err(Undefined {
                what: "conductance of a heat dissipation path, which is negative or not finite",
                value: conductance,
            });
        }
        let warm = match way.side {
            WarmSide::Oil => oil.temperature,
            WarmSide::Surface => surface,
        };
        Ok(conductance * (warm - way.sink))
    }

    /// Sum of the flows that start at one side, and sum of their magnitudes. \[W\]
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
    /// Number of the undefined path, and the reason.
    pub fn flow(&self, oil: &SumpOil) -> Result<HeatFlow, (usize, Undefined)> {
        let surface = self.surface(oil)?;
        let (from_oil, oil_scale) = self.sum(WarmSide::Oil, oil, surface)?;
        let (from_surface, surface_scale) = self.sum(WarmSide::Surface, oil, surface)?;
        // Heat that leaves the surface and does not enter it from a source comes from the oil.
        Ok(HeatFlow {
            surface,
            from_oil: from_oil + from_surface - self.into_surface,
            scale: oil_scale + surface_scale + self.into_surface,
        })
    }

    /// Surface temperature. \[degC\]
    fn surface(&self, oil: &SumpOil) -> Result<f64, (usize, Undefined)> {
        if self.oil_to_surface == 0.0 {
            return Ok(oil.temperature);
        }
        // Heat into the surface, through the wall and from sources, decreases with the surface temperature; heat out of it
        // increases. The surface temperature is between those of the oil and the heat sinks, or higher by at most the effect of the
        // sources.
        let sinks = || self.ways.iter().filter(|w| w.side == WarmSide::Surface).map(|w| w.sink);
        let low = sinks().fold(oil.temperature, f64::min);
        let high = sinks().fold(oil.temperature, f64::max) + self.oil_to_surface * self.into_surface;
        if high <= low {
            return Ok(low);
        }
        let found: Balance<(usize, Undefined)> = single([low, high], |t| {
            let (heat, scale) = self.sum(WarmSide::Surface, oil, t)?;
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
            (None, None) => Err((
                0,
                Undefined {
                    what: "surface temperature between oil and heat sinks; oil [degC]",
                    value: oil.temperature,
                },
            )),
        }
    }

    /// Heat flow of one path, recording every step. \[W\]
    ///
    /// # Errors
    /// If the model is undefined.
    pub(crate) fn explain(&self, way: usize, oil: &SumpOil, surface: f64, trace: &Trace) -> Result<f64, Undefined> {
        let way = &self.ways[way];
        self.flow_of(way, oil, surface, Notes::new(&[], way.model.notes).traced(trace))
    }

    /// Heat flow of every path at an oil temperature, with its notes. \[W\]
    ///
    /// # Errors
    /// As [`Housing::flow`].
    pub(crate) fn flows(
        &self,
        oil: &SumpOil,
        surface: f64,
        cells: &[Cell<Seen>],
    ) -> Result<Vec<f64>, (usize, Undefined)> {
        let flow = |(i, way): (usize, &Way)| {
            self.flow_of(way, oil, surface, Notes::new(cells, way.model.notes))
                .map_err(|e| (i, e))
        };
        self.ways.iter().enumerate().map(flow).collect()
    }
}

impl From<OutsideEntry> for HousingPart {
    /// The box provides omitted values.
    fn from(outside: OutsideEntry) -> Self {
        let of_box = outside
            .sides
            .map(|[l, w, h]| 2.0 * (l * w + l * h + w * h) - outside.mounting_area);
        let area = outside.area.or(of_box).filter(|a| *a > 0.0);
        Self {
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
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::registry::{Entry, Files, MechanismEntry, Registry};

    /// A housing with paths of constant conductance from the surface: conductance in W/K, heat sink in degC.
    fn housing(ways: &[(f64, f64)], resistance: f64, source: f64) -> Housing {
        // A registry needs at least one model in addition to the generic ones.
        let entry = Entry {
            name: "stand_in",
            ..crate::generic::entries::<HeatDissipation>()[0]
        };
        let mechanism = MechanismEntry::new::<HeatDissipation>(crate::origin!());
        let registry = Registry::from_entries([mechanism], [entry], [], []).unwrap();
        let files = Files::default();
        let mut build = Build::new(&registry, &files);
        let part = Arc::new(HousingPart::from(OutsideEntry::default()));
        let way = |(i, (conductance, sink)): (usize, &(f64, f64))| {
            let law = serde_json::json!({ "type": "formula", "formula": format!("{conductance}") });
            Way {
                path: format!("way {i}"),
                model: build.slot_at::<HeatDissipation>("way", &part, &law).unwrap(),
                side: WarmSide::Surface,
                sink: *sink,
            }
        };
        let ways = ways.iter().enumerate().map(way).collect();
        Housing {
            part,
            ways,
            ambient: 20.0,
            maximum: 150.0,
            oil_to_surface: resistance,
            into_oil: 0.0,
            into_surface: source,
        }
    }

    fn flow(housing: &Housing, temperature: f64) -> HeatFlow {
        let oil = SumpOil {
            temperature,
            rho: 850.0,
            heat_capacity: 2000.0,
        };
        housing.flow(&oil).unwrap()
    }

    #[test]
    fn a_resistance_and_a_conductance_in_a_row_whichever_side_is_warmer() {
        for (oil, sink) in [(80.0, 20.0), (55.0, 100.0), (20.0, 20.0)] {
            let heat = flow(&housing(&[(4.0, sink)], 0.5, 0.0), oil);
            let expected = (oil - sink) / (0.5 + 1.0 / 4.0);
            assert!(
                (heat.from_oil - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "{oil} {sink} {}",
                heat.from_oil
            );
            assert!((heat.surface - (oil - 0.5 * expected)).abs() < 1e-9);
        }
    }

    #[test]
    fn two_sinks_and_a_source_meet_at_the_surface() {
        for oil in [10.0, 50.0, 90.0] {
            let heat = flow(&housing(&[(4.0, 20.0), (2.0, 70.0)], 0.2, 30.0), oil);
            // Balance of the surface: (oil - t)/R + source = sum of G (t - sink).
            let surface = (oil / 0.2 + 30.0 + 4.0 * 20.0 + 2.0 * 70.0) / (1.0 / 0.2 + 4.0 + 2.0);
            assert!(
                (heat.surface - surface).abs() < 1e-9,
                "{oil}: {} against {surface}",
                heat.surface
            );
            assert!((heat.from_oil - (oil - surface) / 0.2).abs() < 1e-8);
        }
        // Without a path from the surface the heat of a source passes through the resistance into the oil.
        let closed = flow(&housing(&[], 0.2, 30.0), 50.0);
        assert!((closed.surface - 56.0).abs() < 1e-9 && (closed.from_oil + 30.0).abs() < 1e-9);
    }
}
