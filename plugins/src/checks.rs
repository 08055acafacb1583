//! What the check values of several models have in common.

use gearloss_framework::registry::Check;

/// Values from an independent implementation of the formula of a model, with six digits.
pub const SIX_DIGITS: Check = Check {
    input: "",
    values: &[],
    tolerance: 1e-5,
    because: "the values have six digits",
    source: "independent implementation of the formula",
};

/// Values that were calculated by hand from the formula of a model.
pub const BY_HAND: Check = Check {
    because: "the factors of the calculation have six digits or more",
    source: "calculated by hand from the formula",
    ..SIX_DIGITS
};

/// A helical pair, for inputs of checks.
macro_rules! helical {
    () => {
        "{ z: [31, 96], normal_module: 1.6 mm, pressure_angle: 17.5 deg, helix_angle: 27 deg, centre_distance: 115 mm, facewidth: 17 mm, \
         tip_diameter: [60.2 mm, 176.251 mm], ra: [0.4 um, 0.4 um], rq: [0.35 um, 0.35 um] }"
    };
}

/// A pinion in a ring gear, for inputs of checks.
macro_rules! internal {
    () => {
        "{ z: [24, 72], internal: true, normal_module: 2 mm, pressure_angle: 20 deg, centre_distance: 48 mm, facewidth: 20 mm, \
         tip_diameter: [52 mm, 140.8 mm], ra: [0.4 um, 0.4 um], rq: [0.35 um, 0.35 um] }"
    };
}

pub(crate) use {helical, internal};
