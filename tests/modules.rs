//! The import graph of every crate, from the paths in its files: small cycles only, so that a file can be read after those it imports.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::common::file;

/// Folders of sources, one for each crate.
const CRATES: [&str; 11] = [
    "framework/document/src",
    "framework/exchange/src",
    "framework/fmu/src",
    "framework/numerics/src",
    "framework/core/src",
    "framework/editor/src",
    "framework/studies/src",
    "framework/report/src",
    "framework/workbench/src",
    "plugins/src",
    "src",
];

/// Maximum number of files in a cycle of imports.
const LARGEST_CYCLE: usize = 3;

/// Path of a module from the root of its crate.
type Module = Vec<String>;

#[test]
fn files_import_each_other_in_small_cycles_only() {
    let mut large = Vec::new();
    for folder in CRATES {
        let imports = imports(&file(folder));
        assert!(imports.values().any(|to| !to.is_empty()), "{folder}: no import is read");
        for cycle in cycles(&imports).into_iter().filter(|cycle| cycle.len() > LARGEST_CYCLE) {
            let names: Vec<String> = cycle.iter().map(|module| module.join("::")).collect();
            large.push(format!("{folder}: {}", names.join(", ")));
        }
    }
    assert!(
        large.is_empty(),
        "these files import each other in a cycle; move what they share into a file of its own:\n{}",
        large.join("\n")
    );
}

#[test]
fn crates_without_tests_of_their_docs_have_no_examples_in_them() {
    for folder in CRATES {
        let manifest = fs::read_to_string(file(folder).with_file_name("Cargo.toml")).expect("a manifest");
        if !manifest.contains("doctest = false") {
            continue;
        }
        for (module, source) in sources(&file(folder)) {
            let example = source.lines().map(str::trim_start).find(|line| {
                let text = line.strip_prefix("///").or_else(|| line.strip_prefix("//!"));
                text.is_some_and(|text| text.trim_start().starts_with("```"))
            });
            assert!(
                example.is_none(),
                "{folder}: {}: remove `doctest = false`, so that the example is run",
                module.join("::")
            );
        }
    }
}

#[test]
fn cycles_are_found_through_groups_and_relative_paths() {
    let sources = [
        ("", "mod a; mod b; pub use b::B;"),
        ("a", "use crate::{b::{self, B}, c::d};"),
        ("b", "fn f() -> super::c::C { \"crate::e::E\" }"),
        ("c", "pub use self::d::D; use crate::e as other; // use crate::a;"),
        ("c::d", "use super::super::a::A;"),
        ("e", "use super::a;\n#[cfg(test)]\nmod tests { use crate::c; }"),
    ];
    let sources = sources.map(|(name, text)| {
        (
            name.split("::").filter(|s| !s.is_empty()).map(str::to_owned).collect(),
            text.to_owned(),
        )
    });
    let names: Vec<Vec<String>> = cycles(&imports_of(&sources.into()))
        .into_iter()
        .map(|cycle| cycle.iter().map(|module| module.join("::")).collect())
        .collect();
    assert_eq!(names, [["a", "b", "c", "c::d", "e"]]);
}

/// For every file of a crate the files that it imports.
fn imports(folder: &Path) -> BTreeMap<Module, BTreeSet<Module>> {
    imports_of(&sources(folder))
}

fn sources(folder: &Path) -> BTreeMap<Module, String> {
    let mut sources = BTreeMap::new();
    read(folder, &mut Vec::new(), &mut sources);
    sources
}

/// Reads the sources below a folder by module; files of tests are omitted.
fn read(folder: &Path, above: &mut Module, sources: &mut BTreeMap<Module, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if name == "tests" {
            continue;
        }
        above.push(name.clone());
        if path.is_dir() {
            read(&path, above, sources);
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            let is_of_folder = ["lib", "main", "mod"].contains(&name.as_str());
            let module = above[..above.len() - usize::from(is_of_folder)].to_vec();
            sources.insert(module, fs::read_to_string(&path).unwrap());
        }
        above.pop();
    }
}

fn imports_of(sources: &BTreeMap<Module, String>) -> BTreeMap<Module, BTreeSet<Module>> {
    let of_file = |(module, text): (&Module, &String)| {
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let mut to = BTreeSet::new();
        for (path, is_public) in paths(&tokens(code), module) {
            let known = (0..=path.len()).rev().map(|n| path[..n].to_vec());
            let target = known.into_iter().find(|path| sources.contains_key(path));
            // A module that re-exports what its own modules define does not depend on them.
            let is_facade = |target: &Module| is_public && target.starts_with(module);
            to.extend(target.filter(|target| target != module && !is_facade(target)));
        }
        (module.clone(), to)
    };
    sources.iter().map(of_file).collect()
}

/// Names, `::` and single characters of a source, without comments, texts and lifetimes.
fn tokens(code: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
        let raw = rest.strip_prefix('r').map(|r| r.trim_start_matches('#'));
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(text) = raw.filter(|text| text.starts_with('"')) {
            let hashes = rest.len() - 1 - text.len();
            let end = format!("\"{}", "#".repeat(hashes));
            let start = rest.len() - text.len() + 1;
            rest[start..].find(&end).map_or(rest.len(), |at| start + at + end.len())
        } else if first == '"' {
            let mut escaped = false;
            let end = rest[1..].find(|c| {
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            end.map_or(rest.len(), |at| at + 2)
        } else if let Some(char) = rest.strip_prefix('\'') {
            match char.strip_prefix('\\') {
                Some(escaped) => 3 + escaped[1..].find('\'').unwrap_or(0) + 1,
                None => match char.char_indices().nth(1) {
                    Some((at, '\'')) => at + 2,
                    _ => 1 + char.find(|c| !is_of_name(c)).unwrap_or(char.len()),
                },
            }
        } else if is_of_name(first) {
            let length = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
            tokens.push(&rest[..length]);
            length
        } else {
            let length = if rest.starts_with("::") { 2 } else { first.len_utf8() };
            tokens.extend((!first.is_whitespace()).then_some(&rest[..length]));
            length
        };
        rest = &rest[length..];
    }
    tokens
}

/// The paths of a file that start at the crate, at a parent or at itself, and whether each is re-exported.
fn paths(tokens: &[&str], module: &Module) -> Vec<(Module, bool)> {
    let mut found = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        let starts = ["crate", "super", "self"].contains(token) && tokens.get(i + 1) == Some(&"::");
        if !starts || (i > 0 && tokens[i - 1] == "::") {
            continue;
        }
        let before = &tokens[..i];
        let is_public = before.ends_with(&["pub", "use"]) || before.ends_with(&[")", "use"]);
        let mut paths = Vec::new();
        expand(&tokens[i..], Vec::new(), &mut paths);
        found.extend(paths.into_iter().map(|path| (absolute(&path, module), is_public)));
    }
    found
}

/// Adds the paths of a tree of imports, and returns the number of its tokens.
fn expand(tokens: &[&str], mut above: Module, paths: &mut Vec<Module>) -> usize {
    let mut used = 0;
    loop {
        match tokens.get(used) {
            Some(&"{") => {
                used += 1;
                while tokens.get(used).is_some_and(|token| *token != "}") {
                    used += expand(&tokens[used..], above.clone(), paths);
                    // A separator, or the new name of an import.
                    while tokens.get(used).is_some_and(|token| ![",", "}"].contains(token)) {
                        used += 1;
                    }
                    used += usize::from(tokens.get(used) == Some(&","));
                }
                return used + 1;
            }
            Some(name) => above.push((*name).to_owned()),
            None => {}
        }
        used += 1;
        if tokens.get(used) != Some(&"::") {
            paths.push(above);
            return used;
        }
        used += 1;
    }
}

/// A path of a module from the root of the crate.
fn absolute(path: &[String], module: &Module) -> Module {
    let mut absolute = module.clone();
    for name in path {
        match name.as_str() {
            "crate" => absolute.clear(),
            "super" => drop(absolute.pop()),
            "self" => {}
            _ => absolute.push(name.clone()),
        }
    }
    absolute
}

/// The sets of files that reach each other, each sorted.
fn cycles(imports: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<Vec<Module>> {
    let reached: BTreeMap<&Module, BTreeSet<&Module>> =
        imports.keys().map(|from| (from, reached(imports, from))).collect();
    let mut found: Vec<Vec<Module>> = Vec::new();
    for (from, to) in &reached {
        if !to.contains(from) || found.iter().any(|cycle| cycle.contains(from)) {
            continue;
        }
        found.push(
            to.iter()
                .filter(|other| reached[**other].contains(from))
                .map(|m| (*m).clone())
                .collect(),
        );
    }
    found
}

/// The files that a file imports, directly or through others.
fn reached<'a>(imports: &'a BTreeMap<Module, BTreeSet<Module>>, from: &Module) -> BTreeSet<&'a Module> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&Module> = imports[from].iter().collect();
    while let Some(next) = open.pop() {
        if reached.insert(next) {
            open.extend(&imports[next]);
        }
    }
    reached
}
