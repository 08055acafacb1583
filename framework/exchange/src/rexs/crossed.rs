//! Bevel, hypoid, worm and crossed helical stages.
//!
//! What the geometry needs is read from the stage and its gears; pitch cones, the places of the mean points and the blanks follow from it and from
//! the axes, as for gearboxes that are written by hand.

use super::draft::{CrossedMesh, Gear};
use super::gears::ReadGear;
use super::map::{Map, id, named, one_line};
use super::model::{Component, Id};
use super::pose::{cross, dot, sum};
use super::units::Quantity;
use super::yaml::{Entry, number};
use crate::codes;

/// Offset above which bevel gears are hypoid gears; below it is rounding of positions. \[mm\]
const OFFSET: f64 = 1e-3;
/// Distance of a gear from the crossing point of the axes from which it says where the apex is. \[mm\]
const APART: f64 = 0.1;

/// Gears and meshes on axes that cross, and what the file does not have: paths and reasons.
#[derive(Debug, Default)]
pub struct Crossed {
    pub gears: Vec<Gear>,
    pub meshes: Vec<CrossedMesh>,
    pub assumed: Vec<(Vec<String>, String)>,
}

/// A gear of a stage with its place.
#[derive(Debug, Clone, Copy)]
struct Placed<'a> {
    gear: &'a Component,
    member: Id,
    z: i64,
}

/// All stages whose axes cross. `helical` are the cylindrical ones among them.
pub fn crossed<'a>(map: &Map<'a>, helical: &[(&'a Component, [ReadGear<'a>; 2])]) -> Crossed {
    let mut found = Crossed::default();
    let source = map.source;
    for stage in source.components("bevel_stage") {
        if let Some(pair) = pair(map, stage, &["bevel_gear"]) {
            bevel(map, stage, pair, &mut found);
        }
    }
    for stage in source.components("worm_stage") {
        if let Some(pair) = pair(map, stage, &["worm_gear", "worm_wheel"]) {
            worm(map, stage, pair, &mut found);
        }
    }
    for (stage, gears) in helical {
        crossed_helical(map, stage, gears, &mut found);
    }
    let meshed = |id: Id| {
        source
            .relations("stage")
            .any(|stage| [stage.role("gear_1"), stage.role("gear_2")].contains(&Some(id)))
    };
    for kind in ["bevel_gear", "worm_gear", "worm_wheel"] {
        for gear in source.components(kind).filter(|gear| !meshed(gear.id)) {
            source.note(format!("{} is in no stage and was left out", gear.label()));
        }
    }
    found
}

/// The gears of a stage, the one that turns faster first.
fn pair<'a>(map: &Map<'a>, stage: &'a Component, kinds: &[&str]) -> Option<[Placed<'a>; 2]> {
    let source = map.source;
    let relation = source
        .relations("stage")
        .find(|relation| relation.role("stage") == Some(stage.id));
    let ids = relation.and_then(|relation| Some([relation.role("gear_1")?, relation.role("gear_2")?]));
    let Some(ids) = ids else {
        source.error(
            stage,
            codes::REXS_MODEL,
            "it names no gears: there is no relation `stage` with gear_1 and gear_2",
            "add the relation, or delete the stage",
        );
        return None;
    };
    let mut placed = Vec::new();
    for id in ids {
        let gear = source.component(id).filter(|gear| kinds.contains(&gear.kind.as_str()));
        let Some(gear) = gear else {
            source.error(
                stage,
                codes::REXS_MODEL,
                &format!("its gears must be of the types {}", kinds.join(" and ")),
                "correct the relation `stage`",
            );
            return None;
        };
        let Some(member) = map.member_with(gear.id) else {
            source.error(
                gear,
                codes::REXS_MODEL,
                "it is on no shaft: there is no relation `assembly` or `side` with it",
                "put the gear on a shaft in the program that exported the model",
            );
            return None;
        };
        // A shaft without a position was reported.
        map.poses.get(member)?;
        let z = source.needed(gear, "number_of_teeth", Quantity::Number);
        placed.push(Placed {
            gear,
            member,
            z: z.abs() as i64,
        });
    }
    let [a, b] = placed.try_into().ok()?;
    if a.member == b.member {
        source.error(
            stage,
            codes::REXS_MODEL,
            "both of its gears are on one shaft",
            "correct the gears in the program that exported the model",
        );
        return None;
    }
    if !super::gears::crosses(map, [a.member, b.member]) {
        source.error(
            stage,
            codes::REXS_PART,
            "the axes of its gears are parallel",
            "only axes that cross are available for this kind of gears: check u_axis_vector of both shafts",
        );
        return None;
    }
    let first_is_wheel = match kinds {
        [_] => a.z > b.z,
        _ => a.gear.kind == "worm_wheel",
    };
    Some(if first_is_wheel { [b, a] } else { [a, b] })
}

/// A gear without what a kind adds.
fn gear_of(map: &Map<'_>, placed: &Placed<'_>, facewidth: f64, hand: Option<&'static str>) -> Gear {
    let source = map.source;
    let loose = map.loose.get(&placed.member).copied();
    Gear {
        id: id("gear", placed.gear.id),
        comment: named(placed.gear),
        shaft: map.member_name(loose.unwrap_or(placed.member)),
        at: None,
        z: placed.z,
        facewidth,
        ring: false,
        loose: loose.is_some(),
        hand,
        faces: None,
        profile_shift: None,
        tip_diameter: None,
        root_diameter: None,
        ra: source.positive(
            placed.gear,
            "arithmetic_mean_roughness_flank_iso_4287_1997",
            Quantity::Roughness,
        ),
    }
}

fn oil_of(map: &Map<'_>, stage: &Component) -> Option<String> {
    let oil = map.referenced(stage.id, "lubricant")?;
    Some(id("lubricant", oil.id)).filter(|oil| Some(oil) != map.sump.as_ref())
}

/// Distances of points on two axes from their common perpendicular, along the axes, and the distance of the axes. \[mm\]
fn feet(map: &Map<'_>, [a, b]: [Id; 2]) -> Option<([super::pose::Vector; 2], f64)> {
    let (a, b) = (map.poses.get(a)?, map.poses.get(b)?);
    let common = cross(a.u, b.u);
    let size = dot(common, common);
    let between = sum(b.origin, a.origin, -1.0);
    let along_a = dot(cross(between, b.u), common) / size;
    let along_b = dot(cross(between, a.u), common) / size;
    let foot = |pose: &super::pose::Pose, along: f64| sum(pose.origin, pose.u, along);
    let offset = dot(between, common).abs() / size.sqrt();
    Some(([foot(a, along_a), foot(b, along_b)], offset))
}

/// Towards which end of its shaft a bevel gear faces: the end on whose side its apex is.
fn faces(map: &Map<'_>, placed: &Placed<'_>, crossing: super::pose::Vector) -> Option<&'static str> {
    let source = map.source;
    let towards = |sense: f64| if sense > 0.0 { "end" } else { "start" };
    let pose = map.poses.get(placed.gear.id).or_else(|| map.poses.get(placed.member))?;
    match source.word(placed.gear, "bevel_cone_orientation").as_deref() {
        Some("positive") => return Some(towards(map.sense(placed.member, pose.u))),
        Some("negative") => return Some(towards(-map.sense(placed.member, pose.u))),
        _ => {}
    }
    let own = map
        .poses
        .get(placed.gear.id)
        .map(|pose| map.along(placed.member, pose.origin));
    let distance = map.along(placed.member, crossing) - own?;
    if distance.abs() < APART {
        source.error(
            placed.gear,
            codes::REXS_VALUE,
            "the file does not say on which side its apex is",
            "state bevel_cone_orientation",
        );
        return None;
    }
    source.assume(format!(
        "{}: the file states no bevel_cone_orientation; its apex was taken on the side of the other axis",
        placed.gear.label()
    ));
    Some(towards(distance))
}

fn bevel(map: &Map<'_>, stage: &Component, pair: [Placed<'_>; 2], found: &mut Crossed) {
    let source = map.source;
    let Some((crossing, offset)) = feet(map, pair.map(|placed| placed.member)) else {
        return;
    };
    let [pinion, wheel] = pair;
    let is_hypoid = offset > OFFSET;
    let angle = |of: &Component, id: &str| source.number(of, id, Quantity::Angle);
    let length = |of: &Component, id: &str| source.positive(of, id, Quantity::Length);
    let mut keys: Vec<(&'static str, String)> = Vec::new();
    let spiral = pair.map(|placed| angle(placed.gear, "mean_spiral_angle").map(f64::abs));
    let sizes = [
        ("outer_diameter", length(wheel.gear, "outer_pitch_diameter"), 1.0),
        ("outer_module", length(stage, "outer_transverse_module"), 1.0),
        ("mean_diameter", length(wheel.gear, "mean_pitch_diameter"), 1.0),
        (
            "mean_diameter",
            length(wheel.gear, "mean_normal_module"),
            wheel.z as f64 / spiral[1].or(spiral[0]).unwrap_or(0.0).to_radians().cos(),
        ),
    ];
    match sizes.iter().find_map(|(key, size, factor)| Some((*key, (*size)? * factor))) {
        Some((key, size)) => keys.push((key, format!("{} mm", number(size)))),
        None => source.error(
            stage,
            codes::REXS_VALUE,
            "the file states no size of its wheel",
            "state outer_pitch_diameter, mean_pitch_diameter or mean_normal_module of the wheel, or outer_transverse_module of the stage",
        ),
    }
    let method = source.word(stage, "calculation_method_iso_23509_2025");
    let is_method = |number: &str| method.as_deref().is_some_and(|method| method.ends_with(number));
    let inclined = spiral.iter().flatten().any(|spiral| *spiral > 0.0);
    match spiral {
        // Of methods 2 and 3 the wheel has the stated angle.
        [Some(_), Some(of_wheel)] if is_hypoid && (is_method("2") || is_method("3")) => {
            keys.push(("spiral_angle", format!("{} deg", number(of_wheel))));
            keys.push(("spiral_angle_of", "wheel".to_owned()));
        }
        [Some(own), _] => keys.push(("spiral_angle", format!("{} deg", number(own)))),
        [None, Some(own)] => {
            keys.push(("spiral_angle", format!("{} deg", number(own))));
            keys.push(("spiral_angle_of", "wheel".to_owned()));
        }
        [None, None] => source.assume(format!(
            "{}: the file states no mean_spiral_angle; straight teeth were taken",
            stage.label()
        )),
    }
    if is_hypoid {
        hypoid_cones(map, stage, &wheel, is_method("2"), is_method("3"), &mut keys);
    }
    pressure_angles(map, stage, &mut keys);
    if let Some(depth) = depth(map, stage, pair) {
        keys.push(("depth", depth));
    }
    for (key, id, stated) in [
        ("shaft_angle", "shaft_angle", Quantity::Angle),
        ("offset", "hypoid_offset", Quantity::Length),
    ] {
        if let Some(value) = source.number(stage, id, stated) {
            let unit = if key == "offset" { "mm" } else { "deg" };
            keys.push((key, format!("{} {unit}", number(value.abs()))));
        }
    }
    for (i, placed) in pair.iter().enumerate() {
        let facewidth = source.needed(placed.gear, "face_width", Quantity::Length);
        let hand = source.word(placed.gear, "spiral_angle_pitch_direction");
        let hand = match hand.as_deref() {
            Some("left") => Some("left"),
            Some("right") => Some("right"),
            _ => None,
        };
        let mut gear = gear_of(map, placed, facewidth, hand.filter(|_| inclined));
        gear.faces = faces(map, placed, crossing[i]);
        found.gears.push(gear);
    }
    let hands = &found.gears[found.gears.len() - 2..];
    if inclined && hands.iter().all(|gear| gear.hand.is_none()) {
        source.error(
            stage,
            codes::REXS_VALUE,
            "the file does not say which hand its teeth have",
            "state spiral_angle_pitch_direction of a gear",
        );
    }
    found.meshes.push(CrossedMesh {
        section: "bevel_meshes",
        id: id("stage", stage.id),
        comment: named(stage),
        gears: [pinion, wheel].map(|placed| id("gear", placed.gear.id)),
        keys,
        lubricant: oil_of(map, stage),
    });
}

/// What determines the pitch cones of hypoid gears: the cutter, or the pitch angle of the wheel.
fn hypoid_cones(
    map: &Map<'_>,
    stage: &Component,
    wheel: &Placed<'_>,
    is_oerlikon: bool,
    is_klingelnberg: bool,
    keys: &mut Vec<(&'static str, String)>,
) {
    let source = map.source;
    let cutter = source.positive(stage, "cutter_radius", Quantity::Length);
    if let Some(radius) = cutter.filter(|_| !is_oerlikon) {
        let blades = source.integer(stage, "number_of_blade_groups").unwrap_or(0).max(0);
        if is_klingelnberg {
            keys.push(("method", "klingelnberg".to_owned()));
        }
        let entry = Entry::default().quantity("radius", radius, "mm");
        let entry = entry.word_if("blade_groups", (blades > 0).then(|| blades.to_string()));
        keys.push(("cutter", entry.text()));
        return;
    }
    match source.positive(wheel.gear, "pitch_angle", Quantity::Angle) {
        Some(pitch) => keys.push(("wheel_pitch_angle", format!("{} deg", number(pitch)))),
        None if is_oerlikon => source.error(
            stage,
            codes::REXS_PART,
            "the pitch cones of hypoid gears by method 2 of ISO 23509 (Oerlikon) are not available from the cutter",
            "state pitch_angle of the wheel, from which they follow",
        ),
        None => source.error(
            stage,
            codes::REXS_VALUE,
            "the file does not say what determines the pitch cones of its hypoid gears",
            "state cutter_radius of the stage, or pitch_angle of the wheel",
        ),
    }
}

fn pressure_angles(map: &Map<'_>, stage: &Component, keys: &mut Vec<(&'static str, String)>) {
    let source = map.source;
    let of = |ids: [&str; 2]| ids.map(|id| source.number(stage, id, Quantity::Angle));
    let nominal = of([
        "nominal_design_pressure_angle_on_drive_side",
        "nominal_design_pressure_angle_on_coast_side",
    ]);
    let generated = of([
        "generated_pressure_angle_on_drive_side",
        "generated_pressure_angle_on_coast_side",
    ]);
    let factor = source.number(stage, "influence_factor_of_limit_pressure_angle", Quantity::Number);
    let (drive, coast, factor) = match (nominal, generated) {
        ([Some(drive), Some(coast)], _) => (drive, coast, factor),
        // Generated angles contain the limit pressure angle already.
        (_, [Some(drive), Some(coast)]) => (drive, coast, Some(0.0)),
        _ => {
            source.assume(format!(
                "{}: the file states no pressure angles of both flanks; 20 deg was taken",
                stage.label()
            ));
            return;
        }
    };
    let entry = Entry::default()
        .quantity("drive", drive, "deg")
        .quantity("coast", coast, "deg")
        .quantity_if("limit_factor", factor, "");
    keys.push(("pressure_angle", entry.text()));
}

/// The tooth depth: of data type II as it is, of data type I converted; `None` if the file states nothing of it.
fn depth(map: &Map<'_>, stage: &Component, [pinion, wheel]: [Placed<'_>; 2]) -> Option<String> {
    let source = map.source;
    let of_stage = |id: &str| source.number(stage, id, Quantity::Number);
    let of_gear = |placed: &Placed<'_>, id: &str| source.number(placed.gear, id, Quantity::Number);
    let angles = ["addendum_angle", "dedendum_angle"].map(|id| source.number(wheel.gear, id, Quantity::Angle));
    let basic = [pinion, wheel].iter().find_map(|placed| {
        Some((
            of_gear(placed, "basic_crown_gear_addendum_factor")?,
            of_gear(placed, "basic_crown_gear_dedendum_factor")?,
        ))
    });
    let (working, clearance, addendum) = match (of_stage("depth_factor"), basic) {
        (Some(working), _) => (
            Some(working),
            of_stage("clearance_factor"),
            of_stage("mean_addendum_factor_of_wheel"),
        ),
        // k_d = 2 k_hap, k_c = k_hfp/k_d - 1/2, c_ham = 1/2 - x_hm1/k_d.
        (None, Some((of_tip, of_root))) => {
            let working = 2.0 * of_tip;
            let shift = of_gear(&pinion, "profile_shift_coefficient")
                .or_else(|| of_gear(&wheel, "profile_shift_coefficient").map(|shift| -shift));
            (
                Some(working),
                Some(of_root / working - 0.5),
                Some(0.5 - shift.unwrap_or(0.0) / working),
            )
        }
        (None, None) => (None, None, None),
    };
    if working.is_none() {
        source.assume(format!(
            "{}: the file states no tooth depth; a working depth of two modules with the usual addendum of the wheel was taken",
            stage.label()
        ));
    }
    if angles.iter().all(Option::is_none) {
        source.assume(format!(
            "{}: the file states no addendum and dedendum angle of the wheel; uniform depth was taken",
            stage.label()
        ));
    }
    let entry = Entry::default()
        .quantity_if("working", working, "")
        .quantity_if("clearance", clearance, "")
        .quantity_if("wheel_addendum", addendum, "")
        .quantity_if("addendum_angle", angles[0], "deg")
        .quantity_if("dedendum_angle", angles[1], "deg");
    Some(entry.text()).filter(|text| text != "{}")
}

/// Materials of worm wheels by words of their designations: those of which friction is known. Earlier entries count first.
const MATERIALS: &[(&[&str], &str)] = &[
    (&["CUSN12NI"], "cusn12ni2"),
    (&["CUSN12"], "cusn12"),
    (&["CUAL10"], "cual10fe5ni5"),
    (&["GJS", "GGG"], "en_gjs400"),
    (&["GJL", "GG25", "GG-25"], "en_gjl250"),
];

/// The material of a worm wheel; a placeholder if its friction is not known.
fn material(map: &Map<'_>, wheel: &Placed<'_>, stage: &str, found: &mut Crossed) -> &'static str {
    let source = map.source;
    let name = map.referenced(wheel.gear.id, "material").map(|material| {
        source
            .text(material, "material_designation")
            .map_or_else(|| material.name.clone(), str::to_owned)
    });
    let known = name.as_ref().and_then(|name| {
        let name = name.to_ascii_uppercase();
        let known = MATERIALS
            .iter()
            .find(|(words, _)| words.iter().any(|word| name.contains(word)));
        Some(known?.1)
    });
    known.unwrap_or_else(|| {
        let stated = name.map_or_else(
            || "states no material of the wheel".to_owned(),
            |name| {
                let name = one_line(&name, 40);
                format!("has a wheel of {name}, with which worm friction is not known")
            },
        );
        found.assumed.push((
            vec![format!("worm_meshes.{stage}")],
            format!("placeholder: the REXS file {stated}"),
        ));
        source.missing(format!(
            "the material of {} for its friction: the file {stated}; tin bronze stands in as `material`",
            wheel.gear.label()
        ));
        "cusn12"
    })
}

fn worm(map: &Map<'_>, stage: &Component, [worm, wheel]: [Placed<'_>; 2], found: &mut Crossed) {
    let source = map.source;
    let length = |of: &Component, id: &str| source.positive(of, id, Quantity::Length);
    let mut keys: Vec<(&'static str, String)> = Vec::new();
    let module = source.needed(worm.gear, "axial_module", Quantity::Length);
    keys.push(("module", format!("{} mm", number(module))));
    let diameter = source.needed(worm.gear, "reference_diameter_worm_gear", Quantity::Length);
    keys.push(("worm_diameter", format!("{} mm", number(diameter))));
    match source.number(worm.gear, "pressure_angle_worm_gear", Quantity::Angle) {
        Some(angle) => keys.push(("pressure_angle", format!("{} deg", number(angle)))),
        None => source.assume(format!(
            "{}: the file states no pressure angle; 20 deg was taken",
            worm.gear.label()
        )),
    }
    let form = source
        .word(worm.gear, "flank_form")
        .or_else(|| source.word(wheel.gear, "flank_form"));
    match form.as_deref() {
        Some(form @ ("za" | "zn" | "zi" | "zk" | "zc")) => keys.push(("profile", form.to_owned())),
        Some(other) => source.error(
            worm.gear,
            codes::REXS_PART,
            &format!("worms with the flank form `{}` are not available", one_line(other, 40)),
            "cylindrical worms with the profiles ZA, ZN, ZI, ZK and ZC are; enveloping (globoid) worms are not",
        ),
        None => source.assume(format!(
            "{}: the file states no flank_form; ZI was taken",
            worm.gear.label()
        )),
    }
    let id_of_stage = id("stage", stage.id);
    keys.push(("material", material(map, &wheel, &id_of_stage, found).to_owned()));
    match source.word(stage, "lubrication_type_din_3996_2019").as_deref() {
        Some("injection_lubrication") => keys.push(("lubrication", "spray".to_owned())),
        Some("dip_lubrication") => keys.push(("lubrication", "bath".to_owned())),
        _ => source.assume(format!(
            "{}: the file states no lubrication_type; a bath of oil was taken",
            stage.label()
        )),
    }
    if let Some(shift) = source.number(
        wheel.gear,
        "addendum_modification_coefficient_worm_wheel",
        Quantity::Number,
    ) {
        keys.push(("profile_shift", number(shift)));
    }
    let stated = length(stage, "center_distance");
    if let (Some(stated), Some((_, distance))) = (stated, feet(map, [worm.member, wheel.member]))
        && (stated - distance).abs() > OFFSET
    {
        source.note(format!(
            "{}: center_distance is {} mm, but the axes are {distance:.4} mm apart, which counts",
            stage.label(),
            number(stated)
        ));
    }
    let hand = match source.number(worm.gear, "lead_angle_worm_gear", Quantity::Angle) {
        Some(lead) if lead < 0.0 => "left",
        Some(_) => "right",
        None => {
            source.assume(format!(
                "{}: the file states no lead_angle_worm_gear; right-hand threads were taken",
                worm.gear.label()
            ));
            "right"
        }
    };
    source.assume(
        "a positive lead angle of a worm is a right-hand thread; the sense changes the directions of rotation and of the axial forces",
    );
    let widths = [
        "effective_face_width_worm_wheel",
        "face_width_worm_wheel",
        "rim_width_worm_wheel",
    ];
    let width = widths.iter().find_map(|id| length(wheel.gear, id));
    let width = width.unwrap_or_else(|| source.needed(wheel.gear, widths[0], Quantity::Length));
    let threads = source.needed(worm.gear, "length_worm_gear", Quantity::Length);
    for (placed, facewidth, hand) in [(worm, threads, Some(hand)), (wheel, width, None)] {
        let mut gear = gear_of(map, &placed, facewidth, hand);
        gear.tip_diameter = length(placed.gear, "tip_diameter_worm_gear");
        gear.root_diameter = length(placed.gear, "root_diameter_worm_gear");
        found.gears.push(gear);
    }
    found.meshes.push(CrossedMesh {
        section: "worm_meshes",
        id: id_of_stage,
        comment: named(stage),
        gears: [worm, wheel].map(|placed| id("gear", placed.gear.id)),
        keys,
        lubricant: oil_of(map, stage),
    });
}

/// Cylindrical gears on axes that cross; the gears are written with the other cylindrical ones.
fn crossed_helical(map: &Map<'_>, stage: &Component, [a, b]: &[ReadGear<'_>; 2], found: &mut Crossed) {
    let source = map.source;
    if (a.normal_module - b.normal_module).abs() > 1e-6 {
        source.error(
            stage,
            codes::REXS_MODEL,
            &format!(
                "its gears have the normal modules {} and {} mm",
                number(a.normal_module),
                number(b.normal_module)
            ),
            "correct the gears in the program that exported the model",
        );
        return;
    }
    if [a, b].iter().any(|gear| gear.component.kind == "ring_gear") {
        source.error(
            stage,
            codes::REXS_PART,
            "crossed helical gears with internal teeth are not available",
            "check u_axis_vector of both shafts",
        );
        return;
    }
    let mut keys = vec![("normal_module", format!("{} mm", number(a.normal_module)))];
    if let Some(angle) = a.pressure_angle.or(b.pressure_angle) {
        keys.push(("pressure_angle", format!("{} deg", number(angle))));
    }
    let angles = [a, b].map(|gear| format!("{} deg", number(gear.helix.abs())));
    keys.push(("helix_angle", format!("[{}]", angles.join(", "))));
    found.meshes.push(CrossedMesh {
        section: "crossed_helical_meshes",
        id: id("stage", stage.id),
        comment: named(stage),
        gears: [a, b].map(|gear| id("gear", gear.component.id)),
        keys,
        lubricant: oil_of(map, stage),
    });
}
