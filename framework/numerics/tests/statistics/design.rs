//! What to measure next in the made-up problem: 22 points at one torque and viscosity are known, all 440 are candidates.

use gearloss_numerics::design::{Design, Information, Plan, Rule, uniform_row};
use gearloss_numerics::inference::{Parameter, Scale};
use gearloss_numerics::sensitivity::gradients;

use super::check_problem::{BOUNDS, NAMES, START, model, points};

/// Printed with six to nine digits, the last of six worth up to 1e-5; derivatives have ten.
fn near(x: f64, y: f64) {
    assert!((x - y).abs() <= 5e-6 * y.abs(), "{x} instead of {y}");
}

fn ranges() -> [f64; 8] {
    BOUNDS.map(|[low, high]| high - low)
}

/// Gradients over the parameters themselves, over the standard uncertainty of each point, at the start values.
fn candidates() -> Vec<Vec<f64>> {
    let list: Vec<Parameter> = (0..8)
        .map(|k| Parameter::new(NAMES[k], Scale::Linear, START[k], BOUNDS[k]).unwrap())
        .collect();
    let points = points();
    gradients(&list, 0.0, |theta| {
        Ok(points.iter().map(|at| model(theta, at) / at.sigma()).collect())
    })
    .unwrap()
}

fn known(candidates: &[Vec<f64>]) -> Information {
    let points = points();
    let mut rows: Vec<Vec<f64>> = (0..8).map(|k| uniform_row(k, &ranges())).collect();
    let measured = (0..440).filter(|i| points[*i].nu == 6.4 && points[*i].torque == 10.0);
    rows.extend(measured.map(|i| candidates[i].clone()));
    assert_eq!(rows.len(), 30);
    Information::new(&ranges(), &rows).unwrap()
}

/// Eight for another oil temperature, a half for another torque.
fn change_over(a: usize, b: usize) -> f64 {
    let points = points();
    let oil = if points[a].nu == points[b].nu { 0.0 } else { 8.0 };
    oil + if points[a].torque == points[b].torque { 0.0 } else { 0.5 }
}

fn plan(rule: Rule, dear: bool) -> Plan {
    let candidates = candidates();
    let cost = |a: usize, b: usize| if dear { change_over(a, b) } else { 0.0 };
    Design::new(known(&candidates), &candidates, rule, cost)
        .unwrap()
        .greedy(8)
        .unwrap()
}

fn check(rule: Rule, dear: bool, numbers: [usize; 8], [determinant, trace, worst]: [f64; 3]) {
    let plan = plan(rule, dear);
    let found: Vec<usize> = plan.candidates().iter().map(|i| i + 1).collect();
    assert_eq!(found, numbers);
    near(plan.after.ln_determinant, determinant);
    near(plan.after.trace, trace);
    near(plan.after.worst(), worst);
}

#[test]
fn check_5_what_is_known_before() {
    let before = known(&candidates()).precision();
    let expected = [
        0.2745144, 0.1450797, 0.2886751, 0.2817746, 0.2446087, 0.1196476, 0.2656406, 0.1494142,
    ];
    for (x, y) in before.deviations.iter().zip(expected) {
        near(*x, y);
    }
    near(before.ln_determinant, -33.2336011);
    near(before.trace, 0.426174992);
}

#[test]
fn check_5_determinant() {
    let after = [-44.3538477, 0.177293207, 0.2399307];
    check(Rule::Determinant, false, [419, 22, 222, 216, 11, 242, 419, 44], after);
    for (choice, gain) in plan(Rule::Determinant, false)
        .choices
        .iter()
        .zip([3.17676, 2.61949, 1.65886])
    {
        near(choice.gain, gain);
    }
}

#[test]
fn check_5_determinant_with_change_over() {
    let after = [-41.8983135, 0.233121601, 0.271318];
    check(Rule::Determinant, true, [419, 222, 242, 221, 440, 419, 440, 419], after);
}

#[test]
fn check_5_trace() {
    let after = [-43.7676159, 0.168662881, 0.2305522];
    check(Rule::Trace, false, [208, 44, 199, 222, 419, 220, 233, 221], after);
    for (choice, gain) in plan(Rule::Trace, false)
        .choices
        .iter()
        .zip([0.0742294, 0.0669359, 0.0385155])
    {
        near(choice.gain, gain);
    }
}

#[test]
fn check_5_trace_with_change_over() {
    check(
        Rule::Trace,
        true,
        [208, 44, 199, 1, 11, 220, 199, 1],
        [-43.788709, 0.176826094, 0.2278918],
    );
}

#[test]
fn check_5_worst() {
    let after = [-41.6046746, 0.2099798, 0.2273944];
    check(Rule::Worst, false, [163, 45, 1, 154, 438, 1, 177, 220], after);
    for (choice, gain) in plan(Rule::Worst, false)
        .choices
        .iter()
        .zip([0.0212183, 0.0111783, 0.0118214])
    {
        near(choice.gain, gain);
    }
}

#[test]
fn check_5_worst_with_change_over() {
    check(
        Rule::Worst,
        true,
        [163, 45, 1, 154, 200, 220, 1, 9],
        [-42.11273, 0.202672762, 0.2269389],
    );
}

#[test]
fn an_exchange_never_worsens_a_plan_nor_makes_it_dearer() {
    let candidates = candidates();
    for rule in [Rule::Determinant, Rule::Trace, Rule::Worst] {
        let design = Design::new(known(&candidates), &candidates, rule, change_over).unwrap();
        let greedy = design.greedy(8).unwrap();
        let better = design.exchange(&greedy).unwrap();
        let cost = |plan: &Plan| plan.choices.iter().map(|c| c.cost).sum::<f64>();
        assert!(cost(&better) <= cost(&greedy));
        let [a, b] = [&greedy.after, &better.after].map(|after| match rule {
            Rule::Determinant => after.ln_determinant,
            Rule::Trace => after.trace,
            Rule::Worst => after.worst(),
        });
        assert!(b <= a + 1e-12, "{rule:?}: {b} after {a}");
    }
}
