//! Operating temperature of an operating point.

use super::balance::{Accuracy, Balance, Outcome, Root, Step, balance, balance_all};
use super::housing::SumpOil;
use crate::evaluate::{BatchScratch, Point, PowerFlow, Scratch};
use crate::flow::Tolerance;
use crate::loss::{Trace, Undefined};
use crate::real::Stencil;
use crate::transmission::{Case, Transmission};

/// Why losses or heat are undefined at a temperature.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
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
    /// All steps at the losses of the point: those of the scan, then those towards each temperature.
    pub history: Vec<Step>,
    /// Index of the first step after the scan.
    pub scanned: usize,
    /// Spacing of the scan: two balances that are closer may both be missed. \[K\]
    pub spacing: f64,
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

    /// Number of evaluations of the point, without estimates.
    pub fn evaluations(&self) -> usize {
        self.history.len()
    }
}

impl Transmission {
    /// Balances the temperature of a point, with the losses at all temperatures of the scan. The caller evaluates the point at that
    /// temperature.
    pub fn equilibrium(&self, case: &Case, point: &Point<'_>, scratch: &mut Scratch) -> Equilibrium {
        let housing = self.housing();
        let found = balance([housing.coldest(), housing.maximum], |t| {
            self.heat_step(t, self.probe(case, point, &[t], scratch))
        });
        self.balanced(found, scratch)
    }

    /// Finds the temperatures of [`Transmission::equilibrium`] for several points side by side. The scan uses estimated losses where they
    /// suffice, so the history is shorter.
    pub fn equilibria(&self, case: &Case, points: &[Point<'_>], scratch: &mut BatchScratch) -> Vec<Equilibrium> {
        let housing = self.housing();
        // With an ideal power flow, estimates would be the losses themselves.
        let rough: Vec<Point<'_>> = points
            .iter()
            .map(|point| point.with_tolerance_at_least(Tolerance::ESTIMATE))
            .collect();
        let is_ideal = |point: &Point<'_>| point.flow == PowerFlow::Ideal;
        let scan = if points.iter().all(is_ideal) {
            Accuracy::Exact
        } else {
            Accuracy::Estimate
        };
        let range = [housing.coldest(), housing.maximum];
        let found = balance_all(range, points.len(), scan, |asked, accuracy| {
            let points = match accuracy {
                Accuracy::Estimate => &rough,
                Accuracy::Exact => points,
            };
            let losses = self.probe_all(case, points, asked, scratch);
            let steps = losses.into_iter().zip(asked);
            steps.map(|(loss, (_, t))| self.heat_step(*t, loss)).collect()
        });
        found
            .into_iter()
            .map(|found| self.balanced(found, scratch.alone()))
            .collect()
    }

    /// The oil of the sump at a temperature in degC.
    fn sump(&self, temperature: f64) -> SumpOil {
        let (rho, heat_capacity) = self.sump_heat(temperature);
        SumpOil {
            temperature,
            rho,
            heat_capacity,
        }
    }

    /// Losses and heat at a temperature in degC, from the losses there.
    fn heat_step(&self, temperature: f64, loss: Result<f64, Unbalanced>) -> Result<Step, Unbalanced> {
        let (housing, loss) = (self.housing(), loss?);
        let flow = housing
            .flow(&self.sump(temperature))
            .map_err(|(way, e)| Unbalanced::Way(way, e))?;
        Ok(Step {
            temperature,
            loss: loss + housing.into_oil,
            heat: flow.from_oil,
            scale: loss + housing.into_oil + flow.scale,
        })
    }

    /// Increase of the dissipated heat with the oil temperature, by differences with a step and with twice the step. \[W/K\]
    pub(crate) fn dissipation_slope(&self, temperature: f64) -> Result<[f64; 2], Unbalanced> {
        /// Wide enough for heat flows whose surface temperature is itself balanced. \[K\]
        const STEP: f64 = 0.5;
        let heat = |distance: f64| {
            let flow = self.housing().flow(&self.sump(temperature + distance));
            flow.map(|flow| flow.from_oil)
                .map_err(|(way, e)| Unbalanced::Way(way, e))
        };
        let slope = |step: f64| Ok(Stencil::new(step, heat)?.slope(|heat| *heat));
        Ok([slope(STEP)?, slope(2.0 * STEP)?])
    }

    /// A finished balance with the heat flows at its temperature, which are noted.
    fn balanced(&self, found: Balance<Unbalanced>, scratch: &mut Scratch) -> Equilibrium {
        let housing = self.housing();
        let mut surface = None;
        let mut ways = Vec::new();
        if let Some(root) = found.taken() {
            let oil = self.sump(root.temperature);
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
            undefined: found.undefined,
        }
    }
}
