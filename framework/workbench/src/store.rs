//! Where the files of a session are.

use std::fmt::Debug;
use std::path::{Component, Path};
use std::sync::{Mutex, PoisonError};

use gearloss_document::visible;
use gearloss_editor::outline;
use gearloss_framework::files::{InMemory, SharedSource};
use gearloss_studies::engine::head::{fnv1a_64, hexadecimal};
use serde::Serialize;

use crate::answer::Fault;
use crate::drafts::{Draft, KeptDraft};

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
        let message = format!("`{}` is not in the opened folder", visible(file));
        return Err(Fault::new(message, "open its folder with `gearloss open`"));
    }
    if file.split('/').any(|part| part.starts_with('.')) {
        let message = format!("`{}` is hidden", visible(file));
        return Err(Fault::new(message, "choose a name that does not begin with a dot"));
    }
    let extension = path.extension().and_then(|extension| extension.to_str());
    if !matches!(extension, Some("yaml" | "yml" | "csv")) {
        let message = format!("`{}` is not a document", visible(file));
        return Err(Fault::new(message, "let its name end with .yaml"));
    }
    Ok(())
}

/// Names of devices on Windows, with any extension; there are ports with a digit, too.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// Refuses the name of a new file that some computer cannot have, that hides what it is, or that is in no folder of the `known` files.
/// `web/src/workbench/names.ts` has the same rules for the page.
pub(crate) fn check_new_name(file: &str, known: &[String]) -> Result<(), Fault> {
    check_name(file)?;
    let (folder, name) = file.rsplit_once('/').unwrap_or(("", file));
    let shown = visible(file);
    let folders = known.iter().filter_map(|known| known.rsplit_once('/'));
    // A folder is known by the files in it and in its folders.
    let is_known = |(parent, _): (&str, &str)| parent == folder || parent.starts_with(&format!("{folder}/"));
    if !folder.is_empty() && !folders.clone().any(is_known) {
        return Err(Fault::new(
            format!("the opened folder has no documents in the folder of `{shown}`"),
            "use a folder of the list, or none",
        ));
    }
    let is_usual = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | ' ');
    let begins = name
        .chars()
        .next()
        .is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '-'));
    if !begins || !name.chars().all(is_usual) {
        return Err(Fault::new(
            format!("`{shown}` has signs that names of new files may not have"),
            "write letters, digits, spaces, `_`, `-` and dots, and begin with none of the last two",
        ));
    }
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_lowercase();
    let port = stem.strip_prefix("com").or_else(|| stem.strip_prefix("lpt"));
    let is_port = port.is_some_and(|number| number.len() == 1 && number.bytes().all(|digit| digit.is_ascii_digit()));
    if DEVICES.contains(&stem.as_str()) || is_port {
        return Err(Fault::new(
            format!("`{shown}` is the name of a device on Windows"),
            "choose another name",
        ));
    }
    let is_same = |known: &&String| known.to_lowercase() == file.to_lowercase();
    if let Some(known) = known.iter().find(is_same) {
        return Err(Fault::new(
            format!(
                "`{shown}` differs from the file `{}` by large and small letters only",
                visible(known)
            ),
            "choose another name: some disks do not tell them apart",
        ));
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
    /// If it is outside of the folder, if a new file cannot have this name, or if it cannot be written.
    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault>;

    /// What documents read.
    fn source(&self) -> SharedSource;

    /// Keeps a text that is not saved, for a page after a reload or a restart of the program; its name among the drafts. A store without
    /// drafts keeps nothing.
    ///
    /// # Errors
    /// If it cannot be kept.
    fn keep(&self, _tab: &str, _draft: &Draft) -> Result<String, Fault> {
        Ok(String::new())
    }

    /// Forgets a draft; one that is unknown is forgotten already.
    ///
    /// # Errors
    /// If it cannot be removed.
    fn forget(&self, _id: &str) -> Result<(), Fault> {
        Ok(())
    }

    /// Drafts of this program, and of those that have ended.
    fn drafts(&self) -> Vec<KeptDraft> {
        Vec::new()
    }
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
        let found = files.iter().find(|(known, _)| known == file);
        Ok(found.map(|(_, text)| text.clone()))
    }

    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault> {
        let mut files = self.files();
        let Some((_, known_text)) = files.iter_mut().find(|(name, _)| name == file) else {
            let known: Vec<String> = files.iter().map(|(file, _)| file.clone()).collect();
            check_new_name(file, &known)?;
            files.push((file.to_owned(), text.to_owned()));
            return Ok(Saved::Saved(hash(text)));
        };
        if known != Some(hash(known_text).as_str()) {
            return Ok(Saved::Changed {
                text: Some(known_text.clone()),
                hash: Some(hash(known_text)),
            });
        }
        text.clone_into(known_text);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn new_files_have_names_that_every_computer_can_have() {
        let known: Vec<String> = ["gearbox.yaml", "sub/study.yaml", "a/b/c.yaml"]
            .map(str::to_owned)
            .into();
        for file in [
            "new.yaml",
            "Größe 2.yaml",
            "減速機.yml",
            "_x-1.2.csv",
            "sub/new.yaml",
            "a/new.yaml",
            "a/b/new.yaml",
        ] {
            assert_eq!(check_new_name(file, &known), Ok(()), "{file}");
        }
        for file in [
            "../new.yaml",
            "/new.yaml",
            "sub/../new.yaml",
            "sub//new.yaml",
            "./new.yaml",
            "new\0.yaml",
            "C:new.yaml",
            "sub\\new.yaml",
            "",
            "new.yaml.",
            "new.yaml ",
            "new",
            ".yaml",
            ".new.yaml",
            " new.yaml",
            "new\u{202e}.yaml",
            "new\u{200b}.yaml",
            "new\n.yaml",
            "new?.yaml",
            "a*b.yaml",
            "new|x.yaml",
            "\"new\".yaml",
            "<new>.yaml",
            "$(new).yaml",
            "other/new.yaml",
            "su/new.yaml",
            "con.yaml",
            "Nul.yaml",
            "AUX .yaml",
            "com1.yaml",
            "LPT9.x.yaml",
            "conout$.yaml",
            "Gearbox.YAML",
            "Gearbox.yaml",
            "SUB/new.yaml",
            "sub/Study.yaml",
        ] {
            assert!(check_new_name(file, &known).is_err(), "{file}");
        }
    }
}
