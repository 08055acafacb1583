//! One operating point of a gearbox in the report: loads, power balance, and the evidence of its losses.

use std::sync::Arc;

use gearloss_framework::description::AssumedEntry;
use gearloss_framework::evaluate::{Point, Reading, Solution};
use gearloss_framework::flow::Tolerance;
use gearloss_framework::mechanism::bearing::BearingPart;
use gearloss_framework::registry::{Evidence, kind_of};
use gearloss_framework::transmission::Transmission;
use gearloss_studies::analyses::common::axes::{speeds, torques};
use gearloss_studies::analyses::{Built, Planner, gear_of};
use gearloss_studies::numbers::RPM;
use gearloss_studies::points::{Given, OilTemperature, evidence};

use super::PageTable;
use super::gearbox::table;
use crate::picture::{Picture, Screen, Waterfall};
use crate::point::flow_rows;
use crate::schematic::oil_section;
use crate::text::{fixed, number};

/// The point of the report: from the study, or the largest torque and speed of its first grid.
pub fn place(runner: &Planner<'_>, t: &Transmission) -> Option<(String, Given)> {
    let entry = &runner.study.entry;
    let given = |torque, speed| Given {
        torque,
        speed,
        oil: None,
    };
    if let Some(at) = &entry.report_at {
        return Some((gear_of(at.gear.as_deref(), t).to_owned(), given(at.torque, at.speed)));
    }
    let (name, grid) = entry.grids.iter().next()?;
    let path = format!("grids.{name}");
    let greatest = |values: Vec<f64>| values.into_iter().reduce(|a, b| if b.abs() > a.abs() { b } else { a });
    let torque = greatest(torques(runner, &path, &grid.torque, t).ok()?)?;
    let speed = greatest(speeds(runner, &path, &grid.speed, t).ok()?)?;
    let gear = grid.gear.selected(t).into_iter().next()?;
    t.state(&gear).ok()?;
    Some((gear, given(torque, speed)))
}

/// The report of one point.
pub struct Page {
    /// The point as text.
    pub words: String,
    /// Loads and balance with the first set, evidence of the losses with every set.
    pub tables: Vec<PageTable>,
    /// Torque and speed as text.
    pub place: String,
    /// Loss of each part of the drawing with the first set. \[W\]
    pub losses: Vec<(String, f64)>,
    /// From the input power to the output power with every set.
    pub pictures: Vec<Picture>,
    /// Cross-section of the housing with its oil, with the first set.
    pub oil: String,
    /// How much of the loss with the first set is from models that no measured set judges; absent if it is little.
    pub unjudged: Option<String>,
}

/// Solves the point with every set.
pub fn page(runner: &Planner<'_>, sets: &[Arc<Built<'_>>], assumed: &[AssumedEntry]) -> Option<Page> {
    let first = sets.first()?;
    let (gear, given) = place(runner, &first.transmission)?;
    let (mut tables, mut pictures, mut rests, mut words) = (Vec::new(), Vec::new(), Vec::new(), String::new());
    let (mut losses, mut oil, mut unjudged) = (Vec::new(), String::new(), None);
    for (i, b) in sets.iter().enumerate() {
        let t = &b.transmission;
        let points = runner.listed(t, &gear, vec![given]);
        let case = points.case(t).ok()?;
        let (own_torques, own_speeds) = ([given.torque], [given.speed]);
        let point = Point {
            speeds: &own_speeds[..case.speed_ports.len().min(1)],
            torques: &own_torques[..case.torque_ports.len().min(1)],
            flow: points.flow,
            tolerance: Tolerance::default(),
            inclination: 0.0,
        };
        let mut scratch = t.scratch(&case);
        let warm = OilTemperature::find(points.oil, t, &case, &point, &mut scratch);
        let solution = t.evaluate(&case, &point, warm.temperatures(), &mut scratch);
        if i == 0 {
            let conditions = &runner.study.entry.conditions;
            words = format!(
                "gear {gear}, {} Nm at {}, {:.0} rpm at {}, oil {} °C{}, models {}",
                given.torque,
                conditions.torque_at,
                given.speed * RPM,
                conditions.speed_at,
                number(Some(warm.oil), 1),
                if warm.outcome().is_some() {
                    " by heat balance"
                } else {
                    ""
                },
                b.name
            );
            let levels = solution.oil_levels();
            oil = levels
                .and_then(|levels| oil_section(t, &b.resolved.value, &levels, solution.pockets()))
                .unwrap_or_default();
            if solution.has_flow() {
                losses = losses_of_parts(t, &solution);
                unjudged = unjudged_share(b, &solution);
                tables.push(bearings(b, &solution));
                tables.push(dips(t, &solution));
                tables.extend(oil_flows(&solution));
                tables.push(ports(t, &solution));
                tables.push(members(t, &solution));
            } else {
                words.push_str(&format!("; {}: no torques, loads or losses", solution.status().name()));
            }
        }
        if solution.has_flow() {
            rests.push(rest_on(b, &solution, assumed));
            pictures.extend(waterfall(&b.name, &solution));
        }
    }
    tables.push(table(
        "Share of the loss in % that depends on assumed inputs, unchecked formulas, and models outside their validity range",
        &[
            "models",
            "loss W",
            "assumed input of the component",
            "formula or default quoted from memory (not checked) or assumed",
            "outside a validity range",
            "any",
            "assumed, affects all components",
        ],
        rests,
    ));
    tables.retain(|t: &PageTable| !t.rows.is_empty());
    Some(Page {
        words,
        tables,
        place: crate::text::place(given.torque, given.speed * RPM),
        losses,
        pictures,
        oil,
        unjudged,
    })
}

/// Share of the loss from models without a measured set from which a report says so. A convention: below, the sentence would be noise.
const MUCH: f64 = 0.25;

/// Share of the loss of a model from which it is named.
const NAMED: f64 = 0.05;

/// How much of the loss is from models that no measured set of the corpus judges, with the largest of them; absent if it is little. Models
/// whose law the user states rest on the user's own data.
fn unjudged_share(b: &Built<'_>, solution: &Solution<'_>) -> Option<String> {
    let t = &b.transmission;
    let total = solution.loss().filter(|loss| *loss > 0.0)?;
    let mut models: Vec<(String, f64)> = Vec::new();
    for (part, loss) in solution.parts() {
        let entry = &t.instances()[part.notes.instance()].entry;
        let kind = kind_of(&b.resolved.value, &part.path);
        if entry.is_user_defined() || !entry.compared().of_kind(kind.as_deref()).is_empty() {
            continue;
        }
        let name = format!("{}/{}", entry.mechanism, entry.name);
        match models.iter_mut().find(|(known, _)| *known == name) {
            Some((_, watts)) => *watts += loss.watts(),
            None => models.push((name, loss.watts())),
        }
    }
    models.sort_by(|a, b| b.1.total_cmp(&a.1));
    let share = models.iter().map(|(_, watts)| watts).sum::<f64>() / total;
    let percent = |share: f64| number(Some(100.0 * share), 0);
    let named = models.iter().filter(|(_, watts)| watts / total >= NAMED);
    let named: Vec<String> = named
        .map(|(name, watts)| format!("{name} {} %", percent(watts / total)))
        .collect();
    (share >= MUCH).then(|| {
        format!(
            "{} % of the loss at the report's point is from models that no measured set of the corpus judges: {}",
            percent(share),
            named.join(", ")
        )
    })
}

/// Losses by the parts of the drawing: those of a mesh and its drags belong to both of its gears in equal parts.
pub fn losses_of_parts(t: &Transmission, solution: &Solution<'_>) -> Vec<(String, f64)> {
    let mut list: Vec<(String, f64)> = Vec::new();
    let mut add = |path: &str, watts: f64| match list.iter_mut().find(|(listed, _)| listed == path) {
        Some((_, sum)) => *sum += watts,
        None => list.push((path.to_owned(), watts)),
    };
    for (i, (part, loss)) in solution.parts().enumerate() {
        let watts = loss.watts();
        if !watts.is_finite() {
            continue;
        }
        let path = part.path.split(".drag.").next().unwrap_or(&part.path);
        let gears = gears_of(t, i);
        if gears.is_empty() {
            add(path, watts);
        }
        for gear in &gears {
            add(gear, watts / gears.len() as f64);
        }
    }
    list
}

/// The losses of all components between the input and the output, with the name of the model set.
pub fn waterfall(set: &str, solution: &Solution<'_>) -> Option<Picture> {
    let ends = [("input", solution.input_power()?), ("output", solution.output_power()?)];
    let losses = solution.parts().filter_map(|(part, loss)| {
        let watts = loss.watts();
        (watts.is_finite() && watts > 0.0).then(|| (part.path.clone(), part.mechanism.to_owned(), watts))
    });
    Some(Picture::Screen(Screen::Waterfall(Waterfall {
        title: format!("From the input to the output, {set}"),
        unit: "W".to_owned(),
        ends: ends.map(|(name, power)| (name.to_owned(), power)),
        losses: losses.collect(),
    })))
}

fn read(readings: &[Reading], name: &str) -> Option<f64> {
    readings.iter().find(|r| r.name == name).map(|r| r.value)
}

/// Loads of bearings, with static safety, speed factor and oil level.
fn bearings(b: &Built<'_>, solution: &Solution<'_>) -> PageTable {
    let t = &b.transmission;
    let mut rows = Vec::new();
    for (i, part) in t.parts().iter().enumerate().filter(|(_, p)| p.mechanism == "bearing") {
        let readings = solution.readings(i);
        let read = |name: &str| read(&readings, name);
        let id = part.path.trim_start_matches("bearings.");
        let described = &b.resolved.value["bearings"][id];
        let bearing = gearloss_framework::registry::from_resolved::<BearingPart>(described).ok();
        let (radial, axial) = (read("radial").unwrap_or(0.0), read("axial").unwrap_or(0.0));
        let safety = bearing
            .as_ref()
            .and_then(BearingPart::static_rating)
            .map(|rating| rating.safety(radial, axial))
            .filter(|safety| safety.is_finite());
        let speed = read("speed").unwrap_or(0.0);
        let rolling = bearing.as_ref().filter(|b| b.kind.rolls());
        let factor = rolling.map(|b| speed.abs() * b.mean_diameter() * 1e3);
        let name = bearing.as_ref().and_then(|b| b.designation.clone());
        rows.push(vec![
            id.to_owned(),
            name.unwrap_or_default(),
            format!("{speed:.1}"),
            format!("{radial:.1}"),
            format!("{axial:.1}"),
            number(read("tilting"), 2),
            number(safety, 2),
            number(factor.map(|f| f * 1e-6), 3),
            number(read("oil_height"), 1),
            number(Some(solution.part(i).watts()), 3),
        ]);
    }
    table(
        "Bearings",
        &[
            "bearing",
            "designation",
            "n rpm",
            "F_r N",
            "F_a N",
            "M Nm",
            "C0/P0",
            "n d_m 1e6 mm/min",
            "H mm",
            "loss W",
        ],
        rows,
    )
}

/// Immersion depths of gears if a model uses them.
fn dips(t: &Transmission, solution: &Solution<'_>) -> PageTable {
    let drags = t.parts().iter().enumerate().filter(|(_, p)| p.mechanism == "gear_drag");
    let rows = drags.map(|(i, part)| {
        let readings = solution.readings(i);
        let read = |name: &str| number(read(&readings, name), 1);
        vec![
            part.path.clone(),
            read("tip_dip"),
            read("dip"),
            read("tip_dip_2"),
            read("dip_2"),
            number(Some(solution.part(i).watts()), 3),
        ]
    });
    table(
        "Immersion depth of gears at the tip and at the reference circle, first and second gear",
        &["drag", "tip mm", "reference mm", "tip 2 mm", "reference 2 mm", "loss W"],
        rows.collect(),
    )
}

/// Flows of the oil network.
fn oil_flows(solution: &Solution<'_>) -> Option<PageTable> {
    let (head, rows) = flow_rows(&solution.oil_supply()?);
    Some(table("Flows of the oil network", &head, rows))
}

fn ports(t: &Transmission, solution: &Solution<'_>) -> PageTable {
    let mut rows: Vec<Vec<String>> = t
        .ports()
        .iter()
        .enumerate()
        .map(|(i, port)| {
            let (speed, torque) = (solution.speed(port.member), solution.known_torque(i));
            vec![
                port.name.clone(),
                fixed(speed * RPM, 2),
                number(torque, 4),
                number(torque.map(|torque| speed * torque), 3),
            ]
        })
        .collect();
    let gap = solution.residual().map(|r| format!("{r:.1e}"));
    for (name, value) in [
        ("losses", number(solution.loss().map(|l| -l), 3)),
        ("residual", gap.unwrap_or_else(|| "-".to_owned())),
        ("efficiency %", number(solution.efficiency().map(|e| 100.0 * e), 3)),
    ] {
        rows.push(vec![name.to_owned(), String::new(), String::new(), value]);
    }
    table("Power at the ports", &["port", "n rpm", "T Nm", "P W"], rows)
}

/// Powers of each member.
fn members(t: &Transmission, solution: &Solution<'_>) -> PageTable {
    let torques = solution.member_torques();
    let rows = t
        .members()
        .iter()
        .zip(&torques)
        .enumerate()
        .map(|(i, (name, balance))| {
            let speed = solution.speed(i);
            let watts = |torque: f64| format!("{:.3}", torque * speed);
            vec![
                name.clone(),
                format!("{:.2}", speed * RPM),
                watts(balance.ports),
                watts(balance.meshes),
                watts(balance.drags),
                format!("{:.1e}", balance.residual() * speed),
            ]
        });
    table(
        "Power balance by member, inflow positive",
        &["member", "n rpm", "ports W", "meshes W", "drags W", "residual W"],
        rows.collect(),
    )
}

/// Shares of the loss that depend on assumptions, unchecked formulas or extrapolation, in percent.
fn rest_on(b: &Built<'_>, solution: &Solution<'_>, assumed: &[AssumedEntry]) -> Vec<String> {
    let t = &b.transmission;
    let known = evidence(t, &b.resolved, &|path| b.gearbox.places.is_written(path));
    let weak = |path: &str| {
        let grades = known.iter().filter(|w| w.grade >= Evidence::Recalled);
        grades
            .flat_map(|w| &w.paths)
            .any(|p| p == path || p.starts_with(&format!("{path}.")))
    };
    let patterns: Vec<&str> = assumed
        .iter()
        .flat_map(|a| a.paths.iter().map(String::as_str))
        .collect();
    let extents = solution.extents();
    let mut sums = [0.0; 4];
    for (i, (part, loss)) in solution.parts().enumerate() {
        let watts = loss.watts();
        let component = part.path.split(".drag.").next().unwrap_or(&part.path);
        let instance = &t.instances()[part.notes.instance()];
        let is_within = |path: &str| path == instance.path || path.starts_with(&format!("{}.", instance.path));
        let left = t.instances().iter().filter(|i| is_within(&i.path)).any(|i| {
            let limits = i.entry.limits.iter();
            limits
                .into_iter()
                .any(|l| extents[i.notes.limits() + l.index].outside > 0)
        });
        let flags = [
            gears_of(t, i)
                .iter()
                .map(String::as_str)
                .chain([component])
                .any(|c| is_assumed(&patterns, c)),
            weak(&instance.path) || weak(component),
            left,
        ];
        for (sum, flag) in sums.iter_mut().zip(flags) {
            *sum += if flag { watts } else { 0.0 };
        }
        sums[3] += if flags.contains(&true) { watts } else { 0.0 };
    }
    let loss = solution.loss().filter(|loss| *loss > 0.0);
    let share = |watts: f64| number(loss.map(|loss| 100.0 * watts / loss), 1);
    let mut row = vec![b.name.clone(), number(loss, 3)];
    row.extend(sums.map(share));
    // Assumptions on oil, housing, flanks or heat affect all components.
    let whole = ["lubricants", "materials", "housing", "surface", "thermal", "shafts"];
    let global: Vec<&str> = patterns
        .iter()
        .copied()
        .filter(|p| whole.contains(&p.split('.').next().unwrap_or_default()))
        .collect();
    row.push(if global.is_empty() {
        "-".to_owned()
    } else {
        global.join(", ")
    });
    row
}

/// Paths of the gears of a mesh, whose inputs are also inputs of its loss.
fn gears_of(t: &Transmission, part: usize) -> Vec<String> {
    let path = t.parts()[part].path.as_str();
    let path = path.split(".drag.").next().unwrap_or(path);
    t.gears_of_mesh(path).iter().map(|id| format!("gears.{id}")).collect()
}

/// True if a pattern matches the component, a part of it, or its parent.
fn is_assumed(patterns: &[&str], component: &str) -> bool {
    patterns.iter().any(|pattern| {
        let mut keys = pattern.split('.');
        component
            .split('.')
            .all(|key| keys.next().is_none_or(|p| p == "*" || p == key))
    })
}

#[cfg(test)]
mod tests {
    use super::is_assumed;

    #[test]
    fn a_pattern_names_a_component_its_values_or_its_section() {
        for (pattern, named) in [
            ("bearings.B3", true),
            ("bearings.*.at", true),
            ("bearings", true),
            ("bearings.B4", false),
            ("housing.oil", false),
        ] {
            assert_eq!(is_assumed(&[pattern], "bearings.B3"), named, "{pattern}");
        }
    }
}
