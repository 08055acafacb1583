//! The oil space of a housing that grade and acceleration incline while it travels: a volume has another level at each inclination.
//!
//! Spaces are exact in steps of half a degree. Between two of them the volumes below surfaces that meet in the middle of the sections are
//! interpolated, so that level and volume remain inverse of each other and no oil is lost.

use super::outline::Outline;
use super::{Disc, Space, Walls};

/// Step of the inclinations at which the space is exact. \[deg\]
const STEP: f64 = 0.5;

/// Greatest inclination in steps: 60 degrees are an acceleration of 17 m/s2 on a level road.
const STEPS: usize = 120;

/// The greatest inclination. \[rad\]
pub const STEEPEST: f64 = STEPS as f64 * STEP * std::f64::consts::PI / 180.0;

/// Inclination of the apparent vertical: rise over run of the road, acceleration (m/s2) and gravity (m/s2). \[rad\]
pub fn apparent_grade(rise: f64, acceleration: f64, gravity: f64) -> f64 {
    // (g sin + a)/(g cos) with the sine and the cosine of the slope of the road.
    (rise + acceleration / gravity * rise.hypot(1.0)).atan()
}

/// How a housing travels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// The upward direction on a level road.
    up: [f64; 3],
    /// The direction of travel, perpendicular to it.
    ahead: [f64; 3],
}

impl Travel {
    /// From the upward direction on a level road and a direction in the housing; `None` if the direction is upwards.
    pub fn new(up: [f64; 3], direction: [f64; 3]) -> Option<Self> {
        let upwards: f64 = up.iter().zip(direction).map(|(a, b)| a * b).sum();
        let across: [f64; 3] = std::array::from_fn(|i| direction[i] - upwards * up[i]);
        let length = across.iter().map(|part| part * part).sum::<f64>().sqrt();
        (length > 1e-6).then(|| Self {
            up,
            ahead: across.map(|part| part / length),
        })
    }

    /// The upward direction at an inclination; positive raises what is ahead. \[rad\]
    #[inline]
    pub fn up(&self, inclination: f64) -> [f64; 3] {
        if inclination == 0.0 {
            return self.up;
        }
        let (sine, cosine) = inclination.sin_cos();
        std::array::from_fn(|i| cosine * self.up[i] + sine * self.ahead[i])
    }

    /// The upward directions at the inclinations whose spaces are exact, from the steepest descent to the steepest climb.
    pub fn ups(&self) -> impl Iterator<Item = [f64; 3]> {
        let degrees = (0..=2 * STEPS).map(|step| (step as f64 - STEPS as f64) * STEP);
        degrees.map(|degrees| self.up(degrees.to_radians()))
    }
}

/// The spaces of all inclinations of a housing that travels.
#[derive(Debug, Clone, PartialEq)]
pub struct Inclinations {
    travel: Travel,
    /// From the steepest descent to the steepest climb, with their upward directions.
    spaces: Vec<([f64; 3], Space)>,
    /// x and y of the middle of the sections, from the datum. \[m\]
    middle: [f64; 2],
}

impl Inclinations {
    /// The spaces of some sections, with the solids in them and the height of the datum at each of [`Travel::ups`]; `middle` is the middle of
    /// the sections along x and y, from the datum (m).
    pub fn new(travel: Travel, sections: &[Outline], at: &[(Vec<Disc>, f64)], middle: [f64; 2]) -> Self {
        let space = |(up, (solids, datum)): ([f64; 3], &(Vec<Disc>, f64))| {
            (up, Space::unchecked(sections, solids.clone(), up, *datum))
        };
        Self {
            travel,
            spaces: travel.ups().zip(at).map(space).collect(),
            middle,
        }
    }

    /// How the housing travels.
    pub fn travel(&self) -> &Travel {
        &self.travel
    }

    /// The upward directions of [`Travel::ups`] with their spaces.
    pub fn exact(&self) -> impl Iterator<Item = ([f64; 3], &Space)> {
        self.spaces.iter().map(|(up, space)| (*up, space))
    }

    /// The space at an inclination. \[rad\]
    #[inline]
    pub fn space(&self, inclination: f64) -> AnySpace<'_> {
        let (before, share) = step(inclination);
        if share == 0.0 {
            let (_, space) = &self.spaces[before];
            return space.into();
        }
        let up = self.travel.up(inclination);
        let [x, y] = self.middle;
        let near = |i: usize| {
            let (own, space) = &self.spaces[i];
            let slope = own[2] / up[2];
            Turned {
                space,
                slope,
                offset: (own[0] - slope * up[0]) * x + (own[1] - slope * up[1]) * y,
            }
        };
        AnySpace {
            near: near(before),
            far: Some((near(before + 1), share)),
        }
    }
}

/// The walls above the level at rest at all inclinations.
#[derive(Debug, Clone, PartialEq)]
pub struct InclinedWalls(
    /// At each of [`Travel::ups`].
    pub Vec<Walls>,
);

impl InclinedWalls {
    /// The walls at an inclination, linear between those of [`Travel::ups`]. \[rad\]
    pub fn at(&self, inclination: f64) -> Walls {
        let (before, share) = step(inclination);
        let near = self.0[before];
        let Some(far) = self.0.get(before + 1).filter(|_| share > 0.0) else {
            return near;
        };
        Walls {
            area: near.area + share * (far.area - near.area),
            length: near.length + share * (far.length - near.length),
            flight: near.flight + share * (far.flight - near.flight),
        }
    }
}

/// Number of the step before an inclination (rad), and the share of the way to the next one. Whole steps are exact, whatever the rounding
/// of the angle.
fn step(inclination: f64) -> (usize, f64) {
    let place = (inclination.to_degrees() / STEP + STEPS as f64).clamp(0.0, 2.0 * STEPS as f64);
    if (place - place.round()).abs() < 1e-9 {
        return (place.round() as usize, 0.0);
    }
    (place as usize, place - place.floor())
}

/// A space with its levels over those of another inclination: both surfaces meet in the middle of the sections.
#[derive(Debug, Clone, Copy)]
struct Turned<'a> {
    space: &'a Space,
    slope: f64,
    offset: f64,
}

impl Turned<'_> {
    fn volume(&self, level: f64) -> [f64; 2] {
        let [volume, area] = self.space.volume(self.offset + self.slope * level);
        [volume, area * self.slope]
    }

    /// A level of the space as one of the other inclination. \[m\]
    fn back(&self, level: f64) -> f64 {
        (level - self.offset) / self.slope
    }
}

/// A space as built, or one between those of two inclinations.
#[derive(Debug, Clone, Copy)]
pub struct AnySpace<'a> {
    near: Turned<'a>,
    /// With its share.
    far: Option<(Turned<'a>, f64)>,
}

impl<'a> From<&'a Space> for AnySpace<'a> {
    fn from(space: &'a Space) -> Self {
        let near = Turned {
            space,
            slope: 1.0,
            offset: 0.0,
        };
        Self { near, far: None }
    }
}

impl AnySpace<'_> {
    /// True if both are one space as built.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.far.is_none() && other.far.is_none() && std::ptr::eq(self.near.space, other.near.space)
    }

    /// Volume of oil below a level, and its derivative. \[m3 and m2\]
    #[inline]
    pub fn volume(&self, level: f64) -> [f64; 2] {
        let Some((far, share)) = &self.far else {
            return self.near.space.volume(level);
        };
        let (near, far) = (self.near.volume(level), far.volume(level));
        std::array::from_fn(|i| near[i] + share * (far[i] - near[i]))
    }

    /// The lowest point. \[m\]
    pub fn bottom(&self) -> f64 {
        match &self.far {
            None => self.near.space.bottom(),
            Some((far, _)) => self
                .near
                .back(self.near.space.bottom())
                .min(far.back(far.space.bottom())),
        }
    }

    /// The highest point. \[m\]
    pub fn top(&self) -> f64 {
        match &self.far {
            None => self.near.space.top(),
            Some((far, _)) => self.near.back(self.near.space.top()).max(far.back(far.space.top())),
        }
    }

    /// The level of a volume of oil; the top for more than fits. \[m\]
    pub fn level(&self, volume: f64) -> f64 {
        if self.far.is_none() {
            return self.near.space.level(volume);
        }
        let ends @ [bottom, top] = [self.bottom(), self.top()];
        if volume >= self.volume(top)[0] {
            return top;
        }
        super::space::level(volume, ends, 0.5 * (bottom + top), |level| self.volume(level))
    }
}
