//! The virtual cylindrical pair of a bevel or hypoid pair at its mean point, after ISO 10300-1 annex A, and the curvature of its contact.

use std::f64::consts::PI;

use super::blank::Blank;
use super::mean_point::Flank;
use super::pitch_cones::PitchCones;

/// Share of the face width that carries, if the contact pattern is unknown: 0.85 in ISO 10300-1.
const CARRYING: f64 = 0.85;

/// Virtual cylindrical pair. \[rad, m\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualPair {
    /// Normal pressure angle of the flank.
    pub pressure_angle: f64,
    /// Pitch diameters.
    pub diameter: [f64; 2],
    /// Transverse pressure angle.
    pub transverse_angle: f64,
    /// Base helix angle.
    pub base_helix: f64,
    /// Lengths of the path of contact from the pitch point to the tip of each gear.
    pub to_tip: [f64; 2],
    /// Transverse contact ratio.
    pub contact_ratio: f64,
    /// Effective face width.
    pub facewidth: f64,
    /// Overlap ratio.
    pub overlap_ratio: f64,
    /// Inclination of the line of contact to the trace of the teeth.
    pub inclination: f64,
    /// Relative radius of curvature perpendicular to the line of contact.
    pub relative_radius: f64,
}

impl VirtualPair {
    /// Of a flank with a design pressure angle, and the share of the limit pressure angle that the cutter contains (`limit_factor`: 1 for a
    /// hypoid pair by Gleason, 0 without). \[rad\]
    pub fn new(cones: &PitchCones, blank: &Blank, (design_angle, limit_factor): (f64, f64), flank: Flank) -> Self {
        let side = match flank {
            Flank::Drive => 1.0,
            Flank::Coast => -1.0,
        };
        let limit = side * cones.limit_pressure_angle();
        let pressure_angle = design_angle + limit_factor * limit;
        let effective = pressure_angle - limit;
        let module = cones.normal_module();
        let spiral = f64::midpoint(cones.spiral_angle[0], cones.spiral_angle[1]);
        let transverse_angle = (effective.tan() / spiral.cos()).atan();
        let base_helix = (spiral.sin() * effective.cos()).asin();
        let diameter = [0, 1].map(|i| 2.0 * cones.radius[i] / cones.pitch_angle[i].cos());
        let to_tip = [0, 1].map(|i| {
            let base = diameter[i] * transverse_angle.cos();
            let tip = diameter[i] + 2.0 * blank.mean_addendum[i];
            0.5 * ((tip * tip - base * base).sqrt() - diameter[i] * transverse_angle.sin())
        });
        let path = to_tip[0] + to_tip[1];
        let half = cones.offset_angle() / 2.0;
        let turned = (cones.pitch_angle[1].sin() * cones.wheel_offset_angle().tan()).atan() - half;
        let carrying = CARRYING * blank.facewidth[1];
        let facewidth =
            (carrying / half.cos() - path * transverse_angle.cos() * half.tan()) / (1.0 - turned.tan() * half.tan());
        let inclination = (spiral.tan() * effective.sin()).atan();
        let [b1, b2] = cones.spiral_angle.map(f64::cos);
        let of_cones = [0, 1].map(|i| cones.pitch_angle[i].cos() / cones.radius[i]);
        let tangents = pressure_angle.cos() * (pressure_angle.tan() - limit.tan());
        let of_offset = side * (2.0 * half).tan() * inclination.tan();
        let curvature = b1 * b2 / (2.0 * half).cos() * (of_cones[0] + of_cones[1]) / (tangents + of_offset);
        Self {
            pressure_angle,
            diameter,
            transverse_angle,
            base_helix,
            to_tip,
            contact_ratio: path * spiral.cos() / (PI * module * transverse_angle.cos()),
            facewidth,
            overlap_ratio: facewidth * spiral.sin() / (PI * module),
            inclination,
            relative_radius: inclination.cos().powi(2) / curvature.abs(),
        }
    }
}
