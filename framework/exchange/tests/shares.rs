//! Loads on the teeth that a model has as results.

use std::path::Path;

use gearloss_exchange::rexs::Imported;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::geometry::Pair;
use gearloss_framework::mechanism::Mechanism as _;
use gearloss_framework::mechanism::gear_mesh::GearMesh;
use gearloss_framework::resolve::Choice;
use serde_json::{Value, json};

use crate::common::{gearbox, language};
use crate::written::{Model, has, one_stage};

const TORQUE: f64 = 50.0;

/// Geometry of the stage, from the pinion.
fn pair() -> Pair {
    let (_, transmission) = gearbox(&one_stage("0,100,0").imported().gearbox);
    let (_, _, part) = transmission.cylindrical_meshes().next().unwrap();
    part.pair.clone()
}

/// Places on the path of contact and shares there: two pairs of teeth share as stated, the first of them at the root of the pinion.
fn shares(pair: &Pair, first: f64) -> Vec<[f64; 2]> {
    let [start, .., end] = pair.points;
    let [_, inner, _, outer, _] = pair.points.map(|x| (x - start) / (end - start));
    let jump = 5e-5;
    vec![
        [0.0, first],
        [inner - jump, first],
        [inner + jump, 1.0],
        [0.5 * (inner + outer), 1.0],
        [outer - jump, 1.0],
        [outer + jump, 1.0 - first],
        [1.0, 1.0 - first],
    ]
}

fn list(values: impl Iterator<Item = f64>) -> String {
    values.map(|value| format!("{value:?},")).collect()
}

/// The points of a grid of seven radii and three positions along the face: radius on a gear and u. \[mm\]
fn points(pair: &Pair, gear: usize, first: f64) -> Vec<[f64; 3]> {
    let [start, .., end] = pair.points;
    let force = TORQUE / pair.base_radius[0] / (pair.facewidth * 1e3);
    let place = |[path, share]: [f64; 2]| {
        let x = start + path * (end - start);
        let own = if gear == 0 { x } else { pair.tangent_length - x };
        let radius = own.hypot(pair.base_radius[gear]) * 1e3;
        [-10.0, 0.0, 10.0].map(|u| [radius, u, share * force])
    };
    shares(pair, first).into_iter().flat_map(place).collect()
}

/// The stage with line loads at these points of a gear.
fn with_points(gear: usize, points: &[[f64; 3]], torque: &str) -> Model {
    let mut model = one_stage("0,100,0");
    let column = |i: usize| list(points.iter().map(|point| point[i]));
    let ids = list((1..=points.len()).map(|id| id as f64));
    model
        .component(40, "cylindrical_stage_gear_data", torque)
        .component(43, "cylindrical_stage_gear_data", "")
        .relation(
            "stage_gear_data",
            &[("stage", 30), ("gear", 11), ("stage_gear_data", 40)],
        )
        .relation(
            "stage_gear_data",
            &[("stage", 30), ("gear", 21), ("stage_gear_data", 43)],
        )
        .component(
            41,
            "point_list",
            &format!(
                "point_ids={ids} point_coordinates_radius={} point_coordinates_u_coord={}",
                column(0),
                column(1)
            ),
        )
        .relation("assembly", &[("assembly", [40, 43][gear]), ("part", 41)])
        .component(
            42,
            "meshing_contact_stage_data_set",
            &format!("set_ids={ids} local_normal_line_load={}", column(2)),
        )
        .relation("reference", &[("origin", 41), ("referenced", 42)]);
    model
}

/// Loss of the mesh at the rating, with the tables beside the gearbox and another load sharing if one is given. \[W\]
fn loss(imported: &Imported, sharing: Option<Value>) -> f64 {
    assert!(!imported.shares.is_empty(), "{}", imported.gearbox);
    static NUMBER: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("gearloss-rexs-shares-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in &imported.shares {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let loss = loss_in(&folder, imported, sharing);
    std::fs::remove_dir_all(folder).unwrap();
    loss
}

fn loss_in(folder: &Path, imported: &Imported, sharing: Option<Value>) -> f64 {
    let read = Gearbox::of_text(language(), &imported.gearbox, "gearbox.yaml", folder);
    let overrides = sharing.map(|value| ("meshes.stage_30.model.load_sharing".to_owned(), value));
    let choice = Choice {
        overrides: overrides.into_iter().collect(),
        ..Choice::default()
    };
    let built = read.and_then(|gearbox| gearbox.transmission(language(), &choice));
    let transmission = built.unwrap_or_else(|found| panic!("{}", found.render()));
    let watts = transmission.at_rating(0, |solution| {
        let meshes = solution.parts().filter(|(part, _)| part.mechanism == GearMesh::KEY);
        meshes.map(|(_, loss)| loss.watts()).sum()
    });
    watts.unwrap()
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() < tolerance, "{value} {expected}");
}

/// Points of either gear, with arrays or a matrix of coordinates, give the shares they were made of.
#[test]
fn line_loads_of_points_are_the_shares_of_their_mesh() {
    let pair = pair();
    let imported = with_points(0, &points(&pair, 0, 0.5), "torque=50").imported();
    has(
        &imported.gearbox,
        &[
            "model: { type: path_integral, load_sharing: { type: file, path: shares_stage_30.csv }, tooth_friction: { type: xu } }",
            "# - stage_30: its loss is integrated along the path of contact",
        ],
    );
    let (name, table) = &imported.shares[0];
    assert_eq!(name, "shares_stage_30.csv");
    assert!(
        table.starts_with("path [-],face [-],share [-]\n0,0,0.5\n0,0.5,0.5\n"),
        "{table}"
    );
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
    // Where the two gears of the file stand does not matter, and unequal shares are not turned around.
    let [first, second] = [0, 1].map(|gear| with_points(gear, &points(&pair, gear, 0.3), "torque=-50").imported());
    close(loss(&first, None), loss(&second, None), 1e-6);
    let reversed = with_points(0, &points(&pair, 0, 0.7), "torque=50").imported();
    assert!((loss(&reversed, None) / loss(&first, None) - 1.0).abs() > 1e-3);
    let mut model = with_points(0, &points(&pair, 0, 0.3), "torque=50");
    let rows: Vec<String> = (points(&pair, 0, 0.3).iter())
        .map(|[radius, u, _]| format!("{u:?},{:?},{:?}", 0.6 * radius, 0.8 * radius))
        .collect();
    let ids = list((1..=rows.len()).map(|id| id as f64));
    model.components.retain(|(id, ..)| *id != 41);
    model.component(
        41,
        "point_list",
        &format!("point_ids={ids} point_coordinates={}", rows.join("|")),
    );
    close(loss(&model.imported(), None), loss(&first, None), 1e-6);
}

/// Load cases with their own line loads and torques are one table.
#[test]
fn load_cases_are_torques_of_the_table() {
    let pair = pair();
    let mut model = with_points(0, &points(&pair, 0, 0.5), "");
    for (case, factor) in [(1, 1.0), (2, 0.5)] {
        let loads = list(points(&pair, 0, 0.5).iter().map(|point| factor * point[2]));
        let torque = factor * TORQUE;
        model.case(
            case,
            &[
                (14, &format!("torque_around_u_axis={torque}")),
                (40, &format!("torque={torque}")),
                (42, &format!("local_normal_line_load={loads}")),
            ],
        );
    }
    let imported = model.imported();
    let table = &imported.shares[0].1;
    assert!(table.contains("\n25,0,0,") && table.contains("\n50,1,1,"), "{table}");
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
}

/// Factors after AGMA 925 over roll angles of the pinion, whichever gear of the stage it is.
#[test]
fn factors_after_agma_925_are_shares() {
    let pair = pair();
    let [start, .., end] = pair.points;
    let factors = |first: f64| {
        let rows = shares(&pair, first);
        let angles = list(
            rows.iter()
                .map(|row| (start + row[0] * (end - start)) / pair.base_radius[0]),
        );
        let factors = list(rows.iter().map(|row| row[1]));
        format!(
            "load_sharing_factor_of_calculation_points_agma_925_a03={factors} roll_angles_of_calculation_points_agma_925_a03={angles}"
        )
    };
    let stage = |gears: [i64; 2], attributes: &str| {
        let mut model = one_stage("0,100,0");
        model.components.retain(|(id, ..)| *id != 30);
        model.relations.retain(|(kind, _)| kind != "stage");
        model.component(30, "cylindrical_stage", attributes);
        let [first, second] = gears;
        model.relation("stage", &[("stage", 30), ("gear_1", first), ("gear_2", second)]);
        model
    };
    let imported = stage([11, 21], &factors(0.5)).imported();
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
    let [first, second] = [[11, 21], [21, 11]].map(|gears| stage(gears, &factors(0.3)).imported());
    close(loss(&first, None), loss(&second, None), 1e-6);
    for (attributes, why) in [
        (
            factors(0.5).replace("roll_angles", "other_angles"),
            "so their places are not known",
        ),
        (
            factors(0.5).replace(
                "calculation_points_agma_925_a03=",
                "calculation_points_agma_925_a03=0.1,",
            ),
            "of the path of contact",
        ),
    ] {
        let imported = stage([11, 21], &attributes).imported();
        has(&imported.gearbox, &["the loads on its teeth were not taken", why]);
        assert!(imported.shares.is_empty());
    }
}

/// Loads that do not carry the force, or whose place or force is not known, are not taken, and the report says why.
#[test]
fn loads_that_cannot_be_used_are_named() {
    let pair = pair();
    let good = points(&pair, 0, 0.5);
    let changed = |change: &dyn Fn(&mut Vec<[f64; 3]>)| {
        let mut points = good.clone();
        change(&mut points);
        points
    };
    let heavy = changed(&|points| points.iter_mut().for_each(|point| point[2] *= 1.1));
    let gap = changed(&|points| {
        points.remove(4);
    });
    let beside = changed(&|points| points[0][1] = -12.0);
    for (points, torque, why) in [
        (&heavy, "torque=50", "the shares of all pairs add up to 1.1"),
        (&good, "", "the force is not known"),
        (&gap, "torque=50", "its 20 points are no grid"),
        (&beside, "torque=50", "of the common face"),
    ] {
        let imported = with_points(0, points, torque).imported();
        has(
            &imported.gearbox,
            &["cylindrical_stage 30: the loads on its teeth were not taken", why],
        );
        assert!(imported.shares.is_empty() && !imported.gearbox.contains("path_integral"));
    }
    let mut unknown = with_points(0, &good, "torque=50");
    unknown.components.iter_mut().for_each(|(id, _, text)| {
        if *id == 42 {
            *text = text.replacen("<c>1.0</c>", "<c>99</c>", 1);
        }
    });
    has(
        &unknown.imported().gearbox,
        &["the point 99 of meshing_contact_stage_data_set 42 is not in its point_list"],
    );
}
