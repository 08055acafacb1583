//! One solved point: text and record.

mod derivatives;
mod explain;
mod explained;
mod network;
mod oil;
mod oil_network;
mod pair;
mod ratings;
mod record;

use std::fmt::Display;

use gearloss_framework::evaluate::{PowerFlow, Solution};
use gearloss_framework::loads::SupportLoad;
use gearloss_framework::resolve::Resolved;
use gearloss_framework::transmission::{BearingPair, PlanetShares, Port, Transmission};
use gearloss_studies::analyses::balance::BalanceOfPoint;
use gearloss_studies::numbers::RPM;
use gearloss_studies::pairs::preload_records;
use gearloss_studies::points::{Found, PreparedPoint, STATIC_SAFETY, SUMS, SelfLocking, SolvedPoint, WeakPoint, sums};

pub use derivatives::derivatives_text;
use explain::{explain_heat_path, explain_part};
pub use explained::Explained;
use network::network_blocks;
use oil::oil_level_text;
pub use oil_network::flow_rows;
use oil_network::oil_blocks;
use ratings::explain_ratings;
pub use ratings::{rating_lines, ratings_blocks, ratings_text};
pub use record::PointRecord;

use crate::page::{Blocks, outside};
use crate::text::{TextTable, figures, fixed, number, significant};
use crate::unit;
pub use crate::views::balance::{balance_text, over_temperature};

/// Lines on what has no model, on changed coefficients, and on the lowest evidence grade.
pub fn remarks(resolved: &Resolved, changed: &[impl Display], evidence: &[WeakPoint]) -> Vec<String> {
    let missing = resolved
        .unreached
        .iter()
        .chain(&resolved.without)
        .chain(&resolved.designations);
    let mut lines: Vec<String> = missing.map(|line| format!("note: {line}")).collect();
    lines.extend(changed.iter().map(|changed| format!("note: {changed}")));
    lines.extend(evidence.first().map(|weak| {
        let grade = weak.grade.name();
        format!("lowest evidence grade: {grade} ({}: {})", weak.what, weak.because)
    }));
    lines
}

/// What is solved: transmission, gear, temperature, kind of flow.
pub fn heading(transmission: &Transmission, prepared: &PreparedPoint, at: &str) -> String {
    let title = match transmission.title() {
        "" => String::new(),
        title => format!("{title}\n"),
    };
    let flow = if matches!(prepared.flow, PowerFlow::Real) {
        "real"
    } else {
        "ideal"
    };
    format!("{title}gear {}, {at}, {flow} flow\n", prepared.gear)
}

/// Speeds, torques and powers at the ports.
fn ports_table(transmission: &Transmission, solution: &Solution<'_>) -> TextTable {
    let speed = |port: &Port| solution.speed(port.member);
    TextTable::of(transmission.ports().iter().enumerate())
        .column("port", |(_, port)| &port.name)
        .column("speed rpm", |(_, port)| fixed(speed(port) * RPM, 2))
        .column("torque Nm", |(i, _)| number(solution.known_torque(*i), 4))
        .column("power W", |(i, port)| {
            number(solution.known_torque(*i).map(|torque| speed(port) * torque), 2)
        })
        .finish()
}

/// The same as text.
pub fn ports_text(transmission: &Transmission, solution: &Solution<'_>) -> String {
    ports_table(transmission, solution).render() + "\n"
}

/// A solved point as text.
pub fn point_text(transmission: &Transmission, prepared: &PreparedPoint, solved: &SolvedPoint<'_>) -> String {
    point_blocks(transmission, prepared, solved).render()
}

/// A solved point: ports, loads, losses, sums, temperatures, and what was outside its stated range.
pub fn point_blocks(transmission: &Transmission, prepared: &PreparedPoint, solved: &SolvedPoint<'_>) -> Blocks {
    let (solution, found) = (&solved.solution, &solved.found);
    let at = if found.is_sound() {
        format!("oil {} °C", figures(found.oil, 4))
    } else {
        format!("no heat balance, losses at {} °C", figures(found.oil, 4))
    };
    let mut blocks = Blocks::default();
    blocks.text(&heading(transmission, prepared, &at));
    blocks.text(&answer(solution));
    blocks.text("\n");
    blocks.table(ports_table(transmission, solution));
    blocks.text("\n");
    // Without a power flow there are no loads and losses.
    let flow = solution.has_flow();
    if flow && !transmission.supports().is_empty() {
        blocks.table(bearing_loads(transmission, solution));
        for planets in solution.planet_shares() {
            blocks.text(&planets_text(&planets));
        }
        for preload in preload_records(transmission, solution) {
            blocks.text(&(preload.sentence() + "\n"));
        }
        blocks.text("\n");
    }
    let mut parts = TextTable::new(&[
        "component",
        "model",
        "loss W",
        "load-dependent W",
        "moment Nm",
        "relative rpm",
    ]);
    for (part, loss) in solution.parts() {
        let entry = &transmission.instances()[part.notes.instance()].entry;
        let dependent: f64 = entry
            .terms
            .iter()
            .filter(|t| t.load_dependent)
            .fold(0.0, |sum, t| sum + loss.term_watts(t.index));
        let watts = match &loss.result {
            Err(_) if flow => "undefined".to_owned(),
            _ => number(flow.then(|| loss.watts()), 4),
        };
        parts.row(vec![
            part.path.clone(),
            entry.name.to_owned(),
            watts,
            number(flow.then_some(dependent), 4),
            number(loss.moment().filter(|_| flow), 6),
            fixed(loss.speed * RPM, 1),
        ]);
    }
    blocks.table(parts);
    blocks.text("\n");
    if let Some(sums) = sums(transmission, solution) {
        let words: Vec<String> = SUMS
            .iter()
            .zip(sums)
            .map(|((name, _), watts)| format!("{name} {}", fixed(watts, 3)))
            .collect();
        blocks.text(&format!("sums W: {}\n", words.join(", ")));
    }
    // The internal power exceeds the input only with circulating power.
    if let Some(times) = multiplied(solution).filter(|times| *times > 1.001) {
        blocks.text(&format!(
            "largest internal power {} W, {times:.2} times the input\n",
            number(Some(solution.largest_power()), 2),
        ));
    }
    if !solved.machines.is_empty() {
        blocks.table(machines_table(solved));
        blocks.text(&unit::line(solved.unit().as_ref()));
    }
    if let Some((part, reason)) = solution.undefined() {
        blocks.text(&format!("{}: {reason}\n", part.path));
    }
    if let Some(locking) = &solved.locking {
        blocks.text(&locking_text(locking));
    }
    blocks.text(&oil_level_text(solution.oil_levels()));
    blocks.append(oil_blocks(solution));
    blocks.append(temperature_blocks(transmission, found));
    blocks.text(&outside_ranges(solved));
    blocks
}

/// The load sharing of planets in one line.
fn planets_text(found: &PlanetShares) -> String {
    let shares: Vec<String> = found.shares.iter().map(|share| format!("{share:.4}")).collect();
    let moved: Vec<String> = (found.displacements.iter())
        .map(|(member, displacement)| format!("; {member} moves by {:.2} um", displacement * 1e6))
        .collect();
    format!(
        "planets of {}: K_gamma {:.4}; shares {}{}\n",
        found.set,
        found.k_gamma(),
        shares.join(", "),
        moved.concat()
    )
}

/// The electric machines at a point.
fn machines_table(solved: &SolvedPoint<'_>) -> TextTable {
    TextTable::of(&solved.machines)
        .column("machine", |(path, _)| path)
        .column("torque Nm", |(_, state)| number(Some(state.torque), 4))
        .column("loss W", |(_, state)| number(Some(state.machine), 3))
        .column("inverter W", |(_, state)| number(Some(state.inverter), 3))
        .column("DC power W", |(_, state)| number(Some(state.electric()), 2))
        .column("torque", |(_, state)| match (state.outside, state.reached) {
            (true, _) => "outside the map",
            (false, reached) => reached.name(),
        })
        .finish()
}

/// Loads of the bearings of a point with a power flow.
fn bearing_loads(transmission: &Transmission, solution: &Solution<'_>) -> TextTable {
    let induced = |pair: &BearingPair| pair.spring.is_none() && pair.preload.is_none();
    let paired = transmission.pairs().iter().any(induced);
    let mut head = vec!["bearing", "radial N", "axial N", "tilting Nm"];
    if paired {
        head.insert(3, "of it induced N");
    }
    let mut loads = TextTable::new(&head);
    let row = |path: String, load: SupportLoad, induced: Option<f64>| {
        let mut row = vec![
            path,
            fixed(load.radial, 1),
            fixed(load.axial, 1),
            fixed(load.tilting, 3),
        ];
        if paired {
            row.insert(3, number(induced, 1));
        }
        row
    };
    for (i, path) in transmission.supports().iter().enumerate() {
        loads.row(row(path.clone(), solution.load(i), solution.induced(i, false)));
        if let Some(load) = solution.most_loaded(i) {
            let induced = solution.induced(i, true);
            loads.row(row(format!("{path}, most loaded planet"), load, induced));
        }
    }
    loads
}

/// Loss and efficiency in one line: what a point is solved for.
fn answer(solution: &Solution<'_>) -> String {
    let quantity = |name: &str, value: Option<f64>, unit: &str| {
        let value = value.map_or_else(|| "-".to_owned(), |value| figures(value, 4));
        format!("{name} {value} {unit}")
    };
    format!(
        "{}, {}, {}; status {}\n",
        quantity("loss", solution.loss(), "W"),
        quantity("efficiency", solution.efficiency().map(|e| 100.0 * e), "%"),
        quantity("loss torque", solution.loss_torque(), "Nm"),
        solution.status().name(),
    )
}

/// What is outside its stated range at a point, a line for each range.
pub fn outside_ranges(solved: &SolvedPoint<'_>) -> String {
    // The ratings state the static safety, with the user's bound.
    let notes = solved.notes.iter().filter(|note| note.name != STATIC_SAFETY);
    outside(&notes.cloned().collect::<Vec<_>>())
}

/// Self-locking as a sentence.
pub fn locking_text(locking: &SelfLocking) -> String {
    let quoted = |names: &[String]| -> String {
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        quoted.join(" and ")
    };
    let (from, to) = (quoted(&locking.from), quoted(&locking.to));
    let mut text = if locking.helping.is_empty() {
        format!("self-locking: no power flows from {from} to {to} at any torque at {from}")
    } else {
        let torques: Vec<String> = locking
            .helping
            .iter()
            .map(|(port, torque)| format!("`{port}` ({} Nm)", significant(*torque)))
            .collect();
        let pushes = if torques.len() == 1 { "drives" } else { "drive" };
        format!(
            "self-locking: torque at {from} alone does not turn it; the speeds are maintained only because {} {pushes} as well, and \
             there is no output power",
            torques.join(" and ")
        )
    };
    if !locking.meshes.is_empty() {
        text.push_str(&format!("; locked by {}", locking.meshes.join(", ")));
    }
    if let Some(back) = locking.back {
        text.push_str(&format!("; efficiency from {to}: {:.2} %", 100.0 * back));
    }
    text.push('\n');
    text
}

/// The heat balance of a point as text; empty if temperatures are given.
pub fn temperature_text(transmission: &Transmission, warm: &Found) -> String {
    temperature_blocks(transmission, warm).render()
}

fn temperature_blocks(transmission: &Transmission, warm: &Found) -> Blocks {
    if let Some(balance) = &warm.balance {
        let mut blocks = Blocks::default();
        blocks.text(&balance_text(&BalanceOfPoint::new(transmission, balance), true));
        return blocks;
    }
    let network = warm.network.as_ref();
    network.map_or_else(Blocks::default, |network| network_blocks(transmission, network))
}

/// The largest internal power relative to the input power.
fn multiplied(solution: &Solution<'_>) -> Option<f64> {
    let input = solution.input_power().filter(|input| *input > 0.0)?;
    Some(solution.largest_power() / input)
}
