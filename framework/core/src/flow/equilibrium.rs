//! Equilibrium of every member at given losses: one product with the inverse, and one small system for friction.

use super::linear::{add, back, factor, larger, product};
use super::system::{Flow, MeshRow};
use super::work::{Active, Drive, Work};

/// Relative to the fastest speed, speeds below this are rounding error.
const STILL: f64 = 1e-12;

impl Flow {
    /// Torques for the losses in `work.used`; false if friction leaves no unique equilibrium.
    pub(super) fn solve(&self, speeds: &[f64], work: &mut Work, kept: bool) -> bool {
        self.outside(work);
        if !self.friction(work) {
            return false;
        }
        self.step(work);
        std::mem::swap(&mut work.unknown, &mut work.step);
        if kept {
            // One step of iterative refinement keeps the balance at rounding.
            product(&self.base, &work.unknown, &mut work.residual);
            for (residual, right) in work.residual.iter().zip(&mut work.right) {
                *right -= residual;
            }
            for own in &work.active {
                let lost = own.share * work.unknown[own.row];
                add(-lost, &self.friction[own.mesh].sides[own.side].change, &mut work.right);
            }
            self.step(work);
            add(1.0, &work.step, &mut work.unknown);
        }
        if !work.unknown.iter().all(|x| x.is_finite()) {
            return false;
        }
        for ((multiplier, x), scale) in work.multipliers.iter_mut().zip(&work.unknown).zip(&self.scale) {
            *multiplier = x * scale;
        }
        for (port, torque) in self.unknown.iter().zip(&work.unknown[self.rows..]) {
            work.ports[*port] = *torque;
        }
        self.powers(speeds, work);
        true
    }

    /// Copies the values that are constant over all solves of a point: given torques, and the speeds of the gears of each mesh.
    pub(super) fn prepare(&self, speeds: &[f64], torques: &[f64], work: &mut Work) {
        work.ports.fill(0.0);
        for (port, torque) in self.given.iter().zip(torques) {
            work.ports[*port] += torque;
        }
        work.applied.fill(0.0);
        work.applied[..self.columns].copy_from_slice(&work.ports);
        self.relative(speeds, &mut work.relative);
    }

    /// Speeds of second and first gear of each mesh in the carrier's frame; zero if they are rounding error.
    pub(super) fn relative(&self, speeds: &[f64], relative: &mut [[f64; 2]]) {
        let still = STILL * speeds.iter().fold(0.0, |most, w| larger(most, w.abs()));
        for (relative, mesh) in relative.iter_mut().zip(&self.meshes) {
            *relative = [mesh.second, mesh.first].map(|gear| relative_speed(gear, mesh, speeds, still));
        }
    }

    /// The right-hand side: given torques, drags, and losses of meshes that are not a share of their power.
    fn outside(&self, work: &mut Work) {
        for (right, applied) in work.right.iter_mut().zip(&work.applied) {
            *right = -applied;
        }
        for (right, drag) in work.right.iter_mut().zip(work.used.drags()) {
            *right -= drag;
        }
        for (k, mesh) in self.meshes.iter().enumerate() {
            let loss = work.used.constant(k);
            let side = driven_side(work.drives[k]);
            let relative = work.relative[k][side];
            if loss == 0.0 || relative == 0.0 {
                continue;
            }
            let torque = loss / relative;
            if let Some(driven) = [mesh.second, mesh.first][side] {
                work.right[driven] += torque;
            }
            if let Some(carrier) = mesh.carrier {
                work.right[carrier] -= torque;
            }
        }
    }

    /// Factors the small system of the meshes with friction: identity plus responses times shares.
    fn friction(&self, work: &mut Work) -> bool {
        work.active.clear();
        for (mesh, (friction, drive)) in self.friction.iter().zip(&work.drives).enumerate() {
            let share = work.used.share(mesh);
            if share > 0.0 {
                work.active.push(Active {
                    mesh,
                    row: friction.row,
                    side: driven_side(*drive),
                    share,
                });
            }
        }
        let count = work.active.len();
        for (j, own) in work.active.iter().enumerate() {
            let coupling = &self.friction[own.mesh].sides[own.side].coupling;
            let column = &mut work.small[j * count..(j + 1) * count];
            for (entry, other) in column.iter_mut().zip(&work.active) {
                *entry = coupling[other.mesh] * own.share;
            }
            column[j] += 1.0;
        }
        factor(&mut work.small[..count * count], &mut work.order[..count], count)
    }

    /// The solution for the right-hand side (Sherman, Morrison and Woodbury).
    fn step(&self, work: &mut Work) {
        product(&self.inverse, &work.right, &mut work.step);
        let count = work.active.len();
        if count == 0 {
            return;
        }
        for (share, own) in work.shares.iter_mut().zip(&work.active) {
            *share = work.step[own.row];
        }
        back(
            &work.small[..count * count],
            &work.order[..count],
            count,
            &mut work.shares[..count],
        );
        for (share, own) in work.shares.iter().zip(&work.active) {
            let lost = share * own.share;
            add(-lost, &self.friction[own.mesh].sides[own.side].response, &mut work.step);
        }
    }

    /// Rolling powers, the largest internal power, and the losses of meshes as used.
    fn powers(&self, speeds: &[f64], work: &mut Work) {
        let mut largest = 0.0_f64;
        for (k, mesh) in self.meshes.iter().enumerate() {
            let relative = work.relative[k];
            let rolling = -work.multipliers[mesh.row] * mesh.z1 * relative[1];
            largest = larger(largest, rolling.abs());
            let moves = relative[driven_side(work.drives[k])] != 0.0;
            let constant = if moves { work.used.constant(k) } else { 0.0 };
            work.mesh_loss[k] = work.used.share(k) * rolling.abs() + constant;
            work.rolling[k] = rolling;
        }
        for (speed, torque) in speeds.iter().zip(&work.ports) {
            largest = larger(largest, (speed * torque).abs());
        }
        work.largest = largest;
    }
}

/// Speed of a gear in the carrier's frame; zero if it is rounding error.
fn relative_speed(gear: Option<usize>, mesh: &MeshRow, speeds: &[f64], still: f64) -> f64 {
    let speed = |column: Option<usize>| column.map_or(0.0, |c| speeds[c]);
    let relative = speed(gear) - speed(mesh.carrier);
    if relative.abs() <= still { 0.0 } else { relative }
}

/// Which side of [`super::system::Friction`] loses torque.
fn driven_side(drive: Drive) -> usize {
    usize::from(drive == Drive::Second)
}
