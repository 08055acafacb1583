//! A corpus judged by its models: as a document, as text, as a page.

use std::fmt::Write as _;

use gearloss_framework::language::Language;
use gearloss_framework::registry::JudgedCell;
use gearloss_studies::analyses::validation::{ValidatedModel, ValidationOutcome};
use gearloss_studies::corpus::{
    Basis, CellOfSet, FEWEST_SETS, Judgement, LeftOut, ModelOverSets, Set, Validated, cells_csv, errors_of_laws,
    over_sets,
};

use crate::html::{Frame, Report, Section};
use crate::page::Page;
use crate::text::TextTable;
use crate::views::oil_property;
use crate::views::validation::{CELLS, by_regime, cells, coordinates, fitted, ratio_text};

/// What the document says before its tables.
const HEAD: &str = "\
# Validation: models against measured sets

`gearloss validate` writes this page: every number below is computed by it from the sets of the [corpus](../corpus/README.md). No model is
tuned. A ratio is the calculated over the measured loss, or property of an oil: 1 is exact, 2 is twice the measured one.

- *ratio* is the geometric mean over the points of a set, *least* and *greatest* are those of single points; *bias*, *rms* and *max* are of the
  calculated less the measured loss, in percent of the measured loss.
- *in band* is the share of points whose 95 % band of the ratio contains 1. The band comes from what the set does not state, with the ranges of its
  `source.md`, and from the accuracy of the measurement, which is taken as common to all points of a set.
- *in range* is the share of points at which the model is inside the range that its source states.
- Sets are counted, not points: points of one rig have its errors in common. Below three sets only their ratios are stated. From three sets on, the 95 %
  band is that of the mean of a further set, by Student's t over the logarithms of the means of the sets.
- *one factor* is a factor on the loss of the model that is fitted to the points at all other values of the condition that is left out, and predicts the rest: with
  it, the shape of the law is judged and not its level.
- Regimes are those of the points: speed, torque, oil temperature, bound columns, the viscosity of the oil, and the film ratio of flanks (lambda) or the viscosity ratio of rolling
  bearings (kappa), which the models of the gearbox of the set give.
- A set whose constants a model was derived from is marked `seen` and not counted for it.
";

/// What the document says before the errors of the models.
const ERROR: &str = "
## Error of the models

The factor is the measured over the calculated loss at a point of a further product, for models that at least three sets judge in one kind of component:
median and 95 % band. It contains the difference between sets, estimated as [random effects](decisions/model-error.md) with the error that each set has of its
own, and the scatter of the points of a set. Bands with [`model_error: corpus`](corpus.md#bands-that-contain-the-model) use these distributions. The last two
columns predict each set by the others: how many means, and how many sets with all their points, are inside the 95 % band. Of a model in the table of sets that is
not here, the error is unknown.
";

/// The document `docs/validation.md`.
pub fn document(language: &Language, validated: &Validated<'_>) -> String {
    let cells = validated.cells(language);
    let mut out = HEAD.to_owned();
    out.push_str("\n## Sets\n");
    table(
        &mut out,
        &["set", "what", "kind", "trust", "points", "models judged"],
        validated.sets.iter().map(|(set, results)| row_of_set(set, results)),
    );
    out.push_str("\n## Models over the measured sets\n");
    out.push_str(&over_sets_text(&over_sets(&cells)));
    out.push_str(&errors_text(&cells));
    for (set, results) in validated.sets.iter().filter(|(_, results)| !results.is_empty()) {
        let _ = write!(
            out,
            "\n## {}\n{} ({}, trust {}).",
            set.name,
            set.source.title,
            set.source.kind.words(),
            set.source.trust.words()
        );
        let _ = writeln!(out, " {}", note_of(set));
        if set.source.kind != Basis::Measured {
            let _ = writeln!(out, "\nNo measurement: it is not counted above.");
        }
        for judgement in results {
            match judgement {
                Judgement::Losses(outcome) => of_outcome(&mut out, set, outcome, &cells),
                Judgement::Property(outcome) => {
                    let (head, rows) = oil_property::cells(&outcome.oil_property);
                    table(&mut out, &head, rows.into_iter());
                    for (head, rows) in oil_property::parts(&outcome.oil_property) {
                        table(
                            &mut out,
                            &head.iter().map(String::as_str).collect::<Vec<_>>(),
                            rows.into_iter(),
                        );
                    }
                    if !outcome.oil_property.left_out.is_empty() {
                        let _ = writeln!(out, "\nNot judged: {}.", outcome.oil_property.left_out.join("; "));
                    }
                }
            }
        }
    }
    out
}

/// Where a set comes from, as a sentence.
fn note_of(set: &Set) -> String {
    format!(
        "By {}: {}; {}. Accuracy: {}.",
        set.source.who, set.source.published, set.source.obtained, set.source.accuracy
    )
}

fn row_of_set(set: &Set, results: &[Judgement]) -> Vec<String> {
    let count = |k: usize| results.iter().map(|judgement| judgement.counts()[k]).sum::<usize>();
    let [points, models] = [0, 1].map(count);
    vec![
        format!("[{0}](../corpus/{0}/source.md)", set.name),
        set.source.title.clone(),
        set.source.kind.words().to_owned(),
        set.source.trust.words().to_owned(),
        set.source
            .needs
            .as_ref()
            .map_or_else(|| points.to_string(), |_| "-".to_owned()),
        set.source
            .needs
            .as_ref()
            .map_or_else(|| models.to_string(), |needs| format!("needs: {needs}")),
    ]
}

/// The table over sets: one row for each model.
fn over_sets_text(models: &[ModelOverSets]) -> String {
    let mut out = String::new();
    let row = |model: &ModelOverSets| {
        let (first, last) = (model.sets.first(), model.sets.last());
        let band = model.band.map_or_else(
            || format!("- (fewer than {FEWEST_SETS} sets)"),
            |(mean, [low, high])| format!("{} ({} to {})", ratio_text(mean), ratio_text(low), ratio_text(high)),
        );
        let outside = if model.outside {
            ", outside its stated range"
        } else {
            ""
        };
        vec![
            model.mechanism.clone(),
            format!("{}{outside}", model.model),
            model.sets.len().to_string(),
            first.map_or_else(String::new, |(set, ratio)| format!("{} ({set})", ratio_text(*ratio))),
            last.map_or_else(String::new, |(set, ratio)| format!("{} ({set})", ratio_text(*ratio))),
            band,
        ]
    };
    table(
        &mut out,
        &[
            "mechanism",
            "model",
            "sets",
            "least ratio of a set",
            "greatest ratio of a set",
            "mean and band of a further set",
        ],
        models.iter().map(row),
    );
    out
}

/// The errors of the models that enough sets judge, and the coverage of all their bands.
fn errors_text(cells: &[CellOfSet]) -> String {
    let csv = cells_csv(cells);
    // What was just written can be read.
    let cells = JudgedCell::read(&csv).unwrap_or_default();
    let mut out = ERROR.to_owned();
    let mut all = LeftOut::default();
    let mut rows = Vec::new();
    for ([mechanism, model, part], error) in errors_of_laws(&cells) {
        let Some([low, middle, high]) = error.band() else {
            continue;
        };
        let left = error.left_out.unwrap_or_default();
        all.sets += left.sets;
        all.means_inside += left.means_inside;
        all.points_inside += left.points_inside;
        let inside = |count: usize| match left.sets {
            0 => "-".to_owned(),
            sets => format!("{count} of {sets}"),
        };
        rows.push(vec![
            mechanism.to_owned(),
            model.to_owned(),
            part.to_owned(),
            error.sets.len().to_string(),
            ratio_text(middle),
            format!("{} to {}", ratio_text(low), ratio_text(high)),
            inside(left.means_inside),
            inside(left.points_inside),
        ]);
    }
    table(
        &mut out,
        &[
            "mechanism",
            "model",
            "kind",
            "sets",
            "factor",
            "95 % band",
            "means inside",
            "all points inside",
        ],
        rows.into_iter(),
    );
    let _ = writeln!(
        out,
        "\nAll models together: {} of {} sets have their mean inside the band that the other sets give, {} all their points. The same sets judge each model, so that these are \
         not as many independent trials.",
        all.means_inside, all.sets, all.points_inside
    );
    out
}

/// The models at one set.
fn of_outcome(out: &mut String, set: &Set, outcome: &ValidationOutcome, all: &[CellOfSet]) {
    let found = &outcome.validation;
    let is_seen = |model: &ValidatedModel| {
        let own =
            |cell: &&CellOfSet| cell.set == set.name && cell.mechanism == found.mechanism && cell.model == model.name;
        all.iter().filter(own).any(|cell| cell.seen)
    };
    let row = |model: &ValidatedModel| {
        let mut row = cells(model);
        if is_seen(model) {
            row[0].push_str(" (seen)");
        }
        row
    };
    table(out, &CELLS, found.models.iter().map(row));
    if let Some((head, rows)) = fitted(found) {
        table(
            out,
            &head.iter().map(String::as_str).collect::<Vec<_>>(),
            rows.into_iter(),
        );
    }
    for (over, unit) in coordinates(found) {
        let (mut head, rows) = by_regime(found, over, unit);
        head[0] = format!("ratio by {}", over.replace('_', " "));
        table(
            out,
            &head.iter().map(String::as_str).collect::<Vec<_>>(),
            rows.into_iter(),
        );
    }
    if !found.left_out.is_empty() {
        let _ = writeln!(out, "\nNot judged: {}.", found.left_out.join("; "));
    }
}

/// A table of Markdown.
fn table(out: &mut String, head: &[&str], rows: impl Iterator<Item = Vec<String>>) {
    let line = |cells: Vec<String>| {
        format!(
            "| {} |\n",
            cells
                .iter()
                .map(|cell| cell.replace('|', "\\|"))
                .collect::<Vec<_>>()
                .join(" | ")
        )
    };
    out.push('\n');
    out.push_str(&line(head.iter().map(|cell| (*cell).to_owned()).collect()));
    out.push_str(&line(vec!["---".to_owned(); head.len()]));
    for row in rows {
        out.push_str(&line(row));
    }
}

/// What the terminal shows: a line for each set, the models over the measured sets, and the sets that wait.
pub fn text(language: &Language, validated: &Validated<'_>) -> String {
    let judged = validated.sets.iter().flat_map(|(set, results)| {
        let closest = results
            .iter()
            .filter_map(|judgement| Some((judgement.counts(), judgement.closest()?)));
        closest.map(move |(counts, closest)| (set, counts, closest))
    });
    let sets = TextTable::of(judged)
        .column("set", |(set, ..)| &set.name)
        .column("kind", |(set, ..)| set.source.kind.words())
        .column("points", |(_, [points, _], _)| points.to_string())
        .column("models", |(_, [_, models], _)| models.to_string())
        .column("closest", |(.., (name, _))| *name)
        .column("ratio", |(.., (_, all))| ratio_text(all.ratio))
        .column("least", |(.., (_, all))| ratio_text(all.least))
        .column("greatest", |(.., (_, all))| ratio_text(all.greatest))
        .finish();
    let ratio = |set: Option<&(String, f64)>| set.map_or_else(String::new, |(_, ratio)| ratio_text(*ratio));
    let over_sets = over_sets(&validated.cells(language));
    let models = TextTable::of(&over_sets)
        .column("mechanism", |model| &model.mechanism)
        .column("model", |model| &model.model)
        .column("measured sets", |model| model.sets.len().to_string())
        .column("ratio from", |model| ratio(model.sets.first()))
        .column("to", |model| ratio(model.sets.last()))
        .finish();
    let waiting = validated
        .sets
        .iter()
        .filter_map(|(set, _)| Some((set, set.source.needs.as_ref()?)));
    let waiting: Vec<String> = waiting
        .map(|(set, needs)| {
            format!(
                "{} ({}) judges nothing yet, needs: {needs}\n",
                set.name,
                set.source.kind.words()
            )
        })
        .collect();
    format!("{}\n{}\n{}", sets.render(), models.render(), waiting.concat())
}

/// The page with the pictures of every set, and its head.
pub fn page(language: &Language, validated: &Validated<'_>, version: &str) -> (Report, Frame) {
    let mut report = Report::default();
    for (set, results) in &validated.sets {
        for outcome in results.iter().map(Judgement::outcome) {
            let mut section = Section {
                name: format!("{}-{}", set.name, outcome.head().analysis),
                title: set.source.title.clone(),
                about: note_of(set),
                note: (set.source.kind != Basis::Measured).then(|| "This set is no measurement.".to_owned()),
                ..Section::default()
            };
            section.add(Page::from_outcome(outcome));
            section.headline = section.headline.map(|headline| format!("{}: {headline}", set.name));
            report.sections.push(section);
        }
    }
    let judging = validated.sets.iter().filter(|(_, results)| !results.is_empty());
    let frame = Frame {
        title: "Models against measured sets".to_owned(),
        question: "Which model is right, by how much, on whose data?".to_owned(),
        measurements: judging
            .map(|(set, _)| format!("{}: {}", set.name, note_of(set)))
            .collect(),
        conditions: "Each set has the conditions of its study; no model is tuned.".to_owned(),
        version: version.to_owned(),
        inputs: String::new(),
        packages: language.registry().packages().iter().map(ToString::to_string).collect(),
        study: String::new(),
    };
    (report, frame)
}
