//! `new plugin`: a crate with a user's loss model.

use std::path::{Component, Path, PathBuf};

use gearloss_studies::study::is_device;

use super::{folder, word, write};
use crate::args::NewPluginArgs;
use crate::output::{End, Failure, Out};

/// Files of the crate with their templates. With the suffix `.in` cargo and rustfmt do not treat them as code of this crate.
const FILES: [(&str, &str); 8] = [
    ("Cargo.toml", include_str!("plugin/Cargo.toml.in")),
    ("README.md", include_str!("plugin/README.md.in")),
    (".gitignore", include_str!("plugin/gitignore.in")),
    ("gearbox.yaml", include_str!("plugin/gearbox.yaml.in")),
    ("src/lib.rs", include_str!("plugin/lib.rs.in")),
    ("src/main.rs", include_str!("plugin/main.rs.in")),
    ("src/my_bearing.rs", include_str!("plugin/my_bearing.rs.in")),
    ("tests/conformance.rs", include_str!("plugin/conformance.rs.in")),
];

/// Reserved names of Rust and Cargo, names of the crate's dependencies, and device names of Windows.
const TAKEN: &str = "abstract alloc as async aux await become box break build con const continue core crate deps do dyn \
    else enum examples extern false final fn for gen if impl in incremental let loop macro match mod \
    move mut nul override priv prn proc_macro pub ref return schemars self serde static std struct super \
    test trait true try type typeof unsafe unsized use virtual where while yield";

pub fn run(args: &NewPluginArgs, out: &mut Out) -> Result<End, Failure> {
    usable(&args.name)?;
    if let Some(path) = &args.gearloss {
        holds_a_checkout(path)?;
    }
    let home = args.output.clone().unwrap_or_else(|| PathBuf::from(&args.name));
    make(&home)?;
    let source = Source::choose(args.gearloss.as_deref(), &home)?;
    for (file, template) in FILES {
        write(&home.join(file), &filled(template, &args.name, &source)?, out)?;
    }
    out.line(source.description())?;
    out.line("next:")?;
    if home != Path::new(".") {
        out.line(format!("  cd {}", word(&home)))?;
    }
    out.line("  cargo test --no-fail-fast")?;
    out.line("  cargo run -- explain gearbox.yaml P1 --torque \"20 Nm\" --speed \"1500 rpm\"")?;
    Ok(End::Fine)
}

/// Rejects names that are invalid for a crate or cause a warning at every build.
fn usable(name: &str) -> Result<(), Failure> {
    if !is_written_well(name) {
        let close = name.to_ascii_lowercase().replace(|c| !may_stand_in_a_name(c), "-");
        let close = close
            .trim_start_matches(|c: char| !c.is_ascii_lowercase())
            .trim_end_matches(['-', '_']);
        let close = if is_written_well(close) && !is_taken(close) {
            close
        } else {
            "acme-losses"
        };
        return Err(Failure::input(
            format!(
                "`{name}` cannot name a crate: names consist of lower-case letters, digits, `-` and `_`, and start with a letter"
            ),
            format!("write a name such as `{close}`"),
        ));
    }
    if is_device(name) {
        return Err(Failure::input(
            format!("`{name}` cannot name a crate: it is a device name on Windows, where its folder cannot be created"),
            format!("add the name of your company, such as `acme-{name}`"),
        ));
    }
    if is_taken(name) {
        return Err(Failure::input(
            format!("`{name}` cannot name a crate: the name is reserved"),
            format!("add the name of your company, such as `acme-{name}`"),
        ));
    }
    Ok(())
}

fn may_stand_in_a_name(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_'
}

fn is_written_well(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(may_stand_in_a_name)
}

fn is_taken(name: &str) -> bool {
    name.starts_with("gearloss") || TAKEN.split(' ').any(|taken| taken == name.replace('-', "_"))
}

fn holds_a_checkout(path: &Path) -> Result<(), Failure> {
    if is_checkout(path) {
        return Ok(());
    }
    Err(Failure::input(
        format!(
            "{} is not a checkout of gearloss: it has no framework/core/Cargo.toml",
            path.display()
        ),
        "give the folder of a checkout, which contains README.md and framework, with --gearloss PATH",
    ))
}

fn is_checkout(path: &Path) -> bool {
    path.join("Cargo.toml").is_file() && path.join("framework/core/Cargo.toml").is_file()
}

/// Creates the folders of the crate. An existing folder must be empty apart from `.git`.
fn make(home: &Path) -> Result<(), Failure> {
    let cannot = |why: String, help: &str| {
        Err(Failure::input(
            format!("cannot write to {}: {why}", home.display()),
            help,
        ))
    };
    let other = "choose another folder with -o DIR";
    if home.is_dir() {
        let mut entries = std::fs::read_dir(home)?;
        if entries.any(|entry| entry.is_ok_and(|entry| entry.file_name() != ".git")) {
            return cannot(
                "the folder is not empty, and files are not overwritten".to_owned(),
                other,
            );
        }
    } else if home.exists() {
        return cannot("it is a file".to_owned(), other);
    } else if !folder(home).is_dir() {
        let why = format!("the folder {} does not exist", folder(home).display());
        return cannot(why, "create that folder, or choose another one with -o DIR");
    }
    for part in ["src", "tests"] {
        if let Err(error) = std::fs::create_dir_all(home.join(part)) {
            return cannot(error.to_string(), other);
        }
    }
    Ok(())
}

/// The source of gearloss for the crate.
enum Source {
    /// A given checkout, as a path in Cargo.toml.
    Named(PathBuf),
    /// The checkout that this program was built from.
    Own(PathBuf),
    /// The registry of crates.
    Registry,
}

impl Source {
    fn choose(named: Option<&Path>, home: &Path) -> Result<Self, Failure> {
        let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
        Ok(match named {
            // Links are resolved, because `..` after a link leads elsewhere.
            Some(path) if path.is_relative() => {
                Self::Named(path_from(&std::fs::canonicalize(home)?, &std::fs::canonicalize(path)?))
            }
            Some(path) => Self::Named(path.to_path_buf()),
            None if is_checkout(sources) => Self::Own(sources.to_path_buf()),
            None => Self::Registry,
        })
    }

    /// The values of the lines `gearloss` and `gearloss-framework` of Cargo.toml.
    fn dependencies(&self) -> Result<[String; 2], Failure> {
        let version = env!("CARGO_PKG_VERSION");
        let (Self::Named(path) | Self::Own(path)) = self else {
            return Ok([format!("\"{version}\""), format!("\"{version}\"")]);
        };
        let line = |path: &Path| match path.to_str() {
            // A JSON string is also a TOML string.
            Some(text) => Ok(format!(
                "{{ path = {}, version = \"{version}\" }}",
                serde_json::Value::from(text)
            )),
            None => Err(Failure::input(
                format!(
                    "Cargo.toml cannot contain {}: the path is not valid Unicode",
                    path.display()
                ),
                "rename the folder",
            )),
        };
        Ok([line(path)?, line(&path.join("framework/core"))?])
    }

    fn description(&self) -> String {
        match self {
            Self::Named(path) => format!("it uses gearloss from {}", path.display()),
            Self::Own(path) => format!(
                "it uses gearloss from {}, which this program was built from; --gearloss PATH selects another checkout",
                path.display()
            ),
            Self::Registry => format!(
                "it uses gearloss {} from the crate registry; --gearloss PATH selects a checkout instead",
                env!("CARGO_PKG_VERSION")
            ),
        }
    }
}

/// The relative path from one folder to another, both without links; the absolute path if they have no common root, as on two drives.
fn path_from(folder: &Path, to: &Path) -> PathBuf {
    let common = folder
        .components()
        .zip(to.components())
        .take_while(|(a, b)| a == b)
        .count();
    if common == 0 {
        return to.to_path_buf();
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to.components().skip(common)).collect();
    if way.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        way
    }
}

fn filled(template: &str, name: &str, source: &Source) -> Result<String, Failure> {
    let [gearloss, framework] = source.dependencies()?;
    Ok(template
        .replace("@NAME@", name)
        .replace("@CRATE@", &name.replace('-', "_"))
        .replace("@RUST@", env!("CARGO_PKG_RUST_VERSION"))
        .replace("@GEARLOSS@", &gearloss)
        .replace("@FRAMEWORK@", &framework))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::{Path, Source, path_from};

    #[test]
    fn without_a_checkout_the_lines_are_plain_versions() {
        let version = format!("\"{}\"", env!("CARGO_PKG_VERSION"));
        assert_eq!(Source::Registry.dependencies().unwrap(), [version.clone(), version]);
        assert!(Source::Registry.description().contains("--gearloss PATH"));
    }

    #[test]
    fn a_path_is_written_as_it_is_seen_from_the_new_crate() {
        for (home, to, way) in [
            ("/a/b", "/a/gl", "../gl"),
            ("/a/b/c", "/a", "../.."),
            ("/a", "/a/gl", "gl"),
            ("/a", "/a", "."),
            ("/ab", "/a", "../a"),
        ] {
            assert_eq!(
                path_from(Path::new(home), Path::new(to)),
                Path::new(way),
                "{home} to {to}"
            );
        }
    }
}
