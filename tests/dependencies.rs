//! What is linked into the program and what its page is built with: licences of a list, sources of the usual registries. `.ci/dependencies` asks for
//! known faults, which needs tools and a network.

use std::collections::BTreeSet;
use std::process::Command;

use serde_json::Value;

use crate::common::file;

fn read(path: &str) -> String {
    std::fs::read_to_string(file(path)).unwrap()
}

/// The licences of `deny.toml`.
fn allowed() -> BTreeSet<String> {
    let text = read("deny.toml");
    let list = text.split_once("\nallow = [").unwrap().1.split_once(']').unwrap().0;
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Whether an expression of SPDX can be met by licences of the list. The slash is an old form of `OR`.
fn is_met(expression: &str, allowed: &BTreeSet<String>) -> bool {
    fn any(words: &mut &[String], allowed: &BTreeSet<String>) -> bool {
        let mut met = all(words, allowed);
        while words.first().is_some_and(|word| word == "OR") {
            *words = &words[1..];
            met |= all(words, allowed);
        }
        met
    }
    fn all(words: &mut &[String], allowed: &BTreeSet<String>) -> bool {
        let mut met = one(words, allowed);
        while words.first().is_some_and(|word| word == "AND") {
            *words = &words[1..];
            met &= one(words, allowed);
        }
        met
    }
    fn one(words: &mut &[String], allowed: &BTreeSet<String>) -> bool {
        let Some((word, rest)) = words.split_first() else {
            return false;
        };
        *words = rest;
        if word == "(" {
            let met = any(words, allowed);
            *words = words.get(1..).unwrap_or_default();
            return met;
        }
        let mut licence = word.clone();
        if let [with, exception, rest @ ..] = *words
            && with == "WITH"
        {
            *words = rest;
            licence = format!("{licence} WITH {exception}");
        }
        allowed.contains(&licence)
    }
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<String> = spaced.split_whitespace().map(str::to_owned).collect();
    let mut words = words.as_slice();
    any(&mut words, allowed) && words.is_empty()
}

#[test]
fn expressions_of_licences_are_read() {
    let allowed = BTreeSet::from(["MIT", "Apache-2.0", "Apache-2.0 WITH LLVM-exception"].map(str::to_owned));
    for met in [
        "MIT",
        "MIT OR GPL-3.0",
        "GPL-3.0/MIT",
        "(GPL-3.0 OR MIT) AND Apache-2.0",
        "Apache-2.0 WITH LLVM-exception",
    ] {
        assert!(is_met(met, &allowed), "{met}");
    }
    for not in [
        "",
        "GPL-3.0",
        "MIT AND GPL-3.0",
        "(MIT OR Apache-2.0) AND GPL-3.0",
        "MIT WITH GPL-exception",
        "MIT GPL-3.0",
    ] {
        assert!(!is_met(not, &allowed), "{not}");
    }
}

/// Those of this system: those of others are not downloaded, and `cargo deny` sees them.
#[test]
fn crates_have_licences_of_the_list() {
    let host = Command::new("rustc").arg("-vV").output().unwrap();
    let host = String::from_utf8(host.stdout).unwrap();
    let host = host.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--offline", "--locked", "--format-version", "1"])
        .args(["--filter-platform", host])
        .current_dir(file("."))
        .output()
        .unwrap();
    assert!(
        metadata.status.success(),
        "{}",
        String::from_utf8_lossy(&metadata.stderr)
    );
    let metadata: Value = serde_json::from_slice(&metadata.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let allowed = allowed();
    let is_fine = |package: &&Value| is_met(package["license"].as_str().unwrap_or_default(), &allowed);
    let wrong: Vec<String> = packages
        .iter()
        .filter(|package| !is_fine(package))
        .map(|package| format!("{} {}", package["name"], package["license"]))
        .collect();
    assert!(packages.len() > 100 && wrong.is_empty(), "{wrong:?}");
}

/// Of all systems: everything is a member of the workspace, or from crates.io with the checksum of its content.
#[test]
fn crates_are_from_the_usual_registry() {
    let text = read("Cargo.lock");
    let mut found = 0;
    for package in text.split("[[package]]").skip(1) {
        let value = |key: &str| {
            package
                .lines()
                .find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "))
        };
        let name = value("name").unwrap();
        match value("source") {
            Some(source) => {
                assert_eq!(
                    source, "\"registry+https://github.com/rust-lang/crates.io-index\"",
                    "{name}"
                );
                assert!(value("checksum").is_some_and(|sum| sum.len() == 66), "{name}");
                found += 1;
            }
            None => assert!(
                name.starts_with("\"gearloss") || name == "\"in-house-plugin\"",
                "{name} has no source"
            ),
        }
    }
    assert!(found > 100, "{found}");
}

/// Packages of Node build and test the page. What a bundle contains is checked by `web/licence.mjs`: it is MIT.
#[test]
fn packages_of_node_have_known_licences_and_sums() {
    let mut allowed = allowed();
    // Tools that are not shipped: axe-core is under the MPL.
    allowed.extend(["ISC", "BlueOak-1.0.0", "MPL-2.0"].map(str::to_owned));
    for lock in [
        "web/package-lock.json",
        "editors/vscode/package-lock.json",
        "tests/editor/package-lock.json",
    ] {
        let lock_file: Value = serde_json::from_str(&read(lock)).unwrap();
        let packages = lock_file["packages"].as_object().unwrap();
        assert!(packages.len() > 1, "{lock}");
        for (name, package) in packages.iter().filter(|(name, _)| !name.is_empty()) {
            let licence = package["license"].as_str().unwrap_or_default();
            assert!(is_met(licence, &allowed), "{lock}: {name}: {licence}");
            assert!(package["integrity"].is_string(), "{lock}: {name} has no sum");
            let source = package["resolved"].as_str();
            let is_usual = source.is_none_or(|source| source.starts_with("https://registry.npmjs.org/"));
            assert!(is_usual, "{lock}: {name}: {source:?}");
        }
    }
}
