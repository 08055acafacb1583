//! What the suite asks of a law beside single contacts: whole paths, in one go and side by side.

use std::cell::Cell;

use super::{Along, ContactAt, PathAt, PathExtent, PathNode, ToothFrictionModel, WeightedFriction};
use crate::lanes::{LANES, Lane, LaneNotes, Powers, REMEMBERED, each, same_notes};
use crate::loss::{MOST_KEPT, NoteBase, Notes, Undefined};
use crate::mechanism::gear_mesh::MeshPart;
use crate::mechanism::mean_friction::MeanFrictionAt;

/// Places on the path of the suite.
const PLACES: usize = 6;
/// Speed of its first gear. \[rad/s\]
const SPEED: f64 = 300.0;
/// How well the sum of [`ToothFrictionModel::weighted`] agrees with that over the places.
const SUM: f64 = 1e-9;

/// A path through the neighbourhood of a contact.
fn nodes(at: &ContactAt<'_>) -> [PathNode; PLACES] {
    std::array::from_fn(|k| {
        let k = k as f64;
        PathNode::new(
            at.sliding * (0.1 + 0.3 * k) / SPEED,
            at.sum_speed * (1.0 + 0.05 * k) / SPEED,
            at.radius * (0.8 + 0.1 * k),
            (0.4 + 0.2 * k).min(1.0),
        )
    })
}

/// What is wrong with the answers of a law for a whole path, beside those for one line load at a time.
pub(super) fn fault(model: &dyn ToothFrictionModel, contact: &ContactAt<'_>, notes: NoteBase) -> Option<&'static str> {
    // A mesh has no path without load, speed and curvature.
    if contact.line_load <= 0.0 || contact.sum_speed <= 0.0 || contact.radius <= 0.0 {
        return None;
    }
    let Ok(part) = MeshPart::fzg_c() else {
        return Some("cannot be asked: the pair of the suite is impossible");
    };
    let mean = MeanFrictionAt::usual(&part, Notes::MUTED);
    let nodes = nodes(contact);
    let extent = PathExtent::of(&nodes);
    let path = PathAt::of(&nodes, &extent, contact.length, &mean, Notes::muted(notes)).with(|to| {
        to.speed = SPEED;
        to.line_load = contact.line_load;
        to.modulus = contact.modulus;
        (to.ra, to.rq) = (contact.ra, contact.rq);
        (to.temperature, to.nu, to.eta) = (contact.temperature, contact.nu, contact.eta);
        (to.alpha, to.beta, to.conductivity) = (contact.alpha, contact.beta, contact.conductivity);
        to.x_l = contact.x_l;
    });
    let weights = nodes.map(|node| 0.3 * node.share);
    let weighted = model.weighted(&nodes, &weights);
    let law = Law {
        model,
        weighted: weighted.as_deref(),
        weights,
        notes,
    };
    law.keeping(&path).or_else(|| law.side_by_side(&path))
}

/// A law with its sum over the path of the suite.
struct Law<'a> {
    model: &'a dyn ToothFrictionModel,
    weighted: Option<&'a dyn WeightedFriction>,
    weights: [f64; PLACES],
    notes: NoteBase,
}

/// Coefficients at the places of a path, with what else is known of it.
type Answer = Result<(Along, [f64; PLACES]), Undefined>;

impl Law<'_> {
    fn along(&self, path: &PathAt<'_>) -> Answer {
        let mut mu = [f64::NAN; PLACES];
        let along = self.model.along(path, &mut mu)?;
        Ok((along, mu))
    }

    /// What is kept over the passes of a point must not hang on the load.
    fn keeping(&self, path: &PathAt<'_>) -> Option<&'static str> {
        let kept = vec![Cell::new([f64::NAN; MOST_KEPT]); self.notes.instance + 1];
        let keeping = path.with(|to| to.notes = to.notes.keeping(&kept));
        let ask = |path: &PathAt<'_>| {
            let answer = self.along(path).map_err(|undefined| undefined.what);
            (answer, self.weighted.map_or(0.0, |sum| sum.sum(path)).to_bits())
        };
        let _ = ask(&keeping.with(|to| to.line_load *= 2.0));
        (ask(&keeping) != ask(path)).then_some("keeps what hangs on the line load over the passes of a point")
    }

    fn side_by_side(&self, path: &PathAt<'_>) -> Option<&'static str> {
        let line_loads = each(|i| path.line_load * (0.3 + 1.5 * i as f64 / LANES as f64));
        let mut mu = [Lane::ZERO; PLACES];
        let wide = self.model.along_lanes(path, &line_loads, &mut mu);
        if !wide && self.weighted.is_none() {
            return None;
        }
        let under = |lane: usize| path.with(|to| to.line_load = line_loads[lane]);
        let answers: [Answer; LANES] = std::array::from_fn(|lane| self.along(&under(lane)));
        let same = |lane: usize| match &answers[lane] {
            Ok((_, along)) => (0..PLACES).all(|k| mu[k][lane].to_bits() == along[k].to_bits()),
            Err(_) => (0..PLACES).any(|k| !mu[k][lane].is_finite()),
        };
        if wide && !(0..LANES).all(same) {
            return Some("`along_lanes` answers otherwise than `along`");
        }
        if answers.iter().flatten().any(|(along, _)| *along != Along::default()) {
            return Some("has a sum or lanes, but its heat does not go into both bodies alike");
        }
        let weighted = self.weighted?;
        let sums = each(|lane| weighted.sum(&under(lane)));
        // A sum that is no number leaves the path to its places.
        let agrees = |lane: usize| match &answers[lane] {
            Ok((_, along)) => {
                let sum: f64 = self.weights.iter().zip(along).map(|(weight, mu)| weight * mu).sum();
                sums[lane].is_nan() || (sums[lane] - sum).abs() <= SUM * sum.abs()
            }
            Err(_) => !sums[lane].is_finite(),
        };
        if !(0..LANES).all(agrees) {
            return Some("`weighted` sums to something else than the places of `along`");
        }
        let abreast = weighted.sums(path, &line_loads, &mut Powers::EXACT.clone());
        if !(0..LANES).all(|lane| abreast[lane].to_bits() == sums[lane].to_bits()) {
            return Some("`sums` answers otherwise than `sum`");
        }
        // What is remembered comes from another speed and loads close by.
        let mut powers = Powers::remembering();
        let before = path.with(|to| to.speed *= 1.3);
        weighted.sums(&before, &each(|i| line_loads[i] * 1.001), &mut powers);
        let remembered = weighted.sums(path, &line_loads, &mut powers);
        if (0..LANES).any(|lane| (remembered[lane] - sums[lane]).abs() > REMEMBERED * sums[lane].abs()) {
            return Some("`sums` remembers what is no power of the line loads times a constant");
        }
        // What is undefined at a load is noted by its point alone.
        if answers.iter().any(Result::is_err) {
            return None;
        }
        let single = |lane: usize, notes: Notes<'_>| {
            let _ = self.along(&under(lane).with(|to| to.notes = notes));
        };
        let together = |notes: LaneNotes<'_>| {
            let path = path.with(|to| to.notes = notes.all());
            if weighted.note(&path, &line_loads, notes) {
                return;
            }
            if wide {
                self.model.note_lanes(&path, &line_loads, &mu, notes);
            } else {
                (0..LANES).for_each(|lane| single(lane, notes.lane(lane)));
            }
        };
        (!same_notes(self.notes, single, together)).then_some("`note` or `note_lanes` notes otherwise than `along`")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::lanes::over;
    use crate::loss::Observed;
    use crate::mechanism::NoPart;

    const MU: Observed = Observed::new(0, "mu", "-", "Coefficients of friction.");

    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Slip {
        None,
        Keeps,
        Lanes,
        Heat,
        Sum,
        Sums,
        Remembers,
        Notes,
    }

    /// A law that rises with the root of the load, with every way to a path, and one slip.
    struct RootLaw(Slip);

    impl RootLaw {
        fn factor(&self, path: &PathAt<'_>) -> f64 {
            let load = if self.0 == Slip::Keeps { path.line_load } else { 1.0 };
            let [factor] = path.notes.once(|| [1e-5 * path.speed.sqrt() * load]);
            factor
        }
    }

    impl ToothFrictionModel for RootLaw {
        fn mu(&self, at: &ContactAt<'_>) -> Result<f64, Undefined> {
            Ok(1e-5 * at.line_load.sqrt())
        }

        fn along(&self, path: &PathAt<'_>, mu: &mut [f64]) -> Result<Along, Undefined> {
            let factor = self.factor(path);
            for (node, mu) in path.nodes.iter().zip(mu) {
                *mu = factor * path.line_load.sqrt() * node.share.sqrt();
                path.notes.observe(&MU, *mu);
            }
            Ok(Along {
                first_heat: if self.0 == Slip::Heat { 0.4 } else { 0.5 },
            })
        }

        fn along_lanes(&self, path: &PathAt<'_>, line_loads: &Lane, mu: &mut [Lane]) -> bool {
            let slip = if self.0 == Slip::Lanes { 1.0 + 1e-15 } else { 1.0 };
            let factor = slip * self.factor(path);
            for (node, mu) in path.nodes.iter().zip(mu) {
                *mu = over(line_loads, |load| factor * load.sqrt() * node.share.sqrt());
            }
            true
        }

        fn weighted(&self, nodes: &[PathNode], weights: &[f64]) -> Option<Box<dyn WeightedFriction>> {
            let roots = nodes.iter().map(|node| node.share.sqrt());
            let slip = if self.0 == Slip::Sum { 1.0 + 1e-8 } else { 1.0 };
            Some(Box::new(RootSum {
                law: Self(self.0),
                sum: slip * roots.zip(weights).map(|(root, weight)| root * weight).sum::<f64>(),
            }))
        }

        fn note_lanes(&self, _path: &PathAt<'_>, _line_loads: &Lane, mu: &[Lane], notes: LaneNotes<'_>) {
            let (mut least, mut greatest) = (mu[PLACES - 1], mu[PLACES - 1]);
            for mu in mu.iter().skip(usize::from(self.0 == Slip::Notes)) {
                least = each(|i| least[i].min(mu[i]));
                greatest = each(|i| greatest[i].max(mu[i]));
            }
            notes.observe(&MU, &least, &greatest);
        }
    }

    struct RootSum {
        law: RootLaw,
        sum: f64,
    }

    impl WeightedFriction for RootSum {
        fn sum(&self, path: &PathAt<'_>) -> f64 {
            path.line_load.sqrt() * self.law.factor(path) * self.sum
        }

        fn sums(&self, path: &PathAt<'_>, line_loads: &Lane, powers: &mut Powers) -> Lane {
            let (within, outside) = match self.law.0 {
                Slip::Remembers => (self.law.factor(path), 1.0),
                Slip::Sums => (1.0, (1.0 + 1e-15) * self.law.factor(path)),
                _ => (1.0, self.law.factor(path)),
            };
            let raised = powers.of(0, |i| line_loads[i], 0.5, |load| load.sqrt() * within);
            over(&raised, |raised| raised * outside * self.sum)
        }
    }

    #[test]
    fn every_slip_of_a_law_for_paths_is_found() {
        let base = NoteBase {
            end: 1,
            ..NoteBase::default()
        };
        let found = |slip| fault(&RootLaw(slip), &ContactAt::usual(&NoPart {}, Notes::MUTED), base);
        assert_eq!(found(Slip::None), None);
        for (slip, words) in [
            (Slip::Keeps, "keeps what hangs on the line load"),
            (Slip::Lanes, "`along_lanes` answers otherwise"),
            (Slip::Heat, "heat does not go into both bodies alike"),
            (Slip::Sum, "`weighted` sums to something else"),
            (Slip::Sums, "`sums` answers otherwise"),
            (Slip::Remembers, "`sums` remembers"),
            (Slip::Notes, "notes otherwise than `along`"),
        ] {
            let fault = found(slip).unwrap();
            assert!(fault.contains(words), "{slip:?}: {fault}");
        }
    }
}
