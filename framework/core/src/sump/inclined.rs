//! The oil space of a housing that grade and acceleration incline while it travels: a volume has another level at each inclination.
//!
//! Spaces are exact in steps of one degree. Between two of them volumes are interpolated, so that level and volume remain inverse of each
//! other and no oil is lost.

use super::outline::Outline;
use super::{Crowded, Disc, Space};

/// Step of the inclinations at which the space is exact. \[deg\]
const STEP: f64 = 1.0;

/// Greatest inclination in steps: 60 degrees are an acceleration of 17 m/s2 on a level road.
const STEPS: usize = 60;

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

    /// The inclinations whose spaces are exact, in degrees, with their upward directions.
    pub fn ups(&self) -> impl Iterator<Item = (f64, [f64; 3])> {
        let degrees = (0..=2 * STEPS).map(|step| (step as f64 - STEPS as f64) * STEP);
        degrees.map(|degrees| (degrees, self.up(degrees.to_radians())))
    }
}

/// The spaces of all inclinations of a housing that travels.
#[derive(Debug, Clone, PartialEq)]
pub struct Inclinations {
    travel: Travel,
    /// From the steepest descent to the steepest climb.
    spaces: Vec<Space>,
}

impl Inclinations {
    /// The spaces of some sections, with the solids in them and the height of the datum at each of [`Travel::ups`].
    ///
    /// # Errors
    /// If solids reach out of the sections at an inclination (deg).
    pub fn new(travel: Travel, sections: &[Outline], at: &[(Vec<Disc>, f64)]) -> Result<Self, (f64, Crowded)> {
        let space = |((degrees, up), (solids, datum)): ((f64, [f64; 3]), &(Vec<Disc>, f64))| {
            Space::new(sections, solids.clone(), up, *datum).map_err(|crowded| (degrees, crowded))
        };
        Ok(Self {
            travel,
            spaces: travel.ups().zip(at).map(space).collect::<Result<_, _>>()?,
        })
    }

    /// How the housing travels.
    pub fn travel(&self) -> &Travel {
        &self.travel
    }

    /// The space at an inclination. \[rad\]
    #[inline]
    pub fn space(&self, inclination: f64) -> AnySpace<'_> {
        let place = (inclination.to_degrees() / STEP + STEPS as f64).clamp(0.0, 2.0 * STEPS as f64);
        // Directions of whole degrees are exact, whatever the rounding of the angle.
        let place = if (place - place.round()).abs() < 1e-9 {
            place.round()
        } else {
            place
        };
        let before = (place as usize).min(2 * STEPS - 1);
        AnySpace {
            near: &self.spaces[before],
            far: &self.spaces[before + 1],
            share: place - before as f64,
        }
    }
}

/// A space as built, or one between those of two inclinations.
#[derive(Debug, Clone, Copy)]
pub struct AnySpace<'a> {
    near: &'a Space,
    far: &'a Space,
    share: f64,
}

impl<'a> From<&'a Space> for AnySpace<'a> {
    fn from(space: &'a Space) -> Self {
        Self {
            near: space,
            far: space,
            share: 0.0,
        }
    }
}

impl AnySpace<'_> {
    /// Volume of oil below a level, and its derivative. \[m3 and m2\]
    #[inline]
    pub fn volume(&self, level: f64) -> [f64; 2] {
        let near = self.near.volume(level);
        if self.share == 0.0 {
            return near;
        }
        let far = self.far.volume(level);
        std::array::from_fn(|i| near[i] + self.share * (far[i] - near[i]))
    }

    /// The lowest point. \[m\]
    pub fn bottom(&self) -> f64 {
        if self.share == 0.0 {
            self.near.bottom()
        } else {
            self.near.bottom().min(self.far.bottom())
        }
    }

    /// The highest point. \[m\]
    pub fn top(&self) -> f64 {
        if self.share == 0.0 {
            self.near.top()
        } else {
            self.near.top().max(self.far.top())
        }
    }

    /// The level of a volume of oil; the top for more than fits. \[m\]
    pub fn level(&self, volume: f64) -> f64 {
        super::space::level(volume, [self.bottom(), self.top()], |level| self.volume(level))
    }
}
