//! Quantities of a candidate outside their stated ranges at the points of a tournament.

use gearloss_framework::loss::Extent;
use gearloss_framework::transmission::Transmission;

use crate::numbers::{beyond, significant};
use crate::points::{Note, STATIC_SAFETY, notes};

/// A quantity of a model outside its stated range.
#[derive(Clone)]
pub struct Mark {
    /// Symbol of the quantity.
    pub name: &'static str,
    /// Description with range, values and number of points.
    pub words: String,
}

/// Quantities of models at some paths, including nested models, outside their stated ranges, except the safety of components.
pub fn marks(transmission: &Transmission, seen: &[Extent], paths: &[String]) -> Vec<Mark> {
    let is_concerned = |path: &str| {
        let below = |whole: &String| {
            path.strip_prefix(whole.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        paths.iter().any(below)
    };
    let mut groups: Vec<Note> = Vec::new();
    for note in notes(transmission, seen) {
        if note.outside == 0 || note.name == STATIC_SAFETY || !is_concerned(&note.path) {
            continue;
        }
        match groups
            .iter_mut()
            .find(|group| (group.name, group.range) == (note.name, note.range))
        {
            Some(group) => {
                group.least = group.least.min(note.least);
                group.greatest = group.greatest.max(note.greatest);
                group.points = group.points.saturating_add(note.points);
                group.outside = group.outside.saturating_add(note.outside);
            }
            None => groups.push(note),
        }
    }
    let mark = |note: Note| {
        let range = note.range?;
        let unit = if note.unit == "-" {
            String::new()
        } else {
            format!(" {}", note.unit)
        };
        let words = format!(
            "{} {} to {}{unit} is {} at {} of {} points of its components ({})",
            note.name,
            significant(note.least),
            significant(note.greatest),
            beyond(range.least, range.greatest),
            note.outside,
            note.points,
            range.origin
        );
        Some(Mark { name: note.name, words })
    };
    groups.into_iter().filter_map(mark).collect()
}
