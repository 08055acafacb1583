//! What Functional Mock-up Units of maps and of cycles have in common.

use gearloss_fmu::Library;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::transmission::Transmission;

use crate::analyses::{Planner, Stopped};
use crate::codes;

/// The libraries of FMUs: that of the own platform, and those of the files.
pub fn libraries(cx: &Planner<'_>, files: &[String], is_needed: bool) -> Result<Vec<Library>, Stopped> {
    let path = format!("{}.fmu_libraries", cx.path());
    if !is_needed {
        return match files {
            [] => Ok(Vec::new()),
            _ => Err(cx.wrong(&path, "no FMU is exported", "write `export: [fmu2]`, or delete it")),
        };
    }
    let mut libraries: Vec<Library> = Library::own().into_iter().collect();
    let mut found = Vec::new();
    for file in files {
        let read = cx.study.read_file(file).map_err(|e| format!("cannot read {file}: {e}"));
        let library = read.and_then(|bytes| {
            cx.keep_input(file, &bytes);
            Library::read(bytes).map_err(|e| format!("{file} {e}"))
        });
        match library {
            Ok(library) => {
                libraries.retain(|known| known.platform != library.platform);
                libraries.push(library);
            }
            Err(reason) => found.push(
                Diagnostic::error(path.clone(), reason)
                    .help("take the library out of the folder `binaries` of an FMU that gearloss wrote on the other platform")
                    .code(codes::ANALYSIS),
            ),
        }
    }
    if !found.is_empty() {
        return Err(cx.found(found));
    }
    if libraries.is_empty() {
        return Err(cx.wrong(
            &format!("{}.export", cx.path()),
            "this program has no library for FMUs, because its own platform loads none",
            "write `fmu_libraries: [FILE]` with a library out of an FMU that gearloss wrote on another platform",
        ));
    }
    libraries.sort_by_key(|library| library.platform);
    Ok(libraries)
}

/// Speed of the other port over that of the reference port in a gear, if there are two ports and both turn.
pub fn speed_ratio(t: &Transmission, gear: &str) -> Option<f64> {
    let reference = &t.ports()[t.reference_port()];
    let [other] = t
        .ports()
        .iter()
        .filter(|port| port.name != reference.name)
        .collect::<Vec<_>>()[..]
    else {
        return None;
    };
    let state = t.state(gear).ok()?;
    let torques: &[&str] = if t.torques_needed(state) == 0 {
        &[]
    } else {
        &[&reference.name]
    };
    let case = t.case(gear, &[&reference.name], torques).ok()?;
    let speeds = t.speeds(&case, &[1.0]);
    let ratio = speeds[other.member] / speeds[reference.member];
    (ratio.is_finite() && ratio != 0.0).then_some(ratio)
}
