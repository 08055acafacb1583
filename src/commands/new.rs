//! `new`: commented templates.

mod gearbox;
mod plugin;
mod study;

use std::io::ErrorKind;
use std::path::Path;

use gearloss_framework::files::{LONGEST_TEXT, read_text};
use gearloss_framework::language::{Kind, Language};

use super::schema::published;
use crate::args::{NewArgs, NewWhat};
use crate::output::{End, Failure, Out};

pub fn run(args: &NewArgs, out: &mut Out) -> Result<End, Failure> {
    match &args.what {
        NewWhat::Gearbox(args) => gearbox::run(args, out),
        NewWhat::Study(args) => study::run(args, out),
        NewWhat::Plugin(args) => plugin::run(args, out),
    }
}

/// Writes a new file and prints its name; an existing file is an error.
pub(super) fn write(file: &Path, text: &str, out: &mut Out) -> Result<(), Failure> {
    use std::io::Write as _;
    let refuse = |what: String, help: String| Err(Failure::input(what, help));
    let folder = folder(file);
    if !folder.is_dir() {
        return refuse(
            format!(
                "cannot write {}: the folder {} does not exist",
                file.display(),
                folder.display()
            ),
            "create the folder, or choose another one with -o".to_owned(),
        );
    }
    if file.is_dir() {
        return refuse(
            format!("cannot write {}: it is a folder", file.display()),
            "choose a file in it with -o".to_owned(),
        );
    }
    let opened = std::fs::OpenOptions::new().write(true).create_new(true).open(file);
    match opened.and_then(|mut opened| opened.write_all(text.as_bytes())) {
        Ok(()) => {
            out.line(format!("wrote {}", file.display()))?;
            Ok(())
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => refuse(
            format!("{} exists and is not overwritten", file.display()),
            "choose another file, such as -o other.yaml".to_owned(),
        ),
        Err(error) => refuse(
            format!("cannot write {}: {error}", file.display()),
            "choose another file with -o".to_owned(),
        ),
    }
}

/// Writes the schema that the first line of a file names, for editors. An existing schema is kept, because other files may use it.
pub(super) fn write_schema(
    file: &Path,
    language: &Language,
    kind: Kind,
    name: &str,
    out: &mut Out,
) -> Result<(), Failure> {
    let schema = folder(file).join(name);
    let schema = schema.strip_prefix(".").unwrap_or(&schema);
    let text = published(language, kind)?;
    match read_text(schema, LONGEST_TEXT) {
        Err(error) if error.kind() == ErrorKind::NotFound => write(schema, &text, out),
        Ok(present) if present == text => Ok(()),
        Err(error) if error.kind() != ErrorKind::InvalidData => Err(Failure::input(
            format!("cannot read {}: {error}", schema.display()),
            "choose another folder with -o",
        )),
        _ => {
            out.line(format!(
                "kept {}, which is not the schema of this version; `gearloss schema` prints the current one",
                schema.display()
            ))?;
            Ok(())
        }
    }
}

/// The folder of a file; the current folder if the path has none.
fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A path quoted for a shell.
pub(super) fn word(path: &Path) -> String {
    let text = path.display().to_string();
    if text.chars().all(|c| c.is_alphanumeric() || "/\\._-:+".contains(c)) {
        text
    } else {
        // Windows has double quotes only; other shells expand text inside double quotes.
        if cfg!(windows) {
            format!("\"{text}\"")
        } else {
            format!("'{}'", text.replace('\'', r"'\''"))
        }
    }
}

/// Prints the commands to type next.
pub(super) fn print_next(commands: &[String], out: &mut Out) -> Result<(), Failure> {
    out.line("next:")?;
    for command in commands {
        out.line(format!("  gearloss {command}"))?;
    }
    Ok(())
}
