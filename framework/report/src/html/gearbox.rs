//! A gearbox in the report: geometry, kinematics, and the evidence of its results.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::description::AssumedEntry;
use gearloss_framework::document::visible_json;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::analyses::{Built, Planner, Stopped};
use gearloss_studies::distinct::distinct;
use gearloss_studies::numbers::RPM;
use serde_json::Value;

use super::{GearboxPage, PageTable, point};
use crate::schematic;
use crate::text::number;

/// The basis of a gearbox's results: geometry and description with its default models, loads and losses with the model sets of the
/// analyses.
///
/// # Errors
/// Everything that resolving and building find.
pub fn gearbox_page(cx: &Planner<'_>, name: &str, gearbox: &Gearbox) -> Result<GearboxPage, Stopped> {
    let sets = cx.study.sets_used_for(name);
    // Overrides may apply only to the models of a set and not to the defaults of the gearbox.
    let described = cx.built(gearbox, &[]).or_else(|fault| match &sets[..] {
        [] => Err(fault),
        [first, ..] => cx.built(gearbox, std::slice::from_ref(first)),
    })?;
    let (resolved, transmission) = (&described[0].resolved, &described[0].transmission);
    let text = |key: &str| {
        resolved
            .value
            .get(key)
            .and_then(Value::as_str)
            .unwrap_or_default()
            .to_owned()
    };
    let assumed: Vec<AssumedEntry> = resolved
        .value
        .get("assumed")
        .and_then(|list| serde_json::from_value(list.clone()).ok())
        .unwrap_or_default();
    let built = cx.built(gearbox, &sets)?;
    let point = point::page(cx, &built, &assumed);
    let mut tables = vec![gears(transmission), meshes(transmission)];
    tables.extend(crossed_meshes(transmission));
    tables.push(states(transmission));
    tables.extend(changed(described.iter().chain(&built).map(|b| &**b)));
    Ok(GearboxPage {
        name: name.to_owned(),
        point: point.as_ref().map(|p| p.words.clone()).unwrap_or_default(),
        place: point.as_ref().map(|p| p.place.clone()).unwrap_or_default(),
        losses: point.as_ref().map_or_else(String::new, |p| {
            visible_json(&serde_json::to_string(&p.losses).unwrap_or_default()).into_owned()
        }),
        unjudged: point.as_ref().and_then(|p| p.unjudged.clone()),
        pictures: point.iter().flat_map(|p| p.pictures.clone()).collect(),
        oil: point.as_ref().map(|p| p.oil.clone()).unwrap_or_default(),
        point_tables: point.map(|p| p.tables).unwrap_or_default(),
        title: text("title"),
        source: text("source"),
        drawing: schematic(transmission, &resolved.value),
        tables,
        assumed,
        resolved: serde_saphyr::to_string(&resolved.value).unwrap_or_default(),
    })
}

/// Coefficients that differ from their source; absent if there are none.
fn changed<'a>(built: impl Iterator<Item = &'a Built<'a>>) -> Option<PageTable> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for b in built {
        for changed in changed_from_source(&b.transmission, &b.resolved) {
            let row = vec![
                b.name.clone(),
                changed.paths.join(", "),
                changed.model.to_owned(),
                changed.coefficient,
                changed.value.to_string(),
                changed.published.to_string(),
                changed.source.to_owned(),
            ];
            rows.push(row);
        }
    }
    let head = ["models", "path", "model", "coefficient", "value", "published", "source"];
    (!rows.is_empty()).then(|| table("Coefficients that differ from their source", &head, distinct(rows)))
}

pub(super) fn table(title: &str, head: &[&str], rows: Vec<Vec<String>>) -> PageTable {
    PageTable {
        title: title.to_owned(),
        head: head.iter().map(|h| (*h).to_owned()).collect(),
        rows,
    }
}

fn gears(t: &Transmission) -> PageTable {
    let mm = |x: f64| format!("{:.3}", x * 1e3);
    let rows = t
        .gears()
        .iter()
        .map(|g| {
            let [d, da, df] = g.diameters;
            let kind = if g.ring { "ring" } else { "external" };
            vec![
                g.id.clone(),
                if t.members()[g.member] == g.id {
                    "idler".to_owned()
                } else {
                    t.members()[g.member].clone()
                },
                g.z.to_string(),
                kind.to_owned(),
                mm(g.facewidth),
                mm(d),
                mm(da),
                mm(df),
            ]
        })
        .collect();
    table(
        "Gears",
        &["gear", "on", "z", "kind", "b mm", "d mm", "d_a mm", "d_f mm"],
        rows,
    )
}

/// Meshes of gears on axes that cross; absent if there are none.
fn crossed_meshes(t: &Transmission) -> Option<PageTable> {
    let both = |values: [f64; 2]| format!("{:.3} / {:.3}", values[0], values[1]);
    let rows: Vec<Vec<String>> = t
        .crossed_stages()
        .map(|stage| {
            vec![
                stage.mesh.split_once('.').map_or("", |(_, id)| id).to_owned(),
                format!("{}/{}", stage.z[0], stage.z[1]),
                format!("{:.3}", stage.shaft_angle_deg),
                format!("{:.3}", stage.offset_mm),
                both(stage.pitch_angle_deg),
                both(stage.spiral_angle_deg.map(f64::abs)),
                format!("{:.4}", stage.mean_normal_module_mm),
                both(stage.mean_diameter_mm),
                both(stage.at_mm),
            ]
        })
        .collect();
    let head = [
        "mesh",
        "z",
        "Σ deg",
        "a mm",
        "δ deg",
        "β_m deg",
        "m_mn mm",
        "d_m mm",
        "mean point at mm",
    ];
    (!rows.is_empty()).then(|| table("Meshes on axes that cross", &head, rows))
}

fn meshes(t: &Transmission) -> PageTable {
    let rows = t
        .cylindrical_meshes()
        .map(|(_, path, part)| {
            let p = &part.pair;
            vec![
                path.trim_start_matches("meshes.").to_owned(),
                format!("{}/{}", p.z[0], p.z[1]),
                format!("{:.3}", p.normal_module * 1e3),
                format!("{:.2}", p.helix_angle.to_degrees()),
                format!("{:.3}", p.working_angle.to_degrees()),
                format!("{:.3}", p.centre_distance * 1e3),
                format!("{:.4} / {:.4}", p.profile_shift[0], p.profile_shift[1]),
                number(p.involute.then_some(p.contact_ratio), 3),
                format!("{:.3}", p.overlap_ratio),
            ]
        })
        .collect();
    table(
        "Meshes",
        &[
            "mesh",
            "z",
            "m_n mm",
            "beta deg",
            "alpha_wt deg",
            "a mm",
            "x_1 / x_2",
            "eps_alpha",
            "eps_beta",
        ],
        rows,
    )
}

/// Speed of every member in every gear state, for 1000 rpm at the first free port.
fn states(t: &Transmission) -> PageTable {
    let mut head = vec!["gear", "port"];
    head.extend(t.members().iter().map(String::as_str));
    let mut rows = Vec::new();
    for (i, state) in t.states().iter().enumerate() {
        let Some(port) = state.speed_ports.first().filter(|_| state.speed_ports.len() == 1) else {
            continue;
        };
        let names: Vec<&str> = t.ports().iter().map(|p| p.name.as_str()).collect();
        let speed_at = names[*port];
        let torques: Vec<&str> = names.iter().copied().take(t.torques_needed(i)).collect();
        let Ok(case) = t.case(&state.name, &[speed_at], &torques) else {
            continue;
        };
        let speeds = t.speeds(&case, &[1000.0 / RPM]);
        let mut row = vec![state.name.clone(), speed_at.to_owned()];
        row.extend((0..t.members().len()).map(|m| format!("{:.2}", speeds[m] * RPM)));
        rows.push(row);
    }
    table("Speeds in rpm for 1000 rpm at the port", &head, rows)
}
