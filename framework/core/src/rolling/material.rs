//! Materials of rings and rolling elements.

/// Elastic constants and density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Young's modulus. \[Pa\]
    pub modulus: f64,
    /// Poisson's ratio. \[-\]
    pub poisson: f64,
    /// Density. \[kg/m3\]
    pub density: f64,
}

impl Material {
    /// Bearing steel, with the constants of ISO/TS 16281.
    pub const STEEL: Self = Self {
        modulus: 210e9,
        poisson: 0.3,
        density: 7800.0,
    };
    /// Silicon nitride of hybrid bearings: 300 to 315 GPa and 3200 to 3240 kg/m3 in several sources, Poisson's ratio recalled.
    pub const SILICON_NITRIDE: Self = Self {
        modulus: 310e9,
        poisson: 0.26,
        density: 3200.0,
    };

    /// Contact modulus E* with another body: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. \[Pa\]
    pub fn contact_modulus(&self, other: &Self) -> f64 {
        let compliance = |body: &Self| (1.0 - body.poisson * body.poisson) / body.modulus;
        1.0 / (compliance(self) + compliance(other))
    }
}
