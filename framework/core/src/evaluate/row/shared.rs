//! What does not differ between the points of a block.

use crate::loss::{Loss, Undefined};

/// What one part answered where all lanes carry the same, as beside a gear that idles: mostly the same in all blocks of a row.
#[derive(Debug, Clone)]
pub(super) struct Shared<K> {
    /// What they carry.
    at: Option<K>,
    answer: Result<Loss, Undefined>,
    /// True where the notes stand among the common ones.
    noted: bool,
}

impl<K: Copy + PartialEq> Shared<K> {
    /// Nothing was asked yet.
    pub const NONE: Self = Self {
        at: None,
        answer: Ok(Loss::POWERS),
        noted: false,
    };

    /// The answer for what they carry now, asked for where that has moved.
    pub fn answer(&mut self, at: K, ask: impl FnOnce() -> Result<Loss, Undefined>) -> Result<Loss, Undefined> {
        if self.at != Some(at) {
            *self = Self {
                at: Some(at),
                answer: ask(),
                noted: false,
            };
        }
        self.answer
    }

    /// The same where asking also notes: asked for again unless the notes stand already.
    pub fn note(&mut self, at: K, ask: impl FnOnce() -> Result<Loss, Undefined>) {
        if self.at != Some(at) || !self.noted {
            *self = Self {
                at: Some(at),
                answer: ask(),
                noted: true,
            };
        }
    }

    /// Where the common notes stand for something else now.
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
        let asked = std::cell::Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            Ok(Loss::POWERS)
        };
        for (load, answers) in [(1.0, 1), (1.0, 1), (2.0, 2), (1.0, 3)] {
            assert!(shared.answer(load, ask).is_ok());
            assert_eq!(asked.get(), answers, "{load}");
        }
        for (load, answers) in [(1.0, 4), (1.0, 4), (2.0, 5), (2.0, 5)] {
            shared.note(load, ask);
            assert_eq!(asked.get(), answers, "{load}");
        }
        // The answer serves, but the notes have to be made again, by whichever way they were lost.
        assert!(shared.answer(2.0, ask).is_ok());
        assert_eq!(asked.get(), 5);
        shared.overwritten();
        shared.note(2.0, ask);
        assert_eq!(asked.get(), 6);
        // What is no number is the same as nothing.
        for answers in [7, 8] {
            shared.note(f64::NAN, ask);
            assert_eq!(asked.get(), answers);
        }
    }
}
