//! What a comparison of models decides, against a truth that is known: synthetic measurements of two gearboxes at four noise levels,
//! with and without errors of the rig that all points share. The rates that it finds are in docs/inference.md.
#![allow(clippy::print_stdout, reason = "the documentation quotes the rates")]

use crate::common::{RPM, file, language, random_bits};
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_numerics::inference::{Decision, PointSet, folds};
use gearloss_numerics::sampling::inverse_normal;
use gearloss_numerics::selection::{Combination, Losses, MeasuredLosses, compare_pair, rank, validate, winner};
use gearloss_studies::points::{Field, OilTemperature, Points, run_grid};
use serde_json::{Value, json};

/// Numbers that are the same every time.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        ((random_bits(&mut self.0) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        inverse_normal(self.uniform()).unwrap()
    }
}

/// Losses of the candidates of two mechanisms at the points of a gearbox; the first of each is the truth.
struct Bench {
    torques: Vec<f64>,
    speeds: Vec<f64>,
    /// Power at the port of the torque, and speed of the input. \[W\], \[rad/s\]
    powers: Vec<f64>,
    inputs: Vec<f64>,
    rest: Vec<f64>,
    mechanisms: Vec<Vec<Vec<f64>>>,
}

impl Bench {
    fn losses(&self) -> Losses<'_> {
        Losses {
            rest: &self.rest,
            mechanisms: (self.mechanisms.iter())
                .map(|models| models.iter().map(Vec::as_slice).collect())
                .collect(),
        }
    }
}

struct Setting<'a> {
    gearbox: &'a str,
    gear: &'a str,
    torque_at: &'a str,
    torques: Vec<f64>,
    speeds: Vec<f64>,
    oil: f64,
    mechanisms: [(&'a str, &'a str, Vec<Value>); 2],
}

fn bench(language: &Language, setting: &Setting<'_>) -> Bench {
    let gearbox = Gearbox::read(language, &file(setting.gearbox)).unwrap();
    let mut bench: Option<Bench> = None;
    let mut mechanisms = vec![Vec::new(), Vec::new()];
    for (k, (mechanism, path, models)) in setting.mechanisms.iter().enumerate() {
        for model in models {
            let mut choice = Choice::default();
            for (_, path, models) in &setting.mechanisms {
                choice = choice.with(*path, models[0].clone());
            }
            let choice = choice.with(*path, model.clone());
            let transmission = gearbox
                .transmission(language, &choice)
                .unwrap_or_else(|f| panic!("{}", f.render()));
            let points = Points {
                gear: setting.gear.to_owned(),
                torque_at: vec![setting.torque_at.to_owned()],
                speed_at: vec!["input".to_owned()],
                field: Field::Grid {
                    torques: setting.torques.clone(),
                    speeds: setting.speeds.iter().map(|n| n * RPM).collect(),
                },
                oil: OilTemperature::Fixed(setting.oil),
                flow: PowerFlow::Real,
                terms: false,
            };
            let solved = run_grid(&transmission, &points, &|_| true).unwrap().unwrap();
            let of = |is_counted: &dyn Fn(&str) -> bool| -> Vec<f64> {
                let sum = |p: &gearloss_studies::points::PointResult| {
                    assert!(p.loss.is_some(), "{model} has no loss at {} Nm", p.torque);
                    let parts = transmission.parts().iter().zip(&p.parts);
                    parts
                        .filter(|(part, _)| is_counted(part.mechanism))
                        .map(|(_, w)| w)
                        .sum()
                };
                solved.points.iter().map(sum).collect()
            };
            mechanisms[k].push(of(&|mechanism_of_part| mechanism_of_part == *mechanism));
            bench.get_or_insert_with(|| Bench {
                torques: solved.points.iter().map(|p| p.torque).collect(),
                speeds: solved.points.iter().map(|p| p.speed).collect(),
                powers: solved
                    .points
                    .iter()
                    .map(|p| (p.torque * p.torque_speed).abs())
                    .collect(),
                inputs: solved.points.iter().map(|p| p.reference_speed.abs()).collect(),
                rest: of(&|mechanism_of_part| {
                    setting
                        .mechanisms
                        .iter()
                        .all(|(mechanism, ..)| mechanism_of_part != *mechanism)
                }),
                mechanisms: Vec::new(),
            });
        }
    }
    Bench {
        mechanisms,
        ..bench.unwrap()
    }
}

fn benches(language: &Language) -> [Bench; 2] {
    let friction = |name: &str| json!({ "type": "path_integral", "tooth_friction": { "type": name } });
    [
        bench(
            language,
            &Setting {
                gearbox: "examples/two-speed-ev/gearbox.yaml",
                gear: "first",
                torque_at: "input",
                torques: vec![4.0, 8.0, 12.0, 16.0, 20.0],
                speeds: (1..=8).map(|k| 2500.0 * f64::from(k)).collect(),
                oil: 100.0,
                mechanisms: [
                    (
                        "gear_mesh",
                        "meshes.*.model",
                        vec![
                            friction("xu"),
                            json!({ "type": "iso14179_2" }),
                            json!({ "type": "anderson_loewenthal" }),
                            friction("benedict_kelley"),
                            friction("misharin"),
                        ],
                    ),
                    (
                        "bearing",
                        "bearings.*.model",
                        vec![
                            json!({ "type": "skf", "needle_as_full_complement": true }),
                            json!({ "type": "iso14179_2" }),
                        ],
                    ),
                ],
            },
        ),
        bench(
            language,
            &Setting {
                gearbox: "examples/planetary-reducer/gearbox.yaml",
                gear: "reducing",
                torque_at: "output",
                torques: vec![-10.0, -30.0, -50.0, -70.0, -90.0],
                speeds: (1..=8).map(|k| 500.0 * f64::from(k)).collect(),
                oil: 60.0,
                mechanisms: [
                    (
                        "gear_mesh",
                        "meshes.*.model",
                        vec![
                            json!({ "type": "iso14179_2" }),
                            friction("benedict_kelley"),
                            friction("misharin"),
                            friction("drozdov_gavrikov"),
                        ],
                    ),
                    (
                        "seal",
                        "seals.*.model",
                        vec![
                            json!({ "type": "niemann_winter", "lambda_l": 7.69e-3 }),
                            json!({ "type": "iso14179_2" }),
                            json!({ "type": "linke" }),
                        ],
                    ),
                ],
            },
        ),
    ]
}

/// Points of a bench with these losses, each with an accuracy.
fn measured(bench: &Bench, losses: Vec<f64>, deviations: Vec<f64>) -> MeasuredLosses {
    let count = losses.len();
    MeasuredLosses {
        weights: vec![1.0; count],
        units: vec![Some(1.0); count],
        folds: folds(&bench.torques, 5)
            .unwrap()
            .into_iter()
            .map(|fold| fold.points)
            .collect(),
        points: PointSet::default(),
        losses,
        deviations,
    }
    .with_conditions(&bench.torques, &bench.speeds, &vec![0.0; bench.torques.len()])
}

fn rms(list: &[f64]) -> f64 {
    (list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64).sqrt()
}

/// How often decisions are wrong, and how often nothing is decided where the truth is clear.
#[derive(Default)]
struct Rates {
    pairs: usize,
    decided: usize,
    wrong: usize,
    /// The same where the folds alone decide, whatever the set of points can see.
    decided_by_folds: usize,
    wrong_by_folds: usize,
    clear: usize,
    undecided_though_clear: usize,
    /// Truth against another model that is clearly apart from it.
    clear_of_truth: usize,
    undecided_of_truth: usize,
    sets: usize,
    wrong_winners: usize,
}

impl Rates {
    fn words(&self) -> String {
        let percent = |a: usize, b: usize| 100.0 * a as f64 / b.max(1) as f64;
        format!(
            "{} sets, {} pairs: decided {:.1} %, wrongly {:.2} % of the decided ({:.2} % by folds alone); of {} clear ones not decided {:.1} %; of {} clear ones with the \
             true combination {:.1} %; another winner decidedly better than the truth in {} sets",
            self.sets,
            self.pairs,
            percent(self.decided, self.pairs),
            percent(self.wrong, self.decided),
            percent(self.wrong_by_folds, self.decided_by_folds),
            self.clear,
            percent(self.undecided_though_clear, self.clear),
            self.clear_of_truth,
            percent(self.undecided_of_truth, self.clear_of_truth),
            self.wrong_winners
        )
    }
}

#[test]
fn decisions_are_rarely_wrong() {
    let language = language();
    let benches = benches(&language);
    let mut random = Random(28);
    // Nothing fitted and one factor for each mechanism, without and with errors that all points share.
    let mut rates: [[Rates; 3]; 2] = Default::default();
    for number in 0..200 {
        let bench = &benches[number % 2];
        let noise = [0.005, 0.01, 0.02, 0.04][(number / 2) % 4];
        let kind = (number / 8) % 3;
        let losses = bench.losses();
        let truth = losses.of_combination(&[0, 0], &[1.0, 1.0]);
        let floor = 0.01 * rms(&truth);
        // A gain and an offset of the rig, which the accuracy holds beside the noise, as that of an instrument does.
        let [gain, offset] = [noise, floor].map(|x| [0.0, 1.0, 3.0][kind] * x);
        let [drawn_gain, drawn_offset] = [gain * random.normal(), offset * random.normal()];
        let mut seen = |loss: &f64| {
            let scatter = (noise * loss).hypot(floor) * random.normal();
            loss * (1.0 + drawn_gain) + drawn_offset + scatter
        };
        let points: Vec<f64> = truth.iter().map(&mut seen).collect();
        let deviation = |loss: &f64| (noise * loss).hypot(floor).hypot(gain * loss).hypot(offset);
        let measured = measured(bench, points, truth.iter().map(deviation).collect());
        for (k, bounds) in [None, Some([0.5, 2.0])].into_iter().enumerate() {
            let rates = &mut rates[k][kind];
            let ranked = rank(&losses, &measured, bounds, &|| true);
            let found = winner(&ranked, &|_| false, &losses, &measured, None).unwrap();
            // What each predicts of the truth, fitted to points without any error.
            let exact = MeasuredLosses {
                losses: truth.clone(),
                ..measured.clone()
            };
            let of_truth = |c: &Combination| validate(&losses, &exact, bounds, c.places.clone()).unwrap();
            let fitted: Vec<Combination> = ranked.iter().map(of_truth).collect();
            let errors: Vec<f64> = fitted.iter().map(|c| c.predicted).collect();
            let predictions: Vec<Vec<f64>> = fitted
                .iter()
                .map(|c| losses.of_combination(&c.places, &c.factors))
                .collect();
            let is_true = |c: &Combination| c.places == [0, 0];
            rates.sets += 1;
            let of_truth = ranked.iter().position(is_true).unwrap();
            rates.wrong_winners +=
                usize::from(found.standings[of_truth].decision == Decision::Better && of_truth != found.place);
            for a in 0..ranked.len() {
                for b in a + 1..ranked.len() {
                    let standing = compare_pair([&ranked[a], &ranked[b]], &losses, &measured, &found.errors);
                    let is_wrong = |decision: Decision| match decision {
                        Decision::Better => errors[a] > errors[b] || is_true(&ranked[b]),
                        Decision::Worse => errors[a] < errors[b] || is_true(&ranked[a]),
                        Decision::NotDecided => false,
                    };
                    let by_folds = standing.folds.unwrap().decision();
                    let apart = measured.differences(&predictions[a], &predictions[b]);
                    // Clear: predictions two accuracies apart, and the errors of one twice those of the other.
                    let is_clear = rms(&apart) > 2.0 && (errors[a] / errors[b]).ln().abs() > 2.0_f64.ln();
                    let with_truth = is_true(&ranked[a]) || is_true(&ranked[b]);
                    let is_open = standing.decision == Decision::NotDecided;
                    rates.pairs += 1;
                    rates.decided += usize::from(!is_open);
                    rates.wrong += usize::from(is_wrong(standing.decision));
                    rates.decided_by_folds += usize::from(by_folds != Decision::NotDecided);
                    rates.wrong_by_folds += usize::from(is_wrong(by_folds));
                    rates.clear += usize::from(is_clear);
                    rates.undecided_though_clear += usize::from(is_clear && is_open);
                    rates.clear_of_truth += usize::from(is_clear && with_truth);
                    rates.undecided_of_truth += usize::from(is_clear && with_truth && is_open);
                }
            }
        }
    }
    for (k, fitted) in ["nothing fitted", "factors fitted"].into_iter().enumerate() {
        for (kind, words) in [
            "noise alone",
            "errors in common as large",
            "errors in common three times as large",
        ]
        .into_iter()
        .enumerate()
        {
            println!("{fitted}, {words}: {}", rates[k][kind].words());
        }
    }
    for rates in rates.iter().flatten() {
        // The truth is called worse than another combination in one set of twenty at most, and so is any wrong decision.
        assert!(
            20 * rates.wrong <= rates.decided && 20 * rates.wrong_winners <= rates.sets,
            "{}",
            rates.words()
        );
        assert!(5 * rates.undecided_though_clear <= rates.clear, "{}", rates.words());
    }
}

/// Loss, loss torque and efficiency are one measurement, whichever of them is written down.
#[test]
fn the_order_is_the_same_for_every_quantity() {
    let language = language();
    let bench = &benches(&language)[0];
    let losses = bench.losses();
    let truth = losses.of_combination(&[1, 1], &[1.0, 1.0]);
    let mut random = Random(5);
    for _ in 0..5 {
        let points: Vec<f64> = truth.iter().map(|x| x * (1.0 + 0.05 * random.normal())).collect();
        let deviations: Vec<f64> = truth.iter().map(|x| (0.05 * x).hypot(2.0)).collect();
        let order = |units: Vec<Option<f64>>| {
            let measured = MeasuredLosses {
                units,
                ..measured(bench, points.clone(), deviations.clone())
            };
            let ranked = rank(&losses, &measured, Some([0.5, 2.0]), &|| true);
            ranked.into_iter().map(|c| (c.places, c.predicted)).collect::<Vec<_>>()
        };
        let of_loss = order(vec![Some(1.0); points.len()]);
        assert_eq!(of_loss, order(bench.inputs.iter().map(|w| Some(1.0 / w)).collect()));
        assert_eq!(of_loss, order(bench.powers.iter().map(|p| Some(100.0 / p)).collect()));
    }
}
