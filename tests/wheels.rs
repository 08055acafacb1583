//! The electric axle: a gearbox with a port for each wheel, driven straight through a map, a cycle and a sweep of oils.

use assert_cmd::Command;
use serde_json::Value;

#[test]
fn two_wheels_drive_straight_through_map_cycle_and_fluid_sweep() {
    let folder = std::env::temp_dir().join(format!("gearloss-wheels-{}", std::process::id()));
    let output = Command::cargo_bin("gearloss")
        .unwrap()
        .args(["run", "examples/e-axle/study.yaml", "-o"])
        .arg(&folder)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read = |name: &str| -> Value {
        let text = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
        serde_json::from_str(&text).unwrap()
    };
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value}"));

    let map = read("map");
    let points = map["maps"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 169);
    for p in points {
        // Power in is power out and losses, to the rounding of numbers of 100 kW.
        let gap = number(&p["input_w"]) - number(&p["output_w"]) - number(&p["loss_w"]);
        assert!(gap.abs() < 1e-9 * number(&p["input_w"]), "{p}");
    }

    let energy = &read("wltc")["cycles"][0]["energy"];
    let [input, output, loss] = ["input_j", "output_j", "loss_j"].map(|key| number(&energy[key]));
    assert!(
        ((input - output - loss) / input).abs() < 1e-9,
        "{input} {output} {loss}"
    );

    // The friction of seals and bearings rises with the viscosity.
    let oils = read("oils");
    let fluids = oils["fluid_sweep"][0]["cycles"][0]["fluids"].as_array().unwrap();
    let losses: Vec<f64> = fluids.iter().map(|f| number(&f["mean_loss_w"])).collect();
    assert!(
        losses.windows(2).all(|pair| pair[0] < pair[1]) && losses.len() >= 4,
        "{losses:?}"
    );
    let _ = std::fs::remove_dir_all(&folder);
}
