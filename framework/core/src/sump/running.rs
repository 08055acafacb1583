//! The level while gears lift oil out of the sump: what is on the walls and in the air is missing from it.
//!
//! No open formula for this level was found. Two estimates bracket it, derived here from textbook parts:
//! - *film*: a gear cannot lift more oil than its churning power accelerates to the speed of its rim: Q = c P/(rho v^2), c at most 2 by
//!   energy, 1 by momentum, and not more than full tooth spaces carry, v b (R_a^2 - R_f^2)/(4 R_a). The oil flies for half the inside height
//!   and runs down the walls as a film, of which a wall that is sprayed evenly holds 3/4. Below 1.5 m/s nothing is thrown off, above 3 m/s
//!   (Changenet and Velex 2008) all of it; the step between is a convention. A gear that has emptied its pool lifts less, also by
//!   convention. Windows and ribs keep oil off the walls, and pockets hold some of it.
//! - *effective depth*: h_eff/h_0 of Shore and others, from the torque on one gear in a tight case up to 90 m/s.

use super::AnySpace;
use super::films::{drawn, film, left_on_flank};
use crate::immersion::Height;
use crate::real::{Points, Real};

/// Gravity as Shore rounds it. \[m/s2\]
const SHORE_G: f64 = 9.8;

/// Rim speed from which all lifted oil is thrown off; half of it throws off none. \[m/s\]
pub const LEAST_SPLASH: f64 = 3.0;

/// Factor c of the lifted flow: of the highest level, of the usual one, and of the lowest. The bound by energy is 2.
pub const CAPTURE: [f64; 3] = [0.3, 1.0, 2.0];

/// A gear that may lift oil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lift {
    /// Height of its axis, or of the centre of its orbit. \[m\]
    pub height: f64,
    /// Depth across the shafts per height along the upward direction.
    pub slope: f64,
    /// Radius of its orbit. \[m\]
    pub orbit: f64,
    /// Radii of tip, reference and root circle. \[m\]
    pub radii: [f64; 3],
    /// Face width, of all copies. \[m\]
    pub width: f64,
    /// Number of teeth.
    pub teeth: f64,
}

impl Lift {
    /// Immersion depth of the tip circle at a level, with the height and slope of its axis as built. \[m\]
    #[inline]
    pub fn tip_dip<R: Real>(&self, level: R) -> R {
        self.tip_dip_at(level, [self.height, self.slope].map(R::constant))
    }

    /// The same with the height and slope of its axis at an inclination.
    #[inline]
    pub fn tip_dip_at<R: Real>(&self, level: R, axis: [R; 2]) -> R {
        self.height_at(level, axis).dip(self.radii[0])
    }

    /// Height of a level above an axis, across the shafts. \[m\]
    #[inline]
    fn height_at<R: Real>(&self, level: R, [height, slope]: [R; 2]) -> Height<R> {
        Height {
            level: (level - height) * slope,
            orbit: self.orbit,
        }
    }

    /// Thickness of the oil that full tooth spaces carry: half of the ring between tip and root is space. \[m\]
    pub fn carried(&self) -> f64 {
        let [tip, _, root] = self.radii;
        (tip * tip - root * root) / (4.0 * tip)
    }

    /// What the gear throws off while the oil stands at a level (m), with a factor c: less from a pool that it has emptied. \[m3/s\]
    #[inline]
    pub fn thrown<R: Points>(&self, gear: &Lifted<R>, level: R, capture: f64) -> R {
        let pool = (self.tip_dip_at(level, gear.axis) / (2.0 * self.carried())).at_most(1.0);
        gear.flow(capture) * pool
    }

    /// What the gear lifts by its churning power (W) at its speed (rad/s) in oil of a density (kg/m3), with c = 1.
    #[inline]
    pub fn lifted<R: Real>(&self, power: R, speed: R, rho: R) -> Lifted<R> {
        let omega = speed.abs();
        let rim = omega * self.radii[0];
        let least = 0.5 * LEAST_SPLASH;
        let x = ((rim - R::constant(least)) / least).at_least(0.0).at_most(1.0);
        let thrown = x * x * (R::constant(3.0) - x * 2.0);
        let fast = rim.at_least(least);
        Lifted {
            flow: thrown * power / (rho * fast * fast),
            most: thrown * fast * self.width * self.carried(),
            rim: fast,
            omega,
            axis: [self.height, self.slope].map(R::constant),
        }
    }
}

/// What a gear lifts at one point, if its pool is deep enough.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lifted<R = f64> {
    /// Flow with c = 1. \[m3/s\]
    pub flow: R,
    /// Flow of full tooth spaces. \[m3/s\]
    pub most: R,
    /// Speed of the rim, at least that at which oil is thrown off. \[m/s\]
    pub rim: R,
    /// Magnitude of the speed. \[rad/s\]
    pub omega: R,
    /// Height of its axis (m), and depth across the shafts per height, at the inclination of the point.
    pub axis: [R; 2],
}

impl<R: Points> Lifted<R> {
    /// The flow with a factor c. \[m3/s\]
    #[inline]
    fn flow(&self, capture: f64) -> R {
        Real::min(self.flow * capture, self.most)
    }

    /// The same in other numbers.
    fn map<T>(self, of: impl Fn(R) -> T) -> Lifted<T> {
        Lifted {
            flow: of(self.flow),
            most: of(self.most),
            rim: of(self.rim),
            omega: of(self.omega),
            axis: self.axis.map(&of),
        }
    }
}

/// Where oil is that does not stand in the sump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walls<R = f64> {
    /// Inside wall above the sump on which oil runs down. \[m2\]
    pub area: R,
    /// Horizontal length of that wall. \[m\]
    pub length: R,
    /// Mean path of flight from the rim to the wall. \[m\]
    pub flight: R,
}

impl<R> Walls<R> {
    /// The same in other numbers.
    pub fn map<T>(self, of: impl Fn(R) -> T) -> Walls<T> {
        Walls {
            area: of(self.area),
            length: of(self.length),
            flight: of(self.flight),
        }
    }
}

/// What catches thrown oil before it runs down the walls.
pub trait Catchers<R> {
    /// What they take of a flow (m3/s) that gears throw at walls of a horizontal length (m). `of` takes the numbers of one point, or of all;
    /// `gear` gives the immersion depth of the tip circle of a gear, by its number among those that lift oil (m), and what it throws (m3/s).
    fn caught<T: Points>(
        &self,
        of: impl Fn(R) -> T + Copy,
        gear: impl Fn(usize) -> [T; 2] + Copy,
        flow: T,
        length: T,
    ) -> Caught<T>;
}

/// Oil that does not run down the walls.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Caught<T> {
    /// What flies through windows. \[m3/s\]
    pub through: T,
    /// Share of the film that ribs keep off the walls. \[-\]
    pub bare: T,
    /// Oil that stands in pockets. \[m3\]
    pub held: T,
}

/// Oil that is not in the sump, and the flow that brings it where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outside<T> {
    /// What the gears lift. \[m3/s\]
    pub flow: T,
    /// What reaches the walls. \[m3/s\]
    pub wetting: T,
    /// Oil on the walls. \[m3\]
    pub on_walls: T,
    /// Oil in the air. \[m3\]
    pub in_air: T,
    /// Oil in pockets. \[m3\]
    pub in_pockets: T,
}

impl<T: Real> Outside<T> {
    /// What is missing from the sump. \[m3\]
    pub fn missing(&self) -> T {
        self.on_walls + self.in_air + self.in_pockets
    }
}

/// Effective over static depth after Shore: filled share of the case, speed (rad/s), reference radius (m), viscosity (m2/s). \[-\]
#[inline]
pub fn effective_share<R: Real>(fill: R, omega: R, radius: f64, nu: R) -> R {
    // At standstill the depth is the static one.
    let omega = omega.at_least(1e-3);
    let froude = omega * omega * (radius / SHORE_G);
    let reynolds = omega * (radius * radius) / nu;
    // Beyond 20 the hyperbolic tangent is one.
    let x = (reynolds.power(0.4) / froude + 0.2).at_most(20.0);
    let tanh = R::constant(1.0) - R::constant(2.0) / ((x * 2.0).exp() + 1.0);
    fill + (R::constant(1.0) - fill) * tanh
}

/// The oil level while rotating, with its band. \[m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band<R = f64> {
    /// Films with c = 0.3, 1 and 2.
    pub films: [R; 3],
    /// By the effective depth of Shore.
    pub effective: R,
}

impl<R: Real> Band<R> {
    /// Lowest estimate.
    pub fn low(&self) -> R {
        let [a, _, b] = self.films;
        Real::min(Real::min(a, b), self.effective)
    }

    /// Highest estimate.
    pub fn high(&self) -> R {
        let [a, _, b] = self.films;
        Real::max(Real::max(a, b), self.effective)
    }

    /// The level at a place in the band: the lowest at -1, the usual one at 0, the highest at 1.
    pub fn at(&self, place: f64) -> R {
        let central = self.films[1];
        let end = if place < 0.0 { self.low() } else { self.high() };
        end * place.abs() + central * (1.0 - place.abs())
    }
}

/// A sump whose gears lift oil, at one point.
pub struct Running<'a, R, S, C> {
    /// The oil space at each point.
    pub space: S,
    /// Volume of the space without the solids in it. \[m3\]
    pub inside: f64,
    /// Its walls at each point.
    pub walls: Walls<R>,
    /// The gears in it.
    pub lifts: &'a [Lift],
    /// What each gear lifts.
    pub lifted: &'a [Lifted<R>],
    /// Level at rest. \[m\]
    pub rest: R,
    /// Volume of oil below the level at rest. \[m3\]
    pub stock: R,
    /// Viscosity of the oil on the walls. \[m2/s\]
    pub nu: R,
    /// What catches oil before it reaches the walls.
    pub catchers: C,
    /// Points whose bit is not set are equal to the one before.
    pub starts: u32,
}

/// Steps of the search of a level, which halves its bracket in every fourth.
const STEPS: usize = 200;

/// Width of a bracket within which a level is found. \[m\]
const CLOSE: f64 = 1e-13;

/// Share of the volume within which the balance closes before the last step.
const ENOUGH: f64 = 1e-14;

/// Half the step of the differences for the slope of the balance. \[m\]
const STEP: f64 = 1e-6;

impl<'s, R: Points, S: Fn(usize) -> AnySpace<'s>, C: Catchers<R>> Running<'_, R, S, C> {
    /// Oil that is missing from the sump at a level (m), with a factor c. `of` takes the numbers of one point, or of all.
    #[inline]
    pub fn outside<T: Points>(&self, of: impl Fn(R) -> T + Copy, level: T, capture: f64) -> Outside<T> {
        let walls = self.walls.map(of);
        let (mut flow, mut air) = (T::ZERO, T::ZERO);
        for (lift, lifted) in self.lifts.iter().zip(self.lifted) {
            let gear = lifted.map(of);
            let own = lift.thrown(&gear, level, capture);
            flow += own;
            air += own * walls.flight / gear.rim;
        }
        let thrown = |i: usize| {
            let (lift, gear) = (&self.lifts[i], self.lifted[i].map(of));
            [lift.tip_dip_at(level, gear.axis), lift.thrown(&gear, level, capture)]
        };
        let caught = self.catchers.caught(of, thrown, flow, walls.length);
        let wetting = (flow - caught.through).at_least(0.0);
        let wall = film(wetting / walls.length, of(self.nu)) * (walls.area * 0.75) * (T::constant(1.0) - caught.bare);
        let still = flow.is_zero();
        Outside {
            flow,
            wetting,
            on_walls: T::select(still, T::ZERO, wall),
            in_air: air,
            in_pockets: caught.held,
        }
    }

    /// The level by the balance of films, with a factor c. \[m\]
    pub fn film_level(&self, capture: f64) -> R {
        let mut found = [0.0; 3];
        let [level, below, slope] = R::each_of(|point| {
            if point == 0 || self.starts >> point & 1 != 0 {
                found = self.root(point, capture);
            }
            found
        });
        // One step of Newton's gives derivatives, where numbers have them; its length is within the bracket.
        let missing = self.outside(|x| x, level, capture).missing();
        let step = (below + missing - self.stock) / slope;
        let excess = R::each(|point| step.at_point(point) - step.at_point(point).clamp(-CLOSE, CLOSE));
        let next = level - (step - excess);
        R::select(missing.is_zero(), self.rest, Real::min(next, self.rest))
    }

    /// Level, volume below it and slope of the balance at one point. \[m, m3, m2\]
    fn root(&self, point: usize, capture: f64) -> [f64; 3] {
        let stock = self.stock.at_point(point);
        let missing = |level: f64| self.outside(|x: R| x.at_point(point), level, capture).missing();
        let space = (self.space)(point);
        let excess = |level: f64| space.volume(level)[0] + missing(level) - stock;
        let rest = self.rest.at_point(point);
        let (mut low, mut high) = (space.bottom(), rest);
        let (mut at_low, mut at_high) = (excess(low), excess(high));
        let mut level = rest;
        if missing(rest) > 0.0 && at_low < 0.0 && at_high > 0.0 {
            let mut kept = 0;
            for step in 0..STEPS {
                let secant = low - at_low * (high - low) / (at_high - at_low);
                let halved = 0.5 * (low + high);
                level = if step % 4 == 3 || !(secant > low && secant < high) {
                    halved
                } else {
                    secant
                };
                let at = excess(level);
                if at.abs() <= ENOUGH * stock || high - low < CLOSE {
                    break;
                }
                // An end that is kept twice has half its weight, so that it does not stand still.
                let side = if at < 0.0 { -1 } else { 1 };
                if at < 0.0 {
                    (low, at_low) = (level, at);
                    at_high *= if kept == side { 0.5 } else { 1.0 };
                } else {
                    (high, at_high) = (level, at);
                    at_low *= if kept == side { 0.5 } else { 1.0 };
                }
                kept = side;
            }
        }
        let slope = (excess(level + STEP) - excess(level - STEP)) / (2.0 * STEP);
        let slope = if slope > 0.0 { slope } else { 1.0 };
        [level, space.volume(level)[0], slope]
    }

    /// The level by the effective depth, of the gear that lowers it most. \[m\]
    pub fn effective_level(&self) -> R {
        let fill = self.stock * (1.0 / self.inside);
        let mut lowest = self.rest;
        for (lift, gear) in self.lifts.iter().zip(self.lifted) {
            if lift.orbit > 0.0 {
                continue;
            }
            let radius = lift.radii[1];
            let depth = (lift.height_at(self.rest, gear.axis).level + radius).at_least(0.0);
            let share = effective_share(fill, gear.omega, radius, self.nu);
            let level = self.rest - depth * (R::constant(1.0) - share) / gear.axis[1];
            lowest = Real::min(lowest, level);
        }
        lowest
    }

    /// Greatest speed of a tip circle that dips into the oil at rest. \[m/s\]
    pub fn fastest_rim(&self) -> R {
        let gears = self.lifts.iter().zip(self.lifted);
        gears.fold(R::ZERO, |fastest, (lift, gear)| {
            let rim = gear.omega * lift.radii[0];
            R::select(
                lift.tip_dip_at(self.rest, gear.axis).is_above(R::ZERO),
                Real::max(fastest, rim),
                fastest,
            )
        })
    }

    /// Oil on the flanks of the gears that dip into the oil at rest, half a turn after they left it, at one point. It is too little to lower a
    /// level, so the balance does not have it. \[m3\]
    pub fn on_gears(&self, point: usize) -> f64 {
        let (nu, rest) = (self.nu.at_point(point), self.rest.at_point(point));
        let of = |(lift, lifted): (&Lift, &Lifted<R>)| {
            let gear = lifted.map(|x| x.at_point(point));
            let [tip, _, root] = lift.radii;
            let (dip, rim) = (lift.tip_dip_at(rest, gear.axis), gear.omega * tip);
            if dip <= 0.0 || rim <= 0.0 {
                return 0.0;
            }
            let wetted = 2.0 * tip * (1.0 - dip / tip).clamp(-1.0, 1.0).acos();
            let film = drawn(nu, rim, wetted).min(left_on_flank(nu, tip - root, rim));
            film * 2.0 * lift.teeth * (tip - root) * lift.width
        };
        self.lifts.iter().zip(self.lifted).map(of).sum()
    }

    /// All estimates.
    pub fn band(&self) -> Band<R> {
        Band {
            films: CAPTURE.map(|capture| self.film_level(capture)),
            effective: self.effective_level(),
        }
    }
}
