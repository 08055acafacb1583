//! `solve`: one operating point with the loss of each component, sums and efficiency.

use gearloss_framework::coefficients::changed_from_source;
use gearloss_framework::evaluate::Solution;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::loads::SupportLoad;
use gearloss_framework::loss::Extent;
use gearloss_framework::transmission::Transmission;
pub use gearloss_report::page::outside;
use gearloss_report::views::balance::balance_text;
use gearloss_studies::analyses::balance::BalanceOfPoint;
pub use gearloss_studies::analyses::numbers::RPM;
use gearloss_studies::analysis::Found;
use gearloss_studies::analysis::{SUMS, evidence, notes, sum_of};
use serde_json::{Value, json};

use super::check::grade;
use super::network::{json_of_network, of_network};
use super::point::{Prepared, prepare};
use super::{locking, set, warn};
use crate::args::{Format, SolveArgs};
use crate::output::{End, Failure, Out, Table, fixed, number, significant};
use gearloss_studies::analyses::numbers::tidy;

pub fn run(args: &SolveArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let gearbox = Gearbox::read(language, &args.gearbox)?;
    let resolved = set::resolve(language, &gearbox, &args.choice)?;
    let transmission = gearbox.build(language, &resolved)?;
    warn(&gearbox, &transmission)?;
    let prepared = prepare(&args.point, &gearbox, &transmission)?;
    let mut scratch = transmission.scratch(&prepared.case);
    let point = prepared.point();
    let warm = prepared.oil.find(&transmission, &prepared.case, &point, &mut scratch);
    // Notes of heat paths count over all points; here there is one.
    let of_heat = scratch.totals.clone();
    let solution = transmission.evaluate(&prepared.case, &point, warm.temperatures(), &mut scratch);
    let locking = locking::find(&transmission, &prepared, &solution, warm.temperatures());
    let extents: Vec<Extent> = of_heat
        .iter()
        .zip(solution.extents())
        .map(|(heat, seen)| heat.merge(seen.once()))
        .collect();
    let seen = notes(&transmission, &extents);
    let known = evidence(&transmission, &resolved, &|path| gearbox.places.is_written(path));
    let changed = changed_from_source(&transmission, &resolved);
    match args.format {
        Format::Json => {
            let mut value = as_json(&transmission, &solution, &prepared);
            value["packages"] = json!(language.registry().packages());
            value["self_locking"] = json!(locking.map(|locking| locking.json()));
            // Without a heat balance there is no oil temperature; the losses are at another one.
            value["oil_temperature_degc"] = json!(warm.is_sound().then_some(warm.oil));
            value["evaluated_at_degc"] = json!(warm.oil);
            value["balance"] = json!(warm.balance.as_ref().map(|b| BalanceOfPoint::new(&transmission, b)));
            value["network"] = json!(warm.network.as_ref().map(|n| json_of_network(&transmission, n)));
            value["notes"] = json!(seen);
            value["evidence"] = json!(known);
            value["unreached"] = json!(resolved.unreached);
            value["changed_from_source"] = json!(changed);
            out.line(serde_json::to_string_pretty(&value).unwrap_or_default())?;
        }
        Format::Table => {
            let at = if warm.is_sound() {
                format!("oil {} degC", significant(warm.oil))
            } else {
                format!("no heat balance, losses at {} degC", significant(warm.oil))
            };
            out.text(&as_table(&transmission, &solution, &prepared, &at))?;
            out.text(&locking.map_or_else(String::new, |locking| locking.words()))?;
            out.text(&of_warmth(&transmission, &warm))?;
            out.text(&outside(&seen))?;
            for line in resolved.unreached.iter().chain(&resolved.without) {
                out.line(format!("note: {line}"))?;
            }
            for changed in &changed {
                out.line(format!("note: {changed}"))?;
            }
            if let Some(weak) = known.first() {
                out.line(format!(
                    "lowest evidence grade: {} ({}: {})",
                    weak.grade.name(),
                    weak.what,
                    weak.because
                ))?;
            }
        }
    }
    let mut end = if solution.is_complete() && warm.is_sound() {
        End::Fine
    } else {
        End::Finding
    };
    for what in &args.deny {
        let denied = if what == "extrapolation" {
            seen.iter().any(|n| n.outside > 0)
        } else {
            let grade = grade(what)?;
            known.first().is_some_and(|w| w.grade >= grade)
        };
        if denied {
            let reason = if what == "extrapolation" {
                "a model is used outside its stated range"
            } else {
                "the result depends on evidence of this grade or lower"
            };
            out.line(format!("error (--deny {what}): {reason}"))?;
            end = End::Finding;
        }
    }
    Ok(end)
}

/// The point as text and the state of the transmission.
pub fn heading(transmission: &Transmission, solution: &Solution<'_>, prepared: &Prepared, at: &str) -> String {
    let mut text = String::new();
    if !transmission.title().is_empty() {
        text.push_str(&format!("{}\n", transmission.title()));
    }
    text.push_str(&format!(
        "gear {}, {at}, {} flow\n\n",
        prepared.gear,
        if matches!(prepared.flow, gearloss_framework::evaluate::PowerFlow::Real) {
            "real"
        } else {
            "ideal"
        }
    ));
    let mut ports = Table::new(&["port", "speed rpm", "torque Nm", "power W"]);
    for (i, port) in transmission.ports().iter().enumerate() {
        let (speed, torque) = (solution.speed(port.member), solution.known_torque(i));
        ports.row(vec![
            port.name.clone(),
            fixed(speed * RPM, 2),
            number(torque, 4),
            number(torque.map(|torque| speed * torque), 2),
        ]);
    }
    text.push_str(&ports.render());
    text.push('\n');
    text
}

fn as_table(transmission: &Transmission, solution: &Solution<'_>, prepared: &Prepared, at: &str) -> String {
    let mut text = heading(transmission, solution, prepared, at);
    // Without a power flow there are no loads and losses.
    let flow = solution.has_flow();
    if flow && !transmission.supports().is_empty() {
        let mut loads = Table::new(&["bearing", "radial N", "axial N", "tilting Nm"]);
        let row = |path: String, load: SupportLoad| {
            vec![
                path,
                fixed(load.radial, 1),
                fixed(load.axial, 1),
                fixed(load.tilting, 3),
            ]
        };
        for (i, path) in transmission.supports().iter().enumerate() {
            loads.row(row(path.clone(), solution.load(i)));
            if let Some(load) = solution.most_loaded(i) {
                loads.row(row(format!("{path}, most loaded planet"), load));
            }
        }
        text.push_str(&loads.render());
        text.push('\n');
    }
    let mut parts = Table::new(&[
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
    text.push_str(&parts.render());
    text.push('\n');
    if let Some(sums) = sums(transmission, solution) {
        let words: Vec<String> = SUMS
            .iter()
            .zip(sums)
            .map(|((name, _), watts)| format!("{name} {}", fixed(watts, 3)))
            .collect();
        text.push_str(&format!("sums W: {}\n", words.join(", ")));
    }
    text.push_str(&format!(
        "status {}, loss {} W, efficiency {} %, loss torque {} Nm, {} iterations\n",
        solution.status().name(),
        number(solution.loss(), 4),
        number(solution.efficiency().map(|e| 100.0 * e), 4),
        number(solution.loss_torque(), 6),
        solution.passes(),
    ));
    // The internal power exceeds the input only with circulating power.
    if let Some(times) = multiplied(solution).filter(|times| *times > 1.001) {
        text.push_str(&format!(
            "largest internal power {} W, {times:.2} times the input\n",
            number(Some(solution.largest_power()), 2),
        ));
    }
    if let Some((part, reason)) = solution.undefined() {
        text.push_str(&format!("{}: {reason}\n", part.path));
    }
    text
}

/// The heat balance of a point as text; empty if temperatures are given.
pub fn of_warmth(transmission: &Transmission, warm: &Found) -> String {
    let balance = warm
        .balance
        .as_ref()
        .map(|b| balance_text(&BalanceOfPoint::new(transmission, b), true));
    let network = warm.network.as_ref().map(|n| of_network(transmission, n));
    balance.or(network).unwrap_or_default()
}

/// The largest internal power relative to the input power.
fn multiplied(solution: &Solution<'_>) -> Option<f64> {
    let input = solution.input_power().filter(|input| *input > 0.0)?;
    Some(solution.largest_power() / input)
}

/// The usual sums by their names.
pub fn by_name(sums: [f64; 6]) -> Value {
    let named = SUMS.iter().zip(sums);
    named
        .map(|((name, _), watts)| ((*name).to_owned(), json!(watts)))
        .collect()
}

/// The usual sums; absent if there is no power flow.
fn sums(transmission: &Transmission, solution: &Solution<'_>) -> Option<[f64; 6]> {
    if !solution.has_flow() {
        return None;
    }
    let mut sums = [0.0; 6];
    for (part, loss) in solution.parts() {
        for term in transmission.instances()[part.notes.instance()].entry.terms {
            sums[sum_of(part.mechanism, term.load_dependent)] += loss.term_watts(term.index);
        }
    }
    Some(sums)
}

fn as_json(transmission: &Transmission, solution: &Solution<'_>, prepared: &Prepared) -> Value {
    // Without a power flow loads and losses are null.
    let flow = solution.has_flow();
    let known = |value: f64| flow.then_some(value);
    let ports: Vec<Value> = transmission
        .ports()
        .iter()
        .enumerate()
        .map(|(i, port)| {
            let (speed, torque) = (solution.speed(port.member), solution.known_torque(i));
            let power = torque.map(|torque| speed * torque);
            json!({ "port": port.name, "speed_rpm": tidy(speed * RPM), "torque_nm": torque, "power_w": power })
        })
        .collect();
    let members: Vec<Value> = transmission
        .members()
        .iter()
        .enumerate()
        .map(|(i, name)| json!({ "member": name, "speed_rpm": tidy(solution.speed(i) * RPM) }))
        .collect();
    let loads: Vec<Value> = transmission
        .supports()
        .iter()
        .enumerate()
        .map(|(i, path)| {
            let load = solution.load(i);
            let most = solution
                .most_loaded(i)
                .filter(|_| flow)
                .map(|load| json!({ "radial_n": load.radial, "axial_n": load.axial, "tilting_nm": load.tilting }));
            json!({
                "support": path, "radial_n": known(load.radial), "axial_n": known(load.axial), "tilting_nm": known(load.tilting),
                "most_loaded_planet": most, "static_safety": solution.static_safety(i),
            })
        })
        .collect();
    let parts: Vec<Value> = solution
        .parts()
        .map(|(part, loss)| {
            let entry = &transmission.instances()[part.notes.instance()].entry;
            let terms: Vec<Value> = entry
                .terms
                .iter()
                .map(|t| json!({ "term": t.name, "load_dependent": t.load_dependent, "loss_w": known(loss.term_watts(t.index)) }))
                .collect();
            json!({
                "part": part.path,
                "mechanism": part.mechanism,
                "model": entry.name,
                "count": part.count,
                "relative_speed_rpm": tidy(loss.speed * RPM),
                "moment_of_one_nm": loss.moment().filter(|_| flow),
                "loss_w": loss.result.is_ok().then(|| loss.watts()).filter(|_| flow),
                "undefined": loss.result.err().filter(|_| flow).map(|e| e.to_string()),
                "terms": terms,
            })
        })
        .collect();
    json!({
        "format": "gearloss-point/1",
        "gearloss": env!("CARGO_PKG_VERSION"),
        "gear": prepared.gear,
        "power_flow": prepared.flow,
        "status": solution.status(),
        "efficiency": solution.efficiency(),
        "loss_w": solution.loss(),
        "loss_torque_nm": solution.loss_torque(),
        "power": {
            "input_w": solution.input_power(),
            "output_w": solution.output_power(),
            "loss_w": solution.loss(),
            "residual_w": solution.residual(),
            "largest_internal_power_w": known(solution.largest_power()),
            "largest_internal_over_input": multiplied(solution),
        },
        "sums_w": sums(transmission, solution).map(by_name),
        "ports": ports,
        "members": members,
        "stages": transmission.stages().collect::<Vec<_>>(),
        "supports": loads,
        "parts": parts,
    })
}
