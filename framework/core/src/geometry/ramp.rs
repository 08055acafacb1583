//! Load that rises and falls along the path of contact as a trapezoid, as with tip relief.
//!
//! A pair of teeth alone would carry raw(s) = min(1, (s - s_A)/l, (s_E - s)/l) with l = min(eps_alpha - 1, eps_alpha/2) p_bt. The
//! loads of the pairs in contact are normalised to a sum of one: f(s) = raw(s) / sum of raw(s + k p_bt). Between one and two pairs
//! the sum is already one, and l is the length of double contact. From two pairs on the trapezoid is a triangle. Up to one pair,
//! raw = 1.

use super::pair::Pair;

/// The trapezoid of one pair of teeth over the path of contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ramp {
    /// Ends of the path. \[m\]
    path: [f64; 2],
    /// Feet of the trapezoid. \[m\]
    feet: [f64; 2],
    /// Length of a flank of the trapezoid; zero if one pair carries all. \[m\]
    rise: f64,
    /// Base pitch. \[m\]
    pitch: f64,
}

impl Ramp {
    /// From first to last contact.
    pub fn new(pair: &Pair) -> Self {
        let [start, .., end] = pair.points;
        let ratio = pair.contact_ratio;
        Self {
            path: [start, end],
            feet: [start, end],
            rise: (ratio - 1.0).min(0.5 * ratio).max(0.0) * pair.base_pitch,
            pitch: pair.base_pitch,
        }
    }

    /// Shifted along the path so that the pitch point is its centre; load outside the path is zero.
    pub fn symmetric(pair: &Pair) -> Self {
        let ramp = Self::new(pair);
        let shift = pair.points[2] - 0.5 * (ramp.path[0] + ramp.path[1]);
        Self {
            feet: ramp.feet.map(|foot| foot + shift),
            ..ramp
        }
    }

    /// Load of a pair before normalisation.
    fn raw(&self, x: f64) -> f64 {
        if x < self.path[0] || x > self.path[1] {
            return 0.0;
        }
        if self.rise == 0.0 {
            return 1.0;
        }
        let [low, high] = self.feet;
        ((x - low).min(high - x) / self.rise).clamp(0.0, 1.0)
    }

    /// Share of the normal force on a pair of teeth at a place on the path.
    pub fn share(&self, x: f64) -> f64 {
        let steps = |length: f64| (length / self.pitch).floor().max(0.0) as usize;
        let (before, behind) = (steps(x - self.path[0]), steps(self.path[1] - x));
        let height = self.raw(x);
        let others: f64 = (1..=before)
            .map(|k| self.raw(x - k as f64 * self.pitch))
            .chain((1..=behind).map(|k| self.raw(x + k as f64 * self.pitch)))
            .sum();
        if height + others > 0.0 {
            height / (height + others)
        } else {
            // A shifted trapezoid may have zero load on all pairs in contact; they then share equally.
            1.0 / (1 + before + behind) as f64
        }
    }

    /// Kinks of the share on the path: the corners of the trapezoid and those of the other pairs. \[m\]
    pub fn kinks(&self) -> Vec<f64> {
        let [low, high] = self.feet;
        let [start, end] = self.path;
        let mut kinks = Vec::new();
        for corner in [low, low + self.rise, high - self.rise, high] {
            let mut x = corner - ((corner - start) / self.pitch).floor() * self.pitch;
            while x < end {
                kinks.push(x);
                x += self.pitch;
            }
        }
        kinks
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{LoadSharing, PairSpec};

    fn spec() -> PairSpec {
        PairSpec {
            z: [31, 81],
            internal: false,
            normal_module: 1.7e-3,
            pressure_angle: 20.0_f64.to_radians(),
            helix_angle: 20.0_f64.to_radians(),
            centre_distance: None,
            profile_shift: [Some(0.12), Some(0.12)],
            tip_diameter: [None, None],
            root_diameter: [None, None],
            facewidth: 0.030,
            tip_shortening: false,
        }
    }

    /// A pair of any contact ratio, with its pitch point at a share of the path.
    fn pair(ratio: f64, pitch_point: f64) -> Pair {
        let base = Pair::new(&spec()).unwrap();
        let [start, ..] = base.points;
        let end = start + ratio * base.base_pitch;
        let pitch = start + pitch_point * (end - start);
        Pair {
            points: [start, end - base.base_pitch, pitch, start + base.base_pitch, end],
            contact_ratio: ratio,
            ..base
        }
    }

    #[test]
    fn u1d_share_of_the_first_stage() {
        let pair = Pair::new(&spec()).unwrap();
        let close = |value: f64, printed: f64| assert!((value / printed - 1.0).abs() < 1e-6, "{value} {printed}");
        close(pair.base_pitch, 0.005299801);
        close(pair.contact_ratio, 1.557373);
        let [start, _, pitch, _, end] = pair.points;
        close(start, 0.006340103);
        close(pitch, 0.01043260);
        close(end, 0.01459387);
        let s = start + 0.3 * (end - start);
        close(s, 0.008816232);
        let ramp = Ramp::new(&pair);
        close(ramp.share(s), 0.8382395);
        close(ramp.share(s + pair.base_pitch), 0.1617605);
    }

    #[test]
    fn one_pair_carries_all_and_two_share_a_triangle() {
        let single = Ramp::new(&pair(0.95, 0.5));
        for t in [0.0, 0.3, 1.0] {
            let x = single.path[0] + t * (single.path[1] - single.path[0]);
            assert_eq!(single.share(x), 1.0);
        }
        // With two pairs the triangles overlap to a constant sum.
        let two = Ramp::new(&pair(2.0, 0.5));
        assert!((two.share(two.path[0] + 0.25 * two.pitch) - 0.25).abs() < 1e-12);
        assert!((two.share(two.path[0] + 1.25 * two.pitch) - 0.75).abs() < 1e-12);
    }

    #[test]
    fn a_pitch_point_in_the_middle_makes_both_ramps_one() {
        let pair = pair(1.6, 0.5);
        let (plain, symmetric) = (Ramp::new(&pair), Ramp::symmetric(&pair));
        for i in 0..=50 {
            let x = plain.path[0] + f64::from(i) / 50.0 * (plain.path[1] - plain.path[0]);
            assert!((plain.share(x) - symmetric.share(x)).abs() < 1e-12);
        }
    }

    #[test]
    fn what_the_shifted_trapezoid_leaves_out_is_carried_by_who_is_in_contact() {
        // The pitch point is at the end of a path with little double contact: no part of the trapezoid reaches its start.
        let pair = pair(1.1, 1.0);
        let ramp = Ramp::symmetric(&pair);
        let x = ramp.path[0] + 0.3 * ramp.pitch;
        assert!(ramp.raw(x) == 0.0 && ramp.share(x) == 1.0);
    }

    proptest! {
        #[test]
        fn pairs_in_contact_carry_the_whole_force(ratio in 0.9..3.2_f64, pitch_point in -0.2..1.2_f64, place in 0.0..1.0_f64) {
            let pair = pair(ratio, pitch_point);
            for ramp in [Ramp::new(&pair), Ramp::symmetric(&pair)] {
                let first = ramp.path[0] + place * ramp.pitch.min(ramp.path[1] - ramp.path[0]);
                let mut sum = 0.0;
                let mut x = first;
                while x <= ramp.path[1] {
                    let share = ramp.share(x);
                    prop_assert!((0.0..=1.0).contains(&share));
                    sum += share;
                    x += ramp.pitch;
                }
                prop_assert!((sum - 1.0).abs() < 1e-9, "{sum}");
            }
        }

        /// The integral along the path is a base pitch only if each kink is a section end.
        #[test]
        fn quadrature_sees_every_kink(ratio in 1.0..3.2_f64, pitch_point in 0.0..1.0_f64) {
            let pair = pair(ratio, pitch_point);
            for (sharing, tolerance) in [(LoadSharing::Ramp, 1e-6), (LoadSharing::SymmetricRamp, 1e-6)] {
                let whole: f64 = pair.path(sharing, 8).iter().map(|p| p.weight * p.share).sum();
                prop_assert!((whole / pair.base_pitch - 1.0).abs() < tolerance, "{sharing:?} {}", whole / pair.base_pitch);
            }
        }

        /// The trapezoid is symmetric about the pitch point.
        #[test]
        fn symmetric_ramps_mirror_at_the_pitch_point(ratio in 1.0..3.2_f64, pitch_point in 0.2..0.8_f64, aside in 0.0..0.2_f64) {
            let pair = pair(ratio, pitch_point);
            let ramp = Ramp::symmetric(&pair);
            let aside = aside * (ramp.path[1] - ramp.path[0]);
            prop_assert!((ramp.raw(pair.points[2] + aside) - ramp.raw(pair.points[2] - aside)).abs() < 1e-9);
        }

        /// From the other gear the path runs backwards, and the load at each point is the same.
        #[test]
        fn exchanged_gears_share_alike(ratio in 1.01..3.2_f64, pitch_point in 0.0..1.0_f64, place in 0.0..1.0_f64) {
            let (one, other) = (pair(ratio, pitch_point), pair(ratio, 1.0 - pitch_point));
            for (a, b) in [(Ramp::new(&one), Ramp::new(&other)), (Ramp::symmetric(&one), Ramp::symmetric(&other))] {
                let length = a.path[1] - a.path[0];
                let (x, y) = (a.path[0] + place * length, b.path[1] - place * length);
                // Steep flanks of short double contact magnify the rounding of a position.
                prop_assert!((a.share(x) - b.share(y)).abs() < 1e-9, "{} {}", a.share(x), b.share(y));
            }
        }
    }
}
