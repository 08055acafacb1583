//! Power times mean friction times a tooth loss factor, shared by several models.

use gearloss_framework::contact::sharing::{Knots, Sharing};
use gearloss_framework::geometry::Pair;
use gearloss_framework::loss::{Loss, Undefined};
use gearloss_framework::mechanism::Answers;
use gearloss_framework::mechanism::gear_mesh::GearMeshAt;
use gearloss_framework::mechanism::mean_friction::{MeanFriction, MeanFrictionAt};
use gearloss_framework::real::Mask as _;
use gearloss_framework::registry::Slot;
use gearloss_framework::{observed, terms};

terms! { pub SLIDING = load("sliding"); }
observed! {
    pub MU = ("mu_m", "-", "mean coefficient of friction");
    pub LOSS_FACTOR = ("H_v", "-", "tooth loss factor");
}

/// A loss factor with its mean friction law.
pub struct Factor {
    knots: Knots,
    /// The loss factor at each knot of the load sharing.
    values: Vec<f64>,
    friction: Slot<MeanFriction>,
}

impl Factor {
    /// A factor that does not depend on the load.
    pub fn new(value: f64, friction: Slot<MeanFriction>) -> Self {
        Self {
            knots: Knots::ONE,
            values: vec![value],
            friction,
        }
    }

    /// The local factor of a load sharing.
    pub fn of_sharing(pair: &Pair, sharing: &Sharing, friction: Slot<MeanFriction>) -> Self {
        Self {
            knots: sharing.knots(),
            values: sharing.loss_factors(pair),
            friction,
        }
    }

    #[inline(always)]
    pub fn loss<R: Answers>(&self, at: &GearMeshAt<'_, R>) -> Result<Loss<R>, Undefined> {
        let idle = at.speed.is_zero() | at.torque.is_zero();
        if idle.all() {
            at.branch("no speed or no torque: no loss");
            return Ok(Loss::POWERS);
        }
        let at = &at.with(|to| to.notes = to.notes.among(!idle));
        let mean = MeanFrictionAt::at_pitch_point(at, at.notes.nested(self.friction.notes));
        let mu = at.observe(&MU, R::answer::<MeanFriction>(&*self.friction, &mean)?);
        let line_load = at.part.pair.line_load(mean.normal_force);
        let factor = at.observe(&LOSS_FACTOR, self.knots.between(line_load, &self.values));
        let input = at.show("P_in", "W", at.torque * at.speed.abs());
        let watts = at.show("P", "W", input * mu * factor);
        Ok(Loss::POWERS.with(&SLIDING, R::select(idle, R::ZERO, watts)))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::path_integral::tests::{Kind, pair_of};
    use super::*;
    use gearloss_framework::loss::{NoteBase, Notebook, Notes};
    use gearloss_framework::mechanism::gear_mesh::GearMesh;
    use gearloss_framework::mechanism::{Inputs as _, Mechanism as _};
    use gearloss_framework::real::LANES;
    use gearloss_framework::registry::{Build, Files, Registry};
    use serde_json::{Value, json};
    use std::sync::Arc;

    /// None of them falls back to one point at a time, whatever the mean friction; one of the points has no torque.
    #[test]
    fn closed_models_of_the_mesh_serve_several_points_together() {
        let registry = Registry::linked().unwrap();
        let files = Files::default();
        let part = Arc::new(pair_of(Kind::Spur));
        let points: [GearMeshAt<'_>; LANES] = std::array::from_fn(|i| {
            GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
                to.torque = 20.0 * i as f64;
                to.speed *= 1.0 + 0.1 * i as f64;
            })
        });
        let all = GearMeshAt::together(&part, Notebook::CLOSED.notes(NoteBase::default()), |i| points[i]);
        let means = [
            json!({ "type": "schlenk", "oil": "polyglycol" }),
            json!({ "type": "michaelis" }),
            json!({ "type": "iso_13989" }),
            json!({ "type": "fernandes" }),
        ];
        for mean in &means {
            let slot = Build::new(&registry, &files)
                .slot_at::<MeanFriction>("model", &part, mean)
                .unwrap();
            let at = MeanFrictionAt::at_pitch_point(&all, all.notes);
            assert!(MeanFriction::answer_together(&*slot, &at).is_ok(), "one by one: {mean}");
        }
        let with_mean = |name: &'static str| {
            means
                .iter()
                .map(move |mean| json!({ "type": name, "mean_friction": mean }))
        };
        let formulas = ["iso14179_1", "iso14179_2", "anderson_loewenthal"].map(|name| json!({ "type": name }));
        let models: Vec<Value> = ["ohlendorf", "wimmer", "even_share"]
            .into_iter()
            .flat_map(with_mean)
            .chain(formulas)
            .collect();
        for model in models {
            let slot = Build::new(&registry, &files)
                .slot_at::<GearMesh>("model", &part, &model)
                .unwrap();
            let together = GearMesh::answer_together(&*slot, &all).unwrap_or_else(|_| panic!("one by one: {model}"));
            for (i, at) in points.iter().enumerate() {
                let alone = slot.loss(at).unwrap();
                assert_eq!(together.at_point(i), alone, "{model}");
                assert_eq!(alone.sum() == 0.0, i == 0, "{model}");
            }
        }
        // The mean of a local law is undefined without torque, so that the nested law alone falls back.
        let local =
            json!({ "type": "wimmer", "mean_friction": { "type": "local", "tooth_friction": { "type": "xu" } } });
        let slot = Build::new(&registry, &files)
            .slot_at::<GearMesh>("model", &part, &local)
            .unwrap();
        let together = GearMesh::answer_together(&*slot, &all).unwrap();
        assert!((0..LANES).all(|i| together.at_point(i) == slot.loss(&points[i]).unwrap()));
    }
}
