//! What is explained.

use std::path::Path;

use super::common::{cursor, in_memory};

const GEARBOX: &str = "gearloss: gearbox/1
shafts:
  drive: { axis: [0 mm, 0 mm], mass: 3 kg }
bearings:
  B1: { shaft: drive, designation: \"6205\", kind: deep_groove_ball, model: { type: skf } }
models: { bearing: { type: harris } }
set: { housing.oil.volume: 2 l }
";

/// Text before which the cursor is, and words of the explanation.
#[test]
fn keys_models_designations_and_ids_are_explained() {
    for (before, words) in [
        ("mass: 3", "Mass including|Unit: kg|Default: 0|Range: 0 to 100000 kg"),
        ("shaft: drive", "Member in the bore"),
        ("drive, des", "`drive` in `shafts`|Member in the bore"),
        ("6205", "catalogue of bearings|`bore`: 25 mm|Confidence"),
        ("deep_groove", "Values|`deep_groove_ball`"),
        ("skf }", "**skf**|Source: |Evidence of the formula|Example: "),
        ("harris", "**harris**|Source: "),
        ("bearings:", "rolling bearing"),
        ("housing.oil.vol", "Unit: "),
    ] {
        let text = GEARBOX.replacen(before, &format!("|{before}"), 1);
        let (text, at) = cursor(&text);
        let hover = in_memory(&[("a.yaml", &text)]).hover(Path::new("a.yaml"), at + 1);
        let shown = hover.unwrap_or_else(|| panic!("nothing at {before}")).text;
        for word in words.split('|') {
            assert!(shown.contains(word), "{before}: `{word}` is not in\n{shown}");
        }
    }
    assert_eq!(in_memory(&[("a.yaml", "# text")]).hover(Path::new("a.yaml"), 3), None);
}
