//! `models --format json`: all data of mechanisms and models, for programs.

use gearloss_framework::coefficients::Coefficient;
use gearloss_framework::document::Unit;
use gearloss_framework::language::{Kind, Language};
use gearloss_framework::loss::{Limit, Observed, Term};
use gearloss_framework::mechanism::QuantityDoc;
use gearloss_framework::rating::Figure;
use gearloss_framework::registry::{
    Check, ComparedSet, Entry, Evidence, Graded, MechanismEntry, Package, RatingPlugin,
};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::{evaluation, parameters, ratings};

const FORMAT: &str = "gearloss-models/1";

/// Output of `gearloss models --format json`.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(title = FORMAT)]
pub struct ModelsRecord {
    /// Kind and version of the format.
    #[schemars(extend("const" = FORMAT))]
    format: &'static str,
    /// Version of the program.
    gearloss: &'static str,
    /// Crates whose mechanisms and models are linked into the program.
    packages: Vec<Package>,
    /// The requested mechanisms.
    mechanisms: Vec<MechanismRecord>,
    /// Model sets that crates provide.
    sets: Vec<SetRecord>,
    /// Ratings, which no loss depends on.
    ratings: Vec<RatingRecord>,
}

/// A mechanism.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Mechanism")]
struct MechanismRecord {
    /// Name in documents.
    mechanism: &'static str,
    /// Meaning.
    meaning: &'static str,
    /// Result of its models.
    answer: &'static str,
    /// Section of its components in a gearbox, if it has its own.
    section: Option<&'static str>,
    /// Crate that registers it.
    package: &'static str,
    /// Input quantities of its models.
    quantities: Vec<QuantityRecord>,
    /// Laws that relate the quantities; `eval` applies them.
    laws: Vec<&'static str>,
    /// Its models.
    models: Vec<ModelRecord>,
}

/// A set.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Set")]
struct SetRecord {
    /// Name in `--models`.
    name: &'static str,
    /// Meaning.
    meaning: &'static str,
    /// Crate that ships it.
    package: &'static str,
}

/// An input quantity of models.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Quantity")]
struct QuantityRecord {
    /// Name in formulas, tables and `eval`.
    name: &'static str,
    /// Meaning.
    meaning: String,
    /// Unit of the numbers.
    unit: &'static str,
    /// Usual value.
    usual: f64,
    /// Minimum value at which models are tested.
    least: f64,
    /// Maximum value at which models are tested.
    greatest: f64,
    /// Origin of its value in a gearbox.
    from: &'static str,
}

/// A model.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Model")]
struct ModelRecord {
    /// Name in documents.
    model: &'static str,
    /// Meaning.
    meaning: String,
    /// Primary source.
    source: &'static str,
    /// Crate that registers it.
    package: &'static str,
    /// A record in YAML.
    example: &'static str,
    /// Generic: evaluated at several points at once, with exact derivatives; plain: with derivatives by differences.
    #[schemars(extend("enum" = ["generic", "plain"]))]
    evaluation: &'static str,
    /// Keys of its record.
    parameters: Vec<ParameterRecord>,
    /// Constants and exponents of its formula that a document may change.
    coefficients: Vec<Coefficient>,
    /// Named shares of the answer.
    terms: &'static [Term],
    /// Quantities that it shows.
    observed: &'static [Observed],
    /// Validity ranges stated by the source.
    limits: &'static [Limit],
    /// Evidence grades of the formula and the defaults.
    evidence: Vec<GradeRecord>,
    /// Measured sets of the corpus that judge it, alone or nested in another model.
    measured_sets: Vec<MeasuredSetRecord>,
    /// Cases with known results.
    checks: Vec<CheckValuesRecord>,
}

/// A model at one measured set.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "MeasuredSet")]
struct MeasuredSetRecord {
    /// Name of the set.
    set: &'static str,
    /// Kinds of the judged components, joined by `+`; empty for components without kinds.
    part: &'static str,
    /// Whether constants of the model were derived from the set.
    seen: bool,
    /// Calculated over measured loss, geometric mean over the points; the least over nested models. [-]
    ratio_least: f64,
    /// The greatest over nested models. [-]
    ratio_greatest: f64,
    /// Whether some of its points are inside the ranges that the sources of the models state.
    in_range: bool,
}

/// A rating.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Rating")]
struct RatingRecord {
    /// Name in documents, under `ratings`.
    rating: &'static str,
    /// Key of the mechanism whose components it rates.
    mechanism: &'static str,
    /// Meaning.
    meaning: String,
    /// Primary source.
    source: &'static str,
    /// Crate that registers it.
    package: &'static str,
    /// Keys of its record.
    parameters: Vec<ParameterRecord>,
    /// Quantities that it may return.
    quantities: &'static [Figure],
    /// Validity ranges stated by the source.
    limits: &'static [Limit],
    /// Evidence grades of the formula and the defaults.
    evidence: Vec<GradeRecord>,
    /// Cases with known results.
    checks: Vec<CheckValuesRecord>,
}

/// A parameter.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Parameter")]
struct ParameterRecord {
    /// Key in the record of the model.
    name: String,
    /// Meaning.
    meaning: String,
    /// Unit, for a quantity.
    unit: Option<&'static str>,
    /// Default; null if there is none.
    default: Value,
    /// Minimum value.
    #[schemars(with = "Option<f64>")]
    least: Value,
    /// Maximum value.
    #[schemars(with = "Option<f64>")]
    greatest: Value,
}

/// A grade.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Grade")]
struct GradeRecord {
    /// Parameter whose default is graded; null for the formula.
    default_of: Option<&'static str>,
    /// Grade.
    grade: Evidence,
    /// Reason or source of the grade.
    because: &'static str,
}

/// A case with known results, which the model must reproduce.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Check")]
struct CheckValuesRecord {
    /// Input as for `gearloss eval --input`, in YAML.
    input: &'static str,
    /// Expected values.
    values: Vec<ExpectedValueRecord>,
    /// Greatest deviation, relative to the expected value.
    tolerance: f64,
    /// Reason for this tolerance.
    because: &'static str,
    /// Where the values are from.
    source: &'static str,
}

/// A quantity and its expected value.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Expected")]
struct ExpectedValueRecord {
    /// Result, term, step or observed quantity, as `gearloss eval` names it.
    quantity: &'static str,
    /// Expected value with unit.
    value: &'static str,
}

impl ModelsRecord {
    /// All mechanisms with their models, and the ratings, or the selected ones.
    pub fn new(language: &Language, mechanism: Option<&MechanismEntry>, model: Option<&Entry>) -> Self {
        let schema = language.published(Kind::Gearbox);
        let registry = language.registry();
        let of_mechanism = |mechanism: &MechanismEntry| {
            let models = registry.models(mechanism.key);
            let models = models.filter(|entry| model.is_none_or(|only| only.name == entry.name));
            MechanismRecord {
                mechanism: mechanism.key,
                meaning: mechanism.meaning,
                answer: mechanism.answer,
                section: mechanism.section.as_ref().map(|section| section.name),
                package: mechanism.origin.package.name,
                quantities: (mechanism.quantities)().iter().map(QuantityRecord::new).collect(),
                laws: (mechanism.laws)(),
                models: models.map(|entry| ModelRecord::new(language, entry, &schema)).collect(),
            }
        };
        let fits = |key: &str| mechanism.is_none_or(|only| only.key == key);
        let mechanisms = registry.mechanisms().iter().filter(|mechanism| fits(mechanism.key));
        let sets = registry.shipped_sets().iter().map(|set| SetRecord {
            name: set.name,
            meaning: set.meaning,
            package: set.origin.package.name,
        });
        let ratings = registry.ratings().iter();
        let ratings = ratings.filter(|rating| fits(rating.entry.mechanism) && model.is_none());
        Self {
            format: FORMAT,
            gearloss: env!("CARGO_PKG_VERSION"),
            packages: registry.packages(),
            mechanisms: mechanisms.map(of_mechanism).collect(),
            sets: sets.collect(),
            ratings: ratings.map(|rating| RatingRecord::new(rating, &schema)).collect(),
        }
    }
}

/// A doc comment without its unit at the end.
fn meaning(doc: &str) -> String {
    let doc = doc.trim();
    let meaning = doc
        .rfind(" [")
        .filter(|_| doc.ends_with(']'))
        .map_or(doc, |at| &doc[..at]);
    meaning.replace('\n', " ")
}

impl QuantityRecord {
    fn new(quantity: &QuantityDoc) -> Self {
        Self {
            name: quantity.name,
            meaning: meaning(quantity.doc),
            unit: quantity.unit.symbol,
            usual: quantity.usual,
            least: quantity.least,
            greatest: quantity.greatest,
            from: quantity.from,
        }
    }
}

impl ModelRecord {
    fn new(language: &Language, entry: &Entry, schema: &Value) -> Self {
        Self {
            model: entry.name,
            meaning: entry.meaning(),
            source: entry.source,
            package: entry.origin.package.name,
            example: entry.example,
            evaluation: evaluation(language, entry),
            parameters: parameters(entry, schema)
                .into_iter()
                .map(ParameterRecord::from)
                .collect(),
            coefficients: entry.coefficients(),
            terms: entry.terms,
            observed: entry.observed,
            limits: entry.limits,
            evidence: entry.evidence.iter().map(GradeRecord::new).collect(),
            measured_sets: entry.compared().sets.into_iter().map(MeasuredSetRecord::from).collect(),
            checks: entry.checks.iter().map(CheckValuesRecord::new).collect(),
        }
    }
}

impl From<ComparedSet> for MeasuredSetRecord {
    fn from(of: ComparedSet) -> Self {
        let ComparedSet {
            set,
            part,
            seen,
            ratio: [ratio_least, ratio_greatest],
            in_range,
        } = of;
        Self {
            set,
            part,
            seen,
            ratio_least,
            ratio_greatest,
            in_range,
        }
    }
}

impl RatingRecord {
    fn new(rating: &RatingPlugin, schema: &Value) -> Self {
        let entry = &rating.entry;
        let parameters = ratings::parameters(rating, schema).into_iter();
        Self {
            rating: entry.name,
            mechanism: entry.mechanism,
            meaning: entry.meaning(),
            source: entry.source,
            package: entry.origin.package.name,
            parameters: parameters.map(ParameterRecord::from).collect(),
            quantities: rating.figures,
            limits: entry.limits,
            evidence: entry.evidence.iter().map(GradeRecord::new).collect(),
            checks: entry.checks.iter().map(CheckValuesRecord::new).collect(),
        }
    }
}

impl From<(String, Value)> for ParameterRecord {
    /// From its key and its schema.
    fn from((name, field): (String, Value)) -> Self {
        let doc = field["description"].as_str().unwrap_or_default();
        Self {
            name,
            meaning: meaning(doc),
            unit: Unit::of_doc(doc).map(|unit| unit.symbol),
            default: field["default"].clone(),
            least: field["minimum"].clone(),
            greatest: field["maximum"].clone(),
        }
    }
}

impl GradeRecord {
    fn new(graded: &Graded) -> Self {
        Self {
            default_of: (!graded.key.is_empty()).then_some(graded.key),
            grade: graded.grade,
            because: graded.because,
        }
    }
}

impl CheckValuesRecord {
    fn new(check: &Check) -> Self {
        let values = check.values.iter();
        Self {
            input: check.input,
            values: values
                .map(|&(quantity, value)| ExpectedValueRecord { quantity, value })
                .collect(),
            tolerance: check.tolerance,
            because: check.because,
            source: check.source,
        }
    }
}
