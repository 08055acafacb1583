//! A map of 100 x 100 points under both sets of the two-speed example, report included: the program as a whole, and its memory.
#![allow(clippy::unwrap_used, missing_docs)]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::common::example;
use criterion::{Criterion, Throughput, criterion_group};

/// The study of the example with a fine grid and a map of the sets `iso` and `joint` in place of its analyses.
fn study(folder: &Path) -> PathBuf {
    let example = example("two-speed-ev");
    let text = std::fs::read_to_string(example.join("study.yaml")).unwrap();
    let (head, _) = text.split_once("\nmeasurements:").unwrap();
    let head = head.replace("gearbox.yaml", example.join("gearbox.yaml").to_str().unwrap());
    // Without the analyses of the example there is nothing that answers its question.
    let head: String = head
        .split_inclusive('\n')
        .filter(|line| !line.starts_with("answered_by"))
        .collect();
    let fine = "
grids:
  fine: { gear: first, torque: { from: 0.2 Nm, to: 20 Nm, step: 0.2 Nm }, speed: { from: 220 rpm, to: 22000 rpm, step: 220 rpm } }
analyses:
  maps: { type: map, grid: fine, model_sets: [iso, joint], write: [csv, json] }
";
    let path = folder.join("study.yaml");
    std::fs::write(&path, head + fine).unwrap();
    path
}

fn command(study: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gearloss"));
    command.arg("run").arg(study).stdout(Stdio::null());
    command
}

/// The most memory that a run held, where the system tells it. \[MB\]
fn memory(study: &Path) -> Option<f64> {
    let mut child = command(study).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut most = None;
    while child.try_wait().unwrap().is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let held = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
        most = held.map(|kb| kb / 1024.0).or(most);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    most
}

fn map(c: &mut Criterion) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bench-map");
    std::fs::create_dir_all(&folder).unwrap();
    let study = study(&folder);
    let mut group = c.benchmark_group("map");
    group.sample_size(10).throughput(Throughput::Elements(2 * 100 * 100));
    group.bench_function("100 x 100 points of two sets, with CSV, JSON and report", |b| {
        b.iter(|| assert!(command(&study).status().unwrap().success()));
    });
    group.finish();
    if let Some(megabytes) = memory(&study) {
        // Beside the times, where the reader of a bench looks.
        std::io::Write::write_fmt(&mut std::io::stdout(), format_args!("peak memory: {megabytes:.0} MB\n")).unwrap();
    }
}

criterion_group!(benches, map);
