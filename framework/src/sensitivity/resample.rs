//! Resampling of rows, and quantiles of what comes of it.

/// A small generator of numbers that look random and are the same everywhere.
///
/// Source: Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014 (SplitMix64).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Generator(u64);

impl Generator {
    /// The generator of a stream; streams of neighbouring numbers have nothing in common.
    pub fn new(stream: u64) -> Self {
        let mut start = Self(stream);
        Self(start.draw())
    }

    /// The next 64 binary digits.
    fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// The next whole number below a bound; zero where the bound is zero.
    pub fn below(&mut self, bound: usize) -> usize {
        // The upper half of the product; its bias is that of the bound over 2^64.
        ((u128::from(self.draw()) * bound as u128) >> 64) as usize
    }
}

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
    fn published_numbers_of_the_generator() {
        // First outputs for the seed 1234567, as the reference program of the algorithm prints them.
        let mut generator = Generator(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        for x in expected {
            assert_eq!(generator.draw(), x);
        }
    }

    #[test]
    fn rows_are_drawn_evenly() {
        let mut generator = Generator::new(1);
        let mut counts = [0_u32; 10];
        for _ in 0..10_000 {
            counts[generator.below(10)] += 1;
        }
        // Six standard deviations of a count about 1000.
        assert!(counts.iter().all(|c| (820..1180).contains(c)), "{counts:?}");
        assert_eq!(generator.below(0), 0);
    }

    #[test]
    fn quantiles_lie_between_neighbours() {
        let list = [1.0, 2.0, 4.0];
        assert_eq!(quantile(&list, 0.0), Some(1.0));
        assert_eq!(quantile(&list, 0.75), Some(3.0));
        assert_eq!(quantile(&list, 1.0), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
