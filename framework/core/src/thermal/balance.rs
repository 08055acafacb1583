//! The temperature at which losses and dissipated heat are equal, for any law of both.
//!
//! A plain iteration of T = T_ambient + P(T)/(alpha A) may oscillate or leave the range. Therefore a scan first brackets every
//! temperature at which the losses fall below the dissipated heat, and each step stays inside its bracket. A step is that of the
//! plain iteration, accelerated by the last two or three (secant, or inverse quadratic interpolation where it is safe:
//! Chandrupatla, Adv. Eng. Softw. 28 (1997) 145-149), else bisection.
//!
//! The scan needs signs only. Where many members are balanced, it asks for estimates of the losses first, and for the losses
//! themselves where an estimate does not decide, at the ends of each bracket, and everywhere if an estimate proves wrong by more than a
//! quarter or no bracket is found. With estimates within a quarter, temperatures are those of a scan with losses, to the bit.

mod closing;
mod scan;

use closing::Closings;
use scan::{Scan, Scanned, Search};

/// Intervals of the first scan.
const STRETCHES: usize = 16;
/// Number of times the scan is refined before the losses are assumed to be greater everywhere.
const DOUBLINGS: usize = 4;
/// Convergence tolerance: energy residual over the loss.
const TOLERANCE: f64 = 1e-10;
/// Rounding of the heat flows over their sum; smaller residuals are indistinguishable from zero.
const ROUNDING: f64 = 1e-14;

/// How accurate asked losses have to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accuracy {
    /// Usually to a few percent.
    Estimate,
    /// As those of a solved point.
    Exact,
}

/// Losses and heat at one temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Temperature. \[degC\]
    pub temperature: f64,
    /// Heat input: losses and heat sources. \[W\]
    pub loss: f64,
    /// Dissipated heat. \[W\]
    pub heat: f64,
    /// Sum of the magnitudes of all heat flows, the scale of rounding. \[W\]
    pub scale: f64,
}

impl Step {
    /// Residual. \[W\]
    pub fn residual(&self) -> f64 {
        self.loss - self.heat
    }

    fn is_balanced(&self) -> bool {
        self.residual().abs() <= (TOLERANCE * self.loss.abs()).max(ROUNDING * self.scale)
    }
}

/// A stable temperature: dissipation exceeds the losses above it, and the losses exceed dissipation below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// The temperature. \[degC\]
    pub temperature: f64,
    /// Losses and heat there; at a jump those of the colder side.
    pub step: Step,
    /// At a jump of a law: losses and heat on the warmer side.
    pub beyond: Option<Step>,
}

impl Root {
    fn from_step(step: Step) -> Self {
        Self {
            temperature: step.temperature,
            step,
            beyond: None,
        }
    }
}

/// Outcome of a balance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// One stable temperature.
    Converged,
    /// One stable temperature, at a jump of a law: losses exceed the dissipated heat below it, and are less above it.
    AtDiscontinuity,
    /// Several stable temperatures; the lowest is used.
    Several,
    /// Losses exceed the dissipated heat up to the maximum temperature of the search.
    NoneBelowMaximum,
    /// A law is undefined at the balance.
    Undefined,
    /// The temperatures of a network do not converge.
    NoConvergence,
}

impl Outcome {
    /// Name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::AtDiscontinuity => "at_discontinuity",
            Self::Several => "several",
            Self::NoneBelowMaximum => "none_below_maximum",
            Self::Undefined => "undefined",
            Self::NoConvergence => "no_convergence",
        }
    }
}

/// A balance with all evaluated steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance<E> {
    /// Outcome.
    pub outcome: Outcome,
    /// Stable temperatures, the lowest first.
    pub stable: Vec<Root>,
    /// All steps with exact losses: those of the scan, then those of each bracket.
    pub history: Vec<Step>,
    /// Index of the first step after the scan.
    pub scanned: usize,
    /// Spacing of the scan. \[K\]
    pub spacing: f64,
    /// Temperature at which a law was first asked without having a value, and the reason.
    pub undefined: Option<(f64, E)>,
}

impl<E> Balance<E> {
    /// The temperature that is used.
    pub fn taken(&self) -> Option<&Root> {
        self.stable.first()
    }

    fn new([low, high]: [f64; 2], stretches: usize) -> Self {
        Self {
            outcome: Outcome::NoneBelowMaximum,
            stable: Vec::new(),
            history: Vec::new(),
            scanned: 0,
            spacing: (high - low) / stretches as f64,
            undefined: None,
        }
    }

    /// Keeps what a law gave at a temperature.
    fn take(&mut self, temperature: f64, given: Result<Step, E>) -> Option<Step> {
        match given {
            Ok(step) => {
                self.history.push(step);
                Some(step)
            }
            Err(reason) => {
                self.undefined.get_or_insert((temperature, reason));
                None
            }
        }
    }
}

/// Finds the stable temperatures in a range; at its lower end no heat is dissipated. \[degC\]
///
/// Two crossings that are closer to each other than the spacing of the scan may both be missed; the residual of a found temperature
/// is still below 1e-10 of the loss.
pub fn balance<E>(range: [f64; 2], law: impl FnMut(f64) -> Result<Step, E>) -> Balance<E> {
    search_one(range, [STRETCHES, DOUBLINGS], law)
}

/// As [`balance`], without a scan: for losses that decrease and dissipation that increases throughout, so that there is one
/// temperature.
pub fn single<E>(range: [f64; 2], law: impl FnMut(f64) -> Result<Step, E>) -> Balance<E> {
    search_one(range, [1, 0], law)
}

fn search_one<E>(range: [f64; 2], scan: [usize; 2], mut law: impl FnMut(f64) -> Result<Step, E>) -> Balance<E> {
    let each = |asked: &[(usize, f64)], _| asked.iter().map(|(_, t)| law(*t)).collect();
    let mut found = search(range, scan, Accuracy::Exact, 1, each);
    found.pop().unwrap_or_else(|| Balance::new(range, 1))
}

/// As [`balance`], of several members side by side, with a scan of some accuracy. The law is asked for many at once: numbers of members
/// and temperatures.
pub(crate) fn balance_all<E>(
    range: [f64; 2],
    members: usize,
    scan: Accuracy,
    law: impl FnMut(&[(usize, f64)], Accuracy) -> Vec<Result<Step, E>>,
) -> Vec<Balance<E>> {
    search(range, [STRETCHES, DOUBLINGS], scan, members, law)
}

fn search<E>(
    [low, high]: [f64; 2],
    [stretches, doublings]: [usize; 2],
    accuracy: Accuracy,
    members: usize,
    law: impl FnMut(&[(usize, f64)], Accuracy) -> Vec<Result<Step, E>>,
) -> Vec<Balance<E>> {
    if members == 0 {
        return Vec::new();
    }
    let mut search = Search {
        found: (0..members).map(|_| Balance::new([low, high], stretches)).collect(),
        law,
    };
    let place = |i: usize, count: usize| low + (high - low) * i as f64 / count as f64;
    let everyone: Vec<usize> = (0..members).collect();
    let places: Vec<f64> = (0..=stretches).map(|i| place(i, stretches)).collect();
    let mut scans = search.scan(&everyone, &places, accuracy);
    if accuracy == Accuracy::Estimate {
        search.decide(&mut scans);
    }
    for doubling in 1..=doublings {
        // Losses exceeded dissipation at all points: refine the scan before concluding that they do so everywhere.
        let exceeds = |scan: &Scan| {
            let mut warmer = scan.iter().skip(1).map(Scanned::residual);
            warmer.all(|residual| residual.is_some_and(|residual| residual > 0.0))
        };
        let open: Vec<usize> = everyone
            .iter()
            .copied()
            .filter(|member| exceeds(&scans[*member]))
            .collect();
        if open.is_empty() {
            break;
        }
        let count = stretches << doubling;
        let places: Vec<f64> = (0..count / 2).map(|i| place(2 * i + 1, count)).collect();
        let finer = search.scan(&open, &places, Accuracy::Exact);
        for (member, between) in open.iter().zip(finer) {
            search.found[*member].spacing = (high - low) / count as f64;
            let mut between = between.into_iter();
            let scan = std::mem::take(&mut scans[*member]);
            scans[*member] = scan
                .into_iter()
                .flat_map(|old| [Some(old), between.next()])
                .flatten()
                .collect();
        }
    }
    let mut closings: Vec<Closings> = scans
        .into_iter()
        .zip(&mut search.found)
        .map(|(scan, found)| found.bracket(scan))
        .collect();
    loop {
        let asked: Vec<(usize, f64)> = everyone
            .iter()
            .filter_map(|member| Some((*member, closings[*member].next(&mut search.found[*member])?)))
            .collect();
        if asked.is_empty() {
            break;
        }
        let steps = search.ask(&asked, Accuracy::Exact);
        for ((member, _), step) in asked.iter().zip(steps) {
            closings[*member].take(step);
        }
    }
    for (found, closings) in search.found.iter_mut().zip(closings) {
        found.outcome = match &found.stable[..] {
            [] if closings.gap => Outcome::Undefined,
            [] => Outcome::NoneBelowMaximum,
            [one] if one.beyond.is_some() => Outcome::AtDiscontinuity,
            [_] => Outcome::Converged,
            _ => Outcome::Several,
        };
    }
    search.found
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn step(temperature: f64, loss: f64, conductance: f64) -> Step {
        let heat = conductance * (temperature - 20.0);
        Step {
            temperature,
            loss,
            heat,
            scale: loss + heat.abs(),
        }
    }

    fn solved(range: [f64; 2], conductance: f64, law: impl Fn(f64) -> f64) -> Balance<()> {
        balance(range, |t| Ok(step(t, law(t), conductance)))
    }

    #[test]
    fn e7_losses_that_fall_with_temperature() {
        let found = solved([20.0, 150.0], 8.0, |t| 300.0 * (-0.01 * (t - 40.0)).exp());
        assert_eq!(found.outcome, Outcome::Converged);
        assert!((found.stable[0].temperature - 52.9463).abs() < 5e-5);
        assert!(found.history.len() < 24, "{}", found.history.len());
    }

    #[test]
    fn e1_a_constant_loss_is_balanced_where_alpha_a_says() {
        let found = solved([20.0, 150.0], 24.7 * 0.05, |_| 74.1);
        assert!((found.stable[0].temperature - 80.0).abs() < 1e-8);
    }

    #[test]
    fn without_loss_it_stays_at_the_surroundings() {
        let found = solved([20.0, 150.0], 1.2, |_| 0.0);
        assert_eq!((found.outcome, found.stable[0].temperature), (Outcome::Converged, 20.0));
    }

    #[test]
    fn a_jump_downwards_is_named_with_both_residuals() {
        let found = solved([20.0, 150.0], 1.0, |t| if t < 61.7 { 80.0 } else { 10.0 });
        assert_eq!(found.outcome, Outcome::AtDiscontinuity);
        let root = found.stable[0];
        let beyond = root.beyond.map_or(f64::NAN, |s| s.residual());
        assert!((root.temperature - 61.7).abs() < 1e-9);
        assert!((root.step.residual() - 38.3).abs() < 1e-6 && (beyond + 31.7).abs() < 1e-6);
    }

    #[test]
    fn losses_that_rise_faster_than_the_heat_have_no_balance() {
        let found = solved([20.0, 150.0], 1.0, |t| 2.0 * (t - 10.0));
        assert_eq!(found.outcome, Outcome::NoneBelowMaximum);
        assert!(found.spacing < 0.6);
    }

    #[test]
    fn of_several_the_lowest_is_taken() {
        // Two decreasing steps with an increase in between: 40 and 90 degC are stable, 60 is not.
        let found = solved([20.0, 150.0], 1.0, |t| if t < 60.0 { 20.0 } else { 70.0 });
        assert_eq!(found.outcome, Outcome::Several);
        let at: Vec<f64> = found.stable.iter().map(|r| r.temperature).collect();
        assert!((at[0] - 40.0).abs() < 1e-7 && (at[1] - 90.0).abs() < 1e-7, "{at:?}");
    }

    #[test]
    fn a_law_without_value_at_the_balance_is_reported() {
        let law = |least: f64| {
            balance([20.0, 150.0], move |t| {
                if t < least {
                    Err("too cold")
                } else {
                    Ok(step(t, 50.0, 1.0))
                }
            })
        };
        assert_eq!(law(30.0).outcome, Outcome::Converged);
        let lost = law(100.0);
        assert_eq!(
            (lost.outcome, lost.undefined),
            (Outcome::Undefined, Some((20.0, "too cold")))
        );
        assert_eq!(law(200.0).outcome, Outcome::Undefined);
    }

    /// A loss law: decreasing exponential, humps, and jumps in both directions.
    #[derive(Debug, Clone)]
    struct Law {
        base: f64,
        fall: f64,
        humps: Vec<[f64; 3]>,
        jumps: Vec<[f64; 2]>,
    }

    impl Law {
        fn loss_at(&self, t: f64) -> f64 {
            let mut loss = self.base * (-self.fall * (t - 20.0)).exp();
            for [place, width, height] in &self.humps {
                loss += height * (-((t - place) / width).powi(2)).exp();
            }
            for [place, height] in &self.jumps {
                if t > *place {
                    loss += height;
                }
            }
            loss.max(0.0)
        }
    }

    prop_compose! {
        fn laws()(
            base in prop_oneof![Just(0.0), 0.001..2000.0_f64],
            fall in -0.02..0.08_f64,
            humps in prop::collection::vec([20.0..150.0_f64, 3.0..40.0, 0.0..200.0], 0..3),
            jumps in prop::collection::vec([20.0..150.0_f64, -200.0..200.0], 0..4),
        ) -> Law {
            Law { base, fall, humps, jumps }
        }
    }

    proptest! {
        /// Estimates that are wrong by up to a fifth, and some without value: the same temperatures to the bit.
        #[test]
        fn a_scan_of_estimates_finds_the_temperatures_of_a_scan(
            members in prop::collection::vec((laws(), 0.1..30.0_f64, 0.0..1.0_f64), 0..6),
            rough in 0.0..0.2_f64,
        ) {
            let exact = |member: usize, t: f64| {
                let (law, conductance, _) = &members[member];
                step(t, law.loss_at(t), *conductance)
            };
            let mut estimated = 0;
            let found = balance_all([20.0, 150.0], members.len(), Accuracy::Estimate, |asked, accuracy| {
                let each = asked.iter().map(|(member, t)| {
                    let step = exact(*member, *t);
                    let seed = (t * 7.3 + members[*member].2).sin();
                    estimated += usize::from(accuracy == Accuracy::Estimate);
                    match accuracy {
                        Accuracy::Estimate if seed > 0.9 => Err(()),
                        Accuracy::Estimate => Ok(Step { loss: step.loss * (1.0 + rough * seed), ..step }),
                        Accuracy::Exact => Ok(step),
                    }
                });
                each.collect()
            });
            prop_assert_eq!(estimated, (STRETCHES + 1) * members.len());
            for (member, together) in found.iter().enumerate() {
                let alone = balance([20.0, 150.0], |t| Ok::<_, ()>(exact(member, t)));
                prop_assert_eq!((together.outcome, &together.stable), (alone.outcome, &alone.stable));
                prop_assert_eq!((together.spacing, together.undefined), (alone.spacing, None));
                prop_assert!(together.history.len() <= alone.history.len());
            }
        }
    }

    /// The balance of losses from a scan of other ones, and that from a scan of losses.
    fn with_estimates(
        estimate: impl Fn(f64) -> f64,
        law: impl Fn(f64) -> Result<f64, &'static str>,
    ) -> [Balance<&'static str>; 2] {
        let exact = |t: f64| law(t).map(|loss| step(t, loss, 1.0));
        let mut found = balance_all([20.0, 150.0], 1, Accuracy::Estimate, |asked, accuracy| {
            let each = asked.iter().map(|(_, t)| match accuracy {
                Accuracy::Estimate => Ok(step(*t, estimate(*t), 1.0)),
                Accuracy::Exact => exact(*t),
            });
            each.collect()
        });
        [found.remove(0), balance([20.0, 150.0], exact)]
    }

    #[test]
    fn a_wrong_estimate_is_followed_by_a_scan_of_losses() {
        let fall = |at: f64| move |t: f64| if t < at { 500.0 } else { 1.0 };
        // The estimates have their only crossing at 120 degC, the losses theirs at 60 degC.
        let [found, alone] = with_estimates(fall(120.0), |t| Ok(fall(60.0)(t)));
        assert_eq!(found.stable, alone.stable);
        assert!((found.stable[0].temperature - 60.0).abs() < 1e-9);
        // The estimates have crossings at 50 and 120 degC; the losses fall to the heat at 30 degC instead of 50 degC.
        let dip = |from: f64| move |t: f64| if (from..85.0).contains(&t) { 1.0 } else { fall(120.0)(t) };
        let [found, alone] = with_estimates(dip(50.0), |t| Ok(dip(30.0)(t)));
        assert_eq!(found.stable, alone.stable);
        assert!(found.stable.len() == 2 && (found.stable[0].temperature - 30.0).abs() < 1e-9);
        // The losses have no value at an end of the bracket.
        let [found, alone] = with_estimates(fall(60.0), |t| if t < 60.0 { Err("too cold") } else { Ok(1.0) });
        assert_eq!((found.outcome, alone.outcome), (Outcome::Undefined, Outcome::Undefined));
        assert_eq!(found.undefined.map(|(_, why)| why), Some("too cold"));
    }

    #[test]
    fn a_dip_between_temperatures_of_the_scan_is_found_with_estimates() {
        let law = |t: f64| if (70.0..73.0).contains(&t) { 1.0 } else { 500.0 };
        let [found, alone] = with_estimates(|_| 450.0, |t| Ok(law(t)));
        assert_eq!((&found.stable, found.spacing), (&alone.stable, alone.spacing));
        assert!((found.stable[0].temperature - 70.0).abs() < 1e-9 && found.spacing < 4.1);
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 10_000, ..ProptestConfig::default() })]
        #[test]
        fn ten_thousand_laws_balance_or_have_the_outcome_that_is_true(law in laws(), conductance in 0.1..30.0_f64) {
            let found = solved([20.0, 150.0], conductance, |t| law.loss_at(t));
            let residual = |t: f64| law.loss_at(t) - conductance * (t - 20.0);
            for root in &found.stable {
                let loss = law.loss_at(root.temperature);
                match root.beyond {
                    // A very small loss is matched as well as the digits of the temperature allow.
                    None => prop_assert!(residual(root.temperature).abs() <= (1e-9 * loss).max(1e-13 * conductance)),
                    // Adjacent residuals with different signs: the law jumps there.
                    Some(beyond) => {
                        prop_assert!(beyond.temperature - root.temperature < 1e-9);
                        prop_assert!(root.step.residual() > 0.0 && beyond.residual() <= 0.0);
                        let jump = |[place, _]: &[f64; 2]| root.temperature <= *place && *place <= beyond.temperature;
                        prop_assert!(law.jumps.iter().any(jump));
                    }
                }
                // It is stable: greater losses just below, smaller just above, except for jumps as close and for the lower end.
                let near = |place: f64| (place - root.temperature).abs() < 2e-4;
                if !law.jumps.iter().any(|[place, _]| near(*place)) && root.temperature > 20.001 {
                    prop_assert!(residual(root.temperature - 1e-4) > 0.0 && residual(root.temperature + 1e-4) < 0.0);
                }
            }
            // It is the lowest that the scan can find: above every point below it the losses are greater.
            if let Some(root) = found.stable.first() {
                let mut t = 20.0 + found.spacing;
                while t < root.temperature {
                    prop_assert!(residual(t) > 0.0, "{t}");
                    t += found.spacing;
                }
            }
            prop_assert!(found.stable.windows(2).all(|w| w[0].temperature < w[1].temperature));
            match found.outcome {
                Outcome::Converged => prop_assert!(found.stable.len() == 1 && found.stable[0].beyond.is_none()),
                Outcome::AtDiscontinuity => prop_assert!(found.stable.len() == 1 && found.stable[0].beyond.is_some()),
                Outcome::Several => prop_assert!(found.stable.len() > 1),
                Outcome::NoneBelowMaximum => {
                    // True at every point of a scan as fine as that of the balance, and at its ends.
                    let mut t = 20.0;
                    while t <= 150.0 {
                        prop_assert!(residual(t) > 0.0 || t == 20.0, "{t}");
                        t += found.spacing;
                    }
                }
                Outcome::Undefined | Outcome::NoConvergence => prop_assert!(false, "every law is defined everywhere"),
            }
        }
    }
}
