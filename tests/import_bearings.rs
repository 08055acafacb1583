//! `import bearings` as a user calls it: its catalogue is read by `catalogue` and by a gearbox.

use std::path::{Path, PathBuf};
use std::process::Command;

const TABLE: &str = "\
Kurzzeichen;Bohrung d [mm];Außendurchmesser D [mm];Breite B [mm];Dynamische Tragzahl C [kN];Statische Tragzahl C0 [kN];Gewicht [kg]
W 100;30;62;16;20,3;11,2;0,2
W 200;30;62;16;20,3;11,2;0,2
falsch;62;30;16;20,3;11,2;0,2
";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("import-bearings-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn called(folder: &Path, args: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, err)
}

#[test]
fn a_makers_table_becomes_a_catalogue_of_a_gearbox() {
    let folder = folder("table");
    std::fs::write(folder.join("maker.csv"), TABLE).unwrap();
    let args = ["import", "bearings", "maker.csv", "--kind", "deep_groove_ball"];
    let (code, out, err) = called(&folder, &args);
    assert_eq!(code, Some(0), "{err}");
    assert!(
        out.contains("wrote maker-catalogue.csv") && out.contains("decimal comma"),
        "{out}"
    );
    assert!(
        out.contains("- c [N] from `Dynamische Tragzahl C`: 2 of 2 bearings"),
        "{out}"
    );
    assert!(
        out.contains("Not used: Gewicht") && out.contains("- pu of 2 bearings"),
        "{out}"
    );
    assert!(
        err.contains("line 4: `falsch`: the outside diameter 30 mm is not larger than the bore 62 mm"),
        "{err}"
    );
    let (code, out, _) = called(
        &folder,
        &["catalogue", "bearings", "W 2", "--file", "maker-catalogue.csv"],
    );
    assert!(
        code == Some(0) && out.contains("20300 N") && out.contains("maker.csv, line 3"),
        "{out}"
    );
    // Nothing is overwritten.
    let (code, _, err) = called(&folder, &args);
    assert!(code == Some(2) && err.contains("maker-catalogue.csv exists"), "{err}");
    let gearbox = "\
gearloss: gearbox/1
catalogues: { bearings: maker-catalogue.csv }
lubricants: { oil: { designation: ISO VG 220 mineral } }
shafts: { s: { axis: [0 mm, 0 mm] } }
bearings:
  a: { shaft: s, at: 0 mm, designation: W 100, axial: both, oil: oil }
  b: { shaft: s, at: 100 mm, designation: W 200, axial: none, oil: oil }
";
    std::fs::write(folder.join("gearbox.yaml"), gearbox).unwrap();
    let (_, out, err) = called(&folder, &["check", "--resolved", "gearbox.yaml"]);
    let text = out + &err;
    assert!(!text.contains("no catalogue has"), "{text}");
}

#[test]
fn an_unknown_table_says_what_to_state() {
    let folder = folder("unknown");
    std::fs::write(folder.join("a.csv"), "Art,inner,outer\nX,30,62\n").unwrap();
    let (code, _, err) = called(&folder, &["import", "bearings", "a.csv"]);
    assert_eq!(code, Some(2));
    assert!(
        err.contains("E0806") && err.contains("no heading is known as `bore`"),
        "{err}"
    );
    assert!(err.contains("--columns \"bore=HEADING\""), "{err}");
    assert!(!folder.join("a-catalogue.csv").exists());
    let args = [
        "--columns",
        "designation=Art",
        "--columns",
        "d=inner [mm]",
        "--columns",
        "D=outer [mm]",
        "-o",
        "own.csv",
    ];
    let (code, _, err) = called(&folder, &[&["import", "bearings", "a.csv"], &args[..]].concat());
    assert_eq!(code, Some(0), "{err}");
    assert!(
        std::fs::read_to_string(folder.join("own.csv"))
            .unwrap()
            .contains("X,30,62,")
    );
}

/// A gearbox with a catalogue and the bearings of its input.
fn gearbox_with(catalogue: &str, [left, right]: [&str; 2]) -> String {
    format!(
        "gearloss: gearbox/1
catalogues: {{ bearings: {catalogue} }}
ports: {{ input: a, output: b }}
shafts: {{ a: {{ axis: [0 mm, 0 mm] }}, b: {{ axis: [60 mm, 0 mm] }} }}
gears:
  pinion: {{ shaft: a, at: 30 mm, z: 20, facewidth: 20 mm }}
  wheel: {{ shaft: b, at: 30 mm, z: 40, facewidth: 20 mm }}
meshes: {{ stage: {{ gears: [pinion, wheel], normal_module: 2 mm, centre_distance: 60 mm }} }}
bearings:
  left: {{ shaft: a, at: 0 mm, designation: {left}, axial: both }}
  right: {{ shaft: a, at: 60 mm, designation: {right} }}
  left_out: {{ shaft: b, at: 0 mm, designation: \"6206\", axial: both }}
  right_out: {{ shaft: b, at: 60 mm, designation: \"6206\" }}
lubricants: {{ oil: {{ designation: ISO VG 220 mineral }} }}
"
    )
}

#[test]
fn a_folder_of_catalogues_is_read_whole_and_has_precedence() {
    let folder = folder("makers");
    std::fs::create_dir_all(folder.join("makers/old")).unwrap();
    let head = "designation,kind,series,bore [mm],outside [mm],width [mm],c [N],c0 [N]\n";
    let put = |name: &str, rows: &str| std::fs::write(folder.join(name), format!("{head}{rows}")).unwrap();
    put("makers/a.csv", "6208,deep_groove_ball,62,40,80,18,35800,20800\n");
    put("makers/b.csv", "W 200,deep_groove_ball,62,30,62,16,20300,11200\n");
    put("makers/old/c.csv", "6208,deep_groove_ball,62,40,80,18,1,1\n");
    std::fs::write(folder.join("makers/readme.txt"), "no table").unwrap();
    std::fs::write(
        folder.join("gearbox.yaml"),
        gearbox_with("makers/", ["W 200-2Z", "6208/C3"]),
    )
    .unwrap();
    let (_, out, err) = called(&folder, &["check", "--resolved", "gearbox.yaml"]);
    let text = out + &err;
    assert!(
        text.contains("35800") && text.contains("20300") && !text.contains("no catalogue has"),
        "{text}"
    );
    let (code, out, err) = called(&folder, &["catalogue", "bearings", "--file", "makers"]);
    assert_eq!(code, Some(0), "{err}");
    assert!(out.contains("35800 N") && out.contains("W 200"), "{out}");

    // Two files with one designation, and a folder that is none.
    put("makers/b.csv", "6208,deep_groove_ball,62,40,80,18,35800,20800\n");
    let (code, _, err) = called(&folder, &["check", "gearbox.yaml"]);
    assert_eq!(code, Some(2));
    assert!(
        err.contains("makers/b.csv: makers/a.csv has `6208`, too") && err.contains("gearbox.yaml:2:"),
        "{err}"
    );
    for (name, message) in [
        ("nowhere/", "cannot list"),
        ("makers/old/../", "too"),
        ("makers", "it is a folder, not a file"),
    ] {
        std::fs::write(folder.join("gearbox.yaml"), gearbox_with(name, ["6208/C3", "6208/C3"])).unwrap();
        let (code, _, err) = called(&folder, &["check", "gearbox.yaml"]);
        assert!(code == Some(2) && err.contains(message), "{name}: {err}");
        assert!(err.contains("a name that ends with `/` is a folder of tables"), "{err}");
    }
}
