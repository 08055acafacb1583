//! A gearbox of many lines: a train of spur gears, each driving the next, with two bearings on every shaft.

use std::fmt::Write as _;

/// Shafts of the train.
pub const SHAFTS: usize = 555;
/// Lines of the document.
pub const LINES: usize = 10_000;

/// The document.
pub fn yaml() -> String {
    let last = SHAFTS - 1;
    let mut out = format!("gearloss: gearbox/1\ntitle: A long train\nports: {{ input: S0, output: S{last} }}\n");
    out += "shafts:\n";
    for i in 0..SHAFTS {
        let _ = write!(out, "  S{i}:\n    axis: [{} mm, 0 mm]\n", 60 * i);
    }
    out += "gears:\n";
    for i in 0..SHAFTS {
        let _ = write!(
            out,
            "  G{i}:\n    shaft: S{i}\n    at: 30 mm\n    z: 30\n    facewidth: 20 mm\n"
        );
    }
    out += "meshes:\n";
    for i in 0..last {
        let next = i + 1;
        let _ = write!(out, "  M{i}:\n    gears: [G{i}, G{next}]\n    normal_module: 2 mm\n");
    }
    out += "bearings:\n";
    for i in 0..SHAFTS {
        for (side, at) in [("L", 0), ("R", 60)] {
            let _ = write!(
                out,
                "  {side}{i}:\n    shaft: S{i}\n    at: {at} mm\n    designation: \"6205\"\n"
            );
        }
    }
    out += "lubricants:\n  oil:\n    viscosity: { kv40: 46 mm2/s, kv100: 8 mm2/s }\n";
    out + "models:\n  gear_mesh: { type: iso14179_2 }\n  bearing: { type: iso14179_2 }\n"
}
