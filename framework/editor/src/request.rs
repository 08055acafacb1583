//! Requests and answers as data, for a page or another program: each is one JSON value.

use std::path::{Path, PathBuf};

use gearloss_studies::engine::progress::Progress;
use serde::{Deserialize, Serialize};

use crate::complete::Completion;
use crate::findings::{FileRange, Finding};
use crate::hover::Hover;
use crate::navigate::{FileEdits, NoRename};
use crate::symbols::Symbol;
use crate::workspace::Workspace;

/// A request, such as `{"request": "completion", "file": "gearbox.yaml", "offset": 120}`. Offsets count bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "request", rename_all = "snake_case")]
pub enum Request {
    /// Opens a document, or replaces its text.
    Open {
        /// File.
        file: PathBuf,
        /// Text.
        text: String,
    },
    /// Closes a document.
    Close {
        /// File.
        file: PathBuf,
    },
    /// Findings of `check`.
    Findings {
        /// File.
        file: PathBuf,
    },
    /// Suggestions.
    Completion {
        /// File.
        file: PathBuf,
        /// Byte.
        offset: usize,
    },
    /// Explanation.
    Hover {
        /// File.
        file: PathBuf,
        /// Byte.
        offset: usize,
    },
    /// Definitions.
    Definition {
        /// File.
        file: PathBuf,
        /// Byte.
        offset: usize,
    },
    /// Definitions and uses.
    References {
        /// File.
        file: PathBuf,
        /// Byte.
        offset: usize,
    },
    /// Edits that rename an id.
    Rename {
        /// File.
        file: PathBuf,
        /// Byte.
        offset: usize,
        /// New name.
        name: String,
    },
    /// Sections and ids.
    Symbols {
        /// File.
        file: PathBuf,
    },
}

impl Request {
    /// The file that it is about.
    pub fn file(&self) -> &Path {
        match self {
            Self::Open { file, .. }
            | Self::Close { file }
            | Self::Findings { file }
            | Self::Completion { file, .. }
            | Self::Hover { file, .. }
            | Self::Definition { file, .. }
            | Self::References { file, .. }
            | Self::Rename { file, .. }
            | Self::Symbols { file } => file,
        }
    }
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "answer", content = "value", rename_all = "snake_case")]
pub enum Answer {
    /// The document is open or closed.
    Done,
    /// The caller interrupted the request.
    Interrupted,
    /// Findings.
    Findings(Vec<Finding>),
    /// Suggestions.
    Completion(Vec<Completion>),
    /// Explanation.
    Hover(Option<Hover>),
    /// Places.
    Places(Vec<FileRange>),
    /// Edits.
    Edits(Vec<FileEdits>),
    /// The id cannot be renamed.
    NoRename(NoRename),
    /// Sections and ids.
    Symbols(Vec<Symbol>),
}

impl Workspace<'_> {
    /// Answers a request. The caller can interrupt findings.
    pub fn answer(&mut self, request: &Request, progress: &dyn Progress) -> Answer {
        match request {
            Request::Open { file, text } => {
                self.open(file, text.as_str());
                Answer::Done
            }
            Request::Close { file } => {
                self.close(file);
                Answer::Done
            }
            Request::Findings { file } => self
                .findings(file, progress)
                .map_or(Answer::Interrupted, Answer::Findings),
            Request::Completion { file, offset } => Answer::Completion(self.completion(file, *offset)),
            Request::Hover { file, offset } => Answer::Hover(self.hover(file, *offset)),
            Request::Definition { file, offset } => Answer::Places(self.definition(file, *offset)),
            Request::References { file, offset } => Answer::Places(self.references(file, *offset)),
            Request::Rename { file, offset, name } => match self.rename(file, *offset, name) {
                Ok(edits) => Answer::Edits(edits),
                Err(refused) => Answer::NoRename(refused),
            },
            Request::Symbols { file } => Answer::Symbols(self.symbols(file)),
        }
    }
}
