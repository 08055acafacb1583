//! `import`: tables from files of other programs.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use gearloss_framework::document::{Unit, parse_quantity};
use gearloss_framework::files::{LONGEST_DATA, LONGEST_TEXT, read_text};
use gearloss_framework::mechanism::Mechanism;
use gearloss_framework::mechanism::planetary_drag::PlanetaryDrag;
use gearloss_framework::table::{Reading, Table as Csv};

use crate::args::{AxisArg, ImportArgs, ImportFrom};
use crate::output::{End, Failure, Out, Table, significant};
use gearloss_studies::fit::openfoam::{Mean, Sample, samples};

pub fn run(args: &ImportArgs, out: &mut Out) -> Result<End, Failure> {
    let ImportFrom::OpenfoamForces {
        runs,
        axis,
        from,
        to,
        factor,
        output,
    } = &args.from;
    if !(factor.is_finite() && *factor > 0.0) {
        return Err(Failure::input(format!("--factor {factor}"), "give a positive number"));
    }
    let from = seconds("--from", from)?;
    let to = match to {
        Some(to) => seconds("--to", to)?,
        None => f64::INFINITY,
    };
    let window = [from, to];
    let text = super::read_file(runs, LONGEST_TEXT, "check the file name")?;
    let list = Runs::read(&text).map_err(|fault| {
        Failure::input(
            format!("{}: {fault}", runs.display()),
            "write a column `name [unit]` for each axis and `folder` as the last column",
        )
    })?;
    let beside = runs.parent().unwrap_or(Path::new(""));
    let mut means = Vec::new();
    for run in &list.runs {
        let folder = beside.join(&run.folder);
        let told = |fault: &dyn std::fmt::Display, help: &str| {
            Failure::input(
                format!("{}, line {}: {}: {fault}", runs.display(), run.line, folder.display()),
                help,
            )
        };
        let samples = history(&folder).map_err(|fault| {
            told(
                &fault,
                "give the folder under `postProcessing` with the output of the function object",
            )
        })?;
        let mean = Mean::over_time(&samples, *axis as usize, window)
            .map_err(|fault| told(&fault, "choose --from and --to within the times of the run"))?;
        means.push(mean.times(*factor));
    }
    // Drag opposes the motion, so all moments have the same sign.
    let sign = means.first().map_or(1.0, |m: &Mean| m.total().signum());
    if let Some((run, mean)) = list.runs.iter().zip(&means).find(|(_, m)| m.total() * sign <= 0.0) {
        return Err(Failure::input(
            format!(
                "{}, line {}: the mean moment about {} is {} Nm, whose sign differs from the first run",
                runs.display(),
                run.line,
                axis.name(),
                significant(mean.total())
            ),
            "check --axis, the sense of rotation and --from",
        ));
    }
    let table = list.table(&means, sign, *axis, window);
    readable(&table, list.axes.len()).map_err(|fault| {
        Failure::input(
            format!("{}: the runs do not form a table: {fault}", runs.display()),
            "give one run for each point of a full grid, with quantities and units as names of the axes",
        )
    })?;
    write_new(output, &table)?;
    let mut printed = Table::new(&["folder", "samples", "until s", "pressure Nm", "viscous Nm", "spread Nm"]);
    for (run, mean) in list.runs.iter().zip(&means) {
        printed.row(vec![
            run.folder.clone(),
            mean.samples.to_string(),
            significant(mean.until),
            significant(sign * mean.pressure),
            significant(sign * mean.viscous),
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

/// The table must be valid for a drag model: full grid, known axes and units.
fn readable(table: &str, axes: usize) -> Result<(), String> {
    let read = Csv::several_from_csv(table, &Reading::default(), axes)?;
    for axis in read.iter().flat_map(Csv::axes) {
        let Some(quantity) = PlanetaryDrag::QUANTITIES.iter().find(|q| q.name == axis.name) else {
            let names: Vec<&str> = PlanetaryDrag::QUANTITIES.iter().map(|q| q.name).collect();
            return Err(format!(
                "`{}` is not a known quantity; known: {}",
                axis.name,
                names.join(", ")
            ));
        };
        if quantity.unit().symbol != axis.unit {
            return Err(format!(
                "`{}` is in {}, not in {}",
                axis.name,
                axis.unit,
                quantity.unit().symbol
            ));
        }
    }
    Ok(())
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

/// One run: coordinates as text, folder, line.
struct Run {
    point: Vec<String>,
    folder: String,
    line: u64,
}

struct Runs {
    axes: Vec<String>,
    runs: Vec<Run>,
}

impl Runs {
    fn read(text: &str) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| e.to_string())?.clone();
        let axes: Vec<String> = header.iter().map(str::to_owned).collect();
        let Some((last, axes)) = axes.split_last().filter(|(_, axes)| !axes.is_empty()) else {
            return Err("line 1: too few columns".to_owned());
        };
        if last != "folder" {
            return Err(format!("line 1: the last column is `{last}`, not `folder`"));
        }
        let mut runs = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| e.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut point: Vec<String> = record.iter().map(str::to_owned).collect();
            let folder = point.pop().unwrap_or_default();
            for (column, (cell, name)) in point.iter().zip(axes).enumerate() {
                if cell.parse::<f64>().ok().is_none_or(|x| !x.is_finite()) {
                    return Err(format!(
                        "line {line}, column {} `{name}`: `{cell}` is not a number",
                        column + 1
                    ));
                }
            }
            runs.push(Run { point, folder, line });
        }
        if runs.is_empty() {
            return Err("line 1: no runs below the header".to_owned());
        }
        Ok(Self {
            axes: axes.to_vec(),
            runs,
        })
    }

    /// The table with its points in ascending order of the axes.
    fn table(&self, means: &[Mean], sign: f64, axis: AxisArg, window: [f64; 2]) -> String {
        let mut text = format!(
            "# Means of OpenFOAM moments about {} from {} s{}.\n",
            axis.name(),
            window[0],
            if window[1].is_finite() {
                format!(" to {} s", window[1])
            } else {
                String::new()
            }
        );
        let _ = writeln!(text, "{},pressure [Nm],viscous [Nm]", self.axes.join(","));
        let key = |run: &Run| {
            run.point
                .iter()
                .filter_map(|x| x.parse::<f64>().ok())
                .collect::<Vec<f64>>()
        };
        let mut order: Vec<usize> = (0..self.runs.len()).collect();
        order.sort_by(|a, b| {
            let (a, b) = (key(&self.runs[*a]), key(&self.runs[*b]));
            a.iter()
                .zip(&b)
                .map(|(a, b)| a.total_cmp(b))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        for i in order {
            let _ = writeln!(
                text,
                "{},{},{}",
                self.runs[i].point.join(","),
                sign * means[i].pressure,
                sign * means[i].viscous
            );
        }
        text
    }
}
