//! Silent chains and toothed belts: a typical efficiency, for a first estimate.
//!
//! No formula for rocker pins or for the hysteresis of belts is openly published. Silent chains: 94 to 96 % are said to be guaranteed for
//! well designed drives under average conditions, 96 to 97 % to be reached under favourable ones, in the wording of an old handbook that
//! dealers of chains repeat; the middle of the guaranteed range is 0.95. Toothed belts: up to 98 % is a common statement, without
//! conditions. Both are independent of load, which no real drive is: at low torque the efficiency is lower. State the value of the maker
//! with `efficiency` where you have one, and vary this one from 0.94 to 0.97 (silent chain) and from 0.95 to 0.99 (toothed belt).

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::chain::{Chain, ChainAt, ChainKind, ChainLaw};
use gearloss_framework::registry::{Build, Evidence, formula};
use gearloss_framework::{coefficients, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { TYPICAL = load("typical"); }

coefficients! {
    /// Typical efficiencies.
    struct Values {
        /// Efficiency of a silent chain.
        silent_chain = 0.95, in 0.94..=0.97;
        /// Efficiency of a toothed belt.
        toothed_belt = 0.98, in 0.95..=0.99;
    }
}

/// Silent chains and toothed belts: a typical efficiency, for a first estimate.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    #[serde(default)]
    coefficients: Values,
}

struct Typical {
    /// Share of the power that is lost.
    share: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Typical, Diagnostic> {
    let Values {
        silent_chain,
        toothed_belt,
    } = params.coefficients;
    let efficiency = match cx.own_part::<Chain>()?.kind {
        ChainKind::SilentChain => silent_chain,
        ChainKind::ToothedBelt => toothed_belt,
        ChainKind::RollerChain => {
            return Err(cx
                .error("typical has no value for roller chains")
                .help("use `spicer`, which computes the friction of their pins, or `efficiency`"));
        }
        ChainKind::VariableBelt => {
            return Err(cx
                .error("typical has no value for belts of variable ratio")
                .help("use `efficiency` with a table over `ratio`, `torque` and `speed`, or `table`"));
        }
    };
    Ok(Typical {
        share: 1.0 - efficiency,
    })
}

impl ChainLaw for Typical {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &ChainAt<'_, R>) -> Result<Loss<R>, Undefined> {
        Ok(Loss::POWERS.with(&TYPICAL, at.torque * at.speed.abs() * self.share))
    }
}

register!(Chain, "typical", Params,
    source: "handbook wording that dealers repeat (silent chains), common statement (toothed belts)",
    example: "{ type: typical }",
    part: "{ kind: silent_chain, z: [37, 37], pitch: 9.525 mm, links: 84 }",
    evidence: [formula(Evidence::Recalled, "without conditions of measurement: 0.94 to 0.97 for silent chains, 0.95 to 0.99 for toothed belts")],
    terms: [TYPICAL], prepare: prepare);
