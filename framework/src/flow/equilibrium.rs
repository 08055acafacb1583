//! Equilibrium of every member for given losses: one product with the inverse, and one small system for friction.

use super::linear::{add, add_product, back, factor};
use super::system::{Flow, MeshRow};
use super::work::{Drive, Work};

/// Speeds below this of the fastest one are rounding.
const STILL: f64 = 1e-12;

impl Flow {
    /// Torques for the losses in `work.used`; false where friction leaves no unique equilibrium.
    pub(super) fn solve(&self, speeds: &[f64], work: &mut Work, kept: bool) -> bool {
        self.outside(work);
        if !self.friction(work) {
            return false;
        }
        work.residual.copy_from_slice(&work.right);
        work.unknown.fill(0.0);
        // The second turn is one step of refinement, which keeps the balance at rounding where the flow is kept.
        for turn in 0..2 {
            self.step(work);
            add(1.0, &work.step, &mut work.unknown);
            if turn == 1 || !kept {
                break;
            }
            work.residual.copy_from_slice(&work.right);
            add_product(-1.0, &self.base, &work.unknown, &mut work.residual);
            for &k in &work.active {
                let side = &self.friction[k].sides[driven_side(work.drives[k])];
                let lost = work.used.share(k) * work.unknown[self.friction[k].row];
                add(-lost, &side.change, &mut work.residual);
            }
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

    /// Takes over what is the same in every solve of a point: given torques, and the speeds of the gears of each mesh.
    pub(super) fn prepare(&self, speeds: &[f64], torques: &[f64], work: &mut Work) {
        work.ports.fill(0.0);
        for (port, torque) in self.given.iter().zip(torques) {
            work.ports[*port] += torque;
        }
        work.applied.fill(0.0);
        work.applied[..self.columns].copy_from_slice(&work.ports);
        let still = STILL * speeds.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        for (relative, mesh) in work.relative.iter_mut().zip(&self.meshes) {
            *relative = [mesh.second, mesh.first].map(|gear| relative_speed(gear, mesh, speeds, still));
        }
    }

    /// The right side: given torques, drags, and losses of meshes that are no share of their power.
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
        work.active
            .extend((0..self.meshes.len()).filter(|k| work.used.share(*k) > 0.0));
        let count = work.active.len();
        for (j, &k) in work.active.iter().enumerate() {
            let response = &self.friction[k].sides[driven_side(work.drives[k])].response;
            for (i, &other) in work.active.iter().enumerate() {
                let unit = f64::from(u8::from(i == j));
                work.small[j * count + i] = unit + response[self.friction[other].row] * work.used.share(k);
            }
        }
        factor(&mut work.small[..count * count], &mut work.order[..count], count)
    }

    /// The solution for the residual (Sherman, Morrison and Woodbury).
    fn step(&self, work: &mut Work) {
        work.step.fill(0.0);
        add_product(1.0, &self.inverse, &work.residual, &mut work.step);
        let count = work.active.len();
        if count == 0 {
            return;
        }
        for (share, &k) in work.shares.iter_mut().zip(&work.active) {
            *share = work.step[self.friction[k].row];
        }
        back(
            &work.small[..count * count],
            &work.order[..count],
            count,
            &mut work.shares[..count],
        );
        for (share, &k) in work.shares.iter().zip(&work.active) {
            let lost = share * work.used.share(k);
            let response = &self.friction[k].sides[driven_side(work.drives[k])].response;
            add(-lost, response, &mut work.step);
        }
    }

    /// Rolling powers, the largest internal power, and the losses of meshes as used.
    fn powers(&self, speeds: &[f64], work: &mut Work) {
        let mut largest = 0.0_f64;
        for (k, mesh) in self.meshes.iter().enumerate() {
            let relative = work.relative[k];
            let rolling = -work.multipliers[mesh.row] * mesh.z1 * relative[1];
            largest = largest.max(rolling.abs());
            let moves = relative[driven_side(work.drives[k])] != 0.0;
            let constant = if moves { work.used.constant(k) } else { 0.0 };
            work.mesh_loss[k] = work.used.share(k) * rolling.abs() + constant;
            work.rolling[k] = rolling;
        }
        for (speed, torque) in speeds.iter().zip(&work.ports) {
            largest = largest.max((speed * torque).abs());
        }
        work.largest = largest;
    }
}

/// Speed of a gear in the carrier's frame; zero where it is rounding.
fn relative_speed(gear: Option<usize>, mesh: &MeshRow, speeds: &[f64], still: f64) -> f64 {
    let speed = |column: Option<usize>| column.map_or(0.0, |c| speeds[c]);
    let relative = speed(gear) - speed(mesh.carrier);
    if relative.abs() <= still { 0.0 } else { relative }
}

/// Which side of [`super::system::Friction`] loses torque.
fn driven_side(drive: Drive) -> usize {
    usize::from(drive == Drive::Second)
}
