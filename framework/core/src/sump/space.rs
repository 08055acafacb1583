//! The oil space: the volume below a level and the level of a volume, exactly for polygons, with and without inclination.

use super::disc::Disc;
use super::outline::{Outline, Profile, sorted};

/// Sections of a housing below one surface, less the solids in them.
///
/// Between two heights at which a corner meets the surface the volume of the sections is a cubic polynomial of the level, inclined or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// Heights between which the polynomials hold, increasing. \[m\]
    heights: Vec<f64>,
    /// Coefficients over the share of the way to the next height. \[m3\]
    cubics: Vec<[f64; 4]>,
    discs: Vec<Disc>,
    /// Volumes below the heights, between which a level is looked for. \[m3\]
    volumes: Vec<f64>,
}

/// The solids displace more than the outline holds: they reach out of it at this level. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crowded(pub f64);

/// Steps that a root needs at most: those of halving a bracket of a metre to the last bit.
const STEPS: usize = 60;

/// A smaller step than this no longer changes a level. \[m\]
const ROUNDING: f64 = 1e-15;

impl Space {
    /// The space of some sections with solids in them. `up` is the upward direction; a point has the height of its product with it,
    /// less `datum`, so that the surface is level.
    ///
    /// # Errors
    /// If the volume falls while the level rises.
    pub fn new(sections: &[Outline], discs: Vec<Disc>, up: [f64; 3], datum: f64) -> Result<Self, Crowded> {
        let space = Self::unchecked(sections, discs, up, datum);
        match space.falls() {
            Some(level) => Err(Crowded(level)),
            None => Ok(space),
        }
    }

    /// The same, of solids that were checked in another position: a bearing beside a small gear may reach out of a hull a little, which
    /// matters where the surface is narrow. A level then is one of those that have the volume.
    pub(crate) fn unchecked(sections: &[Outline], discs: Vec<Disc>, up: [f64; 3], datum: f64) -> Self {
        let at = |[y, z]: [f64; 2]| up[1] * y + up[2] * z - datum;
        let profiles: Vec<Profile> = sections.iter().map(|section| Profile::new(section, at)).collect();
        let ends = sections.iter().zip(&profiles).flat_map(|(section, profile)| {
            let corners = profile.heights().iter();
            corners.flat_map(|height| section.range.map(|x| height + up[0] * x))
        });
        let heights = sorted(ends.collect());
        let volume = |level: f64| -> f64 {
            let of = |(section, profile): (&Outline, &Profile)| {
                if up[0] == 0.0 {
                    return section.length() * profile.area(level);
                }
                let [from, to] = section.range.map(|x| level - up[0] * x);
                section.length() * profile.mean([from.min(to), from.max(to)])
            };
            sections.iter().zip(&profiles).map(of).sum()
        };
        let cubics = heights.windows(2).map(|ends| {
            let at = |share: f64| volume(ends[0] + share * (ends[1] - ends[0]));
            let [a, b, c, d] = [volume(ends[0]), at(1.0 / 3.0), at(2.0 / 3.0), volume(ends[1])];
            [
                a,
                0.5 * (-11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d),
                4.5 * (2.0 * a - 5.0 * b + 4.0 * c - d),
                4.5 * (3.0 * (b - c) + d - a),
            ]
        });
        let mut space = Self {
            cubics: cubics.collect(),
            heights,
            discs,
            volumes: Vec::new(),
        };
        space.volumes = space.heights.iter().map(|height| space.volume(*height)[0]).collect();
        space
    }

    /// A level at which the volume falls while the level rises, looked for in steps of a hundredth of the height.
    fn falls(&self) -> Option<f64> {
        let (from, step) = (self.bottom(), 0.01 * (self.top() - self.bottom()));
        let levels = (0..100).map(|i| from + (f64::from(i) + 0.5) * step);
        levels.into_iter().find(|level| self.volume(*level)[1] < 0.0)
    }

    /// The lowest point. \[m\]
    pub fn bottom(&self) -> f64 {
        self.heights.first().copied().unwrap_or(0.0)
    }

    /// The highest point. \[m\]
    pub fn top(&self) -> f64 {
        self.heights.last().copied().unwrap_or(0.0)
    }

    /// Volume of oil below a level, and its derivative: the area of the surface. \[m3 and m2\]
    #[inline]
    pub fn volume(&self, level: f64) -> [f64; 2] {
        let after = self.heights.partition_point(|h| *h <= level);
        if after == 0 || self.cubics.is_empty() {
            return [0.0, 0.0];
        }
        let place = (after - 1).min(self.cubics.len() - 1);
        let length = self.heights[place + 1] - self.heights[place];
        let share = ((level - self.heights[place]) / length).min(1.0);
        let [a, b, c, d] = self.cubics[place];
        let mut volume = a + share * (b + share * (c + share * d));
        let mut area = (b + share * (2.0 * c + share * 3.0 * d)) / length;
        for disc in &self.discs {
            let [solid, cut] = disc.below(level);
            volume -= solid;
            area -= cut;
        }
        if level >= self.top() {
            [volume, 0.0]
        } else {
            [volume, area]
        }
    }

    /// Volume of the full space without the solids in it, as the laws use it for the filled share of a case. \[m3\]
    pub fn inside(&self) -> f64 {
        self.cubics.last().map_or(0.0, |[a, b, c, d]| a + b + c + d)
    }

    /// Volume of oil that fills the space. \[m3\]
    pub fn full(&self) -> f64 {
        self.volume(self.top())[0]
    }

    /// The level of a volume of oil; the top for more than fits. \[m\]
    pub fn level(&self, volume: f64) -> f64 {
        let after = self.volumes.partition_point(|below| *below < volume);
        if after == 0 {
            return self.bottom();
        }
        let (Some(above), below) = (self.volumes.get(after), self.volumes[after - 1]) else {
            return self.top();
        };
        let ends @ [low, high] = [self.heights[after - 1], self.heights[after]];
        let linear = low + (volume - below) / (above - below) * (high - low);
        level(volume, ends, linear, |level| self.volume(level))
    }
}

/// The level of a volume between two ends, by the volume below a level and the area of its surface, from a first guess. \[m3, m\]
pub(super) fn level(volume: f64, [mut low, mut high]: [f64; 2], mut level: f64, of: impl Fn(f64) -> [f64; 2]) -> f64 {
    for _ in 0..STEPS {
        let [below, area] = of(level);
        if below < volume {
            low = level;
        } else {
            high = level;
        }
        let next = level - (below - volume) / area;
        if (next - level).abs() <= ROUNDING {
            break;
        }
        // Half the bracket where Newton's step would leave it, as at the jump of the surface at a horizontal edge.
        level = if next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
    }
    level
}
