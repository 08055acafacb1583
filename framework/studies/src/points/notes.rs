//! Notes on limits and observed quantities with the paths of their models, and evidence of models.

use super::PointResult;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use gearloss_framework::loads::LEAST_STATIC_SAFETY;
use gearloss_framework::loss::Extent;
use gearloss_framework::registry::{Evidence, Instance};
use gearloss_framework::resolve::{Resolved, ValueSource, lookup};
use gearloss_framework::transmission::Transmission;

/// Name of the note of a bearing's static safety.
pub const STATIC_SAFETY: &str = "S0 = C0/P0";

/// One limit or observed quantity over many points.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Note {
    /// Path of the model.
    pub path: String,
    /// Symbol.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Minimum; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub least: f64,
    /// Maximum; null if it is not finite.
    #[schemars(with = "Option<f64>")]
    pub greatest: f64,
    /// Number of points with the quantity.
    pub points: u32,
    /// Number of points outside the stated range; zero for an observed quantity.
    pub outside: u32,
    /// The stated range; absent for an observed quantity.
    pub range: Option<Stated>,
    /// Share of its component in the loss of all points; absent if it is not known. [-]
    pub loss_share: Option<f64>,
}

/// Losses of all components, summed over points in whole numbers of nanowatts, so that no sum depends on the order of the points.
#[derive(Debug, Clone, Default)]
pub struct LostByPart(Vec<i128>);

impl LostByPart {
    /// One nanowatt. \[W\]
    const UNIT: f64 = 1e-9;

    /// Of some points.
    pub fn of<'p>(points: impl IntoIterator<Item = &'p PointResult>) -> Self {
        let mut lost = Self::default();
        for point in points {
            let watts = point.parts.iter().map(|watts| (watts / Self::UNIT) as i128);
            lost.add(watts.collect());
        }
        lost
    }

    /// Adds further points.
    pub fn merge(&mut self, other: &Self) {
        self.add(other.0.clone());
    }

    fn add(&mut self, losses: Vec<i128>) {
        self.0.resize(self.0.len().max(losses.len()), 0);
        for (sum, loss) in self.0.iter_mut().zip(losses) {
            *sum = sum.saturating_add(loss);
        }
    }

    /// The share of the components that use a model, by its path.
    fn share(&self, transmission: &Transmission, path: &str) -> Option<f64> {
        let sum = |losses: &mut dyn Iterator<Item = &i128>| {
            losses.fold(0, |sum: i128, loss| sum.saturating_add(*loss)) as f64
        };
        let all = sum(&mut self.0.iter());
        let uses = |model: &str| path == model || path.strip_prefix(model).is_some_and(|rest| rest.starts_with('.'));
        let parts = transmission.parts().iter().zip(&self.0);
        let own = parts.filter(|(part, _)| {
            let model = &transmission.instances()[part.notes.instance()].path;
            uses(model) || part.path == path
        });
        let mut own = own.map(|(_, loss)| loss).peekable();
        (all > 0.0 && own.peek().is_some()).then(|| sum(&mut own) / all)
    }
}

/// As [`notes`], with the share of each component in the loss.
pub fn notes_with_shares(transmission: &Transmission, seen: &[Extent], lost: &LostByPart) -> Vec<Note> {
    let mut notes = notes(transmission, seen);
    for note in &mut notes {
        note.loss_share = lost.share(transmission, &note.path);
    }
    notes
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
    /// Provenance.
    pub origin: &'static str,
}

/// Notes on all limits and observed quantities, and on bearings with insufficient static safety.
pub fn notes(transmission: &Transmission, seen: &[Extent]) -> Vec<Note> {
    let mut notes = Vec::new();
    for instance in transmission.instances() {
        for limit in instance.entry.limits {
            let extent = seen[instance.notes.limits() + limit.index];
            let stated = Stated {
                least: limit.least,
                greatest: limit.greatest,
                origin: limit.origin,
            };
            notes.extend(note(instance, limit.name, limit.unit, extent, Some(stated)));
        }
        for observed in instance.entry.observed {
            notes.extend(note(
                instance,
                observed.name,
                observed.unit,
                seen[instance.notes.observed() + observed.index],
                None,
            ));
        }
    }
    // Sufficient safety is not reported.
    let rated = transmission.rated().iter().zip(&seen[transmission.rated_cells()..]);
    notes.extend(rated.filter(|(_, seen)| seen.outside > 0).map(|(rated, seen)| Note {
        path: transmission.supports()[rated.support].clone(),
        name: STATIC_SAFETY,
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
        loss_share: None,
    }));
    notes
}

fn note(
    instance: &Instance,
    name: &'static str,
    unit: &'static str,
    extent: Extent,
    range: Option<Stated>,
) -> Option<Note> {
    (extent.seen > 0).then(|| Note {
        path: instance.path.clone(),
        name,
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
    /// The grade.
    pub grade: Evidence,
    /// Reason of the grade.
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
            let path = format!("{}.{}", instance.path, graded.key);
            let value = lookup(&resolved.value, &path);
            let own = written(&path) || *resolved.source_of(&path) == ValueSource::Override;
            // A parameter whose default is used, or one that the model sets itself.
            if !own || value.is_none_or(Value::is_null) {
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
                _ => Evidence::User,
            };
            let owner = path.rsplit_once('.').map_or(path.as_str(), |(owner, _)| owner);
            let what = format!("catalogue row {designation}");
            if !points
                .iter()
                .any(|p| p.what == what && p.paths.iter().any(|p| p == owner))
            {
                match points.iter_mut().find(|p| p.what == what) {
                    Some(point) => point.paths.push(owner.to_owned()),
                    None => points.push(WeakPoint {
                        what,
                        grade,
                        because: format!("confidence {confidence}"),
                        paths: vec![owner.to_owned()],
                    }),
                }
            }
        }
    }
    points.sort_by(|a, b| b.grade.cmp(&a.grade).then_with(|| a.what.cmp(&b.what)));
    points
}
