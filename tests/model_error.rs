//! Bands that contain the error of the models: they widen by the known error, and an unknown error is named and never zero.

use serde_json::Value;

use crate::common::study::{Ran, run_texts};

const GEARBOX: &str = "gearloss: gearbox/1
title: A bearing and a seal
ports: { input: shaft }
shafts: { shaft: { axis: [0 mm, 0 mm], loads: [{ at: 0 mm, force: [0 N, 2000 N, 0 N] }] } }
bearings: { B: { shaft: shaft, at: 0 mm, designation: \"6208\", takes_moment: true } }
seals: { S: { shaft: shaft, diameter: 40 mm } }
lubricants: { oil: { viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s } } }
thermal: { mode: fixed, oil: 60 degC }
models: { bearing: { type: iso14179_2 }, seal: { type: linke } }
";

const HEAD: &str = "mechanism,model,nested,part,set,kind,seen,ratio,least,greatest,in_range,error,scatter\n";

/// Cells of so many sets of ball bearings: the law gives `ratio` times the measured loss, more or less by `spread`.
fn cells(sets: usize, ratio: f64, spread: f64) -> String {
    let line = |i: usize| {
        let log = spread * (i as f64 / (sets - 1) as f64 - 0.5);
        let ratio = ratio * log.exp();
        format!("bearing,iso14179_2,,deep_groove_ball,s{i},measured,no,{ratio},{ratio},{ratio},1,0.01,0.01\n")
    };
    format!("{HEAD}{}", (0..sets).map(line).collect::<String>())
}

fn run(analysis: &str, cells: &str) -> Ran {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ bearing: gearbox.yaml }}
model_sets: {{ harris: {{ bearing: {{ type: harris }} }} }}
grids: {{ speeds: {{ torque: 0 Nm, speed: [1000 rpm, 3000 rpm] }} }}
analyses: {{ it: {analysis} }}
"
    );
    run_texts(&study, &[("gearbox.yaml", GEARBOX), ("cells.csv", cells)])
}

const INPUTS: &str = "inputs: [{ path: lubricants.oil.viscosity.factor, from: 0.9, to: 1.1 }]";
const OWN: &str = "model_error: { cells: [cells.csv], corpus: false }";

fn uncertainty(more: &str, cells: &str) -> Ran {
    run(
        &format!("{{ type: uncertainty, grid: speeds, samples: 1024, {more} }}"),
        cells,
    )
}

/// Loss at the first point: nominal, and its band.
fn loss(ran: &Ran) -> (f64, Vec<f64>) {
    let loss = ran.json("it")["bands"][0]["points"][0]["loss_w"].clone();
    let band = loss["band"].as_array().unwrap_or_else(|| panic!("{loss}"));
    (
        loss["nominal"].as_f64().unwrap(),
        band.iter().map(|x| x.as_f64().unwrap()).collect(),
    )
}

fn law(ran: &Ran, mechanism: &str) -> Value {
    let all = ran.json("it")["model_error"][0]["laws"].clone();
    let found = all.as_array().unwrap().iter().find(|law| law["mechanism"] == mechanism);
    found.unwrap_or_else(|| panic!("{all:#}")).clone()
}

#[test]
fn bands_widen_by_the_error_of_the_models() {
    let cells = cells(4, 1.0, 0.6);
    let width = |ran: &Ran| {
        assert!(ran.succeeded, "{}", ran.text);
        let (_, band) = loss(ran);
        band[2] - band[0]
    };
    let inputs = uncertainty(INPUTS, &cells);
    let both = uncertainty(&format!("{INPUTS}, {OWN}"), &cells);
    let alone = uncertainty(OWN, &cells);
    assert!(
        width(&both) > 3.0 * width(&inputs),
        "{} {}",
        width(&both),
        width(&inputs)
    );
    // The bearing has the factor, the seal has none: the band of the sum is that of the bearing.
    let of_bearing = law(&alone, "bearing");
    let factor: Vec<f64> = of_bearing["factor"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    let (nominal, band) = loss(&alone);
    let share = |k: usize| (band[k] / nominal - 1.0) / (factor[k] - 1.0);
    // The quantiles of the samples are near those of the distribution.
    assert!((share(0) / share(2) - 1.0).abs() < 0.1, "{} {}", share(0), share(2));
    assert!(of_bearing["share_of_loss"].as_f64().unwrap() < 1.0);
    // Four sets: each is predicted by three others.
    assert_eq!(of_bearing["left_out"]["sets"], 4, "{of_bearing:#}");
}

#[test]
fn an_unknown_error_is_named_and_never_zero() {
    for (count, state) in [(0, "no_set"), (2, "too_few_sets"), (4, "known")] {
        let cells = if count == 0 {
            HEAD.to_owned()
        } else {
            cells(count, 1.2, 0.2)
        };
        let ran = uncertainty(&format!("{INPUTS}, {OWN}"), &cells);
        assert!(ran.succeeded, "{}", ran.text);
        let bearing = law(&ran, "bearing");
        assert_eq!(
            (bearing["state"].as_str(), bearing["sets"].as_array().map(Vec::len)),
            (Some(state), Some(count))
        );
        assert_eq!(bearing["factor"].is_null(), count < 3, "{bearing:#}");
        let seal = law(&ran, "seal");
        assert!(
            seal["state"] == "no_set" && seal["factor"].is_null() && seal["share_of_loss"].as_f64() > Some(0.0),
            "{seal:#}"
        );
        assert!(
            ran.text.contains("unknown") && ran.text.contains("no measured set"),
            "{}",
            ran.text
        );
    }
    // Nothing at all is uncertain.
    let nothing = uncertainty(OWN, HEAD);
    assert!(
        !nothing.succeeded && nothing.text.contains("E0608") && nothing.text.contains("nothing is uncertain"),
        "{}",
        nothing.text
    );
}

#[test]
fn a_law_that_was_adjusted_or_gave_its_constants_to_a_set_is_not_judged() {
    let cells = cells(4, 1.2, 0.2);
    let gearbox = GEARBOX.replace("takes_moment: true", "takes_moment: true, loss_factor: 0.8");
    let study = format!(
        "gearloss: study/1\ngearboxes: {{ bearing: gearbox.yaml }}\ngrids: {{ speeds: {{ torque: 0 Nm, speed: [1000 rpm] }} }}\n\
         analyses: {{ it: {{ type: uncertainty, grid: speeds, samples: 16, {INPUTS}, {OWN} }} }}\n"
    );
    let ran = run_texts(&study, &[("gearbox.yaml", &gearbox), ("cells.csv", &cells)]);
    assert_eq!(law(&ran, "bearing")["state"], "loss_factor_stated", "{}", ran.text);
    let seen = cells.replace("measured,no", "measured,yes");
    let ran = uncertainty(&format!("{INPUTS}, {OWN}"), &seen);
    let bearing = law(&ran, "bearing");
    assert!(
        bearing["state"] == "no_set" && bearing["seen"].as_array().map(Vec::len) == Some(4),
        "{bearing:#}"
    );
    assert!(ran.text.contains("derived from s0"), "{}", ran.text);
}

#[test]
fn the_corpus_of_the_program_judges_tapered_roller_bearings() {
    let gearbox = GEARBOX.replace(
        "\"6208\", takes_moment: true",
        "\"32216\", takes_moment: true, induced_thrust: 0",
    );
    let gearbox = gearbox
        .replace("type: iso14179_2", "type: skf")
        .replace("force: [0 N, 2000 N, 0 N]", "force: [6000 N, 0 N, 0 N]");
    let study = "gearloss: study/1\ngearboxes: { bearing: gearbox.yaml }\ngrids: { speeds: { torque: 0 Nm, speed: [1000 rpm] } }\n\
                 analyses: { it: { type: uncertainty, grid: speeds, samples: 16, model_error: corpus } }\n";
    let ran = run_texts(study, &[("gearbox.yaml", &gearbox)]);
    assert!(ran.succeeded, "{}", ran.text);
    let bearing = law(&ran, "bearing");
    assert!(
        bearing["state"] == "known" && bearing["kind"] == "tapered_roller",
        "{bearing:#}"
    );
    assert_eq!(bearing["sets"].as_array().map(Vec::len), Some(5), "{bearing:#}");
}

#[test]
fn a_faulty_table_of_cells_is_refused_with_its_line() {
    let ran = uncertainty(OWN, "mechanism,model\nbearing,skf\n");
    assert!(
        ran.text.contains("E0607") && ran.text.contains("line 1: there is no column `nested`"),
        "{}",
        ran.text
    );
    let ran = uncertainty("model_error: { cells: [none.csv] }", HEAD);
    assert!(
        ran.text.contains("E0607") && ran.text.contains("none.csv"),
        "{}",
        ran.text
    );
    let ran = uncertainty(
        &format!("inputs: [{{ path: bearings.B.loss_factor, from: 0.9, to: 1.1 }}], {OWN}"),
        &cells(4, 1.0, 0.2),
    );
    assert!(ran.text.contains("change the same value"), "{}", ran.text);
}

#[test]
fn the_error_of_a_common_law_cancels_in_a_difference() {
    let cells = cells(4, 1.0, 0.6);
    let compared = |with: &str| {
        let ran = run(
            &format!("{{ type: compare, grid: speeds, quantity: loss, base: own, {with}, {OWN} }}"),
            &cells,
        );
        assert!(ran.succeeded, "{}", ran.text);
        ran.json("it")["comparisons"][0].clone()
    };
    let band = |c: &Value| -> Vec<f64> {
        let band = c["loss_difference_band_w"]
            .as_array()
            .unwrap_or_else(|| panic!("{c:#}"));
        band.iter().map(|x| x.as_f64().unwrap()).collect()
    };
    // Half the viscosity lowers the loss by the same law: whatever its factor, the difference is negative.
    let thin = band(&compared(
        "variants: { thin: { lubricants.oil.viscosity.factor: 0.5 } }",
    ));
    assert!(thin[0] < thin[2] && thin[2] < 0.0, "{thin:?}");
    // Another law has an error of its own, here unknown: that of the base alone decides the sign.
    let harris = band(&compared("against: [harris]"));
    assert!(harris[0] < 0.0 && harris[2] > 0.0, "{harris:?}");
    let without = run(
        "{ type: compare, grid: speeds, quantity: loss, base: own, against: [harris], samples: 16 }",
        &cells,
    );
    assert!(
        without.text.contains("`samples` belongs to `model_error`"),
        "{}",
        without.text
    );
}

#[test]
fn the_band_of_a_tournament_contains_the_error_of_its_models() {
    let tournament = |more: &str| {
        let ran = run(
            &format!(
                "{{ type: tournament, grid: speeds, quantity: loss, mechanisms: [{{ mechanism: bearing, models: {{ iso: {{ type: iso14179_2 }}, h: {{ type: harris }} }} }}], {more} }}"
            ),
            &cells(4, 1.0, 0.6),
        );
        assert!(ran.succeeded, "{}", ran.text);
        ran
    };
    let ran = tournament(OWN);
    let point = ran.json("it")["tournament"]["points"][0].clone();
    let band: Vec<f64> = point["band_w"]
        .as_array()
        .unwrap_or_else(|| panic!("{point:#}"))
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    let number = |key: &str| point[key].as_f64().unwrap();
    assert!(
        band[2] > number("greatest_loss_w") || band[0] < number("least_loss_w"),
        "{point:#}"
    );
    assert!(tournament("shown: 10").json("it")["tournament"]["points"][0]["band_w"].is_null());
}
