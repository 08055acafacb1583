//! Blanks of bevel and hypoid gears after ISO 23509: tooth depth, face widths, tip diameters.

use std::f64::consts::FRAC_PI_2;

use super::pitch_cones::PitchCones;

/// Depth of the teeth, in mean normal modules, and the angles by which it changes along the face. \[-, rad\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// Working depth.
    pub working: f64,
    /// Clearance, as a share of the working depth.
    pub clearance: f64,
    /// Addendum of the wheel, as a share of the working depth.
    pub wheel_addendum: f64,
    /// Addendum angle of the wheel.
    pub addendum_angle: f64,
    /// Dedendum angle of the wheel.
    pub dedendum_angle: f64,
}

/// A pair of blanks. \[m, rad\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blank {
    /// Mean addenda.
    pub mean_addendum: [f64; 2],
    /// Mean dedenda.
    pub mean_dedendum: [f64; 2],
    /// Face widths.
    pub facewidth: [f64; 2],
    /// Outer tip diameters.
    pub tip_diameter: [f64; 2],
    /// How far the faces reach outwards from the mean point, along the pitch cones.
    pub outer: [f64; 2],
    /// Dedenda at the outer ends.
    pub outer_dedendum: [f64; 2],
}

/// How far the face of a gear reaches from the mean point to its outer and inner end. \[m\]
#[derive(Clone, Copy)]
struct Reach {
    outer: f64,
    inner: f64,
}

impl Blank {
    /// Of a pair with the face width of its wheel. The outer end of the wheel is half a face from the mean point, or where `outer_diameter` is.
    pub fn new(cones: &PitchCones, depth: &Depth, facewidth: f64, outer_diameter: Option<f64>) -> Self {
        let module = cones.normal_module();
        let working = depth.working * module;
        let clearance = depth.clearance * working;
        let wheel = depth.wheel_addendum * working;
        let mean_addendum = [working - wheel, wheel];
        let mean_dedendum = [wheel + clearance, working - wheel + clearance];
        let outer = outer_diameter.map_or(facewidth / 2.0, |outer| {
            outer / (2.0 * cones.pitch_angle[1].sin()) - cones.cone_distance()[1]
        });
        let of_wheel = Reach {
            outer,
            inner: facewidth - outer,
        };
        let teeth = Teeth {
            cones,
            depth,
            working,
            clearance,
            mean_addendum,
            mean_dedendum,
        };
        let (of_pinion, pinion_angles) = if cones.offset == 0.0 {
            (of_wheel, [depth.dedendum_angle, depth.addendum_angle])
        } else {
            teeth.pinion(of_wheel)
        };
        let reach = [of_pinion, of_wheel];
        let addendum_angle = [pinion_angles[0], depth.addendum_angle];
        let dedendum_angle = [pinion_angles[1], depth.dedendum_angle];
        Self {
            mean_addendum,
            mean_dedendum,
            facewidth: reach.map(|reach| reach.outer + reach.inner),
            outer: reach.map(|reach| reach.outer),
            outer_dedendum: [0, 1].map(|i| mean_dedendum[i] + reach[i].outer * dedendum_angle[i].tan()),
            tip_diameter: [0, 1].map(|i| {
                let (sine, cosine) = cones.pitch_angle[i].sin_cos();
                let pitch = 2.0 * (cones.cone_distance()[i] + reach[i].outer) * sine;
                pitch + 2.0 * (mean_addendum[i] + reach[i].outer * addendum_angle[i].tan()) * cosine
            }),
        }
    }
}

struct Teeth<'a> {
    cones: &'a PitchCones,
    depth: &'a Depth,
    working: f64,
    clearance: f64,
    mean_addendum: [f64; 2],
    mean_dedendum: [f64; 2],
}

impl Teeth<'_> {
    /// Angle of an element of the wheel's cone in the axial plane of the pinion, for a pitch angle of that cone and the angle between both.
    /// \[rad\]
    fn element(&self, pitch_angle: f64, between: f64) -> f64 {
        let cones = self.cones;
        let beyond = cones.shaft_angle - FRAC_PI_2;
        let long = cones.cone_distance()[1] * between.cos() - cones.apex_beyond_crossing()[1] * pitch_angle.cos();
        // Blanks are surfaces of revolution: the side of the offset does not matter.
        let offset = cones.offset.abs();
        let turned = (offset * beyond.tan() * pitch_angle.cos() / long).atan();
        (offset * turned.cos() * pitch_angle.sin() / long).asin() - turned
    }

    /// Face of the pinion of a hypoid pair beyond the mean point, and its addendum and dedendum angles.
    fn pinion(&self, wheel: Reach) -> (Reach, [f64; 2]) {
        let (cones, depth) = (self.cones, self.depth);
        let beyond = cones.shaft_angle - FRAC_PI_2;
        let root = cones.pitch_angle[1] - depth.dedendum_angle;
        let angle = self.element(root, depth.dedendum_angle);
        let tip = (beyond.sin() * root.sin() + beyond.cos() * root.cos() * angle.cos()).asin();
        let wheel_tip = cones.pitch_angle[1] + depth.addendum_angle;
        let at_tip = self.element(wheel_tip, depth.addendum_angle);
        let bottom = (beyond.sin() * wheel_tip.sin() + beyond.cos() * wheel_tip.cos() * at_tip.cos()).asin();
        let [d1, d2] = cones.pitch_angle;
        let addendum_angle = tip - d1;
        let (u, offset_angle) = (cones.ratio(), cones.offset_angle().abs());
        let turned = (offset_angle.sin() * d2.cos() / (u * d1.cos() + d2.cos() * offset_angle.cos())).atan();
        let facewidth = wheel.outer + wheel.inner;
        let projected = facewidth * turned.cos() / (offset_angle - turned).cos();
        let of_depth = self.working * angle.sin() * (1.0 - 1.0 / u);
        let rise = (self.mean_dedendum[1] - self.clearance) * d1.sin();
        let inclined = tip.cos() / addendum_angle.cos();
        let outer = wheel.outer / facewidth * projected * inclined + of_depth - rise;
        let inner = wheel.inner / facewidth * projected * inclined + of_depth + rise;
        let addendum = self.mean_addendum[0] * d1.sin();
        let reach = Reach {
            outer: (outer + addendum) / inclined,
            inner: (inner - addendum) / (d1.cos() - addendum_angle.tan() * d1.sin()),
        };
        (reach, [addendum_angle, d1 - bottom])
    }
}
