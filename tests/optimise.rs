//! The search for the best design: the optimum of a grid, limits, shares, and a file that runs.

use std::path::Path;

use gearloss::api::{InMemory, Language, Outcome, StudyRun, analyses::optimise::OptimiseOutcome, read_study};

use crate::common::file;

const HEAD: &str = "
gearloss: study/1
gearboxes: { ev: gearbox.yaml }
conditions: { oil_temperature: 60 degC }
cycles:
  loads: { spectrum: [{ torque: 12 Nm, speed: 6000 rpm, share: 0.6 }, { torque: 3 Nm, speed: 12000 rpm, share: 0.4 }] }
  heavy: { spectrum: [{ torque: 20 Nm, speed: 2000 rpm, share: 1 }] }
analyses:
";

/// The outcome of the first analysis of a study of the two-speed gearbox.
fn optimised(analysis: &str) -> Result<Box<dyn Outcome>, String> {
    let language = Language::linked().unwrap();
    let gearbox = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let study = format!("{HEAD}{analysis}");
    let files = InMemory::new([("study.yaml", study), ("gearbox.yaml", gearbox)]).shared();
    let study = read_study(&language, &files, "study.yaml").map_err(|e| e.render())?;
    let outcome = StudyRun::new(&language, &study).analysis("best");
    outcome.map_err(|stopped| stopped.findings().iter().map(gearloss::api::Findings::render).collect())
}

fn search(analysis: &str) -> OptimiseOutcome {
    let outcome = optimised(analysis).unwrap();
    outcome.get::<OptimiseOutcome>().unwrap().clone()
}

const VARIABLES: &str = "
    variables:
      viscosity: { path: lubricants.sump.viscosity.factor, from: 0.3, to: 3, scale: log }
      bearing: { path: bearings.B5.designation, values: [\"6010\", \"6210\", \"16010\"] }";

fn common(more: &str) -> String {
    format!("  best:\n    type: optimise\n    gear: first\n    model_sets: [joint]\n{more}\n")
}

/// The least loss of a full grid is not less than that of the search, and the optimum is in the same cell.
#[test]
fn an_exhaustive_grid_has_the_same_optimum() {
    let found = search(&common(&format!("    cycles: [loads]{VARIABLES}\n    designs: 150")));
    let steps = 60;
    let grid: Vec<String> = (0..=steps)
        .map(|i| format!("{}", 0.3 * 10_f64.powf(f64::from(i) / f64::from(steps))))
        .collect();
    let all = search(&common(&format!(
        "    cycles: [loads]
    variables:
      viscosity: {{ path: lubricants.sump.viscosity.factor, values: [{}] }}
      bearing: {{ path: bearings.B5.designation, values: [\"6010\", \"6210\", \"16010\"] }}
    designs: 400",
        grid.join(", ")
    )));
    assert!(all.exhaustive && all.designs == 183 && !found.exhaustive && found.designs <= 150);
    let [search, grid] = [&found, &all].map(|outcome| outcome.gains[0].best_w.unwrap());
    assert!(search <= grid * (1.0 + 1e-6), "{search} {grid}");
    assert!(search > grid * (1.0 - 1e-3), "{search} {grid}");
    assert_eq!(found.variables[1].best, all.variables[1].best);
    let [search, grid] =
        [&found, &all].map(|outcome| outcome.variables[0].best.as_ref().unwrap().parse::<f64>().unwrap());
    assert!(
        (search / grid).ln().abs() < 10_f64.ln() / f64::from(steps),
        "{search} {grid}"
    );
}

#[test]
fn shares_add_up_to_the_gain_and_a_single_change_is_its_own() {
    let found = search(&common(&format!("    cycles: [loads]{VARIABLES}\n    designs: 60")));
    let gain = found.gains[0].present_w - found.gains[0].best_w.unwrap();
    let shares: f64 = found
        .changes
        .iter()
        .map(|change| change.share_w.as_ref().unwrap()[0])
        .sum();
    // A number that is changed by less than a thousandth of its range is not a change.
    assert!((shares - gain).abs() < 1e-3 * gain.abs().max(1.0), "{shares} {gain}");
    let single = search(&common(
        "    cycles: [loads]\n    variables: { bearing: { path: bearings.B5.designation, values: [\"6010\", \"6210\", \"16010\"] } }",
    ));
    for change in &single.changes {
        assert_eq!(change.alone_w, change.share_w);
    }
}

#[test]
fn a_limit_is_kept_and_costs_something() {
    let free = search(&common(&format!(
        "    cycles: [loads, heavy]\n    minimise: [loads]{VARIABLES}\n    designs: 80"
    )));
    let heavy = free.gains.iter().find(|gain| gain.cycle == "heavy").unwrap();
    assert!(!heavy.minimised);
    // Both cycles prefer the same oil; a least loss of the other one keeps the search from it.
    let bound = 0.5 * (heavy.best_w.unwrap() + heavy.present_w);
    let limited = search(&common(&format!(
        "    cycles: [loads, heavy]\n    minimise: [loads]{VARIABLES}\n    designs: 80\n    limits: {{ other: {{ quantity: mean_loss, of: heavy, least: {bound} W }} }}"
    )));
    let kept = limited.limits[0].best.unwrap();
    assert!(kept >= bound && limited.limits[0].binding, "{kept} {bound}");
    assert!(limited.gains[0].best_w.unwrap() > free.gains[0].best_w.unwrap());
    let none = search(&common(&format!(
        "    cycles: [loads]{VARIABLES}\n    designs: 32\n    limits: {{ never: {{ quantity: mean_loss, most: 0.001 W }} }}"
    )));
    assert!(none.gains[0].best_w.is_none() && none.front.is_empty() && none.changes.is_empty());
    assert_eq!((none.feasible, none.failed), (0, 0));
}

/// A life that only a heavier bearing reaches costs losses.
#[test]
fn a_life_limits_the_choice_of_a_bearing() {
    let variables = "    cycles: [loads]
    variables: { bearing: { path: bearings.B5.designation, values: [\"16010\", \"6010\", \"6210\", \"6310\"] } }
    limits: { life: { quantity: rating, rating: iso_281.L10h, of: bearings.B5, least: LEAST h } }";
    let life = |least: &str| search(&common(&variables.replace("LEAST", least)));
    let free = life("0.001");
    let lives: Vec<f64> = free.all.iter().map(|design| design.limited[0]).collect();
    assert!(
        free.exhaustive && lives.windows(2).all(|pair| pair[0] < pair[1]),
        "{lives:?}"
    );
    let least = 0.5 * (lives[2] + lives[3]);
    let long = life(&least.to_string());
    assert_eq!((long.feasible, long.variables[0].best.as_deref()), (1, Some("6310")));
    assert!(long.limits[0].best.unwrap() > least);
    assert!(long.gains[0].best_w.unwrap() > free.gains[0].best_w.unwrap());
}

#[test]
fn the_example_is_right() {
    let language = Language::linked().unwrap();
    let files = gearloss::api::Disk::shared();
    let study = file("examples/best-design/study.yaml");
    assert!(read_study(&language, &files, study).is_ok());
}

#[test]
fn two_cycles_have_a_front() {
    let found = search(&common(&format!(
        "    cycles: [loads, heavy]{VARIABLES}\n    designs: 120"
    )));
    let losses: Vec<&Vec<f64>> = found
        .front
        .iter()
        .map(|design| design.mean_losses_w.as_ref().unwrap())
        .collect();
    for pair in losses.windows(2) {
        assert!(pair[0][0] < pair[1][0] && pair[0][1] > pair[1][1], "{pair:?}");
    }
    for cycle in 0..2 {
        let least = losses.iter().map(|design| design[cycle]).fold(f64::INFINITY, f64::min);
        assert_eq!(Some(least), found.gains[cycle].least_w);
    }
}

#[test]
fn a_gain_has_a_band_under_uncertain_inputs() {
    let found = search(&common(&format!(
        "    cycles: [loads]{VARIABLES}\n    designs: 48\n    inputs: [{{ path: \"gears.*.surface.rq\", percent: 20 }}]\n    samples: 16"
    )));
    let band = found.gains[0].band.unwrap();
    let gain = found.gains[0].present_w - found.gains[0].best_w.unwrap();
    let [low, middle, high] = band.gain_w.unwrap();
    assert!(low <= middle && middle <= high && band.samples == 16);
    assert!(low <= gain && gain <= high, "{low} {gain} {high}");
    assert!(!band.contains_zero);
    assert!(found.changes.iter().all(|change| change.bands.len() == 1));
}

/// The file of the best design is a gearbox with its loss.
#[test]
fn the_best_design_is_a_gearbox_that_runs() {
    let language = Language::linked().unwrap();
    let outcome = optimised(&common(&format!("    cycles: [loads]{VARIABLES}\n    designs: 40"))).unwrap();
    let optimised = outcome.get::<OptimiseOutcome>().unwrap();
    let files = outcome.files();
    assert_eq!(files[0].name, "best-best.yaml");
    let gearbox = std::fs::read_to_string(file("examples/two-speed-ev/gearbox.yaml")).unwrap();
    let study = format!(
        "{}  check: {{ type: cycle, gear: first, model_sets: [joint], cycles: [loads] }}\n",
        HEAD.replace("gearbox.yaml", "best.yaml")
    );
    let source = InMemory::new([
        (Path::new("study.yaml"), study),
        (Path::new("gearbox.yaml"), gearbox),
        (Path::new("best.yaml"), files[0].text.clone()),
    ]);
    let study = read_study(&language, &source.shared(), "study.yaml")
        .map_err(|e| e.render())
        .unwrap();
    let check = StudyRun::new(&language, &study).analysis("check").unwrap();
    let check = check.get::<gearloss::api::analyses::cycle::CycleOutcome>().unwrap();
    assert_eq!(Some(check.cycles[0].mean_loss_w), optimised.gains[0].best_w);
}

#[test]
fn designations_come_from_the_catalogue() {
    let found = search(&common(
        "    cycles: [loads]\n    variables: { bearing: { path: bearings.B5.designation, catalogue: { kind: deep_groove_ball, bore: 50 mm } } }",
    ));
    assert!(found.exhaustive, "{found:?}");
    let all: Vec<&str> = found.all.iter().map(|design| design.values[0].as_str()).collect();
    assert!(
        all.contains(&"6010") && all.contains(&"16010") && all.len() >= 5,
        "{all:?}"
    );
    let words = optimised(&common(
        "    cycles: [loads]\n    variables: { bearing: { path: bearings.B5.designation, catalogue: { bore: 51 mm } } }",
    ));
    let words = words.map(|_| ()).unwrap_err();
    assert!(
        words.contains("no designation has `bore: 51 mm`") && words.contains("catalogue.bore"),
        "{words}"
    );
}

#[test]
fn wrong_entries_are_reported() {
    let variables = "    cycles: [loads]\n    variables: ";
    for (analysis, said) in [
        (
            format!("{variables}{{ x: {{ path: bearings.B5.designation, values: [\"6010\"] }} }}"),
            "only one value",
        ),
        (
            format!("{variables}{{ x: {{ path: bearings.B5.designation, values: [\"6010\", \"60100\"] }} }}"),
            "60100",
        ),
        (
            format!("{variables}{{ x: {{ path: housing.oil.level_offset, from: -1 mm, to: 1 mm, scale: log }} }}"),
            "logarithmic scale needs positive ends",
        ),
        (
            format!(
                "{variables}{{ x: {{ path: housing.oil.level_offset, from: -1 mm, to: 1 mm, values: [1 mm, 2 mm] }} }}"
            ),
            "either `values` or a range",
        ),
        (
            format!("{variables}{{ x: {{ path: lubricants.oil.viscosity.factor, from: 1, to: 2 }} }}"),
            "`lubricants` has no `oil`",
        ),
        (
            format!("    minimise: [heavy]\n    cycles: [loads]{VARIABLES}"),
            "no cycle of this analysis is called `heavy`",
        ),
        (
            format!(
                "    cycles: [loads]{VARIABLES}\n    limits: {{ hot: {{ quantity: temperature, of: casing, most: 90 degC }} }}"
            ),
            "casing",
        ),
        (
            format!("    cycles: [loads]{VARIABLES}\n    limits: {{ hot: {{ quantity: temperature, most: 90 W }} }}"),
            "hot",
        ),
        (
            format!(
                "    cycles: [loads]{VARIABLES}\n    limits: {{ life: {{ quantity: rating, rating: iso_281.L20h, least: 1 h }} }}"
            ),
            "no quantity of this rating is called `L20h`",
        ),
        (
            format!(
                "    cycles: [loads]{VARIABLES}\n    limits: {{ life: {{ quantity: rating, rating: iso_28.L10h, least: 1 h }} }}"
            ),
            "no rating is called `iso_28`",
        ),
        (
            format!("    cycles: [loads]{VARIABLES}\n    limits: {{ life: {{ quantity: rating, least: 1 h }} }}"),
            "`rating` is missing",
        ),
        (
            format!("    cycles: [loads]{VARIABLES}\n    limits: {{ hot: {{ quantity: temperature }} }}"),
            "needs `least` or `most`",
        ),
    ] {
        let words = optimised(&common(&analysis)).map(|_| ()).unwrap_err();
        assert!(words.contains(said), "{analysis}\n{words}");
    }
}
