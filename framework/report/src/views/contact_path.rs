//! Paths of contact: a table along the path; each quantity over the distance from the pitch point.

mod summary;

use gearloss_studies::analyses::contact_path::{ContactPath, ContactPathOutcome, MeshUnderLoad, PlaceOnPath};

use crate::Figure;
use crate::figure::Map;
use crate::page::Page;
use crate::plot::{Line, Stroke};
use crate::register_view;
use crate::text::{TextTable, number, spread};

register_view!(ContactPathOutcome, show);

fn show(outcome: &ContactPathOutcome, page: &mut Page) {
    summary::add(outcome, page);
    let name = &outcome.head.analysis;
    for path in &outcome.paths {
        text(name, path, page);
        figures(name, path, page);
        if let Some(load) = &path.mesh_load {
            load_figures(name, path, load, page);
        }
    }
}

fn text(name: &str, path: &ContactPath, page: &mut Page) {
    let sharing = serde_json::to_value(&path.load_sharing).unwrap_or_default();
    let sharing = sharing
        .as_str()
        .or_else(|| sharing["type"].as_str())
        .unwrap_or_default()
        .to_owned();
    page.line(format!(
        "{name}: path of contact of {}, {:.3} Nm at its first gear, load sharing {}, models {}",
        path.mesh, path.mesh_torque_nm, sharing, path.model_set
    ));
    let table = TextTable::of(spread(path.places.len()).into_iter().map(|i| &path.places[i]))
        .column("mm from pitch", |p| format!("{:.3}", p.from_pitch_point_mm))
        .column("share", |p| format!("{:.3}", p.load_share))
        .column("sliding m/s", |p| format!("{:.3}", p.sliding_speed_m_s))
        .column("entrainment m/s", |p| format!("{:.3}", p.sum_speed_m_s))
        .column("p_H GPa", |p| format!("{:.3}", p.hertz_pressure_gpa))
        .column("film um", |p| format!("{:.3}", p.film_um))
        .column("mu", |p| number(p.mu, 4))
        .column("loss W", |p| number(p.sliding_loss_w, 2));
    page.table(table.finish());
    if let Some(why) = &path.no_friction {
        page.line(format!("no friction of {}: {why}", path.mesh));
    }
    if let Some(load) = &path.mesh_load {
        page.line(format!(
            "thin slices: stiffness {:.2} N/(mm um), transmission error {:.2} um on average and {:.2} um from least to greatest, line load up \
             to {:.1} N/mm, face load factor {:.3}, loss factor {:.4}",
            load.stiffness_gpa,
            load.mean_transmission_error_um,
            load.transmission_error_range_um,
            load.greatest_line_load_n_mm,
            load.face_load_factor,
            load.loss_factor
        ));
        let shafts = if load.shift_is_in_shaft_loads {
            "the loads on the shafts have that at the rating"
        } else {
            "which the loads on the shafts neglect"
        };
        page.line(format!(
            "the misalignment is {:.2} um; the resultant force is {:.1} % of half of the face width from its middle, {shafts}",
            load.misalignment_um,
            load.shift_of_resultant * 100.0
        ));
        if load.least_touching < 0.5 {
            page.careful.push(format!(
                "at times {:.0} % of the flanks of {} on the path touch: the modification or misalignment exceeds the deflection",
                load.least_touching * 100.0,
                path.mesh
            ));
        }
    }
    page.line("");
}

/// Line load over the plane of action, and the transmission error.
fn load_figures(name: &str, path: &ContactPath, load: &MeshUnderLoad, page: &mut Page) {
    let mut along: Vec<f64> = load.plane.iter().map(|p| p.plane_from_pitch_point_mm).collect();
    along.dedup();
    let count = load.plane.len() / along.len().max(1);
    let face = |j: usize| load.plane[j].face_mm;
    // One slice is the whole face.
    let rows = if count == 1 { 2 } else { count };
    let value = |j: usize, i: usize| Some(load.plane[i * count + j.min(count - 1)].line_load_n_mm);
    let map = Map {
        title: format!("{name}: line load over the plane of action of {}", path.mesh),
        x: (
            "distance from the pitch point in mm".to_owned(),
            along.iter().map(|x| format!("{x:.2}")).collect(),
        ),
        y: (
            "distance from the start of the face in mm".to_owned(),
            if count == 1 {
                vec!["0".to_owned(), format!("{:.2}", 2.0 * face(0))]
            } else {
                (0..rows).map(|j| format!("{:.2}", face(j))).collect()
            },
        ),
        values: (0..rows)
            .flat_map(|j| (0..along.len()).map(move |i| (j, i)))
            .map(|(j, i)| value(j, i))
            .collect(),
        unit: "N/mm".to_owned(),
        ..Map::default()
    };
    page.figure(format!("{name}-{}-plane", path.model_set), Figure::Map(map));
    let error = Figure::Lines {
        title: format!("{name}: transmission error of {}", path.mesh),
        x: "travel along the line of action in base pitches".to_owned(),
        y: "transmission error in um".to_owned(),
        lines: vec![Line {
            name: path.model_set.clone(),
            points: load
                .phases
                .iter()
                .map(|p| Some((p.base_pitches, p.transmission_error_um)))
                .collect(),
            stroke: Stroke::Line,
        }],
    };
    page.figure(format!("{name}-{}-transmission-error", path.model_set), error);
}

/// One figure for each quantity along the path.
fn figures(name: &str, path: &ContactPath, page: &mut Page) {
    type Along = (&'static str, &'static str, fn(&PlaceOnPath) -> Option<f64>);
    let quantities: [Along; 5] = [
        ("share", "share of the load", |p| Some(p.load_share)),
        ("pressure", "Hertzian pressure in GPa", |p| Some(p.hertz_pressure_gpa)),
        ("sliding", "sliding velocity in m/s", |p| Some(p.sliding_speed_m_s)),
        ("friction", "coefficient of friction", |p| p.mu),
        ("loss", "sliding loss in W", |p| p.sliding_loss_w),
    ];
    for (short, y, quantity) in quantities {
        if path.places.iter().all(|p| quantity(p).is_none()) {
            continue;
        }
        let point = |p: &PlaceOnPath| Some((p.from_pitch_point_mm, quantity(p)?));
        let line = Line {
            name: path.model_set.clone(),
            points: path.places.iter().map(point).collect(),
            stroke: Stroke::Line,
        };
        let figure = Figure::Lines {
            title: format!("{name}: {y} along the path of contact of {}", path.mesh),
            x: "distance from the pitch point in mm".to_owned(),
            y: y.to_owned(),
            lines: vec![line],
        };
        page.figure(format!("{name}-{}-{short}", path.model_set), figure);
    }
}
