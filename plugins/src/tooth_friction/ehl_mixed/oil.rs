//! The oil of a mesh in its contacts: at zero pressure at the inlet, under pressure and shear in the film.

use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::lubricant::roelands::Roelands;
use gearloss_framework::lubricant::{Lubricant, thermal};
use gearloss_framework::mechanism::gear_mesh::MeshOil;
use gearloss_framework::real::{Points, Real};
use gearloss_framework::registry::Build;

use crate::rotating::Fluid;

/// Temperature limits for viscosity laws; iterations may try film temperatures above those of any oil. \[degC\]
const ASKED: [f64; 2] = [-60.0, 400.0];

/// Behaviour of an oil under shear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rheology {
    /// Eyring stress. \[Pa\]
    pub tau0: f64,
    /// Slope of the limiting stress over mean pressure.
    pub limiting_slope: f64,
    /// Effective shear modulus. \[Pa\]
    pub shear_modulus: f64,
    /// Coefficient of boundary friction.
    pub mu_b: f64,
}

/// Values written in the model, which take precedence over those of the oil.
#[derive(Debug, Clone, Copy, Default)]
pub struct Written {
    /// Eyring stress. \[Pa\]
    pub tau0: Option<f64>,
    /// Exponent of Roelands' law over pressure.
    pub z: Option<f64>,
    /// Slope of the limiting stress over mean pressure.
    pub limiting_slope: Option<f64>,
    /// Effective shear modulus. \[Pa\]
    pub shear_modulus: Option<f64>,
    /// Coefficient of boundary friction.
    pub mu_b: Option<f64>,
}

/// Default effective shear modulus of film and surfaces; it hardly affects gears. \[Pa\]
const USUAL_MODULUS: f64 = 0.5e9;

/// The oil of a model, prepared.
#[derive(Debug, Clone)]
pub struct MeshFluid {
    /// Behaviour under shear.
    pub rheology: Rheology,
    z: Option<f64>,
    lubricant: Option<(Arc<Lubricant>, Roelands)>,
}

impl MeshFluid {
    /// The oil of a mesh; written values take precedence over those of the oil.
    ///
    /// # Errors
    /// All values that neither states.
    pub fn new(written: Written, oil: Option<&MeshOil>, cx: &Build<'_>) -> Result<Self, Diagnostic> {
        let of_lubricant = oil.map(|oil| *oil.lubricant.rheology()).unwrap_or_default();
        let mut missing = Vec::new();
        let mut need = |value: Option<f64>, key: &'static str| {
            value.unwrap_or_else(|| {
                missing.push(key);
                f64::NAN
            })
        };
        let rheology = Rheology {
            tau0: need(written.tau0.or(of_lubricant.tau0), "tau0"),
            limiting_slope: need(written.limiting_slope.or(of_lubricant.limiting_slope), "limiting_slope"),
            mu_b: need(written.mu_b.or(of_lubricant.mu_b), "mu_b"),
            shear_modulus: written
                .shear_modulus
                .or(of_lubricant.shear_modulus)
                .unwrap_or(USUAL_MODULUS),
        };
        if !missing.is_empty() {
            let fault = cx.error(format!(
                "ehl_mixed requires the rheology of the oil: {}",
                missing.join(", ")
            ));
            let values = "rheology: { tau0: 5 MPa, limiting_slope: 0.055, mu_b: 0.13 }";
            return Err(match oil {
                Some(oil) => fault.help(format!("add `{values}` to `lubricants.{}` with your values", oil.id)),
                None => fault.help(format!("write {} beside `type`", missing.join(", "))),
            });
        }
        let z = written.z.or(of_lubricant.z);
        Ok(Self {
            rheology,
            z,
            lubricant: oil.map(|oil| (Arc::clone(&oil.lubricant), oil.lubricant.roelands(z))),
        })
    }

    /// The oil at one operating point.
    #[inline(always)]
    pub fn for_supply<R: Real>(&self, supplied: Supplied<R>) -> Oil<'_, R> {
        let z = || {
            self.z
                .map_or_else(|| Roelands::exponent(supplied.alpha, supplied.eta), R::constant)
        };
        Oil {
            rheology: &self.rheology,
            lubricant: self.lubricant.as_ref().map(|(lubricant, _)| &**lubricant),
            law: match &self.lubricant {
                Some((_, law)) => law.everywhere(),
                None => Roelands::tangent(supplied.temperature, supplied.eta, supplied.beta, z()),
            },
            stated_alpha: self
                .lubricant
                .as_ref()
                .and_then(|(lubricant, _)| lubricant.stated_alpha()),
            supplied,
        }
    }
}

/// The oil supplied to the mesh. SI, temperature in degC.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supplied<R = f64> {
    /// Temperature. \[degC\]
    pub temperature: R,
    /// Kinematic viscosity. \[m2/s\]
    pub nu: R,
    /// Dynamic viscosity. \[Pa s\]
    pub eta: R,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: R,
    /// Relative decrease of the viscosity with temperature. \[1/K\]
    pub beta: R,
    /// Thermal conductivity. \[W/(m K)\]
    pub conductivity: R,
}

impl<R: Points> Supplied<R> {
    fn at_point(&self, point: usize) -> Supplied {
        Supplied {
            temperature: self.temperature.at_point(point),
            nu: self.nu.at_point(point),
            eta: self.eta.at_point(point),
            alpha: self.alpha.at_point(point),
            beta: self.beta.at_point(point),
            conductivity: self.conductivity.at_point(point),
        }
    }
}

/// The oil at one operating point. The inlet uses the oil's own viscosity law, if it has one; the film uses that of Roelands, for
/// pressure and temperature together. The temperature slope is also that of Roelands: it enters only inlet heating, where its
/// deviation of 1.4 % from ASTM D341 with density at 40 degC changes the film by 0.1 %.
#[derive(Debug, Clone, Copy)]
pub struct Oil<'a, R = f64> {
    /// Behaviour under shear.
    pub rheology: &'a Rheology,
    /// Viscosity in the film.
    pub law: Roelands<R>,
    /// Pressure-viscosity coefficient at the inlet, if the oil states it; otherwise that of the law. \[1/Pa\]
    pub stated_alpha: Option<f64>,
    /// The supplied oil.
    pub supplied: Supplied<R>,
    lubricant: Option<&'a Lubricant>,
}

/// The oil at the inlet of a contact, with natural logarithms. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InletOil<R = f64> {
    /// Viscosity. \[Pa s\]
    pub eta: R,
    /// Pressure-viscosity coefficient. \[1/Pa\]
    pub alpha: R,
    /// Thermal load eta beta U^2/k for a speed of one. \[s2/m2\]
    pub unit_thermal_load: R,
    /// Logarithm of the viscosity.
    pub ln_eta: R,
    /// Logarithm of the pressure-viscosity coefficient.
    pub ln_alpha: R,
    /// Logarithm of `unit_thermal_load`.
    pub ln_unit_thermal_load: R,
}

impl<R: Points> Oil<'_, R> {
    /// The oil at the inlet, at zero pressure and a temperature in degC.
    #[inline(always)]
    pub fn inlet(&self, temperature: R) -> InletOil<R> {
        let t = temperature.at_least(ASKED[0]).at_most(ASKED[1]);
        let eta = match self.lubricant {
            Some(lubricant) => t.lift(|t| lubricant.eta(t)),
            None => self.law.eta(R::ZERO, t),
        };
        let alpha = self
            .stated_alpha
            .map_or_else(|| Roelands::coefficient(self.law.z, eta), R::constant);
        let unit_thermal_load = eta * self.law.beta(t) / self.supplied.conductivity;
        InletOil {
            eta,
            alpha,
            unit_thermal_load,
            ln_eta: eta.ln(),
            ln_alpha: alpha.ln(),
            ln_unit_thermal_load: unit_thermal_load.ln(),
        }
    }

    /// The oil of one of the points as a coolant of gears.
    pub fn fluid(&self, point: usize) -> Fluid {
        let Supplied {
            temperature,
            nu,
            eta,
            conductivity,
            ..
        } = self.supplied.at_point(point);
        let density = eta / nu;
        Fluid {
            conductivity,
            eta,
            density,
            heat_capacity: match self.lubricant {
                Some(lubricant) => lubricant.heat_capacity(temperature),
                // Density at oil temperature instead of 15 degC differs by 2 % in its root.
                None => thermal::heat_capacity(density, temperature),
            },
        }
    }
}
