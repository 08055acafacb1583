//! Temperature of the flank and of the root of plastic gears, as VDI 2736 is implemented in a public gear program.
//!
//! Source: a public gear program that names VDI 2736 part 2: theta = theta_0 + P mu H_v (k/(b z (v_t m_n)^0.75) + R_lG/A_G) with P in W, b and m_n
//! in mm, v_t in m/s, A_G in m2. k is 6300 for the flank and 895 for the root of a plastic gear with a metal one, 9000 and 2148 for two plastics.
//! R_lG is 0 for an open drive, 0.015 to 0.045 K m2/W for a partly open housing, 0.06 for a closed one. H_v is the tooth loss factor of
//! Ohlendorf. The guideline was not available for checking: memory has 2100 for the root, and a factor for intermittent duty, which
//! is left out.
//! The program takes the teeth of the pinion for both gears; here each plastic gear has its own. Dry gears in air; not for teeth that oil
//! cools. The rating does not take the friction of the mesh model but its own `mean_friction`: state the same as the mesh's. A review calls
//! the accuracy of such temperatures limited.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::mechanism::ShopUnits as _;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt};
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::rating::{Bound, Figure, Rated, Rating};
use gearloss_framework::register_rating;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::Deserialize;

const FLANK: [Figure; 2] = [
    Figure::greatest("theta_F1", "degC", "temperature of the flank of the first gear"),
    Figure::greatest("theta_F2", "degC", "temperature of the flank of the second gear"),
];
const ROOT: [Figure; 2] = [
    Figure::greatest("theta_R1", "degC", "temperature of the root of the first gear").detail(),
    Figure::greatest("theta_R2", "degC", "temperature of the root of the second gear").detail(),
];

/// Factors k of flank and root of a plastic gear with a metal one.
const WITH_METAL: [f64; 2] = [6300.0, 895.0];
/// Factors k of flank and root of two plastic gears.
const WITH_PLASTIC: [f64; 2] = [9000.0, 2148.0];
/// Exponent of speed times module.
const EXPONENT: f64 = 0.75;

/// Temperature of the flank and of the root of plastic gears, as VDI 2736 is implemented in a public gear program.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PlasticTemperature {
    /// Law of the mean coefficient of friction; that of the mesh model is not taken: state the same. Without it nothing is rated.
    pub mean_friction: Option<ModelRef<MeanFriction>>,
    /// Temperature of the air around the gears; default: that of the oil of the mesh. [degC]
    #[schemars(range(min = -60.0, max = 200.0))]
    pub surroundings: Option<f64>,
    /// Thermal resistance of the housing R_lG in K m2/W: 0 open, 0.015 to 0.045 partly open, 0.06 closed. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub housing_resistance: f64,
    /// Heat-dissipating surface of the housing A_G; required with `housing_resistance`. [m2]
    #[schemars(range(min = 1e-4, max = 100.0))]
    pub housing_area: Option<f64>,
}

struct Prepared {
    params: PlasticTemperature,
    friction: Option<Slot<MeanFriction>>,
    /// Temperature rise through the housing per heat. \[K/W\]
    housing: f64,
}

fn prepare(params: PlasticTemperature, cx: &mut Build<'_>) -> Result<Prepared, Diagnostic> {
    let stated = params.mean_friction.as_ref();
    let friction = stated.map(|law| cx.slot("mean_friction", law)).transpose()?;
    let housing = match params.housing_area {
        Some(area) => params.housing_resistance / area,
        None if params.housing_resistance == 0.0 => 0.0,
        None => {
            return Err(cx
                .error("`housing_resistance` needs the surface of the housing")
                .help("state `housing_area`, such as 0.03 m2"));
        }
    };
    Ok(Prepared {
        params,
        friction,
        housing,
    })
}

/// Temperature rise per heat for a factor k, from face width (m), teeth, pitch line velocity (m/s) and module (m). \[K/W\]
fn rise(k: f64, facewidth: f64, z: f64, speed: f64, module: f64) -> f64 {
    k / (facewidth.mm() * z * (speed * module.mm()).powf(EXPONENT))
}

impl Rating<GearMesh> for Prepared {
    fn rate(&self, at: &GearMeshAt<'_>, to: &mut Rated) -> Result<(), Undefined> {
        let part = at.part;
        if part.plastic().is_none() {
            at.branch("no gear of this mesh is of plastic: name its `material`");
            return Ok(());
        }
        let Some(friction) = &self.friction else {
            at.branch("no friction: state `mean_friction` of the rating");
            return Ok(());
        };
        if at.torque <= 0.0 || at.speed == 0.0 {
            at.branch("no torque or no speed");
            return Ok(());
        }
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes.nested(friction.notes));
        let mu = at.show("mu", "-", friction.mu(&mean)?);
        let pair = &part.pair;
        let factor = at.show("H_v", "-", pair.loss_factor_ohlendorf());
        let heat = at.show("P_R", "W", at.torque * at.speed.abs() * mu * factor);
        let around = at.show("theta_0", "degC", self.params.surroundings.unwrap_or(at.temperature));
        let both = part.materials.iter().all(|material| material.kind.is_plastic());
        let factors = if both { WITH_PLASTIC } else { WITH_METAL };
        for (gear, material) in part.materials.iter().enumerate() {
            if !material.kind.is_plastic() {
                continue;
            }
            let bound = material.permissible_temperature.map_or(Bound::NONE, Bound::at_most);
            for (k, figure) in factors.into_iter().zip([&FLANK[gear], &ROOT[gear]]) {
                let own = rise(
                    k,
                    pair.facewidth,
                    f64::from(pair.z[gear]),
                    mean.pitch_speed,
                    pair.normal_module,
                );
                let theta = around + heat * (own + self.housing);
                to.add_bounded(figure, at.show(figure.symbol, "degC", theta), bound);
            }
        }
        Ok(())
    }
}

register_rating!(GearMesh, "plastic_temperature", PlasticTemperature,
    source: "VDI 2736-2:2014 as a public gear program has it",
    evidence: [
        formula(Evidence::OneSource, "one public program; memory has another factor of the root; the guideline was not available for checking"),
        default_of("housing_resistance", Evidence::OneSource, "an open drive"),
        default_of("surroundings", Evidence::Assumed, "the air in a housing is as warm as its oil"),
    ],
    figures: [FLANK[0], FLANK[1], ROOT[0], ROOT[1]],
    prepare: prepare);

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::testing::{assert_close, rate};

    /// 20 W, mu 0.2, H_v 0.2, b 10 mm, z 30, v m 2: computed apart from this program.
    #[test]
    fn rises_of_the_formula() {
        let heat = 20.0 * 0.2 * 0.2;
        let of = |k: f64| heat * rise(k, 0.010, 30.0, 2.0, 1e-3);
        assert_close(of(WITH_METAL[0]), 9.989_339_766, 1e-9);
        assert_close(of(WITH_PLASTIC[0]), 14.270_485_380, 1e-9);
        assert_close(of(WITH_METAL[1]), 1.419_120_491, 1e-9);
    }

    const PAIR: &str = "z: [20, 40], normal_module: 1 mm, pressure_angle: 20 deg, facewidth: 10 mm, ra: [0.4 um, 0.4 um], \
        rq: [0.5 um, 0.5 um]";
    const STEEL: &str = "{ elastic_modulus: 206 GPa, poisson: 0.3 }";
    const POM: &str = "{ kind: pom, elastic_modulus: 3.2 GPa, poisson: 0.35, permissible_temperature: 90 degC }";

    fn values(materials: [&str; 2], more: &str) -> [Option<f64>; 4] {
        let [first, second] = materials;
        let found = rate(
            "plastic_temperature",
            &format!(
                "{{ part: {{ {PAIR}, materials: [{first}, {second}] }}, at: {{ torque: 0.5 Nm, speed: 1500 rpm, temperature: 25 degC }}, \
                 rating: {{ mean_friction: {{ type: constant, value: 0.2 }}{more} }} }}"
            ),
        );
        ["theta_F1", "theta_F2", "theta_R1", "theta_R2"].map(|symbol| found.rated.value(symbol))
    }

    #[test]
    fn only_plastic_gears_are_rated() {
        assert_eq!(values([STEEL, STEEL], ""), [None; 4]);
        let [None, Some(flank), None, Some(root)] = values([STEEL, POM], "") else {
            panic!("the wheel alone is of plastic");
        };
        assert!(flank > root && root > 25.0);
        // The pinion has half as many teeth, each of which meshes twice as often.
        let [Some(first), Some(second), ..] = values([POM, POM], "") else {
            panic!("both are of plastic");
        };
        assert_close((first - 25.0) / (second - 25.0), 2.0, 1e-12);
        assert_close((second - 25.0) / (flank - 25.0), 9000.0 / 6300.0, 1e-12);
    }

    #[test]
    fn a_housing_adds_its_resistance_and_the_surroundings_count() {
        let [_, Some(open), ..] = values([STEEL, POM], ", surroundings: 40 degC") else {
            panic!("the wheel alone is of plastic");
        };
        let closed = ", surroundings: 40 degC, housing_resistance: 0.06, housing_area: 0.03 m2";
        let [_, Some(closed), ..] = values([STEEL, POM], closed) else {
            panic!("the wheel alone is of plastic");
        };
        let [_, Some(at_25), ..] = values([STEEL, POM], "") else {
            panic!("the wheel alone is of plastic");
        };
        assert_close(open - at_25, 15.0, 1e-12);
        assert!(closed > open);
    }
}
