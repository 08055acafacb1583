//! The path of contact as quadrature points on its smooth sections, and load sharing among pairs of teeth.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact_lines::ContactLines;
use super::gauss;
use super::pair::Pair;
use super::ramp::Ramp;
use super::share_table::ShareTable;

/// Load sharing among pairs of teeth in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LoadSharing {
    /// Equal load on all pairs in contact: one half, one, one half along the path of a spur pair.
    #[default]
    Rigid,
    /// From zero at first contact to full load in single contact, as with tip relief. From a contact ratio of two, a triangle over
    /// the whole path, normalised so that the pairs together carry the full force.
    Ramp,
    /// As `ramp`, centred at the pitch point and normalised so that the pairs together carry the full force.
    SymmetricRamp,
    /// From one third to two thirds in double contact; as `rigid` from a contact ratio of two.
    Third,
    /// Constant over the whole path, the limit of helical gears with a large overlap ratio.
    Uniform,
    /// Constant line load over all lines of contact of helical gears, whose length varies; for spur gears as `rigid`.
    ContactLines,
}

/// Distance of the end points of a section from its ends, over its length: far enough that rounding does not move them into the next one.
const INSIDE: f64 = 1e-9;

/// One quadrature point on the path of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Distance from T1 along the line of action. \[m\]
    pub x: f64,
    /// Weight of the point in an integral along the path. \[m\]
    pub weight: f64,
    /// Share of the mesh's normal force that this pair of teeth carries.
    pub share: f64,
    /// Line load of this pair over that of one pair under the full force; the share, unless the load along the face is uneven.
    pub line: f64,
    /// Number of pairs in contact.
    pub pairs: usize,
}

impl Pair {
    /// Kinks of the path of contact: ends of contact, changes of the number of pairs, the pitch point. \[m\]
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

    /// Splits sections close to a base circle, so that no radius of curvature grows more than fourfold over any of them: friction
    /// follows fractional powers of it, which a single polynomial does not approximate. Up to a thousandth of the pitch from the
    /// circle.
    fn break_beside_bases(&self, breaks: &mut Vec<f64>) {
        let least = 1e-3 * self.base_pitch;
        let ends: [(f64, f64); 2] = [(0.0, 1.0), (self.tangent_length, -1.0)];
        // Ring gears have no base circle near the path.
        for (foot, sense) in &ends[..if self.internal { 1 } else { 2 }] {
            let mut more = Vec::new();
            for piece in breaks.array_windows::<2>() {
                let [near, far] = [0, 1].map(|i| (piece[i] - foot) * sense);
                let [near, far] = [near.min(far).max(0.0), near.max(far)];
                let mut radius = (4.0 * near).max(least);
                while radius < 0.999 * far {
                    more.push(foot + sense * radius);
                    radius *= 4.0;
                }
            }
            breaks.extend(more);
            breaks.sort_by(f64::total_cmp);
        }
    }

    /// Number of pairs in contact when one is at a distance from T1.
    pub(crate) fn pairs_at(&self, x: f64) -> usize {
        let [start, .., end] = self.points;
        let before = ((x - start) / self.base_pitch).floor().max(0.0) as usize;
        let behind = ((end - x) / self.base_pitch).floor().max(0.0) as usize;
        1 + before + behind
    }

    /// Equidistant points over the whole path, including its ends, without weights.
    pub fn even_path(&self, sharing: LoadSharing, places: usize) -> Vec<PathPoint> {
        let law = Law::new(self, sharing);
        let [start, .., end] = self.points;
        let step = (end - start) / (places.max(2) - 1) as f64;
        (0..places.max(2))
            .map(|i| self.place((start + step * i as f64).min(end), 0.0, &law))
            .collect()
    }

    fn place(&self, x: f64, weight: f64, law: &Law) -> PathPoint {
        let share = law.share(self, x);
        PathPoint {
            x,
            weight,
            share,
            line: share,
            pairs: self.pairs_at(x),
        }
    }

    fn place_of(&self, x: f64, weight: f64, (table, line): (&ShareTable, Line)) -> PathPoint {
        let row = table.at(x);
        PathPoint {
            x,
            weight,
            share: row.share,
            line: match line {
                Line::Mean => row.line,
                Line::Peak => row.peak,
            },
            pairs: self.pairs_at(x),
        }
    }

    /// Equidistant points as those of [`Self::even_path`], with the shares of a table.
    pub fn even_path_of(&self, table: &ShareTable, line: Line, places: usize) -> Vec<PathPoint> {
        let [start, .., end] = self.points;
        let step = (end - start) / (places.max(2) - 1) as f64;
        (0..places.max(2))
            .map(|i| self.place_of((start + step * i as f64).min(end), 0.0, (table, line)))
            .collect()
    }

    /// Quadrature points as those of [`Self::graded_path`], with the shares of a table. On each section the shares have the integral of share
    /// times sliding that the table has, so that the loss under constant friction does not depend on the number of points. All tables of a
    /// pair have the same points.
    pub fn graded_path_of(&self, table: &ShareTable, line: Line, order: usize, with_ends: bool) -> Vec<PathPoint> {
        let mut breaks = self.breaks();
        self.break_beside_bases(&mut breaks);
        let rule = if with_ends {
            rule_with_ends(order)
        } else {
            gauss::graded_rule(order)
        };
        let mut points = Vec::new();
        for piece in breaks.windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            let first = points.len();
            for (t, w) in &rule {
                points.push(self.place_of(middle + half * t, half * w, (table, line)));
            }
            let arm = |p: &PathPoint| p.weight * p.share * (p.x - self.points[2]).abs();
            let sum: f64 = points[first..].iter().map(arm).sum();
            let exact = table.moment(self, [piece[0], piece[1]]);
            if sum > 0.0 && exact > 0.0 {
                let factor = exact / sum;
                for point in &mut points[first..] {
                    point.share *= factor;
                }
            }
        }
        points
    }

    /// Quadrature points, `order` on each smooth section; for integer powers of the position.
    pub fn path(&self, sharing: LoadSharing, order: usize) -> Vec<PathPoint> {
        self.points_of(sharing, &gauss::rule(order))
    }

    /// Quadrature points, `order` on each smooth section and denser at its ends; for friction, which starts there like fractional
    /// powers of sliding and load.
    pub fn graded_path(&self, sharing: LoadSharing, order: usize) -> Vec<PathPoint> {
        self.points_of(sharing, &gauss::graded_rule(order))
    }

    /// As [`Self::graded_path`], with both ends of every section in addition. They have no weight, and the share of their section.
    pub(crate) fn graded_path_with_ends(&self, sharing: LoadSharing, order: usize) -> Vec<PathPoint> {
        self.points_of(sharing, &rule_with_ends(order))
    }

    fn points_of(&self, sharing: LoadSharing, rule: &[(f64, f64)]) -> Vec<PathPoint> {
        let law = Law::new(self, sharing);
        let mut points = Vec::new();
        let mut breaks = self.breaks();
        match &law {
            Law::Lines(lines) => {
                breaks.extend(lines.kinks(self.points[4]));
                breaks.sort_by(f64::total_cmp);
                breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * self.base_pitch);
            }
            Law::Ramp(ramp) => {
                // Most kinks are already section ends, except for rounding.
                for kink in ramp.kinks() {
                    if breaks.iter().all(|x| (x - kink).abs() > 1e-9 * self.base_pitch) {
                        breaks.push(kink);
                    }
                }
                breaks.sort_by(f64::total_cmp);
            }
            Law::Plain(_) => {}
        }
        self.break_beside_bases(&mut breaks);
        for piece in breaks.windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            for (t, w) in rule {
                points.push(self.place(middle + half * t, half * w, &law));
            }
        }
        points
    }
}

/// Which line load along the face the points of a path have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// That with the friction of the whole face.
    Mean,
    /// The greatest.
    Peak,
}

/// The graded rule with both ends of a section, which have no weight.
fn rule_with_ends(order: usize) -> Vec<(f64, f64)> {
    let end = 1.0 - 2.0 * INSIDE;
    let mut rule = gauss::graded_rule(order);
    rule.insert(0, (-end, 0.0));
    rule.push((end, 0.0));
    rule
}

/// A load sharing, prepared for one pair.
enum Law {
    Ramp(Ramp),
    Lines(ContactLines),
    Plain(LoadSharing),
}

impl Law {
    fn new(pair: &Pair, sharing: LoadSharing) -> Self {
        match sharing {
            LoadSharing::Ramp => Self::Ramp(Ramp::new(pair)),
            LoadSharing::SymmetricRamp => Self::Ramp(Ramp::symmetric(pair)),
            LoadSharing::ContactLines => ContactLines::new(pair).map_or(Self::Plain(LoadSharing::Rigid), Self::Lines),
            LoadSharing::Rigid | LoadSharing::Third | LoadSharing::Uniform => Self::Plain(sharing),
        }
    }

    /// Share of the normal force on a pair of teeth at a distance from T1.
    fn share(&self, pair: &Pair, x: f64) -> f64 {
        let [a, b, _, d, e] = pair.points;
        match self {
            Self::Ramp(ramp) => ramp.share(x),
            Self::Lines(lines) => lines.share(x),
            Self::Plain(LoadSharing::Uniform) => 1.0 / pair.contact_ratio,
            Self::Plain(LoadSharing::Third) if pair.contact_ratio < 2.0 => {
                if x < b {
                    (1.0 + (x - a) / (b - a)) / 3.0
                } else if x > d {
                    (1.0 + (e - x) / (e - d)) / 3.0
                } else {
                    1.0
                }
            }
            Self::Plain(_) => 1.0 / pair.pairs_at(x) as f64,
        }
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
        // A helix angle of a hundredth of a degree is inclined by a thousandth of the path.
        assert!((lines / rigid - 1.0).abs() < 1e-3, "{lines} {rigid}");
        let spur = pair(0.0, 0.02).loss_factor_local(LoadSharing::ContactLines);
        assert!((spur / rigid - 1.0).abs() < 1e-12);
    }

    proptest! {
        /// The pairs in contact carry the full force, over one cycle.
        #[test]
        fn shares_carry_the_whole_force(helix in 0.0..35.0_f64, facewidth in 0.002..0.06_f64) {
            let pair = pair(helix, facewidth);
            for sharing in [LoadSharing::Rigid, LoadSharing::Uniform, LoadSharing::ContactLines] {
                let whole: f64 = pair.path(sharing, 6).iter().map(|p| p.weight * p.share).sum();
                // Sections shorter than a millionth of the pitch are omitted.
                prop_assert!((whole / pair.base_pitch - 1.0).abs() < 1e-5, "{sharing:?} {}", whole / pair.base_pitch);
            }
        }
    }
}
