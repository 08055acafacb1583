//! The load on the teeth in whole gearboxes: files of both flanks, files that an analysis wrote, and the misalignment by shafts.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use crate::common::{RPM, file, language, study_run};
use gearloss_framework::contact::sharing::ACCURATE;
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::{Findings, Gearbox};
use gearloss_framework::language::Language;
use gearloss_framework::mechanism::Mechanism as _;
use gearloss_framework::mechanism::gear_mesh::GearMesh;
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::Transmission;
use serde_json::{Value, json};

const EXAMPLE: &str = "examples/tip-relief/gearbox.yaml";

/// The stage of the example with some values changed, beside the files of a folder.
fn built(language: &Language, folder: &Path, changes: &[(&str, Value)]) -> Result<Transmission, Findings> {
    let text = std::fs::read_to_string(file(EXAMPLE)).unwrap();
    let gearbox = Gearbox::of_text(language, &text, "gearbox.yaml", folder).unwrap();
    let choice = Choice {
        overrides: changes
            .iter()
            .map(|(path, value)| ((*path).to_owned(), value.clone()))
            .collect(),
        ..Choice::default()
    };
    gearbox.transmission(language, &choice)
}

/// Loss of the mesh and radial loads of the four bearings, at 2250 rpm. \[W, N\]
fn at(t: &Transmission, torque: f64, rpm: f64) -> (f64, [f64; 4]) {
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[rpm * RPM],
        torques: &[torque],
        flow: PowerFlow::Ideal,
        ..Point::default()
    };
    let solution = t.evaluate(&case, &point, &[90.0], &mut scratch);
    let meshes = solution.parts().filter(|(part, _)| part.mechanism == GearMesh::KEY);
    let watts = meshes.map(|(_, loss)| loss.watts()).sum();
    (watts, std::array::from_fn(|support| solution.load(support).radial))
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{value} {expected}");
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gearloss-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn model(load_sharing: Value) -> Value {
    json!({ "type": "path_integral", "load_sharing": load_sharing, "tooth_friction": { "type": "xu" } })
}

const MODEL: &str = "meshes.*.model";
const RATINGS: &str = "ratings.flank_contact.load_sharing";

/// What `contact_path` writes of thin slices has their losses as a file, on both flanks.
#[test]
fn a_file_of_contact_path_has_the_losses_of_its_slices() {
    let language = language();
    let run = study_run("examples/tip-relief/study.yaml");
    let folder = folder("shares");
    let text = std::fs::read_to_string(run.folder.join("contact-shares-relieved.csv")).unwrap();
    assert!(
        text.starts_with("torque [Nm],path [-],face [-],share [-]\n"),
        "{}",
        &text[..80]
    );
    std::fs::write(folder.join("share.csv"), &text).unwrap();
    let sliced = built(&language, &folder, &[]).unwrap();
    let shares = json!({ "type": "file", "path": "share.csv" });
    let from_file = built(&language, &folder, &[(MODEL, model(shares))]).unwrap();
    for torque in [100.0, 200.0, 400.0] {
        for flank in [1.0, -1.0] {
            let [one, other] = [&sliced, &from_file].map(|t| at(t, flank * torque, 2250.0).0);
            // Between the loads at which they were calculated, the losses of the slices are only that accurate.
            close(other, one, ACCURATE);
        }
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// A file with both flanks: the shares of one word on each, whichever gear drives in whichever sense.
#[test]
fn a_file_has_both_flanks() {
    let language = language();
    let folder = folder("flanks");
    let t = built(&language, &folder, &[]).unwrap();
    let (_, _, part) = t.cylindrical_meshes().next().unwrap();
    let pair = part.pair;
    let [start, inner, _, outer, end] = pair
        .points
        .map(|x| (x - pair.points[0]) / (pair.points[4] - pair.points[0]));
    let mut text = "flank,path [-],share [-]\n".to_owned();
    for (flank, low, high) in [("drive", 0.5, 0.5), ("coast", 1.0 / 3.0, 2.0 / 3.0)] {
        let jump = 1e-9;
        let rows = [
            (start, low),
            (inner - jump, high),
            (inner + jump, 1.0),
            (outer - jump, 1.0),
            (outer + jump, high),
            (end, low),
        ];
        for (path, share) in rows {
            text += &format!("{flank},{path},{share}\n");
        }
    }
    std::fs::write(folder.join("share.csv"), &text).unwrap();
    let shares = json!({ "type": "file", "path": "share.csv" });
    let changes = [(MODEL, model(shares.clone())), (RATINGS, shares.clone())];
    let both = built(&language, &folder, &changes).unwrap();
    let word = |word: &str| built(&language, &folder, &[(MODEL, model(json!(word)))]).unwrap();
    let (rigid, third) = (word("rigid"), word("third"));
    for (torque, rpm) in [(200.0, 2250.0), (-200.0, 2250.0), (200.0, -2250.0), (-200.0, -2250.0)] {
        let expected = if torque > 0.0 { &rigid } else { &third };
        close(at(&both, torque, rpm).0, at(expected, torque, rpm).0, 1e-6);
    }
    let mean = json!({ "type": "wimmer", "load_sharing": shares, "mean_friction": { "type": "schlenk" } });
    let refused = built(&language, &folder, &[(MODEL, mean)]).err().unwrap();
    assert!(refused.render().contains("E0353"), "{}", refused.render());
    std::fs::remove_dir_all(folder).unwrap();
}

fn sections(outer: f64) -> Value {
    json!([{ "from": "-10 mm", "to": "200 mm", "outer": format!("{} m", outer) }])
}

/// Two shafts on two rigid bearings, with the mesh off their middle: the slope of a beam under its own load, F a b (b - a)/(3 E I L).
#[test]
fn shafts_misalign_their_mesh() {
    let language = language();
    let folder = folder("shafts");
    let (outer, length, place) = ([30e-3, 40e-3], 0.1, 0.03);
    let mut changes = vec![
        ("meshes.stage.shaft_deflection", json!(true)),
        ("meshes.stage.misalignment", json!("0 um")),
        ("gears.*.at", json!(format!("{place} m"))),
        ("shafts.input.sections", sections(outer[0])),
        ("shafts.output.sections", sections(outer[1])),
    ];
    let t = built(&language, &folder, &changes).unwrap();
    let (_, _, part) = t.cylindrical_meshes().next().unwrap();
    let line_load = 200.0 / part.pair.base_radius[0] / part.pair.facewidth;
    let force = line_load * part.pair.facewidth;
    let far = length - place;
    let slope = |outer: f64| force * place * far * (far - place) / (3.0 * 206e9 * PI * outer.powi(4) / 64.0 * length);
    let expected = (slope(outer[0]) + slope(outer[1])) * part.pair.facewidth;
    close(part.misalignment_under(line_load), expected, 1e-6);
    close(part.misalignment_under(2.0 * line_load), 2.0 * expected, 1e-6);
    // The flanks open towards the end, so that the resultant moves towards the start, where the bearing takes more.
    changes[0].1 = json!(false);
    let rigid = built(&language, &folder, &changes).unwrap();
    let [leaning, straight] = [&t, &rigid].map(|t| at(t, 200.0, 2250.0).1);
    assert!(
        leaning[0] > straight[0] && leaning[1] < straight[1],
        "{leaning:?} {straight:?}"
    );
    close(leaning[0] + leaning[1], straight[0] + straight[1], 1e-9);
    // The same with the slices of a law of mean friction.
    changes[0].1 = json!(true);
    let local = json!({ "type": "local", "load_sharing": { "type": "slices" }, "tooth_friction": { "type": "xu" } });
    let mut of_law = changes.clone();
    of_law.push((MODEL, json!({ "type": "ohlendorf", "mean_friction": local })));
    let of_law = built(&language, &folder, &of_law).unwrap();
    close(at(&of_law, 200.0, 2250.0).1[0], leaning[0], 1e-6);
    // Softer bearings of the pinion at its end turn it by their deflection as well.
    let stiffness = 1e8;
    changes.push(("bearings.B2.radial_stiffness", json!(format!("{stiffness} N/m"))));
    let soft = built(&language, &folder, &changes).unwrap();
    let (_, _, part) = soft.cylindrical_meshes().next().unwrap();
    let turned = force * place / length / stiffness / length * part.pair.facewidth;
    close(part.misalignment_under(line_load), expected + turned, 1e-6);
    std::fs::remove_dir_all(folder).unwrap();
}

/// A helical stage in the middle of both shafts, turning forwards from y to -y: only the moments of the thrust bend them at the mesh. Thrust pushes
/// a driving pinion with right hand forwards, so that the moments F_a r turn both gears about z, by F_a r L/(12 E I). The pinion, whose shaft is
/// thin, turns more: its end at greater x leaves the wheel, by sin alpha in the plane of action, and the other end carries more. There contact
/// ends, so the start of the face is what opens. With left hand all is mirrored.
#[test]
fn thrust_of_helical_gears_opens_the_end_that_it_pushes_forwards() {
    let language = language();
    let (outer, length) = ([25e-3, 60e-3], 0.1);
    let [z1, z2, module, helix, facewidth] = [20.0, 40.0, 3.0, 20_f64.to_radians(), 30e-3];
    let text = |hand: &str, deflects: bool| {
        let distance = 0.5 * (z1 + z2) * module / helix.cos();
        let section = |outer: f64| format!("[{{ from: -10 mm, to: 110 mm, outer: {outer} m }}]");
        let bearings: String = [("input", 1), ("output", 3)]
            .map(|(shaft, first)| {
                format!(
                    "  B{first}: {{ shaft: {shaft}, at: 0 mm, designation: \"6208\", axial: both }}\n  \
                       B{}: {{ shaft: {shaft}, at: {length} m, designation: \"6208\", axial: none }}\n",
                    first + 1
                )
            })
            .concat();
        format!(
            "gearloss: gearbox/1\nports: {{ input: input, output: output }}\nrating: {{ torque: 100 Nm, speed: 1500 rpm }}\n\
             shafts:\n  input: {{ axis: [{distance} mm, 0 mm], sections: {} }}\n  output: {{ axis: [0 mm, 0 mm], sections: {} }}\n\
             gears:\n  pinion: {{ shaft: input, at: 50 mm, z: {z1}, facewidth: {facewidth} m, hand: {hand} }}\n  \
             wheel: {{ shaft: output, at: 50 mm, z: {z2}, facewidth: {facewidth} m }}\n\
             meshes:\n  stage: {{ gears: [pinion, wheel], normal_module: {module} mm, pressure_angle: 20 deg, helix_angle: {helix} rad, \
             shaft_deflection: {deflects} }}\nsurface: {{ ra: 0.4 um }}\nbearings:\n{bearings}lubricants: {{ sump: {{ designation: ISO VG 100 mineral }} }}\n\
             housing: {{ oil: {{ lubricant: sump }} }}\nthermal: {{ oil: 90 degC }}\n\
             models:\n  gear_mesh: {{ type: path_integral, load_sharing: {{ type: slices }}, tooth_friction: {{ type: xu }} }}\n  bearing: {{ type: skf }}\n",
            section(outer[0]),
            section(outer[1])
        )
    };
    let built = |hand: &str, deflects: bool| {
        let gearbox = Gearbox::of_text(&language, &text(hand, deflects), "gearbox.yaml", "")
            .unwrap_or_else(|found| panic!("{}", found.render()));
        gearbox
            .transmission(&language, &Choice::default())
            .unwrap_or_else(|found| panic!("{}", found.render()))
    };
    for (hand, near, far) in [("right", 0, 1), ("left", 1, 0)] {
        let t = built(hand, true);
        let (_, _, part) = t.cylindrical_meshes().next().unwrap();
        let pair = &part.pair;
        let thrust = 100.0 / pair.working_radius[0] * pair.working_helix.tan();
        let turn = |gear: usize| {
            let inertia = PI * outer[gear].powi(4) / 64.0;
            thrust * pair.working_radius[gear] * length / (12.0 * 206e9 * inertia)
        };
        assert!(turn(0) > turn(1));
        let opening = (turn(0) - turn(1)) * pair.working_angle.sin() * pair.facewidth;
        let line_load = 100.0 / pair.base_radius[0] / pair.facewidth;
        close(part.misalignment_under(line_load), -opening, 1e-6);
        let [leaning, straight] = [&t, &built(hand, false)].map(|t| at(t, 100.0, 1500.0).1);
        assert!(
            leaning[near] > straight[near] && leaning[far] < straight[far],
            "{hand}: {leaning:?} {straight:?}"
        );
    }
}

#[test]
fn misalignments_that_nothing_takes_are_reported() {
    let language = language();
    let folder = folder("unused");
    let mut changes = vec![
        ("meshes.stage.shaft_deflection", json!(true)),
        ("shafts.input.sections", sections(30e-3)),
        ("shafts.output.sections", sections(40e-3)),
        (MODEL, model(json!("ramp"))),
    ];
    let reported = |changes: &[(&str, Value)]| -> Vec<String> {
        let t = built(&language, &folder, changes).unwrap_or_else(|found| panic!("{}", found.render()));
        let unused = t
            .warnings
            .iter()
            .filter(|warning| warning.to_string().contains("has no effect"));
        unused.map(|warning| warning.path.clone()).collect()
    };
    // The rating of the example has thin slices.
    assert!(reported(&changes).is_empty());
    changes.push((RATINGS, json!("ramp")));
    let unused = ["meshes.stage.shaft_deflection", "meshes.stage.misalignment"];
    assert_eq!(reported(&changes), unused);
    changes[3].1 = model(json!({ "type": "slices" }));
    assert!(reported(&changes).is_empty());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn shafts_without_what_their_deflection_needs_are_named() {
    let language = language();
    let folder = folder("no-sections");
    let wanted = ("meshes.stage.shaft_deflection", json!(true));
    let fault = |changes: &[(&str, Value)]| built(&language, &folder, changes).err().unwrap().render();
    let missing = fault(std::slice::from_ref(&wanted));
    assert!(
        missing.contains("E0352") && missing.contains("`input` has no diameter"),
        "{missing}"
    );
    std::fs::remove_dir_all(folder).unwrap();
}
