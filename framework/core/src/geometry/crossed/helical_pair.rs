//! The flanks of crossed helical gears that touch in a point, as a pair of surfaces with a path of contact.

use nalgebra::{Vector2, Vector3};

use super::flank_pair::TeethFault;
use super::mean_point::{Flank, MeanPoint};
use super::pitch_cones::PitchCones;
use super::tooth_path::ToothPath;
use crate::geometry::Pair;
use crate::rolling::PointContact;

/// Pressure for which a length of contact is stated where only one can be. \[Pa\]
const USUAL_PRESSURE: f64 = 1e9;

impl Pair {
    /// The flanks of two cylinders on crossed axes with a normal pressure angle (rad), tip radii (m) and the reduced modulus E/(1 - nu^2) (Pa). Both
    /// senses of torque are alike, because half a turn about the common perpendicular of the axes exchanges the flanks.
    ///
    /// Contact is a point that moves along the normal of the flanks, so path and curvature are those of the plane of that normal. It is an ellipse
    /// under load; for laws of line contact its length is 4/3 of the long semi-axis, and the radius of curvature the one that has its pressure
    /// ([`CrossedMotion::spot`](super::CrossedMotion)). Radii belong to the gears, the base radii to the arm of the normal force.
    ///
    /// # Errors
    /// All faults that make the teeth impossible.
    pub fn crossed_helical(
        cylinders: &PitchCones,
        pressure_angle: f64,
        tip_radius: [f64; 2],
        modulus: f64,
    ) -> Result<Self, Vec<TeethFault>> {
        let frame = MeanPoint::new(cylinders);
        let normal = frame.flank_normal(pressure_angle, Flank::Drive);
        let [(rho_1, to_tip_1), (rho_2, to_tip_2)] = [0, 1].map(|i| {
            let (beta, radius) = (cylinders.spiral_angle[i], cylinders.radius[i]);
            let transverse = (pressure_angle.tan() / beta.cos()).atan();
            let cos_base_helix = (beta.sin() * pressure_angle.cos()).asin().cos();
            let base = radius * transverse.cos();
            let to_tip = (tip_radius[i] * tip_radius[i] - base * base).sqrt() - radius * transverse.sin();
            (radius * transverse.sin() / cos_base_helix, to_tip / cos_base_helix)
        });
        let base_pitch = std::f64::consts::PI * cylinders.normal_module() * pressure_angle.cos();
        let contact_ratio = (to_tip_1 + to_tip_2) / base_pitch;
        let faults = faults([rho_1, rho_2], [to_tip_1, to_tip_2], contact_ratio);
        if !faults.is_empty() {
            return Err(faults);
        }
        let (line, relative) = spot_of(&frame, normal, [rho_1, rho_2]);
        let ends = [-to_tip_1, to_tip_2];
        let path = ToothPath::across_line(&frame, normal, ends, line);
        let contact = PointContact::new(relative[0], relative[1], 0.5 * modulus);
        let unit = contact.under(1.0);
        let semi_axis = unit.across.max(unit.along);
        // The line load of one newton over 4/3 of the semi-axis has the pressure of the ellipse at this radius.
        let line_load = 0.75 / semi_axis;
        let pitch_radius = line_load * modulus / (2.0 * std::f64::consts::PI * unit.pressure * unit.pressure);
        let arm = cylinders.radius[0] * pressure_angle.cos() * cylinders.spiral_angle[0].cos();
        let rolling = path.rolling(0.0);
        let [start, end] = [rho_1 - to_tip_2, rho_1 + to_tip_1];
        let mut motion = path.motion(1.0, pitch_radius * (rho_1 + rho_2) / (rho_1 * rho_2));
        motion.spot = Some(semi_axis);
        Ok(Self {
            involute: true,
            crossed: Some(motion),
            z: cylinders.z,
            internal: false,
            normal_module: cylinders.normal_module(),
            pressure_angle,
            helix_angle: 0.0,
            transverse_angle: pressure_angle,
            working_angle: pressure_angle,
            base_helix: 0.0,
            sin_working_angle: (rolling[0] + rolling[1]).abs() / (2.0 * cylinders.radius[0]),
            cos_base_helix: 1.0,
            working_helix: 0.0,
            reference_distance: cylinders.offset,
            centre_distance: cylinders.offset,
            profile_shift: [0.0; 2],
            shortening: 0.0,
            reference_diameter: cylinders.radius.map(|r| 2.0 * r),
            base_radius: [arm, arm * cylinders.ratio()],
            working_radius: cylinders.radius,
            tip_diameter: tip_radius.map(|r| 2.0 * r),
            root_diameter: cylinders.radius.map(|r| 2.0 * r - 2.5 * cylinders.normal_module()),
            base_pitch,
            tangent_length: rho_1 + rho_2,
            points: [start, end - base_pitch, rho_1, start + base_pitch, end],
            contact_ratio,
            addendum_ratio: [to_tip_1 / base_pitch, to_tip_2 / base_pitch],
            overlap_ratio: 0.0,
            facewidth: semi_axis * (USUAL_PRESSURE / unit.pressure) / 0.75,
            pitch_radius,
        })
    }
}

/// Direction of the long axis of contact, and the relative radii across and along it, from the radii of both flanks. \[m\]
fn spot_of(frame: &MeanPoint, normal: Vector3<f64>, radius: [f64; 2]) -> (Vector3<f64>, [f64; 2]) {
    let in_flank = normal.cross(&frame.trace);
    let curvature = [0, 1].map(|i| {
        // The straight line of a flank is in the plane of its axis and its normal.
        let generatrix = (frame.axis[i] - normal * frame.axis[i].dot(&normal)).normalize();
        let across = normal.cross(&generatrix);
        let across = Vector2::new(across.dot(&frame.trace), across.dot(&in_flank));
        across * across.transpose() / radius[i]
    });
    let eigen = (curvature[0] + curvature[1]).symmetric_eigen();
    let flat = usize::from(eigen.eigenvalues[1] < eigen.eigenvalues[0]);
    let along: Vector2<f64> = eigen.eigenvectors.column(flat).into();
    let line = frame.trace * along.x + in_flank * along.y;
    (line, [1.0 / eigen.eigenvalues[1 - flat], 1.0 / eigen.eigenvalues[flat]])
}

fn faults(radius: [f64; 2], to_tip: [f64; 2], contact_ratio: f64) -> Vec<TeethFault> {
    let no_path = |i: &usize| !to_tip[*i].is_finite() || to_tip[*i] <= 0.0;
    let tips: Vec<TeethFault> = (0..2).filter(no_path).map(TeethFault::NoAddendum).collect();
    if !tips.is_empty() {
        return tips;
    }
    let below = |i: &usize| to_tip[1 - *i] > radius[*i];
    let mut all: Vec<TeethFault> = (0..2).filter(below).map(TeethFault::BelowBase).collect();
    if contact_ratio < 1.0 {
        all.push(TeethFault::ContactRatio(contact_ratio));
    }
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mechanism::mean_friction::hertz;

    /// z 15/30, m_n 3 mm, both helix angles 45 degrees, axes at right angles.
    #[test]
    fn a_pair_at_right_angles() {
        let degree = std::f64::consts::PI / 180.0;
        let cylinders = PitchCones::cylinders([15, 30], 3e-3, [45.0 * degree, -45.0 * degree]);
        let tips = cylinders.radius.map(|r| r + 3e-3);
        let pair = Pair::crossed_helical(&cylinders, 20.0 * degree, tips, 226e9).unwrap();
        let close =
            |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-8, "{value} not {expected}");
        // Curvature of both flanks, the relative radii, and sliding at the pitch point.
        close(pair.points[2], 19.48653685e-3);
        close(pair.tangent_length - pair.points[2], 38.97307370e-3);
        let frame = MeanPoint::new(&cylinders);
        let normal = frame.flank_normal(20.0 * degree, Flank::Drive);
        let (_, relative) = spot_of(&frame, normal, [19.48653685e-3, 38.97307370e-3]);
        close(relative[0], 14.3035438e-3);
        close(relative[1], 141.5733072e-3);
        close(pair.sliding(pair.points[2]), 45.0e-3);
        // The pressure of the ellipse at any force.
        let contact = PointContact::new(relative[0], relative[1], 113e9);
        for force in [10.0, 1000.0] {
            let pressure = hertz(pair.line_load(force), 226e9, pair.pitch_radius);
            close(pressure, contact.under(force).pressure);
        }
    }
}
