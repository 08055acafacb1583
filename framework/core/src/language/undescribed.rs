//! Physics that gearbox files cannot describe yet: it is named, instead of being reported as a misspelt key.

use crate::document::{Content, Diagnostic, Node, codes};

/// Words for stages that are no pairs of spur or helical gears.
const STAGES: [(&[&str], &str); 7] = [
    (&["worm", "worms"], "worm stages"),
    (&["hypoid"], "hypoid stages"),
    (&["bevel", "spiral"], "bevel stages"),
    (&["crossed"], "crossed helical gears"),
    (&["chain", "chains"], "chain drives"),
    (&["belt", "belts"], "belt drives"),
    (&["harmonic", "strain", "cycloidal"], "strain wave and cycloidal gears"),
];

/// Keys of axes that are not parallel.
const AXES: [&str; 6] = [
    "direction",
    "shaft_angle",
    "cone_angle",
    "lead_angle",
    "tilt",
    "axis_angle",
];

/// The stage that a word of a description means, such as `worm` or `worm_gear`.
pub fn undescribed_stage(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase();
    let parts: Vec<&str> = word.split(|c: char| !c.is_alphanumeric()).collect();
    let meant = STAGES
        .iter()
        .find(|(words, _)| words.iter().any(|word| parts.contains(word)));
    meant.map(|(_, name)| *name)
}

/// What to do instead.
pub const DESCRIBE_THE_REST: &str = "gearbox files have parallel shafts with spur and helical gears, also planetary ones: describe that part of the transmission, with a \
     port where the other stage is, and take the loss of the other stage from elsewhere";

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
    if let Some(stage) = undescribed_stage(key).or_else(|| text.and_then(undescribed_stage)) {
        return finding_without_notes(finding, &format!("{stage} cannot be described yet")).help(DESCRIBE_THE_REST);
    }
    if code == codes::UNKNOWN_KEY && AXES.contains(&key) {
        let message = "all shafts are parallel to x: other directions, and so bevel, hypoid and worm stages, cannot be described yet";
        return finding_without_notes(finding, message).help(DESCRIBE_THE_REST);
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
