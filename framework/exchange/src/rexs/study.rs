//! The text of a study with the load cases, and the table of them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::loads::{Case, Loads, gear_name};
use super::map::{Force, Map, id};
use super::yaml::{number, quoted};

/// A study and its table.
#[derive(Debug)]
pub struct Study {
    pub study: String,
    pub table: String,
}

/// A value of the gearbox that differs between the load cases: column with unit, path, value in each case.
struct Bound {
    column: String,
    unit: &'static str,
    path: String,
    values: Vec<f64>,
}

/// The study; `None` without load cases. `gears` are the gear states of the gearbox.
pub fn study(map: &Map<'_>, loads: &Loads, title: &str, gears: &BTreeSet<String>) -> Option<Study> {
    if loads.cases.is_empty() {
        return None;
    }
    let bound = bound(map, loads);
    let mut text = format!(
        "# yaml-language-server: $schema=study.schema.json\n\
         # The load cases of the REXS model, one by one and as load spectrum. `gearloss run` writes tables, figures and a report.\n\
         gearloss: study/1\ntitle: {}\ngearboxes: {{ gearbox: gearbox.yaml }}\n\nconditions:\n  torque_at: {}\n  speed_at: {}\n",
        quoted(&format!("Load cases of {title}")),
        loads.torque_at,
        loads.speed_at
    );
    let spectra = spectra(map, loads, gears);
    if !spectra.is_empty() {
        text.push_str("\ncycles:\n");
        for spectrum in &spectra {
            text.push_str(&spectrum.text);
        }
    }
    let gear = gears
        .iter()
        .next()
        .map_or_else(String::new, |gear| format!("gear: {gear}, "));
    let field = "{ of_rating: [0.1, 0.25, 0.5, 0.75, 1] }";
    let _ = write!(
        text,
        "\n#grids: {{ field: {{ {gear}torque: {field}, speed: {field} }} }}\n"
    );
    text.push_str("analyses:\n  load_cases:\n    type: operating_points\n    title: The load cases\n    data: { file: load_cases.csv }\n");
    if !bound.is_empty() {
        text.push_str("    bind:                                  # what differs between the load cases, beside torque and speed\n");
        for bound in &bound {
            let _ = writeln!(text, "      {}: {}", bound.column, bound.path);
        }
    }
    for spectrum in &spectra {
        let gear = spectrum
            .gear
            .as_ref()
            .map_or_else(String::new, |gear| format!(", gear: {gear}"));
        let _ = writeln!(
            text,
            "  {0}_losses: {{ type: cycle, title: {1}, cycles: [{0}], by: component{gear} }}",
            spectrum.name,
            quoted(&spectrum.title)
        );
    }
    text.push_str(
        "  #map: { type: map, grid: field }         # efficiency over torque and speed, with `grids` above\n",
    );
    Some(Study {
        study: text,
        table: table(loads, &bound, gears),
    })
}

/// Values that change from case to case: oil temperature and external forces.
fn bound(map: &Map<'_>, loads: &Loads) -> Vec<Bound> {
    let mut all = Vec::new();
    if loads.cases.iter().all(|case| case.oil.is_some()) {
        all.push(Bound {
            column: "oil".to_owned(),
            unit: "degC",
            path: "thermal.oil".to_owned(),
            values: loads.cases.iter().filter_map(|case| case.oil).collect(),
        });
    }
    let mut count: BTreeMap<i64, usize> = BTreeMap::new();
    for force in &map.forces {
        let place = count.entry(force.member).or_default();
        let shaft = format!("shafts.{}.loads.{place}", map.member_name(force.member));
        *place += 1;
        if map.copies.contains(&force.member) || !map.connected.contains(&force.member) {
            continue;
        }
        components(force, loads, &shaft, &mut all);
    }
    all
}

/// The components of a force that are not equal in all cases.
fn components(force: &Force, loads: &Loads, shaft: &str, all: &mut Vec<Bound>) {
    let names = [
        ("force", "x", 0, "N"),
        ("force", "y", 1, "N"),
        ("force", "z", 2, "N"),
        ("moment", "y", 0, "Nm"),
        ("moment", "z", 1, "Nm"),
    ];
    for (what, axis, place, unit) in names {
        let values: Vec<f64> = loads
            .cases
            .iter()
            .filter_map(|case| force.by_case.get(case.number))
            .map(|(forces, moments)| if what == "force" { forces[place] } else { moments[place] })
            .collect();
        if values.iter().any(|value| *value != values[0]) {
            all.push(Bound {
                column: format!("{}_{axis}", id(what, force.component)),
                unit,
                path: if what == "force" {
                    format!("{shaft}.force.{place}")
                } else {
                    format!("{shaft}.moment.{place}")
                },
                values,
            });
        }
    }
}

/// The gear of a case, if it is one of the gearbox.
fn gear(case: &Case, gears: &BTreeSet<String>) -> Option<String> {
    let name = gear_name(case.gear?);
    gears.contains(&name).then_some(name)
}

fn table(loads: &Loads, bound: &[Bound], gears: &BTreeSet<String>) -> String {
    let mut text =
        "# The load cases of the REXS model; torque and speed about the x axis of the gearbox.\nname".to_owned();
    if !gears.is_empty() {
        text.push_str(",gear");
    }
    text.push_str(",torque [Nm],speed [rpm]");
    for bound in bound {
        let _ = write!(text, ",{} [{}]", bound.column, bound.unit);
    }
    text.push('\n');
    for (row, case) in loads.cases.iter().enumerate() {
        text.push_str(&case.name);
        if !gears.is_empty() {
            let first = || gears.iter().next().cloned().unwrap_or_default();
            let _ = write!(text, ",{}", gear(case, gears).unwrap_or_else(first));
        }
        let _ = write!(text, ",{},{}", number(case.torque), number(case.speed));
        for bound in bound {
            let _ = write!(text, ",{}", number(bound.values.get(row).copied().unwrap_or_default()));
        }
        text.push('\n');
    }
    text
}

/// A load spectrum as a cycle of the study.
struct Cycle {
    name: String,
    title: String,
    gear: Option<String>,
    text: String,
}

/// Spectra with shares or times of all load cases, one for each gear.
fn spectra(map: &Map<'_>, loads: &Loads, gears: &BTreeSet<String>) -> Vec<Cycle> {
    let source = map.source;
    let mut groups: BTreeMap<(usize, Option<String>), Vec<&Case>> = BTreeMap::new();
    for case in &loads.cases {
        groups.entry((case.spectrum, gear(case, gears))).or_default().push(case);
    }
    let several_spectra = loads.cases.iter().any(|case| case.spectrum != loads.cases[0].spectrum);
    let several_gears = loads
        .cases
        .iter()
        .any(|case| gear(case, gears) != gear(&loads.cases[0], gears));
    if several_gears {
        source.note("a load spectrum of a study has one gear: the load cases of each gear are a spectrum of their own, with shares of the time in it");
    }
    let mut cycles = Vec::new();
    for ((number_of, gear), cases) in groups {
        let (shares, times): (Option<Vec<f64>>, Option<Vec<f64>>) = (
            cases.iter().map(|case| case.share).collect(),
            cases.iter().map(|case| case.time).collect(),
        );
        let total: f64 = shares.iter().flatten().sum();
        let (weights, by_share) = match (shares, times) {
            (Some(shares), _) if total > 0.0 => (shares.iter().map(|share| share / total).collect::<Vec<f64>>(), true),
            (_, Some(times)) if times.iter().sum::<f64>() > 0.0 => (times, false),
            _ => {
                if cases.len() > 1 {
                    source.note("the load cases state no durations, so there is no load spectrum");
                }
                continue;
            }
        };
        if cases.len() < 2 && !several_gears {
            continue;
        }
        if by_share && (total - 100.0).abs() > 1e-6 && !several_gears {
            source.note(format!(
                "the load cases have {} % of the time in total; their shares were divided by it",
                number(total)
            ));
        }
        let mut name = "load_spectrum".to_owned();
        let mut title = "Load spectrum".to_owned();
        if several_spectra {
            let _ = write!(name, "_{number_of}");
            let _ = write!(title, " {number_of}");
        }
        if let (true, Some(gear)) = (several_gears, &gear) {
            let _ = write!(name, "_{gear}");
            let _ = write!(title, ", {gear}");
        }
        let mut text = format!("  {name}:\n    spectrum:\n");
        let oil = cases.iter().all(|case| case.oil.is_some());
        for (case, weight) in cases.iter().zip(&weights) {
            let of_time = if by_share {
                format!("share: {}", number(*weight))
            } else {
                format!("time: {} h", number(*weight))
            };
            let oil = case
                .oil
                .filter(|_| oil)
                .map_or_else(String::new, |oil| format!(", oil_temperature: {} degC", number(oil)));
            let _ = writeln!(
                text,
                "      - {{ torque: {} Nm, speed: {} rpm, {of_time}{oil} }}   # load case {}",
                number(case.torque),
                number(case.speed),
                case.name
            );
        }
        if by_share {
            text.push_str("    duration: 1 h\n");
        }
        cycles.push(Cycle {
            name,
            title,
            gear,
            text,
        });
    }
    if !cycles.is_empty()
        && map
            .forces
            .iter()
            .any(|force| force.by_case.iter().any(|values| *values != force.by_case[0]))
    {
        source.note("external forces differ between the load cases: the operating points have those of each case, the load spectrum those of the first");
    }
    cycles
}
