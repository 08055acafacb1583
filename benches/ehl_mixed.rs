//! Friction of contacts that warm themselves: one mesh at one point, on the points of the mesh model and on 200, and a drive cycle
//! of 1800 points over both meshes of the two-speed example; both once more by tables, the cycle with building them.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::registry::{Build, Files, Registry};
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::{Case, Transmission};
use gearloss_plugins::path;
use serde_json::{Value, json};

const RPM: f64 = std::f64::consts::PI / 30.0;

fn friction() -> Value {
    json!({ "type": "ehl_mixed", "tau0": "5 MPa", "limiting_slope": 0.055, "mu_b": 0.13 })
}

fn mesh() -> Value {
    json!({ "type": "path_integral", "load_sharing": "ramp", "tooth_friction": friction() })
}

/// The same by a table that holds the torques of the cycle at both stages.
fn tabulated() -> Value {
    json!({ "type": "tabulated", "of": mesh(), "torques": ["0.3 Nm", "400 Nm"] })
}

/// The example with a model in all meshes.
fn gearbox(language: &Language, model: &Value) -> (Gearbox, Choice) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/two-speed-ev/gearbox.yaml");
    let gearbox = Gearbox::read(language, &file).unwrap_or_else(|f| panic!("{}", f.render()));
    let overrides = ["M1", "M2", "M3"].map(|id| (format!("meshes.{id}.model"), model.clone()));
    let choice = Choice {
        overrides: overrides.into(),
        ..Choice::default()
    };
    (gearbox, choice)
}

fn one_mesh(c: &mut Criterion, language: &Language) {
    let (gearbox, choice) = gearbox(language, &tabulated());
    let resolved = gearbox
        .resolve(language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let t = gearbox
        .transmission(language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let (_, part) = t.meshes().next().unwrap();
    let part: Arc<MeshPart> = Arc::new(part.clone());
    let (registry, files) = (Registry::linked().unwrap(), Files::default());
    let mut build = Build::new(&registry, &files);
    let tabulated = &resolved.value["meshes"]["M1"]["model"];
    let model = &tabulated["of"];
    let table = build.slot_at::<GearMesh>("table", &part, tabulated).unwrap();
    let mesh = build.slot_at::<GearMesh>("model", &part, model).unwrap();
    let law = build
        .slot_beside::<ToothFriction, _>("law", &part, &model["tooth_friction"])
        .unwrap();
    let oil = part.oil.as_ref().unwrap().lubricant.at(60.0);
    let at = GearMeshAt::usual(&part, Notes::MUTED).with(|to| {
        to.torque = 50.0;
        to.speed = 4000.0 * RPM;
        to.temperature = 60.0;
        to.nu = oil.nu;
        to.eta = oil.eta;
        to.rho = oil.rho;
        to.alpha = oil.alpha;
        to.beta = oil.beta;
        to.conductivity = oil.conductivity;
    });
    c.bench_function("one mesh with ehl_mixed", |b| {
        b.iter(|| mesh.loss(black_box(&at)).unwrap().sum());
    });
    c.bench_function("one mesh with ehl_mixed, tabulated", |b| {
        b.iter(|| table.loss(black_box(&at)).unwrap().sum());
    });
    let mean = MeanFrictionAt::of(&at, Notes::MUTED);
    let fine = path::Path::even(&part.pair, LoadSharing::Ramp, 200);
    let mut mu = vec![0.0; 200];
    c.bench_function("ehl_mixed on 200 places", |b| {
        b.iter(|| law.along(black_box(&fine.at(&mean, Notes::MUTED)), &mut mu).unwrap());
    });
}

/// Loss summed over a cycle whose torque changes its sign.
fn run(t: &Transmission, case: &Case) -> f64 {
    let mut scratch = t.scratch(case);
    let mut sum = 0.0;
    for i in 0..1800_u32 {
        let phase = f64::from(i) * 0.013;
        let point = Point {
            speeds: &[(4000.0 + 3900.0 * phase.sin()) * RPM],
            torques: &[60.0 * (3.1 * phase).cos()],
            flow: PowerFlow::Real,
            tolerance: Tolerance::default(),
        };
        sum += t
            .evaluate(case, &point, black_box(&[60.0]), &mut scratch)
            .loss()
            .unwrap_or(0.0);
    }
    sum
}

fn cycle(c: &mut Criterion, language: &Language) {
    for (name, model) in [
        ("1800 points with ehl_mixed, one thread", mesh()),
        (
            "1800 points with ehl_mixed, tabulated, with building the tables",
            tabulated(),
        ),
    ] {
        let (gearbox, choice) = gearbox(language, &model);
        let transmission = || {
            gearbox
                .transmission(language, &choice)
                .unwrap_or_else(|f| panic!("{}", f.render()))
        };
        c.bench_function(name, |b| {
            b.iter_batched(
                || {
                    let t = transmission();
                    let case = t.case("first", &[], &["input"]).unwrap();
                    (t, case)
                },
                |(t, case)| run(&t, &case),
                BatchSize::LargeInput,
            );
        });
    }
}

fn all(c: &mut Criterion) {
    let language = Language::new(Registry::linked().unwrap()).unwrap_or_else(|f| panic!("{f:#?}"));
    one_mesh(c, &language);
    cycle(c, &language);
}

criterion_group! { name = benches; config = Criterion::default().sample_size(20); targets = all }
criterion_main!(benches);
