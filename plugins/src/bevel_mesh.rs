//! Loss of bevel and hypoid meshes.

pub mod efficiency;
mod flanks;
pub mod mean_friction;
pub mod path_integral;
#[cfg(test)]
mod tests;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::{LoadSharing, Pair};
use gearloss_framework::registry::Build;

/// The default load sharing.
fn uniform() -> LoadSharing {
    LoadSharing::Uniform
}

/// Teeth that overlap along the face may have a transverse contact ratio below one. Between two contacts of the transverse section their load is
/// carried elsewhere along the face, which only an even load or lines of contact describe.
fn check_sharing(pairs: &[Pair; 2], sharing: LoadSharing, cx: &Build<'_>) -> Result<(), Diagnostic> {
    let least = pairs
        .iter()
        .map(|pair| pair.contact_ratio)
        .fold(f64::INFINITY, f64::min);
    let along_the_face = matches!(sharing, LoadSharing::Uniform | LoadSharing::ContactLines);
    if least >= 1.0 || along_the_face {
        return Ok(());
    }
    Err(cx
        .error(format!(
            "the transverse contact ratio of the virtual gears is {least:.3}, so that this load sharing leaves gaps"
        ))
        .help("write `load_sharing: uniform` or `contact_lines`"))
}
