//! The text of a model from the bytes of a file, decided by content: XML, JSON, or an archive with one of them.

use gearloss_document::Diagnostic;
use rawzip::{CompressionMethod, ZipArchive};

use crate::codes;

/// Longest text of a model; files of programs have up to about 10 MB. \[byte\]
pub const LONGEST_MODEL: u64 = 64 << 20;
/// Largest ratio of the text to its packed bytes. Models reach about 20.
const LARGEST_RATIO: u64 = 200;
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
    let broken = |fault: rawzip::Error| {
        error(format!("the archive cannot be read: {fault}"))
            .help("export or copy the file again; it may be incomplete")
    };
    let archive = ZipArchive::from_slice(bytes).map_err(broken)?;
    let mut entries = archive.entries();
    let mut models: Vec<(String, Vec<u8>)> = Vec::new();
    let mut total = 0;
    for count in 0.. {
        let Some(entry) = entries.next_entry().map_err(broken)? else {
            break;
        };
        if count == MOST_ENTRIES {
            return Err(
                limit(format!("the archive has more than {MOST_ENTRIES} entries")).help("give the model itself")
            );
        }
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        if entry.is_dir() || !can_be_model(&name) {
            continue;
        }
        let encrypted = entry.flags().is_encrypted();
        let method = entry.compression_method();
        let (packed, length) = (entry.compressed_size_hint(), entry.uncompressed_size_hint());
        // Files beside the model may be anything, as long as they are not unpacked.
        if encrypted || !(method == CompressionMethod::DEFLATE || method == CompressionMethod::STORE) {
            if named_as_model(&name) {
                let how = if encrypted {
                    "encrypted"
                } else {
                    "packed by another method than deflate"
                };
                return Err(error(format!("`{name}` in the archive is {how}"))
                    .help("unpack the archive and give the model in it"));
            }
            continue;
        }
        if length > LONGEST_MODEL || length / LARGEST_RATIO > packed {
            return Err(limit(format!(
                "`{name}` in the archive says that it unpacks from {packed} to {length} bytes; at most {} MB and {LARGEST_RATIO} times its size are read",
                LONGEST_MODEL >> 20
            ))
            .help("export the model without results, or unpack it and give the model"));
        }
        total += length;
        if total > LONGEST_MODEL {
            return Err(too_long());
        }
        let local = archive.get_entry(entry.wayfinder()).map_err(broken)?;
        let data = local.data();
        let content = if method == CompressionMethod::STORE {
            data.to_vec()
        } else {
            // One byte more than said shows that there is more.
            miniz_oxide::inflate::decompress_to_vec_with_limit(data, length as usize + 1).map_err(|fault| {
                error(format!("`{name}` in the archive cannot be unpacked: {fault}"))
                    .help("export or copy the file again; it may be incomplete")
            })?
        };
        let expected = local.claim_verifier();
        if content.len() as u64 != length || rawzip::crc32(&content) != expected.crc {
            return Err(error(format!(
                "`{name}` in the archive is damaged: length or checksum is wrong"
            ))
            .help("export or copy the file again"));
        }
        let begins = content.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&content);
        if named_as_model(&name) || format(begins).is_some_and(|format| is_model(begins, format)) {
            models.push((name, content));
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
