//! Definitions and references of names, and renaming of ids.

use std::path::{Path, PathBuf};

use gearloss_framework::gearbox::DocumentKind;
use serde::Serialize;

use crate::findings::FileRange;
use crate::ids::{Name, Occurrence};
use crate::outline::Node;
use crate::workspace::{Document, Site, Workspace, gearboxes, named, section};

/// Replaced ranges of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FileEdits {
    /// File.
    pub file: String,
    /// Ranges, in the order of the text.
    pub edits: Vec<Edit>,
}

/// A replaced range.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Edit {
    /// Range.
    pub range: crate::text::TextRange,
    /// New text.
    pub insert: String,
}

/// Why an id cannot be renamed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize)]
#[error("{message}; {help}")]
pub struct NoRename {
    /// What prevents it.
    pub message: String,
    /// What to do.
    pub help: String,
}

/// An id with the documents that know it.
struct Symbol {
    sections: Vec<String>,
    id: String,
    /// Documents with its definitions: one study, or gearboxes that extend each other.
    family: Vec<PathBuf>,
    /// True for an id of a gearbox, which studies may use.
    of_gearbox: bool,
}

impl Workspace<'_> {
    /// Where a gearbox, or a file that it extends, describes a component: its key.
    pub fn place_of(&self, gearbox: impl AsRef<Path>, component: &str) -> Option<FileRange> {
        self.chain(gearbox.as_ref()).into_iter().find_map(|document| {
            let (section, id) = component.rsplit_once('.')?;
            let entries = self::section(&document.outline, section)?.entries();
            let entry = entries.iter().find(|entry| entry.key == id)?;
            Some(FileRange {
                file: document.path.display().to_string(),
                range: document.lines.range(&document.text, &entry.span),
            })
        })
    }
    /// The name at a byte.
    fn name_at(&self, document: &Document, offset: usize) -> Option<Occurrence> {
        let all = self.occurrences(document).into_iter();
        let touching = all.filter(|occurrence| occurrence.span.start <= offset && offset <= occurrence.span.end);
        // The shortest: an id within a path.
        touching.min_by_key(|occurrence| occurrence.span.len())
    }

    /// Where the name at a byte is defined; a file is its first character.
    pub fn definition(&self, path: &Path, offset: usize) -> Vec<FileRange> {
        let Some(document) = self.document(path) else {
            return Vec::new();
        };
        let Some(name) = self.name_at(&document, offset) else {
            return Vec::new();
        };
        if let Name::File(file) = &name.name {
            let site = Site {
                path: named(&document.path, file),
                span: 0..0,
            };
            // A file that is no text, or does not exist, has no place to go to.
            return self.range(&site).into_iter().collect();
        }
        let definitions = self.definitions(&document, &name);
        definitions.iter().filter_map(|(_, site)| self.range(site)).collect()
    }

    /// All places that name what is at a byte, with its definitions, in this and in all known documents.
    pub fn references(&self, path: &Path, offset: usize) -> Vec<FileRange> {
        let found = self.document(path).and_then(|document| {
            let symbol = self.symbol(&document, offset)?;
            Some(self.sites(&symbol))
        });
        let sites = found.unwrap_or_default();
        sites.iter().filter_map(|(site, _)| self.range(site)).collect()
    }

    /// The range of the id at a byte that can be renamed.
    pub fn renamable(&self, path: &Path, offset: usize) -> Option<FileRange> {
        let document = self.document(path)?;
        self.symbol(&document, offset)?;
        let name = self.name_at(&document, offset)?;
        self.range(&Site {
            path: document.path.clone(),
            span: name.span,
        })
    }

    /// The edits that rename the id at a byte, in this and in all known documents. Data files are not changed.
    ///
    /// # Errors
    /// If there is no id, if the new name is not valid or is taken, or if a study uses the id for other gearboxes, too.
    pub fn rename(&self, path: &Path, offset: usize, new: &str) -> Result<Vec<FileEdits>, NoRename> {
        let refuse = |message: String, help: &str| NoRename {
            message,
            help: help.to_owned(),
        };
        let document = self.document(path);
        let symbol = document.as_ref().and_then(|document| self.symbol(document, offset));
        let Some(symbol) = symbol else {
            return Err(refuse(
                "there is no id here that the documents define".to_owned(),
                "place the cursor on an id, such as that of a shaft",
            ));
        };
        let digits = symbol.sections.iter().any(|name| self.digits_first(name));
        if !is_id(new, digits) {
            return Err(refuse(
                format!("`{new}` is not a valid id"),
                "start with a letter, followed by letters, digits and _; words such as `on` and `no` are booleans in YAML",
            ));
        }
        if new != symbol.id {
            for path in &symbol.family {
                let Some(opened) = self.document(path) else { continue };
                if let Some(name) = symbol.sections.iter().find(|name| has_id(&opened.outline, name, new)) {
                    return Err(refuse(
                        format!("`{name}` of {} already has an id `{new}`", path.display()),
                        "choose another name",
                    ));
                }
            }
        }
        let mut edits: Vec<FileEdits> = Vec::new();
        for (site, shared) in self.sites(&symbol) {
            let Some(place) = self.range(&site) else { continue };
            if shared {
                return Err(refuse(
                    format!(
                        "{}, line {}, uses `{}` for several gearboxes",
                        place.file,
                        place.range.start.line + 1,
                        symbol.id
                    ),
                    "state `gearbox` there, or rename it by hand in all of them",
                ));
            }
            let edit = Edit {
                range: place.range,
                insert: new.to_owned(),
            };
            match edits.iter_mut().find(|edits_of_file| edits_of_file.file == place.file) {
                Some(edits_of_file) => edits_of_file.edits.push(edit),
                None => edits.push(FileEdits {
                    file: place.file,
                    edits: vec![edit],
                }),
            }
        }
        for edits_of_file in &mut edits {
            edits_of_file.edits.sort_by_key(|edit| edit.range.from);
            edits_of_file.edits.dedup();
        }
        Ok(edits)
    }

    fn digits_first(&self, name: &str) -> bool {
        let place = self.root(DocumentKind::Gearbox, None).along(name);
        place.is_some_and(|place| place.digits_first())
    }

    fn range(&self, site: &Site) -> Option<FileRange> {
        let document = self.document(&site.path)?;
        Some(FileRange {
            file: site.path.to_string_lossy().into_owned(),
            range: document.lines.range(&document.text, &site.span),
        })
    }

    /// The id at a byte, if a document defines it.
    fn symbol(&self, document: &Document, offset: usize) -> Option<Symbol> {
        let name = self.name_at(document, offset)?;
        let Name::Id { id, .. } = &name.name else {
            return None;
        };
        let definitions = self.definitions(document, &name);
        let (_, first) = definitions.first()?;
        let home = self.document(&first.path)?;
        let mut sections: Vec<String> = Vec::new();
        for (section, site) in &definitions {
            if (site.path == home.path || home.kind == DocumentKind::Gearbox) && !sections.contains(section) {
                sections.push(section.clone());
            }
        }
        // Only sections of ids that something may refer to: the keys of other maps are names of quantities.
        let root = self.root(home.kind, None);
        sections.retain(|section| section != "catalogues" && root.along(section).is_some_and(|place| place.has_ids()));
        if sections.is_empty()
            || sections
                .iter()
                .any(|section| section.contains('.') && !section.starts_with("thermal."))
        {
            return None;
        }
        let of_gearbox = home.kind == DocumentKind::Gearbox;
        let family = if of_gearbox {
            self.family(&home.path)
        } else {
            vec![home.path]
        };
        Some(Symbol {
            sections,
            id: id.clone(),
            family,
            of_gearbox,
        })
    }

    /// Gearboxes that extend each other, directly or through others, among the known documents.
    fn family(&self, path: &Path) -> Vec<PathBuf> {
        let mut chains: Vec<Vec<PathBuf>> = vec![paths(&self.chain(path))];
        for other in self.documents() {
            let is_gearbox = self
                .document(&other)
                .is_some_and(|opened| opened.kind == DocumentKind::Gearbox);
            if is_gearbox {
                chains.push(paths(&self.chain(&other)));
            }
        }
        let mut family = chains[0].clone();
        loop {
            let before = family.len();
            for chain in &chains {
                if chain.iter().any(|path| family.contains(path)) {
                    for path in chain {
                        if !family.contains(path) {
                            family.push(path.clone());
                        }
                    }
                }
            }
            if family.len() == before {
                return family;
            }
        }
    }

    /// Places of an id, each with whether it also names an id of an unrelated gearbox.
    fn sites(&self, symbol: &Symbol) -> Vec<(Site, bool)> {
        let mut found = Vec::new();
        for path in &symbol.family {
            if let Some(document) = self.document(path) {
                let here = self
                    .occurrences(&document)
                    .into_iter()
                    .filter(|occurrence| names(occurrence, symbol));
                found.extend(here.map(|occurrence| (site(&document, occurrence), false)));
            }
        }
        if !symbol.of_gearbox {
            return found;
        }
        for path in self.documents() {
            let Some(study) = self.document(&path).filter(|opened| opened.kind == DocumentKind::Study) else {
                continue;
            };
            let listed = gearboxes(&study);
            let (of_family, others): (Vec<_>, Vec<_>) = listed.iter().partition(|(_, file)| {
                self.chain(file)
                    .iter()
                    .any(|opened| symbol.family.contains(&opened.path))
            });
            if of_family.is_empty() {
                continue;
            }
            for occurrence in self
                .occurrences(&study)
                .into_iter()
                .filter(|occurrence| names(occurrence, symbol) && !occurrence.defines)
            {
                // An id of the study itself has precedence: a model set of the same name.
                if symbol
                    .sections
                    .iter()
                    .any(|name| has_id(&study.outline, name, &symbol.id))
                {
                    continue;
                }
                let stated = |name: &String| occurrence.gearboxes.is_empty() || occurrence.gearboxes.contains(name);
                if !of_family.iter().any(|(name, _)| stated(name)) {
                    continue;
                }
                let shared = others.iter().any(|(name, file)| {
                    let defines = |opened: &Document| {
                        symbol
                            .sections
                            .iter()
                            .any(|name| has_id(&opened.outline, name, &symbol.id))
                    };
                    stated(name) && self.chain(file).iter().any(defines)
                });
                found.push((site(&study, occurrence), shared));
            }
        }
        found
    }
}

fn paths(chain: &[Document]) -> Vec<PathBuf> {
    chain.iter().map(|opened| opened.path.clone()).collect()
}

fn site(document: &Document, occurrence: Occurrence) -> Site {
    Site {
        path: document.path.clone(),
        span: occurrence.span,
    }
}

fn names(occurrence: &Occurrence, symbol: &Symbol) -> bool {
    match &occurrence.name {
        Name::Id { sections, id } => *id == symbol.id && sections.iter().any(|name| symbol.sections.contains(name)),
        _ => false,
    }
}

fn has_id(document: &Node, name: &str, id: &str) -> bool {
    section(document, name).is_some_and(|section| section.get(id).is_some())
}

/// As the walk over a document decides.
fn is_id(text: &str, digits_first: bool) -> bool {
    let mut letters = text.chars();
    let first = letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || (digits_first && c.is_ascii_digit()));
    let trap = ["y", "n", "yes", "no", "on", "off", "true", "false", "null"];
    first
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !trap.contains(&text.to_ascii_lowercase().as_str())
}
