//! `explain`: a point, then every step of the losses, ratings and heat paths of a component.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::document::{Diagnostic, did_you_mean};
use gearloss_framework::evaluate::Ratings;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::Transmission;
use gearloss_studies::points::{PreparedPoint, SolvedPoint};

use super::oil::oil_level_text;
use super::{explain_heat_path, explain_part, explain_ratings, heading, locking_text, ports_text, temperature_text};
use crate::text::figures;

/// What is explained: components and heat paths that a name matches, by path, by id, or by the start of a path.
#[derive(Debug, Clone)]
pub struct Explained {
    parts: Vec<usize>,
    ways: Vec<usize>,
}

impl Explained {
    /// What a name matches.
    ///
    /// # Errors
    /// If it is none; the help has a close name, or all.
    pub fn named(transmission: &Transmission, name: &str) -> Result<Self, Diagnostic> {
        let fits = |path: &str, id: usize| {
            path == name || path.starts_with(&format!("{name}.")) || path.split('.').nth(id) == Some(name)
        };
        let parts = transmission.parts();
        let ways = transmission.housing().ways();
        let explained = Self {
            parts: (0..parts.len()).filter(|i| fits(&parts[*i].path, 1)).collect(),
            ways: (0..ways.len()).filter(|i| fits(&ways[*i].path, 2)).collect(),
        };
        if !explained.parts.is_empty() || !explained.ways.is_empty() {
            return Ok(explained);
        }
        let paths: Vec<&str> = parts.iter().map(|part| part.path.as_str()).collect();
        let ids: Vec<&str> = paths.iter().filter_map(|path| path.split('.').nth(1)).collect();
        let help = match did_you_mean(name, paths.iter().chain(&ids).copied()) {
            Some(close) => format!("write {close}"),
            None => format!("write one of {}", paths.join(", ")),
        };
        Err(Diagnostic::error("", format!("there is no component `{name}`")).help(help))
    }

    /// The text at a solved point.
    pub fn text(
        &self,
        (gearbox, resolved, transmission): (&Gearbox, &Resolved, &Transmission),
        ratings: &Ratings,
        prepared: &PreparedPoint,
        solved: &SolvedPoint<'_>,
    ) -> String {
        let found = &solved.found;
        let at = format!("oil {} °C", figures(found.oil, 4));
        let mut text = heading(transmission, prepared, &at) + "\n";
        text += &ports_text(transmission, &solved.solution);
        if let Some(locking) = &solved.locking {
            text = text + &locking_text(locking) + "\n";
        }
        if found.outcome().is_some() {
            text = text + &temperature_text(transmission, found) + "\n";
        }
        text += &oil_level_text(solved.solution.oil_levels());
        for way in &self.ways {
            let surface = found.balance.as_ref().and_then(|b| b.surface).unwrap_or(found.oil);
            text += &explain_heat_path(transmission, gearbox, resolved, *way, (found.oil, surface));
        }
        let changed = changed_from_source(transmission, resolved);
        for part in &self.parts {
            text += &explain_part(transmission, gearbox, resolved, &solved.solution, *part, &changed);
            text += &explain_ratings(transmission, ratings, &solved.solution, *part);
        }
        text
    }
}
