//! Materials of rings and rolling elements.

use crate::material::Elastic;

/// Elastic constants and density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Elastic constants.
    pub elastic: Elastic,
    /// Density. \[kg/m3\]
    pub density: f64,
}

impl Material {
    /// Bearing steel, with the constants of ISO/TS 16281.
    pub const STEEL: Self = Self {
        elastic: Elastic {
            modulus: 210e9,
            poisson: 0.3,
        },
        density: 7800.0,
    };
    /// Silicon nitride of hybrid bearings: 300 to 315 GPa and 3200 to 3240 kg/m3 in several sources, Poisson's ratio recalled.
    pub const SILICON_NITRIDE: Self = Self {
        elastic: Elastic {
            modulus: 310e9,
            poisson: 0.26,
        },
        density: 3200.0,
    };

    /// Contact modulus E* with another body. \[Pa\]
    pub fn contact_modulus(&self, other: &Self) -> f64 {
        self.elastic.contact_modulus(other.elastic)
    }
}
