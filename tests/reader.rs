//! Parquet that the program writes, read by an independent reader and compared with the CSV of the same run.

use crate::common;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Version of the reader.
const READER: &str = "pyarrow==21.0.0";

/// The longest that pip may take.
const PATIENCE: Duration = Duration::from_mins(2);

/// Compares every cell; prints how many there are and how many of them are gaps.
const COMPARE: &str = r#"
import csv, sys
import pyarrow.parquet as parquet
table = parquet.read_table(sys.argv[1])
columns = [column.to_pylist() for column in table.columns]
cells = gaps = 0
with open(sys.argv[2], newline="") as file:
    rows = csv.reader(file)
    assert next(rows) == table.column_names, table.column_names
    for i, row in enumerate(rows):
        for text, column in zip(row, columns, strict=True):
            value = column[i]
            cells += 1
            if value is None:
                gaps += 1
                assert text == "", (i, text)
            elif isinstance(value, float):
                assert float(text) == value, (i, text, value)
            else:
                assert text == value, (i, text, value)
assert i + 1 == table.num_rows, (i + 1, table.num_rows)
print(table.num_rows, cells, gaps)
"#;

/// Folder with the reader for Python; installed at the first time and when its version has changed.
///
/// # Errors
/// Why there is none: no Python, no pip, no network.
fn reader() -> Result<PathBuf, String> {
    let found = Command::new("python3").args(["-m", "pip", "--version"]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        return Err("no python3 with pip; on Debian `apt-get install python3-pip` brings it".to_owned());
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("reader");
    // The last to be written, so that it tells what is installed in full.
    let installed = folder.join("installed");
    if std::fs::read_to_string(&installed).is_ok_and(|version| version == READER) {
        return Ok(folder);
    }
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let log = folder.join("pip.log");
    let mut pip = Command::new("python3")
        .args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
            "--only-binary=:all:",
        ])
        .args(["--retries=1", "--timeout=20", READER, "--target"])
        .arg(&folder)
        .stdout(Stdio::null())
        .stderr(File::create(&log).unwrap())
        .spawn()
        .map_err(|e| e.to_string())?;
    let end = Instant::now() + PATIENCE;
    let ended = loop {
        if let Some(status) = pip.try_wait().unwrap() {
            break status;
        }
        if Instant::now() > end {
            let _ = pip.kill();
            let _ = pip.wait();
            return Err(format!("pip took longer than {PATIENCE:?}"));
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    if !ended.success() {
        let words = std::fs::read_to_string(log).unwrap_or_default();
        return Err(format!("pip could not install {READER}:\n{words}"));
    }
    std::fs::write(installed, READER).unwrap();
    Ok(folder)
}

/// A map of several groups of rows, with names, gaps and bound values.
#[test]
fn another_reader_finds_the_cells_of_the_csv() {
    let reader = match reader() {
        Ok(reader) => reader,
        Err(why) => {
            // Past the capture of the test runner, so that everybody sees it.
            writeln!(
                std::io::stderr(),
                "SKIPPED: Parquet was not read by another reader: {why}"
            )
            .unwrap();
            return;
        }
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("reader");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let gearbox = common::file("examples/two-speed-ev/gearbox.yaml");
    let study = format!(
        "gearloss: study/1\ngearboxes: {{ ours: {} }}\nconditions: {{ torque_at: input, speed_at: input }}\ngrids:\n  field:\n    \
         gear: [first, second]\n    torque: {{ from: 0 Nm, to: 20 Nm, step: 0.05 Nm }}\n    speed: {{ from: 0 rpm, to: 22000 rpm, \
         step: 500 rpm }}\n    bind: {{ lubricants.sump.viscosity.kv100: [5 mm2/s, 6.4 mm2/s] }}\nanalyses:\n  map: {{ type: map, \
         grid: field, write: [csv, parquet] }}\n",
        gearbox.display()
    );
    std::fs::write(folder.join("study.yaml"), study).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .arg("run")
        .arg(folder.join("study.yaml"))
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let compared = Command::new("python3")
        .args(["-c", COMPARE])
        .args(["map.parquet", "map.csv"].map(|file| folder.join("results").join(file)))
        .env("PYTHONPATH", reader)
        .output()
        .unwrap();
    assert!(
        compared.status.success(),
        "{}",
        String::from_utf8_lossy(&compared.stderr)
    );
    let counts: Vec<usize> = String::from_utf8_lossy(&compared.stdout)
        .split_whitespace()
        .map(|n| n.parse().unwrap())
        .collect();
    // More rows than one group holds; at rest there is no efficiency.
    assert_eq!(counts[0], 4 * 401 * 45);
    assert!(
        counts[0] > 65_536 && counts[1] > 25 * counts[0] && counts[2] > 4 * 401,
        "{counts:?}"
    );
}
