//! Uncertain inputs: quantities of the description with distributions.

use crate::codes;
use crate::study::{Shape, ToleranceEntry};
use gearloss_numerics::sampling::Distribution;

use super::ranges::{Range, once};
use super::{Built, Planner, Stopped};

/// An uncertain input with its distribution, in the unit of the path.
pub struct Input {
    /// Its range.
    pub range: Range,
    distribution: Distribution,
}

impl Input {
    /// All inputs of an analysis at a path, without repetition.
    pub fn all(cx: &Planner<'_>, path: &str, entries: &[ToleranceEntry], b: &Built<'_>) -> Result<Vec<Self>, Stopped> {
        let path = format!("{path}.inputs");
        let of = |(i, input)| Self::new(cx, &format!("{path}.{i}"), input, b);
        let inputs: Vec<Self> = entries.iter().enumerate().map(of).collect::<Result<_, _>>()?;
        let varied: Vec<_> = inputs.iter().map(|input| &input.range.varied).collect();
        once(cx, &path, &varied)?;
        Ok(inputs)
    }

    fn new(cx: &Planner<'_>, path: &str, entry: &ToleranceEntry, b: &Built<'_>) -> Result<Self, Stopped> {
        let range = Range::new(cx, path, &entry.range, b)?;
        // Values outside the range of the schema are moved to its ends.
        if entry.distribution != Shape::Normal {
            range.inside(cx, path)?;
        }
        let [low, high] = range.ends;
        let distribution = match entry.distribution {
            Shape::Uniform => Distribution::uniform(low, high),
            // 95 % of a normal distribution are within 1.96 deviations.
            Shape::Normal => Distribution::normal(0.5 * (low + high), 0.5 * (high - low) / 1.959964),
            Shape::Triangular => {
                let mode = range.varied.start().unwrap_or(0.5 * (low + high));
                Distribution::triangular(low, mode.clamp(low, high), high)
            }
        };
        let wrong = |reason: String| {
            let message = format!("{}: {reason}", entry.range.path);
            cx.wrong_as(codes::VARIED, path, message, "give a range with a positive width")
        };
        Ok(Self {
            distribution: distribution.map_err(wrong)?,
            range,
        })
    }

    /// The quantile of a probability, in the unit of the path.
    pub fn value(&self, share: f64) -> Result<f64, String> {
        let [least, greatest] = self.range.varied.range;
        Ok(self.distribution.value(share)?.clamp(least, greatest))
    }
}
