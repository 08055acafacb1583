//! A thermal network of 64 nodes for the two-speed example: oil, shafts, and a casing cut into plates that all stand in the air.

use serde_json::{Map, Value, json};

/// Nodes: the surroundings, the sump, the shafts and the plates.
pub const NODES: usize = 64;
/// Plates of the casing.
const PLATES: usize = NODES - 3;
/// Plates in a row.
const ROW: usize = 8;

/// Changes to the example.
pub fn network() -> Vec<(String, Value)> {
    let mut nodes = Map::new();
    nodes.insert("sump".into(), json!({ "oil": true, "heat_capacity": "2100 J/K" }));
    let gears = ["G1", "G2", "G3", "G4", "G5", "G6"];
    nodes.insert("shafts".into(), json!({ "heat_capacity": "3800 J/K", "gears": gears }));
    let mut links = Map::new();
    let mut link = |name: String, between: [&str; 2], conductance: f64| {
        links.insert(
            name,
            json!({ "between": between, "conductance": format!("{conductance} W/K") }),
        );
    };
    link("flung".into(), ["shafts", "sump"], 20.0);
    let plate = |i: usize| format!("plate_{i}");
    for i in 0..PLATES {
        let mut node = json!({ "heat_capacity": "90 J/K" });
        // A bearing in each of the first plates of six rows.
        if i % ROW == 0 && i / ROW < 6 {
            node["parts"] = json!([format!("bearings.B{}", i / ROW + 1)]);
            link(format!("bearing_{i}"), ["shafts", &plate(i)], 4.0);
        }
        nodes.insert(plate(i), node);
        link(format!("air_{i}"), [&plate(i), "ambient"], 0.06);
        link(format!("oil_{i}"), ["sump", &plate(i)], 0.5);
        for (name, next) in [("along", i + 1), ("across", i + ROW)] {
            if next < PLATES && (name == "across" || next % ROW != 0) {
                link(format!("{name}_{i}"), [&plate(i), &plate(next)], 5.0);
            }
        }
    }
    vec![
        ("thermal.mode".into(), json!("network")),
        ("thermal.network".into(), json!({ "nodes": nodes, "links": links })),
    ]
}
