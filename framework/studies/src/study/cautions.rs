//! What the gearboxes of a study give cause to say before it runs.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::gearbox::Findings;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::OWN_MODELS;

use super::Study;

/// Warnings and notes of the gearboxes of a study, under its conditions and with their own models.
#[derive(Debug, Default)]
pub struct Cautions {
    /// Warnings of building the gearboxes, by gearbox.
    pub warnings: Vec<Findings>,
    /// Components without a model, and coefficients that differ from their source.
    pub notes: Vec<String>,
}

impl Study {
    /// Warnings and notes of the gearboxes. A gearbox that cannot be built has none; the analyses that need it report why.
    pub fn cautions(&self, language: &Language) -> Cautions {
        let mut cautions = Cautions::default();
        for (name, gearbox) in &self.gearboxes {
            let Ok((resolved, transmission)) = self.built(language, gearbox, &self.choice(None), &[]) else {
                continue;
            };
            if !transmission.warnings.is_empty() {
                cautions.warnings.push(Findings {
                    list: transmission.warnings,
                    sources: gearbox.sources.clone(),
                });
            }
            let without = resolved.unreached.iter().chain(&resolved.without);
            cautions.notes.extend(without.map(|line| format!("{name}: {line}")));
        }
        cautions.notes.extend(self.changed_coefficients(language));
        cautions
    }

    /// A line for each coefficient with a value other than the published one, under the gearbox defaults or a model set of the analyses.
    fn changed_coefficients(&self, language: &Language) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for (name, gearbox) in &self.gearboxes {
            let mut known: Vec<String> = Vec::new();
            let sets = self.sets_used_for(name);
            let named = sets.iter().filter_map(|set| set.rsplit('/').next());
            for set in std::iter::once(OWN_MODELS).chain(named) {
                let set = Some(set).filter(|set| *set != OWN_MODELS);
                let Ok((resolved, transmission)) = self.built(language, gearbox, &self.choice(set), &[]) else {
                    continue;
                };
                let under = set.map_or_else(String::new, |set| format!(", models {set}"));
                for changed in changed_from_source(&transmission, &resolved)
                    .iter()
                    .map(ToString::to_string)
                {
                    if !known.contains(&changed) {
                        lines.push(format!("{name}{under}: {changed}"));
                        known.push(changed);
                    }
                }
            }
        }
        lines
    }
}
