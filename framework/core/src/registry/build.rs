//! Context of a model while it is built.

use std::any::Any;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Entry, Memory, Registry, from_resolved};
use crate::attach::dangling;
use crate::codes;
use crate::contact::sharing::{ACCURATE, CalculatedSharing, Flank, Sharing, SharingEntry, SharingFault};
use crate::document::{Diagnostic, did_you_mean};
use crate::files::{Disk, InMemory, LONGEST_DATA, SharedSource};
use crate::loss::{NoteBase, Term};
use crate::mechanism::gear_drag::{GearDrag, Scope};
use crate::mechanism::gear_mesh::{GearMesh, MeshPart};
use crate::mechanism::mean_friction::MeanFriction;
use crate::mechanism::tooth_friction::ToothFriction;
use crate::mechanism::{Mechanism, ModelRef, Slot};
use crate::rating::{Rating, RatingSlot};

/// Files named by a description, read once; paths are relative to the document that names them.
#[derive(Debug)]
pub struct Files {
    folder: PathBuf,
    source: SharedSource,
    read: Mutex<BTreeMap<PathBuf, FileContent>>,
}

/// A file that was read: as a text, or as bytes that may be a workbook.
#[derive(Debug, Clone)]
enum FileContent {
    Text(Arc<str>),
    Bytes(Arc<[u8]>),
}

impl FileContent {
    fn bytes(&self) -> Arc<[u8]> {
        match self {
            Self::Text(text) => Arc::from(Arc::clone(text)),
            Self::Bytes(bytes) => Arc::clone(bytes),
        }
    }
}

/// No files but those that are given by [`Files::put`].
impl Default for Files {
    fn default() -> Self {
        Self::from_source(Arc::new(InMemory::default()), PathBuf::new())
    }
}

/// With the files read so far; the copy keeps its own list of those that it reads from then on.
impl Clone for Files {
    fn clone(&self) -> Self {
        let read = self.read.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        Self {
            folder: self.folder.clone(),
            source: Arc::clone(&self.source),
            read: Mutex::new(read.clone()),
        }
    }
}

impl Files {
    /// Files on disk, in the folder of a document.
    pub fn beside(folder: impl Into<PathBuf>) -> Self {
        Self::from_source(Disk::shared(), folder)
    }

    /// Files of a source, relative to this folder.
    pub fn from_source(source: SharedSource, folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            source,
            read: Mutex::default(),
        }
    }

    /// The text of a file.
    ///
    /// # Errors
    /// The reason why it cannot be read, with the path that was tried.
    pub fn text(&self, name: &str) -> Result<Arc<str>, String> {
        let path = self.folder.join(name);
        let mut read = self.read.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(FileContent::Text(text)) = read.get(&path) {
            return Ok(Arc::clone(text));
        }
        let text: Arc<str> = self
            .source
            .read_text(&path, LONGEST_DATA)
            .map_err(|e| format!("cannot read {}: {e}", path.display()))?
            .into();
        read.insert(path, FileContent::Text(Arc::clone(&text)));
        Ok(text)
    }

    /// The names of the files in a folder, in order.
    ///
    /// # Errors
    /// The reason why it cannot be listed, with the path that was tried.
    pub fn list(&self, folder: &str) -> Result<Vec<String>, String> {
        let path = self.folder.join(folder);
        let names = self.source.list(&path);
        names.map_err(|e| format!("cannot list {}: {e}", path.display()))
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// The reason why it cannot be read, with the path that was tried.
    pub fn bytes(&self, name: &str) -> Result<Arc<[u8]>, String> {
        let path = self.folder.join(name);
        let mut read = self.read.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(content) = read.get(&path) {
            return Ok(content.bytes());
        }
        let bytes: Arc<[u8]> = self
            .source
            .read(&path, LONGEST_DATA)
            .map_err(|e| format!("cannot read {}: {e}", path.display()))?
            .into();
        read.insert(path, FileContent::Bytes(Arc::clone(&bytes)));
        Ok(bytes)
    }

    /// Provides a text for a file that need not exist.
    pub fn put(&self, name: &str, text: &str) {
        let path = self.folder.join(name);
        self.read
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .insert(path, FileContent::Text(text.into()));
    }

    /// Provides several files: names with their text.
    pub fn put_all(&self, files: &[(&str, &str)]) {
        for (name, text) in files {
            self.put(name, text);
        }
    }

    /// All files read so far, with their content.
    pub fn all(&self) -> Vec<(PathBuf, Arc<[u8]>)> {
        let read = self.read.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        read.iter()
            .map(|(path, content)| (path.clone(), content.bytes()))
            .collect()
    }
}

/// One built model with its path in the document.
#[derive(Clone)]
pub struct Instance {
    /// Resolved path of the model, such as `bearings.B1.model`.
    pub path: String,
    /// Its registration.
    pub entry: Entry,
    /// Position of its notes.
    pub notes: NoteBase,
    /// Parameters that it does not use for its part, so that their defaults are no evidence of its result.
    pub unused: Vec<&'static str>,
    /// What is doubtful about its parameters.
    pub doubts: Vec<Diagnostic>,
}

/// Context of a model while it is built: the registry for nested slots, its part, its path, files. Collects findings.
pub struct Build<'a> {
    registry: &'a Registry,
    files: &'a Files,
    path: String,
    part: Option<Arc<dyn Any + Send + Sync>>,
    /// Scope of the drag model whose slot is being built.
    around: Option<Scope>,
    instances: Vec<Instance>,
    cells: usize,
    /// Paths of the elements of the oil network; `None` while a model is built without a gearbox.
    pub(crate) oil_elements: Option<Vec<String>>,
    /// The element that the model named which is being built.
    supply: Option<Arc<str>>,
    /// True if the oil space of the housing is drawn.
    pub(crate) drawn_space: bool,
    /// What the last build left, and what this one leaves.
    pub(crate) memory: Memory,
}

/// A model that was built, with everything that it depends on.
struct KeptSlot<M: Mechanism> {
    part: Arc<dyn Any + Send + Sync>,
    slot: Slot<M>,
    /// Its instance and those of its nested models.
    instances: Vec<Instance>,
    /// Number of the first of them, and of their first cell and the cell after the last.
    first: usize,
    cells: [usize; 2],
}

impl<'a> Build<'a> {
    /// A fresh build.
    pub fn new(registry: &'a Registry, files: &'a Files) -> Self {
        Self::again(registry, files, Memory::default())
    }

    /// A build after another one.
    pub(crate) fn again(registry: &'a Registry, files: &'a Files, mut memory: Memory) -> Self {
        memory.begin();
        Self {
            registry,
            files,
            path: String::new(),
            part: None,
            around: None,
            instances: Vec::new(),
            cells: 0,
            oil_elements: None,
            supply: None,
            drawn_space: false,
            memory,
        }
    }

    /// An error at the path that is being built.
    pub fn error(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(self.path.clone(), message).code(codes::MODEL)
    }

    /// Adds a warning at a parameter of the model that is being built.
    pub fn doubt(&mut self, key: &str, warning: Diagnostic) {
        let path = format!("{}.{key}", self.path);
        if let Some(instance) = self.instances.iter_mut().rfind(|instance| instance.path == self.path) {
            instance.doubts.push(Diagnostic { path, ..warning });
        }
    }

    /// True if the oil space of the housing is that of a drawing.
    pub fn has_drawn_space(&self) -> bool {
        self.drawn_space
    }

    /// The path that is being built.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// States parameters of the model that is being built which its part does not need, so that the grades of their defaults do not count.
    pub fn leave_unused(&mut self, keys: impl IntoIterator<Item = &'static str>) {
        if let Some(instance) = self.instances.iter_mut().rfind(|instance| instance.path == self.path) {
            instance.unused.extend(keys);
        }
    }

    /// The part that the model belongs to, if it is one of this mechanism.
    pub fn part<M: Mechanism>(&self) -> Option<&M::Part> {
        self.part.as_ref().and_then(|part| part.downcast_ref())
    }

    /// The part that a model of this mechanism belongs to.
    ///
    /// # Errors
    /// If the framework builds the model without its part, which is a bug.
    pub fn own_part<M: Mechanism>(&self) -> Result<&M::Part, Diagnostic> {
        self.part::<M>().ok_or_else(|| self.error("bug: no part"))
    }

    /// True for the name of a drag model that is evaluated once per mesh.
    pub fn is_pair(&self, drag: &str) -> bool {
        let entry = self.registry.model(GearDrag::KEY, drag);
        entry.is_some_and(|entry| entry.scope == Scope::Mesh)
    }

    /// The text of a file that the description names.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn text(&self, file: &str) -> Result<Arc<str>, Diagnostic> {
        self.files.text(file).map_err(|reason| {
            self.error(reason)
                .help("names of files are relative to the document that names them")
        })
    }

    /// The bytes of a file that the description names.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn bytes(&self, file: &str) -> Result<Arc<[u8]>, Diagnostic> {
        self.files.bytes(file).map_err(|reason| {
            self.error(reason)
                .help("names of files are relative to the document that names them")
        })
    }

    /// The load sharing of the mesh to which the model belongs, from its parameter `load_sharing`, for a model that does not distinguish both
    /// flanks. Where it corrects a file, or is not accurate between its knots, it is doubted.
    ///
    /// # Errors
    /// A sharing that the mesh cannot have, a faulty file, or one with both flanks.
    pub fn load_sharing(&mut self, part: &MeshPart, entry: &SharingEntry) -> Result<Sharing, Diagnostic> {
        let (drive, coast) = self.load_sharings(part, entry)?;
        if coast.is_some() {
            let message = "this model does not know which flanks touch, and the file has shares of both";
            let help =
                "name a file without the column `flank`, or use a mesh model that integrates along the path of contact";
            return Err(Diagnostic::error(format!("{}.load_sharing", self.path), message)
                .code(codes::SHARES_OF_FLANKS)
                .help(help));
        }
        Ok(drive)
    }

    /// The same for the drive flank of the first gear, and for its coast flank if that has its own.
    ///
    /// # Errors
    /// A sharing that the mesh cannot have, or a faulty file.
    pub fn load_sharings(
        &mut self,
        part: &MeshPart,
        entry: &SharingEntry,
    ) -> Result<(Sharing, Option<Sharing>), Diagnostic> {
        if let SharingEntry::Fixed(sharing) = entry {
            return Ok((Sharing::Fixed(*sharing), None));
        }
        let files = self.files;
        let bytes = match entry {
            SharingEntry::Calculated(CalculatedSharing::File { path }) => Some(files.bytes(path)),
            _ => None,
        };
        let input = (part.clone().with_oil(None), entry.clone(), bytes);
        let prepared = self.repeat("load sharing", input, |(part, entry, bytes)| {
            let of = |flank| {
                Sharing::new(part, entry, flank, |_| {
                    bytes.clone().unwrap_or_else(|| Err(String::new()))
                })
            };
            Ok::<_, SharingFault>((of(Flank::Drive)?, of(Flank::Coast)?))
        });
        let path = format!("{}.load_sharing", self.path);
        let (drive, coast) = prepared.map_err(|fault| fault.at(&path))?;
        for sharing in [&drive, &coast].into_iter().flatten() {
            let Sharing::Loaded(shares) = sharing else { continue };
            if shares.deviation() > 1e-3 {
                let message = format!(
                    "the shares of the file add up to the whole force within {:.2} %; they are corrected",
                    shares.deviation() * 100.0
                );
                self.doubt(
                    "load_sharing",
                    Diagnostic::warning("", message).code(codes::SHARES_CORRECTED),
                );
            }
            if shares.error() > ACCURATE {
                let message = format!(
                    "between the loads at which the shares are calculated, the loss factor is interpolated within {:.2} %",
                    shares.error() * 100.0
                );
                self.doubt(
                    "load_sharing",
                    Diagnostic::warning("", message).code(codes::SHARES_COARSE),
                );
            }
        }
        let drive = drive.ok_or_else(|| self.error("bug: the drive flank has no load sharing"))?;
        Ok((drive, coast))
    }

    /// Has the context of the model show what flows through an element of the oil network, by its section, such as `nozzles`, and its name.
    ///
    /// # Errors
    /// If there is no such element, or a nested model names another one.
    pub fn oil_element(&mut self, section: &str, name: &str) -> Result<(), Diagnostic> {
        let path = format!("oil_network.{section}.{name}");
        if let Some(known) = &self.oil_elements
            && !known.contains(&path)
        {
            let first = format!("oil_network.{section}.");
            let names: Vec<&str> = known.iter().filter_map(|path| path.strip_prefix(&first)).collect();
            let what = section.trim_end_matches('s').replace('_', " ");
            return Err(dangling(&self.path, &what, name, &names));
        }
        if self.supply.as_ref().is_some_and(|other| **other != *path) {
            return Err(self
                .error("a nested model names another element of the oil network")
                .help("name the same element in both"));
        }
        self.supply = Some(path.into());
        Ok(())
    }

    /// The parameters of the model.
    ///
    /// # Errors
    /// Faults found by the parameters' own checks.
    pub fn params<T: DeserializeOwned>(&self, value: &Value) -> Result<T, Diagnostic> {
        from_resolved(value).map_err(|e| self.error(e.to_string()))
    }

    /// Builds the model of a nested slot; `key` is the field's name.
    ///
    /// # Errors
    /// If the nested model cannot be built.
    pub fn slot<M: Mechanism>(&mut self, key: &str, slot: &ModelRef<M>) -> Result<Slot<M>, Diagnostic> {
        let outer = self.path.len();
        self.path.push('.');
        self.path.push_str(key);
        let built = self.slot_here(&slot.value);
        self.path.truncate(outer);
        built
    }

    /// Builds the model of a nested slot for another part, which may be that of another mechanism.
    ///
    /// # Errors
    /// As [`Build::slot`].
    pub fn slot_of<M: Mechanism, P: Any + Send + Sync>(
        &mut self,
        key: &str,
        part: &Arc<P>,
        slot: &ModelRef<M>,
    ) -> Result<Slot<M>, Diagnostic> {
        let outer = self.part.replace(Arc::clone(part) as Arc<dyn Any + Send + Sync>);
        let built = self.slot(key, slot);
        self.part = outer;
        built
    }

    /// Builds a model at a path for a part.
    ///
    /// # Errors
    /// If the model cannot be built.
    pub fn slot_at<M: Mechanism>(
        &mut self,
        path: &str,
        part: &Arc<M::Part>,
        value: &Value,
    ) -> Result<Slot<M>, Diagnostic> {
        self.slot_beside(path, part, value)
    }

    /// Builds the model that the entry at a path states as its `model`; without one, `none`.
    ///
    /// # Errors
    /// If the model cannot be built.
    pub fn model_of<M: Mechanism>(
        &mut self,
        path: &str,
        part: &Arc<M::Part>,
        model: Option<&ModelRef<M>>,
    ) -> Result<Slot<M>, Diagnostic> {
        let none = Value::from("none");
        self.slot_at(
            [path, ".model"].concat().as_str(),
            part,
            model.map_or(&none, |model| &model.value),
        )
    }

    /// Builds a nested model at a path, for a part of another mechanism.
    ///
    /// # Errors
    /// If the model cannot be built.
    pub fn slot_beside<M: Mechanism, P: Any + Send + Sync>(
        &mut self,
        path: &str,
        part: &Arc<P>,
        value: &Value,
    ) -> Result<Slot<M>, Diagnostic> {
        let part = Arc::clone(part) as Arc<dyn Any + Send + Sync>;
        if let Some(slot) = self.kept_slot(path, &part) {
            return Ok(slot);
        }
        let (first, first_cell) = (self.instances.len(), self.cells);
        path.clone_into(&mut self.path);
        self.part = Some(Arc::clone(&part));
        self.supply = None;
        let built = self.slot_here(value);
        self.part = None;
        let mut slot: Slot<M> = built?;
        slot.supply = self.supply.take();
        let kept = KeptSlot {
            part,
            slot: slot.clone(),
            instances: self.instances[first..].to_vec(),
            first,
            cells: [first_cell, self.cells],
        };
        self.memory.keep_model(path, kept);
        Ok(slot)
    }

    /// The model of the last build at a path, if it was built for the same part, its choice has not changed in the document since, and its
    /// notes have the same place.
    fn kept_slot<M: Mechanism>(&mut self, path: &str, part: &Arc<dyn Any + Send + Sync>) -> Option<Slot<M>> {
        let kept: &KeptSlot<M> = self.memory.get(path)?;
        let same = std::ptr::addr_eq(Arc::as_ptr(&kept.part), Arc::as_ptr(part))
            && (kept.first, kept.cells[0]) == (self.instances.len(), self.cells)
            && self.memory.is_same_value(path);
        if !same {
            return None;
        }
        self.instances.extend_from_slice(&kept.instances);
        self.cells = kept.cells[1];
        Some(kept.slot.clone())
    }

    /// A part, or that of the last build if it is equal, so that its models are found again.
    pub(crate) fn part_again<P: PartialEq + Any + Send + Sync>(&mut self, path: &str, part: P) -> Arc<P> {
        let key = [path, ": part"].concat();
        match self.memory.get::<Arc<P>>(&key) {
            Some(known) if **known == part => Arc::clone(known),
            _ => {
                let part = Arc::new(part);
                self.memory.keep(&key, Arc::clone(&part));
                part
            }
        }
    }

    /// The result of a step of preparing the model from its whole input: that of the last build if the input is equal.
    pub fn repeat<I, O>(&mut self, step: &str, input: I, compute: impl FnOnce(&I) -> O) -> O
    where
        I: PartialEq + Any + Send + Sync,
        O: Clone + Any + Send + Sync,
    {
        let key = [&self.path, ": ", step].concat();
        self.memory.repeat(&key, input, compute)
    }

    fn slot_here<M: Mechanism>(&mut self, value: &Value) -> Result<Slot<M>, Diagnostic> {
        let name = value.as_str().or_else(|| value["type"].as_str()).unwrap_or("none");
        let Some(entry) = self.registry.model(M::KEY, name).copied() else {
            let names: Vec<&str> = self.registry.models(M::KEY).map(|m| m.name).collect();
            let missing = self.error(format!("no {} model is called `{name}`", M::KEY));
            let missing = missing.note(format!("available: {}", names.join(", ")));
            return Err(match did_you_mean(name, names.iter().copied()) {
                Some(close) => missing.help(format!("write `{close}`")),
                None => missing.help("use one of them"),
            });
        };
        let outer = self.around;
        if M::KEY == GearDrag::KEY {
            if (outer, entry.scope) == (Some(Scope::Gear), Scope::Mesh) {
                return Err(self
                    .error(format!(
                        "`{name}` is a law for meshes, but the enclosing model is for single gears"
                    ))
                    .help("choose a law for a single gear"));
            }
            self.around = Some(entry.scope);
        }
        let notes = NoteBase::new(
            self.instances.len(),
            self.cells,
            entry.limits.len(),
            entry.observed.len(),
        );
        self.cells = notes.end();
        self.instances.push(Instance {
            path: self.path.clone(),
            entry,
            notes,
            unused: Vec::new(),
            doubts: Vec::new(),
        });
        let built = (entry.build)(value, self);
        self.around = outer;
        let built = built?;
        if [MeanFriction::KEY, ToothFriction::KEY].contains(&M::KEY) && !entry.plastics {
            self.doubt_metal_law(name);
        }
        match built.downcast::<Arc<M::Model>>() {
            Ok(model) => Ok(Slot::new(*model, notes.until(self.cells), name == "none")),
            Err(_) => Err(self.error(format!("bug: model `{name}` was built for another mechanism"))),
        }
    }

    /// Doubts a law of friction between metal flanks, if a gear of the mesh is of plastic.
    fn doubt_metal_law(&mut self, name: &str) {
        let plastic = self.part::<GearMesh>().and_then(MeshPart::plastic);
        let Some(kind) = plastic.map(|material| material.kind.name()) else {
            return;
        };
        let message = format!("`{name}` is a law of metal flanks, and a gear of this mesh is of {kind}");
        let warning = Diagnostic::warning("", message)
            .code(codes::METAL_LAW)
            .help("choose a law for plastics: `gearloss models mean_friction` lists them, or state a `constant`");
        self.doubt("type", warning);
    }

    /// Number of the element of the oil network that a model names.
    pub(crate) fn supply<M: Mechanism>(&self, slot: &Slot<M>) -> Option<u16> {
        let path = slot.supply.as_deref()?;
        let number = self.oil_elements.as_ref()?.iter().position(|known| known == path)?;
        Some(number as u16)
    }

    /// Builds a rating at a path for a part.
    ///
    /// # Errors
    /// If the rating cannot be built.
    pub(crate) fn rating<M: Mechanism>(
        &mut self,
        path: &str,
        part: &Arc<M::Part>,
        entry: &Entry,
        value: &Value,
    ) -> Result<RatingSlot<M>, Diagnostic> {
        path.clone_into(&mut self.path);
        self.part = Some(Arc::clone(part) as Arc<dyn Any + Send + Sync>);
        let notes = NoteBase::new(self.instances.len(), self.cells, entry.limits.len(), 0);
        self.cells = notes.end();
        self.instances.push(Instance {
            path: path.to_owned(),
            entry: *entry,
            notes,
            unused: Vec::new(),
            doubts: Vec::new(),
        });
        let built = (entry.build)(value, self);
        self.part = None;
        match built?.downcast::<Arc<dyn Rating<M>>>() {
            Ok(rating) => Ok(RatingSlot {
                rating: *rating,
                notes: notes.until(self.cells),
            }),
            Err(_) => Err(self.error(format!("bug: rating `{}` was built for another mechanism", entry.name))),
        }
    }

    /// Number of the instances built so far.
    pub(crate) fn instances(&self) -> usize {
        self.instances.len()
    }

    /// The terms of the model with these notes.
    pub(crate) fn terms_of(&self, notes: NoteBase) -> &'static [Term] {
        self.instances
            .get(notes.instance())
            .map_or(&[], |instance| instance.entry.terms)
    }

    /// All instances built, and the number of their note cells.
    pub fn finish(self) -> (Vec<Instance>, usize) {
        (self.instances, self.cells)
    }
}
