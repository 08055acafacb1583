//! What is known of a material: elastic constants, thermal properties, limits. Gears, bearings, films and ratings take them from here.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::real::Real;

/// Elastic constants of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus. \[Pa\]
    pub modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Elastic {
    /// Compliance of a half-space, (1 - nu^2)/E. \[1/Pa\]
    pub fn half_space(self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.modulus
    }

    /// Contact modulus E* with another body: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. \[Pa\]
    pub fn contact_modulus(self, other: Self) -> f64 {
        1.0 / (self.half_space() + other.half_space())
    }
}

/// Reduced modulus of two bodies, 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, which of equal bodies is E/(1 - nu^2). \[Pa\]
pub fn reduced_modulus([first, second]: [Elastic; 2]) -> f64 {
    if first == second {
        return first.modulus / (1.0 - first.poisson * first.poisson);
    }
    2.0 * first.contact_modulus(second)
}

/// Thermal properties of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Conductor {
    /// Thermal conductivity. [W/(m K)]
    #[schemars(range(min = 0.05, max = 500.0))]
    pub conductivity: f64,
    /// Density. [kg/m3]
    #[schemars(range(min = 500.0, max = 25000.0))]
    pub density: f64,
    /// Specific heat. [J/(kg K)]
    #[schemars(range(min = 50.0, max = 5000.0))]
    pub heat_capacity: f64,
}

/// Peclet number U a/(2 chi) down to which the law of fast bands, intended for more than five, is within 6 % of Jaeger's solution
/// at any speed. Limiting it to five, as some authors do, would reduce the rise by 25 % at three and by 58 % at one.
pub const FAST: f64 = 0.15;

impl Conductor {
    /// Thermal diffusivity. \[m2/s\]
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }

    /// Thermal effusivity, sqrt(k rho c). \[W s^0.5/(m2 K)\]
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.density * self.heat_capacity).sqrt()
    }

    /// Peclet number of a band of this half width (m) at this speed (m/s).
    #[inline(always)]
    pub fn peclet<R: Real>(&self, half_width: R, speed: R) -> R {
        speed * 0.5 * half_width / self.diffusivity()
    }

    /// Mean surface temperature rise over a moving band of contact per heat that enters the body, for one surface speed in m/s. \[K/W\]
    /// Uniform heat and a fast band (Blok 1937; Jaeger 1942); below [`FAST`] the value is that at the limit, so that a stationary body has
    /// a finite resistance. The maximum rise, at the trailing edge, is one and a half times the mean.
    #[inline(always)]
    pub fn resistance<R: Real>(&self, half_width: R, length: R, speed: R) -> R {
        let least = R::constant(2.0 * FAST * self.diffusivity()) / half_width;
        let swept = speed.max(least) * (self.conductivity * self.density * self.heat_capacity);
        // Two thirds of 2 q''/k sqrt(chi 2a/(pi U)) on the area 2 a L.
        (R::constant(2.0) / (half_width * PI * swept)).sqrt() * (2.0 / 3.0) / length
    }

    /// Mean rise under a uniformly heated circle at any speed according to Tian and Kennedy, from heat per area (W/m2), radius (m) and
    /// speed (m/s). \[K\]
    pub fn circle(&self, heat: f64, radius: f64, speed: f64) -> f64 {
        1.22 * heat * radius / (self.conductivity * (PI * (0.6575 + self.peclet(radius, speed))).sqrt())
    }
}

/// Young's modulus below which no metal of gears is. \[Pa\]
pub const SOFTEST_METAL: f64 = 20e9;

/// Kind of a material, by which laws of friction and temperature are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaterialKind {
    /// Steel.
    #[default]
    Steel,
    /// Cast iron.
    CastIron,
    /// Bronze and brass.
    Bronze,
    /// Polyoxymethylene.
    Pom,
    /// Polyamide 66.
    Pa66,
    /// Polyetheretherketone.
    Peek,
    /// Another plastic.
    Plastic,
}

impl MaterialKind {
    /// True for plastics, whose flanks are soft and conduct little heat.
    pub fn is_plastic(self) -> bool {
        matches!(self, Self::Pom | Self::Pa66 | Self::Peek | Self::Plastic)
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steel => "steel",
            Self::CastIron => "cast iron",
            Self::Bronze => "bronze",
            Self::Pom => "POM",
            Self::Pa66 => "PA66",
            Self::Peek => "PEEK",
            Self::Plastic => "plastic",
        }
    }
}

/// A material of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Its kind.
    pub kind: MaterialKind,
    /// Elastic constants.
    pub elastic: Elastic,
    /// Thermal properties, if they are stated; a model has its own of steel.
    pub thermal: Option<Conductor>,
    /// Permissible Hertzian pressure of a flank. \[Pa\]
    pub permissible_pressure: Option<f64>,
    /// Permissible temperature of a tooth. \[degC\]
    pub permissible_temperature: Option<f64>,
}

impl Material {
    /// A metal of which only Young's modulus (Pa) and Poisson's ratio are stated.
    pub fn metal(modulus: f64, poisson: f64) -> Self {
        Self {
            kind: MaterialKind::Steel,
            elastic: Elastic { modulus, poisson },
            thermal: None,
            permissible_pressure: None,
            permissible_temperature: None,
        }
    }
}
