//! Flash and contact temperature of gear flanks according to Blok.
//!
//! Sources: Blok 1937: maximum rise 1.11 mu w |sqrt(v1) - sqrt(v2)|/(B_M sqrt(2 b_H)) over a Hertzian band of contact between flanks of one
//! material, of two |v1 - v2|/(B_M1 sqrt(v1) + B_M2 sqrt(v2)) in place of the difference over B_M; textbooks print the equal forms
//! 0.62 mu w^(3/4) (E'/rho)^(1/4) and 2.45 mu p_H^(3/2) (rho/E')^(1/2). B_M = sqrt(k rho c) is 13.6 N/(mm s^0.5 K) for
//! martensitic steels. The bulk temperature is that of the thermal network, else the oil temperature plus 0.47 times the mean rise along the
//! path, as ISO/TS 6336-20 estimates it for dip lubrication (1.2 times as much for injection).
//! Friction is a mean law for the whole path; the default is intended for scuffing.
//! An indicator: without the load factors, the approach factor and the tip relief of ISO/TS 6336-20. The scuffing temperature of an oil
//! comes from a test and must be stated.

use gearloss_framework::contact::sharing::SharingEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::material::Conductor;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::json;

use super::flank::{self, RatedFlanks};
use crate::flank_heat::{flanks, known};
use crate::tooth_friction::ehl_mixed::contact::Contact;
use crate::tooth_friction::ehl_mixed::temperature::blok;

const FLASH: Figure = Figure::greatest("theta_fl", "K", "maximum flash temperature");
const BULK: Figure = Figure::greatest("theta_M", "degC", "bulk temperature").detail();
const CONTACT: Figure = Figure::greatest("theta_B", "degC", "maximum contact temperature");
const SCUFFING: Figure = Figure::least("S_B", "-", "indicator of scuffing");

/// Flash temperature of gear flanks according to Blok, and their contact temperature.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct FlashTemperature {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default)]
    pub load_sharing: SharingEntry,
    /// Law of the mean coefficient of friction; default: `iso_13989`.
    pub mean_friction: Option<ModelRef<MeanFriction>>,
    /// Rise of the bulk temperature above the oil over the mean flash temperature: 0.47 for dip, 0.56 for injection lubrication; not used
    /// where a thermal network has the gears. [-]
    #[serde(default = "bulk_factor")]
    #[schemars(range(min = 0.0, max = 5.0))]
    pub bulk_factor: f64,
    /// Thermal conductivity of both flanks; default: that of the gears' materials, else 48.7. [W/(m K)]
    #[schemars(range(min = 0.1, max = 500.0))]
    pub conductivity: Option<f64>,
    /// Density of both flanks; default: that of the gears' materials, else 7800. [kg/m3]
    #[schemars(range(min = 500.0, max = 25000.0))]
    pub density: Option<f64>,
    /// Specific heat of both flanks; default: that of the gears' materials, else 487. [J/(kg K)]
    #[schemars(range(min = 50.0, max = 5000.0))]
    pub heat_capacity: Option<f64>,
    /// Scuffing temperature of the oil, from a test; without it there is no indicator. [degC]
    #[schemars(range(min = 0.0, max = 1500.0))]
    pub scuffing_temperature: Option<f64>,
    /// Indicator of scuffing below which the mesh is reported. [-]
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub least_safety: f64,
}

fn bulk_factor() -> f64 {
    0.47
}

/// The steel of gears that name no material; its `B_M` is 13.6 N/(mm s^0.5 K).
const STEEL: Conductor = Conductor {
    conductivity: 48.7,
    density: 7800.0,
    heat_capacity: 487.0,
};

fn one() -> f64 {
    1.0
}

/// The rating with the path of its mesh and its friction law.
struct Prepared {
    params: FlashTemperature,
    flanks: Option<RatedFlanks>,
    friction: Slot<MeanFriction>,
    /// Heat conduction of both flanks; `None` if that of a plastic is not known.
    conductors: Option<[Conductor; 2]>,
}

fn prepare(params: FlashTemperature, cx: &mut Build<'_>) -> Result<Prepared, Diagnostic> {
    let default = || ModelRef::new(json!({ "type": "iso_13989" }));
    let chosen = params.mean_friction.clone().unwrap_or_else(default);
    let friction = cx.slot("mean_friction", &chosen)?;
    let part = cx.own_part::<GearMesh>()?.clone();
    let (drive, coast) = cx.load_sharings(&part, &params.load_sharing)?;
    Ok(Prepared {
        flanks: RatedFlanks::new(&part.pair, &drive, coast.as_ref()),
        conductors: flanks(
            [params.conductivity, params.density, params.heat_capacity],
            STEEL,
            part.materials.map(known),
            cx,
        )
        .ok(),
        friction,
        params,
    })
}

impl Rating<GearMesh> for Prepared {
    fn rate(&self, at: &GearMeshAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let Some(path) = self.flanks.as_ref().map(|flanks| flanks.at(at)) else {
            at.branch("no path of contact of involute flanks");
            return Ok(());
        };
        if at.torque <= 0.0 || at.speed == 0.0 {
            at.branch("no torque or no speed");
            return Ok(());
        }
        let Some(conductors) = &self.conductors else {
            at.branch("the thermal properties of a plastic gear are not known: state those of its material");
            return Ok(());
        };
        let params = &self.params;
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes.nested(self.friction.notes));
        let mu = at.show("mu", "-", self.friction.mu(&mean)?);
        let (mut greatest, mut sum, mut length) = (0.0_f64, 0.0, 0.0);
        flank::contacts(path, at, &mean, |i, contact| {
            let first_faster = path.first_faster(i);
            let speeds = Contact::speeds(contact.sliding, contact.sum_speed, first_faster);
            let place = Contact::new(
                contact.line_load,
                contact.radius,
                contact.modulus,
                contact.length,
                speeds,
            );
            let rise = blok(mu, &place, conductors);
            greatest = greatest.max(rise);
            let weight = path.points()[i].weight;
            sum += weight * rise;
            length += weight;
        });
        to.add(&FLASH, at.show("theta_fl", "K", greatest));
        let bulk = match at.bodies()? {
            Some([first, second]) => {
                at.branch("bulk temperature of the thermal network, the warmer gear");
                first.max(second)
            }
            None => at.temperature + params.bulk_factor * at.show("theta_flm", "K", sum / length),
        };
        to.add(&BULK, at.show("theta_M", "degC", bulk));
        let contact = at.show("theta_B", "degC", bulk + greatest);
        to.add(&CONTACT, contact);
        if let Some(scuffing) = params.scuffing_temperature {
            let rise = contact - at.temperature;
            if rise > 0.0 {
                let safety = at.show("S_B", "-", (scuffing - at.temperature) / rise);
                to.add_bounded(&SCUFFING, safety, Bound::at_least(params.least_safety));
            }
        }
        Ok(())
    }
}

register_rating!(GearMesh, "flash_temperature", FlashTemperature,
    source: "Blok 1937; ISO/TS 6336-20:2017 for the bulk temperature",
    evidence: [
        formula(Evidence::Recalled, "Blok's factors are printed in textbooks; the estimate of the bulk temperature is from memory"),
        default_of("conductivity", Evidence::OneSource, "with the two others B_M of martensitic steels, as the manual of a gear program prints it"),
        default_of("bulk_factor", Evidence::Recalled, "ISO/TS 6336-20"),
    ],
    figures: [FLASH, BULK, CONTACT, SCUFFING],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::registry::RatedAlone;
    use gearloss_framework::testing::{assert_close, rate};
    use std::f64::consts::PI;

    const FRICTION: &str = "mean_friction: { type: constant, value: 0.06 }";

    fn rated(at: &str, rating: &str) -> RatedAlone {
        rate("flash_temperature", &format!("{{ at: {at}, rating: {{ {rating} }} }}"))
    }

    fn value(rated: &RatedAlone, symbol: &str) -> f64 {
        rated.rated.value(symbol).unwrap()
    }

    /// Tribology in Machine Design, page 76: the factors 1.11, 0.62 and 2.45 of the three forms of Blok's formula.
    #[test]
    fn the_printed_forms_of_blok_are_equal() {
        let (mu, load, radius, modulus, speeds) = (0.06, 3e5, 0.01, 226.4e9, [12.0, 5.0]);
        let effusivity = STEEL.effusivity();
        assert_close(effusivity, 13_600.0, 1e-3);
        let contact = Contact::new(load, radius, modulus, 0.02, speeds);
        let one = blok(mu, &contact, &[STEEL; 2]);
        // The form for two materials is the same of one.
        let mut nearly = STEEL;
        nearly.density *= 1.0 + 1e-12;
        assert_close(blok(mu, &contact, &[STEEL, nearly]), one, 1e-9);
        let slid = mu * (speeds[0].sqrt() - speeds[1].sqrt()) / effusivity;
        assert_close(
            0.62 * load.powf(0.75) * (modulus / radius).powf(0.25) * slid,
            one,
            0.005,
        );
        let pressure = (load * modulus / (2.0 * PI * radius)).sqrt();
        assert_close(2.45 * pressure.powf(1.5) * (radius / modulus).sqrt() * slid, one, 0.01);
    }

    /// Blok's law: proportional to friction, to the root of the speed, and to the load to the power of 3/4.
    #[test]
    fn powers_of_the_law() {
        let flash = |at: &str| value(&rated(at, FRICTION), "theta_fl");
        let base = flash("{ torque: 100 Nm, speed: 1000 rpm }");
        assert_close(flash("{ torque: 100 Nm, speed: 4000 rpm }") / base, 2.0, 1e-9);
        assert_close(
            flash("{ torque: 200 Nm, speed: 1000 rpm }") / base,
            2.0_f64.powf(0.75),
            1e-9,
        );
        let twice = value(
            &rated(
                "{ torque: 100 Nm, speed: 1000 rpm }",
                "mean_friction: { type: constant, value: 0.12 }",
            ),
            "theta_fl",
        );
        assert_close(twice / base, 2.0, 1e-9);
    }

    #[test]
    fn contact_is_bulk_and_flash() {
        let found = rated("{ temperature: 80 degC }", FRICTION);
        assert_close(
            value(&found, "theta_B"),
            value(&found, "theta_M") + value(&found, "theta_fl"),
            1e-12,
        );
        let rise = 0.47 * found.step("theta_flm").unwrap();
        assert_close(value(&found, "theta_M"), 80.0 + rise, 1e-12);
        let network = rated(
            "{ bodies_known: 1, temperature_1: 95 degC, temperature_2: 90 degC }",
            FRICTION,
        );
        assert_close(value(&network, "theta_M"), 95.0, 1e-12);
    }

    #[test]
    fn scuffing_needs_its_temperature() {
        assert_eq!(rated("{}", FRICTION).rated.value("S_B"), None);
        let found = rated(
            "{ temperature: 80 degC }",
            &format!("{FRICTION}, scuffing_temperature: 90 degC"),
        );
        let by_hand = 10.0 / (value(&found, "theta_B") - 80.0);
        assert_close(value(&found, "S_B"), by_hand, 1e-12);
    }
}
