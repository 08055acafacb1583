//! Mesh loss from local friction integrated along the path of contact.
//!
//! Source: sliding power mu K F_bn v_g at each point, averaged over one base pitch of the mesh cycle (Niemann/Winter,
//! Maschinenelemente 2; Wimmer 2006). For constant friction it equals mean friction times the local loss factor.
//! An option averages over the travel of one tooth with double contact counted twice, as in equation 3 of Shen and Rinderknecht
//! (Modelling of transmission losses with parameter identification); for constant friction the result is 20 % above the mesh-cycle
//! average of an FZG C gear.
//! Assumes a load sharing among pairs of teeth: a fixed one, or one that depends on the load (a relief, a file, thin slices), whose loss is
//! interpolated between some loads. The line load is the normal force of the pair over the length of its
//! line of contact, b/cos beta_b for helical teeth: F_bt/b times the share.
//! Rolling friction is optional. One law is Goksem and Hargreaves, J. Lubr. Tech. 100 (1978) 346-352, times the factor for film
//! thinning by inlet heating (Gupta et al. in the form of Arana et al. 2019; at least a twentieth, where the fit ends), because the
//! isothermal law grows too fast with viscosity and speed. The other is 9e7 N/m2 times film thickness and line length according to Crook
//! 1963 as used by Anderson and Loewenthal, with the minimum film thickness of Dowson and Higginson, times the sum velocity (some
//! authors use half of it, which is an option). Without torque the loss is zero; rolling friction hardly depends on load, so with
//! it the loss jumps at zero torque by about a watt.
//! The integral is within 1e-4 of its limit for any law of friction: each smooth section of the path between A, B, C, D and E, and
//! between the kinks of the load sharing, has as many nodes as the law requires, denser at its ends. Rolling friction according to Crook,
//! whose film grows without bound where the load ramp starts, is within 2e-3.

use std::sync::Arc;

use gearloss_framework::contact::sharing::{Knots, Sharing, SharingEntry};
use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::PathPoint;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshLaw, MeshPart};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::{PathAt, PathNode, ToothFriction};
use gearloss_framework::real::{Mask as _, Real};
use gearloss_framework::registry::{Build, Check, Evidence, ModelRef, Slot, default_of, formula};
use gearloss_framework::{observed, register, terms};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gearloss_framework::contact::path::{FrictionPath, PathFriction};
use gearloss_framework::contact::{dowson_higginson, heating, thinned};

use crate::checks::SIX_DIGITS;

terms! {
    SLIDING = load("sliding");
    ROLLING = load("rolling");
}
observed! {
    MU_MEAN = ("mu_mean", "-", "coefficient of friction, weighted by load and sliding speed");
    LOSS_FACTOR = ("H_vL", "-", "local tooth loss factor of the load sharing");
}

/// Domain of averaging.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Average {
    /// Over one base pitch: the mean over time.
    #[default]
    BasePitch,
    /// Over the travel of one tooth with double contact counted twice, for comparison with publications.
    ToothTravel,
}

/// Rolling friction law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rolling {
    /// None.
    #[default]
    None,
    /// Goksem and Hargreaves.
    GoksemHargreaves,
    /// Crook, as used by Anderson and Loewenthal.
    Crook,
}

/// Velocity that multiplies the rolling force of Crook.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RollingSpeed {
    /// The sum velocity.
    #[default]
    Sum,
    /// The mean velocity, which halves the loss.
    Mean,
}

/// Local friction integrated along the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PathIntegral {
    /// Load sharing among pairs of teeth in contact.
    #[serde(default)]
    pub load_sharing: SharingEntry,
    /// Domain of averaging.
    #[serde(default)]
    pub average: Average,
    /// Local friction law of the flanks.
    pub tooth_friction: ModelRef<ToothFriction>,
    /// Rolling friction law.
    #[serde(default)]
    pub rolling_friction: Rolling,
    /// Inlet heating lowers the rolling force of Goksem and Hargreaves; otherwise their law is isothermal.
    #[serde(default = "yes")]
    pub rolling_thermal: bool,
    /// Velocity that multiplies the rolling force of Crook.
    #[serde(default)]
    pub rolling_speed: RollingSpeed,
}

fn yes() -> bool {
    true
}

/// The path of one mesh, prepared.
struct Integral {
    drive: FlankPath,
    /// The path of the coast flank, if that has its own load sharing.
    coast: Option<FlankPath>,
    friction: Slot<ToothFriction>,
}

/// The path of one flank.
struct FlankPath {
    /// The path with its local loss factor at each knot of the load sharing.
    path: Arc<(FrictionPath, Vec<f64>)>,
    rolling: Option<Vec<RollingPath>>,
}

/// What a path tells at an operating point.
struct AlongFlank<R> {
    friction: PathFriction<R>,
    loss_factor: R,
    /// Power of rolling friction, if it is not neglected. \[W\]
    rolling: Option<R>,
}

fn prepare(params: PathIntegral, cx: &mut Build<'_>) -> Result<Integral, Diagnostic> {
    let friction = cx.slot("tooth_friction", &params.tooth_friction)?;
    let part = cx.own_part::<GearMesh>()?.clone();
    let (drive, coast) = cx.load_sharings(&part, &params.load_sharing)?;
    let mut path = |step, sharing| flank_path(&params, &part, (step, sharing), &friction, cx);
    Ok(Integral {
        drive: path("path", drive)?,
        coast: coast.map(|coast| path("path of the coast flank", coast)).transpose()?,
        friction,
    })
}

/// The path of a flank with its load sharing; the name of the step is its own.
fn flank_path(
    params: &PathIntegral,
    part: &MeshPart,
    (step, sharing): (&str, Sharing),
    friction: &Slot<ToothFriction>,
    cx: &mut Build<'_>,
) -> Result<FlankPath, Diagnostic> {
    let (pair, average) = (part.pair, params.average);
    let [start, .., end] = pair.points;
    let weight = |p: &PathPoint| match average {
        Average::BasePitch => p.weight / pair.base_pitch,
        Average::ToothTravel => p.weight * p.pairs as f64 / (end - start),
    };
    // It does not depend on oil and roughness of the part.
    let orders = (friction.order(), friction.kinked_order(), friction.friction_limits());
    let path = cx.repeat(
        step,
        (pair, sharing.clone(), average, orders),
        |_| -> Result<_, String> {
            let path = FrictionPath::new(&pair, &sharing, &**friction)?.weighted(weight);
            Ok(Arc::new((path, sharing.loss_factors(&pair))))
        },
    );
    let path = path.map_err(|fault| cx.error(fault))?;
    let rolling = path.0.all_few().map(|few| {
        // What rolls is the part of the face that carries load.
        let touching = |p: &PathPoint| if p.line > 0.0 { p.share / p.line } else { 0.0 };
        let weights: Vec<f64> = few.points().iter().map(|p| weight(p) * touching(p)).collect();
        RollingPath::new(params, part, few.nodes(), &weights)
    });
    Ok(FlankPath {
        rolling: rolling.collect(),
        path,
    })
}

impl FlankPath {
    #[inline(always)]
    fn along<R: Answers>(
        &self,
        law: &Slot<ToothFriction>,
        at: &GearMeshAt<'_, R>,
        mean: &MeanFrictionAt<'_, R>,
    ) -> Result<AlongFlank<R>, Undefined> {
        let bodies = at.bodies()?;
        let (path, loss_factors) = &*self.path;
        let at_path = path
            .few()
            .at_operating_point(mean, at.notes.nested_at_same_state(law.notes))
            .with(|to| to.bodies = bodies);
        at.show("F_bt/b", "N/m", at_path.line_load);
        let rolling = self.rolling.as_ref();
        Ok(AlongFlank {
            friction: path.friction(&**law, &at_path)?,
            loss_factor: path.knots().between(at_path.line_load, loss_factors),
            rolling: rolling.map(|rolling| rolling_power(rolling, path.knots(), at, &at_path)),
        })
    }
}

impl Integral {
    /// What the path of the flank in contact tells.
    #[inline(always)]
    fn along<R: Answers>(
        &self,
        at: &GearMeshAt<'_, R>,
        mean: &MeanFrictionAt<'_, R>,
    ) -> Result<AlongFlank<R>, Undefined> {
        let drive = |at: &GearMeshAt<'_, R>| self.drive.along(&self.friction, at, mean);
        let Some(coast) = &self.coast else {
            return drive(at);
        };
        let coast = |at: &GearMeshAt<'_, R>| coast.along(&self.friction, at, mean);
        let (first, back) = (at.first_drives.is_above(R::HALF), at.speed.is_below(R::ZERO));
        let on_drive = (first & !back) | (!first & back);
        if on_drive.all() {
            at.branch("drive flank");
            return drive(at);
        }
        if !on_drive.any() {
            at.branch("coast flank");
            return coast(at);
        }
        let among = |mask| at.with(|to| to.notes = at.notes.among(mask));
        let (one, other) = (drive(&among(on_drive))?, coast(&among(!on_drive))?);
        let of = |one, other| R::select(on_drive, one, other);
        Ok(AlongFlank {
            friction: PathFriction {
                sliding: of(one.friction.sliding, other.friction.sliding),
                mean: of(one.friction.mean, other.friction.mean),
                arm: of(one.friction.arm, other.friction.arm),
                first_heat: of(one.friction.first_heat, other.friction.first_heat),
            },
            loss_factor: of(one.loss_factor, other.loss_factor),
            rolling: one.rolling.zip(other.rolling).map(|(one, other)| of(one, other)),
        })
    }
}

/// Exponents of viscosity times speed, of the line load and of the pressure-viscosity coefficient in the rolling force of Goksem and
/// Hargreaves, and in that of Crook with the film of Dowson and Higginson.
const GOKSEM_HARGREAVES: [f64; 3] = [0.658, 0.0126, 0.658 - 1.0];
const CROOK: [f64; 3] = [0.7, -0.13, 0.54];

/// Rolling force per length of the line of contact from the line load in N/m, radius of relative curvature in m, viscosity in Pa s, mean rolling speed
/// in m/s, pressure-viscosity coefficient in 1/Pa, reduced modulus in Pa. \[N/m\]
fn goksem_hargreaves(line_load: f64, radius: f64, eta: f64, rolling: f64, alpha: f64, modulus: f64) -> f64 {
    let (g, u, w) = (
        alpha * modulus,
        eta * rolling / (modulus * radius),
        line_load / (modulus * radius),
    );
    4.318 * (g * u).power(0.658) * w.power(0.0126) * radius / alpha
}

/// Rolling force per length of the line of contact from the film. \[N/m\]
fn crook(film: f64) -> f64 {
    film * 9.0e7
}

/// Rolling friction along a path. Both laws are products of powers, so that each node contributes a constant.
struct RollingPath {
    /// Exponents of viscosity times speed, line load and pressure-viscosity coefficient.
    exponents: [f64; 3],
    /// Power of each node for one of each of these, and for a speed of one. \[W\]
    powers: Vec<f64>,
    /// Their sum.
    power: f64,
    /// The terms of heating at the inlet for a pressure and a speed of one, unless it is neglected.
    heating: Option<Vec<[f64; 2]>>,
}

impl RollingPath {
    /// Prepares the law at nodes with their weights; none if there is no rolling friction.
    fn new(params: &PathIntegral, part: &MeshPart, nodes: &[PathNode], weights: &[f64]) -> Option<Self> {
        let modulus = part.modulus;
        let force = |node: &PathNode| {
            let rolling = 0.5 * node.sum_speed;
            match params.rolling_friction {
                _ if node.share <= 0.0 => 0.0,
                Rolling::None => 0.0,
                Rolling::GoksemHargreaves => goksem_hargreaves(node.share, node.radius, 1.0, rolling, 1.0, modulus),
                Rolling::Crook => {
                    let scale = modulus * node.radius;
                    let film = dowson_higginson(rolling / scale, modulus, node.share / scale) * node.radius;
                    match params.rolling_speed {
                        RollingSpeed::Sum => crook(film),
                        RollingSpeed::Mean => 0.5 * crook(film),
                    }
                }
            }
        };
        let exponents = match params.rolling_friction {
            Rolling::None => return None,
            Rolling::GoksemHargreaves => GOKSEM_HARGREAVES,
            Rolling::Crook => CROOK,
        };
        let power = |(node, weight): (&PathNode, &f64)| force(node) * node.sum_speed * weight * part.pair.line_length();
        let powers: Vec<f64> = nodes.iter().zip(weights).map(power).collect();
        let heats = params.rolling_thermal && params.rolling_friction == Rolling::GoksemHargreaves;
        Some(Self {
            exponents,
            power: powers.iter().sum(),
            powers,
            heating: heats.then(|| nodes.iter().map(|node| node.heating).collect()),
        })
    }

    /// Power of rolling friction. \[W\]
    #[inline(always)]
    fn power<R: Real>(&self, at: &GearMeshAt<'_, R>, path: &PathAt<'_, R>) -> R {
        let [speed, load, alpha] = self.exponents;
        let powers = (at.eta * path.speed).ln() * speed + path.line_load.ln() * load + at.alpha.ln() * alpha;
        let sum = match &self.heating {
            None => R::constant(self.power),
            Some(nodes) => {
                let [pressed, slid] = heating(at.eta * at.beta * path.speed * path.speed / at.conductivity);
                let pressed = path.unit_pressure() / at.part.modulus * pressed;
                let mut sum = R::ZERO;
                for (power, terms) in self.powers.iter().zip(nodes) {
                    sum += thinned([pressed * terms[0], slid * terms[1]]) * *power;
                }
                sum
            }
        };
        sum * powers.exp() * path.speed
    }
}

/// Power of rolling friction of the paths at the knots of a load sharing. \[W\]
#[inline(always)]
fn rolling_power<R: Real>(paths: &[RollingPath], knots: &Knots, at: &GearMeshAt<'_, R>, path: &PathAt<'_, R>) -> R {
    if let [only] = paths {
        return only.power(at, path);
    }
    let place = knots.place(path.line_load);
    let mut sum = R::ZERO;
    for (knot, rolling) in paths.iter().enumerate() {
        let part = knots.part(knot, place);
        let counts = part.is_above(R::ZERO);
        if counts.any() {
            sum += R::select(counts, rolling.power(at, path) * part, R::ZERO);
        }
    }
    sum
}

impl GearMeshLaw for Integral {
    #[inline(always)]
    fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = at.notes.among(!idle));
        let speed = at.speed.abs();
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes);
        let normal = at.show("F_bn", "N", mean.normal_force);
        let along = self.along(at, &mean)?;
        let friction = along.friction;
        at.observe(&MU_MEAN, friction.mean);
        at.observe(&LOSS_FACTOR, along.loss_factor);
        let watts = at.show("P_s", "W", friction.sliding * normal * speed);
        let loss = Loss::POWERS
            .with(&SLIDING, R::select(idle, R::ZERO, watts))
            .heats_first(friction.first_heat);
        let Some(rolling) = along.rolling else {
            return Ok(loss);
        };
        let rolling = at.show("P_r", "W", rolling);
        Ok(loss.with(&ROLLING, R::select(idle, R::ZERO, rolling)))
    }
}

register!(GearMesh, "path_integral", PathIntegral,
    source: "Niemann/Winter, Maschinenelemente 2; Wimmer 2006; Goksem and Hargreaves 1978; Crook 1963",
    example: "{ type: path_integral, tooth_friction: { type: constant, value: 0.05 }, rolling_friction: goksem_hargreaves }",
    evidence: [
        formula(Evidence::Derived, "equals friction times loss factor for constant friction"),
        default_of("load_sharing", Evidence::Assumed, "rigid teeth"),
        default_of("average", Evidence::Derived, "mean over time"),
        default_of("rolling_friction", Evidence::OneSource, "usually neglected compared with sliding"),
        default_of("rolling_thermal", Evidence::OneSource, "factor from one public source and from memory; the original law includes one"),
        default_of("rolling_speed", Evidence::Recalled, "Crook's coefficient as used by Anderson and Loewenthal, quoted from memory"),
    ],
    checks: [
        Check {
            input: "{ model: { type: path_integral, load_sharing: rigid, average: base_pitch, tooth_friction: { type: constant, \
                    value: 0.05 }, rolling_friction: none }, at: { torque: 200 Nm, speed: 1500 rpm, eta: 13.28 mPa s } }",
            values: &[("total", "312.015 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: rigid, average: tooth_travel, tooth_friction: { type: constant, \
                    value: 0.05 }, rolling_friction: none }, at: { torque: 200 Nm, speed: 1500 rpm, eta: 13.28 mPa s } }",
            values: &[("total", "375.906 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: rigid, average: base_pitch, tooth_friction: { type: xu, \
                    roughness: composite_rms }, rolling_friction: none }, part: { z: [16, 24], normal_module: 4.5 mm, \
                    pressure_angle: 20 deg, centre_distance: 91.5 mm, facewidth: 14 mm, tip_diameter: [82.636 mm, 118.544 mm], \
                    ra: [0.4 um, 0.4 um], rq: [0.353553391 um, 0.353553391 um] }, at: { torque: 200 Nm, speed: 1500 rpm, \
                    eta: 13.28 mPa s } }",
            values: &[("total", "183.716 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: rigid, average: tooth_travel, tooth_friction: { type: xu, \
                    roughness: composite_rms }, rolling_friction: none }, part: { z: [16, 24], normal_module: 4.5 mm, \
                    pressure_angle: 20 deg, centre_distance: 91.5 mm, facewidth: 14 mm, tip_diameter: [82.636 mm, 118.544 mm], \
                    ra: [0.4 um, 0.4 um], rq: [0.353553391 um, 0.353553391 um] }, at: { torque: 200 Nm, speed: 1500 rpm, \
                    eta: 13.28 mPa s } }",
            values: &[("total", "221.384 W")],
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: { type: relief, kappa: 0.5 }, tooth_friction: { type: constant, value: \
                    0.05 } }, at: { torque: 200 Nm, speed: 1500 rpm } }",
            values: &[("H_vL", "0.186967"), ("total", "293.686 W")],
            source: "closed form of the share of spur gears with linear tip reliefs, independently computed",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: { type: relief, amount: 20 um, stiffness: 14 GPa }, tooth_friction: { \
                    type: constant, value: 0.05 } }, at: { torque: 400 Nm, speed: 1500 rpm } }",
            values: &[("H_vL", "0.190898")],
            source: "closed form of the share of spur gears with linear tip reliefs, independently computed",
            ..SIX_DIGITS
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: { type: relief, amount: 20 um, stiffness: 14 GPa }, tooth_friction: { \
                    type: constant, value: 0.05 } }, at: { torque: 100 Nm, speed: 1500 rpm } }",
            values: &[("H_vL", "0.170265")],
            tolerance: 2e-3,
            because: "the loss is interpolated between the loads at which the shares are prepared",
            source: "closed form of the share of spur gears with linear tip reliefs, independently computed",
        },
        Check {
            input: "{ model: { type: path_integral, load_sharing: { type: slices, stiffness: iso6336, single_stiffness: 14 GPa }, \
                    tooth_friction: { type: constant, value: 0.05 } }, part: { z: [16, 24], normal_module: 4.5 mm, pressure_angle: 20 deg, centre_distance: 91.5 mm, \
                    facewidth: 14 mm, tip_diameter: [82.636 mm, 118.544 mm], profile_shift: [0.1817, 0.1715], ra: [0.4 um, 0.4 um], rq: [0.5 um, 0.5 um], \
                    modification: [{ tip_relief: { amount: 20 um }, crowning: 5 um }, { tip_relief: { amount: 20 um } }], misalignment: 10 \
                    um }, at: { torque: 200 Nm, speed: 1500 rpm } }",
            values: &[("H_vL", "0.183334"), ("total", "287.980 W")],
            tolerance: 2e-3,
            because: "the loss is interpolated between the loads at which the shares are prepared",
            source: "thin slices of constant stiffness, 20 slices and 200 phases, independently computed",
        },
    ],
    terms: [SLIDING, ROLLING], observed: [MU_MEAN, LOSS_FACTOR], prepare: prepare);

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use gearloss_framework::geometry::{Pair, PairSpec};
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::gear_mesh::MeshPart;
    use gearloss_framework::registry::{Files, Registry};
    use serde_json::{Value, json};
    use std::sync::Arc;

    /// FZG C14 test gears with roughness Ra and Rq in m.
    pub fn fzg_c14(ra: f64, rq: f64) -> MeshPart {
        let pair = Pair::new(&PairSpec {
            z: [16, 24],
            internal: false,
            normal_module: 4.5e-3,
            pressure_angle: 20.0_f64.to_radians(),
            helix_angle: 0.0,
            centre_distance: Some(91.5e-3),
            profile_shift: [None, None],
            tip_diameter: [Some(82.636e-3), Some(118.544e-3)],
            root_diameter: [None, None],
            facewidth: 14e-3,
            tip_shortening: true,
        });
        let one = rq / 2.0_f64.sqrt();
        MeshPart::new(pair.unwrap(), [ra, ra], [one, one], 206e9, 0.3)
    }

    /// A pair of the check cases.
    #[derive(Debug, Clone, Copy)]
    pub enum Kind {
        /// FZG C14.
        Spur,
        /// FZG C14 with the wheel written first.
        Swapped,
        /// 31/96 of 1.6 mm, 27 deg.
        Helical,
        /// 24 in 72 of 2 mm.
        Internal,
    }

    /// A pair of the check cases with its roughness.
    pub fn pair_of(kind: Kind) -> MeshPart {
        let spec = |z, module, pressure: f64, helix: f64, distance, tips: [f64; 2], facewidth| PairSpec {
            z,
            internal: false,
            normal_module: module,
            pressure_angle: pressure.to_radians(),
            helix_angle: helix.to_radians(),
            centre_distance: Some(distance),
            profile_shift: [None, None],
            tip_diameter: tips.map(Some),
            root_diameter: [None, None],
            facewidth,
            tip_shortening: true,
        };
        let spec = match kind {
            Kind::Spur => return fzg_c14(0.4e-6, 0.5e-6),
            Kind::Swapped => spec([24, 16], 4.5e-3, 20.0, 0.0, 91.5e-3, [118.544e-3, 82.636e-3], 14e-3),
            Kind::Helical => spec([31, 96], 1.6e-3, 17.5, 27.0, 115e-3, [60.2e-3, 176.251e-3], 17e-3),
            Kind::Internal => PairSpec {
                internal: true,
                ..spec([24, 72], 2e-3, 20.0, 0.0, 48e-3, [52e-3, 140.8e-3], 20e-3)
            },
        };
        MeshPart::new(Pair::new(&spec).unwrap(), [0.4e-6; 2], [0.35e-6; 2], 206e9, 0.3)
    }

    /// Effective loss factor of a mean friction model for a pair: its loss over power and constant friction.
    pub fn loss_factor(model: &Value, kind: Kind) -> f64 {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let part = Arc::new(pair_of(kind));
        let mut model = model.clone();
        model["mean_friction"] = json!({ "type": "constant", "value": 0.05 });
        let slot = Build::new(&registry, &files)
            .slot_at::<GearMesh>("model", &part, &model)
            .unwrap();
        let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
            to.torque = 100.0;
            to.speed = 100.0;
        });
        slot.loss(&at).unwrap().sum() / (0.05 * 1e4)
    }

    fn watts(model: &Value) -> f64 {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let part = Arc::new(fzg_c14(0.4e-6, 0.5e-6));
        let mut build = Build::new(&registry, &files);
        let slot = build.slot_at::<GearMesh>("model", &part, model).unwrap();
        let speed = 1500.0 * std::f64::consts::PI / 30.0;
        let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
            to.torque = 200.0;
            to.speed = speed;
            to.eta = 13.28e-3;
        });
        slot.loss(&at).unwrap().total_watts(speed)
    }

    fn model(friction: Value, average: &str) -> Value {
        json!({ "type": "path_integral", "load_sharing": "rigid", "average": average, "tooth_friction": friction, "rolling_friction": "none", "rolling_thermal": true, "rolling_speed": "sum" })
    }

    #[test]
    fn b13_rolling_force_and_power() {
        for (film, width, sum_speed, force, power) in
            [(0.8e-6, 20e-3, 10.0, 1.44, 14.4), (0.3e-6, 30e-3, 25.0, 0.81, 20.25)]
        {
            let rolling_force = crook(film) * width;
            assert!(
                (rolling_force / force - 1.0_f64).abs() < 1e-12
                    && (rolling_force * sum_speed / power - 1.0_f64).abs() < 1e-12
            );
        }
    }

    #[test]
    fn rolling_after_crook_has_the_size_of_goksem_and_its_mean_speed_halves_it() {
        let rolling = |law: &str, speed: &str| {
            let mut model = model(json!({ "type": "constant", "value": 0.0 }), "base_pitch");
            model["rolling_friction"] = law.into();
            model["rolling_speed"] = speed.into();
            watts(&model)
        };
        let (crook, goksem) = (rolling("crook", "sum"), rolling("goksem_hargreaves", "sum"));
        // Two laws of the same effect: a few watts compared with 300 W of sliding loss.
        assert!((0.25..4.0).contains(&(crook / goksem)), "{crook} {goksem}");
        assert!((rolling("crook", "mean") / crook - 0.5).abs() < 1e-12);
    }

    #[test]
    fn heating_at_the_inlet_bounds_rolling_in_thick_oil() {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let part = Arc::new(fzg_c14(0.4e-6, 0.5e-6));
        // Rolling loss at 2000 rpm and a kinematic viscosity in mm2/s.
        let watts = |thermal: bool, nu: f64| {
            let mut model = model(json!({ "type": "constant", "value": 0.0 }), "base_pitch");
            (model["rolling_friction"], model["rolling_thermal"]) = ("goksem_hargreaves".into(), thermal.into());
            let slot = Build::new(&registry, &files)
                .slot_at::<GearMesh>("model", &part, &model)
                .unwrap();
            let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
                (to.torque, to.speed) = (50.0, 2000.0 * std::f64::consts::PI / 30.0);
                (to.nu, to.eta, to.beta) = (nu * 1e-6, nu * 850e-6, 0.08);
            });
            slot.loss(&at).unwrap().total_watts(at.speed)
        };
        let [thin, thick] = [10.0, 1e4].map(|nu| (watts(true, nu), watts(false, nu)));
        // Hot oil is hardly heated at the inlet; isothermally, rolling grows with viscosity to the power 0.658.
        assert!((0.85..1.0).contains(&(thin.0 / thin.1)), "{thin:?}");
        assert!((thick.1 / thin.1 / 1000.0_f64.powf(0.658) - 1.0).abs() < 1e-9);
        assert!((0.05..0.5).contains(&(thick.0 / thick.1)), "{thick:?}");
    }

    #[test]
    fn places_without_load_do_not_roll() {
        let mut model = model(json!({ "type": "constant", "value": 0.05 }), "base_pitch");
        model["load_sharing"] = "symmetric_ramp".into();
        for law in ["crook", "goksem_hargreaves"] {
            model["rolling_friction"] = law.into();
            for kind in [Kind::Spur, Kind::Helical, Kind::Internal] {
                let registry = Registry::linked().unwrap();
                let files = Files::default();
                let part = Arc::new(pair_of(kind));
                let slot = Build::new(&registry, &files)
                    .slot_at::<GearMesh>("model", &part, &model)
                    .unwrap();
                assert!(
                    slot.loss(&GearMeshAt::usual(&part, Notes::MUTED)).is_ok(),
                    "{law} {kind:?}"
                );
            }
        }
    }

    #[test]
    fn a_mean_law_along_the_path_is_a_constant_and_a_local_law_in_a_mean_slot_keeps_its_loss() {
        let schlenk = json!({ "type": "schlenk", "x_l": 1.0, "clamp_line_load": true, "clamp_speed": "sum_speed" });
        let along = watts(&model(
            json!({ "type": "mean", "mean_friction": schlenk }),
            "base_pitch",
        ));
        let factor = watts(&json!({ "type": "ohlendorf", "mean_friction": schlenk }));
        assert!((along / factor - 1.0).abs() < 1e-6, "{along} {factor}");
        let xu = json!({ "type": "xu", "roughness": "composite_rms" });
        let integral = watts(&model(xu.clone(), "base_pitch"));
        let local = json!({ "type": "local", "at": "path", "load_sharing": "rigid", "tooth_friction": xu });
        let mean = watts(&json!({ "type": "wimmer", "load_sharing": "rigid", "mean_friction": local }));
        assert!((mean / integral - 1.0).abs() < 1e-6, "{mean} {integral}");
    }

    /// Sharings that depend on the load: several points together have the bits of each alone, and derivatives are those of differences.
    #[test]
    fn sharings_that_depend_on_the_load_serve_several_points_and_derivatives() {
        use gearloss_framework::contact::sharing::modification::{FlankModification, Relief, ReliefShape};
        use gearloss_framework::loss::{NoteBase, Notebook};
        use gearloss_framework::mechanism::{Inputs as _, Mechanism as _};
        use gearloss_framework::real::{Dual, LANES};
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let flank = FlankModification {
            tip_relief: Some(Relief {
                amount: 15e-6,
                length: None,
                from_diameter: None,
                shape: ReliefShape::Linear,
            }),
            crowning: 4e-6,
            ..FlankModification::default()
        };
        for kind in [Kind::Spur, Kind::Helical, Kind::Internal] {
            let part = Arc::new(pair_of(kind).with_flanks([flank; 2], 8e-6));
            let points: [GearMeshAt<'_>; LANES] = std::array::from_fn(|i| {
                GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
                    to.torque = 25.0 * i as f64;
                    to.speed *= 1.0 + 0.1 * i as f64;
                })
            });
            let all = GearMeshAt::together(&part, Notebook::CLOSED.notes(NoteBase::default()), |i| points[i]);
            let stiffness = if matches!(kind, Kind::Internal) {
                "iso6336"
            } else {
                "weber"
            };
            let sharing = json!({ "type": "slices", "stiffness": stiffness, "slices": 12, "phases": 60 });
            for friction in [json!({ "type": "constant", "value": 0.05 }), json!({ "type": "xu" })] {
                let model = json!({ "type": "path_integral", "load_sharing": sharing, "tooth_friction": friction,
                    "rolling_friction": "goksem_hargreaves", "average": "base_pitch", "rolling_thermal": true, "rolling_speed": "sum" });
                let slot = Build::new(&registry, &files)
                    .slot_at::<GearMesh>("model", &part, &model)
                    .unwrap();
                let together = GearMesh::answer_together(&*slot, &all).unwrap();
                for (i, at) in points.iter().enumerate() {
                    let alone = slot.loss(at).unwrap();
                    assert_eq!(together.at_point(i), alone, "{kind:?} {i}");
                    assert!(alone.sum().is_finite() && (alone.sum() == 0.0) == (i == 0));
                    if i == 0 {
                        continue;
                    }
                    let at_torque = |torque: f64| at.with(|to| to.torque = torque);
                    let (here, step) = (at.torque, 1e-4 * at.torque);
                    let notes = Notebook::CLOSED.notes(NoteBase::default());
                    let dual = GearMeshAt::gather(&part, notes, |quantity| Dual {
                        value: quantity(at),
                        slopes: std::array::from_fn(|_| quantity(&at_torque(here + 1.0)) - quantity(at)),
                    });
                    let exact = GearMesh::answer_with_derivatives(&*slot, &dual).unwrap().unwrap().sum();
                    let [less, more] =
                        [here - step, here + step].map(|torque| slot.loss(&at_torque(torque)).unwrap().sum());
                    let difference = (more - less) / (2.0 * step);
                    assert_eq!(exact.value, alone.sum());
                    assert!(
                        (exact.slopes[0] / difference - 1.0).abs() < 1e-4,
                        "{kind:?} {i}: {} {difference}",
                        exact.slopes[0]
                    );
                }
            }
        }
    }

    #[test]
    fn b14_rolling_force() {
        let first = goksem_hargreaves(3e5, 0.010, 20e-3, 5.0, 20e-9, 226.374e9) * 0.020;
        assert!((first / 1.50835 - 1.0).abs() < 1e-5, "{first}");
        // The check takes the thermal factor as given.
        let second = 0.9 * goksem_hargreaves(1.5e5, 0.006, 8e-3, 12.0, 15e-9, 226.374e9) * 0.030;
        assert!((second / 1.83244 - 1.0).abs() < 1e-5, "{second}");
    }
}
