//! Analyses: what a study writes of each, how it is computed, and what comes out.
//!
//! An analysis registers itself with [`register_analysis!`](crate::register_analysis), as a model does, so that the schema, `run`, the
//! reference and the report find it.

mod entries;

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use gearloss_framework::document::did_you_mean;
use gearloss_framework::registry::{Origin, inventory};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use crate::study::{Then, Uses};

/// What a study writes of an analysis.
pub trait Entry: DeserializeOwned + JsonSchema + fmt::Debug + Send + Sync + 'static {
    /// Value of the key `type`.
    const TYPE: &'static str;
    /// What the analysis is, as a sentence.
    const MEANING: &'static str;

    /// The names that it uses, to be looked up before anything is solved.
    fn uses(&self) -> Uses<'_>;

    /// The model set that it leaves for later analyses.
    fn then(&self) -> Option<Then<'_>> {
        None
    }
}

/// An [`Entry`] of any type.
trait Written: Any + fmt::Debug + Send + Sync {
    fn uses(&self) -> Uses<'_>;
    fn then(&self) -> Option<Then<'_>>;
}

impl<E: Entry> Written for E {
    fn uses(&self) -> Uses<'_> {
        Entry::uses(self)
    }

    fn then(&self) -> Option<Then<'_>> {
        Entry::then(self)
    }
}

/// An analysis that is linked into the program.
pub struct AnalysisKind {
    /// Value of the key `type`.
    pub name: &'static str,
    /// What it is, as a sentence.
    pub meaning: &'static str,
    /// Where it is registered.
    pub origin: Origin,
    schema: fn(&mut SchemaGenerator) -> Schema,
    read: fn(Value) -> Result<Arc<dyn Written>, serde_json::Error>,
}

inventory::collect!(AnalysisKind);

impl AnalysisKind {
    /// An entry whose computation is elsewhere.
    pub const fn of_entry<E: Entry>(origin: Origin) -> Self {
        Self {
            name: E::TYPE,
            meaning: E::MEANING,
            origin,
            schema: SchemaGenerator::subschema_for::<E>,
            read: |value| Ok(Arc::new(serde_json::from_value::<E>(value)?)),
        }
    }

    /// All that are linked, in the order of their names.
    ///
    /// # Panics
    /// If two have one name: a fault of the program, found when it first reads a study.
    pub fn linked() -> Vec<&'static Self> {
        let mut all: Vec<&'static Self> = inventory::iter::<Self>.into_iter().collect();
        all.sort_by_key(|kind| kind.name);
        for pair in all.windows(2) {
            assert!(
                pair[0].name != pair[1].name,
                "two analyses are called `{}`: {} and {}",
                pair[0].name,
                pair[0].origin,
                pair[1].origin
            );
        }
        all
    }
}

/// Registers the entry of an analysis.
#[macro_export]
macro_rules! register_entry {
    ($E:ty) => {
        gearloss_framework::registry::inventory::submit! {
            $crate::analyses::AnalysisKind::of_entry::<$E>(gearloss_framework::origin!())
        }
    };
}

/// An analysis as a study writes it.
#[derive(Debug, Clone)]
pub struct AnalysisEntry {
    kind: &'static AnalysisKind,
    written: Arc<dyn Written>,
}

impl fmt::Debug for AnalysisKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl AnalysisEntry {
    /// Which analysis it is.
    pub fn kind(&self) -> &'static AnalysisKind {
        self.kind
    }

    /// The entry, where it is of the type.
    pub fn entry<E: Entry>(&self) -> Option<&E> {
        let written: &dyn Any = self.written.as_ref();
        written.downcast_ref()
    }

    /// The names that it uses.
    pub fn uses(&self) -> Uses<'_> {
        self.written.uses()
    }

    /// The model set that it leaves for later analyses.
    pub fn then(&self) -> Option<Then<'_>> {
        self.written.then()
    }
}

impl<'de> Deserialize<'de> for AnalysisEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut value = Value::deserialize(deserializer)?;
        let name = value.as_object_mut().and_then(|record| record.shift_remove("type"));
        let name = name.as_ref().and_then(Value::as_str).unwrap_or_default();
        let kinds = AnalysisKind::linked();
        let Some(kind) = kinds.iter().copied().find(|kind| kind.name == name) else {
            let close = did_you_mean(name, kinds.iter().map(|kind| kind.name));
            let help = close.map_or_else(String::new, |close| format!(", did you mean `{close}`?"));
            return Err(D::Error::custom(format!("no analysis is called `{name}`{help}")));
        };
        let written = (kind.read)(value).map_err(D::Error::custom)?;
        Ok(Self { kind, written })
    }
}

impl JsonSchema for AnalysisEntry {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Analysis".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let variants = AnalysisKind::linked().into_iter().map(|kind| {
            let mut variant = (kind.schema)(generator);
            variant.insert("description".to_owned(), kind.meaning.into());
            variant.insert("type".to_owned(), "object".into());
            variant.insert(
                "properties".to_owned(),
                serde_json::json!({ "type": { "type": "string", "const": kind.name } }),
            );
            variant.insert("required".to_owned(), serde_json::json!(["type"]));
            variant.to_value()
        });
        let variants: Vec<Value> = variants.collect();
        json_schema!({ "description": "An analysis.", "oneOf": variants })
    }
}
