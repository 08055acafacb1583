//! Warnings and notes about the gearboxes of a study.

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
        let mut changed = Vec::new();
        for (name, gearbox) in &self.gearboxes {
            let sets = self.sets_used_for(name);
            let named = sets.iter().filter_map(|set| set.rsplit('/').next());
            let mut known: Vec<String> = Vec::new();
            for (i, set) in std::iter::once(OWN_MODELS).chain(named).enumerate() {
                let Ok((resolved, transmission)) = self.built(language, gearbox, &self.choice(Some(set)), &[]) else {
                    continue;
                };
                let under = if set == OWN_MODELS {
                    String::new()
                } else {
                    format!(", models {set}")
                };
                for line in changed_from_source(&transmission, &resolved)
                    .iter()
                    .map(ToString::to_string)
                {
                    if !known.contains(&line) {
                        changed.push(format!("{name}{under}: {line}"));
                        known.push(line);
                    }
                }
                if i > 0 {
                    continue;
                }
                let without = resolved.unreached.iter().chain(&resolved.without);
                cautions.notes.extend(without.map(|line| format!("{name}: {line}")));
                if !transmission.warnings.is_empty() {
                    cautions.warnings.push(Findings {
                        list: transmission.warnings,
                        sources: gearbox.sources.clone(),
                    });
                }
            }
        }
        cautions.notes.extend(changed);
        cautions
    }
}
