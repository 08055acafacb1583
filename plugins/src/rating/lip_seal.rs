//! Lip speed and temperature of radial shaft seals compared with the limits of their material.
//!
//! Sources: pages of the SKF catalogue for the temperatures of NBR (-40 to 100 degC), HNBR (to 150) and FKM (-30 to 200); the other
//! temperatures and the speeds, those of diagrams like that of DIN 3760 for unpressurised oil, are quoted from memory: 12 m/s for NBR, 14 for
//! HNBR, 18 for ACM, 35 for FKM and VMQ, 30 for PTFE.
//! The oil temperature is compared; the lip is warmer, the more so the faster the shaft. Small diameters bear less speed, and makers
//! state other limits for their compounds: state them.

use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealMaterial};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Check, Evidence, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const SPEED: Figure = Figure::greatest("v", "m/s", "lip speed");
const TEMPERATURE: Figure = Figure::greatest("theta", "degC", "oil temperature at the lip");

/// Lip speed and temperature of a radial shaft seal, compared with the limits of its material.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct LipSeal {
    /// Lip speed above which a seal is reported; default: that of its material. [m/s]
    #[schemars(range(min = 0.0, max = 200.0))]
    pub greatest_speed: Option<f64>,
    /// Temperature above which a seal is reported; default: that of its material. [degC]
    #[schemars(range(min = -60.0, max = 400.0))]
    pub greatest_temperature: Option<f64>,
    /// Temperature below which a seal is reported; default: that of its material. [degC]
    #[schemars(range(min = -100.0, max = 100.0))]
    pub least_temperature: Option<f64>,
}

/// Lip speed in m/s, minimum and maximum temperature in degC of a material.
fn limits(material: SealMaterial) -> [f64; 3] {
    match material {
        SealMaterial::Nbr => [12.0, -40.0, 100.0],
        SealMaterial::Hnbr => [14.0, -40.0, 150.0],
        SealMaterial::Acm => [18.0, -30.0, 150.0],
        SealMaterial::Fkm => [35.0, -30.0, 200.0],
        SealMaterial::Vmq => [35.0, -60.0, 160.0],
        SealMaterial::Ptfe => [30.0, -80.0, 200.0],
    }
}

impl Rating<Seal> for LipSeal {
    fn rate(&self, at: &SealAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no lip");
            return Ok(());
        }
        let of_material = at.part.material.map(limits);
        if of_material.is_none() {
            at.branch("the `material` is not stated: its limits are not known");
        }
        let speed = at.show("v", "m/s", 0.5 * at.part.diameter * at.speed.abs());
        let greatest = self.greatest_speed.or(of_material.map(|m| m[0]));
        to.add_bounded(&SPEED, speed, greatest.map_or(Bound::NONE, Bound::at_most));
        let least = self.least_temperature.or(of_material.map(|m| m[1]));
        let greatest = self.greatest_temperature.or(of_material.map(|m| m[2]));
        let bound = Bound {
            least: least.unwrap_or(Bound::NONE.least),
            greatest: greatest.unwrap_or(Bound::NONE.greatest),
        };
        to.add_bounded(&TEMPERATURE, at.show("theta", "degC", at.temperature), bound);
        Ok(())
    }
}

register_rating!(Seal, "lip_seal", LipSeal,
    source: "SKF catalogue of seals; DIN 3760:1996 for the form of the speeds",
    evidence: [formula(Evidence::Recalled, "temperatures of three materials are on pages of a maker, the others and all speeds from memory")],
    checks: [
        Check {
            input: "{ part: { diameter: 40 mm, material: nbr }, at: { speed: 6000 rpm, temperature: 110 degC } }",
            values: &[("v", "12.566 m/s")],
            tolerance: 1e-4,
            because: "rounded to five digits",
            source: "by hand: pi 40 mm 6000/min",
        },
    ],
    figures: [SPEED, TEMPERATURE]);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::rating::{Rated, RatedFigure};
    use gearloss_framework::testing::rate;

    fn rated(part: &str, at: &str) -> Rated {
        rate("lip_seal", &format!("{{ part: {part}, at: {at} }}")).rated
    }

    /// SKF: NBR to 100 degC, FKM to 200 degC.
    #[test]
    fn nbr_and_fkm() {
        let at = "{ speed: 6000 rpm, temperature: 110 degC }";
        let nbr = rated("{ diameter: 40 mm, material: nbr }", at);
        assert_eq!(nbr.figures().iter().filter(|f| f.is_outside()).count(), 2);
        let fkm = rated("{ diameter: 40 mm, material: fkm }", at);
        assert!(!fkm.figures().iter().any(RatedFigure::is_outside));
    }

    #[test]
    fn without_a_material_there_is_no_limit_and_without_contact_no_rating() {
        let at = "{ speed: 30000 rpm, temperature: 190 degC }";
        let unknown = rated("{ diameter: 400 mm }", at);
        assert!(unknown.figures().len() == 2 && !unknown.figures().iter().any(RatedFigure::is_outside));
        assert!(
            rated("{ diameter: 40 mm, kind: non_contact, material: nbr }", at)
                .figures()
                .is_empty()
        );
    }
}
