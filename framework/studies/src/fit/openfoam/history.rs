//! All samples of a run, from the files that the solver writes at each of its starts.

use std::path::{Path, PathBuf};

use gearloss_framework::files::{LONGEST_DATA, read_text};

use super::{Frame, MomentsError, Sample, samples};

/// Help for a place without files of moments.
const NAME_THE_FOLDER: &str = "give the folder under `postProcessing` with the output of the function object";

/// Why a run has no samples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct HistoryFault {
    /// What is wrong, with the file.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

fn fault(message: String) -> HistoryFault {
    HistoryFault {
        message,
        help: NAME_THE_FOLDER.to_owned(),
    }
}

/// All samples of a run: from a file, or from a folder with one subfolder for each start of the solver. Samples of a later start replace
/// earlier samples at the same times.
///
/// # Errors
/// The file that cannot be read, and why.
pub fn history(place: &Path, frame: Frame) -> Result<Vec<Sample>, HistoryFault> {
    let files = if place.is_file() {
        vec![place.to_path_buf()]
    } else {
        files(place, frame)?
    };
    let mut all: Vec<Sample> = Vec::new();
    for file in files {
        let text = read_text(&file, LONGEST_DATA).map_err(|e| fault(format!("cannot read {}: {e}", file.display())))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let samples = samples(&text, &name, frame).map_err(|error| {
            let help = match moments_beside(&file, &name).filter(|_| error == MomentsError::Forces) {
                Some(beside) => format!("the moments are beside it: name {}", beside.display()),
                None => error.help().to_owned(),
            };
            let message = format!("{}, {error}", file.display());
            HistoryFault { message, help }
        })?;
        if let Some(first) = samples.first() {
            all.retain(|s| s.time < first.time);
        }
        all.extend(samples);
    }
    Ok(all)
}

/// The file of moments that openfoam.com writes beside one of forces.
fn moments_beside(file: &Path, name: &str) -> Option<PathBuf> {
    let rest = name.strip_prefix("force")?;
    let beside = file.with_file_name(format!("moment{rest}"));
    let written = file.with_file_name("moment.dat");
    [beside, written].into_iter().find(|file| file.is_file())
}

fn files(folder: &Path, frame: Frame) -> Result<Vec<PathBuf>, HistoryFault> {
    let names: &[&str] = match frame {
        Frame::Global => &["moment.dat", "forces.dat"],
        Frame::Local => &["localMoment.dat", "moment.dat", "forces.dat"],
    };
    let file_in = |folder: &Path| {
        let mut files = names.iter().map(|name| folder.join(name));
        files.find(|file| file.is_file())
    };
    if let Some(file) = file_in(folder) {
        return Ok(vec![file]);
    }
    let entries = std::fs::read_dir(folder).map_err(|e| fault(format!("cannot read: {e}")))?;
    let mut starts: Vec<(f64, PathBuf)> = entries
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let time = path.file_name()?.to_str()?.parse::<f64>().ok()?;
            Some((time, file_in(&path)?))
        })
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    if starts.is_empty() {
        let names = names.join(" or ");
        return Err(fault(format!("no {names} in the folder or in its time folders")));
    }
    Ok(starts.into_iter().map(|(_, file)| file).collect())
}
