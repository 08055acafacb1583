//! Heat transfer between a rotating body and the surrounding oil, air or mist.
//!
//! Sources: Olver, IMechE G 205 (1991) 35-43 (sides and track of a gear); rotating disc in free fluid, laminar and turbulent;
//! rotating cylinder according to Becker, Int. J. Heat Mass Transfer 6 (1963) 1053-1062: Nu = 0.133 Re^(2/3) Pr^(1/3) with the diameter
//! and the surface speed. Mist properties are weighted by volume, its specific heat by mass.

use std::f64::consts::PI;

/// A fluid. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: f64,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: f64,
    /// Density. \[kg/m3\]
    pub density: f64,
    /// Specific heat. \[J/(kg K)\]
    pub heat_capacity: f64,
}

/// Dry air in a warm gear case. Only its order of magnitude matters compared with oil.
pub const AIR: Fluid = Fluid {
    conductivity: 0.029,
    eta: 2.1e-5,
    density: 1.0,
    heat_capacity: 1006.0,
};

impl Fluid {
    /// A mist of this fluid in air, from its volume fraction.
    pub fn mist(&self, share: f64) -> Self {
        let mean = |liquid: f64, air: f64| share * liquid + (1.0 - share) * air;
        let density = mean(self.density, AIR.density);
        Self {
            conductivity: mean(self.conductivity, AIR.conductivity),
            eta: mean(self.eta, AIR.eta),
            density,
            heat_capacity: mean(self.density * self.heat_capacity, AIR.density * AIR.heat_capacity) / density,
        }
    }

    /// Kinematic viscosity. \[m2/s\]
    pub fn nu(&self) -> f64 {
        self.eta / self.density
    }

    /// Thermal diffusivity. \[m2/s\]
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }

    /// Prandtl number.
    pub fn prandtl(&self) -> f64 {
        self.eta * self.heat_capacity / self.conductivity
    }

    /// Heat transfer coefficient of a disc with a radius (m) rotating at a speed (rad/s). \[W/(m2 K)\]
    pub fn disc(&self, radius: f64, speed: f64) -> f64 {
        const TURBULENT: f64 = 2.5e5;
        let (re, pr) = (speed * radius * radius / self.nu(), self.prandtl());
        let laminar = 0.585 * re.sqrt() / (0.6 / pr + 0.95 / pr.cbrt());
        let nusselt = if re <= TURBULENT {
            laminar
        } else {
            let x = TURBULENT / re;
            laminar * x + 0.015 * (pr / 0.72).cbrt() * re.powf(0.8) * (1.0 - x.powf(1.3))
        };
        nusselt * self.conductivity / radius
    }

    /// Reynolds number of a cylinder with a radius (m) rotating at a speed (rad/s), based on diameter and surface speed.
    pub fn cylinder_reynolds(&self, radius: f64, speed: f64) -> f64 {
        2.0 * speed * radius * radius / self.nu()
    }

    /// Heat transfer coefficient of a cylinder with a radius (m) rotating at a speed (rad/s). \[W/(m2 K)\]
    pub fn cylinder(&self, radius: f64, speed: f64) -> f64 {
        let re = self.cylinder_reynolds(radius, speed);
        0.133 * (re * re * self.prandtl()).cbrt() * self.conductivity / (2.0 * radius)
    }
}

/// The surfaces of a gear that exchange heat with the fluid. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Outer and inner radius of its sides. \[m\]
    pub sides: [f64; 2],
    /// Radius of its toothed face. \[m\]
    pub track: f64,
    /// Face width. \[m\]
    pub facewidth: f64,
}

impl Body {
    /// Conductance from the body to a fluid at a speed (rad/s); zero at standstill. \[W/K\]
    pub fn conductance(&self, fluid: &Fluid, speed: f64) -> f64 {
        let [outer, inner] = self.sides;
        let sides = 2.0 * PI * (outer * outer - inner * inner) * fluid.disc(outer, speed);
        let track = 2.0 * PI * self.track * self.facewidth * fluid.cylinder(self.track, speed);
        sides + track
    }

    /// Resistance from the body to a fluid at a speed (rad/s). \[K/W\]
    pub fn resistance(&self, fluid: &Fluid, speed: f64) -> f64 {
        1.0 / self.conductance(fluid, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    /// A fluid with a given conductivity, kinematic viscosity and Prandtl number.
    fn fluid(conductivity: f64, nu: f64, pr: f64) -> Fluid {
        Fluid {
            conductivity,
            eta: nu,
            density: 1.0,
            heat_capacity: pr * conductivity / nu,
        }
    }

    #[test]
    fn u4d_u4e_disc() {
        let air = fluid(0.026, 1.6e-5, 0.71);
        close(air.disc(0.030, 209.4395), 28.81207);
        close(air.disc(0.075, 1047.198), 101.8014);
    }

    #[test]
    fn u4f_track() {
        close(fluid(0.026, 1.6e-5, 0.71).cylinder(0.030, 209.4395), 42.25719);
    }

    #[test]
    fn u4g_pinion_in_oil() {
        let oil = fluid(0.14, 1.2e-5, 143.0);
        close(oil.disc(0.0298, 209.4395), 1840.890);
        close(oil.cylinder(0.0298, 209.4395), 1612.150);
        let pinion = Body {
            sides: [0.0298, 0.018],
            track: 0.0298,
            facewidth: 0.030,
        };
        close(pinion.resistance(&oil, 209.4395), 0.06418579);
    }

    #[test]
    fn a_mist_lies_between_oil_and_air() {
        let oil = Fluid {
            conductivity: 0.14,
            eta: 0.01,
            density: 820.0,
            heat_capacity: 2000.0,
        };
        assert_eq!(oil.mist(1.0), oil);
        assert_eq!(oil.mist(0.0), AIR);
        let body = Body {
            sides: [0.03, 0.018],
            track: 0.03,
            facewidth: 0.03,
        };
        let resistances = [0.0, 0.02, 0.2, 1.0].map(|share| body.resistance(&oil.mist(share), 209.0));
        assert!(resistances.windows(2).all(|r| r[1] < r[0]), "{resistances:?}");
    }
}
