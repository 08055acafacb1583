//! Conformance checks of a friction law beyond single contacts: whole paths, single and batched.

use std::cell::Cell;

use super::{Along, ContactAt, PathAt, PathExtent, PathNode, ToothFrictionModel, WeightedFriction};
use crate::lanes::{LANES, Lane, LaneNotes, Powers, REMEMBERED, each, over, same_notes};
use crate::loss::{MOST_KEPT, NoteBase, Notes, Undefined};
use crate::mechanism::gear_mesh::MeshPart;
use crate::mechanism::mean_friction::MeanFrictionAt;

/// Points on the path of the suite, one of which is the pitch point.
const PLACES: usize = 6;
const PITCH: f64 = 2.0;
/// Speed of its first gear. \[rad/s\]
const SPEED: f64 = 300.0;
/// Tolerance of the sum of [`ToothFrictionModel::weighted`] to that over the points.
const SUM: f64 = 1e-9;
/// Maximum number of models within a law that may keep values.
const NESTED: usize = 16;

/// A path near a contact.
fn nodes(at: &ContactAt<'_>) -> [PathNode; PLACES] {
    std::array::from_fn(|k| {
        let k = k as f64;
        let node = PathNode::new(
            at.sliding * 0.4 * (k - PITCH).abs() / SPEED,
            at.sum_speed * (1.0 + 0.05 * k) / SPEED,
            at.radius * (0.8 + 0.1 * k),
            (0.4 + 0.2 * k).min(1.0),
        );
        PathNode {
            first_faster: k > PITCH,
            ..node
        }
    })
}

/// The faults of the results of a law for a whole path, compared with those for one line load at a time.
pub(super) fn fault(model: &dyn ToothFrictionModel, contact: &ContactAt<'_>, notes: NoteBase) -> Option<&'static str> {
    // A mesh has no path without load, speed and curvature.
    if contact.line_load <= 0.0 || contact.sum_speed <= 0.0 || contact.radius <= 0.0 {
        return None;
    }
    let Ok(part) = MeshPart::fzg_c() else {
        return Some("cannot be evaluated: the pair of the suite is impossible");
    };
    let nodes = nodes(contact);
    let weights = nodes.map(|node| 0.3 * node.share);
    let weighted = model.weighted(&nodes, &weights);
    Law {
        model,
        weighted: weighted.as_deref(),
        weights,
        nodes: &nodes,
        extent: PathExtent::from_nodes(&nodes),
        part: &part,
        contact,
        notes,
        line_loads: each(|i| contact.line_load * (0.3 + 1.5 * i as f64 / LANES as f64)),
    }
    .fault()
}

/// A law with the path of the suite.
struct Law<'a> {
    model: &'a dyn ToothFrictionModel,
    weighted: Option<&'a dyn WeightedFriction>,
    weights: [f64; PLACES],
    nodes: &'a [PathNode; PLACES],
    extent: PathExtent,
    part: &'a MeshPart,
    contact: &'a ContactAt<'a>,
    notes: NoteBase,
    /// The batched line loads. \[N/m\]
    line_loads: Lane,
}

/// Coefficients at the points of a path, with the other results.
type Answer = Result<(Along, [f64; PLACES]), Undefined>;
type Kept = [Cell<[f64; MOST_KEPT]>];

/// Results for all line loads.
struct Wide {
    /// True if the law has a batched evaluation of the coefficients.
    answers: bool,
    mu: [Lane; PLACES],
    sums: Lane,
}

/// True if both have the same bits, or are both NaN.
fn same_bits(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn all_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| same_bits(*a, *b))
}

impl Law<'_> {
    fn fault(&self) -> Option<&'static str> {
        let answers: [Answer; LANES] = std::array::from_fn(|lane| self.along(lane, Notes::muted(self.notes)));
        let sound = |mu: &f64| *mu >= 0.0 && mu.is_finite();
        if !answers.iter().flatten().all(|(_, mu)| mu.iter().all(sound)) {
            return Some("`along` returns a coefficient that is negative or NaN");
        }
        let wide = self.wide(&[], 1.0, &mut Powers::EXACT.clone());
        self.keeping(&answers, &wide)
            .or_else(|| self.lanes(&answers, &wide))
            .or_else(|| self.sums(&answers, &wide))
            .or_else(|| self.noting(&answers, &wide))
    }

    /// Evaluates the path at a line load, with the speed times a factor.
    fn with_path<R>(&self, line_load: f64, faster: f64, notes: Notes<'_>, then: impl FnOnce(&PathAt<'_>) -> R) -> R {
        let (contact, load) = (self.contact, line_load / self.contact.line_load);
        let mean = MeanFrictionAt::usual(self.part, Notes::MUTED).with(|to| {
            to.line_load *= load;
            to.normal_force *= load;
            to.pressure *= load.sqrt();
        });
        then(
            &PathAt::new(self.nodes, &self.extent, contact.length, &mean, notes).with(|to| {
                to.speed = SPEED * faster;
                to.line_load = line_load;
                to.modulus = contact.modulus;
                (to.ra, to.rq) = (contact.ra, contact.rq);
                (to.temperature, to.nu, to.eta) = (contact.temperature, contact.nu, contact.eta);
                (to.alpha, to.beta, to.conductivity) = (contact.alpha, contact.beta, contact.conductivity);
                to.x_l = contact.x_l;
            }),
        )
    }

    fn along(&self, lane: usize, notes: Notes<'_>) -> Answer {
        self.with_path(self.line_loads[lane], 1.0, notes, |path| {
            let mut mu = [f64::NAN; PLACES];
            let along = self.model.along(path, &mut mu)?;
            Ok((along, mu))
        })
    }

    fn sum(&self, lane: usize, notes: Notes<'_>) -> f64 {
        let sum = |path: &PathAt<'_>| self.weighted.map_or(0.0, |weighted| weighted.sum(path));
        self.with_path(self.line_loads[lane], 1.0, notes, sum)
    }

    /// The results for all line loads, times a factor, on a path without a load of its own.
    fn wide(&self, kept: &Kept, factor: f64, powers: &mut Powers) -> Wide {
        let line_loads = over(&self.line_loads, |load| load * factor);
        let mut mu = [Lane::ZERO; PLACES];
        // The evaluation at other loads uses another speed, too, unless kept values are checked.
        let faster = if factor == 1.0 || !kept.is_empty() { 1.0 } else { 1.3 };
        self.with_path(0.0, faster, Notes::muted(self.notes).keeping(kept), |path| Wide {
            answers: self.model.along_lanes(path, &line_loads, &mut mu),
            mu,
            sums: self
                .weighted
                .map_or(Lane::ZERO, |weighted| weighted.sums(path, &line_loads, powers)),
        })
    }

    /// Checks that values kept over the iterations of a point are independent of the load.
    fn keeping(&self, answers: &[Answer; LANES], wide: &Wide) -> Option<&'static str> {
        let fault = Some("keeps a value that depends on the line load over the iterations of a point");
        let kept = || vec![Cell::new([f64::NAN; MOST_KEPT]); self.notes.instance() + NESTED];
        let (single, own) = (kept(), Notes::muted(self.notes));
        let keeping = own.keeping(&single);
        let _ = (self.along(LANES - 1, keeping), self.sum(LANES - 1, keeping));
        let alike = match (&answers[0], self.along(0, keeping)) {
            (Ok(answer), Ok(kept)) => answer.0 == kept.0 && all_same(&answer.1, &kept.1),
            (Err(answer), Err(kept)) => answer.what == kept.what,
            _ => false,
        };
        if !alike || !same_bits(self.sum(0, own), self.sum(0, keeping)) {
            return fault;
        }
        let together = kept();
        let _ = self.wide(&together, 2.0, &mut Powers::EXACT.clone());
        let again = self.wide(&together, 1.0, &mut Powers::EXACT.clone());
        let mu = (0..PLACES).all(|k| all_same(&wide.mu[k][..], &again.mu[k][..]));
        if mu && all_same(&wide.sums[..], &again.sums[..]) {
            None
        } else {
            fault
        }
    }

    fn lanes(&self, answers: &[Answer; LANES], wide: &Wide) -> Option<&'static str> {
        let agrees = |lane: usize| match &answers[lane] {
            Ok((_, mu)) => (0..PLACES).all(|k| same_bits(wide.mu[k][lane], mu[k])),
            Err(_) => (0..PLACES).any(|k| !wide.mu[k][lane].is_finite()),
        };
        if wide.answers && !(0..LANES).all(agrees) {
            return Some("`along_lanes` differs from `along`");
        }
        let alike = |answer: &Answer| answer.as_ref().map_or(true, |(along, _)| *along == Along::default());
        let ways = wide.answers || self.weighted.is_some();
        (ways && !answers.iter().all(alike))
            .then_some("has lanes or a sum, but does not split its heat equally between both bodies")
    }

    fn sums(&self, answers: &[Answer; LANES], wide: &Wide) -> Option<&'static str> {
        self.weighted?;
        let sums = each(|lane| self.sum(lane, Notes::muted(self.notes)));
        // NaN as a sum means that the points must be evaluated.
        let agrees = |lane: usize| match &answers[lane] {
            Ok((_, mu)) => {
                let sum: f64 = self.weights.iter().zip(mu).map(|(weight, mu)| weight * mu).sum();
                sums[lane].is_nan() || (sums[lane] - sum).abs() <= SUM * sum.abs()
            }
            Err(_) => !sums[lane].is_finite(),
        };
        if !(0..LANES).all(agrees) {
            return Some("the sum of `weighted` differs from that over the points of `along`");
        }
        if !all_same(&wide.sums[..], &sums[..]) {
            return Some("`sums` differs from `sum`");
        }
        // Remembered values come from another speed and similar loads.
        let mut powers = Powers::remembering();
        let _ = self.wide(&[], 1.001, &mut powers);
        let remembered = self.wide(&[], 1.0, &mut powers).sums;
        let agrees = |lane: usize| {
            let (own, sum) = (remembered[lane], sums[lane]);
            own.is_nan() && sum.is_nan() || (own - sum).abs() <= REMEMBERED * sum.abs()
        };
        (!(0..LANES).all(agrees))
            .then_some("`sums` remembers a value that is not a power of the line loads times a constant")
    }

    fn noting(&self, answers: &[Answer; LANES], wide: &Wide) -> Option<&'static str> {
        let weighted = self.weighted?;
        // The single point notes values that are undefined at a load.
        if answers.iter().any(Result::is_err) {
            return None;
        }
        let single = |lane: usize, notes: Notes<'_>| {
            let _ = self.along(lane, notes);
        };
        let together = |notes: LaneNotes<'_>| {
            let noted = self.with_path(0.0, 1.0, notes.all(), |path| {
                let noted = weighted.note(path, &self.line_loads, notes);
                if !noted && wide.answers {
                    self.model.note_lanes(path, &self.line_loads, &wide.mu, notes);
                }
                noted || wide.answers
            });
            if !noted {
                (0..LANES).for_each(|lane| single(lane, notes.lane(lane)));
            }
        };
        (!same_notes(self.notes, single, together)).then_some("`note` or `note_lanes` writes other notes than `along`")
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::mechanism::NoPart;
    use crate::observed;

    observed! { MU = ("mu", "-", "Coefficients of friction."); }

    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Slip {
        None,
        Keeps,
        LanesKeep,
        Negative,
        Lanes,
        Mean,
        Heat,
        Sum,
        Sums,
        Remembers,
        Forgets,
        Notes,
    }

    /// A law that increases with the root of the load, with every kind of path evaluation, and one deliberate fault.
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
            let factor = self.factor(path) * if self.0 == Slip::Negative { -1.0 } else { 1.0 };
            for (node, mu) in path.nodes.iter().zip(mu) {
                *mu = factor * path.line_load.sqrt() * node.share.sqrt();
                path.notes.observe(&MU, *mu);
            }
            Ok(Along {
                first_heat: if self.0 == Slip::Heat { 0.4 } else { 0.5 },
            })
        }

        fn along_lanes(&self, path: &PathAt<'_>, line_loads: &Lane, mu: &mut [Lane]) -> bool {
            let factor = match self.0 {
                Slip::Lanes => (1.0 + 1e-15) * self.factor(path),
                Slip::Mean => self.factor(path) * path.mean.normal_force,
                Slip::LanesKeep => path.notes.once(|| [line_loads[0], 0.0])[0],
                _ => self.factor(path),
            };
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
            let raised = powers.raise(0, |i| line_loads[i], 0.5, |load| load.sqrt() * within);
            // Remembered powers are not exact roots.
            let forgets =
                self.law.0 == Slip::Forgets && (0..LANES).any(|i| !same_bits(raised[i], line_loads[i].sqrt()));
            let raised = if forgets { Lane::all(f64::NAN) } else { raised };
            over(&raised, |raised| raised * outside * self.sum)
        }
    }

    #[test]
    fn every_slip_of_a_law_for_paths_is_found() {
        let base = NoteBase::default().until(1);
        let found = |slip| fault(&RootLaw(slip), &ContactAt::usual(&NoPart {}, Notes::MUTED), base);
        assert_eq!(found(Slip::None), None);
        for (slip, words) in [
            (Slip::Keeps, "keeps a value that depends on the line load"),
            (Slip::LanesKeep, "keeps a value that depends on the line load"),
            (Slip::Negative, "negative or NaN"),
            (Slip::Lanes, "`along_lanes` differs"),
            (Slip::Mean, "`along_lanes` differs"),
            (Slip::Heat, "does not split its heat equally"),
            (Slip::Sum, "the sum of `weighted` differs"),
            (Slip::Sums, "`sums` differs"),
            (Slip::Remembers, "`sums` remembers"),
            (Slip::Forgets, "`sums` remembers"),
            (Slip::Notes, "writes other notes than `along`"),
        ] {
            let fault = found(slip).unwrap();
            assert!(fault.contains(words), "{slip:?}: {fault}");
        }
    }
}
