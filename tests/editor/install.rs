//! What tests need of npm: the language server of the YAML extension, kept in the folder of the build, and tools of `web/`.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The longest that npm may take.
const PATIENCE: Duration = Duration::from_mins(2);

/// Program of the server, for node; installed at the first time and when its version has changed.
///
/// # Errors
/// Why there is none: no node, no npm, no network.
pub fn server() -> Result<PathBuf, String> {
    // Tests run side by side, and npm empties the folder first.
    static SERVER: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    SERVER.get_or_init(installed).clone()
}

fn installed() -> Result<PathBuf, String> {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/editor");
    let folder = target().join("editor");
    let program = folder.join("node_modules/yaml-language-server/bin/yaml-language-server");
    std::fs::create_dir_all(&folder).unwrap();
    for name in ["package.json", "package-lock.json"] {
        std::fs::copy(scripts.join(name), folder.join(name)).unwrap();
    }
    packages(&folder)?;
    Ok(program)
}

/// Installs the packages of a folder, unless those of its lock file are there.
///
/// # Errors
/// No node, no npm, no network.
pub fn packages(folder: &Path) -> Result<(), String> {
    for tool in ["node", "npm"] {
        let found = Command::new(tool).arg("--version").output();
        if !found.is_ok_and(|output| output.status.success()) {
            return Err(format!("no {tool}; on Debian `apt-get install nodejs npm` brings it"));
        }
    }
    let read = |path: PathBuf| std::fs::read_to_string(path).unwrap_or_default();
    // The last to be written, so that it tells what is installed in full.
    let record = folder.join("node_modules/installed.json");
    let wanted = read(folder.join("package-lock.json"));
    if read(record.clone()) == wanted {
        return Ok(());
    }
    std::fs::create_dir_all(target().join("npm")).unwrap();
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let log = target().join("npm").join(format!("{name}.log"));
    let mut npm = Command::new("npm");
    npm.args(["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline"])
        .args(["--fetch-retries=1", "--fetch-timeout=20000", "--prefix"])
        .arg(folder)
        .stdout(File::create(&log).unwrap())
        .stderr(File::options().append(true).open(&log).unwrap());
    let ended = within(PATIENCE, npm)?;
    if !ended.success() {
        return Err(format!("npm could not install the packages of {name}:\n{}", read(log)));
    }
    std::fs::write(record, wanted).unwrap();
    Ok(())
}

/// Runs a command to its end, at most for a given time.
///
/// # Errors
/// If it takes longer.
pub fn within(limit: Duration, mut command: Command) -> Result<ExitStatus, String> {
    let mut child = command.spawn().map_err(|e| format!("{command:?}: {e}"))?;
    let end = Instant::now() + limit;
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return Ok(status);
        }
        if Instant::now() > end {
            let _ = child.kill();
            let _ = child.wait();
            return Err(format!("{command:?} took longer than {limit:?}"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// The folder of the build.
pub fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().to_owned()
}
