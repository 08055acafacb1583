//! Pseudorandom numbers that are identical on every platform.

/// A small pseudorandom generator that is identical on every platform.
///
/// Source: Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014 (SplitMix64).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Generator(u64);

impl Generator {
    /// The generator of a stream; streams of neighbouring numbers are independent.
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

    /// The next integer below a bound; zero if the bound is zero.
    pub fn below(&mut self, bound: usize) -> usize {
        // The upper half of the product; its bias is bound / 2^64.
        ((u128::from(self.draw()) * bound as u128) >> 64) as usize
    }

    /// The next number from zero to one, without one: 53 random bits.
    pub fn unit(&mut self) -> f64 {
        (self.draw() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    /// A random permutation of a list.
    ///
    /// Source: Durstenfeld, Comm. ACM 7 (1964) 420 (algorithm 235).
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for place in (1..list.len()).rev() {
            list.swap(place, self.below(place + 1));
        }
    }
}

#[cfg(test)]
mod tests {
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
    fn every_order_is_as_likely_as_the_others() {
        let mut generator = Generator::new(7);
        let mut counts = std::collections::BTreeMap::new();
        for _ in 0..6000 {
            let mut list = [0, 1, 2];
            generator.shuffle(&mut list);
            *counts.entry(list).or_insert(0_u32) += 1;
        }
        // Six standard deviations of a count about 1000.
        assert!(
            counts.len() == 6 && counts.values().all(|c| (820..1180).contains(c)),
            "{counts:?}"
        );
        generator.shuffle::<u8>(&mut []);
    }
}
