//! What runs cases: a process of its own, so that it may be ended when it takes too long or too much.

use std::fs::{self, File};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::cases::{Case, Sound};

/// The longest that a case may use the processor; the slowest sound one takes two seconds in the test profile.
pub const MOST_TIME: Duration = Duration::from_secs(30);

/// The longest that it may take, busy or not, on a machine that has other things to do.
pub const MOST_WAIT: Duration = Duration::from_mins(5);

/// The most memory that the process may hold during a case. \[kB\]
pub const MOST_MEMORY: u64 = 600_000;

/// Cases of a worker.
pub struct Cases {
    pub seed: u64,
    pub first: u64,
    pub end: u64,
    pub stride: u64,
}

/// Runs cases, with a line of the log for each: number, command, exit code, milliseconds, memory, and what is wrong. A line that has
/// the number alone is that of a case that ended the process.
pub fn run(cases: &Cases, folder: &Path) {
    let sound = Sound::read(Path::new(env!("CARGO_MANIFEST_DIR")));
    let work = folder.join("case");
    let _ = fs::remove_dir_all(&work);
    fs::create_dir_all(&work).unwrap();
    std::env::set_current_dir(&work).unwrap();
    let mut log = File::options()
        .create(true)
        .append(true)
        .open(folder.join("log"))
        .unwrap();
    let mut printed = ["out", "err"].map(|name| Printed::from_path(folder.join(name)));
    let began = Arc::new(Mutex::new((Instant::now(), Duration::ZERO)));
    watch(Arc::clone(&began));
    for number in (cases.first..cases.end).step_by(cases.stride as usize) {
        write!(log, "{number} ").unwrap();
        let case = sound.case(cases.seed, number);
        lay_out(&case, Path::new("."));
        reset_peak();
        let now = processor();
        *began.lock().unwrap() = (Instant::now(), now);
        let code = gearloss::call(std::iter::once("gearloss".into()).chain(case.command.iter().map(Into::into)));
        let time = processor().saturating_sub(now).as_millis();
        let [out, err] = printed.each_mut().map(Printed::new_text);
        let memory = status("VmHWM:").unwrap_or(0);
        let wrong = wrong(&case, code, &out, &err, memory);
        writeln!(log, "{} {code} {time} {memory} {wrong}", case.command[0]).unwrap();
    }
}

/// Writes the files of a case into a folder, in place of those of the last one.
pub fn lay_out(case: &Case, folder: &Path) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            fs::remove_dir_all(path).unwrap();
        } else {
            fs::remove_file(path).unwrap();
        }
    }
    for (name, text) in &case.files {
        let file = folder.join(name);
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).unwrap();
        }
        fs::write(file, text).unwrap();
    }
}

/// What is wrong with how a case went; empty if nothing is.
fn wrong(case: &Case, code: u8, out: &str, err: &str, memory: u64) -> String {
    let mut wrong = Vec::new();
    if !(0..=2).contains(&code) {
        wrong.push(format!("exit code {code}: {:.300}", err.replace('\n', " | ")));
    }
    if code == 2 && !err.contains("error") {
        wrong.push("refused without a word".to_owned());
    }
    if err.len() > 1 << 20 {
        wrong.push(format!("{} bytes of errors", err.len()));
    }
    if memory > MOST_MEMORY {
        wrong.push("too much memory".to_owned());
    }
    // What a document says of itself may hold any word.
    let said = case.files.values().any(|text| words(text).any(is_no_number));
    let mut written = vec![out.to_owned()];
    for entry in fs::read_dir("results").into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|kind| kind == "csv") {
            written.push(fs::read_to_string(&path).unwrap_or_default());
        }
        if path.extension().is_some_and(|kind| kind == "part") {
            wrong.push(format!("{} is left", path.display()));
        }
    }
    if code < 2 && !said && written.iter().any(|text| answers_no_number(text)) {
        wrong.push("a result is not finite".to_owned());
    }
    wrong.join("; ")
}

/// Whether a text holds a number that is none, as a word of its own; not in words about ranges and about what is undefined, which
/// may say so. (JSON has no such numbers.)
fn answers_no_number(text: &str) -> bool {
    let is_said = |line: &str| line.contains("outside") || line.contains("undefined");
    let lines = text.lines().filter(|line| !is_said(line));
    lines.flat_map(words).any(is_no_number)
}

fn is_no_number(word: &str) -> bool {
    ["NaN", "inf", "Infinity", "nan"].contains(&word)
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

/// A file that something is printed into.
struct Printed(Option<File>);

impl Printed {
    fn from_path(path: PathBuf) -> Self {
        Self(File::open(path).ok().map(|mut file| {
            let _ = file.seek(SeekFrom::End(0));
            file
        }))
    }

    /// What was printed since it was last asked.
    fn new_text(&mut self) -> String {
        let mut bytes = Vec::new();
        if let Some(file) = &mut self.0 {
            let _ = file.read_to_end(&mut bytes);
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// Ends the process when a case takes too long, or so much memory that the machine would suffer.
fn watch(began: Arc<Mutex<(Instant, Duration)>>) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_millis(50));
            let (begin, used) = *began.lock().unwrap();
            let (waited, used) = (begin.elapsed(), processor().saturating_sub(used));
            let memory = status("VmRSS:").unwrap_or(0);
            if used > MOST_TIME || waited > MOST_WAIT || memory > 2 * MOST_MEMORY {
                eprintln!(
                    "ended after {} s, {} s of the processor, with {memory} kB",
                    waited.as_secs(),
                    used.as_secs()
                );
                std::process::exit(99);
            }
        }
    });
}

/// How long the process has used the processor; nothing where the system does not tell.
fn processor() -> Duration {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name of the program; 11 and 12 are user and system time in hundredths of a second.
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    let hundredths: u64 = fields
        .skip(11)
        .take(2)
        .filter_map(|field| field.parse::<u64>().ok())
        .sum();
    Duration::from_millis(10 * hundredths)
}

/// A number that Linux tells of the process; absent elsewhere.
fn status(key: &str) -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Lets the peak of memory begin anew, where Linux does so.
fn reset_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}
