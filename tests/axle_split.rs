//! A front and a rear unit: the share that draws least, disconnection, and what is refused.

use crate::common::file;
use crate::common::study::{Ran, number, run_texts};

/// Two units with the gearbox of the two-speed example, in its second gear.
fn study(front: &str, rear: &str, more: &str) -> String {
    let gearbox = file("examples/two-speed-ev/gearbox.yaml");
    format!(
        "gearloss: study/1
gearboxes: {{ front: {0}, rear: {0} }}
conditions: {{ oil_temperature: 60 degC }}
cycles: {{ town: {{ shipped: nycc, start: 20 s, end: 220 s }} }}
vehicles:
  car:
    mass: 1800 kg
    drag_area: 0.6 m2
    rolling_resistance: 0.009
    tyre_radius: 310 mm
    regeneration: {{ torque: 40 Nm, power: 40 kW }}
    motor_map: {1}
    battery: {{ energy: 30 kWh, efficiency: 0.95 }}
analyses:
  split:
    type: axle_split
    cycles: [town]
    front: {{ gearbox: front, gear: second{front} }}
    rear: {{ gearbox: rear, gear: second{rear} }}
{more}",
        gearbox.display(),
        file("examples/two-speed-ev/machine.csv").display(),
    )
}

fn ran(front: &str, rear: &str, more: &str) -> Ran {
    let ran = run_texts(&study(front, rear, more), &[]);
    assert!(ran.succeeded, "{}", ran.text);
    ran
}

#[test]
fn the_best_share_is_never_worse_than_a_fixed_one() {
    let ran = ran("", "", "");
    let split = &ran.json("split")["cycles"][0];
    let fixed = split["fixed"].as_array().unwrap();
    assert_eq!(fixed.len(), 3);
    for fixed in fixed {
        assert!(number(&fixed["difference_j"]) > -1e-6, "{fixed}");
    }
    // Equal units: each alone draws the same.
    let [front, rear] = [1, 2].map(|i| number(&fixed[i]["drawn_j"]));
    assert!((front - rear).abs() < 1e-6 * front.abs(), "{front} {rear}");
    // Half is the least of equal units with convex losses: the rest is the interpolation of the map.
    assert!(
        number(&fixed[0]["difference_j"]) < 0.003 * number(&split["drawn_j"]),
        "{split}"
    );
    assert_eq!(
        split["states"].as_array().unwrap().len(),
        2,
        "both, and standstill: {split}"
    );
    let csv = ran.csv("split");
    let drawn: f64 = csv
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            cells[2].parse::<f64>().unwrap() * cells[cells.len() - 1].parse::<f64>().unwrap()
        })
        .sum();
    assert!(
        (drawn - number(&split["drawn_j"])).abs() < 1e-6 * drawn.abs(),
        "{drawn}"
    );
}

#[test]
fn a_disconnected_unit_saves_its_idle_losses() {
    let connected = ran("", "", "");
    let ran = ran("", ", disconnect: neutral", "");
    let [connected, split] = [&connected, &ran].map(|ran| ran.json("split")["cycles"][0].clone());
    assert!(number(&split["drawn_j"]) < number(&connected["drawn_j"]), "{split}");
    let states: Vec<&str> = split["states"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["state"].as_str().unwrap())
        .collect();
    assert!(
        states.contains(&"front_alone") && !states.contains(&"rear_alone"),
        "{states:?}"
    );
}

#[test]
fn a_fixed_share_is_that_of_the_comparison() {
    let free = ran("", "", "");
    let half = ran("", "", "    split: 0.5\n");
    let of = |ran: &Ran| ran.json("split")["cycles"][0].clone();
    assert_eq!(number(&of(&half)["drawn_j"]), number(&of(&free)["fixed"][0]["drawn_j"]));
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    let cases = [
        (", disconnect: parked", "no gear state is called `parked`"),
        (", disconnect: first", "does not separate the wheels from the input"),
        (", motor_map: none.csv", "cannot read none.csv"),
    ];
    for (rear, message) in cases {
        let ran = run_texts(&study("", rear, ""), &[]);
        assert!(!ran.succeeded, "{rear}");
        assert!(
            ran.text.contains(message) && ran.text.contains("analyses.split.rear"),
            "{}",
            ran.text
        );
    }
    let without = |key: &str| {
        let text = study("", "", "");
        let kept: Vec<&str> = text.lines().filter(|line| !line.contains(key)).collect();
        run_texts(&kept.join("\n"), &[]).text
    };
    assert!(without("motor_map").contains("has no machine"));
    let inertia = study("", "", "").replace(
        "    battery:",
        "    inertia: { wheels: 2 kg m2, rotor: 0.006 kg m2 }\n    battery:",
    );
    assert!(run_texts(&inertia, &[]).text.contains("belong to one unit"));
}
