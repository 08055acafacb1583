//! `import openfoam-forces`: a table from results of OpenFOAM.

use std::path::{Path, PathBuf};

use gearloss_framework::document::{Diagnostic, Unit, parse_quantity};
use gearloss_framework::files::{LONGEST_DATA, LONGEST_TEXT, read_text};
use gearloss_studies::fit::openfoam::{Axis, Mean, Runs, Sample, samples};

use crate::args::{AxisArg, ImportFrom};
use crate::output::{End, Failure, Out, Table, significant};

pub fn run(from: &ImportFrom, out: &mut Out) -> Result<End, Failure> {
    let ImportFrom::OpenfoamForces {
        runs,
        axis,
        from,
        to,
        factor,
        output,
    } = from
    else {
        return Err(Failure::input("bug: another import was called", "report this"));
    };
    if !(factor.is_finite() && *factor > 0.0) {
        return Err(Failure::input(format!("--factor {factor}"), "give a positive number"));
    }
    let from = seconds("--from", from)?;
    let to = match to {
        Some(to) => seconds("--to", to)?,
        None => f64::INFINITY,
    };
    let window = [from, to];
    let axis = match axis {
        AxisArg::X => Axis::X,
        AxisArg::Y => Axis::Y,
        AxisArg::Z => Axis::Z,
    };
    let text = super::super::read_file(runs, LONGEST_TEXT, "check the file name")?;
    let in_list = |fault: Diagnostic| Diagnostic {
        message: format!("{}: {}", runs.display(), fault.message),
        ..fault
    };
    let list = Runs::from_text(&text).map_err(in_list)?;
    let beside = runs.parent().unwrap_or(Path::new(""));
    let mut means = Vec::new();
    for run in list.runs() {
        let folder = beside.join(&run.folder);
        let failed = |fault: &dyn std::fmt::Display, help: &str| {
            Failure::input(
                format!("{}, line {}: {}: {fault}", runs.display(), run.line, folder.display()),
                help,
            )
        };
        let samples = history(&folder).map_err(|fault| {
            failed(
                &fault,
                "give the folder under `postProcessing` with the output of the function object",
            )
        })?;
        let mean = Mean::over_time(&samples, axis, window)
            .map_err(|fault| failed(&fault, "choose --from and --to within the times of the run"))?;
        means.push(mean.times(*factor));
    }
    let means = list.opposing(means, axis).map_err(in_list)?;
    let table = list.table(&means, axis, window).map_err(in_list)?;
    write_new(output, &table)?;
    let mut printed = Table::new(&["folder", "samples", "until s", "pressure Nm", "viscous Nm", "spread Nm"]);
    for (run, mean) in list.runs().iter().zip(&means) {
        printed.row(vec![
            run.folder.clone(),
            mean.samples.to_string(),
            significant(mean.until),
            significant(mean.pressure),
            significant(mean.viscous),
            significant(mean.spread),
        ]);
    }
    out.text(&printed.render())?;
    out.line(format!("wrote {}", output.display()))?;
    Ok(End::Fine)
}

/// All samples of a run: from a file, or from a folder with one subfolder for each start of the solver. Samples of a later start replace
/// earlier samples at the same times.
fn history(place: &Path) -> Result<Vec<Sample>, String> {
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

fn seconds(option: &str, text: &str) -> Result<f64, Failure> {
    let unit = Unit::of_symbol("s").unwrap_or(Unit::ONE);
    parse_quantity(text.trim(), unit).map_err(|fault| {
        Failure::input(
            format!("{option} \"{text}\": {}", fault.message),
            fault
                .help
                .unwrap_or_else(|| "write a time such as \"0.5 s\"".to_owned()),
        )
    })
}

fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    use std::io::Write as _;
    let file = std::fs::OpenOptions::new().write(true).create_new(true).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|e| {
        Failure::input(
            format!("cannot write {}: {e}", path.display()),
            "choose another file with -o; an existing file is not overwritten",
        )
    })
}
