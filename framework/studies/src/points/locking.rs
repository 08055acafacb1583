//! Self-locking at a point: the direction in which power cannot flow, and the torques that maintain the equilibrium instead.

use gearloss_framework::evaluate::{Point, PowerFlow, Solution};
use gearloss_framework::flow::Status;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use super::PreparedPoint;

/// Factor on the torque to test whether more torque helps.
const HARDER: f64 = 1.5;

/// The direction in which a transmission locks.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SelfLocking {
    /// Ports that would supply power without losses.
    pub from: Vec<String>,
    /// Ports at which the power would leave.
    pub to: Vec<String>,
    /// Paths of the meshes that lock; of worm drives only, if a torque at another port maintains the equilibrium.
    pub meshes: Vec<String>,
    /// Efficiency in the other direction; absent if there is none.
    #[serde(skip)]
    pub back: Option<f64>,
    /// Torques that the output ports must apply; empty if no torque maintains the equilibrium. \[Nm\]
    #[serde(skip)]
    pub helping: Vec<(String, f64)>,
}

/// Determines whether a solved point is self-locking; with ideal flow it is not.
pub fn self_locking(
    t: &Transmission,
    prepared: &PreparedPoint,
    solution: &Solution<'_>,
    temperatures: &[f64],
) -> Option<SelfLocking> {
    let status = solution.status();
    if prepared.flow == PowerFlow::Ideal || !matches!(status, Status::SelfLocking | Status::Dragged) {
        return None;
    }
    let mut scratch = t.scratch(&prepared.case);
    let mut powers = |flow, factor: f64| {
        let torques: Vec<f64> = prepared.torques.iter().map(|torque| factor * torque).collect();
        let point = Point {
            torques: &torques,
            flow,
            ..prepared.point()
        };
        let solved = t.evaluate(&prepared.case, &point, temperatures, &mut scratch);
        (solved.status(), solved.efficiency(), port_powers(t, &solved))
    };
    let (_, _, ideal) = powers(PowerFlow::Ideal, 1.0);
    let largest = ideal.iter().fold(0.0, |largest: f64, power| largest.max(power.abs()));
    let named = |sense: f64| -> Vec<usize> {
        let passes = |port: &usize| sense * ideal[*port] > 1e-12 * largest;
        (0..ideal.len()).filter(passes).collect()
    };
    let (from, to) = (named(1.0), named(-1.0));
    if from.is_empty() || to.is_empty() {
        return None;
    }
    let (mut meshes, mut helping) = (Vec::new(), Vec::new());
    if status == Status::Dragged {
        let pushed = |powers: &[f64]| to.iter().map(|port| powers[*port]).sum::<f64>();
        let before = pushed(&port_powers(t, solution));
        let (harder, _, after) = powers(PowerFlow::Real, HARDER);
        // If only drag prevents motion, more torque at one side reduces the torque at the other.
        if before <= 0.0 || harder != Status::Dragged || pushed(&after) <= before {
            return None;
        }
        meshes.extend(solution.locked_worms().map(str::to_owned));
        helping = to
            .iter()
            .map(|port| (t.ports()[*port].name.clone(), solution.torque(*port)))
            .collect();
    } else {
        meshes.extend(solution.turned_meshes().map(str::to_owned));
    }
    let (_, back, _) = powers(PowerFlow::Real, -1.0);
    let names = |ports: Vec<usize>| ports.into_iter().map(|port| t.ports()[port].name.clone()).collect();
    Some(SelfLocking {
        from: names(from),
        to: names(to),
        meshes,
        back,
        helping,
    })
}

/// Input powers of the ports. \[W\]
fn port_powers(t: &Transmission, solution: &Solution<'_>) -> Vec<f64> {
    let ports = t.ports().iter().enumerate();
    ports
        .map(|(i, port)| solution.speed(port.member) * solution.torque(i))
        .collect()
}
