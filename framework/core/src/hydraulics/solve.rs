//! The pressures of the junctions at which no junction gains or loses oil.
//!
//! Every flow grows with the pressure difference that drives it. The excess of a junction is therefore the gradient of a convex function of
//! the pressures, with a symmetric positive definite Jacobian: there is one solution, and Newton steps that are halved while they
//! overshoot converge from any start.

use super::network::{End, Flow, Hydraulics, Inputs, Supply};
use crate::real::{Lane, Mask as _, Points, Real};

/// Maximum number of Newton steps; networks of oil circuits take five to fifteen.
const MOST_STEPS: usize = 200;

/// Maximum number of halvings of a step.
const MOST_HALVINGS: usize = 40;

/// Excess of a junction over the largest flow at which the last, linear step is taken; it squares this error.
const CLOSE: f64 = 1e-9;

/// Step over the largest pressure below which it is the last one.
const STILL: f64 = 1e-12;

/// Slope of the convex function after a step over that before it, above which the step overshoots too far.
const OVERSHOOT: f64 = 0.25;

/// Flow below which a network is stationary. \[m3/s\]
const NOTHING: f64 = 1e-18;

/// Workspace and results of the solution at one point.
#[derive(Debug, Clone)]
pub(crate) struct Work<R> {
    /// Pressure of each junction over the air of the housing. \[Pa\]
    pub pressures: Vec<R>,
    /// What flows through each element.
    pub supplies: Vec<Supply<R>>,
    /// Oil height in each pocket above the lowest point of the raceway. \[m\]
    pub pockets: Vec<R>,
    /// Oil that gears throw on the walls, for ribs that catch it, and the horizontal length of the walls. \[m3/s and m\]
    pub wetting: R,
    pub walls: R,
    /// Oil that gears throw into each pocket through its window. \[m3/s\]
    pub thrown: Vec<R>,
    /// Newton steps of the point that needed most.
    pub steps: usize,
    trial: Vec<R>,
    excess: Vec<R>,
    step: Vec<R>,
    /// Rows of the Jacobian, then of its factor.
    jacobian: Vec<R>,
    flows: Vec<Flow<R>>,
    relieved: Vec<Option<Flow<R>>>,
    gains: Vec<R>,
}

impl<R: Points> Work<R> {
    /// For a network; empty without one.
    pub fn new(network: &Hydraulics) -> Self {
        let (nodes, elements) = (network.junctions.len(), network.elements.len());
        let nothing = Flow {
            flow: R::ZERO,
            slope: R::ZERO,
        };
        Self {
            pressures: vec![R::ZERO; nodes],
            supplies: vec![Supply::default(); elements],
            pockets: vec![R::ZERO; network.pockets.len()],
            wetting: R::ZERO,
            walls: R::constant(1.0),
            thrown: vec![R::ZERO; network.pockets.len()],
            steps: 0,
            trial: vec![R::ZERO; nodes],
            excess: vec![R::ZERO; nodes],
            step: vec![R::ZERO; nodes],
            jacobian: vec![R::ZERO; nodes * nodes],
            flows: vec![nothing; elements],
            relieved: vec![None; elements],
            gains: vec![R::ZERO; elements],
        }
    }
}

impl Work<Lane> {
    /// Takes the results of the point that all points have in common.
    pub fn take_common(&mut self, common: &Work<f64>) {
        for (own, common) in self.supplies.iter_mut().zip(&common.supplies) {
            *own = Supply {
                flow: Lane::constant(common.flow),
                rise: Lane::constant(common.rise),
                relieved: Lane::constant(common.relieved),
                torque: Lane::constant(common.torque),
                displacement: Lane::constant(common.displacement),
            };
        }
        for (own, common) in self.pockets.iter_mut().zip(&common.pockets) {
            *own = Lane::constant(*common);
        }
        (self.wetting, self.walls) = (Lane::constant(common.wetting), Lane::constant(common.walls));
        for (own, common) in self.thrown.iter_mut().zip(&common.thrown) {
            *own = Lane::constant(*common);
        }
    }
}

impl Hydraulics {
    /// Solves the network from the pressures of the air, then the pockets.
    pub(crate) fn solve<R: Points>(&self, at: &Inputs<'_, R>, work: &mut Work<R>) {
        if !self.is_described() {
            return;
        }
        work.pressures.fill(R::ZERO);
        work.wetting = R::ZERO;
        work.thrown.fill(R::ZERO);
        self.solve_from_pressures(at, work);
        self.fill_pockets(at, work);
    }

    /// Solves the network from the pressures in the workspace.
    pub(super) fn solve_from_pressures<R: Points>(&self, at: &Inputs<'_, R>, work: &mut Work<R>) {
        for (gain, element) in work.gains.iter_mut().zip(&self.elements) {
            *gain = self.gain(element, &self.fluid(element, at), at);
        }
        self.flows(at, work, false);
        let mut open = R::mask(|_| true);
        let mut converged = !open;
        for steps in 0..=MOST_STEPS {
            let (excess, largest) = (norm(&work.excess), largest(&work.flows));
            self.factorise(work);
            newton(work);
            // Where channels resist little, the rounding of pressures prevents a smaller excess.
            let still = norm(&work.step).is_below(norm(&work.pressures) * STILL);
            let close = still | !excess.is_above(largest * CLOSE + NOTHING);
            converged = converged | (open & close);
            open = open & !close;
            work.steps = steps;
            if !open.any() || steps == MOST_STEPS {
                break;
            }
            self.advance(at, work, open);
        }
        // The last step is linear, with the flows of the linear laws: they balance to rounding, and have the derivatives of the root.
        for ((supply, element), i) in work.supplies.iter_mut().zip(&self.elements).zip(0..) {
            let step = |end: End| match end {
                End::Node(node) => work.step[node],
                End::Sump | End::Open => R::ZERO,
            };
            let pressure = |end: End| match end {
                End::Node(node) => work.pressures[node] + work.step[node],
                End::Sump | End::Open => R::ZERO,
            };
            let [from, to] = element.ends;
            let flow = &work.flows[i];
            let oil = 1.0 - self.air;
            let relieved = work.relieved[i].map_or(R::ZERO, |own| own.flow + own.slope * step(to));
            let (flow, rise) = (
                (flow.flow + flow.slope * (step(from) - step(to))) * oil,
                pressure(to) - pressure(from),
            );
            let [torque, displacement] = Self::torque(element, flow, rise, at);
            *supply = Supply {
                flow,
                rise,
                relieved: relieved * oil,
                torque,
                displacement,
            }
            .valid(converged);
        }
        for (pressure, step) in work.pressures.iter_mut().zip(&work.step) {
            *pressure = R::select(converged, *pressure + *step, R::constant(f64::NAN));
        }
    }

    /// Flows of all elements and the excess of all junctions, at the trial or the present pressures.
    fn flows<R: Points>(&self, at: &Inputs<'_, R>, work: &mut Work<R>, trial: bool) {
        let Work {
            pressures,
            trial: trials,
            excess,
            flows,
            relieved,
            gains,
            ..
        } = work;
        let pressures = if trial { trials } else { pressures };
        let pressure = |end: End| match end {
            End::Node(node) => pressures[node],
            End::Sump | End::Open => R::ZERO,
        };
        excess.fill(R::ZERO);
        for (i, element) in self.elements.iter().enumerate() {
            let [from, to] = element.ends;
            let driving = pressure(from) - pressure(to) + gains[i];
            let flow = Self::flow(element, driving, &self.fluid(element, at), at);
            if let End::Node(node) = from {
                excess[node] += flow.flow;
            }
            if let End::Node(node) = to {
                excess[node] -= flow.flow;
            }
            relieved[i] = Self::relieved(element, pressure(to));
            if let (Some(relieved), End::Node(node)) = (&relieved[i], to) {
                excess[node] += relieved.flow;
            }
            flows[i] = flow;
        }
    }

    /// Factorises the Jacobian at the present flows (Cholesky).
    fn factorise<R: Points>(&self, work: &mut Work<R>) {
        let n = self.junctions.len();
        let jacobian = &mut work.jacobian;
        jacobian.fill(R::ZERO);
        for (i, element) in self.elements.iter().enumerate() {
            let slope = work.flows[i].slope;
            let [from, to] = element.ends;
            for end in element.ends {
                if let End::Node(node) = end {
                    jacobian[node * n + node] += slope;
                }
            }
            if let [End::Node(from), End::Node(to)] = [from, to] {
                jacobian[from * n + to] -= slope;
                jacobian[to * n + from] -= slope;
            }
            if let (Some(relieved), End::Node(node)) = (&work.relieved[i], to) {
                jacobian[node * n + node] += relieved.slope;
            }
        }
        for column in 0..n {
            for row in column..n {
                let mut sum = jacobian[row * n + column];
                for k in 0..column {
                    sum -= jacobian[row * n + k] * jacobian[column * n + k];
                }
                jacobian[row * n + column] = if row == column {
                    sum.sqrt()
                } else {
                    sum / jacobian[column * n + column]
                };
            }
        }
    }

    /// Takes the step at the open points, halved until it no longer overshoots.
    fn advance<R: Points>(&self, at: &Inputs<'_, R>, work: &mut Work<R>, open: R::Mask) {
        let before = along(work).abs();
        let mut share = R::select(open, R::constant(1.0), R::ZERO);
        for _ in 0..MOST_HALVINGS {
            for ((trial, pressure), step) in work.trial.iter_mut().zip(&work.pressures).zip(&work.step) {
                *trial = *pressure + *step * share;
            }
            self.flows(at, work, true);
            // Negative before the minimum of the convex function along the step.
            let fine = along(work).is_below(before * OVERSHOOT) | !open;
            if fine.all() {
                break;
            }
            share = R::select(fine, share, share * 0.5);
        }
        work.pressures.copy_from_slice(&work.trial);
    }
}

/// The Newton step from the factor and the excess.
fn newton<R: Points>(work: &mut Work<R>) {
    let n = work.step.len();
    let (factor, step) = (&work.jacobian, &mut work.step);
    for row in 0..n {
        let mut sum = -work.excess[row];
        for k in 0..row {
            sum -= factor[row * n + k] * step[k];
        }
        step[row] = sum / factor[row * n + row];
    }
    for row in (0..n).rev() {
        let mut sum = step[row];
        for k in row + 1..n {
            sum -= factor[k * n + row] * step[k];
        }
        step[row] = sum / factor[row * n + row];
    }
}

/// The largest flow of an element at each point. \[m3/s\]
fn largest<R: Real>(flows: &[Flow<R>]) -> R {
    flows.iter().fold(R::ZERO, |most, flow| most.max(flow.flow.abs()))
}

/// Slope of the convex function along the step.
fn along<R: Real>(work: &Work<R>) -> R {
    let products = work.excess.iter().zip(&work.step).map(|(excess, step)| *excess * *step);
    products.fold(R::ZERO, |sum, product| sum + product)
}

/// The largest magnitude at each point.
fn norm<R: Real>(values: &[R]) -> R {
    values.iter().fold(R::ZERO, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::super::network::{Driver, Element, Law, Relief};
    use super::*;
    use crate::attach::Oil;
    use crate::hydraulics::tests::{L_MIN, close};
    use crate::hydraulics::{Channel, Orifice};
    use crate::real::Dual;
    use proptest::prelude::*;

    fn oil<R: Real>(nu: R, rho: f64) -> Oil<R> {
        Oil {
            nu,
            rho: R::constant(rho),
            eta: nu * rho,
            ..Oil::default()
        }
    }

    fn element(ends: [End; 2], law: Law) -> Element {
        Element {
            path: String::new(),
            ends,
            law,
            oil: 0,
            feeds: Vec::new(),
            chamber: None,
            inlet: None,
        }
    }

    fn nozzles(node: usize, count: f64, diameter: f64, length: f64) -> Element {
        let orifice = Orifice {
            diameter,
            length,
            discharge: 0.8,
            count,
        };
        element([End::Node(node), End::Open], Law::Orifice(orifice))
    }

    /// The printed network: a pump with a relief valve, two pipes, three groups of nozzles.
    fn printed() -> Hydraulics {
        let turn = 2.0 * std::f64::consts::PI;
        let pump = Law::Pump {
            driver: Driver::Member(0),
            displacement: 6e-6 / turn,
            leakage: 5e-9,
            regulated: None,
            relief: Some(Relief {
                opens: 4e5,
                conductance: 2e-9,
            }),
        };
        let pipe = |from, to, channel| element([End::Node(from), End::Node(to)], Law::Pipe(channel));
        Hydraulics {
            junctions: ["0", "1", "2"].map(str::to_owned).to_vec(),
            heights: vec![None; 3],
            elements: vec![
                element([End::Sump, End::Node(0)], pump),
                pipe(0, 1, Channel::round(8e-3, 0.4, 1.5)),
                pipe(1, 2, Channel::round(6e-3, 0.3, 1.0)),
                nozzles(1, 3.0, 1e-3, 2e-3),
                nozzles(2, 2.0, 1.5e-3, 3e-3),
                nozzles(2, 4.0, 0.8e-3, 2e-3),
            ],
            ..Hydraulics::default()
        }
    }

    fn solved(network: &Hydraulics, start: &[f64]) -> Work<f64> {
        let mut work = Work::new(network);
        work.pressures.copy_from_slice(start);
        let (speeds, oils) = ([3000.0 * std::f64::consts::PI / 30.0], [oil(1e-5, 830.0)]);
        let at = Inputs {
            speeds: &speeds,
            oils: &oils,
            surface: 0.0,
            incline: None,
        };
        network.solve_from_pressures(&at, &mut work);
        work
    }

    /// The largest excess of a junction over the largest flow.
    fn imbalance(network: &Hydraulics, work: &Work<f64>) -> f64 {
        let mut excess = vec![0.0; network.junctions.len()];
        let mut largest = 0.0_f64;
        for (element, supply) in network.elements.iter().zip(&work.supplies) {
            largest = largest.max(supply.flow.abs());
            for (end, sign) in element.ends.into_iter().zip([1.0, -1.0]) {
                if let End::Node(node) = end {
                    excess[node] += sign * supply.flow;
                }
            }
            if let End::Node(node) = element.ends[1] {
                excess[node] += supply.relieved;
            }
        }
        excess.iter().fold(0.0_f64, |most, excess| most.max(excess.abs())) / largest
    }

    #[test]
    fn the_printed_network() {
        let network = printed();
        for start in [[1e5, 0.9e5, 0.8e5], [0.01e5, 5e5, 0.001e5], [0.0; 3]] {
            let work = solved(&network, &start);
            for (pressure, bar) in work.pressures.iter().zip([4.526_478_5, 4.299_316_6, 4.005_649_0]) {
                close(pressure * 1e-5, bar, 8);
            }
            let flows = [17.984_38, 11.666_63, 8.100_599];
            let shares = [1.188_678 * 3.0, 2.598_062 * 2.0, 0.726_119 * 4.0];
            for (supply, flow) in work.supplies.iter().zip(flows) {
                close(supply.flow / L_MIN, flow, 7);
            }
            for ((supply, all), count) in work.supplies[3..].iter().zip(shares).zip([3.0, 2.0, 4.0]) {
                close(
                    supply.flow / L_MIN / count,
                    all / count,
                    if count < 4.0 { 7 } else { 6 },
                );
            }
            close(work.supplies[0].relieved / L_MIN, 6.317_74, 6);
            assert!(imbalance(&network, &work) < 1e-14);
            assert!(work.steps < 10, "{}", work.steps);
        }
    }

    #[test]
    fn rotation_adds_pressure() {
        let channel = Channel::round(4e-3, 10e-3, 0.0);
        let rotating = Law::Rotating {
            channel,
            count: 1.0,
            member: 0,
            radii: [10e-3, 20e-3],
            swirl: 0.0,
        };
        let mut network = Hydraulics {
            elements: vec![element([End::Sump, End::Open], rotating)],
            ..Hydraulics::default()
        };
        let speeds = [6000.0 * std::f64::consts::PI / 30.0];
        let oils = [oil(1e-5, 830.0)];
        let at = Inputs {
            speeds: &speeds,
            oils: &oils,
            surface: 0.0,
            incline: None,
        };
        let fluid = network.fluid(&network.elements[0], &at);
        close(network.gain(&network.elements[0], &fluid, &at), 49150.6, 6);
        // 1 l/min without swirl at the inlet.
        let [torque, _] = Hydraulics::torque(&network.elements[0], L_MIN, 0.0, &at);
        close(torque, 3.476_70e-3, 6);
        close(torque * speeds[0], 2.184_47, 6);
        // 5 l/min that leave at 40 mm and 18000 rpm take 393 W.
        if let Law::Rotating { radii, .. } = &mut network.elements[0].law {
            radii[1] = 40e-3;
        }
        let speeds = [18000.0 * std::f64::consts::PI / 30.0];
        let at = Inputs { speeds: &speeds, ..at };
        let [torque, _] = Hydraulics::torque(&network.elements[0], 5.0 * L_MIN, 0.0, &at);
        close(torque * speeds[0], 393.2, 4);
    }

    #[test]
    fn a_regulator_limits_and_air_takes_its_share() {
        let mut network = printed();
        if let Law::Pump { regulated, .. } = &mut network.elements[0].law {
            *regulated = Some(10.0 * L_MIN);
        }
        let limited = solved(&network, &[0.0; 3]);
        close(limited.supplies[0].flow / L_MIN, 10.0, 8);
        network.air = 0.1;
        let aerated = solved(&network, &[0.0; 3]);
        close(aerated.supplies[0].flow / L_MIN, 9.0, 8);
        assert!(imbalance(&network, &aerated) < 1e-14);
        let fluid = network.aerated(&oil(1e-5, 830.0));
        close(fluid.nu / 1e-5, 1.2778, 5);
        for (air, factor) in [(0.02, 1.0510), (0.2, 1.6250)] {
            close(
                Hydraulics {
                    air,
                    ..Hydraulics::default()
                }
                .aerated(&oil(1.0, 1.0))
                .nu,
                factor,
                5,
            );
        }
    }

    #[test]
    fn lanes_have_the_bits_of_single_points_and_duals_the_derivatives() {
        let network = printed();
        let viscosities: Vec<f64> = (0..Lane::COUNT).map(|i| 1e-6 * 1.6_f64.powf(i as f64)).collect();
        let nu = |i: usize| viscosities[i];
        let speed = |i: usize| 40.0 * i as f64;
        let mut lanes = Work::new(&network);
        let (speeds, oils) = ([Lane::each(speed)], [oil(Lane::each(nu), 830.0)]);
        network.solve(
            &Inputs {
                speeds: &speeds,
                oils: &oils,
                surface: Lane::ZERO,
                incline: None,
            },
            &mut lanes,
        );
        let alone = |speed: f64, nu: f64| {
            let mut work = Work::new(&network);
            let (speeds, oils) = ([speed], [oil(nu, 830.0)]);
            network.solve(
                &Inputs {
                    speeds: &speeds,
                    oils: &oils,
                    surface: 0.0,
                    incline: None,
                },
                &mut work,
            );
            work
        };
        for i in 0..Lane::COUNT {
            let own = alone(speed(i), nu(i));
            for (together, alone) in lanes.supplies.iter().zip(&own.supplies) {
                assert_eq!(together.flow.at_point(i), alone.flow, "{i}");
                assert_eq!(together.rise.at_point(i), alone.rise);
                assert_eq!(together.relieved.at_point(i), alone.relieved);
            }
        }
        let mut duals = Work::new(&network);
        let (speeds, oils) = ([Dual::variable(200.0, 0)], [oil(Dual::variable(1.3e-5, 1), 830.0)]);
        network.solve(
            &Inputs {
                speeds: &speeds,
                oils: &oils,
                surface: Dual::ZERO,
                incline: None,
            },
            &mut duals,
        );
        for i in 0..network.elements.len() {
            let flow = |speed: f64, nu: f64| alone(speed, nu).supplies[i].flow;
            let by_speed = (flow(200.1, 1.3e-5) - flow(199.9, 1.3e-5)) / 0.2;
            let by_nu = (flow(200.0, 1.301e-5) - flow(200.0, 1.299e-5)) / 2e-8;
            let own = duals.supplies[i].flow;
            assert_eq!(own.value, flow(200.0, 1.3e-5));
            assert!((own.slopes[0] - by_speed).abs() < 1e-5 * by_speed.abs(), "{i}");
            assert!(
                (own.slopes[2] - by_nu).abs() < 1e-4 * by_nu.abs() + 1e-9,
                "{i} {} {by_nu}",
                own.slopes[2]
            );
        }
    }

    /// A random tree of pipes with nozzles at its ends, some loops, and pumps.
    fn random() -> impl Strategy<Value = (Hydraulics, Vec<f64>, f64)> {
        let size = 2..9_usize;
        let network = size.prop_flat_map(|n| {
            let pipes = prop::collection::vec((1e-3..20e-3, 1e-3..2.0, 0.0..5.0, 0..n), n + 2);
            let holes = prop::collection::vec((0.3e-3..4e-3, 0.0..8e-3), n);
            let starts = prop::collection::vec(-1e6..1e7, n);
            let pump = (
                1e-7..2e-5,
                0.0..1e-8,
                prop::option::of(1e-5..1e-3),
                prop::option::of(1e5..1e6),
            );
            (pipes, holes, starts, pump, -6.0..-2.5)
        });
        network.prop_map(|(pipes, holes, starts, pump, nu)| {
            let n = holes.len();
            let mut elements: Vec<Element> = Vec::new();
            for (i, (diameter, length, losses, other)) in pipes.into_iter().enumerate() {
                // The first ones form a tree, the last ones loops.
                let [from, to] = if i == 0 || i >= n {
                    [i % n, (other + 1) % n]
                } else {
                    [i, other % i]
                };
                if from != to {
                    elements.push(element(
                        [End::Node(from), End::Node(to)],
                        Law::Pipe(Channel::round(diameter, length, losses)),
                    ));
                }
            }
            for (node, (diameter, length)) in holes.into_iter().enumerate() {
                elements.push(nozzles(node, 1.0, diameter, length));
            }
            let (displacement, leakage, regulated, opens) = pump;
            let relief = opens.map(|opens| Relief {
                opens,
                conductance: 2e-9,
            });
            let driver = Driver::Motor(300.0);
            elements.push(element(
                [End::Sump, End::Node(0)],
                Law::Pump {
                    driver,
                    displacement,
                    leakage,
                    regulated,
                    relief,
                },
            ));
            let network = Hydraulics {
                junctions: vec![String::new(); n],
                heights: vec![None; n],
                elements,
                ..Hydraulics::default()
            };
            (network, starts, 10.0_f64.powf(nu))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]
        #[test]
        fn random_networks_balance_from_any_start((network, start, nu) in random()) {
            let oils = [oil(nu, 850.0)];
            let at = Inputs { speeds: &[], oils: &oils, surface: 0.0, incline: None };
            let mut work = Work::new(&network);
            network.solve(&at, &mut work);
            prop_assert!(imbalance(&network, &work) <= 1e-12, "{}", imbalance(&network, &work));
            let mut other = Work::new(&network);
            other.pressures.copy_from_slice(&start);
            network.solve_from_pressures(&at, &mut other);
            for (a, b) in work.pressures.iter().zip(&other.pressures) {
                prop_assert!((a - b).abs() <= 1e-7 * work.pressures[0].abs(), "{a} {b} in {} and {} steps", work.steps, other.steps);
            }
            prop_assert!(work.steps < 60 && other.steps < MOST_STEPS, "{} {}", work.steps, other.steps);
            // Without heights and rotation all pressures are between that of the air and that of the pump.
            for pressure in &work.pressures {
                prop_assert!(*pressure >= 0.0 && *pressure <= work.pressures[0] * (1.0 + 1e-9));
            }
        }

        #[test]
        fn more_speed_gives_no_consumer_less((network, _, nu) in random(), factor in 1.0..3.0) {
            let oils = [oil(nu, 850.0)];
            let at = Inputs { speeds: &[], oils: &oils, surface: 0.0, incline: None };
            let flows = |network: &Hydraulics| {
                let mut work = Work::new(network);
                network.solve(&at, &mut work);
                work.supplies.iter().map(|supply| supply.flow).collect::<Vec<_>>()
            };
            let slow = flows(&network);
            let mut fast = network.clone();
            for element in &mut fast.elements {
                if let Law::Pump { driver: Driver::Motor(speed), .. } = &mut element.law {
                    *speed *= factor;
                }
            }
            let holes = network.elements.iter().zip(slow.iter().zip(flows(&fast)));
            for (_, (slow, fast)) in holes.filter(|(element, _)| element.ends[1] == End::Open) {
                prop_assert!(fast >= slow * (1.0 - 1e-9));
            }
        }
    }
}
