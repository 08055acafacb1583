//! The files of a folder that documents may name.

use std::path::{Path, PathBuf};

/// Maximum depth of the folders of a workspace.
pub const DEEPEST: usize = 5;

/// Maximum number of files.
const MOST: usize = 2000;

/// Maximum number of entries that are looked at: a workspace may contain anything.
const MOST_SEEN: usize = 20_000;

/// Documents and data files of a folder and of folders in it, without hidden ones and those of build tools. Links are not followed.
pub fn files(folder: &Path, depth: usize) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut seen = 0;
    let mut waiting = vec![(folder.to_owned(), depth)];
    while let Some((folder, depth)) = waiting.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            continue;
        };
        for entry in entries.flatten() {
            seen += 1;
            if seen > MOST_SEEN || found.len() >= MOST {
                return found;
            }
            let (path, name) = (entry.path(), entry.file_name());
            let name = name.to_string_lossy();
            let Ok(kind) = entry.file_type() else { continue };
            if name.starts_with('.') {
                continue;
            }
            if kind.is_dir() {
                if depth > 1 && !["target", "node_modules"].contains(&name.as_ref()) {
                    waiting.push((path, depth - 1));
                }
                continue;
            }
            let extension = path.extension().and_then(|extension| extension.to_str());
            if kind.is_file() && matches!(extension, Some("yaml" | "yml" | "csv" | "xlsx" | "mf4")) {
                found.push(path);
            }
        }
    }
    found
}
