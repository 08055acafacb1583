//! Cardan joints: friction of the trunnions of the cross.
//!
//! Derived for a rigid cross with the friction mu of its four trunnions and negligible fluctuation of speed and torque on the driving side.
//! In one revolution the cross oscillates by the joint angle beta to either side about its axis in each yoke. The couple between the yokes is
//! perpendicular to both axes of the cross, so it is T/cos q_1 with the present angle q_1 in the first yoke, and q_2 in the second has
//! cos q_1 = cos beta/cos q_2. The work of friction per revolution is the integral of mu (r/R) T/cos q_1 (|dq_1| + |dq_2|) =
//! 4 mu (r/R) T (ln tan(pi/4 + beta/2) + tan beta), with the radius r of the trunnions and R from the middle of the joint to the middle of a
//! trunnion. For small angles the share of the power is (4/pi) mu (r/R) beta. `friction` is that of the trunnions in their bearings: for needle
//! bearings the equivalent of their friction at the trunnion, to be stated. Seals of the trunnions, the churning of grease and inertia are
//! not included.

use std::f64::consts::PI;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::joint::{Joint, JointAt, JointKind, JointLaw};
use gearloss_framework::registry::{Build, Check, Evidence, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::Deserialize;

terms! { TRUNNIONS = load("trunnions"); }
observed! { SHARE = ("1 - eta", "-", "share of the power that the joint loses"); }

/// Cardan joints: friction of the trunnions of the cross.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct Params {
    /// Coefficient of friction of the trunnions, at their radius. [-]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub friction: f64,
    /// Radius of the trunnions. [mm]
    #[schemars(range(min = 0.5, max = 500.0))]
    pub trunnion_radius: f64,
    /// Distance from the middle of the joint to the middle of a trunnion. [mm]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub arm: f64,
}

struct Cross {
    /// Share of the power over the function of the angle.
    factor: f64,
}

fn prepare(params: Params, cx: &mut Build<'_>) -> Result<Cross, Diagnostic> {
    if cx.own_part::<Joint>()?.kind != JointKind::Cardan {
        return Err(cx
            .error("cross computes the friction of the cross of a cardan joint")
            .help("write `kind: cardan`, or use `efficiency` for a constant-velocity joint"));
    }
    if params.arm <= params.trunnion_radius {
        return Err(cx
            .error("the trunnions are thicker than their arm is long")
            .help("state `arm`, from the middle of the joint to the middle of a trunnion, and `trunnion_radius`"));
    }
    Ok(Cross {
        factor: 2.0 / PI * params.friction * params.trunnion_radius / params.arm,
    })
}

impl JointLaw for Cross {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &JointAt<'_, R>) -> Result<Loss<R>, Undefined> {
        // asinh(tan(beta)) is ln tan(pi/4 + beta/2), also exactly zero without an angle.
        let turned = at.angle.lift(|beta| beta.tan() + beta.tan().asinh());
        let share = at.observe(&SHARE, turned * self.factor);
        Ok(Loss::POWERS.with(&TRUNNIONS, at.torque * at.speed.abs() * share))
    }
}

register!(Joint, "cross", Params,
    source: "derived: friction of the trunnions over a revolution",
    example: "{ type: cross, friction: 0.02, trunnion_radius: 8 mm, arm: 30 mm }",
    evidence: [formula(Evidence::Derived, "its integral over a revolution was checked numerically")],
    checks: [
        Check {
            input: "{ part: { kind: cardan, angle: 10 deg }, model: { type: cross, friction: 0.1, trunnion_radius: 8 mm, arm: 30 mm }, \
at: { angle: 10 deg, torque: 100 Nm, speed: 10 rad/s } }",
            values: &[("1 - eta", "0.005971541175 -"), ("total", "5.971541175 W")],
            tolerance: 1e-9,
            because: "the value has ten digits",
            source: "numerical quadrature over a revolution of the cross with vectors, 200000 steps",
        },
        Check {
            input: "{ part: { kind: cardan, angle: 30 deg }, model: { type: cross, friction: 0.1, trunnion_radius: 8 mm, arm: 30 mm }, \
at: { angle: 30 deg, torque: 100 Nm, speed: 10 rad/s } }",
            values: &[("1 - eta", "0.01912671332 -"), ("total", "19.12671332 W")],
            tolerance: 1e-9,
            because: "the value has ten digits",
            source: "numerical quadrature over a revolution of the cross with vectors, 200000 steps",
        },
    ],
    terms: [TRUNNIONS], observed: [SHARE], prepare: prepare);
