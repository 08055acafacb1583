//! The losses of one part in all lanes.

use super::{LANES, Lane, Powers, each, gather, over};
use crate::loss::{Loss, MOST_TERMS, Measure, Term, Undefined};

/// The losses of one part in all lanes: the batched [`Loss`].
#[derive(Debug, Clone)]
pub struct LossLanes {
    measure: Measure,
    /// False until a result has set the measure.
    measured: bool,
    values: [Lane; MOST_TERMS],
    /// Terms that have values; the others are ignored.
    terms: usize,
    /// Values that the model uses again when it writes notes.
    kept: Lane,
    powers: Powers,
    alone: [bool; LANES],
    wanted: [bool; LANES],
}

impl LossLanes {
    /// No loss, in any lane.
    pub const NONE: Self = Self {
        measure: Measure::Power,
        measured: false,
        values: [Lane::all(0.0); MOST_TERMS],
        terms: 0,
        kept: Lane::ZERO,
        powers: Powers::EXACT,
        alone: [false; LANES],
        wanted: [true; LANES],
    };

    /// The same with a memory of powers.
    pub(crate) fn remembering() -> Self {
        Self {
            powers: Powers::remembering(),
            ..Self::NONE
        }
    }

    /// Starts a result as [`Loss::MOMENTS`] or [`Loss::POWERS`] do; every term is zero.
    #[inline]
    pub fn begin(&mut self, like: &Loss) {
        self.measure = like.measure();
        self.measured = true;
        self.terms = 0;
        self.alone = [false; LANES];
    }

    /// Adds to a term a value for each lane, given by its index: N m for moments, W for powers.
    #[inline(always)]
    pub fn add(&mut self, term: &Term, value: impl Fn(usize) -> f64) {
        if term.index < self.terms {
            let sum = &mut self.values[term.index];
            *sum = each(|i| sum[i] + value(i));
        } else {
            self.grow(term.index);
            self.values[term.index] = each(value);
            self.terms = term.index + 1;
        }
    }

    /// Keeps a number of each lane for the notes at the same loads.
    pub fn keep(&mut self, numbers: &Lane) {
        self.kept = *numbers;
    }

    /// The number kept last.
    pub fn kept(&self) -> &Lane {
        &self.kept
    }

    /// Powers of loads and similar, which may remember those of the previous speed.
    pub fn powers(&mut self) -> &mut Powers {
        &mut self.powers
    }

    /// Initialises some terms with zero.
    #[inline(always)]
    fn grow(&mut self, terms: usize) {
        while self.terms < terms {
            self.values[self.terms] = Lane::ZERO;
            self.terms += 1;
        }
    }

    /// Clears all results, before the first iteration of a block; `wanted` marks the lanes with a point.
    pub(crate) fn clear(&mut self, wanted: &[bool; LANES]) {
        self.begin(&Loss::POWERS);
        self.measured = false;
        self.wanted = *wanted;
    }

    /// Marks the lanes whose result is still needed.
    pub(crate) fn want(&mut self, wanted: &[bool; LANES]) {
        self.wanted = *wanted;
    }

    /// False if the result is no longer needed: a model that is evaluated once for each lane may skip the lane.
    pub fn wanted(&self, lane: usize) -> bool {
        self.wanted[lane]
    }

    /// Stores the result for one lane. An undefined result, or one in another measure than the previous lanes, excludes the lane,
    /// so that an evaluation of the single point gives the reason.
    pub fn put(&mut self, lane: usize, answer: Result<Loss, Undefined>) {
        let loss = answer.unwrap_or(Loss::POWERS);
        if answer.is_ok() && !self.measured {
            (self.measure, self.measured) = (loss.measure(), true);
        }
        self.alone[lane] = answer.is_err() || loss.measure() != self.measure;
        for term in 0..MOST_TERMS {
            let value = if self.alone[lane] { 0.0 } else { loss.value(term) };
            if value != 0.0 {
                self.grow(term + 1);
            }
            if term < self.terms {
                self.values[term][lane] = value;
            }
        }
    }

    /// Stores one result for all lanes, as [`put`](Self::put) for each.
    pub(crate) fn put_all(&mut self, answer: Result<Loss, Undefined>) {
        let loss = answer.unwrap_or(Loss::POWERS);
        self.begin(&loss);
        for term in (0..MOST_TERMS).filter(|term| loss.value(*term) != 0.0) {
            self.grow(term);
            self.values[term] = Lane::all(loss.value(term));
            self.terms = term + 1;
        }
        self.alone = [answer.is_err(); LANES];
    }

    /// Excludes a lane, whose point is then evaluated as a single point.
    pub fn leave(&mut self, lane: usize) {
        self.alone[lane] = true;
    }

    /// True if a lane agrees with the result of its single point within a relative tolerance (not to the bit), or is excluded.
    pub(crate) fn agrees(&self, lane: usize, answer: &Result<Loss, Undefined>, within: f64) -> bool {
        let same = |loss: &Loss| {
            let terms = (0..MOST_TERMS).all(|term| {
                let value = if term < self.terms {
                    self.values[term][lane]
                } else {
                    0.0
                };
                (value - loss.value(term)).abs() <= within * loss.value(term).abs()
            });
            terms && (self.measure == loss.measure() || loss.sum() == 0.0)
        };
        self.alone[lane] || answer.as_ref().is_ok_and(same)
    }

    /// Excluded lanes.
    pub(crate) fn alone(&self) -> &[bool; LANES] {
        &self.alone
    }

    /// Powers of one term at a relative speed in rad/s. \[W\]
    #[inline(always)]
    pub fn watts(&self, term: usize, speed: f64) -> Lane {
        if term >= self.terms {
            return Lane::ZERO;
        }
        let factor = self.factor(speed);
        over(&self.values[term], |value| value * factor)
    }

    /// Power per value at a relative speed in rad/s.
    #[inline(always)]
    fn factor(&self, speed: f64) -> f64 {
        match self.measure {
            Measure::Moment => speed.abs(),
            Measure::Power => 1.0,
        }
    }

    /// The result of `end` for the sum of all terms times a factor, in each lane.
    #[inline(always)]
    fn sum(&self, factor: f64, end: impl Fn(f64) -> f64) -> Lane {
        let step = |[sum]: [f64; 1], values: &Lane, i: usize| [sum + values[i] * factor];
        gather(self.values[..self.terms].iter(), [0.0], step, |[sum], _| end(sum))
    }

    /// The result of `end` for the total power of all terms (W) at a relative speed in rad/s.
    #[inline(always)]
    pub(crate) fn total_watts(&self, speed: f64, end: impl Fn(f64) -> f64) -> Lane {
        self.sum(self.factor(speed), end)
    }

    /// The measure of the values.
    pub(crate) fn measure(&self) -> Measure {
        self.measure
    }

    /// The sums of all terms, in their measure. Excludes the lanes whose result is invalid: negative, NaN, or with untaken thrust.
    #[inline(always)]
    pub(crate) fn sound_sum(&mut self, untaken: &Lane) -> Lane {
        let mut unsound = 0_u64;
        // No negative part and a finite sum, or no sum with untaken thrust.
        let sound = |sum: f64, least: f64, untaken: f64| {
            let most = if untaken == 0.0 { f64::MAX } else { 0.0 };
            least >= 0.0 && sum <= most
        };
        // NaN passes the minimum and remains in the sum.
        let step = |[sum, least]: [f64; 2], values: &Lane, i: usize| {
            [sum + values[i], if values[i] < least { values[i] } else { least }]
        };
        let sum = gather(self.values[..self.terms].iter(), [0.0; 2], step, |[sum, least], i| {
            unsound |= u64::from(!sound(sum, least, untaken[i]));
            sum
        });
        if unsound == 0 {
            return sum;
        }
        for i in 0..LANES {
            let own = self.values[..self.terms].iter().map(|values| values[i]);
            if !sound(sum[i], own.fold(0.0, f64::min), untaken[i]) {
                self.alone[i] = true;
                // Otherwise torques of this lane would be NaN, at which no model is evaluated.
                for values in &mut self.values[..self.terms] {
                    values[i] = 0.0;
                }
            }
        }
        self.sum(1.0, |sum| sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terms;

    terms! {
        FIRST = load("first");
        SECOND = no_load("second");
    }

    #[test]
    fn lanes_have_the_bits_of_single_losses() {
        let speed = -7.3;
        let loss = |i: usize| {
            Loss::MOMENTS
                .with(&FIRST, 0.1 * i as f64)
                .with(&SECOND, 0.3 / (1.0 + i as f64))
        };
        let mut lanes = LossLanes::NONE;
        for i in 0..LANES {
            lanes.put(i, Ok(loss(i)));
        }
        for i in 0..LANES {
            assert_eq!(lanes.total_watts(speed, |watts| watts)[i], loss(i).total_watts(speed));
            assert_eq!(lanes.sum(1.0, |sum| sum)[i], loss(i).total_moment(speed));
            assert_eq!(lanes.watts(1, speed)[i], loss(i).watts(1, speed));
        }
    }

    #[test]
    fn one_answer_for_all_lanes_is_that_answer_in_each() {
        let undefined = Undefined {
            what: "nothing",
            value: 0.0,
        };
        let some = Loss::MOMENTS.with(&SECOND, 0.7);
        for answer in [Ok(some), Ok(some.with(&FIRST, 0.1)), Ok(Loss::POWERS), Err(undefined)] {
            // Overwrites any previous value.
            let mut together = LossLanes::NONE;
            together.add(&FIRST, |_| 3.0);
            together.leave(5);
            together.put_all(answer);
            let mut single = LossLanes::NONE;
            for lane in 0..LANES {
                single.put(lane, answer);
                assert!(together.agrees(lane, &answer, 0.0));
            }
            assert_eq!(together.alone(), single.alone());
            for double in [|x| x, |x| 2.0 * x] {
                assert_eq!(together.total_watts(-3.0, double), single.total_watts(-3.0, double));
            }
        }
    }

    #[test]
    fn what_is_no_sound_number_is_left_alone() {
        let mut lanes = LossLanes::NONE;
        for i in 0..LANES {
            lanes.put(i, Ok(Loss::POWERS.with(&FIRST, 1.0)));
        }
        let undefined = Undefined {
            what: "nothing",
            value: 0.0,
        };
        lanes.put(1, Ok(Loss::POWERS.with(&FIRST, -1.0)));
        lanes.put(2, Ok(Loss::POWERS.with(&FIRST, f64::NAN)));
        lanes.put(3, Ok(Loss::POWERS.with(&FIRST, f64::INFINITY)));
        lanes.put(4, Ok(Loss::MOMENTS.with(&FIRST, 1.0)));
        lanes.put(5, Err(undefined));
        let mut untaken = Lane::all(0.0);
        untaken[6] = 3.0;
        let sum = lanes.sound_sum(&untaken);
        assert_eq!((sum[0], sum[1], sum[6]), (1.0, 0.0, 0.0));
        let left: Vec<usize> = (0..LANES).filter(|i| lanes.alone()[*i]).collect();
        assert_eq!(left, [1, 2, 3, 4, 5, 6]);
        lanes.begin(&Loss::POWERS);
        assert_eq!(lanes.total_watts(1.0, |watts| watts), Lane::all(0.0));
    }
}
