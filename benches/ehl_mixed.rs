//! Thermal elastohydrodynamic friction: one mesh at one point, on the points of the mesh model and on 200, and a drive cycle
//! of 1800 points over both meshes of the two-speed example; both once more by tables, the cycle with building them.
#![allow(clippy::unwrap_used, missing_docs)]

use std::hint::black_box;
use std::sync::Arc;

use crate::common::{RPM, build, language, point, set, with};
use criterion::{BatchSize, Criterion, Throughput, criterion_group};
use gearloss_framework::contact::path;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::geometry::LoadSharing;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Notes;
use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt, MeshPart};
use gearloss_framework::mechanism::mean_friction::MeanFrictionAt;
use gearloss_framework::mechanism::tooth_friction::ToothFriction;
use gearloss_framework::registry::{Build, Files};
use gearloss_framework::resolve::Choice;
use gearloss_framework::transmission::{Case, Transmission};
use serde_json::{Value, json};

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

/// A model in all meshes.
fn in_all(model: &Value) -> Vec<(String, Value)> {
    let meshes = ["M1", "M2", "M3"];
    meshes.map(|id| (format!("meshes.{id}.model"), model.clone())).into()
}

fn one_mesh(c: &mut Criterion, language: &Language, gearbox: &Gearbox) {
    let mut group = c.benchmark_group("ehl_mixed");
    let choice = with(in_all(&tabulated()));
    let resolved = gearbox
        .resolve(language, &choice)
        .unwrap_or_else(|f| panic!("{}", f.render()));
    let t = build(language, gearbox, &choice);
    let (.., part) = t.cylindrical_meshes().next().unwrap();
    let part: Arc<MeshPart> = Arc::new(part.clone());
    let files = Files::default();
    let mut made = Build::new(language.registry(), &files);
    let tabulated = &resolved.value["meshes"]["M1"]["model"];
    let model = &tabulated["of"];
    let table = made.slot_at::<GearMesh>("table", &part, tabulated).unwrap();
    let mesh = made.slot_at::<GearMesh>("model", &part, model).unwrap();
    let law = made
        .slot_beside::<ToothFriction, _>("law", &part, &model["tooth_friction"])
        .unwrap();
    let oil = part.oil.as_ref().unwrap().lubricant.oil_at(60.0);
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
    group.bench_function("one mesh at one point", |b| {
        b.iter(|| mesh.loss(black_box(&at)).unwrap().sum());
    });
    group.bench_function("one mesh at one point, tabulated", |b| {
        b.iter(|| table.loss(black_box(&at)).unwrap().sum());
    });
    let mean = MeanFrictionAt::at_pitch_point(&at, Notes::MUTED);
    let fine = path::Path::even(&part.pair, LoadSharing::Ramp, 200);
    let mut mu = vec![0.0; 200];
    group.throughput(Throughput::Elements(200));
    group.bench_function("one mesh, 200 points of its path", |b| {
        b.iter(|| {
            law.uncut_along(black_box(&fine.at_operating_point(&mean, Notes::MUTED)), &mut mu)
                .unwrap()
        });
    });
    group.finish();
}

/// The set `joint` with this friction in its meshes, at one point.
fn one_point(c: &mut Criterion, language: &Language, gearbox: &Gearbox) {
    let mut choice = set(language, "joint");
    choice.overrides.extend(in_all(&mesh()));
    let t = build(language, gearbox, &choice);
    let case = t.case("first", &[], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let (speeds, torques) = ([8000.0 * RPM], [10.0]);
    let mut group = c.benchmark_group("ehl_mixed");
    group.bench_function("two-speed example, set joint, one point", |b| {
        b.iter(|| {
            let point = point(black_box(&speeds), black_box(&torques));
            t.evaluate(&case, &point, &[100.0], &mut scratch).loss()
        });
    });
    group.finish();
}

/// Points of the cycle.
const POINTS: u32 = 1800;

/// Loss summed over a cycle whose torque changes its sign.
fn run((t, case): (Transmission, Case)) -> f64 {
    let mut scratch = t.scratch(&case);
    let mut sum = 0.0;
    for i in 0..POINTS {
        let phase = f64::from(i) * 0.013;
        let (speeds, torques) = ([(4000.0 + 3900.0 * phase.sin()) * RPM], [60.0 * (3.1 * phase).cos()]);
        let solution = t.evaluate(&case, &point(&speeds, &torques), black_box(&[60.0]), &mut scratch);
        sum += solution.loss().unwrap_or(0.0);
    }
    sum
}

fn cycle(c: &mut Criterion, language: &Language, gearbox: &Gearbox) {
    let made = |choice: &Choice| {
        let t = build(language, gearbox, choice);
        let case = t.case("first", &[], &["input"]).unwrap();
        (t, case)
    };
    let (settled, looked_up) = (with(in_all(&mesh())), with(in_all(&tabulated())));
    let mut group = c.benchmark_group("ehl_mixed");
    group
        .sample_size(20)
        .throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("1800 points, one thread", |b| {
        b.iter_batched(|| made(&settled), run, BatchSize::LargeInput);
    });
    group.bench_function("1800 points, tabulated, with building the tables", |b| {
        b.iter_batched(|| made(&looked_up), run, BatchSize::LargeInput);
    });
    group.finish();
}

fn all(c: &mut Criterion) {
    let language = language();
    let gearbox = crate::common::gearbox(&language, "two-speed-ev");
    one_mesh(c, &language, &gearbox);
    one_point(c, &language, &gearbox);
    cycle(c, &language, &gearbox);
}

criterion_group!(benches, all);
