//! Instructions of eight pieces of work, counted by callgrind: unlike times they do not depend on what else the machine does, so that a
//! change of one per cent is seen. They are compared with `counts.csv`; with `UPDATE=1` they are written there. They depend on the compiler and
//! on the width of registers, which is limited to AVX2, the widest that callgrind knows.

mod pieces;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

/// Calls of a piece whose difference is counted: what a program does once drops out.
const CALLS: [u32; 2] = [2, 6];

/// Share by which a count may differ from the committed one: tables of hashed names have other collisions in each run.
const SHARE: f64 = 0.01;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [name, calls] = &arguments[..]
        && let Ok(calls) = calls.parse()
    {
        pieces::run(name, calls);
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind")
        .arg("--version")
        .stdout(Stdio::null())
        .status()
        .is_err()
    {
        say("valgrind is not installed\n");
        return ExitCode::FAILURE;
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("counts.csv");
    let committed = std::fs::read_to_string(&file).unwrap_or_default();
    let (mut table, mut same) = (
        String::from("piece,instructions,elements,instructions per element\n"),
        true,
    );
    for piece in &pieces::PIECES {
        let [few, many] = CALLS.map(|calls| count(piece.name, calls));
        let one = (many - few) / u64::from(CALLS[1] - CALLS[0]);
        let each = one / u64::from(piece.elements);
        let _ = writeln!(table, "{},{one},{},{each}", piece.name, piece.elements);
        let before = committed
            .lines()
            .find_map(|line| line.strip_prefix(piece.name)?.strip_prefix(','));
        let before = before.and_then(|rest| rest.split(',').next()?.parse::<f64>().ok());
        let ratio = before.map_or(f64::NAN, |before| one as f64 / before);
        same &= (ratio - 1.0).abs() <= SHARE;
        say(&format!(
            "{:<15} {each:>12} instructions per {}, {ratio:.4} of the committed count\n",
            piece.name, piece.element
        ));
    }
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&file, table).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        return ExitCode::SUCCESS;
    }
    if same {
        return ExitCode::SUCCESS;
    }
    say("a count has changed: find out why; with `UPDATE=1` the new ones are written\n");
    ExitCode::FAILURE
}

/// Instructions of a process that does a piece some times.
fn count(piece: &str, calls: u32) -> u64 {
    let me = std::env::current_exe().unwrap_or_else(|error| panic!("{error}"));
    let out = std::env::temp_dir().join(format!("callgrind-{}-{piece}-{calls}", std::process::id()));
    let done = Command::new("valgrind")
        .args(["--tool=callgrind", "--quiet"])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(me)
        .args([piece, &calls.to_string()])
        .envs([("GEARLOSS_REGISTERS", "avx2"), ("RAYON_NUM_THREADS", "1")])
        .stdout(Stdio::null())
        .status();
    assert!(done.is_ok_and(|done| done.success()), "{piece}: callgrind failed");
    let text = std::fs::read_to_string(&out).unwrap_or_default();
    let _ = std::fs::remove_file(&out);
    let totals = text.lines().find_map(|line| line.strip_prefix("totals: "));
    totals
        .and_then(|totals| totals.trim().parse().ok())
        .unwrap_or_else(|| panic!("{}: no totals", out.display()))
}

fn say(words: &str) {
    let _ = std::io::stdout().write_all(words.as_bytes());
}
