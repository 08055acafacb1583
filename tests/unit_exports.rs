//! Tables and FMUs of a drive unit: their values are those of the points that were solved.

use std::collections::BTreeMap;

use gearloss_fmu::content::Content;
use gearloss_fmu::model::Model;
use gearloss_fmu::variables::{Kind, Use};
use gearloss_framework::document::archive::Archive;
use serde_json::Value;

use crate::common::RPM;
use crate::common::study::{Ran, check_texts, number, run_texts};
use crate::drive_unit::STAGE;

/// A machine whose losses depend on speed and on the magnitude of the torque, also at standstill.
fn map() -> String {
    let mut rows = "speed [rpm],torque [Nm],loss [W]\n".to_owned();
    for n in [0.0, 1000.0, 4000.0] {
        for torque in [-100.0_f64, -50.0, 0.0, 50.0, 100.0] {
            rows.push_str(&format!("{n},{torque},{}\n", 40.0 + 0.05 * n + 0.08 * torque * torque));
        }
    }
    rows
}

const MACHINE: &str = "{ map: map.csv, idle: \"off\", freewheel: [{ speed: 0 rpm, loss: 0 W }, { speed: 4000 rpm, loss: 80 W }], \
                       inverter: { efficiency: 0.97 }, envelope: { peak: { torque: 100 Nm, power: 20 kW } } }";

/// Maps of the stage with a machine; `mode` is the rest of the conditions.
fn exported(machine: &str, maps: &str) -> Ran {
    let study = format!(
        "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC }}
grids: {{ g: {{ torque: [-60 Nm, -20 Nm, 20 Nm, 60 Nm], speed: [0 rpm, 500 rpm, 2000 rpm, 3500 rpm] }} }}
analyses:
{maps}
"
    );
    let gearbox = format!("{STAGE}\nmachines: {{ motor: {machine} }}\n");
    run_texts(&study, &[("box.yaml", &gearbox), ("map.csv", &map())])
}

/// The points of a map by torque and speed as they are written.
fn points(ran: &Ran, analysis: &str) -> BTreeMap<[i64; 2], Value> {
    let points = ran.json(analysis)["maps"][0]["points"].as_array().unwrap().clone();
    let key = |point: &Value| ["torque_nm", "speed_rpm"].map(|key| number(&point[key]).round() as i64);
    points.into_iter().map(|point| (key(&point), point)).collect()
}

/// Whether two numbers are equal but for the rounding of a product and a quotient.
fn same(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= 1e-12 * expected.abs().max(1.0)
}

/// The model of an FMU.
fn model(ran: &Ran, name: &str) -> Model {
    let archive = Archive::open(ran.bytes(name), 1000).unwrap();
    let content = archive.find("resources/map.bin").unwrap();
    Model::new(Content::decode(&archive.unpack(content, 1 << 24).unwrap()).unwrap())
}

/// The outputs of a model at a torque (Nm) and a speed (rad/s).
fn outputs(model: &mut Model, torque: f64, speed: f64) -> impl Fn(Use) -> f64 + use<> {
    let slots = model.slots().to_vec();
    let place = |wanted: Use| slots.iter().position(|slot| slot.use_ == wanted).unwrap() as u32;
    model.set(place(Use::Speed), Kind::Real, speed).unwrap();
    model.set(place(Use::Torque), Kind::Real, torque).unwrap();
    let all: Vec<f64> = (0..slots.len() as u32)
        .map(|i| model.get(i, slots[i as usize].kind).unwrap())
        .collect();
    move |wanted| all[slots.iter().position(|slot| slot.use_ == wanted).unwrap()]
}

#[test]
fn an_fmu_of_the_unit_has_the_powers_of_its_points() {
    let ran = exported(
        MACHINE,
        "  unit: { type: map, grid: g, of: unit, export: [fmu2, fmu3], write: [json] }",
    );
    assert!(ran.succeeded, "{}", ran.text);
    let mut model = model(&ran, "unit-own-fmi3.fmu");
    for ([torque, rpm], point) in points(&ran, "unit") {
        let at = outputs(&mut model, torque as f64, rpm as f64 * RPM);
        let unit = &point["unit"];
        for (use_, key) in [
            (Use::DcPower, "dc_power_w"),
            (Use::MachineLoss, "machine_loss_w"),
            (Use::InverterLoss, "inverter_loss_w"),
            (Use::LossPower, "unit_loss_w"),
        ] {
            assert!(
                same(at(use_), number(&unit[key])),
                "{torque} {rpm} {key}: {} {unit}",
                at(use_)
            );
        }
        assert!(same(at(Use::GearboxLoss), number(&point["loss_w"])), "{torque} {rpm}");
        let efficiency = unit["system_efficiency"].as_f64().unwrap_or(0.0);
        assert!(same(at(Use::Efficiency), efficiency), "{torque} {rpm} {efficiency}");
        assert_eq!(at(Use::Outside), 0.0);
        // What comes out of the link is lost or leaves at the other port.
        let leaves = at(Use::OutputTorque) * at(Use::OutputSpeed);
        assert!(
            same(at(Use::DcPower) - at(Use::LossPower), leaves),
            "{torque} {rpm} {leaves}"
        );
        let shares: f64 = (0..6).map(|i| at(Use::Share(i))).sum();
        assert!(same(shares, at(Use::GearboxLoss)));
    }
    // Between standstill and the lowest speed the machine does not stop losing.
    let at = outputs(&mut model, 60.0, 0.0);
    assert!(at(Use::MachineLoss) > 300.0 && at(Use::GearboxLoss) == 0.0 && at(Use::Efficiency) == 0.0);
    let xml = Archive::open(ran.bytes("unit-own-fmi2.fmu"), 1000).unwrap();
    let xml = xml.unpack(xml.find("modelDescription.xml").unwrap(), 1 << 24).unwrap();
    let xml = String::from_utf8(xml).unwrap();
    for name in [
        "dc.power",
        "loss.gearbox",
        "loss.machines",
        "loss.inverters",
        "output.torque",
    ] {
        assert!(xml.contains(&format!("name=\"{name}\"")), "{xml}");
    }
    assert!(
        ran.text
            .contains("interpolation error of the loss between grid points: at most"),
        "{}",
        ran.text
    );
}

#[test]
fn an_fmu_of_the_machines_has_no_gearbox() {
    let ran = exported(
        MACHINE,
        "  m: { type: map, grid: g, of: machine, export: [fmu3], write: [json] }",
    );
    assert!(ran.succeeded, "{}", ran.text);
    let mut model = model(&ran, "m-own-fmi3.fmu");
    assert!(
        model
            .slots()
            .iter()
            .all(|slot| !matches!(slot.use_, Use::GearboxLoss | Use::OutputTorque | Use::Share(_)))
    );
    for ([torque, rpm], point) in points(&ran, "m") {
        let at = outputs(&mut model, torque as f64, rpm as f64 * RPM);
        let unit = &point["unit"];
        let lost = number(&unit["machine_loss_w"]) + number(&unit["inverter_loss_w"]);
        assert!(
            same(at(Use::LossPower), lost) && same(at(Use::DcPower), number(&unit["dc_power_w"])),
            "{torque} {rpm}"
        );
    }
}

/// The rows of a table of a Modelica file: torques, and values by torque and speed.
fn table(text: &str, name: &str) -> Vec<Vec<f64>> {
    let body = text.split_once(&format!("double {name}(")).unwrap().1;
    let rows = body.lines().skip(1).take_while(|line| !line.starts_with(['d', '#']));
    rows.map(|row| row.split(' ').map(|x| x.parse().unwrap()).collect())
        .collect()
}

#[test]
fn tables_of_the_unit_have_the_bits_of_its_points() {
    let ran = exported(
        MACHINE,
        "  unit: { type: map, grid: g, of: unit, export: [mat, matlab, modelica], write: [json] }",
    );
    assert!(ran.succeeded, "{}", ran.text);
    let text = ran.file("unit-own-only.txt");
    let points = points(&ran, "unit");
    for (name, key) in [
        ("dc_power", "dc_power_w"),
        ("loss_power", "unit_loss_w"),
        ("machine_loss", "machine_loss_w"),
        ("inverter_loss", "inverter_loss_w"),
        ("efficiency", "system_efficiency"),
    ] {
        let rows = table(text, name);
        // Standstill is a column of powers, and zero torque a row.
        assert_eq!([rows.len(), rows[0].len()], [6, 5], "{name}");
        for row in &rows[1..] {
            for (value, speed) in row[1..].iter().zip(&rows[0][1..]) {
                let Some(point) = points.get(&[row[0] as i64, (speed / RPM).round() as i64]) else {
                    assert_eq!(row[0], 0.0);
                    continue;
                };
                assert_eq!(
                    *value,
                    point["unit"][key].as_f64().unwrap_or(0.0),
                    "{name} {} {speed}",
                    row[0]
                );
            }
        }
    }
    let script = ran.file("unit-own-only.m");
    for name in [
        "dc_power_tbl = [",
        "loss_power_tbl = [",
        "machine_loss_tbl = [",
        "inverter_loss_tbl = [",
    ] {
        assert!(script.contains(name), "{script}");
    }
    assert!(script.contains("omega_unit_bpts = [0 ") && !script.contains("omega_bpts = [0 "));
    let mat = ran.bytes("unit-own-only.mat");
    let has = |name: &[u8]| mat.windows(name.len()).any(|part| part == name);
    assert!(has(b"dc_power_tbl") && has(b"omega_unit_bpts"));
}

/// The numbers of a CSV after its header.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(|x| x.parse().unwrap()).collect())
        .collect()
}

#[test]
fn vecto_takes_the_machine_with_its_drag_and_full_load() {
    let maps = "  m: { type: map, grid: signed, of: machine, export: [vecto], write: [json] }";
    let study = |machine: &str| {
        let grids = "grids: { signed: { torque: [-60 Nm, -20 Nm, 0 Nm, 20 Nm, 60 Nm], speed: [0 rpm, 500 rpm, 2000 rpm, 3500 rpm] } }";
        let text = format!(
            "gearloss: study/1\ngearboxes: {{ box: box.yaml }}\nconditions: {{ oil_temperature: 60 degC }}\n{grids}\nanalyses:\n{maps}\n"
        );
        let gearbox = format!("{STAGE}\nmachines: {{ motor: {machine} }}\n");
        run_texts(&text, &[("box.yaml", &gearbox), ("map.csv", &map())])
    };
    let ran = study(MACHINE);
    assert!(ran.succeeded, "{}", ran.text);
    let points = points(&ran, "m");
    let power = ran.file("m-own-only.vemo");
    assert_eq!(power.lines().next(), Some("n [rpm],T [Nm],P_el [kW]"));
    // Without torque the inverter is off, and the drag has a file of its own.
    assert_eq!(rows(power).len(), 16);
    for row in rows(power) {
        let unit = &points[&[row[1] as i64, row[0] as i64]]["unit"];
        // Written to a milliwatt.
        assert!((1000.0 * row[2] - number(&unit["dc_power_w"])).abs() < 6e-4, "{row:?}");
    }
    let drag = rows(ran.file("m-own-only.vemd"));
    let expected = |rpm: f64| -(80.0 * rpm / 4000.0) / (rpm * RPM);
    assert_eq!(drag.len(), 3);
    assert!(
        drag.iter().all(|row| (row[1] - expected(row[0])).abs() < 6e-7),
        "{drag:?}"
    );
    let full = rows(ran.file("m-own-only.vemp"));
    assert_eq!(full[0], [0.0, 100.0, -100.0]);
    assert!((full[3][1] - 20_000.0 / (3500.0 * RPM)).abs() < 6e-5, "{full:?}");
    // An energised machine states no drag, and one without an envelope no full load.
    let ran = study("{ map: map.csv, contains: [inverter] }");
    assert!(ran.succeeded, "{}", ran.text);
    assert!(!ran.has_file("m-own-only.vemd") && !ran.has_file("m-own-only.vemp"));
    assert_eq!(rows(ran.file("m-own-only.vemo")).len(), 20);
    assert!(ran.text.contains("no drag curve"), "{}", ran.text);
}

#[test]
fn formats_of_two_shafts_say_what_to_use_instead() {
    for (of, format, words) in [
        (
            "unit",
            "vecto",
            "VECTO takes the machine and the gearbox as files of their own",
        ),
        ("unit", "lossy_gear", "machines lose at standstill too"),
        ("machine", "lossy_gear", "export `lossy_gear` of a map without `of`"),
    ] {
        let ran = exported(
            MACHINE,
            &format!("  m: {{ type: map, grid: g, of: {of}, export: [{format}] }}"),
        );
        assert!(
            !ran.succeeded && ran.text.contains(words) && ran.text.contains("E0542"),
            "{}",
            ran.text
        );
    }
}

/// The voltage of the link is no axis of a table: `check` says so, and VECTO's files are one for each voltage.
#[test]
fn maps_at_several_voltages_are_tables_of_their_own() {
    let study = |format: &str| {
        format!(
            "gearloss: study/1
gearboxes: {{ box: box.yaml }}
conditions: {{ oil_temperature: 60 degC }}
grids:
  g:
    torque: [-60 Nm, 0 Nm, 60 Nm]
    speed: [500 rpm, 2000 rpm, 3500 rpm]
    bind: {{ machines.motor.voltage: [300 V, 400 V] }}
analyses: {{ m: {{ type: map, grid: g, of: machine, export: [{format}] }} }}
"
        )
    };
    let mut map = "speed [rpm],torque [Nm],voltage [V],loss [W]\n".to_owned();
    for voltage in [300, 400] {
        for n in [0, 4000] {
            for torque in [-100, 0, 100] {
                map.push_str(&format!("{n},{torque},{voltage},{}\n", 40 + n / 20 + voltage / 10));
            }
        }
    }
    let gearbox = format!(
        "{STAGE}\nmachines: {{ motor: {{ map: map.csv, voltage: 400 V, inverter: {{ efficiency: 0.97 }} }} }}\n"
    );
    let files = [("box.yaml", gearbox.as_str()), ("map.csv", map.as_str())];
    for format in ["fmu3", "mat", "matlab", "modelica"] {
        let found = check_texts(&study(format), &files);
        let says = [
            "analyses.m.export",
            "differ in `machines.motor.voltage`",
            "bind one value of it",
        ];
        assert!(says.iter().all(|words| found.contains(words)), "{found}");
    }
    let ran = run_texts(&study("vecto"), &files);
    assert!(ran.succeeded, "{}", ran.text);
    let of = |number: usize| rows(ran.file(&format!("m-own-only-{number}.vemo")));
    let (low, high) = (of(1), of(2));
    // 10 W more at 400 V, through the inverter, in kW of six digits after the point.
    let driving = low.iter().zip(&high).find(|(low, _)| low[1] == 60.0).unwrap();
    assert!(
        (driving.1[2] - driving.0[2] - 0.01 / 0.97).abs() <= 1.001e-6,
        "{driving:?}"
    );
}
