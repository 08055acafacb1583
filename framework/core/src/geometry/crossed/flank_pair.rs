//! The two flanks of a bevel or hypoid pair that touch, as a pair of surfaces with a path of contact.

use super::blank::Blank;
use super::mean_point::{Flank, MeanPoint};
use super::pitch_cones::PitchCones;
use super::tooth_path::ToothPath;
use super::virtual_pair::VirtualPair;
use crate::geometry::Pair;

/// Why bevel or hypoid teeth do not mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TeethFault {
    /// The addendum of a gear, 0 or 1, leaves no path of contact on its side of the pitch point.
    NoAddendum(usize),
    /// Contact would reach below the base circle of a virtual gear, 0 or 1.
    BelowBase(usize),
    /// The effective face width of the virtual gears is not positive.
    NoFace,
    /// Transverse contact ratio and overlap ratio of the virtual gears together are below one.
    ContactRatio(f64),
}

impl std::fmt::Display for TeethFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = |gear: usize| if gear == 0 { "pinion" } else { "wheel" };
        match *self {
            Self::NoAddendum(gear) => write!(
                f,
                "the addendum of the {} leaves no path of contact beyond the pitch point",
                name(gear)
            ),
            Self::BelowBase(gear) => write!(
                f,
                "contact starts below the base circle of the {}: the addendum of its mate is too large",
                name(gear)
            ),
            Self::NoFace => write!(
                f,
                "the offset is too large for the face width: no effective face width is left"
            ),
            Self::ContactRatio(ratio) => write!(
                f,
                "the contact ratio of the virtual cylindrical gears, {ratio:.3}, is below one"
            ),
        }
    }
}

impl Pair {
    /// The flanks of a bevel or hypoid pair, with the design pressure angle and the limit factor of [`VirtualPair::new`]. \[rad\]
    ///
    /// Path of contact, base helix angle, contact ratios and face width are those of the virtual cylindrical pair, velocities those of the gears
    /// ([`Pair::crossed`]). Radii belong to the gears: mean pitch radii, outer tip diameters, and base radii with the arm of the normal force.
    ///
    /// # Errors
    /// All faults that make the teeth impossible.
    pub fn bevel(
        cones: &PitchCones,
        blank: &Blank,
        pressure: (f64, f64),
        flank: Flank,
    ) -> Result<Self, Vec<TeethFault>> {
        let teeth = VirtualPair::new(cones, blank, pressure, flank);
        let frame = MeanPoint::new(cones);
        let normal = frame.flank_normal(teeth.pressure_angle, flank);
        let path = ToothPath::new(&frame, normal, teeth.to_tip, (teeth.base_helix, teeth.inclination));
        let [tangent, second] = teeth.diameter.map(|d| 0.5 * d * teeth.transverse_angle.sin());
        let base_pitch = (teeth.to_tip[0] + teeth.to_tip[1]) / teeth.contact_ratio;
        let [start, end] = [tangent - teeth.to_tip[1], tangent + teeth.to_tip[0]];
        let faults = faults(&teeth, [start, end], tangent + second);
        if !faults.is_empty() {
            return Err(faults);
        }
        let cos_base_helix = teeth.base_helix.cos();
        let arm = cones.radius[0] * teeth.pressure_angle.cos() * cones.spiral_angle[0].cos();
        let rolling = path.rolling(0.0);
        let spiral = f64::midpoint(cones.spiral_angle[0], cones.spiral_angle[1]);
        let sin_working_angle = (rolling[0] + rolling[1]).abs() / (2.0 * cones.radius[0]);
        let mut pair = Self {
            involute: true,
            crossed: None,
            z: cones.z,
            internal: false,
            normal_module: cones.normal_module(),
            pressure_angle: teeth.pressure_angle,
            helix_angle: spiral,
            transverse_angle: teeth.transverse_angle,
            working_angle: teeth.transverse_angle,
            base_helix: teeth.base_helix,
            sin_working_angle,
            cos_base_helix,
            working_helix: spiral,
            reference_distance: 0.5 * (teeth.diameter[0] + teeth.diameter[1]),
            centre_distance: 0.5 * (teeth.diameter[0] + teeth.diameter[1]),
            profile_shift: [0.0; 2],
            shortening: 0.0,
            reference_diameter: cones.radius.map(|r| 2.0 * r),
            base_radius: [arm / cos_base_helix, arm * cones.ratio() / cos_base_helix],
            working_radius: cones.radius,
            tip_diameter: blank.tip_diameter,
            root_diameter: [0, 1]
                .map(|i| 2.0 * (cones.radius[i] - blank.mean_dedendum[i] * cones.pitch_angle[i].cos())),
            base_pitch,
            tangent_length: tangent + second,
            points: [start, end - base_pitch, tangent, start + base_pitch, end],
            contact_ratio: teeth.contact_ratio,
            addendum_ratio: teeth.to_tip.map(|length| length / base_pitch),
            overlap_ratio: teeth.overlap_ratio,
            facewidth: teeth.facewidth,
            pitch_radius: teeth.relative_radius,
        };
        let radius_factor = teeth.relative_radius / pair.relative_radius(tangent);
        pair.crossed = Some(path.motion(cos_base_helix, radius_factor));
        Ok(pair)
    }
}

/// Why the teeth of a virtual pair do not mesh, with the ends of its path from the first base circle and the distance of both base circles. \[m\]
fn faults(teeth: &VirtualPair, [start, end]: [f64; 2], tangent_length: f64) -> Vec<TeethFault> {
    // A tip inside of its base circle has no path.
    let no_path = |i: usize| (!teeth.to_tip[i].is_finite() || teeth.to_tip[i] <= 0.0).then_some(i);
    let tips: Vec<TeethFault> = (0..2).filter_map(no_path).map(TeethFault::NoAddendum).collect();
    if !tips.is_empty() {
        return tips;
    }
    let total = teeth.contact_ratio + teeth.overlap_ratio;
    let all = [
        (start < 0.0, TeethFault::BelowBase(0)),
        (end > tangent_length, TeethFault::BelowBase(1)),
        (teeth.facewidth <= 0.0, TeethFault::NoFace),
        (total < 1.0, TeethFault::ContactRatio(total)),
    ];
    all.into_iter()
        .filter(|(is_found, _)| *is_found)
        .map(|(_, fault)| fault)
        .collect()
}
