//! Documents and tables that were changed at random: no command panics, hangs, takes much memory or answers with what is no number.
//!
//! 400 cases in two processes, 2000 in `.ci/full`; `FUZZ_CASES=1000000 FUZZ_SEED=5 FUZZ_PROCESSES=2 cargo test --release --test all fuzz:: -- --nocapture`
//! runs more or others. `FUZZ_ONE=123 cargo test --test all fuzz:: -- --nocapture` writes the files of one case and prints its command.
//!
//! Cases run inside of the test binary, which is begun again as a process of its own: so one that ends it costs one case. On Unix
//! `ulimit -v` bounds what it may ask for; on Linux the most memory of each case is read from `/proc`.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod cases;
mod mutate;
pub mod random;
mod tables;
mod tree;
mod worker;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::time::Instant;

use gearloss_plugins as _;

use worker::Cases;

/// A number that the environment gives.
fn given(key: &str) -> Option<u64> {
    std::env::var(key).ok()?.parse().ok()
}

fn seed() -> u64 {
    given("FUZZ_SEED").unwrap_or(27)
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The process that runs cases. It is no test of its own: without an order it has nothing to do.
#[test]
fn worker() {
    let Some(folder) = std::env::var_os("FUZZ_FOLDER") else {
        return;
    };
    let [first, end, stride] = ["FUZZ_FIRST", "FUZZ_END", "FUZZ_STRIDE"].map(|key| given(key).unwrap());
    let cases = Cases {
        seed: seed(),
        first,
        end,
        stride,
    };
    worker::run(&cases, Path::new(&folder));
}

/// This program as a worker.
fn begin(folder: &Path, [first, end, stride]: [u64; 3]) -> ExitStatus {
    let program = std::env::current_exe().unwrap();
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        // In kB: room for threads and what is asked for and not used.
        shell.args(["-c", "ulimit -v 3000000; exec \"$0\" \"$@\""]).arg(program);
        shell
    } else {
        Command::new(program)
    };
    let open = |name: &str| {
        File::options()
            .create(true)
            .append(true)
            .open(folder.join(name))
            .unwrap()
    };
    command
        .args(["--exact", "fuzz::worker", "--nocapture"])
        .env("FUZZ_FOLDER", folder)
        .env("FUZZ_FIRST", first.to_string())
        .env("FUZZ_END", end.to_string())
        .env("FUZZ_STRIDE", stride.to_string())
        .env("RAYON_NUM_THREADS", "1")
        .stdout(open("out"))
        .stderr(open("err"));
    command.status().unwrap()
}

/// Cases of one process, which is begun again behind each that ended it.
fn all_of(folder: &Path, mut first: u64, end: u64, stride: u64) -> String {
    let log = folder.join("log");
    let mut ended = 0;
    while first < end {
        let status = begin(folder, [first, end, stride]);
        let text = fs::read_to_string(&log).unwrap_or_default();
        if status.success() {
            break;
        }
        let last = text
            .lines()
            .last()
            .and_then(|line| line.split(' ').next()?.parse::<u64>().ok());
        let err = fs::read_to_string(folder.join("err")).unwrap_or_default();
        let word = err.lines().last().unwrap_or_default();
        fs::write(&log, format!("{text}? ? 0 0 ended the process, {status}: {word}\n")).unwrap();
        ended += 1;
        match last {
            Some(last) if ended < 20 => first = last + stride,
            _ => break,
        }
    }
    fs::read_to_string(&log).unwrap_or_default()
}

#[test]
fn changed_documents_are_refused_or_answered() {
    if std::env::var_os("FUZZ_FOLDER").is_some() {
        return;
    }
    if let Some(number) = given("FUZZ_ONE") {
        let folder = folder(&format!("case-{number}"));
        let case = cases::Sound::read(Path::new(env!("CARGO_MANIFEST_DIR"))).case(seed(), number);
        worker::lay_out(&case, &folder);
        println!("cd {}; gearloss {}", folder.display(), case.command.join(" "));
        return;
    }
    let count = given("FUZZ_CASES").unwrap_or(400);
    let processes = given("FUZZ_PROCESSES").unwrap_or(2);
    let start = Instant::now();
    let logs: Vec<String> = std::thread::scope(|scope| {
        let begun: Vec<_> = (0..processes)
            .map(|k| {
                let folder = folder(&format!("seed-{}-process-{k}", seed()));
                scope.spawn(move || all_of(&folder, k, count, processes))
            })
            .collect();
        begun.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    // Number of each command and exit code.
    let mut ends: BTreeMap<(String, String), usize> = BTreeMap::new();
    let (mut longest, mut most, mut done, mut wrong) = ((0, 0), (0, 0), 0, Vec::new());
    for line in logs.iter().flat_map(|log| log.lines()) {
        let [number, command, code, time, memory, words] = line.splitn(6, ' ').collect::<Vec<_>>()[..] else {
            wrong.push(line.to_owned());
            continue;
        };
        let [number, time, memory] = [number, time, memory].map(|word| word.parse::<u64>().unwrap_or(0));
        *ends.entry((command.to_owned(), code.to_owned())).or_default() += 1;
        longest = longest.max((time, number));
        most = most.max((memory, number));
        done += 1;
        if !words.is_empty() {
            wrong.push(line.to_owned());
        }
    }
    println!(
        "{done} cases of seed {} in {:.0} s",
        seed(),
        start.elapsed().as_secs_f64()
    );
    println!(
        "longest: {} ms of the processor, case {}; most memory: {} MB, case {}",
        longest.0,
        longest.1,
        most.0 / 1000,
        most.1
    );
    for ((command, code), count) in &ends {
        println!("  {command}, exit code {code}: {count}");
    }
    assert!(wrong.is_empty(), "FUZZ_ONE=NUMBER shows a case:\n{}", wrong.join("\n"));
    assert_eq!(done, count, "cases are missing");
    // Cases that say nothing would test nothing: of each command some are answered and some refused.
    for command in ["check", "solve", "run", "eval", "import", "fit"] {
        for code in ["0", "2"] {
            let found = ends.contains_key(&(command.to_owned(), code.to_owned()));
            assert!(found || count < 400, "no {command} ended with {code}");
        }
    }
}
