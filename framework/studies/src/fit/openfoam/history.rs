//! All samples of a run, from the files that the solver writes at each of its starts.

use std::path::{Path, PathBuf};

use gearloss_framework::files::{LONGEST_DATA, read_text};

use super::{Sample, samples};

/// All samples of a run: from a file, or from a folder with one subfolder for each start of the solver. Samples of a later start replace
/// earlier samples at the same times.
///
/// # Errors
/// The file that cannot be read, and why.
pub fn history(place: &Path) -> Result<Vec<Sample>, String> {
    let files = if place.is_file() {
        vec![place.to_path_buf()]
    } else {
        files(place)?
    };
    let mut all: Vec<Sample> = Vec::new();
    for file in files {
        let text = read_text(&file, LONGEST_DATA).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
        let samples = samples(&text).map_err(|fault| format!("{}, {fault}", file.display()))?;
        if let Some(first) = samples.first() {
            all.retain(|s| s.time < first.time);
        }
        all.extend(samples);
    }
    Ok(all)
}

fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let own = |folder: &Path| {
        ["moment.dat", "forces.dat"]
            .map(|name| folder.join(name))
            .into_iter()
            .find(|file| file.is_file())
    };
    if let Some(file) = own(folder) {
        return Ok(vec![file]);
    }
    let entries = std::fs::read_dir(folder).map_err(|e| format!("cannot read: {e}"))?;
    let mut starts: Vec<(f64, PathBuf)> = entries
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let time = path.file_name()?.to_str()?.parse::<f64>().ok()?;
            Some((time, own(&path)?))
        })
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    if starts.is_empty() {
        return Err("no moment.dat or forces.dat in the folder or in its time folders".to_owned());
    }
    Ok(starts.into_iter().map(|(_, file)| file).collect())
}
