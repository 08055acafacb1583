//! The path of contact as quadrature points on its smooth pieces, and how pairs in contact share the load.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact_lines::ContactLines;
use super::gauss;
use super::pair::Pair;

/// How the pairs that are in contact at once share the load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LoadSharing {
    /// Pairs in contact share evenly: one half, one, one half along the path of a spur pair.
    #[default]
    Rigid,
    /// From nothing at first contact to all in single contact, as tip relief does.
    Ramp,
    /// From one third to two thirds in double contact.
    Third,
    /// Evenly over the whole path, the limit of helical gears with a large overlap ratio.
    Uniform,
    /// Evenly along all lines of contact of helical gears, whose length varies; for spur gears as `rigid`.
    ContactLines,
}

/// One quadrature point on the path of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Distance from T1 along the line of action. \[m\]
    pub x: f64,
    /// Weight of the point in an integral along the path. \[m\]
    pub weight: f64,
    /// Share of the mesh's normal force that this pair of teeth carries.
    pub share: f64,
    /// Line load over that of one pair with all the force on its face width.
    pub line: f64,
    /// Number of pairs in contact.
    pub pairs: usize,
}

impl Pair {
    /// Where the path of contact is not smooth: ends of contact, changes of the number of pairs, the pitch point. \[m\]
    pub fn breaks(&self) -> Vec<f64> {
        let [start, _, pitch, _, end] = self.points;
        let mut breaks = vec![start, end];
        if pitch > start && pitch < end {
            breaks.push(pitch);
        }
        for k in 1..=self.contact_ratio.floor() as usize {
            let step = k as f64 * self.base_pitch;
            breaks.extend(
                [start + step, end - step]
                    .into_iter()
                    .filter(|x| *x > start && *x < end),
            );
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-12 * end);
        breaks
    }

    /// Number of pairs in contact when one is at a distance from T1.
    pub fn pairs_at(&self, x: f64) -> usize {
        let [start, .., end] = self.points;
        let before = ((x - start) / self.base_pitch).floor().max(0.0) as usize;
        let behind = ((end - x) / self.base_pitch).floor().max(0.0) as usize;
        1 + before + behind
    }

    /// Share of the normal force on a pair of teeth at a distance from T1.
    ///
    /// The ramps are stated for one to two pairs; with more the even share holds, as for contact lines of spur gears.
    fn share(&self, sharing: LoadSharing, x: f64) -> f64 {
        let [a, b, _, d, e] = self.points;
        let even = 1.0 / self.pairs_at(x) as f64;
        let ramp = |low: f64, high: f64| {
            if x < b {
                low + (high - low) * (x - a) / (b - a)
            } else if x > d {
                low + (high - low) * (e - x) / (e - d)
            } else {
                1.0
            }
        };
        match sharing {
            LoadSharing::Uniform => 1.0 / self.contact_ratio,
            LoadSharing::Ramp if self.contact_ratio < 2.0 => ramp(0.0, 1.0),
            LoadSharing::Third if self.contact_ratio < 2.0 => ramp(1.0 / 3.0, 2.0 / 3.0),
            _ => even,
        }
    }

    /// Places at even distances over the whole path, its ends included, with no weight.
    pub fn even_path(&self, sharing: LoadSharing, places: usize) -> Vec<PathPoint> {
        let lines = match sharing {
            LoadSharing::ContactLines => ContactLines::new(self),
            _ => None,
        };
        let [start, .., end] = self.points;
        let step = (end - start) / (places.max(2) - 1) as f64;
        (0..places.max(2))
            .map(|i| self.place(start + step * i as f64, 0.0, sharing, lines.as_ref()))
            .collect()
    }

    fn place(&self, x: f64, weight: f64, sharing: LoadSharing, lines: Option<&ContactLines>) -> PathPoint {
        let share = lines.map_or_else(|| self.share(sharing, x), |lines| lines.share(x));
        PathPoint {
            x,
            weight,
            share,
            // An inclined line is longer than the face is wide.
            line: if lines.is_some() {
                share * self.base_helix.cos()
            } else {
                share
            },
            pairs: self.pairs_at(x),
        }
    }

    /// Quadrature points, `order` on each smooth piece.
    pub fn path(&self, sharing: LoadSharing, order: usize) -> Vec<PathPoint> {
        let rule = gauss::rule(order);
        let lines = match sharing {
            LoadSharing::ContactLines => ContactLines::new(self),
            _ => None,
        };
        let mut points = Vec::new();
        let mut breaks = self.breaks();
        if let Some(lines) = &lines {
            breaks.extend(lines.kinks(self.points[4]));
            breaks.sort_by(f64::total_cmp);
            breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * self.base_pitch);
        }
        for piece in breaks.windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            for (t, w) in &rule {
                points.push(self.place(middle + half * t, half * w, sharing, lines.as_ref()));
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::geometry::PairSpec;
    use proptest::prelude::*;

    fn pair(helix_angle: f64, facewidth: f64) -> Pair {
        Pair::new(&PairSpec {
            z: [31, 96],
            internal: false,
            normal_module: 1.6e-3,
            pressure_angle: 17.5_f64.to_radians(),
            helix_angle: helix_angle.to_radians(),
            centre_distance: None,
            profile_shift: [Some(0.1), Some(0.0)],
            tip_diameter: [None, None],
            root_diameter: [None, None],
            facewidth,
            tip_shortening: true,
        })
        .unwrap()
    }

    #[test]
    fn contact_lines_of_a_whole_overlap_ratio_carry_evenly() {
        let spur = pair(25.0, 0.01);
        let whole = pair(25.0, 0.01 / spur.overlap_ratio * 2.0);
        assert!((whole.overlap_ratio - 2.0).abs() < 1e-9);
        for point in whole.path(LoadSharing::ContactLines, 3) {
            assert!((point.share * whole.contact_ratio - 1.0).abs() < 1e-6, "{point:?}");
        }
    }

    #[test]
    fn contact_lines_of_spur_gears_are_the_rigid_share() {
        let lines = pair(0.01, 0.02).loss_factor_local(LoadSharing::ContactLines);
        let rigid = pair(0.0, 0.02).loss_factor_local(LoadSharing::Rigid);
        // A helix of a hundredth of a degree is inclined by a thousandth of the path.
        assert!((lines / rigid - 1.0).abs() < 1e-3, "{lines} {rigid}");
        let spur = pair(0.0, 0.02).loss_factor_local(LoadSharing::ContactLines);
        assert!((spur / rigid - 1.0).abs() < 1e-12);
    }

    proptest! {
        /// The pairs in contact carry all of the force, over one cycle.
        #[test]
        fn shares_carry_the_whole_force(helix in 0.0..35.0_f64, facewidth in 0.002..0.06_f64) {
            let pair = pair(helix, facewidth);
            for sharing in [LoadSharing::Rigid, LoadSharing::Uniform, LoadSharing::ContactLines] {
                let whole: f64 = pair.path(sharing, 6).iter().map(|p| p.weight * p.share).sum();
                // Pieces shorter than a millionth of the pitch are left out.
                prop_assert!((whole / pair.base_pitch - 1.0).abs() < 1e-5, "{sharing:?} {}", whole / pair.base_pitch);
            }
        }
    }
}
