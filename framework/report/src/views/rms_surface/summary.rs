//! The minimum of each surface in one sentence.

use gearloss_studies::analyses::rms_surface::RmsSurfaceOutcome;

use crate::names::quantity;
use crate::page::Page;
use crate::text::short;

pub fn add(outcome: &RmsSurfaceOutcome, page: &mut Page) {
    let mut words = Vec::new();
    for surface in &outcome.surfaces {
        let (what, unit) = surface.quantity.words(outcome.difference);
        let least = &surface.least;
        let place = &surface.least_place.place;
        let at = [(&surface.x, place[0], least.x_end), (&surface.y, place[1], least.y_end)];
        let at = at.map(|(axis, i, end)| {
            let name = quantity(&axis.path);
            let end = end.map_or_else(String::new, |end| format!(" ({end} end)"));
            format!("{name} {}{end}", axis.words[i])
        });
        let at = at.join(", ");
        words.push(format!(
            "`{}` {} {unit} rms at {at}",
            surface.model_set,
            short(least.rms)
        ));
        page.key_figure(
            &format!("least deviation, {}", surface.model_set),
            short(least.rms),
            unit,
            format!("rms of the {what} at {at}"),
        );
        if least.x_end.is_some() || least.y_end.is_some() {
            page.careful
                .push(format!("{}: the minimum is at the end of a range", surface.model_set));
        }
    }
    page.headline =
        (!words.is_empty()).then(|| format!("Smallest deviation from the measurement: {}", words.join("; ")));
}
