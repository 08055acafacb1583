//! Grease in a rolling bearing, as written.
//!
//! Sources: a bearing that starts churns its grease with much friction until the grease is distributed; then channels remain, and only oil that bleeds
//! out of the grease reaches the contacts (two publications). Catalogue values are those of this state; fresh grease has two to four times their viscous
//! friction (SKF and Harris, recalled). A maker of bearings fills them wholly for low speeds, and by 30 to 50 % for medium and high ones (its page, read).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BearingEntry, BearingKind, Lubrication};

/// Filling above which grease finds no space to leave the way of the rolling elements, except at low speed.
const MUCH: f64 = 0.5;

/// Grease in a rolling bearing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct BearingGrease {
    /// Share of the free space of the bearing that is filled: 0.3 to 0.5 for medium and high speeds, up to 1 for low ones. `check` asks for `churning`
    /// if it is more than 0.5; no law depends on it. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub filling: Option<f64>,
    /// Factor of churning on viscous friction, the rolling friction of `skf` and `contact` and the load-independent moment of Palmgren's form: 1 where
    /// grease has formed channels, for which catalogue values hold; 2 to 4 with fresh or too much grease. Default: 1. [-]
    #[schemars(range(min = 0.2, max = 10.0))]
    pub churning: Option<f64>,
}

impl BearingGrease {
    /// The filling, if grease in it churns unless the bearing is slow, and nothing is said about that.
    pub(crate) fn overfilled(&self) -> Option<f64> {
        self.filling
            .filter(|filling| *filling > MUCH && self.churning.is_none())
    }
}

/// Refuses grease where it is not used, and oil where grease is.
pub(super) fn check(entry: &BearingEntry, kind: BearingKind) -> Result<(), String> {
    if entry.lubrication != Lubrication::Grease {
        return match entry.grease {
            Some(_) => Err("`grease` without `lubrication: grease`: write it, or delete `grease`".to_owned()),
            None => Ok(()),
        };
    }
    if !kind.rolls() {
        return Err(format!(
            "no law of grease is known for `{}`: delete `lubrication: grease`, and choose a model such as `constant` for a greased bearing",
            kind.name()
        ));
    }
    match entry.oil_height {
        Some(_) => Err(
            "`oil_height` with `lubrication: grease`: a greased bearing is in no oil; delete one of them".to_owned(),
        ),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mechanism::bearing::BearingPart;

    fn greased(change: impl FnOnce(&mut BearingEntry)) -> Result<BearingPart, String> {
        let mut entry = BearingEntry {
            kind: Some(BearingKind::DeepGrooveBall),
            bore: Some(0.03),
            outside: Some(0.062),
            lubrication: Lubrication::Grease,
            ..BearingEntry::default()
        };
        change(&mut entry);
        BearingPart::try_from(entry)
    }

    #[test]
    fn channels_are_the_default() {
        assert_eq!(greased(|_| ()).unwrap().churning(), 1.0);
        let fresh = BearingGrease {
            churning: Some(3.0),
            ..BearingGrease::default()
        };
        assert_eq!(greased(|entry| entry.grease = Some(fresh)).unwrap().churning(), 3.0);
    }

    #[test]
    fn oil_and_grease_exclude_each_other() {
        type Change = fn(&mut BearingEntry);
        let cases: [(Change, &str); 3] = [
            (|entry| entry.oil_height = Some(0.01), "is in no oil"),
            (
                |entry| (entry.lubrication, entry.grease) = (Lubrication::Bath, Some(BearingGrease::default())),
                "without `lubrication: grease`",
            ),
            (
                |entry| {
                    (entry.kind, entry.width) = (Some(BearingKind::ThrustWasher), Some(0.002));
                    entry.film = Some(super::super::BearingFilm {
                        gap: Some(5e-5),
                        ..Default::default()
                    });
                },
                "no law of grease",
            ),
        ];
        for (change, named) in cases {
            let fault = greased(change).unwrap_err();
            assert!(fault.contains(named), "{fault}");
        }
    }

    #[test]
    fn a_full_bearing_needs_a_word_about_churning() {
        let grease = |filling, churning| BearingGrease { filling, churning };
        assert_eq!(grease(Some(0.8), None).overfilled(), Some(0.8));
        assert_eq!(grease(Some(0.8), Some(1.0)).overfilled(), None);
        assert_eq!(grease(Some(0.3), None).overfilled(), None);
    }
}
