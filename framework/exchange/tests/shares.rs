//! Loads on the teeth that a model has as results.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// Geometry of the spur stage, from the pinion.
fn pair() -> Pair {
    pair_of(&one_stage("0,100,0"))
}

fn pair_of(model: &Model) -> Pair {
    let (_, transmission) = gearbox(&model.imported().gearbox);
    let (_, _, part) = transmission.cylindrical_meshes().next().unwrap();
    part.pair
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
    let mut values: Vec<String> = values.map(|value| format!("{value:?}")).collect();
    values.push(String::new());
    values.join(",")
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

/// The spur stage with line loads at these points of a gear.
fn with_points(gear: usize, points: &[[f64; 3]], torque: &str) -> Model {
    with_points_of(one_stage("0,100,0"), gear, points, torque)
}

fn with_points_of(mut model: Model, gear: usize, points: &[[f64; 3]], torque: &str) -> Model {
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

/// The spur stage with factors after AGMA 925 over roll angles of the pinion, which has the share `first` at its root.
fn with_factors(gears: [i64; 2], attributes: &str) -> Model {
    let mut model = one_stage("0,100,0");
    model.components.retain(|(id, ..)| *id != 30);
    model.relations.retain(|(kind, _)| kind != "stage");
    model.component(30, "cylindrical_stage", attributes);
    let [first, second] = gears;
    model.relation("stage", &[("stage", 30), ("gear_1", first), ("gear_2", second)]);
    model
}

fn factors(pair: &Pair, first: f64) -> String {
    let [start, .., end] = pair.points;
    let rows = shares(pair, first);
    let angles = list(
        rows.iter()
            .map(|row| (start + row[0] * (end - start)) / pair.base_radius[0]),
    );
    let factors = list(rows.iter().map(|row| row[1]));
    format!(
        "load_sharing_factor_of_calculation_points_agma_925_a03={factors} roll_angles_of_calculation_points_agma_925_a03={angles}"
    )
}

/// Loss of the mesh at the rating, with the tables beside the gearbox and another load sharing if one is given. \[W\]
fn loss(imported: &Imported, sharing: Option<Value>) -> f64 {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    assert!(!imported.shares.is_empty(), "{}", imported.gearbox);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
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
            "the shares are those at 50 Nm and hold for every torque",
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
    assert!(!imported.gearbox.contains("hold for every torque"));
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
    // Cases of known torques and of the opposite sense are counted.
    for (case, torque) in [(3, 50.0), (4, -30.0), (5, -20.0)] {
        let loads = list(points(&pair, 0, 0.5).iter().map(|point| point[2]));
        model.case(
            case,
            &[
                (14, &format!("torque_around_u_axis={torque}")),
                (40, &format!("torque={torque}")),
                (42, &format!("local_normal_line_load={loads}")),
            ],
        );
    }
    let counted = model.imported();
    has(
        &counted.gearbox,
        &[
            "the line loads of 1 load case were not taken: their torques are those of other cases",
            "the line loads of 2 load cases were not taken: their torques have the opposite sense",
        ],
    );
    assert_eq!(counted.shares[0].1, *table);
}

/// Of several data sets the first is taken, and the others are counted.
#[test]
fn one_data_set_stands_for_both_flanks() {
    let pair = pair();
    let of = |points: &[[f64; 3]]| {
        let ids = list((1..=points.len()).map(|id| id as f64));
        format!(
            "set_ids={ids} local_normal_line_load={}",
            list(points.iter().map(|point| point[2]))
        )
    };
    let mut model = with_points(0, &points(&pair, 0, 0.5), "torque=50");
    model
        .component(44, "meshing_contact_stage_data_set", &of(&points(&pair, 0, 0.3)))
        .relation("reference", &[("origin", 41), ("referenced", 44)]);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &["the line loads of meshing_contact_stage_data_set 42 stand for both flanks; 1 further data set left out"],
    );
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
}

/// The stage with a helix of 15 deg and the transverse module of the spur one.
fn helical_stage() -> Model {
    let mut model = one_stage("0,100,0");
    let module = 2.0 * 15_f64.to_radians().cos();
    for (id, _, attributes) in &mut model.components {
        let helix = match *id {
            11 => 15,
            21 => -15,
            _ => continue,
        };
        *attributes = attributes.replace(
            "<attribute id=\"normal_module\">2</attribute>",
            &format!(
                "<attribute id=\"normal_module\">{module}</attribute><attribute id=\"helix_angle_reference_diameter\">{helix}</attribute>"
            ),
        );
    }
    model
}

/// Helical gears have the mean of the line loads over the face.
#[test]
fn helical_gears_have_the_mean_over_the_face() {
    let stage = helical_stage();
    let pair = pair_of(&stage);
    assert!((pair.helix_angle.to_degrees() - 15.0).abs() < 1e-9);
    let even = points(&pair, 0, 0.5);
    // From a half to one and a half of the mean.
    let leaning: Vec<[f64; 3]> = even
        .iter()
        .map(|[r, u, load]| [*r, *u, load * (1.0 + u / 20.0)])
        .collect();
    let [even, leaning] =
        [even, leaning].map(|points| with_points_of(helical_stage(), 0, &points, "torque=50").imported());
    let [(_, even), (_, leaning)] = [&even, &leaning].map(|imported| &imported.shares[0]);
    assert!(even.starts_with("path [-],share [-]\n0,0.5\n"), "{even}");
    assert_eq!(even, leaning);
}

/// Factors after AGMA 925 over roll angles of the pinion, whichever gear of the stage it is.
#[test]
fn factors_after_agma_925_are_shares() {
    let pair = pair();
    let factors = |first: f64| factors(&pair, first);
    let imported = with_factors([11, 21], &factors(0.5)).imported();
    close(loss(&imported, None), loss(&imported, Some(json!("rigid"))), 1e-3);
    let [first, second] = [[11, 21], [21, 11]].map(|gears| with_factors(gears, &factors(0.3)).imported());
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
        let imported = with_factors([11, 21], &attributes).imported();
        has(
            &imported.gearbox,
            &["the load sharing factors of its teeth were not taken", why],
        );
        assert!(imported.shares.is_empty());
    }
    // The first load case counts; those that differ are said.
    let mut model = with_factors([11, 21], "");
    for (case, first) in [(1, 0.5), (2, 0.3), (3, 0.5)] {
        model.case(case, &[(14, "torque_around_u_axis=50"), (30, &factors(first))]);
    }
    let of_cases = model.imported();
    has(
        &of_cases.gearbox,
        &["the factors of 1 further load case differ and were not taken"],
    );
    assert_eq!(of_cases.shares, imported.shares);
}

/// Factors stand in for line loads that cannot be used.
#[test]
fn factors_stand_in_for_line_loads() {
    let pair = pair();
    let mut model = with_points_of(
        with_factors([11, 21], &factors(&pair, 0.5)),
        0,
        &points(&pair, 0, 0.3),
        "",
    );
    let imported = model.imported();
    has(
        &imported.gearbox,
        &["the line loads on its teeth were not taken: `torque` of its cylindrical_stage_gear_data is missing"],
    );
    assert!(imported.shares[0].1.starts_with("path [-],share [-]\n"));
    // With a torque they are preferred, and the factors are not read.
    model.components.retain(|(id, ..)| *id != 40);
    model.component(40, "cylindrical_stage_gear_data", "torque=50");
    let preferred = model.imported();
    assert!(
        preferred.shares[0]
            .1
            .starts_with("path [-],face [-],share [-]\n0,0,0.3\n")
    );
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
            &["cylindrical_stage 30: the line loads on its teeth were not taken", why],
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

/// Line loads of internal teeth and factors of helical teeth are refused; loads of a gearbox with errors wait for the next import.
#[test]
fn loads_of_other_teeth_are_refused() {
    let pair = pair();
    let mut internal = with_points(0, &points(&pair, 0, 0.5), "torque=50");
    for (id, kind, attributes) in &mut internal.components {
        if *id == 21 {
            "ring_gear".clone_into(kind);
        }
        // The wheel's axis is 20 mm from that of the pinion.
        *attributes = attributes.replace("<c>100</c><c>0</c></array>", "<c>20</c><c>0</c></array>");
    }
    let mut helical = helical_stage();
    helical.components.retain(|(id, ..)| *id != 30);
    helical.component(30, "cylindrical_stage", &factors(&pair, 0.5));
    for (model, why) in [
        (internal, "line loads of internal teeth are not read"),
        (
            helical,
            "factors after AGMA 925 are shares of the force only for external spur gears",
        ),
    ] {
        let imported = model.imported();
        has(&imported.gearbox, &["cylindrical_stage 30: the l", why]);
        assert!(imported.shares.is_empty());
    }
    let mut faulty = with_points(0, &points(&pair, 0, 0.5), "torque=50");
    faulty.bearing(15, [10, 2], "70,0,0", "no_direction");
    let imported = faulty.imported();
    has(
        &imported.gearbox,
        &[
            "# To correct before the gearbox can be solved:",
            "# - loads on the teeth are not taken until the errors above are corrected: import again",
        ],
    );
    assert!(imported.shares.is_empty());
}
