//! The reference of the models in `docs/models` is that of the program: text from the heads of the model files, tables from
//! their registrations, answers from running them.

use crate::common;
use std::fmt::Write as _;

use gearloss_framework::coefficients::COEFFICIENTS;
use gearloss_framework::document::records_by_type;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::loss::Limit;
use gearloss_framework::registry::{ComparedSet, Entry, Files, MechanismEntry, RatingPlugin};
use gearloss_framework::resolve::RATINGS;
use serde_json::{Map, Value};

/// Models of the field that are not here.
const OMITTED: &str = "\
## Omitted models and reasons
- Terekhov and Lauster-Boos (churning): with the constants quoted from memory the torque is 12 to 60 times and 2 to 7 times smaller than
  with any other law for automotive gears, so a factor is wrong; the originals were not available. The model `dimensional` accepts the constants.
- Boness 1989 (churning): jumps of 8 and 25 % between its branches and 32 N m for an automotive gear near Re = 1e5; the original was not available.
- Swell of a gear pair, housing distances according to Changenet and Velex 2008, bevel gears according to Laruelle: formulas not public.
  `swell` is user-defined.
- Root filling and pocketing according to Seetharaman and Kahraman: not public in full; the two known terms are a model marked as incomplete.
- Mauz with his functions of wall distance and oil volume, Walter, Butsch (FVA): not public.
- Carrier losses according to Kettler, no-load losses of planetary sets according to Höhn: not public.
- Talboom's tooth loss factor, Doleschel's constants of standard oils: not public.
- Drag of bearings above n d_m = 0.5e6 mm/min according to Morales-Espejel and Wemekamp: not public. `beyond: hold` is a convention.
- Raceway torques of tapered roller bearings according to Matsuyama, Houpert: one secondary source each. `contact` has those of Zhou and Hoeprich and of Aihara.
- Dawson's update of 1988 requires a chart that is not public. SKF diagrams of shaft seals and Engelke's model: no closed form.
- Rocker pins of silent chains, hysteresis of toothed belts, push belts, constant-velocity joints: no open law. `typical` has handbook values of
  chains and belts; `efficiency` and `table` accept those of the maker, also over ratio and angle.
- Torque converters, leakage of hydraulic actuation: outside the scope of the program; `table` accepts a measured map.
";

/// The stated ranges of a model or a rating.
fn ranges(out: &mut String, limits: &[Limit]) {
    for limit in limits {
        writeln!(
            out,
            "- Stated range of the {} {} [{}]: {} to {} ({}).",
            limit.meaning,
            limit.name,
            limit.unit,
            significant(limit.least),
            significant(limit.greatest),
            limit.origin
        )
        .unwrap();
    }
}

fn head_of(entry: &Entry) -> String {
    if entry.origin.package.name != "gearloss-plugins" {
        return String::new();
    }
    let path = common::file(entry.origin.file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let lines: Vec<&str> = text
        .lines()
        .take_while(|l| l.starts_with("//!"))
        .map(|l| l.trim_start_matches("//!").trim())
        .collect();
    // The first line says what the table says already; a sentence that goes on behind it would lose its beginning.
    let rest = lines[1..].join("\n").trim().to_owned();
    assert!(
        lines[0].ends_with('.') && rest.starts_with(|c: char| c.is_uppercase()),
        "{}: the first line is not a complete sentence, so the reference would begin with: {}",
        path.display(),
        rest.lines().next().unwrap_or_default()
    );
    rest
}

fn row(out: &mut String, cells: &[&str]) {
    let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|").replace('\n', " ")).collect();
    writeln!(out, "| {} |", cells.join(" | ")).unwrap();
}

fn header(out: &mut String, cells: &[&str]) {
    row(out, cells);
    row(out, &vec!["---"; cells.len()]);
}

fn significant(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (4 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{x:.digits$}");
    if !(1e-4..1e7).contains(&x.abs()) {
        return format!("{x:.4e}");
    }
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The definition to which a part of a schema refers.
fn referred<'s>(schema: &'s Value, part: &Value) -> Option<&'s Value> {
    let reference = [part, &part["allOf"][0], &part["anyOf"][0], &part["oneOf"][0]]
        .into_iter()
        .find_map(|f| f["$ref"].as_str());
    schema["definitions"].get(reference?.strip_prefix("#/definitions/")?)
}

/// Constants with their meanings, each written after a key.
fn meanings(of: &Value, key: &str) -> Vec<String> {
    let choices = of["oneOf"].as_array().into_iter().flatten();
    choices
        .filter_map(|choice| {
            let value = choice["const"].as_str()?;
            let meaning = choice["description"].as_str().unwrap_or_default();
            Some(format!("`{key}{value}`: {}", meaning.trim_end_matches('.')))
        })
        .collect()
}

/// The values that an enumeration takes, with their meaning; of words beside records, both.
fn choices(schema: &Value, field: &Value) -> String {
    let Some(definition) = referred(schema, field) else {
        return String::new();
    };
    let mut values = meanings(definition, "");
    let alternatives = definition["anyOf"].as_array().into_iter().flatten();
    let alternatives: Vec<&Value> = alternatives.filter_map(|choice| referred(schema, choice)).collect();
    values.extend(alternatives.iter().flat_map(|choice| meanings(choice, "")));
    if values.is_empty() {
        return String::new();
    }
    let records = alternatives.iter().map(|choice| &choice["properties"]["type"]);
    values.extend(records.flat_map(|kind| meanings(kind, "type: ")));
    format!("{}.", values.join("; "))
}

fn parameters(out: &mut String, language: &Language, entry: &Entry) {
    let schema = language.published(Kind::Gearbox);
    let records = records_by_type(&schema["definitions"][format!("{}_model", entry.mechanism)])
        .into_iter()
        .find_map(|(name, record)| (name == entry.name).then_some(record));
    let fields: Vec<(&String, &Value)> = records
        .and_then(|v| v["properties"].as_object())
        .into_iter()
        .flatten()
        .filter(|(name, _)| !["type", COEFFICIENTS].contains(&name.as_str()))
        .collect();
    parameter_table(out, &schema, &fields, entry);
}

/// A row for each parameter of a model or rating.
fn parameter_table(out: &mut String, schema: &Value, fields: &[(&String, &Value)], entry: &Entry) {
    if fields.is_empty() {
        out.push_str("No parameters.\n\n");
        return;
    }
    header(
        out,
        &[
            "parameter",
            "default",
            "range",
            "description",
            "evidence of the default",
        ],
    );
    for &(name, field) in fields {
        let range = match (field["minimum"].as_f64(), field["maximum"].as_f64()) {
            (Some(least), Some(greatest)) => format!("{} to {}", significant(least), significant(greatest)),
            (Some(least), None) => format!("from {}", significant(least)),
            (None, Some(greatest)) => format!("to {}", significant(greatest)),
            (None, None) => String::new(),
        };
        let default = match &field["default"] {
            Value::Null => "-".to_owned(),
            Value::Number(n) => n.as_f64().map_or_else(|| n.to_string(), significant),
            value => value.to_string(),
        };
        let graded = entry.evidence.iter().find(|g| g.key == name.as_str());
        let evidence = graded.map_or_else(String::new, |g| format!("{}: {}", g.grade.name(), g.because));
        let doc = field["description"].as_str().unwrap_or_default();
        let choices = choices(schema, field);
        let doc = if choices.is_empty() {
            doc.to_owned()
        } else {
            format!("{doc} {choices}")
        };
        row(out, &[&format!("`{name}`"), &default, &range, &doc, &evidence]);
    }
    out.push('\n');
}

/// Constants of the formula that a document may change.
fn coefficients(out: &mut String, entry: &Entry) {
    let list = entry.coefficients();
    if list.is_empty() {
        return;
    }
    writeln!(out, "Coefficients of the formula, published by {}:\n", entry.source).unwrap();
    header(out, &["`coefficients`", "published", "unit", "range", "description"]);
    for coefficient in list {
        let range = format!(
            "{} to {}",
            significant(coefficient.least),
            significant(coefficient.greatest)
        );
        let published = coefficient.published.to_string();
        row(
            out,
            &[
                &format!("`{}`", coefficient.name),
                &published,
                coefficient.unit,
                &range,
                &coefficient.meaning,
            ],
        );
    }
    out.push('\n');
}

fn model(out: &mut String, language: &Language, mechanism: &MechanismEntry, entry: &Entry) {
    writeln!(out, "## {}\n\n{}\n", entry.name, entry.meaning()).unwrap();
    let head = head_of(entry);
    if !head.is_empty() {
        writeln!(out, "{head}\n").unwrap();
    }
    parameters(out, language, entry);
    coefficients(out, entry);
    for graded in entry.evidence.iter().filter(|g| g.key.is_empty()) {
        writeln!(out, "Evidence: {} ({}).", graded.grade.name(), graded.because).unwrap();
    }
    writeln!(out, "Source: {}.\n", entry.source).unwrap();
    measurements(out, entry);
    ranges(out, entry.limits);
    for term in entry.terms {
        let kind = if term.load_dependent {
            "load-dependent"
        } else {
            "load-independent"
        };
        writeln!(out, "- Term `{}`, {kind}.", term.name).unwrap();
    }
    for observed in entry.observed {
        writeln!(
            out,
            "- Observed {} [{}]: {}.",
            observed.name, observed.unit, observed.meaning
        )
        .unwrap();
    }
    if entry.name == "table" {
        writeln!(out, "\n```yaml\nmodel: {}\n```\n", entry.example).unwrap();
        return;
    }
    let (value, part) = language.example_of(entry).unwrap();
    let files = Files::default();
    let answer = (mechanism.eval)(language.registry(), &files, &value, &part, &Map::new()).unwrap();
    writeln!(
        out,
        "\n```yaml\nmodel: {}\n```\n`gearloss eval {}/{}` returns {} at the usual point.\n",
        entry.example,
        mechanism.key,
        entry.name,
        match answer.moment {
            Some(moment) => format!("{} W, {} N m", significant(answer.total), significant(moment)),
            None => significant(answer.total),
        }
    )
    .unwrap();
    checks(out, entry);
}

/// What the measured sets of the corpus say about a model.
fn measurements(out: &mut String, entry: &Entry) {
    let compared = entry.compared();
    // Most models have no set: the page of the corpus says what is missing.
    let Some(words) = compared.words() else { return };
    let set = |set: &ComparedSet| {
        let [least, greatest] = set.ratio.map(significant);
        let ratio = if least == greatest {
            least
        } else {
            format!("{least} to {greatest}")
        };
        format!("{} {ratio}", set.set)
    };
    let sets: Vec<String> = compared.sets.iter().map(set).collect();
    writeln!(
        out,
        "Measurements: {words} ([validation](../validation.md)): {}.\n",
        sets.join(", ")
    )
    .unwrap();
}

/// The check values of a model or a rating; `gearloss models --checks` prints them with the computed ones.
fn checks(out: &mut String, entry: &Entry) {
    if entry.checks.is_empty() {
        return;
    }
    out.push_str("Check values:\n\n");
    header(out, &["input of `eval`", "expected", "within", "source"]);
    for check in entry.checks {
        let values: Vec<String> = check
            .values
            .iter()
            .map(|(name, value)| format!("`{name}` = {value}"))
            .collect();
        let within = format!("{:e}: {}", check.tolerance, check.because);
        row(
            out,
            &[&format!("`{}`", check.input), &values.join(", "), &within, check.source],
        );
    }
    out.push('\n');
}

fn mechanism_page(language: &Language, mechanism: &MechanismEntry) -> String {
    let mut out = format!(
        "# {}\n\n{} Result of a model: {}\n\n",
        mechanism.key, mechanism.meaning, mechanism.answer
    );
    if let Some(section) = &mechanism.section {
        writeln!(out, "Section of its components: `{}`.\n", section.name).unwrap();
    }
    out.push_str("Inputs of a model, which formulas and tables may use:\n\n");
    header(
        &mut out,
        &["quantity", "usual", "minimum", "maximum", "description", "source"],
    );
    for q in (mechanism.quantities)() {
        row(
            &mut out,
            &[
                &format!("`{}`", q.name),
                &significant(q.usual),
                &significant(q.least),
                &significant(q.greatest),
                q.doc.trim(),
                q.from,
            ],
        );
    }
    out.push('\n');
    let laws = (mechanism.laws)();
    if !laws.is_empty() {
        let laws: Vec<String> = laws.iter().map(|law| format!("`{law}`")).collect();
        writeln!(
            out,
            "Laws between them, with which `eval` computes omitted quantities and rejects contradictions: {}.\n",
            laws.join("; ")
        )
        .unwrap();
    }
    for entry in language.registry().models(mechanism.key) {
        model(&mut out, language, mechanism, entry);
    }
    out.trim_end().to_owned() + "\n"
}

fn rating(out: &mut String, language: &Language, plugin: &RatingPlugin) {
    let entry = &plugin.entry;
    writeln!(out, "## {}\n\n{}\n", entry.name, entry.meaning()).unwrap();
    let head = head_of(entry);
    if !head.is_empty() {
        writeln!(out, "{head}\n").unwrap();
    }
    writeln!(
        out,
        "Rates components of the mechanism [{0}]({0}.md).\n",
        entry.mechanism
    )
    .unwrap();
    let schema = language.published(Kind::Gearbox);
    let choice = &schema["properties"][RATINGS]["properties"][entry.name];
    let records = choice["anyOf"].as_array().into_iter().flatten();
    let fields: Vec<(&String, &Value)> = records
        .filter_map(|record| record["properties"].as_object())
        .flatten()
        .collect();
    parameter_table(out, &schema, &fields, entry);
    for graded in entry.evidence.iter().filter(|g| g.key.is_empty()) {
        writeln!(out, "Evidence: {} ({}).", graded.grade.name(), graded.because).unwrap();
    }
    writeln!(out, "Source: {}.\n", entry.source).unwrap();
    ranges(out, entry.limits);
    for figure in plugin.figures {
        writeln!(
            out,
            "- Quantity {} [{}]: {}.",
            figure.symbol, figure.unit, figure.meaning
        )
        .unwrap();
    }
    let (parameters, part) = language.example_of_rating(plugin).unwrap();
    let files = Files::default();
    let alone = (plugin.eval)(language.registry(), &files, plugin, &parameters, &part, &Map::new()).unwrap();
    let values: Vec<String> = alone
        .rated
        .figures()
        .iter()
        .map(|rated| {
            let unit = if rated.figure.unit == "-" {
                ""
            } else {
                rated.figure.unit
            };
            format!("{} {} {unit}", rated.figure.symbol, significant(rated.value))
                .trim_end()
                .to_owned()
        })
        .collect();
    let values = values.join(", ");
    writeln!(
        out,
        "\n`gearloss eval rating/{}` returns {values} at the usual point.\n",
        entry.name
    )
    .unwrap();
    checks(out, entry);
}

/// The page of all ratings.
fn ratings_page(language: &Language) -> String {
    let mut out = String::from(
        "# Ratings\n\nQuantities of components at solved points, compared with their limits. No loss depends on them. \
         [How to use them, and what is omitted](../ratings.md).\n\n",
    );
    for plugin in language.registry().ratings() {
        rating(&mut out, language, plugin);
    }
    out.trim_end().to_owned() + "\n"
}

fn index(language: &Language) -> String {
    let mut out = String::from(
        "# Models\n\nChoose a model for each mechanism by its source and [evidence grade](../../CONTRIBUTING.md#evidence). The page of the mechanism has \
         formulas, parameters, stated ranges, check values and examples; `gearloss models --needs GEARBOX` lists the inputs that a gearbox lacks, \
         `gearloss models MECHANISM MODEL --checks` evaluates the check values: `part` and quantities that an input omits are those of \
         `gearloss eval` without an input. Generated by `UPDATE=1 cargo test --test all reference::`.\n\n",
    );
    let mut count = 0;
    for mechanism in language.registry().mechanisms() {
        writeln!(out, "## [{0}]({0}.md)\n\n{1}\n", mechanism.key, mechanism.meaning).unwrap();
        header(&mut out, &["model", "description", "evidence", "source"]);
        for entry in language.registry().models(mechanism.key) {
            let grade = entry
                .evidence
                .iter()
                .find(|g| g.key.is_empty())
                .map_or("", |g| g.grade.name());
            let link = format!("[{0}]({1}.md#{0})", entry.name, mechanism.key);
            row(&mut out, &[&link, &entry.meaning(), grade, entry.source]);
            count += 1;
        }
        out.push('\n');
    }
    out.push_str("## [ratings](ratings.md)\n\nRatings of components at solved points.\n\n");
    header(&mut out, &["rating", "mechanism", "description", "evidence", "source"]);
    for plugin in language.registry().ratings() {
        let entry = &plugin.entry;
        let formula = entry.evidence.iter().find(|g| g.key.is_empty());
        let link = format!("[{0}](ratings.md#{0})", entry.name);
        let grade = formula.map_or("", |g| g.grade.name());
        row(
            &mut out,
            &[&link, entry.mechanism, &entry.meaning(), grade, entry.source],
        );
    }
    out.push('\n');
    writeln!(
        out,
        "{count} models, including the four generic ones of each mechanism.\n"
    )
    .unwrap();
    out.push_str(OMITTED);
    out
}

#[test]
fn the_model_shown_to_contributors_is_the_one_that_ships() {
    let text = std::fs::read_to_string(common::file("CONTRIBUTING.md")).unwrap();
    let shown = text.split("```rust\n").nth(1).unwrap().split("\n```").next().unwrap();
    let ships = std::fs::read_to_string(common::file("plugins/src/seal/linke.rs")).unwrap();
    assert!(
        ships.starts_with(shown),
        "CONTRIBUTING.md shows a different seal/linke.rs"
    );
}

#[test]
fn the_reference_is_not_stale() {
    let language = common::language();
    let mut pages = vec![("README".to_owned(), index(&language))];
    for mechanism in language.registry().mechanisms() {
        pages.push((mechanism.key.to_owned(), mechanism_page(&language, mechanism)));
    }
    pages.push(("ratings".to_owned(), ratings_page(&language)));
    for (name, page) in &pages {
        let path = common::file(&format!("docs/models/{name}.md"));
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&path, page).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            committed == *page,
            "docs/models/{name}.md is stale: run `UPDATE=1 cargo test --test all reference::`"
        );
    }
    let mut committed: Vec<String> = std::fs::read_dir(common::file("docs/models"))
        .unwrap()
        .map(|e| e.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    committed.sort();
    let mut names: Vec<String> = pages.into_iter().map(|p| p.0).collect();
    names.sort();
    assert_eq!(committed, names, "a page belongs to no mechanism");
}
