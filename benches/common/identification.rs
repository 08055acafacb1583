//! An analysis `identify` of a study without the program around it: what times and comparisons of the solver have in common.

use std::error::Error;
use std::path::Path;

use gearloss_framework::language::Language;
use gearloss_plugins as _;
use gearloss_studies::analyses::identify::IdentifyEntry;
use gearloss_studies::identify::Identification;
use gearloss_studies::measured::Measured;
use gearloss_studies::study::Study;

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
    study: Study,
    measured: Measured,
    entry: IdentifyEntry,
}

impl Prepared {
    /// Reads an analysis `identify` of a study; `eight` is one that every study has, see [`ANALYSIS`].
    ///
    /// # Errors
    /// In the words of what found it.
    pub fn read(study: &Path, analysis: &str) -> Result<Self, Box<dyn Error>> {
        let language = Language::linked()?;
        let text = std::fs::read_to_string(study)?;
        let text = text.replacen(ANALYSES, &format!("{ANALYSES}{}", ANALYSIS.trim_end()), 1);
        let folder = study.parent().unwrap_or(Path::new(""));
        let study = Study::of_text(&language, text, &study.display().to_string(), folder)?;
        let Some(entry) = study
            .entry
            .analyses
            .get(analysis)
            .and_then(|analysis| analysis.entry::<IdentifyEntry>())
        else {
            return Err(format!("`{analysis}` is no analysis `identify` of the study").into());
        };
        let entry = entry.clone();
        let bind: Vec<&str> = entry.bind.ids().collect();
        let data = entry.data.as_ref().ok_or("the identification has no data")?;
        let (measured, _) = study.measured("data", data, &bind)?;
        Ok(Self {
            language,
            study,
            measured,
            entry,
        })
    }

    /// Its identification under one set of models.
    ///
    /// # Errors
    /// In the words of what found it.
    pub fn identification(&self, set: &str) -> Result<Identification<'_>, Box<dyn Error>> {
        let (study, entry) = (&self.study, &self.entry);
        let (_, gearbox) = study.gearbox("gearbox", entry.gearbox.as_ref())?;
        let rows = study.rows(&self.measured, &entry.bind, entry.gear.as_deref(), false);
        let (choice, parameters) = (study.choice(Some(set)), entry.parameters.iter());
        let made = Identification::new(&self.language, gearbox, choice, rows, parameters, &entry.residuals);
        Ok(made?)
    }
}
