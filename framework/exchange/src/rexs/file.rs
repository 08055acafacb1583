//! The text of a model from the bytes of a file, decided by content: XML, JSON, or an archive with one of them.

use gearloss_document::Diagnostic;
use gearloss_document::archive::{Archive, ArchiveFault};

use crate::codes;

/// Longest text of a model; files of programs have up to about 10 MB. \[byte\]
pub const LONGEST_MODEL: u64 = 64 << 20;
/// Most entries of an archive.
const MOST_ENTRIES: usize = 1000;

/// How a model is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Xml,
    Json,
}

/// The text of a model.
#[derive(Debug)]
pub struct Document {
    /// Name of the file, with that of the entry in an archive.
    pub name: String,
    pub text: String,
    pub format: Format,
}

/// The text of a file.
pub fn text(bytes: &[u8], name: &str) -> Result<Document, Diagnostic> {
    if bytes.starts_with(b"PK") {
        let (entry, bytes) = unpacked(bytes)?;
        return plain(&bytes, format!("{name}: {entry}"));
    }
    plain(bytes, name.to_owned())
}

fn plain(bytes: &[u8], name: String) -> Result<Document, Diagnostic> {
    if bytes.len() as u64 > LONGEST_MODEL {
        return Err(too_long());
    }
    let text = std::str::from_utf8(bytes).map_err(|fault| {
        error(format!("byte {} is not UTF-8 text", fault.valid_up_to() + 1))
            .help("export the file with the encoding UTF-8")
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    match format(text.as_bytes()) {
        Some(format) => Ok(Document {
            name,
            text: text.to_owned(),
            format,
        }),
        None => Err(error("the file begins neither as XML nor as JSON nor as an archive")
            .help("give a file with the extension .rexs, .rexsj or .rexsz of the program that exported it")),
    }
}

fn format(bytes: &[u8]) -> Option<Format> {
    match bytes.iter().find(|byte| !byte.is_ascii_whitespace())? {
        b'<' => Some(Format::Xml),
        b'{' => Some(Format::Json),
        _ => None,
    }
}

/// Name and bytes of the only model in an archive.
fn unpacked(bytes: &[u8]) -> Result<(String, Vec<u8>), Diagnostic> {
    let archive = Archive::open(bytes, MOST_ENTRIES).map_err(|fault| match fault {
        ArchiveFault::Entries(most) => {
            limit(format!("the archive has more than {most} entries")).help("give the model itself")
        }
        fault => error(format!("the archive cannot be read: {fault}"))
            .help("export or copy the file again; it may be incomplete"),
    })?;
    let mut models: Vec<(String, Vec<u8>)> = Vec::new();
    let mut total = 0;
    for (name, entry) in &archive.entries {
        // Files beside the model may be anything, as long as they are not unpacked.
        let packed_otherwise = entry.encrypted || !entry.has_known_method();
        if !can_be_model(name) || (packed_otherwise && !named_as_model(name)) {
            continue;
        }
        // One that is too long by itself is refused below, by its name.
        if entry.length <= LONGEST_MODEL {
            total += entry.length;
        }
        if total > LONGEST_MODEL {
            return Err(too_long());
        }
        let content = archive
            .unpack(*entry, LONGEST_MODEL)
            .map_err(|fault| unpacking(name, &fault))?;
        let begins = content.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&content);
        if named_as_model(name) || format(begins).is_some_and(|format| is_model(begins, format)) {
            models.push((name.clone(), content));
        }
    }
    match models.len() {
        1 => Ok(models.swap_remove(0)),
        0 => Err(error("the archive contains no model").help("give an archive with one file in XML or JSON")),
        _ => {
            let names: Vec<&str> = models.iter().take(5).map(|(name, _)| name.as_str()).collect();
            Err(error(format!(
                "the archive contains {} models: {}",
                models.len(),
                names.join(", ")
            ))
            .help("unpack the archive and give one of them"))
        }
    }
}

/// The finding of an entry that cannot be unpacked.
fn unpacking(name: &str, fault: &ArchiveFault) -> Diagnostic {
    let message = format!("`{name}` in the archive cannot be unpacked: {fault}");
    match fault {
        ArchiveFault::Length { .. } => {
            limit(message).help("export the model without results, or unpack it and give the model")
        }
        ArchiveFault::Encrypted | ArchiveFault::Method => {
            error(message).help("unpack the archive and give the model in it")
        }
        ArchiveFault::Damaged(_) | ArchiveFault::Entries(_) => {
            error(message).help("export or copy the file again; it may be incomplete")
        }
    }
}

/// False for the copies of macOS, which have the names of models.
fn can_be_model(name: &str) -> bool {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    !name.starts_with("__MACOSX/") && !last.starts_with("._")
}

fn named_as_model(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    [".rexs", ".rexsj", ".rexs.xml", ".rexs.json"]
        .iter()
        .any(|end| name.ends_with(end))
}

/// True if the first element or key is that of a model.
fn is_model(bytes: &[u8], format: Format) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]).into_owned();
    match format {
        Format::Xml => head.contains("<model"),
        Format::Json => head.contains("\"model\""),
    }
}

fn error(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error("", message).code(codes::REXS_FILE)
}

fn limit(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error("", message).code(codes::REXS_LIMIT)
}

fn too_long() -> Diagnostic {
    limit(format!("the model is longer than {} MB", LONGEST_MODEL >> 20))
        .help("export it without results of calculations")
}
