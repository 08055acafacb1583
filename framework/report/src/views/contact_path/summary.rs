//! The largest values along the paths in one sentence.

use gearloss_studies::analyses::contact_path::{ContactPath, ContactPathOutcome, PlaceOnPath};

use crate::page::Page;
use crate::text::{extremes, label_of_set, of_set, range, short};

pub fn add(outcome: &ContactPathOutcome, page: &mut Page) {
    let sets = outcome.paths.len();
    let mut sentences = Vec::new();
    for path in &outcome.paths {
        let set = &path.model_set;
        let mut words = Vec::new();
        if let Some([_, high]) = ends(path, |place| Some(place.hertz_pressure_gpa)) {
            words.push(format!("Hertzian pressure up to {} GPa", short(high)));
            let label = label_of_set("largest Hertzian pressure", set, sets);
            page.key_figure(&label, short(high), "GPa", "");
        }
        if let Some([low, high]) = ends(path, |place| place.mu) {
            words.push(format!("coefficient of friction {}", range(low, high, 3)));
            let label = label_of_set("largest coefficient of friction", set, sets);
            page.key_figure(&label, short(high), "", "");
        }
        if let Some([low, _]) = ends(path, |place| Some(place.film_um)) {
            words.push(format!("film at least {} µm", short(low)));
            page.key_figure(&label_of_set("thinnest film", set, sets), short(low), "µm", "");
        }
        if let Some(why) = &path.no_friction {
            let path = label_of_set(&format!("no friction along the path of {}", path.mesh), set, sets);
            page.careful.push(format!("{path}: {why}"));
        }
        if !words.is_empty() {
            let subject = if sentences.is_empty() {
                format!("Mesh {} {}", path.mesh, of_set(set, sets))
            } else {
                of_set(set, sets)
            };
            sentences.push(format!("{}: {}", subject.trim_end(), words.join(", ")));
        }
    }
    page.headline = (!sentences.is_empty()).then(|| sentences.join("; "));
}

/// The least and the largest value along a path.
fn ends(path: &ContactPath, value: fn(&PlaceOnPath) -> Option<f64>) -> Option<[f64; 2]> {
    let values = path.places.iter().filter_map(|place| Some((value(place)?, ())));
    extremes(values).map(|ends| ends.map(|(value, ())| value))
}
