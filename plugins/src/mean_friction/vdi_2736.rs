//! Mean friction of a mesh with plastic gears, by pairing, as VDI 2736 is implemented in a public gear program.
//!
//! Source: a public gear program that names VDI 2736, for dry meshes: POM with POM 0.28, PA66 with PA66 0.40; plastic with steel 0.18 if the
//! pinion is the plastic, 0.20 if it is the steel. The guideline was not available for checking. Its values for grease and oil, and for
//! other pairings, have no open source: state `mu`, from a measurement on such gears.
//! The coefficient depends on neither load, speed nor temperature, which measurements on plastic gears contradict; it is an estimate for the
//! thermal design. Not for two metal gears.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::Undefined;
use gearloss_framework::material::MaterialKind;
use gearloss_framework::mechanism::gear_mesh::MeshPart;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt, MeanFrictionLaw};
use gearloss_framework::real::Real;
use gearloss_framework::registry::{Build, Check, Evidence, default_of, formula};
use gearloss_framework::{coefficients, observed, register};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::checks::SIX_DIGITS;

observed! { MU = ("mu_m", "-", "mean coefficient of friction"); }

coefficients! {
    /// Coefficients of friction of dry pairings.
    struct Pairings {
        /// POM with POM.
        pom_pom = 0.28, in 0.02..=1.0;
        /// PA66 with PA66.
        pa66_pa66 = 0.40, in 0.02..=1.0;
        /// A pinion of plastic with a wheel of metal.
        plastic_pinion = 0.18, in 0.02..=1.0;
        /// A pinion of metal with a wheel of plastic.
        metal_pinion = 0.20, in 0.02..=1.0;
    }
}

/// How the teeth are lubricated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Lubrication {
    /// Not at all.
    Dry,
    /// With grease; `mu` is stated.
    Grease,
    /// With oil; `mu` is stated.
    Oil,
}

/// Mean friction of a mesh with plastic gears, by pairing, as VDI 2736 is implemented in a public gear program.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// How the teeth are lubricated.
    pub lubrication: Lubrication,
    /// Coefficient of friction; default: that of the dry pairing. [-]
    #[schemars(range(min = 0.001, max = 1.0))]
    pub mu: Option<f64>,
    #[serde(default)]
    coefficients: Pairings,
}

struct OfPairing {
    mu: f64,
}

/// The coefficient of a dry pairing.
///
/// # Errors
/// A pairing that the source does not have, in words.
fn dry(pairings: &Pairings, part: &MeshPart) -> Result<f64, String> {
    let [z1, z2] = part.pair.z;
    let kinds = part.materials.map(|material| material.kind);
    let [pinion, wheel] = if z1 <= z2 { kinds } else { [kinds[1], kinds[0]] };
    match (pinion.is_plastic(), wheel.is_plastic()) {
        (true, false) => Ok(pairings.plastic_pinion),
        (false, true) => Ok(pairings.metal_pinion),
        (true, true) if (pinion, wheel) == (MaterialKind::Pom, MaterialKind::Pom) => Ok(pairings.pom_pom),
        (true, true) if (pinion, wheel) == (MaterialKind::Pa66, MaterialKind::Pa66) => Ok(pairings.pa66_pa66),
        _ => Err(format!(
            "the friction of {} with {} has no open source",
            pinion.name(),
            wheel.name()
        )),
    }
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<OfPairing, Diagnostic> {
    const HELP: &str = "state `mu`, from a measurement on such gears";
    let part = cx.own_part::<MeanFriction>()?;
    if part.plastic().is_none() {
        return Err(cx
            .error("this law is one of plastic gears, and no gear of this mesh is of plastic")
            .help("name the `material` of the plastic gear, or choose a law of metal flanks: `gearloss models mean_friction` lists them"));
    }
    if let Some(mu) = params.mu {
        return Ok(OfPairing { mu });
    }
    if params.lubrication != Lubrication::Dry {
        return Err(cx
            .error("the friction of lubricated plastic gears has no open source")
            .help(HELP));
    }
    let mu = dry(&params.coefficients, part).map_err(|fault| cx.error(fault).help(HELP))?;
    Ok(OfPairing { mu })
}

impl MeanFrictionLaw for OfPairing {
    #[inline(always)]
    fn mu<R: Real>(&self, at: &MeanFrictionAt<'_, R>) -> Result<R, Undefined> {
        Ok(at.observe(&MU, R::constant(self.mu)))
    }
}

/// A pair of the two materials, as the registrations need it.
macro_rules! pair {
    ($first:literal, $second:literal) => {
        concat!(
            "{ z: [20, 40], normal_module: 1 mm, pressure_angle: 20 deg, facewidth: 10 mm, ra: [0.4 um, 0.4 um], rq: [0.5 um, 0.5 um], materials: [",
            $first,
            ", ",
            $second,
            "] }"
        )
    };
}

register!(MeanFriction, "vdi_2736", Params,
    source: "VDI 2736-2:2014 as a public gear program has it",
    example: "{ type: vdi_2736, lubrication: dry }",
    part: pair!(
        "{ kind: steel, elastic_modulus: 206 GPa, poisson: 0.3 }",
        "{ kind: pom, elastic_modulus: 3.2 GPa, poisson: 0.35 }"
    ),
    evidence: [
        formula(Evidence::OneSource, "one public program; the guideline was not available for checking"),
        default_of("mu", Evidence::OneSource, "one public program, dry only"),
    ],
    checks: [
        Check {
            input: concat!("{ model: { type: vdi_2736, lubrication: dry }, part: ", pair!(
                "{ kind: pom, elastic_modulus: 3.2 GPa, poisson: 0.35 }", "{ kind: pom, elastic_modulus: 3.2 GPa, poisson: 0.35 }"), " }"),
            values: &[("total", "0.28")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: vdi_2736, lubrication: dry }, part: ", pair!(
                "{ kind: pa66, elastic_modulus: 1.85 GPa, poisson: 0.3 }", "{ kind: pa66, elastic_modulus: 1.85 GPa, poisson: 0.3 }"), " }"),
            values: &[("total", "0.40")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: vdi_2736, lubrication: dry }, part: ", pair!(
                "{ kind: pa66, elastic_modulus: 1.85 GPa, poisson: 0.3 }", "{ kind: steel, elastic_modulus: 206 GPa, poisson: 0.3 }"), " }"),
            values: &[("total", "0.18")],
            ..SIX_DIGITS
        },
        Check {
            input: concat!("{ model: { type: vdi_2736, lubrication: dry }, part: ", pair!(
                "{ kind: steel, elastic_modulus: 206 GPa, poisson: 0.3 }", "{ kind: pom, elastic_modulus: 3.2 GPa, poisson: 0.35 }"), " }"),
            values: &[("total", "0.20")],
            ..SIX_DIGITS
        },
    ],
    observed: [MU], plastics: true, prepare: prepare);
