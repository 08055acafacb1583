//! The path of contact as quadrature points on its smooth pieces, and how pairs in contact share the load.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// The ramps are stated for one to two pairs; with more the even share holds.
    pub fn share(&self, sharing: LoadSharing, x: f64) -> f64 {
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

    /// Quadrature points, `order` on each smooth piece.
    pub fn path(&self, sharing: LoadSharing, order: usize) -> Vec<PathPoint> {
        let rule = gauss::rule(order);
        let mut points = Vec::new();
        for piece in self.breaks().windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            for (t, w) in &rule {
                let x = middle + half * t;
                points.push(PathPoint {
                    x,
                    weight: half * w,
                    share: self.share(sharing, x),
                    pairs: self.pairs_at(middle),
                });
            }
        }
        points
    }
}
