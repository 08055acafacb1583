//! Comparisons over cycles: differences by share and by phase, of sets and of variants.

use crate::common::study::{number, of_gearbox, run_texts};
use serde_json::Value;

const GEARBOX: &str = "examples/two-speed-ev/gearbox.yaml";
const SPEED: &str = "time [s],vehicle_speed [km/h]\n0,0\n1,8\n2,16\n3,24\n4,32\n5,40\n6,48\n7,48\n8,48\n";
const CYCLES: &str = "cycles: { town: { file: speed.csv, phases: { start: { end: 4 s }, rest: { end: 8 s } } }, odd: { file: speed.csv, phases: { early: { end: 4 s }, late: { end: 2 s } } }, long: { file: speed.csv, phases: { all: { end: 9 s } } } }\n\
    vehicles: { car: { mass: 1200 kg, drag_area: 0.6 m2, rolling_resistance: 0.01, tyre_radius: 0.3 m, regeneration: none } }\n";

fn run(analyses: &str) -> crate::common::study::Ran {
    let study = of_gearbox(GEARBOX, &format!("{CYCLES}analyses:\n{analyses}"));
    run_texts(&study, &[("speed.csv", SPEED)])
}

fn sum(list: &Value, key: &str) -> f64 {
    list.as_array().unwrap().iter().map(|row| number(&row[key])).sum()
}

#[test]
fn shares_and_phases_add_up_to_the_difference_of_two_runs() {
    let ran = run(
        "  both: { type: compare, drive: { cycles: [town] }, base: own, by: component, variants: { thin: { lubricants.sump.viscosity.factor: 0.5 } } }\n  \
                     alone: { type: cycle, cycles: [town] }\n",
    );
    assert!(ran.succeeded, "{}", ran.text);
    let both = &ran.json("both")["comparisons"][0];
    let difference = number(&both["difference_w"]);
    assert!(difference.abs() > 1e-3, "{both}");
    assert!(
        (sum(&both["shares"], "difference_w") - difference).abs() < 1e-9,
        "{both}"
    );
    // Both phases last half of the cycle.
    assert!(
        (sum(&both["phases"], "difference_w") / 2.0 - difference).abs() < 1e-9,
        "{both}"
    );
    let alone = &ran.json("alone")["cycles"][0];
    assert_eq!(alone["mean_loss_w"], both["base_mean_loss_w"]);
    // Trapezoids of the speeds, 240 km/h s.
    let km = 240.0 / 3600.0;
    let lost = number(&alone["energy"]["loss_j"]) / 3600.0;
    assert!(
        (number(&alone["per_distance"]["loss_wh_per_km"]) / (lost / km) - 1.0).abs() < 1e-9,
        "{alone}"
    );
    let per_km = difference * 8.0 / 3600.0 / km;
    assert!(
        (number(&both["difference_wh_per_km"]) / per_km - 1.0).abs() < 1e-9,
        "{both}"
    );
    assert!(ran.text.contains("thin minus own W"), "{}", ran.text);
    assert!(
        ran.csv("both-phases").lines().count() == 3,
        "{}",
        ran.csv("both-phases")
    );
}

/// The first row of a recording is the start of the first phase, whatever its clock says.
#[test]
fn phases_count_from_the_first_row() {
    let later = SPEED
        .lines()
        .enumerate()
        .map(|(i, line)| match line.split_once(',').filter(|_| i > 0) {
            Some((time, speed)) => format!("{},{speed}\n", time.parse::<u32>().unwrap() + 1000),
            None => format!("{line}\n"),
        });
    let study = of_gearbox(
        GEARBOX,
        &format!(
            "{CYCLES}analyses:\n  both: {{ type: compare, drive: {{ cycles: [town] }}, base: own, variants: {{ thin: {{ \
             lubricants.sump.viscosity.factor: 0.5 }} }} }}\n"
        ),
    );
    let [ran, moved] =
        [SPEED.to_owned(), later.collect::<String>()].map(|speed| run_texts(&study, &[("speed.csv", &speed)]));
    assert!(moved.succeeded, "{}", moved.text);
    assert!(number(&moved.json("both")["comparisons"][0]["phases"][0]["mean_loss_w"]) > 0.0);
    assert_eq!(ran.json("both")["comparisons"], moved.json("both")["comparisons"]);
}

/// Without brakes every interval drives or coasts: all input is in one of both efficiencies.
#[test]
fn a_cycle_states_its_efficiency_in_drive() {
    let ran = run("  alone: { type: cycle, cycles: [town] }\n");
    let energy = &ran.json("alone")["cycles"][0]["energy"];
    let drive = number(&energy["drive_efficiency"]);
    assert!(drive > 0.9 && drive < 1.0, "{energy}");
    assert!(
        (drive - number(&energy["output_j"]) / number(&energy["input_j"])).abs() < 1e-9,
        "{energy}"
    );
    assert!(energy["recuperation_efficiency"].is_null(), "{energy}");
}

#[test]
fn what_a_comparison_over_cycles_lacks_is_reported() {
    for (analysis, said) in [
        ("drive: { cycles: [town] }, against: [own]", "needs `base`"),
        (
            "drive: { cycles: [town] }, base: own",
            "nothing is compared with the base",
        ),
        (
            "drive: { cycles: [odd] }, base: own, variants: { a: { surface.ra: 1 um } }",
            "the phase `late` ends at 2 s, not after 4 s",
        ),
        (
            "drive: { cycles: [long] }, base: own, variants: { a: { surface.ra: 1 um } }",
            "the phase `all` ends at 9 s, after the cycle, which lasts 8 s",
        ),
        (
            "drive: { cycles: [tow] }, base: own, variants: { a: { surface.ra: 1 um } }",
            "tow",
        ),
        (
            "drive: { cycles: [town] }, base: own, against: [iso14179_2], variants: { iso14179_2: { surface.ra: 1 um } }",
            "has the name of a compared set",
        ),
        (
            "drive: { cycles: [town] }, base: own, variants: { a: { bearings.B9.at: 1 mm } }",
            "B9",
        ),
        (
            "drive: { cycles: [town] }, base: own, by: term, variants: { a: { surface.ra: 1 um } }",
            "by mechanism",
        ),
    ] {
        let ran = run(&format!("  bad: {{ type: compare, {analysis} }}\n"));
        assert!(
            !ran.succeeded && ran.text.contains(said) && ran.text.contains("help:"),
            "{said}: {}",
            ran.text
        );
    }
}
