//! Names of a study that are used for files.

use super::StudyEntry;
use gearloss_framework::document::Diagnostic;

/// Device names on Windows, which no file can have with any extension; `com` and `lpt` with a digit are also reserved.
///
/// Source: Microsoft, Naming Files, Paths, and Namespaces.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// True if the name is invalid for a file on some system.
pub fn is_device(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let port = |kind: &str| {
        let number = name.strip_prefix(kind);
        number.is_some_and(|number| matches!(number.as_bytes(), [b'0'..=b'9']))
    };
    DEVICES.contains(&name.as_str()) || port("com") || port("lpt")
}

/// Analyses and products with invalid file names.
pub(super) fn devices(entry: &StudyEntry) -> Vec<Diagnostic> {
    let of = |section: &'static str, ids: Vec<&str>| -> Vec<Diagnostic> {
        let found = ids.into_iter().filter(|id| is_device(id));
        let said = found.map(|id| {
            Diagnostic::error(
                format!("{section}.{id}"),
                format!("`{id}` is a device name on Windows, so it cannot be a file name"),
            )
            .help(format!("rename it, for example to `{id}_`"))
        });
        said.collect()
    };
    let mut found = of("gearboxes", entry.gearboxes.ids().collect());
    found.extend(of("analyses", entry.analyses.ids().collect()));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_are_distinguished_from_other_names() {
        for name in ["CON", "aux", "nul", "Prn", "com1", "LPT9"] {
            assert!(is_device(name), "{name}");
        }
        for name in ["cone", "aux_", "com", "com10", "comx", "map"] {
            assert!(!is_device(name), "{name}");
        }
    }
}
