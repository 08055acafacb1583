//! Physics that gearbox files cannot describe yet: it is named, instead of being reported as a misspelt key.

use crate::document::{Content, Diagnostic, Node, codes};

/// Words for stages with a section of their own, and that section.
const SECTIONS: [(&[&str], &str, &str); 4] = [
    (&["worm", "worms"], "worm stages", "worm_meshes"),
    (&["hypoid"], "hypoid stages", "bevel_meshes"),
    (&["bevel", "spiral"], "bevel stages", "bevel_meshes"),
    (&["crossed"], "crossed helical gears", "crossed_helical_meshes"),
];

/// Words for stages that cannot be described.
const STAGES: [(&[&str], &str); 1] = [(&["harmonic", "strain", "cycloidal"], "strain wave and cycloidal gears")];

/// Keys of axes that are not parallel.
const AXES: [&str; 4] = ["direction", "tilt", "axis_angle", "inclination"];

/// The stage that a word of a description means, such as `worm` or `worm_gear`.
pub fn undescribed_stage(word: &str) -> Option<&'static str> {
    let meant = STAGES.iter().find(|(words, _)| means(word, words));
    meant.map(|(_, name)| *name)
}

/// The stage with a section of its own that a word of a description means, and that section.
pub fn stage_with_section(word: &str) -> Option<(&'static str, &'static str)> {
    let meant = SECTIONS.iter().find(|(words, ..)| means(word, words));
    meant.map(|(_, name, section)| (*name, *section))
}

/// True if one of some words is a part of a word of a description.
fn means(word: &str, words: &[&str]) -> bool {
    let word = word.to_lowercase();
    let parts: Vec<&str> = word.split(|c: char| !c.is_alphanumeric()).collect();
    words.iter().any(|word| parts.contains(word))
}

/// What to do instead.
pub const DESCRIBE_THE_REST: &str = "describe the rest of the transmission, with a port where that stage is, and take the loss of that stage from elsewhere";

/// Findings about such stages, in their words.
pub(super) fn explained(findings: Vec<Diagnostic>, document: &Node) -> Vec<Diagnostic> {
    findings
        .into_iter()
        .map(|finding| explained_one(finding, document))
        .collect()
}

fn explained_one(finding: Diagnostic, document: &Node) -> Diagnostic {
    let code = finding.code_or_other();
    if code != codes::UNKNOWN_KEY && code != codes::UNKNOWN_TYPE && code != codes::WRONG_TYPE {
        return finding;
    }
    let key = finding.path.rsplit('.').next().unwrap_or_default();
    let value = finding.path.split('.').try_fold(document, inner);
    let text = value.and_then(Node::text);
    if key == "bearings" && text == Some("none") {
        return finding_without_notes(finding, "`bearings: none` is a key of a single shaft").help(
            "write it into each shaft without bearings: `shafts: { NAME: { axis: [0 mm, 0 mm], bearings: none } }`",
        );
    }
    if code == codes::WRONG_TYPE {
        return finding;
    }
    if let Some((stage, section)) = stage_with_section(key).or_else(|| text.and_then(stage_with_section)) {
        return finding_without_notes(finding, &format!("{stage} are described in a section of their own"))
            .help(format!("describe the pair in `{section}`, and its shafts with `axis: {{ through: [x, y, z], direction: [x, y, z] }}`"));
    }
    if let Some(stage) = undescribed_stage(key).or_else(|| text.and_then(undescribed_stage)) {
        return finding_without_notes(finding, &format!("{stage} cannot be described yet")).help(DESCRIBE_THE_REST);
    }
    if code == codes::UNKNOWN_KEY && AXES.contains(&key) {
        return finding_without_notes(finding, "the direction of a shaft is a part of its axis")
            .help("write `axis: { through: [x, y, z], direction: [x, y, z] }` at the shaft");
    }
    finding
}

fn finding_without_notes(finding: Diagnostic, message: &str) -> Diagnostic {
    Diagnostic {
        message: message.to_owned(),
        notes: Vec::new(),
        help: None,
        ..finding
    }
}

fn inner<'a>(node: &'a Node, key: &str) -> Option<&'a Node> {
    match &node.content {
        Content::List(list) => list.get(key.parse::<usize>().ok()?),
        _ => node.get(key),
    }
}
