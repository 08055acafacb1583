//! Paths of contact: a table along the path; each quantity over the distance from the pitch point.

mod summary;

use gearloss_studies::analyses::contact_path::{ContactPath, ContactPathOutcome, PlaceOnPath};

use crate::Figure;
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
    }
}

fn text(name: &str, path: &ContactPath, page: &mut Page) {
    let sharing = serde_json::to_value(path.load_sharing).unwrap_or_default();
    page.line(format!(
        "{name}: path of contact of {}, {:.3} Nm at its first gear, load sharing {}, models {}",
        path.mesh,
        path.mesh_torque_nm,
        sharing.as_str().unwrap_or_default(),
        path.model_set
    ));
    let mut table = TextTable::new(&[
        "mm from pitch",
        "share",
        "sliding m/s",
        "entrainment m/s",
        "p_H GPa",
        "film um",
        "mu",
        "loss W",
    ]);
    for i in spread(path.places.len()) {
        let p = &path.places[i];
        table.row(vec![
            format!("{:.3}", p.from_pitch_point_mm),
            format!("{:.3}", p.load_share),
            format!("{:.3}", p.sliding_speed_m_s),
            format!("{:.3}", p.sum_speed_m_s),
            format!("{:.3}", p.hertz_pressure_gpa),
            format!("{:.3}", p.film_um),
            number(p.mu, 4),
            number(p.sliding_loss_w, 2),
        ]);
    }
    page.table(table);
    if let Some(why) = &path.no_friction {
        page.line(format!("no friction of {}: {why}", path.mesh));
    }
    page.line("");
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
