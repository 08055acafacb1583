//! The identified values in the format of a study.

use std::fmt::Write as _;

use super::outcome::IdentificationOfSet;
use crate::identify::Target;

/// The values in the format of a study.
pub(super) fn as_yaml(name: &str, o: &IdentificationOfSet) -> String {
    let mut text = format!(
        "# Values identified by `{name}` for the models `{}`. Copy the lines below `set` into a study.\n",
        o.model_set
    );
    let theta = o.found.fitted.theta();
    let parameters = &o.found.parameters;
    text.push_str("conditions:\n  set:\n");
    let mut any = false;
    for (i, (parameter, value)) in parameters.iter().zip(theta).enumerate() {
        // Parameters without effect keep their values; a curve is written if one of its torques has an effect.
        let seen = |k: usize| o.found.fitted.inference.column(k) > 0.0;
        let unseen = match &parameter.target {
            Target::Over { torques, place: 0, .. } => !(i..i + torques.len()).any(seen),
            Target::Over { .. } => false,
            Target::Path(_) | Target::Rig(_) => !seen(i),
        };
        if unseen {
            let _ = writeln!(text, "    # not identifiable: {}", parameter.name);
            continue;
        }
        any |= matches!(parameter.target, Target::Path(_) | Target::Over { place: 0, .. });
        match &parameter.target {
            Target::Path(varied) => {
                for (path, set_value) in varied.overrides(*value) {
                    // A factor leaves each path its own unit.
                    let unit = if parameter.unit.symbol == "-" {
                        ""
                    } else {
                        parameter.unit.symbol
                    };
                    let _ = writeln!(text, "    {path}: {}", format!("{set_value} {unit}").trim_end());
                }
            }
            Target::Over {
                varied,
                port,
                torques,
                place: 0,
            } => {
                let factors = &theta[i..i + torques.len()];
                for path in &varied.paths {
                    let _ = writeln!(
                        text,
                        "    {path}: {{ port: {port}, torques: {torques:?}, factors: {factors:?} }}"
                    );
                }
            }
            Target::Over { .. } | Target::Rig(_) => {}
        }
    }
    if !any {
        text = text.replace("  set:\n", "  set: {}\n");
    }
    for (parameter, value) in parameters.iter().zip(theta) {
        if matches!(parameter.target, Target::Rig(_)) {
            let _ = writeln!(text, "# rig, see the data: {}: {value} Nm", parameter.path);
        }
    }
    text
}
