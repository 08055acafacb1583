//! Which set predicts best, and whether the points decide it.

use gearloss_numerics::inference::{
    Accuracy, Comparison, FittedModel, PointSet, Succession, Validation, akaike, neighbours, ranking,
};
use gearloss_studies::identify::Observation;
use gearloss_studies::study::IdentifyEntry;
use serde_json::{Value, json};

use super::super::Runner;
use super::super::table::TableFile;
use super::super::write::cell;
use super::outcome::Outcome;
use crate::output::{Failure, Out, Table, figures, number};

/// The accuracies over which sets are compared, for each observation: the root of their mean square over the sets, because an accuracy in
/// percent, and that of an instrument, are those at the loss that a set calculates. Absent where the sets were fitted to different observations.
fn common_deviations(outcomes: &[Outcome<'_>]) -> Option<Vec<f64>> {
    let lists: Vec<&[Observation]> = outcomes.iter().map(|o| o.identification.observations()).collect();
    let key = |o: &Observation| (o.row, o.quantity);
    let same = |list: &&[Observation]| list.iter().map(key).eq(lists[0].iter().map(key));
    if !lists.iter().all(same) {
        return None;
    }
    let mean = |i: usize| lists.iter().map(|list| list[i].deviation.powi(2)).sum::<f64>() / lists.len() as f64;
    Some((0..lists[0].len()).map(|i| mean(i).sqrt()).collect())
}

/// One set beside the first one.
struct Set {
    model: FittedModel,
    /// Probability of the misfit, where accuracies are stated.
    probability: Option<f64>,
    /// The first set against this one; absent for the first itself.
    against: Option<Comparison>,
}

/// Sets in the order of the decisions, and the sentence that follows.
pub struct Compared {
    sets: Vec<Set>,
    sentence: String,
}

/// A set with its residuals over common accuracies.
fn model(o: &Outcome<'_>, common: &[f64]) -> Option<FittedModel> {
    let inference = &o.fitted.inference;
    let in_common = |list: &[f64]| -> Vec<f64> {
        let own = o.identification.observations().iter().zip(common);
        let pairs = list.iter().zip(own);
        pairs
            .map(|(residual, (own, common))| residual * own.deviation / common)
            .collect()
    };
    let residuals = in_common(inference.residuals());
    let squares = residuals.iter().map(|r| r * r).sum();
    let folds = o.folds.as_ref().and_then(|folds| folds.as_ref().ok());
    let (points, parameters) = (inference.residuals().len(), inference.parameters().len());
    let lack = o.checks.lack.is_some_and(|lack| lack.widening().is_some());
    let together = o.checks.succession.as_ref().is_some_and(Succession::is_suspect);
    Some(FittedModel {
        name: o.name.clone(),
        parameters,
        criterion: akaike(squares, points, parameters, inference.accuracy())?,
        validation: folds.and_then(|(folds, found)| Validation::new(folds, &in_common(&found.errors))),
        residuals,
        scatter: match inference.accuracy() {
            Accuracy::Given => 1.0,
            Accuracy::Estimated => inference.scatter(),
        },
        is_suspect: lack || together,
    })
}

/// Neighbouring observations of one quantity, gear state and temperature, and the shapes of common errors: for each quantity a share of the
/// accuracy, a gain and an offset.
fn points(o: &Outcome<'_>, common: &[f64]) -> PointSet {
    let measured = o.identification.measured();
    let observations = o.identification.observations();
    let value = |i: usize, quantity: &str| {
        measured
            .value(&measured.rows[observations[i].row], quantity)
            .unwrap_or(0.0)
    };
    let mut points = PointSet::default();
    for quantity in o.quantities() {
        let over = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let of = |i: usize| {
                if observations[i].quantity == quantity {
                    value(i) / common[i]
                } else {
                    0.0
                }
            };
            (0..observations.len()).map(of).collect()
        };
        points
            .shapes
            .extend([over(&|i| common[i]), over(&|i| o.pairs[1][i].measured), over(&|_| 1.0)]);
    }
    for sheet in &o.sheets {
        for quantity in o.quantities() {
            let own = |i: &usize| observations[*i].quantity == quantity && sheet.rows.contains(&observations[*i].row);
            let places: Vec<usize> = (0..observations.len()).filter(own).collect();
            let [torques, speeds] =
                ["torque", "speed"].map(|q| places.iter().map(|i| value(*i, q)).collect::<Vec<f64>>());
            let of_places = |cell: Vec<usize>| cell.into_iter().map(|k| places[k]).collect();
            points.cells.extend(
                neighbours(&torques, &speeds, &vec![0.0; places.len()])
                    .into_iter()
                    .map(of_places),
            );
        }
    }
    points
}

/// Compares the sets, prints a table and a sentence. Absent where there is nothing to compare, or it would not be just.
pub fn compare(
    runner: &Runner<'_>,
    name: &str,
    outcomes: &[Outcome<'_>],
    out: &mut Out,
) -> Result<Option<Compared>, Failure> {
    if outcomes.len() < 2 {
        return Ok(None);
    }
    // Sets are compared over the same numbers only, by sums of squares that were made small.
    let squares = |o: &Outcome<'_>| o.fitted.factors.is_empty() && !o.fitted.inference.is_robust();
    let common = common_deviations(outcomes).filter(|_| outcomes.iter().all(squares));
    let Some(common) = common else {
        let words = "the sets are not compared: they were fitted to different rows, by a robust loss or with factors of the accuracies";
        out.line(format!("{name}: {words}\n"))?;
        return Ok(None);
    };
    let Some(models) = outcomes.iter().map(|o| model(o, &common)).collect::<Option<Vec<_>>>() else {
        return Ok(None);
    };
    let set_of_points = points(&outcomes[0], &common);
    let order = ranking(&models, &set_of_points);
    let first = order[0];
    let set = |place: &usize| Set {
        against: (*place != first).then(|| Comparison::new(&models[first], &models[*place], &set_of_points)),
        model: models[*place].clone(),
        probability: outcomes[*place].checks.lack.map(|lack| lack.probability),
    };
    let sets: Vec<Set> = order.iter().map(set).collect();
    let quoted = |name: &str| format!("`{name}`");
    let clauses = sets.iter().filter_map(|set| {
        Some(
            set.against?
                .words(&quoted(&sets[0].model.name), &quoted(&set.model.name)),
        )
    });
    let compared = Compared {
        sentence: clauses.collect::<Vec<_>>().join("; "),
        sets,
    };
    show(name, &compared, out)?;
    runner.verdict(format!("{name}: {}", compared.sentence), out)?;
    out.line("")?;
    Ok(Some(compared))
}

impl Set {
    fn gap(&self, first: &Self) -> f64 {
        self.model.criterion - first.model.criterion
    }

    fn folds(&self) -> Option<Vec<f64>> {
        Some(self.model.validation.as_ref()?.fold_rms())
    }
}

fn show(name: &str, compared: &Compared, out: &mut Out) -> Result<(), Failure> {
    let Some(first) = compared.sets.first() else {
        return Ok(());
    };
    out.line(format!(
        "{name}: the sets side by side; wins and ratio are those of `{}` against the set of the line",
        first.model.name
    ))?;
    let head = [
        "set",
        "parameters",
        "AICc more",
        "rms of the bands",
        "wins",
        "ratio (95 %)",
        "lack of fit p",
        "decision",
    ];
    let mut table = Table::new(&head);
    for set in &compared.sets {
        let folds = set.against.and_then(|c| c.folds);
        let rms = set.folds().map_or_else(
            || "-".to_owned(),
            |list| list.iter().map(|x| figures(*x, 3)).collect::<Vec<_>>().join(" "),
        );
        table.row(vec![
            set.model.name.clone(),
            set.model.parameters.to_string(),
            number(Some(set.gap(first)), 1),
            rms,
            folds.map_or_else(|| "-".to_owned(), |p| format!("{} of {}", p.won, p.folds)),
            folds.map_or_else(
                || "-".to_owned(),
                |p| {
                    format!(
                        "{} ({} to {})",
                        figures(p.ratio, 3),
                        figures(p.interval[0], 2),
                        figures(p.interval[1], 2)
                    )
                },
            ),
            match set.probability {
                None => "-".to_owned(),
                Some(p) if p < 0.001 => "<0.001".to_owned(),
                Some(p) => format!("{p:.3}"),
            },
            set.against
                .map_or_else(|| "-".to_owned(), |c| c.decision.name().replace('_', " ")),
        ]);
    }
    out.text(&table.render())?;
    Ok(())
}

/// The same as a table, `NAME-sets.csv`.
pub fn write(
    runner: &Runner<'_>,
    name: &str,
    entry: &IdentifyEntry,
    compared: Option<&Compared>,
) -> Result<(), Failure> {
    let Some((compared, first)) = compared.and_then(|c| Some((c, c.sets.first()?))) else {
        return Ok(());
    };
    let header = [
        "model_set",
        "parameters",
        "criterion_difference",
        "fold_rms",
        "folds",
        "folds_won_by_first",
        "ratio_of_first",
        "ratio_low",
        "ratio_high",
        "separation",
        "evidence",
        "correlation",
        "lack_of_fit_probability",
        "decision",
        "reason",
    ]
    .map(str::to_owned);
    let row = |set: &Set| {
        let (against, folds) = (set.against, set.against.and_then(|c| c.folds));
        let separation = against.and_then(|c| c.separation);
        let list = set.folds().unwrap_or_default();
        let mut cells = vec![
            set.model.name.clone(),
            set.model.parameters.to_string(),
            cell(Some(set.gap(first))),
        ];
        cells.push(list.iter().map(|x| cell(Some(*x))).collect::<Vec<_>>().join(" "));
        cells.push(list.len().to_string());
        cells.push(folds.map_or_else(String::new, |p| p.won.to_string()));
        let numbers = [
            folds.map(|p| p.ratio),
            folds.map(|p| p.interval[0]),
            folds.map(|p| p.interval[1]),
            separation.map(|s| s.square.sqrt()),
            separation.map(|s| s.evidence),
            separation.map(|s| s.correlation),
            set.probability,
        ];
        cells.extend(numbers.map(cell));
        cells.push(against.map_or_else(String::new, |c| c.decision.name().to_owned()));
        cells.push(against.map_or_else(String::new, |c| c.reason.name().to_owned()));
        cells
    };
    let mut table = TableFile::new(runner.run, &format!("{name}-sets"), &entry.write, &header)?;
    table.push_all(&compared.sets.iter().map(row).collect::<Vec<_>>())?;
    table.finish()
}

/// The same as JSON; null where nothing was compared.
pub fn json_of(compared: Option<&Compared>) -> Value {
    let Some((compared, first)) = compared.and_then(|c| Some((c, c.sets.first()?))) else {
        return Value::Null;
    };
    let set = |set: &Set| {
        let against = set.against.map(|c| {
            json!({
                "decision": c.decision.name(), "reason": c.reason.name(),
                "folds": c.folds.map(|p| json!({ "ratio": p.ratio, "interval": p.interval, "won": p.won, "groups": p.folds })),
                "separation": c.separation.map(|s| s.square.sqrt()), "evidence": c.separation.map(|s| s.evidence),
                "correlation": c.separation.map(|s| s.correlation),
            })
        });
        json!({
            "model_set": set.model.name, "parameters": set.model.parameters, "criterion_difference": set.gap(first),
            "fold_rms": set.folds(), "lack_of_fit_probability": set.probability, "first_against_it": against,
        })
    };
    json!({ "sentence": compared.sentence, "sets": compared.sets.iter().map(set).collect::<Vec<_>>() })
}
