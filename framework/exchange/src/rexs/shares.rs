//! Loads on the teeth that a model has as results, as tables for `load_sharing: { type: file }`.
//!
//! Line loads (`local_normal_line_load`, from version 1.4 on) belong to points of a flank: their radius is a place along the path of contact, their
//! position along the axis one on the face. Factors after AGMA 925 belong to roll angles of the pinion, the gear with fewer teeth. Both must carry
//! the force of their mesh, as those of any file.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use gearloss_framework::contact::sharing::{CalculatedSharing, Flank, Sharing, SharingEntry};
use gearloss_framework::geometry::Pair;
use gearloss_framework::transmission::Transmission;

use super::draft::{Draft, Mesh};
use super::loads::{Values, all};
use super::map::{Map, id};
use super::model::{Component, Id};
use super::pose::sum;
use super::source::counted;
use super::units::Quantity;
use super::yaml::number;

const DATA_SET: &str = "meshing_contact_stage_data_set";
const LINE_LOAD: &str = "local_normal_line_load";
const FACTOR: &str = "load_sharing_factor_of_calculation_points_agma_925_2003";
const ROLL_ANGLE: &str = "roll_angles_of_calculation_points_agma_925_2003";

/// Difference of places, of the length of the path or of the face, that is rounding.
const ROUNDING: f64 = 1e-5;
/// Distance of the first and last roll angle from the ends of the path, over its length, that is rounding of tip circles.
const ENDS: f64 = 0.02;

/// Notes that loads on the teeth of a model are not taken because its gearbox has errors, which the report lists first.
pub fn postpone(map: &Map<'_>) {
    let cases = cases(map);
    let is_stated = |(kind, attribute): (&str, &str)| {
        let mut components = map.source.components(kind);
        components.any(|component| has(&cases, component, attribute))
    };
    if [("cylindrical_stage", FACTOR), (DATA_SET, LINE_LOAD)]
        .into_iter()
        .any(is_stated)
    {
        map.source
            .note("loads on the teeth are not taken until the errors above are corrected: import again");
    }
}

fn cases<'a>(map: &Map<'a>) -> Vec<Values<'a>> {
    all(map.source).into_iter().map(|(_, values)| values).collect()
}

/// True if the model or one of its cases states an attribute.
fn has(cases: &[Values<'_>], component: &Component, attribute: &str) -> bool {
    component.attribute(attribute).is_some() || cases.iter().any(|values| values.states(component, attribute))
}

/// Adds the table of each mesh whose loads the model has, and what its model takes of them; notes why others are not taken.
pub fn add(map: &Map<'_>, transmission: &Transmission, draft: &mut Draft) {
    let cases = cases(map);
    let Draft {
        meshes, gears, shares, ..
    } = draft;
    for mesh in meshes {
        let path = format!("meshes.{}", mesh.id);
        let stage = map.source.components("cylindrical_stage");
        let stage = stage.into_iter().find(|stage| id("stage", stage.id) == mesh.id);
        let part = transmission.cylindrical_meshes().find(|(_, known, _)| *known == path);
        let (Some(stage), Some((_, _, part))) = (stage, part) else {
            continue;
        };
        let face = mesh.gears.iter().filter_map(|id| {
            let gear = gears.iter().find(|gear| gear.id == *id)?;
            let at = gear.at?;
            Some([at - 0.5 * gear.facewidth, at + 0.5 * gear.facewidth])
        });
        let face = face.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]);
        let of = Teeth {
            map,
            stage,
            pair: &part.pair,
            gears: gear_ids(map, stage, mesh),
            face,
            cases: &cases,
        };
        let file = format!("shares_{}.csv", mesh.id);
        let carries_the_force = |text: &str| {
            let entry = SharingEntry::Calculated(CalculatedSharing::File { path: file.clone() });
            let read = Sharing::new(part, &entry, Flank::Drive, |_| Ok(Arc::from(text.as_bytes())));
            read.map_err(|fault| fault.at("").message).map(|_| ())
        };
        let Some(table) = of.table(carries_the_force) else {
            continue;
        };
        let at = table.torque.map(|torque| {
            let torque = number(torque.abs());
            format!("; the shares are those at {torque} Nm and hold for every torque")
        });
        map.source.assume(format!(
            "{}: its loss is integrated along the path of contact, with the loads on the teeth of the file and friction after Xu{}; without \
             `model` of the mesh it has that of `models`",
            mesh.id,
            at.unwrap_or_default()
        ));
        for line in table.notes {
            map.source.note(format!("{}: {line}", stage.label()));
        }
        mesh.shares = Some(file.clone());
        shares.push((file, table.text));
    }
}

/// A table of loads on the teeth.
struct Table {
    text: String,
    /// The only torque of the loads, whose shares hold for every torque. \[Nm\]
    torque: Option<f64>,
    /// What of the model it leaves out.
    notes: Vec<String>,
}

/// The components of both gears in the order of the mesh.
fn gear_ids(map: &Map<'_>, stage: &Component, mesh: &Mesh) -> [Id; 2] {
    let relation = map
        .source
        .relations("stage")
        .find(|of| of.role("stage") == Some(stage.id));
    let role = |role| relation.and_then(|of| of.role(role)).unwrap_or_default();
    let [first, second] = [role("gear_1"), role("gear_2")];
    if id("gear", first) == mesh.gears[0] {
        [first, second]
    } else {
        [second, first]
    }
}

/// A mesh with what its loads refer to.
struct Teeth<'m, 'a> {
    map: &'m Map<'a>,
    stage: &'a Component,
    pair: &'m Pair,
    gears: [Id; 2],
    /// Start and end of the face that both gears share, if they have positions. \[mm\]
    face: Option<[f64; 2]>,
    cases: &'m [Values<'a>],
}

/// A line load at a place. \[-, -, N/mm\]
type Place = [f64; 3];

impl<'a> Teeth<'_, 'a> {
    /// Place on the path of contact, from 0 to 1, of a point that is this far from the end of the line of action on the side of a gear. \[m\]
    fn along_the_path(&self, gear: usize, distance: f64) -> f64 {
        let [start, .., end] = self.pair.points;
        let x = if gear == 0 {
            distance
        } else {
            self.pair.tangent_length - distance
        };
        (x - start) / (end - start)
    }

    /// The cases that state an attribute themselves; else the only one, or the components without a case.
    fn stating(&self, component: &Component, attribute: &str) -> Vec<Values<'a>> {
        let own: Vec<Values<'a>> = (self.cases.iter().copied())
            .filter(|values| values.states(component, attribute))
            .collect();
        match (&own[..], self.cases) {
            ([], [only]) => vec![*only],
            ([], [first, ..]) => vec![first.without_case()],
            _ => own,
        }
    }

    /// The line loads, or the factors where there are no line loads that can be used; notes why loads are not taken.
    fn table(&self, carries_the_force: impl Fn(&str) -> Result<(), String>) -> Option<Table> {
        let kinds: [(&str, fn(&Self) -> Option<Result<Table, String>>); 2] = [
            ("line loads on its teeth", Self::line_loads),
            ("load sharing factors of its teeth", Self::factors),
        ];
        kinds.into_iter().find_map(|(what, read)| {
            let table = read(self)?.and_then(|table| carries_the_force(&table.text).map(|()| table));
            let not_taken = |why: String| {
                let line = format!("{}: the {what} were not taken: {why}", self.stage.label());
                self.map.source.note(line);
            };
            table.map_err(not_taken).ok()
        })
    }

    /// A table of the factors after AGMA 925 over the path; `None` without them.
    fn factors(&self) -> Option<Result<Table, String>> {
        has(self.cases, self.stage, FACTOR).then(|| self.table_of_factors())
    }

    fn table_of_factors(&self) -> Result<Table, String> {
        if self.pair.helix_angle != 0.0 || self.pair.internal {
            return Err("factors after AGMA 925 are shares of the force only for external spur gears".to_owned());
        }
        let read = |values: &Values<'a>| {
            let factors = values.numbers(self.stage, FACTOR, Quantity::Number);
            (factors, values.numbers(self.stage, ROLL_ANGLE, Quantity::RollAngle))
        };
        let stated: Vec<_> = self.stating(self.stage, FACTOR).iter().map(read).collect();
        let differing = stated.iter().filter(|other| **other != stated[0]).count();
        let (factors, angles) = stated.into_iter().next().unwrap_or_default();
        let factors = factors.ok_or("they are not an array")?;
        let Some(angles) = angles else {
            return Err(format!("{ROLL_ANGLE} is missing, so their places are not known"));
        };
        if factors.len() != angles.len() {
            return Err(format!("{} factors have {} roll angles", factors.len(), angles.len()));
        }
        let pinion = usize::from(self.pair.z[1] < self.pair.z[0]);
        let place = |angle: f64| self.along_the_path(pinion, angle * self.pair.base_radius[pinion]);
        let mut rows: Vec<[f64; 2]> = angles
            .iter()
            .zip(factors)
            .map(|(angle, factor)| [place(*angle), factor])
            .collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let ends = [rows.first(), rows.last()].map(|row| row.map_or(f64::NAN, |row| row[0]));
        if !(ends[0].abs() < ENDS && (ends[1] - 1.0).abs() < ENDS) {
            return Err(format!(
                "their roll angles, as those of the gear with fewer teeth, go from {} to {} of the path of contact, not from 0 to 1",
                number(ends[0]),
                number(ends[1])
            ));
        }
        let mut text = "path [-],share [-]\n".to_owned();
        let mut before = f64::NEG_INFINITY;
        for [path, share] in rows {
            // Two factors at one place are a jump.
            let path = path.clamp(0.0, 1.0).max(before + 1e-9);
            let _ = writeln!(text, "{},{}", path.min(1.0), number(share));
            before = path;
        }
        let mut notes = Vec::new();
        if differing > 0 {
            let cases = counted(differing, "further load case");
            notes.push(format!("the factors of {cases} differ and were not taken"));
        }
        Ok(Table {
            text,
            torque: None,
            notes,
        })
    }

    /// A table of the line loads over path and face, at each torque; `None` without them.
    fn line_loads(&self) -> Option<Result<Table, String>> {
        let sets = self.map.source.components(DATA_SET);
        let sets = sets.filter(|set| has(self.cases, set, LINE_LOAD));
        let mut sets = sets.filter_map(|set| {
            let list = self.map.origin(set.id, "point_list")?;
            Some((set, list, self.gear_of(list)?))
        });
        let (set, list, gear) = sets.next()?;
        let further = sets.count();
        Some(self.table_of_line_loads(set, list, gear).map(|mut table| {
            if further > 0 {
                let left_out = counted(further, "further data set");
                let label = set.label();
                table.notes.push(format!(
                    "the line loads of {label} stand for both flanks; {left_out} left out"
                ));
            }
            table
        }))
    }

    /// The gear in whose frame the points of a list are, if they belong to this mesh: to the data of a gear in this stage, or to a gear or its flank
    /// that is in no other stage.
    fn gear_of(&self, list: &Component) -> Option<usize> {
        let source = self.map.source;
        let mut assemblies = source
            .relations("assembly")
            .filter(|of| of.role("part") == Some(list.id));
        let base = assemblies.find_map(|of| of.role("assembly"))?;
        let place = |gear: Option<Id>| self.gears.iter().position(|own| Some(*own) == gear);
        let mut data = source
            .relations("stage_gear_data")
            .filter(|of| of.role("stage_gear_data") == Some(base));
        if let Some(data) = data.next() {
            return place(data.role("gear").filter(|_| data.role("stage") == Some(self.stage.id)));
        }
        let mut flanks = source.relations("flank");
        let flank = flanks.find(|of| [of.role("left"), of.role("right")].contains(&Some(base)));
        let gear = flank.map_or(Some(base), |of| of.role("gear"));
        let stages = source.relations("stage");
        let own = stages.filter(|of| [of.role("gear_1"), of.role("gear_2")].contains(&gear));
        place(gear).filter(|_| own.count() == 1)
    }

    /// The torque of the first gear at a case, with its sign; `None` if it is not stated. \[Nm\]
    fn torque(&self, values: &Values<'a>) -> Option<f64> {
        let source = self.map.source;
        let of = |gear: usize| {
            let mut data = source.relations("stage_gear_data");
            let data =
                data.find(|of| of.role("stage") == Some(self.stage.id) && of.role("gear") == Some(self.gears[gear]))?;
            let data = source.component(data.role("stage_gear_data")?)?;
            values.number(data, "torque", Quantity::Moment)
        };
        let [first, second] = self.pair.z.map(f64::from);
        of(0)
            .or_else(|| Some(-of(1)? * first / second))
            .filter(|torque| *torque != 0.0)
    }

    fn table_of_line_loads(&self, set: &'a Component, list: &'a Component, gear: usize) -> Result<Table, String> {
        if self.pair.internal {
            return Err("line loads of internal teeth are not read".to_owned());
        }
        let places = self.places(list, gear)?;
        let mut blocks: Vec<(f64, Vec<Place>)> = Vec::new();
        let (mut equal, mut opposite) = (0, 0);
        for values in self.stating(set, LINE_LOAD) {
            let Some(torque) = self.torque(&values) else {
                return Err(
                    "`torque` of its cylindrical_stage_gear_data is missing, so the force is not known".to_owned(),
                );
            };
            if blocks.iter().any(|(known, _)| known * torque < 0.0) {
                opposite += 1;
            } else if blocks.iter().any(|(known, _)| *known == torque) {
                equal += 1;
            } else {
                blocks.push((torque, Self::loads(&values, set, &places)?));
            }
        }
        let mut notes = Vec::new();
        for (count, why) in [
            (equal, "their torques are those of other cases"),
            (
                opposite,
                "their torques have the opposite sense, and those of the first sense stand for both flanks",
            ),
        ] {
            if count > 0 {
                let cases = counted(count, "load case");
                notes.push(format!("the line loads of {cases} were not taken: {why}"));
            }
        }
        blocks.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        // A table over the torque has two at least; the shares at one torque hold for all.
        let one = blocks.len() == 1;
        let value = |torque: f64, load: f64| {
            let force = torque.abs() / self.pair.base_radius[0];
            number(if one {
                load * 1e3 * self.pair.facewidth / force
            } else {
                load
            })
        };
        let torque_at = |torque: f64| if one { String::new() } else { number(torque.abs()) + "," };
        // Where contact begins on the face of helical gears depends on the flank, which a model does not name clearly: they have the mean.
        let has_face = self.pair.helix_angle == 0.0;
        let mut text = if one { String::new() } else { "torque [Nm],".to_owned() };
        text.push_str(if has_face { "path [-],face [-]," } else { "path [-]," });
        text.push_str(if one { "share [-]\n" } else { "line load [N/mm]\n" });
        for (torque, loads) in &blocks {
            for (path, along_the_face) in rows(loads)? {
                let start = format!("{}{}", torque_at(*torque), number(path));
                if !has_face {
                    let _ = writeln!(text, "{start},{}", value(*torque, mean(&along_the_face)));
                    continue;
                }
                for [face, load] in along_the_face {
                    let _ = writeln!(text, "{start},{},{}", number(face), value(*torque, load));
                }
            }
        }
        let torque = blocks.first().filter(|_| one).map(|(torque, _)| *torque);
        Ok(Table { text, torque, notes })
    }

    /// Place along path and face of each point of a list. \[-, -\]
    fn places(&self, list: &Component, gear: usize) -> Result<BTreeMap<i64, [f64; 2]>, String> {
        let source = self.map.source;
        let read = |attribute, quantity| source.numbers(list, attribute, quantity);
        let ids = read("point_ids", Quantity::Number).ok_or_else(|| format!("{} has no point_ids", list.label()))?;
        let radii = read("point_coordinates_radius", Quantity::Length);
        let along = read("point_coordinates_u_coord", Quantity::Length);
        let points: Vec<[f64; 2]> = if let (Some(radii), Some(along)) = (radii, along) {
            radii.into_iter().zip(along).map(|(radius, u)| [radius, u]).collect()
        } else {
            let rows = source.points(list, "point_coordinates");
            let rows = rows.ok_or_else(|| format!("{} has no coordinates of its points", list.label()))?;
            rows.into_iter().map(|[u, v, w]| [v.hypot(w), u]).collect()
        };
        if points.len() != ids.len() {
            return Err(format!(
                "{} has {} point_ids and {} points",
                list.label(),
                ids.len(),
                points.len()
            ));
        }
        let component = self.gears[gear];
        let frame = self.map.poses.get(component).zip(self.map.member_with(component));
        let (pose, member) = frame.ok_or("its gear has no position")?;
        let base = self.pair.base_radius[gear];
        let [start, end] = self.face.ok_or("its gears have no positions on their shafts")?;
        if end <= start {
            return Err("its gears have no common face at their positions".to_owned());
        }
        let place = |[radius, u]: [f64; 2]| {
            let distance = (radius * 1e-3).powi(2) - base * base;
            let position = self
                .map
                .along(member, sum(pose.origin, pose.turned([u, 0.0, 0.0]), 1.0));
            let face = (position - start) / (end - start);
            [self.along_the_path(gear, distance.max(0.0).sqrt()), face]
        };
        Ok(ids
            .iter()
            .map(|id| *id as i64)
            .zip(points.into_iter().map(place))
            .collect())
    }

    /// The line loads of a case at their places; points beside the path and the face carry none.
    fn loads(values: &Values<'a>, set: &'a Component, places: &BTreeMap<i64, [f64; 2]>) -> Result<Vec<Place>, String> {
        let ids = values.numbers(set, "set_ids", Quantity::Number);
        let ids = ids.ok_or_else(|| format!("{} has no set_ids, which name the points of its values", set.label()))?;
        let loads = values
            .numbers(set, LINE_LOAD, Quantity::LineLoad)
            .ok_or("they are not an array")?;
        if ids.len() != loads.len() {
            return Err(format!(
                "{} has {} set_ids and {} line loads",
                set.label(),
                ids.len(),
                loads.len()
            ));
        }
        let mut found = Vec::new();
        for (id, load) in ids.iter().zip(loads) {
            let Some(place) = places.get(&(*id as i64)) else {
                return Err(format!("the point {id} of {} is not in its point_list", set.label()));
            };
            let is_inside = place.iter().all(|x| (-ROUNDING..=1.0 + ROUNDING).contains(x));
            match (is_inside, load == 0.0) {
                (true, _) => found.push([place[0].clamp(0.0, 1.0), place[1].clamp(0.0, 1.0), load]),
                (false, true) => {}
                (false, false) => {
                    return Err(format!(
                        "the point {id} carries {} N/mm at {} of the path of contact and {} of the common face",
                        number(load),
                        number(place[0]),
                        number(place[1])
                    ));
                }
            }
        }
        Ok(found)
    }
}

/// Loads of a full grid by their place on the path, each with place on the face and load.
fn rows(loads: &[Place]) -> Result<Vec<(f64, Vec<[f64; 2]>)>, String> {
    let mut sorted = loads.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut rows: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for [path, face, load] in sorted {
        match rows.last_mut() {
            Some((known, row)) if path - *known <= ROUNDING => row.push([face, load]),
            _ => rows.push((path, vec![[face, load]])),
        }
    }
    for (_, row) in &mut rows {
        row.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    let faces: Vec<f64> = rows
        .first()
        .map(|(_, row)| row.iter().map(|at| at[0]).collect())
        .unwrap_or_default();
    for (_, row) in &mut rows {
        let same = row.len() == faces.len()
            && row
                .iter()
                .zip(&faces)
                .all(|(at, face)| (at[0] - face).abs() <= ROUNDING);
        let apart = row.windows(2).all(|two| two[1][0] - two[0][0] > ROUNDING);
        if !(same && apart) {
            return Err(format!(
                "its {} points are no grid of radii and positions along the face",
                loads.len()
            ));
        }
        for (at, face) in row.iter_mut().zip(&faces) {
            at[0] = *face;
        }
    }
    if rows.len() < 2 {
        return Err("its points have one place along the path of contact only".to_owned());
    }
    Ok(rows)
}

/// Mean over the face: straight lines between the places, constant beyond the first and the last.
fn mean(row: &[[f64; 2]]) -> f64 {
    let between = row
        .windows(2)
        .map(|two| 0.5 * (two[0][1] + two[1][1]) * (two[1][0] - two[0][0]));
    match (row.first(), row.last()) {
        (Some(first), Some(last)) => first[0] * first[1] + between.sum::<f64>() + (1.0 - last[0]) * last[1],
        _ => 0.0,
    }
}
