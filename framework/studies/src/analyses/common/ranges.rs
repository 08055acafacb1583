//! Quantities that are varied over ranges.

use crate::codes;
use crate::study::RangeEntry;
use crate::varied::Varied;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use crate::analyses::{Built, BuiltAgain, Planner, Stopped};

/// A varied quantity with its range, in the unit of the path.
pub struct Range {
    /// The quantity.
    pub varied: Varied,
    /// Lower and upper end; the upper one is larger.
    pub ends: [f64; 2],
}

impl Range {
    /// `path` is the entry's place in the study.
    pub fn new(cx: &Planner<'_>, path: &str, entry: &RangeEntry, b: &Built<'_>) -> Result<Self, Stopped> {
        let wrong = |message: String, help: &str| {
            cx.wrong_as(codes::VARIED, path, format!("{}: {message}", entry.words()), help)
        };
        let together = !entry.paths.is_empty() || !entry.values.is_empty();
        let varied = match &entry.path {
            Some(own) if !together => varied(cx, path, (own, entry.tie), b)?,
            Some(_) => {
                let message = "both `path` and `paths` with `values` are stated";
                return Err(cx.wrong_as(codes::VARIED, path, message, "delete one of them"));
            }
            None if together => Varied::along(cx.language, &b.resolved, &entry.paths, &entry.values)
                .map_err(|(key, message, help)| cx.wrong_as(codes::VARIED, &format!("{path}.{key}"), message, &help))?,
            None => {
                let help = "add `path`, or several `paths` with `values`";
                return Err(cx.wrong_as(codes::VARIED, path, "no path is stated", help));
            }
        };
        let about = || {
            varied.start().ok_or_else(|| {
                wrong(
                    "the gearbox states no value".to_owned(),
                    "state one, or give `from` and `to`",
                )
            })
        };
        let quantity = |value: &Value, difference: bool| {
            varied
                .quantity(value, difference)
                .map_err(|reason| wrong(reason, "write a quantity of the path, such as `0.1 um`"))
        };
        let ends = match (&entry.plus_minus, entry.percent, &entry.from, &entry.to) {
            (Some(half), None, None, None) => {
                let (middle, half) = (about()?, quantity(half, true)?.abs());
                [middle - half, middle + half]
            }
            (None, Some(percent), None, None) => {
                let middle = about()?;
                let half = 0.01 * percent * middle.abs();
                [middle - half, middle + half]
            }
            (None, None, None, None) if together => varied.range,
            (None, None, Some(from), Some(to)) => [quantity(from, false)?, quantity(to, false)?],
            _ => {
                return Err(wrong(
                    "expected one of `plus_minus`, `percent`, or both `from` and `to`".to_owned(),
                    "write for example `percent: 10`",
                ));
            }
        };
        if ends[0] >= ends[1] {
            let said = format!(
                "a range needs two finite ends in ascending order, not {} and {}",
                varied.words(ends[0]),
                varied.words(ends[1])
            );
            return Err(wrong(said, "give a range with a positive width"));
        }
        Ok(Self { varied, ends })
    }

    /// Rejects a range outside the schema.
    pub fn inside(&self, cx: &Planner<'_>, path: &str) -> Result<(), Stopped> {
        let ([low, high], [least, greatest]) = (self.ends, self.varied.range);
        if low >= least && high <= greatest {
            return Ok(());
        }
        let said = format!(
            "{}: {} to {} is outside {least} to {greatest}",
            self.varied.pattern,
            self.varied.words(low),
            self.varied.words(high)
        );
        Err(cx.wrong_as(codes::VARIED, path, said, "narrow the range"))
    }

    /// The value at a fraction of the range.
    pub fn value_at(&self, share: f64) -> f64 {
        let [low, high] = self.ends;
        (low + share * (high - low)).clamp(low, high)
    }
}

/// What is built again when each of these leaves one end of its range for the other; without those at an end of which the gearbox cannot be
/// built.
pub fn built_again<'r>(
    cx: &Planner<'_>,
    b: &Built<'_>,
    ranges: impl IntoIterator<Item = &'r Range>,
) -> Vec<BuiltAgain> {
    let variants = Variants::new(cx.language, b.gearbox, cx.study.choice(b.set()));
    let of = |range: &Range| {
        let [first, second] = range.ends.map(|end| range.varied.overrides(end).collect::<Vec<_>>());
        Some(BuiltAgain {
            of: b.name.clone(),
            quantity: range.varied.pattern.clone(),
            // A value with which the gearbox cannot be built is for the samples to report.
            models: variants.built_again([&first, &second]).ok()?,
        })
    };
    ranges.into_iter().filter_map(of).collect()
}

/// A varied coefficient of a formula.
#[derive(Debug, Clone)]
pub struct PublishedCoefficient {
    /// The pattern as written.
    pub pattern: String,
    /// Value of the source.
    pub published: f64,
}

/// The varied quantities that are coefficients of formulas.
pub fn published<'v>(all: impl Iterator<Item = &'v Varied>) -> Vec<PublishedCoefficient> {
    let coefficient = |varied: &Varied| {
        Some(PublishedCoefficient {
            pattern: varied.pattern.clone(),
            published: *varied.published.iter().flatten().next()?,
        })
    };
    all.filter_map(coefficient).collect()
}

/// A varied quantity of a study; `path` is its place there.
pub fn varied(
    cx: &Planner<'_>,
    path: &str,
    (pattern, tie): (&str, crate::varied::Tie),
    b: &Built<'_>,
) -> Result<Varied, Stopped> {
    let varied = Varied::new(cx.language, &b.resolved, pattern, tie).map_err(|mut error| {
        error.message = format!("`{pattern}`: {}", error.message);
        path.clone_into(&mut error.path);
        cx.found(vec![error])
    })?;
    let fixed = cx.study.entry.conditions.oil_temperature.is_some();
    if fixed && varied.paths.iter().any(|path| path == "thermal.oil") {
        let message = "the conditions fix the temperature, so it cannot be varied";
        return Err(cx.wrong_as(codes::VARIED, path, message, "delete `conditions.oil_temperature`"));
    }
    Ok(varied)
}

/// Rejects two quantities that change the same value; `place` is the key of a list in the study.
pub fn once(cx: &Planner<'_>, place: &str, all: &[&Varied]) -> Result<(), Stopped> {
    for (i, varied) in all.iter().enumerate() {
        let twice = |other: &&&Varied| other.paths.iter().any(|p| varied.paths.contains(p));
        if let Some(other) = all[..i].iter().find(twice) {
            let message = format!("`{}` and `{}` change the same value", other.pattern, varied.pattern);
            return Err(cx.wrong_as(codes::VARIED, &format!("{place}.{i}"), message, "list every value once"));
        }
    }
    Ok(())
}
