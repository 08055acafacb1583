//! Profile likelihood intervals: the parameter is moved and all others are refitted until the objective has increased to a limit.
//!
//! Source: Bates, Watts: Nonlinear Regression Analysis and Its Applications (Wiley 1988), section 6.1: the signed root of the increase,
//! tau, is nearly linear in the parameter, so a secant finds its crossings in a few fits.

use super::Side;

/// Default relative tolerance of the root of the increase at an end.
pub(super) const FOUND: f64 = 1e-6;
/// Relative width of a bracket at which the search ends, independent of the objective inside.
const CLOSED: f64 = 1e-7;
/// Maximum number of fits on one side; kinks where another parameter reaches its bound need many.
const MOST: usize = 40;
/// Decrease of the objective below the optimum above which the optimum is rejected.
const FALL: f64 = 1e-6;
/// Minimum and maximum step outward, relative to the distance so far.
const OUTWARD: [f64; 2] = [0.2, 10.0];

/// The optimum of the others with one parameter fixed.
#[derive(Debug, Clone, PartialEq)]
pub struct Refit {
    /// Objective: sum of all squared residuals, including those of priors.
    pub objective: f64,
    /// Coordinates of all parameters.
    pub u: Vec<f64>,
}

/// Why a search for an end stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// The objective reaches its limit.
    Limit,
    /// The parameter reaches its bound first.
    Bound,
    /// Neither within the allowed number of fits; the end is the farthest trial below the limit.
    Unresolved,
}

/// One end of an interval by profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileEnd {
    /// Coordinate of the parameter.
    pub u: f64,
    /// Why the search stopped.
    pub reach: Reach,
    /// Number of fits.
    pub fits: usize,
}

/// Why a profile was abandoned.
#[derive(Debug, Clone, PartialEq)]
pub enum ProfileFault {
    /// A fit on the way is better than the optimum: the search must restart from here.
    BetterOptimum(Refit),
    /// A fit failed.
    Failed(String),
    /// There is no profile, with the reason.
    Meaningless(String),
}

/// Input of a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The parameter.
    pub parameter: usize,
    /// Its bounds in its coordinate; infinite if there is none.
    pub bounds: [f64; 2],
    /// Coordinates of the optimum.
    pub optimum: Vec<f64>,
    /// Objective of the optimum.
    pub objective: f64,
    /// Root of the increase at an end, [`super::Fit::profile_limit`].
    pub limit: f64,
    /// Distance of the first trial, the half-width of the linearised interval.
    pub distance: f64,
    /// Relative tolerance of the root of the increase at an end: usually 1e-6, not below the accuracy of the refits. \[-\]
    pub found: f64,
}

/// A trial: distance from the optimum, root of the increase, optimum of the others.
struct Trial {
    distance: f64,
    root: f64,
    u: Vec<f64>,
}

impl Profile {
    /// Finds the end on one side. The function refits with the parameter fixed at a coordinate, starting from the given coordinates.
    ///
    /// # Errors
    /// If a fit fails or finds a better optimum, or limit or distance are not positive.
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
                "a profile needs a positive limit and a positive first distance".to_owned(),
            ));
        }
        let room = (side.sign() * (self.bounds[side.place()] - start)).max(0.0);
        let place = |distance: f64| {
            // Exactly the bound.
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
                return Err(ProfileFault::Failed("a refit has no objective".to_owned()));
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
        // Between a trial below the limit and one above: regula falsi that halves the weight of a retained end (Dowell, Jarratt, BIT 11
        // (1971) 168-174).
        let mut weights = [z - inner.root, outer.root - z];
        let (mut moved, mut last) = (None, outer.u.clone());
        while !is_found(&outer) && !is_found(&inner) {
            let width = outer.distance - inner.distance;
            if width <= CLOSED * outer.distance {
                // The objective is (nearly) discontinuous at its limit.
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
    fn faults_of_fits_are_reported() {
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
