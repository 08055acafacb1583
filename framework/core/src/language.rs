//! The language of documents: the schema of everything that linked mechanisms and models accept, composed once per program.

mod compose;
mod readable;
mod undescribed;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use schemars::SchemaGenerator;
use serde_json::Value;

pub use undescribed::{DESCRIBE_THE_REST, stage_with_section, undescribed_stage};

use crate::codes;
use crate::coefficients::COEFFICIENTS;
use crate::document::{
    Diagnostic, Node, Places, Schema, Shape, Unit, Walked, classify, read_yaml, walk, walk_at, walk_shape,
};
use crate::mechanism::Mechanism;
use crate::mechanism::bevel_mesh::BevelMesh;
use crate::mechanism::chain::Chain;
use crate::mechanism::crossed_helical_mesh::CrossedHelicalMesh;
use crate::mechanism::differential::Differential;
use crate::mechanism::gear_drag::{GearDrag, Scope};
use crate::mechanism::gear_mesh::GearMesh;
use crate::mechanism::heat_dissipation::HeatDissipation;
use crate::mechanism::joint::Joint;
use crate::mechanism::planetary_drag::PlanetaryDrag;
use crate::mechanism::worm_mesh::WormMesh;
use crate::registry::{DocumentKind, Entry, Files, RatingPlugin, Registry, inventory};
use crate::resolve::{CatalogueTable, Fault, LinkedCatalogue, RATINGS};

/// Key of the mechanism of mesh models.
pub(crate) const MESHES: &str = GearMesh::KEY;
/// Key of the mechanism of planetary set models.
pub const SETS: &str = PlanetaryDrag::KEY;
/// Section of differentials, which need no model.
pub(crate) const DIFFERENTIALS: &str = "differentials";
/// Mechanisms whose models are in sections of the framework itself: section and key.
pub const HELD: [(&str, &str); 8] = [
    ("meshes", MESHES),
    ("bevel_meshes", BevelMesh::KEY),
    ("worm_meshes", WormMesh::KEY),
    ("crossed_helical_meshes", CrossedHelicalMesh::KEY),
    ("planetary_sets", SETS),
    ("chains", Chain::KEY),
    ("joints", Joint::KEY),
    (DIFFERENTIALS, Differential::KEY),
];
/// Key of the mechanism of named gear and mesh drag models.
pub const DRAGS: &str = GearDrag::KEY;

/// Key of the mechanism of the named models in the thermal section.
pub(crate) const HEAT: &str = HeatDissipation::KEY;
/// Mechanisms with several models chosen by name.
pub const NAMED: [&str; 2] = [DRAGS, HEAT];

/// Section of the oils, which has catalogues like the sections of components.
pub const LUBRICANTS: &str = "lubricants";

/// Section of the materials of gears, which has catalogues as well.
pub const MATERIALS: &str = "materials";

/// Name of the schema of a study, under which the crate of studies registers it.
pub const STUDY: &str = "study";

/// Kind of a document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A gearbox.
    Gearbox,
    /// A study.
    Study,
    /// Input of `eval`, which depends on the mechanism.
    Eval,
}

/// Registry, schemas and catalogues of one program. Built once; all readers of documents borrow it.
pub struct Language {
    registry: Registry,
    gearbox: Document,
    /// Documents of other crates by name. Each is composed when it is first needed, because a gearbox alone needs none of them.
    others: BTreeMap<&'static str, Other>,
    catalogues: BTreeMap<&'static str, LinkedCatalogue>,
    sets: BTreeMap<String, Value>,
}

/// The schema of a kind of document, published and compiled.
struct Document {
    published: Value,
    schema: Schema,
}

impl Document {
    /// # Errors
    /// Every construct of the schema that cannot be checked.
    fn new(published: Value) -> Result<Self, Vec<Diagnostic>> {
        let mut found = Vec::new();
        if let Some(schema) = compiled(&published, &mut found) {
            return Ok(Self { published, schema });
        }
        classify(&mut found, codes::REGISTRATION);
        Err(found)
    }
}

/// A document of another crate.
struct Other {
    schema: fn(&mut SchemaGenerator) -> schemars::Schema,
    composed: OnceLock<Result<Document, Vec<Diagnostic>>>,
}

impl Language {
    /// The language of a registry.
    ///
    /// # Errors
    /// Every construct of the schema of a gearbox that cannot be checked, with mechanism, model and field; every fault of a linked
    /// set, and of the form of a linked catalogue, whose rows are [read later](Self::faults_of_catalogues).
    pub fn new(registry: Registry) -> Result<Self, Vec<Diagnostic>> {
        let mut found = Vec::new();
        let gearbox = match Document::new(compose::gearbox(&registry)) {
            Ok(gearbox) => Some(gearbox),
            Err(faults) => {
                found.extend(faults);
                None
            }
        };
        let other = |kind: &DocumentKind| {
            let other = Other {
                schema: kind.schema,
                composed: OnceLock::new(),
            };
            (kind.name, other)
        };
        let mut catalogues: BTreeMap<&'static str, LinkedCatalogue> = BTreeMap::new();
        for section in registry.sections().map(|(_, s)| s.name).chain([LUBRICANTS, MATERIALS]) {
            for catalogue in registry.catalogues(section) {
                let place = format!("registered at {}", catalogue.origin);
                match catalogues.entry(section).or_default().add(catalogue.csv) {
                    Ok(()) => {}
                    Err(Fault::Twice(twice)) => found.push(
                        Diagnostic::error("", format!("two catalogues of {section} have a row `{twice}`"))
                            .note(format!("the later one is {place}"))
                            .help("remove it from one, or state the values in the gearbox's own catalogue"),
                    ),
                    Err(Fault::Form(reason)) => {
                        found.push(Diagnostic::error("", format!("catalogue of {section}: {reason}")).note(place));
                    }
                }
            }
        }
        classify(&mut found, codes::REGISTRATION);
        let Some(gearbox) = gearbox else {
            return Err(found);
        };
        let mut language = Self {
            registry,
            gearbox,
            others: inventory::iter::<DocumentKind>.into_iter().map(other).collect(),
            catalogues,
            sets: BTreeMap::new(),
        };
        for set in language.registry.shipped_sets().to_vec() {
            match language.part_of_document(set.yaml, &format!("model_sets.{}", set.name)) {
                Ok(value) => {
                    language.sets.insert(set.name.to_owned(), value);
                }
                Err(more) => found.extend(
                    more.into_iter()
                        .map(|d| d.note(format!("in the set registered at {}", set.origin))),
                ),
            }
        }
        if found.is_empty() { Ok(language) } else { Err(found) }
    }

    /// The registry.
    pub fn registry(&self) -> &Registry {
        &self.registry
    }

    /// The published JSON Schema (draft-07) of a kind of document; for `eval` of one mechanism.
    pub fn published(&self, kind: Kind) -> Value {
        match kind {
            Kind::Gearbox => self.gearbox.published.clone(),
            Kind::Study => self.composed(&self.others[STUDY]),
            Kind::Eval => compose::eval(&self.registry),
        }
    }

    /// Checks a gearbox.
    pub fn walk_gearbox(&self, node: &Node) -> Walked {
        let walked = walk(node, self.gearbox());
        Walked {
            findings: undescribed::explained(walked.findings, node),
            ..walked
        }
    }

    /// Checks a study.
    ///
    /// # Panics
    /// If the crate that registers this kind of document is not linked.
    pub fn walk_study(&self, node: &Node) -> Walked {
        self.walk_document(STUDY, node)
    }

    /// Checks a document of another crate, by the name under which that crate registers its schema.
    ///
    /// # Panics
    /// If no linked crate registers it.
    pub fn walk_document(&self, name: &str, node: &Node) -> Walked {
        match self.document(&self.others[name]) {
            Ok(document) => walk(node, &document.schema),
            Err(faults) => Walked {
                value: Value::Null,
                findings: faults.clone(),
                places: Places::default(),
            },
        }
    }

    /// The document of another crate.
    ///
    /// # Errors
    /// Every construct of its schema that cannot be checked.
    fn document<'a>(&'a self, other: &'a Other) -> Result<&'a Document, &'a Vec<Diagnostic>> {
        let composed = other.composed.get_or_init(|| Document::new(self.composed(other)));
        composed.as_ref()
    }

    /// The schema of the document of another crate.
    fn composed(&self, other: &Other) -> Value {
        compose::document(&self.registry, other.schema)
    }

    fn gearbox(&self) -> &Schema {
        &self.gearbox.schema
    }

    /// Checks the input of `eval` for one mechanism: `model`, `part` and `at`.
    ///
    /// # Errors
    /// If the schema of the mechanism cannot be compiled.
    pub fn walk_eval(&self, mechanism: &str, node: &Node) -> Result<Walked, Vec<Diagnostic>> {
        let mut found = Vec::new();
        match compiled(&compose::eval_of(&self.registry, mechanism), &mut found) {
            Some(schema) => Ok(walk(node, &schema)),
            None => Err(found),
        }
    }

    /// Checks a value against the gearbox schema at a path; returns the value in SI with defaults filled in. Quantities may be
    /// texts with a unit or numbers in the documented unit.
    ///
    /// # Errors
    /// All findings of the check.
    pub fn checked(&self, value: &Value, path: &str) -> Result<Value, Vec<Diagnostic>> {
        fine(walk_at(&Node::from_json(value), self.gearbox(), path))
    }

    /// As [`Language::checked`], for a path of an existing document: inside a model, the keys and ranges of its `type` apply, not
    /// those of other models.
    ///
    /// # Errors
    /// All findings of the check.
    pub fn checked_in(&self, document: &Value, value: &Value, path: &str) -> Result<Value, Vec<Diagnostic>> {
        // A new `type` may be any model, not only the present one.
        let shape = self
            .shape_at(document, path)
            .filter(|_| path.rsplit('.').next() != Some("type"));
        match shape {
            Some(shape) => fine(walk_shape(&Node::from_json(value), self.gearbox(), shape, path)),
            None => self.checked(value, path),
        }
    }

    /// True if a resolved document accepts a path: the keys of a model are those of its `type`.
    pub fn has_place(&self, document: &Value, path: &str) -> bool {
        self.shape_at(document, path).is_some()
    }

    /// The keys of an entry of a section, such as `bearings`.
    pub fn keys_of(&self, section: &str) -> Vec<&str> {
        match self.gearbox().shape_at(&format!("{section}.id"), |_| None) {
            Some(Shape::Record(fields)) => fields.iter().map(|(name, _)| name.as_str()).collect(),
            _ => Vec::new(),
        }
    }

    fn shape_at(&self, document: &Value, path: &str) -> Option<&Shape> {
        let tag = |slot: &str| {
            let slot = crate::resolve::lookup(document, slot)?;
            slot.get("type").and_then(Value::as_str).map(str::to_owned)
        };
        self.gearbox().shape_at(path, tag)
    }

    /// Unit, minimum and maximum of the number that a resolved document has at a path; `None` if it is not a number.
    pub fn number_at(&self, document: &Value, path: &str) -> Option<(&'static Unit, f64, f64)> {
        let number = |shape| match shape {
            &Shape::Number {
                unit,
                least,
                greatest,
                whole: false,
                ..
            } => Some((unit, least, greatest)),
            _ => None,
        };
        match self.shape_at(document, path)? {
            Shape::Either(shapes) => shapes.iter().find_map(number),
            shape => number(shape),
        }
    }

    /// Whether a resolved document has a whole number at a path, such as a number of teeth.
    pub fn is_whole_at(&self, document: &Value, path: &str) -> bool {
        let is_whole = |shape: &Shape| matches!(shape, Shape::Number { whole: true, .. });
        match self.shape_at(document, path) {
            Some(Shape::Either(shapes)) => shapes.iter().any(is_whole),
            Some(shape) => is_whole(shape),
            None => false,
        }
    }

    /// The published value of the coefficient of a model's formula that a resolved document has at a path; `None` if the path is
    /// not a coefficient.
    pub fn published_coefficient(&self, document: &Value, path: &str) -> Option<f64> {
        let (record, name) = path.rsplit_once('.')?;
        let (_, COEFFICIENTS) = record.rsplit_once('.')? else {
            return None;
        };
        let Shape::Record(fields) = self.shape_at(document, record)? else {
            return None;
        };
        let (_, field) = fields.iter().find(|(known, _)| known == name)?;
        field.default.as_ref()?.as_f64()
    }

    /// A piece of YAML checked against the gearbox schema at a path.
    ///
    /// # Errors
    /// All findings of reading and checking.
    pub fn part_of_document(&self, yaml: &str, path: &str) -> Result<Value, Vec<Diagnostic>> {
        let read = read_yaml(0, yaml);
        if !read.findings.is_empty() {
            return Err(read.findings);
        }
        fine(walk_at(&read.node, self.gearbox(), path))
    }

    /// The resolved example of a model and the resolved example part of its mechanism.
    ///
    /// # Errors
    /// All findings of reading and checking either.
    pub fn example_of(&self, entry: &Entry) -> Result<(Value, Value), Vec<Diagnostic>> {
        let mechanism = self.registry.mechanism(entry.mechanism);
        let part = entry.part.unwrap_or_else(|| mechanism.map_or("{}", |m| m.example));
        let indented = part
            .trim()
            .lines()
            .fold(String::new(), |text, line| text + "\n  " + line);
        let yaml = format!("model: {}\npart:{indented}\n", entry.example);
        let read = read_yaml(0, &yaml);
        if !read.findings.is_empty() {
            return Err(read.findings);
        }
        let value = fine(self.walk_eval(entry.mechanism, &read.node)?)?;
        Ok((value["model"].clone(), value["part"].clone()))
    }

    /// The parameters of a rating with their defaults.
    ///
    /// # Errors
    /// If one of them has no default.
    pub fn default_rating(&self, name: &str) -> Result<Value, Vec<Diagnostic>> {
        self.checked(&Value::Object(serde_json::Map::new()), &format!("{RATINGS}.{name}"))
    }

    /// The parameters of a rating with their defaults, and the resolved example part of its mechanism.
    ///
    /// # Errors
    /// All findings of reading and checking either.
    pub fn example_of_rating(&self, rating: &RatingPlugin) -> Result<(Value, Value), Vec<Diagnostic>> {
        let mechanism = self.registry.mechanism(rating.entry.mechanism);
        let part = rating
            .entry
            .part
            .unwrap_or_else(|| mechanism.map_or("{}", |m| m.example));
        let indented = part
            .trim()
            .lines()
            .fold(String::new(), |text, line| text + "\n  " + line);
        let read = read_yaml(0, &format!("part:{indented}\n"));
        if !read.findings.is_empty() {
            return Err(read.findings);
        }
        let value = fine(self.walk_rating(rating, &read.node)?)?;
        Ok((self.default_rating(rating.entry.name)?, value["part"].clone()))
    }

    /// Checks the input of a rating that is evaluated alone: `rating`, `part` and `at`.
    ///
    /// # Errors
    /// If the schema of the rating cannot be compiled.
    pub fn walk_rating(&self, rating: &RatingPlugin, node: &Node) -> Result<Walked, Vec<Diagnostic>> {
        let mut found = Vec::new();
        match compiled(&compose::rating(&self.registry, rating), &mut found) {
            Some(schema) => Ok(walk(node, &schema)),
            None => Err(found),
        }
    }

    /// Whether the law of a model is written for any number: then it answers for several points at once and has exact derivatives.
    /// Other laws are differentiated by differences.
    pub fn is_generic(&self, entry: &Entry) -> bool {
        let files = Files::default();
        files.put_all(entry.files);
        let example = self
            .example_of(entry)
            .ok()
            .zip(self.registry.mechanism(entry.mechanism));
        example.and_then(|((model, part), mechanism)| (mechanism.is_generic)(&self.registry, &files, &model, &part))
            == Some(true)
    }

    /// Sections whose entries have one model each, with the key of the mechanism.
    pub fn sections(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.registry.sections().map(|(m, s)| (s.name, m.key)).chain(HELD)
    }

    /// All rows of the linked catalogues of a section.
    pub fn catalogue(&self, section: &str) -> Option<&CatalogueTable> {
        self.linked_catalogue(section).map(LinkedCatalogue::table)
    }

    /// The linked catalogues of a section, for single rows.
    pub fn linked_catalogue(&self, section: &str) -> Option<&LinkedCatalogue> {
        self.catalogues.get(section)
    }

    /// Faults of the rows of all linked catalogues: cells that are no numbers, unknown keys, and values that the keys do not accept.
    pub fn faults_of_catalogues(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (section, catalogue) in &self.catalogues {
            faults.extend(
                catalogue
                    .faults()
                    .map(|fault| format!("catalogue of {section}: {fault}")),
            );
            for (designation, row) in &catalogue.table().0 {
                for (key, value) in &row.values {
                    let wrong = self.checked(value, &format!("{section}.row.{key}")).err();
                    for wrong in wrong.into_iter().flatten() {
                        faults.push(format!(
                            "catalogue of {section}: `{designation}`: {key}: {}",
                            wrong.message
                        ));
                    }
                }
            }
        }
        faults
    }

    /// The model sets shipped by linked crates, checked.
    pub fn shipped_sets(&self) -> &BTreeMap<String, Value> {
        &self.sets
    }

    /// True if the scope of a drag model, as data, is `gears` or `meshes`.
    pub fn fits_scope(&self, section: &str, model: &Value) -> bool {
        let name = model.as_str().or_else(|| model["type"].as_str()).unwrap_or("none");
        match self.registry.model(DRAGS, name).map(|entry| entry.scope) {
            Some(Scope::Gear) => section == "gears",
            Some(Scope::Mesh) => section == "meshes",
            None => true,
        }
    }
}

fn compiled(schema: &Value, found: &mut Vec<Diagnostic>) -> Option<Schema> {
    match Schema::compile(schema) {
        Ok(schema) => Some(schema),
        Err(unsupported) => {
            found.extend(
                unsupported
                    .into_iter()
                    .map(|u| Diagnostic::error("", format!("schema: {u}"))),
            );
            None
        }
    }
}

fn fine(walked: Walked) -> Result<Value, Vec<Diagnostic>> {
    if walked.findings.is_empty() {
        Ok(walked.value)
    } else {
        Err(walked.findings)
    }
}
