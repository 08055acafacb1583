//! A prismatic section of the oil space: a polygon across the shafts, and a range along them.

/// A section of the inside of the housing.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Corners of a polygon that does not cross itself, as y and z. \[m\]
    pub corners: Vec<[f64; 2]>,
    /// Range along the shafts. \[m\]
    pub range: [f64; 2],
}

impl Outline {
    /// Length along the shafts. \[m\]
    pub fn length(&self) -> f64 {
        self.range[1] - self.range[0]
    }

    /// Area of the polygon. \[m2\]
    pub fn area(&self) -> f64 {
        area(self.corners.iter().copied())
    }

    /// Least and greatest y. \[m\]
    pub fn extent(&self) -> [f64; 2] {
        let y = self.corners.iter().map(|corner| corner[0]);
        [
            y.clone().fold(f64::INFINITY, f64::min),
            y.fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// Length of the sides and area above a level, of points whose height `at` gives. \[m and m2\]
    pub fn above(&self, at: impl Fn([f64; 2]) -> f64, level: f64) -> [f64; 2] {
        let sides = self.edges().map(|[a, b]| {
            let (low, high) = (at(a).min(at(b)), at(a).max(at(b)));
            let share = if high > low {
                ((high - level) / (high - low)).clamp(0.0, 1.0)
            } else {
                f64::from(u8::from(low >= level))
            };
            // Most sides of a hull are below the oil.
            if share > 0.0 {
                share * (b[0] - a[0]).hypot(b[1] - a[1])
            } else {
                0.0
            }
        });
        [sides.sum(), (self.area() - area_below(self, &at, level)).max(0.0)]
    }

    /// Corners of the part below a level, of points whose height `at` gives.
    pub fn below(&self, at: impl Fn([f64; 2]) -> f64, level: f64) -> Vec<[f64; 2]> {
        let mut clipped = Vec::with_capacity(self.corners.len() + 2);
        for [a, b] in self.edges() {
            let (low, high) = (at(a), at(b));
            if low <= level {
                clipped.push(a);
            }
            if (low <= level) != (high <= level) {
                let share = (level - low) / (high - low);
                clipped.push([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]);
            }
        }
        clipped
    }

    /// Pairs of neighbouring corners.
    pub(super) fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// True if two edges that are not neighbours cross or touch, so that the polygon has no inside.
    pub fn crosses_itself(&self) -> bool {
        let edges: Vec<[[f64; 2]; 2]> = self.edges().collect();
        let count = edges.len();
        (0..count).any(|i| {
            let others = (i + 2..count).filter(|j| !(i == 0 && *j == count - 1));
            others.into_iter().any(|j| cross(edges[i], edges[j]))
        })
    }
}

/// Twice the signed area of a triangle.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// True if two edges have a point in common.
fn cross([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let apart = |i: usize| a[i].max(b[i]) < c[i].min(d[i]) || c[i].max(d[i]) < a[i].min(b[i]);
    let sides = turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0;
    sides && !apart(0) && !apart(1)
}

/// Area of a polygon by its corners in order.
fn area(corners: impl Iterator<Item = [f64; 2]> + Clone) -> f64 {
    let Some(first) = corners.clone().next() else {
        return 0.0;
    };
    let next = corners.clone().skip(1).chain([first]);
    // About the first corner, so that a polygon far from the origin has no larger error.
    let twice: f64 = corners.zip(next).map(|(a, b)| turn(first, a, b)).sum();
    0.5 * twice.abs()
}

/// Area of a polygon below a height, over this height: a parabola between two corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Heights of the corners, increasing. \[m\]
    heights: Vec<f64>,
    /// Area at each height, and in the middle to the next one. \[m2\]
    areas: Vec<[f64; 2]>,
    /// Integral of the area from each height to the next one. \[m3\]
    pieces: Vec<f64>,
}

/// Heights that are closer than this are one. \[m\]
const SAME: f64 = 1e-12;

/// Increasing heights without repetition.
pub(super) fn sorted(mut heights: Vec<f64>) -> Vec<f64> {
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|later, first| *later - *first <= SAME);
    heights
}

impl Profile {
    /// The profile of an outline whose points have the height `at` for their y and z.
    pub fn new(outline: &Outline, at: impl Fn([f64; 2]) -> f64) -> Self {
        let heights = sorted(outline.corners.iter().map(|corner| at(*corner)).collect());
        let below = |level: f64| area_below(outline, &at, level);
        let areas: Vec<[f64; 2]> = (0..heights.len())
            .map(|i| {
                let own = heights[i];
                let middle = 0.5 * (own + heights.get(i + 1).copied().unwrap_or(own));
                [below(own), below(middle)]
            })
            .collect();
        let mut profile = Self {
            pieces: Vec::new(),
            heights,
            areas,
        };
        let pieces = profile.heights.windows(2).map(|ends| profile.piece(ends[0], ends[1]));
        profile.pieces = pieces.collect();
        profile
    }

    /// Heights of the corners, increasing. \[m\]
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// Area below a height. \[m2\]
    pub fn area(&self, height: f64) -> f64 {
        let after = self.heights.partition_point(|h| *h <= height);
        if after == 0 {
            return 0.0;
        }
        let [own, middle] = self.areas[after - 1];
        let Some(next) = self.heights.get(after) else {
            return own;
        };
        let u = (height - self.heights[after - 1]) / (next - self.heights[after - 1]);
        let end = self.areas[after][0];
        own + u * ((4.0 * middle - 3.0 * own - end) + u * 2.0 * (own + end - 2.0 * middle))
    }

    /// Mean of the area over a range of heights: of a narrow one it has more digits than the integral. \[m2\]
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        if to > from {
            self.integral([from, to]) / (to - from)
        } else {
            self.area(from)
        }
    }

    /// Integral of the area over the height. \[m3\]
    fn integral(&self, [from, to]: [f64; 2]) -> f64 {
        let first = self.heights.partition_point(|h| *h <= from);
        let last = self.heights.partition_point(|h| *h < to);
        if last <= first {
            return self.piece(from, to);
        }
        let whole = self.pieces[first..last - 1].iter().copied();
        let ends = [
            self.piece(from, self.heights[first]),
            self.piece(self.heights[last - 1], to),
        ];
        [ends[0]].into_iter().chain(whole).chain([ends[1]]).sum()
    }

    /// The integral between two heights without a corner between them: Simpson's rule is exact for a parabola.
    fn piece(&self, a: f64, b: f64) -> f64 {
        (b - a) / 6.0 * (self.area(a) + 4.0 * self.area(0.5 * (a + b)) + self.area(b))
    }
}

/// Area of a polygon below a height.
fn area_below(outline: &Outline, at: impl Fn([f64; 2]) -> f64, level: f64) -> f64 {
    area(outline.below(at, level).iter().copied())
}
