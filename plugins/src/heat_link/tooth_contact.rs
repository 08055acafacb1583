//! Heat conducted from gear to gear through the teeth in contact.
//!
//! Sources: Blok 1937; Jaeger, Proc. R. Soc. NSW 76 (1942) 203-224: mean temperature rise of a flank under a fast band of contact
//! with uniform heat, B = 0.752/(L sqrt(2 a k rho c U)), half width a, length L, rolling speed U. The resistance of a pair of teeth
//! is the sum of both flanks; the number of pairs in parallel is the contact ratio. Blok's own coefficient is 0.767.
//!
//! The law is intended for Peclet numbers U a rho c/(2 k) above 5 and is within 6 % of the exact solution down to 0.15; slower
//! teeth are treated as at that limit. The link adds to the friction heat, which belongs to the sources of both gears.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::material::{Conductor, FAST};
use gearloss_framework::mechanism::heat_link::{GearMaterial, HeatLink, HeatLinkAt, HeatLinkModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{limits, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{STEEL, of_gear, part};
use crate::flank_heat::flanks;

limits! { PECLET = ("Pe", "Péclet number of the contact", "-", FAST, f64::INFINITY, "fast bands of contact, derived"); }
/// Sine of a pressure angle of 20 deg.
const SINE: f64 = 0.342_020_143_325_668_7;
/// Ratio of Blok's coefficient to that of uniform heat, 4/3/sqrt(pi).
const BLOK: f64 = 0.767 / 0.752_252_778_063_675;

/// Coefficient of the band of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// Uniform heat over the band: 0.752.
    #[default]
    Even,
    /// After Blok: 0.767.
    Blok,
}

/// Heat from gear to gear through the teeth in contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Half width of the band of contact. [mm]
    #[schemars(range(min = 1e-4, max = 10.0))]
    pub half_width: f64,
    /// Length of the line of contact; default: the face width of the gear. [mm]
    #[schemars(range(min = 0.1, max = 2000.0))]
    pub length: Option<f64>,
    /// Radius of curvature of the flank, which gives the rolling speed from the gear speed; default: that at the pitch point for a
    /// pressure angle of 20 deg. [mm]
    #[schemars(range(min = 0.01, max = 1e4))]
    pub radius: Option<f64>,
    /// Pairs of teeth in contact on average. [-]
    #[serde(default = "pairs")]
    #[schemars(range(min = 0.1, max = 20.0))]
    pub contact_ratio: f64,
    /// Coefficient of the band of contact.
    #[serde(default)]
    pub band: Band,
    /// Thermal conductivity of the flanks; default: that of the gears' materials, else 46. [W/(m K)]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub conductivity: Option<f64>,
    /// Density of the flanks; default: that of the gears' materials, else 7800. [kg/m3]
    #[schemars(range(min = 500.0, max = 20000.0))]
    pub density: Option<f64>,
    /// Specific heat of the flanks; default: that of the gears' materials, else 470. [J/(kg K)]
    #[schemars(range(min = 100.0, max = 3000.0))]
    pub heat_capacity: Option<f64>,
    /// Thermal properties of the other gear's flanks; default: those stated here for both, else of its material, else of steel.
    pub mate: Option<Conductor>,
}

fn pairs() -> f64 {
    1.5
}
/// Steel, for metals whose thermal properties are not stated.
const FLANK: Conductor = Conductor {
    conductivity: STEEL,
    density: 7800.0,
    heat_capacity: 470.0,
};

struct Teeth {
    flanks: [Conductor; 2],
    half_width: f64,
    length: f64,
    radius: f64,
    contact_ratio: f64,
    factor: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Teeth, Diagnostic> {
    let gear = part(cx).gear;
    let of_mate = params.mate.map(|thermal| GearMaterial {
        thermal: Some(thermal),
        ..GearMaterial::default()
    });
    let mate = of_mate.or(gear.map(|gear| gear.mate)).unwrap_or_default();
    let materials = [gear.map(|gear| gear.material).unwrap_or_default(), mate];
    let stated = [params.conductivity, params.density, params.heat_capacity];
    let known = materials.map(|of| (of.kind, of.thermal));
    let [own, other] = flanks(stated, FLANK, known, cx)?;
    Ok(Teeth {
        // What is stated for `mate` is its own, also where the other flank's values are stated.
        flanks: [own, params.mate.unwrap_or(other)],
        half_width: params.half_width,
        length: of_gear(
            params.length,
            |g| g.facewidth,
            "the length of the line of contact",
            "length: 30 mm",
            cx,
        )?,
        radius: of_gear(
            params.radius,
            |g| 0.5 * g.pitch_diameter * SINE,
            "the radius of curvature of the flank",
            "radius: 10 mm",
            cx,
        )?,
        contact_ratio: params.contact_ratio,
        factor: match params.band {
            Band::Even => 1.0,
            Band::Blok => BLOK,
        },
    })
}

impl HeatLinkModel for Teeth {
    fn conductance(&self, at: &HeatLinkAt<'_>) -> Result<f64, Undefined> {
        let speed = at.show("U", "m/s", at.speed * self.radius);
        let [first, second] = &self.flanks;
        let slowest = first
            .peclet(self.half_width, speed)
            .min(second.peclet(self.half_width, speed));
        at.check(&PECLET, slowest);
        // Both flanks have about the same rolling speed, exactly the same at the pitch point.
        let of = |flank: &Conductor| flank.resistance(self.half_width, self.length, speed);
        let pair = self.factor * (of(first) + of(second));
        at.show("R", "K/W", pair);
        Ok(at.show("G", "W/K", self.contact_ratio / pair))
    }
}

register!(HeatLink, "tooth_contact", Params,
    source: "Blok 1937; Jaeger 1942",
    example: "{ type: tooth_contact, half_width: 0.13 mm }",
    evidence: [
        formula(Evidence::SeveralSources, "fast bands, derivation repeated"),
        default_of("contact_ratio", Evidence::Assumed, "a typical transverse contact ratio"),
        default_of("band", Evidence::Derived, "follows from uniform heat; gear literature uses Blok's, 2 % higher"),
        default_of("conductivity", Evidence::SeveralSources, "hardened steel"),
        default_of("density", Evidence::SeveralSources, "steel"),
        default_of("heat_capacity", Evidence::SeveralSources, "steel"),
    ],
    limits: [PECLET], prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use gearloss_framework::mechanism::heat_link::HeatLinkPart;
    use gearloss_framework::registry::{Files, Registry};
    use serde_json::{Value, json};

    use super::super::cases::{at, built};
    use super::*;
    use crate::tooth_friction::ehl_mixed::cases::close;

    fn teeth(band: Band, length: Option<f64>) -> Params {
        Params {
            half_width: 1.5e-4,
            length,
            radius: Some(0.010),
            contact_ratio: 1.0,
            band,
            conductivity: None,
            density: None,
            heat_capacity: None,
            mate: None,
        }
    }

    fn resistance(params: Params, speed: f64) -> f64 {
        let part = HeatLinkPart::default();
        let model = built(prepare, params).unwrap();
        1.0 / model
            .conductance(&at(&part, speed, [0.14, 1.5e-5, 820.0, 2100.0]))
            .unwrap()
    }

    #[test]
    fn u5i_striction_of_two_teeth() {
        close(resistance(teeth(Band::Even, Some(0.030)), 500.0), 0.09971300);
        close(resistance(teeth(Band::Blok, Some(0.030)), 500.0), 0.1016678);
        let pairs = Params {
            contact_ratio: 1.6,
            ..teeth(Band::Even, Some(0.030))
        };
        close(resistance(pairs, 500.0), 0.09971300 / 1.6);
    }

    /// A plastic wheel on a steel pinion: its flank resists by the ratio of the effusivities, from the materials or as stated.
    #[test]
    fn materials_of_the_gears_resist_as_their_own_values() {
        let pom = json!({ "conductivity": 0.31, "density": 1410.0, "heat_capacity": 1470.0 });
        let plastic = json!({ "kind": "pom", "thermal": pom });
        let of = |material: Value, mate: Value, more: Value| {
            let gear = json!({ "teeth": 31, "pitch_diameter": 0.0563, "tip_diameter": 0.0599, "tooth_height": 0.0038, "facewidth": 0.03,
                "material": material, "mate": mate });
            let part = Arc::new(HeatLinkPart {
                gear: Some(serde_json::from_value(gear).unwrap()),
                ..HeatLinkPart::default()
            });
            let mut model =
                json!({ "type": "tooth_contact", "half_width": 1.5e-4, "radius": 0.01, "contact_ratio": 1.0 });
            model.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            let (registry, files) = (Registry::linked().unwrap(), Files::default());
            let slot = Build::new(&registry, &files).slot_at::<HeatLink>("link", &part, &model);
            let slot = slot.map_err(|fault| fault.to_string())?;
            let at = at(&part, 500.0, [0.14, 1.5e-5, 820.0, 2100.0]);
            Ok::<f64, String>(1.0 / slot.conductance(&at).unwrap())
        };
        let steel = || json!({});
        let both_steel = of(steel(), steel(), json!({})).unwrap();
        close(both_steel, 0.09971300);
        let effusivity = |k: f64, rho: f64, c: f64| (k * rho * c).sqrt();
        let ratio = effusivity(46.0, 7800.0, 470.0) / effusivity(0.31, 1410.0, 1470.0);
        let mixed = 0.5 * both_steel * (1.0 + ratio);
        close(of(steel(), plastic.clone(), json!({})).unwrap(), mixed);
        close(of(plastic.clone(), steel(), json!({})).unwrap(), mixed);
        close(of(steel(), steel(), json!({ "mate": pom })).unwrap(), mixed);
        close(
            of(
                steel(),
                plastic,
                json!({ "conductivity": 46.0, "density": 7800.0, "heat_capacity": 470.0 }),
            )
            .unwrap(),
            both_steel,
        );
        let error = of(json!({ "kind": "plastic" }), steel(), json!({})).unwrap_err();
        assert!(error.contains("thermal properties of a plastic gear"), "{error}");
    }

    #[test]
    fn slow_teeth_keep_a_finite_resistance() {
        let [rest, slow, fast] = [0.0, 1e-3, 100.0].map(|w| resistance(teeth(Band::Even, Some(0.030)), w));
        assert!(rest == slow && slow > fast && rest.is_finite());
    }

    #[test]
    fn a_missing_length_is_named() {
        let error = built(prepare, teeth(Band::Even, None)).err().unwrap();
        assert!(
            error.contains("length of the line of contact") && error.contains("length: 30 mm"),
            "{error}"
        );
    }
}
