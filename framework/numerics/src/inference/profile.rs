//! Intervals by profile: how far a parameter can go while all others follow, until the objective has risen too much.
//!
//! Source: Bates, Watts: Nonlinear Regression Analysis and Its Applications (Wiley 1988), section 6.1: the signed root of the rise,
//! tau, is nearly linear in the parameter, so a secant finds its crossings in a few fits.

use super::Side;

/// Difference of the root of the rise from its limit, over the limit, at which an end is found unless more is asked for.
pub(super) const FOUND: f64 = 1e-6;
/// Width of a bracket over its distance from the optimum at which it is closed, however the objective rises inside.
const CLOSED: f64 = 1e-7;
/// Fits at most on one side; kinks where another parameter meets its bound need many.
const MOST: usize = 40;
/// Fall of the objective below that of the optimum from which on the optimum was none.
const FALL: f64 = 1e-6;
/// The least and greatest step outward, over the distance so far.
const OUTWARD: [f64; 2] = [0.2, 10.0];

/// The best that is left when one parameter is held.
#[derive(Debug, Clone, PartialEq)]
pub struct Refit {
    /// Objective: sum of all squared residuals, those of priors with them.
    pub objective: f64,
    /// Coordinates of all parameters.
    pub u: Vec<f64>,
}

/// Why an end of an interval is where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// The objective has risen to its limit there.
    Limit,
    /// The parameter meets its bound before.
    Bound,
    /// Neither within the fits that are allowed; the end is the farthest that was tried below the limit.
    Unresolved,
}

/// One end of an interval by profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileEnd {
    /// Coordinate of the parameter.
    pub u: f64,
    /// Why it is there.
    pub reach: Reach,
    /// Fits that it took.
    pub fits: usize,
}

/// Why a profile was given up.
#[derive(Debug, Clone, PartialEq)]
pub enum ProfileFault {
    /// A fit on the way is better than the optimum, which therefore was none: everything starts anew from here.
    BetterOptimum(Refit),
    /// A fit failed.
    Failed(String),
    /// There is nothing to profile, and why.
    Meaningless(String),
}

/// What is profiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The parameter.
    pub parameter: usize,
    /// Its bounds, in its coordinate; infinite where there is none.
    pub bounds: [f64; 2],
    /// Coordinates of the optimum.
    pub optimum: Vec<f64>,
    /// Objective of the optimum.
    pub objective: f64,
    /// Root of the rise at which an end lies, [`super::Fit::profile_limit`].
    pub limit: f64,
    /// Distance of the first trial, the half-width of the linearised interval.
    pub distance: f64,
    /// Difference of the root of the rise from its limit, over the limit, at which an end is found: 1e-6 as a rule, no less than
    /// the refits are good for. \[-\]
    pub found: f64,
}

/// A trial: distance from the optimum, root of the rise, best of the others.
struct Trial {
    distance: f64,
    root: f64,
    u: Vec<f64>,
}

impl Profile {
    /// Finds the end on one side. The function refits with a parameter held at a coordinate, starting from given coordinates of
    /// all; nuisance parameters stay free in it.
    ///
    /// # Errors
    /// If a fit fails or finds a better optimum, or the profile is given without a limit or a distance above zero.
    pub fn end(
        &self,
        side: Side,
        refit: &mut impl FnMut(usize, f64, &[f64]) -> Result<Refit, String>,
    ) -> Result<ProfileEnd, ProfileFault> {
        let Some(start) = self.optimum.get(self.parameter).copied() else {
            return Err(ProfileFault::Meaningless("no such parameter".to_owned()));
        };
        if !(self.limit > 0.0 && self.limit.is_finite() && self.distance > 0.0 && self.distance.is_finite()) {
            return Err(ProfileFault::Meaningless(
                "a profile needs a limit and a first distance above zero".to_owned(),
            ));
        }
        let room = (side.sign() * (self.bounds[side.place()] - start)).max(0.0);
        let place = |distance: f64| {
            // The bound itself by its own bits.
            if distance >= room {
                self.bounds[side.place()]
            } else {
                start + side.sign() * distance
            }
        };
        let end = |distance: f64, reach: Reach, fits: usize| ProfileEnd {
            u: place(distance),
            reach,
            fits,
        };
        if room == 0.0 {
            return Ok(end(0.0, Reach::Bound, 0));
        }
        let mut ask = |distance: f64, from: &[f64]| -> Result<Trial, ProfileFault> {
            let found = refit(self.parameter, place(distance), from).map_err(ProfileFault::Failed)?;
            let rise = found.objective - self.objective;
            if !rise.is_finite() || found.u.len() != self.optimum.len() {
                return Err(ProfileFault::Failed("a fit on the way has no objective".to_owned()));
            }
            if rise < -FALL {
                return Err(ProfileFault::BetterOptimum(found));
            }
            Ok(Trial {
                distance,
                root: rise.max(0.0).sqrt(),
                u: found.u,
            })
        };
        let z = self.limit;
        let is_found = |trial: &Trial| (trial.root - z).abs() <= self.found * z;
        let mut inner = Trial {
            distance: 0.0,
            root: 0.0,
            u: self.optimum.clone(),
        };
        let mut outer = ask(self.distance.min(room), &inner.u)?;
        let mut count = 1;
        while outer.root < z && !is_found(&outer) {
            if outer.distance >= room {
                return Ok(end(room, Reach::Bound, count));
            }
            if count == MOST {
                return Ok(end(outer.distance, Reach::Unresolved, count));
            }
            let [least, most] = OUTWARD;
            let further = (1.1 * (z - outer.root) / outer.root.max(f64::MIN_POSITIVE)).clamp(least, most);
            inner = outer;
            outer = ask((inner.distance * (1.0 + further)).min(room), &inner.u)?;
            count += 1;
        }
        // Between a trial below the limit and one above: the secant, where the weight of an end that stays is halved again and
        // again so that it moves too (Dowell, Jarratt, BIT 11 (1971) 168-174).
        let mut weights = [z - inner.root, outer.root - z];
        let (mut moved, mut last) = (None, outer.u.clone());
        while !is_found(&outer) && !is_found(&inner) {
            let width = outer.distance - inner.distance;
            if width <= CLOSED * outer.distance {
                // The objective jumps across its limit, or nearly so.
                return Ok(end(inner.distance, Reach::Limit, count));
            }
            if count == MOST {
                return Ok(end(inner.distance, Reach::Unresolved, count));
            }
            let share = weights[0] / (weights[0] + weights[1]);
            let trial = ask(inner.distance + share.clamp(0.01, 0.99) * width, &last)?;
            count += 1;
            last.clone_from(&trial.u);
            let side = usize::from(trial.root >= z);
            weights[side] = (trial.root - z).abs();
            if moved == Some(side) {
                weights[1 - side] *= 0.5;
            }
            moved = Some(side);
            *[&mut inner, &mut outer][side] = trial;
        }
        let best = if is_found(&outer) { &outer } else { &inner };
        Ok(end(best.distance, Reach::Limit, count))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// One parameter at zero with a rise of its own.
    fn profile(bounds: [f64; 2]) -> Profile {
        Profile {
            parameter: 0,
            bounds,
            optimum: vec![0.0],
            objective: 5.0,
            limit: 2.0,
            distance: 2.0,
            found: FOUND,
        }
    }

    fn with(rise: impl Fn(f64) -> f64) -> impl FnMut(usize, f64, &[f64]) -> Result<Refit, String> {
        move |_, v, _| {
            Ok(Refit {
                objective: 5.0 + rise(v),
                u: vec![v],
            })
        }
    }

    const OPEN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    #[test]
    fn a_straight_profile_takes_one_fit() {
        let end = profile(OPEN).end(Side::Lower, &mut with(|v| v * v)).unwrap();
        assert_eq!((end.u, end.reach, end.fits), (-2.0, Reach::Limit, 1));
    }

    #[test]
    fn curved_kinked_and_jumping_profiles_are_followed() {
        for (rise, expected) in [
            (
                &(|v: f64| v * v * (1.0 + v * v)) as &dyn Fn(f64) -> f64,
                ((17.0_f64.sqrt() - 1.0) / 2.0).sqrt(),
            ),
            (&|v: f64| 0.01 * v * v, 20.0),
            (
                &|v: f64| if v < 1.0 { 0.01 * v } else { 0.01 + 40.0 * (v - 1.0) },
                1.0 + 3.99 / 40.0,
            ),
            (&|v: f64| if v < 1.3 { 0.1 * v } else { 50.0 }, 1.3),
        ] {
            let end = profile(OPEN).end(Side::Upper, &mut with(rise)).unwrap();
            // The root of the rise is found to 1e-6 of the limit; these profiles are no flatter than half of a straight one.
            assert!((end.u - expected).abs() < 4e-6 * expected, "{end:?} {expected}");
            assert!(end.reach == Reach::Limit && end.fits <= MOST);
        }
    }

    #[test]
    fn bounds_and_flat_profiles_end_the_search() {
        let end = profile([-1.5, 0.0]).end(Side::Lower, &mut with(|v| v * v)).unwrap();
        assert_eq!((end.u, end.reach), (-1.5, Reach::Bound));
        let end = profile([-1.5, 0.0]).end(Side::Upper, &mut with(|v| v * v)).unwrap();
        assert_eq!((end.u, end.reach, end.fits), (0.0, Reach::Bound, 0));
        let end = profile(OPEN).end(Side::Upper, &mut with(|_| 0.0)).unwrap();
        assert!(end.reach == Reach::Unresolved && end.fits == MOST && end.u.is_finite());
    }

    #[test]
    fn faults_of_fits_are_told() {
        let better = profile(OPEN).end(Side::Upper, &mut with(|_| -1.0)).unwrap_err();
        assert!(matches!(better, ProfileFault::BetterOptimum(refit) if refit.objective == 4.0));
        let failed = profile(OPEN)
            .end(Side::Upper, &mut |_, _, _| Err("no".to_owned()))
            .unwrap_err();
        assert_eq!(failed, ProfileFault::Failed("no".to_owned()));
        assert!(profile(OPEN).end(Side::Upper, &mut with(|_| f64::NAN)).is_err());
        let mut without = profile(OPEN);
        without.limit = f64::NAN;
        assert!(matches!(
            without.end(Side::Upper, &mut with(|v| v)),
            Err(ProfileFault::Meaningless(_))
        ));
    }
}
