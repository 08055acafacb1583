//! Values that are equal for all points of a block.

use crate::loss::{Loss, Undefined};

/// Result of one part in a block whose lanes have equal loads, as at an idling gear: usually the same in all blocks of a batch.
#[derive(Debug, Clone)]
pub(super) struct Shared<K> {
    /// The loads.
    at: Option<K>,
    answer: Result<Loss, Undefined>,
    /// True if the notes are among the shared ones.
    noted: bool,
}

impl<K: Copy + PartialEq> Shared<K> {
    /// Not evaluated yet.
    pub const NONE: Self = Self {
        at: None,
        answer: Ok(Loss::POWERS),
        noted: false,
    };

    /// The result for the present loads, evaluated again if they have changed.
    pub fn answer(&mut self, at: K, evaluate: impl FnOnce() -> Result<Loss, Undefined>) -> Result<Loss, Undefined> {
        if self.at != Some(at) {
            *self = Self {
                at: Some(at),
                answer: evaluate(),
                noted: false,
            };
        }
        self.answer
    }

    /// The same for an evaluation that also writes notes: evaluated again unless the notes are already shared.
    pub fn note(&mut self, at: K, evaluate: impl FnOnce() -> Result<Loss, Undefined>) {
        if self.at != Some(at) || !self.noted {
            *self = Self {
                at: Some(at),
                answer: evaluate(),
                noted: true,
            };
        }
    }

    /// Invalidates the shared notes.
    pub fn overwritten(&mut self) {
        self.noted = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_asked_for_where_the_load_moved_and_noted_once() {
        let mut shared = Shared::NONE;
        let calls = std::cell::Cell::new(0);
        let evaluate = || {
            calls.set(calls.get() + 1);
            Ok(Loss::POWERS)
        };
        for (load, answers) in [(1.0, 1), (1.0, 1), (2.0, 2), (1.0, 3)] {
            assert!(shared.answer(load, evaluate).is_ok());
            assert_eq!(calls.get(), answers, "{load}");
        }
        for (load, answers) in [(1.0, 4), (1.0, 4), (2.0, 5), (2.0, 5)] {
            shared.note(load, evaluate);
            assert_eq!(calls.get(), answers, "{load}");
        }
        // The result is reused, but the notes must be written again, in whichever way they were lost.
        assert!(shared.answer(2.0, evaluate).is_ok());
        assert_eq!(calls.get(), 5);
        shared.overwritten();
        shared.note(2.0, evaluate);
        assert_eq!(calls.get(), 6);
        // NaN is equal to nothing.
        for answers in [7, 8] {
            shared.note(f64::NAN, evaluate);
            assert_eq!(calls.get(), answers);
        }
    }
}
