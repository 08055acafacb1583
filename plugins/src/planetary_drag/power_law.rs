//! A power law of speed, viscosity and oil volume.
//!
//! Source: user-defined, fitted to simulations or measurements (Concli 2015 interpolates the drag of planetary gearboxes over
//! speed, temperature and oil level in this way): T = T_0 (n/n_0)^a (nu/nu_0)^b (V/V_0)^c. With a reference point the factor is a
//! torque; otherwise its unit would depend on the exponents.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::generic::PLACE;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::gear_drag::Covers;
use gearloss_framework::mechanism::planetary_drag::{PlanetaryDrag, PlanetaryDragAt, PlanetaryDragModel};
use gearloss_framework::registry::{Build, Evidence, USER_DEFINED, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { TERM = no_load("drag"); }

/// A power law of speed, viscosity and oil volume, fitted to simulations or measurements.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PowerLaw {
    /// Torque on the reference shaft at the reference point. [Nm]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub moment: f64,
    /// Speed of the reference shaft at the reference point. [rpm]
    #[schemars(range(min = 0.1, max = 1e6))]
    pub speed: f64,
    /// Kinematic viscosity at the reference point. [mm2/s]
    #[schemars(range(min = 0.1, max = 1e6))]
    pub nu: f64,
    /// Oil volume at the reference point; default: the volume has no effect. [ml]
    #[schemars(range(min = 0.1, max = 1e7))]
    pub volume: Option<f64>,
    /// Exponent of the speed. [-]
    #[schemars(range(min = -5.0, max = 5.0))]
    pub speed_exponent: f64,
    /// Exponent of the viscosity. [-]
    #[serde(default)]
    #[schemars(range(min = -5.0, max = 5.0))]
    pub viscosity_exponent: f64,
    /// Exponent of the volume. [-]
    #[serde(default)]
    #[schemars(range(min = -5.0, max = 5.0))]
    pub volume_exponent: f64,
    /// Speed range of the underlying points; exceeding it is noted. [rpm]
    #[schemars(inner(range(min = 0.0, max = 1e6)))]
    pub speeds: Option<[f64; 2]>,
    /// Viscosity range of the underlying points. [mm2/s]
    #[schemars(inner(range(min = 0.0, max = 1e6)))]
    pub viscosities: Option<[f64; 2]>,
    /// Oil volume range of the underlying points. [ml]
    #[schemars(inner(range(min = 0.0, max = 1e7)))]
    pub volumes: Option<[f64; 2]>,
}

fn prepare(law: PowerLaw, cx: &mut Build<'_>) -> Result<PowerLaw, Diagnostic> {
    let known = cx.part::<PlanetaryDrag>().is_none_or(|part| part.oil_volume.is_some());
    if law.volume.is_some() && !known {
        return Err(cx
            .error("the law depends on the oil volume, which is not known here")
            .help("state `housing.oil.volume`, or omit `volume` and `volume_exponent`"));
    }
    if law.volume.is_none() && (law.volume_exponent != 0.0 || law.volumes.is_some()) {
        return Err(cx
            .error("`volume_exponent` or `volumes` without `volume`")
            .help("state the volume at the reference point"));
    }
    let rising = |range: Option<[f64; 2]>| range.is_none_or(|[least, greatest]| least < greatest);
    if ![law.speeds, law.viscosities, law.volumes].into_iter().all(rising) {
        return Err(cx
            .error("a range of the law does not increase")
            .help("write the minimum first"));
    }
    Ok(law)
}

impl PlanetaryDragModel for PowerLaw {
    fn covers(&self) -> Covers {
        Covers {
            churning: true,
            squeezing: false,
            windage: true,
        }
    }

    fn loss(&self, at: &PlanetaryDragAt<'_>) -> Result<Loss, Undefined> {
        if at.at_rest()? {
            return Ok(Loss::MOMENTS);
        }
        let speed = at.speed.abs();
        let place =
            |range: Option<[f64; 2]>, x: f64| range.map_or(0.5, |[least, greatest]| (x - least) / (greatest - least));
        let farthest = [
            place(self.speeds, speed),
            place(self.viscosities, at.nu),
            place(self.volumes, at.volume),
        ];
        let out = |p: &f64| (p - 0.5).abs();
        let farthest = farthest.into_iter().max_by(|a, b| out(a).total_cmp(&out(b)));
        at.check(&PLACE, farthest.unwrap_or(0.5));
        let by_speed = at.show("(n/n_0)^a", "-", (speed / self.speed).powf(self.speed_exponent));
        let by_viscosity = at.show("(nu/nu_0)^b", "-", (at.nu / self.nu).powf(self.viscosity_exponent));
        let by_volume = match self.volume {
            Some(volume) => at.show("(V/V_0)^c", "-", (at.volume / volume).powf(self.volume_exponent)),
            None => 1.0,
        };
        let moment = at.show("T", "Nm", self.moment * by_speed * by_viscosity * by_volume);
        Ok(Loss::MOMENTS.with(&TERM, moment))
    }
}

register!(PlanetaryDrag, "power_law", PowerLaw,
    source: USER_DEFINED,
    example: "{ type: power_law, moment: 0.05 Nm, speed: 300 rpm, nu: 100 mm2/s, volume: 90 ml, speed_exponent: 0.6, \
              viscosity_exponent: 0.4, volume_exponent: 0.8 }",
    evidence: [formula(Evidence::User, "the user states it")],
    limits: [PLACE], terms: [TERM], prepare: prepare);
