//! The largest values along the path in one sentence.

use gearloss_studies::analyses::contact_path::{ContactPathOutcome, PlaceOnPath};

use crate::page::Page;
use crate::text::{extremes, range, short};

pub fn add(outcome: &ContactPathOutcome, page: &mut Page) {
    let Some(path) = outcome.paths.first() else { return };
    let of = |value: fn(&PlaceOnPath) -> Option<f64>| {
        extremes(path.places.iter().filter_map(move |place| Some((value(place)?, place))))
    };
    let mut words = Vec::new();
    if let Some([_, high]) = of(|place| Some(place.hertz_pressure_gpa)) {
        words.push(format!("Hertzian pressure up to {} GPa", short(high.0)));
        page.key_figure("largest Hertzian pressure", short(high.0), "GPa", path.mesh.as_str());
    }
    if let Some([low, high]) = of(|place| place.mu) {
        words.push(format!("coefficient of friction {}", range(low.0, high.0, 3)));
        page.key_figure(
            "largest coefficient of friction",
            short(high.0),
            "",
            path.model_set.as_str(),
        );
    }
    if let Some([low, _]) = of(|place| Some(place.film_um)) {
        words.push(format!("film at least {} µm", short(low.0)));
        page.key_figure("thinnest film", short(low.0), "µm", path.mesh.as_str());
    }
    if let Some(why) = &path.no_friction {
        page.careful
            .push(format!("no friction along the path of {}: {why}", path.mesh));
    }
    page.headline =
        (!words.is_empty()).then(|| format!("Mesh {} with `{}`: {}", path.mesh, path.model_set, words.join(", ")));
}
