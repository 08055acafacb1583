//! Names of a study that become files.

use super::StudyEntry;
use gearloss_framework::document::Diagnostic;

/// Names of devices on Windows, where no file can have one whatever its ending; `com` and `lpt` with a digit are others.
///
/// Source: Microsoft, Naming Files, Paths, and Namespaces.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// True where no file can be called so on every system.
pub fn is_device(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let port = |kind: &str| {
        let number = name.strip_prefix(kind);
        number.is_some_and(|number| matches!(number.as_bytes(), [b'0'..=b'9']))
    };
    DEVICES.contains(&name.as_str()) || port("com") || port("lpt")
}

/// Analyses and products whose files could not be written everywhere.
pub(super) fn devices(entry: &StudyEntry) -> Vec<Diagnostic> {
    let of = |section: &'static str, ids: Vec<&str>| -> Vec<Diagnostic> {
        let found = ids.into_iter().filter(|id| is_device(id));
        let said = found.map(|id| {
            Diagnostic::error(
                format!("{section}.{id}"),
                format!("`{id}` names a device on Windows, so no file of results can be called so"),
            )
            .help(format!("call it `{id}_`, or by another name"))
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
    fn devices_are_told_from_other_names() {
        for name in ["CON", "aux", "nul", "Prn", "com1", "LPT9"] {
            assert!(is_device(name), "{name}");
        }
        for name in ["cone", "aux_", "com", "com10", "comx", "map"] {
            assert!(!is_device(name), "{name}");
        }
    }
}
