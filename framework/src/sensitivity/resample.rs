//! Quantiles of what comes of resampled rows.

/// The quantile of an ascending list, straight between neighbours; absent where the list is empty.
pub(super) fn quantile(ascending: &[f64], probability: f64) -> Option<f64> {
    let last = ascending.len().checked_sub(1)?;
    let place = probability.clamp(0.0, 1.0) * last as f64;
    let below = (place.floor() as usize).min(last);
    let above = (below + 1).min(last);
    Some(ascending[below] + (place - below as f64) * (ascending[above] - ascending[below]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn quantiles_lie_between_neighbours() {
        let list = [1.0, 2.0, 4.0];
        assert_eq!(quantile(&list, 0.0), Some(1.0));
        assert_eq!(quantile(&list, 0.75), Some(3.0));
        assert_eq!(quantile(&list, 1.0), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
