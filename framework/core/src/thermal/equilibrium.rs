//! The temperature at which an operating point runs.

use std::cell::Cell;

use super::balance::{Outcome, Root, Step, balance};
use super::housing::SumpOil;
use crate::evaluate::{Point, Scratch};
use crate::loss::{Trace, Undefined};
use crate::transmission::{Case, Transmission};

/// Why losses or heat have no value at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unbalanced {
    /// The loss of a part, by number, is undefined.
    Part(usize, Undefined),
    /// The heat of a way, by number, is undefined.
    Way(usize, Undefined),
    /// The law of a link of the thermal network, by number, is undefined.
    Link(usize, Undefined),
    /// The transmission locks itself, or losses and loads do not agree.
    Flow,
    /// The temperatures of the thermal network do not settle, or a node hangs on nothing while its oil stands.
    Network,
}

/// The temperature of an operating point with the balance behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// What became of the balance.
    pub outcome: Outcome,
    /// Temperatures of the oil that keep themselves, the lowest first; it is taken.
    pub stable: Vec<Root>,
    /// Temperature of the surface there. \[degC\]
    pub surface: Option<f64>,
    /// Heat of each way there, in the order of [`super::Housing::ways`]. \[W\]
    pub ways: Vec<f64>,
    /// All steps: the scan, then those towards each temperature.
    pub history: Vec<Step>,
    /// Number of the first step behind the scan.
    pub scanned: usize,
    /// Distance of neighbouring temperatures of the scan: two balances that lie closer may both be missed. \[K\]
    pub spacing: f64,
    /// Calls of loss models on the way.
    pub calls: usize,
    /// Where losses or heat had no value, and why.
    pub undefined: Option<(f64, Unbalanced)>,
}

impl Transmission {
    /// Heat flow of a way, by number, at temperatures of oil and surface in degC, with every step written down. \[W\]
    pub fn explain_way(&self, way: usize, oil: f64, surface: f64) -> (Result<f64, Undefined>, Trace) {
        let (rho, heat_capacity) = self.sump_heat(oil);
        let oil = SumpOil {
            temperature: oil,
            rho,
            heat_capacity,
        };
        let trace = Trace::default();
        let heat = self.housing().explain(way, &oil, surface, &trace);
        (heat, trace)
    }
}

impl Equilibrium {
    /// The temperature of the oil that is taken. \[degC\]
    pub fn oil(&self) -> Option<f64> {
        self.stable.first().map(|root| root.temperature)
    }

    /// Evaluations of the point on the way.
    pub fn evaluations(&self) -> usize {
        self.history.len()
    }
}

impl Transmission {
    /// The temperature at which a point runs. Evaluating the point there is up to the caller.
    pub fn equilibrium(&self, case: &Case, point: &Point<'_>, scratch: &mut Scratch) -> Equilibrium {
        let housing = self.housing();
        let sump = |temperature: f64| {
            let (rho, heat_capacity) = self.sump_heat(temperature);
            SumpOil {
                temperature,
                rho,
                heat_capacity,
            }
        };
        let mut calls = 0;
        let found = balance([housing.coldest(), housing.maximum], |t| {
            let loss = self.probe(case, point, &[t], scratch)?;
            calls += scratch.calls();
            let flow = housing.flow(&sump(t)).map_err(|(way, e)| Unbalanced::Way(way, e))?;
            Ok(Step {
                temperature: t,
                loss: loss + housing.into_oil,
                heat: flow.from_oil,
                scale: loss + housing.into_oil + flow.scale,
            })
        });
        let mut surface = None;
        let mut ways = Vec::new();
        if let Some(root) = found.taken() {
            let oil = sump(root.temperature);
            if let Ok(flow) = housing.flow(&oil) {
                surface = Some(flow.surface);
                let cells = Cell::from_mut(scratch.heat_cells()).as_slice_of_cells();
                ways = housing.flows(&oil, flow.surface, cells).unwrap_or_default();
            }
        }
        Equilibrium {
            outcome: found.outcome,
            stable: found.stable,
            surface,
            ways,
            history: found.history,
            scanned: found.scanned,
            spacing: found.spacing,
            calls,
            undefined: found.undefined,
        }
    }
}
