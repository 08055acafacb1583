//! Statistics of a list of differences, and bands.

use schemars::JsonSchema;
use serde::Serialize;

/// Statistics of a list of differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Statistics {
    /// Number of differences. [-]
    pub count: usize,
    /// Minimum.
    pub least: f64,
    /// Maximum.
    pub greatest: f64,
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
}

impl Statistics {
    /// Statistics of a list; absent if it is empty.
    pub fn from_values(list: impl IntoIterator<Item = f64>) -> Option<Self> {
        Self::weighted(list.into_iter().map(|x| (x, 1.0)))
    }

    /// Statistics of values with weights, which apply to mean and root mean square; NaN and values without weight are omitted.
    pub fn weighted(list: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let (mut count, mut whole, mut sum, mut squares) = (0_usize, 0.0, 0.0, 0.0);
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (x, weight) in list.into_iter().filter(|(x, weight)| x.is_finite() && *weight > 0.0) {
            count += 1;
            whole += weight;
            sum += weight * x;
            squares += weight * x * x;
            least = least.min(x);
            greatest = greatest.max(x);
        }
        (count > 0).then(|| Self {
            count,
            least,
            greatest,
            mean: sum / whole,
            rms: (squares / whole).sqrt(),
        })
    }
}

/// Quantile of a sorted list with linear interpolation.
///
/// # Panics
/// If the list is empty: a bug of the caller.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + part * (sorted[high] - sorted[low])
}

/// Correlation of two lists of equal length; absent if one of them is constant.
pub fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    (aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

/// Maximum number of distinct values with a band each.
const MOST: usize = 8;

/// Indices of points by the value of a coordinate, ascending: values within two percent of the first are equal, because measured values
/// scatter about their setpoint.
pub fn levels(coordinates: &[f64]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..coordinates.len()).collect();
    order.sort_by(|a, b| coordinates[*a].total_cmp(&coordinates[*b]));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in order {
        let near = |group: &Vec<usize>| {
            let first = coordinates[group[0]];
            (coordinates[i] - first).abs() <= 0.02 * first.abs().max(1e-9)
        };
        match groups.last_mut() {
            Some(group) if near(group) => group.push(i),
            _ => groups.push(vec![i]),
        }
    }
    groups
}

/// Bands over a coordinate: one for each value if there are few, otherwise bands with about equal numbers of points. Lower and upper end,
/// and the indices of the points in each.
pub fn bands(coordinates: &[f64]) -> Vec<([f64; 2], Vec<usize>)> {
    let mut groups = levels(coordinates);
    if groups.len() > MOST {
        let all: Vec<usize> = groups.concat();
        let size = all.len().div_ceil(MOST);
        groups = all.chunks(size).map(<[usize]>::to_vec).collect();
    }
    let ends = |group: &Vec<usize>| [coordinates[group[0]], coordinates[group[group.len() - 1]]];
    groups.into_iter().map(|group| (ends(&group), group)).collect()
}

/// Histogram with equal bins: lower end of the first bin, width, counts. The number of bins is proportional to the root of the number of
/// values.
pub fn histogram(values: &[f64]) -> (f64, f64, Vec<usize>) {
    let Some(of) = Statistics::from_values(values.iter().copied()) else {
        return (0.0, 1.0, Vec::new());
    };
    let cells = ((of.count as f64).sqrt().ceil() as usize).clamp(1, 40);
    let width = ((of.greatest - of.least) / cells as f64)
        .max(1e-12 * of.greatest.abs())
        .max(1e-300);
    let mut counts = vec![0; cells];
    for x in values {
        let i = (((x - of.least) / width) as usize).min(cells - 1);
        counts[i] += 1;
    }
    (of.least, width, counts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_list() {
        let of = Statistics::from_values([1.0, -1.0, 3.0, 1.0]);
        let expected = Statistics {
            count: 4,
            least: -1.0,
            greatest: 3.0,
            mean: 1.0,
            rms: 3.0_f64.sqrt(),
        };
        assert_eq!(of, Some(expected));
        assert_eq!(Statistics::from_values([]), None);
    }

    #[test]
    fn quantiles_and_correlations_of_known_lists() {
        let list = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(
            (quantile(&list, 0.5), quantile(&list, 0.125), quantile(&list, 1.0)),
            (3.0, 1.5, 5.0)
        );
        let falling: Vec<f64> = list.iter().map(|x| 7.0 - 2.0 * x).collect();
        assert!((correlation(&list, &falling).unwrap_or(0.0) + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&list, &[3.0; 5]), None);
    }

    #[test]
    fn bands_gather_what_belongs_together_and_lose_nothing() {
        let few = bands(&[1000.0, 3000.0, 1002.0, 2999.0]);
        assert_eq!(few.iter().map(|b| b.1.len()).collect::<Vec<_>>(), [2, 2]);
        let many: Vec<f64> = (0..100).map(f64::from).collect();
        let bands = bands(&many);
        assert!(bands.len() <= MOST && bands.iter().map(|b| b.1.len()).sum::<usize>() == 100);
    }

    #[test]
    fn a_histogram_counts_every_value_once() {
        let values: Vec<f64> = (0..50).map(|i| f64::from(i * i)).collect();
        let (low, width, counts) = histogram(&values);
        assert_eq!(counts.iter().sum::<usize>(), 50);
        assert!(low == 0.0 && (low + width * counts.len() as f64 - 2401.0).abs() < 1e-9);
        assert_eq!(histogram(&[2.0, 2.0]).2.iter().sum::<usize>(), 2);
    }
}
