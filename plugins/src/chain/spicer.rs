//! Roller chains: friction of the pins in their bushes, according to Spicer.
//!
//! Source: Spicer, Richardson, Ehrlich, Bernstein, Fukuda, Terada, Effects of frictional loss on bicycle chain drive efficiency, J. Mech.
//! Des. 123 (2001) 598-605, in the form of the program BicycleEfficiency.jl: P = N_1 w_1 mu rho (pi/2) F (1/N_1 + 1/N_2).
//! Each joint turns by 2 pi/N where the taut strand runs onto a wheel and where it leaves one, against the friction mu rho F (pi/2) of a pin
//! whose pressure is distributed over half of its circumference; `contact: 1` is a pin that touches along a line. Spicer neglects the slack
//! strand. Here its joints do the same with their own tension, that of the slack strand and of the centrifugal force q v2, which the taut
//! strand carries in addition to the tension from the torque, F_u = 2 pi T/(N p). The coefficient of friction depends on lubricant and wear
//! and must be stated; the example of that program has 0.09 for a bicycle chain.
//! Friction of rollers on the teeth, of links on the sides of a misaligned wheel, impact, and oil that the chain moves are not included. Not
//! for silent chains: rocker pins roll, with far less loss.

use std::f64::consts::TAU;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::chain::{Chain, ChainAt, ChainKind, ChainLaw};
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use gearloss_framework::{coefficients, observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! {
    TAUT = load("taut strand");
    TENSION = no_load("own tension");
}
observed! { TAUT_TENSION = ("F_t", "N", "tension of the taut strand"); }

coefficients! {
    /// The constant of the friction of a pin.
    struct Constants {
        /// Factor of the friction of a pin: pi/2 for distributed pressure, one for contact along a line.
        contact = std::f64::consts::FRAC_PI_2, in 1.0..=1.6;
    }
}

/// Roller chains: friction of the pins in their bushes, according to Spicer.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Coefficient of friction between pin and bush. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub friction: f64,
    #[serde(default)]
    coefficients: Constants,
}

struct Spicer {
    /// Power over speed of the first wheel and tension of a strand. \[m\]
    factor: f64,
    /// Radius at which the tension acts on the first wheel. \[m\]
    radius: f64,
    /// Tension of the slack strand. \[N\]
    slack: f64,
    /// Mass per length. \[kg/m\]
    mass: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Spicer, Diagnostic> {
    let part = cx.own_part::<Chain>()?;
    if part.kind != ChainKind::RollerChain {
        return Err(cx
            .error("spicer computes the friction of round pins: it is for `kind: roller_chain`")
            .help("use `efficiency`, `typical` or a table for silent chains and belts"));
    }
    let (Some([z1, z2]), Some(pitch)) = (part.z, part.pitch) else {
        return Err(cx
            .error("spicer requires the numbers of teeth and the pitch of the chain")
            .help("add `z` of both wheels and `pitch`"));
    };
    let Some(pin) = part.pin_diameter else {
        return Err(cx
            .error("spicer requires the diameter of the pins")
            .help("add `pin_diameter:` to the chain; the standards of roller chains list it"));
    };
    let [z1, z2] = [z1, z2].map(f64::from);
    Ok(Spicer {
        factor: z1 * params.friction * (0.5 * pin) * params.coefficients.contact * (1.0 / z1 + 1.0 / z2),
        radius: z1 * pitch / TAU,
        slack: part.slack_tension,
        mass: part.mass_per_length(),
    })
}

impl ChainLaw for Spicer {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &ChainAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let speed = at.speed.abs();
        let chain_speed = at.show("v", "m/s", speed * self.radius);
        let pull = at.show("F_u", "N", at.torque / self.radius);
        let own = at.show("F_s", "N", chain_speed * chain_speed * self.mass + self.slack);
        at.observe(&TAUT_TENSION, pull + own);
        let factor = speed * self.factor;
        Ok(Loss::POWERS
            .with(&TAUT, factor * pull)
            .with(&TENSION, factor * own * 2.0))
    }
}

register!(Chain, "spicer", Params,
    source: "Spicer and others, J. Mech. Des. 123 (2001) 598-605",
    example: "{ type: spicer, friction: 0.09 }",
    evidence: [formula(Evidence::OneSource, "as a public program quotes it; the share of the slack strand is derived")],
    checks: [
        Check {
            input: "{ part: { z: [48, 24], pitch: 6.283185307179586 mm, pin_diameter: 3.51936 mm }, model: { type: spicer, friction: 0.09 }, \
at: { speed: 80 rpm, torque: 14.4 Nm } }",
            values: &[("total", "1.8756733110 W"), ("F_t", "300 N")],
            tolerance: 1e-10,
            because: "the value has eleven digits",
            source: "BicycleEfficiency.jl, value of `P1` (mu 0.09, rho 1.75968 mm, 48 and 24 teeth, 80 1/min, 300 N), recomputed",
        },
        Check {
            input: "{ part: { z: [48, 24], pitch: 6.283185307179586 mm, pin_diameter: 3.51936 mm, slack_tension: 30 N }, \
model: { type: spicer, friction: 0.09 }, at: { speed: 80 rpm, torque: 14.4 Nm } }",
            values: &[("taut strand", "1.8756733110 W"), ("own tension", "0.37513466220 W")],
            tolerance: 1e-10,
            because: "the value has eleven digits",
            source: "calculated by hand: the joints of both strands carry a tenth of 300 N in addition",
        },
    ],
    terms: [TAUT, TENSION], observed: [TAUT_TENSION], prepare: prepare);
