//! The models against all sets of a corpus.

use gearloss_framework::language::Language;
use gearloss_framework::registry::Entry;
use gearloss_numerics::inference::probability::student_quantile;
use serde_json::Value;

use super::{Basis, Corpus, Set};
use crate::analyses::oil_property::{LawOfProperty, OilPropertyEntry, OilPropertyOutcome};
use crate::analyses::validation::{Cell, ValidatedModel, ValidationEntry, ValidationOutcome};
use crate::analyses::{AnalysisEntry, Engine, Outcome, Planner, Stopped};
use crate::distinct::distinct;
use crate::engine::progress::Progress;
use crate::run::StudyRun;

/// Number of sets below which only their ratios are stated, and no band.
pub const FEWEST_SETS: usize = 3;

/// The results of a corpus: of each set those of its analyses.
pub struct Validated<'a> {
    /// The sets with their results; none of a set that needs something.
    pub sets: Vec<(&'a Set, Vec<Judgement>)>,
}

/// The result of an analysis that judges something by a set.
#[derive(Debug, Clone)]
pub enum Judgement {
    /// Models by losses.
    Losses(ValidationOutcome),
    /// Laws by values of a property of oils.
    Property(OilPropertyOutcome),
}

impl Judgement {
    /// Whether an analysis judges something.
    pub(super) fn is_of(analysis: &AnalysisEntry) -> bool {
        analysis.entry::<ValidationEntry>().is_some() || analysis.entry::<OilPropertyEntry>().is_some()
    }

    /// As an outcome.
    pub fn outcome(&self) -> &dyn Outcome {
        match self {
            Self::Losses(outcome) => outcome,
            Self::Property(outcome) => outcome,
        }
    }

    /// Number of points, and number of models or laws.
    pub fn counts(&self) -> [usize; 2] {
        match self {
            Self::Losses(outcome) => [outcome.validation.points, outcome.validation.models.len()],
            Self::Property(outcome) => [outcome.oil_property.points, outcome.oil_property.laws.len()],
        }
    }

    /// The closest model or law with its cell.
    pub fn closest(&self) -> Option<(&str, &Cell)> {
        match self {
            Self::Losses(outcome) => outcome
                .validation
                .models
                .first()
                .map(|model| (model.name.as_str(), &model.all)),
            Self::Property(outcome) => outcome
                .oil_property
                .laws
                .first()
                .map(|law| (law.name.as_str(), &law.all)),
        }
    }
}

/// A model at one set.
#[derive(Debug, Clone, PartialEq)]
pub struct CellOfSet {
    /// Mechanism, with the slot of a drag.
    pub mechanism: String,
    /// Model with its nested models.
    pub model: String,
    /// The nested models, each as `mechanism/model`, joined by `+`.
    pub nested: String,
    /// Kinds of the judged components, joined by `+`.
    pub part: String,
    /// Name of the set.
    pub set: String,
    /// Where its numbers come from.
    pub kind: Basis,
    /// Whether constants of the model were derived from the set.
    pub seen: bool,
    /// The model at all points of the set.
    pub cell: Cell,
}

/// A model over the measured sets that it has not seen.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelOverSets {
    /// Mechanism.
    pub mechanism: String,
    /// Model with its nested models.
    pub model: String,
    /// The sets with the geometric mean of the ratio in each, the least first.
    pub sets: Vec<(String, f64)>,
    /// Whether the model is outside a stated range at every point of all sets.
    pub outside: bool,
    /// Geometric mean over the sets, and 95 % band for the mean of a further set; absent below three sets.
    pub band: Option<(f64, [f64; 2])>,
}

impl Corpus {
    /// Judges models by every set with a study.
    ///
    /// # Errors
    /// The first set that cannot run.
    pub fn validate(&self, language: &Language, progress: &dyn Progress) -> Result<Validated<'_>, Stopped> {
        let of_set = |set| Ok((set, judged(language, set, progress)?));
        let sets = self.sets.iter().map(of_set).collect::<Result<_, Stopped>>()?;
        Ok(Validated { sets })
    }
}

/// The results of the analyses of a set that judge models.
fn judged(language: &Language, set: &Set, progress: &dyn Progress) -> Result<Vec<Judgement>, Stopped> {
    let Some(study) = &set.study else { return Ok(Vec::new()) };
    let run = StudyRun::new(language, study);
    let mut all = Vec::new();
    for (name, analysis) in study.entry.analyses.iter() {
        if !Judgement::is_of(analysis) {
            continue;
        }
        let study = run.study_for_analysis();
        let planner = Planner::new(language, &study, name);
        let outcome = run.run(&Engine::new(&planner, progress))?;
        if let Some(found) = outcome.get::<ValidationOutcome>() {
            all.push(Judgement::Losses(found.clone()));
        } else if let Some(found) = outcome.get::<OilPropertyOutcome>() {
            all.push(Judgement::Property(found.clone()));
        }
    }
    Ok(all)
}

impl Validated<'_> {
    /// Every model at every set, sorted by mechanism, model and set.
    pub fn cells(&self, language: &Language) -> Vec<CellOfSet> {
        let mut all = Vec::new();
        for (set, results) in &self.sets {
            for judgement in results {
                let found = match judgement {
                    Judgement::Losses(outcome) => &outcome.validation,
                    Judgement::Property(outcome) => {
                        let cell = |law: &LawOfProperty| CellOfSet {
                            mechanism: format!("oil.{}", outcome.oil_property.name),
                            model: law.name.clone(),
                            nested: String::new(),
                            part: String::new(),
                            set: set.name.clone(),
                            kind: set.source.kind,
                            seen: false,
                            cell: law.all,
                        };
                        all.extend(outcome.oil_property.laws.iter().map(cell));
                        continue;
                    }
                };
                let cell = |model: &ValidatedModel| {
                    let nested = nested(language, &found.mechanism, &model.model);
                    let own = format!("{}/{}", found.mechanism, type_of(&model.model).unwrap_or_default());
                    CellOfSet {
                        seen: set.source.seen.iter().any(|seen| *seen == own || nested.contains(seen)),
                        mechanism: found.mechanism.clone(),
                        model: model.name.clone(),
                        nested: nested.join("+"),
                        part: found.part.clone(),
                        set: set.name.clone(),
                        kind: set.source.kind,
                        cell: model.all,
                    }
                };
                all.extend(found.models.iter().map(cell));
            }
        }
        all.sort_by(|a, b| (&a.mechanism, &a.model, &a.set).cmp(&(&b.mechanism, &b.model, &b.set)));
        all
    }
}

/// Each model over the measured sets that it has not seen, in the order of the cells. Several cells of one set count as one.
pub fn over_sets(cells: &[CellOfSet]) -> Vec<ModelOverSets> {
    let judged = |cell: &&CellOfSet| cell.kind == Basis::Measured && !cell.seen;
    let of_model = |cell: &CellOfSet| (cell.mechanism.clone(), cell.model.clone());
    let models = distinct(cells.iter().filter(judged).map(of_model));
    let model = |(mechanism, model): (String, String)| {
        let own = |cell: &&CellOfSet| judged(cell) && cell.mechanism == mechanism && cell.model == model;
        let names = distinct(cells.iter().filter(own).map(|cell| cell.set.clone()));
        let log = |set: &String| {
            let logs: Vec<f64> = cells
                .iter()
                .filter(own)
                .filter(|cell| cell.set == *set)
                .map(|cell| cell.cell.ratio.ln())
                .collect();
            logs.iter().sum::<f64>() / logs.len() as f64
        };
        let mut sets: Vec<(String, f64)> = names.iter().map(|set| (set.clone(), log(set))).collect();
        sets.sort_by(|a, b| a.1.total_cmp(&b.1));
        let band = band(&sets.iter().map(|(_, log)| *log).collect::<Vec<_>>());
        for (_, ratio) in &mut sets {
            *ratio = ratio.exp();
        }
        let outside = cells.iter().filter(own).all(|cell| cell.cell.in_range == 0.0);
        ModelOverSets {
            mechanism,
            model,
            sets,
            outside,
            band,
        }
    };
    models.into_iter().map(model).collect()
}

/// Geometric mean over sets and 95 % band for the mean of a further set, by Student's t over the logarithms of their means.
fn band(logs: &[f64]) -> Option<(f64, [f64; 2])> {
    if logs.len() < FEWEST_SETS {
        return None;
    }
    let count = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / count;
    let variance = logs.iter().map(|log| (log - mean) * (log - mean)).sum::<f64>() / (count - 1.0);
    let half = student_quantile(0.975, count - 1.0)? * (variance * (1.0 + 1.0 / count)).sqrt();
    Some((mean.exp(), [(mean - half).exp(), (mean + half).exp()]))
}

fn type_of(model: &Value) -> Option<&str> {
    model.as_str().or_else(|| model.get("type")?.as_str())
}

/// The models nested in a model, each as `mechanism/model`.
fn nested(language: &Language, mechanism: &str, model: &Value) -> Vec<String> {
    let of = type_of(model).and_then(|name| language.registry().model(mechanism, name));
    let slots = of.map(Entry::required_slots).unwrap_or_default();
    let named = slots
        .iter()
        .filter_map(|(key, mechanism)| Some(format!("{mechanism}/{}", type_of(model.get(key)?)?)));
    named.collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn cell(set: &str, kind: Basis, seen: bool, ratio: f64) -> CellOfSet {
        CellOfSet {
            mechanism: "bearing".to_owned(),
            model: "law".to_owned(),
            nested: String::new(),
            part: String::new(),
            set: set.to_owned(),
            kind,
            seen,
            cell: Cell {
                points: 1,
                ratio,
                least: ratio,
                greatest: ratio,
                bias_percent: 0.0,
                rms_percent: 0.0,
                max_percent: 0.0,
                in_band: None,
                in_range: 1.0,
                error: None,
                scatter: None,
            },
        }
    }

    #[test]
    fn sets_are_counted_and_not_points_and_only_measured_unseen_ones() {
        let all = over_sets(&[
            cell("a", Basis::Measured, false, 2.0),
            cell("a", Basis::Measured, false, 0.5),
            cell("b", Basis::Measured, false, 1.5),
            cell("tool", Basis::Calculated, false, 9.0),
            cell("own", Basis::Measured, true, 1.0),
        ]);
        assert_eq!(all.len(), 1);
        let near = |place: usize, name: &str, ratio: f64| {
            all[0].sets[place].0 == name && (all[0].sets[place].1 - ratio).abs() < 1e-12
        };
        assert!(all[0].sets.len() == 2 && near(0, "a", 1.0) && near(1, "b", 1.5));
        assert_eq!(all[0].band, None, "below three sets");
    }

    #[test]
    fn the_band_of_a_further_set_is_that_of_student() {
        // Logarithms -0.1, 0, 0.1: deviation 0.1; t of two degrees of freedom is 4.302653.
        let (mean, ends) = band(&[-0.1, 0.0, 0.1]).unwrap();
        let half = 4.302_652_7 * 0.1 * (4.0_f64 / 3.0).sqrt();
        assert!((mean - 1.0).abs() < 1e-12 && (ends[1].ln() - half).abs() < 1e-6 && (ends[0].ln() + half).abs() < 1e-6);
    }
}
