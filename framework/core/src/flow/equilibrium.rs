//! Equilibrium of every member at given losses: one product with the inverse, and one small system for friction; of large trains one
//! elimination.

use super::linear::{eliminate, substitute};
use super::system::{Flow, MeshRow, Response, Solver};
use super::work::{Drive, Work};
use crate::real::{Mask as _, Points, Real};

/// Relative to the fastest speed, speeds below this are rounding error.
const STILL: f64 = 1e-12;

impl Flow {
    /// Torques for the losses in `work.used`, refined to rounding where they are `kept`. Returns where friction leaves a unique
    /// equilibrium; elsewhere the torques are as before.
    #[inline(always)]
    pub(super) fn solve<R: Points>(&self, work: &mut Work<R>, kept: R::Mask) -> R::Mask {
        self.outside(work);
        let regular = self.friction(work);
        self.step(work);
        std::mem::swap(&mut work.unknown, &mut work.step);
        if kept.any() {
            // One step of iterative refinement keeps the balance at rounding.
            self.base.product(&work.unknown, &mut work.residual);
            for (residual, right) in work.residual.iter().zip(&mut work.right) {
                *right -= *residual;
            }
            for &mesh in &work.active {
                let friction = &self.friction[mesh];
                let lost = work.used.share(mesh) * work.unknown[friction.row];
                let side = &friction.sides[driven_side(work.drives[mesh])];
                side.change.add(-lost, &mut work.right);
            }
            self.step(work);
            for (unknown, step) in work.unknown.iter_mut().zip(&work.step) {
                *unknown = R::select(kept, *unknown + *step, *unknown);
            }
        }
        let size = work.unknown[..self.size].iter();
        let size = size.fold(R::ZERO, |sum, x| sum + x.abs());
        let found = regular & size.is_below(R::constant(f64::INFINITY));
        if !found.any() {
            return found;
        }
        let (rows, ports) = work.unknown[..self.size].split_at(self.rows);
        for ((multiplier, x), scale) in work.multipliers.iter_mut().zip(rows).zip(&self.scale) {
            *multiplier = R::select(found, *x * *scale, *multiplier);
        }
        for (port, torque) in self.unknown.iter().zip(ports) {
            work.ports[*port] = R::select(found, *torque, work.ports[*port]);
        }
        self.powers(work);
        found
    }

    /// Copies the values that are constant over all solves of a point: given torques, and the speeds of the gears of each mesh.
    #[inline(always)]
    pub(super) fn prepare<R: Points>(&self, work: &mut Work<R>) {
        work.ports.fill(R::ZERO);
        for (port, torque) in self.given.iter().zip(&work.given) {
            work.ports[*port] += *torque;
        }
        work.multipliers.fill(R::ZERO);
        work.applied.fill(R::ZERO);
        work.applied[..self.columns].copy_from_slice(&work.ports);
        let fastest = work.speeds.iter().fold(R::ZERO, |most, w| most.max(w.abs()));
        for (relative, mesh) in work.relative.iter_mut().zip(&self.meshes) {
            *relative = [mesh.second, mesh.first].map(|gear| relative_speed(gear, mesh, &work.speeds, fastest * STILL));
        }
    }

    /// The right-hand side: given torques, drags, and losses of meshes that are not a share of their power.
    #[inline(always)]
    fn outside<R: Points>(&self, work: &mut Work<R>) {
        for (right, applied) in work.right.iter_mut().zip(&work.applied) {
            *right = -*applied;
        }
        for (right, drag) in work.right.iter_mut().zip(work.used.drags()) {
            *right -= *drag;
        }
        for (k, mesh) in self.meshes.iter().enumerate() {
            let loss = work.used.constant(k);
            let side = driven_side(work.drives[k]);
            let relative = work.relative[k][side];
            let acts = !(loss.is_zero() | relative.is_zero());
            if !acts.any() {
                continue;
            }
            let torque = R::select(acts, loss / relative, R::ZERO);
            if let Some(driven) = [mesh.second, mesh.first][side] {
                work.right[driven] += torque;
            }
            if let Some(carrier) = mesh.carrier {
                work.right[carrier] -= torque;
            }
        }
    }

    /// Factors the system with friction. Returns where it is regular.
    #[inline(always)]
    fn friction<R: Points>(&self, work: &mut Work<R>) -> R::Mask {
        work.active.clear();
        for mesh in 0..self.friction.len() {
            if work.used.share(mesh).is_above(R::ZERO).any() {
                work.active.push(mesh);
            }
        }
        match &self.solver {
            Solver::Inverse { responses, .. } => small_system(responses, work),
            Solver::Elimination { elimination, changed } => {
                elimination.write(&mut work.factors);
                for &mesh in &work.active {
                    let share = work.used.share(mesh);
                    for (place, change) in &changed[mesh][driven_side(work.drives[mesh])] {
                        work.factors[*place] += share * *change;
                    }
                }
                elimination.eliminate(&mut work.factors)
            }
        }
    }

    /// The solution for the right-hand side.
    #[inline(always)]
    fn step<R: Points>(&self, work: &mut Work<R>) {
        match &self.solver {
            Solver::Inverse { inverse, responses } => {
                inverse.product(&work.right, &mut work.step);
                self.respond(responses, work);
            }
            Solver::Elimination { elimination, .. } => {
                work.residual.copy_from_slice(&work.right);
                elimination.solve(&work.factors, &mut work.residual, &mut work.step);
            }
        }
    }

    /// Adds the effect of friction to a solution without it (Sherman, Morrison and Woodbury).
    #[inline(always)]
    fn respond<R: Points>(&self, responses: &[[Response; 2]], work: &mut Work<R>) {
        let n = work.active.len();
        if n == 0 {
            return;
        }
        for (share, &mesh) in work.shares.iter_mut().zip(&work.active) {
            *share = work.step[self.friction[mesh].row];
        }
        substitute(&work.factors[..n * n], &work.order[..n], &mut work.shares[..n]);
        for (share, &mesh) in work.shares.iter().zip(&work.active) {
            let lost = *share * work.used.share(mesh);
            let side = &responses[mesh][driven_side(work.drives[mesh])];
            side.response.add(-lost, &mut work.step);
        }
    }

    /// Rolling powers, the largest internal power, and the losses of meshes as used.
    #[inline(always)]
    fn powers<R: Points>(&self, work: &mut Work<R>) {
        let mut largest = R::ZERO;
        for (k, mesh) in self.meshes.iter().enumerate() {
            let relative = work.relative[k];
            let rolling = -work.multipliers[mesh.row] * mesh.z1 * relative[1];
            largest = largest.max(rolling.abs());
            let still = relative[driven_side(work.drives[k])].is_zero();
            let constant = R::select(still, R::ZERO, work.used.constant(k));
            work.mesh_loss[k] = work.used.share(k) * rolling.abs() + constant;
            work.rolling[k] = rolling;
        }
        for (speed, torque) in work.speeds.iter().zip(&work.ports) {
            largest = largest.max((*speed * *torque).abs());
        }
        work.largest = largest;
    }
}

/// Factors the small system of the meshes with friction: identity plus responses times shares. Returns where it is regular.
#[inline(always)]
fn small_system<R: Points>(responses: &[[Response; 2]], work: &mut Work<R>) -> R::Mask {
    let n = work.active.len();
    for (j, &mesh) in work.active.iter().enumerate() {
        let share = work.used.share(mesh);
        let coupling = &responses[mesh][driven_side(work.drives[mesh])].coupling;
        let column = &mut work.factors[j * n..(j + 1) * n];
        for (entry, &other) in column.iter_mut().zip(&work.active) {
            *entry = share * coupling[other];
        }
        column[j] = column[j] + 1.0;
    }
    eliminate(&mut work.factors[..n * n], &mut work.order[..n])
}

/// Speed of a gear in the carrier's frame; zero if it is rounding error.
#[inline(always)]
fn relative_speed<R: Real>(gear: Option<usize>, mesh: &MeshRow, speeds: &[R], still: R) -> R {
    let speed = |column: Option<usize>| column.map_or(R::ZERO, |c| speeds[c]);
    let relative = speed(gear) - speed(mesh.carrier);
    R::select(relative.abs().is_above(still), relative, R::ZERO)
}

/// Which side of [`super::system::Friction`] and [`Response`] loses torque.
pub(super) fn driven_side(drive: Drive) -> usize {
    usize::from(drive == Drive::Second)
}
