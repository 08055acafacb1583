//! The slot of a model in a document, and the built model.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::Deref;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::description::Ordered;
use crate::loss::NoteBase;
use crate::mechanism::Mechanism;

/// The choice of a model, as data: `{ type: ..., ... }` or `none`. Its schema is a reference; the registry in use writes the
/// definition, so that any registry has a schema and slots may nest.
pub struct ModelRef<M> {
    /// The resolved choice.
    pub value: Value,
    mechanism: PhantomData<fn() -> M>,
}

impl<M> ModelRef<M> {
    /// The choice as a value.
    pub fn new(value: Value) -> Self {
        Self {
            value,
            mechanism: PhantomData,
        }
    }
}

impl<M> std::fmt::Debug for ModelRef<M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.value)
    }
}

impl<M> Clone for ModelRef<M> {
    fn clone(&self) -> Self {
        Self::new(self.value.clone())
    }
}

impl<M> Serialize for ModelRef<M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.value.serialize(serializer)
    }
}

impl<'de, M> Deserialize<'de> for ModelRef<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Value::deserialize(deserializer).map(Self::new)
    }
}

impl<M: Mechanism> JsonSchema for ModelRef<M> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{}_model", M::KEY).into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        Schema::new_ref(format!("#/definitions/{}_model", M::KEY))
    }
}

/// Several models by name, such as `churning` and `windage`.
pub struct NamedSlots<M>(pub Ordered<ModelRef<M>>);

impl<M> std::fmt::Debug for NamedSlots<M> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<M> Clone for NamedSlots<M> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<M> Serialize for NamedSlots<M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, M> Deserialize<'de> for NamedSlots<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ordered::deserialize(deserializer).map(Self)
    }
}

impl<M: Mechanism> JsonSchema for NamedSlots<M> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{}_slots", M::KEY).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let model = ModelRef::<M>::json_schema(generator);
        json_schema!({ "type": "object", "additionalProperties": model })
    }
}

/// A built model. Dereferences to the mechanism's trait.
pub struct Slot<M: Mechanism> {
    model: Arc<M::Model>,
    /// Position of the model's notes.
    pub notes: NoteBase,
    /// True for `none`, which need not be evaluated.
    pub off: bool,
    /// Path of the element of the oil network that the model, or one nested in it, names.
    pub(crate) supply: Option<Arc<str>>,
}

impl<M: Mechanism> Slot<M> {
    pub(crate) fn new(model: Arc<M::Model>, notes: NoteBase, off: bool) -> Self {
        Self {
            model,
            notes,
            off,
            supply: None,
        }
    }
}

impl<M: Mechanism> Clone for Slot<M> {
    fn clone(&self) -> Self {
        Self {
            model: Arc::clone(&self.model),
            notes: self.notes,
            off: self.off,
            supply: self.supply.clone(),
        }
    }
}

impl<M: Mechanism> Deref for Slot<M> {
    type Target = M::Model;
    fn deref(&self) -> &M::Model {
        &self.model
    }
}
