//! From a file to a transmission: read, check, resolve, build; findings with their positions.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

use crate::codes;
use crate::document::{Diagnostic, Node, PlacedDiagnostic, Places, Severity, Sources, Span, read_yaml};
use crate::evaluate::Ratings;
use crate::files::{Disk, LONGEST_TEXT, SharedSource};
use crate::language::{DRAGS, HEAT, Language};
use crate::registry::{Files, Memory, Registry};
use crate::resolve::{Choice, Resolved, ValueSource, called_own, expand_set, meets, resolve, sets_of};
use crate::transmission::Transmission;

/// Maximum number of files that may extend each other.
const LONGEST_CHAIN: usize = 8;

/// Maximum number of findings that are printed.
const MOST_SHOWN: usize = 100;

/// A gearbox after reading and checking. Resolving and building are repeated for every choice of models and overrides.
#[derive(Clone)]
pub struct Gearbox {
    /// The checked description, SI.
    pub value: Arc<Value>,
    /// Positions of all values.
    pub places: Arc<Places>,
    /// The source texts.
    pub sources: Sources,
    /// Files named by the description.
    pub files: Files,
}

/// Findings with the source texts that they refer to.
#[derive(thiserror::Error)]
#[error("{}", self.render())]
pub struct Findings {
    /// The findings.
    pub list: Vec<Diagnostic>,
    /// The source texts.
    pub sources: Sources,
}

impl Findings {
    /// The findings with file, line and column.
    pub fn placed(&self) -> impl Iterator<Item = PlacedDiagnostic> + '_ {
        self.list.iter().map(|finding| self.sources.placed(finding))
    }

    /// The message of the first finding, for places that take only one sentence.
    pub fn first(&self) -> String {
        self.list.first().map_or_else(String::new, |d| d.message.clone())
    }

    /// All findings rendered, followed by their number.
    pub fn render(&self) -> String {
        self.render_new(&mut BTreeSet::new())
    }

    /// As [`Findings::render`], without the findings of files before this one, which are in `shown`: several files may extend the faulty
    /// one. A finding that two stages made is one.
    pub fn render_new(&self, shown: &mut BTreeSet<String>) -> String {
        let mut text = String::new();
        let (mut errors, mut again, mut listed) = (0, 0, 0);
        let mut keys = BTreeSet::new();
        for finding in &self.list {
            let key = self.key(finding);
            if !keys.insert(key.clone()) {
                continue;
            }
            errors += usize::from(finding.severity == Severity::Error);
            // Without a place, two files may have errors of the same words.
            if !finding.spans.is_empty() && !shown.insert(key) {
                again += 1;
                continue;
            }
            listed += 1;
            if listed <= MOST_SHOWN {
                text.push_str(&self.sources.render(finding));
                text.push_str("\n\n");
            }
        }
        if listed > MOST_SHOWN {
            text.push_str(&format!("... and {} more\n", listed - MOST_SHOWN));
        }
        let plural = if errors == 1 { "" } else { "s" };
        text.push_str(&format!("{errors} error{plural}"));
        if again > 0 {
            text.push_str(&format!(
                ", {again} of them printed above: they are in a file that was read before"
            ));
        }
        text.push('\n');
        text
    }

    /// What makes two findings the same: words and place.
    fn key(&self, finding: &Diagnostic) -> String {
        let place = finding.spans.first().map(|(span, _)| {
            let file = self.sources.get(span.source).map(|(name, _)| name);
            (file, span.start, span.end)
        });
        format!("{place:?} {} {:?}", finding.title(), finding.help)
    }
}

/// As rendered, because a `main` that returns an error prints its debug form.
impl std::fmt::Debug for Findings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render())
    }
}

/// As a list of [`PlacedDiagnostic`].
impl Serialize for Findings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.placed())
    }
}

/// Findings without a source text.
impl From<Vec<Diagnostic>> for Findings {
    fn from(list: Vec<Diagnostic>) -> Self {
        Self {
            list,
            sources: Sources::default(),
        }
    }
}

impl From<Diagnostic> for Findings {
    fn from(one: Diagnostic) -> Self {
        Self::from(vec![one])
    }
}

impl Language {
    /// The language of all linked crates; the starting point of reading.
    ///
    /// # Errors
    /// All faults of the linked mechanisms, models, catalogues and sets.
    pub fn linked() -> Result<Self, Findings> {
        Ok(Self::new(Registry::linked()?)?)
    }
}

impl Gearbox {
    /// Reads a gearbox file of the disk and the files that it extends.
    ///
    /// # Errors
    /// All findings of reading and checking.
    pub fn read(language: &Language, file: &Path) -> Result<Self, Findings> {
        Self::read_from(language, &Disk::shared(), file)
    }

    /// Reads a gearbox file of a source and the files that it extends. Data that the description names are read from the same source.
    ///
    /// # Errors
    /// All findings of reading and checking.
    pub fn read_from(language: &Language, source: &SharedSource, file: &Path) -> Result<Self, Findings> {
        let text = source.read_text(file, LONGEST_TEXT).map_err(|e| {
            Diagnostic::error("", format!("cannot read {}: {e}", file.display()))
                .help("check the file name")
                .code(crate::document::codes::UNREADABLE)
        })?;
        let folder = file.parent().unwrap_or(Path::new(""));
        Self::from_text(language, source, &text, &file.display().to_string(), folder)
    }

    /// Reads a gearbox from a text; `folder` on the disk contains the files that it names.
    ///
    /// # Errors
    /// All findings of reading and checking.
    pub fn of_text(language: &Language, text: &str, name: &str, folder: impl Into<PathBuf>) -> Result<Self, Findings> {
        Self::from_text(language, &Disk::shared(), text, name, folder)
    }

    /// Reads a gearbox from a text; the files that it names are read from a source, relative to `folder`.
    ///
    /// # Errors
    /// All findings of reading and checking.
    pub fn from_text(
        language: &Language,
        source: &SharedSource,
        text: &str,
        name: &str,
        folder: impl Into<PathBuf>,
    ) -> Result<Self, Findings> {
        let (mut sources, mut found, folder) = (Sources::default(), Vec::new(), folder.into());
        let mut chain = Chain {
            source,
            sources: &mut sources,
            found: &mut found,
            seen: Vec::new(),
        };
        let node = chain.read(text, name, &folder, None);
        let node = match node {
            Some(node) if found.is_empty() => node,
            _ => return Err(Findings { list: found, sources }),
        };
        let walked = language.walk_gearbox(&node);
        if !walked.findings.is_empty() {
            return Err(Findings {
                list: walked.findings,
                sources,
            });
        }
        Ok(Self {
            value: Arc::new(walked.value),
            places: Arc::new(walked.places),
            sources,
            files: Files::from_source(Arc::clone(source), folder),
        })
    }

    /// Resolves the description with a choice of models and overrides.
    ///
    /// # Errors
    /// All findings of resolving, with positions.
    pub fn resolve(&self, language: &Language, choice: &Choice) -> Result<Resolved, Findings> {
        resolve(language, &self.files, &self.value, choice)
            .map_err(|list| self.faults_of_choice(language, choice, list))
    }

    /// Findings of resolving with a choice, with positions.
    pub(crate) fn faults_of_choice(&self, language: &Language, choice: &Choice, list: Vec<Diagnostic>) -> Findings {
        self.findings(
            list.into_iter()
                .map(|d| self.in_own_set(language, choice, d).code(codes::CHOICE))
                .collect(),
        )
    }

    /// Reads every model set of the document, also the unused ones.
    ///
    /// # Errors
    /// If a set extends one that does not exist, or itself.
    pub fn check_sets(&self, language: &Language) -> Result<(), Findings> {
        let sets = sets_of(language, &self.value, &Map::new());
        let written = self.value.get("model_sets").and_then(Value::as_object);
        let names = written.into_iter().flatten().map(|(name, _)| name);
        let mut found: Vec<Diagnostic> = Vec::new();
        found.extend(called_own(names.clone()));
        for error in names.filter_map(|name| expand_set(&sets, name).err()) {
            if found.iter().all(|other| other.path != error.path) {
                found.push(error.code(codes::CHOICE));
            }
        }
        if found.is_empty() {
            Ok(())
        } else {
            Err(self.findings(found))
        }
    }

    /// Moves a finding about a path to the model set or `set` that changes it.
    fn in_own_set(&self, language: &Language, choice: &Choice, finding: Diagnostic) -> Diagnostic {
        let set = choice.set.as_ref().and_then(|name| {
            let sets = sets_of(language, &self.value, &choice.sets);
            expand_set(&sets, name).ok()
        });
        let of_set = set.and_then(|set| {
            set.changes
                .into_iter()
                .rev()
                .find(|(path, ..)| meets(path, &finding.path))
        });
        if let Some((path, _, name)) = of_set {
            return finding.moved(&format!("model_sets.{name}.set"), &path);
        }
        let changes = self.value.get("set").and_then(Value::as_object);
        let change = changes
            .into_iter()
            .flatten()
            .filter(|(path, _)| meets(path, &finding.path))
            .max_by_key(|(path, _)| path.split('.').count());
        match change {
            Some((path, _)) => finding.moved("set", path),
            None => finding,
        }
    }

    /// Builds the transmission of a resolved description.
    ///
    /// # Errors
    /// All findings of building, with positions.
    pub fn build(&self, language: &Language, resolved: &Resolved) -> Result<Transmission, Findings> {
        let (built, _) = self.build_again(language, resolved, Memory::default())?;
        Ok(built)
    }

    /// Builds the ratings of a resolved description, for the points of its transmission.
    ///
    /// # Errors
    /// All findings of building them, with positions.
    pub fn ratings(
        &self,
        language: &Language,
        resolved: &Resolved,
        transmission: &Transmission,
    ) -> Result<Ratings, Findings> {
        Ratings::new(language, &self.files, resolved, transmission).map_err(|list| self.findings(list))
    }

    /// As [`Gearbox::build`], after another build of the description.
    ///
    /// # Errors
    /// As [`Gearbox::build`]; the memory is then lost.
    pub(crate) fn build_again(
        &self,
        language: &Language,
        resolved: &Resolved,
        memory: Memory,
    ) -> Result<(Transmission, Memory), Findings> {
        let (mut built, memory) = Transmission::again(language, &self.files, resolved, memory).map_err(|list| {
            self.findings(
                list.into_iter()
                    .map(|d| self.inherited(language, resolved, d).code(codes::GEARBOX))
                    .collect(),
            )
        })?;
        built.warnings = built
            .warnings
            .into_iter()
            .map(|d| self.places.place(d).code(codes::PLAUSIBILITY))
            .collect();
        Ok((built, memory))
    }

    /// For a model that a component takes from `models`, a finding also shows where it is written.
    fn inherited(&self, language: &Language, resolved: &Resolved, finding: Diagnostic) -> Diagnostic {
        if *resolved.source_of(&finding.path) != ValueSource::Models {
            return finding;
        }
        let mut keys = finding.path.split('.');
        let section = keys.next().unwrap_or_default();
        let written = match (section, keys.nth(1), keys.next()) {
            (_, Some("drag"), Some(slot)) => format!("models.{DRAGS}.{slot}"),
            ("thermal", Some(slot), None) => format!("models.{HEAT}.{slot}"),
            _ => match language.sections().find(|(name, _)| *name == section) {
                Some((_, key)) => format!("models.{key}"),
                None => return finding,
            },
        };
        match (self.places.locate(&finding.path), self.places.get(&written)) {
            (Some(component), Some(model)) => finding
                .at_span(component)
                .label(model.value, "the model comes from here"),
            _ => finding,
        }
    }

    /// Resolves and builds.
    ///
    /// # Errors
    /// All findings of both.
    pub fn transmission(&self, language: &Language, choice: &Choice) -> Result<Transmission, Findings> {
        self.build(language, &self.resolve(language, choice)?)
    }

    /// Findings with the positions of their paths.
    pub fn findings(&self, list: Vec<Diagnostic>) -> Findings {
        Findings {
            list: list.into_iter().map(|d| self.places.place(d)).collect(),
            sources: self.sources.clone(),
        }
    }
}

/// Kind of a document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DocumentKind {
    /// The description of a gearbox.
    Gearbox,
    /// Analyses of gearboxes.
    Study,
}

/// The first two keys of a study, which a gearbox does not have.
const OF_STUDY: [&str; 2] = ["gearboxes", "analyses"];

impl DocumentKind {
    /// The kind that `gearloss:` states, otherwise that of the top-level keys.
    pub fn of(stated: Option<&str>, has: impl Fn(&str) -> bool) -> Self {
        let is_study = match stated {
            Some(text) if text.starts_with("study") => true,
            Some(text) if text.starts_with("gearbox") => false,
            _ => OF_STUDY.iter().any(|key| has(key)),
        };
        if is_study { Self::Study } else { Self::Gearbox }
    }
}

/// The finding for a document of the wrong kind.
pub fn other_kind(node: &Node, wanted: DocumentKind, name: &str) -> Option<Diagnostic> {
    let key = node.get("gearloss")?;
    let written = key.text()?;
    let has = |keys: [&str; 2]| keys.iter().any(|key| node.get(key).is_some());
    let (message, help) = match wanted {
        DocumentKind::Study if written.starts_with("study") && has(["ports", "shafts"]) => (
            "the first key marks a study, but the other keys are those of a gearbox",
            "write `gearloss: gearbox/1`".to_owned(),
        ),
        DocumentKind::Gearbox if written.starts_with("gearbox") && has(OF_STUDY) => (
            "the first key marks a gearbox, but the other keys are those of a study",
            "write `gearloss: study/1`".to_owned(),
        ),
        DocumentKind::Study if written.starts_with("gearbox") => (
            "this is a gearbox file; a study file is required",
            format!(
                "`gearloss new study --gearbox {name}` writes a study of it; `check`, `solve` and `explain` accept the gearbox file itself"
            ),
        ),
        DocumentKind::Gearbox if written.starts_with("study") => (
            "this is a study file; a gearbox file is required",
            "name a gearbox file, such as one under `gearboxes` of the study; `check` and `run` accept the study"
                .to_owned(),
        ),
        _ => return None,
    };
    Some(
        Diagnostic::error("gearloss", message)
            .at_span(key.span)
            .help(help)
            .code(codes::OTHER_DOCUMENT),
    )
}

/// Documents that extend each other.
struct Chain<'a> {
    source: &'a SharedSource,
    sources: &'a mut Sources,
    found: &'a mut Vec<Diagnostic>,
    seen: Vec<PathBuf>,
}

impl Chain<'_> {
    /// A document merged over the one that it extends; `from` is where another one names it.
    fn read(&mut self, text: &str, name: &str, folder: &Path, from: Option<Span>) -> Option<Node> {
        let read = read_yaml(self.sources.add(name, text), text);
        if !read.findings.is_empty() {
            self.found.extend(read.findings);
            return None;
        }
        if let Some(error) = other_kind(&read.node, DocumentKind::Gearbox, name) {
            self.found.push(match from {
                Some(span) => {
                    Diagnostic::error("extends", format!("{name} is a study; only a gearbox can be extended"))
                        .at_span(span)
                        .help("name a gearbox file, such as one under `gearboxes` of that study")
                        .code(codes::EXTENDS)
                }
                None => error,
            });
            return None;
        }
        let Some(base) = read.node.get("extends").and_then(Node::text) else {
            return Some(read.node);
        };
        let span = read.node.get("extends").map(|n| n.span);
        let error = |message: String| {
            let error = Diagnostic::error("extends", message).help("name a gearbox file, relative to this one");
            if let Some(span) = span {
                error.at_span(span)
            } else {
                error
            }
        };
        let file = folder.join(base);
        if self.seen.contains(&file) || self.seen.len() >= LONGEST_CHAIN {
            let circular = error("circular `extends`, or too many files".to_owned());
            self.found.push(circular.code(codes::EXTENDS));
            return None;
        }
        self.seen.push(file.clone());
        match self.source.read_text(&file, LONGEST_TEXT) {
            Err(e) => {
                let message = format!("cannot read {}: {e}", file.display());
                self.found.push(error(message).code(crate::document::codes::UNREADABLE));
                None
            }
            Ok(text) => {
                let inner = file.parent().unwrap_or(Path::new(""));
                let base = self.read(&text, &file.display().to_string(), inner, span)?;
                Some(read.node.merged_over(base))
            }
        }
    }
}
