//! Models written here, for what the public ones do not have: loose gears with clutches, several gears and spectra, shafts that are turned
//! around, other axes, idle shafts.

use gearloss_exchange::rexs::{Imported, import};
use gearloss_framework::evaluate::Point;

use crate::common::{gearbox, language};

/// A model that is put together.
#[derive(Default)]
pub struct Model {
    pub components: Vec<(i64, String, String)>,
    pub relations: Vec<(String, Vec<(String, i64)>)>,
    cases: String,
}

impl Model {
    fn new() -> Self {
        let mut model = Self::default();
        model.component(1, "gear_unit", "");
        model.component(2, "gear_casing", "");
        model
    }

    /// A component with attributes such as `face_width=20`; vectors have commas, lists semicolons, rows of matrices bars between them.
    pub fn component(&mut self, id: i64, kind: &str, attributes: &str) -> &mut Self {
        self.components.push((id, kind.to_owned(), attributes_of(attributes)));
        self
    }

    pub fn relation(&mut self, kind: &str, refs: &[(&str, i64)]) -> &mut Self {
        let refs = refs.iter().map(|(role, id)| ((*role).to_owned(), *id)).collect();
        self.relations.push((kind.to_owned(), refs));
        self
    }

    fn shaft(&mut self, id: i64, at: &str, more: &str) -> &mut Self {
        self.component(id, "shaft", &format!("{} {more}", place(at)))
    }

    /// A gear on a shaft, or of its own.
    fn gear(&mut self, id: i64, shaft: Option<i64>, at: &str, data: &str) -> &mut Self {
        self.component(
            id,
            "cylindrical_gear",
            &format!("{} face_width=20 normal_module=2 {data}", place(at)),
        );
        if let Some(shaft) = shaft {
            self.relation("assembly", &[("assembly", shaft), ("part", id)]);
        }
        self
    }

    pub fn stage(&mut self, id: i64, gears: [i64; 2]) -> &mut Self {
        self.component(id, "cylindrical_stage", "");
        self.relation("stage", &[("stage", id), ("gear_1", gears[0]), ("gear_2", gears[1])])
    }

    pub fn bearing(&mut self, id: i64, sides: [i64; 2], at: &str, axial: &str) -> &mut Self {
        let data = "bearing_type=radial_grooved_ball_bearing catalogue_designation=6206";
        self.component(
            id,
            "rolling_bearing_with_catalog_geometry",
            &format!("{} {data} axial_force_absorption={axial}", place(at)),
        );
        self.relation(
            "side",
            &[("assembly", id), ("inner_part", sides[0]), ("outer_part", sides[1])],
        )
    }

    pub fn load(&mut self, id: i64, shaft: i64, data: &str) -> &mut Self {
        self.component(
            id,
            "external_load",
            &format!("transmits_torque=true u_coordinate_on_shaft=0 {data}"),
        );
        self.relation("assembly", &[("assembly", shaft), ("part", id)])
    }

    /// A load case of the first spectrum.
    pub fn case(&mut self, id: i64, values: &[(i64, &str)]) -> &mut Self {
        self.cases.push_str(&format!("<load_case id=\"{id}\">"));
        for (component, attributes) in values {
            let attributes = attributes_of(attributes);
            self.cases.push_str(&format!(
                "<component id=\"{component}\" type=\"any\">{attributes}</component>"
            ));
        }
        self.cases.push_str("</load_case>");
        self
    }

    fn xml(&self) -> String {
        let mut text = "<model version=\"1.6\" applicationId=\"test\"><relations>".to_owned();
        for (id, (kind, refs)) in self.relations.iter().enumerate() {
            text.push_str(&format!("<relation id=\"{id}\" type=\"{kind}\">"));
            for (role, id) in refs {
                text.push_str(&format!("<ref role=\"{role}\" id=\"{id}\"/>"));
            }
            text.push_str("</relation>");
        }
        text.push_str("</relations><components>\n");
        for (id, kind, attributes) in &self.components {
            text.push_str(&format!(
                "<component id=\"{id}\" type=\"{kind}\">{attributes}</component>\n"
            ));
        }
        text.push_str("</components>");
        if !self.cases.is_empty() {
            text.push_str(&format!("<load_spectrum id=\"1\">{}</load_spectrum>", self.cases));
        }
        text + "</model>"
    }

    pub fn imported(&self) -> Imported {
        import(self.xml().as_bytes(), "model.rexs", language()).unwrap_or_else(|found| panic!("{}", found.render()))
    }

    pub fn refused(&self) -> String {
        match import(self.xml().as_bytes(), "model.rexs", language()) {
            Ok(imported) => panic!("{}", imported.gearbox),
            Err(found) => found.render(),
        }
    }
}

/// Position with the axes u and w, each three numbers: `0,0,0`, or `0,0,0/1,0,0/0,0,1`.
fn place(at: &str) -> String {
    let mut parts = at.split('/');
    let origin = parts.next().unwrap();
    let u = parts.next().unwrap_or("1,0,0");
    let w = parts.next().unwrap_or("0,0,1");
    format!("support_vector={origin} u_axis_vector={u} w_axis_vector={w} reference_component_for_position=1")
}

fn attributes_of(text: &str) -> String {
    let mut all = String::new();
    for attribute in text.split_whitespace() {
        let (id, value) = attribute.split_once('=').unwrap();
        let cells = |value: &str| {
            let cells = value.split([',', ';']).filter(|cell| !cell.is_empty());
            let cells: Vec<String> = cells.map(|cell| format!("<c>{cell}</c>")).collect();
            cells.concat()
        };
        let value = if value.contains('|') {
            let rows: Vec<String> = value.split('|').map(|row| format!("<r>{}</r>", cells(row))).collect();
            format!("<matrix>{}</matrix>", rows.concat())
        } else if value.contains([',', ';']) {
            format!("<array>{}</array>", cells(value))
        } else {
            value.to_owned()
        };
        all.push_str(&format!("<attribute id=\"{id}\">{value}</attribute>"));
    }
    all
}

/// One stage: shafts 10 and 20, 100 mm apart.
pub fn one_stage(second: &str) -> Model {
    let mut model = Model::new();
    model
        .shaft(10, "0,0,0", "defines_speed=true rotational_speed=1000")
        .shaft(20, second, "")
        .gear(11, Some(10), "50,0,0", "number_of_teeth=40")
        .gear(21, Some(20), "50,100,0", "number_of_teeth=60")
        .stage(30, [11, 21])
        .bearing(12, [10, 2], "0,0,0", "both_directions")
        .bearing(13, [10, 2], "100,0,0", "no_direction")
        .bearing(22, [20, 2], "0,100,0", "both_directions")
        .bearing(23, [20, 2], "100,100,0", "no_direction")
        .load(14, 10, "defines_torque=true torque_around_u_axis=50")
        .load(24, 20, "");
    model
}

pub fn has(text: &str, lines: &[&str]) {
    for line in lines {
        assert!(text.contains(line), "`{line}` is not in\n{text}");
    }
}

#[test]
fn a_stage_is_complete() {
    let imported = one_stage("0,100,0").imported();
    has(
        &imported.gearbox,
        &[
            "ports: { input: shaft_10, output: shaft_20 }",
            "rating: { torque: 50 Nm, speed: 1000 rpm }",
            "shaft_20: { axis: [100 mm, 0 mm] }",
            "stage_30: { gears: [gear_11, gear_21], normal_module: 2 mm, pressure_angle: 20 deg }",
            "bearing_12: { shaft: shaft_10, at: 0 mm, designation: \"6206\", axial: both }",
        ],
    );
    assert!(
        imported
            .load_cases
            .unwrap()
            .ends_with("name,torque [Nm],speed [rpm]\n1,50,1000\n")
    );
    let (_, transmission) = gearbox(&imported.gearbox);
    assert!(transmission.warnings.is_empty());
}

/// Torque that brakes the shaft with the given speed leaves there.
#[test]
fn the_port_that_brakes_is_the_output() {
    let mut model = one_stage("0,100,0");
    model.components.iter_mut().for_each(|(id, _, attributes)| {
        if *id == 14 {
            *attributes = attributes.replace(">50<", ">-50<");
        }
    });
    let imported = model.imported();
    has(&imported.gearbox, &["ports: { input: shaft_20, output: shaft_10 }"]);
    has(
        imported.study.as_deref().unwrap(),
        &["torque_at: output", "speed_at: output"],
    );
}

/// A shaft whose u axis points backwards: speeds, torques, sections, thrust and forces change their sign with it.
#[test]
fn shafts_may_be_turned_around() {
    let mut model = one_stage("100,100,0/-1,0,0/0,0,1");
    model
        .component(25, "shaft_section", "u_coordinate_on_shaft=20 length=30 outer_diameter_begin=40 outer_diameter_end=40")
        .relation("assembly", &[("assembly", 20), ("part", 25)])
        .bearing(26, [20, 2], "10,100,0/-1,0,0/0,0,1", "positive")
        .component(27, "external_load", "transmits_torque=false u_coordinate_on_shaft=10 force_u_direction=5 force_v_direction=7 force_w_direction=9")
        .relation("assembly", &[("assembly", 20), ("part", 27)]);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "      - { from: 50 mm, to: 80 mm, outer: 40 mm }",
            "bearing_26: { shaft: shaft_20, at: 10 mm, designation: \"6206\", axial: left, axial_share: 0.5 }",
            // v is w x u: it points backwards, too.
            "      - { at: 90 mm, force: [-5 N, -7 N, 9 N] }",
        ],
    );
}

/// Shafts along the w axis of the gear unit, gravity along -u.
#[test]
fn shafts_may_have_any_direction() {
    let mut model = Model::new();
    model.components[0].2 =
        attributes_of("direction_vector_gravity_u=-1 direction_vector_gravity_v=0 direction_vector_gravity_w=0");
    let axes = "/0,0,1/1,0,0";
    model
        .shaft(10, &format!("0,0,0{axes}"), "defines_speed=true rotational_speed=1000")
        .shaft(20, &format!("100,0,0{axes}"), "")
        .gear(11, Some(10), &format!("0,0,50{axes}"), "number_of_teeth=40")
        .gear(21, Some(20), &format!("100,0,50{axes}"), "number_of_teeth=60")
        .stage(30, [11, 21])
        .load(14, 10, "defines_torque=true torque_around_u_axis=50")
        .load(24, 20, "");
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "shaft_20: { axis: [0 mm, 100 mm], bearings: none }",
            "gear_11: { shaft: shaft_10, at: 50 mm",
            "# - bearings of shaft_10 (shaft 10): the file has none",
        ],
    );
    assert!(!imported.gearbox.contains("no direction of gravity"));
    gearbox(&imported.gearbox);
}

/// Helix angles of 45 degrees make the axes cross at right angles.
#[test]
fn cylindrical_gears_on_crossed_axes_are_crossed_helical() {
    let mut model = one_stage("50,200,0/0,0,1/1,0,0");
    for (id, _, attributes) in &mut model.components {
        let at = match *id {
            11 => "50,0,0",
            20 | 21 => "50,141.4213562373095,0/0,0,1/1,0,0",
            22 => "50,141.4213562373095,-50/0,0,1/1,0,0",
            23 => "50,141.4213562373095,50/0,0,1/1,0,0",
            _ => continue,
        };
        let more = match *id {
            11 => "face_width=20 normal_module=2 number_of_teeth=40 helix_angle_reference_diameter=45",
            21 => "face_width=20 normal_module=2 number_of_teeth=60 helix_angle_reference_diameter=45",
            22 => {
                "bearing_type=radial_grooved_ball_bearing catalogue_designation=6206 axial_force_absorption=both_directions"
            }
            23 => {
                "bearing_type=radial_grooved_ball_bearing catalogue_designation=6206 axial_force_absorption=no_direction"
            }
            _ => "",
        };
        *attributes = attributes_of(&format!("{} {more}", place(at)));
    }
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "shaft_20: { axis: { through: [50 mm, 141.421356237 mm, 0 mm], direction: [0, 0, 1] } }",
            "gear_21: { shaft: shaft_20, at: 0 mm, z: 60, facewidth: 20 mm, hand: right }",
            "bearing_22: { shaft: shaft_20, at: -50 mm",
            "crossed_helical_meshes:\n  stage_30: { gears: [gear_11, gear_21], normal_module: 2 mm, helix_angle: [45 deg, 45 deg] }",
            "crossed_helical_mesh: { type: point_contact",
        ],
    );
    assert!(!imported.gearbox.contains("To correct"), "{}", imported.gearbox);
    gearbox(&imported.gearbox);
}

/// The hypoid gears of ISO 23509 annex F.3, whose ring is 15 mm above the pinion.
fn hypoid() -> Model {
    let mut model = Model::new();
    let across = "/0,1,0/0,0,1";
    model
        .shaft(10, "0,0,0", "defines_speed=true rotational_speed=-1200")
        .shaft(20, &format!("0,0,15{across}"), "")
        .component(
            11,
            "bevel_gear",
            &format!("{} number_of_teeth=13 face_width=31.9 mean_spiral_angle=50 spiral_angle_pitch_direction=left bevel_cone_orientation=negative", place("70,0,0")),
        )
        .component(
            21,
            "bevel_gear",
            &format!("{} number_of_teeth=42 face_width=30 outer_pitch_diameter=170 pitch_angle=68.324 addendum_angle=1 dedendum_angle=4", place(&format!("0,27,15{across}"))),
        )
        .relation("assembly", &[("assembly", 10), ("part", 11)])
        .relation("assembly", &[("assembly", 20), ("part", 21)])
        .component(
            30,
            "bevel_stage",
            "cutter_radius=63.5 number_of_blade_groups=0 depth_factor=2 clearance_factor=0.125 mean_addendum_factor_of_wheel=0.35 \
             nominal_design_pressure_angle_on_drive_side=20 nominal_design_pressure_angle_on_coast_side=20 \
             influence_factor_of_limit_pressure_angle=1 shaft_angle=90 hypoid_offset=15",
        )
        .relation("stage", &[("stage", 30), ("gear_1", 21), ("gear_2", 11)])
        .bearing(12, [10, 2], "110,0,0", "both_directions")
        .bearing(13, [10, 2], "190,0,0", "no_direction")
        .bearing(22, [20, 2], &format!("0,80,15{across}"), "both_directions")
        .bearing(23, [20, 2], &format!("0,-60,15{across}"), "no_direction")
        .load(14, 10, "defines_torque=true torque_around_u_axis=-250")
        .load(24, 20, "");
    model
}

/// Efficiency with constant tooth friction and without bearings, at the load case.
fn efficiency_of_teeth(gearbox_file: &str) -> f64 {
    let text = gearbox_file
        .replace(
            "tooth_friction: { type: xu }",
            "tooth_friction: { type: constant, value: 0.05 }",
        )
        .replace("bearing: { type: skf }", "bearing: none");
    let (_, t) = gearbox(&text);
    let case = t.case("only", &["input"], &["input"]).unwrap();
    let mut scratch = t.scratch(&case);
    let point = Point {
        speeds: &[-1200.0 * std::f64::consts::PI / 30.0],
        torques: &[-250.0],
        ..Point::default()
    };
    let solved = t.evaluate(&case, &point, &[80.0], &mut scratch);
    let power = [0, 1].map(|port| solved.torque(port) * solved.speed(t.ports()[port].member));
    -power[1] / power[0]
}

#[test]
fn hypoid_gears_are_complete() {
    let imported = hypoid().imported();
    has(
        &imported.gearbox,
        &[
            "shaft_10: { axis: [0 mm, 0 mm] }",
            "shaft_20: { axis: { through: [0 mm, 0 mm, 15 mm], direction: [0, 1, 0] } }",
            "gear_11: { shaft: shaft_10, z: 13, facewidth: 31.9 mm, hand: left, faces: start }",
            "gear_21: { shaft: shaft_20, z: 42, facewidth: 30 mm, faces: start }",
            "bevel_meshes:\n  stage_30: { gears: [gear_11, gear_21], outer_diameter: 170 mm, spiral_angle: 50 deg, cutter: { radius: 63.5 mm }, \
             pressure_angle: { drive: 20 deg, coast: 20 deg, limit_factor: 1 }, depth: { working: 2, clearance: 0.125, wheel_addendum: 0.35, \
             addendum_angle: 1 deg, dedendum_angle: 4 deg }, shaft_angle: 90 deg, offset: 15 mm }",
            "bevel_gear 21: the file states no bevel_cone_orientation; its apex was taken on the side of the other axis",
        ],
    );
    assert!(!imported.gearbox.contains("To correct"), "{}", imported.gearbox);
    // The published geometry with friction in the balance of forces; the standard's spiral angle is not exactly 50 degrees.
    let found = efficiency_of_teeth(&imported.gearbox);
    assert!((found - 0.978_195_24).abs() < 2e-6, "{found}");
    // Data type I has other factors of the same depth.
    let mut model = hypoid();
    for (id, _, attributes) in &mut model.components {
        if *id == 11 {
            attributes.push_str(&attributes_of(
                "basic_crown_gear_addendum_factor=1 basic_crown_gear_dedendum_factor=1.25 profile_shift_coefficient=0.3",
            ));
        }
        if *id == 30 {
            *attributes = attributes_of(
                "cutter_radius=63.5 nominal_design_pressure_angle_on_drive_side=20 nominal_design_pressure_angle_on_coast_side=20",
            );
        }
    }
    has(
        &model.imported().gearbox,
        &[
            "depth: { working: 2, clearance: 0.125, wheel_addendum: 0.35, addendum_angle: 1 deg, dedendum_angle: 4 deg }",
        ],
    );
}

/// What determines the pitch cones of hypoid gears, and what is not there is said in its words.
#[test]
fn bevel_gears_say_what_is_missing() {
    let with = |id: i64, from: &str, to: &str| {
        let mut model = hypoid();
        for (own, _, attributes) in &mut model.components {
            if *own == id {
                assert!(attributes.contains(from), "{attributes}");
                *attributes = attributes.replace(from, to);
            }
        }
        model
    };
    let cutter = "<attribute id=\"cutter_radius\">63.5</attribute>";
    has(
        &with(30, cutter, "").imported().gearbox,
        &["wheel_pitch_angle: 68.324 deg"],
    );
    let oerlikon = with(
        30,
        cutter,
        "<attribute id=\"calculation_method_iso_23509_2025\">2</attribute>",
    );
    has(&oerlikon.imported().gearbox, &["wheel_pitch_angle: 68.324 deg"]);
    let mut without = oerlikon;
    for (_, _, attributes) in &mut without.components {
        *attributes = attributes.replace("pitch_angle\">68.324", "root_angle\">64");
    }
    has(
        &without.refused(),
        &[
            "bevel_stage 30: the pitch cones of hypoid gears by method 2 of ISO 23509 (Oerlikon) are not available from the cutter",
        ],
    );
    has(
        &with(11, "spiral_angle_pitch_direction", "unknown_direction").refused(),
        &["bevel_stage 30: the file does not say which hand its teeth have"],
    );
    has(
        &with(21, "outer_pitch_diameter", "unknown_diameter").refused(),
        &["bevel_stage 30: the file states no size of its wheel"],
    );
    let parallel = with(20, "<c>0</c><c>1</c><c>0</c>", "<c>1</c><c>0</c><c>0</c>");
    has(
        &parallel.refused(),
        &["bevel_stage 30: the axes of its gears are parallel"],
    );
}

/// Two speeds: gears on bearings, joined to their shaft by clutches; one spectrum with both gears.
#[test]
fn loose_gears_have_clutches() {
    let mut model = Model::new();
    model.components[0].2 = attributes_of("number_of_gears=2 gear_shift_index=1");
    model
        .shaft(10, "0,0,0", "defines_speed=true")
        .shaft(20, "0,100,0", "")
        .gear(11, Some(10), "30,0,0", "number_of_teeth=40")
        .gear(12, Some(10), "70,0,0", "number_of_teeth=50")
        .gear(21, None, "30,100,0", "number_of_teeth=60")
        .gear(22, Some(20), "70,100,0", "number_of_teeth=50")
        .stage(31, [11, 21])
        .stage(32, [12, 22])
        .bearing(41, [20, 21], "30,100,0", "both_directions")
        .bearing(42, [20, 22], "70,100,0", "both_directions")
        .bearing(43, [10, 2], "0,0,0", "both_directions")
        .bearing(44, [10, 2], "100,0,0", "no_direction")
        .bearing(45, [20, 2], "0,100,0", "both_directions")
        .bearing(46, [20, 2], "100,100,0", "no_direction")
        .component(51, "switchable_coupling", "is_engaged=true;false")
        .relation("side", &[("assembly", 51), ("inner_part", 20), ("outer_part", 21)])
        .component(52, "switchable_coupling", "is_engaged=false;true")
        .relation("side", &[("assembly", 52), ("inner_part", 20), ("outer_part", 22)])
        .load(14, 10, "defines_torque=true")
        .load(24, 20, "")
        .case(
            1,
            &[
                (1, "gear_shift_index=1 operating_time_fraction=60"),
                (10, "rotational_speed=1000"),
                (14, "torque_around_u_axis=50"),
            ],
        )
        .case(
            2,
            &[
                (1, "gear_shift_index=1 operating_time_fraction=20"),
                (10, "rotational_speed=2000"),
                (14, "torque_around_u_axis=30"),
            ],
        )
        .case(
            3,
            &[
                (1, "gear_shift_index=2 operating_time_fraction=20"),
                (10, "rotational_speed=3000"),
                (14, "torque_around_u_axis=20"),
            ],
        );
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "gear_21: { shaft: shaft_20, at: 30 mm, z: 60, facewidth: 20 mm, mounted: loose }",
            "bearing_41: { shaft: shaft_20, outer: gear_21, at: 30 mm, designation: \"6206\", axial: both }",
            "coupling_51: { kind: dog, between: [shaft_20, gear_21], model: none }",
            "  gear_1: [coupling_51]\n  gear_2: [coupling_52]\n",
        ],
    );
    let (_, transmission) = gearbox(&imported.gearbox);
    assert!(transmission.warnings.is_empty(), "{:?}", transmission.warnings);
    let study = imported.study.as_deref().unwrap();
    has(
        study,
        &[
            "load_spectrum_gear_1:",
            "{ torque: 50 Nm, speed: 1000 rpm, share: 0.75 }   # load case 1",
            "{ torque: 20 Nm, speed: 3000 rpm, share: 1 }   # load case 3",
            "cycles: [load_spectrum_gear_2], by: component, gear: gear_2 }",
        ],
    );
    has(
        imported.load_cases.as_deref().unwrap(),
        &["name,gear,torque", "\n3,gear_2,20,3000\n"],
    );
    let files = gearloss_document::files::InMemory::new([
        ("gearbox.yaml", imported.gearbox.as_str()),
        ("study.yaml", study),
        ("load_cases.csv", imported.load_cases.as_deref().unwrap()),
    ])
    .shared();
    let study = gearloss_studies::study::Study::read_from(language(), &files, "study.yaml".as_ref())
        .unwrap_or_else(|found| panic!("{}", found.render()));
    let run = gearloss_studies::run::StudyRun::new(language(), &study);
    for analysis in [
        "load_cases",
        "load_spectrum_gear_1_losses",
        "load_spectrum_gear_2_losses",
    ] {
        assert!(run.analysis(analysis).is_ok(), "{analysis}");
    }
}

/// A hollow shaft on another shaft: the bearings are those of the hollow shaft.
#[test]
fn the_shaft_of_a_bearing_is_the_one_that_it_supports() {
    let mut model = one_stage("0,100,0");
    model
        .shaft(70, "0,100,0", "")
        .gear(71, Some(70), "70,100,0", "number_of_teeth=50")
        .gear(72, Some(10), "70,0,0", "number_of_teeth=50")
        .stage(73, [72, 71])
        .bearing(74, [20, 70], "65,100,0", "positive")
        .bearing(75, [20, 70], "75,100,0", "negative")
        .component(76, "switchable_coupling", "is_engaged=false")
        .relation("side", &[("assembly", 76), ("inner_part", 20), ("outer_part", 70)]);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "bearing_74: { shaft: shaft_70, outer: shaft_20, at: 65 mm, designation: \"6206\", axial: left }",
            "bearing_75: { shaft: shaft_70, outer: shaft_20, at: 75 mm, designation: \"6206\", axial: right }",
        ],
    );
    gearbox(&imported.gearbox);
}

#[test]
fn thrust_that_two_bearings_take_is_divided() {
    let mut model = one_stage("0,100,0");
    for (_, _, attributes) in &mut model.components {
        *attributes = attributes.replace("no_direction", "both_directions");
    }
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "axial: both, axial_share: 0.5 }",
            "# - the thrust of shaft_20 is divided equally among its 2 bearings that can take it",
        ],
    );
    gearbox(&imported.gearbox);
}

/// Times of the load cases are durations; that of the gear unit is the life of the gearbox.
#[test]
fn load_cases_may_state_times() {
    let mut model = one_stage("0,100,0");
    model.components[0].2 = attributes_of("operating_time=20000");
    let case = |torque: &'static str, time: &'static str| [(14, torque), (1, time)];
    model.case(1, &case("torque_around_u_axis=50", "operating_time=100"));
    model.case(2, &case("torque_around_u_axis=60", "operating_time=100"));
    let study = model.imported().study.unwrap();
    has(
        &study,
        &[
            "- { torque: 50 Nm, speed: 1000 rpm, time: 100 h }   # load case 1",
            "- { torque: 60 Nm, speed: 1000 rpm, time: 100 h }   # load case 2",
        ],
    );
    let mut model = one_stage("0,100,0");
    model.components[0].2 = attributes_of("operating_time=20000");
    model
        .case(1, &[(14, "torque_around_u_axis=50")])
        .case(2, &[(14, "torque_around_u_axis=60")]);
    let imported = model.imported();
    assert!(!imported.study.unwrap().contains("cycles:"));
    has(
        &imported.gearbox,
        &["# - the load cases state no durations, so there is no load spectrum"],
    );
}

/// Data of the file count before those of the catalogue; a row of another size is another bearing.
#[test]
fn bearings_of_another_size_than_the_catalogue_are_their_own() {
    let mut model = one_stage("0,100,0");
    for (id, _, attributes) in &mut model.components {
        if *id == 12 {
            attributes.push_str(&attributes_of(
                "inner_diameter=30 outer_diameter=80 width=16 radial_static_load_rating=11",
            ));
        }
    }
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "designation: \"6206 (file)\", kind: deep_groove_ball, series: \"62\", bore: 30 mm, outside: 80 mm, width: 16 mm, c0: 11000 N, axial: both }",
            "the catalogue's `6206` has another kind or other dimensions than the file's `6206`; those of the file count",
        ],
    );
    gearbox(&imported.gearbox);
}

/// A bearing whose data do not suffice for the usual model gets another one, or none, with the reason.
#[test]
fn models_of_bearings_follow_from_their_data() {
    let mut model = one_stage("0,100,0");
    for (id, _, attributes) in &mut model.components {
        let data = match *id {
            12 => "bearing_type=radial_needle_roller_bearing axial_force_absorption=both_directions",
            13 => "bearing_type=radial_spherical_roller_bearing axial_force_absorption=no_direction",
            _ => continue,
        };
        let place = place(if *id == 12 { "0,0,0" } else { "100,0,0" });
        let sizes =
            "inner_diameter=30 outer_diameter=62 width=16 radial_static_load_rating=20 radial_dynamic_load_rating=25";
        *attributes = attributes_of(&format!("{place} {data} {sizes}"));
    }
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "c0: 20000 N, axial: both, model: { type: iso14179_2 } }",
            "c0: 20000 N, axial: none, model: none }",
            "# - bearing_12 (rolling_bearing_with_catalog_geometry 12): the model is iso14179_2, because skf publishes no row",
            "# - bearing_13 (rolling_bearing_with_catalog_geometry 13): skf needs the `series` of this bearing",
        ],
    );
    gearbox(&imported.gearbox);
}

/// What the file does not have and the program needs is said where the import ends.
#[test]
fn what_cannot_be_solved_is_said() {
    let mut model = one_stage("0,100,0");
    model.bearing(15, [10, 2], "70,0,0", "no_direction");
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "# To correct before the gearbox can be solved:\n# - shafts.shaft_10.sections: no diameters between 0.000 mm and 50.000 mm",
            "(help: add `sections:",
        ],
    );
    assert!(imported.report.iter().any(|line| line.starts_with("To correct")));
    assert!(!imported.gearbox.contains("loads on the teeth"));
}

#[test]
fn shafts_that_carry_nothing_are_left_out() {
    let mut model = one_stage("0,100,0");
    model.shaft(99, "0,0,300", "");
    let imported = model.imported();
    assert!(!imported.gearbox.contains("shaft_99"));
    has(&imported.gearbox, &["# - shaft 99 carries nothing and was left out"]);
}

#[test]
fn profile_shifts_that_contradict_the_centre_distance_are_left_out() {
    let mut model = one_stage("0,100,0");
    model
        .component(61, "cylindrical_gear_flank", "addendum_modification_coefficient=0.5")
        .component(62, "cylindrical_gear_flank", "addendum_modification=0.6")
        .relation("flank", &[("gear", 11), ("left", 61), ("right", 61)])
        .relation("flank", &[("gear", 21), ("left", 62), ("right", 62)]);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "profile_shift: 0.5 }",
            "the profile shifts 0.5 and 0.3 do not give the centre distance 100 mm",
        ],
    );
    let (_, transmission) = gearbox(&imported.gearbox);
    let (.., mesh) = transmission.cylindrical_meshes().next().unwrap();
    assert!((mesh.pair.profile_shift[1] + 0.5).abs() < 1e-9);
}

#[test]
fn names_of_components_do_no_harm() {
    let mut text = one_stage("0,100,0").xml();
    text = text.replace(
        "id=\"11\" type=",
        "id=\"11\" name=\"a&#10;b: {&#x202e;# c&quot;\" type=",
    );
    let imported = import(text.as_bytes(), "we\"ird\n: name.rexs", language())
        .unwrap_or_else(|found| panic!("{}", found.render()));
    has(
        &imported.gearbox,
        &["# 11 \"a b: { # c\"\"\n", "title: \"we\\\"ird : name\"\n"],
    );
    gearbox(&imported.gearbox);
}

/// Parts that were begun and never filled in: a shaft with a section, a material and two couplings to it.
#[test]
fn empty_components_are_left_out() {
    let with_stub = |model: &mut Model| {
        model
            .component(97, "shaft", "")
            .component(98, "shaft_section", "")
            .component(99, "material", "")
            .component(100, "coupling", "")
            .component(101, "coupling", "")
            .relation("assembly", &[("assembly", 1), ("part", 97)])
            .relation("assembly", &[("assembly", 97), ("part", 98)])
            .relation("reference", &[("origin", 97), ("referenced", 99)])
            .relation("side", &[("assembly", 100), ("inner_part", 97), ("outer_part", 20)])
            .relation("side", &[("assembly", 101), ("inner_part", 10), ("outer_part", 97)]);
    };
    let plain = one_stage("0,100,0").imported();
    let mut model = one_stage("0,100,0");
    with_stub(&mut model);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "left out, because they have no data and nothing needs them: shaft 97, shaft_section 98, material 99, coupling 100, coupling 101",
        ],
    );
    let without_report = |text: &str| text.split("# Ignored or changed").next().unwrap().to_owned();
    let head = |text: &str| -> Vec<String> {
        let lines = text.lines().take_while(|line| !line.starts_with("# Missing"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(
        head(&without_report(&imported.gearbox)),
        head(&without_report(&plain.gearbox))
    );
    // A gear on the shaft needs it: then its position is missing.
    model.gear(96, Some(97), "50,0,0", "number_of_teeth=40");
    has(&model.refused(), &["shaft 97: it has no position"]);
}

/// `code` with Base64: float64 of 50, 100, 0.
#[test]
fn encoded_arrays_are_vectors() {
    let model = one_stage("0,100,0");
    let plain = model.xml();
    let array = "<array><c>50</c><c>100</c><c>0</c></array>";
    let coded = plain.replace(
        array,
        "<array code=\"float64\">AAAAAAAASUAAAAAAAABZQAAAAAAAAAAA</array>",
    );
    assert_ne!(plain, coded);
    let text = |xml: &str| import(xml.as_bytes(), "model.rexs", language()).unwrap().gearbox;
    assert_eq!(text(&coded), text(&plain));
}

/// A bearing of another component type on shaft 20, instead of the rolling bearing 23.
fn with_bearing(kind: &str, data: &str) -> Model {
    let mut model = one_stage("0,100,0");
    model.components.retain(|(id, ..)| *id != 23);
    model
        .relations
        .retain(|(_, refs)| !refs.contains(&("assembly".to_owned(), 23)));
    model.component(25, kind, &format!("{} {data}", place("100,100,0")));
    model.relation("side", &[("assembly", 25), ("inner_part", 20), ("outer_part", 2)]);
    model
}

/// Plain bearings have a film: with their relative clearance, or a clearance whose unit their diameter tells.
#[test]
fn plain_bearings_have_a_film() {
    let film = "film: { relative_clearance: 0.0015, least_thickness: 3 um }, model: { type: journal_film }";
    let size = "inner_diameter=60 width=30";
    for (kind, clearance) in [
        (
            "hydrodynamic_radial_plain_bearing",
            "relative_clearance_plain_bearing=0.0015",
        ),
        (
            "hydrodynamic_radial_plain_bearing",
            "diameter_clearance_plain_bearing=0.09",
        ),
        ("slide_bearing", "diameter_clearance_plain_bearing=90"),
    ] {
        let imported = with_bearing(kind, &format!("{size} {clearance}")).imported();
        has(
            &imported.gearbox,
            &[
                &format!(
                    "bearing_25: {{ shaft: shaft_20, at: 100 mm, kind: plain, bore: 60 mm, width: 30 mm, axial: none, {film} }}"
                ),
                "bearings.bearing_25.film.least_thickness",
            ],
        );
        let (_, transmission) = gearbox(&imported.gearbox);
        assert!(transmission.warnings.is_empty());
    }
}

/// What a plain bearing lacks is said, and it has no loss.
#[test]
fn plain_bearings_without_clearance_have_no_loss() {
    let data = "inner_diameter=60 diameter_clearance_plain_bearing=5 axial_force_absorption=positive";
    let imported = with_bearing("slide_bearing", data).imported();
    has(
        &imported.gearbox,
        &[
            "film: { relative_clearance: 0.0015, least_thickness: 3 um }, model: none }",
            "(slide_bearing 25): width, film.relative_clearance; without them its loss is left out",
            "plain bearings carry no thrust",
        ],
    );
    gearbox(&imported.gearbox);
}

/// A bearing whose lubricant is a grease is greased, has no oil level, and names the grease.
#[test]
fn greases_are_described_by_their_base_oils() {
    let data = "bearing_type=radial_grooved_ball_bearing catalogue_designation=6206 axial_force_absorption=no_direction \
                depth_of_immersion_in_oil=5";
    let mut model = with_bearing("rolling_bearing_with_catalog_geometry", data);
    let viscosities = "viscosity_at_40_degree_celsius=100 viscosity_at_100_degree_celsius=11";
    model
        .component(40, "lubricant", viscosities)
        .component(41, "lubricant", &format!("kind=grease basis=mineral {viscosities}"))
        .relation("reference", &[("origin", 2), ("referenced", 40)])
        .relation("reference", &[("origin", 25), ("referenced", 41)]);
    let imported = model.imported();
    has(
        &imported.gearbox,
        &[
            "lubricant_41: { kind: mineral, viscosity: { kv40: 100 mm2/s, kv100: 11 mm2/s }, grease: {} }",
            "axial: none, lubrication: grease, lubricant: lubricant_41 }",
            "its depth in the oil was ignored",
            "count as those of its base oil",
        ],
    );
    let (_, transmission) = gearbox(&imported.gearbox);
    assert!(transmission.warnings.is_empty());
}

/// Types of rolling bearings without a kind carry load, and the report names them.
#[test]
fn bearing_types_without_a_kind_are_reported() {
    for kind in ["axial_tapered_roller_bearing", "crossed_roller_bearing"] {
        let data =
            format!("bearing_type={kind} inner_diameter=50 outer_diameter=80 axial_force_absorption=no_direction");
        let imported = with_bearing("rolling_bearing_with_detailed_geometry", &data).imported();
        has(
            &imported.gearbox,
            &[
                &format!("gearbox files have no kind for the bearing type `{kind}`"),
                "model: none }",
            ],
        );
    }
}
