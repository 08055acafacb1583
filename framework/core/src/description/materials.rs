//! Materials of gears.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::material::{Conductor, Elastic, Material, MaterialKind, SOFTEST_METAL};
use crate::mechanism::worm_mesh::WheelMaterial;

/// A material, which gears name; models take what they need of it.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct MaterialEntry {
    /// Designation in a catalogue of materials, such as `steel` or `POM`; fills the omitted keys.
    #[schemars(extend("x-refers-to" = "catalogue"))]
    pub designation: Option<String>,
    /// Kind, by which laws of friction and temperature are chosen; default: that of the catalogue, else steel; required for a
    /// modulus below 20 GPa.
    pub kind: Option<MaterialKind>,
    /// Young's modulus at the temperature of the teeth; default: that of the catalogue. [GPa]
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub elastic_modulus: Option<f64>,
    /// Poisson's ratio; default: that of the catalogue. [-]
    #[schemars(range(min = 0.0, max = 0.49))]
    pub poisson: Option<f64>,
    /// Density; default: that of the catalogue. [kg/m3]
    #[schemars(range(min = 500.0, max = 25000.0))]
    pub density: Option<f64>,
    /// Thermal conductivity; default: that of the catalogue. [W/(m K)]
    #[schemars(range(min = 0.05, max = 500.0))]
    pub conductivity: Option<f64>,
    /// Specific heat; default: that of the catalogue. [J/(kg K)]
    #[schemars(range(min = 50.0, max = 5000.0))]
    pub heat_capacity: Option<f64>,
    /// Permissible Hertzian pressure of a flank, at the temperature and life that it is meant for; ratings compare with it. [MPa]
    #[schemars(range(min = 1.0, max = 10000.0))]
    pub permissible_pressure: Option<f64>,
    /// Permissible temperature of a tooth; ratings compare with it. [degC]
    #[schemars(range(min = -50.0, max = 1500.0))]
    pub permissible_temperature: Option<f64>,
    /// What this material is as the rim of a worm wheel, for laws of worm drives.
    pub worm_wheel: Option<WheelMaterial>,
    /// Source of the values.
    pub source: Option<String>,
}

impl MaterialEntry {
    /// The material.
    ///
    /// # Errors
    /// The key that is missing or does not suffice, with what is wrong.
    pub fn material(&self) -> Result<Material, (&'static str, String)> {
        let missing = |key: &'static str, what: &str| (key, format!("{what} of the material is not known"));
        let elastic = Elastic {
            modulus: self
                .elastic_modulus
                .ok_or_else(|| missing("elastic_modulus", "Young's modulus"))?,
            poisson: self.poisson.ok_or_else(|| missing("poisson", "Poisson's ratio"))?,
        };
        let thermal = match (self.conductivity, self.density, self.heat_capacity) {
            (Some(conductivity), Some(density), Some(heat_capacity)) => Some(Conductor {
                conductivity,
                density,
                heat_capacity,
            }),
            (None, _, None) => None,
            (conductivity, density, _) => {
                let (key, what) = match (conductivity, density) {
                    (None, _) => ("conductivity", "thermal conductivity"),
                    (_, None) => ("density", "density"),
                    _ => ("heat_capacity", "specific heat"),
                };
                return Err((
                    key,
                    format!("{what} is not known, without which the others have no effect"),
                ));
            }
        };
        if self.kind.is_none() && elastic.modulus < SOFTEST_METAL {
            let fault = "the kind of the material is not known, and its Young's modulus is below 20 GPa, which no metal of gears has";
            return Err(("kind", fault.to_owned()));
        }
        Ok(Material {
            kind: self.kind.unwrap_or_default(),
            elastic,
            thermal,
            permissible_pressure: self.permissible_pressure,
            permissible_temperature: self.permissible_temperature,
        })
    }
}
