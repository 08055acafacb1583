//! Distributions of uncertain quantities, which map the unit cube to values.

use super::normal::inverse_normal;

/// Distribution of an uncertain quantity, in its own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution(Kind);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Uniform([f64; 2]),
    Normal { mean: f64, deviation: f64 },
    Triangular { low: f64, mode: f64, high: f64 },
}

impl Distribution {
    /// Uniform between two ends.
    ///
    /// # Errors
    /// If the ends are reversed, or ends or distance are not finite.
    pub fn uniform(low: f64, high: f64) -> Result<Self, String> {
        if low < high && (high - low).is_finite() {
            Ok(Self(Kind::Uniform([low, high])))
        } else {
            Err(format!(
                "a uniform distribution needs two finite ends in order, not {low} and {high}"
            ))
        }
    }

    /// Normal.
    ///
    /// # Errors
    /// If the mean is not finite, or the standard deviation is not positive.
    pub fn normal(mean: f64, deviation: f64) -> Result<Self, String> {
        // The probability beyond forty deviations underflows.
        if mean.is_finite() && deviation > 0.0 && (mean.abs() + 40.0 * deviation).is_finite() {
            Ok(Self(Kind::Normal { mean, deviation }))
        } else {
            Err(format!(
                "a normal distribution needs a finite mean and a positive standard deviation, not {mean} and {deviation}"
            ))
        }
    }

    /// Triangular.
    ///
    /// # Errors
    /// If the numbers or the distance of the ends are not finite, the ends not in order or the mode not between them.
    pub fn triangular(low: f64, mode: f64, high: f64) -> Result<Self, String> {
        if low < high && low <= mode && mode <= high && (high - low).is_finite() {
            Ok(Self(Kind::Triangular { low, mode, high }))
        } else {
            Err(format!(
                "a triangular distribution needs finite ends in order and its mode between them, not {low}, {mode}, {high}"
            ))
        }
    }

    /// The quantile of a probability; zero and one are the ends, if there are ends.
    ///
    /// # Errors
    /// If the probability is not between zero and one, or is zero or one for a normal quantity.
    pub fn value(&self, probability: f64) -> Result<f64, String> {
        if !(0.0..=1.0).contains(&probability) {
            return Err(format!("{probability} is not a probability"));
        }
        Ok(match self.0 {
            Kind::Uniform([low, high]) => (low + probability * (high - low)).clamp(low, high),
            Kind::Normal { mean, deviation } => match inverse_normal(probability) {
                Some(standard) => mean + deviation * standard,
                None => return Err("a normal quantity has no ends: give it a range".to_owned()),
            },
            Kind::Triangular { low, mode, high } => {
                let (width, rise) = (high - low, mode - low);
                let value = if probability * width < rise {
                    low + width * (probability * (rise / width)).sqrt()
                } else {
                    high - width * ((1.0 - probability) * ((high - mode) / width)).sqrt()
                };
                value.clamp(low, high)
            }
        })
    }

    /// Expected value.
    pub fn mean(&self) -> f64 {
        match self.0 {
            Kind::Uniform([low, high]) => low + 0.5 * (high - low),
            Kind::Normal { mean, .. } => mean,
            Kind::Triangular { low, mode, high } => low + ((mode - low) + (high - low)) / 3.0,
        }
    }

    /// Standard deviation.
    pub fn deviation(&self) -> f64 {
        match self.0 {
            Kind::Uniform([low, high]) => (high - low) / 12.0_f64.sqrt(),
            Kind::Normal { deviation, .. } => deviation,
            Kind::Triangular { low, mode, high } => {
                let (width, rise) = (high - low, (mode - low) / (high - low));
                width * ((1.0 - rise * (1.0 - rise)) / 18.0).sqrt()
            }
        }
    }
}

/// Values at a point of the unit cube, one distribution for each coordinate.
///
/// # Errors
/// If the numbers of coordinates and distributions differ, or a coordinate has no value, [`Distribution::value`].
pub fn values(distributions: &[Distribution], point: &[f64]) -> Result<Vec<f64>, String> {
    if distributions.len() != point.len() {
        return Err(format!(
            "{} coordinates for {} distributions",
            point.len(),
            distributions.len()
        ));
    }
    distributions.iter().zip(point).map(|(d, p)| d.value(*p)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use proptest::prelude::*;

    use super::super::Sobol;
    use super::*;

    #[test]
    fn what_is_no_distribution_is_refused() {
        assert!(Distribution::uniform(1.0, 1.0).is_err());
        assert!(Distribution::uniform(f64::NAN, 1.0).is_err());
        assert!(Distribution::uniform(-f64::MAX, f64::MAX).is_err());
        assert!(Distribution::normal(0.0, 0.0).is_err());
        assert!(Distribution::normal(f64::INFINITY, 1.0).is_err());
        assert!(Distribution::normal(0.0, f64::MAX).is_err());
        assert!(Distribution::triangular(0.0, 2.0, 1.0).is_err());
        assert!(Distribution::triangular(0.0, f64::NAN, 1.0).is_err());
        let one = [Distribution::uniform(0.0, 1.0).unwrap()];
        assert!(
            values(&one, &[0.5, 0.5]).is_err() && values(&one, &[1.1]).is_err() && values(&one, &[f64::NAN]).is_err()
        );
        assert_eq!(values(&one, &[0.25]).unwrap(), [0.25]);
    }

    #[test]
    fn ends_belong_to_what_has_ends() {
        for d in [
            Distribution::uniform(-1.0, 3.0).unwrap(),
            Distribution::triangular(-1.0, 0.0, 3.0).unwrap(),
        ] {
            assert_eq!([0.0, 1.0].map(|p| d.value(p).unwrap()), [-1.0, 3.0]);
        }
        let normal = Distribution::normal(0.0, 1.0).unwrap();
        assert!(normal.value(0.0).unwrap_err().contains("range") && normal.value(1.0).is_err());
    }

    #[test]
    fn moments_are_those_of_the_values() {
        // Quadrature by 4096 Sobol points: their error is about 1/4096 of the range, more in the tails of the normal one.
        let sobol = Sobol::new(1).unwrap();
        for d in [
            Distribution::uniform(-1.0, 3.0).unwrap(),
            Distribution::normal(2.0, 0.5).unwrap(),
            Distribution::triangular(0.0, 1.0, 4.0).unwrap(),
            Distribution::triangular(0.0, 0.0, 4.0).unwrap(),
            Distribution::triangular(0.0, 4.0, 4.0).unwrap(),
        ] {
            let list: Vec<f64> = (0..4096).map(|i| d.value(sobol.point(i)[0]).unwrap()).collect();
            let mean = list.iter().sum::<f64>() / 4096.0;
            let variance = list.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 4096.0;
            assert!((mean - d.mean()).abs() < 1e-3, "{d:?} {mean}");
            assert!((variance.sqrt() - d.deviation()).abs() < 2e-3, "{d:?} {variance}");
        }
    }

    proptest! {
        #[test]
        fn values_rise_and_stay_inside(low in -10.0..10.0_f64, width in 1e-6..20.0_f64, share in 0.0..=1.0_f64,
                                       p in 1e-9..0.999_f64) {
            let high = low + width;
            let mode = (low + share * width).min(high);
            for d in [Distribution::uniform(low, high).unwrap(), Distribution::triangular(low, mode, high).unwrap()] {
                let [a, b] = [p, p + 5e-4].map(|p| d.value(p).unwrap());
                prop_assert!(low <= a && a <= b && b <= high);
            }
        }

        #[test]
        fn triangular_values_give_their_probability_back(mode in 0.0..=1.0_f64, p in 1e-6..0.999_999_f64) {
            let x = Distribution::triangular(0.0, mode, 1.0).unwrap().value(p).unwrap();
            let back = if x < mode { x * x / mode } else { 1.0 - (1.0 - x) * (1.0 - x) / (1.0 - mode).max(1e-300) };
            prop_assert!((back - p).abs() < 1e-9);
        }
    }
}
