#![allow(clippy::unwrap_used)]

mod epicyclic;
mod large;
mod order;
mod properties;
mod sharing;
mod two_speed;

use super::{
    Balance, Drive, Flow, FlowFault, FlowState, LoadedDrag, MeshRow, Outcome, Reading, Share, Start, Status, Tolerance,
    Work,
};
use crate::kinematics::{Motion, Row, Train};

/// A train under test: columns, meshes with a constant share of loss, other rows.
#[derive(Debug, Clone, Default)]
struct Rig {
    columns: usize,
    meshes: Vec<(MeshRow, f64)>,
    rows: Vec<Row>,
    /// Pairs of columns with a drag moment between them.
    drags: Vec<(Option<usize>, Option<usize>, f64)>,
    /// Columns with a drag that depends on torques.
    loaded: Vec<usize>,
    shares: Vec<Share>,
}

impl Rig {
    fn new(columns: usize) -> Self {
        Self {
            columns,
            ..Self::default()
        }
    }
    fn mesh(mut self, first: usize, z1: f64, second: usize, sz2: f64, carrier: Option<usize>, zeta: f64) -> Self {
        let row = self.rows.len();
        let mesh = MeshRow {
            row,
            first: Some(first),
            z1,
            second: Some(second),
            sz2,
            carrier,
            steep: zeta > 0.5,
        };
        self.rows.push(Row::mesh(Some(first), z1, Some(second), sz2, carrier));
        self.meshes.push((mesh, zeta));
        self
    }
    fn join(mut self, a: usize, b: Option<usize>) -> Self {
        self.rows.push(Row::joined(Some(a), b));
        self
    }
    fn drag(mut self, a: Option<usize>, b: Option<usize>, moment: f64) -> Self {
        self.drags.push((a, b, moment));
        self
    }
    fn loaded(mut self, column: usize) -> Self {
        self.loaded.push(column);
        self
    }
    /// Drags that may depend on the torques of all meshes.
    fn loaded_drags(&self) -> Vec<LoadedDrag> {
        let drags = self.loaded.iter().map(|column| LoadedDrag {
            component: 0,
            between: [Some(*column), None],
            reads: (0..self.meshes.len()).map(Reading::Row).collect(),
            group: None,
        });
        drags.collect()
    }
    /// Motion and flow with the ports of which some have a given speed and some a given torque.
    fn flow(&self, ports: &[usize], speed_ports: &[usize], torque_ports: &[usize]) -> (Motion, Flow) {
        let train = self.train();
        let motion = Motion::new(&train, ports, speed_ports).unwrap();
        let unknown = ports.iter().copied().filter(|p| !torque_ports.contains(p)).collect();
        let meshes = self.meshes.iter().map(|m| m.0).collect();
        let ports = (unknown, torque_ports.to_vec());
        let flow = Flow::new(
            &train,
            meshes,
            self.shares.clone(),
            &motion.loops,
            ports,
            self.loaded_drags(),
        )
        .unwrap();
        (motion, flow)
    }
    fn train(&self) -> Train {
        Train {
            columns: self.columns,
            rows: self.rows.clone(),
        }
    }
}

struct Solved {
    speeds: Vec<f64>,
    work: Work,
    outcome: Outcome,
    drag_loss: f64,
}

impl Solved {
    fn loss(&self) -> f64 {
        self.work.mesh_loss.iter().sum::<f64>() + self.drag_loss
    }
    fn balance(&self, ports: &[usize]) -> Balance {
        Balance::from_powers(self.powers(ports))
    }
    fn status(&self, ports: &[usize]) -> Status {
        Status::from_powers(self.balance(ports), self.powers(ports), 0)(0)
    }
    fn powers(&self, ports: &[usize]) -> impl Iterator<Item = f64> + Clone {
        ports.iter().map(|p| self.work.ports[*p] * self.speeds[*p])
    }
    fn passes(&self) -> usize {
        match self.outcome {
            Outcome::Converged { passes } => passes,
            other => panic!("{other:?}"),
        }
    }
    fn efficiency(&self, ports: &[usize]) -> f64 {
        self.balance(ports).efficiency().unwrap()
    }
}

/// Solves to 1e-12 with the law `loss(mesh, torque of the driver, relative speed of the driver)` per mesh, and the torques that drags
/// apply to the loaded columns.
fn solve_with(
    rig: &Rig,
    ports: &[usize],
    speed_ports: &[(usize, f64)],
    torque_ports: &[(usize, f64)],
    law: impl Fn(usize, f64, f64) -> f64,
    extra: impl Fn(&FlowState<'_>) -> Vec<f64>,
) -> Solved {
    solve_to(1e-12, rig, ports, speed_ports, torque_ports, law, extra)
}

fn solve_to(
    power: f64,
    rig: &Rig,
    ports: &[usize],
    speed_ports: &[(usize, f64)],
    torque_ports: &[(usize, f64)],
    law: impl Fn(usize, f64, f64) -> f64,
    extra: impl Fn(&FlowState<'_>) -> Vec<f64>,
) -> Solved {
    let columns = |given: &[(usize, f64)]| -> Vec<usize> { given.iter().map(|p| p.0).collect() };
    let (motion, flow) = rig.flow(ports, &columns(speed_ports), &columns(torque_ports));
    let mut speeds = vec![0.0; rig.columns];
    motion.speeds(&speed_ports.iter().map(|p| p.1).collect::<Vec<_>>(), &mut speeds);
    let mut work = flow.work();
    work.given = torque_ports.iter().map(|p| p.1).collect();
    work.speeds.clone_from(&speeds);
    let tolerance = Tolerance { power, passes: 60 };
    for (a, b, moment) in &rig.drags {
        let speed = |c: Option<usize>| c.map_or(0.0, |c: usize| speeds[c]);
        let delta = speed(*a) - speed(*b);
        if delta.abs() > 1e-12 * speed(*a).abs().max(speed(*b).abs()) {
            if let Some(a) = a {
                work.steady[*a] -= moment * delta.signum();
            }
            if let Some(b) = b {
                work.steady[*b] += moment * delta.signum();
            }
        }
    }
    let outcome = flow.real(tolerance, Start::Lossless, &mut work, |state: &mut FlowState<'_>| {
        for &k in &state.laws.meshes {
            let mesh = rig.meshes[k].0;
            let speed = |c: Option<usize>| c.map_or(0.0, |c| state.speeds[c]);
            let lambda = state.multipliers[mesh.row].abs();
            let (z, column) = if state.drives[k] == Drive::Second {
                (mesh.sz2, mesh.second)
            } else {
                (mesh.z1, mesh.first)
            };
            let relative = speed(column) - speed(mesh.carrier);
            let relative = if relative.abs() < 1e-12 * speed(column).abs() {
                0.0
            } else {
                relative
            };
            state.mesh_loss[k] = law(k, lambda * z.abs(), relative.abs());
        }
        let torques = extra(state);
        for &drag in &state.laws.drags {
            state.moments[drag] = -torques[rig.loaded[drag]];
        }
    });
    let drag_loss = -work.drags.iter().zip(&speeds).map(|(d, w)| d * w).sum::<f64>();
    Solved {
        speeds,
        work,
        outcome,
        drag_loss,
    }
}

fn solve(rig: &Rig, ports: &[usize], speed_ports: &[(usize, f64)], torque_ports: &[(usize, f64)]) -> Solved {
    solve_with(
        rig,
        ports,
        speed_ports,
        torque_ports,
        |k, torque, speed| rig.meshes[k].1 * torque * speed,
        |_| Vec::new(),
    )
}

fn close(value: f64, printed: f64, scale: f64) {
    assert!(
        (value - printed).abs() <= 1e-7 * scale.abs().max(printed.abs()),
        "{value} against {printed}"
    );
}

fn rpm(n: f64) -> f64 {
    n * std::f64::consts::PI / 30.0
}
