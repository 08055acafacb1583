//! Key data of a gearbox: its stages and the ratio of each gear.

use gearloss_framework::transmission::{Stage, Transmission};
use serde_json::Value;

use crate::text::{TextTable, number, significant};

/// One indented line per stage and per gear.
pub fn card(transmission: &Transmission) -> String {
    let mut text = String::new();
    let mut stages = TextTable::new(&[
        "stage",
        "z",
        "ratio",
        "a mm",
        "x1",
        "x2",
        "eps_alpha",
        "eps_beta",
        "face overlap mm",
    ]);
    let mut any = false;
    for stage in transmission.stages() {
        any = true;
        stages.row(row(&stage));
    }
    if any {
        text.push_str(&stages.render());
    }
    let ports = transmission.ports();
    let reference = &ports[transmission.reference_port()].name;
    for (i, state) in transmission.states().iter().enumerate() {
        let ratios: Vec<String> = transmission
            .ratios(i)
            .into_iter()
            .map(|(port, ratio)| {
                let ratio = ratio.map_or_else(|| "stationary".to_owned(), significant);
                format!("{reference}/{} {ratio}", ports[port].name)
            })
            .collect();
        let ratios = if ratios.is_empty() {
            "no fixed ratio".to_owned()
        } else {
            ratios.join(", ")
        };
        text.push_str(&format!("gear {}: {ratios}\n", state.name));
    }
    let lines: Vec<&str> = text.lines().collect();
    format!("  {}\n", lines.join("\n  "))
}

fn row(stage: &Stage) -> Vec<String> {
    let narrow = stage.facewidth_mm[0].min(stage.facewidth_mm[1]);
    let [x1, x2] = stage.profile_shift.map(|x| number(Some(x), 4));
    vec![
        stage.mesh.trim_start_matches("meshes.").to_owned(),
        format!("{}/{}", stage.z[0], stage.z[1]),
        number(Some(stage.ratio), 4),
        number(Some(stage.centre_distance_mm), 3),
        x1,
        x2,
        number(stage.transverse_contact_ratio, 4),
        number(Some(stage.overlap_contact_ratio), 4),
        format!("{} of {}", significant(stage.face_overlap_mm), significant(narrow)),
    ]
}

/// All data of a stage at full precision, one line each: key and value as in JSON.
pub fn stage_lines(stage: &Stage) -> Vec<String> {
    let value = serde_json::to_value(stage).unwrap_or_default();
    let fields = value.as_object().into_iter().flatten();
    fields
        .filter(|(key, _)| *key != "mesh")
        .map(|(key, value)| format!("{key}: {}", inline(value)))
        .collect()
}

fn inline(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
