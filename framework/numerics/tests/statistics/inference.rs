//! Covariance, intervals, verdicts and bands at the optimum of the made-up problem.
//!
//! The optimum is given with ten digits and central differences have as many; the condition of 150 of the unit columns leaves
//! eight digits or so. Check values are printed with six to nine.

use gearloss_numerics::inference::{Fit, Parameter, Scale, Side, Verdict};
use gearloss_numerics::sensitivity::gradients;

use super::check_problem::{BOUNDS, DEVIATIONS, NAMES, OPTIMUM, Point, TERMS, TRUTH, fit, model, parameters, terms};

const F_NU: usize = 0;
const F_MU: usize = 1;
const F_L: usize = 3;
const F_0: usize = 4;
const H: usize = 5;
const M_S: usize = 6;
const D_T: usize = 7;

fn optimum() -> Fit {
    fit(parameters(&OPTIMUM))
}

fn near(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance * y.abs(), "{x} instead of {y}");
}

#[test]
fn check_7_2_lack_of_fit() {
    let fit = optimum();
    near(fit.chi_square(), 468.4034462, 1e-10);
    let test = fit.lack_of_fit().unwrap();
    assert_eq!(test.freedom, 432.0);
    near(test.objective / test.freedom, 1.08426724, 1e-8);
    near(test.probability, 0.109756, 1e-6);
    assert!(test.widening().is_none() && test.words().is_none());
    // At an optimum nothing pushes: the gradient beside lengths of column and residual.
    for k in 0..8 {
        assert!(fit.gradient(k).abs() < 1e-6 * fit.column(k) * fit.objective().sqrt());
    }
}

#[test]
fn check_7_2_covariance() {
    let fit = optimum();
    for (k, expected) in DEVIATIONS.into_iter().enumerate() {
        let of = &fit.parameters()[k];
        let unit = if of.scale == Scale::Log { of.theta() } else { 1.0 };
        near(fit.deviation(k).unwrap() * unit, expected, 1e-7);
    }
}

#[test]
fn check_7_2_correlations() {
    let fit = optimum();
    let rows: [&[f64]; 7] = [
        &[0.738683, 0.259505, -0.614936, -0.948905, -0.228905, -0.301147, 0.355377],
        &[-0.014647, -0.852408, -0.637183, -0.412906, -0.560309, 0.556083],
        &[-0.427922, -0.268748, 0.026651, 0.041094, 0.040772],
        &[0.524188, 0.367641, 0.499572, -0.523779],
        &[0.037667, 0.196068, -0.261392],
        &[0.902989, -0.897789],
        &[-0.993598],
    ];
    for (j, row) in rows.into_iter().enumerate() {
        for (i, expected) in row.iter().enumerate() {
            let found = fit.correlation(j, j + 1 + i).unwrap();
            assert!((found - expected).abs() < 6e-7, "{j}: {found} {expected}");
            assert_eq!(fit.correlation(j + 1 + i, j).unwrap(), found);
        }
    }
}

#[test]
fn check_7_2_intervals() {
    let fit = optimum();
    let expected = [
        [0.80942326, 1.7335364],
        [1.0395004, 1.2591075],
        [0.19462226, 0.31267595],
        [0.75881157, 1.4495149],
        [0.63717687, 1.4966036],
        [0.60744679, 0.84267258],
        [-0.013831183, 0.053564461],
        [-0.0062207318, 0.055018559],
    ];
    for (k, ends) in expected.into_iter().enumerate() {
        let interval = fit.interval(k, 0.95, 1.0).unwrap();
        near(interval.uncut[0], ends[0], 2e-7);
        near(interval.uncut[1], ends[1], 2e-7);
        assert_eq!(interval.is_cut(Side::Lower), k == M_S);
        assert!(!interval.is_cut(Side::Upper));
    }
    assert_eq!(fit.interval(M_S, 0.95, 1.0).unwrap().ends[0], 0.0);
    assert!(fit.interval(0, 1.0, 1.0).is_none());
}

#[test]
fn check_7_2_singular_values() {
    let fit = optimum();
    let unit = [
        2.35077296,
        1.34705878,
        0.728704735,
        0.261755879,
        0.198604436,
        0.130298193,
        0.0557369562,
        0.0156339971,
    ];
    // An absolute error of rounding beside the greatest, so the last has least digits.
    for (x, y) in fit.singular_values().iter().zip(unit) {
        near(*x, y, 2e-8);
    }
    near(fit.condition().unwrap(), 150.362888, 2e-8);
    let last = fit.direction(7);
    let expected = [
        0.0564842,
        0.0949892,
        0.000647811,
        -0.0684722,
        -0.0563258,
        -0.112269,
        -0.655548,
        0.733197,
    ];
    for (x, y) in last.iter().zip(expected) {
        assert!((x * last[D_T].signum() - y).abs() < 6e-7, "{last:?}");
    }
    assert!(!fit.is_singular());
}

#[test]
fn check_7_2_ranged_singular_values() {
    // The check counts all parameters by themselves, none by its logarithm.
    let linear: Vec<Parameter> = (0..8)
        .map(|k| Parameter::new(NAMES[k], Scale::Linear, OPTIMUM[k], BOUNDS[k]).unwrap())
        .collect();
    let all: Vec<usize> = (0..440).collect();
    let measured = super::check_problem::measured();
    let points = super::check_problem::points();
    let function = |theta: &[f64]| {
        let residual = |i: &usize| (model(theta, &points[*i]) - measured[*i]) / points[*i].sigma();
        Ok(all.iter().map(residual).collect())
    };
    let slopes = gradients(&linear, 0.0, function).unwrap();
    let jacobian = nalgebra::DMatrix::from_fn(440, 8, |i, k| slopes[i][k]);
    let u: Vec<f64> = parameters(&OPTIMUM).iter().map(|p| p.u).collect();
    let residuals = super::check_problem::residuals(&u, &all, &measured);
    let fit = Fit::new(
        linear,
        &jacobian,
        &residuals,
        0,
        gearloss_numerics::inference::Accuracy::Given,
    )
    .unwrap();
    let expected = [
        782.735901, 235.947523, 167.25295, 56.9139903, 30.3480047, 24.5195968, 8.81330677, 5.02207515,
    ];
    for (x, y) in fit.ranged_singular_values().into_iter().zip(expected) {
        near(x, y, 2e-7);
    }
}

#[test]
fn check_7_2_verdicts() {
    let fit = optimum();
    let expected: [(f64, f64, f64, Verdict, &[usize]); 8] = [
        (0.207793, 0.0207919, 0.100061, Verdict::OnlyInCombination, &[F_0]),
        (0.0732024, 0.00703456, 0.0960974, Verdict::WellDetermined, &[]),
        (0.0737836, 0.02308, 0.312807, Verdict::RoughlyDetermined, &[]),
        (0.108025, 0.0132258, 0.122432, Verdict::OnlyInCombination, &[F_MU]),
        (0.13264, 0.00959952, 0.0723725, Verdict::OnlyInCombination, &[F_NU]),
        (0.0653405, 0.00817699, 0.125144, Verdict::OnlyInCombination, &[M_S, D_T]),
        (0.336978, 0.00801003, 0.0237702, Verdict::OnlyInCombination, &[D_T, H]),
        (0.153098, 0.00326041, 0.0212962, Verdict::OnlyInCombination, &[M_S, H]),
    ];
    for (k, (width, alone, share, verdict, partners)) in expected.into_iter().enumerate() {
        let found = fit.determination(k);
        // Printed with six digits.
        near(found.width.unwrap(), width, 5e-6);
        near(found.alone.unwrap(), alone, 5e-6);
        near(found.own_share, share, 5e-6);
        assert_eq!(
            (found.verdict, &found.partners[..]),
            (verdict, partners),
            "{}",
            NAMES[k]
        );
    }
    assert_eq!(fit.determination(F_L).partners, [F_MU]);
}

/// Wider bounds are no better data, and no worse ones.
#[test]
fn verdicts_do_not_depend_on_the_width_of_the_bounds() {
    let narrow = optimum();
    for factor in [0.5, 2.0, 10.0] {
        let wider = parameters(&OPTIMUM).into_iter().map(|mut parameter| {
            parameter.bounds = parameter
                .bounds
                .map(|bound| parameter.u + factor * (bound - parameter.u));
            parameter
        });
        let wide = fit(wider.collect());
        for k in 0..8 {
            let [a, b] = [&narrow, &wide].map(|fit| fit.determination(k));
            assert_eq!(
                (a.verdict, &a.partners),
                (b.verdict, &b.partners),
                "{} {factor}",
                NAMES[k]
            );
            // Steps of differences follow the range, and leave as many digits.
            near(a.relative.unwrap(), b.relative.unwrap(), 1e-6);
            near(a.width.unwrap(), factor * b.width.unwrap(), 1e-6);
            assert!(a.filled.unwrap() <= 1.0);
        }
        let resolved = |fit: &Fit| fit.sized_singular_values().iter().filter(|s| **s > 4.0).count();
        assert_eq!(resolved(&narrow), resolved(&wide));
    }
}

#[test]
fn an_interval_that_fills_the_range_is_named_as_such() {
    let list = parameters(&OPTIMUM).into_iter().enumerate().map(|(k, mut parameter)| {
        if k == H {
            parameter.bounds = [parameter.u - 0.1, parameter.u + 0.15];
        }
        parameter
    });
    let fit = fit(list.collect());
    let found = fit.determination(H);
    assert!((0.8..=1.0).contains(&found.filled.unwrap()), "{found:?}");
    let words = format!(
        "its interval fills {:.0} % of the given range",
        100.0 * found.filled.unwrap()
    );
    assert!(fit.sentence(H).ends_with(&words), "{}", fit.sentence(H));
}

#[test]
fn check_7_2_sharp_combination() {
    let fit = optimum();
    let found = fit.combination(M_S, D_T).unwrap();
    near(-found.factor, 1.0934836, 1e-7);
    near(found.value, 0.0465464512, 1e-7);
    near(found.deviation, 0.00194240122, 1e-6);
    let sentence = fit.sentence(M_S);
    assert!(
        sentence.contains("only in combination with dT, h: M_s + 1.093 dT = 0.0465 +- 0.0038 is determined"),
        "{sentence}"
    );
    assert!(
        fit.sentence(F_MU).contains("1.15 +- 0.11 (95 %)"),
        "{}",
        fit.sentence(F_MU)
    );
}

#[test]
fn check_7_2_joint_region() {
    let fit = optimum();
    let truth = parameters(&TRUTH);
    let u: Vec<f64> = truth.iter().map(|p| p.u).collect();
    // The check measures along the parameters themselves, a step of a logarithm as that of theta over theta: nearer to the
    // exact rise here than along the logarithms.
    let straight: Vec<f64> = (fit.parameters().iter().zip(TRUTH))
        .map(|(p, truth)| match p.scale {
            Scale::Linear => truth,
            Scale::Log => p.u + (truth - p.theta()) / p.theta(),
        })
        .collect();
    near(fit.rise(&straight), 13.6327048, 1e-7);
    // Regression value.
    near(fit.rise(&u), 19.4138910, 1e-7);
    // The exact rise from the sums of squares themselves.
    let all: Vec<usize> = (0..440).collect();
    let there: f64 = super::check_problem::residuals(&u, &all, &super::check_problem::measured())
        .iter()
        .map(|r| r * r)
        .sum();
    near(there - fit.objective(), 12.8248522, 1e-7);
    assert!(there - fit.objective() < fit.joint_limit(0.95).unwrap());
    near(fit.joint_limit(0.95).unwrap(), 15.5073131, 1e-8);
}

#[test]
fn draws_lie_in_the_joint_region_and_scatter_like_the_covariance() {
    let fit = optimum();
    let draws = fit.draws(2000, 0.95).unwrap();
    let limit = fit.joint_limit(0.95).unwrap();
    for u in &draws {
        // A coordinate that is cut at its bound is drawn away from the others and may raise the sum a little.
        let cut = fit.parameters().iter().zip(u).any(|(p, u)| p.bounds.contains(u));
        assert!(cut || fit.rise(u) <= limit * (1.0 + 1e-9));
    }
    let spread = |k: usize| {
        let mean = draws.iter().map(|u| u[k]).sum::<f64>() / 2000.0;
        (draws.iter().map(|u| (u[k] - mean).powi(2)).sum::<f64>() / 2000.0).sqrt() / fit.deviation(k).unwrap()
    };
    // Drawing the outer 5 % in takes a few percent of the spread; an offset meets no bound.
    assert!((0.93..1.0).contains(&spread(F_MU)) && (0.93..1.0).contains(&spread(D_T)));
    assert_eq!(draws[..3], fit.draws(3, 0.95).unwrap());
    assert!(fit.draws(3, 1.0).is_err());
}

#[test]
fn check_7_3_bands() {
    let fit = optimum();
    let at = Point {
        nu: 6.4,
        torque: 10.0,
        speed: 10000.0,
    };
    let values = terms(&OPTIMUM, &at);
    let slopes = gradients(fit.parameters(), 0.0, |theta| Ok(terms(theta, &at).to_vec())).unwrap();
    let expected = [67.7674834, 14.6827144, 13.1190035, 12.6751886, 16.9866365, 25.5504825];
    let deviations = [2.38644777, 2.4243058, 1.35591774, 1.53208714, 14.7006566, 16.3599015];
    for k in 0..TERMS {
        near(values[k], expected[k], 5e-9);
        near(
            fit.derived(values[k], &slopes[k]).deviation.unwrap(),
            deviations[k],
            1e-7,
        );
    }
    let found = fit.breakdown(&values[..5], &slopes[..5]).unwrap();
    near(found.total.value, 125.231026, 5e-9);
    near(found.total.deviation.unwrap(), 16.0312125, 1e-7);
    let shares = [0.541139727, 0.117245022, 0.104758412, 0.101214443, 0.135642396];
    let deviations = [0.0810917606, 0.0168550024, 0.016219582, 0.00750287533, 0.100205298];
    for k in 0..5 {
        near(found.shares[k].value, shares[k], 5e-9);
        near(found.shares[k].deviation.unwrap(), deviations[k], 1e-7);
    }
    // With the correlations dropped.
    let sum: Vec<f64> = (0..8).map(|k| slopes[..5].iter().map(|g| g[k]).sum()).collect();
    let dropped: f64 = (0..8).map(|k| (sum[k] * fit.deviation(k).unwrap()).powi(2)).sum();
    near(dropped.sqrt(), 15.6141373, 1e-7);
    // Less than two deviations above zero: the band of the seal's share stays inside.
    let [low, high] = found.shares[4].share_band(1.96).unwrap();
    assert!(0.0 < low && high < 1.0);
    assert!(fit.breakdown(&values[..5], &slopes[..4]).is_err());
}
