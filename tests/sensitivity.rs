//! What losses depend on: of laws whose slopes and shares are known, and what is refused.

use crate::common;
use crate::common::study::{Ran, number, of_gearbox, run_texts};

use serde_json::Value;

/// Seals only: the loss is a sum over the seals, each proportional to its moment. Needle cages keep models of their own.
const SETS: &str = "model_sets:
  seals:
    gear_mesh: none
    gear_drag: { churning: none }
    bearing: none
    synchronizer: none
    seal: { type: constant, value: 0.1 Nm }
  thin: { extends: seals, seal: { type: formula, formula: \"0.01 * sqrt(7 - nu)\" } }
  turning:
    extends: seals
    seal: { type: formula, formula: \"0.1 + if(abs(speed) > 1000, 0.005 * (nu - 6.4) * (abs(speed) - 5000) / abs(speed), 0)\" }
grids:
  few: { gear: first, torque: [5 Nm, 10 Nm], speed: [2000 rpm, 8000 rpm] }
  bound: { gear: first, torque: 5 Nm, speed: 2000 rpm, bind: { surface.ra: [0.3 um, 0.4 um] } }
";

/// Runs analyses of the two-speed example; their results and what was printed.
fn run(analyses: &str) -> (Ran, String) {
    run_under("oil_temperature: 100 degC", analyses)
}

/// The same under other conditions.
fn run_under(conditions: &str, analyses: &str) -> (Ran, String) {
    let study = format!("conditions: {{ {conditions} }}\n{SETS}analyses:\n{analyses}");
    run_texts(&of_gearbox("examples/two-speed-ev/gearbox.yaml", &study), &[]).with_text()
}

/// An output by its name.
fn output<'v>(result: &'v Value, name: &str) -> &'v Value {
    let all = result["outputs"].as_array().unwrap();
    all.iter().find(|o| o["output"] == name).unwrap()
}

/// Two seals by moments of their own: T1 w1 + T2 w2 is linear in both, so slopes are speeds, effects do not scatter, and the
/// shares of the variance are the squares of slope times range.
#[test]
fn a_sum_has_the_slopes_and_shares_of_its_terms() {
    let (results, text) = run("  what:
    type: sensitivity
    grid: few
    model_sets: [seals]
    parameters:
      - { path: seals.D1.model.value, percent: 10 }
      - { path: seals.D2.model.value, from: 0 Nm, to: 0.6 Nm }
      - { path: lubricants.sump.viscosity.kv100, percent: 20 }
");
    let result = results.json("what")["sensitivities"][0].clone();
    assert_eq!(
        result["runs"],
        serde_json::json!({ "local": 7, "morris": 80, "sobol": 5120 }),
        "{text}"
    );
    let seal = output(&result, "seal");
    // Mean speed of the input, 5000 rpm, and that of the output behind the ratio of first gear.
    let w1 = 5000.0 * common::RPM;
    let slopes: Vec<f64> = seal["local"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| number(&l["slope"]))
        .collect();
    assert!((slopes[0] / w1 - 1.0).abs() < 1e-9, "{slopes:?}");
    assert_eq!(slopes[2], 0.0, "seals of a constant moment do not see the oil");
    let reach = [0.02 * slopes[0], 0.6 * slopes[1]];
    let whole = reach[0] * reach[0] + reach[1] * reach[1];
    let mut alone = 0.0;
    for k in 0..2 {
        let effect = &seal["morris"][k];
        assert!(
            (number(&effect["mu"]) / reach[k] - 1.0).abs() < 1e-9,
            "{effect} {reach:?}"
        );
        assert!(number(&effect["sigma"]) < 1e-9 * reach[k]);
        let first = number(&seal["sobol"]["first"][k]["value"]);
        assert!((first - reach[k] * reach[k] / whole).abs() < 0.01, "{seal}");
        alone += first;
    }
    assert!((alone - 1.0).abs() < 0.01 && seal["sobol"]["interactions"] == false);
    assert_eq!(seal["morris"][2]["mu_star"], 0.0);
    assert_eq!(seal["morris"][2]["influence"], "none");
    assert_eq!(number(&seal["sobol"]["total"][2]["value"]), 0.0);
    // The elasticity of a sum to one of its terms is the term's share.
    let elasticity: f64 = seal["local"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| number(&l["elasticity"]))
        .sum();
    assert!((elasticity - 1.0).abs() < 1e-9);
    // The seals are the loss, but for needle cages; terms are named, and the mean is that of the mechanism.
    let term = result["outputs"]
        .as_array()
        .unwrap()
        .iter()
        .find(|o| o["kind"] == "term" && o["output"].as_str().unwrap().starts_with("seal "));
    assert_eq!(term.unwrap()["mean"], seal["mean"]);
    assert!(number(&output(&result, "loss")["mean"]) >= number(&seal["mean"]));
    assert!(number(&output(&result, "efficiency")["local"][1]["slope"]) < 0.0);
    for picture in ["effects", "morris", "shares"] {
        assert!(results.draws(&format!("what-seals-{picture}")));
    }
    assert!(
        text.contains("depends most on seals.D2.model.value") && text.contains("not influential on the mean loss: "),
        "{text}"
    );
    assert!(text.contains("parameters do not interact"), "{text}");
    let csv = results.csv("what");
    assert!(csv.lines().count() == 1 + 3 * result["outputs"].as_array().unwrap().len());
}

#[test]
fn what_cannot_be_asked_is_reported_with_its_place_and_how_to_fix_it() {
    let kv = "lubricants.sump.viscosity.kv100";
    let one = format!("parameters: [{{ path: {kv}, percent: 5 }}]");
    for (analysis, said) in [
        (
            format!("samples: 1000, {one}"),
            vec![
                "the number of samples must be a power of two, not 1000",
                "write `samples: 1024`",
                "analyses.what.samples",
            ],
        ),
        (
            format!(
                "parameters: [{{ path: {kv}, percent: 5 }}, {{ path: lubricants.sump.viscosity.kv900, percent: 5 }}]"
            ),
            vec!["kv900", "analyses.what.parameters.1"],
        ),
        (
            format!("parameters: [{{ path: {kv}, from: 6 mm2/s, to: 6 mm2/s }}]"),
            vec![
                "two finite ends in ascending order, not 6 mm2/s and 6 mm2/s",
                "give a range with a positive width",
            ],
        ),
        (
            format!("parameters: [{{ path: {kv}, from: 7 mm2/s, to: 9 mm2/s }}]"),
            vec![
                "the value 6.4 mm2/s for `local` is not in 7 mm2/s to 9 mm2/s",
                "methods: [morris, sobol]",
            ],
        ),
        (
            "parameters: [{ path: seals.D1.model.value, percent: 5 }, { path: \"seals.*.model.value\", percent: 5 }]"
                .to_owned(),
            vec!["change the same value"],
        ),
        (
            "parameters: [{ path: thermal.oil, plus_minus: 5 K }]".to_owned(),
            vec!["the conditions fix the temperature"],
        ),
        (
            format!("parameters: [{{ path: {kv}, percent: 5, distribution: normal }}]"),
            vec!["distribution"],
        ),
        (format!("grid: bound, {one}"), vec!["without bound values and envelope"]),
        (format!("methods: [guess], {one}"), vec!["guess", "morris"]),
        // Thicker than 7 mm2/s the law of the seals has no value.
        (
            format!("model_sets: [thin], parameters: [{{ path: {kv}, from: 6 mm2/s, to: 8 mm2/s }}]"),
            vec![
                "no loss at 5 Nm, 2000 rpm: seals.D1",
                "kv100 = ",
                "mm2/s: ",
                "narrow the ranges",
            ],
        ),
    ] {
        let grid = if analysis.contains("grid:") { "" } else { "grid: few, " };
        let sets = if analysis.contains("model_sets:") {
            ""
        } else {
            "model_sets: [seals], "
        };
        let (_, text) = run(&format!("  what: {{ type: sensitivity, {grid}{sets}{analysis} }}\n"));
        for said in said {
            assert!(text.contains(said), "{analysis}: {said}\n{text}");
        }
        assert!(text.contains("help:"), "{text}");
    }
}

/// The same bits on one thread and on two.
#[test]
fn threads_change_nothing() {
    let study = "  what: { type: sensitivity, grid: few, samples: 16, trajectories: 3, parameters: [{ path: lubricants.sump.viscosity.kv100, percent: 20 }, { path: \"gears.*.surface.rq\", percent: 20 }] }\n";
    let all = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (results, text) = pool.install(|| run(study));
        assert!(results.succeeded, "{text}");
        results.csv("what")
    });
    assert_eq!(all[0], all[1]);
}

/// A temperature that the gearbox states is a quantity like others: thicker oil loses more.
#[test]
fn the_temperature_of_the_oil_counts_where_the_gearbox_states_it() {
    let study = "  what: { type: sensitivity, grid: few, methods: [local], parameters: [{ path: thermal.oil, plus_minus: 20 K }] }
  band: { type: uncertainty, grid: few, samples: 8, inputs: [{ path: thermal.oil, plus_minus: 20 K }] }
";
    let (results, text) = run_under("", study);
    let result = results.json("what")["sensitivities"][0].clone();
    assert!(number(&output(&result, "loss")["local"][0]["slope"]) < 0.0, "{text}");
    let loss = results.json("band")["bands"][0]["points"][0]["loss_w"]["band"].clone();
    assert!(number(&loss[2]) > 1.02 * number(&loss[0]), "{loss}");
}

/// Seals whose moment turns about its middle speed with the viscosity: loss moves from low to high speed, and the mean stays.
#[test]
fn what_moves_loss_between_regions_is_seen_at_single_points() {
    let kv = "lubricants.sump.viscosity.kv100";
    let (results, text) = run(&format!(
        "  what:
    type: sensitivity
    grid: few
    model_sets: [turning]
    trajectories: 8
    samples: 64
    parameters: [{{ path: {kv}, percent: 20 }}, {{ path: seals.D1.loss_factor, percent: 20 }}]
"
    ));
    let result = results.json("what")["sensitivities"][0].clone();
    let [loss, points] = ["loss", "relative_loss"].map(|name| output(&result, name));
    assert!(
        loss["morris"][0]["influence"] == "none" && points["morris"][0]["influence"] != "none",
        "{text}"
    );
    // From the values of the gearbox the moment at 2000 rpm changes by a tenth, that at 8000 rpm by a fortieth.
    let total = number(&points["sobol"]["total"][0]["value"]);
    assert!(
        total > 0.05 && number(&loss["sobol"]["total"][0]["value"]) < 0.05,
        "{text}"
    );
    assert!(points["local"].is_null() && number(&points["mean"]) == 0.0 && points["unit"] == "-");
    assert!(
        text.contains(&format!(
            "not influential on the mean loss: {kv}; but influential on the loss at single points"
        )),
        "{text}"
    );
    assert!(
        text.contains(&format!("influential only on the loss at single points: {kv}")),
        "{text}"
    );
}
