//! Files of results.

use std::fs;
use std::path::Path;

use gearloss_framework::report::Figure;
use gearloss_framework::study::Write;
use serde_json::{Value, json};

use super::parquet::parquet;
use super::{Built, Runner};
use crate::output::Failure;

/// What stands at the head of every JSON result.
pub fn head(runner: &Runner<'_>, analysis: &str, built: &[&Built<'_>]) -> Value {
    let mut inputs = vec![json!({ "gearbox": null, "file": "study", "fnv1a_64": hash(runner.study.text.as_bytes()) })];
    for (name, gearbox) in &runner.study.gearboxes {
        for source in 0.. {
            let Some((file, text)) = gearbox.sources.get(source) else {
                break;
            };
            let file = Path::new(file).file_name().map_or(file, |f| f.to_str().unwrap_or(file));
            inputs.push(json!({ "gearbox": name, "file": file, "fnv1a_64": hash(text.as_bytes()) }));
        }
        for (file, text) in gearbox.files.all() {
            let file = file.file_name().and_then(|f| f.to_str()).unwrap_or_default().to_owned();
            inputs.push(json!({ "gearbox": name, "file": file, "fnv1a_64": hash(text.as_bytes()) }));
        }
    }
    for (file, hash) in runner.read.borrow().iter() {
        inputs.push(json!({ "gearbox": null, "file": file, "fnv1a_64": hash }));
    }
    let conditions = &runner.study.entry.conditions;
    json!({
        "format": "gearloss-result/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "packages": runner.language.registry().packages(),
        "study": runner.study.entry.title,
        "analysis": analysis,
        "conditions": {
            "torque_at": conditions.torque_at,
            "speed_at": conditions.speed_at,
            "oil_temperature_degc": conditions.oil_temperature,
            "power_flow": conditions.power_flow,
            "set": conditions.set,
        },
        "inputs": inputs,
        "unreached": built.iter().map(|b| json!({ "model_set": b.name, "lines": b.resolved.unreached })).collect::<Vec<_>>(),
    })
}

/// Writes a file beside its place and moves it there, so that nobody finds half of it.
pub fn whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    fs::write(&part, bytes)?;
    fs::rename(&part, path)
}

/// Writes a table as CSV and Parquet and a value as JSON, as asked.
pub fn write(
    runner: &Runner<'_>,
    name: &str,
    formats: &[Write],
    header: &[String],
    rows: &[Vec<String>],
    value: &Value,
) -> Result<(), Failure> {
    for format in formats {
        let (kind, bytes) = match format {
            Write::Csv => ("csv", csv(header, rows)),
            Write::Parquet => ("parquet", parquet(header, rows)),
            Write::Json => {
                let text = serde_json::to_string_pretty(value).map_err(|e| e.to_string());
                ("json", text.map(|text| (text + "\n").into_bytes()))
            }
            Write::Svg => continue,
        };
        keep(runner, &format!("{name}.{kind}"), bytes)?;
    }
    Ok(())
}

/// Puts a picture into the report, and writes it as a file where that is asked for.
pub fn picture(runner: &Runner<'_>, name: &str, figure: Figure, formats: &[Write]) -> Result<(), Failure> {
    if formats.contains(&Write::Svg) {
        // A product stands before its set with a slash.
        let file = format!("{}.svg", name.replace('/', "-"));
        keep(runner, &file, figure.svg().map(String::into_bytes))?;
    }
    runner.report.borrow_mut().figure(figure);
    Ok(())
}

/// Writes a file of results whole, or says why it could not.
pub fn keep(runner: &Runner<'_>, file: &str, bytes: Result<Vec<u8>, String>) -> Result<(), Failure> {
    let path = runner.folder.join(file);
    let failed = |e: String| {
        Failure::input(
            format!("cannot write {}: {e}", path.display()),
            "name another folder with -o",
        )
    };
    let bytes = bytes.map_err(failed)?;
    fs::create_dir_all(&runner.folder).map_err(|e| failed(e.to_string()))?;
    whole(&path, &bytes).map_err(|e| failed(e.to_string()))
}

fn csv(header: &[String], rows: &[Vec<String>]) -> Result<Vec<u8>, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(|e| e.to_string())?;
    for row in rows {
        writer.write_record(row).map_err(|e| e.to_string())?;
    }
    writer.into_inner().map_err(|e| e.to_string())
}

/// A cell: the number with all its digits, or nothing.
pub fn cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, |x| format!("{x}"))
}

/// FNV-1a, 64 bit: tells whether an input changed, no more.
pub fn hash(bytes: &[u8]) -> String {
    let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}
