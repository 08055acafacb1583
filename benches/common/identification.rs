//! An analysis `identify` of a study without the program around it: what times and comparisons of the solver have in common.

use std::path::Path;

use gearloss_framework::analysis::Rows;
use gearloss_framework::document::{Diagnostic, Sources, read_yaml};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::identify::{Faults, Identification};
use gearloss_framework::language::Language;
use gearloss_framework::measured::Measured;
use gearloss_framework::registry::Registry;
use gearloss_framework::resolve::Choice;
use gearloss_framework::study::{Analysis, Data, IdentifyEntry, StudyEntry};
use gearloss_plugins as _;
use serde_json::{Map, Value};

/// An analysis that is put beside those of a study: eight parameters that the rig of the two-speed example tells apart under its set `joint`, for that example's study: that set
/// has no seals, and a factor of its tooth friction would say the same as the roughness. All end between their bounds.
const ANALYSIS: &str = r#"
  eight:
    type: identify
    data: rig
    parameters:
      viscosity: { path: lubricants.sump.viscosity.factor, from: 0.4, to: 2.5, scale: log }
      roughness: { path: "gears.*.surface.rq", from: 0.1 um, to: 1 um }
      level: { path: housing.oil.level_offset, from: -20 mm, to: 20 mm }
      radial: { path: "bearings.*.radial_factor", from: 0.5, to: 2, scale: log }
      axial: { path: "bearings.*.axial_factor", from: 0.5, to: 2, scale: log }
      boundary: { path: "bearings.*.model.mu_bl", from: 0.05, to: 0.25 }
      torque_offset: { path: rig.torque_offset_in, from: -0.1 Nm, to: 0.1 Nm }
      rig_bearing: { path: rig.support_in.torque, from: 0 Nm, to: 0.06 Nm }
"#;

/// Where the analyses of a study begin.
const ANALYSES: &str = "\nanalyses:";

/// What an identification borrows.
pub struct Prepared {
    language: Language,
    study: StudyEntry,
    sets: Map<String, Value>,
    gearbox: Gearbox,
    measured: Measured,
    entry: IdentifyEntry,
}

impl Prepared {
    /// Reads an analysis `identify` of a study; `eight` is one that every study has, see [`ANALYSIS`].
    ///
    /// # Errors
    /// In the words of what found it.
    pub fn read(study: &Path, analysis: &str) -> Result<Self, String> {
        let rendered = |list: Vec<Diagnostic>, sources: &Sources| {
            let sources = sources.clone();
            Findings { list, sources }.render()
        };
        let bare = |list: Vec<Diagnostic>| rendered(list, &Sources::default());
        let language = Language::new(Registry::linked().map_err(bare)?).map_err(bare)?;
        let text = std::fs::read_to_string(study).map_err(|e| format!("cannot read {}: {e}", study.display()))?;
        let text = text.replacen(ANALYSES, &format!("{ANALYSES}{}", ANALYSIS.trim_end()), 1);
        let mut sources = Sources::default();
        let read = read_yaml(sources.add(study.display().to_string(), text.as_str()), &text);
        if !read.findings.is_empty() {
            return Err(rendered(read.findings, &sources));
        }
        let walked = language.walk_study(&read.node);
        if !walked.findings.is_empty() {
            return Err(rendered(walked.findings, &sources));
        }
        let sets = walked.value["model_sets"].as_object().cloned().unwrap_or_default();
        let study_entry: StudyEntry = serde_json::from_value(walked.value).map_err(|e| e.to_string())?;
        let Some(Analysis::Identify(entry)) = study_entry.analyses.get(analysis) else {
            return Err(format!("`{analysis}` is no analysis `identify` of {}", study.display()));
        };
        let entry = entry.clone();
        let folder = study.parent().unwrap_or(Path::new(""));
        let gearboxes = &study_entry.gearboxes;
        let file = match &entry.gearbox {
            Some(name) => gearboxes.get(name),
            None => gearboxes.iter().next().map(|(_, file)| file),
        };
        let file = file.ok_or("the gearbox of the analysis is not named")?;
        let gearbox = Gearbox::read(&language, &folder.join(file)).map_err(|findings| findings.render())?;
        let data = match &entry.data {
            Data::Own(data) => &**data,
            Data::Named(name) => study_entry.measurements.get(name).ok_or("the data are not named")?,
        };
        let bytes = std::fs::read(folder.join(&data.file)).map_err(|e| format!("cannot read {}: {e}", data.file))?;
        let bind: Vec<&str> = entry.bind.ids().collect();
        let measured = data
            .read(&bytes, &bind)
            .map_err(|fault| format!("{}: {}", data.file, fault.message))?;
        Ok(Self {
            language,
            study: study_entry,
            sets,
            gearbox,
            measured,
            entry,
        })
    }

    /// Its identification under one set of models.
    ///
    /// # Errors
    /// In the words of what found it.
    pub fn identification(&self, set: &str) -> Result<Identification<'_>, String> {
        let conditions = &self.study.conditions;
        let overrides = conditions.set.iter();
        let choice = Choice {
            set: Some(set.to_owned()),
            sets: self.sets.clone(),
            overrides: overrides
                .map(|(path, value)| (path.to_owned(), value.clone()))
                .collect(),
        };
        let rows = Rows {
            measured: &self.measured,
            bind: self.entry.bind.iter().map(|(_, path)| path.as_str()).collect(),
            gear: self.entry.gear.as_deref(),
            torque_at: &conditions.torque_at,
            speed_at: &conditions.speed_at,
            oil: conditions.oil_temperature,
            flow: conditions.power_flow,
            terms: false,
        };
        let (entries, residuals) = (self.entry.parameters.iter(), &self.entry.residuals);
        let made = Identification::new(&self.language, &self.gearbox, choice, rows, entries, residuals);
        made.map_err(|faults| match faults {
            Faults::Gearbox(findings) => findings.render(),
            Faults::Study(list) => {
                let words = list.iter().map(|found| format!("{}: {}", found.path, found.message));
                words.collect::<Vec<String>>().join("\n")
            }
        })
    }
}
