//! The outline of a valid document is what a YAML parser reads.

use gearloss_document::{Content as Read, Node as ReadNode, read_yaml};
use gearloss_editor::outline::{Content, Node, read};

use super::common::examples;

fn compare(node: &Node, read: &ReadNode, path: &str, text: &str) {
    match (&node.content, &read.content) {
        (Content::Empty, Read::Null) => {}
        (Content::Map { entries, .. }, Read::Map(other)) => {
            let keys: Vec<&str> = entries.iter().map(|entry| entry.key.as_str()).collect();
            let expected: Vec<&str> = other.iter().map(|(key, _)| key.name.as_str()).collect();
            assert_eq!(keys, expected, "{path}");
            for (entry, (key, value)) in entries.iter().zip(other) {
                let path = format!("{path}.{}", key.name);
                assert_eq!(entry.span, key.span.start as usize..key.span.end as usize, "{path}");
                compare(&entry.value, value, &path, text);
            }
        }
        (Content::List(items), Read::List(other)) => {
            assert_eq!(items.len(), other.len(), "{path}");
            for (i, (item, value)) in items.iter().zip(other).enumerate() {
                compare(item, value, &format!("{path}.{i}"), text);
            }
        }
        (Content::Scalar { text: own_text, quoted }, _) => {
            let (start, end) = (read.span.start as usize, read.span.end as usize);
            // A block of text has its own rules for the end of lines.
            if !(*quoted && text[start..].starts_with(['|', '>'])) {
                assert_eq!(node.span, start..end, "{path}");
            }
            match &read.content {
                Read::Text { text: other, .. } if !text[start..end].contains(['\n', '\\']) => {
                    assert_eq!(own_text.replace("''", "'"), *other, "{path}");
                }
                Read::Map(_) | Read::List(_) => panic!("{path}: {node:?} instead of {read:?}"),
                _ => {}
            }
        }
        other => panic!("{path}: {other:?}"),
    }
}

#[test]
fn the_outline_of_every_example_is_that_of_the_parser() {
    for file in examples() {
        let text = std::fs::read_to_string(&file).unwrap();
        let parsed = read_yaml(0, &text);
        if parsed.findings.is_empty() {
            compare(&read(&text, None), &parsed.node, &file.display().to_string(), &text);
        }
    }
}

/// As Windows writes lines.
#[test]
fn lines_may_end_with_carriage_returns() {
    for file in examples() {
        let text = std::fs::read_to_string(&file).unwrap().replace('\n', "\r\n");
        let parsed = read_yaml(0, &text);
        if parsed.findings.is_empty() {
            compare(&read(&text, None), &parsed.node, &file.display().to_string(), &text);
        }
    }
}
