//! Identifiability of parameters as text.
//!
//! Intervals are compared with the size of the parameter, [`super::Parameter::own_size`], not with the bounds, because wider bounds are not
//! better data. The share of the bounds that an interval fills is reported separately. Parameters that are identifiable only in combination
//! are found by correlations, and otherwise by singular vectors (Belsley, Kuh, Welsch: Regression Diagnostics, Wiley 1980, chapter 3). The
//! limits are conventions.

use super::{Fit, Side, Standing};

/// Confidence of the half-widths.
const CONFIDENCE: f64 = 0.95;
/// Maximum half-width over size of a well determined parameter.
const WELL: f64 = 0.1;
/// The same for a roughly determined parameter.
const ROUGHLY: f64 = 0.5;
/// Conditional half-width over size above which the data do not determine a parameter.
const UNSEEN: f64 = 1.0;
/// Share of the range filled by an interval above which it is reported.
pub(super) const FILLS: f64 = 0.5;
/// Unexplained part of a column below which a parameter is identifiable only in combination.
const OWN: f64 = 0.2;
/// Correlation above which a parameter is a partner.
const PARTNER: f64 = 0.8;
/// Entry of a singular vector above which a parameter is a partner.
const ENTRY: f64 = 0.3;

/// Verdict on a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Fixed by the user.
    Held,
    /// At an active bound.
    OnBound(Side),
    /// A change by its own size has less effect than the accuracy of the instruments.
    NotSeen,
    /// The half-width of its interval is at most a tenth of its size.
    WellDetermined,
    /// Identifiable only in combination with others.
    OnlyInCombination,
    /// The half-width of its interval is at most half its size.
    RoughlyDetermined,
    /// Otherwise.
    NotDetermined,
}

/// A combination of two parameters that is better determined than either: u - factor v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Combination {
    /// The other parameter.
    pub with: usize,
    /// Factor on its coordinate.
    pub factor: f64,
    /// Value of the combination.
    pub value: f64,
    /// Standard deviation of the combination.
    pub deviation: f64,
}

/// Identifiability of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Determination {
    /// Verdict.
    pub verdict: Verdict,
    /// Half-width of the 95 % interval over the size of the parameter, [`super::Parameter::own_size`]; absent without a standard deviation.
    /// The verdict is based on it. \[-\]
    pub relative: Option<f64>,
    /// The same conditional on all other parameters; absent if the column is zero or the parameter is not free. \[-\]
    pub relative_alone: Option<f64>,
    /// Share of the range between the bounds that the interval fills; absent without two bounds or a standard deviation. \[-\]
    pub filled: Option<f64>,
    /// Half-width of the 95 % interval over the range; absent without a standard deviation.
    pub width: Option<f64>,
    /// The same conditional on all other parameters; absent if the column is zero or the parameter is not free.
    pub alone: Option<f64>,
    /// Part of the column that the others do not explain, from zero to one: the root of the tolerance, 1/VIF.
    pub own_share: f64,
    /// Parameters that are identifiable only in combination with it, the strongest first.
    pub partners: Vec<usize>,
}

impl Fit {
    /// Verdict on a parameter.
    pub fn determination(&self, parameter: usize) -> Determination {
        self.determination_widened(parameter, 1.0)
    }

    /// As [`Fit::determination`], with intervals widened by a factor from the checks of the residuals.
    pub fn determination_widened(&self, parameter: usize, widening: f64) -> Determination {
        let mut found = Determination {
            verdict: Verdict::Held,
            relative: None,
            relative_alone: None,
            filled: None,
            width: None,
            alone: None,
            own_share: 0.0,
            partners: Vec::new(),
        };
        match self.parameters()[parameter].standing {
            Standing::Fixed => return found,
            Standing::Active(side) => {
                found.verdict = Verdict::OnBound(side);
                return found;
            }
            Standing::Free => {}
        }
        let at = &self.parameters()[parameter];
        let (range, size) = (at.range(), at.own_size());
        // There are more rows than parameters if Student's quantile is used.
        let quantile = self.quantile(CONFIDENCE).unwrap_or(f64::MAX);
        let alone = self.variance().sqrt() / self.column(parameter);
        let deviation = self.deviation(parameter);
        let half = deviation.map(|d| widening * quantile * d);
        let half_alone = Some(widening * quantile * alone).filter(|w| w.is_finite());
        found.relative = half.map(|half| half / size);
        found.relative_alone = half_alone.map(|half| half / size);
        let [low, high] = at.bounds;
        found.filled = half
            .filter(|_| (high - low).is_finite() && high > low)
            .map(|half| ((at.u + half).min(high) - (at.u - half).max(low)) / (high - low));
        found.width = half.map(|half| half / range);
        found.alone = half_alone.map(|half| half / range);
        found.own_share = match deviation {
            Some(d) if d > 0.0 => (alone / d).min(1.0),
            // Without scatter every parameter is known exactly.
            Some(_) => 1.0,
            None => 0.0,
        };
        let within = |limit: f64| found.relative.is_some_and(|relative| relative <= limit);
        found.verdict = if found.relative_alone.is_none_or(|w| w > UNSEEN) {
            Verdict::NotSeen
        } else if within(WELL) {
            Verdict::WellDetermined
        } else if found.own_share < OWN {
            Verdict::OnlyInCombination
        } else if within(ROUGHLY) {
            Verdict::RoughlyDetermined
        } else {
            Verdict::NotDetermined
        };
        if found.verdict == Verdict::OnlyInCombination {
            found.partners = self.partners(parameter);
        }
        found
    }

    /// The partners of a parameter, the strongest first.
    fn partners(&self, parameter: usize) -> Vec<usize> {
        let others = || (0..self.parameters().len()).filter(|k| *k != parameter);
        let strength = |k: usize| self.correlation(parameter, k).map_or(0.0, f64::abs);
        let mut list: Vec<(usize, f64)> = others()
            .map(|k| (k, strength(k)))
            .filter(|(_, s)| *s >= PARTNER)
            .collect();
        if list.is_empty() {
            // The direction with most of the variance: an unresolved direction if there is no variance.
            let resolved = self.factors.resolved;
            let places = if self.deviation(parameter).is_some() {
                0..resolved
            } else {
                resolved..self.singular_values().len()
            };
            let shares = places.map(|place| {
                let entry = self.direction(place)[parameter].abs();
                (
                    place,
                    if place < resolved {
                        entry / self.singular_values()[place]
                    } else {
                        entry
                    },
                )
            });
            if let Some((place, _)) = shares.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) {
                let direction = self.direction(place);
                list = others()
                    .map(|k| (k, direction[k].abs()))
                    .filter(|(_, s)| *s > ENTRY)
                    .collect();
            }
        }
        list.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        list.into_iter().map(|(k, _)| k).collect()
    }

    /// The best determined combination of a parameter with another; absent if either has no standard deviation.
    pub fn combination(&self, parameter: usize, with: usize) -> Option<Combination> {
        let correlation = self.correlation(parameter, with)?;
        let factor = correlation * self.deviation(parameter)? / self.deviation(with)?;
        let mut gradient = vec![0.0; self.parameters().len()];
        gradient[parameter] = 1.0;
        gradient[with] = -factor;
        let [u, v] = [parameter, with].map(|k| self.parameters()[k].u);
        Some(Combination {
            with,
            factor,
            value: u - factor * v,
            deviation: self.deviation_along(&gradient)?,
        })
    }
}
