//! Common part of the dimensional churning laws: T = 1/2 rho w^2 R^3 S_m C_m of an immersed gear.

use gearloss_framework::mechanism::gear_drag::GearDragAt;

use super::wetted::Wetted;

/// A rotating, immersed gear.
pub struct Dipping {
    /// Magnitude of the speed. \[rad/s\]
    pub omega: f64,
    /// Radius of the reference circle. \[m\]
    pub radius: f64,
    /// Immersion depth of the reference circle, at most its diameter. \[m\]
    pub dip: f64,
    /// Wetted surface. \[m2\]
    pub surface: f64,
}

impl Dipping {
    /// The gear; `None` if it is dry or at standstill, so that there is no loss.
    pub fn of(at: &GearDragAt<'_>) -> Option<Self> {
        let gear = &at.part.gear;
        let omega = at.speed.abs();
        if at.dip <= 0.0 || omega == 0.0 {
            at.branch("dry or at standstill: no churning");
            return None;
        }
        let radius = 0.5 * gear.reference_diameter;
        let height = 0.5 * (gear.tip_diameter - gear.root_diameter).abs();
        // The immersion depth of a fully immersed gear is its diameter.
        let dip = at.show("h", "m", at.dip.min(gear.reference_diameter));
        let surface = Wetted::new(
            radius,
            dip,
            gear.facewidth,
            f64::from(gear.z),
            height,
            gear.pressure_angle,
            gear.helix_angle,
        )
        .on_cone(radius - gear.facewidth * gear.pitch_angle.sin(), radius)
        .sum();
        Some(Self {
            omega,
            radius,
            dip,
            surface: at.show("S_m", "m2", surface),
        })
    }

    /// Torque from the dimensionless torque. \[Nm\]
    pub fn torque(&self, rho: f64, c_m: f64) -> f64 {
        0.5 * rho * self.omega * self.omega * self.radius.powi(3) * self.surface * c_m
    }
}
