//! Which parameters the data determine, in words.
//!
//! Intervals are judged by the size of the parameter, [`super::Parameter::own_size`], and not by the bounds that a user gives: wider
//! bounds are no better data. How much of the bounds an interval fills is a second statement. Parameters that are known only together
//! are found by correlations, and where these say nothing by singular vectors (Belsley, Kuh, Welsch: Regression Diagnostics, Wiley
//! 1980, chapter 3). The limits are conventions.

use super::{Fit, Side, Standing};

/// Confidence of the half-widths.
const CONFIDENCE: f64 = 0.95;
/// Half-width over the size up to which a parameter is well determined.
const WELL: f64 = 0.1;
/// The same up to which it is roughly determined.
const ROUGHLY: f64 = 0.5;
/// The same if all others were known, above which the data do not see a parameter.
const UNSEEN: f64 = 1.0;
/// Share of the range from which on it is told that an interval fills it.
pub(super) const FILLS: f64 = 0.5;
/// Part of a column that no other explains, below which a parameter is known only in combination.
const OWN: f64 = 0.2;
/// Correlation from which on a parameter is a partner.
const PARTNER: f64 = 0.8;
/// Entry of a singular vector above which a parameter is a partner.
const ENTRY: f64 = 0.3;

/// What the data say of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The user holds it.
    Held,
    /// It is on a bound and would go on.
    OnBound(Side),
    /// A change by its own size moves the results less than the instruments can see.
    NotSeen,
    /// The half-width of its interval is a tenth of its size or less.
    WellDetermined,
    /// Only together with others.
    OnlyInCombination,
    /// The half-width of its interval is half of its size or less.
    RoughlyDetermined,
    /// The rest: its interval is nearly as wide as its size, or wider.
    NotDetermined,
}

/// A combination of two parameters that is better known than either: u - factor v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Combination {
    /// The other parameter.
    pub with: usize,
    /// What its coordinate is multiplied by before it is taken away.
    pub factor: f64,
    /// Value of the combination.
    pub value: f64,
    /// Standard deviation of the combination.
    pub deviation: f64,
}

/// How well a parameter is determined, and by what.
#[derive(Debug, Clone, PartialEq)]
pub struct Determination {
    /// What the data say.
    pub verdict: Verdict,
    /// Half-width of the 95 % interval over the size of the parameter, [`super::Parameter::own_size`]; absent where there is no standard
    /// deviation. The verdict follows from it. \[-\]
    pub relative: Option<f64>,
    /// The same if all other parameters were known; absent where the column is zero or the parameter does not move. \[-\]
    pub relative_alone: Option<f64>,
    /// Share of the range between the bounds that the interval fills; absent without two bounds or a standard deviation. \[-\]
    pub filled: Option<f64>,
    /// Half-width of the 95 % interval over the range; absent where there is no standard deviation.
    pub width: Option<f64>,
    /// The same if all other parameters were known; absent where the column is zero or the parameter does not move.
    pub alone: Option<f64>,
    /// Part of the column that no other explains, from zero to one: the root of the tolerance, 1/VIF.
    pub own: f64,
    /// Parameters that it is known together with, the nearest first.
    pub partners: Vec<usize>,
}

impl Fit {
    /// What the data say of a parameter.
    pub fn determination(&self, parameter: usize) -> Determination {
        self.determination_widened(parameter, 1.0)
    }

    /// As [`Fit::determination`], where checks of the residuals say that intervals are too small by a factor.
    pub fn determination_widened(&self, parameter: usize, widening: f64) -> Determination {
        let mut found = Determination {
            verdict: Verdict::Held,
            relative: None,
            relative_alone: None,
            filled: None,
            width: None,
            alone: None,
            own: 0.0,
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
        // Rows are more than parameters wherever Student's quantile is asked for.
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
        found.own = match deviation {
            Some(d) if d > 0.0 => (alone / d).min(1.0),
            // Without any scatter every parameter is known exactly.
            Some(_) => 1.0,
            None => 0.0,
        };
        let within = |limit: f64| found.relative.is_some_and(|relative| relative <= limit);
        found.verdict = if found.relative_alone.is_none_or(|w| w > UNSEEN) {
            Verdict::NotSeen
        } else if within(WELL) {
            Verdict::WellDetermined
        } else if found.own < OWN {
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

    /// The parameters that one is known together with, the nearest first.
    fn partners(&self, parameter: usize) -> Vec<usize> {
        let others = || (0..self.parameters().len()).filter(|k| *k != parameter);
        let strength = |k: usize| self.correlation(parameter, k).map_or(0.0, f64::abs);
        let mut list: Vec<(usize, f64)> = others()
            .map(|k| (k, strength(k)))
            .filter(|(_, s)| *s >= PARTNER)
            .collect();
        if list.is_empty() {
            // The direction in which most of the variance lies: an unresolved one where there is no variance to tell.
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

    /// The combination of a parameter with another that is known best; absent where either has no standard deviation.
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
