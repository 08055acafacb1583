//! XML, JSON and archives of one model become one gearbox.

use std::io::Write as _;

use gearloss_exchange::rexs::import;
use serde_json::{Value, json};

use crate::common::{PLANETARY, THREE_STAGE, TWO_STAGE, data, imported, language, refused, text};

/// A model in XML as JSON, each value under the name of its type.
pub fn json_of(xml: &str) -> String {
    let document = roxmltree::Document::parse(xml).unwrap();
    let root = document.root_element();
    let part = |name: &str| root.children().find(|child| child.has_tag_name(name));
    let integer = |node: roxmltree::Node<'_, '_>| node.attribute("id").unwrap().parse::<i64>().unwrap();
    let relations: Vec<Value> = part("relations")
        .unwrap()
        .children()
        .filter(roxmltree::Node::is_element)
        .map(|relation| {
            let refs: Vec<Value> = relation
                .children()
                .filter(roxmltree::Node::is_element)
                .map(|reference| json!({ "id": integer(reference), "role": reference.attribute("role"), "hint": reference.attribute("hint") }))
                .collect();
            json!({ "id": integer(relation), "type": relation.attribute("type"), "refs": refs })
        })
        .collect();
    let spectrum = part("load_spectrum").map(|spectrum| {
        let cases: Vec<Value> = spectrum
            .children()
            .filter(roxmltree::Node::is_element)
            .map(|case| json!({ "id": integer(case), "components": components(case) }))
            .collect();
        json!({ "id": 1, "load_cases": cases })
    });
    let mut model = json!({
        "version": root.attribute("version"),
        "applicationId": root.attribute("applicationId"),
        "applicationVersion": root.attribute("applicationVersion"),
        "date": root.attribute("date"),
        "relations": relations,
        "components": components(part("components").unwrap()),
    });
    if let Some(spectrum) = spectrum {
        model["load_spectrum"] = spectrum;
    }
    serde_json::to_string_pretty(&json!({ "model": model })).unwrap()
}

fn components(of: roxmltree::Node<'_, '_>) -> Value {
    of.children()
        .filter(roxmltree::Node::is_element)
        .map(|component| {
            let attributes: Vec<Value> = component
                .children()
                .filter(roxmltree::Node::is_element)
                .map(attribute)
                .collect();
            json!({
                "id": component.attribute("id").unwrap().parse::<i64>().unwrap(),
                "type": component.attribute("type"),
                "name": component.attribute("name"),
                "attributes": attributes,
            })
        })
        .collect()
}

fn attribute(node: roxmltree::Node<'_, '_>) -> Value {
    let scalar = |text: &str| -> (&str, Value) {
        let text = text.trim();
        match text {
            "true" | "false" => ("boolean", Value::from(text == "true")),
            _ => match text.parse::<f64>() {
                Ok(number) => ("floating_point", Value::from(number)),
                Err(_) => ("string", Value::from(text)),
            },
        }
    };
    let id = node.attribute("id").unwrap();
    let unit = node.attribute("unit");
    let (kind, value) = match node.children().find(roxmltree::Node::is_element) {
        Some(array) => {
            let cells: Vec<Value> = array
                .children()
                .filter(roxmltree::Node::is_element)
                .map(|cell| scalar(cell.text().unwrap_or_default()).1)
                .collect();
            let kind = if cells.first().is_some_and(Value::is_boolean) {
                "boolean_array"
            } else {
                "floating_point_array"
            };
            (kind, Value::from(cells))
        }
        // Designations such as 6205 are texts.
        None if matches!(id, "name" | "catalogue_designation") => {
            ("string", Value::from(node.text().unwrap_or_default()))
        }
        None => scalar(node.text().unwrap_or_default()),
    };
    json!({ "id": id, "unit": unit, kind: value })
}

/// An archive of files, packed or stored.
pub fn archive(files: &[(&str, &[u8])], pack: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, content) in files {
        let method = if pack {
            rawzip::CompressionMethod::DEFLATE
        } else {
            rawzip::CompressionMethod::STORE
        };
        let (mut entry, config) = writer.new_file(name).compression_method(method).start().unwrap();
        let packed = if pack {
            miniz_oxide::deflate::compress_to_vec(content, 6)
        } else {
            content.to_vec()
        };
        // Length and checksum are those of the content, whatever is written.
        let mut checked = config.wrap(std::io::sink());
        checked.write_all(content).unwrap();
        let (_, descriptor) = checked.finish().unwrap();
        entry.write_all(&packed).unwrap();
        entry.finish(descriptor).unwrap();
    }
    writer.finish().unwrap();
    bytes
}

#[test]
fn published_json_and_archive_become_the_same_files() {
    let xml = imported(TWO_STAGE);
    let json = imported("FVA-Industriegetriebe_2stufig_1-4.rexsj");
    assert_eq!(json.gearbox, xml.gearbox);
    assert_eq!((json.study, json.load_cases), (xml.study, xml.load_cases));
    let xml = imported(PLANETARY);
    let archive = imported("FVA_Planetary_stage_-_Minus_gearing_1.1.rexsz");
    assert_eq!(archive.gearbox, xml.gearbox);
    assert_eq!((archive.study, archive.load_cases), (xml.study, xml.load_cases));
}

#[test]
fn every_model_is_the_same_in_every_format() {
    for name in [TWO_STAGE, PLANETARY, THREE_STAGE] {
        let xml = imported(name);
        let bytes = data(name);
        let json = json_of(&text(name));
        let marked = [b"\xef\xbb\xbf".as_slice(), &bytes].concat();
        let other = b"a readme".as_slice();
        let apple = [0_u8, 5, 22, 7].as_slice();
        let apple_name = format!("__MACOSX/._{name}");
        let beside = [
            (apple_name.as_str(), apple),
            ("._x.rexs", apple),
            ("readme.txt", other),
            ("folder/model.xml", bytes.as_slice()),
        ];
        for (format, content) in [
            ("JSON", json.clone().into_bytes()),
            (
                "JSON in one line",
                serde_json::from_str::<Value>(&json).unwrap().to_string().into_bytes(),
            ),
            ("byte order mark", marked),
            ("packed", archive(&[("rexs-model.rexs", &bytes)], true)),
            ("stored", archive(&[("rexs-model.rexs", &bytes)], false)),
            ("with other files", archive(&beside, true)),
            ("packed JSON", archive(&[("a.rexsj", json.as_bytes())], true)),
        ] {
            let found =
                import(&content, name, language()).unwrap_or_else(|found| panic!("{format}: {}", found.render()));
            assert!(found.gearbox == xml.gearbox, "{name} as {format}");
            assert_eq!(
                (&found.study, &found.load_cases),
                (&xml.study, &xml.load_cases),
                "{name} as {format}"
            );
        }
    }
}

/// `false` stands for everything that is no number.
#[test]
fn json_that_lost_its_vectors_is_refused() {
    let name = "FVA_Planetary_stage_-_Minus_gearing_1.1.rexsj";
    let found = refused(&data(name), name);
    assert!(
        found.contains("support_vector is a truth value and not a vector"),
        "{found}"
    );
    assert!(found.contains("export the model as XML"), "{found}");
    assert!(found.contains("more findings"), "{found}");
    assert!(found.lines().count() < 250, "{found}");
}
