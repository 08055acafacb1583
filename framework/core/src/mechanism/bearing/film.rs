//! The oil film of a plain bearing or a thrust washer, as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BearingEntry, BearingKind};

/// The oil film of a plain bearing or a thrust washer.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct BearingFilm {
    /// Clearance over diameter of a plain bearing, or state `clearance`; 0.0005 to 0.003 are usual. [-]
    #[schemars(range(min = 1e-5, max = 0.05))]
    pub relative_clearance: Option<f64>,
    /// Diameter of the bush minus diameter of the shaft of a plain bearing, or state `relative_clearance`. [um]
    #[schemars(range(min = 0.1, max = 10_000.0))]
    pub clearance: Option<f64>,
    /// Film thickness of a plain bearing below which its surfaces touch: mixed friction. [um]
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub least_thickness: Option<f64>,
    /// Coefficient of friction of a plain bearing where its surfaces touch, default 0.1; of a thrust washer under its axial load, default:
    /// none, the film of the stated gap carries the load. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub solid_friction: Option<f64>,
    /// Heat that a plain bearing gives off to shaft and housing, per K; its film then has the temperature at which it gives off its loss.
    /// Default: the film has the temperature of the oil at the bearing. [W/K]
    #[schemars(range(min = 0.001, max = 1e5))]
    pub conductance: Option<f64>,
    /// Temperature of shaft and housing, for `conductance`; default: that of the oil at the bearing. [degC]
    #[schemars(range(min = -60.0, max = 200.0))]
    pub surroundings: Option<f64>,
    /// Fresh oil replaces the oil that leaves the film at its sides and carries heat away, for `conductance`.
    #[serde(default)]
    pub fed: bool,
    /// Temperature of the fresh oil, for `fed`; default: that of the oil at the bearing. [degC]
    #[schemars(range(min = -60.0, max = 200.0))]
    pub supply: Option<f64>,
    /// The load keeps its direction in space although shaft and `outer` both turn, as between coaxial shafts. Default: the load keeps its
    /// direction relative to the shaft or to `outer`, as in the housing or on a planet.
    #[serde(default)]
    pub load_fixed_in_space: bool,
    /// Oil gap of a thrust washer; the sum of both gaps if it floats between two faces. [um]
    #[schemars(range(min = 0.1, max = 10_000.0))]
    pub gap: Option<f64>,
    /// Share of the ring between `bore` and `outside` that the pads of a thrust washer cover; default: all of it. [-]
    #[schemars(range(min = 0.01, max = 1.0))]
    pub pad_share: Option<f64>,
}

/// The film of a bearing, with what its kind needs and nothing that its kind does not use.
pub(super) fn checked(entry: &BearingEntry, kind: BearingKind, bore: f64) -> Result<Option<BearingFilm>, String> {
    let name = kind.name();
    if kind.rolls() {
        return match entry.film {
            Some(_) => Err(format!(
                "`film` applies to plain bearings and thrust washers, not to `{name}`: delete it, or write `kind: plain`"
            )),
            None => Ok(None),
        };
    }
    let film = entry.film.unwrap_or_default();
    let example = match kind {
        BearingKind::ThrustWasher => "{ gap: 50 um }",
        _ => "{ relative_clearance: 0.0015, least_thickness: 3 um }",
    };
    let needs = |key: &str| format!("`{name}` needs `film.{key}`: write `film: {example}` with your values");
    let refused = |keys: &[(&str, bool)]| match keys.iter().find(|(_, stated)| *stated) {
        Some((key, _)) => Err(format!("`film.{key}` does not apply to `{name}`: delete it")),
        None => Ok(()),
    };
    if kind == BearingKind::ThrustWasher {
        film.gap.ok_or_else(|| needs("gap"))?;
        refused(&[
            ("relative_clearance", film.relative_clearance.is_some()),
            ("clearance", film.clearance.is_some()),
            ("least_thickness", film.least_thickness.is_some()),
            ("conductance", film.conductance.is_some()),
            ("surroundings", film.surroundings.is_some()),
            ("fed", film.fed),
            ("supply", film.supply.is_some()),
            ("load_fixed_in_space", film.load_fixed_in_space),
        ])?;
        return Ok(Some(film));
    }
    refused(&[("gap", film.gap.is_some()), ("pad_share", film.pad_share.is_some())])?;
    entry
        .width
        .ok_or_else(|| format!("`{name}` needs `width`: add the width of the running surface"))?;
    let relative_clearance = match (film.relative_clearance, film.clearance) {
        (Some(_), Some(_)) => {
            return Err("`film` has both `relative_clearance` and `clearance`: delete one of them".to_owned());
        }
        (Some(relative), None) => relative,
        (None, Some(clearance)) => clearance / bore,
        (None, None) => return Err(needs("relative_clearance")),
    };
    let least = film.least_thickness.ok_or_else(|| needs("least_thickness"))?;
    let greatest = 0.5 * relative_clearance * bore;
    if least >= greatest {
        return Err(format!(
            "`film.least_thickness` {} um is not below the clearance of the radius, {} um, so that there is never a film: correct one of them",
            least * 1e6,
            greatest * 1e6
        ));
    }
    if film.conductance.is_none() {
        let of_balance = [
            ("surroundings", film.surroundings.is_some()),
            ("fed", film.fed),
            ("supply", film.supply.is_some()),
        ];
        if let Some((key, _)) = of_balance.iter().find(|(_, stated)| *stated) {
            return Err(format!(
                "`film.{key}` is used with `film.conductance` only: add it, such as `conductance: 2 W/K`, or delete `{key}`"
            ));
        }
    }
    if film.supply.is_some() && !film.fed {
        return Err("`film.supply` is used with `film.fed` only: write `fed: true`, or delete `supply`".to_owned());
    }
    Ok(Some(BearingFilm {
        relative_clearance: Some(relative_clearance),
        ..film
    }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::loads::Thrust;
    use crate::mechanism::bearing::BearingPart;

    /// A plain bearing of 60 mm with a film that changes are applied to.
    fn plain(change: impl FnOnce(&mut BearingEntry, &mut BearingFilm)) -> Result<BearingPart, String> {
        let mut film = BearingFilm {
            clearance: Some(90e-6),
            least_thickness: Some(3e-6),
            ..BearingFilm::default()
        };
        let mut entry = BearingEntry {
            kind: Some(BearingKind::Plain),
            bore: Some(0.06),
            width: Some(0.03),
            ..BearingEntry::default()
        };
        change(&mut entry, &mut film);
        entry.film = entry.film.or(Some(film));
        BearingPart::try_from(entry)
    }

    #[test]
    fn a_plain_bearing_has_a_relative_clearance_and_no_outside_diameter() {
        let part = plain(|_, _| ()).unwrap();
        assert!((part.film.unwrap().relative_clearance.unwrap() - 1.5e-3).abs() < 1e-15);
        assert_eq!((part.outside, part.raceway), (0.06, 0.03));
        assert_eq!(part.carries().thrust, Thrust::None);
    }

    #[test]
    fn what_a_film_lacks_or_does_not_use_is_named() {
        type Change = fn(&mut BearingEntry, &mut BearingFilm);
        let cases: [(Change, &str); 9] = [
            (|_, film| film.clearance = None, "needs `film.relative_clearance`"),
            (|_, film| film.relative_clearance = Some(1e-3), "delete one of them"),
            (|_, film| film.least_thickness = None, "needs `film.least_thickness`"),
            (|_, film| film.least_thickness = Some(45e-6), "never a film"),
            (|_, film| film.gap = Some(1e-4), "`film.gap` does not apply"),
            (
                |_, film| film.fed = true,
                "`film.fed` is used with `film.conductance` only",
            ),
            (
                |_, film| (film.conductance, film.supply) = (Some(1.0), Some(40.0)),
                "write `fed: true`",
            ),
            (|entry, _| entry.width = None, "needs `width`"),
            (
                |entry, _| {
                    (entry.kind, entry.outside) = (Some(BearingKind::DeepGrooveBall), Some(0.11));
                },
                "`film` applies to plain bearings",
            ),
        ];
        for (change, named) in cases {
            let fault = plain(change).unwrap_err();
            assert!(fault.contains(named), "{fault}");
        }
    }

    #[test]
    fn a_thrust_washer_needs_its_gap_and_carries_thrust_only() {
        let washer = |film: Option<BearingFilm>| {
            BearingPart::try_from(BearingEntry {
                kind: Some(BearingKind::ThrustWasher),
                bore: Some(0.02),
                outside: Some(0.03),
                film,
                ..BearingEntry::default()
            })
        };
        assert!(washer(None).unwrap_err().contains("needs `film.gap`"));
        let gap = BearingFilm {
            gap: Some(5e-5),
            ..BearingFilm::default()
        };
        let carries = washer(Some(gap)).unwrap().carries();
        assert_eq!((carries.radial, carries.thrust), (false, Thrust::OneDirection));
        let mixed_up = BearingFilm { fed: true, ..gap };
        assert!(
            washer(Some(mixed_up))
                .unwrap_err()
                .contains("`film.fed` does not apply")
        );
    }
}
