//! Analyses: their entries in a study, computation and outcomes. Each file or folder is one analysis; `common/` has what they share, and
//! [`engine`](crate::engine) computes what they plan.
//!
//! Like a model, an analysis registers itself with [`register_analysis!`](crate::register_analysis), so that the schema, `run`, the
//! reference and the report find it.

pub mod axle_split;
pub mod balance;
pub mod breakdown;
pub mod common;
pub mod compare;
pub mod component_compare;
pub mod contact_path;
pub mod cycle;
pub mod fluid_sweep;
pub mod identify;
pub mod map;
pub mod oil_property;
pub mod operating_points;
pub mod optimise;
pub mod rms_surface;
pub mod sensitivity;
pub mod spin_loss;
pub mod sweep;
pub mod temperature_sweep;
pub mod thermal_limit;
pub mod tournament;
pub mod uncertainty;
pub mod validation;

use std::any::Any;
use std::fmt;
use std::io;
use std::sync::Arc;

use gearloss_framework::document::did_you_mean;
use gearloss_framework::gearbox::Findings;
use gearloss_framework::registry::{Origin, inventory};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

pub use common::chosen::Chosen;

pub use crate::engine::{Built, BuiltAgain, Engine, Head, Plan, Planner, Run, Runs, Stopped, Work, gear_of};
use crate::points::Note;
use crate::study::{ParameterKey, Then, Uses, Write};
use crate::table::Table;

/// An analysis: its entry in a study and the computation of its outcome. The first paragraph of the doc comment of the entry describes
/// the analysis in schema and report.
///
/// It prints nothing, writes no files and has no state between runs.
pub trait Analysis: DeserializeOwned + JsonSchema + Send + Sync + 'static {
    /// Value of the key `type`.
    const TYPE: &'static str;
    /// The key whose entries may be names of parameters of the study.
    const PARAMETERS: Option<ParameterKey> = None;
    /// Formats that are written unless the entry states others under `write`.
    const FORMATS: &'static [Write] = Write::DATA;
    /// What it computes, with all that was read and built for it.
    type Plan<'a>: Plan;
    /// Outcome.
    type Outcome: Outcome + JsonSchema;

    /// The names that it uses, which are checked before anything is solved.
    fn uses(&self) -> Uses<'_>;

    /// The model set that it provides for later analyses.
    fn then(&self) -> Option<Then<'_>> {
        None
    }

    /// Reads, builds and checks everything that it asks for, without its results: the whole of `check`.
    ///
    /// # Errors
    /// All errors of the input.
    fn plan<'a>(&'a self, cx: &Planner<'a>) -> Result<Self::Plan<'a>, Stopped>;

    /// Computes the outcome of what was planned.
    ///
    /// # Errors
    /// An interruption by the caller; that points have no solution without which there is no outcome.
    fn reduce<'a>(&'a self, plan: Self::Plan<'a>, engine: &Engine<'a>) -> Result<Self::Outcome, Stopped>;
}

/// The outcome of an analysis.
pub trait Outcome: AsJson + Any + fmt::Debug + Send + Sync {
    /// Provenance.
    fn head(&self) -> &Head;

    /// Its numbers as columns; the first table has the name of the analysis.
    fn tables(&self) -> Vec<Table>;

    /// Notes of models: quantities outside their stated ranges, observed quantities.
    fn notes(&self) -> Vec<&Note>;

    /// Quantities outside their stated ranges in samples, without details: path and quantity.
    fn left_at_samples(&self) -> Vec<&(String, String)> {
        Vec::new()
    }

    /// Number of quantities outside their stated ranges that [`Outcome::notes`] does not list; they count for `--deny extrapolation`.
    fn unlisted(&self) -> usize {
        0
    }

    /// Values of the model set for later analyses ([`Analysis::then`]): resolved path to value.
    fn found(&self) -> Vec<(String, Value)> {
        Vec::new()
    }

    /// Why parts of the outcome are missing. The remainder is valid, shown and written, but the analysis has failed.
    fn failures(&self) -> &[Findings] {
        &[]
    }

    /// Further text files, such as values for a study, that are always written.
    fn files(&self) -> Vec<TextFile> {
        Vec::new()
    }
}

/// A file of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextFile {
    /// Name with extension.
    pub name: String,
    /// Content.
    pub text: String,
}

/// What is written as JSON: every type that serialises.
pub trait AsJson {
    /// Writes it as JSON.
    ///
    /// # Errors
    /// Errors of the writer.
    fn write_json(&self, to: &mut dyn io::Write) -> serde_json::Result<()>;
}

impl<T: Serialize> AsJson for T {
    fn write_json(&self, to: &mut dyn io::Write) -> serde_json::Result<()> {
        serde_json::to_writer_pretty(to, self)
    }
}

impl dyn Outcome {
    /// The outcome as its type; absent where it is that of another analysis.
    pub fn get<O: Outcome>(&self) -> Option<&O> {
        let any: &dyn Any = self;
        any.downcast_ref()
    }

    /// A table by its name; the first one has the name of the analysis.
    pub fn table(&self, name: &str) -> Option<Table> {
        self.tables().into_iter().find(|table| table.name == name)
    }
}

/// An entry of any analysis.
type Written = dyn Any + Send + Sync;

/// An analysis that is linked into the program.
pub struct AnalysisKind {
    /// Value of the key `type`.
    pub name: &'static str,
    /// The key whose entries may be names of parameters of the study.
    pub parameters: Option<ParameterKey>,
    /// Formats that are written unless an entry states others.
    pub formats: &'static [Write],
    /// Where it is registered.
    pub origin: Origin,
    schema: fn(&mut SchemaGenerator) -> Schema,
    own_schema: fn(&mut SchemaGenerator) -> Schema,
    read: fn(Value) -> Result<Arc<Written>, serde_json::Error>,
    uses: fn(&Written) -> Uses<'_>,
    then: fn(&Written) -> Option<Then<'_>>,
    plan: fn(&Written, &Planner<'_>) -> Result<Vec<Work>, Stopped>,
    samples: fn(&Written, &Planner<'_>) -> Result<Vec<BuiltAgain>, Stopped>,
    run: fn(&Written, &Engine<'_>) -> Result<Box<dyn Outcome>, Stopped>,
    outcome: fn(&mut SchemaGenerator) -> Schema,
}

inventory::collect!(AnalysisKind);

impl AnalysisKind {
    /// An analysis; use [`register_analysis!`](crate::register_analysis).
    pub const fn new<A: Analysis>(origin: Origin) -> Self {
        Self {
            name: A::TYPE,
            parameters: A::PARAMETERS,
            formats: A::FORMATS,
            origin,
            schema: SchemaGenerator::subschema_for::<A>,
            own_schema: A::json_schema,
            read: |value| Ok(Arc::new(serde_json::from_value::<A>(value)?)),
            uses: |entry| typed::<A>(entry).uses(),
            then: |entry| typed::<A>(entry).then(),
            plan: |entry, cx| {
                let plan = typed::<A>(entry).plan(cx)?;
                let work = plan.work();
                let failures = plan.into_failures();
                if failures.is_empty() {
                    Ok(work)
                } else {
                    Err(Stopped::Several(failures))
                }
            },
            samples: |entry, cx| Ok(typed::<A>(entry).plan(cx)?.samples(cx)),
            run: |entry, engine| {
                let entry = typed::<A>(entry);
                let plan = entry.plan(engine.planner())?;
                Ok(Box::new(entry.reduce(plan, engine)?))
            },
            outcome: SchemaGenerator::subschema_for::<A::Outcome>,
        }
    }

    /// Description as a sentence: the first paragraph of the doc comment of the entry.
    pub fn meaning(&self) -> String {
        let schema = (self.own_schema)(&mut SchemaGenerator::default());
        let description = schema.get("description").and_then(Value::as_str).unwrap_or_default();
        let paragraph = description.split("\n\n").next().unwrap_or_default();
        paragraph.replace('\n', " ")
    }

    /// Value of the key `type`.
    pub fn type_name(&self) -> &'static str {
        self.name
    }

    /// The schema of its outcome.
    pub fn outcome_schema(&self, generator: &mut SchemaGenerator) -> Schema {
        (self.outcome)(generator)
    }

    /// All that are linked, in the order of their names.
    ///
    /// # Panics
    /// If two have the same name: a bug of the program, found when it first reads a study.
    pub fn linked() -> Vec<&'static Self> {
        let mut all: Vec<&'static Self> = inventory::iter::<Self>.into_iter().collect();
        all.sort_by_key(|kind| kind.name);
        for pair in all.windows(2) {
            assert!(
                pair[0].name != pair[1].name,
                "two analyses have the name `{}`: {} and {}",
                pair[0].name,
                pair[0].origin,
                pair[1].origin
            );
        }
        all
    }

    /// The key under which analyses of a type list their parameters.
    pub(crate) fn parameters_of(analysis_type: &str) -> Option<ParameterKey> {
        let mut kinds = inventory::iter::<Self>.into_iter();
        kinds.find(|kind| kind.name == analysis_type)?.parameters
    }
}

/// The entry of this kind.
fn typed<A: Analysis>(entry: &Written) -> &A {
    entry.downcast_ref().expect("a kind runs the entries that it has read")
}

// Unit tests register nothing, so that they compile only what they use.
#[cfg(test)]
pub(crate) use gearloss_framework::unregistered as submit;
#[cfg(not(test))]
#[doc(hidden)]
pub use inventory::submit;

/// Registers an analysis: `register_analysis!(BalanceEntry);`.
#[macro_export]
macro_rules! register_analysis {
    ($A:ty) => {
        $crate::analyses::submit! {
            $crate::analyses::AnalysisKind::new::<$A>(gearloss_framework::origin!())
        }
    };
}

/// An analysis as an entry of a study.
#[derive(Clone)]
pub struct AnalysisEntry {
    /// Title in the report; absent: the name of the analysis.
    pub title: Option<String>,
    /// Note in the report.
    pub note: Option<String>,
    /// Requested files.
    pub write: Vec<Write>,
    kind: &'static AnalysisKind,
    written: Arc<Written>,
}

impl fmt::Debug for AnalysisEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.name)
    }
}

impl AnalysisEntry {
    /// The kind of analysis.
    pub fn kind(&self) -> &'static AnalysisKind {
        self.kind
    }

    /// The entry if it has this type.
    pub fn entry<A: Analysis>(&self) -> Option<&A> {
        self.written.downcast_ref()
    }

    /// What it computes.
    ///
    /// # Errors
    /// As [`Analysis::plan`].
    pub fn plan(&self, cx: &Planner<'_>) -> Result<Vec<Work>, Stopped> {
        (self.kind.plan)(self.written.as_ref(), cx)
    }

    /// How other values of its varied quantities get into the gearbox of a sample.
    ///
    /// # Errors
    /// As [`Analysis::plan`].
    pub fn samples(&self, cx: &Planner<'_>) -> Result<Vec<BuiltAgain>, Stopped> {
        (self.kind.samples)(self.written.as_ref(), cx)
    }

    /// Plans, and computes the outcome.
    ///
    /// # Errors
    /// As [`Analysis::plan`] and [`Analysis::reduce`].
    pub fn run(&self, engine: &Engine<'_>) -> Result<Box<dyn Outcome>, Stopped> {
        (self.kind.run)(self.written.as_ref(), engine)
    }

    /// The names that it uses.
    pub fn uses(&self) -> Uses<'_> {
        (self.kind.uses)(self.written.as_ref())
    }

    /// The model set that it provides for later analyses.
    pub fn then(&self) -> Option<Then<'_>> {
        (self.kind.then)(self.written.as_ref())
    }
}

impl<'de> Deserialize<'de> for AnalysisEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut value = Value::deserialize(deserializer)?;
        let mut take = |key: &str| value.as_object_mut().and_then(|record| record.shift_remove(key));
        let write = take("write");
        let mut text = |key: &str| match take(key) {
            Some(Value::String(text)) => Some(text),
            _ => None,
        };
        let [name, title, note] = ["type", "title", "note"].map(&mut text);
        let name = name.unwrap_or_default();
        let name = name.as_str();
        let kinds = AnalysisKind::linked();
        let Some(kind) = kinds.iter().copied().find(|kind| kind.name == name) else {
            let close = did_you_mean(name, kinds.iter().map(|kind| kind.name));
            let help = close.map_or_else(String::new, |close| format!(", did you mean `{close}`?"));
            return Err(D::Error::custom(format!("there is no analysis `{name}`{help}")));
        };
        let write = write
            .map(serde_json::from_value)
            .transpose()
            .map_err(D::Error::custom)?;
        let written = (kind.read)(value).map_err(D::Error::custom)?;
        Ok(Self {
            title,
            note,
            write: write.unwrap_or_else(|| kind.formats.to_vec()),
            kind,
            written,
        })
    }
}

impl JsonSchema for AnalysisEntry {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Analysis".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let variants = AnalysisKind::linked().into_iter().map(|kind| {
            let mut variant = (kind.schema)(generator);
            let mut write = Vec::<Write>::json_schema(generator);
            let names: Vec<String> = kind.formats.iter().map(|format| format!("{format:?}").to_uppercase()).collect();
            let default = match &names[..] {
                [] => "none".to_owned(),
                [one] => one.clone(),
                [first @ .., last] => format!("{} and {last}", first.join(", ")),
            };
            write.insert("description".to_owned(), format!("Formats to write; default: {default}.").into());
            write.insert("default".to_owned(), serde_json::json!(kind.formats));
            variant.insert("description".to_owned(), kind.meaning().into());
            variant.insert("type".to_owned(), "object".into());
            variant.insert(
                "properties".to_owned(),
                serde_json::json!({
                    "type": { "type": "string", "const": kind.name },
                    "title": { "type": "string", "description": "Title in the report, also before the result where the study has several analyses of this type; default: the name of the analysis." },
                    "note": { "type": "string", "description": "Note in the report." },
                    "write": write,
                }),
            );
            variant.insert("required".to_owned(), serde_json::json!(["type"]));
            variant.to_value()
        });
        let variants: Vec<Value> = variants.collect();
        json_schema!({ "description": "An analysis.", "oneOf": variants })
    }
}
