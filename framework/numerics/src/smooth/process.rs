//! A Gaussian process with the mean zero and a squared exponential covariance.
//!
//! The covariance of the values at two places is s^2 exp(-1/2 sum ((x_k - x'_k)/l_k)^2), where each coordinate is divided by its range; each
//! value has its stated deviation and one more that is common to all, r, for what repeats of a measurement scatter beyond it. The unknown
//! s, r and l_k are not set to their most probable values, whose bands are too narrow for few values, but integrated: logarithms are uniform
//! between the limits below, and the likelihood weighs evenly distributed points of the region that it does not exclude.
//!
//! Source: Rasmussen, Williams, Gaussian Processes for Machine Learning, MIT Press 2006: predictions and likelihood, algorithm 2.1; leaving
//! one value out, equations 5.10 to 5.12.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::Hull;
use crate::sampling::Sobol;

/// Most values: the time of a fit grows with the third power of their number.
pub const MOST_VALUES: usize = 400;

/// Lengths over the range of a coordinate: below the first a function is not smooth, above the last it does not depend on the coordinate.
const LENGTHS: [f64; 2] = [0.2, 10.0];
/// Deviation of the function over the root mean square of the values.
const AMPLITUDES: [f64; 2] = [0.01, 5.0];
/// Further deviation of a value over the same.
const NOISES: [f64; 2] = [0.001, 1.0];

/// Numbers of points in the rounds that narrow the region, and of those that predict.
const ROUNDS: [u32; 3] = [256, 128, 128];
const MEMBERS: u32 = 16;
/// The next region reaches so many deviations to both sides, and is at least this share of the whole.
const REACH: f64 = 2.5;
const NARROWEST: f64 = 0.03;
/// Weight of a member, over the largest, below which it is left out.
const LEAST_WEIGHT: f64 = 1e-3;
/// Variance that is added for the sake of rounding, relative to that of the function.
const ROUNDING: f64 = 1e-9;
/// Half-width of the 95 % band in standard deviations.
const BAND: f64 = 1.959_963_985;

/// One set of unknowns with its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Its probability.
    pub weight: f64,
    /// Length of each coordinate over its range.
    pub lengths: Vec<f64>,
    /// Standard deviation of the function, in the unit of the values.
    pub amplitude: f64,
    /// Further standard deviation of a value, in the unit of the values.
    pub noise: f64,
}

/// The function at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predicted {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation, without that of a measurement.
    pub deviation: f64,
}

impl Predicted {
    /// Its 95 % band.
    pub fn band(&self) -> [f64; 2] {
        [self.mean - BAND * self.deviation, self.mean + BAND * self.deviation]
    }
}

/// Each value predicted by the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// Root mean square of the values.
    pub rms_before: f64,
    /// Root mean square of the values less their predictions.
    pub rms_after: f64,
    /// Share of the values inside the 95 % band of their prediction, which contains the deviation of a value.
    pub in_band: f64,
}

/// A member that is ready to predict.
#[derive(Debug, Clone)]
struct Ready {
    member: Member,
    factor: Cholesky<f64, Dyn>,
    /// Inverse of the covariance times the values.
    alpha: DVector<f64>,
}

/// A smooth function through values.
#[derive(Debug, Clone)]
pub struct Smooth {
    hull: Hull,
    ranges: Vec<[f64; 2]>,
    places: Vec<Vec<f64>>,
    values: DVector<f64>,
    deviations: Vec<f64>,
    members: Vec<Ready>,
}

impl Smooth {
    /// Through values at places, each with the standard deviation of its error. Absent without values.
    ///
    /// # Errors
    /// More than [`MOST_VALUES`], unequal numbers, or a number that is not finite.
    pub fn fit(places: &[Vec<f64>], values: &[f64], deviations: &[f64]) -> Result<Option<Self>, String> {
        let Some(mut smooth) = Self::empty(places, values, deviations)? else {
            return Ok(None);
        };
        let dimensions = smooth.ranges.len() + 2;
        let sobol = Sobol::new(dimensions)?;
        let squares = smooth.values.norm_squared() / values.len() as f64;
        let of_errors = deviations.iter().map(|d| d * d).sum::<f64>() / values.len() as f64;
        let size = squares.max(of_errors).sqrt();
        if size == 0.0 {
            // Nothing is wrong and nothing is uncertain.
            return Ok(Some(smooth));
        }
        let mut region = vec![LENGTHS.map(f64::ln); smooth.ranges.len()];
        region.push(AMPLITUDES.map(|x| (x * size).ln()));
        region.push(NOISES.map(|x| (x * size).ln()));
        let whole = region.clone();
        for count in ROUNDS {
            let tried = smooth.tried(&sobol, &region, count);
            region = narrowed(&whole, &region, &tried);
        }
        let tried = smooth.tried(&sobol, &region, MEMBERS);
        let members = weighed(&tried).into_iter().map(|(weight, at)| member(weight, &at));
        smooth.members = members.filter_map(|member| smooth.ready(member)).collect();
        if smooth.members.is_empty() {
            return Err("no smooth function fits the values".to_owned());
        }
        Ok(Some(smooth))
    }

    /// The function with known unknowns, as [`Smooth::members`] gave them.
    ///
    /// # Errors
    /// As [`Smooth::fit`]; members that do not fit the places, or with numbers that are not positive.
    pub fn with_members(
        places: &[Vec<f64>],
        values: &[f64],
        deviations: &[f64],
        members: Vec<Member>,
    ) -> Result<Option<Self>, String> {
        let Some(mut smooth) = Self::empty(places, values, deviations)? else {
            return Ok(None);
        };
        for member in members {
            let positive = |x: &f64| x.is_finite() && *x > 0.0;
            let positive = member.lengths.iter().all(positive)
                && [member.amplitude, member.noise, member.weight].iter().all(positive);
            if !positive || member.lengths.len() != smooth.ranges.len() {
                return Err("a member has a length, an amplitude, a noise or a weight that is not positive".to_owned());
            }
            let ready = smooth.ready(member);
            smooth
                .members
                .push(ready.ok_or("the covariance of a member is not positive")?);
        }
        let whole: f64 = smooth.members.iter().map(|ready| ready.member.weight).sum();
        for ready in &mut smooth.members {
            ready.member.weight /= whole;
        }
        Ok(Some(smooth))
    }

    fn empty(places: &[Vec<f64>], values: &[f64], deviations: &[f64]) -> Result<Option<Self>, String> {
        if values.len() > MOST_VALUES {
            return Err(format!("{} values are more than {MOST_VALUES}", values.len()));
        }
        if places.len() != values.len() || deviations.len() != values.len() {
            return Err("there are not as many places and deviations as values".to_owned());
        }
        let finite = values.iter().all(|x| x.is_finite()) && deviations.iter().all(|d| d.is_finite() && *d >= 0.0);
        if values.is_empty() {
            return Ok(None);
        }
        let hull = Hull::new(places).filter(|_| finite);
        let hull = hull.ok_or("a coordinate, a value or a deviation is not finite")?;
        let range = |k: usize| {
            let of = |ends: [f64; 2], place: &Vec<f64>| [ends[0].min(place[k]), ends[1].max(place[k])];
            let [low, high] = places.iter().fold([f64::INFINITY, f64::NEG_INFINITY], of);
            [low, if high > low { high - low } else { 1.0 }]
        };
        let ranges: Vec<[f64; 2]> = (0..places[0].len()).map(range).collect();
        Ok(Some(Self {
            places: places.iter().map(|place| scaled(&ranges, place)).collect(),
            hull,
            ranges,
            values: DVector::from_column_slice(values),
            deviations: deviations.to_vec(),
            members: Vec::new(),
        }))
    }

    /// The unknowns with their probabilities.
    pub fn members(&self) -> impl Iterator<Item = &Member> {
        self.members.iter().map(|ready| &ready.member)
    }

    /// The function at a place; absent outside of the hull of its places.
    pub fn at(&self, place: &[f64]) -> Option<Predicted> {
        if !self.hull.contains(place) {
            return None;
        }
        let place = scaled(&self.ranges, place);
        let of_members = self.members.iter().map(|ready| {
            let covariance = |other: &Vec<f64>| ready.member.covariance(&place, other);
            let to_values = DVector::from_iterator(self.places.len(), self.places.iter().map(covariance));
            let mean = to_values.dot(&ready.alpha);
            let known = ready.factor.l_dirty().solve_lower_triangular(&to_values);
            let known = known.map_or(0.0, |known| known.norm_squared());
            let variance = (ready.member.amplitude.powi(2) - known).max(0.0);
            (ready.member.weight, mean, variance)
        });
        Some(mixed(of_members))
    }

    /// Each value predicted by the others, with the unknowns of all.
    pub fn left_out(&self) -> LeftOut {
        let count = self.values.len() as f64;
        let inverses: Vec<DVector<f64>> = self
            .members
            .iter()
            .map(|ready| ready.factor.inverse().diagonal())
            .collect();
        let (mut before, mut after, mut inside) = (0.0, 0.0, 0.0);
        for (i, value) in self.values.iter().enumerate() {
            let of_members = self.members.iter().zip(&inverses).map(|(ready, inverse)| {
                let mean = value - ready.alpha[i] / inverse[i];
                (ready.member.weight, mean, 1.0 / inverse[i])
            });
            let found = mixed(of_members);
            let [low, high] = found.band();
            before += value * value;
            after += (value - found.mean).powi(2);
            inside += f64::from(u8::from(low <= *value && *value <= high));
        }
        LeftOut {
            rms_before: (before / count).sqrt(),
            rms_after: (after / count).sqrt(),
            in_band: inside / count,
        }
    }

    /// A member with the factor of its covariance; absent if that is not positive.
    fn ready(&self, member: Member) -> Option<Ready> {
        let factor = self.factor(&member)?;
        let alpha = factor.solve(&self.values);
        Some(Ready { member, factor, alpha })
    }

    fn factor(&self, member: &Member) -> Option<Cholesky<f64, Dyn>> {
        let count = self.places.len();
        let mut covariance = DMatrix::zeros(count, count);
        for i in 0..count {
            for j in 0..=i {
                let entry = member.covariance(&self.places[i], &self.places[j]);
                covariance[(i, j)] = entry;
                covariance[(j, i)] = entry;
            }
            let own = self.deviations[i].powi(2) + member.noise.powi(2) + ROUNDING * member.amplitude.powi(2);
            covariance[(i, i)] += own;
        }
        covariance.cholesky()
    }

    /// Logarithm of the likelihood of the values, but for a constant.
    fn likelihood(&self, member: &Member) -> f64 {
        let Some(factor) = self.factor(member) else {
            return f64::NEG_INFINITY;
        };
        let logs: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        let likelihood = -0.5 * self.values.dot(&factor.solve(&self.values)) - logs;
        if likelihood.is_finite() {
            likelihood
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Points of a region with their likelihoods.
    fn tried(&self, sobol: &Sobol, region: &[[f64; 2]], count: u32) -> Vec<(f64, Vec<f64>)> {
        let point = |i: u32| {
            let place = sobol.point(i);
            let at: Vec<f64> = region
                .iter()
                .zip(&place)
                .map(|([low, high], x)| low + x * (high - low))
                .collect();
            (self.likelihood(&member(1.0, &at)), at)
        };
        (0..count).map(point).collect()
    }
}

impl Member {
    /// Covariance of the function at two places.
    fn covariance(&self, a: &[f64], b: &[f64]) -> f64 {
        let square = |((x, y), length): ((&f64, &f64), &f64)| ((x - y) / length).powi(2);
        let squares: f64 = a.iter().zip(b).zip(&self.lengths).map(square).sum();
        self.amplitude.powi(2) * (-0.5 * squares).exp()
    }
}

fn member(weight: f64, logs: &[f64]) -> Member {
    let (lengths, others) = logs.split_at(logs.len() - 2);
    Member {
        weight,
        lengths: lengths.iter().map(|log| log.exp()).collect(),
        amplitude: others[0].exp(),
        noise: others[1].exp(),
    }
}

fn scaled(ranges: &[[f64; 2]], place: &[f64]) -> Vec<f64> {
    ranges
        .iter()
        .zip(place)
        .map(|([low, range], x)| (x - low) / range)
        .collect()
}

/// Mean and deviation of a mixture of normal distributions: weight, mean and variance of each.
fn mixed(all: impl Iterator<Item = (f64, f64, f64)>) -> Predicted {
    let (mut mean, mut square) = (0.0, 0.0);
    for (weight, of, variance) in all {
        mean += weight * of;
        square += weight * (variance + of * of);
    }
    Predicted {
        mean,
        deviation: (square - mean * mean).max(0.0).sqrt(),
    }
}

/// Points with their probabilities, without those that are improbable.
fn weighed(tried: &[(f64, Vec<f64>)]) -> Vec<(f64, Vec<f64>)> {
    let top = tried.iter().map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
    let weights = tried.iter().map(|(log, at)| ((log - top).exp(), at));
    let kept: Vec<(f64, &Vec<f64>)> = weights.filter(|(weight, _)| *weight >= LEAST_WEIGHT).collect();
    let whole: f64 = kept.iter().map(|(weight, _)| weight).sum();
    kept.into_iter()
        .map(|(weight, at)| (weight / whole, at.clone()))
        .collect()
}

/// The region that the likelihood does not exclude.
fn narrowed(whole: &[[f64; 2]], region: &[[f64; 2]], tried: &[(f64, Vec<f64>)]) -> Vec<[f64; 2]> {
    let weighed = weighed(tried);
    if weighed.is_empty() {
        return region.to_vec();
    }
    let narrow = |(k, [low, high]): (usize, &[f64; 2])| {
        let mean: f64 = weighed.iter().map(|(weight, at)| weight * at[k]).sum();
        let variance: f64 = weighed.iter().map(|(weight, at)| weight * (at[k] - mean).powi(2)).sum();
        // A single probable point says that its neighbours were missed.
        let spacing = (region[k][1] - region[k][0]) / (tried.len() as f64).powf(1.0 / whole.len() as f64);
        let half = (REACH * variance.sqrt())
            .max(NARROWEST * (high - low))
            .max(0.5 * spacing);
        [(mean - half).max(*low), (mean + half).min(*high)]
    };
    whole.iter().enumerate().map(narrow).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::sampling::{Generator, inverse_normal};

    /// An error of a model over torque in Nm and speed in rad/s, in Nm.
    fn error(place: &[f64]) -> f64 {
        0.3 + 0.4 * (place[0] / 60.0).sin() - 0.2 * (place[1] / 300.0 - 0.5).powi(2)
    }

    /// Places of a grid with a little disorder, and values with errors of a deviation.
    fn simulated(seed: u64, deviation: f64) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut generator = Generator::new(seed);
        let mut places = Vec::new();
        for torque in [10.0, 50.0, 100.0, 150.0, 200.0] {
            for speed in [50.0, 120.0, 200.0, 280.0, 350.0, 420.0] {
                places.push(vec![torque + 3.0 * generator.unit(), speed + 5.0 * generator.unit()]);
            }
        }
        let noise = |g: &mut Generator| inverse_normal(g.unit().clamp(1e-9, 1.0 - 1e-9)).unwrap();
        let values = places
            .iter()
            .map(|place| error(place) + deviation * noise(&mut generator));
        let values = values.collect();
        (places, values)
    }

    #[test]
    fn a_known_smooth_error_is_recovered() {
        let (places, values) = simulated(1, 0.01);
        let smooth = Smooth::fit(&places, &values, &[0.01; 30]).unwrap().unwrap();
        for place in [[40.0, 160.0], [125.0, 240.0], [180.0, 390.0], [75.0, 100.0]] {
            let found = smooth.at(&place).unwrap();
            assert!(
                (found.mean - error(&place)).abs() < 0.02,
                "{place:?} {found:?} {}",
                error(&place)
            );
        }
        let left = smooth.left_out();
        assert!(left.rms_after < 0.1 * left.rms_before, "{left:?}");
    }

    #[test]
    fn the_band_covers_the_function() {
        // Each corpus of values has one share of covered places; their mean is the coverage.
        let (mut inside, mut all) = (0, 0);
        for seed in 0..40 {
            let (places, values) = simulated(100 + seed, 0.05);
            let smooth = Smooth::fit(&places, &values, &[0.05; 30]).unwrap().unwrap();
            let mut generator = Generator::new(1000 + seed);
            for _ in 0..20 {
                let place = [20.0 + 170.0 * generator.unit(), 60.0 + 350.0 * generator.unit()];
                let [low, high] = smooth.at(&place).unwrap().band();
                inside += usize::from(low <= error(&place) && error(&place) <= high);
                all += 1;
            }
        }
        let coverage = inside as f64 / f64::from(all);
        assert!((0.90..=0.99).contains(&coverage), "{coverage}");
    }

    #[test]
    fn there_is_no_value_outside_of_the_data() {
        let (places, values) = simulated(2, 0.01);
        let smooth = Smooth::fit(&places, &values, &[0.01; 30]).unwrap().unwrap();
        for outside in [[205.0, 200.0], [100.0, 500.0], [5.0, 200.0], [100.0, 20.0]] {
            assert_eq!(smooth.at(&outside), None, "{outside:?}");
        }
    }

    #[test]
    fn without_values_there_is_no_correction_and_without_an_error_it_is_zero() {
        assert!(Smooth::fit(&[], &[], &[]).unwrap().is_none());
        let places: Vec<Vec<f64>> = (0..9).map(|i| vec![f64::from(i % 3), f64::from(i / 3)]).collect();
        let exact = Smooth::fit(&places, &[0.0; 9], &[0.0; 9]).unwrap().unwrap();
        assert_eq!(
            exact.at(&[1.5, 0.5]),
            Some(Predicted {
                mean: 0.0,
                deviation: 0.0
            })
        );
        // Zero within an accuracy is zero with a band.
        let within = Smooth::fit(&places, &[0.0; 9], &[0.1; 9]).unwrap().unwrap();
        let found = within.at(&[1.5, 0.5]).unwrap();
        assert!(
            found.mean.abs() < 1e-9 && found.deviation > 0.001 && found.deviation < 0.1,
            "{found:?}"
        );
    }

    #[test]
    fn its_members_give_it_again() {
        let (places, values) = simulated(3, 0.02);
        let smooth = Smooth::fit(&places, &values, &[0.02; 30]).unwrap().unwrap();
        let members = smooth.members().cloned().collect();
        let again = Smooth::with_members(&places, &values, &[0.02; 30], members)
            .unwrap()
            .unwrap();
        let (a, b) = (smooth.at(&[100.0, 200.0]).unwrap(), again.at(&[100.0, 200.0]).unwrap());
        assert!((a.mean - b.mean).abs() < 1e-12 && (a.deviation - b.deviation).abs() < 1e-12);
        let wrong = Member {
            weight: 1.0,
            lengths: vec![1.0],
            amplitude: 1.0,
            noise: 0.1,
        };
        assert!(Smooth::with_members(&places, &values, &[0.02; 30], vec![wrong]).is_err());
        assert!(Smooth::fit(&places, &[f64::NAN; 30], &[0.02; 30]).is_err());
        assert!(Smooth::fit(&vec![vec![0.0]; 401], &[0.0; 401], &[0.0; 401]).is_err());
    }
}
