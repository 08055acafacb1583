//! Operating temperature of an operating point.

use super::balance::{Outcome, Root, Step, balance};
use super::housing::SumpOil;
use crate::evaluate::{Point, Scratch};
use crate::loss::{Trace, Undefined};
use crate::transmission::{Case, Transmission};

/// Why losses or heat are undefined at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unbalanced {
    /// The loss of a part, by number, is undefined.
    Part(usize, Undefined),
    /// The conductance of a heat dissipation path, by number, is undefined.
    Way(usize, Undefined),
    /// The model of a link of the thermal network, by number, is undefined.
    Link(usize, Undefined),
    /// The transmission is self-locking, or losses and loads do not converge.
    Flow,
    /// The temperatures of the thermal network do not converge, or a node is isolated while its oil is stationary.
    Network,
}

/// The temperature of an operating point with the balance behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// Outcome of the balance.
    pub outcome: Outcome,
    /// Stable oil temperatures, the lowest first; it is used.
    pub stable: Vec<Root>,
    /// Surface temperature. \[degC\]
    pub surface: Option<f64>,
    /// Heat flow of each path, in the order of [`super::Housing::ways`]. \[W\]
    pub ways: Vec<f64>,
    /// All steps: the scan, then those towards each temperature.
    pub history: Vec<Step>,
    /// Index of the first step after the scan.
    pub scanned: usize,
    /// Spacing of the scan: two balances that are closer may both be missed. \[K\]
    pub spacing: f64,
    /// Number of loss model evaluations.
    pub calls: usize,
    /// Temperature at which losses or heat were undefined, and the reason.
    pub undefined: Option<(f64, Unbalanced)>,
}

impl Transmission {
    /// Heat flow of a path, by number, at temperatures of oil and surface in degC, recording every step. \[W\]
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
    /// The oil temperature that is used. \[degC\]
    pub fn oil(&self) -> Option<f64> {
        self.stable.first().map(|root| root.temperature)
    }

    /// Number of evaluations of the point.
    pub fn evaluations(&self) -> usize {
        self.history.len()
    }
}

impl Transmission {
    /// Balances the temperature of a point. The caller evaluates the point at that temperature.
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
                ways = scratch
                    .note_heat(|cells| housing.flows(&oil, flow.surface, cells))
                    .unwrap_or_default();
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
