//! Constants and exponents of published formulas as parameters: `model.coefficients.NAME`, with the published value as default and
//! a range that excludes meaningless values.
//!
//! A model declares them with [`coefficients!`](crate::coefficients!) and holds the struct as `#[serde(default)] coefficients: X`.
//! The schema, the resolved document, `models`, the reference, and the note of every changed value follow from the declaration.

use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, json_schema};
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::ser::SerializeMap as _;
use serde::{Deserializer, Serialize, Serializer};
use serde_json::{Map, Value, json};

use crate::registry::{Entry, Instance};
use crate::resolve::{Resolved, lookup};
use crate::transmission::Transmission;

pub use serde;

/// Key of the record in a model's parameters.
pub const COEFFICIENTS: &str = "coefficients";

/// Rules appended to the description of every record of coefficients.
const RULES: &str = "Values as in the source, in the units of its formula; the default is the published value. A range \
                     is assumed to be plausible unless the text of the coefficient states its source.";

/// One coefficient as its model declares it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Declared {
    /// Key in documents.
    pub name: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Value of the source.
    pub published: f64,
    /// Lower end of the accepted range.
    pub least: f64,
    /// Upper end of the accepted range.
    pub greatest: f64,
}

/// The coefficients of one model; implemented by [`coefficients!`](crate::coefficients!).
pub trait Coefficients: Copy + Default {
    /// Description of the record.
    const ABOUT: &'static str;
    /// All coefficients in the order of their declaration.
    const LIST: &'static [Declared];
    /// Mutable access to a coefficient by name.
    fn field(&mut self, name: &str) -> Option<&mut f64>;
}

/// Writes all coefficients as a map.
///
/// # Errors
/// If the serializer fails.
pub fn serialize<C: Coefficients, S: Serializer>(coefficients: &C, serializer: S) -> Result<S::Ok, S::Error> {
    let mut fields = *coefficients;
    let mut map = serializer.serialize_map(Some(C::LIST.len()))?;
    for declared in C::LIST {
        if let Some(value) = fields.field(declared.name) {
            map.serialize_entry(declared.name, value)?;
        }
    }
    map.end()
}

/// Reads coefficients from a map; omitted ones keep the published value.
///
/// # Errors
/// If a name is unknown or a value lies outside its range.
pub fn deserialize<'de, C: Coefficients, D: Deserializer<'de>>(deserializer: D) -> Result<C, D::Error> {
    deserializer.deserialize_map(Record(PhantomData))
}

/// Reads the map. Models are built again for every sample of a study, so names are compared without copying them.
struct Record<C>(PhantomData<C>);

impl<'de, C: Coefficients> Visitor<'de> for Record<C> {
    type Value = C;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map of coefficients")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<C, M::Error> {
        let mut read = C::default();
        while let Some(declared) = map.next_key_seed(Name::<C>(PhantomData))? {
            let value: f64 = map.next_value()?;
            if !(declared.least..=declared.greatest).contains(&value) {
                return Err(M::Error::custom(format!(
                    "coefficient `{}` is {value}, outside its range {} to {}",
                    declared.name, declared.least, declared.greatest
                )));
            }
            if let Some(field) = read.field(declared.name) {
                *field = value;
            }
        }
        Ok(read)
    }
}

/// Reads the name of a coefficient.
struct Name<C>(PhantomData<C>);

impl<'de, C: Coefficients> DeserializeSeed<'de> for Name<C> {
    type Value = &'static Declared;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl<C: Coefficients> Visitor<'_> for Name<C> {
    type Value = &'static Declared;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a coefficient")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Self::Value, E> {
        C::LIST.iter().find(|declared| declared.name == name).ok_or_else(|| {
            let names: Vec<&str> = C::LIST.iter().map(|declared| declared.name).collect();
            E::custom(format!("unknown coefficient `{name}`; available: {}", names.join(", ")))
        })
    }
}

/// The schema of a record of coefficients.
pub fn schema<C: Coefficients>() -> Schema {
    let property = |declared: &Declared| {
        let schema = json!({
            "type": "number",
            "description": format!("{} [-]", declared.doc.trim()),
            "default": declared.published,
            "minimum": declared.least,
            "maximum": declared.greatest,
            // In the units of the formula.
            "x-bare": true,
        });
        (declared.name.to_owned(), schema)
    };
    let properties: Map<String, Value> = C::LIST.iter().map(property).collect();
    json_schema!({
        "type": "object",
        "description": format!("{} {RULES}", C::ABOUT.trim()),
        "properties": properties,
    })
}

/// Declares the coefficients of a published formula: each with its doc comment, its published value and the range in which it may
/// be changed. The formula must be defined for all values in the range.
///
/// ```
/// gearloss_framework::coefficients! {
///     /// Constants of a law of friction.
///     pub struct Constants {
///         /// Factor of the formula.
///         factor = 0.048, in 0.024..=0.096;
///         /// Exponent of the line load in N/mm.
///         load_exponent = 0.2, in 0.1..=0.4;
///     }
/// }
/// assert_eq!(Constants::default().load_exponent, 0.2);
/// ```
#[macro_export]
macro_rules! coefficients {
    ($(#[doc = $about:literal])+ $visibility:vis struct $Name:ident {
        $($(#[doc = $doc:literal])+ $field:ident = $published:expr, in $range:expr;)+
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, Copy, PartialEq)]
        $visibility struct $Name {
            $($(#[doc = $doc])+ pub $field: f64,)+
        }

        impl $Name {
            /// The values of the source.
            pub const PUBLISHED: Self = Self { $($field: $published,)+ };
        }

        impl Default for $Name {
            fn default() -> Self {
                Self::PUBLISHED
            }
        }

        impl $crate::coefficients::Coefficients for $Name {
            const ABOUT: &'static str = concat!($($about),+);
            const LIST: &'static [$crate::coefficients::Declared] = &[$($crate::coefficients::Declared {
                name: stringify!($field),
                doc: concat!($($doc),+),
                published: $published,
                least: *($range).start(),
                greatest: *($range).end(),
            }),+];
            fn field(&mut self, name: &str) -> Option<&mut f64> {
                match name {
                    $(stringify!($field) => Some(&mut self.$field),)+
                    _ => None,
                }
            }
        }

        impl $crate::coefficients::serde::Serialize for $Name {
            fn serialize<S: $crate::coefficients::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $crate::coefficients::serialize(self, serializer)
            }
        }

        impl<'de> $crate::coefficients::serde::Deserialize<'de> for $Name {
            fn deserialize<D: $crate::coefficients::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::coefficients::deserialize(deserializer)
            }
        }

        impl $crate::schemars::JsonSchema for $Name {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                stringify!($Name).into()
            }
            fn json_schema(_: &mut $crate::schemars::SchemaGenerator) -> $crate::schemars::Schema {
                $crate::coefficients::schema::<Self>()
            }
        }
    };
}

/// A coefficient of a registered model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Coefficient {
    /// Key below `coefficients` in the record of the model.
    pub name: String,
    /// Description.
    pub meaning: String,
    /// Unit; `-` for a number in the units of the formula.
    pub unit: &'static str,
    /// Value of the source.
    pub published: f64,
    /// Lower end of the accepted range.
    pub least: f64,
    /// Upper end of the accepted range.
    pub greatest: f64,
}

impl Entry {
    /// The coefficients of the model's formula, as declared by its parameters.
    pub fn coefficients(&self) -> Vec<Coefficient> {
        let schema = (self.schema)(&mut schemars::SchemaGenerator::default()).to_value();
        let list = schema["properties"][COEFFICIENTS]["properties"].as_object();
        let read = |(name, field): (&String, &Value)| {
            let doc = field["description"].as_str().unwrap_or_default();
            Some(Coefficient {
                name: name.clone(),
                meaning: doc.trim().trim_end_matches("[-]").trim_end().to_owned(),
                unit: "-",
                published: field["default"].as_f64()?,
                least: field["minimum"].as_f64()?,
                greatest: field["maximum"].as_f64()?,
            })
        };
        list.into_iter().flatten().filter_map(read).collect()
    }
}

/// A coefficient that differs from the published value, with all models that have the same change.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Changed {
    /// Paths of the models, such as `meshes.M1.model`.
    pub paths: Vec<String>,
    /// Key of the mechanism.
    pub mechanism: &'static str,
    /// Name of the model.
    pub model: &'static str,
    /// Key below `coefficients`.
    pub coefficient: String,
    /// Value in use.
    pub value: f64,
    /// Value of the source.
    pub published: f64,
    /// The model's source.
    pub source: &'static str,
}

impl Changed {
    /// The same, restricted to the models of one component; `None` if it has none of them.
    pub fn below(&self, component: &str) -> Option<Self> {
        let inside = |path: &&String| {
            path.strip_prefix(component)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let paths: Vec<String> = self.paths.iter().filter(inside).cloned().collect();
        (!paths.is_empty()).then(|| Self { paths, ..self.clone() })
    }
}

impl fmt::Display for Changed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {}: {COEFFICIENTS}.{} {} instead of {}, changed from the source ({})",
            self.paths.join(", "),
            self.model,
            self.coefficient,
            self.value,
            self.published,
            self.source
        )
    }
}

/// All coefficients of a transmission that differ from the published values, in the order of its models.
pub fn changed_from_source(transmission: &Transmission, resolved: &Resolved) -> Vec<Changed> {
    let mut all: Vec<Changed> = Vec::new();
    for instance in transmission.instances() {
        for changed in changed_in(instance, &resolved.value) {
            let same = |known: &&mut Changed| {
                (known.mechanism, known.model, &known.coefficient)
                    == (changed.mechanism, changed.model, &changed.coefficient)
                    && known.value == changed.value
            };
            match all.iter_mut().find(same) {
                Some(known) => known.paths.extend(changed.paths),
                None => all.push(changed),
            }
        }
    }
    all
}

/// The changed coefficients of one model.
fn changed_in(instance: &Instance, document: &Value) -> Vec<Changed> {
    let entry = &instance.entry;
    let written = lookup(document, &format!("{}.{COEFFICIENTS}", instance.path)).filter(|value| value.is_object());
    let Some(written) = written else {
        return Vec::new();
    };
    let changed = |coefficient: Coefficient| {
        let value = written[&coefficient.name].as_f64()?;
        (value != coefficient.published).then(|| Changed {
            paths: vec![instance.path.clone()],
            mechanism: entry.mechanism,
            model: entry.name,
            coefficient: coefficient.name,
            value,
            published: coefficient.published,
            source: entry.source,
        })
    };
    entry.coefficients().into_iter().filter_map(changed).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    crate::coefficients! {
        /// Constants of a test.
        struct Constants {
            /// Factor of the formula
            /// over two lines.
            factor = 0.048, in 0.024..=0.096;
            /// Exponent of the speed.
            speed_exponent = -1.0 / 3.0, in -0.5..=-0.1;
        }
    }

    fn read(value: Value) -> Result<Constants, String> {
        serde_json::from_value(value).map_err(|e| e.to_string())
    }

    #[test]
    fn absent_ones_keep_the_published_value_to_the_bit() {
        assert_eq!(read(json!({})).unwrap(), Constants::default());
        let read_back = read(json!({ "factor": 0.05 })).unwrap();
        assert_eq!((read_back.factor, read_back.speed_exponent), (0.05, -1.0 / 3.0));
        let back: Constants = serde_json::from_value(serde_json::to_value(read_back).unwrap()).unwrap();
        assert_eq!(back, read_back);
    }

    #[test]
    fn unknown_names_and_values_outside_the_range_are_refused() {
        assert!(
            read(json!({ "facto": 0.05 }))
                .unwrap_err()
                .contains("available: factor, speed_exponent")
        );
        assert!(
            read(json!({ "factor": 0.1 }))
                .unwrap_err()
                .contains("outside its range 0.024 to 0.096")
        );
        assert!(read(json!({ "factor": null })).is_err());
    }

    #[test]
    fn the_schema_has_default_range_and_text() {
        let schema = schema::<Constants>().to_value();
        let factor = &schema["properties"]["factor"];
        assert_eq!(factor["default"], 0.048);
        assert_eq!((&factor["minimum"], &factor["maximum"]), (&json!(0.024), &json!(0.096)));
        assert_eq!(factor["description"], "Factor of the formula over two lines. [-]");
        assert!(
            schema["description"]
                .as_str()
                .unwrap()
                .starts_with("Constants of a test. Values as in the source")
        );
    }
}
