//! Ids that were renamed between versions: the table of the import against the change logs, and one model in the words of every version.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use gearloss_exchange::rexs::{import, newest_attribute, newest_component};

use crate::common::{PLANETARY, THREE_STAGE, TWO_STAGE, imported, language, text};

const VERSIONS: [&str; 9] = ["1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7", "2.0.0"];

/// A renamed attribute of a component type.
struct Rename {
    /// Place of the older version in `VERSIONS`.
    from: usize,
    old: String,
    new: String,
    components: Vec<String>,
}

fn renames() -> Vec<Rename> {
    let text = text("renames.csv");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        let [from, to, old, new, components] = cells[..] else {
            panic!("{row}")
        };
        let place = VERSIONS.iter().position(|version| *version == from).unwrap();
        assert_eq!(VERSIONS[place + 1], to);
        Rename {
            from: place,
            old: old.to_owned(),
            new: new.to_owned(),
            components: components.split(' ').map(str::to_owned).collect(),
        }
    })
    .collect()
}

/// The newest id of an attribute, by following the change logs.
fn newest(renames: &[Rename], of: &Rename, component: &str) -> String {
    let mut id = of.new.clone();
    for version in of.from + 1..VERSIONS.len() {
        let next = renames.iter().find(|rename| {
            rename.from == version && rename.old == id && rename.components.iter().any(|renamed| renamed == component)
        });
        if let Some(next) = next {
            id.clone_from(&next.new);
        }
    }
    id
}

/// All sources of the import, to see which ids it reads.
fn sources() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/rexs");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = files.filter(|path| !path.ends_with("aliases.rs"));
    sources.map(|path| fs::read_to_string(path).unwrap()).collect()
}

#[test]
fn the_table_of_aliases_has_every_renamed_id_that_is_read() {
    let (renames, sources) = (renames(), sources());
    assert_eq!(renames.len(), 406);
    let mut read = 0;
    for rename in &renames {
        for component in &rename.components {
            let newest = newest(&renames, rename, component);
            let component = newest_component(component);
            let found = newest_attribute(component, &rename.old);
            if sources.contains(&format!("\"{newest}\"")) {
                read += 1;
                assert_eq!(found, newest, "{} of {component}", rename.old);
            } else {
                assert_eq!(found, rename.old, "{} of {component} is not read", rename.old);
            }
        }
    }
    assert!(read >= 8, "{read}");
    // An id with another meaning elsewhere keeps it.
    assert_eq!(newest_attribute("lubricant", "name"), "name");
}

/// Types of components that changed between 1.2 and 1.3: old, new.
const TYPES: [(&str, &str); 2] = [
    ("flank_geometry", "cylindrical_gear_flank"),
    ("stage_gear_data", "cylindrical_stage_gear_data"),
];

/// A model with the ids of another version.
fn rewritten(text: &str, renames: &[Rename], stated: usize, wanted: usize) -> String {
    let mut out = String::new();
    let mut component = String::new();
    for line in text.split_inclusive('\n') {
        let mut line = line.to_owned();
        if line.contains("<component ") {
            attribute(&line, "type").clone_into(&mut component);
            for (old, new) in TYPES {
                if stated < 3 && wanted >= 3 {
                    line = line.replace(&format!("type=\"{old}\""), &format!("type=\"{new}\""));
                } else if stated >= 3 && wanted < 3 {
                    line = line.replace(&format!("type=\"{new}\""), &format!("type=\"{old}\""));
                }
            }
        }
        if line.contains("<attribute ") {
            let id = attribute(&line, "id").to_owned();
            let renamed = renamed(renames, &component, &id, stated, wanted);
            line = line.replace(
                &format!("<attribute id=\"{id}\""),
                &format!("<attribute id=\"{renamed}\""),
            );
            if wanted < 4 {
                line = line.replace("unit=\"deg\"", "unit=\"°\"");
            } else {
                line = line.replace("unit=\"°\"", "unit=\"deg\"");
            }
            if wanted == 8 {
                line = line.replace("elastic_modulus\" unit=\"N / mm^2\"", "elastic_modulus\" unit=\"MPa\"");
            }
        }
        out.push_str(&line);
    }
    out
}

fn renamed(renames: &[Rename], component: &str, id: &str, stated: usize, wanted: usize) -> String {
    let mut id = id.to_owned();
    let is_of = |rename: &&Rename| rename.components.iter().any(|renamed| renamed == component);
    for version in stated..wanted {
        let step = renames
            .iter()
            .filter(|rename| rename.from == version && rename.old == id)
            .find(is_of);
        if let Some(step) = step {
            id.clone_from(&step.new);
        }
    }
    for version in (wanted..stated).rev() {
        let step = renames
            .iter()
            .filter(|rename| rename.from == version && rename.new == id)
            .find(is_of);
        if let Some(step) = step {
            id.clone_from(&step.old);
        }
    }
    id
}

fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
    let rest = line.split(&format!("{name}=\"")).nth(1).unwrap();
    rest.split('"').next().unwrap()
}

/// The gearbox without the list of ids that were not used, which has the ids of the file.
fn described(gearbox: &str) -> &str {
    gearbox.split("# Not used: ").next().unwrap()
}

#[test]
fn a_model_in_the_words_of_every_version_is_the_same() {
    let renames = renames();
    let mut changed = BTreeMap::new();
    for (name, stated) in [(THREE_STAGE, 0), (PLANETARY, 1), (TWO_STAGE, 4)] {
        let original = imported(name);
        let text = text(name);
        let xml = text.replacen(" version=\"1.0\" enc", " version=\"xml\" enc", 1);
        for wanted in 0..VERSIONS.len() {
            let version = format!(" version=\"{}\"", if stated == 0 { "1.0" } else { VERSIONS[stated] });
            let again = rewritten(&xml, &renames, stated, wanted);
            let again = again.replacen(&version, &format!(" version=\"{}\"", VERSIONS[wanted]), 1);
            let again = again.replacen(" version=\"xml\" enc", " version=\"1.0\" enc", 1);
            *changed.entry(name).or_insert(0) += usize::from(again != text);
            let found = import(again.as_bytes(), name, language()).unwrap_or_else(|found| panic!("{}", found.render()));
            assert!(found.warnings.list.is_empty());
            let expected = original.gearbox.replace(
                &format!("REXS {} model", VERSIONS[stated]),
                &format!("REXS {} model", VERSIONS[wanted]),
            );
            assert_eq!(
                described(&found.gearbox),
                described(&expected),
                "{name} as {}",
                VERSIONS[wanted]
            );
            assert_eq!(
                (&found.study, &found.load_cases),
                (&original.study, &original.load_cases)
            );
        }
    }
    assert!(changed.values().all(|count| *count == 8), "{changed:?}");
}

#[test]
fn an_unknown_version_is_a_warning() {
    let text = text(TWO_STAGE).replace(" version=\"1.4\"", " version=\"3.1\"");
    let found = import(text.as_bytes(), TWO_STAGE, language()).unwrap();
    let warnings = found.warnings.render();
    assert!(
        warnings.contains("warning[W0801]: the version of the file is 3.1"),
        "{warnings}"
    );
}
