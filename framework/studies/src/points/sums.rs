//! The usual sums of losses.

use gearloss_framework::evaluate::{PartLoss, Solution};
use gearloss_framework::registry::Instance;
use gearloss_framework::transmission::{PartInfo, Transmission};
use schemars::JsonSchema;
use serde::Serialize;

/// Names and meanings of the sums, in order.
pub const SUMS: [(&str, &str); 6] = [
    ("P_VZP", "gears, load-dependent"),
    ("P_VZ0", "gears, load-independent"),
    ("P_VLP", "bearings, load-dependent"),
    ("P_VL0", "bearings, load-independent"),
    ("P_VD", "seals"),
    ("P_VX", "others"),
];

/// The usual sums of losses.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Sums {
    /// Gears, load-dependent. [W]
    #[serde(rename = "P_VZP")]
    gears_loaded: f64,
    /// Gears, load-independent. [W]
    #[serde(rename = "P_VZ0")]
    gears_unloaded: f64,
    /// Bearings, load-dependent. [W]
    #[serde(rename = "P_VLP")]
    bearings_loaded: f64,
    /// Bearings, load-independent. [W]
    #[serde(rename = "P_VL0")]
    bearings_unloaded: f64,
    /// Seals. [W]
    #[serde(rename = "P_VD")]
    seals: f64,
    /// Others. [W]
    #[serde(rename = "P_VX")]
    others: f64,
}

impl From<[f64; 6]> for Sums {
    /// From the sums in the order of [`SUMS`].
    fn from(sums: [f64; 6]) -> Self {
        Self {
            gears_loaded: sums[0],
            gears_unloaded: sums[1],
            bearings_loaded: sums[2],
            bearings_unloaded: sums[3],
            seals: sums[4],
            others: sums[5],
        }
    }
}

/// Index of the sum of a term of a mechanism.
pub fn sum_of(mechanism: &str, load_dependent: bool) -> usize {
    match (mechanism, load_dependent) {
        ("gear_mesh" | "gear_drag" | "planetary_drag" | "differential", true) => 0,
        ("gear_mesh" | "gear_drag" | "planetary_drag" | "differential", false) => 1,
        ("bearing", true) => 2,
        ("bearing", false) => 3,
        ("seal", _) => 4,
        _ => 5,
    }
}

/// Adds the terms of a component to the sums.
pub(super) fn add(sums: &mut [f64; 6], transmission: &Transmission, part: &PartInfo, loss: &PartLoss) {
    let instance: &Instance = &transmission.instances()[part.notes.instance()];
    for term in instance.entry.terms {
        sums[sum_of(part.mechanism, term.load_dependent)] += loss.term_watts(term.index);
    }
}

/// The sums of a point; absent if no flow was found. \[W\]
pub fn sums(transmission: &Transmission, solution: &Solution<'_>) -> Option<[f64; 6]> {
    solution.has_flow().then(|| {
        let mut sums = [0.0; 6];
        for (part, loss) in solution.parts() {
            add(&mut sums, transmission, part, &loss);
        }
        sums
    })
}
