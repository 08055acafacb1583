//! The usual sums of losses.

use gearloss_framework::evaluate::{PartLoss, Solution};
use gearloss_framework::registry::Instance;
use gearloss_framework::transmission::{PartInfo, Transmission};

/// Names and meanings of the sums, in order.
pub const SUMS: [(&str, &str); 6] = [
    ("P_VZP", "gears, load-dependent"),
    ("P_VZ0", "gears, load-independent"),
    ("P_VLP", "bearings, load-dependent"),
    ("P_VL0", "bearings, load-independent"),
    ("P_VD", "seals"),
    ("P_VX", "others"),
];

/// Index of the sum of a term of a mechanism.
pub fn sum_of(mechanism: &str, load_dependent: bool) -> usize {
    match (mechanism, load_dependent) {
        ("gear_mesh" | "gear_drag" | "planetary_drag", true) => 0,
        ("gear_mesh" | "gear_drag" | "planetary_drag", false) => 1,
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
