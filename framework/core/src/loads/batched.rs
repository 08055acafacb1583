//! Bearing loads in the lanes of a block.

use super::SupportLoad;
use super::shaft_loads::{ShaftLoads, under};
use super::statics::Reaction;
use super::thrust::Taking;
use crate::lanes::{LANES, Lane, each, gather, is_even, over, wide};

/// Loads of one support in all lanes: the batched [`SupportLoad`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadLanes {
    /// Radial loads. \[N\]
    pub radial: Lane,
    /// Axial loads. \[N\]
    pub axial: Lane,
    /// Tilting moments. \[Nm\]
    pub tilting: Lane,
    /// Untaken thrust of the member, signed towards +x; zero if there is none. \[N\]
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

    /// True if all lanes have the same load, as at an idling gear.
    #[inline]
    pub(crate) fn is_even(&self) -> bool {
        // Usually the last lane decides.
        self.radial[0] == self.radial[LANES - 1]
            && wide(
                #[inline(always)]
                || {
                    let own = [&self.radial, &self.axial, &self.tilting, &self.untaken];
                    own.into_iter().all(is_even)
                },
            )
    }

    /// Replaces the load of one lane.
    pub fn set(&mut self, i: usize, load: SupportLoad) {
        self.radial[i] = load.radial;
        self.axial[i] = load.axial;
        self.tilting[i] = load.tilting;
        self.untaken[i] = load.untaken;
    }
}

/// The length of a force or couple on a support.
#[inline(always)]
fn length(
    start: [f64; 2],
    meshes: &[(usize, [Reaction; 2])],
    part: impl Fn(&Reaction) -> [f64; 2],
    tangential: &[Lane],
) -> Lane {
    let terms = meshes
        .iter()
        .map(|(mesh, [ahead, back])| (&tangential[*mesh], part(ahead), part(back)));
    gather(
        terms,
        start,
        #[inline(always)]
        |[y, z], (forces, ahead, back), i| {
            let force = forces[i];
            let own = |k: usize| force * if force < 0.0 { back[k] } else { ahead[k] };
            [y + own(0), z + own(1)]
        },
        #[inline(always)]
        |[y, z], _| (y * y + z * z).sqrt(),
    )
}

impl ShaftLoads {
    /// As [`ShaftLoads::evaluate`] for the tangential forces of a block; to be called within [`crate::lanes::wide`]. Loads that are
    /// always zero are not written, so they must be [`LoadLanes::NONE`] before the first call.
    #[inline(always)]
    pub(crate) fn evaluate_batched(
        &self,
        tangential: &[Lane],
        speeds: &[f64],
        passed: &mut [Lane],
        loads: &mut [LoadLanes],
    ) {
        for (cases, load) in self.cases.iter().zip(&mut *loads) {
            let start = cases.torqueless(|member| speeds[member]);
            load.radial = match &cases.only {
                Some((mesh, lengths)) => over(&tangential[*mesh], |force| under(lengths, force)),
                None => length(start.force, &cases.meshes, |reaction| reaction.force, tangential),
            };
            // Few supports take a couple.
            if cases.couples {
                load.tilting = length(start.couple, &cases.meshes, |reaction| reaction.couple, tangential);
            }
        }
        let (passed, sizes) = passed.split_at_mut(self.order.len());
        // Without carriers no thrust is passed on.
        let carried = self.order.iter().any(|member| member.carrier.is_some());
        if carried {
            passed.fill(Lane::ZERO);
            sizes.fill(Lane::ZERO);
        }
        for (place, member) in self.order.iter().enumerate() {
            let forces = member.meshes.iter().map(|(mesh, factor)| (*factor, &tangential[*mesh]));
            // The sum, and the sum of the magnitudes.
            let step = |[sum, size]: [f64; 2], (factor, force): (f64, &Lane), i: usize| {
                let own = factor * force[i];
                [sum + own, size + own.abs()]
            };
            let start = [member.always, member.size];
            if let (false, Some((taker, share))) = (carried, member.taking.only()) {
                loads[taker].axial = gather(forces, start, step, |[thrust, scale], _| {
                    settled(thrust, scale).abs() * share
                });
                continue;
            }
            let thrust = gather(forces.clone(), start, step, |[thrust, _], _| thrust);
            let scale = gather(forces, start, step, |[_, scale], _| scale);
            let (thrust, scale) = if carried {
                (
                    each(|i| thrust[i] + passed[place][i]),
                    each(|i| scale[i] + sizes[place][i]),
                )
            } else {
                (thrust, scale)
            };
            let untaken = member.taking.share_batched(&thrust, &scale, loads);
            if let Some((carrier, copies)) = member.carrier {
                passed[carrier] = each(|i| passed[carrier][i] + (thrust[i] - untaken[i]) * copies);
                sizes[carrier] = each(|i| sizes[carrier][i] + scale[i] * copies);
            }
        }
    }
}

/// A sum of forces, or zero if it is rounding error.
#[inline(always)]
fn settled(sum: f64, size: f64) -> f64 {
    if sum.abs() <= 1e-9 * size { 0.0 } else { sum }
}

impl Taking {
    /// The single support that takes thrust in both directions, with its share, if there is no other.
    #[inline(always)]
    fn only(&self) -> Option<(usize, f64)> {
        let simple = self.pair.is_none() && self.springs.is_empty() && self.takers[0] == self.takers[1];
        match &self.takers[0][..] {
            [only] if simple => Some(*only),
            _ => None,
        }
    }

    /// As [`Taking::share`] in all lanes; overwrites the axial loads.
    #[inline(always)]
    fn share_batched(&self, thrust: &Lane, scale: &Lane, loads: &mut [LoadLanes]) -> Lane {
        if let Some((place, share)) = self.only() {
            loads[place].axial = each(|i| settled(thrust[i], scale[i]).abs() * share);
            return Lane::ZERO;
        }
        for place in &self.supports {
            loads[*place].axial = Lane::ZERO;
        }
        if let Some([(r, induced_r), (l, induced_l)]) = self.pair {
            let (s_r, s_l) = (
                over(&loads[r].radial, |radial| induced_r * radial),
                over(&loads[l].radial, |radial| induced_l * radial),
            );
            let spring = self.springs.iter().map(|s| s.1).sum::<f64>();
            let thrust = over(thrust, |thrust| thrust + spring);
            let right = |i: usize| thrust[i] + s_l[i] >= s_r[i];
            loads[r].axial = each(|i| if right(i) { thrust[i] + s_l[i] } else { s_r[i] });
            loads[l].axial = each(|i| if right(i) { s_l[i] } else { s_r[i] - thrust[i] });
            return Lane::ZERO;
        }
        let mut rest = *thrust;
        for (place, spring) in &self.springs {
            loads[*place].axial = over(&loads[*place].axial, |axial| axial + spring.abs());
            rest = over(&rest, |rest| rest + spring);
        }
        let rest = each(|i| settled(rest[i], scale[i]));
        let mut untaken = Lane::ZERO;
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

    /// Asserts that batched loads equal those of single points, to the bit.
    pub fn assert_batched_equals_single(loads: &ShaftLoads, meshes: usize, speeds: &[f64]) {
        // Forces of both signs and zero.
        let tangential: Vec<Lane> = (0..meshes)
            .map(|k| each(|i| 137.0 * (i as f64 - 5.0) * if (i + k) % 3 == 0 { -1.0 } else { 1.0 + 0.1 * k as f64 }))
            .collect();
        let supports = loads.supports;
        let mut together = vec![LoadLanes::NONE; supports];
        let mut passed = vec![Lane::all(0.0); loads.scratch_len()];
        wide(
            #[inline(always)]
            || loads.evaluate_batched(&tangential, speeds, &mut passed, &mut together),
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
