//! Open documents over the files of a source: unsaved texts are seen by every document that names their file.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearloss_document::files::{FileSource, LONGEST_TEXT, SharedSource, without_dots};
use gearloss_framework::gearbox::DocumentKind;
use gearloss_framework::language::Language;

use crate::ids::{Name, Occurrence, occurrences};
use crate::outline::{Node, read};
use crate::place::{Place, Schemas};
use crate::text::Lines;

/// Maximum number of files that extend each other.
const LONGEST_CHAIN: usize = 8;

/// Open documents, and the files that they name.
#[derive(Clone)]
pub struct Workspace<'l> {
    pub(crate) language: &'l Language,
    schemas: Arc<Schemas>,
    source: SharedSource,
    open: BTreeMap<PathBuf, Arc<str>>,
    known: BTreeSet<PathBuf>,
}

/// A document with its outline.
pub(crate) struct Document {
    pub path: PathBuf,
    pub text: Arc<str>,
    pub lines: Lines,
    pub outline: Node,
    pub kind: DocumentKind,
}

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Site {
    pub path: PathBuf,
    pub span: std::ops::Range<usize>,
}

/// Unsaved texts over a source.
#[derive(Debug)]
struct Overlay {
    source: SharedSource,
    open: BTreeMap<PathBuf, Arc<str>>,
}

impl FileSource for Overlay {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        match self.open.get(&without_dots(path)) {
            Some(text) if text.len() as u64 <= longest => Ok(text.as_bytes().to_vec()),
            Some(_) => Err(io::Error::other(format!("it has more than {} MB", longest >> 20))),
            None => self.source.read(path, longest),
        }
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<String>> {
        self.source.list(folder)
    }
}

/// The gearboxes of a study: name and file.
pub(crate) fn gearboxes(study: &Document) -> Vec<(String, PathBuf)> {
    let entries = study.outline.get("gearboxes").map(Node::entries).unwrap_or_default();
    let file = |entry: &crate::outline::Entry| {
        let file = entry.value.text()?;
        Some((entry.key.clone(), named(&study.path, file)))
    };
    entries.iter().filter_map(file).collect()
}

/// The path of a file that a document names.
pub(crate) fn named(document: &Path, file: &str) -> PathBuf {
    without_dots(&document.parent().unwrap_or(Path::new("")).join(file))
}

impl<'l> Workspace<'l> {
    /// Without open documents, over the files of a source.
    pub fn new(language: &'l Language, source: SharedSource) -> Self {
        Self {
            language,
            schemas: Arc::default(),
            source,
            open: BTreeMap::new(),
            known: BTreeSet::new(),
        }
    }

    /// Opens a document, or replaces its text.
    pub fn open(&mut self, path: impl AsRef<Path>, text: impl Into<Arc<str>>) {
        self.open.insert(without_dots(path.as_ref()), text.into());
    }

    /// Closes a document: from now on it is the file of the source.
    pub fn close(&mut self, path: impl AsRef<Path>) {
        self.open.remove(&without_dots(path.as_ref()));
    }

    /// A file of the folder that is not open: documents among them are searched for uses of an id, and all are suggested as files.
    pub fn know(&mut self, path: impl AsRef<Path>) {
        self.known.insert(without_dots(path.as_ref()));
    }

    /// True unless a text has keys, but not that of a gearbox or study: an editor may open any YAML file.
    pub fn is_document(&self, path: impl AsRef<Path>) -> bool {
        let document = self.document(path.as_ref());
        document.is_some_and(|document| {
            let keys = document.outline.entries();
            !keys.iter().any(|entry| entry.colon) || document.outline.get("gearloss").is_some()
        })
    }

    /// True if a text states with the key `gearloss` that it is a document.
    pub fn states_kind(&self, path: impl AsRef<Path>) -> bool {
        let document = self.document(path.as_ref());
        document.is_some_and(|document| document.outline.get("gearloss").is_some())
    }

    /// Paths of the open documents.
    pub fn opened(&self) -> impl Iterator<Item = &Path> {
        self.open.keys().map(PathBuf::as_path)
    }

    /// The text of an open document.
    pub fn text(&self, path: impl AsRef<Path>) -> Option<&Arc<str>> {
        self.open.get(&without_dots(path.as_ref()))
    }

    /// The files with the unsaved texts over them.
    pub fn files(&self) -> SharedSource {
        Arc::new(Overlay {
            source: Arc::clone(&self.source),
            open: self.open.clone(),
        })
    }

    pub(crate) fn root(&self, kind: DocumentKind, document: Option<&Node>) -> Place<'_> {
        Place::root(self.schemas.of(self.language, kind), document)
    }

    pub(crate) fn document(&self, path: &Path) -> Option<Document> {
        let path = without_dots(path);
        let text: Arc<str> = match self.open.get(&path) {
            Some(text) => Arc::clone(text),
            None => self.source.read_text(&path, LONGEST_TEXT).ok()?.into(),
        };
        let outline = read(&text, None);
        let stated = outline.get("gearloss").and_then(Node::text);
        Some(Document {
            lines: Lines::new(&text),
            kind: DocumentKind::of(stated, |key| outline.get(key).is_some()),
            path,
            text,
            outline,
        })
    }

    /// Open documents and known ones, except data files.
    pub(crate) fn documents(&self) -> Vec<PathBuf> {
        let is_document = |path: &&PathBuf| {
            let extension = path.extension().and_then(|extension| extension.to_str());
            matches!(extension, Some("yaml" | "yml"))
        };
        let all: BTreeSet<&PathBuf> = self.open.keys().chain(self.known.iter().filter(is_document)).collect();
        all.into_iter().cloned().collect()
    }

    pub(crate) fn known_files(&self) -> impl Iterator<Item = &PathBuf> {
        self.known.iter()
    }

    pub(crate) fn occurrences(&self, document: &Document) -> Vec<Occurrence> {
        let gearbox = self.root(DocumentKind::Gearbox, None);
        let root = self.root(document.kind, Some(&document.outline));
        occurrences(&document.outline, document.kind, root, &gearbox)
    }

    /// A gearbox and those that it extends, the nearest first.
    pub(crate) fn chain(&self, path: &Path) -> Vec<Document> {
        let mut chain: Vec<Document> = Vec::new();
        let mut next = Some(without_dots(path));
        while let Some(path) = next.take() {
            if chain.len() >= LONGEST_CHAIN || chain.iter().any(|known| known.path == path) {
                break;
            }
            let Some(document) = self.document(&path) else { break };
            let base = document.outline.get("extends").and_then(Node::text);
            next = base.map(|base| named(&path, base));
            chain.push(document);
        }
        chain
    }

    /// Documents in which an id of a document may be defined, each list one gearbox with those that it extends. For a study, it itself
    /// comes first, then its gearboxes, only those of `owners` if any are stated.
    pub(crate) fn scopes(&self, document: &Document, owners: &[String]) -> Vec<Vec<Document>> {
        match document.kind {
            DocumentKind::Gearbox => vec![self.chain(&document.path)],
            DocumentKind::Study => {
                let mut scopes = vec![self.document(&document.path).into_iter().collect()];
                for (name, path) in gearboxes(document) {
                    if owners.is_empty() || owners.contains(&name) {
                        scopes.push(self.chain(&path));
                    }
                }
                scopes
            }
        }
    }

    /// Where an id of one of the sections is defined, as seen from a document.
    pub(crate) fn definitions(&self, document: &Document, occurrence: &Occurrence) -> Vec<(String, Site)> {
        let Name::Id { sections, id } = &occurrence.name else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for scope in self.scopes(document, &occurrence.gearboxes) {
            for document in scope {
                for section in sections {
                    let place = definition(&document.outline, section, id).or_else(|| {
                        let defined = |other: &Occurrence| {
                            other.defines && matches!(&other.name, Name::Id { sections, id: known } if sections.contains(section) && known == id)
                        };
                        // Sets that analyses define.
                        (section == "model_sets" && document.kind == DocumentKind::Study)
                            .then(|| self.occurrences(&document).into_iter().find(defined))
                            .flatten()
                            .map(|other| other.span)
                    });
                    if let Some(span) = place {
                        let site = Site {
                            path: document.path.clone(),
                            span,
                        };
                        if found.iter().all(|(_, other)| *other != site) {
                            found.push((section.clone(), site));
                        }
                    }
                }
            }
        }
        found
    }
}

/// The value at a path of keys.
pub(crate) fn section<'n>(document: &'n Node, path: &str) -> Option<&'n Node> {
    path.split('.').try_fold(document, |node, key| node.get(key))
}

fn definition(document: &Node, path: &str, id: &str) -> Option<std::ops::Range<usize>> {
    let entries = section(document, path)?.entries();
    let entry = entries.iter().find(|entry| entry.key == id && entry.colon)?;
    let quotes = usize::from(entry.span.len() == id.len() + 2);
    Some(entry.span.start + quotes..entry.span.end - quotes)
}
