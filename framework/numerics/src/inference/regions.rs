//! Summaries of errors of calculated values, in total and by region: bands of torque, speed and temperature, and direction of power at the
//! port of the torque.

use super::folds;

/// Difference of oil temperatures above which they belong to different levels. \[K\]
const APART: f64 = 3.0;
/// Maximum number of bands over one coordinate; with more levels some share a band.
const MOST: usize = 12;

/// An error, calculated minus measured, and its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedError {
    /// Line in the file.
    pub line: u64,
    /// \[Nm\]
    pub torque: f64,
    /// \[rpm\]
    pub speed: f64,
    /// \[degC\]
    pub oil: Option<f64>,
    /// Calculated minus measured, in any unit.
    pub error: f64,
    /// The measured value in the same unit.
    pub measured: f64,
    /// Standard deviation of the measurement in the same unit, if stated.
    pub accuracy: Option<f64>,
    /// Whether the row was held out of the fit.
    pub is_held_out: bool,
}

/// Summary of errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSummary {
    /// Number of errors.
    pub count: usize,
    /// Root mean square.
    pub rms: f64,
    /// Mean: the bias of the calculation.
    pub mean: f64,
    /// The error with the largest magnitude.
    pub greatest: PlacedError,
    /// Root mean square, mean and maximum in standard deviations of the measurements; absent unless all are stated.
    pub in_accuracies: Option<[f64; 3]>,
    /// Root mean square, mean and maximum in percent of the measured values; absent unless all measured values have the same sign and are
    /// not zero.
    pub in_percent: Option<[f64; 3]>,
}

/// Root mean square, mean and value with the largest magnitude; absent for an empty list or non-finite values.
fn figures(list: &[f64]) -> Option<[f64; 3]> {
    let count = list.len() as f64;
    let rms = (list.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
    let greatest = list.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    rms.is_finite()
        .then_some([rms, list.iter().sum::<f64>() / count, greatest])
}

impl ErrorSummary {
    /// Summarises a list; absent if it is empty.
    pub fn summarise<'e>(errors: impl IntoIterator<Item = &'e PlacedError>) -> Option<Self> {
        let list: Vec<&PlacedError> = errors.into_iter().collect();
        let greatest = list.iter().max_by(|a, b| a.error.abs().total_cmp(&b.error.abs()))?;
        let all = |value: &dyn Fn(&PlacedError) -> Option<f64>| -> Option<[f64; 3]> {
            figures(&list.iter().map(|e| value(e)).collect::<Option<Vec<f64>>>()?)
        };
        let [rms, mean, _] = all(&|e| Some(e.error))?;
        let sign = list[0].measured.signum();
        Some(Self {
            count: list.len(),
            rms,
            mean,
            greatest: **greatest,
            in_accuracies: all(&|e| e.accuracy.map(|a| e.error / a)),
            in_percent: all(&|e| (e.measured * sign > 0.0).then(|| 100.0 * e.error / e.measured.abs())),
        })
    }
}

/// Errors in one region, of fitted and held-out rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// The divided quantity: `torque`, `speed`, `oil_temperature` or `direction`.
    pub over: &'static str,
    /// Lower and upper end in Nm, rpm or degC; absent for directions.
    pub band: Option<[f64; 2]>,
    /// The region as text.
    pub name: String,
    /// Fitted rows.
    pub fitted: Option<ErrorSummary>,
    /// Held-out rows.
    pub held_out: Option<ErrorSummary>,
}

/// Errors over bands of torque, speed and oil temperature, and for both directions of power, without divisions that have one region only.
/// Fitted and held-out rows share the bands.
pub fn regions(errors: &[PlacedError]) -> Vec<Region> {
    let region = |over: &'static str, band: Option<[f64; 2]>, name: String, places: &[usize]| {
        let of_kind = |held: bool| {
            let placed = places.iter().map(|i| &errors[*i]);
            ErrorSummary::summarise(placed.filter(|e| e.is_held_out == held))
        };
        Region {
            over,
            band,
            name,
            fitted: of_kind(false),
            held_out: of_kind(true),
        }
    };
    let mut all: Vec<Region> = Vec::new();
    let coordinates: [(&'static str, &str, &dyn Fn(&PlacedError) -> Option<f64>); 3] = [
        ("torque", "Nm", &|e| Some(e.torque)),
        ("speed", "rpm", &|e| Some(e.speed)),
        ("oil_temperature", "degC", &|e| e.oil),
    ];
    for (over, unit, coordinate) in coordinates {
        let Some(list) = errors.iter().map(coordinate).collect::<Option<Vec<f64>>>() else {
            continue;
        };
        let found = if over == "oil_temperature" {
            temperature_levels(&list)
        } else {
            whole_levels(&list)
        };
        if found.len() > 1 {
            all.extend(found.into_iter().map(|(band, places)| {
                let name = format!("{} {unit}", span(band));
                region(over, Some(band), name, &places)
            }));
        }
    }
    let enters = |e: &PlacedError| e.torque * e.speed >= 0.0;
    let (forth, back): (Vec<usize>, Vec<usize>) = (0..errors.len()).partition(|i| enters(&errors[*i]));
    if !forth.is_empty() && !back.is_empty() {
        for (name, places) in [("power in", forth), ("power out", back)] {
            all.push(region("direction", None, name.to_owned(), &places));
        }
    }
    all
}

/// Bands of neighbouring levels, which are not split: lower and upper end, and the indices in each. Empty if there is one level.
fn whole_levels(list: &[f64]) -> Vec<([f64; 2], Vec<usize>)> {
    let found = folds(list, MOST).unwrap_or_default().into_iter();
    found.filter_map(|fold| Some((fold.band?, fold.points))).collect()
}

/// Levels of a rig apart from scatter: lower and upper end, and the indices in each.
fn temperature_levels(list: &[f64]) -> Vec<([f64; 2], Vec<usize>)> {
    let mut order: Vec<usize> = (0..list.len()).collect();
    order.sort_by(|a, b| list[*a].total_cmp(&list[*b]));
    let levels: Vec<Vec<usize>> = order
        .chunk_by(|a, b| list[*b] - list[*a] <= APART)
        .map(<[usize]>::to_vec)
        .collect();
    if levels.len() > MOST {
        return whole_levels(list);
    }
    let with_ends = |level: Vec<usize>| ([list[level[0]], list[level[level.len() - 1]]], level);
    levels.into_iter().map(with_ends).collect()
}

/// A band as text with four digits.
fn span([low, high]: [f64; 2]) -> String {
    let digits = |x: f64| {
        let size = x.abs().max(high.abs()).max(low.abs());
        let places = (3.0 - size.max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{x:.places$}");
        let short = if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            &text
        };
        short.to_owned()
    };
    let [low, high] = [low, high].map(digits);
    if low == high { low } else { format!("{low} to {high}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn at(line: u64, torque: f64, speed: f64, error: f64, is_held_out: bool) -> PlacedError {
        PlacedError {
            line,
            torque,
            speed,
            oil: Some(80.0),
            error,
            measured: 50.0,
            accuracy: Some(2.0),
            is_held_out,
        }
    }

    #[test]
    fn errors_are_summed_up_in_three_units() {
        let found = ErrorSummary::summarise(&[at(1, 1.0, 1.0, 3.0, true), at(2, 1.0, 1.0, -4.0, true)]).unwrap();
        assert_eq!((found.count, found.mean, found.greatest.line), (2, -0.5, 2));
        assert!((found.rms - 12.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(found.in_accuracies.unwrap()[1..], [-0.25, -2.0]);
        assert_eq!(found.in_percent.unwrap()[1..], [-1.0, -8.0]);
        let mut bare = [at(1, 1.0, 1.0, 3.0, true), at(2, 1.0, 1.0, -4.0, true)];
        (bare[0].accuracy, bare[1].measured) = (None, -1.0);
        let found = ErrorSummary::summarise(&bare).unwrap();
        assert_eq!((found.in_accuracies, found.in_percent), (None, None));
        assert_eq!(ErrorSummary::summarise(&[]), None);
    }

    #[test]
    fn regions_set_both_kinds_side_by_side() {
        let errors = [
            at(1, 10.0, 1000.0, 1.0, false),
            at(2, 10.0, 2000.0, 2.0, true),
            at(3, -10.0, 1000.0, 3.0, true),
            at(4, -10.0, 2000.0, 5.0, true),
        ];
        let found = regions(&errors);
        let names: Vec<(&str, &str)> = found.iter().map(|r| (r.over, r.name.as_str())).collect();
        let expected = [
            ("torque", "-10 Nm"),
            ("torque", "10 Nm"),
            ("speed", "1000 rpm"),
            ("speed", "2000 rpm"),
            ("direction", "power in"),
            ("direction", "power out"),
        ];
        assert_eq!(names, expected);
        assert_eq!(found[0].held_out.unwrap().mean, 4.0);
        assert!(found[0].fitted.is_none() && found[1].fitted.unwrap().count == 1);
        assert!(regions(&[]).is_empty());
    }

    #[test]
    fn temperatures_that_scatter_are_one_level() {
        let mut errors: Vec<PlacedError> = (1..=6).map(|line| at(line, 10.0, 1000.0, 1.0, line > 3)).collect();
        for (error, oil) in errors.iter_mut().zip([39.2, 40.9, 40.1, 99.0, 101.0, 100.2]) {
            error.oil = Some(oil);
        }
        let names: Vec<String> = regions(&errors).into_iter().map(|r| r.name).collect();
        assert_eq!(names, ["39.2 to 40.9 degC", "99 to 101 degC"]);
    }

    #[test]
    fn bands_are_written_short() {
        assert_eq!(span([1000.0, 2000.4]), "1000 to 2000");
        assert_eq!(span([0.25, 0.5]), "0.25 to 0.5");
        assert_eq!(span([79.98, 80.02]), "79.98 to 80.02");
        assert_eq!(span([-20.0, -20.0]), "-20");
    }
}
