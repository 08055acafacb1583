//! Contact seals of rolling bearings according to the SKF catalogue, as separate seals.
//!
//! Source: SKF Rolling bearings, PUB 10000 (2013) and 17000 (2018): M = K_S1 d_s^beta + K_S2 in N mm for both seals of a bearing,
//! d_s the diameter of the counterface in mm; constants by seal, bearing and outside diameter. A single seal has half of the
//! moment, but RSL above 25 mm all of it. Non-contact seals have no loss. `diameter` of the seal is d_s. The bearing model `skf`
//! covers the same seals with its parameter `seals`.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::ShopUnits;
use gearloss_framework::mechanism::seal::{Seal, SealAt, SealKind, SealModel};
use gearloss_framework::registry::{Build, Evidence, default_of, formula};
use gearloss_framework::{register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::bearing::skf_seal::{Code, SealRow};

terms! { LIP = no_load("lip"); }

/// Contact seals of rolling bearings according to the SKF catalogue.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Seal type and kind of bearing.
    pub code: Code,
    /// Outside diameter of the bearing. [mm]
    #[schemars(range(min = 1.0, max = 5000.0))]
    pub outside: f64,
    /// Number of seals of the bearing: one or two. [-]
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 2))]
    pub seals: u32,
}

fn two() -> u32 {
    2
}

struct Skf(SealRow);

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Skf, Diagnostic> {
    SealRow::new(params.code, params.outside.mm(), params.seals)
        .map(Skf)
        .map_err(|(message, help)| cx.error(message).help(help))
}

impl SealModel for Skf {
    fn loss(&self, at: &SealAt<'_>) -> Result<Loss, Undefined> {
        if at.part.kind == SealKind::NonContact {
            at.branch("no contact: no friction");
            return Ok(Loss::MOMENTS);
        }
        let moment = at.show("M_seal", "N mm", self.0.moment(at.part.diameter.mm()));
        Ok(Loss::MOMENTS.with(&LIP, moment.nmm_in_nm()))
    }
}

register!(Seal, "skf", Params,
    source: "SKF Rolling bearings, PUB 10000 (2013) and PUB 17000 (2018)",
    example: "{ type: skf, code: rs1_deep_groove, outside: 72 mm }",
    evidence: [
        formula(Evidence::SeveralSources, "two transcriptions agree"),
        default_of("seals", Evidence::SeveralSources, "the constants are for both"),
    ],
    terms: [LIP], prepare: prepare);
