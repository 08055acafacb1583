//! The two stages, the oil and the path shared by the check cases.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use gearloss_framework::description::LubricantEntry;
use gearloss_framework::description::lubricant::{DensityEntry, RheologyEntry, ViscosityEntry};
use gearloss_framework::geometry::{Pair, PairSpec};
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::material::Conductor;
use gearloss_framework::mechanism::gear_mesh::{MeshOil, MeshPart};
use gearloss_framework::mechanism::tooth_friction::PathNode;

/// Compares to the digits that the cases are published with.
pub fn close(value: f64, printed: f64) {
    assert!((value / printed - 1.0).abs() < 1e-6, "{value} against {printed}");
}

/// The steel of the cases.
pub const STEEL: Conductor = Conductor {
    conductivity: 46.0,
    density: 7800.0,
    heat_capacity: 470.0,
};

/// An e-fluid as in the cases.
pub fn base_oil() -> Arc<Lubricant> {
    let entry = LubricantEntry {
        viscosity: Some(ViscosityEntry {
            kv40: Some(27.3e-6),
            kv100: Some(5.9e-6),
            ..ViscosityEntry::default()
        }),
        density: Some(DensityEntry {
            at: 20.0,
            value: Some(839.0),
            expansion: Some(0.65 / 839.0),
            ..DensityEntry::default()
        }),
        conductivity: Some(0.14),
        rheology: Some(RheologyEntry {
            tau0: Some(5.0e6),
            z: Some(0.60),
            limiting_slope: Some(0.055),
            shear_modulus: Some(0.5e9),
            mu_b: Some(0.13),
        }),
        ..LubricantEntry::default()
    };
    Arc::new(Lubricant::new(&entry).unwrap())
}

/// Stage one or two of an electric axle drive, with 280 nm of roughness and the oil.
pub fn stage(number: usize) -> MeshPart {
    let (z, module, helix, facewidth, shift): (_, _, f64, _, [f64; 2]) = match number {
        1 => ([31, 81], 1.7e-3, 20.0, 30e-3, [0.12, 0.12]),
        _ => ([24, 83], 2.6e-3, 22.5, 46e-3, [0.16, 0.04]),
    };
    let pair = Pair::new(&PairSpec {
        z,
        internal: false,
        normal_module: module,
        pressure_angle: 20.0_f64.to_radians(),
        helix_angle: helix.to_radians(),
        centre_distance: None,
        profile_shift: shift.map(Some),
        tip_diameter: [None, None],
        root_diameter: [None, None],
        facewidth,
        tip_shortening: false,
    })
    .unwrap();
    let each = 280e-9 / 2.0_f64.sqrt();
    let oil = MeshOil {
        id: "base".to_owned(),
        lubricant: base_oil(),
    };
    MeshPart::new(pair, [0.8 * each; 2], [each; 2], 206e9, 0.3).with_oil(Some(oil))
}

/// A path of equal sections with nodes at their centres, under the load ramp from the first contact to single contact.
pub fn midpoints(pair: &Pair, count: usize) -> Vec<PathNode> {
    let [start, .., end] = pair.points;
    let step = (end - start) / count as f64;
    let ramp = (pair.contact_ratio - 1.0) * pair.base_pitch;
    (0..count)
        .map(|i| {
            let x = start + (i as f64 + 0.5) * step;
            let share = ((x - start) / ramp).min((end - x) / ramp).min(1.0);
            PathNode {
                weight: step / pair.base_pitch,
                first_faster: x > pair.points[2],
                ..PathNode::new(pair.sliding(x), pair.sum_speed(x), pair.relative_radius(x), share)
            }
        })
        .collect()
}
