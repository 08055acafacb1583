//! Hertzian line contact of two flanks, treated as cones in the normal plane.
//!
//! Source: Hertz; the modulus is that of film theory, 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, twice the one of contact
//! mechanics.

use std::f64::consts::PI;

use gearloss_framework::real::Real;

/// A loaded line contact. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact<R = f64> {
    /// Force per length of the line of contact. \[N/m\]
    pub line_load: R,
    /// Radius of relative curvature. \[m\]
    pub radius: R,
    /// Reduced modulus. \[Pa\]
    pub modulus: R,
    /// Length of the line of contact. \[m\]
    pub length: R,
    /// Speeds of the surfaces of the first and of the second flank. \[m/s\]
    pub speeds: [R; 2],
    /// Half of the width of the band of contact. \[m\]
    pub half_width: R,
    /// Mean pressure. \[Pa\]
    pub mean_pressure: R,
}

/// Natural logarithms of the quantities of a contact: film formulas are products of their powers. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logarithms<R = f64> {
    /// Of the force per length.
    pub line_load: R,
    /// Of the radius of relative curvature.
    pub radius: R,
    /// Of the reduced modulus.
    pub modulus: R,
    /// Of the length of the line of contact.
    pub length: R,
    /// Of the mean of both surface speeds.
    pub speed: R,
    /// Of the slide-to-roll ratio; minus infinity in pure rolling.
    pub slide_roll: R,
}

impl<R: Real> Contact<R> {
    /// A contact from line load (N/m), radius (m), reduced modulus (Pa), length (m), surface speeds (m/s).
    #[inline(always)]
    pub fn new(line_load: R, radius: R, modulus: R, length: R, speeds: [R; 2]) -> Self {
        let half_width = (line_load * 8.0 * radius / (modulus * PI)).sqrt();
        Self {
            line_load,
            radius,
            modulus,
            length,
            speeds,
            half_width,
            mean_pressure: line_load / (half_width * 2.0),
        }
    }

    /// Surface speeds from their difference and their sum, for a first flank that is the faster one or not. If they are opposite,
    /// the slower one is used by magnitude. \[m/s\]
    #[inline(always)]
    pub fn speeds(sliding: R, sum: R, first_faster: bool) -> [R; 2] {
        let (fast, slow) = ((sum + sliding) * 0.5, ((sum - sliding) * 0.5).abs());
        if first_faster { [fast, slow] } else { [slow, fast] }
    }

    /// The logarithms of its quantities.
    pub fn logarithms(&self) -> Logarithms<R> {
        let [u1, u2] = self.speeds;
        let speed = (u1 + u2) * 0.5;
        Logarithms {
            line_load: self.line_load.ln(),
            radius: self.radius.ln(),
            modulus: self.modulus.ln(),
            length: self.length.ln(),
            speed: speed.ln(),
            slide_roll: ((u1 - u2).abs() / speed).ln(),
        }
    }

    /// Maximum pressure. \[Pa\]
    #[inline(always)]
    pub fn pressure(&self) -> R {
        self.mean_pressure * (4.0 / PI)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::{close, stage};
    use gearloss_framework::geometry::LoadSharing;

    #[test]
    fn u1a_u1b_u1f_geometry_of_both_stages() {
        let (one, two) = (stage(1).pair, stage(2).pair);
        for (value, printed) in [
            (one.transverse_angle.to_degrees(), 21.17283),
            (one.base_helix.to_degrees(), 18.74724),
            (one.working_angle.to_degrees(), 21.75102),
            (one.centre_distance, 0.1017125),
            (one.base_radius[0], 0.02614818),
            (one.base_radius[1], 0.06832265),
            (0.5 * one.tip_diameter[0], 0.02994508),
            (0.5 * one.tip_diameter[1], 0.07517264),
            (one.base_pitch, 0.005299801),
            (one.tangent_length, 0.03769199),
            (one.points[0], 0.006340103),
            (one.points[1], 0.009294067),
            (one.points[2], 0.01043260),
            (one.points[3], 0.01163990),
            (one.points[4], 0.01459387),
            (one.contact_ratio, 1.557373),
            (one.overlap_ratio, 1.921207),
            (one.pitch_radius, 0.007967732),
            (two.transverse_angle.to_degrees(), 21.50238),
            (two.base_helix.to_degrees(), 21.07593),
            (two.working_angle.to_degrees(), 21.99227),
            (two.centre_distance, 0.1510752),
            (two.base_radius[0], 0.03142028),
            (two.base_radius[1], 0.1086618),
            (0.5 * two.tip_diameter[0], 0.03678664),
            (0.5 * two.tip_diameter[1], 0.1194941),
            (two.base_pitch, 0.008225810),
            (two.tangent_length, 0.05657485),
            (two.points[0], 0.006861090),
            (two.points[2], 0.01268969),
            (two.points[4], 0.01913172),
            (two.contact_ratio, 1.491723),
            (two.overlap_ratio, 2.155134),
            (two.pitch_radius, 0.01054909),
            (one.ratio() * two.ratio(), 9.036290),
        ] {
            close(value, printed);
        }
    }

    #[test]
    fn u1c_hertz_pressure_at_the_pitch_point() {
        let part = stage(1);
        let tangential = 143.2394 / part.pair.base_radius[0];
        close(tangential, 5477.990);
        let w = tangential / part.pair.facewidth;
        close(w, 182599.7);
        let contact = Contact::new(w, part.pair.pitch_radius, part.modulus, 0.03, [1.0, 1.0]);
        close(contact.half_width, 1.279306e-4);
        close(contact.pressure(), 908.6688e6);
        close(contact.mean_pressure, 713.6668e6);
    }

    #[test]
    fn u1d_load_share_and_speeds_on_the_ramp() {
        let pair = stage(1).pair;
        let [start, .., end] = pair.points;
        // Eleven equidistant points: the fourth is at three tenths of the path.
        let place = pair.even_path(LoadSharing::Ramp, 11)[3];
        close(place.x, 0.008816232);
        close(place.share, 0.8382395);
        // The other pair in contact is one base pitch ahead, on the falling ramp.
        let ahead = place.x + pair.base_pitch;
        close((end - ahead) / (end - pair.points[3]), 0.1617605);
        assert!(ahead > pair.points[3] && place.x > start);
        let omega = 2000.0 * PI / 30.0;
        let [u1, u2] = Contact::speeds(pair.sliding(place.x) * omega, pair.sum_speed(place.x) * omega, false);
        close(u1, 1.846467);
        close(u2, 2.314561);
        close(2.0 * (u2 - u1) / (u1 + u2), 0.2249895);
    }
}
