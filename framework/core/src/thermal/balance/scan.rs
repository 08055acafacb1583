//! The scan: estimated or exact losses at temperatures over the whole range, and the brackets found from them.

use std::collections::BTreeSet;

use super::closing::Closings;
use super::{Accuracy, Balance, ROUNDING, Root, Step};

/// Residual over the estimated losses above which the sign of an estimate is relied on, and error above which no estimate of a scan is.
const CLEAR: f64 = 0.25;

impl Step {
    /// Whether the residual is too large for the error of an estimate to change its sign.
    fn is_clear(&self) -> bool {
        self.residual().abs() > (CLEAR * self.loss.abs()).max(ROUNDING * self.scale)
    }

    /// Whether the losses are those of an exact step, within the error that is allowed for an estimate.
    fn is_estimate_of(&self, exact: Option<Self>) -> bool {
        exact.is_some_and(|exact| (exact.loss - self.loss).abs() <= CLEAR * self.loss.abs())
    }
}

/// One temperature of a scan.
#[derive(Clone, Copy)]
pub(super) struct Scanned {
    temperature: f64,
    /// What the law gave there.
    step: Option<Step>,
    accuracy: Accuracy,
}

impl Scanned {
    pub fn residual(&self) -> Option<f64> {
        self.step.map(|step| step.residual())
    }

    fn is_decided(&self) -> bool {
        self.accuracy == Accuracy::Exact || self.step.is_some_and(|step| step.is_clear())
    }
}

/// The scan of one member, from its coldest temperature.
pub(super) type Scan = Vec<Scanned>;

/// Whether losses exceed dissipation at the first and no longer at the second of two temperatures.
fn is_bracket(cold: &Scanned, warm: &Scanned) -> bool {
    matches!((cold.residual(), warm.residual()), (Some(cold), Some(warm)) if cold > 0.0 && warm <= 0.0)
}

/// Several members and the law that they are asked of.
pub(super) struct Search<E, L> {
    pub found: Vec<Balance<E>>,
    pub law: L,
}

impl<E, L: FnMut(&[(usize, f64)], Accuracy) -> Vec<Result<Step, E>>> Search<E, L> {
    pub fn ask(&mut self, asked: &[(usize, f64)], accuracy: Accuracy) -> Vec<Option<Step>> {
        let given = (self.law)(asked, accuracy).into_iter().zip(asked);
        let taken = given.map(|(given, (member, t))| match accuracy {
            Accuracy::Exact => self.found[*member].take(*t, given),
            Accuracy::Estimate => given.ok(),
        });
        taken.collect()
    }

    /// The scans of some members. They are asked side by side at each temperature, because they have more in common than the
    /// temperatures of a member.
    pub fn scan(&mut self, members: &[usize], places: &[f64], accuracy: Accuracy) -> Vec<Scan> {
        let pairs = places.iter().flat_map(|t| members.iter().map(|member| (*member, *t)));
        let steps = self.ask(&pairs.collect::<Vec<_>>(), accuracy);
        let scanned = |(temperature, step): (&f64, &Option<Step>)| Scanned {
            temperature: *temperature,
            step: *step,
            accuracy,
        };
        let steps_of_member = |number: usize| steps.iter().skip(number).step_by(members.len());
        (0..members.len())
            .map(|number| places.iter().zip(steps_of_member(number)).map(scanned).collect())
            .collect()
    }

    /// Replaces estimates by exact steps: where they do not decide, at the ends of brackets, and everywhere in a scan with a wrong
    /// estimate or without a bracket.
    pub fn decide(&mut self, scans: &mut [Scan]) {
        let mut wrong = self.replace(scans, |_, scan, i| !scan[i].is_decided());
        let is_end = |scan: &Scan, i: usize| {
            i > 0 && is_bracket(&scan[i - 1], &scan[i]) || i + 1 < scan.len() && is_bracket(&scan[i], &scan[i + 1])
        };
        wrong.extend(self.replace(scans, |_, scan, i| is_end(scan, i)));
        for (member, scan) in scans.iter().enumerate() {
            if !(1..scan.len()).any(|i| is_end(scan, i)) {
                wrong.insert(member);
            }
        }
        self.replace(scans, |member, _, _| wrong.contains(&member));
    }

    /// Replaces the estimates that are wanted by exact steps, temperature by temperature. Returns the members with a wrong estimate.
    fn replace(&mut self, scans: &mut [Scan], is_wanted: impl Fn(usize, &Scan, usize) -> bool) -> BTreeSet<usize> {
        let mut wanted: Vec<(usize, usize)> = Vec::new();
        for (member, scan) in scans.iter().enumerate() {
            let places = (0..scan.len()).filter(|i| scan[*i].accuracy == Accuracy::Estimate);
            wanted.extend(places.filter(|i| is_wanted(member, scan, *i)).map(|i| (i, member)));
        }
        wanted.sort_unstable();
        let asked: Vec<(usize, f64)> = wanted
            .iter()
            .map(|(i, member)| (*member, scans[*member][*i].temperature))
            .collect();
        let mut wrong = BTreeSet::new();
        for ((i, member), step) in wanted.into_iter().zip(self.ask(&asked, Accuracy::Exact)) {
            let scanned = &mut scans[member][i];
            if scanned.step.is_some_and(|estimate| !estimate.is_estimate_of(step)) {
                wrong.insert(member);
            }
            (scanned.step, scanned.accuracy) = (step, Accuracy::Exact);
        }
        wrong
    }
}

impl<E> Balance<E> {
    /// The brackets of a finished scan.
    pub(super) fn bracket(&mut self, scan: Scan) -> Closings {
        self.scanned = self.history.len();
        if let Some(Scanned { step: Some(first), .. }) = scan.first()
            && first.is_balanced()
            && scan[1].residual().is_some_and(|next| next < 0.0)
        {
            // No loss: the lower end itself.
            self.stable.push(Root::from_step(*first));
        }
        let mut brackets = Vec::new();
        let mut gap = scan.iter().all(|scanned| scanned.step.is_none());
        for pair in scan.windows(2) {
            match (pair[0].step, pair[1].step) {
                (Some(a), Some(b)) if is_bracket(&pair[0], &pair[1]) => brackets.push([a, b]),
                // Losses are below dissipation where a law starts to be defined, or above it where a law ends.
                (None, Some(b)) if b.residual() <= 0.0 => gap = true,
                (Some(a), None) if a.residual() > 0.0 => gap = true,
                _ => {}
            }
        }
        Closings::new(brackets, gap)
    }
}
