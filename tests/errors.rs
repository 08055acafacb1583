//! The list of codes: docs/errors.md contains it, and every finding has a code.

use crate::common::file;
use gearloss::api::{Code, codes};

/// docs/errors.md.
fn page() -> String {
    let mut text = "# Errors and warnings\n\nGenerated from the lists of codes in the sources by `UPDATE=1 cargo test --test all errors::`. Every \
                    finding has a code, which\ndoes not change if the message is reworded: `error[E0101]` on the terminal, `code` in \
                    `check --format json`. A code that is no longer used\nis not reused for another kind of finding.\n"
        .to_owned();
    for code in codes() {
        text.push_str(&format!(
            "\n## {}: {}\n**Cause.** {}\n\n**Help.** {}\n",
            code.id(),
            code.title(),
            code.cause(),
            code.help()
        ));
    }
    text
}

#[test]
fn the_page_of_errors_is_that_of_the_codes() {
    let path = file("docs/errors.md");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, page()).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == page(), "docs/errors.md is stale: UPDATE=1 writes it");
}

#[test]
fn codes_are_unique_and_ordered_within_errors_and_warnings() {
    for severity in ['E', 'W'] {
        let ids: Vec<&str> = codes()
            .into_iter()
            .map(Code::id)
            .filter(|id| id.starts_with(severity))
            .collect();
        assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
        assert!(
            ids.iter()
                .all(|id| id.len() == 5 && id[1..].bytes().all(|b| b.is_ascii_digit())),
            "{ids:?}"
        );
    }
}

/// The texts that users see: those of all golden cases.
#[test]
fn every_finding_of_the_golden_cases_has_a_code_of_its_own() {
    let known: Vec<&str> = codes().into_iter().map(Code::id).filter(|id| *id != "E0000").collect();
    let mut seen: Vec<String> = Vec::new();
    for folder in ["tests/cases", "tests/mistakes"] {
        for entry in std::fs::read_dir(file(folder)).unwrap() {
            let path = entry.unwrap().path().join("expected.txt");
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            for line in text
                .lines()
                .filter(|line| line.starts_with("error[") || line.starts_with("warning["))
            {
                let id = line
                    .split_once('[')
                    .and_then(|(_, rest)| rest.split_once(']'))
                    .unwrap()
                    .0;
                assert!(known.contains(&id), "{}: {line}", path.display());
                assert_eq!(
                    line.starts_with("error"),
                    id.starts_with('E'),
                    "{}: {line}",
                    path.display()
                );
                seen.push(id.to_owned());
            }
        }
    }
    seen.sort();
    seen.dedup();
    assert!(seen.len() > 20, "{seen:?}");
}
