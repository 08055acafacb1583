//! Textbook laws of free and forced convection at plates and cylinders, and of radiation.
//!
//! Sources: free convection at a vertical plate and about a horizontal cylinder: Churchill and Chu, Int. J. Heat Mass Transfer 18
//! (1975) 1323-1329 and 1049-1053; forced convection along a plate: laminar according to Pohlhausen, turbulent with a laminar leading part
//! above Re = 5e5, Incropera and DeWitt, Fundamentals of heat and mass transfer; radiation between a small grey body and its
//! surroundings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::air::Air;

/// Stefan-Boltzmann constant. \[W/(m2 K4)\]
const SIGMA: f64 = 5.670374e-8;
const GRAVITY: f64 = 9.80665;
/// Reynolds number at which the flow along a plate becomes turbulent.
const TURBULENT: f64 = 5e5;

/// Shape of a wall for free convection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A vertical plate, by its height.
    #[default]
    Plate,
    /// A horizontal cylinder, by its diameter.
    Cylinder,
}

impl Shape {
    /// Nusselt number of free convection over height or diameter, from Rayleigh and Prandtl number.
    pub fn free(self, rayleigh: f64, prandtl: f64) -> f64 {
        let (conduction, of_prandtl) = match self {
            Self::Plate => (0.825, 0.492),
            Self::Cylinder => (0.60, 0.559),
        };
        let falling = (1.0 + (of_prandtl / prandtl).powf(9.0 / 16.0)).powf(8.0 / 27.0);
        (conduction + 0.387 * rayleigh.powf(1.0 / 6.0) / falling).powi(2)
    }
}

/// Rayleigh number from expansion (1/K), difference of temperature (K), height or diameter (m), kinematic viscosity and thermal
/// diffusivity (m2/s).
pub fn rayleigh(expansion: f64, difference: f64, size: f64, nu: f64, diffusivity: f64) -> f64 {
    GRAVITY * expansion * difference.abs() * size.powi(3) / (nu * diffusivity)
}

/// Nusselt number of the flow along a plate over its length, from Reynolds and Prandtl number.
pub fn along_plate(reynolds: f64, prandtl: f64) -> f64 {
    let flow = if reynolds < TURBULENT {
        0.664 * reynolds.sqrt()
    } else {
        0.037 * reynolds.powf(0.8) - 871.0
    };
    flow * prandtl.cbrt()
}

/// Rayleigh number and heat transfer coefficient (W/(m2 K)) of free convection in air; height or diameter in m, temperatures in
/// K.
pub fn free(shape: Shape, size: f64, wall: f64, ambient: f64) -> (f64, f64) {
    let mean = 0.5 * (wall + ambient);
    let air = Air::at_temperature(mean);
    let ra = rayleigh(1.0 / mean, wall - ambient, size, air.nu, air.nu / air.prandtl);
    (ra, shape.free(ra, air.prandtl) * air.conductivity / size)
}

/// Heat transfer coefficient of forced convection in air; speed in m/s, length in m, mean temperature in K. \[W/(m2 K)\]
pub fn forced(v: f64, length: f64, mean: f64) -> f64 {
    let air = Air::at_temperature(mean);
    along_plate(v * length / air.nu, air.prandtl) * air.conductivity / length
}

/// Combined free and forced convection in the same direction. \[W/(m2 K)\]
pub fn mixed(forced: f64, free: f64) -> f64 {
    (forced.powi(3) + free.powi(3)).cbrt()
}

/// Heat transfer coefficient of radiation; temperatures in K. \[W/(m2 K)\]
pub fn radiation(emissivity: f64, wall: f64, ambient: f64) -> f64 {
    emissivity * SIGMA * (wall * wall + ambient * ambient) * (wall + ambient)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    #[test]
    fn e4_free_convection_at_a_wall() {
        let (_, alpha) = free(Shape::Plate, 0.3, 353.15, 293.15);
        // The check value uses g = 9.81 m/s2; alpha varies with about the cube root of g.
        assert!(
            (alpha * (9.81 / GRAVITY).cbrt() / 5.81938 - 1.0).abs() < 2e-5,
            "{alpha}"
        );
        assert!((radiation(0.9, 353.15, 293.15) / 6.94790 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn u5e_plate_radiation_and_flow() {
        let (k, nu, chi) = (0.027, 1.8e-5, 2.5e-5);
        let ra = rayleigh(1.0 / 318.15, 40.0, 0.30, nu, chi);
        close(ra, 7.397756e7);
        close(Shape::Plate.free(ra, nu / chi) * k / 0.30, 5.034084);
        close(radiation(0.3, 343.15, 303.15), 2.304973);
        let re = 15.0 * 0.40 / nu;
        close(re, 333333.3);
        close(along_plate(re, 0.72) * k / 0.40, 23.19292);
    }

    /// A pipe of 0.1 m at 165 degC in air of 23 degC, Ra = 5.073e6 and Pr = 0.697: 0.60 + 0.387 x 13.108/1.20630 = 4.8053, by hand.
    #[test]
    fn a_cylinder_that_lies() {
        let nu = Shape::Cylinder.free(5.073e6, 0.697);
        assert!((nu.sqrt() / 4.8053 - 1.0).abs() < 1e-4, "{nu}");
        assert!((Shape::Cylinder.free(0.0, 0.7) - 0.36).abs() < 1e-12);
    }

    #[test]
    fn mixed_convection_is_the_greater_where_one_is_small() {
        assert!((mixed(30.0, 0.0) - 30.0).abs() < 1e-12 && (mixed(1.0, 30.0) / 30.0 - 1.0).abs() < 1e-4);
        assert!(forced(10.0, 0.3, 320.0) > forced(5.0, 0.3, 320.0));
        // The laminar and turbulent laws join continuously.
        let ratio = along_plate(1.0001 * TURBULENT, 0.7) / along_plate(0.9999 * TURBULENT, 0.7);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    }
}
