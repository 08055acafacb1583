//! Loads of all supports in the lanes of a block.

use super::SupportLoad;
use super::shaft_loads::{Component, ShaftLoads};
use super::thrust::Taking;
use crate::lanes::{Lane, each, over};

/// Loads of one support in all lanes: what [`SupportLoad`] is for a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadLanes {
    /// Radial loads. \[N\]
    pub radial: Lane,
    /// Axial loads. \[N\]
    pub axial: Lane,
    /// Tilting moments. \[Nm\]
    pub tilting: Lane,
    /// Thrust that nothing on the member takes, signed towards +x; zero when all is well. \[N\]
    pub untaken: Lane,
}

impl LoadLanes {
    /// No load, in any lane.
    pub const NONE: Self = Self {
        radial: Lane::all(0.0),
        axial: Lane::all(0.0),
        tilting: Lane::all(0.0),
        untaken: Lane::all(0.0),
    };

    /// The load of one lane.
    pub fn lane(&self, i: usize) -> SupportLoad {
        SupportLoad {
            radial: self.radial[i],
            axial: self.axial[i],
            tilting: self.tilting[i],
            untaken: self.untaken[i],
        }
    }

    /// Replaces the load of one lane.
    pub fn set(&mut self, i: usize, load: SupportLoad) {
        self.radial[i] = load.radial;
        self.axial[i] = load.axial;
        self.tilting[i] = load.tilting;
        self.untaken[i] = load.untaken;
    }
}

impl Component {
    /// The component in all lanes.
    #[inline(always)]
    fn sum(&self, tangential: &[Lane], speeds: &[f64]) -> Lane {
        let mut sum = Lane::all(self.always);
        for (mesh, signed, magnitude) in &self.meshes {
            let force = &tangential[*mesh];
            sum = if *magnitude == 0.0 {
                each(|i| sum[i] + force[i] * signed)
            } else {
                each(|i| sum[i] + force[i] * signed + force[i].abs() * magnitude)
            };
        }
        for (carrier, part) in &self.planets {
            let factor = speeds[*carrier].powi(2);
            sum = over(&sum, |x| x + factor * part);
        }
        sum
    }
}

#[inline(always)]
fn length(y: &Lane, z: &Lane) -> Lane {
    each(|i| (y[i] * y[i] + z[i] * z[i]).sqrt())
}

impl ShaftLoads {
    /// As [`ShaftLoads::evaluate`] for the tangential forces of a block; to be called within [`crate::lanes::wide`].
    #[inline(always)]
    pub(crate) fn evaluate_abreast(
        &self,
        tangential: &[Lane],
        speeds: &[f64],
        passed: &mut [Lane],
        loads: &mut [LoadLanes],
    ) {
        for (cases, load) in self.cases.iter().zip(&mut *loads) {
            let [y, z, couple_y, couple_z] = &cases.components;
            load.radial = length(&y.sum(tangential, speeds), &z.sum(tangential, speeds));
            // Few supports take a couple.
            load.tilting = if couple_y.is_nothing() && couple_z.is_nothing() {
                Lane::all(0.0)
            } else {
                length(&couple_y.sum(tangential, speeds), &couple_z.sum(tangential, speeds))
            };
            load.axial = Lane::all(0.0);
            load.untaken = Lane::all(0.0);
        }
        let (passed, sizes) = passed.split_at_mut(self.order.len());
        // Without carriers nothing is ever passed on.
        if self.order.iter().any(|member| member.carrier.is_some()) {
            passed.fill(Lane::all(0.0));
            sizes.fill(Lane::all(0.0));
        }
        for (place, member) in self.order.iter().enumerate() {
            let mut thrust = over(&passed[place], |passed| member.always + passed);
            let mut scale = over(&sizes[place], |size| member.always.abs() + size);
            for (mesh, factor) in &member.meshes {
                let force = &tangential[*mesh];
                thrust = each(|i| thrust[i] + factor * force[i]);
                scale = each(|i| scale[i] + (factor * force[i]).abs());
            }
            if let (true, Some((carrier, copies))) = (member.passes, member.carrier) {
                passed[carrier] = each(|i| passed[carrier][i] + thrust[i] * copies);
                sizes[carrier] = each(|i| sizes[carrier][i] + scale[i] * copies);
                continue;
            }
            let untaken = member.taking.share_abreast(&thrust, &scale, loads);
            if let Some((carrier, copies)) = member.carrier {
                passed[carrier] = each(|i| passed[carrier][i] + (thrust[i] - untaken[i]) * copies);
                sizes[carrier] = each(|i| sizes[carrier][i] + scale[i] * copies);
            }
        }
    }
}

impl Taking {
    /// As [`Taking::share`] in all lanes.
    #[inline(always)]
    fn share_abreast(&self, thrust: &Lane, scale: &Lane, loads: &mut [LoadLanes]) -> Lane {
        if let Some([(r, induced_r), (l, induced_l)]) = self.pair {
            let (s_r, s_l) = (
                over(&loads[r].radial, |radial| induced_r * radial),
                over(&loads[l].radial, |radial| induced_l * radial),
            );
            let spring = self.springs.iter().map(|s| s.1).sum::<f64>();
            let thrust = over(thrust, |thrust| thrust + spring);
            let right = |i: usize| thrust[i] + s_l[i] >= s_r[i];
            loads[r].axial = each(|i| loads[r].axial[i] + if right(i) { thrust[i] + s_l[i] } else { s_r[i] });
            loads[l].axial = each(|i| loads[l].axial[i] + if right(i) { s_l[i] } else { s_r[i] - thrust[i] });
            return Lane::all(0.0);
        }
        let mut rest = *thrust;
        for (place, spring) in &self.springs {
            loads[*place].axial = over(&loads[*place].axial, |axial| axial + spring.abs());
            rest = over(&rest, |rest| rest + spring);
        }
        let rest = each(|i| if rest[i].abs() <= 1e-9 * scale[i] { 0.0 } else { rest[i] });
        let mut untaken = Lane::all(0.0);
        for (right, takers) in self.takers.iter().enumerate() {
            let sign = if right == 1 { 1.0 } else { -1.0 };
            let own = over(&rest, |rest| if rest * sign > 0.0 { rest } else { 0.0 });
            for (place, share) in takers {
                loads[*place].axial = each(|i| loads[*place].axial[i] + own[i].abs() * share);
            }
            if takers.is_empty() {
                untaken = each(|i| untaken[i] + own[i]);
            }
        }
        if self.takers.iter().any(Vec::is_empty) {
            for place in &self.supports {
                loads[*place].untaken = untaken;
            }
        }
        untaken
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::lanes::{LANES, wide};

    /// Asserts that loads abreast are those of single points, to the bit.
    pub fn assert_abreast(loads: &ShaftLoads, meshes: usize, speeds: &[f64]) {
        // Forces of both senses and none.
        let tangential: Vec<Lane> = (0..meshes)
            .map(|k| each(|i| 137.0 * (i as f64 - 5.0) * if (i + k) % 3 == 0 { -1.0 } else { 1.0 + 0.1 * k as f64 }))
            .collect();
        let supports = loads.supports;
        let mut together = vec![LoadLanes::NONE; supports];
        let mut passed = vec![Lane::all(0.0); loads.scratch_len()];
        wide(
            #[inline(always)]
            || loads.evaluate_abreast(&tangential, speeds, &mut passed, &mut together),
        );
        for i in 0..LANES {
            let own: Vec<f64> = tangential.iter().map(|lane| lane[i]).collect();
            let mut alone = vec![SupportLoad::default(); supports];
            loads.evaluate(&own, speeds, &mut vec![0.0; loads.scratch_len()], &mut alone);
            for (together, alone) in together.iter().zip(&alone) {
                assert_eq!(together.lane(i), *alone);
            }
        }
    }
}
