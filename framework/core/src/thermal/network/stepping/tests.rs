#![allow(clippy::unwrap_used)]
use super::super::circuit::tests::drive_unit;
use super::super::circuit::{Circuit, Exchange};
use super::*;

/// Nodes of the drive unit that store heat; its first is unused, its second the ambient, its last behind the exchanger.
const STORING: std::ops::Range<usize> = 2..17;
const START: f64 = 23.0;

/// The drive unit, with its heat decreasing and the link of casing and sump increasing by a share per kelvin.
#[derive(Clone)]
struct Unit {
    circuit: Circuit,
    heat: Vec<f64>,
    per_kelvin: f64,
    steps: [usize; 2],
}

impl Unit {
    fn new(per_kelvin: f64) -> Self {
        let (circuit, heat) = drive_unit();
        Self {
            circuit,
            heat,
            per_kelvin,
            steps: [0; 2],
        }
    }

    fn heat(&self, node: usize, temperature: f64) -> f64 {
        self.heat[node] * (1.0 - self.per_kelvin * (temperature - START))
    }

    fn conductance(&self, [a, b]: [usize; 2], given: f64, t: &[f64]) -> f64 {
        if [a, b] == [2, 14] {
            given * (1.0 + self.per_kelvin * (0.5 * (t[a] + t[b]) - START))
        } else {
            given
        }
    }

    /// Temperatures after an interval in s, and its energies.
    fn march(&mut self, scheme: Scheme, step: StepSize, intervals: &[f64]) -> (Vec<f64>, Heats) {
        let mut t = vec![START; self.heat.len()];
        let mut stepping = Stepping::new(scheme, step);
        let mut heats = Heats::default();
        for duration in intervals {
            heats.add(&stepping.advance(self, &mut t, *duration).unwrap());
        }
        (t, heats)
    }

    /// Temperature rates, implemented independently: without a matrix and without the circuit's own equations.
    fn slopes(&self, y: &[f64]) -> Vec<f64> {
        let mut t = y.to_vec();
        // Nodes without heat capacity follow immediately.
        let Exchange { from, to, .. } = self.circuit.exchangers[0];
        t[to] = self.circuit.exchangers[0].outlet(t[from]);
        let mut heat: Vec<f64> = (0..t.len()).map(|i| self.heat(i, t[i])).collect();
        for (ends, given) in &self.circuit.links {
            let [a, b] = *ends;
            let through = self.conductance(*ends, *given, &t) * (t[a] - t[b]);
            heat[a] -= through;
            heat[b] += through;
        }
        for ([up, down], capacity) in &self.circuit.flows {
            heat[*down] += capacity * (t[*up] - t[*down]);
        }
        let mut slopes = vec![0.0; t.len()];
        for node in STORING {
            slopes[node] = heat[node] / self.circuit.capacities[node];
        }
        slopes
    }

    /// The temperatures from another solver.
    fn reference(&self, duration: f64) -> Vec<f64> {
        dormand_prince(|t| self.slopes(t), vec![START; self.heat.len()], duration)
    }
}

/// Weights of the previous slopes in each stage of Dormand and Prince, 5(4); those of the last stage give the fifth-order solution.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// Weights of all slopes in the difference between fifth and fourth order.
const DIFFERENCE: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Solves y' = f(y) explicitly, with adaptive steps, each to 1e-11 relative and absolute.
fn dormand_prince(slopes: impl Fn(&[f64]) -> Vec<f64>, mut y: Vec<f64>, duration: f64) -> Vec<f64> {
    let (mut time, mut step) = (0.0, 1e-3);
    while time < duration {
        step = f64::min(step, duration - time);
        let mut found = vec![slopes(&y)];
        let weighted = |weights: &[f64], found: &[Vec<f64>], i: usize| -> f64 {
            step * weights.iter().zip(found).map(|(w, slopes)| w * slopes[i]).sum::<f64>()
        };
        let mut end = Vec::new();
        for weights in STAGES {
            end = (0..y.len()).map(|i| y[i] + weighted(weights, &found, i)).collect();
            found.push(slopes(&end));
        }
        let error = (0..y.len())
            .map(|i| weighted(&DIFFERENCE, &found, i).abs() / (1e-11 * (1.0 + y[i].abs())))
            .fold(0.0, f64::max);
        if error <= 1.0 {
            time += step;
            y = end;
        }
        step *= (0.9 * error.powf(-0.2)).clamp(0.2, 5.0);
    }
    y
}

impl Heated for Unit {
    fn warm(&mut self, trials: &mut [Trial], _: Search) -> Result<(), Unbalanced> {
        for Trial { guess: t, warm, .. } in trials {
            warm.circuit = self.circuit.clone();
            for (ends, g) in &mut warm.circuit.links {
                *g = self.conductance(*ends, *g, t);
            }
            warm.heat = (0..t.len()).map(|i| self.heat(i, t[i])).collect();
            warm.point.watts.clone_from(&warm.heat);
        }
        Ok(())
    }
    fn stepped(&mut self, taken: Option<(f64, &Warm)>) {
        self.steps[usize::from(taken.is_none())] += 1;
    }
}

fn error(one: &[f64], other: &[f64]) -> f64 {
    farthest(&one[STORING], &other[STORING])
}

/// Errors after a time with steps of 8, 4, 2 and 1 s.
fn errors(unit: &mut Unit, scheme: Scheme, duration: f64) -> Vec<f64> {
    let reference = unit.reference(duration);
    let error = |step| error(&unit.march(scheme, StepSize::Fixed(step), &[duration]).0, &reference);
    [8.0, 4.0, 2.0, 1.0].map(error).to_vec()
}

#[test]
fn the_other_solver_follows_an_oscillator() {
    let end = dormand_prince(|y| vec![y[1], -y[0]], vec![1.0, 0.0], 20.0);
    let exact = [20.0_f64.cos(), -20.0_f64.sin()];
    assert!(farthest(&end, &exact) < 2e-9, "{end:?} {exact:?}");
}

#[test]
fn halved_steps_halve_the_error_against_another_solver() {
    for scheme in [Scheme::Implicit, Scheme::Lagged] {
        for duration in [64.0, 600.0] {
            let errors = errors(&mut Unit::new(0.0), scheme, duration);
            assert!(errors[3] < 0.06, "{scheme:?} {duration} {errors:?}");

            for pair in errors.windows(2) {
                let ratio = pair[0] / pair[1];
                assert!((1.7..2.2).contains(&ratio), "{scheme:?} {duration} {errors:?}");
            }
        }
    }
}

#[test]
fn losses_that_fall_and_links_that_rise_with_temperature_follow_too() {
    for scheme in [Scheme::Implicit, Scheme::Lagged] {
        let errors = errors(&mut Unit::new(0.01), scheme, 600.0);
        assert!(errors[3] < 0.06, "{scheme:?} {errors:?}");

        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((1.6..2.4).contains(&ratio), "{scheme:?} {errors:?}");
        }
    }
}

#[test]
fn adapted_steps_keep_to_their_tolerance() {
    for per_kelvin in [0.0, 0.01] {
        let reference = Unit::new(per_kelvin).reference(600.0);
        for tolerance in [0.3, 0.1, 0.03] {
            let mut unit = Unit::new(per_kelvin);
            let (t, heats) = unit.march(Scheme::Implicit, StepSize::Adaptive(tolerance), &[600.0]);
            let error = error(&t, &reference);
            assert!(error < 0.5 * tolerance, "{per_kelvin} {tolerance}: {error}");
            assert!(heats.residual().abs() < 1e-9 * heats.heat_input());
            assert!(unit.steps[0] < 200 && unit.steps[1] < 20, "{:?}", unit.steps);
        }
    }
}

#[test]
fn energy_is_kept_whatever_the_steps() {
    let steps = [StepSize::Fixed(1.0), StepSize::Fixed(60.0), StepSize::Adaptive(0.1)];
    for (scheme, step) in [Scheme::Implicit, Scheme::Lagged]
        .into_iter()
        .flat_map(|scheme| steps.map(|step| (scheme, step)))
    {
        let (_, heats) = Unit::new(0.01).march(scheme, step, &[30.0, 600.0, 0.5]);
        assert!((heats.duration - 630.5).abs() < 1e-9);
        assert!(
            heats.residual().abs() < 1e-9 * heats.heat_input(),
            "{scheme:?} {step:?} {}",
            heats.residual()
        );
    }
}

#[test]
fn a_long_march_ends_at_rest() {
    for per_kelvin in [0.0, 0.01] {
        let mut unit = Unit::new(per_kelvin);
        let (t, _) = unit.march(Scheme::Implicit, StepSize::Fixed(2e4), &[4e6]);
        let mut trials = [Trial::default()];
        let mut rest = t.clone();
        for _ in 0..100 {
            trials[0].guess.clone_from(&rest);
            unit.warm(&mut trials, Search::ONLY).unwrap();
            let warm = &trials[0].warm;
            rest = warm.circuit.solve(&warm.heat, None).unwrap();
        }
        // The losses of a step belong to its end within a hundredth of a kelvin.
        assert!(error(&t, &rest) < 0.01, "{per_kelvin} {}", error(&t, &rest));
        if per_kelvin == 0.0 {
            assert!(error(&t, &rest) < 1e-9);
        }
    }
}

#[test]
fn u5k_lagged_steps_are_the_published_ones() {
    let mut unit = Unit::new(0.0);
    let mut stepping = Stepping::new(Scheme::Lagged, StepSize::Fixed(1.0));
    let mut t = vec![START; unit.heat.len()];
    for (duration, node, printed) in [
        (1.0, 14, 23.262936),
        (59.0, 14, 29.263425),
        (540.0, 4, 37.525723),
        (1200.0, 9, 44.789050),
        (5400.0, 16, 46.610521),
    ] {
        stepping.advance(&mut unit, &mut t, duration).unwrap();
        assert!(
            (t[node] - printed).abs() < 1e-6,
            "{node}: {} against {printed}",
            t[node]
        );
    }
}

#[test]
fn what_never_agrees_is_reported_and_changes_nothing() {
    struct Wild(bool);
    impl Heated for Wild {
        fn warm(&mut self, trials: &mut [Trial], _: Search) -> Result<(), Unbalanced> {
            // Two alternating results, far apart for any step length.
            self.0 = !self.0;
            let warm = &mut trials[0].warm;
            warm.circuit = Circuit {
                capacities: vec![0.0, 0.0],
                held: vec![Some(20.0), None],
                links: vec![([0, 1], 1.0)],
                ..Circuit::default()
            };
            warm.heat = vec![0.0, if self.0 { 50.0 } else { 0.0 }];
            Ok(())
        }
        fn stepped(&mut self, _: Option<(f64, &Warm)>) {}
    }
    let mut t = vec![20.0, 21.0];
    let mut stepping = Stepping::new(Scheme::Implicit, StepSize::Fixed(1.0));
    assert_eq!(
        stepping.advance(&mut Wild(false), &mut t, 1.0),
        Err(Unbalanced::Network)
    );
    assert_eq!(t, [20.0, 21.0]);
}

/// Temperatures, energies and numbers of steps of the unit over intervals of different length, one by one or together.
fn intervals(unit: &mut Unit, step: f64, together: bool) -> (Vec<f64>, Heats, Vec<usize>) {
    let durations: Vec<f64> = (0..60).map(|i| if i % 7 == 3 { 2.5 } else { 1.0 }).collect();
    let mut stepping = Stepping::new(Scheme::Implicit, StepSize::Fixed(step));
    let (mut t, mut heats, mut counts) = (vec![START; unit.heat.len()], Heats::default(), Vec::new());
    let mut rest = &durations[..];
    while !rest.is_empty() {
        let some = if together { rest } else { &rest[..1] };
        let passed = stepping.advance_together(unit, &mut t, some).unwrap();
        for stretch in &passed {
            heats.add(&stretch.heats);
        }
        assert_eq!(passed.last().unwrap().temperatures, t);
        rest = &rest[passed.len()..];
        counts.push(passed.len());
    }
    (t, heats, counts)
}

/// What is left of the iteration in temperatures is below its tolerance for one step, times the few steps over which a node forgets.
#[test]
fn steps_together_are_those_one_by_one_within_the_tolerance_of_the_iteration() {
    for (per_kelvin, step) in [(0.0, 1.0), (0.01, 1.0), (0.01, 0.25), (0.05, 1.0)] {
        let mut alone = Unit::new(per_kelvin);
        let mut together = alone.clone();
        let (t, heats, _) = intervals(&mut alone, step, false);
        let (own_t, own_heats, counts) = intervals(&mut together, step, true);
        assert!(
            counts.iter().any(|count| *count >= 4),
            "{per_kelvin} {step}: {counts:?}"
        );
        assert_eq!(alone.steps, together.steps);
        assert!(farthest(&t, &own_t) < AGREED, "{per_kelvin} {}", farthest(&t, &own_t));
        assert!((own_heats.duration - heats.duration).abs() < 1e-9);
        assert!(own_heats.residual().abs() < 1e-9 * own_heats.heat_input());
        assert!((own_heats.heat_input() / heats.heat_input() - 1.0).abs() < 1e-4);
    }
}

#[test]
fn steps_that_do_not_agree_together_are_solved_one_by_one_up_to_the_one_that_fails() {
    /// Fails in its third interval, and for several steps at once; with the numbers of steps that were evaluated.
    struct Stubborn(Unit, Vec<usize>);
    impl Heated for Stubborn {
        fn warm(&mut self, trials: &mut [Trial], search: Search) -> Result<(), Unbalanced> {
            self.1.push(trials.len());
            if trials.len() > 1 || self.0.steps[0] == 2 {
                return Err(Unbalanced::Flow);
            }
            self.0.warm(trials, search)
        }
        fn stepped(&mut self, taken: Option<(f64, &Warm)>) {
            self.0.stepped(taken);
        }
    }
    let mut unit = Stubborn(Unit::new(0.01), Vec::new());
    let mut stepping = Stepping::new(Scheme::Implicit, StepSize::Fixed(1e-3));
    let mut t = vec![START; unit.0.heat.len()];
    for _ in 0..2 {
        let passed = stepping.advance_together(&mut unit, &mut t, &[1e-3; 40]).unwrap();
        assert_eq!(passed.len(), 1);
    }
    let before = t.clone();
    assert_eq!(
        stepping.advance_together(&mut unit, &mut t, &[1e-3; 40]),
        Err(Unbalanced::Flow)
    );
    assert_eq!((t, unit.0.steps[0]), (before, 2));
    // A single step, then fewer and fewer steps together.
    assert_eq!(unit.1[..6], [1, 1, 16, 8, 1, 1]);
}

#[test]
fn only_implicit_steps_of_fixed_length_are_solved_together() {
    for (scheme, step, expected) in [
        (Scheme::Implicit, StepSize::Fixed(1.0), MOST_TOGETHER),
        (Scheme::Implicit, StepSize::Fixed(0.25), MOST_TOGETHER / 4),
        (Scheme::Implicit, StepSize::Fixed(0.01), 1),
        (Scheme::Implicit, StepSize::Adaptive(0.1), 1),
        (Scheme::Lagged, StepSize::Fixed(1.0), 1),
    ] {
        let mut stepping = Stepping::new(scheme, step);
        assert_eq!(stepping.reach(std::iter::repeat_n(1.0, 100)), 1);
        stepping.together = MOST_TOGETHER;
        assert_eq!(stepping.reach(std::iter::repeat_n(1.0, 100)), expected);
        assert_eq!(stepping.reach(std::iter::repeat_n(1.0, 1)), 1);
    }
}

/// Long steps need more iterations, and more together than one by one.
#[test]
fn long_steps_are_solved_one_by_one() {
    let mut unit = Unit::new(0.02);
    let mut stepping = Stepping::new(Scheme::Implicit, StepSize::Fixed(600.0));
    let mut t = vec![START; unit.heat.len()];
    for _ in 0..3 {
        let passed = stepping.advance_together(&mut unit, &mut t, &[600.0; 40]).unwrap();
        assert_eq!((passed.len(), stepping.together), (1, 1));
    }
}
