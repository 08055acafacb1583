//! Mesh loss by integrating local friction along the path of contact.
//!
//! Source: sliding power mu K F_bn v_g at each place, averaged over one base pitch of the mesh cycle (Niemann/Winter,
//! Maschinenelemente 2; Wimmer 2006). With constant friction it equals mean friction times the local loss factor.
//! An option averages over the travel of one tooth with double contact counted twice, as equation 3 of Shen and Rinderknecht
//! (Modelling of transmission losses with parameter identification) prints it: for constant friction that is 20 % above the
//! cycle average of an FZG C gear, because double contact counts twice.
//! Assumes rigid teeth with a stated sharing of the load; the line load is that of the pair over the face width.
//! Rolling friction is optional: Goksem and Hargreaves, J. Lubr. Tech. 100 (1978) 346-352, isothermal.

use gearloss_framework::document::Diagnostic;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::loss::{Loss, Observed, Term, Undefined};
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, GearMeshModel};
use gearloss_framework::mechanism::tooth_friction::{PathAt, PathExtent, PathNode, ToothFriction};
use gearloss_framework::register;
use gearloss_framework::registry::{Build, Evidence, ModelRef, Slot, default_of, formula};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const SLIDING: Term = Term::load(0, "sliding");
const ROLLING: Term = Term::load(1, "rolling");
const MU_MEAN: Observed = Observed::new(
    0,
    "mu_mean",
    "-",
    "Coefficient of friction, weighted by load and sliding speed.",
);
const LOSS_FACTOR: Observed = Observed::new(1, "H_vL", "-", "Local tooth loss factor of the load sharing.");

/// Quadrature points on each smooth piece of the path: the loss is then within 1e-4 of its limit (5e-5 in the two-speed example).
const ORDER: usize = 3;
/// The most points on a path.
const MOST_NODES: usize = 64;

/// Over what the loss is averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Average {
    /// Over one base pitch: the mean over time.
    #[default]
    BasePitch,
    /// Over the travel of one tooth with double contact counted twice, for comparison with publications.
    ToothTravel,
}

/// Whether rolling friction counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rolling {
    /// It does not count.
    #[default]
    None,
    /// Goksem and Hargreaves, isothermal.
    GoksemHargreaves,
}

/// Mesh loss by integrating local friction along the path of contact.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct PathIntegral {
    /// How pairs in contact at once share the load.
    #[serde(default)]
    pub load_sharing: LoadSharing,
    /// Over what the loss is averaged.
    #[serde(default)]
    pub average: Average,
    /// Law of friction between the flanks.
    pub tooth_friction: ModelRef<ToothFriction>,
    /// Whether rolling friction counts.
    #[serde(default)]
    pub rolling_friction: Rolling,
}

/// The path of one mesh, prepared.
struct Path {
    nodes: Vec<PathNode>,
    extent: PathExtent,
    /// Sliding power per friction, normal force and speed of the first gear, by node. \[m\]
    weights: Vec<f64>,
    /// Weight of the rolling power at each node.
    rolling_weights: Vec<f64>,
    loss_factor: f64,
    friction: Slot<ToothFriction>,
    rolling: Rolling,
}

fn prepare(params: PathIntegral, cx: &mut Build<'_>) -> Result<Path, Diagnostic> {
    let friction = cx.slot("tooth_friction", &params.tooth_friction)?;
    let part = cx.part::<GearMesh>().ok_or_else(|| cx.error("bug: no pair"))?;
    let pair = &part.pair;
    let points = pair.path(params.load_sharing, ORDER);
    if points.len() > MOST_NODES {
        return Err(cx.error(format!(
            "the contact ratio {:.2} is too high for a path integral",
            pair.contact_ratio
        )));
    }
    let [start, .., end] = pair.points;
    let nodes: Vec<PathNode> = points
        .iter()
        .map(|p| {
            PathNode::new(
                pair.sliding(p.x),
                pair.sum_speed(p.x),
                pair.relative_radius(p.x),
                p.share,
            )
        })
        .collect();
    let per_length: Vec<f64> = points
        .iter()
        .map(|p| match params.average {
            Average::BasePitch => p.weight / pair.base_pitch,
            Average::ToothTravel => p.weight * p.pairs as f64 / (end - start),
        })
        .collect();
    let weights = per_length
        .iter()
        .zip(&nodes)
        .zip(&points)
        .map(|((w, n), p)| w * p.share * n.sliding)
        .collect();
    Ok(Path {
        rolling_weights: per_length,
        weights,
        loss_factor: pair.loss_factor_local(params.load_sharing),
        extent: PathExtent::of(&nodes),
        nodes,
        friction,
        rolling: params.rolling_friction,
    })
}

/// Rolling force per face width. \[N/m\] Line load in N/m, radius in m, viscosity in Pa s, mean rolling speed in m/s,
/// pressure-viscosity coefficient in 1/Pa, reduced modulus in Pa.
fn goksem_hargreaves(line_load: f64, radius: f64, eta: f64, rolling: f64, alpha: f64, modulus: f64) -> f64 {
    let (g, u, w) = (
        alpha * modulus,
        eta * rolling / (modulus * radius),
        line_load / (modulus * radius),
    );
    4.318 * (g * u).powf(0.658) * w.powf(0.0126) * radius / alpha
}

impl GearMeshModel for Path {
    fn loss(&self, at: &GearMeshAt<'_>) -> Result<Loss, Undefined> {
        if at.speed == 0.0 || at.torque == 0.0 {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let pair = &at.part.pair;
        let speed = at.speed.abs();
        let normal = at.show("F_bn", "N", at.torque / (pair.base_radius[0] * pair.base_helix.cos()));
        let line_load = at.show("F_bn/b", "N/m", normal / pair.facewidth);
        let path = PathAt {
            nodes: &self.nodes,
            extent: &self.extent,
            speed,
            line_load,
            modulus: at.part.modulus,
            ra: at.part.ra,
            rq: at.part.rq,
            temperature: at.temperature,
            nu: at.nu,
            eta: at.eta,
            alpha: at.alpha,
            x_l: at.x_l,
            notes: at.notes.of(self.friction.notes),
        };
        let mut mu = [0.0; MOST_NODES];
        let mu = &mut mu[..self.nodes.len()];
        self.friction.along(&path, mu)?;
        let (mut sum, mut whole) = (0.0, 0.0);
        for (weight, mu) in self.weights.iter().zip(mu.iter()) {
            sum += weight * mu;
            whole += weight;
        }
        at.observe(&MU_MEAN, sum / whole);
        at.observe(&LOSS_FACTOR, self.loss_factor);
        let loss = Loss::POWERS.with(&SLIDING, at.show("P_s", "W", sum * normal * speed));
        if self.rolling == Rolling::None {
            return Ok(loss);
        }
        let rolling: f64 = self
            .nodes
            .iter()
            .zip(&self.rolling_weights)
            .map(|(node, weight)| {
                let sum_speed = node.sum_speed * speed;
                let w = node.share * line_load;
                let force = goksem_hargreaves(w, node.radius, at.eta, 0.5 * sum_speed, at.alpha, at.part.modulus);
                weight * force * pair.facewidth * sum_speed
            })
            .sum();
        Ok(loss.with(&ROLLING, at.show("P_r", "W", rolling)))
    }
}

register!(GearMesh, "path_integral", PathIntegral,
    meaning: "Local friction integrated along the path of contact.",
    source: "Niemann/Winter, Maschinenelemente 2; Wimmer 2006; Goksem and Hargreaves 1978",
    example: "{ type: path_integral, tooth_friction: { type: constant, value: 0.05 }, rolling_friction: goksem_hargreaves }",
    evidence: [
        formula(Evidence::Derived, "equals friction times loss factor for constant friction"),
        default_of("load_sharing", Evidence::Assumed, "rigid teeth"),
        default_of("rolling_friction", Evidence::OneSource, "usually neglected beside sliding"),
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

    fn watts(model: &Value) -> f64 {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let part = Arc::new(fzg_c14(0.4e-6, 0.5e-6));
        let mut build = Build::new(&registry, &files);
        let slot = build.slot_at::<GearMesh>("model", &part, model).unwrap();
        let speed = 1500.0 * std::f64::consts::PI / 30.0;
        let at = GearMeshAt {
            torque: 200.0,
            speed,
            eta: 13.28e-3,
            ..GearMeshAt::usual(&part, Notes::MUTED)
        };
        slot.loss(&at).unwrap().total_watts(speed)
    }

    fn model(friction: Value, average: &str) -> Value {
        json!({ "type": "path_integral", "load_sharing": "rigid", "average": average, "tooth_friction": friction, "rolling_friction": "none" })
    }

    #[test]
    fn b5_constant_friction_on_fzg_c14() {
        let friction = json!({ "type": "constant", "value": 0.05 });
        let cycle = watts(&model(friction.clone(), "base_pitch"));
        let travel = watts(&model(friction, "tooth_travel"));
        assert!((cycle / 312.015 - 1.0).abs() < 1e-5, "{cycle}");
        assert!((travel / 375.906 - 1.0).abs() < 1e-5, "{travel}");
        assert!((travel / cycle / 1.20477 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn b5_local_friction_on_fzg_c14() {
        let friction = json!({ "type": "xu", "roughness": "composite_rms" });
        // The check was integrated to its limit; three points on each piece leave 1e-4.
        let cycle = watts(&model(friction.clone(), "base_pitch"));
        assert!((cycle / 183.716 - 1.0).abs() < 2e-4, "{cycle}");
        let travel = watts(&model(friction, "tooth_travel"));
        assert!((travel / 221.384 - 1.0).abs() < 2e-4, "{travel}");
    }

    #[test]
    fn b14_rolling_force() {
        let first = goksem_hargreaves(3e5, 0.010, 20e-3, 5.0, 20e-9, 226.374e9) * 0.020;
        assert!((first / 1.50835 - 1.0).abs() < 1e-5, "{first}");
        let second = 0.9 * goksem_hargreaves(1.5e5, 0.006, 8e-3, 12.0, 15e-9, 226.374e9) * 0.030;
        assert!((second / 1.83244 - 1.0).abs() < 1e-5, "{second}");
    }
}
