//! Where the files of a session are.

use std::fmt::Debug;
use std::path::{Component, Path};
use std::sync::{Mutex, PoisonError};

use gearloss_editor::outline;
use gearloss_framework::files::{InMemory, SharedSource};
use gearloss_studies::analyses::head::{fnv1a_64, hexadecimal};
use serde::Serialize;

use crate::answer::Fault;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FileKind {
    /// A gearbox.
    Gearbox,
    /// A study.
    Study,
    /// Data, or another text.
    Other,
}

impl FileKind {
    /// The kind that the first key of a text states.
    pub fn of(text: &str) -> Self {
        let outline = outline::read(text, None);
        match outline.get("gearloss").and_then(outline::Node::text) {
            Some(stated) if stated.starts_with("gearbox") => Self::Gearbox,
            Some(stated) if stated.starts_with("study") => Self::Study,
            _ => Self::Other,
        }
    }
}

/// A file of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FolderFile {
    /// Path relative to the folder.
    pub file: String,
    /// What it is.
    pub kind: FileKind,
}

/// What saving a text led to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Saved {
    /// It is saved; the hash of the text.
    Saved(String),
    /// The file is not what the page has read: what it is instead.
    Changed {
        /// Text; absent if there is no file, or no text.
        text: Option<String>,
        /// Hash; absent as the text.
        hash: Option<String>,
    },
}

/// The hash of a text by which changes are noticed.
pub fn hash(text: &str) -> String {
    hexadecimal(fnv1a_64(text.as_bytes()))
}

/// Refuses names that lead out of a folder, hidden files, and files that are no documents and no data.
pub(crate) fn check_name(file: &str) -> Result<(), Fault> {
    let path = Path::new(file);
    let is_plain = path.components().all(|part| matches!(part, Component::Normal(_)));
    if !is_plain || file.is_empty() || file.contains(['\\', ':', '\0']) || file.contains("//") || file.starts_with("./")
    {
        let message = format!("`{file}` is not in the opened folder");
        return Err(Fault::new(message, "open its folder with `gearloss open`"));
    }
    if file.split('/').any(|part| part.starts_with('.')) {
        let message = format!("`{file}` is hidden");
        return Err(Fault::new(message, "choose a name that does not begin with a dot"));
    }
    let extension = path.extension().and_then(|extension| extension.to_str());
    if !matches!(extension, Some("yaml" | "yml" | "csv")) {
        let message = format!("`{file}` is not a document");
        return Err(Fault::new(message, "let its name end with .yaml"));
    }
    Ok(())
}

fn is_yaml(file: &str) -> bool {
    let extension = Path::new(file).extension();
    extension.is_some_and(|extension| extension == "yaml" || extension == "yml")
}

/// Files of a session, relative to one folder.
pub trait Store: Debug + Send + Sync {
    /// Name of the folder.
    fn name(&self) -> String;

    /// The file that the page opens first.
    fn first(&self) -> Option<String> {
        None
    }

    /// Documents and data files.
    fn names(&self) -> Vec<String>;

    /// Documents and data files with their kinds.
    fn list(&self) -> Vec<FolderFile> {
        let kind = |file: &String| {
            let text = Some(file)
                .filter(|file| is_yaml(file))
                .and_then(|file| self.read(file).ok());
            text.map_or(FileKind::Other, |text| FileKind::of(&text))
        };
        let files = self.names().into_iter().map(|file| FolderFile {
            kind: kind(&file),
            file,
        });
        files.collect()
    }

    /// Refuses the name of a file outside of the folder, and of one that is no document and no data.
    ///
    /// # Errors
    /// What is wrong with the name.
    fn check(&self, file: &str) -> Result<(), Fault>;

    /// The text of a file; `None` if there is none.
    ///
    /// # Errors
    /// As [`Store::check`]; if the file cannot be read, or is no text.
    fn text(&self, file: &str) -> Result<Option<String>, Fault>;

    /// The text of a file.
    ///
    /// # Errors
    /// As [`Store::text`], and if there is none.
    fn read(&self, file: &str) -> Result<String, Fault> {
        let text = self.text(file)?;
        text.ok_or_else(|| Fault::new(format!("there is no file {file}"), "choose one of the list"))
    }

    /// Writes a file whose hash is known; a new file must not exist.
    ///
    /// # Errors
    /// If it is outside of the folder, or cannot be written.
    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault>;

    /// What documents read.
    fn source(&self) -> SharedSource;
}

/// Files in memory.
#[derive(Debug, Default)]
pub struct Memory {
    name: String,
    files: Mutex<Vec<(String, String)>>,
}

impl Memory {
    /// Files with their texts.
    pub fn new<'a>(name: &str, files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let files = files.into_iter();
        Self {
            name: name.to_owned(),
            files: Mutex::new(files.map(|(file, text)| (file.to_owned(), text.to_owned())).collect()),
        }
    }

    fn files(&self) -> std::sync::MutexGuard<'_, Vec<(String, String)>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Store for Memory {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn first(&self) -> Option<String> {
        self.files().first().map(|(file, _)| file.clone())
    }

    fn names(&self) -> Vec<String> {
        self.files().iter().map(|(file, _)| file.clone()).collect()
    }

    fn check(&self, file: &str) -> Result<(), Fault> {
        check_name(file)
    }

    fn text(&self, file: &str) -> Result<Option<String>, Fault> {
        let files = self.files();
        let found = files.iter().find(|(own, _)| own == file);
        Ok(found.map(|(_, text)| text.clone()))
    }

    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault> {
        let mut files = self.files();
        let Some((_, own)) = files.iter_mut().find(|(own, _)| own == file) else {
            files.push((file.to_owned(), text.to_owned()));
            return Ok(Saved::Saved(hash(text)));
        };
        if known != Some(hash(own).as_str()) {
            return Ok(Saved::Changed {
                text: Some(own.clone()),
                hash: Some(hash(own)),
            });
        }
        text.clone_into(own);
        Ok(Saved::Saved(hash(text)))
    }

    fn source(&self) -> SharedSource {
        InMemory::new(
            self.files()
                .iter()
                .map(|(file, text)| (Path::new(file), text.as_bytes())),
        )
        .shared()
    }
}
