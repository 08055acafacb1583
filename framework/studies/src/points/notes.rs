//! Notes on limits and observed quantities with the paths of their models, and evidence of models.

use std::collections::HashSet;

use super::{Driven, PointResult};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use gearloss_framework::loads::LEAST_STATIC_SAFETY;
use gearloss_framework::loss::{Extent, nanowatts};
use gearloss_framework::registry::{Evidence, Instance};
use gearloss_framework::resolve::{ESTIMATED, Resolved, ValueSource, lookup};
use gearloss_framework::transmission::{BearingPair, BodyTemperature, Transmission};

/// Name of the note of a bearing's static safety.
pub const STATIC_SAFETY: &str = "S0 = C0/P0";

/// One limit or observed quantity over many points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Note {
    /// Path of the model.
    pub path: String,
    /// Symbol.
    pub name: &'static str,
    /// Name of the quantity, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit of all values; `-` if there is none.
    pub unit: &'static str,
    /// Minimum noted value, in `unit`; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub least: f64,
    /// Maximum noted value, in `unit`; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub greatest: f64,
    /// Number of points at which it was noted.
    pub points: u32,
    /// Number of points outside the stated range; zero for an observed quantity.
    pub outside: u32,
    /// The stated range; null for an observed quantity.
    pub range: Option<Stated>,
    /// Loss of its component at the points outside the range as a share of the loss of all components at all points; of a cycle the same
    /// with energies. Null if it is not known. [-]
    pub loss_share: Option<f64>,
}

/// Loss of a transmission, summed over points in whole nanowatts, so that no sum depends on the order of the points.
#[derive(Debug, Clone, Copy, Default)]
pub struct TotalLoss(i128);

impl TotalLoss {
    /// Of some points; those without a power flow have none.
    pub fn of<'p>(points: impl IntoIterator<Item = &'p PointResult>) -> Self {
        let points = points.into_iter().filter(|point| point.status.has_flow());
        let watts = points.flat_map(|point| &point.parts);
        Self(watts.fold(0, |sum: i128, watts| sum.saturating_add(nanowatts(*watts))))
    }

    /// Adds further points.
    pub fn merge(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }
}

/// As [`notes`] of points, with the loss of each component at the points outside as a share of all losses.
pub fn notes_with_shares(transmission: &Transmission, seen: &[Extent], total: TotalLoss) -> Vec<Note> {
    notes_of(transmission, seen, &|cell| {
        (total.0 > 0).then(|| seen[cell].lost_outside as f64 / total.0 as f64)
    })
}

/// As [`notes`] of a cycle, with the energy that each component loses outside as a share of all lost energy.
pub fn notes_over_time(transmission: &Transmission, driven: &Driven) -> Vec<Note> {
    let total: f64 = driven.total.parts.iter().sum();
    notes_of(transmission, &driven.seen, &|cell| {
        let outside = driven.lost_outside.get(cell)?;
        (total > 0.0).then(|| outside / total)
    })
}

/// The stated range of a model, in the unit of the note.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Stated {
    /// Lower end; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub least: f64,
    /// Upper end; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub greatest: f64,
    /// Origin of the range.
    pub origin: &'static str,
}

/// Notes on all limits and observed quantities, on bearings with insufficient static safety, and on pairs with too weak a spring; none if
/// nothing was observed.
pub fn notes(transmission: &Transmission, seen: &[Extent]) -> Vec<Note> {
    if seen.is_empty() {
        return Vec::new();
    }
    notes_of(transmission, seen, &|_| None)
}

/// Merges notes of several transmissions: those on the same quantity with the same range become one, without a share of the loss.
pub fn merge_notes(total: &mut Vec<Note>, more: &[Note]) {
    for note in more {
        let is_same = |known: &&mut Note| {
            (&known.path, known.name, known.unit, known.range) == (&note.path, note.name, note.unit, note.range)
        };
        if let Some(known) = total.iter_mut().find(is_same) {
            known.least = known.least.min(note.least);
            known.greatest = known.greatest.max(note.greatest);
            known.points = known.points.saturating_add(note.points);
            known.outside = known.outside.saturating_add(note.outside);
            known.loss_share = None;
        } else {
            total.push(note.clone());
        }
    }
}

/// The notes with the share of the loss of each cell of a limit.
fn notes_of(transmission: &Transmission, seen: &[Extent], share: &dyn Fn(usize) -> Option<f64>) -> Vec<Note> {
    let is_of_part = |cell: usize| transmission.limited().iter().any(|(limited, _)| *limited == cell);
    let share = |cell: usize| share(cell).filter(|_| is_of_part(cell));
    let mut notes = Vec::new();
    for instance in transmission.instances() {
        for limit in instance.entry.limits {
            let cell = instance.notes.limits() + limit.index;
            let stated = Stated {
                least: limit.least,
                greatest: limit.greatest,
                origin: limit.origin,
            };
            let note = note(
                instance,
                [limit.name, limit.meaning, limit.unit],
                seen[cell],
                Some(stated),
            );
            notes.extend(note.map(|note| Note {
                loss_share: share(cell),
                ..note
            }));
        }
        for observed in instance.entry.observed {
            notes.extend(note(
                instance,
                [observed.name, observed.meaning, observed.unit],
                seen[instance.notes.observed() + observed.index],
                None,
            ));
        }
    }
    // Sufficient safety is not reported.
    let first = transmission.rated_cells();
    let rated = transmission.rated().iter().zip(&seen[first..]).zip(first..);
    notes.extend(
        rated
            .filter(|((_, seen), _)| seen.outside > 0)
            .map(|((rated, seen), cell)| Note {
                path: transmission.supports()[rated.support].clone(),
                name: STATIC_SAFETY,
                meaning: "static safety",
                unit: "-",
                least: seen.least,
                greatest: seen.greatest,
                points: seen.seen,
                outside: seen.outside,
                range: Some(Stated {
                    least: LEAST_STATIC_SAFETY,
                    greatest: f64::INFINITY,
                    origin: "static safety, ISO 76",
                }),
                loss_share: share(cell),
            }),
    );
    let first = transmission.pair_cells();
    let noted = transmission.pairs().iter().flat_map(|pair| {
        pair.noted().map(move |support| {
            let words = match pair.spring {
                Some(spring) if spring.support == support => &ON_SPRING,
                Some(_) => &AGAINST_SPRING,
                None => &PRELOADED,
            };
            (support, words)
        })
    });
    let noted = noted.zip(&seen[first..]).zip(first..);
    notes.extend(
        noted
            .filter(|((_, seen), _)| seen.outside > 0)
            .map(|(((support, words), seen), cell)| Note {
                path: transmission.supports()[support].clone(),
                name: words.name,
                meaning: words.meaning,
                unit: words.unit,
                least: seen.least,
                greatest: seen.greatest,
                points: seen.seen,
                outside: seen.outside,
                range: Some(Stated {
                    least: 0.0,
                    greatest: f64::INFINITY,
                    origin: words.origin,
                }),
                loss_share: share(cell),
            }),
    );
    notes
}

/// How a note on a bearing of a pair reads.
struct PairWords {
    name: &'static str,
    meaning: &'static str,
    unit: &'static str,
    origin: &'static str,
}

const ON_SPRING: PairWords = PairWords {
    name: "Fs - r Fr",
    meaning: "spring force less the thrust that the radial load induces",
    unit: "N",
    origin: "pair with a spring: below, less than half of the rolling elements carry",
};

const AGAINST_SPRING: PairWords = PairWords {
    name: "Fs + Ka - r Fr",
    meaning: "axial load less the thrust that the radial load induces",
    ..ON_SPRING
};

const PRELOADED: PairWords = PairWords {
    name: "closing",
    meaning: "distance by which the bearing is closed under its loads",
    unit: "um",
    origin: "pair with a preload or end play: below, less than half of the rolling elements carry, none without radial load",
};

fn note(
    instance: &Instance,
    [name, meaning, unit]: [&'static str; 3],
    extent: Extent,
    range: Option<Stated>,
) -> Option<Note> {
    (extent.seen > 0).then(|| Note {
        path: instance.path.clone(),
        name,
        meaning,
        unit,
        least: extent.least,
        greatest: extent.greatest,
        points: extent.seen,
        outside: extent.outside,
        range,
        loss_share: None,
    })
}

/// A formula, default or catalogue value that a result depends on, with its evidence grade.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct WeakPoint {
    /// Model, and the parameter if the grade is that of a default.
    pub what: String,
    /// Evidence grade.
    pub grade: Evidence,
    /// Reason or source of the grade.
    pub because: String,
    /// Paths that use it.
    pub paths: Vec<String>,
}

/// Evidence of everything that the transmission uses, the lowest grade first. Written parameters are the user's and omitted.
pub fn evidence(transmission: &Transmission, resolved: &Resolved, written: &dyn Fn(&str) -> bool) -> Vec<WeakPoint> {
    let mut points: Vec<WeakPoint> = Vec::new();
    let mut add =
        |what: String, grade: Evidence, because: &str, path: &str| match points.iter_mut().find(|p| p.what == what) {
            Some(point) => point.paths.push(path.to_owned()),
            None => points.push(WeakPoint {
                what,
                grade,
                because: because.to_owned(),
                paths: vec![path.to_owned()],
            }),
        };
    for instance in transmission.instances() {
        let entry = &instance.entry;
        if entry.name == "none" {
            continue;
        }
        let model = format!("{}/{}", entry.mechanism, entry.name);
        for graded in entry.evidence {
            if graded.key.is_empty() {
                add(model.clone(), graded.grade, graded.because, &instance.path);
                continue;
            }
            if instance.unused.contains(&graded.key) {
                continue;
            }
            let path = format!("{}.{}", instance.path, graded.key);
            let value = lookup(&resolved.value, &path);
            let is_stated = written(&path) || *resolved.source_of(&path) == ValueSource::Override;
            // A parameter whose default is used, or one that the model sets itself.
            if !is_stated || value.is_none_or(Value::is_null) {
                add(
                    format!("{model}.{}", graded.key),
                    graded.grade,
                    graded.because,
                    &instance.path,
                );
            }
        }
    }
    for (path, _) in resolved
        .sources
        .iter()
        .filter(|(_, came)| **came == ValueSource::Network)
    {
        let because = "capacities and conductances by size";
        add("network: auto".to_owned(), Evidence::Assumed, because, path);
    }
    for bearing in transmission.pairs().iter().flat_map(BearingPair::bearings) {
        if let Some((grade, because)) = bearing.induced.basis.evidence() {
            let what = format!("induced thrust by {}", bearing.induced.basis.words());
            add(what, grade, because, &transmission.supports()[bearing.support]);
        }
    }
    for (what, grade, because, path) in of_preloads(transmission) {
        add(what.to_owned(), grade, because, path);
    }
    let mut seen = HashSet::new();
    for (path, came) in &resolved.sources {
        if let ValueSource::Catalogue {
            designation,
            confidence,
        } = came
        {
            let grade = match confidence.as_str() {
                "high" => Evidence::SeveralSources,
                "medium" => Evidence::OneSource,
                "low" => Evidence::Recalled,
                "disputed" => Evidence::Disputed,
                ESTIMATED => Evidence::Assumed,
                _ => Evidence::User,
            };
            let owner = path.rsplit_once('.').map_or(path.as_str(), |(owner, _)| owner);
            let (what, because) = if confidence == ESTIMATED {
                (format!("estimates in catalogue row {designation}"), "a rule".to_owned())
            } else {
                (
                    format!("catalogue row {designation}"),
                    format!("confidence {confidence}"),
                )
            };
            if seen.insert((designation, confidence, owner)) {
                add(what, grade, &because, owner);
            }
        }
    }
    points.sort_by(|a, b| b.grade.cmp(&a.grade).then_with(|| a.what.cmp(&b.what)));
    points
}

/// Evidence of the preloads of pairs: what is graded, its grade and reason, the bearing.
fn of_preloads(transmission: &Transmission) -> Vec<(&'static str, Evidence, &'static str, &str)> {
    let mut graded = Vec::new();
    for pair in transmission.pairs() {
        let Some(preload) = &pair.preload else { continue };
        let path = transmission.supports()[preload.support].as_str();
        let (grade, because) = if preload.is_estimated {
            (Evidence::Assumed, "the internal geometry is estimated")
        } else {
            let because =
                "load integrals with the nominal contact angle, straight rollers, rigid rings, shaft and housing";
            (Evidence::Derived, because)
        };
        graded.push(("stiffness of preloaded bearings", grade, because, path));
        let is_oil = |body: &BodyTemperature| matches!(body, BodyTemperature::AboveOil { .. });
        if preload.temperatures.iter().any(is_oil) {
            let because = "shaft or housing at the temperature of the oil, or a stated difference from it";
            graded.push(("temperatures of a preload", Evidence::Assumed, because, path));
        }
    }
    graded
}
