//! Random numbers that are the same on every machine: each case has its own from the seed and its number, so that one case can be
//! run alone.

use crate::common::random_bits;

pub struct Random(u64);

impl Random {
    /// Numbers of one case.
    pub fn from_seed(seed: u64, case: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ case);
        random.bits();
        random
    }

    pub fn bits(&mut self) -> u64 {
        random_bits(&mut self.0)
    }

    /// A number below another one.
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end.max(1) as u64) as usize
    }

    /// True once in so many times.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// One of a list.
    pub fn one<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}
