//! Uncertain inputs: quantities of the description with distributions.

use crate::codes;
use crate::study::{Shape, ToleranceEntry};
use crate::varied::{Tie, Varied};
use gearloss_numerics::inference::Further;
use gearloss_numerics::sampling::Distribution;

use super::model_error::ModelError;
use super::ranges::{Range, once};
use crate::analyses::{Built, Planner, Stopped};

/// An uncertain input with its distribution, in the unit of the path.
pub struct Input {
    /// Its range.
    pub range: Range,
    distribution: Drawn,
}

/// How an input is distributed.
enum Drawn {
    /// Over its range.
    Range(Distribution),
    /// As the logarithm of a factor, by the error of a model.
    ModelError(Further),
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
            let message = format!("{}: {reason}", entry.range.words());
            cx.wrong_as(codes::VARIED, path, message, "give a range with a positive width")
        };
        Ok(Self {
            distribution: Drawn::Range(distribution.map_err(wrong)?),
            range,
        })
    }

    /// The factor on the losses of components with the same law, by the distribution of its logarithm. `path` is its place in the study.
    pub(crate) fn of_model_error(
        cx: &Planner<'_>,
        path: &str,
        (law, paths): (&ModelError, Vec<String>),
        logarithm: Further,
        b: &Built<'_>,
    ) -> Result<Self, Stopped> {
        let varied = paths
            .iter()
            .map(|path| Varied::new(cx.language, &b.resolved, path, Tie::Factor));
        let varied = varied.collect::<Result<Vec<Varied>, _>>().map_err(|mut error| {
            path.clone_into(&mut error.path);
            cx.found(vec![error])
        })?;
        let mut varied = varied.into_iter();
        let first = varied
            .next()
            .ok_or_else(|| cx.wrong(path, "a law without components", "report this"))?;
        let mut all = varied.fold(first, |mut all, one| {
            all.paths.extend(one.paths);
            all.base.extend(one.base);
            all.published.extend(one.published);
            all
        });
        let kind = law.kind.as_ref().map_or_else(String::new, |kind| format!(" of {kind}"));
        all.pattern = format!("error of {} {}{kind}", law.mechanism, law.model);
        // The factors of all of them are one, so that their range is that of the schema.
        let ends = paths
            .iter()
            .filter_map(|path| cx.language.number_at(&b.resolved.value, path));
        for (_, least, greatest) in ends {
            all.range = [all.range[0].max(least), all.range[1].min(greatest)];
        }
        let [low, _, high] = law.factor.unwrap_or([1.0; 3]);
        Ok(Self {
            range: Range {
                varied: all,
                ends: [low, high],
            },
            distribution: Drawn::ModelError(logarithm),
        })
    }

    /// The quantile of a probability, in the unit of the path.
    pub fn value(&self, share: f64) -> Result<f64, String> {
        let [least, greatest] = self.range.varied.range;
        let value = match &self.distribution {
            Drawn::Range(distribution) => distribution.value(share)?,
            Drawn::ModelError(logarithm) => {
                let quantile = logarithm.quantile(share);
                quantile
                    .ok_or_else(|| format!("{share} is no probability inside zero to one"))?
                    .exp()
            }
        };
        Ok(value.clamp(least, greatest))
    }
}
