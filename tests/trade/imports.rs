//! Tables and models of other programs.
#![allow(clippy::format_collect, clippy::approx_constant)]

use super::Case;
use super::losses::solved;

/// A drag table of two runs, as OpenFOAM's function object writes them.
const IMPORT_MOMENTS: [&str; 8] = [
    "import",
    "openfoam-forces",
    "runs.csv",
    "--axis",
    "z",
    "--from",
    "0.1 s",
    "-o",
];

#[test]
fn forces_are_not_taken_for_moments() {
    let case = Case::new("moments_beside_forces", "force-file");
    let said = case.gearloss(&[&IMPORT_MOMENTS[..], &["out.csv"]].concat());
    assert_eq!(said.code, Some(2), "{}", said.text);
    assert!(
        said.text.contains("these are forces in N, not moments"),
        "{}",
        said.text
    );
    assert!(!case.path("out.csv").exists());
    // The help leads to the right moment: 0.4 + 0.1 Nm.
    let help = said.text.split("name ").last().unwrap();
    let file = help.lines().next().unwrap().trim();
    assert_eq!(file, "run1/0/moment.dat", "{}", said.text);
    for place in [file, "run1"] {
        case.write("runs.csv", format!("speed [rpm],folder\n1000,{place}\n2000,run2\n"));
        let name = format!("{}.csv", place.replace('/', "-"));
        let said = case.gearloss(&[&IMPORT_MOMENTS[..], &[name.as_str()]].concat());
        assert_eq!(said.code, Some(0), "{}", said.text);
        let table = std::fs::read_to_string(case.path(&name)).unwrap();
        assert!(table.contains("\n1000,0.4,0.1\n2000,0.4,0.02\n"), "{table}");
    }
}

#[test]
fn moments_in_local_axes_are_taken_only_when_stated() {
    let case = Case::new("moments_beside_forces", "local-axes");
    let line =
        |time: f64| format!("{time} ((0 0 0) (0 0 0)) ((0 0 0.3) (0 0 0)) ((0 0 0) (0 0 0)) ((0 0 0.7) (0 0 0))\n");
    case.write(
        "run1/0/forces.dat",
        "# Forces\n# Time forces(pressure viscous) moment(pressure viscous) localForce(pressure viscous) localMoment(pressure viscous)\n"
            .to_owned()
            + &line(1.0)
            + &line(2.0),
    );
    case.write(
        "runs.csv",
        "speed [rpm],folder\n1000,run1/0/forces.dat\n2000,run1/0/forces.dat\n",
    );
    for (more, moment) in [(&[][..], "0.3"), (&["--local-axes"][..], "0.7")] {
        let name = format!("{moment}.csv");
        let said = case.gearloss(&[&IMPORT_MOMENTS[..], &[name.as_str()], more].concat());
        assert_eq!(said.code, Some(0), "{}", said.text);
        let table = std::fs::read_to_string(case.path(&name)).unwrap();
        assert!(table.contains(&format!("\n1000,{moment},0\n")), "{table}");
    }
    // The other file has no local axes.
    case.write("runs.csv", "speed [rpm],folder\n1000,run2\n");
    let said = case.gearloss(&[&IMPORT_MOMENTS[..], &["none.csv", "--local-axes"]].concat());
    assert!(
        said.code == Some(2)
            && said.text.contains("no moments in local axes")
            && said.text.contains("omit `--local-axes`"),
        "{}",
        said.text
    );
}

#[test]
fn a_makers_table_serves_every_bearing_model() {
    let case = Case::new("maker_table", "models");
    let said = case.gearloss(&["import", "bearings", "table.csv", "-o", "cat.csv"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    assert!(
        said.text
            .contains("- series from the series in the designation: 2 of 2 bearings"),
        "{}",
        said.text
    );
    let said = case.gearloss(&["check", "gearbox.yaml"]);
    assert!(
        said.code == Some(0) && said.text.contains("gearbox.yaml: fine"),
        "{}",
        said.text
    );
    for model in ["iso14179_1", "iso14179_2", "harris", "schaeffler"] {
        let set = format!("bearings.*.model={{ type: {model} }}");
        let point = [
            "solve",
            "gearbox.yaml",
            "--speed",
            "1000 rpm",
            "--torque",
            "10 Nm",
            "--set",
            &set,
        ];
        let said = case.gearloss(&point);
        assert_eq!(said.code, Some(0), "{model}: {}", said.text);
    }
    // The shipped bearings lose as much.
    let catalogue = std::fs::read_to_string(case.path("cat.csv")).unwrap();
    for row in [
        "6206,deep_groove_ball,62,30,62,16,20300,11200,",
        "6208,deep_groove_ball,62,40,80,18,32500,19000,",
    ] {
        assert!(catalogue.contains(&format!("\n{row}")), "{catalogue}");
    }
    let gearbox = std::fs::read_to_string(case.path("gearbox.yaml")).unwrap();
    case.write(
        "shipped.yaml",
        gearbox.replace("catalogues: { bearings: cat.csv }\n", ""),
    );
    let loss = |file: &str| solved(&case, file, "10 Nm", "1000 rpm")["loss_w"].as_f64().unwrap();
    assert!((loss("gearbox.yaml") - loss("shipped.yaml")).abs() < 1e-9);
    assert!(
        (loss("gearbox.yaml") - 12.6181).abs() < 1e-3,
        "{}",
        loss("gearbox.yaml")
    );
}

/// One bearing of each kind with what makers' tables state.
const KINDS: &str = "\
Designation,d [mm],D [mm],B [mm],C [kN],C0 [kN],e,Y,Y0,kind
6208,40,80,18,32.5,19,,,,
4208,40,80,23,37.1,32.5,,,,
2208,40,80,23,31.9,10,0.22,,,
7208 BEP,40,80,18,36.5,26,,,,
7208 C,40,80,18,36.5,26,,,,
3208 A,40,80,30.2,47.5,34,,,,
QJ 208,40,80,18,49,36.5,,,,
51108,40,60,13,25.5,63,,,,
NU 208,40,80,18,62,53,,,,
NCF 3008 CV,40,68,21,57.2,69.5,,,,
NA 4908,40,62,22,42.9,71,,,,
30208,40,80,19.75,74.9,68,0.37,,,
22208 E,40,80,23,96.5,90,0.28,,,
C 2208,40,80,23,90,86.5,,,,
81108,40,60,13,43,137,,,,
29412 E,60,130,42,390,915,,,,
AXK 4060,40,60,3,28,114,,,,needle_roller_thrust
";

/// What the import says of a model is what the model does.
#[test]
fn the_import_says_which_models_every_kind_serves() {
    let case = Case::new("maker_table", "kinds");
    case.write("table.csv", KINDS);
    let said = case.gearloss(&["import", "bearings", "table.csv", "-o", "cat.csv"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    let designations: Vec<&str> = KINDS
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap())
        .collect();
    for (model, lacking) in [
        ("skf", vec!["NA 4908"]),
        ("iso14179_2", vec!["C 2208"]),
        (
            "timken",
            designations
                .iter()
                .copied()
                .filter(|designation| *designation != "30208")
                .collect(),
        ),
    ] {
        let ready = designations.len() - lacking.len();
        let line = format!("- {model}: {ready} of {} bearings are complete", designations.len());
        assert!(said.text.contains(&line), "{line}\n{}", said.text);
        // Parameters of the model that are no data of the bearing.
        let more = if model == "timken" { ", g1: 20" } else { "" };
        for designation in &designations {
            let gearbox = format!(
                "gearloss: gearbox/1\ncatalogues: {{ bearings: cat.csv }}\nports: {{ input: s, output: t }}\n\
                 shafts: {{ s: {{ axis: [0 mm, 0 mm] }}, t: {{ axis: [60 mm, 0 mm], bearings: none }} }}\n\
                 gears:\n  p: {{ shaft: s, at: 50 mm, z: 20, facewidth: 20 mm }}\n  w: {{ shaft: t, at: 50 mm, z: 40, facewidth: 20 mm }}\n\
                 meshes: {{ m: {{ gears: [p, w], normal_module: 2 mm, model: none }} }}\n\
                 lubricants: {{ oil: {{ designation: ISO VG 220 mineral }} }}\nthermal: {{ mode: fixed, oil: 60 degC }}\n\
                 bearings:\n  own: {{ shaft: s, at: 0 mm, designation: \"{designation}\", axial: none, model: {{ type: {model}{more} }} }}\n  \
                 a: {{ shaft: s, at: 20 mm, designation: \"6208\", axial: both, model: none }}\n  \
                 b: {{ shaft: s, at: 80 mm, designation: \"6208\", axial: none, model: none }}\n"
            );
            case.write("gearbox.yaml", gearbox);
            let said = case.gearloss(&["check", "gearbox.yaml"]);
            let lacks = said.text.contains("bearings.own.model");
            assert_eq!(
                lacks,
                lacking.contains(designation),
                "{model} {designation}: {}",
                said.text
            );
        }
    }
    // Factors of the contact angle, and of e.
    let written = std::fs::read_to_string(case.path("cat.csv")).unwrap();
    let row = |designation: &str| {
        written
            .lines()
            .find(|line| line.starts_with(designation))
            .unwrap()
            .to_owned()
    };
    assert!(
        row("7208 BEP").contains(",72 BE,40,80,18,36500,26000,1.14,0.57,0.26,"),
        "{written}"
    );
    assert!(row("3208 A").contains(",0.8,1.24,0.66,"), "{written}");
    assert!(
        row("30208").contains(",302,40,80,19.75,74900,68000,0.37,1.62,0.89,"),
        "{written}"
    );
    assert!(
        row("22208 E").contains(",222E,") && row("22208 E").contains(",0.28,3.59,2.36,"),
        "{written}"
    );
    // C0/C of 0.31 and more is plausible for self-aligning bearings, and 0.22, too.
    assert!(!said.text.contains("C0/C"), "{}", said.text);
}

#[test]
fn the_own_format_survives_a_round_trip() {
    let case = Case::new("maker_table", "round-trip");
    for name in ["bearings", "bearings-typical"] {
        let shipped = std::fs::read_to_string(crate::common::file(&format!("plugins/catalogues/{name}.csv"))).unwrap();
        case.write("own.csv", &shipped);
        let again = format!("{name}.csv");
        let said = case.gearloss(&["import", "bearings", "own.csv", "-o", &again]);
        assert!(said.code == Some(0) && !said.text.contains("Not used"), "{}", said.text);
        // No rating of these bearings is implausible for its kind.
        assert!(!said.text.contains("warning"), "{}", said.text);
        let rows = |text: &str| -> Vec<String> {
            let lines = text.lines().filter(|line| !line.starts_with('#'));
            lines.map(|line| line.replace('"', "")).collect()
        };
        let again = std::fs::read_to_string(case.path(&again)).unwrap();
        let (again, shipped) = (rows(&again), rows(&shipped));
        assert_eq!(again.len(), shipped.len());
        for (again, shipped) in again.iter().zip(&shipped) {
            assert_eq!(again, shipped);
        }
    }
}

#[test]
fn columns_with_one_heading_are_told_apart_by_their_unit() {
    let case = Case::new("maker_table", "one-heading");
    case.write(
        "table.csv",
        "Designation,d [mm],D [mm],T [mm],C [mm],C [kN],C0 [kN],e\n30208,40,80,19.75,16,74.9,68,0.37\n",
    );
    let said = case.gearloss(&["import", "bearings", "table.csv", "-o", "cat.csv"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    assert!(said.text.contains("Not used: C [mm]"), "{}", said.text);
    let written = std::fs::read_to_string(case.path("cat.csv")).unwrap();
    assert!(
        written.contains("\n30208,tapered_roller,302,40,80,19.75,74900,68000,"),
        "{written}"
    );
}

#[test]
fn an_unknown_column_of_a_catalogue_is_named_once() {
    let case = Case::new("maker_table", "unknown-column");
    let rows: String = (0..300).map(|i| format!("X{i},30,62,{i},2\n")).collect();
    case.write(
        "own.csv",
        format!("designation,bore [mm],outside [mm],mass [kg],weight [kg]\n{rows}"),
    );
    let said = case.gearloss(&["catalogue", "bearings", "--file", "own.csv"]);
    assert_eq!(said.code, Some(2), "{}", said.text);
    assert_eq!(said.text.matches("mass").count(), 1, "{}", said.text);
    assert!(
        said.text.contains("no key for the columns `mass`, `weight`") && said.text.len() < 1000,
        "{}",
        said.text
    );
}

#[test]
fn a_cycle_over_distance_becomes_one_over_time() {
    let case = Case::new("distance_cycle", "distance");
    let cycle = case.result("study.yaml", "c");
    let duration = cycle["cycles"][0]["duration_s"].as_f64().unwrap();
    assert!((duration - 23.146_589_0).abs() < 1e-5, "{duration}");
    let csv = std::fs::read_to_string(case.path("results/c.csv")).unwrap();
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let place = lines
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "time_s")
        .unwrap();
    let last = lines.next_back().unwrap().split(',').nth(place).unwrap();
    // By hand, with 1 m/s2: the last metre begins at 21.7323754 s, after stops of 2 and 3 s, and takes 1.4142136 s in two steps.
    let last: f64 = last.parse().unwrap();
    assert!((last - (21.732_375_4 + 0.707_106_8)).abs() < 1e-5, "{last}");
}

/// Torque at the input in the first second: (1500 kg 0.3333 m/s2 + 100 N + 0.0111 N - 0.1133 N) 0.3 m / (2 0.9).
#[test]
fn a_cycle_over_time_has_the_torque_of_its_acceleration() {
    let case = Case::new("distance_cycle", "time");
    case.result("time.yaml", "c");
    let csv = std::fs::read_to_string(case.path("results/c.csv")).unwrap();
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let first: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = header.iter().position(|name| *name == "torque_nm").unwrap();
    let torque: f64 = first[place].parse().unwrap();
    assert!((torque - 99.982_97).abs() < 1e-4, "{torque}");
}

/// The vehicle stands for 2 s in line 2 and for 3 s in line 8.
#[test]
fn stops_are_not_dropped_if_their_column_is_not_stated() {
    let case = Case::new("distance_cycle", "without-stops");
    let study = std::fs::read_to_string(case.path("study.yaml")).unwrap();
    case.write(
        "study.yaml",
        study.replace(", stop: \"<stop>\"", "").replace(", stop: s", ""),
    );
    let told = |what: &str| {
        let said = case.gearloss(&["check", "study.yaml"]);
        assert_eq!(said.code, Some(2), "{}", said.text);
        assert!(
            said.text.contains(what) && said.text.contains("\n1 error\n"),
            "{}",
            said.text
        );
    };
    told("line 2: the vehicle stands here, and no column says for how long");
    told("columns: { stop: \"<stop>\" }");
    // Without the column, the first row is only the start.
    let route = std::fs::read_to_string(case.path("route.vdri")).unwrap();
    let rows = route
        .lines()
        .map(|line| line.rsplit_once(',').unwrap().0.to_owned() + "\n");
    case.write("route.vdri", rows.collect::<String>());
    told("line 8: the vehicle stands here");
}

#[test]
fn a_cycle_without_time_says_what_it_needs() {
    let case = Case::new("distance_cycle", "without-time");
    let study = std::fs::read_to_string(case.path("study.yaml")).unwrap();
    // Neither a time nor a distance.
    case.write(
        "wrong.yaml",
        study.replace("distance: \"<s>\", ", "").replace("distance: m, ", ""),
    );
    let said = case.gearloss(&["run", "wrong.yaml", "-o", "results"]);
    assert_ne!(said.code, Some(0), "{}", said.text);
    assert!(
        !said.text.contains("printed above") && said.text.contains("`distance`"),
        "{}",
        said.text
    );
    let counted = said.text.matches("error[").count();
    let plural = if counted == 1 { "" } else { "s" };
    assert!(
        said.text.contains(&format!("\n{counted} error{plural}\n")),
        "{}",
        said.text
    );
}
