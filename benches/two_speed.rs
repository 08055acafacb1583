//! The two-speed example: reading, building, and one point under each set of models.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::registry::Registry;
use gearloss_framework::resolve::Choice;
use gearloss_plugins as _;

/// The sets `iso` and `joint` of the study, which count gears, churning and bearings only.
const SETS: &str = "
model_sets:
  iso:
    gear_mesh: { type: iso14179_2, x_l: 1.0, clamp_line_load: true }
    gear_drag: { churning: { type: iso14179_2, speed_of: pinion } }
    bearing: { type: iso14179_2 }
    seal: none
    synchronizer: none
  joint_of_study:
    gear_mesh: { type: path_integral, load_sharing: rigid, tooth_friction: { type: xu } }
    gear_drag: { churning: { type: changenet_2011 } }
    bearing: { type: skf, edition: \"2013\", mu_bl: 0.15 }
    seal: none
    synchronizer: none
";

fn two_speed(c: &mut Criterion) {
    let language = Language::new(Registry::linked().unwrap()).unwrap_or_else(|f| panic!("{f:#?}"));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/two-speed-ev");
    let text = std::fs::read_to_string(folder.join("gearbox.yaml")).unwrap() + SETS;
    c.bench_function("YAML to walked document", |b| {
        b.iter(|| Gearbox::of_text(&language, black_box(&text), "gearbox.yaml", &folder).unwrap());
    });
    let gearbox = Gearbox::of_text(&language, &text, "gearbox.yaml", &folder).unwrap();
    c.bench_function("walked document to transmission", |b| {
        b.iter(|| gearbox.transmission(&language, black_box(&Choice::default())).unwrap());
    });
    for (name, set) in [("iso", "iso"), ("joint", "joint_of_study")] {
        let t = gearbox
            .transmission(
                &language,
                &Choice {
                    set: Some(set.to_owned()),
                    ..Choice::default()
                },
            )
            .unwrap();
        let case = t.case("first", &[], &["input"]).unwrap();
        let mut scratch = t.scratch(&case);
        c.bench_function(&format!("one point, {name}"), |b| {
            b.iter(|| {
                let point = Point {
                    speeds: black_box(&[837.758]),
                    torques: black_box(&[10.0]),
                    flow: PowerFlow::Real,
                    tolerance: Tolerance::default(),
                };
                t.evaluate(&case, &point, &[100.0], &mut scratch).loss()
            });
        });
    }
}

criterion_group!(benches, two_speed);
criterion_main!(benches);
