//! Profile intervals of the parameters of a fit.

use super::profile::FOUND;
use super::{Fit, Profile, ProfileEnd, ProfileFault, Reach, Refit, Side, Standing};

/// Ratios of profile to linearised half-width between which a fit counts as linear.
const LINEAR: [f64; 2] = [0.8, 1.25];

/// A profile interval of one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileInterval {
    /// Lower and upper end.
    pub ends: [ProfileEnd; 2],
    /// The ends in the parameter's own unit.
    pub theta: [f64; 2],
    /// Whether a half-width is below 0.8 or above 1.25 of the linearised one: this interval is then shown first.
    pub nonlinear: bool,
}

impl Fit {
    /// Input of the profile for an interval with a confidence. A parameter at its bound has a one-sided interval. Absent for parameters
    /// that are fixed or without effect, and for robust losses.
    pub fn to_profile(&self, parameter: usize, confidence: f64) -> Option<Profile> {
        let at = &self.parameters()[parameter];
        // The limit of the increase is a chi-square quantile.
        (!self.robust).then_some(())?;
        let two_sided = match at.standing {
            Standing::Fixed => return None,
            Standing::Free => confidence,
            Standing::Active(_) => 2.0 * confidence - 1.0,
        };
        let limit = self.profile_limit(two_sided)?;
        // Without a standard deviation: the conditional one, which is too small.
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

    /// Profile interval of a parameter. The function refits with the parameter fixed, [`Profile::end`].
    ///
    /// # Errors
    /// If a fit fails or finds a better optimum, or the parameter is fixed or without effect.
    pub fn profile(
        &self,
        parameter: usize,
        confidence: f64,
        refit: impl FnMut(usize, f64, &[f64]) -> Result<Refit, String>,
    ) -> Result<ProfileInterval, ProfileFault> {
        let at = &self.parameters()[parameter];
        let Some(profile) = self.to_profile(parameter, confidence) else {
            return Err(ProfileFault::Meaningless(format!(
                "{} is fixed or without effect",
                at.name
            )));
        };
        self.profiled(&profile, confidence, refit)
    }

    /// As [`Fit::profile`], with the input from [`Fit::to_profile`].
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
