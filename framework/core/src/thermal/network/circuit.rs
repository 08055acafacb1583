//! Numerical form of a thermal network at one state: C dT/dt = Q - K T.
//!
//! Links transfer heat in both directions and appear in the rows of both nodes; a flow carries heat downstream and appears only in
//! the row of its downstream node. A flow that leaves the network has the temperature of its last node. A heat exchanger is a flow
//! from which heat is removed, so that its outlet temperature follows from its inlet temperature. Temperatures in degC, heat in W.
//!
//! Source: the usual nodal equations; a backward Euler step is stable for any length. Nodes without heat capacity are algebraic.
//! The matrix has positive diagonals and rows that sum to zero, so without a source the temperature of a node is within the range
//! of its neighbours.

use nalgebra::{DMatrix, DVector};

/// Heat exchanger between two nodes of oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exchange {
    /// Node of the incoming oil.
    pub from: usize,
    /// Node of the outgoing oil.
    pub to: usize,
    /// Capacity flow of the oil. \[W/K\]
    pub oil: f64,
    /// Heat per difference of the inlet temperatures of oil and coolant, at most the capacity flow. \[W/K\]
    pub transfer: f64,
    /// Inlet temperature of the coolant. \[degC\]
    pub coolant: f64,
}

impl Exchange {
    /// Outlet temperature for oil of an inlet temperature; equal to it without flow. \[degC\]
    pub(crate) fn outlet(&self, inlet: f64) -> f64 {
        if self.oil > 0.0 {
            inlet - self.transfer * (inlet - self.coolant) / self.oil
        } else {
            inlet
        }
    }
}

/// A thermal network in numerical form.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Circuit {
    /// Heat capacities. \[J/K\]
    pub capacities: Vec<f64>,
    /// Prescribed node temperatures. \[degC\]
    pub held: Vec<Option<f64>>,
    /// Conductances between two nodes. \[W/K\]
    pub links: Vec<([usize; 2], f64)>,
    /// Capacity flows from one node to another. \[W/K\]
    pub flows: Vec<([usize; 2], f64)>,
    /// Heat exchangers.
    pub exchangers: Vec<Exchange>,
}

/// Heat that leaves a circuit. \[W\]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Leaving {
    /// Into nodes of prescribed temperature, through links and from their own heat: one for each node, zero for free nodes.
    pub held: Vec<f64>,
    /// Through each heat exchanger.
    pub exchangers: Vec<f64>,
    /// Carried away by flows: the sum of their gains along the way, minus the heat removed by exchangers.
    pub flows: f64,
}

impl Leaving {
    /// Total. \[W\]
    pub fn total(&self) -> f64 {
        self.held.iter().sum::<f64>() + self.exchangers.iter().sum::<f64>() + self.flows
    }
}

impl Circuit {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.capacities.len()
    }

    /// K of all nodes, and the heat input of heat exchangers from their coolants. \[W/K and W\]
    fn matrix(&self) -> (DMatrix<f64>, DVector<f64>) {
        let mut k = DMatrix::zeros(self.len(), self.len());
        let mut coolants = DVector::zeros(self.len());
        for ([a, b], g) in &self.links {
            for (node, other) in [(*a, *b), (*b, *a)] {
                k[(node, node)] += g;
                k[(node, other)] -= g;
            }
        }
        for ([from, to], flow) in &self.flows {
            k[(*to, *to)] += flow;
            k[(*to, *from)] -= flow;
        }
        for e in &self.exchangers {
            k[(e.to, e.to)] += e.oil;
            k[(e.to, e.from)] -= e.oil - e.transfer;
            coolants[e.to] += e.transfer * e.coolant;
        }
        (k, coolants)
    }

    /// Temperatures after a backward step (s) from `before`, under heat (W) at each node; without a step the steady state. `None`
    /// if a node is isolated.
    pub fn solve(&self, heat: &[f64], step: Option<(f64, &[f64])>) -> Option<Vec<f64>> {
        let (mut k, mut right) = self.matrix();
        for (sum, heat) in right.iter_mut().zip(heat) {
            *sum += heat;
        }
        if let Some((duration, before)) = step {
            for i in 0..self.len() {
                let held_back = self.capacities[i] / duration;
                k[(i, i)] += held_back;
                right[i] += held_back * before[i];
            }
        }
        // Stationary oil has the temperature of its upstream node, unless something else heats or cools it.
        let ways = self.flows.iter().map(|(ends, _)| *ends);
        for [from, to] in ways.chain(self.exchangers.iter().map(|e| [e.from, e.to])) {
            if k[(to, to)] == 0.0 && heat[to] == 0.0 {
                k[(to, to)] = 1.0;
                k[(to, from)] = -1.0;
            }
        }
        for (i, held) in self.held.iter().enumerate() {
            if let Some(temperature) = held {
                k.row_mut(i).fill(0.0);
                k[(i, i)] = 1.0;
                right[i] = *temperature;
            }
        }
        let mut solved = k.lu().solve(&right)?;
        for (t, held) in solved.iter_mut().zip(&self.held) {
            *t = held.unwrap_or(*t);
        }
        solved.iter().all(|t| t.is_finite()).then(|| solved.as_slice().to_vec())
    }

    /// Outgoing heat at given temperatures, under heat (W) at each node: heat of a node with prescribed temperature leaves there.
    pub fn leaving(&self, temperatures: &[f64], heat: &[f64]) -> Leaving {
        let mut leaving = Leaving {
            held: heat.to_vec(),
            exchangers: Vec::with_capacity(self.exchangers.len()),
            flows: 0.0,
        };
        let is_held = |i: usize| self.held[i].is_some();
        for (i, held) in leaving.held.iter_mut().enumerate() {
            if !is_held(i) {
                *held = 0.0;
            }
        }
        for ([a, b], g) in &self.links {
            for (node, other) in [(*a, *b), (*b, *a)] {
                if is_held(node) && !is_held(other) {
                    leaving.held[node] += g * (temperatures[other] - temperatures[node]);
                }
            }
        }
        for ([from, to], flow) in &self.flows {
            if !is_held(*to) {
                leaving.flows += flow * (temperatures[*to] - temperatures[*from]);
            }
        }
        for e in &self.exchangers {
            let heat = e.transfer * (temperatures[e.from] - e.coolant);
            if !is_held(e.to) {
                leaving.flows += e.oil * (temperatures[e.to] - temperatures[e.from]);
            }
            leaving.exchangers.push(heat);
        }
        leaving
    }

    /// Heat that the nodes have stored since `before`. \[J\]
    pub fn stored(&self, before: &[f64], after: &[f64]) -> f64 {
        let free = self.capacities.iter().zip(&self.held).zip(before.iter().zip(after));
        free.filter(|((_, held), _)| held.is_none())
            .map(|((capacity, _), (before, after))| capacity * (after - before))
            .sum()
    }
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::thermal::Arrangement;

    fn close(value: f64, expected: f64) {
        assert!(
            (value - expected).abs() < 2e-7 * expected.abs().max(1.0) + 5e-7,
            "{value} against {expected}"
        );
    }

    /// Prescribed at 23 degC, then 12, 25 and 8 W/K in series.
    fn chain() -> Circuit {
        Circuit {
            capacities: vec![0.0, 20e3, 4e3, 6e3],
            held: vec![Some(23.0), None, None, None],
            links: vec![([0, 1], 12.0), ([1, 2], 25.0), ([2, 3], 8.0)],
            ..Circuit::default()
        }
    }

    const CHAIN_HEAT: [f64; 4] = [0.0, 10.0, 50.0, 300.0];

    #[test]
    fn u5a_chain_at_rest() {
        let t = chain().solve(&CHAIN_HEAT, None).unwrap();
        for (t, printed) in t.iter().zip([23.0, 53.0, 67.0, 104.5]) {
            close(*t, printed);
        }
    }

    #[test]
    fn u5b_chain_in_time() {
        let chain = chain();
        let mut t = vec![23.0; 4];
        for second in 1..=600 {
            t = chain.solve(&CHAIN_HEAT, Some((1.0, &t))).unwrap();
            let printed = match second {
                60 => [23.05590, 23.74971, 25.91096],
                600 => [25.15750, 30.30333, 45.94483],
                _ => continue,
            };
            for (t, printed) in t[1..].iter().zip(printed) {
                assert!((t - printed).abs() < 6e-6, "{t} against {printed}");
            }
        }
    }

    #[test]
    fn u5c_a_flow_carries_heat_away() {
        let open = Circuit {
            capacities: vec![0.0; 3],
            held: vec![Some(50.0), None, None],
            links: vec![([1, 2], 5.0)],
            flows: vec![([0, 1], 200.0), ([1, 2], 200.0)],
            ..Circuit::default()
        };
        let t = open.solve(&[0.0, 1500.0, 300.0], None).unwrap();
        assert!((t[1] - 57.53659).abs() < 5e-6);
        close(t[2], 59.0);
        close(open.leaving(&t, &[0.0, 1500.0, 300.0]).total(), 1800.0);
    }

    /// The drive unit of seventeen nodes, numbered from one as in its publication; node 0 is unused.
    pub(crate) fn drive_unit() -> (Circuit, Vec<f64>) {
        let mut links = vec![
            (1, 2, 10.0),
            (1, 3, 5.0),
            (2, 3, 30.0),
            (3, 16, 150.0),
            (4, 15, 15.0),
            (15, 16, 80.0),
            (4, 7, 3.0),
            (4, 8, 3.0),
            (4, 9, 3.0),
            (5, 10, 4.0),
            (5, 11, 4.0),
            (6, 12, 5.0),
            (6, 13, 5.0),
            (7, 3, 6.0),
            (8, 2, 7.0),
            (9, 2, 7.0),
            (10, 2, 7.0),
            (11, 2, 7.0),
            (12, 2, 8.0),
            (13, 2, 8.0),
            (4, 5, 10.0),
            (5, 6, 10.0),
            (2, 14, 40.0),
            (4, 14, 3.0),
            (5, 14, 8.0),
            (6, 14, 15.0),
        ];
        links.extend((8..=13).map(|bearing| (bearing, 14, 2.0)));
        let mut capacities = vec![
            0.0, 0.0, 22000.0, 9000.0, 9000.0, 3300.0, 7000.0, 73.0, 174.0, 296.0, 296.0, 296.0, 390.0, 282.0, 3600.0,
            400.0, 12000.0,
        ];
        // Sump and oil in the annulus are nodes 14 and 15 of the publication, the stator is 16, the outlet of the exchanger 17.
        capacities.push(0.0);
        let mut heat = vec![0.0; 18];
        for (node, watts) in [
            (4, 187.5),
            (5, 75.0),
            (6, 37.5),
            (7, 5.0),
            (8, 15.0),
            (9, 40.0),
            (10, 25.0),
            (11, 25.0),
            (12, 8.0),
            (13, 8.0),
            (14, 40.0),
            (16, 600.0),
        ] {
            heat[node] = watts;
        }
        let mut held = vec![None; 18];
        held[0] = Some(0.0);
        held[1] = Some(23.0);
        let circuit = Circuit {
            capacities,
            held,
            links: links.into_iter().map(|(a, b, g)| ([a, b], g)).collect(),
            flows: vec![([17, 15], 100.0), ([15, 14], 100.0), ([17, 14], 100.0)],
            exchangers: vec![Exchange {
                from: 14,
                to: 17,
                oil: 200.0,
                transfer: Arrangement::Counterflow.transfer(300.0, [200.0, 0.12 * 3600.0]),
                coolant: 35.0,
            }],
        };
        (circuit, heat)
    }

    /// The published scheme: the exchanger's outlet is prescribed from the sump temperature of the previous step.
    #[test]
    fn u5k_seventeen_nodes_in_time() {
        let (circuit, heat) = drive_unit();
        close(circuit.exchangers[0].transfer / 200.0, 0.6974399);
        let mut t = vec![23.0; 18];
        let mut lagged = circuit.clone();
        lagged.exchangers.clear();
        for second in 1..=7200 {
            lagged.held[17] = Some(circuit.exchangers[0].outlet(t[14]));
            t = lagged.solve(&heat, Some((1.0, &t))).unwrap();
            let printed: &[(usize, f64)] = match second {
                1 => &[
                    (2, 23.000616),
                    (4, 23.023302),
                    (9, 23.131818),
                    (14, 23.262936),
                    (16, 23.058328),
                    (17, 31.369279),
                ],
                60 => &[
                    (2, 23.631340),
                    (4, 24.840573),
                    (9, 27.321037),
                    (14, 29.263425),
                    (16, 26.449413),
                    (17, 33.256487),
                ],
                600 => &[
                    (2, 32.155091),
                    (4, 37.525723),
                    (9, 37.021983),
                    (14, 35.219075),
                    (16, 38.499898),
                    (17, 35.064097),
                ],
                1800 => &[
                    (2, 39.782634),
                    (4, 46.926593),
                    (9, 44.789050),
                    (14, 39.485164),
                    (16, 45.100488),
                    (17, 36.356607),
                ],
                7200 => &[
                    (2, 41.625649),
                    (4, 49.181208),
                    (9, 46.661816),
                    (14, 40.509544),
                    (16, 46.610521),
                ],
                _ => continue,
            };
            for (node, printed) in printed {
                assert!(
                    (t[*node] - printed).abs() < 1e-6,
                    "{second} s, node {node}: {} against {printed}",
                    t[*node]
                );
            }
        }
        let leaving = circuit.leaving(&t, &heat);
        assert!((leaving.held[1] - 297.380).abs() < 1e-3 && (leaving.exchangers[0] - 768.515).abs() < 1e-3);
        // In steady state all incoming heat leaves, and both schemes agree.
        let rest = circuit.solve(&heat, None).unwrap();
        let all: f64 = heat.iter().sum();
        assert!((circuit.leaving(&rest, &heat).total() - all).abs() < 1e-9 * all);
        assert!(rest.iter().zip(&t).all(|(a, b)| (a - b).abs() < 0.02), "{rest:?} {t:?}");
    }

    #[test]
    fn a_step_keeps_the_energy() {
        let (circuit, heat) = drive_unit();
        let mut t = vec![23.0; 18];
        t[17] = 31.0;
        for duration in [0.01, 1.0, 1000.0] {
            let after = circuit.solve(&heat, Some((duration, &t))).unwrap();
            let supplied: f64 = heat.iter().sum::<f64>() * duration;
            let went = circuit.stored(&t, &after) + circuit.leaving(&after, &heat).total() * duration;
            assert!(
                (supplied - went).abs() < 1e-9 * supplied,
                "{duration}: {supplied} {went}"
            );
            t = after;
        }
    }

    #[test]
    fn oil_that_stands_keeps_the_temperature_of_its_source_and_heat_of_held_nodes_leaves() {
        let (mut circuit, mut heat) = drive_unit();
        for (_, flow) in &mut circuit.flows {
            *flow = 0.0;
        }
        (circuit.exchangers[0].oil, circuit.exchangers[0].transfer) = (0.0, 0.0);
        circuit.held[14] = Some(60.0);
        heat[1] = 7.0;
        let t = circuit.solve(&heat, Some((1.0, &[23.0; 18]))).unwrap();
        assert_eq!(t[17], 60.0);
        let supplied: f64 = heat.iter().sum();
        let went = circuit.stored(&[23.0; 18], &t) + circuit.leaving(&t, &heat).total();
        assert!((supplied - went).abs() < 1e-9 * supplied, "{supplied} {went}");
    }

    #[test]
    fn a_node_without_links_has_no_temperature() {
        let lost = Circuit {
            capacities: vec![0.0; 2],
            held: vec![Some(20.0), None],
            ..Circuit::default()
        };
        assert!(lost.solve(&[0.0, 1.0], None).is_none());
    }
}
