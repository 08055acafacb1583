//! Intervals of the parameters of a fit by profile.

use super::profile::FOUND;
use super::{Fit, Profile, ProfileEnd, ProfileFault, Reach, Refit, Side, Standing};

/// Half-widths by profile over those of the linearised fit between which a fit counts as linear.
const LINEAR: [f64; 2] = [0.8, 1.25];

/// An interval of one parameter by profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileInterval {
    /// Lower and upper end.
    pub ends: [ProfileEnd; 2],
    /// The ends in the parameter's own unit.
    pub theta: [f64; 2],
    /// Whether a half-width is less than 0.8 or more than 1.25 of the linearised one: this interval is then shown first.
    pub nonlinear: bool,
}

impl Fit {
    /// What is to be profiled for an interval of some confidence. For a parameter on its bound it is the side away from the
    /// bound alone, so that the whole of what is left out lies there. Absent for parameters that are held or not seen, and where
    /// outliers pull less.
    pub fn to_profile(&self, parameter: usize, confidence: f64) -> Option<Profile> {
        let at = &self.parameters()[parameter];
        // The limit of the rise is that of a chi-square.
        (!self.robust).then_some(())?;
        let two_sided = match at.standing {
            Standing::Fixed => return None,
            Standing::Free => confidence,
            Standing::Active(_) => 2.0 * confidence - 1.0,
        };
        let limit = self.profile_limit(two_sided)?;
        // Without a standard deviation of its own: as if all others were known, which is too near.
        let alone = || Some(self.variance().sqrt() / self.column(parameter)).filter(|d| d.is_finite());
        let deviation = self.deviation(parameter).or_else(alone)?;
        Some(Profile {
            parameter,
            bounds: at.bounds,
            optimum: self.parameters().iter().map(|p| p.u).collect(),
            objective: self.objective(),
            limit,
            distance: self.quantile(two_sided)? * deviation,
            found: FOUND,
        })
    }

    /// Interval of a parameter by profile. The function refits with a parameter held, [`Profile::end`].
    ///
    /// # Errors
    /// If a fit fails or finds a better optimum, or the parameter is held or not seen.
    pub fn profile(
        &self,
        parameter: usize,
        confidence: f64,
        refit: impl FnMut(usize, f64, &[f64]) -> Result<Refit, String>,
    ) -> Result<ProfileInterval, ProfileFault> {
        let at = &self.parameters()[parameter];
        let Some(profile) = self.to_profile(parameter, confidence) else {
            return Err(ProfileFault::Meaningless(format!("{} is held or not seen", at.name)));
        };
        self.profiled(&profile, confidence, refit)
    }

    /// As [`Fit::profile`], of what [`Fit::to_profile`] prepared.
    ///
    /// # Errors
    /// If a fit fails or finds a better optimum.
    pub fn profiled(
        &self,
        profile: &Profile,
        confidence: f64,
        mut refit: impl FnMut(usize, f64, &[f64]) -> Result<Refit, String>,
    ) -> Result<ProfileInterval, ProfileFault> {
        let parameter = profile.parameter;
        let at = &self.parameters()[parameter];
        let ends = [
            profile.end(Side::Lower, &mut refit)?,
            profile.end(Side::Upper, &mut refit)?,
        ];
        let half = self
            .quantile(confidence)
            .zip(self.deviation(parameter))
            .map(|(q, d)| q * d);
        let strange = |end: &ProfileEnd| {
            let ratio = half.map_or(1.0, |half| (end.u - at.u).abs() / half);
            end.reach != Reach::Bound && !(LINEAR[0]..=LINEAR[1]).contains(&ratio)
        };
        Ok(ProfileInterval {
            ends,
            theta: ends.map(|end| at.scale.theta(end.u)),
            nonlinear: ends.iter().any(strange),
        })
    }
}
