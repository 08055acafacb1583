//! The losses of one part in all lanes.

use super::{LANES, Lane, Powers, each, gather, over};
use crate::loss::{Loss, MOST_TERMS, Measure, Term, Undefined};

/// The losses of one part in all lanes: what [`Loss`] is for a point.
#[derive(Debug, Clone)]
pub struct LossLanes {
    measure: Measure,
    /// False while no answer has said the measure.
    measured: bool,
    values: [Lane; MOST_TERMS],
    /// Terms that have values; what stands in the others counts for nothing.
    terms: usize,
    /// What the model wants again where it notes.
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

    /// Begins an answer as [`Loss::MOMENTS`] or [`Loss::POWERS`] do; every term is zero.
    #[inline]
    pub fn begin(&mut self, like: &Loss) {
        self.measure = like.measure();
        self.measured = true;
        self.terms = 0;
        self.alone = [false; LANES];
    }

    /// Adds to a term a value for each lane, given by its place: N m for moments, W for powers.
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

    /// Keeps a number of each lane for the time when the model notes at the same loads.
    pub fn keep(&mut self, numbers: &Lane) {
        self.kept = *numbers;
    }

    /// What was kept last.
    pub fn kept(&self) -> &Lane {
        &self.kept
    }

    /// Powers of loads and the like, which may remember those of the speed before.
    pub fn powers(&mut self) -> &mut Powers {
        &mut self.powers
    }

    /// Makes room for some terms, which are zero.
    #[inline(always)]
    fn grow(&mut self, terms: usize) {
        while self.terms < terms {
            self.values[self.terms] = Lane::ZERO;
            self.terms += 1;
        }
    }

    /// Forgets all answers, before the first pass of a block; `wanted` says in which lanes there is a point.
    pub(crate) fn clear(&mut self, wanted: &[bool; LANES]) {
        self.begin(&Loss::POWERS);
        self.measured = false;
        self.wanted = *wanted;
    }

    /// Says in which lanes an answer is still wanted.
    pub(crate) fn want(&mut self, wanted: &[bool; LANES]) {
        self.wanted = *wanted;
    }

    /// False where nobody reads the answer any more: a model that is asked once for each lane may pass over it.
    pub fn wanted(&self, lane: usize) -> bool {
        self.wanted[lane]
    }

    /// Takes over the answer for one lane. What is undefined, or in another measure than that of the lanes before, is left to an
    /// evaluation of that point alone, which says why.
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

    /// Takes over one answer for all lanes, as [`put`](Self::put) for each.
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

    /// Leaves a lane to an evaluation of its point alone.
    pub fn leave(&mut self, lane: usize) {
        self.alone[lane] = true;
    }

    /// Whether a lane agrees with an answer for its point alone within a share of it, where none asks for the same bits; or is left to it.
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

    /// Lanes that are left to an evaluation of their point alone.
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

    /// What `end` makes of the sum of all terms times a factor, in each lane.
    #[inline(always)]
    fn sum(&self, factor: f64, end: impl Fn(f64) -> f64) -> Lane {
        let step = |[sum]: [f64; 1], values: &Lane, i: usize| [sum + values[i] * factor];
        gather(self.values[..self.terms].iter(), [0.0], step, |[sum], _| end(sum))
    }

    /// What `end` makes of the powers of all terms together (W) at a relative speed in rad/s.
    #[inline(always)]
    pub(crate) fn total_watts(&self, speed: f64, end: impl Fn(f64) -> f64) -> Lane {
        self.sum(self.factor(speed), end)
    }

    /// What the values are.
    pub(crate) fn measure(&self) -> Measure {
        self.measure
    }

    /// The sums of all terms, in their measure. Leaves the lanes whose answer counts for nothing: negative, no number, or beside a thrust
    /// that nothing takes.
    #[inline(always)]
    pub(crate) fn sound_sum(&mut self, untaken: &Lane) -> Lane {
        let mut unsound = 0_u64;
        // No negative part and a finite sum, or no sum beside a thrust that nothing takes.
        let sound = |sum: f64, least: f64, untaken: f64| {
            let most = if untaken == 0.0 { f64::MAX } else { 0.0 };
            least >= 0.0 && sum <= most
        };
        // What is no number passes by the least one and stands in the sum.
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
                // Or torques of this lane would be no numbers, at which no model is asked.
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

    const FIRST: Term = Term::load(0, "first");
    const SECOND: Term = Term::no_load(1, "second");

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
            // Whatever stood there before.
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
